"""The exact and the published films in SI units, against their groups and the printed formulas."""

from __future__ import annotations

import numpy as np
import pytest
from kernel_module import FILM, OIL, kernels


def test_exact_films_in_si_units_are_the_groups_scaled():
    film, velocity = np.array([[2.0e-6, 5.0e-6], [1.0e-5, 3.0e-6]]), np.array([[0.0, -1e-3], [2e-3, 5e-3]])
    scale = 12.0 * FILM["length"] * FILM["speed"] * FILM["viscosity"] * FILM["radius"] / film
    a = 4.0 * velocity / FILM["speed"] / np.sqrt(2.0 * film / FILM["radius"])
    b = 6.0 * np.sqrt(2.0 * FILM["radius"]) * 2e-8 * FILM["speed"] * FILM["viscosity"] / film**1.5
    assert np.allclose(kernels.squeeze_group(FILM["radius"], FILM["speed"], film, velocity), a, rtol=1e-14)
    pressure = kernels.pressure_scale(FILM["radius"], FILM["speed"], FILM["viscosity"], film)
    assert np.allclose(2e-8 * pressure, b, rtol=1e-14)
    load = kernels.reynolds_iso_viscous_load(film, velocity, **FILM)[0]
    assert np.allclose(load, scale * kernels.iso_viscous_load(a)[0], rtol=1e-13)
    load = kernels.reynolds_piezo_viscous_load(film, velocity, **FILM, **OIL)[0]
    assert np.allclose(load, scale * kernels.piezo_viscous_load(a, b)[0], rtol=1e-13)


@pytest.mark.parametrize(
    ("kernel", "options"),
    [
        ("reynolds_iso_viscous_load", FILM),
        ("reynolds_piezo_viscous_load", FILM | OIL),
        ("half_pi_rupture_load", FILM),
        ("solved_rupture_load", FILM),
        ("published_piezo_load", FILM | OIL),
    ],
)
def test_slopes_in_si_units_are_those_of_the_loads(kernel, options):
    film, velocity = np.array([3e-6, 5e-6, 4e-6]), np.array([-1e-3, 0.0, 1e-3])
    load = getattr(kernels, kernel)
    _, by_film, by_velocity = load(film, velocity, **options)
    thinner, thicker = load(film - 1e-11, velocity, **options)[0], load(film + 1e-11, velocity, **options)[0]
    assert np.allclose((thicker - thinner) / 2e-11, by_film, rtol=1e-6)
    slower, faster = load(film, velocity - 1e-8, **options)[0], load(film, velocity + 1e-8, **options)[0]
    assert np.allclose((faster - slower) / 2e-8, by_velocity, rtol=1e-6)


def test_published_loads_are_the_printed_formulas():
    h, w = 1.2e-6, -2.0e-3
    rolling = 2.8 * 0.010 * 1.905 * 0.3 * 0.0127 / h
    squeeze = 3.0 * 0.010 * 0.3 * 0.0127**1.5 / np.sqrt(2.0) / h**1.5
    assert kernels.half_pi_rupture_load(h, w, **FILM)[0] == pytest.approx(
        rolling - np.pi * squeeze * w, rel=1e-13
    )
    width = kernels.rupture_angle(4.0 * w / 1.905 / np.sqrt(2.0 * h / 0.0127)) + np.pi / 2.0
    assert kernels.solved_rupture_load(h, w, **FILM)[0] == pytest.approx(
        rolling - width * squeeze * w, rel=1e-13
    )
    stiffness, damping = kernels.published_stiffness_damping(h, w, **FILM)
    assert damping == pytest.approx(width * squeeze, rel=1e-13)
    assert stiffness == pytest.approx(rolling / h - 1.5 * width * squeeze * w / h, rel=1e-13)
    printed = (
        6.6 * 0.010 * (1.905 * 0.3) ** 2.75 * (0.0127 * 2e-8) ** 1.75 / h**3.5 * np.exp(-703.0 * w / 1.905)
    )
    assert kernels.published_piezo_load(h, w, **FILM, **OIL)[0] == pytest.approx(printed, rel=1e-13)


def test_steady_films_of_the_canonical_scene():
    load = 199.2 + 3.0 * 9.80665
    assert kernels.half_pi_rupture_load(8.889224234368e-07, 0.0, **FILM)[0] == pytest.approx(load, rel=1e-12)
    assert kernels.published_piezo_load(1.000449736566e-06, 0.0, **FILM, **OIL)[0] == pytest.approx(
        load, rel=1e-11
    )
    assert kernels.reynolds_iso_viscous_load(7.770084386172e-07, 0.0, **FILM)[0] == pytest.approx(
        load, rel=1e-12
    )


def test_barus_pressure_and_limiting_film():
    alpha_p = np.array([0.0, 0.5, 0.826, 1.0, 1.65, np.nan])
    assert np.allclose(kernels.barus_pressure(alpha_p)[:3], -np.log1p(-alpha_p[:3]), rtol=1e-14)
    assert np.isnan(kernels.barus_pressure(alpha_p)[3:]).all()
    speed, squeeze = np.array([0.9e-6, 0.45e-6, 0.9e-6]), np.array([0.0, -5e-4, 5e-4])
    film = kernels.limiting_film_ratio(speed, squeeze)
    b = 6.0 * np.sqrt(2.0) * speed / film**1.5
    assert np.allclose(b, kernels.critical_pressure_group(4.0 * squeeze / np.sqrt(2.0 * film)), rtol=1e-11)
    assert np.isnan(kernels.limiting_film_ratio(np.array([np.nan, 1e-6]), np.array([0.0, np.nan]))).all()


@pytest.mark.parametrize("film", [1e-14, 1e-9, 1e-4, 1e2])
@pytest.mark.parametrize("a", [-1e8, -3.0, 0.0, 0.1, 30.0, 4.1e4, 1e8])
@pytest.mark.parametrize("share", [0.5, 0.99, 1.001, 1.136, 40.0, 1e6])
def test_limiting_film_of_any_point(a: float, share: float, film: float):
    """On the way to thicker films alpha p falls below 1 at last, however fast the film separates."""
    speed = share * kernels.critical_pressure_group(a) * film**1.5 / (6.0 * np.sqrt(2.0))
    squeeze = 0.25 * a * np.sqrt(2.0 * film)

    def alpha_p(h: float) -> float:
        group = 6.0 * np.sqrt(2.0) * speed / h**1.5
        return group / kernels.critical_pressure_group(4.0 * squeeze / np.sqrt(2.0 * h))

    limit = kernels.limiting_film_ratio(speed, squeeze)
    if np.isnan(limit):  # alpha p of thinner and thinner films stays below 1
        assert share < 1.0 and alpha_p(1e-15) < 1.0
        return
    assert alpha_p(limit) == pytest.approx(1.0, abs=1e-12)
    assert (limit > film) == (share > 1.0)
