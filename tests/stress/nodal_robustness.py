"""Random loose gears with their films in nodes: which stop, how long they take, what is verified wrongly.

    python tests/stress/nodal_robustness.py build/rattle rows.csv [--scenes 2000] [--heavy 500]
                                                                  [--seconds 2400]
    python tests/stress/nodal_robustness.py --table rows.csv

Gears are those of closure_errors.py; heavy ones are shaken with 40 to 400 m/s2, and kept if the closure shows
a largest load M = W/(E* R eps^2 l) from 2 to 12. Four periods from rest are solved in 32 nodes, the last two
judged and verified in 64; one in five once more in 128 nodes at an accuracy of 1e-3, for which neighbours
of a motion off its harmonics are not followed: that takes minutes. A verified verdict, or class, that differs
from that of 128 nodes is wrong; classes off the harmonics count as one. A row is appended for each scene, so
that a study goes on where it was left.
"""

from __future__ import annotations

import argparse
import collections
import csv
import math
import random
import resource
import sys
from pathlib import Path

from closure_errors import film_of, peak_of, scene_of, solved

FOLLOWED = {"solver.periods": 4, "spectrum.periods": 2, "solver.time_limit": 60.0}
COARSE = {"film.nodes": 32, "solver.accuracy": 1e-2}
VERIFIED = {**FOLLOWED, **COARSE, "film.model": "resolved", "spectrum.verify": True}
FINE = {"film.nodes": 128, "solver.accuracy": 1e-3, "spectrum.irregular_limit": 1.0}
REFERENCE = {**FOLLOWED, "film.model": "resolved", **FINE}
IRREGULAR_LIMIT = 0.01
OFF_HARMONICS = ("irregular", "irregular_so_far", "subharmonic")
REFERENCE_OF = 5
HEAVY = (2.0, 12.0)
CLASSES = ((0.0, 0.15), (0.15, 2.0), (2.0, 6.0), (6.0, 12.0), (12.0, math.inf))
CLASS_NAMES = ("rattle_class", "reference_class")
FIELDS = (
    *("kind", "number", "law", "load", "status", "reference", "seconds", "verdict", "verdict_verified"),
    *("reference_verdict", "rattle_class", "class_verified", "reference_class"),
    *("peak_error", "peak_error_reported", "film_error", "film_error_reported"),
)


def heavy_scene_of(number: int) -> tuple[dict, float]:
    """A gear that is shaken harder, and the load that M counts in [N]."""
    scene, unit = scene_of(number)
    draw = random.Random(-number)
    share = math.exp(draw.uniform(math.log(40.0), math.log(400.0)))
    share /= scene["load"]["force_amplitudes"][0] / scene["load"]["mass"]
    scene["load"]["steady_force"] *= share
    scene["load"]["force_amplitudes"] = [share * force for force in scene["load"]["force_amplitudes"]]
    return scene, unit


def load_of(reported: dict, unit: float) -> float:
    """Largest load M of both flanks."""
    return max(reported["load_maximum"], reported["coast_load_maximum"]) / unit


def row_of(kind: str, number: int, program: Path) -> dict | None:
    """What a scene reports; nothing of a heavy one that is not heavy."""
    scene, unit = (heavy_scene_of if kind == "heavy" else scene_of)(number)
    closure = solved(scene, {**FOLLOWED, "film.model": "closure", "solver.starts": 1}, program)
    row: dict = dict.fromkeys(FIELDS, "")
    row.update(kind=kind, number=number, law=scene["lubricant"]["viscosity_law"])
    if closure["status"] == "complete":
        row["load"] = load_of(closure, unit)
    if kind == "heavy" and not (row["load"] != "" and HEAVY[0] <= row["load"] <= HEAVY[1]):
        return None
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    reported = solved(scene, VERIFIED, program)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    row["seconds"] = round(after.ru_utime - before.ru_utime, 3)
    row["status"] = reported["status"]
    if reported["status"] != "complete":
        return row
    row["load"] = load_of(reported, unit)
    row.update(verdict=reported["verdict"], rattle_class=reported["rattle_class"])
    row["verdict_verified"] = int(bool(reported.get("verdict_verified", False)))
    row["class_verified"] = int(reported.get("verification") == "verified")
    if number % REFERENCE_OF != 0:
        return row
    finer = solved(scene, REFERENCE, program)
    row["reference"] = finer["status"]
    if finer["status"] != "complete":
        return row
    off = finer["irregular_fraction"] > IRREGULAR_LIMIT
    row.update(reference_verdict=finer["verdict"])
    row.update(reference_class=OFF_HARMONICS[0] if off else finer["rattle_class"])
    row["peak_error"] = abs(peak_of(reported) / peak_of(finer) - 1.0)
    row["film_error"] = abs(film_of(reported) / film_of(finer) - 1.0)
    row["peak_error_reported"] = reported.get("acceleration_error", "")
    row["film_error_reported"] = reported.get("film_error", "")
    return row


def is_wrong(row: dict) -> bool:
    """Whether what is verified is not what 128 nodes show."""
    if row["reference"] != "complete":
        return False
    wrong_verdict = row["verdict_verified"] == "1" and row["verdict"] != row["reference_verdict"]
    classes = {OFF_HARMONICS[0] if row[name] in OFF_HARMONICS else row[name] for name in CLASS_NAMES}
    return wrong_verdict or (row["class_verified"] == "1" and len(classes) > 1)


def stop_of(words: str) -> str:
    """Name of how a scene stopped."""
    for name in ("film_cycles", "film_torn", "time_limit", "film_lost", "not_converged", "overflow"):
        if name in words:
            return name
    return words


def share_of(part: int, whole: int) -> str:
    return f"{part} ({100.0 * part / whole:.1f} %)" if part else "0"


def table_of(rows: list[dict]) -> list[str]:
    """Stops, verified and wrong verdicts, and times, by the largest load."""
    names = (
        "scenes",
        "stopped",
        "verdict verified",
        "class verified",
        "of 128 nodes",
        "wrong",
        "128 stopped",
    )
    lines = [
        "| gears | M | " + " | ".join(names) + " | seconds, median | most |",
        "|---|---|" + "---:|" * (len(names) + 2),
    ]
    for kind in ("random", "heavy"):
        for low, high in CLASSES:
            chosen = [
                row
                for row in rows
                if row["kind"] == kind and row["load"] and low <= float(row["load"]) < high
            ]
            if not chosen:
                continue
            n = len(chosen)
            done = [row for row in chosen if row["status"] == "complete"]
            seconds = sorted(float(row["seconds"]) for row in chosen)
            cells = [
                kind,
                f"{low:g} to {high:g}" if high < math.inf else f"above {low:g}",
                str(n),
                share_of(n - len(done), n),
                share_of(sum(row["verdict_verified"] == "1" for row in done), n),
                share_of(sum(row["class_verified"] == "1" for row in done), n),
                str(sum(row["reference"] == "complete" for row in done)),
                str(sum(is_wrong(row) for row in done)),
                str(sum(row["reference"] not in ("complete", "") for row in done)),
                f"{seconds[n // 2]:.2f}",
                f"{seconds[-1]:.1f}",
            ]
            lines.append("| " + " | ".join(cells) + " |")
    return lines


def tell(path: Path) -> None:
    """Print the table, stops by name, and scenes that were wrong."""
    with path.open(newline="") as lines:
        rows = list(csv.DictReader(lines))
    print("\n".join(table_of(rows)))
    stops = collections.Counter(
        (row["kind"], stop_of(row["status"])) for row in rows if row["status"] != "complete"
    )
    for (kind, name), count in sorted(stops.items()):
        print(f"{kind}: {count} stopped, {name}")
    for row in rows:
        if is_wrong(row):
            print("wrong:", ", ".join(f"{name} {row[name]}" for name in FIELDS if row[name] != ""))


def main() -> None:
    """Solve the scenes, or report of those that were solved."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("program", type=Path, nargs="?")
    parser.add_argument("rows", type=Path)
    parser.add_argument("--table", action="store_true", help="solve nothing, tell of the rows")
    parser.add_argument("--scenes", type=int, default=2000)
    parser.add_argument("--heavy", type=int, default=500)
    parser.add_argument(
        "--seconds", type=float, default=math.inf, help="processor time after which no scene begins"
    )
    options = parser.parse_args()
    if options.table:
        tell(options.rows)
        return
    done: dict[str, list[int]] = {"random": [], "heavy": []}
    if options.rows.exists():
        with options.rows.open(newline="") as lines:
            for row in csv.DictReader(lines):
                done[row["kind"]].append(int(row["number"]))
    else:
        options.rows.write_text(",".join(FIELDS) + "\n")
    counts = {kind: len(numbers) for kind, numbers in done.items()}
    following = {kind: max(numbers, default=0) + 1 for kind, numbers in done.items()}
    wanted = {"random": options.scenes, "heavy": options.heavy}
    while any(counts[kind] < wanted[kind] for kind in wanted):
        if sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2]) > options.seconds:
            break
        # Both kinds in proportion, so that a study that is cut short has both.
        kind = min(wanted, key=lambda name: (counts[name] + 1) / max(wanted[name], 1e-9))
        row = row_of(kind, following[kind], options.program)
        following[kind] += 1
        if row is None:
            continue
        counts[kind] += 1
        with options.rows.open("a", newline="") as lines:
            csv.DictWriter(lines, FIELDS).writerow(row)
        if row["status"] != "complete" or is_wrong({name: str(value) for name, value in row.items()}):
            print({name: value for name, value in row.items() if value != ""}, file=sys.stderr)
    tell(options.rows)


if __name__ == "__main__":
    main()
