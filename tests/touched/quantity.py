"""A toy quantity: how far the acceleration swings."""

from __future__ import annotations

from math import isclose
from pathlib import Path

import scene
from run_touched import ToyError, Tree

INPUT = scene.scene_text()
TABLE, VALUES = "fsrc/scene/quantities.f90", "fsrc/judgement/judged_scene.f90"
NAME = "quantity_acceleration_swing, &\n         "
ROW = """      quantity_t(quantity_acceleration_swing, 'acceleration_swing', 'm/s2', a_number, part_window, &
         needs_acceleration_range, 'summary sweep campaign', &
         'Largest acceleration of the window less the smallest.'), &
"""
CASE = """         case (quantity_acceleration_swing)
            value = highest(seen_acceleration)%value - lowest(seen_acceleration)%value
"""


def change(tree: Tree) -> None:
    tree.put(TABLE, "quantity_acceleration_rms, quantity_gear_acceleration_rms,", NAME)
    tree.put(TABLE, "      quantity_t(quantity_acceleration_rms,", ROW)
    tree.put(VALUES, "         case (quantity_load_minimum)\n", CASE)


def look(folder: Path, scratch: Path) -> None:
    reported = scene.read_summary(folder / "quantity.summary.nml")
    swing = reported["acceleration_maximum"] - reported["acceleration_minimum"]
    if not isclose(reported["acceleration_swing"], swing, rel_tol=1e-9):
        raise ToyError(f"the summary tells {reported['acceleration_swing']}, not {swing}")
