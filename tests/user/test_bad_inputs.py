"""Bad input of every kind ends with code 2, one plain line per fault, and leaves the disk as it was."""

from __future__ import annotations

import os
import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

BAD_FILES = sorted((Path(__file__).resolve().parents[1] / "bad_inputs").glob("*.nml"))
TRACES_OF_A_CRASH = ("acktrace", "Program received", "forrtl", "Fortran runtime error", "At line")

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
    ("solver", "iteration_limit", "0", COUNT),
    ("solver", "iteration_limit", "1000000001", COUNT),
    ("solver", "steps_per_period", "7", STEPS),
    ("solver", "steps_per_period", "10000001", STEPS),
    ("solver", "periods", "0", COUNT),
    ("solver", "periods", "1000000001", COUNT),
    ("spectrum", "periods", "0", COUNT),
    ("spectrum", "periods", "-2", COUNT),
    ("spectrum", "line_threshold", "0", FRACTION),
    ("spectrum", "line_threshold", "1.01", FRACTION),
    ("spectrum", "idle_lines", "0", COUNT),
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
    ("lubricant", "viscosity_law", "'eyring'", "one of 'barus'"),
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


def contents(folder: Path) -> dict[str, bytes]:
    """Everything below a folder; folders themselves count as well."""
    return {
        str(path.relative_to(folder)): b"" if path.is_dir() else path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_dir() or path.is_file()
    }


@pytest.fixture
def refused(run, tmp_path: Path) -> Callable[..., list[str]]:
    """Call the program with bad input; return its faults, one per line, everything else checked."""

    def call(*arguments: object, **options: object) -> list[str]:
        before = contents(tmp_path)
        ended = run(*arguments, cwd=tmp_path, **options)
        assert ended.returncode == 2, ended
        assert ended.stdout == ""
        assert not [trace for trace in TRACES_OF_A_CRASH if trace in ended.stderr], ended.stderr
        assert contents(tmp_path) == before
        assert ended.stderr.endswith("\n")
        return ended.stderr[:-1].split("\n")

    return call


def assert_faults(found: list[str], file: object, expected: list[str]) -> None:
    """Each fault begins with 'file:', then with 'line: &group key: message' as expected, in this order."""
    wanted = [f"{file}:{'' if fault[0].isdigit() else ' '}{fault}" for fault in expected]
    assert len(found) == len(wanted), "\n".join(found)
    for fault, start in zip(found, wanted, strict=True):
        assert fault.startswith(start)


def line_of(text: str, key: str, group: str) -> int:
    """Line of `key = ...` behind `&group`."""
    lines = text.split("\n")
    opening = lines.index(f"&{group}")
    inside = next(i for i, line in enumerate(lines[opening:]) if line.startswith(f"   {key} ="))
    return opening + inside + 1


@pytest.mark.parametrize("file", BAD_FILES, ids=lambda file: file.stem)
def test_bad_file(file: Path, refused, tmp_path: Path) -> None:
    """The files tell in their first lines what is expected of them."""
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
    # New words may join the known ones; the bounds of a number are told to the letter.
    told = faults[0].partition(" is not allowed; allowed: ")[2]
    assert told.startswith(allowed) if allowed.startswith("one of") else told == allowed
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
    assert refused("absent.nml") == ["absent.nml: there is no such file, or it may not be read"]


def test_file_below_a_file(refused, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert refused("file/absent.nml") == ["file/absent.nml: there is no such file, or it may not be read"]


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
    (tmp_path / "huge.nml").write_text(scene_text() + "! padding\n" * 100000)
    assert_faults(refused("huge.nml"), "huge.nml", ["it is larger than 262144 bytes"])


def test_endless_standard_input(rattle: Path, tmp_path: Path) -> None:
    """The limit on the size holds while reading, so an endless device is refused at once."""
    with open("/dev/zero", "rb") as endless:
        ended = subprocess.run(
            [rattle, "-"], cwd=tmp_path, stdin=endless, capture_output=True, timeout=10, check=False
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


# --- arguments ---------------------------------------------------------------------------------------

ARGUMENTS = [
    (["--set"], "--set: a value must follow this option"),
    (["--output"], "--output: a value must follow this option"),
    (["--set", "load.mass"], "--set load.mass: write it as group.key=value"),
    (["--set", "mass=3"], "--set mass=3: write it as group.key=value"),
    (["--set", "load.=3"], "--set load.=3: write it as group.key=value"),
    (["--set", ".mass=3"], "--set .mass=3: write it as group.key=value"),
    (["--set", ""], "--set : write it as group.key=value"),
    (["--set", "lod.mass=3"], "--set lod.mass=3: &lod: unknown group; the nearest known group is &load"),
    (["--set", "load.mas=3"], "--set load.mas=3: &load mas: unknown key; the nearest known key is mass"),
    (["--set", "load.mass=heavy"], "--set load.mass=heavy: &load mass: heavy is not allowed"),
    (["--set", "load.mass=-1"], "--set load.mass=-1: &load mass: -1 is not allowed; allowed: a number > 0.0"),
    (["--set", "load.mass=1/2"], "--set load.mass=1/2: &load mass: 1/2 is not allowed"),
    (["--set", "load.mass="], "--set load.mass=: &load mass: a value is missing"),
    (["--set", "load.mass=1 2"], "--set load.mass=1 2: &load mass: takes one value, 2 are given"),
    (["--set", "film.law=elastic"], "--set film.law=elastic: &film law: 'elastic' is not allowed"),
    (["--set", "film.law='iso"], "--set film.law='iso: &film law: the closing quote is missing"),
    (["--set", "output.columns=time,speed"], "--set output.columns=time,speed: &output columns: 'speed'"),
    (["--set", "scene.name=a/b"], "--set scene.name=a/b: &scene name: 'a/b' is not allowed"),
    (["--set", "load.steady_force=-100"], "--set load.steady_force=-100: &load steady_force: the static"),
    (["--set", "spectrum.periods=4"], "scene.nml:23: &solver periods: at least &spectrum periods (4)"),
    (["--output", ""], "--output : &output directory: '' is not allowed"),
    (["--output", "d" * 513], f"--output {'d' * 513}: &output directory: "),
    (["--overwrit"], "--overwrit: unknown option; rattle --help lists all"),
    (["-q"], "-q: unknown option"),
    (["--check=yes"], "--check=yes: unknown option"),
    ([""], "'': the name of an input file is empty"),
    (["--template", "loda"], "--template: &loda: unknown group; the nearest known group is &load"),
]


@pytest.mark.parametrize(("arguments", "expected"), ARGUMENTS, ids=lambda item: " ".join(item)[:40])
def test_bad_arguments(arguments: list[str], expected: str, refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    faults = refused("scene.nml", *arguments)
    assert len(faults) == 1, faults
    assert faults[0].startswith(expected)


def test_fault_of_the_command_line_is_told_once(refused, scene_text, tmp_path: Path) -> None:
    for name in ("a.nml", "b.nml"):
        (tmp_path / name).write_text(scene_text())
    assert len(refused("a.nml", "b.nml", "--set", "load.mass=heavy")) == 1


def test_no_arguments(refused) -> None:
    faults = refused()
    assert faults[0] == "rattle: no input file is given"
    assert faults[1].startswith("rattle [options] FILE.nml")


def test_equal_names(refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "a.nml").write_text(scene_text(scene={"name": "'b'"}))
    (tmp_path / "b.nml").write_text(scene_text())
    assert refused("a.nml", "b.nml") == ["b.nml: &scene name: 'b' is also the name of a.nml"]


def test_same_file_twice(refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "a.nml").write_text(scene_text())
    assert refused("a.nml", "./a.nml") == ["./a.nml: &scene name: 'a' is also the name of a.nml"]


# --- places for the output ---------------------------------------------------------------------------


def test_folder_below_a_file(refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    (tmp_path / "file").write_text("mine")
    faults = refused("scene.nml", "--output", "file/below")
    assert faults == ["scene.nml: &output directory: the folder 'file/below' cannot be made"]


def test_file_in_place_of_the_folder(refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    (tmp_path / "results").write_text("mine")
    assert refused("scene.nml") == ["scene.nml: &output directory: 'results' is a file; a folder is needed"]


def test_folder_where_none_can_be_made(refused, scene_text, tmp_path: Path) -> None:
    """/proc takes no folders, not even from root."""
    (tmp_path / "scene.nml").write_text(scene_text())
    faults = refused("scene.nml", "--output", "/proc/rattle/results")
    assert faults == ["scene.nml: &output directory: the folder '/proc/rattle/results' cannot be made"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_folder_without_permission(refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    (tmp_path / "results").mkdir(mode=0o555)
    assert refused("scene.nml") == ["scene.nml: &output directory: the folder 'results' is not writable"]


def test_folder_without_permission_for_all(refused, scene_text, tmp_path: Path) -> None:
    """A folder that is there but takes no files, not even from root."""
    (tmp_path / "scene.nml").write_text(scene_text())
    faults = refused("scene.nml", "--output", "/proc/self")
    assert len(faults) == 1
    assert faults[0].startswith("scene.nml: &output directory: the folder '/proc/self' ")


def test_unusable_place_of_one_scene_stops_all(refused, scene_text, tmp_path: Path) -> None:
    """No folder is made for the first scene when the second has nowhere to go."""
    (tmp_path / "a.nml").write_text(scene_text(output={"directory": "'new/a'"}))
    (tmp_path / "b.nml").write_text(scene_text(output={"directory": "'b.nml'"}))
    assert refused("a.nml", "b.nml") == ["b.nml: &output directory: 'b.nml' is a file; a folder is needed"]


def test_result_that_exists(refused, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    faults = refused("scene.nml")
    assert faults == [
        f"scene.nml: &output overwrite: results/scene.{kind} exists; --overwrite replaces it"
        for kind in ("rattle", "state", "summary.nml", "log")
    ]


@pytest.mark.parametrize("overwrite", [[], ["--overwrite"], ["--set", "output.overwrite=.true."]])
@pytest.mark.parametrize("kind", ["rattle", "summary.nml", "log"])
@pytest.mark.parametrize(
    "mine", ["", "R", "my notes\n", "!&summary\n"], ids=["empty", "one letter", "notes", "nearly a summary"]
)
def test_file_of_another_kind_is_never_replaced(
    mine: str, kind: str, overwrite: list[str], refused, scene_text, tmp_path: Path
) -> None:
    """Content is compared by the fixture."""
    (tmp_path / "scene.nml").write_text(scene_text())
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / f"scene.{kind}").write_text(mine)
    faults = refused("scene.nml", *overwrite)
    expected = f"results/scene.{kind} exists and was not written by rattle; it is never replaced"
    assert faults == [f"scene.nml: &output: {expected}"]


@pytest.mark.parametrize("kind", ["rattle", "summary.nml", "log"])
def test_folder_in_place_of_a_file(kind: str, refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    (tmp_path / "results" / f"scene.{kind}").mkdir(parents=True)
    faults = refused("scene.nml", "--overwrite")
    assert len(faults) == 1
    assert f"results/scene.{kind} exists and was not written by rattle" in faults[0]


def test_link_to_a_file_of_another_kind_is_never_followed(refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    (tmp_path / "mine").write_text("my notes\n")
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "scene.rattle").symlink_to(tmp_path / "mine")
    faults = refused("scene.nml", "--overwrite")
    assert len(faults) == 1
    assert "results/scene.rattle exists and was not written by rattle" in faults[0]


def test_pipe_in_place_of_a_file(refused, scene_text, tmp_path: Path) -> None:
    """Looking at a pipe that nobody writes to must not wait for ever."""
    (tmp_path / "scene.nml").write_text(scene_text())
    (tmp_path / "results").mkdir()
    os.mkfifo(tmp_path / "results" / "scene.log")
    faults = refused("scene.nml", "--overwrite", timeout=5.0)
    assert len(faults) == 1
    assert "results/scene.log exists and was not written by rattle" in faults[0]


# --- what looks odd but is valid ---------------------------------------------------------------------

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
