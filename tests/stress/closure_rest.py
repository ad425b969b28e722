"""Films at rest of the closure beside films in nodes, and the factor of the closure that limits them.

    python tests/stress/closure_rest.py build/rattle [--nodes 128]

Steady contacts are solved in nodes. The closure is that of tests/reference, with several factors of
(x^2 + s^2)^2 in g_r: by how much its films at rest are off those in nodes up to M = 2, and d ln H/d ln M
where it is largest. With that of the program films are least off, and fall with their loads.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reference"))

import elastohydrodynamic_closure as reference

import rattle

MODULUS, RADIUS, LENGTH = 226.0e9, 9.0e-3, 0.015
# Law, viscosity [Pa s] and pressure-viscosity coefficient [1/Pa]
OILS = (("barus", 0.1, 2.0e-8), ("roelands", 0.1, 2.0e-8), ("roelands", 0.02, 1.4e-8))
MATERIALS = (5.0, 8.0, 14.0, 20.0)
LOADS = (0.1, 0.4, 0.7, 1.0, 1.4, 2.0)
FACTORS = (0.0, 0.04, 0.05, 0.054, 0.058, 0.062, 0.07)


def contact(law: str, viscosity: float, coefficient: float, material: float) -> reference.Gear:
    """A contact of a material number L: its speed follows."""
    eps = material / (coefficient * MODULUS)
    speed = eps**4 * MODULUS * RADIUS / viscosity
    return reference.Gear(
        radius=RADIUS,
        length=LENGTH,
        speed=speed,
        mass=1.0,
        steady_force=1.0,
        backlash=1e-4,
        stiffness=1e12,
        viscosity=viscosity,
        pressure_viscosity=coefficient,
        frequency=50.0,
        amplitudes=(1.0,),
        phases=(0.0,),
        law=law,
        modulus=MODULUS,
    )


def film_in_nodes(gear: reference.Gear, load: float, nodes: int, program: Path) -> float | None:
    """H of M at rest, none where nodes find none."""
    force = load * gear.load_unit
    scene = {
        "contact": {
            "radius": RADIUS,
            "length": LENGTH,
            "stiffness": 1e12,
            "flattening_included": False,
        },
        "lubricant": {
            "viscosity": gear.viscosity,
            "pressure_viscosity": gear.pressure_viscosity,
            "viscosity_law": gear.law,
        },
        "kinematics": {"rolling_speed": gear.speed},
        "load": {
            "mass": 1.0,
            "steady_force": force,
            "gravity": 0.0,
            "frequency": 50.0,
            "force_amplitude": 1e-7 * force,
        },
        "film": {"law": "elastohydrodynamic", "model": "resolved", "nodes": nodes},
        "solver": {"until": "periods", "periods": 1, "samples_per_period": 16},
        "spectrum": {"periods": 1, "verify": False},
        "output": {"series": False},
    }
    with tempfile.TemporaryDirectory() as folder:
        try:
            reported = rattle.run(scene, folder=folder, program=program).summary
        except rattle.SceneFailed:
            return None
    return reported["film_minimum"] / gear.film_unit


def steepest(gear: reference.Gear) -> float:
    """Largest d ln H/d ln M of the closure at rest up to M = 2."""
    loads = np.geomspace(0.3, 2.0, 25)
    films = [gear.steady(load) for load in loads]
    return float(np.max(np.diff(np.log(films)) / np.diff(np.log(loads))))


def main() -> None:
    """Solve the contacts and print both tables."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--nodes", type=int, default=128)
    options = parser.parse_args()
    own = reference.ROLLING_LIMIT
    gears = [contact(*oil, material) for oil in OILS for material in MATERIALS]
    films = [[film_in_nodes(gear, load, options.nodes, options.program) for load in LOADS] for gear in gears]
    print("| law, viscosity | L | " + " | ".join(f"M {load:g}" for load in LOADS) + " |")
    print("|---|---|" + "---:|" * len(LOADS))
    for number, (gear, row) in enumerate(zip(gears, films, strict=True)):
        cells = [
            f"{film:.3f}, {100.0 * (gear.steady(load) / film - 1.0):+.1f} %" if film else "-"
            for load, film in zip(LOADS, row, strict=True)
        ]
        material = MATERIALS[number % len(MATERIALS)]
        print(f"| {gear.law}, {gear.viscosity:g} Pa s | {material:g} | " + " | ".join(cells) + " |")
    print("\n| factor | rms | largest | steepest |\n|---|---:|---:|---:|")
    for factor in FACTORS:
        reference.ROLLING_LIMIT = factor
        off = [
            100.0 * (gear.steady(load) / film - 1.0)
            for gear, row in zip(gears, films, strict=True)
            for load, film in zip(LOADS, row, strict=True)
            if film
        ]
        cells = [f"{np.sqrt(np.mean(np.square(off))):.1f} %", f"{max(off, key=abs):+.1f} %"]
        cells.append(f"{max(steepest(gear) for gear in gears):+.3f}")
        print(f"| {factor:g} | " + " | ".join(cells) + " |")
    reference.ROLLING_LIMIT = own


if __name__ == "__main__":
    main()
