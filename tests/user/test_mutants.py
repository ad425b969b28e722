"""The list of mutants belongs to the present source: each of them applies, and in one place only."""

from __future__ import annotations

import importlib.util
import sys
from collections import Counter
from pathlib import Path

MUTANTS = Path(__file__).resolve().parents[1] / "mutants"


def test_every_mutant_applies_exactly_once():
    spec = importlib.util.spec_from_file_location("run_mutants", MUTANTS / "run_mutants.py")
    runner = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = runner
    spec.loader.exec_module(runner)
    mutants = runner.read_list()
    assert runner.check(mutants) == []
    assert len(mutants) >= 150
    changes = Counter((one.path, one.original, one.changed) for one in mutants)
    assert max(changes.values()) == 1
