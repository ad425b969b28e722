"""Sounds of film forces: the spectrum is that of force times transfer function, with nothing folded in."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.io import wavfile
from script_calls import called_here

import rattle as package
from rattle.command import CommandError
from rattle.sound import force, levels, pressure, transfer

FOLDER = {"solver": {"starts": 1, "accuracy": 1e-6}}
COLUMNS = ["time", "applied_force", "film_thickness", "acceleration", "film_load", "coast_load"]
GEARS = ("1st", "2nd", "3rd", "4th")
# Nominal A-weighting of IEC 61672-1, table 3, at exact frequencies 1000 * 10**(n/10).
NOMINAL = {-15: -39.4, -12: -26.2, -9: -16.1, -6: -8.6, -3: -3.2, 0: 0.0, 3: 1.2, 6: 1.0, 9: -1.1, 12: -6.6}


@pytest.fixture(scope="module")
def boxes(rattle, repository, tmp_path_factory) -> dict[str, Path]:
    """The table of the ready gearbox, and of one whose engine shakes half as much."""
    folder = tmp_path_factory.mktemp("heard")
    for name, scale in (("base", 1.0), ("halved", 0.5)):
        given = {**FOLDER, "load": {"force_scale": scale}, "output": {"columns": COLUMNS}}
        options = {"set": given, "folder": folder / name, "program": rattle}
        package.run(repository / "input" / "gearbox.nml", **options)
    return {name: folder / name / "gearbox.summary.nml" for name in ("base", "halved")}


def solved_of(box: Path, gear: str) -> package.Solved:
    result = package.read(box.with_name(f"gearbox.{gear}.rattle"))
    return package.Solved(result, package.read_summary(result.summary_path))


def harmonics_of(heard: np.ndarray, frequency: float, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Two-sided amplitudes at the multiples of a frequency that fits the duration, and all others."""
    spectrum = np.fft.rfft(heard) / heard.size
    step = round(frequency * seconds)
    assert step == pytest.approx(frequency * seconds, rel=1e-12)
    return spectrum[step::step], np.delete(spectrum, slice(0, None, step))


def test_the_spectrum_of_an_impulse_train_is_exact_and_nothing_folds() -> None:
    """Triangles of 20 us, whose spectrum reaches far beyond 24 kHz: area times sinc squared."""
    frequency, half = 80.0 / 3.0, 10e-6
    period = 1.0 / frequency
    grid = 512
    time = np.arange(grid) * period / grid
    value = np.zeros(grid)
    for middle, height in ((0.3 * period + 1.3e-6, 100.0), (0.71 * period + 2.9e-6, 40.0)):
        time = np.concatenate([time, middle + np.array([-half, 0.0, half])])
        value = np.concatenate([value, [0.0, height, 0.0]])
    order = np.argsort(time)
    count = int(20000.0 * period)
    found = force.fourier_coefficients(time[order], value[order], period, count, grid)
    f = frequency * np.arange(1, count + 1)
    expected = sum(
        height * half * frequency * np.sinc(f * half) ** 2 * np.exp(-2j * np.pi * f * middle)
        for middle, height in ((0.3 * period + 1.3e-6, 100.0), (0.71 * period + 2.9e-6, 40.0))
    )
    assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()
    assert np.abs(expected[-1]) > 0.1 * np.abs(expected[0])  # there is much to fold
    seconds = 3.0
    heard = pressure.samples([pressure.Tones(frequency, found)], int(seconds * pressure.RATE))
    at, between = harmonics_of(heard, frequency, seconds)
    assert np.abs(at[:count] - expected).max() < 1e-8 * np.abs(expected).max()
    assert np.abs(between).max() < 1e-8 * np.abs(expected).max()
    assert np.abs(at[count:]).max() < 1e-8 * np.abs(expected).max()


def test_the_force_is_the_load_of_both_films_and_has_the_rms_of_the_summary(boxes) -> None:
    for gear in GEARS:
        solved = solved_of(boxes["base"], gear)
        result = solved.result
        loads = result["film_load"] - result["coast_load"]
        balance = result.number("load", "mass") * result["acceleration"] + result["applied_force"]
        assert np.abs(loads - balance).max() < 1e-6 * np.abs(loads).max()
        found = force.force_harmonics(solved, 20000.0)
        assert found.rms == pytest.approx(solved.summary["film_force_rms"], rel=2e-3)
        assert found.repeats and found.periods == 1
        assert 2.0 * (np.abs(found.amplitudes) ** 2).sum() == pytest.approx(found.rms**2, rel=1e-3)


def test_all_pairs_together_are_the_forces_in_phase(boxes) -> None:
    found = [force.force_harmonics(solved_of(boxes["base"], gear), 20000.0) for gear in GEARS]
    unit = transfer.Transfer("one", True, (0.0, 1e5), np.array([1.0, 1e5]), np.zeros(2), np.zeros(2))
    (together,) = pressure.tones_of(found, unit)
    rms = np.sqrt(2.0 * (np.abs(together.amplitudes) ** 2).sum())
    table = package.read_summary(boxes["base"])
    assert rms == pytest.approx(table["film_force_rms_in_phase"], rel=2e-3)


def test_finer_samples_are_not_heard(rattle, repository, boxes) -> None:
    """4096 samples a period are enough: levels in the band are those of sixteen times as many."""
    given = {**FOLDER, "solver.samples_per_period": 65536, "output.columns": list(force.COLUMNS)}
    fine = package.run(repository / "input" / "gearbox.nml", set=given, program=rattle)
    housing = transfer.generic()
    for gear in ("1st", "4th"):
        some, many = (
            pressure.tones_of([force.force_harmonics(solved, 20000.0)], housing)
            for solved in (solved_of(boxes["base"], gear), fine[gear])
        )
        assert levels.sound_level(some) == pytest.approx(levels.sound_level(many), abs=0.05)


def test_the_file_has_the_spectrum_and_the_level_that_are_reported(boxes, tmp_path) -> None:
    """Both variants, one gain: samples are force times transfer function, and the level is theirs."""
    output = tmp_path / "box.wav"
    code, said, complained = called_here("listen.py", *boxes.values(), "--output", output, cwd=tmp_path)
    assert code == 0 and "only differences between the variants of one file mean" in complained
    rate, samples = wavfile.read(output)
    assert (rate, samples.dtype) == (48000, np.float32)
    assert samples.size == (3.0 + 0.5 + 3.0) * rate
    assert np.abs(samples).max() == pytest.approx(0.5, rel=1e-3)  # twice the largest is a sample of 1
    scale = float(said.partition("a sample of 1 is ")[2].split()[0])
    rows = [line.split() for line in said.splitlines() if "/gearbox" in line]
    housing = transfer.generic()
    seconds = 1.5  # of 40 periods; away from the ends, which swell and fade
    for place, (name, box) in enumerate(boxes.items()):
        first = round((place * 3.5 + 0.75) * rate)
        heard = scale * samples[first : first + round(seconds * rate)].astype(float)
        found = [force.force_harmonics(solved_of(box, gear), 20000.0) for gear in GEARS]
        expected = sum(one.amplitudes for one in found) * housing.at(found[0].frequencies)
        expected = expected * np.exp(2j * np.pi * found[0].frequencies * 0.75)
        at, between = harmonics_of(heard, found[0].frequency, seconds)
        largest = np.abs(expected).max()
        assert np.abs(at[: expected.size] - expected).max() < 1e-3 * largest  # four digits of the scale
        assert np.abs(between).max() < 1e-6 * largest
        assert np.abs(at[expected.size :]).max() < 1e-6 * largest
        weighted = np.abs(at[: expected.size]) * 10.0 ** (iec_levels(found[0].frequencies) / 20.0)
        level = 10.0 * np.log10(2.0 * (weighted**2).sum() / 4e-10)
        assert rows[place][0] == f"{name}/gearbox"
        assert float(rows[place][-4]) == pytest.approx(level, abs=0.07)
    assert float(rows[1][-3]) == pytest.approx(float(rows[1][-4]) - float(rows[0][-4]), abs=0.11)
    pause = samples[3 * rate : round(3.5 * rate)]
    assert (pause == 0.0).all()


def iec_levels(frequency: np.ndarray) -> np.ndarray:
    """A-weighting [dB] by its poles and zeros as an analogue filter, as IEC 61672-1 has them."""
    poles = 2.0 * np.pi * np.array([20.598997, 20.598997, 107.65265, 737.86223, 12194.217, 12194.217])
    at = 2j * np.pi * np.append(frequency, 1000.0)
    response = np.abs(at**4 / np.prod([at + pole for pole in poles], axis=0))
    return 20.0 * np.log10(response[:-1] / response[-1])


def test_the_weighting_is_that_of_the_standard() -> None:
    for step, nominal in NOMINAL.items():
        found = 20.0 * np.log10(levels.a_weight(np.array([1000.0 * 10.0 ** (step / 10.0)])))
        assert found.item() == pytest.approx(nominal, abs=0.051), step
    tone = pressure.Tones(1000.0, np.array([0.5 * np.sqrt(2.0)]))  # 1 Pa rms
    assert levels.sound_level([tone]) == pytest.approx(93.98, abs=0.005)


def test_a_measured_function_is_read_with_its_units_and_passed_on_as_it_is(boxes, tmp_path) -> None:
    function = tmp_path / "transfer.csv"
    function.write_text("frequency_kHz;amplitude;phase_deg\n0,1;0,001;170\n1;0,01;-170\n8;0,005;-10\n")
    read = transfer.read_transfer(function)
    at = read.at(np.array([50.0, 100.0, 1000.0, 8000.0, 9000.0]))
    assert np.abs(at) == pytest.approx([0.0, 1e-3, 1e-2, 5e-3, 0.0])
    assert np.rad2deg(np.angle(at[1:4])) == pytest.approx([170.0, -170.0, -10.0])
    between = read.at(np.array([550.0]))
    assert np.abs(between) == pytest.approx(np.sqrt(1e-5)) and np.abs(np.angle(between)) == pytest.approx(
        np.pi
    )
    first = boxes["base"].with_name("gearbox.1st.rattle")
    arguments = (first, "--transfer", function, "--output", tmp_path / "one.wav", "--seconds", "1.5")
    code, said, complained = called_here("listen.py", *arguments, cwd=tmp_path)
    assert code == 0 and "a sample of 1 is 1 Pa" in said, complained
    rate, samples = wavfile.read(tmp_path / "one.wav")
    found = force.force_harmonics(solved_of(boxes["base"], "1st"), 20000.0)
    heard = found.amplitudes * read.at(found.frequencies)
    middle = samples[round(0.375 * rate) : round(1.125 * rate)].astype(float)  # 20 periods
    assert np.sqrt((middle**2).mean()) == pytest.approx(np.sqrt(2.0 * (np.abs(heard) ** 2).sum()), rel=1e-5)
    inside = (found.frequencies >= 100.0) & (found.frequencies <= 8000.0)
    share = 2.0 * (np.abs(found.amplitudes[inside]) ** 2).sum() / found.rms**2
    assert f"{100.0 * share:.3g} %" in said


@pytest.mark.parametrize(
    ("text", "line", "words"),
    (
        ("frequency [Hz],amplitude [Pa/N]\n1,1\n2,1\n", 1, "no columns are called phase"),
        ("frequency [Hz],amplitude [Pa],phase [deg]\n1,1,0\n2,1,0\n", 1, "it is in Pa; Pa/N is needed"),
        ("frequency [Hz],amplitude [Pa/N],phase\n1,1,0\n2,1,0\n", 1, "the phase has no unit"),
        ("frequency [Hz],amplitude [Pa/N],phase [deg]\n1,1,0\n1,1,0\n", 3, "frequencies have to be above 0"),
        ("frequency [Hz],amplitude [Pa/N],phase [deg]\n1,1,0\n2,0,0\n", 3, "an amplitude has to be above 0"),
        ("frequency [Hz],amplitude [Pa/N],phase [deg]\n1,1,0\n2,,0\n", 3, "a number is missing"),
        ("frequency [Hz],amplitude [Pa/N],phase [deg]\n1,1,0\n", None, "needs two frequencies or more"),
    ),
)
def test_a_faulty_function_is_refused_with_its_line(text, line, words, tmp_path) -> None:
    path = tmp_path / "transfer.csv"
    path.write_text(text)
    with pytest.raises(CommandError, match=words) as refused:
        transfer.read_transfer(path)
    assert str(refused.value).startswith(f"{path}:{line}:" if line else f"{path}:")


def test_the_generic_housing_is_a_few_damped_modes() -> None:
    frequency = np.arange(100.0, 10000.0, 1.0)
    gain = np.abs(transfer.generic().at(frequency))
    peaks = frequency[1:-1][(gain[1:-1] > gain[:-2]) & (gain[1:-1] > gain[2:])]
    assert peaks == pytest.approx([mode for mode, _, _ in transfer.MODES], rel=0.02)


def test_loudness_and_sharpness_are_those_of_a_tone() -> None:
    """1 kHz: 4 sone at 60 dB, by definition of the sone, and 1 acum."""
    pytest.importorskip("mosqito")
    tone = pressure.Tones(1000.0, np.array([0.02 / np.sqrt(2.0)]))
    found = levels.loudness_and_sharpness(pressure.samples([tone], 48000))
    assert found[0] == pytest.approx(4.0, rel=0.05) and found[1] == pytest.approx(1.0, rel=0.05)


def test_without_the_library_the_rest_is_reported(boxes, tmp_path, monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "mosqito.sq_metrics", None)
    function = tmp_path / "transfer.csv"
    function.write_text("frequency [Hz],amplitude [Pa/N],phase [rad]\n50,1,0\n20000,1,0\n")
    first = boxes["base"].with_name("gearbox.1st.rattle")
    arguments = (first, "--transfer", function, "--output", tmp_path / "one.wav", "--seconds", "0.3")
    code, said, complained = called_here("listen.py", *arguments, cwd=tmp_path)
    assert code == 0 and "MoSQITo is not installed; pip install 'rattle[sound]' brings it." in complained
    assert "dB(A)" in said and "players cut it off at 1" in complained


@pytest.mark.long
def test_a_motion_that_does_not_repeat_is_said_to(rattle, repository, tmp_path) -> None:
    given = {"shaft.speed_rpm": 2400.0, "oil.temperature_celsius": 120.0, "solver.starts": 1}
    package.run(repository / "input" / "gearbox.nml", set=given, folder=tmp_path, program=rattle)
    summary = package.read_summary(tmp_path / "gearbox.4th.summary.nml")
    assert summary["rattle_class"] == "irregular"
    arguments = (tmp_path / "gearbox.4th.rattle", "--output", tmp_path / "i.wav", "--seconds", "0.5")
    code, _, complained = called_here("listen.py", *arguments, cwd=tmp_path)
    assert code == 0
    assert (
        "4th has a motion that does not repeat; its last 100 periods are heard again and again." in complained
    )


def test_bad_inputs_have_a_plain_sentence(boxes, rattle, repository, tmp_path) -> None:
    first = boxes["base"].with_name("gearbox.1st.rattle")
    few = {**FOLDER, "solver.samples_per_period": 64}
    package.run(repository / "input" / "gearbox.nml", set=few, folder=tmp_path / "few", program=rattle)
    lean = {**FOLDER, "output.columns": ["time", "film_thickness"]}
    package.run(repository / "input" / "gearbox.nml", set=lean, folder=tmp_path / "lean", program=rattle)
    output = tmp_path / "o.wav"
    (tmp_path / "high.csv").write_text("frequency [Hz],amplitude [Pa/N],phase [rad]\n3e4,1,0\n4e4,1,0\n")
    for arguments, words in (
        (
            (tmp_path / "few" / "gearbox.1st.rattle", "--output", output),
            "has too few samples for its film force",
        ),
        ((tmp_path / "lean" / "gearbox.1st.rattle", "--output", output), "has no column 'acceleration'"),
        ((tmp_path / "absent.rattle", "--output", output), "cannot be read"),
        ((first, "--output", tmp_path / "o.mp3"), "a sound is written as FILE.wav"),
        (
            (first, "--output", output, "--transfer", tmp_path / "high.csv"),
            "no force in the range of the transfer",
        ),
        ((first, "--output", first), "is a result itself"),
    ):
        code, said, complained = called_here("listen.py", *arguments, cwd=tmp_path)
        assert (code, said) == (2, "") and words in complained, complained
        assert complained.count("\n") == 1 and not output.exists()
    code, _, complained = called_here(
        "listen.py", first, "--output", output, "--seconds", "1e9", cwd=tmp_path
    )
    assert code == 2 and "is not from 0.2 to 600 seconds" in complained
