"""Bad input of every kind ends with code 2, one plain line per fault, and leaves the disk as it was."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from outcomes import assert_faults

BAD_FILES = sorted((Path(__file__).resolve().parents[1] / "bad_inputs").glob("*.nml"))

POSITIVE = "a number > 0.0"
NOT_NEGATIVE = "a number >= 0.0"
COUNT = "an integer >= 1 and <= 1.0E9"
STEPS = "an integer >= 8 and <= 1.0E7"
FRACTION = "a number > 0.0 and <= 1.0"
FLAG = ".true. or .false."
NAME = "1 to 64 letters, digits, . _ -"
TEXT = "a text in quotes of at most 512 characters"

# group, key, value as it stands in the file, what the message says is allowed
VALUES = [
    # beyond the bounds, each bound
    ("contact", "radius", "0", POSITIVE),
    ("contact", "radius", "-0.0127", POSITIVE),
    ("contact", "length", "0.0", POSITIVE),
    ("contact", "young_modulus", "0", POSITIVE),
    ("contact", "poisson_ratio", "-1", "a number > -1.0 and <= 0.5"),
    ("contact", "poisson_ratio", "0.51", "a number > -1.0 and <= 0.5"),
    ("lubricant", "viscosity", "0", POSITIVE),
    ("lubricant", "pressure_viscosity", "0", POSITIVE),
    ("lubricant", "pressure_viscosity", "-2e-8", POSITIVE),
    ("kinematics", "entrainment_speed", "0", POSITIVE),
    ("kinematics", "entrainment_speed", "-1.905", POSITIVE),
    ("load", "mass", "0", POSITIVE),
    ("load", "mass", "-3.0", POSITIVE),
    ("load", "mass", "1e-999", POSITIVE),
    ("load", "force_amplitude", "-1e-300", NOT_NEGATIVE),
    ("load", "frequency", "0", POSITIVE),
    ("load", "gravity", "-9.81", NOT_NEGATIVE),
    ("film", "initial_film", "0", POSITIVE),
    ("film", "initial_film", "-1e-6", POSITIVE),
    ("solver", "tolerance", "0", POSITIVE),
    ("solver", "iteration_limit", "0", "an integer >= 1 and <= 100000"),
    ("solver", "iteration_limit", "100001", "an integer >= 1 and <= 100000"),
    ("solver", "steps_per_period", "7", STEPS),
    ("solver", "steps_per_period", "10000001", STEPS),
    ("solver", "periods", "0", COUNT),
    ("solver", "periods", "1000000001", COUNT),
    ("spectrum", "periods", "0", COUNT),
    ("spectrum", "periods", "-2", COUNT),
    ("spectrum", "harmonic_threshold", "0", FRACTION),
    ("spectrum", "harmonic_threshold", "1.01", FRACTION),
    ("spectrum", "idle_harmonics", "0", COUNT),
    ("spectrum", "quiet_limit", "0", POSITIVE),
    ("spectrum", "irregular_limit", "0", FRACTION),
    ("spectrum", "irregular_limit", "1.5", FRACTION),
    ("output", "stride", "0", COUNT),
    # numbers that are none
    ("load", "mass", "nan", POSITIVE),
    ("load", "mass", "NaN(1)", None),
    ("load", "mass", "inf", POSITIVE),
    ("load", "steady_force", "-Infinity", "a number"),
    ("load", "steady_force", "1e999", "a number"),
    ("load", "steady_force", "-1d400", "a number"),
    ("load", "steady_force", "1e99999999999999999999", "a number"),
    ("load", "steady_force", "true", "a number"),
    ("load", "steady_force", "0x10", "a number"),
    ("load", "steady_force", "1.0_dp", "a number"),
    ("load", "steady_force", "1.2.3", "a number"),
    ("load", "steady_force", "--3", "a number"),
    ("load", "steady_force", "1e", "a number"),
    ("load", "steady_force", "e5", "a number"),
    ("load", "steady_force", "1e1.5", "a number"),
    ("load", "steady_force", "1+5", "a number"),
    ("load", "steady_force", ".", "a number"),
    ("load", "steady_force", "-", "a number"),
    ("load", "steady_force", "200N", "a number"),
    ("load", "steady_force", "(1.0,2.0)", None),
    ("load", "steady_force", "3/4", "a number"),
    ("load", "steady_force", "'199.2'", "a number"),
    # integers that are none, or that no machine integer holds
    ("solver", "periods", "2147483648", COUNT),
    ("solver", "periods", "99999999999999999999999", COUNT),
    ("solver", "periods", "3.0", COUNT),
    ("solver", "periods", "3e0", COUNT),
    ("solver", "periods", "three", COUNT),
    # logicals
    ("output", "series", "yes", FLAG),
    ("output", "series", "1", FLAG),
    ("output", "overwrite", "'true'", FLAG),
    # words
    ("scene", "task", "'film-thickness'", "one of 'motion'"),
    ("lubricant", "viscosity_law", "'eyring'", "one of 'constant' 'barus' 'roelands'"),
    ("film", "law", "'elastic'", "one of 'iso-viscous' 'piezo-viscous'"),
    ("film", "law", "'Iso-Viscous'", "one of 'iso-viscous' 'piezo-viscous'"),
    ("film", "law", "''", "one of 'iso-viscous' 'piezo-viscous'"),
    ("film", "law", "'iso-viscous piezo-viscous'", "one of 'iso-viscous' 'piezo-viscous'"),
    ("film", "model", "'exact'", "one of 'published'"),
    ("film", "rupture", "'pi'", "one of 'half-pi' 'solved'"),
    ("solver", "method", "'euler'", "one of 'newmark'"),
    ("solver", "iteration", "'fixed'", "one of 'newton' 'successive'"),
    ("solver", "predictor", "'none'", "one of 'extrapolated' 'previous'"),
    ("solver", "method", "newmark", "one of 'newmark'"),
    # names and folders
    ("scene", "name", "'results/idle'", NAME),
    ("scene", "name", "'../idle'", NAME),
    ("scene", "name", "'..'", NAME),
    ("scene", "name", "'.'", NAME),
    ("scene", "name", "'two words'", NAME),
    ("scene", "name", "'idle '", NAME),
    ("scene", "name", "'ra\u00e4tsel'", NAME),
    ("scene", "name", "'it''s'", NAME),
    ("scene", "name", "'" + "n" * 65 + "'", NAME),
    ("scene", "name", "''", TEXT),
    ("scene", "name", "'   '", TEXT),
    ("scene", "name", "'" + "n" * 513 + "'", TEXT),
    ("output", "directory", "''", TEXT),
    ("output", "directory", "'" + "d" * 513 + "'", TEXT),
]

NO_SPEED = {"entrainment_speed": None}


def line_of(text: str, key: str, group: str) -> int:
    """Line of `key = ...` behind `&group`."""
    lines = text.split("\n")
    opening = lines.index(f"&{group}")
    inside = next(i for i, line in enumerate(lines[opening:]) if line.startswith(f"   {key} ="))
    return opening + inside + 1


@pytest.mark.parametrize("file", BAD_FILES, ids=lambda file: file.stem)
def test_bad_file(file: Path, refused, tmp_path: Path) -> None:
    """The files show in their first lines what is expected of them."""
    text = file.read_text()
    expected = re.findall(r"^! expect: (.*)$", text, flags=re.MULTILINE)
    assert expected
    (tmp_path / "bad.nml").write_text(text)
    assert_faults(refused("bad.nml"), "bad.nml", expected)


def test_there_are_bad_files() -> None:
    assert len(BAD_FILES) >= 50


@pytest.mark.parametrize(("group", "key", "value", "allowed"), VALUES, ids=lambda item: str(item)[:24])
def test_bad_value(
    group: str, key: str, value: str, allowed: str | None, refused, scene_text, tmp_path: Path
) -> None:
    """One bad value is one fault: where it stands, what it is, what is allowed."""
    text = scene_text(**{group: {key: value}})
    (tmp_path / "scene.nml").write_text(text)
    faults = refused("scene.nml")
    place = f"scene.nml:{line_of(text, key, group)}: &{group} {key}: "
    assert faults[0].startswith(place)
    if allowed is None:
        return  # parentheses are taken for an index; any plain refusal will do
    assert len(faults) == 1, faults
    # New words may join the known ones; the bounds of a number are reported to the letter.
    reported = faults[0].partition(" is not allowed; allowed: ")[2]
    assert reported.startswith(allowed) if allowed.startswith("one of") else reported == allowed
    assert value[:20] in faults[0]


@pytest.mark.parametrize(
    ("group", "changes", "key"),
    [
        ("contact", {"radius": None, "radius_1": "0", "radius_2": "0.02"}, "radius_1"),
        ("contact", {"radius": None, "radius_1": "0.02", "radius_2": "-0.02"}, "radius_2"),
        ("kinematics", {**NO_SPEED, "rolling_speed": "0"}, "rolling_speed"),
        ("kinematics", {**NO_SPEED, "surface_speed_1": "nan", "surface_speed_2": "1"}, "surface_speed_1"),
        ("kinematics", {**NO_SPEED, "surface_speed_1": "-2", "surface_speed_2": "1"}, "surface_speed_1"),
        ("film", {"rupture": "'solved'", "rupture_solver": "'slow'"}, "rupture_solver"),
    ],
    ids=str,
)
def test_bad_value_among_others(
    group: str, changes: dict[str, str | None], key: str, refused, scene_text, tmp_path: Path
) -> None:
    text = scene_text(**{group: changes})
    (tmp_path / "scene.nml").write_text(text)
    faults = refused("scene.nml")
    assert len(faults) == 1, faults
    assert faults[0].startswith(f"scene.nml:{line_of(text, key, group)}: &{group} {key}: ")


def test_decimal_comma_is_not_a_point(refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text(load={"mass": "3,0"}))
    assert_faults(refused("scene.nml"), "scene.nml", ["13: &load mass: takes one value, 2 are given"])


def test_every_faulty_file_is_reported(refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "a.nml").write_text(scene_text(load={"mass": "0"}, film={"law": "'x'"}))
    (tmp_path / "b.nml").write_text(scene_text())
    (tmp_path / "c.nml").write_text(scene_text(contact={"radius": "none"}))
    faults = refused("a.nml", "missing.nml", "b.nml", "c.nml")
    assert [fault.split(" ")[0] for fault in faults] == ["a.nml:13:", "a.nml:19:", "missing.nml:", "c.nml:2:"]


def test_more_faults_than_anybody_reads(refused, tmp_path: Path) -> None:
    (tmp_path / "many.nml").write_text("&load\n" + "nonsense = 1\n" * 2000 + "/\n")
    faults = refused("many.nml")
    assert len(faults) == 1001
    assert re.fullmatch(r"and \d+ faults more", faults[-1])


# --- files that are no input -------------------------------------------------------------------------


def test_missing_file(refused) -> None:
    assert refused("absent.nml") == ["absent.nml: there is no such file"]


def test_file_below_a_file(refused, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert refused("file/absent.nml") == ["file/absent.nml: there is no such file"]


def test_folder_as_file(refused, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    assert refused("folder") == ["folder: it cannot be read as a file"]


@pytest.mark.parametrize("blanks", ["", "  "], ids=["no byte", "blanks only"])
def test_empty_file(blanks: str, refused, tmp_path: Path) -> None:
    (tmp_path / "empty.nml").write_text(blanks)
    assert_faults(refused("empty.nml"), "empty.nml", ["the file is empty"])


def test_empty_standard_input(refused) -> None:
    assert_faults(refused("-"), "standard input", ["the file is empty"])


def test_binary_file(refused, tmp_path: Path) -> None:
    (tmp_path / "binary.nml").write_bytes(b"&load\n mass = 3\x00.0\n" + bytes(range(256)) * 16)
    expected = ["2: not a text file: it holds the control character 0"]
    assert_faults(refused("binary.nml"), "binary.nml", expected)


def test_bytes_beyond_ascii(refused, tmp_path: Path) -> None:
    (tmp_path / "bytes.nml").write_bytes(bytes(range(128, 256)) * 16)
    assert refused("bytes.nml")[0].startswith("bytes.nml:1: text outside a group")


def test_program_as_input(refused, rattle: Path, tmp_path: Path) -> None:
    (tmp_path / "program").write_bytes(rattle.read_bytes()[:100000])
    assert_faults(refused("program"), "program", ["1: not a text file"])


def test_huge_file(refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "huge.nml").write_text(scene_text() + "! padding\n" * 1700000)
    assert_faults(refused("huge.nml"), "huge.nml", ["it is larger than 16777216 bytes"])


def test_endless_standard_input(rattle: Path, tmp_path: Path) -> None:
    """The limit on the size holds while reading, so an endless device is refused at once."""
    with open("/dev/zero", "rb") as endless:
        ended = subprocess.run(
            [rattle, "-"], cwd=tmp_path, stdin=endless, capture_output=True, timeout=600.0, check=False
        )
    assert ended.returncode == 2
    assert b"larger than" in ended.stderr


@pytest.mark.parametrize("name", ["a b.nml", "\u00e4.nml", 65 * "n" + ".nml"])
def test_file_name_that_names_no_scene(name: str, refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / name).write_text(scene_text())
    faults = refused(name)
    assert len(faults) == 1
    assert faults[0].startswith(f"{name}: &scene name: ")
    assert faults[0].endswith(f"allowed: {NAME}")
