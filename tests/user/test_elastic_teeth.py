"""Elastic teeth, as a user describes them: one key more, resumed, swept, in campaigns, by both methods."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

import rattle

# Reference S5: case R1 of two flanks with 5e7 N/m on both of them, computed by independent code.
S5 = """
&contact radius = 7.5e-3, length = 0.02, backlash = 1.0e-4, stiffness = 5.0e7 /
&lubricant viscosity = 0.05, pressure_viscosity = 2.0e-8 /
&kinematics rolling_speed = 2.14 /
&load
   mass = 0.45, steady_force = 5.0, gravity = 0.0, frequency = 26.7
   force_orders = 1, 2, 3, force_amplitudes = 7.9, 2.0, 0.8, force_phases = 0.0, 0.5, 1.1
/
&film law = 'iso-viscous', model = 'reynolds' /
&solver periods = 30, samples_per_period = 512 /
&spectrum periods = 4 /
&output
   columns = 'time', 'film_thickness', 'acceleration', 'film_load', 'coast_film', 'coast_load',
   'gear_position'
/
"""


def test_gear_films_and_loads_are_those_of_the_reference(run, tmp_path: Path) -> None:
    (tmp_path / "teeth.nml").write_text(S5)
    ended = run("teeth.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    reported = summary_of(tmp_path / "results" / "teeth.summary.nml")
    assert reported["gear_position_maximum"] == pytest.approx(9.5334473e-05, rel=1e-5)
    assert reported["coast_film_minimum"] == pytest.approx(4.8281494e-06, rel=1e-4)
    assert reported["coast_load_maximum"] == pytest.approx(8.8322, rel=2e-4)
    assert (
        reported["reversal"] is True
        and reported["double_sided"] is False
        and reported["verification"] == "verified"
    )
    assert len(reported["floquet_multipliers"]) == 8
    result = rattle.read(tmp_path / "results" / "teeth.rattle")
    compression = np.array(result["film_thickness"]) - np.array(result["gear_position"])
    assert np.array(result["film_load"]) == pytest.approx(5.0e7 * compression, rel=1e-9, abs=1e-9)


def test_newmark_is_refused(run, tmp_path: Path) -> None:
    (tmp_path / "teeth.nml").write_text(S5.replace("&solver", "&solver method = 'newmark',"))
    refused = run("--check", "teeth.nml", cwd=tmp_path)
    assert refused.returncode == 2
    assert "the paper's method is for the rigid teeth of the paper" in refused.stderr
    assert "leave contact.stiffness out" in refused.stderr


def test_a_resumed_run_is_the_whole_one(run, tmp_path: Path) -> None:
    whole = S5.replace("&solver", "&solver starts = 1,")
    (tmp_path / "teeth.nml").write_text(whole.replace("periods = 30", "periods = 8"))
    assert run("teeth.nml", cwd=tmp_path).returncode == 0
    (tmp_path / "teeth.nml").write_text(whole)
    assert run("teeth.nml", "--resume", cwd=tmp_path).returncode == 0
    assert run("teeth.nml", "--output", "whole", cwd=tmp_path).returncode == 0
    resumed, whole = (rattle.read(tmp_path / place / "teeth.rattle") for place in ("results", "whole"))
    for name in ("film_thickness", "acceleration", "coast_load", "gear_position"):
        assert np.array_equal(np.array(resumed[name]), np.array(whole[name]))


def test_a_campaign_over_the_stiffness_has_the_same_rows_in_any_company(run, tmp_path: Path) -> None:
    campaign = S5.replace("&film", "&scene task = 'campaign' /\n&film").replace(
        S5[S5.index("&output") :],
        "&campaign vary = 'contact.stiffness', 'contact.backlash', scale = 'logarithmic', 'logarithmic', "
        "first = 1e7, 2e-5, last = 1e10, 2e-4, count = 5, 3, "
        "record = 'rattle_class', 'film_minimum', 'double_sided', "
        "'gear_position_maximum', 'film_force_rms' /\n",
    )
    (tmp_path / "teeth.nml").write_text(campaign)
    for threads, place in (("1", "one"), ("2", "two")):
        ended = run("teeth.nml", "--output", place, "--threads", threads, cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
    one, two = ((tmp_path / place / "teeth.rattle").read_bytes() for place in ("one", "two"))
    assert one == two


def test_a_sweep_carries_the_springs_along(run, repository: Path, tmp_path: Path) -> None:
    """Films that rupture in flight: a spring that met its film anew would throw the tooth away."""
    scene = repository / "input" / "stiff_or_not.nml"
    settings = ("film.law=piezo-viscous", "sweep.first=1.3e8", "sweep.last=1.0e8", "sweep.count=4")
    given = [word for setting in settings for word in ("--set", setting)]
    assert run(scene, *given, "--output", tmp_path, cwd=tmp_path).returncode == 0
    swept = rattle.read(tmp_path / "stiff_or_not.rattle").frame()
    assert set(swept.status_word) == {"steady"} and set(swept.orbit_period) == {2.0}
    assert swept.film_maximum.between(1.5e-5, 3.5e-5).all()
    for _, both in swept.groupby("stiffness"):
        assert np.ptp(both.acceleration_maximum) < 1e-4 * both.acceleration_maximum.max()


# A tooth so soft that its compression is hundreds of films: tens of thousands of steps a period, whose
# rounding disturbs the period map.
SOFT = """
&contact radius = 0.0158551134, length = 3.42004741e-3, backlash = 9.3876104e-5, stiffness = 3.1331994e6 /
&lubricant viscosity = 0.0334465569, pressure_viscosity = 1.94882791e-8 /
&kinematics entrainment_speed = 0.135652346 /
&load
   mass = 0.0160102177, steady_force = 3.40580006, gravity = 0.0, force_amplitude = 44.8895953
   frequency = 23.3872855
/
&film law = 'iso-viscous', model = 'reynolds', initial_film = 1.41290851e-6, initial_velocity = 0.0 /
&solver periods = 14, samples_per_period = 128 /
&spectrum periods = 1 /
"""


# The tooth hits its flank with 0.19 m/s through a film of 24 nm where a period begins, and moves 0.4 mm in a
# period:
# what rounding leaves of its velocity is much against that film and nothing against the velocity.
HARD = """
&contact radius = 2.20778e-3, length = 0.01475016, backlash = 3.705e-4, stiffness = 3.15849e6 /
&lubricant viscosity = 6.852661e-3, pressure_viscosity = 1.444374e-8 /
&kinematics entrainment_speed = 0.3047978 /
&load
   mass = 0.013710266, steady_force = -19.86671, gravity = 0.0, force_amplitude = 66.45123612
   frequency = 5.42623530
/
&film law = 'iso-viscous', model = 'reynolds', initial_velocity = 0.0 /
&solver accuracy = 1.0e-6, samples_per_period = 128, periods = 7 /
&spectrum periods = 1 /
"""


@pytest.mark.long
@pytest.mark.parametrize(
    ("text", "multiplier", "error"),
    # The second one by differences of 1e-3 and of 1e-5: the same to 1e-3.
    [(SOFT, -0.15366, 1e-3), (HARD, -4.02e-3, 1e-2)],
    ids=["soft", "hard"],
)
def test_a_motion_of_very_many_steps_repeats_after_its_own_period(
    text: str, multiplier: float, error: float, run, tmp_path: Path
) -> None:
    (tmp_path / "soft.nml").write_text(text)
    assert run("soft.nml", cwd=tmp_path).returncode == 0
    reported = summary_of(tmp_path / "results" / "soft.summary.nml")
    assert reported["orbit_period"] == 1 and reported["orbit_stability"] == "stable"
    assert reported["floquet_multipliers"][0] == pytest.approx(multiplier, rel=error)


# The tooth crosses between its flanks where a period begins: its films are thick there, and one of the
# springs is all but released.
CROSSING = """
&contact radius = 2.2078e-3, length = 0.01475, backlash = 3.705e-4, stiffness = 3.1585e6 /
&lubricant viscosity = 0.0685, pressure_viscosity = 1.4444e-8 /
&kinematics entrainment_speed = 0.3048 /
&load mass = 0.01371, steady_force = -19.8667, gravity = 0.0, force_amplitude = 25.0, frequency = 40.0 /
&film law = 'iso-viscous', model = 'reynolds', initial_velocity = 0.0 /
&solver accuracy = 1.0e-11, samples_per_period = 512, periods = 30 /
&spectrum periods = 8 /
&output columns = 'time', 'squeeze_velocity' /
"""


@pytest.mark.long
def test_a_multiplier_is_the_rate_at_which_motions_approach_each_other(run, tmp_path: Path) -> None:
    (tmp_path / "one.nml").write_text(CROSSING)
    assert run("one.nml", cwd=tmp_path).returncode == 0
    reported = summary_of(tmp_path / "results" / "one.summary.nml")
    assert reported["orbit_period"] == 1 and reported["orbit_stability"] == "stable"
    begun = CROSSING.replace("periods = 30", "periods = 4").replace("periods = 8", "periods = 4")
    velocities = []
    for name, start in (("slow", "0.0"), ("fast", "0.1")):
        (tmp_path / f"{name}.nml").write_text(
            begun.replace("initial_velocity = 0.0", f"initial_velocity = {start}")
        )
        assert run(f"{name}.nml", cwd=tmp_path).returncode == 0
        result = rattle.read(tmp_path / "results" / f"{name}.rattle")
        velocities.append(np.array(result["squeeze_velocity"])[::512])
    apart = velocities[1] - velocities[0]
    # The faster rates have died away after three periods: 3e-4 of the second ratio, 1e-5 of the fourth.
    assert reported["floquet_multipliers"][0] == pytest.approx(apart[4] / apart[3], rel=3e-4)
