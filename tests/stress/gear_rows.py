"""Random gear inputs whose campaign rows are compared with single scenes of the same settings.

    python tests/stress/gear_rows.py build/rattle [--inputs 500] [--first 1]

An input depends on its number alone. The motion of the shaft by lists of accelerations or speeds, or by a
signal of each kind; contact positions and lines, several oils, rigid and elastic teeth, one flank or two.
One to three of the numeric keys that the input has are varied together, by the key table of the program. All
quantities that a row and a summary both have are compared, bit by bit, and whether they are verified.
"""

from __future__ import annotations

import argparse
import math
import random
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import f90nml
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

import rattle
from rattle.codes import CODES

SAMPLES = 512
# A single scene is followed from more starts than a row.
OF_STARTS = re.compile(r"motions|starts_solved|start_periods|unsettled_starts|loudest_\w+|quietest_\w+")


@dataclass(frozen=True)
class Case:
    """An input without its task, the keys that are varied and their values row by row."""

    text: str
    signal: str
    keys: tuple[str, ...]
    values: tuple[tuple[float, ...], ...]


def numeric_keys(program: Path) -> dict[str, bool]:
    """Every numeric key of the key table, and whether it is an integer."""
    table = subprocess.run([program, "--keys"], capture_output=True, text=True, check=True).stdout
    group, found = "", {}
    for line in table.splitlines():
        begun = re.match(r"## &(\w+)", line)
        group = begun[1] if begun else group
        key = re.match(r"\| `(\w+)` \|[^|]*\|[^|]*\| (a number|an integer)", line)
        if key:
            found[f"{group}.{key[1]}"] = key[2] == "an integer"
    return found


def draw(number: int, table: dict[str, bool]) -> Case:
    """The input of a number."""
    dice = random.Random(number)
    groups: dict[str, dict[str, float | int | str]] = {
        "gear": {
            "teeth_1": dice.randint(11, 45),
            "teeth_2": dice.randint(18, 50),
            "normal_module": dice.uniform(1.5e-3, 3.5e-3),
            "pressure_angle_deg": dice.uniform(15.0, 22.0),
            "helix_angle_deg": dice.choice((0.0, dice.uniform(-33.0, 33.0))),
            "face_width": dice.uniform(0.010, 0.025),
            "contact_position": dice.uniform(-1e-3, 1e-3),
            "contact_lines": dice.uniform(0.8, 3.0),
            "loose_inertia": 10.0 ** dice.uniform(-3.8, -2.5),
            "drag_torque": dice.uniform(0.05, 0.6),
        },
        "shaft": {"speed_rpm": dice.uniform(600.0, 3000.0)},
        "oil": {
            "viscosity_40_cst": dice.uniform(30.0, 150.0),
            "viscosity_100_cst": dice.uniform(6.0, 14.0),
            "density_15": dice.uniform(830.0, 900.0),
            "temperature_celsius": dice.uniform(0.0, 100.0),
            "base": dice.choice(("'mineral'", "'pao'", "'polyglycol'")),
        },
        "load": {"force_scale": dice.uniform(0.3, 1.0), "force_mean": dice.uniform(-0.2, 0.5)},
        "film": {"law": dice.choice(("'iso-viscous'", "'piezo-viscous'")), "model": "'reynolds'"},
        "solver": {"until": "'periods'", "accuracy": 1e-6, "periods": 4, "samples_per_period": SAMPLES},
        "spectrum": {"periods": 2},
    }
    gear, shaft, oil = groups["gear"], groups["shaft"], groups["oil"]
    if dice.random() < 0.6:
        gear["backlash"] = dice.uniform(6e-5, 2e-4)
    if dice.random() < 0.4:
        gear["tooth_stiffness"] = dice.uniform(8e9, 2e10)
    if dice.random() < 0.3:
        helix = math.radians(gear["helix_angle_deg"])
        gear["centre_distance"] = (
            0.5 * gear["normal_module"] / math.cos(helix) * (gear["teeth_1"] + gear["teeth_2"]) * 1.002
        )
    if dice.random() < 0.3:
        oil["pressure_viscosity"] = dice.uniform(1e-8, 2.5e-8)
    signal = _motion(dice, shaft)
    present = [f"{group}.{key}" for group, keys in groups.items() for key in keys]
    varied = [
        key
        for key in present
        if key in table
        and key not in ("solver.samples_per_period", "shaft.cycle_revolutions", "shaft.signal_orders")
    ]
    gear.setdefault("tooth_stiffness", 0.0)
    # A signal of a speed at other speeds is where derivation once went wrong.
    chosen = dice.sample(varied, dice.randint(1, 3))
    if dice.random() < 0.3 and "shaft.speed_rpm" not in chosen:
        chosen[0] = "shaft.speed_rpm"
    rows = [tuple(_near(dice, key, groups, table[key]) for key in chosen) for _ in range(3)]
    text = "".join(
        f"&{group}\n" + "".join(f"   {key} = {value}\n" for key, value in keys.items()) + "/\n"
        for group, keys in groups.items()
    )
    return Case(text, signal, tuple(chosen), tuple(rows))


def _motion(dice: random.Random, shaft: dict) -> str:
    """Give the shaft its motion, by lists or by a signal whose text is returned."""
    speed = shaft["speed_rpm"] * math.pi / 30.0
    orders = sorted(dice.sample((0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0), dice.randint(1, 3)))
    parts = [(order, dice.uniform(50.0, 600.0) / order, dice.uniform(-3.0, 3.0)) for order in orders]
    kind = dice.choice(
        ("accelerations", "speed_amplitudes", "angular_acceleration", "angular_speed", "angular_speed_rpm")
    )
    if kind in ("accelerations", "speed_amplitudes"):
        by = [1.0 if kind == "accelerations" else order * speed for order in orders]
        shaft["orders"] = ", ".join(str(order) for order in orders)
        shaft[kind] = ", ".join(str(part[1] / unit) for part, unit in zip(parts, by, strict=True))
        shaft["phases"] = ", ".join(str(part[2]) for part in parts)
        return ""
    unit = {"angular_acceleration": 1.0, "angular_speed": 1.0, "angular_speed_rpm": 30.0 / math.pi}[kind]
    is_speed = kind != "angular_acceleration"
    count = 180
    lines = ["angle,shaft"]
    for i in range(count):
        turn = 4.0 * math.pi * i / count
        value = speed * unit if is_speed else 0.0
        for order, amplitude, phase in parts:
            value += unit * amplitude / (order * speed if is_speed else 1.0) * math.cos(order * turn + phase)
        lines.append(f"{720.0 * i / count!r},{value!r}")
    shaft["signal"] = "'cycle.csv'"
    shaft["signal_kind"] = f"'{kind}'"
    return "\n".join(lines) + "\n"


def _near(dice: random.Random, key: str, groups: dict, whole: bool) -> float:
    """Another value of a key, near that of the base."""
    group, name = key.split(".")
    base = groups[group][name]
    if key == "solver.periods":
        return dice.randint(3, 6)
    if key == "spectrum.periods":
        return dice.randint(1, 3)
    if whole:
        return base + dice.randint(-2, 4)
    if key == "solver.accuracy":
        return 10.0 ** dice.uniform(-9.0, -4.0)
    if key == "shaft.speed_rpm":
        return base * dice.uniform(0.5, 2.0)
    if key == "gear.centre_distance":
        return base * dice.uniform(0.9995, 1.003)
    return base * dice.uniform(0.85, 1.15)


def recordable(program: Path) -> list[str]:
    """Every quantity that a row can hold."""
    table = subprocess.run([program, "--quantities"], capture_output=True, text=True, check=True).stdout
    page = subprocess.run([program, "--keys"], capture_output=True, text=True, check=True).stdout
    (line,) = (line for line in page.splitlines() if line.startswith("| `record` |"))
    names = [row.split(",")[0] for row in table.splitlines()[1:]]
    kept = [name for name in names if not OF_STARTS.fullmatch(name)]
    return [name for name in kept if re.search(rf"\b{name}\b", line.split("|")[4])]


def faults_of(program: Path, case: Case, recorded: list[str], folder: Path) -> Iterator[str]:
    """What a row and its single scene have different, a line each."""
    if case.signal:
        (folder / "cycle.csv").write_text(case.signal)
    (folder / "rows.csv").write_text(
        ",".join(case.keys) + "\n" + "".join(",".join(repr(v) for v in row) + "\n" for row in case.values)
    )
    (folder / "many.nml").write_text(
        case.text
        + "&scene task = 'campaign' /\n&campaign csv = 'rows.csv', allow_invalid = T\n"
        + f"samples_per_period = {SAMPLES}\n"
        + f"record = {', '.join(repr(name) for name in recorded)} /\n"
    )
    ended = _call(program, folder, "many.nml", "--overwrite")
    if ended.returncode not in (0, 1):
        yield f"the campaign ended with {ended.returncode}: {ended.stderr[:400]}"
        return
    rows = rattle.read_campaign(folder / "results" / "many.rattle")
    (folder / "one.nml").write_text(case.text)
    for row, values in enumerate(case.values):
        settings = [
            word
            for key, value in zip(case.keys, values, strict=True)
            for word in ("--set", f"{key}={value!r}")
        ]
        ended = _call(program, folder, *settings, "--overwrite", "one.nml")
        invalid = bool(rows["status"][row] == invalid_status())
        if (ended.returncode == 2) != invalid:
            yield f"row {row + 1}: status {rows['status'][row]}, alone it ends with {ended.returncode}"
            continue
        if ended.returncode == 2:
            continue
        alone = f90nml.read(folder / "results" / "one.summary.nml")["summary"]
        if "verification" in alone:
            alone["verified"] = alone["verification"] == "verified"
        yield from (f"row {row + 1}: {line}" for line in _differences(rows, row, alone, recorded))


def invalid_status() -> int:
    return next(code for code, word in CODES["status"].items() if word == "invalid")


def _differences(rows, row: int, alone: dict, recorded: list[str]) -> Iterator[str]:
    for name in recorded:
        if name == "harmonics":
            if "harmonics" not in alone:
                continue
            reported = np.array(alone["harmonics"][:8], dtype=float)
            here = np.array([rows[f"harmonic_{n}"][row] for n in range(1, 9)])
            if not np.array_equal(reported, here[: reported.size]):
                yield f"harmonics {here} for {reported}"
            continue
        if name not in alone:
            # A period of 0 is none.
            if np.isnan(rows[name][row]) or (name == "orbit_period" and rows[name][row] == 0.0):
                continue
            yield f"{name} {rows[name][row]!r}, which the single scene does not tell"
            continue
        reported = alone[name]
        if name in CODES:
            reported = {words: code for code, words in CODES[name].items()}[str(reported).strip()]
        if name.endswith("_error"):
            number = alone.get(name.removesuffix("_error"), 1.0)
            if not is_error_of_summary(float(reported), float(rows[name][row]), float(number)):
                yield f"{name} {rows[name][row]!r} for {reported!r}"
        elif float(reported) != float(rows[name][row]):
            yield f"{name} {rows[name][row]!r} for {reported!r}"


def is_error_of_summary(shown: float, error: float, number: float) -> bool:
    """Whether a summary shows an error: two digits, rounded up, not below the rounding of its number."""
    largest = max(1.1 * error * (1.0 + 1e-9), 2.4e-16 * abs(number))
    return error <= shown * (1.0 + 1e-9) and shown <= largest


def _call(program: Path, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [program, "--quiet", *words], cwd=folder, capture_output=True, text=True, check=False, timeout=600.0
    )


def main() -> int:
    """Run the study; 1 if a row differs from its single scene."""
    parser = argparse.ArgumentParser(description="Rows of random gear inputs against single scenes.")
    parser.add_argument("program", type=Path)
    parser.add_argument("--inputs", type=int, default=500)
    parser.add_argument("--first", type=int, default=1)
    options = parser.parse_args()
    program = options.program.resolve()
    table, recorded = numeric_keys(program), recordable(program)
    wrong = 0
    for number in range(options.first, options.first + options.inputs):
        case = draw(number, table)
        with tempfile.TemporaryDirectory() as folder:
            lines = list(faults_of(program, case, recorded, Path(folder)))
        wrong += bool(lines)
        for line in lines:
            print(f"input {number}, {', '.join(case.keys)}: {line}", flush=True)
    print(f"{options.inputs} inputs, {wrong} with rows that differ from their single scenes")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
