"""Contact and lubrication regime: eqs (2) to (4), Grubin's film (33) and Johnson's regime map."""

from __future__ import annotations

from typing import Any

from rattle import codes
from rattle.kernels._calls import elementwise

MAP_REGIMES = (
    "unknown",
    "iso-viscous rigid",
    "piezo-viscous rigid",
    "iso-viscous elastic",
    "piezo-viscous elastic",
)
FILM_REGIMES = tuple(codes.FILM_REGIMES.values())


@elementwise
def equivalent_radius(radius_1: Any, radius_2: Any) -> Any:
    """R [m], 1/R = 1/r1 + 1/r2, eq (2), for arrays of both radii [m]; a hollow one is negative."""


@elementwise
def plane_strain_modulus(young_modulus: Any, poisson_ratio: Any) -> Any:
    """E* = E/(1 - nu^2) [Pa], eq (3), for arrays of E [Pa] and nu [-]."""


@elementwise
def contact_deflection(radius: Any, pressure: Any, modulus: Any) -> Any:
    """delta = 4 R p^2/E*^2 [m], eq (4), for arrays of R [m], p [Pa] and E* [Pa]."""


@elementwise
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


@elementwise
def viscosity_group(
    *, radius: Any, speed: Any, viscosity: Any, pressure_viscosity: Any, line_load: Any
) -> Any:
    """g_v = alpha sqrt((W/l)^3/(eta0 U R^2)) [-] of Johnson's regime map.

    For arrays of R [m], entrainment speed U [m/s], eta0 [Pa s], alpha [1/Pa], W/l [N/m].
    """


@elementwise
def elasticity_group(*, radius: Any, speed: Any, viscosity: Any, modulus: Any, line_load: Any) -> Any:
    """g_e = (W/l)/sqrt(eta0 U E* R) [-] of Johnson's regime map.

    For arrays of R [m], entrainment speed U [m/s], eta0 [Pa s], E* [Pa], W/l [N/m].
    """


@elementwise
def film_parameter(*, radius: Any, speed: Any, viscosity: Any, line_load: Any, film: Any) -> Any:
    """h0 (W/l)/(eta0 U R) [-], the film of Johnson's regime map.

    For arrays of R [m], entrainment speed U [m/s], eta0 [Pa s], W/l [N/m], h0 [m].
    """


@elementwise
def limiting_films(g_viscosity: Any, g_elasticity: Any) -> tuple[Any, Any, Any, Any]:
    """The four limiting films of Johnson's map [-], in the order of MAP_REGIMES[1:].

    For arrays of g_v and g_e [-]. Films in the form of `film_parameter`: Martin, Blok, Herrebrugh, Dowson.
    """


@elementwise
def mapped_regime(g_viscosity: Any, g_elasticity: Any) -> Any:
    """Regime of Johnson's map as an index into MAP_REGIMES (int32), for arrays of g_v and g_e [-].

    The limit with the largest film rules; 0 where a group is negative or NaN.
    """


@elementwise
def film_regime(alpha_p_maximum: Any, deflection: Any, film: Any) -> Any:
    """Regime of a computed film as an index into FILM_REGIMES (int32).

    For arrays of alpha p_max [-] of the exact pressure, delta [m] of eq (4) and h0 [m]. From alpha p = 1 on
    and above delta = 0.1 h0 elastohydrodynamic, from alpha p = 0.1 on piezo-viscous; 0 where a number is
    negative or NaN or the film not positive, but delta is read below alpha p = 1 only.
    """
