"""film.model = automatic: by the closure, in nodes where that does not do, and reported which."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of
from waiting import until

import rattle as package
from rattle.codes import word

GEAR = """&contact radius = 9.1e-3, length = 0.019, backlash = 110.0e-6, stiffness = 2.4e8 /
&lubricant viscosity = 0.02, pressure_viscosity = 1.6e-8, viscosity_law = 'roelands' /
&kinematics rolling_speed = 2.8 /
&load mass = 0.62, steady_force = 2.0, gravity = 0.0, frequency = 30.0, force_amplitude = 6.0 /
&film law = 'elastohydrodynamic', model = 'automatic' /
&solver until = 'steady', periods = 40, starts = 1, samples_per_period = 256 /
&spectrum periods = 2 /
"""
FORCES = (0.5, 2.0, 6.0, 20.0, 60.0)
RECORD = (
    *("film_minimum", "acceleration_maximum", "acceleration_minimum", "load_maximum", "coast_load_maximum"),
    *("verdict", "impacts_per_period_drive", "film_force_rms", "harmonic_distortion", "rattle_class"),
    *("verified", "verdict_verified", "pressure_maximum", "closure_range"),
)
CAMPAIGN = (
    "&scene name = 'rows', task = 'campaign' /\n"
    + GEAR
    + "&campaign vary = 'load.force_amplitude', values(:, 1) = "
    + ", ".join(map(str, FORCES))
    + ", neighbours = .false., record = "
    + ", ".join(f"'{name}'" for name in RECORD)
    + " /\n"
)


@pytest.fixture(scope="module")
def rows(run, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("automatic")
    (folder / "rows.nml").write_text(CAMPAIGN)
    ended = run("--output", "one", "--threads", "1", "rows.nml", cwd=folder)
    assert ended.returncode == 0, ended.stderr
    return folder


@pytest.mark.long
def test_rows_are_single_scenes_of_the_model_they_tell(rows: Path) -> None:
    table = package.read(rows / "one/rows.rattle")
    models = ["", "closure", "resolved"]
    reported = [models[round(code)] for code in table["film_model"]]
    assert set(reported) == {"closure", "resolved"}
    for place, (force, model) in enumerate(zip(FORCES, reported, strict=True)):
        settings = {"load.force_amplitude": force, "film.model": model}
        alone = package.run(GEAR, set=settings).summary
        for name in RECORD:
            if name not in alone:  # a single scene in nodes has no closure to be within its range
                continue
            row = table[name][place]
            reported_row = word(name, row) if isinstance(alone[name], str) else row
            assert reported_row == alone[name], (force, model, name)
        assert (table["verified"][place] == 1) == (alone["verification"] == "verified")
        # A single scene chooses as its row has.
        chosen = package.run(GEAR, set={"load.force_amplitude": force}).summary
        assert chosen["model"] == model and chosen["film_model"] == model and chosen["model_text"]
        assert chosen["acceleration_maximum"] == alone["acceleration_maximum"]


@pytest.mark.parametrize("forces", [(2.0, 60.0), pytest.param(FORCES, marks=pytest.mark.long)])
def test_threads_and_parts_leave_the_same_bytes(forces: tuple[float, ...], run, tmp_path: Path) -> None:
    listed = ", ".join(map(str, forces))
    (tmp_path / "rows.nml").write_text(CAMPAIGN.replace(", ".join(map(str, FORCES)), listed))
    for folder, threads in (("one", 1), ("two", 2)):
        ended = run("--output", folder, "--threads", threads, "rows.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
    assert (tmp_path / "two/rows.rattle").read_bytes() == (tmp_path / "one/rows.rattle").read_bytes()
    columns = package.read(tmp_path / "one/rows.rattle")
    assert {1.0, 2.0} == set(columns["film_model"])
    for part in (1, 2):
        parts = ("--set", "campaign.parts=2", "--set", f"campaign.part={part}")
        ended = run("--output", "parts", *parts, "rows.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
    found = [package.read(path) for path in sorted((tmp_path / "parts").glob("rows.part-*.rattle"))]
    for name in columns.names:
        joined = np.concatenate([np.array(part[name]) for part in found])
        np.testing.assert_array_equal(joined, np.array(columns[name]))


@pytest.mark.long
def test_a_campaign_that_is_killed_and_resumed_has_the_same_bytes(rows: Path, run, rattle: Path) -> None:
    """Killed twice among rows by the closure and rows in nodes; each time some are not solved yet."""
    forces = ", ".join(f"{0.5 * 1.5**k:.4f}" for k in range(12))
    (rows / "many.nml").write_text(
        CAMPAIGN.replace(", ".join(map(str, FORCES)), forces).replace("'rows'", "'many'")
    )
    ended = run("--output", "whole", "--threads", "1", "many.nml", cwd=rows)
    assert ended.returncode == 0, ended.stderr
    models = np.array(package.read(rows / "whole/many.rattle")["film_model"])
    assert {1.0, 2.0} <= set(models)
    result = rows / "cut/many.rattle"
    for least in (3, 7):
        process = subprocess.Popen(
            [rattle, "--quiet", "--resume", "--threads", "1", "--output", "cut", "many.nml"], cwd=rows
        )
        try:
            until(lambda n=least: result.exists() and package.read_campaign(result).done.sum() >= n, process)
        finally:
            process.kill()
            process.wait()
        done = package.read_campaign(result).done
        assert least <= done.sum() < len(done)
    ended = run("--output", "cut", "--resume", "--threads", "1", "many.nml", cwd=rows)
    assert ended.returncode == 0, ended.stderr
    assert result.read_bytes() == (rows / "whole/many.rattle").read_bytes()


@pytest.mark.long
def test_rows_whose_verdict_stands_near_its_limit_are_solved_in_nodes(run, tmp_path: Path) -> None:
    """Roelands' closure may be off by 2.4 % of a load below M = 2: a limit within that of the largest load of
    a flank is asked of nodes, one farther off is not."""
    strong = {"load.force_amplitude": 6.0}
    closure = package.run(GEAR, set={**strong, "film.model": "closure"}).summary
    loads = np.array([closure["load_maximum"], closure["coast_load_maximum"]])
    (tmp_path / "rows.nml").write_text(CAMPAIGN.replace("0.5, 2.0, 6.0, 20.0, 60.0", "6.0, 6.5"))
    assert loads.min() > 1.2 * (2.0 + 6.0) and abs(loads[0] / loads[1] - 1.0) > 0.1
    for load, shares in zip(loads, ((0.99, 1.01, 0.94, 1.06), (0.99, 1.06)), strict=True):
        for share in shares:
            limit = float(share * load / (2.0 + 6.0))
            chosen = ("--set", f"spectrum.impact_limit={limit!r}", "--overwrite", "--output", "out")
            ended = run(*chosen, "rows.nml", cwd=tmp_path)
            assert ended.returncode == 0, ended.stderr
            table = package.read(tmp_path / "out/rows.rattle")
            in_nodes = abs(share - 1.0) < 0.02
            assert round(table["film_model"][0]) == 1 + in_nodes, (load, share)
            alone = package.run(GEAR, set={**strong, "spectrum.impact_limit": limit}).summary
            assert alone["acceleration_maximum"] == table["acceleration_maximum"][0]
            assert alone["verdict"] == word("verdict", table["verdict"][0])
            assert ("within the error of the closure" in alone["model_text"]) == in_nodes


def test_a_scene_says_why(run, tmp_path: Path) -> None:
    (tmp_path / "single.nml").write_text(GEAR)
    for force, words in ((60.0, "fitted to films up to M = 2"), (2.0, "")):
        folder = f"why_{force:g}"
        setting = ("--set", f"load.force_amplitude={force}")
        ended = run("--verbose", "--output", folder, *setting, "single.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        reported = summary_of(tmp_path / folder / "single.summary.nml")
        assert words in reported["model_text"] and reported["model_text"][:40] in ended.stdout


@pytest.mark.parametrize(
    ("old", "new", "message"),
    (
        ("task = 'campaign'", "task = 'threshold'", "'automatic' is for task = 'motion' or 'campaign'"),
        (
            "'elastohydrodynamic', model",
            "'iso-viscous', model",
            "'automatic' needs law = 'elastohydrodynamic'",
        ),
        ("model = 'automatic'", "model = 'automatic', nodes = 40", "not a number of nodes"),
    ),
)
def test_what_makes_no_sense_is_refused(old: str, new: str, message: str, run, tmp_path: Path) -> None:
    (tmp_path / "rows.nml").write_text(CAMPAIGN.replace(old, new))
    ended = run("rows.nml", cwd=tmp_path)
    assert ended.returncode == 2 and message in ended.stderr, ended.stderr
