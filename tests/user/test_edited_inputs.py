"""--resume after an input was edited: results of another input are never replaced."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from campaign_runs import grid
from outcomes import contents

BEGIN_ANEW = "; --overwrite instead of --resume begins the run anew"

GEARBOX = """&gear
   name = '1st', teeth_1 = 11, teeth_2 = 38, normal_module = 2.5e-3, helix_angle_deg = 28.96
   face_width = 0.016, loose_inertia = 1.715e-3, drag_torque = 0.10, backlash = 1e-4
/
&gear
   name = '4th', teeth_1 = 33, teeth_2 = 32, normal_module = 1.85e-3, helix_angle_deg = 30.8
   face_width = 0.016, loose_inertia = 2.8e-4, drag_torque = 0.05, backlash = 8e-5
/
&shaft speed_rpm = 800.0, orders = 2.0, 4.0, accelerations = 600.0, 100.0 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 0.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver periods = 8, accuracy = 1e-6 /
&spectrum periods = 2 /
"""


def motion(scene_text, **changes: dict) -> str:
    return scene_text(**changes)


def sweep(scene_text, **changes: dict) -> str:
    solver = {"method": None, "steps_per_period": None, "periods": "60"}
    swept = {"key": "'frequency'", "first": "500.0", "last": "600.0", "count": "3"}
    return scene_text(scene={"task": "'sweep'"}, solver=solver, sweep=swept, **changes)


def film(scene_text, **changes: dict) -> str:
    absent = {"load": None, "film": None, "solver": None, "spectrum": None, "kinematics": None}
    points = {"film_ratios": "70e-6, 80e-6", "speed_groups": "0.45e-6", "compute": "'load', 'profile'"}
    points |= changes.pop("points", {})
    return scene_text(scene={"task": "'film'"}, points=points, **absent, **changes)


def threshold(scene_text, **changes: dict) -> str:
    return scene_text(
        scene={"task": "'threshold'"},
        solver={"method": None, "steps_per_period": None, "periods": "60", "accuracy": "1e-6"},
        spectrum={"periods": "2", "verify": ".false."},
        threshold={
            "key": "'load.force_amplitude'",
            "criterion": "'harmonic_distortion'",
            "level": "0.3",
            "first": "20.0",
            "last": "200.0",
            "count": "3",
            "tolerance": "0.1",
        },
        campaign={"vary": "'load.mass'", "first": "2.0", "last": "3.0", "count": "2"},
        **changes,
    )


def campaign(scene_text, **changes: dict) -> str:
    return grid(scene_text, 3, 2, **changes)


TASKS: dict[str, Callable[..., str]] = {
    "motion": motion,
    "sweep": sweep,
    "film": film,
    "threshold": threshold,
    "campaign": campaign,
}
EDITED = {task: {"lubricant": {"viscosity": "0.25"}} for task in TASKS}


@pytest.mark.parametrize("gone", [(), ("state",), ("state", "summary.nml")], ids="-".join)
@pytest.mark.parametrize("by", ["file", "standard input"])
@pytest.mark.parametrize("task", TASKS)
def test_a_finished_result_of_another_input_is_kept(
    task: str, by: str, gone: tuple[str, ...], run, scene_text, tmp_path: Path
) -> None:
    """The sentence names the key with both values, and nothing is touched; --overwrite is another matter."""
    call = ("--output", "elsewhere", "scene.nml" if by == "file" else "-")

    def ends(option: str, text: str):
        (tmp_path / "scene.nml").write_text(text)
        return run(option, *call, cwd=tmp_path, stdin=text if by != "file" else "")

    text = "&scene name = 'scene' /\n" if task == "motion" else ""
    first = text + TASKS[task](scene_text)
    edited = text + TASKS[task](scene_text, **EDITED[task])
    if task != "motion":
        first, edited = (
            given.replace("&scene\n", "&scene\n   name = 'scene'\n") for given in (first, edited)
        )
    assert ends("--quiet", first).returncode == 0
    for kind in gone:
        (tmp_path / "elsewhere" / f"scene.{kind}").unlink(missing_ok=True)
    before = contents(tmp_path / "elsewhere")
    ended = ends("--resume", edited)
    assert ended.returncode == 2
    assert "lubricant.viscosity is 0.25 now and was 0.3" in ended.stderr
    assert "--overwrite" in ended.stderr
    assert ended.stderr.count("\n") == 1
    assert contents(tmp_path / "elsewhere") == before
    assert ends("--resume", first).returncode == 0
    assert ends("--overwrite", edited).returncode == 0


def test_all_keys_that_differ_are_named(run, scene_text, tmp_path: Path) -> None:
    """Four with their values; more are counted."""
    (tmp_path / "scene.nml").write_text(sweep(scene_text))
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 0
    settings = ["contact.length=0.02", "lubricant.viscosity=0.2", "load.mass=2.0", "load.steady_force=180.0"]
    settings += ["load.frequency=500.0", "film.initial_velocity=0.1"]
    reported = [
        "contact.length is 0.02 now and was 0.01",
        "lubricant.viscosity is 0.2 now and was 0.3",
        "load.mass is 2.0 now and was 3.0",
        "load.steady_force is 180.0 now and was 199.2",
    ]
    for count, more in ((2, ""), (4, ""), (5, "; and 1 key more"), (6, "; and 2 keys more")):
        given = [word for setting in settings[:count] for word in ("--set", setting)]
        ended = run("--resume", *given, "scene.nml", cwd=tmp_path)
        words = "; ".join(reported[:count]) + more
        assert ended.stderr == (
            f"scene.nml: results/scene.rattle belongs to another scene: {words}{BEGIN_ANEW}\n"
        )


def test_profiles_of_another_film_task_are_kept(run, scene_text, tmp_path: Path) -> None:
    """Also where the table is gone and only they are left."""
    (tmp_path / "scene.nml").write_text(film(scene_text))
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 0
    for name in ("scene.rattle", "scene.summary.nml"):
        (tmp_path / "results" / name).unlink()
    before = contents(tmp_path / "results")
    (tmp_path / "scene.nml").write_text(film(scene_text, points={"film_ratios": "75e-6"}))
    ended = run("--resume", "scene.nml", cwd=tmp_path)
    assert (
        ended.returncode == 2 and "results/scene.profiles.rattle belongs to another scene: " in ended.stderr
    )
    assert contents(tmp_path / "results") == before


@pytest.mark.parametrize("task", TASKS)
def test_a_result_of_another_task_is_kept(task: str, run, scene_text, tmp_path: Path) -> None:
    """Whichever two tasks meet under one name."""
    (tmp_path / "scene.nml").write_text(TASKS[task](scene_text))
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 0
    before = contents(tmp_path / "results")
    for other in TASKS:
        if other == task:
            continue
        (tmp_path / "scene.nml").write_text(TASKS[other](scene_text))
        ended = run("--resume", "scene.nml", cwd=tmp_path)
        assert ended.returncode == 2, other
        assert "--overwrite" in ended.stderr
        assert contents(tmp_path / "results") == before


@pytest.mark.parametrize("task", TASKS)
def test_a_summary_whose_result_is_gone_is_kept(task: str, run, scene_text, tmp_path: Path) -> None:
    """Its input is not known any more: it could be that of any scene."""
    (tmp_path / "scene.nml").write_text(TASKS[task](scene_text))
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 0
    for path in (tmp_path / "results").glob("scene.*"):
        if path.name not in ("scene.summary.nml", "scene.log"):
            path.unlink()
    before = contents(tmp_path / "results")
    ended = run("--resume", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert "results/scene.summary.nml is of an earlier run whose result is missing" in ended.stderr
    assert contents(tmp_path / "results") == before
    assert run("--overwrite", "scene.nml", cwd=tmp_path).returncode == 0


def test_a_series_does_not_become_shorter(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text(solver={"periods": "20"}))
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 0
    before = contents(tmp_path / "results")
    shorter = ("--set", "solver.periods=19", "--set", "spectrum.periods=1")
    ended = run("--resume", *shorter, "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert contents(tmp_path / "results") == before
    assert "scene.rattle holds 641 rows; this run would end after 609" in ended.stderr
    assert run("--resume", "--set", "solver.periods=21", "scene.nml", cwd=tmp_path).returncode == 0


def test_more_periods_need_the_state(run, scene_text, tmp_path: Path) -> None:
    """Without it the run would begin anew, and replace what it does not go on with."""
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 0
    (tmp_path / "results" / "scene.state").unlink()
    ended = run("--resume", "--set", "solver.periods=9", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert "scene.rattle belongs to another scene: solver.periods is 9 now and was 3" in ended.stderr
    assert run("--resume", "scene.nml", cwd=tmp_path).returncode == 0


# --- several gears, parts, tables ------------------------------------------------------------------------


def test_every_pair_of_a_gearbox_is_held_against_its_own_result(run, tmp_path: Path) -> None:
    (tmp_path / "box.nml").write_text(GEARBOX)
    assert run("--quiet", "box.nml", cwd=tmp_path).returncode == 0
    for kind in ("state", "summary.nml"):
        (tmp_path / "results" / f"box.4th.{kind}").unlink(missing_ok=True)
    before = contents(tmp_path)
    (tmp_path / "box.nml").write_text(GEARBOX.replace("drag_torque = 0.05", "drag_torque = 0.06"))
    ended = run("--resume", "box.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert ended.stderr.startswith(
        "box.nml: results/box.4th.rattle belongs to another scene: gear.drag_torque is 0.06"
    )
    after = contents(tmp_path)
    before.pop("box.nml"), after.pop("box.nml")
    assert after == before


def test_the_table_of_another_gearbox_is_kept(run, tmp_path: Path) -> None:
    """A gear was taken out of the input: its row would be lost."""
    (tmp_path / "box.nml").write_text(GEARBOX)
    assert run("--quiet", "box.nml", cwd=tmp_path).returncode == 0
    before = contents(tmp_path / "results")
    (tmp_path / "box.nml").write_text(GEARBOX.replace("'4th'", "'5th'"))
    ended = run("--resume", "box.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert "box.summary.nml belongs to another gearbox: it has the gear '4th', which this input has not" in (
        ended.stderr
    )
    assert contents(tmp_path / "results") == before
    (tmp_path / "box.nml").write_text(GEARBOX)
    assert run("--resume", "box.nml", cwd=tmp_path).returncode == 0


@pytest.mark.parametrize("task", ["campaign", "threshold"])
def test_a_part_of_another_input_is_kept(task: str, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(TASKS[task](scene_text))
    part = ("--set", "campaign.part=2", "--set", "campaign.parts=2", "scene.nml")
    assert run("--quiet", *part, cwd=tmp_path).returncode == 0
    before = contents(tmp_path / "results")
    ended = run("--resume", "--set", "load.mass=2.5", "--set", "lubricant.viscosity=0.2", *part, cwd=tmp_path)
    assert ended.returncode == 2
    assert "lubricant.viscosity is 0.2 now and was 0.3" in ended.stderr
    assert contents(tmp_path / "results") == before


def test_the_result_of_a_threshold_over_another_table_is_kept(run, scene_text, tmp_path: Path) -> None:
    """The input is the same, the lines that it reads are not."""
    text = threshold(scene_text).replace("vary = 'load.mass'", "csv = 'lines.csv'")
    text = "".join(
        line + "\n"
        for line in text.splitlines()
        if line.strip() not in ("first = 2.0", "last = 3.0", "count = 2")
    )
    (tmp_path / "scene.nml").write_text(text)
    (tmp_path / "lines.csv").write_text("load.mass\n2.0\n3.0\n")
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 0
    before = contents(tmp_path / "results")
    (tmp_path / "lines.csv").write_text("load.mass\n2.0\n2.5\n")
    ended = run("--resume", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert "results/scene.rattle belongs to other traces: their CSV file has changed since" in ended.stderr
    assert contents(tmp_path / "results") == before


def test_a_signal_that_has_changed_is_another_input(run, repository: Path, tmp_path: Path) -> None:
    """The name of the file is the same; what counts are the orders that follow from it."""
    (tmp_path / "cycle.nml").write_text((repository / "input" / "engine_cycle.nml").read_text())
    table = (repository / "input" / "engine_cycle.csv").read_text().splitlines()
    (tmp_path / "engine_cycle.csv").write_text("\n".join(table) + "\n")
    quick = (
        "--quiet",
        "--set",
        "solver.until=periods",
        "--set",
        "solver.periods=20",
        "--set",
        "spectrum.verify=.false.",
    )
    assert run(*quick, "cycle.nml", cwd=tmp_path).returncode == 0
    (tmp_path / "results" / "cycle.state").unlink(missing_ok=True)
    head, rows = table[:2], table[2:]
    swung = [",".join([row.split(",")[0], repr(2.0 * float(row.split(",")[1]) - 800.0)]) for row in rows]
    (tmp_path / "engine_cycle.csv").write_text("\n".join([*head, *swung]) + "\n")
    before = contents(tmp_path / "results")
    ended = run("--resume", *quick, "cycle.nml", cwd=tmp_path)
    assert ended.returncode == 2 and "shaft.speed_amplitudes(1) is 0.2" in ended.stderr
    assert contents(tmp_path / "results") == before
