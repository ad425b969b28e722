"""A motion that ends before its end shows its state there, and its series has every sample up to there."""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of
from test_run_endings import wait_for_rows

import rattle as package

FREQUENCY = 600.0
COLUMNS = "'time', 'film_thickness', 'squeeze_velocity'"
METHODS = {
    "taylor": {"method": "'taylor'", "steps_per_period": None, "samples_per_period": "2048"},
    "newmark": {"method": "'newmark'", "steps_per_period": "2048", "tolerance": None},
}
CEASING = {
    "load": {"steady_force": "80.0", "force_amplitude": "200.0"},
    "film": {"law": "'piezo-viscous'", "model": "'reynolds'"},
}
FAST = {"film": {"initial_velocity": "-100.0"}}
COARSE = {"method": "'newmark'", "steps_per_period": "8"}
# Method, what is asked beyond the scene of all tests, status, and whether the motion got anywhere.
FAILURES = {
    "no film, from rest": ("taylor", CEASING, "no_rigid_film", True),
    "no film, from a film of its own": (
        "taylor",
        CEASING | {"film": CEASING["film"] | {"initial_film": "3e-6"}},
        "no_rigid_film",
        True,
    ),
    "no film, newmark": ("newmark", CEASING, "no_rigid_film", True),
    "no film, newmark, from a film of its own": (
        "newmark",
        CEASING | {"film": CEASING["film"] | {"initial_film": "3e-6"}},
        "no_rigid_film",
        True,
    ),
    "not converged": ("taylor", FAST, "not_converged", True),
    "not converged, newmark": (
        "newmark",
        {"solver": {"steps_per_period": "64", "iteration_limit": "3", "tolerance": "1e-15"}},
        "not_converged",
        True,
    ),
    "film lost, newmark": ("newmark", FAST | {"solver": COARSE}, "film_lost", False),
    "overflow": (
        "taylor",
        {"film": {"law": "'piezo-viscous'", "initial_velocity": "-1.0e3"}},
        "overflow",
        False,
    ),
}


@pytest.mark.parametrize("failure", FAILURES)
@pytest.mark.parametrize("until", ["periods", "steady"])
def test_the_state_at_failure_is_where_the_series_ends(
    failure: str, until: str, run, scene_text, tmp_path: Path
) -> None:
    method, changes, status, moved = FAILURES[failure]
    solver = METHODS[method] | {"periods": "40", "until": f"'{until}'"} | changes.get("solver", {})
    (tmp_path / "scene.nml").write_text(
        scene_text(**(changes | {"solver": solver, "output": {"columns": COLUMNS}}))
    )
    ended = run("--verbose", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 1, ended.stderr
    reported = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert reported["status"] == status
    series = package.read(tmp_path / "results" / "scene.rattle")
    time, film, velocity = (np.array(series[name]) for name in COLUMNS.replace("'", "").split(", "))
    step = 1.0 / (FREQUENCY * int(solver.get("samples_per_period") or solver["steps_per_period"]))
    np.testing.assert_allclose(np.diff(time), step, rtol=1e-9)
    behind = reported["status_time"] - time[-1]
    assert -1e-9 * step <= behind < step
    # Within a sample the film goes on as its velocity says; its curvature is what may be left of it.
    left = 2.0 * abs(velocity[-1] - velocity[-2]) * behind if moved and time.size > 1 else 0.0
    if time.size > 1 or not moved:
        assert reported["film_at_status_time"] == pytest.approx(
            film[-1] + velocity[-1] * behind, rel=1e-9, abs=left
        )
    assert (abs(reported["film_at_status_time"] / film[0] - 1.0) > 0.005) == moved
    line = f"{status} at t = "
    (said,) = (text for text in ended.stdout.splitlines() if line in text)
    assert f"film {1e6 * reported['film_at_status_time']:.5g}"[:10] in said


def test_a_motion_without_a_film_to_start_from_tells_none(run, scene_text, tmp_path: Path) -> None:
    for method, solver in METHODS.items():
        text = scene_text(
            load={"steady_force": "2000.0"}, film=CEASING["film"], solver=solver | {"periods": "8"}
        )
        (tmp_path / f"{method}.nml").write_text(text)
        ended = run("--verbose", f"{method}.nml", cwd=tmp_path)
        assert ended.returncode == 1
        reported = summary_of(tmp_path / "results" / f"{method}.summary.nml")
        assert reported["status"] == "no_rigid_film" and "film_at_status_time" not in reported
        assert "no_rigid_film at t = 0 s, without a film to start from: " in ended.stdout


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("ending", ["time_limit", "interrupted"])
def test_a_motion_that_is_ended_tells_the_state_of_its_last_row(
    method: str, ending: str, rattle: Path, scene_text, tmp_path: Path
) -> None:
    """At the end of a period the film is not that of the start, which was at rest."""
    solver = METHODS[method] | {"periods": "1000000"}
    if ending == "time_limit":
        solver["time_limit"] = "0.2"
    (tmp_path / "scene.nml").write_text(scene_text(solver=solver, output={"columns": COLUMNS}))
    process = subprocess.Popen([rattle, "--quiet", "scene.nml"], cwd=tmp_path)
    try:
        if ending == "interrupted":
            wait_for_rows(tmp_path / "results" / "scene.rattle", process)
            process.send_signal(signal.SIGTERM)
        process.wait(30)
    finally:
        process.kill()
    reported = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert reported["status"] == ending
    series = package.read(tmp_path / "results" / "scene.rattle")
    assert reported["status_time"] == pytest.approx(series["time"][-1], rel=1e-12)
    assert reported["film_at_status_time"] == pytest.approx(series["film_thickness"][-1], rel=1e-12)
    assert abs(reported["film_at_status_time"] / series["film_thickness"][0] - 1.0) > 0.01
