"""The film as published: loads, stiffness and damping as the paper prints them."""

from __future__ import annotations

from typing import Any

from rattle.kernels._elementwise import elementwise


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
