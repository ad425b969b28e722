"""Every result is a mapping of its columns, and a table of pandas and of xarray."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas
import pytest
import xarray
from campaign_writer import FORCES, SPEEDS, grid

import rattle as package
from rattle.result_file import ResultFile


@pytest.fixture(params=("motion", "film", "sweep", "threshold", "campaign", "unfinished", "pair"))
def result(request, rattle, repository, tmp_path: Path) -> ResultFile:
    if request.param in ("campaign", "unfinished"):
        undone = {"undone": [2], "closed": False} if request.param == "unfinished" else {}
        return package.read_campaign(
            grid(FORCES, SPEEDS, failures=True).write(tmp_path / "map.rattle", **undone)
        )
    place = repository / "input"
    options = {"program": rattle, "folder": tmp_path}
    if request.param == "pair":
        vary = {"gear.drag_scale": [0.5, 1.0]}
        solver = {"until": "steady", "periods": 4, "accuracy": 1e-4}
        given = {"solver": solver, "spectrum": {"periods": 1}, "film": {"law": "iso-viscous"}}
        solved = package.campaign(place / "gearbox.nml", vary, record=["film_minimum"], set=given, **options)
        return solved.result.pair("2nd")
    fast = {
        "motion": {"solver.periods": 20},
        "film": {},
        "sweep": {"sweep.count": 2},
        "threshold": {"threshold.count": 3, "threshold.tolerance": 0.2, "campaign.count": 2},
    }
    files = {"motion": "idle"}
    name = files.get(request.param, request.param)
    return package.run(place / f"{name}.nml", set=fast[request.param], **options).result


def test_a_result_is_a_mapping_that_pandas_and_xarray_take(result: ResultFile) -> None:
    names = list(result.names)
    assert isinstance(result, Mapping) and len(result) == len(names) and bool(result)
    assert list(result) == list(result.keys()) == list(dict(result)) == list({**result}) == names
    assert list(result | {"more": 1}) == [*names, "more"] and list({"more": 1} | result) == ["more", *names]
    assert names[0] in result and "no_such_column" not in result and result.get("no_such_column") is None
    frame = pandas.DataFrame(result)
    assert list(frame.columns) == names
    for (name, values), again in zip(result.items(), result.values(), strict=True):
        np.testing.assert_array_equal(values, result[name])
        np.testing.assert_array_equal(again, frame[name])
    again = copy.copy(result)
    assert list(again) == names and again.path == result.path
    assert result == result and result != again and len({result, again}) == 2
    table, data = result.to_dataframe(), result.to_xarray()
    assert set(names) <= set(table.columns) and isinstance(data, xarray.Dataset)
    assert set(names) <= set(data.variables) and data.attrs["resolved_input"] == result.input_text


def test_a_result_cannot_be_changed(result: ResultFile) -> None:
    name = result.names[0]
    for change in (
        lambda: result.update({name: 1.0}),
        lambda: result.pop(name),
        lambda: result.__setitem__(name, 1.0),
        lambda: result.__delitem__(name),
        result.clear,
    ):
        with pytest.raises(TypeError, match="cannot be changed"):
            change()
    with pytest.raises(KeyError, match=r"has no column 'no_such'; it holds") as refused:
        result["no_such"]
    assert isinstance(refused.value, package.ResultError) and str(refused.value)[0] != '"'


def test_the_pairs_of_a_gearbox_are_a_table(rattle, repository) -> None:
    fast = {
        "film": {"law": "iso-viscous", "model": "reynolds"},
        "solver": {"periods": 4, "starts": 1},
        "spectrum": {"periods": 1, "verify": False},
        "gear(2)": {"backlash": 8e-5},
    }
    box = package.run(repository / "input" / "gearbox.nml", set=fast, program=rattle)
    frame = box.to_dataframe()
    assert list(frame.index) == list(box) == ["1st", "2nd", "3rd", "4th"]
    for gear, solved in box.items():
        assert frame.film_minimum[gear] == solved.summary["film_minimum"]
    assert dict(box.to_xarray().sizes) == {"gear": 4}
    backlash = [solved.result.value("gear", "backlash") for solved in box.values()]
    assert backlash == [1e-4, 8e-5, 8e-5, 8e-5]


def test_the_version_has_the_name_that_python_gives_it() -> None:
    assert package.__version__ == package.version
    assert "__version__" in package.__all__
