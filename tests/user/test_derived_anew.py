"""What follows from a drawing, a data sheet and a measured cycle is derived anew at every varied value."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

import rattle as package

SETTINGS = (
    "solver.until='periods'",
    "solver.periods=6",
    "solver.accuracy=1e-6",
    "spectrum.periods=2",
    "spectrum.verify=.false.",
)


@pytest.fixture
def cycle(repository: Path, tmp_path: Path) -> Path:
    """The ready input with a measured cycle of speeds, in a folder of its own."""
    for name in ("engine_cycle.nml", "engine_cycle.csv"):
        shutil.copy(repository / "input" / name, tmp_path)
    return tmp_path / "engine_cycle.nml"


def settings(*more: str) -> list[str]:
    return [word for setting in (*SETTINGS, *more) for word in ("--set", setting)]


def single(run, cycle: Path, speed: float) -> dict:
    ended = run("--overwrite", *settings(f"shaft.speed_rpm={speed}"), cycle.name, cwd=cycle.parent)
    assert ended.returncode == 0, ended.stderr
    return summary_of(cycle.parent / "results" / "engine_cycle.summary.nml")


def test_rows_over_the_speed_have_the_accelerations_of_their_speed(run, cycle: Path) -> None:
    """Speeds are differentiated at the speed of the row."""
    text = cycle.read_text() + (
        "&campaign vary = 'shaft.speed_rpm', values(:, 1) = 500, 800, 1600, samples_per_period = 512\n"
        "record = 'acceleration_maximum', 'film_minimum', 'film_force_rms', 'dissipated_energy' /\n"
    )
    many = cycle.with_name("many.nml")
    many.write_text(text)
    ended = run(*settings("scene.task='campaign'"), many.name, cwd=many.parent)
    # `verify` belongs to motions.
    assert ended.returncode == 2 and "spectrum verify" in ended.stderr
    words = settings("scene.task='campaign'")
    place = words.index("spectrum.verify=.false.")
    ended = run(*words[: place - 1], *words[place + 1 :], many.name, cwd=many.parent)
    assert ended.returncode == 0, ended.stderr
    rows = package.read_campaign(many.parent / "results" / "many.rattle")
    for row, speed in enumerate((500.0, 800.0, 1600.0)):
        alone = single(run, cycle, speed)
        for name in ("acceleration_maximum", "film_minimum", "film_force_rms", "dissipated_energy"):
            assert rows[name][row] == pytest.approx(alone[name], rel=1e-12), (speed, name)


def test_amplitudes_of_the_speed_are_those_of_the_acceleration_over_the_circular_frequency(
    run, tmp_path: Path
) -> None:
    """Two inputs of one motion, reported by its accelerations and by its speeds."""
    speed = 800.0
    accelerations, orders, phases = np.array([600.0, 60.0]), np.array([2.0, 0.5]), np.array([0.3, -1.0])
    amplitudes = accelerations / (orders * speed * np.pi / 30.0)
    pair = """
&gear teeth_1 = 11, teeth_2 = 38, normal_module = 2.5e-3, helix_angle_deg = 28.96, face_width = 0.016
   loose_inertia = 1.715e-3, drag_torque = 0.10, backlash = 1e-4 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 40.0 /
&film law = 'iso-viscous', model = 'reynolds' /
"""
    reported = []
    for name, values, shift in (
        ("accelerations", accelerations, 0.0),
        ("speed_amplitudes", amplitudes, 0.5 * np.pi),
    ):
        listed = [", ".join(str(value) for value in numbers) for numbers in (orders, values, phases - shift)]
        (tmp_path / "pair.nml").write_text(
            f"{pair}&shaft speed_rpm = {speed}, orders = {listed[0]}\n"
            f"{name} = {listed[1]}\nphases = {listed[2]} /\n"
        )
        ended = run("--check", "pair.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        reported.append(
            {
                key: [float(word) for word in line.split("=")[1].rsplit(" ", 1)[0].split(",")]
                for line in ended.stdout.splitlines()
                for key in ("force_amplitudes", "force_phases")
                if line.startswith(f"! derived: load.{key}")
            }
        )
    assert reported[1]["force_amplitudes"] == pytest.approx(reported[0]["force_amplitudes"], rel=1e-14)
    assert reported[1]["force_phases"] == pytest.approx(reported[0]["force_phases"], rel=1e-14)


def test_the_motion_of_a_shaft_is_reported_once(run, cycle: Path) -> None:
    """Accelerations or speeds or a signal: none is refused, two are."""
    pair = cycle.read_text()
    start, end = pair.index("   signal = "), pair.index("/\n\n&oil")
    for lines, words in (
        ("orders = 2", "&shaft accelerations: a motion of the shaft is required"),
        (
            "orders = 2, accelerations = 600, speed_amplitudes = 1",
            "&shaft speed_amplitudes: give either accelerations or speed_amplitudes",
        ),
        (
            "orders = 2, speed_amplitudes = 1, 2",
            "&shaft speed_amplitudes: as many values as orders has (1) are needed",
        ),
    ):
        cycle.write_text(pair[:start] + lines + "\n" + pair[end:])
        ended = run("--check", cycle.name, cwd=cycle.parent)
        assert ended.returncode == 2 and words in ended.stderr, ended.stderr
    cycle.write_text(pair[:start] + "speed_amplitudes = 1.0,\n" + pair[start:])
    ended = run("--check", cycle.name, cwd=cycle.parent)
    assert ended.returncode == 2 and "speed_amplitudes: the signal gives the motion" in ended.stderr


PAIR = """
&gear
   teeth_1 = 33, teeth_2 = 32, normal_module = 1.85e-3, helix_angle_deg = 30.8, face_width = 0.016,
   contact_lines = 2.5
   loose_inertia = 2.8e-4, drag_torque = 0.05
/
&shaft speed_rpm = 800.0, orders = 2.0, accelerations = 100.0 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 40.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver periods = 4, accuracy = 1e-6 /
&spectrum periods = 2 /
&output columns = 'film_thickness', 'film_load' /
"""


def test_a_flank_is_as_stiff_as_all_its_lines(run, tmp_path: Path) -> None:
    """c' times face width times contact lines: of given teeth, and of steel where they are rigid."""
    stiffness = 1.4e10 * 0.016 * 2.5
    (tmp_path / "pair.nml").write_text(PAIR)
    reported = run("--check", "--set", "gear.tooth_stiffness=1.4e10", "pair.nml", cwd=tmp_path)
    (line,) = (line for line in reported.stdout.splitlines() if "derived: contact.stiffness" in line)
    assert float(line.split("=")[1].split()[0]) == pytest.approx(stiffness, rel=1e-14)
    ended = run("--set", "gear.tooth_stiffness=0", "pair.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    summary = summary_of(tmp_path / "results" / "pair.summary.nml")
    result = package.read(tmp_path / "results" / "pair.rattle")
    film, load = (np.array(result[name])[-1024:] for name in ("film_thickness", "film_load"))
    worst = int(np.argmax(load))
    # About its maximum the load is flat while the film moves on. By contact length it would be 12 % less.
    assert summary["deflection_share"] == pytest.approx(load[worst] / (stiffness * film[worst]), rel=0.03)


def test_rigid_teeth_of_a_gear_are_reported_the_key_that_makes_them_give(run, tmp_path: Path) -> None:
    (tmp_path / "pair.nml").write_text(PAIR)
    settings = ["gear.tooth_stiffness=0", "gear.drag_torque=50", "oil.temperature_celsius=90"]
    settings += ["gear.contact_lines=1"]
    words = [word for setting in settings for word in ("--set", setting)]
    reported = run("--check", *words, "pair.nml", cwd=tmp_path).stdout
    assert "steel ones have gear.tooth_stiffness = 1.4E10 N/m2" in reported, reported


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("&load mass = 0,017 /", "takes one value, 2 are given; the decimal comma is a point here: 0.017"),
        (
            PAIR.replace("normal_module", "modul"),
            "&gear modul: unknown key; the nearest known key is normal_module",
        ),
        (
            "\n".join(line for line in PAIR.splitlines() if not line.startswith("&oil")),
            "&lubricant viscosity: this key is required, or the data sheet of the oil in &oil",
        ),
    ],
)
def test_faults_name_what_was_meant(text: str, words: str, run, tmp_path: Path) -> None:
    (tmp_path / "pair.nml").write_text(text)
    ended = run("--check", "pair.nml", cwd=tmp_path)
    assert ended.returncode == 2 and words in ended.stderr, ended.stderr
