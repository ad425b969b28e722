"""Figures of variants side by side: film forces of motions, maps with one scale and their difference."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rattle.campaign_plan import GRID
from rattle.campaign_result import Campaign
from rattle.campaign_section import Section, new_section
from rattle.command import CommandError
from rattle.comparison.difference import AMPLITUDES
from rattle.figures import campaign_look as look
from rattle.figures import style

DIFFERENCE_COLOURS = "PuOr_r"  # white where nothing differs; distinguished in red-green blindness
OTHER_WORD = "#333333"
LEAST_SPAN = 1.0  # dB
TALLEST = 9.0  # inches


def draw_forces(forces: Mapping[str, Mapping[str, float]], words: Mapping[tuple[str, str], str]) -> Figure:
    """Bars of the film force rms [N] by variant and gear; `words` stand at the bar of a variant and gear."""
    gears = list(dict.fromkeys(gear for of_variant in forces.values() for gear in of_variant))
    height = 0.8 / len(forces)
    figure = Figure(figsize=(style.WIDTH, min(TALLEST, 1.1 + 0.2 * len(gears) * (len(forces) + 1))))
    axes = figure.subplots()
    for place, (name, of_variant) in enumerate(forces.items()):
        rows = [row for row, gear in enumerate(gears) if gear in of_variant]
        bars = axes.barh(
            [row + (place - 0.5 * (len(forces) - 1)) * height for row in rows],
            [of_variant[gears[row]] for row in rows],
            height=0.9 * height,
            color=style.RUN_COLOURS[place % len(style.RUN_COLOURS)],
            label=name,
        )
        axes.bar_label(bars, [words.get((name, gears[row]), "") for row in rows], padding=3, fontsize=7)
    axes.set_yticks(range(len(gears)), gears)
    axes.invert_yaxis()
    axes.margins(x=0.15)
    axes.set_xlabel("Film force on the bearings [N rms]")
    style.legend_below(figure, axes)
    return figure


def draw_maps(base: Campaign, other: Campaign, column: str) -> Figure:
    """A column of both over their first two varied keys, in one scale, and what differs; a row for each pair.

    The third map shows by how much numbers differ, those of forces and the like in dB, and where words do.
    Raises CommandError where the two have no map at the same points.
    """
    sections = _sections(base), _sections(other)
    rows = list(zip(*sections, strict=False))
    if len({*map(len, sections)}) > 1 or not all(_alike(one, two) for one, two in rows):
        raise CommandError(
            "The variants were solved at other points, so there is no map of their difference."
        )
    values = [(one.values(column), two.values(column)) for one, two in rows]
    palette, decibels = look.code_colours(column), base.units[column] in AMPLITUDES
    changes = [_change(*pair, palette is not None, decibels) for pair in values]
    widest = max(np.nanmax(np.abs(change), initial=0.0) for change in changes)
    widest = max(widest, LEAST_SPAN) if decibels else widest or 1.0
    figure = Figure(figsize=(style.WIDTH, min(TALLEST, 1.3 + 1.5 * len(rows))))
    grid = figure.subplots(len(rows), 3, sharex=True, sharey=True, squeeze=False)
    every = np.concatenate([part.ravel() for pair in values for part in pair])
    looks = {"cmap": look.COLOUR_MAP, "norm": look.colour_norm(every, "auto")}
    of_change = {"cmap": DIFFERENCE_COLOURS, "norm": Normalize(-widest, widest)}
    if palette is not None:
        codes = range(max(palette) + 1)
        looks["cmap"] = ListedColormap([palette.get(code, look.GAP_COLOUR) for code in codes])
        looks["norm"] = BoundaryNorm([code - 0.5 for code in range(max(palette) + 2)], len(codes))
        of_change = {"cmap": ListedColormap([look.GAP_COLOUR, OTHER_WORD]), "norm": Normalize(0.0, 1.0)}
    for axes, (one, _), pair, change in zip(grid, rows, values, changes, strict=True):
        edges = [look.cell_edges(axis) for axis in one.free]
        for panel, part in zip(axes[:2], pair, strict=True):
            drawn = panel.pcolormesh(*edges, part.T, **looks, rasterized=True)
        shown = axes[2].pcolormesh(*edges, change.T, **of_change, rasterized=True)
        for which, axis in zip("xy", one.free, strict=True):
            look.set_axis(axes[0], which, axis, to_edges=True)
            getattr(axes[0], f"set_{which}label")("")
        axes[0].set_ylabel(one.campaign.name.removeprefix(f"{base.name}.") if len(rows) > 1 else "")
    for panel, words in zip(grid[0], ("base", "variant", "difference"), strict=True):
        panel.set_title(words)
    grid[-1][1].set_xlabel(look.axis_label(rows[0][0].free[0]))
    figure.supylabel(look.axis_label(rows[0][0].free[1]), fontsize="medium")
    if palette is not None:
        _legend(figure, column, np.unique(every[np.isfinite(every)]), palette)
        return figure
    unit = "dB" if decibels else look.drawn_unit(base.units[column])
    label = look.column_label(base, column).replace("\n", ", ")
    figure.colorbar(drawn, ax=list(grid[:, :2].ravel()), label=label, location="top", aspect=40, pad=0.02)
    words = f"Change [{unit}]"
    figure.colorbar(shown, ax=list(grid[:, 2]), label=words, location="top", aspect=20, pad=0.02)
    return figure


def _sections(campaign: Campaign) -> list[Section]:
    """The cut of each pair with its first two varied keys free."""
    if campaign.kind != GRID or len(campaign.pairs[0].varied) < 2:
        raise CommandError("Only campaigns on a grid of two keys or more have maps.")
    return [new_section(pair, pair.varied[:2], {}) for pair in campaign.pairs]


def _alike(one: Section, other: Section) -> bool:
    axes = ([*section.free, *(held.axis for held in section.held)] for section in (one, other))
    return all(
        a.key == b.key and a.values.shape == b.values.shape and np.allclose(a.values, b.values, rtol=1e-9)
        for a, b in zip(*axes, strict=True)
    )


def _change(one: np.ndarray, other: np.ndarray, of_words: bool, decibels: bool) -> np.ndarray:
    """By how much the variant differs; of words 1 where they do. Not a number where one is unknown."""
    known = np.isfinite(one) & np.isfinite(other)
    if of_words:
        return np.where(known, (one != other).astype(float), np.nan)
    if not decibels:
        return np.where(known, other - one, np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(known & (one * other > 0.0), 20.0 * np.log10(other / one), np.nan)


def _legend(figure: Figure, column: str, codes: np.ndarray, palette: Mapping[int, str]) -> None:
    handles = [
        Patch(
            facecolor=palette.get(int(code), look.GAP_COLOUR),
            edgecolor=look.HATCH_COLOUR,
            linewidth=0.5,
            label=look.words_in_legends(column, int(code)),
        )
        for code in codes
    ]
    handles.append(Patch(facecolor=OTHER_WORD, label="differs"))
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
