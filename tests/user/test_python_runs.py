"""rattle.run, sweep and campaign: what they return, and what they say of bad input."""

from __future__ import annotations

import gc
import tempfile
import warnings
from pathlib import Path

import campaign_runs
import numpy as np
import pytest
from conftest import FAST_SCENE

import rattle
from rattle import codes
from rattle.faults import read_faults
from rattle.solve import literal

SCENE = {
    "contact": {"radius": 0.0127, "length": 0.010},
    "lubricant": {"viscosity": 0.3, "pressure_viscosity": 2.0e-8},
    "kinematics": {"entrainment_speed": 1.905},
    "load": {"mass": 3.0, "steady_force": 199.2, "force_amplitude": 205.7, "frequency": 600.0},
    "film": {"law": "iso-viscous"},
    "solver": {"steps_per_period": 32, "periods": 3, "method": "newmark"},
    "spectrum": {"periods": 2},
}
STEADY = {"accuracy": 1e-6, "until": "steady", "periods": 60}


@pytest.fixture(autouse=True)
def program(request, monkeypatch):
    """The program under test."""
    monkeypatch.setenv("RATTLE_PROGRAM", str(request.getfixturevalue("rattle")))


@pytest.fixture
def file(scene_text, tmp_path) -> Path:
    path = tmp_path / "file.nml"
    path.write_text(scene_text())
    return path


def test_file_text_and_dict_give_the_same_motion(file, solved):
    direct = rattle.read(solved("scene") / "scene.rattle")
    for given in (file, str(file), file.read_text(), SCENE):
        result, summary = rattle.run(given)
        assert summary["status"] == "complete"
        for name in direct.names:
            np.testing.assert_array_equal(result[name], direct[name])
    assert {group: set(keys) for group, keys in SCENE.items()} == {
        group: set(keys) for group, keys in FAST_SCENE.items() if group != "output"
    }


def test_set_replaces_keys_of_every_kind(file):
    changes = {
        "load.mass": np.float64(2.5),
        "solver.periods": 4,
        "spectrum.verify": False,
        "film.rupture": "solved",
        "output.columns": ["time", "acceleration"],
    }
    result, summary = rattle.run(file, set=changes)
    for key, value in changes.items():
        assert result.value(*key.split(".")) == value
    assert result.names == ("time", "acceleration")
    assert "verification" not in summary


def test_files_go_to_the_folder_and_are_not_replaced_unasked(file, tmp_path):
    folder = tmp_path / "out"
    result, _ = rattle.run(file, folder=folder)
    assert result.path == folder / "file.rattle"
    with pytest.raises(rattle.InputError, match="--overwrite replaces it"):
        rattle.run(file, folder=folder)
    result, _ = rattle.run(file, folder=folder, overwrite=True, set={"load.mass": 2.0})
    assert result.number("load", "mass") == 2.0


def test_a_temporary_folder_lives_as_long_as_its_result(file):
    result, _ = rattle.run(file)
    folder, column = result.path.parent, result["acceleration"]
    assert folder.exists()
    first = column.copy()
    del result
    gc.collect()
    assert not folder.exists()
    np.testing.assert_array_equal(column, first)


def test_without_a_series_there_is_a_summary_only(file):
    result, summary = rattle.run(file, set={"output.series": False})
    assert result is None and summary["name"] == "file"


def test_every_fault_is_carried_with_its_place(file):
    text = file.read_text().replace("mass =", "mas =").replace("'iso-viscous'", "'iso'")
    file.write_text(text)
    with pytest.raises(rattle.InputError) as refused:
        rattle.run(file, set={"contact.radius": -1.0})
    faults = {(fault.group, fault.key): fault for fault in refused.value.faults}
    lines = text.splitlines()
    misspelt = faults["load", "mas"]
    assert misspelt.file == str(file) and lines[misspelt.line - 1].strip().startswith("mas")
    assert "nearest known key is mass" in misspelt.message
    assert lines[faults["film", "law"].line - 1].strip().startswith("law")
    assert faults["load", "mass"].line is None
    assert faults["contact", "radius"].file == "--set contact.radius=-1.0"
    assert refused.value.exit_code == 2
    assert str(misspelt) in str(refused.value)


@pytest.mark.parametrize(
    ("line", "place"),
    (
        ("a b.nml:3: &load mass: no: really", ("a b.nml", 3, "load", "mass", "no: really")),
        ("in.nml: &load: no group", ("in.nml", None, "load", None, "no group")),
        ("in.nml: there is no such file", ("in.nml", None, None, None, "there is no such file")),
        ("--set a.b=1: &a b: unknown", ("--set a.b=1", None, "a", "b", "unknown")),
        ("no place at all", ("rattle", None, None, None, "no place at all")),
    ),
)
def test_a_fault_is_taken_apart_and_put_together(line, place):
    (fault,) = read_faults(line + "\n")
    assert tuple(fault) == place
    assert str(fault) == (line if fault.file != "rattle" else f"rattle: {line}")


def test_a_file_that_is_not_there_is_an_input_error(tmp_path):
    with pytest.raises(rattle.InputError, match="no such file"):
        rattle.run(tmp_path / "none.nml")


def test_a_scene_that_fails_brings_what_there_is(file):
    with pytest.raises(rattle.SceneFailed, match="not_converged") as failed:
        rattle.run(file, set={"load.force_amplitude": 1e9, "solver.iteration_limit": 2})
    assert failed.value.solved.summary["status"] == "not_converged"
    assert failed.value.solved.result.row_count >= 1


def test_a_campaign_varies_ranges_and_values(scene_text, tmp_path):
    vary = {
        "load.force_amplitude": rattle.Range(5.0, 205.0, 3),
        "kinematics.entrainment_speed": rattle.Range(0.5, 20.0, 4, scale="logarithmic"),
        "load.mass": [1.0, 2.5],
    }
    scene = {**SCENE, "solver": STEADY, "spectrum": {"periods": 8}}
    result, summary = rattle.campaign(scene, vary, record=["rattle_class", "film_minimum"], threads=1)
    assert summary["scenes_done"] == 24
    data = result.dataset()
    assert dict(data.sizes) == dict(zip(vary, (3, 4, 2), strict=True))
    assert result.varied == tuple(vary)
    np.testing.assert_allclose(data["kinematics.entrainment_speed"], np.geomspace(0.5, 20.0, 4))
    np.testing.assert_array_equal(data["load.mass"], [1.0, 2.5])
    (tmp_path / "one.nml").write_text(scene_text())
    single = rattle.run(
        {**scene, "load": {**SCENE["load"], "mass": 2.5, "force_amplitude": 105.0}},
        set={"kinematics.entrainment_speed": float(data["kinematics.entrainment_speed"][2])},
    )
    cell = data.isel({"load.force_amplitude": 1, "kinematics.entrainment_speed": 2, "load.mass": 1})
    assert codes.CLASSES[int(cell.rattle_class)] == single.summary["rattle_class"]
    assert float(cell.film_minimum) == pytest.approx(single.summary["film_minimum"], rel=1e-4)


def test_a_campaign_of_the_input_is_run_as_it_is(scene_text):
    text = campaign_runs.grid(scene_text, 3, 2)
    assert rattle.campaign(text).result.shape == (3, 2)
    sampled = {"load.mass": rattle.Range(1.0, 2.0)}
    scene = {**SCENE, "solver": STEADY}
    result, _ = rattle.campaign(scene, sampled, sample="sobol", size=5, seed=3)
    assert result.kind == "sample" and result.row_count == 5


RANGES = (
    "vary = 'load.force_amplitude', 'kinematics.entrainment_speed', scale = 'logarithmic', 'logarithmic', "
    "first = 5.0, 0.5, last = 105.0, 20.0, count = 5, 4"
)
PLANS = {
    "ranges": RANGES,
    "values": "vary = 'load.force_amplitude', 'load.frequency', values(:, 1) = 5, 7, 9, "
    "values(:, 2) = 500, 600",
    "table": "csv = 'scenes.csv'",
}
ASKED: dict[str, tuple[dict, dict]] = {
    "values": ({"load.mass": [2.0, 3.0, 4.0]}, {}),
    "a range": ({"load.mass": rattle.Range(2.0, 4.0, 3)}, {}),
    "both": ({"load.mass": rattle.Range(1.0, 4.0, 3, scale="logarithmic"), "load.gravity": [9.0, 9.8]}, {}),
    "more": (
        {
            "load.mass": rattle.Range(2.0, 4.0, 2),
            "load.gravity": rattle.Range(9.0, 9.8, 2),
            "load.force_scale": rattle.Range(0.5, 1.0, 2),
        },
        {},
    ),
    "a sample": ({"load.mass": rattle.Range(2.0, 4.0)}, {"sample": "sobol", "size": 3}),
}


@pytest.mark.parametrize("asked", ASKED)
@pytest.mark.parametrize("plan", PLANS)
def test_asked_keys_vary_instead_of_those_of_the_input(scene_text, tmp_path, plan, asked):
    """As in an input that has no plan of its own."""
    (tmp_path / "scenes.csv").write_text("load.mass\n2\n3\n")
    inputs = (scene_text(**campaign_runs.BASE) + f"\n&campaign\n{own}\n/\n" for own in (PLANS[plan], ""))
    found = []
    for text in inputs:
        (tmp_path / "scene.nml").write_text(text)
        vary, options = ASKED[asked]
        found.append(rattle.campaign(tmp_path / "scene.nml", vary, record=["film_minimum"], **options).result)
    replaced, alone = found
    assert replaced.varied == alone.varied == tuple(vary)
    assert replaced.kind == alone.kind
    for name in alone.names:
        np.testing.assert_array_equal(replaced[name], alone[name], err_msg=name)


def test_ranges_too_many_on_the_command_line_are_refused(scene_text):
    """What the command line says itself is not left out."""
    text = scene_text(**campaign_runs.BASE) + f"\n&campaign\n{RANGES}\n/\n"
    with pytest.raises(rattle.InputError, match="more ranges than varied keys"):
        rattle.campaign(text, {"load.mass": rattle.Range(2.0, 4.0, 3)}, set={"campaign.first": [2.0, 3.0]})


def test_failed_scenes_of_a_campaign_are_rows():
    scene = {**SCENE, "solver": STEADY, "film": {"law": "piezo-viscous", "model": "reynolds"}}
    result, summary = rattle.campaign(scene, {"load.force_amplitude": [1.0, 900.0]}, record=["film_minimum"])
    assert summary["scenes_failed_in_this_run"] == int(result.failed.sum()) > 0


def test_a_sweep_goes_there_and_back():
    scene = {**SCENE, "solver": {"accuracy": 1e-6, "periods": 60}}
    result, summary = rattle.sweep(scene, "frequency", 500.0, 700.0, count=3)
    assert summary["motions"] == 5
    frame = result.frame()
    assert frame.frequency.tolist() == [500.0, 600.0, 700.0, 600.0, 500.0]
    assert set(frame.rattle_class_word) <= set(codes.CLASSES.values())
    result, _ = rattle.sweep(scene, "frequency", 500.0, 700.0, count=3, turn=False, spacing="logarithmic")
    np.testing.assert_allclose(result["frequency"], np.geomspace(500.0, 700.0, 3))
    ends = rattle.Range(500.0, 700.0, 3, scale="logarithmic")
    again, _ = rattle.sweep(scene, "load.frequency", ends, turn=False)
    assert again.frame().equals(result.frame())
    with pytest.raises(TypeError, match="A Range has its last value"):
        rattle.sweep(scene, "frequency", ends, 700.0)
    with pytest.raises(rattle.InputError, match=r"'shaft\.frequency' is not allowed"):
        rattle.sweep(scene, "shaft.frequency", ends)


def test_frames_and_datasets_hold_the_columns_with_units(file):
    result, _ = rattle.run(file)
    frame, data = result.frame(), result.dataset()
    for name in result.names:
        np.testing.assert_array_equal(frame[name], result[name])
        np.testing.assert_array_equal(data[name], result[name])
    assert frame.attrs["units"] == dict(result.units)
    assert data.acceleration.attrs["units"] == "m s-2"
    assert data.acceleration.dims == ("time",)
    assert data.attrs["resolved_input"] == result.input_text


def test_extreme_rows_stand_where_their_times_are():
    scene = {**SCENE, "solver": {"periods": 20, "samples_per_period": 8}}
    result, _ = rattle.run(scene)
    assert result.coarse and result.extremes["time"].size
    frame = result.frame()
    assert len(frame) == result.row_count + result.extremes["time"].size
    assert frame.time.is_monotonic_increasing
    assert frame.acceleration.max() == result.extremes["acceleration"].max()


def test_keys_are_set_by_group_or_with_it(file):
    nested = rattle.run(file, set={"load": {"mass": 2.5, "gravity": 0.0}, "solver.periods": 4}).result
    assert [nested.value(*key) for key in (("load", "mass"), ("load", "gravity"), ("solver", "periods"))] == [
        2.5,
        0.0,
        4,
    ]
    with pytest.raises(rattle.InputError, match="unknown key; the nearest known key is mass"):
        rattle.run(file, set={"load": {"mas": 2.5}})
    with pytest.raises(
        TypeError, match=r"set\['gear'\] has to be a dict of keys: several pairs are 'gear\(1\)'"
    ):
        rattle.run(file, set={"gear": [{"backlash": 1e-4}]})


GEAR = {"teeth_1": 19, "teeth_2": 37, "normal_module": 2.2e-3, "helix_angle_deg": 28.0, "face_width": 0.016}
GEAR |= {"centre_distance": 0.070, "loose_inertia": 8.9e-4, "backlash": 9e-5, "drag_torque": 0.1}
BOX = {
    "gear": [{"name": "near", **GEAR}, {"name": "far", **GEAR, "backlash": 0.09}],
    "shaft": {"speed_rpm": 800.0, "orders": 2.0, "accelerations": 600.0},
    "oil": {"viscosity_40_cst": 58.0, "viscosity_100_cst": 9.6, "temperature_celsius": 50.0},
    "film": {"law": "iso-viscous", "model": "reynolds"},
    "solver": {"periods": 4, "starts": 1},
    "spectrum": {"periods": 1, "verify": False},
}


def test_what_is_odd_about_an_input_is_a_python_warning():
    """Here the number of the second pair: once, at the line of the caller, with its place."""
    with pytest.warns(rattle.InputWarning, match="it would be 9.000E-5 m if it was meant in mm") as warned:
        box = rattle.run(BOX)
    (one,) = warned
    assert one.filename == __file__
    fault = one.message.fault
    assert (fault.group, fault.key) == ("gear", "backlash")
    assert fault.line == rattle.solve.text_of(BOX).split("\n").index("   backlash = 0.09") + 1
    again = rattle.solve.text_of(box["far"].result.input)
    assert again.count("&gear\n") == 1 and "backlash = 0.09" in again
    # Set in both it is reported once.
    with pytest.warns(rattle.InputWarning) as warned:
        rattle.run(BOX, set={"gear": {"backlash": 0.08}})
    assert len(warned) == 1 and warned[0].message.fault.file == "--set gear.backlash=0.08"


@pytest.mark.parametrize("task", ("campaign", "threshold", "sweep"))
def test_every_task_warns_and_a_warning_may_be_an_error(task, monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    pair = {**BOX, "gear": BOX["gear"][1], "solver": {"periods": 4}, "spectrum": {"periods": 1}}
    arguments = {
        "campaign": ({"gear.drag_torque": [0.05, 0.2]},),
        "threshold": ("gear.drag_torque", 0.05, 0.2),
        "sweep": ("force_scale", 0.9, 1.0),
    }
    counted = {} if task == "campaign" else {"count": 2}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(rattle.InputWarning, match="0.09 m is not what machines have"):
            getattr(rattle, task)(pair, *arguments[task], **counted)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("value", "text"),
    ((True, ".true."), (3, "3"), (1e-14, "1e-14"), ("it's", "'it''s'"), (np.array([1.0, 2.0]), "1.0, 2.0")),
)
def test_values_become_namelist_text(value, text):
    assert literal(value) == text


def test_what_no_input_can_hold_is_refused():
    with pytest.raises(TypeError, match="not a value that an input can have"):
        literal(None)


def test_without_a_program_there_is_a_plain_sentence(monkeypatch, tmp_path):
    monkeypatch.delenv("RATTLE_PROGRAM")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("rattle.solve.PROGRAMS", ())
    with pytest.raises(rattle.RunError, match="no program rattle"):
        rattle.run(SCENE)
