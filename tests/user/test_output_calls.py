"""Every output call of a run is checked: its failure is reported, and what a kill may lose is bounded."""

from __future__ import annotations

import os
import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from campaign_runs import grid

import rattle as package

RESULTS = ("scene.rattle", "scene.state", "scene.summary.nml")


@pytest.fixture
def meet(shim: Path, rattle: Path, scene_text, tmp_path: Path) -> Callable:
    """Run the scene, or the campaign, in a folder of its own with a fault; its end and its output calls."""
    (tmp_path / "scene.nml").write_text(scene_text(solver={"periods": "100"}, spectrum={"verify": ".false."}))
    (tmp_path / "map.nml").write_text(grid(scene_text, 5, 4))

    def call(
        folder: str, scene: str = "scene", **fault: object
    ) -> tuple[subprocess.CompletedProcess[str], list[str]]:
        trace = tmp_path / f"{folder}.trace"
        words = {"FAULT_FOLDER": f"{folder}/", "FAULT_KIND": "none", "FAULT_TRACE": trace, **fault}
        ended = subprocess.run(
            [rattle, "--quiet", "--threads", "1", "--output", folder, f"{scene}.nml"],
            cwd=tmp_path,
            env={**os.environ, "LD_PRELOAD": str(shim), **{key: str(word) for key, word in words.items()}},
            capture_output=True,
            text=True,
            check=False,
            timeout=600.0,
        )
        return ended, trace.read_text().splitlines()

    return call


def test_failure_of_every_call_is_reported(meet, tmp_path: Path) -> None:
    """Of all calls for series, state and summary; nothing incomplete looks complete."""
    whole, calls = meet("whole")
    assert whole.returncode == 0
    names = {call.split()[0] for call in calls}
    assert names >= {"open", "write", "pwrite", "fsync", "close", "rename"}
    tried = 0
    for number, call in enumerate(calls, 1):
        file = call.split()[1].removesuffix(".new")
        if file not in RESULTS:
            continue
        tried += 1
        folder = f"call_{number}"
        ended, _ = meet(folder, FAULT_KIND="error", FAULT_AT=number)
        assert ended.returncode == 3, call
        assert ended.stderr == f"{folder}/{file} cannot be written: No space left on device\n", call
        summary = tmp_path / folder / "scene.summary.nml"
        assert not summary.exists() or "not_written" in summary.read_text(), call
        # The last step is that of the summary: all else is complete and in its place then.
        last = call == "rename scene.summary.nml"
        assert (tmp_path / folder / "scene.state").exists() == last, call
        assert not list((tmp_path / folder).glob("*.new"))
    assert tried >= 15


def test_failure_of_every_call_of_a_campaign_is_reported(meet, tmp_path: Path) -> None:
    """Also when its file is closed: a disk across the network may say only then that it is full."""
    whole, calls = meet("whole", "map")
    assert whole.returncode == 0
    numbers = [number for number, call in enumerate(calls, 1) if call.split()[1].startswith("map.rattle")]
    assert {calls[number - 1].split()[0] for number in numbers} >= {"pwrite", "fsync", "close"}
    for number in numbers:
        folder, call = f"call_{number}", calls[number - 1]
        ended, _ = meet(folder, "map", FAULT_KIND="error", FAULT_AT=number)
        # Before anything has run, a place that cannot be written is bad input.
        assert ended.returncode == (2 if call.startswith("open") else 3), call
        assert re.search(rf"{folder}/map\.rattle(\.\w+\.new)? cannot be written: ", ended.stderr), call
        summary = tmp_path / folder / "map.summary.nml"
        assert not summary.exists() or "'complete'" not in summary.read_text(), call


@pytest.mark.parametrize("kind", ["error", "short"])
def test_log_that_lost_its_first_line_stops_nobody(kind: str, meet, run, tmp_path: Path) -> None:
    """A log is known by its first line: where that was lost, none follows."""
    calls = meet("whole")[1]
    number = calls.index("write scene.log") + 1
    ended, _ = meet("again", FAULT_KIND=kind, FAULT_AT=number)
    assert ended.returncode == 3 and "again/scene.log" in ended.stderr
    log = tmp_path / "again" / "scene.log"
    assert not log.exists() if kind == "error" else log.read_text().count("\n") == 0
    assert run("--resume", "--output", "again", "scene.nml", cwd=tmp_path).returncode == 0
    first, second = ((tmp_path / name / "scene.rattle").read_bytes() for name in ("whole", "again"))
    assert first == second


@pytest.mark.parametrize(("step", "least", "most"), [(0, 2, 2), (3000, 101, 105), (300, 9, 30)])
def test_rows_go_to_the_disk_every_two_seconds(step: int, least: int, most: int, meet) -> None:
    """The clock goes on by some milliseconds whenever it is read; checksums go with the rows."""
    ended, calls = meet("timed", FAULT_CLOCK=step)
    assert ended.returncode == 0
    assert least <= calls.count("pwrite scene.rattle") <= most


def test_killed_run_has_the_rows_of_its_last_flush(meet, tmp_path: Path) -> None:
    """They are covered by checksums: a flipped bit among them is seen."""
    _, calls = meet("whole")
    expected = package.read(tmp_path / "whole" / "scene.rattle")["acceleration"]
    number = [
        place
        for place, call in enumerate(meet("timed", FAULT_CLOCK=3000)[1], 1)
        if call == "pwrite scene.rattle"
    ][60]
    meet("killed", FAULT_CLOCK=3000, FAULT_KIND="kill", FAULT_AT=number)
    path = tmp_path / "killed" / "scene.rattle"
    killed = package.read(path)
    assert not killed.closed
    assert 60 * 32 <= killed.row_count < expected.size
    assert killed["acceleration"].tolist() == expected[: killed.row_count].tolist()
    content = bytearray(path.read_bytes())
    content[-32 * 32 * 3] ^= 1
    path.write_bytes(content)
    with pytest.raises(package.ResultError, match="are not what their checksum says"):
        package.read(path)["acceleration"]
