"""Sobol indices of what a campaign records, by Saltelli's design (SALib), and how likely a pair rattles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import f90nml
import numpy as np

from rattle.campaign_plan import LOGARITHMIC, SAMPLE, TABLE
from rattle.campaign_result import Campaign
from rattle.codes import QUANTITIES
from rattle.command import CommandError
from rattle.counts import counted
from rattle.namelist import NamelistError, parse_groups
from rattle.outputs import Writer, text_writer
from rattle.thresholds import WITH_IMPACTS

# What a design records, and what is analysed of it unless others are named.
RECORDED = (
    "verdict",
    "film_force_rms",
    "impacts_per_period_drive",
    "impacts_per_period_coast",
    "inertia_ratio",
)
DIVIDERS = ("csv", "vary", "first", "last", "count", "scale", "values", "sample", "size", "seed")
CONFIDENCE, RESAMPLES = 0.95, 200
LEAST_BLOCKS = 2
BLOCKS = 256  # of a design, where neither --blocks nor campaign.size says how many
NORMAL = 1.959963984540054  # of the interval of a share
LEAST_POINTS = 4  # of a direction


@dataclass(frozen=True)
class Indices:
    """First and total indices of a quantity over the varied keys, with half widths of their intervals."""

    quantity: str
    first: np.ndarray
    first_error: np.ndarray
    total: np.ndarray
    total_error: np.ndarray


@dataclass(frozen=True)
class Direction:
    """Whether a quantity grows with each varied key: Spearman's rank correlation at independent points."""

    quantity: str
    correlation: np.ndarray
    by_chance: float
    """Size that 95 % of the correlations of keys without any effect keep below."""


@dataclass(frozen=True)
class Study:
    """What a design or a sample shows of one pair; `probability` of impacts with its interval, if known."""

    pair: str
    keys: tuple[str, ...]
    blocks: int
    left_out: int
    found: tuple[Indices, ...]
    constant: tuple[str, ...]
    probability: tuple[float, float, float] | None
    directions: tuple[Direction, ...] = ()


@dataclass(frozen=True)
class Design:
    """Saltelli's design: blocks of as many scenes as keys and two more, for each of some gear pairs."""

    blocks: int
    keys: int
    pairs: int
    files: list[tuple[Path, Writer]]

    @property
    def words(self) -> str:
        scenes = self.blocks * (self.keys + 2)
        words = f"{self.blocks} blocks of {self.keys + 2} scenes for {self.keys} keys: {scenes} scenes"
        return (
            f"{words} of each of {self.pairs} pairs, {scenes * self.pairs} in all"
            if self.pairs > 1
            else words
        )


def new_design(path: Path, blocks: int | None, seed: int | None, folder: Path) -> Design:
    """A design over the ranges of an input, and an input that reads it.

    `blocks` None: as many as the scenes of `campaign.size` have room for; `seed` None: that of the campaign.
    """
    from SALib.sample import sobol as design  # takes seconds to load

    try:
        groups = parse_groups(path.read_text(encoding="utf-8"))
    except NamelistError as fault:
        raise CommandError(f"{path} cannot be read: {fault}") from None
    if "campaign" not in groups:
        raise CommandError(f"{path} has no group &campaign, whose vary, first and last are the ranges.")
    keys, lows, highs, logarithmic = _ranges(groups["campaign"], path)
    bounds = np.array([lows, highs], dtype=float)
    bounds[:, logarithmic] = np.log(bounds[:, logarithmic])
    problem = {"num_vars": len(keys), "names": keys, "bounds": bounds.T.tolist()}
    count = blocks or _blocks_of(groups["campaign"].get("size"), len(keys), path)
    seed = seed or groups["campaign"].get("seed", 1)
    points = design.sample(problem, count, calc_second_order=False, seed=seed)
    points[:, logarithmic] = np.exp(points[:, logarithmic])
    lines = [",".join(keys), *(",".join(map(repr, row)) for row in points.tolist()), ""]
    stem = path.stem
    for name in [name for name in groups["campaign"] if name in DIVIDERS]:
        del groups["campaign"][name]
        groups["campaign"].start_index.pop(name, None)
    groups["campaign"]["csv"] = f"{stem}.design.csv"
    groups["campaign"].setdefault("record", list(RECORDED))
    scene = groups.setdefault("scene", f90nml.Namelist())
    scene["name"], scene["task"] = f"{stem}_design", "campaign"
    groups.end_comma = False
    head = (
        f"! Saltelli's design of {counted(count, 'block')}, seed {seed}, over the ranges of {path.name}.\n\n"
    )
    files = [
        (folder / f"{stem}.design.csv", text_writer("\n".join(lines))),
        (folder / f"{stem}_design.nml", text_writer(head + str(groups) + "\n")),
    ]
    return Design(count, len(keys), max(1, sum(name == "gear" for name, _ in groups.items())), files)


def _blocks_of(size: Any, keys: int, path: Path) -> int:
    """The largest power of two of blocks that a count of scenes has room for."""
    if size is None:
        return BLOCKS
    blocks = int(size) // (keys + 2) if isinstance(size, int) else 0
    if blocks < LEAST_BLOCKS:
        raise CommandError(
            f"{path}: &campaign size = {size}, which are the scenes, holds no {LEAST_BLOCKS} blocks of "
            f"{keys + 2}; write size = {LEAST_BLOCKS * (keys + 2)} at least, or give --blocks."
        )
    return 1 << (blocks.bit_length() - 1)


def _ranges(campaign: f90nml.Namelist, path: Path) -> tuple[list[str], list[float], list[float], np.ndarray]:
    """Keys with both ends of their ranges, and which are spread by their logarithm."""
    lists = {}
    for name in ("vary", "first", "last", "scale"):
        given = campaign.get(name)
        lists[name] = given if isinstance(given, list) else [] if given is None else [given]
    keys = [str(key).strip() for key in lists["vary"]]
    lists["scale"] += ["linear"] * (len(keys) - len(lists["scale"]))
    if not keys or any(
        len(lists[name]) != len(keys) or not all(isinstance(end, int | float) for end in lists[name])
        for name in ("first", "last")
    ):
        raise CommandError(f"{path}: &campaign needs vary with first and last for each key.")
    logarithmic = np.array([str(scale).strip() == LOGARITHMIC for scale in lists["scale"]])
    for key, low, high, is_log in zip(keys, lists["first"], lists["last"], logarithmic, strict=True):
        if not low < high or (is_log and low <= 0.0):
            raise CommandError(
                f"{path}: {key} goes from {low:g} to {high:g}, which is not a range to sample."
            )
    return keys, lists["first"], lists["last"], logarithmic


def studies(campaign: Campaign, quantities: Sequence[str]) -> list[Study]:
    """What a campaign over a design shows, pair by pair."""
    known = [name for name in RECORDED[1:] if name in campaign] if not quantities else list(quantities)
    for name in known:
        kind = QUANTITIES[name].kind if name in QUANTITIES and name in campaign else ""
        if kind not in ("number", "count", "flag"):
            raise CommandError(f"{campaign.path} has no numbers of '{name}'.")
    if not known and campaign.kind != SAMPLE:
        raise CommandError(
            f"{campaign.path} records none of {', '.join(RECORDED[1:])}: name others by --quantities."
        )
    return [_study(pair, known) for pair in campaign.pairs]


def is_design(campaign: Campaign) -> bool:
    """Whether a campaign is over a design, of which indices follow."""
    try:
        return campaign.kind == TABLE and all(
            len(_blocks(_points(pair), pair)) > 0 for pair in campaign.pairs
        )
    except CommandError:
        return False


def _points(campaign: Campaign) -> np.ndarray:
    """(scene, varied key)"""
    return np.column_stack([np.array(campaign[key], dtype=float) for key in campaign.varied])


def _study(campaign: Campaign, quantities: Sequence[str]) -> Study:
    from SALib.analyze import sobol as indices

    pair = campaign.name.rpartition(".")[2] if campaign.gears else ""
    if campaign.kind == SAMPLE:
        found_signs = directions(campaign, quantities, 1)
        return Study(pair, tuple(campaign.varied), 0, 0, (), (), _probability(campaign, 1), found_signs)
    blocks = _blocks(_points(campaign), campaign)
    usable = np.all((campaign.done & ~campaign.failed).reshape(blocks.shape[:2]), axis=1)
    found, constant = [], []
    names = list(campaign.varied)
    problem = {"num_vars": len(names), "names": names, "bounds": [[0.0, 1.0]] * len(names)}
    for name in quantities:
        values = np.array(campaign[name], dtype=float).reshape(blocks.shape[:2])
        values = values[usable & np.all(np.isfinite(values), axis=1)]
        if len(values) < 2 or np.ptp(values) <= 1e-12 * np.max(np.abs(values), initial=0.0):
            constant.append(name)
            continue
        computed = indices.analyze(
            problem,
            values.ravel(),
            calc_second_order=False,
            num_resamples=RESAMPLES,
            conf_level=CONFIDENCE,
            seed=1,
        )
        found.append(Indices(name, computed["S1"], computed["S1_conf"], computed["ST"], computed["ST_conf"]))
    return Study(
        pair,
        tuple(campaign.varied),
        len(blocks),
        int(np.sum(~usable)),
        tuple(found),
        tuple(constant),
        _probability(campaign, blocks.shape[1]),
        directions(campaign, quantities, blocks.shape[1]),
    )


def directions(campaign: Campaign, quantities: Sequence[str], size: int) -> tuple[Direction, ...]:
    """The direction of each quantity that varies; `size` scenes are a block, 1 in a sample."""
    from scipy.stats import spearmanr

    found = []
    for name in quantities:
        values = np.array(campaign[name], dtype=float)
        usable = independent(campaign, size) & np.isfinite(values)
        if np.sum(usable) < LEAST_POINTS or np.ptp(values[usable]) <= 1e-12 * np.max(np.abs(values[usable])):
            continue
        columns = (np.array(campaign[key], dtype=float)[usable] for key in campaign.varied)
        signs = np.array([spearmanr(column, values[usable]).statistic for column in columns])
        found.append(Direction(name, signs, float(NORMAL / np.sqrt(np.sum(usable) - 1))))
    return tuple(found)


def independent(campaign: Campaign, size: int) -> np.ndarray:
    """Which rows are scenes that were solved, at points that are drawn independently."""
    drawn = np.isin(np.arange(campaign.row_count) % size, (0, size - 1))
    return drawn & campaign.done & ~campaign.failed


def block_size(campaign: Campaign) -> int:
    """Scenes of a block of a design, 1 of a sample. Raises CommandError for any other campaign."""
    return 1 if campaign.kind == SAMPLE else _blocks(_points(campaign), campaign).shape[1]


def _blocks(points: np.ndarray, campaign: Campaign) -> np.ndarray:
    """The points by blocks: one of a first sample, each key of it from a second in turn, the second."""
    size = points.shape[1] + 2
    fault = CommandError(
        f"{campaign.path} is not a campaign over a design or a sample: 'sensitivity.py design' writes one."
    )
    if len(points) == 0 or len(points) % size:
        raise fault
    blocks = points.reshape(-1, size, points.shape[1])
    for key in range(points.shape[1]):
        expected = blocks[:, 0].copy()
        expected[:, key] = blocks[:, -1, key]
        if not np.array_equal(expected, blocks[:, key + 1]):
            raise fault
    return blocks


def _probability(campaign: Campaign, size: int) -> tuple[float, float, float] | None:
    """Share of the independent points at which the pair rattles, with Wilson's interval."""
    if "verdict" not in campaign:
        return None
    usable = independent(campaign, size)
    if not np.any(usable):
        return None
    return share_of(np.isin(campaign["verdict"], WITH_IMPACTS)[usable])


def share_of(hits: np.ndarray) -> tuple[float, float, float]:
    """Share of true ones, and both ends of its 95 % interval (Wilson)."""
    count, share = len(hits), float(np.mean(hits))
    centre = share + NORMAL**2 / (2 * count)
    half = NORMAL * np.sqrt(share * (1.0 - share) / count + NORMAL**2 / (4 * count**2))
    low, high = (float((centre + side * half) / (1.0 + NORMAL**2 / count)) for side in (-1.0, 1.0))
    return share, low, high
