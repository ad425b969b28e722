"""The curves of time series: the extreme rows are part of them, the spectra take the other rows alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from result_writer import write_motion

import rattle
from rattle.figures import acceleration, film_and_force
from rattle.figures.spectra import column_spectrum

# Behind the 20th period, in the last of the periods drawn, and long before; the period lasts 2 ms.
EXTREMES = [[0.005, 1.0, 2e-6, 500.0], [0.03351, 2.0, 9e-6, -700.0], [0.03999, 3.0, 1e-9, 900.0]]


@pytest.fixture
def result(tmp_path: Path) -> rattle.Result:
    return rattle.read(write_motion(tmp_path / "a.rattle", lines={1.0: 5.0}, extremes=EXTREMES))


def curve(axes) -> np.ndarray:
    """The points of the curve with the most of them."""
    return max((line.get_xydata() for line in axes.lines), key=len)


@pytest.mark.parametrize(
    ("draw", "place", "scale", "column"),
    [(acceleration.draw, 0, 1.0, 3), (film_and_force.draw, 0, 1e6, 2), (film_and_force.draw, 1, 1.0, 1)],
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
