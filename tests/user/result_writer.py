"""Writes result files for the tests, independent of the reader and of the Fortran program."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from pathlib import Path

import numpy as np

LANES = 509


def checksum(data: bytes) -> int:
    """The checksum of fsrc/foundation/checksum.f90, written out with Python's integers."""
    words = struct.unpack(f"<{-(-len(data) // 8)}Q", data.ljust(-(-len(data) // 8) * 8, b"\0"))
    lanes = [0] * LANES
    for place, word in enumerate(words):
        lanes[place % LANES] ^= word
    joined = _mixed(len(data), 0)
    for place, lane in enumerate(lanes, 1):
        joined ^= _mixed(lane, place)
    return struct.unpack("<q", struct.pack("<Q", joined or 1))[0]


def _mixed(word: int, place: int) -> int:
    high, low = divmod(word ^ (place * 0x5E3779B1), 1 << 32)
    high ^= _folded(low * 0x7FEB352D)
    low ^= _folded(high * 0x6C8E9CF5)
    high ^= _folded(low * 0x58F38DED)
    return high << 32 | low


def _folded(product: int) -> int:
    return (product ^ product >> 32) & 0xFFFFFFFF


def result_bytes(
    columns: Sequence[tuple[str, str]],
    rows: Sequence[Sequence[float]] | np.ndarray,
    *,
    input_text: str = "",
    closed: bool = True,
    program_version: str = "0.1.0",
    format_version: int = 2,
    byte_order: str = "<",
    chunk_rows: int = 64,
    extremes: Sequence[Sequence[float]] = (),
    coarse: bool = False,
) -> bytes:
    """A whole result file; `columns` holds pairs of name and unit.

    A file that is not closed is one whose rows came after the last checksum.
    """
    table_rows = np.asarray(rows, dtype=byte_order + "f8").reshape(-1, len(columns))
    extreme_rows = np.asarray(extremes, dtype=byte_order + "f8").reshape(-1, len(columns)).tobytes()
    chunks = [table_rows[i : i + chunk_rows].tobytes() for i in range(0, len(table_rows), chunk_rows)]
    rest = chunks.pop() if len(table_rows) % chunk_rows else b""
    sums = [checksum(chunk) for chunk in chunks] if closed else []
    count = max(-(-len(table_rows) // chunk_rows), 1)
    seal = (0, 0, 0, 0, 0)
    if closed:
        sums_behind = (checksum(rest) if rest else 0, checksum(extreme_rows) if extremes else 0)
        seal = (len(table_rows), len(extremes), int(coarse), *sums_behind)
    head = header(
        columns,
        input_text.encode("ascii"),
        table=(b"BLOCKTAB", chunk_rows, count, len(table_rows)),
        checksums=(sums + [0] * count)[:count],
        seal=seal,
        row_count=len(table_rows) if closed else -1,
        program_version=program_version,
        format_version=format_version,
        byte_order=byte_order,
    )
    return head + table_rows.tobytes() + extreme_rows


def header(
    columns: Sequence[tuple[str, str]],
    text: bytes,
    *,
    table: tuple[bytes, int, int, int],
    checksums: Sequence[int],
    row_count: int,
    program_version: str,
    seal: tuple[int, int, int, int, int] = (0, 0, 0, 0, 0),
    source: int = 0,
    format_version: int = 2,
    byte_order: str = "<",
) -> bytes:
    """A header up to the first row; a row count of -1: not closed."""
    table_start = -(-(128 + 48 * len(columns) + len(text)) // 64) * 64
    header_bytes = -(-(table_start + 32 + 8 * len(checksums)) // 64) * 64
    front = b"RATTLE\r\n" + struct.pack(byte_order + "iiq", format_version, 0x01020304, header_bytes)
    behind = struct.pack(byte_order + "ii", len(columns), len(text))
    behind += program_version.encode("ascii").ljust(24) + struct.pack(byte_order + "q", source)
    names = b"".join(
        name.encode("ascii").ljust(32) + unit.encode("ascii").ljust(16) for name, unit in columns
    )
    table_head = struct.pack(byte_order + "8sqqq", *table)
    sealed = struct.pack(byte_order + "qiiqq", *seal)
    head = front + struct.pack(byte_order + "q", row_count) + behind
    head += struct.pack(byte_order + "q", checksum(front + behind + names + text + table_head))
    head += sealed + struct.pack(byte_order + "q", checksum(sealed)) + bytes(8) + names + text
    head = (
        head.ljust(table_start, b"\0")
        + table_head
        + struct.pack(f"{byte_order}{len(checksums)}q", *checksums)
    )
    return head.ljust(header_bytes, b"\0")


def resealed(content: bytes) -> bytes:
    """A changed file with the right checksum of its header: the work of another program, no damage."""
    column_count, text_bytes = struct.unpack("<ii", content[32:40])
    end = 128 + 48 * column_count + text_bytes
    table = -(-end // 64) * 64
    covered = content[:24] + content[32:72] + content[128:end] + content[table : table + 32]
    return content[:72] + struct.pack("<q", checksum(covered)) + content[80:]


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
   task = '{task}'
/
&load
   steady_force = 200.0
   {force}
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
   harmonic_threshold = 0.01
   idle_harmonics = 20
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
    task: str = "motion",
    name: str | None = None,
    tolerance: float = 1e-12,
    steps_per_period: int = 128,
    stride: int = 1,
    periods: int = 20,
    window: int = 16,
    without: str | None = None,
    closed: bool = True,
    extremes: Sequence[Sequence[float]] = (),
    coarse: bool = False,
    film_lines: dict[float, float] | None = None,
    force: dict[int, float] | None = None,
) -> Path:
    """A made-up motion: `lines` maps f/f_exc to the amplitude of the acceleration [m/s2].

    `film_lines` maps it to amplitudes of the film [um], beside the one that it has anyway; `force` maps
    orders of the force to amplitudes [N], without it there is a cosine.
    """
    samples = steps_per_period // stride
    phase = np.arange(periods * samples + 1) / samples
    angle = 2.0 * np.pi * phase
    data = {
        "time": phase / 500.0,
        "applied_force": 200.0 + sum(a * np.cos(n * angle) for n, a in (force or {1: 150.0}).items()),
        "film_thickness": 1e-6
        * (1.0 - 0.4 * np.cos(angle) + sum(a * np.cos(r * angle) for r, a in (film_lines or {}).items())),
        "acceleration": sum(a * np.cos(ratio * angle) for ratio, a in lines.items()),
    }
    columns = [(column, unit) for column, unit in MOTION_COLUMNS if column != without]
    text = _MOTION_INPUT.format(
        name=name or path.stem,
        law=law,
        force=f"force_orders = {str([*force])[1:-1]}\n   force_amplitudes = {str([*force.values()])[1:-1]}"
        if force
        else "force_amplitude = 150.0",
        task=task,
        tolerance=tolerance,
        steps_per_period=steps_per_period,
        periods=periods,
        window=window,
        stride=stride,
    )
    rows = np.column_stack([data[column] for column, _ in columns])
    return write_result(path, columns, rows, input_text=text, closed=closed, extremes=extremes, coarse=coarse)
