"""From time to the angle of a shaft: by an angle channel, pulses of a wheel, or an integrated speed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy import interpolate

from rattle.counts import counted
from rattle.recordings import mending, units
from rattle.recordings.channels import Channel
from rattle.recordings.faults import RecordingError

TURN = 2.0 * np.pi
# A gap of a recording that is bridged unless more is allowed [s].
BRIDGE = 0.01
# Units of what is no tacho.
NO_PULSES = ("N", "N m", "m/s2", "rad", "rad/s", "rad/s2")
Kind = Literal["angle", "tacho", "speed"]
# Degree of the splines through samples.
DEGREE = 5


@dataclass(frozen=True)
class ShaftAngle:
    """The angle of a shaft over time; both ascend strictly."""

    time: np.ndarray  #: [s]
    angle: np.ndarray  #: [rad]
    notes: list[str]  #: sentences for the user
    error: float  #: estimated standard error of an angle [rad]
    marked: bool = False  #: the angle 0 is a mark of the wheel, not where the recording begins

    @property
    def revolutions(self) -> float:
        """What the recording spans [revolutions]."""
        return float(self.angle[-1] - self.angle[0]) / TURN

    @property
    def mean_speed_rpm(self) -> float:
        """Mean speed over all of the recording [1/min]."""
        return 60.0 * self.revolutions / float(self.time[-1] - self.time[0])

    def at(self, time: ArrayLike) -> np.ndarray:
        """Angle at given times.

        Parameters
        ----------
        time
            Times [s].

        Returns
        -------
        angle
            [rad], not a number outside the recording.
        """
        return self._angle_over_time(np.asarray(time, dtype=float), extrapolate=False)

    def times(self, angle: ArrayLike) -> np.ndarray:
        """Times at given angles.

        Parameters
        ----------
        angle
            Angles [rad].

        Returns
        -------
        time
            [s], not a number outside the recording.
        """
        return self._time_over_angle(np.asarray(angle, dtype=float), extrapolate=False)

    def speed(self, angle: ArrayLike) -> np.ndarray:
        """Speed at given angles.

        Parameters
        ----------
        angle
            Angles [rad].

        Returns
        -------
        speed
            [rad/s], not a number outside the recording.
        """
        slope = self._time_over_angle.derivative()
        return 1.0 / slope(np.asarray(angle, dtype=float), extrapolate=False)

    @cached_property
    def _angle_over_time(self) -> interpolate.BSpline:
        return interpolate.make_interp_spline(self.time, self.angle, k=_degree(len(self.time)))

    @cached_property
    def _time_over_angle(self) -> interpolate.BSpline:
        return interpolate.make_interp_spline(self.angle, self.time, k=_degree(len(self.time)))


def shaft_angle(
    channel: Channel,
    *,
    kind: Kind | None = None,
    pulses_per_revolution: int = 1,
    missing_teeth: int = 0,
    bridge: float = BRIDGE,
    mend: bool = False,
) -> ShaftAngle:
    """The angle of a shaft from a channel.

    Parameters
    ----------
    channel
        An angle, a speed or pulses.
    kind
        'angle': deg, rad or rev, rising or wrapped; 'tacho': pulses; 'speed': rpm, rad/s or Hz, integrated.
        None: by the unit of the channel.
    pulses_per_revolution
        Pulses with the missing ones, 60 for a wheel 60-2.
    missing_teeth
        Missing ones, 2 for a wheel 60-2.
    bridge
        Gaps up to this length [s] are bridged, longer ones refused.
    mend
        Whether spikes and drop-outs are taken for gaps.

    Returns
    -------
    shaft
        Its angle with the error of it.

    Raises
    ------
    RecordingError
        The channel gives no angle that rises over a revolution or more.
    """
    kind = kind or kind_of(channel)
    if not channel.has_time and kind != "angle":
        raise RecordingError(
            f"{channel.source} has no column of time; give its sampling rate by --rate, in Hz."
        )
    if kind == "tacho":
        return _from_pulses(channel, pulses_per_revolution, missing_teeth, bridge)
    return (_from_angle if kind == "angle" else _from_speed)(channel, bridge, mend, [])


def kind_of(channel: Channel) -> Kind:
    """What a channel is by its unit: an angle, a speed, else pulses."""
    if units.fits(channel.unit, "rad"):
        return "angle"
    return "speed" if units.fits(channel.unit, "rad/s") else "tacho"


def angles_of(channel: Channel, shaft: ShaftAngle) -> tuple[np.ndarray, np.ndarray]:
    """Angle [rad] and value of each sample that stands within the angle of the shaft and is a number."""
    angle = shaft.at(channel.time)
    known = np.isfinite(angle) & np.isfinite(channel.values)
    if np.sum(known) < 4:
        raise RecordingError(
            f"'{channel.name}' and the angle of the shaft have {counted(np.sum(known), 'sample')} of the "
            "same time; they are of different recordings, or of different clocks."
        )
    angle, values = angle[known], channel.values[known]
    if not np.all(np.diff(angle) > 0.0):
        at = channel.time[known][int(np.argmin(np.diff(angle)))]
        raise RecordingError(
            f"{channel.source}: the angle of the shaft does not rise at {at:.6g} s; its tacho or angle "
            "jitters by more than a sample."
        )
    return angle, values


def resample_on_angle(
    channel: Channel, shaft: ShaftAngle, samples_per_revolution: int
) -> tuple[np.ndarray, np.ndarray, float]:
    """The channel at equal angles.

    A spline of degree 5 runs through the samples over their angle, so nothing is filtered: take at least as
    many samples a revolution as the recording has.

    Parameters
    ----------
    channel
        What is resampled.
    shaft
        The angle over time.
    samples_per_revolution
        Samples of a revolution.

    Returns
    -------
    angle, values, error
        Angles [rad], multiples of their step; the channel there, in its unit; rms of the error of the
        interpolation over that of what oscillates [-].

    Raises
    ------
    RecordingError
        Channel and shaft do not go together.
    """
    angle, values = angles_of(channel, shaft)
    step = TURN / samples_per_revolution
    first, last = np.ceil(angle[0] / step - 1e-9), np.floor(angle[-1] / step + 1e-9)
    even = step * np.arange(first, last + 1.0)
    spline = interpolate.make_interp_spline(angle, values, k=_degree(len(angle)))
    return even, spline(np.clip(even, angle[0], angle[-1])), interpolation_error(angle, values)


def interpolation_error(angle: np.ndarray, values: np.ndarray) -> float:
    """Rms error of a spline through samples over the rms of what oscillates of them.

    It is that of the spline through every second sample at those between, over 32: that is what twice the
    samples gain of smooth signals. Noise, which no spline follows, is seen as it is.
    """
    spread = float(np.std(values))
    if len(values) < 24 or spread == 0.0:
        return 0.0
    coarse = interpolate.make_interp_spline(angle[::2], values[::2], k=_degree(len(values[::2])))
    between = slice(9, len(values) - 8 - len(values) % 2, 2)
    return float(np.sqrt(np.mean((coarse(angle[between]) - values[between]) ** 2))) / spread / 2.0**DEGREE


def _degree(count: int) -> int:
    """An odd degree for so many points."""
    return max(1, min(DEGREE, count - 1 - (count % 2)))


def _checked(shaft: ShaftAngle, channel: Channel) -> ShaftAngle:
    if not np.all(np.diff(shaft.angle) > 0.0):
        at = shaft.time[int(np.argmin(np.diff(shaft.angle)))]
        raise RecordingError(
            f"{channel.source}: the angle from '{channel.name}' does not rise at {at:.6g} s; "
            "--mend replaces spikes and drop-outs."
        )
    if shaft.revolutions < 1.0:
        raise RecordingError(
            f"{channel.source}: the recording spans {shaft.revolutions:.3g} of a revolution by "
            f"'{channel.name}'; "
            "it takes at least one."
        )
    return shaft


def _from_angle(channel: Channel, bridge: float, mend: bool, notes: list[str]) -> ShaftAngle:
    finite = np.isfinite(channel.values)
    time, angle = channel.time[finite], channel.within("rad")[finite]
    if len(angle) < 4 or np.ptp(angle) == 0.0:
        raise RecordingError(
            f"{channel.source}: '{channel.name}' has {counted(len(angle), 'sample')}, all at {angle[:1]} "
            "rad; a shaft that turns has an angle that changes."
        )
    if np.median(np.sign(np.diff(angle))) < 0.0:
        notes.append(f"'{channel.name}' falls: the shaft is taken to turn the other way.")
        angle = -angle
    angle = _unwrapped(channel, time, angle, notes)
    slope = (angle[-1] - angle[0]) / (time[-1] - time[0])
    trend = angle[0] + slope * (time - time[0])
    rest = Channel(channel.name, "rad", time, angle - trend, channel.source, channel.has_time)
    # Of an angle that stands for some samples, as counted pulses do, the first of each stand is known.
    stands = np.mean(np.diff(angle) == 0.0) > 0.2
    if not stands:
        rest = mending.mended(rest, mend=mend, notes=notes, trend=trend)
        if channel.has_time:
            rest = mending.bridged(rest, limit=bridge, notes=notes)
        kept = np.isfinite(rest.values)
        time = rest.time[kept]
        angle = rest.values[kept] + angle[0] + slope * (time - finite_time(channel))
    else:
        rises = np.concatenate(([True], np.diff(np.maximum.accumulate(angle)) > 0.0))
        time, angle = time[rises], angle[rises]
        notes.append(
            f"'{channel.name}' is known in steps of {np.degrees(np.median(np.diff(angle))):.3g} deg."
        )
    if np.any(np.diff(angle) <= 0.0):
        at = int(np.argmax(np.diff(angle) <= 0.0))
        where = f"at {time[at + 1]:.6g} s" if channel.has_time else f"at sample {at + 2}"
        raise RecordingError(
            f"{channel.source}: the angle of '{channel.name}' goes back {where}, from "
            f"{np.degrees(angle[at]):.6g} to {np.degrees(angle[at + 1]):.6g} deg; --mend replaces spikes and "
            "drop-outs."
        )
    error = np.median(np.diff(angle)) / np.sqrt(12.0) if stands else _roughness(time, angle)
    return _checked(ShaftAngle(time, angle, notes, float(error)), channel)


def finite_time(channel: Channel) -> float:
    """Time of the first sample that is a number [s]."""
    return float(channel.time[np.isfinite(channel.values)][0])


def _unwrapped(channel: Channel, time: np.ndarray, angle: np.ndarray, notes: list[str]) -> np.ndarray:
    """An angle that rises on where it falls by a whole number of turns."""
    steps = np.diff(angle)
    back = -steps[steps < -0.25 * TURN]
    if not back.size:
        return angle
    period = TURN * max(1.0, round(float(np.median(back)) / TURN))
    if np.ptp(angle) > 1.01 * period:
        return angle
    notes.append(f"'{channel.name}' wraps at {np.degrees(period):.0f} deg.")
    spans = np.diff(time)
    expected = float(np.median(steps / spans)) * spans
    turns = np.round((expected - steps) / period)
    return angle + period * np.concatenate(([0.0], np.cumsum(turns)))


def _from_speed(channel: Channel, bridge: float, mend: bool, notes: list[str]) -> ShaftAngle:
    own = Channel(channel.name, channel.unit, channel.time, channel.values, channel.source)
    own = mending.mended(own, mend=mend, notes=notes)
    own = mending.bridged(own, limit=bridge, notes=notes)
    time, values = own.time, own.within("rad/s")
    if np.mean(values) < 0.0:
        notes.append(f"'{channel.name}' is negative: the shaft is taken to turn the other way.")
        values = -values
    if not np.all(values > 0.0):
        at = int(np.argmin(values))
        raise RecordingError(
            f"{channel.source}: '{channel.name}' is {own.values[at]:.4g} {units.shown(channel.unit)} at "
            f"{time[at]:.6g} s; an "
            "angle needs a speed that keeps its sign; cut the recording, or let --mend replace drop-outs."
        )
    spline = interpolate.make_interp_spline(time, values, k=_degree(len(time)))
    angle = spline.antiderivative()(time)
    angle -= angle[0]
    coarse = interpolate.make_interp_spline(
        time[::2], values[::2], k=_degree(len(time[::2]))
    ).antiderivative()
    error = float(np.std(coarse(time[::2]) - coarse(time[0]) - angle[::2])) / 8.0
    notes.append(f"the angle is the integral of '{channel.name}'.")
    return _checked(ShaftAngle(time, angle, notes, error), channel)


def _from_pulses(channel: Channel, teeth: int, missing: int, bridge: float) -> ShaftAngle:
    """Rising edges of a wheel; drop-outs are spans of several teeth where the wheel has no gap."""
    if not 0 <= missing < teeth:
        raise RecordingError(f"a wheel of {teeth} teeth cannot miss {missing}.")
    for unit in NO_PULSES:
        if channel.unit and units.fits(channel.unit, unit):
            raise RecordingError(
                f"{channel.source}: '{channel.name}' is in {channel.unit}, so it is not a tacho; pulses are "
                "in V or have no unit."
            )
    notes: list[str] = []
    edges = rising_edges(channel)
    if len(edges) < max(4, teeth - missing):
        raise RecordingError(
            f"{channel.source}: '{channel.name}' has {counted(len(edges), 'pulse')}, fewer than a "
            f"revolution of {teeth}{f'-{missing}' if missing else ''}; is it the tacho?"
        )
    edges = _without_extra(edges, channel, notes)
    counts = _teeth_passed(edges, teeth - missing)
    place = np.concatenate(([0], np.cumsum(counts)))
    marked = False
    dropped = np.flatnonzero(counts > 1)
    if missing:
        gap = missing + 1
        behind = place[1:][counts == gap] % teeth
        if not behind.size:
            raise RecordingError(
                f"{channel.source}: '{channel.name}' shows no gap of {counted(missing, 'tooth', 'teeth')} in "
                f"{len(edges)} pulses; check --pulses and --missing."
            )
        mark = int(np.bincount(behind, minlength=teeth).argmax())
        share = np.sum(behind == mark) / max(1.0, place[-1] / teeth)
        if share < 0.5:
            raise RecordingError(
                f"{channel.source}: the gaps of '{channel.name}' do not come once in {teeth} teeth; "
                "check --pulses and --missing."
            )
        place = _resynchronised(place - mark, counts, teeth, missing, notes)
        marked = True
        dropped = dropped[(place[1:][dropped] % teeth != 0) | (counts[dropped] != gap)]
    _tell_dropped(channel, edges, counts, dropped, bridge, notes)
    angle = place * (TURN / teeth)
    error = _roughness(edges, angle)
    words = f"{teeth}-{missing}" if missing else f"{teeth}"
    notes.append(
        f"'{channel.name}' has {len(edges)} pulses of a wheel with {words} a revolution; they jitter by "
        f"{np.degrees(error):.2g} deg (standard deviation)."
    )
    if missing:
        notes.append(f"angle 0 is the tooth behind the gap of '{channel.name}'.")
    if teeth - missing < 8:
        notes.append(
            f"with {teeth} pulse{'s' if teeth > 1 else ''} a revolution what the speed does in between is "
            f"not seen: the angle follows orders below {0.5 * teeth:g} alone."
        )
    return _checked(ShaftAngle(edges, angle, notes, error, marked), channel)


def rising_edges(channel: Channel) -> np.ndarray:
    """Times [s] at which pulses rise through the middle of their range, interpolated between samples.

    A pulse counts only if the signal has been below a third of the range before (hysteresis).
    """
    finite = np.isfinite(channel.values)
    time, values = channel.time[finite], channel.values[finite]
    low, high = np.percentile(values, (0.5, 99.5))
    if high - low < 0.2 * (values.max() - values.min()) or high == low:
        low, high = float(values.min()), float(values.max())
    if high == low:
        raise RecordingError(
            f"{channel.source}: '{channel.name}' is constant at {low:.4g}; it has no pulses."
        )
    middle, margin = 0.5 * (low + high), (high - low) / 6.0
    state = np.where(values > middle + margin, 1, np.where(values < middle - margin, -1, 0))
    decided = np.flatnonzero(state)
    risen = decided[1:][(state[decided][1:] == 1) & (state[decided][:-1] == -1)]
    before = decided[:-1][(state[decided][1:] == 1) & (state[decided][:-1] == -1)]
    edges = np.empty(len(risen))
    for place, (last, first) in enumerate(zip(before, risen, strict=True)):
        crossing = last + int(np.argmax(values[last : first + 1] >= middle))
        lower, upper = values[crossing - 1], values[crossing]
        share = (middle - lower) / (upper - lower)
        edges[place] = time[crossing - 1] + share * (time[crossing] - time[crossing - 1])
    return edges


def _local(intervals: np.ndarray, window: int) -> np.ndarray:
    """The median of the intervals around each: a span of a tooth at that speed."""
    from scipy.ndimage import median_filter

    return median_filter(intervals, size=max(5, min(window, len(intervals)) | 1), mode="nearest")


def _without_extra(edges: np.ndarray, channel: Channel, notes: list[str]) -> np.ndarray:
    """Edges without those that come between two others a tooth apart, as bouncing ones do."""
    intervals = np.diff(edges)
    usual = _local(intervals, 15)
    extra: list[int] = []
    for place in np.flatnonzero((intervals[:-1] < 0.75 * usual[:-1]) | (intervals[1:] < 0.75 * usual[1:])):
        both = intervals[place] + intervals[place + 1]
        if both < 1.3 * usual[place] and place not in extra:
            extra.append(int(place) + 1)
    if extra:
        if len(extra) > 0.1 * len(edges):
            raise RecordingError(
                f"{channel.source}: {len(extra)} of {len(edges)} pulses of '{channel.name}' come too soon "
                "behind another; it is not a tacho, or noise crosses its middle."
            )
        several = f"{len(extra)} pulses" if len(extra) > 1 else "a pulse"
        notes.append(
            f"{several} of '{channel.name}' too soon behind another left out, first at "
            f"{edges[extra[0]]:.6g} s."
        )
    return np.delete(edges, extra)


def _resynchronised(
    place: np.ndarray, counts: np.ndarray, teeth: int, missing: int, notes: list[str]
) -> np.ndarray:
    """Teeth passed, set right at gaps of the wheel that come a tooth or two from where they should.

    A gap that comes farther away is a drop-out of as many teeth.
    """
    shift = np.zeros(len(place))
    for at in np.flatnonzero(counts == missing + 1) + 1:
        off = (place[at] + shift[at] + teeth / 2) % teeth - teeth / 2
        if 0.0 < abs(off) <= 2.0:
            shift[at:] -= off
    if np.any(shift != 0.0):
        count = np.count_nonzero(np.diff(shift))
        notes.append(
            f"pulses that were lost or too many are set right at {count} gap{'s' if count > 1 else ''}."
        )
    return place + shift


def _teeth_passed(edges: np.ndarray, teeth: int) -> np.ndarray:
    """How many teeth pass from each edge to the next one."""
    intervals = np.diff(edges)
    return np.maximum(1, np.round(intervals / _local(intervals, min(15, max(5, teeth // 2))))).astype(int)


def _tell_dropped(
    channel: Channel,
    edges: np.ndarray,
    counts: np.ndarray,
    dropped: np.ndarray,
    bridge: float,
    notes: list[str],
) -> None:
    if not dropped.size:
        return
    lengths = np.diff(edges)[dropped]
    longest = int(np.argmax(lengths))
    where = f"at {edges[dropped[longest]]:.6g} s, {lengths[longest]:.3g} s long"
    if lengths[longest] > bridge:
        raise RecordingError(
            f"{channel.source}: '{channel.name}' drops out {where}; gaps up to {bridge:g} s are bridged "
            f"(--bridge)."
        )
    if dropped.size > 0.2 * len(counts):
        raise RecordingError(
            f"{channel.source}: {dropped.size} of {len(counts)} pulses of '{channel.name}' do not follow "
            "each other evenly; check --pulses and --missing."
        )
    notes.append(
        f"'{channel.name}' lacks {counted(np.sum(counts[dropped] - 1), 'pulse')} in "
        f"{counted(dropped.size, 'drop-out')}, the longest {where}; bridged."
    )


def _roughness(time: np.ndarray, angle: np.ndarray) -> float:
    """Standard deviation [rad] of what a spline through every second point misses, as jitter is."""
    if len(time) < 24:
        return 0.0
    spline = interpolate.make_interp_spline(angle[::2], time[::2], k=3)
    inner = slice(9, len(angle) - 8 - len(angle) % 2, 2)
    off = spline(angle[inner]) - time[inner]
    speed = (angle[-1] - angle[0]) / (time[-1] - time[0])
    # The spline has 0.7 of the variance of its points between them.
    return 1.4826 * float(np.median(np.abs(off))) * speed / np.sqrt(1.7)
