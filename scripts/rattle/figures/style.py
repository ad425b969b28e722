"""The look that all figures share, whatever the user's own matplotlib settings are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rattle.command import CommandError

# The palette of Okabe and Ito, which colour-blind readers can tell apart.
LAW_COLOURS = {"iso-viscous": "#0072B2", "piezo-viscous": "#D55E00"}
RUN_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
RUN_DASHES = ("-", (0, (5, 1.5)), (0, (1.5, 1.2)), (0, (5, 1.5, 1.2, 1.5)))
FORCE_COLOUR = "#4D4D4D"
FAINT_COLOUR = "#9A9A9A"
PERIOD_COLOUR = "#D5D5D5"

ACCELERATION_LABEL = r"Acceleration $\ddot{z}$ [m/s$^2$]"
AMPLITUDE_LABEL = r"Amplitude of $\ddot{z}$ [m/s$^2$]"
FILM_LABEL = r"Film thickness $h$ [$\mathrm{\mu}$m]"
FORCE_LABEL = r"Applied force $F$ [N]"
RATIO_LABEL = r"Frequency ratio $f/f_\mathrm{exc}$"

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
    "savefig.dpi": 200,
    "pdf.fonttype": 42,
}


@contextmanager
def house_style() -> Iterator[None]:
    """Matplotlib's own defaults with the settings of this module."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_SETTINGS)
        yield


def run_line(position: int) -> dict[str, object]:
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


def save(figure: Figure, directory: Path, stem: str) -> list[Path]:
    """Write `stem`.png and `stem`.pdf without dates, so that equal data give equal bytes."""
    paths = [directory / f"{stem}.png", directory / f"{stem}.pdf"]
    try:
        directory.mkdir(parents=True, exist_ok=True)
        figure.savefig(paths[0], metadata={"Software": None})
        figure.savefig(paths[1], metadata={"CreationDate": None})
    except OSError as fault:
        raise CommandError(f"{directory} cannot take the figures: {fault.strerror or fault}.") from None
    return paths
