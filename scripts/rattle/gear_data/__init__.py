"""Gear data as engineers have them, tables of drawing data and REXS files, as &gear, &shaft and &oil."""

from __future__ import annotations

import re
from dataclasses import dataclass

from rattle.command import CommandError

GROUPS = ("gear", "shaft", "oil")


class GearDataError(CommandError):
    """Data that cannot be used; each line names its place."""


@dataclass(frozen=True)
class Given:
    """A value of one key, in the unit of the key, with what stands in the file and where."""

    pair: str
    """Name of the gear pair; empty for shaft and oil, and where a file has one pair without a name."""
    group: str
    key: str
    value: float | int | str | tuple[float, ...]
    place: str
    words: str

    @property
    def number(self) -> float:
        """The value of a key that is a number."""
        if not isinstance(self.value, int | float):
            raise TypeError(f"{self.words} is no number")
        return float(self.value)


def pair_name(text: str) -> str:
    """A name as the program takes it for a pair: letters, digits, dots and dashes, else underscores."""
    return re.sub(r"[^A-Za-z0-9._-]+", "_", text).strip("_")
