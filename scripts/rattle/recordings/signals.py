"""What rattle takes of a channel, and the files of a mean cycle: its CSV and the lines of the input."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from rattle.keys import key_table
from rattle.recordings import units
from rattle.recordings.channels import Channel
from rattle.recordings.cycles import MeanCycle
from rattle.recordings.faults import RecordingError


@dataclass(frozen=True)
class Taken:
    """A quantity that rattle takes: its group, unit, column of the CSV and, of a shaft, signal_kind."""

    group: str
    unit: str
    column: str
    kind: str = ""

    @property
    def is_speed(self) -> bool:
        """Whether rattle differentiates it."""
        return self.kind == "angular_speed_rpm"


SPEED = Taken("shaft", "rpm", "speed_rpm", "angular_speed_rpm")
ACCELERATION = Taken("shaft", "rad/s2", "angular_acceleration [rad/s2]", "angular_acceleration")
FORCE = Taken("load", "N", "force_N")


# Units of what benches record and rattle does not take.
OTHERS = ("kg", "V", "A", "m", "m/s", "s", "K", "Pa", "W", "J", "l/min", "%", "1")


def taken(channel: Channel, radius: float | None, notes: list[str]) -> tuple[Channel, Taken]:
    """The channel in the unit of what rattle takes of it; `radius` [m] turns torques and accelerations."""
    for quantity in (SPEED, ACCELERATION, FORCE):
        if units.fits(channel.unit, quantity.unit):
            return _converted(channel, quantity, 1.0, notes), quantity
    for unit, quantity, words in (
        ("m/s2", ACCELERATION, "an acceleration along a circle"),
        ("N m", FORCE, "a torque"),
    ):
        if units.fits(channel.unit, unit):
            if radius is None:
                raise RecordingError(
                    f"'{channel.name}' is {words} in {channel.unit}; rattle takes {quantity.unit}: give "
                    "the radius "
                    "of it by --radius, in m (of a torque on the loose gear r_b2 cos beta_b, which "
                    "--check prints)."
                )
            scaled = _converted(channel, replace(quantity, unit=unit), 1.0 / radius, notes)
            notes.append(f"divided by the radius of {radius:g} m it is in {quantity.unit}.")
            return replace(scaled, unit=quantity.unit), quantity
    if channel.unit and any(units.fits(channel.unit, other) for other in OTHERS):
        raise RecordingError(
            f"'{channel.name}' is in {units.shown(channel.unit)}; rattle takes the speed of a shaft "
            "(1/min, rad/s, Hz), its angular "
            "acceleration (rad/s2), its angle (deg), or a force (N): choose another --signal, or give its "
            "--unit."
        )
    units.factor(channel.unit, SPEED.unit, channel.name)  # says that its unit is missing or not known
    raise AssertionError(channel.unit)


def _converted(channel: Channel, quantity: Taken, scale: float, notes: list[str]) -> Channel:
    factor = units.factor(channel.unit, quantity.unit, channel.name)
    same = "as recorded" if factor == 1.0 else f"times {factor:.6g}, from {units.shown(channel.unit)}"
    notes.append(f"'{channel.name}' is in {units.shown(quantity.unit)}, {same}.")
    return replace(channel, unit=quantity.unit, values=channel.values * (factor * scale))


def write_csv(path: Path, cycle: MeanCycle, quantity: Taken) -> None:
    """One cycle over the angle, as `signal` takes it."""
    turns = cycle.cycle_revolutions
    lines = [f"# mean of {cycle.cycles} x {turns} revolutions", f"angle_deg,{quantity.column}"]
    step = 360.0 * turns / len(cycle.values)
    lines += [f"{round(step * place, 9)!r},{value:.9g}" for place, value in enumerate(cycle.values.tolist())]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def namelist(cycle: MeanCycle, quantity: Taken, path: Path) -> str:
    """The lines of the input that take the CSV."""
    lines = [f"signal = '{path.name}'", f"signal_column = '{quantity.column}'"]
    known = np.isfinite(cycle.speed_rpm)
    if quantity.group == "shaft":
        lines.append(f"signal_kind = '{quantity.kind}'")
        lines.append(f"cycle_revolutions = {cycle.cycle_revolutions}")
        if known:
            lines.insert(0, f"speed_rpm = {cycle.speed_rpm:.6g}")
    else:
        lines.append("signal_cycles = 1")
        if known:
            lines.insert(0, f"frequency = {cycle.speed_rpm / 60.0 / cycle.cycle_revolutions:.8g}")
    if cycle.kept:
        lines.append(f"signal_orders = {cycle.kept}")
    if known:
        low, high = cycle.speed_range
        span = f"{math.floor(low):.1f}, {math.ceil(high):.1f}"
        if (quantity.group, "signal_speed_range") in key_table():
            lines.append(f"signal_speed_range = {span}")
        else:
            lines.append(f"! measured from {math.floor(low)} to {math.ceil(high)} 1/min")
    return "\n".join([f"&{quantity.group}", *(f"   {line}" for line in lines), "/"])
