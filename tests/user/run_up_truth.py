"""Run-ups whose orders are known: angle and speed of a shaft, and what its table must hold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

Amplitude = Callable[[np.ndarray], np.ndarray]


def resonance(speed: np.ndarray, at: float, damping: float, size: float, rest: complex) -> np.ndarray:
    """Amplitude of an order that passes a resonance."""
    ratio = speed / at
    return size / (1.0 - ratio**2 + 2j * damping * ratio) + rest


ENGINE: dict[float, Amplitude] = {
    2.0: lambda n: resonance(n, 1400.0, 0.12, 200.0, 350.0 * np.exp(0.1j)),
    4.0: lambda n: 100.0 * n / 800.0 * np.exp(0.8j - 2e-4j * n),
    6.0: lambda n: 50.0 * (n / 800.0) ** 0.9 * np.exp(-0.5j),
    8.0: lambda n: 20.0 * n / 800.0 * np.exp(0.3j),
}


@dataclass(frozen=True)
class Truth:
    """A shaft whose angular acceleration has orders with complex amplitudes [rad/s2] over its speed [1/min].

    The speed goes evenly from `first` to `last` in `seconds`; a tone [Hz, rad/s2] is no order.
    """

    orders: dict[float, Amplitude] = field(default_factory=lambda: dict(ENGINE))
    first: float = 700.0
    last: float = 3000.0
    seconds: float = 20.0
    tone: tuple[float, float] | None = None

    def mean_speed(self, time: np.ndarray) -> np.ndarray:
        """[1/min]"""
        return self.first + (self.last - self.first) * time / self.seconds

    def mean_angle(self, time: np.ndarray) -> np.ndarray:
        """[rad]"""
        return np.pi / 30.0 * (self.first * time + (self.last - self.first) * time**2 / (2.0 * self.seconds))

    def angle(self, time: np.ndarray) -> np.ndarray:
        """The angle [rad]: that of the mean speed, and each acceleration over the square of its frequency."""
        speed, mean = self.mean_speed(time), self.mean_angle(time)
        angle = mean.copy()
        for order, amplitude in self.orders.items():
            swing = -amplitude(speed) / (order * speed * np.pi / 30.0) ** 2
            angle += (swing * np.exp(1j * order * mean)).real
        if self.tone is not None:
            pulsation = 2.0 * np.pi * self.tone[0]
            angle -= self.tone[1] / pulsation**2 * np.cos(pulsation * time + 0.4)
        return angle

    def speed(self, time: np.ndarray) -> np.ndarray:
        """The speed [1/min], by a central difference that is good to nine digits."""
        step = 1e-5
        return (self.angle(time + step) - self.angle(time - step)) / (2.0 * step) * 30.0 / np.pi

    def amplitudes(self, speeds: np.ndarray, order: float, zero: float) -> np.ndarray:
        """What a table must hold whose angle is 0 where this one is `zero` [rad]."""
        return self.orders[order](speeds) * np.exp(1j * order * zero)


def quantised(values: np.ndarray, span: float, bits: int) -> np.ndarray:
    """Values as a converter of so many bits over a span has them."""
    step = span / 2.0**bits
    return np.round(values / step) * step
