"""One period of a motion: films of the flanks on a logarithmic axis, and its impacts flank by flank."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rattle.figures import style
from rattle.figures.campaign_look import plain_log_ticks
from rattle.figures.histories import FLANK_FILMS, coarse_words, last_periods
from rattle.result import TIME, Result
from rattle.summary import Summary

NOT_REPEATING = 4
# Name, place of the marks on the curve of the acceleration, and how the flank looks.
FLANKS = (
    ("drive", "v", style.RUN_COLOURS[0], style.RUN_DASHES[0]),
    ("coast", "^", style.RUN_COLOURS[1], style.RUN_DASHES[1]),
)


def draw(result: Result, summary: Summary, label: str) -> Figure:
    """Films over the acceleration, with a mark at each impact that the summary lists."""
    periods = periods_of(result)
    figure = Figure(figsize=(style.WIDTH, 5.2))
    above, below = figure.subplots(2, 1, sharex=True)
    for (flank, _, colour, dashes), name in zip(FLANKS, FLANK_FILMS, strict=True):
        if name in result:
            line = {"color": colour, "linestyle": dashes}
            above.plot(*last_periods(result, name, periods, 1e6), label=f"film, {flank} flank", **line)
    above.set_yscale("log")
    plain_log_ticks(above.yaxis, *above.get_ylim())
    above.set_ylabel(style.FILM_LABEL)
    below.axhline(0.0, color=style.PERIOD_COLOUR, linewidth=0.7, zorder=0)
    below.plot(*last_periods(result, "acceleration", periods), color=style.FORCE_COLOUR)
    below.margins(y=0.16)
    _mark_impacts(below, result, summary, periods)
    below.set_xlim(0.0, 1e3 * periods / result.frequency)
    below.set_ylabel(style.of_acceleration(style.ACCELERATION_LABEL, [result]))
    below.set_xlabel(f"Time within {words_of(result)} [ms]")
    style.note(below, coarse_words(result, "acceleration", periods, "m/s$^2$"))
    above.set_title(style.title("One period", result, label))
    figure.align_ylabels()
    handles = dict(zip(*reversed(above.get_legend_handles_labels()), strict=True))
    handles |= dict(zip(*reversed(below.get_legend_handles_labels()), strict=True))
    style.legend_below(figure, above, columns=2, labels=handles)
    return figure


def periods_of(result: Result) -> int:
    """How many periods of the force are drawn: until the motion repeats; some where it does not."""
    return min(result.orbit_period or NOT_REPEATING, result.whole_periods)


def words_of(result: Result) -> str:
    """What is drawn, in words."""
    periods = periods_of(result)
    if periods == result.orbit_period:
        return "one period" if periods == 1 else f"{periods} periods, after which it repeats"
    return words_of_last(periods)


def words_of_last(periods: int) -> str:
    """Periods at the end, in words."""
    return "the last period of the force" if periods == 1 else f"the last {periods} periods of the force"


def _mark_impacts(axes: Axes, result: Result, summary: Summary, periods: int) -> None:
    """Marks at the peaks of the curve, outside of it; a motion that repeats has them in every period."""
    time, values = last_periods(result, "acceleration", periods)
    start = float(result.samples(TIME, result.window(periods, with_start=True))[0])
    length = periods / result.frequency
    for flank, mark, colour, _ in FLANKS:
        since = np.atleast_1d(np.asarray(summary.get(f"impact_times_{flank}", []), dtype=float)) - start
        if result.orbit_period:
            since %= length
        since = 1e3 * np.unique(since[(since >= 0.0) & (since <= length)])
        if since.size:
            place = {"marker": mark, "linestyle": "", "color": colour, "markersize": 6, "clip_on": False}
            away = (1.0 if flank == "drive" else -1.0) * 0.06 * np.ptp(values)
            words = f"impact on the {flank} flank ({since.size})"
            axes.plot(since, np.interp(since, time, values) + away, label=words, **place)
