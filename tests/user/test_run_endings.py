"""How runs end: failures, signals, kills, a full disk, a closed terminal."""

from __future__ import annotations

import os
import re
import resource
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from outcomes import assert_no_crash, summary_of
from waiting import let_work, until

from rattle import read

# At this speed of approach exp(A) of the piezo-viscous load (37) is beyond every number.
OVERFLOW = {"film": {"law": "'piezo-viscous'", "initial_velocity": "-1.0e3"}}


@pytest.mark.parametrize("order", [("bad", "good"), ("good", "bad")], ids=" ".join)
def test_failed_scene_does_not_stop_the_others(
    order: tuple[str, str], run, scene_text, tmp_path: Path
) -> None:
    (tmp_path / "good.nml").write_text(scene_text())
    (tmp_path / "bad.nml").write_text(scene_text(**OVERFLOW))
    ended = run(*(f"{name}.nml" for name in order), cwd=tmp_path)
    assert ended.returncode == 1
    assert_no_crash(ended.stderr + ended.stdout)
    good = summary_of(tmp_path / "results" / "good.summary.nml")
    assert good["status"] == "complete"
    bad = summary_of(tmp_path / "results" / "bad.summary.nml")
    assert bad["status"] == "overflow"
    assert bad["status_time"] == 0.0
    assert bad["status_text"].endswith(".")
    assert bad["steady_film"] > 0
    assert "rattle_class" not in bad
    assert "film_minimum" not in bad
    assert read(tmp_path / "results" / "bad.rattle").closed
    assert "overflow" in (tmp_path / "results" / "bad.log").read_text()


def test_not_converged(run, scene_text, tmp_path: Path) -> None:
    """A tolerance that no pass can meet ends the scene; rows up to the failing step are kept."""
    text = scene_text(solver={"iteration_limit": "1", "tolerance": "1e-300"})
    assert run("-", cwd=tmp_path, stdin=text).returncode == 1
    summary = summary_of(tmp_path / "results" / "standard-input.summary.nml")
    assert summary["status"] == "not_converged"
    result = read(tmp_path / "results" / "standard-input.rattle")
    assert result.closed
    assert result.row_count == summary["steps"] + 1
    assert summary["film_at_status_time"] > 0


@pytest.mark.long
@pytest.mark.parametrize("model", ["published", "reynolds"])
def test_periods_that_return_to_the_last_bit(model: str, run, scene_text, tmp_path: Path) -> None:
    """Ten million periods, computed one by one, would take minutes; the summary is that of three hundred."""
    summaries = []
    for name, periods in (("short", "300"), ("long", "10000000")):
        solver = {"method": "'taylor'", "periods": periods, "steps_per_period": None, "tolerance": None}
        text = scene_text(solver=solver, film={"model": f"'{model}'"}, output={"series": ".false."})
        (tmp_path / f"{name}.nml").write_text(text)
        ended = run(f"{name}.nml", cwd=tmp_path)
        assert (ended.returncode, ended.stderr) == (0, "")
        summaries.append(summary_of(tmp_path / "results" / f"{name}.summary.nml"))
        assert summaries[-1]["periods_solved"] == int(periods)
        assert summaries[-1]["steps"] > 5 * int(periods)
    own = {"name", "status_time", "periods_solved", "evaluations", "steps", "wall_seconds", "input_file"}
    # The file of the motions has the text of its input.
    own.add("motions_checksum")
    # Impacts come at the same phases of the force of 600 Hz.
    phases = [np.multiply(each.get("impact_times_drive", []), 600.0) % 1.0 for each in summaries]
    assert phases[0] == pytest.approx(phases[1], abs=1e-6)
    own.add("impact_times_drive")
    short, long = ({key: each[key] for key in each if key not in own} for each in summaries)
    assert short == long


def long_scene(scene_text: Callable[..., str], **output: str) -> str:
    """Would take many minutes and hundreds of gigabytes."""
    return scene_text(solver={"steps_per_period": "512", "periods": "100000000"}, output=output)


def start(rattle: Path, cwd: Path, *arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [rattle, *arguments], cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def wait_for_rows(path: Path, process: subprocess.Popen, size: int = 100_000) -> None:
    """Until the program has written rows."""
    until(lambda: path.exists() and path.stat().st_size >= size, process)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGUSR1], ids=lambda n: n.name)
def test_interruption_keeps_what_was_computed(
    number: signal.Signals, rattle: Path, scene_text, tmp_path: Path
) -> None:
    (tmp_path / "long.nml").write_text(long_scene(scene_text))
    (tmp_path / "next.nml").write_text(scene_text())
    path = tmp_path / "results" / "long.rattle"
    # On one thread the second scene waits for the first.
    process = start(rattle, tmp_path, "--threads", "1", "long.nml", "next.nml")
    try:
        wait_for_rows(path, process)
        process.send_signal(number)
        stdout, stderr = process.communicate(timeout=600.0)
    finally:
        process.kill()
    assert process.returncode == 128 + number
    assert stderr == ""
    assert "interrupted" in stdout

    summary = summary_of(tmp_path / "results" / "long.summary.nml")
    assert summary["status"] == "interrupted"
    result = read(path)
    assert result.closed
    assert result.row_count == summary["steps"] + 1
    assert result.row_count % 512 == 1
    np.testing.assert_array_equal(result["time"][:3], np.arange(3) / (600.0 * 512))
    assert result["time"][-1] == pytest.approx(summary["status_time"], rel=1e-14)
    assert np.isfinite(result["acceleration"]).all()
    assert "rattle_class" not in summary
    assert "interrupted" in (tmp_path / "results" / "long.log").read_text()
    assert not (tmp_path / "results" / "next.summary.nml").exists()
    shutil.rmtree(tmp_path / "results")


@pytest.mark.long
def test_kill_leaves_a_readable_result(rattle: Path, scene_text, tmp_path: Path) -> None:
    (tmp_path / "long.nml").write_text(long_scene(scene_text))
    path = tmp_path / "results" / "long.rattle"
    process = start(rattle, tmp_path, "long.nml")
    try:
        wait_for_rows(path, process)
    finally:
        process.kill()
        process.communicate(timeout=600.0)
    result = read(path)
    assert not result.closed
    assert result.row_count > 1000
    steps = np.arange(1000, dtype=float)
    np.testing.assert_array_equal(result["time"][:1000], steps / (600.0 * 512))
    assert np.isfinite(result["acceleration"]).all()
    assert not (tmp_path / "results" / "long.summary.nml").exists()
    shutil.rmtree(tmp_path / "results")


def test_full_disk(rattle: Path, scene_text, tmp_path: Path) -> None:
    """A file that may not grow stands for the full disk: code 3, a plain sentence, a summary all the same."""
    (tmp_path / "long.nml").write_text(long_scene(scene_text))

    def limit_files() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, 1_000_000))

    ended = subprocess.run(
        [rattle, "long.nml"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=600.0,
        check=False,
        preexec_fn=limit_files,
    )
    assert ended.returncode == 3
    assert re.fullmatch(r"results/long\.rattle cannot be written: .+\n", ended.stderr)
    summary = summary_of(tmp_path / "results" / "long.summary.nml")
    assert summary["status"] == "not_written"
    result = read(tmp_path / "results" / "long.rattle")
    assert not result.closed
    assert result.row_count > 20_000
    assert "rattle_class" not in summary


PEAK_MEMORY = """
import os, subprocess, sys
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, usage = os.wait4(process.pid, 0)
print(os.waitstatus_to_exitcode(status), usage.ru_maxrss)
"""


@pytest.mark.long
def test_memory_does_not_grow_with_the_periods(rattle: Path, scene_text, tmp_path: Path) -> None:
    """Without a series nothing is kept but the window."""
    peaks = []
    for periods in (100, 4000):
        name = f"p{periods}"
        solver = {"steps_per_period": "512", "periods": str(periods)}
        (tmp_path / f"{name}.nml").write_text(scene_text(solver=solver, output={"series": "f"}))
        measured = subprocess.run(
            [sys.executable, "-c", PEAK_MEMORY, rattle, f"{name}.nml"],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=600.0,
            check=True,
        )
        code, kilobytes = map(int, measured.stdout.split())
        assert code == 0
        peaks.append(kilobytes)
    # One value of 4000 periods alone would be 16 MB.
    assert peaks[1] - peaks[0] < 3000


def test_closed_terminal_does_not_lose_the_run(rattle: Path, scene_text, tmp_path: Path) -> None:
    """`rattle ... | head -1`: no one reads any more, but the files are complete."""
    (tmp_path / "scene.nml").write_text(scene_text())
    reader, writer = os.pipe()
    os.close(reader)
    process = subprocess.Popen([rattle, "scene.nml"], cwd=tmp_path, stdout=writer, stderr=subprocess.PIPE)
    os.close(writer)
    process.communicate(timeout=600.0)
    assert summary_of(tmp_path / "results" / "scene.summary.nml")["status"] == "complete"
    assert read(tmp_path / "results" / "scene.rattle").closed


def test_a_signal_ends_a_long_period(rattle: Path, scene_text, tmp_path: Path) -> None:
    """A period of ten million steps, each with a root that takes many iterations, is not waited for."""
    text = scene_text(
        film={"rupture": "'solved'", "rupture_solver": "'successive'"},
        solver={"steps_per_period": "10000000"},
        spectrum={"periods": "1"},
        output={"series": ".false."},
    )
    (tmp_path / "scene.nml").write_text(text)
    process = start(rattle, tmp_path, "scene.nml")
    try:
        until((tmp_path / "results" / "scene.log").exists, process)
        let_work(process, 0.5)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=600.0)
    finally:
        process.kill()
    assert process.returncode == 128 + signal.SIGTERM
    summary = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert summary["status"] == "interrupted"
    assert "rattle_class" not in summary


def test_a_sweep_tells_where_it_was_cut(rattle: Path, repository: Path, tmp_path: Path) -> None:
    """Every motion begins with the one before: carried on, a sweep is solved again, and the log says so."""
    arguments = [rattle, "--quiet", "--set", "sweep.count=20001", "--output", "."]
    for resume in ([], ["--resume"]):
        process = subprocess.Popen([*arguments, *resume, repository / "input" / "sweep.nml"], cwd=tmp_path)
        let_work(process, 0.3)
        process.send_signal(signal.SIGTERM)
        assert process.wait(600) == 128 + signal.SIGTERM
        log = (tmp_path / "sweep.log").read_text()
        rows = read(tmp_path / "sweep.rattle").row_count
        assert rows > 0 and f"\n  cut              after {rows} of 40001 motions\n" in log
        assert ("earlier run      was cut after" in log) == bool(resume)
