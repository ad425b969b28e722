"""Figure 6: the film thickness under the oscillating force."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from rattle.figures import style
from rattle.figures.history import coarse_words, last_periods, period_rules, time_label
from rattle.figures.labels import curve_label, name_runs
from rattle.result import Result

SUBJECT = "Film thickness under the applied force"


def draw(results: Sequence[Result], labels: Sequence[str], periods: int) -> Figure:
    """Film thickness over applied force of one run, or of several in one picture."""
    figure = Figure(figsize=(style.WIDTH, 4.2))
    film_axes, force_axes = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    lines = style.run_lines([result.law for result in results])
    for result, label, line in zip(results, labels, lines, strict=True):
        force_line = {"color": style.FORCE_COLOUR} if len(results) == 1 else line
        film_axes.plot(
            *last_periods(result, "film_thickness", periods, 1e6), label=curve_label(result, label), **line
        )
        force_axes.plot(*last_periods(result, "applied_force", periods), **force_line)
    for axes in (film_axes, force_axes):
        period_rules(axes, results, periods)
    film_axes.set_ylim(bottom=0.0)
    film_axes.set_ylabel(style.FILM_LABEL)
    force_axes.set_ylabel(style.FORCE_LABEL)
    figure.align_ylabels()
    force_axes.set_xlabel(time_label(results, periods))
    note = coarse_words(results[0], "film_thickness", periods, r"$\mathrm{\mu}$m", 1e6)
    name_runs(figure, film_axes, SUBJECT, results, labels, note)
    return figure
