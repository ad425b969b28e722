"""NetCDF and MAT-files of results of every task hold their columns exactly."""

from __future__ import annotations

import struct
from pathlib import Path

import campaign_runs
import numpy as np
import pytest
import xarray
from result_writer import write_motion
from script_calls import call_script

import rattle
from rattle.mat_file import write_mat
from rattle.result import ResultError


def read_mat(path: Path) -> dict[str, np.ndarray | str]:
    """Variables of a MAT-file of level 5, read as its description says."""
    raw = path.read_bytes()
    assert raw.startswith(b"MATLAB 5.0 MAT-file") and raw[124:128] == b"\x00\x01IM"
    found: dict[str, np.ndarray | str] = {}
    place = 128
    while place < len(raw):
        kind, size = struct.unpack_from("<II", raw, place)
        assert kind == 14 and size % 8 == 0
        parts, inner = [], place + 8
        place = inner + size
        while inner < place:
            kind, size = struct.unpack_from("<II", raw, inner)
            parts.append((kind, raw[inner + 8 : inner + 8 + size]))
            inner += 8 + -(-size // 8) * 8
        (_, flags), (_, shape), (_, name), (kind, data) = parts
        shape = struct.unpack(f"<{len(shape) // 4}i", shape)
        if flags[0] == 4:
            assert kind == 4 and shape == (1, len(data) // 2)
            found[name.decode()] = data.decode("utf-16-le")
        else:
            assert flags[0] == 6 and kind == 9
            found[name.decode()] = np.frombuffer(data, "<f8").reshape(shape, order="F")
    return found


@pytest.fixture(scope="module")
def results(tmp_path_factory, run, repository, scene_text) -> dict[str, Path]:
    """A result of each task."""
    folder = tmp_path_factory.mktemp("results")
    (folder / "map.nml").write_text(campaign_runs.grid(scene_text, 3, 4))
    inputs = {"motion": "creep", "sweep": "sweep", "film": "film"}
    options = {"sweep": ("--set", "sweep.count=5")}
    found = {}
    for task, name in inputs.items():
        ended = run(
            repository / "input" / f"{name}.nml", *options.get(task, ()), "--output", folder, cwd=folder
        )
        assert ended.returncode == 0, ended.stderr
        found[task] = folder / f"{name}.rattle"
    assert run("map.nml", "--output", folder, cwd=folder).returncode == 0
    return {**found, "campaign": folder / "map.rattle"}


@pytest.mark.parametrize("task", ("motion", "sweep", "film", "campaign"))
def test_mat_files_hold_every_column_and_unit(results, task):
    path = results[task]
    done = call_script("export.py", path, "--to", "mat")
    assert (done.returncode, done.stdout, done.stderr) == (0, f"{path.with_suffix('.mat')}\n", "")
    result, held = rattle.read(path), read_mat(path.with_suffix(".mat"))
    for name in result.names:
        known = name.replace(".", "_")
        np.testing.assert_array_equal(held[known], result[name][:, None])
        assert held[f"{known}_unit"] == result.units[name]
    assert held["resolved_input"] == result.input_text
    assert len(held) == 2 * len(result.names) + 3


@pytest.mark.parametrize("task", ("motion", "sweep", "film", "campaign"))
def test_netcdf_files_hold_every_column_and_unit(results, task, tmp_path):
    output = tmp_path / "out.nc"
    done = call_script("export.py", results[task], "--output", output)
    assert (done.returncode, done.stdout) == (0, f"{output}\n"), done.stderr
    result = rattle.read(results[task])
    with xarray.open_dataset(output) as data:
        along = {"motion": ["time"], "sweep": ["row"], "film": ["row"]}.get(task)
        assert list(data.sizes) == (along or ["load.force_amplitude", "kinematics.entrainment_speed"])
        for name in result.names:
            if name not in data.sizes or task == "motion":
                np.testing.assert_array_equal(data[name].values.ravel(), result[name])
        assert data.attrs["resolved_input"] == result.input_text
        assert data["acceleration_maximum" if task in ("sweep", "campaign") else result.names[1]].attrs[
            "units"
        ]


@pytest.mark.parametrize("form", ("netcdf", "mat"))
def test_columns_and_stride_are_those_asked_for(results, tmp_path, form):
    output = tmp_path / f"part{'.nc' if form == 'netcdf' else '.mat'}"
    names = ("time", "acceleration")
    done = call_script(
        "export.py", results["motion"], "--columns", ",".join(names), "--stride", 7, "--output", output
    )
    assert done.returncode == 0, done.stderr
    result = rattle.read(results["motion"])
    if form == "mat":
        held = read_mat(output)
        assert {"film_thickness", "applied_force"}.isdisjoint(held)
    else:
        with xarray.open_dataset(output) as data:
            held = {name: data[name].values[:, None] for name in names}
            assert list(data.data_vars) == ["acceleration"]
    for name in names:
        np.testing.assert_array_equal(held[name], result[name][::7, None])


def test_extreme_rows_stand_where_their_times_are(tmp_path):
    extremes = [[0.0301, 200.0, 1e-6, 99.0]]
    path = write_motion(tmp_path / "a.rattle", lines={1.0: 2.0}, coarse=True, extremes=extremes)
    assert call_script("export.py", path, "--to", "mat").returncode == 0
    held = read_mat(path.with_suffix(".mat"))
    assert np.all(np.diff(held["time"][:, 0]) > 0.0)
    assert held["acceleration"].max() == 99.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    (
        (("--output", "a.parquet"), "writes csv, netcdf, mat"),
        (("--to", "mat", "--output", "-"), "mat needs a file"),
    ),
)
def test_what_cannot_be_written_is_refused(results, tmp_path, arguments, words):
    done = call_script("export.py", results["motion"], *arguments, cwd=tmp_path)
    assert done.returncode == 2 and words in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_names_that_become_one_are_refused(tmp_path):
    with pytest.raises(ResultError, match="both called a_b"):
        write_mat(tmp_path / "a.mat", {"a.b": np.zeros(2), "a_b": np.zeros(2)}, {})
