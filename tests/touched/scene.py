"""The scene of the toys, and how what comes of it is read."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import f90nml
from run_touched import Tree

MASS, STEADY_FORCE, GRAVITY = 3.0, 199.2, 9.80665
# Coefficient of 1/h in (23) [N m]
ROLLING = 2.8 * 0.01 * 1.905 * 0.3 * 0.0127


def scene_text(law: str = "iso-viscous", more: str = "") -> str:
    """The canonical scene under a tenth of its static load."""
    return f"""&contact
   radius = 0.0127
   length = 0.01
/
&lubricant
   viscosity = 0.3
   pressure_viscosity = 2.0e-8
/
&kinematics
   entrainment_speed = 1.905
/
&load
   mass = {MASS}
   steady_force = {STEADY_FORCE}
   force_amplitude = 20.0
   frequency = 600.0
/
&film
   law = '{law}'
/
&solver
   periods = 40
/
{more}
"""


def add_law(tree: Tree, code: str, word: str) -> None:
    """A further law in the list of codes and words of `scene_types.f90`."""
    types = "fsrc/scene/scene_types.f90"
    words = re.search(r"words_of_laws = '(.+)'\n", tree.text(types))
    last = re.search(
        r"(law_\w+ = (\d+))\n   character\(\*\), parameter, public :: words_of_laws", tree.text(types)
    )
    tree.change(types, f"{last[1]}\n", f"{last[1]}, &\n      {code} = {int(last[2]) + 1}\n")
    tree.change(types, f"'{words[1]}'", f"'{words[1]} {word}'")


def read_summary(path: Path) -> dict[str, Any]:
    """All groups of a summary in one."""
    return {name: value for group in f90nml.read(path).values() for name, value in group.items()}


def read_table(path: Path, scratch: Path) -> dict[str, Any]:
    """Columns of a result or campaign, read by the package of the scratch copy."""
    sys.path.insert(0, str(scratch / "scripts"))
    import rattle

    result = rattle.read(path)
    return {name: result[name].tolist() for name in result.names}
