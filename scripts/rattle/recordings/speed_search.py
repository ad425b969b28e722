"""The speed of a recording without tacho or angle: that at which its cycles are most alike."""

from __future__ import annotations

import numpy as np
from scipy import optimize

from rattle.recordings.angle import TURN, ShaftAngle
from rattle.recordings.channels import Channel
from rattle.recordings.faults import RecordingError

# How far the speed may be from what is given, and how many harmonics of the cycle are looked at.
REACH = 0.1
HARMONICS = 24
# Of the power of what oscillates, the share that a speed must gather.
LEAST_COHERENCE = 0.2


def steady_angle(channel: Channel, near_rpm: float, cycle_revolutions: int) -> ShaftAngle:
    """The angle at the constant speed, within a tenth of `near_rpm`, that gathers most power in its orders.

    The orders are those of the cycle, from the first to the twenty-fourth harmonic; the power is that of the
    recording under Hann's window. The speed is as sure as the recording is long.
    """
    if not channel.has_time:
        raise RecordingError(
            f"{channel.source} has no column of time; give its sampling rate by --rate, in Hz."
        )
    time = channel.time - channel.time[0]
    values = channel.values - np.mean(channel.values)
    span = float(time[-1])
    base = near_rpm / 60.0 / cycle_revolutions
    if span * base < 3.0:
        raise RecordingError(
            f"{channel.source}: {span:.4g} s are {span * base:.2g} cycles at {near_rpm:g} 1/min; to find "
            "the speed from the signal itself takes at least three. Record a tacho."
        )
    usual = float(np.median(np.diff(time)))
    even = np.arange(0.0, span, usual)
    weighted = np.interp(even, time, values) * np.hanning(len(even))
    count = max(1, min(HARMONICS, int(0.4 / (usual * base))))
    numbers = np.arange(1, count + 1)
    padded = 8 * (1 << (len(even) - 1).bit_length())
    power = np.abs(np.fft.rfft(weighted, padded)) ** 2
    bins = np.arange(len(power))
    step = 1.0 / (padded * usual)
    candidates = np.arange((1.0 - REACH) * base, (1.0 + REACH) * base, 0.25 / span / count)
    gathered = np.zeros(len(candidates))
    for number in numbers:
        gathered += np.interp(number * candidates / step, bins, power)
    # Of speeds that gather as much, as those of few orders do, the one nearest to what is given.
    alike = candidates[gathered > 0.97 * gathered.max()]
    nearest = alike[int(np.argmin(np.abs(alike - base)))]
    near = np.abs(candidates - nearest) < 1.0 / span / count
    best = candidates[near][int(np.argmax(gathered[near]))]

    def lack(frequency: float) -> float:
        turns = np.exp(-1j * TURN * frequency * even)
        total, running = 0.0, np.ones(len(even), dtype=complex)
        for _ in numbers:
            running = running * turns
            total += abs(np.dot(weighted, running)) ** 2
        return -total

    reach = 0.5 / span / count
    found = optimize.minimize_scalar(
        lack, bounds=(best - reach, best + reach), method="bounded", options={"xatol": 1e-9 * best}
    )
    frequency = float(found.x)
    # A line of Hann's window holds 2/3 of the sum of its squares times the samples, on either side of zero.
    share = 2.0 * -found.fun / (np.sum(weighted**2) * len(even)) * 1.5
    if share < LEAST_COHERENCE or not (1.0 - REACH) * base < frequency < (1.0 + REACH) * base:
        raise RecordingError(
            f"{channel.source}: within a tenth of {near_rpm:g} 1/min no speed gathers the power of "
            f"'{channel.name}' in "
            f"orders ({100.0 * share:.2g} % of it at best); give --speed-near nearer, or record a tacho."
        )
    speed = 60.0 * frequency * cycle_revolutions
    notes = [
        f"the speed is measured from '{channel.name}': {speed:.6g} 1/min gathers "
        f"{100.0 * min(share, 1.0):.3g} % of its "
        "power in orders; it is taken as constant."
    ]
    angle = TURN * speed / 60.0 * (channel.time - channel.time[0])
    return ShaftAngle(channel.time, angle, notes, 0.0)
