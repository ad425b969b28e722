"""The table of chunks of a result file: the checksum of every run of rows.

It stands in the header region behind the resolved input, at the next multiple of 64 bytes:

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

import numpy as np

CAMPAIGN, SERIES = b"CHUNKTAB", b"BLOCKTAB"
TABLE_HEAD = struct.Struct("<8sqqq")


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
