"""Hold what two builds report of the same gear scenes against each other.

    compare_motions.py BEFORE.csv AFTER.csv

Both files are of reported_motions. A motion that repeats is lost if no motion of the other build is within
2 % of its acceleration rms; of rows the motions from rest, the loudest and the quietest are compared. Prints
every scene that differs, and the sums.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import pandas

SAME_RMS = 0.02


def missing(motions: pandas.DataFrame, others: pandas.DataFrame) -> list[float]:
    """Accelerations of the motions that repeat and that the others do not have."""
    settled = motions[motions.period > 0].rms.drop_duplicates()
    return [rms for rms in settled if not (abs(others.rms - rms) <= SAME_RMS * rms).any()]


def words_of(summary: pandas.Series, motions: pandas.DataFrame) -> str:
    """What a build reports of a scene, in a few words."""
    parts = [
        f"{one.rms:.4g} m/s2" + (f" of {one.period}" if one.starts else "") for one in motions.itertuples()
    ]
    return f"{', '.join(parts)}; {summary.unsettled} unsettled"


def compare(before: pandas.DataFrame, after: pandas.DataFrame, way: str) -> None:
    """Print how the scenes of one way differ."""
    tables = [table[table.way == way] for table in (before, after)]
    both = sorted(set(tables[0].scene) & set(tables[1].scene))
    tables = [table[table.scene.isin(both)] for table in tables]
    sums = [table[table.what == "all"] for table in tables]
    motions = [table[table.what == "motion"] for table in tables]
    lost = gained = 0
    for scene in both:
        one, other = (table[table.scene == scene] for table in motions)
        summaries = [table[table.scene == scene].iloc[0] for table in sums]
        away, new = missing(one, other), missing(other, one)
        lost, gained = lost + len(away), gained + len(new)
        if away or new or summaries[0]["count"] != summaries[1]["count"]:
            marks = " lost" * bool(away) + " gained" * bool(new)
            print(f"{way} {scene}:{marks} | {words_of(summaries[0], one)} | {words_of(summaries[1], other)}")
    print(f"{way}: {len(both)} scenes, {lost} motions lost, {gained} gained")
    for name in ("count", "unsettled", "starts", "periods", "seconds"):
        old, new = (table[name].sum() for table in sums)
        if old > 0:
            print(
                f"  {'motions' if name == 'count' else name}: {old:.6g} to {new:.6g}, ratio {new / old:.3f}"
            )


def main() -> None:
    """Read both files and compare the scenes that are in both."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    arguments = parser.parse_args()
    before, after = pandas.read_csv(arguments.before), pandas.read_csv(arguments.after)
    for way in ("alone", "row"):
        compare(before, after, way)


if __name__ == "__main__":
    main()
