"""A row tells of a scene what its summary tells, to the last bit."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from outcomes import summary_of

import rattle as package

sys.path.insert(0, str(Path(__file__).parents[1] / "stress"))

import gear_rows

QUANTITIES = (
    "film_minimum",
    "film_maximum",
    "acceleration_maximum",
    "acceleration_rms",
    "acceleration_kurtosis",
    "film_force_rms",
    "dissipated_energy",
    "unloaded_share",
    "impacts_per_period_drive",
    "impact_impulse_mean_drive",
    "irregular_fraction",
    "periods_solved",
)


@pytest.mark.parametrize(("until", "periods"), [("steady", 10), ("periods", 60)])
def test_windows_are_the_same(until: str, periods: int, run, scene_text, tmp_path: Path) -> None:
    """Of motions that have not settled, and of those that return to the last bit: the same periods."""
    forces = (5.0, 100.0, 205.7, 300.0)
    solver = {
        "method": None,
        "steps_per_period": None,
        "samples_per_period": "2048",
        "periods": str(periods),
        "until": f"'{until}'",
    }
    changes = {"solver": solver, "spectrum": {"periods": "5"}}
    campaign = {
        "vary": "'load.force_amplitude'",
        "values(:, 1)": ", ".join(map(repr, forces)),
        "samples_per_period": "2048",
        "record": ", ".join(f"'{name}'" for name in (*QUANTITIES, "harmonics")),
    }
    (tmp_path / "many.nml").write_text(scene_text(scene={"task": "'campaign'"}, campaign=campaign, **changes))
    assert run("many.nml", cwd=tmp_path).returncode == 0
    rows = package.read_campaign(tmp_path / "results" / "many.rattle")
    (tmp_path / "one.nml").write_text(scene_text(**changes))
    for row, force in enumerate(forces):
        ended = run("--overwrite", "--set", f"load.force_amplitude={force!r}", "one.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        alone = summary_of(tmp_path / "results" / "one.summary.nml")
        assert alone["window_periods"] == 5
        told = {name: alone[name] for name in QUANTITIES}
        assert {name: rows[name][row] for name in QUANTITIES} == told
        assert [rows[f"harmonic_{n}"][row] for n in range(1, 9)] == alone["harmonics"][:8]


def test_a_row_without_a_rigid_film_knows_its_regime(run, scene_text, tmp_path: Path) -> None:
    """Such a film never was, so that it is not lost: status and regime are those of the single scene."""
    changes = {"film": {"law": "'piezo-viscous'", "model": "'reynolds'"}, "load": {"steady_force": "4e4"}}
    solver = {"method": None, "steps_per_period": None, "periods": "4"}
    campaign = {
        "vary": "'load.mass'",
        "values(:, 1)": "3.0, 4.0",
        "record": "'film_regime', 'law_contradicted'",
    }
    (tmp_path / "many.nml").write_text(
        scene_text(scene={"task": "'campaign'"}, solver=solver, campaign=campaign, **changes)
    )
    (tmp_path / "one.nml").write_text(scene_text(solver=solver, **changes))
    assert run("many.nml", cwd=tmp_path).returncode == 1
    assert run("one.nml", cwd=tmp_path).returncode == 1
    alone = summary_of(tmp_path / "results" / "one.summary.nml")
    told = (alone["status"], alone["film_regime"], alone["law_contradicted"])
    assert told == ("no_rigid_film", "elastohydrodynamic", True)
    rows = package.read_campaign(tmp_path / "results" / "many.rattle")
    assert list(rows["status"]) == [4.0, 4.0]
    assert list(rows["film_regime"]) == [3.0, 3.0] and list(rows["law_contradicted"]) == [1.0, 1.0]


@pytest.mark.parametrize(
    "number",
    (
        11,  # idle for irregular so far, by integrals that tell too little off the harmonics
        pytest.param(13, marks=pytest.mark.long),  # and too little of the harmonic distortion
        18,  # twice the samples are enough
        29,  # verified, though the tighter solution has too few samples and fewer harmonics than idle
        31,  # no motion but rounding, of which lines tell nothing
        131,  # and the row itself
    ),
)
def test_gear_inputs_of_the_study(number: int, rattle: Path, tmp_path: Path) -> None:
    """All quantities of random gear inputs, one of each kind whose rows once differed from single scenes."""
    case = gear_rows.draw(number, gear_rows.numeric_keys(rattle))
    assert list(gear_rows.faults_of(rattle, case, gear_rows.recordable(rattle), tmp_path)) == []
