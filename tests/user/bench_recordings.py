"""Recordings of a test bench with a known truth: the speed of a shaft over its angle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

TURN = 2.0 * np.pi
# Order: amplitude over the mean, and phase; as an idling engine has them.
ORDERS = {0.5: (0.002, 0.4), 1.0: (0.001, -1.0), 2.0: (0.02, 0.3), 4.0: (0.005, -2.0), 6.0: (0.001, 2.5)}
FORCE = {1.0: (40.0, 0.5), 2.0: (150.0, -0.7), 3.0: (25.0, 2.0)}


@dataclass
class Bench:
    """A shaft whose speed [1/min] is `mean` times one and its orders, drifting by a share in all."""

    mean: float = 812.7
    orders: Mapping[float, tuple[float, float]] = field(default_factory=lambda: dict(ORDERS))
    drift: float = 0.0
    span: float = 3.777

    def __post_init__(self) -> None:
        turns = self.mean / 60.0 * self.span * (1.0 + abs(self.drift)) * 1.1 + 2.0
        self._angle = np.linspace(0.0, TURN * turns, int(turns * 4000))
        slowness = 1.0 / self.speed(self._angle)
        # Simpson's rule over each step: the middle is computed, too.
        middle = 1.0 / self.speed(0.5 * (self._angle[1:] + self._angle[:-1]))
        steps = np.diff(self._angle) * (slowness[1:] + 4.0 * middle + slowness[:-1]) / 6.0
        self._time = np.concatenate(([0.0], np.cumsum(steps)))

    def speed(self, angle: np.ndarray) -> np.ndarray:
        """Speed at angles [rad/s]."""
        slow = 1.0 + self.drift * angle / (TURN * self.mean / 60.0 * self.span)
        return self.mean * TURN / 60.0 * (slow + series(self.orders, angle))

    def speed_rpm(self, time: np.ndarray) -> np.ndarray:
        return self.speed(self.angle(time)) * 60.0 / TURN

    def angle(self, time: np.ndarray) -> np.ndarray:
        """Angle at times [rad]."""
        from scipy.interpolate import CubicSpline

        return CubicSpline(self._time, self._angle)(time)

    def wheel(self, time: np.ndarray, teeth: int, missing: int = 0) -> np.ndarray:
        """Pulses of 5 V of a wheel, with edges as sloping as a sensor's: tooth n rises at n + 1/4 teeth."""
        tooth = self.angle(time) * teeth / TURN
        pulses = np.clip(2.5 - 8.0 * np.cos(TURN * tooth), 0.0, 5.0)
        return np.where(np.floor(tooth) % teeth < teeth - missing, pulses, 0.0)


def series(orders: Mapping[float, tuple[float, float]], angle: np.ndarray) -> np.ndarray:
    return sum(a * np.cos(order * angle + phase) for order, (a, phase) in orders.items())


def times(span: float, rate: float) -> np.ndarray:
    return np.arange(int(span * rate)) / rate


def quantised(values: np.ndarray, bits: int = 12) -> np.ndarray:
    """As a converter of so many bits sees them whose range is a quarter wider than the values."""
    low, high = values.min(), values.max()
    step = 1.25 * (high - low) / 2**bits
    return low + step * np.round((values - low) / step)


def csv(
    path: Path,
    heads: Sequence[str],
    columns: Sequence[np.ndarray],
    *,
    separator: str = ",",
    decimal: str = ".",
    digits: Sequence[str] = (".6f", ".6f", ".6f", ".6f"),
    encoding: str = "utf-8",
    above: str = "",
    units: Sequence[str] = (),
) -> Path:
    """A file as a bench writes it."""
    lines = [separator.join(heads)] + ([separator.join(units)] if units else [])
    for row in zip(*columns, strict=True):
        cells = [format(value, digit) for value, digit in zip(row, digits, strict=False)]
        lines.append(separator.join(cell.replace(".", decimal) for cell in cells))
    path.write_bytes((above + "\n".join(lines) + "\n").encode(encoding))
    return path
