"""Time stamps as benches write them become times that ascend: repeated, rounded and jittering ones."""

from __future__ import annotations

import numpy as np

from rattle.counts import counted
from rattle.recordings.faults import RecordingError

# Jitter that is one of the stamps and not of the sampling, in steps; rattle itself allows the same.
MOST_JITTER = 0.1
# Where more of the stamps repeat the one before, the stamps have too few digits.
ROUNDED_SHARE = 0.2


def settle(
    time: np.ndarray, values: np.ndarray, lines: np.ndarray | None, source: str, notes: list[str]
) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] that ascend strictly, with their values; what was done is appended to `notes`, once."""
    time, values = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    if lines is None:
        lines = np.zeros(len(time), dtype=int)
    known = np.isfinite(time)
    if not known.all():
        lost = counted(np.sum(~known), "sample without a time is", "samples without a time are")
        _note(notes, f"{source}: {lost} left out.")
        time, values, lines = time[known], values[known], lines[known]
    if len(time) < 2:
        return time, values
    steps = np.diff(time)
    if np.any(steps < 0.0):
        at = int(np.argmax(steps < 0.0)) + 1
        place = f", line {lines[at]}" if lines[at] else f", sample {at + 1}"
        raise RecordingError(
            f"{source}{place}: time goes back from {time[at - 1]:.9g} to {time[at]:.9g} s; cut the file "
            "there, or choose the column of time that ascends."
        )
    if not np.any(steps > 0.0):
        raise RecordingError(f"{source}: its time stands still at {time[0]:.9g} s.")
    same = steps == 0.0
    if np.mean(same) > ROUNDED_SHARE:
        time = _spread(time, source, notes)
    elif same.any():
        time, values = _joined(time, values, source, notes)
    return _uniform(time, source, notes), values


def _note(notes: list[str], sentence: str) -> None:
    if sentence not in notes:
        notes.append(sentence)


def _spread(time: np.ndarray, source: str, notes: list[str]) -> np.ndarray:
    """Stamps with too few digits: the samples of each stamp stand evenly until the next one."""
    starts = np.flatnonzero(np.concatenate(([True], np.diff(time) > 0.0)))
    quantum = float(np.median(np.diff(time[starts])))
    counted = np.arange(len(time))
    slope, offset = np.polyfit(counted, time, 1)
    even = offset + slope * counted
    _note(
        notes,
        f"{source}: its time stamps have too few digits ({len(starts)} different ones of {len(time)}); "
        "the samples are taken as evenly spaced.",
    )
    if np.max(np.abs(even - time)) <= 1.01 * quantum:
        return even
    return np.interp(counted, np.append(starts, len(time)), np.append(time[starts], time[-1] + quantum))


def _joined(
    time: np.ndarray, values: np.ndarray, source: str, notes: list[str]
) -> tuple[np.ndarray, np.ndarray]:
    """One sample for each time: their mean where several differ."""
    times, place, counts = np.unique(time, return_inverse=True, return_counts=True)
    finite = np.isfinite(values)
    sums = np.bincount(place, np.where(finite, values, 0.0))
    numbers = np.bincount(place, finite)
    means = np.where(numbers > 0, sums / np.maximum(numbers, 1), np.nan)
    several = counted(int(np.sum(counts > 1)), "time stands", "times stand")
    _note(
        notes,
        f"{source}: {several} repeatedly, first {times[counts > 1][0]:.9g} s; "
        "the mean of their samples is taken.",
    )
    return times, means


def _uniform(time: np.ndarray, source: str, notes: list[str]) -> np.ndarray:
    """Evenly spaced times where the stamps differ from these by jitter or rounding alone; gaps remain."""
    steps = np.diff(time)
    counted = np.concatenate(([0.0], np.cumsum(np.maximum(1.0, np.round(steps / np.median(steps))))))
    slope, offset = np.polyfit(counted, time - time[0], 1)
    even = time[0] + offset + slope * counted
    off = float(np.max(np.abs(even - time)))
    missing = int(counted[-1]) + 1 - len(time)
    if missing > 0.1 * len(time) or off > max(MOST_JITTER * slope, min(_last_digit(time), 0.6 * slope)):
        if np.max(np.abs(steps - np.median(steps))) > MOST_JITTER * np.median(steps):
            _note(
                notes,
                f"{source}: its times are not uniform, {steps.min():.4g} to {steps.max():.4g} s apart; "
                "they are taken as they stand.",
            )
        return time
    if off < 1e-6 * slope:
        return time
    if off > 1e-3 * slope:
        _note(
            notes,
            f"{source}: its time stamps jitter by at most {off:.3g} s, {off / slope:.2g} of a step of "
            f"{slope:.6g} s; the clock is taken as uniform.",
        )
    return even


def _last_digit(time: np.ndarray) -> float:
    """What the last decimal of stamps that were rounded is worth [s]; 0 of times with many digits."""
    for digits in range(7):
        if np.allclose(time * 10.0**digits, np.round(time * 10.0**digits), rtol=0.0, atol=1e-6):
            return 10.0**-digits
    return 0.0


def gaps(time: np.ndarray, finite: np.ndarray) -> list[tuple[float, float]]:
    """Times [s] of the last value before and the first behind each stretch without a finite value."""
    there = time[finite]
    if len(there) < 3:
        return []
    steps, all_steps = np.diff(there), np.diff(time)
    usual = np.median(all_steps)
    regular = np.mean(np.abs(all_steps - usual) < MOST_JITTER * usual) > 0.9
    wide = np.flatnonzero(steps > (1.5 if regular else 10.0) * usual)
    return [(float(there[i]), float(there[i + 1])) for i in wide]
