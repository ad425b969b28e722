"""recording.py encoders: what rattle moved is seen by two encoders; calibrate.py finds its input again."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from script_calls import called_here

import rattle as package
from rattle.derived import derived

INPUT = """&scene name = 'bench' /
&gear
   teeth_1 = 11, teeth_2 = 38, normal_module = 2.5e-3, helix_angle_deg = 28.96, face_width = 0.016
   loose_inertia = 1.715e-3, drag_torque = 0.10, backlash = 1.0e-4, tooth_stiffness = 0.0
/
&shaft speed_rpm = 800.0, orders = 2.0, 4.0, accelerations = 600.0, 100.0, phases = 0.0, 0.8 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 60.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver until = 'periods', periods = 40, samples_per_period = 4096, starts = 1 /
&spectrum periods = 4, verify = .false. /
&output columns = 'time', 'gear_position' /
"""
PERIODS, RATE = 30, 50e3
BITS = 16  # a revolution: 5 um at the flank of the loose gear


class Bench:
    """A motion of rattle, and what the encoders of a bench make of it."""

    def __init__(self, **settings) -> None:
        self.keys = derived(INPUT, set=settings)
        solved = package.run(INPUT, set=settings)
        self.summary = solved.summary
        time, position = (np.array(solved.result[name], dtype=float) for name in ("time", "gear_position"))
        begin = time[-1] - PERIODS / float(self.keys["load.frequency"])
        self.time = np.arange(begin, time[-1], 1.0 / RATE)
        self.position = np.interp(self.time, time, position)

    def angles(self) -> tuple[np.ndarray, np.ndarray]:
        """Of driver and loose gear [rad]: the gap is that of the loose gear running ahead."""
        number = {
            key: float(self.keys[f"gear.base_{key}"]) for key in ("radius_1", "radius_2", "helix_angle")
        }
        speed = float(self.keys["shaft.speed_rpm"]) * np.pi / 30.0
        rows = (
            map(float, self.keys[f"shaft.{key}"].split(",")) for key in ("orders", "accelerations", "phases")
        )
        driver = speed * self.time
        for order, size, phase in zip(*rows, strict=True):
            driver = driver - size / (order * speed) ** 2 * np.cos(order * speed * self.time + phase)
        ahead = self.position / np.cos(np.radians(number["helix_angle"]))
        return driver, (ahead + number["radius_1"] * driver) / number["radius_2"]

    def write(
        self, path: Path, *, drift: float = 2e-4, eccentricity: float = 2e-4, change=lambda a, b: (a, b)
    ):
        """A file as a bench writes it: encoders with steps and noise, one drifts and is off its axis."""
        driver, loose = self.angles()
        loose = loose + eccentricity * np.sin(loose + 1.0)
        loose = loose + drift * np.sin(2.0 * np.pi * 0.8 * (self.time - self.time[0]))
        draw, step = np.random.default_rng(7), 2.0 * np.pi / 2.0**BITS
        driver, loose = (
            np.floor((angle + draw.normal(0.0, 1e-5, len(angle))) / step) * step for angle in (driver, loose)
        )
        columns = [self.time - self.time[0], *map(np.degrees, change(driver, loose))]
        head = "time [s],driver [deg],loose [deg]"
        np.savetxt(path, np.column_stack(columns), delimiter=",", fmt="%.9g", header=head, comments="")


@pytest.fixture(scope="module")
def bench(rattle: Path) -> Bench:
    return Bench()


@pytest.fixture(scope="module")
def measured(bench: Bench, tmp_path_factory) -> Path:
    """A folder with the input, the recording and what recording.py makes of it."""
    folder = tmp_path_factory.mktemp("encoders")
    (folder / "bench.nml").write_text(INPUT)
    bench.write(folder / "bench.csv")
    code, said, complained = measure(folder)
    assert code == 0, complained
    (folder / "said.txt").write_text(said)
    return folder


def measure(
    folder: Path, *options: object, channels: tuple[str, str] = ("driver", "loose")
) -> tuple[int, str, str]:
    given = options if "--base-radii" in options else (*options, "--input", "bench.nml")
    return called_here(
        "recording.py", "encoders", "bench.csv", "--driver", channels[0], "--loose", channels[1],
        "--temperature", 60, *given, "--output", "bench.json", "--overwrite", cwd=folder,
    )  # fmt: skip


def reported(folder: Path) -> dict:
    return json.loads((folder / "bench.json").read_text())


def ratio(bench: Bench) -> float:
    """Drag over inertia [1/s2] of the input."""
    return float(bench.keys["gear.drag_torque"]) / float(bench.keys["gear.loose_inertia"])


def test_backlash_and_impacts_are_seen(bench: Bench, measured: Path) -> None:
    """Films at contact are below 1 um each here; parabolas through steps of 5 um are off as much."""
    found = reported(measured)
    assert found["is_double_sided"] and found["periods"] >= PERIODS - 2
    assert found["play"]["value"] == pytest.approx(1.0e-4, rel=0.02)
    for side in ("drive", "coast"):
        assert found[f"impacts_per_period_{side}"] == pytest.approx(
            bench.summary[f"impacts_per_period_{side}"], abs=0.05
        )
        # rattle takes the velocity where the film has begun to slow the gear, the encoders where it touches.
        own = bench.summary[f"impact_velocity_maximum_{side}"]
        assert own * 0.97 < found[f"velocity_{side}"]["value"] < own * 1.1
        assert found[f"velocity_maximum_{side}"] >= found[f"velocity_{side}"]["value"]


def test_restitution_is_that_of_the_motion(bench: Bench, measured: Path) -> None:
    """Largest velocity within 1.5 ms behind an impact over that before it, of the motion itself."""
    velocity = np.gradient(bench.position, bench.time)
    found = reported(measured)
    for side, sign in (("drive", 1.0), ("coast", -1.0)):
        away = sign * velocity
        before = np.min(away[1000:-1000])
        at = [1000 + i for i in np.flatnonzero(np.diff((away[1000:-1000] < 0.9 * before).astype(int)) == -1)]
        after = np.mean([np.max(away[i : i + 75]) for i in at])
        assert len(at) >= PERIODS - 2
        assert found[f"restitution_{side}"]["value"] == pytest.approx(-after / before, abs=0.1)
        assert 0.0 < found[f"restitution_{side}"]["high"] - found[f"restitution_{side}"]["low"] < 0.2


def test_flights_tell_drag_over_inertia(bench: Bench, measured: Path) -> None:
    """The oil pulls in flight by some per cent of a drag of 0.1 N m."""
    found = reported(measured)["drag_over_inertia"]
    assert found["value"] == pytest.approx(ratio(bench), rel=0.04)
    assert found["low"] < ratio(bench) < found["high"] < 1.15 * found["low"]


def test_the_orders_of_the_driver_are_those_of_the_shaft(measured: Path) -> None:
    shaft = reported(measured)["shaft"]
    assert shaft["speed_rpm"] == pytest.approx(800.0, rel=1e-4)
    assert shaft["orders"] == [2.0, 4.0]
    assert shaft["accelerations"] == pytest.approx([600.0, 100.0], rel=0.01)
    turned = np.array(shaft["phases"]) - np.array([0.0, 0.8])
    # The angle counts from where the encoder reads 0, up to whole turns.
    assert np.abs(np.angle(np.exp(1j * turned))) == pytest.approx([0.0, 0.0], abs=0.02)


def test_what_is_not_seen_is_said(measured: Path) -> None:
    said = (measured / "said.txt").read_text()
    for words in (
        "larger by the oil films at contact",
        "A drift of",
        "order 2 at 800",
        "calibrate.py takes that off",
    ):
        assert words in said


@pytest.mark.parametrize(("drift", "eccentricity"), ((0.0, 0.0), (1e-3, 0.0), (0.0, 1e-3)))
def test_drift_and_eccentricity_are_no_backlash(
    drift: float, eccentricity: float, bench: Bench, tmp_path: Path
) -> None:
    """1 mrad is half of the backlash at the loose gear."""
    (tmp_path / "bench.nml").write_text(INPUT)
    bench.write(tmp_path / "bench.csv", drift=drift, eccentricity=eccentricity)
    code, _, complained = measure(tmp_path)
    assert code == 0, complained
    assert reported(tmp_path)["play"]["value"] == pytest.approx(1.0e-4, rel=0.03)
    assert reported(tmp_path)["drag_over_inertia"]["value"] == pytest.approx(ratio(bench), rel=0.06)


def fitted(said: str, key: str) -> tuple[float, float, float]:
    """Value and interval that calibrate.py prints."""
    found = re.search(rf"^{key} = (\S+), 95% interval (\S+) to (\S+)$", said, re.M)
    value, low, high = map(float, found.groups())
    return value, low, high


def test_calibrate_finds_the_input_again(measured: Path) -> None:
    """From a backlash and a drag that are a third off; the intervals hold what was solved."""
    text = INPUT.replace("backlash = 1.0e-4", "backlash = 1.3e-4").replace(
        "drag_torque = 0.10", "drag_torque = 0.13"
    )
    (measured / "off.nml").write_text(text)
    code, said, complained = called_here("calibrate.py", "off.nml", "bench.json", cwd=measured)
    assert code == 0, complained
    backlash, low, high = fitted(said, "gear.backlash")
    assert backlash == pytest.approx(1.0e-4, rel=0.015) and low < 1.0e-4 < high < 1.04 * low
    drag, low, high = fitted(said, "gear.drag_torque")
    assert low < 0.10 < high and high < 1.12 * low and drag == pytest.approx(0.10, rel=0.04)
    # What the fit did not use agrees: velocities and impacts of the fitted input.
    for line in said.splitlines()[2:8]:
        measured_value, computed = map(float, line.split()[-2:])
        assert computed == pytest.approx(measured_value, rel=0.1, abs=0.1), line


def test_elastic_teeth_bounce_and_are_fitted_all_the_same(tmp_path: Path, rattle: Path) -> None:
    """Teeth of steel give by 3 um at an impact and throw the gear back with half of its velocity."""
    settings = {"gear.tooth_stiffness": 14e9, "oil.temperature_celsius": 40.0}
    bench = Bench(**settings)
    text = INPUT.replace("stiffness = 0.0", "stiffness = 14e9")
    (tmp_path / "bench.nml").write_text(text.replace("backlash = 1.0e-4", "backlash = 0.8e-4"))
    bench.write(tmp_path / "bench.csv")
    code, _, complained = measure(tmp_path, "--temperature", 40)
    assert code == 0, complained
    assert reported(tmp_path)["restitution_drive"]["value"] > 0.3
    code, said, complained = called_here("calibrate.py", "bench.nml", "bench.json", cwd=tmp_path)
    assert code == 0, complained
    assert fitted(said, "gear.backlash")[0] == pytest.approx(1.0e-4, rel=0.015)
    assert fitted(said, "gear.drag_torque")[0] == pytest.approx(0.10, rel=0.05)


def test_calibrate_tells_the_inertia_of_a_known_drag(measured: Path) -> None:
    """Of an input whose inertia is a quarter off: more drag is asked for, or the true inertia."""
    (measured / "heavy.nml").write_text(INPUT.replace("loose_inertia = 1.715e-3", "loose_inertia = 2.1e-3"))
    code, said, complained = called_here("calibrate.py", "heavy.nml", "bench.json", cwd=measured)
    assert code == 0, complained
    assert fitted(said, "gear.drag_torque")[0] == pytest.approx(0.10 * 2.1 / 1.715, rel=0.04)
    inertia, low, high = map(
        float, re.search(r"loose_inertia would be (\S+), (\S+) to (\S+) kg m2", said).groups()
    )
    assert low < 1.715e-3 < high and inertia == pytest.approx(1.715e-3, rel=0.04)


def test_one_flank_gives_a_bound_alone(tmp_path: Path, rattle: Path) -> None:
    """Hot oil, more drag and backlash: the gear falls back before it reaches the coast flank."""
    bench = Bench(**{"gear.backlash": 6e-4, "gear.drag_torque": 0.2, "oil.temperature_celsius": 80.0})
    assert bench.summary["verdict"] == "single-sided impacts"
    (tmp_path / "bench.nml").write_text(INPUT)
    bench.write(tmp_path / "bench.csv")
    code, said, complained = measure(tmp_path)
    assert code == 0, complained
    found = reported(tmp_path)
    assert not found["is_double_sided"] and found["impacts_per_period_coast"] < 0.2
    assert found["play"]["value"] == pytest.approx(np.ptp(bench.position), rel=0.1)
    assert "the backlash is larger than the range" in said
    code, _, complained = called_here("calibrate.py", "bench.nml", "bench.json", cwd=tmp_path)
    assert code == 2 and "no impacts on both flanks" in complained


def swap(driver: np.ndarray, loose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return loose, driver


def tied(driver: np.ndarray, _: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A loose gear that never leaves the driver."""
    return driver, driver * 11.0 / 38.0


@pytest.mark.parametrize(
    ("change", "options", "words"),
    (
        (swap, (), "the encoders are swapped"),
        (tied, (), "does not stand out"),
        (lambda a, b: (a, 1.01 * b), (), "check the radii"),
        (lambda a, b: (a, 0.0 * b), (), "has an angle that changes"),
        (None, ("--part", "0,0.3"), "at least"),
        (None, ("--gear", "5th"), "has no pair '5th'"),
        (None, ("--base-radii", "0.0145,0.0501", "--input", "bench.nml"), "give either --input"),
        (None, ("--base-radii", "0.0145"), "is not two radii"),
        (None, ("--unit", "loose=V"), "no unit of an angle"),
        (None, ("--period-order", "1.3"), "give the order of the force by --period-order"),
    ),
)
def test_what_is_no_loose_gear_is_refused(
    change, options, words, bench: Bench, measured, tmp_path: Path
) -> None:
    (tmp_path / "bench.nml").write_text(INPUT)
    if change is None:
        (tmp_path / "bench.csv").symlink_to(measured / "bench.csv")
    else:
        bench.write(tmp_path / "bench.csv", change=change)
    code, _, complained = measure(tmp_path, *options)
    assert code == 2 and words in complained and "Traceback" not in complained
    assert not (tmp_path / "bench.json").exists()


def test_channels_must_be_two_encoders_at_one_speed(bench: Bench, measured: Path, tmp_path: Path) -> None:
    code, _, complained = measure(measured, channels=("loose", "loose"))
    assert code == 2 and "two encoders are two channels" in complained
    # A speed that rises by a tenth over the recording.
    time = bench.time - bench.time[0]
    faster = time + 0.05 * time**2 / time[-1]
    (tmp_path / "bench.nml").write_text(INPUT)
    bench.write(
        tmp_path / "bench.csv", change=lambda a, b: (np.interp(faster, time, a), np.interp(faster, time, b))
    )
    code, _, complained = measure(tmp_path, "--part", "0,1")
    assert code == 2 and "at a steady speed" in complained


def test_lines_of_pulses_are_encoders_too(bench: Bench, tmp_path: Path) -> None:
    """Sines of 400 and 1000 lines a revolution, without steps: no noise, but few lines a period."""
    driver, loose = bench.angles()
    columns = [bench.time - bench.time[0], np.sin(400.0 * driver), np.sin(1000.0 * loose)]
    head = "time [s],driver [V],loose [V]"
    path = tmp_path / "bench.csv"
    np.savetxt(path, np.column_stack(columns), delimiter=",", fmt="%.7g", header=head, comments="")
    (tmp_path / "bench.nml").write_text(INPUT)
    code, said, complained = measure(tmp_path, "--lines", "400,1000")
    assert code == 0 and "147 samples or lines a period" in said, complained
    found = reported(tmp_path)
    assert found["play"]["value"] == pytest.approx(1e-4, rel=0.01)
    assert found["drag_over_inertia"]["value"] == pytest.approx(ratio(bench), rel=0.03)


def test_a_campaign_is_no_input_of_a_motion(measured: Path) -> None:
    campaign = (
        "&campaign vary = 'gear.backlash', first = 1e-4, last = 2e-4, count = 2, record = 'verdict' /\n"
    )
    (measured / "map.nml").write_text(
        INPUT.split("&spectrum")[0].replace("name = 'bench'", "task = 'campaign'") + campaign
    )
    code, _, complained = called_here("calibrate.py", "map.nml", "bench.json", cwd=measured)
    assert code == 2 and "the input of a campaign; that of a motion is needed" in complained


def test_other_files_are_not_calibrated(measured: Path) -> None:
    for text, words in (("{", "is not a file of"), ('{"form": "x"}', "its form is not")):
        (measured / "other.json").write_text(text)
        code, _, complained = called_here("calibrate.py", "bench.nml", "other.json", cwd=measured)
        assert code == 2 and words in complained and "Traceback" not in complained
    code, _, complained = called_here(
        "calibrate.py",
        "bench.nml",
        "bench.json",
        "--second",
        "gear.backlash",
        "--second-range",
        "1,2",
        cwd=measured,
    )
    assert code == 2 and "leave --key, --second and --output out" in complained
