#!/usr/bin/env python3
"""Print the summaries of several scenes side by side."""

from __future__ import annotations

import argparse
from pathlib import Path

import rattle
from rattle import command, table
from rattle.summary import comparison_table


def main() -> None:
    options = parse_options()
    paths = [path.with_suffix(".summary.nml") if path.suffix == ".rattle" else path for path in options.paths]
    rows = comparison_table([rattle.read_summary(path) for path in paths])
    print(table.markdown(rows) if options.markdown else table.plain(rows))


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Print a table with a column for each scene; '-' is what a summary does not know."
    )
    parser.add_argument(
        "paths",
        nargs="+",
        type=Path,
        metavar="SUMMARY|RESULT",
        help="NAME.summary.nml, or NAME.rattle beside it",
    )
    parser.add_argument("--markdown", action="store_true", help="print the table in Markdown")
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
