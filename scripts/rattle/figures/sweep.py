"""Steady motions along a swept key, on the ways up and down; several sweeps in one figure."""

from __future__ import annotations

import argparse
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import rattle
from rattle import command, run_up
from rattle.campaign_section import short_name
from rattle.codes import SUCCESSES
from rattle.figures import style
from rattle.figures.campaign_look import with_unit
from rattle.result import Result

DESCRIPTION = (
    "Draw the steady motions of a sweep along its key, up and down, as sweep_NAME; several sweeps of one "
    "key as sweep_overlay."
)
KEY_LABELS = {
    "frequency": r"Excitation frequency $f_\mathrm{exc}$ [Hz]",
    "force_amplitude": r"Force amplitude $F_0$ [N]",
    "steady_force": r"Steady force $Q$ [N]",
    "entrainment_speed": r"Entrainment speed $U$ [m/s]",
    "stiffness": r"Stiffness of the teeth $k$ [N/m]",
}
WAYS = {"up": (style.RUN_COLOURS[0], "-"), "down": (style.RUN_COLOURS[1], (0, (4, 2)))}
SHADE = "0.85"
MARKED = 12  # marks along a curve of an overlay


@dataclass(frozen=True)
class Panel:
    """A panel: its label, the curves of some rows, and how high it is."""

    label: str
    curves: Callable[[Result, np.ndarray], Sequence[np.ndarray]]
    height: float = 2.2


def column(result: Result, name: str, rows: np.ndarray, scale: float = 1.0) -> np.ndarray:
    """Values of some rows; motions that failed or were not found leave a gap."""
    values = scale * np.asarray(result[name][rows])
    unknown = (values == 0) & (name in ("orbit_period", "floquet_modulus"))
    return np.where(~np.isin(result["status"][rows], SUCCESSES) | unknown, np.nan, values)


def _films(result: Result, rows: np.ndarray) -> list[np.ndarray]:
    return [column(result, name, rows, 1e6) for name in ("film_maximum", "film_minimum")]


def _peak(result: Result, rows: np.ndarray) -> list[np.ndarray]:
    lowest = np.abs(column(result, "acceleration_minimum", rows))
    return [np.maximum(lowest, column(result, "acceleration_maximum", rows))]


def _plain(name: str) -> Callable[[Result, np.ndarray], Sequence[np.ndarray]]:
    return lambda result, rows: [column(result, name, rows)]


def _rate(result: Result, rows: np.ndarray) -> list[np.ndarray]:
    if not run_up.is_run_up(result):
        raise command.CommandError(f"{result.path} is no sweep over shaft.speed_rpm, which has a rate.")
    return [run_up.pace(result).rates[rows]]


PANELS = {
    "film": Panel(r"Film [$\mathrm{\mu}$m]", _films),
    "acceleration": Panel(r"Peak $|\ddot{z}|$ [m/s$^2$]", _peak),
    "harmonics": Panel("Harmonics", _plain("harmonic_count")),
    "period": Panel(r"Period [$1/f$]", _plain("orbit_period"), 1.0),
    "multiplier": Panel("Floquet multiplier", _plain("floquet_modulus"), 1.6),
    "rate": Panel("Rate [1/min/s]", _rate, 1.6),
}
DEFAULT_PANELS = ("film", "acceleration", "period", "multiplier")
RATE = "rate"  # drawn of sweeps over speed, unless panels are chosen


def add_options(parser: ArgumentParser) -> None:
    parser.add_argument(
        "results", nargs="+", type=Path, metavar="RESULT", help="result file of a sweep, NAME.rattle"
    )
    parser.add_argument(
        "--panels",
        type=panels,
        default=None,
        metavar="NAMES",
        help=f"of {', '.join(PANELS)} (all but harmonics; rate of a run-up only)",
    )
    parser.add_argument(
        "--mark",
        type=mark,
        action="append",
        default=[],
        metavar="VALUE=WORDS",
        help="a rule at a value of the key, with words on it; may be repeated",
    )


def panels(text: str) -> tuple[str, ...]:
    chosen = command.names(text)
    for name in chosen:
        if name not in PANELS:
            raise argparse.ArgumentTypeError(f"'{name}' is not one of {', '.join(PANELS)}")
    if not chosen:
        raise argparse.ArgumentTypeError("no panel is named")
    return tuple(dict.fromkeys(chosen))


def mark(text: str) -> tuple[float, str]:
    value, equals, words = text.partition("=")
    if not equals or not words.strip():
        raise argparse.ArgumentTypeError(f"'{text}' is not a value and words, as in 1.4e8=steel")
    return command.finite(value), words.strip()


def run(options: Namespace) -> None:
    results = [rattle.read(path) for path in options.results]
    for result in results:
        result.require_rows("sweep")
        command.note_open(result)
    keys = {key_of(result) for result in results}
    if len(keys) > 1:
        raise command.CommandError(
            f"The sweeps are of different keys, {' and '.join(sorted(keys))}; each has a figure of its own."
        )
    most = len(style.RUN_COLOURS)
    if len(results) > most:
        raise command.CommandError(f"An overlay shows {most} sweeps at most; {len(results)} were given.")
    stem = f"sweep_{results[0].scene_name}" if len(results) == 1 else "sweep_overlay"
    with style.house_style():
        made = draw(*results, panels=options.panels, marks=options.mark)
        print(*style.save([(stem, made)], options), sep="\n")


def draw(
    *results: Result, panels: Sequence[str] | None = None, marks: Sequence[tuple[float, str]] = ()
) -> Figure:
    """The panels over the swept key; of several sweeps each has colour and mark, a direction its dashes."""
    if panels is None:
        panels = (*DEFAULT_PANELS, *([RATE] if all(map(run_up.is_run_up, results)) else []))
    chosen = [PANELS[name] for name in panels]
    heights = [panel.height for panel in chosen]
    figure = Figure(figsize=(style.WIDTH, 0.8 + 0.77 * sum(heights)))
    all_axes = dict(
        zip(
            panels,
            figure.subplots(len(chosen), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0],
            strict=True,
        )
    )
    handles = _draw_single(results[0], all_axes) if len(results) == 1 else _draw_overlay(results, all_axes)
    for name, axes in all_axes.items():
        axes.set_ylabel(label_of(name, results))
        axes.margins(x=0.01)
    _dress(results, all_axes)
    first, last = all_axes[panels[0]], all_axes[panels[-1]]
    last.set_xlabel(_key_label(results[0]))
    logarithmic = str(results[0].input.get("sweep", {}).get("spacing", "linear")).strip() == "logarithmic"
    if logarithmic:
        last.set_xscale("log")
    if marks and first.get_yscale() == "linear":
        low, high = first.get_ylim()
        first.set_ylim(low, high + 0.12 * (high - low))
    for value, words in marks:
        for axes in all_axes.values():
            axes.axvline(value, color=style.FAINT_COLOUR, linewidth=0.8, linestyle=(0, (2, 2)), zorder=0)
        first.annotate(
            words,
            (value, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(3, -2),
            textcoords="offset points",
            verticalalignment="top",
            fontsize=8,
            path_effects=style.HALO,
        )
    single = f"{results[0].scene_name}, {style.film_words(results[0])}"
    words = single if len(results) == 1 else f"{len(results)} sweeps"
    first.set_title(f"Steady motions: {words}")
    figure.align_ylabels()
    style.legend_below(figure, first, columns=2, labels=handles)
    return figure


def label_of(name: str, results: Sequence[Result]) -> str:
    """The label of a panel; the acceleration of gears is relative to the shaft."""
    label = PANELS[name].label
    if name == "acceleration" and any(result.has_gear for result in results):
        return label.replace("Peak", "Relative peak")
    return label


def _draw_single(result: Result, all_axes: Mapping[str, Axes]) -> dict[str, object]:
    handles: dict[str, object] = {}
    shaded = _shade(result, all_axes)
    for name, direction in run_up.ways(result).items():
        colour, dashes = WAYS[name]
        rows = of_direction(result, direction)
        value = result[result.names[0]][rows]
        for panel, axes in all_axes.items():
            for values in PANELS[panel].curves(result, rows):
                (curve,) = axes.plot(value, values, color=colour, linestyle=dashes)
                handles.setdefault(name, curve)
    return handles | shaded


def _shade(result: Result, all_axes: Mapping[str, Axes]) -> dict[str, object]:
    """Stretches in which both ways have motions of their own."""
    handles: dict[str, object] = {}
    for stretch in hysteresis(result):
        for axes in all_axes.values():
            band = axes.axvspan(*stretch, color=SHADE, lw=0.0, zorder=0)
        handles["hysteresis"] = band
    return handles


def hysteresis(result: Result) -> list[tuple[float, float]]:
    """Stretches in which both ways have motions of their own, half a step beyond their last values."""
    values = np.unique(result[result.names[0]])
    apart = np.flatnonzero(np.isin(values, run_up.differing(result)))
    middles = np.concatenate([values[:1], 0.5 * (values[1:] + values[:-1]), values[-1:]])
    stretches = np.split(apart, np.flatnonzero(np.diff(apart) > 1) + 1) if apart.size else []
    return [(middles[stretch[0]], middles[stretch[-1] + 1]) for stretch in stretches]


def _draw_overlay(results: Sequence[Result], all_axes: Mapping[str, Axes]) -> dict[str, object]:
    handles: dict[str, object] = {}
    directions: dict[str, object] = {}
    for position, (result, label) in enumerate(zip(results, style.run_labels(results), strict=True)):
        look = {
            "color": style.RUN_COLOURS[position],
            "marker": style.RUN_MARKS[position],
            "markersize": 3.6,
        }
        handles[f"{label}, {style.film_words(result)}"] = Line2D([], [], **look)
        for name, direction in run_up.ways(result).items():
            rows = of_direction(result, direction)
            thin = {"linestyle": WAYS[name][1], "linewidth": 1.2 if direction > 0.0 else 0.9}
            directions.setdefault(name, Line2D([], [], color=style.FORCE_COLOUR, **thin))
            value = result[result.names[0]][rows]
            marked = _marked(value, position / len(results))
            for panel, axes in all_axes.items():
                for values in PANELS[panel].curves(result, rows):
                    axes.plot(value, values, markevery=marked, **look, **thin)
    return handles | directions


def _marked(values: np.ndarray, offset: float) -> list[int]:
    """Rows with a mark, the same values in both directions, from a share of their distance on."""
    each = max(1, values.size // MARKED)
    places = np.sort(values)[int(offset * each) :: each]
    return list(np.flatnonzero(np.isin(values, places)))


def _dress(results: Sequence[Result], all_axes: Mapping[str, Axes]) -> None:
    """Scales, limits and rules that belong to a panel."""
    if film := all_axes.get("film"):
        film.set_yscale("log")
    if period := all_axes.get("period"):
        longest = max(float(np.nanmax(result["orbit_period"])) for result in results)
        period.set_ylim(0.5, max(2.5, longest + 0.5))
    if multiplier := all_axes.get("multiplier"):
        multiplier.axhline(1.0, color=style.FAINT_COLOUR, linewidth=0.8)
        multiplier.set_ylim(0.0, 1.1)
    if rate := all_axes.get(RATE):
        rate.set_yscale("log")
        rate.yaxis.set_major_formatter("{x:g}")
        rate.yaxis.set_minor_formatter("")
    if lines := all_axes.get("harmonics"):
        lines.set_ylim(bottom=0.0)
        limits = {result.input.get("spectrum", {}).get("idle_harmonics") for result in results} - {None}
        if len(limits) == 1:
            (limit,) = limits
            lines.axhline(limit, color=style.FAINT_COLOUR, linewidth=0.8, zorder=0)
            lines.annotate(
                f"idle from {limit} harmonics on",
                (1.0, limit),
                xycoords=("axes fraction", "data"),
                xytext=(0, -2),
                textcoords="offset points",
                horizontalalignment="right",
                verticalalignment="top",
                fontsize=8,
                path_effects=style.HALO,
            )


def key_of(result: Result) -> str:
    return str(result.value("sweep", "key")).strip()


def _key_label(result: Result) -> str:
    """Symbols where they are known, else name and unit."""
    name = result.names[0]
    return KEY_LABELS.get(key_of(result)) or with_unit(short_name(name), result.units[name])


def of_direction(result: Result, direction: float) -> np.ndarray:
    """Rows of one direction; the way back begins with the last motion of the way there."""
    rows = np.flatnonzero(result["direction"] == direction)
    if direction < 0.0 and rows.size:
        rows = np.concatenate(([rows[0] - 1], rows))
    return rows
