"""A toy figure: load over film of a motion."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import scene
from run_touched import ToyError, Tree

INPUT = scene.scene_text(more="&output\n   columns = 'film_thickness', 'film_load'\n/\n")
MODULE = '''"""Load over film of a motion."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

from matplotlib.figure import Figure

import rattle
from rattle import command
from rattle.figures import style

DESCRIPTION = "Draw the load over the film of a motion as 'loop_NAME'."


def add_options(parser: ArgumentParser) -> None:
    parser.add_argument("result", type=Path, metavar="RESULT", help="NAME.rattle of a motion")


def run(options: Namespace) -> None:
    result = rattle.read(options.result)
    result.require_task("motion")
    with style.house_style():
        for path in style.save([(f"loop_{result.scene_name}", draw(result))], options):
            command.note(str(path))


def draw(result: rattle.Result) -> Figure:
    figure = Figure()
    axes = figure.subplots()
    axes.plot(result["film_thickness"] * 1e6, result["film_load"])
    axes.set(xlabel="film thickness [\\N{MICRO SIGN}m]", ylabel="load [N]")
    return figure
'''


def change(tree: Tree) -> None:
    tree.add("scripts/rattle/figures/loop.py", MODULE)
    command = '    "loop": "load over film of a motion",\n'
    tree.put("scripts/plot.py", '    "film-fit": ', command)


def look(folder: Path, scratch: Path) -> None:
    command = [sys.executable, scratch / "scripts/plot.py", "loop", "figure.rattle"]
    ended = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if ended.returncode or not (folder / "loop_figure.png").read_bytes().startswith(b"\x89PNG"):
        raise ToyError(f"plot.py ends with exit code {ended.returncode}: {ended.stderr}")
