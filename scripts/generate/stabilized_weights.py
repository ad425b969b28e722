"""Weights of module stabilized_series: of the terms of a Taylor series that is summed over a long step.

The terms up to order p count as they are, so the sum is exact to that order. The weights of the others make
P(x) = sum of w_k x**k/k! as bounded as a motion that comes to rest: |P| <= max(0.8, 1 + 0.8 x) from x = -S
to 0, with the largest S for which there are such weights. The error of the sum begins with (1 - w_(p+1))
times the first term that is not exact. The weights e_k of its estimate begin so too, and sum e_k x**k/k! is
as small as it can be from -S to 0: what decays within a step does not count as an error.

Both are linear programs in Chebyshev polynomials on (-S, 0).
"""

from math import factorial

import numpy as np
from numpy.polynomial import Polynomial, chebyshev
from scipy.optimize import linprog

ORDER = 14
EXACT_ORDERS = (5, 8)
DAMPED = 0.8
PLACES = -np.unique(np.concatenate([np.linspace(0.0, 1.0, 600) ** 2, np.linspace(0.0, 1.0, 1200)]))


def smallest(exact, span, bound, fixed, first=None):
    """Smallest m with |fixed + y**(exact + 1) q(y)| <= m bound at the places y = x/span.

    If `first` is given, q(0) equals it. Returns m and q by Chebyshev polynomials of 2 y + 1.
    """
    count = ORDER - exact
    powers = PLACES[:, None] ** (exact + 1) / bound[:, None]
    terms = chebyshev.chebvander(2.0 * PLACES + 1.0, count - 1) * powers
    limit = -np.ones((len(PLACES), 1))
    found = linprog(
        np.append(np.zeros(count), 1.0),
        A_ub=np.block([[terms, limit], [-terms, limit]]),
        b_ub=np.concatenate([-fixed / bound, fixed / bound]),
        A_eq=None if first is None else np.append(np.ones(count), 0.0)[None, :],
        b_eq=None if first is None else [first],
        bounds=[(None, None)] * count + [(0.0, None)],
    )
    return found.x[-1], found.x[:-1]


def weights_of(exact, span, coefficients):
    """Weights of the terms above the exact ones, from q as of `smallest`."""
    powers = chebyshev.Chebyshev(coefficients).convert(kind=Polynomial)(Polynomial([1.0, 2.0])).coef
    orders = range(exact + 1, ORDER + 1)
    return [power * factorial(k) / span**k for k, power in zip(orders, powers, strict=True)]


def weights(exact):
    """Span, weights of the sum and of its error, and the largest error that what decays counts as."""

    def sum_within(span):
        x = span * PLACES
        fixed = sum(x**k / factorial(k) for k in range(exact + 1))
        return smallest(exact, span, np.maximum(DAMPED, 1.0 + DAMPED * x), fixed)

    low, high = 0.0, 0.0
    # The exact terms alone are bounded within some short spans too.
    for high in np.geomspace(150.0, 5.0, 60):
        if sum_within(high)[0] <= 1.0:
            low, high = high, 1.07 * high
            break
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if sum_within(middle)[0] <= 1.0 else (low, middle)
    summed = weights_of(exact, low, sum_within(low)[1])
    first = (1.0 - summed[0]) * low ** (exact + 1) / factorial(exact + 1)
    largest, estimate = smallest(exact, low, np.ones(len(PLACES)), np.zeros(len(PLACES)), first)
    return low, summed, weights_of(exact, low, estimate), largest


def main():
    """Print the numbers."""
    for exact in EXACT_ORDERS:
        span, summed, estimate, largest = weights(exact)
        print(f"exact to order {exact}: span {span:.4f}, estimate of what decays at most {largest:.2f}")
        for name, row in (("weights", summed), ("estimate", estimate)):
            print(f"  {name}: " + ", ".join(f"{value:.12e}_dp" for value in row))


if __name__ == "__main__":
    main()
