"""Slices of a campaign: columns along one varied key, over the bands of the classes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rattle.campaign_section import Section
from rattle.codes import CLASSES, spoken, words_of
from rattle.figures import campaign_look as look
from rattle.figures import style

MOST_MARKERS = 80
LIGHTENED = 0.35


def draw(section: Section, columns: Sequence[str]) -> Figure:
    """A panel for each column along the one free key."""
    campaign = section.campaign
    axis = section.free[0]
    figure = Figure(figsize=(style.WIDTH, 1.3 + 1.55 * len(columns)))
    panels = figure.subplots(len(columns), 1, sharex=True, squeeze=False)[:, 0]
    handles: dict[str, Patch | Line2D] = {}
    for panel, column in zip(panels, columns, strict=True):
        _draw_bands(panel, section, handles)
        _draw_column(panel, section, column)
        panel.set_ylabel(look.column_label(campaign, column).replace(" [", "\n["))
    look.set_axis(panels[0], "x", axis, to_edges=True)
    for panel in panels:
        measured = look.draw_measured_speeds(panel, campaign, {"x": axis.key})
        handles |= {line.get_label(): line for line in measured}
    for panel in panels[:-1]:
        panel.set_xlabel("")
    panels[-1].set_xlabel(look.axis_label(axis))
    figure.align_ylabels()
    if handles:
        figure.legend(handles=list(handles.values()), loc="outside lower center", ncols=4)
    held = f", {section.words}" if section.held else ""
    panels[0].set_title(f"Along {look.short_name(axis.key)}: {campaign.name}{held}")
    return figure


def _draw_column(panel: Axes, section: Section, column: str) -> None:
    factor, _ = look.column_scale(section.campaign, column)
    x, y = section.free[0].values, factor * section.values(column)
    marker = "o" if x.size <= MOST_MARKERS else None
    words = words_of(column)
    line = {"color": style.RUN_COLOURS[0], "marker": marker, "markersize": 2.5, "linewidth": 1.2}
    if words is not None:
        # Codes have no order: nothing lies between two of them.
        panel.plot(x, y, **line | {"linestyle": "", "marker": "o"})
        codes = sorted(words)
        panel.set_yticks(codes, [spoken(words[code]) for code in codes])
        panel.set_ylim(codes[0] - 0.4, codes[-1] + 0.4)
        return
    panel.plot(x, y, **line)
    finite = y[np.isfinite(y)]
    if finite.size and finite.min() > 0.0 and finite.max() > 100.0 * finite.min():
        panel.set_yscale("log")


def _draw_bands(panel: Axes, section: Section, handles: dict[str, Patch]) -> None:
    """The class of each scene as a band behind the line; gaps and what is not verified are hatched."""
    campaign = section.campaign
    edges = look.cell_edges(section.free[0])
    if "rattle_class" in campaign:
        classes = section.values("rattle_class")
        for code, words in CLASSES.items():
            colour = look.CLASS_COLOURS[code]
            for first, last in _runs(classes == code):
                panel.axvspan(edges[first], edges[last], color=colour, alpha=LIGHTENED, linewidth=0, zorder=0)
                handles[spoken(words)] = Patch(facecolor=colour, alpha=LIGHTENED, label=spoken(words))
    column = "rattle_class" if "rattle_class" in campaign else "scene"
    gaps = [(gap.words, gap.hatch, section.mask(gap.scenes)) for gap in look.gaps(campaign, column)]
    gaps.append(("not done", look.NOT_DONE_HATCH, ~section.mask(campaign.done)))
    for words, hatch, where in gaps:
        for first, last in _runs(where):
            panel.axvspan(
                edges[first],
                edges[last],
                facecolor=look.GAP_COLOUR,
                edgecolor=look.HATCH_COLOUR,
                hatch=hatch,
                linewidth=0.0,
                zorder=0,
            )
            handles.setdefault(words, look.gap_patch(words, hatch))
    for doubt in look.doubts(campaign, "rattle_class"):
        for first, last in _runs(section.mask(doubt.scenes)):
            area = {"facecolor": "none", "edgecolor": "black", "alpha": LIGHTENED, "linewidth": 0.0}
            panel.axvspan(edges[first], edges[last], hatch=doubt.hatch, zorder=0, **area)
            handles[doubt.words] = look.doubt_patch(doubt.words, doubt)


def _runs(where: np.ndarray) -> list[tuple[int, int]]:
    """First and behind-last index of every run of True."""
    padded = np.concatenate([[False], where, [False]]).astype(int)
    steps = np.diff(padded)
    return list(zip(np.flatnonzero(steps == 1), np.flatnonzero(steps == -1), strict=True))
