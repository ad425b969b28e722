"""Errors of numbers, as far as the digits of the numbers that they belong to show them."""

from __future__ import annotations

import math

ERROR_DIGITS = 2
# Of a unit of the last digit: less than this is rounding of binary numbers.
ROUNDING_SHARE = 1e-9


def last_place(number: float, digits: int) -> float:
    """A unit of the last of so many significant digits; 0 of a number that has none."""
    if number == 0.0 or not math.isfinite(number):
        return 0.0
    return 10.0 ** (math.floor(math.log10(abs(number))) - digits + 1)


def stated_error(error: float, number: float, digits: int) -> float:
    """The error of a number reported with so many digits, itself with two of them.

    The bound is rounded up, and never below half a unit of the last digit of the number; a relative error
    belongs to 1.
    """
    bound = max(error, 0.5 * last_place(number, digits))
    unit = last_place(bound, ERROR_DIGITS)
    if unit == 0.0:
        return bound
    return float(f"{math.ceil(bound / unit - ROUNDING_SHARE)}e{round(math.log10(unit))}")
