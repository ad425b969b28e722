"""Numbers that lead out of the range of the reals are refused with the key and its place; none crashes."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from outcomes import assert_no_crash

sys.path.insert(0, str(Path(__file__).parents[1] / "stress"))
import extreme_numbers

MACHINES = ("contact", "lubricant", "kinematics", "load", "film", "points")


# Groups that only some of the inputs have; gear, shaft and oil replace keys of the others (test_gear_inputs).
OWN_GROUPS = ("sweep", "points", "campaign", "threshold", "gear", "shaft", "oil")


@pytest.fixture(scope="module")
def keys(rattle: Path) -> list[extreme_numbers.Key]:
    found = extreme_numbers.numeric_keys(rattle)
    assert {key.group for key in found} > {*MACHINES, "solver", "spectrum", "sweep", "campaign"}
    return found


def test_ranges_are_wide_and_bounded(keys) -> None:
    """Every key of a machine is bounded on both sides, and by a margin beyond what machines have."""
    bounded = {key.name: key.ends for key in keys if key.group in MACHINES and key.group != "points"}
    for name, ends in bounded.items():
        assert len(ends) == 2, name
        assert name == "poisson_ratio" or ends[1] >= 0.1
    assert bounded["radius"] == (1e-10, 1e7) and bounded["mass"] == (1e-10, 1e9)


@pytest.mark.long
@pytest.mark.parametrize(
    "title",
    ["published", "exact piezo", "newmark", "sweep", "film", "film of groups", "campaign", "threshold"],
)
def test_every_key_at_extremes(title: str, keys, run, tmp_path: Path) -> None:
    """--check knows the place of what is too large or too small; what it takes has a natural frequency."""
    refused = 0
    for key in keys:
        if key.group in OWN_GROUPS and key.group not in extreme_numbers.BASES[title]:
            continue
        for number in extreme_numbers.EXTREMES:
            for groups in extreme_numbers.with_key(extreme_numbers.BASES[title], key, number):
                text = extreme_numbers.namelist(groups)
                (tmp_path / "scene.nml").write_text(text)
                ended = run("--check", "scene.nml", cwd=tmp_path)
                assert ended.returncode in (0, 2), (key, number, ended)
                assert_no_crash(ended.stderr)
                assert "natural frequency                    0" not in ended.stdout, (key, number)
                if ended.returncode == 0:
                    outside = len(key.ends) == 2 and not key.ends[0] <= number <= key.ends[1]
                    assert not outside, (key, number)
                elif "too large or too small" in ended.stderr:
                    line = next(
                        n for n, line in enumerate(text.splitlines(), 1) if f"   {key.name} = " in line
                    )
                    assert f"scene.nml:{line}: &{key.group} {key.name}: " in ended.stderr
                    refused += 1
    assert refused > 40


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        (
            {"contact": {"radius": "1e300"}},
            "&contact radius: 1.0E300 m gives numbers too large or too small",
        ),
        ({"load": {"mass": "1e-300"}}, "&load mass: 1.0E-300 kg gives numbers too large or too small"),
        (
            {"lubricant": {"pressure_viscosity": "1e300"}},
            "&lubricant pressure_viscosity: 1.0E300 1/Pa gives",
        ),
        ({"load": {"steady_force": "1e-13", "gravity": "0.0"}}, "&load steady_force: the static load"),
        ({"load": {"mass": "1e200", "gravity": "1e200"}}, "&load mass: 1.0E200 kg gives numbers"),
        (
            {"kinematics": {"entrainment_speed": None, "surface_speed_1": "1e-10", "surface_speed_2": "0.0"}},
            "&kinematics surface_speed_1: the sum of both surface speeds must be positive, at least 2e-9 m/s",
        ),
    ],
)
def test_refusal_says_where_and_why(changes: dict, fault: str, refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text(**changes))
    assert any(fault in line for line in refused("--check", "scene.nml"))


def test_extremes_of_a_campaign_are_invalid_scenes(run, tmp_path: Path) -> None:
    """A value that would overflow is named with its scene, or recorded as an invalid scene."""
    base = extreme_numbers.BASES["campaign"]
    varied = {
        "vary": "'load.mass'",
        "first": "",
        "last": "",
        "count": "",
        "values(:, 1)": "3.0, 1e300, -1e300",
    }
    text = extreme_numbers.namelist(extreme_numbers.merged(base, {"campaign": varied}))
    (tmp_path / "scene.nml").write_text(text)
    assert "(2 invalid)" in run("--check", "scene.nml", cwd=tmp_path).stdout
    refused = run("--check", "--set", "campaign.allow_invalid=.false.", "scene.nml", cwd=tmp_path)
    assert refused.returncode == 2
    assert "scene 2 is not valid: load.mass: 1.0E300 kg gives numbers too large" in refused.stderr
