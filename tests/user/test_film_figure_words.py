"""Words and numbers of the figures of films: those of the rows, of the kernels and of the scenes."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from figure_words import assert_says, power, words_of
from figure_words import relative as relative_label
from reported import SPOKEN
from result_writer import write_motion

import rattle
from rattle.figures import film_fit, film_points, film_pressures, film_slopes, regime_map, style, tolerance
from rattle.verdict import judge_samples

SQUEEZE = r"$w^* = w/u$, from the top"
COORDINATE = r"Film coordinate $\bar{x} = \arctan(x/\sqrt{2 R h_0})$ [rad]"
NUMBER = re.compile(r"\\leq ([\d.]+)")
FILM = r"Film thickness $h_0$ [$\mathrm{\mu}$m]"


@pytest.fixture(autouse=True)
def house_style():
    with style.house_style():
        yield


@pytest.fixture(scope="module")
def films(run, repository, tmp_path_factory) -> Path:
    """The ready film task."""
    folder = tmp_path_factory.mktemp("films")
    assert run(repository / "input" / "film.nml", "--output", folder, cwd=folder).returncode == 0
    return folder / "film.rattle"


def ratio(value: float) -> str:
    return "0 (pure rolling)" if value == 0.0 else power(value)


def nearest(values, wanted: float) -> float:
    return float(min(values, key=lambda value: abs(np.log(value / wanted))))


# --- figures 3 to 5 ------------------------------------------------------------------------------------


def test_words_of_figure_3(films):
    rows = rattle.read(films.with_suffix(".profiles.rattle"))
    held = nearest(rows["film_ratio"], 70e-6)
    assert_says(
        film_pressures.draw_iso_viscous(film_points.read_profiles(films), film_points.Choice()),
        [
            "Pressure of the iso-viscous film, (16) corrected\n"
            f"Scene {rows.scene_name}, {power(held, 'h^*')}",
            COORDINATE,
            "Pressure group $p^*$ [-]",
            SQUEEZE,
            *(ratio(value) for value in np.unique(rows["squeeze_ratio"])),
            r"rupture $\bar{x}_e$ of (18)",
        ],
    )


@pytest.mark.parametrize("speed_group", (None, 0.45e-6))
def test_words_of_figure_5(films, speed_group):
    rows = rattle.read(films.with_suffix(".profiles.rattle"))
    alpha = rows.input["lubricant"]["pressure_viscosity"]
    held = nearest(rows["film_ratio"], 70e-6)
    groups = np.unique(rows["speed_group"]) if speed_group is None else [speed_group]
    expected, ratios = [], np.unique(rows["squeeze_ratio"])
    for place, group in enumerate(groups):
        without = []
        for value in ratios:
            here = (
                (rows["speed_group"] == group)
                & (rows["squeeze_ratio"] == value)
                & (rows["film_ratio"] == held)
            )
            # The largest of the nodes is that of the profile, to the square of their distance.
            top = alpha * float(rows["reduced_pressure"][here].max())
            limit = float(rows["piezo_viscous_pressure"][here].max()) if top < 1.0 else np.nan
            without += [top >= 1.0]
            expected.append((value, top, limit))
        title = power(group, "u^*")
        if all(without):
            title += r": $\alpha p$ exceeds 1, no rigid piezo-viscous film exists"
        elif any(without):
            title += (
                rf": $\alpha p$ exceeds 1 and no rigid film exists at {sum(without)} of {len(ratios)} $w^*$"
            )
        if place == 0:
            scene = f"Scene {rows.scene_name}, {power(held, 'h^*')}"
            title = f"Pressure of the piezo-viscous film, (31)\n{scene}\n{title}"
        expected.append(title)
        expected += [SQUEEZE, r"$\alpha p = 1$", "Pressure [MPa]", "reduced pressure $p$, (16)"]
        expected += [] if all(without) else ["pressure $q$, (31)"]
    expected.append(r"Position $x$ [$\mathrm{\mu}$m]")
    choice = film_points.Choice(speed_group=speed_group)
    found = words_of(film_pressures.draw_piezo_viscous(film_points.read_profiles(films), choice))
    for curve in [one for one in expected if isinstance(one, tuple)]:
        value, top, limit = curve
        reported = {
            word: NUMBER.findall(word.partition(": ")[2]) for word in found if word.startswith(ratio(value))
        }
        (word,) = (
            word for word, most in reported.items() if most and float(most[0]) == pytest.approx(top, rel=6e-3)
        )
        peak, *pressure = reported[word]
        ending = "no film"
        if not np.isnan(limit):
            assert float(pressure[0]) == pytest.approx(1e-6 * limit, rel=0.02, abs=0.6)
            ending = rf"$q \leq {pressure[0]}$ MPa"
        assert word == rf"{ratio(value)}: $\alpha p \leq {peak}$, {ending}"
        found.remove(word)
    assert found == sorted(one for one in expected if isinstance(one, str))


@pytest.mark.parametrize("quantity", ("stiffness", "damping"))
@pytest.mark.parametrize("speed_group", (0.45e-6, 0.9e-6))
def test_words_of_figure_4(films, quantity, speed_group):
    rows = rattle.read(films)
    slope = {"stiffness": film_slopes.STIFFNESS, "damping": film_slopes.DAMPING}[quantity]
    here = rows["speed_group"] == speed_group
    words = {
        "iso_viscous": "Reynolds iso-viscous",
        "published": "published (26)-(28)",
        "piezo_viscous": "Reynolds piezo-viscous",
    }
    remarks = []
    for model, name in words.items():
        count = int((rows[f"{quantity}_{model}"][here] <= 0.0).sum())
        if count:
            remarks.append(f"{name} is not positive at {count} points, which are left out")
    lacking = np.isnan(rows[f"{quantity}_piezo_viscous"][here])
    if lacking.all():
        remarks.append(r"$\alpha p \geq 1$ everywhere: no rigid piezo-viscous film")
    elif lacking.any():
        remarks.append(r"The piezo-viscous curves end where $\alpha p$ reaches 1")
    assert remarks
    derivative = {"stiffness": "h_0$ [N/m]", "damping": r"\dot{h}_0$ [N s/m]"}[quantity]
    title = [
        f"{quantity.capitalize()} of the film, positive is resisting",
        f"Scene {rows.scene_name}, {power(speed_group, 'u^*')}, the same $u$ in every film",
        *remarks,
    ]
    choice = film_points.Choice(speed_group=speed_group)
    assert_says(
        film_slopes.draw(film_points.read_points(films), slope, choice),
        [
            "\n".join(title),
            FILM,
            rf"{quantity.capitalize()} $-\partial W/\partial {derivative}",
            "Published\nover exact [-]",
            f"{SQUEEZE}\nof the upper panel",
            *(ratio(value) for value in np.unique(rows["squeeze_ratio"])),
            *words.values(),
        ],
    )


# --- the fit of (32), the map of regimes, loose tolerances ---------------------------------------------


@pytest.mark.parametrize("speed_group", (None, (3e-7, 1e-6)))
@pytest.mark.parametrize("narrow", (False, True))
def test_words_of_the_fit(speed_group, narrow):
    ranges = film_fit.Ranges((5e-5, 2e-4), (-5e-4, 0.0), speed_group)
    fits = [film_fit.fit_window(ranges, reading, (0.3, 0.8)) for reading in film_fit.READINGS]
    names = {"h^*": ranges.film_ratio, "w^*": ranges.squeeze_ratio, "u^*": speed_group}
    spans = [
        f"${name}$ from {power(span[0])} to {power(span[1]) if span[1] else 0}"
        for name, span in names.items()
        if span
    ]
    moved = "; a factor of $p$ or $\\bar{W}$ only moves $c$" if speed_group is None else ""
    panels = [
        "Exponent $a$ of $u^*$",
        r"Exponent $b$ of $\bar{W}$",
        "Factor $s$ of $w^*$",
        "Factor $c$",
        r"rms of $\ln h^*$, fitted law",
        r"rms of $\ln h^*$, printed law",
    ]
    assert_says(
        film_fit.draw(fits, ranges, 0.8, narrow),
        [
            r"The law $h_0^* = c\,u^{*a}\,\bar{W}^b\,e^{s w^*}$ of (32), fitted to Reynolds films up to "
            rf"$\alpha p = 0.8${chr(10)}{', '.join(spans)}{moved}",
            *(f"({letter}) {panel}" for letter, panel in zip("abcdef", panels, strict=True)),
            *([r"Least $\alpha p$ of the window"] * (2 if narrow else 3)),
            "p as printed",
            "p halved",
            "p and W halved",
            "(32) as printed",
        ],
    )


def test_words_of_the_map_of_regimes(run, repository, tmp_path):
    inputs = [repository / "input" / f"{name}.nml" for name in ("idle", "loose_pair")]
    assert run(*inputs, "--output", tmp_path, cwd=tmp_path).returncode == 0
    paths = [tmp_path / f"{path.stem}.rattle" for path in inputs]
    scenes = [regime_map.read_scene(path) for path in paths]
    results = [rattle.read(path) for path in paths]
    alpha = results[0].input["lubricant"]["pressure_viscosity"]
    contact = results[0].input["contact"]
    modulus = contact["young_modulus"] / (1.0 - contact["poisson_ratio"] ** 2)
    made = regime_map.draw(scenes)
    levels = [text.get_text() for text in made.axes[0].texts if text.get_text().isdigit()]
    assert len(levels) >= 3 and {*levels} <= {"6", "10", "20", "50", "100", "200", "500"}
    expected = [
        "Lubrication regimes of line contacts, after Johnson (1970)\n"
        rf"Hatched for {power(alpha, chr(92) + 'alpha')} Pa$^{{-1}}$, $E^* = {1e-9 * modulus:.4g}$ GPa; "
        "$U$ is the entrainment speed",
        r"Elasticity group $g_e = (W/l)/\sqrt{\eta_0 U E^* R}$ [-]",
        r"Viscosity group $g_v = \alpha \sqrt{(W/l)^3/(\eta_0 U R^2)}$ [-]",
        "iso-viscous rigid",
        "piezo-viscous rigid",
        "iso-viscous elastic",
        "piezo-viscous elastic",
        *(result.scene_name for result in results),
        "range of $F + m g$",
        "Grubin (33) applies",
        r"film $h_0 W/(l \eta_0 U R)$",
    ]
    assert_says(made, [*expected, *levels])
    # What stands in the table is what the summaries and inputs say.
    head, *rows = regime_map.table_rows(scenes)
    for row, result, path in zip(rows, results, paths, strict=True):
        reported = dict(zip(head, row, strict=True))
        load = result.input["load"]
        weight = load["mass"] * load["gravity"]
        summary = rattle.read_summary(path.with_suffix(".summary.nml"))
        assert reported["scene"] == result.scene_name
        assert reported["load [N]"] == f"{load['steady_force'] + load.get('force_mean', 0.0) + weight:.4g}"
        assert reported["steady film [um]"] == f"{1e6 * summary['steady_film']:.4g}"


@pytest.mark.parametrize("count", (1, 2))
@pytest.mark.parametrize("narrow", (False, True))
def test_words_of_a_loose_tolerance(tmp_path, monkeypatch, count, narrow):
    """The acceleration of a gear, in the narrow figure, is said to be relative to the shaft."""
    monkeypatch.setattr(rattle.Result, "has_gear", narrow)
    labels = (r"Acceleration $\ddot{z}$ [m/s$^2$]", r"Amplitude of $\ddot{z}$ [m/s$^2$]")
    acceleration, amplitude = map(relative_label, labels) if narrow else labels
    loose = rattle.read(write_motion(tmp_path / "l.rattle", lines={1.0: 4.0, 2.5: 9.0}, tolerance=2.5e-7))
    tight = rattle.read(write_motion(tmp_path / "t.rattle", lines={1.0: 5.0, 3.0: 1.0}))
    pairs = [
        tolerance.Pair(name, loose, tight, last)
        for name, last in (("A false harmonic", 6.0), ("False reversals", 32.0))[:count]
    ]
    solver = loose.input["solver"]
    scheme = f"iteration {solver['iteration']}, predictor {solver['predictor']}"
    expected = []
    for letter, pair in zip(("(a) ", "(b) ") if count > 1 else ("",), pairs, strict=True):
        expected.append(f"{letter}{pair.name}\n{scheme}\n{solver['steps_per_period']} steps a period")
        expected.append(f"{letter}{pair.name}" if letter else None)
        for result, eps in ((tight, "10^{-12}"), (loose, r"2.5 \times 10^{-7}")):
            reported = judge_samples(result, 16)
            expected.append(
                rf"$\varepsilon = {eps}$ m: {reported['reversals_per_period']:.3g} reversals a period, "
                f"class {SPOKEN.get(reported['rattle_class'], reported['rattle_class'])}"
            )
        expected += [
            "Time within the last 3 excitation periods [ms]",
            acceleration,
            r"Frequency ratio $f/f_\mathrm{exc}$",
            amplitude,
        ]
    assert_says(tolerance.draw(pairs, 3, 16, narrow), expected)
