"""What a figure shows: its lines, bars and words as numbers and text."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex
from matplotlib.container import BarContainer
from matplotlib.figure import Figure
from matplotlib.text import Text


def curves(axes: Axes) -> list[tuple[np.ndarray, np.ndarray]]:
    """The lines drawn over data: x and y of each, rules and legend entries left out."""
    found = []
    for line in axes.lines:
        x, y = (np.ma.filled(np.ma.asarray(part, dtype=float), np.nan) for part in line.get_data())
        if line.get_transform() == axes.transData and x.size > 0:
            found.append((x, y))
    return found


def rules(axes: Axes, direction: str) -> list[float]:
    """Places of the straight lines across the whole picture: 'x' those that stand, 'y' those that lie."""
    across = {"x": axes.get_xaxis_transform(), "y": axes.get_yaxis_transform()}[direction]
    pick = 0 if direction == "x" else 1
    return [float(line.get_data()[pick][0]) for line in axes.lines if line.get_transform() == across]


def bars(axes: Axes) -> list[tuple[np.ndarray, np.ndarray]]:
    """Places and heights of each set of spectral lines; all of them must stand on zero."""
    found = []
    for lines in axes.collections:
        if isinstance(lines, LineCollection):
            segments = np.array(lines.get_segments()).reshape(-1, 2, 2)
            assert (segments[:, 0, 1] == 0.0).all()
            assert (segments[:, 0, 0] == segments[:, 1, 0]).all()
            found.append((segments[:, 1, 0], segments[:, 1, 1]))
    return found


def lying_bars(axes: Axes) -> dict[str, float]:
    """Horizontal bars: the word at the axis, and how long each is."""
    words = dict(zip(axes.get_yticks(), (text.get_text() for text in axes.get_yticklabels()), strict=True))
    container = next(one for one in axes.containers if isinstance(one, BarContainer))
    return {words[round(bar.get_y() + bar.get_height() / 2.0)]: bar.get_width() for bar in container.patches}


def colours(axes: Axes) -> list[str]:
    """The colour of each of the `curves`."""
    return [
        to_hex(line.get_color())
        for line in axes.lines
        if line.get_transform() == axes.transData and len(line.get_xdata()) > 0
    ]


def legend_words(figure: Figure) -> list[str]:
    """All words in legends, those of the figure first."""
    legends = [*figure.legends, *(axes.get_legend() for axes in figure.axes if axes.get_legend())]
    return [text.get_text() for legend in legends for text in legend.get_texts()]


def all_words(figure: Figure) -> str:
    """Every text of the figure, a line each."""
    return "\n".join(text.get_text() for text in figure.findobj(Text))


def labels(axes: Axes) -> tuple[str, str]:
    """Labels of the x and the y axis."""
    return axes.get_xlabel(), axes.get_ylabel()
