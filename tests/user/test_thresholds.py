"""Thresholds: where along a key a motion changes, compared with grids of campaigns."""

from __future__ import annotations

import re
import shutil
import signal
import subprocess
from pathlib import Path

import numpy as np
import pytest
from campaign_runs import BASE
from outcomes import assert_faults, contents, digest, summary_of
from waiting import let_work, until

import rattle as package
from rattle.campaign_plan import read_plan
from rattle.figures import threshold
from rattle.thresholds import thresholds

THRESHOLD = {"key": "'load.force_amplitude'", "first": "5.0", "last": "455.0", "count": "17"}
SPEEDS = {"vary": "'kinematics.entrainment_speed'", "values(:, 1)": "0.8, 1.9, 9.5"}
# Brackets as narrow as asked for, whatever is verified.
NARROW = {"periods": "8", "verify": ".false."}
SEVERE = {"criterion": "'film_force_rms'", "level": "100.0"}


def threshold_text(scene_text, campaign=SPEEDS, **changes: dict) -> str:
    threshold = {**THRESHOLD, **changes.pop("threshold", {})}
    groups = {**BASE, "scene": {"task": "'threshold'"}, **changes}
    if campaign is not None:
        groups["campaign"] = {"samples_per_period": "64", **campaign}
    return scene_text(**groups, threshold=threshold)


@pytest.fixture
def found(run, tmp_path: Path):
    """Find the thresholds of an input; return their table."""

    def find(text: str, *options: object, code: int = 0, name: str = "scene"):
        (tmp_path / f"{name}.nml").write_text(text)
        ended = run(*options, f"{name}.nml", cwd=tmp_path, timeout=600.0)
        assert ended.returncode == code, ended.stderr
        return package.read(tmp_path / "results" / f"{name}.rattle").frame()

    return find


def grid_column(run, scene_text, folder: Path, column: str, values, **changes: dict) -> np.ndarray:
    """A column of a campaign over the same traces and these force amplitudes, and the status."""
    campaign = {
        "vary": "'kinematics.entrainment_speed', 'load.force_amplitude'",
        "values(:, 1)": SPEEDS["values(:, 1)"],
        "values(:, 2)": ", ".join(map(repr, map(float, values))),
        "samples_per_period": "64",
        "record": f"'{column}'",
    }
    (folder / "grid.nml").write_text(scene_text(**{**BASE, **changes}, campaign=campaign))
    assert run("--overwrite", "grid.nml", cwd=folder, timeout=600.0).returncode in (0, 1)
    rows = package.read_campaign(folder / "results" / "grid.rattle")
    return np.array([rows[column], rows["status"]]).reshape(2, 3, len(values))


@pytest.mark.parametrize("criterion", ["class", "idle", "film_force_rms"])
def test_brackets_are_where_a_fine_grid_changes(criterion: str, found, run, scene_text, tmp_path: Path):
    """A bracket is a step of a grid of 1025 values; both say the same of all scenes of the scan as well."""
    threshold = {
        "criterion": f"'{criterion}'",
        "tolerance": "1e-3",
        "level": "100.0" if "rms" in criterion else None,
    }
    rows = found(threshold_text(scene_text, threshold=threshold, spectrum=NARROW))
    values = np.linspace(5.0, 455.0, 1025)
    column = "film_force_rms" if "rms" in criterion else "rattle_class"
    grid, _ = grid_column(run, scene_text, tmp_path, column, values)
    side = {"class": grid, "idle": grid == 3.0, "film_force_rms": grid >= 100.0}[criterion]
    scan, crossings, searched = np.arange(0, 1025, 64), 0, 0
    for line in range(3):
        ours = rows[(rows["trace"] == line + 1) & (rows["crossing"] > 0)]
        np.testing.assert_array_equal(ours["crossing"], np.arange(len(ours)) + 1)
        steps = np.searchsorted(values, ours["lower"] - 1e-9)
        np.testing.assert_allclose(values[steps], ours["lower"], rtol=1e-14)
        np.testing.assert_allclose(values[steps + 1], ours["upper"], rtol=1e-14)
        assert (side[line, steps] != side[line, steps + 1]).all()
        np.testing.assert_array_equal(grid[line, steps], ours[f"{column}_below"])
        np.testing.assert_array_equal(grid[line, steps + 1], ours[f"{column}_above"])
        # Every step of the scan whose ends differ has its changes, and no other.
        for first, last in zip(scan[:-1], scan[1:], strict=True):
            inside = ((steps >= first) & (steps < last)).sum()
            assert (inside > 0) == (side[line, first] != side[line, last])
            searched += int(inside > 0)
        crossings += len(ours)
    assert crossings >= 3
    reported = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert reported["crossings"] == crossings and reported["traces"] == 3
    # Crossings within one step of the scan share the first halves of their search.
    assert 51 + 6 * searched <= reported["scenes"] <= 51 + (6 + 2) * crossings


def test_several_thresholds_on_a_line(found, scene_text) -> None:
    """Quiet, creep, idle and back: every change of the class, each beginning where the one before has led."""
    rows = found(threshold_text(scene_text, spectrum=NARROW))
    for line in (1, 2, 3):
        ours = rows[rows["trace"] == line]
        assert len(ours) >= 2
        np.testing.assert_array_equal(ours["rattle_class_above"][:-1], ours["rattle_class_below"][1:])
        assert (ours["rattle_class_above"] != ours["rattle_class_below"]).all()
        assert ours["rattle_class_below_word"].iloc[0] == "quiet"
        assert (ours["lower"] < ours["upper"]).all() and (np.diff(ours["lower"]) > 0).all()
        np.testing.assert_allclose(ours["upper"] - ours["lower"], 450.0 / 16384)


def test_every_column_has_the_unit_of_what_it_holds(found, scene_text, tmp_path: Path) -> None:
    threshold = {"key": "'load.mass'", "first": "1.0", "last": "5.0", "count": "3", "tolerance": "0.5"}
    found(threshold_text(scene_text, threshold={**threshold, **SEVERE}))
    units = {"kinematics.entrainment_speed": "m/s", "lower": "kg", "upper": "kg", "width": "kg"}
    units |= {"film_force_rms_below": "N", "film_force_rms_above": "N"}
    units |= {"last_below": "kg", "last_above": "kg"}
    reported = package.read(tmp_path / "results" / "scene.rattle").units
    assert {name: unit for name, unit in reported.items() if unit != "-"} == units
    assert set(reported) - set(units) == {
        *("trace", "crossing", "status_below", "status_above", "verified_below", "verified_above"),
        *("motion_end_below", "motion_end_above"),
    }


def test_rows_of_a_campaign_know_which_side_is_verified(found, run, scene_text, tmp_path: Path) -> None:
    rows = found(threshold_text(scene_text, threshold={"tolerance": "0.05"}))
    for _, row in rows.iterrows():
        stands, _ = grid_column(run, scene_text, tmp_path, "verified", [row["lower"], row["upper"]])
        reported = [row["verified_below"], row["verified_above"]]
        assert stands[int(row["trace"]) - 1].tolist() == reported, row


@pytest.mark.parametrize(("tolerance", "seen"), [("0.01", 1.0), ("1e-12", 0.0)])
def test_every_bracket_says_whether_both_classes_stand(tolerance, seen, found, scene_text, tmp_path: Path):
    """Regular motions are verified up to a film error; hardly one is up to an error of rounding."""
    spectrum = {"verification_tolerance": tolerance}
    rows = found(threshold_text(scene_text, threshold={"tolerance": "0.05"}, spectrum=spectrum))
    flags = rows[["verified_below", "verified_above"]]
    assert seen in np.unique(flags) and np.isin(flags, [0.0, 1.0]).all() and len(rows) > 3
    reported = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert reported["crossings_uncertain"] == int((flags == 0.0).any(axis=1).sum())
    bare = found(threshold_text(scene_text, threshold={"tolerance": "0.05"}, spectrum=NARROW), name="bare")
    assert list(bare) == [name for name in rows if name not in ("verified_below", "verified_above")]


def test_ends_go_apart_until_both_are_verified(found, run, scene_text, tmp_path: Path) -> None:
    """Each end of a bracket is the next point whose class is verified; rows of a campaign say the same."""
    fine = {"tolerance": "1e-7", "count": "9", "criterion": "'quiet'"}
    rows = found(threshold_text(scene_text, threshold=fine))
    bare = found(threshold_text(scene_text, threshold=fine, spectrum=NARROW), name="bare")
    assert len(rows) == len(bare) == 3 and (rows["crossing"] == 1.0).all()
    assert (rows["lower"] <= bare["lower"]).all() and (rows["upper"] >= bare["upper"]).all()
    asked = 450.0 / 2**24
    np.testing.assert_allclose(bare["width"], asked, rtol=1e-6)
    np.testing.assert_array_equal(rows["width"], rows["upper"] - rows["lower"])
    assert (rows[["verified_below", "verified_above"]] == 1.0).all(axis=None)
    assert (rows["width"] > 1.5 * asked).any()
    for place, row in rows.iterrows():
        # Solved alone, both ends are what the row says of them.
        halves = [row["lower"], row["upper"]]
        verified, _ = grid_column(run, scene_text, tmp_path, "verified", halves)
        classes, _ = grid_column(run, scene_text, tmp_path, "rattle_class", halves)
        assert verified[int(row["trace"]) - 1].tolist() == [1.0, 1.0], place
        assert (
            classes[int(row["trace"]) - 1] == [row["rattle_class_below"], row["rattle_class_above"]]
        ).all()
    reported = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert reported["crossings_uncertain"] == 0
    assert reported["crossings_wide"] == int((rows["width"] > 1.5 * asked).sum())


def test_a_line_without_threshold_is_reported(found, scene_text, run, tmp_path: Path) -> None:
    rows = found(threshold_text(scene_text, threshold={**SEVERE, "last": "60.0"}))
    assert rows["trace"].tolist() == [1, 2, 3]
    alone = rows[rows["crossing"] == 0]
    assert 0 < len(alone) < 3
    assert (alone["lower"] == 5.0).all() and (alone["upper"] == 60.0).all()
    assert (alone["film_force_rms_above"] < 100.0).all() and alone["verified_below"].isna().all()
    reported = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert reported["traces_without_crossing"] == len(alone) and reported["crossings"] == 3 - len(alone)


def test_scenes_that_fail_are_a_kind_of_their_own(found, run, scene_text, tmp_path: Path) -> None:
    """Where the Reynolds piezo-viscous film is lost is a crossing, with the status behind it."""
    film = {"law": "'piezo-viscous'", "model": "'reynolds'"}
    changes = {"film": film, "load": {"steady_force": "30.0"}}
    threshold = {"last": "900.0", "tolerance": "1e-2"}
    rows = found(threshold_text(scene_text, threshold=threshold, **changes), code=1)
    lost = rows[rows["status_above"] > 1]
    assert len(lost) >= 1 and lost["rattle_class_above"].isna().all()
    assert (lost["status_above_word"].isin(["film_lost", "no_rigid_film", "not_converged", "overflow"])).all()
    for place, row in lost.iterrows():
        _, status = grid_column(
            run, scene_text, tmp_path, "rattle_class", [row["lower"], row["upper"]], **changes
        )
        assert status[int(row["trace"]) - 1].tolist() == [row["status_below"], row["status_above"]], place
    assert summary_of(tmp_path / "results" / "scene.summary.nml")["scenes_failed"] > 0


def test_several_axes_and_other_scenes(found, scene_text, tmp_path: Path) -> None:
    """The traces are the scenes of the campaign: of a grid, a sample, a table; without one, the base."""
    two = {
        "vary": "'kinematics.entrainment_speed', 'load.mass'",
        "first": "1.0, 2.0",
        "last": "4.0, 3.0",
        "count": "2, 3",
    }
    coarse = {**SEVERE, "tolerance": "1e-2"}
    rows = found(threshold_text(scene_text, campaign=two, threshold=coarse))
    assert rows["trace"].tolist() == [1, 2, 3, 4, 5, 6]
    assert rows["kinematics.entrainment_speed"].tolist() == [1.0] * 3 + [4.0] * 3
    assert rows["load.mass"].tolist() == [2.0, 2.5, 3.0] * 2
    (tmp_path / "traces.csv").write_text("load.mass,kinematics.entrainment_speed\n2.5,4.0\n")
    table = found(
        threshold_text(scene_text, campaign={"csv": "'traces.csv'"}, threshold=coarse), name="table"
    )
    base = {"kinematics": {"entrainment_speed": "4.0"}, "load": {"mass": "2.5"}}
    alone = found(threshold_text(scene_text, campaign=None, threshold=coarse, **base), name="alone")
    for other in (table, alone):
        assert len(other) == 1
        for column in ("lower", "upper", "film_force_rms_below", "film_force_rms_above"):
            assert other[column][0] == rows[column][4], column
    sample = {**two, "count": None, "sample": "'sobol'", "size": "5"}
    assert len(found(threshold_text(scene_text, campaign=sample, threshold=coarse), name="sample")) >= 5


def test_logarithmic_range_and_integers(found, scene_text) -> None:
    coarse = {**SEVERE, "tolerance": "1e-3", "scale": "'logarithmic'"}
    rows = found(threshold_text(scene_text, threshold=coarse))
    crossed = rows[rows["crossing"] > 0]
    np.testing.assert_allclose(crossed["upper"] / crossed["lower"], 91.0 ** (1 / 1024))
    lines = {
        "key": "'spectrum.idle_harmonics'",
        "first": "2",
        "last": "40",
        "criterion": "'idle'",
        "count": "5",
    }
    rows = found(threshold_text(scene_text, threshold=lines), name="traces")
    crossed = rows[rows["crossing"] > 0]
    assert len(crossed) >= 1 and (crossed["upper"] - crossed["lower"] == 1.0).all()


@pytest.mark.long
def test_threads_and_another_run_give_the_same_bytes(found, run, scene_text, tmp_path: Path) -> None:
    found(threshold_text(scene_text))
    digests = {digest(tmp_path / "results" / "scene.rattle")}
    for place, options in (
        ("one", ["--threads", "1"]),
        ("four", ["--threads", "4"]),
        ("again", ["--resume"]),
    ):
        assert run(*options, "--output", place, "scene.nml", cwd=tmp_path, timeout=600.0).returncode == 0
        digests.add(digest(tmp_path / place / "scene.rattle"))
    assert len(digests) == 1
    before = contents(tmp_path)
    ended = run("scene.nml", cwd=tmp_path)
    assert ended.returncode == 2 and "--overwrite replaces it" in ended.stderr
    assert contents(tmp_path) == before
    ended = run("--resume", "scene.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0 and "all is solved from the start" in ended.stdout


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT], ids=lambda n: n.name)
def test_a_signal_ends_it_without_a_result(number, rattle, run, scene_text, tmp_path: Path) -> None:
    """The result of an earlier run stays with its own summary; the log says that all was cut."""
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text, threshold={"tolerance": "0.5"}))
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    results = [tmp_path / "results" / f"scene.{kind}" for kind in ("rattle", "summary.nml")]
    before = [digest(path) for path in results]
    many = ["--set", "threshold.count=100000", "--set", "threshold.tolerance=1e-6"]
    process = subprocess.Popen([rattle, "--overwrite", "--quiet", *many, "scene.nml"], cwd=tmp_path)
    log = tmp_path / "results" / "scene.log"
    # The log of the earlier run goes before that of this one comes.
    until(lambda: log.exists() and "100000 values a trace" in log.read_text(), process)
    process.send_signal(number)
    assert process.wait(600) == 128 + number
    reported = log.read_text()
    assert "cut short        after 0 of 3 traces; --resume goes on with these and " in reported
    assert "files            results/scene.rattle and its summary are those of an earlier run\n" in reported
    assert [digest(path) for path in results] == before
    assert not list((tmp_path / "results").glob("*.new"))


# So many values a trace that few traces are searched at a time.
LONG = {"count": "2049", "tolerance": "1e-4", "criterion": "'film_force_rms'", "level": "100.0"}
MANY_LINES = {
    "vary": "'kinematics.entrainment_speed'",
    "first": "1.0",
    "last": "4.0",
    "count": "24",
    "samples_per_period": "32",
}


def state_path(folder: Path) -> Path:
    return folder / "results" / "scene.state"


def cut_short(
    rattle: Path, folder: Path, number: int, seconds: float, *options: str, name: str = "scene"
) -> int:
    """Ends a run by a signal after so much processor time, once its log is begun; its exit code."""
    call = [rattle, "--quiet", "--threads", "1", "--overwrite", *options, "scene.nml"]
    log = folder / "results" / f"{name}.log"
    log.unlink(missing_ok=True)
    process = subprocess.Popen(call, cwd=folder)
    until(log.exists, process)
    let_work(process, seconds)
    process.send_signal(number)
    return process.wait(600)


def cut_between(rattle: Path, folder: Path) -> int:
    """Ends a run by a signal after its first line and before its last; how many were done."""
    for share in (1.0, 2.0, 0.5, 4.0, 0.25, 8.0, 0.1):
        if cut_short(rattle, folder, signal.SIGTERM, 0.2 * share) == 128 + signal.SIGTERM:
            reported = (folder / "results" / "scene.log").read_text()
            if lines := int(re.search(r"cut short        after (\d+) of 24 traces", reported)[1]):
                return lines
    raise AssertionError("the run could not be cut between two traces")


@pytest.mark.long
def test_carried_on_to_the_same_bytes(rattle, run, scene_text, tmp_path: Path) -> None:
    """After a signal, and a kill that leaves the state as it was; with other threads."""
    # Of the class: no crossing is verified as close to its change as asked for.
    classes = {**LONG, "criterion": "'class'", "level": None}
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text, campaign=MANY_LINES, threshold=classes))
    assert run("--output", "whole", "scene.nml", cwd=tmp_path, timeout=600.0).returncode == 0
    whole, results = tmp_path / "whole", tmp_path / "results"
    assert not (whole / "scene.state").exists()
    lines = cut_between(rattle, tmp_path)
    kept = state_path(tmp_path).read_bytes()
    assert not (results / "scene.rattle").exists()
    ended = run("scene.nml", cwd=tmp_path)
    assert ended.returncode == 2 and "--resume continues it" in ended.stderr
    assert cut_short(rattle, tmp_path, signal.SIGKILL, 0.02, "--resume") == -signal.SIGKILL
    assert state_path(tmp_path).read_bytes() == kept
    ended = run("--resume", "--threads", "2", "scene.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0, ended.stderr
    assert f"carried on       after {lines} traces of the earlier run" in ended.stdout
    assert digest(results / "scene.rattle") == digest(whole / "scene.rattle")
    reported, expected = (summary_of(place / "scene.summary.nml") for place in (results, whole))
    assert {**reported, "wall_seconds": 0} == {**expected, "wall_seconds": 0}
    assert not state_path(tmp_path).exists()


@pytest.mark.long
def test_cut_in_its_first_lines_it_goes_on_where_it_was(rattle, run, scene_text, tmp_path: Path) -> None:
    """Cut again and again before its first line is done: nothing is counted twice, no byte differs."""
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text, threshold={"count": "513"}))
    assert run("--output", "whole", "scene.nml", cwd=tmp_path, timeout=600.0).returncode == 0
    seconds, cuts, values = 0.02, [], 0
    while len(cuts) < 60:
        options = ["--resume"] if cuts else ["--overwrite"]
        process = subprocess.Popen([rattle, "--quiet", "--threads", "1", *options, "scene.nml"], cwd=tmp_path)
        let_work(process, seconds)
        process.send_signal(signal.SIGTERM)
        if process.wait(600) == 0:
            break
        log = tmp_path / "results" / "scene.log"
        reported = re.search(
            r"with these and (\d+) values? of the next", log.read_text() if log.exists() else ""
        )
        if reported is None:
            # The signal came before the run had begun.
            seconds *= 2.0
            continue
        cuts.append(int(reported[1]))
        assert cuts[-1] >= values
        # One scene more may take longer.
        seconds *= 1.5 if cuts[-1] == values else 1.0
        values = cuts[-1]
    else:
        assert run("--resume", "scene.nml", cwd=tmp_path, timeout=600.0).returncode == 0
    assert sum(value > 0 for value in cuts) >= 2, cuts
    assert digest(tmp_path / "results" / "scene.rattle") == digest(tmp_path / "whole" / "scene.rattle")
    reported, expected = (summary_of(tmp_path / at / "scene.summary.nml") for at in ("results", "whole"))
    assert {**reported, "wall_seconds": 0} == {**expected, "wall_seconds": 0}


def test_states_of_others_are_refused(rattle, run, scene_text, tmp_path: Path) -> None:
    """Of other inputs, of traces from a CSV file that has changed, damaged ones."""
    lines = "kinematics.entrainment_speed\n" + "".join(f"{1.0 + 0.1 * i}\n" for i in range(24))
    (tmp_path / "traces.csv").write_text(lines)
    table = {"csv": "'traces.csv'", "samples_per_period": "32"}
    text = threshold_text(scene_text, campaign=table, threshold=LONG)
    (tmp_path / "scene.nml").write_text(text)
    cut_between(rattle, tmp_path)
    kept = state_path(tmp_path).read_bytes()

    def refusal(*options: str) -> str:
        ended = run("--resume", *options, "scene.nml", cwd=tmp_path, timeout=600.0)
        assert ended.returncode == 2, ended.stderr
        assert state_path(tmp_path).exists()
        return ended.stderr

    assert "threshold.level is 90.0 now and was 100.0" in refusal("--set", "threshold.level=90.0")
    (tmp_path / "traces.csv").write_text(lines.replace("1.5", "1.55"))
    assert "belongs to other traces: their CSV file has changed" in refusal()
    (tmp_path / "traces.csv").write_text(lines)
    state_path(tmp_path).write_bytes(kept[:-300] + bytes(300))
    assert "scene.state" in refusal()
    state_path(tmp_path).write_bytes(kept)
    assert run("--resume", "scene.nml", cwd=tmp_path, timeout=600.0).returncode == 0


def test_check_tells_lines_and_cost(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text))
    ended = run("--check", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    for words in (
        "! traces              3\n",
        "! scenes of the scan  51\n",
        "! a grid as fine has  49155 scenes\n",
    ):
        assert words in ended.stdout
    assert "core time of the scan" in ended.stdout and "   criterion = 'class'\n" in ended.stdout


REFUSED = [
    ({"key": "'load.force_amplitud'"}, "41: &threshold key: load.force_amplitud: unknown key; the nearest"),
    ({"key": "'force_amplitude'"}, "41: &threshold key: force_amplitude: a key is named as group.key"),
    ({"key": "'output.stride'"}, "41: &threshold key: output.stride: this key does not describe the motion"),
    (
        {"key": "'kinematics.rolling_speed'"},
        "41: &threshold key: kinematics.rolling_speed: the base input does",
    ),
    (
        {"key": "'kinematics.entrainment_speed'"},
        "41: &threshold key: &campaign varies kinematics.entrainment",
    ),
    ({"first": "500.0"}, "42: &threshold first: the first value must be below the last"),
    ({"first": "-5.0"}, "42: &threshold first: -5.0 is not allowed for load.force_amplitude; allowed: "),
    (
        {"first": "0.0", "scale": "'logarithmic'"},
        "42: &threshold first: a logarithmic range must lie above zero",
    ),
    ({"last": "1e13"}, "43: &threshold last: 1.0E13 N gives numbers too large"),
    ({"count": "1"}, "44: &threshold count: 1 is not allowed"),
    ({"tolerance": "0.0"}, "45: &threshold tolerance: 0.0 is not allowed"),
    ({"criterion": "'clas'"}, "45: &threshold criterion: 'clas' is not allowed"),
    ({"criterion": "'harmonics'"}, "45: &threshold criterion: 'harmonics' is not allowed"),
    ({"criterion": "'film_force_rms'"}, " &threshold level: film_force_rms is a number: give the level"),
    (
        {"criterion": "'idle'", "level": "1.0"},
        "46: &threshold level: idle changes by itself and has no level",
    ),
    ({"criterion": "'double_sided'"}, "45: &threshold criterion: double_sided needs a backlash"),
    ({"key": None}, " &threshold key: this key is required"),
]


@pytest.mark.parametrize(("threshold", "fault"), REFUSED)
def test_refused_thresholds(threshold: dict, fault: str, refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text, threshold=threshold))
    assert_faults(refused("scene.nml"), "scene.nml", [fault.strip() if fault[0] == " " else fault])


def test_every_fault_at_once(refused, scene_text, tmp_path: Path) -> None:
    """Faults of the key come with those of the axes; a key of another task is named with its task."""
    text = threshold_text(
        scene_text,
        threshold={"key": "'load.foo'"},
        campaign={"vary": "'contact.bar'", "first": "1.0", "last": "2.0", "count": "2"},
    )
    (tmp_path / "scene.nml").write_text(text)
    faults = refused("scene.nml")
    assert len(faults) == 2 and "load.foo" in faults[0] and "contact.bar" in faults[1]
    (tmp_path / "scene.nml").write_text(text.replace("'threshold'", "'campaign'"))
    assert all("used only with scene.task=threshold" in fault for fault in refused("scene.nml")[:4])
    (tmp_path / "scene.nml").write_text(
        threshold_text(scene_text, campaign={**SPEEDS, "record": "'verified'"})
    )
    assert "&campaign record: this key is used only with scene.task=campaign" in refused("scene.nml")[0]
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text))
    (tmp_path / "other.nml").write_text(threshold_text(scene_text))
    assert "a threshold must be the only input of a call" in refused("scene.nml", "other.nml")[0]


def test_lines_that_are_no_scenes(run, found, scene_text, tmp_path: Path) -> None:
    """At the first value the static load is negative: refused, or a kind of its own if that is allowed."""
    threshold = {"key": "'load.steady_force'", "first": "-100.0", "last": "200.0", "tolerance": "1e-2"}
    text = threshold_text(scene_text, threshold=threshold)
    (tmp_path / "scene.nml").write_text(text)
    ended = run("scene.nml", cwd=tmp_path)
    assert (
        ended.returncode == 2
        and "the static load steady_force + mass*gravity must be positive" in ended.stderr
    )
    rows = found(text.replace("&campaign\n", "&campaign\n   allow_invalid = .true.\n"), code=1)
    assert (rows.groupby("trace")["status_below_word"].first() == "invalid").all()
    weight = 3.0 * 9.80665
    first = rows.groupby("trace").first()
    assert ((first["lower"] <= -weight) & (-weight <= first["upper"])).all()


@pytest.mark.long
def test_every_gear_of_a_box_has_its_curve(run, repository: Path, tmp_path: Path) -> None:
    """The thresholds of a pair in a box are those of its campaign alone; the figure names the pairs."""
    text = (repository / "input" / "gearbox_map.nml").read_text().partition("&campaign")[0]
    shutil.copy(repository / "input" / "gearbox_run_up.csv", tmp_path)
    changes = ["scene.task='threshold'", "threshold.key='load.force_scale'", "threshold.first=0.05"]
    changes += ["threshold.last=5.0", "threshold.criterion='double_sided'", "threshold.tolerance=1e-2"]
    changes += [
        "threshold.scale='logarithmic'",
        "campaign.vary='shaft.speed_rpm'",
        "spectrum.verify=.false.",
    ]
    changes += ["campaign.first=800.0", "campaign.last=1600.0", "campaign.count=3"]
    changes += ["film.law='iso-viscous'", "film.model='reynolds'"]
    options = [part for change in changes for part in ("--set", change)]
    (tmp_path / "box.nml").write_text(text)
    ended = run(*options, "box.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0, ended.stderr
    result = package.read(tmp_path / "results" / "box.rattle")
    rows = result.frame()
    assert rows["gear"].tolist() == np.repeat([1.0, 2.0, 3.0, 4.0], 3).tolist()
    assert (rows["crossing"] == 1).all() and rows["lower"].nunique() > 4
    first = text.index("&gear")
    parts = [f"&gear{part}" for part in text[first:].split("&gear")[1:]]
    rest = text[:first] + parts[-1].partition("\n/\n")[2]
    (tmp_path / "alone.nml").write_text(rest + parts[1].partition("\n/\n")[0] + "\n/\n")
    ended = run(*options, "alone.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0, ended.stderr
    alone = package.read(tmp_path / "results" / "alone.rattle").frame()
    np.testing.assert_array_equal(alone["lower"], rows["lower"][3:6])
    found, held = threshold.cut(thresholds(result), {}, 2)
    words = [text.get_text() for text in threshold.draw(found, held).legends[0].get_texts()]
    assert words[:4] == [f"gear {name}" for name in read_plan(result.input_text).gears]
