"""A tooth between two flanks, as a user describes it: reference R1, computed by independent code."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from outcomes import summary_of

R1 = """
&contact radius = 7.5e-3, length = 0.02, backlash = 1.0e-4 /
&lubricant viscosity = 0.05, pressure_viscosity = 2.0e-8 /
&kinematics rolling_speed = 2.14 /
&load
   mass = 0.45, steady_force = 5.0, gravity = 0.0, frequency = 26.7
   force_orders = 1, 2, 3, force_amplitudes = 7.9, 2.0, 0.8, force_phases = 0.0, 0.5, 1.1
/
&film law = 'iso-viscous', model = 'reynolds' /
&solver periods = 40, samples_per_period = 2048 /
&spectrum periods = 4 /
"""


def test_a_loose_tooth_crosses_its_gap_without_impacts(run, tmp_path: Path) -> None:
    (tmp_path / "loose.nml").write_text(R1)
    ended = run("loose.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    reported = summary_of(tmp_path / "results" / "loose.summary.nml")
    # Its largest load is 1.49 times the largest force.
    assert (
        reported["reversal"] is True
        and reported["verdict"] == "separation"
        and reported["double_sided"] is False
    )
    assert reported["harmonic_count"] == 89
    assert reported["film_minimum"] == pytest.approx(2.0385964e-06, rel=3e-5)
    assert reported["film_maximum"] == pytest.approx(9.5180665e-05, rel=3e-7)
    assert reported["harmonics"][:8] == pytest.approx(
        [1.0544934, 2.0593625, 1.5235086, 0.8887504, 1.8208022, 2.0759337, 1.2894884, 0.4725849], abs=2e-7
    )


def test_the_film_that_carries_the_load_tells_how_teeth_give_way(run, tmp_path: Path) -> None:
    """A load that rests on the coast flank is the mirror of one on the drive flank."""
    reported = []
    for force in ("5.0", "-5.0"):
        (tmp_path / "loose.nml").write_text(R1.replace("steady_force = 5.0", f"steady_force = {force}"))
        checked = run("--check", "loose.nml", cwd=tmp_path).stdout
        reported.append(float(re.search(r"deflection share at the steady film +(\S+)", checked)[1]))
    assert reported[0] == pytest.approx(reported[1], rel=1e-2) and reported[0] > 0.0


def test_no_static_load_is_needed_between_two_flanks(run, tmp_path: Path) -> None:
    for force in ("0.0", "-5.0"):
        (tmp_path / "loose.nml").write_text(R1.replace("steady_force = 5.0", f"steady_force = {force}"))
        assert run("--check", "loose.nml", cwd=tmp_path).returncode == 0
        (tmp_path / "loose.nml").write_text(
            (tmp_path / "loose.nml").read_text().replace(", backlash = 1.0e-4", "")
        )
        refused = run("--check", "loose.nml", cwd=tmp_path)
        assert refused.returncode == 2 and "the static load" in refused.stderr
