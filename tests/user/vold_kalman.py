"""A Vold-Kalman filter of the second generation with two poles: an independent tracker of orders.

Vold, Leuridan 1993; the weight for a bandwidth is that of Tuma 2005.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy import linalg


def vold_kalman(values: np.ndarray, phases: Sequence[np.ndarray], bandwidth: float) -> np.ndarray:
    """Complex amplitudes of sines of the phases [rad], a column each, and of a mean beside them.

    `values` are equally spaced, `bandwidth` (at -3 dB) is in cycles a sample. The second differences of the
    amplitudes are least, beside what the sum of the sines is off the values.
    """
    shapes = [np.ones(len(values))]
    for phase in phases:
        shapes += [np.cos(phase), -np.sin(phase)]
    count, size = len(shapes), len(values)
    angle = math.pi * bandwidth
    weight = (math.sqrt(2.0) - 1.0) / (6.0 - 8.0 * math.cos(angle) + 2.0 * math.cos(2.0 * angle))
    weights = np.full(count, 0.5 * weight)
    weights[0] = weight
    bands = np.zeros((2 * count + 1, size * count))
    for i in range(count):
        for j in range(i + 1):
            bands[i - j, j::count] += shapes[i] * shapes[j]
    difference = (1.0, -2.0, 1.0)
    for later in range(3):
        for earlier in range(later + 1):
            product = difference[later] * difference[earlier] * weights
            rows = bands[(later - earlier) * count].reshape(size, count)
            rows[earlier : size - 2 + earlier] += product
    right = (np.array(shapes) * values).T.ravel()
    found = linalg.solveh_banded(bands, right, lower=True).reshape(size, count)
    return found[:, 1::2] + 1j * found[:, 2::2]
