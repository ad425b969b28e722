"""Fits what drawing and oil cannot give, the drag above all, to points measured over speed and temperature.

Every motion is solved by the program: a fit asks it for campaigns whose scenes are the measured points.
"""

from __future__ import annotations

import csv
import math
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np
from scipy import optimize, stats

from rattle.campaign_result import Campaign
from rattle.codes import CODES, QUANTITIES
from rattle.command import CommandError
from rattle.counts import counted
from rattle.solve import campaign

SPEED, TEMPERATURE = "speed_rpm", "temperature_celsius"
RATTLES = "rattles"
YES, NO = ("1", "yes", "true", "y"), ("0", "no", "false", "n")
# What stands in the verdict of a pair that rattles, by what a listener is taken to hear.
CRITERIA = {
    "separation": ("separation", "impacts"),
    "impacts": ("impacts",),
    "double_sided": ("double-sided impacts",),
}
CONFIDENCE = 0.95
SCAN, BISECTIONS = 25, 14
# Of a scan for two keys: points an axis, best points that are looked at closer, and how often.
FINE_SCAN, BEST, ZOOMS = 9, 4, 4


@dataclass(frozen=True)
class Measurements:
    """Points of a test stand: `name` is 'rattles' or a quantity of the program."""

    name: str
    speeds: np.ndarray
    temperatures: np.ndarray
    values: np.ndarray


@dataclass(frozen=True)
class Fitted:
    """A key with its fitted value; no interval where the measurements leave none.

    `is_bound`: the interval is all that the measurements allow, not one of a confidence.
    """

    key: str
    value: float
    interval: tuple[float, float] | None
    is_bound: bool = False


@dataclass(frozen=True)
class Fit:
    """What a fit found; `computed` stands beside the measured values, `notes` are sentences for the user."""

    fitted: tuple[Fitted, ...]
    computed: np.ndarray
    notes: tuple[str, ...]


def read_measurements(path: Path) -> Measurements:
    """Read a CSV file with columns speed_rpm, temperature_celsius and what was measured."""
    with path.open(newline="", encoding="utf-8-sig", errors="surrogateescape") as stream:
        lines = [
            (number, row) for number, row in enumerate(csv.reader(stream), 1) if any(map(str.strip, row))
        ]
    if not lines:
        raise CommandError(f"{path} is empty; it has a head and a line for each measured point.")
    head = [name.strip() for name in lines[0][1]]
    others = [name for name in head if name not in (SPEED, TEMPERATURE)]
    if sorted(head) != sorted([SPEED, TEMPERATURE, *others]) or len(others) != 1:
        raise CommandError(
            f"{path}: the head is '{','.join(head)}'; it has to have {SPEED}, {TEMPERATURE} and one column "
            f"that was measured: '{RATTLES}' (1 or 0), or a quantity such as film_force_rms."
        )
    (name,) = others
    if name != RATTLES and (name not in QUANTITIES or QUANTITIES[name].kind not in ("number", "count")):
        raise CommandError(f"{path}: '{name}' is neither '{RATTLES}' nor a number that the program reports.")
    columns: dict[str, list[float]] = {column: [] for column in head}
    for number, row in lines[1:]:
        if len(row) != len(head):
            raise CommandError(
                f"{path}, line {number}: {counted(len(row), 'value')} for {counted(len(head), 'column')}."
            )
        for column, text in zip(head, row, strict=True):
            columns[column].append(_value(text.strip(), column, f"{path}, line {number}"))
    if not columns[name]:
        raise CommandError(f"{path} has no measured point.")
    return Measurements(name, *(np.array(columns[column]) for column in (SPEED, TEMPERATURE, name)))


def _value(text: str, column: str, place: str) -> float:
    if column == RATTLES and text.lower() in (*YES, *NO):
        return float(text.lower() in YES)
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if column == RATTLES or not math.isfinite(value):
        wanted = "1 or 0, yes or no" if column == RATTLES else "a number"
        raise CommandError(f"{place}: '{text}' in column {column} is not {wanted}.")
    if column not in (SPEED, TEMPERATURE) and value <= 0.0:
        raise CommandError(f"{place}: {column} is {text}; shares of it are fitted, so it has to be positive.")
    return value


class Model:
    """The program at the measured points, for any values of the fitted keys."""

    def __init__(
        self,
        input: Path,
        measurements: Measurements,
        keys: Sequence[str],
        *,
        gear: str | None = None,
        criterion: str = "impacts",
    ) -> None:
        self.input, self.measurements, self.keys, self.gear = input, measurements, tuple(keys), gear
        self.column = "verdict" if measurements.name == RATTLES else measurements.name
        self.rattling = [
            code
            for code, word in CODES["verdict"].items()
            if word != "no separation" and any(part in word for part in CRITERIA[criterion])
        ]
        self.notes: set[str] = set()

    def everywhere(self, values: np.ndarray) -> np.ndarray:
        """What the program computes: a row for each row of key values, a column for each measured point."""
        points = len(self.measurements.values)
        found = self._solve(
            np.tile(self.measurements.speeds, len(values)),
            np.tile(self.measurements.temperatures, len(values)),
            np.repeat(values, points, axis=0),
        )
        return found.reshape(len(values), points)

    def at_points(self, values: np.ndarray) -> np.ndarray:
        """What the program computes where each measured point has a value of its own of the one key."""
        return self._solve(self.measurements.speeds, self.measurements.temperatures, values[:, None])

    def _solve(self, speeds: np.ndarray, temperatures: np.ndarray, values: np.ndarray) -> np.ndarray:
        head = ",".join((f"shaft.{SPEED}", f"oil.{TEMPERATURE}", *self.keys))
        with tempfile.TemporaryDirectory(prefix="rattle-") as folder:
            points = Path(folder) / "points.csv"
            lines = np.column_stack((speeds, temperatures, values)).tolist()
            points.write_text("\n".join([head, *(",".join(map(repr, line)) for line in lines), ""]))
            solved = campaign(self.input, record=[self.column], set={"campaign.csv": str(points)})
        rows = cast(Campaign, solved.result)
        if rows.gears and self.gear not in rows.gears:
            raise CommandError(f"{self.input} has the pairs {', '.join(rows.gears)}: choose one by --gear.")
        if self.gear is not None and not rows.gears:
            raise CommandError(f"{self.input} has one pair; leave out --gear.")
        if self.gear is not None:
            rows = rows.pair(self.gear)
        if np.any(rows.failed):
            self.notes.add("Some scenes of the fit failed; they are left out.")
        return np.where(rows.failed, np.nan, np.array(rows[self.column], dtype=float))


def fit_numbers(model: Model, ranges: Sequence[tuple[float, float]]) -> Fit:
    """Values of the keys whose computed numbers are nearest to the measured ones, as shares of them."""
    measured = np.log(model.measurements.values)
    low, high = (np.log(np.array([span[end] for span in ranges])) for end in (0, 1))

    def residuals(logs: np.ndarray) -> np.ndarray:
        return _residuals(model.everywhere(np.exp(logs)[None])[0], measured)

    found = optimize.least_squares(
        residuals,
        _scan(model, low, high, measured),
        bounds=(low, high),
        diff_step=1e-3,
        xtol=1e-10,
        ftol=1e-12,
    )
    logs, notes = found.x, set(model.notes)
    if any(np.minimum(logs - low, high - logs) < 1e-6):
        notes.add(
            "A fitted value lies at the end of its range: measurements and model do not meet within it."
        )
    freedom = len(measured) - len(logs)
    spreads = np.full(len(logs), math.nan)
    normal = found.jac.T @ found.jac
    if freedom > 0 and np.linalg.cond(normal) < 1e12:
        scatter = float(np.sum(found.fun**2)) / freedom
        spreads = stats.t.ppf(0.5 + 0.5 * CONFIDENCE, freedom) * np.sqrt(
            np.diag(np.linalg.inv(normal)) * scatter
        )
    elif freedom <= 0:
        notes.add("There are as many keys as measurements: the fit meets them, and no interval is known.")
    else:
        notes.add("The measurements cannot distinguish the keys: no interval is known.")
    fitted = [
        Fitted(key, math.exp(log), None if math.isnan(s) else (math.exp(log - s), math.exp(log + s)))
        for key, log, s in zip(model.keys, logs, spreads, strict=True)
    ]
    return Fit(tuple(fitted), model.everywhere(np.exp(logs)[None])[0], tuple(sorted(notes | model.notes)))


def _scan(model: Model, low: np.ndarray, high: np.ndarray, measured: np.ndarray) -> np.ndarray:
    """Where the misfit is least on a grid, and on finer ones about its best points.

    Vibrations over drag have jumps, at which a search by slopes alone would stay.
    """
    count = SCAN if len(low) == 1 else FINE_SCAN
    unit = np.stack(np.meshgrid(*[np.linspace(-1.0, 1.0, count)] * len(low)), -1).reshape(-1, len(low))
    half, centres = 0.5 * (high - low), [0.5 * (low + high)]
    for _ in range(ZOOMS):
        points = np.clip(np.concatenate([centre + half * unit for centre in centres]), low, high)
        misfits = np.sum(_residuals(model.everywhere(np.exp(points)), measured) ** 2, axis=1)
        centres = list(points[np.argsort(misfits, kind="stable")[:BEST]])
        half = half * 3.0 / count
    return centres[0]


def _residuals(computed: np.ndarray, measured: np.ndarray) -> np.ndarray:
    """Differences of logarithms; a scene without a positive number is as far off as a factor of a million."""
    usable = np.isfinite(computed) & (computed > 0.0)
    return np.where(usable, np.log(np.where(usable, computed, 1.0)) - measured, math.log(1e6))


def fit_thresholds(model: Model, span: tuple[float, float]) -> Fit:
    """The value of a key at which the pair begins to rattle at some measured points and at others not.

    Each point has a value at which its motion changes, here called its limit. What was heard says on which
    side of it the true value lies.
    """
    logs = np.linspace(np.log(span[0]), np.log(span[1]), SCAN)
    states = np.isin(model.everywhere(np.exp(logs)[:, None]), model.rattling)
    notes = set()
    changes = np.sum(states[1:] != states[:-1], axis=0)
    if any(changes > 1):
        notes.add(
            f"At {int(np.sum(changes > 1))} of {len(changes)} points the motion changes more than once over "
            "the range; the first change from the lower end is taken."
        )
    points = np.arange(len(changes))
    first = np.argmax(states[1:] != states[:-1], axis=0)
    low, high = logs[first], logs[first + 1]
    at_low = states[first, points]
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        same = np.isin(model.at_points(np.exp(middle)), model.rattling) == at_low
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    limits = 0.5 * (low + high)
    # A motion that is the same over the whole range has its limit beyond one end, wherever that is.
    heard = model.measurements.values > 0.5
    lower, upper = logs[0], logs[-1]
    useful = changes > 0
    for at, calm_above, rattles, is_useful, state in zip(
        limits, at_low, heard, useful, states[0], strict=True
    ):
        if not is_useful:
            if state != rattles:
                notes.add("A measured point disagrees with the model over the whole range.")
            continue
        # More of the key calms the motion where it rattles at the lower end.
        if rattles == calm_above:
            upper = min(upper, at)
        else:
            lower = max(lower, at)
    key = model.keys[0]
    if not np.any(useful):
        raise CommandError(
            f"The motion does not change between {key} = {span[0]:g} and {span[1]:g} at any point."
        )
    agree = lower < upper
    if agree:
        best, interval = 0.5 * (lower + upper), (math.exp(lower), math.exp(upper))
        if lower == logs[0] or upper == logs[-1]:
            notes.add(
                "The measurements bound the value on one side only; the other end is that of the range."
            )
    else:
        notes.add("No value agrees with all points: the one with the least disagreement is reported.")
        best, interval = _by_likelihood(limits[useful], (heard == at_low)[useful], logs)
    computed = np.isin(model.everywhere(np.array([[math.exp(best)]]))[0], model.rattling).astype(float)
    return Fit(
        (Fitted(key, math.exp(best), interval, is_bound=agree),), computed, tuple(sorted(notes | model.notes))
    )


def _by_likelihood(
    limits: np.ndarray, below: np.ndarray, logs: np.ndarray
) -> tuple[float, tuple[float, float]]:
    """The most likely value of a key and its interval, where ears and model scatter about the limits."""
    values = np.linspace(logs[0], logs[-1], 2001)
    sign = np.where(below, 1.0, -1.0)

    def worst(log_width: float, value: float) -> float:
        return float(np.sum(np.logaddexp(0.0, -sign * (limits - value) / math.exp(log_width))))

    span = (math.log(1e-3), math.log(logs[-1] - logs[0]))
    costs = np.array(
        [optimize.minimize_scalar(worst, bounds=span, args=(v,), method="bounded").fun for v in values]
    )
    likely = values[costs <= np.min(costs) + 0.5 * stats.chi2.ppf(CONFIDENCE, 1)]
    return float(values[np.argmin(costs)]), (math.exp(likely[0]), math.exp(likely[-1]))
