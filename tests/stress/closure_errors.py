"""Random loose gears under the closure and with their pressure in nodes: how far the closure is off.

    python tests/stress/closure_errors.py build/rattle [--scenes 500] [--first 1] [--seconds 600]

A scene depends on its number alone. Its first two periods from rest are compared, before irregular motions
part: the largest acceleration, relative to it or to the force over the mass if that is more, and the smallest
film of either flank. The films in nodes have 48 of them and an accuracy of 3e-3. The table is by the largest
load M = W/(E* R eps^2 l); scenes that stop are counted by name.
"""

from __future__ import annotations

import argparse
import collections
import math
import random
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

import rattle

MODULUS = 226.0e9
IN_NODES = {"film.nodes": 48, "solver.accuracy": 3e-3}
CLASSES = ((0.0, 0.15), (0.15, 2.0), (2.0, 6.0), (6.0, math.inf))
LAWS = ("constant", "roelands")


@dataclass(frozen=True)
class Row:
    """A scene that both have solved: its law, largest load, and relative errors of the closure."""

    law: str
    load: float
    peak: float
    film: float


def scene_of(number: int) -> tuple[dict, float]:
    """A loose gear as an input, and the load that M counts in [N]."""
    draw = random.Random(number)

    def between(low: float, high: float) -> float:
        return math.exp(draw.uniform(math.log(low), math.log(high)))

    radius, length = between(4e-3, 15e-3), between(10e-3, 25e-3)
    viscosity, speed = between(4e-3, 0.15), between(0.8, 12.0)
    mass, shaking = between(0.2, 1.5), between(4.0, 60.0)
    scene = {
        "contact": {
            "radius": radius,
            "length": length,
            "backlash": between(50e-6, 150e-6),
            "stiffness": 14e9 * length,
        },
        "lubricant": {
            "viscosity": viscosity,
            "pressure_viscosity": between(1.2e-8, 2.2e-8),
            "viscosity_law": LAWS[number % 2],
        },
        "kinematics": {"rolling_speed": speed},
        "load": {
            "mass": mass,
            "steady_force": mass * shaking * between(0.05, 0.9),
            "gravity": 0.0,
            "frequency": between(15.0, 60.0),
            "force_orders": [1, 2],
            "force_amplitudes": [mass * shaking, mass * shaking * draw.uniform(0.1, 0.6)],
            "force_phases": [0.0, draw.uniform(0.0, 6.2)],
        },
        "film": {"law": "elastohydrodynamic"},
        "solver": {"until": "periods", "periods": 2, "samples_per_period": 512},
        "spectrum": {"periods": 2, "verify": False},
        "output": {"series": False},
    }
    return scene, MODULUS * radius * length * math.sqrt(viscosity * speed / (MODULUS * radius))


def solved(scene: dict, settings: dict, program: Path) -> dict:
    """Summary of a scene, its status alone where it stops."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            return dict(rattle.run(scene, set=settings, folder=folder, program=program).summary)
        except rattle.SceneFailed as failure:
            return {"status": str(failure)}


def film_of(reported: dict) -> float:
    """Smallest film of both flanks [m]."""
    return min(reported["film_minimum"], reported["coast_film_minimum"])


def peak_of(reported: dict) -> float:
    """Largest acceleration either way [m/s2]."""
    return max(reported["acceleration_maximum"], -reported["acceleration_minimum"])


def compare(number: int, program: Path) -> Row | str:
    """Both solutions of a scene, or how it stopped."""
    scene, unit = scene_of(number)
    closure = solved(scene, {"film.model": "closure", "solver.starts": 1}, program)
    nodes = solved(scene, {"film.model": "resolved", **IN_NODES}, program)
    for name, reported in (("closure", closure), ("nodes", nodes)):
        if reported["status"] != "complete":
            return f"{name}: {reported['status']}"
    load = max(nodes["load_maximum"], nodes["coast_load_maximum"]) / unit
    shaking = scene["load"]["force_amplitudes"][0] / scene["load"]["mass"]
    peak = abs(peak_of(closure) - peak_of(nodes)) / max(peak_of(nodes), shaking)
    film = abs(film_of(closure) / film_of(nodes) - 1.0)
    return Row(scene["lubricant"]["viscosity_law"], load, peak, film)


def table_of(rows: list[Row]) -> list[str]:
    """Median and 99 % of the errors, by the largest load and the law of viscosity."""
    lines = [
        "| M | viscosity | scenes | peak, median | 99 % | film, median | 99 % |",
        "|---|---|---:|---:|---:|---:|---:|",
    ]
    for low, high in CLASSES:
        for law in LAWS:
            chosen = [row for row in rows if row.law == law and low <= row.load < high]
            if not chosen:
                continue
            words = f"{low:g} to {high:g}" if high < math.inf else f"above {low:g}"
            cells = [
                f"{100.0 * np.percentile([getattr(row, name) for row in chosen], share):.2g} %"
                for name in ("peak", "film")
                for share in (50, 99)
            ]
            lines.append(f"| {words} | {law} | {len(chosen)} | " + " | ".join(cells) + " |")
    return lines


def main() -> None:
    """Solve the scenes and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--scenes", type=int, default=500)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=math.inf, help="begin no scene after these")
    options = parser.parse_args()
    rows: list[Row] = []
    stops: collections.Counter[str] = collections.Counter()
    ends = time.monotonic() + options.seconds
    for number in range(options.first, options.first + options.scenes):
        if time.monotonic() > ends:
            break
        outcome = compare(number, options.program)
        if isinstance(outcome, Row):
            rows.append(outcome)
        else:
            stops[outcome] += 1
            print(f"scene {number}: {outcome}", file=sys.stderr)
    print("\n".join(table_of(rows)))
    for words, count in stops.items():
        print(f"{count} stopped: {words}")


if __name__ == "__main__":
    main()
