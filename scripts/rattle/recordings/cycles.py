"""The mean cycle of a steady recording: whole cycles on equal angles, their mean, orders and scatter."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import interpolate

from rattle.counts import counted
from rattle.recordings import mending, units
from rattle.recordings.angle import BRIDGE, DEGREE, TURN, ShaftAngle, angles_of, interpolation_error
from rattle.recordings.channels import Channel
from rattle.recordings.faults import RecordingError

SAMPLES = 360
# Samples of a cycle that rattle takes at least.
LEAST_SAMPLES = 4
# Scatter of the cycles beyond which the user is warned, and drift of the speed that is named as its cause.
WIDE_SCATTER = 0.1
DRIFT = 0.01
# Orders that rattle takes of a cycle at most, and the share of the largest that one must have.
MOST_ORDERS = 128
LEAST_SHARE = 1e-3
# An order stands out of the scatter where it is so many times its standard error.
SIGNIFICANT = 4.0
# By how much harmonics by least squares may grow errors of the times; for all cycles, and for one with
# drop-outs.
GROWTH, MOST_GROWTH = 30.0, 100.0


@dataclass(frozen=True)
class MeanCycle:
    """The mean of whole cycles at equal angles, and its harmonics: a cos(order angle + phase)."""

    name: str  #: of the channel
    unit: str  #: of the channel
    angle: np.ndarray  #: equal angles of one cycle [rad], the first is 0
    values: np.ndarray  #: the mean there
    cycle_revolutions: int  #: revolutions of a cycle
    cycles: int  #: whole cycles in the mean
    left_out: float  #: what is in no whole cycle [revolutions]
    mean: float  #: over the cycle
    orders: np.ndarray  #: of the revolution
    amplitudes: np.ndarray  #: of the orders
    phases: np.ndarray  #: of the orders [rad]
    amplitude_errors: np.ndarray  #: standard errors of the mean, not a number of a single cycle
    phase_errors: np.ndarray  #: likewise [rad]
    scatter: float  #: rms by which cycles differ from their mean over the rms of what oscillates of it
    speed_rpm: float  #: mean speed [1/min]
    speed_range: tuple[float, float]  #: of the mean speeds of the cycles [1/min]
    resampling_error: float  #: rms error of the interpolation over that of what oscillates
    kept: int  #: how many harmonics stand out of the scatter
    notes: list[str]  #: sentences for the user
    warnings: list[str]  #: sentences for the user


def mean_cycle(
    channel: Channel | None,
    shaft: ShaftAngle,
    *,
    cycle_revolutions: int = 2,
    samples_per_revolution: int = SAMPLES,
    derivative: bool = False,
    mend: bool = False,
    bridge: float = BRIDGE,
) -> MeanCycle:
    """Average the whole cycles of a steady channel.

    The channel is resampled onto equal angles, at least as dense as it was recorded, by a spline of degree
    5; after the mean is taken, orders that `samples_per_revolution` cannot hold are cut off in its
    spectrum, so none is folded back.

    Parameters
    ----------
    channel
        What is averaged; None: the speed of the shaft itself [1/min].
    shaft
        The angle over time.
    cycle_revolutions
        Revolutions of a cycle, 2 of a four-stroke engine.
    samples_per_revolution
        Samples of the mean in a revolution.
    derivative
        Whether the signal is a speed, of which rattle takes the derivative, so that its orders count by
        their accelerations.
    mend
        Whether spikes and drop-outs are taken for gaps.
    bridge
        Gaps up to this length [s] are bridged, longer ones refused.

    Returns
    -------
    cycle
        The mean with the errors of its harmonics.

    Raises
    ------
    RecordingError
        The channel is constant, too short, too coarse or has gaps.
    """
    length = TURN * cycle_revolutions
    if channel is None:
        record = _speed_of_shaft(shaft, length, samples_per_revolution)
        derivative = True
    else:
        record = _samples_of_channel(channel, shaft, length, samples_per_revolution, mend, bridge)
    rows, slow = _without_drift(record.rows)
    spectra = np.fft.rfft(rows, axis=1) / rows.shape[1]
    samples = samples_per_revolution * cycle_revolutions
    # No more orders than the output holds, or the recording.
    highest = min(samples // 2 - 1, record.highest, rows.shape[1] // 2 - 1)
    if samples < 2 * LEAST_SAMPLES:
        raise RecordingError(f"{samples} samples a cycle are too few to be written: --samples.")
    if highest < 1:
        raise RecordingError(
            f"{record.name} has fewer than three samples a cycle, so no order of it is known."
        )
    spectrum = np.zeros(samples // 2 + 1, dtype=complex)
    spectrum[: highest + 1] = spectra.mean(axis=0)[: highest + 1]
    oscillating = spectrum[1 : highest + 1]
    amplitudes = 2.0 * np.abs(oscillating)
    along, across = _standard_errors(spectra[:, 1 : highest + 1])
    edges = np.clip(record.starts[:, None] + np.array([0.0, length]), *shaft.angle[[0, -1]])
    times = shaft.times(edges)
    speeds = 60.0 / TURN * np.diff(edges, axis=1)[:, 0] / np.diff(times, axis=1)[:, 0]
    cycle = MeanCycle(
        name=record.name,
        unit=record.unit,
        angle=np.arange(samples) * length / samples,
        values=np.fft.irfft(spectrum * samples, samples),
        cycle_revolutions=cycle_revolutions,
        cycles=len(rows),
        left_out=record.left_out,
        mean=float(spectrum[0].real),
        orders=np.arange(1, highest + 1) / cycle_revolutions,
        amplitudes=amplitudes,
        phases=np.angle(oscillating),
        amplitude_errors=along,
        phase_errors=across / np.maximum(amplitudes, np.finfo(float).tiny),
        scatter=_scatter(rows),
        speed_rpm=float(60.0 / TURN * np.ptp(edges) / np.ptp(times)),
        speed_range=(float(speeds.min()), float(speeds.max())),
        resampling_error=record.error,
        kept=_kept(amplitudes, along, derivative),
        notes=record.notes,
        warnings=[],
    )
    return replace(
        cycle,
        notes=cycle.notes + _notes(cycle, record, slow),
        warnings=_warnings(cycle, record, rows, speeds),
    )


@dataclass(frozen=True)
class _Record:
    """Whole cycles on equal angles, a row for each, and what is known of them."""

    name: str
    unit: str
    rows: np.ndarray
    starts: np.ndarray
    left_out: float
    highest: int
    error: float
    method: str
    notes: list[str]


def _samples_of_channel(
    channel: Channel, shaft: ShaftAngle, length: float, wanted: int, mend: bool, bridge: float
) -> _Record:
    """The cycles of a channel by a spline through its samples over the angle."""
    notes: list[str] = []
    channel = mending.mended(channel, mend=mend, notes=notes)
    if channel.has_time:
        channel = mending.bridged(channel, limit=bridge, notes=notes)
    angle, values = angles_of(channel, shaft)
    if np.ptp(values) <= 1e-12 * np.max(np.abs(values)):
        raise RecordingError(
            f"{channel.source}: '{channel.name}' is constant at {values[0]:.6g}; nothing oscillates."
        )
    per_cycle = length / float(np.median(np.diff(angle)))
    if per_cycle < LEAST_SAMPLES:
        raise RecordingError(
            f"{channel.source}: '{channel.name}' has {per_cycle:.2g} samples a cycle of "
            f"{counted(round(length / TURN), 'revolution')}; "
            f"it takes {LEAST_SAMPLES}."
        )
    begin, cycles, closed_angle, closed_values = _whole_cycles(channel, shaft, angle, values, length)
    samples = round(length / TURN) * _dense(angle, wanted)
    even = begin + np.arange(cycles * samples) * (length / samples)
    degree = min(DEGREE, 2 * ((len(closed_angle) - 2) // 2) + 1)
    spline = interpolate.make_interp_spline(closed_angle, closed_values, k=degree)
    rows = spline(np.clip(even, *closed_angle[[0, -1]])).reshape(cycles, samples)
    return _Record(
        name=channel.name,
        unit=channel.unit,
        rows=rows,
        starts=begin + length * np.arange(cycles),
        left_out=max(0.0, (angle[-1] - angle[0] - cycles * length) / TURN),
        highest=int(0.5 * length / np.max(np.diff(angle))),
        error=interpolation_error(angle, values),
        method=f"a spline of degree {DEGREE} through the samples",
        notes=notes,
    )


def _speed_of_shaft(shaft: ShaftAngle, length: float, wanted: int) -> _Record:
    """The cycles of the speed of a shaft [1/min], from harmonics of the times of its angles.

    In each cycle the times, less their slow course, are a straight line and harmonics by least squares:
    also of a wheel with missing teeth, where a spline would have to guess. There are as many harmonics as
    the gaps between the angles allow.
    """
    begin, cycles = _first_cycle(shaft, shaft.angle, length)
    if cycles < 1:
        raise RecordingError(_too_short("the angle of the shaft", shaft.angle, length))
    slow = np.polynomial.Polynomial.fit(shaft.angle, shaft.time, 3 if cycles > 2 else 1)
    rest = shaft.time - slow(shaft.angle)
    ends = np.array([-1e-9, length + 1e-9])
    windows = [shaft.angle.searchsorted(begin + number * length + ends) for number in range(cycles)]
    fullest = slice(*max(windows, key=lambda window: window[1] - window[0]))
    count = fullest.stop - fullest.start
    if count < 2 * LEAST_SAMPLES:
        raise RecordingError(
            f"{count} pulses or angles in a cycle of {counted(round(length / TURN), 'revolution')} do not "
            f"show what the speed does within it; it takes {2 * LEAST_SAMPLES}."
        )
    highest = _harmonics_that_fit(shaft.angle[fullest], length)
    samples = round(length / TURN) * wanted
    even = np.arange(samples) * (length / samples)
    slopes = _harmonic_slopes(even, length, highest)
    rows, starts, off = [], [], []
    for number, window in enumerate(windows):
        start = begin + number * length
        times = rest[slice(*window)]
        matrix = _harmonic_matrix(shaft.angle[slice(*window)] - start, length, highest)
        # The normal equations do, as what would lose their digits is not taken.
        sizes, vectors = np.linalg.eigh(matrix.T @ matrix)
        if sizes[0] * MOST_GROWTH**2 < sizes[-1]:
            continue  # drop-outs leave too little of this cycle
        weights = vectors @ ((vectors.T @ (matrix.T @ times)) / sizes)
        off.append(np.mean((times - matrix @ weights) ** 2))
        rows.append(60.0 / TURN / (slow.deriv()(start + even) + slopes @ weights))
        starts.append(start)
    if not rows:
        raise RecordingError("drop-outs leave no whole cycle of the angle of the shaft.")
    left = f"{cycles - len(rows)} of {cycles} cycles are left out: drop-outs leave too little of them."
    speeds = np.array(rows)
    # What the harmonics leave of the times, as an error of the highest one in the speed.
    misfit = float(np.sqrt(np.mean(off) / count)) * highest * TURN / length * TURN / 60.0 * speeds.mean() ** 2
    return _Record(
        name="speed of the shaft",
        unit="rpm",
        rows=speeds,
        starts=np.array(starts),
        left_out=(shaft.angle[-1] - shaft.angle[0] - cycles * length) / TURN,
        highest=highest,
        error=misfit / max(float(np.std(speeds.mean(axis=0))), np.finfo(float).tiny),
        method="harmonics of the times of its angles, by least squares in each cycle",
        notes=[left] if len(rows) < cycles else [],
    )


def _harmonic_matrix(angle: np.ndarray, length: float, highest: int) -> np.ndarray:
    """A straight line, cosines and sines at angles."""
    phases = TURN / length * angle[:, None] * np.arange(1, highest + 1)
    return np.hstack((np.ones((len(angle), 1)), angle[:, None] / length, np.cos(phases), np.sin(phases)))


def _harmonic_slopes(angle: np.ndarray, length: float, highest: int) -> np.ndarray:
    """Derivatives of the columns of that matrix by the angle."""
    rates = TURN / length * np.arange(1, highest + 1)
    phases = angle[:, None] * rates
    line = np.column_stack((np.zeros(len(angle)), np.full(len(angle), 1.0 / length)))
    return np.hstack((line, -rates * np.sin(phases), rates * np.cos(phases)))


def _harmonics_that_fit(angle: np.ndarray, length: float) -> int:
    """As many harmonics as angles determine without a large growth of their errors."""
    highest = min(MOST_ORDERS, int(0.4 * len(angle)))
    matrix = _harmonic_matrix(angle, length, highest)
    products = matrix.T @ matrix
    for fewer in range(highest, 1, -1):
        kept = np.r_[0 : 2 + fewer, 2 + highest : 2 + highest + fewer]
        sizes = np.linalg.eigvalsh(products[np.ix_(kept, kept)])
        if sizes[0] * GROWTH**2 > sizes[-1]:
            return fewer
    return 1


def _first_cycle(shaft: ShaftAngle, angle: np.ndarray, length: float) -> tuple[float, int]:
    """Where the first whole cycle begins, and how many there are."""
    begin = np.ceil(angle[0] / TURN - 1e-9) * TURN if shaft.marked else float(angle[0])
    return begin, int((angle[-1] - begin) / length + 1e-9)


def _too_short(name: str, angle: np.ndarray, length: float) -> str:
    return (
        f"{name} spans {np.ptp(angle) / TURN:.3g} revolutions, and a cycle has {length / TURN:.0f} "
        "(--cycle-revolutions); record at least one whole cycle."
    )


def _without_drift(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The cycles without the slow course of their means, a parabola at most; and that course."""
    count, samples = rows.shape
    means = rows.mean(axis=1)
    if count < 4:
        return rows, np.full(count, means.mean())
    slow = np.polynomial.Polynomial.fit(np.arange(count) + 0.5, means, 2)
    course = slow(np.arange(count * samples) / samples).reshape(count, samples)
    return rows - course + means.mean(), slow(np.arange(count) + 0.5)


def _whole_cycles(
    channel: Channel, shaft: ShaftAngle, angle: np.ndarray, values: np.ndarray, length: float
) -> tuple[float, int, np.ndarray, np.ndarray]:
    """Where the first whole cycle begins, how many there are, and the samples.

    A recording that ends a sample before the next cycle begins holds that cycle: it is closed by the
    samples of its beginning.
    """
    begin, cycles = _first_cycle(shaft, angle, length)
    step = float(angle[-1] - angle[-2])
    closed = int((angle[-1] + 1.01 * step - begin) / length + 1e-9)
    if closed > cycles and begin == angle[0]:
        count = min(len(angle), 2 * DEGREE)
        angle = np.concatenate((angle, angle[:count] + closed * length))
        values = np.concatenate((values, values[:count]))
        keep = np.concatenate(([True], np.diff(np.maximum.accumulate(angle)) > 0.0))
        return begin, closed, angle[keep], values[keep]
    if cycles < 1:
        raise RecordingError(f"{channel.source}: {_too_short(repr(channel.name), angle, length)}")
    return begin, cycles, angle, values


def _dense(angle: np.ndarray, wanted: int) -> int:
    """Samples a revolution, a multiple of those that are wanted, that are no sparser than the recording."""
    recorded = TURN / float(np.median(np.diff(angle)))
    return wanted * max(1, int(np.ceil(recorded / wanted - 1e-6)))


def _standard_errors(spectra: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Standard errors of the amplitudes along and across the mean of each order, over the cycles."""
    count = len(spectra)
    if count < 2:
        unknown = np.full(spectra.shape[1], np.nan)
        return unknown, unknown
    mean = spectra.mean(axis=0)
    size = np.abs(mean)
    turned = spectra * np.where(size > 0.0, mean.conj() / np.where(size > 0.0, size, 1.0), 1.0)
    along, across = (np.std(part, axis=0, ddof=1) / np.sqrt(count) for part in (turned.real, turned.imag))
    return 2.0 * along, 2.0 * across


def _scatter(rows: np.ndarray) -> float:
    """Rms by which cycles differ from their mean over the rms of what oscillates of it."""
    mean = rows.mean(axis=0)
    spread = float(np.std(mean))
    off = float(np.sqrt(np.mean((rows - mean) ** 2)))
    return off / spread if spread > 0.0 else np.inf


def _kept(amplitudes: np.ndarray, errors: np.ndarray, derivative: bool) -> int:
    """The last harmonic that is large enough and stands out of the scatter; 0 if none does."""
    harmonics = np.arange(1, len(amplitudes) + 1)
    sizes = amplitudes * harmonics if derivative else amplitudes
    clear = sizes >= LEAST_SHARE * sizes.max()
    if np.isfinite(errors).all():
        # Errors of neighbours together, as those of a few cycles are uncertain themselves.
        pooled = np.sqrt(np.convolve(np.pad(errors**2, 4, mode="edge"), np.full(9, 1.0 / 9.0), mode="valid"))
        clear &= amplitudes > SIGNIFICANT * np.maximum(pooled, errors)
        sizes = np.where(clear, sizes, 0.0)
    return int(harmonics[clear & (harmonics <= MOST_ORDERS)].max(initial=0))


def _notes(cycle: MeanCycle, record: _Record, slow: np.ndarray) -> list[str]:
    """What was done, in sentences."""
    turns = f"{cycle.cycle_revolutions} revolution{'s' if cycle.cycle_revolutions > 1 else ''}"
    left = f"; {cycle.left_out:.3g} revolutions are left out" if cycle.left_out > 1e-3 else ""
    notes = [
        f"{cycle.cycles} whole cycle{'s' if cycle.cycles > 1 else ''} of {turns}{left}.",
        f"on equal angles by {record.method}, orders up to {cycle.orders[-1]:g}; the error of that is about "
        f"{100.0 * cycle.resampling_error:.2g} % of the rms.",
    ]
    if np.ptp(slow) > 0.1 * np.std(cycle.values):
        notes.append(
            f"its mean drifts from {slow[0]:.6g} to {slow[-1]:.6g} {units.shown(cycle.unit)}; the drift "
            "is taken out of the cycles."
        )
    if cycle.cycles > 1:
        notes.append(f"the cycles differ from their mean by {100.0 * cycle.scatter:.3g} % of its rms.")
    else:
        notes.append("of a single cycle no scatter is known.")
    return notes


def _warnings(cycle: MeanCycle, record: _Record, rows: np.ndarray, speeds: np.ndarray) -> list[str]:
    """A wide scatter with its likely cause, a speed that drifts, a signal that is all noise."""
    found = []
    if cycle.cycles > 1 and cycle.scatter > WIDE_SCATTER:
        found.append(
            f"the cycles of '{cycle.name}' differ by {100.0 * cycle.scatter:.3g} % of the rms of their mean: "
            + _cause(rows, cycle.cycle_revolutions, speeds)
        )
    elif _drift(speeds) > DRIFT:
        found.append(f"{_drift_words(speeds)}; the cycle is a mean over these speeds.")
    if cycle.kept == 0:
        found.append(f"no order of '{cycle.name}' stands out of the scatter of its cycles.")
    return found


def _drift(speeds: np.ndarray) -> float:
    """By what share a straight line through the speeds of the cycles rises or falls."""
    if len(speeds) < 3:
        return 0.0
    slope = np.polyfit(np.arange(len(speeds)), speeds, 1)[0]
    return abs(float(slope)) * (len(speeds) - 1) / float(np.mean(speeds))


def _drift_words(speeds: np.ndarray) -> str:
    return f"the speed drifts from {speeds[0]:.5g} to {speeds[-1]:.5g} 1/min"


def _cause(rows: np.ndarray, revolutions: int, speeds: np.ndarray) -> str:
    """The likely cause of a wide scatter, in words."""
    scatter = _scatter(rows)
    record = rows.ravel()
    per_turn = rows.shape[1] // revolutions
    for other in (1, 2, 3, 4, 6, 8):
        count = len(record) // (other * per_turn)
        if other == revolutions or count < 2 or (other < revolutions and revolutions % other == 0):
            continue
        scatter_there = _scatter(record[: count * other * per_turn].reshape(count, -1))
        if scatter_there < 0.5 * scatter:
            return (
                f"with --cycle-revolutions {other} it would be {100.0 * scatter_there:.3g} %, so that is "
                "rather what a cycle is."
            )
    if _drift(speeds) > DRIFT:
        return f"{_drift_words(speeds)}; take a --part, or recording.py run-up."
    slip = _slip(rows)
    if abs(slip) > 0.5:
        return (
            f"from cycle to cycle they shift by {slip * 360.0 * revolutions / rows.shape[1]:.3g} deg, so "
            "the angle is not that of the shaft: check --pulses and --missing, or the speed."
        )
    return "neither its length nor the speed explains it; it is noise or unsteady, see +- of the orders."


def _slip(rows: np.ndarray) -> float:
    """By how many samples a cycle is shifted against the one before, by the strongest harmonic of each."""
    spectra = np.fft.rfft(rows, axis=1)[:, 1 : rows.shape[1] // 2]
    strongest = int(np.argmax(np.mean(np.abs(spectra) ** 2, axis=0)))
    turned = np.angle(np.sum(spectra[1:, strongest] * spectra[:-1, strongest].conj()))
    return float(turned) * rows.shape[1] / (TURN * (strongest + 1))
