"""Figures 3 to 5 of the film: right names, right words, one sentence for what lacks."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest
from drawn import all_words
from figure_files import stems
from film_writer import FILM_INPUT, write_points, write_profiles
from result_writer import write_motion, write_result
from script_calls import call_script

import rattle
from rattle.figures import film_points, film_pressures, style
from rattle.figures.fit import fit

PAPER = ["figure_03_film", "figure_04a_film", "figure_04b_film", "figure_05_film"]


@pytest.fixture
def film(tmp_path) -> Path:
    """A film task with everything, at the groups of the paper and at half its speed."""
    groups = (0.45e-6, 0.9e-6)
    write_profiles(tmp_path / "film.profiles.rattle", 70e-6, groups)
    return write_points(tmp_path / "film.rattle", np.geomspace(35e-6, 140e-6, 21), groups)


@pytest.mark.long
def test_a_film_task_gives_the_figures_of_the_paper(film, tmp_path):
    done = call_script("plot.py", "film", film, "--output", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == PAPER
    assert len(done.stdout.splitlines()) == len(PAPER)


def test_profiles_may_be_named_in_place_of_the_table(film, tmp_path):
    profiles = film.with_name("film.profiles.rattle")
    done = call_script("plot.py", "film", profiles, "--figures", "3", "--output", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == ["figure_03_film"]


@pytest.mark.long
def test_same_film_gives_the_same_bytes(film, tmp_path):
    for name in ("first", "second"):
        assert (
            call_script("plot.py", "film", film, "--figures", "3,5", "--output", tmp_path / name).returncode
            == 0
        )
    for first in (tmp_path / "first").iterdir():
        assert first.read_bytes() == (tmp_path / "second" / first.name).read_bytes(), first.name


def test_figure_5_says_which_films_do_not_exist(film):
    profiles = film_points.read_profiles(film)
    with style.house_style():
        printed = all_words(
            film_pressures.draw_piezo_viscous(profiles, film_points.Choice(speed_group=0.9e-6))
        )
        halved = all_words(
            film_pressures.draw_piezo_viscous(profiles, film_points.Choice(speed_group=0.45e-6))
        )
        both = all_words(film_pressures.draw_piezo_viscous(profiles, film_points.Choice()))
    assert "no rigid piezo-viscous film exists" in printed
    assert r"$\alpha p \leq 1.65$, no film" in printed and "MPa$" not in printed.replace("[MPa]", "")
    assert "no rigid" not in halved
    assert r"$\alpha p \leq 0.826$" in halved and r"$q \leq 201$ MPa" in halved
    assert "no rigid piezo-viscous film exists" in both and r"$q \leq 201$ MPa" in both


def test_figure_5_names_each_squeeze_ratio_once_in_a_column(film):
    profiles = film_points.read_profiles(film)
    with style.house_style():
        narrow = film_pressures.draw_piezo_viscous(profiles, film_points.Choice(narrow=True))
        wide = film_pressures.draw_piezo_viscous(profiles, film_points.Choice())
        fit(narrow, Namespace(width=80 / 25.4, font_size=None, no_title=False, xlim=None, ylim=None))
    (legend,) = narrow.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert len(words) == len(set(words)) == 1 + 5 + 2
    assert "pressure $q$, (31)" in words and "no film" not in all_words(narrow)
    assert all_words(wide).count("no film") > 4


def test_figure_5_counts_the_films_that_do_not_exist(tmp_path):
    write_profiles(tmp_path / "film.profiles.rattle", 96e-6)
    with style.house_style():
        profiles = film_points.read_profiles(tmp_path / "film.rattle")
        found = all_words(film_pressures.draw_piezo_viscous(profiles, film_points.Choice()))
    assert "no rigid film exists at 3 of 5" in found


@pytest.mark.parametrize(
    ("figure", "column"),
    [
        ("3", "pressure_group"),
        ("4", "stiffness_published"),
        ("5", "piezo_viscous_pressure"),
    ],
)
def test_a_column_that_was_not_asked_for_is_named(tmp_path, figure, column):
    without = {"without": column}
    write_profiles(tmp_path / "a.profiles.rattle", 70e-6, **without if figure != "4" else {})
    path = write_points(
        tmp_path / "a.rattle", np.geomspace(5e-5, 1e-4, 5), **without if figure == "4" else {}
    )
    done = call_script("plot.py", "film", path, "--figures", figure, "--output", tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert f"has no column '{column}'" in done.stderr


@pytest.mark.long
def test_without_the_piezo_viscous_slopes_the_others_are_drawn(tmp_path):
    path = write_points(tmp_path / "a.rattle", np.geomspace(5e-5, 1e-4, 5), without="stiffness_piezo_viscous")
    done = call_script("plot.py", "film", path, "--figures", "4", "--output", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == ["figure_04a_a", "figure_04b_a"]


@pytest.mark.long
def test_without_profiles_figure_4_is_drawn_and_the_rest_explained(tmp_path):
    path = write_points(tmp_path / "a.rattle", np.geomspace(5e-5, 1e-4, 5))
    done = call_script("plot.py", "film", path, "--output", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == ["figure_04a_a", "figure_04b_a"]
    assert done.stderr.count("was not asked for 'profile'") == 2
    asked = call_script("plot.py", "film", path, "--figures", "3", "--output", tmp_path / "figures")
    assert asked.returncode == 2 and asked.stderr.count("\n") == 1


def test_a_single_film_thickness_gives_no_figure_4(tmp_path):
    path = write_points(tmp_path / "a.rattle", np.array([7e-5]))
    done = call_script("plot.py", "film", path, "--figures", "4", "--output", tmp_path)
    assert done.returncode == 2
    assert "has a single film thickness; figure 4 needs several." in done.stderr


def test_a_film_that_the_result_does_not_hold_is_refused(film, tmp_path):
    done = call_script(
        "plot.py", "film", film, "--figures", "3", "--film-ratio", "8e-5", "--output", tmp_path
    )
    assert done.returncode == 2
    assert "has no film_ratio 8e-05; it holds 7e-05." in done.stderr


def test_a_motion_is_refused(tmp_path):
    path = write_motion(tmp_path / "idle.rattle", lines={1.0: 1.0})
    done = call_script("plot.py", "film", path, "--figures", "4", "--output", tmp_path)
    assert done.returncode == 2
    assert "is not a film but the result of task = 'motion'; 'plot.py motion' draws it." in done.stderr


@pytest.mark.parametrize("arguments", [("--figures", "6"), ("--film-ratio", "-1"), ("--speed-group", "fast")])
def test_wrong_options_of_film_figures_are_explained(film, arguments):
    done = call_script("plot.py", "film", film, *arguments)
    assert done.returncode == 2
    assert f"'{arguments[1]}' is not" in done.stderr


def test_curves_beyond_the_most_are_thinned_with_a_word(tmp_path, capsys):
    names = ["film_ratio", "squeeze_ratio", "speed_group", "coordinate"]
    rows = [[7e-5, squeeze, 1e-6, x] for squeeze in np.linspace(-1, 1, 21) for x in (0.2, 0.1)]
    text = FILM_INPUT.format(task="film")
    path = write_result(tmp_path / "a.rattle", [(name, "-") for name in names], rows, input_text=text)
    found = film_points.curves(rattle.read(path), [], "coordinate", {"film_ratio": 7e-5})
    assert [curve.squeeze_ratio for curve in found][::4] == [-1.0, 0.0, 1.0]
    assert len(found) == film_points.MOST_CURVES
    assert (found[0]["coordinate"] == [0.1, 0.2]).all()
    assert "holds 21 squeeze ratios; 9 of them are drawn." in capsys.readouterr().err
    shades = film_points.colours(found)
    assert len(set(shades)) == len(shades) and shades[4] == film_points.ROLLING


def test_a_result_of_another_task_is_refused_once(tmp_path):
    path = write_motion(tmp_path / "motion.rattle", lines={1.0: 1.0})
    done = call_script("plot.py", "film", path, "--output", tmp_path)
    assert done.returncode == 2
    assert done.stderr == (
        f"plot.py: {path} is not a film but the result of task = 'motion'; 'plot.py motion' draws it.\n"
    )
