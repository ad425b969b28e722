"""One side of a comparison: all that was solved of one input, by gear pair."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rattle.campaign_result import Campaign, read_campaign
from rattle.command import CommandError
from rattle.result import MOTIONS_ENDING, PROFILES_ENDING, Result, read
from rattle.solve import Gearbox, Solved
from rattle.summary import ENDING, Summary, read_summary

COMPARED = ("motion", "sweep", "campaign", "threshold")
Given = Solved | Gearbox | Result | Campaign | str | Path | Iterable[str | Path]


@dataclass(frozen=True)
class Variant:
    """What was solved of one input.

    `pairs` has it by gear, '' standing for a pair without a name; `together` is the table of all gear pairs
    of a motion, None where it is not known or only some of them are compared.
    """

    name: str
    pairs: Mapping[str, Solved]
    together: Summary | None = None

    @property
    def results(self) -> list[Result | Campaign]:
        return [solved.result for solved in self.pairs.values() if solved.result is not None]

    @property
    def task(self) -> str:
        """The task of its results; a variant without a result is a motion, of which the summary is known."""
        return self.results[0].task if self.results else "motion"


def variants_of(given: Mapping[str, Given]) -> list[Variant]:
    """Variants by name, the first the base; of each what `rattle.run` returned, a result, or its paths.

    Raises CommandError where they cannot be compared.
    """
    return compared([_variant(str(name), one) for name, one in given.items()])


def read_variants(paths: Sequence[Path]) -> list[Variant]:
    """Variants in the order of their files; those of the gear pairs of one input make one variant.

    Raises CommandError where they cannot be compared.
    """
    return compared(grouped(paths))


def compared(variants: list[Variant]) -> list[Variant]:
    """The variants, if they are two or more of one task that can be compared."""
    if len(variants) < 2:
        raise CommandError("A comparison needs two results: the base, and a variant of it.")
    tasks = list(dict.fromkeys(variant.task for variant in variants))
    if len(tasks) > 1:
        kinds = ", ".join(f"{variant.name} is a {variant.task}" for variant in variants)
        raise CommandError(f"Results of one kind are compared: {kinds}.")
    if tasks[0] not in COMPARED:
        raise CommandError(f"Results of {', '.join(COMPARED)} are compared, not of {tasks[0]}.")
    base = variants[0]
    for solved in (one for variant in variants for one in variant.pairs.values()):
        if tasks[0] == "motion" and solved.result is not None and not solved.summary:
            raise CommandError(f"No summary stands beside {solved.result.path}: its answer is not known.")
    for variant in variants:
        if len(base.pairs) * len(variant.pairs) > 1 and not {*base.pairs} & {*variant.pairs}:
            raise CommandError(f"{base.name} and {variant.name} have no gear pair in common.")
    return variants


def grouped(paths: Sequence[Path]) -> list[Variant]:
    """Variants of files, with names that distinguish them; a pair that comes again begins another variant."""
    found: list[tuple[Path, Variant]] = []
    for path in paths:
        if path.name.endswith((MOTIONS_ENDING, PROFILES_ENDING)):
            continue  # they are parts of the result beside them
        place, variant = _of_file(path)
        (gear,) = variant.pairs if len(variant.pairs) == 1 else [None]
        last = found[-1][1] if found and found[-1][0] == place else None
        if last and last.together and gear and gear not in last.pairs:
            name = str(last.together["name"]).strip()
            found[-1] = place, replace(last, name=name, pairs={**last.pairs, **variant.pairs})
        else:
            found.append((place, variant))
    return [_whole(variant) for variant in _distinct(found)]


def _variant(name: str, given: Given) -> Variant:
    if isinstance(given, Gearbox):
        return Variant(name, dict(given), given.summary)
    if isinstance(given, Solved):
        return Variant(name, {_gear_of(given.summary): given})
    if isinstance(given, Result | Campaign):
        path = given.summary_path
        solved = Solved(given, read_summary(path) if path.exists() else {})
        return Variant(name, {_gear_of(solved.summary): solved})
    if isinstance(given, Mapping) or not isinstance(given, str | Path | Iterable):
        raise CommandError(
            f"{name} is a {type(given).__name__}; a variant is what rattle.run returned, a result, or a path."
        )
    paths: list[Any] = [given] if isinstance(given, str | Path) else list(given)
    found = grouped([Path(path) for path in paths])
    if len(found) != 1:
        raise CommandError(f"{name} is {len(found)} variants; the paths of one are needed.")
    return replace(found[0], name=name)


def _of_file(path: Path) -> tuple[Path, Variant]:
    """The place that all files of an input have in common, and the variant that this file alone makes."""
    if path.name.endswith(ENDING):
        summary = read_summary(path)
        stem = path.name.removesuffix(ENDING)
        if "gears" in summary:
            return path, Variant(stem, dict(_pairs_of(path, stem, summary)), summary)
        beside = path.with_name(f"{stem}.rattle")
        solved = Solved(_opened(beside) if beside.exists() else None, summary)
    else:
        result = _opened(path)
        path = result.summary_path
        solved = Solved(result, read_summary(path) if path.exists() else {})
        stem = path.name.removesuffix(ENDING)
    gear = _gear_of(solved.summary)
    box = path.with_name(f"{stem.removesuffix(f'.{gear}')}{ENDING}")
    if gear and box != path and box.exists():
        table = read_summary(box)
        if gear in table.get("gears", {}):
            return box, Variant(stem, {gear: solved}, table)
    return path, Variant(stem, {gear: solved})


def _pairs_of(path: Path, stem: str, table: Summary) -> Iterator[tuple[str, Solved]]:
    """The pairs of a table, by the summaries beside it."""
    for gear in table["gears"]:
        summary, result = (path.with_name(f"{stem}.{gear}{end}") for end in (ENDING, ".rattle"))
        if not summary.exists():
            raise CommandError(f"{path} is the table of gear pairs; {summary} of one of them is not there.")
        yield gear, Solved(_opened(result) if result.exists() else None, read_summary(summary))


def _opened(path: Path) -> Result | Campaign:
    result = read(path)
    return read_campaign(path) if result.task == "campaign" else result


def _gear_of(summary: Mapping[str, Any]) -> str:
    return str(summary.get("gear", "")).strip()


def _whole(variant: Variant) -> Variant:
    """Without the table of all pairs where only some of them were given."""
    if variant.together is None or set(variant.pairs) == set(variant.together["gears"]):
        return variant
    return replace(variant, together=None)


def _distinct(found: Sequence[tuple[Path, Variant]]) -> list[Variant]:
    """Equal names are distinguished by their folders, then by their order."""
    counts = Counter(variant.name for _, variant in found)
    names = [
        f"{place.resolve().parent.name}/{variant.name}" if counts[variant.name] > 1 else variant.name
        for place, variant in found
    ]
    again, seen = Counter(names), Counter[str]()
    for place, name in enumerate(names):
        seen[name] += 1
        if again[name] > 1 and seen[name] > 1:
            names[place] = f"{name} ({seen[name]})"
    return [replace(variant, name=name) for (_, variant), name in zip(found, names, strict=True)]
