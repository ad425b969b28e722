"""Levels of a sound: A-weighted by IEC 61672-1, loudness and sharpness by MoSQITo where it is installed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rattle.sound.pressure import RATE, Tones

REFERENCE = 2e-5  # Pa
POLES = (20.598997, 107.65265, 737.86223, 12194.217)  # Hz, annex E of IEC 61672-1:2013
NORMAL = 1000.0  # Hz, where the weighting is 0 dB
# What is left of a signal for its loudness: the filters swell, and the computation takes 3 s for each second.
SKIPPED, LISTENED = 0.3, 1.0  # seconds


def a_weight(frequencies: np.ndarray) -> np.ndarray:
    """Factor of an amplitude by A-weighting, equation (E.6) of IEC 61672-1."""
    return _response(np.asarray(frequencies, dtype=float)) / _response(np.array(NORMAL))


def _response(frequencies: np.ndarray) -> np.ndarray:
    square = frequencies**2
    first, second, third, fourth = (pole**2 for pole in POLES)
    return (
        fourth
        * square**2
        / ((square + first) * np.sqrt((square + second) * (square + third)) * (square + fourth))
    )


def sound_level(tones: Sequence[Tones], *, weighted: bool = True) -> float:
    """Level of the mean square of all harmonics [dB re 20 uPa], A-weighted or not."""
    power = 0.0
    for part in tones:
        weight = a_weight(part.frequencies) if weighted else 1.0
        power += 2.0 * float((np.abs(part.amplitudes * weight) ** 2).sum())
    return 10.0 * np.log10(power / REFERENCE**2) if power > 0.0 else -np.inf


def loudness_and_sharpness(pressure: np.ndarray) -> tuple[float, float] | None:
    """Loudness that is exceeded 5 % of the time [sone, ISO 532-1] and mean sharpness [acum, DIN 45692].

    Of a free field, over a second behind the first 0.3 s. None where MoSQITo is not installed.
    """
    try:
        from mosqito.sq_metrics import loudness_zwtv, sharpness_din_from_loudness
    except ImportError:
        return None
    part = pressure[: int((SKIPPED + LISTENED) * RATE)]
    loudness, specific, _, time = loudness_zwtv(part, RATE, field_type="free")
    kept = time >= SKIPPED
    sharpness = sharpness_din_from_loudness(loudness[kept], specific[:, kept])
    return float(np.percentile(loudness[kept], 95.0)), float(np.mean(sharpness))
