"""Writes result files for the tests, independent of the reader and of the Fortran program."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from pathlib import Path

import numpy as np


def result_bytes(
    columns: Sequence[tuple[str, str]],
    rows: Sequence[Sequence[float]] | np.ndarray,
    *,
    input_text: str = "",
    closed: bool = True,
    program_version: str = "0.1.0",
    format_version: int = 1,
    byte_order: str = "<",
) -> bytes:
    """A whole result file; `columns` holds pairs of name and unit."""
    text = input_text.encode("ascii")
    header_bytes = -(-header_end(columns, text) // 64) * 64
    head = header_front(
        columns,
        text,
        header_bytes=header_bytes,
        row_count=len(rows) if closed else -1,
        program_version=program_version,
        format_version=format_version,
        byte_order=byte_order,
    ).ljust(header_bytes, b"\0")
    return head + np.asarray(rows, dtype=byte_order + "f8").reshape(-1, len(columns)).tobytes()


def header_end(columns: Sequence[tuple[str, str]], text: bytes) -> int:
    """Bytes of a header up to the end of its input text."""
    return 64 + 48 * len(columns) + len(text)


def header_front(
    columns: Sequence[tuple[str, str]],
    text: bytes,
    *,
    header_bytes: int,
    row_count: int,
    program_version: str,
    format_version: int = 1,
    byte_order: str = "<",
) -> bytes:
    """A header up to the end of its input text; a row count of -1: not closed."""
    head = b"RATTLE\r\n"
    head += struct.pack(byte_order + "iiqq", format_version, 0x01020304, header_bytes, row_count)
    head += struct.pack(byte_order + "ii", len(columns), len(text))
    head += program_version.encode("ascii").ljust(24)
    for name, unit in columns:
        head += name.encode("ascii").ljust(32) + unit.encode("ascii").ljust(16)
    return head + text


def write_result(path: Path, columns: Sequence[tuple[str, str]], rows, **options) -> Path:
    """Write `result_bytes` to `path`."""
    path.write_bytes(result_bytes(columns, rows, **options))
    return path


MOTION_COLUMNS = (
    ("time", "s"),
    ("applied_force", "N"),
    ("film_thickness", "m"),
    ("acceleration", "m/s2"),
)

_MOTION_INPUT = """&scene
   name = '{name}'
   task = 'motion'
/
&load
   steady_force = 200.0
   force_amplitude = 150.0
   frequency = 500.0
/
&film
   law = '{law}'
   model = 'published'
/
&solver
   method = 'newmark'
   iteration = 'successive'
   predictor = 'previous'
   tolerance = {tolerance!r}
   steps_per_period = {steps_per_period}
   periods = {periods}
/
&spectrum
   periods = {window}
   line_threshold = 0.01
   idle_lines = 20
   quiet_limit = 0.35
   irregular_limit = 0.01
/
&output
   series = .true.
   columns = 'time', 'applied_force', 'film_thickness', 'acceleration'
   stride = {stride}
/
"""


def write_motion(
    path: Path,
    *,
    lines: dict[float, float],
    law: str = "iso-viscous",
    name: str | None = None,
    tolerance: float = 1e-12,
    steps_per_period: int = 128,
    stride: int = 1,
    periods: int = 20,
    window: int = 16,
    without: str | None = None,
    closed: bool = True,
) -> Path:
    """A made-up motion: `lines` maps f/f_exc to the amplitude of the acceleration [m/s2]."""
    samples = steps_per_period // stride
    phase = np.arange(periods * samples + 1) / samples
    angle = 2.0 * np.pi * phase
    data = {
        "time": phase / 500.0,
        "applied_force": 200.0 + 150.0 * np.cos(angle),
        "film_thickness": 1e-6 * (1.0 - 0.4 * np.cos(angle)),
        "acceleration": sum(a * np.cos(ratio * angle) for ratio, a in lines.items()),
    }
    columns = [(column, unit) for column, unit in MOTION_COLUMNS if column != without]
    text = _MOTION_INPUT.format(
        name=name or path.stem,
        law=law,
        tolerance=tolerance,
        steps_per_period=steps_per_period,
        periods=periods,
        window=window,
        stride=stride,
    )
    rows = np.column_stack([data[column] for column, _ in columns])
    return write_result(path, columns, rows, input_text=text, closed=closed)
