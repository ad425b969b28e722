"""What a column of a result is, in the words that readers of NetCDF know."""

from __future__ import annotations

from typing import Any

import numpy as np

from rattle.codes import words_of

UDUNITS = {"": "1", "-": "1", "m/s2": "m s-2", "m/s": "m s-1", "1/Pa": "Pa-1", "rad/s2": "rad s-2"}


def attributes(name: str, unit: str) -> dict[str, Any]:
    """Unit, name and the meanings of codes."""
    found: dict[str, Any] = {"units": UDUNITS.get(unit, unit), "long_name": name.replace("_", " ")}
    words = words_of(name)
    if words:
        found["flag_values"] = np.array(list(words), dtype=float)
        found["flag_meanings"] = " ".join(word.replace(",", "").replace(" ", "_") for word in words.values())
    return found
