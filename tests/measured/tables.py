"""Tables of the entries as CSV beside each."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path

Value = str | int | float


def cell(value: Value) -> str:
    """A number with four digits; NaN where there is no impact."""
    if not isinstance(value, float):
        return str(value)
    return "no impact" if math.isnan(value) else f"{value:.4g}"


def write_csv(path: Path, head: Sequence[str], rows: Sequence[Sequence[Value]]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows([[cell(value) for value in row] for row in rows])


def read_csv(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))
