"""Every key that may be varied, alone and in pairs: rows, values of sweeps and single scenes agree.

Which keys those are, and their values, the program says itself: here stand only inputs that use them. All
start from rest alone, since there are so many; test_coexisting_rows.py has the other starts.
"""

from __future__ import annotations

import itertools
import random
import re
import sys
from pathlib import Path

import f90nml
import pytest
from outcomes import summary_of

import rattle as package

sys.path.insert(0, str(Path(__file__).parents[1] / "stress"))

import gear_rows

OIL = """&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, density_15 = 870.0, temperature_celsius = 50.0
   pressure_viscosity = 1.8e-8, volume = 2e-3 /
"""
SHAFT = "&shaft speed_rpm = 800.0, table = 'run_up.csv' /\n"
REST = """&load force_scale = 0.9, force_mean = 0.1 /
&film law = 'iso-viscous', model = 'reynolds', initial_film = 2e-5, initial_velocity = 1e-4 /
&solver periods = 4, accuracy = 1e-6, samples_per_period = 512, starts = 1 /
&spectrum periods = 2 /
"""
GEAR = """&gear teeth_1 = 19, teeth_2 = 37, normal_module = 2.2e-3, pressure_angle_deg = 20.0
   helix_angle_deg = 28.0, face_width = 0.016, loose_inertia = 8.9e-4, backlash = 9e-5, tooth_stiffness = 14e9
   tooth_damping_ratio = 0.03
"""
COMPUTED = """   bearing_mean_diameter = 0.038, immersion_depth = 0.03, own_shaft_ratio = 0.4
   drag_scale = 0.8, synchroniser_cones = 2, synchroniser_diameter = 0.062, synchroniser_width = 0.008
   synchroniser_gap = 2e-4
"""
PLAIN = """&lubricant viscosity = 0.3, pressure_viscosity = 1.2e-8 /
&film law = '{law}', model = '{model}', initial_film = 2e-6, initial_velocity = 1e-4 /
&solver periods = 4, accuracy = 1e-6, samples_per_period = 512, starts = 1 /
&spectrum periods = 2 /
"""
FORCE = (
    "&load mass = 3.0, steady_force = 150.0, force_amplitude = 120.0, force_scale = 0.9, force_mean = 10.0,"
)
BASES = {
    "two soft flanks": "&contact radius = 0.0127, length = 0.01, backlash = 8e-6, stiffness = 1e9\n"
    " damping_ratio = 0.1 /\n"
    "&kinematics entrainment_speed = 1.905 /\n"
    + FORCE
    + " frequency = 600.0 /\n"
    + PLAIN.format(law="iso-viscous", model="reynolds"),
    "one hard flank": "&contact radius_1 = 0.025, radius_2 = 0.026, length = 0.01 /\n"
    "&kinematics surface_speed_1 = 1.5, surface_speed_2 = 2.3 /\n"
    + FORCE
    + " frequency = 600.0, gravity = 5.0 /\n"
    + PLAIN.format(law="piezo-viscous", model="published"),
    "rolling speed": "&contact radius = 0.0127, length = 0.01 /\n&kinematics rolling_speed = 3.8 /\n"
    + FORCE
    + " frequency = 600.0 /\n"
    + PLAIN.format(law="iso-viscous", model="published"),
    "computed drag": GEAR
    + COMPUTED
    + "   bearing_factor = 12.0, tip_diameter_1 = 0.0482, tip_diameter_2 = 0.0968 /\n"
    + SHAFT
    + OIL
    + REST,
    "plain bearing": GEAR
    + COMPUTED
    + "   bearing_width = 0.02, bearing_clearance = 3e-5, centre_distance = 0.070, contact_lines = 1.4 /\n"
    + SHAFT
    + OIL
    + REST,
    "drag of a table": GEAR
    + "   drag_table = 'drag.csv', drag_scale = 0.8, contact_position = 1e-4 /\n"
    + "&shaft speed_rpm = 800.0, orders = 2.0, 4.0, accelerations = 600.0, 100.0, phases = 0.0, 0.8 /\n"
    + OIL.replace(", volume = 2e-3", "")
    + REST,
    "measured cycle": GEAR
    + "   drag_torque = 0.1, contact_position = -2e-4, contact_lines = 1.3 /\n"
    + "&shaft speed_rpm = 800.0, signal = 'cycle.csv', signal_kind = 'angular_speed_rpm' /\n"
    + OIL.replace(", volume = 2e-3", "")
    + REST,
}
CYCLE = "angle,shaft\n" + "".join(
    f"{720.0 * i / 90!r},{800.0 + 20.0 * ((i * i) % 7 - 3) / 3.0!r}\n" for i in range(90)
)
TABLES = {
    "drag.csv": "speed_rpm,temperature_celsius,torque\n600,20,.16\n600,60,.05\n1000,20,.20\n1000,60,.07\n",
    "run_up.csv": "speed_rpm,acceleration_2,phase_2,acceleration_4,phase_4\n"
    "600,900,0,120,3\n1000,600,.2,100,-3\n",
    "cycle.csv": CYCLE,
}
# Tips and centres leave little folder; all else is varied by some per cent.
NARROW = ("gear.tip_diameter_1", "gear.tip_diameter_2", "gear.centre_distance", "gear.normal_module")
MOST_COLUMNS = 30
PAIRS = 100
# From these most of a gear pair follows.
SOURCES = {"shaft.speed_rpm", "oil.temperature_celsius", "gear.teeth_1"}
# What a sweep reports that follows from its value alone, however its motion began.
FOLLOWING = ("steady_film", "natural_frequency", "damping_ratio", "drag_torque", "inertia_ratio")


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return with_tables(tmp_path)


def with_tables(folder: Path) -> Path:
    for name, text in TABLES.items():
        (folder / name).write_text(text)
    return folder


@pytest.fixture(scope="module")
def values(run, tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, float]]:
    """Of each input the keys that a campaign may vary, with the values that they have there."""
    folder = with_tables(tmp_path_factory.mktemp("values"))
    return {base: values_of(run, folder, text) for base, text in BASES.items()}


def refusal(run, place: Path, text: str, key: str, value: float) -> str:
    """Why a campaign over an input may not vary a key; empty if it may."""
    campaign = f"&scene task = 'campaign' /\n&campaign vary = '{key}', values(:, 1) = {value!r} /\n"
    (place / "probe.nml").write_text(text + campaign)
    return run("--check", "probe.nml", cwd=place).stderr


def values_of(run, place: Path, text: str) -> dict[str, float]:
    """Keys of an input that a campaign may vary, with the values that they have there."""
    (place / "base.nml").write_text(text)
    resolved = run("--check", "base.nml", cwd=place)
    assert resolved.returncode == 0, resolved.stderr
    return {
        f"{group}.{key}": value
        for group, keys in f90nml.reads(resolved.stdout).items()
        for key, value in keys.items()
        if isinstance(value, int | float)
        and not isinstance(value, bool)
        and not refusal(run, place, text, f"{group}.{key}", value)
    }


def changed(key: str, value: float) -> float:
    if isinstance(value, int):
        # With one tooth more a pinion of given tip would have hardly any teeth above its pitch circle.
        return value - 1 if key == "gear.teeth_1" else value + 1
    return value * (1.002 if key in NARROW else 1.04) or 1e-4


def differences(
    rattle: Path, place: Path, text: str, values: dict, varied: list[tuple[str, ...]]
) -> list[str]:
    """What rows with some keys changed have different from single scenes; none of these is invalid."""
    keys = tuple(dict.fromkeys(itertools.chain(*varied)))
    rows = [tuple(changed(key, values[key]) if key in row else values[key] for key in keys) for row in varied]
    case = gear_rows.Case(text, "", keys, tuple(rows))
    found = list(gear_rows.faults_of(rattle, case, gear_rows.recordable(rattle), place))
    reported = package.read_campaign(place / "results" / "many.rattle")["status"]
    return found + [
        f"{row}: no valid scene" for row, status in zip(varied, reported, strict=True) if status == 9.0
    ]


@pytest.mark.long
@pytest.mark.parametrize("base", BASES)
def test_rows_with_one_key_changed(base: str, values, rattle: Path, place: Path) -> None:
    """Of keys that inputs share, the first of these; but what most follows from is varied in each."""
    before = itertools.takewhile(lambda name: name != base, BASES)
    seen = set(itertools.chain.from_iterable(values[name] for name in before)) - SOURCES
    varied = [(key,) for key in values[base] if key not in seen]
    assert varied and differences(rattle, place, BASES[base], values[base], varied) == []


@pytest.mark.long
@pytest.mark.parametrize("base", BASES)
def test_rows_with_two_keys_changed(base: str, values, rattle: Path, place: Path) -> None:
    """And with one, in all inputs that have it."""
    single = [(key,) for key in values[base]]
    for first in range(0, len(single), MOST_COLUMNS):
        assert (
            differences(rattle, place, BASES[base], values[base], single[first : first + MOST_COLUMNS]) == []
        )
    pairs = list(itertools.combinations(values[base], 2))
    for pair in random.Random(base).sample(pairs, PAIRS):
        assert differences(rattle, place, BASES[base], values[base], [pair]) == [], pair


def test_no_key_is_left_out(values, run, rattle: Path, place: Path) -> None:
    """Every number of the key table that may be varied at all is varied above."""
    varied = {key for keys in values.values() for key in keys}
    for key in sorted(set(gear_rows.numeric_keys(rattle)) - varied):
        assert "it cannot be varied" in refusal(run, place, BASES["rolling speed"], key, 1), key


@pytest.mark.parametrize("base", BASES)
def test_what_follows_from_the_values_of_sweeps(base: str, values, run, place: Path) -> None:
    (line,) = re.findall(r"^\| `key` \|.*one of ('.*?) \|", run("--keys", cwd=place).stdout, re.M)
    swept = re.findall(r"'(\w+)'", line)
    keys = [key for key in values[base] if key.split(".")[1] in swept]
    assert keys
    # What follows asks for no more than a calm motion.
    calm = BASES[base].replace("force_scale = 0.9", "force_scale = 0.05")
    held = {**values[base], "load.force_scale": 0.05}
    (place / "one.nml").write_text(calm)
    for key in keys:
        first, name = held[key], key.split(".")[1]
        last = changed(key, first)
        sweep = f"&sweep key = '{name}', first = {first!r}, last = {last!r}, count = 2, turn = F /\n"
        (place / "way.nml").write_text(calm.replace(", starts = 1", "") + "&scene task = 'sweep' /\n" + sweep)
        ended = run("--overwrite", "way.nml", cwd=place)
        if "the input does not use" in ended.stderr:  # that of &contact, which follows from &gear
            continue
        assert ended.returncode == 0, ended.stderr
        rows = package.read(place / "results" / "way.rattle")
        ended = run("--overwrite", "--set", f"{key}={last!r}", "one.nml", cwd=place)
        assert ended.returncode == 0, ended.stderr
        alone = summary_of(place / "results" / "one.summary.nml")
        reported = [quantity for quantity in FOLLOWING if quantity in rows]
        # What is unknown is 0 in a sweep.
        assert {quantity: float(rows[quantity][1]) for quantity in reported} == {
            quantity: alone.get(quantity, 0.0) for quantity in reported
        }, key
