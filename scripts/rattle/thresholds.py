"""What a result of thresholds says: its crossings, what changes at each, and how far that stands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from rattle.campaign_plan import GEAR, GRID, LINEAR, LOGARITHMIC, read_plan
from rattle.campaign_result import Axis, is_varied
from rattle.campaign_section import short_name, spaced_unit
from rattle.codes import CLASSES, CODES, STATUSES, SUCCESSES, quantity_of, spoken, word, words_of
from rattle.result import Result

# A criterion of its own: whether the verdict is one with impacts.
IMPACTS = "impacts"
WITH_IMPACTS = tuple(code for code, word in CODES["verdict"].items() if "impacts" in word)


@dataclass(frozen=True)
class Thresholds:
    """A result of thresholds, or some of its rows, in words that people know."""

    result: Result
    rows: np.ndarray

    @property
    def key(self) -> str:
        """The key whose thresholds they are."""
        return str(self.result.value("threshold", "key")).strip().lower()

    @property
    def quantity(self) -> str:
        """The quantity that the criterion looks at."""
        return quantity_of(next(name for name in self.result.names if name.endswith("_below")))

    @property
    def varied(self) -> tuple[str, ...]:
        return tuple(name for name in self.result.names if is_varied(name))

    def column(self, name: str) -> np.ndarray:
        return np.asarray(self.result[name])[self.rows]

    @cached_property
    def range(self) -> Axis:
        """The key between its ends."""
        ends = [float(self.result.number("threshold", name)) for name in ("first", "last")]
        scale = str(self.result.value("threshold", "scale")).strip()
        return Axis(self.key, self.result.units["lower"], scale, np.array(ends))

    @property
    def values(self) -> np.ndarray:
        """Middles of the brackets, NaN for a trace without one."""
        lower, upper = self.column("lower"), self.column("upper")
        logarithmic = self.range.scale == LOGARITHMIC
        with np.errstate(invalid="ignore"):
            middles = np.sqrt(lower * upper) if logarithmic else 0.5 * (lower + upper)
        return np.where(self.column("crossing") > 0, middles, np.nan)

    @cached_property
    def kinds(self) -> np.ndarray:
        """What changes at each crossing, as in 'quiet to creep'; of a trace without one what it is."""
        below, above = (self._sides(side) for side in ("_below", "_above"))
        crossing = self.column("crossing") > 0
        return np.array(
            [
                f"{one} to {other}" if changes else one
                for one, other, changes in zip(below, above, crossing, strict=True)
            ],
            dtype=object,
        )

    def _sides(self, side: str) -> list[str]:
        status, values = self.column(f"status{side}"), self.column(f"{self.quantity}{side}")
        return [
            spoken(STATUSES.get(int(code), "failed")) if code not in SUCCESSES else self._word(value)
            for code, value in zip(status, values, strict=True)
        ]

    def _word(self, value: float) -> str:
        if not np.isfinite(value):
            return "unknown"
        if words_of(self.quantity) is not None:
            words = spoken(word(self.quantity, value))
            wanted = str(self.result.value("threshold", "criterion")).strip()
            if wanted == IMPACTS:
                return "impacts" if value in WITH_IMPACTS else "no impacts"
            if wanted in CLASSES.values() and words != spoken(wanted):
                return "another class"
            return words if self.quantity == "rattle_class" else f"{short_name(self.quantity)} {words}"
        level = float(self.result.number("threshold", "level"))
        place = "at least" if value >= level else "below"
        return f"{place} {level:g}{spaced_unit(self.result.units[f'{self.quantity}_below'])}"

    def rattles(self, side: str) -> np.ndarray:
        """Whether the motion on a side, '_below' or '_above', is the one that thresholds are to keep off."""
        values = self.column(f"{self.quantity}{side}")
        wanted = str(self.result.value("threshold", "criterion")).strip()
        with np.errstate(invalid="ignore"):
            if words_of(self.quantity) is None:
                return values >= float(self.result.number("threshold", "level"))
            if self.quantity == "verdict":
                return np.isin(values, WITH_IMPACTS)
            if self.quantity != "rattle_class":
                return values >= 1.0
            codes = {word: code for code, word in CLASSES.items()}
            return values == codes[wanted] if wanted in codes else values > codes["quiet"]

    @property
    def rattling_words(self) -> str:
        """What the side is that `rattles` finds."""
        wanted = str(self.result.value("threshold", "criterion")).strip()
        if words_of(self.quantity) is None:
            level = float(self.result.number("threshold", "level"))
            return f"at least {level:g}{spaced_unit(self.result.units[f'{self.quantity}_below'])}"
        if self.quantity == "verdict":
            return "impacts"
        if self.quantity != "rattle_class":
            return short_name(self.quantity)
        return spoken(wanted) if wanted in CLASSES.values() else "not quiet"

    @property
    def has_ends(self) -> bool:
        """Whether the motions of both sides were followed to where they end."""
        return "last_below" in self.result

    @property
    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        """Smallest value of the motions of the side above, and largest of those below; NaN where not known.

        Where they overlap, a gear on its way up changes at the second, on its way down at the first.
        """
        if not self.has_ends:
            return np.full(self.rows.size, np.nan), np.full(self.rows.size, np.nan)
        return self.column("last_above"), self.column("last_below")

    @property
    def either(self) -> np.ndarray:
        """Crossings with values beyond the bracket at which motions of both sides were found."""
        last_above, last_below = self.ends
        crossed = self.column("crossing") > 0
        beyond = (last_above < self.column("lower")) | (last_below > self.column("upper"))
        return crossed & beyond & (last_above < last_below)

    @property
    def another_side(self) -> np.ndarray:
        """Traces without a threshold with motions on another side, from one of the ends to the other."""
        last_above, last_below = self.ends
        return (self.column("crossing") == 0) & (last_above <= last_below)

    @property
    def uncertain(self) -> np.ndarray:
        """Crossings with a side that is not verified, where that was asked for."""
        if "verified_below" not in self.result:
            return np.zeros(self.rows.size, dtype=bool)
        flags = np.column_stack([self.column(f"verified{side}") for side in ("_below", "_above")])
        return (self.column("crossing") > 0) & ~(flags == 1.0).all(axis=1)

    @cached_property
    def axes(self) -> tuple[Axis, ...]:
        """The varied keys with their values in rising order."""
        scales = {axis.key: axis.scale for axis in read_plan(self.result.input_text).axes}
        return tuple(
            Axis(key, self.result.units[key], scales.get(key, LINEAR), np.unique(self.column(key)))
            for key in self.varied
        )

    def words_of_value(self, key: str, value: float) -> str:
        """A value of a varied key with its unit, or the name of a gear pair."""
        if key == GEAR:
            return read_plan(self.result.input_text).gears[int(value) - 1]
        return f"{value:.4g}{spaced_unit(self.result.units[key])}"

    @property
    def on_grid(self) -> bool:
        return read_plan(self.result.input_text).kind == GRID

    def held(self, values: Mapping[str, float]) -> Thresholds:
        """The rows of the traces at these values of some keys."""
        kept = np.ones(self.rows.size, dtype=bool)
        for key, value in values.items():
            kept &= self.column(key) == value
        return replace(self, rows=self.rows[kept])


def thresholds(result: Result) -> Thresholds:
    """All thresholds of a result."""
    return Thresholds(result, np.arange(result.row_count))


def words_of_criterion(found: Thresholds) -> str:
    """As in 'change of class'."""
    criterion = str(found.result.value("threshold", "criterion")).strip()
    if criterion == "class" or found.quantity == criterion == "rattle_class":
        return "change of class"
    if criterion == IMPACTS:
        return "beginning or end of impacts"
    if criterion in CLASSES.values():
        return f"change into or out of {spoken(criterion)}"
    if words_of(criterion) is not None:
        return f"change of {short_name(criterion)}"
    level = float(found.result.number("threshold", "level"))
    return f"{short_name(criterion)} passes {level:g}{spaced_unit(found.result.units[f'{criterion}_below'])}"
