"""plot.py orders: cuts are the harmonics of single scenes, and measured ones lie where they were measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of
from script_calls import called_here

import rattle as package
from rattle.figures import orders, style

GEAR = """&gear
   teeth_1 = 19, teeth_2 = 37, normal_module = 2.2e-3, helix_angle_deg = 28.0, face_width = 0.016
   centre_distance = 0.070, loose_inertia = 8.9e-4, backlash = 9e-5, drag_torque = 0.08
/
&shaft speed_rpm = 900.0, orders = 2.0, 3.0, accelerations = 600.0, 100.0, phases = 0.0, 0.8 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 50.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver periods = 6, accuracy = 1e-6, samples_per_period = 2048 /
&spectrum periods = 2 /
"""
CAMPAIGN = """&campaign
   vary = 'shaft.speed_rpm', first = 800.0, last = 1200.0, count = 5, samples_per_period = 2048
   record = 'harmonics'
/
"""


@pytest.fixture(scope="module")
def result(tmp_path_factory, rattle: Path) -> Path:
    folder = tmp_path_factory.mktemp("orders")
    solved = package.run(GEAR + CAMPAIGN + "&scene task = 'campaign', name = 'run_up' /\n", folder=folder)
    return solved.result.path


def test_cuts_are_the_harmonics_of_single_scenes(result: Path, tmp_path: Path) -> None:
    """The orders 2 and 3 have the common order 1: harmonic n is engine order n at every speed."""
    cuts = orders.computed(package.read_campaign(result))
    assert cuts.orders == tuple(map(float, range(1, 9)))
    assert list(cuts.speeds) == [800.0, 900.0, 1000.0, 1100.0, 1200.0]
    for row, speed in ((0, 800.0), (3, 1100.0)):
        package.run(
            GEAR + "&scene name = 'one' /\n", set={"shaft.speed_rpm": speed}, folder=tmp_path, overwrite=True
        )
        alone = summary_of(tmp_path / "one.summary.nml")["harmonics"][:8]
        assert cuts.amplitudes[row] == pytest.approx(alone, rel=1e-6)


def test_curves_and_colours_are_levels_of_the_cuts(result: Path) -> None:
    campaign = package.read_campaign(result)
    cuts = orders.computed(campaign)
    measured = orders.Cuts(np.array([850.0, 950.0]), (2.0,), np.array([[1.0], [10.0]]))
    with style.house_style():
        figure = orders.draw(campaign, cuts, measured)
    above, below = figure.axes[:2]
    curve, marks = above.lines
    assert curve.get_label() == "order 2" and marks.get_label() == "order 2, measured"
    assert curve.get_ydata() == pytest.approx(20.0 * np.log10(np.array(campaign["harmonic_2"]) / 1e-6))
    assert list(marks.get_xdata()) == [850.0, 950.0]
    assert marks.get_ydata() == pytest.approx([120.0, 140.0])
    for order, mesh in enumerate(below.collections, 1):
        expected = 20.0 * np.log10(np.array(campaign[f"harmonic_{order}"]) / 1e-6)
        assert np.ma.getdata(mesh.get_array()).ravel() == pytest.approx(expected)
        # The middle of a cell at 1000 1/min lies at its order times 1000/60 Hz.
        corners = np.asarray(mesh.get_coordinates())
        middle = corners[:, 2:4].mean(axis=(0, 1))
        assert middle.tolist() == pytest.approx([1000.0, order * 1000.0 / 60.0])


@pytest.mark.parametrize("script", (("plot.py", "orders"), ("compare.py",)))
def test_differences_are_reported_in_decibels(script: tuple[str, ...], result: Path, tmp_path: Path) -> None:
    cuts = orders.computed(package.read_campaign(result))
    own = cuts.at(2.0).tolist()
    (tmp_path / "bench.csv").write_text(
        f"speed_rpm,order_2,order_11\n700,1,1\n800,{own[0] / 10.0!r},\n1000,{own[2] / 10.0!r},1\n"
    )
    code, said, complained = called_here(
        *script, result, "--measured", "bench.csv", "--format", "png", cwd=tmp_path
    )
    assert code == 0, complained
    lines = said.splitlines()
    assert lines[0] == "orders_run_up.png"
    assert lines[1:] == [
        "run_up, order 2: computed less measured +20.0 dB in the mean, +20.0 to +20.0 dB at 2 speeds",
        "run_up, order 11: measured, not computed",
    ]


def test_compare_draws_measured_cuts_alone(result: Path, tmp_path: Path) -> None:
    (tmp_path / "bench.csv").write_text("speed_rpm,order_2\n800,1\n900,1\n")
    for arguments, words in (
        ((result, result, "--measured", "bench.csv"), "--measured needs one result"),
        ((result, "--markdown", "--measured", "bench.csv"), "--markdown is for the table"),
        ((result, "--font-size", "8"), "--font-size is for the figure of --measured"),
        ((result, "--overwrite"), "--overwrite is for the figure of --measured"),
    ):
        code, _, complained = called_here("compare.py", *arguments, cwd=tmp_path)
        assert code == 2 and words in complained
    assert not list(tmp_path.glob("*.png"))


PLAIN = [(800.0, 1.5, 0.25), (900.0, np.nan, 0.5), (1000.0, 2.5, 0.75)]
# One table as benches write it: bytes, and what they are to the plain one.
WRITTEN = {
    "plain": b"speed_rpm,order_2,order_3\n800,1.5,0.25\n900,,0.5\n1000,2.5,0.75\n",
    "BOM and DOS ends": b"\xef\xbb\xbfspeed_rpm,order_2,order_3\r\n"
    b"800,1.5,0.25\r\n900,,0.5\r\n1000,2.5,0.75\r\n",
    "semicolons": b"speed_rpm;order_2;order_3\n800;1,5;0,25\n900;;0,5\n1000;2,5;0,75\n",
    "a row of units": b"speed;order_2;order_3\n1/min;m/s2;mm/s\xb2\n800;1,5;250\n900;;500\n1000;2,5;750\n",
    "units in the head": b"speed [1/s],order_2 (mm/s2),order_3_m/s2\n13.333333333333334,1500,.25\n15,,5d-1\n"
    b"16.666666666666668,2500,0.75\n",
    "comments": b"# Pr\xfcfstand\n\nspeed_rpm,order_2,order_3\n"
    b"# K\xf6ln\n800,1.5,0.25\n900,,0.5\n\n1000,2.5,0.75",
    "quotes": b'"speed_rpm","order_2","order_3"\n"800","1.5","0.25"\n"900","","0.5"\n"1000","2.5","0.75"\n',
    "separators at the end": b"speed_rpm,order_2,order_3,\n800,1.5,0.25,\n900,,0.5,\n1000,2.5,0.75,\n",
    "another order": b"order_3,speed_rpm,order_2\n0.25,800,1.5\n0.5,900,\n0.75,1000,2.5\n",
}


@pytest.mark.parametrize("form", WRITTEN)
def test_measured_cuts_are_read_as_benches_write_them(form: str, tmp_path: Path) -> None:
    path = tmp_path / "K\u00f6ln bench.csv"
    path.write_bytes(WRITTEN[form])
    cuts = orders.read_measured(path)
    assert sorted(cuts.orders) == [2.0, 3.0]
    found = np.column_stack([cuts.speeds, cuts.at(2.0), cuts.at(3.0)])
    np.testing.assert_allclose(found, PLAIN, rtol=1e-14)


@pytest.mark.parametrize(
    ("text", "words"),
    (
        ("", "bad.csv: the file is empty; its first line must name its columns, such as speed_rpm,order_2"),
        ("order_2\n1\n2\n", "bad.csv:1: the head has to be speed_rpm,order_2"),
        ("speed,order_2\n1,2\n", "bad.csv:1: column 1 (speed) is neither the speed nor an order"),
        ("speed_rpm,level\n1,2\n", "bad.csv:1: column 2 (level) is neither the speed nor an order"),
        ("speed_rpm,order_2,order_2\n1,2,3\n", "bad.csv:1: column 3 (order_2) is neither"),
        (
            "speed_rpm,order_2 [kN]\n800,1\n900,1\n",
            "bad.csv:1: column 2 (order_2 [kN]): it is in kN; m/s2 is needed",
        ),
        ("speed_rpm,order_2\n800,1\n900,x\n", "bad.csv:3: column 2: this is not a number"),
        ("speed_rpm,order_2\n\n800,1\n900,inf\n", "bad.csv:4: column 2: this is not a number"),
        ("speed_rpm,order_2\n800,1\n900,nan\n", "bad.csv:3: column 2: this is not a number"),
        ("speed_rpm,order_2\n800,1\n900,1,5\n", "bad.csv:3: the line has 3 columns, the header 2"),
        ("speed_rpm,order_2\n800,1\n,1\n", "bad.csv:3: a speed is missing"),
        ("speed_rpm,order_2\n800,1\n", "two speeds at least"),
        ("speed_rpm,order_2\n900,1\n800,1\n", "bad.csv:3: the speeds must ascend"),
        ("speed_rpm,order_2\n800,1\n900,-1\n", "bad.csv:3: an amplitude is negative"),
        ("speed_rpm,order_11\n800,1\n900,1\n", "has orders 11, the campaign 1, 2,"),
    ),
)
def test_bad_measurements_are_refused(text: str, words: str, result: Path, tmp_path: Path) -> None:
    (tmp_path / "bad.csv").write_text(text)
    code, _, complained = called_here("plot.py", "orders", result, "--measured", "bad.csv", cwd=tmp_path)
    assert code == 2 and words in complained and "Traceback" not in complained


def test_other_campaigns_are_refused(tmp_path: Path, rattle: Path) -> None:
    for change, words in (
        (("'harmonics'", "'acceleration_rms'"), "has no harmonics"),
        (
            (
                "'shaft.speed_rpm', first = 800.0, last = 1200.0",
                "'oil.temperature_celsius', first = 20, last = 60",
            ),
            "varies",
        ),
    ):
        text = GEAR + CAMPAIGN.replace(*change) + "&scene task = 'campaign', name = 'other' /\n"
        solved = package.run(text, folder=tmp_path, overwrite=True)
        code, _, complained = called_here("plot.py", "orders", solved.result.path, cwd=tmp_path)
        assert code == 2 and words in complained
