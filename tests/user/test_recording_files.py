"""Every format of recordings, written by its own library, gives the channels that were put in."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import bench_recordings as bench
import h5py
import numpy as np
import pytest
import pyuff
import scipy.io
from asammdf import MDF, Signal
from nptdms import ChannelObject, TdmsWriter
from script_calls import called_here

from rattle import recordings

RATE = 2000.0
TIME = bench.times(1.5, RATE)
ENGINE = bench.Bench(span=1.5)
SPEED = ENGINE.speed_rpm(TIME)
FORCE = bench.series(bench.FORCE, ENGINE.angle(TIME)) / 1000.0


def write_mdf4(path: Path) -> None:
    with MDF(version="4.10") as file:
        file.append([Signal(SPEED, TIME, name="speed", unit="1/min")])
        file.append([Signal(FORCE, TIME, name="force", unit="kN")])
        file.append([Signal(np.array([b"idle"] * 5), np.arange(5.0), name="state", encoding="utf-8")])
        file.save(path, overwrite=True)


def write_mdf3(path: Path) -> None:
    with MDF(version="3.30") as file:
        signals = (("speed", SPEED, "1/min"), ("force", FORCE, "kN"))
        file.append([Signal(values, TIME, name=name, unit=unit) for name, values, unit in signals])
        file.save(path, overwrite=True)


def write_tdms(path: Path) -> None:
    waveform = {"wf_increment": 1.0 / RATE, "wf_start_offset": 0.0}
    with TdmsWriter(path) as writer:
        writer.write_segment(
            [
                ChannelObject("bench", "speed", SPEED, waveform | {"unit_string": "1/min"}),
                ChannelObject("bench", "force", FORCE, waveform | {"unit_string": "kN"}),
            ]
        )


def write_tdms_with_times(path: Path) -> None:
    with TdmsWriter(path) as writer:
        writer.write_segment(
            [
                ChannelObject("bench", "Time", TIME),
                ChannelObject("bench", "speed", SPEED, {"unit_string": "1/min"}),
                ChannelObject("bench", "force", FORCE, {"unit_string": "kN"}),
            ]
        )


def write_uff(path: Path, binary: int) -> None:
    file = pyuff.UFF(str(path))
    for name, values, unit in (("speed", SPEED, "1/min"), ("force", FORCE, "kN")):
        # What the library asks of every set.
        counts = ("ver_num", "load_case_id", "rsp_node", "rsp_dir", "ref_node", "ref_dir")
        axes = ("abscissa", "ordinate", "orddenom", "z_axis")
        kinds = ("spec_data_type", "len_unit_exp", "force_unit_exp", "temp_unit_exp")
        set_ = {key: 0 for key in (*counts, *(f"{axis}_{kind}" for axis in axes for kind in kinds))}
        set_ |= {key: "NONE" for key in ("id2", "id3", "id4", "id5", "rsp_ent_name", "ref_ent_name")}
        set_ |= {f"{axis}_axis_{word}_lab": "NONE" for axis in axes[:3] for word in ("", "units")}
        set_ |= {"type": 58, "binary": binary, "func_type": 1, "data": values, "x": TIME, "id1": name}
        set_ |= {"ordinate_axis_units_lab": unit, "abscissa_axis_units_lab": "s", "abscissa_spacing": 1}
        set_ |= {"abscissa_min": 0.0, "abscissa_inc": 1.0 / RATE, "z_axis_value": 0.0}
        set_ |= {f"{axis}_axis_lab": "NONE" for axis in axes}
        file.write_sets(set_, "add")


def write_mat(path: Path) -> None:
    bench_ = {"time": TIME, "speed": SPEED, "speed_unit": "1/min", "force": FORCE, "force_unit": "kN"}
    scipy.io.savemat(path, bench_)


def write_mat_with_structure(path: Path) -> None:
    scipy.io.savemat(path, {"bench": {"fs": RATE, "speed": SPEED[:, None], "force": FORCE}, "note": "idle"})


def write_hdf5(path: Path) -> None:
    with h5py.File(path, "w") as file:
        group = file.create_group("run 1")
        group["time"] = TIME
        for name, values, unit in (("speed", SPEED, "1/min"), ("force", FORCE, "kN")):
            group[name] = values
            group[name].attrs["unit"] = unit


def write_hdf5_with_rate(path: Path) -> None:
    with h5py.File(path, "w") as file:
        for name, values, unit in (("speed", SPEED, "1/min"), ("force", FORCE, "kN")):
            file[name] = values
            file[name].attrs["units"] = np.bytes_(unit)
            file[name].attrs["sample_rate"] = RATE


def write_mat_of_7_3(path: Path) -> None:
    """As MATLAB writes it: HDF5 behind a block of 512 bytes, vectors as tables of one row."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("time", TIME), ("speed", SPEED), ("force", FORCE)):
            file[name] = values[None, :]
    content = bytearray(path.read_bytes())
    words = b"MATLAB 7.3 MAT-file, Platform: GLNXA64"
    content[: len(words)] = words
    path.write_bytes(content)


FORMATS = {
    "mf4": write_mdf4,
    "mdf": write_mdf3,
    "tdms": write_tdms,
    "times.tdms": write_tdms_with_times,
    "uff": lambda path: write_uff(path, 0),
    "binary.uff": lambda path: write_uff(path, 1),
    "mat": write_mat,
    "structure.mat": write_mat_with_structure,
    "h5": write_hdf5,
    "rate.hdf5": write_hdf5_with_rate,
    "7.3.mat": write_mat_of_7_3,
}
WITHOUT_UNITS = ("structure.mat", "7.3.mat")


@pytest.mark.parametrize("name", FORMATS)
def test_channels_are_those_that_were_written(tmp_path: Path, name: str) -> None:
    path = tmp_path / f"run.{name}"
    FORMATS[name](path)
    channels = recordings.read_channels(path)
    # A universal file of text has numbers of few digits.
    close = 1e-4 if name == "uff" else 1e-6
    for short, values, unit in (("speed", SPEED, "rpm"), ("force", FORCE, "kN")):
        (channel,) = (channel for channel in channels if channel.name.split(".")[-1] == short)
        assert channel.unit == ("" if name in WITHOUT_UNITS else unit)
        np.testing.assert_allclose(channel.time, TIME, atol=1e-6)
        np.testing.assert_allclose(channel.values, values, rtol=close, atol=close)
    assert len(channels) == 2


@pytest.mark.parametrize("name", ("mf4", "tdms", "binary.uff", "structure.mat", "rate.hdf5"))
def test_a_mean_cycle_of_any_format(tmp_path: Path, name: str) -> None:
    FORMATS[name](tmp_path / f"run.{name}")
    place = "bench." if "structure" in name else ""
    given = ["--unit", f"{place}speed=rpm", "--unit", f"{place}force=kN"] if place else []
    options = ("--signal", f"{place}force", "--speed", f"{place}speed", "--output", "f.csv", *given)
    code, said, complained = called_here("recording.py", f"run.{name}", *options, cwd=tmp_path)
    assert code == 0, complained
    (row,) = (line.split() for line in said.splitlines() if line.startswith("2 "))
    assert float(row[1]) == pytest.approx(150.0, rel=0.005) and float(row[3]) == pytest.approx(-40.1, abs=1.0)


@pytest.mark.parametrize("name", FORMATS)
def test_a_file_that_is_cut_short_is_refused(tmp_path: Path, name: str) -> None:
    """Or what is left is read: never a traceback."""
    path = tmp_path / f"run.{name}"
    FORMATS[name](path)
    content = path.read_bytes()
    for share in (0.02, 0.3, 0.6, 0.95):
        path.write_bytes(content[: int(share * len(content))])
        code, said, complained = called_here("recording.py", "list", path.name, cwd=tmp_path)
        assert code in (0, 2) and (code == 0 or (complained.count("\n") == 1 and path.name in complained)), (
            complained
        )
        if code == 0:
            assert "speed" in said
        elif share > 0.02:
            assert "damaged or cut short" in complained or "channel" in complained, complained


@pytest.mark.parametrize("name", FORMATS)
def test_bytes_that_flip_never_end_in_a_traceback(tmp_path: Path, name: str) -> None:
    path = tmp_path / f"run.{name}"
    FORMATS[name](path)
    content = path.read_bytes()
    random = np.random.default_rng(7)
    for _ in range(3):
        damaged = bytearray(content)
        for place in random.integers(0, min(2000, len(damaged)), 20):
            damaged[place] = random.integers(256)
        path.write_bytes(damaged)
        code, _, complained = called_here("recording.py", "list", path.name, cwd=tmp_path)
        assert code in (0, 2) and "Traceback" not in complained


MISSING = (("mf4", "asammdf"), ("tdms", "npTDMS"), ("uff", "pyuff"), ("h5", "h5py"), ("csv", "pandas"))


@pytest.mark.parametrize(("suffix", "package"), MISSING)
def test_a_package_that_is_not_there_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str, package: str
) -> None:
    writer: Callable[[Path], object] = FORMATS.get(
        suffix, lambda path: bench.csv(path, ("time_s", "speed_rpm"), (TIME, SPEED))
    )
    writer(tmp_path / f"run.{suffix}")
    monkeypatch.setitem(__import__("sys").modules, package.lower(), None)
    code, _, complained = called_here("recording.py", "list", f"run.{suffix}", cwd=tmp_path)
    assert code == 2 and f"needs the package {package}: pip install 'rattle[recordings]'" in complained
