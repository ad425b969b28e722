#!/usr/bin/env python3
"""Fit the film-thickness law (32) to exact films over windows of alpha p: a table and a figure."""

from __future__ import annotations

import argparse
from pathlib import Path

from rattle import command, table

WINDOWS = (
    (0.0, 0.5),
    (0.3, 0.5),
    (0.0, 1.0),
    (0.1, 1.0),
    (0.3, 1.0),
    (0.5, 1.0),
    (0.7, 1.0),
    (0.9, 1.0),
    (0.99, 1.0),
)


def main() -> None:
    options = parse_options()
    from rattle.figures import film_fit, style

    ranges = film_fit.Ranges(options.film_ratio, options.squeeze_ratio, options.speed_group)
    readings, upper = film_fit.READINGS, options.upper_end
    if not options.film_ratio[0] < options.film_ratio[1]:
        raise command.CommandError("A single h* determines no law; give --film-ratio a range.")
    try:
        fits, curves = (
            [film_fit.fit_window(ranges, reading, window) for reading in readings for window in windows]
            for windows in (options.alpha_p, film_fit.windows(upper))
        )
    except ValueError as fault:
        raise command.CommandError(f"The ranges cannot be used: {fault}.") from None
    with style.house_style():
        figure = film_fit.draw(curves, ranges, upper)
        for path in style.save(figure, options.output, "film_fit"):
            command.note(str(path))
    rows = film_fit.table_rows(fits)
    print(table.markdown(rows) if options.markdown else table.plain(rows))


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Fit the film-thickness law (32) to exact piezo-viscous films over windows of alpha p, "
        "and judge the printed coefficients on the same films. Prints a table and writes film_fit.png and "
        "film_fit.pdf. A range is LEAST,LARGEST; write --squeeze-ratio=-5e-4,5e-4, with '='."
    )
    parser.add_argument("--output", type=Path, default=Path("."), metavar="DIR", help="where the figure goes")
    parser.add_argument("--markdown", action="store_true", help="print the table in Markdown")
    parser.add_argument(
        "--film-ratio", type=span, default=(5e-5, 2e-4), metavar="RANGE", help="range of h* (5e-5,2e-4)"
    )
    parser.add_argument(
        "--squeeze-ratio", type=span, default=(-5e-4, 5e-4), metavar="RANGE", help="range of w* (-5e-4,5e-4)"
    )
    parser.add_argument(
        "--speed-group", type=span, metavar="RANGE", help="range of u*; by default all that alpha p gives"
    )
    parser.add_argument(
        "--alpha-p",
        type=span,
        nargs="+",
        default=WINDOWS,
        metavar="RANGE",
        help="windows of alpha p for the table, a line each",
    )
    parser.add_argument(
        "--upper-end", type=fraction, default=1.0, metavar="X", help="upper end of alpha p in the figure (1)"
    )
    return parser.parse_args()


def span(text: str) -> tuple[float, float]:
    values = [command.finite(part) for part in text.split(",")]
    if len(values) != 2 or values[0] > values[1]:
        raise argparse.ArgumentTypeError(f"'{text}' is not a range LEAST,LARGEST")
    return values[0], values[1]


def fraction(text: str) -> float:
    value = command.finite(text)
    if not 0.0 < value <= 1.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number above 0 and up to 1")
    return value


if __name__ == "__main__":
    command.run(main)
