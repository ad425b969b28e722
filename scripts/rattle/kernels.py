"""The Fortran kernels for numpy arrays.

Every function takes float64 arrays (or Python floats) and returns float64 arrays of the same shape (or
floats). Another type or shape raises; nothing is cast silently. The equations are those of the paper in
their corrected form.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rattle import _kernels

CLASSES = ("quiet", "creep", "idle", "irregular")

__all__ = ["amplitude_spectrum", "classify", "lines", "pressure_group", "rupture_angle", "rupture_tangent"]


def _array(value: Any, name: str) -> np.ndarray:
    """The value as a float64 array that is not a copy; Python floats are welcome, other types are not."""
    if isinstance(value, float):
        return np.asarray(value)
    if not isinstance(value, np.ndarray):
        raise TypeError(f"{name} must be a numpy array of float64 or a float, not {type(value).__name__}")
    if value.dtype != np.float64:
        raise TypeError(f"{name} must be of type float64, not {value.dtype}")
    return value


def _elementwise(kernel: Any, *values: tuple[str, Any], options: tuple[Any, ...] = ()) -> Any:
    """Call a kernel of flat arrays of equal length for arrays of equal shape."""
    arrays = [_array(value, name) for name, value in values]
    shape = arrays[0].shape
    for (name, _), array in zip(values[1:], arrays[1:], strict=True):
        if array.shape != shape:
            raise ValueError(f"{name} has shape {array.shape}, {values[0][0]} has {shape}")
    flat = [np.ascontiguousarray(array).reshape(-1) for array in arrays]
    results = kernel(*flat, *options)
    if isinstance(results, tuple):
        return tuple(result.reshape(shape) if shape else float(result[0]) for result in results)
    return results.reshape(shape) if shape else float(results[0])


def rupture_tangent(a: Any, *, solver: str = "fast") -> Any:
    """t_e = tan x_e of eq (18) for the squeeze group A [-], any shape; error below 1e-13 max(1, |t_e|).

    solver: 'fast' (Newton) or 'successive' (the paper's successive substitution); both find the same root.
    """
    if solver not in ("fast", "successive"):
        raise ValueError(f"solver must be 'fast' or 'successive', not {solver!r}")
    return _elementwise(_kernels.wrap_rupture_tangent, ("a", a), options=(int(solver == "successive"),))


def rupture_angle(a: Any, *, solver: str = "fast") -> Any:
    """x_e [rad] of eq (18) for the squeeze group A [-], any shape."""
    tangent = np.arctan(rupture_tangent(a, solver=solver))
    return tangent if isinstance(a, np.ndarray) else float(tangent)


def pressure_group(tangent: Any, rupture_tangent: Any, a: Any) -> Any:
    """p*(xbar) of eq (16) at tan(xbar), for t_e and A; three arrays of one shape [-]."""
    return _elementwise(
        _kernels.wrap_pressure_group, ("tangent", tangent), ("rupture_tangent", rupture_tangent), ("a", a)
    )


def amplitude_spectrum(samples: Any) -> np.ndarray:
    """Single-sided amplitudes a_0 .. a_(n/2) of n equidistant samples, rectangular window, unit of the samples."""
    flat = _samples(samples, "samples")
    return _kernels.wrap_amplitude_spectrum(flat, flat.size // 2 + 1)


def lines(acceleration: Any, samples_per_period: int) -> np.ndarray:
    """a_n [m/s2]: amplitude of z'' at n f_exc for every n that the samples resolve; n = 1 comes first."""
    return classify(acceleration, samples_per_period)["harmonics"]


def classify(
    acceleration: Any,
    samples_per_period: int,
    *,
    line_threshold: float = 0.01,
    idle_lines: int = 20,
    quiet_limit: float = 0.35,
    irregular_limit: float = 0.01,
    noise_floor: float = 0.0,
) -> dict[str, Any]:
    """Class of a window of whole periods of z'' [m/s2], with the measures it rests on.

    noise_floor [m/s2]: a motion whose rms times sqrt(2) does not exceed it is at rest. A motion at rest is
    quiet and has no ratios: these are nan then.
    """
    samples = _samples(acceleration, "acceleration")
    if isinstance(samples_per_period, bool) or not isinstance(samples_per_period, (int, np.integer)):
        raise TypeError("samples_per_period must be an integer")
    if samples_per_period < 3 or samples.size % samples_per_period:
        raise ValueError(
            f"acceleration holds {samples.size} samples; that is no whole number of periods of {samples_per_period}"
        )
    limits = np.array([line_threshold, quiet_limit, irregular_limit, noise_floor], dtype=np.float64)
    harmonics, ratios, counts = _kernels.wrap_classify(
        samples, samples.size // samples_per_period, limits, int(idle_lines), (int(samples_per_period) - 1) // 2
    )
    moving = bool(counts[2])
    return {
        "rattle_class": CLASSES[counts[0] - 1],
        "line_count": int(counts[1]),
        "harmonic_distortion": float(ratios[0]) if moving else float("nan"),
        "irregular_fraction": float(ratios[1]) if moving else float("nan"),
        "reversals_per_period": float(ratios[2]),
        "sampling_sufficient": bool(counts[3]),
        "harmonics": harmonics,
    }


def _samples(value: Any, name: str) -> np.ndarray:
    """A contiguous, finite, one-dimensional float64 array with at least one sample."""
    array = _array(value, name)
    if array.ndim != 1 or array.size == 0:
        raise ValueError(f"{name} must be one-dimensional and not empty, its shape is {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} holds values that are not finite")
    return np.ascontiguousarray(array)
