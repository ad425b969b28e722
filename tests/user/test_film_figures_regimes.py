"""The regime map: scenes placed on it, and those that have no place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from figure_files import stems
from result_writer import write_motion, write_result
from script_calls import call_script

import rattle
from rattle.figures import regime_map

ALPHA = 2.0e-8

MOTION_INPUT = """&scene
   name = '{name}'
   task = '{task}'
/
&contact
   radius = 0.0127
   length = 0.01
   young_modulus = 2.0566E11
   poisson_ratio = 0.3
/
&lubricant
   viscosity = 0.3
   pressure_viscosity = {alpha!r}
/
&kinematics
   {speed}
/
&load
   mass = 3.0
   steady_force = {force!r}
   force_amplitude = 205.7
   gravity = 9.80665
/
"""


def write_scene(
    path: Path,
    *,
    force: float = 199.2,
    alpha: float = ALPHA,
    speed: str = "entrainment_speed = 1.905",
    task: str = "motion",
) -> Path:
    """A motion of which only the resolved input matters."""
    text = MOTION_INPUT.format(name=path.stem, task=task, alpha=alpha, speed=speed, force=force)
    return write_result(path, [("time", "s")], [[0.0]], input_text=text)


def test_scenes_are_placed_on_the_map(tmp_path):
    idle = write_scene(tmp_path / "idle.rattle")
    (tmp_path / "idle.summary.nml").write_text("&summary\n   name = 'idle'\n   steady_film = 8.889E-7\n/\n")
    light = write_scene(tmp_path / "light.rattle", force=-20.0, speed="rolling_speed = 3.81")
    done = call_script(
        "plot.py",
        "regime-map",
        tmp_path / "idle.summary.nml",
        light,
        "--output",
        tmp_path / "figures",
        "--markdown",
    )
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == ["regime_map"]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines()]
    assert cells[2] == [
        "idle",
        "228.6",
        "7.2",
        "0.564",
        "piezo-viscous elastic",
        "2.361",
        "3.405",
        "yes",
        "0.8889",
    ]
    assert cells[3][0] == "light" and cells[3][4] == "iso-viscous rigid" and cells[3][7:] == ["no", "-"]
    assert idle.exists()


def test_the_bare_map_is_drawn(tmp_path):
    done = call_script("plot.py", "regime-map", "--output", tmp_path)
    assert done.returncode == 0 and done.stdout == ""
    assert stems(tmp_path) == ["regime_map"]


def test_grubin_film_of_the_map_is_that_of_the_scene(tmp_path):
    result = rattle.read(
        write_scene(tmp_path / "a.rattle", speed="surface_speed_1 = 4.0\n surface_speed_2 = 1.0")
    )
    scene = regime_map.new_scene("a", result.input, {})
    assert scene.speed == 2.5
    g_v, g_e = scene.groups(scene.load)
    parameter = regime_map.grubin_parameter(scene.material, np.array(g_v), np.array(g_e))
    assert parameter * scene.film_per_parameter() == pytest.approx(scene.grubin_film(), rel=1e-12)


def test_scenes_of_different_oil_are_reported(tmp_path):
    paths = [write_scene(tmp_path / "a.rattle"), write_scene(tmp_path / "b.rattle", alpha=1e-8)]
    done = call_script("plot.py", "regime-map", *paths, "--output", tmp_path)
    assert done.returncode == 0
    assert "The scenes differ in alpha or E*; the hatched part is that of a." in done.stderr


def test_scenes_without_a_place_are_refused(tmp_path):
    (tmp_path / "alone.summary.nml").write_text("&summary\n   name = 'alone'\n/\n")
    alone = call_script("plot.py", "regime-map", tmp_path / "alone.summary.nml", "--output", tmp_path)
    film_task = call_script(
        "plot.py", "regime-map", write_scene(tmp_path / "f.rattle", task="film"), "--output", tmp_path
    )
    bare = call_script(
        "plot.py", "regime-map", write_motion(tmp_path / "m.rattle", lines={1.0: 1.0}), "--output", tmp_path
    )
    many = call_script(
        "plot.py", "regime-map", *[write_scene(tmp_path / "s.rattle")] * 8, "--output", tmp_path
    )
    for done, sentence in (
        (alone, "alone.rattle, which would, does not exist."),
        (film_task, "is not a motion but the result of task = 'film'; 'plot.py film' draws it."),
        (bare, "has no number as contact."),
        (many, "The map shows 7 scenes at most; 8 were given."),
    ):
        assert done.returncode == 2
        assert done.stderr.count("\n") == 1
        assert sentence in done.stderr
