"""Pages of report.py say what results and summaries say, and nothing else."""

from __future__ import annotations

import math
import re
from pathlib import Path

import campaign_runs
import numpy as np
import pytest
from outcomes import series_in
from report_reader import figures, input_of, number, read_page
from reported import SPOKEN, stated_error
from result_writer import write_motion, write_result
from script_calls import call_script, called_here

import rattle
from rattle import codes
from rattle.keys import key_table
from rattle.report import page as page_parts
from rattle.report import report as page_on
from rattle.report.limits import read_limits

CALM = {"steps_per_period": None, "method": None, "periods": "60", "accuracy": "1e-6", "until": "'steady'"}
LOOSE = {"steps_per_period": "20", "periods": "20"}


def report(*results: Path) -> Path:
    """Write the page beside the first result."""
    output = results[0].with_suffix(".html")
    output.write_text(page_on(results), encoding="utf-8")
    return output


def with_summary(result: Path, **changes: object) -> None:
    """Change keys of the summary beside a result as another program would; None leaves a key out."""
    path = result.with_suffix(".summary.nml")
    text = path.read_text().partition("! checksum")[0]
    for key, value in changes.items():
        text = re.sub(rf"^   {key} = .*\n", "", text, flags=re.MULTILINE)
        if value is not None:
            text = text.replace("&summary\n", f"&summary\n   {key} = {value}\n", 1)
    path.write_text(text)


@pytest.fixture
def motion(solved) -> Path:
    """A verified motion by the default method."""
    return solved("calm", solver=CALM) / "calm.rattle"


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pages without their pictures, for tests of words."""
    monkeypatch.setattr(page_parts, "drawing", lambda *_: "<figure><svg></svg></figure>")


@pytest.mark.usefixtures("undrawn")
def test_every_number_of_the_summary_stands_on_the_page_as_it_is(motion):
    page, summary = read_page(report(motion)), rattle.read_summary(motion.with_suffix(".summary.nml"))
    held = [float(digits) for digits, _ in page.numbers]
    reported = [name for name in summary if name in codes.QUANTITIES and not isinstance(summary[name], list)]
    assert len(reported) > 30
    for name in reported:
        value, shown = summary[name], page.shown(name)
        if name.endswith("_error"):
            value = stated_error(value, summary.get(name.removesuffix("_error"), 1.0), 6)
        if isinstance(value, bool):
            assert shown == ("yes" if value else "no"), name
        elif isinstance(value, str):
            assert shown == value, name
        else:
            assert value in held, name
            assert number(shown) == pytest.approx(value, rel=1e-5), name
    for line, error in zip(summary["harmonics"][:12], summary["harmonic_errors"][:12], strict=True):
        assert line in held and stated_error(error, line, 6) in held


@pytest.mark.usefixtures("undrawn")
def test_all_numbers_are_shown_as_their_digits_say(motion):
    page = read_page(report(motion))
    assert len(page.numbers) > 80
    for digits, shown in page.numbers:
        # Errors have two digits, what everybody should see four, all else six.
        rounded = [float(f"{float(digits):.{count}g}") for count in (2, 4, 6)]
        # Checksums are shown as they are.
        known = shown == digits or any(number(shown) == pytest.approx(value, rel=1e-9) for value in rounded)
        assert known, (digits, shown)


@pytest.mark.usefixtures("undrawn")
def test_every_input_stands_there_with_unit_and_meaning(motion):
    page, result = read_page(report(motion)), rattle.read(motion)
    for group, keys in result.input.items():
        assert [f"&{group}"] in page.rows
        for name, value in keys.items():
            rows = [row for row in page.rows if len(row) == 3 and row[0] == name]
            key = key_table()[group, name]
            meanings = [row[2] for row in rows]
            meaning = key.meaning.replace("`", "")
            assert meaning in meanings, (group, name)
            if isinstance(value, float) and key.unit in ("kg", "N", "Hz", "Pa s"):
                assert f"{value:g}\xa0{key.unit}" in [row[1] for row in rows]


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("verification", ("verified", "uncertain", None))
def test_verified_stands_there_exactly_if_the_summary_says_so(motion, verification):
    text = "'The reason of this test.'"
    with_summary(
        motion,
        verification=verification and f"'{verification}'",
        verification_text=verification and text,
        verdict_verified=None,
    )
    page = read_page(report(motion))
    badge = {"verified": "numerically verified", None: "not examined"}.get(verification, verification)
    assert page.badges == ["not examined", badge]
    assert ("The reason of this test." in page.seen) == (verification is not None)
    assert ("verified" in page.verdicts[0]) == (verification == "verified")
    assert ("not solved a second time" in page.seen) == (verification is None)


@pytest.mark.usefixtures("undrawn")
def test_a_scene_that_was_not_verified_is_not_called_so(solved):
    result = solved("plain", spectrum={"verify": ".false."}) / "plain.rattle"
    page = read_page(report(result))
    assert page.badges == ["not examined", "not examined"]


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(
    ("flag", "word"), ((".true.", "numerically verified"), (".false.", "uncertain"), (None, "not examined"))
)
def test_the_verdict_comes_first_with_its_own_verification(motion, flag, word):
    with_summary(motion, verdict="'single-sided impacts'", verdict_verified=flag, verification="'verified'")
    page = read_page(report(motion))
    assert page.verdicts[0].split("\n")[1].startswith(f"single-sided impacts{word}")
    assert page.badges == [word, "numerically verified"]


def test_of_what_is_seen_first_there_are_two_pictures_and_few_numbers(motion):
    """All else stands behind folds, which print as an appendix."""
    text = report(motion).read_text()
    seen, _, rest = text.partition('<section class="appendix">')
    assert seen.count("<svg") == 2 and "<svg" not in rest
    assert 8 <= seen.count("data-value") <= 15 and "<details>" not in seen
    assert seen.index('<div class="verdict') < seen.index("<svg") < seen.index("data-value")
    assert rest.count("<details>") == rest.count("</details>") == 5
    assert ".appendix { break-before: page;" in text


def words_before_the_first_figure(path: Path) -> list[str]:
    """Headings included, styles not."""
    text = path.read_text().partition("<body")[2].partition("<svg")[0]
    return re.sub(r"<[^>]*>", " ", text.partition(">")[2]).split()


def test_few_words_stand_before_the_first_figure_the_operating_point_first(motion, run, repository, tmp_path):
    scene = repository / "input" / "gearbox.nml"
    assert run(scene, "--output", tmp_path, cwd=tmp_path).returncode == 0
    pairs = sorted(path for path in tmp_path.glob("gearbox.*.rattle") if "motions" not in path.name)
    assert len(pairs) == 4
    oil = "oil 60 \N{DEGREE SIGN}C (58 and 9.6 mm\N{SUPERSCRIPT TWO}/s at 40 and 100 \N{DEGREE SIGN}C)"
    for results, first in (
        (
            [motion],
            "Steady force 199.2 N, amplitude 205.7 N at 600 Hz, oil of 0.3 Pa s, drawn in at 1.905 m/s.",
        ),
        (pairs[:1], f"At 800 1/min, {oil}, 1st 11/38 teeth."),
        (pairs, f"At 800 1/min, {oil}, 1st 11/38, 2nd 19/37, 3rd 27/35, 4th 33/32 teeth."),
    ):
        path = report(*results)
        assert len(words_before_the_first_figure(path)) <= 60
        assert read_page(path).paragraphs[0] == first
    page = read_page(path)
    box = rattle.read_summary(tmp_path / "gearbox.summary.nml")
    sums = [f"{box[f'film_force_rms_{how}']:.3g} N" for how in ("uncorrelated", "in_phase")]
    words = f"The four pairs together load the bearings with {sums[0]} rms if their forces are independent, "
    assert f"{words}{sums[1]} in phase." in page.verdicts[0]
    assert "4 of 4 gear pairs have impacts" in page.verdicts[0] and page.badges[0] == "numerically verified"
    heads, *rows = next(table for table in page.tables if table[0][0] == "Pair")
    assert heads[1:3] == ["Verdict", "Film force, rms"]
    forces = {gear: one["film_force_rms"] for gear, one in box["gears"].items()}
    assert [row[0] for row in rows] == sorted(forces, key=forces.get, reverse=True)
    for row in rows:
        reported = rattle.read_summary(tmp_path / f"gearbox.{row[0]}.summary.nml")
        assert row[1] == reported["verdict"]
        assert number(row[2]) == pytest.approx(reported["film_force_rms"], rel=1e-3)
        counts = [reported[f"impacts_per_period_{flank}"] for flank in ("drive", "coast")]
        assert row[3] == " / ".join(f"{count:g}" for count in counts)
        fastest = max(reported[f"impact_velocity_maximum_{flank}"] for flank in ("drive", "coast"))
        assert number(row[4]) == pytest.approx(fastest, rel=1e-2)
        assert number(row[5]) == pytest.approx(reported["inertia_ratio"], rel=1e-3)
        assert row[6].startswith("numerically verified")
        assert ("2 motions" in row[6]) == (reported["motions"] == 2)


@pytest.mark.usefixtures("undrawn")
def test_limits_are_held_against_the_forces(run, repository, tmp_path):
    scene = repository / "input" / "gearbox.nml"
    assert run(scene, "--output", tmp_path, cwd=tmp_path).returncode == 0
    results = sorted(path for path in tmp_path.glob("gearbox.*.rattle") if "motions" not in path.name)
    read = {
        path.name.split(".")[1]: rattle.read_summary(path.with_suffix(".summary.nml")) for path in results
    }
    limits = tmp_path / "limits.csv"
    forces = {gear: one["film_force_rms"] for gear, one in read.items()}
    limits.write_text(f"gear,film_force_rms\n1st,{0.9 * forces['1st']}\n2nd,{1.1 * forces['2nd']}\n")
    output = tmp_path / "page.html"
    done = call_script("report.py", *results, "--limits", limits, "--output", output)
    assert done.returncode == 0, done.stderr
    page = read_page(output)
    assert "Above the limit: 1st." in page.verdicts[0]
    heads, *rows = next(table for table in page.tables if table[0][0] == "Pair")
    assert heads[3:5] == ["Limit", "Over limit"]
    shown, over = ({row[0]: row[place] for row in rows} for place in (3, 4))
    assert over == {"1st": "+0.9 dB", "2nd": "-0.8 dB", "3rd": "-", "4th": "-"}
    assert number(shown["1st"]) == pytest.approx(0.9 * forces["1st"], rel=1e-3)
    assert shown["3rd"] == shown["4th"] == "-"
    assert set(read_limits(repository / "input" / "gearbox_limits.csv")) == set(forces)
    one = page_on(results[1:2], limits={"2nd": 1.1 * forces["2nd"]})
    ready = ("--limits", repository / "input" / "gearbox_limits.csv", "--output", tmp_path / "one.html")
    done = call_script("report.py", results[1], *ready)
    assert done.returncode == 0 and "pairs that are not here: 1st, 3rd, 4th." in done.stderr
    assert f"within its limit of {1.1 * forces['2nd']:.4g} N" in one
    for text, words in (
        ("gear,force\n1st,3\n", "the head has to be gear,film_force_rms"),
        ("gear,film_force_rms\n1st,loud\n", ":2: a name and a number"),
        ("gear,film_force_rms\n1st,3\n1st,-4\n", ":3: a limit is a positive number"),
        ("gear,film_force_rms\npair,3\n", "has limits of pair; the motions are of 1st, 2nd, 3rd, 4th."),
    ):
        limits.write_text(text)
        done = call_script("report.py", *results, "--limits", limits, "--output", output, "--overwrite")
        assert done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1


@pytest.mark.usefixtures("undrawn")
def test_forces_are_levels_against_a_reference(run, tmp_path):
    """Of a gearbox pair by pair and together, of one pair in its verdict; within errors there is none."""
    pair = "teeth_1 = 11, teeth_2 = 38, normal_module = 2.5e-3, helix_angle_deg = 28.96, face_width = 0.016"
    pair += ", loose_inertia = 1.715e-3, backlash = 1.0e-4, tooth_stiffness = 0.0"
    box = "".join(f"&gear name = '{name}', {pair}, drag_torque = 0.1 /\n" for name in ("low", "high"))
    box += "&shaft speed_rpm = 800.0, orders = 2.0, accelerations = 600.0 /\n&spectrum periods = 4 /\n"
    box += "&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 40.0 /\n"
    box += "&film law = 'iso-viscous', model = 'reynolds' /\n&solver periods = 60 /\n"
    (tmp_path / "box.nml").write_text(box)
    for folder, low in (("a", 1.0e-4), ("b", 0.6e-4)):
        ended = run("--output", folder, "--set", f"gear(1).backlash={low}", "box.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
    forces = {
        folder: {
            name: rattle.read_summary(tmp_path / folder / f"box.{name}.summary.nml")["film_force_rms"]
            for name in ("low", "high")
        }
        for folder in "ab"
    }
    level = f"{20.0 * math.log10(forces['a']['low'] / forces['b']['low']):+.1f} dB"
    assert level not in ("+0.0 dB", "-0.0 dB")
    sums = [rattle.read_summary(tmp_path / one / "box.summary.nml") for one in "ab"]
    ratio = sums[0]["film_force_rms_uncorrelated"] / sums[1]["film_force_rms_uncorrelated"]
    results = [f"a/box.{name}.rattle" for name in ("low", "high")]
    arguments = ("--reference", "box A=b/box.summary.nml", "--output", "page.html")
    code, _, complained = called_here("report.py", *results, *arguments, cwd=tmp_path)
    assert code == 0, complained
    page = read_page(tmp_path / "page.html")
    heads, *rows = next(table for table in page.tables if table[0][0] == "Pair")
    shown = {row[0]: row[heads.index("re box A")] for row in rows}
    assert shown == {"low": level, "high": "0 dB within the errors"}
    assert f"Independent forces: {20.0 * math.log10(ratio):+.1f} dB re box A." in page.verdicts[0]
    arguments = ("--reference", "b/box.low.rattle", "--output", "one.html")
    assert called_here("report.py", results[0], *arguments, cwd=tmp_path)[0] == 0
    assert f"N rms, {level} re box.low." in read_page(tmp_path / "one.html").verdicts[0]
    assert called_here("report.py", *results, "--output", "bare.html", cwd=tmp_path)[0] == 0
    assert " re box" not in (tmp_path / "bare.html").read_text()


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("word", codes.CLASSES.values())
def test_the_class_is_the_one_of_the_summary(motion, word):
    with_summary(motion, rattle_class=f"'{word}'", harmonic_count="17", orbit_period="3")
    page = read_page(report(motion))
    assert f"Class: {SPOKEN.get(word, word)}" in page.verdicts[0]
    verdict = page.seen.replace("Idle", "idle").replace("Subh", "subh").replace("Irreg", "irreg")
    verdict = verdict.replace("Quiet", "quiet").replace("Creep", "creep")
    named = {"quiet": "quiet by its sound", "creep": "creep rattle by its sound"}
    named |= {"idle": "idle rattle by its sound", "irregular": "irregular rattle by its sound"}
    named |= {
        "subharmonic": "subharmonic rattle by its sound",
        "irregular_so_far": "irregular so far by its sound",
    }
    assert [known for known, words in named.items() if words in verdict] == [word]
    assert ("17 harmonics" in verdict) == (word in ("creep", "idle"))
    assert ("after 3 periods" in verdict) == (word == "subharmonic")


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("regime", ("unknown", "iso-viscous", "piezo-viscous", "elastohydrodynamic"))
@pytest.mark.parametrize("contradicted", (True, False))
def test_regime_and_law_are_reported_as_the_summary_has_them(motion, regime, contradicted):
    with_summary(motion, film_regime=f"'{regime}'", law_contradicted=f".{contradicted}.".lower())
    verdict = read_page(report(motion)).seen
    found = re.findall(r"\((\S+) regime\)", verdict)
    assert found == ([] if regime == "unknown" else [regime])
    assert ("is not the one of that regime" in verdict) == contradicted


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(
    ("key", "value", "words"),
    (
        ("model_limit", "'too_narrow'", "falls below 1 nm"),
        ("model_limit", "'too_wide'", "beyond a tenth of the radius"),
        ("sampling_sufficient", ".false.", "too few samples"),
        ("orbit_stability", "'unstable'", "unstable"),
        ("status", "'film_lost'", "did not reach its end"),
        ("harmonic_count_is_bound", ".true.", "at least"),
        ("stiffness_matters", ".true.", "rigid, which is no fair assumption: steel ones would deflect by"),
        ("stiffness_matters", ".false.", "rigid, which is a fair assumption: steel ones would deflect by"),
        ("verdict", "'double-sided impacts'", "hits both flanks"),
        ("verdict", "'single-sided impacts'", "hits one flank"),
        ("verdict", "'separation'", "leaves its drive flank, without an impact"),
        ("verdict", "'no separation'", "stays on its drive flank"),
        ("double_sided", ".true.", "crosses its gap"),
    ),
)
def test_what_must_be_known_beside_the_class_is_reported_only_where_it_is_so(motion, key, value, words):
    with_summary(motion, rattle_class="'idle'", stiffness_matters=None, double_sided=None, verdict=None)
    assert words not in read_page(report(motion)).seen
    with_summary(motion, **{key: value})
    assert words in read_page(report(motion)).seen


@pytest.mark.usefixtures("undrawn")
def test_without_a_summary_there_is_no_verdict(motion):
    motion.with_suffix(".summary.nml").unlink()
    page = read_page(report(motion))
    assert page.verdicts[0].strip().startswith("No verdict")
    assert page.badges == []


def test_the_page_stands_alone(motion):
    text = report(motion).read_text()
    targets = re.findall(r'\b(?:src|href|xlink:href)="([^"]*)"', text)
    assert all(target.startswith(("#", "data:")) for target in targets)
    outside = re.findall(r"url\(([^)]*)\)", text)
    assert all(target.startswith("#") for target in outside)
    assert not re.search(r"<(script|link|iframe|img)\b|@import", text)


def test_figures_are_drawings_whose_parts_are_all_there(motion):
    drawn = figures(report(motion))
    assert len(drawn) == 2
    for svg in drawn:
        ids = re.findall(r'\bid="([^"]+)"', svg)
        assert len(ids) == len(set(ids))
        used = re.findall(r'href="#([^"]+)"', svg) + re.findall(r"url\(#([^)]+)\)", svg)
        assert used and set(used) <= set(ids)
        assert 'role="img"' in svg and "viewBox" in svg


@pytest.mark.long
def test_same_results_give_the_same_page(motion):
    first = report(motion)
    other = motion.with_name("other.html")
    done = call_script("report.py", motion, "--output", other, TZ="Asia/Tokyo")
    assert (done.returncode, done.stdout, done.stderr) == (0, f"{other}\n", "")
    assert other.read_bytes() == first.read_bytes()


@pytest.mark.usefixtures("undrawn")
def test_the_input_on_the_page_repeats_the_run(motion, run, tmp_path):
    (tmp_path / "again.nml").write_text(input_of(report(motion)))
    ended = run("again.nml", "--output", "again", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    again, first = rattle.read(tmp_path / "again" / "calm.rattle"), rattle.read(motion)
    for name in first.names:
        np.testing.assert_array_equal(again[name], first[name])


@pytest.mark.usefixtures("undrawn")
def test_how_it_was_computed_is_that_of_the_input(solved):
    page = read_page(report(solved("loose", solver=LOOSE) / "loose.rattle"))
    assert page.shown("Method").startswith("Newmark")
    assert page.shown("Steps in a period of the force") == "20"
    page = read_page(report(solved("calm", solver=CALM) / "calm.rattle"))
    assert page.shown("Method").startswith("series")
    assert number(page.shown("Relative accuracy of the film that was aimed at")) == 1e-6


def test_a_sweep_is_cut_where_its_class_changes(tmp_path):
    columns = [
        ("frequency", "Hz"),
        ("direction", "-"),
        ("status", "-"),
        ("film_minimum", "m"),
        ("film_maximum", "m"),
    ]
    columns += [("acceleration_minimum", "m/s2"), ("acceleration_maximum", "m/s2"), ("rattle_class", "-")]
    columns += [("orbit_period", "-"), ("floquet_modulus", "-"), ("harmonic_count", "-")]
    rows = [
        [100.0, 1, 1, 4e-7, 2e-6, -5.0, 30.0, 2, 1, 0.5, 7],
        [200.0, 1, 1, 3e-7, 2e-6, -5.0, 40.0, 2, 1, 0.5, 8],
        [300.0, 1, 1, 2e-7, 2e-6, -5.0, 50.0, 3, 2, 0.5, 30],
        [400.0, 1, 3, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 0],
        [300.0, -1, 1, 2e-7, 2e-6, -5.0, 50.0, 3, 2, 0.5, 30],
        [200.0, -1, 1, 1e-7, 2e-6, -77.0, 40.0, 3, 1, 0.5, 30],
        [100.0, -1, 1, 4e-7, 2e-6, -5.0, 30.2, 2, 1, 0.5, 7],
    ]
    text = "&scene\n name = 'up'\n task = 'sweep'\n/\n&film\n law = 'iso-viscous'\n/\n"
    text += "&sweep\n key = 'frequency'\n/\n"
    page = read_page(report(write_result(tmp_path / "up.rattle", columns, rows, input_text=text)))
    cut = [row[:4] for row in page.rows if row and row[0] in ("up", "down")]
    assert cut == [
        ["up", "creep", "100\xa0Hz to 200\xa0Hz", "2"],
        ["up", "idle", "300\xa0Hz to 300\xa0Hz", "1"],
        ["up", "failed: film_lost", "400\xa0Hz to 400\xa0Hz", "1"],
        ["down", "idle", "300\xa0Hz to 200\xa0Hz", "2"],
        ["down", "creep", "100\xa0Hz to 100\xa0Hz", "1"],
    ]
    extremes = [[number(cell) for cell in row[4:6]] for row in page.rows if row and row[0] == "down"]
    np.testing.assert_allclose(extremes, [[1e-7, 77.0], [4e-7, 30.2]])
    assert "1 failed" in page.verdicts[0]
    words = "The way down differs from the way up at 1 value of the excitation frequency, 200 Hz"
    assert words in page.seen
    assert "at most 2" in page.seen
    assert "no verification" in page.seen


def test_a_sweep_begins_with_verdicts_and_the_largest_film_force(tmp_path):
    """The key falls first: the way there is the way down. Two motions are complete and not steady."""
    columns = [("speed_rpm", "1/min"), ("direction", "-"), ("status", "-"), ("film_minimum", "m")]
    columns += [("film_maximum", "m"), ("acceleration_minimum", "m/s2"), ("acceleration_maximum", "m/s2")]
    columns += [("orbit_period", "-"), ("floquet_modulus", "-"), ("rattle_class", "-"), ("verdict", "-")]
    columns += [("film_force_rms", "N")]
    ways = [(900, 1, 1, 3, 9), (800, 1, 0, 3, 12), (700, 1, 1, 1, 4)]
    ways += [(800, -1, 0, 3, 11), (900, -1, 3, 0, 99)]
    rows = [
        [speed, way, status, 4e-7, 2e-6, -5.0, 30.0, 1, 0.5, 3, verdict, force]
        for speed, way, status, verdict, force in ways
    ]
    text = "&scene\n name = 'fall'\n task = 'sweep'\n/\n&film\n law = 'iso-viscous'\n/\n"
    text += "&sweep\n key = 'speed_rpm'\n/\n"
    page = read_page(report(write_result(tmp_path / "fall.rattle", columns, rows, input_text=text)))
    assert (
        page.verdicts[0]
        .strip()
        .startswith(
            "Double-sided impacts at 800 to 900 1/min; separation at 700 1/min; "
            "largest film force 12 N rms at 800 1/min"
        )
    )
    said = "2 steady, 2 not yet steady when their periods ended, 1 failed."
    assert f"along the shaft speed, from 700 to 900 1/min, each from the one before: {said}" in page.seen
    assert {row[0] for row in page.rows if row and row[0] in ("up", "down")} == {"up", "down"}
    assert [row[2] for row in page.rows if row and row[0] == "down"] == ["900\xa01/min to 700\xa01/min"]
    assert "at a shaft speed of" in page.seen


@pytest.mark.parametrize("record", ("'rattle_class', 'acceleration_maximum', 'film_minimum'", "+verified"))
def test_a_campaign_is_counted(run, scene_text, tmp_path, record):
    with_verifications = record == "+verified"
    if with_verifications:
        record = "'rattle_class', 'verified', 'acceleration_maximum'"
    (tmp_path / "scene.nml").write_text(campaign_runs.grid(scene_text, 5, 4, campaign={"record": record}))
    path = campaign_runs.solve(run, tmp_path)
    page, campaign = read_page(report(path)), rattle.read_campaign(path)
    assert "All 20 scenes are solved." in page.verdicts[0]
    assert "20 of 20 scenes are solved; 0 of them failed." in page.seen
    for code, word in codes.CLASSES.items():
        count = int((campaign["rattle_class"] == code).sum())
        assert (f"{SPOKEN.get(word, word)} in {count} (" in page.seen) == (count > 0)
    if with_verifications:
        verified = int((campaign["verified"] == 1.0).sum())
        assert f"verified in {verified} scenes" in page.seen
        are = "is" if verified == 19 else "are"
        assert f"{20 - verified} of 20 scenes {are} not verified." in page.seen
    else:
        assert "was not recorded" in page.seen
        assert "verified" not in page.seen
    peaks = np.sort(campaign["acceleration_maximum"])[::-1]
    numbers = [float(digits) for digits, _ in page.numbers]
    assert all(peak in numbers for peak in peaks[:10])
    assert peaks[11] not in numbers
    assert float(np.median(peaks)) in numbers
    assert len(figures(path.with_suffix(".html"))) == 3


def test_a_campaign_that_is_not_finished_says_so(run, scene_text, tmp_path):
    (tmp_path / "scene.nml").write_text(campaign_runs.grid(scene_text, 3, 3))
    path = campaign_runs.solve(run, tmp_path)
    part = path.read_bytes()
    path.write_bytes(part[:24] + b"\xff" * 8 + part[32:])
    path.with_suffix(".summary.nml").unlink()  # which a run writes at its end
    assert "was not finished" in read_page(report(path)).words


@pytest.mark.long
def test_a_film_task_has_its_figures_and_ranges(run, repository, tmp_path):
    ended = run("--output", tmp_path, repository / "input" / "film.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    output = report(tmp_path / "film.rattle")
    page, result = read_page(output), rattle.read(tmp_path / "film.rattle")
    assert len(figures(output)) == 4
    numbers = [float(digits) for digits, _ in page.numbers]
    for name in ("load_published", "stiffness_iso_viscous"):
        assert float(result[name].min()) in numbers and float(result[name].max()) in numbers
    assert not any(row[:1] == ["Method"] for row in page.rows)


def test_several_results_share_a_page(motion, solved):
    other = solved("loose", solver=LOOSE) / "loose.rattle"
    page = read_page(report(motion, other))
    assert page.headings[0] == "Rattle of 2 results"
    assert [anchor for anchor in page.anchors if anchor] == ["result-1", "result-2"]
    assert len(page.badges) == 4
    assert len(page.verdicts) == 3  # the first is on what differs
    assert ["", "calm", "loose"] in page.rows


def test_a_motion_without_the_columns_of_a_figure_says_so(tmp_path):
    path = write_motion(tmp_path / "bare.rattle", lines={1.0: 2.0}, without="acceleration")
    output = report(path)
    assert "No figure here" in read_page(output).words
    assert len(figures(output)) == 1


@pytest.mark.usefixtures("undrawn")
def test_names_cannot_break_the_page(tmp_path):
    path = write_motion(tmp_path / "a.rattle", lines={1.0: 2.0}, name="<b>&amp;x")
    text = report(path).read_text()
    assert "<b>" not in text
    assert "&lt;b&gt;&amp;amp;x" in text


def test_what_is_no_result_is_refused_in_one_sentence(tmp_path):
    (tmp_path / "a.rattle").write_text("nothing")
    done = call_script("report.py", tmp_path / "a.rattle", "--output", tmp_path / "a.html")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1 and "is not a rattle result file" in done.stderr
    assert not (tmp_path / "a.html").exists()


def test_a_result_is_never_replaced_by_its_page(motion):
    before = motion.read_bytes()
    for options in (("--output", motion), ("--output", motion.with_suffix(".html"), "--pdf", motion)):
        done = call_script("report.py", motion, *options)
        assert done.returncode == 2 and "is a result itself" in done.stderr
    assert motion.read_bytes() == before


def test_without_a_browser_the_page_is_there_and_the_pdf_is_not(motion, tmp_path):
    pdf, output = tmp_path / "a.pdf", tmp_path / "a.html"
    done = call_script("report.py", motion, "--output", output, "--pdf", pdf, PATH=str(tmp_path))
    assert done.returncode == 2
    assert output.exists() and not pdf.exists()
    assert done.stderr.count("\n") == 1 and "no browser" in done.stderr


def test_folds_are_open_in_print(motion, tmp_path):
    """A browser of this test keeps the page that it is given."""
    browser = tmp_path / "chromium"
    browser.write_text(f"""#!/bin/sh
for word; do case "$word" in
  file://*) cp "${{word#file://}}" {tmp_path}/given.html;;
  --print-to-pdf=*) echo %PDF > "${{word#*=}}";;
esac; done
""")
    browser.chmod(0o755)
    output, pdf = tmp_path / "a.html", tmp_path / "a.pdf"
    done = call_script(
        "report.py", motion, "--output", output, "--pdf", pdf, PATH=f"{tmp_path}:/usr/bin:/bin"
    )
    assert done.returncode == 0 and pdf.exists(), done.stderr
    given = (tmp_path / "given.html").read_text()
    assert given == output.read_text().replace("<details>", "<details open>") != output.read_text()


def test_a_browser_that_fails_is_named(motion, tmp_path):
    browser = tmp_path / "chromium"
    browser.write_text("#!/bin/sh\necho 'no display today' >&2\nexit 3\n")
    browser.chmod(0o755)
    output = tmp_path / "a.html"
    done = call_script(
        "report.py", motion, "--output", output, "--pdf", tmp_path / "a.pdf", PATH=f"{tmp_path}:/bin"
    )
    assert done.returncode == 2
    assert "chromium failed (no display today)" in done.stderr


def test_lines_are_engine_orders_where_there_is_a_shaft(repository, run, tmp_path):
    """The base frequency of an engine with half orders is half a revolution."""
    scene = repository / "input" / "engine_cycle.nml"
    assert run(scene, "--output", tmp_path, cwd=tmp_path).returncode == 0
    path = tmp_path / "engine_cycle.rattle"
    page, summary = read_page(report(path)), rattle.read_summary(path.with_suffix(".summary.nml"))
    start = page.rows.index(["Harmonic", "Engine order", "Amplitude", "Error at most"]) + 1
    for place, row in enumerate(page.rows[start : start + 12]):
        number_of_line = place + 1
        assert row[0] == str(number_of_line)
        assert float(row[1]) == pytest.approx(number_of_line * summary["frequency"] / (800.0 / 60.0))
        assert float(row[1]) == number_of_line / 2
        assert number(row[2]) == pytest.approx(summary["harmonics"][place], rel=1e-5)
    assert "over engine orders, multiples of the speed of the shaft" in page.words


def test_lines_are_harmonics_where_there_is_no_shaft(motion):
    page = read_page(report(motion))
    assert ["Harmonic", "Amplitude", "Error at most"] in page.rows
    assert "engine order" not in page.words


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(
    ("share", "matters", "rigid", "elastic"),
    (
        (
            9.1997,
            True,
            "rigid, which is no fair assumption: steel ones would deflect by 9.2 times the thickness of the "
            "film.",
            "The teeth deflect by 9.2 times the thickness of the film, which this scene takes into account; "
            "rigid ones would be no fair assumption.",
        ),
        (
            0.0123,
            False,
            "rigid, which is a fair assumption: steel ones would deflect by 1.2 % of the film.",
            "The teeth deflect by 1.2 % of the film; rigid ones would be a fair assumption as well.",
        ),
    ),
)
def test_of_rigid_and_of_elastic_teeth_is_reported_what_is_so(solved, share, matters, rigid, elastic):
    reported = {"deflection_share": share, "stiffness_matters": f".{matters}.".lower()}
    hard = next(solved("hard", solver=CALM).glob("*.rattle"))
    (soft,) = series_in(solved("soft", solver=CALM, contact={"stiffness": "1e9"}))
    for path, words, others in ((hard, rigid, elastic), (soft, elastic, rigid)):
        with_summary(path, **reported)
        said = " ".join(read_page(report(path)).seen.split())
        assert words in said and others not in said
