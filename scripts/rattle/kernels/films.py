"""The film, iso- and piezo-viscous: exact rupture, pressure and load from Reynolds' equation, and the loads,
stiffness and damping that the paper prints."""

from __future__ import annotations

from typing import Any

from rattle.kernels._calls import Numbers, elementwise, evaluate


def rupture_tangent(a: Numbers, *, solver: str = "fast") -> Any:
    """Tangent t_e of the rupture angle, eq (18).

    Parameters
    ----------
    a
        Squeeze group A [-].
    solver
        'fast' sums tables, with an error below ``1e-13 max(1, |t_e|)`` for every finite A, and NaN for an
        infinite one; 'successive' is the paper's successive substitution to the same root, for comparison.

    Returns
    -------
    tangent
        t_e = tan x_e [-].

    Raises
    ------
    ValueError
        The solver has another name.
    """
    if solver not in ("fast", "successive"):
        raise ValueError(f"solver must be 'fast' or 'successive', not {solver!r}")
    return evaluate("rupture_tangent" if solver == "fast" else "rupture_tangent_successive", {"a": a})


@elementwise
def rupture_angle(a: Numbers) -> Any:
    """Angle x_e at which the film ruptures, eq (18).

    Its error is below 1e-13.

    Parameters
    ----------
    a
        Squeeze group A [-].

    Returns
    -------
    angle
        x_e [rad]; NaN for an infinite A.
    """


@elementwise
def rupture_tangent_slope(a: Numbers) -> Any:
    """Slope of the tangent of the rupture angle, eq (18).

    Its relative error is below 1e-13.

    Parameters
    ----------
    a
        Squeeze group A [-].

    Returns
    -------
    slope
        dt_e/dA [-].
    """


@elementwise
def iso_viscous_load(a: Numbers) -> tuple[Any, Any]:
    """Load of the iso-viscous film and its slope, eq (21) corrected.

    W = 12 l u eta0 R/h0 Phi(A). Relative errors are below 1e-13 for every finite A (both underflow to zero
    beyond A = 1e100); infinite A gives NaN.

    Parameters
    ----------
    a
        Squeeze group A [-].

    Returns
    -------
    load, slope
        Phi [-] and dPhi/dA [-].

    Examples
    --------
    >>> load, slope = rattle.kernels.iso_viscous_load(0.0)
    >>> f"{load:.4f}"
    '0.2040'
    """


@elementwise
def piezo_viscous_load(a: Numbers, b: Numbers) -> tuple[Any, Any, Any]:
    """Load of the film of Barus oil and its slopes, eqs (19) and (31).

    W = 12 l u eta0 R/h0 Psi(A, B). There is a film for 0 <= B < B_crit(A); every other B gives NaN. The
    relative error of Psi is below 1e-10 up to 0.999 B_crit and 1e-6 up to 0.999999 B_crit, that of the
    slopes below 1e-8 up to 0.99 B_crit.

    Parameters
    ----------
    a, b
        Squeeze group A and pressure group B [-].

    Returns
    -------
    load, squeeze_slope, pressure_slope
        Psi, dPsi/dA and dPsi/dB [-].
    """


@elementwise
def critical_pressure_group(a: Numbers) -> Any:
    """Pressure group from which on no rigid piezo-viscous film exists.

    There alpha p_max = B/B_crit of eq (31) has reached one. B_crit grows with A^3: beyond A = 3.4e102 it is
    above the largest number of its kind, and infinite. Its relative error is below 1e-13.

    Parameters
    ----------
    a
        Squeeze group A [-].

    Returns
    -------
    group
        B_crit = 1/max p* [-].
    """


@elementwise
def pressure_group(tangent: Numbers, rupture_tangent: Numbers, a: Numbers) -> Any:
    """Pressure of the iso-viscous film over its scale, eq (16).

    It holds between -infinity and t_e; beyond, the film is ruptured and the number means nothing. The error
    is a few epsilon of the largest of its three terms: t_e A on fast approach.

    Parameters
    ----------
    tangent, rupture_tangent, a
        t = tan(xbar), t_e and A [-].

    Returns
    -------
    pressure
        p*(xbar) [-].
    """


@elementwise
def squeeze_group(radius: Numbers, speed: Numbers, film: Numbers, velocity: Numbers) -> Any:
    """Squeeze group A, on which the iso-viscous film depends, eq (18).

    Parameters
    ----------
    radius, speed, film, velocity
        R [m], u [m/s], h0 [m] and w [m/s].

    Returns
    -------
    group
        A = 4 w*/sqrt(2 h*) [-].
    """


@elementwise
def pressure_scale(radius: Numbers, speed: Numbers, viscosity: Numbers, film: Numbers) -> Any:
    """Scale of the pressure, eq (12).

    Parameters
    ----------
    radius, speed, viscosity, film
        R [m], u [m/s], eta0 [Pa s] and h0 [m].

    Returns
    -------
    scale
        p/p* = 6 sqrt(2 R) u eta0 h0^(-3/2) [Pa].
    """


@elementwise
def barus_pressure(alpha_p: Numbers) -> Any:
    """Pressure of Barus oil from the reduced pressure, eq (31).

    Parameters
    ----------
    alpha_p
        alpha p [-].

    Returns
    -------
    alpha_q
        alpha q = -ln(1 - alpha p) [-]; NaN from alpha p = 1 on.
    """


@elementwise
def reynolds_iso_viscous_load(
    film: Numbers, velocity: Numbers, *, radius: Numbers, length: Numbers, speed: Numbers, viscosity: Numbers
) -> tuple[Any, Any, Any]:
    """Load of the Reynolds iso-viscous film, W = 12 l u eta0 R/h Phi(A), and its slopes.

    The slopes are total: x_e moves with h and w. Relative errors are below 1e-12, down to where a number
    underflows (dW/dh: beyond A = 1e77); a film that is not positive gives NaN.

    Parameters
    ----------
    film, velocity
        h [m] and w [m/s].
    radius, length, speed, viscosity
        R [m], l [m], u [m/s] and eta0 [Pa s].

    Returns
    -------
    load, film_slope, velocity_slope
        W [N], dW/dh [N/m] and dW/dw [N s/m].
    """


@elementwise
def reynolds_piezo_viscous_load(
    film: Numbers,
    velocity: Numbers,
    *,
    radius: Numbers,
    length: Numbers,
    speed: Numbers,
    viscosity: Numbers,
    pressure_viscosity: Numbers,
) -> tuple[Any, Any, Any]:
    """Load of the Reynolds piezo-viscous film, W = 12 l u eta0 R/h Psi(A, B), and its slopes.

    The slopes are total. Relative errors are below 1e-12 up to 0.99 B_crit, growing as 1e-15/(1 - B/B_crit)
    from there on. NaN where there is no rigid film.

    Parameters
    ----------
    film, velocity
        h [m] and w [m/s].
    radius, length, speed, viscosity
        R [m], l [m], u [m/s] and eta0 [Pa s].
    pressure_viscosity
        alpha [1/Pa].

    Returns
    -------
    load, film_slope, velocity_slope
        W [N], dW/dh [N/m] and dW/dw [N s/m].
    """


@elementwise
def limiting_film_ratio(speed_group: Numbers, squeeze_ratio: Numbers) -> Any:
    """Film at which alpha p_max = 1, eq (31).

    alpha p_max of that film is one to 1e-12, and the film as exact as that makes it: where it separates
    fast, alpha p_max changes by 1/A^2 only between films of twice the thickness.

    Parameters
    ----------
    speed_group, squeeze_ratio
        u* > 0 and w* [-].

    Returns
    -------
    film_ratio
        h* [-]; NaN where the surfaces separate so fast that alpha p stays below one for every h* above
        1e-15.
    """


@elementwise
def half_pi_rupture_load(
    film: Numbers, velocity: Numbers, *, radius: Numbers, length: Numbers, speed: Numbers, viscosity: Numbers
) -> tuple[Any, Any, Any]:
    """Load of eq (35) as printed, and its slopes: x_e = pi/2, the film can pull.

    A film that is not positive gives NaN.

    Parameters
    ----------
    film, velocity
        h [m] and w [m/s].
    radius, length, speed, viscosity
        R [m], l [m], u [m/s] and eta0 [Pa s].

    Returns
    -------
    load, film_slope, velocity_slope
        W [N], dW/dh [N/m] and dW/dw [N s/m].

    Examples
    --------
    >>> load, _, _ = rattle.kernels.half_pi_rupture_load(
    ...     1e-6, 0.0, radius=0.0127, length=0.01, speed=1.905, viscosity=0.3
    ... )
    >>> f"{load:.1f} N"
    '203.2 N'
    """


@elementwise
def solved_rupture_load(
    film: Numbers, velocity: Numbers, *, radius: Numbers, length: Numbers, speed: Numbers, viscosity: Numbers
) -> tuple[Any, Any, Any]:
    """Load of eq (24) as printed, with x_e of the corrected eq (18), and its slopes.

    The slopes are total: x_e moves with h and w. A film that is not positive gives NaN.

    Parameters
    ----------
    film, velocity
        h [m] and w [m/s].
    radius, length, speed, viscosity
        R [m], l [m], u [m/s] and eta0 [Pa s].

    Returns
    -------
    load, film_slope, velocity_slope
        W [N], dW/dh [N/m] and dW/dw [N s/m].
    """


@elementwise
def published_stiffness_damping(
    film: Numbers, velocity: Numbers, *, radius: Numbers, length: Numbers, speed: Numbers, viscosity: Numbers
) -> tuple[Any, Any]:
    """Stiffness and damping, eqs (26) to (28): eq (24) differentiated with x_e held.

    Positive where they resist. h0^(1/2) of eq (27) is read as h0^(5/2). A film that is not positive gives
    NaN.

    Parameters
    ----------
    film, velocity
        h [m] and w [m/s].
    radius, length, speed, viscosity
        R [m], l [m], u [m/s] and eta0 [Pa s].

    Returns
    -------
    stiffness, damping
        k = -dW/dh [N/m] and c = -dW/dw [N s/m].
    """


@elementwise
def published_piezo_load(
    film: Numbers,
    velocity: Numbers,
    *,
    radius: Numbers,
    length: Numbers,
    speed: Numbers,
    viscosity: Numbers,
    pressure_viscosity: Numbers,
) -> tuple[Any, Any, Any]:
    """Load of eq (37), with the factor l and the velocity in its exponent, and its slopes.

    The exponential is held at exp(550), so an approach faster than 0.78 u has no meaning. A film that is
    not positive gives NaN.

    Parameters
    ----------
    film, velocity
        h [m] and w [m/s].
    radius, length, speed, viscosity
        R [m], l [m], u [m/s] and eta0 [Pa s].
    pressure_viscosity
        alpha [1/Pa].

    Returns
    -------
    load, film_slope, velocity_slope
        W [N], dW/dh [N/m] and dW/dw [N s/m].
    """
