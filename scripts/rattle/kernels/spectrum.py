"""Spectrum of a motion, and the rattle class that follows from it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rattle import _kernels, codes
from rattle.kernels._calls import finite_numbers, finite_samples, positive_count

CLASSES = tuple(codes.CLASSES.values())


def amplitude_spectrum(samples: np.ndarray) -> np.ndarray:
    """Single-sided amplitudes a_0 .. a_(n/2) of n equidistant samples, rectangular window.

    Parameters
    ----------
    samples
        One-dimensional, finite, not empty.

    Returns
    -------
    amplitudes
        In the unit of the samples.
    """
    flat = finite_samples(samples, "samples")
    return _kernels.wrap_amplitude_spectrum(flat, flat.size // 2 + 1)


def lines(acceleration: np.ndarray, samples_per_period: int) -> np.ndarray:
    """Amplitudes of the acceleration at the multiples of the excitation frequency.

    Parameters
    ----------
    acceleration
        z'' [m/s2] over whole periods, one-dimensional and finite.
    samples_per_period
        At least 3.

    Returns
    -------
    harmonics
        a_n [m/s2] at n f_exc for every n that the samples resolve; n = 1 comes first.

    Raises
    ------
    ValueError
        The samples are no whole number of periods, or not finite.
    """
    return classify(acceleration, samples_per_period)["harmonics"]


def classify(
    acceleration: np.ndarray,
    samples_per_period: int,
    *,
    harmonic_threshold: float = 0.01,
    idle_harmonics: int = 20,
    quiet_limit: float = 0.35,
    irregular_limit: float = 0.01,
    noise_floor: float = 0.0,
    orbit_period: int | None = None,
    force_orders: Sequence[int] = (1,),
    force_amplitudes: Sequence[float] = (1.0,),
) -> dict[str, Any]:
    """Class of a window of whole periods of the acceleration, with the measures that it follows from.

    A motion at rest is quiet and has no ratios: these are nan then.

    Parameters
    ----------
    acceleration
        z'' [m/s2], one-dimensional and finite.
    samples_per_period
        At least 3.
    harmonic_threshold, idle_harmonics, quiet_limit, irregular_limit
        Limits of the classes, as keys of &spectrum have them.
    noise_floor
        Acceleration [m/s2]: a motion whose rms times sqrt(2) does not exceed it is at rest.
    orbit_period
        Periods of the force after which the motion is known to repeat, if that is known; with several, a
        motion that were irregular is subharmonic.
    force_orders, force_amplitudes
        Harmonics of a force of several; lines there are no sign of rattle, the others are compared with the
        largest of them, the reference line.

    Returns
    -------
    measures
        rattle_class, harmonic_count, spectral_reach, harmonic_distortion, irregular_fraction,
        reversals_per_period, sampling_sufficient, harmonics [m/s2] and reference_line.

    Raises
    ------
    ValueError
        The samples are no whole number of periods, or a number is outside its range.
    """
    samples = finite_samples(acceleration, "acceleration")
    period = positive_count(samples_per_period, "samples_per_period")
    if period < 3:
        raise ValueError(f"a class needs at least 3 samples a period, not {period}")
    if samples.size % period:
        raise ValueError(
            f"acceleration holds {samples.size} samples; that is not a whole number of periods of {period}"
        )
    limits = finite_numbers(
        harmonic_threshold=harmonic_threshold,
        quiet_limit=quiet_limit,
        irregular_limit=irregular_limit,
        noise_floor=noise_floor,
    )
    harmonics, ratios, counts = _kernels.wrap_classify(
        samples,
        samples.size // period,
        limits,
        positive_count(idle_harmonics, "idle_harmonics"),
        0 if orbit_period is None else positive_count(orbit_period, "orbit_period"),
        *_orders_of(force_orders, force_amplitudes),
        (period - 1) // 2,
    )
    moving = bool(counts[2])
    return {
        "rattle_class": codes.CLASSES[counts[0]],
        "harmonic_count": int(counts[1]),
        "spectral_reach": float(ratios[3]),
        "harmonic_distortion": float(ratios[0]) if moving else float("nan"),
        "irregular_fraction": float(ratios[1]) if moving else float("nan"),
        "reversals_per_period": float(ratios[2]),
        "sampling_sufficient": bool(counts[3]),
        "harmonics": harmonics,
        "reference_line": int(counts[4]),
    }


def _orders_of(orders: Any, amplitudes: Any) -> tuple[np.ndarray, np.ndarray]:
    """Harmonics of a force and their amplitudes, as the kernel takes them."""
    whole = np.array(
        [positive_count(order, "force_orders") for order in np.atleast_1d(orders)], dtype=np.int32
    )
    sizes = finite_samples(np.asarray(amplitudes, dtype=float), "force_amplitudes")
    if whole.size != sizes.size:
        raise ValueError(f"a force has as many amplitudes as orders, not {sizes.size} for {whole.size}")
    return whole, sizes
