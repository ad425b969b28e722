"""Job scripts for Slurm: a campaign as an array of parts, or as one MPI job."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

# Slurm checks time limits about once a minute, so its warning may come up to a minute early, never late.
CLOCK_GRAIN = 60
# Time limits: minutes[:seconds], hours:minutes:seconds, days-hours[:minutes[:seconds]].
TIME = re.compile(r"(?:(?P<days>\d+)-)?(?P<clock>(?<=-)|\d+(?::\d+){0,2})", re.ASCII)
NO_LIMIT = ("UNLIMITED", "INFINITE", "-1")
# An amount of memory, in megabytes where no unit stands.
MEMORY = re.compile(r"\d+(?:[KMGT]B?)?", re.ASCII | re.IGNORECASE)
MOST_SIGNAL_SECONDS = 65535
# Tasks of an array beyond which no configuration of Slurm goes.
MOST_ARRAY_TASKS = 4_000_000
# What Slurm takes as it stands in an #SBATCH line.
PLAIN = re.compile(r"[A-Za-z0-9_./%=:@,+-]*")


@dataclass(frozen=True)
class Job:
    """What a job script needs to know."""

    input_file: Path
    name: str
    program: str
    working_directory: Path
    log_directory: Path
    results: str | None
    parts: int | None
    ranks: int | None
    threads: int
    time: str | None
    signal_seconds: int
    partition: str | None
    account: str | None
    memory: str | None
    modules: list[str]
    launcher: str


def seconds_of(time: str) -> int | None:
    """Seconds of a time limit as Slurm takes it, None for no limit; ValueError for anything else."""
    if time.upper() in NO_LIMIT:
        return None
    found = TIME.fullmatch(time)
    if found is None:
        raise ValueError(time)
    days, clock = found["days"], [int(part) for part in found["clock"].split(":") if part]
    if days is None and len(clock) < 3:
        clock.insert(0, 0)  # without days and hours, minutes come first
    units = zip((3600, 60, 1), clock, strict=False)
    return 86400 * int(days or 0) + sum(unit * part for unit, part in units) or None


def part_name(name: str, part: int, parts: int) -> str:
    """Result file of one part."""
    return f"{name}.part-{part}-of-{parts}.rattle"


def text(job: Job) -> str:
    """The script."""
    return "\n".join([*_directives(job), "", *_body(job)]) + "\n"


def _directives(job: Job) -> list[str]:
    log = "%x-%A-%a.log" if job.parts else "%x-%j.log"
    lines = ["#!/bin/bash", f"#SBATCH --job-name={job.name}"]
    if job.parts:
        lines.append(f"#SBATCH --array=1-{job.parts}")
    lines += [
        f"#SBATCH --ntasks={job.ranks or 1}",
        f"#SBATCH --cpus-per-task={job.threads}",
        f"#SBATCH --signal=B:USR1@{job.signal_seconds}",
        "#SBATCH --requeue",
        "#SBATCH --open-mode=append",
        f"#SBATCH --output={_quoted(str(job.log_directory / log))}",
        f"#SBATCH --chdir={_quoted(str(job.working_directory))}",
    ]
    if job.time:
        lines.append(f"#SBATCH --time={job.time}")
    if job.partition:
        lines.append(f"#SBATCH --partition={_quoted(job.partition)}")
    if job.account:
        lines.append(f"#SBATCH --account={_quoted(job.account)}")
    if job.memory:
        lines.append(f"#SBATCH --mem-per-cpu={_quoted(job.memory)}")
    return lines


def _body(job: Job) -> list[str]:
    arguments = ["--resume", "--threads", '"$OMP_NUM_THREADS"']
    if job.results is not None:
        arguments += ["--output", shlex.quote(job.results)]
    if job.parts:
        arguments += ["--set", 'campaign.part="$SLURM_ARRAY_TASK_ID"']
        arguments += ["--set", f"campaign.parts={job.parts}"]
    # A name that begins with a dash would be an option.
    dash = str(job.input_file).startswith("-")
    arguments.append(shlex.quote(f"./{job.input_file}" if dash else str(job.input_file)))
    program = shlex.quote(job.program)
    launch = f"{job.launcher} {program}" if job.ranks else program
    this_job = '"${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"' if job.parts else '"$SLURM_JOB_ID"'
    modules = [f"module load {shlex.quote(module)} || exit 1" for module in job.modules]
    return [
        *modules,
        'export OMP_NUM_THREADS="${SLURM_CPUS_PER_TASK:-1}"',
        'export SRUN_CPUS_PER_TASK="$OMP_NUM_THREADS"',
        "",
        "# Slurm warns this script alone. It hands the warning on, rattle ends its chunks and leaves,",
        "# and the job goes back into the queue. What is done is not computed again.",
        "warned=",
        "hand_on() {",
        "    warned=yes",
        '    kill -USR1 "$rattle"',
        "}",
        "trap hand_on USR1",
        "",
        f"{launch} {' '.join(arguments)} &",
        "rattle=$!",
        'wait "$rattle"',
        "code=$?",
        "# A warning cuts the wait short, so wait anew for the code of rattle itself.",
        'while [ -n "$warned" ]; do',
        '    wait "$rattle"',
        "    code=$?",
        '    kill -0 "$rattle" 2> /dev/null || break',
        "done",
        'if [ -n "$warned" ] && [ "$code" -gt 128 ]; then',
        f"    exec scontrol requeue {this_job}",
        "fi",
        'exit "$code"',
    ]


def _quoted(value: str) -> str:
    """A value of an #SBATCH line, which Slurm splits at blanks, # and quotes outside quotes."""
    return value if PLAIN.fullmatch(value) else f'"{value}"'
