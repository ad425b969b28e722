"""Checks of arguments before Fortran sees them. Nothing is cast; the messages name the argument."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np


def float_array(value: Any, name: str) -> np.ndarray:
    """The value as a float64 array that is not a copy; Python floats are welcome, other types are not."""
    if isinstance(value, float):
        return np.asarray(value, dtype=np.float64)
    if not isinstance(value, np.ndarray) or isinstance(value, np.ma.MaskedArray):
        raise TypeError(f"{name} must be a numpy array of float64 or a float, not {type(value).__name__}")
    if value.dtype != np.float64:
        raise TypeError(f"{name} must be of type float64, not {value.dtype}")
    return value


def finite_samples(value: Any, name: str) -> np.ndarray:
    """A contiguous, finite, one-dimensional float64 array with at least one sample."""
    array = float_array(value, name)
    if array.ndim != 1 or array.size == 0:
        raise ValueError(f"{name} must be one-dimensional and not empty, its shape is {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} holds values that are not finite")
    return np.ascontiguousarray(array)


def finite_numbers(positive: Collection[str] = (), **values: Any) -> np.ndarray:
    """Finite floats as an array in the order given; those named in `positive` must be so."""
    for name, value in values.items():
        if not isinstance(value, float):
            raise TypeError(f"{name} must be a float, not {type(value).__name__}")
        if not np.isfinite(value):
            raise ValueError(f"{name} must be finite")
        if name in positive and not value > 0.0:
            raise ValueError(f"{name} must be positive")
    return np.array(list(values.values()), dtype=np.float64)


def positive_count(value: Any, name: str) -> int:
    """One positive integer that Fortran can hold."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise TypeError(f"{name} must be an integer, not {type(value).__name__}")
    if not 1 <= value <= np.iinfo(np.int32).max - 1:
        raise ValueError(f"{name} must be a positive number below 2^31 - 1")
    return int(value)
