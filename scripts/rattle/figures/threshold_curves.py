"""Thresholds as curves, also over a map that they divide."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rattle.campaign_plan import GEAR, LOGARITHMIC
from rattle.campaign_result import Axis
from rattle.campaign_section import Section, short_name
from rattle.command import CommandError
from rattle.figures import style
from rattle.thresholds import Thresholds, words_of_criterion

EITHER = "either is possible"
# A curve of fewer steps than these has no usual one.
LEAST_STEPS = 4
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
    return [unjoined(found, x, found.values[rows]) for x, rows in joined_rows(found, axis, chosen)]


def joined_rows(found: Thresholds, axis: Axis, chosen: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """The values of a key along each curve, and the places of its rows."""
    x = found.column(axis.key)
    lines = [np.flatnonzero(chosen & (x == value)) for value in axis.values]
    joined, start = [], 0
    for end in range(1, len(lines) + 1):
        if end < len(lines) and len(lines[end]) == len(lines[start]):
            continue
        part = np.array(lines[start:end], dtype=int)
        joined += [(axis.values[start:end], part[:, place]) for place in range(part.shape[1])]
        start = end
    return joined


def unjoined(found: Thresholds, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A curve with a gap at each of its jumps.

    A jump is a step of more than a twentieth of the range that was searched and five times the median step.
    """
    seen = np.log if found.range.scale == LOGARITHMIC else np.asarray
    steps = np.abs(np.diff(seen(y)))
    if steps.size < LEAST_STEPS or not np.isfinite(steps).any():
        return x, y
    far = max(0.05 * float(np.ptp(seen(found.range.values))), 5.0 * float(np.nanmedian(steps)))
    jumps = np.flatnonzero(steps > far) + 1
    return np.insert(x, jumps, np.nan), np.insert(y, jumps, np.nan)


def draw_either(axes: Axes, found: Thresholds, axis: Axis, chosen: np.ndarray, colour: str) -> None:
    """The band in which either side is possible, between the ends of the motions of both sides."""
    if not (chosen & found.either).any():
        return
    low, high = (np.where(chosen & found.either, values, np.nan) for values in found.ends)
    for x, rows in joined_rows(found, axis, chosen):
        axes.fill_between(x, low[rows], high[rows], color=colour, alpha=0.16, linewidth=0.0, zorder=1.5)
        for values in (low[rows], high[rows]):
            axes.plot(x, values, color=colour, linewidth=0.8, linestyle=(0, (1.2, 1.0)), zorder=2)
    rows = chosen & found.either
    # A band of one trace has no width: a bar with feet stands for it.
    style_of_bar = {"colors": colour, "alpha": 0.4, "linewidth": 0.8, "zorder": 2}
    axes.vlines(found.column(axis.key)[rows], low[rows], high[rows], **style_of_bar)


def either_entry(count: int) -> Patch:
    edge = {"edgecolor": style.FORCE_COLOUR, "linestyle": (0, (1.2, 1.0)), "linewidth": 0.8}
    return Patch(facecolor=(*to_rgb(style.FORCE_COLOUR), 0.16), **edge, label=f"{EITHER} ({count})")


def draw_bars(axes: Axes, x: np.ndarray, lower: np.ndarray, upper: np.ndarray, colour: str) -> None:
    """How far apart the ends of each crossing are."""
    known = np.isfinite(lower)
    axes.vlines(x[known], lower[known], upper[known], colors=colour, linewidth=2.5, alpha=0.4, zorder=3)
