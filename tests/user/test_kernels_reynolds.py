"""Reynolds' equation solved numerically, against the closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from kernel_module import FILM, kernels


@pytest.mark.parametrize(("a", "share"), [(-10.0, 0.0), (-1.0, 0.5), (0.0, 0.9), (0.5, 0.0), (3.0, 0.5)])
def test_numerical_film_agrees_with_the_exact_one(a, share):
    b = share * kernels.critical_pressure_group(a)
    found = kernels.solve_reynolds(1.0, a, b, cells=4096)
    assert found.status == "converged"
    assert found.load == pytest.approx(kernels.piezo_viscous_load(a, b)[0], rel=1e-6)
    assert found.rupture_angle == pytest.approx(kernels.rupture_angle(a), abs=1e-5)
    assert found.angle.shape == found.pressure.shape == (4097,)
    highest = kernels.barus_pressure(share) / b if share else 1.0 / kernels.critical_pressure_group(a)
    assert found.maximum_pressure == pytest.approx(highest, rel=1e-5)


def test_numerical_film_without_solution_and_roelands():
    beyond = kernels.solve_reynolds(1.0, 0.0, 9.0, cells=256)
    assert beyond.status == "no_rigid_film"
    assert np.isnan([beyond.load, beyond.maximum_pressure, beyond.rupture_angle]).all()
    assert np.isnan(beyond.pressure).all()
    scales = kernels.scale_film(
        radius=0.0127,
        film=3e-6,
        speed_sum=1.905,
        squeeze_velocity=-1e-3,
        viscosity=0.3,
        pressure_viscosity=2e-8,
    )
    groups = (scales.rolling, scales.squeeze, scales.pressure_group)
    barus = kernels.solve_reynolds(*groups, cells=512)
    oil = {"roelands_pressure": scales.roelands_pressure, "roelands_logarithm": scales.roelands_logarithm}
    roelands = kernels.solve_reynolds(*groups, cells=512, law="roelands", **oil)
    iso = kernels.solve_reynolds(*groups, cells=512, law="constant")
    assert iso.load < roelands.load < barus.load
    load = kernels.reynolds_iso_viscous_load(3e-6, -1e-3, **FILM)[0]
    assert iso.load * scales.load_scale * FILM["length"] == pytest.approx(load, rel=1e-4)
