"""No error has more than two digits, nor is it smaller than the digits of its number let it be known."""

from __future__ import annotations

import re
from decimal import Decimal

import numpy as np
import pytest
from report_reader import read_page
from reported import stated_error
from script_calls import call_script
from test_report import report
from test_thresholds import threshold_text

import rattle
from rattle import rounding

READY = ("idle", "creep", "creep_false_harmonic", "engine_cycle", "loose_gear", "loose_pair", "gearbox")


@pytest.fixture(scope="module")
def solved(run, repository, tmp_path_factory):
    """Summaries of ready scenes, their logs and results beside them."""
    folder = tmp_path_factory.mktemp("errors")
    inputs = [repository / "input" / f"{name}.nml" for name in READY]
    assert run(*inputs, "--output", folder, cwd=folder).returncode == 0
    found = [path for path in folder.glob("*.summary.nml") if path.name != "gearbox.summary.nml"]
    assert len(found) == len(READY) + 3
    return found


def digits(shown: str) -> str:
    """The significant digits of a number as it is written."""
    plain = re.sub(r"[eE].*", "", shown).lstrip("-").replace(".", "")
    return plain.lstrip("0") if "." in shown else plain.lstrip("0").rstrip("0")


def last_place(shown: str) -> float:
    """A unit of the last digit of a number as it is written."""
    return float(Decimal(1).scaleb(Decimal(shown).as_tuple().exponent))


def assert_reported(error: str, number: str, bound: float) -> None:
    """An error beside its number: two digits, the bound of the summary and the rounding, and no more."""
    reported, least = float(error), max(bound, 0.5 * last_place(number))
    assert len(digits(error)) <= 2, error
    assert least * (1.0 - 1e-9) <= reported <= 1.1 * least * (1.0 + 1e-9), (error, number, bound)


def test_errors_in_logs(solved):
    for path in solved:
        reported = rattle.read_summary(path)
        log = path.with_name(path.name.replace(".summary.nml", ".log"))
        if not log.exists():  # that of the gearbox
            log = path.with_name("gearbox.log")
        text = log.read_text()
        text = text[text.index(f"scene {reported['name']}:") :]
        film, low, high = re.search(
            r"  film (\S+) to \S+ um, acceleration (\S+) to (\S+) m/s2", text
        ).groups()
        of_film, of_low, of_high = re.search(
            r"error of the film at most (\S+) of it, "
            r"of the extremes of the acceleration (\S+) and (\S+) m/s2",
            text,
        ).groups()
        assert_reported(of_low, low, reported["acceleration_minimum_error"])
        assert_reported(of_high, high, reported["acceleration_maximum_error"])
        assert_reported(of_film, "1.0000", reported["film_error"])
        assert float(of_film) * float(film) >= 0.5 * last_place(film) * (1.0 - 1e-9)
        for number, error in re.findall(r"(\S+) \+- (\S+) a period", text):
            assert len(digits(error)) <= 2 and float(error) >= 0.5 * last_place(number)


def test_errors_in_summaries(solved):
    for path in solved:
        reported, text = rattle.read_summary(path), path.read_text()
        names = [name for name in reported if name.endswith("_error")]
        flanks = sum(f"impacts_per_period_{flank}" in reported for flank in ("drive", "coast"))
        assert len(names) == 10 + 2 * flanks
        for name in names:
            shown = re.search(rf"^   {name} = (\S+)$", text, re.MULTILINE)[1]
            number = reported.get(name.removesuffix("_error"), 1.0)
            assert len(digits(shown.removesuffix(".0"))) <= 2
            assert reported[name] >= 0.5 * np.spacing(abs(number))
        errors = re.search(r"harmonic_errors = ([^=]*)\n   \w+ =", text)[1].replace(",", " ").split()
        assert len(errors) > 0
        for shown, number in zip(errors, reported["harmonics"], strict=False):
            assert len(digits(shown.removesuffix(".0"))) <= 2
            assert float(shown) >= 0.5 * np.spacing(number)


def plain(cell: str) -> tuple[str, str]:
    """The number of a cell as a computer writes it, and its unit."""
    shown, _, unit = cell.partition("\xa0")
    shown = shown.replace("\N{MINUS SIGN}", "-")
    return re.sub("\N{MULTIPLICATION SIGN}10", "e", shown), unit


SCALES = {"m": 1.0, "\N{MICRO SIGN}m": 1e-6, "nm": 1e-9}


def assert_cells(error: str, number: str, bound: float) -> None:
    """The same of cells of a page, whose numbers have six digits, zeros at the end left out."""
    (reported, own), (shown, unit) = plain(error), plain(number)
    scale = SCALES.get(own, 1.0)
    value = float(shown) * SCALES.get(unit, 1.0)
    assert (own in SCALES) == (unit in SCALES) and (own == unit or own in SCALES)
    if value:
        assert_reported(reported, f"{value / scale:.5e}", bound / scale)
    assert len(digits(reported)) <= 2


@pytest.mark.long
def test_errors_in_reports(solved):
    names = {quantity.meaning.rstrip("."): name for name, quantity in rattle.codes.QUANTITIES.items()}
    for path in solved:
        reported = rattle.read_summary(path)
        page = read_page(report(path.with_name(path.name.replace(".summary.nml", ".rattle"))))
        extremes = next(table for table in page.tables if table[0] == ["", "Value", "Error at most"])
        assert len(extremes) == 5
        for meaning, number, error in extremes[1:]:
            assert_cells(error, number, reported[f"{names[meaning]}_error"])
        lines = next(table for table in page.tables if table[0][0] == "Harmonic")
        for (*_, number, error), bound in zip(lines[1:], reported["harmonic_errors"], strict=False):
            assert_cells(error, number, bound)
        rows = {row[0]: row[1] for row in page.tables[2][1:]}
        for name, cell in rows.items():
            if name.endswith("_error"):
                assert_cells(cell, rows.get(name.removesuffix("_error"), "1"), reported[name])


def test_errors_of_scenes_side_by_side(solved):
    done = call_script("compare.py", *solved, "--markdown")
    assert done.returncode == 0, done.stderr
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines()]
    rows = {words: cells for words, *cells in lines}
    for path, film, error in zip(solved, rows["film thickness [um]"], rows["error of the film"], strict=True):
        assert_reported(error, "1.0000", rattle.read_summary(path)["film_error"])
        least = film.partition(" to ")[0]
        assert float(error) * float(least) >= 0.5 * last_place(least) * (1.0 - 1e-9)


def test_widths_of_thresholds(run, scene_text, tmp_path):
    """What is left between the ends of a crossing is the error of it."""
    (tmp_path / "edge.nml").write_text(threshold_text(scene_text, threshold={"tolerance": "1e-7"}))
    assert run("edge.nml", "--output", tmp_path, cwd=tmp_path).returncode == 0
    path = next(tmp_path.glob("*.rattle"))
    page, rows = read_page(report(path)), rattle.read(path)
    table = next(table for table in page.tables if "Width" in table[0])
    place = table[0].index("Width")
    crossed = [row for row in table[1:] if row[place] != "-"]
    widths = rows["width"][rows["crossing"] > 0]
    assert len(crossed) == len(widths) > 0
    for row, width in zip(crossed, widths, strict=True):
        assert_cells(row[place], row[place - 1], width)


@pytest.mark.parametrize("digits_reported", (4, 5, 6))
def test_errors_are_stated_by_one_rule(digits_reported):
    random = np.random.default_rng(7)
    numbers = random.choice([-1.0, 1.0], 500) * 10.0 ** random.uniform(-12.0, 9.0, 500)
    for number, share in zip(numbers, 10.0 ** random.uniform(-18.0, 1.0, 500), strict=True):
        error = abs(number) * share
        expected = stated_error(error, number, digits_reported)
        found = rounding.stated_error(error, number, digits_reported)
        assert found == expected == rounding.stated_error(found, number, digits_reported)
    assert rounding.stated_error(0.0, 0.0, digits_reported) == 0.0
