#!/usr/bin/env python3
"""Turn recordings of a test bench into what an input takes."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

from rattle import command, table

TASKS = {
    "list": "names, units, samples and ranges of the channels",
    "cycle": "the mean cycle of a steady recording (also what `recording.py FILE ...` does)",
    "run-up": "the run-up table of the orders of a recording over speed",
    "encoders": "relative angle, backlash and impacts from two encoders",
}


def main() -> int:
    try:
        from rattle.recordings import channels, cycle_command, encoders, order_tracking
    except ModuleNotFoundError as fault:
        raise command.CommandError(
            f"this needs the package {fault.name}: pip install 'rattle[recordings]' brings it."
        ) from None

    parser = argparse.ArgumentParser(
        description="Turn recordings of a test bench (CSV, MDF, TDMS, UFF 58, MAT, HDF5) into what an input "
        "takes; see input/MEASURED.md."
    )
    tasks = parser.add_subparsers(dest="task", required=True, metavar="TASK")
    parts = {name: tasks.add_parser(name, help=words, description=words) for name, words in TASKS.items()}
    for part in parts.values():
        part.set_defaults(parser=part)
    parts["list"].add_argument("files", nargs="+", type=Path, metavar="FILE", help="recordings")
    parts["list"].add_argument("--rate", type=command.positive_number, metavar="HZ", help=channels.RATE)
    cycle_command.add_arguments(parts["cycle"])
    order_tracking.add_arguments(parts["run-up"])
    encoders.add_arguments(parts["encoders"])
    if len(sys.argv) > 1 and sys.argv[1] not in (*TASKS, "-h", "--help"):
        sys.argv.insert(1, "cycle")
    options = command.parse(parser)
    runs = {"list": show, "cycle": cycle_command.run, "run-up": order_tracking.run, "encoders": encoders.run}
    return runs[options.task](options)


def show(options: argparse.Namespace) -> int:
    """The channels of each file."""
    from rattle.recordings import read_channels, units

    rows = [["", "channel", "unit", "samples", "from [s]", "to [s]", "least", "largest", "gaps"]]
    notes: list[str] = []
    for path in options.files:
        for number, channel in enumerate(read_channels(path, rate=options.rate, notes=notes), 1):
            ends = [f"{channel.time[at]:.6g}" if channel.has_time else "-" for at in (0, -1)]
            finite = channel.values[np.isfinite(channel.values)]
            span = [f"{value:.6g}" for value in (finite.min(), finite.max())] if finite.size else ["-", "-"]
            count = len(channel.values)
            rows.append(
                [f"{number}", channel.name, units.shown(channel.unit) or "-", f"{count}", *ends, *span]
            )
            rows[-1].append(f"{count - finite.size}")
    print(table.plain(rows))
    for note in notes:
        print(note)
    return command.COMPLETE


if __name__ == "__main__":
    command.run(main)
