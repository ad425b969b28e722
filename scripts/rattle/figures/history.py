"""Time histories of the last periods of a run."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from rattle.figures.style import PERIOD_COLOUR
from rattle.result import Result


def last_periods(
    result: Result, name: str, periods: int, scale: float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Time since the start of the last `periods` [ms] and the scaled column `name`, with the extreme rows."""
    rows = result.window(periods, with_start=True)
    time, values = result.merged(("time", name), rows)
    return 1e3 * (time - time[0]), scale * values


def period_rules(axes: Axes, results: Sequence[Result], periods: int) -> None:
    """Vertical rules one excitation period apart, where all runs have the same period."""
    lengths = {1e3 / result.frequency for result in results}
    if len(lengths) == 1:
        for count in range(periods + 1):
            axes.axvline(count * max(lengths), color=PERIOD_COLOUR, linewidth=0.7, zorder=0)
    axes.set_xlim(0.0, periods * max(lengths))


def time_label(results: Sequence[Result], periods: int) -> str:
    """The label of the time axis; for a single run it also says where the axis starts."""
    label = f"Time within the last {periods} excitation periods [ms]"
    if len(results) > 1:
        return label
    start = 1e3 * float(results[0].samples("time", results[0].window(periods, with_start=True))[0])
    return f"{label}, from $t$ = {start:.2f} ms"
