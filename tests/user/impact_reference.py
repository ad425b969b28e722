"""Impacts of a tooth by other means than the program's.

A period of the motion by Dormand and Prince's method, with films written down anew, and impacts counted on
thousands of points of it by the words of their definition.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

# --- films: load at film and velocity, and velocity at film and load --------------------------------------


@dataclass
class PublishedIsoViscous:
    """(35)."""

    speed: float
    radius: float
    length: float
    viscosity: float

    def load(self, film: float, velocity: float) -> float:
        squeeze = 3.0 * math.pi / math.sqrt(2.0) * math.sqrt(self.radius / film) * velocity / self.speed
        return self.length * self.viscosity * self.speed * self.radius / film * (2.8 - squeeze)

    def velocity(self, film: float, load: float) -> float:
        rolling = 2.8 - load * film / (self.length * self.viscosity * self.speed * self.radius)
        return rolling * self.speed / (3.0 * math.pi / math.sqrt(2.0) * math.sqrt(self.radius / film))


@dataclass
class PublishedPiezoViscous:
    """(37), by the steady film of a load."""

    speed: float
    steady_film: float
    steady_load: float

    def load(self, film: float, velocity: float) -> float:
        return self.steady_load * (self.steady_film / film) ** 3.5 * math.exp(-703.0 * velocity / self.speed)

    def velocity(self, film: float, load: float) -> float:
        return -self.speed / 703.0 * math.log(load / self.steady_load * (film / self.steady_film) ** 3.5)


def _rupture_table(points: int = 400_000) -> tuple[list[float], list[float]]:
    """A and Phi of the Reynolds film, from its rupture angle, in the order of A, for |A| below 60."""
    x = np.linspace(1.5605, -1.53, points)
    c, t = np.cos(x), np.tan(x)
    j = x / 8 - np.sin(4 * x) / 32 + math.pi / 16
    k = 3 * x / 8 + np.sin(2 * x) / 4 + np.sin(4 * x) / 32 + 3 * math.pi / 16
    a = (j - t * t * k) / (c**4 / 4 + t * k)
    phi = c * c / 4 - a / 8 * (x + math.pi / 2 + np.sin(x) * c)
    return a.tolist(), phi.tolist()


_TABLE: list[tuple[list[float], list[float]]] = []


@dataclass
class ExactIsoViscous:
    """The film of Swift and Stieber."""

    speed: float
    radius: float
    length: float
    viscosity: float

    def __post_init__(self) -> None:
        if not _TABLE:
            _TABLE.append(_rupture_table())
        self.a, self.phi = _TABLE[0]

    def load(self, film: float, velocity: float) -> float:
        a = 4.0 * velocity / self.speed / math.sqrt(2.0 * film / self.radius)
        if a <= self.a[0]:
            phi = -math.pi * a / 8 + 1 / (6 * a * a)
        elif a >= self.a[-1]:
            phi = 16 / (81 * a * a)
        else:
            i = bisect.bisect(self.a, a)
            share = (a - self.a[i - 1]) / (self.a[i] - self.a[i - 1])
            phi = self.phi[i - 1] + share * (self.phi[i] - self.phi[i - 1])
        return 12.0 * self.length * self.speed * self.viscosity * self.radius / film * phi

    def velocity(self, film: float, load: float) -> float:
        phi = load * film / (12.0 * self.length * self.speed * self.viscosity * self.radius)
        if phi >= self.phi[0]:
            a = -8 / math.pi * phi
        elif phi <= self.phi[-1]:
            a = math.sqrt(16 / (81 * phi))
        else:
            i = bisect.bisect(self.phi, -phi, key=float.__neg__)
            share = (phi - self.phi[i - 1]) / (self.phi[i] - self.phi[i - 1])
            a = self.a[i - 1] + share * (self.a[i] - self.a[i - 1])
        return a * self.speed * math.sqrt(2.0 * film / self.radius) / 4.0


Film = PublishedIsoViscous | PublishedPiezoViscous | ExactIsoViscous

# --- the tooth -------------------------------------------------------------------------------------------


@dataclass
class Tooth:
    """A mass between one flank or two, its teeth rigid or not.

    The state is the gear's place and velocity, then the films of elastic teeth.
    """

    film: Film
    mass: float
    frequency: float
    steady_force: float
    orders: tuple[tuple[int, float, float], ...]
    gravity: float = 9.80665
    backlash: float | None = None
    stiffness: float | None = None

    def force(self, time: float) -> float:
        """F + m g."""
        turn = 2.0 * math.pi * self.frequency * time
        return (
            self.steady_force
            + self.mass * self.gravity
            + sum(amplitude * math.cos(order * turn + phase) for order, amplitude, phase in self.orders)
        )

    def loads(self, state: tuple[float, ...]) -> tuple[float, float]:
        """Of the drive film and of the coast film."""
        place, velocity = state[:2]
        if self.stiffness is not None:
            drive = self.stiffness * (state[2] - place)
            coast = 0.0 if self.backlash is None else self.stiffness * (state[3] - (self.backlash - place))
            return drive, coast
        coast = 0.0 if self.backlash is None else self.film.load(self.backlash - place, -velocity)
        return self.film.load(place, velocity), coast

    def rates(self, time: float, state: tuple[float, ...]) -> tuple[float, ...]:
        drive, coast = self.loads(state)
        rates = (state[1], (drive - coast - self.force(time)) / self.mass)
        if self.stiffness is None:
            return rates
        films = (drive, coast)[: len(state) - 2]
        return (*rates, *(self.film.velocity(h, load) for h, load in zip(state[2:], films, strict=True)))


_NODES = (0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0)
_STAGES = (
    (),
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
    (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
)
_ERRORS = (71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40)


def solve(
    rates: Callable[[float, tuple[float, ...]], tuple[float, ...]],
    start: tuple[float, ...],
    scales: tuple[float, ...],
    span: float,
    accuracy: float = 1e-11,
    fewest: int = 4000,
) -> tuple[np.ndarray, np.ndarray]:
    """Times and states of all steps over a span; films are held to their own size, velocities to a scale."""
    time, state, step = 0.0, start, span / fewest
    times, states = [time], [state]
    first = rates(time, state)
    while time < span:
        step = min(step, span / fewest, span - time)
        stages = [first]
        for node, weights in zip(_NODES[1:], _STAGES[1:], strict=True):
            here = tuple(
                y + step * sum(w * k[i] for w, k in zip(weights, stages, strict=True))
                for i, y in enumerate(state)
            )
            stages.append(rates(time + node * step, here))
        error = max(
            abs(step * sum(w * k[i] for w, k in zip(_ERRORS, stages, strict=True))) / scales[i]
            for i in range(len(state))
        )
        if error <= accuracy:
            time, state, first = time + step, here, stages[-1]
            if span - time < 1e-14 * span:
                time = span
            times.append(time)
            states.append(state)
        step *= min(4.0, max(0.2, 0.9 * (accuracy / max(error, 1e-30)) ** 0.2))
    return np.array(times), np.array(states)


# --- impacts ---------------------------------------------------------------------------------------------


class Impact(NamedTuple):
    time: float
    load: float
    velocity: float
    impulse: float


def find_impacts(
    times: np.ndarray, loads: np.ndarray, velocities: np.ndarray, largest_force: float, limit: float
) -> list[Impact]:
    """The impacts of one cycle of W(t), whose ends are the same; velocities are those towards the flank."""
    # The cycle begins where W is lowest; its last point is its first one.
    low = int(np.argmin(loads[:-1]))
    span = times[-1] - times[0]
    times = np.concatenate([times[low:-1], times[: low + 1] + span])
    loads = np.concatenate([loads[low:-1], loads[: low + 1]])
    velocities = np.concatenate([velocities[low:-1], velocities[: low + 1]])
    slopes = np.gradient(loads, times)
    inner = loads[1:-1]
    tops = 1 + np.flatnonzero((inner >= loads[:-2]) & (inner > loads[2:]) & (inner > limit * largest_force))
    tops = tops.tolist()
    # Two maxima are one unless W falls below half of the smaller one: the smaller of the closest pair goes.
    while True:
        pairs = [
            (a, b)
            for a, b in zip(tops, tops[1:], strict=False)
            if loads[a : b + 1].min() >= 0.5 * min(loads[a], loads[b])
        ]
        if not pairs:
            break
        a, b = pairs[0]
        tops.remove(a if loads[a] < loads[b] else b)
    impacts = []
    for number, top in enumerate(tops):
        first, last = top, top
        # Another impact in the same stretch ends at the lowest point between both.
        earliest = 0 if number == 0 else tops[number - 1] + int(np.argmin(loads[tops[number - 1] : top + 1]))
        latest = (
            len(loads) - 1
            if number + 1 == len(tops)
            else top + int(np.argmin(loads[top : tops[number + 1] + 1]))
        )
        while first > earliest and loads[first - 1] > largest_force:
            first -= 1
        while last < latest and loads[last + 1] > largest_force:
            last += 1
        t, w = times[first : last + 1], loads[first : last + 1]
        velocity = velocities[first]
        if first > earliest:
            share = (largest_force - loads[first - 1]) / (loads[first] - loads[first - 1])
            t = np.insert(t, 0, times[first - 1] + share * (times[first] - times[first - 1]))
            w = np.insert(w, 0, largest_force)
            velocity = velocities[first - 1] + share * (velocities[first] - velocities[first - 1])
        if last < latest:
            share = (loads[last] - largest_force) / (loads[last] - loads[last + 1])
            t = np.append(t, times[last] + share * (times[last + 1] - times[last]))
            w = np.append(w, largest_force)
        # The parabola through the highest point and its neighbours.
        a, b, c = np.polyfit(times[top - 1 : top + 2] - times[top], loads[top - 1 : top + 2], 2)
        # The trapezium with the correction of Euler and Maclaurin.
        slope, steps = np.interp(t, times, slopes), np.diff(t)
        impulse = float(np.sum(0.5 * steps * (w[1:] + w[:-1]) + steps**2 / 12 * (slope[:-1] - slope[1:])))
        impacts.append(Impact(times[top] - 0.5 * b / a, c - 0.25 * b * b / a, float(velocity), impulse))
    return impacts


def share_below(times: np.ndarray, loads: np.ndarray, level: float) -> float:
    """Share of a time in which straight lines between points are below a level."""
    first, second, length = loads[:-1], loads[1:], np.diff(times)
    crossing = (first < level) != (second < level)
    share = np.where((first < level) & (second < level), 1.0, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        place = (level - first) / (second - first)
    share = np.where(crossing, np.where(first < level, place, 1.0 - place), share)
    return float(np.sum(share * length) / np.sum(length))
