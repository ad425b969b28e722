"""Recordings that cannot be used get a sentence each: what is wrong, where, what to type."""

from __future__ import annotations

import io
from pathlib import Path

import bench_recordings as bench
import h5py
import numpy as np
import pytest
import scipy.io
from script_calls import called_here

ENGINE = bench.Bench(span=1.0)
TIME = bench.times(1.0, 2000.0)
SPEED = ENGINE.speed_rpm(TIME)
FORCE = bench.series(bench.FORCE, ENGINE.angle(TIME))
RANDOM = np.random.default_rng(11)
NAN = np.full(len(TIME), np.nan)


def text(heads: str, *columns: np.ndarray) -> bytes:
    """A CSV file."""
    stream = io.StringIO()
    np.savetxt(stream, np.column_stack(columns), delimiter=",", header=heads, comments="", fmt="%.9g")
    return stream.getvalue().encode()


def changed(values: np.ndarray, where: slice | int, value: float) -> np.ndarray:
    copy = values.copy()
    copy[where] = value
    return copy


def hdf5(**columns: np.ndarray) -> bytes:
    stream = io.BytesIO()
    with h5py.File(stream, "w") as file:
        for name, values in columns.items():
            file[name] = values
    return stream.getvalue()


def mat(**columns: object) -> bytes:
    stream = io.BytesIO()
    scipy.io.savemat(stream, columns)
    return stream.getvalue()


GOOD = text("time_s,speed_rpm", TIME, SPEED)
BOTH = text("time_s,speed_rpm,force_N", TIME, SPEED, FORCE)
VOLTS = text("time_s,volts [V],force_N", TIME, ENGINE.wheel(TIME, 10), FORCE)
LINES = GOOD.decode().splitlines()
BY_SPEED = ("--speed", "speed_rpm", "--signal", "force_N")
TACHO = ("--tacho", "volts", "--signal", "force_N")
NOISE = RANDOM.normal(size=len(TIME))

# Name of the case: content of the file, options, what the sentence says.
CASES: dict[str, tuple[bytes, tuple[str, ...], str]] = {
    "empty": (b"", (), "is empty"),
    "blank lines": (b"\n\n \n", (), "no line of numbers"),
    "heads alone": (b"time_s,speed_rpm\n", (), "no line of numbers"),
    "prose": (b"Dear colleague,\nthe engine rattles.\n", (), "no line of numbers"),
    "one sample": (b"time_s,speed_rpm\n0.0,800.0\n", (), "1 sample"),
    "three samples": (b"time_s,speed_rpm\n0,800\n1,801\n2,802\n", (), "3 samples"),
    "constant speed": (text("time_s,speed_rpm", TIME, 0.0 * TIME + 800.0), (), "constant at 800"),
    "constant force": (text("time_s,speed_rpm,force_N", TIME, SPEED, 0.0 * TIME), BY_SPEED, "constant at 0"),
    "all not a number": (text("time_s,speed_rpm", TIME, NAN), (), "all are gaps"),
    "signal not a number": (text("time_s,speed_rpm,force_N", TIME, SPEED, NAN), BY_SPEED, "has 0 samples"),
    "time not a number": (text("time_s,speed_rpm", NAN, SPEED), (), "no sample of a known time"),
    "time goes back": (
        text("time_s,speed_rpm", changed(TIME, 7, 0.001), SPEED),
        (),
        "line 9: time goes back",
    ),
    "time stands still": (text("time_s,speed_rpm", 0.0 * TIME, SPEED), (), "stands still"),
    "infinite": (text("time_s,speed_rpm", TIME, changed(SPEED, 5, np.inf)), (), "line 7: 'inf'"),
    "too large": (text("time_s,speed_rpm", TIME, changed(SPEED, 5, 1e200)), (), "line 7"),
    "word among numbers": (
        "\n".join([*LINES[:9], "0.004,error", *LINES[10:]]).encode(),
        (),
        "line 10: 'error'",
    ),
    "more columns": ("\n".join([*LINES[:9], "0.004,1,2,3", *LINES[10:]]).encode(), (), "line 10"),
    "commas everywhere": (b"time,speed\n" + b"0,001,800,5\n0,002,801,5\n" * 9, (), "semicolons between"),
    "a quote that does not close": (b"time_s,speed_rpm\n" + b'0,1\n1,"2\n2,3\n3,4\n' * 9, (), ""),
    "junk": (RANDOM.bytes(5000), (), "neither text nor"),
    "junk without zeros": (bytes(RANDOM.integers(128, 160, 5000).tolist()), (), "neither text nor"),
    "no such channel": (GOOD, ("--signal", "force"), "has no channel 'force'; it has speed_rpm"),
    "no such number": (GOOD, ("--signal", "7"), "has no channel '7'"),
    "two of a name": (text("time_s,n,n", TIME, SPEED, SPEED), ("--signal", "n"), "choose by number, 1 or 2"),
    "several channels": (BOTH, (), "choose by --signal: speed_rpm [1/min], force_N [N]"),
    "nothing tells the angle": (BOTH, ("--signal", "force_N"), "--tacho (with --pulses)"),
    "no unit": (text("time_s,x", TIME, SPEED), (), "'x' has no unit"),
    "unit that does not fit": (
        text("time_s,x [kg]", TIME, SPEED),
        (),
        "'x' is in kg; rattle takes the speed",
    ),
    "unknown unit": (text("time_s,x [furlong/floop]", TIME, SPEED), (), "furlong/floop"),
    "unit of another channel": (GOOD, ("--unit", "force=N"), "has no channel 'force'"),
    "torque without radius": (text("time_s,x [N m]", TIME, SPEED), (), "--radius"),
    "no time, no angle": (text("speed_rpm", SPEED), (), "--rate"),
    "no time, no speed": (text("angle_deg,force_N", 720.0 * TIME, FORCE), (), "--speed-near"),
    "wrong channel as tacho": (BOTH, ("--tacho", "force_N"), "so it is not a tacho"),
    "noise as tacho": (text("time_s,volts,force_N", TIME, NOISE, FORCE), TACHO, ""),
    "constant tacho": (text("time_s,volts,force_N", TIME, 0.0 * TIME, FORCE), TACHO, "has no pulses"),
    "no gap in the wheel": (
        VOLTS,
        (*TACHO, "--pulses", "60", "--missing", "2"),
        "check --pulses and --missing",
    ),
    "all teeth missing": (VOLTS, (*TACHO, "--pulses", "2", "--missing", "2"), "cannot miss 2"),
    "a pulse a cycle": (VOLTS, ("--tacho", "volts", "--pulses", "3"), "do not show what the speed"),
    "few pulses": (VOLTS, (*TACHO, "--pulses", "10000"), "fewer than a revolution"),
    "tacho stops": (
        text(
            "time_s,volts,force_N", TIME, np.where(abs(TIME - 0.5) < 0.1, 0.0, ENGINE.wheel(TIME, 10)), FORCE
        ),
        (*TACHO, "--pulses", "10"),
        "drops out at 0.39",
    ),
    "wrong channel as angle": (text("time_s,a_deg,force_N", TIME, NOISE, FORCE), ("--angle", "a_deg"), ""),
    "constant angle": (
        text("time_s,a_deg,f_N", TIME, 0.0 * TIME, FORCE),
        ("--angle", "a_deg"),
        "an angle that",
    ),
    "angle goes back": (
        text("time_s,a_deg", TIME, changed(np.degrees(ENGINE.angle(TIME)), 900, 10.0)),
        ("--angle", "a_deg"),
        "goes back at 0.45 s",
    ),
    "speed through zero": (text("time_s,speed_rpm", TIME, SPEED - 810.0), (), "keeps its sign"),
    "drop-out to zero": (text("time_s,speed_rpm", TIME, changed(SPEED, 300, 0.0)), (), "--mend"),
    "long gap": (
        text("time_s,speed_rpm", TIME, changed(SPEED, slice(300, 400), np.nan)),
        (),
        "--bridge 0.051",
    ),
    "stamps missing": (
        text("time_s,speed_rpm", *np.delete([TIME, SPEED], slice(300, 400), 1)),
        (),
        "--bridge",
    ),
    "less than a cycle": (text("time_s,speed_rpm", TIME[:220], SPEED[:220]), (), "at least one whole cycle"),
    "less than a turn": (text("time_s,speed_rpm", TIME[:20], SPEED[:20]), (), "at least one"),
    "few samples a cycle": (
        text("time_s,force_N,n_rpm", TIME[::140], FORCE[::140], SPEED[::140]),
        ("--signal", "force_N", "--speed", "n_rpm"),
        "samples a cycle of 2 revolutions; it takes 4",
    ),
    "part outside": (GOOD, ("--part", "5,6"), "--part leaves 0 samples"),
    "no order at that speed": (text("time_s,force_N", TIME, NOISE), ("--speed-near", "800"), "--speed-near"),
    "too short to find a speed": (
        text("time_s,force_N", TIME[:400], FORCE[:400]),
        ("--speed-near", "800"),
        "three",
    ),
    "unit given twice": (GOOD, ("--unit", "speed_rpm=Hz", "--unit", "speed_rpm=rpm"), "twice"),
}

NAMED: dict[str, tuple[str, bytes, str]] = {
    "text as MDF": ("run.mf4", GOOD, "no MDF file, in spite of its name"),
    "text as TDMS": ("run.tdms", GOOD, "no TDMS file"),
    "text as MATLAB": ("run.mat", GOOD, "cannot be read as MATLAB"),
    "junk as HDF5": ("run.h5", RANDOM.bytes(4000), "no HDF5 file"),
    "junk as MATLAB": ("run.mat", RANDOM.bytes(4000), "cannot be read as MATLAB"),
    "beginning of MDF": ("run.mf4", b"MDF     4.10    " + RANDOM.bytes(3000), "cannot be read as MDF"),
    "beginning of TDMS": ("run.tdms", b"TDSm" + RANDOM.bytes(3000), ""),
    "beginning of HDF5": ("run.h5", b"\x89HDF\r\n\x1a\n" + RANDOM.bytes(3000), "cannot be read as HDF5"),
    "beginning of UFF": ("run.uff", b"    -1\n    58\n" + b"x" * 900, ""),
    "HDF5 of words": ("run.h5", hdf5(note=np.bytes_("idle")), "no channel of numbers"),
    "MATLAB of scalars": ("run.mat", mat(a=1.0, b="x"), "no channel of numbers"),
    "different lengths": ("run.h5", hdf5(time=TIME, speed=SPEED[:-5]), "--rate"),
}


def assert_refused(folder: Path, *arguments: object, said: str) -> None:
    before = sorted(folder.iterdir())
    code, _, complained = called_here("recording.py", *arguments, "--output", "out.csv", cwd=folder)
    assert code == 2, complained
    assert complained.startswith("recording.py: ") and complained.count("\n") == 1, complained
    assert said in complained, complained
    assert sorted(folder.iterdir()) == before


@pytest.mark.parametrize("case", CASES)
def test_a_recording_that_cannot_be_used(tmp_path: Path, case: str) -> None:
    content, options, said = CASES[case]
    (tmp_path / "run.csv").write_bytes(content)
    assert_refused(tmp_path, "run.csv", *options, said=said)


@pytest.mark.parametrize("case", NAMED)
def test_a_file_that_is_not_what_its_name_says(tmp_path: Path, case: str) -> None:
    name, content, said = NAMED[case]
    (tmp_path / name).write_bytes(content)
    assert_refused(tmp_path, name, "--unit", "speed=rpm", said=said)


def test_recordings_of_different_clocks(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_bytes(GOOD)
    (tmp_path / "b.csv").write_bytes(text("time_s,force_N", TIME + 5.0, FORCE))
    assert_refused(tmp_path, "a.csv", "b.csv", *BY_SPEED, said="of different clocks")


def test_places_that_cannot_be_read_or_written(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_bytes(GOOD)
    (tmp_path / "folder").mkdir()
    assert_refused(tmp_path, "none.csv", said="none.csv: No such file")
    assert_refused(tmp_path, "folder", said="is a folder")
    (tmp_path / "out.csv").write_text("mine\n")
    assert_refused(tmp_path, "run.csv", said="--overwrite replaces it")
    assert (tmp_path / "out.csv").read_text() == "mine\n"


def test_two_tachos_that_are_swapped(tmp_path: Path) -> None:
    """The other shaft turns 11/38 as fast: its pulses are as good, and no cycle of the force is one."""
    time = bench.times(2.0, 10000.0)
    engine = bench.Bench(span=2.0)
    force = bench.series({0.5: (50.0, 0.0), **bench.FORCE}, engine.angle(time))
    other = np.where(np.sin(60.0 * engine.angle(time) * 11.0 / 38.0) > 0.0, 5.0, 0.0)
    columns = (time, engine.wheel(time, 60), other, force)
    (tmp_path / "run.csv").write_bytes(text("time_s,input_V,output_V,force_N", *columns))
    options = ("--signal", "force_N", "--pulses", "60", "--output", "out.csv", "--overwrite")
    code, said, warned = called_here("recording.py", "run.csv", *options, "--tacho", "input_V", cwd=tmp_path)
    assert (code, warned) == (0, "")
    code, said, warned = called_here("recording.py", "run.csv", *options, "--tacho", "output_V", cwd=tmp_path)
    assert code == 0 and "differ by" in warned, said


def test_a_million_samples(tmp_path: Path) -> None:
    time = bench.times(10.0, 1e5)
    engine = bench.Bench(span=10.0)
    (tmp_path / "run.h5").write_bytes(hdf5(time=time, speed=engine.speed_rpm(time)))
    options = ("--unit", "speed=rpm", "--output", "out.csv")
    code, said, complained = called_here("recording.py", "run.h5", *options, cwd=tmp_path)
    assert (code, complained) == (0, "") and "67 whole cycles" in said
