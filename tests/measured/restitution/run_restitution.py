"""Restitution of a lubricated steel cylinder on a plane over its Stokes number.

    python tests/measured/restitution/run_restitution.py

Writes table.csv and restitution.png beside this file, and prints the tables of ../README.md.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tables import Value, write_csv

import rattle
from rattle.figures import style

HERE = Path(__file__).resolve().parent
INPUT = HERE / "cylinder.nml"
RADIUS, LENGTH, FIRST_FILM, DENSITY = 6.0e-3, 0.020, 6.0e-4, 7800.0  # as of the input [m], [kg/m3]
MASS = DENSITY * math.pi * RADIUS**2 * LENGTH
STEEL = 2.26e11  # E* of the default key [Pa]
POISSON = 0.3
VELOCITIES = np.geomspace(0.05, 5.0, 25)  # [m/s]
ROLLING = 0.1  # entrainment speed over velocity
ROUGHNESS = (0.1e-6, 0.4e-6, 1.0e-6)  # films at which a rigid approach may end [m]
REBOUND = 0.02  # restitution from which a body is said to rebound
HEAD = ("cylinder", "velocity_m_s", "stokes", "closure", "in_nodes", "mass_on_spring")
SETTINGS = {"solver.accuracy": 1e-2, "film.nodes": 64}  # of films in nodes


@dataclass(frozen=True)
class Case:
    """A cylinder in its oil."""

    name: str
    viscosity: float = 0.05  # [Pa s]
    modulus: float = STEEL  # E* [Pa]

    def stokes(self, velocity: float) -> float:
        return DENSITY * 2.0 * RADIUS * velocity / (9.0 * self.viscosity)

    def velocity(self, stokes: float) -> float:
        return stokes * 9.0 * self.viscosity / (DENSITY * 2.0 * RADIUS)

    @property
    def squeeze(self) -> float:
        """C of the load C V h**-1.5 of a film that is squeezed alone."""
        return 3.0 * math.sqrt(2.0) * math.pi * self.viscosity * LENGTH * RADIUS**1.5


CASES = (
    Case("steel, 0.05 Pa s"),
    Case("steel, 0.2 Pa s", viscosity=0.2),
    Case("a tenth of the modulus, 0.05 Pa s", modulus=0.1 * STEEL),
)


# --- by the program ---------------------------------------------------------------------------------------


def changes_of(case: Case, velocity: float) -> dict[str, float]:
    """Keys of a cylinder that arrives at some velocity."""
    return {
        "film.initial_velocity": -velocity,
        "kinematics.entrainment_speed": ROLLING * velocity,
        "load.frequency": velocity / (6.0 * FIRST_FILM),
        "load.force_amplitudes": 1.1 * case.squeeze * velocity / FIRST_FILM**1.5,
        "lubricant.viscosity": case.viscosity,
        "contact.young_modulus": case.modulus * (1.0 - POISSON**2),
    }


def restitution(case: Case, velocity: float, model: str) -> float:
    """Of the program; NaN where the load never passes the limit of an impact."""
    changes = changes_of(case, velocity) | {"film.model": model}
    if model == "resolved":
        changes |= SETTINGS
    return float(rattle.run(INPUT, set=changes).summary.get("restitution_drive", math.nan))


def restitution_in_nodes(case: Case, velocity: float) -> Value:
    """The same, or the word of the status with which nodes stopped."""
    try:
        return restitution(case, velocity, "resolved")
    except rattle.SceneFailed as fault:
        return str(fault.solved.summary["status"])


# --- by reasoning: a rigid body, and one behind a spring --------------------------------------------------


def rigid_critical(film: float) -> float:
    """Stokes number of a rigid cylinder that stops at a film: m V is the integral of C h**-1.5 dh."""
    return 4.0 * math.sqrt(2.0) / 3.0 * (math.sqrt(RADIUS / film) - math.sqrt(RADIUS / FIRST_FILM))


def rigid_critical_of_sphere(film: float) -> float:
    """The same of a rigid sphere, whose film resists as 6 pi viscosity R**2 V/h."""
    return math.log(FIRST_FILM / film)


def elastic_film(case: Case, velocity: float) -> tuple[float, float]:
    """Film (C V/k)**0.4 whose load compresses the line contact by as much as itself [m], and k there [N/m].

    k = pi E* l/(2 ln(2 R/h)): the compression of a plane that is elastic down to R, about a contact as
    wide as the film makes it.
    """
    film = 1e-6
    for _ in range(100):
        stiffness = math.pi * case.modulus * LENGTH / (2.0 * math.log(2.0 * RADIUS / film))
        film = (case.squeeze * velocity / stiffness) ** 0.4
    return film, stiffness


def elastic_critical(case: Case) -> float:
    """Stokes number of a rigid cylinder that stops where its film is the elastic one of the same velocity."""

    def miss(stokes: float) -> float:
        return stokes - rigid_critical(elastic_film(case, case.velocity(stokes))[0])

    return float(brentq(miss, 1.0, 1e4))


def sprung_restitution(case: Case, velocity: float) -> float:
    """Of the cylinder as a rigid mass behind a spring k on a film C V h**-1.5 that ruptures when it opens."""
    film, stiffness = elastic_film(case, velocity)
    time = film / velocity
    load = stiffness * film
    inertia = load * time / (MASS * velocity)

    # Film h, load w and velocity v over those units: h' = -w h**1.5, w' = h' - v, v' = inertia w.
    def rates(_: float, state: np.ndarray) -> list[float]:
        h, w, v = state
        closing = -w * max(h, 0.0) ** 1.5
        return [closing, closing - v, inertia * w]

    def unloaded(_: float, state: np.ndarray) -> float:
        return float(state[1])

    unloaded.terminal, unloaded.direction = True, -1
    first = FIRST_FILM / film
    ended = solve_ivp(
        rates, (0.0, 1e5 * first), [first, first**-1.5, -1.0], "Radau", events=unloaded, rtol=1e-8, atol=1e-12
    )
    return float(ended.y[2, -1])


# --- table and picture ------------------------------------------------------------------------------------


def passing(stokes: np.ndarray, values: np.ndarray, level: float) -> float:
    """Where the restitution passes a level for the last time, by straight lines over ln St."""
    above = np.flatnonzero(values[:-1] < level)[-1]
    return float(np.exp(np.interp(level, values[above : above + 2], np.log(stokes[above : above + 2]))))


def line_in_inverse(stokes: np.ndarray, values: np.ndarray) -> tuple[float, float, float]:
    """e = dry - slope/St of those that keep a tenth, and the largest deviation from it."""
    kept = values > 0.1
    slope, dry = np.polyfit(1.0 / stokes[kept], values[kept], 1)
    return dry, -slope, float(np.max(np.abs(values[kept] - dry - slope / stokes[kept])))


def draw(found: dict[str, dict[str, np.ndarray]]) -> None:
    with style.house_style():
        figure = Figure(figsize=(style.WIDTH, 4.6))
        axes = figure.subplots()
        axes.axvspan(8.0, 10.0, color="0.85")
        axes.text(10.4, 0.98, "spheres, measured: no\nrebound below about 10", va="top", fontsize=8)
        axes.axvspan(500.0, 1100.0, color="0.93")
        axes.text(515.0, 0.04, "spheres,\nmeasured: as\ndry above\nabout 500", fontsize=8)
        for place, case in enumerate(CASES):
            rows, colour = found[case.name], style.RUN_COLOURS[place]
            axes.plot(rows["stokes"], rows["closure"], color=colour, label=case.name)
            axes.plot(rows["stokes"], rows["resolved"], "o", color=colour, ms=4, mfc="none")
            axes.plot(rows["stokes"], rows["sprung"], ":", color=colour)
            axes.axvline(elastic_critical(case), ymax=0.07, color=colour)
        for mark, words in (("-", "closure"), ("o", "in nodes"), (":", "mass behind a spring, scipy")):
            axes.plot([], [], mark, color="0.3", ms=4, mfc="none", label=words)
        axes.plot([], [], "|", color="0.3", label="critical St, derived")
        axes.set(xscale="log", xlim=(8.0, 1100.0), ylim=(-0.03, 1.0))
        axes.set_xlabel(r"Stokes number $\rho D V/(9 \eta)$")
        axes.set_ylabel("Restitution")
        axes.set_title("Lubricated cylinder that strikes a plane, computed")
        style.legend_below(figure, axes, 2)
        figure.savefig(HERE / "restitution.png", dpi=110, metadata={"Software": None})


def main() -> int:
    found, table, lines = {}, [], []
    for case in CASES:
        stokes = np.array([case.stokes(velocity) for velocity in VELOCITIES])
        closure = np.array([restitution(case, velocity, "closure") for velocity in VELOCITIES])
        in_nodes = [restitution_in_nodes(case, velocity) for velocity in VELOCITIES]
        sprung = np.array([sprung_restitution(case, velocity) for velocity in VELOCITIES])
        columns = (VELOCITIES, stokes, closure, in_nodes, sprung)
        for row in zip(*(map(plain, column) for column in columns), strict=True):
            table.append((case.name, *row))
        numbers = np.array([math.nan if isinstance(value, str) else value for value in in_nodes])
        found[case.name] = {"stokes": stokes, "closure": closure, "resolved": numbers, "sprung": sprung}
        derived, half = elastic_critical(case), passing(stokes, closure, 0.5)
        dry, slope, deviation = line_in_inverse(stokes, closure)
        lines.append(
            f"| {case.name} | {derived:.0f} | {passing(stokes, closure, REBOUND):.0f} "
            f"| {passing(stokes, sprung, REBOUND):.0f} | {half:.0f}, {half / derived:.2f} "
            f"| {np.nanmax(np.abs(numbers - closure)):.3f} | {dry:.3f} - {slope:.0f}/St, {deviation:.3f} |"
        )
    head = (
        "cylinder | critical St, derived | rebound from, computed | mass on spring | 0.5 at St, over derived "
        "| nodes off closure | line, off by"
    )
    print("\n".join([f"| {head} |", "|---" * 7 + "|", *lines, ""]))
    rigid = ["| approach ends at | rigid cylinder | rigid sphere |", "|---|---|---|"]
    for film in ROUGHNESS:
        numbers = f"{rigid_critical(film):.0f} | {rigid_critical_of_sphere(film):.1f}"
        rigid.append(f"| {1e6 * film:g} um | {numbers} |")
    print("\n".join(rigid))
    write_csv(HERE / "table.csv", HEAD, table)
    draw(found)
    return 0


def plain(value: Value) -> Value:
    return value if isinstance(value, str) else float(value)


if __name__ == "__main__":
    sys.exit(main())
