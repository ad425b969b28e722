"""Contact and regime: the formulas as printed, regimes as words."""

from __future__ import annotations

import numpy as np
import pytest
from kernel_module import FILM, LINE, OIL, TEETH, kernels


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


@pytest.mark.parametrize(
    ("g_v", "g_e", "films"),
    [(2.0, 3.0, (4.9, 2.635086, 7.465497, 4.115564)), (10.0, 0.5, (4.9, 7.705037, 1.780482, 8.814224))],
)
def test_limiting_films_are_those_of_johnson(g_v, g_e, films):
    """4.9, 1.66 g_v^(2/3), 3.10 g_e^0.8 and 2.65 g_v^0.54 g_e^0.06, worked out by hand."""
    assert kernels.limiting_films(g_v, g_e) == pytest.approx(films, rel=1e-6)


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
