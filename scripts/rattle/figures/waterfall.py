"""Waterfalls of run-ups over order and speed: measured, with computed orders beside; driven, up and down."""

from __future__ import annotations

import re
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

import rattle
from rattle import command, run_up
from rattle.figures import orders, style, sweep
from rattle.figures.campaign_look import COLOUR_MAP, with_unit
from rattle.figures.comparison import DIFFERENCE_COLOURS
from rattle.figures.fit import is_narrow
from rattle.figures.spectra import LEVEL_LABEL
from rattle.result import Result

DESCRIPTION = (
    "Draw the waterfall of 'recording.py run-up', amplitude over order and speed, as waterfall_NAME; "
    "orders that its table kept are marked. --computed draws a campaign over shaft.speed_rpm that records "
    "harmonics beside it, each gear pair in a picture of its own. Of a sweep over speed_rpm: levels of the "
    "orders of the force on the way up, on the way down, and their difference, hysteresis between lines."
)
DECADES = 3.0  # below the largest amplitude that are drawn
HEIGHT = 4.2  # inches
LEAST_CHANGE = 1.0  # dB, that has the full colour where ways hardly differ
WIDEST = 0.15  # of the strips of computed orders
KINDS = {"rad/s2": "angular acceleration", "m/s2": "acceleration"}


@dataclass(frozen=True)
class Map:
    """Amplitudes in `unit` over speed [1/min] (rows) and order (columns), which is `half` wide either way."""

    speeds: np.ndarray
    orders: np.ndarray
    amplitudes: np.ndarray
    half: float
    unit: str
    is_relative: bool = False


def add_options(parser: ArgumentParser) -> None:
    parser.add_argument(
        "waterfall",
        type=Path,
        metavar="FILE",
        help="NAME.waterfall.csv of 'recording.py run-up', or NAME.rattle of a sweep over speed_rpm",
    )
    parser.add_argument(
        "--computed", type=Path, metavar="RESULT", help="result of a campaign over speed, NAME.rattle"
    )


def run(options: Namespace) -> None:
    if options.waterfall.suffix == ".rattle":
        return _run_driven(options)
    measured, kept = read_waterfall(options.waterfall)
    name = options.waterfall.name.removesuffix(".csv").removesuffix(".waterfall")
    narrow = is_narrow(options.width)
    with style.house_style():
        if options.computed is None:
            drawn = [(f"waterfall_{style.file_part(name)}", draw(name, measured, kept))]
        else:
            drawn = [
                (
                    f"waterfall_{pair.name}",
                    draw(name, measured, kept, computed(pair), pair.name, narrow=narrow),
                )
                for pair in rattle.read_campaign(options.computed).pairs
            ]
        print(*style.save(drawn, options), sep="\n")


def _run_driven(options: Namespace) -> None:
    """The waterfall of a sweep over speed."""
    if options.computed is not None:
        raise command.CommandError("--computed is laid beside a measured waterfall, not a sweep.")
    result = rattle.read(options.waterfall)
    result.require_rows("sweep")
    command.note_open(result)
    with style.house_style():
        print(*style.save([(f"waterfall_{result.scene_name}", draw_ways(result))], options), sep="\n")


def read_waterfall(path: Path) -> tuple[Map, list[float]]:
    """The waterfall of a file, and the orders that were kept."""
    lines = path.read_text(encoding="utf-8", errors="surrogateescape").splitlines()
    described = dict(re.findall(r"^# (kept|unit): (\S+)$", "\n".join(lines), re.MULTILINE))
    rows = [line.split(",") for line in lines if line.strip() and not line.startswith("#")]
    head = [orders.ORDER_COLUMN.fullmatch(name) for name in (rows[0][1:] if rows else [])]
    if len(rows) < 3 or rows[0][0] != "speed_rpm" or len(head) < 2 or not all(head) or len(described) != 2:
        raise command.CommandError(
            f"{path} is not a waterfall; 'recording.py run-up' writes NAME.waterfall.csv beside its table."
        )
    try:
        numbers = np.array(rows[1:], dtype=float)
        kept = [float(order) for order in described["kept"].split(",")]
    except ValueError as fault:
        raise command.CommandError(f"{path} is not a waterfall: {fault}.") from None
    columns = np.array([float(found[1]) for found in head if found])
    half = 0.5 * float(columns[1] - columns[0])
    return Map(numbers[:, 0], columns, numbers[:, 1:], half, described["unit"]), kept


def computed(campaign: rattle.Campaign) -> Map:
    """The harmonics of a campaign, as wide as orders that were measured look."""
    cuts = orders.computed(campaign)
    first = cuts.orders[0]
    return Map(
        cuts.speeds,
        np.array(cuts.orders),
        cuts.amplitudes,
        min(0.5 * first, WIDEST),
        "m/s2",
        campaign.has_gear,
    )


def draw(
    name: str,
    measured: Map,
    kept: list[float],
    beside: Map | None = None,
    pair: str = "",
    *,
    narrow: bool = False,
) -> Figure:
    """The measured map, and the computed one of a pair beside it, or below where it is narrow."""
    maps = [(measured, f"Measured run-up {name}")] + (
        [] if beside is None else [(beside, f"Computed, {pair}")]
    )
    rows = len(maps) if narrow else 1
    figure = Figure(figsize=(style.WIDTH, HEIGHT * rows))
    panels = figure.subplots(rows, len(maps) // rows, sharex=True, sharey=True, squeeze=False).ravel()
    for axes, (shown, title) in zip(panels, maps, strict=True):
        # Amplitudes of one unit have one scale.
        top = max(float(np.nanmax(other.amplitudes)) for other, _ in maps if other.unit == shown.unit)
        norm = LogNorm(top / 10.0**DECADES, top)
        _cells(axes, shown, norm)
        axes.set_title(title, pad=18.0)
        if axes is panels[-1] or not narrow:
            axes.set_xlabel("Order of the shaft [-]")
        if axes is panels[0] or narrow:
            axes.set_ylabel("Shaft speed [1/min]")
        figure.colorbar(
            ScalarMappable(norm, COLOUR_MAP), ax=axes, label=_label(shown), extend="min", pad=0.02, aspect=30
        )
    panels[0].set_xlim(0.0, measured.orders[-1] + measured.half)
    panels[0].set_ylim(measured.speeds[0], measured.speeds[-1])
    for axes in panels:
        _mark(axes, kept)
    return figure


def draw_ways(result: Result) -> Figure:
    """Levels of a sweep over speed on the way up, of one that turns also down, and their difference."""
    ways = [(way_map(result, direction), word) for word, direction in run_up.ways(result).items()]
    figure = Figure(figsize=(style.WIDTH, HEIGHT))
    panels = figure.subplots(1, 2 * len(ways) - 1, sharex=True, sharey=True, squeeze=False)[0]
    every = np.concatenate([shown.amplitudes for shown, _ in ways])
    if not np.isfinite(every).any():
        raise command.CommandError(f"{result.path} has no motion whose harmonics are known.")
    top, least = float(np.nanmax(every)), float(np.nanmin(every))
    levels = Normalize(max(least, top - 20.0 * DECADES), top)
    for axes, (shown, title) in zip(panels, ways, strict=False):
        _cells(axes, shown, levels)
        axes.set_title(title)
    _bar(figure, panels[: len(ways)], ScalarMappable(levels, COLOUR_MAP), LEVEL_LABEL)
    if len(ways) > 1:
        up, down = (shown for shown, _ in ways)
        speeds, of_up, of_down = np.intersect1d(up.speeds, down.speeds, return_indices=True)
        change = down.amplitudes[of_down] - up.amplitudes[of_up]
        most = max(float(np.nanmax(np.abs(change), initial=0.0)), LEAST_CHANGE)
        around = Normalize(-most, most)
        _cells(panels[2], Map(speeds, up.orders, change, up.half, "dB"), around, DIFFERENCE_COLOURS)
        panels[2].set_title("difference")
        _bar(figure, panels[2:], ScalarMappable(around, DIFFERENCE_COLOURS), "Change [dB]")
    for axes in panels:
        axes.set_xlabel("Order [-]")
        axes.set_xticks(ways[0][0].orders[1::2])
        for edge in np.ravel(sweep.hysteresis(result)):
            axes.axhline(edge, color="black", linewidth=0.8, linestyle=(0, (4, 2)))
    panels[0].set_ylabel("Shaft speed [1/min]")
    panels[0].set_xlim(up.orders[0] - 1.25 * up.half, up.orders[-1] + 1.25 * up.half)
    panels[0].set_ylim(up.speeds[0], up.speeds[-1])
    return figure


def _bar(figure: Figure, panels: Sequence[Axes], colours: ScalarMappable, label: str) -> None:
    """The colours of some panels, above them."""
    figure.colorbar(colours, ax=list(panels), label=label, location="top", aspect=20 * len(panels), pad=0.02)


def way_map(result: Result, direction: float) -> Map:
    """Levels [dB] of the orders of the force on one way of a sweep over speed; a failed motion is a gap."""
    first = run_up.first_order(result)
    if result.names[0] != run_up.SPEED or first is None or "harmonic_1" not in result:
        raise command.CommandError(f"{result.path} is no sweep over {run_up.KEY} with harmonics.")
    rows = sweep.of_direction(result, direction)
    rows = rows[np.argsort(result[run_up.SPEED][rows])]
    names = [name for name in result.names if re.fullmatch(r"harmonic_\d+", name)]
    amplitudes = np.column_stack([sweep.column(result, name, rows) for name in names])
    orders_of_force = first * np.arange(1, len(names) + 1)
    levels = orders.level(amplitudes)
    return Map(np.asarray(result[run_up.SPEED][rows]), orders_of_force, levels, 0.4 * first, "dB")


def _cells(axes: Axes, shown: Map, norm: Normalize, colours: str = COLOUR_MAP) -> None:
    """Each order as a strip; orders that are not computed stay empty."""
    middles = 0.5 * (shown.speeds[1:] + shown.speeds[:-1])
    edges = np.concatenate([[shown.speeds[0]], middles, [shown.speeds[-1]]])
    sides = np.column_stack([shown.orders - shown.half, shown.orders + shown.half]).ravel()
    # Between the strips of two orders there is a gap, which touching ones have without a width.
    cells = np.full((len(shown.speeds), len(sides) - 1), np.nan)
    cells[:, ::2] = np.maximum(shown.amplitudes, norm.vmin)
    axes.pcolormesh(sides, edges, np.ma.masked_invalid(cells), norm=norm, cmap=colours, rasterized=True)


def _mark(axes: Axes, kept: list[float]) -> None:
    """Kept orders above the map."""
    for order in kept:
        axes.plot(
            order,
            1.015,
            "v",
            transform=axes.get_xaxis_transform(),
            color="black",
            markersize=3.5,
            clip_on=False,
        )
        axes.annotate(
            f"{order:g}",
            (order, 1.0),
            (0.0, 7.0),
            xycoords=axes.get_xaxis_transform(),
            textcoords="offset points",
            ha="center",
            fontsize=7,
        )


def _label(shown: Map) -> str:
    relative = "relative " if shown.is_relative else ""
    return with_unit(f"amplitude of the {relative}{KINDS[shown.unit]}", shown.unit)
