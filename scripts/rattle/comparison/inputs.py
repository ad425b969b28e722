"""What differs in the inputs of variants, and in what follows from them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from rattle.campaign_plan import GEAR
from rattle.comparison.difference import Difference
from rattle.comparison.pairs import paired
from rattle.comparison.variant import Variant
from rattle.keys import key_table
from rattle.result_file import ResultFile

# Keys that say where files go and what they are called, not what is solved.
NO_INPUT = {("scene", "name"), (GEAR, "name"), ("output", "directory"), ("output", "overwrite")}
NO_INPUT |= {("campaign", "part"), ("campaign", "parts")}


def input_differences(base: Variant, variant: Variant) -> list[Difference]:
    """Keys of the resolved inputs, and what follows from them, that differ; what all pairs share once."""
    found: list[Difference] = []
    pairs = [pair for pair in paired(base, variant) if None not in (pair.base.result, pair.other.result)]
    for pair in pairs:
        first, second = pair.base.result, pair.other.result
        assert first is not None and second is not None
        one, other = _values(first), _values(second)
        units = {**_units(first), **_units(second)}
        for key in {**one, **other}:
            part = "follows" if key in units else "input"
            unit = units.get(key) or _unit(key)
            entry = Difference(
                variant.name, pair.gear, part, ".".join(key), unit, one.get(key), other.get(key)
            )
            if not entry.same:
                found.append(entry)
    return list(_once(found, [pair.gear for pair in pairs]))


def tables_named(variants: Sequence[Variant]) -> list[str]:
    """CSV files that the inputs name: their contents are not compared."""
    values = (
        value
        for variant in variants
        for result in variant.results
        for key, value in _values(result).items()
        if isinstance(value, str) and value.strip().lower().endswith(".csv")
    )
    return sorted({value.strip() for value in values})


def _values(result: ResultFile) -> dict[tuple[str, str], Any]:
    """Keys with their values; groups of one name as gear(1), gear(2) by the names of the gears."""
    several = f"{GEAR}(2)" in result.input
    found = {}
    for group, keys in result.input.items():
        known = group.partition("(")[0]
        name = f"{GEAR} {str(keys['name']).strip()}" if several and known == GEAR else group
        found.update({(name, key): value for key, value in keys.items() if (known, key) not in NO_INPUT})
    return found


def _units(result: ResultFile) -> dict[tuple[str, str], str]:
    """Units of what follows from the input."""
    return result.derived_units if result.task == "motion" else {}


def _unit(key: tuple[str, str]) -> str:
    known = key_table().get((key[0].partition(" ")[0].partition("(")[0], key[1]))
    return known.unit if known else ""


def _once(entries: Sequence[Difference], gears: Sequence[str]) -> Iterator[Difference]:
    """Entries that are the same for all pairs only once, of no gear."""
    of_key: dict[str, list[Difference]] = {}
    for entry in entries:
        of_key.setdefault(entry.name, []).append(entry)
    for same in of_key.values():
        first = same[0]
        values = [(entry.base, entry.value) for entry in same]
        if len(same) == len(gears) and all(value == values[0] for value in values):
            yield Difference(first.variant, "", first.part, first.name, first.unit, first.base, first.value)
        else:
            yield from same
