"""Values with units as people write them, in the unit that a key has."""

from __future__ import annotations

import re
from collections.abc import Callable

from rattle.csv_table import conversion
from rattle.gear_data import GearDataError
from rattle.keys import Key

_NUMBER = r"[-+]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][-+]?\d+)?"
# Several stand behind one another; in 800 1/min the 1 belongs to the unit.
_NUMBERS = re.compile(rf"({_NUMBER}(?:(?:\s*;\s*|,?\s+)(?!1\s*/){_NUMBER})*)\s*(.*)", re.DOTALL)
_THOUSANDS = re.compile(r"(?<![\d.,])[1-9]\d{0,2},\d{3}(?!\d)")
_BEHIND = re.compile(r"(.*?\S)\s*(?:\[([^][]+)\]|\((.+)\))\s*")


def name_and_unit(head: str, unit_of: Callable[[str], str | None]) -> tuple[str, str]:
    """A name, and the unit in brackets behind it; brackets that hold something else belong to the name.

    `unit_of` says which unit the key of a name has; None of a name that is not known.
    """
    found = _BEHIND.fullmatch(head.strip())
    needed = unit_of(found[1]) if found else None
    if found and needed is not None:
        unit = (found[2] or found[3]).strip()
        if unit_of(head) is None or not conversion(unit, needed)[2]:
            return found[1], unit
    return head.strip(), ""


def value_of(text: str, unit: str, key: Key) -> float | int | str | tuple[float, ...]:
    """What a cell says, in the unit of its key; `unit` is what stands beside it, or nothing.

    Raises GearDataError, in words without a place.
    """
    if not key.unit:
        return text.strip().strip("'\"")
    found = _NUMBERS.fullmatch(text.strip())
    if found is None:
        raise GearDataError(f"'{text.strip()}' is no number with a unit")
    if _THOUSANDS.search(found[1]):
        raise GearDataError(f"'{text.strip()}' may mean thousands or a decimal comma; write a decimal point")
    inside = found[2].strip().strip("[]").strip()
    if inside and unit and inside != unit:
        raise GearDataError(f"'{text.strip()}' has the unit {inside}, but {unit} stands beside it")
    numbers = [float(number.replace(",", ".")) for number in re.findall(_NUMBER, found[1])]
    factor, added = _conversion(inside or unit, key.unit)
    values = tuple(_rounded(number * factor + added) for number in numbers)
    if key.allowed.startswith("numbers"):
        return values
    if len(values) > 1:
        raise GearDataError(f"'{text.strip()}' has {len(values)} numbers, where one is needed")
    if key.allowed.startswith("an integer") and values[0].is_integer():
        return int(values[0])
    return values[0]


def _conversion(unit: str, needed: str) -> tuple[float, float]:
    if not unit and needed != "-":
        raise GearDataError(f"it has no unit; one such as {needed} is needed")
    if not unit:
        return 1.0, 0.0
    factor, added, fault = conversion(unit, needed)
    if fault:
        raise GearDataError(f"unit {unit}: {fault}")
    return factor, added


def _rounded(value: float) -> float:
    """Without the last digit, which the conversion of decimal numbers leaves behind."""
    return float(f"{value:.15g}")
