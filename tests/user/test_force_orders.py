"""Forces of several orders: references of an independent solver, symmetries, and what is refused.

The reference is a motion of the canonical tooth pair under three orders, solved by two other solvers to all
digits shown, its extremes those of 2048 samples a period.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from outcomes import assert_faults, summary_of

import rattle
from rattle.verdict import classify

CANONICAL = {
    "contact": {"radius": "0.0127", "length": "0.010"},
    "lubricant": {"viscosity": "0.3", "pressure_viscosity": "2.0e-8"},
    "kinematics": {"entrainment_speed": "1.905"},
    "film": {"law": "'iso-viscous'"},
}
LOAD = {"mass": "3.0", "steady_force": "199.2", "frequency": "600.0", "force_amplitude": None}
ORDERS = {
    "force_orders": "1, 2, 3",
    "force_amplitudes": "150.0, 60.0, 25.0",
    "force_phases": "0.0, 0.7, -1.2",
}
TAYLOR = {
    "method": "'taylor'",
    "steps_per_period": None,
    "accuracy": "1.0e-9",
    "samples_per_period": "2048",
    "periods": "120",
}
FILMS = (4.3852019e-07, 2.0769293e-06)
ACCELERATIONS = (-40.487302, 67.754164)
HARMONICS = (9.3167804, 18.0493493, 16.1777555, 9.9559708, 7.8172578, 5.8696725, 4.3752847, 3.1695731)
SEVERITY = {
    "acceleration_rms": 21.323978,
    "crest_factor": 3.17737,
    "acceleration_kurtosis": 4.67967,
    "film_force_rms": 145.751130,
    "dissipated_energy": 3.1298907e-04,
}
# Half a unit of the last digit shown, relative to the largest value.
DIGITS = 1e-7


def solve(run, scene_text, folder: Path, name: str, **groups) -> tuple[dict, rattle.Result]:
    groups = {**CANONICAL, "load": LOAD | ORDERS, "solver": TAYLOR, "spectrum": {"periods": "8"}, **groups}
    (folder / f"{name}.nml").write_text(scene_text(**groups))
    ended = run(f"{name}.nml", cwd=folder, timeout=600.0)
    assert ended.returncode == 0, ended.stderr
    return summary_of(folder / "results" / f"{name}.summary.nml"), rattle.read(
        folder / "results" / f"{name}.rattle"
    )


def last_period(result: rattle.Result, column: str, samples: int) -> np.ndarray:
    return np.array(result[column])[-samples:]


def test_motion_under_three_orders_is_the_reference(run, scene_text, tmp_path: Path) -> None:
    summary, result = solve(run, scene_text, tmp_path, "scene")
    film, acceleration = (last_period(result, name, 2048) for name in ("film_thickness", "acceleration"))
    assert (film.min(), film.max()) == pytest.approx(FILMS, rel=0.0, abs=DIGITS * FILMS[1])
    assert (acceleration.min(), acceleration.max()) == pytest.approx(
        ACCELERATIONS, rel=0.0, abs=DIGITS * ACCELERATIONS[1]
    )
    assert summary["harmonics"][:8] == pytest.approx(HARMONICS, rel=0.0, abs=DIGITS * max(HARMONICS))
    # Lines at the orders of the force are no sign of rattle: the others are compared with them.
    assert summary["harmonic_distortion"] == pytest.approx(0.590501, abs=1e-6)
    assert summary["harmonic_count"] == 14
    assert summary["verification"] == "verified"
    for name, value in SEVERITY.items():
        assert summary[name] == pytest.approx(value, rel=2e-6), name
    assert summary["dissipated_power"] == pytest.approx(600.0 * summary["dissipated_energy"], rel=1e-15)


@pytest.mark.parametrize("law", ["half-pi", "solved", "reynolds", "piezo-viscous"])
def test_both_engines_find_the_same_motion(law: str, run, scene_text, tmp_path: Path) -> None:
    """Newmark's method comes nearer with the square of its step."""
    film = {
        "half-pi": {"law": "'iso-viscous'"},
        "solved": {"law": "'iso-viscous'", "rupture": "'solved'"},
        "reynolds": {"law": "'iso-viscous'", "model": "'reynolds'"},
        "piezo-viscous": {"law": "'piezo-viscous'"},
    }[law]
    taylor, _ = solve(run, scene_text, tmp_path, "taylor", film=film)
    gaps = []
    for steps in (512, 1024):
        newmark = {"method": "'newmark'", "steps_per_period": str(steps), "periods": "60"}
        summary, _ = solve(run, scene_text, tmp_path, f"newmark_{steps}", film=film, solver=newmark)
        gaps.append(abs(summary["film_maximum"] / taylor["film_maximum"] - 1.0))
    # Extremes of Newmark's motion are samples of it, whose distance from the peak is of the second order too.
    assert gaps[1] < 0.5 * gaps[0] < 1e-3


def test_one_order_is_the_force_of_the_paper(run, scene_text, tmp_path: Path) -> None:
    orders = LOAD | {"force_orders": "1", "force_amplitudes": "205.7"}
    amplitude = LOAD | {"force_amplitude": "205.7"}
    scaled = LOAD | {"force_amplitude": "102.85", "force_scale": "2.0"}
    results = [
        solve(run, scene_text, tmp_path, name, load=load)[1]
        for name, load in (("orders", orders), ("amplitude", amplitude), ("scaled", scaled))
    ]
    for column in ("applied_force", "film_thickness", "acceleration"):
        expected = np.array(results[1][column]).tobytes()
        assert np.array(results[0][column]).tobytes() == expected, column
        assert np.array(results[2][column]).tobytes() == expected, column


def test_force_of_the_series_is_the_sum_of_its_orders(run, scene_text, tmp_path: Path) -> None:
    load = LOAD | {
        "force_orders": "7, 1, 32",
        "force_amplitudes": "20.0, 100.0, 3.0",
        "force_phases": "0.4, -2.0, 9.0",
        "force_scale": "0.5",
    }
    _, result = solve(run, scene_text, tmp_path, "scene", load=load)
    phase = 2.0 * np.pi * (np.arange(1, 2049) / 2048)
    expected = 199.2 + 0.5 * (
        20.0 * np.cos(7 * phase + 0.4) + 100.0 * np.cos(phase - 2.0) + 3.0 * np.cos(32 * phase + 9.0)
    )
    # Powers on the unit circle: some units of rounding an order.
    assert last_period(result, "applied_force", 2048) == pytest.approx(
        expected, rel=0.0, abs=32 * 8 * 2.2e-16 * 123.0
    )


def test_motion_shifts_with_its_force(run, scene_text, tmp_path: Path) -> None:
    """A quarter of a period earlier: every phase moves by its order times a quarter of a turn."""
    first, early = (
        solve(
            run,
            scene_text,
            tmp_path,
            name,
            load=LOAD | ORDERS | {"force_phases": ", ".join(map(repr, phases))},
        )
        for name, phases in (
            ("first", (0.0, 0.7, -1.2)),
            ("early", tuple(p + n * 0.5 * np.pi for n, p in ((1, 0.0), (2, 0.7), (3, -1.2)))),
        )
    )
    film = last_period(first[1], "film_thickness", 2048)
    assert last_period(early[1], "film_thickness", 2048) == pytest.approx(np.roll(film, -512), rel=1e-7)
    assert early[0]["harmonics"][:8] == pytest.approx(first[0]["harmonics"][:8], rel=1e-6)


def test_a_calm_motion_under_many_orders_is_quiet(run, scene_text, tmp_path: Path) -> None:
    """Four lines of like size, all of them forced: against the first alone its distortion would be 1.7."""
    load = LOAD | {"force_orders": "1, 2, 3, 4", "force_amplitudes": "0.1, 0.1, 0.1, 0.1"}
    summary, _ = solve(run, scene_text, tmp_path, "scene", load=load)
    assert summary["rattle_class"] == "quiet"
    assert summary["harmonic_distortion"] < 0.05
    assert summary["harmonic_count"] == 1


def test_rows_and_sweeps_over_the_scale_are_the_single_scenes(run, scene_text, tmp_path: Path) -> None:
    solver = TAYLOR | {"samples_per_period": None, "accuracy": "1.0e-8"}
    campaign = {
        "vary(1)": "'load.force_scale'",
        "scale(1)": "'linear'",
        "first(1)": "0.5",
        "last(1)": "1.0",
        "count(1)": "2",
    }
    groups = {**CANONICAL, "load": LOAD | ORDERS, "solver": solver, "spectrum": {"periods": "8"}}
    (tmp_path / "rows.nml").write_text(
        scene_text(**groups, scene={"task": "'campaign'"}, campaign=campaign, output=None)
    )
    assert run("rows.nml", "--output", "results", cwd=tmp_path).returncode == 0
    rows = rattle.read_campaign(tmp_path / "results" / "rows.rattle")
    for number, scale in enumerate((0.5, 1.0)):
        single, _ = solve(
            run,
            scene_text,
            tmp_path,
            f"scale_{number}",
            load=LOAD | ORDERS | {"force_scale": str(scale)},
            solver=TAYLOR | {"accuracy": "1.0e-8"},
        )
        for column in ("film_minimum", "film_maximum", "acceleration_minimum", "acceleration_maximum"):
            assert rows[column][number] == single[column], column
        assert rows["harmonic_distortion"][number] == pytest.approx(single["harmonic_distortion"], rel=1e-6)
        assert rows["harmonic_count"][number] == single["harmonic_count"]


@pytest.mark.parametrize(
    ("load", "faults"),
    [
        (
            {},
            ["&load force_amplitude: a force is required: give either force_amplitude, or force_orders with"],
        ),
        ({"force_orders": "1"}, ["&load force_orders: force_orders and force_amplitudes are given together"]),
        ({"force_amplitudes": "1"}, ["&load force_amplitudes: force_orders and force_amplitudes are given"]),
        (
            ORDERS | {"force_amplitude": "3"},
            ["&load force_orders: give either force_amplitude, or force_orders with force_amplitudes"],
        ),
        (ORDERS | {"force_orders": "1, 2"}, ["as many values as force_orders has (2)", "as many values as"]),
        (ORDERS | {"force_orders": "1, 2.5, 3"}, ["harmonics are whole numbers"]),
        (ORDERS | {"force_orders": "1, 2, 2"}, ["harmonic 2 is given twice"]),
        (ORDERS | {"force_orders": "0, 1, 2"}, ["allowed: numbers >= 1.0 and <= 128.0"]),
        (ORDERS | {"force_orders": "1, 2, 30"}, ["the highest harmonic of the force needs at least 120"]),
    ],
)
def test_a_force_that_is_none_is_refused(
    load: dict, faults: list[str], run, scene_text, tmp_path: Path
) -> None:
    solver = TAYLOR | {"samples_per_period": "96"}
    (tmp_path / "scene.nml").write_text(scene_text(**CANONICAL, load=LOAD | load, solver=solver))
    ended = run("--check", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2
    lines = ended.stderr.splitlines()
    assert len(lines) == len(faults), ended.stderr
    for line, fault in zip(lines, faults, strict=True):
        assert fault in line


def test_a_sweep_of_the_amplitude_needs_one(refused, scene_text, tmp_path: Path) -> None:
    sweep = {"key": "'force_amplitude'", "first": "1.0", "last": "2.0", "count": "2"}
    text = scene_text(
        **CANONICAL,
        scene={"task": "'sweep'"},
        load=LOAD | ORDERS,
        solver=TAYLOR,
        sweep=sweep,
        output={"series": None},
    )
    (tmp_path / "scene.nml").write_text(text)
    found = refused("scene.nml")
    line = text[: text.index("key = ")].count("\n") + 1
    assert_faults(
        found,
        "scene.nml",
        [f"{line}: &sweep key: a force of several harmonics has no force_amplitude; sweep force_scale"],
    )


def test_classify_holds_lines_against_the_orders_of_the_force(run, scene_text, tmp_path: Path) -> None:
    """The kernel that Python calls knows from the file which lines are forced."""
    summary, result = solve(run, scene_text, tmp_path, "scene")
    judged = classify(result)
    assert judged["harmonic_count"] == summary["harmonic_count"]
    assert judged["harmonic_distortion"] == pytest.approx(summary["harmonic_distortion"], rel=1e-12)


@pytest.mark.long
def test_no_sample_lies_beyond_the_extremes_reported(run, scene_text, tmp_path: Path) -> None:
    """Forces of many orders have many peaks nearly as high as the highest: none of them is passed over."""
    rng = np.random.default_rng(5)
    orders = np.arange(1, 33)
    names = [f"drawn{i}" for i in range(40)]
    for name in names:
        amplitudes = 0.4 * rng.uniform(0.0, 1.0, 32) ** 3
        phases = rng.uniform(0.0, 2.0 * np.pi, 32)
        load = {
            "mass": "0.2",
            "steady_force": "0.8",
            "gravity": "0.0",
            "frequency": repr(float(rng.uniform(20.0, 80.0))),
            "force_amplitude": None,
            "force_orders": ", ".join(map(str, orders)),
            "force_amplitudes": ", ".join(f"{a:.9g}" for a in amplitudes),
            "force_phases": ", ".join(f"{p:.9g}" for p in phases),
        }
        solver = {**TAYLOR, "accuracy": f"1e-{rng.integers(4, 9)}", "periods": "12"}
        text = {
            **CANONICAL,
            "load": load,
            "solver": solver,
            "spectrum": {"periods": "8", "verify": ".false."},
        }
        (tmp_path / f"{name}.nml").write_text(scene_text(**text))
    assert run(*(f"{name}.nml" for name in names), cwd=tmp_path).returncode == 0
    for name in names:
        reported = summary_of(tmp_path / "results" / f"{name}.summary.nml")
        result = rattle.read(tmp_path / "results" / f"{name}.rattle")
        window = slice(-8 * 2048, None)
        for quantity, column in (("acceleration", "acceleration"), ("film", "film_thickness")):
            samples = np.array(result[column])[window]
            reach = np.ptp(samples)
            assert reported[f"{quantity}_maximum"] >= samples.max() - 1e-7 * reach, (name, quantity)
            assert reported[f"{quantity}_minimum"] <= samples.min() + 1e-7 * reach, (name, quantity)


def test_a_force_of_high_orders_alone_has_all_its_lines_counted(run, scene_text, tmp_path: Path) -> None:
    """Orders 15 and 24: every third multiple is a line, and impacts too short for samples have many."""
    groups = {
        "contact": {"radius": "4.872326888672092e-3", "length": "5.795388516972303e-3"},
        "lubricant": {"viscosity": "0.18345063391522218", "pressure_viscosity": "1.2024540627285404e-8"},
        "kinematics": {"entrainment_speed": "0.10958939782734214"},
        "film": {"law": "'iso-viscous'", "model": "'reynolds'"},
        "load": {
            "mass": "0.6770292660429571",
            "steady_force": "9.364527042425909",
            "force_amplitude": None,
            "force_orders": "15, 24",
            "force_amplitudes": "0.5866889569144734, 0.4133110430855265",
            "force_phases": "1.0827893103541142, 2.0805537615679044",
            "force_scale": "77.22739367095402",
            "frequency": "19.289232126593813",
        },
        "solver": TAYLOR | {"accuracy": "1.0e-10", "samples_per_period": "512", "periods": "23"},
        "spectrum": {"periods": "4"},
    }
    single, _ = solve(run, scene_text, tmp_path, "single", **groups)
    assert single["rattle_class"] == "idle"
    assert single["verification"] == "verified"
    assert single["harmonic_count"] >= 20
    rows = {"vary": "'load.steady_force'", "first": "9.364527042425909", "last": "9.4", "count": "2"}
    groups["campaign"] = rows | {"record": "'rattle_class', 'harmonic_count'"}
    _, campaign = solve(run, scene_text, tmp_path, "rows", scene={"task": "'campaign'"}, **groups)
    assert campaign["rattle_class"][0] == 3
    assert campaign["harmonic_count"][0] == single["harmonic_count"]
