"""The chunk table of a campaign result: which runs of rows are done.

It stands in the header region behind the resolved input, at the next multiple of 64 bytes:

====== ======= ==============================================
offset bytes   content
====== ======= ==============================================
0      8       magic ``CHUNKTAB``
8      8       rows in a chunk; the last chunk may hold fewer
16     8       count of chunks
24     8 each  checksum of every chunk, 0 until it is done
====== ======= ==============================================

Zeros follow up to the first row, again at a multiple of 64 bytes.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from rattle.result_header import ResultError, ResultHeader, aligned

MAGIC = b"CHUNKTAB"
TABLE_HEAD = struct.Struct("<8sqq")


@dataclass(frozen=True)
class ChunkTable:
    """Rows in a chunk, and the checksum of every chunk."""

    chunk_rows: int
    checksums: np.ndarray

    @property
    def done(self) -> np.ndarray:
        return self.checksums != 0

    @property
    def table_bytes(self) -> bytes:
        head = TABLE_HEAD.pack(MAGIC, self.chunk_rows, self.checksums.size)
        return head + self.checksums.astype("<i8").tobytes()


def read_chunk_table(stream: BinaryIO, header: ResultHeader, path: object) -> ChunkTable:
    """Read and check the chunk table; `header` is that of the same stream."""
    start = aligned(header.input_end)
    stream.seek(start)
    head = stream.read(TABLE_HEAD.size) if start + TABLE_HEAD.size <= header.header_bytes else b""
    if not head.startswith(MAGIC):
        raise ResultError(f"{path} is no campaign: it has no chunk table.")
    _, chunk_rows, count = TABLE_HEAD.unpack(head)
    if chunk_rows < 1 or count < 0 or aligned(start + TABLE_HEAD.size + 8 * count) != header.header_bytes:
        raise ResultError(f"{path} has a damaged chunk table: its sizes contradict each other.")
    checksums = np.frombuffer(stream.read(8 * count), dtype="<i8")
    return ChunkTable(chunk_rows, checksums)
