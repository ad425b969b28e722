"""The class of a motion, judged by the Fortran kernel from a result file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rattle.result import Result

THRESHOLDS = ("line_threshold", "idle_lines", "quiet_limit", "irregular_limit")


def thresholds(result: Result, overrides: Mapping[str, float | None] | None = None) -> dict[str, float]:
    """Thresholds of the resolved input, replaced where an override is not None."""
    given = {name: value for name, value in (overrides or {}).items() if value is not None}
    return {name: given[name] if name in given else result.number("spectrum", name) for name in THRESHOLDS}


def classify(
    result: Result,
    periods: int | None = None,
    overrides: Mapping[str, float | None] | None = None,
) -> dict[str, Any]:
    """Class and measures of the last `periods`, by default those of the &spectrum group."""
    from rattle import kernels

    samples = result.samples("acceleration", result.window(periods))
    return kernels.classify(samples, result.samples_per_period, **thresholds(result, overrides))
