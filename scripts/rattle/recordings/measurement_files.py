"""Recordings in the files of measurement systems, each read by the library that its field keeps."""

from __future__ import annotations

import contextlib
import gc
import io
import logging
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping
from functools import wraps
from pathlib import Path
from typing import Any

import numpy as np

from rattle.recordings.faults import RecordingError, library
from rattle.recordings.raw import Raw

TIME_NAMES = ("time", "t", "timestamp", "timestamps", "zeit", "x")
RATES = ("sample_rate", "samplerate", "sampling_rate", "sampling_frequency", "fs", "rate")
STEPS = ("dt", "wf_increment", "increment", "delta", "step", "sample_interval")
# Units of UFF 58 by the code of what the ordinate is, where its label is empty.
UFF_UNITS = {8: "m", 9: "N", 11: "m/s", 12: "m/s2", 13: "N", 15: "Pa"}

Reader = Callable[[Path, list[str]], list[Raw]]


def _refusing(kind: str) -> Callable[[Reader], Reader]:
    """A reader of damaged files, too: libraries meet these with any exception and words of their own."""

    def decorate(reader: Reader) -> Reader:
        @wraps(reader)
        def read(path: Path, notes: list[str]) -> list[Raw]:
            with _silence():
                found, reason = _tried(reader, path, notes)
                gc.collect()  # half-made objects complain when they are taken away
            if reason:
                raise RecordingError(
                    f"{path} cannot be read as {kind}; it is damaged or cut short ({reason})."
                )
            if not found:
                raise RecordingError(f"{path} has no channel of numbers.")
            return found

        return read

    return decorate


def _tried(reader: Reader, path: Path, notes: list[str]) -> tuple[list[Raw], str]:
    """What a reader finds, or else why it does not."""
    try:
        return reader(path, notes), ""
    except (RecordingError, MemoryError):
        raise
    except Exception as fault:
        return [], " ".join(str(fault).split())[:120].rstrip(" .") or type(fault).__name__


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """Nothing of what a library says reaches the user."""
    words, hook = io.StringIO(), sys.unraisablehook
    logging.disable(logging.CRITICAL)
    sys.unraisablehook = lambda _: None
    try:
        with (
            warnings.catch_warnings(),
            contextlib.redirect_stdout(words),
            contextlib.redirect_stderr(words),
        ):
            warnings.simplefilter("ignore")
            yield
    finally:
        sys.unraisablehook = hook
        logging.disable(logging.NOTSET)


@_refusing("MDF")
def read_mdf(path: Path, notes: list[str]) -> list[Raw]:
    """Channels of an MDF file of version 3 or 4, each over the master of its group."""
    channels: list[Raw] = []
    with library("asammdf").MDF(str(path)) as file:
        for group, parts in enumerate(file.groups):
            master = file.masters_db.get(group)
            for place in range(len(parts.channels)):
                if place == master:
                    continue
                signal = file.get(group=group, index=place, ignore_invalidation_bits=False)
                if _is_numbers(signal.samples) and len(signal.samples):
                    values = signal.samples.astype(float)
                    time = np.asarray(signal.timestamps, dtype=float)
                    channels.append(Raw(signal.name, signal.unit or "", values, time))
    return channels


@_refusing("TDMS")
def read_tdms(path: Path, notes: list[str]) -> list[Raw]:
    """Channels of a TDMS file, over the increment of their waveform or a channel of time in their group."""
    channels: list[Raw] = []
    for group in library("nptdms").TdmsFile.read(str(path)).groups():
        own = [channel for channel in group.channels() if len(channel) and _is_numbers(channel[:])]
        clock = next((c for c in own if c.name.lower() in TIME_NAMES), None)
        for channel in own:
            if channel is clock:
                continue
            values = np.asarray(channel[:], dtype=float)
            time = None
            if channel.properties.get("wf_increment"):
                time = channel.time_track()
            elif clock is not None and len(clock) == len(values):
                time = np.asarray(clock[:], dtype=float)
            unit = str(channel.properties.get("unit_string") or channel.properties.get("unit") or "")
            channels.append(Raw(channel.name, unit, values, time))
    return channels


@_refusing("UFF")
def read_uff(path: Path, notes: list[str]) -> list[Raw]:
    """Time series of the data sets 58 of a universal file."""
    file = library("pyuff").UFF(str(path))
    channels: list[Raw] = []
    for place, kind in enumerate(file.get_set_types()):
        if int(kind) != 58:
            continue
        set_ = file.read_sets(place)
        if set_["func_type"] not in (0, 1) or not _is_numbers(set_["data"]):
            continue
        name = str(set_.get("id1", "")).strip()
        if not name or name.upper() == "NONE":
            name = f"set_{place + 1}"
        unit = str(set_.get("ordinate_axis_units_lab", "")).strip()
        if unit.upper() in ("", "NONE"):
            unit = UFF_UNITS.get(int(set_.get("ordinate_spec_data_type", 0)), "")
        time = np.asarray(set_["x"], dtype=float)
        channels.append(Raw(name, unit, np.asarray(set_["data"], dtype=float), time))
    return channels


@_refusing("MATLAB")
def read_mat(path: Path, notes: list[str]) -> list[Raw]:
    """Vectors of a MAT file before version 7.3, also within structures."""
    content = library("scipy.io").loadmat(str(path), squeeze_me=True, struct_as_record=False)
    tree = {name: value for name, value in content.items() if not name.startswith("__")}
    return _tree_channels(tree, {})


@_refusing("HDF5")
def read_hdf5(path: Path, notes: list[str]) -> list[Raw]:
    """Vectors of an HDF5 file, or of a MAT file of version 7.3, over the time of their group."""
    h5py = library("h5py")
    attributes: dict[str, Mapping[str, Any]] = {}

    def load(group: Any) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for name, item in group.items():
            if name.startswith("#"):
                continue
            attributes[item.name.lstrip("/")] = dict(item.attrs)
            if isinstance(item, h5py.Dataset):
                if item.dtype.kind in "fiu":
                    found[name] = np.squeeze(np.asarray(item[()]))
            else:
                found[name] = load(item)
        found |= {key: value for key, value in group.attrs.items() if key.lower() in (*RATES, *STEPS)}
        return found

    with h5py.File(path, "r") as file:
        return _tree_channels(load(file), attributes)


def _tree_channels(
    tree: Mapping[str, Any], attributes: Mapping[str, Mapping[str, Any]], place: str = ""
) -> list[Raw]:
    """Channels of a folder of vectors and of the folders within it."""
    vectors = {name: value for name, value in tree.items() if _is_vector(value)}
    clock = next((name for name in vectors if name.lower() in TIME_NAMES), None)
    step = _step({name: value for name, value in tree.items() if np.ndim(value) == 0})
    channels: list[Raw] = []
    for name, value in _columns(vectors):
        if name == clock:
            continue
        own = attributes.get(place + name, {})
        texts = {key.lower(): _text(word) for key, word in own.items()}
        unit = next((texts[key] for key in ("unit", "units") if texts.get(key)), "")
        unit = unit or _text(tree.get(f"{name}_unit", ""))
        time = None
        if clock is not None and len(vectors[clock]) == len(value):
            time = np.asarray(vectors[clock], dtype=float)
        elif own_step := _step(own) or step:
            time = own_step * np.arange(len(value))
        channels.append(Raw(place.replace("/", ".") + name, unit, np.asarray(value, dtype=float), time))
    for name, value in tree.items():
        inner = value if isinstance(value, Mapping) else getattr(value, "__dict__", None)
        if isinstance(inner, Mapping) and not isinstance(value, np.ndarray):
            inner = {key: item for key, item in inner.items() if not key.startswith("_")}
            channels += _tree_channels(inner, attributes, f"{place}{name}/")
    return channels


def _columns(vectors: Mapping[str, np.ndarray]) -> Iterator[tuple[str, np.ndarray]]:
    """Vectors, and the columns of tables by number."""
    for name, value in vectors.items():
        if value.ndim == 1:
            yield name, value
        else:
            longer = value if value.shape[0] >= value.shape[1] else value.T
            yield from ((f"{name}_{place}", column) for place, column in enumerate(longer.T, 1))


def _step(scalars: Mapping[str, Any]) -> float | None:
    """The time from one sample to the next that a number of a known name gives [s]."""
    for name, value in scalars.items():
        if np.ndim(value) == 0 and name.lower() in (*RATES, *STEPS):
            with contextlib.suppress(TypeError, ValueError):
                number = float(value)
                if np.isfinite(number) and number > 0.0:
                    return 1.0 / number if name.lower() in RATES else number
    return None


def _text(value: Any) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def _is_numbers(values: Any) -> bool:
    return np.asarray(values).dtype.kind in "fiub" and np.asarray(values).ndim == 1


def _is_vector(value: Any) -> bool:
    return (
        isinstance(value, np.ndarray)
        and value.dtype.kind in "fiu"
        and value.ndim in (1, 2)
        and len(value) > 1
    )
