"""Cylindrical stages of a model in REXS, the Reusable Engineering eXchange Standard of the FVA, as XML."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rattle.gear_data import GearDataError, Given, pair_name
from rattle.gear_data.values import value_of
from rattle.keys import key_table

ENDINGS = (".rexs", ".xml")
PACKED = (".rexsz", ".rexsj", ".json", ".zip")
# Units of REXS that are spelt otherwise here.
UNITS = {"C": "degC", "mum": "um", "none": "-", "mm^2 / N": "mm2/N"}
SHARED = {"normal_module": "normal_module", "helix_angle_reference_diameter": "helix_angle_deg"}
OIL = {
    "viscosity_at_40_degree_celsius": "viscosity_40_cst",
    "viscosity_at_100_degree_celsius": "viscosity_100_cst",
    "density_at_15_degree_celsius": "density_15",
}
BACKLASHES = ("minimum_normal_backlash", "maximum_normal_backlash")


@dataclass
class Component:
    """A component with its attributes as they stand, each with its unit."""

    number: str
    type: str
    name: str
    attributes: Mapping[str, tuple[str, str]] = field(default_factory=dict)

    def given(self, attribute: str, key: str, pair: str, path: Path, group: str = "gear") -> list[Given]:
        """The value of an attribute, if the component has it."""
        if attribute not in self.attributes:
            return []
        text, unit = self.attributes[attribute]
        words = f"{attribute} of {self.called}: {text} {'' if unit == 'none' else unit}".strip()
        try:
            value = value_of(text, UNITS.get(unit, unit), key_table()[group, key])
        except GearDataError as fault:
            raise GearDataError(f"{path}: {attribute} of {self.called}: {fault}.") from None
        return [Given(pair, group, key, value, f"{path}", words)]

    @property
    def called(self) -> str:
        return self.name or f"{self.type} {self.number}"


def read_rexs(path: Path, loose: Sequence[str] = ()) -> list[Given]:
    """The pairs of all cylindrical stages, gear_2 being loose unless gear_1 is among the names `loose`.

    Raises GearDataError for what is no such model, for internal gears, and where both gears of a stage
    differ in what they share.
    """
    components, relations = _model(path)
    stages = [roles for kind, roles in relations if kind == "stage" and roles.get("stage") in components]
    stages = [roles for roles in stages if components[roles["stage"]].type == "cylindrical_stage"]
    if not stages:
        raise GearDataError(f"{path} has no cylindrical stage.")
    gears = [components[roles[role]].called for roles in stages for role in ("gear_1", "gear_2")]
    for name in loose:
        if gears.count(name) != 1:
            raise GearDataError(f"{path} has {gears.count(name)} gears '{name}'; it has {', '.join(gears)}.")
    angles = {
        roles["gear"]: [components[roles[side]] for side in ("left", "right") if side in roles]
        for kind, roles in relations
        if kind == "flank" and "gear" in roles
    }
    names = [pair_name(components[roles["stage"]].called) for roles in stages]
    found: list[Given] = []
    for roles, pair in zip(stages, names, strict=True):
        if names.count(pair) > 1:
            pair = f"{pair}_{roles['stage']}"
        gears_of = [components[roles[role]] for role in ("gear_1", "gear_2")]
        if gears_of[0].called in loose:
            gears_of.reverse()
        found += _pair(components[roles["stage"]], gears_of, pair, path)
        flanks = [flank for gear in gears_of for flank in angles.get(gear.number, [])]
        found += _agreed(
            [flank.given("normal_pressure_angle", "pressure_angle_deg", pair, path) for flank in flanks]
        )
    oils = [one for one in components.values() if one.type == "lubricant"]
    if len(oils) == 1:
        for attribute, key in OIL.items():
            found += oils[0].given(attribute, key, "", path, "oil")
        if oils[0].attributes.get("basis", ("", ""))[0] == "mineral":
            found.append(Given("", "oil", "base", "mineral", f"{path}", "basis: mineral"))
    return found


def _pair(stage: Component, gears: Sequence[Component], pair: str, path: Path) -> list[Given]:
    """What a stage and its gears, the driving one first, say of a pair."""
    found = []
    for number, gear in enumerate(gears, 1):
        teeth = gear.given("number_of_teeth", f"teeth_{number}", pair, path)
        if gear.type != "cylindrical_gear" or any(one.number < 0.0 for one in teeth):
            raise GearDataError(f"{path}: {gear.called} of {pair} is an internal gear, which is not solved.")
        found += teeth
    for attribute, key in SHARED.items():
        found += _agreed([_positive(gear.given(attribute, key, pair, path)) for gear in gears])
    widths = stage.given("common_face_width", "face_width", pair, path)
    own = [one for gear in gears for one in gear.given("face_width", "face_width", pair, path)]
    if not widths and len(own) == len(gears):
        widths = [min(own, key=lambda one: one.number)]
    found += widths + stage.given("center_distance", "centre_distance", pair, path)
    tips = [gear.given("tip_diameter", f"tip_diameter_{at}", pair, path) for at, gear in enumerate(gears, 1)]
    found += [one for tip in tips for one in tip] if all(tips) else []
    ends = [one for name in BACKLASHES for one in stage.given(name, "backlash", pair, path)]
    if len(ends) == len(BACKLASHES):
        mean = float(f"{sum(one.number for one in ends) / 2.0:.15g}")
        words = "mean of " + " and ".join(one.words for one in ends)
        found.append(Given(pair, "gear", "backlash", mean, f"{path}", words))
    return found


def _positive(given: list[Given]) -> list[Given]:
    """Both hands of a helix are one angle here."""
    return [Given(one.pair, one.group, one.key, abs(one.number), one.place, one.words) for one in given]


def _agreed(given: Sequence[list[Given]]) -> list[Given]:
    """What several components say of one key, once."""
    flat = [one for several in given for one in several]
    for one in flat:
        if abs(one.number - flat[0].number) > 1e-9 * abs(flat[0].number):
            raise GearDataError(f"{one.place}: {flat[0].words}, but {one.words}; a pair shares it.")
    return flat[:1]


def _model(path: Path) -> tuple[dict[str, Component], list[tuple[str, dict[str, str]]]]:
    """Components by their id, and relations as type and id by role."""
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as fault:
        raise GearDataError(f"{path} is no XML ({fault}).") from None
    if root.tag != "model" or root.find("components") is None:
        raise GearDataError(f"{path} is no REXS model.")
    components = {}
    for node in root.iterfind("components/component"):
        attributes = {
            one.get("id", ""): (one.text.strip(), one.get("unit", "none"))
            for one in node.iterfind("attribute")
            if one.text and one.text.strip()
        }
        number = node.get("id", "")
        components[number] = Component(number, node.get("type", ""), node.get("name", ""), attributes)
    relations = []
    for node in root.iterfind("relations/relation"):
        roles = {one.get("role", ""): one.get("id", "") for one in node.iterfind("ref")}
        missing = [number for number in roles.values() if number not in components]
        if missing:
            raise GearDataError(f"{path}: a relation names component {missing[0]}, which there is not.")
        relations.append((node.get("type", ""), roles))
    return components, relations
