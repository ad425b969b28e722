"""Campaigns, sweeps and thresholds side by side: rows of base and variant at the same values of keys."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rattle.campaign_plan import GEAR
from rattle.campaign_result import Campaign
from rattle.codes import QUANTITIES, SUCCESSES, quantity_of, spoken, word, words_of
from rattle.command import CommandError
from rattle.comparison.answers import EFFORT
from rattle.comparison.difference import DIGITS, level
from rattle.comparison.variant import Variant
from rattle.result import Result
from rattle.result_file import ResultFile
from rattle.run_up import ways
from rattle.thresholds import thresholds

ERROR = "_error"
# Digits to which values of keys agree that are the same: two ways to a point of a grid differ in the last.
KEY_DIGITS = 10
THRESHOLD, KIND, CROSSING = "threshold", "kind", "crossing"


@dataclass(frozen=True)
class Table:
    """Rows of one result: its keys, and what was found there.

    Columns of words are arrays of objects; numbers of scenes that failed are not a number.
    """

    name: str
    keys: Mapping[str, np.ndarray]
    columns: Mapping[str, np.ndarray]
    units: Mapping[str, str]

    @cached_property
    def places(self) -> dict[tuple[str, ...], int]:
        """The row of each set of values of the keys."""
        columns = [[_key_words(value) for value in values] for values in self.keys.values()]
        return {values: place for place, values in enumerate(zip(*columns, strict=True))}


@dataclass(frozen=True)
class Compared:
    """Two tables at the values of the keys that both have; `rows` of the base and of the variant."""

    base: Table
    other: Table
    rows: tuple[np.ndarray, np.ndarray]

    @property
    def quantities(self) -> list[str]:
        """What both recorded, without errors of others."""
        return [name for name in self.base.columns if name in self.other.columns and not name.endswith(ERROR)]

    def values(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """A quantity of the base and of the variant, row by row."""
        return self.base.columns[name][self.rows[0]], self.other.columns[name][self.rows[1]]

    def is_word(self, name: str) -> bool:
        return self.base.columns[name].dtype == object

    def differs(self, name: str) -> np.ndarray:
        """Where a quantity differs beyond the errors recorded, or, without any, beyond the digits reported.

        Nothing is said to differ where a side has no number.
        """
        one, other = self.values(name)
        if self.is_word(name):
            return one != other
        with np.errstate(invalid="ignore"):
            return np.abs(other - one) > self._margin(name, 0) + self._margin(name, 1)

    def lacking(self, name: str) -> int:
        """Rows at which one side alone has a number."""
        if self.is_word(name):
            return 0
        one, other = self.values(name)
        return int((np.isfinite(one) != np.isfinite(other)).sum())

    def has_errors(self, name: str) -> bool:
        return name + ERROR in self.base.columns and name + ERROR in self.other.columns

    def levels(self, name: str) -> np.ndarray:
        """Levels of the variant against the base [dB]; not a number where there is none."""
        unit = self.base.units[name]
        found = (level(*pair, unit) for pair in zip(*self.values(name), strict=True))
        return np.array([np.nan if one is None else one for one in found], dtype=float)

    def percent(self, name: str) -> np.ndarray:
        """Change in percent of the base, by size: a drop is negative; not a number where there is none."""
        one, other = self.values(name)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where((one == 0.0) | (one * other < 0.0), np.nan, 100.0 * (other - one) / one)

    def changes(self, name: str) -> Counter[tuple[str, str]]:
        """How often which word became which other."""
        one, other = self.values(name)
        pairs = zip(one.tolist(), other.tolist(), strict=True)
        return Counter(pair for pair in pairs if pair[0] != pair[1])

    def _margin(self, name: str, side: int) -> np.ndarray:
        table = (self.base, self.other)[side]
        number = np.abs(table.columns[name][self.rows[side]])
        with np.errstate(divide="ignore", invalid="ignore"):
            digit = 0.5 * 10.0 ** (np.floor(np.log10(number)) - DIGITS + 1)
        digit = np.where(number > 0.0, digit, 0.0)
        error = table.columns.get(name + ERROR)
        return digit if error is None else np.fmax(error[self.rows[side]], digit)


def compared_rows(base: Variant, variant: Variant) -> Compared:
    """The rows that both have. Raises CommandError where they have no key, or no row, in common."""
    one, other = table_of(base), table_of(variant)
    if [*one.keys] != [*other.keys]:
        raise CommandError(
            f"{base.name} varies {', '.join(one.keys)}, {variant.name} {', '.join(other.keys)}: their rows "
            "cannot stand side by side."
        )
    common = [key for key in one.places if key in other.places]
    if not common:
        raise CommandError(
            f"{base.name} and {variant.name} have no value of {', '.join(one.keys)} in common."
        )
    first, second = (np.array([table.places[key] for key in common]) for table in (one, other))
    return Compared(one, other, (first, second))


def table_of(variant: Variant) -> Table:
    """The rows of a variant's one result."""
    if len(variant.results) != 1:
        raise CommandError(f"{variant.name} has no result: its rows are not known.")
    result = variant.results[0]
    if isinstance(result, Campaign):
        return _of_campaign(variant.name, result)
    return _of_sweep(variant.name, result) if result.task == "sweep" else _of_thresholds(variant.name, result)


def _of_campaign(name: str, campaign: Campaign) -> Table:
    done = np.flatnonzero(campaign.done)
    keys = {key: np.asarray(campaign[key])[done] for key in campaign.varied}
    if GEAR in keys and campaign.gears:
        keys[GEAR] = np.array([campaign.gears[int(number) - 1] for number in keys[GEAR]], dtype=object)
    recorded = [column for column in campaign.names if column in QUANTITIES and column not in EFFORT]
    columns = {column: np.asarray(campaign[column])[done] for column in recorded}
    return Table(name, keys, _with_words(columns, campaign.failed[done]), campaign.units)


def _of_sweep(name: str, result: Result) -> Table:
    key = result.names[0]
    keys = {key: np.asarray(result[key])}
    if "direction" in result:
        words = {direction: word for word, direction in ways(result).items()}
        keys["direction"] = np.array([words[float(way)] for way in result["direction"]], dtype=object)
    recorded = [column for column in result.names if column in QUANTITIES and column not in EFFORT]
    columns = {column: np.asarray(result[column]) for column in recorded}
    failed = ~np.isin(result["status"], SUCCESSES)
    return Table(name, keys, _with_words(columns, failed), result.units)


def _of_thresholds(name: str, result: Result) -> Table:
    """Of each crossing its middle, half its width as error, and what changes there."""
    found = thresholds(result)
    keys = {
        key: np.array([found.words_of_value(key, float(value)) for value in found.column(key)], dtype=object)
        if key == GEAR
        else found.column(key)
        for key in found.varied
    }
    keys[CROSSING] = found.column(CROSSING)
    half = 0.5 * np.where(found.column(CROSSING) > 0, found.column("upper") - found.column("lower"), np.nan)
    columns = {THRESHOLD: found.values, THRESHOLD + ERROR: half, KIND: found.kinds}
    return Table(
        name, keys, columns, {**_key_units(result, keys), THRESHOLD: result.units["lower"], KIND: ""}
    )


def _key_units(result: ResultFile, keys: Mapping[str, np.ndarray]) -> dict[str, str]:
    return {key: result.units[key] for key in keys}


def _with_words(columns: Mapping[str, np.ndarray], failed: np.ndarray) -> dict[str, np.ndarray]:
    """Codes as words; of scenes that failed only how they ended."""
    found: dict[str, np.ndarray] = {}
    for name, values in columns.items():
        if words_of(name) is None:
            found[name] = np.where(failed, np.nan, values)
            continue
        words = {code: spoken(word(name, code)) for code in np.unique(values[np.isfinite(values)]).tolist()}
        spelt = [words.get(code, "unknown") for code in values.tolist()]
        found[name] = np.array(spelt, dtype=object)
        if quantity_of(name) != "status":
            found[name][failed] = "failed"
    return found


def _key_words(value: Any) -> str:
    return value if isinstance(value, str) else f"{float(value):.{KEY_DIGITS}g}"
