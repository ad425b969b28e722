"""Sound pressure of several forces, as harmonics and as samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rattle.optional import needed
from rattle.sound.force import ForceHarmonics
from rattle.sound.transfer import Transfer

RATE = 48000  # samples a second
HIGHEST = 20000.0  # Hz


@dataclass(frozen=True)
class Tones:
    """Harmonics of a pressure: those of `frequency`, amplitudes as in `ForceHarmonics` [Pa]."""

    frequency: float
    amplitudes: np.ndarray

    @property
    def frequencies(self) -> np.ndarray:
        """Of the harmonics [Hz]."""
        return self.frequency * np.arange(1, self.amplitudes.size + 1)


def tones_of(forces: Sequence[ForceHarmonics], transfer: Transfer) -> list[Tones]:
    """The pressure of all forces, those of one frequency added as they stand: all follow one shaft."""
    found: list[Tones] = []
    for force in forces:
        heard = force.amplitudes * transfer.at(force.frequencies)
        same = [
            place
            for place, tones in enumerate(found)
            if np.isclose(tones.frequency, force.frequency, rtol=1e-9)
        ]
        if same:
            both = sorted((found[same[0]].amplitudes, heard), key=len)
            heard = both[1] + np.pad(both[0], (0, both[1].size - both[0].size))
            found[same[0]] = Tones(force.frequency, heard)
        else:
            found.append(Tones(force.frequency, heard))
    return found


def heard_share(force: ForceHarmonics, transfer: Transfer) -> float:
    """Share of the mean square of a force in the range of the transfer function."""
    low, high = transfer.range
    inside = (force.frequencies >= low) & (force.frequencies <= high)
    return float(2.0 * (np.abs(force.amplitudes[inside]) ** 2).sum() / force.rms**2) if force.rms else 0.0


def samples(tones: Sequence[Tones], count: int) -> np.ndarray:
    """The pressure [Pa] at the times 0, 1/RATE, ...: each harmonic exactly, by a chirp z-transform."""
    signal = needed("scipy", "scipy.signal")
    pressure = np.zeros(count)
    for part in tones:
        turn = 2j * np.pi * part.frequency / RATE
        # czt sums amplitude x_k z^-k, k from 0: the z of sample n is exp(-turn n).
        summed = signal.czt(np.concatenate([[0.0], part.amplitudes]), count, np.exp(turn), 1.0)
        pressure += 2.0 * summed.real
    return pressure


def faded(pressure: np.ndarray, seconds: float) -> np.ndarray:
    """The same, swelling and fading over this time at its ends, so that they do not click."""
    count = min(int(seconds * RATE), pressure.size // 2)
    swell = np.sin(0.5 * np.pi * np.arange(count) / max(count, 1)) ** 2
    shaped = pressure.copy()
    shaped[:count] *= swell
    shaped[pressure.size - count :] *= swell[::-1]
    return shaped
