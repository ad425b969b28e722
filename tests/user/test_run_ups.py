"""recording.py run-up: what was put into a run-up stands in its table, and rattle reads it so."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from run_up_truth import ENGINE, Truth, quantised, resonance
from scipy.interpolate import CubicSpline
from script_calls import called_here
from vold_kalman import vold_kalman

import rattle as package
from rattle.figures import style, waterfall
from rattle.recordings import order_tracking
from rattle.recordings.order_windows import fit_window, mean_course

RATE = 2000.0
GEAR = """&gear
   teeth_1 = 19, teeth_2 = 37, normal_module = 2.2e-3, helix_angle_deg = 28.0, face_width = 0.016
   centre_distance = 0.070, loose_inertia = 8.9e-4, backlash = 9e-5, drag_torque = 0.08
/
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 50.0 /
&film law = 'iso-viscous', model = 'reynolds' /
"""


def times(truth: Truth, rate: float = RATE) -> np.ndarray:
    return np.arange(0.0, truth.seconds, 1.0 / rate)


def integrated(time: np.ndarray, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The angle [rad] of a recorded speed [1/min], from 0 on."""
    rate = speed * np.pi / 30.0
    return time, np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(time))])


def tracked(truth: Truth, speed: np.ndarray, **options) -> order_tracking.RunUp:
    time = times(truth)
    return order_tracking.track_run_up(time, speed * np.pi / 30.0, 1, integrated(time, speed), **options)


def worst(found: order_tracking.RunUp, truth: Truth, zero: float) -> dict[float, tuple[float, float]]:
    """Of each order the largest relative error of its amplitude, and that of its phase [deg]."""
    off = {}
    for place, order in enumerate(found.orders):
        ratio = found.amplitudes[:, place] / truth.amplitudes(found.speeds, order, zero)
        off[order] = np.max(np.abs(np.abs(ratio) - 1.0)), np.degrees(np.max(np.abs(np.angle(ratio))))
    return off


def zero(truth: Truth) -> float:
    """The angle [rad] at which a recording begins."""
    return float(truth.angle(np.array([0.0]))[0])


def read_table(path: Path) -> dict[str, np.ndarray]:
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    columns = np.array([list(map(float, line.split(","))) for line in lines[1:]]).T
    return dict(zip(lines[0].split(","), columns, strict=True))


@pytest.fixture(scope="module")
def measured(tmp_path_factory) -> Path:
    """A bench's file: 12 bits over 8000 1/min, jitter of the time, noise, German numbers, and its table."""
    truth, folder = Truth(), tmp_path_factory.mktemp("run_up")
    draw = np.random.default_rng(2)
    time = times(truth) + draw.uniform(-0.05, 0.05, len(times(truth))) / RATE
    speed = quantised(truth.speed(time) + draw.normal(0.0, 0.05, len(time)), 8000.0, 12)
    rows = (f"{t:.6f};{n:.3f}".replace(".", ",") for t, n in zip(time, speed, strict=True))
    (folder / "bench.csv").write_text("\n".join(["Zeit;n_Motor", "s;1/min", *rows, ""]))
    code, said, complained = called_here(
        "recording.py", "run-up", "bench.csv", "--speed", "n_Motor", "--output", "table.csv", cwd=folder
    )
    assert code == 0, complained
    (folder / "said.txt").write_text(said)
    return folder


def test_a_table_holds_what_was_put_in(measured: Path) -> None:
    """The orders are chosen by their power; 12 bits are a step of 2 1/min, order 8 swings by 0.3 1/min."""
    table = read_table(measured / "table.csv")
    assert list(table) == [
        "speed_rpm",
        *(f"{k}_{o}" for o in (2, 4, 6, 8) for k in ("acceleration", "phase")),
    ]
    assert len(table["speed_rpm"]) >= 20
    truth = Truth()
    for order, share, degrees in ((2, 0.02, 1.5), (4, 0.03, 2.0)):
        own = table[f"acceleration_{order}"] * np.exp(1j * table[f"phase_{order}"])
        ratio = own / truth.amplitudes(table["speed_rpm"], float(order), zero(truth))
        assert np.max(np.abs(np.abs(ratio) - 1.0)) < share
        assert np.degrees(np.max(np.abs(np.angle(ratio)))) < degrees
    said = (measured / "said.txt").read_text()
    assert "Orders kept by power: 2, 4, 6, 8" in said and "&shaft table = 'table.csv'" in said


@pytest.mark.parametrize("last", (3000.0, 500.0))
def test_without_noise_all_orders_are_within_a_percent(last: float) -> None:
    """Up and down; 2 % are asked for, and rows about a resonance are where quadratic amplitudes are off."""
    truth = Truth(last=last, first=700.0 if last > 700.0 else 3000.0)
    found = tracked(truth, truth.speed(times(truth)))
    assert found.orders == (2.0, 4.0, 6.0, 8.0)
    for share, degrees in worst(found, truth, zero(truth)).values():
        assert share < 0.01 and degrees < 0.5


def test_standard_errors_are_those_of_the_noise() -> None:
    """Of the amplitudes; phases drift with the angle, the integral of the noise."""
    truth = Truth(orders={o: (lambda n, a=a: a * (1.0 + 0j * n)) for o, a in ((2.0, 300.0), (5.0, 200.0))})
    speed = truth.speed(times(truth)) + np.random.default_rng(3).normal(0.0, 1.0, len(times(truth)))
    found = tracked(truth, speed, orders=(2.0, 5.0))
    for place, order in enumerate(found.orders):
        off = np.abs(found.amplitudes[:, place]) - np.abs(truth.orders[order](found.speeds))
        assert 0.6 < np.sqrt(np.mean((off / found.errors[:, place]) ** 2)) < 1.5


def test_close_orders_are_distinguished_on_request() -> None:
    """Orders 2 and 2.2, the latter with a resonance of its own."""
    orders = dict(ENGINE) | {2.2: lambda n: resonance(n, 2200.0, 0.1, 30.0, 60.0 * np.exp(1j))}
    truth = Truth(orders=orders)
    speed = truth.speed(times(truth)) + np.random.default_rng(4).normal(0.0, 0.05, len(times(truth)))
    found = tracked(truth, speed, orders=(2.0, 2.2, 4.0))
    assert found.orders == (2.0, 2.2, 4.0)
    off = worst(found, truth, zero(truth))
    assert max(share for share, _ in off.values()) < 0.02 and max(deg for _, deg in off.values()) < 2.0


def test_a_tone_that_crosses_an_order_is_fitted_beside_it() -> None:
    """50 Hz is order 2 at 1500 1/min and order 4 at 750; unnamed, it would be off by a fifth there."""
    truth = Truth(tone=(50.0, 100.0))
    found = tracked(truth, truth.speed(times(truth)), tones=(50.0,))
    assert found.orders == (2.0, 4.0, 6.0, 8.0)
    assert max(share for share, _ in worst(found, truth, zero(truth)).values()) < 0.03
    unnamed = tracked(truth, truth.speed(times(truth)), orders=(2.0,))
    assert worst(unnamed, truth, zero(truth))[2.0][0] > 0.1


def test_an_image_of_a_strong_order_is_none_of_twice_the_order() -> None:
    """Over an angle that swings with it a second order of 900 rad/s2 would have a fourth of 40 and more."""
    truth = Truth(orders={2.0: lambda n: 900.0 + 0j * n})
    found = tracked(truth, truth.speed(times(truth)), orders=(2.0, 4.0))
    assert np.max(np.abs(found.amplitudes[:, 1])) < 0.5


def test_windows_follow_a_resonance_better_than_a_vold_kalman_filter() -> None:
    """Both with noise; of the filter the best of four bandwidths."""
    truth = Truth(seconds=12.0)
    time = times(truth)
    speed = truth.speed(time) + np.random.default_rng(5).normal(0.0, 0.1, len(time))
    course = mean_course(*integrated(time, speed), 2)
    phase, orders = course.phase(time), (2.0, 4.0, 6.0, 8.0)
    found = tracked(truth, speed)
    own = max(share for share, _ in worst(found, truth, zero(truth)).values())
    grid = np.arange(phase[0], phase[-1], 2.0 * np.pi / 64.0)
    even = CubicSpline(phase, speed * np.pi / 30.0)(grid)
    at = np.searchsorted(grid, course.at_speed(found.speeds * np.pi / 30.0))
    others = []
    for bandwidth in (0.03, 0.06, 0.1, 0.2):
        swing = vold_kalman(even, [order * grid for order in orders], bandwidth / 64.0)[at]
        ratio = [
            1j
            * order
            * found.speeds
            * np.pi
            / 30.0
            * swing[:, place]
            / truth.amplitudes(found.speeds, order, zero(truth))
            for place, order in enumerate(orders)
        ]
        others.append(np.max(np.abs(np.abs(ratio) - 1.0)))
    assert own < min(others)


def test_a_wheel_of_60_2_teeth_tells_its_own_orders(tmp_path: Path) -> None:
    """The pulses alone; phases count from the tooth behind the gap, where the true angle is 0, too."""
    truth = Truth(first=700.0, last=2000.0, seconds=8.0)
    time = times(truth, 20000.0)
    turn = truth.angle(time) / (2.0 * np.pi) * 60.0
    is_tooth = np.floor(turn) % 60 < 58
    # A sine of each tooth that rises through 0 where the tooth begins.
    pulses = np.where(is_tooth, np.sin(2.0 * np.pi * turn), -np.abs(np.sin(2.0 * np.pi * turn)) - 0.0)
    np.savetxt(
        tmp_path / "w.csv",
        np.c_[time, pulses],
        delimiter=",",
        fmt="%.6g",
        header="time [s],wheel",
        comments="",
    )
    code, _, complained = called_here(
        "recording.py", "run-up", "w.csv", "--tacho", "wheel", "--pulses", 60, "--missing", 2,
        "--output", "t.csv", "--orders", "2,4", cwd=tmp_path,
    )  # fmt: skip
    assert code == 0, complained
    table = read_table(tmp_path / "t.csv")
    for order in (2, 4):
        own = table[f"acceleration_{order}"] * np.exp(1j * table[f"phase_{order}"])
        ratio = own / truth.amplitudes(table["speed_rpm"], float(order), 0.0)
        assert np.max(np.abs(np.abs(ratio) - 1.0)) < 0.02
        assert np.degrees(np.max(np.abs(np.angle(ratio)))) < 2.0


@pytest.mark.parametrize("speed", (900.0, 1700.0))
def test_rattle_takes_the_table_as_it_was_meant(speed: float, measured: Path, rattle: Path) -> None:
    """Accelerations of the resolved scene are those of the truth, and those that its speeds come to."""
    truth = Truth()
    (measured / "pair.nml").write_text(GEAR + f"&shaft speed_rpm = {speed}, table = 'table.csv' /\n")
    own = {order: complex(truth.amplitudes(np.array([speed]), order, zero(truth))[0]) for order in (2.0, 4.0)}
    swings = {order: value / (1j * order * speed * np.pi / 30.0) for order, value in own.items()}
    (measured / "speeds.nml").write_text(
        GEAR + f"&shaft speed_rpm = {speed}, orders = 2.0, 4.0, "
        f"speed_amplitudes = {abs(swings[2.0])}, {abs(swings[4.0])}, "
        f"phases = {np.angle(swings[2.0])}, {np.angle(swings[4.0])} /\n"
    )
    forces = []
    for name in ("pair.nml", "speeds.nml"):
        reported = subprocess.run(
            [rattle, "--check", name], cwd=measured, capture_output=True, text=True
        ).stdout
        sizes, phases = (
            list(
                map(float, re.findall(rf"load.force_{key} = (.*?)(?: N| rad)$", reported, re.M)[0].split(","))
            )
            for key in ("amplitudes", "phases")
        )
        forces.append(np.array(sizes)[:2] * np.exp(1j * np.array(phases)[:2]))
    ratio = forces[0] / forces[1]
    assert np.max(np.abs(np.abs(ratio) - 1.0)) < 0.03
    assert np.degrees(np.max(np.abs(np.angle(ratio)))) < 2.0


def test_the_larger_run_is_taken_of_several() -> None:
    truth = Truth(seconds=10.0)
    forth = truth.speed(times(truth))
    speed = np.concatenate([np.full(2000, forth[0]), forth, forth[::-1][: len(forth) // 2]])
    time = np.arange(len(speed)) / RATE
    found = order_tracking.track_run_up(time, speed * np.pi / 30.0, 1, integrated(time, speed))
    assert found.speeds[0] < 900.0 and found.speeds[-1] > 2800.0
    assert any("turns 1 time" in note for note in found.notes)


def test_vibration_becomes_order_cuts(tmp_path: Path) -> None:
    """A channel in g beside the speed: plot.py orders takes its table."""
    truth = Truth(seconds=8.0)
    time = times(truth)
    shaken = 2.0 * np.cos(2.0 * truth.mean_angle(time) + 0.3) / 9.80665
    table = np.c_[time, truth.speed(time), shaken]
    np.savetxt(
        tmp_path / "v.csv",
        table,
        delimiter=",",
        fmt="%.9g",
        header="time [s],n [rpm],housing [g]",
        comments="",
    )
    code, said, complained = called_here(
        "recording.py",
        "run-up",
        "v.csv",
        "--speed",
        "n",
        "--signal",
        "housing",
        "--output",
        "c.csv",
        cwd=tmp_path,
    )
    assert code == 0, complained
    table = read_table(tmp_path / "c.csv")
    assert list(table) == ["speed_rpm", "order_2"]
    assert table["order_2"] == pytest.approx(np.full(len(table["order_2"]), 2.0), rel=0.01)
    assert "&shaft" not in said


def test_the_waterfall_shows_kept_orders_where_they_are(measured: Path) -> None:
    shown, kept = waterfall.read_waterfall(measured / "table.waterfall.csv")
    assert kept == [2.0, 4.0, 6.0, 8.0] and shown.unit == "rad/s2"
    place = int(np.argmin(np.abs(shown.orders - 2.0)))
    truth = np.abs(ENGINE[2.0](shown.speeds))
    assert np.max(np.abs(shown.amplitudes[:, place] / truth - 1.0)) < 0.05
    with style.house_style():
        figure = waterfall.draw("table", shown, kept)
    axes = figure.axes[0]
    assert [text.get_text() for text in axes.texts] == ["2", "4", "6", "8"]
    marks = [float(line.get_xdata()[0]) for line in axes.lines]
    assert marks == kept
    # The colour of a cell is its amplitude: strips and the gaps between them take turns.
    cells = np.ma.getdata(axes.collections[0].get_array())
    assert cells[:, 2 * place] == pytest.approx(
        np.maximum(shown.amplitudes[:, place], shown.amplitudes.max() / 1e3)
    )


def test_a_computed_campaign_stands_beside_the_measured_map(
    measured: Path, tmp_path: Path, rattle: Path
) -> None:
    text = GEAR + "&shaft speed_rpm = 900.0, orders = 2.0, accelerations = 600.0 /\n"
    text += "&solver periods = 4, accuracy = 1e-6, starts = 1 /\n&spectrum periods = 1 /\n"
    text += (
        "&campaign vary = 'shaft.speed_rpm', first = 800, last = 1200, count = 3, record = 'harmonics' /\n"
    )
    solved = package.run(text + "&scene task = 'campaign', name = 'pair' /\n", folder=tmp_path)
    code, said, complained = called_here(
        "plot.py", "waterfall", measured / "table.waterfall.csv", "--computed", solved.result.path,
        "--format", "png", cwd=tmp_path,
    )  # fmt: skip
    assert code == 0 and said.split() == ["waterfall_pair.png"], complained
    computed = waterfall.computed(package.read_campaign(solved.result.path))
    assert list(computed.orders) == [2.0 * n for n in range(1, 9)]
    assert computed.amplitudes[:, 0] == pytest.approx(np.array(solved.result["harmonic_1"]))


@pytest.mark.parametrize(
    ("change", "options", "words"),
    (
        ("steady", (), "'recording.py cycle'"),
        ("short", (), "turns at least"),
        ("coarse", (), "shows no order"),
        ("", ("--orders", "40"), "beyond what the samples show"),
        ("", ("--orders", "0"), "'0' is not a positive number"),
        ("", ("--step", "5000"), "two rows"),
        ("even", (), "no order stands out"),
        ("", ("--signal", "nothing"), "no channel 'nothing'"),
        ("torque", ("--signal", "torque"), "a run-up takes an angle, a speed or an acceleration"),
        ("no shaft", (), "--angle, --tacho or --speed"),
    ),
)
def test_what_is_no_run_up_is_refused(change: str, options: tuple, words: str, tmp_path: Path) -> None:
    truth = Truth(seconds=0.3 if change == "short" else 6.0)
    time = times(truth)
    speed = truth.speed(time)
    speed = speed - truth.mean_speed(time) + 900.0 if change == "steady" else speed
    speed = truth.mean_speed(time) if change == "even" else speed
    time, speed = (values[:: 100 if change == "coarse" else 1] for values in (time, speed))
    np.savetxt(
        tmp_path / "r.csv", np.c_[time, speed, speed], delimiter=",", fmt="%.12g",
        header="time [s],n [rpm],torque [N m]", comments="",
    )  # fmt: skip
    shaft = () if change == "no shaft" else ("--speed", "n")
    code, _, complained = called_here(
        "recording.py", "run-up", "r.csv", *shaft, *options, "--output", "t.csv", cwd=tmp_path
    )
    assert code == 2 and words in complained and "Traceback" not in complained
    assert not (tmp_path / "t.csv").exists()


@pytest.mark.parametrize(
    "text",
    (
        "",
        "speed_rpm,order_1,order_2\n1,2,3\n2,3,4\n",
        "# unit: rad/s2\n# kept: 2\nspeed_rpm,order_1,order_2\n1,x,3\n2,3,4\n",
    ),
)
def test_other_files_are_no_waterfall(text: str, tmp_path: Path) -> None:
    (tmp_path / "w.csv").write_text(text)
    code, _, complained = called_here("plot.py", "waterfall", "w.csv", cwd=tmp_path)
    assert code == 2 and "not a waterfall" in complained and "Traceback" not in complained


def test_too_few_samples_make_no_fit() -> None:
    assert fit_window(np.linspace(0.0, 6.0, 20), np.zeros(20), [2.0, 4.0], 3.0, 3.0) is None
