"""Figures for papers and slides: width, type, titles, limits, units of spectra, the user's own settings."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

import campaign_runs
import drawn
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.legend import Legend
from matplotlib.text import Text
from result_writer import write_motion, write_result
from script_calls import call_script

import rattle
from rattle.campaign_section import new_section, short_name
from rattle.command import CommandError
from rattle.figures import campaign_map, campaign_slice, histories, motion, spectra, style, sweep, tolerance
from rattle.figures.campaign_look import with_unit
from rattle.figures.fit import fit, is_narrow

LINES = {1.0: 10.0, 2.0: 8.0, 3.0: 0.5}
IMPACT = {float(n): 5.0 for n in range(1, 60)}


def options(**given: object) -> Namespace:
    plain = {"width": None, "font_size": None, "no_title": False, "xlim": None, "ylim": None}
    return Namespace(**plain | given)


def fitted(figure: Figure, **given: object) -> Figure:
    if given.get("width"):
        given["width"] /= 25.4
    with style.house_style():
        fit(figure, options(**given))
        FigureCanvasAgg(figure).draw()
    return figure


@pytest.fixture
def idle(tmp_path) -> rattle.Result:
    return rattle.read(write_motion(tmp_path / "idle.rattle", lines=LINES))


@pytest.fixture(scope="module")
def made(tmp_path_factory, run, repository, scene_text) -> dict[str, Path]:
    """A sweep and a campaign."""
    folder = tmp_path_factory.mktemp("made")
    (folder / "map.nml").write_text(campaign_runs.grid(scene_text, 6, 5))
    assert run("map.nml", "--output", folder, cwd=folder).returncode == 0
    ended = run(repository / "input" / "sweep.nml", "--set", "sweep.count=9", "--output", folder, cwd=folder)
    assert ended.returncode == 0
    return {"map": folder / "map.rattle", "sweep": folder / "sweep.rattle"}


@pytest.fixture(
    params=("film", "acceleration", "force", "spectrum", "overlay", "sweep", "map", "values", "slice")
)
def figure(request, idle, made) -> Figure:
    """One figure of each kind."""
    pair = [idle, idle]
    with style.house_style():
        campaign = rattle.read_campaign(made["map"])
        plane = new_section(campaign, campaign.varied, {})
        makers = {
            "film": lambda: histories.draw_film_and_force([idle], ["idle"], 4),
            "acceleration": lambda: histories.draw_acceleration([idle], ["idle"], 4),
            "force": lambda: spectra.draw_force([idle], ["idle"], None),
            "spectrum": lambda: spectra.draw_acceleration([idle], ["idle"], None),
            "overlay": lambda: spectra.draw_acceleration(pair, ["a scene", "another scene"], None),
            "sweep": lambda: sweep.draw(rattle.read(made["sweep"])),
            "map": lambda: campaign_map.draw(plane, "rattle_class", campaign_map.Options()),
            "values": lambda: campaign_map.draw(plane, "film_minimum", campaign_map.Options()),
            "slice": lambda: campaign_slice.draw(
                new_section(campaign, campaign.varied[:1], {}), ["film_minimum", "rattle_class"]
            ),
        }
        return makers[request.param]()


def seen_texts(figure: Figure) -> list[Text]:
    """Titles, labels and words of legends that are drawn."""
    named = [text for axes in figure.axes for text in (axes._left_title, axes.xaxis.label, axes.yaxis.label)]
    legends = [text for legend in figure.findobj(Legend) for text in legend.get_texts()]
    return [text for text in (*named, *legends) if text.get_text() and text.get_visible()]


@pytest.mark.parametrize("width", (80.0, 160.0))
def test_all_words_stand_within_the_figure_and_can_be_read(figure, width):
    fitted(figure, width=width)
    renderer = figure.canvas.get_renderer()
    assert figure.get_figwidth() * 25.4 == pytest.approx(width)
    wide, high = figure.get_size_inches() * figure.dpi
    texts = seen_texts(figure)
    assert texts
    for text in texts:
        box = text.get_window_extent(renderer)
        assert box.x0 >= -1.0 and box.x1 <= wide + 1.0, text.get_text()
        assert box.y0 >= -1.0 and box.y1 <= high + 1.0, text.get_text()
        assert text.get_fontsize() >= 6.0
    for panel in figure.axes:
        assert panel.get_window_extent().width > (0.3 if panel.get_label() != "<colorbar>" else 0.01) * wide
    labels = [
        axes.yaxis.label for axes in figure.axes if axes.get_ylabel() and axes.get_label() != "<colorbar>"
    ]
    boxes = [label.get_window_extent(renderer) for label in labels]
    for one, other in zip(boxes, boxes[1:], strict=False):
        assert one.y0 > other.y1, "labels of panels overlap"


def test_no_word_is_lost_in_a_column_but_the_film_of_a_title(idle):
    with style.house_style():
        wide = spectra.draw_acceleration([idle], ["idle"], None)
        words = drawn.all_words(wide).split()
        narrow = fitted(spectra.draw_acceleration([idle], ["idle"], None), width=80.0)
    assert wide.axes[0].get_title(loc="left").endswith(": idle, published iso-viscous film")
    assert narrow.axes[0].get_title(loc="left") == "Spectrum of the acceleration: idle"  # one line
    for word in words:
        if word.isalpha() and word not in ("published", "film"):
            assert word in drawn.all_words(narrow).split(), word


def test_legends_move_out_of_narrow_axes():
    figure = Figure(figsize=(6.3, 3.0), layout="constrained")
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], label="first")
    axes.plot([0, 1], [1, 0], label="second")
    axes.legend(title="all")
    fitted(figure, width=80.0)
    assert axes.get_legend() is None
    assert drawn.legend_words(figure) == ["all", "first", "second"]


def test_the_size_of_type_is_the_one_asked_for(idle):
    with style.house_style():
        figure = histories.draw_acceleration([idle], ["idle"], 4)
    fitted(figure, font_size=12.0)
    axes = figure.axes[0]
    sizes = [axes.xaxis.label.get_fontsize(), axes.yaxis.label.get_fontsize()]
    assert sizes == pytest.approx([12.0, 12.0])
    ticks = [label.get_fontsize() for label in axes.get_xticklabels()]
    assert 10.0 < min(ticks) <= max(ticks) < 12.0


def test_without_titles_only_what_tells_panels_apart_is_left(idle):
    figure = fitted(histories.draw_acceleration([idle], ["idle"], 4), no_title=True)
    assert figure.axes[0].get_title(loc="left") == ""
    figure = Figure(layout="constrained")
    above, below = figure.subplots(2)
    above.set_title("Subject\nscene\n(a) one", loc="left")
    below.set_title("(b) two", loc="left")
    figure.suptitle("all")
    fitted(figure, no_title=True)
    assert (above.get_title(loc="left"), below.get_title(loc="left")) == ("(a) one", "(b) two")
    assert figure.get_suptitle() == ""


def test_limits_are_those_asked_for(idle):
    view = spectra.View(decibels=False)
    figure = fitted(
        spectra.draw_acceleration([idle], ["idle"], None, view), xlim=(0.5, 4.5), ylim=(-1.0, 3.0)
    )
    (axes,) = figure.axes
    assert axes.get_xlim() == (0.5, 4.5) and axes.get_ylim() == (-1.0, 3.0)
    two = fitted(histories.draw_film_and_force([idle], ["idle"], 4), ylim=(0.1, 3.0))
    assert two.axes[0].get_ylim() == (0.1, 3.0) != two.axes[1].get_ylim()


def test_limits_that_a_logarithmic_axis_cannot_have_are_refused(made):
    with style.house_style(), pytest.raises(CommandError, match="this axis is logarithmic"):
        fitted(sweep.draw(rattle.read(made["sweep"])), ylim=(-1.0, 1.0))


def test_without_wishes_nothing_changes(figure):
    before = [(text.get_text(), text.get_fontsize()) for text in figure.findobj(Text)]
    size = tuple(figure.get_size_inches())
    with style.house_style():
        fit(figure, options())
    assert [(text.get_text(), text.get_fontsize()) for text in figure.findobj(Text)] == before
    assert tuple(figure.get_size_inches()) == size


def test_pixels_are_those_of_the_width(idle, tmp_path):
    done = call_script(
        "plot.py", "motion", idle.path, "--figures", 8, "--width", 80, "--dpi", 254, "--output", tmp_path
    )
    assert done.returncode == 0, done.stderr
    picture = imread(tmp_path / "figure_08_idle.png")
    assert picture.shape[1] == 800
    assert 0.01 < (picture[:, :, :3].min(axis=2) < 0.7).mean() < 0.5


@pytest.mark.parametrize(
    ("given", "words"),
    (
        (("--xlim", "3,1"), "not two rising numbers"),
        (("--ylim", "1"), "not two rising numbers"),
        (("--font-size", "100"), "not a size of type"),
        (("--frequency", "order"), "has no &shaft speed_rpm that orders could count; give --shaft-speed"),
        (("--shaft-speed", "900"), "--shaft-speed belongs to --frequency order"),
    ),
)
def test_wishes_that_cannot_be_met_are_refused(idle, tmp_path, given, words):
    done = call_script("plot.py", "motion", idle.path, *given, "--output", tmp_path / "out")
    assert done.returncode == 2 and words in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(("frequency", "factor"), (("ratio", 1.0), ("hz", 500.0), ("order", 500.0 / 150.0)))
def test_spectra_stand_over_what_was_asked_for(idle, frequency, factor):
    view = spectra.View(frequency, 9000.0)
    extent = motion.Extent(4, None, view)
    with style.house_style():
        ((_, spectrum),) = motion.single_figures([idle], [10], extent)
        ((_, force),) = motion.single_figures([idle], [7], extent)
    places, heights = drawn.bars(spectrum.axes[0])[1]
    strong = heights > 0.1
    np.testing.assert_allclose(places[strong], factor * np.array(list(LINES)))
    np.testing.assert_allclose(heights[strong], list(LINES.values()), rtol=1e-9)
    places, heights = drawn.bars(force.axes[0])[0]
    np.testing.assert_allclose(places[heights > 1.0], [0.0, factor])
    words = {"ratio": "Frequency ratio", "hz": "Frequency [Hz]", "order": "Engine order [-]"}
    for made_figure in (spectrum, force):
        assert made_figure.axes[-1].get_xlabel().startswith(words[frequency])


HALVES = {0.0: 3.0, 4.0: 9.0, 5.0: 0.5, 12.0: 2.0}


def shafted(folder: Path, name: str, speed: float = 15000.0) -> rattle.Result:
    """A motion of 500 Hz on a shaft that turns half as often in a second: engine order 2 is harmonic 1."""
    path = write_motion(folder / f"{name}.rattle", lines=HALVES, force={4: 150.0, 12: 20.0})
    source = rattle.read(path)
    columns = [(column, source.units[column]) for column in source.names]
    rows = list(zip(*(source[column].tolist() for column in source.names), strict=True))
    text = source.input_text + f"&shaft\n speed_rpm = {speed}\n/\n"
    return rattle.read(write_result(path, columns, rows, input_text=text))


def test_where_there_is_a_shaft_lines_stand_at_engine_orders(tmp_path):
    """Also those of an overlay, each at its own shaft; beside a run without a shaft all are harmonics."""
    whole, half = shafted(tmp_path, "whole"), shafted(tmp_path, "half", 60000.0)
    plain = rattle.read(write_motion(tmp_path / "plain.rattle", lines=HALVES, force={4: 150.0}))
    with style.house_style():
        alone = spectra.draw_acceleration([whole], ["whole"], None)
        force = spectra.draw_force([whole], ["whole"], None)
        asked = spectra.draw_acceleration([whole], ["whole"], None, spectra.View("ratio"))
        both = spectra.draw_force([whole, half], ["whole", "half"], None)
        mixed = spectra.draw_force([whole, plain], ["whole", "plain"], None)
    assert [made.axes[-1].get_xlabel() for made in (alone, force, asked, both, mixed)] == [
        "Engine order [-]",
        "Engine order [-]",
        "Harmonic, multiple of 500 Hz",
        "Engine order [-]; runs side by side",
        "Harmonic, multiple of 500 Hz; runs side by side",
    ]
    driven = drawn.bars(alone.axes[0])[2]
    np.testing.assert_allclose(driven, [[8.0, 24.0], [9.0, 2.0]], rtol=1e-9)
    assert drawn.legend_words(alone) == [
        "harmonics of 500 Hz",
        "orders of the force: 8, 24",
        "1 % of the line of engine order 8",
    ]
    assert drawn.legend_words(asked)[-1] == "1 % of harmonic 4"
    for made, factors in ((force, (2.0,)), (both, (2.0, 0.5)), (mixed, (1.0, 1.0))):
        shifts = (0.0,) if len(factors) == 1 else (-0.03, 0.03)
        for (places, heights), factor, shift in zip(drawn.bars(made.axes[0]), factors, shifts, strict=True):
            np.testing.assert_allclose(places[heights > 100.0], [factor * shift, factor * (4.0 + shift)])


def test_orders_count_the_shaft_of_the_scene(repository, run, tmp_path):
    scene = repository / "input" / "loose_pair.nml"
    assert run(scene, "--set", "spectrum.verify=.false.", "--output", tmp_path, cwd=tmp_path).returncode == 0
    result = rattle.read(tmp_path / "loose_pair.rattle")
    for speed, factor in ((None, 2.0), (1600.0, 1.0)):
        with style.house_style():
            figure = spectra.draw_force([result], ["pair"], None, spectra.View("order", speed))
        places, heights = drawn.bars(figure.axes[0])[0]
        strong = places[heights > 0.1]
        np.testing.assert_allclose(strong, factor * np.arange(4.0), atol=1e-12)


def test_levels_are_those_of_the_amplitudes(idle):
    with style.house_style():
        figure = spectra.draw_acceleration([idle], ["idle"], None, spectra.View(decibels=True))
    (axes,) = figure.axes
    assert "dB re 10$^{-6}$ m/s$^2$" in axes.get_ylabel()
    levels = [float(label.get_text()) for label in axes.get_yticklabels()]
    assert len(levels) >= 4
    for place, level in zip(axes.get_yticks(), levels, strict=True):
        assert level == pytest.approx(20.0 * np.log10(place / 1e-6))
    assert 140.0 in levels and pytest.approx(1e-6 * 10.0 ** (140.0 / 20.0)) == 10.0


def test_runs_side_by_side_have_marks_of_their_own(idle):
    with style.house_style():
        figure = spectra.draw_acceleration([idle, idle], ["one", "two"], None)
    marks = [line.get_marker() for line in figure.axes[0].lines]
    assert len(set(marks)) == len(marks) == 2
    assert [handle.get_marker() for handle in figure.legends[0].legend_handles] == marks
    assert len(set(style.RUN_MARKS)) == len(style.RUN_COLOURS)


def test_a_short_impact_has_a_panel_of_its_own(tmp_path):
    hard = rattle.read(
        write_motion(tmp_path / "hard.rattle", lines=IMPACT, steps_per_period=1024, periods=16, window=8)
    )
    with style.house_style():
        figure = histories.draw_acceleration([hard], ["hard"], 4)
    whole, near = figure.axes
    first, last = near.get_xlim()
    assert 0.0 < last - first < 0.1 * (whole.get_xlim()[1] - whole.get_xlim()[0])
    time, values = drawn.curves(near)[0]
    inside = (time > first) & (time < last)
    assert inside.sum() > 8 and np.abs(values[inside]).max() == pytest.approx(np.abs(values).max())


def test_long_impacts_and_those_between_samples_have_none(idle, tmp_path):
    coarse = rattle.read(
        write_motion(tmp_path / "b.rattle", lines=IMPACT, steps_per_period=128, periods=16, window=8)
    )
    for result in (idle, coarse):
        assert histories.impact(result, 4) is None


@pytest.mark.long
def test_pairs_of_runs_stand_below_each_other_in_a_column(tmp_path):
    loose = write_motion(tmp_path / "loose.rattle", lines={1.0: 4.0}, tolerance=1e-7)
    tight = write_motion(tmp_path / "tight.rattle", lines={1.0: 5.0})
    pairs = [
        tolerance.Pair(name, rattle.read(loose), rattle.read(tight), 6.0) for name in ("First", "Second")
    ]
    for width, columns in ((80.0, 1), (160.0, 2)):
        with style.house_style():
            made = tolerance.draw(pairs, 3, 16, is_narrow(width / 25.4))
        fitted(made, width=width)
        assert len({round(axes.get_position().x0, 2) for axes in made.axes}) == columns
        (legend,) = made.legends
        words = [text.get_text() for text in legend.get_texts()]
        assert [words[0], words[3]] == ["(a) First", "(b) Second"] and len(words) == 6


def test_names_of_keys_are_those_that_people_use():
    assert short_name("oil.temperature_celsius") == "oil temperature"
    assert short_name("shaft.speed_rpm") == "shaft speed"
    assert short_name("gear.helix_angle_deg") == "helix angle"
    assert short_name("load.force_amplitude") == "force amplitude"
    assert with_unit("oil density", "kg/m3") == "Oil density [kg/m$^3$]"
