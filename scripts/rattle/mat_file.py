"""MAT-files (level 5) that Matlab, Octave and scipy open: columns of numbers, and texts."""

from __future__ import annotations

import re
import struct
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from rattle.result_header import ResultError

INT8, UINT16, INT32, UINT32, DOUBLE, MATRIX = 1, 4, 5, 6, 9, 14  # types of data elements
CHARACTERS, NUMBERS = 4, 6  # classes of arrays
LONGEST_NAME = 63
MOST_BYTES = 2**31 - 1  # of one variable


def write_mat(path: Path, columns: Mapping[str, np.ndarray], texts: Mapping[str, str]) -> None:
    """Write variables; names that Matlab does not take get an underscore for what it does not know."""
    named: dict[str, np.ndarray | str] = {}
    for name, values in {**columns, **texts}.items():
        known = re.sub(r"\W", "_", name)[:LONGEST_NAME]
        if known in named:
            raise ResultError(f"{name} and another variable are both called {known} in a MAT-file")
        named[known] = values
    with path.open("wb") as stream:
        stream.write(
            b"MATLAB 5.0 MAT-file, written by rattle".ljust(124) + struct.pack("<H2s", 0x0100, b"IM")
        )
        for name, values in named.items():
            stream.write(variable(name, values))


def variable(name: str, values: np.ndarray | str) -> bytes:
    """One variable: a text as a row of characters, numbers in their shape, one dimension as a column."""
    if isinstance(values, str):
        data = values.encode("utf-16-le")
        kind, shape, content = CHARACTERS, (1, len(data) // 2), element(UINT16, data)
    else:
        numbers = np.asarray(values, dtype="<f8")
        shape = numbers.shape if numbers.ndim > 1 else (numbers.size, 1)
        kind, content = NUMBERS, element(DOUBLE, numbers.tobytes(order="F"))
    body = element(UINT32, struct.pack("<II", kind, 0))
    body += element(INT32, struct.pack(f"<{len(shape)}i", *shape))
    body += element(INT8, name.encode("ascii")) + content
    if len(body) > MOST_BYTES:
        raise ValueError(
            f"{name} is too large for a MAT-file, which takes 2 GB a variable; NetCDF takes more"
        )
    return struct.pack("<II", MATRIX, len(body)) + body


def element(kind: int, data: bytes) -> bytes:
    """A data element: its type, its bytes, and zeros up to a multiple of eight."""
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)
