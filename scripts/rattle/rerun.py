"""Single scenes of a campaign, or of a sweep, as inputs of their own, with the time series."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import f90nml
import numpy as np

from rattle.campaign_plan import GEAR
from rattle.campaign_result import SCENE, Campaign
from rattle.command import CommandError
from rattle.namelist import parse_groups
from rattle.outputs import Writer, text_writer
from rattle.result import Result

# Keys that name tables in files of their own.
TABLES = ("gear.drag_table", "shaft.table")


def extreme_rows(campaign: Campaign, column: str, count: int, *, smallest: bool = False) -> np.ndarray:
    """Rows of the scenes with the largest (or smallest) entries of a column, the most extreme first.

    Scenes that failed or are not done take no part; equals stay in scene order.
    """
    values = np.array(campaign[column], dtype=float)
    usable = campaign.done & ~campaign.failed & np.isfinite(values)
    rows = np.flatnonzero(usable)
    key = values[rows] if smallest else -values[rows]
    return rows[np.argsort(key, kind="stable")][:count]


def failed_rows(campaign: Campaign, count: int) -> np.ndarray:
    """Rows of the first scenes that failed."""
    return np.flatnonzero(campaign.failed)[:count]


def scene_values(campaign: Campaign, row: int) -> dict[str, float]:
    """The varied keys of one scene."""
    return {key: float(campaign[key][row]) for key in campaign.varied}


def scene_label(campaign: Campaign, row: int) -> str:
    """Name of a single scene, which is the stem of its files."""
    digits = len(str(campaign.scene_count or campaign.row_count))
    return f"{campaign.name}_{int(campaign[SCENE][row]):0{digits}d}"


def inputs(
    campaign: Campaign, rows: Sequence[int], directory: Path, results: str
) -> list[tuple[Path, Writer]]:
    """A file for each row that takes its input: the base scene with the values of this one, and a series.

    Tables that the base input names stand beside them.
    """
    files = {
        directory / f"{scene_label(campaign, row)}.nml": input_text(campaign, row, results) for row in rows
    }
    for row in rows:
        for name, text in tables(campaign, row).values():
            files[directory / name] = text
    return [(path, text_writer(text)) for path, text in files.items()]


def tables(campaign: Campaign, row: int) -> dict[str, tuple[str, str]]:
    """The tables of one scene by their keys: names of files, and what they hold.

    The resolved input has their rows as comments; those of a gear pair stand behind its name.
    """
    text, pair = campaign.input_text, ""
    if campaign.gears:
        pair = campaign.gears[int(campaign[GEAR][row]) - 1]
        text = text.partition(f"\n! gear {pair}\n")[2].partition("\n! gear ")[0]
    return _tables_of(text, campaign.name, pair)


def _tables_of(text: str, name: str, pair: str = "") -> dict[str, tuple[str, str]]:
    found = {}
    for key in TABLES:
        lines = re.findall(rf"^! derived: {re.escape(key)} (?:columns|row) = (.*)$", text, re.MULTILINE)
        if lines:
            file = f"{name}.{pair + '.' if pair and key.startswith('gear') else ''}{key}.csv"
            found[key] = (file, "".join(line.replace(", ", ",") + "\n" for line in lines))
    return found


def motion_of_sweep(result: Result, directory: Path) -> list[tuple[Path, Writer]]:
    """The input of a sweep as that of one motion, NAME.nml, and the tables that it names, beside it."""
    groups, tables = parse_groups(result.input_text), _tables_of(result.input_text, result.scene_name)
    groups.pop("sweep")
    for name, (file, _) in tables.items():
        group, key = name.split(".", 1)
        groups[group][key] = file
    groups["scene"]["task"] = "motion"
    groups.setdefault("output", f90nml.Namelist())["series"] = True
    groups.end_comma = False
    files = {f"{result.scene_name}.nml": str(groups) + "\n", **dict(tables.values())}
    return [(directory / name, text_writer(text)) for name, text in files.items()]


def input_text(campaign: Campaign, row: int, results: str) -> str:
    """The input of one scene. The base is the resolved input, so no default can change it."""
    groups = parse_groups(campaign.input_text)
    groups.pop("campaign", None)
    if campaign.gears:
        pair = groups["gear"][int(campaign[GEAR][row]) - 1]
        del groups["gear"]
        groups["gear"] = pair
    for name, value in scene_values(campaign, row).items():
        if name == GEAR:
            continue
        group, key = name.split(".", 1)
        groups.setdefault(group, f90nml.Namelist())
        groups[group][key] = _number(value, groups[group].get(key), name)
    for name, (file, _) in tables(campaign, row).items():
        group, key = name.split(".", 1)
        groups[group][key] = file
    scene = groups.setdefault("scene", f90nml.Namelist())
    scene["name"] = scene_label(campaign, row)
    scene["task"] = "motion"
    output = groups.setdefault("output", f90nml.Namelist())
    output["series"] = True
    output["directory"] = results
    groups.end_comma = False
    number = int(campaign[SCENE][row])
    head = f"! Scene {number} of the campaign {campaign.name}, as a single run with its time series.\n\n"
    return head + str(groups) + "\n"


def _number(value: float, base: object, name: str) -> float | int:
    """A whole number where the base has one, or where there is no base and the value is whole."""
    whole = value.is_integer() and abs(value) < 1e9
    if isinstance(base, int) and not isinstance(base, bool):
        if not whole:
            raise CommandError(f"{name} = {value!r} is not the whole number that its key takes.")
        return int(value)
    return int(value) if base is None and whole else value
