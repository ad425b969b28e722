"""Figures 3, 4a, 4b and 5 of the paper: which of them the result of a film task gives."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

import rattle
from rattle import command
from rattle.figures import film_points, film_pressures, film_slopes, style
from rattle.figures.fit import is_narrow
from rattle.result import ResultError

DESCRIPTION = (
    "Draw figures 3, 4a, 4b and 5 of the paper from the result of a film task. Figures 3 and 5 need the "
    "profiles, NAME.profiles.rattle beside NAME.rattle."
)
NUMBERS = (3, 4, 5)


def add_options(parser: ArgumentParser) -> None:
    parser.add_argument("result", type=result_path, metavar="RESULT", help="result file, NAME.rattle")
    parser.add_argument(
        "--figures",
        type=command.some_of(NUMBERS),
        metavar="3,4,5",
        help="the figures to draw; by default all that the result holds",
    )
    parser.add_argument(
        "--film-ratio",
        type=command.positive_number,
        metavar="X",
        help="film ratio h* of figures 3 and 5; by default the one nearest to the 70e-6 of the paper",
    )
    parser.add_argument(
        "--speed-group",
        type=command.positive_number,
        metavar="X",
        help="speed group u*; by default the one nearest to the 0.9e-6 of the paper, in figure 5 up to three",
    )


def run(options: Namespace) -> int:
    profiles = options.result.with_suffix(".profiles.rattle")
    if options.result.exists() or not profiles.exists():
        rattle.read(options.result).require_task("film")
    choice = film_points.Choice(options.film_ratio, options.speed_group, is_narrow(options.width))
    numbers = options.figures or NUMBERS
    makers = [(stem, maker) for number, stem, maker in FIGURES if number in numbers]
    scene = options.result.name.removesuffix(".rattle").removesuffix(".profiles")
    drawn: list[tuple[str, Figure]] = []
    missed = 0
    with style.house_style():
        for stem, maker in makers:
            try:
                figure = maker(options.result, choice)
            except ResultError as fault:
                missed += 1
                command.complain(f"{stem} cannot be drawn: {fault}")
                continue
            drawn.append((f"{stem}_{scene}", figure))
        if drawn:
            print(*style.save(drawn, options), sep="\n")
    # Without a wish for certain figures, what the result holds is enough.
    return command.BAD_INPUT if missed and (options.figures or not drawn) else command.COMPLETE


def figure_3(path: Path, choice: film_points.Choice) -> Figure:
    return film_pressures.draw_iso_viscous(film_points.read_profiles(path), choice)


def figure_4a(path: Path, choice: film_points.Choice) -> Figure:
    return film_slopes.draw(film_points.read_points(path), film_slopes.STIFFNESS, choice)


def figure_4b(path: Path, choice: film_points.Choice) -> Figure:
    return film_slopes.draw(film_points.read_points(path), film_slopes.DAMPING, choice)


def figure_5(path: Path, choice: film_points.Choice) -> Figure:
    return film_pressures.draw_piezo_viscous(film_points.read_profiles(path), choice)


FIGURES: tuple[tuple[int, str, Callable[[Path, film_points.Choice], Figure]], ...] = (
    (3, "figure_03", figure_3),
    (4, "figure_04a", figure_4a),
    (4, "figure_04b", figure_4b),
    (5, "figure_05", figure_5),
)


def result_path(text: str) -> Path:
    """The table of the film task, also when its profiles are named."""
    return Path(
        text.removesuffix(".profiles.rattle") + ".rattle" if text.endswith(".profiles.rattle") else text
    )
