"""A sweep over speed as a driven run-up: where both ways differ, and how slow is slow enough."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from script_calls import called_here
from test_report import report

import rattle as package
from rattle import run_up
from rattle.figures import style, waterfall
from rattle.report import sweep as words

# The part of the ready run-up with both jumps and both changes of period.
PART = {"sweep.first": 2080.0, "sweep.last": 2260.0, "sweep.count": 19}


def driven(repository: Path, program: Path, folder: Path, periods: int) -> package.Result:
    """The run-up with at most so many periods at each value: a staircase."""
    given = PART | {"solver.periods": periods, "scene.name": f"driven_{periods}"}
    path = repository / "input" / "gearbox_run_up.nml"
    return package.run(path, set=given, folder=folder, program=program).result


@pytest.fixture(scope="module")
def run_ups(rattle, repository, tmp_path_factory) -> dict[int, package.Result]:
    folder = tmp_path_factory.mktemp("driven")
    return {periods: driven(repository, rattle, folder, periods) for periods in (16, 160, 400)}


def far_from(result: package.Result, other: package.Result) -> np.ndarray:
    """Share by which the peaks of two run-ups differ, row by row."""
    return np.abs(run_up.peaks(result) / run_up.peaks(other) - 1.0)


def test_ways_differ_within_the_hysteresis_alone(run_ups) -> None:
    steady = run_ups[400]
    speed, peak = steady["speed_rpm"], run_up.peaks(steady)
    up, down = peak[:19], peak[18:][::-1]
    apart = np.isin(speed[:19], run_up.differing(steady))
    assert set(speed[:19][apart]) <= set(np.arange(2110.0, 2190.0, 10.0)) and apart.sum() >= 7
    inside = (speed[:19] >= 2110.0) & (speed[:19] <= 2180.0)
    assert np.abs(up / down - 1.0)[~inside].max() < 1e-3
    assert np.abs(up / down - 1.0)[apart].min() > run_up.SAME_PEAKS


def test_a_run_up_that_is_slow_enough_has_the_steady_motions_and_a_fast_one_has_not(run_ups) -> None:
    """Driven as a staircase: the rate is a step over the time at each value."""
    steady = run_ups[400]
    pace = run_up.pace(steady)
    known = np.isfinite(pace.rates)
    slowest = pace.rates[pace.slowest]
    assert slowest == np.nanmin(pace.rates)
    # Steps of 10 1/min; the force repeats twice a turn.
    rates = {periods: 10.0 * 2200.0 / 30.0 / periods for periods in run_ups}
    assert rates[160] < slowest < rates[16]
    assert far_from(run_ups[160], steady)[known].max() < 0.01
    assert far_from(run_ups[16], steady)[known].max() > 0.02


def test_no_rate_holds_behind_jumps_and_changes_of_period(run_ups) -> None:
    steady = run_ups[400]
    pace = run_up.pace(steady)
    changes = {(before, behind) for before, behind, _ in pace.changes}
    assert {(2180.0, 2190.0), (2110.0, 2100.0), (2230.0, 2240.0), (2240.0, 2230.0)} <= changes
    for _, behind, way in pace.changes:
        (row,) = np.flatnonzero((steady["speed_rpm"] == behind) & (steady["direction"] == way))
        assert np.isnan(pace.rates[row])
    assert np.isnan(pace.rates[0])


def test_the_rate_is_the_step_over_the_time_that_a_disturbance_takes(run_ups) -> None:
    steady = run_ups[400]
    pace = run_up.pace(steady)
    for row in np.flatnonzero(np.isfinite(pace.rates)):
        seconds = steady["orbit_period"][row] * 30.0 / steady["speed_rpm"][row]
        turns = 10.0 / pace.rates[row] / seconds
        assert turns >= 1.0 - 1e-12
        left = steady["floquet_modulus"][row] ** turns
        assert left == pytest.approx(0.01) or (left < 0.01 and turns == pytest.approx(1.0))


def test_the_report_says_how_slow_and_where_no_rate_is_slow_enough(run_ups) -> None:
    steady = run_ups[400]
    pace = run_up.pace(steady)
    text = report(steady.path).read_text()
    assert f"driven at {pace.rates[pace.slowest]:.3g} 1/min/s or slower" in text
    assert "between 2180 and 2190, 2230 and 2240 1/min" in text
    assert "the fastest run-up that has these motions" in text and "Shaded: both ways" in text


def harmonics_of(result: package.Result) -> np.ndarray:
    """A row for each motion, a column for each multiple of the frequency of the force."""
    return np.column_stack([result[f"harmonic_{number}"] for number in range(1, 9)])


@pytest.mark.parametrize("speed", [2080.0, 2250.0])
def test_harmonics_of_a_value_are_those_of_the_motion_alone(
    run_ups, repository, rattle, tmp_path, speed
) -> None:
    """Below and above the hysteresis, where there is one motion, on both ways."""
    base = repository / "input" / "gearbox_run_up.nml"
    alone = base.read_text().partition("&sweep")[0].replace("'sweep'", "'motion'")
    (tmp_path / "alone.nml").write_text(alone)
    shutil.copy(base.with_suffix(".csv"), tmp_path)
    given = {"shaft.speed_rpm": speed, "solver.until": "steady", "solver.starts": 1}
    summary = package.run(tmp_path / "alone.nml", set=given, program=rattle).summary
    own = np.array(summary["harmonics"][:8])
    steady = run_ups[400]
    rows = np.flatnonzero(steady["speed_rpm"] == speed)
    assert rows.size == 2
    # Both end within 1e-4 of the motion that repeats, which a jump, 5 dB and more, is far from.
    for row in rows:
        np.testing.assert_allclose(harmonics_of(steady)[row], own, rtol=1e-3, atol=1e-3 * own.max())


def test_the_waterfall_has_the_levels_of_both_ways_and_their_difference(run_ups, tmp_path) -> None:
    steady = run_ups[400]
    code, said, complained = called_here("plot.py", "waterfall", steady.path, "--format", "png", cwd=tmp_path)
    assert code == 0 and said.split() == ["waterfall_driven_400.png"], complained
    levels = 20.0 * np.log10(harmonics_of(steady) / 1e-6)
    up, down = levels[:19], levels[18:][::-1]
    with style.house_style():
        panels = waterfall.draw_ways(steady).axes[:3]
    for axes, expected in zip(panels, (up, down, down - up), strict=True):
        (mesh,) = axes.collections
        np.testing.assert_allclose(mesh.get_array()[:, ::2], expected, atol=1e-9)
        assert list(axes.get_xticks()) == [4.0, 8.0, 12.0, 16.0]
        assert sorted({line.get_ydata()[0] for line in axes.lines}) == [2105.0, 2185.0]


def test_a_sweep_without_orders_has_no_waterfall(repository, rattle, tmp_path) -> None:
    given = {"sweep.count": 2, "sweep.first": 400.0, "solver.periods": 100}
    solved = package.run(repository / "input" / "sweep.nml", set=given, folder=tmp_path, program=rattle)
    code, _, complained = called_here("plot.py", "waterfall", solved.result.path, cwd=tmp_path)
    assert code == 2 and "is no sweep over shaft.speed_rpm with harmonics" in complained


def test_other_keys_have_no_rate(repository, rattle, tmp_path) -> None:
    given = {"sweep.count": 2, "sweep.first": 400.0, "solver.periods": 100}
    result = package.run(
        repository / "input" / "sweep.nml", set=given, folder=tmp_path, program=rattle
    ).result
    assert not run_up.is_run_up(result)
    assert not any("1/min/s" in sentence for sentence in words.sentences_on(result))
