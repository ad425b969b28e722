"""Reynolds' equation solved numerically, a reference solution for every closed form."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rattle import _kernels
from rattle.kernels._calls import finite_numbers, positive_count

VISCOSITY_LAWS = ("constant", "barus", "roelands")
REYNOLDS_STATUS = ("converged", "no_rigid_film", "not_converged", "unresolved")


class FilmScales(NamedTuple):
    """Groups of a film for `solve_reynolds` and the scales that turn its answers into SI units.

    The speed of the scale is ``v = max(|u|, 4 |w|/sqrt(2 h*))``, so u may have either sign or vanish.
    """

    rolling: float  #: u/v [-]
    squeeze: float  #: 4 (w/v)/sqrt(2 h*) [-]; A where v = u
    pressure_group: float  #: alpha times the pressure scale [-]; B where v = u
    roelands_pressure: float  #: alpha p_r [-], p_r = 1.96e8 Pa
    roelands_logarithm: float  #: ln(eta0/(Pa s)) + 9.67 [-]
    pressure_scale: float  #: q/q* [Pa]
    load_scale: float  #: W/l over the load group [N/m]


class ReynoldsFilm(NamedTuple):
    """What the grid found; without a solution the numbers are NaN."""

    status: str  #: one of REYNOLDS_STATUS
    iterations: int  #: Newton steps on the finest grid
    load: float  #: W h0/(12 l v eta0 R) [-]; Psi where v = u
    load_correction: float  #: what extrapolation changed in the load [-]
    maximum_pressure: float  #: largest q* [-]
    rupture_angle: float  #: xbar of the rupture [rad]
    angle: np.ndarray  #: xbar of the cells + 1 nodes [rad]
    pressure: np.ndarray  #: q* there, on the grid, not extrapolated [-]


def scale_film(
    *,
    radius: float,
    film: float,
    speed_sum: float,
    squeeze_velocity: float,
    viscosity: float,
    pressure_viscosity: float,
) -> FilmScales:
    """Groups and scales of one film.

    Parameters
    ----------
    radius, film
        R and h0 [m], positive.
    speed_sum, squeeze_velocity
        u1 + u2 and w [m/s].
    viscosity
        eta0 [Pa s], positive.
    pressure_viscosity
        alpha [1/Pa], not negative.

    Returns
    -------
    scales
        What `solve_reynolds` takes, and what turns its answers into SI units.

    Raises
    ------
    ValueError
        A number is not finite or outside its range.
    """
    numbers = finite_numbers(
        positive=("radius", "film", "viscosity"),
        radius=radius,
        film=film,
        speed_sum=speed_sum,
        squeeze_velocity=squeeze_velocity,
        viscosity=viscosity,
        pressure_viscosity=pressure_viscosity,
    )
    if pressure_viscosity < 0.0:
        raise ValueError("pressure_viscosity must not be negative")
    groups, scales = _kernels.wrap_scale_film(numbers)
    return FilmScales(*groups.tolist(), *scales.tolist())


def solve_reynolds(
    rolling: float,
    squeeze: float,
    pressure_group: float = 0.0,
    *,
    law: str = "barus",
    roelands_pressure: float = 0.0,
    roelands_logarithm: float = 0.0,
    cells: int = 1024,
    extrapolate: bool = True,
) -> ReynoldsFilm:
    """One film by finite volumes: Reynolds' equation, rupture by complementarity, eqs (6) and (17).

    Independent of every closed form, and of the reduced pressure of eq (31). With rolling = 1, squeeze = A
    and pressure_group = B its load is Psi(A, B), and Phi(A) for B = 0; the error falls as 1/cells^2, faster
    with `extrapolate`.

    Parameters
    ----------
    rolling, squeeze
        u/v and 4 (w/v)/sqrt(2 h*) [-], any v > 0.
    pressure_group
        alpha times the pressure scale [-], not negative.
    law
        Viscosity law, one of VISCOSITY_LAWS.
    roelands_pressure, roelands_logarithm
        Constants of Roelands' law [-], as `scale_film` has them; other laws do not read them.
    cells
        Cells of the grid, even, at least 16, with `extrapolate` at least 32.
    extrapolate
        Whether the load is extrapolated from the grid of half the cells (Richardson).

    Returns
    -------
    film
        What the grid found.

    Raises
    ------
    ValueError
        A group is not finite or beyond 1e100, or a constant outside the range of its law.
    """
    if law not in VISCOSITY_LAWS:
        raise ValueError(f"law must be one of {', '.join(VISCOSITY_LAWS)}, not {law!r}")
    if not isinstance(extrapolate, bool):
        raise TypeError("extrapolate must be a bool")
    count = positive_count(cells, "cells")
    if count % 2 or count < (32 if extrapolate else 16):
        raise ValueError("cells must be even and at least 16, or 32 with extrapolate")
    groups = finite_numbers(
        rolling=rolling,
        squeeze=squeeze,
        pressure_group=pressure_group,
        roelands_pressure=roelands_pressure,
        roelands_logarithm=roelands_logarithm,
    )
    angle, pressure, results, (status, iterations) = _kernels.wrap_solve_reynolds(
        groups, VISCOSITY_LAWS.index(law), int(extrapolate), count + 1
    )
    if status >= len(REYNOLDS_STATUS):
        raise ValueError("a group or a constant of the viscosity law is outside its range")
    numbers = dict(zip(ReynoldsFilm._fields[2:6], results.tolist(), strict=True))
    return ReynoldsFilm(REYNOLDS_STATUS[status], int(iterations), **numbers, angle=angle, pressure=pressure)
