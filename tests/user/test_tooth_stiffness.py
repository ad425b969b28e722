"""Rigid teeth: the program says where a steel tooth, 14 N/(um mm) of the contact length, would not be."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

import rattle

COLUMNS = "'film_thickness', 'film_load'"
LOOSE_GEAR = {
    "contact": {"radius": "7.5e-3", "length": "0.02"},
    "lubricant": {"viscosity": "0.05"},
    "kinematics": {"entrainment_speed": "1.07"},
    "load": {"mass": "0.45", "steady_force": "5.0", "force_amplitude": "2.0", "frequency": "26.7"},
}
SETTLED = {"solver": {"periods": "20", "steps_per_period": "256"}, "spectrum": {"periods": "2"}}


@pytest.mark.parametrize(("groups", "length", "matters"), [({}, 0.01, True), (LOOSE_GEAR, 0.02, False)])
def test_the_deflection_is_that_of_the_largest_load(groups, length, matters, run, scene_text, tmp_path: Path):
    output = {"columns": COLUMNS}
    (tmp_path / "scene.nml").write_text(scene_text(**groups, **SETTLED, output=output))
    ended = run("--verbose", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    summary = summary_of(tmp_path / "results" / "scene.summary.nml")
    result = rattle.read(tmp_path / "results" / "scene.rattle")
    film, load = (np.array(result[name])[-512:] for name in ("film_thickness", "film_load"))
    worst = int(np.argmax(load))
    assert summary["deflection_share"] == pytest.approx(
        load[worst] / (1.4e10 * length * film[worst]), rel=1e-9
    )
    assert summary["stiffness_matters"] == matters == (summary["deflection_share"] > 0.1)
    assert ("a steel tooth deflects by" in ended.stdout) == matters
    # A campaign that records nothing else finds the same.
    campaign = {
        "vary": "'load.mass'",
        "first": groups.get("load", {}).get("mass", "3.0"),
        "last": "10.0",
        "count": "2",
        "record": "'deflection_share', 'stiffness_matters'",
    }
    solver = {"method": None, "steps_per_period": None, "periods": "20", "accuracy": "1e-8"}
    changes = {"scene": {"task": "'campaign'"}, "solver": solver, "output": {"columns": None}}
    settled = {"spectrum": SETTLED["spectrum"]}
    (tmp_path / "campaign.nml").write_text(scene_text(**groups, **changes, **settled, campaign=campaign))
    ended = run("campaign.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    rows = rattle.read(tmp_path / "results" / "campaign.rattle")
    assert rows["deflection_share"][0] == pytest.approx(summary["deflection_share"], rel=0.05)
    assert rows["stiffness_matters"][0] == matters
    checked = run("--check", "scene.nml", cwd=tmp_path).stdout
    assert ("! warning: at rest a steel tooth deflects by 1.8 times the film" in checked) == matters
    steel = "fall into another class: steel ones have contact.stiffness = 1.4E8 N/m"
    assert (steel in checked) == matters
    assert "! deflection share at the steady film" in checked
