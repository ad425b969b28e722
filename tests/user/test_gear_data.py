"""gear_data.py: drawings as CSV and spreadsheets, REXS models, and what is refused of them."""

from __future__ import annotations

import csv
import math
import subprocess
import sys
from pathlib import Path

import pytest
from page_commands import call, shell
from script_calls import called_here

from rattle.derived import derived
from rattle.gear_data import names
from rattle.keys import key_table
from rattle.namelist import parse

PAIR = """number of teeth, driving; 11
number of teeth of the loose gear; 38
normal module [mm]; 2,5
pressure angle (°); 20
helix angle; 28.96 deg
face width; 1.6 cm
moment of inertia; 17.15 kg cm2
drag torque; 100 mN m
normal backlash; 100 um
teeth stiffness; 0 N/m2
engine speed; 800 1/min
engine orders; 2, 4, 6
angular accelerations; 600, 100, 50 rad/s2
phases; 0, 0.8, -0.5 rad
kinematic viscosity at 40 °C; 58 cSt
kinematic viscosity at 100 °C; 9.6 mm²/s
density at 15 °C [g/cm3]; 0.87
oil temperature; 40 °C
"""
# As the standard of the FVA has them: components with attributes, and relations between them.
REXS = """<?xml version="1.0" encoding="UTF-8"?>
<model version="1.7" applicationId="x" applicationVersion="1" date="2026-01-01">
<relations>
 <relation id="1" type="stage"><ref id="3" role="stage"/><ref id="1" role="gear_1"/><ref id="2" role="gear_2"/></relation>
 <relation id="2" type="flank"><ref id="1" role="gear"/><ref id="4" role="left"/><ref id="5" role="right"/></relation>
</relations>
<components>
 <component id="1" type="cylindrical_gear" name="pinion"><attribute id="number_of_teeth" unit="none">11</attribute>
  <attribute id="normal_module" unit="mm">2.5</attribute><attribute id="face_width" unit="mm">17</attribute>
  <attribute id="helix_angle_reference_diameter" unit="deg">-28.96</attribute>
  <attribute id="tip_diameter" unit="mm">36.4</attribute></component>
 <component id="2" type="cylindrical_gear" name="wheel"><attribute id="number_of_teeth" unit="none">38</attribute>
  <attribute id="normal_module" unit="mm">2.5</attribute><attribute id="face_width" unit="mm">16</attribute>
  <attribute id="helix_angle_reference_diameter" unit="deg">28.96</attribute>
  <attribute id="tip_diameter" unit="mm">113.5</attribute></component>
 <component id="3" type="cylindrical_stage" name="1st gear"><attribute id="center_distance" unit="mm">70</attribute>
  <attribute id="minimum_normal_backlash" unit="mm">0.08</attribute>
  <attribute id="maximum_normal_backlash" unit="mm">0.12</attribute></component>
 <component id="4" type="cylindrical_gear_flank"><attribute id="normal_pressure_angle" unit="deg">20</attribute></component>
 <component id="5" type="cylindrical_gear_flank"><attribute id="normal_pressure_angle" unit="deg">20</attribute></component>
 <component id="6" type="lubricant"><attribute id="viscosity_at_40_degree_celsius" unit="mm^2 / s">58</attribute>
  <attribute id="viscosity_at_100_degree_celsius" unit="mm^2 / s">9.6</attribute>
  <attribute id="density_at_15_degree_celsius" unit="kg / dm^3">0.87</attribute>
  <attribute id="basis" unit="none">mineral</attribute></component>
</components></model>
"""  # noqa: E501
REST = """inertia; 1700 kg mm2
drag torque; 0.1 N m
speed; 800 1/min
orders; 2
accelerations; 600 rad/s2
oil temperature; 60 °C
"""


def written(folder: Path, *arguments: object, code: int = 0) -> Path:
    output = folder / "box.nml"
    ended, said, complained = called_here(
        "gear_data.py", *arguments, "--output", output, "--overwrite", cwd=folder
    )
    assert ended == code, complained
    assert said == f"{output}\n"
    return output


def refused(folder: Path, text: str, name: str = "pair.csv") -> list[str]:
    """What is said of a file that is refused; nothing is written."""
    (folder / name).write_text(text)
    code, said, complained = called_here("gear_data.py", name, "--output", "none.nml", cwd=folder)
    assert code == 2 and said == "" and not (folder / "none.nml").exists()
    return complained.removeprefix("gear_data.py: ").splitlines()


def assert_alike(made: Path, ready: Path, gear: str | None = None) -> None:
    """What follows from both is the same, number by number."""
    found, expected = derived(made, gear=gear), derived(ready, gear=gear)
    for key, value in expected.items():
        if key.partition(".")[0] in ("contact", "lubricant", "kinematics", "load", "gear", "shaft", "oil"):
            assert found[key] == value, key


def test_the_commands_of_the_page(rattle: Path, repository: Path, tmp_path: Path) -> None:
    commands = shell((repository / "input" / "GEARS.md").read_text())
    assert "gear_data.py" in commands
    ended = call(commands, tmp_path, rattle, repository)
    assert ended.returncode == 0 and ended.stdout.count(": valid") == 4, ended.stderr


@pytest.mark.parametrize("gear", ("1st", "4th"))
def test_the_ready_drawing_is_the_ready_gearbox(repository: Path, tmp_path: Path, gear: str) -> None:
    made = written(tmp_path, repository / "input" / "gearbox_drawing.csv")
    assert_alike(made, repository / "input" / "gearbox.nml", gear)


def test_a_spreadsheet_is_its_csv_file(repository: Path, tmp_path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    source = repository / "input" / "gearbox_drawing.csv"
    for row in csv.reader(source.read_text().splitlines()):
        book.active.append([float(cell) if cell.replace(".", "").isdigit() else cell for cell in row])
    book.save(tmp_path / "box.xlsx")
    made = written(tmp_path, "box.xlsx")
    ready = parse((repository / "input" / "gearbox.nml").read_text())
    found = parse(made.read_text())
    for group, keys in ready.items():
        for key, value in keys.items() if group.startswith(("gear", "shaft", "oil")) else ():
            assert found[group][key] == value, (group, key)
    book.active["C5"] = "=A1"
    book.save(tmp_path / "box.xlsx")
    code, _, complained = called_here("gear_data.py", "box.xlsx", cwd=tmp_path)
    assert code == 2 and "C5: no value was saved with its formula" in complained


def test_two_columns_with_units_are_the_ready_pair(repository: Path, tmp_path: Path) -> None:
    (tmp_path / "pair.csv").write_text(PAIR)
    made = written(tmp_path, "pair.csv")
    made.write_text(f"{made.read_text()}&film law = 'iso-viscous', model = 'reynolds' /\n")
    assert_alike(made, repository / "input" / "loose_pair.nml")


def test_circumferential_backlash_is_taken_along_the_normal(tmp_path: Path) -> None:
    """By the formula of the page, cos(alpha_t) cos(beta_b), from transverse and base angles."""
    (tmp_path / "pair.csv").write_text(PAIR.replace("normal backlash", "circumferential backlash"))
    normal, helix = math.radians(20.0), math.radians(28.96)
    transverse = math.atan(math.tan(normal) / math.cos(helix))
    base = math.asin(math.sin(helix) * math.cos(normal))
    found = parse(written(tmp_path, "pair.csv").read_text())["gear"]["backlash"]
    assert found == pytest.approx(1e-4 * math.cos(transverse) * math.cos(base), rel=1e-12)
    (said,) = refused(
        tmp_path, PAIR.replace("normal back", "transverse back").replace("pressure angle (°); 20", "")
    )
    assert said.startswith("pair.csv:9:") and "needs the pressure angle" in said


def test_a_rexs_model_with_what_it_lacks(tmp_path: Path) -> None:
    (tmp_path / "box.rexs").write_text(REXS)
    (tmp_path / "rest.csv").write_text(REST)
    found = parse(written(tmp_path, "box.rexs", "rest.csv").read_text())
    assert found["gear"] == {
        "name": "1st_gear",
        "teeth_1": 11,
        "teeth_2": 38,
        "normal_module": 0.0025,
        "pressure_angle_deg": 20.0,
        "helix_angle_deg": 28.96,
        "face_width": 0.016,
        "centre_distance": 0.07,
        "tip_diameter_1": 0.0364,
        "tip_diameter_2": 0.1135,
        "loose_inertia": 0.0017,
        "drag_torque": 0.1,
        "backlash": 0.0001,
    }
    oil = {"viscosity_40_cst": 58.0, "viscosity_100_cst": 9.6, "density_15": 870.0, "base": "mineral"}
    assert found["oil"] == oil | {"temperature_celsius": 60.0}
    turned = parse(written(tmp_path, "box.rexs", "rest.csv", "--loose", "pinion").read_text())["gear"]
    assert (turned["teeth_1"], turned["teeth_2"], turned["tip_diameter_1"]) == (38, 11, 0.1135)


def test_keys_that_nothing_gives_are_listed(tmp_path: Path) -> None:
    (tmp_path / "box.rexs").write_text(REXS)
    code, said, complained = called_here("gear_data.py", "box.rexs", cwd=tmp_path)
    assert code == 1
    for group, key in (("gear", "loose_inertia"), ("shaft", "speed_rpm"), ("oil", "temperature_celsius")):
        assert f"&{group} {key} [{key_table()[group, key].unit}]" in complained
        assert f"! {key} =  " in said
    assert "&gear drag_torque: the drag on the loose gear is required" in complained


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ("face width", "fase width", "6: fase width: this name is not known; the nearest known name"),
        ("normal backlash", "backlash", "9: backlash: this name is not known; say 'normal backlash'"),
        ("normal module", "transverse module", "3: transverse module [mm]: this name is not known"),
        ("1.6 cm", "1.6", "6: face width: it has no unit; one such as m is needed"),
        ("1.6 cm", "1.6 kg", "6: face width: unit kg: it is in kg; m is needed"),
        ("1.6 cm", "16 +- 0.1 mm", "6: face width: unit +- 0.1 mm: its unit is not known; m is needed"),
        ("17.15 kg cm2", "1,715 kg mm2", "7: moment of inertia: '1,715 kg mm2' may mean thousands"),
        ("; 38", "; many", "2: number of teeth of the loose gear: 'many' is no number"),
        ("; 38", "; 38.5", "2: number of teeth of the loose gear: 38.5: "),
        ("17.15 kg", "-17.15 kg", "7: moment of inertia: -17.15 kg cm2: -0.001715 is not allowed"),
        ("oil temperature", "oil temperature;;", "18: '40 °C' stands beyond the last column"),
        ("face width; 1.6 cm", "face width; 16 mm\nfacewidth; 2 cm", "7: facewidth: 2 cm, but pair.csv:6"),
    ],
)  # fmt: skip
def test_what_is_not_understood_is_refused_at_its_place(
    tmp_path: Path, before: str, after: str, words: str
) -> None:
    assert before in PAIR
    said = refused(tmp_path, PAIR.replace(before, after, 1))
    assert len(said) == 1 and said[0].startswith(f"pair.csv:{words}"), said


def test_rows_of_tables_that_contradict_themselves(tmp_path: Path) -> None:
    table = "name,unit,1st,2nd\nteeth driving,,11,19\nteeth loose,,38,37\noil temperature [K],degC,60,60\n"
    assert "the unit degC stands in the row, and K behind its name" in refused(tmp_path, table)[0]
    assert "all pairs share it" in refused(tmp_path, table.replace(" [K]", "").replace("60,60", "60,70"))[0]
    assert "a name of its own" in refused(tmp_path, table.replace("1st,2nd", "1st,1st"))[0]
    assert "is empty" in refused(tmp_path, "\n")[0]


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ('none">38', 'none">-38', "wheel of 1st_gear is an internal gear"),
        ('.5</attribute><attribute id="face_width" unit="mm">16', ".4</attribute><attribute>", "a pair"),
        ("cylindrical_stage", "bevel_stage", "has no cylindrical stage"),
        ('<ref id="3"', '<ref id="9"', "names component 9"),
        ("<model", "<modell", "is no XML"),
        ('unit="mm">70', 'unit="kg">70', "center_distance of 1st gear: unit kg: it is in kg; m is needed"),
    ],
)  # fmt: skip
def test_models_that_cannot_be_used(tmp_path: Path, before: str, after: str, words: str) -> None:
    assert before in REXS
    (said,) = refused(tmp_path, REXS.replace(before, after), "box.rexs")
    assert said.startswith("box.rexs") and words in said


def test_every_known_name_means_one_key() -> None:
    """Names of keys and phrases do not hide one another, and each phrase is that of a key."""
    keys = {f"{group}.{key}" for group, key in key_table()}
    assert set(names.PHRASES) <= keys
    for key, phrases in names.PHRASES.items():
        for phrase in phrases:
            assert names.key_of(phrase) == tuple(key.split(".")), phrase


def test_odd_numbers_are_said_at_their_place(tmp_path: Path) -> None:
    (tmp_path / "pair.csv").write_text(PAIR.replace("1.6 cm", "16 m"))
    code, _, complained = called_here("gear_data.py", "pair.csv", cwd=tmp_path)
    assert code == 0 and "pair.csv:6: face width: 16 m: " in complained


def test_without_openpyxl_a_sentence_says_what_brings_it(repository: Path, tmp_path: Path) -> None:
    (tmp_path / "openpyxl.py").write_text("raise ModuleNotFoundError('none', name='openpyxl')\n")
    (tmp_path / "box.xlsx").write_bytes(b"")
    ended = subprocess.run(
        [sys.executable, repository / "scripts" / "gear_data.py", "box.xlsx"],
        cwd=tmp_path,
        env={"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 2 and "pip install 'rattle[tables]'" in ended.stderr, ended.stderr
