"""Variants side by side: numbers are those of the single results, and nothing differs from itself."""

from __future__ import annotations

import csv
import math
import shutil
import sys
from pathlib import Path

import numpy as np
import pandas
import pytest
from report_reader import read_page
from script_calls import called_here

import rattle as package
from rattle.command import CommandError
from rattle.comparison.difference import Difference
from rattle.report import page as page_parts

BOX = {"solver": {"starts": 1, "accuracy": 1e-6}}
HALVED = {**BOX, "shaft": {"accelerations": [300.0, 100.0, 50.0, 20.0]}}
MAP = {
    "film": {"law": "iso-viscous", "model": "reynolds"},
    "solver": {"method": "taylor", "until": "steady", "periods": 20, "accuracy": 1e-4},
    "campaign": {"count": [3, 2], "record": ["verdict", "rattle_class", "film_force_rms", "film_minimum"]},
    "spectrum": {"periods": 1},
}


@pytest.fixture(scope="module")
def boxes(rattle, repository, tmp_path_factory) -> dict[str, Path]:
    """The table of the ready gearbox, and of one whose engine shakes half as much."""
    folder = tmp_path_factory.mktemp("boxes")
    for name, given in (("base", BOX), ("halved", HALVED)):
        options = {"set": given, "folder": folder / name, "program": rattle}
        package.run(repository / "input" / "gearbox.nml", **options)
    return {name: folder / name / "gearbox.summary.nml" for name in ("base", "halved")}


@pytest.fixture(scope="module")
def maps(rattle, repository, tmp_path_factory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("maps")
    for name, scale in (("base", 1.0), ("scaled", 0.6)):
        given = {**MAP, "load": {"force_scale": scale}}
        options = {"set": given, "folder": folder / name, "program": rattle}
        package.run(repository / "input" / "gearbox_map.nml", **options)
    return {name: folder / name / "gearbox_map.rattle" for name in ("base", "scaled")}


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pages without their pictures, for tests of words."""
    monkeypatch.setattr(page_parts, "drawing", lambda draw, caption, salt: "")


def test_a_gearbox_beside_itself_has_no_difference(boxes) -> None:
    frame = package.variants({"base": boxes["base"], "again": boxes["base"]})
    assert frame.same.all() and (frame.change.dropna() == 0.0).all()
    assert set(frame.part) == {"answer", "together"}
    assert set(frame.gear) == {"1st", "2nd", "3rd", "4th", ""}


def test_solved_again_as_accurately_nothing_differs_beyond_the_errors(rattle, repository, boxes) -> None:
    tighter = {**BOX, "solver": {**BOX["solver"], "accuracy": 1e-8}}
    again = package.run(repository / "input" / "gearbox.nml", set=tighter, program=rattle)
    frame = package.variants({"base": boxes["base"], "again": again})
    answer = frame[frame.part == "answer"]
    stated = answer[answer.base_error.notna() & answer.error.notna()]
    assert len(stated) > 20 and (stated.change != 0.0).any()
    assert stated.same.all(), stated[~stated.same]
    inputs = frame[frame.part == "input"]
    assert list(inputs.name) == ["solver.accuracy"] and list(inputs.gear) == [""]


def test_every_number_is_that_of_the_single_results(boxes) -> None:
    frame = package.variants(boxes)
    for gear in ("1st", "2nd", "3rd", "4th"):
        base, other = (
            package.read_summary(path.with_name(f"gearbox.{gear}.summary.nml")) for path in boxes.values()
        )
        rows = frame[(frame.gear == gear) & (frame.part == "answer")].set_index("name")
        for name, row in rows.iterrows():
            if base.get(f"{name}_is_bound") or other.get(f"{name}_is_bound"):
                continue
            assert (row.base, row.value) == (base.get(name), other.get(name)), name
            if f"{name}_error" in base and f"{name}_error" in other:
                assert (row.base_error, row.error) == (base[f"{name}_error"], other[f"{name}_error"]), name
        force = rows.loc["film_force_rms"]
        ratio = other["film_force_rms"] / base["film_force_rms"]
        assert force.percent == pytest.approx(100.0 * (ratio - 1.0), rel=1e-12)
        assert force.decibel == pytest.approx(20.0 * math.log10(ratio), rel=1e-12)
        assert not force.same
        power = rows.loc["dissipated_power"]
        expected = 10.0 * math.log10(other["dissipated_power"] / base["dissipated_power"])
        assert power.decibel == pytest.approx(expected, rel=1e-12)
    together = frame[frame.part == "together"].set_index("name")
    tables = [package.read_summary(path) for path in boxes.values()]
    for name in ("film_force_rms_uncorrelated", "film_force_rms_in_phase", "dissipated_power"):
        assert [together.base[name], together.value[name]] == [table[name] for table in tables]
    inputs = frame[frame.part == "input"]
    assert list(inputs.name) == ["shaft.accelerations"] and list(inputs.gear) == [""]
    assert inputs.value.iloc[0] == [300.0, 100.0, 50.0, 20.0]
    follows = frame[frame.part == "follows"]
    assert set(follows.name) == {"load.force_amplitudes"} and len(follows) == 4


@pytest.mark.parametrize(
    ("base", "value", "errors", "words"),
    (
        (1.0, 1.0, (None, None), "none"),
        (1.0, 1.003, (2e-3, 2e-3), "none within the errors"),
        (1.0, 1.003, (1e-3, 1e-3), ""),
        (1.0, 1.0 + 2e-6, (None, None), "none within the errors"),  # half a unit of the sixth digit of both
        (1.0, 1.0 + 2e-5, (None, None), ""),
        (0.0, 0.0, (0.0, 0.0), "none"),
        ("idle ", "idle", (None, None), "none"),
        ("idle", "creep", (None, None), ""),
        (None, 1.0, (None, None), ""),
        (True, False, (None, None), ""),
    ),
)
def test_a_difference_within_the_errors_is_none(base, value, errors, words) -> None:
    entry = Difference("variant", "1st", "answer", "film_force_rms", "N", base, value, *errors)
    assert entry.words == words and entry.same == bool(words)


def test_a_key_of_the_input_differs_by_any_digit() -> None:
    entry = Difference("variant", "", "input", "load.mass", "kg", 1.0, 1.0 + 1e-12)
    assert not entry.same


def test_changes_are_of_the_size_and_none_where_a_unit_has_no_ratio() -> None:
    drop = Difference("variant", "", "answer", "acceleration_minimum", "m/s2", -200.0, -100.0)
    assert (drop.percent, drop.decibel) == (-50.0, pytest.approx(-6.0206, abs=1e-4))
    warmer = Difference("variant", "", "input", "oil.temperature_celsius", "degC", 40.0, 60.0)
    assert (warmer.change, warmer.percent, warmer.decibel) == (20.0, None, None)
    turned = Difference("variant", "", "answer", "velocity_minimum", "m/s", -1.0, 1.0)
    assert (turned.change, turned.percent, turned.decibel) == (2.0, None, None)


@pytest.mark.usefixtures("undrawn")
def test_the_page_and_the_csv_file_say_the_same(boxes, tmp_path) -> None:
    page, table = tmp_path / "box.html", tmp_path / "box.csv"
    code, said, complained = called_here("compare.py", *boxes.values(), "--output", page, cwd=tmp_path)
    assert (code, complained) == (0, "") and said.split() == [str(page), str(table)]
    frame = package.variants({"base/gearbox": boxes["base"], "halved/gearbox": boxes["halved"]})
    with table.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["name"] for row in rows] == list(frame.name)
    for row, (_, known) in zip(rows, frame.iterrows(), strict=True):
        if isinstance(known.base, float) and isinstance(known.value, float):
            assert float(row["base"]) == known.base and float(row["value"]) == known.value
        assert row["same"] == str(known.same)
    read = read_page(page)
    reported = {float(digits) for digits, _ in read.numbers}
    seen = frame[frame.name.isin(("film_force_rms", "acceleration_rms", "film_minimum"))]
    assert {*seen.base, *seen.value} <= reported
    decibels = [f"{value:+.2f}".replace("-", "\N{MINUS SIGN}") for value in seen.decibel.dropna()]
    assert decibels and all(any(words in row[-1] for row in read.rows if row) for words in decibels)
    assert "The answer differs" in read.verdicts[0]


@pytest.mark.usefixtures("undrawn")
def test_what_differs_in_one_variant_is_shown_of_all(boxes, tmp_path) -> None:
    """A variant that does not differ there has its number and 'none', as if it were compared alone."""
    again = shutil.copytree(boxes["base"].parent, tmp_path / "again")
    page = tmp_path / "three.html"
    paths = [boxes["base"], boxes["halved"], again / "gearbox.summary.nml"]
    code, _, complained = called_here("compare.py", *paths, "--output", page, cwd=tmp_path)
    assert (code, complained) == (0, "")
    rows = [row for row in read_page(page).rows if len(row) == 6 and row[0] != "Quantity"]
    assert len(rows) > 100 and any(row[3] not in ("none", "-") for row in rows)
    for row in rows:
        assert (row[4], row[5]) == (row[1], "-" if row[1] == "-" else "none"), row


@pytest.mark.usefixtures("undrawn")
def test_the_page_of_a_result_beside_itself_says_so(boxes, tmp_path) -> None:
    series = boxes["base"].with_name("gearbox.1st.rattle")
    code, _, complained = called_here(
        "compare.py", series, series, "--output", tmp_path / "p.html", cwd=tmp_path
    )
    assert (code, complained) == (0, "")
    page = read_page(tmp_path / "p.html")
    assert "The answer does not differ" in page.verdicts[0]
    assert "No quantity differs beyond the errors." in page.verdicts[0]
    assert "Nothing: every key has the same value." in page.words
    changes = [row[-1] for row in page.tables[0][1:] if len(row) > 1]
    assert changes and set(changes) == {"none"}


def test_pairs_of_one_input_are_one_variant(boxes) -> None:
    paths = [sorted(path.parent.glob("gearbox.*.rattle")) for path in boxes.values()]
    frame = package.variants({"base": paths[0], "halved": paths[1]})
    pandas.testing.assert_frame_equal(frame, package.variants(boxes))
    some = package.variants({"base": paths[0][:3], "halved": paths[1][:3]})
    assert "together" not in set(some.part)


def test_maps_stand_side_by_side_at_the_same_points(maps) -> None:
    base, scaled = (package.read_campaign(path) for path in maps.values())
    frame = package.variants(maps)
    assert len(frame) == base.row_count == 24 and set(frame.gear) == {"1st", "2nd", "3rd", "4th"}
    assert np.array_equal(frame.film_force_rms_base, base["film_force_rms"])
    assert np.array_equal(frame.film_force_rms, scaled["film_force_rms"])
    assert not frame.film_force_rms_same.any() and not frame.verdict_same.all()
    assert (frame.verdict_same == (base["verdict"] == scaled["verdict"])).all()
    itself = package.variants({"base": maps["base"], "again": maps["base"]})
    assert itself[[name for name in itself if name.endswith("_same")]].all(axis=None)


def test_the_page_of_maps_draws_both_and_their_difference(maps, tmp_path) -> None:
    page = tmp_path / "o" / "comparison.html"
    code, said, complained = called_here(
        "compare.py", *maps.values(), "--output", tmp_path / "o", cwd=tmp_path
    )
    assert (code, complained) == (0, "") and str(page) in said
    text = page.read_text()
    assert text.count("<svg") == 2 and "No figure here" not in text
    read = read_page(page)
    frame = package.variants(maps)
    differ = int((~frame.verdict_same).sum())
    assert f"Verdict differs at {differ} of 24." in read.verdicts[0]
    levels = 20.0 * np.log10(frame.film_force_rms / frame.film_force_rms_base)
    for gear, of_gear in levels.groupby(frame.gear):
        row = next(row for row in read.rows if row and row[0] == gear)
        expected = [of_gear.median(), of_gear.min(), of_gear.max()]
        assert [cell.replace("\N{MINUS SIGN}", "-") for cell in row[4:]] == [
            f"{value:+.2f}\xa0dB" for value in expected
        ]


def test_thresholds_differ_by_their_middles_with_half_the_width_as_error(
    rattle, repository, tmp_path
) -> None:
    found = {}
    for name, force in (("base", 199.2), ("lighter", 120.0)):
        given = {"load.steady_force": force, "threshold.tolerance": 0.02, "campaign.values(:,1)": [1.0, 2.0]}
        options = {"set": given, "folder": tmp_path / name, "program": rattle}
        found[name] = package.run(repository / "input" / "threshold.nml", **options)
    frame = package.variants(found)
    for side, column in (("base", "threshold_base"), ("lighter", "threshold")):
        result = found[side].result
        crossed = result["crossing"] == 1
        middles = 0.5 * (result["lower"] + result["upper"])[crossed]
        assert np.isin(frame[column].dropna(), middles).all()
    known = frame.dropna(subset=["threshold", "threshold_base"])
    assert len(known) and not known.threshold_same.all()
    itself = package.variants({"base": found["base"], "again": found["base"]})
    assert itself.threshold_same.all() and itself.kind_same.all()


def test_sweeps_are_compared_way_by_way(rattle, repository, tmp_path) -> None:
    path = repository / "input" / "sweep.nml"
    given = {"sweep.count": 3}
    base = package.run(path, set=given, folder=tmp_path / "a", program=rattle)
    other = package.run(
        path, set={**given, "load.force_amplitude": 20.0}, folder=tmp_path / "b", program=rattle
    )
    frame = package.variants({"base": base, "other": other})
    assert len(frame) == len(base.result["direction"]) and set(frame.direction) == {"up", "down"}
    assert np.array_equal(frame.acceleration_rms_base, base.result["acceleration_rms"])
    assert np.array_equal(frame.acceleration_rms, other.result["acceleration_rms"])


@pytest.mark.usefixtures("undrawn")
def test_a_report_on_results_of_one_kind_contains_the_comparison(boxes, tmp_path) -> None:
    paths = [path.with_name("gearbox.1st.rattle") for path in boxes.values()]
    code, _, complained = called_here("report.py", *paths, "--output", tmp_path / "r.html", cwd=tmp_path)
    assert (code, complained) == (0, "")
    page = read_page(tmp_path / "r.html")
    assert "base/gearbox.1st beside halved/gearbox.1st" in page.headings
    assert any("The answer differs" in words for words in page.verdicts)


def test_bad_inputs_have_a_plain_sentence(boxes, maps, tmp_path) -> None:
    lonely = tmp_path / "lonely.rattle"
    shutil.copy(boxes["base"].with_name("gearbox.1st.rattle"), lonely)
    table = tmp_path / "gearbox.summary.nml"
    shutil.copy(boxes["base"], table)
    output = ("--output", tmp_path / "o.html")
    for arguments, words in (
        ((boxes["base"],), "A comparison needs two results"),
        (
            (boxes["base"], maps["base"]),
            "Results of one kind are compared: gearbox is a motion, gearbox_map is a",
        ),
        ((boxes["base"], lonely), "No summary stands beside"),
        ((boxes["base"], table), "of one of them is not there"),
        ((boxes["base"], tmp_path / "absent.rattle"), "cannot be read"),
        ((boxes["base"], boxes["halved"], "--markdown"), "--markdown is for the table of summaries"),
    ):
        code, said, complained = called_here("compare.py", *arguments, *output, cwd=tmp_path)
        assert (code, said) == (2, "") and words in complained, complained
        assert complained.count("\n") == 1 and not (tmp_path / "o.html").exists()
    code, _, complained = called_here(
        "compare.py", boxes["base"], boxes["halved"], "--overwrite", cwd=tmp_path
    )
    assert (
        code == 2 and "--overwrite is for the figure of --measured and the files of --output." in complained
    )
    with pytest.raises(CommandError, match="other is a float"):
        package.variants({"base": boxes["base"], "other": 1.0})


def test_pairs_that_one_side_lacks_are_named(boxes, tmp_path) -> None:
    first, *_ = sorted(boxes["halved"].parent.glob("gearbox.*.rattle"))
    arguments = (boxes["base"], first, "--output", tmp_path / "o.html")
    assert called_here("compare.py", *arguments, cwd=tmp_path)[0] == 0
    assert "gearbox alone has 2nd, 3rd, 4th." in read_page(tmp_path / "o.html").words


@pytest.mark.parametrize("library", ("pandas", "xarray"))
def test_without_the_library_a_table_says_what_brings_it(library, boxes, maps, monkeypatch) -> None:
    result = package.read(boxes["base"].with_name("gearbox.1st.rattle"))
    box = package.Gearbox({"1st": package.Solved(result, package.read_summary(result.summary_path))})
    monkeypatch.setitem(sys.modules, library, None)
    name = "to_dataframe" if library == "pandas" else "to_xarray"
    for one in (result, package.read_campaign(maps["base"]), box, box["1st"]):
        with pytest.raises(ModuleNotFoundError, match=rf"^{library} is not installed.*rattle\[tables\]"):
            getattr(one, name)()
    if library == "pandas":
        with pytest.raises(ModuleNotFoundError, match="pandas is not installed"):
            package.variants(boxes)


def test_what_was_solved_of_one_pair_is_a_table_of_one_row(boxes) -> None:
    result = package.read(boxes["base"].with_name("gearbox.2nd.rattle"))
    solved = package.Solved(result, package.read_summary(result.summary_path))
    frame = solved.to_dataframe()
    assert list(frame.index) == ["2nd"] and frame.film_minimum.item() == solved.summary["film_minimum"]
    assert dict(solved.to_xarray().sizes) == {"gear": 1}


@pytest.mark.usefixtures("undrawn")
def test_a_report_on_two_gearboxes_of_one_name_has_the_table_of_each(boxes, tmp_path) -> None:
    paths = [path for box in boxes.values() for path in sorted(box.parent.glob("gearbox.???.rattle"))]
    code, _, complained = called_here("report.py", *paths, "--output", tmp_path / "r.html", cwd=tmp_path)
    assert (code, complained) == (0, "")
    page = read_page(tmp_path / "r.html")
    for name, box in boxes.items():
        assert f"Gear pairs of {name}/gearbox" in page.headings
        together = package.read_summary(box)["film_force_rms_uncorrelated"]
        assert repr(together) in {digits for digits, _ in page.numbers}
    assert "base/gearbox beside halved/gearbox" in page.headings
