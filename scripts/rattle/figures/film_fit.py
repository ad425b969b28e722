"""How the coefficients of the film-thickness law (32) hang on the window of alpha p they are fitted over."""

from __future__ import annotations

from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rattle import command, kernels, table
from rattle.figures import style
from rattle.figures.fit import is_narrow

DESCRIPTION = (
    "Fit the film-thickness law (32) to Reynolds piezo-viscous films over windows of alpha p, and judge the "
    "printed coefficients on the same films. Prints a table and draws 'film_fit'. A range is LEAST,LARGEST; "
    "write --squeeze-ratio=-5e-4,5e-4, with '='."
)
Window = tuple[float, float]  # least and largest alpha p of the films
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


@dataclass(frozen=True)
class Reading:
    """A way to read the groups of (32): what pressure and load group are multiplied with."""

    words: str
    pressure_factor: float
    load_factor: float
    line: dict[str, object]


# With u* of u1 + u2 and the pressure of their mean, p is half of what (6) gives for u*; so is the load group
# of (20) where its u is the sum too.
READINGS = (
    Reading("p as printed", 1.0, 1.0, {"color": "#56B4E9", "linewidth": 3.0}),
    Reading("p halved", 0.5, 1.0, {"color": "#D55E00", "linewidth": 1.5}),
    Reading("p and W halved", 0.5, 0.5, {"color": "#000000", "linestyle": (0, (1.2, 2.2))}),
)


@dataclass(frozen=True)
class Ranges:
    """Least and largest h*, w* and u* of the films; no range of u* takes all that alpha p gives."""

    film_ratio: tuple[float, float]
    squeeze_ratio: tuple[float, float]
    speed_group: tuple[float, float] | None

    def words(self) -> str:
        parts = [("h^*", self.film_ratio), ("w^*", self.squeeze_ratio)]
        if self.speed_group:
            parts.append(("u^*", self.speed_group))
        return ", ".join(rf"${name}$ from {_power(low)} to {_power(high)}" for name, (low, high) in parts)


@dataclass(frozen=True)
class Fit:
    """The law of one window, and how far the printed one is from the same films."""

    reading: Reading
    window: Window
    films: int
    fit: kernels.FilmFit
    printed: kernels.LawError


def add_options(parser: ArgumentParser) -> None:
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


def run(options: Namespace) -> None:
    ranges = Ranges(options.film_ratio, options.squeeze_ratio, options.speed_group)
    upper = options.upper_end
    if not options.film_ratio[0] < options.film_ratio[1]:
        raise command.CommandError("A single h* determines no law; give --film-ratio a range.")
    try:
        fits, curves = (
            [fit_window(ranges, reading, window) for reading in READINGS for window in chosen]
            for chosen in (options.alpha_p, windows(upper))
        )
    except ValueError as fault:
        raise command.CommandError(f"The ranges cannot be used: {fault}.") from None
    with style.house_style():
        made = draw(curves, ranges, upper, is_narrow(options.width))
        for path in style.save([("film_fit", made)], options):
            command.note(str(path))
    rows = table_rows(fits)
    print(table.markdown(rows) if options.markdown else table.plain(rows))


def span(text: str) -> tuple[float, float]:
    values = [command.finite(part) for part in text.split(",")]
    if len(values) != 2 or values[0] > values[1]:
        raise ArgumentTypeError(f"'{text}' is not a range LEAST,LARGEST")
    return values[0], values[1]


def fraction(text: str) -> float:
    value = command.finite(text)
    if not 0.0 < value <= 1.0:
        raise ArgumentTypeError(f"'{text}' is not a number above 0 and up to 1")
    return value


def fit_window(ranges: Ranges, reading: Reading, window: Window) -> Fit:
    """Fit (32) to the Reynolds films of one window."""
    points = kernels.sample_film_window(
        ranges.film_ratio,
        ranges.squeeze_ratio,
        window,
        pressure_factor=reading.pressure_factor,
        load_factor=reading.load_factor,
    )
    if ranges.speed_group:
        low, high = ranges.speed_group
        kept = (points.speed_group >= low) & (points.speed_group <= high)
        points = kernels.FilmPoints(*(column[kept] for column in points))
    films = points.film_ratio.size
    fit = kernels.fit_film_law(*points) if films > 4 else None
    if fit is None or not fit.unique:
        raise command.CommandError(
            f"The window {window[0]:g} < alpha p < {window[1]:g} ({reading.words}) holds {films} films, "
            "which do not determine the four coefficients; widen the ranges."
        )
    return Fit(reading, window, films, fit, kernels.judge_film_law(kernels.PUBLISHED_FILM_LAW, *points))


def table_rows(fits: Sequence[Fit]) -> list[list[str]]:
    """Rows of text: a window each, and the printed law last."""
    head = ["reading", "alpha p", "films", "c", "a of u*", "b of W", "s of w*", "rms", "R2"]
    rows = [[*head, "rms printed", "bias printed"]]
    for one in fits:
        law, error = one.fit.law, one.fit.error
        rows.append(
            [
                one.reading.words,
                f"{one.window[0]:g} to {one.window[1]:g}",
                str(one.films),
                f"{law.factor:.3g}",
                f"{law.speed_exponent:.3f}",
                f"{law.load_exponent:.3f}",
                f"{law.squeeze_factor:.1f}",
                f"{error.rms:.3f}",
                f"{error.r_squared:.3f}",
                f"{one.printed.rms:.3f}",
                f"{one.printed.bias:+.3f}",
            ]
        )
    printed = [format(value, "g") for value in kernels.PUBLISHED_FILM_LAW]
    rows.append(["(32) as printed", "", "", *printed, "", "", "", ""])
    return rows


def draw(fits: Sequence[Fit], ranges: Ranges, upper_end: float, narrow: bool = False) -> Figure:
    """Coefficients and errors over the lower end of the window; a curve for each reading."""
    printed = kernels.PUBLISHED_FILM_LAW
    figure = Figure(figsize=(5.0, 7.4) if narrow else (7.4, 5.0))
    grid = figure.subplots(*((3, 2) if narrow else (2, 3)), sharex=True)
    panels = list(grid.flat)
    _panel(panels[0], "(a) Exponent $a$ of $u^*$", fits, lambda one: one.fit.law.speed_exponent)
    _panel(panels[1], "(b) Exponent $b$ of $\\bar{W}$", fits, lambda one: one.fit.law.load_exponent)
    _panel(panels[2], "(c) Factor $s$ of $w^*$", fits, lambda one: one.fit.law.squeeze_factor)
    _panel(panels[3], "(d) Factor $c$", fits, lambda one: one.fit.law.factor)
    _panel(panels[4], "(e) rms of $\\ln h^*$, fitted law", fits, lambda one: one.fit.error.rms)
    _panel(panels[5], "(f) rms of $\\ln h^*$, printed law", fits, lambda one: one.printed.rms)
    values = (printed.speed_exponent, printed.load_exponent, printed.squeeze_factor, printed.factor)
    for axes, value in zip(panels, values, strict=False):
        axes.axhline(value, **_PRINTED_LINE)
    panels[3].set_yscale("log")
    for axes in panels[4:]:
        axes.set_ylim(bottom=0.0)
    for axes in grid[-1]:
        axes.set_xlabel(r"Least $\alpha p$ of the window")
    handles = [Line2D([], [], **reading.line) for reading in READINGS] + [Line2D([], [], **_PRINTED_LINE)]
    words = [reading.words for reading in READINGS] + ["(32) as printed"]
    figure.legend(handles, words, loc="outside lower center", ncols=4)
    figure.suptitle(_title(ranges, upper_end), x=0.01, ha="left", fontsize=9.5)
    return figure


_PRINTED_LINE = {"color": style.FAINT_COLOUR, "linewidth": 1.0, "linestyle": (0, (6, 3))}


def _panel(axes: Axes, title: str, fits: Sequence[Fit], value: Callable[[Fit], float]) -> None:
    for reading in READINGS:
        own = [one for one in fits if one.reading is reading]
        axes.plot([one.window[0] for one in own], [value(one) for one in own], **reading.line)
    axes.set_title(title, fontsize=9)
    axes.margins(x=0.02)


def _title(ranges: Ranges, upper_end: float) -> str:
    first = (
        r"The law $h_0^* = c\,u^{*a}\,\bar{W}^b\,e^{s w^*}$ of (32), fitted to Reynolds films"
        rf" up to $\alpha p = {upper_end:g}$"
    )
    second = ranges.words()
    if ranges.speed_group is None:
        second += "; a factor of $p$ or $\\bar{W}$ only moves $c$"
    return f"{first}\n{second}"


def _power(value: float) -> str:
    return "0" if value == 0.0 else style.power_words(value)


def windows(upper_end: float) -> list[Window]:
    """Windows for the curves, denser towards both ends, where the coefficients turn."""
    shares = 0.5 - 0.5 * np.cos(np.pi * np.arange(60) / 62)
    return [(float(share) * upper_end, upper_end) for share in shares]
