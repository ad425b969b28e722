"""Right-hand sides and Jacobians of the scaled scenes, compiled by numba.

Published films: states (y, v) as in scenes.py. Reynolds films: states (y, d), where d = x_e + pi/2 is the
rupture angle counted from -pi/2. The rupture condition (18) is explicit in d, so v = A(d) sqrt(y)/c
replaces v and no root is sought. With S = sin d, C = cos d, t_e = -C/S,

    A   = (S^2 J - C^2 K)/(S^6/4 - S C K)
    D   = dd/dA = S^2 (S^5/4 - C K)/(K (2 C - A S))
    y'  = A sqrt(y)/c
    d'  = D c/sqrt(y) (a (G - 1 - q cos(2 pi tau)) - A^2/(2 c^2)).

Phi is closed, Psi is integrated by parts, which removes the logarithm and the cancellation far upstream,

    Psi = integral over phi from 0 to d of N/(1 - B p*(phi)),
    N   = sin phi cos phi (cos phi + t_e sin phi) (cos phi - (t_e + A) sin phi).

The integrand has a pair of poles at distance e from the pressure peak phi_m. The substitution phi = phi_m +
e sinh s spreads them: GAUSS_POINTS points then give Psi to 2e-11 up to alpha p = 0.9.
"""

import math

import numpy as np

try:
    from numba import njit
except ImportError:  # slow, but the same numbers

    def njit(function):
        """Leave the function as it is."""
        return function


TWO_PI = 2.0 * math.pi
GAUSS_POINTS = 24
_nodes, _weights = np.polynomial.legendre.leggauss(GAUSS_POINTS)
NODES, WEIGHTS = 0.5 * (_nodes + 1.0), _weights / np.sum(_weights)

FILMS = ("published iso_viscous", "published piezo_viscous", "reynolds iso_viscous", "reynolds piezo_viscous")


@njit
def _rupture(d):
    """A(d), dd/dA, sin d, cos d, K(d)."""
    s, c = math.sin(d), math.cos(d)
    sc = s * c
    quarter = 0.5 * sc * (1.0 - 2.0 * s * s)
    j, k = 0.125 * d - 0.25 * quarter, 0.375 * d - 0.5 * sc + 0.25 * quarter
    s2 = s * s
    a = (s2 * j - c * c * k) / (0.25 * s2 * s2 * s2 - sc * k)
    slope = s2 * (0.25 * s2 * s2 * s - c * k) / (k * (2.0 * c - a * s))
    return a, slope, s, c, k


@njit
def _piezo_load(d, s, c, a, b):
    """Psi(A, B)."""
    t = -c / s
    t_sum = t + a
    peak = math.atan2(1.0, t_sum)
    s2, c2 = math.sin(2.0 * peak), math.cos(2.0 * peak)
    k = 0.375 * peak - 0.25 * s2 + 0.0625 * s2 * c2
    p = 0.125 * peak - 0.0625 * s2 * c2 - t * t * k - a * (0.0625 * (1.0 - c2) ** 2 + t * k)
    width = math.sqrt((1.0 - b * p) * 4.0 / (b * (t + t_sum) * (1.0 - c2)))
    low = math.asinh(-peak / width)
    span = math.asinh((d - peak) / width) - low
    total = 0.0
    for i in range(GAUSS_POINTS):
        grow = math.exp(low + span * NODES[i])
        shrink = 1.0 / grow
        phi = peak + 0.5 * width * (grow - shrink)
        s2, c2 = math.sin(2.0 * phi), math.cos(2.0 * phi)
        k = 0.375 * phi - 0.25 * s2 + 0.0625 * s2 * c2
        p = 0.125 * phi - 0.0625 * s2 * c2 - t * t * k - a * (0.0625 * (1.0 - c2) ** 2 + t * k)
        rise = 0.25 * s2 * (1.0 + c2 - a * s2 - t * t_sum * (1.0 - c2))
        total += WEIGHTS[i] * (grow + shrink) * rise / (1.0 - b * p)
    return 0.5 * width * span * total


@njit
def _piezo_slopes(d, s, c, a, b, slope, load):
    """dPsi/dA and dPsi/dB, by the same rule."""
    t = -c / s
    t_sum = t + a
    pull = (t + t_sum) * slope / (s * s)
    peak = math.atan2(1.0, t_sum)
    s2, c2 = math.sin(2.0 * peak), math.cos(2.0 * peak)
    k = 0.375 * peak - 0.25 * s2 + 0.0625 * s2 * c2
    p = 0.125 * peak - 0.0625 * s2 * c2 - t * t * k - a * (0.0625 * (1.0 - c2) ** 2 + t * k)
    width = math.sqrt((1.0 - b * p) * 4.0 / (b * (t + t_sum) * (1.0 - c2)))
    low = math.asinh(-peak / width)
    span = math.asinh((d - peak) / width) - low
    by_a, by_b = 0.0, 0.0
    for i in range(GAUSS_POINTS):
        grow = math.exp(low + span * NODES[i])
        shrink = 1.0 / grow
        phi = peak + 0.5 * width * (grow - shrink)
        s2, c2 = math.sin(2.0 * phi), math.cos(2.0 * phi)
        k = 0.375 * phi - 0.25 * s2 + 0.0625 * s2 * c2
        fourth = 0.0625 * (1.0 - c2) ** 2
        p = 0.125 * phi - 0.0625 * s2 * c2 - t * t * k - a * (fourth + t * k)
        weight = WEIGHTS[i] * (grow + shrink) / ((1.0 - b * p) * 0.5 * (1.0 - c2))
        by_a -= weight * (fourth + (t + pull) * k)
        by_b += weight * p
    factor = 0.5 * width * span
    return factor * by_a, (factor * by_b - load) / b


@njit
def rates(film, tau, y, v, p):
    """Derivatives of the two states; `film` is the place in FILMS, p = (a, c, q, B0, steady load)."""
    drive = 1.0 + p[2] * math.cos(TWO_PI * tau)
    root = math.sqrt(y)
    if film == 0:
        return v, p[0] * ((1.0 - p[1] * v / root) / y - drive)
    if film == 1:
        return v, p[0] * (math.exp(-p[1] * v) / (y * y * y * root) - drive)
    a, slope, s, c, _ = _rupture(v)
    load = 0.25 * s * s - 0.125 * a * (v - s * c) if film == 2 else _piezo_load(v, s, c, a, p[3] / (y * root))
    return a * root / p[1], slope * p[1] / root * (p[0] * (load / (p[4] * y) - drive) - 0.5 * (a / p[1]) ** 2)


@njit
def jacobian(film, tau, y, v, p):
    """d(y', v')/d(y, v) as a 2 x 2 array."""
    root = math.sqrt(y)
    out = np.zeros((2, 2))
    if film < 2:
        out[0, 1] = 1.0
    if film == 0:
        out[1, 0] = p[0] * (1.5 * p[1] * v / root - 1.0) / (y * y)
        out[1, 1] = -p[0] * p[1] / (y * root)
    elif film == 1:
        load = p[0] * math.exp(-p[1] * v) / (y * y * y * root)
        out[1, 0] = -3.5 * load / y
        out[1, 1] = -p[1] * load
    else:
        a, slope, s, c, k = _rupture(v)
        s2 = s * s
        if film == 2:
            load = 0.25 * s2 - 0.125 * a * (v - s * c)
            moment = 0.25 * s2 * s2
            load_by_a = -0.125 * (v - s * c) + moment * (moment - c / s * k) / k
            load_by_y = 0.0
        else:
            b = p[3] / (y * root)
            load = _piezo_load(v, s, c, a, b)
            load_by_a, load_by_b = _piezo_slopes(v, s, c, a, b, slope, load)
            load_by_y = -1.5 * b / y * load_by_b
        # slope = top/bottom, differentiated along d, where A'(d) = 1/slope and K'(d) = S^4.
        inner = 0.25 * s2 * s2 * s - c * k
        bottom = k * (2.0 * c - a * s)
        top_by_d = 2.0 * s * c * inner + s2 * (0.25 * s2 * s2 * c + s * k)
        bottom_by_d = s2 * s2 * (2.0 * c - a * s) - k * (2.0 * s + s / slope + a * c)
        slope_by_d = (top_by_d - slope * bottom_by_d) / bottom
        gain = slope * p[1] / root
        force = p[0] * (load / (p[4] * y) - 1.0 - p[2] * math.cos(TWO_PI * tau)) - 0.5 * (a / p[1]) ** 2
        out[0, 0] = 0.5 * a / (p[1] * root)
        out[0, 1] = root / (p[1] * slope)
        out[1, 0] = gain * (p[0] * (load_by_y - load / y) / (p[4] * y) - 0.5 * force / y)
        out[1, 1] = slope_by_d * gain / slope * force + gain / slope * (
            p[0] * load_by_a / (p[4] * y) - a / p[1] ** 2
        )
    return out
