"""A list of variants, each with a cost and the keys that it changes, as a CSV file has it."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rattle.command import CommandError
from rattle.countermeasures.levers import value_of
from rattle.countermeasures.scenes import Scenes
from rattle.counts import counted

NAME, COST = "variant", "cost"


@dataclass(frozen=True)
class Variant:
    """One line of the list; `cost` in a unit of the user, not a number where none is given."""

    name: str
    cost: float
    settings: Mapping[str, Any]


def read(path: Path, scenes: Scenes) -> list[Variant]:
    """The variants of a file: columns variant, cost, and keys as group.key, empty where one stays.

    A value that begins with * is a multiple of the present one, of each pair its own; a key of &gear is that
    of all pairs, gear(2).key that of the second.

    Raises
    ------
    CommandError
        What is wrong with the file, with its line.
    """
    with path.open(newline="", encoding="utf-8-sig", errors="surrogateescape") as stream:
        lines = [
            (number, row) for number, row in enumerate(csv.reader(stream), 1) if any(map(str.strip, row))
        ]
    if len(lines) < 2:
        raise CommandError(f"{path} has no variant: a head as {NAME},{COST},gear.backlash, then a line each.")
    head = [name.strip() for name in lines[0][1]]
    keys = [name for name in head if name not in (NAME, COST)]
    if NAME not in head or not keys or len(set(head)) < len(head):
        raise CommandError(f"{path}: the head '{','.join(head)}' needs {NAME} and keys, each once.")
    found: list[Variant] = []
    for number, row in lines[1:]:
        if len(row) != len(head):
            raise CommandError(
                f"{path}, line {number}: {counted(len(row), 'value')} for {counted(len(head), 'column')}."
            )
        cells = dict(zip(head, map(str.strip, row), strict=True))
        place = f"{path}, line {number}"
        settings: dict[str, Any] = {}
        for key in filter(cells.get, keys):
            settings |= _settings(key, cells[key], scenes, place)
        cost = _number(cells[COST], f"{place}: {COST}") if cells.get(COST) else math.nan
        if not settings or not cells[NAME] or any(one.name == cells[NAME] for one in found):
            raise CommandError(f"{place}: each variant has a name of its own and changes something.")
        found.append(Variant(cells[NAME], cost, settings))
    return found


def _settings(key: str, text: str, scenes: Scenes, place: str) -> dict[str, Any]:
    """The keys that a cell sets."""
    value = _number(text.removeprefix("*"), f"{place}: {key}")
    if not text.startswith("*"):
        return {key: value}
    group, _, name = key.partition(".")
    number = re.fullmatch(r"gear\((\d+)\)", group)
    pairs = list(enumerate(scenes.pairs, 1))
    if number:
        pairs = [pair for pair in pairs if pair[0] == int(number[1])]
    several = len(scenes.pairs) > 1
    settings = {}
    for count, scene in pairs if group.startswith("gear") else pairs[:1]:
        now = value_of(scene.groups, f"gear.{name}" if number else key)
        if now is None:
            raise CommandError(f"{place}: {key} has no value in {scene.name} that '{text}' could multiply.")
        settings[f"gear({count}).{name}" if several and group.startswith("gear") else key] = now * value
    if not settings:
        raise CommandError(f"{place}: there is no pair of {key}.")
    return settings


def _number(text: str, place: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise CommandError(f"{place}: '{text}' is not a number.")
    return number
