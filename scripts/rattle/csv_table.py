"""Tables of CSV files as the program itself reads them: its separators, units and words on faults."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rattle.command import CommandError


@dataclass(frozen=True)
class CsvTable:
    """Columns of numbers; a field that is empty is no number.

    `names` stand in the line `header`, `units` in the one below or are empty; each row of `values` stands in
    one of `lines`.
    """

    path: Path
    header: int
    names: tuple[str, ...]
    units: tuple[str, ...]
    values: np.ndarray
    lines: np.ndarray

    def name_of(self, column: int, unit: str) -> tuple[str, str]:
        """What a column is called without its unit, and that, where one such as `unit` is needed."""
        return _unit_of(self.names[column], self.units[column], unit)[:2]

    def column(self, column: int, unit: str) -> np.ndarray:
        """The numbers of a column in the unit that is needed; refuse one that cannot be converted."""
        _, _, (factor, added), fault = _unit_of(self.names[column], self.units[column], unit)
        if fault:
            raise CommandError(
                f"{self.path}:{self.header}: column {column + 1} ({self.names[column]}): {fault}."
            )
        return factor * self.values[:, column] + added


def read_csv_table(path: Path, example: str) -> CsvTable:
    """Read a table; `example` is a header as it may be.

    Raises
    ------
    CommandError
        Each fault with file and line, in the words of the program.
    """
    import rattle._kernels as _kernels

    place = os.fsencode(path)
    counts, faults, *found = _kernels.wrap_read_csv(place, example, 1, 1)
    if counts[0] == 0:
        raise CommandError("\n".join(os.fsdecode(faults).split("\n")[:-1]))
    if tuple(counts[:2]) != (1, 1):
        _, _, *found = _kernels.wrap_read_csv(place, example, counts[0], counts[1])
    names, units, values, lines = found
    # A separator at the end of each line makes a column without name and numbers.
    kept = [
        column for column, name in enumerate(names) if name.strip() or np.isfinite(values[:, column]).any()
    ]
    return CsvTable(
        path,
        int(counts[2]),
        tuple(_decoded(names[column]) for column in kept),
        tuple(_decoded(units[column]) for column in kept),
        np.ascontiguousarray(values[:, kept]),
        lines,
    )


def conversion(unit: str, needed: str) -> tuple[float, float, str]:
    """Factor of a number in one unit, and what is added, to be in another; or why it cannot be."""
    _, _, (factor, added), fault = _unit_of("", unit, needed)
    return float(factor), float(added), fault


def _unit_of(head: str, below: str, needed: str) -> tuple[str, str, np.ndarray, str]:
    """Name without unit; the unit; factor and what is added behind; why nothing makes the unit needed."""
    import rattle._kernels as _kernels

    name, unit, conversion, fault = _kernels.wrap_column_unit(head.encode(), below.encode(), needed)
    return _decoded(name), _decoded(unit), conversion, _decoded(fault)


def _decoded(text: bytes) -> str:
    """Words of a file in UTF-8, or as older programs write them."""
    try:
        return text.decode().strip()
    except UnicodeDecodeError:
        return text.decode("latin-1").strip()
