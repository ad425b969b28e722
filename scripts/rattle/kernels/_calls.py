"""Checks of arguments of Fortran kernels, and calls of those of numbers for numpy arrays of one shape.

Nothing is cast; the messages name the argument.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Collection, Mapping
from typing import Any, TypeVar, cast

import numpy as np

from rattle import _kernels

# What the arguments called "arrays" take. Results are Any: arrays, or a number where all arguments are.
Numbers = float | np.ndarray
Declared = TypeVar("Declared", bound=Callable[..., Any])


def elementwise(declared: Declared) -> Declared:
    """The compiled kernel of the same name, called as the declared function says, which needs no body.

    The parameters stand in the order of the kernel's arguments.
    """
    signature = inspect.signature(declared)

    @functools.wraps(declared)
    def call(*arguments: Any, **named: Any) -> Any:
        return evaluate(declared.__name__, signature.bind(*arguments, **named).arguments)

    return cast(Declared, call)


def evaluate(kernel: str, values: Mapping[str, Any]) -> Any:
    """Call a kernel by its name for arrays of equal shape; numbers stretch to it.

    values: argument by name, in the order of the kernel.
    """
    flat, shape = flat_arrays(values)
    # Where there is no film Fortran is asked for one, to learn how many results there are.
    rows = np.array(flat if 0 not in shape else [np.zeros(1)] * len(flat))
    results, count = _kernels.wrap_kernel(kernel, rows.T)
    if count == 0:
        raise ImportError(f"the compiled module has no {kernel}")
    columns = results.T[: abs(count)].astype(np.int32 if count < 0 else np.float64)
    found = tuple(shaped(column, shape) for column in columns)
    return found if count > 1 else found[0]


def flat_arrays(values: Mapping[str, Any]) -> tuple[list[np.ndarray], tuple[int, ...]]:
    """Arrays of equal shape as flat ones, numbers stretched to it, and that shape."""
    arrays = {name: float_array(value, name) for name, value in values.items()}
    first, shape = next(((name, array.shape) for name, array in arrays.items() if array.ndim), ("", ()))
    for name, array in arrays.items():
        if array.ndim and array.shape != shape:
            raise ValueError(f"{name} has shape {array.shape}, {first} has {shape}")
    return [np.broadcast_to(array, shape).reshape(-1) for array in arrays.values()], shape


def shaped(flat: np.ndarray, shape: tuple[int, ...]) -> Any:
    """A flat result in the shape of the arguments; a number where they were numbers."""
    if not shape:
        return flat[0].item()
    return (flat[:0] if 0 in shape else flat).reshape(shape)


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
