"""Every text of a figure, and what figures of one kind have in common to say."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend import Legend


def relative(label: str) -> str:
    """The label of an acceleration that is relative to the shaft."""
    words = label.replace(r"Acceleration $\ddot{z}$", "Relative acceleration")
    return words.replace("of $", "of relative $").replace("of the acc", "of the relative acc")


def words_of(figure: Figure) -> list[str]:
    """Every text of a figure that is not a number at a tick, in the order of the alphabet."""
    axes = [*figure.axes, *(child for one in figure.axes for child in one.child_axes)]
    found = [text for one in axes for text in texts_of(one)]
    legends = {*figure.legends, *(child for one in axes for child in one.get_children())}
    for legend in (one for one in legends if isinstance(one, Legend)):
        found += [legend.get_title().get_text(), *(text.get_text() for text in legend.get_texts())]
    # A title above all panels is one of these.
    found += [text.get_text() for text in figure.texts]
    return sorted(text for text in found if text)


def texts_of(axes: Axes) -> list[str]:
    titles = [axes.get_title(loc=place) for place in ("left", "center", "right")]
    return [*titles, axes.get_xlabel(), axes.get_ylabel(), *(text.get_text() for text in axes.texts)]


def assert_says(figure: Figure, expected: Sequence[str | None]) -> None:
    """The figure has these texts, and no others."""
    found = words_of(figure)
    wanted = sorted(text for text in expected if text)
    assert found == wanted, (set(found) ^ set(wanted), found)


def film_of(given: Mapping[str, Any]) -> str:
    if given["film"]["law"] == "elastohydrodynamic":
        return f"elastohydrodynamic film ({given['film']['model']})"
    model = {"reynolds": "Reynolds", "published": "published"}[given["film"]["model"]]
    return f"{model} {given['film']['law']} film"


def power(value: float, symbol: str = "") -> str:
    """A number with its power of ten, four digits at most."""
    exponent = math.floor(math.log10(abs(value)) + 1e-12)
    mantissa = round(value / 10.0**exponent, 3)
    return f"${symbol + ' = ' if symbol else ''}{mantissa:g} \\times 10^{{{exponent}}}$"
