"""What a loose tolerance eps of eq (36) does to the same motion."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

import rattle
from rattle import command
from rattle.codes import spoken
from rattle.figures import style
from rattle.figures.fit import is_narrow
from rattle.figures.histories import last_periods, period_rules, time_label
from rattle.figures.spectra import column_spectrum
from rattle.result import Result, ResultError
from rattle.verdict import judge_samples

DESCRIPTION = (
    "Compare the same motion at a loose and a tight tolerance: histories and spectra of the acceleration, "
    "as 'tolerance'."
)
CASES = (("false_harmonic", "A false harmonic", 6.0), ("false_reversals", "False reversals", 32.0))
FREE_GROUPS = ("scene", "solver", "spectrum", "output")  # all that two runs of one motion may differ in
LOOSE = {"color": style.LAW_COLOURS["piezo-viscous"], "linewidth": 1.1}
TIGHT = {"color": style.LAW_COLOURS["iso-viscous"], "linewidth": 1.9}


@dataclass(frozen=True)
class Pair:
    """The same motion at a loose and a tight tolerance."""

    name: str
    loose: Result
    tight: Result
    last_ratio: float

    def check(self) -> None:
        """Refuse runs of two motions, and runs in the wrong order."""
        groups = sorted((self.loose.input.keys() | self.tight.input.keys()) - set(FREE_GROUPS))
        for group in groups:
            if self.loose.input.get(group) != self.tight.input.get(group):
                raise ResultError(
                    f"{self.loose.path} and {self.tight.path} are not the same motion: "
                    f"their groups &{group} differ."
                )
        if self.loose.number("solver", "tolerance") <= self.tight.number("solver", "tolerance"):
            raise ResultError(
                f"The tolerance of {self.loose.path} is not looser than that of {self.tight.path}."
            )


def add_options(parser: ArgumentParser) -> None:
    for key, name, _ in CASES:
        parser.add_argument(
            f"--{key.replace('_', '-')}",
            nargs=2,
            type=Path,
            metavar=("LOOSE", "TIGHT"),
            help=f"two result files for the column '{name}'",
        )
    style.add_extent(parser, 3)


def run(options: Namespace) -> None:
    pairs = []
    for key, name, last_ratio in CASES:
        paths = getattr(options, key)
        if paths is not None:
            loose, tight = map(rattle.read, paths)
            for result in (loose, tight):
                result.require_rows("motion")
                command.note_open(result)
            pairs.append(Pair(name, loose, tight, last_ratio))
    if not pairs:
        raise command.CommandError("Nothing to draw: give --false-harmonic, --false-reversals or both.")
    with style.house_style():
        made = draw(pairs, options.periods, options.window, is_narrow(options.width))
        print(*style.save([("tolerance", made)], options), sep="\n")


def draw(pairs: Sequence[Pair], periods: int, window: int | None, narrow: bool = False) -> Figure:
    """Histories above, spectra below; a column for each pair, in a narrow figure one below the other."""
    if narrow:
        figure = Figure(figsize=(4.1, 4.4 * len(pairs)))
        columns = figure.subplots(2 * len(pairs), 1).reshape(len(pairs), 2)
    else:
        figure = Figure(figsize=(max(style.WIDTH, 4.1 * len(pairs)), 4.4))
        columns = figure.subplots(2, len(pairs), squeeze=False).T
    for position, (pair, (history, spectrum)) in enumerate(zip(pairs, columns, strict=True)):
        pair.check()
        _draw_histories(history, pair, periods, window)
        _draw_spectra(spectrum, pair, window)
        handles = history.get_legend_handles_labels()
        letter = f"({chr(ord('a') + position)}) " if len(pairs) > 1 else ""
        place = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.34), "alignment": "left"}
        spectrum.legend(*handles, title=f"{letter}{pair.name}" if letter else None, **place)
        history.set_title(f"{letter}{pair.name}\n{_scheme(pair)}")
    figure.align_ylabels()
    return figure


def _draw_histories(axes: Axes, pair: Pair, periods: int, window: int | None) -> None:
    axes.axhline(0.0, color=style.PERIOD_COLOUR, linewidth=0.7, zorder=0)
    for result, line in ((pair.tight, TIGHT), (pair.loose, LOOSE)):
        axes.plot(*last_periods(result, "acceleration", periods), label=_words(result, window), **line)
    period_rules(axes, [pair.loose, pair.tight], periods)
    axes.set_xlabel(time_label([pair.loose, pair.tight], periods))
    axes.set_ylabel(style.of_acceleration(style.ACCELERATION_LABEL, [pair.loose]))


def _draw_spectra(axes: Axes, pair: Pair, window: int | None) -> None:
    largest = 0.0
    for result, line, width in ((pair.loose, LOOSE, 1.7), (pair.tight, TIGHT, 0.9)):
        ratio, amplitude = column_spectrum(result, "acceleration", window)
        shown = (ratio > 0.0) & (ratio <= pair.last_ratio)
        axes.vlines(ratio[shown], 0.0, amplitude[shown], color=line["color"], linewidth=width)
        largest = max(largest, float(amplitude[shown].max()))
    axes.set_xlim(0.0, pair.last_ratio + 0.1)
    axes.set_ylim(0.0, 1.08 * largest if largest > 0.0 else 1.0)
    axes.set_xlabel(style.RATIO_LABEL)
    axes.set_ylabel(style.of_acceleration(style.AMPLITUDE_LABEL, [pair.loose]))


def _words(result: Result, window: int | None) -> str:
    verdict = judge_samples(result, window)
    return (
        f"{_power(result.number('solver', 'tolerance'))}: "
        f"{verdict['reversals_per_period']:.3g} reversals a period, "
        f"class {spoken(verdict['rattle_class'])}"
    )


def _power(tolerance: float) -> str:
    mantissa, exponent = f"{tolerance:.3e}".split("e")
    factor = "" if float(mantissa) == 1.0 else rf"{float(mantissa):g} \times "
    return rf"$\varepsilon = {factor}10^{{{int(exponent)}}}$ m"


def _scheme(pair: Pair) -> str:
    solver = pair.loose.input.get("solver", {})
    words = [f"{key} {str(solver[key]).strip()}" for key in ("iteration", "predictor") if key in solver]
    few = ", too few" if pair.loose.coarse or pair.tight.coarse else ""
    return f"{', '.join(words)}\n{solver.get('steps_per_period')} steps a period{few}"
