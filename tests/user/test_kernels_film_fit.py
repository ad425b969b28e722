"""The film-thickness regression: known laws found again, the window compared with the Reynolds film."""

from __future__ import annotations

import numpy as np
import pytest
from kernel_module import kernels


def test_fit_finds_a_known_law_and_judges_it():
    random = np.random.default_rng(3)
    points = (
        10.0 ** random.uniform(-7, -5, 60),
        random.uniform(0.05, 1.0, 60),
        random.uniform(-5e-4, 5e-4, 60),
    )
    assert kernels.PUBLISHED_FILM_LAW == (0.787, 0.7, -0.4, -281.2)
    film = kernels.law_film_ratio(kernels.PUBLISHED_FILM_LAW, *points)
    fit = kernels.fit_film_law(*points, film)
    assert fit.law == pytest.approx(kernels.PUBLISHED_FILM_LAW, rel=1e-8)
    assert fit.unique and fit.rank == 4 and fit.error.rms < 1e-10
    other = kernels.FilmLaw(2.0 * 0.787, 0.7, -0.4, -281.2)
    error = kernels.judge_film_law(other, *points, film)
    assert error.bias == pytest.approx(np.log(2.0)) and error.rms == pytest.approx(np.log(2.0))


def test_fit_is_that_of_numpy_on_exact_films():
    points = kernels.sample_film_window((5e-5, 2e-4), (-5e-4, 5e-4), (0.3, 1.0))
    fit = kernels.fit_film_law(*points)
    design = np.column_stack(
        [
            np.ones_like(points.film_ratio),
            np.log(points.speed_group),
            np.log(points.load_group),
            points.squeeze_ratio,
        ]
    )
    solution, residuals, rank, _ = np.linalg.lstsq(design, np.log(points.film_ratio), rcond=None)
    assert rank == 4
    assert fit.law[1:] == pytest.approx(solution[1:], rel=1e-7)
    assert fit.law.factor == pytest.approx(np.exp(solution[0]), rel=1e-7)
    assert fit.error.rms == pytest.approx(np.sqrt(residuals[0] / points.film_ratio.size), rel=1e-9)


def test_window_holds_exact_films():
    points = kernels.sample_film_window(
        (5e-5, 2e-4), (-5e-4, 5e-4), (0.1, 0.9), film_count=3, pressure_count=4
    )
    assert all(column.shape == (3 * 9 * 4,) for column in points)
    a = 4.0 * points.squeeze_ratio / np.sqrt(2.0 * points.film_ratio)
    b = 6.0 * np.sqrt(2.0) * points.speed_group / points.film_ratio**1.5
    assert np.allclose(points.load_group, kernels.piezo_viscous_load(a, b)[0], rtol=1e-11)
    halved = kernels.sample_film_window(
        (5e-5, 2e-4),
        (-5e-4, 5e-4),
        (0.1, 0.9),
        film_count=3,
        pressure_count=4,
        pressure_factor=0.5,
        load_factor=0.5,
    )
    assert np.allclose(halved.speed_group, 2.0 * points.speed_group)
    assert np.allclose(halved.load_group, 0.5 * points.load_group)


def test_exponents_hang_on_the_window():
    exponents = [
        kernels.fit_film_law(
            *kernels.sample_film_window((5e-5, 2e-4), (-5e-4, 5e-4), window)
        ).law.load_exponent
        for window in ((0.0, 0.5), (0.3, 1.0), (0.99, 1.0))
    ]
    assert exponents[0] < -2.5 and exponents[1] < -1.0 and exponents[2] > 0.2


def test_points_that_determine_no_law_are_flagged():
    fit = kernels.fit_film_law(*[np.full(8, 1e-4)] * 4)
    assert not fit.unique and fit.rank < 4
