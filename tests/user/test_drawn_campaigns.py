"""What the pictures of campaigns show: the numbers of the file, in the unit that is named."""

from __future__ import annotations

from pathlib import Path

import drawn
import numpy as np
import pytest
from campaign_writer import (
    FORCE,
    FORCES,
    SPEED,
    SPEEDS,
    VISCOSITIES,
    VISCOSITY,
    Key,
    Made,
    grid,
    sample,
    with_verdicts,
)
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection, QuadMesh
from matplotlib.colors import to_hex
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure

import rattle
from rattle.campaign_result import Campaign
from rattle.campaign_section import new_section
from rattle.codes import CLASSES
from rattle.figures import campaign as campaign_figure
from rattle.figures import campaign_look as look
from rattle.figures import campaign_map, campaign_slice, campaign_summary, fit, style

VERDICTS = ("no separation", "separation without impact", "single-sided impacts", "double-sided impacts")
WORDS = {code: word.replace("_", " ") for code, word in CLASSES.items()}

# A chunk of 20 scenes is the row of one speed, as the force varies fastest.
# Borders of the cells about 20, 40, ... 400 N; the outer ones are the ends of what was computed.
LINEAR_FORCE = np.clip(np.linspace(10.0, 410.0, 21), 20.0, 400.0)
LOGARITHMIC_SPEED = 0.5 * 10.0 ** (np.clip(np.arange(16) - 0.5, 0.0, 14.0) / 14.0)


@pytest.fixture
def made() -> Made:
    return grid(FORCES, SPEEDS, failures=True, chunk_rows=20)


def read(made: Made, directory: Path, **options) -> Campaign:
    return rattle.read_campaign(made.write(directory / "map.rattle", **options))


def draw_map(campaign: Campaign, column: str, *, x: str = FORCE, y: str = SPEED, **options) -> Figure:
    with style.house_style():
        return campaign_map.draw(new_section(campaign, (x, y), {}), column, campaign_map.Options(**options))


def cells(axes: Axes) -> QuadMesh:
    (mesh,) = (one for one in axes.collections if isinstance(one, QuadMesh))
    return mesh


def shown_grid(made: Made, column: str) -> np.ndarray:
    """A column with a row for each speed, as the picture has them from below."""
    return made.column(column).reshape(15, 20)


def hatched(axes: Axes) -> dict[str, np.ndarray]:
    """For each hatch, the middles of the cells (force, speed) that it covers, as a mask."""
    forces, speeds = (0.5 * (edges[1:] + edges[:-1]) for edges in (LINEAR_FORCE, LOGARITHMIC_SPEED))
    found = {}
    for area in axes.collections:
        if isinstance(area, QuadContourSet) and area.filled:
            (path,) = area.get_paths()
            inside = [[path.contains_point((force, speed)) for force in forces] for speed in speeds]
            found[area.hatches[0]] = np.array(inside)
    return found


# --- maps ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("column", "factor", "label"),
    [
        ("film_minimum", 1e6, "Film minimum [\N{MICRO SIGN}m]"),
        ("acceleration_maximum", 1.0, "Acceleration maximum [m/s$^2$]"),
        ("natural_frequency", 1.0, "Natural frequency [Hz]"),
        ("harmonic_distortion", 1.0, "Harmonic distortion [-]"),
    ],
)
def test_a_map_of_numbers_holds_them_in_the_unit_of_its_bar(made, tmp_path, column, factor, label):
    figure = draw_map(read(made, tmp_path), column, contours=())
    axes, bar = figure.axes
    values = factor * shown_grid(made, column)
    mesh = cells(axes)
    np.testing.assert_allclose(np.ma.filled(mesh.get_array(), np.nan), values, rtol=1e-12)
    corners = mesh.get_coordinates()
    np.testing.assert_allclose(corners[0, :, 0], LINEAR_FORCE, rtol=1e-12)
    np.testing.assert_allclose(corners[:, 0, 1], LOGARITHMIC_SPEED, rtol=1e-12)
    assert bar.get_ylabel() == label
    assert (mesh.norm.vmin, mesh.norm.vmax) == pytest.approx((np.nanmin(values), np.nanmax(values)))
    assert (axes.get_xscale(), axes.get_yscale()) == ("linear", "log")
    assert axes.get_xlim() == pytest.approx((20.0, 400.0))
    assert axes.get_ylim() == pytest.approx((LOGARITHMIC_SPEED[0], LOGARITHMIC_SPEED[-1]))
    assert drawn.labels(axes) == ("Force amplitude [N]", "Entrainment speed [m/s]")
    assert axes.get_title(loc="left") == f"{label.partition(' [')[0]}: map"


def test_a_map_with_its_axes_exchanged_is_turned(made, tmp_path):
    axes = draw_map(read(made, tmp_path), "film_minimum", x=SPEED, y=FORCE, contours=()).axes[0]
    values = 1e6 * shown_grid(made, "film_minimum").T
    np.testing.assert_allclose(np.ma.filled(cells(axes).get_array(), np.nan), values, rtol=1e-12)
    assert drawn.labels(axes) == ("Entrainment speed [m/s]", "Force amplitude [N]")
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "linear")


def test_every_class_has_its_colour_and_its_share(made, tmp_path):
    figure = draw_map(read(made, tmp_path), "rattle_class", contours=())
    (axes,) = figure.axes
    mesh = cells(axes)
    classes = shown_grid(made, "rattle_class")
    for code in CLASSES:
        assert to_hex(mesh.cmap(mesh.norm(code))).upper() == look.CLASS_COLOURS[code]
        count = int((classes == code).sum())
        assert f"{WORDS[code]} ({look.share(count, 300)})" in drawn.legend_words(figure)
    np.testing.assert_array_equal(np.ma.filled(mesh.get_array(), np.nan), classes)
    colours = {
        handle.get_label().split(" (")[0]: to_hex(handle.get_facecolor()).upper()
        for handle in figure.legends[0].legend_handles
    }
    assert {word: colours[word] for word in WORDS.values()} == {
        WORDS[code]: look.CLASS_COLOURS[code] for code in CLASSES
    }


def test_codes_that_do_not_occur_are_not_in_the_legend(made, tmp_path):
    words = drawn.legend_words(draw_map(read(made, tmp_path), "status", contours=()))
    status = made.column("status")
    expected = {1: "steady", 3: "film lost", 4: "no rigid film"}
    assert words == [
        f"{word} ({look.share(int((status == code).sum()), 300)})" for code, word in expected.items()
    ]


@pytest.mark.parametrize("column", ["verified", "law_contradicted"])
def test_flags_are_no_and_yes(made, tmp_path, column):
    figure = draw_map(read(made, tmp_path), column, contours=())
    mesh = cells(figure.axes[0])
    bad = {"verified": 0, "law_contradicted": 1}[column]
    assert to_hex(mesh.cmap(mesh.norm(bad))).upper() == "#D55E00"
    no = int((made.column(column) == 0.0).sum())
    assert f"no ({look.share(no, 300)})" in drawn.legend_words(figure)


def test_gaps_cover_the_scenes_that_failed_or_are_not_done(made, tmp_path):
    figure = draw_map(read(made, tmp_path, undone=[7], closed=False), "rattle_class", contours=())
    (axes,) = figure.axes
    status, done = shown_grid(made, "status"), np.ones((15, 20), dtype=bool)
    done[7] = False
    lost, rigid = done & (status == 3.0), done & (status == 4.0)
    found = hatched(axes)
    np.testing.assert_array_equal(found[look.HATCHES[0]], lost)
    np.testing.assert_array_equal(found[look.HATCHES[1]], rigid)
    np.testing.assert_array_equal(found[look.NOT_DONE_HATCH], ~done)
    so_far = done & (shown_grid(made, "rattle_class") == look.IRREGULAR_SO_FAR)
    lacking = done & (shown_grid(made, "verified") == 0.0) & ~so_far
    gaps = [word for word in drawn.legend_words(figure) if word.split(" (")[0] not in CLASSES.values()]
    # Once, for colour and hatch.
    assert gaps.pop() == f"irregular so far ({look.share(int(so_far.sum()), 300)})"
    assert gaps == [
        f"film lost ({look.share(int(lost.sum()), 300)})",
        f"no rigid film ({look.share(int(rigid.sum()), 300)})",
        f"not done ({look.share(20, 300)})",
        f"not verified ({look.share(int(lacking.sum()), 300)})",
    ]
    assert axes.get_title(loc="left") == "Rattle class: map"


@pytest.mark.parametrize("column", ["rattle_class", "film_minimum"])
def test_what_is_not_verified_is_hatched_over_its_colour(made, tmp_path, column):
    figure = draw_map(read(made, tmp_path), column, contours=())
    so_far = shown_grid(made, "rattle_class") == look.IRREGULAR_SO_FAR
    axes, lacking = figure.axes[0], (shown_grid(made, "verified") == 0.0) & ~so_far
    assert so_far.any()
    np.testing.assert_array_equal(hatched(axes)[look.SO_FAR_HATCH], so_far)
    np.testing.assert_array_equal(hatched(axes)[look.UNCERTAIN_HATCH], lacking)
    for area in axes.collections:
        if isinstance(area, QuadContourSet) and area.filled and area.hatches[0] == look.UNCERTAIN_HATCH:
            assert (area.get_facecolor()[:, 3] == 0.0).all()
    assert f"not verified ({look.share(int(lacking.sum()), 300)})" in drawn.legend_words(figure)


@pytest.mark.parametrize(
    ("column", "drawn_motion"),
    [
        ("loudest_class", "the loudest"),
        ("loudest_verdict", "the loudest"),
        ("film_minimum", "that from rest"),
    ],
)
def test_several_motions_are_hatched_crosswise(made, tmp_path, column, drawn_motion):
    """The legend says which of them is drawn; the usual map is that of the loudest."""
    motions = 1.0 + (made.column("film_minimum") > np.nanmedian(made.column("film_minimum")))
    assert campaign_figure.usual_columns(read(made, tmp_path)) == ["rattle_class"]
    verdicts = np.arange(300) % 4
    made.rows = np.column_stack([made.rows, motions, made.column("rattle_class"), verdicts])
    made.columns = [*made.columns, ("motions", "-"), ("loudest_class", "-"), ("loudest_verdict", "-")]
    campaign = read(made, tmp_path)
    figure = draw_map(campaign, column, contours=())
    several = motions.reshape(15, 20) > 1.0
    np.testing.assert_array_equal(hatched(figure.axes[0])[look.SEVERAL_HATCH], several)
    share = look.share(int(several.sum()), 300)
    assert f"several motions, {drawn_motion} drawn ({share})" in drawn.legend_words(figure)
    assert campaign_figure.usual_columns(campaign) == ["loudest_verdict"]
    if column.startswith("loudest"):
        title = figure.axes[0].get_title(loc="left")
        words = column.removeprefix("loudest_").capitalize()
        assert title.startswith(f"{words} of the loudest motion: map")


def test_a_map_of_verifications_needs_no_hatch(made, tmp_path):
    figure = draw_map(read(made, tmp_path), "verified", contours=())
    assert look.UNCERTAIN_HATCH not in hatched(figure.axes[0])


def test_every_class_verified_leaves_no_hatch(made, tmp_path):
    made.column("verified")[:] = 1.0
    figure = draw_map(read(made, tmp_path), "rattle_class", contours=())
    assert look.UNCERTAIN_HATCH not in hatched(figure.axes[0])
    assert not any("verified" in words for words in drawn.legend_words(figure))


def bilinear(x: np.ndarray, y: np.ndarray, values: np.ndarray, point: np.ndarray) -> float:
    """`values`, a row for each y, between its points."""
    along = np.array([np.interp(point[0], x, row) for row in values])
    return float(np.interp(point[1], y, along))


def test_contours_lie_where_their_labels_say(made, tmp_path):
    made.column("verified")[:] = 1.0
    made.column("rattle_class")[made.column("rattle_class") == look.IRREGULAR_SO_FAR] = 5.0
    figure = draw_map(read(made, tmp_path), "rattle_class")
    (axes,) = figure.axes
    sets = [one for one in axes.collections if isinstance(one, QuadContourSet) and not one.filled]
    quantities = (shown_grid(made, "natural_frequency") / 600.0, shown_grid(made, "damping_ratio"))
    assert len(sets) == 2
    for lines, values in zip(sets, quantities, strict=True):
        assert len(lines.levels) >= 3
        for level, segments in zip(lines.levels, lines.allsegs, strict=True):
            for point in (one for segment in segments for one in segment):
                found = bilinear(FORCES.values, SPEEDS.values, values, point)
                assert np.isnan(found) or found == pytest.approx(level, rel=1e-6)
    assert sets[0].get_linestyle() != sets[1].get_linestyle()
    words = drawn.legend_words(figure)
    assert words[-2:] == [r"natural frequency $f_n/f_\mathrm{exc}$", r"damping ratio $\zeta$"]


def test_a_varied_frequency_is_that_of_each_scene(tmp_path):
    made = grid(Key("load.force_amplitude", 20.0, 400.0, 4), Key(SPEED, 0.5, 5.0, 3))
    made.columns[2] = ("load.frequency", "Hz")
    made.group = made.group.replace(SPEED, "load.frequency")
    campaign = read(made, tmp_path)
    expected = campaign["natural_frequency"] / campaign["load.frequency"]
    np.testing.assert_array_equal(look.frequency_ratio(campaign), expected)


@pytest.mark.parametrize(
    ("low", "high", "scale", "logarithmic"),
    [
        (1.0, 99.0, "auto", False),
        (1.0, 101.0, "auto", True),
        (-1.0, 1e4, "auto", False),
        (1.0, 2.0, "logarithmic", True),
        (1.0, 1e6, "linear", False),
    ],
)
def test_colours_are_logarithmic_over_more_than_two_decades(low, high, scale, logarithmic):
    norm = look.colour_norm(np.array([low, 0.5 * (low + high), high, np.nan]), scale)
    assert (norm.vmin, norm.vmax) == (low, high)
    middle = np.sqrt(low * high) if logarithmic else 0.5 * (low + high)
    assert float(norm(middle)) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("count", "words"), [(0, "0.0 %"), (1, "< 0.1 %"), (123, "1.2 %"), (10000, "100.0 %")]
)
def test_shares_are_in_percent(count, words):
    assert look.share(count, 10000) == words
    assert look.share(0, 0) == "0 %"


def test_dots_stand_at_their_scenes(tmp_path):
    made = sample(failures=True)
    with style.house_style():
        figure = campaign_map.draw_points(
            read(made, tmp_path), FORCE, SPEED, "film_minimum", campaign_map.Options(contours=())
        )
    axes, bar = figure.axes
    dots, *crosses, rings, diamonds = (one for one in axes.collections if isinstance(one, PathCollection))
    status, film = made.column("status"), made.column("film_minimum")
    places = np.column_stack([made.column(FORCE), made.column(SPEED)])
    known = status == 1.0
    np.testing.assert_allclose(dots.get_offsets(), places[known])
    np.testing.assert_allclose(dots.get_array(), 1e6 * film[known])
    for marks, code in zip(crosses, (3.0, 4.0), strict=True):
        np.testing.assert_allclose(marks.get_offsets(), places[status == code])
    so_far = made.column("rattle_class") == look.IRREGULAR_SO_FAR
    lacking = (made.column("verified") == 0.0) & ~so_far
    np.testing.assert_allclose(diamonds.get_offsets(), places[so_far])
    np.testing.assert_allclose(rings.get_offsets(), places[lacking])
    assert rings.get_facecolor().size == 0
    assert bar.get_ylabel() == "Film minimum [\N{MICRO SIGN}m]"
    lost, rigid = (int((status == code).sum()) for code in (3.0, 4.0))
    gaps = [f"film lost ({lost})", f"no rigid film ({rigid})"]
    assert drawn.legend_words(figure) == [
        *gaps,
        f"not verified ({int(lacking.sum())})",
        f"irregular so far ({int(so_far.sum())})",
    ]
    assert (axes.get_xscale(), axes.get_yscale()) == ("linear", "log")
    forces, speeds = made.column(FORCE), np.log(made.column(SPEED))
    room = 0.03 * np.ptp(forces)
    assert axes.get_xlim() == pytest.approx((forces.min() - room, forces.max() + room))
    room = 0.03 * np.ptp(speeds)
    assert np.log(axes.get_ylim()) == pytest.approx((speeds.min() - room, speeds.max() + room))


# --- the verdict ---------------------------------------------------------------------------------------


def test_a_map_of_the_verdict_has_four_colours_forces_limit_and_hatch(made, tmp_path):
    """What the law does not hold for lies inside the outline, what is not verified below the hatch."""
    with_verdicts(made)
    made.column("law_contradicted")[:] = 0.0
    beyond = (made.column(FORCE) > 210.0) & (made.column(SPEED) > 1.0)
    made.column("law_contradicted")[beyond] = 1.0
    figure = draw_map(read(made, tmp_path), "verdict")
    (axes,) = figure.axes
    np.testing.assert_array_equal(
        np.ma.filled(cells(axes).get_array(), np.nan).reshape(15, 20),
        shown_grid(made, "verdict"),
    )
    colours = {code: to_hex(cells(axes).cmap(cells(axes).norm(code))).upper() for code in range(5)}
    assert colours == look.VERDICT_COLOURS and len(set(colours.values())) == 5
    lacking = shown_grid(made, "verdict_verified") == 0.0
    np.testing.assert_array_equal(hatched(axes)[look.UNCERTAIN_HATCH], lacking)
    lines = [one for one in axes.collections if isinstance(one, QuadContourSet) and not one.filled]
    (outline,) = (one for one in lines if to_hex(one.get_edgecolor()[0]).upper() == campaign_map.LIMIT_COLOUR)
    corner = np.min(np.concatenate(outline.allsegs[0]), axis=0)
    first = [int(np.argmax(keys.values > least)) for keys, least in ((FORCES, 210.0), (SPEEDS, 1.0))]
    assert corner == pytest.approx((LINEAR_FORCE[first[0]], LOGARITHMIC_SPEED[first[1]]))
    (forces,) = (one for one in lines if getattr(one, "labelTexts", ()))
    for level, segments in zip(forces.levels, forces.allsegs, strict=True):
        for point in np.concatenate(segments):
            # Forces grow with the force alone, on a grid of 20 N.
            assert 0.01 * point[0] ** 1.5 == pytest.approx(level, rel=0.05)
    words = drawn.legend_words(figure)
    shares = [f"{name} (25.0 %)" for name in VERDICTS]
    assert words[:4] == shares
    assert words[-2:] == [
        f"film law does not fit ({look.share(int(beyond.sum()), 300)})",
        "film force rms [N]",
    ]
    assert f"not verified ({look.share(int(lacking.sum()), 300)})" in words
    assert axes.get_title(loc="left") == "Verdict: map, published iso-viscous film"


def test_a_map_says_where_verdicts_were_not_put_to_the_test(made, tmp_path):
    figure = draw_map(read(with_verdicts(made, verified=False), tmp_path), "verdict")
    assert "whether it is verified was not recorded" in drawn.legend_words(figure)
    assert look.UNCERTAIN_HATCH not in hatched(figure.axes[0])


def test_levels_of_forces_is_known_apart():
    for low, high in ((0.2, 0.9), (1.1, 60.0), (0.01, 5000.0), (1e-6, 1e6)):
        levels = campaign_map._levels_of_forces(low, high)
        assert all(low < level < high for level in levels) and levels == sorted(levels)
        assert 1 <= len(levels) <= campaign_map.MOST_FORCE_LEVELS or high / low > 1e6


def test_no_legend_is_wider_than_its_figure(made, tmp_path):
    path = with_verdicts(made).write(tmp_path / "map.rattle")
    figure = draw_map(rattle.read_campaign(path), "verdict")
    fit.narrow_legends(figure)
    figure.draw_without_rendering()
    (legend,) = figure.legends
    box = legend.get_window_extent()
    assert box.x0 >= 0.0 and box.x1 <= figure.get_figwidth() * figure.dpi


# --- slices --------------------------------------------------------------------------------------------


def test_a_slice_shows_its_columns_over_bands_of_the_classes(made, tmp_path):
    campaign = read(made, tmp_path, undone=[14], closed=False)
    columns = ["film_minimum", "acceleration_maximum", "rattle_class"]
    with style.house_style():
        figure = campaign_slice.draw(new_section(campaign, (SPEED,), {FORCE: 400.0}), columns)
    film, acceleration, classes = figure.axes
    row = {column: shown_grid(made, column)[:, 19].copy() for column in columns}
    for values in row.values():
        values[14] = np.nan
    for axes, column, factor in (
        (film, columns[0], 1e6),
        (acceleration, columns[1], 1.0),
        (classes, columns[2], 1.0),
    ):
        ((speed, shown),) = drawn.curves(axes)
        np.testing.assert_array_equal(speed, SPEEDS.values)
        np.testing.assert_allclose(shown, factor * row[column], rtol=1e-12)
        assert axes.get_xscale() == "log"
        assert axes.get_xlim() == pytest.approx((LOGARITHMIC_SPEED[0], LOGARITHMIC_SPEED[-1]))
    assert film.get_ylabel() == "Film minimum\n[\N{MICRO SIGN}m]"
    assert acceleration.get_ylabel() == "Acceleration maximum\n[m/s$^2$]"
    assert classes.get_xlabel() == "Entrainment speed [m/s]"
    ticks = dict(
        zip(classes.get_yticks(), (text.get_text() for text in classes.get_yticklabels()), strict=True)
    )
    assert ticks == WORDS
    assert film.get_title(loc="left").endswith("force amplitude = 400 N")
    bands = {}
    for patch in film.patches:
        low, high = patch.get_x(), patch.get_x() + patch.get_width()
        colour = to_hex(patch.get_facecolor()).upper()
        inside = tuple(np.flatnonzero((low < SPEEDS.values * 1.001) & (SPEEDS.values * 0.999 < high)))
        bands.setdefault((colour, patch.get_hatch()), []).extend(inside)
    status, codes = shown_grid(made, "status")[:14, 19], row["rattle_class"]
    for code, colour in look.CLASS_COLOURS.items():
        expected = np.flatnonzero(codes == code)
        assert bands.get((colour, None), []) == list(expected)
    assert bands[(look.GAP_COLOUR, look.HATCHES[0])] == list(np.flatnonzero(status == 3.0))
    assert bands[(look.GAP_COLOUR, look.NOT_DONE_HATCH)] == [14]
    so_far = shown_grid(made, "rattle_class")[:14, 19] == look.IRREGULAR_SO_FAR
    lacking = np.flatnonzero((shown_grid(made, "verified")[:14, 19] == 0.0) & ~so_far)
    assert lacking.size and bands[("#000000", look.UNCERTAIN_HATCH)] == list(lacking)


def test_a_slice_is_logarithmic_over_more_than_two_decades(made, tmp_path):
    made.column("film_minimum")[:] = np.repeat(np.geomspace(1e-8, 2e-6, 15), 20)
    made.column("film_maximum")[:] = np.repeat(np.geomspace(1e-8, 0.5e-6, 15), 20)
    section = new_section(read(made, tmp_path), (SPEED,), {})
    with style.house_style():
        figure = campaign_slice.draw(section, ["film_minimum", "film_maximum"])
    assert [axes.get_yscale() for axes in figure.axes] == ["log", "linear"]


# --- the page ------------------------------------------------------------------------------------------


@pytest.fixture
def page(made, tmp_path) -> Figure:
    """The page on a campaign of which one chunk is not done."""
    campaign = read(made, tmp_path, undone=[7], closed=False)
    worst = campaign_summary.Worst([5, 299], "film_minimum", smallest=True)
    with style.house_style():
        return campaign_summary.draw(campaign, worst)


def panel(page: Figure, title: str) -> Axes:
    (axes,) = (one for one in page.axes if one.get_title(loc="left").startswith(title))
    return axes


def test_the_page_counts_classes_and_endings(page, made):
    done = np.ones(300, dtype=bool)
    done[140:160] = False
    classes, status = made.column("rattle_class")[done], made.column("status")[done]
    expected = {WORDS[code]: int((classes == code).sum()) for code in CLASSES}
    expected["no class"] = int(np.isnan(classes).sum())
    shares = panel(page, "Share of classes")
    assert drawn.lying_bars(shares) == expected
    whole = sum(expected.values())
    ends = [f"{count:,}  ({look.share(count, whole)})" for count in expected.values()]
    assert [text.get_text() for text in shares.texts] == ends
    endings = {"steady": 1, "film lost": 3, "no rigid film": 4}
    expected = {words: int((status == code).sum()) for words, code in endings.items()} | {"not done": 20}
    failed = expected["film lost"] + expected["no rigid film"]
    ended = panel(page, "How scenes ended")
    assert drawn.lying_bars(ended) == expected
    assert ended.get_title(loc="left") == f"How scenes ended: {look.share(failed, 280)} failed"
    colours = [to_hex(bar.get_facecolor()).upper() for bar in ended.patches]
    assert colours == ["#0072B2", "#D55E00", "#D55E00", look.GAP_COLOUR]
    assert [to_hex(bar.get_facecolor()).upper() for bar in shares.patches][: len(CLASSES)] == list(
        look.CLASS_COLOURS.values()
    )


def test_the_page_maps_classes_and_verifications(page, made):
    for title, column in (("Rattle class", "rattle_class"), ("Verification fails", "verified")):
        axes = panel(page, title)
        values = shown_grid(made, column).copy()
        values[7] = np.nan
        np.testing.assert_array_equal(np.ma.filled(cells(axes).get_array(), np.nan), values)
        assert drawn.labels(axes) == ("Force amplitude [N]", "Entrainment speed [m/s]")
        assert axes.get_xlim() == pytest.approx((20.0, 400.0))
    verified = np.delete(made.column("verified"), slice(140, 160))
    judged, failing = int(np.isfinite(verified).sum()), int((verified == 0.0).sum())
    words = f"Verification fails in {look.share(failing, judged)} of {judged} scenes"
    assert panel(page, "Verification").get_title(loc="left") == words
    legend = [text.get_text() for text in panel(page, "Verification").get_legend().get_texts()]
    assert legend[0].startswith("verification fails") and legend[1].startswith("verification holds")


def test_the_page_lists_the_worst_scenes_in_the_unit_of_the_head(page, made):
    table = panel(page, "Worst scenes, smallest film minimum").texts[0].get_text().splitlines()
    assert "film minimum [\N{MICRO SIGN}m]" in table[0] and "force amplitude [N]" in table[0]
    for line, row in zip(table[2:], (5, 299), strict=True):
        cells = line.split()
        assert cells[0] == f"map_{row + 1:03d}.nml"
        assert cells[1:3] == [f"{made.column(key)[row]:.4g}" for key in (FORCE, SPEED)]
        film = made.column("film_minimum")[row]
        assert cells[3] == ("nan" if np.isnan(film) else f"{1e6 * film:.4g}")
    head = drawn.all_words(page)
    assert "Campaign map, 280 of 300 scenes" in head
    assert "force amplitude: 20 to 400 N (linear, 20 values)" in head
    assert "entrainment speed: 0.5 to 5 m/s (logarithmic, 15 values)" in head


def test_the_page_shows_how_often_verifications_fail_over_further_keys(tmp_path):
    made = grid(FORCES, SPEEDS, VISCOSITIES, name="deep")
    campaign = read(made, tmp_path)
    with style.house_style():
        page = campaign_summary.draw(campaign, campaign_summary.Worst([], "film_minimum", smallest=False))
    axes = panel(page, "Verification fails")
    lacking = (made.column("verified") == 0.0).reshape(3, 15, 20).mean(axis=0)
    np.testing.assert_allclose(cells(axes).get_array(), lacking, rtol=1e-12)
    assert cells(axes).norm.vmax == 1.0 and cells(axes).norm.vmin == 0.0
    held = panel(page, "Rattle class at")
    np.testing.assert_array_equal(
        np.ma.filled(cells(held).get_array(), np.nan), made.column("rattle_class").reshape(3, 15, 20)[1]
    )
    assert held.get_title(loc="left") == "Rattle class at\nviscosity = 0.3 Pa s"


def test_the_page_of_one_key_shows_codes_over_it(tmp_path):
    made = grid(FORCES, failures=True, name="line")
    with style.house_style():
        page = campaign_summary.draw(
            read(made, tmp_path), campaign_summary.Worst([0], "film_minimum", smallest=False)
        )
    axes = panel(page, "Rattle class")
    dots = [one for one in axes.collections if isinstance(one, PathCollection)]
    for marks, code in zip(dots, CLASSES, strict=True):
        forces = FORCES.values[made.column("rattle_class") == code]
        np.testing.assert_allclose(marks.get_offsets(), np.column_stack([forces, np.full(forces.size, code)]))
        if forces.size:
            assert to_hex(marks.get_facecolor()[0]).upper() == look.CLASS_COLOURS[code]
        assert axes.get_yticklabels()[code - 1].get_text() == WORDS[code]
    assert axes.get_xlabel() == "Force amplitude [N]"


def test_held_keys_are_the_ones_asked_for(tmp_path):
    made = grid(FORCES, SPEEDS, VISCOSITIES, name="deep")
    section = new_section(read(made, tmp_path), (FORCE, SPEED), {VISCOSITY: 0.9})
    with style.house_style():
        axes = campaign_map.draw(section, "film_minimum", campaign_map.Options(contours=())).axes[0]
    expected = 1e6 * made.column("film_minimum").reshape(3, 15, 20)[2]
    np.testing.assert_allclose(cells(axes).get_array(), expected, rtol=1e-12)
    assert axes.get_title(loc="left").endswith("viscosity = 0.9 Pa s")
