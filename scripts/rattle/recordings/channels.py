"""Channels of a recording: what was measured, in its unit, over time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rattle.recordings import measurement_files, text_file, time_axis, units
from rattle.recordings.faults import RecordingError
from rattle.recordings.raw import Raw

__all__ = ["Channel", "RecordingError", "choose", "read_channels", "with_units"]

# Readers by the first bytes of a file, and where these show nothing by the end of its name.
BY_BEGINNING: tuple[tuple[bytes, str], ...] = (
    (b"MDF     ", "mdf"),
    (b"UnFinMF ", "mdf"),
    (b"TDSm", "tdms"),
    (b"\x89HDF\r\n\x1a\n", "hdf5"),
    (b"MATLAB 5.0 MAT-file", "mat"),
    (b"MATLAB 7.3 MAT-file", "hdf5"),
    (b"    -1", "uff"),
)
BY_SUFFIX = {
    ".mf4": "mdf",
    ".mdf": "mdf",
    ".tdms": "tdms",
    ".h5": "hdf5",
    ".hdf5": "hdf5",
    ".hdf": "hdf5",
    ".mat": "mat",
    ".uff": "uff",
    ".unv": "uff",
}
READERS: dict[str, Callable[[Path, list[str]], list[Raw]]] = {
    "mdf": measurement_files.read_mdf,
    "tdms": measurement_files.read_tdms,
    "hdf5": measurement_files.read_hdf5,
    "mat": measurement_files.read_mat,
    "uff": measurement_files.read_uff,
    "text": text_file.read_text,
}
NAMES = {"mdf": "MDF", "tdms": "TDMS", "hdf5": "HDF5"}
LEAST_SAMPLES = 2
# What the option says that stands for times.
RATE = "samples a second of a file without times"


@dataclass(frozen=True)
class Channel:
    """One channel of a recording; its times ascend strictly."""

    name: str  #: as the recording has it
    unit: str  #: of the values, as recorded
    time: np.ndarray  #: [s]; counts samples where the file has no times
    values: np.ndarray  #: not a number where the recording has a gap
    source: str  #: path of the file
    has_time: bool = True  #: False of a file without times, from which no speed can be found

    @property
    def label(self) -> str:
        """Name with unit."""
        return f"{self.name} [{units.shown(self.unit)}]" if self.unit else self.name

    def within(self, unit: str) -> np.ndarray:
        """The values in another unit.

        Parameters
        ----------
        unit
            Name of the unit.

        Returns
        -------
        values
            Converted.

        Raises
        ------
        RecordingError
            The unit is unknown, or of another dimension.
        """
        return units.convert(self.values, self.unit, unit, self.name)


def read_channels(
    path: Path | str, *, rate: float | None = None, notes: list[str] | None = None
) -> list[Channel]:
    """All channels of a recording: text (CSV), MDF, TDMS, UFF 58, MAT or HDF5.

    Parameters
    ----------
    path
        The file.
    rate
        Sampling rate [Hz], for a file without times.
    notes
        What was made of the file is appended to it.

    Returns
    -------
    channels
        In the order of the file.

    Raises
    ------
    RecordingError
        The file cannot be used; file and line where known.
    """
    path = Path(path)
    messages = [] if notes is None else notes
    found = READERS[_format(path)](path, messages)
    channels: list[Channel] = []
    for raw in found:
        time, has_time = raw.time, raw.time is not None
        if np.any(strange := np.abs(raw.values) > text_file.LARGEST):
            at = int(np.argmax(strange))
            raise RecordingError(
                f"{path}: sample {at + 1} of '{raw.name}' is {raw.values[at]:g}, no number of a bench."
            )
        if time is None:
            time = np.arange(len(raw.values)) / (rate or 1.0)
            has_time = rate is not None
        kept = time_axis.settle(time, raw.values, raw.lines, f"{path}", messages)
        channels.append(Channel(raw.name, units.plain(raw.unit), *kept, str(path), has_time))
    if not channels:
        raise RecordingError(f"{path} has no channel of numbers.")
    if not any(len(channel.values) >= LEAST_SAMPLES for channel in channels):
        count = max(len(channel.values) for channel in channels)
        raise RecordingError(f"{path} has {count or 'no'} sample of a known time; a recording has more.")
    if not any(np.isfinite(channel.values).any() for channel in channels):
        raise RecordingError(f"{path} has no number in any channel: all are gaps.")
    return channels


def choose(channels: Sequence[Channel], name_or_number: str | int) -> Channel:
    """The channel of a name or a number.

    Parameters
    ----------
    channels
        Channels of one file.
    name_or_number
        Its name, whatever its case, or its number from 1 on as `recording.py list` counts.

    Returns
    -------
    channel
        The one that is meant.

    Raises
    ------
    RecordingError
        There is none, or several.
    """
    wanted = str(name_or_number).strip()
    for same in (
        lambda channel: channel.name == wanted,
        lambda channel: channel.label == wanted,
        lambda channel: channel.name.lower() == wanted.lower(),
    ):
        found = [channel for channel in channels if same(channel)]
        if len(found) == 1:
            return found[0]
        if found:
            numbers = [str(place) for place, channel in enumerate(channels, 1) if same(channel)]
            raise RecordingError(
                f"{len(found)} channels are called '{wanted}': choose by number, {' or '.join(numbers)}."
            )
    if wanted.isdecimal() and 1 <= int(wanted) <= len(channels):
        return channels[int(wanted) - 1]
    names = ", ".join(channel.name for channel in channels[:20]) + (", ..." if len(channels) > 20 else "")
    raise RecordingError(f"{channels[0].source} has no channel '{wanted}'; it has {names}.")


def with_units(channels: Sequence[Channel], given: dict[str, str]) -> list[Channel]:
    """The channels with units that the user gives.

    Parameters
    ----------
    channels
        Channels of one file.
    given
        Units by name or number of the channel.

    Returns
    -------
    channels
        The same values in these units.

    Raises
    ------
    RecordingError
        There is no such channel.
    """
    changed = list(channels)
    for name, unit in given.items():
        place = [c is choose(channels, name) for c in channels].index(True)
        old = channels[place]
        changed[place] = Channel(old.name, units.plain(unit), old.time, old.values, old.source, old.has_time)
    return changed


def _format(path: Path) -> str:
    if path.is_dir():
        raise RecordingError(f"{path} is a folder; give a file.")
    with path.open("rb") as stream:
        beginning = stream.read(24)
    if not beginning:
        raise RecordingError(f"{path} is empty.")
    for bytes_, name in BY_BEGINNING:
        if beginning.startswith(bytes_):
            return name
    named = BY_SUFFIX.get(path.suffix.lower(), "")
    if named == "mat":  # of version 4, which nothing marks
        return named
    if named in NAMES:
        raise RecordingError(
            f"{path} is no {NAMES[named]} file, in spite of its name; text is read from NAME.csv."
        )
    return "text"
