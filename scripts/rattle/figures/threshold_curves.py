"""Thresholds as curves, also over a map that they divide."""

from __future__ import annotations

from collections.abc import Callable, Sequence

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

SHADE = 0.1  # opacity; where several rattle it adds up
EITHER = "either is possible"
# What stands where a line ends within a picture.
END = {"color": "black", "marker": "D", "markersize": 3.2, "linestyle": "", "zorder": 5}
END_WORDS = "end: the motion changes kind"
FAR = 0.05  # of the range that was searched
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
    parts = [
        part
        for kind in dict.fromkeys(rows.kinds[crossed])
        for part in curves(rows, along, crossed & (rows.kinds == kind))
    ]
    for x, y in parts:
        axes.plot(*((x, y) if upwards else (y, x)), zorder=4, path_effects=style.HALO, **look)
    x, y = line_ends(parts, along)
    axes.plot(*((x, y) if upwards else (y, x)), **END)
    draw = axes.vlines if upwards else axes.hlines
    known = crossed & np.isfinite(rows.column("lower"))
    ends = (rows.column(name)[known] for name in ("lower", "upper"))
    draw(rows.column(other)[known], *ends, colors="black", linewidth=2.5, alpha=0.4, zorder=4)
    unsure = rows.uncertain
    marks = {"color": "black", "marker": "o", "markersize": 3.0, "linestyle": "", "zorder": 5}
    places = rows.column(other)[unsure], rows.values[unsure]
    axes.plot(*(places if upwards else places[::-1]), markerfacecolor="white", **marks)
    handles = [Line2D([], [], **look, label=f"threshold: {words_of_criterion(found)}")]
    return handles + ([end_entry()] if x.size else [])


def line_ends(parts: Sequence[tuple[np.ndarray, np.ndarray]], along: Axis) -> tuple[np.ndarray, np.ndarray]:
    """Where lines end or jump within the axis, as the motion changes kind there."""
    ends = []
    for x, y in parts:
        for piece in np.split(np.arange(x.size), np.flatnonzero(np.isnan(x))):
            kept = piece[np.isfinite(x[piece])]
            for end in kept[[0, -1]] if kept.size else ():
                # A line of one point, which no stroke shows, is marked wherever it stands.
                if kept.size == 1 or along.values[0] < x[end] < along.values[-1]:
                    ends.append((float(x[end]), float(y[end])))
    found = np.array(list(dict.fromkeys(ends))).reshape(-1, 2)
    return found[:, 0], found[:, 1]


def end_entry() -> Line2D:
    return Line2D([], [], **END, label=END_WORDS)


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
    """Crossings of one kind joined from trace to trace."""
    return [unjoined(found, x, found.values[rows]) for x, rows in joined_rows(found, axis, chosen)]


def joined_rows(found: Thresholds, axis: Axis, chosen: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """The values of a key along each curve, and the places of its rows.

    Neighbours with as many crossings are joined in their order; else each with the nearest, if it is near.
    """
    x, seen = found.column(axis.key), _seen(found)
    farthest = FAR * float(np.ptp(seen(found.range.values)))
    ended: list[tuple[int, list[int]]] = []
    going: list[tuple[int, list[int]]] = []
    for start, value in enumerate(axis.values):
        rows = [int(row) for row in np.flatnonzero(chosen & (x == value))]
        if len(rows) == len(going):
            pairs = list(enumerate(range(len(rows))))
        else:
            steps = sorted(
                (abs(float(seen(found.values[row]) - seen(found.values[line[1][-1]]))), one, other)
                for one, line in enumerate(going)
                for other, row in enumerate(rows)
            )
            pairs = []
            for step, one, other in steps:
                free = all(one != pair[0] and other != pair[1] for pair in pairs)
                pairs += [(one, other)] if step <= farthest and free else []
        taken = dict(pairs)
        ended += [line for place, line in enumerate(going) if place not in taken]
        lines = {taken[place]: line for place, line in enumerate(going) if place in taken}
        going = [
            (lines[place][0], [*lines[place][1], row]) if place in lines else (start, [row])
            for place, row in enumerate(rows)
        ]
    found_lines = sorted([*ended, *going], key=lambda line: line[0])
    return [(axis.values[start : start + len(rows)], np.array(rows)) for start, rows in found_lines]


def unjoined(found: Thresholds, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A curve with a gap at each of its jumps.

    A jump is a step of more than FAR of the range that was searched and five times the median step.
    """
    seen = _seen(found)
    steps = np.abs(np.diff(seen(y)))
    if steps.size < LEAST_STEPS or not np.isfinite(steps).any():
        return x, y
    far = max(FAR * float(np.ptp(seen(found.range.values))), 5.0 * float(np.nanmedian(steps)))
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


def _seen(found: Thresholds) -> Callable:
    return np.log if found.range.scale == LOGARITHMIC else np.asarray


def shade(axes: Axes, found: Thresholds, axis: Axis, chosen: np.ndarray, colour: str) -> None:
    """Shade where the motion rattles, trace by trace, joined as far as neighbours have as many such parts."""
    x = found.column(axis.key)
    below, above, crossing = found.rattles("_below"), found.rattles("_above"), found.column("crossing")
    parts = []
    for value in axis.values:
        rows = np.flatnonzero(chosen & (x == value))
        rows = rows[np.argsort(crossing[rows])]
        first, last = found.range.values
        places = [first, *(found.values[row] for row in rows if crossing[row] > 0), last]
        sides = [below[rows[0]], *(above[row] for row in rows if crossing[row] > 0)] if rows.size else [False]
        spans = zip(places, places[1:], sides, strict=False)
        parts.append([(low, high) for low, high, rattles in spans if rattles])
    far = FAR * float(np.ptp(found.range.values))
    start = 0
    for end in range(1, len(parts) + 1):
        joined = end < len(parts) and len(parts[end]) == len(parts[end - 1])
        if joined and np.abs(np.subtract(parts[end], parts[end - 1])).max(initial=0.0) <= far:
            continue
        along = axis.values[start:end]
        # Half-way to the neighbours that are not joined, as cells of a map are.
        ends = [0.5 * (axis.values[max(start - 1, 0)] + along[0])]
        ends.append(0.5 * (along[-1] + axis.values[min(end, len(parts) - 1)]))
        for place in range(len(parts[start])):
            low, high = np.array([part[place] for part in parts[start:end]]).T
            low, high = ([side[0], *side, side[-1]] for side in (low, high))
            whole = [ends[0], *along, ends[1]]
            axes.fill_between(whole, low, high, color=colour, alpha=SHADE, linewidth=0.0, zorder=0.5)
        start = end


def shade_entry(found: Thresholds) -> Patch:
    return Patch(facecolor=(*to_rgb(style.FORCE_COLOUR), 2.0 * SHADE), label=f"{found.rattling_words} here")


def draw_bars(axes: Axes, x: np.ndarray, lower: np.ndarray, upper: np.ndarray, colour: str) -> None:
    """How far apart the ends of each crossing are."""
    known = np.isfinite(lower)
    axes.vlines(x[known], lower[known], upper[known], colors=colour, linewidth=2.5, alpha=0.4, zorder=3)
