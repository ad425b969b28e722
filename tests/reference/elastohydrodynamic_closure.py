"""A loose gear between elastohydrodynamic films, by the equations of their closure alone.

Independent of the program: films in Moes' variables, the inverse of Phi from its rupture angle, loads from
gaps by Newton's method, and scipy's Radau method in time, on the films themselves as inner states:

    mu Z'' = M1 - M2 - F(T),  G1 = Z,  G2 = B - Z,  H = G + M (c - (2/pi) ln(0.516 H + 0.245 M)),
    H_T = sqrt(H/2) (g_r/g_s) PhiInverse(M H/(12 g_r)).

    python tests/reference/elastohydrodynamic_closure.py PROGRAM [SCENES [SEED]]

compares a program with it over random loose gears.
"""

from __future__ import annotations

import math
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

# --- the film ---------------------------------------------------------------------------------------------


def _inverse_of_load(points: int = 60_000) -> CubicSpline:
    """Asinh A over ln Phi, from x_e; beyond the ends of the angles by the limits of both."""
    turn = np.linspace(-9.0, 9.0, points)
    # Angles close to both ends: x_e = pi/2 and -pi/2.
    x = 0.5 * math.pi * np.tanh(turn)
    x = x[(x > -1.56) & (x < 1.5705)]
    c, t = np.cos(x), np.tan(x)
    j = x / 8 - np.sin(4 * x) / 32 + math.pi / 16
    k = 3 * x / 8 + np.sin(2 * x) / 4 + np.sin(4 * x) / 32 + 3 * math.pi / 16
    a = (j - t * t * k) / (c**4 / 4 + t * k)
    phi = c * c / 4 - a / 8 * (x + math.pi / 2 + np.sin(x) * c)
    # Near -pi/2 the closed forms cancel.
    sound = a < 60.0
    a, phi = a[sound], phi[sound]
    far = np.geomspace(100.0, 1e9, 400)
    # Of a film that separates fast Phi = 16/(81 A^2) (1 + ...): the next terms by what A = 20 to 60 show.
    share = np.polyfit(1.0 / a[a > 20.0] ** 2, phi[a > 20.0] * 81.0 / 16.0 * a[a > 20.0] ** 2, 2)
    a = np.concatenate([a, far])
    phi = np.concatenate([phi, 16.0 / (81.0 * far**2) * np.polyval(share, 1.0 / far**2)])
    near = np.geomspace(1e3, 1e9, 400)
    a = np.concatenate([a, -near])
    phi = np.concatenate([phi, math.pi * near / 8 + 1 / (6 * near**2)])
    order = np.argsort(phi)
    phi, a = phi[order], a[order]
    keep = np.concatenate([[True], np.diff(np.log(phi)) > 1e-9])
    return CubicSpline(np.log(phi[keep]), np.arcsinh(a[keep]))


INVERSE = _inverse_of_load()
STILL = 0.203957020579723718
# Factor of (x^2 + s^2)^2 in g_r, which studies vary.
ROLLING_LIMIT = 0.058


@dataclass
class Gear:
    """A loose gear as an input gives it, SI units."""

    radius: float
    length: float
    speed: float
    mass: float
    steady_force: float
    backlash: float
    stiffness: float
    viscosity: float
    pressure_viscosity: float
    frequency: float
    amplitudes: tuple[float, ...]
    phases: tuple[float, ...]
    law: str
    modulus: float = 226e9

    def __post_init__(self) -> None:
        self.eps = (self.viscosity * self.speed / (self.modulus * self.radius)) ** 0.25
        self.film_unit = self.radius * self.eps**2
        self.load_unit = self.modulus * self.radius * self.eps**2 * self.length
        self.time_unit = self.radius * self.eps / (0.5 * self.speed)
        self.c = 4 / math.pi * math.log(1 / self.eps) + self.modulus * self.length / self.stiffness
        self.gap = self.backlash / self.film_unit
        self.mu = self.mass / (self.time_unit**2 * self.modulus * self.length)
        self.logarithm = math.log(self.viscosity) + 9.67
        self.index = 1.96e8 * self.pressure_viscosity / self.logarithm

    def thickening(self, pressure: float) -> float:
        """ln(eta/eta0) at P."""
        p = pressure * self.modulus * self.eps
        if self.law == "constant":
            return 0.0
        if self.law == "barus":
            return self.pressure_viscosity * p
        return self.logarithm * ((1 + p / 1.96e8) ** self.index - 1)

    def factors(self, h: float, m: float) -> tuple[float, float]:
        s, q = m / h, m / math.sqrt(2 * h + 8 * m / math.pi)
        x = self.thickening(0.278 * q)
        rolling = (1 + 0.830 * s) * math.exp(0.864 * x / (1 + ROLLING_LIMIT * (x**2 + s**2) ** 2) ** 0.25)
        return rolling, (1 + 0.765 * s) ** 1.5 * math.exp(self.thickening(0.213 * q))

    def velocity(self, h: float, m: float) -> float:
        rolling, squeeze = self.factors(h, m)
        return math.sqrt(h / 2) * rolling / squeeze * math.sinh(INVERSE(math.log(m * h / (12 * rolling))))

    def gives(self, h: float, m: float) -> float:
        return m * (self.c - 2 / math.pi * math.log(0.516 * h + 0.245 * m))

    def load(self, h: float, gap: float) -> float:
        """M of a film over a gap."""
        m = max((h - gap) / self.c, 1e-12)
        for _ in range(60):
            width = 0.516 * h + 0.245 * m
            slope = self.c - 2 / math.pi * (math.log(width) + 0.245 * m / width)
            step = (h - gap - self.gives(h, m)) / slope
            m = max(m + step, 0.1 * m)
            if abs(step) <= 1e-14 * m:
                break
        return m

    def steady(self, m: float) -> float:
        def miss(logarithm: float) -> float:
            h = math.exp(logarithm)
            return math.log(m * h / (12 * STILL)) - math.log(self.factors(h, m)[0])

        low = math.log(12 * STILL / m)
        high = low + 1.0
        while miss(high) < 0:
            high += 1.0
        return math.exp(brentq(miss, low, high, xtol=1e-14))

    def rest(self) -> tuple[float, float, float]:
        """Z, H1 and H2 under the steady force."""
        q = self.steady_force / self.load_unit

        def films(logarithm: float) -> tuple[float, float, float, float]:
            small = math.exp(logarithm)
            return q + small, small, self.steady(q + small), self.steady(small)

        def miss(logarithm: float) -> float:
            m1, m2, h1, h2 = films(logarithm)
            return h1 + h2 - self.gives(h1, m1) - self.gives(h2, m2) - self.gap

        m1, _, h1, h2 = films(brentq(miss, -30.0, math.log(q + 1.0), xtol=1e-13))
        return h1 - self.gives(h1, m1), h1, h2

    def force(self, time: float) -> float:
        """F at T, over the unit of loads."""
        angle = 2 * math.pi * self.frequency * time * self.time_unit
        return (
            self.steady_force
            + sum(
                a * math.cos((i + 1) * angle + phase)
                for i, (a, phase) in enumerate(zip(self.amplitudes, self.phases, strict=True))
            )
        ) / self.load_unit

    def loads(self, y: np.ndarray) -> tuple[float, float]:
        """M1 and M2; the films are states by their logarithms."""
        return self.load(math.exp(y[2]), y[0]), self.load(math.exp(y[3]), self.gap - y[0])

    def slope(self, time: float, y: np.ndarray) -> list[float]:
        m1, m2 = self.loads(y)
        h1, h2 = math.exp(y[2]), math.exp(y[3])
        return [
            y[1],
            (m1 - m2 - self.force(time)) / self.mu,
            self.velocity(h1, m1) / h1,
            self.velocity(h2, m2) / h2,
        ]

    def extremes(self, periods: int = 1, tolerance: float = 1e-9) -> dict[str, float]:
        """Extremes of some periods from rest."""
        z, h1, h2 = self.rest()
        end = periods / (self.frequency * self.time_unit)
        start = [z, 0.0, math.log(h1), math.log(h2)]
        found = solve_ivp(
            self.slope,
            (0.0, end),
            start,
            method="Radau",
            rtol=tolerance,
            atol=[tolerance, tolerance * self.gap / end, tolerance, tolerance],
            dense_output=True,
        )
        if not found.success:
            raise ArithmeticError(found.message)
        # Eight places within every step.
        share = np.linspace(0.0, 1.0, 8, endpoint=False)
        times = np.append((found.t[:-1, None] + np.diff(found.t)[:, None] * share).ravel(), end)
        states = found.sol(times)
        acceleration = np.array([self.slope(t, y)[1] for t, y in zip(times, states.T, strict=True)])
        loads = np.array([self.loads(y) for y in states.T])
        unit = self.film_unit / self.time_unit**2
        return {
            "acceleration_maximum": acceleration.max() * unit,
            "acceleration_minimum": acceleration.min() * unit,
            "film_minimum": math.exp(states[2].min()) * self.film_unit,
            "coast_film_minimum": math.exp(states[3].min()) * self.film_unit,
            "load_maximum": loads[:, 0].max() * self.load_unit,
            "coast_load_maximum": loads[:, 1].max() * self.load_unit,
        }

    def input(self, name: str, periods: int = 1) -> str:
        orders = ", ".join(str(i + 1) for i in range(len(self.amplitudes)))
        return f"""
&scene name = '{name}' /
&contact radius = {self.radius!r}, length = {self.length!r}, backlash = {self.backlash!r}
   young_modulus = {self.modulus * 0.91!r}, stiffness = {self.stiffness!r}, flattening_included = .false. /
&lubricant viscosity = {self.viscosity!r}, pressure_viscosity = {self.pressure_viscosity!r}
   viscosity_law = '{self.law}' /
&kinematics rolling_speed = {self.speed!r} /
&load mass = {self.mass!r}, steady_force = {self.steady_force!r}, gravity = 0.0
   frequency = {self.frequency!r}
   force_orders = {orders}, force_amplitudes = {", ".join(map(repr, self.amplitudes))}
   force_phases = {", ".join(map(repr, self.phases))} /
&film law = 'elastohydrodynamic' /
&solver method = 'taylor', periods = {periods}, accuracy = 1e-8 /
&spectrum periods = {periods}, verify = .false. /
&output series = .false. /
"""


def random_gear(random: np.random.Generator) -> Gear:
    """A loose gear of a transmission, at random."""

    def between(low: float, high: float) -> float:
        return float(math.exp(random.uniform(math.log(low), math.log(high))))

    mass, force = between(0.1, 1.5), between(0.5, 6.0)
    amplitude = force * between(0.8, 6.0)
    viscosity = between(0.004, 0.15)
    length = between(0.01, 0.04)
    return Gear(
        radius=between(4e-3, 15e-3),
        length=length,
        speed=between(0.8, 12.0),
        mass=mass,
        steady_force=force,
        backlash=between(40e-6, 200e-6),
        stiffness=length * between(0.8e10, 2.5e10),
        viscosity=viscosity,
        pressure_viscosity=between(1e-8, 2.5e-8),
        frequency=between(20.0, 80.0),
        amplitudes=(amplitude, amplitude * float(random.uniform(0.0, 0.5))),
        phases=(0.0, float(random.uniform(0.0, 2 * math.pi))),
        law=("constant", "barus", "roelands")[int(random.integers(3))],
    )


def reported_by(program: str, gear: Gear, folder: Path, periods: int = 1) -> dict[str, float]:
    """The same numbers by the program."""
    path = folder / "gear.nml"
    path.write_text(gear.input("gear", periods))
    command = [program, "--quiet", "--overwrite", "--output", str(folder), str(path)]
    subprocess.run(command, check=True)
    reported = {}
    for line in (folder / "gear.summary.nml").read_text().splitlines():
        name, equals, value = line.strip().partition(" = ")
        if equals and name in KEYS:
            reported[name] = float(value)
    return reported


KEYS = (
    "acceleration_maximum",
    "acceleration_minimum",
    "film_minimum",
    "coast_film_minimum",
    "load_maximum",
    "coast_load_maximum",
)


def main(program: str, scenes: str = "20", seed: str = "1") -> None:
    random = np.random.default_rng(int(seed))
    off = []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(int(scenes)):
            gear = random_gear(random)
            expected, reported = gear.extremes(), reported_by(program, gear, Path(folder))
            off.append([abs(reported[key] / expected[key] - 1.0) for key in KEYS])
            print(
                number,
                gear.law,
                f"M {expected['load_maximum'] / gear.load_unit:.3g}",
                *(f"{x:.1e}" for x in off[-1]),
            )
    print(
        "median",
        *(f"{x:.1e}" for x in np.median(off, axis=0)),
        "largest",
        *(f"{x:.1e}" for x in np.max(off, axis=0)),
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
