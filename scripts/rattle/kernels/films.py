"""The film, iso- and piezo-viscous: exact rupture, pressure and load from Reynolds' equation, and the loads,
stiffness and damping that the paper prints."""

from __future__ import annotations

from typing import Any

from rattle.kernels._calls import elementwise, evaluate


def rupture_tangent(a: Any, *, solver: str = "fast") -> Any:
    """t_e = tan x_e [-] of eq (18), for arrays of the squeeze group A [-].

    solver: 'fast' sums tables, with an error below 1e-13 max(1, |t_e|) for every finite A, and NaN for an
    infinite one; 'successive' is the paper's successive substitution to the same root, for comparison.
    """
    if solver not in ("fast", "successive"):
        raise ValueError(f"solver must be 'fast' or 'successive', not {solver!r}")
    return evaluate("rupture_tangent" if solver == "fast" else "rupture_tangent_successive", {"a": a})


@elementwise
def rupture_angle(a: Any) -> Any:
    """x_e [rad] of eq (18), for arrays of the squeeze group A [-]; error below 1e-13, NaN for infinite A."""


@elementwise
def rupture_tangent_slope(a: Any) -> Any:
    """dt_e/dA [-] of eq (18), for arrays of the squeeze group A [-]; relative error below 1e-13."""


@elementwise
def iso_viscous_load(a: Any) -> tuple[Any, Any]:
    """Phi [-] and dPhi/dA [-], eq (21) corrected, for arrays of the squeeze group A [-].

    W = 12 l u eta0 R/h0 Phi(A). Relative errors below 1e-13 for every finite A (both underflow to zero beyond
    A = 1e100); infinite A gives NaN.
    """


@elementwise
def piezo_viscous_load(a: Any, b: Any) -> tuple[Any, Any, Any]:
    """Psi, dPsi/dA, dPsi/dB [-] of Barus oil, eqs (19) and (31), for arrays of the groups A and B [-].

    W = 12 l u eta0 R/h0 Psi(A, B). There is a film for 0 <= B < B_crit(A); every other B gives NaN. Relative
    error of Psi below 1e-10 up to 0.999 B_crit and 1e-6 up to 0.999999 B_crit, of the slopes below 1e-8 up to
    0.99 B_crit.
    """


@elementwise
def critical_pressure_group(a: Any) -> Any:
    """B_crit = 1/max p* [-], for arrays of the squeeze group A [-]; relative error below 1e-13.

    From B_crit on there is no rigid piezo-viscous film: alpha p_max = B/B_crit of eq (31) has reached one. It
    grows with A**3: beyond A = 3.4e102 it is above the largest number of its kind, and infinite.
    """


@elementwise
def pressure_group(tangent: Any, rupture_tangent: Any, a: Any) -> Any:
    """p*(xbar) [-] of eq (16), for arrays of t = tan(xbar), t_e and A [-].

    Holds between -infinity and t_e; beyond, the film is ruptured and the number means nothing. The error is a
    few epsilon of the largest of its three terms: t_e A on fast approach.
    """


@elementwise
def squeeze_group(radius: Any, speed: Any, film: Any, velocity: Any) -> Any:
    """A = 4 w*/sqrt(2 h*) [-], the group of eq (18), for arrays of R [m], u [m/s], h0 [m] and w [m/s]."""


@elementwise
def pressure_scale(radius: Any, speed: Any, viscosity: Any, film: Any) -> Any:
    """p/p* = 6 sqrt(2 R) u eta0 h0^(-3/2) [Pa] of eq (12).

    For arrays of R [m], u [m/s], eta0 [Pa s] and h0 [m].
    """


@elementwise
def barus_pressure(alpha_p: Any) -> Any:
    """alpha q = -ln(1 - alpha p) [-] of eq (31), for arrays of alpha p [-]; NaN from alpha p = 1 on."""


@elementwise
def reynolds_iso_viscous_load(
    film: Any, velocity: Any, *, radius: Any, length: Any, speed: Any, viscosity: Any
) -> tuple[Any, Any, Any]:
    """W [N], dW/dh [N/m], dW/dw [N s/m] of the Reynolds iso-viscous film, W = 12 l u eta0 R/h Phi(A).

    The slopes are total: x_e moves with h and w. For arrays of h [m], w [m/s], R [m], l [m], u [m/s],
    eta0 [Pa s]. Relative errors below 1e-12, down to where a number underflows (dW/dh: beyond A = 1e77); a
    film that is not positive gives NaN.
    """


@elementwise
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
    """W [N], dW/dh [N/m], dW/dw [N s/m] of the Reynolds piezo-viscous film, W = 12 l u eta0 R/h Psi(A, B).

    The slopes are total. Arrays as for `reynolds_iso_viscous_load`, and alpha [1/Pa]. Relative errors below
    1e-12 up to 0.99 B_crit, growing as 1e-15/(1 - B/B_crit) from there on. NaN where there is no rigid film.
    """


@elementwise
def limiting_film_ratio(speed_group: Any, squeeze_ratio: Any) -> Any:
    """h* [-] at which alpha p_max = 1, eq (31), for arrays of u* > 0 and w* [-].

    alpha p_max of that film is one to 1e-12, and the film as exact as that makes it: where it separates fast,
    alpha p_max changes by 1/A**2 only between films of twice the thickness. NaN where the surfaces separate
    so fast that alpha p stays below one for every h* above 1e-15.
    """


@elementwise
def half_pi_rupture_load(
    film: Any, velocity: Any, *, radius: Any, length: Any, speed: Any, viscosity: Any
) -> tuple[Any, Any, Any]:
    """W [N], dW/dh [N/m], dW/dw [N s/m] of eq (35), as printed: x_e = pi/2, the film can pull.

    For arrays of h [m], w [m/s], R [m], l [m], u [m/s], eta0 [Pa s]. A film that is not positive gives NaN.
    """


@elementwise
def solved_rupture_load(
    film: Any, velocity: Any, *, radius: Any, length: Any, speed: Any, viscosity: Any
) -> tuple[Any, Any, Any]:
    """W [N], dW/dh [N/m], dW/dw [N s/m] of eq (24) as printed, with x_e of the corrected eq (18).

    The slopes are total: x_e moves with h and w. Arrays as for `half_pi_rupture_load`.
    """


@elementwise
def published_stiffness_damping(
    film: Any, velocity: Any, *, radius: Any, length: Any, speed: Any, viscosity: Any
) -> tuple[Any, Any]:
    """k = -dW/dh [N/m] and c = -dW/dw [N s/m], eqs (26) to (28): eq (24) differentiated with x_e held.

    Positive where they resist. h0^(1/2) of eq (27) is read as h0^(5/2). Arrays as for `half_pi_rupture_load`.
    """


@elementwise
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
