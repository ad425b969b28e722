"""What a run writes: series, summary, and the same bytes from the same input."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

from rattle import read


def test_series_has_every_step_and_the_start(solved) -> None:
    result = read(solved() / "scene.rattle")
    assert result.closed
    assert list(result.columns) == ["time", "applied_force", "film_thickness", "acceleration"]
    assert result.row_count == 3 * 32 + 1
    steps = np.arange(97)
    np.testing.assert_allclose(result["time"], steps / (600.0 * 32), rtol=1e-15)
    # Eq. (34): F = Q + F0 cos(2 pi f t).
    expected = 199.2 + 205.7 * np.cos(2 * np.pi * steps / 32)
    np.testing.assert_allclose(result["applied_force"], expected, rtol=1e-13)


def test_columns_in_the_order_of_the_input(solved) -> None:
    names = ["film_load", "acceleration", "squeeze_velocity", "time", "film_thickness", "applied_force"]
    columns = ", ".join(f"'{name}'" for name in names)
    result = read(solved("some", output={"columns": columns}) / "some.rattle")
    assert list(result.columns) == names
    units = ["N", "m/s2", "m/s", "s", "m", "N"]
    assert [result.units[name] for name in names] == units
    # Eq. (1): m z'' = W - F - m g.
    np.testing.assert_allclose(
        result["film_load"], 3.0 * (result["acceleration"] + 9.80665) + result["applied_force"], rtol=1e-13
    )
    everything = read(solved("default") / "default.rattle")
    for name in everything.columns:
        np.testing.assert_array_equal(result[name], everything[name])


@pytest.mark.parametrize("stride", [2, 5, 7, 32, 33, 40, 96, 97, 1000])
def test_stride_takes_every_nth_row(stride: int, solved) -> None:
    whole = read(solved("whole") / "whole.rattle")
    thin = read(solved("thin", output={"stride": str(stride)}) / "thin.rattle")
    assert thin.closed
    for name in whole.columns:
        np.testing.assert_array_equal(thin[name], whole[name][::stride])


def test_scene_without_a_series(solved) -> None:
    folder = solved(output={"series": ".false."})
    assert sorted(path.name for path in folder.iterdir()) == ["scene.log", "scene.state", "scene.summary.nml"]
    assert summary_of(folder / "scene.summary.nml")["rattle_class"] in ("idle", "creep", "quiet", "irregular")


def test_series_does_not_change_the_summary(solved) -> None:
    def steady_part(path: Path) -> str:
        return re.sub(r"wall_seconds.*|name = .*|checksum .*", "", path.read_text())

    first = steady_part(solved("a") / "a.summary.nml")
    assert first == steady_part(solved("b", output={"series": "f"}) / "b.summary.nml")


@pytest.mark.parametrize("law", ["iso-viscous", "piezo-viscous"])
def test_same_input_gives_the_same_bytes(law: str, run, scene_text, tmp_path: Path) -> None:
    """In other folders, under another name of the input file, with other places, on repeated runs."""
    text = scene_text(film={"law": f"'{law}'"}, scene={"name": "'same'"}, solver={"steps_per_period": "256"})
    results = []
    for folder in ("a", "b/c/d"):
        here = tmp_path / folder
        here.mkdir(parents=True)
        (here / f"{folder[-1]}.nml").write_text(text)
        for output in ("first", "second"):
            arguments = [f"{folder[-1]}.nml", "--output", output, "--quiet", "--overwrite"]
            assert run(*arguments, cwd=here).returncode == 0
            results.append((here / output / "same.rattle").read_bytes())
    assert len(results[0]) > 3 * 256 * 32
    assert all(result == results[0] for result in results[1:])


def test_result_is_an_input_of_itself(run, solved, tmp_path: Path) -> None:
    """The resolved input in the header, fed back, gives the same file."""
    folder = solved(film={"law": "'piezo-viscous'"}, output={"stride": "3"})
    text = read(folder / "scene.rattle").input_text
    assert run("-", "--output", "again", cwd=tmp_path, stdin=text).returncode == 0
    assert (tmp_path / "again" / "scene.rattle").read_bytes() == (folder / "scene.rattle").read_bytes()


def test_summary_of_a_complete_run(solved) -> None:
    summary = summary_of(solved() / "scene.summary.nml")
    assert summary["status"] == "complete"
    assert summary["status_time"] == pytest.approx(3 / 600.0)
    assert summary["name"] == "scene"
    assert summary["steps"] == 96
    assert summary["evaluations"] >= 96
    assert summary["iterations_per_step"] == pytest.approx(summary["evaluations"] / 96)
    assert summary["wall_seconds"] > 0
    assert summary["window_periods"] == 2
    assert summary["film_minimum"] < summary["steady_film"] < summary["film_maximum"]
    assert isinstance(summary["law_contradicted"], bool)


def test_extremes_are_those_of_the_window(solved) -> None:
    folder = solved(solver={"periods": "9"})
    summary = summary_of(folder / "scene.summary.nml")
    result = read(folder / "scene.rattle")
    window = slice(7 * 32 + 1, None)
    assert summary["film_minimum"] == result["film_thickness"][window].min()
    assert summary["film_maximum"] == result["film_thickness"][window].max()
    assert summary["acceleration_minimum"] == result["acceleration"][window].min()
    assert summary["acceleration_maximum"] == result["acceleration"][window].max()
