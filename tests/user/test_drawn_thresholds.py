"""What Python makes of thresholds: figures, the page of a report, a call of the program."""

from __future__ import annotations

import re
from pathlib import Path

import campaign_writer
import drawn
import numpy as np
import pytest
from campaign_runs import BASE
from campaign_writer import FORCE, SPEED, Key
from matplotlib.figure import Figure
from outcomes import contents
from report_reader import read_page
from result_writer import write_result
from script_calls import call_script

import rattle as package
from rattle.campaign_section import new_section
from rattle.figures import campaign_map, style, threshold
from rattle.thresholds import thresholds

SIDES = ("verified_below", "verified_above")
NAN = np.nan
# trace, speed, crossing, lower, upper, then below and above: class, status, verified
ROWS = [
    [1.0, 1.0, 1.0, 40.0, 42.0, 1.0, 2.0, 1.0, 1.0, 1.0, 1.0],
    [1.0, 1.0, 2.0, 90.0, 92.0, 2.0, 3.0, 1.0, 1.0, 1.0, 1.0],
    [2.0, 2.0, 1.0, 30.0, 32.0, 1.0, 2.0, 1.0, 1.0, 1.0, 0.0],
    [2.0, 2.0, 2.0, 70.0, 72.0, 2.0, NAN, 1.0, 3.0, 1.0, NAN],
    [3.0, 4.0, 0.0, 5.0, 100.0, 1.0, 1.0, 1.0, 1.0, NAN, NAN],
    [4.0, 8.0, 1.0, 20.0, 22.0, 1.0, 2.0, 1.0, 1.0, 1.0, 1.0],
]
PLANE = [
    [
        float(1 + 10 * x + y),
        float(x),
        float(y),
        1.0,
        10.0 * x + y,
        10.0 * x + y + 2.0,
        1.0,
        2.0,
        1.0,
        1.0,
        1.0,
        1.0,
    ]
    for x in range(1, 11)
    for y in range(1, 10)
]


BASE_KEYS = {
    f"{group}.{key}": float(value) if value[0].isdigit() else value.strip("'")
    for group in ("solver", "spectrum")
    for key, value in BASE[group].items()
    if value is not None
}
BASE_KEYS = {key: int(value) if key.endswith("periods") else value for key, value in BASE_KEYS.items()}


def threshold_input(
    criterion: str = "class", axes: tuple[str, ...] = ("kinematics.entrainment_speed",)
) -> str:
    vary = "".join(f" vary({i}) = '{key}'\n" for i, key in enumerate(axes, 1))
    return (
        "&scene\n name = 'edge'\n task = 'threshold'\n/\n"
        "&film\n law = 'iso-viscous'\n model = 'published'\n/\n"
        f"&campaign\n{vary} sample = 'grid'\n/\n&threshold\n key = 'load.force_amplitude'\n first = 5.0\n"
        f" last = 100.0\n scale = 'linear'\n count = 33\n tolerance = 0.02\n criterion = '{criterion}'\n/\n"
    )


def written(path: Path, rows=ROWS, axes=("kinematics.entrainment_speed",), criterion: str = "class"):
    units = {"kinematics.entrainment_speed": "m/s", "load.mass": "kg"}
    names = [
        "trace",
        *axes,
        "crossing",
        "lower",
        "upper",
        "width",
        "rattle_class_below",
        "rattle_class_above",
    ]
    names += ["status_below", "status_above", *SIDES]
    columns = [(name, units.get(name, "N" if name in ("lower", "upper", "width") else "-")) for name in names]
    start = 1 + len(axes)
    widths = [row[start + 2] - row[start + 1] if row[start] else NAN for row in rows]
    rows = [[*row[: start + 3], width, *row[start + 3 :]] for row, width in zip(rows, widths, strict=True)]
    write_result(path, columns, rows, input_text=threshold_input(criterion, axes))
    return package.read(path)


def figure(result, **options) -> Figure:
    with style.house_style():
        return threshold.draw(thresholds(result), **options)


def test_kinds_of_change_are_curves_of_their_own(tmp_path):
    """Neighbours with as many changes of a kind are joined; a trace without a change is marked at the
    foot."""
    made = figure(written(tmp_path / "edge.rattle"))
    lines = drawn.curves(made.axes[0])
    expected = [
        ([1.0, 2.0], [41.0, 31.0]),
        ([8.0], [21.0]),
        ([1.0, 8.0], [41.0, 21.0]),
        ([2.0], [31.0]),
        ([1.0], [91.0]),
        ([1.0], [91.0]),
        ([2.0], [71.0]),
        ([2.0], [71.0]),
        # Where lines end within the picture, and those of one point.
        ([2.0, 8.0, 1.0, 2.0], [31.0, 21.0, 91.0, 71.0]),
    ]
    lines = [line for line in lines if line[0].size]
    assert len(lines) == len(expected)
    for found, wanted in zip(lines, expected, strict=True):
        np.testing.assert_array_equal(found, wanted)
    assert drawn.rules(made.axes[0], "x") == [4.0]
    assert drawn.legend_words(made) == [
        "quiet to creep (3)",
        "creep to idle (1)",
        "creep to film lost (1)",
        "from lower to upper",
        "end: its neighbour has no such change near",
        "not quiet here",
        "not verified (2)",
        "no change (1)",
    ]
    assert made.axes[0].get_xlabel() == "Entrainment speed [m/s]"
    assert made.axes[0].get_ylabel() == "Force amplitude [N], searched from 5 to 100 N"
    assert "Change of class" in made.axes[0].get_title(loc="left")


def test_the_axis_shows_the_changes_where_they_lie_close_together(tmp_path):
    far = figure(written(tmp_path / "far.rattle")).axes[0]
    assert far.get_ylim()[0] < 5.0 and far.get_ylim()[1] > 100.0
    near = figure(written(tmp_path / "near.rattle", [ROWS[0], ROWS[2], ROWS[5]])).axes[0]
    low, high = near.get_ylim()  # of 21, 31 and 41 N
    assert 5.0 < low < 20.0 and 42.0 < high < 60.0
    assert near.get_ylabel().endswith(", searched from 5 to 100 N")


def test_bars_that_hide_behind_their_marks_have_no_legend(tmp_path):
    """Shorter than a hundredth of the axis, which is 95 N long, in curves over one key and over two."""
    axes = ("kinematics.entrainment_speed", "load.mass")
    lasting = [row for row in ROWS if row[2] > 0.0]
    plane = [row for row in PLANE if row[2] <= 3.0]
    for width, shows in ((0.8, False), (1.2, True)):
        rows = [[*row[:4], row[3] + width, *row[5:]] for row in lasting]
        made = figure(written(tmp_path / f"{width}.rattle", rows))
        assert ("from lower to upper" in drawn.legend_words(made)) == shows
        rows = [[*row[:5], row[4] + width, *row[6:]] for row in plane]
        made = figure(written(tmp_path / f"{width}_plane.rattle", rows, axes))
        assert ("from lower to upper" in drawn.legend_words(made)) == shows


def test_neighbours_with_other_counts_of_a_change_are_not_joined(tmp_path):
    back = [2.0, 2.0, 2.0, 50.0, 52.0, 2.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    again = [2.0, 2.0, 3.0, 70.0, 72.0, 1.0, 2.0, 1.0, 1.0, 1.0, 1.0]
    made = figure(written(tmp_path / "edge.rattle", [ROWS[0], ROWS[2], back, again, ROWS[5]]))
    joined = [y.tolist() for x, y in drawn.curves(made.axes[0]) if x.size == 1]
    assert joined[:3] == [[41.0], [31.0], [71.0]] and drawn.legend_words(made)[0] == "quiet to creep (4)"


def test_the_side_that_rattles_is_shaded(tmp_path):
    """Above a change from quiet to creep, between its ends where it is quiet again, nowhere where quiet."""
    back = [2.0, 2.0, 2.0, 50.0, 52.0, 2.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    calm = [3.0, 4.0, 0.0, 5.0, 100.0, 1.0, 1.0, 1.0, 1.0, np.nan, np.nan]
    made = figure(written(tmp_path / "edge.rattle", [ROWS[0], ROWS[2], back, calm]))
    fills = [area for area in made.axes[0].collections if "Fill" in type(area).__name__]
    corners = [area.get_paths()[0].vertices for area in fills]
    spans = {(*area.min(axis=0), *area.max(axis=0)) for area in corners}
    assert spans == {(1.0, 41.0, 1.5, 100.0), (1.5, 31.0, 3.0, 51.0)}


def test_one_class_against_all_others(tmp_path):
    made = figure(written(tmp_path / "edge.rattle", ROWS[:3], criterion="quiet"))
    assert drawn.legend_words(made)[0] == "quiet to another class (2)"
    assert "Change into or out of quiet" in made.axes[0].get_title(loc="left")


def test_curves_lie_over_the_map_that_they_divide(tmp_path):
    path = tmp_path / "map.rattle"
    keys = Key(SPEED, 1.0, 8.0, 6), Key(FORCE, 5.0, 100.0, 5)
    campaign_writer.grid(*keys).write(path)
    result = written(tmp_path / "edge.rattle")
    done = call_script("plot.py", "threshold", result.path, "--map", path, "--output", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert sorted(contents(tmp_path / "out")) == ["threshold_edge.png"]
    section = threshold.behind(thresholds(result), path, {})
    made = figure(result, section=section)
    assert [axis.key for axis in section.free] == [SPEED, FORCE]
    assert any(words.startswith("creep (") for words in drawn.legend_words(made))
    assert "quiet to creep (3)" in drawn.legend_words(made)


def test_two_keys_are_curves_if_few_and_a_surface_if_many(tmp_path):
    axes = ("kinematics.entrainment_speed", "load.mass")
    few = [row for row in PLANE if row[2] <= 3.0]
    made = figure(written(tmp_path / "few.rattle", few, axes))
    lines = [line for line in drawn.curves(made.axes[0]) if line[0].size]
    for mass, (x, y) in enumerate(lines, 1):
        np.testing.assert_array_equal(x, np.arange(1.0, 11.0))
        np.testing.assert_array_equal(y, 10.0 * x + mass + 1.0)
    assert drawn.legend_words(made) == [
        *("mass 1 kg", "mass 2 kg", "mass 3 kg"),
        *("not quiet here", "from lower to upper"),
    ]
    made = figure(written(tmp_path / "many.rattle", PLANE, axes))
    mesh = next(one for one in made.axes[0].collections if one.get_array() is not None)
    values = np.asarray(mesh.get_array()).reshape(9, 10)
    np.testing.assert_array_equal(values, [[10.0 * x + y + 1.0 for x in range(1, 11)] for y in range(1, 10)])
    searched = "Force amplitude [N], searched from 5 to 100 N"
    assert [one.get_ylabel() for one in made.axes] == ["Mass [kg]", searched]
    gone = figure(written(tmp_path / "gone.rattle", PLANE, axes), crossing=2)
    assert drawn.legend_words(gone) == ["no change (90)"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--slice", "load.force=1"], "does not vary 'load.force'"),
        (["--slice", "kinematics.entrainment_speed=1"], "one has to stay free"),
        (["--map", "edge.rattle"], "is not a campaign but the result of task = 'threshold'"),
    ],
)
def test_what_cannot_be_drawn_is_reported(options, words, tmp_path):
    written(tmp_path / "edge.rattle")
    done = call_script("plot.py", "threshold", "edge.rattle", *options, cwd=tmp_path)
    assert done.returncode == 2 and words in done.stderr, done.stderr


def test_one_line_has_no_curve_but_a_page(tmp_path):
    rows = [[row[0], *row[2:]] for row in ROWS[:2]]
    path = written(tmp_path / "edge.rattle", rows, axes=()).path
    done = call_script("plot.py", "threshold", path)
    assert done.returncode == 2 and "there is no key to draw it along" in done.stderr
    done = call_script("report.py", path, "--output", tmp_path / "edge.html")
    assert done.returncode == 0, done.stderr
    assert "From quiet to creep: at 41 N." in read_page(tmp_path / "edge.html").words


def test_the_report_tells_every_threshold(tmp_path):
    path = written(tmp_path / "edge.rattle").path
    done = call_script("report.py", path, "--output", tmp_path / "edge.html")
    assert done.returncode == 0, done.stderr
    words = read_page(tmp_path / "edge.html").words
    for sentence in (
        "5 thresholds",
        "Looked for: change of class, along the force amplitude from 5 N to 100 N, on 4 traces, one for each",
        "From quiet to creep: 3 times, between 21 N and 41 N.",
        "1 of 4 traces has no threshold in this range.",
        "At 3 of 5 thresholds both ends are numerically verified",
        "quiet throughout",
        "Two changes between neighbours that cancel each other are not seen.",
    ):
        assert sentence in words, sentence
    shown = {float(digits) for digits, _ in read_page(tmp_path / "edge.html").numbers}
    for row in ROWS:
        if row[2]:
            assert row[3] in shown and row[4] in shown


def level_result(path: Path):
    """A threshold of a level of 100 N: below it below the change, above it above, and once the other way."""
    rows = [
        [1.0, 1.0, 1.0, 40.0, 42.0, 2.0, 99.0, 101.0, 1.0, 1.0, 1.0, 1.0],
        [2.0, 2.0, 1.0, 30.0, 31.0, 1.0, 100.0, 99.5, 1.0, 1.0, 1.0, 0.0],
    ]
    names = ["trace", "kinematics.entrainment_speed", "crossing", "lower", "upper", "width"]
    names += ["film_force_rms_below", "film_force_rms_above", "status_below", "status_above", *SIDES]
    newtons = ("lower", "upper", "width", "film_force_rms_below", "film_force_rms_above")
    units = dict.fromkeys(newtons, "N") | {"kinematics.entrainment_speed": "m/s"}
    text = threshold_input("film_force_rms").replace(" tolerance", " level = 100.0\n tolerance")
    write_result(path, [(name, units.get(name, "-")) for name in names], rows, input_text=text)
    return package.read(path)


def test_sides_of_a_level_are_named_for_what_they_are(tmp_path):
    found = thresholds(level_result(tmp_path / "edge.rattle"))
    assert found.kinds.tolist() == ["below 100 N to at least 100 N", "at least 100 N to below 100 N"]
    assert found.uncertain.tolist() == [False, True]
    made = figure(found.result)
    assert drawn.legend_words(made) == [
        "below 100 N to at least 100 N (1)",
        "at least 100 N to below 100 N (1)",
        "from lower to upper",
        "end: its neighbour has no such change near",
        "at least 100 N here",
        "not verified (1)",
    ]


def bars(axes) -> list[tuple[float, float, float]]:
    """Place, lower and upper end of every vertical bar."""
    segments = [
        part for one in axes.collections if hasattr(one, "get_segments") for part in one.get_segments()
    ]
    return sorted((float(part[0][0]), float(part[0][1]), float(part[1][1])) for part in segments)


def test_a_bar_goes_from_end_to_end_of_every_threshold(tmp_path):
    rows = [*ROWS, [5.0, 16.0, 1.0, 50.0, 80.0, 1.0, 2.0, 1.0, 1.0, 1.0, 1.0]]
    made = figure(written(tmp_path / "edge.rattle", rows))
    assert bars(made.axes[0]) == sorted((row[1], row[3], row[4]) for row in rows if row[2])
    axes = ("kinematics.entrainment_speed", "load.mass")
    few = [row for row in PLANE if row[2] <= 3.0]
    made = figure(written(tmp_path / "few.rattle", few, axes))
    assert bars(made.axes[0]) == sorted((row[1], row[4], row[5]) for row in few)


def test_every_cell_of_the_report_is_that_of_the_result(tmp_path):
    """Both tables, cell by cell, and each sentence with its numbers."""
    path = written(tmp_path / "edge.rattle").path
    summary = "&summary\n name = 'edge'\n status = 'complete'\n scenes = 50\n scenes_of_a_grid = 1000.0\n/\n"
    path.with_suffix(".summary.nml").write_text(summary)
    done = call_script("report.py", path, "--output", tmp_path / "edge.html")
    assert done.returncode == 0, done.stderr
    read = read_page(tmp_path / "edge.html")
    expected = [
        ["quiet to creep", "3", "21 N", "41 N", "1"],
        ["creep to idle", "1", "91 N", "91 N", "0"],
        ["creep to film lost", "1", "71 N", "71 N", "1"],
        ["1 m/s", "40 N", "42 N", "2 N", "quiet to creep", "yes"],
        ["1 m/s", "90 N", "92 N", "2 N", "creep to idle", "yes"],
        ["2 m/s", "30 N", "32 N", "2 N", "quiet to creep", "no"],
        ["2 m/s", "70 N", "72 N", "2 N", "creep to film lost", "no"],
        ["4 m/s", "-", "-", "-", "quiet throughout", "-"],
        ["8 m/s", "20 N", "22 N", "2 N", "quiet to creep", "yes"],
    ]
    rows = [[" ".join(cell.split()) for cell in row] for row in read.rows]
    # The heads of both tables stand before their rows.
    kinds = [
        row
        for row in rows
        if len(row) == 5 and row[0] in ("quiet to creep", "creep to idle", "creep to film lost")
    ]
    every = [row for row in rows if len(row) == 6 and row[0].endswith(" m/s")]
    assert kinds + every == expected
    for sentence in (
        "From quiet to creep: 3 times, between 21 N and 41 N.",
        "From creep to idle: at 91 N.",
        "From creep to film lost: at 71 N.",
        "1 of 4 traces has no threshold in this range.",
        "was solved in 33 places",
        "the widest that is left is 2 N.",
        "It took 50 scenes; a grid as fine has 20 times as many.",
    ):
        assert sentence in read.words, sentence


def test_thresholds_from_python_and_as_a_table(groups, tmp_path):
    asked = {"criterion": "quiet", "tolerance": 0.01, "set": BASE_KEYS, "folder": tmp_path}
    asked["vary"] = {"kinematics.entrainment_speed": [1.0, 2.0]}
    found = package.threshold(groups, "load.force_amplitude", 5.0, 455.0, **asked)
    frame = found.result.frame()
    ends = package.Range(5.0, 455.0)
    again = package.threshold(groups, "load.force_amplitude", ends, overwrite=True, **asked)
    assert again.result.frame().equals(frame)
    assert frame["trace"].tolist() == [1.0, 2.0] and found.summary["crossings"] == 2
    assert frame["rattle_class_below_word"].tolist() == ["quiet", "quiet"]
    assert set(frame["status_above_word"]) <= {"complete", "steady"}
    assert (frame["upper"] - frame["lower"] < 4.5).all() and frame.attrs["units"]["lower"] == "N"
    data = found.result.dataset()
    assert "quiet" in data["rattle_class_above"].attrs["flag_meanings"]
    done = call_script("export.py", found.result.path)
    assert done.returncode == 0, done.stderr
    table = found.result.path.with_suffix(".csv").read_text()
    assert re.search(r"rattle_class_below\[-\].*rattle_class_below_word", table) and ",quiet," in table
    with pytest.raises(package.InputError) as refused:
        package.threshold(groups, "load.mas", 1.0, 2.0, set=BASE_KEYS)
    assert (refused.value.faults[0].group, refused.value.faults[0].key) == ("threshold", "key")


@pytest.fixture
def groups(rattle: Path, monkeypatch) -> dict:
    """The groups of a scene, for the program under test."""
    monkeypatch.setenv("RATTLE_PROGRAM", str(rattle))
    return {
        "contact": {"radius": 0.0127, "length": 0.010},
        "lubricant": {"viscosity": 0.3, "pressure_viscosity": 2.0e-8},
        "kinematics": {"entrainment_speed": 1.905},
        "load": {"mass": 3.0, "steady_force": 199.2, "force_amplitude": 205.7, "frequency": 600.0},
        "film": {"law": "iso-viscous"},
    }


ENDS = ("last_below", "last_above", "motion_end_below", "motion_end_above")


def written_with_ends(
    path: Path, ends: list[list[float]], lower: list[float], crossings: tuple[float, ...] | None = None
):
    """One crossing on each trace, or none, at speeds of 1, 2, ... m/s, with the ends of its motions."""
    crossings = crossings or (1.0,) * len(lower)
    names = ["trace", "kinematics.entrainment_speed", "crossing", "lower", "upper", "width"]
    names += ["rattle_class_below", "rattle_class_above", "status_below", "status_above", *SIDES, *ENDS]
    newtons = ("lower", "upper", "width", *ENDS[:2])
    columns = [(name, "N" if name in newtons else "m/s" if name.startswith("kin") else "-") for name in names]
    rows = [
        [float(place), float(place), crossing, value, value + 2.0, 2.0, 1.0, 3.0, 1.0, 1.0, 1.0, 1.0, *end]
        for place, (crossing, value, end) in enumerate(zip(crossings, lower, ends, strict=True), 1)
    ]
    write_result(path, columns, rows, input_text=threshold_input())
    return package.read(path)


def test_between_the_ends_of_both_sides_either_is_possible(tmp_path):
    """A band between both ends where they overlap beyond the bracket; none where both end within it."""
    ends = [[60.0, 20.0, 1.0, 1.0], [70.0, 30.0, 1.0, 6.0], [41.0, 41.0, 4.0, 4.0], [NAN] * 4]
    result = written_with_ends(tmp_path / "edge.rattle", ends, [40.0] * 4)
    assert thresholds(result).either.tolist() == [True, True, False, False]
    made = figure(result)
    areas = [area for area in made.axes[0].collections if area.__class__.__name__.startswith("Fill")]
    (band,) = (area for area in areas if area.get_alpha() == 0.16)
    corners = np.concatenate([path.vertices for path in band.get_paths()])
    assert {(1.0, 20.0), (1.0, 60.0), (2.0, 30.0), (2.0, 70.0)} <= set(map(tuple, corners))
    assert corners[:, 0].max() == 2.0
    assert "either is possible (2)" in drawn.legend_words(made)
    plain = written_with_ends(tmp_path / "edge.rattle", ends[2:], [40.0] * 2)
    assert not any("either" in words for words in drawn.legend_words(figure(plain)))


def test_the_report_tells_of_another_side_where_no_threshold_is(tmp_path):
    ends = [[60.0, 20.0, 1.0, 1.0], [70.0, 30.0, 1.0, 6.0], [NAN] * 4]
    path = tmp_path / "edge.rattle"
    for crossings, reported in (((1.0, 0.0, 0.0), 1), ((1.0, 1.0, 0.0), 0)):
        result = written_with_ends(path, ends, [40.0] * 3, crossings)
        assert thresholds(result).another_side.sum() == reported
        done = call_script("report.py", path, "--output", tmp_path / "edge.html", "--overwrite")
        assert done.returncode == 0, done.stderr
        words = read_page(tmp_path / "edge.html").words
        assert ("1 trace without a threshold has motions on another side" in words) == bool(reported)


JUMP = "jump: too large to be sure of one curve"
END = "end: its neighbour has no such change near"


def shaded(axes) -> list[tuple[float, float]]:
    """Between which values of the first key each shaded part lies."""
    fills = [area for area in axes.collections if "Fill" in type(area).__name__ and area.get_alpha() == 0.1]
    corners = [area.get_paths()[0].vertices[:, 0] for area in fills]
    return sorted((float(x.min()), float(x.max())) for x in corners)


def test_a_curve_that_is_steep_is_one_line(tmp_path):
    """Temperatures at which impacts begin, from 700 to 2100 1/min; solved at more speeds, one curve."""
    lower = [30.296, 33.089, 23.77, 20.252, 19.218, 18.809, 18.258, 17.325]
    axes = figure(written_with_ends(tmp_path / "edge.rattle", [[NAN] * 4] * 8, lower)).axes[0]
    lines = [x for x, _ in drawn.curves(axes) if x.size == 8]
    np.testing.assert_array_equal(lines[0], np.arange(1.0, 9.0))
    assert not {JUMP, END} & set(drawn.legend_words(axes.figure)) and shaded(axes) == [(1.0, 8.0)]


def test_a_jump_of_a_curve_is_no_line(tmp_path):
    """Both sides of it are marked; shade and the band in which either is possible stop there too."""
    lower = [30.0, 31.0, 32.0, 70.0, 71.0, 72.0]
    ends = [[value + 9.0, value - 9.0, 1.0, 1.0] for value in lower]
    result = written_with_ends(tmp_path / "edge.rattle", ends, lower)
    axes = figure(result).axes[0]
    x, y = next(line for line in drawn.curves(axes) if line[0].size > 6)
    np.testing.assert_array_equal(x, [1.0, 2.0, 3.0, NAN, 4.0, 5.0, 6.0])
    np.testing.assert_array_equal(y, [31.0, 32.0, 33.0, NAN, 71.0, 72.0, 73.0])
    (marks,) = (line for line in axes.lines if line.get_marker() == "s" and line.get_markersize() == 8)
    np.testing.assert_array_equal(marks.get_xydata(), [[3.0, 33.0], [4.0, 71.0]])
    words = drawn.legend_words(axes.figure)
    assert JUMP in words and END not in words
    assert shaded(axes) == [(1.0, 3.5), (3.5, 6.0)]
    (band,) = (area for area in axes.collections if area.get_alpha() == 0.16)
    assert len(band.get_paths()) == 2
    done = call_script("report.py", result.path, "--output", tmp_path / "edge.html")
    assert done.returncode == 0, done.stderr
    words = read_page(tmp_path / "edge.html").words
    assert "where its neighbour has no such change near" in words
    assert "where a jump is too large to be sure of one curve" in words and "changes kind" not in words


def test_a_peak_of_one_point_is_two_jumps(tmp_path):
    lower = [30.0, 31.0, 70.0, 31.0, 30.0]
    axes = figure(written_with_ends(tmp_path / "edge.rattle", [[NAN] * 4] * 5, lower)).axes[0]
    x = next(x for x, _ in drawn.curves(axes) if x.size > 5)
    np.testing.assert_array_equal(x, [1.0, 2.0, NAN, 3.0, NAN, 4.0, 5.0])


def test_the_legend_over_a_map_counts_what_is_drawn(tmp_path):
    """Of five crossings two lie below the map, and one beyond its last speed."""
    lower = [30.0, 31.0, 32.0, 33.0, 34.0]
    result = written_with_ends(tmp_path / "edge.rattle", [[NAN] * 4] * 5, lower)
    path = tmp_path / "map.rattle"
    campaign_writer.grid(Key(SPEED, 1.0, 4.0, 4), Key(FORCE, 32.5, 100.0, 5)).write(path)
    made = figure(result, section=threshold.behind(thresholds(result), path, {}))
    assert "quiet to idle (2, 3 more outside)" in drawn.legend_words(made)
    section = new_section(package.read_campaign(path), (SPEED, FORCE), {})
    over = campaign_map.Options((), "auto", (thresholds(result),))
    made = campaign_map.draw(section, "rattle_class", over)
    assert "threshold: change of class (3 of 5 outside)" in drawn.legend_words(made)
