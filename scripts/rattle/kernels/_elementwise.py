"""Fortran kernels of flat arrays of one length, called for numpy arrays of one shape."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import numpy as np

from rattle import _kernels
from rattle.kernels._arguments import float_array

Declared = TypeVar("Declared", bound=Callable[..., Any])


def elementwise(declared: Declared) -> Declared:
    """The compiled kernel of the same name, called as the declared function says, which needs no body.

    The parameters stand in the order of the kernel's arguments.
    """
    kernel = getattr(_kernels, f"wrap_{declared.__name__}", None)
    if kernel is None:
        raise ImportError(f"the compiled module has no {declared.__name__}")
    signature = inspect.signature(declared)

    @functools.wraps(declared)
    def call(*arguments: Any, **named: Any) -> Any:
        return evaluate(kernel, signature.bind(*arguments, **named).arguments)

    return call


def evaluate(kernel: Callable[..., Any], values: Mapping[str, Any], *options: int) -> Any:
    """Call a kernel of flat arrays of equal length for arrays of equal shape; numbers stretch to it.

    values: argument by name, in the order of the kernel. options: what the kernel takes behind the arrays.
    """
    arrays = {name: float_array(value, name) for name, value in values.items()}
    first, shape = next(((name, array.shape) for name, array in arrays.items() if array.ndim), ("", ()))
    for name, array in arrays.items():
        if array.ndim and array.shape != shape:
            raise ValueError(f"{name} has shape {array.shape}, {first} has {shape}")
    flat = [np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(-1) for array in arrays.values()]
    empty = 0 in shape
    if empty:  # Fortran is asked for one film, to learn the number and types of the results
        flat = [np.zeros(1) for _ in flat]
    found = kernel(*flat, *options)
    results = tuple(
        (result[:0] if empty else result).reshape(shape) if shape else result[0].item()
        for result in (found if isinstance(found, tuple) else (found,))
    )
    return results if isinstance(found, tuple) else results[0]
