"""What the figures of films show: the numbers of the kernels, in the unit that the axis names."""

from __future__ import annotations

from pathlib import Path

import drawn
import numpy as np
import pytest
from film_writer import ALPHA, LENGTH, RADIUS, SQUEEZE_RATIOS, VISCOSITY, write_points, write_profiles
from kernel_module import kernels
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.text import Annotation

from rattle.command import CommandError
from rattle.figures import (
    film_fit,
    film_points,
    film_pressures,
    film_slopes,
    regime_map,
    style,
)

FILM_RATIO, SPEED_GROUP = 70e-6, 0.45e-6
FILM_RATIOS = np.geomspace(35e-6, 140e-6, 21)
SPEED = SPEED_GROUP * RADIUS / (VISCOSITY * ALPHA)
CHOICE = film_points.Choice(speed_group=SPEED_GROUP)


@pytest.fixture
def film(tmp_path) -> Path:
    """A film task at half the speed of the paper and at the paper's, the other films beside it."""
    groups = (SPEED_GROUP, 2.0 * SPEED_GROUP)
    write_profiles(tmp_path / "film.profiles.rattle", FILM_RATIO, groups)
    return write_points(tmp_path / "film.rattle", FILM_RATIOS, groups)


def squeeze_legend(words: list[str]) -> bool:
    """Whether a legend names the squeeze ratios in their order."""
    starts = [r"$-5 \times 10^{-4}$", r"$-2.5 \times 10^{-4}$", "0 (pure rolling)", r"$2.5 \times 10^{-4}$"]
    return all(word.startswith(start) for word, start in zip(words, starts, strict=False))


# --- figures 3 and 5: pressure -------------------------------------------------------------------------


def test_figure_3_shows_the_pressure_group_over_the_film_coordinate(film):
    with style.house_style():
        made = film_pressures.draw_iso_viscous(film_points.read_profiles(film), film_points.Choice())
    (axes,) = made.axes
    curves = drawn.curves(axes)
    profiles, ends = curves[0::2], curves[1::2]
    assert len(profiles) == len(SQUEEZE_RATIOS)
    for (angle, group), (end, zero), squeeze in zip(profiles, ends, SQUEEZE_RATIOS, strict=True):
        a = kernels.squeeze_group(RADIUS, SPEED, FILM_RATIO * RADIUS, squeeze * SPEED)
        rupture = kernels.rupture_angle(a)
        expected = np.maximum(kernels.pressure_group(np.tan(angle), np.tan(rupture), a), 0.0)
        np.testing.assert_allclose(group, expected, rtol=1e-12, atol=1e-15)
        assert (end[0], zero[0]) == pytest.approx((rupture, 0.0))
        assert angle[-1] == pytest.approx(rupture)
    assert axes.get_xlim() == pytest.approx((-np.pi / 2.0, np.pi / 2.0))
    ticks = dict(zip(axes.get_xticks(), (text.get_text() for text in axes.get_xticklabels()), strict=True))
    assert ticks == {
        -np.pi / 2.0: r"$-\pi/2$",
        -np.pi / 4.0: r"$-\pi/4$",
        0.0: "0",
        np.pi / 4.0: r"$\pi/4$",
        np.pi / 2.0: r"$\pi/2$",
    }
    assert axes.get_ylim()[0] == 0.0
    assert axes.get_ylim()[1] > max(group.max() for _, group in profiles)
    assert drawn.labels(axes) == (
        r"Film coordinate $\bar{x} = \arctan(x/\sqrt{2 R h_0})$ [rad]",
        r"Pressure group $p^*$ [-]",
    )
    words = drawn.legend_words(made)
    assert squeeze_legend(words) and words[-1] == r"rupture $\bar{x}_e$ of (18)"
    assert axes.get_title(loc="left").endswith(r"Scene film, $h^* = 7 \times 10^{-5}$")


def test_curves_are_dark_where_the_film_moves_fast(film):
    found = film_points.curves(film_points.read_points(film), [], "film_ratio", {"speed_group": SPEED_GROUP})
    assert [curve.squeeze_ratio for curve in found] == list(SQUEEZE_RATIOS)
    dark = film_points.colours(found)
    assert dark[0] == film_points.APPROACH.lower() and dark[2] == "#000000"
    assert dark[4] == film_points.SEPARATION.lower()
    lightness = [sum(to_rgb(colour)) for colour in dark]
    assert lightness[1] > lightness[0] and lightness[3] > lightness[4]


def test_figure_5_shows_megapascals_over_micrometres(film):
    with style.house_style():
        made = film_pressures.draw_piezo_viscous(film_points.read_profiles(film), CHOICE)
    (axes,) = made.axes
    curves = drawn.curves(axes)
    reduced, pressure = curves[0::2], curves[1::2]
    scale = kernels.pressure_scale(RADIUS, SPEED_GROUP * RADIUS / ALPHA, 1.0, FILM_RATIO * RADIUS)
    peaks, lefts, rights = [], [], []
    for (place, p), (same, q), squeeze in zip(reduced, pressure, SQUEEZE_RATIOS, strict=True):
        np.testing.assert_array_equal(place, same)
        a = kernels.squeeze_group(RADIUS, SPEED, FILM_RATIO * RADIUS, squeeze * SPEED)
        tangent = 1e-6 * place / np.sqrt(2.0 * FILM_RATIO) / RADIUS
        group = kernels.pressure_group(tangent, np.full_like(tangent, kernels.rupture_tangent(a)), a)
        np.testing.assert_allclose(p, 1e-6 * scale * np.maximum(group, 0.0), rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(
            q, 1e-6 * kernels.barus_pressure(ALPHA * 1e6 * p) / ALPHA, rtol=1e-9, atol=1e-9
        )
        peaks.append(q.max())
        lefts.append(place[p > 0.01 * p.max()].min())
        rights.append(place.max())
    assert drawn.rules(axes, "y") == pytest.approx([1e-6 / ALPHA])
    left, right = axes.get_xlim()
    assert left == pytest.approx(min(lefts))
    assert right == pytest.approx(max(rights) + 0.06 * (max(rights) - min(lefts)))
    assert axes.get_ylim()[0] == 0.0
    assert axes.get_ylim()[1] == pytest.approx(1.06 * max(peaks), rel=5e-3)
    assert drawn.labels(axes) == (r"Position $x$ [$\mathrm{\mu}$m]", "Pressure [MPa]")
    highest = max(alpha_p for alpha_p in (ALPHA * 1e6 * p.max() for _, p in reduced))
    words = drawn.all_words(made)
    assert rf"$\alpha p \leq {highest:#.3g}$" in words
    assert "pressure $q$, (31)" in words and "reduced pressure $p$, (16)" in words


def test_figure_5_draws_no_film_where_there_is_none(film):
    with style.house_style():
        made = film_pressures.draw_piezo_viscous(film_points.read_profiles(film), film_points.Choice())
    half, paper = made.axes
    assert len(drawn.curves(half)) == 2 * len(SQUEEZE_RATIOS)
    assert len(drawn.curves(paper)) == len(SQUEEZE_RATIOS)
    # Twice the speed, twice the reduced pressure.
    for (_, p), (_, double) in zip(drawn.curves(half)[0::2], drawn.curves(paper), strict=True):
        np.testing.assert_allclose(double, 2.0 * p, rtol=1e-9, atol=1e-9)
    top = kernels.pressure_scale(1.0, 2.0 * SPEED_GROUP, 1.0, FILM_RATIO) / min(
        kernels.critical_pressure_group(kernels.squeeze_group(1.0, 1.0, FILM_RATIO, ratio))
        for ratio in SQUEEZE_RATIOS
    )
    assert paper.get_ylim()[1] == pytest.approx(1.06 * top * 1e-6 / ALPHA)
    assert paper.get_title(loc="left").startswith(r"$u^* = 9 \times 10^{-7}$: $\alpha p$ exceeds 1")


# --- figure 4: slopes ----------------------------------------------------------------------------------


@pytest.mark.parametrize("number", [0, 1], ids=["stiffness", "damping"])
def test_figure_4_shows_the_slopes_of_the_kernels_over_micrometres(film, number):
    slope = (film_slopes.STIFFNESS, film_slopes.DAMPING)[number]
    with style.house_style():
        made = film_slopes.draw(film_points.read_points(film), slope, CHOICE)
    above, below = made.axes
    curves, ratios = drawn.curves(above), drawn.curves(below)
    contact = {"radius": RADIUS, "length": LENGTH, "speed": SPEED, "viscosity": VISCOSITY}
    thickness = FILM_RATIOS * RADIUS
    for position, squeeze in enumerate(SQUEEZE_RATIOS):
        velocity = np.full_like(thickness, squeeze * SPEED)
        published = kernels.published_stiffness_damping(thickness, velocity, **contact)[number]
        exact = -kernels.reynolds_iso_viscous_load(thickness, velocity, **contact)[1 + number]
        piezo = kernels.reynolds_piezo_viscous_load(thickness, velocity, **contact, pressure_viscosity=ALPHA)
        models = (exact, published, -piezo[1 + number])
        for (film_shown, shown), expected in zip(curves[3 * position :], models, strict=False):
            np.testing.assert_allclose(film_shown, 1e6 * thickness, rtol=1e-12)
            np.testing.assert_allclose(shown, np.where(expected > 0.0, expected, np.nan), rtol=1e-12)
        np.testing.assert_allclose(ratios[position][1], published / exact, rtol=1e-12)
        np.testing.assert_allclose(ratios[position][0], 1e6 * thickness, rtol=1e-12)
    assert len(curves) == 3 * len(SQUEEZE_RATIOS)
    assert (above.get_xscale(), above.get_yscale()) == ("log", "log")
    assert (below.get_xscale(), below.get_yscale()) == ("log", "linear")
    assert below.get_xlim() == pytest.approx((1e6 * thickness[0], 1e6 * thickness[-1]))
    assert drawn.rules(below, "y") == [1.0]
    assert below.get_xlabel() == r"Film thickness $h_0$ [$\mathrm{\mu}$m]"
    assert below.get_ylabel() == "Published\nover exact [-]"
    assert (
        above.get_ylabel()
        == (
            r"Stiffness $-\partial W/\partial h_0$ [N/m]",
            r"Damping $-\partial W/\partial \dot{h}_0$ [N s/m]",
        )[number]
    )
    words = drawn.legend_words(made)
    assert squeeze_legend(words)
    assert words[-3:] == ["Reynolds iso-viscous", "published (26)-(28)", "Reynolds piezo-viscous"]
    kinds = above.get_legend().legend_handles
    shown = [line.get_linestyle() for line in above.lines[:3]]
    assert [line.get_linestyle() for line in kinds] == shown
    assert r"$u^* = 4.5 \times 10^{-7}$" in above.get_title(loc="left")


# --- the regression (32) -------------------------------------------------------------------------------


def test_the_fit_figure_shows_the_fitted_laws(tmp_path):
    ranges = film_fit.Ranges((5e-5, 2e-4), (-5e-4, 5e-4), None)
    windows = [(0.1, 0.9), (0.4, 0.9), (0.8, 0.9)]
    fits = [
        film_fit.fit_window(ranges, reading, window) for reading in film_fit.READINGS for window in windows
    ]
    with style.house_style():
        made = film_fit.draw(fits, ranges, 0.9)
    printed = kernels.PUBLISHED_FILM_LAW
    for position, reading in enumerate(film_fit.READINGS):
        expected = []
        for window in windows:
            points = kernels.sample_film_window(
                ranges.film_ratio,
                ranges.squeeze_ratio,
                window,
                pressure_factor=reading.pressure_factor,
                load_factor=reading.load_factor,
            )
            fit = kernels.fit_film_law(*points)
            judged = kernels.judge_film_law(printed, *points)
            expected.append(
                [
                    fit.law.speed_exponent,
                    fit.law.load_exponent,
                    fit.law.squeeze_factor,
                    fit.law.factor,
                    fit.error.rms,
                    judged.rms,
                ]
            )
        for axes, values in zip(made.axes, np.array(expected).T, strict=True):
            lower, shown = drawn.curves(axes)[position]
            np.testing.assert_array_equal(lower, [0.1, 0.4, 0.8])
            np.testing.assert_allclose(shown, values, rtol=1e-12)
    rules = [drawn.rules(axes, "y") for axes in made.axes]
    assert rules == [[0.7], [-0.4], [-281.2], [0.787], [], []]
    assert [axes.get_title(loc="left")[:3] for axes in made.axes] == [
        "(a)",
        "(b)",
        "(c)",
        "(d)",
        "(e)",
        "(f)",
    ]
    assert [axes.get_yscale() for axes in made.axes] == ["linear"] * 3 + ["log"] + ["linear"] * 2
    assert [axes.get_ylim()[0] for axes in made.axes[4:]] == [0.0, 0.0]
    assert made.axes[3].get_xlabel() == r"Least $\alpha p$ of the window"
    words = drawn.legend_words(made)
    assert words == ["p as printed", "p halved", "p and W halved", "(32) as printed"]
    handles = made.legends[0].legend_handles
    shown = [line.get_color() for line in made.axes[0].lines]
    assert [line.get_color() for line in handles] == shown
    assert r"up to $\alpha p = 0.9$" in made.get_suptitle()


def test_the_windows_of_the_curves_share_their_upper_end():
    windows = film_fit.windows(0.8)
    lower = np.array([low for low, _ in windows])
    assert {high for _, high in windows} == {0.8}
    assert lower[0] == 0.0 and 0.79 < lower[-1] < 0.8
    steps = np.diff(lower)
    assert (steps > 0.0).all() and max(steps[0], steps[-1]) < 0.25 * steps.max()


def test_a_table_of_fits_puts_each_number_under_its_head():
    ranges = film_fit.Ranges((5e-5, 2e-4), (-5e-4, 5e-4), (3e-7, 1e-6))
    one = film_fit.fit_window(ranges, film_fit.READINGS[0], (0.3, 1.0))
    points = kernels.sample_film_window(ranges.film_ratio, ranges.squeeze_ratio, (0.3, 1.0))
    kept = (points.speed_group >= 3e-7) & (points.speed_group <= 1e-6)
    points = [column[kept] for column in points]
    fit = kernels.fit_film_law(*points)
    judged = kernels.judge_film_law(kernels.PUBLISHED_FILM_LAW, *points)
    rows = film_fit.table_rows([one])
    assert dict(zip(rows[0], rows[1], strict=True)) == {
        "reading": "p as printed",
        "alpha p": "0.3 to 1",
        "films": str(kept.sum()),
        "c": f"{fit.law.factor:.3g}",
        "a of u*": f"{fit.law.speed_exponent:.3f}",
        "b of W": f"{fit.law.load_exponent:.3f}",
        "s of w*": f"{fit.law.squeeze_factor:.1f}",
        "rms": f"{fit.error.rms:.3f}",
        "R2": f"{fit.error.r_squared:.3f}",
        "rms printed": f"{judged.rms:.3f}",
        "bias printed": f"{judged.bias:+.3f}",
    }


# --- the map of regimes --------------------------------------------------------------------------------

MATERIAL = regime_map.Material(2.0e-8, 226.0e9)


def scene(name: str = "idle", load: float = 228.6, amplitude: float = 205.7) -> regime_map.Scene:
    return regime_map.Scene(name, 0.0127, 0.01, 1.905, 0.3, MATERIAL, load, amplitude, {})


def drawn_map(*scenes: regime_map.Scene) -> tuple[Figure, Axes]:
    with style.house_style():
        made = regime_map.draw(scenes)
    (axes,) = made.axes
    return made, axes


def contour_sets(axes: Axes) -> list[QuadContourSet]:
    return [one for one in axes.collections if isinstance(one, QuadContourSet)]


def groups_of(load: float) -> tuple[float, float]:
    """g_v and g_e of the scene under a load, by their definitions in the labels of the axes."""
    line_load, stiff = load / 0.01, 0.3 * 1.905
    g_v = 2.0e-8 * np.sqrt(line_load**3 / (stiff * 0.0127**2))
    return g_v, line_load / np.sqrt(stiff * 226.0e9 * 0.0127)


def test_the_regime_map_colours_regimes_and_names_them():
    _, axes = drawn_map()
    assert axes.get_xlim() == pytest.approx((0.05, 50.0))
    assert axes.get_ylim() == pytest.approx((0.3, 3e3))
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert drawn.labels(axes) == (
        r"Elasticity group $g_e = (W/l)/\sqrt{\eta_0 U E^* R}$ [-]",
        r"Viscosity group $g_v = \alpha \sqrt{(W/l)^3/(\eta_0 U R^2)}$ [-]",
    )
    fills = contour_sets(axes)[0]
    places = np.random.default_rng(3).uniform(
        (np.log(0.06), np.log(0.4)), (np.log(45), np.log(2500)), (200, 2)
    )
    named = np.zeros(5, dtype=int)
    for g_e, g_v in np.exp(places):
        films = np.sort(kernels.limiting_films(g_v, g_e))
        if films[-1] < 1.05 * films[-2]:
            continue  # a border, which the picture draws only as fine as its grid
        regime = int(kernels.mapped_regime(g_v, g_e))
        named[regime] += 1
        inside = [path.contains_point((g_e, g_v)) for path in fills.get_paths()]
        assert inside == [code == regime for code in (1, 2, 3, 4)], (g_e, g_v)
    assert (named[1:] > 5).all()
    for note in (one for one in axes.texts if isinstance(one, Annotation)):
        g_e, g_v = note.xy
        assert note.get_text() == kernels.MAP_REGIMES[int(kernels.mapped_regime(g_v, g_e))]
    assert len([one for one in axes.texts if isinstance(one, Annotation)]) == 4


def test_the_regime_map_draws_films_and_borders_where_they_are():
    _, axes = drawn_map()
    _, films, *borders, hatched = contour_sets(axes)
    assert films.levels.tolist() == [6.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0]
    lines = {
        level: np.concatenate(parts)
        for level, parts in zip(films.levels, films.allsegs, strict=True)
        if parts
    }
    assert len(lines) >= 5
    for level, points in lines.items():
        for g_e, g_v in points[::7]:
            assert max(kernels.limiting_films(g_v, g_e)) == pytest.approx(level, rel=2e-3)
    drawn_borders = [segment for border in borders for segment in border.allsegs[0] if len(segment) > 1]
    assert len(drawn_borders) >= 4
    for g_e, g_v in np.concatenate(drawn_borders)[::7]:
        highest = np.sort(kernels.limiting_films(g_v, g_e))
        assert highest[-1] == pytest.approx(highest[-2], rel=2e-3)
    (area,) = hatched.get_paths()
    for g_e, g_v, applies in (
        (0.564, 7.2, True),
        (0.1, 1.0, False),
        (30.0, 1.0, False),
        (0.06, 100.0, False),
    ):
        assert area.contains_point((g_e, g_v)) is applies


def test_scenes_stand_where_their_load_puts_them():
    made, axes = drawn_map(scene(), scene("light", load=9.42, amplitude=205.7))
    curves = drawn.curves(axes)
    for position, (load, low) in enumerate(((228.6, 22.9), (9.42, 9.42e-6))):
        line, mark = curves[2 * position : 2 * position + 2]
        ends = [groups_of(low), groups_of(load + 205.7)]
        np.testing.assert_allclose(np.array(line).T, [(g_e, g_v) for g_v, g_e in ends], rtol=1e-9)
        g_v, g_e = groups_of(load)
        assert (mark[0][0], mark[1][0]) == pytest.approx((g_e, g_v))
    g_v, g_e = groups_of(9.42)
    assert axes.get_ylim() == pytest.approx((0.3 * g_v, 3e3))
    assert axes.get_xlim() == pytest.approx((0.3 * g_e, 50.0))
    words = drawn.legend_words(made)
    assert words[:3] == ["idle", "light", "range of $F + m g$"]
    handles = made.legends[0].legend_handles
    assert [handle.get_color() for handle in handles[:2]] == list(style.RUN_COLOURS[:2])
    marks = [line for line in axes.lines if line.get_marker() not in ("", "None")]
    assert [handle.get_marker() for handle in handles[:2]] == [mark.get_marker() for mark in marks]
    assert r"$E^* = 226$ GPa" in axes.get_title(loc="left")
    assert r"$\alpha = 2 \times 10^{-8}$ Pa$^{-1}$" in axes.get_title(loc="left")


def test_a_scene_that_another_covers_is_drawn_larger():
    _, axes = drawn_map(scene(), scene("same"), scene("far", load=20.0))
    marks = [line.get_markersize() for line in axes.lines if line.get_marker() not in ("", "None")]
    assert marks == [12.0, 7.0, 7.0]


def test_a_contact_is_built_of_the_keys_that_its_input_has():
    contact = {
        "radius_1": 0.02,
        "radius_2": 0.03,
        "length": 0.01,
        "young_modulus": 2e11,
        "poisson_ratio": 0.3,
    }
    groups = {
        "contact": contact,
        "lubricant": {"viscosity": 0.1, "pressure_viscosity": 1.5e-8},
        "kinematics": {"rolling_speed": 3.0},
        "load": {"mass": 2.0, "steady_force": 100.0, "force_amplitude": 50.0, "gravity": 9.8},
    }
    built = regime_map.new_scene("pair", groups, {})
    assert (built.radius, built.speed) == pytest.approx((0.012, 1.5))
    assert built.material.modulus == pytest.approx(2e11 / 0.91)
    assert (built.load, built.force_amplitude) == pytest.approx((119.6, 50.0))
    groups["load"]["mass"] = True
    with pytest.raises(CommandError, match=r"pair has no number as load\.mass"):
        regime_map.new_scene("pair", groups, {})


def test_the_table_of_scenes_is_in_newtons_and_micrometres():
    known = regime_map.Scene("a", 0.0127, 0.01, 1.905, 0.3, MATERIAL, 228.6, 205.7, {"steady_film": 8.889e-7})
    head, row = regime_map.table_rows([known])
    g_v, g_e = groups_of(228.6)
    film = max(kernels.limiting_films(g_v, g_e)) * 0.3 * 1.905 * 0.0127 / (228.6 / 0.01)
    shown = dict(zip(head, row, strict=True))
    assert shown["load [N]"] == "228.6" and shown["steady film [um]"] == "0.8889"
    assert (shown["g_v"], shown["g_e"]) == (f"{g_v:.3g}", f"{g_e:.3g}")
    assert shown["its film [um]"] == f"{1e6 * film:.4g}"
