"""What a computed drag costs a map: the same scenes with the drag computed, and with its value given.

    bench_drag.py PROGRAM [--rounds N] [--count N]

The second pair of `input/gearbox_map.nml` at N speeds and N oil temperatures, as it is and with the cheapest
film there is for it. The rows of both runs have to be the same motions. Prints a Markdown table of processor
times, medians of interleaved rounds.
"""

from __future__ import annotations

import argparse
import csv
import re
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "scripts"))

import rattle  # noqa: E402

READY = REPOSITORY / "input/gearbox_map.nml"
TABLE = "gearbox_run_up.csv"
SPEED, TEMPERATURE, DRAG = "shaft.speed_rpm", "oil.temperature_celsius", "gear.drag_torque"
PARTS = re.compile(r"\b(bearing_mean_diameter|synchroniser_\w+|immersion_depth) *= *[^,!\n]*,?")
CASES = {
    "as it is": (),
    "rigid teeth, iso-viscous": ("gear.tooth_stiffness=0", "film.model='reynolds'", "film.law='iso-viscous'"),
}
CAMPAIGN = """&campaign
   csv = '{csv}'
   record = 'verdict', 'drag_torque', 'film_minimum', 'acceleration_rms', 'film_force_rms'
/
"""


def inputs(place: Path, count: int) -> dict[str, Path]:
    """The input with its drag computed, to which a column of drags is added once it is known."""
    text = READY.read_text()
    groups = re.findall(r"^&gear\n.*?^/\n", text, re.MULTILINE | re.DOTALL)
    for other in groups[:1] + groups[2:]:
        text = text.replace(other, "")
    text = re.sub(r"^&campaign\n.*?^/\n", "", text, flags=re.MULTILINE | re.DOTALL)
    (place / TABLE).write_bytes(READY.with_name(TABLE).read_bytes())
    grid = [
        (speed, temperature)
        for speed in np.linspace(600.0, 3000.0, count)
        for temperature in np.linspace(-20.0, 120.0, count)
    ]
    write_scenes(place / "computed.csv", (SPEED, TEMPERATURE), grid)
    computed, given = place / "computed.nml", place / "given.nml"
    computed.write_text(text + CAMPAIGN.format(csv="computed.csv"))
    text = PARTS.sub("", PARTS.sub("drag_torque = 0.1\n", text, count=1))
    given.write_text(text + CAMPAIGN.format(csv="given.csv"))
    return {"computed": computed, "given": given}


def write_scenes(path: Path, names: tuple[str, ...], rows: list[tuple[float, ...]]) -> None:
    with path.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(names)
        writer.writerows([[repr(float(value)) for value in row] for row in rows])


def solve(program: str, path: Path, changes: tuple[str, ...]) -> tuple[float, rattle.Campaign]:
    """Processor time [s] and rows of a campaign on one thread."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    options = ["--quiet", "--overwrite", "--threads", "1", "--output", str(path.parent)]
    options += [part for change in changes for part in ("--set", change)]
    subprocess.run([program, *options, str(path)], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime, rattle.read_campaign(path.with_suffix(".rattle"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--count", type=int, default=20)
    options = parser.parse_args()
    print("| scenes of | number | drag given [s] | computed [s] | ratio | largest difference of a row |")
    print("|---|---|---|---|---|---|")
    for words, changes in CASES.items():
        with tempfile.TemporaryDirectory() as name:
            paths = inputs(Path(name), options.count)
            _, found = solve(options.program, paths["computed"], changes)
            scenes = list(zip(*(found[key] for key in (SPEED, TEMPERATURE, "drag_torque")), strict=True))
            write_scenes(Path(name) / "given.csv", (SPEED, TEMPERATURE, DRAG), scenes)
            times: dict[str, list[float]] = {kind: [] for kind in paths}
            for _ in range(options.rounds):
                rows = {}
                for kind, path in paths.items():
                    taken, rows[kind] = solve(options.program, path, changes)
                    times[kind].append(taken)
            apart = max(
                float(np.nanmax(np.abs(rows["computed"][key] / rows["given"][key] - 1.0)))
                for key in ("film_minimum", "film_force_rms")
            )
            given, computed = (statistics.median(times[kind]) for kind in ("given", "computed"))
            cells = (
                words,
                len(scenes),
                f"{given:.2f}",
                f"{computed:.2f}",
                f"{computed / given:.3f}",
                f"{apart:.1e}",
            )
            print(f"| {' | '.join(map(str, cells))} |")


if __name__ == "__main__":
    main()
