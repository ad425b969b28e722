"""The look and the words that all figures share."""

from __future__ import annotations

import re
from argparse import ArgumentParser, Namespace
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rattle import outputs
from rattle.command import CommandError, positive
from rattle.figures.fit import fit
from rattle.outputs import Writer
from rattle.result import Result
from rattle.result_file import ResultFile

# The palette of Okabe and Ito, which colour-blind readers can distinguish.
LAW_COLOURS = {"iso-viscous": "#0072B2", "piezo-viscous": "#D55E00"}
RUN_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
RUN_DASHES = ("-", (0, (5, 1.5)), (0, (1.5, 1.2)), (0, (5, 1.5, 1.2, 1.5)))
RUN_MARKS = ("o", "s", "^", "D", "v", "P", "X")
FORCE_COLOUR = "#4D4D4D"
FAINT_COLOUR = "#9A9A9A"
PERIOD_COLOUR = "#D5D5D5"
HALO = [patheffects.withStroke(linewidth=2.2, foreground="white")]  # of words over curves

ACCELERATION_LABEL = r"Acceleration $\ddot{z}$ [m/s$^2$]"
AMPLITUDE_LABEL = r"Amplitude of $\ddot{z}$ [m/s$^2$]"
# What the acceleration of a gear pair is.
RELATIVE = "relative to the shaft, on the line of action"
FILM_LABEL = r"Film thickness $h$ [$\mathrm{\mu}$m]"
FORCE_LABEL = r"Applied force $F$ [N]"
RATIO_LABEL = r"Frequency ratio $f/f_\mathrm{exc}$"

DATES = {"png": "Software", "pdf": "CreationDate", "svg": "Date"}  # what changes from run to run

FEW_SAMPLES = "too few samples"

WIDTH = 6.3  # inches, a text column of 160 mm
_SETTINGS = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9,
    "axes.titlesize": 9.5,
    "axes.titlelocation": "left",
    "axes.labelsize": 9,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "legend.fontsize": 8,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
    "figure.constrained_layout.use": True,
    "figure.constrained_layout.w_pad": 0.1,  # inches; room for the last tick label
    "figure.constrained_layout.h_pad": 0.06,
    "pdf.fonttype": 42,
}


@contextmanager
def house_style(salt: str = "rattle") -> Iterator[None]:
    """The settings of this module over Matplotlib's own, whatever else is set; names in SVG follow `salt`."""
    with matplotlib.rc_context():
        # Not rcdefaults, which reads the style files of the user.
        defaults = {name: value for name, value in matplotlib.rcParamsDefault.items() if name != "backend"}
        matplotlib.rcParams.update(defaults | _SETTINGS | {"svg.hashsalt": salt})
        yield


def run_line(position: int) -> dict[str, Any]:
    """Colour and dashes of the run at `position` in an overlay of as many runs as there are colours."""
    return {
        "color": RUN_COLOURS[position],
        "linestyle": RUN_DASHES[position % len(RUN_DASHES)],
    }


def run_lines(laws: Sequence[str]) -> list[dict[str, object]]:
    """How the runs of a figure look, given their film laws: a single one has the colour of its law."""
    if len(laws) == 1:
        return [{"color": law_colour(laws[0])}]
    return [run_line(position) for position in range(len(laws))]


def law_colour(law: str) -> str:
    return LAW_COLOURS.get(law, RUN_COLOURS[2])


def legend_below(
    figure: Figure, axes: Axes, columns: int = 3, labels: Mapping[str, object] | None = None
) -> None:
    """A legend under the axes, where it hides no data."""
    handles = labels or dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    figure.legend(list(handles.values()), list(handles), loc="outside lower center", ncols=columns)


def add_extent(parser: ArgumentParser, periods: int) -> None:
    """The options on how much of a motion is shown."""
    parser.add_argument(
        "--periods",
        type=positive,
        default=periods,
        metavar="N",
        help=f"periods that the histories show ({periods})",
    )
    parser.add_argument(
        "--window",
        type=positive,
        metavar="N",
        help="periods behind the spectra, by default those that the program judged",
    )


def save(
    figures: Sequence[tuple[str, Figure]], options: Namespace, beside: Sequence[tuple[Path, Writer]] = ()
) -> list[Path]:
    """Write figures, each under its stem, as the common options of plot.py say, and what goes with them."""
    files: list[tuple[Path, Writer]] = []
    for stem, figure in figures:
        fit(figure, options)
        for name in options.format:
            files.append((options.output / f"{stem}.{name}", figure_writer(figure, options, name)))
    try:
        return outputs.write([*files, *beside], overwrite=options.overwrite)
    except OSError as fault:
        raise CommandError(f"{options.output} cannot take the figures: {fault.strerror or fault}.") from None


def figure_writer(figure: Figure, options: Namespace, form: str) -> Writer:
    """Writes a figure without dates: equal data give equal bytes."""

    def write(path: Path) -> None:
        figure.savefig(path, format=form, dpi=options.dpi, metadata={DATES[form]: None})

    return write


def power_words(value: float, symbol: str = "") -> str:
    """A number as mantissa and power of ten, as the value of a symbol if one is given."""
    mantissa, exponent = f"{value:.3e}".split("e")
    equals = f"{symbol} = " if symbol else ""
    return rf"${equals}{float(mantissa):g} \times 10^{{{int(exponent)}}}$"


def run_labels(results: Sequence[Result]) -> list[str]:
    """Scene names; runs of equal name are distinguished by their directory, then by their order."""
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


def film_words(result: ResultFile) -> str:
    """The film law and model, as in 'published iso-viscous film' and 'elastohydrodynamic film (closure)'."""
    model, law = (str(result.value("film", key)).strip() for key in ("model", "law"))
    if law == "elastohydrodynamic":
        return f"{law} film ({model})"
    return f"{'Reynolds' if model == 'reynolds' else model} {law} film"


def title(subject: str, result: Result, label: str) -> str:
    """One line that says what is drawn, of which scene, and with which film."""
    return f"{subject}: {label}, {film_words(result)}"


def overlay_title(subject: str, results: Sequence[Result]) -> str:
    films = sorted({film_words(result) for result in results})
    return f"{subject}: {len(results)} runs, {' and '.join(films)}"


def curve_label(label: str, few: bool) -> str:
    """A run label in the legend of several; `few` where its curve misses what lies between the samples."""
    return f"{label}, {FEW_SAMPLES}" if few else label


def name_runs(
    figure: Figure,
    axes: Axes,
    subject: str,
    results: Sequence[Result],
    labels: Sequence[str],
) -> None:
    """Title the axes; several runs are distinguished by a legend below."""
    if len(results) == 1:
        axes.set_title(title(subject, results[0], labels[0]))
    else:
        axes.set_title(overlay_title(subject, results))
        legend_below(figure, axes)


def _repeated(labels: Sequence[str]) -> list[bool]:
    counts = Counter(labels)
    return [counts[label] > 1 for label in labels]


def of_acceleration(label: str, results: Sequence[Result]) -> str:
    """The label of an axis: that of a gear is relative to the shaft, along the line of action."""
    return relative_label(label) if any(result.has_gear for result in results) else label


def relative_label(label: str) -> str:
    """As in 'Relative acceleration' and 'Amplitude of relative ...'."""
    words = label.replace(r"Acceleration $\ddot{z}$", "Relative acceleration")
    words = words.replace("of the acceleration", "of the relative acceleration")
    return words.replace(r"of $\ddot{z}$", r"of relative $\ddot{z}$")


def note(axes: Axes, words: str) -> None:
    """A warning in a corner of the panel; titles have none."""
    if words:
        place = {"xycoords": "axes fraction", "textcoords": "offset points", "va": "top"}
        axes.annotate(words, (0.0, 1.0), xytext=(4, -2), fontsize=7, path_effects=HALO, **place)
