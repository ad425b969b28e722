"""The scenes of an input, each to be solved alone or all together with some keys changed."""

from __future__ import annotations

import math
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import f90nml

from rattle.codes import CODES
from rattle.command import CommandError
from rattle.namelist import NamelistError, parse, parse_groups
from rattle.result import Result
from rattle.solve import Gearbox, SceneFailed, Solved, run

VERDICTS = {word: code for code, word in CODES["verdict"].items()}
# The worst last.
SEVERITY = tuple(
    VERDICTS[word]
    for word in (
        "no separation",
        "separation",
        "impacts without separation",
        "single-sided impacts",
        "double-sided impacts",
    )
)
UNKNOWN = max(VERDICTS.values()) + 1
"""The verdict of a scene that did not reach its end: worse than any other."""
VERDICTS_OF = ("verdict", "loudest_verdict")
# Groups of other tasks, and of where files go.
OTHER_GROUPS = ("campaign", "threshold", "sweep", "output")
# Keys that name a file in the folder of the input.
FILES = (("gear", "drag_table"), ("shaft", "table"), ("shaft", "signal"), ("load", "signal"))


@dataclass(frozen=True)
class Answer:
    """What a scene does: the worst verdict of its motions, and the film force rms [N] of the loudest."""

    verdict: int
    force: float
    error: float
    motions: int

    def change_db(self, before: Answer) -> float:
        """By how much the film force changes; less than 0 is quieter."""
        return decibels(self.force, before.force)

    def error_db(self, before: Answer) -> float:
        """How far errors of both forces, which are independent, let that be off."""
        shares = (one.error / one.force if one.force > 0.0 else math.nan for one in (self, before))
        return 20.0 / math.log(10.0) * math.hypot(*shares)


FAILED = Answer(UNKNOWN, math.nan, math.nan, 0)


@dataclass(frozen=True)
class Together:
    """All pairs of a gearbox: the answer of each, and both sums of their film forces [N rms]."""

    pairs: Mapping[str, Answer]
    uncorrelated: float = math.nan
    in_phase: float = math.nan

    def change_db(self, before: Together) -> tuple[float, float]:
        """By how much both sums change."""
        return decibels(self.uncorrelated, before.uncorrelated), decibels(self.in_phase, before.in_phase)


@dataclass(frozen=True)
class Scene:
    """One scene, which the input `path` holds alone.

    `groups` are those of its resolved input without what is derived, `now` is what it does as it stands.
    """

    name: str
    path: Path
    groups: Mapping[str, Mapping[str, Any]]
    now: Answer

    def solve(self, settings: Mapping[str, Any]) -> Answer:
        """The scene with some keys changed; `FAILED` where it does not reach its end."""
        quiet = {"output.series": False}
        try:
            return answer(cast(Solved, run(self.path, set=quiet | dict(settings))).summary)
        except SceneFailed:
            return FAILED


@dataclass(frozen=True)
class Scenes:
    """All scenes of an input, which is `path` as a motion; `together` is what they do now."""

    name: str
    path: Path
    pairs: tuple[Scene, ...]
    together: Together

    def solve(self, settings: Mapping[str, Any]) -> Together:
        """All with some keys changed."""
        try:
            return _together(run(self.path, set={"output.series": False} | dict(settings)))
        except SceneFailed:
            return Together({scene.name: FAILED for scene in self.pairs})


def decibels(value: float, reference: float) -> float:
    """The level of an rms over another."""
    known = value > 0.0 and reference > 0.0
    return 20.0 * math.log10(value / reference) if known else math.nan


def answer(summary: Mapping[str, Any]) -> Answer:
    """What a summary says, or a row of the table of a gearbox."""
    if str(summary.get("status", "")).strip() not in ("complete", "steady") or "verdict" not in summary:
        return FAILED
    worst = max(
        (VERDICTS[str(summary[name]).strip()] for name in VERDICTS_OF if name in summary), key=SEVERITY.index
    )
    force = float(summary["film_force_rms"])
    error = float(summary.get("film_force_rms_error", math.nan))
    return Answer(
        worst,
        float(summary.get("loudest_film_force_rms", force)),
        error,
        max(1, int(summary.get("motions", 1))),
    )


def opened(path: Path, folder: Path) -> Scenes:
    """The scenes of an input as it is now; `folder` takes inputs that hold one each.

    Raises
    ------
    CommandError
        No namelist, no motion, or a scene that does not reach its end, which leaves nothing to compare with.
    RunError
        Other faults of the input.
    """
    try:
        groups = parse_groups(path.read_text(encoding="utf-8", errors="surrogateescape"))
    except NamelistError as fault:
        raise CommandError(f"{path} cannot be read: {fault}") from None
    task = str(groups.get("scene", {}).get("task", "motion")).strip().lower()
    if task == "film":
        raise CommandError(f"{path} has the task film: there is no motion to stop.")
    for name in OTHER_GROUPS:
        groups.pop(name, None)
    groups.setdefault("scene", f90nml.Namelist())["task"] = "motion"
    groups.end_comma = False
    gears = groups.get("gear", [])
    gears = gears if isinstance(gears, list) else [gears]
    whole = folder / path.name
    _write(groups, whole, path.parent)
    # A motion is solved from the file of the user, whose lines the faults name.
    try:
        solved = run(path if task == "motion" else whole, folder=folder / "now")
    except SceneFailed as fault:
        raise CommandError(f"{path}: nothing to compare with, as it stands now: {fault}") from None
    if isinstance(solved, Solved):
        summary = solved.summary
        name = str(summary.get("gear", "")).strip() or str(summary["name"]).strip()
        return _scenes(path, whole, {name: solved}, {name: whole})
    alone: dict[str, Path] = {}
    for name, gear in zip(solved, gears, strict=True):
        del groups["gear"]
        groups["gear"] = gear
        alone[name] = folder / f"{len(alone) + 1}" / path.name
        alone[name].parent.mkdir()
        _write(groups, alone[name], path.parent)
    return _scenes(path, whole, solved, alone)


def _scenes(path: Path, whole: Path, solved: Mapping[str, Solved], alone: Mapping[str, Path]) -> Scenes:
    scenes = []
    for name, (result, summary) in solved.items():
        now = answer(summary)
        if now is FAILED or not isinstance(result, Result):
            raise CommandError(
                f"{path}: {name} does not reach its end as it is now: nothing to compare with."
            )
        scenes.append(Scene(name, alone[name], parse(result.input_text), now))
    if isinstance(solved, Gearbox) and solved.summary:
        return Scenes(str(solved.summary["name"]).strip(), whole, tuple(scenes), _together(solved))
    (only,) = scenes
    name = str(solved[only.name].summary["name"]).strip()
    return Scenes(name, whole, (only,), Together({only.name: only.now}, only.now.force, only.now.force))


def _together(solved: Solved | Gearbox) -> Together:
    if isinstance(solved, Solved):
        summary = solved.summary
        name = str(summary.get("gear", "")).strip() or str(summary["name"]).strip()
        alone = answer(summary)
        return Together({name: alone}, alone.force, alone.force)
    pairs = {name: answer(one.summary) for name, one in solved.items()}
    sums = [
        float((solved.summary or {}).get(f"film_force_rms_{word}", math.nan))
        for word in ("uncorrelated", "in_phase")
    ]
    return Together(pairs, *sums)


def _write(groups: f90nml.Namelist, path: Path, beside: Path) -> None:
    """An input with the tables that it names beside it."""
    path.write_text(f"{groups}\n", encoding="utf-8", errors="surrogateescape")
    for group, key in FILES:
        for keys in _each(groups.get(group, {})):
            name = str(keys.get(key, "")).strip()
            if name and (beside / name).is_file():
                (path.parent / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(beside / name, path.parent / name)


def _each(group: Any) -> list[Mapping[str, Any]]:
    return group if isinstance(group, list) else [group]
