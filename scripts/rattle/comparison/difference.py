"""A value of the base beside that of a variant, and what the difference between them is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from rattle.rounding import stated_error

# Significant digits of numbers: what differs beyond them is none that is reported.
DIGITS = 6
# Units of amplitudes, of which a factor of 10 is 20 dB, and of powers, of which it is 10 dB.
AMPLITUDES = ("N", "m/s2", "rad/s2", "m/s", "N s")
POWERS = ("W", "J")
# Units whose zero is a convention: half of 60 degC is not 30 degC.
WITHOUT_RATIO = ("degC", "deg", "rad")
NONE, WITHIN = "none", "none within the errors"


@dataclass(frozen=True)
class Difference:
    """One key or quantity of a variant beside that of the base.

    `part` is 'input', 'follows' (from the input), 'answer' or 'together' (all gear pairs); `gear` is empty
    where it is of all pairs alike. A value is None where that side has none. Errors are those that the
    program states; None of a number in an answer: none is stated, its digits are all that is known.
    """

    variant: str
    gear: str
    part: str
    name: str
    unit: str
    base: Any
    value: Any
    base_error: float | None = None
    error: float | None = None

    @property
    def change(self) -> float | None:
        """Value less base, of numbers."""
        return float(self.value) - float(self.base) if _numbers(self.base, self.value) else None

    @property
    def margin(self) -> float:
        """By how much two numbers may differ that are the same: the sum of both errors as reported."""
        if self.part in ("input", "follows") or self.change is None:
            return 0.0
        return reported_error(self.base_error, self.base) + reported_error(self.error, self.value)

    @property
    def same(self) -> bool:
        """Whether there is no difference, or none beyond the errors."""
        if self.change is None:
            return _plain(self.base) == _plain(self.value)
        return not abs(self.change) > self.margin

    @property
    def words(self) -> str:
        """'none', 'none within the errors', or nothing where the two differ."""
        if not self.same:
            return ""
        return WITHIN if self.change else NONE

    @property
    def percent(self) -> float | None:
        """Change in percent of the base, by size: a drop is negative; None without one, or of other signs."""
        if self.change is None or self.unit in WITHOUT_RATIO:
            return None
        if float(self.base) == 0.0 or float(self.base) * float(self.value) < 0.0:
            return None
        return 100.0 * self.change / float(self.base)

    @property
    def decibel(self) -> float | None:
        """Level of the value against the base [dB], of amplitudes and powers of one sign."""
        return level(self.base, self.value, self.unit) if self.change is not None else None


def level(base: float, value: float, unit: str) -> float | None:
    """Level of a value against its base [dB]; None of other units, of different signs and of 0."""
    factor = 20.0 if unit in AMPLITUDES else 10.0 if unit in POWERS else None
    if factor is None or not float(base) * float(value) > 0.0:
        return None
    return factor * math.log10(float(value) / float(base))


def reported_error(error: float | None, number: float) -> float:
    """The error of a number as it is reported, never below half a unit of its last digit."""
    return stated_error(float(error or 0.0), float(number), DIGITS)


def _numbers(*values: Any) -> bool:
    return all(isinstance(value, int | float) and not isinstance(value, bool) for value in values)


def _plain(value: Any) -> Any:
    """A value as it is compared: words without blanks behind them."""
    return value.strip() if isinstance(value, str) else value
