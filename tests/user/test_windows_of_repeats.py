"""A motion that repeats after several periods is judged over whole repeats, whatever the window."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gearbox_pairs import one_pair

import rattle

# The fourth pair of the ready map: its motion repeats after three periods, in which it settles by a tenth.
REPEATS = {
    "scene.task": "motion",
    "shaft.speed_rpm": 2330.46,
    "oil.temperature_celsius": 118.25,
    "gear.tooth_stiffness": 1.29364e7,
    "load.force_scale": 0.6358,
    "solver.starts": 1,
}
TEN_PERIODS = {
    "shaft.speed_rpm": 643.6127334790791,
    "oil.temperature_celsius": 90.23008162766372,
    "gear.tooth_stiffness": 7.472029376824206e8,
    "load.force_scale": 0.970661370992437,
    "film.initial_film": 1.5551054577e-5,
    "film.initial_velocity": 0.01302948304,
    "solver.starts": 1,
}
# The second pair: irregular, and two periods on never far from where it was.
TWO_BANDS = {
    "scene.task": "motion",
    "shaft.speed_rpm": 840.49,
    "oil.temperature_celsius": 92.169,
    "gear.tooth_stiffness": 4.94187e9,
    "load.force_scale": 1.41998,
    "solver.starts": 3,
}
PERIODS = 260  # after which it is near where it settles, and not yet within the accuracy
AVERAGES = ("acceleration_rms", "film_force_rms", "dissipated_power", "acceleration_kurtosis")
COUNTS = ("impacts_per_period_drive", "impacts_per_period_coast", "reversals_per_period", "harmonic_count")


@pytest.fixture(scope="module")
def folder(repository: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two pairs of the ready map alone, as `pair.nml` and `bands.nml`."""
    folder = tmp_path_factory.mktemp("repeats")
    inputs = repository / "input"
    (folder / "gearbox_run_up.csv").write_bytes((inputs / "gearbox_run_up.csv").read_bytes())
    for name, place in (("pair", 3), ("bands", 1)):
        (folder / f"{name}.nml").write_text(one_pair((inputs / "gearbox_map.nml").read_text(), place))
    return folder


def solved(folder: Path, **changes: object) -> dict:
    """The summary of the pair with some keys changed."""
    changes = {key.replace("__", "."): value for key, value in changes.items()}
    return rattle.run(folder / "pair.nml", set=REPEATS | {"solver.periods": PERIODS} | changes).summary


@pytest.mark.parametrize("window", [2, 4, 5, 7])
def test_a_window_of_any_length_has_the_numbers_of_whole_repeats(folder: Path, window: int) -> None:
    """Held against a window of one repeat. Where they begin, the motion is within 0.914**85 = 5e-4 of where
    it settles; the power is a small difference of work done and taken: ten times that. A window of four
    periods alone has an rms 6 % too large."""
    found, whole = (solved(folder, spectrum__periods=periods) for periods in (window, 3))
    assert whole["orbit_period"] == found["orbit_period"] == 3
    assert found["window_periods"] == window and found["impact_periods"] % 3 == 0
    for name in AVERAGES:
        assert found[name] == pytest.approx(whole[name], rel=5e-3), name
    for name in COUNTS:
        assert found[name] == whole[name], name
    assert found["dissipated_power"] > 0.0
    np.testing.assert_allclose(found["harmonics"][:4], whole["harmonics"][:4], rtol=0.01)


def test_a_window_that_is_followed_on_is_verified_alike(folder: Path) -> None:
    found = solved(folder)
    assert (found["verification"], found["impacts_verified"]) == ("verified", True)
    assert found["acceleration_rms_error"] < 1e-5 * found["acceleration_rms"]


def test_one_period_shows_no_repeat_and_is_not_verified(folder: Path) -> None:
    found = solved(folder, spectrum__periods=1)
    assert found["verification"] == "uncertain" and "one period" in found["verification_text"]


def test_a_row_has_the_numbers_of_its_scene(folder: Path) -> None:
    alone = solved(folder)
    row = rattle.run(
        folder / "pair.nml",
        set=REPEATS
        | {
            "scene.task": "campaign",
            "solver.periods": PERIODS,
            "campaign.vary": "load.force_scale",
            "campaign.first": REPEATS["load.force_scale"],
            "campaign.last": 0.7,
            "campaign.count": 2,
            "campaign.record": ("acceleration_rms", "film_force_rms", "impacts_per_period_coast"),
        },
    ).result
    for name in ("acceleration_rms", "film_force_rms", "impacts_per_period_coast"):
        assert row[name][0] == pytest.approx(alone[name], rel=1e-4), name


def test_what_settles_may_repeat_after_more_periods_than_eight(repository: Path) -> None:
    """After ten. From rest it is irregular for hundreds of periods; it starts beside where it settles."""
    alone = rattle.run(repository / "input" / "loose_pair.nml", set=TEN_PERIODS).summary
    assert (alone["rattle_class"], alone["orbit_period"]) == ("subharmonic", 10)
    assert alone["verification"] == "verified" and alone["impact_periods"] == 10
    whole = rattle.run(
        repository / "input" / "loose_pair.nml", set=TEN_PERIODS | {"spectrum.periods": 10}
    ).summary
    assert alone["acceleration_rms"] == pytest.approx(whole["acceleration_rms"], rel=1e-8)
    assert alone["impacts_per_period_drive"] == whole["impacts_per_period_drive"]


def test_an_irregular_motion_has_no_period(folder: Path) -> None:
    """Even where its states come near those of two periods before, as in two narrow bands."""
    result, summary = rattle.run(folder / "bands.nml", set=TWO_BANDS)
    assert summary["rattle_class"] == "irregular" and summary["lyapunov_exponent"] > 0.0
    motions = result.motions.to_dataframe()
    assert list(motions.orbit_period[motions.rattle_class_word == "irregular"]) == [0.0]
