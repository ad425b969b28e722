#!/usr/bin/env python3
"""Campaigns on a cluster and after it: job scripts, joining parts, state, export, single scenes again."""

from __future__ import annotations

import argparse
import math
import re
import shlex
from collections import Counter
from functools import partial
from pathlib import Path

import numpy as np

import rattle
from rattle import codes, command, job_script, outputs, rerun, table
from rattle.campaign_result import Campaign
from rattle.namelist import NamelistError, parse
from rattle.solve import find_program

NAME = re.compile(r"[A-Za-z0-9._-]+")
DIRECTIVE_SAFE = re.compile(r'[^"\n%\\]*')


def main() -> int | None:
    options = parse_options()
    return options.act(options)


def slurm(options: argparse.Namespace) -> None:
    """Write a job script."""
    try:
        groups = parse(options.input.read_text(encoding="utf-8"))
    except UnicodeDecodeError:
        raise command.CommandError(f"{options.input} is not an input: it is not plain text.") from None
    except NamelistError as fault:
        raise command.CommandError(f"{options.input} cannot be read: {fault}") from None
    if "campaign" not in groups:
        raise command.CommandError(f"{options.input} has no group &campaign.")
    name = str(groups.get("scene", {}).get("name") or options.input.stem).strip()
    if not NAME.fullmatch(name):
        raise command.CommandError(f"'{name}' cannot name a job: letters, digits, . _ - only.")
    check_times(options.time, options.signal_seconds)
    results = None if options.output is None else str(options.output)
    job = job_script.Job(
        input_file=options.input,
        name=name,
        program=options.program or find_program(),
        working_directory=Path.cwd(),
        log_directory=Path() if options.output is None else options.output,
        results=results,
        parts=options.array,
        ranks=options.ranks,
        threads=options.threads,
        time=options.time,
        signal_seconds=options.signal_seconds,
        partition=options.partition,
        account=options.account,
        memory=options.memory,
        modules=options.module,
        launcher=options.launcher,
    )
    for place in (job.working_directory, job.log_directory):
        if not DIRECTIVE_SAFE.fullmatch(str(place)):
            raise command.CommandError(
                f'Slurm cannot take the directory {place}: it has one of " % \\ in it.'
            )
    script = options.script or (options.output or Path()) / f"{name}.slurm"
    files = [(script, outputs.text_writer(job_script.text(job)))]
    outputs.write(files, overwrite=options.overwrite, inputs=[options.input])
    # Slurm drops a job, without a word, whose directory of logs is absent.
    job.log_directory.mkdir(parents=True, exist_ok=True)
    print(script)
    command.note(f"submit it with: sbatch {shlex.quote(str(script))}")
    if options.array:
        first, last = (job_script.part_name(name, part, options.array) for part in (1, options.array))
        command.note(f"then join {first} to {last} with: campaign.py merge PART... --output {name}.rattle")


def check_times(time: str | None, signal_seconds: int) -> None:
    """Refuse a warning that would come before the start."""
    limit = None if time is None else job_script.seconds_of(time)
    if limit is None:
        command.note(
            "without a --time limit Slurm gives no warning before the partition's own limit, if it has one."
        )
        return
    warning = signal_seconds + job_script.CLOCK_GRAIN
    if limit <= warning:
        raise command.CommandError(
            f"a time limit of {time} leaves no time to compute: Slurm may warn {warning} s before it "
            f"(--signal-seconds and a minute)."
        )


def merge_parts(options: argparse.Namespace) -> None:
    """Join parts."""
    from rattle.merge import merge

    outputs.check([options.output], overwrite=options.overwrite)
    count = merge(options.parts, options.output)
    print(options.output)
    command.note(f"{len(options.parts)} parts joined, {count}.")


def export(options: argparse.Namespace) -> None:
    """Write another format."""
    from rattle.exports import CAMPAIGN_WRITERS

    campaign = opened(options.file)
    ending, write = CAMPAIGN_WRITERS[options.to]
    output = options.output or campaign.path.with_suffix(ending)
    files = [(output, partial(write, campaign))]
    outputs.write(files, overwrite=options.overwrite, inputs=[campaign.path], make_folders=False)
    print(output)


def run_again(options: argparse.Namespace) -> None:
    """Write single scenes as inputs."""
    campaign = opened(options.file)
    if options.scenes:
        rows = rows_of(campaign, options.scenes)
    elif options.failed:
        rows = rerun.failed_rows(campaign, options.failed)
    else:
        rows = rerun.extreme_rows(campaign, options.by, options.worst, smallest=options.smallest)
    if len(rows) == 0:
        raise command.CommandError(f"{options.file} holds no such scene.")
    wanted = options.failed or options.worst
    if not options.scenes and len(rows) < wanted:
        command.note(f"there are only {len(rows)} such scenes.")
    directory = options.output or campaign.path.with_name(f"{campaign.name}_scenes")
    files = rerun.inputs(campaign, list(rows), directory, options.results)
    print(*outputs.write(files, overwrite=options.overwrite), sep="\n")


def rows_of(campaign: Campaign, scenes: list[int]) -> np.ndarray:
    """Rows of scenes given by number."""
    held = campaign["scene"]
    rows = []
    for scene in scenes:
        row = np.flatnonzero(held == scene)
        if row.size == 0:
            raise command.CommandError(f"{campaign.path} holds no scene {scene} that is done.")
        rows.append(int(row[0]))
    return np.array(rows)


def status(options: argparse.Namespace) -> int:
    """Say how far campaigns are."""
    code = command.COMPLETE
    for position, path in enumerate(options.files):
        if position:
            print()
        try:
            campaign = rattle.read_campaign(path)
        except rattle.ResultError as fault:
            code = command.complain(str(fault))
            continue
        print(table.plain(state_rows(campaign)))
    return code


def state_rows(campaign: Campaign) -> list[list[str]]:
    """Two columns of text: what, and how much."""
    chunks = campaign.chunks
    done = int(campaign.done.sum())
    rows = [
        ["campaign", str(campaign.path)],
        ["state", "finished" if campaign.closed else "not finished; rattle --resume goes on"],
        ["chunks done", f"{int(chunks.done.sum())} of {chunks.checksums.size}"],
        ["scenes done", f"{done} of {campaign.row_count}{percent(done, campaign.row_count)}"],
    ]
    if campaign.parts > 1:
        rows.append(["part", f"{campaign.part} of {campaign.parts}"])
    for name, title in (("status", "status"), ("rattle_class", "class")):
        if name not in campaign:
            continue
        counts = Counter(codes.word(name, code) for code in campaign[name][campaign.done].tolist())
        rows += [
            [f"{title} {word}", f"{count}{percent(count, done)}"] for word, count in counts.most_common()
        ]
    if "status" in campaign:
        failures = int(campaign.failed.sum())
        rows.append(["failed", f"{failures}{percent(failures, done)}"])
    if "verified" in campaign:
        lacking = int((campaign["verified"][campaign.done] == 0.0).sum())
        rows.append(["not verified", f"{lacking}{percent(lacking, done)}"])
    return rows + progress_rows(campaign.path.with_suffix(".progress.nml"))


def progress_rows(path: Path) -> list[list[str]]:
    """What the program last said of its progress, if it did."""
    try:
        groups = parse(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return []
    except (OSError, NamelistError, UnicodeDecodeError):
        command.note(f"{path} cannot be read, perhaps because it is being written; it is left out.")
        return []
    rows = []
    for group in groups.values():
        for key, value in group.items():
            shown = f"{value:.6g}" if isinstance(value, float) and math.isfinite(value) else str(value)
            rows.append([f"progress: {key.replace('_', ' ')}", shown.strip()])
    return rows


def percent(count: int, whole: int) -> str:
    return f" ({100.0 * count / whole:.3g} %)" if whole else ""


def opened(path: Path) -> Campaign:
    """A campaign, with a word if it is not finished."""
    campaign = rattle.read_campaign(path)
    command.note_summary(campaign)
    if not campaign.closed:
        done = int(campaign.done.sum())
        are = "is" if done == 1 else "are"
        command.note(f"{path} is not finished; {done} of {campaign.row_count} scenes {are} done and used.")
    return campaign


def array_tasks(text: str) -> int:
    """The count of tasks of an array job, if a cluster may take so many."""
    count = command.positive(text)
    if count > job_script.MOST_ARRAY_TASKS:
        raise argparse.ArgumentTypeError(
            f"{text} tasks are more than any cluster takes; at most {job_script.MOST_ARRAY_TASKS} are allowed"
        )
    return count


def time_limit(text: str) -> str:
    try:
        job_script.seconds_of(text)
        return text
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"'{text}' is not a time such as 90 (minutes), 02:30:00, 1-12 (days-hours) or UNLIMITED"
        ) from None


def warning_time(text: str) -> int:
    """Seconds before a time limit that Slurm can warn at."""
    seconds = command.positive(text)
    if seconds > job_script.MOST_SIGNAL_SECONDS:
        raise argparse.ArgumentTypeError(f"Slurm warns at most {job_script.MOST_SIGNAL_SECONDS} s ahead")
    return seconds


def slurm_word(text: str) -> str:
    """Names of partitions or accounts: any that a line of a job script can hold."""
    if text and text.isprintable() and not set(text) & set(' "\\'):
        return text
    raise argparse.ArgumentTypeError(f"'{text}' is not a name that Slurm takes")


def memory_limit(text: str) -> str:
    if job_script.MEMORY.fullmatch(text):
        return text
    raise argparse.ArgumentTypeError(
        f"'{text}' is not an amount of memory such as 500M, 2G or 4096 (megabytes)"
    )


def scene_numbers(text: str) -> list[int]:
    return [command.positive(part.strip()) for part in text.split(",")]


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Campaigns on a cluster and after it. Each command has its own --help."
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    add_slurm(commands)
    add_merge(commands)

    files = commands.add_parser(
        "status", help="how far campaigns are", description="Say how far campaigns are."
    )
    files.add_argument("files", nargs="+", type=Path, metavar="FILE", help="campaign result or part of one")
    files.set_defaults(act=status)

    other = commands.add_parser(
        "export", help="CSV, Parquet, NetCDF or MAT", description="Write another format."
    )
    other.add_argument("file", type=Path, metavar="FILE", help="campaign result")
    other.add_argument("--to", required=True, choices=("csv", "parquet", "netcdf"), help="the format")
    other.add_argument("--output", type=Path, metavar="PATH", help="by default beside the campaign")
    outputs.add_option(other)
    other.set_defaults(act=export)

    add_rerun(commands)
    return command.parse(parser)


def add_slurm(commands: argparse._SubParsersAction) -> None:
    job = commands.add_parser(
        "slurm",
        help="write a job script",
        description="Write a job script that runs a campaign or thresholds as an array of parts (--array), "
        "as one MPI job (--ranks) or as one plain job, stops before the time limit, goes back into the queue "
        "and resumes.",
    )
    job.add_argument("input", type=Path, metavar="FILE.nml", help="input with a group &campaign")
    kind = job.add_mutually_exclusive_group()
    kind.add_argument(
        "--array", type=array_tasks, metavar="N", help="N tasks, each a part of the scenes or lines"
    )
    kind.add_argument("--ranks", type=command.positive, metavar="N", help="one job of N MPI ranks")
    job.add_argument("--threads", type=command.positive, default=1, metavar="N", help="threads a task (1)")
    job.add_argument(
        "--time",
        type=time_limit,
        metavar="TIME",
        help="time limit of the job as Slurm takes it: minutes, HH:MM:SS, D-HH:MM:SS, UNLIMITED, ...",
    )
    job.add_argument(
        "--signal-seconds",
        type=warning_time,
        default=120,
        metavar="S",
        help="warning before the time limit in seconds; Slurm may be a minute early (120)",
    )
    job.add_argument("--partition", type=slurm_word, metavar="P", help="partition of the cluster")
    job.add_argument("--account", type=slurm_word, metavar="A", help="account that pays for the job")
    job.add_argument("--memory", type=memory_limit, metavar="M", help="memory a thread, e.g. 500M, 2G")
    job.add_argument(
        "--module", action="append", default=[], metavar="M", help="environment module to load; several times"
    )
    job.add_argument("--output", type=Path, metavar="DIR", help="where results, logs and the script go")
    job.add_argument("--script", type=Path, metavar="PATH", help="the script, by default NAME.slurm")
    job.add_argument("--program", metavar="PATH", help="the program rattle, by default that of this folder")
    job.add_argument(
        "--launcher", default="srun", metavar="COMMAND", help="what starts the ranks, e.g. 'srun --mpi=pmix'"
    )
    outputs.add_option(job)
    job.set_defaults(act=slurm)


def add_merge(commands: argparse._SubParsersAction) -> None:
    parts = commands.add_parser(
        "merge",
        help="join the parts of an array job",
        description="Join the parts of a campaign or of thresholds into the file of one undivided run. Gaps, "
        "overlaps, different inputs and unfinished parts are refused.",
    )
    parts.add_argument("parts", nargs="+", type=Path, metavar="PART", help="NAME.part-K-of-N.rattle")
    parts.add_argument("--output", required=True, type=Path, metavar="FILE", help="the whole, NAME.rattle")
    outputs.add_option(parts)
    parts.set_defaults(act=merge_parts)


def add_rerun(commands: argparse._SubParsersAction) -> None:
    again = commands.add_parser(
        "rerun",
        help="single scenes as inputs",
        description="Write inputs of single scenes with their time series: the worst by a column, the first "
        "that failed, or those named.",
    )
    again.add_argument("file", type=Path, metavar="FILE", help="campaign result")
    choice = again.add_mutually_exclusive_group(required=True)
    choice.add_argument("--worst", type=command.positive, metavar="N", help="the N scenes largest in --by")
    choice.add_argument("--failed", type=command.positive, metavar="N", help="the first N scenes that failed")
    choice.add_argument("--scenes", type=scene_numbers, metavar="I,J", help="these scenes")
    again.add_argument(
        "--by", default="acceleration_maximum", metavar="COLUMN", help="(acceleration_maximum)"
    )
    again.add_argument("--smallest", action="store_true", help="the smallest in --by instead of the largest")
    again.add_argument(
        "--output", type=Path, metavar="DIR", help="by default NAME_scenes beside the campaign"
    )
    again.add_argument(
        "--results", default="results", metavar="DIR", help="output.directory of them (results)"
    )
    outputs.add_option(again)
    again.set_defaults(act=run_again)


if __name__ == "__main__":
    command.run(main)
