"""The class of a motion, judged by the Fortran kernel from a result file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from rattle.result import Result, ResultError

LIMITS = ("harmonic_threshold", "quiet_limit", "irregular_limit")
THRESHOLDS = (*LIMITS, "idle_harmonics")


def thresholds(result: Result, overrides: Mapping[str, float | None] | None = None) -> dict[str, float]:
    """Thresholds of the resolved input, replaced where an override is not None."""
    given = {name: value for name, value in (overrides or {}).items() if value is not None}
    own = {name: float(result.number("spectrum", name)) for name in LIMITS if name not in given}
    if "idle_harmonics" not in given:
        own["idle_harmonics"] = result.positive_integer("spectrum", "idle_harmonics")
    return own | given


def classify(
    result: Result,
    periods: int | None = None,
    overrides: Mapping[str, float | None] | None = None,
) -> dict[str, Any]:
    """Class and measures of the last `periods`, by default those that the program judged.

    Raises ResultError where the samples carry no class.
    """
    result.require_task("motion")
    if result.coarse:
        raise ResultError(
            f"{result.path} is coarser than its motion: its samples carry no class. "
            "What is known of its class is verified in the summary."
        )
    return judge_samples(result, periods, overrides)


def judge_samples(
    result: Result,
    periods: int | None = None,
    overrides: Mapping[str, float | None] | None = None,
) -> dict[str, Any]:
    """Class and measures of the samples as they stand, whether they follow the motion or not."""
    from rattle import kernels

    samples = result.samples("acceleration", result.window(periods))
    limits: dict[str, Any] = {**forced(result), **thresholds(result, overrides)}
    try:
        found = kernels.classify(
            samples,
            result.samples_per_period,
            orbit_period=result.orbit_period,
            **limits,
        )
        # Samples alone do not show whether neighbouring motions diverge; the program has followed them.
        if found["rattle_class"] == "irregular_so_far" and result.is_irregular:
            found["rattle_class"] = "irregular"
        return found
    except ValueError as fault:
        raise ResultError(f"{result.path} cannot be classified: {fault}.") from None


def forced(result: Result) -> dict[str, Any]:
    """Harmonics of the force and their amplitudes, where it has several."""
    load = result.input.get("load", {})
    if not load.get("force_orders"):
        return {}
    orders = [int(order) for order in np.atleast_1d(load["force_orders"])]
    return {"force_orders": orders, "force_amplitudes": np.atleast_1d(load["force_amplitudes"])}
