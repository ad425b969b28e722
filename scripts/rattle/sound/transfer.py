"""From force on the bearings to sound pressure: a measured transfer function, or a generic housing."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rattle.command import CommandError
from rattle.csv_table import read_csv_table

EXAMPLE = "frequency [Hz],amplitude [Pa/N],phase [deg]"
UNITS = {"frequency": "Hz", "amplitude": "Pa/N", "phase": "rad"}
# Modes of the generic housing: frequency [Hz], damping ratio, and the sign with which they radiate.
MODES = (
    (620.0, 0.030, 1.0),
    (1050.0, 0.030, -1.0),
    (1700.0, 0.025, 1.0),
    (2500.0, 0.025, -1.0),
    (3500.0, 0.020, 1.0),
    (4800.0, 0.020, -1.0),
)
GENERIC_GAIN = 1e-4  # Pa/N of each mode far above its frequency; chosen, not measured
AUDIBLE = (20.0, 20000.0)  # Hz


@dataclass(frozen=True)
class Transfer:
    """Sound pressure for each newton, over frequency; what lies outside its range [Hz] is not known.

    `frequencies` rise; `calibrated` is False where the amplitude is chosen, not measured.
    """

    words: str
    calibrated: bool
    range: tuple[float, float]
    frequencies: np.ndarray | None = None
    logarithms: np.ndarray | None = None
    phases: np.ndarray | None = None

    def at(self, frequencies: np.ndarray) -> np.ndarray:
        """Complex [Pa/N]; 0 outside the range. Between points, level and phase follow straight lines."""
        inside = (frequencies >= self.range[0]) & (frequencies <= self.range[1])
        if self.frequencies is None or self.logarithms is None or self.phases is None:
            return np.where(inside, housing(frequencies), 0.0)
        level = np.interp(frequencies, self.frequencies, self.logarithms)
        phase = np.interp(frequencies, self.frequencies, self.phases)
        return np.where(inside, np.exp(level + 1j * phase), 0.0)


def generic() -> Transfer:
    """The generic housing: a few damped modes, whose sound is like that of a gearbox, and is of none."""
    return Transfer("a generic housing, not calibrated", False, AUDIBLE)


def housing(frequencies: np.ndarray) -> np.ndarray:
    """Pressure for each newton [Pa/N]: each mode radiates as it accelerates."""
    total = np.zeros(frequencies.shape, dtype=complex)
    for mode, damping, sign in MODES:
        ratio = frequencies / mode
        total -= sign * ratio**2 / (1.0 - ratio**2 + 2j * damping * ratio)
    return GENERIC_GAIN * total


def read_transfer(path: Path) -> Transfer:
    """A measured one from a CSV file with columns frequency, amplitude and phase; phases may be wrapped.

    Raises CommandError with file and line.
    """
    table = read_csv_table(path, EXAMPLE)
    places = {}
    for name, unit in UNITS.items():
        found = [
            place
            for place in range(len(table.names))
            if table.name_of(place, unit)[0].strip().lower() == name
        ]
        if len(found) != 1:
            raise CommandError(
                f"{path}:{table.header}: {len(found) or 'no'} columns are called {name}; "
                f"needed are {EXAMPLE}."
            )
        places[name] = found[0]
    if not table.name_of(places["phase"], "rad")[1]:
        raise CommandError(f"{path}:{table.header}: the phase has no unit; write phase [deg] or phase [rad].")
    columns = {name: table.column(places[name], unit) for name, unit in UNITS.items()}
    frequency, amplitude = columns["frequency"], columns["amplitude"]
    if frequency.size < 2:
        raise CommandError(f"{path}: a transfer function needs two frequencies or more.")
    for wrong, words in (
        (~np.isfinite(np.array([*columns.values()])).all(axis=0), "a number is missing"),
        (np.diff(frequency, prepend=0.0) <= 0.0, "frequencies have to be above 0 and to rise"),
        (amplitude <= 0.0, "an amplitude has to be above 0"),
    ):
        if wrong.any():
            raise CommandError(f"{path}:{table.lines[np.argmax(wrong)]}: {words}.")
    ends = float(frequency[0]), float(frequency[-1])
    phases = np.unwrap(columns["phase"])
    return Transfer(
        f"{path.name}, {ends[0]:g} to {ends[1]:g} Hz", True, ends, frequency, np.log(amplitude), phases
    )
