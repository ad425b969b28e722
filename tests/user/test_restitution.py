"""Restitution of impacts against motions solved by other means, and what tests/measured reports of it."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of
from test_separation import SCENES, largest_force, text_of, true_window

import rattle as package

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "measured" / "restitution"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "measured" / "onset"))

import run_onset
import run_restitution
from tables import read_csv

MEASURED = Path(__file__).resolve().parents[1] / "measured"


def restitution(loads: np.ndarray, velocities: np.ndarray, level: float) -> float:
    """By the words of the definition, of a cycle whose ends are the same, by straight lines."""
    top, points = int(np.argmax(loads)), len(loads) - 1
    loads, velocities = np.roll(loads[:-1], points // 2 - top), np.roll(velocities[:-1], points // 2 - top)
    first = points // 2 - int(np.argmax(loads[points // 2 :: -1] <= level))
    last = points // 2 + int(np.argmax(loads[points // 2 :] <= level))
    approach = np.interp(level, loads[first : first + 2], velocities[first : first + 2])
    away = np.interp(level, loads[last - 1 : last + 1][::-1], velocities[last - 1 : last + 1][::-1])
    return float(-away / approach)


@pytest.mark.parametrize("name", ("idle", "R2", "R4", "S1", "S4"))
def test_restitution_is_that_of_a_motion_solved_by_other_means(name: str, run, tmp_path: Path) -> None:
    """Of rigid and elastic teeth, one flank and two; without an impact there is none."""
    tooth, flanks = SCENES[name], ("drive", "coast")
    (tmp_path / "one.nml").write_text(text_of(tooth))
    ended = run("one.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    summary = summary_of(tmp_path / "results" / "one.summary.nml")
    result = package.read(tmp_path / "results" / "one.rattle")
    periods = summary["window_periods"]
    first = 512 * (summary["periods_solved"] - periods)
    _, states, loads = true_window(tooth, result, first, periods, 16000 if name == "R4" else 4000)
    force = largest_force(tooth)
    for flank in range(1 if tooth.backlash is None else 2):
        reported = f"restitution_{flanks[flank]}"
        if loads[:, flank].max() < 1.5 * force:
            assert reported not in summary
            continue
        toward = -states[:, 1] if flank == 0 else states[:, 1]
        # Half the square of the steps, a thousandth of an impact each, is what straight lines miss.
        assert summary[reported] == pytest.approx(restitution(loads[:, flank], toward, force), abs=1e-4)


# --- tests/measured ---------------------------------------------------------------------------------------


def table_of(case: run_restitution.Case) -> dict[str, np.ndarray]:
    """Columns of the kept table; NaN where there is a word."""
    rows = [row for row in read_csv(MEASURED / "restitution" / "table.csv") if row["cylinder"] == case.name]
    columns = {name: [row[name] for row in rows] for name in run_restitution.HEAD[1:]}
    return {
        name: np.array([float(cell) if re.match(r"-?\d", cell) else np.nan for cell in cells])
        for name, cells in columns.items()
    }


@pytest.mark.parametrize("place", (0, 9, 15, 24))
def test_rows_of_the_kept_table_are_those_of_this_program(place: int) -> None:
    case = run_restitution.CASES[0]
    rows, velocity = table_of(case), float(run_restitution.VELOCITIES[place])
    assert run_restitution.restitution(case, velocity, "closure") == pytest.approx(
        rows["closure"][place], rel=1e-3
    )
    in_nodes = run_restitution.restitution_in_nodes(case, velocity)
    assert in_nodes == pytest.approx(rows["in_nodes"][place], rel=2e-3)


@pytest.mark.parametrize("case", run_restitution.CASES, ids=lambda case: case.name)
def test_the_table_bears_out_what_the_page_says_of_it(case: run_restitution.Case) -> None:
    """No rebound below a critical Stokes number, which reasoning gives within a tenth; from there a line in
    1/St, half at 2.7 times the derived number; nodes as the closure."""
    rows = table_of(case)
    stokes, closure = rows["stokes"], rows["closure"]
    derived = run_restitution.elastic_critical(case)
    assert run_restitution.passing(stokes, closure, run_restitution.REBOUND) == pytest.approx(
        derived, rel=0.1
    )
    assert run_restitution.passing(stokes, closure, 0.5) == pytest.approx(2.72 * derived, rel=0.01)
    assert np.nanmax(closure[stokes < 0.95 * derived]) < 0.01
    assert np.all(np.diff(closure[stokes > derived]) > 0.0)
    assert run_restitution.line_in_inverse(stokes, closure)[2] < 0.033
    assert np.nanmax(np.abs(rows["in_nodes"] - closure)) < 0.01
    assert np.nanmax(np.abs(rows["mass_on_spring"] - closure)[stokes > derived]) < 0.031


def test_derived_critical_numbers() -> None:
    """That of a rigid body by quadrature: m V = integral of the load of the film over time; and that a more
    viscous oil and a softer cylinder both lower that of an elastic one."""
    case, film = run_restitution.CASES[0], 4e-7
    films = np.geomspace(film, run_restitution.FIRST_FILM, 20001)
    impulse = np.trapezoid(case.squeeze * films**-1.5, films)
    stokes = case.stokes(float(impulse) / run_restitution.MASS)
    assert run_restitution.rigid_critical(film) == pytest.approx(stokes, rel=1e-6)
    derived = [run_restitution.elastic_critical(one) for one in run_restitution.CASES]
    assert derived[1] < derived[0] and derived[2] < derived[0]


def test_separation_begins_near_the_rule_where_drag_is_large() -> None:
    """A value of the kept table anew, and what the page says of all."""
    rows = read_csv(MEASURED / "onset" / "table.csv")
    kept = next(row for row in rows if (row["drag_scale"], row["oil_celsius"]) == ("4", "20"))
    drag, ratio, _ = run_onset.onset(4.0, 20.0, between=(0.9, 1.2))
    assert drag == pytest.approx(float(kept["drag_torque_N_m"]), rel=1e-3)
    assert ratio == pytest.approx(float(kept["ratio_at_onset"]), rel=5e-3)
    torques, ratios = (np.array([float(row[name]) for row in rows]) for name in run_onset.HEAD[2:4])
    assert np.all(np.abs(ratios[torques > 0.1] - 1.0) < 0.13)
    assert np.all(np.abs(ratios[torques > 0.04] - 1.0) < 0.23)
