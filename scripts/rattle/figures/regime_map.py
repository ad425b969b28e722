"""Johnson's map of lubrication regimes: the scenes on it, and the part where Grubin's film (33) applies."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import rattle
from rattle import command, kernels, table
from rattle.figures import style

DESCRIPTION = (
    "Draw the regime map of line contacts after Johnson as 'regime_map', place scenes on it by their "
    "static load Q + m g (a line: the range of the applied force), and print where they lie. Without "
    "scenes the bare map is drawn."
)
SUMMARY_ENDING = ".summary.nml"
FILLS = ("#E8F1FA", "#FCEBDD", "#E6F4EC", "#F7E6F0")
PLACES = ((0.70, 0.12), (0.40, 0.55), (0.55, 0.30), (0.73, 0.50))  # of the names, in shares of their regime
BORDER = {"colors": style.FORCE_COLOUR, "linewidths": 1.0}
MARKERS = "osD^vP*"
HATCH = "////"
NODES = 300


@dataclass(frozen=True)
class Material:
    """What the map needs besides its two groups before it can place Grubin's film: oil and teeth."""

    pressure_viscosity: float  # alpha [1/Pa]
    modulus: float  # E* [Pa]


STEEL_AND_OIL = Material(2.0e-8, 226.0e9)


@dataclass(frozen=True)
class Scene:
    """A contact under its static load, and what its summary knows of the film."""

    name: str
    radius: float  # R [m]
    length: float  # l [m]
    speed: float  # entrainment speed U [m/s]
    viscosity: float  # eta0 [Pa s]
    material: Material
    load: float  # Q + m g [N]
    force_amplitude: float  # F0 [N]
    summary: Mapping[str, Any]

    def groups(self, load: float) -> tuple[float, float]:
        """g_v and g_e under a load."""
        contact = {"radius": self.radius, "speed": self.speed, "viscosity": self.viscosity}
        line_load = load / self.length
        return (
            kernels.viscosity_group(
                **contact, pressure_viscosity=self.material.pressure_viscosity, line_load=line_load
            ),
            kernels.elasticity_group(**contact, modulus=self.material.modulus, line_load=line_load),
        )

    def grubin_film(self) -> float:
        """h0 of (33) [m] under the static load."""
        return kernels.grubin_film(
            radius=self.radius,
            length=self.length,
            speed=self.speed,
            viscosity=self.viscosity,
            pressure_viscosity=self.material.pressure_viscosity,
            modulus=self.material.modulus,
            load=self.load,
        )

    def film_per_parameter(self) -> float:
        """Film [m] for one unit of the film parameter of the map."""
        one = {"radius": self.radius, "speed": self.speed, "viscosity": self.viscosity}
        return 1.0 / kernels.film_parameter(**one, line_load=self.load / self.length, film=1.0)


def add_options(parser: ArgumentParser) -> None:
    parser.add_argument(
        "scenes",
        nargs="*",
        type=Path,
        metavar="SUMMARY|RESULT",
        help="NAME.summary.nml or NAME.rattle of a motion",
    )
    parser.add_argument("--markdown", action="store_true", help="print the table in Markdown")


def run(options: Namespace) -> None:
    scenes = [read_scene(path) for path in options.scenes]
    with style.house_style():
        for path in style.save([("regime_map", draw(scenes))], options):
            command.note(str(path))
    if scenes:
        rows = table_rows(scenes)
        print(table.markdown(rows) if options.markdown else table.plain(rows))
    if len({scene.material for scene in scenes}) > 1:
        command.note(f"The scenes differ in alpha or E*; the hatched part is that of {scenes[0].name}.")


def read_scene(path: Path) -> Scene:
    """A scene from its result and its summary, whichever is named; the result holds the resolved input."""
    stem = path.name.removesuffix(SUMMARY_ENDING).removesuffix(".rattle")
    result_path = path.with_name(f"{stem}.rattle")
    summary_path = path.with_name(f"{stem}{SUMMARY_ENDING}")
    if path.name.endswith(SUMMARY_ENDING) and not result_path.exists():
        raise command.CommandError(
            f"{path} does not hold the contact of its scene, and {result_path}, which would, does not exist."
        )
    result = rattle.read(result_path)
    result.require_task("motion")
    summary = rattle.read_summary(summary_path) if summary_path.exists() else {}
    return new_scene(result.scene_name, result.input, summary)


def new_scene(name: str, groups: Mapping[str, Mapping[str, Any]], summary: Mapping[str, Any]) -> Scene:
    """The contact of a resolved input."""

    def number(group: str, key: str) -> float:
        value = groups.get(group, {}).get(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise command.CommandError(
                f"{name} has no number as {group}.{key}: its place on the map is unknown."
            )
        return float(value)

    contact, kinematics = groups.get("contact", {}), groups.get("kinematics", {})
    if "radius" in contact:
        radius = number("contact", "radius")
    else:
        radius = kernels.equivalent_radius(number("contact", "radius_1"), number("contact", "radius_2"))
    if "entrainment_speed" in kinematics:
        speed = number("kinematics", "entrainment_speed")
    elif "rolling_speed" in kinematics:
        speed = number("kinematics", "rolling_speed") / 2.0
    else:
        speed = (number("kinematics", "surface_speed_1") + number("kinematics", "surface_speed_2")) / 2.0
    modulus = kernels.plane_strain_modulus(
        number("contact", "young_modulus"), number("contact", "poisson_ratio")
    )
    weight = number("load", "mass") * number("load", "gravity")
    given = groups["load"].get("force_amplitudes")
    amplitudes = np.atleast_1d(number("load", "force_amplitude") if given is None else given)
    return Scene(
        name,
        radius,
        number("contact", "length"),
        speed,
        number("lubricant", "viscosity"),
        Material(number("lubricant", "pressure_viscosity"), modulus),
        number("load", "steady_force") + groups["load"].get("force_mean", 0.0) + weight,
        sum(amplitudes) * groups["load"].get("force_scale", 1.0),
        summary,
    )


def table_rows(scenes: Sequence[Scene]) -> list[list[str]]:
    """Rows of text, one for each scene."""
    rows = [
        [
            "scene",
            "load [N]",
            "g_v",
            "g_e",
            "regime of the map",
            "its film [um]",
            "Grubin (33) [um]",
            "applies",
        ]
    ]
    rows[0].append("steady film [um]")
    for scene in scenes:
        g_v, g_e = scene.groups(scene.load)
        unit = 1e6 * scene.film_per_parameter()
        grubin = 1e6 * scene.grubin_film()
        films = kernels.limiting_films(g_v, g_e)
        steady = scene.summary.get("steady_film")
        rows.append(
            [
                scene.name,
                f"{scene.load:.4g}",
                f"{g_v:.3g}",
                f"{g_e:.3g}",
                kernels.MAP_REGIMES[kernels.mapped_regime(g_v, g_e)],
                f"{unit * max(films):.4g}",
                f"{grubin:.4g}",
                "yes" if grubin_applies(np.array(grubin / unit), np.array(g_v), np.array(g_e)) else "no",
                "-" if steady is None else f"{1e6 * float(steady):.4g}",
            ]
        )
    return rows


def grubin_applies(film: np.ndarray, g_v: np.ndarray, g_e: np.ndarray) -> np.ndarray:
    """Whether the contact is elastic and piezo-viscous by the map, and by Grubin's own film too.

    film: Grubin's, as the film parameter of the map; it must exceed the other three limits.
    """
    others = kernels.limiting_films(g_v, g_e)[:3]
    elastic = kernels.mapped_regime(g_v, g_e) == kernels.MAP_REGIMES.index("piezo-viscous elastic")
    return elastic & (film > np.maximum.reduce(others))


def grubin_parameter(material: Material, g_v: np.ndarray, g_e: np.ndarray) -> np.ndarray:
    """Grubin's film as the film parameter of the map, at points of the map.

    With alpha E* given, the two groups fix load and speed: g_v/g_e = alpha E* sqrt(W/(l E* R)). All else is
    a matter of units, so R, l and U are set to one.
    """
    modulus, alpha = material.modulus, material.pressure_viscosity
    load = modulus * (g_v / (g_e * alpha * modulus)) ** 2
    viscosity = (load / g_e) ** 2 / modulus
    one = {"radius": 1.0, "speed": 1.0, "viscosity": viscosity}
    film = kernels.grubin_film(**one, length=1.0, pressure_viscosity=alpha, modulus=modulus, load=load)
    return kernels.film_parameter(**one, line_load=load, film=film)


def draw(scenes: Sequence[Scene]) -> Figure:
    """The map; scenes at their static load, with the range of the applied force as a line."""
    if len(scenes) > len(MARKERS):
        raise command.CommandError(f"The map shows {len(MARKERS)} scenes at most; {len(scenes)} were given.")
    material = scenes[0].material if scenes else STEEL_AND_OIL
    figure = Figure(figsize=(style.WIDTH, 5.4))
    axes = figure.subplots()
    axes.set_xscale("log")
    axes.set_yscale("log")
    _set_limits(axes, scenes)
    (least_e, largest_e), (least_v, largest_v) = axes.get_xlim(), axes.get_ylim()
    g_e, g_v = np.geomspace(least_e, largest_e, NODES), np.geomspace(least_v, largest_v, NODES)
    grid_e, grid_v = np.meshgrid(g_e, g_v)
    films = kernels.limiting_films(grid_v, grid_e)
    _draw_regimes(axes, grid_e, grid_v, films)
    applies = grubin_applies(grubin_parameter(material, grid_v, grid_e), grid_v, grid_e)
    hatched = axes.contourf(grid_e, grid_v, applies, levels=(0.5, 1.5), colors="none", hatches=(HATCH,))
    hatched.set(edgecolor=style.FAINT_COLOUR, linewidth=0.0, hatch_linewidth=0.5)
    handles = [
        _draw_scene(axes, scene, position, _covered(scenes, position))
        for position, scene in enumerate(scenes)
    ]
    if scenes:
        handles.append(Line2D([], [], color=style.FORCE_COLOUR, linewidth=1.0, label="range of $F + m g$"))
    handles.append(
        Patch(facecolor=FILLS[3], edgecolor=style.FAINT_COLOUR, hatch=HATCH, label="Grubin (33) applies")
    )
    handles.append(
        Line2D([], [], color=style.FAINT_COLOUR, linewidth=0.6, label=r"film $h_0 W/(l \eta_0 U R)$")
    )
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    axes.set_xlabel(r"Elasticity group $g_e = (W/l)/\sqrt{\eta_0 U E^* R}$ [-]")
    axes.set_ylabel(r"Viscosity group $g_v = \alpha \sqrt{(W/l)^3/(\eta_0 U R^2)}$ [-]")
    alpha = style.power_words(material.pressure_viscosity, r"\alpha")
    axes.set_title(
        "Lubrication regimes of line contacts, after Johnson (1970)\n"
        rf"Hatched for {alpha} Pa$^{{-1}}$, "
        rf"$E^* = {1e-9 * material.modulus:.4g}$ GPa; $U$ is the entrainment speed"
    )
    return figure


def _set_limits(axes: Axes, scenes: Sequence[Scene]) -> None:
    """The part of the map where the four regimes meet, and all scenes."""
    groups = [scene.groups(scene.load) for scene in scenes]
    axes.set_ylim(
        min([0.3, *(0.3 * g_v for g_v, _ in groups)]), max([3e3, *(3.0 * g_v for g_v, _ in groups)])
    )
    axes.set_xlim(
        min([0.05, *(0.3 * g_e for _, g_e in groups)]), max([50.0, *(3.0 * g_e for _, g_e in groups)])
    )


def _draw_regimes(axes: Axes, g_e: np.ndarray, g_v: np.ndarray, films: tuple[np.ndarray, ...]) -> None:
    code = kernels.mapped_regime(g_v, g_e)
    axes.contourf(g_e, g_v, code, levels=(0.5, 1.5, 2.5, 3.5, 4.5), colors=FILLS)
    highest = np.maximum.reduce(films)
    levels = [6.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0]
    lines = axes.contour(g_e, g_v, highest, levels=levels, colors=style.FAINT_COLOUR, linewidths=0.6)
    axes.clabel(lines, fontsize=7, fmt="%g")
    # A border is where two films are equal and none is larger.
    for first, second in combinations(films, 2):
        ruling = np.maximum(first, second) >= 0.999 * highest
        difference = np.where(ruling, np.log(first / second), np.nan)
        axes.contour(g_e, g_v, difference, levels=(0.0,), **BORDER)
    for regime, (across, up) in enumerate(PLACES, 1):
        columns = np.flatnonzero((code == regime).any(axis=0))
        if columns.size:
            column = columns[int(across * (columns.size - 1))]
            rows = np.flatnonzero(code[:, column] == regime)
            place = (g_e[0, column], g_v[rows[int(up * (rows.size - 1))], 0])
            name = axes.annotate(kernels.MAP_REGIMES[regime], place, ha="center", va="center", fontsize=8.5)
            name.set_path_effects(style.HALO)


def _covered(scenes: Sequence[Scene], position: int) -> int:
    """How many later scenes lie on this one and would hide it."""
    own = scenes[position].groups(scenes[position].load)
    return sum(np.allclose(own, scene.groups(scene.load), rtol=0.02) for scene in scenes[position + 1 :])


def _draw_scene(axes: Axes, scene: Scene, position: int, covered: int) -> Line2D:
    """The place of a scene; one that others cover is drawn larger."""
    colour = style.RUN_COLOURS[position]
    low = max(scene.load - scene.force_amplitude, 1e-6 * scene.load)
    ends = [scene.groups(load) for load in (low, scene.load + scene.force_amplitude)]
    width = 1.0 + 1.8 * covered
    axes.plot([g_e for _, g_e in ends], [g_v for g_v, _ in ends], color=colour, linewidth=width, zorder=3)
    g_v, g_e = scene.groups(scene.load)
    size = 7.0 + 5.0 * covered
    marker = {"marker": MARKERS[position], "color": colour, "markeredgecolor": "white", "markersize": size}
    axes.plot(g_e, g_v, linestyle="", zorder=4, **marker)
    return Line2D([], [], linestyle="", label=scene.name, **(marker | {"markersize": 7.0}))
