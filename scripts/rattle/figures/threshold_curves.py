"""Thresholds as curves, also over a map that they divide."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

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

# Values along the x axis, and along the y axis.
Points = tuple[np.ndarray, np.ndarray]

SHADE = 0.1  # opacity; where several rattle it adds up
EITHER = "either is possible"
END_WORDS = "end: its neighbour has no such change near"
JUMP_WORDS = "jump: too large to be sure of one curve"
LINES_SENTENCE = (
    "A line ends, marked round, where its neighbour has no such change near; it is broken, marked square, "
    "where a jump is too large to be sure of one curve."
)
# What stands at ends and jumps within a picture: around points, and over a map, which shows no points.
_RING = {"color": "black", "markersize": 8, "markerfacecolor": "none", "linestyle": "", "zorder": 5}
_DOT = {"color": "black", "markersize": 3.4, "linestyle": "", "zorder": 5}
RINGS = {END_WORDS: {"marker": "o", **_RING}, JUMP_WORDS: {"marker": "s", **_RING}}
DOTS = {END_WORDS: {"marker": "o", **_DOT}, JUMP_WORDS: {"marker": "s", **_DOT}}
FAR = 0.05  # of the range that was searched
STEEPER = 5.0
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
    ends = draw_ends(axes, parts, along, DOTS, upwards)
    draw = axes.vlines if upwards else axes.hlines
    known = crossed & np.isfinite(rows.column("lower"))
    bars = (rows.column(name)[known] for name in ("lower", "upper"))
    draw(rows.column(other)[known], *bars, colors="black", linewidth=2.5, alpha=0.4, zorder=4)
    unsure = rows.uncertain
    marks = {"color": "black", "marker": "o", "markersize": 3.0, "linestyle": "", "zorder": 5}
    places = rows.column(other)[unsure], rows.values[unsure]
    axes.plot(*(places if upwards else places[::-1]), markerfacecolor="white", **marks)
    x, y = rows.column(other)[crossed], rows.values[crossed]
    outside = int((~within(axes, *((x, y) if upwards else (y, x)))).sum())
    words = f"threshold: {words_of_criterion(found)}"
    words += f" ({outside} of {x.size} outside)" if outside else ""
    return [Line2D([], [], **look, label=words), *ends]


def within(axes: Axes, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Which points lie between the limits of both axes."""
    inside = np.ones(np.shape(x), dtype=bool)
    for values, limits in ((x, axes.get_xlim()), (y, axes.get_ylim())):
        inside &= (values >= min(limits)) & (values <= max(limits))
    return inside


def draw_ends(
    axes: Axes,
    parts: Sequence[Points],
    along: Axis,
    looks: Mapping[str, Mapping],
    upwards: bool = True,
) -> list[Line2D]:
    """Marks where lines end, and on both sides of their jumps; returns legend entries of those seen."""
    handles = []
    for (words, look), points in zip(looks.items(), line_ends(parts, along), strict=True):
        x, y = points if upwards else points[::-1]
        inside = within(axes, x, y)
        if inside.any():
            axes.plot(x[inside], y[inside], **look)
            handles.append(Line2D([], [], **look, label=words))
    return handles


def line_ends(parts: Sequence[Points], along: Axis) -> tuple[Points, Points]:
    """Points (x and y of each) at which lines end within the axis, and those on both sides of jumps."""
    ends, jumps = [], []
    for x, y in parts:
        points = list(zip(x.tolist(), y.tolist(), strict=True))
        # A line of one point, which no stroke shows, is marked wherever it stands.
        ends += [
            points[end]
            for end in (0, -1)
            if len(points) == 1 or along.values[0] < points[end][0] < along.values[-1]
        ]
        jumps += [points[gap + side] for gap in np.flatnonzero(np.isnan(x)) for side in (-1, 1)]
    return _points(ends), _points(jumps)


def _points(found: Sequence[tuple[float, float]]) -> Points:
    """Points, each once."""
    each = np.array(list(dict.fromkeys(found))).reshape(-1, 2)
    return each[:, 0], each[:, 1]


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


def curves(found: Thresholds, axis: Axis, chosen: np.ndarray) -> list[Points]:
    """Crossings of one kind joined from trace to trace, with a gap at each jump."""
    parts = []
    for x, rows in joined_rows(found, axis, chosen):
        broken = jumps(found, axis, rows)
        parts.append((gapped(x, broken), gapped(found.values[rows], broken)))
    return parts


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


def jumps(found: Thresholds, axis: Axis, rows: np.ndarray) -> np.ndarray:
    """Before which places of a curve a step is too large to be sure that one curve passes there.

    Such a step is more than FAR of the range that was searched, and STEEPER times as steep as the steps next
    to it in the same direction: a curve that is steep there rises or falls before it or after it.
    """
    seen = _seen(found)
    x, y = found.column(axis.key)[rows], seen(found.values[rows])
    steps = np.diff(y)
    if steps.size < LEAST_STEPS:
        return np.array([], dtype=int)
    slopes = steps / np.diff(np.log(x) if axis.scale == LOGARITHMIC else x)
    beside = np.array([np.append(0.0, slopes[:-1]), np.append(slopes[1:], 0.0)])
    usual = np.where(beside * slopes > 0.0, np.abs(beside), 0.0).max(axis=0)
    far = FAR * float(np.ptp(seen(found.range.values)))
    return np.flatnonzero((np.abs(steps) > far) & (np.abs(slopes) > STEEPER * usual)) + 1


def gapped(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Values along a curve with a gap before each of these places."""
    return np.insert(values, places, np.nan)


def joined_pairs(found: Thresholds, axis: Axis, chosen: np.ndarray) -> set[tuple[int, int]]:
    """Rows of neighbouring traces between which a curve of some kind is drawn."""
    pairs: set[tuple[int, int]] = set()
    for kind in dict.fromkeys(found.kinds[chosen]):
        for _, rows in joined_rows(found, axis, chosen & (found.kinds == kind)):
            broken = set(jumps(found, axis, rows).tolist())
            places = [place for place in range(1, rows.size) if place not in broken]
            pairs.update((int(rows[place - 1]), int(rows[place])) for place in places)
    return pairs


def draw_either(axes: Axes, found: Thresholds, axis: Axis, chosen: np.ndarray, colour: str) -> None:
    """The band in which either side is possible, between the ends of the motions of both sides."""
    if not (chosen & found.either).any():
        return
    low, high = (np.where(chosen & found.either, values, np.nan) for values in found.ends)
    for values_of_key, rows in joined_rows(found, axis, chosen):
        broken = jumps(found, axis, rows)
        x, *ends = (gapped(values, broken) for values in (values_of_key, low[rows], high[rows]))
        axes.fill_between(x, *ends, color=colour, alpha=0.16, linewidth=0.0, zorder=1.5)
        for values in ends:
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
    """Shade where the motion rattles, trace by trace, joined where all that bounds it is.

    Bounds of neighbours are joined by a curve, or near each other though other kinds of change.
    """
    x, seen = found.column(axis.key), _seen(found)
    below, above, crossing = found.rattles("_below"), found.rattles("_above"), found.column("crossing")
    pairs = joined_pairs(found, axis, chosen & (crossing > 0))
    parts, bounds = [], []
    for value in axis.values:
        rows = np.flatnonzero(chosen & (x == value))
        rows = rows[np.argsort(crossing[rows])]
        first, last = found.range.values
        crossed = [int(row) for row in rows if crossing[row] > 0]
        places = [first, *found.values[crossed], last]
        sides = [below[rows[0]], *above[crossed]] if rows.size else [False]
        spans = [place for place, rattles in enumerate(sides) if rattles]
        parts.append([(places[span], places[span + 1]) for span in spans])
        # Rows of the crossings; the ends of the range stand for themselves.
        names = [-1, *crossed, -2]
        bounds.append([name for span in spans for name in names[span : span + 2]])
    far = FAR * float(np.ptp(seen(found.range.values)))
    start = 0
    for end in range(1, len(parts) + 1):
        if end < len(parts) and len(parts[end]) == len(parts[end - 1]):
            near = np.abs(seen(np.ravel(parts[end])) - seen(np.ravel(parts[end - 1]))) <= far
            pairs_here = zip(bounds[end - 1], bounds[end], strict=True)
            if all(pair in pairs or is_near for pair, is_near in zip(pairs_here, near, strict=True)):
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
