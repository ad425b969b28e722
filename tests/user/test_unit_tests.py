"""The runner of the unit tests: it finds its suites by itself, and runs one by name."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

Runner = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture
def unit_tests(rattle: Path) -> Runner:
    """The unit tests beside the program under test."""
    program = rattle.with_name("unit_tests")
    if not program.exists():
        pytest.fail(f"There is no {program}: run `make unit`.", pytrace=False)
    return lambda *names: subprocess.run([program, *names], capture_output=True, text=True, check=False)


def test_every_file_of_tests_is_a_suite(unit_tests, repository):
    files = sorted(path.stem.removeprefix("test_") for path in repository.glob("tests/unit/test_*.f90"))
    assert unit_tests("--list").stdout.split() == files


def test_suites_and_tests_run_by_name(unit_tests):
    suite, other = (int(unit_tests(name).stdout.split()[0]) for name in ("film_law", "errors"))
    both = unit_tests("film_law", "errors")
    assert both.returncode == 0
    assert both.stdout == f"{suite + other} passed, 0 failed\n"
    some = unit_tests("film_law/half-pi")
    assert 0 < some.stdout.count("check  film_law: ") < suite
    assert f"\n{some.stdout.count('check  ')} passed, 0 failed\n" in some.stdout


@pytest.mark.parametrize("name", ["film_lwa", "film_law/nothing says this", "/errors"])
def test_names_that_nothing_has_are_refused(unit_tests, name):
    done = unit_tests(name)
    assert done.returncode == 2
    assert f"there is no test '{name}'" in done.stderr
