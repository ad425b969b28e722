"""Holds the repository against its own rules: data flows down the list of folders in fsrc/MODULES, a file
holds
the module of its name, main is a table of contents, no library routine stops the program, Python imports run
one way, rooms and version are told alike everywhere, and what a change touches does not spread."""

from __future__ import annotations

import argparse
import ast
import os
import re
import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

os.chdir(Path(__file__).resolve().parents[1])
MODULES = [line.split()[0] for line in Path("fsrc/MODULES").read_text().splitlines()]
TOP_LEVEL = {"Makefile", "fsrc", "input", "scripts", "tests", "README.md"}
TOP_LEVEL |= {"LICENSE", "CHANGELOG.md", "CITATION.cff", "pyproject.toml", "build", "results"}
MAIN_LINES = 80
# Where the version of fsrc/VERSION is repeated.
VERSIONS = {
    "CITATION.cff": r"^version: (\S+)$",
    "CHANGELOG.md": r"^## (\S+)",
}

MODULE = re.compile(r"^\s*module\s+(?!procedure\b)(\w+)", re.IGNORECASE)
USE = re.compile(r"^\s*use\s*(?:,\s*\w+\s*)?(?:::)?\s*(\w+)", re.IGNORECASE)
STOP = re.compile(r"^\s*(?:if\s*\(.*\)\s*)?(?:error\s+)?stop\b", re.IGNORECASE)


def module_of(path: Path) -> str:
    return path.relative_to("fsrc").parts[0]


def faults() -> list[str]:
    """One sentence per broken rule."""
    found = [f"{entry.name}: does not belong to the layout" for entry in Path().iterdir() if is_stray(entry)]
    sources = sorted(Path("fsrc").glob("*/**/*.f90"))
    found += [f"fsrc/{room}: a folder without a module" for room in {*MODULES} - {*map(module_of, sources)}]
    home = {path.stem.lower(): module_of(path) for path in sources}
    for path in sources:
        room = module_of(path)
        if room not in MODULES:
            found.append(f"{path}: {room} is no folder of fsrc/MODULES")
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            place = f"{path}:{number}"
            if (module := MODULE.match(line)) and room != "bindings" and module[1].lower() != path.stem:
                found.append(f"{place}: module {module[1]} stands in a file of another name")
            other = home.get(use[1].lower()) if (use := USE.match(line)) else None
            if other in MODULES and MODULES.index(other) > MODULES.index(room):
                found.append(f"{place}: {room} uses {use[1]} of {other}, a folder below it")
            if STOP.match(line):
                found.append(f"{place}: a library routine stops the program")
    if len(Path("fsrc/main.f90").read_text().splitlines()) > MAIN_LINES:
        found.append(f"fsrc/main.f90: more than {MAIN_LINES} lines")
    found += [f"{what}: {count}, more than {limit}" for what, count, limit in counts() if count > limit]
    return [*found, *unlike_modules(), *unlike_versions(), *import_circles()]


def is_stray(entry: Path) -> bool:
    return not entry.name.startswith(".") and entry.name not in TOP_LEVEL


def counts() -> Iterator[tuple[str, int, int]]:
    """What may not spread: its name, how many there are, and how many there may be."""
    fortran = sorted(Path("fsrc").rglob("*.f90"))
    readme = Path("README.md").read_text()
    yield "files that name a film law below scene", sum(map(names_law, fortran)), 2
    yield "files of scene and campaign that a varied key touches", sum(map(names_key, fortran)), 2
    yield "README lines", len(readme.splitlines()), 182
    yield "README words", len(readme.split()), 1800


def names_law(path: Path) -> bool:
    """Whether a file below scene names a film law by its code."""
    laws = r"\b(kernel_(?!of)|law_(iso|piezo)_viscous|rupture_(half_pi|solved|solver))"
    return path.parts[1] not in {"scene", "bindings"} and re.search(laws, path.read_text()) is not None


def names_key(path: Path) -> bool:
    """Whether a file between input and physics names a varied key: one of them stands for all."""
    return (
        path.parts[1] in {"scene", "campaign"}
        and re.search(r"\bpoisson_ratio\b", path.read_text()) is not None
    )


def unlike_modules() -> Iterator[str]:
    """Folders that the map in the README leaves out or puts in another order."""
    layout = Path("README.md").read_text().partition("## The layout")[2]
    told = [
        room
        for row in re.findall(r"^\| `.*?\|", layout, re.MULTILINE)
        for room in re.findall(r"`(\w+)/`", row)
    ]
    if told != MODULES:
        yield f"README.md: the map has the folders {' '.join(told)}, fsrc/MODULES has {' '.join(MODULES)}"


def unlike_versions() -> Iterator[str]:
    """Files whose version is not that of fsrc/VERSION."""
    version = Path("fsrc/VERSION").read_text().strip()
    for name, pattern in VERSIONS.items():
        told = re.search(pattern, Path(name).read_text(), re.MULTILINE)
        if told is None or told[1] != version:
            yield f"{name}: version {told[1] if told else 'missing'}, fsrc/VERSION says {version}"


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
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--counts", action="store_true", help="print what is counted, with its limit")
    if parser.parse_args().counts:
        for what, count, limit in counts():
            print(f"{what:40}{count:7d}  at most {limit}")
        sys.exit()
    sentences = faults()
    print("\n".join(sentences))
    sys.exit(bool(sentences))
