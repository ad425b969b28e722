"""Mutants: what the rules make of a statement, and that those of the list belong to the present source."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "mutants"))
import rules
import run_mutants

# A statement of Fortran, and all that is made of it.
MADE = {
    "x = a + 2*b": (
        *("x = a - 2*b", "x = a + 2/b", "x = a", "x = 2*b", "x = a + 2", "x = a + b"),
        *("x = a + 3*b", "x = a + 1*b", "continue"),
    ),
    "if (a < b) return": ("if (a <= b) return", "if (a > b) return", "if (.not. (a < b)) return", "continue"),
    "q = -r(m:n)": ("q = r(m:n)", "q = -r(m:n - 1)", "q = -r(m + 1:n)", "continue"),
    "do i = 2, n": ("do i = 3, n", "do i = 1, n", "do i = 2, n - 1"),
    "call f(a, b%c, d=e)": ("call f(b%c, a, d=e)", "continue"),
    "x = a .and. .not. b": ("x = a .or. .not. b", "x = a .and. b", "x = a", "x = .not. b", "continue"),
    "x = max(a, 0.5_dp)": (
        *(
            "x = min(a, 0.5_dp)",
            "x = max(a, 1.0_dp)",
            "x = max(a, 0.05_dp)",
            "x = (a)",
            "x = (0.5_dp)",
            "continue",
        ),
    ),
    "x = (a - b)/c": (
        "x = (a + b)/c",
        "x = (a - b)*c",
        "x = (b-a)/c",
        "x = c/(a - b)",
        "x = (a)/c",
        "x = (a - b)",
        "continue",
    ),
    "real(dp), parameter :: x(3) = 1.0e-3_dp": (
        "real(dp), parameter :: x(3) = 0.002_dp",
        "real(dp), parameter :: x(3) = 0.0001_dp",
    ),
    "use kinds, only: dp": (),
    "integer :: i": (),
    "pure real(dp) function f(a, b)": (),
    "end if": (),
    "! x = a + 1": (),
    "word = 'a + 1'  ! a < b": ("continue  ! a < b",),
}
IN_PYTHON = {
    "if not a or b == 1:": (
        *("if a or b == 1:", "if not a and b == 1:", "if not a or b != 1:", "if not a or b == 2:"),
        *("if not a or b == 0:", "if not a:", "if b == 1:"),
    ),
    "x = a if b else f(c, d)": ("x = a if not (b) else f(c, d)", "x = a if b else f(d, c)", "pass"),
    "import a.b": (),
}


@pytest.mark.parametrize("statement", MADE)
def test_rules_of_fortran(statement: str) -> None:
    assert made(statement, False) == Counter(MADE[statement])


@pytest.mark.parametrize("statement", IN_PYTHON)
def test_rules_of_python(statement: str) -> None:
    assert made(statement, True) == Counter(IN_PYTHON[statement])


def made(statement: str, python: bool) -> Counter[str]:
    return Counter(change.apply(statement) for change in rules.changes(statement, python, {1}))


def test_only_the_lines_that_were_asked_for() -> None:
    text = "x = a + &\n    b*c\nz = a - b\n"
    assert {change.apply(text) for change in rules.changes(text, False, {2})} == {
        "x = a + &\n    b/c\nz = a - b\n",
        "x = a + &\n    b\nz = a - b\n",
        "x = a + &\n    c\nz = a - b\n",
    }
    assert rules.changes(text, False, {4}) == []


def test_every_listed_mutant_applies_exactly_once() -> None:
    mutants = run_mutants.read_list()
    assert run_mutants.check(mutants) == []
    changes = Counter((one.path, one.original, one.changed) for one in mutants)
    assert max(changes.values()) == 1


def test_no_listed_mutant_is_made_by_a_rule() -> None:
    """What a rule makes is not kept by hand."""
    for mutant in run_mutants.read_list():
        text = (run_mutants.REPOSITORY / mutant.path).read_text(encoding="utf-8")
        if not mutant.path.endswith((".f90", ".inc", ".py")):
            continue
        start = text.index(mutant.original)
        first = text.count("\n", 0, start) + 1
        lines = set(range(first, first + mutant.original.count("\n") + 1))
        wanted = "".join(mutant.apply(text).split())
        for change in rules.changes(text, mutant.path.endswith(".py"), lines):
            assert "".join(change.apply(text).split()) != wanted, (mutant.path, mutant.reason, change.rule)


def test_the_order_of_mutants_is_that_of_its_seed(monkeypatch) -> None:
    monkeypatch.setattr(
        run_mutants, "changed_lines", lambda since: [("fsrc/run/batch.f90", set(range(1, 400)))]
    )
    order = run_mutants.by_rule("HEAD", 1)
    assert order == run_mutants.by_rule("HEAD", 1) != run_mutants.by_rule("HEAD", 2)
    text = (run_mutants.REPOSITORY / order[0].path).read_text(encoding="utf-8")
    assert all(one.apply(text) != text for one in order)
