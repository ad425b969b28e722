"""Separation and impacts: what summaries and rows report, compared with motions solved by other means."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from impact_reference import (
    ExactIsoViscous,
    PublishedIsoViscous,
    PublishedPiezoViscous,
    Tooth,
    find_impacts,
    share_below,
    solve,
)
from outcomes import summary_of

import rattle

CONTACT = {"radius": 0.0127, "length": 0.010}
ISO = PublishedIsoViscous(1.905, 0.0127, 0.010, 0.3)
PIEZO = PublishedPiezoViscous(1.905, 1.000449736566e-06, 199.2 + 3.0 * 9.80665)
EXACT = ExactIsoViscous(3.81, 0.0127, 0.010, 0.3)
CANONICAL = Tooth(ISO, 3.0, 600.0, 199.2, ((1, 205.7, 0.0),))
LOOSE = Tooth(
    ExactIsoViscous(2.14, 7.5e-3, 0.02, 0.05),
    0.45,
    26.7,
    5.0,
    ((1, 7.9, 0.0), (2, 2.0, 0.5), (3, 0.8, 1.1)),
    gravity=0.0,
    backlash=1e-4,
)
# The canonical scenes and those of real gears, by their names.
SCENES = {
    "idle": CANONICAL,
    "creep": replace(CANONICAL, film=PIEZO),
    "R1": LOOSE,
    "R2": replace(CANONICAL, orders=((1, 150.0, 0.0), (2, 60.0, 0.7), (3, 25.0, -1.2))),
    "R3": replace(CANONICAL, film=PIEZO, steady_force=20.0, gravity=0.0, backlash=4e-6),
    "R4": Tooth(
        PublishedIsoViscous(1.07, 7.5e-3, 0.02, 0.05),
        0.45,
        26.7,
        0.0,
        ((1, 6.0, 0.0), (4, 3.0, 0.3)),
        gravity=0.0,
        backlash=8e-5,
    ),
    "S1": replace(CANONICAL, film=EXACT, stiffness=1e8),
    "S2": replace(CANONICAL, film=EXACT, stiffness=3e8),
    "S3": replace(CANONICAL, stiffness=1e9),
    "S4": replace(CANONICAL, film=PIEZO, stiffness=3e8),
    "S5": replace(LOOSE, stiffness=5e7),
}
VERDICTS = {
    "idle": "impacts without separation",
    "creep": "no separation",
    "R1": "separation",
    "R2": "no separation",
    "R3": "separation",
    "R4": "double-sided impacts",
    "S1": "impacts without separation",
    "S2": "impacts without separation",
    "S3": "impacts without separation",
    "S4": "single-sided impacts",
    "S5": "separation",
}


def text_of(tooth: Tooth, extra: str = "") -> str:
    """The scene of a tooth."""
    film = tooth.film
    law, model, speed = "iso-viscous", "published", "entrainment_speed"
    radius, length, viscosity = 0.0127, 0.010, 0.3
    if isinstance(film, PublishedPiezoViscous):
        law = "piezo-viscous"
    else:
        radius, length, viscosity = film.radius, film.length, film.viscosity
    if isinstance(film, ExactIsoViscous):
        model, speed = "reynolds", "rolling_speed"
    contact = f"radius = {radius!r}, length = {length!r}"
    columns = "'time', 'film_thickness', 'squeeze_velocity', 'acceleration'"
    if tooth.backlash is not None:
        contact += f", backlash = {tooth.backlash!r}"
        columns += ", 'coast_film'"
    if tooth.stiffness is not None:
        contact += f", stiffness = {tooth.stiffness!r}"
        columns += ", 'gear_position'"
    orders, amplitudes, phases = (", ".join(repr(order[i]) for order in tooth.orders) for i in range(3))
    return f"""
&contact {contact} /
&lubricant viscosity = {viscosity!r}, pressure_viscosity = 2.0e-8 /
&kinematics {speed} = {film.speed!r} /
&load mass = {tooth.mass!r}, steady_force = {tooth.steady_force!r}, gravity = {tooth.gravity!r},
   frequency = {tooth.frequency!r}, force_orders = {orders}, force_amplitudes = {amplitudes},
   force_phases = {phases} /
&film law = '{law}', model = '{model}' /
&solver method = 'taylor', until = 'steady', periods = 400, samples_per_period = 512, accuracy = 1.0e-9 /
&spectrum periods = 4 /
&output columns = {columns} /
{extra}
"""


def true_window(tooth: Tooth, result: rattle.ResultFile, first: int, periods: int, points: int):
    """Times, states and loads of a window from the state where it begins, by other means."""
    start = [result["film_thickness"][first], result["squeeze_velocity"][first]]
    if tooth.stiffness is not None:
        start = [result["gear_position"][first], start[1], start[0]]
        if tooth.backlash is not None:
            start.append(result["coast_film"][first])
    size = max(result["film_thickness"][first:])
    least = min(result["film_thickness"][first:])
    if tooth.backlash is not None:
        least = min(least, min(result["coast_film"][first:]))
    speed = max(abs(np.array(result["squeeze_velocity"][first:])))
    scales = (max(least, 1e-3 * size), speed, *(max(least, 1e-3 * size),) * (len(start) - 2))
    times, states = solve(
        tooth.rates, tuple(map(float, start)), scales, periods / tooth.frequency, fewest=points * periods
    )
    # The motion repeats: the program's steady state is one by other means, too.
    assert np.all(np.abs(states[-1] - states[0]) < 1e-6 * np.array([size, speed, size, size][: len(start)]))
    loads = np.array([tooth.loads(tuple(state)) for state in states])
    return times, states, loads


def largest_force(tooth: Tooth) -> float:
    times = np.linspace(0.0, 1.0 / tooth.frequency, 200_001)
    return max(abs(tooth.force(time)) for time in times)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.long if name == "S5" else ()) for name in SCENES]
)
def test_impacts_are_those_of_a_motion_solved_by_other_means(name: str, run, tmp_path: Path) -> None:
    tooth = SCENES[name]
    (tmp_path / "tooth.nml").write_text(text_of(tooth))
    ended = run("tooth.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    reported = summary_of(tmp_path / "results" / "tooth.summary.nml")
    result = rattle.read(tmp_path / "results" / "tooth.rattle")
    periods = reported["window_periods"]
    first = (reported["periods_solved"] - periods) * 512
    begin = (reported["periods_solved"] - periods) / tooth.frequency
    times, states, loads = true_window(tooth, result, first, periods, 16000 if name == "R4" else 4000)

    force = largest_force(tooth)
    static = abs(tooth.steady_force + tooth.mass * tooth.gravity)
    net = loads[:, 0] - loads[:, 1]
    assert reported["reversal"] is bool(net.min() < 0.0 < net.max())
    share = share_below(times, loads[:, 0], 0.01 * (static or force))
    assert reported["unloaded_share"] == pytest.approx(share, abs=1e-6)
    assert reported["separation"] is (reported["reversal"] or share > 0.0)
    assert reported["impact_periods"] == periods
    counts = []
    flanks = ("drive",) if tooth.backlash is None else ("drive", "coast")
    for flank, column, toward in zip(flanks, (0, 1), (-1.0, 1.0), strict=False):
        impacts = find_impacts(times, loads[:, column], toward * states[:, 1], force, 1.5)
        impacts = sorted(
            impact._replace(time=impact.time % (periods / tooth.frequency)) for impact in impacts
        )
        counts.append(len(impacts))
        assert reported[f"impacts_{flank}"] == len(impacts)
        assert reported[f"impacts_per_period_{flank}"] == len(impacts) / periods
        lists = {
            key: np.atleast_1d(reported.get(f"impact_{key}_{flank}", []))
            for key in ("times", "loads", "velocities", "impulses")
        }
        # The other solution has 4000 points a period; of R4, whose impacts are short, 16000.
        assert lists["times"] == pytest.approx([i.time + begin for i in impacts], abs=1e-5 / tooth.frequency)
        assert lists["loads"] == pytest.approx([i.load for i in impacts], rel=1e-5)
        assert lists["velocities"] == pytest.approx([i.velocity for i in impacts], rel=2e-5)
        assert lists["impulses"] == pytest.approx([i.impulse for i in impacts], rel=1e-5)
        for key, lot in (("load", "loads"), ("velocity", "velocities"), ("impulse", "impulses")):
            assert reported[f"impact_{key}_maximum_{flank}"] == max(lists[lot], default=0.0)
        mean = sum(lists["impulses"]) / max(1, len(impacts))
        assert reported[f"impact_impulse_mean_{flank}"] == pytest.approx(mean, rel=1e-14)
    assert reported["verdict"] == VERDICTS[name]
    assert reported.get("double_sided") == (None if len(counts) == 1 else all(counts))
    assert reported["verdict_verified"] is True and reported["impacts_verified"] is True


QUANTITIES = [
    "verdict",
    "reversal",
    "unloaded_share",
    "separation",
    "double_sided",
    "verdict_verified",
    "impacts_verified",
    "impacts_per_period_drive",
    "impacts_per_period_coast",
    "impact_load_maximum_drive",
    "impact_load_maximum_coast",
    "impact_velocity_maximum_drive",
    "impact_velocity_maximum_coast",
    "impact_impulse_maximum_drive",
    "impact_impulse_maximum_coast",
    "impact_impulse_mean_drive",
    "impact_impulse_mean_coast",
]
WORDS = (
    "no separation",
    "separation",
    "single-sided impacts",
    "double-sided impacts",
    "impacts without separation",
)


@pytest.mark.parametrize("name", ("idle", "creep", "R1", "R4", "S1"))
def test_a_row_tells_what_the_summary_tells(name: str, run, tmp_path: Path) -> None:
    """To the last bit, of as many periods from the same start; the row beside it has another force."""
    text = text_of(SCENES[name]).replace("until = 'steady', periods = 400", "periods = 40")
    (tmp_path / "tooth.nml").write_text(text)
    campaign = "&scene task = 'campaign' /\n&campaign vary = 'load.force_scale', first = 1.0, last = 1.2, "
    campaign += f"count = 2, samples_per_period = 512, record = {', '.join(map(repr, QUANTITIES))} /\n"
    (tmp_path / "rows.nml").write_text(text[: text.index("&output")] + campaign)
    for scene in ("tooth.nml", "rows.nml"):
        ended = run(scene, cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
    reported = summary_of(tmp_path / "results" / "tooth.summary.nml")
    rows = rattle.read_campaign(tmp_path / "results" / "rows.rattle")
    assert reported["verdict"] == VERDICTS[name]
    for quantity in QUANTITIES:
        value = rows[quantity][0]
        if quantity not in reported:
            assert np.isnan(value), quantity
        elif quantity == "verdict":
            assert WORDS[int(value)] == reported[quantity]
        else:
            assert value == float(reported[quantity]), quantity


def test_a_higher_limit_leaves_fewer_impacts(run, tmp_path: Path) -> None:
    """R4 hits the drive flank with 26.3 and 32.5 N, the coast flank with 217 N; its force is 9 N."""
    scene = SCENES["R4"]
    force = largest_force(scene)
    verdicts = {}
    for limit, drive, coast in (
        (1.5, 2, 1),
        (29.0 / force, 1, 1),
        (40.0 / force, 0, 1),
        (250.0 / force, 0, 0),
    ):
        text = text_of(scene).replace("&spectrum", f"&spectrum impact_limit = {limit!r},")
        (tmp_path / "tooth.nml").write_text(text)
        assert run("tooth.nml", "--overwrite", cwd=tmp_path).returncode == 0
        reported = summary_of(tmp_path / "results" / "tooth.summary.nml")
        assert (reported["impacts_per_period_drive"], reported["impacts_per_period_coast"]) == (drive, coast)
        assert reported["double_sided"] is (drive > 0 and coast > 0)
        verdicts[(drive, coast)] = reported["verdict"]
    assert verdicts[(0, 1)] == "single-sided impacts" and verdicts[(0, 0)] == "separation"
    (tmp_path / "tooth.nml").write_text(text_of(scene).replace("&spectrum", "&spectrum impact_limit = 1.0,"))
    assert run("--check", "tooth.nml", cwd=tmp_path).returncode == 2


GEAR = """
&gear teeth_1 = 11, teeth_2 = 38, normal_module = 2.5e-3, helix_angle_deg = 28.96, face_width = 0.016,
   loose_inertia = 1.7e-3, drag_torque = {drag!r}, backlash = 1.0e-4, tooth_stiffness = 0.0 /
&shaft speed_rpm = 800.0, orders = 2.0, 4.0, accelerations = 600.0, 100.0, phases = 0.0, 0.8 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, density_15 = 870.0, temperature_celsius = 20.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver until = 'steady', periods = 200 /
"""


def test_a_tooth_that_floats_has_impacts_without_separation(run, tmp_path: Path) -> None:
    """Drag presses the one all the time, the other for most of it; both fall back on the drive film."""
    largest = float(1.7e-3 * 11 / 38 * largest_deceleration(((2, 600.0, 0.0), (4, 100.0, 0.8))))
    for ratio, verdict in ((0.95, "impacts without separation"), (1.1, "single-sided impacts")):
        (tmp_path / "gear.nml").write_text(GEAR.format(drag=largest / ratio))
        ended = run("--overwrite", "gear.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        found = summary_of(tmp_path / "results" / "gear.summary.nml")
        assert found["inertia_ratio"] == pytest.approx(ratio, rel=1e-9)
        assert found["verdict"] == verdict and found["separation"] is (ratio > 1.0)
        assert found["impacts_per_period_drive"] == 1.0 and found["impacts_per_period_coast"] == 0.0
        assert found["verdict_text"].startswith(verdict)


def largest_deceleration(orders) -> float:
    """Largest deceleration of the sum of some orders [rad/s2]."""
    angle = np.linspace(0.0, 2.0 * np.pi, 400001)
    return -min(sum(size * np.cos(n * angle + phase) for n, size, phase in orders))


def test_newmarks_samples_tell_the_same_impacts(run, tmp_path: Path) -> None:
    """Straight lines between 8192 samples a period, whose motion is off by some 1e-5 itself."""
    text = text_of(SCENES["idle"]).replace(", 'squeeze_velocity'", "")
    fine = "method = 'newmark', tolerance = 1e-15, steps_per_period = 8192, periods = 40"
    lists = []
    for solver in ("method = 'taylor', periods = 40", fine):
        begin, rest = text.split("&solver", 1)
        (tmp_path / "tooth.nml").write_text(f"{begin}&solver {solver} /{rest.partition('/')[2]}")
        ended = run("tooth.nml", "--overwrite", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        lists.append(summary_of(tmp_path / "results" / "tooth.summary.nml"))
    first, second = lists
    assert first["verdict"] == second["verdict"] == "impacts without separation"
    # The periods of the one motion repeat to the last bit and are recorded once, those of the other are not.
    assert first["impact_periods"] < second["impact_periods"] == second["window_periods"] == 4
    assert first["impacts_drive"] == first["impact_periods"] and second["impacts_drive"] == 4
    assert first["impacts_per_period_drive"] == second["impacts_per_period_drive"] == 1.0
    for quantity in ("load_maximum", "velocity_maximum", "impulse_maximum", "impulse_mean"):
        key = f"impact_{quantity}_drive"
        assert second[key] == pytest.approx(first[key], rel=1e-4), quantity
    turns = [np.mod(np.array(reported["impact_times_drive"]) * 600.0, 1.0) for reported in lists]
    assert turns[1] == pytest.approx(np.full(4, turns[0][0]), abs=2e-4)
    assert second["unloaded_share"] == first["unloaded_share"] == 0.0
