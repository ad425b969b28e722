"""Holds the repository against its own rules: data flows down the table of folders in fsrc/README.md, a file
holds the module of its name, main is a table of contents, no library routine stops the program, and Python
imports run one way."""

from __future__ import annotations

import ast
import os
import re
import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

os.chdir(Path(__file__).resolve().parents[1])
MODULES = re.findall(r"^\| `(\w+)/` \|", Path("fsrc/README.md").read_text(), re.MULTILINE)
TOP_LEVEL = {"Makefile", "fsrc", "input", "scripts", "tests", "README.md"}
TOP_LEVEL |= {"LICENSE", "CHANGELOG.md", "CITATION.cff", "pyproject.toml", "build", "results"}
MAIN_LINES = 80
# The only files below problem that know film laws: the list of those with a series, and what tells of films.
KNOW_LAWS = {
    "fsrc/motion/film_series.f90",
    "fsrc/verdict/regime_check.f90",
    "fsrc/run/run_film.f90",
    "fsrc/run/scene_report.f90",
}

MODULE = re.compile(r"^\s*module\s+(?!procedure\b)(\w+)", re.IGNORECASE)
USE = re.compile(r"^\s*use\s*(?:,\s*\w+\s*)?(?:::)?\s*(\w+)", re.IGNORECASE)
STOP = re.compile(r"^\s*(?:if\s*\(.*\)\s*)?(?:error\s+)?stop\b", re.IGNORECASE)


def module_of(path: Path) -> str:
    return path.relative_to("fsrc").parts[0]


def below_problem(room: str) -> bool:
    return MODULES.index(room) > MODULES.index("problem") and room != "bindings"


def faults() -> list[str]:
    """One sentence per broken rule."""
    found = [f"{entry.name}: does not belong to the layout" for entry in Path().iterdir() if is_stray(entry)]
    sources = sorted(Path("fsrc").glob("*/**/*.f90"))
    found += [f"fsrc/{room}: a folder without a module" for room in {*MODULES} - {*map(module_of, sources)}]
    home = {path.stem.lower(): module_of(path) for path in sources}
    for path in sources:
        room = module_of(path)
        if room not in MODULES:
            found.append(f"{path}: {room} is no folder of the table in fsrc/README.md")
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            place = f"{path}:{number}"
            if (module := MODULE.match(line)) and room != "bindings" and module[1].lower() != path.stem:
                found.append(f"{place}: module {module[1]} stands in a file of another name")
            other = home.get(use[1].lower()) if (use := USE.match(line)) else None
            if other in MODULES and MODULES.index(other) > MODULES.index(room):
                found.append(f"{place}: {room} uses {use[1]} of {other}, a folder below it")
            if below_problem(room) and use and use[1].lower() == "film_law" and str(path) not in KNOW_LAWS:
                found.append(f"{place}: {room} knows film laws, which problem and its contacts keep from it")
            if STOP.match(line):
                found.append(f"{place}: a library routine stops the program")
    if len(Path("fsrc/main.f90").read_text().splitlines()) > MAIN_LINES:
        found.append(f"fsrc/main.f90: more than {MAIN_LINES} lines")
    return [*found, *import_circles()]


def is_stray(entry: Path) -> bool:
    return not entry.name.startswith(".") and entry.name not in TOP_LEVEL


def import_circles() -> Iterator[str]:
    """Modules of scripts/rattle that import each other, also where it is for a function or for types only."""
    folder = Path("scripts")
    paths = {
        ".".join(path.with_suffix("").relative_to(folder).parts): path
        for path in folder.rglob("rattle/**/*.py")
    }
    modules = {name.removesuffix(".__init__"): path for name, path in paths.items()}
    needs = {}
    for name, path in modules.items():
        needs[name] = set()
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                needs[name] |= {alias.name for alias in node.names} & modules.keys()
            elif isinstance(node, ast.ImportFrom) and node.module in modules:
                parts = {f"{node.module}.{alias.name}" for alias in node.names}
                needs[name] |= parts & modules.keys() or {node.module}
    try:
        TopologicalSorter(needs).prepare()
    except CycleError as fault:
        yield f"scripts/rattle: {' imports '.join(reversed(fault.args[1]))}"


if __name__ == "__main__":
    sentences = faults()
    print("\n".join(sentences))
    sys.exit(bool(sentences))
