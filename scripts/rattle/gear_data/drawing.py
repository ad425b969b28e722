"""Tables of drawing data: a quantity in each row, one column of values or one for each gear pair."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path

from rattle.gear_data import GearDataError, Given, pair_name
from rattle.gear_data.names import advice, is_circumferential, key_of
from rattle.gear_data.values import name_and_unit, value_of
from rattle.keys import key_table
from rattle.optional import needed

SPREADSHEETS = (".xlsx", ".xlsm")
HEADS = ("name", "quantity", "parameter", "")
UNITS, REMARKS = ("unit", "units"), ("remark", "remarks", "note", "notes", "comment", "source")
Rows = Sequence[tuple[int, list[str]]]


def read_drawing(path: Path) -> list[Given]:
    """The values of a CSV file or a spreadsheet. Raises GearDataError with every row that cannot be used."""
    rows = _cells_of_sheet(path) if path.suffix.lower() in SPREADSHEETS else _cells_of_text(path)
    rows = [(number, row) for number, row in rows if any(row) and not row[0].startswith("#")]
    if not rows:
        raise GearDataError(f"{path} is empty.")
    head = [cell.lower() for cell in rows[0][1]]
    has_head = head[0] in HEADS
    names = rows[0][1] if has_head else ["", ""]
    head = head if has_head else names
    unit_columns = [column for column, name in enumerate(head) if name in UNITS]
    columns = [
        column for column, name in enumerate(head) if column and name not in (*UNITS, *REMARKS) and has_head
    ] or [1]
    columns = [column for column in columns if any(len(row) > column and row[column] for _, row in rows)]
    pairs = {
        column: pair_name(names[column]) if len(columns) > 1 else _only(names, column) for column in columns
    }
    if len(columns) > 1 and (len(set(pairs.values())) < len(pairs) or "" in pairs.values()):
        raise GearDataError(f"{path}:{rows[0][0]}: each pair needs a name of its own above its column.")
    found: list[Given] = []
    faults: list[str] = []
    for number, row in rows[has_head:]:
        row = row + [""] * (len(names) - len(row))
        place = f"{path}:{number}"
        beyond = [cell for cell in row[len(names) :] if cell]
        if beyond:
            faults.append(f"{place}: '{beyond[0]}' stands beyond the last column that has a head")
        unit = next((row[column] for column in unit_columns), "")
        cells = {pairs[column]: row[column] for column in columns if row[column]}
        try:
            found += _row(row[0], unit, cells, place)
        except GearDataError as fault:
            faults.append(f"{place}: {row[0]}: {fault}")
    if faults:
        raise GearDataError("\n".join(f"{fault}." for fault in faults))
    return found


def _row(head: str, unit: str, cells: dict[str, str], place: str) -> list[Given]:
    """The values of a row; a title of rows has none."""
    name, behind = name_and_unit(head, _unit_of)
    known = key_of(name)
    if not cells:
        return []
    if known is None:
        raise GearDataError(f"this name is not known; {advice(name)}")
    if behind and unit and behind != unit:
        raise GearDataError(f"the unit {unit} stands in the row, and {behind} behind its name")
    unit = behind or unit
    group, key = known
    rule = key_table()[known]
    found = []
    for pair, cell in cells.items():
        value = value_of(cell, unit, rule)
        words = f"{name}: {cell}" + (f" {unit}" if unit not in ("", "-") and unit not in cell else "")
        found.append(Given(pair if group == "gear" else "", group, key, value, place, words))
    if group != "gear":
        if len({one.value for one in found}) > 1:
            raise GearDataError("all pairs share it, but the values differ")
        return found[:1]
    return [_along_normal(one) for one in found] if is_circumferential(name) else found


def _unit_of(name: str) -> str | None:
    known = key_of(name)
    return key_table()[known].unit if known else None


def _along_normal(given: Given) -> Given:
    """A circumferential backlash, still to be taken along the normal by the angles of its pair."""
    return Given(given.pair, "gear", CIRCUMFERENTIAL, given.value, given.place, given.words)


CIRCUMFERENTIAL = "circumferential backlash"


def along_normal(given: Sequence[Given]) -> list[Given]:
    """Circumferential backlashes at the reference circle along the normal of the flanks.

    cos(alpha_t) cos(beta_b) is cos(alpha_n) cos(beta), of the drawing's own angles.
    """
    by_key = {(one.pair, one.key): one for one in given}
    found = []
    for one in given:
        if one.key != CIRCUMFERENTIAL:
            found.append(one)
            continue
        factor = 1.0
        for key in ("pressure_angle_deg", "helix_angle_deg"):
            angle = by_key.get((one.pair, key))
            if angle is None:
                raise GearDataError(
                    f"{one.place}: {one.words}: it needs the {key[:-4].replace('_', ' ')} too."
                )
            factor *= math.cos(math.radians(angle.number))
        value = float(f"{one.number * factor:.15g}")
        words = f"{one.words}, along the normal"
        found.append(Given(one.pair, "gear", "backlash", value, one.place, words))
    return found


def _only(names: Sequence[str], column: int) -> str:
    """The name of the only pair; a head such as 'value' names none."""
    name = names[column] if column < len(names) else ""
    return "" if name.lower() in ("value", "values") else pair_name(name)


def _cells_of_text(path: Path) -> Rows:
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise GearDataError(f"{path} is no text in UTF-8; save it as CSV in UTF-8.") from None
    separator = max(";\t,", key=lambda mark: sum(mark in line for line in lines))
    reader = csv.reader(lines, delimiter=separator)
    return [(reader.line_num, [" ".join(cell.split()) for cell in row] or [""]) for row in reader]


def _cells_of_sheet(path: Path) -> Rows:
    """The cells of the only sheet that has any; formulas by the values that were saved with them."""
    openpyxl = needed("openpyxl")
    try:
        books = [openpyxl.load_workbook(path, data_only=values) for values in (True, False)]
    except Exception as fault:  # a damaged file is shown by exceptions of many types
        raise GearDataError(f"{path} cannot be read as a spreadsheet ({fault}).") from None
    filled = [sheet for sheet in books[0].worksheets if sheet.max_row > 1 or sheet["A1"].value is not None]
    if len(filled) != 1:
        raise GearDataError(f"{path} has {len(filled)} sheets with cells; leave the one of the gear data.")
    formulas = books[1][filled[0].title]
    rows = []
    for number, row in enumerate(filled[0].iter_rows(), 1):
        for cell in row:
            if cell.value is None and formulas[cell.coordinate].value is not None:
                raise GearDataError(f"{path}: {cell.coordinate}: no value was saved with its formula.")
        rows.append((number, [_text(cell.value) for cell in row]))
    return rows


def _text(value: object) -> str:
    return "" if value is None else " ".join(str(value).split())
