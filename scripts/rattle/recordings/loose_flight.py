"""What the motion of a loose gear in its backlash shows: play, impacts by flank, flights between them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import interpolate, optimize, signal

from rattle.recordings.faults import RecordingError

# Shares of the play: a tooth has left a flank beyond the first, is back within the second.
AWAY, NEAR = 0.2, 0.1
RISE = 0.05  # by which a turn stands out
FLIGHT = (0.25, 0.75)  # where a gear flies, far from both films
APPROACH = (0.05, 0.35)  # before a flank, where the approach velocity is fitted
# Of the velocity at which a tooth comes near it has so much at a contact, and changes it by as much of that.
HIT = 0.5
SETTLED, REBOUND = 2.0e-4, 1.5e-3  # s behind a contact: between them its rebound is fitted
SMOOTH = 0.01  # of a period: largest window of smoothing
NOISE_SOUGHT = 0.005  # of the play, after smoothing
KNOTS = 2.5  # periods between the knots of the drift
LEAST_SAMPLES = 8  # of a fit
LONGEST = 1 << 16  # samples of an approach
LEAST_PERIODS = 8
STANDING_OUT = 12.0  # of the noise of smoothed positions, whose extremes are some six apart
LEAST_EVENTS = 3
DRAWS = 1000
CONFIDENCE = 0.95


@dataclass(frozen=True)
class Estimate:
    """A mean over `count` events, its interval of CONFIDENCE, and the standard deviation of the events."""

    value: float
    low: float
    high: float
    scatter: float
    count: int


@dataclass(frozen=True)
class Flank:
    """The impacts on one flank: count a period, approach velocities [m/s], restitution [-]; None: unknown."""

    impacts_per_period: float
    velocity: Estimate | None
    velocity_maximum: float | None
    restitution: Estimate | None


@dataclass(frozen=True)
class Flights:
    """What was seen: `play` [m] between contacts, `deceleration` [m/s2] of the gear in flight.

    Without impacts on both flanks `play` is the range of the positions, and the backlash is more. `drift` [m]
    was taken off the positions, `noise` [m] is the standard deviation of a sample.
    """

    periods: int
    play: Estimate
    drive: Flank
    coast: Flank
    deceleration: Estimate | None
    is_double_sided: bool
    drift: float
    noise: float


@dataclass(frozen=True)
class Motion:
    """Positions along the line of action [m] at equal times, `step` [s] apart; the drive flank lies below.

    `gap` is that of the gear before the drive flank but for an unknown drift, `gear` the way of the loose
    gear itself, `period` counts the periods of the force with their parts. `turning` are angles [rad] of
    shafts, with which encoders mounted off their axes err.
    """

    step: float
    gap: np.ndarray
    gear: np.ndarray
    period: np.ndarray
    turning: tuple[np.ndarray, ...] = ()


@dataclass(frozen=True)
class Contact:
    """A contact of a tooth with a flank: height in shares of the play, velocities in such shares a second."""

    sample: int
    height: float
    approach: float
    rebound: float


def look(motion: Motion) -> Flights:
    """Play, impacts and flights of a motion."""
    first, last = math.ceil(motion.period[0]), math.floor(motion.period[-1])
    count = last - first
    if count < LEAST_PERIODS:
        raise RecordingError(
            f"the recording has {max(count, 0)} whole periods of the force; {LEAST_PERIODS} is the least."
        )
    edges = np.searchsorted(motion.period, np.arange(first, last + 1))
    noise = float(np.std(np.diff(motion.gap, 4))) / math.sqrt(70.0)
    smooth, window = _smoothed(motion.gap, noise, edges)
    # Where the flanks seem to be: at the extremes of each period; then at the contacts.
    lowest, highest = (_extremes(smooth, edges, which) for which in (np.argmin, np.argmax))
    drift, low, play = _flanks(motion, lowest, smooth[lowest], highest, smooth[highest])
    if not play.value > STANDING_OUT * noise / math.sqrt(window):
        raise RecordingError(
            f"the relative motion of {play.value * 1e6:.3g} um does not stand out of the encoders' noise, "
            f"{noise * 1e6:.3g} um."
        )
    drives, coasts = _contacts(motion, smooth, drift, low, play.value, edges)
    is_double = min(len(drives), len(coasts)) >= LEAST_EVENTS
    if is_double:
        below, above = (np.array([contact.sample for contact in found]) for found in (drives, coasts))
        drift, low, play = _flanks(
            motion,
            below,
            drift[below] + low + play.value * np.array([contact.height for contact in drives]),
            above,
            drift[above] + low + play.value * (1.0 - np.array([contact.height for contact in coasts])),
        )
        drives, coasts = _contacts(motion, smooth, drift, low, play.value, edges)
    draw = np.random.default_rng(0)
    decelerations = -_accelerations((smooth - drift - low) / play.value, motion, edges)
    drive, coast = (_flank(found, play.value, count, draw) for found in (drives, coasts))
    return Flights(
        count,
        play,
        drive,
        coast,
        _mean(decelerations, draw) if len(decelerations) >= LEAST_EVENTS else None,
        is_double,
        float(np.ptp(drift)),
        noise,
    )


def _smoothed(values: np.ndarray, noise: float, edges: np.ndarray) -> tuple[np.ndarray, int]:
    """Values smoothed by parabolas over as few samples as the noise asks for, and their number."""
    span = float(np.median([np.ptp(part) for part in np.split(values, edges)[1:-1]]))
    if not span > 0.0:
        raise RecordingError(
            "the loose gear does not move against the driver at all; are these two encoders?"
        )
    wanted = 2.25 * (noise / (NOISE_SOUGHT * span)) ** 2
    window = int(min(max(5.0, wanted), max(5.0, SMOOTH * np.median(np.diff(edges))))) | 1
    return signal.savgol_filter(values, window, 2), window


def _extremes(values: np.ndarray, edges: np.ndarray, which: Callable[[np.ndarray], np.intp]) -> np.ndarray:
    """The sample of the extreme of each period."""
    return np.array([begin + which(values[begin:end]) for begin, end in zip(edges, edges[1:], strict=False)])


def _flanks(
    motion: Motion, below: np.ndarray, lows: np.ndarray, above: np.ndarray, highs: np.ndarray
) -> tuple[np.ndarray, float, Estimate]:
    """Drift of the positions over time, place of the drive flank and the play, from positions at both flanks.

    The drift is a spline over time and what turns with the shafts; positions far off count little.
    """
    samples = np.concatenate([below, above])
    seen = np.concatenate([lows, highs])
    pieces = max(1, int((motion.period[-1] - motion.period[0]) / KNOTS))
    inner = np.linspace(motion.period[0], motion.period[-1], pieces + 1)
    knots = np.concatenate([[inner[0]] * 3, inner, [inner[-1]] * 3])

    def design(at: np.ndarray) -> np.ndarray:
        spline = interpolate.BSpline.design_matrix(motion.period[at], knots, 3).toarray()
        turns = [shape(angle[at]) for angle in motion.turning for shape in (np.cos, np.sin)]
        return np.column_stack([spline, *turns])

    is_coast = np.arange(len(samples)) >= len(below)
    matrix = np.column_stack([is_coast, design(samples)])
    scale = float(np.ptp(seen))
    start = np.linalg.lstsq(matrix, seen / scale, rcond=None)[0]
    rough = 1.4826 * float(np.median(np.abs(matrix @ start - seen / scale))) + 1e-9
    found = optimize.least_squares(
        lambda numbers: (matrix @ numbers - seen / scale) / rough,
        start,
        jac=lambda _: matrix / rough,
        loss="soft_l1",
    ).x
    rest = seen - scale * (matrix @ found)
    freedom = len(samples) - np.linalg.matrix_rank(matrix)
    heavier = len(samples) / max(1, freedom)
    parts = [rest[~is_coast], rest[is_coast]]
    error = 1.96 * math.sqrt(heavier * sum(float(np.var(part)) / len(part) for part in parts))
    value = scale * float(found[0])
    scatter = math.sqrt(heavier * sum(float(np.var(part)) for part in parts))
    play = Estimate(value, value - error, value + error, scatter, min(map(len, parts)))
    drift = scale * np.concatenate(
        [
            design(part) @ found[1:]
            for part in np.array_split(np.arange(len(motion.gap)), len(motion.gap) // 20000 + 1)
        ]
    )
    low = float(np.mean(drift))
    return drift - low, low, play


def _contacts(
    motion: Motion, smooth: np.ndarray, drift: np.ndarray, low: float, play: float, edges: np.ndarray
) -> tuple[list[Contact], list[Contact]]:
    """The contacts with the drive and with the coast flank."""
    height, raw = ((values - drift - low) / play for values in (smooth, motion.gap))
    sides = ((height, raw), (1.0 - height, 1.0 - raw))
    found = (
        [_contact(own, exact, at, motion.step) for at in _arrivals(own, edges[0], edges[-1])]
        for own, exact in sides
    )
    drives, coasts = ([contact for contact in some if contact is not None] for some in found)
    return drives, coasts


def _arrivals(height: np.ndarray, first: int, last: int) -> np.ndarray:
    """Samples at which a tooth that has been away comes near a flank."""
    state = np.where(height > AWAY, 1, np.where(height < NEAR, -1, 0))
    decided = np.flatnonzero(state)
    found = decided[1:][(state[decided][1:] == -1) & (state[decided][:-1] == 1)]
    return found[(found >= first) & (found < last)]


def _contact(height: np.ndarray, raw: np.ndarray, at: int, step: float) -> Contact | None:
    """The contact behind an arrival near a flank, where parabolas before and behind meet; None: none."""
    longest = max(LEAST_SAMPLES, int(REBOUND / step))
    stay = height[at : at + 2 * longest]
    floor = float(np.min(stay[: _first(stay > np.minimum.accumulate(stay) + RISE)]))
    turn = at + _first(stay < floor + APPROACH[0])
    way = height[max(0, turn - LONGEST) : turn][::-1] - floor
    begin = turn - _first((way > APPROACH[1]) | (way < np.maximum.accumulate(way) - RISE))
    if turn - begin < LEAST_SAMPLES:
        return None
    fall = np.polynomial.Polynomial.fit((np.arange(begin, turn) - turn) * step, raw[begin:turn], 2)
    entering, slope = float(fall.deriv()((begin - turn) * step)), float(fall.deriv()(0.0))
    touch = (fall(0.0) - floor) / -slope if slope < 0.0 else math.inf
    if not 0.0 <= touch < (turn - begin) * step or -float(fall.deriv()(touch)) < HIT * -entering:
        return None
    start = turn + int((touch + SETTLED) / step) + 1
    rise = height[start : start + longest] - floor
    stop = start + max(LEAST_SAMPLES, _first(rise > APPROACH[1]))
    if stop > len(raw):
        return None
    back = np.polynomial.Polynomial.fit((np.arange(start, stop) - turn) * step, raw[start:stop], 2)
    # The tooth goes straight on from the parabola before to that behind, which meet at the contact.
    closing = float(back.deriv()(touch) - fall.deriv()(touch))
    if closing < HIT * -float(fall.deriv()(touch)):
        return None
    contact = touch + float(fall(touch) - back(touch)) / closing
    contact = min(max(contact, touch - SETTLED), touch + SETTLED)
    return Contact(
        turn + round(contact / step),
        float(back(contact)),
        -float(fall.deriv()(contact)),
        float(back.deriv()(contact)),
    )


def _first(found: np.ndarray) -> int:
    """Place of the first that is true, the length where none is."""
    return int(np.argmax(found)) if found.any() else len(found)


def _accelerations(height: np.ndarray, motion: Motion, edges: np.ndarray) -> np.ndarray:
    """Acceleration [m/s2] of the gear itself in each flight through the middle of the play, by parabolas."""
    inside = (height > FLIGHT[0]) & (height < FLIGHT[1])
    changes = np.flatnonzero(np.diff(inside)) + 1
    found = []
    for begin, end in zip(changes, changes[1:], strict=False):
        crosses = inside[begin] and (height[begin - 1] < 0.5) != (height[end] < 0.5)
        if crosses and end - begin >= LEAST_SAMPLES and edges[0] <= begin < edges[-1]:
            time = (np.arange(begin, end) - 0.5 * (begin + end)) * motion.step
            curve = np.polynomial.Polynomial.fit(time, motion.gear[begin:end] - motion.gear[begin], 2)
            found.append(float(curve.deriv(2)(0.0)))
    return np.array(found)


def _flank(contacts: list[Contact], play: float, periods: int, draw: np.random.Generator) -> Flank:
    if len(contacts) < LEAST_EVENTS:
        return Flank(len(contacts) / periods, None, None, None)
    approach = play * np.array([contact.approach for contact in contacts])
    rebound = play * np.array([contact.rebound for contact in contacts])
    picks = draw.integers(len(contacts), size=(DRAWS, len(contacts)))
    ratios = np.sum(rebound[picks], axis=1) / np.sum(approach[picks], axis=1)
    low, high = map(float, np.quantile(ratios, _tails()))
    restitution = Estimate(
        float(np.sum(rebound) / np.sum(approach)),
        low,
        high,
        float(np.std(rebound / approach)),
        len(contacts),
    )
    return Flank(len(contacts) / periods, _mean(approach, draw), float(np.max(approach)), restitution)


def _mean(values: np.ndarray, draw: np.random.Generator) -> Estimate:
    """Mean of values, its interval by drawing them again."""
    means = np.mean(values[draw.integers(len(values), size=(DRAWS, len(values)))], axis=1)
    low, high = map(float, np.quantile(means, _tails()))
    return Estimate(float(np.mean(values)), low, high, float(np.std(values)), len(values))


def _tails() -> tuple[float, float]:
    return 0.5 * (1.0 - CONFIDENCE), 0.5 * (1.0 + CONFIDENCE)
