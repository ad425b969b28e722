"""What the pictures of campaigns share: colours of classes, hatches of gaps, axes and their labels."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis as MatplotlibAxis
from matplotlib.colors import LogNorm, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter

from rattle.campaign_plan import GRID, LINEAR, LOGARITHMIC, SAMPLE, TABLE
from rattle.campaign_result import Axis, Campaign
from rattle.campaign_section import short_name
from rattle.codes import FILM_REGIMES, STATUSES, SUCCESSES, spoken, word, words_of

# From the palette of Okabe and Ito, ordered so that they also differ in lightness.
CLASS_COLOURS = {1: "#DCE6EC", 2: "#56B4E9", 3: "#D55E00", 4: "#4B2E63", 5: "#E8C547", 6: "#EACCFC"}
VERDICT_COLOURS = {0: "#DCE6EC", 1: "#56B4E9", 2: "#E8C547", 3: "#D55E00", 4: "#009E73"}
OTHER_COLOURS = (
    "#DCE6EC",
    "#56B4E9",
    "#E69F00",
    "#009E73",
    "#CC79A7",
    "#D55E00",
    "#0072B2",
    "#F0E442",
    "#4D4D4D",
)
FLAG_COLOURS = {
    "verified": {0: "#D55E00", 1: "#DCE6EC"},
    "sampling_sufficient": {0: "#D55E00", 1: "#DCE6EC"},
    "verdict_verified": {0: "#D55E00", 1: "#DCE6EC"},
    "impacts_verified": {0: "#D55E00", 1: "#DCE6EC"},
    "law_contradicted": {0: "#DCE6EC", 1: "#D55E00"},
    "harmonic_count_is_bound": {0: "#DCE6EC", 1: "#D55E00"},
    "harmonic_distortion_is_bound": {0: "#DCE6EC", 1: "#D55E00"},
    "irregular_fraction_is_bound": {0: "#DCE6EC", 1: "#D55E00"},
}
COLOUR_MAP = "cividis"
GAP_COLOUR = "#F6F6F6"
HATCH_COLOUR = "#777777"
HATCHES = ("xxxx", "////", "\\\\\\\\", "++++", "||||", "----", "oo")
NOT_DONE_HATCH = "...."
UNKNOWN_HATCH = "**"
UNCERTAIN_HATCH = "//////"
UNCERTAIN_WORDS = "not verified"
IRREGULAR_SO_FAR = 6
SO_FAR_HATCH = "\\\\\\\\\\\\"
SO_FAR_WORDS = "irregular so far"
CLASSES = ("rattle_class", "loudest_class", "quietest_class")
VERDICTS = ("verdict", "loudest_verdict")
# Columns of the motion from rest, and what stands for them of the loudest.
LOUDEST = {
    "verdict": "loudest_verdict",
    "rattle_class": "loudest_class",
    "film_force_rms": "loudest_film_force_rms",
}
OUTSIDE = 1  # code of closure_range
SEVERAL_HATCH = 3 * "x"
MICROMETRES = "\N{MICRO SIGN}m"


@dataclass(frozen=True)
class Gap:
    """Scenes without a value: why, and which (for every scene; not done ones are False here)."""

    words: str
    hatch: str
    scenes: np.ndarray


def code_colours(column: str) -> Mapping[int, str] | None:
    """The colour of each code of a column of codes; None for plain numbers."""
    words = words_of(column)
    if words is None:
        return None
    if column in VERDICTS or column in CLASSES:
        return CLASS_COLOURS if column in CLASSES else VERDICT_COLOURS
    return FLAG_COLOURS.get(column) or dict(zip(words, OTHER_COLOURS, strict=False))


def loudest(campaign: Campaign, column: str) -> str:
    """The column of the loudest motion that stands for one of the motion from rest, where it is recorded."""
    found = LOUDEST.get(column, column)
    return found if found in campaign else column


def words_in_legends(column: str, code: int) -> str:
    """The word of a code, and more where it stands alone."""
    words = spoken(word(column, code))
    return f"{words} without impact" if column in VERDICTS and words == "separation" else words


def gaps(campaign: Campaign, column: str) -> list[Gap]:
    """Scenes that failed, by status, and those done whose value is unknown."""
    found = []
    values = campaign[column]
    rest = campaign.done & ~np.isfinite(values)
    if "status" in campaign and column != "status":
        status = campaign["status"]
        codes = np.unique(status[campaign.failed])
        for position, code in enumerate(code for code in codes if code not in SUCCESSES):
            scenes = campaign.done & (status == code)
            words = spoken(STATUSES.get(int(code), f"status {int(code)}"))
            found.append(Gap(words, HATCHES[position % len(HATCHES)], scenes))
            rest = rest & ~scenes
    if rest.any():
        found.append(Gap(f"{short_name(column)} unknown", UNKNOWN_HATCH, rest))
    return found


@dataclass(frozen=True)
class Doubt:
    """Scenes whose class does not stand, and how maps mark them."""

    scenes: np.ndarray
    words: str
    hatch: str
    marker: str
    colour: str = "none"  # of these scenes, where they have one in common


def doubts(campaign: Campaign, column: str) -> list[Doubt]:
    """What maps of a column mark: scenes irregular so far, others that are not verified, several motions.

    A map of the verdict marks where that is not verified, whatever the class.
    """
    if column in ("verified", "verdict_verified", "impacts_verified", "status"):
        return []
    nowhere = np.zeros(campaign.row_count, dtype=bool)
    so_far, lacking = nowhere, nowhere
    if column in VERDICTS:
        lacking = campaign.done & (verdict_flags(campaign) == 0.0)
    else:
        if "rattle_class" in campaign:
            so_far = campaign.done & (campaign["rattle_class"] == IRREGULAR_SO_FAR)
        if "verified" in campaign:
            lacking = campaign.done & (campaign["verified"] == 0.0) & ~so_far
    own_colour = CLASS_COLOURS[IRREGULAR_SO_FAR] if column == "rattle_class" else "none"
    found = [
        Doubt(lacking, UNCERTAIN_WORDS, UNCERTAIN_HATCH, "o"),
        Doubt(so_far, SO_FAR_WORDS, SO_FAR_HATCH, "D", own_colour),
        several_motions(campaign, column),
    ]
    return [doubt for doubt in found if doubt.scenes.any()]


def several_motions(campaign: Campaign, column: str) -> Doubt:
    """Scenes with more than one motion; which of them is drawn the legend says."""
    several = np.zeros(campaign.row_count, dtype=bool)
    if "motions" in campaign:
        several = campaign.done & (campaign["motions"] > 1.0)
    drawn = {"loudest": "the loudest", "quietest": "the quietest"}.get(
        column.partition("_")[0], "that from rest"
    )
    return Doubt(several, f"several motions, {drawn} drawn", SEVERAL_HATCH, "s")


def verdict_flags(campaign: Campaign) -> np.ndarray:
    """Whether each verdict is verified; unknown where that is not recorded."""
    known = "verdict_verified" in campaign
    return campaign["verdict_verified"] if known else np.full(campaign.row_count, np.nan)


def where_law_fails(campaign: Campaign) -> tuple[np.ndarray, str] | None:
    """Scenes whose closure is extrapolated or whose law does not fit their regime; None if not recorded."""
    if "closure_range" in campaign and np.isfinite(campaign["closure_range"]).any():
        return campaign["closure_range"] == OUTSIDE, "film is extrapolated"
    if "law_contradicted" in campaign:
        return campaign["law_contradicted"] == 1.0, "film law does not fit"
    if "film_regime" in campaign:
        beyond = next(code for code, words in FILM_REGIMES.items() if words == "elastohydrodynamic")
        return campaign["film_regime"] == beyond, "film is elastohydrodynamic"
    return None


def doubt_patch(words: str, doubt: Doubt) -> Patch:
    """What a scene that is not verified looks like in a legend: hatched, whatever its colour."""
    return Patch(facecolor=doubt.colour, edgecolor="black", hatch=doubt.hatch, linewidth=0.6, label=words)


def measured_speeds(campaign: Campaign) -> tuple[float, float] | None:
    """Lowest and highest speed [1/min] for which the motion of the shaft was measured, where known."""
    ends = campaign.input.get("shaft", {}).get("signal_speed_range")
    return (float(ends[0]), float(ends[1])) if ends else None


def draw_measured_speeds(axes: Axes, campaign: Campaign, keys: Mapping[str, str]) -> list[Line2D]:
    """Dotted lines at the ends of the measured speeds; `keys` of the axes by "x" and "y"."""
    ends = measured_speeds(campaign)
    along = [which for which, key in keys.items() if key == "shaft.speed_rpm"]
    if ends is None or not along:
        return []
    line = {"color": "black", "linestyle": ":", "linewidth": 1.6}
    limits = axes.get_xlim() if along[0] == "x" else axes.get_ylim()
    for end in ends:
        if min(limits) < end < max(limits):
            (axes.axvline if along[0] == "x" else axes.axhline)(end, **line)
    if ends[0] <= min(limits) and max(limits) <= ends[1]:
        return []
    return [Line2D([], [], label=f"shaft measured at {ends[0]:.5g} to {ends[1]:.5g} 1/min only", **line)]


def gap_patch(words: str, hatch: str) -> Patch:
    """What a gap looks like in a legend."""
    return Patch(facecolor=GAP_COLOUR, edgecolor=HATCH_COLOUR, hatch=hatch, linewidth=0.5, label=words)


def share(count: int, whole: int) -> str:
    """As in '12.3 %'."""
    if whole == 0:
        return "0 %"
    percent = 100.0 * count / whole
    if 0.0 < percent < 0.1:
        return "< 0.1 %"
    return f"{percent:.1f} %"


def column_scale(campaign: Campaign, column: str) -> tuple[float, str]:
    """Factor and unit in which a column is shown: thin films in micrometres."""
    unit = campaign.units[column]
    values = campaign[column]
    if unit == "m" and np.nanmax(np.abs(values), initial=0.0) < 1e-3:
        return 1e6, MICROMETRES
    return 1.0, unit


def column_label(campaign: Campaign, column: str) -> str:
    """As in 'Acceleration maximum [m/s2]'."""
    unit = "" if words_of(column) else column_scale(campaign, column)[1]
    relative = "relative " if unit == "m/s2" and campaign.has_gear else ""
    return with_unit(f"{relative}{short_name(column)}", unit)


def axis_label(axis: Axis) -> str:
    """As in 'Shaft speed [1/min]'."""
    return with_unit(short_name(axis.key), axis.unit)


def with_unit(words: str, unit: str) -> str:
    """The label of an axis: words and unit."""
    return capital(words) if unit == "" else f"{capital(words)} [{drawn_unit(unit)}]"


def drawn_unit(unit: str) -> str:
    """A unit as figures show it, powers raised."""
    return re.sub(r"(?<=[a-z])([23])\b", r"$^\1$", unit).replace("degC", "\N{DEGREE SIGN}C")


def capital(words: str) -> str:
    """The words, the first with a capital letter."""
    return words[:1].upper() + words[1:]


def is_logarithmic(axis: Axis) -> bool:
    """Whether an axis is drawn so: as planned, or because its listed values grow by factors."""
    values = axis.values
    if axis.scale == LOGARITHMIC:
        return bool((values > 0.0).all())
    if axis.scale == LINEAR or values.size < 3 or values[0] <= 0.0:
        return False
    return bool(np.ptp(np.diff(np.log(values))) < np.ptp(np.diff(values)) / np.mean(np.diff(values)))


def cell_edges(axis: Axis) -> np.ndarray:
    """Borders between cells, halfway from grid point to grid point; the outer ones are the end points."""
    logarithmic = is_logarithmic(axis)
    points = np.log(axis.values) if logarithmic else axis.values
    if points.size == 1:
        width = 0.1 if logarithmic else 0.1 * abs(points[0]) or 1.0
        edges = np.array([points[0] - width / 2, points[0] + width / 2])
    else:
        middles = 0.5 * (points[1:] + points[:-1])
        edges = np.concatenate([points[:1], middles, points[-1:]])
    return np.exp(edges) if logarithmic else edges


def _widened(axis: Axis) -> np.ndarray:
    """The ends of an axis with some room, so that dots at the ends are whole."""
    ends = np.log(axis.values[[0, -1]]) if is_logarithmic(axis) else axis.values[[0, -1]]
    room = 0.03 * (ends[1] - ends[0])
    ends = ends + np.array([-room, room])
    return np.exp(ends) if is_logarithmic(axis) else ends


def set_axis(axes: Axes, which: str, axis: Axis, *, to_edges: bool) -> None:
    """Scale, limits and label of the x or the y axis."""
    getattr(axes, f"set_{which}label")(axis_label(axis))
    if not axis.values.size:
        # Of a table of scenes no row is known before the first of them is solved.
        return
    edges = cell_edges(axis) if to_edges else _widened(axis)
    getattr(axes, f"set_{which}scale")("log" if is_logarithmic(axis) else "linear")
    if edges[0] < edges[-1]:
        getattr(axes, f"set_{which}lim")(edges[0], edges[-1])
    target = axes.xaxis if which == "x" else axes.yaxis
    if is_logarithmic(axis):
        plain_log_ticks(target, edges[0], edges[-1])


def plain_log_ticks(target: MatplotlibAxis, low: float, high: float) -> None:
    """Ticks such as 0.5, 1, 2, 5 on a short logarithmic axis; powers of ten on a long one."""
    decades = np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    steps: tuple[float, ...] = (1.0, 2.0, 5.0) if high / low < 300.0 else (1.0,)
    ticks = [step * 10.0**decade for decade in decades for step in steps]
    if sum(low <= tick <= high for tick in ticks) < 3:
        steps = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0)
        ticks = [step * 10.0**decade for decade in decades for step in steps]
    if high / low < 1e5:
        target.set_major_locator(FixedLocator([tick for tick in ticks if low <= tick <= high]))
        target.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    target.set_minor_formatter(NullFormatter())


def colour_norm(values: np.ndarray, scale: str) -> Normalize:
    """Linear or logarithmic colours; 'auto' takes the latter over more than two decades."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    if scale == "logarithmic" or (scale == "auto" and low > 0.0 and high / low > 100.0):
        positive = finite[finite > 0.0]
        if positive.size:
            return LogNorm(float(positive.min()), max(high, float(positive.min()) * 1.0001))
    if high == low:
        return Normalize(low - 0.5 * (abs(low) or 1.0), high + 0.5 * (abs(high) or 1.0))
    return Normalize(low, high)


def headline(campaign: Campaign) -> str:
    """As in 'campaign map, 300 scenes'."""
    done = int(campaign.done.sum())
    count = f"{done:,}" if done == campaign.row_count else f"{done:,} of {campaign.row_count:,}"
    part = f", part {campaign.part} of {campaign.parts}" if campaign.parts > 1 else ""
    kind = {GRID: "", SAMPLE: ", sampled", TABLE: ", from a table"}[campaign.kind]
    scenes = "scene" if campaign.row_count == 1 else "scenes"
    return f"campaign {campaign.name}{part}, {count} {scenes}{kind}"


def frequency_ratio(campaign: Campaign) -> np.ndarray | None:
    """Natural over excitation frequency of every scene, None where one of them is unknown."""
    if "natural_frequency" not in campaign:
        return None
    if "load.frequency" in campaign:
        return campaign["natural_frequency"] / campaign["load.frequency"]
    excitation = campaign.input.get("load", {}).get("frequency")
    return campaign["natural_frequency"] / float(excitation) if excitation else None
