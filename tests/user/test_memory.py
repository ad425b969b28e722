"""Too little memory is reported in a sentence, with exit code 3, and leaves nothing behind."""

from __future__ import annotations

import resource
from pathlib import Path

import numpy as np
import pytest
from campaign_runs import BASE, grid, solve
from outcomes import assert_no_crash, contents

from rattle import read_campaign

pytestmark = pytest.mark.long

MILLION = 1_000_000
CONTROLLED = {"method": "'taylor'", "steps_per_period": None}
FILM = {
    "kinematics": None,
    "load": None,
    "film": None,
    "solver": None,
    "spectrum": None,
    "scene": {"task": "'film'"},
    "points": {"film_ratios": "70.0e-6", "speed_groups": "0.45e-6"},
}
SWEEP = {
    "scene": {"task": "'sweep'"},
    "sweep": {"key": "'frequency'", "first": "500.0", "last": "600.0", "count": "2"},
}
RANGE = {"film_ratios": None, "film_ratio_range": "35.0e-6, 140.0e-6, 5000000"}

# What is asked for, at how many million bytes, and which keys the sentence names.
SHORTAGES = {
    "newmark": (
        {"solver": {"steps_per_period": "100000"}, "spectrum": {"periods": "3"}},
        100,
        "&spectrum periods",
    ),
    "taylor": (
        {
            "solver": {**CONTROLLED, "samples_per_period": "1000003", "periods": "1"},
            "spectrum": {"periods": "1"},
        },
        200,
        "&solver samples_per_period",
    ),
    "sweep": ({**SWEEP, "solver": {**CONTROLLED, "samples_per_period": "400000"}}, 120, "&spectrum periods"),
    "values of a sweep": (
        {**SWEEP, "solver": CONTROLLED, "sweep": {**SWEEP["sweep"], "count": "1000000"}},
        90,
        "&sweep count",
    ),
    "points of a film": ({**FILM, "points": {**FILM["points"], **RANGE}}, 100, "&points film_ratio_range"),
    "profile of a film": (
        {**FILM, "points": {**FILM["points"], "profile_nodes": "1000000", "compute": "'profile'"}},
        130,
        "profile_nodes",
    ),
    "cells of a film": (
        {
            **FILM,
            "film": {"law": None, "model": "'numerical'"},
            "points": {**FILM["points"], "cells": "1000000"},
        },
        130,
        "cells",
    ),
    "anything": ({}, 40, "&spectrum periods"),
}


def limited(megabytes: int) -> dict[str, object]:
    """Options of a call with so much memory."""
    return {
        "preexec_fn": lambda: resource.setrlimit(
            resource.RLIMIT_AS, (megabytes * MILLION, megabytes * MILLION)
        )
    }


def assert_shortage(ended, name: str) -> None:
    assert ended.returncode == 3, ended.stderr
    assert_no_crash(ended.stderr + ended.stdout)
    assert ended.stderr.count("\n") == 1
    assert "out of memory" in ended.stderr
    assert " MB" in ended.stderr
    assert name in ended.stderr


@pytest.mark.parametrize("options", [(), ("--check",)], ids=["run", "check"])
@pytest.mark.parametrize("case", SHORTAGES)
def test_shortage_is_reported(case: str, options: tuple[str, ...], run, scene_text, tmp_path: Path) -> None:
    changes, megabytes, name = SHORTAGES[case]
    (tmp_path / "scene.nml").write_text(scene_text(**changes))
    before = contents(tmp_path)
    assert_shortage(run(*options, "scene.nml", cwd=tmp_path, **limited(megabytes)), name)
    assert contents(tmp_path) == before


def test_more_than_the_machine_has(refused, scene_text, tmp_path: Path) -> None:
    """What no memory of this machine holds is a fault of the input."""
    changes = {"campaign": {"count": "1000000000, 1000000000", "confirm_size": ".true."}}
    (tmp_path / "scene.nml").write_text(grid(scene_text, 2, 2, **changes))
    fault = f"{'1' + 18 * '0'} scenes"
    for options in ((), ("--check",)):
        (reported,) = refused(*options, "scene.nml")
        assert fault in reported
        assert "this machine has" in reported


def test_threads_of_a_campaign_need_memory(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(grid(scene_text, 4, 4, campaign={"samples_per_period": "16384"}))
    for options in ((), ("--check",)):
        ended = run("--threads", "2", *options, "scene.nml", cwd=tmp_path, **limited(150))
        assert_shortage(ended, "&campaign samples_per_period = 16384")
        assert "2 threads (--threads)" in ended.stderr
    assert not (tmp_path / "results").exists()


def table(scene_text, forces: range, **changes: dict) -> dict[str, str]:
    """A campaign over a table of forces, by the names of its files."""
    lines = "".join(f"{force}.5\n" for force in forces)
    campaign = {"csv": "'scenes.csv'", **changes.pop("campaign", {})}
    return {
        "scene.nml": scene_text(**{**BASE, **changes}, campaign=campaign),
        "scenes.csv": f"load.force_amplitude\n{lines}",
    }


def test_long_table_needs_memory(run, scene_text, tmp_path: Path) -> None:
    for name, text in table(scene_text, range(1_000_000)).items():
        (tmp_path / name).write_text(text)
    before = contents(tmp_path)
    ended = run("scene.nml", cwd=tmp_path, **limited(80))
    assert_shortage(ended, "1000001 lines (&campaign csv)")
    assert contents(tmp_path) == before


def test_rows_do_not_depend_on_how_many_scenes_fit(run, scene_text, tmp_path: Path) -> None:
    """Scenes of many samples are solved some at a time: 16 MB each here."""
    columns = []
    for folder, forces in (("all", range(10, 406, 11)), ("some", range(120, 307, 11))):
        (tmp_path / folder).mkdir()
        files = table(
            scene_text,
            forces,
            solver={**BASE["solver"], "until": "'periods'", "starts": "1"},
            spectrum={"periods": "60"},
            campaign={"samples_per_period": "16384"},
        )
        for name, text in files.items():
            (tmp_path / folder / name).write_text(text)
        result = read_campaign(solve(run, tmp_path / folder, "--threads", "1", **limited(560)))
        columns.append({name: np.asarray(result[name]) for name in result.names if name != "scene"})
    whole, part = columns
    assert len(whole["status"]) == 36
    for name, values in part.items():
        np.testing.assert_array_equal(whole[name][10 : 10 + len(values)], values, err_msg=name)


def test_rows_do_not_depend_on_memory(run, scene_text, tmp_path: Path) -> None:
    """Where there is none for the samples of a row the campaign ends, and goes on where there is more."""
    # Few scenes, but windows of which more samples take more than all of them.
    long_window = {"solver": {**BASE["solver"], "periods": "40"}, "spectrum": {"periods": "32"}}
    (tmp_path / "scene.nml").write_text(grid(scene_text, 8, 8, **long_window))
    threads = ("--threads", "2")
    undisturbed = solve(run, tmp_path, *threads).read_bytes()
    words = []
    for megabytes in range(112, 184, 8):
        folder = f"at {megabytes}"
        ended = run("--output", folder, *threads, "scene.nml", cwd=tmp_path, **limited(megabytes))
        if ended.returncode != 0:
            assert_shortage(ended, "&spectrum periods")
        words.append(ended.stderr)
        result = solve(run, tmp_path, "--resume", *threads, name=folder)
        assert result.read_bytes() == undisturbed, folder
    assert any("samples, which impacts as short as these ask for" in reported for reported in words), words
