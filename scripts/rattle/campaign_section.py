"""Cuts through the grid of a campaign: one or two varied keys stay free, the others are held."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rattle.campaign_result import Axis, Campaign
from rattle.command import CommandError

# Words of keys whose names carry their unit or leave out whose they are.
KEY_WORDS = {
    "speed_rpm": "shaft speed",
    "temperature_celsius": "oil temperature",
    "viscosity_40_cst": "oil viscosity at 40 degC",
    "viscosity_100_cst": "oil viscosity at 100 degC",
    "density_15": "oil density at 15 degC",
    "pressure_angle_deg": "pressure angle",
    "helix_angle_deg": "helix angle",
    "frequency": "excitation frequency",
    "loudest_verdict": "verdict of the loudest motion",
    "loudest_class": "class of the loudest motion",
    "quietest_class": "class of the quietest motion",
}


@dataclass(frozen=True)
class Held:
    """A key that is held at a grid point; `asked` is None where nobody chose the point."""

    axis: Axis
    index: int
    asked: float | None

    @property
    def value(self) -> float:
        return float(self.axis.values[self.index])

    @property
    def words(self) -> str:
        """As in 'viscosity = 0.3 Pa s'."""
        return f"{short_name(self.axis.key)} = {self.value:.4g}{spaced_unit(self.axis.unit)}"


@dataclass(frozen=True)
class Section:
    """A cut: its free axes in the order asked for, and the held ones."""

    campaign: Campaign
    free: tuple[Axis, ...]
    held: tuple[Held, ...]

    def values(self, column: str) -> np.ndarray:
        """A column on the cut, an index for each free axis in their order."""
        return self.cut(self.campaign.grid(column))

    def cut(self, grid: np.ndarray) -> np.ndarray:
        """The same of an array on the whole grid."""
        places = {held.axis.key: held.index for held in self.held}
        rest = grid[tuple(places.get(key, slice(None)) for key in self.campaign.varied)]
        left = [key for key in self.campaign.varied if key not in places]
        return np.transpose(rest, [left.index(axis.key) for axis in self.free])

    def mask(self, wanted: np.ndarray) -> np.ndarray:
        """Where on the cut a condition holds that is given for every scene; False where none is done."""
        grid = np.zeros(self.campaign.shape, dtype=bool)
        grid[self.campaign.places] = wanted[self.campaign.done]
        return self.cut(grid)

    @property
    def words(self) -> str:
        """The held keys and their values."""
        return ", ".join(held.words for held in self.held)

    def remarks(self) -> list[str]:
        """Sentences on held keys whose value is not the one asked for."""
        sentences = []
        for held in self.held:
            if held.asked is None:
                sentences.append(
                    f"{held.words}: the middle of its axis; --slice {held.axis.key}=VALUE moves it."
                )
            elif not np.isclose(held.value, held.asked, rtol=1e-9, atol=0.0):
                sentences.append(f"{held.words} is the grid point nearest to the {held.asked:g} asked for.")
        return sentences


def new_section(campaign: Campaign, free: Sequence[str], slices: Mapping[str, float]) -> Section:
    """The cut with these keys free, the others at the grid points nearest to `slices`."""
    if len(set(free)) < len(free):
        raise CommandError(f"{free[0]} cannot be both axes.")
    axes = tuple(campaign.axis(key) for key in free)
    for key in slices:
        campaign.axis(key)
        if key in free:
            raise CommandError(f"{key} is an axis of the picture and cannot be sliced too.")
    held = []
    for axis in campaign.axes:
        if axis.key in free:
            continue
        asked = slices.get(axis.key)
        if asked is None:
            held.append(Held(axis, axis.values.size // 2, None))
            continue
        low, high = axis.values[0], axis.values[-1]
        if not low <= asked <= high and not np.isclose(asked, (low, high)).any():
            raise CommandError(
                f"{axis.key} = {asked:g} is outside the campaign, which has {low:g} to {high:g}."
            )
        held.append(Held(axis, int(np.argmin(np.abs(axis.values - asked))), asked))
    return Section(campaign, axes, tuple(held))


def short_name(key: str) -> str:
    """The words of a key or column, as in 'force amplitude'."""
    name = key.rpartition(".")[2]
    return KEY_WORDS.get(name, name.replace("_", " "))


def spaced_unit(unit: str) -> str:
    """What follows a number of this unit; nothing behind a pure number."""
    return "" if unit in ("", "-") else f" {unit}"
