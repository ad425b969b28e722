"""calibrate.py finds again what measurements were made with, and says how well they determine it."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import pytest
from script_calls import called_here

import rattle as package

INPUT = """&gear
   teeth_1 = 19, teeth_2 = 37, normal_module = 2.2e-3, helix_angle_deg = 28.0, face_width = 0.016
   centre_distance = 0.070, loose_inertia = 8.9e-4, backlash = 9e-5, tooth_stiffness = 14e9
   bearing_mean_diameter = 0.038, immersion_depth = 0.030730400709
/
&shaft speed_rpm = 800.0, orders = 2.0, 4.0, accelerations = 600.0, 100.0, phases = 0.0, 0.8 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 50.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver until = 'steady', periods = 60, accuracy = 1e-6, samples_per_period = 256 /
&spectrum periods = 2 /
"""
POINTS = ((700, 20), (700, 60), (800, -10), (1000, 50), (600, 0), (900, -20), (800, 5))
SCALE = 1.7
HEAD = "speed_rpm,temperature_celsius"


@pytest.fixture
def pair(tmp_path: Path) -> Path:
    path = tmp_path / "pair.nml"
    path.write_text(INPUT)
    return path


def reported(pair: Path, column: str, **keys: float) -> list[float]:
    """What the program says at the points, each solved alone."""
    values = []
    for speed, temperature in POINTS:
        settings = {
            "shaft.speed_rpm": speed,
            "oil.temperature_celsius": temperature,
            "gear.drag_scale": SCALE,
        }
        summary = package.run(pair, set=settings | keys).summary
        values.append(summary[column])
    return values


def measure(pair: Path, column: str, values: list) -> Path:
    path = pair.with_name(f"{column}.csv")
    rows = [
        f"{speed},{temperature},{value}" for (speed, temperature), value in zip(POINTS, values, strict=True)
    ]
    path.write_text("\n".join([f"{HEAD},{column}", *rows, ""]))
    return path


def fitted(said: str, key: str = "gear.drag_scale") -> list[float]:
    """Value and interval as printed."""
    (line,) = (line for line in said.splitlines() if line.startswith(key))
    return [float(number) for number in re.findall(r"(?<![\w.])[\d.]+(?:e-?\d+)?(?![\d.%])", line)]


@pytest.mark.long
@pytest.mark.parametrize("column", ("drag_torque", "film_force_rms"))
def test_a_scale_is_found_again(column: str, pair: Path, tmp_path: Path) -> None:
    path = measure(pair, column, reported(pair, column))
    code, said, complained = called_here("calibrate.py", pair, path, "--output", "o.csv", cwd=tmp_path)
    assert code == 0, complained
    assert fitted(said)[0] == pytest.approx(SCALE, rel=1e-3)
    with (tmp_path / "o.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [(float(row["speed_rpm"]), float(row["temperature_celsius"])) for row in rows] == list(POINTS)
    for row in rows:
        assert float(row["computed"]) == pytest.approx(float(row[column]), rel=1e-3)


@pytest.mark.long
def test_an_interval_holds_the_scale_behind_scattered_numbers(pair: Path, tmp_path: Path) -> None:
    """Torques off by some per cent up and down."""
    scatter = (1.05, 0.96, 1.02, 0.97, 1.03, 0.99, 0.98)
    torques = reported(pair, "drag_torque")
    path = measure(pair, "drag_torque", [t * s for t, s in zip(torques, scatter, strict=True)])
    code, said, complained = called_here("calibrate.py", pair, path, cwd=tmp_path)
    assert code == 0, complained
    value, low, high = fitted(said)
    assert low < value < high and low < SCALE < high and high / low < 1.1


@pytest.mark.long
def test_a_scale_between_rattling_points_and_others(pair: Path, tmp_path: Path) -> None:
    verdicts = reported(pair, "verdict")
    rattles = [int("impacts" in verdict) for verdict in verdicts]
    assert 0 < sum(rattles) < len(rattles)
    path = measure(pair, "rattles", rattles)
    code, said, complained = called_here("calibrate.py", pair, path, cwd=tmp_path)
    assert code == 0, complained
    value, low, high = fitted(said)
    assert low < SCALE < high and low < value < high
    assert "between" in said and "interval" not in said
    # Both ends are limits of a point: there its motion changes.
    for end, calm in ((low, 1.01), (high, 1.01)):
        states = {
            factor: [
                "impacts" in verdict
                for verdict in reported(pair, "verdict", **{"gear.drag_scale": end * factor})
            ]
            for factor in (1.0 / calm, calm)
        }
        assert states[1.0 / calm] != states[calm]
    words = {"yes": 1, "no": 0}
    assert [words[line.split()[-1]] for line in said.splitlines()[2 : 2 + len(POINTS)]] == rattles


@pytest.mark.long
def test_two_keys_are_distinct(pair: Path, tmp_path: Path) -> None:
    path = measure(pair, "film_force_rms", reported(pair, "film_force_rms", **{"load.force_scale": 1.2}))
    second = ("--second", "load.force_scale", "--second-range", "0.5,2")
    code, said, complained = called_here("calibrate.py", pair, path, *second, cwd=tmp_path)
    assert code == 0, complained
    assert fitted(said)[0] == pytest.approx(SCALE, rel=1e-3)
    assert fitted(said, "load.force_scale")[0] == pytest.approx(1.2, rel=1e-3)


def test_one_measurement_leaves_no_interval(pair: Path, tmp_path: Path) -> None:
    path = tmp_path / "one.csv"
    path.write_text(f"{HEAD},drag_torque\n700,20,0.3\n")
    code, said, _ = called_here("calibrate.py", pair, path, cwd=tmp_path)
    assert code == 0 and len(fitted(said)) == 1
    assert "no interval is known" in said


@pytest.mark.parametrize(
    ("text", "words"),
    (
        ("", "is empty"),
        ("speed_rpm,rattles\n700,1\n", "the head is 'speed_rpm,rattles'"),
        (f"{HEAD},loud\n700,20,1\n", "'loud' is neither 'rattles' nor a number"),
        (f"{HEAD},rattles\n", "no measured point"),
        (f"{HEAD},rattles\n700,20,maybe\n", "line 2: 'maybe' in column rattles is not 1 or 0"),
        (f"{HEAD},drag_torque\n700,20,0.1\n700,x,0.1\n", "line 3: 'x' in column temperature_celsius"),
        (f"{HEAD},drag_torque\n700,20,-0.1\n", "has to be positive"),
        (f"{HEAD},drag_torque\n700,20\n", "line 2: 2 values for 3 columns"),
    ),
)
def test_bad_measurements_are_refused(text: str, words: str, pair: Path, tmp_path: Path) -> None:
    (tmp_path / "bad.csv").write_text(text)
    code, _, complained = called_here("calibrate.py", pair, "bad.csv", cwd=tmp_path)
    assert code == 2 and words in complained and "Traceback" not in complained


def test_bad_requests_are_refused(pair: Path, tmp_path: Path) -> None:
    (tmp_path / "m.csv").write_text(f"{HEAD},rattles\n700,20,1\n")
    for options, words in (
        (("--gear", "1st"), "has one pair"),
        (("--second", "gear.backlash", "--second-range", "1e-5,1e-4"), "a second key needs measured numbers"),
        (("--second", "gear.backlash"), "go together"),
        (("--range", "2,1"), "not two positive numbers"),
        (("--key", "gear.drag"), "drag"),
        (("--range", "1,1.001"), "does not change"),
    ):
        code, _, complained = called_here("calibrate.py", pair, "m.csv", *options, cwd=tmp_path)
        assert code == 2 and words in complained, (options, complained)
