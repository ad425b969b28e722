"""What looks odd but is valid: other spellings of the same input, standard input, texts in quotes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from outcomes import assert_faults

PLAIN = """&contact radius = 0.0127, length = 0.010 /
&lubricant viscosity = 0.3, pressure_viscosity = 2.0e-8 /
&kinematics entrainment_speed = 1.905 /
&load mass = 3.0, steady_force = 199.0, force_amplitude = 205.0, frequency = 600.0 /
&film law = 'iso-viscous' /
&solver method = 'newmark', steps_per_period = 32, periods = 3 /
&spectrum periods = 2 /
&output columns = 'time', 'acceleration' /
"""
SPREAD = PLAIN.replace(" /", "\n/").replace(", ", "\n").replace(" = ", "\n=\n")
ODD_BUT_VALID = {
    "no final newline": PLAIN.rstrip("\n"),
    "no newline at all": PLAIN.replace("\n", " "),
    "CRLF": PLAIN.replace("\n", "\r\n"),
    "UTF-8 byte order mark": "\ufeff" + PLAIN,
    "tabs": PLAIN.replace(" ", "\t"),
    "no blanks": PLAIN.replace(" = ", "=").replace(", ", ",").replace(" /", "/"),
    "one word a line": SPREAD.replace("'time'\n", "'time',\n"),
    "comments everywhere": "! first\n"
    + PLAIN.replace(" = ", "! key / &\n=! it's\n").replace(" /\n", ' ! "comment" / & = ,\n/! closed\n'),
    "groups in any order": "\n".join(reversed(PLAIN.splitlines())),
    "capitals": re.sub(r"&?\w+(?= =)|&\w+", lambda word: word.group().upper(), PLAIN),
    "D exponents": PLAIN.replace("2.0e-8", "2.0D-8").replace("0.010", "1d-2").replace("600.0", "+6.D+2"),
    "integers for reals": PLAIN.replace("3.0,", "3,").replace("199.0", "199").replace("600.0", "600"),
    "points without digits": PLAIN.replace("0.3", ".3").replace("3.0,", "3.,").replace("0.010", "+.010"),
    "leading zeros": PLAIN.replace("600.0", "000600.0").replace("periods = 3", "periods = +0003"),
    "many digits": PLAIN.replace("600.0", "600." + "0" * 400).replace("0.3", "0.3" + "0" * 400),
    "empty groups": PLAIN + "&scene /\n",
    "commas at the ends": PLAIN.replace(" /", ", /"),
    "commas in front": PLAIN.replace("&load mass", "&load , mass"),
    "double quotes": PLAIN.replace("'", '"'),
    "blanks for commas": PLAIN.replace(", ", " "),
    "index of the first element": PLAIN.replace("columns", "columns(1)"),
    "blank lines": PLAIN.replace("\n", "\n\n \n\t\n"),
    "group right behind a slash": PLAIN.replace("/\n&", "/&"),
}


@pytest.mark.parametrize("text", ODD_BUT_VALID.values(), ids=ODD_BUT_VALID)
def test_odd_but_valid(text: str, run, tmp_path: Path) -> None:
    """The file runs, and its resolved input is that of the plain spelling."""
    (tmp_path / "scene.nml").write_bytes(text.encode())
    ended = run("scene.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert (tmp_path / "results" / "scene.summary.nml").is_file()
    echo = run("--check", "scene.nml", cwd=tmp_path).stdout
    (tmp_path / "scene.nml").write_text(PLAIN)
    assert echo == run("--check", "scene.nml", cwd=tmp_path).stdout


def test_standard_input(run, scene_text, tmp_path: Path) -> None:
    ended = run("-", cwd=tmp_path, stdin=scene_text())
    assert (ended.returncode, ended.stderr) == (0, "")
    assert sorted(path.name for path in (tmp_path / "results").iterdir()) == [
        "standard-input.log",
        "standard-input.rattle",
        "standard-input.state",
        "standard-input.summary.nml",
    ]


def test_fault_in_standard_input(refused, scene_text) -> None:
    faults = refused("-", stdin=scene_text(load={"mass": "0"}))
    assert_faults(faults, "standard input", ["13: &load mass: 0 is not allowed"])


@pytest.mark.parametrize(
    ("spelt", "folder"),
    [
        ("'it''s'", "it's"),
        ('"it\'s"', "it's"),
        ('"say ""so"""', 'say "so"'),
        ("'a ! & / = b'", "a ! & / = b"),
        ("'erg\u00e4nzt'", "erg\u00e4nzt"),
    ],
    ids=["doubled", "other kind", "doubled double", "signs", "umlaut"],
)
def test_quotes_in_a_text(spelt: str, folder: str, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text(output={"directory": spelt}))
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    assert (tmp_path / folder / "scene.summary.nml").is_file()


def test_file_name_with_dots_and_dashes(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "-a.b_c-1.nml").write_text(scene_text())
    assert run("--", "-a.b_c-1.nml", cwd=tmp_path).returncode == 0
    assert (tmp_path / "results" / "-a.b_c-1.summary.nml").is_file()
