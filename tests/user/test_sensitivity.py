"""sensitivity.py: designs that run, indices that are known in closed form, and shares of rattling scenes."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from script_calls import called_here

import rattle as package
from rattle import sensitivity
from rattle.codes import CODES, QUANTITIES

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
    reported = table_of(said, "inertia_ratio")
    assert list(reported) == list(expected)
    for key, (first, total) in expected.items():
        # Intervals of 95 %: estimates of this one seed lie within one and a half of them.
        assert abs(reported[key][0] - first) <= 1.5 * reported[key][1] + 5e-4, key
        assert abs(reported[key][2] - total) <= 1.5 * reported[key][3] + 5e-4, key
        assert reported[key][1] < 0.35 and reported[key][3] < 0.35
    assert sorted(path.name for path in (tmp_path / "figures").iterdir()) == [
        "directions_pair_design.png",
        "sensitivity_pair_design.png",
    ]


def test_directions_are_those_of_a_product(run, tmp_path: Path) -> None:
    """inertia_ratio falls with drag_scale, grows with force_scale, and backlash is nothing to it."""
    write(tmp_path, "sample = 'sobol', size = 32, record = 'inertia_ratio'\n")
    ended = run("--set", "scene.task='campaign'", "pair.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    result = tmp_path / "results" / "pair.rattle"
    (study,) = sensitivity.studies(package.read_campaign(result), ["inertia_ratio"])
    (found,) = study.directions
    signs = dict(zip(study.keys, found.correlation, strict=True))
    assert found.by_chance == pytest.approx(1.96 / math.sqrt(31.0), rel=1e-3)
    # The logarithm of the drag spans 1.4, that of the force 0.4.
    assert signs["gear.drag_scale"] < -0.9 and 0.15 < signs["load.force_scale"] < 0.5
    assert abs(signs["gear.backlash"]) < found.by_chance
    code, _, complained = called_here("report.py", result, "--output", "page.html", cwd=tmp_path)
    assert code == 0, complained
    assert "Direction of each effect" in (tmp_path / "page.html").read_text()


def test_a_report_says_how_the_verdict_holds(run, tmp_path: Path) -> None:
    """By the campaign of its name beside it, if that is of the same input but for what it varies."""
    path = write(tmp_path, "sample = 'sobol', size = 8, record = 'verdict'\n")
    path.write_text(path.read_text().replace("first = 0.5, 0.8,", "first = 0.5, 0.02,"))
    (tmp_path / "motion.nml").write_text(INPUT)
    tolerances = ("--set", "scene.task='campaign'", "--set", "scene.name='motion_tolerances'", "--overwrite")
    for arguments in (("--set", "solver.starts=1", "motion.nml"), (*tolerances, "pair.nml")):
        ended = run(*arguments, cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
    (tmp_path / "alone").mkdir()
    for path in (tmp_path / "results").glob("motion.*"):
        (tmp_path / "alone" / path.name).write_bytes(path.read_bytes())
    campaign = package.read_campaign(tmp_path / "results" / "motion_tolerances.rattle")
    verdict = package.read_summary(tmp_path / "results" / "motion.summary.nml")["verdict"].strip()
    code = next(code for code, word in CODES["verdict"].items() if word == verdict)
    share = 100.0 * float(np.mean(np.array(campaign["verdict"]) == code))
    assert 0.0 < share < 100.0

    def page(folder: str) -> str:
        ended, _, complained = called_here(
            "report.py", f"{folder}/motion.rattle", "--output", "page.html", "--overwrite", cwd=tmp_path
        )
        assert ended == 0, complained
        return (tmp_path / "page.html").read_text()

    text = page("results")
    assert f"It holds in {share:.0f} % of 8 boxes drawn within tolerances." in text
    assert f"Within tolerances: {verdict} in {share:.0f} % of 8 drawn boxes (95 % interval" in text
    assert "olerances" not in page("alone")
    assert run(*tolerances, "--set", "shaft.speed_rpm=900", "pair.nml", cwd=tmp_path).returncode == 0
    text = page("results")
    assert "motion_tolerances.rattle is of another shaft.speed_rpm than this result" in text
    assert "It holds in" not in text


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


def test_size_means_scenes_and_is_reported_before(tmp_path: Path) -> None:
    """size = 64 has room for 8 blocks of 5 scenes; --blocks comes before it; without both there are 256."""
    for more, arguments, blocks in (
        ("size = 64", (), 8),
        ("size = 10, seed = 7", (), 2),
        ("size = 64", ("--blocks", 4), 4),
        ("", (), 256),
    ):
        write(tmp_path, f"sample = 'sobol', {more}\n" if more else "")
        code, said, complained = called_here(
            "sensitivity.py", "design", "pair.nml", "--overwrite", *arguments, cwd=tmp_path
        )
        assert code == 0, complained
        assert f"{blocks} blocks of 5 scenes for 3 keys: {5 * blocks} scenes\n" in complained
        assert len((tmp_path / "pair.design.csv").read_text().splitlines()) == 1 + 5 * blocks
        seed = 7 if "seed" in more else 1
        assert f"{blocks} blocks, seed {seed}," in (tmp_path / "pair_design.nml").read_text()
    write(tmp_path, "sample = 'sobol', size = 9\n")
    code, _, complained = called_here("sensitivity.py", "design", "pair.nml", cwd=tmp_path)
    assert code == 2 and "write size = 10 at least, or give --blocks" in complained


def test_the_scenes_of_all_pairs_are_reported(repository: Path, tmp_path: Path) -> None:
    path = tmp_path / "box.nml"
    path.write_text((repository / "input" / "gearbox_tolerances.nml").read_text())
    code, _, complained = called_here("sensitivity.py", "design", path, "--blocks", 2, cwd=tmp_path)
    assert code == 0
    assert "2 blocks of 7 scenes for 5 keys: 14 scenes of each of 4 pairs, 56 in all" in complained


def test_a_report_has_the_indices_with_their_intervals(run, tmp_path: Path) -> None:
    """The same numbers as those that the script prints; other campaigns have no such part."""
    result = designed(run, tmp_path, 16)
    _, said, _ = called_here("sensitivity.py", result, cwd=tmp_path)
    code, _, complained = called_here("report.py", result, "--output", "page.html", cwd=tmp_path)
    assert code == 0, complained
    page = (tmp_path / "page.html").read_text()
    part = page[page.index("Which keys matter") :]
    for quantity in ("film_force_rms", "inertia_ratio"):
        rows = part[part.index(QUANTITIES[quantity].meaning) :]
        for key, (first, first_error, total, total_error) in table_of(said, quantity).items():
            cells = re.findall(r"<td[^>]*>([^<]*)</td>", rows[rows.index(f"<code>{key}</code>") :])[:4]
            assert [float(cell) for cell in cells[::2]] == [first, total]
            for cell, value, half in zip(
                cells[1::2], (first, total), (first_error, total_error), strict=True
            ):
                low, high = map(float, cell.split(" to "))
                assert (low + high) / 2.0 == pytest.approx(value, abs=1e-3)
                assert (high - low) / 2.0 == pytest.approx(half, abs=1.1e-3)
    assert "share of the variance" in part.lower() and "<svg" in part
    write(tmp_path, "sample = 'sobol', size = 4, record = 'verdict'\n")
    run("--set", "scene.task='campaign'", "pair.nml", cwd=tmp_path)
    assert called_here("report.py", "results/pair.rattle", "--output", "other.html", cwd=tmp_path)[0] == 0
    assert "Which keys matter" not in (tmp_path / "other.html").read_text()


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
    write(tmp_path, "sample = 'sobol', size = 8, record = 'verdict'\n")
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
        ("not a campaign over a design", (result,)),
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
