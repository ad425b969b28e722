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
64     8       checksum of the scenes of a CSV file, 0: none
72     8       checksum of the header
80     8       rows that the checksums of a series cover
88     4       count of extreme rows
92     4       1: the series is coarser than the motion
96     8       checksum of the rows behind the last whole chunk
104    8       checksum of the extreme rows
112    8       checksum of the 32 bytes from 80 on
128    48 each name (32) and unit (16) of every column
...            resolved input as namelist text
...            table of chunks
====== ======= ==========================================================

The rows follow, then the extreme rows.

The table of chunks holds the checksum of every run of rows. It stands behind the resolved input, at the next
multiple of 64 bytes:

====== ======= =============================================================
offset bytes   content
====== ======= =============================================================
0      8       magic ``CHUNKTAB`` in a campaign, ``BLOCKTAB`` in a series
8      8       rows in a chunk; the last chunk may hold fewer
16     8       count of chunks
24     8       rows of a campaign; rows that a series has at most
32     8 each  checksum of every chunk; 0: not done, or not whole
====== ======= =============================================================

Zeros follow up to the first row, again at a multiple of 64 bytes.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from rattle.checksums import checksum

MAGIC = b"RATTLE\r\n"
FORMAT_VERSION = 2
BYTE_ORDER_MARK = 0x01020304
ALIGNMENT = 64
FIXED_PART = struct.Struct("<8siiqqii24sqq40s8x")
SEAL = struct.Struct("<qiiqqq")
COLUMN_PART = struct.Struct("<32s16s")
CAMPAIGN, SERIES = b"CHUNKTAB", b"BLOCKTAB"
TABLE_HEAD = struct.Struct("<8sqqq")
# Words of a chunk of a series, as long as that makes no more chunks than this.
SERIES_CHUNK_WORDS, MOST_SERIES_CHUNKS = 524_288, 4096


class ResultError(Exception):
    """A result file that cannot be used, explained in one plain sentence."""


class ColumnError(ResultError, KeyError):
    """A column that a result does not have."""

    __str__ = Exception.__str__


@dataclass(frozen=True)
class ChunkTable:
    """Rows in a chunk, rows in all (of a series at most), and the checksum of every chunk."""

    kind: bytes
    chunk_rows: int
    row_limit: int
    checksums: np.ndarray

    @property
    def done(self) -> np.ndarray:
        return self.checksums != 0

    @property
    def head_bytes(self) -> bytes:
        return TABLE_HEAD.pack(self.kind, self.chunk_rows, self.checksums.size, self.row_limit)

    @property
    def table_bytes(self) -> bytes:
        return self.head_bytes + self.checksums.astype("<i8").tobytes()


@dataclass(frozen=True)
class Seal:
    """What the checksums of a series cover, and its extreme rows."""

    rows: int = 0
    extremes: int = 0
    coarse: int = 0
    rest_checksum: int = 0
    extremes_checksum: int = 0

    @property
    def seal_bytes(self) -> bytes:
        words = (self.rows, self.extremes, self.coarse, self.rest_checksum, self.extremes_checksum)
        front = SEAL.pack(*words, 0)[:-8]
        return SEAL.pack(*words, checksum(front))


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
    source_checksum: int
    seal: Seal
    chunks: ChunkTable

    @property
    def closed(self) -> bool:
        return self.row_count >= 0

    @property
    def input_start(self) -> int:
        """Offset of the resolved input."""
        return FIXED_PART.size + COLUMN_PART.size * len(self.names)

    @property
    def row_bytes(self) -> int:
        return 8 * len(self.names)


def series_chunk_rows(column_count: int, row_limit: int) -> int:
    """Rows in a chunk of a series."""
    return max(1, SERIES_CHUNK_WORDS // column_count, -(-row_limit // MOST_SERIES_CHUNKS))


def aligned(count: int) -> int:
    """The next multiple of the alignment of a result file."""
    return -(-count // ALIGNMENT) * ALIGNMENT


def header_bytes_of(
    columns: bytes,
    text: bytes,
    *,
    column_count: int,
    program_version: bytes,
    row_count: int,
    source_checksum: int,
    chunks: ChunkTable,
    seal: Seal,
) -> bytes:
    """A whole header, up to its first row."""
    table_start = aligned(FIXED_PART.size + len(columns) + len(text))
    table = chunks.table_bytes
    header_bytes = aligned(table_start + len(table))
    words = [MAGIC, FORMAT_VERSION, BYTE_ORDER_MARK, header_bytes, row_count, column_count, len(text)]
    words += [program_version, source_checksum]
    fixed = FIXED_PART.pack(*words, 0, seal.seal_bytes)
    covered = fixed[:24] + fixed[32:72] + columns + text + chunks.head_bytes
    fixed = FIXED_PART.pack(*words, checksum(covered), seal.seal_bytes)
    return ((fixed + columns + text).ljust(table_start, b"\0") + table).ljust(header_bytes, b"\0")


def read_header(stream: BinaryIO, path: object) -> ResultHeader:
    """Read and check the header at the start of `stream`; `path` is named in the messages."""
    fixed = stream.read(FIXED_PART.size)
    if not fixed.startswith(MAGIC[: len(fixed)]) or not fixed:
        ending = "" if str(path).endswith(".rattle") else ", which is called NAME.rattle"
        raise ResultError(f"{path} is not a rattle result file{ending}.")
    if len(fixed) >= 16:
        version, mark = struct.unpack("<ii", fixed[8:16])
        _check_encoding(version, mark, path)
    if len(fixed) < FIXED_PART.size:
        raise ResultError(f"{path} ends inside its header.")
    (_, _, _, header_bytes, row_count, column_count, input_bytes, program, source, stored, seal) = (
        FIXED_PART.unpack(fixed)
    )
    column_bytes = COLUMN_PART.size * column_count
    table_start = aligned(FIXED_PART.size + column_bytes + input_bytes)
    if (
        column_count < 1
        or input_bytes < 0
        or row_count < -1
        or header_bytes % ALIGNMENT != 0
        or header_bytes < table_start + TABLE_HEAD.size
    ):
        raise ResultError(f"{path} has a damaged header: its sizes contradict each other.")
    if stream.seek(0, 2) < header_bytes:
        raise ResultError(f"{path} ends inside its header.")

    stream.seek(FIXED_PART.size)
    columns, text = stream.read(column_bytes), stream.read(input_bytes)
    stream.seek(table_start)
    head = stream.read(TABLE_HEAD.size)
    if checksum(fixed[:24] + fixed[32:72] + columns + text + head) != stored:
        raise ResultError(f"{path} has a damaged header: it is not what its checksum says.")
    chunks = _read_chunks(stream, head, header_bytes - table_start, path)
    names = tuple(_text(name, "column name", path) for name, _ in COLUMN_PART.iter_unpack(columns))
    if "" in names or len(set(names)) < len(names):
        raise ResultError(f"{path} has a damaged header: its column names are blank or repeated.")
    return ResultHeader(
        header_bytes=header_bytes,
        row_count=row_count,
        names=names,
        units=tuple(_text(unit, "unit", path) for _, unit in COLUMN_PART.iter_unpack(columns)),
        program_version=_text(program, "program version", path),
        input_bytes=input_bytes,
        input_text=_text(text, "resolved input", path),
        source_checksum=source,
        seal=_read_seal(seal, row_count, chunks, path),
        chunks=chunks,
    )


def checksum_of_head(path: Path) -> int:
    """Checksum of all bytes before the rows, among which are those of the rows; 0 where there are none.

    The summary of a run holds it, so that the two are known to belong together.
    """
    with path.open("rb") as stream:
        fixed = stream.read(FIXED_PART.size)
        if len(fixed) < FIXED_PART.size:
            return 0
        header_bytes = FIXED_PART.unpack(fixed)[3]
        if not FIXED_PART.size <= header_bytes <= stream.seek(0, 2):
            return 0
        stream.seek(0)
        return checksum(stream.read(header_bytes))


def _read_chunks(stream: BinaryIO, head: bytes, space: int, path: object) -> ChunkTable:
    """The table of chunks, whose head has been read and fills a known space with its checksums."""
    kind, chunk_rows, count, row_limit = TABLE_HEAD.unpack(head)
    if (
        kind not in (CAMPAIGN, SERIES)
        or chunk_rows < 1
        or row_limit < 0
        or count != max(-(-row_limit // chunk_rows), 1)
        or aligned(TABLE_HEAD.size + 8 * count) != space
    ):
        raise ResultError(f"{path} has a damaged chunk table: its sizes contradict each other.")
    return ChunkTable(kind, chunk_rows, row_limit, np.frombuffer(stream.read(8 * count), dtype="<i8"))


def _read_seal(raw: bytes, row_count: int, chunks: ChunkTable, path: object) -> Seal:
    """What the checksums of a series cover; nothing, if the disk was full while it was written."""
    *words, stored = SEAL.unpack(raw)
    seal = Seal(*words)
    if row_count < 0 and checksum(raw[:-8]) != stored:
        return Seal()
    expected = seal.rows if chunks.kind == SERIES else chunks.row_limit
    if (
        checksum(raw[:-8]) != stored
        or not 0 <= seal.rows <= chunks.row_limit
        or seal.extremes < 0
        or seal.coarse not in (0, 1)
        or row_count not in (-1, expected)
    ):
        raise ResultError(f"{path} has a damaged header: its counts of rows contradict each other.")
    return seal


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
