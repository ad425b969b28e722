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
# The sampled part needs dense output, the part before does not and is faster without.
FIRST = float(scenes.PERIODS - scenes.SAMPLED_PERIODS)
GRID = np.append(FIRST, scenes.SAMPLE_TIMES)


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
    s, c = hy.sin(d), hy.cos(d)
    sc, s2 = s * c, s * s
    quarter = 0.5 * sc * (1.0 - 2.0 * s2)
    j, k = 0.125 * d - 0.25 * quarter, 0.375 * d - 0.5 * sc + 0.25 * quarter
    a = (s2 * j - c * c * k) / (0.25 * (s2 * s2) * s2 - sc * k)
    slope = s2 * (0.25 * (s2 * s2) * s - c * k) / (k * (2.0 * c - a * s))
    if film == "reynolds iso_viscous":
        load = 0.25 * s2 - 0.125 * a * (d - sc)
    else:
        load = _piezo_load(d, s, c, a, scale / (y * root))
    squeeze = a / rate
    return [
        (y, squeeze * root),
        (d, slope * rate / root * (big_a * (load / (steady * y) - drive) - 0.5 * (squeeze * squeeze))),
    ]


def _start(scene: scenes.Scene) -> list[float]:
    return [1.0, 0.0 if scene.model == "published" else scenes.STEADY_ANGLE]


def _options(film: str) -> dict:
    """Measured on the published films: fast_math gains a fifth; the plain mode beats the compact mode, but it
    compiles for minutes where the expression is long."""
    return {"fast_math": True, "compact_mode": film == "reynolds piezo_viscous"}


@functools.cache
def _scalar(film: str, tolerance: float):
    return hy.taylor_adaptive(_system(film), [1.0, 0.5], tol=tolerance, **_options(film))


@functools.cache
def _batch(film: str, tolerance: float):
    return hy.taylor_adaptive_batch(
        _system(film), np.ones((2, LANES)), tol=tolerance, force_avx512=True, **_options(film)
    )


def prepare_scalar(scene: scenes.Scene, tolerance: float) -> Callable[[], tuple[np.ndarray, float]]:
    """Compile; the function returned solves once and gives the film and the CPU seconds."""
    integrator, start = _scalar(scene.film, tolerance), _start(scene)

    def solve() -> tuple[np.ndarray, float]:
        begin = time.thread_time()
        integrator.time = 0.0
        integrator.state[:] = start
        integrator.pars[:] = scene.parameters[: len(integrator.pars)]
        integrator.propagate_until(FIRST)
        film = integrator.propagate_grid(GRID)[-1][1:, 0]
        return film, time.thread_time() - begin

    return solve


def prepare_batch(scene: scenes.Scene, tolerance: float) -> Callable[[], tuple[np.ndarray, float]]:
    """Like prepare_scalar for eight lanes; seconds are those of one lane, the film that of the first lane."""
    integrator = _batch(scene.film, tolerance)
    start = np.repeat(np.array(_start(scene))[:, None], LANES, axis=1)
    parameters = np.repeat(scene.parameters[:, None], LANES, axis=1)
    times = np.repeat(GRID[:, None], LANES, axis=1)

    def solve() -> tuple[np.ndarray, float]:
        begin = time.thread_time()
        integrator.set_time(0.0)
        integrator.state[:] = start
        integrator.pars[:] = parameters[: len(integrator.pars)]
        integrator.propagate_until(FIRST)
        film = integrator.propagate_grid(times)[-1][1:, 0, 0]
        return film, (time.thread_time() - begin) / LANES

    return solve


IS_COMMAND = False
CONTENDERS = {
    "heyoka scalar": (prepare_scalar, TOLERANCES),
    "heyoka 8 lanes": (prepare_batch, TOLERANCES),
}
