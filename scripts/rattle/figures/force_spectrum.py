"""Figure 7: the spectrum of the applied force."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rattle.figures import style
from rattle.figures.labels import name_runs
from rattle.figures.spectra import column_spectrum
from rattle.result import Result

SUBJECT = "Spectrum of the applied force"
LARGEST_RATIO = 5.0


def draw(results: Sequence[Result], labels: Sequence[str], window: int | None) -> Figure:
    """Lines of the force of one run, or of several side by side."""
    figure = Figure(figsize=(style.WIDTH, 2.6))
    axes = figure.subplots()
    single = len(results) == 1
    largest = 0.0
    lines = style.run_lines([result.law for result in results])
    for position, (result, label, line) in enumerate(zip(results, labels, lines, strict=True)):
        ratio, amplitude = column_spectrum(result, "applied_force", window)
        shown = ratio <= LARGEST_RATIO
        shift = 0.06 * (position - 0.5 * (len(results) - 1))
        axes.vlines(
            ratio[shown] + shift, 0.0, amplitude[shown], label=label, linewidth=2.0, color=line["color"]
        )
        largest = max(largest, float(amplitude[shown].max()))
        if single:
            _name_lines(axes, result, ratio[shown], amplitude[shown])
    axes.set_xlim(-0.25, LARGEST_RATIO)
    axes.set_ylim(0.0, 1.12 * largest if largest > 0.0 else 1.0)
    axes.set_ylabel("Amplitude of $F$ [N]")
    axes.set_xlabel(style.RATIO_LABEL if single else f"{style.RATIO_LABEL}; runs side by side")
    name_runs(figure, axes, SUBJECT, results, labels)
    return figure


def _name_lines(axes: Axes, result: Result, ratio: np.ndarray, amplitude: np.ndarray) -> None:
    """Say what the mean and the line of the excitation are."""
    at_excitation = int(np.argmin(np.abs(ratio - 1.0)))
    names = (
        (0, f"mean\n{amplitude[0]:.4g} N"),
        (at_excitation, f"{amplitude[at_excitation]:.4g} N\nat {result.frequency:g} Hz"),
    )
    for position, name in names:
        axes.annotate(
            name,
            (ratio[position], amplitude[position]),
            xytext=(4, 0),
            textcoords="offset points",
            verticalalignment="top",
            fontsize=8,
        )
