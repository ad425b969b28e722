"""Recordings with a known truth become mean cycles that rattle takes, whatever the bench writes them as."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path

import bench_recordings as bench
import f90nml
import numpy as np
import pytest
from script_calls import called_here

from rattle import recordings
from rattle.recordings import mending

# What the orders of a recording may be off by: the aim is 0.5 % and 1 degree.
AMPLITUDE, PHASE = 0.005, 1.0
RPM = np.pi / 30.0
ENGINE = bench.Bench()
TIME = bench.times(ENGINE.span, 1000.0)
SPEED = ENGINE.speed_rpm(TIME)


@pytest.fixture
def cycle(tmp_path: Path, run, repository: Path) -> Callable[..., Mapping]:
    """Call recording.py, put what it prints into engine_cycle.nml, and return what rattle makes of it."""

    def call(*arguments: object, said: str = "", warned: str = "") -> Mapping:
        output = tmp_path / "cycle.csv"
        ended = called_here("recording.py", *arguments, "--output", output, "--overwrite", cwd=tmp_path)
        assert ended[0] == 0, ended
        assert said in ended[1] and bool(ended[2]) == bool(warned) and warned in ended[2], ended
        lines = ended[1][ended[1].index("For the input:") :].partition("\n\n")[2]
        text = (repository / "input" / "engine_cycle.nml").read_text()
        (tmp_path / "engine.nml").write_text(re.sub(r"&shaft.*?^/\n", lines, text, flags=re.M | re.S))
        checked = run("--check", "engine.nml", cwd=tmp_path)
        assert (checked.returncode, checked.stderr) == (0, ""), checked
        return f90nml.reads(checked.stdout)["shaft"]

    return call


def assert_orders(shaft: Mapping, *, shift: float = 0.0, mean: float = 812.7, loose: float = 1.0) -> None:
    """The orders of rattle are those of the bench; `shift` [rad] is where the cycle begins on the shaft."""
    assert shaft["speed_rpm"] == pytest.approx(mean, rel=1e-3)
    found = dict(
        zip(shaft["orders"], zip(shaft["speed_amplitudes"], shaft["phases"], strict=True), strict=True)
    )
    for order, (amplitude, phase) in bench.ORDERS.items():
        size, angle = found[order]
        assert size == pytest.approx(amplitude * ENGINE.mean * RPM, rel=loose * AMPLITUDE), order
        off = np.degrees(np.angle(np.exp(1j * (angle - phase - order * shift))))
        # A tacho does not show in which of the two turns of a cycle the recording begins.
        off = min(abs(off), abs(abs(off) - 180.0)) if shift and order % 1.0 else abs(off)
        assert off < loose * PHASE, (order, off)


DAMAGED = np.sort(TIME + 4e-4 * np.random.default_rng(4).uniform(-1.0, 1.0, len(TIME)))
DAMAGED[0] = 0.0
ABOVE = "Test bench 7;cell 3\nengine: idle, 812 rpm\n\n"


def text_of(name: str, folder: Path) -> tuple[Path, str]:
    """A file of a variant, and what must be said of it."""
    path = folder / "bench.csv"
    heads, pairs = ("time_s", "speed_rpm"), (TIME, SPEED)
    semicolons = {"separator": ";", "decimal": ","}
    if name == "plain":
        return bench.csv(path, heads, pairs), "25 whole cycles of 2 revolutions; 1.14"
    if name == "jitter of the stamps":
        stamps = TIME + 0.05e-3 * np.random.default_rng(2).uniform(-1.0, 1.0, len(TIME))
        return bench.csv(path, heads, (stamps, SPEED)), "jitter by at most"
    if name == "not uniform":
        return bench.csv(path, heads, (DAMAGED, ENGINE.speed_rpm(DAMAGED))), "are not uniform"
    if name == "semicolons and decimal commas":
        return bench.csv(path, heads, pairs, **semicolons), "decimal commas"
    if name == "a row of units":
        return bench.csv(path, ("t", "n"), pairs, units=("s", "1/min")), "'n' is in 1/min"
    if name == "latin-1, heads, units":
        options = {"above": ABOVE, "encoding": "latin-1", "units": ("[ms]", "[U/min]"), **semicolons}
        return bench.csv(path, ("Zeit", "Drehzahl \xfc"), (1e3 * TIME, SPEED), **options), "latin-1"
    if name == "mark of the encoding, tabs, comments":
        options = {"separator": "\t", "encoding": "utf-8-sig", "above": "# idle\n# cell 3\n"}
        return bench.csv(path, ("time [s]", "speed [rad/s]"), (TIME, SPEED * RPM), **options), "from rad/s"
    if name == "gaps":
        speed = SPEED.copy()
        speed[[500, 501, 1700]] = np.nan
        return bench.csv(path, heads, (TIME, speed)), "has 2 gaps"
    if name == "repeated stamps":
        time = np.floor(TIME * 250.0) / 250.0
        return bench.csv(path, heads, (time, SPEED), digits=(".3f", ".4f")), "too few digits"
    raise AssertionError(name)


VARIANTS = (
    *("plain", "jitter of the stamps", "not uniform", "semicolons and decimal commas", "a row of units"),
    *("latin-1, heads, units", "mark of the encoding, tabs, comments", "gaps", "repeated stamps"),
)


@pytest.mark.parametrize("name", VARIANTS)
def test_one_speed_as_benches_write_it(cycle, tmp_path: Path, name: str) -> None:
    path, said = text_of(name, tmp_path)
    # Stamps of 4 ms show where a cycle begins to half of that, 10 deg, and no mean of them the phase better.
    shaft = cycle(path, said=said)
    if name == "repeated stamps":
        sizes = dict(zip(shaft["orders"], shaft["speed_amplitudes"], strict=True))
        assert sizes[2.0] == pytest.approx(bench.ORDERS[2.0][0] * ENGINE.mean * RPM, rel=AMPLITUDE)
    else:
        assert_orders(shaft)


def test_a_wheel_with_missing_teeth_is_a_speed(cycle, tmp_path: Path) -> None:
    """The speed from 58 of 60 pulses, sampled at 20 kHz in 12 bits; angle 0 is the tooth behind the gap."""
    time = bench.times(ENGINE.span, 20000.0)
    volts = bench.quantised(ENGINE.wheel(time, 60, 2))
    path = bench.csv(tmp_path / "tacho.csv", ("time_s", "tacho [V]"), (time, volts), digits=(".6f", ".5f"))
    shaft = cycle(path, "--tacho", "tacho", "--pulses", 60, "--missing", 2, said="60-2")
    assert_orders(shaft, shift=0.25 * bench.TURN / 60)


def test_a_force_over_the_pulses_of_a_tacho(tmp_path: Path) -> None:
    """With noise the orders are as sure as their standard errors say."""
    random = np.random.default_rng(5)
    time = bench.times(ENGINE.span, 50000.0)
    volts = ENGINE.wheel(time, 60) + 0.02 * random.normal(size=len(time))
    force = bench.series(bench.FORCE, ENGINE.angle(time)) + 5.0 * random.normal(size=len(time))
    tacho = recordings.Channel("tacho", "V", time, bench.quantised(volts), "bench")
    shaft = recordings.shaft_angle(tacho, pulses_per_revolution=60)
    channel = recordings.Channel("force", "N", time, bench.quantised(force), "bench")
    found = recordings.mean_cycle(channel, shaft, cycle_revolutions=1)
    for order, (amplitude, phase) in bench.FORCE.items():
        place = int(order) - 1
        shifted = phase + order * 0.25 * bench.TURN / 60
        off = np.degrees(np.angle(np.exp(1j * (found.phases[place] - shifted))))
        assert found.amplitudes[place] == pytest.approx(amplitude, rel=AMPLITUDE)
        assert abs(off) < PHASE
        assert abs(found.amplitudes[place] - amplitude) < 5.0 * found.amplitude_errors[place]
    assert found.cycles == 51 and found.kept == 3


def test_angles_by_every_kind_of_channel_agree() -> None:
    time = bench.times(ENGINE.span, 5000.0)
    truth = ENGINE.angle(time)

    def off(channel: recordings.Channel, **options: object) -> float:
        found = recordings.shaft_angle(channel, **options)
        inside = (time > found.time[0]) & (time < found.time[-1])
        difference = found.at(time[inside]) - truth[inside]
        return float(np.std(difference))

    def channel(unit: str, values: np.ndarray) -> recordings.Channel:
        return recordings.Channel("x", unit, time, values, "bench")

    assert off(channel("deg", np.degrees(np.mod(truth, 2.0 * bench.TURN)))) < 1e-9
    assert off(channel("rad", -truth)) < 1e-9
    assert off(channel("rad/s", ENGINE.speed(truth))) < 1e-6
    assert off(channel("Hz", -ENGINE.speed(truth) / bench.TURN)) < 1e-6
    # An encoder of 1024 counts is off by a count, evenly: its standard deviation is that over the root of
    # twelve.
    counted = np.floor(truth / bench.TURN * 1024.0) / 1024.0
    assert off(channel("rev", counted)) < 1.1 * bench.TURN / 1024.0 / np.sqrt(12.0)
    # Edges stand between samples, evenly.
    step = ENGINE.mean * RPM / 5000.0
    wheel = channel("V", ENGINE.wheel(time, 60, 2))
    assert off(wheel, pulses_per_revolution=60, missing_teeth=2) < 1.1 * step / np.sqrt(12.0)


def test_the_speed_of_a_force_is_measured_from_it(tmp_path: Path) -> None:
    """3.777 s at 812.7 1/min are no whole cycles: they are cut, and no speed is bent to fit the recording."""
    steady = bench.Bench(orders={2.0: (0.0, 0.0)})
    random = np.random.default_rng(6)
    force = bench.series(bench.FORCE, steady.angle(TIME)) + 3.0 * random.normal(size=len(TIME))
    path = bench.csv(tmp_path / "force.csv", ("time_s", "force_N"), (TIME, force))
    code, said, _ = called_here("recording.py", path, "--speed-near", 800, "--output", "f.csv", cwd=tmp_path)
    assert code == 0 and "25 whole cycles" in said
    frequency = float(re.search(r"frequency = (\S+)", said)[1])
    assert frequency * 120.0 == pytest.approx(812.7, rel=1e-5)


def test_a_force_goes_into_a_load(tmp_path: Path, run, scene_text) -> None:
    """The lines that are printed, in a scene of the paper's symbols."""
    force = bench.series(bench.FORCE, ENGINE.angle(TIME)) + 20.0
    bench.csv(
        tmp_path / "f.csv", ("time_s", "n_rpm", "force_kN"), (TIME, SPEED, force / 1e3), digits=[".9g"] * 3
    )
    given = ("--signal", "force_kN", "--speed", "n_rpm", "--cycle-revolutions", 1, "--output", "cycle.csv")
    code, said, complained = called_here("recording.py", "f.csv", *given, cwd=tmp_path)
    assert code == 0, complained
    lines = re.search(r"^&load\n(.*)^/", said, re.M | re.S)[1]
    text = scene_text(load={"force_amplitude": None, "frequency": None})
    (tmp_path / "scene.nml").write_text(text.replace("&load\n", f"&load\n{lines}"))
    checked = run("--check", "scene.nml", cwd=tmp_path)
    assert (checked.returncode, checked.stderr) == (0, ""), checked
    load = f90nml.reads(checked.stdout)["load"]
    assert load["frequency"] == pytest.approx(812.52 / 60.0, rel=1e-4)
    assert load["force_orders"] == [1.0, 2.0, 3.0] and load["force_mean"] == pytest.approx(20.0, abs=0.1)
    for found, phased, (amplitude, phase) in zip(
        load["force_amplitudes"], load["force_phases"], bench.FORCE.values(), strict=True
    ):
        assert found == pytest.approx(amplitude, rel=AMPLITUDE)
        assert abs(np.degrees(phased - phase)) < PHASE


def test_drop_outs_of_a_wheel_are_bridged_up_to_a_length(tmp_path: Path) -> None:
    time = bench.times(ENGINE.span, 20000.0)
    volts = ENGINE.wheel(time, 60, 2)
    # Three pulses and, elsewhere, one are lost; one too many comes between two.
    volts[(time > 1.001) & (time < 1.0046)] = 0.0
    volts[(time > 2.5) & (time < 2.5012)] = 0.0
    volts[int(np.flatnonzero((np.diff(volts) > 0.0) & (time[1:] > 3.0))[0]) - 4] = 5.0
    tacho = recordings.Channel("tacho", "V", time, volts, "bench")
    options = {"pulses_per_revolution": 60, "missing_teeth": 2}
    shaft = recordings.shaft_angle(tacho, **options)
    assert any("2 drop-outs, the longest at 1.00" in note for note in shaft.notes), shaft.notes
    assert any(
        "a pulse of 'tacho' too soon behind another left out, first at 3.0" in note for note in shaft.notes
    )
    found = recordings.mean_cycle(None, shaft)
    assert found.amplitudes[3] == pytest.approx(bench.ORDERS[2.0][0] * ENGINE.mean, rel=AMPLITUDE)
    with pytest.raises(recordings.RecordingError, match=r"drops out at 1\.00.* gaps up to 0\.003 s"):
        recordings.shaft_angle(tacho, **options, bridge=0.003)


@pytest.mark.parametrize("value", (0.0, 400.0, 1600.0, 5000.0, 12000.0))
@pytest.mark.parametrize("count", (1, 30))
def test_a_spike_is_reported_and_mended_on_request(
    cycle, repository: Path, tmp_path: Path, value: float, count: int
) -> None:
    """engine_cycle.csv with samples from 100 degrees on replaced: mended it has the orders that it had."""
    lines = (repository / "input" / "engine_cycle.csv").read_text().splitlines()
    whole = cycle(repository / "input" / "engine_cycle.csv")
    for place in range(102, 102 + count):
        lines[place] = f"{lines[place].partition(',')[0]},{value}"
    (tmp_path / "spike.csv").write_text("\n".join(lines) + "\n")
    stem = f"'speed_rpm' is {value:g} 1/min"
    code, _, warned = called_here("recording.py", "spike.csv", "--output", "unmended.csv", cwd=tmp_path)
    assert code == (2 if value == 0.0 else 0) and "--mend replaces" in warned
    assert value == 0.0 or f"warning: {stem}" in warned
    mended = cycle("spike.csv", "--mend", said=stem)
    for before, after in zip(whole["speed_amplitudes"][:24], mended["speed_amplitudes"][:24], strict=True):
        # Of an order whose period is no longer than the gap, as order 12, no one knows what it does there.
        assert after == pytest.approx(before, rel=AMPLITUDE, abs=AMPLITUDE * max(whole["speed_amplitudes"]))


def test_long_drop_outs_take_a_longer_bridge(tmp_path: Path, repository: Path) -> None:
    lines = (repository / "input" / "engine_cycle.csv").read_text().splitlines()
    lines[102:162] = [f"{line.partition(',')[0]},0" for line in lines[102:162]]
    (tmp_path / "engine.csv").write_text("\n".join(lines) + "\n")
    options = ("recording.py", "engine.csv", "--mend", "--output", "mended.csv")
    code, _, complained = called_here(*options, cwd=tmp_path)
    assert code == 2 and "gaps up to 0.01 s are bridged" in complained
    bridge = re.search(r"--bridge ([\d.]+\d)", complained)[1]
    code, said, _ = called_here(*options, "--bridge", bridge, cwd=tmp_path)
    assert code == 0 and "60 samples" in said and "bridged" in said, _


def test_real_impacts_and_pulses_are_no_spikes(repository: Path) -> None:
    """What a signal does often is its course."""
    time = bench.times(2.0, 5000.0)
    ringing = sum(
        np.where(time > t, np.exp(-300.0 * (time - t)) * np.sin(4000.0 * (time - t)), 0.0)
        for t in np.arange(0.0, 2.0, 0.04)
    )
    for values in (ENGINE.wheel(time, 60, 2), ringing, np.sign(np.sin(40.0 * time))):
        notes: list[str] = []
        recordings.mending.mended(recordings.Channel("x", "V", time, values, "x"), mend=False, notes=notes)
        assert notes == []


SCATTER = (
    ("wrong length", "with --cycle-revolutions 2 it would be"),
    ("drift", "the speed drifts from"),
    ("wrong pulses", "check --pulses and --missing"),
    ("noise", "it is noise or unsteady"),
)


@pytest.mark.parametrize(("case", "words"), SCATTER, ids=[case for case, _ in SCATTER])
def test_a_wide_scatter_has_a_likely_cause(case: str, words: str) -> None:
    time = bench.times(ENGINE.span, 2000.0)
    engine, revolutions = ENGINE, 2
    force = {0.5: (30.0, 0.0), 2.0: (100.0, 0.0)}
    if case == "drift":
        engine = bench.Bench(drift=0.1)
    values = bench.series(force, engine.angle(time))
    if case == "wrong length":
        revolutions = 1
    if case == "noise":
        values = values + 40.0 * np.random.default_rng(1).normal(size=len(time))
    if case == "drift":
        # A resonance that the drifting speed passes.
        values = values * (1.0 + 4.0 * (time / time[-1]) ** 2)
    shaft = recordings.shaft_angle(recordings.Channel("n", "rpm", time, engine.speed_rpm(time), "x"))
    if case == "wrong pulses":
        shaft = recordings.ShaftAngle(shaft.time, shaft.angle * 58.5 / 60.0, [], 0.0)
    channel = recordings.Channel("force", "N", time, values, "x")
    found = recordings.mean_cycle(channel, shaft, cycle_revolutions=revolutions)
    assert found.scatter > 0.1 and words in found.warnings[0], found.warnings


def test_a_drift_of_the_speed_is_taken_out_and_warned_of(cycle, tmp_path: Path) -> None:
    """2 % in 3.8 s are more than all orders but one; of the first second they are little."""
    engine = bench.Bench(drift=0.02)
    path = bench.csv(tmp_path / "n.csv", ("time_s", "speed_rpm"), (TIME, engine.speed_rpm(TIME)))
    shaft = cycle(path, said="the drift is taken out", warned="the speed drifts from 812.84 to 828.09 1/min")
    assert_orders(shaft, mean=820.4)
    shaft = cycle(path, "--part", "0,1.0", said="6 whole cycles")
    assert shaft["speed_rpm"] == pytest.approx(814.7, abs=0.5)


def test_no_order_is_folded_back(tmp_path: Path) -> None:
    """Order 40 is beyond what 64 samples a turn hold, as order 24 it would be false."""
    time = bench.times(2.0, 20000.0)
    steady = bench.Bench(orders={2.0: (0.0, 0.0)}, span=2.0)
    values = bench.series({2.0: (10.0, 0.0), 40.0: (5.0, 0.0)}, steady.angle(time))
    shaft = recordings.shaft_angle(recordings.Channel("n", "rpm", time, steady.speed_rpm(time), "x"))
    channel = recordings.Channel("force", "N", time, values, "x")
    found = recordings.mean_cycle(channel, shaft, cycle_revolutions=1, samples_per_revolution=64)
    assert found.orders[-1] == 31.0
    spectrum = 2.0 * np.abs(np.fft.rfft(found.values)) / 64.0
    assert spectrum[2] == pytest.approx(10.0, rel=1e-4) and np.delete(spectrum, 2).max() < 1e-3


@pytest.mark.parametrize(
    ("unit", "factor", "options"),
    (
        ("N", 1.0, ()),
        ("kN", 1e-3, ()),
        ("mN", 1e3, ()),
        ("lbf", 1.0 / 4.4482216152605, ()),
        ("N m", 0.05, ("--radius", "0.05")),
    ),
)
def test_units_of_a_force(tmp_path: Path, unit: str, factor: float, options: tuple[str, ...]) -> None:
    force = bench.series(bench.FORCE, ENGINE.angle(TIME))
    bench.csv(
        tmp_path / "u.csv", ("time_s", "n_rpm", "load"), (TIME, SPEED, force * factor), digits=[".9g"] * 3
    )
    given = (
        "--unit",
        f"load={unit}",
        "--signal",
        "load",
        "--speed",
        "n_rpm",
        "--output",
        "out.csv",
        *options,
    )
    code, said, _ = called_here("recording.py", "u.csv", *given, cwd=tmp_path)
    assert code == 0, said
    assert re.search(r"^2 +150(\.0*[01])? ", said, re.M), said


@pytest.mark.parametrize(
    ("unit", "factor", "kind"),
    (
        ("rad/s2", 1.0, "angular_acceleration"),
        ("deg/s2", 180.0 / np.pi, "angular_acceleration"),
        ("g", 0.1 / 9.80665, "angular_acceleration"),
        ("m/s^2", 0.1, "angular_acceleration"),
        ("Hz", 1.0 / bench.TURN, "angular_speed_rpm"),
        ("deg/s", 180.0 / np.pi, "angular_speed_rpm"),
    ),
)
def test_units_of_a_motion(tmp_path: Path, unit: str, factor: float, kind: str) -> None:
    """`g` is no gram, and a frequency of rotation counts turns."""
    values = ENGINE.speed(ENGINE.angle(TIME))
    bench.csv(
        tmp_path / "u.csv", ("time_s", "n_rpm", "x"), (TIME, SPEED, values * factor), digits=[".9g"] * 3
    )
    given = (
        "--unit",
        f"x={unit}",
        "--signal",
        "x",
        "--speed",
        "n_rpm",
        "--radius",
        "0.1",
        "--output",
        "out.csv",
    )
    code, said, complained = called_here("recording.py", "u.csv", *given, cwd=tmp_path)
    assert code == 0, complained
    assert f"signal_kind = '{kind}'" in said
    scale = 1.0 / RPM if kind.endswith("rpm") else 1.0
    size = float(re.search(r"^2 +(\S+)", said, re.M)[1])
    assert size == pytest.approx(0.02 * ENGINE.mean * RPM * scale, rel=1e-3)


def test_channels_are_listed(tmp_path: Path) -> None:
    bench.csv(tmp_path / "a.csv", ("time_s", "n_rpm", "force [kN]"), (TIME, SPEED, SPEED))
    code, said, _ = called_here("recording.py", "list", "a.csv", cwd=tmp_path)
    assert code == 0
    assert re.search(r"^1 +n_rpm +1/min +3777 +0 +3\.776 ", said, re.M), said
    assert re.search(r"^2 +force +kN ", said, re.M), said


def test_channels_of_several_files_of_one_clock(tmp_path: Path) -> None:
    bench.csv(tmp_path / "a.csv", ("time_s", "n_rpm"), (TIME, SPEED))
    slow = bench.times(ENGINE.span, 700.0)
    force = bench.series(bench.FORCE, ENGINE.angle(slow))
    bench.csv(tmp_path / "b.csv", ("time_s", "force_N"), (slow, force))
    given = ("--signal", "force_N", "--speed", "n_rpm", "--output", "out.csv")
    code, said, complained = called_here("recording.py", "a.csv", "b.csv", *given, cwd=tmp_path)
    assert code == 0, complained
    assert re.search(r"^2 +150(\.0*[01])? ", said, re.M), said


def test_long_times_between_samples_are_no_spikes() -> None:
    """Of a smooth speed at random times: steps are as much larger where samples are farther apart."""
    drawn = np.random.default_rng(5)
    time = np.sort(drawn.uniform(0.0, 3.777, 19000))
    speed = 812.7 + 14.0 * np.cos(170.0 * time) + 5.0 * np.cos(340.0 * time)
    assert mending.odd_stretches(speed, time) == []
    speed[9000] = 0.0
    assert mending.odd_stretches(speed, time) == [(9000, 9000)]
