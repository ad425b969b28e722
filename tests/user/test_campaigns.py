"""Campaigns as a user runs them: the same bytes however they are cut up, nothing lost however they stop."""

from __future__ import annotations

import os
import re
import signal
import subprocess
from pathlib import Path

import f90nml
import numpy as np
import pytest
from campaign_runs import BASE, grid, solve
from outcomes import digest, summary_of
from script_calls import call_script
from waiting import let_work, until

import rattle as package
from rattle.codes import CLASSES


@pytest.fixture
def folder(tmp_path: Path, scene_text) -> Path:
    """A folder with a campaign of 900 scenes, and its undisturbed result in `whole`."""
    (tmp_path / "scene.nml").write_text(grid(scene_text, 30, 30))
    return tmp_path


def test_grid_is_in_the_order_of_its_axes(run, folder: Path) -> None:
    result = package.read(solve(run, folder))
    assert result.closed and result.row_count == 900
    assert (result["scene"] == np.arange(1, 901)).all()
    force = result["load.force_amplitude"].reshape(30, 30)
    speed = result["kinematics.entrainment_speed"].reshape(30, 30)
    assert (force == force[:, :1]).all() and (speed == speed[:1]).all()
    assert (force[0, 0], force[-1, 0], speed[0, 0], speed[0, -1]) == (5.0, 400.0, 0.5, 20.0)
    assert np.isin(result["status"], [0.0, 1.0]).all()


def test_threads_and_parts_give_the_same_bytes(run, folder: Path) -> None:
    """One thread, two threads, and three parts merged."""
    whole = solve(run, folder, "--threads", 2)
    assert digest(solve(run, folder, "--threads", 1, name="one")) == digest(whole)
    for part in (1, 2, 3):
        options = ["--set", "campaign.parts=3", "--set", f"campaign.part={part}"]
        ended = run("--output", "parts", *options, "scene.nml", cwd=folder, timeout=600.0)
        assert ended.returncode == 0, ended.stderr
    parts = [folder / "parts" / f"scene.part-{part}-of-3.rattle" for part in (1, 2, 3)]
    merged = call_script("campaign.py", "merge", *parts, "--output", "joined.rattle", cwd=folder)
    assert merged.returncode == 0, merged.stderr
    assert digest(folder / "joined.rattle") == digest(whole)


def test_more_parts_than_chunks_merge(run, folder: Path) -> None:
    """Four chunks of a scene in six parts: two parts hold no scene, and the others are the whole."""
    small = ["--set", "campaign.count=2,2", "--set", "campaign.neighbours=F"]
    whole = solve(run, folder, *small)
    for part in range(1, 7):
        options = [*small, "--set", "campaign.parts=6", "--set", f"campaign.part={part}"]
        ended = run("--output", "parts", *options, "scene.nml", cwd=folder, timeout=600.0)
        assert ended.returncode == 0, ended.stderr
    parts = [folder / "parts" / f"scene.part-{part}-of-6.rattle" for part in range(1, 7)]
    assert [package.read_campaign(part).row_count for part in parts].count(0) == 2
    merged = call_script("campaign.py", "merge", *parts, "--output", "joined.rattle", cwd=folder)
    assert merged.returncode == 0, merged.stderr
    assert digest(folder / "joined.rattle") == digest(whole)
    merged = call_script("campaign.py", "merge", *parts[1:], "--output", "lacking.rattle", cwd=folder)
    assert merged.returncode == 2 and "of 6 parts these are not given: 1" in merged.stderr


@pytest.mark.parametrize(
    ("row", "samples", "tolerance"), [(464, 64, 0.0), (110, 64, 0.0), (629, 64, 1e-6), (899, 4096, 0.0)]
)
def test_a_scene_of_a_campaign_is_the_single_scene(
    row: int, samples: int, tolerance: float, run, folder: Path, scene_text
) -> None:
    """The same kernels and the same judge: film range and harmonics of a row come out of a single run.

    Idle by integrals over its steps, creep, and two irregular scenes, of which one needs more samples. One
    settles slowly; the campaign forecasts where, and comes to the same motion within the accuracy.
    """
    result = package.read(solve(run, folder))
    changes = {
        "load": {"force_amplitude": repr(float(result["load.force_amplitude"][row]))},
        "kinematics": {"entrainment_speed": repr(float(result["kinematics.entrainment_speed"][row]))},
        "solver": {**BASE["solver"], "samples_per_period": "64"},
        "spectrum": {"periods": "8", "verify": ".false."},
    }
    (folder / "single.nml").write_text(scene_text(**changes))
    assert run("--set", "output.series=.false.", "single.nml", cwd=folder).returncode == 0
    single = summary_of(folder / "results" / "single.summary.nml")
    assert single["samples_per_period"] == samples
    harmonics = [result[f"harmonic_{n}"][row] for n in range(1, 9)]
    assert single["film_minimum"] == pytest.approx(result["film_minimum"][row], rel=tolerance, abs=0.0)
    assert single["harmonics"][:8] == pytest.approx(harmonics, rel=0.0, abs=tolerance * max(harmonics))
    assert single["natural_frequency"] == result["natural_frequency"][row]


def test_recorded_quantities_hang_together(run, scene_text, tmp_path: Path) -> None:
    """Pressures exist below alpha p = 1 only; only a motion that repeats has a period."""
    record = "'periods_solved', 'orbit_period', 'alpha_p_maximum', 'pressure_maximum', 'deflection'"
    changes = {"campaign": {"record": record}, "solver": {**BASE["solver"], "periods": "14"}}
    text = grid(scene_text, 10, 10, film={"law": "'piezo-viscous'"}, **changes)
    (tmp_path / "scene.nml").write_text(text)
    result = package.read(solve(run, tmp_path))
    alpha_p, pressure = result["alpha_p_maximum"], result["pressure_maximum"]
    rigid = alpha_p < 1.0
    assert 0 < rigid.sum() < 100
    # Eq. (31), q = -ln(1 - alpha p)/alpha.
    np.testing.assert_allclose(1.0 - np.exp(-2e-8 * pressure[rigid]), alpha_p[rigid], rtol=1e-13)
    assert np.isnan(pressure[~rigid]).all() and np.isfinite(result["deflection"]).all()
    steady = result["status"] == 1.0
    assert 0 < steady.sum() < 100
    periods, orbit = result["periods_solved"], result["orbit_period"]
    assert (periods[steady] > orbit[steady]).all() and (orbit[steady] >= 1).all()
    assert (periods[~steady] == 14).all() and (orbit[~steady] == 1).all()  # looked for at their ends


@pytest.mark.parametrize("until", ["steady", "periods"])
def test_motion_known_to_repeat_is_subharmonic(until: str, run, scene_text, tmp_path: Path) -> None:
    """A steady run knows the orbit; solved for all periods, it is looked for at the end."""
    campaign = {
        "record": "'rattle_class', 'irregular_fraction', 'orbit_period', 'verified'",
        "first": "250.0, 8.0",
        "last": "450.0, 20.0",
        "samples_per_period": "256",
    }
    solver = {**BASE["solver"], "until": f"'{until}'", "periods": "120"}
    (tmp_path / "scene.nml").write_text(grid(scene_text, 8, 8, campaign=campaign, solver=solver))
    result = package.read(solve(run, tmp_path))
    names = np.array([CLASSES[int(code)] for code in result["rattle_class"]])
    off = result["irregular_fraction"] > 0.01
    np.testing.assert_array_equal(np.isin(names, ["irregular", "irregular_so_far", "subharmonic"]), off)
    repeats = result["orbit_period"] > 1
    subharmonic = names == "subharmonic"
    assert repeats.any() and subharmonic.any()
    assert repeats[subharmonic].all()
    assert (result["verified"][subharmonic] == 1.0).sum() > 10
    assert not (result["verified"][names == "irregular_so_far"] == 1.0).any()


HARD = {"first": "250.0, 8.0", "last": "450.0, 20.0"}


@pytest.mark.parametrize(
    ("law", "solver", "campaign", "fewest"),
    [
        ("iso-viscous", {"accuracy": "1e-2", "periods": "200"}, {"count": "6, 6"}, 1),
        ("iso-viscous", {"until": None, "periods": "120"}, {"count": "4, 4", **HARD}, 1),
        ("piezo-viscous", {}, {"count": "4, 4"}, 0),
    ],
    ids=["loose", "irregular", "piezo-viscous"],
)
def test_verified_scene_is_the_verified_single_scene(
    law: str, solver: dict, campaign: dict, fewest: int, run, scene_text, tmp_path: Path
) -> None:
    """Row by row what the verification of a single scene says, and of each verdict so many.

    A row and a single scene look for the same orbit at the same end, so that their classes are the same.
    """
    solver = {**BASE["solver"], **solver}
    film = {"law": f"'{law}'"}
    recorded = "'rattle_class', 'harmonic_count', 'sampling_sufficient', 'verified'"
    campaign = {"record": recorded, "samples_per_period": "1024", **campaign}
    (tmp_path / "scene.nml").write_text(grid(scene_text, 1, 1, solver=solver, film=film, campaign=campaign))
    result = package.read(solve(run, tmp_path))
    verified = result["verified"]
    assert np.isin(verified, [0.0, 1.0]).all()
    compared = {0.0: 0, 1.0: 0}
    # A single scene refines its samples where they are too few; then it judges another window.
    for row in np.flatnonzero(result["sampling_sufficient"] == 1.0):
        compared[verified[row]] += 1
        values = {
            "load": {"force_amplitude": repr(float(result["load.force_amplitude"][row]))},
            "kinematics": {"entrainment_speed": repr(float(result["kinematics.entrainment_speed"][row]))},
            "solver": {**solver, "samples_per_period": "1024"},
            "spectrum": {"periods": "8"},
            "film": film,
        }
        (tmp_path / "single.nml").write_text(scene_text(**values))
        assert (
            run("--overwrite", "--set", "output.series=.false.", "single.nml", cwd=tmp_path).returncode == 0
        )
        single = summary_of(tmp_path / "results" / "single.summary.nml")
        same = single["rattle_class"] == CLASSES[int(result["rattle_class"][row])]
        assert same, single
        assert (same and single["verification"] == "verified") == verified[row], single
    assert min(compared.values()) >= fewest, compared


def test_a_window_of_one_of_two_periods_verifies_nothing(run, scene_text, tmp_path: Path) -> None:
    """One period of a motion that repeats after two looks like one that repeats after it."""
    texts = {
        "film": {"law": "'piezo-viscous'"},
        "contact": {"length": "1.958e-3"},
        "load": {"steady_force": "38.27", "force_amplitude": "203.1", "frequency": "600.0"},
        "solver": {**BASE["solver"], "until": None, "accuracy": "1e-8", "periods": "200"},
        "spectrum": {"periods": "1"},
    }
    (tmp_path / "single.nml").write_text(scene_text(**texts))
    assert run("single.nml", cwd=tmp_path).returncode == 0
    reported = summary_of(tmp_path / "results" / "single.summary.nml")
    assert reported["orbit_period"] == 2 and reported["verification"] == "uncertain"
    assert not reported["verdict_verified"] and not reported["impacts_verified"]  # nor all impacts
    assert "Solved again, the window of one period begins with a film of" in reported["verification_text"]
    assert run("--overwrite", "--set", "spectrum.periods=8", "single.nml", cwd=tmp_path).returncode == 0
    longer = summary_of(tmp_path / "results" / "single.summary.nml")
    assert longer["rattle_class"] == "subharmonic" and longer["verification"] == "verified"
    assert longer["verdict_verified"] and longer["impacts_verified"]
    varied = {"vary": "'load.force_amplitude'", "first": "203.1", "last": "205.7", "count": "2"}
    campaign = {"record": "'rattle_class', 'verified'", "samples_per_period": "1024", **varied}
    whole = {"scene": {"task": "'campaign'"}, **texts, "campaign": campaign}
    (tmp_path / "scene.nml").write_text(scene_text(**whole))
    result = package.read(solve(run, tmp_path))
    assert (
        CLASSES[int(result["rattle_class"][0])] == reported["rattle_class"] and result["verified"][0] == 0.0
    )


def test_log_and_summary_count_what_is_not_verified(run, scene_text, tmp_path: Path) -> None:
    loose = {**BASE["solver"], "accuracy": "1e-2", "periods": "200"}
    campaign = {"record": "'rattle_class', 'verified'"}
    (tmp_path / "scene.nml").write_text(grid(scene_text, 6, 6, solver=loose, campaign=campaign))
    path = solve(run, tmp_path)
    failing = int((package.read(path)["verified"] == 0.0).sum())
    assert 0 < failing < 36
    log = path.with_suffix(".log").read_text()
    assert f", 0 failed, {failing} not verified" in log
    assert f"not verified     {failing} of 36 scenes: " in log
    assert summary_of(path.with_suffix(".summary.nml"))["scenes_not_verified_in_this_run"] == failing
    plain = solve(run, tmp_path, "--set", "campaign.record='rattle_class'", name="plain")
    assert "verified" not in plain.with_suffix(".log").read_text()
    assert "scenes_not_verified_in_this_run" not in summary_of(plain.with_suffix(".summary.nml"))


def test_verification_of_a_scene_does_not_depend_on_its_company(run, scene_text, tmp_path: Path) -> None:
    """Solved with others, irregular ones among them, and with hardly any: the same bits."""
    recorded = "'rattle_class', 'acceleration_maximum', 'harmonics', 'verified'"
    campaign = {"record": recorded, "count": "6, 6", **HARD}
    (tmp_path / "scene.nml").write_text(grid(scene_text, 1, 1, campaign=campaign))
    result = package.read(solve(run, tmp_path))
    assert {3.0, 4.0, 5.0} <= set(result["rattle_class"]) and (result["verified"] == 1.0).sum() > 10
    for row in range(0, 36, 5):
        ends = (
            repr(float(result[key][row])) for key in ("load.force_amplitude", "kinematics.entrainment_speed")
        )
        first = f"campaign.first={', '.join(ends)}"
        options = ("--set", "campaign.count=2, 2", "--set", first, "--set", "campaign.last=500.0, 30.0")
        again = package.read(solve(run, tmp_path, *options, name=f"row_{row}"))
        for name in list(again.columns)[3:]:
            assert again[name][0].tobytes() == result[name][row].tobytes(), (row, name)


def test_verified_is_for_those_who_ask(run, folder: Path) -> None:
    """The column changes no other one, and is unknown where a scene failed."""
    plain = package.read(solve(run, folder))
    columns = [name for name in plain.columns if name.startswith("film_m") or name == "rattle_class"]
    words = ", ".join(f"'{name}'" for name in [*columns, "verified"])
    few = ("--set", "campaign.count=5, 5", "--set", f"campaign.record={words}")
    asked = package.read(solve(run, folder, *few, name="asked"))
    alone = package.read(solve(run, folder, *few[:2], name="alone"))
    assert "verified" not in plain and list(asked.columns)[-1] == "verified"
    for name in columns:
        assert (asked[name] == alone[name]).all()
    invalid = (
        "--set",
        "load.steady_force=-29.0",
        "--set",
        "campaign.vary='load.mass', 'load.force_amplitude'",
    )
    ranges = (
        "--set",
        "campaign.scale='linear', 'linear'",
        "--set",
        "campaign.first=2, 5",
        "--set",
        "campaign.last=4, 9",
    )
    options = (*few, *invalid, *ranges, "--set", "campaign.allow_invalid=.true.")
    failed = package.read(solve(run, folder, *options, name="failed", code=1))
    known = np.isin(failed["status"], [0.0, 1.0])
    assert 0 < known.sum() < known.size
    assert (np.isfinite(failed["verified"]) == known).all()


def test_window_may_be_varied(run, scene_text, tmp_path: Path) -> None:
    """Every scene is judged by its own window, also by one longer than that of the base."""
    changes = {
        "solver": {**BASE["solver"], "until": None, "periods": "16"},
        "campaign": {
            "vary": "'spectrum.periods'",
            "scale": None,
            "first": None,
            "last": None,
            "count": None,
            "values(:, 1)": "2, 16, 4",
        },
    }
    windows = (2, 16, 4)
    (tmp_path / "scene.nml").write_text(grid(scene_text, 1, 1, **changes))
    result = package.read(solve(run, tmp_path))
    for row, periods in enumerate(windows):
        changes["spectrum"] = {"periods": str(periods)}
        changes["campaign"]["values(:, 1)"] = str(periods)
        (tmp_path / "scene.nml").write_text(grid(scene_text, 1, 1, **changes))
        alone = package.read(solve(run, tmp_path, name=f"alone_{periods}"))
        for name in set(alone.columns) - {"scene"}:
            assert alone[name][0] == result[name][row], (name, periods)
    assert len(set(result["film_minimum"])) > 1


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGUSR1, signal.SIGKILL])
def test_stopped_campaign_resumes_to_the_same_bytes(
    number: int, rattle: Path, run, scene_text, tmp_path: Path
) -> None:
    """Stopped at several moments, the finished file is that of the undisturbed run."""
    (tmp_path / "scene.nml").write_text(grid(scene_text, 60, 60))
    whole = digest(solve(run, tmp_path))
    command = [rattle, "--quiet", "--resume", "--output", "cut", "scene.nml"]
    codes = []
    for wait in (0.02, 0.05, 0.08, 0.12):
        process = subprocess.Popen(command, cwd=tmp_path)
        let_work(process, wait)
        process.send_signal(number)
        codes.append(process.wait(600))
    assert codes[0] in (-number, 128 + number)
    cut = tmp_path / "cut" / "scene.rattle"
    if codes[-1] != 0:
        assert not package.read(cut).closed
    assert digest(solve(run, tmp_path, "--resume", name="cut")) == whole


# Eight motions of a million periods. The second never repeats: it takes many minutes.
ENDLESS = {
    "load": {"force_amplitude": "993.1034482758621"},
    "solver": {**BASE["solver"], "periods": "1000000"},
    "campaign": {
        "vary": "'load.frequency'",
        "scale": None,
        "first": "44.2",
        "last": "44.3",
        "count": "8",
        "record": "'film_minimum'",
    },
}


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGUSR1], ids=lambda n: n.name)
def test_a_signal_ends_a_campaign_inside_a_chunk(
    number: int, rattle: Path, scene_text, tmp_path: Path
) -> None:
    """The scenes under way are not written; nothing else is lost."""
    (tmp_path / "scene.nml").write_text(grid(scene_text, 8, 1, **ENDLESS))
    result = tmp_path / "results" / "scene.rattle"
    process = subprocess.Popen([rattle, "--quiet", "scene.nml"], cwd=tmp_path)
    try:
        until(result.exists, process)
        let_work(process, 0.3)
        process.send_signal(number)
        assert process.wait(600) == 128 + number
    finally:
        process.kill()
    campaign = package.read_campaign(result)
    assert not campaign.closed and campaign.row_count == 8 and not campaign.done[1]
    assert summary_of(tmp_path / "results" / "scene.summary.nml")["status"] == "interrupted"


def test_scenes_before_a_slow_one_are_kept(rattle: Path, scene_text, tmp_path: Path) -> None:
    """Of twelve scenes the last takes many minutes: a kill loses it and what is solved beside it."""
    periods = ", ".join(map(str, [*range(20, 31), 1000000]))
    campaign = {"vary": "'solver.periods'", "values(:, 1)": periods, "record": "'film_minimum'"}
    none = dict.fromkeys(("scale", "first", "last", "count"))
    load = {**ENDLESS["load"], "frequency": "44.214285714285715"}
    changes = {**ENDLESS, "load": load, "campaign": {**none, **campaign}}
    (tmp_path / "scene.nml").write_text(grid(scene_text, 1, 1, **changes))
    result = tmp_path / "results" / "scene.rattle"
    process = subprocess.Popen([rattle, "--quiet", "--threads", "1", "scene.nml"], cwd=tmp_path)
    try:
        until(lambda: result.exists() and package.read_campaign(result).done.sum() >= 9, process)
    finally:
        process.kill()
        process.wait()
    campaign = package.read_campaign(result)
    assert not campaign.closed and campaign.done[:9].all() and not campaign.done[-1]


def test_a_signal_ends_the_check_of_a_campaign(rattle: Path, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(grid(scene_text, 8, 1, **ENDLESS))
    process = subprocess.Popen([rattle, "--check", "scene.nml"], cwd=tmp_path, stdout=subprocess.PIPE)
    let_work(process, 0.05)
    process.send_signal(signal.SIGTERM)
    stdout, _ = process.communicate(timeout=600.0)
    assert (process.returncode, stdout) == (128 + signal.SIGTERM, b"")


def test_check_of_a_campaign_tells_what_it_had_no_time_for(run, scene_text, tmp_path: Path) -> None:
    """Scenes that take too long, and more scenes than can be looked at."""
    (tmp_path / "scene.nml").write_text(grid(scene_text, 8, 1, **ENDLESS))
    ended = run("--check", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 0
    assert "! chunks              8 of at most 1 scene\n" in ended.stdout
    assert "8 scenes were not solved within 1 s" in ended.stdout
    many = {"count": "30000000, 300", "confirm_size": "t"}
    (tmp_path / "scene.nml").write_text(grid(scene_text, 2, 2, campaign=many))
    ended = run("--check", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 0
    found = re.search(r"! scenes +9000000000 \(0 invalid among the first (\d+); there was no", ended.stdout)
    assert found and int(found[1]) > 1000
    assert re.search(r"core time, estimated \S+ s, from \d+ scenes\n", ended.stdout)


def test_check_of_a_campaign_tells_how_large_it_becomes(run, scene_text, tmp_path: Path) -> None:
    """A last chunk that is not full counts, and a number has eight bytes."""
    scenes = {"sample": "'sobol'", "count": None, "size": "20201"}
    (tmp_path / "scene.nml").write_text(grid(scene_text, 2, 2, campaign=scenes))
    reported = run("--check", "scene.nml", cwd=tmp_path).stdout
    small = package.read_campaign(solve(run, tmp_path, "--set", "campaign.size=3"))
    assert "! scenes              20201 (0 invalid" in reported
    assert "! chunks              10101 of at most 2 scenes\n" in reported
    size = float(re.search(r"! result size +(\S+) MB\n", reported)[1])
    assert size == pytest.approx(20201 * 8 * len(small.names) / 1e6, rel=5e-3)


def test_override_of_one_element_keeps_the_others(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(grid(scene_text, 5, 7))
    counts = ("--set", "campaign.count(1)=3", "--set", "campaign.vary(2)=load.mass")
    ended = run("--check", *counts, "scene.nml", cwd=tmp_path)
    assert ended.returncode == 0
    assert "   count = 3.0, 7.0\n" in ended.stdout
    assert "   vary = 'load.force_amplitude', 'load.mass'\n" in ended.stdout


def test_invalid_scenes_are_named_with_key_and_place(refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(grid(scene_text, 2, 1, campaign={"first": "-5.0, 1.0"}))
    name = "scene.nml: &campaign: scene 1 is not valid: load.force_amplitude: -5.0 is not allowed"
    faults = refused("scene.nml", "--set", "campaign.count=2,2")
    assert faults[0].startswith(name) and len(faults) == 2
    (tmp_path / "table.csv").write_text("load.mass,load.steady_force\n3,10\n-3,10\n1,-50\n")
    none = dict.fromkeys(("vary", "scale", "first", "last", "count"))
    (tmp_path / "scene.nml").write_text(grid(scene_text, 1, 1, campaign={**none, "csv": "'table.csv'"}))
    faults = refused("scene.nml")
    assert [fault.split(" ")[0] for fault in faults] == ["table.csv:3:", "table.csv:4:"]
    assert "load.mass: -3.0 is not allowed; allowed: a number > 0.0" in faults[0]
    assert "the static load steady_force + mass*gravity must be positive" in faults[1]


def test_finished_scenes_are_not_solved_again(run, folder: Path) -> None:
    solve(run, folder)
    ended = run("--resume", "--output", "whole", "scene.nml", cwd=folder)
    assert ended.returncode == 0
    assert "900 of 900, 0 a second" in ended.stdout
    reported = f90nml.read(folder / "whole" / "scene.progress.nml")["summary"]
    assert (reported["scenes"], reported["scenes_done"], reported["scenes_failed"]) == (900, 900, 0)


def test_damaged_chunk_is_solved_again(run, folder: Path) -> None:
    path = solve(run, folder)
    before = digest(path)
    with path.open("r+b") as stream:
        stream.seek(-1000, os.SEEK_END)
        stream.write(b"damage")
    ended = run("--resume", "--output", "whole", "scene.nml", cwd=folder)
    assert ended.returncode == 0 and "damaged" in ended.stdout
    assert digest(path) == before


def test_resume_names_the_changed_key(run, folder: Path) -> None:
    before = digest(solve(run, folder))
    ended = run("--resume", "--output", "whole", "--set", "load.mass=4", "scene.nml", cwd=folder)
    assert ended.returncode == 2 and "load.mass" in ended.stderr
    assert digest(folder / "whole" / "scene.rattle") == before


def test_second_run_refuses(rattle: Path, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(grid(scene_text, 300, 300))
    first = subprocess.Popen([rattle, "--quiet", "--output", "whole", "scene.nml"], cwd=tmp_path)
    try:
        until((tmp_path / "whole" / "scene.rattle").exists, first)
        ended = run("--resume", "--output", "whole", "scene.nml", cwd=tmp_path)
        assert ended.returncode == 3
        assert "whole/scene is being written by another run" in ended.stderr
    finally:
        first.terminate()
        first.wait(600)


def test_samples_and_csv(run, scene_text, tmp_path: Path) -> None:
    """A sample has its size and its ranges; a table gives its own rows."""
    for seed in ("0", "5"):
        changes = {"sample": "'sobol'", "seed": seed, "size": "100", "count": None}
        (tmp_path / "scene.nml").write_text(grid(scene_text, 1, 1, campaign=changes))
        result = package.read(solve(run, tmp_path, name=f"seed_{seed}"))
        assert result.row_count == 100
        assert 5.0 <= result["load.force_amplitude"].min() <= result["load.force_amplitude"].max() <= 400.0
    (tmp_path / "table.csv").write_text("load.force_amplitude,load.mass\n10,3\n20,2.5\n30,4\n")
    changes = {key: None for key in ("vary", "scale", "first", "last", "count")}
    (tmp_path / "scene.nml").write_text(grid(scene_text, 1, 1, campaign={**changes, "csv": "'table.csv'"}))
    result = package.read(solve(run, tmp_path, name="csv"))
    assert (result["load.mass"] == [3.0, 2.5, 4.0]).all()
    # The table lies beside its input, wherever the program is called; a whole path is taken as it is.
    (tmp_path / "elsewhere").mkdir()
    whole = ("--set", f"campaign.csv='{tmp_path / 'table.csv'}'")
    for place, options in ((tmp_path / "a", ()), (tmp_path / "b", whole)):
        ended = run("../scene.nml", *options, "--output", place, cwd=tmp_path / "elsewhere")
        assert ended.returncode == 0, ended.stderr
        moved = package.read(place / "scene.rattle")
        for name in result.names:
            assert list(moved[name]) == list(result[name])


def test_bad_scene_among_good_ones(run, scene_text, tmp_path: Path) -> None:
    """Invalid scenes stop the campaign before it begins, unless they are allowed; then the rest is solved."""
    changes = {
        "vary": "'load.steady_force'",
        "scale": None,
        "first": "-100.0",
        "last": "200.0",
        "count": "31",
    }
    (tmp_path / "scene.nml").write_text(grid(scene_text, 1, 1, campaign=changes))
    ended = run("scene.nml", cwd=tmp_path)
    assert ended.returncode == 2 and "scene 1 " in ended.stderr
    assert not (tmp_path / "results").exists()
    result = package.read(solve(run, tmp_path, "--set", "campaign.allow_invalid=.true.", code=1))
    invalid = result["load.steady_force"] + 3.0 * 9.80665 <= 0.0
    assert (result["status"][invalid] == 9).all() and (result["status"][~invalid] <= 1).all()
    assert (
        np.isnan(result["film_minimum"][invalid]).all()
        and np.isfinite(result["film_minimum"][~invalid]).all()
    )


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"vary": "'load.force_amplitude', 'load.weight'"}, "load.weight"),
        ({"vary": "'load.force_amplitude', 'film.law'"}, "film.law"),
        ({"vary": "'load.force_amplitude', 'load.force_amplitude'"}, "twice"),
        ({"vary": "'load.force_amplitude', 'kinematics.rolling_speed'"}, "does not use"),
        ({"vary": "'load.force_amplitude', 'campaign.size'"}, "campaign.size"),
        ({"count": "10"}, "count(2)"),
        ({"count": "0, 10"}, "count"),
        ({"first": "400.0, 0.5"}, "force_amplitude"),
        ({"first": "5.0, 0.0"}, "entrainment_speed"),
        ({"csv": "'table.csv'"}, "either vary or csv"),
        ({"vary": None}, "either vary or csv"),
        ({"sample": "'sobol'", "count": None}, "size"),
        ({"record": "'everything'"}, "everything"),
        ({"part": "3", "parts": "2"}, "parts"),
        ({"count": "20000, 20000"}, "confirm_size"),
    ],
)
def test_bad_campaign(changes: dict, words: str, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "bad.nml").write_text(grid(scene_text, 10, 10, campaign=changes))
    ended = run("bad.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert words in ended.stderr and ended.stdout == ""
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("load.weight\n1\n", "load.weight"),
        ("load.mass,load.mass\n1,1\n", "mass"),
        ("load.mass,load.frequency\n1,2\n3\n", ":3"),
        ("load.mass\n1\nheavy\n", ":3"),
        ("load.mass\n1\nnan\n", ":3"),
        ("", "table.csv"),
        ("load.mass\n", "table.csv"),
    ],
)
def test_bad_table(table: str, words: str, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text(table)
    changes = {key: None for key in ("vary", "scale", "first", "last", "count")}
    (tmp_path / "bad.nml").write_text(grid(scene_text, 1, 1, campaign={**changes, "csv": "'table.csv'"}))
    ended = run("bad.nml", cwd=tmp_path)
    assert ended.returncode == 2 and words in ended.stderr


def test_check_tells_the_size(run, folder: Path) -> None:
    ended = run("--check", "scene.nml", cwd=folder)
    assert ended.returncode == 0
    assert "scenes              900 (0 invalid)" in ended.stdout and "core time" in ended.stdout
    assert not (folder / "results").exists()


def test_words_of_a_list_are_limited(refused, scene_text, tmp_path: Path) -> None:
    """Thousands of words set one by one would take minutes to read."""
    text = grid(scene_text, 2, 2).replace(
        "vary = ", "".join(f"vary({i}) = 'load.mass'\n" for i in range(1, 1002)) + "! "
    )
    (tmp_path / "scene.nml").write_text(text)
    faults = refused("--check", "scene.nml")
    assert any(fault.endswith("&campaign vary: at most 1000 elements are allowed") for fault in faults)


def test_samples_of_the_window_of_a_campaign(refused, run, scene_text, tmp_path: Path) -> None:
    """The window counts the samples that the campaign takes, not those of a motion."""
    text = grid(scene_text, 2, 2, spectrum={"periods": "60"}, campaign={"samples_per_period": "16384"})
    (tmp_path / "scene.nml").write_text(text)
    (fault,) = refused("--check", "scene.nml", "--set", "spectrum.periods=700", "--set", "solver.periods=700")
    assert "&campaign samples_per_period: the window of &spectrum periods would hold more" in fault
    longer = ("--set", "campaign.samples_per_period=32", "--set", "spectrum.periods=62500")
    assert run("--check", *longer, "--set", "solver.periods=62600", "scene.nml", cwd=tmp_path).returncode == 0
