"""Waterfall of a run-up: amplitude over order and speed, kept orders marked, computed ones beside."""

from __future__ import annotations

import re
from argparse import ArgumentParser, Namespace
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

import rattle
from rattle import command
from rattle.figures import orders, style
from rattle.figures.campaign_look import COLOUR_MAP, with_unit
from rattle.figures.fit import is_narrow

DESCRIPTION = (
    "Draw the waterfall of 'recording.py run-up', amplitude over order and speed, as waterfall_NAME; "
    "orders that its table kept are marked. --computed draws a campaign over shaft.speed_rpm that records "
    "harmonics beside it, each gear pair in a picture of its own."
)
DECADES = 3.0  # below the largest amplitude that are drawn
HEIGHT = 4.2  # inches
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
    parser.add_argument("waterfall", type=Path, metavar="NAME.waterfall.csv", help="of 'recording.py run-up'")
    parser.add_argument(
        "--computed", type=Path, metavar="RESULT", help="result of a campaign over speed, NAME.rattle"
    )


def run(options: Namespace) -> None:
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


def _cells(axes: Axes, shown: Map, norm: LogNorm) -> None:
    """Each order as a strip; orders that are not computed stay empty."""
    middles = 0.5 * (shown.speeds[1:] + shown.speeds[:-1])
    edges = np.concatenate([[shown.speeds[0]], middles, [shown.speeds[-1]]])
    sides = np.column_stack([shown.orders - shown.half, shown.orders + shown.half]).ravel()
    # Between the strips of two orders there is a gap, which touching ones have without a width.
    cells = np.full((len(shown.speeds), len(sides) - 1), np.nan)
    cells[:, ::2] = np.maximum(shown.amplitudes, norm.vmin)
    axes.pcolormesh(sides, edges, np.ma.masked_invalid(cells), norm=norm, cmap=COLOUR_MAP, rasterized=True)


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
