"""Figures 7, 10a and 10b: spectra of force and acceleration, computed by the Fortran kernel.

They stand over f/f_exc, over the engine orders of a shaft, or over Hz.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rattle.figures import style
from rattle.result import Result, ResultError
from rattle.summary import Summary, read_summary
from rattle.verdict import classify, forced, thresholds

LAST_FORCE_RATIO = 5.0
SUBJECT = "Spectrum of the acceleration"
FLOOR = 1e-5  # of the largest harmonic; below it the logarithmic panel ends
GROUP_WIDTH = 0.4  # of runs side by side, less than the distance of half-integer harmonics
ROOM_FOR_LINES = 100.0  # points that harmonics may cover, also in a column
SMALLEST_LAST_RATIO = 10.0
LARGEST_FAINT_RATIO = 40.0  # up to which harmonics below the threshold have room
ROOM_BELOW = 0.1  # of the least amplitude that counts, where the axis ends
AS_GOOD = 0.01  # of the largest harmonic, by which samples miss none that is known better
RESOLVED = 10  # samples in the period of a harmonic that they are taken to resolve
MOST_LINEAR = 100.5  # harmonics that stand beside each other; of more the axis is logarithmic
MOST_NAMED = 8  # orders of the force that a legend names
FREQUENCY_LABELS = {"ratio": style.RATIO_LABEL, "hz": "Frequency [Hz]", "order": "Engine order [-]"}
REFERENCE = 1e-6  # m/s2, of levels
LEVEL_LABEL = r"Level [dB re 10$^{-6}$ m/s$^2$]"


@dataclass(frozen=True)
class View:
    """Over what spectra are shown ('order': of a shaft at this speed [1/min] or its own); if as levels.

    By default over engine orders where all results have a shaft, else over multiples of the frequency.
    """

    frequency: str | None = None
    shaft_speed: float | None = None
    decibels: bool = True

    def settled(self, results: Sequence[Result]) -> View:
        """The same with the frequency that these results are shown over."""
        shafts = all(result.shaft_speed for result in results)
        return self if self.frequency else replace(self, frequency="order" if shafts else "ratio")

    def factor(self, result: Result) -> float:
        """What multiples of the frequency of the force are multiplied by."""
        if self.frequency == "ratio":
            return 1.0
        if self.frequency == "hz":
            return result.frequency
        return engine_order(result, 1.0, self.shaft_speed)


PLAIN = View()


def engine_order(result: Result, multiple: float, speed: float | None = None) -> float:
    """The order, of the shaft or of one of this speed [1/min], that a multiple of the frequency is."""
    speed = speed or result.shaft_speed
    if not speed:
        raise ResultError(
            f"{result.path} has no &shaft speed_rpm that orders could count; give --shaft-speed."
        )
    return multiple * result.frequency / (speed / 60.0)


def draw_force(
    results: Sequence[Result], labels: Sequence[str], window: int | None, view: View = PLAIN
) -> Figure:
    """Figure 7: harmonics of the force of one run, or of several side by side."""
    figure = Figure(figsize=(style.WIDTH, 2.6))
    axes = figure.subplots()
    single = len(results) == 1
    view = view.settled(results)
    scale = _frequency_label(results, view)
    last = max(LAST_FORCE_RATIO, 0.5 + max(map(_last_harmonic, results)))
    largest = 0.0
    lines = style.run_lines([result.law for result in results])
    for position, (result, label, line) in enumerate(zip(results, labels, lines, strict=True)):
        ratio, amplitude = column_spectrum(result, "applied_force", window)
        shown = ratio <= last
        shift = 0.06 * (position - 0.5 * (len(results) - 1))
        place = view.factor(result) * (ratio[shown] + shift)
        look = {"linewidth": 2.0, "color": line["color"]}
        axes.vlines(place, 0.0, amplitude[shown], label=label, **look)
        largest = max(largest, float(amplitude[shown].max()))
        if single:
            _name_lines(axes, result, place, ratio[shown], amplitude[shown])
    widest = max(map(view.factor, results))
    axes.set_xlim(-0.25 * widest, last * widest)
    axes.set_ylim(0.0, 1.12 * largest if largest > 0.0 else 1.0)
    axes.set_ylabel("Amplitude of $F$ [N]")
    axes.set_xlabel(scale if single else f"{scale}; runs side by side")
    style.name_runs(figure, axes, "Spectrum of the applied force", results, labels)
    return figure


def _name_lines(
    axes: Axes, result: Result, place: np.ndarray, ratio: np.ndarray, amplitude: np.ndarray
) -> None:
    """Say what the mean and the largest line of the excitation are."""
    at_excitation = int(np.argmin(np.abs(ratio - 1.0)))
    if _harmonics_of_force(result).size:
        at_excitation = 1 + int(np.argmax(amplitude[1:]))
    frequency = ratio[at_excitation] * result.frequency
    names = (
        (0, f"mean\n{amplitude[0]:.4g} N"),
        (at_excitation, f"{amplitude[at_excitation]:.4g} N\nat {frequency:.4g} Hz"),
    )
    for position, name in names:
        axes.annotate(
            name,
            (place[position], amplitude[position]),
            xytext=(4, 0),
            textcoords="offset points",
            verticalalignment="top",
            fontsize=8,
        )


def draw_acceleration(
    results: Sequence[Result], labels: Sequence[str], window: int | None, view: View = PLAIN
) -> Figure:
    """Figure 10: every harmonic that counts, as levels, or as amplitudes as in the paper."""
    figure = Figure(figsize=(style.WIDTH, 3.6))
    axes = figure.subplots()
    view = view.settled(results)
    subject = style.of_acceleration(SUBJECT, results)
    scale = _frequency_label(results, view)
    summaries = [better_summary(result, window) for result in results]
    spectra = [
        prolonged(summary, result) if summary else column_spectrum(result, "acceleration", window)
        for result, summary in zip(results, summaries, strict=True)
    ]
    largest = max(float(amplitude[1:].max()) for _, amplitude in spectra)
    end = max(map(_last_ratio, results, spectra))
    factors = [view.factor(result) for result in results]
    if len(results) == 1:
        unknown = results[0].coarse and not summaries[0]
        verdict = None if unknown else summaries[0] or classify(results[0], window)
        _draw_single(figure, axes, results[0], spectra[0], verdict, view, end)
        if unknown:
            style.note(axes, f"{style.FEW_SAMPLES}: these harmonics are those of the samples")
        axes.set_title(style.title(subject, results[0], labels[0]))
        axes.set_xlabel(scale)
    else:
        names = [
            f"{label}, by its summary" if summary else style.curve_label(label, result.coarse)
            for result, summary, label in zip(results, summaries, labels, strict=True)
        ]
        handles = _draw_overlay(axes, names, spectra, factors)
        axes.set_title(style.overlay_title(subject, results))
        axes.set_xlabel(f"{scale}; runs side by side")
        style.legend_below(figure, axes, labels=handles)
    axes.set_xlim(0.0, end * max(factors))
    if end > MOST_LINEAR:
        axes.set_xscale("log")
        axes.set_xlim(0.8 * min(factors), end * max(factors))
        low, high = axes.get_xlim()
        ticks = [step * 10.0**decade for decade in range(-2, 6) for step in (1, 2, 5)]
        axes.set_xticks([tick for tick in ticks if low <= tick <= high])
        axes.xaxis.set_major_formatter("{x:g}")
        axes.set_xticks([], minor=True)
    axes.set_ylim(0.0, 1.08 * largest if largest > 0.0 else 1.0)
    axes.set_ylabel(style.of_acceleration(style.AMPLITUDE_LABEL, results))
    if view.decibels and largest > 0.0:
        counted = min(map(_least_counted, results, spectra))
        axes.set_yscale("log")
        axes.set_ylim(max(ROOM_BELOW * counted, FLOOR * largest), 3.0 * largest)
        _show_levels(axes)
    return figure


def share_ranges(figures: Sequence[Figure]) -> None:
    """Let figures by draw_acceleration that show the same frequencies end at the same one."""
    ends: dict[str, float] = {}
    for figure in figures:
        panel = figure.axes[-1]
        ends[panel.get_xlabel()] = max(ends.get(panel.get_xlabel(), 0.0), panel.get_xlim()[1])
    for figure in figures:
        panel = figure.axes[-1]
        panel.set_xlim(panel.get_xlim()[0], ends[panel.get_xlabel()])


def _show_levels(axes: Axes) -> None:
    """Name the amplitudes of a logarithmic axis by their levels."""
    low, high = (20.0 * math.log10(end / REFERENCE) for end in axes.get_ylim())
    levels = np.arange(20.0 * math.ceil(low / 20.0), high, 20.0)
    axes.set_yticks(REFERENCE * 10.0 ** (levels / 20.0), [f"{level:.0f}" for level in levels])
    axes.set_yticks([], minor=True)
    axes.set_ylabel(LEVEL_LABEL)


def _draw_single(
    figure: Figure,
    axes: Axes,
    result: Result,
    spectrum: tuple[np.ndarray, np.ndarray],
    verdict: Mapping[str, Any] | None,
    view: View,
    end: float,
) -> None:
    ratio, amplitude = spectrum
    thick = {"linewidth": min(1.8, max(ROOM_FOR_LINES / end, 0.3))}
    place = view.factor(result) * ratio
    periods = round(1.0 / ratio[1])
    harmonic = np.arange(amplitude.size) % periods == 0
    harmonic[0] = False
    between = ~harmonic & (amplitude > FLOOR * amplitude[1:].max())  # the others could not be seen
    between[0] = False
    threshold = thresholds(result)["harmonic_threshold"]
    colour = style.law_colour(result.law)
    handles = {}
    of_force = _harmonics_of_force(result)
    driven = harmonic & np.isin(ratio, of_force)
    lines = axes.vlines(place[between], 0.0, amplitude[between], color=style.FAINT_COLOUR, linewidth=0.9)
    handles[f"harmonics of {result.frequency:.4g} Hz"] = axes.vlines(
        place[harmonic & ~driven], 0.0, amplitude[harmonic & ~driven], color=colour, **thick
    )
    if driven.any():
        axes.vlines(place[driven], 0.0, amplitude[driven], color=style.FORCE_COLOUR, **thick)
        (handles[_force_words(place[driven], view)],) = axes.plot(
            place[driven],
            amplitude[driven],
            color=style.FORCE_COLOUR,
            marker="o",
            markersize=3.4,
            linestyle="",
        )
    if between.any():
        handles["between the harmonics"] = lines
    # Under several, harmonics are compared with the largest forced one.
    reference = 1
    if of_force.size:
        forced_lines = np.where(driven, amplitude, -1.0)
        reference = (verdict or {}).get("reference_line", int(np.argmax(forced_lines)) // periods)
    if reference and amplitude[reference * periods] > 0.0:
        name = "the first harmonic" if reference == 1 else f"harmonic {reference}"
        if view.frequency == "order":
            name = f"the line of engine order {engine_order(result, reference, view.shaft_speed):.4g}"
        handles[f"{100 * threshold:.3g} % of {name}"] = axes.axhline(
            threshold * amplitude[reference * periods],
            color=style.FORCE_COLOUR,
            linewidth=0.9,
            linestyle=(0, (4, 2)),
        )
    style.legend_below(figure, axes, labels=handles)


def _force_words(orders: np.ndarray, view: View) -> str:
    """The harmonics of the force in a legend, by their engine orders where these are few."""
    if view.frequency != "order" or orders.size > MOST_NAMED:
        return "at harmonics of the force"
    return f"orders of the force: {', '.join(f'{order:.4g}' for order in orders)}"


def _harmonics_of_force(result: Result) -> np.ndarray:
    """Harmonics of the force that a picture shows; none for the cosine of the paper."""
    force = forced(result)
    if not force:
        return np.zeros(0)
    amplitudes = np.abs(force["force_amplitudes"])
    return np.asarray(force["force_orders"])[amplitudes > FLOOR * amplitudes.max()]


def _last_harmonic(result: Result) -> float:
    """The last harmonic of a force; 0 of a cosine, which needs no room of its own."""
    return float(_harmonics_of_force(result).max(initial=0))


def _frequency_label(results: Sequence[Result], view: View) -> str:
    """What the axis counts: harmonics where a force is given by several of them, if ratios are shown."""
    if view.frequency != "ratio":
        return FREQUENCY_LABELS[view.frequency or "ratio"]
    if not any(_harmonics_of_force(result).size for result in results):
        return style.RATIO_LABEL
    bases = {result.frequency for result in results}
    return (
        f"Harmonic, multiple of {max(bases):.4g} Hz"
        if len(bases) == 1
        else "Harmonic, multiple of each base frequency"
    )


def _draw_overlay(
    axes: Axes,
    labels: Sequence[str],
    spectra: Sequence[tuple[np.ndarray, np.ndarray]],
    factors: Sequence[float],
) -> dict[str, object]:
    """Harmonics side by side, each run with a mark of its own on those that can be seen; returns its
    legend."""
    spacing = min(0.16, GROUP_WIDTH / len(spectra))
    largest = max(float(amplitude[1:].max()) for _, amplitude in spectra)
    handles: dict[str, object] = {}
    for position, ((ratio, amplitude), label, factor) in enumerate(
        zip(spectra, labels, factors, strict=True)
    ):
        look = {"color": style.run_line(position)["color"], "linewidth": 1.3}
        mark = {"marker": style.RUN_MARKS[position], "markersize": 2.6}
        place = factor * (ratio + spacing * (position - 0.5 * (len(spectra) - 1)))
        seen = np.flatnonzero(amplitude > FLOOR * largest)
        seen = seen[seen > 0]
        axes.vlines(place[1:], 0.0, amplitude[1:], label=label, **look)
        axes.plot(place[seen], amplitude[seen], linestyle="", color=look["color"], **mark)
        handles[label] = Line2D([], [], **look, **mark)
    return handles


def _last_ratio(result: Result, spectrum: tuple[np.ndarray, np.ndarray]) -> float:
    """Where the axis ends: behind the last harmonic that counts, and within limits behind fainter ones."""
    ratio, amplitude = spectrum[0][1:], spectrum[1][1:]
    of_force = _forcing(result)
    least = _least_counted(result, spectrum)
    counted = ratio[(amplitude > least) & (ratio % 1.0 == 0.0) & (least > 0.0)]
    faint = ratio[amplitude > FLOOR * amplitude.max()]
    ends = (SMALLEST_LAST_RATIO, max(of_force), counted.max(initial=0.0))
    return math.ceil(max(*ends, min(faint.max(initial=0.0), LARGEST_FAINT_RATIO))) + 0.5


def _forcing(result: Result) -> np.ndarray:
    """Harmonics of the force, of a cosine the first."""
    of_force = _harmonics_of_force(result)
    return of_force if of_force.size else np.ones(1)


def _least_counted(result: Result, spectrum: tuple[np.ndarray, np.ndarray]) -> float:
    """The amplitude above which a harmonic counts."""
    ratio, amplitude = spectrum
    largest = amplitude[np.isin(ratio, _forcing(result))].max(initial=0.0)
    return float(thresholds(result)["harmonic_threshold"] * largest)


def better_summary(result: Result, window: int | None) -> Summary | None:
    """The summary of a series that is coarser than its motion, where it knows the harmonics of the same
    window.

    They come from more samples than the series has, or from integrals over the steps of the solution.
    """
    if not result.coarse or not result.summary_path.exists():
        return None
    summary = read_summary(result.summary_path)
    resolved = summary.get("sampling_sufficient", False) and "harmonics" in summary
    return summary if resolved and window in (None, summary["window_periods"]) else None


def harmonics_of(summary: Summary) -> tuple[np.ndarray, np.ndarray]:
    """Frequency ratio and amplitudes [m/s2] of the harmonics that a summary lists, behind a mean of zero."""
    amplitudes = np.concatenate(([0.0], np.atleast_1d(np.asarray(summary["harmonics"], dtype=float))))
    return np.arange(float(amplitudes.size)), amplitudes


def prolonged(summary: Summary, result: Result) -> tuple[np.ndarray, np.ndarray]:
    """The harmonics of a summary, behind them those of the samples where these give the ones that it has."""
    ratio, amplitude = harmonics_of(summary)
    _, by_samples = column_spectrum(result, "acceleration", 1)
    known = slice(1, amplitude.size)
    end = min(result.samples_per_period // RESOLVED, by_samples.size)
    if result.orbit_period != 1 or end <= amplitude.size:
        return ratio, amplitude
    if np.abs(by_samples[known] - amplitude[known]).max() > AS_GOOD * amplitude.max():
        return ratio, amplitude
    longer = np.concatenate((amplitude, by_samples[amplitude.size : end]))
    return np.arange(float(longer.size)), longer


def column_spectrum(result: Result, name: str, window: int | None) -> tuple[np.ndarray, np.ndarray]:
    """Frequency ratio f/f_exc and single-sided amplitudes of the last `window` periods.

    The window holds whole periods, so a harmonic of the excitation falls on one bin exactly.
    """
    from rattle import kernels

    if result.samples_per_period < 2:
        raise ResultError(f"{result.path} holds too few samples a period for a spectrum.")
    samples = result.samples(name, result.window(window))
    amplitudes = np.asarray(kernels.amplitude_spectrum(samples))
    periods = samples.size // result.samples_per_period
    return np.arange(amplitudes.size) / periods, amplitudes
