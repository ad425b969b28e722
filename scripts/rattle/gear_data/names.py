"""What drawings, data sheets and bench reports call the keys of &gear, &shaft and &oil."""

from __future__ import annotations

import difflib
import re
from functools import cache

from rattle.gear_data import GROUPS
from rattle.keys import key_table

# Besides the names of the keys themselves. Order of words, case and what SILENT lists do not matter.
PHRASES = {
    "gear.teeth_1": ("teeth driving", "teeth, gear 1", "z1"),
    "gear.teeth_2": ("teeth loose", "teeth, gear 2", "z2"),
    "gear.normal_module": ("module", "normal module", "mn"),
    "gear.pressure_angle_deg": ("pressure angle", "normal pressure angle"),
    "gear.helix_angle_deg": ("helix angle", "helix angle reference circle"),
    "gear.face_width": ("common face width", "facewidth"),
    "gear.centre_distance": ("axis distance", "working centre distance"),
    "gear.tip_diameter_1": ("tip diameter driving", "outside diameter driving", "outside diameter 1", "da1"),
    "gear.tip_diameter_2": ("tip diameter loose", "outside diameter loose", "outside diameter 2", "da2"),
    "gear.loose_inertia": ("inertia", "inertia loose", "inertia 2"),
    "gear.drag_torque": ("drag torque loose", "drag torque 2"),
    "gear.bearing_mean_diameter": ("needle bearing mean diameter",),
    "gear.bearing_clearance": ("bearing radial clearance",),
    "gear.synchroniser_cones": ("cones", "synchroniser cones"),
    "gear.synchroniser_diameter": ("cone mean diameter", "synchroniser mean diameter", "cone diameter"),
    "gear.synchroniser_width": ("cone width",),
    "gear.synchroniser_gap": ("cone gap", "cone clearance"),
    "gear.backlash": ("normal backlash", "backlash along normal"),
    "shaft.speed_rpm": ("engine speed", "shaft speed", "speed"),
    "shaft.orders": ("engine orders",),
    "shaft.accelerations": ("angular accelerations", "angular acceleration amplitudes"),
    "oil.viscosity_40_cst": ("viscosity 40", "oil viscosity 40", "v40"),
    "oil.viscosity_100_cst": ("viscosity 100", "oil viscosity 100", "v100"),
    "oil.density_15": ("oil density 15",),
    "oil.temperature_celsius": ("oil temperature",),
    "oil.base": ("base oil", "kind base oil"),
    "oil.pressure_viscosity": ("pressure viscosity coefficient",),
    "oil.volume": ("oil volume",),
}
SILENT = frozenset(("of", "the", "in", "at", "on", "for", "gear", "number", "mass", "moment", "kinematic"))
SILENT |= {"degc", "celsius", "c", "deg", "rpm", "cst"}
SAME = {"center": "centre", "synchronizer": "synchroniser", "diametre": "diameter", "tooth": "teeth"}
SAME |= {"order": "orders", "acceleration": "accelerations", "phase": "phases"}
# Of a name alone it is not known where it is measured.
CIRCUMFERENTIAL = (
    "circumferential backlash",
    "transverse backlash",
    "circumferential backlash reference circle",
)
BACKLASH = "say 'normal backlash', along the normal of the flanks, or 'circumferential backlash'"
# Files and words have no unit; signals of an engine have a command of their own, recording.py.
LEFT_OUT = re.compile(r"signal|^name$|^cycle_revolutions$")


def words_of(name: str) -> frozenset[str]:
    """The words of a name that tell what it is."""
    letters = re.sub(r"[^a-z0-9]+", " ", name.lower()).split()
    return frozenset(SAME.get(word, word) for word in letters if word not in SILENT)


@cache
def known() -> dict[frozenset[str], tuple[str, str]]:
    """Group and key by the words of each name."""
    found = {}
    for group, key in key_table():
        if group in GROUPS and not LEFT_OUT.search(key):
            for phrase in (key, *PHRASES.get(f"{group}.{key}", ())):
                found[words_of(phrase)] = (group, key)
    del found[words_of("backlash")]
    return found


def key_of(name: str) -> tuple[str, str] | None:
    """Group and key that a name means; None where it means none."""
    words = words_of(name)
    return ("gear", "backlash") if is_circumferential(name) else known().get(words)


def is_circumferential(name: str) -> bool:
    return words_of(name) in map(words_of, CIRCUMFERENTIAL)


def advice(name: str) -> str:
    """How a name that is not understood may be meant."""
    if "backlash" in words_of(name):
        return BACKLASH
    phrases = {" ".join(key.split("_")): f"{group}.{key}" for group, key in known().values()}
    phrases |= {phrase: key for key, several in PHRASES.items() for phrase in several}
    near = difflib.get_close_matches(" ".join(re.findall(r"[a-z0-9]+", name.lower())), phrases, 1, 0.0)
    return f"the nearest known name is '{near[0]}' ({phrases[near[0]]})"
