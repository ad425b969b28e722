"""Motions that the program reports of random gear scenes, compared with scipy.

    python tests/stress/motions_by_scipy.py PROGRAM [--scenes N] [--starts N] [--seed S]

Scenes as of stress_motions: a pair of input/gearbox_map.nml at a speed, a temperature, a tooth stiffness
and a strength of the orders that are drawn, its damping ratio below 0.3. The program finds its motions from
29 starts. The equations are those of tests/reference/elastohydrodynamic_closure.py, written from the theory
alone, and scipy's Radau method solves them: from the state of each reported motion for one period of it, and
from random starts (middle half of the gap, velocities within 2 v*), period by period until each has stayed on
a motion.
"""

from __future__ import annotations

import argparse
import math
import re
import sys
import tempfile
from bisect import bisect_right
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(REPOSITORY / "scripts"), str(REPOSITORY / "tests" / "reference")]

import elastohydrodynamic_closure as closure  # noqa: E402

import rattle  # noqa: E402

NUMBERS = (
    *("radius", "length", "mass", "steady_force", "backlash", "stiffness"),
    *("viscosity", "pressure_viscosity", "frequency"),
)
LARGEST_DAMPING = 0.3
# Shares of gap and v* within which states are those of one motion, and at which a start's own periods repeat.
SAME, REPEATED = 1e-2, 2e-4
MOST_PERIODS, LONGEST_PERIOD, STAY = 80, 8, 3
TOLERANCE = 1e-6


def fast_inverse():
    """Asinh A over ln Phi, as of the reference, without the overhead of a call with arrays."""
    places, (a, b, c, d) = closure.INVERSE.x.tolist(), closure.INVERSE.c.tolist()

    def inverse(x: float) -> float:
        i = min(max(bisect_right(places, x) - 1, 0), len(a) - 1)
        t = x - places[i]
        return ((a[i] * t + b[i]) * t + c[i]) * t + d[i]

    return inverse


@dataclass
class Motion:
    """A motion that repeats: Z and Z' at the starts of its periods of the force."""

    states: list[np.ndarray]
    starts: int = 0
    reported: bool = False
    rms: float = 0.0


@dataclass
class Found:
    """What the starts of scipy lead to."""

    motions: list[Motion] = field(default_factory=list)
    unsettled: int = 0


class Scene:
    """A scene of the program for scipy."""

    def __init__(self, reported: dict, scale: float) -> None:
        numbers = {name: float(reported[name]) for name in NUMBERS}
        orders = np.atleast_1d(reported["force_orders"]).astype(int)
        amplitudes, phases = np.zeros(orders.max()), np.zeros(orders.max())
        # The summary has them before load.force_scale.
        amplitudes[orders - 1] = scale * np.atleast_1d(reported["force_amplitudes"])
        phases[orders - 1] = np.atleast_1d(reported["force_phases"])
        self.gear = gear = closure.Gear(
            speed=2.0 * float(reported["entrainment_speed"]),
            amplitudes=tuple(amplitudes.tolist()),
            phases=tuple(phases.tolist()),
            law="roelands",
            **numbers,
        )
        # The stiffness of a tooth contains the flattening of its flanks.
        gear.c = gear.modulus * gear.length / gear.stiffness
        self.period = 1.0 / (gear.frequency * gear.time_unit)
        turn = 2.0 * math.pi * gear.frequency
        swing = sum(a / (gear.mass * (i + 1) * turn) for i, a in enumerate(amplitudes))
        self.speed = swing * gear.time_unit / gear.film_unit
        closure.INVERSE = INVERSE

    def slope(self, time: float, state: np.ndarray) -> list[float]:
        """Rates; where a trial of the solver is so far off that there are none, it takes a shorter step."""
        try:
            with np.errstate(all="ignore"):
                return self.gear.slope(time, state)
        except (ArithmeticError, ValueError):
            return [math.nan] * 4

    def reported_state(self, row) -> list[float]:
        """State from the numbers of a reported motion."""
        gear = self.gear
        m1, m2 = (
            gear.stiffness * float(value) / gear.load_unit
            for value in (row.drive_compression, row.coast_compression)
        )
        h1 = float(row.film) / gear.film_unit
        z = h1 - gear.gives(h1, m1)
        h2 = self.film_over(gear.gap - z, m2)
        return [z, float(row.velocity) * gear.time_unit / gear.film_unit, math.log(h1), math.log(h2)]

    def film_over(self, gap: float, m: float) -> float:
        h = gap
        for _ in range(100):
            h = gap + self.gear.gives(h, m)
        return h

    def start(self, share: float, speed: float) -> list[float]:
        """Films that carry their loads at rest about a place in the gap, and a velocity."""
        gear = self.gear
        z = share * gear.gap
        films = []
        for gap in (z, gear.gap - z):
            h = gap
            for _ in range(100):
                h = gap + gear.gives(h, 12.0 * closure.STILL / h)
            films.append(math.log(h))
        return [z, speed * self.speed, *films]

    def carry_on(self, state: list[float], periods: int = 1, squares: bool = False):
        """States at the ends of some periods, and the rms of the acceleration if asked for."""
        gear, ends, square = self.gear, [], 0.0
        for _ in range(periods):
            solution = solve_ivp(
                self.slope,
                (0.0, self.period),
                state,
                method="Radau",
                rtol=TOLERANCE,
                atol=[TOLERANCE * gear.gap, TOLERANCE * self.speed, TOLERANCE, TOLERANCE],
                dense_output=squares,
            )
            if not solution.success:
                raise ArithmeticError(solution.message)
            state = solution.y[:, -1].tolist()
            ends.append(np.array(state[:2]))
            if squares:
                for low, high in zip(solution.t[:-1], solution.t[1:], strict=True):
                    times = np.linspace(low, high, 5)
                    values = [self.slope(t, solution.sol(t))[1] ** 2 for t in times]
                    square += float(np.trapezoid(values, times))
        rms = math.sqrt(square / (periods * self.period)) * gear.film_unit / gear.time_unit**2
        return state, ends, rms

    def distance(self, one: np.ndarray, other: np.ndarray) -> float:
        return max(abs(one[0] - other[0]) / self.gear.gap, abs(one[1] - other[1]) / self.speed)

    def joined(self, past: list[np.ndarray], motions: list[Motion]) -> Motion | None:
        """The motion on which the last states are."""
        for motion in motions:
            count = len(motion.states)
            for shift in range(count):
                if all(
                    self.distance(state, motion.states[(i + shift) % count]) <= SAME
                    for i, state in enumerate(past[-STAY - 1 :])
                ):
                    return motion
        return None

    def repeats(self, past: list[np.ndarray]) -> int:
        for period in range(1, LONGEST_PERIOD + 1):
            if len(past) < 2 * LONGEST_PERIOD + period:
                break
            pairs = [(past[-i], past[-i - period]) for i in range(1, 2 * LONGEST_PERIOD)]
            if all(self.distance(*pair) <= REPEATED for pair in pairs):
                return period
        return 0

    def follow(self, state: list[float], found: Found) -> None:
        past = [np.array(state[:2])]
        for _ in range(MOST_PERIODS):
            state, ends, _ = self.carry_on(state)
            past += ends
            if len(past) > STAY and (motion := self.joined(past, found.motions)) is not None:
                motion.starts += 1
                return
            if period := self.repeats(past):
                _, states, rms = self.carry_on(state, period, squares=True)
                found.motions.append(Motion([np.array(state[:2]), *states[:-1]], 1, rms=rms))
                return
        found.unsettled += 1


INVERSE = fast_inverse()


def pairs_of_map() -> list[str]:
    """Inputs of single motions of the pairs of the ready map."""
    text = (REPOSITORY / "input" / "gearbox_map.nml").read_text().replace("'campaign'", "'motion'")
    gears = re.findall(r"&gear\n.*?\n/\n", text, re.DOTALL)
    head, tail = text[: text.index("&gear\n")], text[text.index("&shaft\n") : text.index("&campaign\n")]
    return [head + gear + tail for gear in gears]


def drawn(random: np.random.Generator, program: str, folder: Path):
    """Words, scene, summary and motions of the next scene that is lightly damped."""
    while True:
        pair = int(random.integers(4))
        values = {
            "shaft.speed_rpm": round(float(random.uniform(600.0, 3500.0)), 3),
            "oil.temperature_celsius": round(float(random.uniform(-20.0, 120.0)), 3),
            "gear.tooth_stiffness": float(f"{10.0 ** random.uniform(7.0, 12.0):.6g}"),
            "load.force_scale": round(float(2.0 ** random.uniform(-1.0, 1.0)), 5),
        }
        (folder / "scene.nml").write_text(pairs_of_map()[pair])
        try:
            rattle.run(
                folder / "scene.nml",
                set=values | {"solver.periods": 200},
                folder=folder / "results",
                overwrite=True,
                program=program,
            )
        except rattle.RunError:
            continue
        summary = rattle.read_summary(folder / "results" / "scene.summary.nml")
        if float(summary["damping_ratio"]) < LARGEST_DAMPING and "motions" in summary:
            motions = rattle.read(folder / "results" / "scene.motions.rattle")
            scene = Scene(summary, values["load.force_scale"])
            return f"pair {pair + 1} {values}", scene, summary, motions.frame()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--scenes", type=int, default=10)
    parser.add_argument("--starts", type=int, default=8)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    motions = met = reported_count = left = 0
    missed = []
    with tempfile.TemporaryDirectory() as folder:
        for name in ("gearbox_run_up.csv",):
            (Path(folder) / name).write_bytes((REPOSITORY / "input" / name).read_bytes())
        for number in range(options.scenes):
            words, scene, summary, frame = drawn(random, options.program, Path(folder))
            found, off = Found(), []
            for row in frame.itertuples():
                if row.orbit_period == 0:
                    continue
                reported_count += 1
                state = scene.reported_state(row)
                _, ends, rms = scene.carry_on(state, int(row.orbit_period), squares=True)
                states = [np.array(state[:2]), *ends[:-1]]
                apart = scene.distance(ends[-1], states[0])
                off.append((apart, abs(rms / row.acceleration_rms - 1.0)))
                if apart > SAME:
                    left += 1
                    continue
                found.motions.append(Motion(states, reported=True, rms=rms))
            irregular = bool((frame.orbit_period == 0).any()) or int(summary["unsettled_starts"]) > 0
            for _ in range(options.starts):
                share, speed = random.uniform(0.25, 0.75), random.uniform(-2.0, 2.0)
                scene.follow(scene.start(share, speed), found)
            reached = [motion for motion in found.motions if motion.starts > 0]
            motions += len(reached) + (found.unsettled > 0)
            met += sum(motion.reported for motion in reached) + (found.unsettled > 0 and irregular)
            lost = [motion for motion in reached if not motion.reported]
            missed += [(number, motion.rms, motion.starts) for motion in lost]
            print(
                f"{number}: {words}; reported {len(frame)}, "
                + ", ".join(f"{rms:.4g}" for rms in frame.acceleration_rms)
                + f" m/s2, {summary['unsettled_starts']} of 29 starts unsettled; scipy: "
                + ", ".join(
                    f"{m.rms:.4g} m/s2 {m.starts}{'' if m.reported else ' NOT REPORTED'}" for m in reached
                )
                + f", unsettled {found.unsettled}; off "
                + ", ".join(f"{a:.1e} {b:.1e}" for a, b in off),
                flush=True,
            )
    print(f"motions of scipy {motions}, reported {met}; reported ones {reported_count}, left by scipy {left}")
    print("missed (scene, m/s2, starts):", missed)
    sys.exit(1 if left else 0)


if __name__ == "__main__":
    main()
