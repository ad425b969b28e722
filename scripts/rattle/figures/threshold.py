"""Thresholds along one or two keys: curves, alone or over the map that they divide."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib import ticker
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import rattle
from rattle import command
from rattle.campaign_plan import GEAR, GRID
from rattle.campaign_result import Axis
from rattle.campaign_section import Section, new_section, short_name, spaced_unit
from rattle.figures import campaign_look as look
from rattle.figures import campaign_map, style
from rattle.figures.threshold_curves import (
    RINGS,
    curves,
    draw_bars,
    draw_either,
    draw_ends,
    either_entry,
    shade,
    shade_entry,
    within,
)
from rattle.rounding import stated_error
from rattle.thresholds import Thresholds, thresholds, words_of_criterion

DESCRIPTION = (
    "Draw thresholds, over the map of a campaign if one is given, as threshold_NAME: points over one key, "
    "curves or a map over two. Bars: from lower to upper; open marks: an end is not verified."
)
MOST_CURVES = 7
MOST_KINDS = len(style.RUN_COLOURS) - 1
NONE = "no change"
UNCERTAIN = "not verified"
BAR = "from lower to upper"
# Share of an axis below which a bar hides behind its mark.
LEAST_BAR = 0.01


def add_options(parser: ArgumentParser) -> None:
    parser.add_argument("result", type=Path, metavar="RESULT", help="result of thresholds, NAME.rattle")
    parser.add_argument(
        "--map",
        type=Path,
        metavar="CAMPAIGN",
        help="grid campaign over the same keys, drawn behind the curves",
    )
    parser.add_argument(
        "--crossing",
        type=command.positive,
        metavar="N",
        help="draw only this change of each trace over two keys, counted from the first value (all; in a map "
        "of colours the first)",
    )
    parser.add_argument(
        "--slice",
        type=command.held_key,
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="of three varied keys or more, hold one at the nearest value; by default its middle",
    )


def run(options: Namespace) -> None:
    result = rattle.read(options.result)
    result.require_rows("threshold")
    command.note_open(result)
    found, words = cut(thresholds(result), command.one_each(options.slice), 1 if options.map else 2)
    section = behind(found, options.map, words) if options.map else None
    with style.house_style():
        figure = draw(found, words, section, options.crossing)
        print(*style.save([(f"threshold_{result.scene_name}", figure)], options), sep="\n")


def cut(found: Thresholds, slices: Mapping[str, float], most: int) -> tuple[Thresholds, dict[str, float]]:
    """Thresholds over at most so many keys; the others are held where asked for, or in their middle."""
    if not found.varied:
        raise command.CommandError(f"{found.result.path} has one line: there is no key to draw it along.")
    for key in slices:
        if key not in found.varied:
            raise command.CommandError(f"{found.result.path} does not vary '{key}'.")
    # Gear pairs have no order in which a curve could run.
    free = sorted((key for key in found.varied if key not in slices), key=lambda key: key == GEAR)[:most]
    if not free:
        raise command.CommandError("all varied keys are sliced: one has to stay free.")
    if len(found.varied) > 1 and not found.on_grid:
        raise command.CommandError(f"{found.result.path} is not a grid: its thresholds have no curve.")
    held = {}
    for axis in found.axes:
        if axis.key in free:
            continue
        asked = slices.get(axis.key)
        index = axis.values.size // 2 if asked is None else int(np.argmin(np.abs(axis.values - asked)))
        held[axis.key] = float(axis.values[index])
        command.note(
            f"{short_name(axis.key)} = {held[axis.key]:.4g}{spaced_unit(axis.unit)}; --slice moves it."
        )
    return found.held(held), held


def behind(found: Thresholds, path: Path, held: Mapping[str, float]) -> Section:
    """The map behind the curves: the axis to the right, the key of the thresholds upwards."""
    campaign = rattle.read_campaign(path)
    if campaign.kind != GRID:
        raise command.CommandError(
            f"{path} is not a grid but a {campaign.kind} campaign: nothing to draw behind."
        )
    free = next(key for key in found.varied if key not in held)
    return new_section(campaign, (free, found.key), {k: v for k, v in held.items() if k in campaign.varied})


def draw(
    found: Thresholds,
    held: Mapping[str, float] | None = None,
    section: Section | None = None,
    crossing: int | None = None,
) -> Figure:
    """Thresholds over the keys that are not held."""
    free = [axis for axis in found.axes if axis.key not in (held or {})]
    figure = Figure(figsize=(style.WIDTH, 4.9))
    axes = figure.subplots()
    if len(free) == 1:
        handles = draw_points(axes, found, free[0], section)
    elif min(axis.values.size for axis in free) <= MOST_CURVES:
        along, other = sorted(free, key=lambda axis: (axis.key == GEAR, -axis.values.size))
        handles = draw_curves(axes, found, along, other, crossing)
    else:
        crossing = crossing or 1
        handles = draw_surface(figure, axes, found, free[0], free[1], crossing)
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=3)
    what = words_of_criterion(found)
    if len(free) > 1 and crossing:
        what = f"{ordinal(crossing)} {what}"
    parts = [f"{short_name(key)} = {found.words_of_value(key, value)}" for key, value in (held or {}).items()]
    relative = found.result.units[f"{found.quantity}_below"] == "m/s2" and found.result.has_gear
    what = f"relative {what}" if relative else what
    axes.set_title(", ".join([f"{look.capital(what)}: {found.result.scene_name}", *parts]))
    return figure


def searched_label(found: Thresholds) -> str:
    """The label of the axis of thresholds, with the range in which they were sought."""
    first, last = (f"{value:.4g}" for value in found.range.values)
    unit = spaced_unit(look.drawn_unit(found.range.unit))
    return f"{look.axis_label(found.range)}, searched from {first} to {last}{unit}"


def ordinal(number: int) -> str:
    return {1: "first", 2: "second", 3: "third"}.get(number, f"{number}th")


def draw_points(axes: Axes, found: Thresholds, axis: Axis, section: Section | None) -> list:
    """Every crossing over one key, a colour for each kind of change; returns legend entries."""
    handles: list = []
    if section is None:
        look.set_axis(axes, "x", axis, to_edges=False)
        set_range(axes, found, np.concatenate((found.values, *found.ends)))
    else:
        handles, _ = campaign_map.draw_cells(axes, section, map_column(section, found))
    x, y, crossed = found.column(axis.key), found.values, found.column("crossing") > 0
    inside = within(axes, x, y)
    common = [kind for kind, _ in Counter(found.kinds[crossed]).most_common()]
    lines: list = []
    if section is None:
        shade(axes, found, axis, np.ones(x.size, dtype=bool), style.FORCE_COLOUR)
    kinds = common if len(common) <= MOST_KINDS + 1 else [*common[:MOST_KINDS], None]
    for place, kind in enumerate(kinds):
        chosen = crossed & (found.kinds == kind if kind else ~np.isin(found.kinds, kinds[:-1]))
        halo = style.HALO if section else None
        colour = "black" if section else style.RUN_COLOURS[place]
        dashes = {"linewidth": 1.3, "linestyle": style.RUN_DASHES[place % len(style.RUN_DASHES)]}
        parts = curves(found, axis, chosen) if kind else []
        for part in parts:
            axes.plot(*part, zorder=3, color=colour, path_effects=halo, **dashes)
        draw_either(axes, found, axis, chosen, colour)
        lines += parts
        draw_bars(axes, x[chosen], found.column("lower")[chosen], found.column("upper")[chosen], colour)
        marks = {"color": colour, "marker": style.RUN_MARKS[place], "markersize": 3.0, "zorder": 4}
        sure = chosen & ~found.uncertain
        axes.plot(x[sure], y[sure], linestyle="", **marks)
        axes.plot(
            x[chosen & found.uncertain],
            y[chosen & found.uncertain],
            linestyle="",
            markerfacecolor="white",
            **marks,
        )
        words = f"{kind or 'other changes'} ({drawn_of(chosen, inside)})"
        handles.append(Line2D([], [], **dashes, **marks, label=words))
    handles += width_entry(axes, found, crossed)
    handles += draw_ends(axes, lines, axis, RINGS)
    handles += [shade_entry(found)] if section is None else []
    if found.either.any():
        handles.append(either_entry(int(found.either.sum())))
    if found.uncertain.any():
        mark = {"marker": "o", "markersize": 4, "markerfacecolor": "white", "color": style.FORCE_COLOUR}
        handles.append(
            Line2D([], [], linestyle="", **mark, label=f"{UNCERTAIN} ({drawn_of(found.uncertain, inside)})")
        )
    if not crossed.all():
        mark = {"marker": "|", "linestyle": "", "color": style.FORCE_COLOUR, "markersize": 7}
        foot = np.full(int((~crossed).sum()), 0.02)
        axes.plot(x[~crossed], foot, transform=axes.get_xaxis_transform(), zorder=4, **mark)
        beside = within(axes, x, np.full(x.size, axes.get_ylim()[0]))
        handles.append(Line2D([], [], **mark, label=f"{NONE} ({drawn_of(~crossed, beside)})"))
    return handles


def drawn_of(chosen: np.ndarray, inside: np.ndarray) -> str:
    """How many of some rows the picture shows, and how many lie outside its axes."""
    outside = int((chosen & ~inside).sum())
    return f"{int((chosen & inside).sum())}" + (f", {outside} more outside" if outside else "")


def bars_show(axes: Axes, found: Thresholds, chosen: np.ndarray) -> bool:
    """Whether some bar is longer than its mark."""
    seen = np.log if look.is_logarithmic(found.range) else np.asarray
    lower, upper = (seen(found.column(name)[chosen]) for name in ("lower", "upper"))
    return bool((upper - lower > LEAST_BAR * np.ptp(seen(np.array(axes.get_ylim())))).any())


def width_entry(axes: Axes, found: Thresholds, chosen: np.ndarray) -> list[Line2D]:
    """How well the thresholds are known: the bars where they can be seen, else the widest of them."""
    if not chosen.any():
        return []
    if bars_show(axes, found, chosen):
        return [bar_entry()]
    places = np.flatnonzero(chosen)
    widest = places[int(np.argmax(found.column("width")[places]))]
    known = stated_error(float(found.column("width")[widest]), float(found.values[widest]), 6)
    unit = spaced_unit(look.drawn_unit(found.range.unit))
    return [Line2D([], [], linestyle="", label=f"known to {known:.2g}{unit}")]


def bar_entry() -> Line2D:
    bar = {"marker": "|", "markersize": 9, "markeredgewidth": 2.5, "alpha": 0.4, "color": style.FORCE_COLOUR}
    return Line2D([], [], linestyle="", **bar, label=BAR)


def set_range(axes: Axes, found: Thresholds, values: np.ndarray) -> None:
    """The y axis: what was searched, or less of it where the changes lie close together."""
    searched = found.range
    seen, back = (np.log, np.exp) if look.is_logarithmic(searched) else (np.asarray, np.asarray)
    ends, known = seen(searched.values), seen(values[np.isfinite(values)])
    if known.size:
        half = max(0.6 * np.ptp(known), 0.15 * np.ptp(ends))
        middle = 0.5 * (known.min() + known.max())
        if half < 0.35 * np.ptp(ends):
            searched = replace(searched, values=back(np.clip([middle - half, middle + half], *ends)))
    look.set_axis(axes, "y", searched, to_edges=False)
    axes.set_ylabel(searched_label(found))


def map_column(section: Section, found: Thresholds) -> str:
    """What the map behind shows: what the criterion looks at where that is recorded, else the class."""
    return found.quantity if found.quantity in section.campaign else "rattle_class"


def on_plane(found: Thresholds, x: Axis, y: Axis, crossing: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A crossing of each trace, an index for each axis, NaN where there is none; its ends; its doubt."""
    values = np.full((x.values.size, y.values.size), np.nan)
    ends = np.full((2, *values.shape), np.nan)
    uncertain = np.zeros(values.shape, dtype=bool)
    rows = np.flatnonzero(found.column("crossing") == crossing)
    places = tuple(np.searchsorted(axis.values, found.column(axis.key)[rows]) for axis in (x, y))
    values[places], uncertain[places] = found.values[rows], found.uncertain[rows]
    for end, name in zip(ends, ("lower", "upper"), strict=True):
        end[places] = found.column(name)[rows]
    return values, ends, uncertain


def draw_curves(axes: Axes, found: Thresholds, along: Axis, other: Axis, crossing: int | None) -> list:
    """Curves along one key for each value of another, of one change or all; returns legend entries."""
    look.set_axis(axes, "x", along, to_edges=False)
    lasting = found.column("crossing") == crossing if crossing else found.column("crossing") > 0
    handles: list = []
    values, x, uncertain = found.values, found.column(along.key), found.uncertain
    set_range(axes, found, np.concatenate((values[lasting], *(end[lasting] for end in found.ends))))
    lines: list = []
    for place, value in enumerate(other.values):
        own = found.column(other.key) == value
        chosen, unsure = own & lasting, own & lasting & uncertain
        label = f"{short_name(other.key)} {found.words_of_value(other.key, value)}"
        mark = {"marker": style.RUN_MARKS[place], "markersize": 3.0}
        line = style.run_line(place)
        lower, upper = (found.column(end)[chosen] for end in ("lower", "upper"))
        draw_bars(axes, x[chosen], lower, upper, line["color"])
        draw_either(axes, found, along, chosen, line["color"])
        shade(axes, found, along, own, line["color"])
        kinds = dict.fromkeys(found.kinds[chosen])
        parts = [part for kind in kinds for part in curves(found, along, chosen & (found.kinds == kind))]
        for part in parts:
            axes.plot(*part, **line, **mark)
        lines += parts
        handles.append(Line2D([], [], label=label, **line, **mark))
        points = {"color": line["color"], "linestyle": "", "markerfacecolor": "white", **mark}
        axes.plot(x[unsure], values[unsure], **points)
    handles += [*draw_ends(axes, lines, along, RINGS), shade_entry(found), *width_entry(axes, found, lasting)]
    if (lasting & found.either).any():
        handles.append(either_entry(int((lasting & found.either).sum())))
    if (lasting & uncertain).any():
        mark = {"marker": "o", "markersize": 4, "markerfacecolor": "white", "color": style.FORCE_COLOUR}
        handles.append(Line2D([], [], linestyle="", **mark, label=UNCERTAIN))
    return handles


def draw_surface(figure: Figure, axes: Axes, found: Thresholds, x: Axis, y: Axis, crossing: int) -> list:
    """A coloured map of the threshold over two keys, with contours; returns legend entries."""
    values, _, uncertain = on_plane(found, x, y, crossing)
    edges = look.cell_edges(x), look.cell_edges(y)
    drawn = axes.pcolormesh(*edges, values.T, cmap=look.COLOUR_MAP, rasterized=True)
    known = values[np.isfinite(values)]
    if known.size and np.ptp(known) > 0.0:
        levels = ticker.MaxNLocator(7).tick_values(known.min(), known.max())
        levels = [level for level in levels if known.min() < level < known.max()]
        lines = axes.contour(
            x.values, y.values, np.ma.masked_invalid(values.T), levels=levels, colors="black", linewidths=0.9
        )
        lines.set_path_effects(style.HALO)
        for label in axes.clabel(lines, fontsize=7, fmt="%g"):
            label.set_path_effects(style.HALO)
    look.set_axis(axes, "x", x, to_edges=True)
    look.set_axis(axes, "y", y, to_edges=True)
    figure.colorbar(drawn, ax=axes, label=searched_label(found), pad=0.02, aspect=30)
    handles = []
    for where, marker, words in ((np.isnan(values), "x", NONE), (uncertain, ".", UNCERTAIN)):
        if where.any():
            mark = {"marker": marker, "linestyle": "", "color": style.FORCE_COLOUR, "markersize": 3}
            axes.plot(
                *(axis.values[index] for axis, index in zip((x, y), np.nonzero(where), strict=True)), **mark
            )
            handles.append(Line2D([], [], **mark, label=f"{words} ({int(where.sum())})"))
    return handles
