"""Figures of the film, its regression, its regimes: right names, right words, one sentence for what lacks."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.text import Text
from result_writer import write_motion, write_result

kernels = pytest.importorskip(
    "rattle.kernels", reason="'make python' builds the kernels", exc_type=ImportError
)

import rattle  # noqa: E402
from rattle.figures import film_fit, film_piezo_pressure, film_points, film_regimes, style  # noqa: E402

SCRIPTS = Path(__file__).parents[2] / "scripts"
RADIUS, LENGTH, VISCOSITY, ALPHA = 0.0127, 0.010, 0.3, 2.0e-8
SQUEEZE_RATIOS = (-5e-4, -2.5e-4, 0.0, 2.5e-4, 5e-4)
PAPER = ["figure_03", "figure_04a", "figure_04b", "figure_05"]

FILM_INPUT = """&scene
   name = 'film'
   task = '{task}'
/
&contact
   radius = 0.0127
   length = 0.01
/
&lubricant
   viscosity = 0.3
   pressure_viscosity = 2.0E-8
/
"""
MOTION_INPUT = """&scene
   name = '{name}'
   task = '{task}'
/
&contact
   radius = 0.0127
   length = 0.01
   young_modulus = 2.0566E11
   poisson_ratio = 0.3
/
&lubricant
   viscosity = 0.3
   pressure_viscosity = {alpha!r}
/
&kinematics
   {speed}
/
&load
   mass = 3.0
   steady_force = {force!r}
   force_amplitude = 205.7
   gravity = 9.80665
/
"""

POINT_COLUMNS = {
    "film_ratio": "-",
    "squeeze_ratio": "-",
    "speed_group": "-",
    "film_thickness": "m",
    "stiffness_published": "N/m",
    "stiffness_iso_viscous": "N/m",
    "stiffness_piezo_viscous": "N/m",
    "damping_published": "N s/m",
    "damping_iso_viscous": "N s/m",
    "damping_piezo_viscous": "N s/m",
}
PROFILE_COLUMNS = {
    "film_ratio": "-",
    "squeeze_ratio": "-",
    "speed_group": "-",
    "coordinate": "rad",
    "position": "m",
    "pressure_group": "-",
    "reduced_pressure": "Pa",
    "piezo_viscous_pressure": "Pa",
}


def write_points(path: Path, film_ratios: np.ndarray, speed_groups=(0.9e-6,), without: str = "") -> Path:
    """The table of a film task, with the numbers of the kernels."""
    rows = []
    for speed_group in speed_groups:
        speed = speed_group * RADIUS / (VISCOSITY * ALPHA)
        contact = {"radius": RADIUS, "length": LENGTH, "speed": speed, "viscosity": VISCOSITY}
        for squeeze in SQUEEZE_RATIOS:
            state = film_ratios * RADIUS, np.full_like(film_ratios, squeeze * speed)
            published = kernels.published_stiffness_damping(*state, **contact)
            iso = kernels.reynolds_iso_viscous_load(*state, **contact)[1:]
            piezo = kernels.reynolds_piezo_viscous_load(*state, **contact, pressure_viscosity=ALPHA)[1:]
            for position, film_ratio in enumerate(film_ratios):
                pairs = [(published[n][position], -iso[n][position], -piezo[n][position]) for n in (0, 1)]
                rows.append([film_ratio, squeeze, speed_group, film_ratio * RADIUS, *pairs[0], *pairs[1]])
    return _write(path, POINT_COLUMNS, rows, without)


def write_profiles(path: Path, film_ratio: float, speed_groups=(0.9e-6,), without: str = "") -> Path:
    """Pressure profiles of a film task, with the numbers of the kernels."""
    rows = []
    for speed_group in speed_groups:
        scale = kernels.pressure_scale(RADIUS, speed_group * RADIUS / ALPHA, 1.0, film_ratio * RADIUS)
        for squeeze in SQUEEZE_RATIOS:
            a = kernels.squeeze_group(RADIUS, 1.0, film_ratio * RADIUS, squeeze)
            end = kernels.rupture_angle(a)
            angle = np.linspace(-np.pi / 2 + 1e-6, end, 101)
            group = np.maximum(kernels.pressure_group(np.tan(angle), np.tan(end), a), 0.0)
            q = kernels.barus_pressure(ALPHA * scale * group) / ALPHA
            place = np.tan(angle) * np.sqrt(2.0 * film_ratio) * RADIUS
            held = np.broadcast_to([film_ratio, squeeze, speed_group], (angle.size, 3))
            rows += np.column_stack([held, angle, place, group, scale * group, q]).tolist()
    return _write(path, PROFILE_COLUMNS, rows, without)


def _write(path: Path, columns: dict[str, str], rows: list, without: str) -> Path:
    kept = [position for position, name in enumerate(columns) if name != without]
    pairs = [pair for pair in columns.items() if pair[0] != without]
    return write_result(path, pairs, np.asarray(rows)[:, kept], input_text=FILM_INPUT.format(task="film"))


def write_scene(
    path: Path,
    *,
    force: float = 199.2,
    alpha: float = ALPHA,
    speed: str = "entrainment_speed = 1.905",
    task: str = "motion",
) -> Path:
    """A motion of which only the resolved input matters."""
    text = MOTION_INPUT.format(name=path.stem, task=task, alpha=alpha, speed=speed, force=force)
    return write_result(path, [("time", "s")], [[0.0]], input_text=text)


def call(script: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, str(SCRIPTS / script), *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
    )


def stems(directory: Path) -> list[str]:
    """Names of the figures; each must be there in both forms, and not blank."""
    found = sorted(path.stem for path in directory.glob("*.png"))
    assert found == sorted(path.stem for path in directory.glob("*.pdf"))
    for path in directory.glob("*.png"):
        picture = imread(path)
        assert picture.shape[0] > 400 and picture.shape[1] > 1000
        assert 0.005 < (picture[:, :, :3].min(axis=2) < 0.7).mean() < 0.5, path
    return found


def words(figure: Figure) -> str:
    return "\n".join(text.get_text() for text in figure.findobj(Text))


@pytest.fixture
def film(tmp_path) -> Path:
    """A film task with everything, at the groups of the paper and at half its speed."""
    groups = (0.45e-6, 0.9e-6)
    write_profiles(tmp_path / "film.profiles.rattle", 70e-6, groups)
    return write_points(tmp_path / "film.rattle", np.geomspace(35e-6, 140e-6, 21), groups)


# --- figures 3 to 5 -------------------------------------------------------------------------------------


def test_a_film_task_gives_the_figures_of_the_paper(film, tmp_path):
    done = call("plot_film.py", film, "--output", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == PAPER
    assert len(done.stdout.splitlines()) == 2 * len(PAPER)


def test_profiles_may_be_named_in_place_of_the_table(film, tmp_path):
    profiles = film.with_name("film.profiles.rattle")
    done = call("plot_film.py", profiles, "--figures", "3", "--output", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == ["figure_03"]


def test_same_film_gives_the_same_bytes(film, tmp_path):
    for name in ("first", "second"):
        assert call("plot_film.py", film, "--figures", "3,5", "--output", tmp_path / name).returncode == 0
    for first in (tmp_path / "first").iterdir():
        assert first.read_bytes() == (tmp_path / "second" / first.name).read_bytes(), first.name


def test_figure_5_says_which_films_do_not_exist(film):
    profiles = film_points.read_profiles(film)
    with style.house_style():
        printed = words(film_piezo_pressure.draw(profiles, film_points.Choice(speed_group=0.9e-6)))
        halved = words(film_piezo_pressure.draw(profiles, film_points.Choice(speed_group=0.45e-6)))
        both = words(film_piezo_pressure.draw(profiles, film_points.Choice()))
    assert "no rigid piezo-viscous film exists" in printed
    assert r"$\alpha p \leq 1.65$, no film" in printed and "MPa$" not in printed.replace("[MPa]", "")
    assert "no rigid" not in halved
    assert r"$\alpha p \leq 0.826$" in halved and r"$q \leq 201$ MPa" in halved
    assert "no rigid piezo-viscous film exists" in both and r"$q \leq 201$ MPa" in both


def test_figure_5_counts_the_films_that_do_not_exist(tmp_path):
    write_profiles(tmp_path / "film.profiles.rattle", 96e-6)
    with style.house_style():
        profiles = film_points.read_profiles(tmp_path / "film.rattle")
        found = words(film_piezo_pressure.draw(profiles, film_points.Choice()))
    assert "no rigid film exists at 3 of 5" in found


@pytest.mark.parametrize(
    ("figure", "column"),
    [
        ("3", "pressure_group"),
        ("4", "stiffness_published"),
        ("5", "piezo_viscous_pressure"),
    ],
)
def test_a_column_that_was_not_asked_for_is_named(tmp_path, figure, column):
    without = {"without": column}
    write_profiles(tmp_path / "a.profiles.rattle", 70e-6, **without if figure != "4" else {})
    path = write_points(
        tmp_path / "a.rattle", np.geomspace(5e-5, 1e-4, 5), **without if figure == "4" else {}
    )
    done = call("plot_film.py", path, "--figures", figure, "--output", tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert f"has no column '{column}'" in done.stderr


def test_without_the_piezo_viscous_slopes_the_others_are_drawn(tmp_path):
    path = write_points(tmp_path / "a.rattle", np.geomspace(5e-5, 1e-4, 5), without="stiffness_piezo_viscous")
    done = call("plot_film.py", path, "--figures", "4", "--output", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == ["figure_04a", "figure_04b"]


def test_without_profiles_figure_4_is_drawn_and_the_rest_explained(tmp_path):
    path = write_points(tmp_path / "a.rattle", np.geomspace(5e-5, 1e-4, 5))
    done = call("plot_film.py", path, "--output", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == ["figure_04a", "figure_04b"]
    assert done.stderr.count("was not asked for 'profile'") == 2
    asked = call("plot_film.py", path, "--figures", "3", "--output", tmp_path / "figures")
    assert asked.returncode == 2 and asked.stderr.count("\n") == 1


def test_a_single_film_thickness_gives_no_figure_4(tmp_path):
    path = write_points(tmp_path / "a.rattle", np.array([7e-5]))
    done = call("plot_film.py", path, "--figures", "4", "--output", tmp_path)
    assert done.returncode == 2
    assert "has a single film thickness; figure 4 needs several." in done.stderr


def test_a_film_that_the_result_does_not_hold_is_refused(film, tmp_path):
    done = call("plot_film.py", film, "--figures", "3", "--film-ratio", "8e-5", "--output", tmp_path)
    assert done.returncode == 2
    assert "has no film_ratio 8e-05; it holds 7e-05." in done.stderr


def test_a_motion_is_refused(tmp_path):
    path = write_motion(tmp_path / "idle.rattle", lines={1.0: 1.0})
    done = call("plot_film.py", path, "--figures", "4", "--output", tmp_path)
    assert done.returncode == 2
    assert "is not the result of a film task; plot_motion.py draws motions." in done.stderr


@pytest.mark.parametrize("arguments", [("--figures", "6"), ("--film-ratio", "-1"), ("--speed-group", "fast")])
def test_wrong_options_of_plot_film_are_explained(film, arguments):
    done = call("plot_film.py", film, *arguments)
    assert done.returncode == 2
    assert f"'{arguments[1]}' is not" in done.stderr


def test_curves_beyond_the_most_are_thinned_with_a_word(tmp_path, capsys):
    names = ["film_ratio", "squeeze_ratio", "speed_group", "coordinate"]
    rows = [[7e-5, squeeze, 1e-6, x] for squeeze in np.linspace(-1, 1, 21) for x in (0.2, 0.1)]
    text = FILM_INPUT.format(task="film")
    path = write_result(tmp_path / "a.rattle", [(name, "-") for name in names], rows, input_text=text)
    found = film_points.curves(rattle.read(path), [], "coordinate", {"film_ratio": 7e-5})
    assert [curve.squeeze_ratio for curve in found][::4] == [-1.0, 0.0, 1.0]
    assert len(found) == film_points.MOST_CURVES
    assert (found[0]["coordinate"] == [0.1, 0.2]).all()
    assert "holds 21 squeeze ratios; 9 of them are drawn." in capsys.readouterr().err
    shades = film_points.colours(found)
    assert len(set(shades)) == len(shades) and shades[4] == film_points.ROLLING


# --- the regression (32) --------------------------------------------------------------------------------


def test_the_fit_is_printed_and_drawn(tmp_path):
    done = call("plot_film_fit.py", "--output", tmp_path / "figures", "--alpha-p", "0.3,1", "0,0.5")
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == ["film_fit"]
    rows = done.stdout.splitlines()
    assert len(rows) == 2 + 3 * 2 + 1
    fit = kernels.fit_film_law(*kernels.sample_film_window((5e-5, 2e-4), (-5e-4, 5e-4), (0.3, 1.0)))
    assert f"{fit.law.load_exponent:.3f}" in rows[2] and f"{fit.law.squeeze_factor:.1f}" in rows[2]
    assert rows[-1].split()[-4:] == ["0.787", "0.7", "-0.4", "-281.2"]


def test_the_fit_in_markdown_over_other_ranges(tmp_path):
    ranges = ("--film-ratio", "6e-5,1e-4", "--squeeze-ratio=-4e-4,0", "--speed-group", "2e-7,2e-6")
    done = call("plot_film_fit.py", "--output", tmp_path, "--markdown", "--upper-end", "0.95", *ranges)
    assert done.returncode == 0, done.stderr
    assert all(line.startswith("| ") for line in done.stdout.splitlines())


def test_readings_move_the_factor_alone():
    ranges = film_fit.Ranges((5e-5, 2e-4), (-5e-4, 5e-4), None)
    fits = [film_fit.fit_window(ranges, reading, (0.5, 1.0)) for reading in film_fit.READINGS]
    for one in fits[1:]:
        assert one.fit.law[1:] == pytest.approx(fits[0].fit.law[1:], rel=1e-9)
        assert one.fit.error.rms == pytest.approx(fits[0].fit.error.rms, rel=1e-9)
    assert fits[1].printed.rms < fits[0].printed.rms


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--film-ratio", "1e-4,1e-4"), "A single h* determines no law"),
        (("--film-ratio", "2e-4,1e-4"), "is not a range LEAST,LARGEST"),
        (("--alpha-p=-1,2",), "a window needs 0 < h*"),
        (("--speed-group", "1,2"), "holds 0 films"),
        (("--upper-end", "1.5"), "is not a number above 0 and up to 1"),
    ],
)
def test_ranges_that_fit_nothing_are_explained(tmp_path, arguments, sentence):
    done = call("plot_film_fit.py", "--output", tmp_path, *arguments)
    assert done.returncode == 2
    assert sentence in done.stderr and "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())


# --- the regime map -------------------------------------------------------------------------------------


def test_scenes_are_placed_on_the_map(tmp_path):
    idle = write_scene(tmp_path / "idle.rattle")
    (tmp_path / "idle.summary.nml").write_text("&summary\n   name = 'idle'\n   steady_film = 8.889E-7\n/\n")
    light = write_scene(tmp_path / "light.rattle", force=-20.0, speed="rolling_speed = 3.81")
    done = call(
        "plot_regime_map.py",
        tmp_path / "idle.summary.nml",
        light,
        "--output",
        tmp_path / "figures",
        "--markdown",
    )
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == ["regime_map"]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines()]
    assert cells[2] == [
        "idle",
        "228.6",
        "7.2",
        "0.564",
        "piezo-viscous elastic",
        "2.361",
        "3.405",
        "yes",
        "0.8889",
    ]
    assert cells[3][0] == "light" and cells[3][4] == "iso-viscous rigid" and cells[3][7:] == ["no", "-"]
    assert idle.exists()


def test_the_bare_map_is_drawn(tmp_path):
    done = call("plot_regime_map.py", "--output", tmp_path)
    assert done.returncode == 0 and done.stdout == ""
    assert stems(tmp_path) == ["regime_map"]


def test_grubin_film_of_the_map_is_that_of_the_scene(tmp_path):
    result = rattle.read(
        write_scene(tmp_path / "a.rattle", speed="surface_speed_1 = 4.0\n surface_speed_2 = 1.0")
    )
    scene = film_regimes.new_scene("a", result.input, {})
    assert scene.speed == 2.5
    g_v, g_e = scene.groups(scene.load)
    parameter = film_regimes.grubin_parameter(scene.material, np.array(g_v), np.array(g_e))
    assert parameter * scene.film_per_parameter() == pytest.approx(scene.grubin_film(), rel=1e-12)


def test_scenes_of_different_oil_are_told(tmp_path):
    paths = [write_scene(tmp_path / "a.rattle"), write_scene(tmp_path / "b.rattle", alpha=1e-8)]
    done = call("plot_regime_map.py", *paths, "--output", tmp_path)
    assert done.returncode == 0
    assert "The scenes differ in alpha or E*; the hatched part is that of a." in done.stderr


def test_scenes_without_a_place_are_refused(tmp_path):
    (tmp_path / "alone.summary.nml").write_text("&summary\n   name = 'alone'\n/\n")
    alone = call("plot_regime_map.py", tmp_path / "alone.summary.nml", "--output", tmp_path)
    film_task = call(
        "plot_regime_map.py", write_scene(tmp_path / "f.rattle", task="film"), "--output", tmp_path
    )
    bare = call(
        "plot_regime_map.py", write_motion(tmp_path / "m.rattle", lines={1.0: 1.0}), "--output", tmp_path
    )
    many = call("plot_regime_map.py", *[write_scene(tmp_path / "s.rattle")] * 8, "--output", tmp_path)
    for done, sentence in (
        (alone, "alone.rattle, which would, does not exist."),
        (film_task, "is no motion: its contact has no static load."),
        (bare, "has no number as contact."),
        (many, "The map shows 7 scenes at most; 8 were given."),
    ):
        assert done.returncode == 2
        assert done.stderr.count("\n") == 1
        assert sentence in done.stderr
