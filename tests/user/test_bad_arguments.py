"""Bad arguments end with code 2 and one plain line each, and leave the disk as it was."""

from __future__ import annotations

import os
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
    (
        ["--set", "load.mass=4 force_amplitude=1"],
        "--set load.mass=4 force_amplitude=1: one key is set at a time",
    ),
    (["--set", "load.mass=4\nforce_amplitude=1"], "--set load.mass=4\\x0Aforce_amplitude=1: one key is set"),
    (["--set", "load.mass=4 / &film rupture='solved'"], "--set load.mass=4 / &film rupture='solved'"),
    (["--set", "gear(2).backlash=1e-4"], "--set gear(2).backlash=1e-4: there is no gear pair of this number"),
    (["--set", "gear(0).backlash=1e-4"], "--set gear(0).backlash=1e-4: &gear: unexpected '('"),
    (["--set", "load(1).mass=3"], "--set load(1).mass=3: &load: unexpected '('"),
    (["--threads", "0"], "--threads 0: a positive number of threads is needed"),
    (["--threads", "99999"], "--threads 99999: at most "),
    (["--threads", "100000"], "--threads 100000: a positive number of threads is needed"),
    (["\x1b[31m.nml"], "\\x1B[31m.nml: there is no such file"),
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


def test_fault_of_the_command_line_is_reported_once(refused, scene_text, tmp_path: Path) -> None:
    for name in ("a.nml", "b.nml"):
        (tmp_path / name).write_text(scene_text())
    assert len(refused("a.nml", "b.nml", "--set", "load.mass=heavy")) == 1


def test_threads_of_the_environment_are_bounded(refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    faults = refused("scene.nml", env={**os.environ, "OMP_NUM_THREADS": "99999"})
    assert len(faults) == 1 and faults[0].startswith("OMP_NUM_THREADS: 99999 threads are asked for; at most ")


def test_a_launcher_of_several_copies_is_refused_without_mpi(
    run, refused, scene_text, tmp_path: Path
) -> None:
    """What mpirun and srun leave in the environment of their processes stands for them."""
    if "with MPI" in run("--version", cwd=tmp_path).stdout:
        pytest.skip("this build shares the work of an MPI job")
    (tmp_path / "scene.nml").write_text(scene_text())
    for name, value in (("OMPI_COMM_WORLD_SIZE", "2"), ("PMI_SIZE", "3"), ("PMIX_RANK", "1")):
        faults = refused("scene.nml", env={**os.environ, name: value})
        assert len(faults) == 1 and "built without MPI" in faults[0] and "MPI=1 make" in faults[0]
    alone = {**os.environ, "OMPI_COMM_WORLD_SIZE": "1", "PMIX_RANK": "0"}
    assert run("scene.nml", cwd=tmp_path, env=alone).returncode == 0


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
