#!/usr/bin/env python3
"""Say what differs between results; or lay measured order cuts over those of a campaign."""

from __future__ import annotations

import argparse
from pathlib import Path

import rattle
from rattle import command, outputs, table
from rattle.figures.options import common_options
from rattle.summary import comparison_table


def main() -> None:
    options = parse_options()
    if options.measured is not None:
        return lay_over(options)
    for name, unsaid in vars(common_options().parse_args([])).items():
        if name not in ("output", "overwrite") and getattr(options, name) != unsaid:
            raise command.CommandError(f"--{name.replace('_', '-')} is for the figure of --measured.")
    if options.output is not None:
        return write_page(options)
    if options.overwrite:
        raise command.CommandError("--overwrite is for the figure of --measured and the files of --output.")
    paths = [path.with_suffix(".summary.nml") if path.suffix == ".rattle" else path for path in options.paths]
    rows = comparison_table([rattle.read_summary(path) for path in paths])
    print(table.markdown(rows) if options.markdown else table.plain(rows))


def write_page(options: argparse.Namespace) -> None:
    """Write what differs as a page, and beside it as a CSV file."""
    from rattle.comparison.frame import write_csv
    from rattle.comparison.variant import read_variants
    from rattle.report import comparison  # matplotlib only where a figure is drawn

    if options.markdown:
        raise command.CommandError("--markdown is for the table of summaries, not for the page of --output.")
    is_page = options.output.suffix.lower() in (".html", ".htm")
    page = options.output if is_page else options.output / "comparison.html"
    table = page.with_suffix(".csv")
    outputs.check([page, table], overwrite=options.overwrite, inputs=options.paths)
    variants = read_variants(options.paths)
    text = command.readable(comparison.document(variants))
    files = [(page, outputs.text_writer(text)), (table, lambda path: write_csv(path, variants))]
    for path in outputs.write(files, overwrite=options.overwrite, inputs=options.paths):
        print(path)


def lay_over(options: argparse.Namespace) -> None:
    """Draw the measured cuts over the computed ones, with their differences."""
    from rattle.figures import orders  # matplotlib only where a figure is drawn

    if len(options.paths) != 1:
        raise command.CommandError("--measured needs one result: a campaign over shaft.speed_rpm.")
    if options.markdown:
        raise command.CommandError("--markdown is for the table of summaries, not for --measured.")
    options.output = options.output or Path()
    orders.run(argparse.Namespace(**vars(options), result=options.paths[0]))


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Print a table with a column for each scene; '-' is what a summary does not know. "
        "With --output FILE.html: write a page, and FILE.csv, on what differs between the first result, the "
        "base, and each other: in the inputs and in the answer, with errors, in percent and dB; gearboxes "
        "pair by pair and together, maps in one scale with their difference. report.py has the same of "
        "several results of one kind. "
        "With --measured: draw order cuts of a test bench over those of a campaign over the speed of the "
        "shaft, with the differences of level.",
        parents=[common_options()],
    )
    parser.add_argument(
        "paths",
        nargs="+",
        type=Path,
        metavar="SUMMARY|RESULT",
        help="NAME.summary.nml, or NAME.rattle beside it; for --output also campaigns, sweeps and "
        "thresholds, and of a gearbox NAME.summary.nml or the results of its pairs",
    )
    parser.add_argument("--markdown", action="store_true", help="print the table in Markdown")
    parser.add_argument(
        "--measured",
        type=Path,
        metavar="FILE.csv",
        help="columns speed_rpm, ascending, and order_O with amplitudes of order O, as in order_2 [m/s2]; "
        "other units of speed and acceleration are converted, an empty field is a gap; RESULT is then a "
        "campaign over shaft.speed_rpm",
    )
    parser.set_defaults(output=None)
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
