"""Figures 3 and 5: pressure of the iso-viscous and of the piezo-viscous film."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rattle import kernels
from rattle.figures import film_points, style
from rattle.figures.film_points import PAPER_FILM_RATIO, PAPER_SPEED_GROUP, Choice, Curve
from rattle.result import Result, ResultError

SHOWN_SHARE = 0.01  # the contact is shown as far as the reduced pressure exceeds this share of its maximum
MOST_PANELS = 3
REDUCED = {"linewidth": 0.9, "linestyle": (0, (4, 2))}
COLUMNS = ("reduced_pressure", "piezo_viscous_pressure")


def draw_iso_viscous(profiles: Result, choice: Choice) -> Figure:
    """Figure 3: p* of (16) for every squeeze ratio at one film ratio; the speed does not matter."""
    film_ratio = film_points.choose(profiles, "film_ratio", choice.film_ratio, PAPER_FILM_RATIO)
    speed_group = film_points.any_speed_group(profiles, choice)
    fixed = {"film_ratio": film_ratio, "speed_group": speed_group}
    found = film_points.curves(profiles, ["pressure_group"], "coordinate", fixed)
    figure = Figure(figsize=(style.WIDTH, 3.6))
    axes = figure.subplots()
    for curve, colour in zip(found, film_points.colours(found), strict=True):
        angle, group = curve["coordinate"], curve["pressure_group"]
        axes.plot(angle, group, color=colour, label=film_points.squeeze_words(curve.squeeze_ratio))
        axes.plot(angle[-1], 0.0, "o", color=colour, markersize=3.5, clip_on=False, zorder=3)
    axes.plot([], [], "o", color=style.FAINT_COLOUR, markersize=3.5, label=r"rupture $\bar{x}_e$ of (18)")
    film_points.angle_axis(axes)
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel(r"Pressure group $p^*$ [-]")
    axes.legend(title=film_points.SQUEEZE_TITLE, loc="upper right", alignment="left")
    held = film_points.scene_line(profiles, [style.power_words(film_ratio, "h^*")])
    axes.set_title(f"Pressure of the iso-viscous film, (16) corrected\n{held}")
    return figure


def draw_piezo_viscous(profiles: Result, choice: Choice) -> Figure:
    """Figure 5: q of (31) where a rigid film exists; p of (16) for all squeeze ratios; the limit."""
    film_ratio = film_points.choose(profiles, "film_ratio", choice.film_ratio, PAPER_FILM_RATIO)
    alpha = profiles.number("lubricant", "pressure_viscosity")
    if not alpha > 0.0:
        raise ResultError(f"The resolved input in {profiles.path} has no positive pressure_viscosity.")
    groups = _speed_groups(profiles, choice)
    figure = Figure(figsize=(style.WIDTH, 0.7 + 3.0 * len(groups)))
    panels = figure.subplots(len(groups), 1, squeeze=False, sharex=True)[:, 0]
    exists = []
    for axes, speed_group in zip(panels, groups, strict=True):
        fixed = {"film_ratio": film_ratio, "speed_group": speed_group}
        found = film_points.curves(profiles, COLUMNS, "position", fixed)
        peaks = [_peak(film_ratio, curve.squeeze_ratio, speed_group) for curve in found]
        _draw_panel(axes, found, peaks, alpha, choice.narrow)
        axes.set_title(style.power_words(speed_group, "u^*") + _verdict(peaks))
        exists.append(any(peak < 1.0 for peak in peaks))
    for axes, film_exists in zip(panels, exists, strict=True):
        if not choice.narrow:
            _legends(axes, film_exists)
    if choice.narrow:  # one legend, which the figure's width moves below all panels
        _legends(panels[0], any(exists))
    held = film_points.scene_line(profiles, [style.power_words(film_ratio, "h^*")])
    panels[0].set_title(
        f"Pressure of the piezo-viscous film, (31)\n{held}\n{panels[0].get_title(loc='left')}"
    )
    panels[-1].set_xlabel(r"Position $x$ [$\mathrm{\mu}$m]")
    return figure


def _speed_groups(profiles: Result, choice: Choice) -> list[float]:
    """All speed groups, a panel for each, as long as they are few; otherwise the one of the paper."""
    held = np.unique(profiles["speed_group"])
    if choice.speed_group is None and 0 < held.size <= MOST_PANELS:
        return held.tolist()
    return [film_points.choose(profiles, "speed_group", choice.speed_group, PAPER_SPEED_GROUP)]


def _peak(film_ratio: float, squeeze_ratio: float, speed_group: float) -> float:
    """alpha p_max, which no node of a profile need hit. R, eta0 and alpha are one here, so that u is u*."""
    a = kernels.squeeze_group(1.0, 1.0, film_ratio, squeeze_ratio)
    b = kernels.pressure_scale(1.0, speed_group, 1.0, film_ratio)
    return b / kernels.critical_pressure_group(a)


def _draw_panel(
    axes: Axes, found: Sequence[Curve], peaks: Sequence[float], alpha: float, narrow: bool
) -> None:
    for curve, peak, colour in zip(found, peaks, film_points.colours(found), strict=True):
        place = 1e6 * curve["position"]
        axes.plot(place, 1e-6 * curve["reduced_pressure"], color=colour, **REDUCED)
        if peak < 1.0:
            axes.plot(place, 1e-6 * curve["piezo_viscous_pressure"], color=colour)
        ratio = curve.squeeze_ratio
        words = film_points.squeeze_words(ratio) if narrow else _words(ratio, peak, alpha)
        axes.plot([], [], color=colour, label=words)
    limit = 1e-6 / alpha
    axes.axhline(limit, color=style.FORCE_COLOUR, linewidth=0.8, linestyle=(0, (1, 1.5)))
    _scale(axes, found, peaks, limit)
    axes.annotate(
        r"$\alpha p = 1$",
        (0.995, limit),
        xycoords=axes.get_yaxis_transform(),
        xytext=(0, 2),
        textcoords="offset points",
        ha="right",
        va="bottom",
        color=style.FORCE_COLOUR,
        fontsize=8,
    )
    axes.set_ylabel("Pressure [MPa]")


def _words(squeeze_ratio: float, peak: float, alpha: float) -> str:
    """The squeeze ratio, how far its film is from the limit, and the highest pressure."""
    ending = rf"$q \leq {1e-6 * kernels.barus_pressure(peak) / alpha:.0f}$ MPa" if peak < 1.0 else "no film"
    return rf"{film_points.squeeze_words(squeeze_ratio)}: $\alpha p \leq {peak:#.3g}$, {ending}"


def _verdict(peaks: Sequence[float]) -> str:
    """Words for the squeeze ratios without a film."""
    without = sum(peak >= 1.0 for peak in peaks)
    if without == 0:
        return ""
    if without == len(peaks):
        return r": $\alpha p$ exceeds 1, no rigid piezo-viscous film exists"
    return rf": $\alpha p$ exceeds 1 and no rigid film exists at {without} of {len(peaks)} $w^*$"


def _scale(axes: Axes, found: Sequence[Curve], peaks: Sequence[float], limit: float) -> None:
    """Show the part of the contact that carries pressure; the inlet lies at minus infinity."""
    left, right, highest = 0.0, 0.0, 1.0
    for curve, peak in zip(found, peaks, strict=True):
        pressure, place = curve["reduced_pressure"], 1e6 * curve["position"]
        left = min(left, float(place[pressure > SHOWN_SHARE * pressure.max()].min()))
        right = max(right, float(place.max()))
        highest = max(highest, kernels.barus_pressure(peak) if peak < 1.0 else peak)
    axes.set_xlim(left, right + 0.06 * (right - left))
    axes.set_ylim(0.0, 1.06 * highest * limit)


def _legends(axes: Axes, film_exists: bool) -> None:
    first = axes.legend(title=film_points.SQUEEZE_TITLE, loc="upper left", alignment="left")
    axes.add_artist(first)
    handles = [Line2D([], [], color=style.FORCE_COLOUR, **REDUCED)]
    names = ["reduced pressure $p$, (16)"]
    if film_exists:
        handles.append(Line2D([], [], color=style.FORCE_COLOUR))
        names.append("pressure $q$, (31)")
    axes.legend(handles, names, loc="upper left", bbox_to_anchor=(0.0, 0.42))
