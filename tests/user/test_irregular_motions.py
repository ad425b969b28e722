"""What is reported of irregular motions is that of all periods that they were followed, everywhere."""

from __future__ import annotations

from math import hypot
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

import rattle as package

IRREGULAR = {"kinematics": {"entrainment_speed": "12.0"}, "load": {"force_amplitude": "1200.0"}}
SOLVER = {
    "method": None,
    "steps_per_period": None,
    "samples_per_period": "256",
    "periods": "60",
    "starts": "1",
}
# With their errors.
NUMBERS = {
    "acceleration_rms": "acceleration_rms_error",
    "film_force_rms": "film_force_rms_error",
    "dissipated_power": "dissipated_power_error",
    "impacts_per_period_drive": "impacts_per_period_drive_error",
    "impact_impulse_mean_drive": "impact_impulse_mean_drive_error",
}
EXTREMES = ("film_minimum", "film_maximum", "acceleration_minimum", "acceleration_maximum")


@pytest.fixture(scope="module")
def alone(run, scene_text, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a single scene with an irregular motion, one.nml."""
    folder = tmp_path_factory.mktemp("alone")
    (folder / "one.nml").write_text(scene_text(**IRREGULAR, solver=SOLVER, spectrum={"periods": "4"}))
    assert run("one.nml", cwd=folder).returncode == 0
    return folder / "results"


def test_it_is_not_that_of_the_window(alone: Path) -> None:
    summary = summary_of(alone / "one.summary.nml")
    assert (summary["rattle_class"], summary["verification"]) == ("irregular", "verified")
    assert summary["followed_periods"] >= 100 and summary["window_periods"] == 4
    assert summary["followed_periods"] // summary["batch_periods"] >= 10
    shown = package.read(alone / "one.rattle")["acceleration"][-4 * 256 :]
    rms = summary["acceleration_rms"]
    # Four periods are five times as uncertain as a hundred.
    assert 0.0 < abs(np.sqrt(np.mean(shown**2)) - rms) < 10.0 * summary["acceleration_rms_error"]
    assert summary["acceleration_maximum"] > 1.05 * shown.max()
    # Impacts that are listed are those of the window, which the series shows.
    times = np.atleast_1d(summary["impact_times_drive"])
    assert len(times) < summary["impacts_drive"] and summary["impact_periods"] == summary["followed_periods"]
    series = package.read(alone / "one.rattle")
    assert series["time"][-4 * 256 - 1] <= times.min() and times.max() <= series["time"][-1]


def test_a_reader_sees_the_scatter(alone: Path) -> None:
    summary = summary_of(alone / "one.summary.nml")
    log = (alone / "one.log").read_text()
    error = summary["acceleration_rms_error"]
    words = summary["verdict_text"].partition("acceleration rms ")[2].split()
    assert words[1] == "+-" and error <= float(words[2]) <= 1.11 * error
    assert "extremes of an irregular motion grow with time" in log
    assert f"{summary['followed_periods']} periods that the motion was followed" in log
    assert "NaN" not in log


@pytest.mark.parametrize("record", [("rattle_class",), ()], ids=["with its class", "without"])
def test_a_row_has_the_same_numbers(record, alone: Path, run, scene_text, tmp_path: Path) -> None:
    """Beside a row that repeats, and whether its class is asked for or not."""
    expected = summary_of(alone / "one.summary.nml")
    names = ("acceleration_rms", "film_force_rms", "dissipated_power", *EXTREMES, *record)
    campaign = {
        "vary": "'load.force_amplitude'",
        "values(:, 1)": "100.0, 1200.0",
        "samples_per_period": "256",
        "record": ", ".join(f"'{name}'" for name in names),
    }
    text = scene_text(
        scene={"task": "'campaign'"}, campaign=campaign, **IRREGULAR, solver=SOLVER, spectrum={"periods": "4"}
    )
    (tmp_path / "many.nml").write_text(text)
    assert run("many.nml", cwd=tmp_path).returncode == 0
    rows = package.read_campaign(tmp_path / "results" / "many.rattle")
    for name in names[:7]:
        assert rows[name][1] == pytest.approx(expected[name], rel=1e-15), name


def test_a_sweep_has_the_same_numbers(alone: Path, run, scene_text, tmp_path: Path) -> None:
    expected = summary_of(alone / "one.summary.nml")
    sweep = {"key": "'frequency'", "first": "600.0", "last": "610.0", "count": "2"}
    solver = {**SOLVER, "starts": None}
    text = scene_text(
        scene={"task": "'sweep'"}, sweep=sweep, **IRREGULAR, solver=solver, spectrum={"periods": "4"}
    )
    (tmp_path / "swept.nml").write_text(text)
    assert run("swept.nml", cwd=tmp_path).returncode == 0
    values = package.read(tmp_path / "results" / "swept.rattle")
    for name in ("acceleration_rms", "film_force_rms", "dissipated_power", *EXTREMES):
        assert values[name][0] == pytest.approx(expected[name], rel=1e-15), name


@pytest.mark.parametrize(
    "change", [{"solver.accuracy": "1e-9"}, {"film.initial_film": "2e-6"}, {"solver.periods": "173"}]
)
def test_other_solutions_agree_within_their_errors(change: dict, alone: Path, run, tmp_path: Path) -> None:
    """Other samples of the motion. Twice the errors are four standard errors."""
    one = summary_of(alone / "one.summary.nml")
    settings = [word for key, value in change.items() for word in ("--set", f"{key}={value}")]
    ended = run("--output", tmp_path, *settings, alone.parent / "one.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    other = summary_of(tmp_path / "one.summary.nml")
    assert other["rattle_class"] == "irregular"
    differ = False
    for name, error in NUMBERS.items():
        room = 2.0 * hypot(one[error], other[error])
        assert abs(one[name] - other[name]) <= room, name
        assert room < 0.7 * one[name], name
        differ = differ or one[name] != other[name]
    assert differ
