"""What would stop the rattle, where countermeasures.py left its tables beside the results of a report."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from functools import partial
from math import isclose
from pathlib import Path

from rattle.command import CommandError
from rattle.countermeasures import table, words
from rattle.countermeasures.scenes import answer
from rattle.countermeasures.study import PairStudy
from rattle.figures.countermeasures import draw
from rattle.report import page
from rattle.summary import Summary

TITLE = "What would stop it"
CAPTION = (
    "What the tooth does over the range of each change, all else as it is; marks: solved again, from there "
    "on it has ended. Right: what an effort of a tenth gains."
)
OTHER_RUN = "{path} is of another run than these results; countermeasures.py writes it anew."
# Columns of the table of all pairs together, and of variants of a single one.
OF_BOX = ("Changed of all pairs", "Pairs with impacts", "Uncorrelated [dB]", "In phase [dB]")
OF_PAIR = ("Variant", "Film force [dB]")


def part(folder: Path, name: str, summaries: Mapping[str, Summary]) -> tuple[list[str], list[str]]:
    """What is seen, and what stands behind folds; nothing where there are no tables of these results.

    `summaries` has that of each pair by its name; that of a single scene may have any.
    """
    path = folder / f"{name}{table.ENDING}"
    if not path.exists():
        return [], []
    title = page.heading(2, TITLE)
    try:
        pairs = table.read(path)
        if not _is_of(pairs, summaries):
            raise CommandError(OTHER_RUN.format(path=path.name))
    except CommandError as fault:
        return [title, page.paragraph(str(fault), "note")], []
    pairs.sort(key=lambda pair: -pair.now.force)
    seen, folds = [title], []
    for pair in pairs:
        reported = " ".join(words.sentences(pair))
        seen.append(page.paragraph(f"{pair.name}: {reported}" if len(pairs) > 1 else reported))
        drawn = page.drawing(partial(draw, pair), CAPTION, f"{name} {pair.name} countermeasures")
        head, *rows = words.cells(pair)
        ranked = page.table(head, rows, kinds=["" for _ in head], kind="dense")
        refused = [page.paragraph(f"{m.lever.name}: {m.note}.", "note") for m in pair.measures if m.note]
        seen += [drawn] if pair is pairs[0] else []
        shown = [ranked, *refused] if pair is pairs[0] else [drawn, ranked, *refused]
        folds += page.fold(f"{TITLE}: {pair.name}", shown)
    together = _together(folder / f"{name}{table.TOGETHER_ENDING}", is_box=len(pairs) > 1)
    return [*seen, *together], folds


def _is_of(pairs: list[PairStudy], summaries: Mapping[str, Summary]) -> bool:
    """Whether the pairs of a table are those of these summaries, with the same film forces."""
    given = {pair.name: pair.now.force for pair in pairs}
    known = {name: answer(summary).force for name, summary in summaries.items()}
    if len(given) == len(known) == 1:
        given, known = ({"": next(iter(one.values()))} for one in (given, known))
    return given.keys() == known.keys() and all(isclose(given[n], known[n], rel_tol=1e-9) for n in given)


def _together(path: Path, *, is_box: bool) -> list[str]:
    """What the film force becomes where things are changed of all pairs at once."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    lines = []
    for row in rows:
        changes = [f"{float(row[name]):+.1f}" for name in ("change_db", "change_db_in_phase")]
        lines.append([row["change"], *([row["pairs_with_impacts"], *changes] if is_box else changes[:1])])
    heads = OF_BOX if is_box else OF_PAIR
    return [page.table(heads, lines, kinds=("", *("number" for _ in heads[1:])))]
