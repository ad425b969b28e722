"""Contact and lubrication regime: eqs (2) to (4), Grubin's film (33) and Johnson's regime map."""

from __future__ import annotations

from typing import Any

from rattle import codes
from rattle.kernels._calls import Numbers, elementwise

MAP_REGIMES = (
    "unknown",
    "iso-viscous rigid",
    "piezo-viscous rigid",
    "iso-viscous elastic",
    "piezo-viscous elastic",
)
FILM_REGIMES = tuple(codes.FILM_REGIMES.values())


@elementwise
def equivalent_radius(radius_1: Numbers, radius_2: Numbers) -> Any:
    """Radius of the cylinder over a plane that two flanks are alike to, eq (2).

    Parameters
    ----------
    radius_1, radius_2
        Radii of both flanks [m]; a hollow one is negative.

    Returns
    -------
    radius
        R [m], 1/R = 1/r1 + 1/r2.
    """


@elementwise
def plane_strain_modulus(young_modulus: Numbers, poisson_ratio: Numbers) -> Any:
    """Elastic modulus of plane strain, eq (3).

    Parameters
    ----------
    young_modulus, poisson_ratio
        E [Pa] and nu [-].

    Returns
    -------
    modulus
        E* = E/(1 - nu^2) [Pa].
    """


@elementwise
def contact_deflection(radius: Numbers, pressure: Numbers, modulus: Numbers) -> Any:
    """Deflection of the flanks under a pressure, eq (4).

    Parameters
    ----------
    radius, pressure, modulus
        R [m], p [Pa] and E* [Pa].

    Returns
    -------
    deflection
        delta = 4 R p^2/E*^2 [m].
    """


@elementwise
def grubin_film(
    *,
    radius: Numbers,
    length: Numbers,
    speed: Numbers,
    viscosity: Numbers,
    pressure_viscosity: Numbers,
    modulus: Numbers,
    load: Numbers,
) -> Any:
    """Elastohydrodynamic film of eq (33), h* = 2.076 u*^0.72 (W/(E* R l))^-0.091.

    Its load group is its own, not that of eq (20). All arguments are positive.

    Parameters
    ----------
    radius, length, speed, viscosity
        R [m], l [m], entrainment speed U [m/s] and eta0 [Pa s].
    pressure_viscosity, modulus, load
        alpha [1/Pa], E* [Pa] and W [N].

    Returns
    -------
    film
        h0 [m].
    """


@elementwise
def viscosity_group(
    *, radius: Numbers, speed: Numbers, viscosity: Numbers, pressure_viscosity: Numbers, line_load: Numbers
) -> Any:
    """Viscosity group of Johnson's regime map.

    Parameters
    ----------
    radius, speed, viscosity
        R [m], entrainment speed U [m/s] and eta0 [Pa s].
    pressure_viscosity, line_load
        alpha [1/Pa] and W/l [N/m].

    Returns
    -------
    group
        g_v = alpha sqrt((W/l)^3/(eta0 U R^2)) [-].
    """


@elementwise
def elasticity_group(
    *, radius: Numbers, speed: Numbers, viscosity: Numbers, modulus: Numbers, line_load: Numbers
) -> Any:
    """Elasticity group of Johnson's regime map.

    Parameters
    ----------
    radius, speed, viscosity
        R [m], entrainment speed U [m/s] and eta0 [Pa s].
    modulus, line_load
        E* [Pa] and W/l [N/m].

    Returns
    -------
    group
        g_e = (W/l)/sqrt(eta0 U E* R) [-].
    """


@elementwise
def film_parameter(
    *, radius: Numbers, speed: Numbers, viscosity: Numbers, line_load: Numbers, film: Numbers
) -> Any:
    """Film of Johnson's regime map.

    Parameters
    ----------
    radius, speed, viscosity
        R [m], entrainment speed U [m/s] and eta0 [Pa s].
    line_load, film
        W/l [N/m] and h0 [m].

    Returns
    -------
    parameter
        h0 (W/l)/(eta0 U R) [-].
    """


@elementwise
def limiting_films(g_viscosity: Numbers, g_elasticity: Numbers) -> tuple[Any, Any, Any, Any]:
    """The four limiting films of Johnson's map, in the form of `film_parameter`.

    Parameters
    ----------
    g_viscosity, g_elasticity
        g_v and g_e [-].

    Returns
    -------
    martin, blok, herrebrugh, dowson
        Films [-] in the order of MAP_REGIMES[1:].
    """


@elementwise
def mapped_regime(g_viscosity: Numbers, g_elasticity: Numbers) -> Any:
    """Regime of Johnson's map: that of the largest limiting film.

    Parameters
    ----------
    g_viscosity, g_elasticity
        g_v and g_e [-].

    Returns
    -------
    regime
        Index into MAP_REGIMES (int32); 0 where a group is negative or NaN.
    """


@elementwise
def film_regime(alpha_p_maximum: Numbers, deflection: Numbers, film: Numbers) -> Any:
    """Regime of a computed film.

    From alpha p = 1 on and above delta = 0.1 h0 it is elastohydrodynamic, from alpha p = 0.1 on piezo-
    viscous.

    Parameters
    ----------
    alpha_p_maximum, deflection, film
        alpha p_max [-] of the exact pressure, delta [m] of eq (4) and h0 [m].

    Returns
    -------
    regime
        Index into FILM_REGIMES (int32); 0 where a number is negative or NaN or the film not positive, but
        delta is read below alpha p = 1 only.
    """
