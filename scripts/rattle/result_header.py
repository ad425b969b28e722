"""The header of a result file: what stands before the rows.

Layout, little-endian:

====== ======= ==========================================================
offset bytes   content
====== ======= ==========================================================
0      8       magic ``RATTLE\\r\\n``
8      4       format version
12     4       byte-order mark 0x01020304
16     8       offset of the first row, a multiple of 64
24     8       row count, -1 until the run is closed
32     4       column count
36     4       bytes of the resolved input
40     24      program version
64     48 each name (32) and unit (16) of every column
...            resolved input as namelist text, zeros up to the first row
====== ======= ==========================================================
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import BinaryIO

MAGIC = b"RATTLE\r\n"
FORMAT_VERSION = 1
BYTE_ORDER_MARK = 0x01020304
ALIGNMENT = 64
FIXED_PART = struct.Struct("<8siiqqii24s")
COLUMN_PART = struct.Struct("<32s16s")


class ResultError(Exception):
    """A result file that cannot be used, explained in one plain sentence."""


@dataclass(frozen=True)
class ResultHeader:
    """What the header says. `row_count` is -1 while the run is not closed.

    `input_text` comes without the blanks that may end it, `input_bytes` counts them.
    """

    header_bytes: int
    row_count: int
    names: tuple[str, ...]
    units: tuple[str, ...]
    program_version: str
    input_bytes: int
    input_text: str

    @property
    def closed(self) -> bool:
        return self.row_count >= 0

    @property
    def input_start(self) -> int:
        """Offset of the resolved input."""
        return FIXED_PART.size + COLUMN_PART.size * len(self.names)

    @property
    def input_end(self) -> int:
        """Offset of what follows the resolved input."""
        return self.input_start + self.input_bytes

    @property
    def row_bytes(self) -> int:
        return 8 * len(self.names)


def aligned(count: int) -> int:
    """The next multiple of the alignment of a result file."""
    return -(-count // ALIGNMENT) * ALIGNMENT


def read_header(stream: BinaryIO, path: object) -> ResultHeader:
    """Read and check the header at the start of `stream`; `path` is named in the messages."""
    fixed = stream.read(FIXED_PART.size)
    if not fixed.startswith(MAGIC[: len(fixed)]) or not fixed:
        raise ResultError(f"{path} is not a rattle result file.")
    if len(fixed) < FIXED_PART.size:
        raise ResultError(f"{path} ends inside its header.")
    _, version, mark, header_bytes, row_count, column_count, input_bytes, program = FIXED_PART.unpack(fixed)
    _check_encoding(version, mark, path)

    used_bytes = FIXED_PART.size + COLUMN_PART.size * column_count + input_bytes
    if (
        column_count < 1
        or input_bytes < 0
        or row_count < -1
        or header_bytes % ALIGNMENT != 0
        or header_bytes < used_bytes
    ):
        raise ResultError(f"{path} has a damaged header: its sizes contradict each other.")
    if stream.seek(0, 2) < header_bytes:
        raise ResultError(f"{path} ends inside its header.")

    stream.seek(FIXED_PART.size)
    columns = list(COLUMN_PART.iter_unpack(stream.read(COLUMN_PART.size * column_count)))
    names = tuple(_text(name, "column name", path) for name, _ in columns)
    if "" in names or len(set(names)) < len(names):
        raise ResultError(f"{path} has a damaged header: its column names are blank or repeated.")
    return ResultHeader(
        header_bytes=header_bytes,
        row_count=row_count,
        names=names,
        units=tuple(_text(unit, "unit", path) for _, unit in columns),
        program_version=_text(program, "program version", path),
        input_bytes=input_bytes,
        input_text=_text(stream.read(input_bytes), "resolved input", path),
    )


def _check_encoding(version: int, mark: int, path: object) -> None:
    if mark != BYTE_ORDER_MARK:
        if struct.pack(">i", mark) == struct.pack("<i", BYTE_ORDER_MARK):
            raise ResultError(f"{path} was written in big-endian byte order; only little-endian can be read.")
        raise ResultError(f"{path} has a damaged header: its byte-order mark is unknown.")
    if version != FORMAT_VERSION:
        raise ResultError(
            f"{path} has format version {version}; this reader knows version {FORMAT_VERSION} only."
        )


def _text(raw: bytes, what: str, path: object) -> str:
    try:
        return raw.decode("ascii").rstrip(" \0")
    except UnicodeDecodeError:
        raise ResultError(f"{path} has a damaged header: its {what} is not plain text.") from None
