"""Pictures of campaigns: maps, slices, summary; their names, gaps and plain words."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from campaign_writer import FORCE, FORCES, SPEED, SPEEDS, VISCOSITIES, VISCOSITY, Key, csv_table, grid, sample
from matplotlib.image import imread
from script_calls import call_script, figure_stems

import rattle
from rattle.campaign_section import new_section
from rattle.figures import campaign_look as look
from rattle.figures import campaign_summary


def draw(path: Path, *arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    return call_script(
        "plot.py", "campaign", "--overwrite", path, "--output", path.parent / "out", *arguments, **environment
    )


def stems(directory: Path) -> list[str]:
    """Names of the figures, none of them blank."""
    for path in directory.glob("*.png"):
        picture = imread(path)
        assert picture.shape[1] > 1000
        assert 0.01 < (picture[:, :, :3].min(axis=2) < 0.9).mean() < 0.95, path
    return figure_stems(directory)


def colours_in(path: Path) -> set[str]:
    picture = (imread(path)[:, :, :3] * 255).round().astype(int)
    codes, counts = np.unique(picture.reshape(-1, 3) @ [65536, 256, 1], return_counts=True)
    return {f"#{code:06X}" for code in codes[counts > 1000]}


@pytest.fixture
def whole(tmp_path):
    return grid(FORCES, SPEEDS, failures=True).write(tmp_path / "map.rattle")


@pytest.fixture
def deep(tmp_path):
    return grid(FORCES, SPEEDS, VISCOSITIES, name="deep").write(tmp_path / "deep.rattle")


def test_class_map_shows_every_class_in_its_colour(whole):
    done = draw(whole)
    assert (done.returncode, done.stderr) == (0, "")
    output = whole.parent / "out"
    assert done.stdout.split() == [str(output / "map_map_rattle_class.png")]
    assert stems(output) == ["map_map_rattle_class"]
    assert set(look.CLASS_COLOURS.values()) <= colours_in(output / "map_map_rattle_class.png")


def test_class_colours_differ_in_lightness():
    def lightness(colour: str) -> float:
        parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        return 0.2126 * parts[0] ** 2.2 + 0.7152 * parts[1] ** 2.2 + 0.0722 * parts[2] ** 2.2

    levels = sorted(map(lightness, look.CLASS_COLOURS.values()))
    assert min(np.diff(levels)) > 0.1


@pytest.mark.long
def test_maps_of_columns_words_and_numbers(whole):
    columns = ["film_minimum", "status", "verified", "harmonic_count", "harmonic_3"]
    done = draw(whole, "--columns", ",".join(columns), "--x", SPEED, "--contours", "damping")
    assert done.returncode == 0, done.stderr
    assert stems(whole.parent / "out") == sorted(f"map_map_{column}" for column in columns)


def test_same_campaign_gives_the_same_bytes(whole):
    assert draw(whole, TZ="UTC").returncode == 0
    output = whole.parent / "out"
    first = {path.name: path.read_bytes() for path in output.iterdir()}
    assert draw(whole, TZ="Asia/Tokyo").returncode == 0
    assert first == {path.name: path.read_bytes() for path in output.iterdir()}


@pytest.mark.long
def test_slice_names_the_nearest_grid_point(deep):
    done = draw(deep, "--slice", f"{VISCOSITY}=0.25")
    assert done.returncode == 0
    assert done.stderr == ("plot.py: viscosity = 0.3 Pa s is the grid point nearest to the 0.25 asked for.\n")
    done = draw(deep)
    assert "viscosity = 0.3 Pa s: the middle of its axis; --slice lubricant.viscosity=VALUE" in done.stderr
    assert draw(deep, "--slice", f"{VISCOSITY}=0.1").stderr == ""


def test_section_is_the_plane_asked_for(deep):
    campaign = rattle.read_campaign(deep)
    section = new_section(campaign, (SPEED, FORCE), {VISCOSITY: 0.9})
    values = section.values("acceleration_maximum")
    assert values.shape == (15, 20)
    data = campaign.dataset()["acceleration_maximum"].sel({VISCOSITY: 0.9})
    np.testing.assert_array_equal(values, data.transpose(SPEED, FORCE).values)
    np.testing.assert_array_equal(
        section.mask(campaign["rattle_class"] == 3), section.values("rattle_class") == 3
    )


def test_columns_along_a_key(deep):
    done = draw(deep, "--along", SPEED, "--slice", f"{FORCE}=200", "--slice", f"{VISCOSITY}=0.3")
    assert (done.returncode, done.stderr) == (0, "")
    assert stems(deep.parent / "out") == ["deep_slice_entrainment_speed"]


def test_one_varied_key_is_drawn_as_a_slice(tmp_path):
    path = grid(FORCES, name="line").write(tmp_path / "line.rattle")
    assert draw(path, "--columns", "film_minimum").returncode == 0
    assert stems(tmp_path / "out") == ["line_slice_force_amplitude"]


def test_unfinished_campaign_is_drawn_with_a_word(tmp_path):
    path = grid(FORCES, SPEEDS, failures=True).write(tmp_path / "map.rattle", undone=[1], closed=False)
    done = draw(path)
    assert done.returncode == 0
    assert done.stderr == f"plot.py: {path} is not finished; 236 of 300 scenes are done.\n"


def test_gaps_are_named_by_their_status(tmp_path):
    made = grid(FORCES, SPEEDS, failures=True)
    made.column("film_minimum")[0] = np.nan
    campaign = rattle.read_campaign(made.write(tmp_path / "map.rattle"))
    found = {gap.words: int(gap.scenes.sum()) for gap in look.gaps(campaign, "film_minimum")}
    lost, rigid = ((made.column("status") == code).sum() for code in (3, 4))
    assert found == {"film lost": lost, "no rigid film": rigid, "film minimum unknown": 1}
    hatches = [gap.hatch for gap in look.gaps(campaign, "film_minimum")]
    assert len(set(hatches)) == len(hatches)


@pytest.mark.long
@pytest.mark.parametrize("made", [sample(failures=True), csv_table()], ids=["sample", "csv"])
def test_a_campaign_that_is_no_grid_is_drawn_as_dots(tmp_path, made):
    path = made.write(tmp_path / "a.rattle")
    assert draw(path).returncode == 0
    assert draw(path, "--columns", "harmonic_distortion").returncode == 0
    assert draw(path, "--summary").returncode == 0
    assert len(stems(tmp_path / "out")) == 3
    refused = draw(path, "--slice", f"{FORCE}=1")
    assert refused.returncode == 2
    assert "is not a grid" in refused.stderr


@pytest.mark.parametrize("last", [(400.0, 5.0), (400.0, 0.5), (20.0, 5.0)], ids=["both", "force", "speed"])
def test_scenes_on_one_straight_line_are_drawn_as_dots(last, tmp_path):
    """No triangles lie between them, and so no contours either."""
    made = csv_table(points=np.linspace((20.0, 0.5), last, 12).tolist())
    path = made.write(tmp_path / "a.rattle")
    drawn = draw(path, "--columns", "harmonic_distortion")
    assert drawn.returncode == 0, drawn.stderr
    assert call_script("report.py", path, "--output", tmp_path / "page.html").returncode == 0


def test_summary_page_says_where_verifications_fail(run, repository, tmp_path):
    """The verifications of a campaign that the program solved loosely."""
    recorded = "campaign.record='rattle_class', 'acceleration_maximum', 'verified'"
    changes = ["--set", recorded, "--set", "campaign.count=12, 12", "--set", "solver.accuracy=1e-2"]
    solved = run("--output", tmp_path, *changes, repository / "input" / "map.nml", cwd=tmp_path)
    assert solved.returncode == 0, solved.stderr
    campaign = rattle.read_campaign(tmp_path / "map.rattle")
    failing = int((campaign["verified"] == 0.0).sum())
    assert 0 < failing < campaign.row_count
    page = campaign_summary.draw(
        campaign, campaign_summary.Worst([0], "acceleration_maximum", smallest=False)
    )
    share = look.share(failing, campaign.row_count)
    assert f"Verification fails in {share} of 144 scenes" in [axes.get_title() for axes in page.axes]
    assert draw(campaign.path, "--summary").returncode == 0
    assert stems(tmp_path / "out") == ["map_summary"]


@pytest.mark.long
@pytest.mark.parametrize("keys", [(FORCES,), (FORCES, SPEEDS), (FORCES, SPEEDS, VISCOSITIES)])
def test_summary_page_and_inputs_of_the_worst_scenes(tmp_path, keys):
    path = grid(*keys).write(tmp_path / "map.rattle")
    done = draw(path, "--summary", "--worst", 3)
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "out") == ["map_summary"]
    height, width, _ = imread(tmp_path / "out" / "map_summary.png").shape
    assert height / width == pytest.approx(297 / 210, abs=0.01)
    inputs = sorted((tmp_path / "out" / "map_scenes").iterdir())
    assert len(inputs) == 3
    assert [str(path) for path in inputs] == sorted(done.stdout.split()[1:])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--columns", "film"], "has no column 'film'"),
        (["--x", "load.mass"], "does not vary 'load.mass'"),
        (["--x", FORCE, "--y", FORCE], "cannot be both axes"),
        (["--slice", f"{FORCE}=100"], "too many keys are sliced"),
        (["--along", FORCE, "--slice", f"{FORCE}=100"], "is an axis of the picture and cannot be sliced too"),
        (["--along", FORCE, "--slice", f"{SPEED}=50"], "is outside the campaign, which has 0.5 to 5."),
        (["--along", FORCE, "--slice", f"{SPEED}=1", "--slice", f"{SPEED}=2"], "gives kinematics"),
        (["--slice", "load.mass"], "is not group.key=value"),
        (["--contours", "mass"], "'mass' is not one of frequency, damping, force, none"),
        (["--summary", "--by", "film"], "has no column 'film'"),
        (["--summary", "--width", "80"], "--summary is a page; it takes a --width of 150 mm or more"),
        (["--worst", "3"], "--worst, --by and --smallest belong to --summary"),
    ],
)
def test_what_cannot_be_drawn_is_one_sentence(whole, arguments, words):
    done = draw(whole, *arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert not (whole.parent / "out").exists()


def test_nothing_done_is_nothing_to_draw(tmp_path):
    path = grid(FORCES, SPEEDS).write(tmp_path / "map.rattle", undone=range(5), closed=False)
    done = draw(path)
    assert done.returncode == 2
    assert "holds no scene that is done; there is nothing to draw." in done.stderr


@pytest.mark.long
def test_an_axis_of_one_value_and_of_equal_numbers(tmp_path):
    path = grid(FORCES, Key(SPEED, 2.0, 2.0, 1)).write(tmp_path / "thin.rattle")
    done = draw(path, "--columns", "rattle_class,status,natural_frequency")
    assert done.returncode == 0, done.stderr
    assert len(stems(tmp_path / "out")) == 3


def test_contours_that_lack_their_columns_are_left_out_with_a_word(tmp_path):
    made = grid(FORCES, SPEEDS)
    made.columns = [(name.replace("damping_ratio", "other"), unit) for name, unit in made.columns]
    done = draw(made.write(tmp_path / "map.rattle"))
    assert done.returncode == 0
    assert "does not record what the contours of damping need; they are left out." in done.stderr


def test_listed_values_that_grow_by_factors_have_a_logarithmic_axis(deep):
    campaign = rattle.read_campaign(deep)
    assert [look.is_logarithmic(axis) for axis in campaign.axes] == [False, True, True]
