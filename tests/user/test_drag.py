"""Drag and excitation that follow speed and temperature: computed, from tables, in every kind of task."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

import rattle as package
from rattle import outputs, rerun

GEAR = """&gear
   teeth_1 = 19, teeth_2 = 37, normal_module = 2.2e-3, helix_angle_deg = 28.0, face_width = 0.016
   centre_distance = 0.070, loose_inertia = 8.9e-4, backlash = 9e-5, tooth_stiffness = 14e9
"""
COMPUTED = """   bearing_mean_diameter = 0.038, immersion_depth = 0.030730400709
   synchroniser_cones = 2, synchroniser_diameter = 0.062, synchroniser_width = 0.008
   synchroniser_gap = 0.2e-3
"""
PLAIN = COMPUTED + "   bearing_width = 0.02, bearing_clearance = 3e-5\n"
TABULATED = "   drag_table = 'drag.csv'\n"
ORDERS = "&shaft speed_rpm = 800.0, orders = 2.0, 4.0, accelerations = 600.0, 100.0, phases = 0.0, 0.8 /\n"
RUN_UP = "&shaft speed_rpm = 800.0, table = 'run_up.csv' /\n"
REST = """&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 50.0 /
&film law = 'iso-viscous', model = 'reynolds' /
"""
SHORT = (
    "&solver periods = 6, starts = 1, accuracy = 1e-6, samples_per_period = 256 /\n&spectrum periods = 2 /\n"
)
# A sweep begins with the motion from rest alone: it refuses the key.
SWEPT = SHORT.replace(" starts = 1,", "")
DRAG_ROWS = ["600,20,.16", "600,60,.05", "1000,20,.20", "1000,60,.07"]
RUN_UP_ROWS = ["600,900,0,120,3", "1000,600,.2,100,-3", "2000,500,.4,150,-2"]
DRAG_HEAD = "speed_rpm,temperature_celsius,torque"
RUN_UP_HEAD = "speed_rpm,acceleration_2,phase_2,acceleration_4,phase_4"
RECORD = (
    "record = 'drag_torque', 'drag_bearing', 'drag_synchroniser', 'drag_churning', 'inertia_ratio', "
    "'film_minimum', 'film_force_rms', samples_per_period = 256\n"
)
REPORTED = ("drag_torque", "drag_bearing", "drag_synchroniser", "drag_churning", "inertia_ratio")


def scene(drag: str, shaft: str = ORDERS, rest: str = SHORT) -> str:
    return GEAR + drag + "/\n" + shaft + REST + rest


def table(path: Path, head: str, rows: list[str], end: str = "\n") -> None:
    path.write_text(end.join([head, *rows, ""]))


@pytest.fixture
def call(run, tmp_path: Path):
    """Writes an input beside both tables and runs it."""
    table(tmp_path / "drag.csv", DRAG_HEAD, DRAG_ROWS)
    table(tmp_path / "run_up.csv", RUN_UP_HEAD, RUN_UP_ROWS)

    def call(text: str, *options: str, settings: tuple[str, ...] = (), ends: int = 0):
        (tmp_path / "pair.nml").write_text(text)
        words = [word for setting in settings for word in ("--set", setting)]
        ended = run(*options, *words, "pair.nml", cwd=tmp_path, timeout=120.0)
        assert ended.returncode == ends, ended.stderr
        return ended

    return call


def summary(call, tmp_path: Path, text: str, *settings: str) -> dict:
    call(text, "--overwrite", settings=settings)
    return summary_of(tmp_path / "results" / "pair.summary.nml")


def derived(text: str) -> dict[str, float]:
    return {key: float(value) for key, value in re.findall(r"^! derived: (\S+) = ([-+.\dE]+)", text, re.M)}


def test_check_prints_each_contribution(call) -> None:
    """Cases D1 and D2, and what their sum does against the inertia."""
    text = scene(COMPUTED)
    for temperature, parts, ratio in (
        (-20, (0.379199850795, 1.35986651878, 0.0843236932516, 1.82339006283), "stays on its flank"),
        (100, (0.00821821385238, 0.00501152968815, 0.0228524999855, 0.0360822435261), "leaves its flank"),
    ):
        reported = call(text, "--check", settings=(f"oil.temperature_celsius={temperature}",)).stdout
        found = derived(reported)
        names = ("gear.drag_bearing", "gear.drag_synchroniser", "gear.drag_churning", "gear.drag_torque")
        assert [found[name] for name in names] == pytest.approx(parts, rel=1e-9)
        assert re.search(r"^! drag torque .* N m: bearing .*, synchroniser .*, churning ", reported, re.M)
        assert re.search(rf"^! inertia ratio Lambda +[\d.]+: without oil the tooth {ratio}$", reported, re.M)
        assert found["gear.contact_ratio"] == pytest.approx(1.351943473539, rel=1e-12)
        assert found["gear.profile_shift_sum"] == pytest.approx(0.107257065031, rel=1e-11)
        assert found["gear.overlap_ratio"] == pytest.approx(1.0868177434, rel=1e-9)


def test_the_inertia_ratio_is_that_of_the_largest_deceleration(call, tmp_path: Path) -> None:
    """J_2 (z_1/z_2) max(-theta'') over the drag, as sampled finely; half of it under half of the motion."""
    found = summary(call, tmp_path, scene(COMPUTED))
    turn = np.linspace(0.0, 2.0 * np.pi, 2_000_001)
    deceleration = -(600.0 * np.cos(turn) + 100.0 * np.cos(2.0 * turn + 0.8)).min()
    expected = 8.9e-4 * 19.0 / 37.0 * deceleration / found["drag_torque"]
    assert found["inertia_ratio"] == pytest.approx(expected, rel=1e-11)
    half = summary(call, tmp_path, scene(COMPUTED), "load.force_scale=0.5")
    assert half["inertia_ratio"] == pytest.approx(0.5 * expected, rel=1e-11)
    assert half["drag_torque"] == found["drag_torque"]
    parts = found["drag_bearing"] + found["drag_synchroniser"] + found["drag_churning"]
    assert parts == pytest.approx(found["drag_torque"], rel=1e-14)


def test_tables_are_followed_between_their_rows(call) -> None:
    """Cases E1 and E2."""
    reported = call(scene(TABULATED, RUN_UP), "--check", settings=("shaft.speed_rpm=700",)).stdout
    assert derived(reported)["gear.drag_torque"] == pytest.approx(0.08375, rel=1e-14)
    (amplitudes,) = re.findall(r"^! derived: shaft.accelerations = (.*) rad/s2$", reported, re.M)
    assert [float(word) for word in amplitudes.split(",")] == pytest.approx([825.0, 115.0], rel=1e-14)
    (phases,) = re.findall(r"^! derived: shaft.phases = (.*) rad$", reported, re.M)
    assert [float(word) for word in phases.split(",")] == pytest.approx([0.05, 3.07079632679], rel=1e-11)
    scaled = call(scene(TABULATED, RUN_UP), "--check", settings=("shaft.speed_rpm=700", "gear.drag_scale=3"))
    assert derived(scaled.stdout)["gear.drag_torque"] == pytest.approx(0.25125, rel=1e-14)


def test_tables_as_people_write_them(call, tmp_path: Path) -> None:
    """Columns and rows of a grid in any order, comments, quotes, ends of lines of Windows, halves."""
    table(
        tmp_path / "drag.csv",
        '# bench 3\r\n"torque", "speed_rpm", "temperature_celsius"',
        [".20,1000,20", ".05,600,60", "", ".07,1000,60", ".16,600,20"],
        "\r\n",
    )
    table(tmp_path / "run_up.csv", "acceleration_0.5,speed_rpm", ["0,600", "50,1000"])
    reported = derived(call(scene(TABULATED, RUN_UP), "--check", settings=("shaft.speed_rpm=700",)).stdout)
    assert reported["gear.drag_torque"] == pytest.approx(0.08375, rel=1e-14)
    assert reported["shaft.accelerations"] == pytest.approx(12.5, rel=1e-14)
    assert reported["load.frequency"] == pytest.approx(0.5 * 700.0 / 60.0, rel=1e-14)
    assert reported["shaft.phases"] == 0.0


def test_tables_in_other_units(call, tmp_path: Path) -> None:
    """Speeds in Hz, temperatures in K, torques in N mm, angles in degrees; decimal commas, a row of units."""
    drag = [[float(word) for word in row.split(",")] for row in DRAG_ROWS]
    table(
        tmp_path / "drag.csv",
        "speed [Hz];temperature_K;torque\n;;N mm",
        [f"{n / 60.0!r};{t + 273.15!r};{1e3 * q!r}".replace(".", ",") for n, t, q in drag],
    )
    run_up = [[float(word) for word in row.split(",")] for row in RUN_UP_ROWS]
    table(
        tmp_path / "run_up.csv",
        "speed_rpm,acceleration_2 [krad/s2],phase_2_deg,acceleration_4 (rad/s2),phase_4",
        [f"{n},{a / 1e3!r},{math.degrees(p)!r},{b},{q}" for n, a, p, b, q in run_up],
    )
    text = scene(TABULATED, RUN_UP)
    reported = call(text, "--check", settings=("shaft.speed_rpm=700",)).stdout.replace("krad", "rad")
    assert derived(reported)["gear.drag_torque"] == pytest.approx(0.08375, rel=1e-12)
    (amplitudes,) = re.findall(r"^! derived: shaft.accelerations = (.*) rad/s2$", reported, re.M)
    assert [float(word) for word in amplitudes.split(",")] == pytest.approx([825.0, 115.0], rel=1e-14)
    (phases,) = re.findall(r"^! derived: shaft.phases = (.*) rad$", reported, re.M)
    assert [float(word) for word in phases.split(",")] == pytest.approx([0.05, 3.07079632679], rel=1e-11)
    assert "drag.csv: column 2 (temperature_K): its K are converted to degC" in reported


@pytest.mark.parametrize(
    ("head", "rows", "words"),
    [
        ("speed_rpm,temperature,torque", DRAG_ROWS, "drag.csv:1: there is no column temperature_celsius"),
        (DRAG_HEAD + ",note", [row + ",1" for row in DRAG_ROWS], "drag.csv:1: column 4: its name is none of"),
        ("speed_rpm,temperature_celsius,torque,torque", [r + ",1" for r in DRAG_ROWS], "column 4: its name"),
        (
            "600,20,.16",
            DRAG_ROWS,
            "drag.csv:1: the first line holds numbers; it must name the columns, such as",
        ),
        (
            DRAG_HEAD,
            [*DRAG_ROWS, "600,60,.06"],
            "drag.csv:6: columns 1 and 2: an earlier row has this speed",
        ),
        (DRAG_HEAD, DRAG_ROWS[:3], "drag.csv: the grid has a hole: there is no row with speed_rpm 1000.0"),
        (DRAG_HEAD, ["600,20,nan", *DRAG_ROWS[1:]], "drag.csv:2: column 3: this is not a number"),
        (DRAG_HEAD, [DRAG_ROWS[0], "600,60,", *DRAG_ROWS[2:]], "drag.csv:3: column 3: a number is missing"),
        (DRAG_HEAD, [DRAG_ROWS[0], "600,60,inf", *DRAG_ROWS[2:]], "drag.csv:3: column 3: this is not a num"),
        (
            DRAG_HEAD,
            [DRAG_ROWS[0], "600,60", *DRAG_ROWS[2:]],
            "drag.csv:3: the line has 2 columns, the header 3",
        ),
        (
            DRAG_HEAD,
            ["600,20,0,16", "600,60,0,05"],
            "drag.csv:2: the line has 4 columns, the header 3: decimal commas are read only where semicolons",
        ),
        (DRAG_HEAD.replace(",", ";"), DRAG_ROWS, "drag.csv:2: the line has 1 columns, the header 3"),
        (f"{DRAG_HEAD} [V]", DRAG_ROWS, "drag.csv:1: column 3 (torque [V]): it is in V; N m is needed"),
        (
            DRAG_HEAD,
            [r.replace(",", ";") for r in DRAG_ROWS],
            "drag.csv:2: the line has 1 columns, the header 3",
        ),
        (
            DRAG_HEAD,
            ["-600,20,.16", *DRAG_ROWS[1:]],
            "drag.csv:2: column 1 (speed_rpm): -600.0 is not allowed",
        ),
        (
            DRAG_HEAD,
            ["600,-200,.16", "600,60,1"],
            "drag.csv:2: column 2 (temperature_celsius): -200.0 is not",
        ),
        (DRAG_HEAD, [], "drag.csv:1: there is no line of numbers after the header"),
        (DRAG_HEAD, ["600,20,.16"], "drag.csv:2: a table needs two rows at least"),
    ],
)
def test_bad_drag_tables_are_refused(head: str, rows: list[str], words: str, call, tmp_path: Path) -> None:
    table(tmp_path / "drag.csv", head, rows)
    ended = call(scene(TABULATED), "--check", ends=2)
    assert words in ended.stderr, ended.stderr


@pytest.mark.parametrize(
    ("head", "rows", "words"),
    [
        ("speed,acceleration_2", ["600,1", "700,2"], "run_up.csv:1: there is no column speed_rpm"),
        ("speed_rpm", ["600", "700"], "run_up.csv:1: there is no column of an order"),
        (
            "speed_rpm,acceleration",
            ["600,1", "700,2"],
            "run_up.csv:1: column 2: its name is none of speed_rpm",
        ),
        (
            "speed_rpm,acceleration_x",
            ["600,1", "700,2"],
            "run_up.csv:1: column 2: its name is none of speed_rpm",
        ),
        (
            "speed_rpm,acceleration_0",
            ["600,1", "700,2"],
            "run_up.csv:1: column 2: its name is none of speed_rpm",
        ),
        (
            "speed_rpm,acceleration_2,acceleration_2.0",
            ["600,1,1", "700,2,2"],
            "column 3: this order is there",
        ),
        (
            "speed_rpm,acceleration_2,phase_4",
            ["600,1,1", "700,2,2"],
            "column 3: it is a phase of an order that",
        ),
        (
            "speed_rpm,acceleration_2,phase_2,phase_2",
            ["600,1,1,1", "700,2,2,1"],
            "column 4: the phase of this",
        ),
        (
            RUN_UP_HEAD,
            [RUN_UP_ROWS[1], RUN_UP_ROWS[0]],
            "run_up.csv:3: column 1 (speed_rpm): the speeds must a",
        ),
        (
            RUN_UP_HEAD,
            [RUN_UP_ROWS[0], RUN_UP_ROWS[0]],
            "run_up.csv:3: column 1 (speed_rpm): the speeds must a",
        ),
        (RUN_UP_HEAD, RUN_UP_ROWS[:1], "run_up.csv:2: a table needs two rows at least"),
        (
            RUN_UP_HEAD,
            ["600,-900,0,120,3", RUN_UP_ROWS[1]],
            "run_up.csv:2: column 2 (acceleration_2): -900.0 is",
        ),
        (
            RUN_UP_HEAD,
            [RUN_UP_ROWS[0], "1000,600,NaN,100,-3"],
            "run_up.csv:3: column 3: this is not a number",
        ),
        (RUN_UP_HEAD, [RUN_UP_ROWS[0], "1000,600,,100,-3"], "run_up.csv:3: column 3: a number is missing"),
        (RUN_UP_HEAD.replace(",", ";"), RUN_UP_ROWS, "run_up.csv:2: the line has 1 columns, the header 5"),
        (
            "speed_rpm,acceleration_2",
            ["600,9,5", "700,8,5"],
            "run_up.csv:2: the line has 3 columns, the header 2: decimal commas are read only where",
        ),
        (
            "speed_rpm,acceleration_2,acceleration_2.71828",
            ["600,1,1", "700,2,2"],
            "&shaft table: the highest is too",
        ),
    ],
)
def test_bad_run_ups_are_refused(head: str, rows: list[str], words: str, call, tmp_path: Path) -> None:
    table(tmp_path / "run_up.csv", head, rows)
    ended = call(scene(COMPUTED, RUN_UP), "--check", settings=("shaft.speed_rpm=650",), ends=2)
    assert words in ended.stderr, ended.stderr


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        (("gear.drag_torque=.1",), "&gear drag_torque: it excludes gear.bearing_mean_diameter"),
        (("gear.drag_table='drag.csv'",), "&gear drag_table: it excludes gear.bearing_mean_diam"),
        (("gear.bearing_width=.02",), "&gear bearing_width: give both bearing_width and bearing_clearance"),
        (("gear.bearing_clearance=3e-5",), "&gear bearing_clearance: give both bearing_width and bearing_cl"),
        (
            ("gear.bearing_width=.02", "gear.bearing_clearance=3e-5", "gear.bearing_factor=12"),
            "&gear bearing_factor: it excludes gear.bearing_width",
        ),
        (
            ("gear.synchroniser_cones=0",),
            "&gear synchroniser_gap: this key is used only with synchroniser_cones > 0",
        ),
        (("gear.synchroniser_cones=4",), "&gear synchroniser_cones: 4 is not allowed"),
        (("gear.drag_scale=0",), "&gear drag_scale: 0 is not allowed"),
        (
            ("gear.immersion_depth=0.0922",),
            "&gear immersion_depth: the reference circle of gear 2 has a diameter of",
        ),
        (("gear.immersion_depth=-0.01",), "&gear immersion_depth: -0.01 is not allowed"),
        (("gear.tip_diameter_1=0.048",), "&gear tip_diameter_1: give both tip_diameter_1 and tip_diameter_2"),
        (
            ("gear.tip_diameter_1=0.048", "gear.tip_diameter_2=0.097", "gear.contact_lines=1.3"),
            "&gear contact_lines: it excludes gear.tip_diameter_1",
        ),
        (("gear.tip_diameter_1=0.071", "gear.tip_diameter_2=0.097"), "&gear tip_diameter_1: tips interfere"),
        (("shaft.table='run_up.csv'",), "&shaft orders: it excludes shaft.table"),
    ],
)
def test_keys_that_do_not_fit_together(settings: tuple[str, ...], words: str, call) -> None:
    ended = call(scene(COMPUTED), "--check", settings=settings, ends=2)
    assert words in ended.stderr, ended.stderr


def test_what_is_missing_is_named(call, tmp_path: Path) -> None:
    table(tmp_path.parent / "elsewhere.csv", DRAG_HEAD, DRAG_ROWS)
    for drag, words in (
        ("", "&gear drag_torque: the drag on the loose gear is required: give exactly one of drag_torque;"),
        (
            "   bearing_mean_diameter = 0.038, synchroniser_cones = 1\n",
            "&gear synchroniser_gap: this key is req",
        ),
        ("   drag_torque = 0.1, drag_scale = 2\n", "&gear drag_scale: this key is used only with"),
        (
            "   drag_table = '../elsewhere.csv'\n",
            "&gear drag_table: the file lies outside the folder of this input",
        ),
        ("   drag_table = 'nothing.csv'\n", "nothing.csv: there is no such file"),
        (
            "   drag_torque = 0.1, own_shaft_ratio = 0.5\n",
            "&gear own_shaft_ratio: this key is used only with ge",
        ),
    ):
        assert words in call(scene(drag), "--check", ends=2).stderr, words
    no_oil = scene(COMPUTED).replace("&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temp", "!")
    no_oil += "&lubricant viscosity = 0.05, pressure_viscosity = 2e-8 /\n"
    assert "&gear bearing_mean_diameter: it needs the temperature of the oil: give &oil" in (
        call(no_oil, "--check", ends=2).stderr
    )
    alone = scene(COMPUTED).replace("backlash = 9e-5, ", "")
    assert "without a backlash the drag torque must be positive; here it is" in (
        call(alone, "--check", settings=("gear.own_shaft_ratio=2",), ends=2).stderr
    )
    call(alone, "--check")
    call(scene(COMPUTED), "--check", settings=("gear.own_shaft_ratio=2",))


@pytest.mark.parametrize(
    ("task", "words"),
    [
        (
            "campaign vary = 'shaft.speed_rpm', first = 500, last = 900, count = 5",
            "it is 500.0000 1/min and gear.d",
        ),
        (
            "campaign vary = 'shaft.speed_rpm', values(:, 1) = 700, 1001, 800",
            "it is 1001.000 1/min and gear.drag",
        ),
        (
            "campaign vary = 'oil.temperature_celsius', first = 30, last = 61, count = 2",
            "it is 61.00000 degC and g",
        ),
        (
            "sweep key = 'speed_rpm', first = 700, last = 1100, count = 5",
            "at 1100.000: it is 1100.000 1/min and",
        ),
        (
            "sweep key = 'temperature_celsius', first = 19, last = 30, count = 5",
            "at 19.00000: it is 19.00000 degC",
        ),
        (
            "threshold key = 'shaft.speed_rpm', first = 590, last = 900",
            "it is 590.0000 1/min and gear.drag_table",
        ),
        (
            "threshold key = 'oil.temperature_celsius', first = 20, last = 70",
            "it is 70.00000 degC and gear.drag_ta",
        ),
    ],
)
def test_values_outside_a_table_are_refused_before_anything_runs(
    task: str, words: str, call, tmp_path: Path
) -> None:
    kind = task.split()[0]
    solver = SWEPT if kind == "sweep" else SHORT
    text = scene(TABULATED, rest=solver) + f"&scene task = '{kind}' /\n&{task} /\n"
    ended = call(text, ends=2)
    assert words in ended.stderr and "goes from" in ended.stderr, ended.stderr
    assert not (tmp_path / "results").exists() or not any((tmp_path / "results").iterdir())


def test_lines_of_thresholds_outside_a_table_are_refused(call) -> None:
    text = scene(TABULATED, RUN_UP) + "&scene task = 'threshold' /\n"
    text += "&threshold key = 'gear.drag_scale', first = 0.5, last = 5 /\n"
    text += "&campaign vary = 'shaft.speed_rpm', first = 500, last = 900, count = 3 /\n"
    ended = call(text, ends=2)
    assert "it is 500.0000 1/min and gear.drag_table goes from 600.0000 to 1000.000 1/min" in ended.stderr


SOME_TIPS = "   tip_diameter_1 = 0.0482, tip_diameter_2 = 0.0968\n"
VARIED = {
    "shaft.speed_rpm": (COMPUTED, (650.0, 950.0)),
    "oil.temperature_celsius": (COMPUTED, (-10.0, 90.0)),
    "oil.volume": (COMPUTED, (1e-3, 3e-3)),
    "gear.drag_scale": (COMPUTED, (0.5, 4.0)),
    "gear.bearing_mean_diameter": (COMPUTED, (0.03, 0.05)),
    "gear.bearing_factor": (COMPUTED, (6.0, 24.0)),
    "gear.bearing_width": (PLAIN, (0.01, 0.03)),
    "gear.bearing_clearance": (PLAIN, (2e-5, 6e-5)),
    "gear.synchroniser_cones": (COMPUTED, (1, 3)),
    "gear.synchroniser_diameter": (COMPUTED, (0.05, 0.07)),
    "gear.synchroniser_width": (COMPUTED, (0.006, 0.010)),
    "gear.synchroniser_gap": (COMPUTED, (1e-4, 4e-4)),
    "gear.immersion_depth": (COMPUTED, (0.0, 0.06)),
    "gear.own_shaft_ratio": (COMPUTED, (0.3, 0.9)),
    "gear.tip_diameter_1": (COMPUTED + SOME_TIPS, (0.048, 0.0484)),
    "gear.tip_diameter_2": (COMPUTED + SOME_TIPS, (0.0965, 0.097)),
    "tabulated shaft.speed_rpm": (TABULATED, (650.0, 950.0)),
    "tabulated oil.temperature_celsius": (TABULATED, (25.0, 55.0)),
    "tabulated gear.drag_scale": (TABULATED, (0.5, 4.0)),
}


@pytest.mark.parametrize("varied", VARIED)
def test_rows_are_the_single_scenes(varied: str, call, tmp_path: Path) -> None:
    """What follows from speed, oil, drawing and a measured run-up is derived anew for every row."""
    key = varied.split()[-1]
    drag, values = VARIED[varied]
    text = scene(drag, RUN_UP)
    listed = ", ".join(str(value) for value in values)
    many = f"{text}&scene task = 'campaign' /\n&campaign vary = '{key}', values(:, 1) = {listed}\n{RECORD}/\n"
    call(many, "--output", "many")
    rows = package.read_campaign(tmp_path / "many" / "pair.rattle")
    differ = False
    for row, value in enumerate(values):
        alone = summary(call, tmp_path, text, f"{key}={value}")
        for name in REPORTED:
            if name in alone:
                assert rows[name][row] == alone[name], (name, value)
            else:
                assert np.isnan(rows[name][row])
        for name in ("film_minimum", "film_force_rms"):
            assert rows[name][row] == pytest.approx(alone[name], rel=1e-9), (name, value)
        differ = differ or alone["film_force_rms"] != pytest.approx(rows["film_force_rms"][0], rel=1e-6)
    assert differ, "the key does something"


@pytest.mark.parametrize(
    ("key", "first", "last"),
    [("speed_rpm", 650, 950), ("temperature_celsius", 30, 55), ("drag_scale", 0.5, 4.0)],
)
@pytest.mark.parametrize("drag", [COMPUTED, TABULATED])
def test_sweeps_tell_the_drag_of_each_value(
    key: str, first: float, last: float, drag: str, call, tmp_path: Path
) -> None:
    group = {"speed_rpm": "shaft", "temperature_celsius": "oil", "drag_scale": "gear"}[key]
    sweep = f"&sweep key = '{key}', first = {first}, last = {last}, count = 3, turn = .false. /\n"
    call(scene(drag, RUN_UP, SWEPT) + "&scene task = 'sweep' /\n" + sweep, "--output", "swept")
    rows = package.read(tmp_path / "swept" / "pair.rattle")
    for row in range(3):
        value = float(rows[key][row])
        reported = derived(
            call(scene(drag, RUN_UP), "--check", settings=(f"{group}.{key}={value!r}",)).stdout
        )
        assert rows["drag_torque"][row] == pytest.approx(reported["gear.drag_torque"], rel=1e-14)
        alone = summary(call, tmp_path, scene(drag, RUN_UP), f"{group}.{key}={value!r}")
        assert rows["inertia_ratio"][row] == alone["inertia_ratio"]


def test_thresholds_over_the_drag_scale(call, tmp_path: Path) -> None:
    """Lambda is 1 where the scale is Lambda of the scale 1. The film swings faster than the shaft: where its
    load just falls to nothing it hardly adds to the inertia."""
    base = scene(COMPUTED, rest="&solver until = 'steady', periods = 60 /\n&spectrum periods = 4 /\n")
    ratio = float(re.search(r"Lambda +([\d.]+)", call(base, "--check").stdout)[1])
    text = base + "&scene task = 'threshold' /\n&threshold key = 'gear.drag_scale', first = 0.5, last = 8\n"
    text += "scale = 'logarithmic', count = 5, tolerance = 1e-2, "
    brackets = {}
    for criterion in ("'inertia_ratio', level = 1", "'separation'"):
        call(text + f"criterion = {criterion} /\n", "--overwrite")
        rows = package.read(tmp_path / "results" / "pair.rattle").frame()
        rows = rows[rows["crossing"] > 0]
        assert len(rows) == 1, criterion
        brackets[criterion] = (float(rows["lower"].iloc[0]), float(rows["upper"].iloc[0]))
    lower, upper = brackets["'inertia_ratio', level = 1"]
    # Lambda is reported with four digits.
    assert lower * 0.999 < ratio < upper * 1.001
    assert brackets["'separation'"] == pytest.approx((ratio, ratio), rel=0.05)


def test_pairs_know_their_drag_each_in_its_way(call, tmp_path: Path) -> None:
    """Computed, tabulated and given side by side, in a campaign and alone."""
    names = ("computed", "tabulated", "given")
    drags = (COMPUTED, TABULATED, "   drag_torque = 0.07\n")
    gears = [
        GEAR.replace("&gear\n", f"&gear\n   name = '{name}'\n") + drag + "/\n"
        for name, drag in zip(names, drags, strict=True)
    ]
    plan = "&scene task = 'campaign' /\n&campaign vary = 'shaft.speed_rpm', values(:, 1) = 650, 950\n"
    call("".join(gears) + RUN_UP + REST + SHORT + plan + RECORD + "/\n", "--output", "many")
    rows = package.read_campaign(tmp_path / "many" / "pair.rattle")
    for row, (drag, speed) in enumerate((drag, speed) for drag in drags for speed in (650, 950)):
        alone = summary(call, tmp_path, scene(drag, RUN_UP), f"shaft.speed_rpm={speed}")
        for name in ("drag_torque", "inertia_ratio"):
            assert rows[name][row] == alone[name]
        assert np.isnan(rows["drag_churning"][row]) == (drag is not COMPUTED)


def test_a_run_is_not_carried_on_with_another_table(call, run, tmp_path: Path) -> None:
    text = scene(TABULATED, RUN_UP)
    call(text)
    assert run("--resume", "--set", "solver.periods=8", "pair.nml", cwd=tmp_path).returncode == 0
    for name, head, rows in (
        ("drag.csv", DRAG_HEAD, ["600,20,.17", *DRAG_ROWS[1:]]),
        ("run_up.csv", RUN_UP_HEAD, ["600,901,0,120,3", *RUN_UP_ROWS[1:]]),
    ):
        before = (tmp_path / name).read_text()
        table(tmp_path / name, head, rows)
        ended = run("--resume", "--set", "solver.periods=10", "pair.nml", cwd=tmp_path)
        assert ended.returncode == 2 and "holds other rows now" in ended.stderr, ended.stderr
        (tmp_path / name).write_text(before)
    assert run("--resume", "--set", "solver.periods=10", "pair.nml", cwd=tmp_path).returncode == 0


def test_a_force_scale_multiplies_the_run_up(call) -> None:
    whole = derived(call(scene(COMPUTED, RUN_UP), "--check").stdout)
    half = call(scene(COMPUTED, RUN_UP), "--check", settings=("load.force_scale=0.5",)).stdout
    assert derived(half)["load.force_amplitudes"] == whole["load.force_amplitudes"]
    ratios = [float(re.search(r"Lambda +([\d.]+)", text)[1]) for text in (half,)]
    assert ratios[0] > 0.0


def test_single_scenes_of_a_campaign_take_their_tables_along(call, run, tmp_path: Path) -> None:
    """Each scene again, from the result alone, in another folder: the same numbers."""
    names = ("tabulated", "computed")
    gears = [
        GEAR.replace("&gear\n", f"&gear\n   name = '{name}'\n") + drag + "/\n"
        for name, drag in zip(names, (TABULATED, COMPUTED), strict=True)
    ]
    plan = "&scene task = 'campaign' /\n&campaign vary = 'shaft.speed_rpm', values(:, 1) = 650, 950\n"
    for text in (scene(TABULATED, RUN_UP), "".join(gears) + RUN_UP + REST + SHORT):
        call(text + plan + RECORD + "/\n", "--output", "many", "--overwrite")
        rows = package.read_campaign(tmp_path / "many" / "pair.rattle")
        again = tmp_path / f"again{len(rows['scene'])}"
        outputs.write(rerun.inputs(rows, range(len(rows["scene"])), again, "results"), overwrite=False)
        for row in range(len(rows["scene"])):
            label = rerun.scene_label(rows, row)
            ended = run(f"{label}.nml", cwd=again)
            assert ended.returncode == 0, ended.stderr
            found = summary_of(again / "results" / f"{label}.summary.nml")
            assert found["drag_torque"] == rows["drag_torque"][row]
            assert found["inertia_ratio"] == rows["inertia_ratio"][row]


def test_the_gear_turns_as_its_tooth_moves(call, tmp_path: Path) -> None:
    """The angular acceleration is that along the normal over the arm of the base circle."""
    call(scene(COMPUTED))
    alone = summary_of(tmp_path / "results" / "pair.summary.nml")
    helix = np.radians(28.0)
    across = 0.0022 / np.cos(helix)
    angle = np.arctan(np.tan(np.radians(20.0)) / np.cos(helix))
    arm = 0.5 * across * 37 * np.cos(angle) * np.sqrt(1.0 - (np.sin(helix) * np.cos(np.radians(20.0))) ** 2)
    peak = max(-alone["acceleration_minimum"], alone["acceleration_maximum"])
    assert alone["gear_acceleration_rms"] == pytest.approx(alone["acceleration_rms"] / arm, rel=1e-12)
    assert alone["gear_acceleration_maximum"] == pytest.approx(peak / arm, rel=1e-12)
