"""Impacts that last a millionth of a period: a summary holds within its errors, or is uncertain.

The true values are those of tests/stress/impact_steps.f90, implicit steps of another family than the
program's in the logarithm of the film and the velocity. They agree to all digits shown for tolerances of
1e-9 and 1e-11.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import pytest
from outcomes import summary_of

import rattle

EXTREMES = ("film_minimum", "film_maximum", "acceleration_minimum", "acceleration_maximum")


class Impact(NamedTuple):
    """A scene, and what it truly does."""

    contact: dict[str, str]
    lubricant: dict[str, str]
    speed: str
    load: dict[str, str]
    model: str
    periods: int
    extremes: tuple[float, float, float, float]
    harmonics: tuple[float, ...]
    rattle_class: str = "idle"


CANONICAL = {"mass": "3.0", "steady_force": "199.2", "force_amplitude": "700.0"}

IMPACTS = {
    "published": Impact(
        {"radius": "0.0127", "length": "0.010"},
        {"viscosity": "0.3", "pressure_viscosity": "2.0e-8"},
        "1.905",
        CANONICAL | {"frequency": "15.0"},
        "published",
        40,
        (1.453799161e-11, 6.406371143e-02, -309.5381453831, 9.082065098e10),
        (290.753660, 152.365003, 152.290528, 152.183600, 152.049741, 151.895811, 151.729096, 151.556651),
    ),
    "light_gear": Impact(
        {"radius": "0.01091706635700846", "length": "0.019974629588610647"},
        {"viscosity": "0.012632816758308378", "pressure_viscosity": "2e-8"},
        "0.6033019404262285",
        {
            "mass": "1.6195109460574217",
            "steady_force": "5.623621842971335",
            "force_amplitude": "85.60519638513276",
            "frequency": "6.9181530556873",
        },
        "reynolds",
        60,
        (4.615795737e-12, 8.649294481e-02, -66.13767376, 5.555776784e10),
        (66.9586314, 15.9180722, 5.82505215, 9.29384707, 19.1550459, 25.3461038, 26.1547759, 21.3843343),
        "subharmonic",
    ),
    "thick_oil": Impact(
        {"radius": "0.0127", "length": "0.02"},
        {"viscosity": "0.8", "pressure_viscosity": "2.0e-8"},
        "1.905",
        CANONICAL | {"frequency": "10.0"},
        "reynolds",
        60,
        (7.363236812e-10, 1.454694055e-01, -309.5335448247, 4.027543833e9),
        (292.827336, 152.259547, 152.109839, 151.934617, 151.748407, 151.563140, 151.387841, 151.228725),
    ),
    "thicker_oil": Impact(
        {"radius": "0.03", "length": "0.02"},
        {"viscosity": "1.0", "pressure_viscosity": "2.0e-8"},
        "1.905",
        CANONICAL | {"frequency": "10.0"},
        "reynolds",
        30,
        (1.520152605e-08, 1.473149410e-01, -309.5178704509, 1.946526149e8),
        (295.600653, 152.213996, 152.048852, 151.868805, 151.686146, 151.510608, 151.348484, 151.203135),
    ),
    "fast_teeth": Impact(
        {"radius": "0.01628723056124864", "length": "0.0037326479741209913"},
        {"viscosity": "0.010757408595482834", "pressure_viscosity": "2.448252609649449e-8"},
        "21.166213867607613",
        {
            "mass": "0.737281054018536",
            "steady_force": "28.552772564022717",
            "force_amplitude": "75.98343741804",
            "frequency": "353.02069406839377",
        },
        "published",
        60,
        (2.173175127e-10, 6.619284307e-05, -150.7215279930, 3.060518420e6),
        (154.777892, 92.3794967, 91.1932243, 90.3530230, 89.7031161, 89.1691886, 88.7132480, 88.3137684),
    ),
}


@pytest.mark.parametrize("until", ["periods", "steady"])
@pytest.mark.parametrize("name", IMPACTS)
def test_summary_of_an_impact_is_right_or_uncertain(
    name: str, until: str, run, scene_text, tmp_path: Path
) -> None:
    impact = IMPACTS[name]
    text = scene_text(
        contact=impact.contact,
        lubricant=impact.lubricant,
        kinematics={"entrainment_speed": impact.speed},
        load=impact.load,
        film={"model": f"'{impact.model}'"},
        solver={
            "method": "'taylor'",
            "steps_per_period": None,
            "periods": str(impact.periods),
            "until": f"'{until}'",
        },
        spectrum={"periods": "8"},
        output={"series": ".false."},
    )
    (tmp_path / "scene.nml").write_text(text)
    ended = run("scene.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0, ended
    summary = summary_of(tmp_path / "results" / "scene.summary.nml")
    if summary["verification"] != "verified":
        assert summary["verification"] == "uncertain"
        assert summary["verification_text"]
        return

    assert summary["rattle_class"] == impact.rattle_class
    # The true values have ten digits.
    for key, value in zip(EXTREMES, impact.extremes, strict=True):
        error = stated_error(summary, key) + 2e-9 * abs(value)
        assert summary[key] == pytest.approx(value, abs=error, rel=0.0), key
    for number, value in enumerate(impact.harmonics):
        error = summary["harmonic_errors"][number] + 2e-9 * impact.harmonics[0]
        assert summary["harmonics"][number] == pytest.approx(value, abs=error, rel=0.0), number + 1


def stated_error(summary: dict, key: str) -> float:
    """Error that the summary states of an extreme."""
    own = summary.get(f"{key}_error")
    if own is not None:
        return own
    return abs(summary[key]) * summary["film_error" if key.startswith("film") else "acceleration_error"]


def test_a_motion_that_is_irregular_now_and_then_is_uncertain(run, scene_text, tmp_path: Path) -> None:
    """A tooth in resonance that hits a flank once in a while: irregular in its window, quiet in the next.

    An independent solution finds the same window quiet: which one holds an impact is chance.
    """
    text = scene_text(
        contact={"radius": "0.02538974396158362", "length": "0.0072436764857351735"},
        lubricant={"viscosity": "0.1414601857217827", "pressure_viscosity": "2.1105558418418032e-8"},
        kinematics={"entrainment_speed": "4.16803105238128"},
        load={
            "mass": "0.5734554628920673",
            "steady_force": "0.5780725646130213",
            "force_amplitude": "111.5",
            "frequency": "56.53389784980788",
        },
        film={"model": "'reynolds'"},
        solver={
            "method": "'taylor'",
            "steps_per_period": None,
            "samples_per_period": "512",
            "until": "'steady'",
            "periods": "200",
        },
        spectrum={"periods": "4"},
    )
    (tmp_path / "scene.nml").write_text(text)
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    summary = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert summary["rattle_class"] == "irregular"
    assert summary["verification"] == "uncertain"
    # It flies, now and then beyond what the film law means.
    assert re.search("too few impacts|beyond a tenth of the radius", summary["verification_text"])


def test_a_row_counts_the_power_beyond_its_harmonics(run, scene_text, tmp_path: Path) -> None:
    """Impacts that vary by little: of 40 harmonics 0.95 % of the power is off them, of 64 more than 1 %.

    The row is judged by integrals over the steps, the single scene by as many samples as it needs.
    """
    groups = {
        "contact": {"radius": "6.960643911700479E-3", "length": "1.2598553549434646E-2"},
        "lubricant": {"viscosity": "0.45777672202660397", "pressure_viscosity": "1.4575512381037433E-8"},
        "kinematics": {"entrainment_speed": "8.669381583240355"},
        "load": {
            "mass": "3.8409554852085526",
            "steady_force": "8.078884764028755",
            "force_amplitude": "2.7129121323930496",
            "frequency": "13.335801378129023",
            "gravity": "0.0",
        },
        "film": {"model": "'reynolds'"},
        "solver": {"method": "'taylor'", "steps_per_period": None, "accuracy": "1.0e-4", "periods": "37"},
        "spectrum": {"periods": "16"},
    }
    (tmp_path / "scene.nml").write_text(scene_text(**groups, output={"series": ".false."}))
    assert run("scene.nml", cwd=tmp_path, timeout=600.0).returncode == 0
    campaign = {
        "vary(1)": "'load.force_amplitude'",
        "first(1)": "2.7129121323930496",
        "last(1)": "2.8",
        "count(1)": "2",
        "scale(1)": "'linear'",
    }
    (tmp_path / "row.nml").write_text(scene_text(scene={"task": "'campaign'"}, campaign=campaign, **groups))
    assert run("row.nml", cwd=tmp_path, timeout=600.0).returncode == 0
    row = rattle.read_campaign(tmp_path / "results" / "row.rattle")
    assert row["sampling_sufficient"][0] == 1.0
    assert row["irregular_fraction"][0] > 0.01
    assert row["rattle_class"][0] == 6.0  # the motion settles: irregular so far
    assert summary_of(tmp_path / "results" / "scene.summary.nml")["rattle_class"] == "irregular_so_far"


def test_a_window_shorter_than_the_motion_does_not_tell_all_impacts(run, scene_text, tmp_path: Path) -> None:
    """The tooth hits its only flank in one of three periods: a window of another one has none. One of two is
    followed on over whole repeats."""
    changes = {
        "contact": {"radius": "0.0361043", "length": "2.402676e-3"},
        "lubricant": {"viscosity": "0.0333384"},
        "kinematics": {"entrainment_speed": "0.464067"},
        "load": {
            "mass": "0.169181",
            "steady_force": "4.889613",
            "force_amplitude": "51.91411",
            "frequency": "59.84857",
            "gravity": "9.80665",
        },
        "film": {"law": "'iso-viscous'", "model": "'reynolds'"},
        "solver": {"method": "'taylor'", "steps_per_period": None, "accuracy": "1e-8", "periods": "1000"},
    }
    (tmp_path / "scene.nml").write_text(scene_text(**changes))
    verdicts = {1: ("separation", False, False), 2: (None, True, True), 3: (None, True, True)}
    for window, (verdict, stands, numbers_stand) in verdicts.items():
        ended = run("--overwrite", "--set", f"spectrum.periods={window}", "scene.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        reported = summary_of(tmp_path / "results" / "scene.summary.nml")
        assert reported["orbit_period"] == 3 and reported["verdict"] in (verdict, "single-sided impacts")
        assert reported["verdict_verified"] == (stands or reported["verdict"] != "separation")
        assert reported["impacts_verified"] == numbers_stand
