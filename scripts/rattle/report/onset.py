"""Where impacts begin over the varied keys of a campaign, and where they load the bearings most."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rattle.campaign_plan import GEAR, GRID
from rattle.campaign_result import Campaign
from rattle.campaign_section import short_name
from rattle.figures import campaign_look as look
from rattle.report import page
from rattle.thresholds import WITH_IMPACTS

# What a beginning is sought along, the first that is varied.
ALONG = ("oil.temperature_celsius", "shaft.speed_rpm")
NONE = "no impacts"


def impacts(campaign: Campaign) -> np.ndarray | None:
    """Scenes with impacts, in the loudest of their motions; None where no verdict is recorded."""
    column = look.loudest(campaign, "verdict")
    if column not in campaign:
        return None
    return campaign.done & ~campaign.failed & np.isin(campaign[column], WITH_IMPACTS)


def keys(campaign: Campaign) -> list[str]:
    """The varied keys without the pairs, that of the beginning first."""
    varied = [key for key in campaign.varied if key != GEAR]
    first = next((key for key in ALONG if key in varied), varied[0])
    return [first, *(key for key in varied if key != first)]


def least(campaign: Campaign) -> int | None:
    """The row of the least value of the first key with impacts, None where there are none."""
    found = impacts(campaign)
    if found is None or not found.any():
        return None
    rows = np.flatnonzero(found)
    return int(rows[np.lexsort([campaign[key][rows] for key in reversed(keys(campaign))])[0]])


def beginning(campaign: Campaign) -> str:
    """As in 'between -10 and 0 degC, at 2200 1/min': the step of the grid in which the first impacts are."""
    row = least(campaign)
    if row is None:
        return NONE
    along, *others = keys(campaign)
    unit, value = campaign.units[along], float(campaign[along][row])
    values = campaign.axis(along).values
    words = f"from {page.plain(value, unit, page.FEW_DIGITS)}"
    if campaign.kind == GRID:
        place = int(np.searchsorted(values, value))
        before = page.plain(float(values[place - 1]), unit, page.FEW_DIGITS).partition(" ")[0]
        words = f"between {before} and {words.removeprefix('from ')}" if place else f"{words} or below"
    words += "" if along in ALONG else f" of {short_name(along)}"
    return ", at ".join([words, *([values_at(campaign, row, others)] if others else [])])


def worst(campaign: Campaign) -> tuple[float, str] | None:
    """The largest film force [N rms] with impacts, or without, and where it is; None if not recorded."""
    column = look.loudest(campaign, "film_force_rms")
    if column not in campaign:
        return None
    forces = np.where(campaign.done & ~campaign.failed, campaign[column], np.nan)
    if not np.isfinite(forces).any():
        return None
    row = int(np.nanargmax(forces))
    return float(forces[row]), values_at(campaign, row, keys(campaign))


def values_at(campaign: Campaign, row: int, names: Sequence[str]) -> str:
    """As in '2200 1/min and 120 degC'; keys that their unit does not show by their names."""
    parts = []
    for key in names:
        value = page.plain(float(campaign[key][row]), campaign.units[key], page.FEW_DIGITS)
        parts.append(value if key in ALONG else f"{short_name(key)} {value}")
    return " and ".join(parts)


def headline(campaign: Campaign) -> str | None:
    """At which values impacts begin, and where they are worst, over all pairs; None without verdicts."""
    named = zip(campaign.gears, campaign.pairs, strict=True) if len(campaign.pairs) > 1 else [("", campaign)]
    names = {alone: gear for gear, alone in named if alone.done.any()}
    if not names or all(impacts(alone) is None for alone in names):
        return None
    first = {alone: row for alone in names if (row := least(alone)) is not None}
    if not first:
        return "No impacts in the range computed"

    def inside(alone: Campaign, words: str) -> str:
        return ", ".join(filter(None, (names[alone], words)))

    along = keys(campaign)[0]
    begins = min(first, key=lambda alone: float(alone[along][first[alone]]))
    where, _, beside = beginning(begins).partition(", at ")
    more = inside(begins, beside)
    words = f"Impacts begin {where}" + (f" ({more})" if more else "")
    forces = {alone: found for alone in names if (found := worst(alone))}
    if forces:
        most = max(forces, key=lambda alone: forces[alone][0])
        size = page.plain(forces[most][0], "N", 3)
        words += f"; worst {size} rms ({inside(most, forces[most][1].replace(' and ', ', '))})"
    return words
