"""Spikes, drop-outs and gaps: found by what their neighbours say, told, and replaced on request."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rattle.recordings import time_axis
from rattle.recordings.channels import Channel
from rattle.recordings.faults import RecordingError

# A step from one sample to the next that is so many times the usual one is none of the motion.
ODD_STEP = 12.0
# A drop-out is at most such a share of the recording; what is longer is the recording.
LONGEST_SHARE = 0.2
# How many drop-outs are told one by one.
TOLD = 5


def odd_stretches(values: np.ndarray) -> list[tuple[int, int]]:
    """First and last sample of each spike or drop-out.

    Where a signal steps by more than twelve times the median step (or the largest of its smooth course) and steps
    back, the samples between are odd.
    """
    if len(values) < 8:
        return []
    steps = np.diff(values)
    usual = np.median(np.abs(steps))
    bends = np.abs(np.diff(values, 2))
    floor = max(1.4826 * usual, 1.4826 * float(np.median(bends)), 1e-12 * float(np.max(np.abs(values))))
    # What many samples do is no fault of some: signals of pulses step often.
    limit = ODD_STEP * max(floor, float(np.percentile(np.abs(steps), 90.0)) / 3.0)
    jumps = np.flatnonzero(np.abs(steps) > limit)
    found: list[tuple[int, int]] = []
    longest = max(1, int(LONGEST_SHARE * len(values)))
    place = 0
    while place < len(jumps):
        begin = int(jumps[place])
        end = next((int(j) for j in jumps[place + 1 :] if _returns(values, begin, int(j), limit)), None)
        if end is not None and end - begin <= longest:
            found.append((begin + 1, end))
            place = int(np.searchsorted(jumps, end, side="right"))
        else:
            place += 1
    first, last = (int(jumps[0]), int(jumps[-1])) if len(jumps) else (0, 0)
    if len(jumps) and not any(begin - 1 == first for begin, _ in found) and first < longest // 20 + 1:
        found.insert(0, (0, first))
    ends = [end for _, end in found]
    if len(jumps) and last not in ends and len(values) - 2 - last < longest // 20 + 1:
        found.append((last + 1, len(values) - 1))
    return found


def _returns(values: np.ndarray, begin: int, end: int, limit: float) -> bool:
    """Whether behind `end` the signal goes on where it was at `begin`, as far as its course may have led it."""
    if values[begin + 1] == values[begin]:
        return False
    left = abs(values[begin + 1] - values[begin])
    return (
        abs(values[end + 1] - values[begin]) < max(0.5 * left, 0.0)
        and abs(values[end + 1] - values[end]) > limit
    )


def mend(channel: Channel, *, mend: bool, notes: list[str], trend: np.ndarray | None = None) -> Channel:
    """The channel with spikes and drop-outs as gaps, if that is asked for; they are told either way."""
    finite = np.flatnonzero(np.isfinite(channel.values))
    odd = odd_stretches(channel.values[finite])
    if not odd:
        return channel
    values = channel.values.copy()
    shown = values if trend is None else values + trend
    count = sum(end - begin + 1 for begin, end in odd)
    for begin, end in odd[:TOLD]:
        at = finite[begin : end + 1]
        span = f"{channel.time[at[0]]:.6g} s" + (f" to {channel.time[at[-1]]:.6g} s" if end > begin else "")
        around = [finite[place] for place in (begin - 1, end + 1) if 0 <= place < len(finite)]
        told = " and ".join(f"{shown[place]:.6g}" for place in around)
        notes.append(
            f"'{channel.name}' is {shown[at[0]]:.6g} {channel.unit} at {span}, its neighbours {told}: "
            + ("replaced." if mend else "a spike or drop-out? --mend replaces it.")
        )
    if len(odd) > TOLD:
        notes.append(f"'{channel.name}' has {len(odd)} of these in all, {count} samples.")
    if not mend:
        return channel
    if count > LONGEST_SHARE * len(finite):
        raise RecordingError(
            f"{channel.source}: {count} of {len(finite)} samples of '{channel.name}' are far from their neighbours; "
            "that cannot be mended."
        )
    for begin, end in odd:
        values[finite[begin : end + 1]] = np.nan
    return replace(channel, values=values)


def check_gaps(channel: Channel, *, kept_time: np.ndarray, bridge: float, notes: list[str]) -> None:
    """Tell the gaps of a channel, of which times with a value are left; refuse those longer than `bridge` [s]."""
    finite = np.isin(channel.time, kept_time)
    found = time_axis.gaps(channel.time, finite)
    if not found:
        return
    begin, end = max(found, key=lambda gap: gap[1] - gap[0])
    words = f"from {begin:.6g} to {end:.6g} s"
    if end - begin > bridge:
        raise RecordingError(
            f"{channel.source}: '{channel.name}' has no value {words}; gaps up to {bridge:g} s are bridged (--bridge)."
        )
    notes.append(
        f"'{channel.name}' has {len(found)} gap{'s' if len(found) > 1 else ''}, the longest {words}; bridged."
    )
