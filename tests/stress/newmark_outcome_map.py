"""Map of what Newmark's method makes of a scene, over steps a period and the tolerance eps of (36).

Draws what the program newmark_outcomes wrote; one panel for every scene, iteration and predictor.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rattle.command import CommandError
from rattle.figures.style import FAINT_COLOUR, WIDTH, house_style

OUTCOMES = ("right", "wrong amplitudes", "false harmonics", "wrong reversals", "diverged")
COLOURS = ("#DDEFE7", "#56B4E9", "#E69F00", "#C8385A", "#4D4D4D")
SCENES = {"idle": "idle", "creep": "creep", "creep_false_harmonic": "creep, false harmonic"}
METHODS = {
    ("successive", "previous"): "successive,\nprevious",
    ("successive", "extrapolated"): "successive,\nextrapolated",
    ("newton", "previous"): "Newton,\nprevious",
    ("newton", "extrapolated"): "Newton,\nextrapolated",
}
PAPER_RANGE = (1e-8, 1e-7)

Panel = dict[tuple[int, float], str]


def read_outcomes(path: Path) -> dict[tuple[str, str, str], Panel]:
    """Outcomes by steps and eps, for every scene, iteration and predictor."""
    panels: dict[tuple[str, str, str], Panel] = defaultdict(dict)
    try:
        with path.open(newline="") as file:
            for row in csv.DictReader(file):
                key = row["scene"], row["iteration"], row["predictor"]
                panels[key][int(row["steps"]), float(row["eps"])] = row["outcome"]
    except (OSError, KeyError, ValueError) as fault:
        raise CommandError(f"{path} holds no outcomes: {fault}.") from None
    return panels


def edges(values: np.ndarray) -> np.ndarray:
    """Edges of the cells around values, in the logarithm."""
    logs = np.log(values)
    middle = 0.5 * (logs[1:] + logs[:-1])
    return np.exp(np.r_[2 * logs[0] - middle[0], middle, 2 * logs[-1] - middle[-1]])


def draw_panel(axes: Axes, panel: Panel) -> None:
    """One map, with the paper's range of tolerances between two lines."""
    steps = np.array(sorted({key[0] for key in panel}), dtype=float)
    tolerances = np.array(sorted({key[1] for key in panel}))
    codes = np.array([[OUTCOMES.index(panel[int(n), eps]) for n in steps] for eps in tolerances])
    norm = BoundaryNorm(np.arange(len(OUTCOMES) + 1) - 0.5, len(OUTCOMES))
    axes.pcolormesh(
        edges(steps), edges(tolerances), codes, cmap=ListedColormap(COLOURS), norm=norm, rasterized=True
    )
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    for eps in PAPER_RANGE:
        axes.axhline(eps, color="black", linewidth=0.8, linestyle=(0, (3, 2)))
    axes.set_xticks([8, 64, 512, 4096], ["8", "64", "512", "4096"])
    axes.set_yticks([1e-14, 1e-12, 1e-10, 1e-8, 1e-6])
    axes.minorticks_off()
    axes.tick_params(color=FAINT_COLOUR)


def draw(panels: dict[tuple[str, str, str], Panel]) -> Figure:
    """All maps: a row for every scene, a column for every iteration and predictor."""
    figure = Figure(figsize=(WIDTH, 5.6))
    grid = figure.subplots(len(SCENES), len(METHODS), sharex=True, sharey=True)
    figure.get_layout_engine().set(w_pad=0.02)
    for axes, name in zip(grid[0], METHODS.values(), strict=True):
        axes.set_title(name)
    for row, (scene, scene_name) in zip(grid, SCENES.items(), strict=True):
        for axes, method in zip(row, METHODS, strict=True):
            draw_panel(axes, panels[(scene, *method)])
        row[0].set_ylabel(f"{scene_name}\n$\\epsilon$ [m]")
    for axes in grid[-1]:
        axes.set_xlabel("Steps a period")
    for row in grid:
        label = row[-1].text(
            1.04, 10**-7.5, "paper's\nrange", transform=row[-1].get_yaxis_transform(), fontsize=7
        )
        label.set(verticalalignment="center")
    patches = [Patch(facecolor=colour, label=name) for colour, name in zip(COLOURS, OUTCOMES, strict=True)]
    figure.suptitle("What Newmark's method makes of three scenes", x=0.02, ha="left", fontsize=9.5)
    figure.legend(handles=patches, loc="outside lower center", ncols=len(patches))
    return figure


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("outcomes", type=Path, help="CSV of newmark_outcomes")
    parser.add_argument("picture", type=Path, help="PNG to be written")
    arguments = parser.parse_args()
    try:
        panels = read_outcomes(arguments.outcomes)
        with house_style():
            figure = draw(panels)
            arguments.picture.parent.mkdir(parents=True, exist_ok=True)
            figure.savefig(arguments.picture, dpi=200, metadata={"Software": None})
    except KeyError as fault:
        print(f"{arguments.outcomes} lacks {fault}", file=sys.stderr)
        return 1
    except (CommandError, OSError) as fault:
        print(fault, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
