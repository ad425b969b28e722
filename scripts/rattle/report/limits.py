"""Limits of the film force that a project sets, pair by pair."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Mapping
from pathlib import Path

from rattle.campaign_plan import GEAR
from rattle.command import CommandError
from rattle.result_file import ResultFile

HEAD = ("gear", "film_force_rms")
Limits = Mapping[str, float]


def read_limits(path: Path) -> dict[str, float]:
    """Limits [N rms] by the names of gear pairs, of a CSV file with the head gear,film_force_rms."""
    try:
        lines = list(csv.reader(path.read_text(encoding="utf-8-sig").splitlines()))
    except (OSError, UnicodeDecodeError) as fault:
        raise CommandError(f"{path} cannot be read: {getattr(fault, 'strerror', fault) or fault}.") from None
    rows = [(number, [cell.strip() for cell in row]) for number, row in enumerate(lines, 1) if "".join(row)]
    if not rows or tuple(rows[0][1]) != HEAD:
        raise CommandError(f"{path}:1: the head has to be {','.join(HEAD)}.")
    limits: dict[str, float] = {}
    for number, row in rows[1:]:
        try:
            gear, value = row[0], float(row[1])
        except (IndexError, ValueError):
            raise CommandError(f"{path}:{number}: a name and a number [N] are expected.") from None
        if not math.isfinite(value) or value <= 0.0 or gear in limits:
            raise CommandError(f"{path}:{number}: a limit is a positive number, one for each gear.")
        limits[gear] = value
    return limits


def check(path: Path, limits: Limits, results: Iterable[ResultFile]) -> list[str]:
    """Names in the file that no motion has. Raises CommandError where none of its limits is for one."""
    motions = [result for result in results if result.task == "motion"]
    gears = {str(result.input.get(GEAR, {}).get("name", "")).strip() for result in motions}
    if not gears & {*limits}:
        named = ", ".join(sorted(gears - {""})) or "no pair with a name (&gear name)"
        raise CommandError(
            f"{path} has limits of {', '.join(limits) or 'no pair'}; the motions are of {named}."
            if motions
            else f"{path}: limits are those of motions, and no result is one."
        )
    return [name for name in limits if name not in gears]


def words(gear: str, force: float, limits: Limits) -> str:
    """As in 'above its limit of 10 N'; nothing without a limit."""
    if gear not in limits:
        return ""
    place = "above" if force > limits[gear] else "within"
    return f"{place} its limit of {limits[gear]:.4g} N"


def excess(gear: str, force: float | None, limits: Limits) -> str:
    """By how much a force is above its limit, as in '+2.1 dB'; a dash where one of them is not known."""
    return f"{20.0 * math.log10(force / limits[gear]):+.1f} dB" if force and gear in limits else "-"
