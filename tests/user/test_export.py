"""CSV export: exact round trip, columns, stride, plain words."""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from result_writer import write_result
from script_calls import SCRIPTS, call_script

COLUMNS = [("time", "s"), ("film_thickness", "m"), ("acceleration", "m/s2")]
ROWS = np.random.default_rng(1).normal(size=(25000, 3)) * [1.0, 1e-7, 1e200]
ROWS[3] = [np.nan, np.inf, -0.0]


def export(directory: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return call_script("export.py", *arguments, cwd=directory)


@pytest.fixture
def result(tmp_path) -> Path:
    return write_result(tmp_path / "run.rattle", COLUMNS, ROWS)


def read_csv(path: Path) -> tuple[list[str], np.ndarray]:
    with path.open(newline="", encoding="utf-8") as stream:
        head, *rows = csv.reader(stream)
    return head, np.array([[float(cell) for cell in row] for row in rows])


def test_every_number_comes_back_exactly(result):
    done = export(result.parent, "run.rattle")
    assert (done.returncode, done.stdout, done.stderr) == (0, "run.csv\n", "")
    head, rows = read_csv(result.with_suffix(".csv"))
    assert head == ["time[s]", "film_thickness[m]", "acceleration[m/s2]"]
    np.testing.assert_array_equal(rows, ROWS)
    assert np.signbit(rows[3, 2])


def test_columns_in_the_order_asked_for_and_every_nth_row(result, tmp_path):
    output = tmp_path / "part.csv"
    done = export(
        tmp_path,
        str(result),
        "--columns",
        "acceleration,time",
        "--stride",
        "7",
        "--output",
        str(output),
    )
    assert done.returncode == 0
    head, rows = read_csv(output)
    assert head == ["acceleration[m/s2]", "time[s]"]
    np.testing.assert_array_equal(rows, ROWS[::7, [2, 0]])


@pytest.mark.parametrize("stride", [1, 3])
def test_extreme_rows_are_put_in_by_time(tmp_path, stride):
    """Wherever they fall: between two blocks of rows written together, at the end, at a row itself."""
    rows = np.column_stack([np.arange(25000.0), np.zeros(25000), np.arange(25000.0)])
    times = [0.0, 0.5, 9999.5, 10000.0, 24999.25] if stride == 1 else [1.0, 29999.0 / 3, 24998.0, 24999.5]
    extremes = [[time, 1.0, -time] for time in times]
    path = write_result(tmp_path / "run.rattle", COLUMNS, rows, extremes=extremes)
    assert export(tmp_path, str(path), "--stride", str(stride)).returncode == 0
    _, written = read_csv(path.with_suffix(".csv"))
    both = np.vstack([rows[::stride], extremes])
    np.testing.assert_array_equal(written, both[np.argsort(both[:, 0], kind="stable")])


def test_extreme_rows_without_times_are_left_out_with_a_word(tmp_path):
    path = write_result(tmp_path / "run.rattle", COLUMNS[1:], ROWS[:5, 1:], extremes=[[1.0, 2.0]])
    done = export(tmp_path, str(path))
    assert done.stderr == f"export.py: {path} has no column of times; its 1 extreme rows are left out.\n"
    np.testing.assert_array_equal(read_csv(path.with_suffix(".csv"))[1], ROWS[:5, 1:])


def test_damaged_rows_are_not_exported(result):
    content = bytearray(result.read_bytes())
    content[-9] ^= 4
    result.write_bytes(content)
    done = export(result.parent, "run.rattle")
    assert done.returncode == 2
    assert "are not what their checksum says" in done.stderr
    assert not result.with_suffix(".csv").exists()


def test_standard_output_may_be_cut_by_its_reader(result):
    script = SCRIPTS / "export.py"
    command = f"'{sys.executable}' '{script}' '{result}' --output - | head -n 1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    assert done.stdout == "time[s],film_thickness[m],acceleration[m/s2]\n"
    assert done.stderr == ""


def test_unclosed_result_is_exported_with_a_word(tmp_path):
    path = write_result(tmp_path / "run.rattle", COLUMNS, ROWS[:5], closed=False)
    done = export(tmp_path, str(path))
    assert done.returncode == 0
    assert done.stderr == f"export.py: {path} is not closed; its 5 complete rows are used.\n"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["run.rattle", "--columns", "film"], "has no column 'film'"),
        (["none.rattle"], "cannot be read"),
        (["run.rattle", "--output", "run.rattle"], "is a result itself"),
        (["run.rattle", "--output", "absent/run.csv"], "No such file or directory"),
        (["run.rattle", "--stride", "0"], "not a positive whole number"),
        (["run.rattle", "--output", "run.xlsx"], "this script writes csv"),
    ],
)
def test_what_cannot_be_done_is_one_sentence(result, arguments, words):
    before = result.read_bytes()
    done = export(result.parent, *arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert result.read_bytes() == before
    assert not result.with_suffix(".csv").exists()
