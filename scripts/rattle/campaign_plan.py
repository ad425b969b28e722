"""What a campaign varies: the group &campaign of its resolved input."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rattle.namelist import NamelistError, parse_groups

GRID, SAMPLE, TABLE = "grid", "sample", "csv"
GEAR = "gear"  # the axis of the gear pairs, where several stand in the input
LINEAR, LOGARITHMIC, LISTED = "linear", "logarithmic", "values"


@dataclass(frozen=True)
class PlannedAxis:
    """One varied key of a grid: its scale, and its values where the input has them."""

    key: str
    scale: str
    values: np.ndarray | None


@dataclass(frozen=True)
class Plan:
    """Kind of the campaign, its axes if it is a grid, count of scenes if known, and which part this is."""

    kind: str
    axes: tuple[PlannedAxis, ...]
    scene_count: int | None
    part: int
    parts: int
    gears: tuple[str, ...] = ()


def read_plan(input_text: str) -> Plan:
    """The plan behind a resolved input. Raises ValueError with a sentence where it has none."""
    try:
        groups = parse_groups(input_text)
        group = groups.get("campaign")
        gears = gear_names(groups)
    except NamelistError as fault:
        raise ValueError(f"its resolved input cannot be read: {fault}") from None
    if group is None:
        raise ValueError("its resolved input has no group &campaign.")
    part, parts = _count(group, "part"), _count(group, "parts")
    if part > parts:
        raise ValueError(f"its part {part} is none of {parts}.")
    if _said(group, "csv"):
        return Plan(TABLE, (), None, part, parts, gears)
    starts = group.start_index
    keys = _indexed(group, starts, "vary")
    if str(group.get("sample") or GRID).strip() != GRID:
        size = group.get("size")
        axes = tuple(PlannedAxis(key, _scale(group, starts, i), None) for i, key in sorted(keys.items()))
        size = size * max(len(gears), 1) if isinstance(size, int) else None
        return Plan(SAMPLE, axes, size, part, parts, gears)
    axes = tuple(_axis(group, starts, i, str(key).strip()) for i, key in sorted(keys.items()))
    if gears:
        axes = (PlannedAxis(GEAR, LISTED, np.arange(1.0, len(gears) + 1.0)), *axes)
    sizes = [axis.values.size for axis in axes if axis.values is not None]
    count = math.prod(sizes) if axes and len(sizes) == len(axes) else None
    return Plan(GRID, axes, count, part, parts, gears)


def gear_names(groups: Mapping[str, Any]) -> tuple[str, ...]:
    """Names of the gear pairs where several stand, in their order."""
    pairs = groups.get("gear")
    if not isinstance(pairs, list):
        return ()
    return tuple(str(pair.get("name", "")).strip() for pair in pairs)


def _count(group: Mapping[str, Any], key: str) -> int:
    """A positive whole number, 1 if it is not given."""
    number = group.get(key)
    if number is None:
        return 1
    if isinstance(number, bool) or not isinstance(number, int) or number < 1:
        raise ValueError(f"its campaign.{key} is not a positive whole number.")
    return number


def _said(group: Mapping[str, Any], key: str) -> bool:
    return bool(str(group.get(key) or "").strip())


def _scale(group: Mapping[str, Any], starts: Mapping[str, Any], index: int) -> str:
    return str(_indexed(group, starts, "scale").get(index) or LINEAR).strip()


def _axis(group: Mapping[str, Any], starts: Mapping[str, Any], index: int, key: str) -> PlannedAxis:
    listed = _listed(group, starts, index)
    if listed is not None:
        return PlannedAxis(key, LISTED, listed)
    scale = _scale(group, starts, index)
    ends: list[Any] = [_indexed(group, starts, name).get(index) for name in ("first", "last", "count")]
    if not all(isinstance(end, int | float) for end in ends):
        return PlannedAxis(key, scale, None)
    first, last, count = float(ends[0]), float(ends[1]), int(ends[2])
    space = np.geomspace if scale == LOGARITHMIC and first > 0.0 and last > 0.0 else np.linspace
    return PlannedAxis(key, scale, space(first, last, count) if count > 0 else None)


def _listed(group: Mapping[str, Any], starts: Mapping[str, Any], index: int) -> np.ndarray | None:
    """values(:, index), without the places that were left free."""
    columns = group.get("values")
    if columns is None:
        return None
    if not isinstance(columns, list) or not any(isinstance(column, list) for column in columns):
        columns = [columns if isinstance(columns, list) else [columns]]
    start = starts.get("values") or [1]
    offset = start[1] if len(start) > 1 and start[1] else 1
    if not 0 <= index - offset < len(columns):
        return None
    column = columns[index - offset]
    numbers = [value for value in (column if isinstance(column, list) else [column]) if value is not None]
    return np.array(numbers, dtype=float) if numbers else None


def _indexed(group: Mapping[str, Any], starts: Mapping[str, Any], key: str) -> dict[int, Any]:
    """Index and value of a key that is an array."""
    values = group.get(key)
    if values is None:
        return {}
    sequence: Sequence[Any] = values if isinstance(values, list) else [values]
    first = (starts.get(key) or [1])[0] or 1
    return {first + i: value for i, value in enumerate(sequence) if value is not None}
