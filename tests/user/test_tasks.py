"""What a user does beyond one motion: film tasks, sweeps, steady runs, verifications."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of
from script_calls import call_script

import rattle as package

FILM = {"load": None, "film": None, "solver": None, "spectrum": None, "kinematics": None}


def film_text(scene_text, **points: str) -> str:
    """A film task at a few points."""
    given = {"film_ratios": "70.0e-6", "speed_groups": "0.45e-6", **points}
    return scene_text(scene={"task": "'film'"}, points=given, **FILM)


def solve(run, folder: Path, text: str, *options: str, name: str = "scene") -> Path:
    """Run one input and return the folder of its results."""
    (folder / f"{name}.nml").write_text(text)
    ended = run(*options, f"{name}.nml", cwd=folder)
    assert (ended.returncode, ended.stderr) == (0, "")
    return folder / "results"


def summary(results: Path, name: str = "scene") -> dict:
    return summary_of(results / f"{name}.summary.nml")


# --- film ---------------------------------------------------------------------------------------------


def test_film_task_knows_the_paper_s_figure_5(run, scene_text, tmp_path: Path) -> None:
    """alpha p and the highest pressure of the figure, with p halved; as printed there is no rigid film."""
    text = film_text(scene_text, squeeze_ratios="-5.0e-4, 0.0", speed_groups="0.45e-6, 0.9e-6")
    result = package.read(solve(run, tmp_path, text) / "scene.rattle")
    assert result.row_count == 4
    assert result["alpha_p_maximum"][1] == pytest.approx(0.826, abs=5e-4)
    assert result["pressure_maximum"][0] == pytest.approx(201e6, abs=0.5e6)
    assert np.isnan(result["load_piezo_viscous"][2:]).all()
    assert np.isfinite(result["load_iso_viscous"]).all()
    assert (result["film_regime"] == [2, 2, 3, 3]).all()


def test_film_task_computes_what_is_asked_for_only(run, scene_text, tmp_path: Path) -> None:
    text = film_text(scene_text, compute="'load'")
    published = text.replace("&points", "&film model = 'published' /\n&points")
    result = package.read(solve(run, tmp_path, published) / "scene.rattle")
    assert [name for name in result.columns if name.startswith("load")] == ["load_published"]
    assert not [
        name for name in result.columns if "stiffness" in name or "alpha" in name or "rupture" in name
    ]
    assert not (tmp_path / "results" / "scene.profiles.rattle").exists()


def test_reference_solution_agrees_with_the_closed_forms(run, scene_text, tmp_path: Path) -> None:
    """Extrapolated from 2048 and 4096 cells the finite volumes are good to 1e-8."""
    text = film_text(scene_text, squeeze_ratios="-5.0e-4, 0.0, 5.0e-4", speed_groups="0.4e-6")
    text = text.replace("&points", "&film model = 'numerical' /\n&points")
    result = package.read(solve(run, tmp_path, text) / "scene.rattle")
    assert result["load_numerical"] == pytest.approx(result["load_piezo_viscous"], rel=1e-8)
    assert result["rupture_angle_numerical"] == pytest.approx(result["rupture_angle"], abs=1e-8)


def test_film_profiles_end_at_the_rupture(run, scene_text, tmp_path: Path) -> None:
    text = film_text(
        scene_text, compute="'rupture', 'profile'", profile_nodes="33", squeeze_ratios="-3e-4, 3e-4"
    )
    results = solve(run, tmp_path, text)
    points = package.read(results / "scene.rattle")
    profiles = package.read(results / "scene.profiles.rattle")
    assert profiles.row_count == 2 * 33
    for point in range(2):
        rows = slice(33 * point, 33 * (point + 1))
        assert profiles["coordinate"][rows][-1] == pytest.approx(points["rupture_angle"][point], rel=1e-14)
        assert profiles["pressure_group"][rows][-1] == pytest.approx(0.0, abs=1e-15)
        assert (profiles["piezo_viscous_pressure"][rows] >= profiles["reduced_pressure"][rows]).all()


def test_film_speed_reading(run, scene_text, tmp_path: Path) -> None:
    """The sum of the speeds makes u* twice that of the mean."""
    groups = {**FILM, "kinematics": {"entrainment_speed": "1.0"}}
    speeds = []
    for reading in ("mean", "sum"):
        points = {"film_ratios": "70e-6", "speed_reading": f"'{reading}'"}
        text = scene_text(scene={"task": "'film'"}, points=points, **groups)
        speeds.append(
            package.read(solve(run, tmp_path, text, name=reading) / f"{reading}.rattle")["speed"][0]
        )
    assert speeds == [1.0, 2.0]


@pytest.mark.parametrize(
    ("points", "key"),
    [
        ({"film_ratio_range": "1e-5, 1e-4, 5"}, "film_ratio_range"),
        ({"film_ratios": None}, "film_ratios"),
        ({"film_ratios": None, "film_ratio_range": "1e-4, 1e-5, 5"}, "film_ratio_range"),
        ({"film_ratios": None, "film_ratio_range": "1e-5, 1e-4, 1"}, "film_ratio_range"),
        ({"film_ratios": None, "film_ratio_range": "1e-5, 1e-4, 2.5"}, "film_ratio_range"),
        ({"film_ratios": None, "film_ratio_range": "1e-5, 1e-4"}, "film_ratio_range"),
        ({"film_ratios": "-1e-5"}, "film_ratios"),
        ({"compute": "'everything'"}, "compute"),
        ({"compute": "'load', 'load'"}, "compute"),
        ({"speed_groups": None}, "entrainment_speed"),
    ],
)
def test_bad_points(points: dict, key: str, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "bad.nml").write_text(film_text(scene_text, **points))
    ended = run("bad.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert key in ended.stderr and ended.stdout == ""
    assert not (tmp_path / "results").exists()


# --- verifications and steady runs ------------------------------------------------------------------------


def canonical(scene_text, law: str = "iso-viscous", **solver: str | None) -> str:
    given = {"steps_per_period": None, "method": None, "periods": "60", **solver}
    return scene_text(film={"law": f"'{law}'"}, solver=given, spectrum={"periods": "16"})


@pytest.mark.parametrize(
    ("law", "lines", "name"), [("iso-viscous", 30, "idle"), ("piezo-viscous", 12, "creep")]
)
def test_steady_run_equals_the_full_run(
    law: str, lines: int, name: str, run, scene_text, tmp_path: Path
) -> None:
    """The orbit that ends a steady run has the harmonics of the full run, at a fraction of its steps."""
    full = summary(solve(run, tmp_path, canonical(scene_text, law), name="full"), "full")
    steady = summary(
        solve(run, tmp_path, canonical(scene_text, law, until="'steady'"), name="steady"), "steady"
    )
    assert (full["status"], steady["status"]) == ("complete", "steady")
    assert steady["harmonics"] == pytest.approx(full["harmonics"], rel=1e-5)
    assert steady["film_minimum"] == pytest.approx(full["film_minimum"], rel=1e-6)
    assert 5 * steady["steps"] < full["steps"]
    for one in (full, steady):
        assert (one["rattle_class"], one["harmonic_count"], one["verification"]) == (name, lines, "verified")
        assert (one["orbit_period"], one["orbit_stability"]) == (1, "stable")


def test_newmark_error_is_that_of_its_verification(run, scene_text, tmp_path: Path) -> None:
    """The error fourfold at half the steps, as second order asks; also against a window of more samples.

    Errors are reported with two digits, each true to 5 %.
    """
    errors = []
    for steps in ("64", "128", "256", "512"):
        text = canonical(scene_text, method="'newmark'", steps_per_period=steps, periods="30")
        errors.append(summary(solve(run, tmp_path, text, name=f"n{steps}"), f"n{steps}")["film_error"])
    assert np.divide(errors[:-1], errors[1:]) == pytest.approx(4.0, rel=0.15)


@pytest.mark.parametrize("accuracy", ["1e-4", "1e-5"])
def test_errors_of_a_verification_are_those_of_the_numbers(
    accuracy: str, run, scene_text, tmp_path: Path
) -> None:
    """Never smaller than they are, and no more than four times as large."""
    found, exact = (
        summary(solve(run, tmp_path, canonical(scene_text, accuracy=value), name=name), name)
        for name, value in (("loose", accuracy), ("tight", "1e-11"))
    )
    for key in ("film_minimum", "film_maximum", "acceleration_minimum", "acceleration_maximum"):
        error = abs(found[key] - exact[key])
        assert error <= found[f"{key}_error"] <= 4.0 * error, key
    assert found["film_minimum_error"] / found["film_minimum"] <= found["film_error"] < 4.0 * float(accuracy)


@pytest.mark.parametrize("method", ["newmark", "taylor"])
def test_motion_that_has_died_out_is_quiet(method: str, run, scene_text, tmp_path: Path) -> None:
    """Without a varying force only rounding is left, and no line is read into it."""
    text = canonical(scene_text, method=f"'{method}'")
    options = ["--set", "load.force_amplitude=0", "--set", "film.initial_velocity=1e-3"]
    rest = summary(solve(run, tmp_path, text, *options))
    assert (rest["rattle_class"], rest["verification"], rest["reversals_per_period"]) == (
        "quiet",
        "verified",
        0.0,
    )
    assert "harmonic_count" not in rest and "irregular_fraction" not in rest


def test_false_harmonic_is_not_verified(run, repository: Path, tmp_path: Path) -> None:
    """The artefact of a loose tolerance changes its class when solved tighter, and says so."""
    solve(run, tmp_path, (repository / "input" / "creep_false_harmonic.nml").read_text(), name="false")
    false = summary(tmp_path / "results", "false")
    assert (false["rattle_class"], false["verification"]) == ("irregular_so_far", "uncertain")
    assert "quiet" in false["verification_text"]


def test_period_two_is_found(run, repository: Path, tmp_path: Path) -> None:
    """The true line at 2.5 f_exc belongs to a stable motion of twice the period."""
    solve(run, tmp_path, (repository / "input" / "creep_period_two.nml").read_text(), name="two")
    two = summary(tmp_path / "results", "two")
    assert (two["orbit_period"], two["orbit_stability"], two["verification"]) == (2, "stable", "verified")
    assert two["harmonics"][0] == pytest.approx(54.14, abs=0.01)


@pytest.mark.parametrize(
    ("until", "verify", "expected"),
    [
        ("periods", True, "subharmonic"),
        ("steady", True, "subharmonic"),
        ("steady", False, "subharmonic"),
        ("periods", False, "subharmonic"),
    ],
)
@pytest.mark.parametrize("method", ["taylor", "newmark"])
def test_doubled_period_is_subharmonic_where_it_is_known(
    method: str, until: str, verify: bool, expected: str, run, repository: Path, tmp_path: Path
) -> None:
    """By the steady run, by the verification, or because an orbit is looked for at its end."""
    text = (repository / "input" / "creep_period_two.nml").read_text()
    if method == "taylor":
        text = re.sub(
            r"&solver\n.*?\n/\n", "&solver periods=400 samples_per_period=512 /\n", text, flags=re.S
        )
    options = ["--set", f"solver.until={until}", "--set", f"spectrum.verify=.{str(verify).lower()}."]
    results = solve(run, tmp_path, text, *options, name="two")
    two = summary(results, "two")
    assert two["rattle_class"] == expected
    assert two.get("orbit_period") == (2 if expected == "subharmonic" else None)
    assert two.get("verification") == ("verified" if verify else None)
    assert two["irregular_fraction"] > 0.01
    judged = call_script("classify.py", results / "two.rattle", cwd=tmp_path)
    assert judged.returncode == 0 and expected in judged.stdout


def test_a_motion_near_a_fold_is_not_left_for_irregular(run, repository: Path, tmp_path: Path) -> None:
    """Newton's first step goes far beyond the motion of four periods, whose multiplier is near one."""
    text = (repository / "input" / "map.nml").read_text()
    text = re.sub(r"&campaign\n.*?\n/\n", "", text, flags=re.S).replace("'campaign'", "'motion'")
    drawn = ("load.force_amplitude=293", "kinematics.entrainment_speed=17.577532")
    options = [word for setting in drawn for word in ("--set", setting)]
    fold = summary(solve(run, tmp_path, text, *options, name="fold"), "fold")
    assert (fold["orbit_period"], fold["orbit_stability"]) == (4, "stable, fold near")
    assert fold["rattle_class"] == "subharmonic"


def test_doubled_period_of_a_sweep_is_subharmonic(run, repository: Path, tmp_path: Path) -> None:
    """Beyond the frequency at which the period doubles, and only there."""
    scene = (repository / "input" / "creep_period_two.nml").read_text()
    groups = re.sub(r"&(solver|spectrum|output)\n.*?\n/\n", "", scene, flags=re.S)
    swept = "&sweep key='frequency' first=600.0 last=100.0 count=6 /\n&solver samples_per_period=256 /\n"
    results = solve(run, tmp_path, groups + swept, "--set", "scene.task=sweep", name="sweep")
    result = package.read(results / "sweep.rattle")
    off = result["irregular_fraction"] > 0.01
    repeats = result["orbit_period"] > 1
    assert (off & repeats).any() and not off.all()
    subharmonic = result["rattle_class"] == 5
    np.testing.assert_array_equal(subharmonic, off & repeats)
    assert (result["orbit_period"][subharmonic] >= 2).all()


@pytest.mark.parametrize(("periods", "status"), [(26, "steady"), (25, "complete")])
def test_steady_newmark_run_never_exceeds_its_periods(
    periods: int, status: str, run, repository: Path, tmp_path: Path
) -> None:
    """A motion of two periods, known to repeat after 24: its window fits into 26 periods, not into 25."""
    text = (repository / "input" / "creep_period_two.nml").read_text()
    options = ["--set", "solver.until=steady", "--set", "solver.steps_per_period=256"]
    options += ["--set", f"solver.periods={periods}", "--set", "output.series=.false."]
    ended = summary(solve(run, tmp_path, text, *options, name="two"), "two")
    assert (ended["status"], ended["periods_solved"]) == (status, periods)


@pytest.mark.parametrize(("periods", "status"), [(12, "steady"), (11, "complete")])
def test_the_search_leaves_room_for_the_longest_orbit(
    periods: int, status: str, run, scene_text, tmp_path: Path
) -> None:
    """Known to repeat after three periods, behind which nine must follow; single or in a campaign."""
    solver = {"until": "'steady'", "accuracy": "1e-6", "periods": str(periods)}
    text = canonical(scene_text, **solver).replace("periods = 16", "periods = 8")
    ended = summary(solve(run, tmp_path, text, name="one"), "one")
    assert (ended["status"], ended["periods_solved"]) == (status, 4 if status == "steady" else periods)
    text += "\n&campaign vary = 'load.gravity' values(:, 1) = 9.80665, 9.8 /\n"
    many = solve(run, tmp_path, text, "--set", "scene.task=campaign", name="many") / "many.rattle"
    assert (package.read_campaign(many)["status"] == (status == "steady")).all()


# --- sweeps ----------------------------------------------------------------------------------------------


def test_sweep_goes_there_and_back(run, repository: Path, tmp_path: Path) -> None:
    """Every motion is steady; over the resonance the decreasing differs, far from it it does not."""
    text = (repository / "input" / "sweep.nml").read_text()
    results = solve(run, tmp_path, text, name="sweep")
    result = package.read(results / "sweep.rattle")
    count = int(result.input["sweep"]["count"])
    assert result.row_count == 2 * count - 1
    assert (result["status"] == 1).all() and (result["floquet_modulus"] < 1.0).all()
    assert list(result["direction"]) == [1.0] * count + [-1.0] * (count - 1)
    np.testing.assert_array_equal(result["frequency"][:count], result["frequency"][count - 1 :][::-1])
    there = result["film_maximum"][:count]
    back = result["film_maximum"][count - 1 :][::-1]
    differs = np.abs(back / there - 1.0)
    assert differs.max() > 0.5
    assert differs[[0, -1]] == pytest.approx([0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize(
    ("key", "group", "value"),
    [
        ("frequency", "load", 450.0),
        ("force_amplitude", "load", 150.0),
        ("steady_force", "load", 250.0),
        ("entrainment_speed", "kinematics", 2.5),
    ],
)
def test_every_swept_key_changes_its_own_scene(
    key: str, group: str, value: float, run, scene_text, tmp_path: Path
) -> None:
    """The first motion of a sweep is that of a steady run with this value."""
    steady = canonical(scene_text, until="'steady'")
    single = solve(run, tmp_path, steady, "--set", f"{group}.{key}={value}", name="single")
    sweep = {"key": f"'{key}'", "first": repr(value), "last": repr(1.1 * value), "count": "2"}
    text = scene_text(scene={"task": "'sweep'"}, solver=None, spectrum=None, sweep=sweep)
    result = package.read(solve(run, tmp_path, text, name="sweep") / "sweep.rattle")
    for quantity in ("film_minimum", "film_maximum"):
        assert result[quantity][0] == pytest.approx(summary(single, "single")[quantity], rel=1e-4)
    assert result["film_maximum"][1] != pytest.approx(result["film_maximum"][0], rel=1e-3)
