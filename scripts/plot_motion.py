#!/usr/bin/env python3
"""Draw figures 6 to 10 of the paper from result files."""

from __future__ import annotations

import argparse
from pathlib import Path

import rattle
from rattle import command
from rattle.figures import catalogue, style


def main() -> None:
    options = parse_options()
    results = [rattle.read(path) for path in options.results]
    for result in results:
        result.require_task("motion")
        command.note_open(result)
    make = catalogue.overlay_figures if options.overlay else catalogue.single_figures
    extent = catalogue.Extent(options.periods, options.window)
    drawn = 0
    with style.house_style():
        for stem, figure in make(results, options.figures, extent):
            drawn += 1
            for path in style.save(figure, options.output, stem):
                print(path)
    if drawn == 0:
        laws = " and ".join(sorted({result.law for result in results}))
        numbers = ", ".join(map(str, options.figures))
        raise command.CommandError(f"Nothing to draw: {laws} results give no figure {numbers}.")


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Draw figures 6 to 10 of the paper from result files. An iso-viscous result gives "
        "figures 06, 07, 08 and 10a, a piezo-viscous one 09 and 10b, each as PNG and PDF, with the scene's "
        "name behind the number."
    )
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT", help="result file, NAME.rattle")
    parser.add_argument("--output", type=Path, default=Path("."), metavar="DIR", help="where the figures go")
    parser.add_argument(
        "--figures",
        type=command.one_of_numbers(catalogue.NUMBERS),
        default=catalogue.NUMBERS,
        metavar="6,7,8,9,10",
        help="the figures to draw, all by default",
    )
    parser.add_argument(
        "--periods", type=command.positive, default=4, metavar="N", help="periods that the histories show (4)"
    )
    parser.add_argument(
        "--window",
        type=command.positive,
        metavar="N",
        help="periods behind the spectra, by default those that the program judged",
    )
    parser.add_argument("--overlay", action="store_true", help="draw all results in the same figures")
    return parser.parse_args()


if __name__ == "__main__":
    command.run(main)
