"""Arguments of the kernels: shapes, strides, types, NaN and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from kernel_module import FILM, LINE, OIL, TEETH, kernels

ELEMENTWISE = {
    "rupture_tangent": {"a": 1.0},
    "rupture_angle": {"a": 1.0},
    "rupture_tangent_slope": {"a": 1.0},
    "iso_viscous_load": {"a": 1.0},
    "piezo_viscous_load": {"a": 1.0, "b": 2.0},
    "critical_pressure_group": {"a": 1.0},
    "pressure_group": {"tangent": -1.0, "rupture_tangent": 0.4, "a": 0.1},
    "squeeze_group": {"radius": 0.0127, "speed": 1.9, "film": 1e-6, "velocity": 1e-3},
    "pressure_scale": {"radius": 0.0127, "speed": 1.9, "viscosity": 0.3, "film": 1e-6},
    "barus_pressure": {"alpha_p": 0.5},
    "limiting_film_ratio": {"speed_group": 1e-6, "squeeze_ratio": 1e-4},
    "reynolds_iso_viscous_load": {"film": 3e-6, "velocity": 1e-3} | FILM,
    "reynolds_piezo_viscous_load": {"film": 3e-6, "velocity": 1e-3} | FILM | OIL,
    "half_pi_rupture_load": {"film": 3e-6, "velocity": 1e-3} | FILM,
    "solved_rupture_load": {"film": 3e-6, "velocity": 1e-3} | FILM,
    "published_stiffness_damping": {"film": 3e-6, "velocity": 1e-3} | FILM,
    "published_piezo_load": {"film": 3e-6, "velocity": 1e-3} | FILM | OIL,
    "equivalent_radius": {"radius_1": 0.02, "radius_2": 0.03},
    "plane_strain_modulus": {"young_modulus": 2e11, "poisson_ratio": 0.3},
    "contact_deflection": {"radius": 0.0127, "pressure": 1e8} | TEETH,
    "grubin_film": FILM | OIL | TEETH | {"load": 100.0},
    "viscosity_group": LINE | OIL | {"line_load": 1e4},
    "elasticity_group": LINE | TEETH | {"line_load": 1e4},
    "film_parameter": LINE | {"line_load": 1e4, "film": 1e-6},
}


def as_tuple(found: object) -> tuple:
    return found if isinstance(found, tuple) else (found,)


@pytest.mark.parametrize("name", sorted(ELEMENTWISE))
def test_arrays_of_any_shape_give_the_floats_one_by_one(name):
    kernel, values = getattr(kernels, name), ELEMENTWISE[name]
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
    kernel, values = getattr(kernels, name), ELEMENTWISE[name]
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
    kernel, values = getattr(kernels, name), ELEMENTWISE[name]
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
    kernel, values = getattr(kernels, name), ELEMENTWISE[name]
    for key in values:
        with pytest.raises(TypeError, match=key):
            kernel(**(values | {key: wrong}))


@pytest.mark.parametrize("name", sorted(name for name, values in ELEMENTWISE.items() if len(values) > 1))
def test_shapes_must_agree(name):
    kernel, values = getattr(kernels, name), ELEMENTWISE[name]
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
        (lambda: kernels.classify(np.ones(12), 2), ValueError),
        (lambda: kernels.classify(np.ones(12), 4, quiet_limit=np.nan), ValueError),
        (lambda: kernels.classify(np.ones(12), 4, noise_floor=0), TypeError),
    ],
)
def test_other_wrong_arguments_raise(call, fault):
    with pytest.raises(fault):
        call()
