"""How a verdict holds within tolerances, by a campaign over them beside the results of a report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rattle.campaign_result import Campaign, read_campaign
from rattle.codes import CODES
from rattle.command import CommandError
from rattle.figures.campaign_look import short_name
from rattle.result_file import ResultFile
from rattle.sensitivity import block_size, independent, share_of
from rattle.summary import Summary

# What the campaign of tolerances of an input NAME is called: a sample, or a design.
ENDINGS = ("_tolerances.rattle", "_tolerances_design.rattle")
GROUPS = ("gear", "shaft", "oil", "load")


@dataclass(frozen=True)
class Held:
    """Share of drawn scenes with the verdict of a result, with its 95 % interval."""

    verdict: str
    share: float
    low: float
    high: float
    drawn: int
    campaign: str
    keys: tuple[str, ...]
    law: str
    """Film law of the campaign where it is another than that of the result; else empty."""

    @property
    def words(self) -> str:
        law = f", with the {self.law} law" if self.law else ""
        return (
            f"Within tolerances: {self.verdict} in {percent(self.share)} of {self.drawn} drawn boxes "
            f"(95 % interval {percent(self.low)} to {percent(self.high)}), by {self.campaign} over "
            f"{', '.join(map(short_name, self.keys))}{law}."
        )


def held(result: ResultFile, summary: Summary) -> Held | str:
    """How the verdict of a motion holds; a sentence where the campaign beside it is of another input.

    Nothing, '', without a campaign, without verdicts in it, and of no motion.
    """
    gear = str(summary.get("gear", "")).strip()
    name = str(summary.get("name", "")).strip().removesuffix(f".{gear}" if gear else "")
    path = next((one for end in ENDINGS if (one := result.path.parent / f"{name}{end}").exists()), None)
    verdict = str(summary.get("verdict", "")).strip()
    code = next((code for code, word in CODES["verdict"].items() if word == verdict), None)
    if path is None or code is None:
        return ""
    try:
        campaign = _pair_of(read_campaign(path), gear)
        drawn = independent(campaign, block_size(campaign)) if "verdict" in campaign else np.zeros(0, bool)
    except CommandError:
        return f"{path.name} has no sample or design over tolerances of this pair."
    if not np.any(drawn):
        return f"{path.name} has no verdict within tolerances."
    other = _other_key(campaign, result)
    if other:
        return f"{path.name} is of another {other} than this result and says nothing of it."
    share, low, high = share_of(np.array(campaign["verdict"], dtype=int)[drawn] == code)
    laws = [str(one.input.get("film", {}).get("law", "")) for one in (campaign, result)]
    law = laws[0] if laws[0] != laws[1] else ""
    keys = tuple(key for key in campaign.varied if "." in key)
    return Held(verdict, share, low, high, int(np.sum(drawn)), path.stem, keys, law)


def sentences(result: ResultFile, summary: Summary) -> list[str]:
    """What is said of it below 'How sure'."""
    found = held(result, summary)
    return [found.words if isinstance(found, Held) else found] if found else []


def short(found: Sequence[Held | str]) -> list[str]:
    """The same of one or several pairs for the verdict itself: the least share."""
    least = min((one for one in found if isinstance(one, Held)), key=lambda one: one.share, default=None)
    if least is None:
        return []
    if len(found) == 1:
        return [f"It holds in {percent(least.share)} of {least.drawn} boxes drawn within tolerances."]
    return [f"Each verdict holds in {percent(least.share)} or more of the boxes drawn within tolerances."]


def percent(share: float) -> str:
    return f"{100.0 * share:.0f} %"


def _pair_of(campaign: Campaign, gear: str) -> Campaign:
    if not campaign.gears:
        return campaign
    if gear not in campaign.gears:
        raise CommandError(f"{campaign.path} has no pair {gear}.")
    return campaign.pair(gear)


def _other_key(campaign: Campaign, result: ResultFile) -> str:
    """The first key of the input that both have with another value, and that is not varied."""
    for group in GROUPS:
        given = result.input.get(group, {})
        for key, value in campaign.input.get(group, {}).items():
            if f"{group}.{key}" not in campaign.varied and key in given and given[key] != value:
                return f"{group}.{key}"
    return ""
