"""Order cuts as a test bench gives them: levels of engine orders over speed, also as Campbell picture."""

from __future__ import annotations

import math
import re
from argparse import ArgumentParser, Namespace
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import rattle
from rattle import command
from rattle.campaign_result import Campaign
from rattle.counts import counted
from rattle.csv_table import read_csv_table
from rattle.figures import style
from rattle.figures.campaign_look import cell_edges
from rattle.figures.spectra import LEVEL_LABEL, REFERENCE
from rattle.run_up import first_order

DESCRIPTION = (
    "Draw the level of the acceleration at each engine order over the speed of the shaft, as orders_NAME: "
    "curves over a Campbell picture. The result is a campaign that varies shaft.speed_rpm alone and records "
    "harmonics. --measured lays order cuts of a test bench over it, with the differences of level."
)
SPEED = "shaft.speed_rpm"
MOST_CURVES = 4
SUBJECT = "Orders of the acceleration"
# Measured cuts: a head as it may be, and the units that are needed.
HEAD, PER_MINUTE, ACCELERATION = "speed_rpm,order_2", "1/min", "m/s2"
ORDER_COLUMN = re.compile(r"order_(\d+(?:\.\d*)?)")


@dataclass(frozen=True)
class Cuts:
    """Amplitudes over speed: a row for each speed, a column for each engine order [m/s2]."""

    speeds: np.ndarray
    orders: tuple[float, ...]
    amplitudes: np.ndarray

    def at(self, order: float) -> np.ndarray | None:
        """The cut of an order, None where there is none."""
        for place, own in enumerate(self.orders):
            if math.isclose(own, order, rel_tol=1e-6):
                return self.amplitudes[:, place]
        return None


def add_options(parser: ArgumentParser) -> None:
    parser.add_argument("result", type=Path, metavar="RESULT", help="result of a campaign, NAME.rattle")
    parser.add_argument(
        "--measured",
        type=Path,
        metavar="FILE.csv",
        help="measured cuts: columns speed_rpm and order_O with amplitudes of order O, as in order_2 [m/s2]; "
        "other units of speed and acceleration are converted",
    )


def run(options: Namespace) -> None:
    campaign = rattle.read_campaign(options.result)
    measured = None if options.measured is None else read_measured(options.measured)
    pairs = [(pair, computed(pair)) for pair in campaign.pairs]
    if measured is not None and not any(
        cuts.at(order) is not None for _, cuts in pairs for order in measured.orders
    ):
        raise command.CommandError(
            f"{options.measured} has orders {_words(measured.orders)}, "
            f"the campaign {_words(pairs[0][1].orders)}."
        )
    with style.house_style():
        drawn = [(f"orders_{pair.name}", draw(pair, cuts, measured)) for pair, cuts in pairs]
        print(*style.save(drawn, options), sep="\n")
    if measured is not None:
        for pair, cuts in pairs:
            print(*comparison(pair.name, cuts, measured), sep="\n")


def computed(campaign: Campaign) -> Cuts:
    """The order cuts of a campaign over speed."""
    if campaign.varied != (SPEED,):
        raise command.CommandError(f"{campaign.path} varies {', '.join(campaign.varied)}, not {SPEED} alone.")
    names = [name for name in campaign.names if re.fullmatch(r"harmonic_\d+", name)]
    if not names:
        raise command.CommandError(f"{campaign.path} has no harmonics: name 'harmonics' in campaign.record.")
    first = first_order(campaign)
    if first is None:
        raise command.CommandError(f"{campaign.path} has no &shaft whose orders could count.")
    order = np.argsort(campaign[SPEED])
    usable = campaign.done & ~campaign.failed
    amplitudes = np.column_stack(
        [np.where(usable, np.array(campaign[name], dtype=float), np.nan) for name in names]
    )
    orders = tuple(round(first * int(name.rpartition("_")[2]), 9) for name in names)
    return Cuts(np.array(campaign[SPEED])[order], orders, amplitudes[order])


def read_measured(path: Path) -> Cuts:
    """Measured order cuts; an empty field is a gap."""
    table = read_csv_table(path, HEAD)
    speeds, columns = None, {}
    for place, name in enumerate(table.names):
        bare, unit = table.name_of(place, PER_MINUTE)
        found = ORDER_COLUMN.fullmatch(table.name_of(place, ACCELERATION)[0])
        if found and float(found[1]) not in columns:
            columns[float(found[1])] = table.column(place, ACCELERATION)
        elif speeds is None and bare == "speed" and unit:
            speeds = table.column(place, PER_MINUTE)
        else:
            raise command.CommandError(
                f"{path}:{table.header}: column {place + 1} ({name}) is neither the speed nor an order, "
                f"or is there twice; the head has to be {HEAD},..."
            )
    if speeds is None or not columns:
        raise command.CommandError(f"{path}:{table.header}: the head has to be {HEAD},...")
    amplitudes = np.column_stack(list(columns.values()))
    for wrong, words in (
        (~np.isfinite(speeds), "a speed is missing"),
        (np.diff(speeds, prepend=-np.inf) <= 0.0, "the speeds must ascend"),
        (np.any(amplitudes < 0.0, axis=1), "an amplitude is negative"),
    ):
        if wrong.any():
            raise command.CommandError(f"{path}:{table.lines[np.argmax(wrong)]}: {words}.")
    if len(speeds) < 2:
        raise command.CommandError(f"{path} needs two speeds at least.")
    return Cuts(speeds, tuple(columns), amplitudes)


def comparison(name: str, cuts: Cuts, measured: Cuts) -> list[str]:
    """By how much computed levels differ from measured ones, between the speeds that both have."""
    lines = []
    for order in measured.orders:
        own, heard = cuts.at(order), measured.at(order)
        if own is None or heard is None:
            lines.append(f"{name}, order {order:g}: measured, not computed")
            continue
        differences = level(np.interp(measured.speeds, cuts.speeds, own, left=np.nan, right=np.nan))
        differences -= level(heard)
        differences = differences[np.isfinite(differences)]
        if not differences.size:
            lines.append(f"{name}, order {order:g}: no speed in common")
            continue
        lines.append(
            f"{name}, order {order:g}: computed less measured {np.mean(differences):+.1f} dB in the mean, "
            f"{differences.min():+.1f} to {differences.max():+.1f} dB at {counted(differences.size, 'speed')}"
        )
    return lines


def draw(campaign: Campaign, cuts: Cuts, measured: Cuts | None) -> Figure:
    """Cuts of the strongest orders, or of those that were measured, above the Campbell picture."""
    figure = Figure(figsize=(style.WIDTH, 6.0))
    above, below = figure.subplots(2, 1)
    main = None if measured else _main_order(campaign, cuts)
    for place, order in enumerate(_chosen(campaign, cuts, measured)):
        own = cuts.at(order)
        assert own is not None, "chosen are computed orders"
        line = style.run_line(place)
        of_engine = ", main order of the engine" if order == main else ""
        above.plot(cuts.speeds, level(own), label=f"order {order:g}{of_engine}", **line)
        if measured is not None and (heard := measured.at(order)) is not None:
            look = {"linestyle": "none", "marker": "o", "markersize": 3.5, "markerfacecolor": "none"}
            label = f"order {order:g}, measured"
            above.plot(measured.speeds, level(heard), color=line["color"], label=label, **look)
    above.set_ylabel(LEVEL_LABEL)
    above.set_xlim(cuts.speeds[0], cuts.speeds[-1])
    above.set_xlabel("Shaft speed [1/min]")
    subject = style.relative_label(SUBJECT) if campaign.has_gear else SUBJECT
    above.set_title(f"{subject}: {campaign.name}, {style.film_words(campaign)}")
    style.legend_below(figure, above, 4)
    _campbell(figure, below, campaign, cuts)
    return figure


def _campbell(figure: Figure, axes: Axes, campaign: Campaign, cuts: Cuts) -> None:
    """Every order as a ray of frequency over speed, coloured by its level."""
    levels = level(cuts.amplitudes)
    top = np.nanmax(levels, initial=0.0)
    edges = cell_edges(campaign.axes[0])
    for place, order in enumerate(cuts.orders):
        half = 0.5 * cuts.orders[0]
        frequencies = np.outer([order - half, order + half], edges / 60.0)
        mesh = axes.pcolormesh(
            np.tile(edges, (2, 1)),
            frequencies,
            levels[None, :, place],
            vmin=top - 60.0,
            vmax=top,
            cmap="viridis",
        )
        axes.text(edges[-1], order * edges[-1] / 60.0, f" {order:g}", va="center", fontsize=7, clip_on=False)
    axes.set_xlim(edges[0], edges[-1])
    axes.set_ylim(0.0, (cuts.orders[-1] + 0.5 * cuts.orders[0]) * edges[-1] / 60.0)
    axes.set_xlabel("Shaft speed [1/min]; engine orders at the right")
    axes.set_ylabel("Frequency [Hz]")
    figure.colorbar(mesh, ax=axes, label=LEVEL_LABEL, pad=0.05)


def _chosen(campaign: Campaign, cuts: Cuts, measured: Cuts | None) -> list[float]:
    """The orders that were measured, or the strongest, the main one of the engine always among them."""
    if measured is not None:
        return [order for order in measured.orders if cuts.at(order) is not None]
    strongest = np.argsort(-np.nan_to_num(np.nanmax(cuts.amplitudes, axis=0)), kind="stable")
    main = _main_order(campaign, cuts)
    ranked = [main] if cuts.at(main) is not None else []
    ranked += [cuts.orders[place] for place in strongest if cuts.orders[place] not in ranked]
    return sorted(ranked[:MOST_CURVES])


def _main_order(campaign: Campaign, cuts: Cuts) -> float:
    """The order that shakes the gear most at the speed of the input, as the firing order of an engine."""
    found = [
        re.search(rf"^! derived: load\.{name} = ([^N\n]+)", campaign.input_text, re.MULTILINE)
        for name in ("force_orders", "force_amplitudes")
    ]
    lists = [[float(value) for value in one[1].split(",")] for one in found if one]
    if len(lists) < len(found):
        return cuts.orders[0]
    harmonics, sizes = lists
    return harmonics[int(np.argmax(np.abs(sizes)))] * cuts.orders[0]


def level(amplitudes: np.ndarray) -> np.ndarray:
    """Level of an amplitude [dB]."""
    with np.errstate(divide="ignore"):
        levels = 20.0 * np.log10(np.asarray(amplitudes) / REFERENCE)
    return np.where(np.isfinite(levels), levels, np.nan)


def _words(orders: tuple[float, ...]) -> str:
    return ", ".join(f"{order:g}" for order in orders)
