"""Find REYNOLDS_ALPHA of ../peers/scenes.py: alpha for which the largest alpha p of the run is 0.9.

Command: python tests/benchmarks/reference/find_alpha.py   (numpy, scipy, numba; about a minute)
"""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "peers"))

import equations
import scenes

TARGET = 0.9


def peak_group(d: np.ndarray) -> np.ndarray:
    """Largest p* as a function of the rupture angle d = x_e + pi/2; p* = 0 at d gives A."""
    s, c = np.sin(d), np.cos(d)
    j, k = d / 8 - np.sin(4 * d) / 32, 3 * d / 8 - np.sin(2 * d) / 4 + np.sin(4 * d) / 32
    a, t = (s * s * j - c * c * k) / (s**6 / 4 - s * c * k), -c / s
    phi = np.arctan2(1.0, t + a)
    j, k = phi / 8 - np.sin(4 * phi) / 32, 3 * phi / 8 - np.sin(2 * phi) / 4 + np.sin(4 * phi) / 32
    return j - t * t * k - a * (np.sin(phi) ** 4 / 4 + t * k)


def largest_alpha_p(factor: float, alpha: float, periods: int) -> float:
    """Largest alpha p = B max p* over the run; 2 where the piezo-viscous film ceases to exist."""
    scene = scenes.make_scene("reynolds", "piezo_viscous", factor, alpha)
    if scene.pressure_scale * peak_group(np.array(scenes.STEADY_ANGLE)) >= 1.0:
        return 2.0
    p = scene.parameters

    def group(state):
        return p[3] * state[0] ** -1.5 * peak_group(state[1])

    def breakdown(_, state):
        return float(group(state)) - 0.98

    breakdown.terminal = True
    run = solve_ivp(
        lambda tau, u: equations.rates(3, tau, u[0], u[1], p), (0.0, periods), [1.0, scenes.STEADY_ANGLE],
        method="DOP853", rtol=1e-11, atol=1e-11, dense_output=True, events=breakdown,
    )  # fmt: skip
    if run.status != 0:
        return 2.0
    tau = np.linspace(0.0, periods, 400 * periods + 1)
    values = group(run.sol(tau))
    at = int(np.clip(np.argmax(values), 1, len(values) - 2))
    before, top, after = values[at - 1 : at + 2]
    return float(top + 0.125 * (after - before) ** 2 / max(2 * top - before - after, 1e-300))


if __name__ == "__main__":
    for load_factor in scenes.FORCE_FACTORS:
        found = brentq(lambda a, f=load_factor: largest_alpha_p(f, a, 30) - TARGET, 1e-10, 1.6e-8, xtol=1e-16)
        rounded = float(f"{found:.6e}")
        reached = largest_alpha_p(load_factor, rounded, scenes.PERIODS)
        print(f"F0 = {load_factor:g} Q: alpha = {rounded:.6e} 1/Pa, largest alpha p {reached:.9f}")
        if not math.isclose(reached, TARGET, abs_tol=1e-5):
            sys.exit("the largest alpha p is not reached in the first 30 periods")
