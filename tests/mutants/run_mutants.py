#!/usr/bin/env python3
"""Break the code in one place at a time and see whether a test notices.

    tests/mutants/run_mutants.py --since HEAD~20 --sample 40     # by the rules, in lines changed since then
    tests/mutants/run_mutants.py --listed [--only PATTERN]       # those of mutants.txt, which no rule makes

Each mutant is put into a scratch copy of the checkout. The file is compiled again, then the unit tests run,
then the user tests of its folder, then all others, until one fails: the mutant is killed. One that no test
notices has survived.
"""

from __future__ import annotations

import argparse
import csv
import math
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatch
from pathlib import Path

from rules import changes

REPOSITORY = Path(__file__).resolve().parents[2]
LIST = Path(__file__).with_name("mutants.txt")
# Optimised file by file: a file of which only the inside changes is compiled alone and linked anew.
FLAGS = "-O2 -march=x86-64-v3 -fno-math-errno -fno-trapping-math -fopenmp -fPIC"
# An endless loop is noticed: unit tests may take this many times their processor time, user tests so many s.
PATIENCE, USER_LIMIT = 6.0, 900.0
# A module, and the body of its procedures.
FORTRAN = (".f90", ".inc")
COLUMNS = ("number", "place", "reason", "outcome", "by", "seconds")
KILLED, SURVIVED, BROKEN = "killed", "survived", "does not build"
NEAR = "the tests near it"
# What the rules are applied to; tables of coefficients are no code.
MUTATED, TABLES = ("fsrc/*.f90", "fsrc/*.inc", "scripts/rattle/*.py"), "fsrc/film/coefficients/"

# The user tests that most likely see a mutant, by the beginning of the name of its file, else by its
# folder; the longest that fits counts.
TESTS_OF_FILES = {
    "signal": "signal_axes force_signal",
    "mistaken_units": "mistaken_units",
    "odd_numbers": "mistaken_units sensible_numbers",
    "input_difference": "edited_inputs drag carrying_on",
    "summary_file": "mistaken_units tasks logs",
    "short_report": "short_logs",
    "check_report": "two_flanks drag gear_inputs first_map",
    "scene_report": "two_flanks tooth_stiffness logs tasks",
    "scene_summary": "gear_inputs logs state_at_failure tasks",
    "run_sweep": "coarse_series logs tasks carrying_on run_endings",
    "judge_scene": "gearbox coarse_series rows_and_summaries",
    "judged_scene": "logs impacts separation rows_and_summaries tasks",
    "threshold": "thresholds threshold_scenes logs",
    "finer_windows": "rows_and_summaries coarse_series",
    "run_campaign": "logs campaigns carrying_on check_and_template commands",
    "nodal": "resolved",
    "scene_orbit": "coexisting_motions coexisting_rows",
    "other_motions": "coexisting_rows coexisting_motions rows_and_summaries",
    "handed_motions": "coexisting_rows coexisting_motions",
    "single_motions": "coexisting_motions",
    "window_motion": "coexisting_rows coexisting_motions rows_and_summaries",
    "core_time": "campaigns check_and_template commands thresholds",
    "table_task": "run_endings campaigns thresholds",
    "campaign_progress": "campaigns logs carrying_on run_endings",
    "main": "commands run_endings",
    "thresholds": "drawn_thresholds figure_words overlay_words report_words",
    "merge": "campaign_merge",
    "job_script": "campaign_scripts",
    "rerun": "report_words campaign_scripts",
    "exports": "campaign_scripts export*",
    "campaign_section": "drawn_campaigns campaign_map",
    "verdict": "classify_script",
}
TESTS_OF_FOLDERS = {
    "fsrc/foundation": "bad_inputs written_files campaigns carrying_on",
    "fsrc/scene": "refused_tasks columns bad_inputs check_and_template varied_keys tasks commands",
    "fsrc/film": "columns kernels* tasks scenes_at_rest",
    "fsrc/gear": "gear_inputs force_signal varied_keys",
    "fsrc/problem": "two_flanks elastic_teeth tooth_stiffness force_orders scenes_at_rest",
    "fsrc/motion": "columns tasks carrying_on varied_keys run_endings scenes_at_rest campaigns",
    "fsrc/orbit": "columns tasks scenes_at_rest",
    "fsrc/spectrum": "kernels_spectrum classify_script tasks",
    "fsrc/verdict": "kernels* tasks classify_script scenes_at_rest",
    "fsrc/files": "output_calls written_files carrying_on output_places run_endings campaigns full_disk",
    "fsrc/run": "columns refused_tasks tasks run_endings carrying_on commands check_and_template varied_keys",
    "fsrc/campaign": "varied_keys tooth_stiffness columns refused_tasks campaigns carrying_on odd_inputs",
    "fsrc/bindings": "kernels*",
    "scripts/rattle/figures": "drawn_* history coarse_series *figure_words overlay_words",
    "scripts/rattle/kernels": "kernels*",
    "scripts/rattle/report": "report_words report drawn_thresholds summaries_of_results",
    "scripts/rattle": "result_reader campaign_reader summaries drawn_campaigns",
    "scripts": "campaign_scripts",
    "fsrc/judgement": "columns tasks gearbox coarse_series rows_and_summaries coexisting_*",
}
# What the module of the kernels is made of.
KERNEL_ROOMS = ("fsrc/foundation", "fsrc/film", "fsrc/spectrum", "fsrc/verdict", "fsrc/bindings")


# They see neither the program nor its kernels.
PYTHON_ALONE = (
    "campaign_merge",
    "campaign_reader",
    "drawn_campaigns",
    "export",
    "generator",
    "result_reader",
    "summaries",
)
SCRIPT_MODULES = ("import rattle", "from rattle", "script_calls", "figure_files", "kernel_module")


class ListError(Exception):
    """The list of mutants cannot be used."""


@dataclass(frozen=True)
class Mutant:
    """One change of one file: its text, what it becomes, and what kind of mistake that is.

    The text begins at `start`, or stands there once only.
    """

    number: int
    path: str
    reason: str
    original: str
    changed: str
    start: int = -1

    def apply(self, text: str) -> str:
        if self.start >= 0:
            assert text.startswith(self.original, self.start)
            return text[: self.start] + self.changed + text[self.start + len(self.original) :]
        if text.count(self.original) != 1:
            raise ListError(
                f"mutant {self.number} ({self.path}, {self.reason}): its text stands there "
                f"{text.count(self.original)} times, not once:\n{self.original}"
            )
        return text.replace(self.original, self.changed)


def read_list(path: Path = LIST) -> list[Mutant]:
    """The mutants, in their order. Raises ListError for a block that is incomplete."""
    mutants = []
    for block in path.read_text(encoding="ascii").split("\n@ ")[1:]:
        head, *lines = block.splitlines()
        place, _, reason = head.partition(": ")
        parts: dict[str, list[str]] = {"-": [], "+": []}
        for line in lines:
            if line and not line.startswith("#"):
                parts.get(line[0], []).append(line[2:])
        original, changed = "\n".join(parts["-"]), "\n".join(parts["+"])
        number = len(mutants) + 1
        if not (reason and original and parts["+"]) or original == changed:
            raise ListError(f"mutant {number} ({head}) is incomplete")
        mutants.append(Mutant(number, place, reason, original, changed))
    keys = Counter((one.path, one.reason) for one in mutants)
    if keys.most_common(1)[0][1] > 1:
        raise ListError(f"two mutants have one name: {keys.most_common(1)[0][0]}")
    return mutants


def check(mutants: Sequence[Mutant], root: Path = REPOSITORY) -> list[str]:
    """A sentence for each mutant that does not apply exactly once to the present source."""
    faults = []
    for mutant in mutants:
        try:
            mutant.apply((root / mutant.path).read_text(encoding="utf-8"))
        except (ListError, OSError) as fault:
            faults.append(str(fault))
    return faults


def changed_lines(since: str) -> Iterator[tuple[str, set[int]]]:
    """The lines of each file that a revision has not, counted from 1."""
    command = ["git", "diff", "--unified=0", "--no-renames", "--no-ext-diff", since, "--", *MUTATED]
    ended = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=True)
    for part in ended.stdout.split("\n+++ b/")[1:]:
        path = part.partition("\n")[0]
        hunks = re.findall(r"^@@ -\S+ \+(\d+)(?:,(\d+))? @@", part, re.MULTILINE)
        lines = {line for first, count in hunks for line in range(int(first), int(first) + int(count or 1))}
        if lines and not path.startswith(TABLES):
            yield path, lines


def by_rule(since: str, seed: int) -> list[Mutant]:
    """All mutants of the changed lines in an order of chance: one of each line before a second."""
    dice = random.Random(seed)
    found = []
    for path, lines in changed_lines(since):
        text = (REPOSITORY / path).read_text(encoding="utf-8")
        made = changes(text, path.endswith(".py"), lines)
        dice.shuffle(made)
        of_rule: Counter[tuple[int, str]] = Counter()
        of_line: Counter[int] = Counter()
        ranked = []
        for change in made:
            line = text.count("\n", 0, change.start) + 1
            of_rule[line, change.rule] += 1
            ranked.append((of_rule[line, change.rule], line, change))
        for _, line, change in sorted(ranked, key=lambda one: one[0]):
            of_line[line] += 1
            original = text[change.start : change.end]
            reason = f"line {line}, {change.rule}: {_shown(original)} -> {_shown(change.text)}"
            mutant = Mutant(0, path, reason, original, change.text, start=change.start)
            found.append((of_line[line], dice.random(), mutant))
    order = sorted(found, key=lambda one: one[:2])
    return [replace(mutant, number=number) for number, (_, _, mutant) in enumerate(order, 1)]


def _shown(text: str) -> str:
    words = " ".join(text.split())
    return words if len(words) <= 60 else f"{words[:40]} ... {words[-15:]}"


class Scratch:
    """A copy of the checkout with a build of its own."""

    def __init__(self, place: Path, python: str) -> None:
        self.place = place
        self.python = python
        self.trusted: set[str] = set()
        self.blind: set[str] = set()
        self.environment = os.environ | {
            "RATTLE_PROGRAM": str(place / "build" / "rattle"),
            "SYSTEM_LOOKED_AT": "yes",
            "PYTHONDONTWRITEBYTECODE": "1",
            "GFORTRAN_UNBUFFERED_PRECONNECTED": "yes",
        }
        listed = self._run(["git", "ls-files", "-z"], cwd=REPOSITORY).stdout.split("\0")
        for name in filter(None, listed):
            source, target = REPOSITORY / name, place / name
            if source.exists() and (not target.exists() or target.read_bytes() != source.read_bytes()):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(source, target)
        gone = {path for path in place.glob("fsrc/**/*.*") if path.suffix in FORTRAN} - {
            place / name for name in listed
        }
        for path in gone | set(place.glob("tests/**/__pycache__")):
            path.unlink() if path.is_file() else shutil.rmtree(path)
        if not (place / ".venv").exists():
            (place / ".venv").symlink_to((REPOSITORY / ".venv").resolve())
        made = self.make("build/rattle", "build/unit_tests", "build/kernels/built")
        if made.returncode:
            raise SystemExit(f"The unchanged program cannot be built:\n{made.stderr[-2000:]}")
        self.unit_limit = round(USER_LIMIT)
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        if self.unit_tests():
            raise SystemExit("The unit tests fail on the unchanged program.")
        used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        self.unit_limit = math.ceil(PATIENCE * used)

    def _run(self, command: Sequence[str], limit: float = 3600.0, **options) -> subprocess.CompletedProcess:
        options = {"cwd": self.place, "env": self.environment, "text": True} | options
        return subprocess.run(command, capture_output=True, check=False, timeout=limit, **options)

    def make(self, *targets: str) -> subprocess.CompletedProcess:
        command = ["make", "--no-print-directory", "-j2", "-o", ".venv/installed", f"RELEASE_FLAGS={FLAGS}"]
        return self._run([*command, *targets])

    def compile(self, path: str) -> bool:
        """Build the programs with a file that was just changed; False if it does not compile.

        Where the interface that other files see is the same, they are not compiled again.
        """
        source, built = self.place / path, self._object(path)
        module = built.with_suffix(".mod")
        before, stamp = module.read_bytes() if module.exists() else b"", built.stat().st_mtime_ns
        for name in (built.name, "rattle", "unit_tests"):
            (built.parent / name).unlink(missing_ok=True)
        if self.make(f"build/{built.name}").returncode:
            return False
        if module.exists() and module.read_bytes() == before:
            os.utime(source, ns=(stamp - 1, stamp - 1))
            os.utime(built, ns=(stamp, stamp))
        return self.make("build/rattle", "build/unit_tests").returncode == 0

    def keep(self, path: str) -> list[Path]:
        """Copies of a file and of what is made of it alone, for `restore`."""
        built = self._object(path)
        made = (built, built.with_suffix(".mod")) if path.endswith(FORTRAN) else ()
        kept = [self.place / path, *(one for one in made if one.exists())]
        for one in kept:
            shutil.copy2(one, one.with_name(f"{one.name}.kept"))
        return kept

    def restore(self, kept: Sequence[Path]) -> None:
        """Bring the copies back; the files that saw another interface are compiled again."""
        module = kept[-1]
        alike = (
            module.exists() and module.read_bytes() == module.with_name(f"{module.name}.kept").read_bytes()
        )
        for one in kept:
            os.replace(one.with_name(f"{one.name}.kept"), one)
        if len(kept) > 1:  # what was linked with the mutant is not newer than what it is made of
            for name in ("rattle", "unit_tests"):
                (self.place / "build" / name).unlink(missing_ok=True)
        if module.suffix == ".mod" and not alike:
            kept[0].touch()
            self.make("build/rattle", "build/unit_tests")

    def _object(self, path: str) -> Path:
        return self.place / "build" / f"{Path(path).stem}.o"

    def make_kernels(self) -> bool:
        """Build the Python module of the kernels anew."""
        (self.place / "build" / "kernels" / "built").unlink(missing_ok=True)
        return self.make("build/kernels/built").returncode == 0

    def unit_tests(self) -> str:
        """The first failure, empty if there is none; what comes after it is not waited for."""
        limited = f"ulimit -t {self.unit_limit} && exec build/unit_tests"
        ended = subprocess.Popen(
            ["sh", "-c", limited], cwd=self.place, env=self.environment, text=True, stdout=subprocess.PIPE
        )
        patience = threading.Timer(USER_LIMIT, ended.kill)
        patience.start()
        try:
            for line in ended.stdout:
                if line.startswith("FAILED"):
                    return f"unit tests: {line.split(' ', 1)[1].partition(':')[0]}"
            return "unit tests" if ended.wait() else ""
        finally:
            patience.cancel()
            ended.kill()
            ended.wait()
            ended.stdout.close()

    def user_tests(self, files: Sequence[str], passed_over: Sequence[str] = ()) -> str:
        """The first test that fails, twice, so that a machine that is short of time kills no mutant."""
        if not files:
            return ""
        found = self._first_failure(files, passed_over)
        if "::" not in found or self._first_failure([f"tests/user/{found}"], ()):
            return found
        return self.user_tests(files, [*passed_over, found])

    def _first_failure(self, files: Sequence[str], passed_over: Sequence[str]) -> str:
        blind = [f"--deselect=tests/user/{name}" for name in sorted({*self.blind, *passed_over})]
        command = [self.python, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", *blind, *files]
        try:
            ended = self._run(command, USER_LIMIT)
        except subprocess.TimeoutExpired:
            return "time limit"
        failed = [line for line in ended.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
        words = failed[0].split(" ")[1].removeprefix("tests/user/") if failed else "pytest"
        return words.partition("[")[0] if ended.returncode else ""

    def sees_nothing(self, test: str) -> bool:
        """Whether a user test fails on the unchanged program too: then it proves nothing, and is left out."""
        if "::" not in test or test in self.trusted:
            return False
        self.make("build/rattle", "build/kernels/built")
        (self.blind if self.user_tests([f"tests/user/{test}"]) else self.trusted).add(test)
        return test in self.blind

    def files_near(self, path: str) -> tuple[list[str], ...]:
        """The files of user tests that most likely see a change of `path`, and all others."""
        folder = self.place / "tests" / "user"
        every = {found.stem.removeprefix("test_"): found for found in sorted(folder.glob("test_*.py"))}
        of_file = [start for start in TESTS_OF_FILES if Path(path).stem.startswith(start)]
        of_folder = [start for start in TESTS_OF_FOLDERS if path.startswith(start)]
        wishes = TESTS_OF_FOLDERS[max(of_folder, key=len)] if of_folder else ""
        wishes = TESTS_OF_FILES[max(of_file, key=len)] if of_file else wishes
        near = [name for wish in wishes.split() for name in every if fnmatch(name, wish)]
        # The test of the list would see every mutant, by its text.
        blind = {"mutants"}
        if path.startswith("scripts"):
            blind |= {name for name, file in every.items() if not calls_python(file)}
        elif not path.startswith(KERNEL_ROOMS):
            blind |= set(PYTHON_ALONE)
        rest = [name for name in every if name not in near and name not in blind]
        return tuple([f"tests/user/test_{name}.py" for name in names] for names in (near, rest))


def calls_python(file: Path) -> bool:
    """Whether a test uses the Python package or its scripts."""
    text = file.read_text(encoding="utf-8")
    return any(words in text for words in SCRIPT_MODULES)


def judge(mutant: Mutant, scratch: Scratch, near_only: bool) -> tuple[str, str]:
    """Outcome of one mutant, and the test that killed it."""
    target = scratch.place / mutant.path
    compiled = mutant.path.endswith(FORTRAN) and not mutant.path.startswith("fsrc/bindings")
    in_module = mutant.path.startswith(KERNEL_ROOMS)
    kept = scratch.keep(mutant.path)
    try:
        if not compiled:
            scratch.make("build/rattle")
        target.write_text(mutant.apply(target.read_text(encoding="utf-8")), encoding="utf-8")
        if compiled:
            if not scratch.compile(mutant.path):
                return BROKEN, ""
            found = scratch.unit_tests()
            if found:
                in_module = False  # the module was not made of it
                return KILLED, found
        if in_module and not scratch.make_kernels():
            return BROKEN, ""
        near, rest = scratch.files_near(mutant.path)
        found = scratch.user_tests(near) or ("" if near_only else scratch.user_tests(rest))
        return (KILLED, found) if found else (SURVIVED, NEAR if near_only else "")
    finally:
        scratch.restore(kept)
        if in_module:
            scratch.make_kernels()


def run(
    mutants: Sequence[Mutant], scratch: Scratch, path: Path, near_only: bool, sample: int
) -> Counter[str]:
    """Judge those that have no row in the CSV yet, one after another, and write a row for each.

    Those that do not build do not count to the sample.
    """
    outcomes: Counter[str] = Counter()
    path.parent.mkdir(parents=True, exist_ok=True)
    known = {(row["place"], row["reason"]) for row in rows_of(path)} if path.exists() else set()
    with path.open("a", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        if stream.tell() == 0:
            writer.writerow(COLUMNS)
        for mutant in mutants:
            if outcomes.total() - outcomes[BROKEN] >= sample:
                break
            if (mutant.path, mutant.reason) in known:
                continue
            started = time.monotonic()
            outcome, found = judge(mutant, scratch, near_only)
            while outcome == KILLED and scratch.sees_nothing(found):
                outcome, found = judge(mutant, scratch, near_only)
            seconds = f"{time.monotonic() - started:.0f}"
            writer.writerow([mutant.number, mutant.path, mutant.reason, outcome, found, seconds])
            stream.flush()
            print(f"{outcome:14s} {mutant.path}, {mutant.reason}  {found}", flush=True)
            outcomes[outcome] += 1
    return outcomes


def rows_of(path: Path) -> list[dict[str, str]]:
    """Results that stand in a CSV."""
    with path.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--since", default="HEAD~20", metavar="REV", help="rules are applied to lines newer than it"
    )
    parser.add_argument("--sample", type=int, default=40, metavar="N", help="so many of the mutants by rule")
    parser.add_argument("--seed", type=int, default=1, help="of the sample")
    parser.add_argument("--listed", action="store_true", help="the mutants of mutants.txt instead")
    parser.add_argument("--only", default="", metavar="PATTERN", help="those whose 'FILE: REASON' it matches")
    parser.add_argument(
        "--near", action="store_true", help="leave out the tests of other folders, which take minutes"
    )
    parser.add_argument("--scratch", type=Path, default=REPOSITORY / "build" / "mutants", metavar="DIR")
    parser.add_argument(
        "--check",
        action="store_true",
        help="see that every listed mutant applies once, or list those by rule",
    )
    options = parser.parse_args()
    mutants = read_list() if options.listed else by_rule(options.since, options.seed)
    mutants = [one for one in mutants if re.search(options.only, f"{one.path}: {one.reason}")]
    faults = check(mutants)
    if faults or options.check:
        names = [] if options.listed else [f"{one.path}: {one.reason}" for one in mutants]
        print("\n".join([*names, *faults]))
        print(f"{len(mutants)} mutants, of which {len(faults)} do not apply.")
        return 1 if faults else 0
    path = options.scratch / ("listed.csv" if options.listed else "sample.csv")
    if not options.listed:
        path.unlink(missing_ok=True)
        print(f"{len(mutants)} mutants by rule in the lines changed since {options.since}")
    scratch = Scratch(options.scratch.resolve(), sys.executable)
    outcomes = run(mutants, scratch, path, options.near, len(mutants) if options.listed else options.sample)
    print(", ".join(f"{count} {outcome}" for outcome, count in outcomes.items()))
    for row in rows_of(path):
        if row["outcome"] == SURVIVED:
            print(f"survived: {row['place']}, {row['reason']}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
