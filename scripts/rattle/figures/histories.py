"""Figures 6, 8 and 9 and that of both flanks: time histories of the last periods of a run."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rattle.figures import style
from rattle.figures.campaign_look import plain_log_ticks
from rattle.result import TIME, Result

FILM = "film_thickness"
SHORT_IMPACT = 0.02  # of a period, at half the height of the peak; a shorter one has a panel of its own
AROUND = 4.0  # widths before and behind the peak that this panel shows
FEWEST_POINTS = 4  # of the impact in the series; fewer would not show it
FLANK_FILMS = (FILM, "coast_film")
FLANK_LOADS = ("film_load", "coast_load")
FLANK_LINES = (style.run_line(0), style.run_line(1))
LOAD_LABEL = "Film load $W$ [N]"
HARDLY = 0.01  # of the range of a curve
SAME_FILMS = 1e-4  # of their range; a smaller difference is thinner than the line that shows it


def draw_film_and_force(results: Sequence[Result], labels: Sequence[str], periods: int) -> Figure:
    """Figure 6: film thickness over applied force of one run, or of several in one picture."""
    figure = Figure(figsize=(style.WIDTH, 4.2))
    film_axes, force_axes = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    lines = style.run_lines([result.law for result in results])
    for result, label, line in zip(results, labels, lines, strict=True):
        force_line = {"color": style.FORCE_COLOUR} if len(results) == 1 else line
        few = bool(coarse_words(result, FILM, periods, r"$\mathrm{\mu}$m", 1e6))
        film_axes.plot(*last_periods(result, FILM, periods, 1e6), label=style.curve_label(label, few), **line)
        force_axes.plot(*last_periods(result, "applied_force", periods), **force_line)
    for axes in (film_axes, force_axes):
        period_rules(axes, results, periods)
    film_axes.set_yscale("log")
    plain_log_ticks(film_axes.yaxis, *film_axes.get_ylim())
    film_axes.set_ylabel(style.FILM_LABEL)
    force_axes.set_ylabel(style.FORCE_LABEL)
    figure.align_ylabels()
    force_axes.set_xlabel(time_label(results, periods))
    if len(results) == 1:
        style.note(film_axes, coarse_words(results[0], FILM, periods, r"$\mathrm{\mu}$m", 1e6))
    style.name_runs(figure, film_axes, "Film and applied force", results, labels)
    return figure


def draw_acceleration(results: Sequence[Result], labels: Sequence[str], periods: int) -> Figure:
    """Figures 8 and 9: acceleration of the film surface of one run, or of several in one picture."""
    near = impact(results[0], periods) if len(results) == 1 else None
    figure = Figure(figsize=(style.WIDTH, 5.2 if near else 3.0))
    axes, *below = figure.subplots(2 if near else 1, 1, squeeze=False)[:, 0]
    axes.axhline(0.0, color=style.PERIOD_COLOUR, linewidth=0.7, zorder=0)
    lines = style.run_lines([result.law for result in results])
    for result, label, line in zip(results, labels, lines, strict=True):
        few = bool(coarse_words(result, "acceleration", periods, "m/s$^2$"))
        axes.plot(*last_periods(result, "acceleration", periods), label=style.curve_label(label, few), **line)
    period_rules(axes, results, periods)
    axes.set_ylabel(style.of_acceleration(style.ACCELERATION_LABEL, results))
    axes.set_xlabel(time_label(results, periods))
    if len(results) == 1:
        style.note(axes, coarse_words(results[0], "acceleration", periods, "m/s$^2$"))
    style.name_runs(figure, axes, "Acceleration", results, labels)
    if near:
        _draw_impact(axes, below[0], near)
    return figure


def draw_flanks(result: Result, label: str) -> Figure:
    """Films and loads of both flanks, as far as columns show them, and the acceleration over a cycle."""
    periods = result.orbit_period or 1
    figure = Figure(figsize=(style.WIDTH, 5.6 if FLANK_LOADS[0] in result else 4.2))
    pairs = [names for names in (FLANK_FILMS, FLANK_LOADS) if all(name in result for name in names)]
    *both, last = figure.subplots(len(pairs) + 1, 1, sharex=True)
    for axes, names in zip(both, pairs, strict=True):
        is_film = names == FLANK_FILMS
        for name, words, line in zip(names, ("drive flank", "coast flank"), FLANK_LINES, strict=True):
            axes.plot(*last_periods(result, name, periods, 1e6 if is_film else 1.0), label=words, **line)
        axes.set_ylabel(style.FILM_LABEL if is_film else LOAD_LABEL)
    both[0].set_yscale("log")
    plain_log_ticks(both[0].yaxis, *both[0].get_ylim())
    last.axhline(0.0, color=style.PERIOD_COLOUR, linewidth=0.7, zorder=0)
    last.plot(*last_periods(result, "acceleration", periods), color=style.FORCE_COLOUR)
    last.set_ylabel(style.of_acceleration(style.ACCELERATION_LABEL, [result]))
    last.set_xlabel(time_label([result], periods))
    for axes in (*both, last):
        period_rules(axes, [result], periods)
    figure.align_ylabels()
    style.note(both[0], coarse_words(result, FILM, periods, r"$\mathrm{\mu}$m", 1e6))
    both[0].set_title(style.title("Both flanks", result, label))
    style.legend_below(figure, both[0])
    return figure


def impact(result: Result, periods: int) -> tuple[float, float] | None:
    """Start and end [ms] of the largest impact with its surroundings, where it is too short to be seen."""
    time, values = last_periods(result, "acceleration", periods)
    sizes = np.abs(values)
    low = np.flatnonzero(sizes < 0.5 * sizes.max())
    if low.size < 2:
        return None
    whole = slice(low[0], low[-1] + 1)  # an impact at either end is cut
    peak = low[0] + int(np.argmax(sizes[whole]))
    before, after = low[low < peak], low[low > peak]
    if not before.size or not after.size:
        return None
    width = time[after[0]] - time[before[-1]]
    near = time[peak] - AROUND * width, time[peak] + AROUND * width
    short = 1e-3 * width * result.frequency < SHORT_IMPACT
    return near if short and after[0] - before[-1] > FEWEST_POINTS else None


def _draw_impact(axes: Axes, below: Axes, near: tuple[float, float]) -> None:
    """The curve of the upper panel around its largest impact, as wide as the panel."""
    curve = axes.lines[1]  # the first is the rule at zero
    below.axhline(0.0, color=style.PERIOD_COLOUR, linewidth=0.7, zorder=0)
    below.plot(*curve.get_data(), color=curve.get_color(), marker=".", markersize=2.0)
    below.set_xlim(near)
    below.set_ylabel(axes.get_ylabel())
    below.set_xlabel("The largest impact, on the same axis of time [ms]")
    axes.axvspan(*near, color=style.PERIOD_COLOUR, alpha=0.6, linewidth=0, zorder=0)


def last_periods(
    result: Result, name: str, periods: int, scale: float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Time since the start of the last `periods` [ms] and the scaled column `name`, with the extreme rows.

    Where the series is coarser than its motion, each period that repeats one with extreme rows has them too.
    """
    rows = result.window(periods, with_start=True)
    time, values = result.merged((TIME, name), rows)
    if result.coarse and TIME in result:
        extreme, others = np.nonzero(_repetitions(result, periods))
        drawn = result.whole_periods - periods + others
        shifted = result.extremes[TIME][extreme] + (drawn - _own_periods(result)[extreme]) / result.frequency
        order = np.argsort(shifted)
        places = np.searchsorted(time, shifted[order], side="right")
        time = np.insert(time, places, shifted[order])
        values = np.insert(values, places, result.extremes[name][extreme[order]])
    return 1e3 * (time - time[0]), scale * values


def coarse_words(result: Result, name: str, periods: int, unit: str, scale: float = 1.0) -> str:
    """What histories do not show of a series that is coarser than its motion.

    Nothing where the series is fine, or every period drawn has its extremes, or hardly misses them.
    """
    if not result.coarse:
        return ""
    if TIME not in result or not result.extremes[TIME].size:
        return f"Series of {style.FEW_SAMPLES}; what lies between them is not known"
    drawn = np.arange(result.whole_periods - periods, result.whole_periods)
    if (_repetitions(result, periods) | (_own_periods(result)[:, None] == drawn)).all():
        return ""
    ends = np.array([function(result.extremes[name]) for function in (np.min, np.max)])
    samples = result.samples(name, result.window(periods)).reshape(periods, -1)
    found = np.array([samples.min(axis=1), samples.max(axis=1)]).T
    seen = np.log if name == FILM and ends[0] > 0.0 else np.asarray
    if np.abs(seen(found) - seen(ends)).max() <= HARDLY * np.ptp(seen(ends)):
        return ""
    least, largest = scale * ends
    return f"Series of {style.FEW_SAMPLES}; between them {least:.4g} to {largest:.4g} {unit}, not all drawn"


def period_rules(axes: Axes, results: Sequence[Result], periods: int) -> None:
    """Vertical rules one excitation period apart, where all runs have the same period."""
    lengths = {1e3 / result.frequency for result in results}
    if len(lengths) == 1:
        for count in range(periods + 1):
            axes.axvline(count * max(lengths), color=style.PERIOD_COLOUR, linewidth=0.7, zorder=0)
    axes.set_xlim(0.0, periods * max(lengths))


def time_label(results: Sequence[Result], periods: int) -> str:
    """The label of the time axis; for a single run it also says where the axis starts."""
    last = "the last excitation period" if periods == 1 else f"the last {periods} excitation periods"
    label = f"Time within {last} [ms]"
    if len(results) > 1:
        return label
    start = 1e3 * float(results[0].samples("time", results[0].window(periods, with_start=True))[0])
    return f"{label}, from $t = {start:.2f}$ ms"


def _own_periods(result: Result) -> np.ndarray:
    """The period in which each extreme row stands, counted from the start of the run."""
    count = np.floor(result.extremes[TIME] * result.frequency).astype(int)
    return np.minimum(count, result.whole_periods - 1)


def _repetitions(result: Result, periods: int) -> np.ndarray:
    """For each extreme row, which of the last `periods` repeat the period that it stands in, itself left out.

    Films must be the same: the accelerations of two flights are alike even where their impacts are not.
    """
    own = _own_periods(result)
    last, count = result.whole_periods, result.samples_per_period
    repeated = np.zeros((own.size, periods), dtype=bool)
    if FILM not in result or not own.size:
        return repeated
    first = min(int(own.min()), last - periods)
    films = result.samples(FILM, slice(1 + first * count, 1 + last * count)).reshape(-1, count)
    shown = films[last - periods - first :]
    for row, theirs in zip(repeated, films[own - first], strict=True):
        row[:] = np.abs(shown - theirs).max(axis=1) <= SAME_FILMS * np.ptp(theirs)
    return repeated & (own[:, None] != np.arange(last - periods, last))
