"""Rows of campaigns with several starts: motions of single scenes, the same bytes however cut up."""

from __future__ import annotations

import itertools
import math
import subprocess
from pathlib import Path

import numpy as np
import pytest
from campaign_runs import solve
from gearbox_pairs import one_pair
from outcomes import digest, summary_of
from script_calls import call_script
from waiting import let_work

import rattle as package

COLUMNS = (
    "'rattle_class', 'acceleration_rms', 'film_force_rms', 'film_minimum', 'steady_film', 'verified', "
    "'verdict', 'motions', 'starts_solved', 'start_periods', 'loudest_class', 'loudest_verdict', "
    "'unsettled_starts', 'loudest_acceleration_rms', "
    "'loudest_film_force_rms', 'loudest_film_minimum', 'quietest_class', 'quietest_acceleration_rms'"
)
OF_STARTS = ("motions", "starts_solved", "start_periods", "unsettled_starts", "loudest", "quietest")
MASS = 3.0
# A lightly damped contact about its resonance: over a band of frequencies two motions are possible.
FOLD = f"""
&scene task = 'campaign' /
&contact radius = 0.0127, length = 2.0e-3 /
&lubricant viscosity = 0.3, pressure_viscosity = 2.0e-8 /
&kinematics entrainment_speed = 15.0 /
&load mass = {MASS}, steady_force = 38.27, force_amplitude = 35.0, frequency = 270.0, gravity = 0.0 /
&film law = 'iso-viscous', model = 'published' /
&solver until = 'steady', periods = 300 /
&campaign
   vary = 'load.force_amplitude', 'load.frequency'
   first = 15.0, 250.0
   last = 35.0, 320.0
   count = 9, 29
   record = {COLUMNS}
/
"""
FEW = ("--set", "campaign.count=3,15")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a campaign of 261 scenes in three blocks."""
    (tmp_path / "scene.nml").write_text(FOLD)
    return tmp_path


def single_motions(result: package.Result, row: int) -> list[dict]:
    """Summaries of single scenes from rest, from the far end of the room of the motion, out of its middle."""
    force, frequency = (float(result[f"load.{key}"][row]) for key in ("force_amplitude", "frequency"))
    rest = float(result["steady_film"][row])
    omega = 2.0 * math.pi * frequency
    room = rest + 2.0 * force / (MASS * omega**2)
    starts = [(rest, 0.0), (room, 0.0), (0.5 * room, -4.0 * force / (MASS * omega))]
    found = []
    for film, velocity in starts:
        scene = FOLD[: FOLD.index("&campaign")].replace("'campaign'", "'motion'")
        keys = {
            "load.force_amplitude": force,
            "load.frequency": frequency,
            "film.initial_film": film,
            "film.initial_velocity": velocity,
            "solver.starts": 1,
            "output.series": False,
        }
        found.append(dict(package.run(scene, set=keys).summary))
    return found


def test_rows_tell_the_motions_of_single_scenes(run, folder: Path) -> None:
    """As many motions as single scenes from the same starts have, and the loudest of them to the accuracy."""
    result = package.read(solve(run, folder, *FEW, "--set", "campaign.neighbours=F"))
    several = result["motions"] > 1.0
    assert several.any() and (result["starts_solved"] == 3.0).all() and not result["unsettled_starts"].any()
    for row in [*np.flatnonzero(several), 0, 20, 44]:
        reported = single_motions(result, row)
        rms = sorted(one["acceleration_rms"] for one in reported)
        # Motions of these scenes differ by more than a tenth, or are the same within the accuracy.
        kinds = 1 + sum(after > 1.1 * before for before, after in itertools.pairwise(rms))
        assert kinds == result["motions"][row], (row, rms)
        loudest = max(reported, key=lambda one: one["acceleration_rms"])
        for name in ("acceleration_rms", "film_force_rms", "film_minimum"):
            assert result[f"loudest_{name}"][row] == pytest.approx(loudest[name], rel=1e-4), (row, name)
        assert result["quietest_acceleration_rms"][row] == pytest.approx(rms[0], rel=1e-4)
        words = package.codes.CLASSES
        assert words[int(result["loudest_class"][row])] == loudest["rattle_class"]
        words = package.codes.CODES["verdict"]
        assert words[int(result["loudest_verdict"][row])] == loudest["verdict"], row
    one = result["motions"] == 1.0
    for name in ("acceleration_rms", "film_force_rms", "film_minimum", "verdict"):
        np.testing.assert_array_equal(result[f"loudest_{name}"][one], result[name][one])
    # The verdicts of loudest motions are reported by their own impacts, not by those of the motion from rest.
    assert (result["loudest_verdict"] != result["verdict"]).any()


def test_other_columns_are_those_of_the_motion_from_rest(run, folder: Path) -> None:
    """With one start or several, with neighbours or without: the same bits, those of the starts excepted."""
    alone = package.read(solve(run, folder, *FEW, "--set", "solver.starts=1", name="alone"))
    assert (alone["motions"] == 1.0).all() and (alone["starts_solved"] == 1.0).all()
    np.testing.assert_array_equal(alone["loudest_acceleration_rms"], alone["acceleration_rms"])
    many = package.read(solve(run, folder, *FEW))
    for name in many.columns:
        if not name.startswith(OF_STARTS):
            assert many[name].tobytes() == alone[name].tobytes(), name
    assert (many["motions"] >= alone["motions"]).all() and (many["motions"] > 1.0).any()


def test_neighbours_hand_on_their_motions(run, folder: Path) -> None:
    """Where starts miss a motion that a neighbour has, it is found from there; nothing is lost."""
    without = package.read(solve(run, folder, "--set", "campaign.neighbours=F", name="without"))
    handed = package.read(solve(run, folder, name="handed"))
    assert (handed["motions"] >= without["motions"]).all()
    assert (handed["motions"] > without["motions"]).any()
    assert (handed["starts_solved"] >= without["starts_solved"]).all()
    # No scene lacks a motion that the next one along the fast axis shakes by, unless it was tried there.
    shape = (9, 29)
    motions, tried = handed["motions"].reshape(shape), handed["starts_solved"].reshape(shape)
    lacking = (motions[:, :-1] == 1.0) & (motions[:, 1:] > 1.0)
    assert lacking.any() and (tried[:, :-1][lacking] > 3.0).all()


def test_threads_parts_and_kills_give_the_same_bytes(rattle: Path, run, folder: Path) -> None:
    """One thread, two threads, three parts merged, a run that was killed and resumed."""
    whole = digest(solve(run, folder, "--threads", 2))
    assert digest(solve(run, folder, "--threads", 1, name="one")) == whole
    for part in (1, 2, 3):
        options = ["--set", "campaign.parts=3", "--set", f"campaign.part={part}"]
        assert run("--output", "parts", *options, "scene.nml", cwd=folder).returncode == 0
    parts = [folder / "parts" / f"scene.part-{part}-of-3.rattle" for part in (1, 2, 3)]
    merged = call_script("campaign.py", "merge", *parts, "--output", "joined.rattle", cwd=folder)
    assert merged.returncode == 0, merged.stderr
    assert digest(folder / "joined.rattle") == whole
    command = [rattle, "--quiet", "--resume", "--threads", "1", "--output", "cut", "scene.nml"]
    for wait in (0.02, 0.05, 0.08):
        process = subprocess.Popen(command, cwd=folder)
        let_work(process, wait)
        process.kill()
        process.wait(600)
    assert digest(solve(run, folder, "--resume", name="cut")) == whole


def test_log_and_summary_tell_of_several_motions(run, folder: Path) -> None:
    """A line of the log says how many scenes, and that more starts might find more."""
    path = solve(run, folder, *FEW)
    several = int((package.read(path)["motions"] > 1.0).sum())
    absence = "do not prove that there are no others"
    line = f"  motions          several at {several} of 45 scenes; 3 starts and neighbours {absence}"
    assert line in path.with_suffix(".log").read_text().splitlines()
    assert summary_of(path.with_suffix(".summary.nml"))["scenes_with_several_motions_in_this_run"] == several
    path = solve(run, folder, *FEW, "--set", "campaign.neighbours=F", "--set", "solver.starts=5", name="five")
    assert f"; 5 starts {absence}" in path.with_suffix(".log").read_text()
    path = solve(run, folder, *FEW, "--set", "solver.starts=1", name="alone")
    assert "several at" not in path.with_suffix(".log").read_text()
    quiet = ("--set", "campaign.record='rattle_class'")
    path = solve(run, folder, *FEW, *quiet, name="unasked")
    assert "several at" not in path.with_suffix(".log").read_text()


def test_a_damped_contact_has_one_start(run, folder: Path) -> None:
    """A contact that is damped by more than half of the critical damping needs none but rest."""
    settings = ("contact.length=0.01", "kinematics.entrainment_speed=1.905", "load.steady_force=199.2")
    damped = [word for setting in settings for word in ("--set", setting)]
    reported = package.read(solve(run, folder, *FEW, *damped))
    assert (reported["motions"] == 1.0).all() and (reported["starts_solved"] == 1.0).all()


def test_a_scene_that_fails_has_no_motions(run, folder: Path) -> None:
    """What no film carries is neither one motion nor none."""
    invalid = (
        "--set",
        "campaign.vary='load.steady_force', 'load.frequency'",
        "--set",
        "campaign.first=-5,250",
    )
    path = solve(run, folder, *FEW, *invalid, "--set", "campaign.allow_invalid=T", code=1)
    result = package.read(path)
    failed = ~np.isin(result["status"], [0.0, 1.0])
    assert failed.any() and not failed.all()
    for name in result.columns:
        if name.startswith(OF_STARTS):
            np.testing.assert_array_equal(np.isnan(result[name]), failed, err_msg=name)


@pytest.fixture
def gearbox(repository: Path, tmp_path: Path) -> str:
    """The text of gearbox_map, its table beside the scenes of the test."""
    (tmp_path / "gearbox_run_up.csv").write_bytes((repository / "input" / "gearbox_run_up.csv").read_bytes())
    return (repository / "input" / "gearbox_map.nml").read_text()


def reported_alone(run, folder: Path, text: str, *keys: str) -> dict:
    """The summary of a scene of a campaign by itself."""
    alone = folder / "alone.nml"
    alone.write_text(text.replace("'campaign'", "'motion'"))
    ended = run(*(word for key in keys for word in ("--set", key)), alone, cwd=folder)
    assert ended.returncode == 0, ended.stderr
    return summary_of(folder / "results" / "alone.summary.nml")


@pytest.mark.long
def test_a_motion_that_settles_slowly_is_reported_once(run, gearbox: str, tmp_path: Path) -> None:
    """After 60 periods the motion from rest still creeps along, far from where others have settled."""
    text = one_pair(gearbox, 3)
    (tmp_path / "scene.nml").write_text(
        f"{text}&campaign vary = 'oil.temperature_celsius', values(:, 1) = 80.0\n"
        f"   record = {COLUMNS}, 'orbit_period' /\n"
    )
    row = package.read(solve(run, tmp_path, "--set", "shaft.speed_rpm=1800.0"))
    assert row["orbit_period"][0] == 0.0
    assert (row["motions"][0], row["unsettled_starts"][0]) == (1.0, 0.0)
    reported = reported_alone(
        run, tmp_path, text, "shaft.speed_rpm=1800.0", "oil.temperature_celsius=80.0", "solver.periods=200"
    )
    assert reported["motions"] == 1
    assert row["loudest_acceleration_rms"][0] == pytest.approx(reported["acceleration_rms"], rel=1e-4)


def test_the_louder_of_two_slow_motions_is_reported(run, gearbox: str, tmp_path: Path) -> None:
    """After 60 periods none of three starts has settled; two lead to a louder motion of three periods."""
    text = one_pair(gearbox, 2)
    (tmp_path / "scene.nml").write_text(
        f"{text}&campaign vary = 'oil.temperature_celsius', values(:, 1) = 59.24\n"
        f"   record = {COLUMNS}, 'orbit_period' /\n"
    )
    keys = ("shaft.speed_rpm=2122.53", "gear.tooth_stiffness=1.24131e7")
    row = package.read(solve(run, tmp_path, *(word for key in keys for word in ("--set", key))))
    assert row["orbit_period"][0] == 0.0
    assert (row["motions"][0], row["unsettled_starts"][0]) == (2.0, 0.0)
    reported_alone(run, tmp_path, text, *keys, "oil.temperature_celsius=59.24", "solver.periods=200")
    motions = package.read(tmp_path / "results" / "alone.motions.rattle")
    loudest = int(np.argmax(motions["acceleration_rms"]))
    assert motions["orbit_period"][loudest] == 3.0
    # Either is of a window of whole periods of the motion; a row is solved to 1e-6 of the film.
    assert row["loudest_acceleration_rms"][0] == pytest.approx(motions["acceleration_rms"][loudest], rel=1e-4)


@pytest.mark.long
def test_a_row_tells_the_motion_that_rest_comes_to_late(run, gearbox: str, tmp_path: Path) -> None:
    """Soft teeth: the motion from rest has 239 m/s2 after 60 periods, and repeats with 184 after 1351."""
    text = one_pair(gearbox, 1)
    (tmp_path / "scene.nml").write_text(
        f"{text}&campaign vary = 'oil.temperature_celsius', values(:, 1) = 15.0\n   record = {COLUMNS} /\n"
    )
    keys = ("shaft.speed_rpm=2520", "gear.tooth_stiffness=1.2e7")
    row = package.read(solve(run, tmp_path, *(word for key in keys for word in ("--set", key))))
    assert (row["motions"][0], row["unsettled_starts"][0]) == (1.0, 0.0)
    late = ("oil.temperature_celsius=15.0", "solver.periods=2000", "solver.starts=1")
    reported = reported_alone(run, tmp_path, text, *keys, *late)
    assert reported["orbit_period"] == 1
    assert row["loudest_acceleration_rms"][0] == pytest.approx(reported["acceleration_rms"], rel=1e-4)
