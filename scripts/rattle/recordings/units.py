"""Units of channels as benches write them, and their conversion by pint."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import numpy as np

from rattle.recordings.faults import MissingLibrary, RecordingError, library

# What heads of files hold of units, without asking pint; sizes of an angular speed are named by full turns.
_WORDS = """
s ms us ns min h deg rad rev 1/min 1/s 1/s2 rpm U/min Hz kHz m/s m/s2 mm/s2 km/h g mg N mN kN MN
Nm mNm kNm N*m rad/s rad/s2 deg/s deg/s2 rev/s rev/s2 rev/min V mV uV A mA degC K % - 1 Pa kPa MPa bar mbar
m mm um nm kg W kW J l/h l/min
"""
KNOWN = frozenset(_WORDS.split())
SAME = {
    "sec": "s",
    "secs": "s",
    "seconds": "s",
    "second": "s",
    "sek": "s",
    "msec": "ms",
    "usec": "us",
    "degree": "deg",
    "degrees": "deg",
    "degca": "deg",
    "degcrk": "deg",
    "cad": "deg",
    "grad": "deg",
    "radian": "rad",
    "radians": "rad",
    "turn": "rev",
    "turns": "rev",
    "revolution": "rev",
    "revolutions": "rev",
    "rpm": "rpm",
    "u/min": "rpm",
    "1/min": "rpm",
    "min-1": "rpm",
    "min^-1": "rpm",
    "/min": "rpm",
    "rev/min": "rpm",
    "r/min": "rpm",
    "upm": "rpm",
    "nm": "Nm",
    "n.m": "Nm",
    "g_n": "g",
    "gn": "g",
    "hz": "Hz",
    "khz": "kHz",
}
# Words that a pint unit must be spelt by, where what is converted to is a speed of rotation or an
# acceleration.
ROTATING = {
    "Hz": "revolution/s",
    "kHz": "1000*revolution/s",
    "1/s": "revolution/s",
    "rpm": "revolution/minute",
}
ROTATING |= {"1/s2": "revolution/s**2", "rev/s": "revolution/s", "rev/s2": "revolution/s**2"}
PINT = {
    "Nm": "N*m",
    "mNm": "mN*m",
    "kNm": "kN*m",
    "rev": "revolution",
    "g": "standard_gravity",
    "%": "percent",
}
PINT |= {
    "mg": "0.001*standard_gravity",
    "l/h": "liter/hour",
    "l/min": "liter/minute",
    "degC": "degC",
    "-": "",
}


def plain(text: str) -> str:
    """A unit as this package writes it: `m/s^2`, `m/s**2` and the raised two become m/s2, 1/min rpm."""
    word = text.strip().strip("[]() \t")
    for sign, letters in (
        ("\N{DEGREE SIGN}C", "degC"),
        ("\N{DEGREE SIGN}", "deg"),
        ("\N{MICRO SIGN}", "u"),
        ("\N{GREEK SMALL LETTER MU}", "u"),
        ("\N{SUPERSCRIPT TWO}", "2"),
        ("\N{SUPERSCRIPT MINUS}\N{SUPERSCRIPT ONE}", "-1"),
        ("\N{MIDDLE DOT}", "*"),
        ("\N{DOT OPERATOR}", "*"),
    ):
        word = word.replace(sign, letters)
    word = re.sub(r"\s*([*/^])\s*", r"\1", word)
    word = re.sub(r"(\^|\*\*)2\b", "2", word)
    if re.fullmatch(r"[mkM]?N[ *.]m", word):
        word = word[:-2] + "m"
    if word in KNOWN:
        return "rpm" if word in ("1/min", "U/min", "rev/min") else word
    return SAME.get(word.lower(), word)


def shown(unit: str) -> str:
    """A unit as the rest of the program writes it."""
    return "1/min" if unit == "rpm" else unit


def is_known(text: str) -> bool:
    """Whether a cell of a head may be a unit; an empty one is none."""
    word = plain(text)
    return bool(word) and (word in KNOWN or word in PINT)


@cache
def _registry() -> Any:
    registry = library("pint").UnitRegistry()
    registry.define("percent = 0.01")
    return registry


def factor(unit: str, target: str, name: str = "the channel") -> float:
    """By what values in `unit` are multiplied to be in `target`.

    A frequency as a speed of rotation counts turns: 1 Hz is 60 rpm. `g` is an acceleration, never a gram.
    """
    unit, target = plain(unit), plain(target)
    if not unit:
        raise RecordingError(
            f"'{name}' has no unit in its file; give it by --unit '{name}={target}', or with another unit."
        )
    if unit == target:
        return 1.0
    try:
        ratio = (_parsed(unit) / _parsed(target)).to_base_units()
    except RecordingError:
        raise
    except Exception:  # pint has a class for each way in which a text is no unit
        raise RecordingError(
            f"'{name}' is in '{unit}', which is not known; --unit '{name}={target}', say."
        ) from None
    if not ratio.dimensionless or _turns(unit) != _turns(target):
        raise RecordingError(f"'{name}' is in {unit}, which is no {target}.")
    return float(ratio.magnitude)


def _parsed(unit: str) -> Any:
    spelt = ROTATING.get(unit) or PINT.get(unit) or re.sub(r"(?<=[A-Za-z])2\b", "**2", unit)
    return _registry().Quantity(1.0, _registry().parse_units("")) * _registry().parse_expression(spelt)


def _turns(unit: str) -> bool:
    """Whether a unit counts turns or angles: to pint these are plain numbers."""
    return unit in ROTATING or re.search(r"(^|[*/ ])[mkuM]?(rad|deg(?!C)|rev|rpm|turn|arc)", unit) is not None


def convert(values: np.ndarray, unit: str, target: str, name: str = "the channel") -> np.ndarray:
    """The values in another unit."""
    return values * factor(unit, target, name)


def fits(unit: str, target: str) -> bool:
    """Whether one unit can become another."""
    try:
        factor(unit, target)
    except MissingLibrary:
        raise
    except RecordingError:
        return False
    return True
