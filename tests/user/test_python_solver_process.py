"""The program behind rattle.run: long settings, odd values and names, interruptions, nothing left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from script_calls import SCRIPTS
from test_python_runs import SCENE
from waiting import until

import rattle
from rattle.solve import literal, text_of

# A motion of hours, whose rows come in at once.
ENDLESS = {**SCENE, "scene": {"name": "long"}, "solver": {**SCENE["solver"], "periods": 30_000_000}}


@pytest.fixture(autouse=True)
def program(request, monkeypatch):
    """The program under test."""
    monkeypatch.setenv("RATTLE_PROGRAM", str(request.getfixturevalue("rattle")))


@pytest.fixture
def temporary(monkeypatch, tmp_path) -> Path:
    """An empty place for temporary folders."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    return folder


@pytest.mark.long
def test_twenty_thousand_values_are_taken():
    forces = (20.0 + np.arange(20_000) / 3.0e3).tolist()
    few = {"solver": {"periods": 2, "accuracy": 1e-3}, "spectrum": {"periods": 1}}
    record = ["film_minimum"]
    result, _ = rattle.campaign({**SCENE, **few}, {"load.force_amplitude": forces}, record=record)
    np.testing.assert_array_equal(result["load.force_amplitude"], forces)
    reported = {"vary": "load.force_amplitude", "values(:,1)": forces, "record": record}
    same = {**SCENE, **few, "scene": {"task": "campaign"}, "campaign": reported}
    again, _ = rattle.run(same)
    np.testing.assert_array_equal(again["film_minimum"], result["film_minimum"])


def test_settings_of_a_file_are_those_of_the_command_line(run, scene_text, tmp_path):
    (tmp_path / "scene.nml").write_text(scene_text())
    (tmp_path / "set").write_text("load.mass=2.5\n\nscene.name=other\nload.steady_force = 150.0")
    settings = ("--set", "load.mass=2.5", "--set", "load.steady_force = 150.0", "--set", "scene.name=other")
    for folder, given in (("a", ("--set", "@set")), ("b", settings)):
        assert run(*given, "--output", folder, "scene.nml", cwd=tmp_path).returncode == 0
    made = [(tmp_path / folder / "other.rattle").read_bytes() for folder in ("a", "b")]
    assert made[0] == made[1]


def test_faults_of_a_file_of_settings_name_the_setting(refused, scene_text, tmp_path):
    (tmp_path / "scene.nml").write_text(scene_text())
    many = ", ".join(["1.0"] * 1000)
    (tmp_path / "set").write_text(f"load.mass=-1.0\nload.mas=2\nno setting\ncontact.length={many}\n")
    found = refused("--set", "@set", "scene.nml")
    assert any(line.startswith("--set no setting: write it as group.key=value") for line in found)
    (tmp_path / "set").write_text(f"load.mass=-1.0\nload.mas=2\ncontact.length={many}\n")
    found = refused("--set", "@set", "scene.nml")
    assert [line.partition(": ")[0] for line in found] == [
        "--set load.mass=-1.0",
        "--set load.mas=2",
        f"--set contact.length={many}"[:206] + " ...",
    ]
    assert "cannot be read" in refused("--set", "@absent", "scene.nml")[0]


@pytest.mark.parametrize(
    "value",
    (b"12", bytearray(b"1"), memoryview(b"1"), {"a": 1}, {1.0, 2.0}, [b"1"], np.bytes_(b"7"), 1j, None),
)
def test_what_would_become_another_value_is_refused(value, temporary):
    for call in (
        lambda: literal(value),
        lambda: text_of({"load": {"mass": value}}),
        lambda: rattle.run(SCENE, set={"load.mass": value}),
        lambda: rattle.run({**SCENE, "load": {"mass": value}}),
    ):
        with pytest.raises(TypeError, match="not a value that an input can have"):
            call()
    assert not list(temporary.iterdir())


def test_a_text_of_two_lines_is_refused(temporary):
    with pytest.raises(ValueError, match="more than one line"):
        rattle.run(SCENE, set={"scene.name": "a\nload.mass=7"})
    assert not list(temporary.iterdir())


def test_arrays_of_one_value_are_that_value():
    assert literal(np.array(2.5)) == "2.5" and literal(np.float32(0.5)) == "0.5"
    assert literal(np.array([True, False])) == ".true., .false."


@pytest.mark.parametrize(
    "change", ({"load.mass": -1.0}, {"load.force_amplitude": 1e9, "solver.iteration_limit": 2})
)
def test_runs_that_fail_leave_no_folder(change, temporary):
    try:
        rattle.run(SCENE, set={**change, "output.series": False})
    except rattle.RunError as fault:
        del fault
    assert not list(temporary.iterdir())


ODD_NAMES = (
    "two words",
    "Getriebe \u00fc\u00df",
    os.fsdecode(b"latin-\xe4\xf6"),
    "-dash",
    "'quoted\"",
    "a\u2212b",
)


@pytest.mark.parametrize("name", ODD_NAMES)
def test_names_of_any_kind_are_files(name, scene_text, tmp_path, monkeypatch):
    folder = tmp_path / name
    folder.mkdir()
    (folder / f"{name}.nml").write_text(scene_text(scene={"name": "'scene'"}))
    result, summary = rattle.run(folder / f"{name}.nml", folder=folder / "out")
    assert result.path == folder / "out" / "scene.rattle" and summary["status"] == "complete"
    monkeypatch.chdir(folder)
    result, _ = rattle.run(f"{name}.nml", folder=f"{name}.d")
    assert (folder / f"{name}.d" / "scene.rattle").exists()
    with pytest.raises(rattle.InputError) as refused:
        rattle.run(f"{name}.nml", folder=f"{name}.d")
    shown = "".join(f"\\x{ord(c) - 0xDC00:X}" if c >= "\udc80" and c <= "\udcff" else c for c in name)
    assert refused.value.faults[0].file == f"{shown}.nml"


CALLER = """
import rattle, sys
print("ready", flush=True)
rattle.run({scene!r}, folder={folder!r}, **{options!r})
"""


def caller(tmp_path: Path, folder: str | None = "out", code: str = CALLER, **options: object):
    """A Python that runs the endless motion, in a session of its own, when its solver has begun to write."""
    text = code.format(scene=ENDLESS, folder=folder, options=options)
    before = bytes_of(tmp_path)
    environment = os.environ | {"PYTHONPATH": str(SCRIPTS), "TMPDIR": str(tmp_path)}
    process = subprocess.Popen(
        [sys.executable, "-c", text],
        cwd=tmp_path,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )
    until(lambda: bytes_of(tmp_path) >= before + 20_000, process)
    return process


def bytes_of(tmp_path: Path) -> int:
    """What the runs below a folder have written."""
    return sum(path.stat().st_size for path in tmp_path.glob("*/long.*") if path.exists())


def solvers(session: int) -> list[int]:
    """Processes that are left of a session."""
    listed = subprocess.run(
        ["ps", "-o", "pid=,stat=", "-s", str(session)], capture_output=True, text=True, check=False
    )
    return [int(line.split()[0]) for line in listed.stdout.splitlines() if "Z" not in line.split()[1]]


def nothing_left(session: int) -> bool:
    deadline = time.monotonic() + 600.0
    while solvers(session):
        if time.monotonic() > deadline:
            os.killpg(session, signal.SIGKILL)
            return False
        time.sleep(0.02)
    return True


def test_an_interruption_from_the_keyboard_keeps_the_state(tmp_path):
    process = caller(tmp_path)
    process.send_signal(signal.SIGINT)
    complaint = process.communicate(timeout=600.0)[1].decode()
    assert "KeyboardInterrupt" in complaint
    assert nothing_left(process.pid)
    assert rattle.read_summary(tmp_path / "out" / "long.summary.nml")["status"] == "interrupted"
    assert (tmp_path / "out" / "long.state").exists()
    # Carried on with a word, and cut again: it begins where it was cut.
    held = rattle.read(tmp_path / "out" / "long.rattle").row_count
    process = caller(tmp_path, resume=True)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=600.0)
    assert rattle.read(tmp_path / "out" / "long.rattle").row_count >= held > 1


@pytest.mark.parametrize("number", (signal.SIGTERM, signal.SIGHUP))
def test_a_python_that_is_asked_to_end_leaves_neither_solver_nor_temporary_folder(number, tmp_path):
    process = caller(tmp_path, folder=None)
    process.send_signal(number)
    process.communicate(timeout=600.0)
    assert process.returncode == 128 + number
    assert nothing_left(process.pid)
    assert not list(tmp_path.glob("rattle-*"))


THREADED = """
import rattle, threading
threading.Thread(target=lambda: rattle.run({scene!r}, folder={folder!r})).start()
"""


@pytest.mark.parametrize(("code", "number"), ((CALLER, signal.SIGKILL), (THREADED, signal.SIGTERM)))
def test_a_python_that_is_killed_leaves_no_solver(code, number, tmp_path):
    """Nothing of it can act then; the solver itself sees that it is gone, and saves its state."""
    process = caller(tmp_path, code=code)
    process.send_signal(number)
    process.communicate(timeout=600.0)
    assert nothing_left(process.pid)
    assert rattle.read_summary(tmp_path / "out" / "long.summary.nml")["status"] == "interrupted"


def test_a_signal_while_the_solver_is_started_is_handed_on(tmp_path):
    """The script ends after the solver, which has ended in good order."""
    (tmp_path / "scene.nml").write_text(text_of(ENDLESS))
    words = """
import os, signal, subprocess, sys
sys.path.insert(0, sys.argv[1])
import rattle

class Started(subprocess.Popen):
    def __init__(self, *given, **named):
        super().__init__(*given, **named)
        os.kill(os.getpid(), signal.SIGTERM)

subprocess.Popen = Started
rattle.run("scene.nml", folder="results")
"""
    ended = subprocess.run(
        [sys.executable, "-c", words, str(SCRIPTS)], cwd=tmp_path, check=False, timeout=120
    )
    assert ended.returncode == 128 + signal.SIGTERM
    assert not [*(tmp_path / "results").glob("*.lock")]
