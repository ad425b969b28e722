"""From a drawing and a data sheet to a motion: &gear, &shaft and &oil against independent numbers."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from outcomes import assert_faults, summary_of

import rattle as package

PAIR = """
&gear
   teeth_1 = 11, teeth_2 = 38, normal_module = 2.5e-3, helix_angle_deg = 28.96, face_width = 0.016
   loose_inertia = 1.715e-3, drag_torque = 0.10, backlash = 1e-4
/
&shaft speed_rpm = 800.0, orders = 2.0, accelerations = 600.0 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 40.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver periods = 12, accuracy = 1e-6 /
&spectrum periods = 2 /
"""
SECOND = {
    "teeth_1": "33",
    "teeth_2": "32",
    "normal_module": "1.85e-3",
    "helix_angle_deg": "30.8",
    "loose_inertia": "2.8e-4",
    "drag_torque": "0.05",
    "centre_distance": "0.0702",
    "contact_position": "1e-3",
    "contact_lines": "1.5",
}
OILS = {
    -20: (2.69145831, 2.47334058e-8),
    0: (0.473715991, 2.20584281e-8),
    20: (0.131045343, 1.97484482e-8),
    80: (0.0126951718, 1.4388366e-8),
    120: (5.18465014e-3, 1.172389e-8),
}


@pytest.fixture
def check(run, tmp_path: Path):
    def call(text: str, *options: str):
        (tmp_path / "pair.nml").write_text(text)
        settings = [word for option in options for word in ("--set", option)]
        return run("--check", *settings, "pair.nml", cwd=tmp_path)

    return call


def derived(ended) -> dict[str, float]:
    """What follows, of each key the first number."""
    assert ended.returncode == 0, ended.stderr
    return {
        key: float(value) for key, value in re.findall(r"^! derived: (\S+) = ([-+.\dE]+)", ended.stdout, re.M)
    }


def test_check_tells_the_contact_of_a_pair(check) -> None:
    reported = derived(check(PAIR))
    expected = {
        "gear.base_radius_1": 0.01450969563,
        "gear.base_radius_2": 0.05012440307,
        "gear.centre_distance": 0.07000336377,
        "gear.working_pressure_angle": 22.5866253,
        "gear.base_helix_angle": 27.06481427,
        "contact.radius": 0.005256471216,
        "contact.length": 0.01796758757,
        "kinematics.entrainment_speed": 0.5056564966,
        "load.mass": 0.8608059738,
        "load.steady_force": 2.240374258,
        "load.force_amplitudes": 6.673367428,
        "load.frequency": 800.0 / 60.0 * 2.0,
        "load.gravity": 0.0,
        "contact.backlash": 1e-4,
        "lubricant.viscosity": 0.049445,
        "lubricant.pressure_viscosity": 1.7733532e-8,
    }
    for key, value in expected.items():
        assert reported[key] == pytest.approx(
            value, rel=2e-9 if key != "lubricant.pressure_viscosity" else 3e-8
        ), key


def test_the_summary_tells_what_follows_as_check_does(check, run, tmp_path: Path) -> None:
    """Number by number, by the names of the keys."""
    orders = "orders = 2.0, 3.5, accelerations = 600.0, 150.0, phases = 0.4, -1.1"
    text = PAIR.replace("orders = 2.0, accelerations = 600.0", orders)
    checked = check(text.replace("backlash = 1e-4", "backlash = 1e-4, tooth_stiffness = 14e9"))
    assert run("pair.nml", cwd=tmp_path).returncode == 0
    reported = summary_of(tmp_path / "results" / "pair.summary.nml")
    found = re.findall(
        r"^! derived: (?:contact|kinematics|load|lubricant)\.(\S+) = ((?:[-+.\dE]+(?:, )?)+)",
        checked.stdout,
        re.M,
    )
    assert len(found) > 10
    for key, numbers in found:
        if key != "gravity":
            assert np.atleast_1d(reported[key]).tolist() == [
                float(number) for number in numbers.split(", ")
            ], key


def test_check_tells_a_shifted_pair_off_the_pitch_point(check) -> None:
    changes = [f"gear.{key}={value}" for key, value in SECOND.items()]
    reported = derived(check(PAIR, *changes))
    expected = {
        "gear.working_pressure_angle": 23.35107601,
        "gear.base_helix_angle": 28.76138053,
        "contact.radius": 0.007874713445,
        "kinematics.entrainment_speed": 1.182142875,
        "contact.length": 0.02737753343,
        "load.mass": 0.3619119942,
        "load.steady_force": 1.797597589,
        "load.force_amplitudes": 6.228675645,
    }
    for key, value in expected.items():
        assert reported[key] == pytest.approx(value, rel=1e-9), key


@pytest.mark.parametrize("temperature", OILS)
def test_oil_at_its_temperature(temperature: int, check) -> None:
    reported = derived(check(PAIR, f"oil.temperature_celsius={temperature}"))
    viscosity, pressure_viscosity = OILS[temperature]
    assert reported["lubricant.viscosity"] == pytest.approx(viscosity, rel=5e-9)
    assert reported["lubricant.pressure_viscosity"] == pytest.approx(pressure_viscosity, rel=3e-9)


def test_kind_of_oil_and_its_own_coefficient(check) -> None:
    for options, expected in (
        (["oil.base=pao"], 1.25084897e-8),
        (["oil.base=polyglycol"], 8.70226199e-9),
        (["oil.pressure_viscosity=2e-8"], 2e-8),
    ):
        assert derived(check(PAIR, *options))["lubricant.pressure_viscosity"] == pytest.approx(
            expected, rel=3e-9
        )


def test_stiffness_of_the_teeth_is_that_of_their_width(check) -> None:
    reported = derived(check(PAIR.replace("backlash = 1e-4", "tooth_stiffness = 1.4e10")))
    assert reported["contact.stiffness"] == pytest.approx(1.4e10 * 0.016)


def test_orders_of_a_four_stroke_engine_share_a_base(check) -> None:
    ended = check(PAIR, "shaft.orders=2, 0.5, 1.5", "shaft.accelerations=600, 60, 6")
    assert derived(ended)["load.frequency"] == pytest.approx(0.5 * 800.0 / 60.0)
    assert "! derived: load.force_orders = 4.0, 1.0, 3.0" in ended.stdout
    # A shorter list says so.
    ended = check(PAIR, "shaft.orders=2, 0.5")
    assert_faults(
        ended.stderr.splitlines(),
        "pair.nml",
        ["6: &shaft accelerations: as many values as orders has (2) are needed"],
    )


def test_a_gear_with_the_contact_of_a_known_motion(run, tmp_path: Path) -> None:
    """The contact, force and backlash of the reference for two flanks, from equal spur gears."""
    base_radius = 0.015 / math.tan(math.radians(20.0))
    speed = 1.07 / 0.015 * 30.0 / math.pi
    order = 26.7 * 60.0 / speed
    mass = 0.45
    (tmp_path / "known.nml").write_text(f"""
&gear
   teeth_1 = 30, teeth_2 = 30, normal_module = {2 * base_radius / 30 / math.cos(math.radians(20.0))!r}
   face_width = 0.02, loose_inertia = {mass * base_radius**2!r}, drag_torque = {5.0 * base_radius!r}
   backlash = 1e-4, tooth_stiffness = 0.0
/
&shaft
   speed_rpm = {speed!r}, orders = {order!r}, {2 * order!r}, {3 * order!r}, phases = 0.0, 0.5, 1.1
   accelerations = {7.9 / mass / base_radius!r}, {2.0 / mass / base_radius!r}, {0.8 / mass / base_radius!r}
/
&lubricant viscosity = 0.05, pressure_viscosity = 2e-8 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver until = 'periods', periods = 40, samples_per_period = 2048 /
&spectrum periods = 4 /
""")
    ended = run("known.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    reported = summary_of(tmp_path / "results" / "known.summary.nml")
    assert (reported["radius"], reported["length"]) == pytest.approx((7.5e-3, 0.02))
    assert (reported["mass"], reported["steady_force"], reported["frequency"]) == pytest.approx(
        (0.45, 5.0, 26.7)
    )
    assert reported["force_amplitudes"] == pytest.approx([7.9, 2.0, 0.8])
    assert reported["harmonics"][:8] == pytest.approx(
        [1.0544934, 2.0593625, 1.5235086, 0.8887504, 1.8208022, 2.0759337, 1.2894884, 0.4725849], abs=2e-7
    )
    # Python finds what follows where it looks for it.
    result = package.read(tmp_path / "results" / "known.rattle")
    assert result.frequency == pytest.approx(26.7)
    assert result.input["load"]["force_orders"] == [1.0, 2.0, 3.0]


KEYS = {
    "gear.teeth_1": ("12", "13"),
    "gear.normal_module": ("2.4e-3", "2.6e-3"),
    "gear.pressure_angle_deg": ("18.0", "21.0"),
    "gear.helix_angle_deg": ("0.0", "15.0"),
    "gear.face_width": ("0.012", "0.02"),
    "gear.centre_distance": ("0.0702", "0.0704"),
    "gear.contact_position": ("-1e-3", "1e-3"),
    "gear.contact_lines": ("1.5", "2.0"),
    "gear.loose_inertia": ("1e-3", "2e-3"),
    "gear.drag_torque": ("0.0", "-0.1"),
    "gear.backlash": ("6e-5", "2e-4"),
    "gear.tooth_stiffness": ("1.0e10", "2.0e10"),
    "shaft.speed_rpm": ("700.0", "900.0"),
    "oil.viscosity_40_cst": ("50.0", "60.0"),
    "oil.viscosity_100_cst": ("8.0", "11.0"),
    "oil.density_15": ("850.0", "900.0"),
    "oil.temperature_celsius": ("-20.0", "80.0"),
}


@pytest.mark.long
@pytest.mark.parametrize("key", KEYS)
def test_a_row_is_the_single_scene_with_that_value(key: str, run, tmp_path: Path) -> None:
    base = PAIR.replace("backlash = 1e-4", "backlash = 1e-4, centre_distance = 0.0701")
    base = base.replace("temperature_celsius = 40.0", "temperature_celsius = 60.0")
    if key == "gear.tooth_stiffness":
        base = base.replace("centre_distance", "tooth_stiffness = 1.4e10, centre_distance")
        base = base.replace("celsius = 60.0", "celsius = 10.0")
    (tmp_path / "many.nml").write_text(
        base
        + f"&scene task = 'campaign' /\n&campaign vary = '{key}', values(:, 1) = {', '.join(KEYS[key])}\n"
        "record = 'film_minimum', 'steady_film', 'natural_frequency' /\n"
    )
    ended = run("many.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    rows = package.read_campaign(tmp_path / "results" / "many.rattle")
    (tmp_path / "one.nml").write_text(base)
    for row, value in enumerate(KEYS[key]):
        ended = run(
            "--set",
            f"{key}={value}",
            "--set",
            "spectrum.verify=.false.",
            "--overwrite",
            "one.nml",
            cwd=tmp_path,
        )
        assert ended.returncode == 0, ended.stderr
        reported = summary_of(tmp_path / "results" / "one.summary.nml")
        for name in ("steady_film", "natural_frequency", "film_minimum"):
            assert rows[name][row] == reported[name], name
    assert rows["film_minimum"][0] != rows["film_minimum"][1]


def test_a_sweep_over_the_speed_of_the_shaft(run, tmp_path: Path) -> None:
    (tmp_path / "up.nml").write_text(
        PAIR
        + "&scene task = 'sweep' /\n"
        + "&sweep key = 'speed_rpm', first = 700, last = 900, count = 3, turn = F /\n"
    )
    ended = run("up.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    rows = package.read(tmp_path / "results" / "up.rattle")
    assert list(rows["speed_rpm"]) == [700.0, 800.0, 900.0]
    assert len(set(rows["natural_frequency"])) == 3


FAULTS = {
    "&load mass = 1.0, frequency = 20.0 /": [
        "13: &load mass: it follows from &gear; leave it out",
        "13: &load frequency: it follows from &shaft; leave it out",
    ],
    "&lubricant viscosity = 0.1 /": ["13: &lubricant viscosity: it follows from &oil; leave it out"],
    "&contact radius = 0.01 /": ["13: &contact radius: it follows from &gear; leave it out"],
    "&kinematics rolling_speed = 2.0 /": [
        "13: &kinematics rolling_speed: it follows from &gear; leave it out"
    ],
}


@pytest.mark.parametrize("more", FAULTS)
def test_what_follows_is_not_given(more: str, check) -> None:
    ended = check(PAIR.rstrip("\n") + "\n\n\n" + more + "\n")
    assert ended.returncode == 2
    assert_faults(ended.stderr.splitlines(), "pair.nml", FAULTS[more])


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("teeth_1 = 11, ", "", "&gear teeth_1: this key is required"),
        (
            "backlash = 1e-4",
            "contact_position = -0.007",
            "4: &gear contact_position: it lies beyond the line",
        ),
        (
            "backlash = 1e-4",
            "centre_distance = 0.06",
            "4: &gear centre_distance: it must exceed the sum",
        ),
        (
            "drag_torque = 0.10, backlash = 1e-4",
            "drag_torque = 0.0",
            "4: &gear drag_torque: without a backlash",
        ),
        (
            "&shaft speed_rpm = 800.0, orders = 2.0, accelerations = 600.0 /",
            "",
            "&shaft: this group is required",
        ),
        ("orders = 2.0", "orders = 2, 2", "6: &shaft orders: engine order 2.0 is given twice"),
        (
            "viscosity_100_cst = 9.6",
            "viscosity_100_cst = 60",
            "7: &oil viscosity_100_cst: at 100 degC an oil is",
        ),
        ("viscosity_40_cst = 58.0, ", "", "&oil viscosity_40_cst: this key is required"),
        (
            "temperature_celsius = 40.0",
            "temperature_celsius = -140",
            "7: &oil temperature_celsius: the viscosity that",
        ),
        (
            "orders = 2.0, accelerations = 600.0",
            "orders = 1, 1.4142135, accelerations = 1, 1",
            "&shaft orders: ",
        ),
    ],
)
def test_faults_of_a_drawing(old: str, new: str, fault: str, check) -> None:
    assert old in PAIR
    ended = check(PAIR.replace(old, new))
    assert ended.returncode == 2
    assert any(fault in line for line in ended.stderr.splitlines()), ended.stderr


def test_warnings_that_an_engineer_expects(check) -> None:
    assert "warning" not in check(PAIR).stdout
    dragged = check(PAIR, "gear.drag_torque=0.4").stdout
    assert "is larger than the inertia force of 6.673 N at most" in dragged
    thin = check(PAIR, "oil.temperature_celsius=250").stdout
    assert "mm2/s at 250 degC; the line through both viscosities (ASTM D341) is meant for 2 and more" in thin


@pytest.mark.parametrize(
    ("temperature", "words"),
    (
        (-20, None),
        (160, None),
        (
            -21,
            "at -21.0 degC the viscosity is extrapolated by 61 K from the 40 and 100 degC of the data sheet",
        ),
        (161, "at 161 degC the viscosity is extrapolated by 61 K"),
    ),
)
def test_temperatures_far_beyond_the_data_sheet_are_called_extrapolated(check, temperature, words) -> None:
    reported = check(PAIR, f"oil.temperature_celsius={temperature}").stdout
    assert words in reported if words else "extrapolated" not in reported


def test_sweeps_and_campaigns_are_warned_of_their_ends(check) -> None:
    ends = "first = -50, last = 40"
    swept = PAIR + f"&scene task = 'sweep' /\n&sweep key = 'temperature_celsius', {ends}, count = 3 /\n"
    assert "at -50.0 degC the viscosity is extrapolated by 90 K" in check(swept).stdout
    vary = "vary = 'shaft.speed_rpm', 'oil.temperature_celsius'"
    grid = f"&campaign {vary}, first = 600, -50, last = 3000, 40, count = 2, 2 /\n"
    assert "at -50.0 degC" in check(PAIR + "&scene task = 'campaign' /\n" + grid).stdout
    listed = "&campaign vary = 'oil.temperature_celsius', values(:, 1) = 40, 180 /\n"
    assert "at 180 degC" in check(PAIR + "&scene task = 'campaign' /\n" + listed).stdout


def cycle(kind: str) -> tuple[list[float], float]:
    """One cycle of two revolutions at 800 1/min: orders 1.5 and 2 of a motion with phases; its mean."""
    speed = 800.0 * math.pi / 30.0
    parts = ((1.5, 120.0, 0.4), (2.0, 600.0, -1.0))
    unit = {"angular_acceleration": 1.0, "angular_speed": 1.0, "angular_speed_rpm": 30.0 / math.pi}[kind]
    if kind == "angular_acceleration":
        terms, mean = [(order, a, phase) for order, a, phase in parts], 0.0
    else:
        terms = [(order, unit * a / (order * speed), phase - 0.5 * math.pi) for order, a, phase in parts]
        mean = unit * speed
    count = 180
    samples = [
        mean + sum(a * math.cos(4.0 * math.pi * order * i / count + phase) for order, a, phase in terms)
        for i in range(count)
    ]
    return samples, mean


@pytest.mark.parametrize("kind", ["angular_acceleration", "angular_speed", "angular_speed_rpm"])
def test_a_measured_cycle_of_the_shaft_is_its_orders(kind: str, check, tmp_path: Path) -> None:
    samples, _ = cycle(kind)
    rows = "".join(f"{720.0 * i / len(samples)!r},{sample!r}\n" for i, sample in enumerate(samples))
    (tmp_path / "cycle.csv").write_text("angle,shaft\n" + rows)
    signal = f"signal = 'cycle.csv', signal_kind = '{kind}'"
    ended = check(PAIR.replace("orders = 2.0, accelerations = 600.0", signal))
    reported = derived(ended)
    assert reported["load.frequency"] == pytest.approx(0.5 * 800.0 / 60.0)
    orders = [
        float(number) for number in re.search(r"load.force_amplitudes = (.*) N", ended.stdout)[1].split(",")
    ]
    newtons = 6.673367428 / 600.0
    assert orders[2:4] == pytest.approx([120.0 * newtons, 600.0 * newtons], rel=2e-9)
    assert max(orders[:2]) < 1e-9
    phases = [
        float(number) for number in re.search(r"load.force_phases = (.*) rad", ended.stdout)[1].split(",")
    ]
    assert math.cos(phases[2] - 0.4) == pytest.approx(1.0) and math.cos(phases[3] + 1.0) == pytest.approx(1.0)
    # What is printed is an input of its own.
    assert derived(check(ended.stdout))["load.force_amplitudes"] == reported["load.force_amplitudes"]


def test_the_highest_order_of_a_speed_has_no_derivative(check, tmp_path: Path) -> None:
    """Samples of a speed that only alternate do not say when it is at its mean."""
    rows = "".join(f"{800.0 + math.cos(math.pi * i / 4.0) + (-1.0) ** i!r}\n" for i in range(8))
    (tmp_path / "cycle.csv").write_text("speed\n" + rows)
    signal = "signal = 'cycle.csv', signal_kind = 'angular_speed_rpm', signal_orders = 4"
    ended = check(PAIR.replace("orders = 2.0, accelerations = 600.0", signal))
    assert ended.returncode == 2 and "4 orders take 9 samples a cycle; the signal has 8" in ended.stderr
    ended = check(PAIR.replace("orders = 2.0, accelerations = 600.0", signal.replace("= 4", "= 3")))
    assert ended.returncode == 0, ended.stderr
    kept = re.search(r"^   speed_amplitudes = (.*)$", ended.stdout, re.M)[1].split(",")
    assert len(kept) == 3 and float(kept[0]) == pytest.approx(math.pi / 30.0)
    assert max(abs(float(number)) for number in kept[1:]) < 1e-12


def test_faults_of_a_measured_cycle(check, tmp_path: Path) -> None:
    both = PAIR.replace("orders = 2.0", "orders = 2.0, signal = 'cycle.csv'")
    ended = check(both)
    assert ended.returncode == 2 and "the signal gives the motion" in ended.stderr
    ended = check(PAIR.replace("orders = 2.0, accelerations = 600.0", "signal = 'missing.csv'"))
    assert ended.returncode == 2 and "missing.csv" in ended.stderr and "required" not in ended.stderr
    (tmp_path / "cycle.csv").write_text("speed\n801\n799\n801\n799\n")
    speed = "signal = 'cycle.csv', signal_kind = 'angular_speed_rpm'"
    ended = check(PAIR.replace("orders = 2.0, accelerations = 600.0", speed))
    assert ended.returncode == 2 and "it has too few samples to be differentiated" in ended.stderr
    ended = check(PAIR.replace("speed_rpm = 800.0, orders = 2.0, accelerations = 600.0", speed))
    assert ended.returncode == 2 and "&shaft speed_rpm: this key is required" in ended.stderr
    ended = check(PAIR.replace("accelerations = 600.0", "accelerations = 600.0, cycle_revolutions = 2"))
    assert "&shaft cycle_revolutions: this key is used only with signal" in ended.stderr


def test_the_page_works_the_ready_pair_through(run, repository: Path, tmp_path: Path) -> None:
    """The numbers that the page on gears has of loose_pair.nml are those of --check."""
    reported = derived(run("--check", repository / "input" / "loose_pair.nml", cwd=tmp_path))
    page = (repository / "input" / "GEARS.md").read_text()
    rows = re.findall(r"^\| `(contact|kinematics|load)\.(\w+)`[^|]*\|[^|]*\| ([\d.]+)[^|]*\|$", page, re.M)
    assert len(rows) == 7
    for group, key, value in rows:
        assert float(value) == pytest.approx(reported[f"{group}.{key}"], rel=5e-5), key
    for what, key in (("viscosity at T", "viscosity"), ("alpha at T", "pressure_viscosity")):
        value = re.search(rf"^\| {what} .*\| (\S+) \|$", page, re.M)[1]
        assert float(value) == pytest.approx(reported[f"lubricant.{key}"], rel=5e-5)


@pytest.mark.parametrize(
    ("settings", "advice"),
    [
        ([], "iso-viscous with model = reynolds fits"),
        (["film.model=published", "film.law=piezo-viscous"], "iso-viscous with model = reynolds fits"),
        (["gear.drag_torque=1.4"], "piezo-viscous with model = reynolds fits"),
        (["gear.drag_torque=60.0"], "no film of rigid flanks fits, elastohydrodynamic fits"),
    ],
)
def test_check_advises_a_film_law(settings: list[str], advice: str, check) -> None:
    line = next(
        line for line in check(PAIR, *settings).stdout.splitlines() if "Reynolds film at rest" in line
    )
    assert line.endswith(advice)


# --- defaults of gear pairs ------------------------------------------------------------------------------

BARE = PAIR.partition("&film")[0]
DEFAULTS = {
    "law": "'elastohydrodynamic'",
    "model": "'closure'",
    "viscosity_law": "'roelands'",
    "tooth_stiffness": "1.4E10",
    "until": "'steady'",
    "samples_per_period": "4096",
}


def resolved(echo: str) -> dict[str, str]:
    return dict(re.findall(r"^   (\w+) = (.+)$", echo, re.M))


def test_a_gear_without_film_and_solver_has_the_defaults_of_gears(check, scene_text, run, tmp_path) -> None:
    reported = resolved(check(BARE).stdout)
    assert {name: reported[name] for name in DEFAULTS} == DEFAULTS
    scene = resolved(run("--check", "-", cwd=tmp_path, stdin=scene_text()).stdout)
    assert (scene["until"], scene["model"]) == ("'periods'", "'published'")
    assert "tooth_stiffness" not in scene


def test_defaults_of_gears_solve_what_their_keys_do(run, tmp_path: Path) -> None:
    """The same bytes, and `until = 'steady'` ended it."""
    named = "&film law = 'elastohydrodynamic', model = 'closure' /\n&solver until = 'steady', periods = 60,"
    named += " accuracy = 1e-6, samples_per_period = 4096 /\n&lubricant viscosity_law = 'roelands' /\n"
    brief = BARE + "&solver periods = 60, accuracy = 1e-6 /\n"
    full = BARE.replace("backlash = 1e-4", "backlash = 1e-4, tooth_stiffness = 1.4e10") + named
    for folder, text in (("brief", brief), ("full", full)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "pair.nml").write_text(text)
        assert run("pair.nml", cwd=tmp_path / folder).returncode == 0
    paths = [tmp_path / folder / "results" / "pair.rattle" for folder in ("brief", "full")]
    assert paths[0].read_bytes() == paths[1].read_bytes()
    assert summary_of(paths[0].with_suffix(".summary.nml"))["status"] == "steady"


def test_other_laws_of_a_gear_have_their_own_defaults(check) -> None:
    reported = resolved(check(BARE + "&film law = 'iso-viscous' /\n").stdout)
    assert (reported["model"], reported["viscosity_law"]) == ("'reynolds'", "'barus'")


def test_rigid_teeth_are_a_stiffness_of_zero(check) -> None:
    reported = check(PAIR.replace("backlash = 1e-4", "backlash = 1e-4, tooth_stiffness = 0"))
    assert "contact.stiffness" not in reported.stdout and "meant in" not in reported.stdout


def test_a_published_film_of_a_gear_is_warned_of(check) -> None:
    published = "pair.nml:8: the published films are those of the paper's scenes"
    assert published in check(PAIR.replace("reynolds", "published")).stdout
    assert published not in check(PAIR).stdout


def test_newmark_asks_for_rigid_teeth_of_a_gear(run, tmp_path: Path) -> None:
    text = BARE + "&film law = 'iso-viscous' /\n&solver method = 'newmark' /\n"
    refused = run("--check", "-", cwd=tmp_path, stdin=text)
    assert refused.returncode == 2 and "set gear.tooth_stiffness = 0" in refused.stderr
    rigid = text.replace("backlash = 1e-4", "backlash = 1e-4, tooth_stiffness = 0")
    assert run("--check", "-", cwd=tmp_path, stdin=rigid).returncode == 0


@pytest.mark.long
@pytest.mark.parametrize("temperature", (-30, 0, 40, 100))
def test_check_expects_the_law_that_the_motion_asks_for(temperature: int, check, run, tmp_path) -> None:
    """Impacts of a gear that leaves its flank are below those without oil, which no other load is."""
    text = BARE.replace("temperature_celsius = 40.0", f"temperature_celsius = {temperature}")
    text = text.replace(
        "drag_torque = 0.10",
        "bearing_mean_diameter = 0.046, synchroniser_cones = 2\n"
        "   synchroniser_diameter = 0.076, synchroniser_width = 0.008, synchroniser_gap = 0.2e-3",
    )
    text += "&film law = 'iso-viscous' /\n&solver periods = 60, accuracy = 1e-6 /\n"
    (line,) = (line for line in check(text).stdout.splitlines() if "largest load" in line)
    assert run("pair.nml", cwd=tmp_path).returncode == 0
    reported = summary_of(tmp_path / "results" / "pair.summary.nml")
    load = float(re.search(r"(?:expected|without oil) +(\S+) N", line)[1])
    lifted = reported["inertia_ratio"] > 1.0
    assert ("largest load without oil" in line) == lifted
    mass, frequency = reported["mass"], reported["frequency"]
    speed = reported["force_amplitudes"] / (2.0 * math.pi * frequency * mass)
    dry = speed * math.sqrt(mass * reported["stiffness"])
    steady = reported["steady_force"] + reported["force_amplitudes"]
    assert load == pytest.approx(dry if lifted else steady, rel=5e-3)
    assert 0.1 * load < reported["load_maximum"] < 1.01 * load or not lifted
    fits = {"iso-viscous": "iso-viscous with", "piezo-viscous": "piezo-viscous with"}
    if not lifted:
        assert fits[reported["film_regime"]] in line
    elif reported["film_regime"] == "elastohydrodynamic":
        assert "elastohydrodynamic fits" in line
