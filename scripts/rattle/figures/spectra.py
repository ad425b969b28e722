"""Spectra of columns, computed by the Fortran kernel."""

from __future__ import annotations

import numpy as np

from rattle.result import Result, ResultError
from rattle.summary import Summary, read_summary


def better_summary(result: Result, window: int | None) -> Summary | None:
    """The summary of a series that is coarser than its motion, where it knows the lines of the same window.

    They come from more samples than the series has, or from integrals over the steps of the solution.
    """
    if not result.coarse or not result.summary_path.exists():
        return None
    summary = read_summary(result.summary_path)
    resolved = summary.get("sampling_sufficient", False) and "harmonics" in summary
    return summary if resolved and window in (None, summary["window_periods"]) else None


def harmonics_of(summary: Summary) -> tuple[np.ndarray, np.ndarray]:
    """Frequency ratio and amplitudes [m/s2] of the harmonics that a summary lists, behind a mean of zero."""
    amplitudes = np.concatenate(([0.0], np.atleast_1d(np.asarray(summary["harmonics"], dtype=float))))
    return np.arange(float(amplitudes.size)), amplitudes


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
