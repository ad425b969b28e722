"""What scripts write: never over a file that is there unasked, all of it or nothing, never through a link."""

from __future__ import annotations

import os
import re
from pathlib import Path

import campaign_writer
import pytest
from campaign_writer import FORCES, SPEEDS
from outcomes import contents
from result_writer import MOTION_COLUMNS, write_motion, write_result
from script_calls import called_here

from rattle import outputs
from rattle.command import CommandError

LINES = {1.0: 10.0, 2.0: 8.0}
EXISTS = "exists; --overwrite replaces it."
ONE = ("--figures", "8", "--format", "png", "--dpi", "30")


@pytest.fixture
def motion(tmp_path) -> Path:
    return write_motion(tmp_path / "idle.rattle", lines=LINES)


@pytest.fixture
def campaign(tmp_path) -> Path:
    return campaign_writer.grid(FORCES, SPEEDS).write(tmp_path / "map.rattle")


COMMANDS = {
    "a motion as CSV": ("export.py", ("idle.rattle",), {"idle.csv"}),
    "a motion as NetCDF": ("export.py", ("idle.rattle", "--output", "of.nc"), {"of.nc"}),
    "a table of classes": ("classify.py", ("idle.rattle", "--output", "reported.csv"), {"reported.csv"}),
    "figures": ("plot.py", ("motion", "idle.rattle", *ONE), {"figure_08_idle.png"}),
    "a regime map": (
        "plot.py",
        ("regime-map", "--format", "png", "--dpi", "30"),
        {"regime_map.png"},
    ),
    "a page": ("report.py", ("idle.rattle",), {"report.html"}),
    "a campaign as CSV": ("campaign.py", ("export", "map.rattle", "--to", "csv"), {"map.csv"}),
    "a campaign as Parquet": ("campaign.py", ("export", "map.rattle", "--to", "parquet"), {"map.parquet"}),
    "inputs of scenes": (
        "campaign.py",
        ("rerun", "map.rattle", "--scenes", "7,12"),
        {"map_scenes", "map_scenes/map_007.nml", "map_scenes/map_012.nml"},
    ),
    "a page on a campaign": (
        "plot.py",
        ("campaign", "map.rattle", "--summary", "--worst", "1", "--format", "png", "--dpi", "30"),
        {"map_summary.png", "map_scenes", "map_scenes/map_020.nml"},
    ),
    "a job script": (
        "campaign.py",
        ("slurm", "in.nml", "--time", "1:00:00", "--program", "rattle"),
        {"scene.slurm"},
    ),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_what_is_there_is_replaced_only_if_asked(name, motion, campaign, tmp_path):
    script, arguments, made = COMMANDS[name]
    (tmp_path / "in.nml").write_text("&scene\n name = 'scene'\n/\n&campaign\n/\n")
    given = set(contents(tmp_path))
    code, _, complaint = called_here(script, *arguments, cwd=tmp_path)
    assert code == 0, complaint
    first = contents(tmp_path)
    assert set(first) - given == made
    last = max(place for place in made if (tmp_path / place).is_file())
    (tmp_path / last).write_bytes(b"somebody's own")
    before = contents(tmp_path)
    code, _, complaint = called_here(script, *arguments, cwd=tmp_path)
    assert code == 2 and EXISTS in complaint
    assert contents(tmp_path) == before
    code, _, complaint = called_here(script, *arguments, "--overwrite", cwd=tmp_path)
    assert code == 0, complaint
    again = contents(tmp_path)
    assert set(again) == set(first)
    same = [place for place in made if not place.endswith(".nc")]
    assert [again[place] for place in same] == [first[place] for place in same]


def test_a_measured_cycle_is_not_replaced_by_its_export(tmp_path):
    """The names that the ready scene has: engine_cycle.csv is its input and would be its export."""
    text = "&scene\n name = 'engine_cycle'\n/\n&shaft\n signal = 'engine_cycle.csv'\n/\n"
    rows = [[0.1 * i, 1.0, 1e-6, 2.0] for i in range(5)]
    write_result(tmp_path / "engine_cycle.rattle", MOTION_COLUMNS, rows, input_text=text)
    (tmp_path / "engine_cycle.csv").write_text("angle,speed\n0,900\n")
    before = contents(tmp_path)
    for options, words in (((), "computed from"), (("--overwrite",), "computed from")):
        code, _, complaint = called_here("export.py", "engine_cycle.rattle", *options, cwd=tmp_path)
        assert code == 2 and words in complaint and "give another --output" in complaint
        assert contents(tmp_path) == before
    arguments = ("engine_cycle.rattle", "--output", "series.csv")
    assert called_here("export.py", *arguments, cwd=tmp_path)[0] == 0
    assert (tmp_path / "engine_cycle.csv").read_bytes() == before["engine_cycle.csv"]


def test_one_figure_that_is_there_keeps_all_from_being_drawn(motion, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "figure_10a_idle.png").write_bytes(b"the last of them")
    before = contents(tmp_path)
    code, _, complaint = called_here("plot.py", "motion", motion, "--output", "out", cwd=tmp_path)
    assert code == 2 and f"out/figure_10a_idle.png {EXISTS}" in complaint
    assert contents(tmp_path) == before


def test_links_are_replaced_not_followed(motion, tmp_path):
    target = tmp_path / "target.txt"
    target.write_text("kept")
    for name, place in (("reported.csv", target), ("loose.csv", tmp_path / "absent.txt")):
        (tmp_path / name).symlink_to(place)
        code, _, complaint = called_here("export.py", motion, "--output", name, cwd=tmp_path)
        assert code == 2 and EXISTS in complaint
        arguments = (motion, "--output", name, "--overwrite")
        assert called_here("export.py", *arguments, cwd=tmp_path)[0] == 0
        assert (tmp_path / name).is_file() and not (tmp_path / name).is_symlink()
    assert target.read_text() == "kept" and not (tmp_path / "absent.txt").exists()


def test_devices_folders_and_results_keep_their_names(motion, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "device").symlink_to("/dev/null")
    (tmp_path / "folder").mkdir()
    (tmp_path / "alias.csv").hardlink_to(motion)
    for name, words in (
        ("pipe", "is not a plain file"),
        ("device", "is not a plain file"),
        ("folder", "is a folder"),
        ("alias.csv", "is a result itself"),
        ("idle.rattle/x.csv", "is not a folder"),
    ):
        arguments = (motion, "--output", name, "--overwrite")
        code, _, complaint = called_here("export.py", *arguments, cwd=tmp_path)
        assert code == 2 and words in complaint, name


def test_a_write_that_fails_leaves_nothing_and_replaces_nothing(tmp_path):
    def fail(path: Path) -> None:
        path.write_text("half")
        raise OSError(28, "No space left on device")

    (tmp_path / "first").write_text("old")
    files = [(tmp_path / "first", outputs.text_writer("new")), (tmp_path / "second", fail)]
    with pytest.raises(OSError, match="No space left"):
        outputs.write(files, overwrite=True)
    assert contents(tmp_path) == {"first": b"old"}


def test_a_file_that_comes_while_another_is_written_is_kept(tmp_path):
    path, seen = tmp_path / "it", []

    def write(own: Path) -> None:
        seen.append(own)
        own.write_text("ours")
        path.write_text("theirs")

    with pytest.raises(CommandError, match="another program"):
        outputs.write([(path, write)], overwrite=False)
    assert contents(tmp_path) == {"it": b"theirs"}
    assert outputs.write([(path, write)], overwrite=True) == [path]
    assert contents(tmp_path) == {"it": b"ours"}
    assert seen[0].name != seen[1].name and {own.parent for own in seen} == {tmp_path}


def test_files_have_the_rights_of_new_files(tmp_path):
    before = os.umask(0o027)
    try:
        outputs.write([(tmp_path / "it", outputs.text_writer("x"))], overwrite=False)
    finally:
        os.umask(before)
    assert (tmp_path / "it").stat().st_mode & 0o777 == 0o640


def test_two_files_of_one_name_are_refused(tmp_path):
    files = [(tmp_path / name, outputs.text_writer(name)) for name in ("a", "b", "./a")]
    with pytest.raises(CommandError, match="two files would be called"):
        outputs.write(files, overwrite=True)
    assert contents(tmp_path) == {}


@pytest.mark.parametrize(
    ("given", "page"),
    (
        ("out", "out/report.html"),
        ("out/deep/", "out/deep/report.html"),
        ("here.d", "here.d/report.html"),
        (".", "report.html"),
        ("own.html", "own.html"),
        ("out/own.HTM", "out/own.HTM"),
    ),
)
def test_a_page_goes_into_a_folder_as_figures_do(given, page, motion, tmp_path):
    (tmp_path / "here.d").mkdir()
    code, said, complaint = called_here("report.py", motion, "--output", given, cwd=tmp_path)
    assert (code, said) == (0, f"{page}\n"), complaint
    assert (tmp_path / page).read_text().startswith("<!DOCTYPE html>")


def test_make_draws_its_pictures_twice(repository):
    """Its figures are its own: each call may replace them."""
    drawn = (repository / "scripts" / "draw_pictures.sh").read_text()
    text = ((repository / "Makefile").read_text() + drawn).replace("\\\n", " ")
    calls = re.findall(r"scripts/(?:plot|report|export|classify)\.py[^\n]*", text)
    # The pictures are drawn by one function of the script, which is called for each of them.
    assert len(calls) >= 3 and len(re.findall(r"^ *plot ", drawn, re.MULTILINE)) >= 10
    assert all("--overwrite" in call for call in calls)
