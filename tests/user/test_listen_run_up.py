"""listen.py of a run-up: levels are those of each motion, pitch is that of the shaft."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile
from script_calls import called_here

import rattle as package
from rattle.command import CommandError
from rattle.sound import levels, pressure, run_up

SPEEDS = package.Range(900.0, 1200.0, 4)
KEY = "shaft.speed_rpm"
RATE = 20.0  # 1/min/s: five seconds from one motion to the next
FLAT = "frequency [Hz],amplitude [Pa/N],phase [deg]\n1,1,0\n30000,1,0\n"


@pytest.fixture(scope="module")
def campaign(rattle, repository, tmp_path_factory) -> Path:
    """A run-up of the ready pair."""
    folder = tmp_path_factory.mktemp("run_up")
    path = repository / "input" / "rattling_gear.nml"
    options = {"record": ["acceleration_rms"], "folder": folder, "program": rattle}
    return package.campaign(path, {KEY: SPEEDS}, **options).result.path


@pytest.fixture(scope="module")
def heard(campaign, tmp_path_factory) -> dict[float, tuple[str, np.ndarray]]:
    """What is printed, and the force [N], of the run-up and of the way down: the function passes all on."""
    folder = tmp_path_factory.mktemp("heard")
    (folder / "flat.csv").write_text(FLAT)
    found = {}
    for rate in (RATE, -RATE):
        output = folder / f"{rate:g}.wav"
        given = (campaign, "--rate", f"{rate}", "--transfer", folder / "flat.csv", "--output", output)
        code, said, complained = called_here("listen.py", *given, cwd=folder)
        assert code == 0 and "Quasi-steady" in complained, complained
        assert "generic housing" not in complained
        found[rate] = said, wavfile.read(output)[1].astype(float)
    return found


def around(sound: np.ndarray, time: float, half: float) -> np.ndarray:
    return sound[max(0, round((time - half) * pressure.RATE)) : round((time + half) * pressure.RATE)]


@pytest.mark.parametrize("rate", (RATE, -RATE))
def test_level_is_that_of_each_motion(heard, repository, rattle, rate) -> None:
    said, sound = heard[rate]
    assert sound.size == 15 * pressure.RATE + 1
    lines = {float(line.split()[0]): line.split() for line in said.splitlines() if line[:1].isdigit()}
    values = np.linspace(SPEEDS.first, SPEEDS.last, SPEEDS.count)
    assert list(lines) == list(values if rate > 0.0 else values[::-1])
    for speed in (1000.0, 1100.0):
        given = {KEY: speed, "solver.starts": 1}
        summary = package.run(repository / "input" / "rattling_gear.nml", set=given, program=rattle).summary
        time = abs(speed - (900.0 if rate > 0.0 else 1200.0)) / RATE
        # A tenth of a second about it is within a fiftieth of the way to the next motion; three periods.
        part = around(sound, time, 3.0 * 30.0 / speed / 2.0)
        assert np.sqrt((part**2).mean()) == pytest.approx(summary["film_force_rms"], rel=0.03)
        assert float(lines[speed][1]) == pytest.approx(time, abs=1e-9)
        assert float(lines[speed][2]) == pytest.approx(summary["film_force_rms"], rel=5e-3)


def test_pitch_is_that_of_the_shaft_also_between_two_motions(heard) -> None:
    """Orders 2, 4, ... of a speed that rises evenly, at the time of a motion and between two."""
    _, sound = heard[RATE]
    for time in (5.0, 7.5, 11.0):
        speed = 900.0 + RATE * time
        part = around(sound, time, 0.5)
        spectrum = np.abs(np.fft.rfft(part * np.hanning(part.size), 16 * part.size))
        frequency = np.fft.rfftfreq(16 * part.size, 1.0 / pressure.RATE)
        near = (frequency > 20.0) & (frequency < 45.0)
        # The next speed of the table is 3.3 Hz away, and within the second the pitch rises by 0.7 Hz.
        assert frequency[near][np.argmax(spectrum[near])] == pytest.approx(speed / 30.0, abs=0.4)


def test_nothing_is_heard_above_the_highest_frequency(heard) -> None:
    spectrum = np.abs(np.fft.rfft(heard[RATE][1] * np.hanning(heard[RATE][1].size)))
    frequency = np.fft.rfftfreq(heard[RATE][1].size, 1.0 / pressure.RATE)
    assert spectrum[frequency > pressure.HIGHEST + 100.0].max() < 1e-4 * spectrum.max()


def test_level_of_the_table_is_a_weighted(heard, campaign, repository, rattle) -> None:
    """From the file: the sound about a motion, weighted."""
    said, sound = heard[RATE]
    (line,) = (line.split() for line in said.splitlines() if line.startswith("1000 "))
    part = around(sound, 5.0, 0.45)
    spectrum = np.fft.rfft(part) / part.size
    weight = levels.a_weight(np.fft.rfftfreq(part.size, 1.0 / pressure.RATE)[1:])
    level = 10.0 * np.log10(2.0 * (np.abs(spectrum[1:] * weight) ** 2).sum() / levels.REFERENCE**2)
    assert float(line[-1]) == pytest.approx(level, abs=1.0)


def test_what_is_no_run_up_is_refused(campaign, driven, repository, rattle, tmp_path) -> None:
    other = package.campaign(
        repository / "input" / "rattling_gear.nml",
        {"gear.backlash": [6e-5, 8e-5]},
        record=["acceleration_rms"],
        folder=tmp_path,
        program=rattle,
    ).result.path
    output = ("--output", tmp_path / "x.wav")
    for given, words in (
        ((other, "--rate", "50", *output), "varies shaft.speed_rpm alone"),
        ((campaign, campaign, "--rate", "50", *output), "takes one run-up"),
        ((campaign, driven[0].path, "--rate", "50", *output), "takes one run-up"),
        ((driven[0].path, driven[0].path, "--rate", "50", *output), "takes one run-up"),
        ((campaign, "--rate", "0", *output), "a rate other than 0"),
        ((campaign, "--rate", "0.1", *output), "The run-up takes 3000 s at 0.1 1/min/s"),
        ((campaign, *output), "needs the series of a motion"),
    ):
        code, said, complained = called_here("listen.py", *given, cwd=tmp_path)
        assert (code, said) == (2, "") and words in complained, complained
        assert not (tmp_path / "x.wav").exists()


@pytest.fixture(scope="module")
def driven(rattle, repository, tmp_path_factory) -> tuple[package.Result, str, np.ndarray]:
    """The part of the ready run-up with the hysteresis: its sweep, what is printed, and the force [N]."""
    folder = tmp_path_factory.mktemp("driven")
    given = {"sweep.first": 2080.0, "sweep.last": 2200.0, "sweep.count": 4, "solver.periods": 400}
    options = {"set": given, "folder": folder, "program": rattle}
    result = package.run(repository / "input" / "gearbox_run_up.nml", **options).result
    (folder / "flat.csv").write_text(FLAT)
    asked = ("--rate", "20", "--transfer", folder / "flat.csv", "--output", folder / "up.wav")
    code, said, complained = called_here("listen.py", result.path, *asked, cwd=folder)
    assert code == 0 and "motions that are carried along" in complained, complained
    assert "Left out" not in complained
    return result, said, wavfile.read(folder / "up.wav")[1].astype(float)


def test_a_sweep_is_heard_with_the_motions_of_each_way(driven) -> None:
    """At 2160 1/min both ways have their own; the sweep's own table has their forces."""
    result, said, sound = driven
    lines = [line.split() for line in said.splitlines() if line[:1].isdigit()]
    for line in lines:
        speed, time, force = map(float, line[:3])
        row = round(time / 2.0)
        assert time == 2.0 * row and speed == result["speed_rpm"][row]
        assert force == pytest.approx(result["film_force_rms"][row], rel=5e-3)
    assert len(lines) == 7 and sound.size == 12 * pressure.RATE + 1
    up, down = result["film_force_rms"][2], result["film_force_rms"][4]
    assert down > 1.1 * up
    for time, force in ((4.0, up), (8.0, down)):
        part = around(sound, time, 3.0 * 30.0 / 2160.0 / 2.0)
        assert np.sqrt((part**2).mean()) == pytest.approx(force, rel=0.03)


def test_the_sound_of_a_sweep_does_not_break_off_where_it_turns(driven) -> None:
    """The phase of the shaft goes on: no step is larger than those beside it."""
    _, _, sound = driven
    steps = np.abs(np.diff(around(sound, 6.0, 0.2)))
    turn = steps.size // 2
    assert steps[turn - 2 : turn + 3].max() <= 1.05 * np.delete(steps, range(turn - 2, turn + 3)).max()


def test_a_sweep_is_heard_forwards_alone(driven) -> None:
    result, _, _ = driven
    asked = ("--rate", "-10", "--output", "down.wav")
    code, _, complained = called_here("listen.py", result.path, *asked, cwd=result.path.parent)
    assert code == 2 and "the ways it went" in complained


def test_a_motion_that_is_not_that_of_the_sweep_is_left_out(driven, monkeypatch) -> None:
    """Each from rest, not from the one before: at 2120 and 2160 1/min a way then has that of the other."""
    result, _, _ = driven
    monkeypatch.setattr(run_up, "ENDING", {})
    ways, left_out = run_up.driven_motions({"": result})
    assert left_out == [2160.0, 2120.0]
    assert [one.speed for one in ways[0]] == [2080.0, 2120.0, 2200.0]


@pytest.fixture(scope="module")
def box(rattle, repository, tmp_path_factory) -> Path:
    """Sweeps of the ready gear and of one with less backlash, up and back: the folder with their results."""
    folder = tmp_path_factory.mktemp("box")
    text = (repository / "input" / "gearbox_run_up.nml").read_text()
    gear = text[text.index("&gear") : text.index("&shaft")]
    other = gear.replace("'2nd'", "'other'").replace("9.0e-5", "7.0e-5")
    (folder / "box.nml").write_text(text.replace(gear, gear + other))
    shutil.copy(repository / "input" / "gearbox_run_up.csv", folder)
    given = {"sweep.first": 1000.0, "sweep.last": 1200.0, "sweep.count": 3}
    package.run(folder / "box.nml", set=given, folder=folder / "results", program=rattle)
    return folder / "results"


def test_sweeps_of_all_pairs_sound_together(box, tmp_path) -> None:
    """Forces of both are in the sound; alone each has its own table, of the same motions."""
    (tmp_path / "flat.csv").write_text(FLAT)
    pairs = sorted(box.glob("box.*.rattle"))
    assert len(pairs) == 2
    rms, sounds = [], []
    for place, given in enumerate(([pairs[0]], [pairs[1]], pairs)):
        output = tmp_path / f"{place}.wav"
        asked = ("--rate", "100", "--transfer", tmp_path / "flat.csv", "--full-scale", "100")
        code, said, complained = called_here("listen.py", *given, *asked, "--output", output, cwd=tmp_path)
        assert code == 0 and "Left out" not in complained, complained
        rms.append([float(line.split()[2]) for line in said.splitlines() if line[:1].isdigit()])
        sounds.append(wavfile.read(output)[1].astype(float))
    assert np.hypot(rms[0], rms[1]) == pytest.approx(rms[2], rel=1e-3)  # four digits are printed
    assert np.abs(sounds[0] + sounds[1] - sounds[2]).max() <= 1e-6 * np.abs(sounds[2]).max()


def test_sweeps_that_went_other_ways_are_refused(box, driven, tmp_path) -> None:
    ways = {"1": package.read(sorted(box.glob("box.*.rattle"))[0]), "2": driven[0]}
    with pytest.raises(CommandError, match="have not gone over the same speeds"):
        run_up.driven_motions(ways)
