#!/usr/bin/env python3
"""Write a result file as CSV, exactly: every number reads back as the same float64."""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path
from typing import TextIO

import numpy as np

import rattle
from rattle import command

ROWS_AT_ONCE = 10000
STANDARD_OUTPUT = Path("-")


def main() -> None:
    options = parse_options()
    result = rattle.read(options.result)
    names = options.columns or list(result.columns)
    for name in names:
        result.check_column(name)  # an unknown name ends the work before a file is touched
    command.note_open(result)
    output = options.output or result.path.with_suffix(".csv")
    if output == STANDARD_OUTPUT:
        write(sys.stdout, result, names, options.stride)
        return
    if output.exists() and output.samefile(result.path):
        raise command.CommandError(f"{output} is the result file itself; give another --output.")
    with output.open("w", newline="", encoding="utf-8") as stream:
        write(stream, result, names, options.stride)
    print(output)


def write(stream: TextIO, result: rattle.Result, names: list[str], stride: int) -> None:
    """A head of name[unit], then every `stride`-th row; float repr is the shortest exact form."""
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(f"{name}[{result.units[name]}]" for name in names)
    step = ROWS_AT_ONCE * stride
    for start in range(0, result.row_count, step):
        rows = slice(start, start + step, stride)
        writer.writerows(np.column_stack([result[name][rows] for name in names]).tolist())


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Write a result file as CSV with a head of name[unit].")
    parser.add_argument("result", type=Path, metavar="RESULT", help="result file, NAME.rattle")
    parser.add_argument(
        "--columns", type=command.names, metavar="NAME,NAME", help="the columns to write, all by default"
    )
    parser.add_argument(
        "--output",
        type=Path,
        metavar="FILE.csv",
        help="the CSV file; by default NAME.csv beside the result, '-' is standard output",
    )
    parser.add_argument(
        "--stride", type=command.positive, default=1, metavar="N", help="write every N-th row only (1)"
    )
    return parser.parse_args()


if __name__ == "__main__":
    command.run(main)
