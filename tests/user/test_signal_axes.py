"""The axis of a recorded signal is evidence: what it spans fits the keys, or is refused with both numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

import rattle as package

# A force of 600 Hz, and a shaft of 800 1/min whose cycle takes two revolutions: 0.15 s.
FREQUENCY, SPEED, CYCLE = 600.0, 800.0, 0.15
LOAD = {"force_amplitude": None, "steady_force": "190.0"}
FORCE_ORDERS = ((1, 150.0, 0.0), (2, 60.0, 0.7), (3, 25.0, -1.2))
SHAFT_ORDERS = ((1.5, 120.0, 0.4), (2.0, 600.0, -1.0))
SOLVER = {"method": "'taylor'", "steps_per_period": None, "periods": "4"}
CUT_CYCLES = "cut whole cycles out: scripts/recording.py cycle.csv --cycle-revolutions 1"
GEAR = """
&gear
   teeth_1 = 11, teeth_2 = 38, normal_module = 2.5e-3, helix_angle_deg = 28.96, face_width = 0.016
   loose_inertia = 1.715e-3, drag_torque = 0.10, backlash = 1e-4
/
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 40.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver periods = 4, starts = 1, accuracy = 1e-6 /
&spectrum periods = 2 /
&output directory = 'results' /
"""


def force(phase: np.ndarray) -> np.ndarray:
    """What the file of a force holds at parts of its cycle [N]."""
    return sum(a * np.cos(2.0 * np.pi * n * phase + phi) for n, a, phi in FORCE_ORDERS)


def motion(phase: np.ndarray) -> np.ndarray:
    """The angular acceleration of the shaft at parts of its cycle of two revolutions [rad/s2]."""
    return sum(a * np.cos(4.0 * np.pi * n * phase + phi) for n, a, phi in SHAFT_ORDERS)


def steps(count: int, step: float, start: float = 0.0) -> np.ndarray:
    return start + step * np.arange(count)


def spread(count: int, span: float, start: float = 0.0) -> np.ndarray:
    """So many samples over a span, whose end is the first that is not there."""
    return steps(count, span / count, start)


@dataclass
class Recording:
    """A file with a signal of whole cycles by the axis given, and the keys beside it."""

    axis: np.ndarray
    name: str = "time_s"
    group: str = "load"
    cycles: float = 1.0
    keys: dict[str, str] = field(default_factory=dict)
    digits: str = "{!r}"

    def text(self) -> str:
        shape = force if self.group == "load" else motion
        samples = shape(self.cycles * np.arange(len(self.axis)) / len(self.axis))
        rows = [
            f"{self.digits.format(float(x))},{float(y)!r}\n" for x, y in zip(self.axis, samples, strict=True)
        ]
        return f"{self.name},signal\n" + "".join(rows)


def shaft(axis: np.ndarray, name: str, cycles: float = 1.0, **keys: str) -> Recording:
    return Recording(axis, name, "shaft", cycles, keys)


def load(axis: np.ndarray, name: str, cycles: float = 1.0, **keys: str) -> Recording:
    return Recording(axis, name, "load", cycles, keys)


def gear_text(keys: dict[str, str]) -> str:
    keys = {"speed_rpm": str(SPEED)} | keys
    return f"&shaft {', '.join(f'{key} = {value}' for key, value in keys.items())} /\n{GEAR}"


@pytest.fixture
def write(scene_text, tmp_path: Path):
    """Write an input with a signal and its file."""

    def call(group: str, text: str | bytes, keys: dict[str, str] | None = None) -> None:
        (tmp_path / "cycle.csv").write_bytes(text.encode() if isinstance(text, str) else text)
        signal = {"signal": "'cycle.csv'"} | (keys or {})
        scene = scene_text(load=LOAD | signal, solver=SOLVER) if group == "load" else gear_text(signal)
        (tmp_path / "scene.nml").write_text(scene)

    return call


# What is wrong: the recording, what its axis says, what the keys say, and what would mend it.
PERIOD = 1.0 / FREQUENCY
WRONG = {
    "half a period": (
        load(spread(90, PERIOD / 2), "time_s"),
        "8.333333E-4 s",
        "0.001666667 s",
        "it holds no whole cycle: record more",
    ),
    "a period and a half": (
        load(spread(90, 1.5 * PERIOD), "time_s"),
        "0.0025 s",
        "0.001666667 s",
        f"{CUT_CYCLES} --speed-near 36000 --output",
    ),
    "a period and two thirds": (
        load(spread(90, 5 * PERIOD / 3), "time"),
        "0.002777778 s",
        "0.001666667 s",
        f"{CUT_CYCLES} --speed-near 36000 --output",
    ),
    "one sample less": (
        load(steps(89, PERIOD / 90), "time_s"),
        "0.001648148 s",
        "0.001666667 s",
        "it holds no whole cycle: record more",
    ),
    "two samples more": (
        load(steps(92, PERIOD / 90), "time_s"),
        "0.001703704 s",
        "0.001666667 s",
        f"{CUT_CYCLES} --speed-near 36000 --output",
    ),
    "its end repeats its start": (
        load(steps(91, PERIOD / 90), "t"),
        "0.001685185 s",
        "0.001666667 s",
        "leave line 92 out",
    ),
    "ten periods and their end": (
        load(steps(901, PERIOD / 90), "t"),
        "0.01668519 s",
        "0.001666667 s",
        "leave line 902 out",
    ),
    "0.6 of a sample more": (
        load(spread(90, PERIOD * 90.6 / 90), "time_s"),
        "0.001677778 s",
        "0.001666667 s",
        f"{CUT_CYCLES} --speed-near 36000 --output",
    ),
    "milliseconds without a unit": (
        load(spread(90, 1e3 * PERIOD), "time"),
        "1.666667 s",
        "0.001666667 s",
        "name it time_ms",
    ),
    "microseconds without a unit": (
        load(spread(90, 1e6 * PERIOD), "time"),
        "1666.667 s",
        "0.001666667 s",
        "name it time_us",
    ),
    "parts of the cycle": (load(spread(90, 1.0), "time"), "1 s", "0.001666667 s", "frequency = "),
    "milliseconds called seconds": (
        load(spread(90, 1e3 * PERIOD), "time [s]"),
        "1.666667 s",
        "0.001666667 s",
        "--output",
    ),
    "seconds called milliseconds": (
        load(spread(90, PERIOD), "time [ms]"),
        "0.001666667 ms",
        "1.666667 ms",
        "it holds no whole cycle: record more",
    ),
    "half a period in ms": (
        load(spread(90, 500 * PERIOD), "time (ms)"),
        "0.8333333 ms",
        "1.666667 ms",
        "it holds no whole cycle: record more",
    ),
    "two periods, three asked for": (
        load(spread(180, 2 * PERIOD), "time_s", 2, signal_cycles="3"),
        "0.003333333 s",
        "are 0.005 s",
        "signal_cycles = 2 fits",
    ),
    "one period, two asked for": (
        load(spread(90, PERIOD), "time_s", signal_cycles="2"),
        "0.001666667 s",
        "are 0.003333333 s",
        "signal_cycles = 1 fits",
    ),
    "two periods, one asked for": (
        load(spread(180, 2 * PERIOD), "time_s", 2, signal_cycles="1"),
        "0.003333333 s",
        "are 0.001666667 s",
        "signal_cycles = 2 fits",
    ),
    "ten periods that are 9.93": (
        load(spread(900, 9.93 * PERIOD), "time_s", 10),
        "0.01655 s",
        "0.001666667 s",
        f"{CUT_CYCLES} --speed-near 36000 --output",
    ),
    "ten periods in 903 samples": (
        load(spread(903, 10 * PERIOD), "time_s", 10),
        "903 samples",
        "90.3",
        "signal_cycles",
    ),
    "no axis, a count not divisible": (
        load(np.arange(91.0), "count", 10, signal_cycles="10", signal_column="'signal'"),
        "91 samples",
        "9.1",
        "signal_cycles",
    ),
    "no axis, cycles of three samples": (
        load(np.arange(90.0), "count", 30, signal_cycles="30", signal_column="'signal'"),
        "90 samples",
        "needs 4",
        "signal_cycles = 30",
    ),
    "a crank angle of a force": (
        load(spread(720, 720.0), "crank angle [deg]"),
        "720 deg",
        "360 deg",
        "signal_cycles = 1 if",
    ),
    "half a turn of a force": (load(spread(180, 180.0), "angle_deg"), "180 deg", "360 deg", "signal_cycles"),
    "a force of one turn, two cycles asked for": (
        load(spread(360, 360.0), "angle_deg", 2, signal_cycles="2"),
        "360 deg",
        "are 720 deg",
        "signal_cycles",
    ),
    "one revolution for two": (
        shaft(spread(360, 360.0), "angle_deg", 0.5),
        "360 deg",
        "720 deg",
        "cycle_revolutions = 1 if that is what a cycle of it takes",
    ),
    "one revolution for two, of radians": (
        shaft(spread(360, 2 * np.pi), "angle [rad]", 0.5),
        "6.283185 rad",
        "12.56637 rad",
        "cycle_revolutions = 1 if that is what a cycle of it takes",
    ),
    "one revolution for two, unit unsaid": (
        shaft(spread(360, 360.0), "angle", 0.5),
        "360 deg",
        "720 deg",
        "cycle_revolutions = 1 if that is what a cycle of it takes",
    ),
    "one revolution for two, in revolutions": (
        shaft(spread(360, 1.0), "angle_rev", 0.5),
        "1 rev",
        "2 rev",
        "cycle_revolutions = 1 if that is what a cycle of it takes",
    ),
    "three revolutions for two": (
        shaft(spread(540, 1080.0), "angle_deg", 1.5),
        "1080 deg",
        "720 deg",
        "cycle_revolutions = 3 if that is what a cycle of it takes",
    ),
    "two revolutions for three": (
        shaft(spread(360, 720.0), "angle_deg", cycle_revolutions="3"),
        "720 deg",
        "1080 deg",
        "cycle_revolutions = 2 if that is what a cycle of it takes",
    ),
    "two and a half revolutions": (
        shaft(spread(450, 900.0), "angle_deg", 1.25),
        "900 deg",
        "720 deg",
        "cut whole cycles out: scripts/recording.py cycle.csv --cycle-revolutions 2 --output",
    ),
    "both ends of a cycle": (shaft(steps(721, 1.0), "angle_deg"), "721 deg", "720 deg", "leave line 722 out"),
    "both ends of three cycles": (
        shaft(steps(2161, 1.0), "angle_deg", 3),
        "2161 deg",
        "720 deg",
        "leave line 2162 out",
    ),
    "a sample is missing at the end": (
        shaft(steps(719, 1.0), "angle_deg"),
        "719 deg",
        "720 deg",
        "it holds no whole cycle: record more",
    ),
    "radians called degrees": (
        shaft(spread(720, 4 * np.pi), "angle_deg"),
        "12.56637 deg",
        "720 deg",
        "cycle_revolutions",
    ),
    "degrees called radians": (
        shaft(spread(720, 720.0), "angle_rad"),
        "720 rad",
        "12.56637 rad",
        "cycle_revolutions",
    ),
    "degrees or radians": (
        shaft(spread(27 * 1547, 27 * 720.0), "angle", 27),
        "fits in degrees",
        "and in radians",
        "angle_deg or angle_rad",
    ),
    "an unknown unit": (
        shaft(spread(800, 800.0), "angle [gon]"),
        "'angle [gon]'",
        "deg, rad and rev",
        "unit",
    ),
    "a time of one revolution": (
        shaft(spread(360, CYCLE / 2), "time_s", 0.5),
        "0.075 s",
        "0.15 s",
        "cycle_revolutions = 1 if",
    ),
    "a time of three revolutions": (
        shaft(spread(540, 1.5 * CYCLE), "time_s", 1.5),
        "0.225 s",
        "0.15 s",
        "--cycle-revolutions 2 --speed-near 800 --output cycle_cycle.csv",
    ),
    "another speed": (
        shaft(spread(720, 120.0 / 850.0), "time_s"),
        "0.1411765 s",
        "0.15 s",
        "it holds no whole cycle: record more",
    ),
    "a speed hardly another": (
        shaft(spread(720, 120.0 / 801.0), "time_s"),
        "0.1498127 s",
        "0.15 s",
        "it holds no whole cycle: record more",
    ),
    "cycles that cannot be counted": (
        shaft(spread(2160, 3 * CYCLE), "time_s", 3, signal_cycles="2"),
        "0.45 s",
        "are 0.3 s",
        "signal_cycles = 3 fits",
    ),
    "milliseconds of a shaft": (
        shaft(spread(720, 1e3 * CYCLE), "time"),
        "150 s",
        "0.15 s",
        "name it time_ms",
    ),
    "revolutions as cycles": (
        shaft(spread(360, 720.0), "angle_deg", 1, signal_cycles="2"),
        "720 deg",
        "are 1440 deg",
        "signal_cycles = 1 fits",
    ),
    # The count fits, but what is recorded has another period.
    "ten periods for twelve": (
        load(spread(1200, 12 * PERIOD), "time_s", 10),
        "12 cycles",
        "1.73",
        "signal_cycles and frequency",
    ),
    "two cycles cut into three": (
        load(np.arange(180.0), "count", 2, signal_cycles="3", signal_column="'signal'"),
        "3 cycles",
        "0.866",
        "signal_cycles and frequency",
    ),
    "cycles that drift": (
        load(np.arange(900.0), "count", 9.95, signal_cycles="10", signal_column="'signal'"),
        "10 cycles",
        "half a sample",
        "signal_cycles and frequency",
    ),
}
# What is wrong with the axis itself: its name and numbers, and what is reported of them.
CROOKED = {
    "descending": ("time_s", spread(90, PERIOD)[::-1], ":3: the axis descends: after 0.001648"),
    "a doubled line": ("time_s", np.insert(spread(89, PERIOD), 40, spread(89, PERIOD)[40]), "not uniform"),
    "a missing line": ("angle_deg", np.delete(steps(361, 1.0), 180), "not uniform"),
    "a missing line of whole numbers": ("time_ms", np.delete(steps(91, 2.0), 45), "not uniform"),
    "a gap": ("time_s", np.append(spread(80, PERIOD), 2 * PERIOD), "not uniform"),
    "growing steps": ("time_s", PERIOD * (np.arange(90) / 90) ** 1.5, "not uniform"),
    "one value": ("time_s", np.zeros(90), "not uniform: after 0 comes 0"),
    "it begins anew": ("time_s", np.tile(spread(45, PERIOD / 2), 2), "axis descends"),
    "too few digits": ("time_s", np.round(spread(90, PERIOD), 4), "too few digits to show it"),
    "too large": ("time_s", 1e200 * spread(90, PERIOD), "that is no axis"),
}


@pytest.mark.parametrize("case", WRONG)
def test_an_axis_that_does_not_fit_is_refused(case: str, write, refused) -> None:
    recording, of_axis, of_keys, remedy = WRONG[case]
    write(recording.group, recording.text(), recording.keys)
    (fault,) = refused("--check", "scene.nml")
    assert fault.startswith("cycle.csv:")
    for words in (of_axis, of_keys, remedy):
        assert words in fault, fault


@pytest.mark.parametrize("case", CROOKED)
def test_an_axis_that_is_none_is_refused(case: str, write, refused) -> None:
    name, axis, words = CROOKED[case]
    write("load", load(axis, name).text())
    (fault,) = refused("--check", "scene.nml")
    assert words in fault, fault


def as_lines(
    recording: Recording, head: str = "", end: str = "\n", quote: str = "", blank: str = ""
) -> bytes:
    lines = recording.text().splitlines()
    lines = [",".join(f"{quote}{word}{quote}" for word in line.split(",")) for line in lines]
    return (head + (end + blank).join(lines) + end).encode()


ONE = load(spread(90, PERIOD), "time_s")


def kilonewtons() -> str:
    """The same with semicolons, decimal commas and a row of units of its own, as a bench writes it."""
    rows = [line.split(",") for line in ONE.text().splitlines()[1:]]
    lines = [f"{1e3 * float(time)!r};{1e-3 * float(value)!r}" for time, value in rows]
    return "t;signal\n[ms];[kN]\n" + "\n".join(lines).replace(".", ",") + "\n"


JITTER = np.random.default_rng(48).uniform(-0.095, 0.095, 90) * PERIOD / 90
RIGHT = {
    "seconds": ONE,
    "jitter": load(spread(90, PERIOD) + JITTER, "time_s"),
    "seconds unsaid": load(spread(90, PERIOD), "time"),
    "t": load(spread(90, PERIOD), "t"),
    "brackets": load(spread(90, PERIOD), "Time [s]"),
    "milliseconds": load(spread(90, 1e3 * PERIOD), "time [ms]"),
    "microseconds": load(spread(90, 1e6 * PERIOD), "time (µs)"),
    "minutes": load(spread(90, PERIOD / 60), "time_min"),
    "words behind": load(spread(90, PERIOD), "elapsed time / s"),
    "it begins later": load(spread(90, PERIOD, start=12.5), "time_s"),
    "it begins before": load(spread(90, PERIOD, start=-PERIOD / 3), "time_s"),
    "few digits": Recording(spread(90, PERIOD), digits="{:.6f}"),
    "few significant digits": Recording(spread(90, PERIOD), digits="{:.4g}"),
    "exponents": Recording(spread(90, PERIOD), digits="{:.6e}"),
    "0.4 of a sample more": load(spread(90, PERIOD * 90.4 / 90), "time_s"),
    "turns of the force": load(spread(90, 360.0), "angle_deg"),
    "radians unsaid of the force": load(spread(90, 2 * np.pi), "phase"),
    "two periods": load(spread(180, 2 * PERIOD), "time_s", 2),
    "ten periods": load(spread(900, 10 * PERIOD), "time_s", 10),
    "ten periods asked for": load(spread(900, 10 * PERIOD), "time_s", 10, signal_cycles="10"),
    "ten periods without an axis": load(
        np.arange(900.0), "count", 10, signal_cycles="10", signal_column="'signal'"
    ),
    "two turns that are a cycle": load(spread(90, 720.0), "angle_deg", signal_cycles="1"),
    "four turns that are two cycles": load(spread(180, 1440.0), "angle_deg", 2, signal_cycles="2"),
    "degrees": shaft(spread(180, 720.0), "angle_deg"),
    "degrees unsaid": shaft(spread(180, 720.0), "angle"),
    "a sign of degrees": shaft(spread(180, 720.0), "crank angle [°CA]"),
    "radians": shaft(spread(180, 4 * np.pi), "angle (rad)"),
    "radians unsaid": shaft(spread(180, 4 * np.pi), "angle"),
    "revolutions": shaft(spread(180, 2.0), "angle_rev"),
    "degrees from behind": shaft(spread(180, 720.0, start=-360.0), "crank_angle"),
    "seconds of a shaft": shaft(spread(180, CYCLE), "time_s"),
    "milliseconds of a shaft": shaft(spread(180, 1e3 * CYCLE), "time_ms"),
    "three cycles of a shaft": shaft(spread(540, 3 * 720.0), "angle_deg", 3),
    "three cycles of a shaft in time": shaft(spread(540, 3 * CYCLE), "time_s", 3),
    "three cycles of a shaft asked for": shaft(spread(540, 3 * 720.0), "angle_deg", 3, signal_cycles="3"),
    "six cycles of four revolutions": shaft(spread(1080, 6 * 720.0), "angle_deg", 6, cycle_revolutions="4"),
}
DRESSES = {
    "a mark of UTF-8": as_lines(ONE, head="\ufeff"),
    "lines of Windows": as_lines(ONE, end="\r\n"),
    "empty lines": as_lines(ONE, blank="\n"),
    "comments": as_lines(ONE, head="# bench 7\n\n# 2026\n"),
    "everything in quotes": as_lines(ONE, quote='"'),
    "blanks": ONE.text().replace(",", " , ").encode(),
    "semicolons": ONE.text().replace(",", ";").encode(),
    "decimal commas": ONE.text().replace(",", ";").replace(".", ",").encode(),
    "a row of units": ONE.text().replace("\n", "\ns,N\n", 1).encode(),
    "kilonewtons": kilonewtons().encode(),
    "the end of a file of DOS": (ONE.text() + "\x1a").encode(),
    "no end of the last line": ONE.text().rstrip("\n").encode(),
    "further columns": "".join(
        f"{line},{'note' if i == 0 else 'x'}\n" for i, line in enumerate(ONE.text().splitlines())
    ).encode(),
}


@pytest.fixture(scope="module")
def by_hand(run, scene_text, tmp_path_factory):
    """The summaries of the scenes whose orders are given."""
    folder = tmp_path_factory.mktemp("by_hand")
    orders = {
        key: ", ".join(str(order[i]) for order in FORCE_ORDERS)
        for i, key in enumerate(("force_orders", "force_amplitudes", "force_phases"))
    }
    (folder / "load.nml").write_text(scene_text(load=LOAD | orders, solver=SOLVER))
    keys = {
        key: ", ".join(str(order[i]) for order in SHAFT_ORDERS)
        for i, key in enumerate(("orders", "accelerations", "phases"))
    }
    (folder / "shaft.nml").write_text(gear_text(keys))
    found = {}
    for group in ("load", "shaft"):
        ended = run(f"{group}.nml", cwd=folder)
        assert (ended.returncode, ended.stderr) == (0, ""), ended
        found[group] = summary_of(folder / "results" / f"{group}.summary.nml")
    return found


def assert_solved_as(expected: dict, run, folder: Path) -> None:
    ended = run("scene.nml", cwd=folder)
    assert (ended.returncode, ended.stderr) == (0, ""), ended
    summary = summary_of(folder / "results" / "scene.summary.nml")
    for name in (
        "steady_film",
        "film_minimum",
        "film_maximum",
        "acceleration_minimum",
        "acceleration_maximum",
    ):
        assert summary[name] == pytest.approx(expected[name], rel=1e-7), name


@pytest.mark.parametrize("case", RIGHT)
def test_a_recording_in_any_dress_is_its_orders(case: str, write, run, by_hand, tmp_path: Path) -> None:
    recording = RIGHT[case]
    write(recording.group, recording.text(), recording.keys)
    assert_solved_as(by_hand[recording.group], run, tmp_path)


@pytest.mark.parametrize("case", DRESSES)
def test_a_file_in_any_dress_is_its_orders(case: str, write, run, by_hand, tmp_path: Path) -> None:
    keys = {"signal_column": "'signal'"} if case == "further columns" else None
    write("load", DRESSES[case], keys)
    assert_solved_as(by_hand["load"], run, tmp_path)


def test_the_scatter_of_cycles_is_reported(write, run, tmp_path: Path) -> None:
    """In --check, the log and the resolved input, as a share of what oscillates of the mean."""
    count, cycles, noise = 90, 10, 12.0
    one = force(np.arange(count) / count)
    # Cycles that are off by a level of their own, whose mean is none.
    levels = noise * np.array([1.0, -1.0] * (cycles // 2))
    samples = (levels[:, None] + one[None, :]).ravel()
    rows = "".join(f"{i * PERIOD / count!r},{float(x)!r}\n" for i, x in enumerate(samples))
    write("load", "time_s,signal\n" + rows)
    reported = 100.0 * noise / math.sqrt(sum(0.5 * a**2 for _, a, _ in FORCE_ORDERS))
    for options, file in ((("--check",), None), ((), "scene.log")):
        ended = run(*options, "scene.nml", cwd=tmp_path)
        assert (ended.returncode, ended.stderr) == (0, "")
        text = ended.stdout if file is None else (tmp_path / "results" / file).read_text()
        (line,) = (line for line in text.splitlines() if "column 'signal'" in line)
        assert "900 samples; in 10 cycles of 90, whose rms deviation from their mean is " in line
        assert float(line.split("from their mean is ")[1].split(" %")[0]) == pytest.approx(reported, rel=5e-3)
        assert line.endswith("10 cycles: by its axis 'time_s' in s")
        if file is None:
            assert "\n! derived: load.signal_cycles = 10\n" in text
            (line,) = (line for line in text.splitlines() if "load.signal_scatter" in line)
            assert float(line.split(" = ")[1]) == pytest.approx(reported / 100.0, rel=5e-5)
    result = package.read(tmp_path / "results" / "scene.rattle")
    assert result.input["load"]["force_amplitudes"] == pytest.approx([a for _, a, _ in FORCE_ORDERS])


def test_noisy_cycles_are_averaged(write, run, tmp_path: Path) -> None:
    """Chance is no drift: forty cycles with noise of a fifth are taken, and their mean is near."""
    generator = np.random.default_rng(29)
    count, cycles = 90, 40
    samples = np.tile(force(np.arange(count) / count), cycles)
    samples = samples + 0.2 * np.std(samples) * generator.standard_normal(samples.size)
    rows = "".join(f"{i * PERIOD / count!r},{float(x)!r}\n" for i, x in enumerate(samples))
    write("load", "time_s,signal\n" + rows, {"signal_orders": "3"})
    ended = run("scene.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    kept = package.read(tmp_path / "results" / "scene.rattle").input["load"]["force_amplitudes"]
    # An amplitude of a harmonic is off by noise*sqrt(2/samples): 0.55 N here; four times that is allowed.
    assert kept == pytest.approx([a for _, a, _ in FORCE_ORDERS], abs=4 * 0.2 * 116.0 * math.sqrt(2 / 3600))


@pytest.mark.parametrize("way", ["..", "absolute", "link", "link of a folder", "link and back"])
def test_a_signal_outside_the_folder_of_the_input_is_refused(way: str, write, run, tmp_path: Path) -> None:
    outside, inside = tmp_path / "outside", tmp_path / "inside"
    outside.mkdir()
    inside.mkdir()
    (outside / "secret.csv").write_text(ONE.text())
    write("load", ONE.text())
    path = {
        "..": "../outside/secret.csv",
        "absolute": str(outside / "secret.csv"),
        "link": "link.csv",
        "link of a folder": "folder/secret.csv",
        "link and back": "folder/../outside/secret.csv",
    }[way]
    (inside / "link.csv").symlink_to(outside / "secret.csv")
    (inside / "folder").symlink_to(outside)
    text = (tmp_path / "scene.nml").read_text().replace("'cycle.csv'", f"'{path}'")
    (inside / "scene.nml").write_text(text)
    for folder in (inside, tmp_path):
        ended = run("--check", (inside / "scene.nml").relative_to(folder), cwd=folder)
        assert ended.returncode == 2
        (fault,) = ended.stderr.splitlines()
        assert "&load signal: the file lies outside the folder of this input" in fault
    # The working directory is the folder of an input that comes from standard input.
    ended = run("--check", "-", cwd=inside, stdin=text)
    assert ended.returncode == 2 and "outside the folder" in ended.stderr


def test_a_signal_below_the_folder_is_taken(write, run, tmp_path: Path) -> None:
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "cycle.csv").write_text(ONE.text())
    write("load", "", {"signal": "'data/../data/cycle.csv'"})
    for path in ("data/../data/cycle.csv", str(tmp_path / "data" / "cycle.csv")):
        ended = run("--check", "--set", f"load.signal='{path}'", "scene.nml", cwd=tmp_path)
        assert (ended.returncode, ended.stderr) == (0, ""), ended


@pytest.mark.parametrize(
    "text",
    [
        "root:x:0:0:root:/root:/bin/bash\ndaemon:x:1:1:daemon:/usr/sbin:/bin/false\n",
        "root,secret\nbob,hidden\n" * 4,
        "-----BEGIN KEY-----\nAAAA,secret,BBBB\nhidden\n",
        "password = secret; hidden\n" * 3,
        "time,signal\n0,secret\n1,hidden\n2,3\n3,4\n",
        "\tsecret\thidden\nroot\n",
    ],
)
def test_no_line_of_a_foreign_file_is_quoted(text: str, write, refused) -> None:
    for column in ({}, {"signal_column": "'other'"}, {"signal_column": "'root'"}):
        write("load", text, column)
        for fault in refused("--check", "scene.nml"):
            assert fault.startswith("cycle.csv:")
            reported = fault
            for word in ("other", "root"):
                reported = reported.replace(f"column '{word}'", "").replace(f"--signal {word} ", "")
            assert not [word for word in ("secret", "hidden", "root", "KEY", "bob") if word in reported], (
                fault
            )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (ONE.text().replace(",", ";", 1), "cycle.csv:2: the line has 1 columns, the header 2"),
        (ONE.text().replace(".", ","), "decimal commas are read only where semicolons separate the columns"),
        (ONE.text().replace(",", "\t"), "cycle.csv:1: tabs separate the columns"),
        (ONE.text().split("\n", 1)[1], "cycle.csv:1: the first line holds numbers; it must name the columns"),
        (
            ONE.text().replace("\n", "\nold,new\n", 1),
            "cycle.csv:2: column 2: this is not a number; below the names one row may hold units",
        ),
        (ONE.text().replace("\n", "\r"), "cycle.csv:1: carriage returns alone end its lines"),
    ],
)
def test_one_cause_has_one_fault(text: str, words: str, write, refused) -> None:
    write("load", text)
    (fault,) = refused("--check", "scene.nml")
    assert words in fault
