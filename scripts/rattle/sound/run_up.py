"""A run-up as a sound, quasi-steady: the steady motion of each speed, cross-faded into that of the next.

Of a campaign these are the motions from rest; of a sweep those that it carries along, there and back.

All follow the angle of the shaft, which turns as fast as the speed says: a motion is heard faster or slower
as the speed is above or below its own, so that pitch rises evenly.
"""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rattle import outputs, rerun
from rattle.campaign_plan import GEAR
from rattle.campaign_result import Campaign
from rattle.command import CommandError
from rattle.optional import needed
from rattle.result import Result
from rattle.run_up import KEY, SAME_PEAKS, SPEED, first_order
from rattle.solve import SceneFailed, Solved, run
from rattle.sound.force import COLUMNS, ForceHarmonics, force_harmonics
from rattle.sound.levels import sound_level
from rattle.sound.pressure import HIGHEST, RATE, Tones, heard_share, tones_of
from rattle.sound.transfer import Transfer

SETTINGS = {"solver.starts": 1, "solver.samples_per_period": 4096, "output.columns": list(COLUMNS)}
OF_SWEEPS = {
    "solver.until": "steady",
    "output.columns": [*COLUMNS, "film_thickness", "squeeze_velocity"],
}
# What the next motion of a sweep begins with, by the columns whose last row it is.
ENDING = {"film.initial_film": "film_thickness", "film.initial_velocity": "squeeze_velocity"}
# Points of the table of a motion for the shortest wave in it; cubic splines between are within 1e-4.
POINTS = 16
SHORTEST, LONGEST = 0.2, 600.0  # seconds


@dataclass(frozen=True)
class SpeedMotion:
    """The force of each pair at one speed [1/min], from rest."""

    speed: float
    forces: dict[str, ForceHarmonics]

    @property
    def rms(self) -> float:
        """Of the forces, as if they knew nothing of each other [N]."""
        return float(np.sqrt(sum(force.rms**2 for force in self.forces.values())))


@dataclass(frozen=True)
class HeardRunUp:
    """Its pressure [Pa]; for each motion when it is heard alone [s], its level [dB(A)], and its share."""

    motions: tuple[SpeedMotion, ...]
    times: np.ndarray
    levels: tuple[float, ...]
    shares: tuple[float, ...]
    pressure: np.ndarray

    def followed_by(self, other: HeardRunUp) -> HeardRunUp:
        """This one, and another that begins with its last motion."""
        return HeardRunUp(
            self.motions + other.motions[1:],
            np.append(self.times, self.times[-1] + other.times[1:]),
            self.levels + other.levels[1:],
            self.shares + other.shares[1:],
            np.append(self.pressure, other.pressure[1:]),
        )


def solved_motions(campaign: Campaign) -> tuple[list[SpeedMotion], list[float]]:
    """The motions of a campaign over speed, each solved again from rest, and the speeds that have none.

    Raises CommandError where it varies something else, or fewer than two speeds have motions.
    """
    if {*campaign.varied} - {GEAR} != {KEY} or first_order(campaign) is None:
        raise CommandError(
            f"{campaign.path}: a run-up is a campaign that varies {KEY} alone, as gearbox_orders.nml."
        )
    rows = range(campaign.row_count)
    with tempfile.TemporaryDirectory(prefix="rattle-") as place:
        folder = Path(place)
        outputs.write(rerun.inputs(campaign, rows, folder, "results"), overwrite=False)
        labels = [rerun.scene_label(campaign, row) for row in rows]
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            found = list(pool.map(lambda label: _force(folder / f"{label}.nml"), labels))
    by_speed: dict[float, dict[str, ForceHarmonics | None]] = {}
    for row, force in zip(rows, found, strict=True):
        gear = campaign.gears[int(campaign[GEAR][row]) - 1] if campaign.gears else ""
        by_speed.setdefault(float(campaign[KEY][row]), {})[gear] = force
    whole = {
        speed: {gear: force for gear, force in forces.items() if force is not None}
        for speed, forces in by_speed.items()
        if all(forces.values())
    }
    if len(whole) < 2:
        raise CommandError(f"{campaign.path}: fewer than two speeds have motions of all pairs.")
    return [SpeedMotion(speed, whole[speed]) for speed in sorted(whole)], sorted(set(by_speed) - set(whole))


def _force(path: Path) -> ForceHarmonics | None:
    """Of one motion; None where it does not reach its end."""
    try:
        solved = run(path, set=SETTINGS, threads=1)
    except SceneFailed:
        return None
    assert isinstance(solved, Solved)
    return force_harmonics(solved, HIGHEST)


def driven_motions(sweeps: Mapping[str, Result]) -> tuple[list[list[SpeedMotion]], list[float]]:
    """The motions of sweeps over speed, one of each pair, way by way, and speeds of which one is not found.

    Each is solved again from the end of the one before, as the sweep has done. The way back begins with the
    last motion of the way there. Raises CommandError where a way has fewer than two motions, or sweeps have
    not gone the same way.
    """
    first, *others = sweeps.values()
    for result in sweeps.values():
        if result.names[0] != SPEED or first_order(result) is None:
            raise CommandError(
                f"{result.path}: a driven run-up is a sweep over {KEY}, as gearbox_run_up.nml."
            )
    for result in others:
        if not all(np.array_equal(result[name], first[name]) for name in (SPEED, "direction")):
            raise CommandError(f"{first.path} and {result.path} have not gone over the same speeds.")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = dict(zip(sweeps, pool.map(_driven_forces, sweeps.values()), strict=True))
    ways: list[list[SpeedMotion]] = [[]]
    left_out: list[float] = []
    for row, (speed, way) in enumerate(zip(first[SPEED].tolist(), first["direction"], strict=True)):
        if row and way != first["direction"][row - 1]:
            ways.append(ways[-1][-1:])
        forces = {gear: force for gear, of_rows in found.items() if (force := of_rows[row]) is not None}
        if len(forces) == len(found):
            ways[-1].append(SpeedMotion(speed, forces))
        else:
            left_out.append(speed)
    if min(map(len, ways)) < 2:
        raise CommandError(f"{first.path}: fewer than two speeds of a way have motions.")
    return ways, left_out


def _driven_forces(result: Result) -> list[ForceHarmonics | None]:
    """The force of each motion of a sweep; None where that of the sweep is not found again."""
    forces: list[ForceHarmonics | None] = []
    ending: dict[str, float] = {}
    with tempfile.TemporaryDirectory(prefix="rattle-") as place:
        files = rerun.motion_of_sweep(result, Path(place))
        outputs.write(files, overwrite=False)
        for row, speed in enumerate(result[SPEED].tolist()):
            try:
                solved = run(files[0][0], set={**SETTINGS, **OF_SWEEPS, KEY: speed, **ending}, threads=1)
            except SceneFailed:
                ending = {}
                forces.append(None)
                continue
            assert isinstance(solved, Solved) and isinstance(solved.result, Result)
            ending = {key: float(solved.result[name][-1]) for key, name in ENDING.items()}
            same = _is_that_of(solved, result, row)
            forces.append(force_harmonics(solved, HIGHEST) if same else None)
    return forces


def _is_that_of(solved: Solved, result: Result, row: int) -> bool:
    """Whether a motion is that of a row; of two that do not repeat only that they do not."""
    assert isinstance(solved.result, Result)
    period = solved.result.orbit_period
    if period is None or not result["orbit_period"][row] > 0.0:
        return period is None and not result["orbit_period"][row] > 0.0
    return math.isclose(solved.summary["film_force_rms"], result["film_force_rms"][row], rel_tol=SAME_PEAKS)


def heard_driven(ways: Sequence[Sequence[SpeedMotion]], rate: float, transfer: Transfer) -> HeardRunUp:
    """A driven run-up, one way after the other, each of this `rate` [1/min/s] in size; raises as `heard`."""
    found: HeardRunUp | None = None
    turns = 0.0
    for way in ways:
        first, last = way[0].speed, way[-1].speed
        part = heard(way, math.copysign(rate, last - first), transfer, turns)
        turns += 0.5 * (first + last) / 60.0 * part.times[-1]
        found = part if found is None else found.followed_by(part)
    assert found is not None, "a run-up has a way"
    return found


def heard(
    motions: Sequence[SpeedMotion], rate: float, transfer: Transfer, turns_before: float = 0.0
) -> HeardRunUp:
    """The run-up of a `rate` [1/min/s], down where it is below 0, after so many turns of the shaft.

    Raises CommandError where it is too short or too long, or nothing of it is passed on.
    """
    motions = sorted(motions, key=lambda one: one.speed, reverse=rate < 0.0)
    speeds = np.array([one.speed for one in motions])
    times = (speeds - speeds[0]) / rate
    if not SHORTEST <= times[-1] <= LONGEST:
        raise CommandError(
            f"The run-up takes {times[-1]:.4g} s at {abs(rate):g} 1/min/s; from {SHORTEST:g} to "
            f"{LONGEST:g} s can be heard."
        )
    tones = [tones_of([*one.forces.values()], transfer) for one in motions]
    shares = [
        sum(heard_share(force, transfer) * force.rms**2 for force in one.forces.values())
        / (one.rms**2 or 1.0)
        for one in motions
    ]
    if not max(shares) > 0.0:
        raise CommandError("No force of the run-up is in the range of the transfer function.")
    pressure = np.zeros(int(times[-1] * RATE) + 1)
    for place, parts in enumerate(tones):
        near = slice(max(place - 1, 0), min(place + 2, speeds.size))
        first, last = int(np.ceil(times[near][0] * RATE)), int(times[near][-1] * RATE)
        time = np.arange(first, last + 1) / RATE
        weight = np.interp(time, times[near], (speeds[near] == speeds[place]).astype(float))
        turns = turns_before + (speeds[0] * time + 0.5 * rate * time**2) / 60.0
        # What is heard faster must not pass the highest frequency.
        highest = HIGHEST * speeds[place] / speeds[near].max()
        for part in parts:
            repetitions = turns * part.frequency / (speeds[place] / 60.0)
            pressure[first : last + 1] += weight * _wave(part, highest, repetitions)
    return HeardRunUp(tuple(motions), times, tuple(map(sound_level, tones)), tuple(shares), pressure)


def _wave(tones: Tones, highest: float, repetitions: np.ndarray) -> np.ndarray:
    """The pressure of a motion after so many of its repetitions."""
    spline = needed("scipy", "scipy.interpolate").CubicSpline
    amplitudes = np.concatenate([[0.0], tones.amplitudes[tones.frequencies <= highest]])
    count = POINTS * amplitudes.size
    values = np.fft.irfft(amplitudes, count) * count
    return spline(np.arange(count + 1) / count, np.append(values, values[0]), bc_type="periodic")(
        repetitions % 1.0
    )


def rows(found: HeardRunUp, most: int) -> Iterator[list[str]]:
    """A line for some of its motions, evenly spaced."""
    yield ["speed [1/min]", "at [s]", "force rms [N]", "passed on", "level [dB(A)]"]
    for place in np.unique(np.linspace(0, len(found.motions) - 1, most).astype(int)):
        motion = found.motions[place]
        share, level = found.shares[place], found.levels[place]
        yield [
            f"{motion.speed:g}",
            f"{found.times[place]:.3g}",
            f"{motion.rms:.4g}",
            f"{100.0 * share:.3g} %",
            f"{level:.1f}",
        ]
