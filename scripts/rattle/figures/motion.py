"""Figures 6 to 10 of the paper: which of them a run gives, and what their files are called."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure

import rattle
from rattle import command, outputs
from rattle.figures import animation, histories, profiles, spectra, style
from rattle.result import Result

DESCRIPTION = (
    "Draw figures 6 to 10 of the paper. A piezo-viscous result gives figures 09 and 10b, an iso-viscous one "
    "06, 07, 08 and 10a, and so does one with a film that the paper has not; the scene's name stands behind "
    "the number. A result with the column coast_film also gives flanks_NAME: films and loads of both flanks "
    "and the acceleration over a cycle; one with NAME.profiles.rattle beside it profiles_NAME: pressure and "
    "film over the contact."
)

FLANKS = "flanks"
PROFILES = "profiles"
NUMBERS = (6, 7, 8, 9, 10, FLANKS, PROFILES)
OF_PIEZO_VISCOUS: dict[int | str, str] = {9: "figure_09", 10: "figure_10b", FLANKS: FLANKS}
OF_OTHERS: dict[int | str, str] = {
    6: "figure_06",
    7: "figure_07",
    8: "figure_08",
    10: "figure_10a",
    FLANKS: FLANKS,
    PROFILES: PROFILES,
}
OVERLAYS = {
    (6,): "figure_06_overlay",
    (7,): "figure_07_overlay",
    (8, 9): "figure_08_09_overlay",
    (10,): "figure_10_overlay",
}


@dataclass(frozen=True)
class Extent:
    """What is shown: `periods` of histories, `window` periods behind spectra, as in `view`."""

    periods: int
    window: int | None
    view: spectra.View = spectra.PLAIN


def add_options(parser: ArgumentParser) -> None:
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT", help="result file, NAME.rattle")
    parser.add_argument(
        "--figures",
        type=command.some_of(NUMBERS),
        default=NUMBERS,
        metavar="6,7,8,9,10,flanks,profiles",
        help="the figures to draw, all by default",
    )
    style.add_extent(parser, 4)
    parser.add_argument(
        "--frequency",
        choices=tuple(spectra.FREQUENCY_LABELS),
        help="what spectra are drawn over: multiples of the force's frequency (ratio), Hz, engine orders; by "
        "default engine orders where there is a &shaft, else multiples",
    )
    parser.add_argument(
        "--shaft-speed",
        type=command.positive_number,
        metavar="RPM",
        help="speed [1/min] that orders count (&shaft speed_rpm of the result)",
    )
    parser.add_argument(
        "--level",
        choices=("linear", "db"),
        default="db",
        help="the acceleration as levels in dB re 1e-6 m/s2 (default), or as amplitudes",
    )
    parser.add_argument("--overlay", action="store_true", help="draw all results in the same figures")
    parser.add_argument(
        "--animate",
        action="store_true",
        help="write moving pictures instead, motion_NAME.gif: the tooth between its flanks, a period in 10 s",
    )


def run(options: Namespace) -> None:
    results = [rattle.read(path) for path in options.results]
    for result in results:
        result.require_rows("motion")
        command.note_open(result)
    if options.animate:
        _animate(results, options)
        return
    if options.shaft_speed is not None and options.frequency != "order":
        raise command.CommandError("--shaft-speed belongs to --frequency order.")
    if options.frequency == "order" and options.shaft_speed is None:
        for result in results:
            spectra.engine_order(result, 1.0)
    view = spectra.View(options.frequency, options.shaft_speed, options.level == "db")
    extent = Extent(options.periods, options.window, view)
    make = overlay_figures if options.overlay else single_figures
    with style.house_style():
        drawn = list(make(results, options.figures, extent))
        if not drawn:
            laws = " and ".join(sorted({result.law for result in results}))
            numbers = ", ".join(map(str, options.figures))
            raise command.CommandError(f"Nothing to draw: {laws} results give no figure {numbers}.")
        print(*style.save(drawn, options), sep="\n")


def _animate(results: Sequence[Result], options: Namespace) -> None:
    if options.overlay:
        raise command.CommandError("Moving pictures show one motion each: leave out --overlay.")
    with style.house_style():
        files = [
            (
                options.output / f"motion_{style.file_part(label)}.gif",
                animation.moving_pictures(result, label),
            )
            for result, label in zip(results, style.run_labels(results), strict=True)
        ]
    print(*outputs.write(files, overwrite=options.overwrite, inputs=options.results), sep="\n")


def single_figures(
    results: Sequence[Result], numbers: Sequence[int | str], extent: Extent
) -> list[tuple[str, Figure]]:
    """File stem, which ends with the scene's name, and figure for each result, in the order given."""
    of_acceleration: list[Figure] = []
    drawn: list[tuple[str, Figure]] = []
    for result, label in zip(results, style.run_labels(results), strict=True):
        stems = OF_PIEZO_VISCOUS if result.law == "piezo-viscous" else OF_OTHERS
        for number, stem in stems.items():
            if number in numbers and _has(number, result):
                figure = _draw(number, [result], [label], extent)
                drawn.append((f"{stem}_{style.file_part(label)}", figure))
                if number == 10:
                    of_acceleration.append(figure)
    spectra.share_ranges(of_acceleration)
    return drawn


def _has(number: int | str, result: Result) -> bool:
    """Whether a result has what a figure shows."""
    if number == FLANKS:
        return histories.FLANK_FILMS[1] in result
    return number != PROFILES or bool(profiles.profiles_of(result))


def overlay_figures(
    results: Sequence[Result], numbers: Sequence[int | str], extent: Extent
) -> Iterator[tuple[str, Figure]]:
    """File stem and figure that shows all results at once."""
    most = len(style.RUN_COLOURS)
    if len(results) > most:
        raise command.CommandError(f"An overlay shows {most} runs at most; {len(results)} were given.")
    labels = style.run_labels(results)
    for covered, stem in OVERLAYS.items():
        if any(number in numbers for number in covered):
            yield stem, _draw(covered[0], results, labels, extent)


def _draw(number: int | str, results: Sequence[Result], labels: Sequence[str], extent: Extent) -> Figure:
    if number == FLANKS:
        return histories.draw_flanks(results[0], labels[0])
    if number == PROFILES:
        return profiles.draw(results[0], labels[0])
    if number == 6:
        return histories.draw_film_and_force(results, labels, extent.periods)
    if number == 7:
        return spectra.draw_force(results, labels, extent.window, extent.view)
    if number in (8, 9):
        return histories.draw_acceleration(results, labels, extent.periods)
    return spectra.draw_acceleration(results, labels, extent.window, extent.view)
