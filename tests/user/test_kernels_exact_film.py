"""The Reynolds film in its groups, compared with arbitrary precision and known properties."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kernel_module import kernels

sys.path.insert(0, str(Path(__file__).parents[1] / "reference"))
import exact_film

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


# A = 0, where the tables of approach and separation meet, and |A| = 1e9, where |A| takes the place of a root.
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


# --- against arbitrary precision ------------------------------------------------------------------------


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


def test_critical_pressure_group_far_out():
    """It goes with A**3 to the largest number there is, and is infinite where it would be larger still."""
    far = exact_film.mpf(float(kernels.critical_pressure_group(1e8))) / exact_film.mpf(1e8) ** 3
    for a in (1e50, 1e100, 1.9e102, 2.2e102, 3.0e102, 3.39e102):
        assert worst(np.array(kernels.critical_pressure_group(a)), [far * exact_film.mpf(a) ** 3]) < 1e-13
    assert np.isinf(kernels.critical_pressure_group(np.array([3.41e102, 1e103, 1e200, 1.7e308]))).all()
    # Of films with the same B/B_crit the load goes with 1/A**2, also where B_crit is no number any more.
    b = np.array([1.7e308, 1e308, 1.7e308, 1.7e308, 1e300])
    a = np.array([2.2e102, 3.0e102, 3.41e102, 1e103, 1e150])
    near = kernels.critical_pressure_group(1e8)
    share = np.array(
        [float(exact_film.mpf(y) / (far * exact_film.mpf(x) ** 3)) for x, y in zip(a, b, strict=True)]
    )
    psi = kernels.piezo_viscous_load(a, b)[0]
    assert np.isnan(psi[0]) and share[0] > 1.0
    expected = kernels.piezo_viscous_load(1e8, share[1:] * near)[0] * (1e8 / a[1:]) ** 2
    assert psi[1:] == pytest.approx(expected, rel=1e-12)


@pytest.mark.long
@pytest.mark.parametrize(("lowest", "highest", "count"), [(0.1, 8.0, 20), (8.0, 30.0, 20), (30.0, 1e5, 16)])
def test_stiffness_is_exact(lowest, highest, count):
    """Phi + A Phi'/2 and Psi + A dPsi/dA/2 + 3 B dPsi/dB/2: on fast separation their terms cancel."""
    random = np.random.default_rng(22)
    sizes = np.exp(random.uniform(np.log(lowest), np.log(highest), count))
    for a, share in zip(
        [*sizes, lowest, highest, -highest], [*random.uniform(0.0, 0.99, count), 0.0, 0.99, 0.99], strict=True
    ):
        a = float(a)
        critical = kernels.critical_pressure_group(a)
        # Of this film 12 l u eta0 R is 96, A is w and B is 48 alpha, all without rounding but for B.
        teeth = {"radius": 2.0, "length": 1.0, "speed": 4.0, "viscosity": 1.0}
        alpha = share * critical / 48.0
        b = exact_film.mpf(float(48.0 * alpha))
        phi, dphi_da = exact_film.iso_load(a)
        psi, dpsi_da, dpsi_db = exact_film.piezo_load(a, b)
        with exact_film.mp.workdps(40):
            iso = -96 * (phi + exact_film.mpf(a) / 2 * dphi_da)
            piezo = -96 * (psi + exact_film.mpf(a) / 2 * dpsi_da + 3 * b / 2 * dpsi_db)
        found = kernels.reynolds_iso_viscous_load(1.0, a, **teeth)[1]
        assert worst(np.array(found), [iso]) < 1e-12
        found = kernels.reynolds_piezo_viscous_load(1.0, a, pressure_viscosity=alpha, **teeth)[1]
        assert worst(np.array(found), [piezo]) < 1e-12


@pytest.mark.parametrize("share", [0.0, 0.5, 0.99])
def test_stiffness_far_out(share):
    """It falls off with 1/A**4 until it is no number any more."""
    teeth = {"radius": 2.0, "length": 1.0, "speed": 4.0, "viscosity": 1.0}
    a = 10.0 ** np.arange(5.0, 75.0, 5.0)
    alpha = share * kernels.critical_pressure_group(a) / 48.0
    iso = kernels.reynolds_iso_viscous_load(1.0, a, **teeth)[1] * a * a * a * a
    piezo = kernels.reynolds_piezo_viscous_load(1.0, a, pressure_viscosity=alpha, **teeth)[1] * a * a * a * a
    assert iso == pytest.approx(iso[0], rel=1e-9)
    assert iso[1:] == pytest.approx(-96.0 * 0.3611992945326279, rel=1e-12)
    assert piezo[1:] == pytest.approx(piezo[1], rel=1e-12)
    assert piezo[0] == pytest.approx(piezo[1], rel=1e-9)


def test_iso_viscous_load_is_exact():
    phi, slope = kernels.iso_viscous_load(GROUPS)
    exact = [exact_film.iso_load(float(a)) for a in GROUPS]
    assert worst(phi, [pair[0] for pair in exact]) < 1e-13
    assert worst(slope, [pair[1] for pair in exact]) < 1e-13


@pytest.mark.long
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


@settings(max_examples=300)
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


@settings(max_examples=300)
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


@settings(max_examples=100)
@given(moderate_groups)
def test_piezo_viscous_load_tends_to_the_iso_viscous_one(a):
    phi, _ = kernels.iso_viscous_load(a)
    critical = kernels.critical_pressure_group(a)
    for share in (1e-3, 1e-6, 1e-12):
        assert abs(kernels.piezo_viscous_load(a, share * critical)[0] / phi - 1.0) < share


@settings(max_examples=100)
@given(moderate_groups, st.floats(min_value=0.01, max_value=0.95))
def test_slopes_are_those_of_the_loads(a, share):
    b = share * kernels.critical_pressure_group(a)
    step_a, step_b = 1e-5 * (1.0 + abs(a)), 1e-5 * b
    psi, dpsi_da, dpsi_db = kernels.piezo_viscous_load(
        np.array([a, a - step_a, a + step_a, a, a]), np.array([b, b, b, b - step_b, b + step_b])
    )
    assert (psi[2] - psi[1]) / (2.0 * step_a) == pytest.approx(dpsi_da[0], rel=1e-5)
    assert (psi[4] - psi[3]) / (2.0 * step_b) == pytest.approx(dpsi_db[0], rel=1e-5)
