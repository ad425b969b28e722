"""Spikes, drop-outs and gaps: found by what their neighbours say, reported, replaced on request, bridged."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rattle.counts import counted
from rattle.recordings import time_axis, units
from rattle.recordings.channels import Channel
from rattle.recordings.faults import RecordingError

# A step from one sample to the next that is so many times the usual one is none of the motion.
ODD_STEP = 12.0
# What is odd is at most such a share of the recording; what is more is the recording.
LONGEST_SHARE = 0.2
# How many drop-outs are reported one by one.
REPORTED = 5
# A gap is filled by a polynomial of this degree through what is around it.
DEGREE = 5


def odd_stretches(values: np.ndarray, time: np.ndarray | None = None) -> list[tuple[int, int]]:
    """First and last place of each spike or drop-out; a step over a longer time may be as much larger.

    A signal steps away by more than twelve times the median step (of smooth signals; of others a third of the
    step that one in ten exceeds) and steps back to where it was; or it steps close to an end.
    """
    if len(values) < 8:
        return []
    steps = np.diff(values)
    if time is not None:
        spans = np.diff(time)
        steps = steps / np.maximum(1.0, spans / max(float(np.median(spans)), np.finfo(float).tiny))
    size = np.abs(steps)
    usual = max(float(np.median(size)), float(np.median(np.abs(np.diff(steps)))), _quantum(values))
    limit = ODD_STEP * max(1.4826 * usual, float(np.percentile(size, 90.0)) / 3.0)
    limit = max(limit, 1e-9 * float(np.max(np.abs(values))))
    jumps = np.flatnonzero(size > limit)
    longest = max(1, int(LONGEST_SHARE * len(values)))
    found: list[tuple[int, int]] = []
    place = 0
    while place < len(jumps):
        begin = int(jumps[place])
        left = values[begin + 1] - values[begin]
        # Behind the end the signal goes on where it was, as far as its course may have led it.
        back = np.abs(values[jumps[place + 1 :] + 1] - values[begin]) < 0.5 * abs(left)
        away = np.abs(jumps[place + 1 :] - begin) <= longest
        returns = np.flatnonzero(back & away)
        if returns.size:
            end = int(jumps[place + 1 + returns[0]])
            # Impacts ring on behind their first steps; behind a drop-out all is as before.
            beside = np.concatenate((size[max(0, begin - 3) : begin], size[end + 1 : end + 4]))
            if np.all(beside < 0.5 * limit):
                found.append((begin + 1, end))
            place += 2 + int(returns[0])
        elif begin < min(longest, 20) and not found:
            found.append((0, begin))
            place += 1
        elif len(values) - 2 - begin < min(longest, 20):
            found.append((begin + 1, len(values) - 1))
            break
        else:
            place += 1
    return found


def _quantum(values: np.ndarray) -> float:
    """The least step of a signal that is known in steps, as those of few bits are."""
    size = np.abs(np.diff(values[:20000]))
    size = size[size > 0.0]
    return float(size.min()) if size.size else 0.0


def mended(channel: Channel, *, mend: bool, notes: list[str], trend: np.ndarray | None = None) -> Channel:
    """The channel with spikes and drop-outs as gaps, if `mend`; they are reported either way.

    `trend` is what was taken off the values, for the words alone.
    """
    finite = np.flatnonzero(np.isfinite(channel.values))
    odd = odd_stretches(channel.values[finite], channel.time[finite] if channel.has_time else None)
    if not odd:
        return channel
    shown = channel.values if trend is None else channel.values + trend
    count = sum(end - begin + 1 for begin, end in odd)
    for begin, end in odd[:REPORTED]:
        at = finite[begin : end + 1]
        span = f"{channel.time[at[0]]:.6g} s" if channel.has_time else f"sample {at[0] + 1}"
        if end > begin:
            last = f"{channel.time[at[-1]]:.6g} s" if channel.has_time else f"{at[-1] + 1}"
            span += f" to {last} ({end - begin + 1} samples)"
        around = [finite[place] for place in (begin - 1, end + 1) if 0 <= place < len(finite)]
        words = " and ".join(f"{shown[place]:.6g}" for place in around)
        value = f"{shown[at[0]]:.6g} {units.shown(channel.unit)}".rstrip()
        sentence = f"'{channel.name}' is {value} at {span}, its neighbours {words}: "
        # Reported as a warning where it stays as it is.
        notes.append(
            f"{sentence}replaced." if mend else f"warning: {sentence}a spike or drop-out; --mend replaces it."
        )
    if len(odd) > REPORTED:
        notes.append(f"'{channel.name}' has {len(odd)} of these in all, {count} samples.")
    if not mend:
        return channel
    if count > LONGEST_SHARE * len(finite):
        raise RecordingError(
            f"{channel.source}: {count} of {len(finite)} samples of '{channel.name}' are far from their "
            "neighbours; that cannot be mended."
        )
    values = channel.values.copy()
    for begin, end in odd:
        values[finite[begin : end + 1]] = np.nan
    return replace(channel, values=values)


def bridged(channel: Channel, *, limit: float, notes: list[str]) -> Channel:
    """The channel without gaps: those up to `limit` [s] are filled, longer ones refused; ends are cut.

    A gap is filled by a polynomial of degree 5 through what stands on both sides, as long each as the gap.
    """
    finite = np.flatnonzero(np.isfinite(channel.values))
    if finite.size < 4:
        raise RecordingError(
            f"{channel.source}: '{channel.name}' has "
            f"{counted(finite.size, 'sample that is a number', 'samples that are numbers')}; at least four "
            "are needed."
        )
    inside = slice(finite[0], finite[-1] + 1)
    time, values = channel.time[inside], channel.values[inside]
    found = time_axis.gaps(time, np.isfinite(values))
    if not found:
        kept = np.isfinite(values)
        return replace(channel, time=time[kept], values=values[kept])
    begin, end = max(found, key=lambda gap: gap[1] - gap[0])
    words = f"from {begin:.6g} to {end:.6g} s"
    if end - begin > limit:
        raise RecordingError(
            f"{channel.source}: '{channel.name}' has no value {words}; gaps up to {limit:g} s are bridged, "
            f"longer ones only by --bridge {_rounded_up(end - begin):g}."
        )
    kept = np.isfinite(values)
    time, values = time[kept], values[kept]
    step = float(np.median(np.diff(time)))
    parts_of_time, parts = [time], [values]
    for begin, end in found:
        inner = np.linspace(begin, end, max(2, round((end - begin) / step)) + 1)[1:-1]
        parts_of_time.append(inner)
        parts.append(_filled(time, values, begin, end, inner))
    order = np.argsort(np.concatenate(parts_of_time), kind="stable")
    lines = f"{len(found)} gap{'s' if len(found) > 1 else ''}"
    notes.append(f"'{channel.name}' has {lines}, the longest {words}: bridged.")
    return replace(channel, time=np.concatenate(parts_of_time)[order], values=np.concatenate(parts)[order])


def _filled(time: np.ndarray, values: np.ndarray, begin: float, end: float, inner: np.ndarray) -> np.ndarray:
    """Values at the times within a gap from `begin` to `end`."""
    first, last = np.searchsorted(time, begin), np.searchsorted(time, end)
    side = max(len(inner), 2 * DEGREE)
    near = slice(max(0, first + 1 - side), last + side)
    middle, half = 0.5 * (begin + end), 0.5 * (time[near][-1] - time[near][0])
    degree = min(DEGREE, len(time[near]) - 1)
    weights = np.polynomial.legendre.legfit((time[near] - middle) / half, values[near], degree)
    return np.polynomial.legendre.legval((inner - middle) / half, weights)


def _rounded_up(number: float) -> float:
    """A number of two digits that is not below."""
    digit = 10.0 ** (np.floor(np.log10(number)) - 1.0)
    return float(np.ceil(number / digit) * digit)
