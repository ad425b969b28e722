"""The reader of result files: exact values, no copies, and plain words for damaged files."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from result_writer import MOTION_COLUMNS, checksum, result_bytes, write_motion, write_result

import rattle
from rattle.checksums import checksums

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


def _flipped(content: bytes, place: int, bit: int = 0) -> bytes:
    damaged = bytearray(content)
    damaged[place] ^= 1 << bit
    return bytes(damaged)


EXTREMES = [[0.05, 9.0], [0.15, -9.0]]


def test_every_flipped_bit_is_found_or_harmless(tmp_path):
    """Anywhere in the file: refused with a sentence, or nothing that is read has changed."""
    text = "&scene name='a' /\n"
    content = result_bytes(COLUMNS, ROWS, input_text=text, extremes=EXTREMES, coarse=True)
    path = tmp_path / "a.rattle"
    harmless = 0
    for place in range(len(content)):
        path.write_bytes(_flipped(content, place, place % 8))
        try:
            result = rattle.read(path)
            values = [*result["time"], *result["acceleration"], *result.extremes["acceleration"]]
        except rattle.ResultError as fault:
            assert str(path) in str(fault)
            continue
        harmless += 1
        assert (result.input_text, result.units["time"], result.coarse) == (text, "s", True)
        assert (result.program_version, result.closed) == ("0.1.0", True)
        assert values == [0.0, 0.1, 0.2, 1.5, -2.5, 1e-300, 9.0, -9.0]
    assert harmless < 120  # the padding alone


@pytest.mark.parametrize("size", [1, 21, 508, 509, 510])
def test_checksums_of_many_chunks_are_those_of_each(size):
    rows = np.random.default_rng(size).normal(size=(20, size))
    rows[3] = 0.0
    assert checksums(rows).tolist() == [checksum(row.tobytes()) for row in rows]


@pytest.mark.parametrize("closed", [True, False])
def test_damaged_rows_are_named_and_others_can_be_read(tmp_path, closed):
    rows = np.arange(2000.0).reshape(-1, 2)
    content = result_bytes(COLUMNS, rows, chunk_rows=300)
    if not closed:
        content = content[:24] + struct.pack("<q", -1) + content[32:]
    damaged = _flipped(content, len(content) - 16 * 399, 3)
    path = tmp_path / "a.rattle"
    path.write_bytes(damaged)
    result = rattle.read(path)
    assert result.samples("time", slice(0, 600)).tolist() == rows[:600, 0].tolist()
    assert result.samples("time", slice(900, None)).tolist() == rows[900:, 0].tolist()
    start = len(content) - 16000
    words = rf"rows 601 to 900 \(bytes {start + 9600} to {start + 14400}\) are not what their checksum says"
    for touch in (
        lambda: result["acceleration"],
        lambda: result.columns["time"],
        lambda: result.samples("time", slice(899, 901)),
        lambda: result.samples("time"),
    ):
        with pytest.raises(rattle.ResultError, match=words):
            touch()


def test_extreme_rows_stand_apart(tmp_path):
    result = rattle.read(write_result(tmp_path / "a.rattle", COLUMNS, ROWS, extremes=EXTREMES, coarse=True))
    assert result.row_count == 3 and result["time"].tolist() == [0.0, 0.1, 0.2]
    assert result.coarse is True
    assert result.extremes["time"].tolist() == [0.05, 0.15]
    assert result.extremes["acceleration"].tolist() == [9.0, -9.0]
    time, acceleration = result.merged(("time", "acceleration"))
    assert time.tolist() == [0.0, 0.05, 0.1, 0.15, 0.2]
    assert acceleration.tolist() == [1.5, 9.0, -2.5, -9.0, 1e-300]
    assert result.merged(("acceleration",), slice(1, None))[0].tolist() == [-2.5, -9.0, 1e-300]


def test_series_without_extreme_rows(tmp_path):
    result = rattle.read(write_result(tmp_path / "a.rattle", COLUMNS, ROWS))
    assert result.coarse is False
    assert result.extremes["time"].size == 0
    assert result.merged(("time",))[0].tolist() == [0.0, 0.1, 0.2]


def test_run_that_ended_among_its_extreme_rows(tmp_path):
    """The count of rows comes last: without it the extreme rows are none of the others."""
    content = bytearray(result_bytes(COLUMNS, ROWS, extremes=EXTREMES))
    content[24:32] = struct.pack("<q", -1)
    path = tmp_path / "a.rattle"
    for cut in (0, 5, 16, 20, 32):
        path.write_bytes(content[: len(content) - cut])
        result = rattle.read(path)
        assert not result.closed
        assert result["time"].tolist() == [0.0, 0.1, 0.2]
        assert result.extremes["time"].size == 0


def test_header_fields_are_reported(tmp_path):
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
        (result_bytes(COLUMNS, ROWS, format_version=1), "has format version 1"),
        (_swapped(), "big-endian byte order"),
        (result_bytes(COLUMNS, 2 * ROWS)[:-48], "holds 3 of its 6 rows"),
        (result_bytes(COLUMNS, ROWS) + bytes(32), "is 32 bytes longer than its 3 rows"),
        (_with_row_count(7), "counts of rows contradict each other"),
        (_with_row_count(1), "counts of rows contradict each other"),
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
