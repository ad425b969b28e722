"""Joining the parts of a campaign: the file of an undivided run, or a plain word on what is wrong."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from campaign_writer import FORCES, SPEEDS, csv_table, grid, sample
from result_writer import resealed
from script_calls import call_script

import rattle


def merge(directory: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    return call_script("campaign.py", "merge", *arguments, cwd=directory)


@pytest.fixture
def made():
    return grid(FORCES, SPEEDS, failures=True)


def refused(directory: Path, *arguments: object) -> list[str]:
    """Traces of the complaint; nothing may have been written."""
    before = sorted(directory.iterdir())
    done = merge(directory, *arguments, "--output", "whole.rattle")
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert sorted(directory.iterdir()) == before
    return done.stderr.splitlines()


@pytest.mark.parametrize("parts", [1, 2, 3, 5])
def test_merged_file_is_that_of_an_undivided_run(made, tmp_path, parts):
    paths = made.write_parts(tmp_path, parts)
    done = merge(tmp_path, *reversed(paths), "--output", "map.rattle")
    assert (done.returncode, done.stdout) == (0, "map.rattle\n"), done.stderr
    assert done.stderr == f"campaign.py: {parts} parts joined, 300 scenes.\n"
    assert (tmp_path / "map.rattle").read_bytes() == made.content()
    assert not list(tmp_path.glob("*.unfinished"))


def test_parts_of_a_sample(tmp_path):
    made = sample(size=1000)
    merge(tmp_path, *made.write_parts(tmp_path, 7), "--output", "cloud.rattle")
    assert (tmp_path / "cloud.rattle").read_bytes() == made.content()


def test_a_part_that_is_not_finished_is_named(made, tmp_path):
    first, second = made.write_parts(tmp_path, 2)
    made.write(second, part=2, parts=2, undone=[1], closed=False)
    lines = refused(tmp_path, first, second)
    assert lines[0] == "campaign.py: the parts cannot be joined:"
    assert lines[1] == f"  {second} is not finished: 2 of its 3 chunks are done; rattle --resume goes on."
    assert len(lines) == 2


def test_a_gap_is_named_by_scenes_and_parts(made, tmp_path):
    first, _, third = made.write_parts(tmp_path, 3)
    assert refused(tmp_path, first, third)[1:] == [
        f"  scenes 65 to 192 are missing between {first} and {third}.",
        "  of 3 parts these are not given: 2.",
    ]
    assert refused(tmp_path, third)[1].endswith(f"scenes 1 to 192 are missing between the start and {third}.")


def test_a_missing_end_is_named(made, tmp_path):
    first, second, _ = made.write_parts(tmp_path, 3)
    lines = refused(tmp_path, first, second)
    assert f"  scenes 193 to 300 are missing after {second}." in lines


def test_the_last_part_of_a_table_is_missed(tmp_path):
    """No part shows how many scenes the CSV file has: only the number of parts shows a missing end."""
    made = csv_table()
    paths = made.write_parts(tmp_path, 2)
    assert merge(tmp_path, *paths, "--output", "all.rattle").returncode == 0
    assert (tmp_path / "all.rattle").read_bytes() == made.content()
    assert refused(tmp_path, paths[0])[1:] == ["  of 2 parts these are not given: 2."]


def test_what_stands_beside_the_output_is_left_alone(made, tmp_path):
    """Files that another program keeps there, also where the joining ends well, or cannot be written."""
    paths = made.write_parts(tmp_path, 2)
    foreign = tmp_path / "map.rattle.unfinished"
    foreign.write_text("mine")
    assert merge(tmp_path, *paths, "--output", "map.rattle").returncode == 0
    assert (tmp_path / "map.rattle").read_bytes() == made.content() and foreign.read_text() == "mine"
    target = tmp_path / "elsewhere"
    target.write_text("untouched")
    foreign.unlink()
    foreign.symlink_to(target)
    assert merge(tmp_path, *paths, "--output", "map.rattle", "--overwrite").returncode == 0
    assert target.read_text() == "untouched" and foreign.is_symlink()
    (tmp_path / "taken.rattle").mkdir()
    before = sorted(tmp_path.iterdir())
    assert merge(tmp_path, *paths, "--output", "taken.rattle", "--overwrite").returncode != 0
    assert sorted(tmp_path.iterdir()) == before


def test_a_part_given_twice_overlaps(made, tmp_path):
    first, second = made.write_parts(tmp_path, 2)
    assert f"  scenes 1 to 128 of {first} are also in {first}." in refused(tmp_path, first, first, second)


def test_parts_of_different_divisions_are_refused(made, tmp_path):
    halves, thirds = made.write_parts(tmp_path, 2), made.write_parts(tmp_path, 3)
    lines = refused(tmp_path, halves[0], thirds[2])
    assert any("belong to different divisions: into 3 and 2 parts." in line for line in lines)


def test_different_inputs_name_the_key(made, tmp_path):
    first, second = made.write_parts(tmp_path, 2)
    made.base = made.base.replace("mass = 3.0", "mass = 4.0")
    made.write(second, part=2, parts=2)
    lines = refused(tmp_path, first, second)
    expected = f"{second} and {first} come from different inputs: load.mass is 4.0 in one, 3.0 in the other."
    assert expected in lines[1]


def test_different_versions_columns_and_chunks_are_refused(made, tmp_path):
    first, second = made.write_parts(tmp_path, 2)
    made.version = "0.2.0"
    made.write(second, part=2, parts=2)
    assert "different versions of rattle: 0.2.0 and 0.1.0." in refused(tmp_path, first, second)[1]
    made.version, made.columns[-1] = "0.1.0", ("sure", "-")
    made.write(second, part=2, parts=2)
    assert "hold different columns." in refused(tmp_path, first, second)[1]
    made.columns[-1], made.chunk_rows = ("verified", "-"), 32
    made.write(second, part=2, parts=2)
    assert "have chunks of different size: 32 and 64 rows." in refused(tmp_path, first, second)[1]


def test_parts_of_two_states_of_a_csv_file_are_refused(made, tmp_path):
    first, second = made.write_parts(tmp_path, 2)
    made.source = 77
    made.write(second, part=2, parts=2)
    assert (
        "come from different scenes: their CSV file has changed in between."
        in refused(tmp_path, first, second)[1]
    )


def test_damaged_parts_are_not_joined(made, tmp_path):
    """The damage is seen in any column, not only in those that the joining looks at."""
    first, second = made.write_parts(tmp_path, 2)
    content = bytearray(second.read_bytes())
    content[-1] ^= 1
    second.write_bytes(content)
    assert f"{second} is damaged: rows " in refused(tmp_path, first, second)[0]


def test_a_part_that_does_not_begin_with_a_chunk_is_refused(made, tmp_path):
    """Its checksums would be those of other rows than the ones that the whole has in its chunks."""
    rows, paths = made.rows, []
    for part, share in ((1, slice(0, 100)), (2, slice(100, 300))):
        made.rows = rows[share]
        content = made.content().replace(b"part = 1\n", b"part = %d\n" % part)
        paths.append(tmp_path / f"{part}.rattle")
        paths[-1].write_bytes(resealed(content.replace(b"parts = 1\n", b"parts = 2\n")))
    complaint = f"  {paths[1]} does not begin with a chunk, so its checksums cannot be kept."
    assert refused(tmp_path, *paths)[1:] == [complaint]


def test_scenes_out_of_order_are_damage(made, tmp_path):
    first, second = made.write_parts(tmp_path, 2)
    made.column("scene")[200] = 7.0
    made.write(second, part=2, parts=2)
    assert f"  {second} is damaged: its scenes are not in order." in refused(tmp_path, first, second)


def test_an_output_that_exists_or_is_a_part_is_left_alone(made, tmp_path):
    first, second = made.write_parts(tmp_path, 2)
    taken = tmp_path / "map.rattle"
    taken.write_text("mine")
    done = merge(tmp_path, first, second, "--output", taken)
    assert (done.returncode, taken.read_text()) == (2, "mine")
    assert merge(tmp_path, first, second, "--output", taken, "--overwrite").returncode == 0
    before = first.read_bytes()
    done = merge(tmp_path, first, second, "--output", first, "--overwrite")
    assert done.returncode == 2
    assert "is one of the parts itself" in done.stderr
    assert first.read_bytes() == before


def test_a_merged_campaign_reads_as_a_whole_one(made, tmp_path):
    merge(tmp_path, *made.write_parts(tmp_path, 4), "--output", "map.rattle")
    campaign = rattle.read_campaign(tmp_path / "map.rattle")
    assert (campaign.part, campaign.parts, campaign.row_count) == (1, 1, 300)


def test_a_foreign_file_is_one_sentence(made, tmp_path):
    (tmp_path / "notes.txt").write_text("not a result")
    done = merge(tmp_path, "notes.txt", *made.write_parts(tmp_path, 2), "--output", "map.rattle")
    assert done.returncode == 2
    assert done.stderr == "campaign.py: notes.txt is not a rattle result file, which is called NAME.rattle.\n"
