"""What the figures of a film task share: its points, their curves, and the words for both."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb

import rattle
from rattle import command
from rattle.figures import style
from rattle.result import Result, ResultError

# The film of figures 3 and 5 of the paper; of several films in a file the nearest to it is drawn.
PAPER_FILM_RATIO = 70e-6
PAPER_SPEED_GROUP = 0.9e-6

MOST_CURVES = 9
APPROACH, ROLLING, SEPARATION = "#0072B2", "#000000", "#D55E00"
SQUEEZE_TITLE = r"$w^* = w/u$, from the top"


@dataclass(frozen=True)
class Choice:
    """The film ratio and speed group that the user wants; None takes the one nearest to the paper's.

    In a narrow figure the legend names fewer things.
    """

    film_ratio: float | None = None
    speed_group: float | None = None
    narrow: bool = False


@dataclass(frozen=True)
class Curve:
    """Columns along one curve, at one squeeze ratio."""

    squeeze_ratio: float
    columns: Mapping[str, np.ndarray]

    def __getitem__(self, name: str) -> np.ndarray:
        return self.columns[name]


def read_points(path: Path) -> Result:
    """The table of a film task."""
    result = rattle.read(path)
    _check_task(result)
    return result


def read_profiles(points: Path) -> Result:
    """The pressure profiles that stand beside the table of a film task."""
    path = points.with_suffix(".profiles.rattle")
    if not path.exists():
        raise ResultError(f"{path} does not exist: the film task was not asked for 'profile'.")
    result = rattle.read(path)
    _check_task(result)
    if points.exists() and result.input_text != rattle.read(points).input_text:
        raise ResultError(f"{path} does not belong to {points} beside it: the two are of different inputs.")
    return result


def curves(result: Result, names: Sequence[str], along: str, fixed: Mapping[str, float]) -> list[Curve]:
    """A curve for each squeeze ratio, of the rows where the `fixed` columns have their values.

    The first ones are those of the fastest approach; each is sorted by the column `along`.
    """
    chosen = np.ones(result.row_count, dtype=bool)
    for name, value in fixed.items():
        chosen &= result[name] == value
    found = []
    for ratio in _thinned(np.unique(result["squeeze_ratio"][chosen]), result):
        rows = np.flatnonzero(chosen & (result["squeeze_ratio"] == ratio))
        rows = rows[np.argsort(result[along][rows], kind="stable")]
        found.append(Curve(float(ratio), {name: np.asarray(result[name][rows]) for name in (along, *names)}))
    return found


def choose(result: Result, name: str, wanted: float | None, usual: float) -> float:
    """The value of a column that is wanted, or the one nearest to the usual one."""
    held = np.unique(result[name])
    if held.size == 0:
        raise ResultError(f"{result.path} holds no points.")
    nearest = float(held[np.argmin(np.abs(np.log(held / (usual if wanted is None else wanted))))])
    if wanted is not None and abs(nearest / wanted - 1.0) > 1e-6:
        shown = ", ".join(f"{value:.4g}" for value in held[:12]) + (", ..." if held.size > 12 else "")
        raise ResultError(f"{result.path} has no {name} {wanted:g}; it holds {shown}.")
    if wanted is None and held.size > 1:
        command.note(f"{result.path} holds {held.size} values of {name}; {nearest:.4g} is drawn.")
    return nearest


def any_speed_group(result: Result, choice: Choice) -> float:
    """A speed group for what does not depend on it: the one that is wanted, or the first."""
    if choice.speed_group is None and result.row_count > 0:
        return float(result["speed_group"][0])
    return choose(result, "speed_group", choice.speed_group, PAPER_SPEED_GROUP)


def colours(found: Sequence[Curve]) -> list[str]:
    """Blue on approach, black in pure rolling, red on separation; the faster, the darker."""
    shades = []
    for sign, colour in ((-1.0, APPROACH), (1.0, SEPARATION)):
        speeds = sorted(abs(curve.squeeze_ratio) for curve in found if curve.squeeze_ratio * sign > 0.0)
        shades += [
            (sign * speed, _shade(colour, (rank + 1) / len(speeds))) for rank, speed in enumerate(speeds)
        ]
    lookup = dict(shades)
    return [lookup.get(curve.squeeze_ratio, ROLLING) for curve in found]


def squeeze_words(ratio: float) -> str:
    """A squeeze ratio for a legend."""
    return "0 (pure rolling)" if ratio == 0.0 else style.power_words(ratio)


def scene_line(result: Result, parts: Iterable[str]) -> str:
    """Second line of a title: the scene and what is held."""
    return ", ".join((f"Scene {result.scene_name}", *parts))


def angle_axis(axes: Axes) -> None:
    """The film coordinate from the inlet to the outlet, in parts of pi."""
    quarter = np.pi / 4.0
    axes.set_xlim(-2.0 * quarter, 2.0 * quarter)
    axes.set_xticks(
        [-2 * quarter, -quarter, 0.0, quarter, 2 * quarter],
        [r"$-\pi/2$", r"$-\pi/4$", "0", r"$\pi/4$", r"$\pi/2$"],
    )
    axes.set_xlabel(r"Film coordinate $\bar{x} = \arctan(x/\sqrt{2 R h_0})$ [rad]")


def _check_task(result: Result) -> None:
    result.require_rows("film")
    command.note_open(result)


def _thinned(ratios: np.ndarray, result: Result) -> np.ndarray:
    if ratios.size <= MOST_CURVES:
        return ratios
    command.note(f"{result.path} holds {ratios.size} squeeze ratios; {MOST_CURVES} of them are drawn.")
    kept = np.unique(np.round(np.linspace(0, ratios.size - 1, MOST_CURVES)).astype(int))
    return ratios[kept]


def _shade(colour: str, strength: float) -> str:
    """The colour, mixed with white where its strength is below one."""
    share = 0.45 + 0.55 * strength
    return to_hex([1.0 - share * (1.0 - part) for part in to_rgb(colour)])
