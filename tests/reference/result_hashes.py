"""Do two builds write the same results? Hashes of what many runs write, compared with those of another build.

    python tests/reference/result_hashes.py build/rattle --write build/hashes.json
    python tests/reference/result_hashes.py build/rattle --against build/hashes.json [--quick]

Runs are the ready inputs, long campaigns with fewer scenes, the bad inputs, single scenes with several starts
and with films in nodes, sweeps, thresholds, campaigns and gearboxes with one thread and two, in parts and
resumed after a signal or a time limit, and random scenes of the studies of stress. Hashed are columns and
headers of results and states, keys of summaries, exit codes and lines of messages, without versions,
checksums, paths and times. The hashes depend on the processor, so they are not kept in the repository. The
exit code is 1 if there is a difference.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
INPUT, BAD = REPOSITORY / "input", REPOSITORY / "tests" / "bad_inputs"
sys.path.insert(0, str(REPOSITORY / "scripts"))
sys.path.insert(0, str(REPOSITORY / "tests" / "stress"))
sys.path.insert(0, str(REPOSITORY / "tests" / "user"))

import gear_rows  # noqa: E402
import numpy as np  # noqa: E402
import reported_alike  # noqa: E402
from waiting import let_work  # noqa: E402

from rattle.result_header import read_header  # noqa: E402

# What a run writes: for each of its parts a hash. Parts are columns, keys and lines.
Hashes = dict[str, str]

LIMIT = 900.0
# Ready inputs that take long, with fewer scenes.
FEWER = {
    "gearbox_map": "campaign.count=2,2 campaign.first=1200,40 campaign.last=1400,60 solver.accuracy=1e-6",
    "gearbox_orders": "campaign.count=5",
    "gearbox_threshold": "campaign.count=2 threshold.count=3 threshold.tolerance=0.1 threshold.first=30",
    "gearbox_tolerances": "campaign.size=32",
    "map": "campaign.count=24,24",
}
# Settings, and -keys whose lines are left out of the input.
TAYLOR = "-method -iteration -predictor -tolerance -steps_per_period"
# More runs of ready inputs: name, input, settings.
SINGLE_SCENES = (
    *(
        (f"{name} starts {starts}", name, f"solver.starts={starts}")
        for name in ("drive_rattle", "engine_cycle", "gearbox", "loose_gear", "loose_pair", "two_motions")
        for starts in (1, 3)
    ),
    ("creep taylor 29", "creep", f"{TAYLOR} solver.starts=29"),
    ("idle taylor 29", "idle", f"{TAYLOR} solver.starts=29"),
    ("idle taylor steady", "idle", f"{TAYLOR} solver.until=steady solver.starts=3"),
    (
        "idle successive",
        "idle",
        "solver.iteration=successive solver.predictor=previous solver.tolerance=1e-9",
    ),
    ("idle few iterations", "idle", "solver.iteration_limit=1"),
    ("idle rupture solved", "idle", f"{TAYLOR} film.rupture=solved"),
    ("idle rupture successive", "idle", "film.rupture=solved film.rupture_solver=successive"),
    ("idle reynolds", "idle", f"{TAYLOR} -rupture film.model=reynolds solver.accuracy=1e-10"),
    ("creep reynolds", "creep", f"{TAYLOR} film.model=reynolds"),
    ("idle no series", "idle", "output.series=false solver.periods=40"),
    ("idle stride", "idle", "output.stride=7 spectrum.verify=false"),
    ("loose_gear periods", "loose_gear", "solver.until=periods solver.periods=30"),
    ("drive_rattle irregular", "drive_rattle", "load.force_scale=6 solver.periods=60 solver.starts=3"),
    ("drive_rattle no time", "drive_rattle", "solver.time_limit=1e-9"),
    ("elastohydrodynamic nodes", "elastohydrodynamic", "film.model=resolved"),
    (
        "elastohydrodynamic 64 nodes",
        "elastohydrodynamic",
        "film.model=resolved film.nodes=64 spectrum.verify=false",
    ),
    ("elastohydrodynamic automatic", "elastohydrodynamic", "film.model=automatic"),
    ("drive_rattle nodes", "drive_rattle", "film.model=resolved output.profiles=true film.nodes=24"),
    ("drive_rattle automatic", "drive_rattle", "film.model=automatic solver.starts=3"),
    (
        "drive_rattle automatic hard",
        "drive_rattle",
        "film.model=automatic load.force_scale=8 solver.starts=1",
    ),
    ("sweep one way", "sweep", "sweep.turn=false sweep.count=61 solver.accuracy=1e-6"),
    ("sweep of forces", "sweep", "sweep.key=force_amplitude sweep.first=5 sweep.last=60 sweep.count=41"),
    ("stiff_or_not piezo", "stiff_or_not", "film.law=piezo-viscous sweep.count=21"),
    ("stiff_or_not reynolds", "stiff_or_not", "film.model=reynolds sweep.count=21"),
    ("film numerical", "film", "film.model=numerical points.cells=64 -compute"),
)
CAMPAIGN = "scene.task=campaign campaign.vary=load.force_scale campaign.first=0.5 -columns"
TABLES = (
    ("map creep", "map", "film.law=piezo-viscous campaign.count=12,12"),
    ("map everything", "map", "campaign.count=7,7 campaign.record=EVERYTHING"),
    ("map 29 starts", "map", "campaign.count=7,7 solver.starts=29"),
    ("map 1 start", "map", "campaign.count=16,16 solver.starts=1"),
    ("map all periods", "map", "campaign.count=9,9 solver.until=periods solver.periods=60"),
    ("map loose", "map", "campaign.count=9,9 solver.accuracy=1e-2"),
    ("map alone", "map", "campaign.count=9,9 campaign.neighbours=false"),
    ("map sobol", "map", "campaign.sample=sobol campaign.size=40 -count"),
    (
        "map reynolds",
        "map",
        "campaign.count=4,4 film.model=reynolds contact.backlash=1e-4 contact.stiffness=2e8",
    ),
    ("drive rows", "drive_rattle", f"{CAMPAIGN} campaign.last=3 campaign.count=6"),
    (
        "drive rows automatic",
        "drive_rattle",
        f"{CAMPAIGN} campaign.last=2 campaign.count=3 film.model=automatic",
    ),
    ("threshold impacts", "threshold", "campaign.count=9 threshold.criterion=impacts contact.backlash=2e-5"),
    (
        "threshold level",
        "threshold",
        "campaign.count=9 threshold.criterion=film_minimum threshold.level=5e-7",
    ),
    ("threshold class", "threshold", "campaign.count=7 threshold.criterion=class threshold.tolerance=1e-2"),
)
QUICK_TABLES = ("map everything", "drive rows", "drive rows automatic", "threshold class")
TOGETHER = ("idle", "creep", "loose_gear", "loose_pair", "engine_cycle")
NEWMARK = "solver.method=newmark solver.steps_per_period=256"
EVERY_THREADS = (1, 2)
# Keys of a summary that are another each time, or with another version.
PASSING = re.compile(r"wall_seconds|program_version|(\w+_)?checksum|(\w+_)?per_second")
# Numbers in messages that are times, and the version.
TIMES = (
    (re.compile(r"\b\d[\d.]*(E[-+]?\d+)? (s|ms|min|h|seconds?)\b"), "TIME"),
    (re.compile(r"rattle \d+\.\d+\.\d+"), "rattle VERSION"),
)
# What is printed now and then, and how long a check expects a campaign to take.
PASSING_LINES = re.compile(r" +\w+ +\d+ of \d+.*(a second|s left).*|! core time.*")


@dataclass(frozen=True)
class Case:
    """A run, or several in one folder of which the last counts."""

    name: str
    # Options and inputs of each call.
    calls: tuple[tuple[str, ...], ...]
    # Files that are written before.
    files: dict[str, str] = field(default_factory=dict)
    # A signal comes after so much processor time of the first call [s], 0: none does.
    cut_after: float = 0.0
    quick: bool = False
    stdin: str = ""

    @property
    def resumed(self) -> bool:
        """What a cut run says depends on where it was cut; its result does not."""
        return "--resume" in self.calls[-1]


def settings(words: str) -> tuple[str, ...]:
    """--set for each of the settings."""
    return tuple(word for setting in words.split() for word in ("--set", setting))


def ready(name: str) -> str:
    return str(INPUT / f"{name}.nml")


def case_of(title: str, name: str, words: str, *options: str, before: str | None = None, **rest) -> Case:
    """A ready input with settings, and without the lines of the keys that stand there as -key.

    With `before` a call with these settings comes first, which the last one carries on.
    """
    dropped = [word[1:] for word in words.split() if word.startswith("-")]
    words = " ".join(word for word in words.split() if not word.startswith("-"))
    files, path = {}, ready(name)
    if dropped:
        lines = Path(path).read_text().splitlines(keepends=True)
        kept = [line for line in lines if not re.match(rf" +({'|'.join(dropped)})\b", line)]
        path = f"{name}.nml"
        files[path] = "".join(kept)
    call = (*options, *settings(words), path)
    if before is None:
        return Case(title, (call,), files, **rest)
    first = ("--quiet", "--threads", "1", *settings(f"{words} {before}"), path)
    return Case(title, (first, ("--resume", "--quiet", *call)), files, **rest)


def ready_cases(record: str) -> Iterator[Case]:
    """Ready inputs, and more runs of them."""
    for name in sorted(path.stem for path in INPUT.glob("*.nml")):
        yield Case(f"{name}, checked", (("--check", ready(name)),), quick=True)
        quick = name not in ("gearbox_map", "gearbox_threshold", "two_motions")
        yield from both(name, name, FEWER.get(name, ""), quick)
    for title, name, words in SINGLE_SCENES:
        quick = name not in ("gearbox", "two_motions") and not title.endswith("hard")
        yield case_of(title, name, words, "--threads", "2", quick=quick)
    for title, name, words in TABLES:
        yield from both(title, name, words.replace("EVERYTHING", record), title in QUICK_TABLES)
    for threads in EVERY_THREADS:
        call = ("--threads", str(threads), *map(ready, TOGETHER))
        yield Case(f"together, threads {threads}", (call,))
    yield Case("standard input", (("-",),), stdin=Path(ready("loose_gear")).read_text(), quick=True)


def both(title: str, name: str, words: str, quick: bool) -> Iterator[Case]:
    """With one thread and with two."""
    for threads in EVERY_THREADS:
        full = f"{title}, threads {threads}"
        yield case_of(full, name, words, "--threads", str(threads), quick=quick and threads == 2)


def carried_on_cases() -> Iterator[Case]:
    """Runs in parts, and runs that were cut and go on."""
    for part in (1, 2, 3):
        words = f"campaign.count=12,12 campaign.parts=3 campaign.part={part}"
        yield case_of(f"map, part {part} of 3", "map", words, quick=part == 2)
    for name, words, seconds in (
        ("map", "campaign.count=24,24", 0.15),
        ("map", "campaign.count=12,12 solver.starts=29", 0.1),
        ("gearbox_orders", "campaign.count=5", 0.8),
        ("threshold", "campaign.count=41", 0.3),
        ("gearbox", "solver.starts=3", 0.4),
        ("drive_rattle", "film.model=resolved", 0.2),
        ("two_motions", "solver.starts=3", 0.6),
    ):
        title, quick = f"{name} {words}, cut and resumed", name == "map"
        yield case_of(title, name, words, "--threads", "2", before="", cut_after=seconds, quick=quick)
    for name, words in (("loose_pair", ""), ("idle", ""), ("idle", f"{TAYLOR} solver.starts=3")):
        for before in ("solver.periods=17", "solver.time_limit=1e-9"):
            yield case_of(f"{name} {words} {before}, resumed", name, words, before=before, quick=True)


def stress_cases(program: Path, record: str, groups: int, gears: int) -> Iterator[Case]:
    """Random scenes alone, as rows of a campaign, and as values of a sweep."""
    variants = ("", "solver.starts=1", "solver.starts=3", NEWMARK)
    for number in range(1, groups + 1):
        shared, scenes = reported_alike.draw(number)
        for place, scene in enumerate(scenes):
            words = variants[(place + number) % len(variants)]
            text = reported_alike.input_text(shared, scene, "")
            if words == NEWMARK:
                rigid = "stiffness" not in text
                words = words if rigid else ""
                text = re.sub(r"samples_per_period = \d+, until = '\w+', ", "", text) if rigid else text
            title = f"stress group {number}, scene {place + 1}"
            call = ("--quiet", *settings(words), "scene.nml")
            yield Case(title, (call,), {"scene.nml": text}, quick=number <= 2)
        names = list(scenes[0])
        rows = "".join(",".join(repr(scene[name]) for name in names) + "\n" for scene in scenes)
        campaign = (
            "&scene task = 'campaign' /\n"
            f"&campaign csv = 'rows.csv', allow_invalid = T, samples_per_period = 512, record = {record} /"
        )
        files = {
            "rows.csv": ",".join(names) + "\n" + rows,
            "many.nml": reported_alike.input_text(shared, scenes[0], campaign),
        }
        yield Case(f"stress group {number}, rows", (("--quiet", "many.nml"),), files, quick=number <= 2)
        amplitude = scenes[0]["load.force_amplitude"]
        sweep = (
            "&scene task = 'sweep' /\n&sweep key = 'force_amplitude', "
            f"first = {amplitude!r}, last = {1.5 * amplitude!r}, count = 5 /"
        )
        text = reported_alike.input_text(re.sub(r"until = '\w+', ", "", shared), scenes[0], sweep)
        yield Case(
            f"stress group {number}, sweep",
            (("--quiet", "swept.nml"),),
            {"swept.nml": text},
            quick=number <= 2,
        )
    table = gear_rows.numeric_keys(program)
    for number in range(1, gears + 1):
        case = gear_rows.draw(number, table)
        rows = "".join(",".join(repr(value) for value in row) + "\n" for row in case.values)
        campaign = (
            "&scene task = 'campaign' /\n&campaign csv = 'rows.csv', allow_invalid = T\n"
            f"samples_per_period = 512\nrecord = {record} /\n"
        )
        files = {
            "cycle.csv": case.signal,
            "rows.csv": ",".join(case.keys) + "\n" + rows,
            "many.nml": case.text + campaign,
            "one.nml": case.text,
        }
        for name in ("many.nml", "one.nml"):
            yield Case(f"stress gear {number}, {name}", (("--quiet", name),), files, quick=number <= 3)


def all_cases(program: Path) -> Iterator[Case]:
    record = ",".join(recordable(program))
    for option in ("--help", "--keys", "--quantities", "--template"):
        yield Case(f"rattle {option}", ((option,),), quick=True)
    for path in sorted(BAD.glob("*.nml")):
        yield Case(f"bad input {path.stem}", ((str(path),),), quick=True)
    yield from ready_cases(record)
    yield from carried_on_cases()
    yield from stress_cases(program, ", ".join(f"'{name}'" for name in record.split(",")), groups=5, gears=8)


def recordable(program: Path) -> list[str]:
    """Every quantity that a row can hold."""
    page = subprocess.run([program, "--keys"], capture_output=True, text=True, check=True).stdout
    (line,) = (line for line in page.splitlines() if line.startswith("| `record` |"))
    return re.findall(r"'(\w+)'", line.split("|")[4])


def short(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


def hashes_of_result(path: Path) -> Hashes:
    """Columns of a result or a state, its header and what is behind the rows."""
    data = path.read_bytes()
    with path.open("rb") as stream:
        header = read_header(stream, path)
    words = data[: header.header_bytes]
    hashes = {"header": short(words[:40] + words[64:72] + words[80:])}
    rows = max(header.row_count, 0)
    end = header.header_bytes + rows * header.row_bytes
    numbers = np.frombuffer(data[header.header_bytes : end], dtype="<i8").reshape(rows, len(header.names))
    hashes |= {name: short(numbers[:, place].tobytes()) for place, name in enumerate(header.names)}
    return hashes | {"behind the rows": short(data[end:])}


def hashes_of_summary(path: Path) -> Hashes:
    """The keys of a summary, in their order, and each of them with all lines of its value."""
    keys: dict[str, str] = {}
    group, key = "", ""
    for line in path.read_text().splitlines():
        begun = re.match(r" +(\w+) = ", line)
        if line.startswith("&"):
            group = f"{line[1:]} {sum(name.endswith(' begins') for name in keys) + 1} "
            keys[f"{group}begins"] = line
        elif begun:
            key = group + begun[1]
            keys[key] = line
        elif line.startswith(" "):
            keys[key] += line
    kept = {name: text for name, text in keys.items() if not PASSING.fullmatch(name.split(" ")[-1])}
    return {"keys": short(" ".join(kept).encode())} | {
        name: short(text.encode()) for name, text in kept.items()
    }


def hashes_of_text(text: str, folder: Path) -> Hashes:
    """The lines of what was printed, without times and paths."""
    lines = [line for line in text.splitlines() if not PASSING_LINES.fullmatch(line)]
    text = "\n".join(lines)
    for place in (folder, REPOSITORY):
        text = text.replace(f"{place}/", "")
    for pattern, word in TIMES:
        text = pattern.sub(word, text)
    lines = text.splitlines()
    return {"lines": str(len(lines))} | {f"line {i}": short(line.encode()) for i, line in enumerate(lines, 1)}


def call(program: Path, words: tuple[str, ...], folder: Path, case: Case, cut: bool) -> tuple[int, str, str]:
    """Exit code, what was printed, and the faults."""
    process = subprocess.Popen(
        [program, *words],
        cwd=folder,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    if cut:
        let_work(process, case.cut_after)
        process.send_signal(signal.SIGTERM)
    printed, faults = process.communicate(case.stdin, timeout=LIMIT)
    return process.returncode, printed, faults


def hashes_of_case(program: Path, case: Case) -> dict[str, Hashes]:
    """What a run leaves, by file."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place).resolve()
        for name, text in case.files.items():
            (folder / name).write_text(text)
        for number, words in enumerate(case.calls):
            cut = case.cut_after > 0.0 and number == 0
            code, printed, faults = call(program, words, folder, case, cut)
        found = {"exit code": {"code": str(code)}, "faults": hashes_of_text(faults, folder)}
        if not case.resumed:
            found["messages"] = hashes_of_text(printed, folder)
        for path in sorted(folder.glob("results/*")):
            if path.suffix in (".rattle", ".state"):
                found[path.name] = hashes_of_result(path)
            elif path.name.endswith(".summary.nml") and not case.resumed:
                found[path.name] = hashes_of_summary(path)
    return found


def differences(old: dict, new: dict) -> Iterator[str]:
    """A line for each file of each case that differs, with the parts of it that do."""
    for name in [*old, *(name for name in new if name not in old)]:
        if name not in old or name not in new:
            yield f"{name}: only in {'the first' if name in old else 'these results'}"
            continue
        for file in [*old[name], *(file for file in new[name] if file not in old[name])]:
            before, after = old[name].get(file), new[name].get(file)
            if before is None or after is None:
                yield f"{name}: {file} {'is new' if before is None else 'is missing'}"
                continue
            parts = [
                part
                for part in [*before, *(p for p in after if p not in before)]
                if before.get(part) != after.get(part)
            ]
            if parts:
                rest = f" and {len(parts) - 12} more" if len(parts) > 12 else ""
                yield f"{name}: {file}: {', '.join(parts[:12])}{rest}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--write", type=Path, metavar="FILE", help="write the hashes")
    parser.add_argument("--against", type=Path, metavar="FILE", help="print what differs from these hashes")
    parser.add_argument("--quick", action="store_true", help="a sample, about a minute of one core")
    parser.add_argument("--only", default="", metavar="PATTERN", help="runs whose name it matches")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="runs side by side")
    parser.add_argument("--list", action="store_true", help="print the names of the runs")
    options = parser.parse_args()
    program = options.program.resolve()
    cases = [case for case in all_cases(program) if re.search(options.only, case.name)]
    assert len({case.name for case in cases}) == len(cases)
    if options.quick:
        cases = [case for case in cases if case.quick]
    if options.list:
        print("\n".join(case.name for case in cases))
        return 0
    with ThreadPoolExecutor(options.jobs) as pool:
        found = dict(
            zip(
                (case.name for case in cases),
                pool.map(lambda one: hashes_of_case(program, one), cases),
                strict=True,
            )
        )
    if options.write:
        options.write.write_text(json.dumps(found, indent=0) + "\n")
    lines: list[str] = []
    if options.against:
        old = json.loads(options.against.read_text())
        chosen = {case.name for case in cases}
        partly = options.quick or options.only
        lines = list(differences({n: h for n, h in old.items() if n in chosen or not partly}, found))
        print("\n".join(lines) or f"the same: {len(cases)} runs")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
