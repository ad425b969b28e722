"""Looking, not running: --check, --template, --keys, --version, --help."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from rattle.keys import read_page

GROUPS = (
    "scene",
    "contact",
    "lubricant",
    "kinematics",
    "load",
    "film",
    "gear",
    "shaft",
    "oil",
    "solver",
    "spectrum",
    "points",
    "sweep",
    "campaign",
    "threshold",
    "output",
)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"film": {"law": "'piezo-viscous'"}},
        {"film": {"law": "'iso-viscous'", "rupture": "'solved'", "rupture_solver": "'successive'"}},
        {"contact": {"radius": None, "radius_1": "0.02", "radius_2": "0.0345678901234567"}},
        {"kinematics": {"entrainment_speed": None, "surface_speed_1": "3", "surface_speed_2": "-0.1"}},
        {"film": {"initial_film": "1.2345678901234567e-6", "initial_velocity": "-1d-3"}},
        {
            "output": {"columns": "'time', 'film_load'", "series": "f", "stride": "8"},
            "scene": {"name": "'x'"},
        },
    ],
    ids=["plain", "piezo-viscous", "solved rupture", "two radii", "two speeds", "start", "output"],
)
def test_echo_of_check_is_itself_an_input(changes: dict, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text(**changes))
    first = run("--check", "scene.nml", cwd=tmp_path)
    assert (first.returncode, first.stderr) == (0, "")
    again = run("--check", "-", cwd=tmp_path, stdin=first.stdout)
    assert (again.returncode, again.stderr) == (0, "")
    assert again.stdout == first.stdout.replace("! scene.nml:", "! standard input:")
    assert [path.name for path in tmp_path.iterdir()] == ["scene.nml"]


def test_check_tells_derived_values(run, scene_text, tmp_path: Path) -> None:
    """At rest the load of (35) is inversely proportional to the film, so its stiffness is (Q + m g)/h0."""
    echo = run("--check", "-", cwd=tmp_path, stdin=scene_text()).stdout
    film = float(re.search(r"steady film +(\S+) m", echo)[1])
    frequency = float(re.search(r"natural frequency +(\S+) Hz", echo)[1])
    load = 199.2 + 3.0 * 9.80665
    assert frequency == pytest.approx(np.sqrt(load / film / 3.0) / (2 * np.pi), rel=1e-5)
    for words in ("damping ratio", "squeeze group A", "pressure group B", "largest alpha p"):
        assert words in echo


def test_check_of_several_files(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "a.nml").write_text(scene_text())
    (tmp_path / "b.nml").write_text(scene_text(load={"mass": "2"}))
    echo = run("--check", "a.nml", "b.nml", cwd=tmp_path).stdout
    assert "! a.nml: valid" in echo
    assert "   mass = 3.0\n" in echo.split("! b.nml: valid")[0]
    assert "   mass = 2.0\n" in echo.split("! b.nml: valid")[1]


def test_check_does_not_mind_existing_results(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    assert run("--check", "scene.nml", cwd=tmp_path).returncode == 0


def test_template_is_a_valid_input(run, tmp_path: Path) -> None:
    template = run("--template", cwd=tmp_path)
    assert (template.returncode, template.stderr) == (0, "")
    assert [line[1:] for line in template.stdout.split("\n") if line.startswith("&")] == list(GROUPS)
    checked = run("--check", "-", cwd=tmp_path, stdin=template.stdout)
    assert (checked.returncode, checked.stderr) == (0, "")


def test_template_with_every_key_uncommented_names_only_known_keys(run, tmp_path: Path) -> None:
    """The only faults left are those of keys that exclude each other or have no default."""
    template = run("--template", cwd=tmp_path).stdout
    everything = re.sub(r"^   ! (\w+ =)", r"   \1", template, flags=re.MULTILINE)
    faults = run("--check", "-", cwd=tmp_path, stdin=everything).stderr
    assert "unknown" not in faults
    assert faults.count("\n") > 0


@pytest.mark.parametrize("group", [*GROUPS, "LOAD"])
def test_template_of_one_group(group: str, run, tmp_path: Path) -> None:
    whole = run("--template", cwd=tmp_path).stdout
    part = run("--template", f"&{group}", cwd=tmp_path)
    assert part.returncode == 0
    assert re.findall(r"^&(\w+)$", part.stdout, flags=re.MULTILINE) == [group.lower()]
    assert part.stdout in whole


def test_every_ready_input_is_in_the_list_of_the_page(repository: Path) -> None:
    page = (repository / "input" / "README.md").read_text()
    listed = page.partition("## Ready inputs")[2].partition("\n## ")[0]
    assert set(re.findall(r"`(\w+\.nml)`", listed)) == {
        path.name for path in (repository / "input").glob("*.nml")
    }


READY = {
    "gearbox": "gearbox",
    "motion": "loose_pair",
    "film": "film",
    "sweep": "sweep",
    "campaign": "map",
    "threshold": "threshold",
}


@pytest.mark.parametrize("name", READY)
def test_template_of_a_ready_input_is_valid_as_it_is(name: str, run, repository, tmp_path: Path) -> None:
    template = run("--template", name, cwd=tmp_path)
    assert (template.returncode, template.stderr) == (0, "")
    assert template.stdout == (repository / "input" / f"{READY[name]}.nml").read_text()
    (tmp_path / f"{name}.nml").write_text(template.stdout)
    checked = run("--check", f"{name}.nml", cwd=tmp_path)
    assert (checked.returncode, checked.stderr) == (0, "")


def test_template_of_a_group_needs_no_sign_but_where_a_ready_input_has_its_name(run, tmp_path: Path) -> None:
    assert run("--template", "load", cwd=tmp_path).stdout == run("--template", "&load", cwd=tmp_path).stdout
    film = run("--template", "&film", cwd=tmp_path).stdout
    assert film.startswith("&film\n") and film != run("--template", "film", cwd=tmp_path).stdout


def test_version(run, repository: Path, tmp_path: Path) -> None:
    ended = run("--version", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    first, second = ended.stdout.splitlines()
    assert first == f"rattle {(repository / 'fsrc' / 'VERSION').read_text().strip()}"
    assert re.fullmatch(
        r"built with(out)? MPI, for registers of (four|eight) numbers, by GCC version .+", second
    )


def test_help_names_every_option(run, tmp_path: Path) -> None:
    ended = run("--help", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    options = "check template keys set output overwrite quiet verbose version help"
    for option in options.split():
        assert f"--{option}" in ended.stdout
    assert run("-h", cwd=tmp_path).stdout == ended.stdout


def test_page_of_keys(run, repository: Path, tmp_path: Path) -> None:
    ended = run("--keys", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    template = run("--template", cwd=tmp_path).stdout
    keys, group = [], ""
    for begun, key in re.findall(r"^(?:&(\w+)|   (?:! )?(\w+) =)", template, flags=re.MULTILINE):
        group = begun or group
        if key:
            keys.append((group, key))
    assert len(keys) > 30
    page_of_keys, _, quantities = ended.stdout.partition("## Quantities")
    reported = read_page(page_of_keys)
    assert sorted(reported) == sorted(keys)
    assert len(re.findall(r"^\| `\w+` \|", page_of_keys, flags=re.MULTILINE)) == len(keys)
    table = run("--quantities", cwd=tmp_path).stdout.splitlines()
    assert [row.split(",")[0] for row in table[1:]] == re.findall(
        r"^\| `(\w+)` \|", quantities, flags=re.MULTILINE
    )
    page = (repository / "input" / "KEYS.md").read_text()
    assert re.findall(r"^<!-- tables.*?-->\n(.*)^<!-- end of tables -->", page, re.M | re.S) == [ended.stdout]


def test_conditions_of_keys(run, tmp_path: Path) -> None:
    """The tasks that use a key stand above its table, what else it needs in a column."""
    reported = read_page(run("--keys", cwd=tmp_path).stdout)
    motions = ("motion", "sweep", "campaign", "threshold")
    for key, conditions in {
        ("contact", "length"): ((), "no `&gear`"),
        ("contact", "young_modulus"): ((), ""),
        ("contact", "backlash"): (motions, "no `&gear`"),
        ("gear", "teeth_1"): (motions, ""),
        ("gear", "contact_lines"): (motions, "no `gear.tip_diameter_1`"),
        ("gear", "drag_scale"): (motions, "`gear.bearing_mean_diameter` or `gear.drag_table`"),
        ("gear", "bearing_factor"): (motions, "`gear.bearing_mean_diameter`, no `gear.bearing_width`"),
        ("film", "rupture"): (motions, "`film.law=iso-viscous`, `film.model=published`"),
        ("shaft", "signal"): (motions, "no `shaft.table`"),
        ("solver", "accuracy"): (motions, "`solver.method=taylor`"),
        ("solver", "time_limit"): (("motion",), ""),
        ("output", "directory"): ((), ""),
    }.items():
        assert (reported[key].tasks, reported[key].used_with) == conditions, key


@pytest.mark.parametrize("scene", ["idle", "creep"])
def test_ready_scenes_are_valid(scene: str, run, repository: Path, tmp_path: Path) -> None:
    ended = run("--check", repository / "input" / f"{scene}.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
