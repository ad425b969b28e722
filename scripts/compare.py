#!/usr/bin/env python3
"""Print the summaries of several scenes side by side, or lay measured order cuts over those of a campaign."""

from __future__ import annotations

import argparse
from pathlib import Path

import rattle
from rattle import command, table
from rattle.figures.options import common_options
from rattle.summary import comparison_table


def main() -> None:
    options = parse_options()
    if options.measured is not None:
        return lay_over(options)
    for name, unsaid in vars(common_options().parse_args([])).items():
        if getattr(options, name) != unsaid:
            raise command.CommandError(f"--{name.replace('_', '-')} is for the figure of --measured.")
    paths = [path.with_suffix(".summary.nml") if path.suffix == ".rattle" else path for path in options.paths]
    rows = comparison_table([rattle.read_summary(path) for path in paths])
    print(table.markdown(rows) if options.markdown else table.plain(rows))


def lay_over(options: argparse.Namespace) -> None:
    """Draw the measured cuts over the computed ones, and tell by how much they differ."""
    from rattle.figures import orders  # matplotlib only where a figure is drawn

    if len(options.paths) != 1:
        raise command.CommandError("--measured needs one result: a campaign over shaft.speed_rpm.")
    if options.markdown:
        raise command.CommandError("--markdown is for the table of summaries, not for --measured.")
    orders.run(argparse.Namespace(**vars(options), result=options.paths[0]))


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Print a table with a column for each scene; '-' is what a summary does not know. "
        "With --measured: draw order cuts of a test bench over those of a campaign over the speed of the "
        "shaft, and tell by how much the levels differ.",
        parents=[common_options()],
    )
    parser.add_argument(
        "paths",
        nargs="+",
        type=Path,
        metavar="SUMMARY|RESULT",
        help="NAME.summary.nml, or NAME.rattle beside it",
    )
    parser.add_argument("--markdown", action="store_true", help="print the table in Markdown")
    parser.add_argument(
        "--measured",
        type=Path,
        metavar="FILE.csv",
        help="columns speed_rpm and order_O with amplitudes of order O [m/s2]; RESULT is then a campaign",
    )
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
