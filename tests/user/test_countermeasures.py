"""countermeasures.py: what it advises is solved again alone, and does what was said."""

from __future__ import annotations

import csv
import math
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from page_commands import call, shell
from script_calls import called_here, figure_stems
from test_calibrate import INPUT
from test_report import report

import rattle as package
from rattle.codes import CODES
from rattle.countermeasures import table, words
from rattle.countermeasures.levers import KINDS, levers
from rattle.countermeasures.scenes import SEVERITY, UNKNOWN, Answer, opened
from rattle.countermeasures.study import TARGETS, PairStudy, study, ways
from rattle.countermeasures.trace import Change, Trace, _followed, _solved

VERDICTS = {word: code for code, word in CODES["verdict"].items()}
KEYS = ("gear.backlash", "oil.viscosity_40_cst", "shaft.accelerations(1)", "load.force_scale")
VARIANTS = "variant,cost,gear.backlash,oil.temperature_celsius\nhalf,4,*0.5,\ncold,,,20\ncheap,1,8.1e-5,\n"
# The same gear with a smaller pair beside it.
TWO = INPUT.replace("&gear\n", "&gear\n   name = 'large'\n") + INPUT[: INPUT.index("&shaft")].replace(
    "&gear\n", "&gear\n   name = 'small'\n"
).replace("loose_inertia = 8.9e-4", "loose_inertia = 4.0e-4")


@pytest.fixture(scope="module")
def reported(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A pair with what was found of it, and a list of variants."""
    folder = tmp_path_factory.mktemp("pair")
    (folder / "pair.nml").write_text(INPUT)
    (folder / "list.csv").write_text(VARIANTS)
    asked = ("pair.nml", "--keys", ",".join(KEYS), "--variants", "list.csv", "--output", ".")
    code, said, complained = called_here("countermeasures.py", *asked, cwd=folder)
    assert code == 0, complained
    assert (folder / "pair.countermeasures.md").read_text() in said
    return folder


@pytest.fixture(scope="module")
def pair(reported: Path) -> PairStudy:
    (found,) = table.read(reported / "pair.countermeasures.csv")
    return found


def solved(path: Path, settings: dict) -> Answer:
    """What the program says of a scene with some keys changed: worst verdict, force of the loudest."""
    summary = package.run(path, set={"output.series": False} | settings).summary
    worst = max((VERDICTS[summary[name]] for name in ("verdict", "loudest_verdict")), key=SEVERITY.index)
    return Answer(worst, summary["loudest_film_force_rms"], 0.0, summary["motions"])


def settings_of(key: str, value: float) -> dict:
    """The keys of `INPUT` that one of `KEYS` stands for."""
    if key == "oil.viscosity_40_cst":
        return {key: value, "oil.viscosity_100_cst": 9.6 * value / 58.0}
    return {"shaft.accelerations": [value, 100.0]} if key.startswith("shaft") else {key: value}


def test_every_change_that_is_confirmed_ends_what_it_says(reported: Path, pair: PairStudy) -> None:
    """And gains what it says; a thirtieth of the range nearer to the present value it has not ended."""
    ends = [(m.lever, name, end) for m in pair.measures for name, end in m.ends.items() if end.confirmed]
    assert {lever.key for lever, *_ in ends} >= {KEYS[0], KEYS[2], KEYS[3]}
    assert {name for _, name, _ in ends} == set(TARGETS)
    now = solved(reported / "pair.nml", {})
    assert (now.verdict, now.force) == (pair.now.verdict, pair.now.force)
    for lever, name, end in ends:
        after = solved(reported / "pair.nml", settings_of(lever.key, end.value))
        assert after.verdict in TARGETS[name], (lever.key, name)
        assert end.answer.change_db(pair.now) == pytest.approx(20.0 * math.log10(after.force / now.force))
        nearer = lever.value_at(float(lever.place_of(end.value)) - math.copysign(0.03, end.share))
        before = solved(reported / "pair.nml", settings_of(lever.key, nearer))
        assert before.verdict not in TARGETS[name], (lever.key, name)


def test_what_ends_nothing_within_its_range_ends_nothing(reported: Path, pair: PairStudy) -> None:
    (oil,) = (measure for measure in pair.measures if measure.lever.key == KEYS[1])
    assert not oil.ends
    assert words.end_words(oil, "impacts") == "not within"
    for value in (29.0, 41.0, 82.0, 116.0):
        assert (
            solved(reported / "pair.nml", settings_of(KEYS[1], value)).verdict
            == VERDICTS["double-sided impacts"]
        )


def test_effort_is_the_better_of_both_ways(reported: Path, pair: PairStudy) -> None:
    for measure in pair.measures:
        lever = measure.lever
        both = [lever.now * 0.9] + ([lever.now * 1.1] if lever.last > lever.now else [])
        forces = {value: solved(reported / "pair.nml", settings_of(lever.key, value)).force for value in both}
        value, answer = measure.effort
        assert value == pytest.approx(min(forces, key=forces.get))
        assert answer.force == pytest.approx(min(forces.values()), rel=1e-9)


def test_ranks_begin_with_what_ends_impacts_soonest(pair: PairStudy) -> None:
    shares = [m.ends["impacts"].share if "impacts" in m.ends else math.inf for m in pair.measures]
    assert [abs(share) for share in shares] == sorted(map(abs, shares)) and abs(shares[0]) <= 1.0


def test_variants_are_solved_and_ranked_by_what_they_gain_for_their_cost(reported: Path) -> None:
    with (reported / "pair.together.csv").open(newline="") as stream:
        rows = {row["change"]: row for row in csv.DictReader(stream)}
    now = solved(reported / "pair.nml", {})
    settings = {
        "half": {"gear.backlash": 4.5e-5},
        "cheap": {"gear.backlash": 8.1e-5},
        "cold": {"oil.temperature_celsius": 20.0},
    }
    for name, keys in settings.items():
        after = solved(reported / "pair.nml", keys)
        assert float(rows[name]["change_db"]) == pytest.approx(20.0 * math.log10(after.force / now.force))
        assert int(rows[name]["verdict_pair"]) == after.verdict
    gains = [float(rows[name]["gain_db_per_cost"]) for name in list(rows)[:2]]
    assert list(rows)[2] == "cold" and gains == sorted(gains, reverse=True)
    assert float(rows["half"]["gain_db_per_cost"]) == pytest.approx(-float(rows["half"]["change_db"]) / 4.0)


@pytest.mark.long
def test_scenes_one_by_one_find_what_the_program_follows(reported: Path, tmp_path: Path) -> None:
    (scene,) = opened(reported / "pair.nml", tmp_path).pairs
    (lever,) = (lever for lever in levers(scene.groups, {}) if lever.key == KEYS[0])
    by_program, one_by_one = _followed(scene, lever), _solved(scene, lever)
    assert len(by_program.changes) == len(one_by_one.changes) == 2
    assert by_program.first_verdict == one_by_one.first_verdict
    for one, other in zip(by_program.changes, one_by_one.changes, strict=True):
        assert (one.below, one.above) == (other.below, other.above)
        assert one.lower <= other.upper and other.lower <= one.upper


def test_calm_windows_leave_out_where_rougher_motions_last() -> None:
    """A made up trace: rough below 1, where a motion lasts to 1.5, and from 3 on, where one lasts to 2.8."""
    (lever,) = levers({"gear": {"backlash": 1.0}}, {"gear.backlash": (0.0, 4.0)})
    changes = (Change(0.9, 1.0, 3, 1, 1.5, 1.0), Change(3.0, 3.1, 1, 3, 3.0, 2.8))
    found = Trace(lever, 3, changes)
    assert (
        list(found.calm({0, 1})) == [(1.5, 2.8)]
        and list(found.calm({0})) == []
        and list(found.calm({0, 1, 2, 3})) == [(0.0, 4.0)]
    )
    assert [verdict for *_, verdict in found.stretches()] == [3, 1, 3]
    others = Trace(lever, 1, (), (2.0, 2.5))
    assert list(others.calm({0, 1})) == [(0.0, 2.0), (2.5, 4.0)]


def test_windows_are_entered_from_the_present_value() -> None:
    windows = [(0.0, 0.2), (0.4, 0.6), (0.9, 1.0)]
    assert ways(windows, 0.5) == [(0.5, 0.4), (0.5, 0.6), (0.2, 0.0), (0.9, 1.0)]
    assert ways(windows, 1.0) == [(1.0, 0.9), (0.6, 0.4), (0.2, 0.0)]
    assert ways([], 0.5) == []


def test_report_shows_what_would_stop_it(reported: Path, pair: PairStudy, tmp_path: Path) -> None:
    package.run(reported / "pair.nml", folder=tmp_path)
    shutil.copy(reported / "pair.countermeasures.csv", tmp_path)
    text = report(tmp_path / "pair.rattle").read_text()
    assert "What would stop it" in text
    for sentence in words.sentences(pair):
        assert sentence in text
    hotter = {"oil.temperature_celsius": 60.0}
    package.run(reported / "pair.nml", folder=tmp_path, set=hotter, overwrite=True)
    text = report(tmp_path / "pair.rattle").read_text()
    assert "of another run" in text and words.sentences(pair)[1] not in text
    (tmp_path / "pair.countermeasures.csv").write_text("gear,rank\npair,1\n")
    assert "not a table that countermeasures.py wrote" in report(tmp_path / "pair.rattle").read_text()


def test_figures_are_drawn(reported: Path) -> None:
    assert figure_stems(reported) == ["countermeasures_pair"]


def words_left(end: str) -> set[str]:
    """The verdicts that are left when it has ended."""
    return {CODES["verdict"][code] for code in TARGETS[end]}


def test_a_gearbox_is_solved_again_with_what_is_advised(tmp_path: Path) -> None:
    path = tmp_path / "box.nml"
    path.write_text(TWO)
    found = study(opened(path, tmp_path), {}, ("gear.backlash", "load.force_scale"))
    assert [pair.name for pair in found.pairs] == ["large", "small"]
    before = package.run(path)
    for measure in found.together:
        assert measure.confirmed
        after = package.run(path, set=measure.settings)
        force = {name: after[name].summary["loudest_film_force_rms"] for name in after}
        assert {name: one.force for name, one in measure.result.pairs.items()} == force
        assert all(after[name].summary["verdict"] in words_left(end) for name, end in measure.ends.items())
        change = [one.summary["film_force_rms_uncorrelated"] for one in (after, before)]
        assert measure.result.change_db(found.scenes.together)[0] == pytest.approx(
            20.0 * math.log10(change[0] / change[1])
        )
    (backlash,) = (one for one in found.together if one.name == "backlash")
    assert set(backlash.ends) == {"large", "small"}
    assert set(backlash.settings) == {"gear(1).backlash", "gear(2).backlash"}
    values = [
        m.best[1].value for pair in found.pairs for m in pair.measures if m.lever.key == "gear.backlash"
    ]
    assert list(backlash.settings.values()) == values


def test_maps_are_studied_at_their_operating_point(repository: Path, tmp_path: Path) -> None:
    """A campaign with a table of its own; each pair alone does what it does in the gearbox."""
    scenes = opened(repository / "input" / "gearbox_map.nml", tmp_path)
    assert [scene.name for scene in scenes.pairs] == ["1st", "2nd", "3rd", "4th"]
    last = scenes.pairs[-1]
    assert last.solve({}).force == last.now.force
    assert [lever.key for lever in levers(last.groups, {}) if lever.key.startswith("shaft")] == []


def test_a_change_that_the_program_refuses_is_named(tmp_path: Path) -> None:
    path = tmp_path / "pair.nml"
    path.write_text(INPUT)
    deep = {"gear.immersion_depth": (0.01, 0.2)}
    found = study(opened(path, tmp_path), deep, ("gear.immersion_depth",))
    (measure,) = found.pairs[0].measures
    assert measure.note.startswith("refused:") and not measure.ends
    assert words.end_words(measure, "impacts") == "-"


def test_a_pair_without_motion_has_nothing_to_end(tmp_path: Path) -> None:
    path = tmp_path / "pair.nml"
    path.write_text(INPUT)
    quiet = {"load.force_scale": 0.01}
    path.write_text(INPUT + "&load force_scale = 0.01 /\n")
    found = study(opened(path, tmp_path), {}, ("gear.backlash",))
    assert solved(path, quiet).verdict == 0 and "nothing is to end" in words.sentences(found.pairs[0])[0]
    assert len(words.cells(found.pairs[0])[0]) == 5


def test_what_comes_back_is_said_to(pair: PairStudy) -> None:
    """In the sentence as in the table: ended up to a value within the range, or to its end."""
    (measure,) = (one for one in pair.measures if one.lever.key == KEYS[0])
    now = replace(pair, measures=(measure,))
    assert "come back" not in " ".join(words.sentences(now))
    ends = {
        name: replace(end, until=0.5 * (end.value + measure.lever.last)) for name, end in measure.ends.items()
    }
    back = words.sentences(replace(pair, measures=(replace(measure, ends=ends),)))
    until = words.value_words(ends["impacts"].until, measure.lever.unit)
    assert f"Beyond {until} they come back." in back
    assert words.end_words(replace(measure, ends=ends), "impacts").endswith(f", to {until}")


def test_impacts_without_separation_end_separation(reported: Path) -> None:
    """A tooth that floats up on its film leaves no flank."""
    separate = {word for word, code in VERDICTS.items() if code not in TARGETS["separation"]}
    assert separate == {"separation", "single-sided impacts", "double-sided impacts"}
    answer = solved(reported / "pair.nml", {"load.force_scale": 0.15})
    summary = package.run(reported / "pair.nml", set={"load.force_scale": 0.15}).summary
    assert (answer.verdict in TARGETS["separation"]) == (not summary["separation"])


def test_words_of_values() -> None:
    assert [
        words.value_words(*one) for one in ((2.5e-5, "m"), (0.016, "m"), (1.7e-3, "kg m2"), (0.0, "m"))
    ] == [
        "25 um",
        "16 mm",
        "1700 kg mm2",
        "0 m",
    ]
    assert words.verdict_word(UNKNOWN) == "no end reached"
    assert words.gain_words(0.2, 0.5) == "none, +- 0.5" and words.gain_words(-0.01, 0.0) == "0.0"


def test_page_names_every_key_that_is_changed(repository: Path) -> None:
    page = (repository / "input" / "COUNTERMEASURES.md").read_text()
    for kind in KINDS:
        group = kind.key.partition(".")[0]
        words = {"gear": f"`{kind.key}`", "oil": kind.name, "contact": "`&contact`"}
        assert words.get(group, f"`&{group}`") in page, kind.key


@pytest.mark.long
def test_commands_of_the_page(rattle: Path, repository: Path, tmp_path: Path) -> None:
    """From a folder that is as the repository; they leave what the page says."""
    page = (repository / "input" / "COUNTERMEASURES.md").read_text()
    ended = call(shell(page), tmp_path, rattle, repository)
    assert ended.returncode == 0, ended.stderr
    left = {path.name for path in (tmp_path / "results").iterdir()}
    assert {"rattling_gear.countermeasures.md", "rattling_gear.together.csv"} <= left
    assert "What would stop it" in (tmp_path / "rattling_gear.html").read_text()
    (pair,) = table.read(tmp_path / "results" / "rattling_gear.countermeasures.csv")
    ends = {measure.lever.name: measure.ends for measure in pair.measures}
    # The numbers of the page.
    assert words.value_words(ends["backlash"]["impacts"].value, "m") == "31.7 um"
    assert round(ends["oil temperature"]["impacts"].value) == 26
    order = ends["acceleration of order 2"]["double-sided impacts"]
    assert (round(order.value), round(order.until)) == (356, 262)
    assert [name for name, found in ends.items() if "separation" in found] == ["all that shakes"]
    assert round(100.0 * ends["all that shakes"]["separation"].value) == 13


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "has no variant"),
        ("variant,cost\na,1\n", "needs variant and keys"),
        ("name,gear.backlash\na,1e-5\n", "needs variant and keys"),
        ("variant,gear.backlash\na,thick\n", "line 2: gear.backlash: 'thick' is not a number"),
        ("variant,gear.backlash\na\n", "line 2: 1 value for 2 columns"),
        ("variant,gear.backlash\na,\n", "changes something"),
        ("variant,gear.backlash\na,1e-5\na,2e-5\n", "a name of its own"),
        ("variant,gear.drag_torque\na,*0.5\n", "no value in pair"),
        ("variant,cost,gear.backlash\na,dear,1e-5\n", "cost: 'dear' is not a number"),
        ("variant,gear.bakclash\na,1e-5\n", "unknown key"),
        ("variant,gear.backlash\na,-1e-5\n", "backlash"),
    ],
)
def test_bad_lists_of_variants_are_refused(text: str, complaint: str, tmp_path: Path) -> None:
    (tmp_path / "pair.nml").write_text(INPUT)
    (tmp_path / "list.csv").write_text(text)
    arguments = ("pair.nml", "--keys", "gear.face_width", "--variants", "list.csv", "--output", "o")
    code, _, complained = called_here("countermeasures.py", *arguments, cwd=tmp_path)
    assert code == 2 and complaint in complained and not (tmp_path / "o").exists()


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (("missing.nml",), "missing.nml"),
        (("film.nml",), "no motion to stop"),
        (("bad.nml",), "nearest known key"),
        (("pair.nml", "--keys", "gear.teeth_1"), "gear.teeth_1 is not one of the changes"),
        (("pair.nml", "--range", "gear.backlash=1e-4"), "is not GROUP.KEY=FIRST:LAST"),
        (("pair.nml", "--range", "gear.backlash=2:1"), "from a smaller to a larger"),
        (("pair.nml", "--range", "gear.backlash=1e-5:2e-5"), "lies outside"),
        (("pair.nml", "--range", "gear.mass=1:2"), "gear.mass is not one of the changes"),
        (("pair.nml", *("--range", "gear.backlash=1e-5:2e-4") * 2), "gives a key twice"),
        (("pair.nml", "--output", "full"), "exists; --overwrite replaces it"),
    ],
)
def test_bad_requests_are_refused(arguments, complaint: str, repository: Path, tmp_path: Path) -> None:
    (tmp_path / "pair.nml").write_text(INPUT)
    (tmp_path / "bad.nml").write_text(INPUT.replace("backlash", "bakclash"))
    shutil.copy(repository / "input" / "film.nml", tmp_path)
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "pair.countermeasures.csv").write_text("mine")
    code, _, complained = called_here("countermeasures.py", *arguments, cwd=tmp_path)
    assert code == 2 and complaint in complained and "Traceback" not in complained
