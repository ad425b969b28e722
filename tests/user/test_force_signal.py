"""One cycle of a measured force from a CSV file: it becomes orders, in motions, sweeps and campaigns."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from outcomes import assert_faults, digest, summary_of

import rattle as package

LOAD = {"force_amplitude": None, "steady_force": "190.0", "signal": "'cycle.csv'"}
SOLVER = {"method": "'taylor'", "steps_per_period": None, "periods": "40"}
MEAN = 9.2


def force(phase: np.ndarray) -> np.ndarray:
    """Three orders and their mean, as in the tests of forces of several orders [N]."""
    orders = ((1, 150.0, 0.0), (2, 60.0, 0.7), (3, 25.0, -1.2))
    return MEAN + sum(a * np.cos(2.0 * np.pi * n * phase + phi) for n, a, phi in orders)


def cycle_text(samples: np.ndarray, head: str = "time,force") -> str:
    """A file with a comment, times and samples."""
    rows = [f"{i / len(samples) / 600.0:.9f},{float(value)!r}\n" for i, value in enumerate(samples)]
    return "# a test bench, 2026\n" + head + "\n" + "".join(rows)


def phases(count: int) -> np.ndarray:
    return np.arange(count) / count


@pytest.fixture
def folder(scene_text, tmp_path: Path) -> Path:
    """A scene with a signal of 90 samples, in a folder of its own."""
    (tmp_path / "scene.nml").write_text(scene_text(load=LOAD, solver=SOLVER))
    (tmp_path / "cycle.csv").write_text(cycle_text(force(phases(90))))
    return tmp_path


def solve(run, folder: Path, *options: object, name: str = "scene", cwd: Path | None = None) -> dict:
    ended = run("--output", folder / "results", *options, folder / f"{name}.nml", cwd=cwd or folder)
    assert (ended.returncode, ended.stderr) == (0, ""), ended
    return summary_of(folder / "results" / f"{name}.summary.nml")


def test_a_signal_is_its_orders(run, scene_text, folder: Path, tmp_path_factory) -> None:
    """The file is looked for beside the input, wherever the program is called."""
    summary = solve(run, folder, cwd=tmp_path_factory.mktemp("elsewhere"))
    orders = {
        "steady_force": str(190.0 + MEAN),
        "signal": None,
        "force_orders": "1, 2, 3",
        "force_amplitudes": "150.0, 60.0, 25.0",
        "force_phases": "0.0, 0.7, -1.2",
    }
    (folder / "orders.nml").write_text(scene_text(load=LOAD | orders, solver=SOLVER))
    expected = solve(run, folder, name="orders")
    for name in (
        "film_minimum",
        "film_maximum",
        "acceleration_maximum",
        "harmonic_distortion",
        "steady_film",
    ):
        assert summary[name] == pytest.approx(expected[name], rel=1e-9), name
    assert summary["harmonic_count"] == expected["harmonic_count"]
    result = package.read(folder / "results" / "scene.rattle")
    applied = np.array(result["applied_force"])[-512:]
    assert applied == pytest.approx(190.0 + force((np.arange(512) + 1.0) / 512.0), rel=0.0, abs=1e-9)
    # The input in the result says all: it needs no file.
    assert result.input["load"]["force_orders"] == [1, 2, 3]
    assert result.input["load"]["force_mean"] == pytest.approx(MEAN)
    assert "signal" not in result.input["load"]


def test_scale_leaves_the_mean_alone(run, scene_text, folder: Path) -> None:
    solve(run, folder, "--set", "load.force_scale=0.0")
    result = package.read(folder / "results" / "scene.rattle")
    assert np.ptp(result["applied_force"]) == 0.0
    assert result["applied_force"][0] == pytest.approx(190.0 + MEAN)


def test_what_is_dropped_is_reported(run, folder: Path) -> None:
    """As many orders as hold all but a millionth of the power, or as many as are asked for."""
    share = 25.0**2 / (150.0**2 + 60.0**2 + 25.0**2)
    samples = force(phases(90)) + 0.5e-3 * 150.0 * np.cos(2.0 * np.pi * 7.0 * phases(90))
    (folder / "cycle.csv").write_text(cycle_text(samples))
    for options, last, dropped in (
        ((), 3, 0.25e-6 * 150.0**2 / (150.0**2 + 60.0**2 + 25.0**2)),
        (("--set", "load.signal_orders=2"), 2, share),
        (("--set", "load.signal_orders=7"), 7, 0.0),
    ):
        solve(run, folder, "--overwrite", *options)
        (line,) = (
            line for line in (folder / "results" / "scene.log").read_text().splitlines() if "signal " in line
        )
        assert "'force': 90 samples; its head says no unit, N is taken;" in line
        assert f"; harmonics 1 to {last} are kept" in line
        assert "its mean of 9.2" in line
        reported = float(line.split(" are kept, ")[1].split(" % of its power is dropped")[0])
        assert reported / 100.0 == pytest.approx(dropped, rel=0.1, abs=1e-25)


def test_a_run_is_carried_on_with_the_same_signal_only(run, folder: Path) -> None:
    solve(run, folder, "--set", "solver.periods=20")
    long = folder / "long"
    long.mkdir()
    for name in ("scene.nml", "cycle.csv"):
        (long / name).write_bytes((folder / name).read_bytes())
    solve(run, long)
    text = (folder / "cycle.csv").read_text()
    (folder / "cycle.csv").write_text(cycle_text(force(phases(90)) + 1e-6 * np.cos(2.0 * np.pi * phases(90))))
    ended = run("--output", folder / "results", "--resume", folder / "scene.nml", cwd=folder)
    assert ended.returncode == 2
    assert "belongs to another scene: load.force_amplitudes(1) is 150.00000" in ended.stderr
    (folder / "cycle.csv").write_text(text + "# another comment\n")
    solve(run, folder, "--resume")
    for name in ("scene.rattle", "scene.state"):
        assert digest(folder / "results" / name) == digest(long / "results" / name)


def test_campaigns_and_sweeps_scale_a_signal(run, scene_text, folder: Path) -> None:
    """Rows are the same for any threads, and those of single scenes; the mean is added to every Q."""
    varied = {
        "vary": "'load.force_scale', 'load.steady_force'",
        "first": "0.5, 150.0",
        "last": "1.5, 190.0",
        "count": "3, 2",
        "record": "'film_minimum', 'film_maximum', 'steady_film'",
    }
    text = scene_text(scene={"task": "'campaign'"}, load=LOAD, solver=SOLVER, campaign=varied)
    (folder / "map.nml").write_text(text)
    rows = []
    for threads in (1, 2):
        ended = run("--overwrite", "--threads", threads, "map.nml", cwd=folder)
        assert ended.returncode == 0, ended.stderr
        rows.append((folder / "results" / "map.rattle").read_bytes())
    assert rows[0] == rows[1]
    result = package.read(folder / "results" / "map.rattle")
    summary = solve(run, folder, "--set", "load.force_scale=1.5", "--set", "load.steady_force=150")
    row = next(
        i for i in range(6) if (result["load.force_scale"][i], result["load.steady_force"][i]) == (1.5, 150.0)
    )
    assert result["steady_film"][row] == summary["steady_film"]
    assert result["film_minimum"][row] == pytest.approx(summary["film_minimum"], rel=1e-6)
    sweep = {"key": "'force_scale'", "first": "0.5", "last": "1.5", "count": "3"}
    text = scene_text(
        scene={"task": "'sweep'"}, load=LOAD, solver=SOLVER, sweep=sweep, output={"series": None}
    )
    (folder / "sweep.nml").write_text(text)
    assert run("sweep.nml", cwd=folder).returncode == 0
    swept = package.read(folder / "results" / "sweep.rattle")
    summary = solve(run, folder, "--overwrite", "--set", "load.force_scale=1.5")
    assert swept["film_maximum"][2] == pytest.approx(summary["film_maximum"], rel=1e-6)


def test_a_changed_signal_ends_a_campaign(run, scene_text, folder: Path) -> None:
    varied = {"vary": "'load.force_scale'", "first": "0.5", "last": "1.5", "count": "3"}
    (folder / "map.nml").write_text(
        scene_text(scene={"task": "'campaign'"}, load=LOAD, solver=SOLVER, campaign=varied)
    )
    assert run("map.nml", cwd=folder).returncode == 0
    (folder / "cycle.csv").write_text(cycle_text(2.0 * force(phases(90))))
    ended = run("--resume", "map.nml", cwd=folder)
    assert ended.returncode == 2
    assert "load.force_amplitudes(1) is 300.0" in ended.stderr


@pytest.mark.parametrize(
    ("load", "fault"),
    [
        ({"signal": "'absent.csv'"}, "absent.csv: there is no such file"),
        (
            {"signal_column": "'torque'"},
            "cycle.csv:2: there is no column 'torque'; its columns are time, force",
        ),
        ({"force_amplitude": "3.0"}, "&load force_amplitude: the signal gives the force; leave this key or"),
        ({"force_mean": "3.0"}, "&load force_mean: the signal gives the force; leave this key or"),
        ({"signal": None, "force_amplitude": "3.0", "signal_orders": "4"}, "used only with signal"),
        ({"signal_orders": "129"}, "129 is not allowed; allowed: an integer >= 1 and <= 128"),
        ({"steady_force": "-50.0"}, "the static load steady_force + mass*gravity must be positive"),
    ],
)
def test_a_signal_that_is_none_is_refused(load: dict, fault: str, refused, scene_text, folder: Path) -> None:
    (folder / "scene.nml").write_text(scene_text(load=LOAD | load, solver=SOLVER))
    found = refused("scene.nml")
    assert len(found) == 1, found
    assert fault in found[0]


def test_every_fault_of_a_file_is_reported_with_its_line(refused, folder: Path) -> None:
    lines = cycle_text(force(phases(90))).splitlines()
    lines[4] = lines[4].split(",")[0] + ",many"
    lines[7] = "0.5"
    (folder / "cycle.csv").write_text("\n".join(lines))
    assert_faults(
        refused("scene.nml"),
        "cycle.csv",
        [
            "5: column 2: this is not a number",
            "8: the line has 1 columns, the header 2",
        ],
    )


def test_samples_have_to_see_every_order(refused, scene_text, folder: Path) -> None:
    """A signal with many orders says how to keep fewer."""
    (folder / "cycle.csv").write_text(cycle_text(np.where(phases(600) < 0.3, 1.0, 0.0)))
    solver = SOLVER | {"samples_per_period": "64"}
    (folder / "scene.nml").write_text(scene_text(load=LOAD, solver=solver))
    (fault,) = refused("scene.nml")
    assert "the highest harmonic of the force needs at least 512; signal_orders keeps fewer" in fault
