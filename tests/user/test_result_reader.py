"""The reader of result files: exact values, no copies, and plain words for damaged files."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from result_writer import MOTION_COLUMNS, result_bytes, write_motion, write_result

import rattle

COLUMNS = [("time", "s"), ("acceleration", "m/s2")]
ROWS = [[0.0, 1.5], [0.1, -2.5], [0.2, 1e-300]]

names = st.lists(
    st.text(alphabet="abcdefghijklmnopqrstuvwxyz_0123456789", min_size=1, max_size=32),
    min_size=1,
    max_size=7,
    unique=True,
)


@pytest.fixture(scope="module")
def scratch(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("results") / "case.rattle"


@given(names=names, data=st.data(), closed=st.booleans(), text=st.text(alphabet="abc =&/\n'", max_size=300))
def test_any_rows_and_columns_come_back_bit_for_bit(scratch, names, data, closed, text):
    row_count = data.draw(st.integers(0, 12))
    rows = data.draw(arrays("<f8", (row_count, len(names)), elements=st.floats(width=64)))
    columns = [(name, "m") for name in names]
    result = rattle.read(write_result(scratch, columns, rows, input_text=text, closed=closed))
    assert list(result.columns) == names
    assert result.row_count == row_count
    assert result.closed is closed
    assert result.input_text == text.rstrip(" ")
    for position, name in enumerate(names):
        assert result[name].tobytes() == rows[:, position].tobytes()


@given(position=st.integers(0, 63), value=st.integers(0, 255))
@settings(max_examples=400)
def test_a_damaged_header_is_refused_or_read_but_never_crashes(scratch, position, value):
    content = bytearray(result_bytes(COLUMNS, ROWS))
    content[position] = value
    scratch.write_bytes(content)
    try:
        result = rattle.read(scratch)
    except rattle.ResultError as fault:
        assert str(fault).endswith(".") and "\n" not in str(fault)
    else:
        assert result["time"].shape == (result.row_count,)


def test_columns_are_mapped_and_read_only(tmp_path):
    result = rattle.read(write_result(tmp_path / "a.rattle", COLUMNS, ROWS))
    column = result["acceleration"]
    assert isinstance(column, np.memmap)
    assert np.shares_memory(column, result.columns["acceleration"])
    assert not column.flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        column[0] = 0.0
    with pytest.raises(TypeError):
        result.columns["time"] = column


def test_header_fields_are_told(tmp_path):
    result = rattle.read(write_result(tmp_path / "a.rattle", COLUMNS, ROWS, program_version="1.2.3"))
    assert result.program_version == "1.2.3"
    assert dict(result.units) == dict(COLUMNS)
    assert "time" in result and "film_load" not in result


def test_unclosed_file_gives_its_complete_rows(tmp_path):
    path = write_result(tmp_path / "a.rattle", COLUMNS, ROWS, closed=False)
    path.write_bytes(path.read_bytes()[:-3])
    result = rattle.read(path)
    assert not result.closed
    assert result.row_count == 2
    assert result["time"].tolist() == [0.0, 0.1]


@pytest.mark.parametrize("closed", [True, False])
def test_file_without_rows_is_readable(tmp_path, closed):
    result = rattle.read(write_result(tmp_path / "a.rattle", COLUMNS, [], closed=closed))
    assert result.row_count == 0
    assert result["time"].size == 0


def test_every_cut_of_a_closed_file_is_refused(tmp_path):
    content = result_bytes(COLUMNS, ROWS, input_text="&scene name='a' /\n")
    path = tmp_path / "a.rattle"
    for length in range(len(content)):
        path.write_bytes(content[:length])
        with pytest.raises(rattle.ResultError):
            rattle.read(path)


def _swapped() -> bytes:
    return result_bytes(COLUMNS, ROWS, byte_order=">")


def _with_row_count(count: int) -> bytes:
    content = bytearray(result_bytes(COLUMNS, ROWS))
    content[24:32] = struct.pack("<q", count)
    return bytes(content)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "is not a rattle result file"),
        (b"a text file, quite another thing" * 20, "is not a rattle result file"),
        (result_bytes(COLUMNS, ROWS)[:40], "ends inside its header"),
        (result_bytes(COLUMNS, ROWS)[:130], "ends inside its header"),
        (result_bytes(COLUMNS, ROWS, format_version=2), "has format version 2"),
        (_swapped(), "big-endian byte order"),
        (_with_row_count(7), "holds 3 of its 7 rows"),
        (_with_row_count(1), "is 32 bytes longer than its 1 rows"),
        (_with_row_count(-5), "sizes contradict each other"),
        (result_bytes([("time", "s"), ("time", "s")], ROWS), "blank or repeated"),
    ],
)
def test_unusable_files_are_explained(tmp_path, content, words):
    path = tmp_path / "a.rattle"
    path.write_bytes(content)
    with pytest.raises(rattle.ResultError, match=words) as fault:
        rattle.read(path)
    assert str(path) in str(fault.value)


def test_absent_file_and_directory_are_explained(tmp_path):
    with pytest.raises(rattle.ResultError, match="cannot be read: No such file"):
        rattle.read(tmp_path / "none.rattle")
    with pytest.raises(rattle.ResultError, match="cannot be read: Is a directory"):
        rattle.read(tmp_path)


def test_absent_column_names_the_held_ones(tmp_path):
    result = rattle.read(write_result(tmp_path / "a.rattle", COLUMNS, ROWS))
    with pytest.raises(rattle.ResultError, match="no column 'film_load'; it holds time, acceleration"):
        result["film_load"]


def test_resolved_input_gives_the_window(tmp_path):
    path = write_motion(tmp_path / "a.rattle", lines={1.0: 2.0}, steps_per_period=96, stride=3, periods=20)
    result = rattle.read(path)
    assert list(result.columns) == [name for name, _ in MOTION_COLUMNS]
    assert result.scene_name == "a"
    assert result.law == "iso-viscous"
    assert result.frequency == 500.0
    assert result.samples_per_period == 32
    assert result.whole_periods == 20
    assert result.window() == slice(4 * 32 + 1, 20 * 32 + 1)
    assert result.window(20, with_start=True) == slice(0, 20 * 32 + 1)
    with pytest.raises(rattle.ResultError, match="holds 20 whole periods, fewer than the 21 asked for"):
        result.window(21)


@pytest.mark.parametrize(
    ("rows", "periods"), [(2561, 20), (2560, 19), (2434, 19), (2433, 19), (2432, 18), (1, 0)]
)
def test_whole_periods_begin_with_the_row_at_their_start(tmp_path, rows, periods):
    """As many as lie between the first row and the last one, wherever the run was killed."""
    path = write_motion(tmp_path / "a.rattle", lines={1.0: 2.0}, closed=False)
    path.write_bytes(path.read_bytes()[: -(2561 - rows) * 32 or None])
    result = rattle.read(path)
    assert (result.row_count, result.whole_periods) == (rows, periods)
    if periods:
        assert result.window(periods, with_start=True).start == rows - 1 - 128 * periods
    with pytest.raises(rattle.ResultError, match="whole periods, fewer than the 21 asked for"):
        result.window(21)


def test_stride_that_divides_no_period_is_explained(tmp_path):
    path = write_motion(tmp_path / "a.rattle", lines={1.0: 2.0}, steps_per_period=100, stride=3)
    with pytest.raises(rattle.ResultError, match="no whole number of samples a period"):
        rattle.read(path).window()


@pytest.mark.parametrize("text", ["", "&scene name = 'a'", "?!", "&load frequency = 'fast' /"])
def test_unusable_input_text_is_explained(tmp_path, text):
    result = rattle.read(write_result(tmp_path / "a.rattle", COLUMNS, ROWS, input_text=text))
    with pytest.raises(rattle.ResultError):
        _ = result.frequency


def test_values_that_are_not_finite_are_not_drawn(tmp_path):
    result = rattle.read(write_result(tmp_path / "a.rattle", COLUMNS, [[0.0, np.inf]]))
    with pytest.raises(rattle.ResultError, match="not finite"):
        result.samples("acceleration")
