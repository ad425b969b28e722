"""A motion as moving pictures: the tooth between its flanks with both films, their loads and pressures."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from PIL import Image

from rattle.figures import profiles, style
from rattle.figures.histories import FILM, FLANK_LINES, FLANK_LOADS, LOAD_LABEL, last_periods, time_label
from rattle.outputs import Writer
from rattle.result import TIME, Result

FRAMES, SECONDS = 100, 10.0
OIL, STEEL, TOOTH = "#F0C04C", "#B8B8B8", "#6F8FAF"
THICK = 0.4  # of the tooth as drawn, in gaps
INCH_DOTS = 100


def moving_pictures(result: Result, label: str) -> Writer:
    """Writes a GIF of the last periods: one, or all that the motion repeats after, ten seconds for each."""
    periods = result.orbit_period or 1
    figure, show = _picture(result, label, periods)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    figure.set_layout_engine("none")  # what was laid out once stays where it is
    frames = []
    for moment in np.arange(FRAMES * periods) / (FRAMES * periods):
        show(moment)
        canvas.draw()
        frames.append(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB").quantize(64))

    def write(path: Path) -> None:
        step = round(1e3 * SECONDS / FRAMES)
        frames[0].save(path, format="GIF", save_all=True, append_images=frames[1:], duration=step, loop=0)

    return write


def _picture(result: Result, label: str, periods: int) -> tuple[Figure, Callable[[float], None]]:
    """The figure, and what moves it to a share of its periods."""
    time, films = last_periods(result, FILM, periods, 1e6)
    backlash = result.input.get("contact", {}).get("backlash") or 0.0
    both = backlash > 0.0
    gap = 1e6 * backlash if both else 1.6 * films.max()
    shown = profiles.profiles_of(result)
    figure = Figure(figsize=(style.WIDTH, 5.4 if shown else 3.4), dpi=INCH_DOTS)
    if shown:
        panels = figure.subplot_mosaic([["gap", "loads"], ["contact", "contact"]], width_ratios=(2, 3))
        left, right = panels["gap"], panels["loads"]
        span = periods / result.frequency
        show_contact = _contact(panels["contact"], shown, float(result[TIME][-1]) - span, span)
    else:
        left, right = figure.subplots(1, 2, width_ratios=(2, 3))
    tooth, oil = _gap(left, gap, both)
    loads = [name for name in FLANK_LOADS if name in result]
    curves: dict[str, str | None] = dict(zip(loads, ("drive flank", "coast flank"), strict=False))
    curves = curves or {"acceleration": None}
    for (name, words), line in zip(curves.items(), FLANK_LINES, strict=False):
        right.plot(*last_periods(result, name, periods), label=words, **line)
    right.set_ylabel(LOAD_LABEL if loads else style.of_acceleration(style.ACCELERATION_LABEL, [result]))
    right.set_xlabel(time_label([result], periods).partition(", from")[0])
    right.set_xlim(0.0, time[-1])
    if loads:
        right.legend(loc="upper right")
    now = right.axvline(0.0, color="black", linewidth=0.9)
    figure.suptitle(style.title("The tooth in its gap", result, label), x=0.02, ha="left", fontsize=9.5)

    def show(moment: float) -> None:
        film = float(np.interp(moment * time[-1], time, films))
        tooth.set_y(film)
        oil[0].set_height(film)
        if both:
            oil[1].set_y(film + THICK * gap)
            oil[1].set_height(gap - film)
        now.set_xdata([moment * time[-1]] * 2)
        if shown:
            show_contact(moment)

    return figure, show


def _contact(axes: Axes, shown: list[profiles.Profile], start: float, span: float) -> Callable[[float], None]:
    """Pressures over both contacts, and what moves them to a share of the time shown.

    Each flank has its last profile. `start` is where the time shown begins [s], `span` how long it is.
    """
    flanks = sorted({profile.flank for profile in shown})
    lines = {}
    for flank, line in zip(flanks, FLANK_LINES, strict=False):
        (pressure,) = axes.plot([], [], label=profiles.FLANKS[flank], **line)
        (dry,) = axes.plot([], [], color=line["color"], **profiles.DRY)
        lines[flank] = pressure, dry
    axes.plot([], [], color=style.FORCE_COLOUR, label="dry contact (Hertz)", **profiles.DRY)
    highest = max(max(one.pressure.max(), one.dry.max()) for one in shown)
    places = np.concatenate([one.place[one.pressure > profiles.SHOWN_SHARE * highest] for one in shown])
    axes.set_xlim(1.1 * min(places.min(), 0.0), 1.3 * places.max())
    axes.set_ylim(0.0, 1.1 * highest)
    axes.set_ylabel("Pressure [MPa]")
    axes.set_xlabel(r"Position over the contact [$\mathrm{\mu}$m]")
    axes.legend(loc="upper left")

    def show(moment: float) -> None:
        now = start + moment * span
        for flank, (pressure, dry) in lines.items():
            before = [one for one in shown if one.flank == flank]
            one = min(before, key=lambda other: (now - other.time) % span)
            pressure.set_data(*one.curve(one.pressure))
            dry.set_data(*one.dry_curve())

    return show


def _gap(axes: Axes, gap: float, both: bool) -> tuple[Rectangle, list[Rectangle]]:
    """The flanks, with the tooth and the films between them, which are moved."""
    top = gap * (1.0 + THICK)
    axes.add_patch(Rectangle((0.0, -0.25 * gap), 1.0, 0.25 * gap, color=STEEL))
    axes.text(0.5, -0.125 * gap, "drive flank", ha="center", va="center")
    if both:
        axes.add_patch(Rectangle((0.0, top), 1.0, 0.25 * gap, color=STEEL))
        axes.text(0.5, top + 0.125 * gap, "coast flank", ha="center", va="center")
    oil = [axes.add_patch(Rectangle((0.0, 0.0), 1.0, 0.0, color=OIL)) for _ in range(1 + both)]
    tooth = axes.add_patch(Rectangle((0.12, 0.0), 0.76, THICK * gap, color=TOOTH))
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(-0.25 * gap, top + 0.25 * gap * both)
    axes.set_xticks([])
    axes.set_ylabel(r"Film of the drive flank [$\mathrm{\mu}$m]")
    axes.set_yticks(np.linspace(0.0, gap, 5) if both else axes.get_yticks())
    axes.set_yticks([tick for tick in axes.get_yticks() if 0.0 <= tick <= gap * (1.0 + 1e-9)])
    axes.spines["bottom"].set_visible(False)
    return tooth, oil
