"""NetCDF files of results of every task hold their columns exactly."""

from __future__ import annotations

from pathlib import Path

import campaign_runs
import numpy as np
import pytest
import xarray
from result_writer import write_motion
from script_calls import call_script

import rattle


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


def test_columns_and_stride_are_those_asked_for(results, tmp_path):
    output = tmp_path / "part.nc"
    names = ("time", "acceleration")
    done = call_script(
        "export.py", results["motion"], "--columns", ",".join(names), "--stride", 7, "--output", output
    )
    assert done.returncode == 0, done.stderr
    result = rattle.read(results["motion"])
    with xarray.open_dataset(output) as data:
        assert list(data.data_vars) == ["acceleration"]
        for name in names:
            np.testing.assert_array_equal(data[name].values, result[name][::7])


def test_extreme_rows_stand_where_their_times_are(tmp_path):
    extremes = [[0.0301, 200.0, 1e-6, 99.0]]
    path = write_motion(tmp_path / "a.rattle", lines={1.0: 2.0}, coarse=True, extremes=extremes)
    assert call_script("export.py", path, "--to", "netcdf").returncode == 0
    with xarray.open_dataset(path.with_suffix(".nc")) as data:
        assert np.all(np.diff(data["time"].values) > 0.0)
        assert data["acceleration"].values.max() == 99.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    (
        (("--output", "a.parquet"), "writes csv, netcdf"),
        (("--to", "netcdf", "--output", "-"), "netcdf needs a file"),
    ),
)
def test_what_cannot_be_written_is_refused(results, tmp_path, arguments, words):
    done = call_script("export.py", results["motion"], *arguments, cwd=tmp_path)
    assert done.returncode == 2 and words in done.stderr
    assert list(tmp_path.iterdir()) == []
