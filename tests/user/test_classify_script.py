"""The classes that classify.py gives to motions with known lines."""

from __future__ import annotations

import csv
import subprocess
from pathlib import Path

import pytest
from result_writer import write_motion
from script_calls import call_script

IDLE = {float(order): 10.0 * 0.9**order for order in range(1, 31)}
MOTIONS = {
    "idle": IDLE,
    "creep": {1.0: 10.0, 2.0: 8.0, 3.0: 3.0},
    "quiet": {1.0: 10.0, 2.0: 1.0},
    "irregular_so_far": {1.0: 10.0, 2.5: 5.0},
}


def classify(directory: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return call_script("classify.py", *arguments, cwd=directory)


@pytest.fixture
def results(tmp_path) -> list[str]:
    for name, lines in MOTIONS.items():
        write_motion(tmp_path / f"{name}.rattle", lines=lines)
    return [f"{name}.rattle" for name in MOTIONS]


def test_each_class_is_recognised_and_saved(results, tmp_path):
    done = classify(tmp_path, *results, "--output", "classes.csv")
    assert done.returncode == 0, done.stderr
    with (tmp_path / "classes.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["scene"] for row in rows] == list(MOTIONS)
    assert [row["rattle_class"] for row in rows] == list(MOTIONS)
    assert [int(row["harmonic_count"]) for row in rows] == [30, 3, 2, 1]
    assert float(rows[2]["harmonic_distortion"]) == pytest.approx(0.1, rel=1e-12)
    assert float(rows[3]["irregular_fraction"]) == pytest.approx(0.2, rel=1e-12)
    table = done.stdout.splitlines()
    assert len(table) == 2 + len(MOTIONS)
    assert all(name in line for name, line in zip(MOTIONS, table[2:], strict=True))


@pytest.mark.parametrize(
    ("scene", "option", "expected"),
    [
        ("idle", ("--idle-harmonics", "31"), "creep"),
        ("creep", ("--quiet-limit", "2.0"), "quiet"),
        ("quiet", ("--quiet-limit", "0.05"), "creep"),
        ("irregular_so_far", ("--irregular-limit", "0.5"), "quiet"),
        ("creep", ("--harmonic-threshold", "0.5"), "creep"),
    ],
)
def test_thresholds_can_be_replaced(results, tmp_path, scene, option, expected):
    done = classify(tmp_path, f"{scene}.rattle", *option)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[2].split()[:2] == [scene, expected]


def test_a_bad_file_is_named_and_the_others_are_classified(results, tmp_path):
    (tmp_path / "notes.txt").write_text("no result")
    done = classify(tmp_path, "notes.txt", "idle.rattle")
    assert done.returncode == 2
    assert done.stderr == "classify.py: notes.txt is not a rattle result file, which is called NAME.rattle.\n"
    assert "idle" in done.stdout


def test_a_window_longer_than_the_run_is_refused(results, tmp_path):
    done = classify(tmp_path, "idle.rattle", "--periods", "21")
    assert done.returncode == 2
    assert "holds 20 whole periods, fewer than the 21 asked for" in done.stderr


def test_a_result_without_the_acceleration_is_refused(tmp_path):
    path = write_motion(tmp_path / "a.rattle", lines=IDLE, without="acceleration")
    done = classify(tmp_path, str(path))
    assert done.returncode == 2
    assert "has no column 'acceleration'" in done.stderr


def test_too_few_samples_a_period_are_refused(tmp_path):
    path = write_motion(tmp_path / "a.rattle", lines={1.0: 1.0}, steps_per_period=2)
    done = classify(tmp_path, str(path))
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "cannot be classified: a class needs at least 3 samples a period, not 2." in done.stderr


@pytest.mark.parametrize("value", ["nan", "inf", "much"])
def test_thresholds_are_numbers(results, tmp_path, value):
    done = classify(tmp_path, "idle.rattle", "--quiet-limit", value)
    assert done.returncode == 2
    assert f"'{value}' is not a number" in done.stderr
