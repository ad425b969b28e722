"""What a designer can change of a scene, how far, and what that sets in its input."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rattle.command import CommandError
from rattle.keys import key_table

Groups = Mapping[str, Mapping[str, Any]]

# How a range stands to the present value: a multiple of it, added to it, or by itself.
TIMES, PLUS, BY_ITSELF = "times", "plus", "by itself"
SHARE_OF_EFFORT = 0.1


@dataclass(frozen=True)
class Kind:
    """One thing to change: its words, its key, how its range follows, and keys that follow by its factor."""

    name: str
    key: str
    kind: str
    first: float
    last: float
    along: tuple[str, ...] = ()
    needs: str = ""
    """A key without which it does nothing."""


KINDS = (
    Kind("drag torque", "gear.drag_torque", TIMES, 0.25, 4.0),
    Kind("drag", "gear.drag_scale", TIMES, 0.25, 4.0),
    Kind("immersion depth", "gear.immersion_depth", PLUS, -0.015, 0.015, needs="gear.bearing_mean_diameter"),
    Kind("synchroniser gap", "gear.synchroniser_gap", TIMES, 0.5, 2.0, needs="gear.synchroniser_cones"),
    Kind("loose inertia", "gear.loose_inertia", TIMES, 0.5, 1.5),
    Kind("backlash", "gear.backlash", TIMES, 0.25, 4.0),
    Kind("face width", "gear.face_width", TIMES, 0.5, 2.0),
    Kind("tooth damping", "gear.tooth_damping_ratio", BY_ITSELF, 0.0, 0.1, needs="gear.tooth_stiffness"),
    Kind("oil grade", "oil.viscosity_40_cst", TIMES, 0.5, 2.0, along=("oil.viscosity_100_cst",)),
    Kind("oil temperature", "oil.temperature_celsius", PLUS, -40.0, 40.0),
    Kind("steady force", "load.steady_force", TIMES, 0.25, 4.0),
    Kind("mass", "load.mass", TIMES, 0.5, 1.5),
    Kind("backlash", "contact.backlash", TIMES, 0.25, 4.0),
    Kind("length", "contact.length", TIMES, 0.5, 2.0),
    Kind("tooth damping", "contact.damping_ratio", BY_ITSELF, 0.0, 0.1, needs="contact.stiffness"),
    Kind("viscosity", "lubricant.viscosity", TIMES, 0.5, 2.0),
    Kind("all that shakes", "load.force_scale", TIMES, 0.1, 1.0),
)
# Lists with an amplitude for each order: group, key of the orders, key of the amplitudes, words.
LISTS = (
    ("shaft", "orders", "accelerations", "acceleration of order {:g}"),
    ("shaft", "orders", "speed_amplitudes", "speed of order {:g}"),
    ("load", "force_orders", "force_amplitudes", "force of order {:g}"),
)
LEAST_OF_ORDER = 0.1
# What is 0 unless the input says otherwise, and is left out of a resolved input.
ABSENT = {"gear.tooth_damping_ratio": 0.0, "contact.damping_ratio": 0.0}
NEVER_BELOW_ZERO = ("gear.immersion_depth",)
# The program varies it alone, but a scene without damping has no place for it among those that have it.
LEAST = {"gear.tooth_damping_ratio": 1e-3, "contact.damping_ratio": 1e-3}


@dataclass(frozen=True)
class Lever:
    """A thing to change, from `first` to `last`, and its value `now`, in the unit of its key.

    `along`: keys, with their values now, that change by the same factor. `list_key`, `place` and `values`:
    the list of the input that it is an element of.
    """

    name: str
    key: str
    unit: str
    now: float
    first: float
    last: float
    logarithmic: bool
    effort: float
    """What it is changed by, either way, to see what an effort gains."""
    along: tuple[tuple[str, float], ...] = ()
    list_key: str = ""
    place: int = 0
    values: tuple[float, ...] = ()

    @property
    def is_one_key(self) -> bool:
        """Whether the program can follow it as a key of its own."""
        return not self.along and not self.list_key

    @property
    def is_of_pair(self) -> bool:
        """Whether each pair of a gearbox has its own."""
        return self.key.startswith("gear.")

    def settings(self, value: float) -> dict[str, Any]:
        """The keys of the input with the values that make it `value`."""
        if self.list_key:
            values = list(self.values)
            values[self.place] = value
            return {self.list_key: values}
        return {self.key: value} | {key: now * value / self.now for key, now in self.along}

    def place_of(self, value: float | np.ndarray) -> Any:
        """0 at `first`, 1 at `last`."""
        if self.logarithmic:
            return np.log(np.asarray(value) / self.first) / math.log(self.last / self.first)
        return (np.asarray(value) - self.first) / (self.last - self.first)

    def value_at(self, place: float) -> float:
        if self.logarithmic:
            return self.first * (self.last / self.first) ** place
        return self.first + (self.last - self.first) * place

    def share(self, value: float | np.ndarray) -> Any:
        """0 now, 1 at the upper and -1 at the lower end of the range."""
        now, place = float(self.place_of(self.now)), self.place_of(value)
        above = np.maximum(place - now, 0.0) / max(1.0 - now, 1e-12)
        return above - np.maximum(now - place, 0.0) / max(now, 1e-12)

    def efforts(self) -> list[float]:
        """The values that an effort leads to, within the range."""
        tried = (self.now - self.effort, self.now + self.effort)
        return [value for value in tried if self.first <= value <= self.last and value != self.now]


def levers(groups: Groups, ranges: Mapping[str, tuple[float, float]]) -> list[Lever]:
    """What can be changed of a resolved scene; `ranges` stand for those of this module, by key."""
    found = []
    for kind in KINDS:
        now = value_of(groups, kind.key)
        if now is None or (kind.needs and not value_of(groups, kind.needs)):
            continue
        others = ((other, value_of(groups, other)) for other in kind.along)
        along = tuple((other, value) for other, value in others if value is not None)
        found.append(_lever(kind, kind.key, now, ranges, along=along))
    for group, orders, name, words in LISTS:
        given = groups.get(group, {})
        values = tuple(map(float, np.atleast_1d(given.get(name, ()))))
        # One order alone is all that shakes.
        for place, now in enumerate(values if len(values) > 1 else ()):
            kind = Kind(words.format(given[orders][place]), "", TIMES, LEAST_OF_ORDER, 1.0)
            lever = _lever(kind, f"{group}.{name}({place + 1})", now, ranges)
            if lever is not None:
                found.append(replace(lever, list_key=f"{group}.{name}", place=place, values=values))
    return [lever for lever in found if lever is not None]


def value_of(groups: Groups, key: str) -> float | None:
    """The present value of a key that is a number; None where the scene has none."""
    group, name = key.split(".")
    value = groups.get(group, {}).get(name, ABSENT.get(key))
    return float(value) if isinstance(value, int | float) else None


def _lever(
    kind: Kind,
    key: str,
    now: float,
    ranges: Mapping[str, tuple[float, float]],
    along: tuple[tuple[str, float], ...] = (),
) -> Lever | None:
    """None where the present value leaves no range."""
    if key in ranges:
        first, last = ranges[key]
        if not first <= now <= last:
            raise CommandError(f"--range {key}={first:g}:{last:g}: its value now, {now:g}, lies outside.")
    elif kind.kind == TIMES:
        first, last = sorted((kind.first * now, kind.last * now))
    else:
        base = now if kind.kind == PLUS else 0.0
        first, last = base + kind.first, max(base + kind.last, now)
    if key in NEVER_BELOW_ZERO:
        first = max(first, 0.0)
    if not first < last:
        return None
    effort = SHARE_OF_EFFORT * (abs(now) if kind.kind == TIMES else last - first)
    group, name = key.partition("(")[0].split(".")
    known = key_table().get((group, name))
    is_logarithmic = kind.kind == TIMES and first > 0.0 and kind.first * kind.last == 1.0
    return Lever(kind.name, key, known.unit if known else "", now, first, last, is_logarithmic, effort, along)
