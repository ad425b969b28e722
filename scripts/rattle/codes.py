"""What the codes mean that stand in columns of results and that the kernels return."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

CLASSES = MappingProxyType({1: "quiet", 2: "creep", 3: "idle", 4: "irregular", 5: "subharmonic"})
FILM_REGIMES = MappingProxyType({0: "unknown", 1: "iso-viscous", 2: "piezo-viscous", 3: "elastohydrodynamic"})
STATUSES = MappingProxyType(
    {
        0: "complete",
        1: "steady",
        2: "not_converged",
        3: "film_lost",
        4: "no_rigid_film",
        5: "overflow",
        6: "interrupted",
        7: "time_limit",
        8: "not_written",
        9: "invalid",
    }
)
MODEL_LIMITS = MappingProxyType({0: "within", 1: "too_wide", 2: "too_narrow", 3: "too_wide_and_narrow"})
NO_OR_YES = MappingProxyType({0: "no", 1: "yes"})
SUCCESSES = (0, 1)

# Columns whose numbers stand for words.
CODES: Mapping[str, Mapping[int, str]] = MappingProxyType(
    {"rattle_class": CLASSES, "film_regime": FILM_REGIMES, "status": STATUSES, "model_limit": MODEL_LIMITS}
)
FLAGS = ("law_contradicted", "certified", "sampling_sufficient", "line_count_is_bound")


def words_of(column: str) -> Mapping[int, str] | None:
    """The words of a column of codes or flags; None for a column of plain numbers."""
    return NO_OR_YES if column in FLAGS else CODES.get(column)


def word(column: str, code: float) -> str:
    """The word of one code; a code of a later program version is shown by its number."""
    if not np.isfinite(code):
        return "unknown"
    return (words_of(column) or {}).get(int(code), f"{column} {int(code)}")
