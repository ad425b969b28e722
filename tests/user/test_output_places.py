"""Places that cannot take the output, and files there that are never replaced."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest


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


def test_folder_without_permission(refused, rattle: Path, scene_text, tmp_path: Path) -> None:
    """Root may write anywhere, so for root the program runs as nobody, from a copy that no one can reach."""
    (tmp_path / "scene.nml").write_text(scene_text())
    (tmp_path / "results").mkdir(mode=0o555)
    as_nobody: dict[str, object] = {}
    if os.geteuid() == 0:
        shutil.copy(rattle, tmp_path / "rattle")
        (tmp_path / "scene.nml").chmod(0o444)
        tmp_path.chmod(0o755)
        as_nobody = {"program": "./rattle", "user": 65534, "group": 65534, "extra_groups": []}
    faults = refused("scene.nml", **as_nobody)
    assert faults == ["scene.nml: &output directory: the folder 'results' is not writable"]


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
    "mine", ["R", "my notes\n", "!&summary\n"], ids=["one letter", "notes", "nearly a summary"]
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
    assert "results/scene.rattle is a link, which rattle did not make" in faults[0]


def test_pipe_in_place_of_a_file(refused, scene_text, tmp_path: Path) -> None:
    """Looking at a pipe that nobody writes to must not wait for ever."""
    (tmp_path / "scene.nml").write_text(scene_text())
    (tmp_path / "results").mkdir()
    os.mkfifo(tmp_path / "results" / "scene.log")
    faults = refused("scene.nml", "--overwrite", timeout=600.0)
    assert len(faults) == 1
    assert "results/scene.log exists and was not written by rattle" in faults[0]
