#!/usr/bin/env python3
"""Classify the motions of result files: idle, creep, quiet, irregular or subharmonic."""

from __future__ import annotations

import argparse
import csv
from functools import partial
from pathlib import Path
from typing import Any

import rattle
from rattle import command, outputs, table
from rattle.verdict import THRESHOLDS, classify

MEASURES = (
    ("rattle_class", "class", "s"),
    ("harmonic_count", "harmonics", "d"),
    ("harmonic_distortion", "distortion", ".4f"),
    ("irregular_fraction", "irregular", ".2e"),
    ("reversals_per_period", "reversals a period", ".4g"),
)


def main() -> int:
    options = parse_options()
    if options.output:
        outputs.check([options.output], overwrite=options.overwrite, inputs=options.results)
    overrides = {name: getattr(options, name) for name in THRESHOLDS}
    rows: list[dict[str, Any]] = []
    code = command.COMPLETE
    for path in options.results:
        try:
            result = rattle.read(path)
            command.note_open(result)
            verdict = classify(result, options.periods, overrides)
            measures = {key: verdict[key] for key, _, _ in MEASURES}
            rows.append({"file": str(path), "scene": result.scene_name, **measures})
        except (rattle.ResultError, rattle.SummaryError) as fault:
            code = command.complain(str(fault))
    if rows:
        print(table.plain([heads(), *map(cells, rows)]))
        if options.output:
            files = [(options.output, partial(save, rows=rows))]
            outputs.write(files, overwrite=options.overwrite, inputs=options.results)
    return code


def heads() -> list[str]:
    return ["scene", *(head for _, head, _ in MEASURES)]


def cells(row: dict[str, Any]) -> list[str]:
    return [row["scene"], *(format(row[key], form) for key, _, form in MEASURES)]


def save(path: Path, rows: list[dict[str, Any]]) -> None:
    """All measures in full precision, a row for each file."""
    with path.open("w", newline="", encoding="utf-8", errors="surrogateescape") as stream:
        writer = csv.DictWriter(stream, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Classify result files over the window and with the thresholds of their resolved input. "
        "A file that cannot be classified is named, and the others still are."
    )
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT", help="result file, NAME.rattle")
    parser.add_argument("--output", type=Path, metavar="FILE.csv", help="also save the table as CSV")
    outputs.add_option(parser)
    parser.add_argument(
        "--periods", type=command.positive, metavar="N", help="whole periods at the end that are judged"
    )
    parser.add_argument(
        "--harmonic-threshold",
        type=command.finite,
        metavar="X",
        help="a harmonic counts above X times the first harmonic, or of several forced ones the largest",
    )
    parser.add_argument(
        "--idle-harmonics", type=command.positive, metavar="N", help="idle from this many harmonics on"
    )
    parser.add_argument(
        "--quiet-limit", type=command.finite, metavar="X", help="quiet below this harmonic distortion"
    )
    parser.add_argument(
        "--irregular-limit",
        type=command.finite,
        metavar="X",
        help="irregular, or subharmonic if known to repeat, above this fraction between harmonics",
    )
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
