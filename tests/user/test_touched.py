"""The toys of tests/touched fit the sources and take no more files than they may."""

from __future__ import annotations

import importlib
import shutil
import subprocess
import sys

import pytest


@pytest.fixture
def touched(repository, monkeypatch):
    monkeypatch.syspath_prepend(repository / "tests" / "touched")
    return importlib.import_module("run_touched")


@pytest.fixture
def scratch(repository, tmp_path):
    for folder in ("fsrc", "scripts"):
        unwanted = shutil.ignore_patterns("*.so", "__pycache__")
        shutil.copytree(repository / folder, tmp_path / folder, ignore=unwanted)
    return tmp_path


def test_every_toy_fits_and_takes_the_files_of_its_list(touched, scratch):
    taken, faults = touched.add_toys(scratch, list(touched.TOYS.values()))
    assert faults == []
    assert len(taken) == len(touched.TOYS)
    layout = [sys.executable, scratch / "scripts" / "check_layout.py"]
    assert subprocess.run(layout, capture_output=True, text=True, check=False).stdout.strip() == ""


def test_a_list_that_lacks_a_file_is_reported(touched, scratch):
    page = scratch / "fsrc" / "README.md"
    page.write_text(page.read_text().replace("2. `fsrc/film/film_law.f90`", "2. `fsrc/film/rupture.f90`"))
    _, faults = touched.add_toys(scratch, ["law"])
    assert faults == [
        "a film law: it edits fsrc/film/film_law.f90, which its list in fsrc/README.md does not name"
    ]


def test_a_toy_that_takes_more_files_is_reported(touched, scratch):
    page = scratch / "fsrc" / "README.md"
    page.write_text(page.read_text().replace("Add a task (at most 6 files)", "Add a task (at most 5 files)"))
    _, faults = touched.add_toys(scratch, ["task"])
    assert faults == ["a task: 6 files, more than 5"]


def test_a_list_without_a_toy_is_reported(touched, scratch):
    page = scratch / "fsrc" / "README.md"
    page.write_text(page.read_text() + "\n### Add a wheel (at most 1 files)\n")
    _, faults = touched.add_toys(scratch, ["law"])
    assert "a wheel; there are toys for" in faults[0]
