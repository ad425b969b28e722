"""The film force of a motion as harmonics: those of straight lines between the rows of its series."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rattle.command import CommandError
from rattle.result import TIME, Result
from rattle.solve import Solved

COLUMNS = (TIME, "acceleration", "applied_force")
# Most by which the rms of a series may differ from that of its motion, which is known from the steps.
LARGEST_GAP = 0.5  # dB
BLOCK = 1 << 22  # numbers at a time
ON_GRID = 1e-6  # of the distance between samples


@dataclass(frozen=True)
class ForceHarmonics:
    """A force that repeats: F(t) - mean = sum over k of 2 Re(amplitudes[k-1] exp(2 pi i k frequency t)).

    Attributes
    ----------
    frequency : of the repetition [Hz]
    amplitudes : complex, of the harmonics k = 1, 2, ... [N]
    rms : of the force about its mean, of all harmonics, also those above the last [N]
    gap : level of that rms against that of the summary, which is from the steps of the solution [dB]
    periods : of the excitation, after which the force repeats
    repeats : False of a motion that does not repeat: its last periods are repeated instead
    motions : of this operating point; the force is that of the motion from rest
    """

    frequency: float
    amplitudes: np.ndarray
    rms: float
    gap: float
    periods: int
    repeats: bool
    motions: int = 1

    @property
    def frequencies(self) -> np.ndarray:
        """Of the harmonics [Hz]."""
        return self.frequency * np.arange(1, self.amplitudes.size + 1)


def force_harmonics(solved: Solved, highest: float) -> ForceHarmonics:
    """Harmonics up to `highest` [Hz] of the film force, that on the bearings, of one motion.

    The force is mass times acceleration plus the applied force: the loads of both films.
    Raises CommandError where the series does not hold it, or has too few samples for it.
    """
    result, summary = solved
    if not isinstance(result, Result) or result.task != "motion":
        raise CommandError("A sound needs the series of a motion.")
    result.require_rows("motion")
    for name in COLUMNS:
        if name not in result:
            raise CommandError(f"{result.path} has no column '{name}': output.columns leaves it out.")
    repeats = result.orbit_period is not None
    # Of a motion that does not repeat as much as has settled, so that its repetition is not heard as a tone.
    periods = result.orbit_period or max(result.window_periods, result.whole_periods // 2)
    rows = result.window(periods, with_start=True)
    time, acceleration, applied = result.merged(COLUMNS, rows)
    force = result.number("load", "mass") * acceleration + applied
    # The last row is the first of the next repetition.
    length = periods / result.frequency
    kept = np.concatenate([np.diff(time) > ON_GRID * length / (periods * result.samples_per_period), [False]])
    time, force = time[kept], force[kept]
    mean, rms = mean_and_rms(time, force, length)
    known, error = (float(summary.get(f"film_force_rms{end}", 0.0)) for end in ("", "_error"))
    gap = 20.0 * np.log10(rms / known) if known > 0.0 and rms > 0.0 else 0.0
    if abs(gap) > LARGEST_GAP and abs(rms - known) > error:
        raise CommandError(
            f"{result.path} has too few samples for its film force: {rms:.4g} of {known:.4g} N rms. Solve it "
            f"with solver.samples_per_period = {4 * result.samples_per_period} or more."
        )
    amplitudes = fourier_coefficients(
        time, force - mean, length, int(highest * length), periods * result.samples_per_period
    )
    motions = int(summary.get("motions", 1))
    return ForceHarmonics(1.0 / length, amplitudes, rms, float(gap), periods, repeats, motions)


def mean_and_rms(time: np.ndarray, values: np.ndarray, period: float) -> tuple[float, float]:
    """Mean, and rms about it, of straight lines through the points of one period."""
    steps = np.diff(time, append=time[0] + period)
    nexts = np.roll(values, -1)
    mean = float((steps * (values + nexts)).sum() / (2.0 * period))
    one, two = values - mean, nexts - mean
    return mean, float(np.sqrt((steps * (one**2 + one * two + two**2)).sum() / (3.0 * period)))


def fourier_coefficients(
    time: np.ndarray, values: np.ndarray, period: float, count: int, grid: int
) -> np.ndarray:
    """Coefficients c_k, k = 1 to `count`, of exp(2 pi i k t/period) in straight lines through the points.

    The second derivative of such a curve is an impulse at each point, as large as the jump of the slope; its
    coefficients are sums over these, and two integrations make them those of the curve. Nothing is sampled,
    so nothing above the last coefficient folds into those below. `grid`: equal steps of the period, at which
    most points lie; the sum over these is a fast Fourier transform.
    """
    steps = np.diff(time, append=time[0] + period)
    slopes = np.diff(values, append=values[0]) / steps
    jumps = slopes - np.roll(slopes, 1)
    place = (time - time[0]) * grid / period
    on_grid = np.abs(place - np.rint(place)) < ON_GRID
    even = np.bincount(np.rint(place[on_grid]).astype(int) % grid, jumps[on_grid], grid)
    k = np.arange(1, count + 1)
    sums = np.fft.fft(even)[k % grid]
    angle = 2.0 * np.pi / period
    others = time[~on_grid] - time[0]
    for start in range(0, count, max(1, BLOCK // max(others.size, 1))):
        some = slice(start, start + max(1, BLOCK // max(others.size, 1)))
        sums[some] += np.exp(-1j * angle * np.outer(k[some], others)) @ jumps[~on_grid]
    return -sums * np.exp(-1j * angle * k * time[0]) / (period * (angle * k) ** 2)
