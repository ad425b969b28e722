"""What is heard of variants one after the other, with one gain, and the numbers that go with it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from rattle.command import CommandError
from rattle.comparison.variant import Variant
from rattle.optional import needed
from rattle.sound.force import ForceHarmonics, force_harmonics
from rattle.sound.levels import loudness_and_sharpness, sound_level
from rattle.sound.pressure import HIGHEST, RATE, faded, heard_share, samples, tones_of
from rattle.sound.transfer import Transfer

PAUSE = 0.5  # seconds of silence between two variants
FADE = 0.03  # seconds
ROOM = 2.0  # full scale over the largest pressure, where nobody chose it


@dataclass(frozen=True)
class Heard:
    """One variant: where it stands in the file [s], its forces by gear, its pressure [Pa] and its levels.

    `level` is A-weighted [dB re 20 uPa], `loudness` [sone] and `sharpness` [acum] are None where they are not
    known; `share` is that of the mean square of the forces that the transfer function passes on.
    """

    name: str
    start: float
    forces: dict[str, ForceHarmonics]
    pressure: np.ndarray
    level: float
    share: float
    loudness: float | None = None
    sharpness: float | None = None


def heard(variants: Sequence[Variant], transfer: Transfer, seconds: float) -> list[Heard]:
    """Each variant for so many seconds. Raises CommandError where a motion has no force that can be heard."""
    found: list[Heard] = []
    count = round(seconds * RATE)
    for place, variant in enumerate(variants):
        forces = {gear: force_harmonics(solved, HIGHEST) for gear, solved in variant.pairs.items()}
        tones = tones_of([*forces.values()], transfer)
        pressure = samples(tones, count)
        power = sum(force.rms**2 for force in forces.values())
        passed = sum(heard_share(force, transfer) * force.rms**2 for force in forces.values())
        if not passed > 0.0:
            raise CommandError(f"{variant.name} has no force in the range of the transfer function.")
        sensed = loudness_and_sharpness(pressure) if transfer.calibrated else None
        start = place * (seconds + PAUSE)
        found.append(
            Heard(variant.name, start, forces, pressure, sound_level(tones), passed / power, *(sensed or ()))
        )
    return found


class WithPressure(Protocol):
    """What can be heard."""

    @property
    def pressure(self) -> np.ndarray:
        """Sound pressure [Pa]."""


def full_scale(found: Sequence[WithPressure], transfer: Transfer) -> float:
    """The pressure [Pa] of a sample of 1: 1 Pa if calibrated, else above the largest."""
    largest = max(float(np.abs(one.pressure).max()) for one in found)
    return 1.0 if transfer.calibrated else ROOM * largest


def write_wav(path: Path, found: Sequence[WithPressure], scale: float) -> None:
    """All variants with a pause between them: pressure over `scale` [Pa], as floating samples of 32 bits."""
    wavfile = needed("scipy", "scipy.io.wavfile")
    silence = np.zeros(round(PAUSE * RATE))
    parts = [part for one in found for part in (silence, faded(one.pressure, FADE))][1:]
    wavfile.write(path, RATE, (np.concatenate(parts) / scale).astype(np.float32))
