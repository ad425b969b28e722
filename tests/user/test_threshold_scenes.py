"""Both ends of every row of a threshold, compared with the scenes that stand there, each solved alone."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

import rattle as package
from rattle.campaign_plan import GEAR
from rattle.codes import CODES

sys.path.insert(0, str(Path(__file__).parents[1] / "stress"))

import gear_rows

# Enough for rows, so that single scenes take no more of them.
SAMPLES = 1024
# Both take the same steps from one start; sums over samples may be taken in another order.
TOLERANCE = 1e-9
LEVELS = {
    "film_force_rms": 100.0,
    "load_maximum": 40.0,
    "acceleration_maximum": 60.0,
    "harmonic_count": 6.0,
    "impacts_per_period_coast": 0.5,
    "coast_film_minimum": 2e-6,
}
FORCES = "key = 'load.force_amplitude', first = 5.0, last = 455.0, count = 9, tolerance = 0.02"
SPEEDS = "&campaign vary = 'kinematics.entrainment_speed', values(:, 1) = 0.8, 4.0 /\n"
SCALES = (
    "key = 'load.force_scale', first = 0.1, last = 4.0, scale = 'logarithmic', count = 9, tolerance = 0.05"
)
STIFFNESSES = "&campaign vary = 'contact.stiffness', values(:, 1) = 2.8e8, 1e9 /\n"
RIGID = {
    "solver": {"until": "'steady'", "periods": "60", "accuracy": "1e-6"},
    "spectrum": {"periods": "8"},
}
PIEZO = {
    **RIGID,
    "contact": {"length": "1.958e-3"},
    "load": {"steady_force": "38.27", "force_amplitude": "203.1"},
    "film": {"law": "'piezo-viscous'", "initial_film": "0.889e-6"},
}
SOFT = {
    **RIGID,
    "contact": {"radius": "7.5e-3", "length": "0.02", "backlash": "1e-4", "stiffness": "2.8e8"},
    "lubricant": {"viscosity": "0.05"},
    "kinematics": {"entrainment_speed": "1.07"},
    "load": {
        "mass": "0.45",
        "steady_force": "5.0",
        "frequency": "26.7",
        "force_amplitude": None,
        "force_orders": "1, 2, 3",
        "force_amplitudes": "7.9, 2.0, 0.8",
        "force_phases": "0.0, 0.5, 1.1",
    },
    "film": {"model": "'reynolds'"},
}


def criterion_text(criterion: str) -> str:
    level = f", level = {LEVELS[criterion]!r}" if criterion in LEVELS else ""
    return f", criterion = '{criterion}'{level}"


def ends_that_differ(run, folder: Path, text: str, threshold: str, campaign: str) -> tuple[list[str], int]:
    """What the ends of rows have different from their scenes alone, and how many crossings there were.

    Of a box each pair is solved alone.
    """
    samples = f"&campaign samples_per_period = {SAMPLES}"
    campaign = re.sub("&campaign", samples, campaign) or f"{samples} /\n"
    (folder / "edge.nml").write_text(
        f"&scene task = 'threshold' /\n{text}&threshold {threshold} /\n{campaign}"
    )
    ended = run("--overwrite", "edge.nml", cwd=folder)
    assert ended.returncode in (0, 1), ended.stderr
    result = package.read(folder / "results" / "edge.rattle")
    gears = text.split("&gear")[1:]
    (key,) = re.findall(r"key = '(.*?)'", threshold)
    varied = [name for name in result.names if "." in name]
    found = []
    for row in range(result.row_count):
        (folder / "alone.nml").write_text(one_pair(text, int(result[GEAR][row])) if len(gears) > 1 else text)
        held = [(name, float(result[name][row])) for name in varied]
        for side, end in (("below", "lower"), ("above", "upper")):
            value = float(result[end][row])
            settings = [f"{name}={number!r}" for name, number in (*held, (key, value))]
            words = [word for setting in settings for word in ("--set", setting)]
            ended = run("--overwrite", *words, "alone.nml", cwd=folder)
            assert ended.returncode in (0, 1), ended.stderr
            reported = summary_of(folder / "results" / "alone.summary.nml")
            if "verification" in reported:
                reported["verified"] = verified(result, reported)
            found += [
                f"row {row + 1}, {side}, {value!r}: {fault}" for fault in faults(result, row, side, reported)
            ]
    return found, int((result["crossing"] > 0).sum())


def verified(result: package.Result, reported: dict) -> float:
    """Whether what the criterion looks at stands when the scene is solved again, tighter."""
    names = [name.removesuffix("_below") for name in result.names if name.endswith("_below")]
    if {"verdict", "double_sided", "separation"} & set(names):
        return float(reported["verdict_verified"])
    if any(name.startswith("impact") for name in names):
        return float(reported["impacts_verified"])
    return float(reported["verification"] == "verified")


def one_pair(text: str, number: int) -> str:
    """The input of one pair of a box."""
    groups = re.findall(r"&gear\n.*?^/\n", text, re.MULTILINE | re.DOTALL)
    for place, group in enumerate(groups, start=1):
        if place != number:
            text = text.replace(group, "")
    return text


def faults(result: package.Result, row: int, side: str, reported: dict):
    """What one end of a row says and its scene does not."""
    columns = [name.removesuffix(f"_{side}") for name in result.names if name.endswith(f"_{side}")]
    # Where the motions of the side end is no quantity of a scene: tests/user/test_threshold_ends.py.
    columns = [name for name in columns if name not in ("last", "motion_end")]
    assert len(columns) == 2 + ("verified" in columns)
    for name in columns:
        here = float(result[f"{name}_{side}"][row])
        if name == "verified" and result["crossing"][row] == 0.0:
            assert np.isnan(here)  # a trace without a crossing is not put to the test
            continue
        if name not in reported:
            if not np.isnan(here):
                yield f"{name} is {here!r}, which the scene does not tell"
            continue
        alone = reported[name]
        if name in CODES:
            alone = {words: code for code, words in CODES[name].items()}[str(alone).strip()]
        if not abs(here - float(alone)) <= TOLERANCE * abs(float(alone)):
            yield f"{name} is {here!r}, alone {alone!r}"


def sampled(scene_text, changes: dict) -> str:
    solver = {"steps_per_period": None, "method": None, "samples_per_period": str(SAMPLES)}
    return scene_text(**{**changes, "solver": {**solver, **changes["solver"]}})


@pytest.mark.parametrize(
    "criterion", ("class", "idle", "film_force_rms", "acceleration_maximum", "harmonic_count")
)
def test_ends_on_one_rigid_flank(criterion, run, scene_text, tmp_path: Path) -> None:
    text = sampled(scene_text, RIGID)
    found, crossings = ends_that_differ(run, tmp_path, text, FORCES + criterion_text(criterion), SPEEDS)
    assert found == [] and crossings >= 2


@pytest.mark.parametrize("criterion", ("class", "subharmonic"))
def test_ends_of_motions_longer_than_a_period(criterion, run, scene_text, tmp_path: Path) -> None:
    text = sampled(scene_text, PIEZO)
    found, crossings = ends_that_differ(run, tmp_path, text, FORCES + criterion_text(criterion), "")
    assert found == [] and crossings >= 2


@pytest.mark.long
@pytest.mark.parametrize(
    "criterion",
    ("class", "verdict", "double_sided", "impacts_per_period_coast", "coast_film_minimum", "load_maximum"),
)
def test_ends_between_two_flanks_that_give(criterion, run, scene_text, tmp_path: Path) -> None:
    text = sampled(scene_text, SOFT)
    found, crossings = ends_that_differ(run, tmp_path, text, SCALES + criterion_text(criterion), STIFFNESSES)
    assert found == [] and crossings >= 2


@pytest.mark.long
@pytest.mark.parametrize("criterion", ("idle", "impacts", "double_sided"))
def test_ends_of_a_box(criterion, run, repository: Path, tmp_path: Path) -> None:
    """Each pair of the ready thresholds of a box, over a coarser scan, at a speed."""
    text = (repository / "input" / "gearbox_threshold.nml").read_text()
    text = text[text.index("&gear") : text.index("&threshold")]
    shutil.copy(repository / "input" / "gearbox_run_up.csv", tmp_path)
    text = text.replace("periods = 60", f"periods = 60, samples_per_period = {SAMPLES}")
    threshold = "key = 'oil.temperature_celsius', first = -20.0, last = 60.0, count = 3, tolerance = 0.05"
    speeds = "&campaign vary = 'shaft.speed_rpm', values(:, 1) = 800.0 /\n"
    found, crossings = ends_that_differ(run, tmp_path, text, threshold + criterion_text(criterion), speeds)
    assert found == [] and crossings >= 2


@pytest.mark.long
def test_a_bound_below_the_level_is_on_no_side(run, rattle: Path, tmp_path: Path) -> None:
    """Of impacts as short as these at least 40 harmonics are known, which may be more than the level."""
    case = gear_rows.draw(35, gear_rows.numeric_keys(rattle))
    (tmp_path / "cycle.csv").write_text(case.signal)
    text = re.sub(r"force_scale = .*", "force_scale = 1.0", case.text).replace(
        "samples_per_period = 512", f"samples_per_period = {SAMPLES}"
    )
    threshold = "key = 'gear.drag_torque', first = 0.02, last = 1.0, count = 6, tolerance = 0.02"
    threshold += ", criterion = 'harmonic_count', level = 100.0"
    found, _ = ends_that_differ(run, tmp_path, text, threshold, "")
    unknown = [fault for fault in found if "harmonic_count is nan, alone" in fault]
    assert unknown == found and all(fault.split()[-1] == "40" for fault in unknown) and unknown
