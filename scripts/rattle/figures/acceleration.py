"""Figures 8 and 9: the history of the acceleration of the film surface."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from rattle.figures import style
from rattle.figures.history import coarse_words, last_periods, period_rules, time_label
from rattle.figures.labels import curve_label, name_runs
from rattle.result import Result

SUBJECT = "Acceleration of the film surface"


def draw(results: Sequence[Result], labels: Sequence[str], periods: int) -> Figure:
    """Acceleration of one run, or of several in one picture."""
    figure = Figure(figsize=(style.WIDTH, 3.0))
    axes = figure.subplots()
    axes.axhline(0.0, color=style.PERIOD_COLOUR, linewidth=0.7, zorder=0)
    lines = style.run_lines([result.law for result in results])
    for result, label, line in zip(results, labels, lines, strict=True):
        axes.plot(*last_periods(result, "acceleration", periods), label=curve_label(result, label), **line)
    period_rules(axes, results, periods)
    axes.set_ylabel(style.ACCELERATION_LABEL)
    axes.set_xlabel(time_label(results, periods))
    note = coarse_words(results[0], "acceleration", periods, "m/s$^2$")
    name_runs(figure, axes, SUBJECT, results, labels, note)
    return figure
