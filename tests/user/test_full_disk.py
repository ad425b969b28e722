"""Disks that run full under a campaign: it ends cleanly, and goes on to the undisturbed bytes."""

from __future__ import annotations

import shutil
import subprocess
import warnings
from pathlib import Path

import pytest
from campaign_runs import grid, solve
from outcomes import digest, summary_of

# Some hundred kilobytes stay beside the ballast. The finished file is copied out of the file system.
SMALL_FILE_SYSTEM = """
mkdir small && mount -t tmpfs -o size=1m none small && head -c 700000 /dev/zero > small/ballast || exit 99
"$0" --quiet --output small scene.nml 2> words
echo $? > code
rm small/ballast
"$0" --quiet --resume --output small scene.nml || exit 1
cp small/scene.rattle finished.rattle
"""
# The same without a file system: no file may grow beyond the limit.
SIZE_LIMIT = """
(ulimit -f 200; exec "$0" --quiet --output small scene.nml 2> words)
echo $? > code
"$0" --quiet --resume --output small scene.nml || exit 1
cp small/scene.rattle finished.rattle
"""
MAY_MOUNT = (["unshare", "--user", "--map-root-user", "--mount"], ["unshare", "--mount"])


def namespace(folder: Path) -> list[str]:
    """Command that runs another one where it may mount; empty if this machine allows none."""
    for command in MAY_MOUNT:
        if shutil.which(command[0]) is None:
            continue
        trial = [*command, "mount", "-t", "tmpfs", "-o", "size=64k", "none", "."]
        if subprocess.run(trial, cwd=folder, capture_output=True, check=False).returncode == 0:
            return command
    return []


def test_full_file_system_keeps_what_was_written(run, rattle: Path, scene_text, tmp_path: Path) -> None:
    """A small file system runs full; with space made, the resumed campaign ends in the undisturbed bytes."""
    (tmp_path / "scene.nml").write_text(grid(scene_text, 60, 60))
    whole = digest(solve(run, tmp_path))
    inside = namespace(tmp_path)
    script, words = (
        (SMALL_FILE_SYSTEM, "No space left on device") if inside else (SIZE_LIMIT, "File too large")
    )
    if not inside:
        warnings.warn("nothing may be mounted here: a limit on the size of files stands in", stacklevel=1)
    command = [*inside, "bash", "-c", script, rattle]
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=600.0)
    assert ended.returncode == 0, ended.stderr
    assert (tmp_path / "code").read_text() == "3\n"
    assert (tmp_path / "words").read_text() == f"small/scene.rattle cannot be written: {words}\n"
    assert digest(tmp_path / "finished.rattle") == whole


@pytest.mark.parametrize(
    "arguments", ["--template", "--keys", "--help", "--version", "--check scene.nml", "scene.nml"]
)
def test_words_that_cannot_be_written_are_missed(
    arguments: str, rattle: Path, scene_text, tmp_path: Path
) -> None:
    """Standard output on a full disk: code 3 and a sentence; the files of a scene are complete."""
    (tmp_path / "scene.nml").write_text(scene_text())
    with Path("/dev/full").open("w") as full:
        ended = subprocess.run(
            [rattle, *arguments.split()],
            cwd=tmp_path,
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert ended.returncode == 3
    assert (
        ended.stderr.startswith("the standard output could not be written") and ended.stderr.count("\n") == 1
    )
    if arguments == "scene.nml":
        assert summary_of(tmp_path / "results" / "scene.summary.nml")["status"] == "complete"
        assert "steady film" in (tmp_path / "results" / "scene.log").read_text()


def test_full_disk_keeps_what_was_written(run, rattle: Path, scene_text, tmp_path: Path) -> None:
    """A limit on the size of files stands in for a full disk; resumed without it the bytes are the same."""
    (tmp_path / "scene.nml").write_text(grid(scene_text, 60, 60))
    whole = digest(solve(run, tmp_path))
    limited = f"ulimit -f 200; exec {rattle} --quiet --output cut scene.nml"
    ended = subprocess.run(["bash", "-c", limited], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ended.returncode == 3 and ended.stderr
    resumed = run("--output", "cut", "--resume", "scene.nml", cwd=tmp_path, timeout=600.0)
    # No chunk counts as done before its rows are written, so none turns out to be damaged.
    assert resumed.returncode == 0 and "damaged" not in resumed.stdout
    assert digest(tmp_path / "cut" / "scene.rattle") == whole
