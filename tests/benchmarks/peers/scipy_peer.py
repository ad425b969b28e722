"""Peer SciPy: solve_ivp with LSODA, Radau (with Jacobian) and DOP853, right-hand sides compiled by numba."""

import functools
import time
from collections.abc import Callable

import equations
import numpy as np
import scenes
import scipy
from scipy.integrate import solve_ivp

njit = equations.njit
VERSION = scipy.__version__ if njit.__module__.startswith("numba") else f"{scipy.__version__} without numba"
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)


@njit
def _rates(tau, state, film, p):
    first, second = equations.rates(film, tau, state[0], state[1], p)
    return np.array([first, second])


@njit
def _jacobian(tau, state, film, p):
    return equations.jacobian(film, tau, state[0], state[1], p)


def prepare(method: str, scene: scenes.Scene, tolerance: float) -> Callable[[], tuple[np.ndarray, float]]:
    """Compile; the function returned solves once and gives the film and the CPU seconds."""
    film, p = equations.FILMS.index(scene.film), scene.parameters
    start = np.array([1.0, 0.0 if film < 2 else scenes.STEADY_ANGLE])
    _rates(0.0, start, film, p)
    options = {"rtol": tolerance, "atol": tolerance}
    if method == "Radau":
        _jacobian(0.0, start, film, p)
        options["jac"] = _jacobian

    def solve() -> tuple[np.ndarray, float]:
        begin = time.thread_time()
        run = solve_ivp(
            _rates,
            (0.0, float(scenes.PERIODS)),
            start,
            method,
            t_eval=scenes.SAMPLE_TIMES,
            args=(film, p),
            **options,
        )
        return run.y[0], time.thread_time() - begin

    return solve


IS_COMMAND = False
CONTENDERS = {
    "scipy LSODA": (functools.partial(prepare, "LSODA"), TOLERANCES),
    "scipy Radau": (functools.partial(prepare, "Radau"), TOLERANCES),
    "scipy DOP853": (functools.partial(prepare, "DOP853"), TOLERANCES),
}
