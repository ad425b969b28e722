"""The curves of time series: the extreme rows are part of them, the spectra take the other rows alone."""

from __future__ import annotations

from pathlib import Path

import drawn
import numpy as np
import pytest
from result_writer import write_motion

import rattle
from rattle.figures import histories, style
from rattle.figures.spectra import column_spectrum

# Behind the 20th period, in the last of the periods drawn, and long before; the period lasts 2 ms.
EXTREMES = [[0.00501, 1.0, 2e-6, 500.0], [0.03351, 2.0, 9e-6, -700.0], [0.03999, 3.0, 1e-9, 900.0]]

FILMLESS = [[time, force, value] for time, force, _, value in EXTREMES]


@pytest.fixture
def result(tmp_path: Path) -> rattle.Result:
    return rattle.read(write_motion(tmp_path / "a.rattle", lines={1.0: 5.0}, extremes=EXTREMES))


def curve(axes) -> np.ndarray:
    """The points of the curve with the most of them."""
    return max((line.get_xydata() for line in axes.lines), key=len)


@pytest.mark.parametrize(
    ("draw", "place", "scale", "column"),
    [
        (histories.draw_acceleration, 0, 1.0, 3),
        (histories.draw_film_and_force, 0, 1e6, 2),
        (histories.draw_film_and_force, 1, 1.0, 1),
    ],
    ids=["acceleration", "film", "force"],
)
def test_extreme_rows_are_part_of_the_curve(result, draw, place, scale, column):
    points = curve(draw([result], ["a"], 4).axes[place])
    start = result["time"][-1] - 4 / 500.0
    expected = [[1e3 * (row[0] - start), scale * row[column]] for row in EXTREMES[1:]]
    assert len(points) == 4 * 128 + 1 + 2
    assert (np.diff(points[:, 0]) > 0).all()
    for point in expected:
        assert np.isclose(points, point, rtol=1e-12).all(axis=1).sum() == 1


def test_spectra_take_the_regular_rows_alone(result, tmp_path):
    without = rattle.read(write_motion(tmp_path / "b.rattle", lines={1.0: 5.0}))
    for one, other in zip(
        column_spectrum(result, "acceleration", None),
        column_spectrum(without, "acceleration", None),
        strict=True,
    ):
        np.testing.assert_array_equal(one, other)


# --- series that are coarser than their motion ---------------------------------------------------------


def coarse(tmp_path: Path, name: str = "a", **options) -> rattle.Result:
    options = {"lines": {1.0: 5.0}, "extremes": EXTREMES, "coarse": True} | options
    return rattle.read(write_motion(tmp_path / f"{name}.rattle", **options))


def notes(axes) -> list[str]:
    return [text.get_text() for text in axes.texts]


def between(points: np.ndarray) -> np.ndarray:
    """The points that are no samples."""
    steps = points[:, 0] * 128 / 2.0
    return points[np.abs(steps - np.round(steps)) > 1e-6]


@pytest.mark.parametrize(
    ("draw", "place", "scale", "column"),
    [
        (histories.draw_acceleration, 0, 1.0, 3),
        (histories.draw_film_and_force, 0, 1e6, 2),
        (histories.draw_film_and_force, 1, 1.0, 1),
    ],
    ids=["acceleration", "film", "force"],
)
def test_every_period_that_repeats_has_the_extremes(tmp_path, draw, place, scale, column):
    """Also those of a period that stands before all that are drawn."""
    made = draw([coarse(tmp_path)], ["a"], 4)
    points = curve(made.axes[place])
    expected = [
        (1e3 * (row[0] % 0.002) + 2.0 * period, scale * row[column])
        for period in range(4)
        for row in sorted(EXTREMES, key=lambda row: row[0] % 0.002)
    ]
    np.testing.assert_allclose(between(points), expected, rtol=1e-9)
    assert (np.diff(points[:, 0]) > 0).all() and len(points) == 4 * 128 + 1 + 12
    assert notes(made.axes[0]) == []


def test_a_period_with_other_films_has_not_the_extremes(tmp_path):
    """Every second period is the same here."""
    made = histories.draw_acceleration([coarse(tmp_path, film_lines={0.5: 1e-3})], ["a"], 4)
    expected = [(1.01, 500.0), (1.51, -700.0), (3.99, 900.0), (5.01, 500.0), (5.51, -700.0), (7.99, 900.0)]
    np.testing.assert_allclose(between(curve(made.axes[0])), expected, rtol=1e-9)
    words = "Series of too few samples; between them -700 to 900 m/s$^2$, not all drawn"
    assert notes(made.axes[0]) == [words]
    film = histories.draw_film_and_force([coarse(tmp_path, film_lines={0.5: 1e-3})], ["a"], 4)
    words = r"between them 0.001 to 9 $\mathrm{\mu}$m, not all drawn"
    assert [note.endswith(words) for note in notes(film.axes[0])] == [True]


def test_films_that_differ_by_less_than_a_line_are_the_same(tmp_path):
    points = between(
        curve(histories.draw_acceleration([coarse(tmp_path, film_lines={0.5: 2e-5})], ["a"], 4).axes[0])
    )
    assert len(points) == 12


def test_without_films_the_extremes_stand_in_their_own_periods_alone(tmp_path):
    made = histories.draw_acceleration(
        [coarse(tmp_path, without="film_thickness", extremes=FILMLESS)], ["a"], 4
    )
    np.testing.assert_allclose(between(curve(made.axes[0])), [(1.51, -700.0), (7.99, 900.0)], rtol=1e-9)
    assert ["not all drawn" in note for note in notes(made.axes[0])] == [True]


def test_a_coarse_series_without_extremes_says_so(tmp_path):
    """Those of Newmark's method: its samples are its steps."""
    made = histories.draw_acceleration([coarse(tmp_path, extremes=())], ["a"], 4)
    assert not len(between(curve(made.axes[0])))
    assert notes(made.axes[0]) == ["Series of too few samples; what lies between them is not known"]


@pytest.mark.parametrize("draw", [histories.draw_acceleration, histories.draw_film_and_force])
def test_an_overlay_names_the_run_whose_extremes_it_misses(tmp_path, result, draw):
    runs = [coarse(tmp_path, "missed", film_lines={0.5: 1e-3}), coarse(tmp_path, "drawn"), result]
    with style.house_style():
        made = draw(runs, ["missed", "drawn", "a"], 4)
    assert drawn.legend_words(made) == ["missed, too few samples", "drawn", "a"]
    assert "too few" not in histories.draw_acceleration([result], ["a"], 4).axes[0].get_title()
