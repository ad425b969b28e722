"""Which varied keys matter, as bars: shares of the variance of a quantity, and the direction of each."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rattle.campaign_result import Campaign
from rattle.campaign_section import short_name
from rattle.figures import style
from rattle.figures.campaign_look import capital
from rattle.sensitivity import Direction, Indices, Study

BAR, PANEL, MARGIN = 0.34, 0.62, 1.0
TITLE_LETTERS = 50  # that stand side by side above the panels
SIGNS = {True: style.RUN_COLOURS[4], False: style.RUN_COLOURS[0]}
KINDS = (("alone", "first", style.RUN_COLOURS[0]), ("with all others", "total", style.RUN_COLOURS[4]))


def draw(campaign: Campaign, studies: Sequence[Study]) -> Figure:
    """A row of panels for each pair, a panel for each quantity, a pair of bars for each key."""
    figure, panels = _panels(studies, [study.found for study in studies], _bars, BAR)
    panels[0, 0].set_xlim(*_limits(studies))
    panels[-1, 0].set_xticks([0.0, 0.5, 1.0])
    panels[-1, panels.shape[1] // 2].set_xlabel("Share of the variance [-]")
    style.legend_below(figure, panels[0, 0], 2)
    figure.suptitle(f"{campaign.name}: share of the variance that each key explains", fontsize=9.5)
    return figure


def _limits(studies: Sequence[Study]) -> tuple[float, float]:
    """From 0 to 1, or as far as estimates and their intervals go."""
    ends = [0.0, 1.07]
    for found in (one for study in studies for one in study.found):
        for _, name, _ in KINDS:
            values, errors = getattr(found, name), getattr(found, f"{name}_error")
            ends += [np.nanmin(values - errors), np.nanmax(values + errors)]
    return min(ends) - 0.03, max(ends) + 0.03


def draw_directions(campaign: Campaign, studies: Sequence[Study]) -> Figure:
    """A row of panels for each pair, a panel for each quantity, a signed bar for each key."""
    figure, panels = _panels(studies, [study.directions for study in studies], _signed_bars, 0.7 * BAR)
    panels[0, 0].set_xlim(-1.1, 1.1)
    panels[-1, 0].set_xticks([-1.0, 0.0, 1.0])
    figure.supxlabel("Rank correlation with the key [-]: right, it grows with it", fontsize=9)
    figure.suptitle(f"{campaign.name}: direction of each effect", fontsize=9.5)
    return figure


def _panels(
    studies: Sequence[Study],
    found: Sequence[Sequence[Any]],
    draw_bars: Callable[[Axes, Any], None],
    bar: float,
) -> tuple[Figure, np.ndarray]:
    """The panels with what was found of each pair, a row of `bar` inches for each key."""
    names = list(dict.fromkeys(one.quantity for several in found for one in several))
    keys = studies[0].keys
    figure = Figure(figsize=(style.WIDTH, MARGIN + len(studies) * (PANEL + bar * len(keys))))
    panels = figure.subplots(len(studies), max(len(names), 1), squeeze=False, sharex=True, sharey=True)
    for row, study, several in zip(panels, studies, found, strict=True):
        by_name = {one.quantity: one for one in several}
        for axes, name in zip(row, names, strict=True):
            if name in by_name:
                draw_bars(axes, by_name[name])
            else:
                axes.text(
                    0.5, 0.5, "the same\nat all points", ha="center", va="center", transform=axes.transAxes
                )
            if study is studies[0]:
                axes.set_title(capital(textwrap.fill(short_name(name), TITLE_LETTERS // len(names))))
        row[0].set_yticks(range(len(keys)), [short_name(key) for key in keys])
        row[0].set_ylim(len(keys) - 0.5, -0.5)
        row[0].set_ylabel(_label(study))
    return figure, panels


def _signed_bars(axes: Axes, found: Direction) -> None:
    """Bars within the grey band are as long as chance makes them."""
    axes.axvspan(-found.by_chance, found.by_chance, color="#DDDDDD", linewidth=0.0)
    axes.axvline(0.0, color="black", linewidth=0.6)
    colours = [SIGNS[value > 0.0] for value in found.correlation]
    axes.barh(range(len(found.correlation)), found.correlation, 0.6, color=colours)


def _label(study: Study) -> str:
    words = f"{study.pair}\n" if study.pair else ""
    return words if study.probability is None else f"{words}impacts: {study.probability[0]:.0%}"


def _bars(axes: Axes, found: Indices) -> None:
    """Estimates scatter below 0 and above 1."""
    axes.axvline(0.0, color="black", linewidth=0.6)
    places = np.arange(len(found.first))
    for offset, (label, name, colour) in zip((-0.2, 0.2), KINDS, strict=True):
        values, errors = getattr(found, name), getattr(found, f"{name}_error")
        axes.barh(places + offset, values, 0.36, xerr=errors, color=colour, label=label, error_kw={"lw": 0.8})
