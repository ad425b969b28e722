#!/usr/bin/env python3
"""Draw what a loose iteration tolerance does: a forged spectral line, and false reversals."""

from __future__ import annotations

import argparse
from pathlib import Path

import rattle
from rattle import command
from rattle.figures import style, tolerance

CASES = (("forged_line", "A forged spectral line", 6.0), ("false_reversals", "False reversals", 32.0))


def main() -> None:
    options = parse_options()
    pairs = []
    for key, name, last_ratio in CASES:
        paths = getattr(options, key)
        if paths is not None:
            loose, tight = map(rattle.read, paths)
            pairs.append(tolerance.Pair(name, loose, tight, last_ratio))
    if not pairs:
        raise command.CommandError("Nothing to draw: give --forged-line, --false-reversals or both.")
    with style.house_style():
        figure = tolerance.draw(pairs, options.periods, options.window)
        for path in style.save(figure, options.output, "tolerance"):
            print(path)


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Compare the same motion at a loose and a tight tolerance: histories and spectra of the "
        "acceleration, as tolerance.png and tolerance.pdf."
    )
    for key, name, _ in CASES:
        parser.add_argument(
            f"--{key.replace('_', '-')}",
            nargs=2,
            type=Path,
            metavar=("LOOSE", "TIGHT"),
            help=f"two result files for the column '{name}'",
        )
    parser.add_argument("--output", type=Path, default=Path("."), metavar="DIR", help="where the figure goes")
    parser.add_argument(
        "--periods", type=command.positive, default=3, metavar="N", help="periods that the histories show (3)"
    )
    parser.add_argument(
        "--window",
        type=command.positive,
        metavar="N",
        help="periods behind the spectra, by default those that the program judged",
    )
    return parser.parse_args()


if __name__ == "__main__":
    command.run(main)
