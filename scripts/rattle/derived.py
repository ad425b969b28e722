"""What the program derives from an input, of one of its gear pairs: base radii, mass, drag and the like."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from rattle import solver_process
from rattle.command import CommandError
from rattle.faults import InputError, read_faults
from rattle.solve import BAD_INPUT, Input, find_program, literal, text_of

# Each pair begins with a line of its own, and names its gear where there are several.
_PAIR = re.compile(r"^! .*: valid", re.MULTILINE)
_DERIVED = re.compile(r"^! derived: (\S+) = (.*?)(?: [^\d\s]\S*)*$")


def derived(input: Input, *, gear: str | None = None, set: Mapping[str, Any] | None = None) -> dict[str, str]:
    """Keys of an input as 'group.key' with their values as --check writes them, and what it derives.

    Raises InputError for bad input, CommandError for one of no motion or a gear that there is not.
    """
    text = text_of(input)
    settings = [f"{key}={literal(value)}" for key, value in (set or {}).items()]
    given = "-" if text is not None else str(input)
    ended = solver_process.solve([find_program(), "--check", "--", given], settings, text or "")
    if ended.returncode != 0:
        raise InputError(read_faults(ended.stderr), BAD_INPUT)
    starts = [found.start() for found in _PAIR.finditer(ended.stdout)]
    pairs = [_values(ended.stdout[a:b]) for a, b in zip(starts, [*starts[1:], None], strict=True)]
    task = pairs[0].get("scene.task", "").strip("'")
    if task != "motion":
        raise CommandError(f"{given} is the input of a {task}; that of a motion is needed, without &{task}.")
    names = [pair.get("gear.name", "").strip("'") for pair in pairs]
    if len(pairs) == 1 and gear in (None, names[0]):
        return pairs[0]
    if gear is None:
        raise CommandError(f"{given} has the pairs {', '.join(names)}: choose one by --gear.")
    if gear not in names:
        raise CommandError(f"{given} has no pair '{gear}'; it has {', '.join(filter(None, names)) or 'one'}.")
    return pairs[names.index(gear)]


def _values(comments: str) -> dict[str, str]:
    found, group = {}, ""
    for line in comments.splitlines():
        if line.startswith("&"):
            group = line[1:].strip()
        elif match := _DERIVED.match(line):
            found[match[1]] = match[2]
        elif group and " = " in line and not line.startswith("!"):
            key, _, value = line.strip().partition(" = ")
            found[f"{group}.{key}"] = value
    return found
