"""Teeth that a pair can have, against ISO 21771 with 30 digits; units before geometry."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from mpmath import acos, atan, cos, mp, mpf, pi, sin, sqrt, tan

import rattle as package
from rattle.keys import key_table

mp.dps = 30
PAIR = """&gear
   teeth_1 = 11
   teeth_2 = 38
   normal_module = 2.5e-3
   helix_angle_deg = 28.96
   face_width = 0.016
   loose_inertia = 1.715e-3
   drag_torque = 0.10
   backlash = 1.0e-4
/
&shaft speed_rpm = 800.0, orders = 2.0, accelerations = 600.0 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 40.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver periods = 4, accuracy = 1e-6 /
&spectrum periods = 2 /
"""
SPUR = (
    "gear.helix_angle_deg=0",
    "gear.teeth_1=20",
    "gear.teeth_2=30",
    "gear.normal_module=2e-3",
    "gear.centre_distance=0.05",
)


@pytest.fixture
def check(run, tmp_path: Path):
    """What --check says of the pair with some keys set: its warnings, its derived numbers, its faults."""
    (tmp_path / "pair.nml").write_text(PAIR)

    def call(*settings: str, text: str = PAIR):
        (tmp_path / "pair.nml").write_text(text)
        options = [word for setting in settings for word in ("--set", setting)]
        ended = run("--check", *options, "pair.nml", cwd=tmp_path)
        assert ended.returncode in (0, 2), ended.stderr
        warnings = re.findall(r"^! warning: (.*)$", ended.stdout, re.MULTILINE)
        numbers = re.findall(r"^! derived: gear\.(\w+) = (\S+)", ended.stdout, re.MULTILINE)
        return warnings, {name: float(number) for name, number in numbers}, ended.stderr.splitlines()

    return call


def iso_21771(z: tuple[int, int], module: str, helix: str, distance: str) -> tuple[mpf, mpf]:
    """Sum of the profile shifts, and contact ratio of tips shortened by k m_n, half of the sum on both."""
    m_n, beta, alpha_n, a = mpf(module), mpf(helix) * pi / 180, pi / 9, mpf(distance)
    m_t, alpha_t = m_n / cos(beta), atan(tan(alpha_n) / cos(beta))
    r = [m_t * teeth / 2 for teeth in z]
    r_b = [radius * cos(alpha_t) for radius in r]
    alpha_wt = acos(sum(r_b) / a)
    shifts = sum(z) * ((tan(alpha_wt) - alpha_wt) - (tan(alpha_t) - alpha_t)) / (2 * tan(alpha_n))
    k = (a - sum(r)) / m_n - shifts
    r_a = [radius + m_n * (1 + shifts / 2 + k) for radius in r]
    path = sum(sqrt(tip**2 - base**2) for tip, base in zip(r_a, r_b, strict=True)) - a * sin(alpha_wt)
    return shifts, path / (pi * m_t * cos(alpha_t))


@pytest.mark.parametrize(
    ("z", "module", "helix", "distance"),
    [
        ((11, 38), "2.5e-3", "28.96", "0.0725"),
        ((19, 37), "2.2e-3", "28.0", "0.070"),
        ((27, 35), "1.95e-3", "30.0", "0.0695"),
        ((40, 63), "3.0e-3", "0.0", "0.158"),
    ],
)
def test_profile_shifts_and_contact_ratio(z, module: str, helix: str, distance: str, check) -> None:
    words = (f"teeth_1={z[0]}", f"teeth_2={z[1]}", f"normal_module={module}", f"helix_angle_deg={helix}")
    warnings, found, _ = check(*(f"gear.{word}" for word in (*words, f"centre_distance={distance}")))
    shifts, ratio = iso_21771(z, module, helix, distance)
    # Differences of involutes lose four digits.
    assert found["profile_shift_sum"] == pytest.approx(float(shifts), abs=1e-12)
    assert found["contact_ratio"] == pytest.approx(float(ratio), abs=1e-12)
    assert not warnings


@pytest.mark.parametrize("distance", ["0.0668", "0.075", "0.080", "0.085", "0.088"])
def test_no_contact_ratio_is_larger_than_teeth_have(distance: str, check) -> None:
    """Tips that were not shortened had 3.35 at 0.100 m."""
    warnings, found, _ = check(f"gear.centre_distance={distance}")
    angle = acos(mpf("0.0646340987009336") / mpf(distance))
    # Racks with pointed teeth have 1/(2 sin(alpha)**2), gears less; none more than their line of action.
    assert found["contact_ratio"] < min(1 / (2 * sin(angle) ** 2), 49 * tan(angle) / (2 * pi))
    beyond = [words for words in warnings if "profile shifts that add up to" in words]
    assert len(beyond) == (float(distance) > 0.074)
    assert any("contact ratio of teeth as high as usual is" in words for words in warnings)


def test_gears_too_far_apart_or_too_close_are_refused(check) -> None:
    for distance in ("0.10", "0.70", "0.065"):
        _, _, (fault,) = check(f"gear.centre_distance={distance}")
        assert fault.startswith("pair.nml: &gear centre_distance: no teeth have a contact ratio of 1 at ")
        assert fault.endswith("; without profile shift it is 0.07000 m")


def test_a_contact_ratio_below_one_is_warned_of(check) -> None:
    """Short tips: of a spur pair, of a helical one with overlap enough, of one too narrow for that."""
    (warning,), found, _ = check(*SPUR, "gear.tip_diameter_1=0.0406", "gear.tip_diameter_2=0.0606")
    assert found["contact_ratio"] == pytest.approx(0.28447253, rel=1e-7) and found["overlap_ratio"] == 0.0
    said = f"the transverse contact ratio is {found['contact_ratio']:.3f}: below 1 the pair does not "
    assert f"{said}transmit continuously" in warning
    tips = ("gear.tip_diameter_1=0.034", "gear.tip_diameter_2=0.1095")
    (warning,), found, _ = check(*tips)
    total = found["contact_ratio"] + found["overlap_ratio"]
    assert found["contact_ratio"] < 1.0 < total
    assert f"by the overlap of the helix alone, in all {total:.2f}" in warning
    (warning,), found, _ = check(*tips, "gear.face_width=0.004")
    total = found["contact_ratio"] + found["overlap_ratio"]
    assert (
        f"with the overlap of the helix {total:.3f}: below 1 the pair does not transmit continuously"
        in warning
    )
    warnings, found, _ = check(*SPUR, "gear.tip_diameter_1=0.044", "gear.tip_diameter_2=0.064")
    assert not warnings and found["contact_ratio"] > 1.5


def test_odd_teeth_are_warned_of(check) -> None:
    spur = SPUR[:4]
    for settings, words in (
        (("gear.tip_diameter_1=0.0476", "gear.tip_diameter_2=0.0632"), "is pointed below this tip"),
        (
            ("gear.tip_diameter_1=0.0472", "gear.tip_diameter_2=0.0632"),
            " normal modules thick, and usual are 0.2 at least",
        ),
        (
            ("gear.tip_diameter_1=0.0425", "gear.tip_diameter_2=0.0655"),
            "is undercut: it takes a profile shift of -0.34 at least",
        ),
    ):
        warnings, _, faults = check(*spur, *settings)
        assert not faults and any(words in warning for warning in warnings), (words, warnings)
    high = ("gear.teeth_1=60", "gear.teeth_2=60", "gear.tip_diameter_1=0.1262", "gear.tip_diameter_2=0.1262")
    (warning,), _, _ = check(
        "gear.helix_angle_deg=0", "gear.normal_module=2e-3", *high, "gear.pressure_angle_deg=15"
    )
    assert "make addenda of 1.55 normal modules" in warning and "touch these tips" in warning
    (warning,), _, _ = check("gear.contact_position=0.006")
    assert warning.endswith(
        "&gear contact_position: teeth as high as usual do not touch there: it lies beyond a tip"
    )


def test_ends_of_what_is_varied_are_looked_at(check) -> None:
    text = PAIR.replace("face_width", "centre_distance = 0.070, face_width")
    varied = "vary = 'gear.centre_distance', first = 0.070, last = 0.075, count = 3"
    warnings, _, _ = check(text=f"{text}&scene task = 'campaign' /\n&campaign {varied} /\n")
    place = "pair.nml:6: &gear centre_distance: at centre_distance = 0.075: 0.07500 m takes profile shifts"
    assert warnings[0].startswith(place) and len(warnings) == 2
    varied = "key = 'gear.centre_distance', first = 0.070, last = 0.075"
    assert check(text=f"{text}&scene task = 'threshold' /\n&threshold {varied} /\n")[0] == warnings


def test_log_and_summary_tell_shifts_and_ratios(run, tmp_path: Path) -> None:
    (tmp_path / "pair.nml").write_text(PAIR.replace("face_width", "centre_distance = 0.0725, face_width"))
    ended = run("pair.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    shifts, ratio = iso_21771((11, 38), "2.5e-3", "28.96", "0.0725")
    summary = package.read_summary(tmp_path / "results" / "pair.summary.nml")
    assert summary["profile_shift_sum"] == pytest.approx(float(shifts), abs=1e-12)
    assert summary["contact_ratio"] == pytest.approx(float(ratio), abs=1e-12)
    said = f"  profile shift sum {float(shifts):.2f}, contact ratio {float(ratio):.3f}, overlap ratio 0.9864"
    assert said in (tmp_path / "results" / "pair.log").read_text().splitlines()


def test_a_unit_is_the_likely_reason_of_a_fault(check) -> None:
    """A module in millimetres beside a centre distance in metres: what is wrong with the pair, then why."""
    text = PAIR.replace("2.5e-3", "2.5, centre_distance = 0.070")
    _, _, (fault, reason) = check(text=text)
    assert fault.endswith(": &gear centre_distance: it must exceed the sum of the base radii")
    assert reason == (
        "pair.nml:4: &gear normal_module: the likely reason: 2.5 m is not what machines have (3.0E-4 to "
        "0.05 m); it would be 0.002500 m if it was meant in mm"
    )
    # All of them, behind all that is wrong; the width alone would be a warning.
    _, _, faults = check("gear.contact_position=0.5", "gear.face_width=16", text=text)
    reasons = [fault.partition("; ")[2] for fault in faults if "the likely reason: " in fault]
    assert reasons == [
        f"it would be {meant} m if it was meant in mm" for meant in ("0.002500", "0.01600", "5.000E-4")
    ]
    assert not any("reason" in fault for fault in faults[: -len(reasons)]) and len(faults) > len(reasons)
    tips = ("gear.tip_diameter_1=36.3", "gear.tip_diameter_2=113.6")
    _, _, faults = check(*tips)
    assert [fault.rpartition("; ")[2] for fault in faults[-2:]] == [
        f"it would be {meant} m if it was meant in mm" for meant in ("0.03630", "0.1136")
    ]
    # An order that no multiple of another makes stays wrong in any unit.
    orders = ("shaft.orders=1.0,3.14159265358979", "shaft.accelerations=600.0,60.0")
    _, _, faults = check("gear.immersion_depth=40", "gear.drag_scale=1.0", *orders, text=computed_drag())
    assert ["the likely reason: 40.0 m" in fault for fault in faults] == [False, False, True]
    assert "cannot lie 4.000E+01 m below the oil" in faults[0] and "no common divisor" in faults[1]


def computed_drag() -> str:
    return PAIR.replace("drag_torque = 0.10", "bearing_mean_diameter = 0.04")


def of_parts() -> str:
    """A drag of a plain bearing and a synchroniser."""
    more = (
        "bearing_width = 0.02, bearing_clearance = 3e-5, synchroniser_cones = 1, synchroniser_diameter = 0.06"
    )
    cone = "synchroniser_width = 0.008, synchroniser_gap = 2e-4"
    return computed_drag().replace("backlash", f"{more}, {cone}\n   backlash")


@pytest.mark.parametrize(
    ("settings", "meant"),
    [
        (("film.initial_film=100",), "1.000E-4 m if it was meant in um"),
        (("oil.viscosity_40_cst=0.5", "oil.viscosity_100_cst=9.6"), "574.7 mm2/s if it was meant in Pa s"),
    ],
)
def test_a_unit_is_the_likely_reason_of_a_fault_between_keys(settings, meant: str, check) -> None:
    _, _, (fault,) = check(*settings)
    assert fault.endswith(meant)


def test_a_unit_is_the_likely_reason_where_keys_are_varied(check, tmp_path: Path) -> None:
    text = PAIR.replace("face_width", "centre_distance = 0.070, face_width")
    varied = "vary = 'gear.normal_module', first = 2.4, last = 2.5, count = 2"
    _, _, faults = check(text=f"{text}&scene task = 'campaign' /\n&campaign {varied} /\n")
    assert "centre_distance: it must exceed the sum of the base radii; the likely reason: " in faults[0]
    assert "normal_module = 2.4 m is not" in faults[0]
    assert "; it would be 0.002400 m if it was meant in mm; " in faults[0]
    (tmp_path / "run_up.csv").write_text("speed_rpm,acceleration_2\n600,500\n6000,300\n")
    text = PAIR.replace("orders = 2.0, accelerations = 600.0", "table = 'run_up.csv'")
    _, _, (fault, reason) = check("shaft.speed_rpm=15", text=text)
    assert "likely reason" in reason and "likely reason" not in fault
    assert reason.endswith("it would be 900.0 1/min if it was meant in Hz")
    varied = "key = 'speed_rpm', first = 15, last = 30, count = 2"
    _, _, (fault,) = check(text=f"{text}&scene task = 'sweep' /\n&sweep {varied} /\n")
    assert fault.startswith("pair.nml: &sweep first: at 15.00000: ")
    assert "; the likely reason: shaft.speed_rpm = 15.0 1/min is not what machines have" in fault


@pytest.mark.parametrize(
    ("key", "value", "meant"),
    [
        ("bearing_mean_diameter", "40", "0.04000 m if it was meant in mm"),
        ("bearing_width", "25", "0.02500 m if it was meant in mm"),
        ("bearing_clearance", "0.03", "3.000E-5 m if it was meant in mm"),
        ("bearing_clearance", "30", "3.000E-5 m if it was meant in um"),
        ("synchroniser_diameter", "60", "0.06000 m if it was meant in mm"),
        ("synchroniser_width", "8", "0.008000 m if it was meant in mm"),
        ("synchroniser_gap", "0.2", "2.000E-4 m if it was meant in mm"),
        ("synchroniser_gap", "200", "2.000E-4 m if it was meant in um"),
        ("immersion_depth", "20", "0.02000 m if it was meant in mm"),
    ],
)
def test_lengths_of_a_drag(key: str, value: str, meant: str, check) -> None:
    warnings, _, faults = check(f"gear.{key}={value}", text=of_parts())
    assert any(meant in words for words in [*warnings, *faults]), (warnings, faults)


def test_every_length_of_a_gear_is_looked_at(check) -> None:
    """Whatever a length is of, it may have been typed in millimetres, and the volume of the oil in litres."""
    for (group, name), key in key_table().items():
        if group not in ("gear", "oil") or key.unit not in ("m", "m3"):
            continue
        settings = {f"gear.tip_diameter_{i}": tip for i, tip in ((1, "36.3"), (2, "113.6")) if "tip" in name}
        warnings, _, faults = check(
            *(f"{key}={value}" for key, value in ({f"{group}.{name}": "50"} | settings).items()),
            text=PAIR if settings else of_parts(),
        )
        assert any(f"&{group} {name}" in words and "meant in" in words for words in (*warnings, *faults)), (
            name
        )
