#!/bin/bash
# Runs campaigns through Slurm on this machine, one of a gearbox too: as an array job and as an MPI job, warned and sent
# back into the queue, killed at its time limit and submitted again. Every result must be, byte for byte, that of a run
# without Slurm. Usage: run_cluster_tests.sh [BUILD]; RATTLE_PROGRAM=PATH tests a program that is already built with MPI.
set -u
here=$(cd "$(dirname "$0")" && pwd)
repository=$(cd "$here/../.." && pwd)
build=${1:-build/mpi}
python=${PYTHON:-$repository/.venv/bin/python}
campaign="$python $repository/scripts/campaign.py"
aimed_seconds=${CLUSTER_SECONDS:-110} # of the long campaign on one core; its time limit kills within 90 s
failed=0

say() { printf '%s  %s\n' "$(date +%T)" "$*"; }
fail() {
    say "FAILED: $*"
    failed=1
}
give_up() {
    say "FAILED: $*"
    exit 1
}

cd "$repository" || exit 1
place=$(mktemp -d) || exit 1
work=$place/work
mkdir -p "$work"
chmod 711 "$place" # the way to the sockets must be open
finish() {
    "$here/stop_cluster.sh" "$place/cluster" || failed=1
    if [ "$failed" = 0 ] && [ "${1:-0}" = 0 ]; then rm -rf "$place"; else say "all files are left in $place"; fi
}
trap 'code=$?; finish $code; [ "$failed" = 0 ] || code=1; trap - EXIT; exit $code' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

"$here/setup_cluster.sh" "$place/cluster" || give_up 'the cluster does not start'
. "$place/cluster/environment"
program=${RATTLE_PROGRAM:+$(realpath "$RATTLE_PROGRAM")}
if [ -z "$program" ]; then
    say 'building with MPI'
    make --no-print-directory MPI=1 BUILD="$build" "$build/rattle" > "$work/make.log" 2>&1 ||
        { tail -20 "$work/make.log"; give_up 'the build'; }
    program=$repository/$build/rattle
fi
cd "$work" || exit 1

# write_input NAME FORCES SPEEDS
write_input() {
    sed -e "s/= 64 .*FORCES/= $2/" -e "s/= 64 .*SPEEDS/= $3/" "$here/campaign.nml" > "$1.nml"
}
# write_script DIRECTORY NAME OPTIONS...: a job script as a user writes it
write_script() {
    directory=$1 name=$2
    shift 2
    $campaign slurm "$name.nml" --program "$program" --output "$directory" "$@" > /dev/null 2> "$directory.note" ||
        { cat "$directory.note"; give_up "no job script in $directory"; }
}
submit() { sbatch --parsable "$@" || give_up "sbatch $*"; }
show() { scontrol show job --oneliner "$1"; }
shows() { show "$1" | grep -Eq "$2"; }
# wait_until SECONDS WHAT COMMAND...
wait_until() {
    limit=$((SECONDS + $1)) what=$2
    shift 2
    until "$@" 2> /dev/null; do
        [ "$SECONDS" -lt "$limit" ] || give_up "$what"
        sleep 0.3
    done
}
ended() { [ -z "$(squeue --noheader --jobs="$1" 2> /dev/null)" ]; }
all_well() { # every task of the job completed
    ! show "$1" | grep -Ev 'JobState=COMPLETED' | grep -q .
}
same() { # WHAT FILE EXPECTED
    if cmp "$2" "$3"; then say "ok      $1"; else fail "$1"; fi
}

say 'the campaigns without Slurm'
write_input short 64 64
"$program" --quiet --threads 1 --output alone short.nml > alone.log 2>&1 || { tail alone.log; give_up 'short campaign'; }
# Long enough for what a start costs not to matter.
write_input sample 64 256
# Processor time: the clock on the wall says nothing where other work runs beside.
TIMEFORMAT='%U %S'
used=$({ time "$program" --quiet --threads 1 --output alone sample.nml > alone.log 2>&1; } 2>&1) ||
    { tail alone.log; give_up 'sample campaign'; }
spent=$(echo "$used" | awk '{ printf "%d", 1000 * ($1 + $2) + 1 }')
# The count of speeds that makes the long campaign take about the time aimed at.
speeds=$((256 * aimed_seconds * 1000 / spent))
say "64 x 256 scenes took $spent ms on one core; the long campaign has 64 x $speeds"
write_input long 64 "$speeds"
"$program" --quiet --threads 2 --output alone long.nml > alone.log 2>&1 || { tail alone.log; give_up 'long campaign'; }

say 'thresholds on two ranks of two threads, and as an array job of three parts'
cp "$repository/input/threshold.nml" .
"$program" --quiet --threads 1 --output thresholds threshold.nml
mpirun -n 2 --bind-to none "$program" --quiet --threads 2 --output thresholds_of_ranks threshold.nml
same 'thresholds, MPI job' thresholds_of_ranks/threshold.rattle thresholds/threshold.rattle
write_script threshold_array threshold --array 3 --time 00:10:00
job=$(submit threshold_array/threshold.slurm)
wait_until 300 'the array job of thresholds does not end' ended "$job"
all_well "$job" || { show "$job"; fail 'a task of the array job of thresholds'; }
$campaign merge threshold_array/threshold.part-*-of-3.rattle --output threshold_array/threshold.rattle 2> array.note || { cat array.note; fail merge; }
same 'thresholds, array job, merged' threshold_array/threshold.rattle thresholds/threshold.rattle

say 'thresholds whose sides overlap, on two ranks and on three'
cp "$here/overlap.nml" .
"$program" --quiet --threads 1 --output thresholds overlap.nml > alone.log 2>&1 || { tail alone.log; give_up 'overlapping thresholds'; }
grep -Eq 'either side  *possible at [1-9][0-9]* of 3 crossings' thresholds/overlap.log || fail 'no threshold has two sides'
for ranks in 2 3; do
    mpirun -n "$ranks" --oversubscribe --bind-to none "$program" --quiet --threads 2 --output "overlap_$ranks" overlap.nml
    same "overlapping thresholds, $ranks ranks" "overlap_$ranks/overlap.rattle" thresholds/overlap.rattle
done

say 'a gearbox over speed and oil temperature with several motions, every class verified: array job and MPI jobs'
sed -e 's/^   count = .*/   count = 3, 3/' -e 's/^   first = 600.0, .*/   first = 1400.0, 60.0/' -e 's/^   last = 3000.0, .*/   last = 2200.0, 120.0/' \
    "$repository/input/gearbox_map.nml" > gearbox.nml
grep -q 'count = 3, 3' gearbox.nml && grep -q 'first = 1400' gearbox.nml && grep -q 'last = 2200' gearbox.nml || give_up 'gearbox_map.nml has other lines'
cp "$repository/input/gearbox_run_up.csv" .
"$program" --quiet --threads 1 --output alone gearbox.nml > alone.log 2>&1 || { tail alone.log; give_up 'gearbox'; }
grep -Eq '[1-9][0-9]* of 36 scenes have several motions' alone/gearbox.log || fail 'no scene of the gearbox has several motions'
write_script gearbox_array gearbox --array 3 --time 00:10:00
array=$(submit gearbox_array/gearbox.slurm)
write_script gearbox_mpi gearbox --ranks 2 --time 00:10:00 --launcher 'srun --mpi=pmix'
job=$(submit gearbox_mpi/gearbox.slurm)
mpirun -n 2 --bind-to none "$program" --quiet --threads 2 --output gearbox_ranks gearbox.nml || fail 'the gearbox under mpirun'
same 'gearbox, mpirun' gearbox_ranks/gearbox.rattle alone/gearbox.rattle
for waited in "$array" "$job"; do
    wait_until 300 'a gearbox job does not end' ended "$waited"
    all_well "$waited" || { show "$waited"; fail 'a gearbox job'; }
done
$campaign merge gearbox_array/gearbox.part-*-of-3.rattle --output gearbox_array/gearbox.rattle 2> array.note || { cat array.note; fail merge; }
same 'gearbox, array job, merged' gearbox_array/gearbox.rattle alone/gearbox.rattle
same 'gearbox, MPI job' gearbox_mpi/gearbox.rattle alone/gearbox.rattle

say 'a motion under mpirun'
mpirun -n 2 "$program" --quiet --output refused "$repository/input/creep.nml" > refused.log 2>&1 && fail 'a motion ran twice'
grep -q 'only a campaign or threshold can be divided' refused.log && [ ! -e refused ] || { cat refused.log; fail 'no refusal of a motion'; }

say 'an array job of three parts'
write_script array short --array 3 --time 00:10:00
job=$(submit array/short.slurm)
wait_until 300 'the array job does not end' ended "$job"
all_well "$job" || { show "$job"; fail 'a task of the array job'; }
$campaign merge array/short.part-*-of-3.rattle --output array/short.rattle 2> array.note || { cat array.note; fail merge; }
same 'array job, merged' array/short.rattle alone/short.rattle

for launcher in 'srun --mpi=pmix' mpirun; do
    say "an MPI job of two ranks, started by $launcher"
    directory=mpi_${launcher%% *}
    write_script "$directory" short --ranks 2 --time 00:10:00 --launcher "$launcher"
    job=$(submit "$directory/short.slurm")
    wait_until 300 'the MPI job does not end' ended "$job"
    all_well "$job" || { show "$job"; cat "$directory"/*.log; fail 'the MPI job'; }
    same "MPI job, $launcher" "$directory/short.rattle" alone/short.rattle
done

# Slurm looks at time limits every half minute and counts them in minutes. The options of sbatch go before those of
# the script: warned after 5 to 35 s here, and there not warned but killed after 60 to 90 s.
say 'a job warned before its time limit, beside one killed at it'
write_script warned long --time 00:10:00
write_script killed long --time 00:10:00
warned=$(submit --time=00:01:00 --signal=B:USR1@25 warned/long.slurm)
killed=$(submit --time=00:01:00 --signal=B:CONT@1 killed/long.slurm)
wait_until 90 'the warned job does not go back into the queue' shows "$warned" 'Restarts=[1-9]'
say "ok      warned job is back in the queue, $($campaign status warned/long.rattle | grep -o 'chunks done.*' | tr -s ' ')"
wait_until 30 'the time limit of the warned job cannot be raised' \
    scontrol update "JobId=$warned" TimeLimit=60
wait_until 120 'the other job is not killed' shows "$killed" 'JobState=TIMEOUT'
wait_until 60 'the killed job does not end' ended "$killed"
say "ok      other job is killed, $($campaign status killed/long.rattle | grep -o 'chunks done.*' | tr -s ' ')"
cmp -s killed/long.rattle alone/long.rattle && fail 'the killed job had already finished'
killed=$(submit killed/long.slurm)
wait_until 600 'the resumed jobs do not end' ended "$warned"
wait_until 600 'the resumed jobs do not end' ended "$killed"
all_well "$warned" && all_well "$killed" || { cat warned/*.log killed/*.log; fail 'a resumed job'; }
same 'warned, requeued, resumed' warned/long.rattle alone/long.rattle
same 'killed, submitted again, resumed' killed/long.rattle alone/long.rattle

# A warning at any moment, here handed to an MPI job and an array job early on.
say 'warnings to an MPI job and to an array job'
write_script mpi_warned long --ranks 2 --time 00:30:00 --launcher 'srun --mpi=pmix'
job=$(submit mpi_warned/long.slurm)
wait_until 60 'the MPI job does not start' test -s mpi_warned/long.rattle
sleep 3
scancel --signal=USR1 --batch "$job"
wait_until 60 'the MPI job does not go back into the queue' shows "$job" 'Restarts=[1-9]'
wait_until 600 'the MPI job does not end' ended "$job"
same 'MPI job, warned and resumed' mpi_warned/long.rattle alone/long.rattle
write_script array_warned long --array 2 --time 00:30:00
job=$(submit array_warned/long.slurm)
wait_until 60 'the array job does not start' test -s array_warned/long.part-2-of-2.rattle
sleep 3
scancel --signal=USR1 --batch "${job}_2"
wait_until 60 'the task does not go back into the queue' shows "${job}_2" 'Restarts=[1-9]'
wait_until 600 'the array job does not end' ended "$job"
$campaign merge array_warned/long.part-*-of-2.rattle --output array_warned/long.rattle 2> array.note || fail merge
same 'array job, one task warned and resumed, merged' array_warned/long.rattle alone/long.rattle

[ "$failed" = 0 ] && say 'all cluster tests passed'
exit "$failed"
