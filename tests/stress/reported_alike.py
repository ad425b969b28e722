"""Random scenes alone, as rows of campaigns, as values of sweeps: is every quantity the same to the last bit?

    python tests/stress/reported_alike.py build/rattle [--groups 25] [--first 1]

The scenes of a group share film law, flanks and elasticity, and differ in eight numbers. Each is solved
alone, all of them in one campaign with the same settings, and each as the first value of a sweep, which
starts as a single scene does. Every quantity that two of the three report is compared. The exit code is 1
where one differs in a bit, but for rows of motions that settle slowly: a campaign jumps to where they are
forecast to settle, solves other periods, and comes to the same motion within the accuracy.
"""

from __future__ import annotations

import argparse
import random
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import gear_rows
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

import rattle
from rattle.codes import CODES

SCENES = 8
ROW, SWEEP = "summary and row", "summary and sweep"
SAMPLES = 512
# Ten times the accuracy of a motion.
FORECAST = 1e-5
STEADY = next(code for code, word in CODES["status"].items() if word == "steady")
LAWS = (
    ("iso-viscous", "published"),
    ("piezo-viscous", "published"),
    ("iso-viscous", "reynolds"),
    ("piezo-viscous", "reynolds"),
    ("elastohydrodynamic", "closure"),
)


def draw(number: int) -> tuple[str, list[dict[str, float]]]:
    """What the scenes of a group share, and the numbers of each."""
    dice = random.Random(number)
    law, model = dice.choice(LAWS)
    lines = [f"&film law = '{law}', model = '{model}' /"]
    contact = []
    if dice.random() < 0.5:
        contact.append(f"backlash = {dice.uniform(3e-5, 2e-4)!r}")
    if law == "elastohydrodynamic" or dice.random() < 0.4:
        contact.append(f"stiffness = {10.0 ** dice.uniform(7.5, 9.0)!r}")
    if law == "elastohydrodynamic":
        contact.append("flattening_included = .false.")
        lines.append("&lubricant viscosity_law = 'barus' /")
    until = dice.choice(("periods", "steady"))
    periods = dice.choice((8, 40, 120))
    lines.append(f"&solver samples_per_period = {SAMPLES}, until = '{until}', periods = {periods} /")
    lines.append(f"&spectrum periods = {dice.choice((1, 2, 5))} /")
    shared = "\n".join([*lines, f"&contact {', '.join(contact)} /" if contact else ""])
    scenes = []
    for _ in range(SCENES):
        load = 10.0 ** dice.uniform(1.0, 3.0)
        scenes.append(
            {
                "contact.radius": dice.uniform(5e-3, 3e-2),
                "contact.length": dice.uniform(5e-3, 3e-2),
                "lubricant.viscosity": 10.0 ** dice.uniform(-2.0, -0.3),
                "kinematics.entrainment_speed": 10.0 ** dice.uniform(-0.3, 1.0),
                "load.mass": 10.0 ** dice.uniform(-0.5, 1.0),
                "load.steady_force": load,
                "load.force_amplitude": load * 10.0 ** dice.uniform(-1.0, 0.7),
                "load.frequency": 10.0 ** dice.uniform(1.5, 3.0),
            }
        )
    return shared, scenes


def input_text(shared: str, scene: dict[str, float], more: str) -> str:
    """The input of a scene: groups may stand once only, so those of both parts are joined."""
    groups: dict[str, list[str]] = {"lubricant": ["pressure_viscosity = 2.0e-8"]}
    for line in (*shared.splitlines(), *more.splitlines()):
        if line:
            name, _, keys = line.strip(" /&").partition(" ")
            groups.setdefault(name, []).append(keys)
    for key, value in scene.items():
        group, _, name = key.partition(".")
        groups.setdefault(group, []).append(f"{name} = {value!r}")
    return "".join(f"&{name}\n   {', '.join(keys)}\n/\n" for name, keys in groups.items())


@dataclass(frozen=True)
class Difference:
    """A quantity that two report differently."""

    quantity: str
    which: str
    where: str
    alone: float
    other: float


def differences(program: Path, number: int, folder: Path) -> Iterator[Difference]:
    """What the scenes of a group are reported with other bits."""
    shared, scenes = draw(number)
    recorded = gear_rows.recordable(program)
    names = list(scenes[0])
    csv = [",".join(names), *(",".join(repr(scene[name]) for name in names) for scene in scenes)]
    (folder / "rows.csv").write_text("\n".join(csv) + "\n")
    record = ", ".join(repr(name) for name in recorded)
    campaign = (
        "&scene task = 'campaign' /\n"
        f"&campaign csv = 'rows.csv', allow_invalid = T, samples_per_period = {SAMPLES}, record = {record} /"
    )
    (folder / "many.nml").write_text(input_text(shared, scenes[0], campaign))
    ended = _call(program, folder, "many.nml")
    if ended.returncode not in (0, 1):
        raise RuntimeError(f"group {number}: {ended.stderr[:400]}")
    rows = rattle.read_campaign(folder / "results" / "many.rattle")
    for row, scene in enumerate(scenes):
        where = f"group {number}, scene {row + 1}"
        (folder / "one.nml").write_text(input_text(shared, scene, ""))
        ended = _call(program, folder, "--overwrite", "one.nml")
        if ended.returncode not in (0, 1):
            if rows["status"][row] != gear_rows.invalid_status():
                yield Difference("status", ROW, where, ended.returncode, float(rows["status"][row]))
            continue
        alone = numbers_of(rattle.read_summary(folder / "results" / "one.summary.nml"))
        here = {name: float(rows[name][row]) for name in rows.names if name not in scene}
        yield from compared(alone, here, ROW, where)
        amplitude = scene["load.force_amplitude"]
        sweep = (
            "&scene task = 'sweep' /\n"
            f"&sweep key = 'force_amplitude', first = {amplitude!r}, last = {1.01 * amplitude!r}, count = 2 /"
        )
        # A sweep goes on until a motion is steady; where it is not, Newton's method looks for a periodic one.
        if "until = 'steady', " not in shared or alone.get("status") != STEADY:
            continue
        (folder / "swept.nml").write_text(input_text(shared.replace("until = 'steady', ", ""), scene, sweep))
        ended = _call(program, folder, "--overwrite", "swept.nml")
        if ended.returncode not in (0, 1):
            raise RuntimeError(f"{where}: {ended.stderr[:400]}")
        values = rattle.read(folder / "results" / "swept.rattle")
        first = {name: float(values[name][0]) for name in values.names[1:]}
        yield from compared(alone, first, SWEEP, where)


def numbers_of(summary: dict) -> dict[str, float]:
    """What a summary reports, as numbers."""
    reported = {}
    if "verification" in summary:
        reported["verified"] = float(str(summary["verification"]).strip() == "verified")
    for name, value in summary.items():
        if name == "harmonics":
            reported |= {f"harmonic_{n}": float(harmonic) for n, harmonic in enumerate(value[:8], 1)}
        elif name in CODES and isinstance(value, str):
            words = {word: code for code, word in CODES[name].items()}
            reported[name] = float(words.get(value.strip(), np.nan))
        elif isinstance(value, (bool, int, float)):
            reported[name] = float(value)
    return reported


def compared(alone: dict, other: dict, which: str, where: str) -> Iterator[Difference]:
    share = FORECAST if is_forecast(alone, other, which) else 0.0
    for name in sorted(alone.keys() & other.keys()):
        one, two = alone[name], other[name]
        if share > 0.0 and name in ("periods_solved", "evaluations", "steps", "irregular_fraction"):
            continue
        if name.endswith("_error") and which == ROW:
            # Differences of two solutions, in which their last digits count: of one size.
            if share == 0.0 and max(one, two) > max(10.0 * min(one, two), 1e-12):
                yield Difference(name, which, where, one, two)
            continue
        scale = max(abs(one), alone["harmonic_1"] if name.startswith("harmonic_") else 0.0)
        if abs(one - two) > share * scale or np.isnan(one) != np.isnan(two):
            yield Difference(name, which, where, one, two)


def is_forecast(alone: dict, other: dict, which: str) -> bool:
    """Whether a row has come to its motion by a jump."""
    return (
        which == ROW and alone.get("status") == STEADY and alone["periods_solved"] != other["periods_solved"]
    )


def _call(program: Path, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [program, "--quiet", *words], cwd=folder, capture_output=True, text=True, check=False, timeout=600.0
    )


def main() -> int:
    """Run the study; 1 if a quantity differs."""
    parser = argparse.ArgumentParser(description="Random scenes alone, as rows and as values of sweeps.")
    parser.add_argument("program", type=Path)
    parser.add_argument("--groups", type=int, default=25)
    parser.add_argument("--first", type=int, default=1)
    options = parser.parse_args()
    found: set[str] = set()
    for number in range(options.first, options.first + options.groups):
        with tempfile.TemporaryDirectory() as folder:
            for one in differences(options.program.resolve(), number, Path(folder)):
                found.add(one.where)
                print(f"{one.where}: {one.quantity} {one.alone!r} and {one.other!r}, {one.which}", flush=True)
    print(f"{options.groups * SCENES} scenes, {len(found)} reported otherwise alone, in a row or in a sweep")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
