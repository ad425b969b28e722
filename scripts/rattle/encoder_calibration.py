"""Fits backlash and drag, or inertia, of a loose gear to what two encoders show (recording.py encoders).

The program solves the motion under the shaft that was measured, and what reads the encoders reads that, too,
with their noise: so oil films, which no encoder sees, and errors of reading count on both sides.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy import integrate

from rattle.calibration import Fitted
from rattle.command import CommandError
from rattle.derived import derived
from rattle.recordings.encoders import FORM
from rattle.recordings.loose_flight import Flank, Flights, Motion, look
from rattle.solve import Gearbox, run

PERIODS, SETTLING = 60, 20  # periods of the force that are solved, and those left out at their beginning
SAMPLES = 4096  # a period
COLUMNS = ("time", "gear_position", "acceleration", "applied_force")
ROUNDS = 8
CLOSE = 0.05  # of an interval: a fit that moves by less has come to its end
BACKLASH, INERTIA = "gear.backlash", "gear.loose_inertia"
# By flank: what is compared, and the unit in which it is shown.
COMPARED = (
    ("impacts a period", "impacts_per_period", 1.0),
    ("approach [mm/s]", "velocity", 1e3),
    ("restitution", "restitution", 1.0),
)


@dataclass(frozen=True)
class EncoderFit:
    """What a fit found: keys, measured beside computed numbers as a table, sentences for the user."""

    fitted: tuple[Fitted, ...]
    rows: list[list[str]]
    notes: tuple[str, ...]


def is_encoders(path: Path) -> bool:
    """Whether a file is one of 'recording.py encoders'."""
    with path.open("rb") as stream:
        return stream.read(64).lstrip().startswith(b"{")


def read_encoders(path: Path) -> dict[str, Any]:
    """What 'recording.py encoders' wrote."""
    try:
        recorded = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as fault:
        raise CommandError(f"{path} is not a file of 'recording.py encoders': {fault}.") from None
    if not isinstance(recorded, dict) or recorded.get("form") != FORM:
        raise CommandError(f"{path} is not a file of 'recording.py encoders': its form is not '{FORM}'.")
    return recorded


def fit_encoders(input: Path, recorded: Mapping[str, Any], gear: str | None = None) -> EncoderFit:
    """Backlash, and drag or inertia, with which the program moves as the encoders show."""
    if not recorded["is_double_sided"]:
        raise CommandError(
            "The encoders show no impacts on both flanks: the backlash is more than "
            f"{recorded['play']['value'] * 1e6:.3g} um; record a speed at which both are hit."
        )
    if recorded["drag_over_inertia"] is None:
        raise CommandError("The encoders show no flights, from which drag over inertia could be fitted.")
    notes: list[str] = []
    settings = measured_shaft(input, recorded, gear, notes)
    start = derived(input, gear=gear, set=settings)
    if BACKLASH not in start:
        raise CommandError(f"{input}: the pair needs a backlash, from which the fit begins.")
    drag = "gear.drag_scale" if "gear.drag_scale" in start else "gear.drag_torque"
    play, ratio = recorded["play"], recorded["drag_over_inertia"]
    inertia, torque = float(start[INERTIA]), float(start["gear.drag_torque"])
    values = {BACKLASH: float(start[BACKLASH]), drag: float(start[drag])}
    unit = torque / values[drag]  # N m of the drag for each of its key
    for _ in range(ROUNDS):
        seen, lever = solved(input, settings | values, gear, recorded["step"], recorded["noise"])
        if not seen.is_double_sided or seen.deceleration is None:
            raise CommandError(
                f"With {_words(values)} the computed motion has no impacts on both flanks, as the measured "
                "one has: check oil, inertia and the orders of the shaft."
            )
        play_seen, deceleration = asdict(seen.play), asdict(seen.deceleration)
        longer = play["value"] - seen.play.value
        more = ratio["value"] - seen.deceleration.value / lever
        values = {BACKLASH: values[BACKLASH] + longer, drag: values[drag] + more * inertia / unit}
        if min(values.values()) <= 0.0:
            raise CommandError(
                f"The measured flights ask for {_words(values)}; check the inertia and the oil."
            )
        if abs(longer) < CLOSE * _width(play) and abs(more) < CLOSE * _width(ratio):
            break
    else:
        notes.append(f"The fit has not converged after {ROUNDS} rounds: the computed motion is not regular.")
    # Both the measured and the computed motion are known to an interval.
    half_play = 0.5 * math.hypot(_width(play), _width(play_seen))
    half = 0.5 * math.hypot(_width(ratio), _width(deceleration) / lever)
    per_inertia = unit * values[drag] / inertia
    notes += [
        f"Drag over inertia is {per_inertia:.4g} 1/s2; flights give this ratio alone. {drag} is that of "
        f"{INERTIA} = {inertia:.4g} of the input.",
        f"If the input's drag is right, {torque:.4g} N m, {INERTIA} would be {torque / per_inertia:.4g}, "
        f"{torque / (per_inertia + half):.4g} to {torque / max(per_inertia - half, 1e-300):.4g} kg m2.",
    ]
    fitted = (
        Fitted(BACKLASH, values[BACKLASH], _around(values[BACKLASH], half_play)),
        Fitted(drag, values[drag], _around(values[drag], half * inertia / unit)),
    )
    return EncoderFit(fitted, comparison(recorded, seen), tuple(notes))


def measured_shaft(
    input: Path, recorded: Mapping[str, Any], gear: str | None, notes: list[str]
) -> dict[str, Any]:
    """Keys by which an input moves as the driver did, in oil of the temperature that was noted."""
    given = derived(input, gear=gear)
    shaft = recorded["shaft"]
    settings: dict[str, Any] = {"shaft.speed_rpm": shaft["speed_rpm"]}
    if "shaft.table" in given or "shaft.signal" in given:
        notes.append(
            "The orders of the shaft are those of the table or signal of the input, not those measured."
        )
    elif "shaft.speed_amplitudes" in given:
        notes.append("The orders of the shaft are those of the input, not those measured.")
    else:
        settings |= {f"shaft.{key}": list(shaft[key]) for key in ("orders", "accelerations", "phases")}
        settings["load.force_scale"] = 1.0
    if recorded["temperature_celsius"] is None:
        notes.append("The encoders' file has no temperature: the oil is that of the input.")
    elif "oil.temperature_celsius" in given:
        settings["oil.temperature_celsius"] = recorded["temperature_celsius"]
    return settings


def solved(
    input: Path, settings: Mapping[str, Any], gear: str | None, step: float, noise: float
) -> tuple[Flights, float]:
    """What the computed motion shows at samples `step` [s] apart with `noise` [m].

    Beside it the lever [m] from its accelerations to those of the angle.
    """
    asked = {
        "scene.task": "motion",
        "solver.until": "periods",
        "solver.periods": PERIODS,
        "solver.samples_per_period": SAMPLES,
        "solver.starts": 1,
        "spectrum.periods": 1,
        "spectrum.verify": False,
        "output.columns": list(COLUMNS),
        "output.stride": 1,
    }
    found = run(input, set=asked | dict(settings))
    result = (found[gear or ""] if isinstance(found, Gearbox) else found).result
    assert result is not None, "a series is asked for"
    numbers = derived(input, gear=gear, set=dict(settings))
    mass, steady, frequency = (float(numbers[f"load.{key}"]) for key in ("mass", "steady_force", "frequency"))
    part = slice(SETTLING * SAMPLES, None)
    time, gap, acceleration, force = (np.array(result[name][part], dtype=float) for name in COLUMNS)
    # The gear's own acceleration is the relative one and that of the shaft, (F - Q)/m.
    own = acceleration + (force - steady) / mass
    velocity = integrate.cumulative_simpson(own, x=time, initial=0.0)
    gear_way = integrate.cumulative_simpson(velocity, x=time, initial=0.0)
    lever = float(numbers["gear.base_radius_2"]) * math.cos(
        math.radians(float(numbers["gear.base_helix_angle"]))
    )
    even = np.arange(time[0], time[-1], step)
    disturbed = np.interp(even, time, gap) + np.random.default_rng(0).normal(0.0, noise, len(even))
    return look(Motion(step, disturbed, np.interp(even, time, gear_way), even * frequency)), lever


def comparison(recorded: Mapping[str, Any], seen: Flights) -> list[list[str]]:
    """What was measured of the impacts beside what the fitted input computes, which the fit did not use."""
    rows = [["", "measured", "computed"]]
    for side, flank in (("drive", seen.drive), ("coast", seen.coast)):
        for words, key, scale in COMPARED:
            measured, computed = _value(recorded[f"{key}_{side}"]), _of(flank, key)
            rows.append([f"{words}, {side} flank", *(_shown(scale, value) for value in (measured, computed))])
    return rows


def _of(flank: Flank, key: str) -> float | None:
    value = getattr(flank, key)
    return value if value is None or isinstance(value, float) else value.value


def _value(recorded: Any) -> float | None:
    return recorded["value"] if isinstance(recorded, dict) else recorded


def _shown(scale: float, value: float | None) -> str:
    return "unknown" if value is None else f"{scale * value:.4g}"


def _width(estimate: Mapping[str, float]) -> float:
    return estimate["high"] - estimate["low"]


def _around(value: float, half: float) -> tuple[float, float]:
    return value - half, value + half


def _words(values: Mapping[str, float]) -> str:
    return " and ".join(f"{key} = {value:.4g}" for key, value in values.items())
