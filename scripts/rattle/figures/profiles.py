"""Pressure and film over the contact, with the pressure of a dry contact under the same load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rattle.figures import style
from rattle.result import TIME, Result

FLANKS = {1: "drive flank", 2: "coast flank"}
SHOWN_SHARE = 0.01  # the contact is shown as far as a pressure exceeds this share of the largest
FILM_SHARE = 4.0  # films are shown up to this multiple of the film in the middle
BETWEEN = 8  # points of a curve from node to node
DRY = {"linewidth": 1.0, "linestyle": (0, (4, 2))}


@dataclass(frozen=True)
class Profile:
    """A profile of a flank: time [s], load [N], and columns over the contact by their names."""

    flank: int
    time: float
    load: float
    columns: dict[str, np.ndarray]

    @property
    def place(self) -> np.ndarray:
        """Position [um]."""
        return 1e6 * self.columns["position"]

    @property
    def pressure(self) -> np.ndarray:
        """Pressure [MPa]."""
        return 1e-6 * self.columns["pressure"]

    def curve(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Place and values between the nodes too, by the cubics through the next four nodes."""
        return _between(self.place), _between(values)

    def dry_curve(self) -> tuple[np.ndarray, np.ndarray]:
        """Place and pressure of a dry contact: half an ellipse, whose square is a parabola."""
        inside = self.dry > 0.0
        if np.count_nonzero(inside) < 3:
            return self.place, self.dry
        bend, _, top = np.polyfit(self.place[inside], self.dry[inside] ** 2, 2)
        place = np.sqrt(-top / bend) * np.sin(np.linspace(-0.5, 0.5, 201) * np.pi)
        return place, np.sqrt(np.maximum(top + bend * place**2, 0.0))

    @property
    def dry(self) -> np.ndarray:
        """Pressure of a dry contact [MPa]."""
        return 1e-6 * self.columns["hertzian_pressure"]

    @property
    def film(self) -> np.ndarray:
        """Film [um]."""
        return 1e6 * self.columns["film_thickness"]


def _between(values: np.ndarray) -> np.ndarray:
    places = np.linspace(0.0, values.size - 1.0, (values.size - 1) * BETWEEN + 1)
    first = np.clip(places.astype(int) - 1, 0, values.size - 4)
    share = places - first
    curve = np.zeros_like(places)
    for node in range(4):
        weight = np.ones_like(places)
        for other in set(range(4)) - {node}:
            weight *= (share - other) / (node - other)
        curve += weight * values[first + node]
    return curve


def profiles_of(result: Result) -> list[Profile]:
    """The profiles beside a motion, in the order of time; none where it has none."""
    table = result.profiles
    if table is None or table.row_count == 0:
        return []
    columns = {name: np.array(table[name]) for name in table.names}
    changes = (np.diff(columns[TIME]) != 0.0) | (np.diff(columns["flank"]) != 0.0)
    parts = np.split(np.arange(table.row_count), np.flatnonzero(changes) + 1)
    return [
        Profile(
            round(float(columns["flank"][part[0]])),
            float(columns[TIME][part[0]]),
            float(columns["film_load"][part[0]]),
            {name: values[part] for name, values in columns.items()},
        )
        for part in parts
    ]


def most_loaded(profiles: Sequence[Profile]) -> list[Profile]:
    """Of each flank the profile of the largest load."""
    flanks = sorted({profile.flank for profile in profiles})
    return [
        max((one for one in profiles if one.flank == flank), key=lambda one: one.load) for flank in flanks
    ]


def draw(result: Result, label: str) -> Figure:
    """Pressure over film, of each flank at its largest load that is written."""
    shown = most_loaded(profiles_of(result))
    figure = Figure(figsize=(style.WIDTH, 4.6))
    above, below = figure.subplots(2, 1, sharex=True)
    for profile in shown:
        line = style.run_line(profile.flank - 1)
        words = f"{FLANKS[profile.flank]}, $W$ = {profile.load:.0f} N at {1e3 * profile.time:.2f} ms"
        above.plot(*profile.curve(profile.pressure), color=line["color"], label=words)
        above.plot(*profile.dry_curve(), color=line["color"], **DRY)
        below.plot(*profile.curve(profile.film), color=line["color"])
    above.plot([], [], color=style.FORCE_COLOUR, label="the same load on a dry contact (Hertz)", **DRY)
    frame(above, below, shown)
    above.legend(loc="upper left")
    above.set_title(style.title("Pressure and film over the contact", result, label))
    return figure


def frame(above: Axes, below: Axes, profiles: Sequence[Profile]) -> None:
    """Show the part of the contact that carries pressure; the inlet lies far to the left."""
    left, right, thick = 0.0, 0.0, 0.0
    highest = max(max(one.pressure.max(), one.dry.max()) for one in profiles)
    for profile in profiles:
        felt = profile.place[np.maximum(profile.pressure, profile.dry) > SHOWN_SHARE * highest]
        left, right = min(left, felt.min()), max(right, felt.max())
        thick = max(thick, float(np.interp(0.0, profile.place, profile.film)))
    above.set_xlim(1.1 * left, right + 0.1 * (right - left))
    above.set_ylim(0.0, 1.45 * highest)
    below.set_ylim(0.0, FILM_SHARE * thick)
    above.set_ylabel("Pressure [MPa]")
    below.set_ylabel(style.FILM_LABEL)
    below.set_xlabel(r"Position along the surfaces, which move to the right, $x$ [$\mathrm{\mu}$m]")
