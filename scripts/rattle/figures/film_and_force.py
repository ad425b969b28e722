"""Figure 6: the film thickness under the oscillating force."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from rattle.figures import style
from rattle.figures.history import last_periods, period_rules, time_label
from rattle.figures.labels import overlay_title, title
from rattle.result import Result

SUBJECT = "Film thickness under the applied force"


def draw(results: Sequence[Result], labels: Sequence[str], periods: int) -> Figure:
    """Film thickness over applied force of one run, or of several in one picture."""
    figure = Figure(figsize=(style.WIDTH, 4.2))
    film_axes, force_axes = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    single = len(results) == 1
    for position, (result, label) in enumerate(zip(results, labels, strict=True)):
        line = style.run_line(position)
        if single:
            line = {"color": style.law_colour(result.law)}
        force_line = {"color": style.FORCE_COLOUR} if single else line
        film_axes.plot(*last_periods(result, "film_thickness", periods, 1e6), label=label, **line)
        force_axes.plot(*last_periods(result, "applied_force", periods), **force_line)
    for axes in (film_axes, force_axes):
        period_rules(axes, results, periods)
    film_axes.set_ylim(bottom=0.0)
    film_axes.set_ylabel(style.FILM_LABEL)
    force_axes.set_ylabel(style.FORCE_LABEL)
    figure.align_ylabels()
    force_axes.set_xlabel(time_label(results, periods))
    if single:
        film_axes.set_title(title(SUBJECT, results[0], labels[0]))
    else:
        film_axes.set_title(overlay_title(SUBJECT, results))
        style.legend_below(figure, film_axes)
    return figure
