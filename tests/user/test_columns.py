"""Every column of the tables of films and sweeps, compared with the kernels and against single scenes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from kernel_module import kernels
from outcomes import summary_of

import rattle as package
from rattle.codes import CLASSES, FILM_REGIMES

RADIUS, LENGTH, VISCOSITY, ALPHA = 0.0127, 0.010, 0.3, 2.0e-8
ORBITS = ("stable", "stable, period doubling near", "stable, fold near", "stable, torus near", "unstable")
FILM = {"load": None, "film": None, "solver": None, "spectrum": None, "kinematics": None}
POINTS = {
    "film_ratio_range": "5.0e-5, 1.0e-4, 3",
    "squeeze_ratios": "-3.0e-4, 0.0, 2.0e-4",
    "speed_group_range": "2.0e-7, 8.0e-7, 3",
    "compute": "'rupture', 'load', 'stiffness', 'damping', 'pressure', 'limits', 'profile'",
    "profile_nodes": "17",
}
UNITS = {
    "film_thickness": "m",
    "squeeze_velocity": "m/s",
    "speed": "m/s",
    "rupture_angle": "rad",
    "load": "N",
    "stiffness": "N/m",
    "damping": "N s/m",
    "pressure_maximum": "Pa",
    "deflection": "m",
    "limiting_film": "m",
}


@pytest.fixture(scope="module")
def film(run, scene_text, tmp_path_factory) -> Path:
    """The folder of a film task that computes everything."""
    folder = tmp_path_factory.mktemp("film")
    (folder / "film.nml").write_text(scene_text(scene={"task": "'film'"}, points=POINTS, **FILM))
    ended = run("film.nml", cwd=folder)
    assert (ended.returncode, ended.stderr) == (0, "")
    return folder / "results"


def test_every_column_of_a_film_table_is_that_of_the_kernels(film):
    table = package.read(film / "film.rattle")
    # The film ratio runs fastest, the speed group slowest; both ranges grow by factors.
    groups, squeezes, ratios = (
        axis.reshape(-1)
        for axis in np.meshgrid(
            np.geomspace(2e-7, 8e-7, 3), [-3e-4, 0.0, 2e-4], np.geomspace(5e-5, 1e-4, 3), indexing="ij"
        )
    )
    speed = groups * RADIUS / (VISCOSITY * ALPHA)
    state = ratios * RADIUS, squeezes * speed
    contact = {"radius": RADIUS, "length": LENGTH, "speed": speed, "viscosity": VISCOSITY}
    a = kernels.squeeze_group(RADIUS, speed, *state)
    b = ALPHA * kernels.pressure_scale(RADIUS, speed, VISCOSITY, state[0])
    alpha_p = b / kernels.critical_pressure_group(a)
    rigid = np.where(alpha_p < 1.0, -np.log1p(-np.minimum(alpha_p, 0.9999)) / ALPHA, np.nan)
    pressure = np.where(np.isnan(rigid), alpha_p / ALPHA, rigid)
    modulus = kernels.plane_strain_modulus(205.66e9, 0.3)
    deflection = kernels.contact_deflection(RADIUS, pressure, modulus)
    iso = kernels.reynolds_iso_viscous_load(*state, **contact)
    piezo = kernels.reynolds_piezo_viscous_load(*state, **contact, pressure_viscosity=ALPHA)
    slopes = kernels.published_stiffness_damping(*state, **contact)
    expected = {
        "film_ratio": ratios,
        "squeeze_ratio": squeezes,
        "speed_group": groups,
        "film_thickness": state[0],
        "squeeze_velocity": state[1],
        "speed": speed,
        "squeeze_group": a,
        "pressure_group": b,
        "rupture_angle": kernels.rupture_angle(a),
        "load_published": kernels.solved_rupture_load(*state, **contact)[0],
        "load_iso_viscous": iso[0],
        "load_piezo_viscous": piezo[0],
        "stiffness_published": slopes[0],
        "stiffness_iso_viscous": -iso[1],
        "stiffness_piezo_viscous": -piezo[1],
        "damping_published": slopes[1],
        "damping_iso_viscous": -iso[2],
        "damping_piezo_viscous": -piezo[2],
        "alpha_p_maximum": alpha_p,
        "pressure_maximum": rigid,
        "deflection": deflection,
        "film_regime": kernels.film_regime(alpha_p, deflection, state[0]),
        "limiting_film": RADIUS * kernels.limiting_film_ratio(groups, squeezes),
    }
    assert list(table.columns) == list(expected)
    assert 3 < np.isnan(rigid).sum() < 24
    for name, values in expected.items():
        np.testing.assert_allclose(table[name], values, rtol=1e-10, atol=1e-300, err_msg=name)
        stem = name.removesuffix("_published").removesuffix("_iso_viscous").removesuffix("_piezo_viscous")
        assert table.units[name] == UNITS.get(stem, "-"), name
    assert set(np.unique(table["film_regime"])) <= set(FILM_REGIMES)


def test_every_column_of_the_profiles_is_that_of_the_kernels(film):
    table, profiles = package.read(film / "film.rattle"), package.read(film / "film.profiles.rattle")
    assert profiles.row_count == 17 * table.row_count
    for point in range(table.row_count):
        rows = slice(17 * point, 17 * (point + 1))
        for name in ("film_ratio", "squeeze_ratio", "speed_group"):
            assert (profiles[name][rows] == table[name][point]).all()
        angle = np.array(profiles["coordinate"][rows])
        end = float(table["rupture_angle"][point])
        np.testing.assert_allclose(angle, np.linspace(-np.pi / 2 + 1e-6, end, 17), rtol=1e-12, atol=1e-15)
        tangent = np.tan(angle)
        a = float(table["squeeze_group"][point])
        group = kernels.pressure_group(tangent, np.full(17, np.tan(end)), a)
        np.testing.assert_allclose(
            profiles["pressure_group"][rows], np.maximum(group, 0.0), rtol=1e-8, atol=1e-13
        )
        place = tangent * np.sqrt(2.0 * RADIUS * table["film_thickness"][point])
        np.testing.assert_allclose(profiles["position"][rows], place, rtol=1e-9)
        alpha_p = table["pressure_group"][point] * profiles["pressure_group"][rows]
        np.testing.assert_allclose(profiles["reduced_pressure"][rows], alpha_p / ALPHA, rtol=1e-12)
        film = np.where(alpha_p < 1.0, -np.log1p(-np.minimum(alpha_p, 0.9999)) / ALPHA, np.nan)
        np.testing.assert_allclose(profiles["piezo_viscous_pressure"][rows], film, rtol=1e-10, atol=1e-6)


# --- sweeps --------------------------------------------------------------------------------------------

SOLVER = {"steps_per_period": None, "method": None, "periods": "300"}


@pytest.mark.parametrize(
    ("key", "group", "first", "last"),
    [
        ("frequency", "load", 300.0, 900.0),
        ("force_amplitude", "load", 60.0, 180.0),
        ("steady_force", "load", 100.0, 300.0),
        ("entrainment_speed", "kinematics", 1.0, 3.0),
    ],
)
def test_a_row_of_a_sweep_is_the_single_scene(key, group, first, last, run, scene_text, tmp_path: Path):
    sweep = {"key": f"'{key}'", "first": str(first), "last": str(last), "count": "3", "turn": ".false."}
    changes = {"load": {"force_amplitude": "90.0"}, "spectrum": {"periods": "8"}}
    text = scene_text(
        scene={"task": "'sweep'"}, solver=SOLVER, sweep=sweep, output={"directory": "'swept'"}, **changes
    )
    (tmp_path / "sweep.nml").write_text(text)
    ended = run("sweep.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0, ended.stderr
    rows = package.read(tmp_path / "swept" / "sweep.rattle")
    np.testing.assert_allclose(rows[key], np.linspace(first, last, 3))
    (tmp_path / "one.nml").write_text(scene_text(solver=SOLVER | {"until": "'steady'"}, **changes))
    for row, value in enumerate(rows[key]):
        ended = run("--overwrite", "--set", f"{group}.{key}={value}", "one.nml", cwd=tmp_path, timeout=600.0)
        assert ended.returncode == 0, ended.stderr
        one = summary_of(tmp_path / "results" / "one.summary.nml")
        for name in ("film_minimum", "film_maximum", "acceleration_minimum", "acceleration_maximum"):
            assert rows[name][row] == pytest.approx(one[name], rel=1e-5), name
        for name in ("natural_frequency", "harmonic_distortion"):
            # A sweep has 0 where there is none: overdamped motions have no natural frequency.
            assert rows[name][row] == pytest.approx(one.get(name, 0.0), rel=1e-5), name
        for name in ("orbit_period", "harmonic_count"):
            assert rows[name][row] == one[name], name
        assert CLASSES[int(rows["rattle_class"][row])] == one["rattle_class"]
        harmonics = [rows[f"harmonic_{number}"][row] for number in range(1, 9)]
        assert harmonics == pytest.approx(one["harmonics"][:8], rel=1e-5, abs=1e-5 * max(harmonics))
        assert ORBITS[int(rows["orbit_stability"][row]) - 1] == one["orbit_stability"]
        real, imaginary = one["floquet_multipliers"][:2]
        assert rows["floquet_modulus"][row] == pytest.approx(np.hypot(real, imaginary), rel=1e-3, abs=1e-6)
        assert (rows["status"][row], rows["direction"][row]) == (1.0, 1.0)


def test_a_campaign_knows_no_ratios_of_a_motion_at_rest(run, scene_text, tmp_path: Path):
    campaign = {
        "vary": "'load.force_amplitude'",
        "values(:, 1)": "0.0, 50.0",
        "record": "'harmonic_count', 'harmonic_distortion', 'irregular_fraction', 'rattle_class'",
    }
    solver = SOLVER | {"periods": "40"}
    (tmp_path / "rest.nml").write_text(
        scene_text(scene={"task": "'campaign'"}, solver=solver, campaign=campaign)
    )
    assert run("rest.nml", cwd=tmp_path).returncode == 0
    rows = package.read_campaign(tmp_path / "results" / "rest.rattle")
    for name in ("harmonic_count", "harmonic_distortion", "irregular_fraction"):
        assert np.isnan(rows[name][0]) and np.isfinite(rows[name][1]), name
    assert CLASSES[int(rows["rattle_class"][0])] == "quiet"


@pytest.mark.parametrize(("force", "amplitude"), [("40.0", "400.0"), ("80.0", "200.0")])
def test_a_failure_is_reported_with_its_time_within_the_period(
    force, amplitude, run, scene_text, tmp_path: Path
):
    """The film ends in the first period, or in the second one; Newmark, step by step, sees it there, too."""
    times = []
    for method, steps in (("taylor", None), ("newmark", "4096")):
        text = scene_text(
            load={"steady_force": force, "force_amplitude": amplitude},
            solver={"method": f"'{method}'", "steps_per_period": steps, "periods": "8"},
            film={"law": "'piezo-viscous'", "model": "'reynolds'"},
            output={"series": ".false."},
        )
        (tmp_path / f"{method}.nml").write_text(text)
        assert run(f"{method}.nml", cwd=tmp_path).returncode == 1
        lost = summary_of(tmp_path / "results" / f"{method}.summary.nml")
        assert lost["status"] == "no_rigid_film"
        times.append(lost["status_time"])
    assert times[0] == pytest.approx(times[1], rel=0.01)
