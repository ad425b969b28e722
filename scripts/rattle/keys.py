"""The input keys with unit, default and meaning, from the page of all keys that the program writes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

_HERE = Path(__file__).resolve().parent
# Where an installed package has the page, and where the repository has it.
PAGES = (_HERE / "keys.md", _HERE.parents[1] / "input" / "KEYS.md")
_GROUP = re.compile(r"## &(\w+)$")
_TASKS = re.compile(r"For (`.+`):$")
_KEY = re.compile(r"\| `(\w+)` \|")


@dataclass(frozen=True)
class Key:
    """What the page says of one key; `unit` is empty for words and '-' for pure numbers."""

    unit: str
    default: str
    allowed: str
    meaning: str
    tasks: tuple[str, ...] = ()
    """The tasks that use it; empty: all do."""
    used_with: str = ""
    """What else must stand in the input, or must not."""


@cache
def key_table() -> dict[tuple[str, str], Key]:
    """All keys by group and name, in the order of the page; empty where the page is not there."""
    page = next((path for path in PAGES if path.exists()), None)
    return read_page(page.read_text(encoding="utf-8")) if page else {}


def read_page(text: str) -> dict[tuple[str, str], Key]:
    """The keys that a page of `rattle --keys` lists."""
    found: dict[tuple[str, str], Key] = {}
    group = ""
    tasks: tuple[str, ...] = ()
    columns: list[str] = []
    for line in text.splitlines():
        if line.startswith("#"):
            head = _GROUP.match(line)
            group, tasks = head[1] if head else "", ()
        elif shared := _TASKS.match(line):
            tasks = tuple(re.findall(r"`(\w+)`", shared[1]))
        elif group and line.startswith("| key |"):
            columns = [name.strip() for name in line.strip("|").split("|")]
        elif group and (name := _KEY.match(line)):
            cells = (cell.strip() for cell in line.strip("|").split("|", len(columns) - 1))
            row = dict(zip(columns, cells, strict=True))
            found[group, name[1]] = Key(
                row["unit"],
                row["default"].replace("**", ""),
                row["allowed"],
                row["meaning"],
                tasks,
                row.get("used with", ""),
            )
    return found


def unit_of(name: str) -> str:
    """The unit of the first key of this name in any group; empty where there is none."""
    return next((key.unit for (_, known), key in key_table().items() if known == name), "")
