"""Writes the results of film tasks for the tests, with the numbers of the kernels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from kernel_module import kernels
from result_writer import write_result

RADIUS, LENGTH, VISCOSITY, ALPHA = 0.0127, 0.010, 0.3, 2.0e-8
SQUEEZE_RATIOS = (-5e-4, -2.5e-4, 0.0, 2.5e-4, 5e-4)

FILM_INPUT = """&scene
   name = 'film'
   task = '{task}'
/
&contact
   radius = 0.0127
   length = 0.01
/
&lubricant
   viscosity = 0.3
   pressure_viscosity = 2.0E-8
/
"""


POINT_COLUMNS = {
    "film_ratio": "-",
    "squeeze_ratio": "-",
    "speed_group": "-",
    "film_thickness": "m",
    "stiffness_published": "N/m",
    "stiffness_iso_viscous": "N/m",
    "stiffness_piezo_viscous": "N/m",
    "damping_published": "N s/m",
    "damping_iso_viscous": "N s/m",
    "damping_piezo_viscous": "N s/m",
}
PROFILE_COLUMNS = {
    "film_ratio": "-",
    "squeeze_ratio": "-",
    "speed_group": "-",
    "coordinate": "rad",
    "position": "m",
    "pressure_group": "-",
    "reduced_pressure": "Pa",
    "piezo_viscous_pressure": "Pa",
}


def write_points(path: Path, film_ratios: np.ndarray, speed_groups=(0.9e-6,), without: str = "") -> Path:
    """The table of a film task, with the numbers of the kernels."""
    rows = []
    for speed_group in speed_groups:
        speed = speed_group * RADIUS / (VISCOSITY * ALPHA)
        contact = {"radius": RADIUS, "length": LENGTH, "speed": speed, "viscosity": VISCOSITY}
        for squeeze in SQUEEZE_RATIOS:
            state = film_ratios * RADIUS, np.full_like(film_ratios, squeeze * speed)
            published = kernels.published_stiffness_damping(*state, **contact)
            iso = kernels.reynolds_iso_viscous_load(*state, **contact)[1:]
            piezo = kernels.reynolds_piezo_viscous_load(*state, **contact, pressure_viscosity=ALPHA)[1:]
            for position, film_ratio in enumerate(film_ratios):
                pairs = [(published[n][position], -iso[n][position], -piezo[n][position]) for n in (0, 1)]
                rows.append([film_ratio, squeeze, speed_group, film_ratio * RADIUS, *pairs[0], *pairs[1]])
    return _write(path, POINT_COLUMNS, rows, without)


def write_profiles(path: Path, film_ratio: float, speed_groups=(0.9e-6,), without: str = "") -> Path:
    """Pressure profiles of a film task, with the numbers of the kernels."""
    rows = []
    for speed_group in speed_groups:
        scale = kernels.pressure_scale(RADIUS, speed_group * RADIUS / ALPHA, 1.0, film_ratio * RADIUS)
        for squeeze in SQUEEZE_RATIOS:
            a = kernels.squeeze_group(RADIUS, 1.0, film_ratio * RADIUS, squeeze)
            end = kernels.rupture_angle(a)
            angle = np.linspace(-np.pi / 2 + 1e-6, end, 101)
            group = np.maximum(kernels.pressure_group(np.tan(angle), np.tan(end), a), 0.0)
            q = kernels.barus_pressure(ALPHA * scale * group) / ALPHA
            place = np.tan(angle) * np.sqrt(2.0 * film_ratio) * RADIUS
            held = np.broadcast_to([film_ratio, squeeze, speed_group], (angle.size, 3))
            rows += np.column_stack([held, angle, place, group, scale * group, q]).tolist()
    return _write(path, PROFILE_COLUMNS, rows, without)


def _write(path: Path, columns: dict[str, str], rows: list, without: str) -> Path:
    kept = [position for position, name in enumerate(columns) if name != without]
    pairs = [pair for pair in columns.items() if pair[0] != without]
    return write_result(path, pairs, np.asarray(rows)[:, kept], input_text=FILM_INPUT.format(task="film"))
