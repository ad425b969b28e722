#!/bin/sh
# Ends the cluster that setup_cluster.sh started in DIRECTORY: cancels its jobs, stops slurmd, slurmctld and munged
# by the process numbers that they wrote. Usage: stop_cluster.sh DIRECTORY
set -u

[ $# = 1 ] || { echo 'usage: stop_cluster.sh DIRECTORY' >&2; exit 2; }
[ -d "$1" ] || { echo "stop_cluster.sh: $1 holds no cluster." >&2; exit 2; }
place=$(cd "$1" && pwd -P)

if [ -e "$place/environment" ]; then
    . "$place/environment"
    scancel --user="$(id -un)" 2> /dev/null
    tries=50
    while [ "$tries" -gt 0 ] && squeue --noheader 2> /dev/null | grep -q .; do
        tries=$((tries - 1))
        sleep 0.2
    done
fi

code=0
for daemon in slurmd slurmctld munged; do
    [ -s "$place/$daemon.pid" ] || continue
    process=$(cat "$place/$daemon.pid")
    # The number may have passed on to a stranger after a crash.
    [ "$(cat "/proc/$process/comm" 2> /dev/null)" = "$daemon" ] || continue
    kill "$process"
    tries=75
    while [ "$tries" -gt 0 ] && kill -0 "$process" 2> /dev/null; do
        tries=$((tries - 1))
        sleep 0.2
    done
    if kill -0 "$process" 2> /dev/null; then
        echo "stop_cluster.sh: $daemon ($process) did not stop within 15 s and is killed." >&2
        kill -9 "$process"
        code=1
    fi
done
rm -f "$place/environment"
exit $code
