"""The kernels for the tests that call them, which fail without, and the film they share."""

from __future__ import annotations

from rattle import kernels

__all__ = ["FILM", "LINE", "OIL", "TEETH", "kernels"]

FILM = {"radius": 0.0127, "length": 0.010, "speed": 1.905, "viscosity": 0.3}
OIL = {"pressure_viscosity": 2.0e-8}
TEETH = {"modulus": 226.0e9}
LINE = {"radius": 0.0127, "speed": 1.905, "viscosity": 0.3}
