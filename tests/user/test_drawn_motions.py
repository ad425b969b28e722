"""What the figures of motions and sweeps show: the numbers of the result, in the unit that the axis names."""

from __future__ import annotations

from pathlib import Path

import drawn
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from result_writer import write_motion, write_result
from script_calls import call_script

import rattle
from rattle.figures import motion, spectra, style, sweep, tolerance

# Harmonics, and lines between them that fit 16 and 20 periods. The slowest distinguishes the periods.
LINES = {0.25: 0.5, 1.0: 10.0, 2.0: 8.0, 3.0: 3.0, 4.5: 2.0}
PERIOD = 2.0  # ms
ACCELERATION = r"Acceleration $\ddot{z}$ [m/s$^2$]"
AMPLITUDE = r"Amplitude of $\ddot{z}$ [m/s$^2$]"
LEVEL = r"Level [dB re 10$^{-6}$ m/s$^2$]"
RATIO = r"Frequency ratio $f/f_\mathrm{exc}$"


@pytest.fixture
def idle(tmp_path) -> Path:
    return write_motion(tmp_path / "idle.rattle", lines={0.0: 1.5, **LINES})


@pytest.fixture
def creep(tmp_path) -> Path:
    lines = {0.25: 0.2, 1.0: 4.0, 2.0: 1.0}
    return write_motion(tmp_path / "creep.rattle", lines=lines, law="piezo-viscous")


def figure(number: int, *paths: Path, periods: int = 4, window: int | None = None) -> Figure:
    """One figure of one run, or of several laid over each other."""
    results = [rattle.read(path) for path in paths]
    make = motion.overlay_figures if len(paths) > 1 else motion.single_figures
    with style.house_style():
        ((_, made),) = make(results, [number], motion.Extent(periods, window))
        return made


def history(path: Path, column: str, periods: int) -> tuple[np.ndarray, np.ndarray]:
    """Milliseconds and values of the last periods, with the row at their start."""
    rows = slice(-128 * periods - 1, None)
    result = rattle.read(path)
    time = np.array(result["time"][rows])
    return 1e3 * (time - time[0]), np.array(result[column][rows])


def assert_curve(found: tuple[np.ndarray, np.ndarray], expected: tuple[np.ndarray, np.ndarray]) -> None:
    for seen, meant in zip(found, expected, strict=True):
        assert seen.shape == meant.shape
        np.testing.assert_allclose(seen, meant, rtol=1e-12, atol=1e-12 * np.nanmax(np.abs(meant)))


def assert_lines(axes: Axes, drawn_set: int, expected: dict[float, float], shift: float = 0.0) -> None:
    """One set of spectral lines holds these ratios with these amplitudes, and nothing else of any size."""
    places, heights = drawn.bars(axes)[drawn_set]
    large = heights > 1e-9
    np.testing.assert_allclose(places[large] - shift, sorted(expected), rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(heights[large], [expected[ratio] for ratio in sorted(expected)], rtol=1e-9)


# --- figures 6, 8 and 9: histories ---------------------------------------------------------------------


@pytest.mark.parametrize("periods", [1, 4])
def test_figure_6_shows_film_in_micrometres_over_force_in_newtons(idle, periods):
    film, force = figure(6, idle, periods=periods).axes
    time, thickness = history(idle, "film_thickness", periods)
    assert_curve(drawn.curves(film)[0], (time, 1e6 * thickness))
    assert_curve(drawn.curves(force)[0], history(idle, "applied_force", periods))
    assert drawn.colours(film) == [style.LAW_COLOURS["iso-viscous"].lower()]
    assert film.get_ylabel() == r"Film thickness $h$ [$\mathrm{\mu}$m]"
    start = (20 - periods) * PERIOD
    words = "excitation period" if periods == 1 else f"{periods} excitation periods"
    assert drawn.labels(force) == (
        f"Time within the last {words} [ms], from $t = {start:.2f}$ ms",
        "Applied force $F$ [N]",
    )
    assert film.get_yscale() == "log" and film.get_ylim()[1] > 1.4
    for axes in (film, force):
        assert axes.get_xlim() == pytest.approx((0.0, periods * PERIOD))
        expected = [count * PERIOD for count in range(periods + 1)]
        assert drawn.rules(axes, "x") == pytest.approx(expected)
    low, high = force.get_ylim()
    assert low < 50.0 < 350.0 < high
    assert film.get_title(loc="left") == ("Film and applied force: idle, published iso-viscous film")


@pytest.mark.parametrize(("number", "law"), [(8, "iso-viscous"), (9, "piezo-viscous")])
def test_figures_8_and_9_show_the_acceleration(tmp_path, number, law):
    path = write_motion(tmp_path / "idle.rattle", lines=LINES, law=law)
    (axes,) = figure(number, path, periods=3).axes
    assert_curve(drawn.curves(axes)[0], history(path, "acceleration", 3))
    assert drawn.colours(axes) == [style.LAW_COLOURS[law].lower()]
    words = "Time within the last 3 excitation periods [ms], from $t = 34.00$ ms"
    assert drawn.labels(axes) == (words, ACCELERATION)
    assert axes.get_xlim() == pytest.approx((0.0, 6.0))
    assert drawn.rules(axes, "x") == pytest.approx([0.0, 2.0, 4.0, 6.0])
    assert drawn.rules(axes, "y") == [0.0]


def test_an_overlay_of_histories_names_each_run_at_its_own_line(idle, creep):
    made = figure(8, idle, creep, periods=2)
    (axes,) = made.axes
    for found, path in zip(drawn.curves(axes), (idle, creep), strict=True):
        assert_curve(found, history(path, "acceleration", 2))
    assert drawn.colours(axes) == [colour.lower() for colour in style.RUN_COLOURS[:2]]
    handles = made.legends[0].legend_handles
    assert drawn.legend_words(made) == ["idle", "creep"]
    assert [handle.get_color() for handle in handles] == list(style.RUN_COLOURS[:2])
    assert axes.get_xlabel() == "Time within the last 2 excitation periods [ms]"


# --- figures 7 and 10: spectra -------------------------------------------------------------------------


def test_figure_7_shows_the_lines_of_the_force_in_newtons(idle):
    (axes,) = figure(7, idle).axes
    assert_lines(axes, 0, {0.0: 200.0, 1.0: 150.0})
    places = drawn.bars(axes)[0][0]
    assert places.max() == 5.0
    assert np.diff(places) == pytest.approx(1.0 / 16.0)
    assert drawn.labels(axes) == (RATIO, "Amplitude of $F$ [N]")
    assert axes.get_xlim() == (-0.25, 5.0)
    assert axes.get_ylim() == pytest.approx((0.0, 224.0))
    places = {note.get_text(): note.xy for note in axes.texts}
    assert places["mean\n200 N"] == pytest.approx((0.0, 200.0))
    assert places["150 N\nat 500 Hz"] == pytest.approx((1.0, 150.0))


def test_an_overlay_of_the_force_stands_side_by_side(idle, creep):
    (axes,) = figure(7, idle, creep).axes
    for position, shift in enumerate((-0.03, 0.03)):
        assert_lines(axes, position, {0.0: 200.0, 1.0: 150.0}, shift)
    assert axes.get_xlabel() == f"{RATIO}; runs side by side"


@pytest.mark.parametrize("window", [None, 20])
def test_figure_10_shows_harmonics_and_what_is_between_them(idle, window):
    made = figure(10, idle, window=window)
    (axes,) = made.axes
    assert_lines(axes, 0, {ratio: a for ratio, a in LINES.items() if ratio % 1.0})
    assert_lines(axes, 1, {ratio: a for ratio, a in LINES.items() if not ratio % 1.0})
    places = np.sort(np.concatenate([found[0] for found in drawn.bars(axes)]))
    bins = places * (window or 16)
    assert bins == pytest.approx(np.round(bins))
    assert drawn.labels(axes) == (RATIO, LEVEL)
    assert axes.get_xlim() == (0.0, 10.5)
    # 20 dB below the line of what counts, which is 1 % of 10 m/s2.
    assert axes.get_yscale() == "log" and axes.get_ylim() == pytest.approx((0.01, 30.0))
    ticks = dict(zip(axes.get_yticks(), (text.get_text() for text in axes.get_yticklabels()), strict=True))
    assert {round(20.0 * np.log10(place / 1e-6)): words for place, words in ticks.items()} == {
        level: str(level) for level in (80, 100, 120, 140)
    }
    assert drawn.rules(axes, "y") == pytest.approx([0.1])
    assert drawn.legend_words(made) == [
        "harmonics of 500 Hz",
        "between the harmonics",
        "1 % of the first harmonic",
    ]
    assert axes.get_title(loc="left") == "Spectrum of the acceleration: idle, published iso-viscous film"


def test_figure_10_as_amplitudes_is_that_of_the_paper(idle):
    ((_, made),) = motion.single_figures(
        [rattle.read(idle)], [10], motion.Extent(4, None, spectra.View(decibels=False))
    )
    (axes,) = made.axes
    assert axes.get_yscale() == "linear" and axes.get_ylim() == pytest.approx((0.0, 10.8))
    assert axes.get_ylabel() == AMPLITUDE


@pytest.mark.parametrize(
    ("last", "amplitude", "end"),
    [(9.0, 0.1, 10.5), (14.0, 0.01, 14.5), (60.0, 0.1, 60.5), (60.0, 0.01, 40.5), (60.25, 0.1, 40.5)],
)
def test_figure_10_ends_behind_the_last_line_that_counts_or_is_near(tmp_path, last, amplitude, end):
    path = write_motion(tmp_path / "a.rattle", lines={1.0: 5.0, last: amplitude})
    (axes,) = figure(10, path).axes
    assert axes.get_xlim() == (0.0, end)


def test_spectra_of_several_runs_end_at_the_same_frequency(tmp_path, idle):
    """Those of one call can be compared with each other: all end where the widest one does."""
    wide = write_motion(tmp_path / "wide.rattle", lines={1.0: 5.0, 14.0: 0.1})
    results = [rattle.read(path) for path in (idle, wide)]
    with style.house_style():
        made = dict(motion.single_figures(results, [7, 10], motion.Extent(4, None)))
    ends = {stem: [axes.get_xlim() for axes in made[stem].axes] for stem in made if "10a" in stem}
    assert len(ends) == 2 and all(limits == [(0.0, 14.5)] for limits in ends.values())


def test_an_overlay_of_spectra_stands_side_by_side(idle, creep):
    (axes,) = figure(10, idle, creep).axes
    assert_lines(axes, 0, LINES, -0.08)
    assert_lines(axes, 1, {0.25: 0.2, 1.0: 4.0, 2.0: 1.0}, 0.08)
    assert axes.get_xlabel() == f"{RATIO}; runs side by side"


def test_spectra_under_several_harmonics_count_harmonics_where_there_is_no_shaft(tmp_path):
    lines = {1.0: 0.2, 2.0: 5.0, 3.0: 9.0, 12.0: 4.0, 50.0: 0.3}
    path = write_motion(
        tmp_path / "engine.rattle", lines=lines, force={2: 150.0, 12: 20.0, 50: 3.0, 51: 1e-9}
    )
    (force,) = figure(7, path).axes
    assert_lines(force, 0, {0.0: 200.0, 2.0: 150.0, 12.0: 20.0, 50.0: 3.0})
    assert force.get_xlabel() == "Harmonic, multiple of 500 Hz"
    assert force.get_xlim() == (-0.25, 50.5)
    places = {note.get_text(): note.xy for note in force.texts}
    assert places["150 N\nat 1000 Hz"] == pytest.approx((2.0, 150.0))
    made = figure(10, path)
    (axes,) = made.axes
    assert_lines(axes, 1, {ratio: lines[ratio] for ratio in (1.0, 3.0)})
    assert_lines(axes, 2, {ratio: lines[ratio] for ratio in (2.0, 12.0, 50.0)})
    assert axes.get_xlim() == (0.0, 50.5)
    assert axes.get_xlabel() == "Harmonic, multiple of 500 Hz"
    # The largest line at a harmonic of the force is what the others are compared with.
    assert drawn.rules(axes, "y") == pytest.approx([0.05])
    assert drawn.legend_words(made)[1:] == ["at harmonics of the force", "1 % of harmonic 2"]
    both = figure(10, path, write_motion(tmp_path / "paper.rattle", lines={1.0: 5.0})).axes
    assert both[0].get_xlabel() == "Harmonic, multiple of 500 Hz; runs side by side"


# --- loose tolerances ----------------------------------------------------------------------------------


def test_the_tolerance_figure_puts_each_run_where_its_words_are(tmp_path):
    loose_path = write_motion(tmp_path / "loose.rattle", lines={1.0: 4.0, 2.5: 9.0, 7.0: 1.0}, tolerance=2e-7)
    tight_path = write_motion(tmp_path / "tight.rattle", lines={1.0: 5.0, 3.0: 1.0})
    loose, tight = rattle.read(loose_path), rattle.read(tight_path)
    pairs = [tolerance.Pair("First", loose, tight, 6.0), tolerance.Pair("Second", loose, tight, 32.0)]
    with style.house_style():
        made = tolerance.draw(pairs, 3, 16)
    upper, lower = made.axes[:2], made.axes[2:]
    for column, (axes, spectrum) in enumerate(zip(upper, lower, strict=True)):
        assert_curve(drawn.curves(axes)[0], history(tight_path, "acceleration", 3))
        assert_curve(drawn.curves(axes)[1], history(loose_path, "acceleration", 3))
        assert drawn.labels(axes) == ("Time within the last 3 excitation periods [ms]", ACCELERATION)
        assert axes.get_title(loc="left") == (
            f"({'ab'[column]}) {('First', 'Second')[column]}\n"
            "iteration successive, predictor previous\n128 steps a period"
        )
        last = (6.0, 32.0)[column]
        assert_lines(spectrum, 0, {r: a for r, a in {1.0: 4.0, 2.5: 9.0, 7.0: 1.0}.items() if r <= last})
        assert_lines(spectrum, 1, {1.0: 5.0, 3.0: 1.0})
        assert drawn.labels(spectrum) == (RATIO, AMPLITUDE)
        assert spectrum.get_xlim() == pytest.approx((0.0, last + 0.1))
        assert spectrum.get_ylim() == pytest.approx((0.0, 1.08 * 9.0))
        words = [text.get_text() for text in spectrum.get_legend().get_texts()]
        assert words[0].startswith(r"$\varepsilon = 10^{-12}$ m: 2 reversals a period, class quiet")
        assert words[1].startswith(r"$\varepsilon = 2 \times 10^{-7}$ m: ")
        lines = spectrum.get_legend().legend_handles
        assert [line.get_color() for line in lines] == [tolerance.TIGHT["color"], tolerance.LOOSE["color"]]


def test_the_tolerance_figure_says_where_samples_are_too_few(tmp_path):
    """The runs that it is about are coarse ones: what their samples show is its subject."""
    loose_path = write_motion(tmp_path / "loose.rattle", lines={1.0: 4.0}, tolerance=1e-7, coarse=True)
    tight_path = write_motion(tmp_path / "tight.rattle", lines={1.0: 5.0})
    pair = tolerance.Pair("Pair", rattle.read(loose_path), rattle.read(tight_path), 6.0)
    with style.house_style():
        made = tolerance.draw([pair], 3, 16)
    words = [text.get_text() for text in made.axes[1].get_legend().get_texts()]
    assert [word.split(", ")[-1] for word in words] == ["class quiet", "class quiet"]
    assert (
        made.axes[0]
        .get_title(loc="left")
        .endswith("\niteration successive, predictor previous\n128 steps a period, too few")
    )


# --- sweeps --------------------------------------------------------------------------------------------

SWEEP_COLUMNS = {
    "direction": "-",
    "film_minimum": "m",
    "film_maximum": "m",
    "acceleration_minimum": "m/s2",
    "acceleration_maximum": "m/s2",
    "orbit_period": "-",
    "floquet_modulus": "-",
    "status": "-",
}
# The third one failed on the increasing; of the fourth no period is known.
SWEEP_ROWS = [
    [100.0, 1.0, 1e-6, 2e-6, -30.0, 20.0, 1.0, 0.3, 1.0],
    [200.0, 1.0, 0.5e-6, 3e-6, -40.0, 50.0, 2.0, 0.6, 0.0],
    [300.0, 1.0, 0.4e-6, 4e-6, -60.0, 50.0, 1.0, 0.9, 3.0],
    [400.0, 1.0, 0.3e-6, 5e-6, -70.0, 80.0, 0.0, 0.0, 0.0],
    [300.0, -1.0, 0.4e-6, 4e-6, -60.0, 50.0, 4.0, 0.9, 1.0],
    [200.0, -1.0, 0.5e-6, 3e-6, -40.0, 55.0, 2.0, 0.6, 1.0],
    [100.0, -1.0, 0.9e-6, 2e-6, -30.0, 20.0, 1.0, 0.3, 1.0],
]


def sweep_input(key: str) -> str:
    return (
        f"&scene name='climb' task='sweep' /\n&film law='iso-viscous' model='published' /\n"
        f"&sweep key='{key}' /\n"
    )


def sweep_figure(
    path: Path, key: str = "frequency", rows: list | None = None, first_column: str | None = None
) -> Figure:
    columns = [(first_column or key, "-"), *SWEEP_COLUMNS.items()]
    write_result(path, columns, rows or SWEEP_ROWS, input_text=sweep_input(key))
    with style.house_style():
        return sweep.draw(rattle.read(path))


@pytest.mark.parametrize("first_column", ["frequency", "value"])
def test_a_sweep_shows_both_ways_and_leaves_gaps(first_column, tmp_path):
    """The first column is the swept key; early files call it value."""
    made = sweep_figure(tmp_path / "climb.rattle", first_column=first_column)
    film, acceleration, period, multiplier = made.axes
    lost = np.nan
    there, back = [100.0, 200.0, 300.0, 400.0], [400.0, 300.0, 200.0, 100.0]
    expected = {
        film: [
            (there, [2.0, 3.0, lost, 5.0]),
            (there, [1.0, 0.5, lost, 0.3]),
            (back, [5.0, 4.0, 3.0, 2.0]),
            (back, [0.3, 0.4, 0.5, 0.9]),
        ],
        acceleration: [(there, [30.0, 50.0, lost, 80.0]), (back, [80.0, 60.0, 55.0, 30.0])],
        period: [(there, [1.0, 2.0, lost, lost]), (back, [lost, 4.0, 2.0, 1.0])],
        multiplier: [(there, [0.3, 0.6, lost, lost]), (back, [lost, 0.9, 0.6, 0.3])],
    }
    for axes, curves in expected.items():
        for found, (values, quantity) in zip(drawn.curves(axes), curves, strict=True):
            assert_curve(found, (np.array(values), np.array(quantity)))
        ways = drawn.colours(axes)
        half = len(ways) // 2
        assert set(ways[:half]) == {style.RUN_COLOURS[0].lower()}
        assert set(ways[half:]) == {style.RUN_COLOURS[1].lower()}
    assert [axes.get_ylabel() for axes in made.axes] == [
        r"Film [$\mathrm{\mu}$m]",
        r"Peak $|\ddot{z}|$ [m/s$^2$]",
        "Period [$1/f$]",
        "Floquet multiplier",
    ]
    assert multiplier.get_xlabel() == r"Excitation frequency $f_\mathrm{exc}$ [Hz]"
    assert film.get_yscale() == "log"
    assert period.get_ylim() == (0.5, 4.5)
    assert multiplier.get_ylim() == (0.0, 1.1)
    assert drawn.rules(multiplier, "y") == [1.0]
    assert drawn.legend_words(made) == ["up", "down", "hysteresis"]
    # At 200 alone both ways have motions of their own; at 300 that of one way is not known.
    for axes in made.axes:
        (band,) = axes.patches
        assert (band.get_x(), band.get_width()) == (150.0, 100.0)


@pytest.mark.parametrize(
    ("key", "label"),
    [
        ("force_amplitude", "Force amplitude $F_0$ [N]"),
        ("steady_force", "Steady force $Q$ [N]"),
        ("entrainment_speed", "Entrainment speed $U$ [m/s]"),
    ],
)
def test_a_sweep_names_its_key_and_unit(tmp_path, key, label):
    only_there = SWEEP_ROWS[:2]
    made = sweep_figure(tmp_path / "climb.rattle", key, only_there)
    assert made.axes[-1].get_xlabel() == label
    assert made.axes[2].get_ylim() == (0.5, 2.5)
    assert drawn.legend_words(made) == ["up"]


def test_several_sweeps_share_the_panels_that_are_asked_for(tmp_path):
    """Each sweep has a colour and a mark, each way its dashes; marks name values of the key."""
    columns = [("stiffness", "N/m"), *SWEEP_COLUMNS.items(), ("harmonic_count", "-")]
    results = []
    for name, lines in (("soft", 9.0), ("hard", 30.0)):
        rows = [[*row, lines] for row in SWEEP_ROWS]
        text = sweep_input("stiffness").replace("climb", name) + "&spectrum idle_harmonics=20 /\n"
        text = text.replace("&sweep ", "&sweep spacing='logarithmic' ")
        path = tmp_path / f"{name}.rattle"
        write_result(path, columns, rows, input_text=text)
        results.append(rattle.read(path))
    with style.house_style():
        made = sweep.draw(*results, panels=("acceleration", "harmonics"), marks=[(150.0, "steel")])
    acceleration, lines = made.axes
    assert lines.get_xlabel() == "Stiffness of the teeth $k$ [N/m]" and lines.get_xscale() == "log"
    curves = [line for line in lines.lines if len(line.get_xdata()) > 2]
    assert [float(np.nanmax(line.get_ydata())) for line in curves] == [9.0, 9.0, 30.0, 30.0]
    assert len({line.get_marker() for line in curves}) == len({line.get_color() for line in curves}) == 2
    assert len({line.get_linestyle() for line in curves}) == 2
    assert drawn.rules(lines, "y") == [20.0] and drawn.rules(acceleration, "x") == [150.0]
    assert [text.get_text() for text in acceleration.texts] == ["steel"]
    films = "published iso-viscous film"
    assert drawn.legend_words(made) == [f"soft, {films}", f"hard, {films}", "up", "down"]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("--panels", "harmonics,colour"), "'colour' is not one of film, acceleration"),
        (("--mark", "steel"), "is not a value and words"),
    ],
)
def test_panels_and_marks_that_cannot_be_are_refused(tmp_path, given, words):
    sweep_figure(tmp_path / "climb.rattle")
    done = call_script("plot.py", "sweep", tmp_path / "climb.rattle", *given)
    assert done.returncode == 2 and words in done.stderr


def test_sweeps_of_different_keys_do_not_share_a_figure(tmp_path):
    sweep_figure(tmp_path / "one.rattle")
    sweep_figure(tmp_path / "other.rattle", "steady_force")
    done = call_script("plot.py", "sweep", tmp_path / "one.rattle", tmp_path / "other.rattle")
    assert done.returncode == 2 and "different keys, frequency and steady_force" in done.stderr


# --- both flanks ---------------------------------------------------------------------------------------


def test_both_flanks_are_drawn_over_a_cycle(run, repository, tmp_path):
    assert run(repository / "input" / "loose_gear.nml", "--output", tmp_path, cwd=tmp_path).returncode == 0
    path = tmp_path / "loose_gear.rattle"
    made = figure(motion.FLANKS, path)
    films, loads, acceleration = made.axes
    result = rattle.read(path)
    rows = slice(-2049, None)
    for axes, names, scale in (
        (films, ("film_thickness", "coast_film"), 1e6),
        (loads, ("film_load", "coast_load"), 1.0),
        (acceleration, ("acceleration",), 1.0),
    ):
        curves = [line for line in axes.lines if len(line.get_xdata()) > 2]
        assert len(curves) == len(names) == len({line.get_linestyle() for line in curves})
        for curve, name in zip(curves, names, strict=True):
            expected = scale * np.array(result[name][rows])
            assert np.isin(expected, curve.get_ydata()).all(), name
    assert films.get_yscale() == "log"
    assert drawn.legend_words(made) == ["drive flank", "coast flank"]
    assert acceleration.get_xlabel().startswith("Time within the last excitation period [ms]")


def test_one_flank_has_no_figure_of_two(idle, tmp_path):
    done = call_script("plot.py", "motion", idle, "--figures", "flanks", "--output", tmp_path)
    assert done.returncode == 2 and "Nothing to draw" in done.stderr
