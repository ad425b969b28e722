"""The input keys with unit, default and meaning, from the page of all keys that the program writes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

_HERE = Path(__file__).resolve().parent
# Where an installed package has the page, and where the repository has it.
PAGES = (_HERE / "keys.md", _HERE.parents[1] / "input" / "README.md")
_GROUP = re.compile(r"## &(\w+)$")
_CONDITIONS = re.compile(r"(Only with `.+`):$")
_KEY = re.compile(r"\| `(\w+)` \|")


@dataclass(frozen=True)
class Key:
    """What the page says of one key; `unit` is empty for words and '-' for pure numbers."""

    unit: str
    default: str
    allowed: str
    meaning: str


@cache
def key_table() -> dict[tuple[str, str], Key]:
    """All keys by group and name, in the order of the page; empty where the page is not there."""
    page = next((path for path in PAGES if path.exists()), None)
    return read_page(page.read_text(encoding="utf-8")) if page else {}


def read_page(text: str) -> dict[tuple[str, str], Key]:
    """The keys that a page of `rattle --keys` lists."""
    found: dict[tuple[str, str], Key] = {}
    group = conditions = ""
    for line in text.splitlines():
        if line.startswith("#"):
            head = _GROUP.match(line)
            group, conditions = head[1] if head else "", ""
        elif shared := _CONDITIONS.match(line):
            conditions = f" {shared[1]}."
        elif group and (name := _KEY.match(line)):
            _, _, unit, default, allowed, _, meaning = (cell.strip() for cell in line.split("|", 6))
            words = meaning.removesuffix("|").strip() + conditions
            found[group, name[1]] = Key(unit, default.strip("*"), allowed, words)
    return found


def unit_of(name: str) -> str:
    """The unit of the first key of this name in any group; empty where there is none."""
    return next((key.unit for (_, known), key in key_table().items() if known == name), "")
