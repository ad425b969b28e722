"""Signals that can be read and are hardly meant: spikes, other units, other speeds, cycles that differ."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

import rattle as package

INPUT = Path(__file__).resolve().parents[2] / "input"
HEAD = 2  # lines of engine_cycle.csv before its first sample
SAMPLES = 720


@pytest.fixture
def engine(tmp_path: Path) -> Path:
    """The folder with the ready input of an engine cycle."""
    for name in ("engine_cycle.nml", "engine_cycle.csv"):
        shutil.copy(INPUT / name, tmp_path / name)
    return tmp_path


@pytest.fixture
def warnings(run, engine: Path):
    """What --check warns of, without the first words."""

    def call(*options: str) -> list[str]:
        ended = run("--check", *options, "engine_cycle.nml", cwd=engine)
        assert (ended.returncode, ended.stderr) == (0, ""), ended
        return [line[11:] for line in ended.stdout.splitlines() if line.startswith("! warning: ")]

    return call


def put(engine: Path, values: dict[int, float]) -> list[float]:
    """Replace samples, numbered from 0; returns all of them."""
    lines = (INPUT / "engine_cycle.csv").read_text().splitlines()
    for sample, value in values.items():
        lines[HEAD + sample] = f"{lines[HEAD + sample].split(',')[0]},{value}"
    (engine / "engine_cycle.csv").write_text("\n".join(lines) + "\n")
    return [float(line.split(",")[1]) for line in lines[HEAD:]]


def recorded(engine: Path, rows: np.ndarray, head: str = "angle_deg,speed_rpm") -> None:
    text = "\n".join(",".join(f"{float(value)!r}" for value in row) for row in rows)
    (engine / "engine_cycle.csv").write_text(f"{head}\n{text}\n")


def test_no_ready_input_has_a_doubtful_signal(warnings) -> None:
    assert warnings() == []


@pytest.mark.parametrize("place", [0, 1, 100, 333, 719])
@pytest.mark.parametrize("value", [0, 400, 1600, 5000, 12000, -5])
def test_a_sample_that_stands_alone_is_reported(place: int, value: int, warnings, engine: Path) -> None:
    """With its line, its value and those of its neighbours, which are cyclic."""
    samples = put(engine, {place: value})
    (line,) = warnings()
    assert line.startswith(f"engine_cycle.csv:{HEAD + 1 + place}: column 'speed_rpm' ")
    assert ("reaches" if value <= 0 else "stands alone at") in line
    before, behind = re.search(r"its neighbours are (\S+) 1/min before and (\S+) 1/min behind", line).groups()
    assert float(before) == pytest.approx(samples[place - 1], rel=1e-5)
    assert float(behind) == pytest.approx(samples[(place + 1) % SAMPLES], rel=1e-5)
    assert "scripts/recording.py engine_cycle.csv --cycle-revolutions 2 --mend --output" in line


@pytest.mark.parametrize("place", [0, 100, 640])
@pytest.mark.parametrize("value", [0, 400, 1600])
def test_a_run_of_samples_is_reported(place: int, value: int, warnings, engine: Path) -> None:
    samples = put(engine, {place + i: value for i in range(60)})
    (line,) = warnings()
    assert line.startswith(f"engine_cycle.csv:{HEAD + 1 + place}: column 'speed_rpm' ")
    assert f"for 60 samples, to line {HEAD + place + 60}" in line
    before = float(re.search(r"its neighbours are (\S+) 1/min before", line).group(1))
    assert before == pytest.approx(samples[place - 1], rel=1e-5)


def test_odd_samples_stand_in_log_and_summary(run, engine: Path) -> None:
    put(engine, {100: 0})
    ended = run("--set", "solver.periods=20", "--set", "solver.starts=1", "engine_cycle.nml", cwd=engine)
    assert ended.returncode == 0, ended
    for name in ("engine_cycle.log", "engine_cycle.summary.nml"):
        assert "engine_cycle.csv:103: column" in (engine / "results" / name).read_text()


def test_a_row_of_a_run_up_is_reported(run, tmp_path: Path) -> None:
    for name in ("gearbox_orders.nml", "gearbox_run_up.csv"):
        shutil.copy(INPUT / name, tmp_path / name)
    lines = (INPUT / "gearbox_run_up.csv").read_text().splitlines()
    for value, words in (
        ("0.0", "acceleration of order 2.00: 0 rad/s2 stands alone"),
        ("60000", "is not what machines"),
    ):
        cells = lines[14].split(",")
        (tmp_path / "gearbox_run_up.csv").write_text(
            "\n".join([*lines[:14], ",".join([cells[0], value, *cells[2:]]), *lines[15:]])
        )
        ended = run("--check", "gearbox_orders.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        assert [
            line for line in ended.stdout.splitlines() if "gearbox_run_up.csv:15: " in line and words in line
        ]


UNITS = {
    "rad/s of 1/min": ("angle_deg,speed [rad/s]", np.pi / 30.0, "its rad/s are converted to 1/min"),
    "Hz of 1/min": ("angle_deg,speed_Hz", 1.0 / 60.0, "its Hz are converted to 1/min"),
    "nothing said": ("angle_deg,speed", 1.0, "its head says no unit, 1/min is taken"),
    "a row of units": ("angle,n\ndeg,rad/s", np.pi / 30.0, "its rad/s are converted to 1/min"),
}


@pytest.mark.parametrize("case", UNITS)
def test_the_unit_of_a_signal_is_read(case: str, run, engine: Path) -> None:
    head, factor, words = UNITS[case]
    expected = amplitudes(run, engine)
    rows = np.loadtxt(INPUT / "engine_cycle.csv", delimiter=",", skiprows=HEAD)
    recorded(engine, rows * [1.0, factor], head)
    assert amplitudes(run, engine, words) == pytest.approx(expected, rel=1e-10)


def amplitudes(run, folder: Path, words: str = "") -> list[float]:
    ended = run("--check", "engine_cycle.nml", cwd=folder)
    assert (ended.returncode, ended.stderr) == (0, ""), ended
    assert words in ended.stdout
    (line,) = (line for line in ended.stdout.splitlines() if line.startswith("   speed_amplitudes = "))
    return [float(word) for word in line.split(" = ")[1].split(", ")]


@pytest.mark.parametrize(
    ("head", "words"),
    [
        ("angle_deg,torque_Nm", "it is in N m; 1/min is needed"),
        ("angle_deg,speed_V", "it is in V; 1/min is needed"),
        ("angle_deg,speed [furlong]", "its unit is not known; 1/min is needed"),
    ],
)
def test_another_unit_is_refused(head: str, words: str, refused, engine: Path) -> None:
    text = (INPUT / "engine_cycle.csv").read_text().replace("angle_deg,speed_rpm", head)
    (engine / "engine_cycle.csv").write_text(text)
    (fault,) = refused("--check", "engine_cycle.nml")
    assert fault == f"engine_cycle.csv:2: column 2: {words}"


def test_more_orders_than_samples_show_are_refused(refused, engine: Path) -> None:
    """Eight samples a cycle show three orders of a speed, with twenty-four requested."""
    rows = np.loadtxt(INPUT / "engine_cycle.csv", delimiter=",", skiprows=HEAD)[::90]
    recorded(engine, rows)
    (fault,) = refused("--check", "engine_cycle.nml")
    assert "24 orders take 49 samples a cycle; the signal has 8, which show 3 orders" in fault


def test_of_power_beyond_the_samples_nothing_is_said(run, engine: Path) -> None:
    """The firing order, the fourth of the cycle, stands at half of eight samples."""
    rows = np.loadtxt(INPUT / "engine_cycle.csv", delimiter=",", skiprows=HEAD)[::90]
    recorded(engine, rows)
    text = (engine / "engine_cycle.nml").read_text()
    (engine / "engine_cycle.nml").write_text(re.sub(r"signal_orders.*", "", text))
    ended = run("--check", "engine_cycle.nml", cwd=engine)
    assert ended.returncode == 0, ended.stderr
    assert "of its power is dropped" not in ended.stdout
    (line,) = (line for line in ended.stdout.splitlines() if "8 samples a cycle are too few" in line)
    assert "% of the power that they show is that of harmonic 4" in line


@pytest.mark.parametrize(
    ("cycles", "words"),
    [
        # Every second cycle of the file is another: as one cycle of four revolutions it repeats.
        (4, "while 2 cycles would differ by 0 %: is a cycle 2.00 times as long?"),
        (2, "no other count can be compared"),
    ],
)
def test_cycles_that_differ_are_reported(cycles: int, words: str, warnings, engine: Path) -> None:
    phase = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
    cycle = 12.0 * np.cos(4.0 * phase)
    even, odd = 800.0 + cycle, 800.0 + 1.5 * cycle
    samples = np.tile(np.concatenate([even, odd]), cycles // 2)
    recorded(engine, np.column_stack([np.arange(samples.size), samples]))
    (line,) = warnings()
    # Each is a fifth of their mean off it.
    assert "their rms deviation from their mean is 20.0 % of the rms of what oscillates of it" in line
    assert words in line


SPEEDS = {
    "its own": ((), None),
    "near": (("shaft.speed_rpm=870",), None),
    "another": (("shaft.speed_rpm=1200",), "1200"),
    "another that was measured": (("shaft.speed_rpm=1200", "shaft.signal_speed_range=700, 1500"), None),
    "a range": (
        ("scene.task='sweep'", "sweep.key='speed_rpm'", "sweep.first=700", "sweep.last=2000"),
        "700",
    ),
    "a threshold": (
        (
            "scene.task='threshold'",
            "threshold.key='shaft.speed_rpm'",
            "threshold.first=800",
            "threshold.last=2000",
            "threshold.criterion='verdict'",
        ),
        "800",
    ),
}


@pytest.mark.parametrize("case", SPEEDS)
def test_speeds_that_were_not_measured_are_reported(case: str, warnings, engine: Path) -> None:
    """The mean of a signal of speed is the speed at which it was measured; a tenth either way is near."""
    keys, speeds = SPEEDS[case]
    text = (engine / "engine_cycle.nml").read_text()
    if "scene.task='sweep'" in keys:
        text = text.replace("until = 'steady'", "")
    (engine / "engine_cycle.nml").write_text(text)
    found = warnings(*(word for key in keys for word in ("--set", key)))
    if speeds is None:
        assert found == []
    else:
        (line,) = found
        assert "was measured for 720.00 to 880.00 1/min (&shaft signal_speed_range)" in line
        assert f"with the same amplitudes for {speeds}" in line


def test_speeds_of_a_campaign_are_reported_and_drawn(run, engine: Path) -> None:
    """In log and summary, and as lines of the map; a table of scenes is looked at, too."""
    from rattle.campaign_result import read_campaign
    from rattle.figures import campaign_look as look

    text = (engine / "engine_cycle.nml").read_text()
    (engine / "table.csv").write_text("shaft.speed_rpm\n800\n2000\n")
    grid = "vary(1) = 'shaft.speed_rpm', first = 600, last = 3000, count = 2"
    for name, scenes in (("grid", grid), ("table", "csv = 'table.csv'")):
        (engine / f"{name}.nml").write_text(
            f"&scene task = 'campaign' /\n&campaign {scenes}, record = 'film_minimum' /\n" + text
        )
        ended = run("--set", "solver.periods=20", "--set", "solver.starts=1", f"{name}.nml", cwd=engine)
        assert ended.returncode == 0, ended
        for file in (f"{name}.log", f"{name}.summary.nml"):
            assert "was measured for 720.00 to 880.00 1/min" in (engine / "results" / file).read_text()
    campaign = read_campaign(engine / "results" / "grid.rattle")
    assert look.measured_speeds(campaign) == pytest.approx((720.0, 880.0))
    assert package.read(engine / "results" / "table.rattle").row_count == 2


@pytest.mark.parametrize("ends", ["700", "900, 700", "700, 800, 900"])
def test_a_range_of_speeds_has_two_ends(ends: str, refused, engine: Path) -> None:
    (fault,) = refused("--check", "--set", f"shaft.signal_speed_range={ends}", "engine_cycle.nml")
    assert "&shaft signal_speed_range: the lowest and the highest speed are needed" in fault


def test_a_speed_is_never_fitted_to_a_record(refused, engine: Path) -> None:
    """3.777 s of an engine at 812.7 1/min are cut, not explained by another speed."""
    time = np.arange(3777) * 1e-3
    speed = 812.7 + 12.0 * np.cos(2.0 * np.pi * 2.0 * 812.7 / 60.0 * time)
    recorded(engine, np.column_stack([time, speed]), "time_s,speed_rpm")
    for rpm in ("800", "812.7"):
        (fault,) = refused("--check", "--set", f"shaft.speed_rpm={rpm}", "engine_cycle.nml")
        assert (
            "cut whole cycles out: scripts/recording.py engine_cycle.csv --cycle-revolutions 2 --output"
            in fault
        )
        assert "would make it" not in fault


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("gear.backlash_mm\n0.1\n0.05\n", "gear.backlash, is converted from mm to m"),
        ("gear.backlash [um]\n100\n50\n", "gear.backlash, is converted from um to m"),
        ('"gear.backlash"\nmm\n"0.1"\n"0.05"\n', "gear.backlash, is converted from mm to m"),
        ("gear.backlash;gear.drag_torque\n1,0e-4;0,1\n5,0e-5;0,1\n", ""),
    ],
)
def test_a_table_of_scenes_is_read_as_it_is_written(rows: str, words: str, run, engine: Path) -> None:
    (engine / "table.csv").write_text(rows)
    text = (engine / "engine_cycle.nml").read_text()
    (engine / "map.nml").write_text(
        "&scene task = 'campaign' /\n&campaign csv = 'table.csv', record = 'film_minimum' /\n" + text
    )
    ended = run("--set", "solver.periods=20", "--set", "solver.starts=1", "map.nml", cwd=engine)
    assert ended.returncode == 0, ended
    assert words in (engine / "results" / "map.log").read_text()
    result = package.read(engine / "results" / "map.rattle")
    assert result["gear.backlash"] == pytest.approx([1.0e-4, 5.0e-5], rel=1e-14)
