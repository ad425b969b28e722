"""The kernels for numpy arrays: held against arbitrary precision, known properties, wrong arguments."""

from __future__ import annotations

import inspect
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

kernels = pytest.importorskip(
    "rattle.kernels", reason="'make python' builds the kernels", exc_type=ImportError
)
sys.path.insert(0, str(Path(__file__).parents[1] / "reference"))
import exact_film  # noqa: E402

FILM = {"radius": 0.0127, "length": 0.010, "speed": 1.905, "viscosity": 0.3}
OIL = {"pressure_viscosity": 2.0e-8}
TEETH = {"modulus": 226.0e9}
LINE = {"radius": 0.0127, "speed": 1.905, "viscosity": 0.3}

ROUNDING = 4e-15

finite_groups = st.floats(min_value=-1e8, max_value=1e8)
moderate_groups = st.floats(min_value=-100.0, max_value=100.0)


def squeeze_groups(count: int, largest: float) -> np.ndarray:
    """Reproducible groups of both signs: a part even, a part over all orders of magnitude."""
    random = np.random.default_rng(20)
    sizes = 10.0 ** random.uniform(-6.0, np.log10(largest), count // 2) * random.choice(
        [-1.0, 1.0], count // 2
    )
    return np.concatenate([random.uniform(-5.0, 5.0, count - sizes.size), sizes])


# A = 0, where the tables of approach and separation meet, and |A| = 1e9, where a root gives way to |A|.
SPECIAL = np.array([0.0, 5e-324, -5e-324, 1e-300, -1e-16, 1e-16, 1e-8, 10.0, 100.0, 3000.0, 1e8, -1e8])
ENDS = np.array([np.nextafter(side * 1e9, side * way) for side in (-1.0, 1.0) for way in (0.0, 2e9)])
GROUPS = np.concatenate([squeeze_groups(300, 1e8), SPECIAL, ENDS])


def worst(found: np.ndarray, exact: list, floor: float = 0.0) -> float:
    """Largest error relative to the exact value, or to `floor` where that is larger."""
    assert np.isfinite(found).all()
    errors = [
        abs(exact_film.mpf(float(value)) - right) / max(abs(right), floor)
        for value, right in zip(found.reshape(-1), exact, strict=True)
    ]
    return float(max(errors))


# --- the exact film against arbitrary precision ---------------------------------------------------------


@pytest.fixture(scope="module")
def films() -> list[exact_film.Film]:
    return [exact_film.film(float(a)) for a in GROUPS]


@pytest.mark.parametrize("solver", ["fast", "successive"])
def test_rupture_tangent_is_exact(films, solver):
    near = np.abs(GROUPS) <= (1e9 if solver == "fast" else 5.0)
    bound = 1e-13 if solver == "fast" else 1e-11
    exact = [film.tangent for film, kept in zip(films, near, strict=True) if kept]
    assert worst(kernels.rupture_tangent(GROUPS[near], solver=solver), exact, floor=1.0) < bound


def test_rupture_angle_and_slope_are_exact(films):
    assert worst(kernels.rupture_angle(GROUPS), [film.angle for film in films]) < 1e-13
    assert worst(kernels.rupture_tangent_slope(GROUPS), [film.tangent_slope for film in films]) < 1e-13


def test_critical_pressure_group_is_exact(films):
    assert worst(kernels.critical_pressure_group(GROUPS), [1 / film.peak for film in films]) < 1e-13


def test_iso_viscous_load_is_exact():
    phi, slope = kernels.iso_viscous_load(GROUPS)
    exact = [exact_film.iso_load(float(a)) for a in GROUPS]
    assert worst(phi, [pair[0] for pair in exact]) < 1e-13
    assert worst(slope, [pair[1] for pair in exact]) < 1e-13


@pytest.mark.parametrize(
    ("count", "shares", "load_bound", "slope_bound"),
    [
        (100, (0.0, 0.99), 1e-10, 1e-8),
        (12, (0.99, 0.999), 1e-10, None),
        (12, (0.999, 0.999999), 1e-6, None),
    ],
)
def test_piezo_viscous_load_is_exact(count, shares, load_bound, slope_bound):
    a = np.concatenate([squeeze_groups(count, 100.0), [0.0, 100.0, -100.0]])
    critical = kernels.critical_pressure_group(a)
    share = np.random.default_rng(21).uniform(*shares, a.size)
    share[-1] = shares[1]
    b = share * critical
    found = kernels.piezo_viscous_load(a, b)
    exact = [exact_film.piezo_load(float(x), float(y)) for x, y in zip(a, b, strict=True)]
    assert worst(found[0], [values[0] for values in exact]) < load_bound
    if slope_bound:
        assert worst(found[1], [values[1] for values in exact]) < slope_bound
        assert worst(found[2], [values[2] for values in exact]) < slope_bound


def test_reference_numbers_of_pure_rolling():
    assert kernels.rupture_tangent(0.0) == pytest.approx(0.4751299200930563, rel=1e-14)
    assert kernels.iso_viscous_load(0.0) == pytest.approx(
        (0.203957020579723718, -0.192930426530595107), rel=1e-14
    )
    assert kernels.critical_pressure_group(0.0) == pytest.approx(7.8898286226979752, rel=1e-14)
    psi = kernels.piezo_viscous_load(0.0, 0.99 * 7.8898286226979752)[0]
    assert psi == pytest.approx(0.419416824401013185, rel=1e-10)


def test_pressure_vanishes_at_rupture_and_peaks_at_the_critical_group():
    a = squeeze_groups(100, 1e3)
    t = kernels.rupture_tangent(a)
    scale = 1.0 / kernels.critical_pressure_group(a)
    assert np.abs(kernels.pressure_group(t, t, a)).max() < 1e-10 * max(1.0, np.abs(a).max())
    peak = kernels.pressure_group(-t - a, t, a)
    near = np.abs(a) < 5.0
    assert np.abs(peak / scale - 1.0)[near].max() < 1e-12
    below = kernels.pressure_group((-t - a) * 1.001 + 1e-4, t, a)
    assert (below[near] < peak[near]).all()


# --- properties -----------------------------------------------------------------------------------------


@settings(max_examples=300, deadline=None)
@given(finite_groups, finite_groups)
def test_load_is_positive_and_rupture_falls_with_separation(first, second):
    low, high = sorted((first, second))
    angles = kernels.rupture_angle(np.array([low, high]))
    assert angles[1] <= angles[0] + ROUNDING
    assert -np.pi / 2 < angles[1] and angles[0] < np.pi / 2 + 1e-15
    phi, slope = kernels.iso_viscous_load(np.array([low, high]))
    assert (phi > 0.0).all() and (slope < 0.0).all()
    assert phi[1] <= phi[0] * (1.0 + ROUNDING)
    assert kernels.rupture_tangent(low) > -low / 2.0


@settings(max_examples=300, deadline=None)
@given(
    moderate_groups,
    st.floats(min_value=0.0, max_value=0.999999),
    st.floats(min_value=0.0, max_value=0.999999),
)
def test_viscosity_that_rises_with_pressure_carries_more(a, first, second):
    phi, _ = kernels.iso_viscous_load(a)
    low, high = np.sort(np.array([first, second])) * kernels.critical_pressure_group(a)
    weaker, dpsi_da, dpsi_db = kernels.piezo_viscous_load(a, low)
    stronger = kernels.piezo_viscous_load(a, high)[0]
    assert phi * (1.0 - 1e-14) <= weaker <= stronger * (1.0 + 1e-14)
    assert dpsi_da < 0.0 < dpsi_db
    assert kernels.piezo_viscous_load(a, 0.0)[0] == phi


@settings(max_examples=100, deadline=None)
@given(moderate_groups)
def test_piezo_viscous_load_tends_to_the_iso_viscous_one(a):
    phi, _ = kernels.iso_viscous_load(a)
    critical = kernels.critical_pressure_group(a)
    for share in (1e-3, 1e-6, 1e-12):
        assert abs(kernels.piezo_viscous_load(a, share * critical)[0] / phi - 1.0) < share


@settings(max_examples=100, deadline=None)
@given(moderate_groups, st.floats(min_value=0.01, max_value=0.95))
def test_slopes_are_those_of_the_loads(a, share):
    b = share * kernels.critical_pressure_group(a)
    step_a, step_b = 1e-5 * (1.0 + abs(a)), 1e-5 * b
    psi, dpsi_da, dpsi_db = kernels.piezo_viscous_load(
        np.array([a, a - step_a, a + step_a, a, a]), np.array([b, b, b, b - step_b, b + step_b])
    )
    assert (psi[2] - psi[1]) / (2.0 * step_a) == pytest.approx(dpsi_da[0], rel=1e-5)
    assert (psi[4] - psi[3]) / (2.0 * step_b) == pytest.approx(dpsi_db[0], rel=1e-5)


# --- the films in SI units ------------------------------------------------------------------------------


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


# --- the numerical referee ------------------------------------------------------------------------------


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


# --- the film-thickness regression ----------------------------------------------------------------------


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


# --- contact and regime ---------------------------------------------------------------------------------


def test_contact_and_regime_formulas():
    assert kernels.equivalent_radius(0.02, 0.03) == pytest.approx(0.012)
    assert kernels.plane_strain_modulus(205.66e9, 0.3) == pytest.approx(226.0e9)
    assert kernels.contact_deflection(0.0127, 2e8, 226e9) == pytest.approx(4 * 0.0127 * (2e8 / 226e9) ** 2)
    load, line_load = 228.6, 22860.0
    u_group = 1.905 * 0.3 * 2e-8 / 0.0127
    grubin = 0.0127 * 2.076 * u_group**0.72 * (load / (226e9 * 0.0127 * 0.010)) ** -0.091
    assert kernels.grubin_film(**FILM, **OIL, **TEETH, load=load) == pytest.approx(grubin, rel=1e-12)
    g_v = kernels.viscosity_group(**LINE, **OIL, line_load=line_load)
    g_e = kernels.elasticity_group(**LINE, **TEETH, line_load=line_load)
    assert g_v == pytest.approx(2e-8 * np.sqrt(line_load**3 / (0.3 * 1.905 * 0.0127**2)), rel=1e-12)
    assert g_e == pytest.approx(line_load / np.sqrt(0.3 * 1.905 * 226e9 * 0.0127), rel=1e-12)
    film = kernels.film_parameter(**LINE, line_load=line_load, film=1e-6)
    assert film == pytest.approx(1e-6 * line_load / (0.3 * 1.905 * 0.0127), rel=1e-12)


def test_regimes_are_words():
    g_v, g_e = np.array([[0.1, 1e3], [1.0, 10.0]]), np.array([[0.1, 0.1], [50.0, 1.0]])
    codes = kernels.mapped_regime(g_v, g_e)
    films = np.stack(kernels.limiting_films(g_v, g_e))
    assert (codes == 1 + films.argmax(axis=0)).all()
    assert [kernels.MAP_REGIMES[code] for code in codes.reshape(-1)] == list(kernels.MAP_REGIMES[1:])
    assert kernels.mapped_regime(np.nan, 1.0) == kernels.mapped_regime(1.0, -1.0) == 0
    found = kernels.film_regime(
        np.array([0.05, 0.5, 0.05, 1.0, np.nan]), np.array([1e-9, 1e-9, 2e-7, 0.0, 0.0]), 1e-6
    )
    assert [kernels.FILM_REGIMES[code] for code in found] == [
        "iso-viscous",
        "piezo-viscous",
        "elastohydrodynamic",
        "elastohydrodynamic",
        "unknown",
    ]


# --- arguments ------------------------------------------------------------------------------------------

ELEMENTWISE = {
    "rupture_tangent": ({"a": 1.0}, {}),
    "rupture_angle": ({"a": 1.0}, {}),
    "rupture_tangent_slope": ({"a": 1.0}, {}),
    "iso_viscous_load": ({"a": 1.0}, {}),
    "piezo_viscous_load": ({"a": 1.0, "b": 2.0}, {}),
    "critical_pressure_group": ({"a": 1.0}, {}),
    "pressure_group": ({"tangent": -1.0, "rupture_tangent": 0.4, "a": 0.1}, {}),
    "squeeze_group": ({"radius": 0.0127, "speed": 1.9, "film": 1e-6, "velocity": 1e-3}, {}),
    "pressure_scale": ({"radius": 0.0127, "speed": 1.9, "viscosity": 0.3, "film": 1e-6}, {}),
    "barus_pressure": ({"alpha_p": 0.5}, {}),
    "limiting_film_ratio": ({"speed_group": 1e-6, "squeeze_ratio": 1e-4}, {}),
    "reynolds_iso_viscous_load": ({"film": 3e-6, "velocity": 1e-3} | FILM, {}),
    "reynolds_piezo_viscous_load": ({"film": 3e-6, "velocity": 1e-3} | FILM | OIL, {}),
    "solved_rupture_load": ({"film": 3e-6, "velocity": 1e-3} | FILM, {}),
    "published_stiffness_damping": ({"film": 3e-6, "velocity": 1e-3} | FILM, {}),
    "published_piezo_load": ({"film": 3e-6, "velocity": 1e-3} | FILM | OIL, {}),
    "equivalent_radius": ({"radius_1": 0.02, "radius_2": 0.03}, {}),
    "plane_strain_modulus": ({"young_modulus": 2e11, "poisson_ratio": 0.3}, {}),
    "contact_deflection": ({"radius": 0.0127, "pressure": 1e8} | TEETH, {}),
    "grubin_film": (FILM | OIL | TEETH | {"load": 100.0}, {}),
    "viscosity_group": (LINE | OIL | {"line_load": 1e4}, {}),
    "elasticity_group": (LINE | TEETH | {"line_load": 1e4}, {}),
    "film_parameter": (LINE | {"line_load": 1e4, "film": 1e-6}, {}),
}


def as_tuple(found: object) -> tuple:
    return found if isinstance(found, tuple) else (found,)


@pytest.mark.parametrize("name", sorted(ELEMENTWISE))
def test_arrays_of_any_shape_give_the_floats_one_by_one(name):
    kernel, (values, _) = getattr(kernels, name), ELEMENTWISE[name]
    single = as_tuple(kernel(**values))
    assert all(type(value) is float for value in single)
    for shape in ((3,), (2, 3, 4), (0,), (2, 0), (1, 1)):
        arrays = {key: np.full(shape, value) for key, value in values.items()}
        for found, one in zip(as_tuple(kernel(**arrays)), single, strict=True):
            assert found.shape == shape and found.dtype == np.float64
            assert (found == one).all()
    first, *others = values
    mixed = {first: np.full((2, 3), values[first])} | {key: values[key] for key in others}
    assert as_tuple(kernel(**mixed))[0].shape == (2, 3)


@pytest.mark.parametrize("name", sorted(ELEMENTWISE))
def test_strides_and_read_only_arrays_are_no_matter(name):
    kernel, (values, _) = getattr(kernels, name), ELEMENTWISE[name]
    spread = {key: np.linspace(value, 1.1 * value, 8) for key, value in values.items()}
    plain = as_tuple(kernel(**spread))
    turned = {}
    for key, array in spread.items():
        turned[key] = np.repeat(array, 3)[::-3]
        turned[key].flags.writeable = False
    for found, expected in zip(as_tuple(kernel(**turned)), plain, strict=True):
        assert np.array_equal(found[::-1], expected)


@pytest.mark.parametrize("name", sorted(ELEMENTWISE))
def test_nan_stays_where_it_is(name):
    kernel, (values, _) = getattr(kernels, name), ELEMENTWISE[name]
    for key in values:
        arrays = {other: np.full(3, value) for other, value in values.items()}
        arrays[key][1] = np.nan
        results = as_tuple(kernel(**arrays))
        assert any(np.isnan(found[1]) for found in results)
        assert all(np.isfinite(found[[0, 2]]).all() for found in results)


@pytest.mark.parametrize("name", sorted(ELEMENTWISE))
@pytest.mark.parametrize(
    "wrong",
    [
        [1.0, 2.0],
        1,
        True,
        "1.0",
        None,
        1.0 + 0.0j,
        np.float32(1.0),
        np.array([1, 2]),
        np.array([1.0, 2.0], dtype=np.float32),
        np.array([1.0, 2.0], dtype=np.complex128),
        np.array([1.0, 2.0], dtype=">f8"),
        np.array([1.0, 2.0], dtype=object),
        np.ma.masked_array([1.0, 2.0], [False, True]),
    ],
    ids=lambda value: f"{type(value).__name__}-{getattr(value, 'dtype', '')}",
)
def test_nothing_is_cast(name, wrong):
    kernel, (values, _) = getattr(kernels, name), ELEMENTWISE[name]
    for key in values:
        with pytest.raises(TypeError, match=key):
            kernel(**(values | {key: wrong}))


@pytest.mark.parametrize("name", sorted(name for name, (values, _) in ELEMENTWISE.items() if len(values) > 1))
def test_shapes_must_agree(name):
    kernel, (values, _) = getattr(kernels, name), ELEMENTWISE[name]
    first, second, *_ = values
    for shape in ((2,), (3, 1), (1,), (1, 3)):
        with pytest.raises(ValueError, match="shape"):
            kernel(**(values | {first: np.full(3, values[first]), second: np.full(shape, values[second])}))


def test_beyond_the_range_the_answer_is_nan():
    infinite = np.array([np.inf, -np.inf, np.nan])
    for name in ("rupture_tangent", "rupture_angle", "rupture_tangent_slope", "iso_viscous_load"):
        assert all(np.isnan(found).all() for found in as_tuple(getattr(kernels, name)(infinite)))
    a = np.zeros(4)
    for found in kernels.piezo_viscous_load(a, np.array([7.89, 1e300, -1e-300, np.inf])):
        assert np.isnan(found).all()
    films = np.array([0.0, -1e-6, 1.0e-6])  # the last is thinner than a rigid piezo-viscous film can be
    assert np.isnan(kernels.reynolds_piezo_viscous_load(films, 0.0, **FILM, **OIL)[0]).all()
    assert np.isnan(kernels.half_pi_rupture_load(films[:2], 1e-3, **FILM)[0]).all()


@pytest.mark.parametrize(
    ("call", "fault"),
    [
        (lambda: kernels.rupture_tangent(1.0, solver="newton"), ValueError),
        (lambda: kernels.solve_reynolds(1, 0.0), TypeError),
        (lambda: kernels.solve_reynolds(1.0, np.inf), ValueError),
        (lambda: kernels.solve_reynolds(1.0, 0.0, -1.0), ValueError),
        (lambda: kernels.solve_reynolds(1.0, 0.0, law="castor"), ValueError),
        (lambda: kernels.solve_reynolds(1.0, 0.0, law="roelands"), ValueError),
        (lambda: kernels.solve_reynolds(1.0, 0.0, cells=31), ValueError),
        (lambda: kernels.solve_reynolds(1.0, 0.0, cells=64.0), TypeError),
        (lambda: kernels.solve_reynolds(1.0, 0.0, extrapolate=1), TypeError),
        (lambda: kernels.sample_film_window((1e-4, 1e-5), (0.0, 0.0), (0.1, 0.9)), ValueError),
        (lambda: kernels.sample_film_window((1e-5, 1e-4), (0.0, 0.0), (0.1, 1.1)), ValueError),
        (lambda: kernels.sample_film_window([1e-5, 1e-4], (0.0, 0.0), (0.1, 0.9)), TypeError),
        (lambda: kernels.sample_film_window((1e-5, 1e-4), (0.0, 0.0), (0.1, 0.9), film_count=0), ValueError),
        (lambda: kernels.fit_film_law(*[np.ones(4)] * 4), ValueError),
        (lambda: kernels.fit_film_law(np.ones(6), np.ones(6), np.ones(6), np.ones(5)), ValueError),
        (lambda: kernels.fit_film_law(np.zeros(6), *[np.ones(6)] * 3), ValueError),
        (lambda: kernels.fit_film_law(np.ones((2, 3)), *[np.ones(6)] * 3), ValueError),
        (lambda: kernels.judge_film_law((1.0, 0.7, -0.4, 0.0), *[np.ones(6)] * 4), TypeError),
        (
            lambda: kernels.judge_film_law(kernels.FilmLaw(-1.0, 0.7, -0.4, 0.0), *[np.ones(6)] * 4),
            ValueError,
        ),
        (lambda: kernels.amplitude_spectrum(np.ones((2, 2))), ValueError),
        (lambda: kernels.amplitude_spectrum(np.array([1.0, np.nan])), ValueError),
        (lambda: kernels.classify(np.ones(10), 4), ValueError),
        (lambda: kernels.classify(np.ones(12), 4.0), TypeError),
    ],
)
def test_other_wrong_arguments_raise(call, fault):
    with pytest.raises(fault):
        call()


def test_points_that_determine_no_law_are_flagged():
    fit = kernels.fit_film_law(*[np.full(8, 1e-4)] * 4)
    assert not fit.unique and fit.rank < 4


# --- spectrum and class ---------------------------------------------------------------------------------

PERIOD, PERIODS = 256, 8


def synthetic(lines: dict[float, float], phase: float = 0.3) -> np.ndarray:
    """Cosines at multiples of the forcing frequency."""
    angle = 2.0 * np.pi * np.arange(PERIOD * PERIODS) / PERIOD
    return sum(size * np.cos(ratio * angle + phase * ratio**2) for ratio, size in lines.items())


SIGNALS = {
    "quiet": {1.0: 10.0, 2.0: 1.0, 3.0: 0.05},
    "creep": {1.0: 6.0, 2.0: 8.0, 3.0: 6.0, 4.0: 4.0, 5.0: 0.03},
    "idle": {float(n): 20.0 * 0.85 ** (n - 1) for n in range(1, 36)},
    "irregular": {1.0: 6.0, 2.0: 8.0, 2.5: 3.0},
}


@pytest.mark.parametrize("name", sorted(SIGNALS))
def test_classify_agrees_with_numpy(name):
    samples = synthetic(SIGNALS[name])
    found = kernels.classify(samples, PERIOD)
    amplitude = 2.0 * np.abs(np.fft.rfft(samples)) / samples.size
    amplitude[[0, -1]] /= 2.0
    assert np.allclose(kernels.amplitude_spectrum(samples), amplitude, atol=1e-12)
    harmonics = amplitude[PERIODS::PERIODS][: (PERIOD - 1) // 2]
    assert np.allclose(found["harmonics"], harmonics, atol=1e-12)
    assert np.allclose(kernels.lines(samples, PERIOD), harmonics, atol=1e-12)
    assert found["line_count"] == int((harmonics > 0.01 * harmonics[0]).sum())
    distortion = np.sqrt((harmonics[1:] ** 2).sum()) / harmonics[0]
    assert found["harmonic_distortion"] == pytest.approx(distortion, rel=1e-10)
    irregular = 1.0 - (harmonics**2).sum() / (amplitude[1:] ** 2).sum()
    assert found["irregular_fraction"] == pytest.approx(irregular, abs=1e-12)
    expected = (
        "irregular"
        if irregular > 0.01
        else "quiet"
        if distortion < 0.35
        else "idle"
        if found["line_count"] >= 20
        else "creep"
    )
    assert found["rattle_class"] == expected == name


def test_reversals_of_a_plain_wave_and_rest():
    assert kernels.classify(synthetic({1.0: 1.0}), PERIOD)["reversals_per_period"] == 2.0
    assert kernels.classify(synthetic({3.0: 1.0, 1.0: 0.1}), PERIOD)["reversals_per_period"] == 6.0
    rest = kernels.classify(np.zeros(PERIOD), PERIOD)
    assert rest["rattle_class"] == "quiet" and np.isnan(rest["harmonic_distortion"])


# --- documentation --------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", sorted(kernels.__all__))
def test_every_kernel_is_documented(name):
    thing = getattr(kernels, name)
    if not callable(thing):
        return
    text = inspect.getdoc(thing) or ""
    assert text and not text.startswith(f"{name}("), "numpy and tuples write a docstring of their own"
    if inspect.isfunction(thing) and name not in ("classify", "lines", "amplitude_spectrum"):
        assert "eq" in text or "(32)" in text or "map" in text or "film" in text
        assert "[" in text or "arrays" in text or "pure numbers" in text


def test_all_names_everything_public():
    public = {
        name
        for name, thing in vars(kernels).items()
        if not name.startswith("_") and getattr(thing, "__module__", "") == kernels.__name__
    }
    assert public <= set(kernels.__all__)
