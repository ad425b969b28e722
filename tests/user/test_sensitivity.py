"""sensitivity.py: designs that run, indices that are known in closed form, and shares of rattling scenes."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from script_calls import called_here

import rattle as package

INPUT = """&gear
   teeth_1 = 19, teeth_2 = 37, normal_module = 2.2e-3, helix_angle_deg = 28.0, face_width = 0.016
   centre_distance = 0.070, loose_inertia = 8.9e-4, backlash = 9e-5
   bearing_mean_diameter = 0.038, immersion_depth = 0.030730400709
/
&shaft speed_rpm = 800.0, orders = 2.0, 4.0, accelerations = 600.0, 100.0, phases = 0.0, 0.8 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 50.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver periods = 6, accuracy = 1e-5, samples_per_period = 64 /
&spectrum periods = 1 /
"""
SPREAD = """&campaign
   vary = 'gear.drag_scale', 'load.force_scale', 'gear.backlash'
   first = 0.5, 0.8, 8e-5
   last = 2.0, 1.2, 1e-4
   scale = 'logarithmic', 'linear', 'linear'
   samples_per_period = 64
"""


def write(folder: Path, more: str = "") -> Path:
    path = folder / "pair.nml"
    path.write_text(f"{INPUT}{SPREAD}{more}/\n")
    return path


def designed(run, folder: Path, blocks: int, more: str = "") -> Path:
    write(folder, more)
    code, said, complained = called_here(
        "sensitivity.py", "design", "pair.nml", "--blocks", blocks, cwd=folder
    )
    assert code == 0, complained
    assert said.split() == ["pair.design.csv", "pair_design.nml"]
    ended = run("pair_design.nml", cwd=folder, timeout=300.0)
    assert ended.returncode == 0, ended.stderr
    return folder / "results" / "pair_design.rattle"


def table_of(said: str, quantity: str) -> dict[str, list[float]]:
    lines = said[said.index(f"\n{quantity} ") :].split("\n")[3:]
    rows = [line.split() for line in lines[: lines.index("")]]
    return {key: list(map(float, numbers)) for key, *numbers in rows}


@pytest.mark.long
def test_indices_of_a_product(run, tmp_path: Path) -> None:
    """inertia_ratio is force_scale over drag_scale times a constant: its indices are known in closed form."""
    result = designed(run, tmp_path, 256)
    code, said, complained = called_here("sensitivity.py", result, "--output", "figures", cwd=tmp_path)
    assert code == 0, complained
    # 1/x of x spread by its logarithm from 1/2 to 2; a uniform number from 0.8 to 1.2.
    mean, square = 1.5 / math.log(4.0), 3.75 / (2.0 * math.log(4.0))
    drag, force = square - mean**2, 0.4**2 / 12.0
    whole = square * (1.0 + force) - mean**2
    expected = {
        "gear.drag_scale": (drag / whole, drag * (1.0 + force) / whole),
        "load.force_scale": (force * mean**2 / whole, force * square / whole),
        "gear.backlash": (0.0, 0.0),
    }
    told = table_of(said, "inertia_ratio")
    assert list(told) == list(expected)
    for key, (first, total) in expected.items():
        # Intervals of 95 %: estimates of this one seed lie within one and a half of them.
        assert abs(told[key][0] - first) <= 1.5 * told[key][1] + 5e-4, key
        assert abs(told[key][2] - total) <= 1.5 * told[key][3] + 5e-4, key
        assert told[key][1] < 0.35 and told[key][3] < 0.35
    assert sorted(path.name for path in (tmp_path / "figures").iterdir()) == [
        "sensitivity_pair_design.pdf",
        "sensitivity_pair_design.png",
    ]


def test_the_design_fills_its_ranges(run, tmp_path: Path) -> None:
    campaign = package.read_campaign(designed(run, tmp_path, 16))
    assert campaign.row_count == 16 * 5
    for key, low, high in (
        ("gear.drag_scale", 0.5, 2.0),
        ("load.force_scale", 0.8, 1.2),
        ("gear.backlash", 8e-5, 1e-4),
    ):
        values = np.array(campaign[key])
        assert low <= values.min() < low + 0.1 * (high - low)
        assert high >= values.max() > high - 0.2 * (high - low)
    # Half of what is spread by its logarithm lies below the geometric mean.
    assert np.mean(np.array(campaign["gear.drag_scale"]) < 1.0) == pytest.approx(0.5, abs=0.1)


def test_the_probability_is_the_share_of_independent_scenes(run, tmp_path: Path) -> None:
    result = designed(run, tmp_path, 16, "record = 'verdict', 'film_force_rms'\n")
    campaign = package.read_campaign(result)
    verdicts = np.array(campaign["verdict"]).reshape(16, 5)[:, [0, 4]]
    code, said, _ = called_here("sensitivity.py", result, cwd=tmp_path)
    assert code == 0
    share, low, high = map(
        float, re.search(r"impacts ([\d.]+), 95% interval ([\d.]+) to ([\d.]+)", said).groups()
    )
    assert share == pytest.approx(np.mean(verdicts >= 2), abs=5e-4)
    # Wilson's interval, by its definition: where the share is one and 0.975 quantiles of its own error away.
    for end in (low, high):
        error = 1.96 * math.sqrt(max(end * (1.0 - end), 0.0) / verdicts.size)
        assert abs(share - end) == pytest.approx(error, abs=2e-3)


def test_a_sample_has_a_probability_and_no_indices(run, tmp_path: Path) -> None:
    write(tmp_path, "sample = 'sobol', size = 16, record = 'verdict'\n")
    ended = run("--set", "scene.task='campaign'", "pair.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    result = tmp_path / "results" / "pair.rattle"
    code, said, complained = called_here("sensitivity.py", result, cwd=tmp_path)
    assert code == 0, complained
    share = float(re.search(r"impacts ([\d.]+),", said)[1])
    assert share == pytest.approx(np.mean(np.array(package.read_campaign(result)["verdict"]) >= 2), abs=5e-4)
    assert "first order" not in said


def test_what_is_no_design_is_refused(run, tmp_path: Path) -> None:
    result = designed(run, tmp_path, 2, "record = 'film_force_rms', 'rattle_class'\n")
    rows = (tmp_path / "pair.design.csv").read_text().splitlines()
    (tmp_path / "pair.design.csv").write_text("\n".join([*rows[:2], rows[3], rows[2], *rows[4:], ""]))
    assert run("--overwrite", "pair_design.nml", cwd=tmp_path).returncode == 0
    for words, arguments in (
        ("no campaign over a design", (result,)),
        ("no numbers of 'rattle_class'", (result, "--quantities", "rattle_class")),
        ("no numbers of 'crest_factor'", (result, "--quantities", "crest_factor")),
        ("exists; --overwrite replaces it", ("design", "pair.nml")),
    ):
        code, _, complained = called_here("sensitivity.py", *arguments, cwd=tmp_path)
        assert code == 2 and words in complained, complained
    (tmp_path / "pair.nml").write_text(INPUT)
    code, _, complained = called_here("sensitivity.py", "design", "pair.nml", cwd=tmp_path)
    assert code == 2 and "no group &campaign" in complained
    for wrong in (
        "vary = 'gear.backlash', first = 1e-4",
        "vary = 'gear.backlash', first = 2e-4, last = 1e-4",
    ):
        (tmp_path / "pair.nml").write_text(f"{INPUT}&campaign {wrong} /\n")
        code, _, complained = called_here("sensitivity.py", "design", "pair.nml", cwd=tmp_path)
        assert code == 2 and "Traceback" not in complained
