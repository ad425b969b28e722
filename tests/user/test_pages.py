"""Every number of a report is that of a quantity of its summary or rows, with its unit; unknown ones fail."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import campaign_writer
import numpy as np
import pytest
from report_reader import FACTORS, Page, number, read_page
from reported import SPOKEN, stated_error
from test_report import CALM, report, with_summary

import rattle
from rattle import codes
from rattle.keys import key_table
from rattle.report import motion, page
from rattle.summary import comparison_table

Reported = Mapping[str, Any]
Rows = Sequence[list[str]]
SCALED = {"\N{MICRO SIGN}m": "m", "nm": "m", "mm/s": "m/s", "ms": "s", "MPa": "Pa", "GPa": "Pa", "mJ": "J"}
WITHOUT = {"-": "", "of key": ""}
PLAIN = {"m/s\N{SUPERSCRIPT TWO}": "m/s2", "rad/s\N{SUPERSCRIPT TWO}": "rad/s2", "\N{DEGREE SIGN}C": "degC"}


def assert_shows(cell: str, value: Any, unit: str = "", digits: int = 6) -> None:
    """A cell shows a value in its own unit or in one that is read more easily, rounded to so many digits."""
    if isinstance(value, bool):
        assert cell == ("yes" if value else "no")
    elif isinstance(value, str):
        assert cell == value.strip()
    elif isinstance(value, list | tuple):
        # The unit stands behind the last one.
        parts = [*cell.partition("\xa0")[0].split(", ")]
        assert len(parts) == len(value)
        for part, one in zip(parts, value, strict=True):
            assert_shows(part, one)
        assert PLAIN.get(behind(cell), behind(cell)) == WITHOUT.get(unit, unit)
    else:
        name = behind(cell)
        assert SCALED.get(name, PLAIN.get(name, name)) == WITHOUT.get(unit, unit), cell
        scaled = float(value) / FACTORS.get(name, 1.0)
        step = 10.0 ** (math.floor(math.log10(abs(scaled))) - digits + 1) if scaled else 0.0
        assert abs(number(cell) - float(value)) <= 0.501 * step * FACTORS.get(name, 1.0), (cell, value)


def behind(cell: str) -> str:
    return cell.partition("\xa0")[2]


def assert_numbers(page: Page, sentences: Sequence[str], silent: Sequence[str] = ()) -> None:
    """Each sentence stands in the text of the page, the silent ones do not; no other number stands there."""
    text = " ".join(" ".join(page.paragraphs).split())
    for words in sorted(sentences, key=len, reverse=True):
        assert words in text, words
        text = text.replace(words, " ", 1)
    for words in silent:
        assert words not in text, words
    assert not re.findall(r"[^.]*\d[^.]*", text)
    for digits, shown in page.numbers:
        rounded = [float(f"{float(digits):.{count}g}") for count in (2, 4, 6)]
        assert any(number(shown) == pytest.approx(value, rel=1e-9) for value in rounded), (digits, shown)


def assert_tables(page: Page, readers: Mapping[tuple[str, ...], Callable[[Rows], None]], heads: list) -> None:
    """The tables are those named, in this order, and each row is that of its reader."""
    assert [tuple(table[0]) for table in page.tables] == heads
    for head, *rows in page.tables:
        readers[tuple(head)](rows)


# --- what all pages have -------------------------------------------------------------------------------

KEYS = ("Key", "Value", "Meaning")
COMPUTED = ("", "")
# What follows from gears, shaft and oil and is no key.
DRAWING = {"base_radius_1": "m", "base_radius_2": "m"}
DRAWING |= {"working_pressure_angle": "deg", "base_helix_angle": "deg"}
DRAWING |= {"profile_shift_sum": "", "contact_ratio": "", "overlap_ratio": ""}
METHODS = {"newmark": "Newmark's method as in the paper, with steps of equal length"}
METHODS["taylor"] = "series in time with controlled errors; the steps follow the motion"


def reader_of_keys(given: Mapping[str, Mapping[str, Any]]) -> Callable[[Rows], None]:
    def read(rows: Rows) -> None:
        expected = []
        for group, keys in given.items():
            expected.append((f"&{group}", None, "", ""))
            for name, value in keys.items():
                if name in DRAWING:
                    expected.append((name, value, DRAWING[name], "Follows from gears, shaft and oil."))
                    continue
                key = key_table()[group.partition("(")[0], name]
                meaning = key.meaning.replace("`", "")
                expected.append((name, value, key.unit, meaning))
        assert [row[0] for row in rows] == [name for name, *_ in expected]
        for row, (name, value, unit, meaning) in zip(rows, expected, strict=True):
            if not name.startswith("&"):
                assert_shows(row[1], value, unit)
                assert row[2] == meaning

    return read


def reader_of_computed(given: Mapping[str, Mapping[str, Any]], summary: Reported) -> Callable[[Rows], None]:
    """How it was computed: settings of the input, and what the summary reports beside quantities."""
    solver = given.get("solver", {})
    known = {
        "Relative accuracy of the film that was aimed at": (solver.get("accuracy"), ""),
        "Tolerance of the iteration on the film": (solver.get("tolerance"), "m"),
        "Steps in a period of the force": (solver.get("steps_per_period"), ""),
        "Film law": (summary.get("law"), ""),
        "Film model: published, the formulas of the paper; reynolds, those of rigid flanks": (
            summary.get("model"),
            "",
        ),
        "Speed that the film was computed with": (summary.get("speed_used"), "m/s"),
        "That speed is": (summary.get("speed_meaning"), ""),
        "Accelerations are": (summary.get("acceleration_meaning"), ""),
        "Time at which the run ended": (summary.get("status_time"), "s"),
        "Film at that time": (summary.get("film_at_status_time"), "m"),
        "Time that the computation took": (summary.get("wall_seconds"), "s"),
        "Harmonics of the force": (summary.get("force_orders"), ""),
        "Version of rattle": (summary.get("program_version", "0.1.0"), ""),
        "Method": (METHODS.get(solver.get("method")), ""),
    }

    def read(rows: Rows) -> None:
        for label, cell in rows:
            name = label.replace(" ", "_")
            unit = next((key.unit for (_, own), key in key_table().items() if own == name), "")
            value, unit = known.get(label, (summary.get(name), unit))
            assert value is not None, label
            assert_shows(cell, value, unit.replace("-", "") if isinstance(value, list) else unit)

    return read


def reader_of_ranges(columns: Mapping[str, np.ndarray], units: Mapping[str, str]) -> Callable[[Rows], None]:
    def read(rows: Rows) -> None:
        meanings = [codes.QUANTITIES[name].meaning if name in codes.QUANTITIES else "" for name in columns]
        assert [row[0] for row in rows] == [
            name + meaning for name, meaning in zip(columns, meanings, strict=True)
        ]
        for row, (name, values) in zip(rows, columns.items(), strict=True):
            known = np.sort(values[np.isfinite(values)])
            if not known.size:
                assert row[1:] == ["-", "-", "-"]
                continue
            middle = 0.5 * (known[(known.size - 1) // 2] + known[known.size // 2])
            for cell, value in zip(row[1:], (known[0], middle, known[-1]), strict=True):
                assert_shows(cell, value, units[name])

    return read


# --- one motion ----------------------------------------------------------------------------------------

NUMBERS = ("In numbers", "")
ERRORS = ("", "Value", "Error at most")
QUANTITIES = ("Quantity", "Value", "Meaning")
LINES = ("Harmonic", "Amplitude", "Error at most")
ORDERS = ("Harmonic", "Engine order", "Amplitude", "Error at most")


def reader_of_errors(summary: Reported) -> Callable[[Rows], None]:
    names = {quantity.meaning.rstrip("."): name for name, quantity in codes.QUANTITIES.items()}

    def read(rows: Rows) -> None:
        wanted = [f"{what}_{end}" for what in ("film", "acceleration") for end in ("minimum", "maximum")]
        assert [names[row[0]] for row in rows] == [name for name in wanted if name in summary]
        for row in rows:
            name = names[row[0]]
            assert_shows(row[1], summary[name], codes.QUANTITIES[name].unit)
            if f"{name}_error" in summary:
                error = stated_error(summary[f"{name}_error"], summary[name], 6)
                assert_shows(row[2], error, codes.QUANTITIES[name].unit)
            else:
                assert row[2] == "not known"

    return read


def reader_of_numbers(summary: Reported) -> Callable[[Rows], None]:
    """Each row is that of a quantity, rounded to four digits, and none stands there twice."""

    def read(rows: Rows) -> None:
        names = {words: name for name, words in motion.NUMBERS.items()}
        shown = [names[row[0]] for row in rows]
        assert shown == [name for name in motion.NUMBERS if name in summary][: page.MOST_NUMBERS]
        for name, row in zip(shown, rows, strict=True):
            assert_shows(row[1], summary[name], codes.QUANTITIES[name].unit, 4)

    return read


def reader_of_quantities(summary: Reported) -> Callable[[Rows], None]:
    def read(rows: Rows) -> None:
        for row in rows:
            value = summary[row[0]]
            if row[0].endswith("_error"):
                value = stated_error(value, summary.get(row[0].removesuffix("_error"), 1.0), 6)
            assert_shows(row[1], value, codes.QUANTITIES[row[0]].unit)
            assert row[2] == codes.QUANTITIES[row[0]].meaning

    return read


def reader_of_lines(summary: Reported, order: float | None) -> Callable[[Rows], None]:
    """`order`: the engine order of the base frequency."""

    def read(rows: Rows) -> None:
        assert len(rows) == min(12, len(summary["harmonics"]))
        for place, row in enumerate(rows):
            assert row[0] == str(place + 1)
            assert_shows(row[-2], summary["harmonics"][place], "m/s2")
            if "harmonic_errors" in summary:
                error = stated_error(summary["harmonic_errors"][place], summary["harmonics"][place], 6)
                assert_shows(row[-1], error, "m/s2")
            if order is not None:
                assert_shows(row[1], order * (place + 1))

    return read


def sentences_on_motion(summary: Reported, given: Mapping[str, Any]) -> tuple[list[str], list[str]]:
    """What the verdict and the notes say with this summary, and what they must not say."""
    limits = given["spectrum"]
    count = summary["harmonic_count"]
    bound = "at least " if summary.get("harmonic_count_is_bound") else ""
    lines = f"{bound}{count} {'harmonic' if count == 1 else 'harmonics'} of the acceleration are above"
    of = "the largest one of the force's own harmonics" if "force_orders" in given["load"] else "the first"
    threshold = f"{100.0 * limits['harmonic_threshold']:g} % of {of}"
    classes = {
        "quiet": f"a harmonic distortion of {summary.get('harmonic_distortion', np.nan):.4g}, below the "
        f"limit of {limits['quiet_limit']:g}.",
        "creep": f"{lines} {threshold}, fewer than the {limits['idle_harmonics']} from which on it is idle "
        "rattle.",
        "idle": f"{lines} {threshold}; {limits['idle_harmonics']} or more make it idle rattle",
        "irregular": f"A share of {summary.get('irregular_fraction', np.nan):.4g} of the power of the "
        f"acceleration lies off the harmonics of the force; {limits['irregular_limit']:g} is the limit.",
        "irregular_so_far": f"A share of {summary.get('irregular_fraction', np.nan):.4g} of the power of the "
        "acceleration lies off the harmonics of the force.",
        "subharmonic": f"but only after {summary.get('orbit_period')} periods of the force.",
    }
    found = [classes[summary["rattle_class"]]]
    silent = [words for name, words in classes.items() if name != summary["rattle_class"]]
    period = summary.get("orbit_period")
    repeats = "every period" if period == 1 else f"every {period} periods"
    if "orbit_stability" in summary:
        found.append(
            "A periodic motion was found, but it is unstable"
            if summary["orbit_stability"] == "unstable"
            else f"it repeats {repeats} of the force ({summary['orbit_stability']})."
        )
    choose(
        found,
        silent,
        "verification" in summary,
        summary.get("verification_text", "No reason."),
        "a second time",
    )
    if summary.get("starts_solved", 1) > 1:
        found.append(f"From other starts: {summary['motions_text']}.")
    if summary["model_limit"] != "within":
        found.append("1 nm" if "narrow" in summary["model_limit"] else "a tenth of the radius")
    share, elastic = summary["deflection_share"], "stiffness" in given["contact"]
    amount = f"{share:.3g} times the thickness of" if share > 1.0 else f"{100.0 * share:.2g} % of"
    would = "deflect" if elastic else "would deflect"
    found.append(f"{would} by {amount} the film")
    choose(found, silent, summary["stiffness_matters"], "no fair assumption", "a fair assumption")
    choose(found, silent, summary["law_contradicted"], "is not the one of that regime", "Never.")
    impacts = {
        "no separation": "The tooth stays on its drive flank",
        "separation": "The tooth leaves its drive flank, without an impact",
        "single-sided impacts": "The tooth hits one flank",
        "double-sided impacts": "The tooth hits both flanks of its gap",
        "impacts without separation": "The tooth floats and falls back on its film, never leaving it",
    }
    for name, words in impacts.items():
        if summary.get("verdict") != name:
            silent.append(words)
    counts = [(summary.get(f"impacts_per_period_{flank}", 0.0), flank) for flank in ("drive", "coast")]
    hits = [f"{count:.3g}{{}} on the {flank} flank" for count, flank in counts if count > 0.0]
    if hits:
        first = next(count for count, _ in counts if count > 0.0)
        hits[0] = hits[0].format(" impact a period" if first == 1.0 else " impacts a period")
        hits = [words.format("") for words in hits]
    first = ": ".join(filter(None, (impacts[summary["verdict"]], ", ".join(hits))))
    found.append(f"{first}; film force on the bearings {summary['film_force_rms']:.3g} N rms.")
    if summary.get("inertia_ratio", 0.0) > 0.0:
        found.append(
            f"Inertia over drag: {summary['inertia_ratio']:.2f}. "
            "Below 1 a tooth stays on its flank, or on the film there"
        )
    regimes = {
        "iso-viscous": "hardly thickens the oil (iso-viscous regime)",
        "piezo-viscous": "thickens the oil, and the flanks keep their shape (piezo-viscous regime)",
        "elastohydrodynamic": "too high for flanks that keep their shape",
    }
    found += [words for name, words in regimes.items() if summary["film_regime"] == name]
    silent += [words for name, words in regimes.items() if summary["film_regime"] != name]
    periods = summary["window_periods"]
    found.append(f"The window is the last {'period' if periods == 1 else f'{periods} periods'} of the force.")
    if len(summary["harmonics"]) > 12:
        found.append(f"The summary lists {len(summary['harmonics'])} of them.")
    return found, silent


def opening(given: Mapping[str, Mapping[str, Any]], ranges: Mapping[str, tuple[float, float]]) -> str:
    """The first line: speed, oil and teeth, or force and oil; ranges of what is varied."""

    def value(group: str, name: str, unit: str) -> str | None:
        if name in ranges:
            return "{:.4g} to {:.4g} {}".format(*ranges[name], unit)
        known = given.get(group, {}).get(name)
        if known is None:
            return None
        return f"{', '.join(f'{one:.4g}' for one in np.atleast_1d(known))} {unit}"

    if "gear" in given:
        oil, teeth = given["oil"], given["gear"]
        name = f"{str(teeth.get('name', '')).strip()} {teeth['teeth_1']}/{teeth['teeth_2']} teeth".strip()
        grade = f"{oil['viscosity_40_cst']:.4g} and {oil['viscosity_100_cst']:.4g} mm\N{SUPERSCRIPT TWO}/s"
        degrees = "\N{DEGREE SIGN}C"
        warmth = f"oil {oil['temperature_celsius']:.4g} {degrees} ({grade} at 40 and 100 {degrees})"
        return f"At {given['shaft']['speed_rpm']:.4g} 1/min, {warmth}, {name}."
    parts = (
        ("steady force", value("load", "steady_force", "N")),
        ("amplitude", value("load", "force_amplitude", "N")),
        ("amplitudes", value("load", "force_amplitudes", "N")),
        ("at", value("load", "frequency", "Hz")),
        ("oil of", value("lubricant", "viscosity", "Pa s")),
        ("drawn in at", value("kinematics", "entrainment_speed", "m/s")),
    )
    line = ", ".join(f"{words} {shown}" for words, shown in parts if shown).replace(", at ", " at ")
    return f"{line[0].upper()}{line[1:]}."


def choose(found: list[str], silent: list[str], is_so: bool, words: str, otherwise: str) -> None:
    """The words that hold are reported, the others are not."""
    (found if is_so else silent).append(words)
    (silent if is_so else found if otherwise != "Never." else []).append(otherwise)


def asked(given: Mapping[str, Mapping[str, Any]], words: str) -> list[str]:
    """The numbers of the sentence on what was asked, each behind its words."""
    found = []
    for group, name, meaning in (
        ("shaft", "speed_rpm", "speed of the shaft"),
        ("oil", "temperature_celsius", "temperature of the oil"),
        ("load", "mass", "mass of the tooth pair"),
        ("load", "steady_force", "steady force"),
        ("load", "force_mean", "mean of the force beside it"),
        ("load", "force_amplitude", "amplitude of the oscillating force"),
        ("load", "force_amplitudes", "amplitudes of the oscillating force"),
        ("load", "frequency", "its frequency"),
        ("lubricant", "viscosity", "viscosity of the oil"),
        ("kinematics", "entrainment_speed", "speed at which the flanks draw oil in"),
        ("contact", "radius", "radius of the contact"),
        ("contact", "length", "its length"),
        ("contact", "backlash", "backlash between the flanks"),
        ("contact", "stiffness", "stiffness of the teeth"),
    ):
        value = given.get(group, {}).get(name)
        if value is None:
            continue
        summary = re.search(rf"(?:^|[;:] ){meaning} ([^;]*?)(?=;|\. |$)", words)
        assert summary, meaning
        values = value if isinstance(value, list) else [value]
        shown = summary[1].split(", ")
        assert len(shown) == len(values)
        for one, other in zip(shown, values, strict=True):
            digits, _, unit = one.partition(" ")
            sign = digits.replace("-", "\N{MINUS SIGN}").replace("e", "\N{MULTIPLICATION SIGN}10")
            assert_shows(f"{sign}\xa0{unit}" if unit else sign, other, key_table()[group, name].unit)
        found.append(f"{meaning} {summary[1]}")
    return found


NUMERICAL = "numerically verified"


def assert_motion(path: Path) -> None:
    page, summary = read_page(report(path)), rattle.read_summary(path.with_suffix(".summary.nml"))
    result = rattle.read(path)
    given = result.input
    shaft = given.get("shaft", {}).get("speed_rpm")
    order = summary["frequency"] / (shaft / 60.0) if shaft else None
    readers = {
        NUMBERS: reader_of_numbers(summary),
        ERRORS: reader_of_errors(summary),
        QUANTITIES: reader_of_quantities(summary),
        LINES: reader_of_lines(summary, None),
        ORDERS: reader_of_lines(summary, order),
        COMPUTED: reader_of_computed(given, summary),
        KEYS: reader_of_keys(given),
    }
    lines = ORDERS if shaft else LINES
    assert_tables(page, readers, [NUMBERS, ERRORS, QUANTITIES, lines, KEYS, COMPUTED])
    # All that the summary reports has a row.
    plain = [name for name in summary if name in codes.QUANTITIES and not isinstance(summary[name], list)]
    assert [row[0] for row in page.tables[2][1:]] == plain
    sentences, silent = sentences_on_motion(summary, given)
    sentences.append(opening(given, {}))
    assert page.paragraphs[0] == sentences[-1]
    repeats = result.orbit_period
    if repeats is None:
        sentences.append(f"over the last {min(4, result.whole_periods)} periods of the force.")
    elif repeats > 1:
        sentences.append(f"over {repeats} periods, after which it repeats.")
    (short,) = (words for words in page.paragraphs if words.endswith("All inputs stand below."))
    sentences += asked(given, short)
    gears = [keys for group, keys in given.items() if group.partition("(")[0] == "gear"]
    for gear in gears:
        name = str(gear.get("name", "gear")).strip()
        sentences.append(
            f"{name} ({gear['teeth_1']} teeth drive {gear['teeth_2']}, module "
            f"{1e3 * gear['normal_module']:g} mm)"
        )
    sentences.append(f"This text, saved as {path.stem}.nml, repeats the run with: rattle {path.stem}.nml")
    sentences.append(f"Save as {path.stem}.nml")
    if summary["film_regime"] == "elastohydrodynamic":
        sentences.append("flatten by more than a tenth of the film")
    odd = np.atleast_1d(summary.get("input_warnings", [])).tolist()
    sentences += [f"{words[:1].upper()}{words[1:]}." for words in odd]
    assert_numbers(page, sentences, silent)
    word = SPOKEN.get(summary["rattle_class"], summary["rattle_class"])
    verified = {True: NUMERICAL, False: "uncertain", None: "not examined"}[summary.get("verdict_verified")]
    of_class = summary.get("verification", "not examined")
    of_class = NUMERICAL if of_class == "verified" else of_class
    assert page.paragraphs[1] == summary["verdict"] + verified
    assert page.paragraphs[2] == f"Class: {word}{of_class}"
    assert page.badges == [verified, of_class]


@pytest.mark.parametrize("name", ("idle", "creep_period_two", "engine_cycle", "loose_gear", "loose_pair"))
def test_the_page_of_a_ready_motion_is_its_summary(run, repository, tmp_path, name):
    assert run(repository / "input" / f"{name}.nml", "--output", tmp_path, cwd=tmp_path).returncode == 0
    assert_motion(tmp_path / f"{name}.rattle")


# Changes of a summary that bring out each sentence.
SAID = (
    {"rattle_class": "'quiet'", "harmonic_distortion": "0.12345", "verdict": "'no separation'"},
    {"rattle_class": "'creep'", "harmonic_count": "1", "harmonic_count_is_bound": ".false."},
    {"rattle_class": "'creep'", "harmonic_count": "17", "harmonic_count_is_bound": ".true."},
    {"rattle_class": "'irregular'", "irregular_fraction": "0.061234"},
    {"rattle_class": "'irregular_so_far'", "irregular_fraction": "0.43217", "verification": "'uncertain'"},
    {"rattle_class": "'subharmonic'", "orbit_period": "3", "orbit_stability": "'near_unstable'"},
    {"orbit_stability": "'unstable'", "model_limit": "'too_narrow'", "film_regime": "'piezo-viscous'"},
    {"model_limit": "'too_wide'", "film_regime": "'elastohydrodynamic'", "law_contradicted": ".true."},
    {"deflection_share": "0.0654", "stiffness_matters": ".false.", "verdict": "'separation'"},
    {"deflection_share": "0.2345", "stiffness_matters": ".true.", "verdict": "'single-sided impacts'"},
    {"verification": None, "verification_text": None, "verdict": "'double-sided impacts'"},
    {"film_minimum": "3.4567891e-9", "film_maximum": "0.00234567", "film_minimum_error": "4.567e-12"},
    {"acceleration_maximum": "1.2345678e7", "acceleration_maximum_error": None},
    {"pressure_maximum": "1.2345678e9", "deflection": "1.23e-11", "dissipated_energy": "2.3456e-5"},
)


@pytest.mark.parametrize("changes", SAID, ids=[", ".join(change) for change in SAID])
def test_every_sentence_on_a_motion_holds_what_its_summary_says(solved, changes):
    path = next(solved("calm", solver=CALM).glob("*.rattle"))
    with_summary(path, **changes)
    assert_motion(path)


# --- a gearbox -----------------------------------------------------------------------------------------

PAIRS = (
    *("Pair", "Verdict", "Film force, rms", "Impacts a period, drive / coast"),
    *("Approach velocity", "Inertia ratio", "How sure"),
)


@pytest.mark.long
def test_the_page_of_a_gearbox_is_its_table(run, repository, tmp_path):
    assert run(repository / "input" / "gearbox.nml", "--output", tmp_path, cwd=tmp_path).returncode == 0
    box = rattle.read_summary(tmp_path / "gearbox.summary.nml")
    paths = [tmp_path / f"gearbox.{gear}.rattle" for gear in box["gears"]]
    # One pair of which little is known, as if it had failed.
    table = (tmp_path / "gearbox.summary.nml").read_text().partition("! checksum")[0]
    first, second = table.index("   gear = '2nd'"), table.index("   gear = '3rd'")
    bare = table[first:second].splitlines()
    kept = [
        line
        for line in bare
        if not re.match(r"   (rattle_class|double_sided|verdict|film_force_rms|film_minimum) ", line)
    ]
    (tmp_path / "gearbox.summary.nml").write_text(table[:first] + "\n".join(kept) + "\n" + table[second:])
    box = rattle.read_summary(tmp_path / "gearbox.summary.nml")
    paths[1].with_suffix(".summary.nml").unlink()
    page = read_page(report(*paths))
    assert page.headings[0] == "Rattle of gearbox"
    head, *rows = next(table for table in page.tables if tuple(table[0]) == PAIRS)
    whole = {
        gear: rattle.read_summary(path.with_suffix(".summary.nml")) if gear != "2nd" else box["gears"][gear]
        for gear, path in zip(box["gears"], paths, strict=True)
    }
    forces = {
        gear: summary["film_force_rms"] for gear, summary in whole.items() if "film_force_rms" in summary
    }
    assert len(forces) == 3
    assert [row[0] for row in rows] == [*sorted(forces, key=forces.get, reverse=True), "2nd"]
    for gear, *row in rows:
        summary = whole[gear]
        if gear == "2nd":
            assert row[:4] == ["-", "-", "- / -", "-"] and row[5].partition(";")[0] == "-"
            continue
        assert row[0] == summary["verdict"]
        assert_shows(row[1], summary["film_force_rms"], "N", 4)
        counts = [summary[f"impacts_per_period_{flank}"] for flank in ("drive", "coast")]
        assert row[2] == " / ".join(f"{count:.3g}" for count in counts)
        speeds = [summary[f"impact_velocity_maximum_{flank}"] for flank in ("drive", "coast")]
        assert_shows(row[3], max(speeds), "m/s", 3)
        assert_shows(row[4], summary["inertia_ratio"], "", 4)
        assert row[5].partition(";")[0] == NUMERICAL
    sums = [box[f"film_force_rms_{how}"] for how in ("uncorrelated", "in_phase")]
    words = f"with {sums[0]:.3g} N rms if their forces are independent, {sums[1]:.3g} N in phase."
    assert any(words in paragraph for paragraph in page.paragraphs)
    paths.pop(1)
    summaries = [rattle.read_summary(path.with_suffix(".summary.nml")) for path in paths]
    assert ["", *(summary["name"] for summary in summaries)] in page.rows
    side = next(table for table in page.tables if table[0][1:] == [summary["name"] for summary in summaries])
    expected = comparison_table(summaries)
    for row in expected:
        row[0] = row[0].replace("[um]", "[\N{MICRO SIGN}m]").replace("/s2]", "/s\N{SUPERSCRIPT TWO}]")
    assert side == expected


# --- a campaign ----------------------------------------------------------------------------------------

VARIED = ("Varied key", "First", "Last", "Scale", "Values")
RANGES = ("Quantity", "Smallest", "Median", "Largest")
CLASSES = ("Class", "Meaning")
CLASSES_SPOKEN = {code: SPOKEN.get(name, name) for code, name in codes.CLASSES.items()}
WORST = ("Scene", "force amplitude", "entrainment speed", "acceleration maximum")
FLAGS = {"model_limit": 3.0, "stiffness_matters": 1.0, "double_sided": 1.0}


def made_campaign(chosen: Sequence[str], *, failures: bool) -> campaign_writer.Made:
    """A grid with some columns, the flags among them set in different scenes and unknown in others."""
    made = campaign_writer.grid(campaign_writer.FORCES, campaign_writer.SPEEDS, failures=failures)
    random = np.random.default_rng(5)
    for place, (name, largest) in enumerate(FLAGS.items()):
        flags = random.integers(0, 2, len(made.rows)) * random.integers(1, int(largest) + 1, len(made.rows))
        flags = np.where(random.random(len(made.rows)) < 0.1 * (1 + place), np.nan, flags)
        made.rows = np.column_stack([made.rows, flags])
        made.columns.append((name, "-"))
    names = [name for name, _ in made.columns]
    kept = [names.index(name) for name in (*names[:3], "status", *chosen)]
    made.columns, made.rows = [made.columns[place] for place in kept], made.rows[:, kept]
    return made


FULL = (
    *("rattle_class", "verified", "law_contradicted", "film_regime", "acceleration_maximum", "film_minimum"),
    *FLAGS,
)


@pytest.mark.parametrize(
    ("chosen", "failures", "undone"),
    (
        (FULL, True, ()),
        (FULL, False, (1, 3)),
        (("rattle_class", "film_regime", "acceleration_maximum"), True, ()),
        (("film_minimum", "film_maximum"), False, ()),
    ),
    ids=("full", "not finished", "regimes", "films"),
)
def test_the_page_of_a_campaign_is_its_rows(tmp_path, chosen, failures, undone):
    made = made_campaign(chosen, failures=failures)
    path = made.write(tmp_path / "map.rattle", undone=undone, closed=not undone)
    page = read_page(report(path))
    done = np.ones(len(made.rows), dtype=bool)
    for chunk in undone:
        done[64 * chunk : 64 * (chunk + 1)] = False
    columns = {name: made.column(name)[done] for name, _ in made.columns}
    failed = ~np.isin(columns["status"], (0.0, 1.0))
    good = {name: values[~failed] for name, values in columns.items()}
    sentences = sentences_on_campaign(columns, int(failed.sum()), len(made.rows), int(done.sum()))
    worst = "acceleration_maximum" in columns
    extra = [name for name in ("rattle_class", "film_regime", "verified") if name in columns]
    head = (*WORST, *(name.replace("_", " ") for name in extra))
    classes = "rattle_class" in columns
    heads = [
        NUMBERS,
        VARIED,
        *([CLASSES] if classes else []),
        *([head] if worst else []),
        RANGES,
        KEYS,
        COMPUTED,
    ]
    summary = rattle.read_campaign(path)
    readers = {
        NUMBERS: lambda rows: assert_numbers_of_campaign(rows, columns, good, dict(made.columns)),
        CLASSES: lambda rows: assert_classes(rows, columns.get("rattle_class")),
        VARIED: assert_varied,
        head: lambda rows: assert_worst(rows, good, extra),
        RANGES: reader_of_ranges(
            {
                name: values
                for name, values in good.items()
                if name in codes.QUANTITIES and codes.words_of(name) is None
            },
            dict(made.columns),
        ),
        COMPUTED: reader_of_computed(summary.input, {}),
        KEYS: reader_of_keys(summary.input),
    }
    assert_tables(page, readers, heads)
    (short,) = (words for words in page.paragraphs if words.endswith("All inputs stand below."))
    sentences += asked({k: v for k, v in summary.input.items() if k != "kinematics"} | {"load": LOAD}, short)
    sentences.append("This text, saved as map.nml, repeats the run with: rattle map.nml")
    sentences.append("Save as map.nml")
    if classes:
        top = page.paragraphs[2 if undone else 1]
        sentences += first_words(columns, done, failed)
        known = columns["rattle_class"][np.isfinite(columns["rattle_class"])]
        words = [CLASSES_SPOKEN[int(code)] for code in known]
        ranked = sorted(dict.fromkeys(words), key=lambda word: -words.count(word))
        listed = ", ".join(ranked)
        assert top == listed[0].upper() + listed[1:]
    else:
        sentences += first_words(columns, done, failed)
    ranges = {"force_amplitude": (20.0, 400.0), "entrainment_speed": (0.5, 5.0)}
    sentences.append(opening(summary.input, ranges))
    assert page.paragraphs[0] == sentences[-1]
    assert_numbers(page, sentences)


def first_words(columns: Mapping[str, np.ndarray], done: np.ndarray, failed: np.ndarray) -> list[str]:
    """What stands in the box above the first figure."""
    if done.all() and not failed.any():
        found = [f"All {done.size} scenes are solved."]
    else:
        found = [f"{done.sum()} of {done.size} scenes are solved; {failed.sum()} of them failed."]
    if "verified" in columns:
        lacking, known = (columns["verified"] == 0.0).sum(), np.isfinite(columns["verified"]).sum()
        found.append(f"{lacking} of {known} classes are not numerically verified.")
    return found


LOAD = {"mass": 3.0, "steady_force": 199.2, "frequency": 600.0}


def share(count: int, of: int) -> str:
    """Per cent, as far as they are not very few."""
    return f"{100.0 * count / of:.1f} %"


def sentences_on_campaign(
    columns: Mapping[str, np.ndarray], failed: int, scenes: int, done: int
) -> list[str]:
    found = [f"{done} of {scenes} scenes are solved; {failed} of them failed."]
    if "rattle_class" in columns:
        known = columns["rattle_class"][np.isfinite(columns["rattle_class"])]
        for code in np.unique(known):
            count = int((known == code).sum())
            found.append(f"{CLASSES_SPOKEN[int(code)]} in {count} ({share(count, done)})")
    else:
        found.append("The class was not recorded.")
    if "verified" in columns:
        verified, lacking = (int((columns["verified"] == flag).sum()) for flag in (1.0, 0.0))
        found.append(
            f"The class is verified in {verified} scenes: solved again, tighter, it is the same, "
            "or both halves of an irregular motion agree."
        )
        found.append(f"{lacking} of {verified + lacking} scenes are not verified.")
    if "law_contradicted" in columns:
        count = int((columns["law_contradicted"] == 1.0).sum())
        found.append(f"In {count} scenes the film law is not the one of the regime that the motion reaches.")
    elif "film_regime" in columns:
        for code in (1, 2, 3):
            count = int((columns["film_regime"] == code).sum())
            found.append(f"{codes.CODES['film_regime'][code]} in {count}")
    for name, words in (
        ("model_limit", "scenes the film leaves the range of the model: below 1 nm, or above a tenth of"),
        ("stiffness_matters", "scenes the teeth deflect, or if they are rigid those of steel would"),
        ("double_sided", "scenes the tooth hits both flanks of its gap."),
    ):
        if name in columns:
            found.append(f"In {int((columns[name] > 0.0).sum())} {words}")
    return found


def assert_numbers_of_campaign(
    rows: Rows, columns: Mapping[str, np.ndarray], good: Mapping[str, np.ndarray], units: Mapping[str, str]
) -> None:
    """How many scenes there are, how often each class is, and the worst of what is recorded."""
    shown, done = dict(rows), len(columns["scene"])
    assert len(rows) == len(shown) <= page.MOST_NUMBERS
    assert shown.pop("Scenes") == str(done)
    assert shown.pop("of these failed") == str(done - len(good["scene"]))
    known = columns.get("rattle_class", np.array([]))
    for code in np.unique(known[np.isfinite(known)]):
        count = int((known == code).sum())
        assert shown.pop(CLASSES_SPOKEN[int(code)].capitalize()) == share(count, done)
    for name, words, end in (
        ("acceleration_maximum", "Largest acceleration", np.nanmax),
        ("film_minimum", "Thinnest film", np.nanmin),
    ):
        if name in good:
            assert_shows(shown.pop(words), float(end(good[name])), units[name], 4)
    assert not shown


def assert_classes(rows: Rows, column: np.ndarray | None) -> None:
    """The classes that are there, the most common first."""
    known = [] if column is None else [CLASSES_SPOKEN[int(code)] for code in column[np.isfinite(column)]]
    counts = [known.count(row[0]) for row in rows]
    assert counts == sorted(counts, reverse=True) and set(known) == {row[0] for row in rows}


def assert_varied(rows: Rows) -> None:
    keys = (campaign_writer.FORCES, campaign_writer.SPEEDS)
    for row, key in zip(rows, keys, strict=True):
        assert row[0] == key.key and row[3:] == [key.scale, str(key.count)]
        for cell, value in zip(row[1:3], (key.first, key.last), strict=True):
            assert_shows(cell, value, campaign_writer.UNITS[key.key])


def assert_worst(rows: Rows, good: Mapping[str, np.ndarray], extra: Sequence[str]) -> None:
    """The ten scenes with the largest acceleration, failed ones not among them."""
    order = np.argsort(-good["acceleration_maximum"], kind="stable")
    assert len(rows) == 10
    for row, place in zip(rows, order, strict=False):
        assert row[0] == str(int(good["scene"][place]))
        for cell, (name, unit) in zip(
            row[1:],
            ((campaign_writer.FORCE, "N"), (campaign_writer.SPEED, "m/s"), ("acceleration_maximum", "m/s2")),
            strict=False,
        ):
            assert_shows(cell, good[name][place], unit)
        for cell, name in zip(row[4:], extra, strict=True):
            words = codes.words_of(name)
            code = good[name][place]
            assert cell == (
                SPOKEN.get(words[int(code)], words[int(code)]) if np.isfinite(code) else "unknown"
            )


# --- a film task ---------------------------------------------------------------------------------------


@pytest.mark.long
def test_the_page_of_a_film_task_is_its_rows(run, repository, tmp_path):
    assert run(repository / "input" / "film.nml", "--output", tmp_path, cwd=tmp_path).returncode == 0
    path = tmp_path / "film.rattle"
    page, result = read_page(report(path)), rattle.read(path)
    summary = rattle.read_summary(path.with_suffix(".summary.nml"))
    columns = {name: np.array(result[name]) for name in result.names if codes.words_of(name) is None}
    readers = {
        RANGES: reader_of_ranges(columns, result.units),
        COMPUTED: reader_of_computed(result.input, summary),
        KEYS: reader_of_keys(result.input),
    }
    assert_tables(page, readers, [RANGES, KEYS, COMPUTED])
    (short,) = (words for words in page.paragraphs if words.endswith("All inputs stand below."))
    sentences = [
        f"The film at {result.row_count} points: load, stiffness and damping",
        f"The range of each column of the result over its {result.row_count} rows.",
        "This text, saved as film.nml, repeats the run with: rattle film.nml",
        "Save as film.nml",
        opening(result.input, {}),
        *asked(result.input, short),
    ]
    assert_numbers(page, sentences)
