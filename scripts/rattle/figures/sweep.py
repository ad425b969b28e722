"""Steady motions along a swept key, on the way there and on the way back."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import rattle
from rattle import command
from rattle.codes import SUCCESSES
from rattle.figures import style
from rattle.result import Result

DESCRIPTION = "Draw the steady motions of a sweep along its key, there and back, as sweep_NAME."
KEY_LABELS = {
    "frequency": r"Excitation frequency $f_\mathrm{exc}$ [Hz]",
    "force_amplitude": r"Force amplitude $F_0$ [N]",
    "steady_force": r"Steady force $Q$ [N]",
    "entrainment_speed": r"Entrainment speed $U$ [m/s]",
}
WAYS = (("there", 1.0, style.RUN_COLOURS[0], "-"), ("back", -1.0, style.RUN_COLOURS[1], (0, (4, 2))))


def add_options(parser: ArgumentParser) -> None:
    parser.add_argument("result", type=Path, metavar="RESULT", help="result file of a sweep, NAME.rattle")


def run(options: Namespace) -> None:
    result = rattle.read(options.result)
    result.require_task("sweep")
    command.note_open(result)
    with style.house_style():
        for path in style.save(draw(result), options, f"sweep_{result.scene_name}"):
            print(path)


def draw(result: Result) -> Figure:
    """Film range, peak acceleration, period of the motion and Floquet multiplier over the swept key."""
    key = str(result.value("sweep", "key")).strip()
    figure = Figure(figsize=(style.WIDTH, 6.2))
    film, acceleration, period, multiplier = figure.subplots(
        4, 1, sharex=True, gridspec_kw={"height_ratios": (2.2, 2.2, 1, 1.6)}
    )
    for name, direction, colour, dashes in WAYS:
        rows = way(result, direction)
        if rows.size == 0:
            continue
        value = result[result.names[0]][rows]
        line = {"color": colour, "linestyle": dashes}
        film.semilogy(value, column(result, "film_maximum", rows, 1e6), label=f"way {name}", **line)
        film.semilogy(value, column(result, "film_minimum", rows, 1e6), **line)
        peak = np.maximum(
            np.abs(column(result, "acceleration_minimum", rows)), column(result, "acceleration_maximum", rows)
        )
        acceleration.plot(value, peak, **line)
        period.plot(value, column(result, "orbit_period", rows), **line)
        multiplier.plot(value, column(result, "floquet_modulus", rows), **line)
    label_values(film, r"Film, least and" "\n" r"largest [$\mathrm{\mu}$m]")
    label_values(acceleration, r"Largest $|\ddot{z}|$" "\n" r"[m/s$^2$]")
    label_values(period, "Period\n[$1/f_\\mathrm{exc}$]")
    label_values(multiplier, "Largest Floquet\nmultiplier")
    period.set_ylim(0.5, max(2.5, float(np.nanmax(result["orbit_period"])) + 0.5))
    multiplier.axhline(1.0, color=style.FAINT_COLOUR, linewidth=0.8)
    multiplier.set_ylim(0.0, 1.1)
    multiplier.set_xlabel(KEY_LABELS[key])
    film.set_title(f"Steady motions along a sweep\nScene {result.scene_name}, {result.law} film")
    style.legend_below(figure, film, columns=2)
    return figure


def way(result: Result, direction: float) -> np.ndarray:
    """Rows of one way; the way back begins with the last motion of the way there."""
    rows = np.flatnonzero(result["direction"] == direction)
    if direction < 0.0 and rows.size:
        rows = np.concatenate(([rows[0] - 1], rows))
    return rows


def column(result: Result, name: str, rows: np.ndarray, scale: float = 1.0) -> np.ndarray:
    """Values of some rows; motions that failed or were not found leave a gap."""
    values = scale * np.asarray(result[name][rows])
    unknown = (values == 0) & (name in ("orbit_period", "floquet_modulus"))
    return np.where(~np.isin(result["status"][rows], SUCCESSES) | unknown, np.nan, values)


def label_values(axes: Axes, text: str) -> None:
    axes.set_ylabel(text)
    axes.margins(x=0.01)
