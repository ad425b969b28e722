"""The class does not depend on how the force is written: random gears, each change of their orders."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

REPEATING = ("quiet", "creep", "idle", "subharmonic")
# A small order shakes the gear itself: its harmonics may carry a multiple over the threshold, or below it.
SMALL_SHARES = (1e-6, 1e-4, 3e-3, 1e-2)
# From this share on an order is no trace: the force repeats with it, and what was subharmonic is its own.
TRACE = 1e-3
# A loose third gear of a small car: creep with 18 harmonics at 6.5 degC, idle with 21 at 8 degC.
PAIR = {
    "teeth_1": "27, teeth_2 = 35",
    "normal_module": "2.0e-3",
    "helix_angle_deg": "28.0",
    "face_width": "0.0155",
    "centre_distance": "0.0705",
    "loose_inertia": "5.2e-4",
    "bearing_mean_diameter": "0.040",
    "synchroniser_cones": "1, synchroniser_diameter = 0.064, synchroniser_width = 0.007",
    "synchroniser_gap": "0.2e-3",
    "immersion_depth": "0.008",
    "backlash": "9.0e-5",
}


def small_name(share: float) -> str:
    return f"small_{share:.0e}".replace("-", "")


NO_TRACE = tuple(small_name(share) for share in SMALL_SHARES if share >= TRACE)


def shaft(orders, accelerations, phases, speed=800.0) -> dict[str, str]:
    lists = {"orders": orders, "accelerations": accelerations, "phases": phases}
    return {"speed_rpm": repr(speed)} | {
        name: ", ".join(map(repr, map(float, values))) for name, values in lists.items()
    }


def solve(run, folder: Path, name: str, gear, shaking, celsius, solver=None, periods: int = 4) -> dict:
    groups = {
        "gear": gear,
        "shaft": shaking,
        "oil": {"viscosity_40_cst": "46.0", "viscosity_100_cst": "8.2", "temperature_celsius": repr(celsius)},
        "solver": {"until": "'steady'", "periods": "300", "starts": "1"} | (solver or {}),
        "spectrum": {"periods": str(periods)},
        "output": {"series": ".false."},
    }
    text = "".join(
        f"&{group}\n" + "".join(f"   {key} = {value}\n" for key, value in keys.items()) + "/\n"
        for group, keys in groups.items()
    )
    (folder / f"{name}.nml").write_text(text)
    ended = run(f"{name}.nml", cwd=folder, timeout=600.0)
    assert ended.returncode == 0, ended.stderr
    return summary_of(folder / "results" / f"{name}.summary.nml")


@pytest.mark.parametrize(("celsius", "word"), ((6.0, "creep"), (6.5, "creep"), (8.0, "idle")))
def test_a_half_order_beside_the_engine_orders_leaves_the_class(run, tmp_path, celsius, word) -> None:
    """A measured cycle has half orders: of the same engine it gives the class that its whole orders give."""
    plain = solve(run, tmp_path, "plain", PAIR, shaft((2, 4), (667, 140), (0, 0)), celsius)
    halves = solve(run, tmp_path, "halves", PAIR, shaft((0.5, 2, 4), (5, 667, 140), (0, 0, 0)), celsius)
    assert plain["rattle_class"] == halves["rattle_class"] == word
    assert plain["verification"] == halves["verification"] == "verified"
    assert plain["harmonic_count"] == halves["harmonic_count"]
    assert halves["spectral_reach"] == pytest.approx(plain["spectral_reach"], rel=1e-3)
    # Four times as long a period has four times the reversals; a second and a revolution have as many.
    assert halves["reversals_per_period"] == 4.0 * plain["reversals_per_period"]
    for span in ("second", "revolution"):
        name = f"reversals_per_{span}"
        assert halves[name] == pytest.approx(plain[name], rel=1e-12)
    assert plain["reversals_per_second"] == pytest.approx(
        plain["reversals_per_revolution"] * 800.0 / 60.0 * 27.0 / 35.0, rel=1e-12
    )


def random_gear(random: np.random.Generator):
    gear = PAIR | {
        "loose_inertia": repr(float(random.uniform(2e-4, 1.5e-3))),
        "backlash": repr(float(random.uniform(5e-5, 2e-4))),
        "tooth_stiffness": "14.0e9",
    }
    orders = np.array([2.0, 4.0, 6.0][: random.integers(1, 4)])
    accelerations = random.uniform(100.0, 900.0, orders.size) / orders
    phases = random.uniform(-3.0, 3.0, orders.size)
    return gear, orders, accelerations, phases, float(random.uniform(0.0, 60.0))


def changes_of(orders, accelerations, phases):
    """Name of each change, orders with accelerations and phases, further keys."""
    largest = accelerations.max()
    yield "zero", ([0.5, *orders], [0.0, *accelerations], [0.0, *phases]), {}
    for share in SMALL_SHARES:
        small = ([0.5, *orders], [share * largest, *accelerations], [0.7, *phases])
        yield small_name(share), small, {}
    yield "doubled", ([1.0, *orders], [0.0, *accelerations], [0.0, *phases]), {}
    yield "reversed", (orders[::-1], accelerations[::-1], phases[::-1]), {}
    yield "shifted", (orders, accelerations, phases + 0.9 * orders), {}
    yield "samples", (orders, accelerations, phases), {"solver": {"samples_per_period": "2048"}}
    yield "window", (orders, accelerations, phases), {"periods": 8}


def assert_alike(one: dict, other: dict, change: str) -> None:
    """Repeating, verified motions that are the same by their rms have the same class and numbers."""
    if one["rattle_class"] not in REPEATING or one["verification"] != "verified" or one["motions"] > 1:
        return
    subharmonic = one["rattle_class"] == "subharmonic"
    if subharmonic and change in NO_TRACE:
        return
    # Other motions stand beside subharmonic ones: a trace of force, or another phase, may lead to these.
    is_another = abs(other["acceleration_rms"] / one["acceleration_rms"] - 1.0) > 1e-3
    if subharmonic and is_another and change.startswith(("small", "shifted")):
        return
    assert other["acceleration_rms"] == pytest.approx(one["acceleration_rms"], rel=0.02), change
    assert other["rattle_class"] == one["rattle_class"], change
    if subharmonic:
        # Harmonics between those of the force are listed or not, as the list of orders goes.
        assert other["verdict"] == one["verdict"], change
        return
    if not (one["harmonic_count_is_bound"] or other["harmonic_count_is_bound"]):
        assert abs(other["harmonic_count"] - one["harmonic_count"]) <= 1 + 0.05 * one["harmonic_count"], (
            change
        )
    if "spectral_reach" in one and "spectral_reach" in other:
        assert other["spectral_reach"] == pytest.approx(one["spectral_reach"], rel=0.02), change
    # With an order of a hundredth it is another force: a load next to the limit of impacts passes it or not.
    if change in NO_TRACE:
        return
    assert other["verdict"] == one["verdict"], change
    for name in ("impacts_per_second_drive", "impacts_per_revolution_drive"):
        assert other[name] == pytest.approx(one[name], rel=1e-9), change


# Gears 4 and 9 settle late: they take three quarters of what the first ten take.
QUICK_GEARS = (0, 1, 2, 3, 5, 6, 7, 8)


@pytest.mark.parametrize(
    "seed", [pytest.param(n, marks=() if n in QUICK_GEARS else pytest.mark.long) for n in range(100)]
)
def test_no_way_to_write_a_force_changes_the_class(run, tmp_path, seed) -> None:
    gear, orders, accelerations, phases, celsius = random_gear(np.random.default_rng(seed))
    plain = solve(run, tmp_path, "plain", gear, shaft(orders, accelerations, phases), celsius)
    for change, force, more in changes_of(orders, accelerations, phases):
        other = solve(run, tmp_path, change, gear, shaft(*force), celsius, **more)
        assert_alike(plain, other, change)
