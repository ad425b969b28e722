"""Holds fsrc against its own rules: data flows down the list of rooms, a file holds the module of its name,
main is a table of contents, and no library routine stops the program."""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

ROOMS = (
    "foundation",
    "scene",
    "film",
    "motion",
    "orbit",
    "spectrum",
    "verdict",
    "files",
    "run",
    "campaign",
    "bindings",
)
TOP_LEVEL = {"Makefile", "fsrc", "input", "scripts", "tests", "README.md"}
TOP_LEVEL |= {"LICENSE", "CHANGELOG.md", "CITATION.cff", "pyproject.toml", "build", "results"}
MAIN_LINES = 80

MODULE = re.compile(r"^\s*module\s+(?!procedure\b)(\w+)", re.IGNORECASE)
USE = re.compile(r"^\s*use\s*(?:,\s*\w+\s*)?(?:::)?\s*(\w+)", re.IGNORECASE)
STOP = re.compile(r"^\s*(?:if\s*\(.*\)\s*)?(?:error\s+)?stop\b", re.IGNORECASE)


def room_of(path: Path) -> str:
    return path.relative_to("fsrc").parts[0]


def faults() -> list[str]:
    """One sentence per broken rule."""
    found = [f"{entry.name}: stands beside the house" for entry in Path().iterdir() if is_stray(entry)]
    sources = sorted(Path("fsrc").glob("*/**/*.f90"))
    home = {path.stem.lower(): room_of(path) for path in sources}
    for path in sources:
        room = room_of(path)
        if room not in ROOMS:
            found.append(f"{path}: {room} is no room of the house")
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            place = f"{path}:{number}"
            if (module := MODULE.match(line)) and room != "bindings" and module[1].lower() != path.stem:
                found.append(f"{place}: module {module[1]} stands in a file of another name")
            other = home.get(use[1].lower()) if (use := USE.match(line)) else None
            if other and ROOMS.index(other) > ROOMS.index(room):
                found.append(f"{place}: {room} uses {use[1]} of {other}, a room below it")
            if STOP.match(line):
                found.append(f"{place}: a library routine stops the program")
    if len(Path("fsrc/main.f90").read_text().splitlines()) > MAIN_LINES:
        found.append(f"fsrc/main.f90: more than {MAIN_LINES} lines")
    return found


def is_stray(entry: Path) -> bool:
    return not entry.name.startswith(".") and entry.name not in TOP_LEVEL


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__).parse_args()
    sentences = faults()
    print("\n".join(sentences))
    sys.exit(bool(sentences))
