"""Peer diffsol: its BDF and TSIT45, equations in its own language, compiled by LLVM.

It has no functions for the loads of Reynolds films: these scenes are left out.
"""

import functools
import time
from collections.abc import Callable

import numpy as np
import pydiffsol
import scenes

VERSION = pydiffsol.diffsol_version()
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
# Loads over the steady one; the states are those of scenes.py.
LOADS = {
    "published iso_viscous": "(1.0 - c*v/sqrt(y))/y",
    "published piezo_viscous": "exp(-c*v)/(y*y*y*sqrt(y))",
}


@functools.cache
def _equations(film: str, method: pydiffsol.OdeSolverType) -> pydiffsol.Ode:
    drive = f"1.0 + q*cos({2.0 * np.pi!r}*t)"
    code = f"""
        in_i {{ a = 1.0, c = 1.0, q = 0.1 }}
        u_i {{ y = 1.0, v = 0.0 }}
        F_i {{ v, a*({LOADS[film]} - ({drive})) }}
        """
    return pydiffsol.Ode(code, ode_solver=method)


def prepare(
    method: pydiffsol.OdeSolverType, scene: scenes.Scene, tolerance: float
) -> Callable[[], tuple[np.ndarray, float]]:
    """Compile; the function returned solves once and gives the film and the CPU seconds."""
    if scene.film not in LOADS:
        raise NotImplementedError("no load of Reynolds films in its language")
    ode = _equations(scene.film, method)
    parameters = np.array(scene.parameters[:3])

    def solve() -> tuple[np.ndarray, float]:
        ode.rtol = ode.atol = tolerance
        begin = time.thread_time()
        states = ode.solve_dense(parameters, scenes.SAMPLE_TIMES).ys
        spent = time.thread_time() - begin
        return np.array(states[0]), spent

    return solve


IS_COMMAND = False
CONTENDERS = {
    "diffsol BDF": (functools.partial(prepare, pydiffsol.bdf), TOLERANCES),
    "diffsol TSIT45": (functools.partial(prepare, pydiffsol.tsit45), TOLERANCES),
}
