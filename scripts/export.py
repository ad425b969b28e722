#!/usr/bin/env python3
"""Write a result file as CSV, NetCDF or MAT, exactly: every number reads back as the same float64."""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path
from typing import TextIO

import numpy as np

import rattle
from rattle import codes, command, outputs

ROWS_AT_ONCE = 10000
STANDARD_OUTPUT = Path("-")
FORMATS = {"csv": ".csv", "netcdf": ".nc"}
OTHER_FORMATS = (".parquet", ".h5", ".xlsx", ".json")


def main() -> None:
    options = parse_options()
    result = rattle.read(options.result)
    names = options.columns or list(result)
    for name in names:
        result[name]  # an unknown name or damaged rows end the work before a file is touched
    command.note_open(result)
    ending = (options.output or Path()).suffix.lower()
    form = options.to or next((name for name, own in FORMATS.items() if own == ending), "csv")
    output = options.output or result.path.with_suffix(FORMATS[form])
    if options.output is None and output.exists() and output.name in read_names(result):
        raise command.CommandError(
            f"{output} is called like a file that {result.path} was computed from; give another --output."
        )
    if ending in OTHER_FORMATS:
        raise command.CommandError(
            f"{output}: this script writes {', '.join(FORMATS)}; "
            "'campaign.py export --to parquet' writes another format of campaigns."
        )
    if output == STANDARD_OUTPUT:
        if form != "csv":
            raise command.CommandError(f"{form} needs a file; standard output takes CSV.")
        write(sys.stdout, result, names, options.stride)
        return
    if form != "csv" and (options.columns or options.stride > 1) and result.task == "campaign":
        raise command.CommandError(
            "--columns and --stride choose from a series; a campaign is written whole."
        )
    writer = write_csv if form == "csv" else write_other
    files = [(output, lambda path: writer(path, result, names, options.stride, form))]
    outputs.write(files, overwrite=options.overwrite, inputs=[result.path], make_folders=False)
    print(output)


def read_names(result: rattle.Result) -> set[str]:
    """Names of the files that the input of a result reads, without their folders."""
    return {
        Path(value.strip()).name
        for keys in result.input.values()
        for value in keys.values()
        if isinstance(value, str) and "." in value
    }


def write_csv(path: Path, result: rattle.Result, names: list[str], stride: int, form: str) -> None:
    with path.open("w", newline="", encoding="utf-8") as stream:
        write(stream, result, names, stride)


def write_other(path: Path, result: rattle.Result, names: list[str], stride: int, form: str) -> None:
    """NetCDF or MAT."""
    from rattle import exports

    if result.task == "campaign":
        exports.CAMPAIGN_WRITERS[form][1](rattle.read_campaign(result.path), path)
    else:
        exports.SERIES_WRITERS[form](result, path, names, stride)


def write(stream: TextIO, result: rattle.Result, names: list[str], stride: int) -> None:
    """A head of name[unit], then every `stride`-th row; float repr is the shortest exact form.

    The extreme rows are put in by time, all of them. Columns of codes come again as words, behind the others.
    """
    coded = [(place, name) for place, name in enumerate(names) if codes.quantity_of(name) in codes.CODES]
    writer = csv.writer(stream, lineterminator="\n")
    head = [f"{name}[{result.units[name]}]" for name in names]
    writer.writerow([*head, *(f"{name}_word" for _, name in coded)])
    extremes = np.column_stack([result.extremes[name] for name in names])
    if "time" in result:
        places = np.searchsorted(result["time"][::stride], result.extremes["time"], side="right")
    else:
        places = np.full(len(extremes), -1)
        if len(extremes):
            command.note(
                f"{result.path} has no column of times; its {len(extremes)} extreme rows are left out."
            )
    count = -(-result.row_count // stride)
    for start in range(0, count, ROWS_AT_ONCE):
        end = min(start + ROWS_AT_ONCE, count)
        block = np.column_stack([result[name][start * stride : end * stride : stride] for name in names])
        between = (places > start) & (places <= end)
        if between.any():
            block = np.insert(block, places[between] - start, extremes[between], axis=0)
        writer.writerows(
            [*row, *(codes.word(name, row[place]) for place, name in coded)] for row in block.tolist()
        )


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Write a result file as CSV with a head of name[unit], or as NetCDF."
    )
    parser.add_argument("result", type=Path, metavar="RESULT", help="result file, NAME.rattle")
    parser.add_argument(
        "--columns", type=command.names, metavar="NAME,NAME", help="the columns to write, all by default"
    )
    parser.add_argument("--to", choices=tuple(FORMATS), help="the format, by default that of --output")
    parser.add_argument(
        "--output",
        type=Path,
        metavar="FILE",
        help="FILE.csv or .nc, by default NAME.csv beside the result; '-' is standard output",
    )
    outputs.add_option(parser)
    parser.add_argument(
        "--stride", type=command.positive, default=1, metavar="N", help="write every N-th row only (1)"
    )
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
