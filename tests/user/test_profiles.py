"""Pressures and films over the contact: written, read back, drawn, and refused where they make no sense."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from drawn import curves
from outcomes import summary_of

import rattle as package
from rattle.figures import animation, profiles, style
from rattle.outputs import write

GEAR = """&contact radius = 9.1269e-3, length = 0.018943, backlash = 110.0e-6, stiffness = 2.38e8 /
&lubricant viscosity = 0.0214299, pressure_viscosity = 1.57335e-8, viscosity_law = 'roelands' /
&kinematics rolling_speed = 2.83747 /
&load mass = 0.620931, steady_force = 2.04527, gravity = 0.0, frequency = 30.0, force_orders = 1, 2
      force_amplitudes = 5.6858, 1.5162, force_phases = 0.0, 0.0 /
&film law = 'elastohydrodynamic', model = 'resolved' /
&solver until = 'periods', periods = 3 /
&spectrum periods = 1 /
&output profiles = .true., columns = 'time', 'applied_force', 'film_thickness', 'acceleration', 'film_load',
        'coast_film', 'coast_load' /
"""


@pytest.fixture(scope="module")
def solved(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("profiles")
    package.run("&scene name = 'one' /\n" + GEAR, folder=folder)
    return folder


def test_profiles_are_those_of_the_impacts(solved: Path) -> None:
    result = package.read(solved / "one.rattle")
    reported = summary_of(solved / "one.summary.nml")
    found = profiles.profiles_of(result)
    count = {flank: reported[f"impacts_{name}"] for flank, name in ((1, "drive"), (2, "coast"))}
    assert [sum(one.flank == flank for one in found) for flank in (1, 2)] == [count[1], count[2]]
    assert [one.time for one in found] == sorted(one.time for one in found)
    for flank, name in ((1, "drive"), (2, "coast")):
        times = [one.time for one in found if one.flank == flank]
        # The end of a step, some 35 of them an impact of 2 % of a period, is reported.
        assert times == pytest.approx(np.atleast_1d(reported[f"impact_times_{name}"]), abs=2e-3 / 30.0)
        loads = [one.load for one in found if one.flank == flank]
        assert loads == pytest.approx(np.atleast_1d(reported[f"impact_loads_{name}"]), rel=4e-3)
    for one in found:
        columns = one.columns
        carried = 0.018943 * np.sum(columns["pressure"] * columns["weight"])
        assert carried == pytest.approx(one.load, rel=1e-12)
        assert columns["position"].size == 48 and (np.diff(columns["position"]) > 0.0).all()
        # Roelands' law at the pressure of each node, and the oil as given where there is none.
        exponent = 1.96e8 * 1.57335e-8 / (np.log(0.0214299) + 9.67)
        grown = (1.0 + columns["pressure"] / 1.96e8) ** exponent
        expected = 0.0214299 * np.exp((np.log(0.0214299) + 9.67) * (grown - 1.0))
        np.testing.assert_allclose(columns["viscosity"], expected, rtol=1e-12)
        # Half an ellipse that carries the load on its width.
        half = np.sqrt(8.0 * one.load * 9.1269e-3 / (np.pi * 226.0e9 * 0.018943))
        height = 2.0 * one.load / (np.pi * half * 0.018943)
        ellipse = height * np.sqrt(np.maximum(0.0, 1.0 - (columns["position"] / half) ** 2))
        np.testing.assert_allclose(columns["hertzian_pressure"], ellipse, atol=1e-5 * height)
    strongest = max(found, key=lambda one: one.pressure.max())
    assert strongest.pressure.max() == pytest.approx(1e-6 * reported["pressure_maximum"], rel=0.03)
    assert strongest.film.min() == pytest.approx(1e6 * reported["film_minimum"], rel=0.2)
    assert reported["film_minimum"] < reported["film_at_pressure_maximum"] and reported[
        "pressure_resolved"
    ] in (
        True,
        False,
    )
    assert reported["central_film"] == pytest.approx(
        1e-6 * np.interp(0.0, strongest.place, strongest.film), rel=0.05
    )


def test_a_summary_knows_its_profiles(solved: Path, tmp_path: Path) -> None:
    for name in ("one.rattle", "one.summary.nml", "one.profiles.rattle"):
        (tmp_path / name).write_bytes((solved / name).read_bytes())
    assert package.read_summary(tmp_path / "one.summary.nml")["status"] == "complete"
    damaged = bytearray((tmp_path / "one.profiles.rattle").read_bytes())
    damaged[-5] ^= 1
    (tmp_path / "one.profiles.rattle").write_bytes(damaged)
    with pytest.raises(package.ResultError, match="damaged"):
        package.read(tmp_path / "one.profiles.rattle")["pressure"].sum()


@pytest.mark.long
def test_figure_and_moving_picture_show_them(solved: Path, tmp_path: Path) -> None:
    result = package.read(solved / "one.rattle")
    shown = profiles.most_loaded(profiles.profiles_of(result))
    with style.house_style():
        figure = profiles.draw(result, "one")
        above, below = figure.axes
        drawn = curves(above)
        assert len(drawn) == 2 * len(shown) == 4 and len(curves(below)) == 2
        for one, (place, pressure), (_, dry) in zip(shown, drawn[0::2], drawn[1::2], strict=True):
            np.testing.assert_allclose(place[:: profiles.BETWEEN], one.place, rtol=1e-12)
            np.testing.assert_allclose(pressure[:: profiles.BETWEEN], one.pressure, rtol=1e-9, atol=1e-9)
            # The top of a narrow dry contact lies between two of the 48 nodes, 2.8 % above both.
            assert dry.max() == pytest.approx(one.dry.max(), rel=0.04) and dry.max() >= one.dry.max()
        movie = animation.moving_pictures(result, "one")
    (path,) = write([(tmp_path / "one.gif", movie)], overwrite=False)
    assert path.read_bytes()[:3] == b"GIF"


def test_phases_of_the_last_period(run, tmp_path: Path) -> None:
    (tmp_path / "one.nml").write_text(
        GEAR.replace("profiles = .true.", "profiles = .true., profile_count = 8")
    )
    ended = run("--verbose", "--output", "out", "--set", "spectrum.verify=false", "one.nml", cwd=tmp_path)
    assert ended.returncode == 0 and "out/one.profiles.rattle" in ended.stdout, ended.stderr
    found = profiles.profiles_of(package.read(tmp_path / "out/one.rattle"))
    phases = [one.time * 30.0 - 2.0 for one in found]
    wanted = np.repeat(np.arange(1, 9) / 8.0, 2)
    assert len(found) == 16 and (np.array(phases) >= wanted - 1e-9).all()
    assert (np.array(phases) < wanted + 0.02).all()
    assert [one.flank for one in found] == [1, 2] * 8


@pytest.mark.parametrize(
    ("old", "new", "message"),
    (
        ("model = 'resolved'", "model = 'closure'", r":9: &output profiles: this key is used only with"),
        (
            ".true.,",
            ".true., profile_phases = 0.5, 0.25,",
            r":9: &output profile_phases: each phase has to be",
        ),
        (
            ".true.,",
            ".true., profile_phases = 0.5, profile_count = 4,",
            r":9: &output profile_count: it excludes output.profile_phases",
        ),
        (
            "profiles = .true.,",
            "profile_count = 4,",
            r":9: &output profile_count: this key is used only with",
        ),
        (".true.,", ".true., profile_phases = 1.5,", r":9: &output profile_phases: .*1"),
    ),
)
def test_what_makes_no_sense_is_refused(old: str, new: str, message: str, run, tmp_path: Path) -> None:
    (tmp_path / "one.nml").write_text(GEAR.replace(old, new))
    ended = run("one.nml", cwd=tmp_path)
    assert ended.returncode == 2 and re.search(message, ended.stderr), ended.stderr
