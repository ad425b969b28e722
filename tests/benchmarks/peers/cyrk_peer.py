"""Peer CyRK: its C++ solvers of high order, called from Python, right-hand sides as numba C functions."""

import functools
import time
from collections.abc import Callable
from importlib.metadata import version

import equations
import numpy as np
import scenes
from CyRK import nb_diffeq_addr, nbsolve2_ivp

VERSION = version("CyRK")
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)


@functools.cache
def _address(film: int) -> int:
    def rates(slope, tau, state, p):
        slope[0], slope[1] = equations.rates(film, tau, state[0], state[1], p)

    return nb_diffeq_addr(rates)


def prepare(method: str, scene: scenes.Scene, tolerance: float) -> Callable[[], tuple[np.ndarray, float]]:
    """Compile; the function returned solves once and gives the film and the CPU seconds."""
    film = equations.FILMS.index(scene.film)
    address = _address(film)
    start = np.array([1.0, 0.0 if film < 2 else scenes.STEADY_ANGLE])
    span = (0.0, float(scenes.PERIODS))
    options = {"method": method, "t_eval": scenes.SAMPLE_TIMES, "args": scene.parameters}

    def solve() -> tuple[np.ndarray, float]:
        begin = time.thread_time()
        found = nbsolve2_ivp(address, span, start, rtol=tolerance, atol=tolerance, **options)
        spent = time.thread_time() - begin
        film = np.array(found.y[0]) if found.success else np.full(scenes.SAMPLE_COUNT, np.nan)
        found.free()
        return film, spent

    solve()  # compiles
    return solve


IS_COMMAND = False
CONTENDERS = {
    f"CyRK {method}": (functools.partial(prepare, method), TOLERANCES) for method in ("Vern8", "RADAU")
}
