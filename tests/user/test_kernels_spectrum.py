"""Spectrum and class of made-up motions, against numpy."""

from __future__ import annotations

import numpy as np
import pytest
from kernel_module import kernels

PERIOD, PERIODS = 256, 8


def synthetic(lines: dict[float, float], phase: float = 0.3) -> np.ndarray:
    """Cosines at multiples of the forcing frequency."""
    angle = 2.0 * np.pi * np.arange(PERIOD * PERIODS) / PERIOD
    return sum(size * np.cos(ratio * angle + phase * ratio**2) for ratio, size in lines.items())


SIGNALS = {
    "quiet": {1.0: 10.0, 2.0: 1.0, 3.0: 0.05},
    "creep": {1.0: 6.0, 2.0: 8.0, 3.0: 6.0, 4.0: 4.0, 5.0: 0.03},
    "idle": {float(n): 20.0 * 0.85 ** (n - 1) for n in range(1, 36)},
    "irregular_so_far": {1.0: 6.0, 2.0: 8.0, 2.5: 3.0},
}


@pytest.mark.parametrize("name", sorted(SIGNALS))
def test_classify_agrees_with_numpy(name):
    samples = synthetic(SIGNALS[name])
    found = kernels.classify(samples, PERIOD)
    amplitude = 2.0 * np.abs(np.fft.rfft(samples)) / samples.size
    amplitude[[0, -1]] /= 2.0
    assert np.allclose(kernels.amplitude_spectrum(samples), amplitude, atol=1e-12)
    harmonics = amplitude[PERIODS::PERIODS][: (PERIOD - 1) // 2]
    assert np.allclose(found["harmonics"], harmonics, atol=1e-12)
    assert np.allclose(kernels.lines(samples, PERIOD), harmonics, atol=1e-12)
    assert found["reference_line"] == 1
    assert found["harmonic_count"] == int((harmonics > 0.01 * harmonics[0]).sum())
    distortion = np.sqrt((harmonics[1:] ** 2).sum()) / harmonics[0]
    assert found["harmonic_distortion"] == pytest.approx(distortion, rel=1e-10)
    irregular = 1.0 - (harmonics**2).sum() / (amplitude[1:] ** 2).sum()
    assert found["irregular_fraction"] == pytest.approx(irregular, abs=1e-12)
    expected = (
        "irregular_so_far"
        if irregular > 0.01
        else "quiet"
        if distortion < 0.35
        else "idle"
        if found["harmonic_count"] >= 20
        else "creep"
    )
    assert found["rattle_class"] == expected == name


@pytest.mark.parametrize(
    ("orbit", "expected"), [(None, "irregular_so_far"), (1, "irregular_so_far"), (2, "subharmonic")]
)
def test_known_orbit_of_a_motion_off_its_harmonics(orbit, expected):
    samples = synthetic(SIGNALS["irregular_so_far"])
    assert kernels.classify(samples, PERIOD, orbit_period=orbit)["rattle_class"] == expected
    regular = synthetic(SIGNALS["creep"])
    assert kernels.classify(regular, PERIOD, orbit_period=orbit)["rattle_class"] == "creep"


def test_reversals_of_a_plain_wave_and_rest():
    assert kernels.classify(synthetic({1.0: 1.0}), PERIOD)["reversals_per_period"] == 2.0
    assert kernels.classify(synthetic({3.0: 1.0, 1.0: 0.1}), PERIOD)["reversals_per_period"] == 6.0
    rest = kernels.classify(np.zeros(PERIOD), PERIOD)
    assert rest["rattle_class"] == "quiet" and np.isnan(rest["harmonic_distortion"])


def test_a_motion_at_rest_is_quiet_and_has_no_ratios():
    for samples, floor in ((np.zeros(PERIOD), 0.0), (1e-9 * synthetic(SIGNALS["irregular_so_far"]), 1e-6)):
        found = kernels.classify(samples, PERIOD, noise_floor=floor)
        assert found["rattle_class"] == "quiet"
        assert np.isnan(found["harmonic_distortion"]) and np.isnan(found["irregular_fraction"])
        assert found["reversals_per_period"] == 0.0 and found["harmonic_count"] == 0
