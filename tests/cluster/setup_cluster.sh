#!/bin/sh
# Starts a Slurm cluster of one node on the loopback address: munged, slurmctld and slurmd, without systemd and
# without touching /etc. Debian's packages are installed where they are missing. Usage: setup_cluster.sh DIRECTORY
#
# DIRECTORY holds configuration, state and logs; '. DIRECTORY/environment' makes sbatch and its kin speak to it.
# Its path must be short, because sockets live in it (108 characters at most).
set -eu

[ $# = 1 ] || { echo 'usage: setup_cluster.sh DIRECTORY' >&2; exit 2; }
PATH=$PATH:/usr/sbin:/sbin
packages='openmpi-bin libopenmpi-dev slurm-wlm munge'
controller_port=${CLUSTER_PORT:-26817}
node_port=$((controller_port + 1))

complain() {
    echo "setup_cluster.sh: $*" >&2
    exit 1
}

missing() {
    for program in mpirun mpifort munged slurmctld slurmd sbatch srun; do
        command -v "$program" > /dev/null || echo "$program"
    done
}

install_packages() {
    command -v apt-get > /dev/null || complain "no $* here, and no apt-get; install: $packages"
    if [ "$(id -u)" = 0 ]; then as_root=
    elif sudo -n true 2> /dev/null; then as_root='sudo -n'
    else complain "no $* here; install them with: sudo apt-get install -y $packages"
    fi
    echo "installing: $packages"
    # A policy that forbids to start services at installation; ours are started below.
    $as_root env DEBIAN_FRONTEND=noninteractive sh -c "apt-get update -qq &&
        RUNLEVEL=1 apt-get install -y -qq --no-install-recommends $packages" > /dev/null ||
        complain 'apt-get could not install them.'
}

# wait_for SECONDS WHAT LOG COMMAND...
wait_for() {
    seconds=$1 what=$2 log=$3
    shift 3
    tries=$((seconds * 5))
    until "$@" > /dev/null 2>&1; do
        tries=$((tries - 1))
        if [ "$tries" -le 0 ]; then
            [ ! -e "$log" ] || tail -20 "$log" >&2
            complain "$what did not start within $seconds s; its log is $log."
        fi
        sleep 0.2
    done
}

lacking=$(missing)
[ -z "$lacking" ] || install_packages $lacking
lacking=$(missing)
[ -z "$lacking" ] || complain "still missing after the installation: $lacking"

mkdir -p "$1"
place=$(cd "$1" && pwd -P)
[ ${#place} -le 80 ] || complain "$place is too long a path for sockets; take a shorter one."
[ ! -e "$place/environment" ] || complain "$place already holds a cluster; stop_cluster.sh $place ends it."
mkdir -p "$place/state" "$place/spool" "$place/log"
chmod 711 "$place" # munged refuses a socket in a directory that others may write to
user=$(id -un)
host=$(hostname -s)

# Accounting is off: the state of ended jobs is read from the file of jobcomp. A requeued job waits until its
# credential has expired, hence the short life of credentials.
cat > "$place/slurm.conf" << CONFIGURATION
ClusterName=loopback
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$controller_port
SlurmdPort=$node_port
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$place/munge.socket,cred_expire=10
CredType=cred/munge
StateSaveLocation=$place/state
SlurmdSpoolDir=$place/spool
SlurmctldPidFile=$place/slurmctld.pid
SlurmdPidFile=$place/slurmd.pid
SlurmctldLogFile=$place/log/slurmctld.log
SlurmdLogFile=$place/log/slurmd.log
MpiDefault=pmix
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,bf_interval=1
SlurmdParameters=config_overrides
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
JobCompType=jobcomp/filetxt
JobCompLoc=$place/log/jobs.txt
JobRequeue=1
ReturnToService=2
KillWait=5
OverTimeLimit=0
MinJobAge=3600
MessageTimeout=30
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONFIGURATION

(umask 077 && head -c 128 /dev/urandom > "$place/munge.key")
munged --key-file="$place/munge.key" --socket="$place/munge.socket" --pid-file="$place/munged.pid" \
    --log-file="$place/log/munged.log" --seed-file="$place/munged.seed" --num-threads=2
wait_for 10 munged "$place/log/munged.log" munge --socket="$place/munge.socket" --no-input --output=/dev/null

# From here on stop_cluster.sh knows what to stop. Open MPI refuses root and more ranks than cores unless allowed.
cat > "$place/environment" << ENVIRONMENT
export PATH="\$PATH:/usr/sbin:/sbin"
export SLURM_CONF='$place/slurm.conf'
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
ENVIRONMENT
. "$place/environment"

slurmctld -f "$SLURM_CONF" -c > /dev/null
wait_for 20 slurmctld "$place/log/slurmctld.log" scontrol ping
slurmd -f "$SLURM_CONF" -c -N "$host" > /dev/null
wait_for 30 slurmd "$place/log/slurmd.log" sh -c 'sinfo --noheader --format=%T | grep -qx idle'
echo "cluster ready: . $place/environment"
