"""Sweeps, films and campaigns at the edge: what is refused, and what just is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

import rattle as package

SOLVER = {"steps_per_period": None, "method": None, "periods": "40"}
WEIGHT = 3.0 * 9.80665  # of the mass of the scene; the static load is Q + m g


def sweep_text(scene_text, key: str, first: str, last: str, spacing: str = "linear") -> str:
    sweep = {"key": f"'{key}'", "first": first, "last": last, "count": "3", "spacing": f"'{spacing}'"}
    return scene_text(scene={"task": "'sweep'"}, solver=SOLVER, sweep=sweep)


@pytest.mark.parametrize(
    ("key", "first", "last", "spacing", "fault"),
    [
        ("frequency", "600.0", "600.0", "linear", "last: it must differ from first"),
        ("frequency", "0.0", "600.0", "linear", "first: not allowed for frequency"),
        ("frequency", "600.0", "-1.0", "linear", "last: not allowed for frequency"),
        ("force_amplitude", "-1.0", "10.0", "linear", "first: not allowed for force_amplitude"),
        ("force_amplitude", "0.0", "10.0", "logarithmic", "first: not allowed for force_amplitude"),
        ("force_amplitude", "10.0", "0.0", "logarithmic", "last: not allowed for force_amplitude"),
        ("steady_force", "-10.0", "100.0", "logarithmic", "first: not allowed for steady_force"),
        ("steady_force", str(-WEIGHT - 0.01), "100.0", "linear", "first: the static load"),
        ("steady_force", "100.0", str(-WEIGHT - 0.01), "linear", "last: the static load"),
        ("entrainment_speed", "0.0", "2.0", "linear", "first: not allowed for entrainment_speed"),
    ],
)
def test_sweeps_that_are_refused(key, first, last, spacing, fault, refused, scene_text, tmp_path: Path):
    (tmp_path / "bad.nml").write_text(sweep_text(scene_text, key, first, last, spacing))
    found = refused("bad.nml")
    assert len(found) == 1 and f"&sweep {fault}" in found[0]


@pytest.mark.parametrize(
    ("key", "first", "last", "spacing"),
    [
        ("force_amplitude", "0.0", "10.0", "linear"),
        ("steady_force", "-10.0", "100.0", "linear"),
        ("steady_force", "100.0", str(-WEIGHT + 0.01), "linear"),
        ("frequency", "600.0", "300.0", "logarithmic"),
    ],
)
def test_sweeps_that_just_are_not_refused(key, first, last, spacing, run, scene_text, tmp_path: Path):
    (tmp_path / "good.nml").write_text(sweep_text(scene_text, key, first, last, spacing))
    assert run("--check", "good.nml", cwd=tmp_path).returncode == 0


def test_a_sweep_begins_anew_behind_a_motion_that_failed(run, scene_text, tmp_path: Path):
    """To the last bit the motion that starts from its own steady film, not from what is left of another."""
    options = ["--set", "film.law=piezo-viscous", "--set", "film.model=reynolds", "--set", "sweep.turn=f"]
    options += ["--set", "load.force_amplitude=100", "--set", "sweep.count=2"]
    for name, first, last, code in (("behind", "80.0", "20.0", 1), ("fresh", "20.0", "30.0", 0)):
        (tmp_path / f"{name}.nml").write_text(sweep_text(scene_text, "steady_force", first, last))
        assert run(*options, f"{name}.nml", cwd=tmp_path).returncode == code
    behind, fresh = (package.read(tmp_path / "results" / f"{name}.rattle") for name in ("behind", "fresh"))
    assert behind["status"][0] > 1.0 and behind["film_minimum"][0] == 0.0
    assert behind["status"][1] <= 1.0 and behind["film_minimum"][1] > 0.0
    for name in behind.columns:
        assert behind[name][1] == fresh[name][0], name


@pytest.mark.parametrize(("cells", "code"), [("64", 0), ("65", 2)])
def test_the_reference_solution_needs_an_even_number_of_cells(cells, code, run, scene_text, tmp_path: Path):
    groups = {"load": None, "solver": None, "spectrum": None, "kinematics": None}
    points = {"film_ratios": "70e-6", "speed_groups": "0.4e-6", "cells": cells}
    film = {"law": None, "model": "'numerical'"}
    (tmp_path / "film.nml").write_text(
        scene_text(scene={"task": "'film'"}, points=points, film=film, **groups)
    )
    ended = run("--check", "film.nml", cwd=tmp_path)
    assert ended.returncode == code
    assert ("&points cells: an even number is needed" in ended.stderr) == (code == 2)


@pytest.mark.parametrize(("count", "code"), [("5000000", 0), ("5000001", 2), ("10000001", 2)])
def test_ten_million_points_are_enough(count, code, run, scene_text, tmp_path: Path):
    """Two speed groups, and as many films as that leaves room for."""
    groups = {"load": None, "solver": None, "spectrum": None, "kinematics": None, "film": {"law": None}}
    points = {"film_ratio_range": f"1e-5, 1e-4, {count}", "speed_groups": "0.4e-6, 0.5e-6"}
    (tmp_path / "film.nml").write_text(scene_text(scene={"task": "'film'"}, points=points, **groups))
    ended = run("--check", "film.nml", cwd=tmp_path)
    assert ended.returncode == code, ended.stderr
    assert ("&points film_ratio_range: " in ended.stderr) == (code == 2)
    assert ("the lists make more than 10000000 points" in ended.stderr) == (count == "5000001")


@pytest.mark.parametrize(("forces", "failed"), [("20.0, 50.0", 0), ("20.0, 900.0", 1)])
def test_one_failed_scene_is_enough_for_exit_1(forces, failed, run, scene_text, tmp_path: Path):
    campaign = {"vary": "'load.force_amplitude'", "values(:, 1)": forces}
    film = {"law": "'piezo-viscous'", "model": "'reynolds'"}
    load = {"steady_force": "30.0"}
    text = scene_text(scene={"task": "'campaign'"}, solver=SOLVER, campaign=campaign, film=film, load=load)
    (tmp_path / "many.nml").write_text(text)
    ended = run("many.nml", cwd=tmp_path)
    assert ended.returncode == failed, ended.stderr
    reported = summary_of(tmp_path / "results" / "many.summary.nml")
    assert (reported["scenes_done"], reported["scenes_failed_in_this_run"]) == (2, failed)
    assert (
        np.array(package.read_campaign(tmp_path / "results" / "many.rattle")["status"]) > 1.0
    ).sum() == failed
