"""Bad arguments end with code 2 and one plain line each, and leave the disk as it was."""

from __future__ import annotations

from pathlib import Path

import pytest

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
