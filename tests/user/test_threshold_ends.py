"""Where motions on both sides of a threshold end, against another continuation and scenes solved alone."""

from __future__ import annotations

import re
import resource
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from outcomes import digest, summary_of
from script_calls import call_script
from waiting import let_work, until

import rattle as package

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reference"))
import pseudo_arclength

# A tooth of little damping; from rest it hits both flanks from 14.63 N on.
PAIR = {
    "contact": {"radius": "7.5e-3", "length": "0.02", "backlash": "1.0e-4"},
    "lubricant": {"viscosity": "0.003", "pressure_viscosity": "2.0e-8"},
    "kinematics": {"entrainment_speed": "3.3"},
    "load": {
        "mass": "0.45",
        "steady_force": "5.0",
        "gravity": "0.0",
        "frequency": "160.0",
        "force_amplitude": "14.6",
    },
    "film": {"law": "'iso-viscous'", "model": "'published'"},
    "solver": {"method": "'taylor'", "steps_per_period": None, "until": "'steady'", "periods": "400"},
    "spectrum": {"periods": "4"},
}
THRESHOLD = {
    "key": "'load.force_amplitude'",
    "first": "2.0",
    "last": "80.0",
    "criterion": "'double_sided'",
}


@pytest.fixture
def found(run, scene_text, tmp_path: Path):
    """Find the thresholds of the pair; return their result."""

    def find(*options: object, name: str = "scene", threshold: dict | None = None, **changes: dict):
        groups = {**PAIR, "scene": {"task": "'threshold'"}, **changes}
        text = scene_text(**groups, threshold={**THRESHOLD, **(threshold or {})})
        (tmp_path / f"{name}.nml").write_text(text)
        ended = run(*options, f"{name}.nml", cwd=tmp_path, timeout=600.0)
        assert ended.returncode == 0, ended.stderr
        return package.read(tmp_path / "results" / f"{name}.rattle")

    return find


@pytest.fixture
def alone(run, scene_text, tmp_path: Path):
    """Solve the pair alone; return its summary."""

    def solve(*options: object) -> dict:
        (tmp_path / "alone.nml").write_text(scene_text(**PAIR))
        ended = run("--overwrite", *options, "alone.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        return summary_of(tmp_path / "results" / "alone.summary.nml")

    return solve


def set_to(**settings: object) -> list[str]:
    return [
        word for key, value in settings.items() for word in ("--set", f"{key.replace('__', '.')}={value!r}")
    ]


@pytest.mark.long
def test_ends_are_the_folds_of_pseudo_arclength_continuation(found, tmp_path: Path) -> None:
    """Both sides end at folds of one branch, each to 1e-6 of the force that of another continuation."""
    rows = found().frame()
    assert len(rows) == 1
    row = rows.iloc[0]
    assert row["last_above"] < row["lower"] < row["upper"] < row["last_below"]
    assert row["motion_end_below_word"] == row["motion_end_above_word"] == "fold"
    pair = pseudo_arclength.LoosePair(
        radius=7.5e-3,
        length=0.02,
        viscosity=0.003,
        speed=3.3,
        backlash=1.0e-4,
        mass=0.45,
        static_force=5.0,
        frequency=160.0,
    )
    # Some periods from anywhere lead to the motion that does not hit the coast flank.
    state, start = np.array([0.9, -0.85]), 14.0
    for _ in range(10):
        state, _, _ = pair.period_map(state, start)
    unit = 10.0
    folds = pseudo_arclength.folds(pair.period_map, unit, np.append(state, start / unit), 1.0, 2)
    for (amplitude, point), reported in zip(folds, (row["last_below"], row["last_above"]), strict=True):
        assert abs(point.multipliers - 1.0).min() < 1e-5
        assert abs(reported - amplitude) < 1e-6 * amplitude
    log = (tmp_path / "results" / "scene.log").read_text()
    assert "  either side      possible at 1 of 1 crossing, " in log
    reported = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert (
        reported["crossings_followed"],
        reported["crossings_either"],
        reported["crossings_end_unsure"],
    ) == (1, 1, 0)


def test_scenes_alone_have_both_sides_between_the_ends_and_one_beyond(found, alone, tmp_path: Path) -> None:
    row = found().frame().iloc[0]
    low, high = row["last_above"], row["last_below"]
    margin = 0.05 * (high - low)
    for amplitude, sides in ((low - margin, [0]), (0.5 * (low + high), [0, 1]), (high + margin, [1])):
        alone(*set_to(load__force_amplitude=float(amplitude), solver__starts=29))
        motions = package.read(tmp_path / "results" / "alone.rattle").motions.frame()
        reported = [
            alone(
                *set_to(
                    load__force_amplitude=float(amplitude),
                    film__initial_film=motion.film,
                    film__initial_velocity=motion.velocity,
                    solver__starts=1,
                )
            )["double_sided"]
            for motion in motions.itertuples()
        ]
        assert sorted(map(int, reported)) == sides


def test_a_trace_without_a_threshold_tells_of_another_side(found, alone, tmp_path: Path) -> None:
    """From rest the pair changes at 14.63 N; short of it and beyond it other starts find the other side.

    Its motions end at the folds that a trace with the threshold has; scenes alone have both sides there.
    """
    crossed = found().frame().iloc[0]
    starts = ("--set", "solver.starts=29")
    low = found(*starts, threshold={"last": "14.62"}, name="low").frame().iloc[0]
    high = found(*starts, threshold={"first": "14.637"}, name="high").frame().iloc[0]
    for row, ends, words, side in (
        (low, (crossed["last_above"], 14.62), ("fold", "end_of_range"), 0),
        (high, (14.637, crossed["last_below"]), ("end_of_range", "fold"), 1),
    ):
        assert (row["crossing"], row["double_sided_below"], row["double_sided_above"]) == (0, side, side)
        np.testing.assert_allclose([row["last_above"], row["last_below"]], ends, rtol=1e-6)
        assert (row["motion_end_above_word"], row["motion_end_below_word"]) == words
        sides = sides_alone(alone, 0.5 * sum(ends), tmp_path)
        assert sides[0] == side and 1 - side in sides
    assert (
        "other side       in 1 of 1 trace without a crossing"
        in (tmp_path / "results" / "low.log").read_text()
    )
    assert summary_of(tmp_path / "results" / "low.summary.nml")["traces_with_another_side"] == 1


def test_a_trace_with_one_side_has_no_ends(found, alone, tmp_path: Path) -> None:
    """At both ends of the range and in its middle 29 starts of a scene alone lead to one side."""
    row = found("--set", "solver.starts=29", threshold={"last": "12.0"}).frame().iloc[0]
    assert row["crossing"] == 0 and np.isnan([row["last_below"], row["last_above"]]).all()
    for amplitude in (2.0, 7.0, 12.0):
        assert set(sides_alone(alone, amplitude, tmp_path)) == {0}
    assert summary_of(tmp_path / "results" / "scene.summary.nml")["traces_with_another_side"] == 0


def sides_alone(alone, amplitude: float, folder: Path) -> list[int]:
    """Sides of all motions of a scene from 29 starts, each solved again alone; that from rest first."""
    alone(*set_to(load__force_amplitude=float(amplitude), solver__starts=29))
    motions = package.read(folder / "results" / "alone.rattle").motions.frame()
    starts = [{}] + [
        {"film__initial_film": motion.film, "film__initial_velocity": motion.velocity}
        for motion in motions.itertuples()
    ]
    return [
        int(alone(*set_to(load__force_amplitude=float(amplitude), solver__starts=1, **start))["double_sided"])
        for start in starts
    ]


def test_a_motion_that_passes_a_level_smoothly_ends_there(found, alone) -> None:
    """Both ends are within the bracket and the same, and a scene alone has the level there."""
    level = {"criterion": "'acceleration_rms'", "level": "10.0"}
    row = found(threshold=level).frame().iloc[0]
    assert row["lower"] <= row["last_below"] <= row["upper"]
    assert row["motion_end_below_word"] == row["motion_end_above_word"] == "criterion"
    np.testing.assert_allclose(row["last_above"], row["last_below"], rtol=1e-6)
    reported = alone(*set_to(load__force_amplitude=float(row["last_below"]), solver__starts=1))
    np.testing.assert_allclose(reported["acceleration_rms"], 10.0, rtol=1e-6)


@pytest.mark.long
def test_bytes_depend_on_no_threads_parts_or_cuts(run, rattle, found, tmp_path: Path) -> None:
    values = {"vary": "'lubricant.viscosity'", "values(:, 1)": "0.003, 0.006, 0.012"}
    found("--threads", "1", threshold={"tolerance": "1e-3"}, campaign=values)
    whole = digest(tmp_path / "results" / "scene.rattle")
    ended = run("--threads", "3", "--output", "three", "scene.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0 and digest(tmp_path / "three" / "scene.rattle") == whole
    # Cut while motions are followed: all values of the scan are known, and no trace is done.
    process = subprocess.Popen(
        [rattle, "--quiet", "--threads", "1", "--output", "cut", "scene.nml"], cwd=tmp_path
    )
    log = tmp_path / "cut" / "scene.log"
    until(log.exists, process)
    whole_time = processor_time(tmp_path, rattle)
    let_work(process, 0.7 * whole_time)
    process.send_signal(signal.SIGTERM)
    assert process.wait(600) in (0, 128 + signal.SIGTERM)
    ended = run("--resume", "--output", "cut", "scene.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0 and digest(tmp_path / "cut" / "scene.rattle") == whole
    # Killed at some moment: what was saved by then is carried on, and the rest found anew.
    command = [rattle, "--quiet", "--resume", "--threads", "2", "--output", "killed", "scene.nml"]
    for share in (0.3, 0.8):
        process = subprocess.Popen(command, cwd=tmp_path)
        let_work(process, share * whole_time)
        process.kill()
        process.wait(600)
    ended = run("--resume", "--output", "killed", "scene.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0 and digest(tmp_path / "killed" / "scene.rattle") == whole


@pytest.mark.long
def test_joined_parts_have_the_ends_of_the_undivided_run(run, found, tmp_path: Path) -> None:
    """Also the bytes of the columns of ends, which are known of every crossing."""
    values = {"vary": "'lubricant.viscosity'", "values(:, 1)": "0.003, 0.006, 0.012"}
    whole = found("--threads", "2", threshold={"tolerance": "1e-3"}, campaign=values)
    assert len(whole["last_below"]) and not np.isnan(whole["last_below"]).any()
    paths = []
    for part in (1, 2):
        chosen = ["--set", "campaign.parts=2", "--set", f"campaign.part={part}", "--threads", str(3 - part)]
        ended = run("--output", "parts", *chosen, "scene.nml", cwd=tmp_path, timeout=600.0)
        assert ended.returncode == 0, ended.stderr
        paths.append(tmp_path / "parts" / f"scene.part-{part}-of-2.rattle")
    merged = call_script("campaign.py", "merge", *paths, "--output", "joined.rattle", cwd=tmp_path)
    assert merged.returncode == 0, merged.stderr
    assert digest(tmp_path / "joined.rattle") == digest(tmp_path / "results" / "scene.rattle")


@pytest.mark.long
def test_motions_that_do_not_repeat_end_to_the_width_of_a_bracket(
    run, repository: Path, tmp_path: Path
) -> None:
    """Between 900 and 1500 1/min a pair in thin oil is irregular: value by value, and reported as bracketed.

    The last digits of chaotic motions decide how many crossings there are and how the other ends are found.
    """
    text = (repository / "input" / "two_motions.nml").read_text().replace("periods = 400", "periods = 60")
    text = text.replace("temperature_celsius = 60.0", "temperature_celsius = 100.0")
    first, last, places = 900.0, 1500.0, 128
    text += (
        "\n&scene\n   task = 'threshold'\n/\n&threshold\n   key = 'shaft.speed_rpm'\n"
        f"   first = {first}, last = {last}, count = 5, tolerance = 1e-2\n"
        "   criterion = 'acceleration_rms', level = 40.0\n/\n"
    )
    (tmp_path / "scene.nml").write_text(text)
    ended = run("scene.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0, ended.stderr
    rows = package.read(tmp_path / "results" / "scene.rattle").frame()
    unsure = 0
    for _, row in rows.iterrows():
        words = {side: row[f"motion_end_{side}_word"] for side in ("below", "above")}
        unsure += bool({"bracketed", "lost"} & set(words.values()))
        for side, word in words.items():
            place = (row[f"last_{side}"] - first) / (last - first) * places
            assert word != "bracketed" or abs(place - round(place)) < 1e-9, side
    assert unsure > 0 and "bracketed" in {*rows["motion_end_below_word"], *rows["motion_end_above_word"]}
    reported = re.search(r"motion ends      unsure at (\d+) crossings?: no repetition", ended.stdout)
    assert reported and int(reported[1]) == unsure
    assert summary_of(tmp_path / "results" / "scene.summary.nml")["crossings_end_unsure"] == unsure


def processor_time(folder: Path, rattle: Path) -> float:
    """What the run takes from its start to its end [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    call = [rattle, "--quiet", "--threads", "1", "--output", "timed", "scene.nml"]
    assert subprocess.run(call, cwd=folder, timeout=600.0).returncode == 0
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def test_one_start_has_no_ends(found) -> None:
    """The columns that there were are the same bits."""
    several, one = found(), found("--set", "solver.starts=1", name="one")
    ends = {"last_below", "last_above", "motion_end_below", "motion_end_above"}
    assert set(several.names) - set(one.names) == ends
    for name in one.names:
        np.testing.assert_array_equal(several[name], one[name])


@pytest.mark.parametrize(
    "criterion", ["'steady_film', level = 1e-6", "'motions', level = 2.0", "'orbit_period', level = 2.0"]
)
def test_what_is_not_one_motion_has_no_ends(criterion: str, found) -> None:
    assert "last_below" not in found(threshold={"criterion": criterion}).names
