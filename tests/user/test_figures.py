"""Figures of motions: right names, not blank, the same bytes every time."""

from __future__ import annotations

from pathlib import Path

import pytest
from matplotlib.image import imread
from result_writer import write_motion
from script_calls import call_script, figure_stems

LINES = {1.0: 10.0, 2.0: 8.0, 3.0: 3.0}
PAPER = [
    "figure_06_idle",
    "figure_07_idle",
    "figure_08_idle",
    "figure_09_creep",
    "figure_10a_idle",
    "figure_10b_creep",
]


@pytest.fixture
def iso(tmp_path) -> Path:
    return write_motion(tmp_path / "idle.rattle", lines=LINES)


@pytest.fixture
def piezo(tmp_path) -> Path:
    return write_motion(tmp_path / "creep.rattle", lines=LINES, law="piezo-viscous")


@pytest.mark.long
def test_one_run_of_each_law_gives_the_set_of_the_paper(iso, piezo, tmp_path):
    output = tmp_path / "figures"
    done = call_script("plot.py", "motion", iso, piezo, "--format", "png,pdf", "--output", output)
    assert done.returncode == 0, done.stderr
    assert figure_stems(output) == sorted(path.stem for path in output.glob("*.pdf")) == PAPER
    assert len(done.stdout.splitlines()) == 2 * len(PAPER)
    for path in output.glob("*.png"):
        picture = imread(path)
        assert picture.shape[0] > 400 and picture.shape[1] > 1000
        assert 0.005 < (picture[:, :, :3].min(axis=2) < 0.9).mean() < 0.5, path
    for path in output.glob("*.pdf"):
        assert path.read_bytes().startswith(b"%PDF")


@pytest.mark.long
def test_same_results_give_the_same_bytes(iso, piezo, tmp_path):
    outputs = [tmp_path / "first", tmp_path / "second"]
    for output, zone in zip(outputs, ("UTC", "Asia/Tokyo"), strict=True):
        given = ("motion", iso, piezo, "--format", "png,pdf", "--output", output)
        assert call_script("plot.py", *given, TZ=zone).returncode == 0
    for first in outputs[0].iterdir():
        assert first.read_bytes() == (outputs[1] / first.name).read_bytes(), first.name


@pytest.mark.long
def test_only_the_figures_asked_for_are_drawn(iso, piezo, tmp_path):
    output = tmp_path / "figures"
    done = call_script(
        "plot.py", "motion", iso, piezo, "--figures", "9,10", "--periods", 2, "--output", output
    )
    assert done.returncode == 0, done.stderr
    assert figure_stems(output) == ["figure_09_creep", "figure_10a_idle", "figure_10b_creep"]


def test_runs_of_one_law_are_distinguished_by_scene_name(iso, tmp_path):
    other = write_motion(tmp_path / "light.rattle", lines={1.0: 1.0})
    output = tmp_path / "figures"
    assert call_script("plot.py", "motion", iso, other, "--figures", "8", "--output", output).returncode == 0
    assert figure_stems(output) == ["figure_08_idle", "figure_08_light"]


def test_runs_of_one_name_are_distinguished_by_directory(iso, tmp_path):
    (tmp_path / "loose").mkdir()
    other = write_motion(tmp_path / "loose" / "idle.rattle", lines=LINES)
    output = tmp_path / "figures"
    assert call_script("plot.py", "motion", iso, other, "--figures", "8", "--output", output).returncode == 0
    assert figure_stems(output) == sorted([f"figure_08_{tmp_path.name}_idle", "figure_08_loose_idle"])


@pytest.mark.long
def test_overlay_draws_all_runs_in_one_figure(iso, piezo, tmp_path):
    output = tmp_path / "figures"
    done = call_script("plot.py", "motion", iso, piezo, "--overlay", "--output", output)
    assert done.returncode == 0, done.stderr
    assert figure_stems(output) == [
        "figure_06_overlay",
        "figure_07_overlay",
        "figure_08_09_overlay",
        "figure_10_overlay",
    ]


def test_overlay_of_more_runs_than_colours_is_refused(iso, tmp_path):
    done = call_script("plot.py", "motion", *[iso] * 8, "--overlay", "--output", tmp_path)
    assert done.returncode == 2
    assert "An overlay shows 7 runs at most; 8 were given." in done.stderr


def test_unclosed_run_is_drawn_with_a_word(tmp_path):
    path = write_motion(tmp_path / "killed.rattle", lines=LINES, closed=False)
    done = call_script("plot.py", "motion", path, "--figures", "8", "--output", tmp_path)
    assert done.returncode == 0
    assert "is not closed; its 2561 complete rows are used." in done.stderr


def test_tolerance_figure_is_drawn(iso, tmp_path):
    loose = write_motion(tmp_path / "loose.rattle", lines={1.0: 4.0, 2.5: 9.0}, tolerance=1e-7)
    pair = ("--false-harmonic", loose, iso, "--false-reversals", loose, iso)
    done = call_script("plot.py", "tolerance", *pair, "--output", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    assert figure_stems(tmp_path / "figures") == ["tolerance"]


def test_tolerance_figure_refuses_two_motions_and_a_wrong_order(iso, piezo, tmp_path):
    loose = write_motion(tmp_path / "loose.rattle", lines=LINES, tolerance=1e-7)
    other = call_script("plot.py", "tolerance", "--false-harmonic", loose, piezo, "--output", tmp_path)
    assert other.returncode == 2
    assert "are not the same motion: their groups &film differ." in other.stderr
    swapped = call_script("plot.py", "tolerance", "--false-harmonic", iso, loose, "--output", tmp_path)
    assert swapped.returncode == 2
    assert "is not looser than" in swapped.stderr


@pytest.mark.parametrize("number", ["6", "8"])
def test_a_needed_column_that_is_absent_is_named(tmp_path, number):
    column = {"6": "film_thickness", "8": "acceleration"}[number]
    path = write_motion(tmp_path / "a.rattle", lines=LINES, without=column)
    done = call_script("plot.py", "motion", path, "--figures", number, "--output", tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert f"has no column '{column}'" in done.stderr


def test_figures_that_no_result_gives_are_refused(iso, tmp_path):
    done = call_script("plot.py", "motion", iso, "--figures", "9", "--output", tmp_path)
    assert done.returncode == 2
    assert "Nothing to draw: iso-viscous results give no figure 9." in done.stderr


def test_an_output_place_that_cannot_be_written_is_named(iso, tmp_path):
    (tmp_path / "taken").write_text("a file, not a directory")
    done = call_script("plot.py", "motion", iso, "--figures", "8", "--output", tmp_path / "taken")
    assert done.returncode == 2
    assert "taken is not a folder" in done.stderr


def test_a_motion_at_rest_is_drawn(tmp_path):
    path = write_motion(tmp_path / "rest.rattle", lines={1.0: 0.0})
    done = call_script("plot.py", "motion", path, "--figures", "8", "--output", tmp_path)
    assert done.returncode == 0, done.stderr


def test_another_scene_does_not_replace_the_figures_of_the_first(iso, tmp_path):
    output = tmp_path / "figures"
    other = write_motion(tmp_path / "light.rattle", lines={1.0: 1.0})
    for path in (iso, other):
        assert call_script("plot.py", "motion", path, "--figures", "8", "--output", output).returncode == 0
    assert figure_stems(output) == ["figure_08_idle", "figure_08_light"]


@pytest.mark.parametrize(
    "script", ["plot.py motion", "plot.py tolerance --false-harmonic other", "classify.py"]
)
def test_the_result_of_another_task_is_refused_with_the_script_that_draws_it(script, tmp_path):
    path = write_motion(tmp_path / "up.rattle", lines=LINES, task="sweep")
    done = call_script(*script.replace("other", str(path)).split(), path)
    assert done.returncode == 2
    assert "is not a motion but the result of task = 'sweep'; 'plot.py sweep' draws it." in done.stderr


def test_a_result_in_place_of_the_command_is_answered_with_the_command(iso):
    done = call_script("plot.py", iso)
    assert done.returncode == 2
    assert done.stderr == f"plot.py: {iso} is not a command; 'plot.py motion {iso}' draws it.\n"


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("motion", ["RESULT", "--figures", "--overlay"]),
        ("film", ["RESULT", "--film-ratio"]),
        ("sweep", ["RESULT", "--panels", "--mark"]),
        ("campaign", ["FILE", "--slice", "--summary"]),
        ("threshold", ["RESULT", "--map", "--crossing", "--slice"]),
        ("tolerance", ["--false-harmonic"]),
        ("film-fit", ["--alpha-p"]),
        ("regime-map", ["SUMMARY|RESULT"]),
    ],
)
def test_every_command_has_help_with_the_common_options(name, parts):
    done = call_script("plot.py", name, "--help")
    assert done.returncode == 0, done.stderr
    for part in (*parts, "--output DIR", "--format NAMES", "--width MM", "--dpi N"):
        assert part in done.stdout
    assert name in call_script("plot.py", "--help").stdout


def test_format_width_and_resolution_are_those_asked_for(iso, tmp_path):
    options = ("--format", "svg,png", "--width", 80, "--dpi", 254)
    for output in ("first", "second"):
        done = call_script("plot.py", "motion", iso, "--figures", 8, "--output", tmp_path / output, *options)
        assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in (tmp_path / "first").iterdir()) == [
        "figure_08_idle.png",
        "figure_08_idle.svg",
    ]
    assert imread(tmp_path / "first" / "figure_08_idle.png").shape[1] == 800
    for path in (tmp_path / "first").iterdir():
        assert path.read_bytes() == (tmp_path / "second" / path.name).read_bytes()


@pytest.mark.parametrize(
    ("option", "value", "sentence"),
    [
        ("--format", "gif", "'gif' is not one of png, pdf, svg"),
        ("--format", "", "no format is named"),
        ("--width", "8", "'8' is not a width from 40 to 1000 mm"),
        ("--dpi", "0", "'0' is not a positive whole number"),
    ],
)
def test_wrong_common_options_are_explained(iso, tmp_path, option, value, sentence):
    done = call_script("plot.py", "motion", iso, "--output", tmp_path / "figures", option, value)
    assert done.returncode == 2
    assert sentence in done.stderr
    assert not (tmp_path / "figures").exists()
