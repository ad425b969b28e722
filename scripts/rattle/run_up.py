"""How slow a run-up has to be driven for the steady motions of a sweep over speed to be those it has.

A disturbance of a periodic motion shrinks by its largest Floquet multiplier in each of its periods. Between
two values of a sweep a run-up has the time of the step over its rate. Its motions are those of the sweep
where a disturbance shrinks to `LEFT` of itself meanwhile: it then lags by less than a quarter of a step.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rattle.codes import SUCCESSES
from rattle.result import Result
from rattle.result_file import ResultFile

SPEED = "speed_rpm"
KEY = f"shaft.{SPEED}"
LEFT = 0.01  # of a disturbance, before the next value
SAME_PEAKS = 0.01  # share by which the largest accelerations of one motion differ at most


@dataclass(frozen=True)
class Pace:
    """Largest rate [1/min/s] of a run-up, value by value of a sweep over speed.

    `rates` has a number for each row, not a number where none holds: the motion does not repeat, is not
    known, is unstable, or is the first behind a change. `changes`: last value before and first one behind
    each, and the way: the motion jumps, or its period changes. In between a multiplier reaches 1.
    """

    rates: np.ndarray
    changes: tuple[tuple[float, float, float], ...]

    @property
    def slowest(self) -> int | None:
        """The row that needs the slowest run-up."""
        return int(np.nanargmin(self.rates)) if np.isfinite(self.rates).any() else None


def first_order(result: ResultFile) -> float | None:
    """The order of the shaft that the force repeats with, the common divisor of all, at every speed.

    None where no shaft is described.
    """
    base = re.search(r"^! derived: load\.frequency = (\S+)", result.input_text, re.MULTILINE)
    speed = result.input.get("shaft", {}).get(SPEED)
    return float(base[1]) * 60.0 / float(speed) if base and speed else None


def is_run_up(result: Result) -> bool:
    """Whether a sweep is one over the speed of the shaft that has multipliers."""
    return result.names[0] == SPEED and "floquet_modulus" in result and first_order(result) is not None


def ways(result: Result) -> dict[str, float]:
    """Direction of each way that a sweep went, by its word: the key rises on the way up, first or back."""
    directions = np.asarray(result["direction"])
    outward = np.asarray(result[result.names[0]])[directions > 0.0]
    falls = outward.size > 0 and outward[-1] < outward[0]
    named = {"up": -1.0, "down": 1.0} if falls else {"up": 1.0, "down": -1.0}
    return {word: direction for word, direction in named.items() if (directions == direction).any()}


def pace(result: Result) -> Pace:
    """The pace of a sweep over speed; none of its first value, to which nothing led."""
    speed, way = (np.asarray(result[name], dtype=float) for name in (SPEED, "direction"))
    modulus, periods = (np.asarray(result[name], dtype=float) for name in ("floquet_modulus", "orbit_period"))
    known = np.isin(result["status"], SUCCESSES) & (periods > 0.0) & (modulus > 0.0) & (modulus < 1.0)
    shrinks = np.log(np.where(known, modulus, 0.5))
    # A run-up cannot be felt before a period is over.
    count = np.maximum(math.log(LEFT) / shrinks, 1.0) * np.where(known, periods, 1.0)
    steps = np.abs(np.diff(speed, prepend=np.nan))
    rates = np.where(known, steps * speed * first_order(result) / 60.0 / count, np.nan)
    changes = tuple(_changes(result, speed, way, periods))
    for _, behind, direction in changes:
        rates[(speed == behind) & (way == direction)] = np.nan
    return Pace(rates, changes)


def _changes(
    result: Result, speed: np.ndarray, way: np.ndarray, periods: np.ndarray
) -> Iterator[tuple[float, float, float]]:
    """Where a way leaves the motions that only it has, or the period of its motion changes."""
    apart = np.isin(speed, differing(result))
    for row in range(1, speed.size):
        before = row - 1
        jumps = apart[before] and not apart[row]
        doubles = periods[before] > 0.0 and periods[row] > 0.0 and periods[before] != periods[row]
        if jumps or doubles:
            yield float(speed[before]), float(speed[row]), float(way[row])


def differing(result: Result) -> np.ndarray:
    """Values of the key at which the motion on the way up is another than on the way down.

    Two that both do not repeat are not distinguished: their peaks and classes depend on how long one looks.
    """
    kept = np.isin(result["status"], SUCCESSES)
    repeats = (
        np.asarray(result["orbit_period"]) > 0.0 if "orbit_period" in result else np.ones(kept.size, bool)
    )
    classes = result["rattle_class"] if "rattle_class" in result else np.zeros(kept.size)
    rows = zip(
        result[result.names[0]],
        result["direction"],
        classes,
        peaks(result),
        kept,
        repeats,
        strict=True,
    )
    there, found = {}, []
    for value, direction, name, peak, known, own in rows:
        if not known:
            continue
        if direction > 0.0:
            there[value] = (name, peak, own)
        elif value in there:
            before = there[value]
            is_other = name != before[0] or abs(peak - before[1]) > SAME_PEAKS * peak
            if is_other and (own or before[2]):
                found.append(value)
    return np.array(found)


def peaks(result: Result) -> np.ndarray:
    """Largest size of the acceleration of each motion."""
    return np.maximum(-result["acceleration_minimum"], result["acceleration_maximum"])
