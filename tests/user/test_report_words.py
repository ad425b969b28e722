"""Sentences and tables of reports, word for word, on results of which all numbers are made up."""

from __future__ import annotations

import re
from pathlib import Path

import campaign_writer
import numpy as np
import pytest
from campaign_writer import FORCES, SPEEDS, Key
from report_reader import number, read_page
from test_drawn_thresholds import written
from test_report import CALM, report, with_summary

import rattle
from rattle import rerun
from rattle.report import campaign as campaign_report
from rattle.report import motion as motion_report
from rattle.report import threshold as threshold_report

NAN = np.nan


@pytest.fixture
def counted(tmp_path: Path) -> rattle.Campaign:
    """Sixteen scenes in chunks of four, of which the last is not done; every count is another number."""
    forces, speeds = Key(FORCES.key, 100.0, 400.0, 4), Key(SPEEDS.key, 1.0, 4.0, 4)
    made = campaign_writer.grid(forces, speeds, name="counted", chunk_rows=4)
    columns = {
        "status": [1.0] * 10 + [3.0, 3.0] + [1.0] * 4,
        "rattle_class": [1, 3, 3, 3, 3, 3, 3, 2, 2, 2, NAN, NAN] + [1.0] * 4,
        "verified": [1, 1, 1, 1, 1, 1, 0, 0, 0, NAN, NAN, NAN] + [1.0] * 4,
        "law_contradicted": [1.0] * 7 + [0.0] * 3 + [NAN] * 2 + [1.0] * 4,
        "model_limit": [1.0] * 2 + [2.0] * 2 + [3.0] + [0.0] * 5 + [NAN] * 2 + [1.0] * 4,
        "stiffness_matters": [1.0] * 4 + [0.0] * 6 + [NAN] * 2 + [1.0] * 4,
        "double_sided": [1.0] * 3 + [0.0] * 7 + [NAN] * 2 + [1.0] * 4,
        # What stands in a row that failed is no quantity of a motion.
        "acceleration_maximum": [*range(10, 20), 900.0, 901.0, *[950.0] * 4],
        "film_minimum": [*(1e-7 * place for place in range(10, 20)), 1e-12, 1e-12, *[1e-12] * 4],
    }
    known = [name for name, _ in made.columns]
    made.rows = np.column_stack(
        [made.rows, *(np.zeros(len(made.rows)) for name in columns if name not in known)]
    )
    made.columns += [(name, "-") for name in columns if name not in known]
    for name, values in columns.items():
        made.column(name)[:] = values
    return rattle.read_campaign(made.write(tmp_path / "counted.rattle", undone=[3], closed=False))


def test_every_sentence_on_a_campaign_counts_its_rows(counted) -> None:
    assert list(campaign_report.sentences_on(counted)) == [
        "12 of 16 scenes are solved; 2 of them failed.",
        "Class of the motion: idle in 6 (50.0 %), creep in 3 (25.0 %), quiet in 1 (8.3 %).",
        "The class is verified in 6 scenes: solved again, tighter, it is the same, "
        "or both halves of an irregular motion agree. "
        "3 of 9 scenes are not verified.",
        "In 7 scenes the film law is not the one of the regime that the motion reaches.",
        "In 5 scenes the film leaves the range of the model: below 1 nm, or above a tenth of the radius.",
        "In 4 scenes the teeth deflect, or if they are rigid those of steel would, by more than a tenth of "
        "the film: rigid teeth are no fair assumption there.",
        "In 3 scenes the tooth hits both flanks of its gap.",
    ]
    head = campaign_report.verdict(counted)[0]
    assert '<p class="class">Idle, creep, quiet</p>' in head
    assert "3 of 9 classes are not numerically verified." in head


def test_a_map_says_where_impacts_begin_and_where_they_are_worst(tmp_path: Path) -> None:
    """No share of the grid: the step in which the first impacts are, and the scene of the largest force."""
    forces, speeds = Key(FORCES.key, 100.0, 400.0, 4), Key(SPEEDS.key, 1.0, 4.0, 4)
    for hit, begins in (
        ({(300.0, 2.0), (400.0, 3.0)}, "between 200 and 300 N of force amplitude (entrainment speed 2 m/s)"),
        ({(100.0, 4.0)}, "from 100 N or below of force amplitude (entrainment speed 4 m/s)"),
        (set(), None),
    ):
        made = campaign_writer.grid(forces, speeds, name="hit")
        places = list(zip(made.column(FORCES.key), made.column(SPEEDS.key), strict=True))
        columns = {
            "verdict": [2.0 if place in hit else 0.0 for place in places],
            "film_force_rms": [force - 10.0 * abs(speed - 3.0) for force, speed in places],
            "verdict_verified": [1.0] * 15 + [0.0],
        }
        made.rows = np.column_stack([made.rows, *columns.values()])
        made.columns += [(name, "N" if name == "film_force_rms" else "-") for name in columns]
        for name in ("status", "verified"):
            made.column(name)[:] = 1.0
        campaign = rattle.read_campaign(made.write(tmp_path / "hit.rattle"))
        box = read_page(report(campaign.path)).verdicts[0].strip().splitlines()
        worst = "worst 400 N rms (force amplitude 400 N, entrainment speed 3 m/s)"
        assert box[0] == (
            f"Impacts begin {begins}; {worst}" if begins else "No impacts in the range computed"
        )
        assert box[1] == "All 16 scenes are solved. 1 of 16 verdicts are not numerically verified."


def test_a_count_of_one_stands_before_no_plural(tmp_path: Path) -> None:
    """Five scenes, of which each sentence counts one."""
    made = campaign_writer.grid(Key(FORCES.key, 100.0, 500.0, 5), Key(SPEEDS.key, 1.0, 1.0, 1), name="one")
    one = np.array([1.0, 0.0, 0.0, 0.0, 0.0])
    columns = {"status": np.ones(5), "rattle_class": np.ones(5), "motions": 1.0 + one, "verified": one}
    columns |= dict.fromkeys(("law_contradicted", "model_limit", "double_sided"), one)
    columns["verdict_verified"] = 1.0 - one
    known = [name for name, _ in made.columns]
    fresh = [name for name in columns if name not in known]
    made.rows = np.column_stack([made.rows, *(np.zeros(5) for _ in fresh)])
    made.columns += [(name, "-") for name in fresh]
    for name, values in columns.items():
        made.column(name)[:] = values
    reported = " ".join(
        campaign_report.sentences_on(rattle.read_campaign(made.write(tmp_path / "one.rattle")))
    )
    for sentence in (
        "1 scene has several motions: ",
        "1 of 5 verdicts is another.",
        "The class is verified in 1 scene: ",
        "In 1 scene the film law ",
        "In 1 scene the film leaves ",
        "In 1 scene the tooth hits ",
    ):
        assert sentence in reported, sentence
    window = motion_report.key_figures({"window_periods": 1})
    assert "The window is the last period of the force." in window


def test_scenes_that_failed_or_are_not_done_are_in_no_range_and_no_worst(counted) -> None:
    (shown,) = [table for table in read_page(report(counted.path)).tables if table[0][1] == "Smallest"]
    ranges = {row[0]: [number(cell) for cell in row[1:]] for row in shown[1:]}
    least = next(values for name, values in ranges.items() if name.startswith("film_minimum"))
    np.testing.assert_allclose(least, [1e-6, 1.45e-6, 1.9e-6])
    largest = next(values for name, values in ranges.items() if name.startswith("acceleration_maximum"))
    assert largest == [10.0, 14.5, 19.0]
    worst = rerun.extreme_rows(counted, "acceleration_maximum", 3)
    assert counted["scene"][worst].tolist() == [10.0, 9.0, 8.0]
    best = rerun.extreme_rows(counted, "acceleration_maximum", 2, smallest=True)
    assert counted["scene"][best].tolist() == [1.0, 2.0]


@pytest.mark.long
def test_a_share_of_a_line_is_reported_in_per_cent(solved) -> None:
    result = (
        solved("calm", solver=CALM, spectrum={"harmonic_threshold": "0.035", "idle_harmonics": "9"})
        / "calm.rattle"
    )
    for word, words in (
        ("creep", "17 harmonics of the acceleration are above 3.5 % of the first, fewer than the 9 from"),
        ("idle", "17 harmonics of the acceleration are above 3.5 % of the first; 9 or more make it idle"),
    ):
        with_summary(result, rattle_class=f"'{word}'", harmonic_count="17")
        assert words in " ".join(read_page(report(result)).seen.split())


def test_every_line_of_a_motion_stands_beside_its_own_error(solved) -> None:
    result = solved("calm", solver=CALM) / "calm.rattle"
    path = result.with_suffix(".summary.nml")
    lines, errors = ([base + place for place in range(14)] for base in (100.0, 1.0))
    text = path.read_text().partition("! checksum")[0]
    for name, values in (("harmonics", lines), ("harmonic_errors", errors)):
        text = re.sub(rf"^   {name} = .*\n(      .*\n)*", "", text, flags=re.MULTILINE)
        text = text.replace("&summary\n", f"&summary\n   {name} = {', '.join(map(str, values))}\n", 1)
    path.write_text(text)
    (shown,) = [table for table in read_page(report(result)).tables if table[0][0] == "Harmonic"]
    reported = [(int(row[0]), number(row[1]), number(row[2])) for row in shown[1:]]
    assert reported == [(place + 1, lines[place], errors[place]) for place in range(12)]


@pytest.mark.long
def test_as_many_periods_are_reported_as_are_drawn(solved) -> None:
    for periods in (2, 12):
        result = solved(f"of_{periods}", solver={"periods": str(periods)}) / f"of_{periods}.rattle"
        repeats = rattle.read(result).orbit_period
        words = {None: f"over the last {min(periods, 4)} periods of the force", 1: "over one period."}[
            repeats
        ]
        assert words in read_page(report(result)).words
        result.with_suffix(".summary.nml").unlink()
        words = f"over the last {min(periods, 4)} periods of the force"
        assert words in read_page(report(result)).words


def test_every_sentence_on_thresholds_is_that_of_the_rows(tmp_path: Path) -> None:
    """The widest bracket is neither the first nor the last, and the verified ones are not half of all."""
    # line, speed, crossing, lower, upper, then below and above: class, status, verified
    rows = [
        [1.0, 1.0, 1.0, 40.0, 42.0, 1.0, 2.0, 1.0, 1.0, 1.0, 1.0],
        [2.0, 2.0, 1.0, 30.0, 38.0, 1.0, 2.0, 1.0, 1.0, 1.0, 1.0],
        [2.0, 2.0, 2.0, 70.0, 72.0, 2.0, 3.0, 1.0, 1.0, 1.0, 0.0],
        [3.0, 4.0, 0.0, 5.0, 100.0, 1.0, 1.0, 1.0, 1.0, NAN, NAN],
        [4.0, 8.0, 1.0, 20.0, 23.0, 1.0, 2.0, 1.0, 1.0, 1.0, 1.0],
    ]
    result = written(tmp_path / "edge.rattle", rows)
    found = threshold_report.picture.thresholds(result)
    reported = list(threshold_report.sentences_on(found, {"scenes": 30, "scenes_of_a_grid": 600.0}))
    assert reported[0].startswith(
        "Looked for: change of class, along the force amplitude from 5 N to 100 N, on 4"
    )
    assert reported[1:4] == [
        "From quiet to creep: 3 times, between 21.5 N and 41 N.",
        "From creep to idle: at 71 N.",
        "1 of 4 traces has no threshold in this range.",
    ]
    assert reported[4].startswith("At 3 of 4 thresholds both ends are numerically verified: ")
    assert "solved in 33 places" in reported[5] and "the widest that is left is 8 N." in reported[5]
    assert reported[6] == "It took 30 scenes; a grid as fine has 20 times as many."
    page = read_page(report(result.path))
    (kinds,) = [table for table in page.tables if table[0][0] == "From, to"]
    assert [[row[0], row[1], number(row[2]), number(row[3]), row[4]] for row in kinds[1:]] == [
        ["quiet to creep", "3", 21.5, 41.0, "0"],
        ["creep to idle", "1", 71.0, 71.0, "1"],
    ]


def test_where_no_scene_has_a_motion_nothing_is_said_of_motions(run, scene_text, tmp_path: Path) -> None:
    """No film of rigid flanks carries these loads: every scene fails before it begins."""
    film = {"law": "'piezo-viscous'", "model": "'reynolds'"}
    base = {"film": film, "solver": CALM, "load": {"steady_force": "3e4"}}
    loads = {"first": "3e4", "last": "4e4", "count": "3"}
    record = "'rattle_class', 'verified', 'acceleration_maximum'"
    tasks = {
        "sweep": {"sweep": {"key": "'steady_force'", **loads}, "solver": {**CALM, "until": None}},
        "campaign": {"campaign": {"vary": "'load.steady_force'", **loads, "record": record}},
        "threshold": {
            "threshold": {"key": "'load.force_amplitude'", "first": "5", "last": "50", "count": "3"}
        },
    }
    said = {}
    for task, changes in tasks.items():
        text = scene_text(**{**base, "scene": {"task": f"'{task}'"}, **changes})
        (tmp_path / f"{task}.nml").write_text(text)
        assert run("--output", ".", f"{task}.nml", cwd=tmp_path).returncode == 1
        said[task] = read_page(report(tmp_path / f"{task}.rattle"))
    words = {task: " ".join(page.seen.split()) for task, page in said.items()}
    assert " no class " in words["sweep"] and "5 failed" in words["sweep"]
    assert "way down" not in words["sweep"]
    cells = [row for row in said["sweep"].rows if row[:1] in (["up"], ["down"])]
    assert [row[4:] for row in cells] == [["-", "-"], ["-", "-"]]
    assert "No class 3 of 3 scenes are solved; 3 of them failed." in words["campaign"]
    assert "No scene has a class." in words["campaign"]
    assert "Scenes with the largest acceleration" not in said["campaign"].headings
    assert "verified" not in words["threshold"] and "widest" not in words["threshold"]
    assert (
        "The trace has no threshold in this range. The trace was solved in 3 places. Two"
        in words["threshold"]
    )
