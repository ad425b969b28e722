"""Recordings in text: separator, decimal mark, heads, units and comments follow from the lines."""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rattle.recordings import units
from rattle.recordings.faults import RecordingError, library
from rattle.recordings.raw import Raw

# Separator and decimal mark; of several that fit as many lines the first.
DIALECTS = ((";", "."), (";", ","), ("\t", "."), ("\t", ","), (",", "."), ("|", "."), (" ", "."), (" ", ","))
WORDS = {"\t": "tabs", " ": "blanks", ";": "semicolons", ",": "commas", "|": "bars"}
COMMENT = ("#", "!", "%", "//")
GAPS = ("", "nan", "na", "n/a", "-", "--", "null", "none", "#n/a", "#nv", "invalid")
TIME_NAMES = re.compile(r"(^(t|times|timestamps?|zeitstempel)|time|zeit)(?![a-z])", re.IGNORECASE)
CLOCK = re.compile(r"^(\d{4}-\d\d?-\d\d?[ T]|\d\d?[./]\d\d?[./]\d{2,4} )?\d\d?:\d\d:\d\d([.,]\d+)?Z?$")
SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0}
THOUSANDS = re.compile(r"^[-+]?\d{1,3}(\.\d{3})+,\d*$")
SAMPLE = 400
# No quantity of a bench is as large.
LARGEST = 1e30


@dataclass(frozen=True)
class Layout:
    """How the lines of a text are to be read; `words` are columns without numbers."""

    separator: str
    decimal: str
    columns: int
    first: int
    words: frozenset[int] = frozenset()

    def split(self, line: str) -> list[str]:
        if self.separator == " ":
            return line.split()
        return [cell.strip() for cell in next(csv.reader([line.strip(" ")], delimiter=self.separator), [])]


def read_text(path: Path, notes: list[str]) -> list[Raw]:
    """Every column of numbers, over the one that is time, if one is."""
    lines = _decoded(path, notes).splitlines()
    kept = [(n, line) for n, line in enumerate(lines, 1) if line.strip() and not _is_comment(line)]
    layout = _layout(path, [line for _, line in kept])
    names, given = _heads(path, layout, kept, lines, notes)
    numbers, table, clocks = _table(path, layout, kept[layout.first :], names)
    time_at = _time_column(path, names, given, table, clocks, notes)
    time = None
    if time_at is not None and (clock := table[time_at]) is not None:
        time = _seconds(clock, given[time_at], names[time_at])
    left_out = [names[place] for place, column in table.items() if column is None]
    if left_out:
        notes.append(f"{path}: columns of words are left out: {', '.join(left_out[:9])}.")
    return [
        Raw(names[place], given[place], column, time, numbers)
        for place, column in table.items()
        if place != time_at and column is not None
    ]


def _decoded(path: Path, notes: list[str]) -> str:
    content = path.read_bytes()
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        try:
            return content.decode("utf-16")
        except UnicodeDecodeError:
            raise RecordingError(f"{path} is neither text nor a known format of recordings.") from None
    if b"\0" in content:
        raise RecordingError(f"{path} is neither text nor a known format of recordings.")
    try:
        return content.decode("utf-8-sig").rstrip("\x1a")
    except UnicodeDecodeError:
        text = content.decode("latin-1").rstrip("\x1a")
        if sum(not (c.isprintable() or c.isspace()) for c in text[:4000]) > 40:
            raise RecordingError(f"{path} is neither text nor a known format of recordings.") from None
        notes.append(f"{path}: it is not UTF-8; its letters are taken as latin-1.")
        return text


def _is_comment(line: str) -> bool:
    return line.lstrip().lstrip('"').startswith(COMMENT) and not line.lower().lstrip().startswith("#n")


def _plain_number(cell: str, decimal: str) -> str:
    """A number with a decimal point; with decimal commas points may stand between thousands."""
    if decimal == ".":
        return cell
    if THOUSANDS.match(cell):
        cell = cell.replace(".", "")
    return "" if "." in cell and "," in cell else cell.replace(",", ".")


def _is_number(cell: str, decimal: str) -> bool:
    try:
        float(_plain_number(cell.strip(), decimal))
    except ValueError:
        return False
    return "_" not in cell and cell.lower() != "nan"


def _is_data(cells: Sequence[str], decimal: str, words: Collection[int] = ()) -> bool:
    """Whether cells are numbers, gaps and times of a clock, but for the columns of words; one is a number."""
    numbers = [_is_number(cell, decimal) for cell in cells]
    return any(numbers) and all(
        number or place in words or cell.lower() in GAPS or CLOCK.match(cell)
        for place, (number, cell) in enumerate(zip(numbers, cells, strict=True))
    )


def _words_among(rows: Sequence[Sequence[str]], decimal: str) -> set[int]:
    """Columns of words: hardly a number stands in them."""
    found = set()
    for place in range(len(rows[0])):
        cells = [row[place] for row in rows if row[place].lower() not in GAPS]
        if cells and sum(_is_number(c, decimal) or bool(CLOCK.match(c)) for c in cells) < 0.1 * len(cells):
            found.add(place)
    return found


def _layout(path: Path, lines: list[str]) -> Layout:
    """The separator and decimal mark with which most lines are as many numbers."""
    step = max(1, len(lines) // SAMPLE)
    sample = lines[: SAMPLE // 4] + lines[SAMPLE // 4 :: step]
    best: tuple[int, int, Layout] | None = None
    for separator, decimal in DIALECTS:
        layout = Layout(separator, decimal, 0, 0)
        split = [_without_end(layout.split(line)) for line in sample]
        rows = [cells for cells in split if any(_is_number(cell, decimal) for cell in cells)]
        if not rows:
            continue
        columns = max(Counter(map(len, rows)).items(), key=lambda item: (item[1], item[0]))[0]
        rows = [cells for cells in rows if len(cells) == columns]
        words = _words_among(rows, decimal)
        count = sum(_is_data(cells, decimal, words) for cells in rows)
        heads = any(len(cells) == columns for cells in split[:30] if not _is_data(cells, decimal, words))
        score = (count, min(2, columns - len(words)) + heads)
        if columns > len(words) and count and (best is None or score > best[:2]):
            best = (*score, Layout(separator, decimal, columns, 0, frozenset(words)))
    if best is None:
        raise RecordingError(f"{path} has no line of numbers.")
    return _placed(path, best[2], lines)


def _placed(path: Path, layout: Layout, lines: list[str]) -> Layout:
    """The layout with the place of the first line of numbers."""
    cells = (_without_end(layout.split(line)) for line in lines)
    first = next(
        place
        for place, row in enumerate(cells)
        if 2 * len(row) > layout.columns >= len(row) and _is_data(row, layout.decimal, layout.words)
    )
    heads = len(_without_end(layout.split(lines[first - 1]))) if first else 0
    if layout.separator == "," and layout.columns == 2 * heads:
        if heads == 1:
            return Layout("|", ",", 1, first)
        raise RecordingError(
            f"{path}: commas stand between its columns and within its numbers ({heads} heads, "
            f"{layout.columns} numbers a line); write it with semicolons between the columns."
        )
    return replace(layout, first=first)


def _without_end(cells: list[str]) -> list[str]:
    """The cells of a line without an empty one behind a separator at its end."""
    return cells[:-1] if len(cells) > 1 and not cells[-1] else cells


def _heads(
    path: Path, layout: Layout, kept: list[tuple[int, str]], lines: list[str], notes: list[str]
) -> tuple[list[str], list[str]]:
    """Names and units of the columns: from rows above the numbers, or a comment that has as many words."""
    above = [(number, _without_end(layout.split(line))) for number, line in kept[: layout.first]]
    rows = [(number, _padded(cells, layout.columns)) for number, cells in above]
    full = [(n, c) for n, c in rows if layout.columns == 1 or sum(map(bool, c)) > 1 or _is_units(c)]
    names: list[str] = []
    row_of_units: list[str] = []
    if full and _is_units(full[-1][1]) and len(full) > 1:
        row_of_units, names = full[-1][1], full[-2][1]
    elif full:
        with_units = [place for place, (_, cells) in enumerate(full) if _is_units(cells)]
        if with_units and with_units[-1] > 0:
            row_of_units, names = full[with_units[-1]][1], full[with_units[-1] - 1][1]
        else:
            names = full[-1][1]
    else:
        names = _commented(layout, lines[: kept[layout.first][0] - 1])
    if not names:
        notes.append(f"{path}: it has no heads; its columns are called column_1 and so on.")
        names = [""] * layout.columns
    spelt = [_name_and_unit(cell) for cell in names]
    found = [name or f"column_{place}" for place, (name, _) in enumerate(spelt, 1)]
    given = [unit for _, unit in spelt]
    for place, cell in enumerate(row_of_units):
        if cell:
            given[place] = units.plain(cell)
    between = f" {WORDS[layout.separator]} between columns" if layout.columns > 1 else " one column"
    notes.append(f"{path}:{between}{', decimal commas' if layout.decimal == ',' else ''}.")
    return found, given


def _padded(cells: list[str], count: int) -> list[str]:
    return [*cells, *[""] * count][:count]


def _is_units(cells: Sequence[str]) -> bool:
    """Whether a row of a head holds units: most cells are, and none is a longer word."""
    filled = [cell for cell in cells if cell]
    known = [units.is_known(cell) or re.fullmatch(r"[\[(].*[\])]", cell) is not None for cell in filled]
    return bool(filled) and sum(known) > 0.6 * len(filled)


def _commented(layout: Layout, lines: Sequence[str]) -> list[str]:
    """The heads in the last comment above the numbers that has as many words."""
    for line in reversed(lines):
        if _is_comment(line):
            cells = _without_end(layout.split(line.lstrip().lstrip('"#!%/ ').rstrip('"')))
            if len(cells) == layout.columns:
                return cells
    return []


def _name_and_unit(head: str) -> tuple[str, str]:
    """`speed [1/min]` is a name with a unit; of `speed_rpm` and `speed_rad_s` the end says it."""
    if found := re.fullmatch(r"(.*?)\s*(?:\[([^\]]*)\]|\(([^)]*)\)|/ ?([^/]+(?:/[^/]+)?))", head):
        name, unit = found[1], found[2] or found[3] or found[4] or ""
        if found[2] is not None or units.is_known(unit):
            return name.strip() or head, units.plain(unit)
    words = head.split("_")
    for end in ("/".join(words[-2:]), "".join(words[-2:]), words[-1]):
        if len(words) > 1 and units.is_known(end):
            return head, units.plain(end)
    return head, units.plain(head) if units.is_known(head) and units.plain(head) in ("rpm", "deg") else ""


def _table(
    path: Path, layout: Layout, rows: list[tuple[int, str]], names: Sequence[str]
) -> tuple[np.ndarray, dict[int, np.ndarray | None], set[int]]:
    """Lines of the samples, the numbers of each column (None: it has words), and which columns are clocks."""
    pandas = library("pandas")
    numbers = np.array([number for number, _ in rows])
    text = "\n".join(line.strip(" ") for _, line in rows)
    options = {"sep": layout.separator} if layout.separator != " " else {"sep": r"\s+"}
    width = layout.columns + 1
    try:
        frame = pandas.read_csv(
            io.StringIO(text + "\n"),
            header=None,
            names=range(width),
            index_col=False,
            decimal=layout.decimal,
            skip_blank_lines=False,
            skipinitialspace=True,
            keep_default_na=False,
            na_values=[*GAPS, *(word.upper() for word in GAPS), "NaN", "None", "Null"],
            low_memory=False,
            **options,
        )
    except (ValueError, pandas.errors.ParserError) as fault:
        found = re.search(r"line (\d+)", str(fault))
        place = f", line {numbers[min(int(found[1]), len(rows)) - 1]}" if found else ""
        raise RecordingError(
            f"{path}{place}: {layout.columns} columns were expected, there are more."
        ) from None
    if len(frame) != len(rows):
        raise RecordingError(f"{path}: a quote opens in it that does not close.")
    extra = frame[width - 1].notna().to_numpy()
    if extra.any():
        line = numbers[int(np.argmax(extra))]
        raise RecordingError(
            f"{path}, line {line}: it has more than the {layout.columns} columns of the others."
        )
    table: dict[int, np.ndarray | None] = {}
    clocks: set[int] = set()
    for column in range(layout.columns):
        table[column] = None
        if column not in layout.words:
            table[column] = _clock(frame[column])
            if table[column] is not None:
                clocks.add(column)
            else:
                table[column] = _column(path, frame[column], names[column], numbers, layout.decimal)
    return numbers, table, clocks


def _column(path: Path, cells: Any, name: str, lines: np.ndarray, decimal: str) -> np.ndarray:
    """The numbers of a column; a cell that is none, or is not finite, is refused with its line."""
    pandas = library("pandas")
    if cells.dtype.kind in "fiu":
        values = cells.to_numpy(dtype=float)
        strange = np.abs(values) > LARGEST
    else:
        words = cells.fillna("").astype(str).str.strip()
        if decimal == "," and words.str.match(THOUSANDS).any():
            # Then a point stands between thousands also where there is no comma.
            words = words.str.replace(".", "", regex=False)
        plain = words.map(lambda cell: _plain_number(cell, decimal) or "nan")
        values = pandas.to_numeric(plain, errors="coerce").to_numpy(dtype=float)
        gaps = words.str.lower().isin(GAPS).to_numpy()
        strange = np.isnan(values) & ~gaps | (np.abs(values) > LARGEST)
    if strange.any():
        at = int(np.argmax(strange))
        cell = str(cells.iloc[at]).strip()[:40]
        raise RecordingError(
            f"{path}, line {lines[at]}: '{cell}' in column '{name}' is too large to be measured."
        )
    return values


def _clock(cells: Any) -> np.ndarray | None:
    """Seconds from the first time of a clock on; None of a column that is none."""
    pandas = library("pandas")
    if cells.dtype.kind in "fiu":
        return None
    words = cells.fillna("").astype(str).str.strip()
    if not words.str.match(CLOCK).mean() > 0.9:
        return None
    german = words.str.contains(".", regex=False) & words.str.match(r"^\d\d?\.")
    stamps = pandas.to_datetime(
        words.str.replace(",", "."), errors="coerce", format="mixed", dayfirst=bool(german.any())
    )
    return (stamps - stamps.dropna().iloc[0]).dt.total_seconds().to_numpy(dtype=float)


def _time_column(
    path: Path,
    names: Sequence[str],
    given: Sequence[str],
    table: Mapping[int, np.ndarray | None],
    clocks: Collection[int],
    notes: list[str],
) -> int | None:
    """The column of time: a clock, or by its name, its unit, or as the first one that ascends evenly."""
    numbers = {place: column for place, column in table.items() if column is not None}
    for place in numbers:
        if place in clocks or (TIME_NAMES.search(names[place]) and given[place] in ("", *SECONDS)):
            return place
    for place, column in numbers.items():
        unit = given[place] or names[place]
        if unit in SECONDS and (given[place] or unit != "min") and np.all(np.diff(column) >= 0.0):
            return place
    first = numbers.get(0)
    if first is None or len(numbers) < 2 or len(first) < 4 or given[0]:
        return None
    steps = np.diff(first)
    even = np.all(np.abs(steps - np.median(steps)) <= 0.1 * np.median(steps))
    # Steps of one count samples.
    if even and steps[0] > 0.0 and not np.all(steps == 1.0):
        notes.append(f"{path}: '{names[0]}' ascends evenly; it is taken as the time in s.")
        return 0
    return None


def _seconds(values: np.ndarray, unit: str, name: str) -> np.ndarray:
    return values * SECONDS.get(unit or (name if name in SECONDS else "s"), 1.0)
