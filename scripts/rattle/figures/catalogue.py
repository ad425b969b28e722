"""Which figures of the paper a run gives, and what their files are called."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure

from rattle.command import CommandError
from rattle.figures import acceleration, acceleration_spectrum, film_and_force, force_spectrum
from rattle.figures.labels import file_part, run_labels
from rattle.figures.style import RUN_COLOURS
from rattle.result import Result, ResultError

NUMBERS = (6, 7, 8, 9, 10)
FIGURES_OF_LAW = {
    "iso-viscous": {6: "figure_06", 7: "figure_07", 8: "figure_08", 10: "figure_10a"},
    "piezo-viscous": {9: "figure_09", 10: "figure_10b"},
}
OVERLAYS = {
    (6,): "figure_06_overlay",
    (7,): "figure_07_overlay",
    (8, 9): "figure_08_09_overlay",
    (10,): "figure_10_overlay",
}


@dataclass(frozen=True)
class Extent:
    """How much of a run is shown: `periods` of its histories, `window` periods behind its spectra."""

    periods: int
    window: int | None


def single_figures(
    results: Sequence[Result], numbers: Sequence[int], extent: Extent
) -> Iterator[tuple[str, Figure]]:
    """File stem, which ends with the scene's name, and figure for each result, in the order given."""
    for result, label in zip(results, run_labels(results), strict=True):
        if result.law not in FIGURES_OF_LAW:
            raise ResultError(
                f"{result.path} has the film law '{result.law}', which no figure of 6 to 10 shows."
            )
        for number, stem in FIGURES_OF_LAW[result.law].items():
            if number in numbers:
                yield f"{stem}_{file_part(label)}", _draw(number, [result], [label], extent)


def overlay_figures(
    results: Sequence[Result], numbers: Sequence[int], extent: Extent
) -> Iterator[tuple[str, Figure]]:
    """File stem and figure that shows all results at once."""
    most = len(RUN_COLOURS)
    if len(results) > most:
        raise CommandError(f"An overlay shows {most} runs at most; {len(results)} were given.")
    labels = run_labels(results)
    for covered, stem in OVERLAYS.items():
        if any(number in numbers for number in covered):
            yield stem, _draw(covered[0], results, labels, extent)


def _draw(number: int, results: Sequence[Result], labels: Sequence[str], extent: Extent) -> Figure:
    if number == 6:
        return film_and_force.draw(results, labels, extent.periods)
    if number == 7:
        return force_spectrum.draw(results, labels, extent.window)
    if number in (8, 9):
        return acceleration.draw(results, labels, extent.periods)
    return acceleration_spectrum.draw(results, labels, extent.window)
