"""Spectra of columns, computed by the Fortran kernel."""

from __future__ import annotations

import numpy as np

from rattle.result import Result, ResultError


def column_spectrum(result: Result, name: str, window: int | None) -> tuple[np.ndarray, np.ndarray]:
    """Frequency ratio f/f_exc and single-sided amplitudes of the last `window` periods.

    The window holds whole periods, so a harmonic of the excitation falls on one bin exactly.
    """
    from rattle import kernels

    if result.samples_per_period < 2:
        raise ResultError(f"{result.path} holds too few samples a period for a spectrum.")
    samples = result.samples(name, result.window(window))
    amplitudes = np.asarray(kernels.amplitude_spectrum(samples))
    periods = samples.size // result.samples_per_period
    return np.arange(amplitudes.size) / periods, amplitudes
