"""Film forces of a result that others are measured by, as levels against it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from rattle.command import CommandError
from rattle.comparison.answers import UNCORRELATED, answer_differences
from rattle.comparison.difference import Difference
from rattle.comparison.variant import Variant, grouped
from rattle.solve import Solved
from rattle.summary import Summary

FORCE = "film_force_rms"


@dataclass(frozen=True)
class Reference:
    """What was solved of a reference. All pairs are measured by one that has a single pair."""

    variant: Variant

    @property
    def name(self) -> str:
        return self.variant.name

    def level(self, gear: str, summary: Summary) -> str:
        """As in '+3.2 dB', of a pair; a dash where the reference has no such pair or no force."""
        other = Variant("", {gear: Solved(None, dict(summary))})
        return _words(answer_differences(self.variant, other), "answer", FORCE)

    def words(self, gear: str, summary: Summary) -> str:
        """As in '+3.2 dB re box_a'; nothing without a level."""
        level = self.level(gear, summary)
        return "" if level == "-" else f"{level} re {self.name}"

    def together(self, box: Summary, summaries: Mapping[str, Summary]) -> str:
        """The same of all pairs of a gearbox, their forces being independent."""
        pairs = {gear: Solved(None, dict(one)) for gear, one in summaries.items()}
        other = Variant("", pairs, box)
        level = _words(answer_differences(self.variant, other), "together", UNCORRELATED)
        return "" if level == "-" else f"Independent forces: {level} re {self.name}."


def read_reference(given: str) -> Reference:
    """The reference of RESULT or NAME=RESULT, the result or summary of a motion, or the table of a gearbox.

    Raises CommandError where it has no film force.
    """
    name, equals, place = given.partition("=")
    path = Path(given if Path(given).exists() or not equals else place)
    variant = next(iter(grouped([path])), None)
    if variant is None or not any(FORCE in solved.summary for solved in variant.pairs.values()):
        raise CommandError(f"{path} has no film force that others could be measured by.")
    return Reference(replace(variant, name=name) if path == Path(place) else variant)


def _words(differences: Iterable[Difference], part: str, name: str) -> str:
    found = [one for one in differences if (one.part, one.name) == (part, name)]
    level = found[0].decibel if found else None
    if level is None:
        return "-"
    return f"{level:+.1f} dB" if not found[0].same else "0 dB within the errors"
