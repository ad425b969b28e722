"""Tables of the entries: as CSV beside each, and in README.md of this folder."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from pathlib import Path

PAGE = Path(__file__).resolve().parent / "README.md"

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


def replace_table(name: str, lines: Sequence[str]) -> None:
    """Replace the table of a name in README.md."""
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    table = "\n".join([begin, *lines, end])
    page = re.sub(f"{begin}.*{end}", lambda _: table, PAGE.read_text(), flags=re.DOTALL)
    PAGE.write_text(page)
    print("\n".join(lines))
