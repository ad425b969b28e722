"""Figures 4a and 4b: stiffness and damping of the film over its thickness."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rattle.figures import film_points, style
from rattle.figures.film_points import PAPER_SPEED_GROUP, Choice, Curve
from rattle.result import Result, ResultError


@dataclass(frozen=True)
class Slope:
    """A slope of the load: its columns and what they are called."""

    quantity: str
    subject: str
    label: str


STIFFNESS = Slope(
    "stiffness", "Stiffness of the film, positive is resisting", r"Stiffness $-\partial W/\partial h_0$ [N/m]"
)
DAMPING = Slope(
    "damping",
    "Damping of the film, positive is resisting",
    r"Damping $-\partial W/\partial \dot{h}_0$ [N s/m]",
)

EXACT, PUBLISHED, PIEZO = "iso_viscous", "published", "piezo_viscous"
LINES = {EXACT: "-", PUBLISHED: (0, (5, 2)), PIEZO: (0, (1, 1.2))}
WORDS = {
    EXACT: "Reynolds iso-viscous",
    PUBLISHED: "published (26)-(28)",
    PIEZO: "Reynolds piezo-viscous",
}


def draw(points: Result, slope: Slope, choice: Choice) -> Figure:
    """One slope, published beside exact, and below it the ratio of the two iso-viscous ones."""
    speed_group = film_points.choose(points, "speed_group", choice.speed_group, PAPER_SPEED_GROUP)
    models = [EXACT, PUBLISHED] + [PIEZO] * (f"{slope.quantity}_{PIEZO}" in points)
    names = {model: f"{slope.quantity}_{model}" for model in models}
    fixed = {"speed_group": speed_group}
    found = film_points.curves(points, list(names.values()), "film_thickness", fixed)
    if max(curve["film_thickness"].size for curve in found) < 2:
        raise ResultError(f"{points.path} has a single film thickness; figure 4 needs several.")

    figure = Figure(figsize=(style.WIDTH + 0.9, 5.0))
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2.1, 1.0))
    for curve, colour in zip(found, film_points.colours(found), strict=True):
        film = 1e6 * curve["film_thickness"]
        for model, name in names.items():
            line = {"color": colour, "linestyle": LINES[model]}
            above.plot(film, np.where(curve[name] > 0.0, curve[name], np.nan), **line)
        below.plot(
            film, curve[names[PUBLISHED]] / curve[names[EXACT]], color=colour, linestyle=LINES[PUBLISHED]
        )
    above.set_yscale("log")
    above.set_xscale("log")
    _film_axis(below, found)
    below.axhline(1.0, color=style.FAINT_COLOUR, linewidth=0.7, zorder=0)
    below.set_ylabel("Published\nover exact [-]")
    above.set_ylabel(slope.label)
    _legends(above, found, models)
    figure.align_ylabels()
    held = film_points.scene_line(
        points, [style.power_words(speed_group, "u^*"), "the same $u$ in every film"]
    )
    above.set_title(f"{slope.subject}\n{held}{_remarks(found, names)}")
    return figure


def _film_axis(axes: Axes, found: Sequence[Curve]) -> None:
    films = 1e6 * np.concatenate([curve["film_thickness"] for curve in found])
    axes.set_xlim(films.min(), films.max())
    axes.set_xlabel(style.FILM_LABEL.replace("$h$", "$h_0$"))
    axes.xaxis.set_major_formatter("{x:g}")
    if films.max() / films.min() < 30.0:
        axes.xaxis.set_minor_formatter(_sparse)
        axes.tick_params(axis="x", which="minor", pad=5.0)  # as low as the labels of the longer ticks


def _sparse(value: float, _: int) -> str:
    """Labels of the minor ticks at 2, 3, 5 and 7 of each decade."""
    leading = f"{value:.0e}"[0]
    return f"{value:g}" if leading in "2357" else ""


def _legends(axes: Axes, found: Sequence[Curve], models: Sequence[str]) -> None:
    colours = film_points.colours(found)
    handles = [Line2D([], [], color=colour) for colour in colours]
    words = [film_points.squeeze_words(curve.squeeze_ratio) for curve in found]
    axes.figure.legend(
        handles,
        words,
        title=f"{film_points.SQUEEZE_TITLE}\nof the upper panel",
        loc="outside right upper",
        alignment="left",
    )
    kinds = [Line2D([], [], color=style.FORCE_COLOUR, linestyle=LINES[model]) for model in models]
    axes.legend(kinds, [WORDS[model] for model in models], loc="lower left", handlelength=2.6)


def _remarks(found: Sequence[Curve], names: dict[str, str]) -> str:
    """Lines of the title for what a logarithmic axis cannot show and where there is no film."""
    remarks = []
    for model, name in names.items():
        negative = sum(int((curve[name] <= 0.0).sum()) for curve in found)
        if negative:
            remarks.append(f"{WORDS[model]} is not positive at {negative} points, which are left out")
    if PIEZO in names:
        missing = sum(int(np.isnan(curve[names[PIEZO]]).sum()) for curve in found)
        total = sum(curve[names[PIEZO]].size for curve in found)
        if missing == total:
            remarks.append(r"$\alpha p \geq 1$ everywhere: no rigid piezo-viscous film")
        elif missing:
            remarks.append(r"The piezo-viscous curves end where $\alpha p$ reaches 1")
    return "".join(f"\n{remark}" for remark in remarks)
