"""Numbers and sentences as program and scripts print them, made anew from what they report."""

from __future__ import annotations

import math
import re
from decimal import ROUND_CEILING, Decimal

SMALLEST_PLAIN, LARGEST_PLAIN = 1e-3, 1e6  # between which a log writes no exponent
# The word of a code that people are reported in other words.
SPOKEN = {"irregular_so_far": "irregular so far"}
ANY = "*"  # in an expected text: what no file tells, as the time that something took


def short(number: float, digits: int) -> str:
    """A number as logs write it, with so many significant digits."""
    if number == 0.0:
        return "0"
    if SMALLEST_PLAIN <= abs(number) < LARGEST_PLAIN:
        decimals = max(0, digits - 1 - math.floor(math.log10(abs(number))))
        return f"{number:.{decimals}f}"
    mantissa, exponent = f"{number:.{digits - 1}E}".split("E")
    return f"{mantissa}{'' if '.' in mantissa else '.0'}E{int(exponent)}"


def stated_error(error: float, number: float, digits: int) -> float:
    """An error of two digits, rounded up, and not below half a unit of the last digit of its number."""
    bound = Decimal(repr(float(error)))
    if number:
        bound = max(bound, Decimal(5).scaleb(Decimal(repr(abs(float(number)))).adjusted() - digits))
    if not bound:
        return 0.0
    return float(bound.quantize(Decimal(1).scaleb(bound.adjusted() - 1), rounding=ROUND_CEILING))


def counted(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


def assert_reported(found: list[str], expected: list[str | None]) -> None:
    """Text by text the same; None stands for what is left out this time, `ANY` for a number of any value."""
    wanted = [text for text in expected if text is not None]
    for place, (one, other) in enumerate(zip(found, wanted, strict=False)):
        form = re.escape(other).replace(re.escape(ANY), r"[-+\d.E]+")
        assert re.fullmatch(form, one), f"line {place + 1}\nfound    {one}\nexpected {other}"
    assert len(found) == len(wanted), (found[len(wanted) :], wanted[len(found) :])
