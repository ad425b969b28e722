"""Numbers that were surely meant in another unit: a warning says key, value and what was meant."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from report_reader import read_page
from script_calls import call_script

import rattle as package
from rattle.codes import QUANTITIES
from rattle.figures import style

PAIR = """&gear
   teeth_1 = 11, teeth_2 = 38, normal_module = 2.5e-3, helix_angle_deg = 28.96, face_width = 0.016
   loose_inertia = 1.715e-3, drag_torque = 0.10, backlash = 1e-4
/
&shaft
   speed_rpm = 900.0, orders = 2.0, accelerations = 600.0
/
&oil
   viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 60.0
/
&film law = 'iso-viscous', model = 'reynolds' /
&solver periods = 4, starts = 1, accuracy = 1e-6 /
&spectrum periods = 2, verify = .false. /
"""
# Of a gear: what is typed, and what would have been meant.
OF_GEARS = [
    ("shaft.speed_rpm", "15", "it would be 900.0 1/min if it was meant in Hz"),
    ("shaft.speed_rpm", "94", "897.6 1/min if it was meant in rad/s"),
    ("shaft.speed_rpm", "94", "5640 1/min if it was meant in Hz"),
    ("gear.helix_angle_deg", "0.49", "it would be 28.07 deg if it was meant in rad"),
    ("gear.helix_angle_deg", "-0.49", "it would be -28.07 deg if it was meant in rad"),
    ("gear.loose_inertia", "0.95", "it would be 9.500E-5 kg m2 if it was meant in kg cm2"),
    ("gear.loose_inertia", "17.15", "it would be 0.001715 kg m2 if it was meant in kg cm2"),
    ("gear.loose_inertia", "1715", "0.001715 kg m2 if it was meant in kg mm2"),
    ("gear.face_width", "16", "it would be 0.01600 m if it was meant in mm"),
    ("gear.normal_module", "2.5", "it would be 0.002500 m if it was meant in mm"),
    ("gear.drag_torque", "100", "it would be 0.1000 N m if it was meant in N mm"),
    ("gear.backlash", "100", "it would be 1.000E-4 m if it was meant in um"),
    ("gear.backlash", "0.1", "it would be 1.000E-4 m if it was meant in mm"),
    ("gear.tooth_stiffness", "14", "it would be 1.400E10 N/m2 if it was meant in N/(mm um)"),
    ("gear.tooth_stiffness", "14000", "it would be 1.400E10 N/m2 if it was meant in N/mm2"),
    ("shaft.phases", "90", "it would be 1.571 rad if it was meant in deg"),
    ("shaft.accelerations", "5001", "87.28 rad/s2 if it was meant in deg/s2"),
    ("shaft.accelerations", "5001", "523.7 rad/s2 if it was meant in (1/min)/s"),
    ("oil.temperature_celsius", "333", "it would be 59.85 degC if it was meant in K"),
    ("contact.young_modulus", "206", "it would be 2.060E11 Pa if it was meant in GPa"),
    ("contact.young_modulus", "206000", "it would be 2.060E11 Pa if it was meant in MPa"),
]
REFUSED = [
    ("gear.centre_distance", "71", "it would be 0.07100 m if it was meant in mm"),
    ("gear.contact_position", "1.5", "it would be 0.001500 m if it was meant in mm"),
    ("oil.pressure_viscosity", "20", "it would be 2.000E-8 1/Pa if it was meant in 1/GPa"),
    ("gear.pressure_angle_deg", "0.349", "it would be 20.00 deg if it was meant in rad"),
    ("oil.viscosity_40_cst", "0.0505", "it would be 58.05 mm2/s if it was meant in Pa s"),
    ("oil.viscosity_100_cst", "9.6e-6", "it would be 9.600 mm2/s if it was meant in m2/s"),
    ("oil.density_15", "0.87", "it would be 870.0 kg/m3 if it was meant in g/cm3"),
]
OF_CONTACTS = [
    ("contact.radius", "12.7", "it would be 0.01270 m if it was meant in mm"),
    ("contact.length", "10", "it would be 0.01000 m if it was meant in mm"),
    ("contact.stiffness", "140", "it would be 1.400E8 N/m if it was meant in N/um"),
    ("contact.stiffness", "140000", "it would be 1.400E8 N/m if it was meant in N/mm"),
    ("contact.backlash", "50", "it would be 5.000E-5 m if it was meant in um"),
    ("lubricant.viscosity", "300", "it would be 0.3000 Pa s if it was meant in mPa s"),
    ("kinematics.entrainment_speed", "1905", "it would be 1.905 m/s if it was meant in mm/s"),
    ("load.mass", "3000", "it would be 3.000 kg if it was meant in g"),
    ("film.initial_film", "1.5", "it would be 1.500E-6 m if it was meant in um"),
]


def warnings_of(reported: str) -> list[str]:
    return [line for line in reported.splitlines() if "is not what machines have" in line]


@pytest.mark.parametrize(("key", "value", "meant"), OF_GEARS)
def test_a_gear(key: str, value: str, meant: str, run, tmp_path: Path) -> None:
    (tmp_path / "pair.nml").write_text(PAIR)
    reported = run("--check", "--set", f"{key}={value}", "pair.nml", cwd=tmp_path)
    assert reported.returncode == 0, reported.stderr
    (warning,) = warnings_of(reported.stdout)
    group, name = key.split(".")
    assert warning.startswith(f"! warning: --set {key}={value}: &{group} {name}") and meant in warning
    assert re.search(rf"{float(value):g}", warning)


@pytest.mark.parametrize(("key", "value", "meant"), REFUSED)
def test_what_is_refused_says_it_too(key: str, value: str, meant: str, run, tmp_path: Path) -> None:
    (tmp_path / "pair.nml").write_text(PAIR)
    reported = run("--check", "--set", f"{key}={value}", "pair.nml", cwd=tmp_path)
    assert reported.returncode == 2 and reported.stderr.splitlines()[-1].endswith(meant), reported.stderr


@pytest.mark.parametrize(("key", "value", "meant"), OF_CONTACTS)
def test_a_contact(key: str, value: str, meant: str, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text(solver={"method": None, "steps_per_period": None}))
    reported = run("--check", "--set", f"{key}={value}", "scene.nml", cwd=tmp_path)
    assert reported.returncode == 0, reported.stderr
    (warning,) = warnings_of(reported.stdout)
    assert meant in warning


def test_phases_of_a_force_in_degrees(run, scene_text, tmp_path: Path) -> None:
    load = {"force_amplitude": None, "force_orders": "1, 2, 3", "force_amplitudes": "50.0, 30.0, 20.0"}
    (tmp_path / "scene.nml").write_text(scene_text(load=load | {"force_phases": "0.0, 90.0, -120.0"}))
    (warning,) = warnings_of(run("--check", "scene.nml", cwd=tmp_path).stdout)
    assert "&load force_phases: 90.0 rad" in warning and "the first of 2 such numbers among 3" in warning
    assert warning.endswith("; it would be 1.571 rad if it was meant in deg")


def test_speeds_of_a_shaft_that_swing_too_far(run, tmp_path: Path) -> None:
    """30 rad/s of 94 rad/s at order 2 are 32 %; 3.0 are not odd, and 5001 rad/s2 are none at 3000 1/min."""
    text = PAIR.replace("accelerations = 600.0", "speed_amplitudes = 30.0")
    (tmp_path / "pair.nml").write_text(text)
    (warning,) = warnings_of(run("--check", "pair.nml", cwd=tmp_path).stdout)
    assert ": &shaft speed_amplitudes: 30.0 rad/s of order 2.00 " in warning and "swing by 32 %" in warning
    assert warning.endswith("it would be 3.142 rad/s if it was meant in 1/min")
    assert not warnings_of(
        run("--check", "--set", "shaft.speed_amplitudes=3.0", "pair.nml", cwd=tmp_path).stdout
    )
    (tmp_path / "pair.nml").write_text(PAIR)
    words = ("--set", "shaft.speed_rpm=3000", "--set", "shaft.accelerations=5001")
    assert not warnings_of(run("--check", *words, "pair.nml", cwd=tmp_path).stdout)
    # Of several orders the largest swing is reported, wherever it stands.
    swings = "orders = 2.0, 4.0, 6.0, accelerations = 300.0, 6000.0, 100.0"
    (tmp_path / "pair.nml").write_text(PAIR.replace("orders = 2.0, accelerations = 600.0", swings))
    (warning,) = warnings_of(run("--check", "pair.nml", cwd=tmp_path).stdout)
    assert ": &shaft accelerations: 6000.0 rad/s2 of order 4.00 " in warning


def test_log_summary_and_report_tell_it(run, tmp_path: Path) -> None:
    (tmp_path / "pair.nml").write_text(PAIR.replace("28.96", "0.49"))
    ended = run("--verbose", "pair.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    (warning,) = warnings_of(ended.stdout)
    assert warning.startswith("  warning: pair.nml:2: &gear helix_angle_deg = 0.49 deg")
    assert warning in (tmp_path / "results" / "pair.log").read_text()
    reported = package.read_summary(tmp_path / "results" / "pair.summary.nml")["input_warnings"]
    assert warning.strip() in ([reported] if isinstance(reported, str) else reported)
    page = tmp_path / "page.html"
    assert call_script("report.py", tmp_path / "results" / "pair.rattle", "--output", page).returncode == 0
    assert "28.07 deg if it was meant in rad." in read_page(page).words


@pytest.mark.long
def test_campaigns_and_gearboxes_tell_it(run, tmp_path: Path) -> None:
    """The report of a gearbox once, with the pairs that it is about; that of a campaign as its log."""
    odd = PAIR.replace("28.96", "0.49")
    varied = "vary = 'shaft.speed_rpm', first = 800.0, last = 900.0, count = 2"
    plain = odd.replace(", verify = .false.", "")
    (tmp_path / "two.nml").write_text(f"{plain}&scene task = 'campaign' /\n&campaign {varied} /\n")
    ended = run("two.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    (warning,) = warnings_of(ended.stdout)
    summary = package.read_summary(tmp_path / "results" / "two.summary.nml")
    assert re.sub("^ *warning +", "warning: ", warning) in summary["input_warnings"]
    assert summary["acceleration_meaning"] == "relative to the shaft, along the line of action"
    said = "28.07 deg if it was meant in rad."
    page = tmp_path / "page.html"
    assert call_script("report.py", tmp_path / "results" / "two.rattle", "--output", page).returncode == 0
    assert said in read_page(page).words
    first, rest = odd.split("/\n", 1)
    second = first.replace("0.49", "28.96")
    pairs = "".join(f"{gear} name = '{name}'\n/\n" for name, gear in (("1st", first), ("2nd", second)))
    (tmp_path / "box.nml").write_text(pairs + rest)
    assert run("box.nml", cwd=tmp_path).returncode == 0
    results = [tmp_path / "results" / f"box.{name}.rattle" for name in ("1st", "2nd")]
    assert call_script("report.py", *results, "--output", page, "--overwrite").returncode == 0
    notes = [words for words in read_page(page).paragraphs if said in words]
    assert notes[0].startswith("Gear 1st: warning: box.nml:2: ") and len(notes) == 2
    # A table of an earlier version does not say how the forces of all pairs add.
    table = tmp_path / "results" / "box.summary.nml"
    kept = [line for line in table.read_text().splitlines(keepends=True) if "film_force_text" not in line]
    table.write_text("".join(kept).partition("! checksum")[0])
    assert call_script("report.py", *results, "--output", page, "--overwrite").returncode == 0
    assert "that of an earlier version of rattle" in read_page(page).words


def test_the_acceleration_of_a_gear_is_said_to_be_relative_to_its_shaft(
    run, scene_text, tmp_path: Path
) -> None:
    (tmp_path / "pair.nml").write_text(PAIR)
    (tmp_path / "scene.nml").write_text(scene_text())
    ended = run("--verbose", "pair.nml", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    pair, scene = (tmp_path / "results" / f"{name}.summary.nml" for name in ("pair", "scene"))
    said = "relative to the shaft, along the line of action"
    assert package.read_summary(pair)["acceleration_meaning"] == said
    assert "acceleration_meaning" not in package.read_summary(scene)
    assert ended.stdout.count(f" m/s2 {said}\n") == 1
    results = [package.read(path.with_name(f"{path.name.split('.')[0]}.rattle")) for path in (pair, scene)]
    labels = [style.of_acceleration(style.ACCELERATION_LABEL, [result]) for result in results]
    assert [label.startswith("Relative acceleration") for label in labels] == [True, False]
    for name in ("acceleration_minimum", "acceleration_maximum", "acceleration_rms"):
        assert QUANTITIES[name].meaning.endswith(
            "with a &gear relative to the shaft, along the line of action."
        )


@pytest.mark.long
def test_no_ready_input_and_no_reference_is_odd(run, repository: Path, tmp_path: Path) -> None:
    """The pairs whose contacts are computed apart in test_gear.f90, and every ready scene."""
    (tmp_path / "first.nml").write_text(PAIR.replace("900.0", "800.0"))
    second = (
        PAIR.replace("teeth_1 = 11, teeth_2 = 38", "teeth_1 = 33, teeth_2 = 32, centre_distance = 0.0702")
        .replace("2.5e-3", "1.85e-3, contact_position = 1e-3, contact_lines = 1.5")
        .replace("28.96", "30.8")
        .replace("1.715e-3", "2.8e-4")
        .replace("0.10", "0.05")
    )
    (tmp_path / "second.nml").write_text(second)
    ready = sorted((repository / "input").glob("*.nml"))
    for path in (tmp_path / "first.nml", tmp_path / "second.nml", *ready):
        reported = run("--check", path, cwd=tmp_path)
        assert reported.returncode == 0 and not warnings_of(reported.stdout), path
