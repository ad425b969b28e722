"""Peer heyoka.py: Taylor integrator, one scene at a time and eight lanes at once.

Scene numbers are runtime parameters, so one compiled integrator serves all scenes of a film and tolerance.
In the batch all eight lanes hold the same scene, the best case for a batch (no lane waits for another); its
time is divided by eight. The Reynolds films are expressible in the states (y, d) of equations.py, without a
root search.
"""

import functools
import time
from collections.abc import Callable

import equations
import heyoka as hy
import numpy as np
import scenes

VERSION = hy.__version__
LANES = 8
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12, 1e-14)


def _piezo_load(d, s, c, a, b):
    """Psi(A, B), equations._piezo_load as an expression."""
    t = -c / s
    t_sum = t + a
    peak = hy.atan2(hy.expression(1.0), t_sum)

    def pressure(phi):
        s2, c2 = hy.sin(2.0 * phi), hy.cos(2.0 * phi)
        k = 0.375 * phi - 0.25 * s2 + 0.0625 * (s2 * c2)
        down = 1.0 - c2
        p = 0.125 * phi - 0.0625 * (s2 * c2) - (t * t) * k - a * (0.0625 * (down * down) + t * k)
        return p, s2, c2

    top, _, c2 = pressure(peak)
    width = hy.sqrt((1.0 - b * top) * 4.0 / (b * (t + t_sum) * (1.0 - c2)))
    low = hy.asinh(-peak / width)
    span = hy.asinh((d - peak) / width) - low
    terms = []
    for node, weight in zip(equations.NODES, equations.WEIGHTS, strict=True):
        grow = hy.exp(low + span * float(node))
        shrink = 1.0 / grow
        p, s2, c2 = pressure(peak + (0.5 * width) * (grow - shrink))
        rise = 0.25 * s2 * (1.0 + c2 - a * s2 - (t * t_sum) * (1.0 - c2))
        terms.append(float(weight) * (grow + shrink) * rise / (1.0 - b * p))
    return 0.5 * width * span * hy.sum(terms)


def _system(film: str) -> list:
    """Equations of a film in the parameters a, c, q, B0, steady load."""
    y, v = hy.make_vars("y", "v")
    big_a, rate, ratio, scale, steady = (hy.par[i] for i in range(5))
    drive = 1.0 + ratio * hy.cos(2.0 * np.pi * hy.time)
    if film == "published iso_viscous":
        return [(y, v), (v, big_a * (1.0 / y - rate * v * y**-1.5 - drive))]
    if film == "published piezo_viscous":
        return [(y, v), (v, big_a * (y**-3.5 * hy.exp(-rate * v) - drive))]
    d, root = v, hy.sqrt(y)
    a, slope, load = _flank(d)
    if film == "reynolds piezo_viscous":
        load = _piezo_load(d, hy.sin(d), hy.cos(d), a, scale / (y * root))
    squeeze = a / rate
    return [
        (y, squeeze * root),
        (d, slope * rate / root * (big_a * (load / (steady * y) - drive) - 0.5 * (squeeze * squeeze))),
    ]


def _flank(d):
    """A, dd/dA and Phi of a Reynolds iso-viscous film from its rupture angle."""
    s, c = hy.sin(d), hy.cos(d)
    sc, s2 = s * c, s * s
    quarter = 0.5 * sc * (1.0 - 2.0 * s2)
    j, k = 0.125 * d - 0.25 * quarter, 0.375 * d - 0.5 * sc + 0.25 * quarter
    a = (s2 * j - c * c * k) / (0.25 * (s2 * s2) * s2 - sc * k)
    return a, s2 * (0.25 * (s2 * s2) * s - c * k) / (k * (2.0 * c - a * s)), 0.25 * s2 - 0.125 * a * (d - sc)


def _flanks_system(orders: int) -> list:
    """Equations of the Reynolds iso-viscous film between two rigid flanks under several orders
    (scenes.py)."""
    y, drive_angle, coast_angle = hy.make_vars("y", "d", "coast")
    big_a, rate, ratio, backlash, _, steady = (hy.par[i] for i in range(6))
    drive = 1.0 + ratio * hy.cos(2.0 * np.pi * hy.time)
    for order in range(2, orders + 1):
        turn = 2.0 * np.pi * float(order) * hy.time
        drive += hy.par[2 * order + 2] * hy.cos(turn + hy.par[2 * order + 3])
    a, slope, load = _flank(drive_angle)
    _, coast_slope, coast_load = _flank(coast_angle)
    gap = backlash - y
    root, coast_root = hy.sqrt(y), hy.sqrt(gap)
    v = a * root / rate
    change = big_a * (load / (steady * y) - coast_load / (steady * gap) - drive)
    return [
        (y, v),
        (drive_angle, slope * rate / root * (change - 0.5 * (v * v) / y)),
        (coast_angle, -coast_slope * rate / coast_root * (change + 0.5 * (v * v) / gap)),
    ]


def _changed_system(kind: tuple) -> list:
    """Equations of a published film under several orders, on two flanks, of elastic teeth (scenes.py).

    Parameters: a, c, q, backlash, compliance, then ratio and phase of every order above the first.
    """
    film, orders, two_flanks, springs = kind
    if film == "reynolds iso_viscous":
        return _flanks_system(orders)
    iso = film == "published iso_viscous"
    y, v, z, coast = hy.make_vars("y", "v", "z", "coast")
    big_a, rate, ratio, backlash, compliance = (hy.par[i] for i in range(5))
    turn = 2.0 * np.pi * hy.time
    drive = 1.0 + ratio * hy.cos(turn)
    for order in range(2, orders + 1):
        drive += hy.par[2 * order + 1] * hy.cos(float(order) * turn + hy.par[2 * order + 2])

    def load(gap, speed):
        return 1.0 / gap - rate * speed * gap**-1.5 if iso else gap**-3.5 * hy.exp(-rate * speed)

    def speed(gap, load):
        return hy.sqrt(gap) * (1.0 - gap * load) / rate if iso else -(hy.log(load) + 3.5 * hy.log(gap)) / rate

    if not springs:
        net = load(y, v) - load(backlash - y, -v) if two_flanks else load(y, v)
        return [(y, v), (v, big_a * (net - drive))]
    first = (y - z) / compliance
    system = [(y, speed(y, first)), (z, v)]
    net = first
    if two_flanks:
        second = (coast - (backlash - z)) / compliance
        system.append((coast, speed(coast, second)))
        net = first - second
    return [*system, (v, big_a * (net - drive))]


def _parameters(scene: scenes.Scene) -> np.ndarray:
    """What the equations of a scene take."""
    if not scene.is_changed:
        return scene.parameters
    orders = [number for pair in zip(scene.more_ratios, scene.phases, strict=True) for number in pair]
    steady = [scene.steady_load] if scene.model == "reynolds" else []
    return np.array([*scene.parameters[:3], scene.backlash, scene.compliance, *steady, *orders])


def _start(scene: scenes.Scene) -> list[float]:
    if scene.compliance > 0.0:
        coast = [scenes.coast_start(scene)] if scene.backlash > 0.0 else []
        return [1.0, 1.0 - scene.compliance, *coast, 0.0]
    if scene.model == "published":
        return [1.0, 0.0]
    if scene.backlash > 0.0:
        return [scenes.rest_between_flanks(scene.backlash), scenes.STEADY_ANGLE, scenes.STEADY_ANGLE]
    return [1.0, scenes.STEADY_ANGLE]


def _equations(kind: tuple) -> list:
    return _system(kind[0]) if kind[1:] == (1, False, False) else _changed_system(kind)


def _grid(scene: scenes.Scene) -> np.ndarray:
    """Start and times of the sampled part, which needs dense output; the part before is faster without."""
    return np.append(scene.sample_times[0] - 1.0 / scenes.POINTS_A_PERIOD, scene.sample_times)


def _options(film: str) -> dict:
    """Measured on the published films: fast_math gains a fifth; the plain mode is faster than the compact
    mode, but it compiles for minutes where the expression is long."""
    return {"fast_math": True, "compact_mode": film == "reynolds piezo_viscous"}


@functools.cache
def _scalar(kind: tuple, tolerance: float):
    system = _equations(kind)
    return hy.taylor_adaptive(system, np.full(len(system), 0.5), tol=tolerance, **_options(kind[0]))


@functools.cache
def _batch(kind: tuple, tolerance: float):
    system = _equations(kind)
    return hy.taylor_adaptive_batch(
        system, np.ones((len(system), LANES)), tol=tolerance, force_avx512=True, **_options(kind[0])
    )


def prepare_scalar(scene: scenes.Scene, tolerance: float) -> Callable[[], tuple[np.ndarray, float]]:
    """Compile; the function returned solves once and gives the film and the CPU seconds."""
    integrator, start = _scalar(scene.kind, tolerance), _start(scene)
    parameters = _parameters(scene)
    grid = _grid(scene)

    def solve() -> tuple[np.ndarray, float]:
        begin = time.thread_time()
        integrator.time = 0.0
        integrator.state[:] = start
        integrator.pars[:] = parameters[: len(integrator.pars)]
        integrator.propagate_until(grid[0])
        film = integrator.propagate_grid(grid)[-1][1:, 0]
        return film, time.thread_time() - begin

    return solve


def prepare_batch(scene: scenes.Scene, tolerance: float) -> Callable[[], tuple[np.ndarray, float]]:
    """Like prepare_scalar for eight lanes; seconds are those of one lane, the film that of the first lane."""
    integrator = _batch(scene.kind, tolerance)
    start = np.repeat(np.array(_start(scene))[:, None], LANES, axis=1)
    parameters = np.repeat(_parameters(scene)[:, None], LANES, axis=1)
    grid = _grid(scene)
    times = np.repeat(grid[:, None], LANES, axis=1)

    def solve() -> tuple[np.ndarray, float]:
        begin = time.thread_time()
        integrator.set_time(0.0)
        integrator.state[:] = start
        integrator.pars[:] = parameters[: len(integrator.pars)]
        integrator.propagate_until(grid[0])
        film = integrator.propagate_grid(times)[-1][1:, 0, 0]
        return film, (time.thread_time() - begin) / LANES

    return solve


IS_COMMAND = False
CONTENDERS = {
    "heyoka scalar": (prepare_scalar, TOLERANCES),
    "heyoka 8 lanes": (prepare_batch, TOLERANCES),
}
