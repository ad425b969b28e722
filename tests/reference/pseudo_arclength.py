"""Branches of periodic motions by pseudo-arclength continuation, through their folds, as AUTO follows them.

Nothing is shared with the program: the load of the film is (35) as printed, the motion and its slopes by
state and parameter are one system of equations that scipy's LSODA solves, and a fold is where the tangent of
the branch has no part along the parameter.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

# Image of a state under the period map, its slopes by the state, and by the parameter.
PeriodMap = Callable[[np.ndarray, float], tuple[np.ndarray, np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class LoosePair:
    """A rigid tooth between two flanks with the published film (35); the parameter is the force amplitude."""

    radius: float
    length: float
    viscosity: float
    speed: float
    backlash: float
    mass: float
    static_force: float
    frequency: float

    def acceleration(self, phase: float, film: float, velocity: float, amplitude: float):
        """z'' [m/s2], and its slopes by film, velocity and amplitude."""
        entry = 2.8 * self.length * self.speed * self.viscosity * self.radius
        squeeze = 3.0 * math.pi * self.length * self.viscosity * self.radius**1.5 / math.sqrt(2.0)
        gap = self.backlash - film
        load = entry * (1.0 / film - 1.0 / gap) - squeeze * velocity * (film**-1.5 + gap**-1.5)
        by_film = -entry * (film**-2 + gap**-2) + 1.5 * squeeze * velocity * (film**-2.5 - gap**-2.5)
        by_velocity = -squeeze * (film**-1.5 + gap**-1.5)
        wave = math.cos(2.0 * math.pi * phase)
        total = load - self.static_force - amplitude * wave
        return (number / self.mass for number in (total, by_film, by_velocity, -wave))

    def period_map(self, state: np.ndarray, amplitude: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The state a period on: film over backlash, and velocity over backlash times frequency."""

        per_velocity = 1.0 / (self.backlash * self.frequency**2)

        def change(phase: float, numbers: np.ndarray) -> list[float]:
            film, velocity, *slopes = numbers.tolist()
            z, by_film, by_velocity, by_amplitude = self.acceleration(
                phase, film * self.backlash, velocity * self.backlash * self.frequency, amplitude
            )
            by_film, by_velocity = by_film / self.frequency**2, by_velocity / self.frequency
            rates = [by_film * slopes[i] + by_velocity * slopes[3 + i] for i in range(3)]
            rates[2] += by_amplitude * per_velocity
            return [velocity, z * per_velocity, *slopes[3:], *rates]

        first = np.concatenate((state, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]))
        solved = solve_ivp(change, (0.0, 1.0), first, method="LSODA", rtol=1e-11, atol=1e-13)
        assert solved.success, solved.message
        numbers = solved.y[:, -1]
        slopes = numbers[2:].reshape(2, 3)
        return numbers[:2], slopes[:, :2], slopes[:, 2]


@dataclass(frozen=True)
class Point:
    """A periodic motion: its numbers with the parameter over its unit, tangent, Floquet multipliers."""

    numbers: np.ndarray
    tangent: np.ndarray
    multipliers: np.ndarray


def corrected(period_map: PeriodMap, unit: float, guess: np.ndarray, across: np.ndarray) -> Point:
    """The motion in the plane through a guess across a direction, by Newton's method."""
    numbers = guess.copy()
    for _ in range(12):
        image, by_state, by_parameter = period_map(numbers[:-1], numbers[-1] * unit)
        size = image.size
        matrix = np.vstack((np.column_stack((by_state - np.eye(size), by_parameter * unit)), across))
        change = np.linalg.solve(matrix, -np.append(image - numbers[:-1], across @ (numbers - guess)))
        numbers = numbers + change
        if np.abs(change).max() < 1e-9:
            break
    else:
        raise ArithmeticError("Newton's method does not converge.")
    tangent = np.linalg.solve(matrix, np.append(np.zeros(size), 1.0))
    return Point(numbers, tangent / np.linalg.norm(tangent), np.linalg.eigvals(by_state))


def folds(
    period_map: PeriodMap, unit: float, start: np.ndarray, direction: float, count: int, step: float = 1e-3
) -> list[tuple[float, Point]]:
    """The first folds of a branch from a motion at a parameter, each with the parameter where it is."""
    across = np.append(np.zeros(start.size - 1), direction)
    here = corrected(period_map, unit, start, across)
    found: list[tuple[float, Point]] = []
    for _ in range(2000):
        try:
            there = corrected(period_map, unit, here.numbers + step * here.tangent, here.tangent)
        except ArithmeticError:
            step *= 0.5
            continue
        if here.tangent @ there.tangent < 0.98:
            step *= 0.5
            continue
        if here.tangent[-1] * there.tangent[-1] < 0.0:
            way = here.tangent @ (there.numbers - here.numbers)

            def along(length: float, here: Point = here) -> float:
                return at(length, here).tangent[-1]

            def at(length: float, here: Point = here) -> Point:
                return corrected(period_map, unit, here.numbers + length * here.tangent, here.tangent)

            last = at(brentq(along, 0.0, way, xtol=1e-9), here)
            found.append((last.numbers[-1] * unit, last))
            if len(found) == count:
                return found
        here = there
        step = min(1.5 * step, 0.05)
    raise ArithmeticError(f"{len(found)} folds were found, not {count}.")
