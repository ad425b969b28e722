"""A toy key that campaigns may vary: the angle by which the line of action is tilted from the vertical."""

from __future__ import annotations

from math import cos, isclose, radians
from pathlib import Path

import scene
from run_touched import ToyError, Tree

VARIED = """&scene
   task = 'campaign'
/
&campaign
   vary(1) = 'load.tilt_deg'
   values(:, 1) = 0.0, 60.0
   record = 'steady_film'
/
"""
INPUT = scene.scene_text(more=VARIED)
TYPES, TABLE = "fsrc/scene/scene_types.f90", "fsrc/scene/key_table.f90"
ROW = """      key_t('load', 'tilt_deg', real_kind, 'deg', '0.0', &
            range_t(-90.0_dp, .false., 90.0_dp, .false.), '', of_motions, &
            'Angle between line of action and vertical; m g cos(tilt) presses the tooth down.'), &
"""
FIELD = """      !> Angle between the line of action and the vertical [degrees]
      real(dp) :: tilt_deg = 0.0_dp
"""
CASE = "         case ('load.tilt_deg')\n            excitation%tilt_deg = value\n"
SHARE = """   !> Acceleration of free fall along the line of action [m/s2].
   elemental real(dp) function fall_along(self)
      class(excitation_t), intent(in) :: self

      fall_along = self%gravity*cos(self%tilt_deg*acos(-1.0_dp)/180.0_dp)
   end function fall_along

"""


def change(tree: Tree) -> None:
    tree.put(TABLE, "      key_t('load', 'gravity', ", ROW)
    tree.put(TYPES, "   contains\n      procedure :: weight\n", FIELD)
    tree.put(TYPES, "         case ('load.gravity')\n", CASE)
    tree.put(TYPES, "   !> Weight m g of the tooth pair [N].\n", SHARE)
    tree.change(TYPES, "weight = self%mass*self%gravity\n", "weight = self%mass*fall_along(self)\n")
    tree.change(TYPES, "fma(self%mass, self%gravity, ", "fma(self%mass, fall_along(self), ")


def look(folder: Path, scratch: Path) -> None:
    """The steady film of each row carries what is left of the weight."""
    rows = scene.read_table(folder / "key.rattle", scratch)
    for tilt, film in zip(rows["load.tilt_deg"], rows["steady_film"], strict=True):
        load = scene.STEADY_FORCE + scene.MASS * scene.GRAVITY * cos(radians(tilt))
        expected = scene.ROLLING / load
        if not isclose(film, expected, rel_tol=1e-9):
            raise ToyError(f"tilted by {tilt} degrees the steady film is {film}, not {expected}")
