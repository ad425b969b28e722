"""What differs in the answers of single motions: the summaries of base and variant, quantity by quantity."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from rattle.codes import QUANTITIES, words_of
from rattle.comparison.difference import Difference
from rattle.comparison.pairs import paired
from rattle.comparison.variant import Variant

# How a quantity was found, not what it is.
EFFORT = {"window_periods", "samples_per_period", "series_coarse", "harmonics_by_integrals", "starts_solved"}
EFFORT |= {"unsettled_starts", "start_periods", "followed_periods", "batch_periods", "impact_periods"}
EFFORT |= {"periods_solved", "evaluations", "steps", "steps_cut", "iterations_per_step", "impacts_drive"}
EFFORT |= {"impacts_coast", "irregular_fraction", "floquet_modulus"}
ERROR, BOUND = "_error", "_is_bound"
UNCORRELATED, IN_PHASE, POWER = "film_force_rms_uncorrelated", "film_force_rms_in_phase", "dissipated_power"


def answer_differences(base: Variant, variant: Variant) -> Iterator[Difference]:
    """Every quantity of both summaries, pair by pair, then of all pairs together; alike or not."""
    for pair in paired(base, variant):
        one, other = pair.base.summary, pair.other.summary
        for name in QUANTITIES:
            if name in _reported(one) | _reported(other):
                yield Difference(
                    variant.name,
                    pair.gear,
                    "answer",
                    name,
                    "" if words_of(name) else QUANTITIES[name].unit,
                    *(_value(summary, name) for summary in (one, other)),
                    *(summary.get(name + ERROR) for summary in (one, other)),
                )
    if base.together is not None and variant.together is not None:
        for name, unit in ((UNCORRELATED, "N"), (IN_PHASE, "N"), (POWER, "W")):
            if name in base.together or name in variant.together:
                sides = base, variant
                yield Difference(
                    variant.name,
                    "",
                    "together",
                    name,
                    unit,
                    *((side.together or {}).get(name) for side in sides),
                    *(_error_together(side, name) for side in sides),
                )


def _reported(summary: Mapping[str, Any]) -> set[str]:
    """Names of quantities with one value each, that are no errors of others."""
    return {
        name
        for name in summary
        if name in QUANTITIES
        and QUANTITIES[name].kind != "list"
        and name not in EFFORT
        and not name.endswith((ERROR, BOUND))
    }


def _value(summary: Mapping[str, Any], name: str) -> Any:
    """The value of a quantity; one that may be larger is words, which do not differ by a number."""
    value = summary.get(name)
    if value is not None and summary.get(name + BOUND):
        return f"at least {value:.6g}"
    return value.strip() if isinstance(value, str) else value


def _error_together(side: Variant, name: str) -> float | None:
    """Error of what all pairs add up to, where each has one; of forces in phase none is known."""
    pairs = [solved.summary for solved in side.pairs.values()]
    quantity = POWER if name == POWER else "film_force_rms"
    errors = [summary[quantity + ERROR] for summary in pairs if quantity + ERROR in summary]
    total = (side.together or {}).get(name)
    if name == IN_PHASE or len(errors) < len(pairs) or not total:
        return None
    if name == POWER:
        return math.fsum(errors)
    return math.fsum(summary[quantity] * error for summary, error in zip(pairs, errors, strict=True)) / total
