"""The Fortran kernels for numpy arrays.

The arguments called "arrays" are numpy arrays of float64 of one common shape, any shape at all; a Python
float, or an array without dimensions, stands for that number everywhere. Results are arrays of that shape, or
floats where all arguments are. Everything else raises: another type TypeError (lists, integers, float32,
other byte orders, masked arrays; nothing is cast), another shape or a value outside its range ValueError. NaN
gives NaN in all that depends on it and nowhere else. Arguments are never written to.

The equations are those of the paper in their corrected form, unless a name says published. SI units, angles
in radians, '-' for pure numbers. The groups: h* = h0/R, w* = w/u, u* = u eta0 alpha/R, A = 4 w*/sqrt(2 h*),
and B = 6 sqrt(2) u*/h*^(3/2), so that alpha p = B p*. In the exact film u is the sum u1 + u2 of the surface
speeds, in the published one the entrainment speed; w = dh0/dt is negative on approach.
"""

from __future__ import annotations

from rattle.kernels.film_fit import (
    PUBLISHED_FILM_LAW,
    FilmFit,
    FilmLaw,
    FilmPoints,
    LawError,
    fit_film_law,
    judge_film_law,
    law_film_ratio,
    sample_film_window,
)
from rattle.kernels.films import (
    barus_pressure,
    critical_pressure_group,
    half_pi_rupture_load,
    iso_viscous_load,
    limiting_film_ratio,
    piezo_viscous_load,
    pressure_group,
    pressure_scale,
    published_piezo_load,
    published_stiffness_damping,
    reynolds_iso_viscous_load,
    reynolds_piezo_viscous_load,
    rupture_angle,
    rupture_tangent,
    rupture_tangent_slope,
    solved_rupture_load,
    squeeze_group,
)
from rattle.kernels.numerical_reynolds import (
    REYNOLDS_STATUS,
    VISCOSITY_LAWS,
    FilmScales,
    ReynoldsFilm,
    scale_film,
    solve_reynolds,
)
from rattle.kernels.regime import (
    FILM_REGIMES,
    MAP_REGIMES,
    contact_deflection,
    elasticity_group,
    equivalent_radius,
    film_parameter,
    film_regime,
    grubin_film,
    limiting_films,
    mapped_regime,
    plane_strain_modulus,
    viscosity_group,
)
from rattle.kernels.spectrum import (
    CLASSES,
    amplitude_spectrum,
    classify,
    lines,
)

__all__ = [
    "CLASSES",
    "FILM_REGIMES",
    "MAP_REGIMES",
    "PUBLISHED_FILM_LAW",
    "REYNOLDS_STATUS",
    "VISCOSITY_LAWS",
    "FilmFit",
    "FilmLaw",
    "FilmPoints",
    "FilmScales",
    "LawError",
    "ReynoldsFilm",
    "amplitude_spectrum",
    "barus_pressure",
    "classify",
    "contact_deflection",
    "critical_pressure_group",
    "elasticity_group",
    "equivalent_radius",
    "film_parameter",
    "film_regime",
    "fit_film_law",
    "grubin_film",
    "half_pi_rupture_load",
    "iso_viscous_load",
    "judge_film_law",
    "law_film_ratio",
    "limiting_film_ratio",
    "limiting_films",
    "lines",
    "mapped_regime",
    "piezo_viscous_load",
    "plane_strain_modulus",
    "pressure_group",
    "pressure_scale",
    "published_piezo_load",
    "published_stiffness_damping",
    "reynolds_iso_viscous_load",
    "reynolds_piezo_viscous_load",
    "rupture_angle",
    "rupture_tangent",
    "rupture_tangent_slope",
    "sample_film_window",
    "scale_film",
    "solve_reynolds",
    "solved_rupture_load",
    "squeeze_group",
    "viscosity_group",
]
