"""One page on a campaign: its classes, where verifications fail, how scenes ended, the worst scenes."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from rattle import table
from rattle.campaign_plan import GRID
from rattle.campaign_result import Campaign
from rattle.campaign_section import new_section, spaced_unit
from rattle.codes import CLASSES, SUCCESSES, spoken, word
from rattle.counts import counted
from rattle.figures import campaign_look as look
from rattle.figures import campaign_map, style
from rattle.rerun import scene_label

PAGE = (8.27, 11.69)  # A4
BAR_COLOUR = "#0072B2"
FAILED_COLOUR = "#D55E00"
MOST_KEYS_IN_TABLE = 4


@dataclass(frozen=True)
class Worst:
    """The worst scenes: their rows, and the column that says so."""

    rows: Sequence[int]
    column: str
    smallest: bool


def draw(campaign: Campaign, worst: Worst) -> Figure:
    """The page."""
    figure = Figure(figsize=PAGE, layout="none")  # fixed places: long words move nothing
    left, right = 0.11, 0.95
    head = figure.add_axes((left, 0.875, right - left, 0.09))
    maps = figure.add_gridspec(1, 2, left=left, right=right, bottom=0.55, top=0.805, wspace=0.32)
    bars = figure.add_gridspec(1, 2, left=left + 0.03, right=right, bottom=0.26, top=0.405, wspace=0.42)
    scenes = figure.add_axes((0.06, 0.03, right - 0.06, 0.175))
    _draw_head(head, campaign)
    _draw_classes_map(figure.add_subplot(maps[0]), campaign)
    _draw_verifications(figure, figure.add_subplot(maps[1]), campaign)
    _draw_class_shares(figure.add_subplot(bars[0]), campaign)
    _draw_statuses(figure.add_subplot(bars[1]), campaign)
    _draw_worst(scenes, campaign, worst)
    return figure


def _draw_head(axes: Axes, campaign: Campaign) -> None:
    axes.axis("off")
    axes.text(
        0.0, 1.0, look.capital(look.headline(campaign)), fontsize=13, va="top", transform=axes.transAxes
    )
    keys = []
    for axis in campaign.axes:
        if axis.values.size:
            count = f", {counted(axis.values.size, 'value')}" if campaign.kind == GRID else ""
            span = f"{axis.values[0]:.4g} to {axis.values[-1]:.4g}{spaced_unit(look.drawn_unit(axis.unit))}"
            keys.append(f"{look.short_name(axis.key)}: {span} ({axis.scale}{count})")
    keys.append(f"{look.capital(style.film_words(campaign))};  rattle {campaign.program_version}")
    if campaign.has_gear:
        keys.append(f"Acceleration {style.RELATIVE}")
    axes.text(0.0, 0.62, "\n".join(keys), fontsize=8, va="top", transform=axes.transAxes, linespacing=1.4)


def _draw_classes_map(axes: Axes, campaign: Campaign) -> None:
    axes.set_title("Rattle class")
    if "rattle_class" not in campaign:
        _say(axes, "rattle_class is not recorded")
        return
    handles: list = []
    if len(campaign.varied) < 2:
        _draw_single_key(axes, campaign, "rattle_class")
    elif campaign.kind == GRID:
        section = new_section(campaign, campaign.varied[:2], {})
        handles, _ = campaign_map.draw_cells(axes, section, "rattle_class")
        handles += campaign_map.draw_contours(axes, section, campaign_map.CONTOURS)
        if section.held:
            axes.set_title("Rattle class at\n" + textwrap.fill(section.words, 48), fontsize=8)
    else:
        first, second = campaign.varied[:2]
        handles, _ = campaign_map.scatter(axes, campaign, first, second, "rattle_class")
    if handles:
        _legend_below(axes, handles)


def _legend_below(axes: Axes, handles: list) -> None:
    axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(-0.04, -0.16), ncols=2, fontsize=7)


def _draw_verifications(figure: Figure, axes: Axes, campaign: Campaign) -> None:
    """Where the class is not verified; over further keys of a grid, how often."""
    axes.set_title("Where the verification fails")
    if "verified" not in campaign:
        _say(axes, "verified is not recorded")
        return
    verified = campaign["verified"]
    lacking = campaign.done & (verified == 0.0)
    judged = int((campaign.done & np.isfinite(verified)).sum())
    if not lacking.any():
        _say(axes, f"every class of {judged:,} scenes is numerically verified")
        return
    axes.set_title(f"Verification fails in {look.share(int(lacking.sum()), judged)} of {judged:,} scenes")
    if len(campaign.varied) < 2:
        _draw_single_key(axes, campaign, "verified")
    elif campaign.kind != GRID:
        x, y = campaign.varied[:2]
        axes.scatter(campaign[x][campaign.done], campaign[y][campaign.done], s=2, color=style.PERIOD_COLOUR)
        axes.scatter(campaign[x][lacking], campaign[y][lacking], s=8, color=FAILED_COLOUR)
        for which, key in (("x", x), ("y", y)):
            look.set_axis(axes, which, campaign.axis(key), to_edges=False)
    else:
        _draw_unverified_share(figure, axes, campaign)


def _draw_unverified_share(figure: Figure, axes: Axes, campaign: Campaign) -> None:
    grid = campaign.grid("verified")
    known = np.isfinite(grid)
    others = tuple(range(2, grid.ndim))
    count = known.sum(axis=others)
    lacking = (known & (grid == 0.0)).sum(axis=others)
    shares = np.where(count > 0, lacking / np.maximum(count, 1), np.nan)
    edges = [look.cell_edges(axis) for axis in campaign.axes[:2]]
    axes.set_facecolor("white")
    if others:
        drawn = axes.pcolormesh(*edges, shares.T, cmap="YlOrBr", vmin=0.0, vmax=1.0, rasterized=True)
        bar = figure.colorbar(drawn, cax=axes.inset_axes((0.0, -0.27, 1.0, 0.04)), orientation="horizontal")
        bar.set_label("share without verification over the other keys")
        bar.ax.xaxis.set_major_formatter(PercentFormatter(1.0))
    else:
        section = new_section(campaign, campaign.varied[:2], {})
        handles, _ = campaign_map.draw_cells(axes, section, "verified")
        for handle in handles:
            first = handle.get_label().partition(" (")[0]
            handle.set_label({"no": "verification fails", "yes": "verification holds"}.get(first, first))
        _legend_below(axes, handles)
    for which, axis in zip("xy", campaign.axes[:2], strict=True):
        look.set_axis(axes, which, axis, to_edges=True)


def _draw_single_key(axes: Axes, campaign: Campaign, column: str) -> None:
    """Codes over the one varied key."""
    key = campaign.varied[0]
    palette = look.code_colours(column) or {}
    for code, colour in palette.items():
        rows = campaign.done & (campaign[column] == code)
        axes.scatter(
            campaign[key][rows], np.full(rows.sum(), code), s=14, color=colour, edgecolors="black", lw=0.3
        )
    axes.set_yticks(list(palette), [spoken(word(column, code)) for code in palette])
    axes.set_ylim(min(palette) - 0.5, max(palette) + 0.5)
    look.set_axis(axes, "x", campaign.axis(key), to_edges=False)


def _draw_class_shares(axes: Axes, campaign: Campaign) -> None:
    axes.set_title("Share of classes")
    if "rattle_class" not in campaign:
        _say(axes, "rattle_class is not recorded")
        return
    classes = campaign["rattle_class"][campaign.done]
    counts = [int((classes == code).sum()) for code in CLASSES]
    names, colours = list(map(spoken, CLASSES.values())), [look.CLASS_COLOURS[code] for code in CLASSES]
    lacking = int(np.isnan(classes).sum())
    if lacking:
        names, counts, colours = [*names, "no class"], [*counts, lacking], [*colours, look.GAP_COLOUR]
    _bars(axes, names, counts, colours)


def _draw_statuses(axes: Axes, campaign: Campaign) -> None:
    failures = int(campaign.failed.sum())
    failed = look.share(failures, int(campaign.done.sum())) if failures else "none"
    axes.set_title(f"How scenes ended: {failed} failed")
    if "status" not in campaign:
        _say(axes, "status is not recorded")
        return
    codes, found = np.unique(campaign["status"][campaign.done], return_counts=True)
    names = [spoken(word("status", code)) for code in codes]
    colours = [BAR_COLOUR if code in SUCCESSES else FAILED_COLOUR for code in codes]
    left = campaign.row_count - int(campaign.done.sum())
    counts = found.tolist()
    if left:
        names, counts, colours = [*names, "not done"], [*counts, left], [*colours, look.GAP_COLOUR]
    _bars(axes, names, counts, colours)


def _bars(axes: Axes, names: Sequence[str], counts: Sequence[int], colours: Sequence[str]) -> None:
    """Horizontal bars with count and share at their ends."""
    places = np.arange(len(names))[::-1]
    whole = sum(counts)
    axes.barh(places, counts, height=0.65, color=colours, edgecolor=look.HATCH_COLOUR, linewidth=0.5)
    for place, count in zip(places, counts, strict=True):
        axes.text(
            count + 0.015 * max(counts),
            place,
            f"{count:,}  ({look.share(count, whole)})",
            va="center",
            size=7.5,
        )
    axes.set_yticks(places, names)
    axes.set_ylim(min(-0.7, len(names) - 4.7), len(names) - 0.3)
    axes.set_xlim(0.0, 1.35 * max(*counts, 1))
    axes.tick_params(axis="y", length=0)
    axes.set_xticks([])
    axes.spines["bottom"].set_visible(False)


def _draw_worst(axes: Axes, campaign: Campaign, worst: Worst) -> None:
    axes.axis("off")
    which = "smallest" if worst.smallest else "largest"
    axes.set_title(
        f"Worst scenes, {which} {look.short_name(worst.column)}; inputs with series: {campaign.name}_scenes/"
    )
    if len(worst.rows) == 0:
        _say(axes, "no scene has a value")
        return
    factor, unit = look.column_scale(campaign, worst.column)
    keys = campaign.varied[:MOST_KEYS_IN_TABLE]
    head = ["input", *(_head(look.short_name(key), campaign.units[key]) for key in keys)]
    head.append(_head(look.short_name(worst.column), unit))
    extra = [name for name in ("rattle_class", "film_regime", "verified") if name in campaign]
    head += [name.replace("_", " ") for name in extra]
    lines = [head]
    for row in worst.rows:
        line = [scene_label(campaign, row) + ".nml", *(f"{campaign[key][row]:.4g}" for key in keys)]
        line.append(f"{factor * campaign[worst.column][row]:.4g}")
        lines.append([*line, *(spoken(word(name, campaign[name][row])) for name in extra)])
    text = table.plain(lines)
    width = max(map(len, text.splitlines()))
    size = min(7.0, 7.0 * 122 / width)
    axes.text(0.0, 1.0, text, family="DejaVu Sans Mono", fontsize=size, va="top", transform=axes.transAxes)


def _head(words: str, unit: str) -> str:
    return words if unit in ("", "-") else f"{words} [{unit}]"


def _say(axes: Axes, words: str) -> None:
    axes.axis("off")
    axes.text(0.5, 0.5, words, ha="center", va="center", transform=axes.transAxes, color=style.FORCE_COLOUR)
