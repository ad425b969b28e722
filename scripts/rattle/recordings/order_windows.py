"""Windows of the shaft angle: the mean angle of a run-up, and the orders of a signal about some angles.

In each window sines of all orders, their amplitudes quadratic in the angle, are fitted to the samples as they
were recorded: nothing is resampled, orders closer than a window resolves are separated, each amplitude has a
standard error. A Vold-Kalman filter, the best of four bandwidths, is off by more. Of the four orders of
tests/user/run_up_truth.py, one in a resonance, the largest error is 0.2 % (filter 0.4 %), with a noise of
0.3 1/min 7 % (8 %); with 0.05 1/min 1.7 % (2.0 %) beside an order 0.2 away, 1.3 % (2.0 %) crossed by a tone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import optimize

from rattle.counts import counted
from rattle.recordings.faults import RecordingError

GRID = 32  # points a revolution of the mean angle
LEAST_CYCLES = 5
REVERSAL = 0.1  # share of the range of speeds by which it may fall back within a run-up
ERROR_SOUGHT = 5e-3  # of an amplitude; windows widen until it is reached, or until they reach the next rows
WATERFALL_ROWS = 80
DEGREE = 2  # of the amplitudes in a window; of the slow rest of the signal one more
STANDING_OUT = 5.0  # standard errors by which an order exceeds the noise


@dataclass(frozen=True)
class Course:
    """Mean angle [rad] of a shaft over time [s], without its oscillation in a cycle; its speed [rad/s]."""

    time: np.ndarray
    angle: np.ndarray
    speed: np.ndarray

    def phase(self, time: np.ndarray) -> np.ndarray:
        """The mean angle [rad] at other times [s]."""
        return np.interp(time, self.time, self.angle)

    def at_speed(self, speeds: np.ndarray) -> np.ndarray:
        """The mean angles [rad] at which the shaft passes speeds [rad/s]."""
        rises = self.speed[-1] > self.speed[0]
        speed, angle = (self.speed, self.angle) if rises else (self.speed[::-1], self.angle[::-1])
        return np.interp(speeds, optimize.isotonic_regression(speed).x, angle)


def mean_course(time: np.ndarray, angle: np.ndarray, cycle_revolutions: int) -> Course:
    """The mean angle: a mean over whole cycles that leaves cubic courses as they are and drops every order.

    An angle that swings with the orders would bend them: of a shaft with 600 rad/s2 at order 2 and 800 1/min
    a quarter of a fourth order of 100 rad/s2 would be an image of the second.
    """
    count, step = GRID * cycle_revolutions, 2.0 * math.pi / GRID
    grid = np.arange(math.ceil(angle[0] / step), math.floor(angle[-1] / step) + 1) * step
    if len(grid) < LEAST_CYCLES * count:
        raise RecordingError(
            f"the shaft turns {len(grid) / GRID:.1f} times; a mean takes "
            f"{LEAST_CYCLES * cycle_revolutions} turns at least."
        )
    mean = np.convolve(np.ones(count), np.ones(count)) / count**2
    kernel = -np.convolve(mean, mean)
    middle = len(kernel) // 2
    kernel[middle - count + 1 : middle + count] += 2.0 * mean
    # One point more at both ends, so that samples beyond the last whole step have their angle.
    grid = np.concatenate([[grid[0] - step], grid, [grid[-1] + step]])
    before, after = grid[0] - step * np.arange(middle, 0, -1), grid[-1] + step * np.arange(1, middle + 1)
    times = np.interp(grid, angle, time)
    ends = [
        np.polynomial.Polynomial.fit(grid[part], times[part], 3)
        for part in (slice(1, 4 * count), slice(-4 * count, -1))
    ]
    times[0], times[-1] = ends[0](grid[0]), ends[1](grid[-1])
    smooth = np.convolve(np.concatenate([ends[0](before), times, ends[1](after)]), kernel, "valid")
    return Course(smooth, grid, step / np.gradient(smooth))


def longest_run(course: Course, cycle_revolutions: int, notes: list[str]) -> Course:
    """The part in which the speed rises, or falls, the most without turning back."""
    every = GRID * cycle_revolutions
    speed = course.speed[::every]
    limit = REVERSAL * float(np.ptp(speed))
    extreme = int(np.argmax(np.abs(speed - speed[0]) > limit))
    sign = float(np.sign(speed[extreme] - speed[0]))
    turns = [int(np.argmin(sign * speed[:extreme]))]
    for place in range(extreme, len(speed)):
        if sign * (speed[place] - speed[extreme]) >= 0.0:
            extreme = place
        elif sign * (speed[extreme] - speed[place]) > limit:
            turns.append(extreme)
            extreme, sign = place, -sign
    turns.append(extreme)
    first, last = max(
        zip(turns, turns[1:], strict=False), key=lambda ends: abs(speed[ends[1]] - speed[ends[0]])
    )
    part = slice(first * every, last * every + every)
    if len(turns) > 2:
        notes.append(
            f"The speed turns {counted(len(turns) - 2, 'time')}; the largest run is taken, "
            f"{course.time[part][0]:.4g} to {course.time[part][-1]:.4g} s."
        )
    return Course(course.time[part], course.angle[part], course.speed[part])


def fit_window(
    phase: np.ndarray,
    values: np.ndarray,
    orders: Sequence[float],
    centre: float,
    half: float,
    tones: Sequence[np.ndarray] = (),
    degree: int = DEGREE,
) -> tuple[np.ndarray, np.ndarray] | None:
    """Complex amplitudes of orders at an angle [rad] and their standard errors, from samples near it.

    Samples up to `half` [rad] from it count, whose mean angle is `phase` [rad]; `tones` are phases [rad] of
    what else oscillates, `degree` is that of the amplitudes. None: too few samples for a fit.
    """
    part = slice(*np.searchsorted(phase, [centre - half, centre + half]))
    place = (phase[part] - centre) / half
    powers = np.vander(place, degree + 1, increasing=True)
    columns = [np.vander(place, DEGREE + 2, increasing=True)]
    for angle, shapes in (
        *((order * phase[part], powers) for order in orders),
        *((tone[part], powers[:, : max(1, degree)]) for tone in tones),
    ):
        columns += [shapes * np.cos(angle)[:, None], -shapes * np.sin(angle)[:, None]]
    matrix = np.concatenate(columns, axis=1)
    if len(place) < 2 * matrix.shape[1]:
        return None
    weight = np.cos(0.5 * math.pi * place)  # whose square is a Hann window
    weighted = matrix * weight[:, None]
    normal = weighted.T @ weighted
    try:
        inverse = np.linalg.inv(normal)
    except np.linalg.LinAlgError:
        return None
    found = inverse @ (weighted.T @ (values[part] * weight))
    rest = (values[part] - matrix @ found) * weight
    freedom = float(np.sum(weight**2)) * (1.0 - matrix.shape[1] / len(place))
    heavier = weighted * weight[:, None]
    variance = np.sum(rest**2) / freedom * np.sum(inverse @ (heavier.T @ heavier) * inverse, axis=1)
    first = DEGREE + 2 + 2 * (degree + 1) * np.arange(len(orders))
    second = first + degree + 1
    return found[first] + 1j * found[second], np.sqrt(np.maximum(variance[first], variance[second]))


def track(
    phase: np.ndarray,
    values: np.ndarray,
    orders: Sequence[float],
    centres: np.ndarray,
    least: float,
    tones: Sequence[np.ndarray] = (),
) -> tuple[np.ndarray, np.ndarray]:
    """Complex amplitudes at angles (rows) of orders (columns), and standard errors; not a number: no fit.

    Windows reach `least` [rad] either way, and further to the next centre where noise asks for it.
    """
    found = np.full((len(centres), len(orders)), np.nan + 0j)
    errors = np.full(found.shape, np.inf)
    apart = np.abs(np.gradient(centres))
    for row, centre in enumerate(centres):
        half = least
        while True:
            fitted = fit_window(phase, values, orders, centre, half, tones)
            if fitted is not None:
                wanting = ~(errors[row] <= ERROR_SOUGHT * np.abs(found[row]))
                wanting &= fitted[1] < errors[row]
                found[row, wanting], errors[row, wanting] = (part[wanting] for part in fitted)
            if half >= apart[row] or np.all(errors[row] <= ERROR_SOUGHT * np.abs(found[row])):
                break
            half = min(2.0 * half, max(apart[row], least))
    return found, errors


def stand_out(
    phase: np.ndarray,
    values: np.ndarray,
    orders: Sequence[float],
    centres: np.ndarray,
    least: float,
    tones: Sequence[np.ndarray] = (),
) -> np.ndarray:
    """Of each order whether it exceeds the noise at two neighbouring centres, constant within a window."""
    is_clear = np.zeros((len(centres), len(orders)), dtype=bool)
    apart = np.maximum(least, np.abs(np.gradient(centres)))
    for row, (centre, half) in enumerate(zip(centres, apart, strict=True)):
        fitted = fit_window(phase, values, orders, centre, half, tones, degree=0)
        if fitted is not None:
            is_clear[row] = np.abs(fitted[0]) > STANDING_OUT * fitted[1]
    return np.any(is_clear[1:] & is_clear[:-1], axis=0)


def waterfall(
    phase: np.ndarray, values: np.ndarray, course: Course, highest: float, reach: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Speeds [rad/s], orders and amplitudes: a Hann window of the angle about each of some speeds."""
    first, last = np.sort([course.speed[0], course.speed[-1]])
    speeds = np.linspace(first, last, WATERFALL_ROWS)
    centres = course.at_speed(speeds)
    inside = (centres > phase[0] + reach) & (centres < phase[-1] - reach)
    speeds, centres = speeds[inside], centres[inside]
    lines = int(2.0 * reach / math.pi * highest) // 2
    orders = np.arange(1, lines + 1) * math.pi / reach
    between = len(phase) * 2.0 * reach / (phase[-1] - phase[0])
    samples = 2 * max(2 * lines + 4, int(between))
    amplitudes = np.empty((len(centres), lines))
    for row, centre in enumerate(centres):
        grid = centre + reach * (2.0 * np.arange(samples) / samples - 1.0)
        window = 0.5 + 0.5 * np.cos(np.pi * (grid - centre) / reach)
        part = np.interp(grid, phase, values)
        part = part - np.polynomial.Polynomial.fit(grid, part, 2)(grid)
        amplitudes[row] = 2.0 * np.abs(np.fft.rfft(part * window)[1 : lines + 1]) / np.sum(window)
    return speeds, orders, amplitudes
