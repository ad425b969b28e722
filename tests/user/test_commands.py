"""What the options do."""

from __future__ import annotations

from pathlib import Path

import f90nml
from outcomes import summary_of

from rattle import read


def test_set_comes_before_the_file(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    settings = ["load.mass=2.5", "LOAD.Gravity=0", "film.law=piezo-viscous", "output.columns=time,film_load"]
    options = [part for setting in settings for part in ("--set", setting)]
    echo = f90nml.reads(run("--check", *options, "scene.nml", cwd=tmp_path).stdout)
    assert echo["load"]["mass"] == 2.5
    assert echo["load"]["gravity"] == 0.0
    assert echo["film"]["law"] == "piezo-viscous"
    assert echo["output"]["columns"] == ["time", "film_load"]


def test_last_set_wins(run, scene_text, tmp_path: Path) -> None:
    options = ["--set", "load.mass=2.5", "--set", "load.mass=4"]
    echo = f90nml.reads(run("--check", "-", *options, cwd=tmp_path, stdin=scene_text()).stdout)
    assert echo["load"]["mass"] == 4.0


def test_set_mends_a_missing_key(run, scene_text, tmp_path: Path) -> None:
    ended = run("--check", "-", "--set", "load.mass=2", cwd=tmp_path, stdin=scene_text(load={"mass": None}))
    assert ended.returncode == 0


def test_set_takes_quotes_as_well(run, scene_text, tmp_path: Path) -> None:
    options = ["--set", "scene.name='a'", "--set", "output.columns='time', \"acceleration\""]
    echo = f90nml.reads(run("--check", "-", *options, cwd=tmp_path, stdin=scene_text()).stdout)
    assert echo["scene"]["name"] == "a"
    assert echo["output"]["columns"] == ["time", "acceleration"]


def test_output_makes_the_folder(run, scene_text, tmp_path: Path) -> None:
    ended = run("-", "--output", "new/it's/here", cwd=tmp_path, stdin=scene_text(scene={"name": "'a'"}))
    assert ended.returncode == 0
    assert sorted(path.name for path in (tmp_path / "new" / "it's" / "here").iterdir()) == [
        "a.log",
        "a.rattle",
        "a.state",
        "a.summary.nml",
    ]
    assert not (tmp_path / "results").exists()


def test_output_takes_an_absolute_path(run, scene_text, tmp_path: Path) -> None:
    assert run("-", "--output", tmp_path / "there", cwd=tmp_path, stdin=scene_text()).returncode == 0
    assert (tmp_path / "there" / "standard-input.rattle").is_file()


def test_overwrite_replaces_earlier_results(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    ended = run("--overwrite", "scene.nml", "--set", "solver.periods=2", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    result = read(tmp_path / "results" / "scene.rattle")
    assert result.closed
    assert result.row_count == 2 * 32 + 1
    assert summary_of(tmp_path / "results" / "scene.summary.nml")["steps"] == 64


def test_overwrite_replaces_an_unclosed_result(run, scene_text, tmp_path: Path) -> None:
    """What a killed run left behind is a result of an earlier run, too."""
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    path = tmp_path / "results" / "scene.rattle"
    whole = path.read_bytes()
    path.write_bytes(whole[:24] + (-1).to_bytes(8, "little", signed=True) + whole[32:-100])
    assert not read(path).closed
    assert run("--overwrite", "scene.nml", cwd=tmp_path).returncode == 0
    assert path.read_bytes() == whole


def test_quiet_prints_nothing(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    ended = run("--quiet", "scene.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")
    assert "steady film" in (tmp_path / "results" / "scene.log").read_text()


def test_quiet_still_tells_faults(run, tmp_path: Path) -> None:
    ended = run("--quiet", "absent.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert ended.stderr.startswith("absent.nml: ")


def test_verbose_shows_all_of_the_log(run, scene_text, tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / f"{name}.nml").write_text(scene_text())
    ended = run("--verbose", "a.nml", "b.nml", cwd=tmp_path)
    logs = [(tmp_path / "results" / f"{name}.log").read_text() for name in ("a", "b")]
    assert ended.stdout == "".join(logs)
    for name, log in zip(("a", "b"), logs, strict=True):
        assert log.startswith("rattle ")
        assert f"scene {name}" in log
        assert f"results/{name}.summary.nml" in log
