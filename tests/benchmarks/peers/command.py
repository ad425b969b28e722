"""A contender that is a command.

    COMMAND SCENE_FILE ACCURACY

SCENE_FILE is the text of scenes.scene_text: one `key value` a line, the scene in SI units (radius ...
initial_film) and in scaled form (acceleration_scale a, squeeze_scale c, force_ratio q, pressure_scale B0,
steady_load). ACCURACY is the relative accuracy of the film that is asked for. The command prints, one
number a line,

    the CPU seconds of solving this one scene, without reading and printing,
    then y = h/h0 at tau = 190 + k/64, k = 1 ... 640.

It repeats the solution as often as its clock needs. A program that solves several scenes at once fills its
lanes with copies of this scene and divides the time by their number. A program that stops once the motion
repeats prints the values its periodic motion has in the last ten periods. A status other than 0 is a scene
not solved. With the one argument --version the command prints its version.
"""

import functools
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import scenes

_folder = tempfile.TemporaryDirectory(prefix="bench_scenes_")


@functools.cache
def scene_file(scene: scenes.Scene) -> str:
    """Path of the scene's file, written on first use."""
    path = Path(_folder.name) / f"{scene.name}.txt"
    path.write_text(scenes.scene_text(scene))
    return str(path)


def prepare(
    words: list[str], scene: scenes.Scene, tolerance: float, *more: str
) -> Callable[[], tuple[np.ndarray, float]]:
    """The function returned runs the command once and gives the film and the CPU seconds it printed."""
    call = [*words, scene_file(scene), f"{tolerance:.3e}", *more]

    def solve() -> tuple[np.ndarray, float]:
        run = subprocess.run(call, capture_output=True, text=True)
        values = run.stdout.split()
        if run.returncode != 0 or len(values) != scenes.SAMPLE_COUNT + 1:
            raise RuntimeError(f"status {run.returncode}, {len(values)} numbers. {run.stderr.strip()}")
        return np.array(values[1:], dtype=float), float(values[0])

    return solve
