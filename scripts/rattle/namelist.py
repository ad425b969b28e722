"""Namelist text as Python values."""

from __future__ import annotations

from collections import Counter
from typing import Any

import f90nml


class NamelistError(Exception):
    """Namelist text that cannot be parsed."""


def parse(text: str) -> dict[str, dict[str, Any]]:
    """Parse namelist text into group, key, value; groups of one name are NAME, NAME(2), NAME(3) and so on."""
    groups: dict[str, dict[str, Any]] = {}
    seen: Counter[str] = Counter()
    for name, group in parse_groups(text).items():
        seen[name] += 1
        groups[name if seen[name] == 1 else f"{name}({seen[name]})"] = dict(group)
    return groups


def parse_groups(text: str) -> f90nml.Namelist:
    """Parse namelist text into groups that also know where their arrays start, and can be written."""
    try:
        groups = f90nml.Parser().reads(text)
        for group in groups.values():
            dict(group)  # what is no mapping of keys fails here
        return groups
    except Exception as fault:  # the parser shows damaged text by exceptions of many types
        detail = str(fault).splitlines()[0].rstrip(".") if str(fault) else type(fault).__name__
        raise NamelistError(f"it is not a namelist ({detail}).") from fault
