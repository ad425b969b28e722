"""Films between elastic flanks in nodes of pressure, beside others: the canonical scene and scene G of a
loose gear, oil of constant viscosity and Roelands'.

    bench_nodes.py PROGRAM [--rounds 3] [--limit SECONDS] [--flags FILE]

Processor time from rest, medians of interleaved rounds: of this program as a whole process, its start and
the motion by the closure that chooses the grid included; of the others the solution alone, in numpy,
without imports and grids. *Radau* is scipy's implicit method with analytic Jacobian on the equations that
this program solves (nodes_equations.py, its cubics in xi and flows of fourth order); oil that a ruptured
cell would lack is added in proportion to a pressure below 0. *Prototype* is dense elimination at fixed
steps: hats, second order in space and time, the active set decided within Newton's method, the gear one
more row. The canonical scene is followed for two periods, scene G for one. Errors are those of the
largest acceleration and of the smallest film against solutions that are extrapolated over the nodes,
known to two in their last digit.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from nodes_equations import Film, Scene, next_active, steady
from scipy.integrate import solve_ivp

CANONICAL = {
    "radius": 0.0127,
    "length": 0.01,
    "modulus": 2.2e11,
    "stiffness": 1e8,
    "rolling": 3.81,
    "mass": 3.0,
    "steady": 199.2 + 3.0 * 9.80665,
    "frequency": 600.0,
    "amplitudes": (205.7,),
    "viscosity": 0.3,
    "alpha": 2e-8,
    "backlash": 0.0,
    "periods": 2,
    "spread": 4.0,
}
GEAR = {
    "radius": 9.1269e-3,
    "length": 0.018943,
    "modulus": 226e9,
    "stiffness": 2.38e8,
    "rolling": 2.83747,
    "mass": 0.620931,
    "steady": 2.04527,
    "frequency": 30.0,
    "amplitudes": (9.15706, 2.44188),
    "viscosity": 0.0214299,
    "alpha": 1.57335e-8,
    "backlash": 110e-6,
    "periods": 1,
}
SCENES = (
    Scene("canonical, constant", law="constant", reference=(287.33, 0.6047e-6), **CANONICAL),
    Scene("canonical, Roelands", law="roelands", reference=(295.11, 1.8883e-6), **CANONICAL),
    Scene("scene G, constant", law="constant", reference=(507.3, 0.1320e-6), **GEAR),
    Scene("scene G, Roelands", law="roelands", reference=(513.3, 0.2385e-6), **GEAR),
)
# Oil added to a cell in a time unit under the pressure -1, over its length and over 1 + X^2
ADDED = 1e3


class Reported:
    """Largest acceleration [m/s2] and smallest film [m] of what has been seen of a motion."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.peak, self.film = scene, -np.inf, np.inf

    def see(self, time: float, films: list[Film], gaps: list[float], pressures: list[np.ndarray]) -> None:
        loads = [film.load @ p for film, p in zip(films, pressures, strict=True)]
        net = loads[0] - (loads[1] if len(loads) > 1 else 0.0)
        self.peak = max(self.peak, self.scene.acceleration(net, time))
        for film, gap, p in zip(films, gaps, pressures, strict=True):
            self.film = min(self.film, film.smallest(gap, p) * self.scene.film_unit)


def at_rest(scene: Scene, films: list[Film]) -> tuple[float, list[np.ndarray]]:
    """Position and pressures at rest on the drive flank; what the coast film carries is found by turns."""
    load = scene.steady / scene.load_unit
    position, drive = steady(films[0], load)
    if len(films) == 1:
        return position, [drive]
    for _ in range(3):
        coast = open_film(films[1], scene.gap - position)
        position, drive = steady(films[0], load + films[1].load @ coast)
    return position, [drive, coast]


def open_film(film: Film, gap: float) -> np.ndarray:
    """Pressures of a film at rest in a wide gap."""
    middle = 0.5 * (film.edge[1:] + film.edge[:-1])
    pressures = np.maximum(-middle, 0.0) / (2.0 * gap + middle**2) ** 2
    for _ in range(60):
        rates, slopes, _, _ = film.rates(gap, pressures)
        active = next_active(pressures, -slopes, -rates)
        change = np.where(active, 0.0, -pressures)
        right = -(rates + slopes @ change)[active]
        change[active] = np.linalg.solve(slopes[np.ix_(active, active)], right)
        pressures = pressures + change
        if np.abs(change).max() < 1e-10 * (pressures.max() + 1e-12):
            break
    return pressures


def gaps_of(scene: Scene, position: float) -> list[float]:
    return [position, scene.gap - position] if scene.gap > 0.0 else [position]


def prototype(scene: Scene, films: list[Film], steps: int) -> Reported:
    """Fixed steps, backward differences of second order, dense elimination."""
    reported = Reported(scene)
    n = films[0].nodes
    size = n * len(films) + 1
    position, pressures = at_rest(scene, films)
    step = scene.period / steps
    old = [
        (
            position,
            0.0,
            [held(f, g, p) for f, g, p in zip(films, gaps_of(scene, position), pressures, strict=True)],
        )
    ]
    for number in range(1, steps * scene.periods + 1):
        first = len(old) == 1
        a0 = (1.0 if first else 1.5) / step
        back = [(-1.0 / step, old[-1])] if first else [(-2.0 / step, old[-1]), (0.5 / step, old[-2])]
        past_position = sum(weight * state[0] for weight, state in back)
        past_velocity = sum(weight * state[1] for weight, state in back)
        now = number * step
        if not first:
            position = 2.0 * old[-1][0] - old[-2][0]
        for _ in range(60):
            table, right = np.zeros((size, size)), np.zeros(size)
            net = -scene.force(now) - scene.inertia * (a0 * (a0 * position + past_position) + past_velocity)
            table[-1, -1] = scene.inertia * a0 * a0
            actives = []
            for k, (film, gap) in enumerate(zip(films, gaps_of(scene, position), strict=True)):
                sense, rows, p = 1.0 - 2.0 * k, slice(n * k, n * (k + 1)), pressures[k]
                rates, slopes, by_gap, _ = film.rates(gap, p)
                past = sum(weight * state[2][k] for weight, state in back)
                residual = a0 * held(film, gap, p) + past - rates
                by_pressure = a0 * film.volume - slopes
                active = next_active(p, by_pressure, residual)
                actives.append(active)
                block = np.where(active[:, None], by_pressure, np.eye(n))
                table[rows, rows] = block
                table[rows, -1] = np.where(active, sense * (a0 * film.length - by_gap), 0.0)
                right[rows] = np.where(active, -residual, -p)
                table[-1, rows] = -sense * film.load
                net += sense * (film.load @ p)
            right[-1] = net
            change = np.linalg.solve(table, right)
            share = 1.0
            moved = [p + change[n * k : n * (k + 1)] for k, p in enumerate(pressures)]
            while share > 1e-3 and any(
                (gap + film.bowl + film.film @ p).min() <= 0.0
                for film, gap, p in zip(
                    films, gaps_of(scene, position + share * change[-1]), moved, strict=True
                )
            ):
                share *= 0.5
                moved = [p + share * change[n * k : n * (k + 1)] for k, p in enumerate(pressures)]
            position += share * change[-1]
            largest = max(float(p.max()) for p in moved)
            small = np.abs(change[:-1]).max() <= 1e-7 * (largest + 1e-4) and abs(change[-1]) <= 1e-7 * abs(
                position
            )
            pressures = moved
            if small and share >= 1.0:
                break
        else:
            raise ArithmeticError(f"no step at {now / scene.period:.4f} periods")
        pressures = [np.maximum(p, 0.0) for p in pressures]
        velocity = a0 * position + past_position
        gaps = gaps_of(scene, position)
        old = [
            old[-1],
            (position, velocity, [held(f, g, p) for f, g, p in zip(films, gaps, pressures, strict=True)]),
        ]
        reported.see(now, films, gaps, pressures)
    return reported


def held(film: Film, gap: float, pressures: np.ndarray) -> np.ndarray:
    """What the cells hold."""
    return gap * film.length + film.hollow + film.volume @ pressures


def radau(scene: Scene, films: list[Film], tolerance: float) -> Reported:
    """scipy's Radau: states are position, velocity and pressures; cells hold what their volumes have."""
    n = films[0].nodes
    position, pressures = at_rest(scene, films)
    start = np.concatenate([[position, 0.0], *pressures])
    inverses = [np.linalg.inv(film.volume) for film in films]
    added = [ADDED * film.length * (1.0 + film.bowl[1:] + film.bowl[:-1]) for film in films]
    size = len(start)

    def parts(y: np.ndarray):
        for k, (film, gap) in enumerate(zip(films, gaps_of(scene, y[0]), strict=True)):
            yield k, film, gap, slice(2 + n * k, 2 + n * (k + 1)), 1.0 - 2.0 * k

    def rate(now: float, y: np.ndarray) -> np.ndarray:
        out = np.empty(size)
        out[0], net = y[1], -scene.force(now)
        for k, film, gap, rows, sense in parts(y):
            p = y[rows]
            gained = film.rates(gap, p)[0] + added[k] * np.maximum(-p, 0.0)
            out[rows] = inverses[k] @ (gained - sense * y[1] * film.length)
            net += sense * (film.load @ p)
        out[1] = net / scene.inertia
        return out

    def jacobian(now: float, y: np.ndarray) -> np.ndarray:
        out = np.zeros((size, size))
        out[0, 1] = 1.0
        for k, film, gap, rows, sense in parts(y):
            p = y[rows]
            _, slopes, by_gap, _ = film.rates(gap, p)
            slopes[np.arange(n), np.arange(n)] -= added[k] * (p < 0.0)
            out[rows, rows] = inverses[k] @ slopes
            out[rows, 0] = sense * (inverses[k] @ by_gap)
            out[rows, 1] = -sense * (inverses[k] @ film.length)
            out[1, rows] = sense * film.load / scene.inertia
        return out

    least = np.concatenate([[1.0, scene.inertia**-1], np.full(size - 2, 0.1)]) * tolerance
    solved = solve_ivp(
        rate,
        (0.0, scene.periods * scene.period),
        start,
        method="Radau",
        jac=jacobian,
        rtol=tolerance,
        atol=least,
    )
    if not solved.success:
        raise ArithmeticError(solved.message)
    reported = Reported(scene)
    for now, y in zip(solved.t, solved.y.T, strict=True):
        reported.see(now, films, gaps_of(scene, y[0]), [y[rows] for _, _, _, rows, _ in parts(y)])
    return reported


def input_of(scene: Scene) -> str:
    """The scene as an input of this program."""
    orders = ", ".join(str(k + 1) for k in range(len(scene.amplitudes)))
    amplitudes = ", ".join(map(repr, scene.amplitudes))
    phases = ", ".join("0.0" for _ in scene.amplitudes)
    backlash = f"backlash = {scene.backlash!r}, " if scene.backlash else ""
    return f"""&contact radius = {scene.radius!r}, length = {scene.length!r}, {backlash}
   stiffness = {scene.stiffness!r}, young_modulus = {scene.modulus * (1 - 0.3**2)!r},
   flattening_included = .false. /
&lubricant viscosity = {scene.viscosity!r}, pressure_viscosity = {scene.alpha!r},
   viscosity_law = '{scene.law}' /
&kinematics entrainment_speed = {0.5 * scene.rolling!r} /
&load mass = {scene.mass!r}, steady_force = {scene.steady!r}, gravity = 0.0, frequency = {scene.frequency!r},
   force_orders = {orders}, force_amplitudes = {amplitudes}, force_phases = {phases} /
&film law = 'elastohydrodynamic', model = 'resolved' /
&solver until = 'periods', periods = {scene.periods}, samples_per_period = 16 /
&spectrum periods = {scene.periods}, irregular_limit = 0.9, verify = .false. /
&output series = .false. /
"""


def program_run(program: str, scene: Scene, nodes: int, accuracy: float, place: Path) -> Reported:
    path = place / "scene.nml"
    path.write_text(input_of(scene))
    settings = ["--set", f"film.nodes={nodes}", "--set", f"solver.accuracy={accuracy}"]
    subprocess.run(
        [program, "--quiet", "--overwrite", "--threads", "1", "--output", str(place), *settings, str(path)],
        check=True,
    )
    numbers = dict(
        line.strip().split(" = ", 1)
        for line in (place / "scene.summary.nml").read_text().splitlines()
        if " = " in line
    )
    reported = Reported(scene)
    reported.peak = float(numbers["acceleration_maximum"])
    reported.film = min(float(numbers[k]) for k in ("film_minimum", "coast_film_minimum") if k in numbers)
    return reported


def spent(job: Callable[[], Reported], children: bool) -> tuple[float, Reported]:
    """Processor time of a job, or of the process that it starts [s]."""

    def clock() -> float:
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime if children else time.process_time()

    before = clock()
    reported = job()
    return clock() - before, reported


def contenders(
    program: str, scene: Scene, place: Path
) -> list[tuple[str, str, bool, Callable[[], Reported], float]]:
    """Name, setting, whether it is a process, the job, and the seconds that it is known to take at least."""
    fine = 4096 if scene.gap else 256
    jobs: list = [
        ("rattle", f"{nodes} nodes, accuracy {accuracy:g}", True, nodes, accuracy)
        for nodes, accuracy in ((32, 1e-3), (64, 3e-4))
    ]
    found = [
        (name, setting, own, lambda n=nodes, a=accuracy: program_run(program, scene, n, a, place))
        for name, setting, own, nodes, accuracy in jobs
    ]
    flanks = 2 if scene.gap else 1
    for nodes in (32, 64):
        films = [Film(scene, nodes, cubic=False)] * flanks
        for steps in (fine, 4 * fine):
            if nodes == 64 and steps == fine:
                continue
            found.append(
                (
                    "prototype",
                    f"{nodes} nodes, {steps} steps",
                    False,
                    lambda f=films, s=steps: prototype(scene, f, s),
                )
            )
    films = [Film(scene, 32, cubic=True)] * flanks
    for tolerance in (1e-3, 1e-4):
        found.append(
            ("Radau", f"32 nodes, {tolerance:g}", False, lambda f=films, t=tolerance: radau(scene, f, t))
        )
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument(
        "--limit", type=float, default=20.0, help="seconds beyond which a contender is run once"
    )
    parser.add_argument("--flags", type=Path, help="flags file of the build of the program")
    options = parser.parse_args()
    print(
        "| scene | who | setting | processor time | over rattle | error of the peak | of the minimum film |"
    )
    print("|---|---|---|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for scene in SCENES:
            found = contenders(options.program, scene, Path(folder))
            times: list[list[float]] = [[] for _ in found]
            reported: list[Reported | str] = ["" for _ in found]
            for turn in range(options.rounds):
                for k, (_, _, children, job) in enumerate(found):
                    if turn > 0 and (isinstance(reported[k], str) or times[k][0] > options.limit):
                        continue
                    try:
                        seconds, reported[k] = spent(job, children)
                        times[k].append(seconds)
                    except (ArithmeticError, np.linalg.LinAlgError) as stop:
                        reported[k] = str(stop)
            base = statistics.median(times[0])
            for k, (name, setting, _, _) in enumerate(found):
                start = f"| {scene.name} | {name} | {setting} | "
                ended = reported[k]
                if isinstance(ended, str):
                    print(f"{start}stopped: {ended} | | | |", flush=True)
                    continue
                seconds = statistics.median(times[k])
                errors = (ended.peak / scene.reference[0] - 1.0, ended.film / scene.reference[1] - 1.0)
                print(
                    f"{start}{seconds:.3f} s | {seconds / base:.0f} | {errors[0]:+.1e} | {errors[1]:+.1e} |",
                    flush=True,
                )
    if options.flags:
        print()
        print("\n".join(options.flags.read_text().splitlines()[:2]))


if __name__ == "__main__":
    main()
