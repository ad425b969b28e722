"""The mean cycle of a steady recording: whole cycles on equal angles, their mean, orders and scatter."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import interpolate

from rattle.recordings import mending
from rattle.recordings.angle import BRIDGE, DEGREE, TURN, ShaftAngle, angles_of, interpolation_error
from rattle.recordings.channels import Channel
from rattle.recordings.faults import RecordingError

SAMPLES = 360
# Scatter of the cycles beyond which the user is warned, and drift of the speed that is named as its cause.
WIDE_SCATTER = 0.1
DRIFT = 0.01
# Orders that rattle takes of a cycle at most, and the share of the largest that one must have.
MOST_ORDERS = 128
LEAST_SHARE = 1e-3
# An order stands out of the scatter where it is so many times its standard error.
SIGNIFICANT = 4.0


@dataclass(frozen=True)
class MeanCycle:
    """The mean of whole cycles at equal angles, and its harmonics: a cos(order angle + phase).

    `angle` [rad] begins with 0. `amplitude_errors` and `phase_errors` [rad] are standard errors of the means, not
    a number of a single cycle. `scatter` is the rms by which cycles differ from their mean over the rms of what
    oscillates of it. `speed_range` [1/min] is that of the mean speeds of the cycles, `kept` how many harmonics
    stand out of the scatter. `warnings` and `notes` are sentences for the user.
    """

    name: str
    unit: str
    angle: np.ndarray
    values: np.ndarray
    cycle_revolutions: int
    cycles: int
    left_out: float
    mean: float
    orders: np.ndarray
    amplitudes: np.ndarray
    phases: np.ndarray
    amplitude_errors: np.ndarray
    phase_errors: np.ndarray
    scatter: float
    speed_rpm: float
    speed_range: tuple[float, float]
    resampling_error: float
    kept: int
    notes: list[str]
    warnings: list[str]


def mean_cycle(
    channel: Channel,
    shaft: ShaftAngle,
    *,
    cycle_revolutions: int = 2,
    samples_per_revolution: int = SAMPLES,
    derivative: bool = False,
    mend: bool = False,
    bridge: float = BRIDGE,
) -> MeanCycle:
    """Average the whole cycles of a steady recording.

    The channel is resampled onto equal angles, at least as dense as it was recorded, by a spline of degree 5;
    after the mean is taken orders that `samples_per_revolution` cannot hold are cut off in its spectrum, so none is
    folded back. `derivative`: the signal is a speed, of which rattle takes the derivative, so that its orders count
    by their accelerations.
    """
    notes: list[str] = []
    channel = mending.mended(channel, mend=mend, notes=notes)
    if channel.has_time:
        channel = mending.bridged(channel, limit=bridge, notes=notes)
    angle, values = angles_of(channel, shaft)
    if np.ptp(values) <= 1e-12 * np.max(np.abs(values)):
        raise RecordingError(
            f"{channel.source}: '{channel.name}' is constant at {values[0]:.6g}; nothing oscillates."
        )
    length = TURN * cycle_revolutions
    begin, cycles, angle, values = _whole_cycles(channel, shaft, angle, values, length)
    per_turn = _dense(angle, samples_per_revolution)
    rows = _resampled(angle, values, begin, cycles, per_turn * cycle_revolutions, length)
    spectra = np.fft.rfft(rows, axis=1) / rows.shape[1]
    samples = samples_per_revolution * cycle_revolutions
    # No more orders than the output holds, or the recording.
    highest = min(samples // 2 - 1, int(0.5 * length / np.max(np.diff(angle))), rows.shape[1] // 2 - 1)
    if highest < 1:
        raise RecordingError(
            f"{channel.source}: '{channel.name}' has {length / np.mean(np.diff(angle)):.2g} samples a cycle; an order "
            "takes more than two."
        )
    mean = spectra.mean(axis=0)
    spectrum = np.zeros(samples // 2 + 1, dtype=complex)
    spectrum[: highest + 1] = mean[: highest + 1]
    averaged = np.fft.irfft(spectrum * samples, samples)
    amplitudes = 2.0 * np.abs(spectrum[1 : highest + 1])
    phases = np.angle(spectrum[1 : highest + 1])
    errors = _standard_errors(spectra[:, 1 : highest + 1])
    cycle = MeanCycle(
        name=channel.name,
        unit=channel.unit,
        angle=np.arange(samples) * length / samples,
        values=averaged,
        cycle_revolutions=cycle_revolutions,
        cycles=cycles,
        left_out=(angle[-1] - angle[0]) / TURN - cycles * cycle_revolutions,
        mean=float(spectrum[0].real),
        orders=np.arange(1, highest + 1) / cycle_revolutions,
        amplitudes=amplitudes,
        phases=phases,
        amplitude_errors=errors[0],
        phase_errors=errors[1] / np.maximum(amplitudes, np.finfo(float).tiny),
        scatter=_scatter(rows),
        speed_rpm=np.nan,
        speed_range=(np.nan, np.nan),
        resampling_error=interpolation_error(angle, values),
        kept=_kept(amplitudes, errors[0], derivative),
        notes=notes,
        warnings=[],
    )
    return _judged(cycle, shaft, channel, rows, begin)


def _whole_cycles(
    channel: Channel, shaft: ShaftAngle, angle: np.ndarray, values: np.ndarray, length: float
) -> tuple[float, int, np.ndarray, np.ndarray]:
    """Where the first whole cycle begins, how many there are, and the samples.

    A recording that ends a sample before the next cycle begins holds that cycle: it is closed by the samples of its
    beginning.
    """
    begin = angle[0]
    if shaft.marked:
        begin = np.ceil(angle[0] / TURN - 1e-9) * TURN
    step = float(angle[-1] - angle[-2])
    cycles = int((angle[-1] - begin) / length + 1e-9)
    closed = int((angle[-1] + 1.01 * step - begin) / length + 1e-9)
    if closed > cycles and begin == angle[0]:
        count = min(len(angle), 2 * DEGREE)
        angle = np.concatenate((angle, angle[:count] + closed * length))
        values = np.concatenate((values, values[:count]))
        keep = np.concatenate(([True], np.diff(np.maximum.accumulate(angle)) > 0.0))
        return begin, closed, angle[keep], values[keep]
    if cycles < 1:
        raise RecordingError(
            f"{channel.source}: '{channel.name}' spans {(angle[-1] - angle[0]) / TURN:.3g} revolutions, and a cycle has "
            f"{length / TURN:.0f} (--cycle-revolutions); record at least one whole cycle."
        )
    return begin, cycles, angle, values


def _dense(angle: np.ndarray, wanted: int) -> int:
    """Samples a revolution, a multiple of those that are wanted, that are no sparser than the recording."""
    recorded = TURN / float(np.median(np.diff(angle)))
    return wanted * max(1, int(np.ceil(recorded / wanted - 1e-6)))


def _resampled(
    angle: np.ndarray, values: np.ndarray, begin: float, cycles: int, samples: int, length: float
) -> np.ndarray:
    """A row of samples at equal angles for each cycle."""
    even = begin + np.arange(cycles * samples) * (length / samples)
    degree = min(DEGREE, 2 * ((len(angle) - 2) // 2) + 1)
    spline = interpolate.make_interp_spline(angle, values, k=degree)
    return spline(np.clip(even, angle[0], angle[-1])).reshape(cycles, samples)


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


def _judged(
    cycle: MeanCycle, shaft: ShaftAngle, channel: Channel, rows: np.ndarray, begin: float
) -> MeanCycle:
    """The cycle with its speeds, and warnings of a wide scatter with its likely cause."""
    notes, warnings = list(cycle.notes), []
    left = f"; {cycle.left_out:.3g} revolutions are left out" if cycle.left_out > 1e-3 else ""
    turns = f"{cycle.cycle_revolutions} revolution{'s' if cycle.cycle_revolutions > 1 else ''}"
    notes.append(f"{cycle.cycles} whole cycle{'s' if cycle.cycles > 1 else ''} of {turns}{left}.")
    edges = begin + TURN * cycle.cycle_revolutions * np.arange(cycle.cycles + 1)
    times = shaft.times(np.clip(edges, shaft.angle[0], shaft.angle[-1]))
    share = np.diff(np.clip(edges, shaft.angle[0], shaft.angle[-1])) / TURN
    speeds = 60.0 * share / np.diff(times)
    mean_speed = 60.0 * share.sum() / (times[-1] - times[0])
    notes.append(
        f"resampled onto equal angles by a spline of degree {DEGREE}, orders up to {cycle.orders[-1]:g}; its error "
        f"is about {100.0 * cycle.resampling_error:.2g} % of the rms."
    )
    if cycle.cycles > 1:
        notes.append(f"the cycles differ from their mean by {100.0 * cycle.scatter:.3g} % of its rms.")
    else:
        notes.append("of a single cycle no scatter is known.")
    if cycle.cycles > 1 and cycle.scatter > WIDE_SCATTER:
        warnings.append(
            f"the cycles of '{cycle.name}' differ by {100.0 * cycle.scatter:.3g} % of the rms of their mean: "
            + _cause(rows, cycle.cycle_revolutions, speeds)
        )
    if channel.has_time and cycle.kept == 0:
        warnings.append(f"no order of '{cycle.name}' stands out of the scatter of its cycles.")
    return replace(
        cycle,
        notes=notes,
        warnings=warnings,
        speed_rpm=float(mean_speed),
        speed_range=(float(speeds.min()), float(speeds.max())),
    )


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
                f"with --cycle-revolutions {other} it would be {100.0 * scatter_there:.3g} %, so that is rather "
                "what a cycle is."
            )
    slope = np.polyfit(np.arange(len(speeds)), speeds, 1)[0] * (len(speeds) - 1) if len(speeds) > 2 else 0.0
    drift = max(abs(slope), 0.0) / float(np.mean(speeds))
    if drift > DRIFT:
        return (
            f"the speed drifts from {speeds[0]:.5g} to {speeds[-1]:.5g} 1/min; take a shorter part, or "
            "recording.py run-up."
        )
    slip = _slip(rows)
    if abs(slip) > 0.5:
        return (
            f"from cycle to cycle they shift by {slip * 360.0 * revolutions / rows.shape[1]:.3g} deg, so the angle "
            "is not that of the shaft: check --pulses and --missing, or the speed."
        )
    return "nothing in the speed explains it; noise, another source, or an unsteady engine."


def _slip(rows: np.ndarray) -> float:
    """By how many samples a cycle is shifted against the one before, by the strongest harmonic of each."""
    spectra = np.fft.rfft(rows, axis=1)[:, 1 : rows.shape[1] // 2]
    strongest = int(np.argmax(np.mean(np.abs(spectra) ** 2, axis=0)))
    turned = np.angle(np.sum(spectra[1:, strongest] * spectra[:-1, strongest].conj()))
    return float(turned) * rows.shape[1] / (TURN * (strongest + 1))
