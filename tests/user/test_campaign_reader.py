"""Campaign results: columns, done scenes, axes, tables; damage in one plain sentence."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from campaign_writer import FORCE, FORCES, SPEED, SPEEDS, VISCOSITIES, VISCOSITY, Key, csv_table, grid, sample
from result_writer import resealed, write_motion

import rattle
from rattle.codes import CLASSES, NO_OR_YES, STATUSES

SMALL = Key(FORCE, 100.0, 300.0, 5)


@pytest.fixture
def made():
    return grid(FORCES, SPEEDS)


@pytest.fixture
def campaign(made, tmp_path):
    return rattle.read_campaign(made.write(tmp_path / "map.rattle"))


def test_columns_units_and_all_scenes_done(made, campaign):
    assert campaign.closed
    assert campaign.row_count == campaign.scene_count == 300
    assert campaign.done.all() and campaign.chunks.done.all()
    assert campaign.varied == (FORCE, SPEED)
    assert (campaign.kind, campaign.name) == ("grid", "map")
    assert campaign.units["film_minimum"] == "m"
    for name, _ in made.columns:
        np.testing.assert_array_equal(campaign[name], made.column(name))
    assert isinstance(campaign["scene"].base, np.memmap)


@pytest.mark.parametrize("slow_first", [False, True])
def test_axes_and_grid_in_either_order_of_scenes(tmp_path, slow_first):
    made = grid(FORCES, SPEEDS, VISCOSITIES, slow_first=slow_first)
    campaign = rattle.read_campaign(made.write(tmp_path / "map.rattle"))
    assert campaign.shape == (20, 15, 3)
    assert [axis.scale for axis in campaign.axes] == ["linear", "logarithmic", "values"]
    np.testing.assert_array_equal(campaign.axis(SPEED).values, SPEEDS.values)
    np.testing.assert_array_equal(campaign.axis(VISCOSITY).values, (0.1, 0.3, 0.9))
    values = campaign.grid(FORCE)
    np.testing.assert_array_equal(values, np.broadcast_to(FORCES.values[:, None, None], (20, 15, 3)))
    np.testing.assert_array_equal(np.unique(campaign.grid("scene")), np.arange(1, 901))


def test_unfinished_campaign_knows_what_is_done(made, tmp_path):
    path = made.write(tmp_path / "map.rattle", undone=[1, 4], closed=False)
    path.write_bytes(path.read_bytes()[: -44 * 8 * len(made.columns)])  # the last chunk was never written
    campaign = rattle.read_campaign(path)
    assert not campaign.closed
    assert campaign.row_count == 300
    np.testing.assert_array_equal(campaign.chunks.done, [True, False, True, True, False])
    done = np.ones(300, dtype=bool)
    done[64:128] = done[256:] = False
    np.testing.assert_array_equal(campaign.done, done)
    assert np.isnan(campaign["acceleration_maximum"][~done]).all()
    np.testing.assert_array_equal(campaign["scene"][done], np.arange(1, 301)[done])
    np.testing.assert_array_equal(campaign.axis(SPEED).values, SPEEDS.values)
    known = np.where(done, made.column("rattle_class"), np.nan).reshape(15, 20).T
    np.testing.assert_array_equal(campaign.grid("rattle_class"), known)
    assert len(campaign.frame()) == 192


def test_unfinished_campaign_of_whole_chunks_knows_its_scenes(tmp_path):
    made = grid(FORCES, SPEEDS, chunk_rows=60)
    path = made.write(tmp_path / "map.rattle", undone=[2], closed=False)
    campaign = rattle.read_campaign(path)
    assert (campaign.row_count, campaign.scene_count, campaign.done.sum()) == (300, 300, 240)
    path.write_bytes(path.read_bytes()[:-8])
    with pytest.raises(rattle.ResultError, match="chunk 5 counts as done, but 299 rows are all it holds"):
        rattle.read_campaign(path)


def test_unfinished_campaign_of_short_chunks_may_end_before_all_of_them(tmp_path):
    made = grid(FORCES, SPEEDS, chunk_rows=1)
    path = made.write(tmp_path / "map.rattle", undone=[7, *range(60, 300)], closed=False)
    path.write_bytes(path.read_bytes()[: -240 * 8 * len(made.columns)])
    campaign = rattle.read_campaign(path)
    assert campaign.done.sum() == 59
    np.testing.assert_array_equal(campaign["scene"][campaign.done], np.delete(np.arange(1, 61), 7))
    damaged = bytearray(path.read_bytes())
    damaged[-1] ^= 1
    path.write_bytes(damaged)
    with pytest.raises(rattle.ResultError, match="rows 60 to 60 .* are not what their checksum says"):
        rattle.read_campaign(path).frame()


def test_campaign_that_has_just_begun(made, tmp_path):
    campaign = rattle.read_campaign(made.write(tmp_path / "a.rattle", undone=range(5), closed=False))
    assert campaign.done.sum() == 0
    assert campaign.shape == (20, 15)
    assert campaign.frame().empty
    assert np.isnan(campaign.dataset()["rattle_class"]).all()


def test_a_part_knows_its_share(made, tmp_path):
    first, last = (rattle.read_campaign(path) for path in made.write_parts(tmp_path, 2))
    assert (first.part, first.parts, last.part, last.parts) == (1, 2, 2, 2)
    assert (first.row_count, last.row_count) == (128, 172)
    assert last["scene"][0] == 129
    assert last.scene_count == 300
    assert np.isfinite(last.grid("rattle_class")).sum() == 172


def test_last_part_that_is_not_finished_knows_its_share(made, tmp_path):
    last = rattle.read_campaign(made.write_parts(tmp_path, 2, undone=[1], closed=False)[1])
    assert last.row_count == 172
    assert last.done.sum() == 108


def test_frame_holds_numbers_and_words(campaign, made):
    frame = campaign.frame()
    assert list(frame.columns[:3]) == ["scene", FORCE, SPEED]
    assert frame["scene"].dtype == "int64"
    np.testing.assert_array_equal(frame["acceleration_maximum"], made.column("acceleration_maximum"))
    words = np.array(["", "quiet", "creep", "idle", "irregular", "subharmonic", "irregular_so_far"])[
        made.column("rattle_class").astype(int)
    ]
    assert frame["rattle_class_word"].tolist() == words.tolist()
    assert set(frame["status_word"]) == {"steady"}
    assert frame.attrs["units"]["film_minimum"] == "m"


def test_failed_scenes(tmp_path):
    made = grid(FORCES, SPEEDS, failures=True)
    campaign = rattle.read_campaign(made.write(tmp_path / "map.rattle"))
    assert campaign.failed.sum() == (made.column("status") > 1).sum() > 0
    frame = campaign.frame()
    assert set(frame["status_word"]) == {"steady", "film_lost", "no_rigid_film"}
    assert frame["rattle_class_word"].isna().sum() == campaign.failed.sum()


def test_dataset_of_a_grid(campaign):
    data = campaign.dataset()
    assert data["rattle_class"].dims == (FORCE, SPEED)
    assert data["film_minimum"].attrs["units"] == "m"
    assert data["acceleration_maximum"].attrs["units"] == "m s-2"
    assert data["rattle_class"].attrs["flag_meanings"] == (
        "quiet creep idle irregular subharmonic irregular_so_far"
    )
    for name, known in (("rattle_class", CLASSES), ("status", STATUSES), ("verified", NO_OR_YES)):
        attributes = data[name].attrs
        meanings = dict(zip(attributes["flag_values"], attributes["flag_meanings"].split(), strict=True))
        assert meanings == dict(known)
    point = data.sel({FORCE: 200.0, SPEED: 2.0}, method="nearest")
    row = int(point["scene"]) - 1
    assert float(point["natural_frequency"]) == campaign["natural_frequency"][row]
    assert data.attrs["resolved_input"] == campaign.input_text


def test_dataset_of_a_sample_is_one_dimensional(tmp_path):
    campaign = rattle.read_campaign(sample().write(tmp_path / "cloud.rattle"))
    assert campaign.kind == "sample"
    data = campaign.dataset()
    assert dict(data.sizes) == {"scene": 300}
    assert set(data.coords) == {"scene", FORCE, SPEED}
    with pytest.raises(rattle.ResultError, match="is not a grid but a sample campaign"):
        campaign.grid("rattle_class")


def test_csv_campaign(tmp_path):
    made = csv_table()
    campaign = rattle.read_campaign(made.write(tmp_path / "list.rattle"))
    assert (campaign.kind, campaign.scene_count) == ("csv", 3)
    open_one = rattle.read_campaign(made.write(tmp_path / "open.rattle", undone=[0], closed=False))
    assert open_one.scene_count is None
    assert (open_one.row_count, open_one.done.sum()) == (3, 1)


def test_whole_array_assignments_in_the_input(tmp_path):
    made = grid(SMALL)
    made.group = f"   vary = '{FORCE}'\n   first = 100.0\n   last = 300.0\n   count = 5\n"
    campaign = rattle.read_campaign(made.write(tmp_path / "map.rattle"))
    np.testing.assert_array_equal(campaign.axis(FORCE).values, SMALL.values)


def test_lists_of_values_beside_ranges_belong_to_their_keys(tmp_path):
    """A list of the second key, and keys that begin behind the first, as a namelist may have them."""
    made = grid(SMALL, VISCOSITIES)
    made.group = f"   vary = '{FORCE}', '{VISCOSITY}'\n   first = 100.0\n   last = 300.0\n   count = 5\n"
    made.group += "   values(:, 2) = 0.1, 0.3, 0.9\n"
    campaign = rattle.read_campaign(made.write(tmp_path / "map.rattle", undone=[0], closed=False))
    np.testing.assert_array_equal(campaign.axis(FORCE).values, SMALL.values)
    np.testing.assert_array_equal(campaign.axis(VISCOSITY).values, (0.1, 0.3, 0.9))
    assert [axis.scale for axis in campaign.axes] == ["linear", "values"]


def test_axis_takes_the_digits_of_the_rows(tmp_path):
    made = grid(Key(SPEED, 0.5, 5.0, 7, "logarithmic"))
    made.column(SPEED)[3] = np.nextafter(made.column(SPEED)[3], 9.0)
    campaign = rattle.read_campaign(made.write(tmp_path / "map.rattle"))
    np.testing.assert_array_equal(campaign.axis(SPEED).values, made.column(SPEED))


def test_unknown_column_and_key_name_those_held(campaign):
    with pytest.raises(rattle.ResultError, match="has no column 'film'; it holds scene, load.force"):
        campaign["film"]
    with pytest.raises(rattle.ResultError, match="does not vary 'load.mass'; it varies load.force"):
        campaign.axis("load.mass")


def changed(content: bytes, offset: int, form: str, *values: int) -> bytes:
    raw = bytearray(content)
    struct.pack_into(form, raw, offset, *values)
    return bytes(raw)


def table_at(content: bytes) -> int:
    return content.index(b"CHUNKTAB")


DAMAGE = [
    (lambda c, _: c[:-8], "is cut short: it holds 299 of its 300 rows."),
    (lambda c, _: c + b"12345678", "is 8 bytes longer than its 300 rows."),
    (lambda c, t: changed(c, 24, "<q", -1) + b"12345678", "is 8 bytes longer than its 300 rows."),
    (
        lambda c, t: c.replace(b"CHUNKTAB", b"CHUNKTUB"),
        "has a damaged header: it is not what its checksum says.",
    ),
    (lambda c, t: resealed(c.replace(b"CHUNKTAB", b"CHUNKTUB")), "has a damaged chunk table: its sizes"),
    (
        lambda c, t: resealed(changed(c, t + 8, "<q", 0)),
        "has a damaged chunk table: its sizes contradict each other.",
    ),
    (
        lambda c, t: resealed(changed(c, t + 8, "<q", 1)),
        "has a damaged chunk table: its sizes contradict each other.",
    ),
    (
        lambda c, t: resealed(changed(c, t + 16, "<q", 2**60)),
        "has a damaged chunk table: its sizes contradict",
    ),
    (lambda c, t: resealed(changed(c, t + 16, "<q", 0)), "has a damaged chunk table: its sizes contradict"),
    (lambda c, t: resealed(changed(c, t + 8, "<q", 10)), "has a damaged chunk table: its sizes contradict"),
    (lambda c, t: resealed(changed(c, t + 24, "<q", 299)), "its counts of rows contradict each other"),
    (lambda c, t: changed(c, t + 40, "<q", 0), "it is closed, but its chunk 2 is not done."),
    (lambda c, t: changed(c, t + 40, "<q", 77), "is damaged: rows 65 to 128 (bytes "),
    (lambda c, t: changed(c, len(c) - 1, "B", 1), "is damaged: rows 257 to 300 (bytes "),
    (
        lambda c, _: changed(c, 24, "<q", -1)[:-8],
        "chunk 5 counts as done, but 299 rows are all it holds.",
    ),
    (lambda c, _: resealed(c.replace(b"&campaign", b"&campaigx")), "has no group &campaign."),
    (lambda c, _: resealed(c.replace(b"part = 1", b"part = 2")), "its part 2 is none of 1"),
    (
        lambda c, _: resealed(c.replace(b"parts = 1", b"parts=1,1")),
        "its campaign.parts is not a positive whole number",
    ),
    (
        lambda c, _: resealed(c.replace(b"parts = 1", b"parts = 0")),
        "its campaign.parts is not a positive whole number",
    ),
    (
        lambda c, _: resealed(c.replace(b"count(1) = 20", b"count(1) = 19")),
        "load.force_amplitude has values such as",
    ),
    (
        lambda c, _: resealed(c.replace(b"scene   ", b"stage   ", 1)),
        "its columns are not a scene and the varied keys.",
    ),
    (lambda c, _: b"other" + c, "is not a rattle result file."),
    (lambda c, t: c[: t + 8], "ends inside its header."),
]


@pytest.mark.parametrize(("damage", "words"), DAMAGE)
def test_damage_is_one_sentence(made, tmp_path, damage, words):
    content = made.content()
    path = tmp_path / "map.rattle"
    path.write_bytes(damage(content, table_at(content)))
    with pytest.raises(rattle.ResultError) as fault:
        rattle.read_campaign(path).axes  # noqa: B018
    assert words in str(fault.value)
    assert str(path) in str(fault.value)


def test_every_cut_is_refused_or_read(tmp_path):
    content = grid(SMALL).content()
    path = tmp_path / "map.rattle"
    for length in range(0, len(content), 97):
        path.write_bytes(content[:length])
        with pytest.raises(rattle.ResultError):
            rattle.read_campaign(path)


def test_a_time_series_is_no_campaign(tmp_path):
    path = write_motion(tmp_path / "idle.rattle", lines={1.0: 1.0})
    with pytest.raises(
        rattle.ResultError, match="is not a campaign but the result of task = 'motion'; 'plot.py motion'"
    ):
        rattle.read_campaign(path)
    with pytest.raises(rattle.ResultError, match="No such file"):
        rattle.read_campaign(tmp_path / "absent.rattle")


def test_threads_name_the_first_damage(made, tmp_path, monkeypatch):
    """Chunks are verified side by side; what is reported is the damage that stands first."""
    monkeypatch.setattr("rattle.result_file.FEWEST_CHUNKS", 1)
    monkeypatch.setattr("os.sched_getaffinity", lambda _: {0, 1, 2})
    content = made.content()
    path = tmp_path / "map.rattle"
    path.write_bytes(content)
    assert np.isfinite(rattle.read_campaign(path)["film_minimum"]).any()
    table = table_at(content)
    path.write_bytes(changed(changed(content, table + 56, "<q", 77), table + 40, "<q", 77))
    with pytest.raises(rattle.ResultError, match="is damaged: rows 65 to 128 "):
        rattle.read_campaign(path)["film_minimum"]
