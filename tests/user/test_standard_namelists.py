"""Namelists as the standard has them, as gfortran reads them, and as f90nml writes them."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import f90nml
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rattle.namelist import parse_groups

REPOSITORY = Path(__file__).resolve().parents[2]
READY = sorted((REPOSITORY / "input").glob("*.nml"))
WORDS = ("rupture", "load", "stiffness", "damping", "pressure")
SCENE = (
    "&scene task = 'film' /\n"
    "&contact radius = 0.0127, length = 0.010 /\n"
    "&lubricant viscosity = 0.3, pressure_viscosity = 2.0e-8 /\n"
)

Lists = dict[str, list[float | str | None]]


@pytest.fixture(scope="session")
def runtime(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Path], Lists]:
    """What the runtime of gfortran reads of the group &points in a file."""
    program = tmp_path_factory.mktemp("reader") / "namelist_reader"
    source = Path(__file__).with_name("namelist_reader.f90")
    subprocess.run(["gfortran", source, "-o", program], check=True)

    def read(path: Path) -> Lists:
        ended = subprocess.run([program, path], capture_output=True, text=True, check=False)
        assert ended.returncode == 0, ended.stderr + path.read_text()
        lists: Lists = {}
        for line in ended.stdout.splitlines():
            name, *words = line.split()
            values = [None if word == "-" else word if name == "compute" else float(word) for word in words]
            while values and values[-1] is None:
                values.pop()
            lists[name] = values
        return lists

    return read


@pytest.fixture
def resolved(run, tmp_path: Path) -> Callable[..., str]:
    """The resolved input of a text that must be valid."""

    def call(text: str | bytes, *arguments: str) -> str:
        path = tmp_path / "scene.nml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        ended = run("--check", *arguments, path.name, cwd=tmp_path)
        assert (ended.returncode, ended.stderr) == (0, ""), ended
        return ended.stdout

    return call


# --- texts drawn from the grammar, against gfortran ------------------------------------------------------

SEPARATORS = st.sampled_from([", ", " ", " , ", "\n  ", ",\n", " ! a / in a comment\n", ",\t"])
NUMBERS = st.floats(1e-19, 9e9) | st.integers(1, 1000).map(float)


def spelled(draw, value: float | str) -> str:
    """One value in one of its spellings."""
    if isinstance(value, str):
        quote = draw(st.sampled_from("'\""))
        return quote + value + quote
    mantissa, _, exponent = f"{value!r}".partition("e")
    if not exponent:
        return draw(
            st.sampled_from([mantissa, f"+{mantissa}", f"{mantissa}e0", f"{mantissa}+0", f"{value:.17e}"])
        )
    sign = "" if exponent[0] in "+-" else "+"
    if "." not in mantissa:
        mantissa += "."
    return mantissa + draw(st.sampled_from(["e", "D", "q", "Q" + sign, sign])) + exponent


def listed(draw, values: list, most: int = 9) -> str:
    """Values with separators, repeat counts of at most `most`, and null values."""
    text = ""
    place = 0
    while place < len(values):
        same = 1
        while place + same < len(values) and values[place + same] == values[place]:
            same += 1
        count = draw(st.integers(1, min(same, most)))
        value = values[place]
        repeated = count > 1 or (most > 1 and draw(st.integers(0, 9)) == 0)
        last = place + count == len(values)
        if value is None and not repeated:
            text += ", "  # a null value between two commas, or before the first
        else:
            text += f"{count}*" if repeated else ""
            text += "" if value is None else spelled(draw, value)
            follows_null = not last and values[place + count] is None
            text += "" if last else ", " if follows_null or value is None else draw(SEPARATORS)
        place += count
    return text


def assignments(draw, name: str, values: list) -> list[str]:
    """A list in one go, or by sections and elements in any order."""
    name = draw(st.sampled_from([name, name.upper()]))
    way = draw(st.sampled_from(["whole", "pieces", "strides"]))
    count = len(values)
    if way == "whole":
        place = draw(st.sampled_from(["", "(:)", "(1:)", "(1)", f"(1:{count})"]))
        return [f"{name}{place} = {listed(draw, values, most_repeats(place))}"]
    if way == "strides":
        step = draw(st.integers(1, 3))
        pieces = []
        for first in range(min(step, count)):
            part = values[first::step]
            ends = first + 1, first + 1 + step * (len(part) - 1)
            if draw(st.booleans()):
                pieces.append((f"{ends[1]}:{ends[0]}:-{step}", part[::-1]))
            else:
                pieces.append((f"{ends[0]}:{ends[1]}:{step}", part))
    else:
        cut = draw(st.integers(1, count))
        pieces = [(f"{i + 1}", [values[i]]) for i in range(cut)]
        if cut < count:
            pieces.append(
                (draw(st.sampled_from([f"{cut + 1}:", f"{cut + 1}:{count}", f"{cut + 1}"])), values[cut:])
            )
    pieces = draw(st.permutations(pieces))
    return [
        f"{name}({place}) = {listed(draw, part, most_repeats(place))}"
        for place, part in pieces
        if set(part) != {None}
    ]


def most_repeats(place: str) -> int:
    """gfortran goes on behind a single element, but with no repeat counts."""
    return 9 if place == "" or ":" in place else 1


@st.composite
def groups(draw) -> tuple[str, Lists]:
    """A group &points and what its lists hold."""
    lists: Lists = {}
    for name in ("film_ratios", "squeeze_ratios", "speed_groups"):
        few = draw(st.lists(NUMBERS, min_size=1, max_size=3))
        values = draw(st.lists(st.sampled_from(few) | st.none(), max_size=8))
        lists[name] = [*values, few[0]]
    lists["compute"] = list(draw(st.permutations(WORDS)))[: draw(st.integers(1, 5))]
    text = draw(st.permutations([part for name in lists for part in assignments(draw, name, lists[name])]))
    sign, end = draw(st.sampled_from([("&", "/"), ("&", "&end"), ("$", "$END"), ("&", "/ and so on")]))
    between = draw(st.sampled_from([",\n", "\n", ", ", " "]))
    before = draw(st.sampled_from(["", "A film, see 3.2.\n", "  ! nothing\n\n"]))
    return (
        f"{before}{sign}points\n{between.join(text)}{draw(st.sampled_from(['', ',', ' ']))}\n{end}\n",
        lists,
    )


@settings(
    max_examples=60,
    derandomize=True,
    database=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(drawn=groups())
def test_drawn_texts_are_read_as_gfortran_reads_them(drawn, runtime, run, tmp_path: Path) -> None:
    """The same values; an element that is left unset between others is one fault that names it."""
    text, lists = drawn
    path = tmp_path / "scene.nml"
    path.write_text(text + SCENE)
    assert runtime(path) == lists, text
    ended = run("--check", path.name, cwd=tmp_path)
    faulty = {name: values.index(None) + 1 for name, values in lists.items() if None in values}
    if faulty:
        assert ended.returncode == 2, text
        assert len(ended.stderr.splitlines()) == len(faulty), ended.stderr
        for name, place in faulty.items():
            assert (
                f"&points {name}: element {place} is not set, but element {len(lists[name])} is"
                in ended.stderr
            )
        return
    assert (ended.returncode, ended.stderr) == (0, ""), (ended, text)
    found = f90nml.reads(ended.stdout)["points"]
    for name, values in lists.items():
        given = found[name] if isinstance(found[name], list) else [found[name]]
        assert given == values, (name, text)
    by_script = parse_groups(text)["points"] if ":-" not in text else None
    for name, values in lists.items() if by_script else ():
        given = by_script[name] if isinstance(by_script[name], list) else [by_script[name]]
        assert given == values, ("by the scripts", name, text)


# --- files that f90nml writes -----------------------------------------------------------------------------

STYLES = (
    {"end_comma": True},
    {"repeat_counter": True, "index_spacing": True},
    {"column_width": 24, "uppercase": True, "default_start_index": 1},
    {"repeat_counter": True, "index_spacing": True, "column_width": 24, "uppercase": True, "end_comma": True},
)


@pytest.fixture(scope="module")
def checked(run) -> Callable[[Path], list[str]]:
    """What is found of all ready inputs in a folder, without the names of files that warnings begin with."""
    alone = [
        path.name for path in READY if "'campaign'" in path.read_text() or "'threshold'" in path.read_text()
    ]
    together = [path.name for path in READY if path.name not in alone]

    def check(folder: Path) -> list[str]:
        lines = []
        for names in (together, *([name] for name in alone)):
            ended = run("--check", *names, cwd=folder)
            assert (ended.returncode, ended.stderr) == (0, ""), ended.stderr
            found = [line for line in ended.stdout.splitlines() if "core time" not in line]
            lines += [re.sub(r"\.nml:\d+", ".nml", line) for line in found]
        return lines

    return check


@pytest.fixture(scope="module")
def ready(checked) -> list[str]:
    """What is found of the ready inputs as they are."""
    return checked(REPOSITORY / "input")


@pytest.mark.parametrize("style", STYLES, ids="-".join)
def test_files_of_f90nml(style: dict, checked, ready, tmp_path: Path) -> None:
    """All ready inputs, written anew, resolve to the same scene."""
    for data in (REPOSITORY / "input").glob("*.csv"):
        shutil.copy(data, tmp_path)
    for path in READY:
        groups = f90nml.read(path)
        for name, value in style.items():
            setattr(groups, name, value)
        groups.write(tmp_path / path.name)
    assert checked(tmp_path) == ready


def test_a_patched_template(run, resolved, tmp_path: Path) -> None:
    """f90nml changes values within the text, comments stay."""
    template = run("--template", cwd=tmp_path).stdout
    (tmp_path / "template.nml").write_text(template)
    changes = {"load": {"mass": 2.5, "frequency": 500.0}, "output": {"columns": ["time", "acceleration"]}}
    f90nml.patch(tmp_path / "template.nml", changes, tmp_path / "patched.nml")
    patched = resolved((tmp_path / "patched.nml").read_text())
    settings = ("load.mass=2.5", "load.frequency=500.0", "output.columns='time','acceleration'")
    assert patched == resolved(template, *(word for setting in settings for word in ("--set", setting)))


# --- what surrounds values --------------------------------------------------------------------------------

PLAIN = SCENE + "&points film_ratios = 1.0e-4, 2.0e-4, speed_groups = 1.0e-6 /\n"
SPELLINGS = {
    "old closings": PLAIN.replace(" /\n", " &end\n"),
    "dollars": PLAIN.replace("&", "$").replace(" /\n", " $END\n"),
    "text": "Film of a pair; R&D, $5, it's old\n====\n" + PLAIN.replace(" /\n", " / as drawn: d = 3\n"),
    "hashes": "# &gear = 3\n" + PLAIN.replace("&points", "&points\n  # it's a comment, a = 3\n"),
    "dos": PLAIN.replace("\n", "\r\n") + "\x1a",
    "page feed": "\x0c" + PLAIN.replace("\n", "\n\x0c"),
    "byte order mark": "\ufeff" + PLAIN,
    "subscripts": PLAIN.replace("film_ratios = ", "film_ratios( 1 : 2 )="),
    "open stride": PLAIN.replace("film_ratios = 1.0e-4, 2.0e-4", "film_ratios(::1) = 1.0e-4, 2.0e-4"),
    "exponents": PLAIN.replace("1.0e-6", "1.0q-6").replace("2.0e-4", "2.0-4").replace("0.3", "3.0D-01"),
    "nulls": PLAIN.replace("&points", "&points squeeze_ratios = 2*, compute = , ,"),
    "repeats": PLAIN.replace("radius = 0.0127", "radius = 1*0.0127"),
}


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_spellings_of_one_scene(spelling: str, resolved) -> None:
    """The program resolves the same scene, and the scripts find the same values."""
    assert resolved(SPELLINGS[spelling]) == resolved(PLAIN)
    found = parse_groups(SPELLINGS[spelling])
    for group, keys in f90nml.reads(PLAIN).items():
        for key, value in keys.items():
            assert found[group][key] == value


FORCES = {"force_amplitude": None, "force_orders": "1, 2, 3", "force_amplitudes": "3*50.0"}


def test_null_values_leave_what_was_there(scene_text, resolved) -> None:
    """On the command line they leave the element that the file has."""
    text = scene_text(load=FORCES)
    for setting in ("load.force_amplitudes = ,,60.0", "load.force_amplitudes(2:) = ,60.0"):
        found = f90nml.reads(resolved(text, "--set", setting))["load"]
        assert found["force_amplitudes"] == [50.0, 50.0, 60.0]
    assert f90nml.reads(resolved(text, "--set", "load.mass=1*"))["load"]["mass"] == 3.0


def test_a_key_of_null_values_is_not_set(scene_text, refused, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text(load={"mass": "1*"}))
    assert refused("scene.nml") == ["scene.nml: &load mass: this key is required; allowed: a number > 0.0"]


def test_unset_elements_mean_what_an_absent_key_means(scene_text, resolved) -> None:
    """A phase is 0; a range is divided linearly."""
    found = f90nml.reads(resolved(scene_text(load={**FORCES, "force_phases": ", 0.5, 0.25"})))["load"]
    assert found["force_phases"] == [0.0, 0.5, 0.25]
    campaign = {"vary": "'load.mass', 'load.frequency'", "first": "2.0, 500.0", "last": "3.0, 600.0"}
    campaign |= {"count": "2*2", "scale(2)": "'logarithmic'"}
    text = scene_text(
        scene={"task": "'campaign'"}, solver={"method": None, "steps_per_period": None}, campaign=campaign
    )
    assert f90nml.reads(resolved(text))["campaign"]["scale"] == ["linear", "logarithmic"]


def test_a_gap_is_closed_from_the_command_line(scene_text, resolved) -> None:
    text = scene_text(load={**FORCES, "force_amplitudes": None, "force_amplitudes(::2)": "2*50.0"})
    found = f90nml.reads(resolved(text, "--set", "load.force_amplitudes(2)=7.0"))["load"]
    assert found["force_amplitudes"] == [50.0, 7.0, 50.0]


def test_a_key_may_be_varied_over_values_beside_a_range(scene_text, resolved) -> None:
    """The columns of values before that of the second key are empty."""
    campaign = {"vary": "'load.mass', 'load.frequency'", "first": "2.0", "last": "3.0", "count": "3"}
    campaign["values(:, 2)"] = "500.0, 600.0, 550.0"
    text = scene_text(
        scene={"task": "'campaign'"}, solver={"method": None, "steps_per_period": None}, campaign=campaign
    )
    assert "values(:, 2) = 500.0, 600.0, 550.0\n" in resolved(text)


def test_a_design_over_a_standard_input(repository: Path, scene_text, run, tmp_path: Path) -> None:
    """The script that writes designs reads what the program reads, and the program what it writes."""
    campaign = {
        "vary(2)": "'load.frequency'",
        "vary(1)": "'load.mass'",
        "first": "2.0q0, 5.0+2",
        "last(:)": "3.0, 600.0",
    }
    text = scene_text(
        scene={"task": "'campaign'"}, solver={"method": None, "steps_per_period": None}, campaign=campaign
    )
    (tmp_path / "study.nml").write_text(
        "A study of R&D\n# 2 keys\n" + text.replace("&", "$").replace("\n/", "\n$end")
    )
    script = repository / "scripts" / "sensitivity.py"
    subprocess.run([sys.executable, script, "design", "study.nml", "--blocks", "2"], cwd=tmp_path, check=True)
    design = (tmp_path / "study.design.csv").read_text().splitlines()
    assert design[0] == "load.mass,load.frequency"
    assert all(2.0 <= float(row.split(",")[0]) <= 3.0 for row in design[1:])
    ended = run("--check", "study_design.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
