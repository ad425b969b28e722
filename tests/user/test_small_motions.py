"""Natural frequency and damping ratio, compared with eigenvalues that numpy finds of films and springs."""

from __future__ import annotations

import random
import re
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

from rattle import kernels

# Load and its slopes of each law by its keys; the Reynolds film takes the rolling speed u1 + u2.
LAWS: dict[tuple[str, str, str], tuple[str, float]] = {
    ("iso-viscous", "published", "half-pi"): ("half_pi_rupture_load", 1.0),
    ("iso-viscous", "published", "solved"): ("solved_rupture_load", 1.0),
    ("piezo-viscous", "published", "half-pi"): ("published_piezo_load", 1.0),
    ("iso-viscous", "reynolds", "half-pi"): ("reynolds_iso_viscous_load", 2.0),
    ("piezo-viscous", "reynolds", "half-pi"): ("reynolds_piezo_viscous_load", 2.0),
}
OVERDAMPED = "no natural frequency: small motions about the steady film are overdamped"
SCENES_OF_EACH = 40
# Newmark's method takes rigid teeth only.
TAYLOR = {"method": "'taylor'", "steps_per_period": None}


def film_of(law: tuple[str, str, str], speed: float, viscosity: float, pressure_viscosity: float):
    """Load, stiffness and damping of a film at rest over its thickness."""
    kernel, factor = LAWS[law]
    keys = {"radius": 0.0127, "length": 0.01, "speed": factor * speed, "viscosity": viscosity}
    if law[0] == "piezo-viscous":
        keys["pressure_viscosity"] = pressure_viscosity

    def call(thickness):
        load, by_film, by_velocity = getattr(kernels, kernel)(thickness, 0.0, **keys)
        return load, -by_film, -by_velocity

    return call


def oscillation(slopes: np.ndarray, mass: float, spring: float | None):
    """Frequency [Hz] and damping ratio of the pair of complex eigenvalues; None where all are real."""
    if spring is None:
        stiffness, damping = np.sum(slopes, axis=0)
        matrix = np.array([[0.0, 1.0], [-stiffness / mass, -damping / mass]])
    else:
        # States: position and velocity of the gear, and how far each film is from its rest.
        matrix = np.zeros((2 + len(slopes), 2 + len(slopes)))
        matrix[0, 1] = 1.0
        for flank, (stiffness, damping) in enumerate(slopes):
            side, own = 1.0 - 2.0 * flank, 2 + flank
            matrix[1, 0] -= spring / mass
            matrix[1, own] = side * spring / mass
            matrix[own, own] = -(stiffness + spring) / damping
            matrix[own, 0] = side * spring / damping
    values = np.linalg.eigvals(matrix)
    pair = values[values.imag > 1e-9 * abs(values)]
    return (abs(pair[0]) / (2.0 * np.pi), -pair[0].real / abs(pair[0])) if pair.size else None


@pytest.mark.parametrize("law", LAWS, ids=lambda law: "-".join(law))
def test_small_motions_are_those_of_all_films_and_springs(law, run, scene_text, tmp_path: Path) -> None:
    draw = random.Random(str(law))
    expected, names = [], []
    while len(names) < SCENES_OF_EACH:
        place = len(names)
        mass, spring = 10.0 ** draw.uniform(-2.5, 1.0), 10.0 ** draw.uniform(6.0, 10.0)
        speed, viscosity = draw.uniform(0.5, 3.0), 10.0 ** draw.uniform(-1.5, -0.3)
        # The films at rest are drawn: load and backlash follow from them. Beside a much softer coast film
        # eigenvalues of a matrix would lose their digits.
        films = np.array([10.0 ** draw.uniform(-6.0, -5.0)])
        if place % 2:
            films = films[0] * np.array([1.0, draw.uniform(1.05, 20.0)])
        loads, *slopes = film_of(law, speed, viscosity, 1e-8)(films)
        spring = spring if place % 4 > 1 else None
        backlash = films.sum() - loads.sum() / (spring or np.inf) if place % 2 else None
        force = loads[0] - loads[1:].sum()
        if not force > 0.0 or (backlash is not None and backlash < 1e-6):
            continue
        contact = {"backlash": backlash, "stiffness": spring}
        text = scene_text(
            scene={"name": f"'scene_{place}'"},
            contact={key: repr(float(value)) for key, value in contact.items() if value is not None},
            load={"mass": repr(mass), "steady_force": repr(float(force)), "gravity": "0.0"},
            lubricant={"viscosity": repr(viscosity), "pressure_viscosity": "1e-8"},
            kinematics={"entrainment_speed": repr(speed)},
            solver=TAYLOR,
            film={"law": f"'{law[0]}'", "model": f"'{law[1]}'", "rupture": f"'{law[2]}'"},
        )
        if law[1] == "reynolds" or law[0] == "piezo-viscous":
            text = text.replace(f"   rupture = '{law[2]}'\n", "")
        names.append(f"{place}.nml")
        (tmp_path / names[-1]).write_text(text)
        expected.append(oscillation(np.transpose(slopes), mass, spring))
    reported = run("--check", *names, cwd=tmp_path)
    assert (reported.returncode, reported.stderr) == (0, "")
    parts = reported.stdout.split(": valid; ")[1:]
    assert len(parts) == SCENES_OF_EACH
    assert {pair is None for pair in expected} == {True, False}
    for name, pair, part in zip(names, expected, parts, strict=True):
        assert (OVERDAMPED in part) == (pair is None), name
        numbers = [
            float(value)
            for value in re.findall(r"^! (?:natural frequency|damping ratio) +([\d.E-]+)", part, re.M)
        ]
        # --check prints six and five digits; the eigenvalues of stiff springs have lost some of theirs.
        assert numbers == pytest.approx(list(pair or ()), rel=6e-5), name


def test_a_soft_coast_film_takes_no_part(run, scene_text, tmp_path: Path) -> None:
    """The coast film is 1e4 times thicker than the drive film, and its load 1e-14 of it."""
    canonical = {"solver": TAYLOR, "film": {"law": "'piezo-viscous'", "model": "'published'"}}
    reported = []
    for backlash in ({}, {"backlash": "0.01"}):
        (tmp_path / "soft_coast.nml").write_text(
            scene_text(contact={"stiffness": "1e13", **backlash}, **canonical)
        )
        assert run("soft_coast.nml", "--overwrite", cwd=tmp_path).returncode == 0
        reported.append(summary_of(tmp_path / "results" / "soft_coast.summary.nml"))
    for name in ("natural_frequency", "damping_ratio"):
        assert reported[1][name] == pytest.approx(reported[0][name], rel=1e-9)
    assert reported[1]["damping_ratio"] == pytest.approx(0.8612, abs=5e-5)


@pytest.mark.parametrize("stiffness", [None, "1e13"])
def test_an_overdamped_scene_has_no_natural_frequency(
    stiffness: str | None, run, scene_text, tmp_path: Path
) -> None:
    """Left out of the summary, said in log and --check, and no number in a row."""
    light = {"contact": {"stiffness": stiffness}, "load": {"mass": "0.03"}, "film": {"model": "'reynolds'"}}
    light["solver"] = TAYLOR
    (tmp_path / "light.nml").write_text(scene_text(**light))
    assert OVERDAMPED in run("--check", "light.nml", cwd=tmp_path).stdout
    ended = run("--verbose", "light.nml", cwd=tmp_path)
    assert ended.returncode == 0 and OVERDAMPED in ended.stdout
    summary = summary_of(tmp_path / "results" / "light.summary.nml")
    assert summary["steady_film"] > 0.0
    assert not {"natural_frequency", "damping_ratio"} & set(summary)
