"""Several &gear in one input: each pair as if it stood alone, one table of all, an axis of campaigns."""

from __future__ import annotations

import fcntl
import re
import signal
import subprocess
from pathlib import Path

import campaign_writer
import numpy as np
import pytest
from outcomes import assert_faults, summary_of
from report_reader import read_page
from script_calls import call_script
from waiting import until

import rattle as package
from rattle import rerun
from rattle.campaign_section import new_section
from rattle.figures import campaign_map, style

FIRST = """&gear
   name = '1st', teeth_1 = 11, teeth_2 = 38, normal_module = 2.5e-3, helix_angle_deg = 28.96
   face_width = 0.016, loose_inertia = 1.715e-3, drag_torque = 0.10, backlash = 1e-4, tooth_stiffness = 14e9
/
"""
FOURTH = """&gear
   name = '4th', teeth_1 = 33, teeth_2 = 32, normal_module = 1.85e-3, helix_angle_deg = 30.8
   face_width = 0.016, loose_inertia = 2.8e-4, drag_torque = 0.05, backlash = 8e-5, tooth_stiffness = 0
/
"""
SHARED = """&shaft speed_rpm = 800.0, orders = 2.0, 4.0, accelerations = 600.0, 100.0 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 0.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver periods = 8, accuracy = 1e-6, method = 'taylor' /
&spectrum periods = 2 /
"""
BOTH = FIRST + FOURTH + SHARED
TAYLOR = {"method": "'taylor'", "steps_per_period": None}
CAMPAIGN = "&campaign record = 'rattle_class', 'double_sided', 'film_force_rms', 'deflection_share', "
GRID = CAMPAIGN + (
    "vary = 'shaft.speed_rpm', 'gear.drag_torque' first = 700.0, 0.05 last = 900.0, 0.1 count = 3, 2 /\n"
)
SAMPLE = CAMPAIGN + (
    "vary = 'shaft.speed_rpm', 'oil.temperature_celsius' first = 700.0, -20.0 last = 900.0, 10.0 size = 5 "
)
PLANS = {
    "grid": GRID,
    "sobol": SAMPLE + "sample = 'sobol' /\n",
    "csv": CAMPAIGN + "csv = 'scenes.csv' /\n",
}


@pytest.fixture
def solve(run, tmp_path: Path):
    """Writes an input and runs it."""

    def call(name: str, text: str, *arguments: object, ends: int = 0):
        (tmp_path / f"{name}.nml").write_text(text)
        (tmp_path / "scenes.csv").write_text(
            "shaft.speed_rpm,gear.drag_torque\n800,0.05\n750,0.1\n900,0.07\n"
        )
        ended = run(f"{name}.nml", "--verbose", "--overwrite", *arguments, cwd=tmp_path, timeout=600.0)
        assert ended.returncode == ends, ended.stderr
        return ended

    return call


def campaign_text(pairs: str, plan: str) -> str:
    return "&scene task = 'campaign' /\n" + pairs + SHARED + plan


def test_each_pair_is_the_scene_of_its_own_input(solve, tmp_path: Path) -> None:
    ended = solve("box", BOTH)
    for gear, text in (("1st", FIRST), ("4th", FOURTH)):
        solve("alone", f"&scene name = 'box.{gear}' /\n" + text + SHARED, "--output", "alone")
        for ending in ("rattle", "state"):
            name = f"box.{gear}.{ending}"
            assert (tmp_path / "results" / name).read_bytes() == (tmp_path / "alone" / name).read_bytes(), (
                name
            )
        assert summary_of(tmp_path / "results" / f"box.{gear}.summary.nml")["gear"] == gear
    table = package.read_summary(tmp_path / "results" / "box.summary.nml")
    assert list(table["gears"]) == ["1st", "4th"]
    force, power = 0.0, 0.0
    for gear, reported in table["gears"].items():
        summary = summary_of(tmp_path / "results" / f"box.{gear}.summary.nml")
        for name, value in reported.items():
            if name not in ("verified", "summary_checksum"):
                assert summary[name] == value, name
        force, power = force + reported["film_force_rms"] ** 2, power + reported["dissipated_power"]
    assert table["film_force_rms_uncorrelated"] == pytest.approx(force**0.5, rel=1e-14)
    # Of a run that looks for no repetition the window is the last two of its periods, for all pairs.
    in_phase = np.std(sum(force_of(tmp_path / "results", gear, 2) for gear in ("box.1st", "box.4th")))
    # Samples of 1024 a period are some thousandths off the steps, which show the rms of each pair.
    assert table["film_force_rms_in_phase"] == pytest.approx(in_phase, rel=3e-3)
    assert table["film_force_rms_in_phase"] > 1.02 * table["film_force_rms_uncorrelated"]
    assert "over the last 2 periods of 8, the window of all pairs" in table["film_force_text"]
    assert "film_force_rms" not in table
    assert table["dissipated_power"] == pytest.approx(power, rel=1e-14)
    power = f"{table['dissipated_power']:.4g}"
    assert re.search(
        rf"^  together, uncorrelated +{table['film_force_rms_uncorrelated']:.4g} +{power}$",
        ended.stdout,
        re.M,
    )
    assert re.search(rf"^  together, in phase +{table['film_force_rms_in_phase']:.4g}$", ended.stdout, re.M)
    assert f"  {table['film_force_text']}\n" in ended.stdout


def test_few_samples_of_the_series_leave_the_sum_of_forces(solve, tmp_path: Path) -> None:
    """The forces are sampled until they have the power that the steps show, which 64 samples do not."""
    reported = []
    for samples in (64, 4096):
        solve("box", BOTH, "--set", f"solver.samples_per_period={samples}")
        reported.append(package.read_summary(tmp_path / "results" / "box.summary.nml"))
        first = summary_of(tmp_path / "results" / "box.1st.summary.nml")
        assert first["series_coarse"] == (samples == 64)
    few, many = reported
    assert few["film_force_text"] == many["film_force_text"]
    assert few["film_force_rms_uncorrelated"] == many["film_force_rms_uncorrelated"]
    # Samples that have the power of the steps to a millionth.
    assert few["film_force_rms_in_phase"] == pytest.approx(many["film_force_rms_in_phase"], rel=1e-6)


def force_of(folder: Path, name: str, periods: int) -> np.ndarray:
    """Film force of the last periods of a series, m z'' + F, which equation (1) leaves to the films."""
    result = package.read(folder / f"{name}.rattle")
    mass = summary_of(folder / f"{name}.summary.nml")["mass"]
    samples = periods * round(1.0 / (result["time"][1] - result["time"][0]) / result.frequency)
    return (mass * np.array(result["acceleration"]) + np.array(result["applied_force"]))[-samples:]


@pytest.mark.long
def test_pairs_that_repeat_and_one_that_does_not_are_summed_on_one_axis(
    run, repository: Path, tmp_path: Path
) -> None:
    """The ready gearbox, its flanks rigid: the 1st pair, unlike the others, does not repeat soon."""
    few = ("--set", "solver.periods=14", "--set", "film.law=iso-viscous", "--set", "film.model=reynolds")
    ended = run(*few, repository / "input" / "gearbox.nml", "--output", tmp_path, cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    table = package.read_summary(tmp_path / "gearbox.summary.nml")
    status = {gear: reported["status"] for gear, reported in table["gears"].items()}
    assert status == {"1st": "complete", "2nd": "steady", "3rd": "steady", "4th": "steady"}
    total = force_of(tmp_path, "gearbox.1st", 4)
    for gear in ("2nd", "3rd", "4th"):
        total = total + np.tile(force_of(tmp_path, f"gearbox.{gear}", 1), 4)
    assert table["film_force_rms_in_phase"] == pytest.approx(np.std(total), rel=1e-4)
    assert table["film_force_rms_in_phase"] == pytest.approx(35.60, abs=0.005)
    assert table["film_force_rms_uncorrelated"] == pytest.approx(31.79, abs=0.005)
    assert "over the last 4 periods of 14, the window of 1st" in table["film_force_text"]
    page = tmp_path / "page.html"
    results = [tmp_path / f"gearbox.{gear}.rattle" for gear in status]
    assert call_script("report.py", *results, "--output", page).returncode == 0
    read = read_page(page)
    words = "load the bearings with 31.8 N rms if their forces are independent, 35.6 N in phase."
    assert words in read.verdicts[0]
    assert f"Forces of the pairs, {table['film_force_text']}." in read.seen


@pytest.mark.long
def test_a_pair_that_fails_leaves_no_sum(solve, tmp_path: Path) -> None:
    """No rigid piezo-viscous film carries a drag of 40 N m: no sum is reported, and the table says why."""
    text = BOTH.replace("'iso-viscous'", "'piezo-viscous'").replace(
        "drag_torque = 0.05", "drag_torque = 40.0"
    )
    ended = solve("box", text, ends=1)
    table = package.read_summary(tmp_path / "results" / "box.summary.nml")
    failed = table["gears"]["4th"]
    assert failed.keys() == {"status", "summary_checksum"} and failed["status"] == "no_rigid_film"
    assert table["pairs_failed"] == 1
    assert not {"film_force_rms_uncorrelated", "film_force_rms_in_phase", "dissipated_power"} & set(table)
    words = "together unknown, as there is no window to judge of 4th (no_rigid_film)"
    assert table["film_force_text"] == words and words in ended.stdout
    results = [tmp_path / "results" / f"box.{gear}.rattle" for gear in ("1st", "4th")]
    page = tmp_path / "page.html"
    assert call_script("report.py", *results, "--output", page).returncode == 0
    read = read_page(page)
    assert "together load" not in read.words and "1st is the most severe: it loads" in read.verdicts[0]
    assert words in read.seen


def test_side_by_side_tells_and_writes_the_same(solve, scene_text, run, tmp_path: Path) -> None:
    """The first pair takes longest, a scene behind the box fails: reported in order, whichever ends first."""
    (tmp_path / "box.nml").write_text(BOTH.replace("periods = 8", "periods = 40"))
    lost = {"film": {"law": "'piezo-viscous'", "model": "'reynolds'"}, "solver": TAYLOR}
    (tmp_path / "lost.nml").write_text(scene_text(**lost))
    (tmp_path / "last.nml").write_text(scene_text())
    reported = {}
    for threads in (1, 2, 5):
        place = f"by{threads}"
        files = ("box.nml", "lost.nml", "last.nml")
        ended = run(*files, "--threads", threads, "--output", place, cwd=tmp_path, timeout=600.0)
        assert ended.returncode == 1 and ended.stderr == ""
        reported[place] = re.sub(r"in \S+ s,", "", ended.stdout).replace(f" {place}/", " ")
    first = [line for line in reported["by1"].splitlines() if line.startswith("rattle ")]
    assert [line.split(", ")[1].split(":")[0] for line in first] == [
        *("scene box.1st", "scene box.4th", "gearbox box", "scene lost", "scene last")
    ]
    assert reported["by1"] == reported["by2"] == reported["by5"]
    written = sorted(path.name for path in (tmp_path / "by1").iterdir())
    assert "box.4th.state" in written and "box.summary.nml" in written
    for place in ("by2", "by5"):
        assert sorted(path.name for path in (tmp_path / place).iterdir()) == written
        for name in written:
            one, other = (tmp_path / folder / name for folder in ("by1", place))
            if name.endswith(".nml"):
                ours, theirs = summary_of(one), summary_of(other)
                assert {**ours, "wall_seconds": 0} == {**theirs, "wall_seconds": 0}, name
            elif not name.endswith(".log"):
                assert one.read_bytes() == other.read_bytes(), name


def test_a_signal_ends_all_pairs_that_have_begun(rattle: Path, run, tmp_path: Path) -> None:
    """Both are under way, stop, and go on to what one long run gives; a third was not begun."""
    text = BOTH + FOURTH.replace("4th", "5th")
    text = text.replace("model = 'reynolds'", "model = 'published'").replace(
        ", tooth_stiffness = 14e9", ", tooth_stiffness = 0"
    )
    text = text.replace(
        "accuracy = 1e-6, method = 'taylor'", "method = 'newmark', until = 'periods', steps_per_period = 1024"
    )
    text = text.replace("periods = 8", "periods = 100000")
    (tmp_path / "box.nml").write_text(text + "&output stride = 1024 /\n")
    call = [rattle, "--quiet", "--threads", "2", "box.nml"]
    process = subprocess.Popen(call, cwd=tmp_path)
    logs = [tmp_path / "results" / f"box.{gear}.log" for gear in ("1st", "4th")]
    until(lambda: all(log.exists() and log.read_text() for log in logs), process)
    process.send_signal(signal.SIGTERM)
    assert process.wait(600) == 128 + signal.SIGTERM
    table = package.read_summary(tmp_path / "results" / "box.summary.nml")
    assert table["status"] == "interrupted" and list(table["gears"]) == ["1st", "4th"]
    assert [pair["status"] for pair in table["gears"].values()] == ["interrupted"] * 2
    solved = [summary_of(log.with_suffix(".summary.nml"))["periods_solved"] for log in logs]
    shorter = ["--set", f"solver.periods={max(solved) + 20}"]
    for options in (["--resume"], ["--threads", "1", "--output", "long"]):
        ended = run(*shorter, *options, "box.nml", cwd=tmp_path, timeout=600.0)
        assert ended.returncode == 0, ended.stderr
    for gear in ("1st", "4th", "5th"):
        for ending in ("rattle", "state"):
            one, other = (tmp_path / place / f"box.{gear}.{ending}" for place in ("results", "long"))
            assert one.read_bytes() == other.read_bytes(), (gear, ending)


@pytest.mark.parametrize("threads", [1, 2])
def test_trouble_with_the_files_of_a_pair_ends_the_call(threads: int, run, tmp_path: Path) -> None:
    """Reported once; the pair before is complete, the one behind was not begun, and there is no table."""
    (tmp_path / "box.nml").write_text(BOTH + FOURTH.replace("4th", "5th"))
    (tmp_path / "results").mkdir()
    with (tmp_path / "results" / "box.4th.lock").open("w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        ended = run("box.nml", "--threads", threads, cwd=tmp_path)
    assert ended.returncode == 3 and len(ended.stderr.splitlines()) == 1
    assert "results/box.4th is being written by another run" in ended.stderr
    assert summary_of(tmp_path / "results" / "box.1st.summary.nml")["status"] == "complete"
    left = sorted(path.name for path in (tmp_path / "results").iterdir() if ".1st." not in path.name)
    assert left == ["box.4th.lock"] and "gearbox" not in ended.stdout


def test_one_gear_keeps_its_name(solve, tmp_path: Path) -> None:
    solve("one", FIRST + SHARED)
    assert (tmp_path / "results" / "one.rattle").exists()
    assert not list(tmp_path.glob("results/one.1st*"))


def test_check_tells_the_contact_of_each_pair(solve) -> None:
    reported = solve("box", BOTH, "--check").stdout
    radii = [float(value) for value in re.findall(r"^! derived: gear.base_radius_2 = (\S+)", reported, re.M)]
    assert radii[0] == pytest.approx(0.05012440307, rel=1e-9)
    assert len(radii) == 2


@pytest.mark.parametrize("plan", PLANS)
def test_the_pair_is_the_slowest_axis_of_a_campaign(solve, tmp_path: Path, plan: str) -> None:
    solve("map", campaign_text(FIRST + FOURTH, PLANS[plan]), "--threads", 2)
    solve("map", campaign_text(FIRST + FOURTH, PLANS[plan]), "--threads", 1, "--output", "again")
    assert (tmp_path / "results" / "map.rattle").read_bytes() == (
        tmp_path / "again" / "map.rattle"
    ).read_bytes()
    both = package.read_campaign(tmp_path / "results" / "map.rattle")
    assert both.gears == ("1st", "4th")
    assert both.varied[0] == "gear"
    rows = []
    for gear, text in (("1st", FIRST), ("4th", FOURTH)):
        solve("alone", campaign_text(text, PLANS[plan]))
        alone = package.read_campaign(tmp_path / "results" / "alone.rattle")
        pair = both.pair(gear)
        assert pair.varied == alone.varied
        for name in alone.names[1:]:
            np.testing.assert_array_equal(pair[name], alone[name], err_msg=name)
        rows.append(alone.row_count)
    assert both.row_count == sum(rows)
    if plan == "grid":
        assert both.grid("film_force_rms").shape == (2, 3, 2)
        np.testing.assert_array_equal(both.grid("film_force_rms")[1], pair.grid("film_force_rms"))


def test_python_names_the_gears(solve, tmp_path: Path) -> None:
    solve("map", campaign_text(FIRST + FOURTH, GRID))
    campaign = package.read_campaign(tmp_path / "results" / "map.rattle")
    assert list(campaign.frame()["gear"].unique()) == ["1st", "4th"]
    data = campaign.dataset()
    assert data["film_force_rms"].sel(gear="4th").values.shape == (3, 2)
    assert list(data.coords["gear"].values) == ["1st", "4th"]
    row = campaign.row_count - 1
    solve("again", rerun.input_text(campaign, row, "results"))
    summary = summary_of(tmp_path / "results" / f"{rerun.scene_label(campaign, row)}.summary.nml")
    assert summary["gear"] == "4th"
    assert summary["film_force_rms"] == pytest.approx(campaign["film_force_rms"][row], rel=1e-5)


def test_a_campaign_of_pairs_is_carried_on(solve, run, tmp_path: Path) -> None:
    text = campaign_text(FIRST + FOURTH, GRID)
    solve("map", text)
    path = tmp_path / "results" / "map.rattle"
    whole = path.read_bytes()
    assert run("map.nml", "--resume", cwd=tmp_path).returncode == 0
    assert path.read_bytes() == whole
    (tmp_path / "map.nml").write_text(text.replace("teeth_2 = 32", "teeth_2 = 31"))
    ended = run("map.nml", "--resume", cwd=tmp_path)
    assert ended.returncode == 2
    assert "gear(2).teeth_2 is 31 now and was 32" in ended.stderr


def test_run_returns_a_mapping_by_gear(rattle: Path) -> None:
    solved = package.run(BOTH, set={"scene.name": "box"}, program=rattle)
    assert list(solved) == ["1st", "4th"]
    assert solved["4th"].result.scene_name == "box.4th"
    assert solved.summary["gears"]["1st"]["rattle_class"] == solved["1st"].summary["rattle_class"]


def test_each_pair_has_its_sweep(solve, tmp_path: Path) -> None:
    sweep = "&sweep key = 'speed_rpm', first = 700.0, last = 900.0, count = 3, turn = .false. /\n"
    solve("box", "&scene task = 'sweep' /\n" + BOTH + sweep)
    for gear in ("1st", "4th"):
        assert package.read(tmp_path / "results" / f"box.{gear}.rattle").task == "sweep"
    assert not (tmp_path / "results" / "box.summary.nml").exists()


def test_every_fault_of_every_gear_is_reported(run, tmp_path: Path) -> None:
    bad = (
        "&gear\n   name = '1st', teeth_1 = 11, teth_2 = 38, normal_module = 2e-3\n"
        "   face_width = 0.02, loose_inertia = 1e-3, drag_torque = 0.1\n/\n"
        "&gear\n   name = '1ST', teeth_1 = 11, teeth_2 = 38, normal_module = -1.0\n"
        "   face_width = 0.02, loose_inertia = 1e-3, drag_torque = 0.1\n/\n"
        "&gear\n   teeth_1 = 11, teeth_2 = 38, normal_module = 2e-3\n"
        "   face_width = 0.02, loose_inertia = 1e-3, drag_torque = -0.1\n/\n"
    )
    (tmp_path / "bad.nml").write_text(bad + SHARED + "&spectra /\n")
    ended = run("bad.nml", cwd=tmp_path)
    assert_faults(
        ended.stderr.splitlines(),
        "bad.nml",
        [
            "1: &gear teeth_2: this key is required",
            "2: &gear teth_2: unknown key; the nearest known key is teeth_2",
            "6: &gear normal_module: -1.0 is not allowed",
            "6: &gear name: '1ST' is also the name of an earlier &gear",
            "9: &gear name: there are several &gear; each needs a name",
            "11: &gear drag_torque: without a backlash the drag torque must be positive",
            "18: &spectra: unknown group",
        ],
    )


def test_names_are_usable_as_files(run, tmp_path: Path) -> None:
    (tmp_path / "bad.nml").write_text(BOTH.replace("'4th'", "'4/5'"))
    ended = run("bad.nml", cwd=tmp_path)
    expected = "6: &gear name: '4/5' is not allowed; allowed: 1 to 64 letters, digits, . _ -"
    assert_faults(ended.stderr.splitlines(), "bad.nml", [expected])


@pytest.mark.long
def test_ready_gearbox_has_a_map(run, repository: Path, tmp_path: Path) -> None:
    ready = repository / "input" / "gearbox_map.nml"
    ended = run(ready, "--set", "campaign.count=3,3", "--output", tmp_path, cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    path = tmp_path / "gearbox_map.rattle"
    assert package.read_campaign(path).gears == ("1st", "2nd", "3rd", "4th")
    drawn = call_script("plot.py", "campaign", path, "--output", tmp_path, "--format", "png")
    assert drawn.returncode == 0, drawn.stderr
    assert len(list(tmp_path.glob("gearbox_map.*_map_loudest_verdict.png"))) == 4
    assert run("--check", repository / "input" / "gearbox.nml", cwd=tmp_path).returncode == 0


def test_all_pairs_stand_together_in_one_figure(solve, tmp_path: Path) -> None:
    solve("box", BOTH + "&scene task = 'campaign' /\n" + GRID)
    path = tmp_path / "results" / "box.rattle"
    campaign = package.read_campaign(path)
    sections = {
        gear: new_section(alone, ("shaft.speed_rpm", "gear.drag_torque"), {})
        for gear, alone in zip(campaign.gears, campaign.pairs, strict=True)
    }
    with style.house_style():
        figure = campaign_map.draw_pairs(sections, ("rattle_class", "film_force_rms"), campaign_map.Options())
    first, second, force, larger, bar = figure.axes
    assert [axes.get_title(loc="left") for axes in (first, second)] == ["1st", "4th"]
    assert [axes.get_ylabel() for axes in (first, force)] == ["Drag torque [N m]"] * 2
    assert force.get_xlabel() == "Shaft speed [1/min]" and bar.get_ylabel() == "Film force rms [N]"
    meshes = [axes.collections[0] for axes in (force, larger)]
    assert meshes[0].norm.vmin == meshes[1].norm.vmin and meshes[0].norm.vmax == meshes[1].norm.vmax
    for mesh, alone in zip(meshes, campaign.pairs, strict=True):
        assert np.array_equal(np.ravel(mesh.get_array()), alone.grid("film_force_rms").T.ravel())
    with style.house_style():
        column = campaign_map.draw_pairs(
            sections, ("rattle_class", "film_force_rms"), campaign_map.Options(), narrow=True
        )
    upper, _, lower, right, bar = column.axes
    assert [axes.get_title(loc="left") for axes in (upper, lower)] == ["1st", "4th"]
    assert [axes.get_ylabel() for axes in (upper, lower, right)] == ["Drag torque [N m]"] * 2 + [""]
    assert lower.get_xlabel() == right.get_xlabel() == "Shaft speed [1/min]" and upper.get_xlabel() == ""
    assert bar.get_ylabel() == "Film force rms [N]"
    drawn = call_script("plot.py", "campaign", path, "--together", "--output", tmp_path, "--format", "png")
    assert drawn.returncode == 0 and (tmp_path / "box_pairs.png").exists(), drawn.stderr
    refused = call_script("plot.py", "campaign", path, "--together", "--summary")
    assert refused.returncode == 2 and "--together draws maps of all gear pairs" in refused.stderr


def test_the_only_pair_together_is_its_map(tmp_path: Path) -> None:
    """Whoever has one pair types the command for a gearbox, too."""
    path = campaign_writer.grid(campaign_writer.FORCES, campaign_writer.SPEEDS, name="one").write(
        tmp_path / "one.rattle"
    )
    for folder, options in (("alone", ()), ("together", ("--together",))):
        done = call_script("plot.py", "campaign", path, *options, "--output", tmp_path / folder)
        assert done.returncode == 0, done.stderr
    name = "one_map_rattle_class.png"
    assert [file.name for file in (tmp_path / "together").iterdir()] == [name]
    assert (tmp_path / "together" / name).read_bytes() == (tmp_path / "alone" / name).read_bytes()


@pytest.mark.long
def test_the_page_on_all_pairs_names_them_and_the_most_severe(solve, tmp_path: Path) -> None:
    solve("box", BOTH)
    solve("axes", campaign_text(FIRST + FOURTH, GRID))
    output = tmp_path / "page.html"
    results = [tmp_path / "results" / f"box.{gear}.rattle" for gear in ("1st", "4th")]
    assert call_script("report.py", *results, "--output", output).returncode == 0
    page = read_page(output)
    assert page.headings[0] == "Rattle of box"
    reported = {gear: summary_of(tmp_path / "results" / f"box.{gear}.summary.nml") for gear in ("1st", "4th")}
    severest = max(reported, key=lambda gear: reported[gear]["film_force_rms"])
    assert next(table for table in page.tables if table[0][0] == "Pair")[1][0] == severest
    assert page.headings[1] == f"{severest}, the hardest, in pictures"
    assert "The two pairs together load the bearings with" in page.verdicts[0]
    assert (
        "Asked: gear pair 1st (11 teeth drive 38, module 2.5 mm); speed of the shaft 800 1/min;" in page.words
    )
    assert "film by the Reynolds iso-viscous law. This makes: mass of the tooth pair 0.86" in page.words
    assert (
        call_script(
            "report.py", tmp_path / "results" / "axes.rattle", "--overwrite", "--output", output
        ).returncode
        == 0
    )
    page = read_page(output)
    assert "gear pairs 1st (11 teeth drive 38, module 2.5 mm), 4th (33 teeth drive 32" in page.words
    assert "This makes" not in page.words
    assert ["gear", "1st", "4th", "values", "2"] in page.rows
    (second,) = [row for row in page.rows if row[:2] == ["name", "4th"]]
    assert "each is solved as a scene NAME.GEAR" in second[2]
