"""Holds the repository against its own rules: data flows down the folders of fsrc in the order of the
Makefile, which the table of fsrc/README.md repeats, a file holds the module of its name, main is a table of
contents, no library routine stops the program, and Python imports run one way."""

from __future__ import annotations

import ast
import os
import re
import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

os.chdir(Path(__file__).resolve().parents[1])
MODULES = " ".join(re.findall(r"(?<=^MODULES := ).+", Path("Makefile").read_text(), re.MULTILINE)).split()
MODULES.append("bindings")
TABLE = re.findall(r"^\| `(\w+)/` \|", Path("fsrc/README.md").read_text(), re.MULTILINE)
TOP_LEVEL = {"Makefile", "fsrc", "input", "scripts", "tests", "README.md"}
TOP_LEVEL |= {"LICENSE", "CHANGELOG.md", "CITATION.cff", "pyproject.toml", "build", "results"}
MAIN_LINES = 80
# What serves any film law alike, and the only files below problem that know more of film laws: the list of
# those with a series, and what reports on films.
OF_ANY_LAW = {"film_kernel", "film_over_gap", "films_over_gaps", "kept_load", "most_films"}
OF_ANY_LAW |= {"overflow_load", "width_compression"}
KNOW_LAWS = {
    "fsrc/motion/film_series.f90",
    "fsrc/verdict/regime_check.f90",
    "fsrc/run/run_film.f90",
    "fsrc/run/check_report.f90",
}

# The only files below problem that name flanks or springs, by the equations that they hold. None is added;
# one that no longer names them leaves the list.
KNOW_FLANKS = {
    "Taylor series: what a law expands, and the ends that are checked, differ by flanks and springs": (
        "motion/film_series",
        "motion/lane_advance",
        "motion/many_motions",
        "motion/taylor_iso_viscous",
        "motion/taylor_piezo_viscous",
        "motion/taylor_reynolds_piezo",
        "motion/taylor_rupture",
    ),
    "implicit steps: residuals with films of both flanks, and with their springs": (
        "motion/collocation_newton",
        "motion/elastic_newton",
        "motion/elastic_step",
        "motion/elastic_tangents",
        "motion/elastic_trial",
        "motion/inner_equations",
    ),
    "steps of films in nodes: each flank has nodes, a gap and a deflection": (
        "motion/nodal_engine",
        "motion/nodal_profiles",
        "motion/nodal_start",
        "motion/nodal_state",
        "motion/nodal_step",
        "motion/nodal_tangent",
        "orbit/nodal_neighbours",
        "orbit/nodal_orbit",
    ),
    "rows of a block: what steps take of a lane, and which number of a state each row is": (
        "motion/lane_block",
        "motion/lane_state",
    ),
}
FLANKS = re.compile(
    r"flank(?!_contact|_elasticity)|coast|_drive\b|drive_|spring|compression|compliance|elastic_teeth",
    re.IGNORECASE,
)
NO_CODE = re.compile(r"""'[^']*'|"[^"]*"|!.*""")

MODULE = re.compile(r"^\s*module\s+(?!procedure\b)(\w+)", re.IGNORECASE)
USE = re.compile(r"^\s*use\s*(?:,\s*\w+\s*)?(?:::)?\s*(\w+)", re.IGNORECASE)
USE_OF_LAWS = re.compile(r"^\s*use film_law\b(?:, only:)?((?:&\n|[^&\n])*)", re.MULTILINE)
STOP = re.compile(r"^\s*(?:if\s*\(.*\)\s*)?(?:error\s+)?stop\b", re.IGNORECASE)


def module_of(path: Path) -> str:
    return path.relative_to("fsrc").parts[0]


def below_problem(folder: str) -> bool:
    return MODULES.index(folder) > MODULES.index("problem") and folder != "bindings"


def faults() -> list[str]:
    """One sentence per broken rule."""
    found = [f"{entry.name}: does not belong to the layout" for entry in Path().iterdir() if is_stray(entry)]
    if TABLE != MODULES:
        found.append(f"fsrc/README.md: its table of folders is {TABLE}, the Makefile has {MODULES}")
    sources = sorted(Path("fsrc").glob("*/**/*.f90"))
    found += [
        f"{body}: no module of its name includes it"
        for body in sorted(Path("fsrc").glob("*/**/*.inc"))
        if body.with_suffix(".f90") not in sources
        or f"include '{body.name}'" not in body.with_suffix(".f90").read_text()
    ]
    found += [
        f"fsrc/{folder}: a folder without a module" for folder in {*MODULES} - {*map(module_of, sources)}
    ]
    home = {path.stem.lower(): module_of(path) for path in sources}
    for path in sources:
        folder = module_of(path)
        if folder not in MODULES:
            found.append(f"{path}: {folder} is no folder of MODULES in the Makefile")
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            place = f"{path}:{number}"
            if (module := MODULE.match(line)) and folder != "bindings" and module[1].lower() != path.stem:
                found.append(f"{place}: module {module[1]} stands in a file of another name")
            used = use[1] if (use := USE.match(line)) else ""
            other = home.get(used.lower(), "")
            if other in MODULES and MODULES.index(other) > MODULES.index(folder):
                found.append(f"{place}: {folder} uses {used} of {other}, a folder below it")
            if STOP.match(line):
                found.append(f"{place}: a library routine stops the program")
    found += [*law_faults(sources), *flank_faults(sources)]
    if len(Path("fsrc/main.f90").read_text().splitlines()) > MAIN_LINES:
        found.append(f"fsrc/main.f90: more than {MAIN_LINES} lines")
    return [*found, *import_circles()]


def law_faults(sources: list[Path]) -> Iterator[str]:
    """Modules below problem that use more of film laws than what serves any, other than those of the list."""
    for path in sources:
        if module_of(path) not in MODULES or not below_problem(module_of(path)) or str(path) in KNOW_LAWS:
            continue
        for use in USE_OF_LAWS.finditer(path.read_text()):
            if not {*re.findall(r"\w+", use[1])} <= OF_ANY_LAW:
                yield f"{path}: knows film laws, which problem and its contacts keep from it"


def flank_faults(sources: list[Path]) -> Iterator[str]:
    """Modules below problem that name flanks or springs, other than those of the list."""
    listed = {f"fsrc/{name}.f90" for names in KNOW_FLANKS.values() for name in names}
    lower = [path for path in sources if module_of(path) in MODULES and below_problem(module_of(path))]
    for path in lower:
        first = next(places_of_flanks(path), None)
        if first and str(path) not in listed:
            yield f"{first}: names a flank or a spring, which problem and its contacts keep from it"
        if not first and str(path) in listed:
            yield f"{path}: names no flank and no spring; take it off the list KNOW_FLANKS"
    yield from (f"{name}: is on the list KNOW_FLANKS and not there" for name in listed - {*map(str, lower)})


def places_of_flanks(path: Path) -> Iterator[str]:
    """Lines of a module, and of the body that it includes, that name a flank or a spring."""
    for part in filter(Path.exists, (path, path.with_suffix(".inc"))):
        for number, line in enumerate(part.read_text().splitlines(), 1):
            if FLANKS.search(NO_CODE.sub("", line)):
                yield f"{part}:{number}"


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
    needs: dict[str, set[str]] = {}
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
