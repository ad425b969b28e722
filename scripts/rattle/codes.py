"""What columns of results hold: units, names, and what codes and flags mean that the kernels return too.

The table is the program's own: `make pages` writes quantities.csv with `rattle --quantities`.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

with Path(__file__).with_name("quantities.csv").open(newline="", encoding="ascii") as _stream:
    _TABLE = tuple(csv.DictReader(_stream))


@dataclass(frozen=True)
class Quantity:
    """One row of the table; `kind` is 'number', 'count', 'flag', 'code' or 'list'."""

    unit: str
    kind: str
    meaning: str


QUANTITIES: Mapping[str, Quantity] = MappingProxyType(
    {row["name"]: Quantity(row["unit"], row["kind"], row["meaning"]) for row in _TABLE}
)

# Columns whose numbers stand for words.
CODES: Mapping[str, Mapping[int, str]] = MappingProxyType(
    {
        row["name"]: MappingProxyType(
            {int(code): word for code, _, word in (pair.partition(" ") for pair in row["words"].split("|"))}
        )
        for row in _TABLE
        if row["kind"] == "code"
    }
)
FLAGS = tuple(row["name"] for row in _TABLE if row["kind"] == "flag")
CLASSES, FILM_REGIMES, STATUSES = (CODES[name] for name in ("rattle_class", "film_regime", "status"))
NO_OR_YES = MappingProxyType({0: "no", 1: "yes"})
UDUNITS = {"": "1", "-": "1", "m/s2": "m s-2", "m/s": "m s-1", "1/Pa": "Pa-1", "rad/s2": "rad s-2"}
WORD_ENDING = "_word"  # of columns that hold the words of a column of codes
SIDES = ("_below", "_above")  # of a threshold, behind the name of a quantity
SUCCESSES = tuple(code for code, word in STATUSES.items() if word in ("complete", "steady"))


def quantity_of(column: str) -> str:
    """The quantity that a column holds, at a side of a threshold or anywhere."""
    for side in SIDES:
        column = column.removesuffix(side)
    return column


def words_of(column: str) -> Mapping[int, str] | None:
    """The words of a column of codes or flags; None for a column of plain numbers."""
    quantity = quantity_of(column)
    return NO_OR_YES if quantity in FLAGS else CODES.get(quantity)


def word(column: str, code: float) -> str:
    """The word of one code; a code of a later program version is shown by its number.

    What is unknown is not a number in campaigns, 0 in sweeps.
    """
    words = words_of(column) or {}
    if not np.isfinite(code) or (code == 0 and 0 not in words):
        return "unknown"
    return words.get(int(code), f"{column} {int(code)}")


def spoken(name: str) -> str:
    """A word of a column, or a name, as people say it."""
    return name.replace("_", " ")


def attributes(name: str, unit: str) -> dict[str, Any]:
    """Unit, name and the meanings of codes, in the words that readers of NetCDF know."""
    found: dict[str, Any] = {"units": UDUNITS.get(unit, unit), "long_name": name.replace("_", " ")}
    words = words_of(name)
    if words:
        found["flag_values"] = np.array(list(words), dtype=float)
        found["flag_meanings"] = " ".join(word.replace(",", "").replace(" ", "_") for word in words.values())
    return found
