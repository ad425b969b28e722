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

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from rattle import _kernels

CLASSES = ("quiet", "creep", "idle", "irregular")
MAP_REGIMES = (
    "unknown",
    "iso-viscous rigid",
    "piezo-viscous rigid",
    "iso-viscous elastic",
    "piezo-viscous elastic",
)
FILM_REGIMES = ("unknown", "iso-viscous", "piezo-viscous", "elastohydrodynamic")
VISCOSITY_LAWS = ("constant", "barus", "roelands")
REYNOLDS_STATUS = ("converged", "no_rigid_film", "not_converged", "unresolved")

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

# --- the exact film ------------------------------------------------------------------------------------


def rupture_tangent(a: Any, *, solver: str = "fast") -> Any:
    """t_e = tan x_e [-] of eq (18), for arrays of the squeeze group A [-].

    solver: 'fast' sums tables, with an error below 1e-13 max(1, |t_e|) for every finite A, and NaN for an
    infinite one; 'successive' is the paper's successive substitution to the same root, for comparison.
    """
    if solver not in ("fast", "successive"):
        raise ValueError(f"solver must be 'fast' or 'successive', not {solver!r}")
    return _elementwise(_kernels.wrap_rupture_tangent, int(solver == "successive"), a=a)


def rupture_angle(a: Any) -> Any:
    """x_e [rad] of eq (18), for arrays of the squeeze group A [-]; error below 1e-13, NaN for infinite A."""
    return _elementwise(_kernels.wrap_rupture_angle, a=a)


def rupture_tangent_slope(a: Any) -> Any:
    """dt_e/dA [-] of eq (18), for arrays of the squeeze group A [-]; relative error below 1e-13."""
    return _elementwise(_kernels.wrap_rupture_tangent_slope, a=a)


def iso_viscous_load(a: Any) -> tuple[Any, Any]:
    """Phi [-] and dPhi/dA [-], eq (21) corrected, for arrays of the squeeze group A [-].

    W = 12 l u eta0 R/h0 Phi(A). Relative errors below 1e-13 for every finite A (both underflow to zero beyond
    A = 1e100); infinite A gives NaN.
    """
    return _elementwise(_kernels.wrap_iso_viscous_load, a=a)


def piezo_viscous_load(a: Any, b: Any) -> tuple[Any, Any, Any]:
    """Psi, dPsi/dA, dPsi/dB [-] of Barus oil, eqs (19) and (31), for arrays of the groups A and B [-].

    W = 12 l u eta0 R/h0 Psi(A, B). There is a film for 0 <= B < B_crit(A); every other B gives NaN. Relative
    error of Psi below 1e-10 up to 0.999 B_crit and 1e-6 up to 0.999999 B_crit, of the slopes below 1e-8 up to
    0.99 B_crit.
    """
    return _elementwise(_kernels.wrap_piezo_viscous_load, a=a, b=b)


def critical_pressure_group(a: Any) -> Any:
    """B_crit = 1/max p* [-], for arrays of the squeeze group A [-]; relative error below 1e-13.

    From B_crit on there is no rigid piezo-viscous film: alpha p_max = B/B_crit of eq (31) has reached one.
    """
    return _elementwise(_kernels.wrap_critical_pressure_group, a=a)


def pressure_group(tangent: Any, rupture_tangent: Any, a: Any) -> Any:
    """p*(xbar) [-] of eq (16), for arrays of t = tan(xbar), t_e and A [-].

    Holds between -infinity and t_e; beyond, the film is ruptured and the number means nothing. The error is a
    few epsilon of the largest of its three terms: t_e A on fast approach.
    """
    return _elementwise(_kernels.wrap_pressure_group, tangent=tangent, rupture_tangent=rupture_tangent, a=a)


def squeeze_group(radius: Any, speed: Any, film: Any, velocity: Any) -> Any:
    """A = 4 w*/sqrt(2 h*) [-], the group of eq (18), for arrays of R [m], u [m/s], h0 [m] and w [m/s]."""
    return _elementwise(_kernels.wrap_squeeze_group, radius=radius, speed=speed, film=film, velocity=velocity)


def pressure_scale(radius: Any, speed: Any, viscosity: Any, film: Any) -> Any:
    """p/p* = 6 sqrt(2 R) u eta0 h0^(-3/2) [Pa] of eq (12).

    For arrays of R [m], u [m/s], eta0 [Pa s] and h0 [m].
    """
    return _elementwise(
        _kernels.wrap_pressure_scale, radius=radius, speed=speed, viscosity=viscosity, film=film
    )


def barus_pressure(alpha_p: Any) -> Any:
    """alpha q = -ln(1 - alpha p) [-] of eq (31), for arrays of alpha p [-]; NaN from alpha p = 1 on."""
    return _elementwise(_kernels.wrap_barus_pressure, alpha_p=alpha_p)


def reynolds_iso_viscous_load(
    film: Any, velocity: Any, *, radius: Any, length: Any, speed: Any, viscosity: Any
) -> tuple[Any, Any, Any]:
    """W [N], dW/dh [N/m], dW/dw [N s/m] of the exact iso-viscous film, W = 12 l u eta0 R/h Phi(A).

    The slopes are total: x_e moves with h and w. For arrays of h [m], w [m/s], R [m], l [m], u [m/s],
    eta0 [Pa s]. Relative errors below 1e-12; a film that is not positive gives NaN.
    """
    return _elementwise(
        _kernels.wrap_reynolds_iso_viscous_load,
        film=film,
        velocity=velocity,
        radius=radius,
        length=length,
        speed=speed,
        viscosity=viscosity,
    )


def reynolds_piezo_viscous_load(
    film: Any,
    velocity: Any,
    *,
    radius: Any,
    length: Any,
    speed: Any,
    viscosity: Any,
    pressure_viscosity: Any,
) -> tuple[Any, Any, Any]:
    """W [N], dW/dh [N/m], dW/dw [N s/m] of the exact piezo-viscous film, W = 12 l u eta0 R/h Psi(A, B).

    The slopes are total. Arrays as for `reynolds_iso_viscous_load`, and alpha [1/Pa]; errors as of
    `piezo_viscous_load`. NaN where there is no rigid film.
    """
    return _elementwise(
        _kernels.wrap_reynolds_piezo_viscous_load,
        film=film,
        velocity=velocity,
        radius=radius,
        length=length,
        speed=speed,
        viscosity=viscosity,
        pressure_viscosity=pressure_viscosity,
    )


def limiting_film_ratio(speed_group: Any, squeeze_ratio: Any) -> Any:
    """h* [-] at which alpha p_max = 1, eq (31), for arrays of u* > 0 and w* [-]; relative error below 1e-12.

    NaN where the surfaces separate so fast that alpha p stays below one for every h* between 1e-15 and 1e3.
    """
    return _elementwise(
        _kernels.wrap_limiting_film_ratio, speed_group=speed_group, squeeze_ratio=squeeze_ratio
    )


# --- the film as published -----------------------------------------------------------------------------


def half_pi_rupture_load(
    film: Any, velocity: Any, *, radius: Any, length: Any, speed: Any, viscosity: Any
) -> tuple[Any, Any, Any]:
    """W [N], dW/dh [N/m], dW/dw [N s/m] of eq (35), as printed: x_e = pi/2, the film can pull.

    For arrays of h [m], w [m/s], R [m], l [m], u [m/s], eta0 [Pa s]. A film that is not positive gives NaN.
    """
    return _elementwise(
        _kernels.wrap_half_pi_rupture_load,
        film=film,
        velocity=velocity,
        radius=radius,
        length=length,
        speed=speed,
        viscosity=viscosity,
    )


def solved_rupture_load(
    film: Any, velocity: Any, *, radius: Any, length: Any, speed: Any, viscosity: Any
) -> tuple[Any, Any, Any]:
    """W [N], dW/dh [N/m], dW/dw [N s/m] of eq (24) as printed, with x_e of the corrected eq (18).

    The slopes are total: x_e moves with h and w. Arrays as for `half_pi_rupture_load`.
    """
    return _elementwise(
        _kernels.wrap_solved_rupture_load,
        film=film,
        velocity=velocity,
        radius=radius,
        length=length,
        speed=speed,
        viscosity=viscosity,
    )


def published_stiffness_damping(
    film: Any, velocity: Any, *, radius: Any, length: Any, speed: Any, viscosity: Any
) -> tuple[Any, Any]:
    """k = -dW/dh [N/m] and c = -dW/dw [N s/m], eqs (26) to (28): eq (24) differentiated with x_e held.

    Positive where they resist. h0^(1/2) of eq (27) is read as h0^(5/2). Arrays as for `half_pi_rupture_load`.
    """
    return _elementwise(
        _kernels.wrap_published_stiffness_damping,
        film=film,
        velocity=velocity,
        radius=radius,
        length=length,
        speed=speed,
        viscosity=viscosity,
    )


def published_piezo_load(
    film: Any,
    velocity: Any,
    *,
    radius: Any,
    length: Any,
    speed: Any,
    viscosity: Any,
    pressure_viscosity: Any,
) -> tuple[Any, Any, Any]:
    """W [N], dW/dh [N/m], dW/dw [N s/m] of eq (37), with the factor l and the velocity in its exponent.

    For arrays of h [m], w [m/s], R [m], l [m], u [m/s], eta0 [Pa s], alpha [1/Pa]. The exponential is held at
    exp(550), so an approach faster than 0.78 u has no meaning. A film that is not positive gives NaN.
    """
    return _elementwise(
        _kernels.wrap_published_piezo_load,
        film=film,
        velocity=velocity,
        radius=radius,
        length=length,
        speed=speed,
        viscosity=viscosity,
        pressure_viscosity=pressure_viscosity,
    )


# --- the Reynolds equation solved numerically ----------------------------------------------------------


class FilmScales(NamedTuple):
    """Groups of a film for `solve_reynolds` and the scales that turn its answers into SI units.

    The speed of the scale is v = max(|u|, 4 |w|/sqrt(2 h*)), so u may have either sign or vanish.
    """

    rolling: float  # u/v [-]
    squeeze: float  # 4 (w/v)/sqrt(2 h*) [-]; A where v = u
    pressure_group: float  # alpha times the pressure scale [-]; B where v = u
    roelands_pressure: float  # alpha p_r [-], p_r = 1.96e8 Pa
    roelands_logarithm: float  # ln(eta0/(Pa s)) + 9.67 [-]
    pressure_scale: float  # q/q* [Pa]
    load_scale: float  # W/l over the load group [N/m]


class ReynoldsFilm(NamedTuple):
    """What the grid found; without a solution the numbers are NaN."""

    status: str  # one of REYNOLDS_STATUS
    iterations: int  # Newton steps on the finest grid
    load: float  # W h0/(12 l v eta0 R) [-]; Psi where v = u
    load_correction: float  # what extrapolation changed in the load [-]
    maximum_pressure: float  # largest q* [-]
    rupture_angle: float  # xbar of the rupture [rad]
    angle: np.ndarray  # xbar of the cells + 1 nodes [rad]
    pressure: np.ndarray  # q* there, on the grid, not extrapolated [-]


def scale_film(
    *,
    radius: float,
    film: float,
    speed_sum: float,
    squeeze_velocity: float,
    viscosity: float,
    pressure_viscosity: float,
) -> FilmScales:
    """Groups and scales of one film: R [m], h0 [m], u1 + u2 [m/s], w [m/s], eta0 [Pa s], alpha [1/Pa].

    All finite; R, h0, eta0 positive, alpha not negative.
    """
    numbers = {
        "radius": radius,
        "film": film,
        "speed_sum": speed_sum,
        "squeeze_velocity": squeeze_velocity,
        "viscosity": viscosity,
        "pressure_viscosity": pressure_viscosity,
    }
    for name, number in numbers.items():
        _finite(number, name)
        if name in ("radius", "film", "viscosity") and not number > 0.0:
            raise ValueError(f"{name} must be positive")
    if pressure_viscosity < 0.0:
        raise ValueError("pressure_viscosity must not be negative")
    groups, scales = _kernels.wrap_scale_film(np.array(list(numbers.values())))
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
    """One film by finite volumes: Reynolds equation, Swift-Stieber rupture by complementarity, eqs (6), (17).

    rolling, squeeze, pressure_group: u/v, 4 (w/v)/sqrt(2 h*), alpha times the pressure scale [-], any v > 0.
    Independent of every closed form, and of the reduced pressure of eq (31). With rolling = 1, squeeze = A
    and pressure_group = B its load is Psi(A, B), and Phi(A) for B = 0; the error falls as 1/cells^2, faster
    with `extrapolate` (Richardson, from the grid of half the cells).

    law: viscosity law, one of VISCOSITY_LAWS; 'roelands' reads the two roelands numbers of `scale_film`.
    cells: even, at least 16, with `extrapolate` at least 32. A group that is not finite or beyond 1e100, a
    negative pressure group, and constants outside the range of Roelands' law raise ValueError.
    """
    if law not in VISCOSITY_LAWS:
        raise ValueError(f"law must be one of {', '.join(VISCOSITY_LAWS)}, not {law!r}")
    if not isinstance(extrapolate, bool):
        raise TypeError("extrapolate must be a bool")
    count = _count(cells, "cells")
    if count % 2 or count < (32 if extrapolate else 16):
        raise ValueError("cells must be even and at least 16, or 32 with extrapolate")
    names = ("rolling", "squeeze", "pressure_group", "roelands_pressure", "roelands_logarithm")
    values = (rolling, squeeze, pressure_group, roelands_pressure, roelands_logarithm)
    groups = np.array([_finite(value, name) for name, value in zip(names, values, strict=True)])
    angle, pressure, results, (status, iterations) = _kernels.wrap_solve_reynolds(
        groups, VISCOSITY_LAWS.index(law), int(extrapolate), count + 1
    )
    if status >= len(REYNOLDS_STATUS):
        raise ValueError("a group or a constant of the viscosity law is outside its range")
    return ReynoldsFilm(REYNOLDS_STATUS[status], int(iterations), *results.tolist(), angle, pressure)


# --- the film-thickness regression ---------------------------------------------------------------------


class FilmLaw(NamedTuple):
    """Coefficients of h* = c u*^a Wbar^b exp(s w*), eq (32); Wbar = W h0/(12 l u eta0 R), eq (20)."""

    factor: float  # c [-]
    speed_exponent: float  # a [-]
    load_exponent: float  # b [-]
    squeeze_factor: float  # s [-]


class LawError(NamedTuple):
    """Residuals of a law: its ln h* less that of the points."""

    rms: float  # root mean square [-]
    bias: float  # mean [-]
    maximum: float  # largest absolute one [-]
    r_squared: float  # share of the variance of ln h* that the law explains; negative: worse than the mean


class FilmFit(NamedTuple):
    """A least-squares law; where the points do not determine it, the one of least norm."""

    law: FilmLaw
    error: LawError
    singular_values: np.ndarray  # of the design matrix with columns of unit length, falling, four of them
    condition: float  # ratio of the first to the last of them
    rank: int  # number of coefficients that the points determine
    unique: bool  # whether that is all four


class FilmPoints(NamedTuple):
    """Exact piezo-viscous films, one-dimensional arrays of one length, all pure numbers."""

    speed_group: np.ndarray  # u*
    load_group: np.ndarray  # Wbar of eq (20)
    squeeze_ratio: np.ndarray  # w*
    film_ratio: np.ndarray  # h*


PUBLISHED_FILM_LAW = FilmLaw(*_kernels.wrap_published_film_law().tolist())


def law_film_ratio(law: FilmLaw, speed_group: Any, load_group: Any, squeeze_ratio: Any) -> Any:
    """h* [-] of a law of the form (32), for arrays of u* > 0, Wbar > 0 and w* [-].

    A group that is not positive gives NaN or infinity, as the logarithm has it.
    """
    coefficients = _law(law)

    def kernel(u: np.ndarray, load: np.ndarray, w: np.ndarray) -> np.ndarray:
        return _kernels.wrap_law_film_ratio(coefficients, u, load, w)

    return _elementwise(kernel, speed_group=speed_group, load_group=load_group, squeeze_ratio=squeeze_ratio)


def judge_film_law(
    law: FilmLaw, speed_group: Any, load_group: Any, squeeze_ratio: Any, film_ratio: Any
) -> LawError:
    """Error of a law of the form (32) on given points: `judge_film_law(law, *points)`.

    Four one-dimensional arrays of one length, not empty, finite; u*, Wbar and h* positive.
    """
    points = _points(speed_group, load_group, squeeze_ratio, film_ratio)
    return LawError(*_kernels.wrap_judge_film_law(_law(law), *points).tolist())


def fit_film_law(speed_group: Any, load_group: Any, squeeze_ratio: Any, film_ratio: Any) -> FilmFit:
    """Least squares of ln h* in the form (32), by LAPACK's dgelsd: `fit_film_law(*points)`.

    Four one-dimensional arrays of one length of at least five, finite; u*, Wbar and h* positive.
    """
    points = _points(speed_group, load_group, squeeze_ratio, film_ratio)
    if points[0].size < 5:
        raise ValueError("a fit needs at least five points")
    (status, rank), law, error, conditioning = _kernels.wrap_fit_film_law(*points)
    if status > 1:
        raise np.linalg.LinAlgError("the singular values of the design matrix did not converge")
    values, condition = conditioning[:4], float(conditioning[4])
    return FilmFit(
        FilmLaw(*law.tolist()), LawError(*error.tolist()), values, condition, int(rank), bool(status == 0)
    )


def sample_film_window(
    film_ratio: tuple[float, float],
    squeeze_ratio: tuple[float, float],
    alpha_p: tuple[float, float],
    *,
    film_count: int = 9,
    squeeze_count: int = 9,
    pressure_count: int = 16,
    pressure_factor: float = 1.0,
    load_factor: float = 1.0,
) -> FilmPoints:
    """Exact piezo-viscous films over a window, for `fit_film_law` and `judge_film_law`; errors as of Psi.

    film_ratio: least and largest h* > 0, sampled evenly in its logarithm. squeeze_ratio: of w*. alpha_p: of
    alpha p_max, within 0 to 1, sampled at the centres of equal parts. pressure_factor: 1 for the pressure of
    eq (6) as printed, 1/2 where u* is formed with u1 + u2 and the pressure with the mean. load_factor: Wbar
    over Psi. All pure numbers; a range that is out of order or outside its limits raises ValueError.
    """
    ranges = []
    for name, pair in (("film_ratio", film_ratio), ("squeeze_ratio", squeeze_ratio), ("alpha_p", alpha_p)):
        if not isinstance(pair, tuple) or len(pair) != 2:
            raise TypeError(f"{name} must be a tuple of its least and its largest value")
        ranges += [_finite(value, name) for value in pair]
    counts = [
        _count(film_count, "film_count"),
        _count(squeeze_count, "squeeze_count"),
        _count(pressure_count, "pressure_count"),
    ]
    factors = [_finite(pressure_factor, "pressure_factor"), _finite(load_factor, "load_factor")]
    size = counts[0] * counts[1] * counts[2]
    if size > np.iinfo(np.int32).max:
        raise ValueError(f"a window of {size} films is too large")
    *points, valid = _kernels.wrap_sample_film_window(
        np.array(ranges), np.array(counts, dtype=np.int32), np.array(factors), size
    )
    if not valid:
        raise ValueError(
            "a window needs 0 < h*, 0 <= alpha p <= 1, every range in order and the factors positive"
        )
    return FilmPoints(*points)


# --- contact and regime --------------------------------------------------------------------------------


def equivalent_radius(radius_1: Any, radius_2: Any) -> Any:
    """R [m], 1/R = 1/r1 + 1/r2, eq (2), for arrays of both radii [m]; a hollow one is negative."""
    return _elementwise(_kernels.wrap_equivalent_radius, radius_1=radius_1, radius_2=radius_2)


def plane_strain_modulus(young_modulus: Any, poisson_ratio: Any) -> Any:
    """E* = E/(1 - nu^2) [Pa], eq (3), for arrays of E [Pa] and nu [-]."""
    return _elementwise(
        _kernels.wrap_plane_strain_modulus, young_modulus=young_modulus, poisson_ratio=poisson_ratio
    )


def contact_deflection(radius: Any, pressure: Any, modulus: Any) -> Any:
    """delta = 4 R p^2/E*^2 [m], eq (4), for arrays of R [m], p [Pa] and E* [Pa]."""
    return _elementwise(_kernels.wrap_contact_deflection, radius=radius, pressure=pressure, modulus=modulus)


def grubin_film(
    *,
    radius: Any,
    length: Any,
    speed: Any,
    viscosity: Any,
    pressure_viscosity: Any,
    modulus: Any,
    load: Any,
) -> Any:
    """Elastohydrodynamic film h0 [m] of eq (33), h* = 2.076 u*^0.72 (W/(E* R l))^-0.091.

    For arrays of R [m], l [m], entrainment speed [m/s], eta0 [Pa s], alpha [1/Pa], E* [Pa], W [N], all
    positive. Its load group is its own, not that of eq (20).
    """
    return _elementwise(
        _kernels.wrap_grubin_film,
        radius=radius,
        length=length,
        speed=speed,
        viscosity=viscosity,
        pressure_viscosity=pressure_viscosity,
        modulus=modulus,
        load=load,
    )


def viscosity_group(
    *, radius: Any, speed: Any, viscosity: Any, pressure_viscosity: Any, line_load: Any
) -> Any:
    """g_v = alpha sqrt((W/l)^3/(eta0 U R^2)) [-] of Johnson's regime map.

    For arrays of R [m], entrainment speed U [m/s], eta0 [Pa s], alpha [1/Pa], W/l [N/m].
    """
    return _elementwise(
        _kernels.wrap_viscosity_group,
        radius=radius,
        speed=speed,
        viscosity=viscosity,
        pressure_viscosity=pressure_viscosity,
        line_load=line_load,
    )


def elasticity_group(*, radius: Any, speed: Any, viscosity: Any, modulus: Any, line_load: Any) -> Any:
    """g_e = (W/l)/sqrt(eta0 U E* R) [-] of Johnson's regime map.

    For arrays of R [m], entrainment speed U [m/s], eta0 [Pa s], E* [Pa], W/l [N/m].
    """
    return _elementwise(
        _kernels.wrap_elasticity_group,
        radius=radius,
        speed=speed,
        viscosity=viscosity,
        modulus=modulus,
        line_load=line_load,
    )


def film_parameter(*, radius: Any, speed: Any, viscosity: Any, line_load: Any, film: Any) -> Any:
    """h0 (W/l)/(eta0 U R) [-], the film of Johnson's regime map.

    For arrays of R [m], entrainment speed U [m/s], eta0 [Pa s], W/l [N/m], h0 [m].
    """
    return _elementwise(
        _kernels.wrap_film_parameter,
        radius=radius,
        speed=speed,
        viscosity=viscosity,
        line_load=line_load,
        film=film,
    )


def limiting_films(g_viscosity: Any, g_elasticity: Any) -> tuple[Any, Any, Any, Any]:
    """The four limiting films of Johnson's map [-], in the order of MAP_REGIMES[1:].

    For arrays of g_v and g_e [-]. Films in the form of `film_parameter`: Martin, Blok, Herrebrugh, Dowson.
    """
    return _elementwise(_kernels.wrap_limiting_films, g_viscosity=g_viscosity, g_elasticity=g_elasticity)


def mapped_regime(g_viscosity: Any, g_elasticity: Any) -> Any:
    """Regime of Johnson's map as an index into MAP_REGIMES (int32), for arrays of g_v and g_e [-].

    The limit with the largest film rules; 0 where a group is negative or NaN.
    """
    return _elementwise(_kernels.wrap_mapped_regime, g_viscosity=g_viscosity, g_elasticity=g_elasticity)


def film_regime(alpha_p_maximum: Any, deflection: Any, film: Any) -> Any:
    """Regime of a computed film as an index into FILM_REGIMES (int32).

    For arrays of alpha p_max [-] of the exact pressure, delta [m] of eq (4) and h0 [m]. From alpha p = 1 or
    delta = 0.1 h0 on elastohydrodynamic, from alpha p = 0.1 on piezo-viscous; 0 where a number is negative or
    NaN or the film not positive.
    """
    return _elementwise(
        _kernels.wrap_film_regime, alpha_p_maximum=alpha_p_maximum, deflection=deflection, film=film
    )


# --- spectrum and class --------------------------------------------------------------------------------


def amplitude_spectrum(samples: Any) -> np.ndarray:
    """Single-sided amplitudes a_0 .. a_(n/2) of n equidistant samples, rectangular window.

    samples: one-dimensional, finite, not empty; the amplitudes have their unit.
    """
    flat = _samples(samples, "samples")
    return _kernels.wrap_amplitude_spectrum(flat, flat.size // 2 + 1)


def lines(acceleration: Any, samples_per_period: int) -> np.ndarray:
    """a_n [m/s2]: amplitude of z'' at n f_exc for every n that the samples resolve; n = 1 comes first."""
    return classify(acceleration, samples_per_period)["harmonics"]


def classify(
    acceleration: Any,
    samples_per_period: int,
    *,
    line_threshold: float = 0.01,
    idle_lines: int = 20,
    quiet_limit: float = 0.35,
    irregular_limit: float = 0.01,
    noise_floor: float = 0.0,
) -> dict[str, Any]:
    """Class of a window of whole periods of z'' [m/s2], with the measures it rests on.

    noise_floor [m/s2]: a motion whose rms times sqrt(2) does not exceed it is at rest. A motion at rest is
    quiet and has no ratios: these are nan then.
    """
    samples = _samples(acceleration, "acceleration")
    period = _count(samples_per_period, "samples_per_period")
    if period < 3 or samples.size % period:
        raise ValueError(
            f"acceleration holds {samples.size} samples; that is no whole number of periods of {period}"
        )
    limits = np.array([line_threshold, quiet_limit, irregular_limit, noise_floor], dtype=np.float64)
    harmonics, ratios, counts = _kernels.wrap_classify(
        samples, samples.size // period, limits, _count(idle_lines, "idle_lines"), (period - 1) // 2
    )
    moving = bool(counts[2])
    return {
        "rattle_class": CLASSES[counts[0] - 1],
        "line_count": int(counts[1]),
        "harmonic_distortion": float(ratios[0]) if moving else float("nan"),
        "irregular_fraction": float(ratios[1]) if moving else float("nan"),
        "reversals_per_period": float(ratios[2]),
        "sampling_sufficient": bool(counts[3]),
        "harmonics": harmonics,
    }


# --- the border between numpy and Fortran --------------------------------------------------------------


def _array(value: Any, name: str) -> np.ndarray:
    """The value as a float64 array that is not a copy; Python floats are welcome, other types are not."""
    if isinstance(value, float):
        return np.asarray(value, dtype=np.float64)
    if not isinstance(value, np.ndarray) or isinstance(value, np.ma.MaskedArray):
        raise TypeError(f"{name} must be a numpy array of float64 or a float, not {type(value).__name__}")
    if value.dtype != np.float64:
        raise TypeError(f"{name} must be of type float64, not {value.dtype}")
    return value


def _elementwise(kernel: Callable[..., Any], *options: int, **values: Any) -> Any:
    """Call a kernel of flat arrays of equal length for arrays of equal shape; numbers stretch to it."""
    arrays = {name: _array(value, name) for name, value in values.items()}
    first, shape = next(((name, array.shape) for name, array in arrays.items() if array.ndim), ("", ()))
    for name, array in arrays.items():
        if array.ndim and array.shape != shape:
            raise ValueError(f"{name} has shape {array.shape}, {first} has {shape}")
    flat = [np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(-1) for array in arrays.values()]
    empty = 0 in shape
    if empty:  # Fortran is asked for one film, to learn the number and types of the results
        flat = [np.zeros(1) for _ in flat]
    found = kernel(*flat, *options)
    results = tuple(
        (result[:0] if empty else result).reshape(shape) if shape else result[0].item()
        for result in (found if isinstance(found, tuple) else (found,))
    )
    return results if isinstance(found, tuple) else results[0]


def _samples(value: Any, name: str) -> np.ndarray:
    """A contiguous, finite, one-dimensional float64 array with at least one sample."""
    array = _array(value, name)
    if array.ndim != 1 or array.size == 0:
        raise ValueError(f"{name} must be one-dimensional and not empty, its shape is {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} holds values that are not finite")
    return np.ascontiguousarray(array)


def _points(speed_group: Any, load_group: Any, squeeze_ratio: Any, film_ratio: Any) -> list[np.ndarray]:
    """Four sample arrays of one length, groups positive."""
    names = ("speed_group", "load_group", "squeeze_ratio", "film_ratio")
    values = (speed_group, load_group, squeeze_ratio, film_ratio)
    points = [_samples(value, name) for name, value in zip(names, values, strict=True)]
    for name, array in zip(names, points, strict=True):
        if array.size != points[0].size:
            raise ValueError(f"{name} has {array.size} points, speed_group has {points[0].size}")
        if name != "squeeze_ratio" and not (array > 0.0).all():
            raise ValueError(f"{name} must be positive")
    return points


def _law(law: FilmLaw) -> np.ndarray:
    """The coefficients of a law, all finite, the factor positive."""
    if not isinstance(law, FilmLaw):
        raise TypeError(f"law must be a FilmLaw, not {type(law).__name__}")
    coefficients = np.array([_finite(value, name) for name, value in law._asdict().items()])
    if not coefficients[0] > 0.0:
        raise ValueError("factor must be positive")
    return coefficients


def _finite(value: Any, name: str) -> float:
    """One finite float."""
    if not isinstance(value, float):
        raise TypeError(f"{name} must be a float, not {type(value).__name__}")
    if not np.isfinite(value):
        raise ValueError(f"{name} must be finite")
    return value


def _count(value: Any, name: str) -> int:
    """One positive integer that Fortran can hold."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise TypeError(f"{name} must be an integer, not {type(value).__name__}")
    if not 1 <= value <= np.iinfo(np.int32).max - 1:
        raise ValueError(f"{name} must be a positive number below 2^31 - 1")
    return int(value)
