"""What runs are called in titles, legends and file names."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rattle.figures import style
from rattle.result import Result

FEW_SAMPLES = "too few samples"


def run_labels(results: Sequence[Result]) -> list[str]:
    """Scene names; runs of equal name are told apart by their directory, then by their order."""
    labels = [result.scene_name for result in results]
    labels = [
        f"{result.path.resolve().parent.name}/{label}" if repeated else label
        for result, label, repeated in zip(results, labels, _repeated(labels), strict=True)
    ]
    seen: Counter[str] = Counter()
    for position, (label, repeated) in enumerate(zip(labels, _repeated(labels), strict=True)):
        seen[label] += 1
        if repeated:
            labels[position] = f"{label} ({seen[label]})"
    return labels


def file_part(label: str) -> str:
    """A run label as a part of a file name."""
    return re.sub(r"[^A-Za-z0-9._-]+", "_", label).strip("_")


def film_words(result: Result) -> str:
    """The film law and model, as in 'published iso-viscous film'."""
    return f"{str(result.value('film', 'model')).strip()} {result.law} film"


def title(subject: str, result: Result, label: str) -> str:
    """One line that says what is drawn, of which scene, and with which film."""
    return f"{subject}\nScene {label}, {film_words(result)}"


def overlay_title(subject: str, results: Sequence[Result]) -> str:
    films = sorted({film_words(result) for result in results})
    return f"{subject}\n{len(results)} runs, {' and '.join(films)}"


def curve_label(result: Result, label: str) -> str:
    """A run label in the legend of several."""
    return f"{label}, {FEW_SAMPLES}" if result.coarse else label


def name_runs(
    figure: Figure,
    axes: Axes,
    subject: str,
    results: Sequence[Result],
    labels: Sequence[str],
    note: str = "",
) -> None:
    """Title the axes, with a note on a single run; several runs are told apart by a legend below."""
    if len(results) == 1:
        axes.set_title("\n".join(filter(None, (title(subject, results[0], labels[0]), note))))
    else:
        axes.set_title(overlay_title(subject, results))
        style.legend_below(figure, axes)


def _repeated(labels: Sequence[str]) -> list[bool]:
    counts = Counter(labels)
    return [counts[label] > 1 for label in labels]
