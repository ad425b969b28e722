"""Moving pictures: what they show is the series of the motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.patches import Rectangle
from PIL import Image
from script_calls import called_here

import rattle as package
from rattle.figures import animation, style

SHORT = {
    "solver.periods": 12,
    "solver.until": "periods",
    "solver.samples_per_period": 512,
    "spectrum.periods": 1,
}


@pytest.fixture(scope="module")
def motions(repository: Path, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("motions")
    package.run(repository / "input" / "loose_pair.nml", set=SHORT, folder=folder)
    package.run(repository / "input" / "idle.nml", folder=folder)
    return folder


@pytest.mark.long
def test_a_period_takes_ten_seconds(motions: Path, tmp_path: Path) -> None:
    code, said, complained = called_here(
        "plot.py", "motion", "--animate", motions / "loose_pair.rattle", cwd=tmp_path
    )
    assert code == 0, complained
    assert said == "motion_loose_pair.gif\n"
    with Image.open(tmp_path / "motion_loose_pair.gif") as pictures:
        periods = package.read(motions / "loose_pair.rattle").orbit_period or 1
        assert pictures.n_frames == 100 * periods and pictures.info["duration"] == 100
    code, _, complained = called_here(
        "plot.py", "motion", "--animate", motions / "loose_pair.rattle", cwd=tmp_path
    )
    assert code == 2 and "exists; --overwrite replaces it" in complained


@pytest.mark.parametrize(("name", "flanks"), (("loose_pair", 2), ("idle", 1)))
def test_the_tooth_stands_on_its_film(name: str, flanks: int, motions: Path) -> None:
    """The films are those of the series, and both fill what the tooth leaves of the gap."""
    result = package.read(motions / f"{name}.rattle")
    with style.house_style():
        figure, show = animation._picture(result, name, 1)
    colours = {"oil": animation.OIL, "tooth": animation.TOOTH, "steel": animation.STEEL}
    patches = {
        part: [p for p in figure.axes[0].patches if isinstance(p, Rectangle) and _is(p, colour)]
        for part, colour in colours.items()
    }
    (tooth,) = patches["tooth"]
    assert len(patches["oil"]) == len(patches["steel"]) == flanks
    rows = result.window(1, with_start=True)
    films = 1e6 * result.samples("film_thickness", rows)
    count = result.samples_per_period
    for moment in (0.0, 0.25, 0.5, 0.875):
        show(moment)
        film = films[round(moment * count)]
        assert tooth.get_y() == pytest.approx(film, rel=1e-6)
        assert patches["oil"][0].get_height() == pytest.approx(film, rel=1e-6)
        assert figure.axes[1].lines[-1].get_xdata()[0] == pytest.approx(moment * 1e3 / result.frequency)
        if flanks == 2:
            coast = patches["oil"][1]
            assert coast.get_y() == pytest.approx(film + tooth.get_height())
            assert coast.get_height() == pytest.approx(1e6 * result.value("contact", "backlash") - film)


def _is(patch: Rectangle, colour: str) -> bool:
    wanted = [int(colour[place : place + 2], 16) / 255.0 for place in (1, 3, 5)]
    return bool(np.allclose(patch.get_facecolor()[:3], wanted))


def test_moving_pictures_show_one_motion_each(motions: Path, tmp_path: Path) -> None:
    code, _, complained = called_here(
        "plot.py", "motion", "--animate", "--overlay", motions / "idle.rattle", cwd=tmp_path
    )
    assert code == 2 and "leave out --overlay" in complained
