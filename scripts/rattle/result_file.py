"""What all result files share: header facts, the resolved input, and the checked map of the rows."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from rattle.namelist import NamelistError, parse
from rattle.result_header import ResultError, ResultHeader


class ResultFile:
    """A result file of any kind: its place, its columns by name, and what its header tells.

    Attributes
    ----------
    path : where the file stands
    names, units : column names in order, and their units
    closed : False when the run was killed, or still runs
    program_version, input_text : as written by the program
    """

    def __init__(self, path: Path, header: ResultHeader) -> None:
        self.path = path
        self.names = header.names
        self.units: Mapping[str, str] = MappingProxyType(dict(zip(header.names, header.units, strict=True)))
        self.closed = header.closed
        self.program_version = header.program_version
        self.input_text = header.input_text

    def __contains__(self, name: object) -> bool:
        return name in self.units

    def check_column(self, name: str) -> None:
        """Refuse a name that is no column."""
        if name not in self:
            raise ResultError(f"{self.path} has no column '{name}'; it holds {', '.join(self.names)}.")

    @cached_property
    def input(self) -> dict[str, dict[str, Any]]:
        """The resolved input: group, key, value."""
        try:
            return parse(self.input_text)
        except NamelistError as fault:
            raise ResultError(f"The resolved input in {self.path} cannot be read: {fault}") from None


def check_length(path: Path, header: ResultHeader, data_bytes: int) -> None:
    """Refuse a closed file whose rows are not as many as its header says."""
    expected = header.row_count * header.row_bytes
    if header.closed and data_bytes < expected:
        held = data_bytes // header.row_bytes
        raise ResultError(f"{path} is cut short: it holds {held} of its {header.row_count} rows.")
    if header.closed and data_bytes > expected:
        raise ResultError(f"{path} is {data_bytes - expected} bytes longer than its {header.row_count} rows.")


def map_rows(path: Path, header: ResultHeader, row_count: int) -> np.ndarray:
    """The first rows of the file, read-only, an index for the column behind that of the row."""
    shape = (row_count, len(header.names))
    if row_count == 0:  # an empty range cannot be mapped
        rows = np.empty(shape, dtype="<f8")
        rows.flags.writeable = False
        return rows
    try:
        return np.memmap(path, dtype="<f8", mode="r", offset=header.header_bytes, shape=shape)
    except OSError as fault:
        raise ResultError(f"{path} cannot be mapped: {fault.strerror or fault}.") from None
