"""Figure 3: pressure of the iso-viscous film over the film coordinate."""

from __future__ import annotations

from matplotlib.figure import Figure

from rattle.figures import film_points, style
from rattle.figures.film_points import PAPER_FILM_RATIO, Choice, power_words
from rattle.result import Result


def draw(profiles: Result, choice: Choice) -> Figure:
    """p* of (16) for every squeeze ratio at one film ratio; the group does not depend on the speed."""
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
    held = film_points.scene_line(profiles, [power_words(film_ratio, "h^*")])
    axes.set_title(f"Pressure of the iso-viscous film, (16) corrected\n{held}")
    return figure
