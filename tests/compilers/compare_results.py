#!/usr/bin/env python3
"""Holds results of the ready scenes against those of another build: the same words, values within errors.

Usage: compare_results.py FOLDER OTHER_FOLDER
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "scripts"))

import rattle  # noqa: E402

# What is of the work and not of the motion.
WORK = ("wall_seconds", "program_version", "evaluations", "steps", "steps_cut", "iterations_per_step")
CHECKSUM = "_checksum"  # of files that differ in their last digits
ROUNDING = 1e-6  # the share of the largest by which values without a stated error may differ
SHARES = ("irregular_fraction",)  # of one, however little is left of them
CODES = ("status", "rattle_class", "verified", "film_regime", "law_contradicted", "model_limit")


def main() -> int:
    ours, others = map(Path, sys.argv[1:3])
    failed = 0
    for path in sorted(ours.glob("*.summary.nml")):
        if not (others / path.name).exists():
            failed += 1
            print(f"FAILED  {path.name}: the other build has none")
            continue
        for sentence in differences(rattle.read_summary(path), rattle.read_summary(others / path.name)):
            failed += 1
            print(f"FAILED  {path.name}: {sentence}")
    for path in sorted(ours.glob("*.rattle")):
        if (others / path.name.replace(".rattle", ".summary.nml").replace(".profiles", "")).exists():
            print(f"{path.name:32}{largest_difference(path, others / path.name)}")
    print(f"{failed} differences beyond the errors")
    return int(failed > 0)


def differences(one: dict, other: dict) -> list[str]:
    """Keys of summaries that differ by more than their stated error, twice: either build may be off by it."""
    found = [f"{key} is in one only" for key in sorted(one.keys() ^ other.keys())]
    for key in one.keys() & other.keys() - set(WORK):
        a, b = one[key], other[key]
        if key.endswith(CHECKSUM):
            continue
        if key.endswith(
            ("_error", "_errors", "_multipliers")
        ):  # of these only the order of magnitude is meant
            continue
        if isinstance(a, dict):
            found += [f"{key}: {sentence}" for sentence in differences(a, b)]
            continue
        if isinstance(a, str | bool | int):
            if a != b:
                found.append(f"{key} is {a} and {b}")
            continue
        a, b = np.atleast_1d(np.asarray(a, dtype=float)), np.atleast_1d(np.asarray(b, dtype=float))
        error = one.get(f"{key}_error", one.get("harmonic_errors" if key == "harmonics" else "", 0.0))
        largest = 1.0 if key in SHARES else np.abs(a).max(initial=0.0)
        room = 2.0 * np.asarray(error, dtype=float) + ROUNDING * largest
        if a.shape != b.shape or (np.abs(a - b) > room).any():
            found.append(f"{key} is {a} and {b}")
    return found


def largest_difference(path: Path, other: Path) -> str:
    """The column that differs most, relative to its largest value; of codes, how many rows differ."""
    try:
        a, b = rattle.read_campaign(path), rattle.read_campaign(other)
    except rattle.ResultError:
        a, b = rattle.read(path), rattle.read(other)
    worst, where = 0.0, "none"
    for name in a.names:
        x, y = np.asarray(a[name]), np.asarray(b[name])
        if x.shape != y.shape:
            return f"{x.size} and {y.size} rows"
        if name in CODES:
            unlike = int((x != y).sum())
            if unlike:
                return f"{name} differs in {unlike} of {x.size} rows"
            continue
        apart = np.nanmax(np.abs(x - y), initial=0.0) / (np.nanmax(np.abs(x), initial=0.0) or 1.0)
        if apart > worst:
            worst, where = float(apart), name
    return f"at most {worst:.1e} apart ({where})"


if __name__ == "__main__":
    sys.exit(main())
