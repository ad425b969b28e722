"""How many files does a change touch?

Adds a toy of each kind to a scratch copy of the repository, builds the copy once, runs an input that uses
each toy, and prints how many files each of them took. The files that a change may edit and their greatest
number are read from the lists of fsrc/README.md. The exit code is 1 where a toy takes more files, does not
build, or does not do what it should.
"""

from __future__ import annotations

import argparse
import importlib
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
HEADING = r"^### Add (?P<what>[^\n]+) \(at most (?P<most>\d+) files\)\n"
LIST = re.compile(HEADING + r"(?P<text>.*?)(?=^#|\Z)", re.MULTILINE | re.DOTALL)
LISTED = re.compile(r"^\d+\. `([^`]+)`", re.MULTILINE)
# The toy of each list.
TOYS = {
    "a film law": "law",
    "a film law with a state of its own": "law_with_state",
    "a quantity": "quantity",
    "a key that campaigns may vary": "key",
    "a task": "task",
    "a figure": "figure",
}


class ToyError(Exception):
    """What a toy does that it may not, or does not do that it should."""


@dataclass
class Tree:
    """The scratch copy; it lets a toy edit the files of its list only."""

    root: Path
    listed: list[str]
    touched: set[str]

    def _path(self, name: str, *, new: bool = False) -> Path:
        # NAME stands for that of a new file.
        patterns = [
            re.escape(entry).replace("NAME", r"\w+") for entry in self.listed if ("NAME" in entry) == new
        ]
        if not any(re.fullmatch(pattern, name) for pattern in patterns):
            raise ToyError(f"it edits {name}, which its list in fsrc/README.md does not name")
        self.touched.add(name)
        return self.root / name

    def text(self, name: str) -> str:
        return self._path(name).read_text()

    def add(self, name: str, text: str) -> None:
        """A new file."""
        path = self._path(name, new=True)
        if path.exists():
            raise ToyError(f"{name} exists")
        path.write_text(text)

    def put(self, name: str, before: str, text: str) -> None:
        """Text before the one place that begins with `before`."""
        self.change(name, before, text + before)

    def change(self, name: str, old: str, new: str) -> None:
        path = self._path(name)
        text = path.read_text()
        if text.count(old) != 1:
            raise ToyError(f"{name} has {text.count(old)} times, not once: {old!r}")
        path.write_text(text.replace(old, new))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("scratch", type=Path, help="folder of the scratch copy, which is made anew")
    parser.add_argument("--only", choices=TOYS.values(), help="one toy alone")
    options = parser.parse_args()
    scratch = options.scratch.resolve()
    copy(REPOSITORY, scratch)
    chosen = [options.only] if options.only else list(TOYS.values())
    taken, faults = add_toys(scratch, chosen)
    print("\n".join(taken))
    faults = faults or build(scratch)
    if not faults:
        for what, toy in TOYS.items():
            faults += use(what, toy, scratch) if toy in chosen else []
    print("\n".join(faults), end="\n" if faults else "")
    return bool(faults)


def add_toys(scratch: Path, chosen: list[str]) -> tuple[list[str], list[str]]:
    """Let the chosen toys edit the copy: how many files each took, and what is wrong with that."""
    lists = {found["what"]: found for found in LIST.finditer((scratch / "fsrc/README.md").read_text())}
    if lists.keys() != TOYS.keys():
        return [], [f"fsrc/README.md has lists for {', '.join(lists)}; there are toys for {', '.join(TOYS)}"]
    taken, faults = [], []
    for what, toy in TOYS.items():
        if toy not in chosen:
            continue
        tree = Tree(scratch, LISTED.findall(lists[what]["text"]), set())
        try:
            importlib.import_module(toy).change(tree)
        except ToyError as fault:
            faults.append(f"{what}: {fault}")
        count, most = len(tree.touched), int(lists[what]["most"])
        taken.append(f"{what:36}{count:3d} files, at most {most}")
        if count > most:
            faults.append(f"{what}: {count} files, more than {most}")
    return taken, faults


def copy(repository: Path, scratch: Path) -> None:
    """All but what was built."""
    if scratch.exists():
        shutil.rmtree(scratch)
    unwanted = shutil.ignore_patterns("build", "results", ".git", ".venv*", "__pycache__")
    shutil.copytree(repository, scratch, ignore=unwanted)


def build(scratch: Path) -> list[str]:
    """What the compiler and the check of the layout say of the copy with all toys in it."""
    program = ["make", "--no-print-directory", f"-j{os.cpu_count()}", "STRICT=1", "build/rattle"]
    faults = []
    for command in (program, [*program[:-1], "pages"], [sys.executable, "scripts/check_layout.py"]):
        ended = subprocess.run(command, cwd=scratch, capture_output=True, text=True, check=False)
        if ended.returncode:
            faults.append(f"{' '.join(command[-2:])} fails:\n{(ended.stderr or ended.stdout)[:3000]}")
            break
    return faults


def use(what: str, toy: str, scratch: Path) -> list[str]:
    """Run the input of a toy in a folder of its own and look at what comes of it."""
    folder = scratch / "results" / toy
    folder.mkdir(parents=True)
    module = importlib.import_module(toy)
    (folder / f"{toy}.nml").write_text(module.INPUT)
    command = [str(scratch / "build/rattle"), "--quiet", "--output", ".", f"{toy}.nml"]
    ended = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if ended.returncode:
        return [f"{what}: its input ends with exit code {ended.returncode}: {ended.stderr.strip()}"]
    try:
        module.look(folder, scratch)
    except ToyError as fault:
        return [f"{what}: {fault}"]
    return []


if __name__ == "__main__":
    # The toys know this file by its name, not as the program that runs.
    sys.modules["run_touched"] = sys.modules["__main__"]
    sys.exit(main())
