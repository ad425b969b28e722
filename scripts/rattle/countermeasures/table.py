"""A study as tables of numbers: what reports read again."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rattle.command import CommandError
from rattle.countermeasures.levers import Lever
from rattle.countermeasures.scenes import Answer, Scenes, Together
from rattle.countermeasures.study import TARGETS, BoxMeasure, End, Measure, PairStudy, rattling
from rattle.solve import literal

ENDING, PAGE_ENDING = ".countermeasures.csv", ".countermeasures.md"
TOGETHER_ENDING = ".together.csv"
ANSWER = ("verdict", "film_force_rms", "film_force_rms_error", "motions")
LEVER = ("change", "key", "unit", "now", "first", "last", "scale")
SLUGS = {name: name.replace("-", "_").replace(" ", "_") for name in TARGETS}
COLUMNS = (
    *("gear", "rank", *LEVER, "verdicts"),
    *(f"now_{name}" for name in ANSWER),
    *("effort_to", *(f"effort_{name}" for name in ANSWER), "effort_change_db", "effort_change_db_error"),
    *(
        f"no_{slug}_{name}"
        for slug in SLUGS.values()
        for name in ("from", "until", "confirmed", *ANSWER, "change_db")
    ),
    "note",
)


def to_csv(pairs: Sequence[PairStudy]) -> str:
    """Every number of a study, a row for each thing to change of each pair."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
    writer.writeheader()
    for pair in pairs:
        for rank, measure in enumerate(pair.measures, 1):
            writer.writerow({"gear": pair.name, "rank": rank} | _row(pair.now, measure))
    return stream.getvalue()


def _row(now: Answer, measure: Measure) -> dict[str, Any]:
    lever = measure.lever
    scale = "logarithmic" if lever.logarithmic else "linear"
    values = (lever.name, lever.key, lever.unit, lever.now, lever.first, lever.last, scale)
    row: dict[str, Any] = dict(zip(LEVER, values, strict=True)) | _answer("now", now)
    row["verdicts"] = " ".join(f"{first!r}:{last!r}:{code}" for first, last, code in measure.stretches)
    row["note"] = measure.note
    if measure.effort:
        value, answer = measure.effort
        row |= {"effort_to": value, "effort_change_db": answer.change_db(now)} | _answer("effort", answer)
        row["effort_change_db_error"] = answer.error_db(now)
    for name, end in measure.ends.items():
        start = f"no_{SLUGS[name]}"
        row |= {f"{start}_from": end.value, f"{start}_until": end.until} | _answer(start, end.answer)
        row |= {f"{start}_confirmed": int(end.confirmed), f"{start}_change_db": end.answer.change_db(now)}
    return row


def _answer(start: str, answer: Answer) -> dict[str, float]:
    values = (answer.verdict, answer.force, answer.error, answer.motions)
    return {f"{start}_{name}": value for name, value in zip(ANSWER, values, strict=True)}


def read(path: Path) -> list[PairStudy]:
    """What `to_csv` wrote.

    Raises
    ------
    CommandError
        The file is no such table.
    """
    try:
        with path.open(newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream, strict=True))
        found: dict[str, PairStudy] = {}
        for row in rows:
            pair = found.get(row["gear"], PairStudy(row["gear"], _read_answer("now", row), ()))
            found[pair.name] = PairStudy(pair.name, pair.now, (*pair.measures, _read_measure(row)))
    except (KeyError, TypeError, ValueError, csv.Error):
        raise CommandError(f"{path} is not a table that countermeasures.py wrote.") from None
    return list(found.values())


def _read_measure(row: dict[str, str]) -> Measure:
    now, first, last = (float(row[name]) for name in ("now", "first", "last"))
    is_logarithmic = row["scale"] == "logarithmic"
    lever = Lever(row["change"], row["key"], row["unit"], now, first, last, is_logarithmic, 0.0)
    parts = [part.split(":") for part in row["verdicts"].split()]
    stretches = tuple((float(low), float(high), int(code)) for low, high, code in parts)
    ends = {}
    for name, slug in SLUGS.items():
        start = f"no_{slug}"
        if row[f"{start}_from"]:
            value, until = (float(row[f"{start}_{word}"]) for word in ("from", "until"))
            confirmed = row[f"{start}_confirmed"] == "1"
            share = float(lever.share(value))
            ends[name] = End(value, share, until, confirmed, _read_answer(start, row))
    effort = (float(row["effort_to"]), _read_answer("effort", row)) if row["effort_to"] else None
    return Measure(lever, stretches, ends, effort, row["note"])


def _read_answer(start: str, row: dict[str, str]) -> Answer:
    verdict, force, error, motions = (float(row[f"{start}_{name}"]) for name in ANSWER)
    return Answer(int(verdict), force, error, int(motions))


def together_csv(scenes: Scenes, measures: Sequence[BoxMeasure]) -> str:
    """All pairs together, a row for each change of them all and each variant."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    heads = ["change", "settings", "cost", "confirmed", "pairs_with_impacts"]
    heads += ["film_force_rms_uncorrelated", "change_db", "film_force_rms_in_phase", "change_db_in_phase"]
    names = [scene.name for scene in scenes.pairs]
    heads += ["gain_db_per_cost", *(f"verdict_{n}" for n in names), *(f"change_db_{n}" for n in names)]
    writer.writerow(heads)
    for measure in measures:
        result, before = measure.result, scenes.together
        change, in_phase = result.change_db(before)
        confirmed = "" if measure.confirmed is None else int(measure.confirmed)
        row = [measure.name, settings_words(measure), _known(measure.cost), confirmed, rattling(result)]
        row += [result.uncorrelated, change, result.in_phase, in_phase, _known(gain_of_cost(measure, before))]
        row += [result.pairs[name].verdict for name in names]
        row += [result.pairs[name].change_db(before.pairs[name]) for name in names]
        writer.writerow(row)
    return stream.getvalue()


def gain_of_cost(measure: BoxMeasure, before: Together) -> float:
    """dB less for each unit of cost."""
    gain = -measure.result.change_db(before)[0]
    return gain / measure.cost if measure.cost > 0.0 else math.nan


def settings_words(measure: BoxMeasure) -> str:
    """As options --set take them."""
    return "; ".join(f"{key}={literal(value)}" for key, value in measure.settings.items())


def _known(value: float) -> float | str:
    return value if math.isfinite(value) else ""
