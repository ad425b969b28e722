"""Film force of each gear pair as bars, the largest first, with what all load the bearings with together."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rattle.codes import CODES
from rattle.figures import style
from rattle.figures.campaign_look import VERDICT_COLOURS

BAR, MARGIN = 0.3, 1.25  # inches
TOGETHER = "#BBBBBB"
TICK = {"color": "black", "marker": "|", "markersize": 16, "markeredgewidth": 2.0, "linestyle": ""}


def draw(
    forces: Mapping[str, float],
    verdicts: Mapping[str, str],
    together: Mapping[str, float],
    limits: Mapping[str, float],
    levels: Mapping[str, str],
) -> Figure:
    """Forces [N rms] and verdicts by pair, sums by their words, limits [N rms] and levels by pair."""
    ranked = sorted(forces, key=lambda gear: -forces[gear])
    colours = {word: VERDICT_COLOURS[code] for code, word in CODES["verdict"].items()}
    bars = [(gear, forces[gear], colours.get(verdicts.get(gear, ""), TOGETHER)) for gear in ranked]
    bars += [(words, size, TOGETHER) for words, size in together.items()]
    figure = Figure(figsize=(style.WIDTH, MARGIN + BAR * len(bars)))
    axes = figure.subplots()
    most = max([size for _, size, _ in bars] + list(limits.values()), default=1.0)
    for place, (name, size, colour) in enumerate(bars):
        axes.barh(place, size, 0.7, color=colour, edgecolor=style.FORCE_COLOUR, linewidth=0.5)
        words = f"{size:.3g} N" + (f", {levels[name]}" if name in levels else "")
        axes.text(size + 0.01 * most, place, words, va="center", fontsize=8)
        if name in limits:
            axes.plot(limits[name], place, **TICK)
    axes.set_yticks(range(len(bars)), [name for name, _, _ in bars])
    axes.set_ylim(len(bars) - 0.5, -0.5)
    axes.set_xlim(0.0, (1.35 if levels else 1.12) * most or 1.0)
    axes.set_xlabel("Film force on the bearings [N rms]")
    axes.set_title("How hard each pair loads the bearings")
    shown = [word for word in colours if word in {verdicts.get(gear) for gear in ranked}]
    handles: dict[str, object] = {
        word: Patch(facecolor=colours[word], edgecolor=style.FORCE_COLOUR, linewidth=0.5) for word in shown
    }
    if set(limits).intersection(ranked):
        handles["limit"] = Line2D([], [], **TICK | {"markersize": 9})
    if handles:
        style.legend_below(figure, axes, labels=handles)
    return figure
