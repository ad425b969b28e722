"""Words and numbers where a figure shows several things: runs, flanks, gear pairs, traces, contours."""

from __future__ import annotations

from pathlib import Path

import campaign_writer
import numpy as np
import pytest
from campaign_writer import Key
from figure_words import assert_says, film_of, words_of
from figure_words import relative as relative_label
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from reported import SPOKEN
from test_drawn_thresholds import PLANE, ROWS, written

import rattle
from rattle import codes
from rattle.campaign_section import new_section
from rattle.command import CommandError
from rattle.figures import campaign_look, campaign_map, histories, spectra, style, sweep, threshold
from rattle.thresholds import thresholds

PERIODS = 3
TIME = f"Time within the last {PERIODS} excitation periods [ms]"
ACCELERATION = r"Acceleration $\ddot{z}$ [m/s$^2$]"
LEVEL = r"Level [dB re 10$^{-6}$ m/s$^2$]"
MASS = ("kinematics.entrainment_speed", "load.mass")


@pytest.fixture(autouse=True)
def house_style():
    with style.house_style():
        yield


@pytest.fixture(scope="module")
def solved(run, repository, tmp_path_factory) -> dict[str, Path]:
    """Ready motions and sweeps, by their names."""
    folder = tmp_path_factory.mktemp("several")
    names = {name.split(".")[0] for several in SETS for name in several} | {"stiff_or_not"}
    inputs = [repository / "input" / f"{name}.nml" for name in sorted(names)]
    assert run(*inputs, "--output", folder, cwd=folder).returncode == 0
    return {path.stem: path for path in folder.glob("*.rattle")}


def relative(label: str, results) -> str:
    gears = any("gear" in result.input for result in results)
    return relative_label(label) if gears else label


def titles(subject: str, results) -> str:
    films = sorted({film_of(result.input) for result in results})
    return f"{subject}: {len(results)} runs, {' and '.join(films)}"


def runs_named(results) -> list[str]:
    """Of the ready inputs one has too few samples for a picture, and no summary that makes up for it."""
    return [
        f"{result.scene_name}, too few samples" if result.scene_name == FALSE else result.scene_name
        for result in results
    ]


FALSE = "creep_false_harmonic"
SETS = (
    ("idle", "creep_period_two"),
    ("idle", FALSE),
    ("idle", "loose_gear", "loose_pair"),
    ("loose_pair", "engine_cycle"),
    ("gearbox.1st", "gearbox.2nd", "gearbox.3rd"),
)


# --- overlays ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("names", SETS)
def test_words_of_histories_of_several(solved, names):
    results = [rattle.read(solved[name]) for name in names]
    labels = style.run_labels(results)
    assert_says(
        histories.draw_film_and_force(results, labels, PERIODS),
        [
            titles("Film and applied force", results),
            r"Film thickness $h$ [$\mathrm{\mu}$m]",
            "Applied force $F$ [N]",
            TIME,
            *runs_named(results),
        ],
    )
    assert_says(
        histories.draw_acceleration(results, labels, PERIODS),
        [
            titles("Acceleration", results),
            relative(ACCELERATION, results),
            TIME,
            *runs_named(results),
        ],
    )


def frequency_axis(results) -> str:
    if all("shaft" in result.input for result in results):
        return "Engine order [-]"
    if not any("force_amplitudes" in result.input["load"] for result in results):
        return r"Frequency ratio $f/f_\mathrm{exc}$"
    bases = {result.frequency for result in results}
    return f"Harmonic, multiple of {f'{bases.pop():.4g} Hz' if len(bases) == 1 else 'each base frequency'}"


@pytest.mark.parametrize("names", SETS)
def test_words_of_spectra_of_several(solved, names):
    results = [rattle.read(solved[name]) for name in names]
    labels = style.run_labels(results)
    axis = f"{frequency_axis(results)}; runs side by side"
    assert_says(
        spectra.draw_force(results, labels, None),
        [
            titles("Spectrum of the applied force", results),
            axis,
            "Amplitude of $F$ [N]",
            *(result.scene_name for result in results),
        ],
    )
    reported = [rattle.read_summary(result.path.with_suffix(".summary.nml")) for result in results]
    by_summary = [one["series_coarse"] and one["sampling_sufficient"] for one in reported]
    assert_says(
        spectra.draw_acceleration(results, labels, None),
        [
            titles(relative("Spectrum of the acceleration", results), results),
            axis,
            LEVEL,
            *(
                f"{result.scene_name}, by its summary" if better else name
                for result, better, name in zip(results, by_summary, runs_named(results), strict=True)
            ),
        ],
    )


def test_words_of_several_sweeps(solved, run, repository, tmp_path):
    text = (repository / "input" / "stiff_or_not.nml").read_text()
    (tmp_path / "heavier.nml").write_text(text)
    changes = ("--set", "load.mass=4.0", "--set", "sweep.count=9", "--output", tmp_path)
    assert run("heavier.nml", *changes, cwd=tmp_path).returncode in (0, 1)
    results = [rattle.read(solved["stiff_or_not"]), rattle.read(tmp_path / "heavier.rattle")]
    ways = {value for result in results for value in result["direction"]}
    assert_says(
        sweep.draw(*results, panels=("film", "harmonics")),
        [
            "Steady motions: 2 sweeps",
            "Film [$\\mathrm{\\mu}$m]",
            "Harmonics",
            f"idle from {results[0].input['spectrum']['idle_harmonics']} harmonics on",
            "Stiffness of the teeth $k$ [N/m]",
            *(f"{result.scene_name}, {film_of(result.input)}" for result in results),
            "up",
            "down" if -1.0 in ways else None,
        ],
    )


def test_words_of_two_flanks(solved):
    result = rattle.read(solved["loose_gear"])
    reported = rattle.read_summary(solved["loose_gear"].with_suffix(".summary.nml"))
    periods = reported["orbit_period"]
    last = "the last excitation period" if periods == 1 else f"the last {periods} excitation periods"
    start = result["time"][-1] - periods / result.frequency
    title = f"Both flanks: {reported['name']}, {film_of(result.input)}"
    found = words_of(histories.draw_flanks(result, result.scene_name))
    assert found == sorted(
        [
            title,
            r"Film thickness $h$ [$\mathrm{\mu}$m]",
            "Film load $W$ [N]",
            ACCELERATION,
            f"Time within {last} [ms], from $t = {1e3 * start:.2f}$ ms",
            "drive flank",
            "coast flank",
        ]
    )


# --- gear pairs, and the contours of a map -------------------------------------------------------------


@pytest.fixture(scope="module")
def box(run, repository, tmp_path_factory) -> rattle.Campaign:
    """The ready map of a box, of fewer scenes."""
    folder = tmp_path_factory.mktemp("box")
    small = ["campaign.count=3,2", "solver.periods=6", "load.force_scale=0.2"]
    words = [word for setting in small for word in ("--set", setting)]
    ended = run(repository / "input" / "gearbox_map.nml", *words, "--output", folder, cwd=folder)
    assert ended.returncode in (0, 1), ended.stderr
    return rattle.read_campaign(folder / "gearbox_map.rattle")


@pytest.mark.long
@pytest.mark.parametrize("narrow", (False, True))
def test_words_of_gear_pairs(box, narrow):
    rows = box
    columns = ["rattle_class", "acceleration_maximum"]
    sections = {
        gear: new_section(alone, tuple(alone.varied[:2]), {})
        for gear, alone in zip(rows.gears, rows.pairs, strict=True)
    }
    made = campaign_map.draw_pairs(sections, columns, campaign_map.Options(), narrow)
    x, y = (campaign_look.axis_label(axis) for axis in next(iter(sections.values())).free)
    shown = {SPOKEN.get(name, name) for name in codes.CLASSES.values()}
    if ((rows["verified"] == 0.0) & (rows["rattle_class"] != 6.0)).any():
        shown.add("not verified")
    if "motions" in rows and (rows["motions"] > 1.0).any():
        shown.add("several motions, that from rest drawn")
    shown |= {
        words
        for code, words in ((3.0, "film lost"), (4.0, "no rigid film"))
        if (rows["status"] == code).any()
    }
    expected = [*rows.gears, *([x] * (2 if narrow else 1)), *([y] * (4 if narrow else 2))]
    expected.append("Relative acceleration maximum [m/s$^2$]")
    assert_says(made, [*expected, *shown])


def contours(figure: Figure) -> list[ContourSet]:
    """The contours of a figure that have labels."""
    found = [one for axes in figure.axes for one in axes.collections if isinstance(one, ContourSet)]
    return [one for one in found if getattr(one, "labelTexts", ())]


def test_labels_of_the_contours_of_a_map(tmp_path):
    """A label stands on the line of its number: the scenes around it are below and above."""
    made = campaign_writer.grid(campaign_writer.FORCES, campaign_writer.SPEEDS)
    rows = rattle.read_campaign(made.write(tmp_path / "map.rattle"))
    section = new_section(rows, rows.varied, {})
    figure = campaign_map.draw(section, "rattle_class", campaign_map.Options())
    values = {
        "": rows["natural_frequency"] / rows.input["load"]["frequency"],
        r"$\zeta$ ": rows["damping_ratio"],
    }
    sets = contours(figure)
    assert len(sets) == 2
    x, y = (np.unique(rows[key]) for key in rows.varied)
    for one, (head, column) in zip(sets, values.items(), strict=True):
        grid = column.reshape(y.size, x.size)
        for text in one.labelTexts:
            words = text.get_text()
            assert words.startswith(head) and (head or "$" not in words)
            level = float(words.removeprefix(head))
            assert np.isclose(one.levels, level, rtol=1e-5).any()
            at = text.get_position()
            i, j = np.searchsorted(x, at[0]), np.searchsorted(y, at[1])
            around = grid[max(j - 1, 0) : j + 1, max(i - 1, 0) : i + 1]
            margin = 0.05 * np.ptp(grid)
            assert around.min() - margin <= level <= around.max() + margin
    legend = {text for text in words_of(figure) if "frac" in text or "frequency" in text or "zeta" in text}
    assert {r"natural frequency $f_n/f_\mathrm{exc}$", r"damping ratio $\zeta$"} <= legend


# --- thresholds over several keys ----------------------------------------------------------------------


def title_of_edge(ordinal: str = "", held: str = "") -> str:
    what = f"{ordinal} change of class".strip().capitalize()
    return ", ".join(filter(None, (f"{what}: edge", held)))


SEARCHED = "Force amplitude [N], searched from 5 to 100 N"


def test_words_of_threshold_curves(tmp_path):
    rows = [row for row in PLANE if row[2] <= 3.0]
    rows[4] = [*rows[4][:-1], 0.0]
    made = threshold.draw(thresholds(written(tmp_path / "few.rattle", rows, MASS)))
    assert_says(
        made,
        [
            title_of_edge(),
            "Entrainment speed [m/s]",
            SEARCHED,
            "not quiet here",
            *(f"mass {mass:g} kg" for mass in np.unique([row[2] for row in rows])),
            "from lower to upper",
            "not verified",
        ],
    )


@pytest.mark.parametrize(("crossing", "ordinal"), ((1, "first"), (2, "second"), (4, "4th")))
def test_words_of_a_threshold_surface(tmp_path, crossing, ordinal):
    rows = [list(row) for row in PLANE]
    rows[7][-1] = rows[30][-2] = 0.0
    rows[50][3] = 0.0
    found = thresholds(written(tmp_path / "many.rattle", rows, MASS))
    made = threshold.draw(found, crossing=crossing)
    unsure = sum(row[3] == crossing and 0.0 in row[-2:] for row in rows)
    without = sum(row[3] != crossing for row in rows)
    labels = [text for one in contours(made) for text in one.labelTexts]
    assert bool(labels) == (crossing == 1)
    assert_says(
        made,
        [
            title_of_edge(ordinal),
            "Entrainment speed [m/s]",
            "Mass [kg]",
            SEARCHED,
            f"no change ({without})" if without else None,
            f"not verified ({unsure})" if unsure else None,
            *(text.get_text() for text in labels),
        ],
    )
    middles = {(row[1], row[2]): 0.5 * (row[4] + row[5]) for row in rows if row[3] == crossing}
    for text in labels:
        # The made-up threshold is 10 x + y + 1, x and y the two keys.
        x, y = text.get_position()
        assert float(text.get_text()) == pytest.approx(10.0 * x + y + 1.0, abs=5.0)
        assert min(middles.values()) < float(text.get_text()) < max(middles.values())


def test_words_of_a_threshold_at_a_held_key(tmp_path):
    found = thresholds(written(tmp_path / "held.rattle", PLANE, MASS))
    made = threshold.draw(*threshold.cut(found, {"load.mass": 4.2}, 1))
    # The last of ten lies beyond the 100 N to which the axis goes.
    inside, outside = (
        sum(row[2] == 4.0 and (row[4] < 100.0) is side for row in PLANE) for side in (True, False)
    )
    assert_says(
        made,
        [
            title_of_edge(held="mass = 4 kg"),
            "Entrainment speed [m/s]",
            SEARCHED,
            "not quiet here",
            f"quiet to creep ({inside}, {outside} more outside)",
            "from lower to upper",
        ],
    )


def test_words_of_thresholds_over_a_map(tmp_path):
    keys = Key(campaign_writer.SPEED, 1.0, 8.0, 6), Key(campaign_writer.FORCE, 5.0, 100.0, 5)
    path = campaign_writer.grid(*keys).write(tmp_path / "map.rattle")
    rows = rattle.read_campaign(path)
    found = thresholds(written(tmp_path / "edge.rattle"))
    made = threshold.draw(found, section=threshold.behind(found, path, {}))
    crossed = [row for row in ROWS if row[2] > 0.0]
    ends = {1.0: "quiet", 2.0: "creep", 3.0: "idle"}
    kinds = [f"{ends[row[5]]} to {ends[row[6]] if row[8] == 1.0 else 'film lost'}" for row in crossed]
    unsure = sum(row[9:] != [1.0, 1.0] for row in crossed)
    legend = [text.get_text() for one in made.legends for text in one.get_texts()]
    classes = {
        f"{SPOKEN.get(name, name)} ({100.0 * (rows['rattle_class'] == code).mean():.1f} %)"
        for code, name in codes.CLASSES.items()
    }
    assert classes <= set(legend)
    doubt = int((rows["verified"] == 0.0).sum())
    assert set(legend) - classes == {
        *(f"{kind} ({kinds.count(kind)})" for kind in kinds),
        "from lower to upper",
        "end: its neighbour has no such change near",
        f"not verified ({unsure})",
        f"no change ({sum(row[2] == 0.0 for row in ROWS)})",
        *([f"not verified ({100.0 * doubt / rows.row_count:.1f} %)"] if doubt else []),
    }


@pytest.mark.parametrize("exchanged", (False, True))
def test_thresholds_lie_over_a_map_of_the_verdict(tmp_path, exchanged):
    """Every crossing stands where its key and its middle are, whichever of both is upwards."""
    keys = Key(campaign_writer.SPEED, 1.0, 8.0, 6), Key(campaign_writer.FORCE, 5.0, 100.0, 5)
    made = campaign_writer.with_verdicts(campaign_writer.grid(*keys))
    rows = rattle.read_campaign(made.write(tmp_path / "map.rattle"))
    found = thresholds(written(tmp_path / "edge.rattle"))
    free = (campaign_writer.FORCE, campaign_writer.SPEED) if exchanged else rows.varied
    options = campaign_map.Options(thresholds=[found])
    figure = campaign_map.draw(new_section(rows, free, {}), "verdict", options)
    drawn = [line.get_xydata()[:, ::-1] if exchanged else line.get_xydata() for line in figure.axes[0].lines]
    crossed = {(row[1], 0.5 * (row[3] + row[4])) for row in ROWS if row[2] > 0.0}
    unsure = {(row[1], 0.5 * (row[3] + row[4])) for row in ROWS if row[2] > 0.0 and row[9:] != [1.0, 1.0]}
    *curves, marks = drawn
    assert {tuple(map(float, point)) for curve in curves for point in curve} == crossed
    assert {tuple(map(float, point)) for point in marks} == unsure
    assert "threshold: change of class" in words_of(figure)


def test_thresholds_of_other_keys_do_not_lie_over_a_map(tmp_path):
    keys = Key(campaign_writer.SPEED, 1.0, 8.0, 6), Key(campaign_writer.VISCOSITY, 0.1, 0.9, 5)
    rows = rattle.read_campaign(campaign_writer.grid(*keys).write(tmp_path / "map.rattle"))
    options = campaign_map.Options(thresholds=[thresholds(written(tmp_path / "edge.rattle"))])
    with pytest.raises(CommandError, match="do not lie over entrainment speed and viscosity"):
        campaign_map.draw(new_section(rows, rows.varied, {}), "rattle_class", options)
