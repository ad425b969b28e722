"""Peer numbalsoda: LSODA and DOP853 in compiled code, right-hand sides as numba C functions."""

import functools
import time
from collections.abc import Callable
from importlib.metadata import version

import equations
import numba as nb
import numbalsoda
import numpy as np
import scenes

VERSION = version("numbalsoda")
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13)


@functools.cache
def _function(film: int):
    @nb.cfunc(numbalsoda.lsoda_sig)
    def rates(tau, state, slope, data):
        slope[0], slope[1] = equations.rates(film, tau, state[0], state[1], nb.carray(data, (5,)))

    return rates


def prepare(
    solver: Callable, limit: dict, scene: scenes.Scene, tolerance: float
) -> Callable[[], tuple[np.ndarray, float]]:
    """Compile; the function returned solves once and gives the film and the CPU seconds."""
    film, p = equations.FILMS.index(scene.film), scene.parameters
    address = _function(film).address
    start = np.array([1.0, 0.0 if film < 2 else scenes.STEADY_ANGLE])
    times = np.concatenate(([0.0], scenes.SAMPLE_TIMES))

    def solve() -> tuple[np.ndarray, float]:
        begin = time.thread_time()
        states, success = solver(address, start, times, data=p, rtol=tolerance, atol=tolerance, **limit)
        spent = time.thread_time() - begin
        return (states[1:, 0] if success else np.full(scenes.SAMPLE_COUNT, np.nan)), spent

    return solve


IS_COMMAND = False
CONTENDERS = {
    "numbalsoda LSODA": (functools.partial(prepare, numbalsoda.lsoda, {"mxstep": 10**7}), TOLERANCES),
    "numbalsoda DOP853": (functools.partial(prepare, numbalsoda.dop853, {"mxstep": 10**7}), TOLERANCES),
}
