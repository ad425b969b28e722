"""Summaries read and put side by side: every number under its words, in the unit that they name."""

from __future__ import annotations

from pathlib import Path

import pytest
from script_calls import call_script

import rattle
from rattle import table
from rattle.summary import SummaryError, comparison_table

SUMMARY = {
    "name": "'idle'",
    "status": "'complete'",
    "law": "'iso-viscous'",
    "model": "'published'",
    "film_minimum": "0.5123e-6",
    "film_maximum": "1.5e-6",
    "acceleration_minimum": "-52.1239",
    "acceleration_maximum": "290.75",
    "acceleration_rms": "44.1071",
    "film_force_rms": "212.4455",
    "dissipated_power": "0.50282",
    "coast_film_minimum": "3.25e-6",
    "coast_film_maximum": "8.5e-6",
    "verdict": "'double-sided impacts'",
    "verdict_verified": ".false.",
    "motions": "2",
    "load_maximum": "341.27",
    "impacts_per_period_drive": "2.0",
    "impacts_per_period_coast": "0.5",
    "harmonic_count": "30",
    "harmonic_distortion": "0.98761",
    "irregular_fraction": "1.5e-12",
    "reversals_per_period": "4.5",
    "rattle_class": "'idle'",
    "verification": "'verified'",
    "film_error": "2.5e-9",
    "orbit_stability": "'stable'",
    "film_regime": "'piezo-viscous'",
    "law_contradicted": ".true.",
    "stiffness_matters": ".true.",
    "alpha_p_maximum": "0.8261",
    "natural_frequency": "812.34",
    "damping_ratio": "0.12345",
    "steady_film": "0.8889e-6",
}
SHOWN = {
    "": "idle",
    "verdict": "double-sided impacts",
    "verification of the verdict": "uncertain",
    "class": "idle",
    "verification of the class": "numerically verified",
    "motions found": "2",
    "largest load [N]": "341.3",
    "impacts a period": "2 drive, 0.5 coast",
    "status": "complete",
    "film law": "iso-viscous",
    "film model": "published",
    "film thickness [um]": "0.51230 to 1.5000",
    "acceleration [m/s2]": "-52.124 to 290.750",
    "acceleration rms [m/s2]": "44.107",
    "film force rms [N]": "212.4",
    "dissipated power [W]": "0.5028",
    "coast film [um]": "3.2500 to 8.5000",
    "harmonics": "30",
    "harmonic distortion": "0.9876",
    "irregular fraction": "1.5e-12",
    "reversals a period": "4.5",
    "error of the film": "5.0e-05",
    "motion": "stable",
    "film regime": "piezo-viscous",
    "film law fits": "no",
    "rigid teeth fit": "no",
    "largest alpha p": "0.826",
    "natural frequency [Hz]": "812.3",
    "damping ratio": "0.1235",
    "steady film [um]": "0.8889",
}


def write(path: Path, without: tuple[str, ...] = (), **changes: str) -> Path:
    values = {key: value for key, value in (SUMMARY | changes).items() if key not in without}
    lines = "".join(f"   {key} = {value}\n" for key, value in values.items())
    path.write_text(f"&summary\n{lines}/\n")
    return path


def test_every_row_shows_its_own_number_in_its_unit(tmp_path):
    rows = comparison_table([rattle.read_summary(write(tmp_path / "idle.summary.nml"))])
    shown = dict(rows)
    assert {words: shown[words] for words in SHOWN} == SHOWN


def test_scenes_stand_side_by_side_and_what_is_unknown_is_a_dash(tmp_path):
    first = write(tmp_path / "a.summary.nml", ("dissipated_power",), name="'a'")
    second = write(
        tmp_path / "b.summary.nml",
        ("name", "film_maximum", "steady_film", "orbit_stability", "dissipated_power"),
        law_contradicted=".false.",
    )
    done = call_script("compare.py", first, second, "--markdown")
    assert done.returncode == 0, done.stderr
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines()]
    cells = {words: pair for words, *pair in lines}
    assert cells[""] == ["a", "b"]
    assert cells["film thickness [um]"] == ["0.51230 to 1.5000", "-"]
    assert cells["steady film [um]"] == ["0.8889", "-"]
    assert cells["motion"] == ["stable", "-"]
    assert cells["film law fits"] == ["no", "yes"]
    assert "dissipated power [W]" not in cells


def test_the_table_of_the_page_on_the_paper_is_what_the_program_finds(run, repository, tmp_path) -> None:
    scenes = [repository / "input" / f"{name}.nml" for name in ("idle", "creep")]
    assert run("--quiet", *scenes, cwd=tmp_path).returncode == 0
    paths = [tmp_path / "results" / f"{scene.stem}.summary.nml" for scene in scenes]
    lines = table.plain(comparison_table([rattle.read_summary(path) for path in paths])).splitlines()
    page = (repository / "input" / "PAPER.md").read_text().splitlines()
    assert [line[4:] for line in page if line.startswith("    ")][-len(lines) :] == lines


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("&summaty\n/\n", "is not a summary: it has no group &summary."),
        ("no namelist at all", "is not a summary"),
        ("&gear ! 0.9 \u00b0\n/\n", "is not a summary: it has no group &summary."),
    ],
)
def test_what_is_no_summary_is_explained(tmp_path, text, words):
    path = tmp_path / "a.summary.nml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SummaryError) as fault:
        rattle.read_summary(path)
    assert words in str(fault.value) and str(path) in str(fault.value)
    with pytest.raises(SummaryError, match="No such file"):
        rattle.read_summary(tmp_path / "none.summary.nml")


def test_a_value_of_a_wrong_type_is_named(tmp_path):
    path = write(tmp_path / "a.summary.nml", film_minimum="'thin'")
    done = call_script("compare.py", path)
    assert done.returncode == 2
    assert "The summary of idle holds a value of a wrong type." in done.stderr


def test_tables_put_words_to_the_left_and_numbers_to_the_right():
    rows = [["", "a", "long"], ["film [um]", "1.5", "10.25"], ["x | y", "-", "2"]]
    assert table.plain(rows).splitlines() == [
        "             a   long",
        "---------  ---  -----",
        "film [um]  1.5  10.25",
        "x | y        -      2",
    ]
    assert table.markdown(rows).splitlines() == [
        "|           |   a |  long |",
        "| --------- | --: | ----: |",
        "| film [um] | 1.5 | 10.25 |",
        "| x \\| y    |   - |     2 |",
    ]


def test_a_result_stands_for_its_summary(tmp_path):
    (tmp_path / "idle.summary.nml").write_text("&summary\n   name = 'idle'\n   status = 'complete'\n/\n")
    done = call_script("compare.py", tmp_path / "idle.rattle")
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[0].split() == ["idle"]


@pytest.mark.parametrize("script", ["plot.py", "compare.py", "classify.py", "export.py", "campaign.py"])
def test_without_arguments_a_script_shows_its_help(script):
    done, asked = call_script(script), call_script(script, "--help")
    assert (done.returncode, asked.returncode) == (2, 0)
    assert done.stderr == asked.stdout
    assert len(asked.stdout.splitlines()) > 8
