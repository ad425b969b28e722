"""Which gear pair of a variant stands beside which of the base."""

from __future__ import annotations

from dataclasses import dataclass

from rattle.comparison.variant import Variant
from rattle.solve import Solved


@dataclass(frozen=True)
class Pair:
    """What was solved of one gear pair, of the base and of a variant."""

    gear: str
    base: Solved
    other: Solved


def paired(base: Variant, variant: Variant) -> list[Pair]:
    """The gear pairs that both have, by name, in the order of the base; single pairs whatever their names."""
    if len(base.pairs) == len(variant.pairs) == 1:
        (gear, one), (_, other) = *base.pairs.items(), *variant.pairs.items()
        return [Pair(gear, one, other)]
    return [
        Pair(gear, solved, variant.pairs[gear])
        for gear, solved in base.pairs.items()
        if gear in variant.pairs
    ]


def unpaired(base: Variant, variant: Variant) -> list[str]:
    """A sentence for each side on the gear pairs that the other does not have."""
    both = {pair.gear for pair in paired(base, variant)}
    if both and len(base.pairs) == len(variant.pairs) == 1:
        return []
    return [
        f"{side.name} alone has {', '.join(alone)}"
        for side in (base, variant)
        if (alone := [gear for gear in side.pairs if gear not in both])
    ]
