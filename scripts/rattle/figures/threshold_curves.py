"""Thresholds as curves, also over a map that they divide."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from rattle.campaign_plan import GEAR
from rattle.campaign_result import Axis
from rattle.campaign_section import Section, short_name
from rattle.command import CommandError
from rattle.figures import style
from rattle.thresholds import Thresholds, words_of_criterion

DASHES = ("-", (0, (4, 1.2)), (0, (1.2, 1.0)))


def draw_over_map(axes: Axes, section: Section, found: Thresholds, place: int = 0) -> list[Line2D]:
    """Thresholds along one axis of a map over the other, as black curves with the bars of their ends.

    Returns their legend entry.
    """
    rows, other = of_section(section, found)
    upwards = found.key == section.free[1].key
    look = {"color": "black", "linewidth": 1.6, "linestyle": DASHES[place % len(DASHES)]}
    along = next(axis for axis in rows.axes if axis.key == other)
    crossed = rows.column("crossing") > 0
    for kind in dict.fromkeys(rows.kinds[crossed]):
        for x, y in curves(rows, along, crossed & (rows.kinds == kind)):
            axes.plot(*((x, y) if upwards else (y, x)), zorder=4, path_effects=style.HALO, **look)
    draw = axes.vlines if upwards else axes.hlines
    known = crossed & np.isfinite(rows.column("lower"))
    ends = (rows.column(name)[known] for name in ("lower", "upper"))
    draw(rows.column(other)[known], *ends, colors="black", linewidth=2.5, alpha=0.4, zorder=4)
    unsure = rows.uncertain
    marks = {"color": "black", "marker": "o", "markersize": 3.0, "linestyle": "", "zorder": 5}
    places = rows.column(other)[unsure], rows.values[unsure]
    axes.plot(*(places if upwards else places[::-1]), markerfacecolor="white", **marks)
    return [Line2D([], [], **look, label=f"threshold: {words_of_criterion(found)}")]


def of_section(section: Section, found: Thresholds) -> tuple[Thresholds, str]:
    """The thresholds that belong to a map, and the key along which they run there."""
    free = [axis.key for axis in section.free]
    path = found.result.path
    others = [key for key in free if key != found.key]
    if len(others) != 1 or others[0] not in found.varied:
        words = " and ".join(map(short_name, free))
        raise CommandError(f"{path} is of {short_name(found.key)}: its thresholds do not lie over {words}.")
    held = {}
    for axis in found.axes:
        if axis.key == others[0]:
            continue
        value = value_of(section, axis)
        if value is None:
            raise CommandError(f"{path} varies {short_name(axis.key)}, which the map does not.")
        held[axis.key] = float(axis.values[int(np.argmin(np.abs(axis.values - value)))])
    return found.held(held), others[0]


def value_of(section: Section, axis: Axis) -> float | None:
    """Where a map holds a key that thresholds vary."""
    if axis.key == GEAR:
        gears, name = section.campaign.gears, str(section.campaign.input["gear"].get("name", "")).strip()
        return float(gears.index(name) + 1) if name in gears else None
    return next((held.value for held in section.held if held.axis.key == axis.key), None)


def curves(found: Thresholds, axis: Axis, chosen: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Crossings of one kind joined from trace to trace, as long as neighbours have as many of them."""
    x, y = found.column(axis.key), found.values
    lines = [y[chosen & (x == value)] for value in axis.values]
    joined, start = [], 0
    for end in range(1, len(lines) + 1):
        if end < len(lines) and len(lines[end]) == len(lines[start]):
            continue
        part = np.array(lines[start:end])
        joined += [(axis.values[start:end], part[:, place]) for place in range(part.shape[1])]
        start = end
    return joined


def draw_bars(axes: Axes, x: np.ndarray, lower: np.ndarray, upper: np.ndarray, colour: str) -> None:
    """How far apart the ends of each crossing are."""
    known = np.isfinite(lower)
    axes.vlines(x[known], lower[known], upper[known], colors=colour, linewidth=2.5, alpha=0.4, zorder=3)
