"""Motions of one operating point: reported, sealed, started again, followed by an independent solver."""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from gearbox_pairs import one_pair
from outcomes import summary_of
from scipy.integrate import solve_ivp
from script_calls import call_script

import rattle as package

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reference"))
import elastohydrodynamic_closure

# A pair that comes back to one motion from everywhere within a few periods.
LOOSE = {
    "contact": {"radius": "7.5e-3", "length": "0.02", "backlash": "1.0e-4"},
    "lubricant": {"viscosity": "0.05", "pressure_viscosity": "2.0e-8"},
    "kinematics": {"entrainment_speed": "1.07"},
    "load": {
        "mass": "0.45",
        "steady_force": "5.0",
        "gravity": "0.0",
        "frequency": "26.7",
        "force_amplitude": "7.9",
    },
    "film": {"law": "'iso-viscous'", "model": "'reynolds'"},
    "solver": {"method": "'taylor'", "steps_per_period": None, "periods": "40"},
}


@pytest.fixture(scope="module")
def two_motions(run, repository: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder in which the ready input with two motions was solved."""
    folder = tmp_path_factory.mktemp("two_motions")
    ended = run(repository / "input" / "two_motions.nml", cwd=folder)
    assert ended.returncode == 0, ended.stderr
    return folder


def test_both_motions_are_reported(two_motions: Path) -> None:
    results = two_motions / "results"
    reported = summary_of(results / "two_motions.summary.nml")
    assert (reported["motions"], reported["starts_solved"], reported["unsettled_starts"]) == (2, 29, 0)
    table = package.read(results / "two_motions.rattle").motions
    frame = table.frame()
    assert frame.rattle_class_word.tolist() == ["idle", "subharmonic"]
    assert frame.orbit_period.tolist() == [1, 2] and frame.starts.sum() == 29
    assert frame.from_own_start.tolist() == [1, 0]
    # The columns that there were are those of the motion from rest; table and summary agree.
    assert reported["rattle_class"] == reported["quietest_class"] == "idle"
    assert reported["acceleration_rms"] == reported["quietest_acceleration_rms"] == frame.acceleration_rms[0]
    assert reported["loudest_class"] == "subharmonic"
    for name in ("acceleration_rms", "film_force_rms", "film_minimum"):
        assert reported[f"loudest_{name}"] == frame[name][1]
    assert frame.film_force_rms[1] > 1.2 * frame.film_force_rms[0]
    assert (frame.floquet_modulus < 1.0).all()
    log = (results / "two_motions.log").read_text()
    assert re.search(r": idle \((numerically verified|uncertain)\), from rest\n", log)
    sentence = re.search(
        r"2 motions: idle 27\.\d+ m/s2 \(from rest, (\d+) of 29 starts\), "
        r"subharmonic 35\.\d+ m/s2 \((\d+) of 29\)",
        log,
    )
    assert [int(starts) for starts in sentence.groups()] == frame.starts.tolist()
    assert reported["motions_text"].startswith(sentence[0])


def test_a_motion_starts_again_by_its_film_and_velocity(run, repository: Path, two_motions: Path) -> None:
    frame = package.read(two_motions / "results" / "two_motions.motions.rattle").frame()
    assert frame.restarts.all()
    for row in frame.itertuples():
        ended = run(
            *("--set", f"film.initial_film={row.film!r}", "--set", f"film.initial_velocity={row.velocity!r}"),
            *("--set", "solver.starts=1", "--set", "scene.name='again'", "--overwrite"),
            repository / "input" / "two_motions.nml",
            cwd=two_motions,
        )
        assert ended.returncode == 0, ended.stderr
        reported = summary_of(two_motions / "results" / "again.summary.nml")
        assert reported["rattle_class"] == row.rattle_class_word
        assert reported["orbit_period"] == row.orbit_period
        for name in ("acceleration_rms", "film_force_rms", "film_minimum"):
            assert reported[name] == pytest.approx(getattr(row, name), rel=1e-5)


@pytest.mark.long
def test_an_independent_solver_stays_on_each_motion(two_motions: Path) -> None:
    """scipy's Radau method on the equations of springs and Reynolds films, from the reported state."""
    reported = summary_of(two_motions / "results" / "two_motions.summary.nml")
    frame = package.read(two_motions / "results" / "two_motions.motions.rattle").frame()
    radius, mass, stiffness = (float(reported[name]) for name in ("radius", "mass", "stiffness"))
    speed = 2.0 * reported["entrainment_speed"]
    group = 12.0 * reported["length"] * speed * reported["viscosity"] * radius
    orders, amplitudes, phases = (
        np.array(reported[f"force_{name}"]) for name in ("orders", "amplitudes", "phases")
    )
    turn = 2.0 * math.pi * reported["frequency"]

    def velocity(film, compression):
        """Velocity at which a film carries its spring, by the inverse of Phi(A)."""
        load = math.log(max(stiffness * compression * film / group, 1e-300))
        return (
            0.25
            * speed
            * math.sqrt(2.0 * film / radius)
            * math.sinh(float(elastohydrodynamic_closure.INVERSE(load)))
        )

    def rates(time, state):
        """Film, velocity of the gear and both compressions, all in micrometres."""
        film, gear, drive, coast = 1e-6 * state
        other = reported["backlash"] - film + drive + coast
        squeeze = velocity(film, drive)
        force = reported["steady_force"] + np.sum(amplitudes * np.cos(orders * turn * time + phases))
        acceleration = (stiffness * (drive - coast) - force) / mass
        return 1e6 * np.array([squeeze, acceleration, squeeze - gear, velocity(other, coast) + gear])

    for row in frame.itertuples():
        start = 1e6 * np.array([row.film, row.velocity, row.drive_compression, row.coast_compression])
        period = row.orbit_period / reported["frequency"]
        solution = solve_ivp(
            rates, (0.0, period), start, method="Radau", rtol=1e-7, atol=1e-11, dense_output=True
        )
        assert solution.success
        # Back where it began: within a thousandth of the gap, and of the characteristic velocity.
        swing = float(np.sum(amplitudes / (mass * orders * turn)))
        assert abs(solution.y[0, -1] - start[0]) < 1e-3 * 1e6 * reported["backlash"]
        assert abs(solution.y[1, -1] - start[1]) < 1e-3 * 1e6 * swing
        # The integral of the square of the acceleration over the steps of the solution.
        square = sum(
            np.trapezoid(np.square([1e-6 * rates(t, solution.sol(t))[1] for t in fine]), fine)
            for fine in (np.linspace(*ends, 9) for ends in zip(solution.t[:-1], solution.t[1:], strict=True))
        )
        assert math.sqrt(square / period) == pytest.approx(row.acceleration_rms, rel=1e-3)


def test_one_motion_is_reported_with_what_may_be_missed(run, scene_text, tmp_path: Path) -> None:
    """The share p with 1 - (1 - p)^n = 0.95 of the n starts that are drawn: all but the first three."""
    (tmp_path / "scene.nml").write_text(scene_text(**LOOSE))
    for starts in (29, 62):
        ended = run("--set", f"solver.starts={starts}", "--overwrite", "scene.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        reported = summary_of(tmp_path / "results" / "scene.summary.nml")
        assert (reported["motions"], reported["starts_solved"], reported["unsettled_starts"]) == (
            1,
            starts,
            0,
        )
        share = math.ceil(100.0 * (1.0 - 0.05 ** (1.0 / (starts - 3))))
        assert (
            f"one motion from {starts} starts: any other has less than {share} % of the sampled starts (95 %)"
            in ended.stdout
        )
        assert reported["loudest_acceleration_rms"] == reported["acceleration_rms"]


@pytest.mark.long
def test_starts_end_early_on_a_known_irregular_motion(run, repository: Path, tmp_path: Path) -> None:
    """After 32 periods if all are on it; a motion beside it that repeats is reported nevertheless."""
    for speed, motions in ((1200.0, 1), (2400.0, 2)):
        ended = run(
            *("--set", f"shaft.speed_rpm={speed}", "--set", "oil.temperature_celsius=100.0"),
            *("--set", "solver.periods=200", "--overwrite"),
            *("--output", tmp_path, repository / "input" / "two_motions.nml"),
            cwd=tmp_path,
        )
        assert ended.returncode == 0, ended.stderr
        reported = summary_of(tmp_path / "two_motions.summary.nml")
        # Whether the exponent of a chaotic motion is above its error is a matter of the last digits; so is
        # whether the motion from rest at 2400 1/min comes to the one that repeats.
        from_rest = reported["rattle_class"].startswith("irregular")
        assert (from_rest or motions == 2) and reported["motions"] == motions
        # 28 starts of 32 periods, and 60 of the motion they are compared with; of 120 each they had 3360.
        assert reported["start_periods"] < 1100
        unsettled = 30 - motions - (not from_rest)
        assert reported["unsettled_starts"] == unsettled
        words = "of 29 starts the motion does not repeat, or not yet"
        if motions == 1:
            assert reported["motions_text"] == f"one motion from 29 starts; {words}"
        else:
            assert (
                "subharmonic" in reported["motions_text"]
                and f"; of {unsettled} starts" in reported["motions_text"]
            )


@pytest.mark.long
def test_a_motion_of_six_periods_is_reported_once(run, repository: Path, tmp_path: Path) -> None:
    """Its window of four periods does not show that it repeats."""
    text = (repository / "input" / "gearbox_map.nml").read_text()
    first = text.index("&gear\n")
    text = text[: text.index("&gear\n", first + 1)] + text[text.index("&shaft\n") : text.index("&campaign\n")]
    (tmp_path / "gearbox_run_up.csv").write_bytes((repository / "input" / "gearbox_run_up.csv").read_bytes())
    text = text.replace("task = 'campaign'", "task = 'motion'").replace("periods = 60 ", "periods = 200 ")
    (tmp_path / "scene.nml").write_text(
        text.replace("temperature_celsius = 60.0", "temperature_celsius = 104.0")
    )
    ended = run("scene.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0, ended.stderr
    reported = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert (reported["unsettled_starts"], reported["rattle_class"]) == (0, "subharmonic")
    assert (reported["orbit_period"], reported["orbit_stability"]) == (6, "stable")
    frame = package.read(tmp_path / "results" / "scene.rattle").motions.frame()
    assert (frame.orbit_period == 6).tolist() == [True] + [False] * (len(frame) - 1)
    assert frame.starts[0] > 20


def solve_pair(run, repository: Path, folder: Path, place: int, *keys: str) -> tuple[str, dict]:
    """What the log and the summary of a pair of gearbox_map show at an operating point of its own."""
    text = one_pair((repository / "input" / "gearbox_map.nml").read_text(), place)
    (folder / "gearbox_run_up.csv").write_bytes((repository / "input" / "gearbox_run_up.csv").read_bytes())
    (folder / "scene.nml").write_text(text.replace("'campaign'", "'motion'"))
    settings = [word for key in keys for word in ("--set", key)]
    ended = run("--verbose", "--overwrite", *settings, "scene.nml", cwd=folder)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout, summary_of(folder / "results" / "scene.summary.nml")


def test_a_loud_motion_that_settles_slowly_is_reported(run, repository: Path, tmp_path: Path) -> None:
    """Soft teeth: two of 29 starts come to a motion of 139 m/s2, which they near by a little each period."""
    keys = ("shaft.speed_rpm=1524.344", "oil.temperature_celsius=59.50032", "solver.periods=200")
    keys += ("gear.tooth_stiffness=2.726063e7", "load.force_scale=1.382198")
    _, reported = solve_pair(run, repository, tmp_path, 3, *keys)
    assert (reported["motions"], reported["unsettled_starts"]) == (2, 0)
    # The reference of tests/stress has 139.1 m/s2.
    assert reported["loudest_acceleration_rms"] == pytest.approx(139.135, rel=1e-3)


@pytest.mark.long
def test_a_motion_far_from_where_slow_starts_end_is_reported(run, repository: Path, tmp_path: Path) -> None:
    """Soft teeth: slow starts end hundreds of films away from the motion of 45.6 m/s2 that they come to."""
    keys = ("shaft.speed_rpm=747.6303148188935", "oil.temperature_celsius=92.6035145285589")
    keys += ("gear.tooth_stiffness=1.05220197e7", "load.force_scale=0.79697788")
    log, reported = solve_pair(run, repository, tmp_path, 1, *keys)
    assert (reported["motions"], reported["rattle_class"]) == (2, "irregular_so_far")
    of_window = "The motion does not repeat within its window of 4 periods: other windows have other numbers"
    assert of_window in log
    keys += (
        "film.initial_film=6e-5",
        "film.initial_velocity=-0.15",
        "solver.starts=1",
        "solver.periods=1500",
    )
    log, settled = solve_pair(run, repository, tmp_path, 1, *keys)
    assert settled["orbit_period"] == 1 and of_window not in log
    assert reported["loudest_acceleration_rms"] == pytest.approx(settled["acceleration_rms"], rel=1e-3)


@pytest.mark.long
def test_irregular_starts_count_to_no_motion_beside(run, repository: Path, tmp_path: Path) -> None:
    """Newton's method leads from some irregular starts to a stable motion of 12.2 m/s2; no start does."""
    keys = ("shaft.speed_rpm=3372", "oil.temperature_celsius=115", "gear.tooth_stiffness=1.38e7")
    keys += ("load.force_scale=0.63",)
    _, reported = solve_pair(run, repository, tmp_path, 0, *keys)
    assert (reported["motions"], reported["unsettled_starts"], reported["rattle_class"]) == (
        1,
        29,
        "irregular",
    )
    _, later = solve_pair(run, repository, tmp_path, 0, *keys, "solver.starts=1", "solver.periods=1500")
    # In 1500 periods it comes to that motion or stays irregular, by the last digits.
    assert later["periods_solved"] == 1500
    assert later["rattle_class"] == "irregular" or later["acceleration_rms"] == pytest.approx(12.2, rel=0.01)


def test_a_start_that_flies_off_is_not_verified(run, scene_text, tmp_path: Path) -> None:
    """From 10 mm at 100 m/s the tooth is metres away: there its class says nothing, in a row neither."""
    start = {"law": "'iso-viscous'", "initial_film": "1e-2", "initial_velocity": "100.0"}
    solver = {"method": "'taylor'", "steps_per_period": None, "periods": "40"}
    (tmp_path / "scene.nml").write_text(scene_text(film=start, solver=solver))
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    reported = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert reported["film_maximum"] > 1.0 and reported["model_limit"] == "too_wide"
    assert reported["verification"] == "uncertain"
    assert "beyond a tenth of the radius: the film law does not hold there." in reported["verification_text"]
    rows = {
        "vary": "'film.initial_velocity'",
        "values(:, 1)": "0.0, 100.0",
        "record": "'rattle_class', 'verified'",
    }
    start["initial_film"] = "1e-6"
    text = scene_text(scene={"task": "'campaign'"}, film=start, solver=solver, campaign=rows)
    (tmp_path / "rows.nml").write_text(text)
    ended = run("rows.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert package.read(tmp_path / "results" / "rows.rattle")["verified"].tolist() == [1.0, 0.0]


def test_one_start_is_the_same_series(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text(**LOOSE))
    rows = []
    for starts in (1, 29):
        ended = run("--set", f"solver.starts={starts}", "--overwrite", "scene.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        frame = package.read(tmp_path / "results" / "scene.rattle").frame()
        rows.append(frame.to_numpy().tobytes())
        if starts == 1:
            assert not (tmp_path / "results" / "scene.motions.rattle").exists()
            assert "one start: other motions were not looked for" in ended.stdout
    assert rows[0] == rows[1]


def test_why_one_start_is_enough(run, scene_text, tmp_path: Path) -> None:
    taylor = {"method": "'taylor'", "steps_per_period": None, "periods": "20"}
    for changes, words in (
        ({}, "one start: the method of the paper"),
        ({"solver": taylor}, "one start: on one flank and damped above half of the critical damping"),
        (
            {**LOOSE, "load": {**LOOSE["load"], "force_amplitude": "0.0"}},
            "one start: nothing oscillates",
        ),
    ):
        (tmp_path / "scene.nml").write_text(scene_text(**changes))
        ended = run("--overwrite", "scene.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        assert words in ended.stdout
        assert not (tmp_path / "results" / "scene.motions.rattle").exists()
        assert summary_of(tmp_path / "results" / "scene.summary.nml")["starts_solved"] == 1
    (tmp_path / "scene.nml").write_text(scene_text(solver={"starts": "5"}))
    refused = run("--check", "scene.nml", cwd=tmp_path)
    assert (
        refused.returncode == 2
        and "solver starts: this key is used only with solver.method=taylor" in refused.stderr
    )


def test_the_table_of_motions_is_written_like_other_results(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text(**LOOSE))
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    results = tmp_path / "results"
    table = results / "scene.motions.rattle"
    first = table.read_bytes()
    for name in ("scene.rattle", "scene.state", "scene.summary.nml", "scene.log"):
        (results / name).unlink()
    refused = run("scene.nml", cwd=tmp_path)
    assert (
        refused.returncode == 2 and "scene.motions.rattle exists; --overwrite replaces it" in refused.stderr
    )
    assert run("--overwrite", "--threads", "1", "scene.nml", cwd=tmp_path).returncode == 0
    assert table.read_bytes() == first
    # The summary knows the table that it belongs to, and a bit is missed.
    assert package.read_summary(results / "scene.summary.nml")["motions"] == 1
    assert run("--overwrite", "--set", "load.mass=0.5", "scene.nml", cwd=tmp_path).returncode == 0
    table.write_bytes(first)
    with pytest.raises(package.SummaryError, match=r"scene\.motions\.rattle beside"):
        package.read_summary(results / "scene.summary.nml")
    refused = run("--resume", "scene.nml", cwd=tmp_path)
    assert refused.returncode == 2


def test_a_run_is_carried_on_with_more_starts(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text(**LOOSE))
    for name, arguments in (
        ("parts", ("--set", "solver.starts=5", "--set", "solver.periods=30")),
        ("parts", ("--resume",)),
        ("whole", ()),
    ):
        ended = run("--output", name, *arguments, "scene.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
    for ending in ("rattle", "motions.rattle", "state"):
        assert (tmp_path / "parts" / f"scene.{ending}").read_bytes() == (
            tmp_path / "whole" / f"scene.{ending}"
        ).read_bytes()


def test_a_report_tells_all_motions_once(two_motions: Path, repository: Path) -> None:
    results = sorted((two_motions / "results").glob("two_motions*.rattle"))
    assert len(results) == 2
    call_script("report.py", *results, "--output", two_motions / "page.html", cwd=two_motions)
    page = (two_motions / "page.html").read_text()
    assert page.count("From other starts: 2 motions: idle") == 1
