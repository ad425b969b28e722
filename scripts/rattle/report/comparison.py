"""What a page says of variants side by side: what differs in the inputs, and what in the answer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from rattle.campaign_plan import GEAR
from rattle.campaign_result import Campaign
from rattle.campaign_section import short_name
from rattle.codes import QUANTITIES
from rattle.command import CommandError
from rattle.comparison.answers import IN_PHASE, POWER, UNCORRELATED, answer_differences
from rattle.comparison.difference import Difference, reported_error
from rattle.comparison.inputs import input_differences, tables_named
from rattle.comparison.pairs import paired, unpaired
from rattle.comparison.rows import KIND, THRESHOLD, Compared, compared_rows
from rattle.comparison.variant import Variant, read_variants
from rattle.figures import campaign_look as look
from rattle.figures import comparison as picture
from rattle.report import page
from rattle.report.motion import NUMBERS
from rattle.summary import SummaryError

LEAD = "What differs between {base}, the base, and {others}: in the inputs, and in the answer."
# What of a motion everybody should see, in this order.
SEEN = {"verdict": "Verdict", "verdict_verified": "Verdict numerically verified"}
SEEN |= {"rattle_class": "Class by its spectrum", "verified": "Class numerically verified"}
SEEN |= {
    name: NUMBERS[name]
    for name in ("film_force_rms", "impacts_per_period_drive", "impacts_per_period_coast", "acceleration_rms")
}
SEEN |= {
    "impact_velocity_maximum_drive": "Largest velocity of approach, drive flank",
    "impact_velocity_maximum_coast": "Largest velocity of approach, coast flank",
    "film_minimum": NUMBERS["film_minimum"],
    "inertia_ratio": NUMBERS["inertia_ratio"],
    "motions": "Motions of this operating point; all else here is of that from rest",
    "loudest_film_force_rms": "Film force of the loudest of them, rms",
}
TOGETHER = {
    UNCORRELATED: "Film force rms of all pairs, if their forces are independent",
    IN_PHASE: "Film force rms of all pairs, in phase",
    POWER: "Power that films and teeth of all pairs take",
}
DRAWN = ("verdict", "film_force_rms")
# What is said of in the sentences on campaigns, sweeps and thresholds, and which words in a table.
SAID = ("verdict", "rattle_class", "film_force_rms", THRESHOLD, KIND)
SEEN_WORDS = ("verdict", "rattle_class")
MOST_ROWS = 100
# Share of a whole count below which its error is that of adding up.
ROUNDING = 1e-12
ERRORS = (
    "Behind \N{PLUS-MINUS SIGN} is the error that the program states, at least half a unit of the sixth "
    "digit; whole counts that are verified have none. A difference is none where it is no "
    "larger than both errors together; where no error is stated, than half a unit of the sixth digit of both."
)
ERRORS_OF_THRESHOLDS = "Of a threshold it is half the distance between the two scenes around it."


def document(variants: Sequence[Variant]) -> str:
    """The whole page."""
    title = f"{variants[0].name} and {'a variant' if len(variants) == 2 else f'{len(variants) - 1} variants'}"
    lead = LEAD.format(base=variants[0].name, others=_listed(variant.name for variant in variants[1:]))
    return page.document(title, [page.heading(1, title), page.paragraph(lead, "lead"), *parts(variants)])


def of_paths(paths: Sequence[Path]) -> list[str]:
    """The same parts for a page on results; none where these are not of one kind, or cannot be compared."""
    try:
        variants = read_variants(paths)
        said = parts(variants)
    except (CommandError, SummaryError):
        return []
    words = f"{variants[0].name} beside {_listed(variant.name for variant in variants[1:])}"
    return [page.heading(2, words), *said]


def parts(variants: Sequence[Variant]) -> list[str]:
    """All that is said of variants, the first of which is the base."""
    base, *others = variants
    notes = [page.paragraph(f"{words}.", "note") for other in others for words in unpaired(base, other)]
    versions = {result.program_version for variant in variants for result in variant.results}
    if len(versions) > 1:
        words = f"They were solved by different versions of rattle: {_listed(sorted(versions))}."
        notes.append(page.paragraph(words, "note"))
    answer = _motions(base, others) if base.task == "motion" else _tables(base, others)
    return [*notes, *answer]


def _inputs(base: Variant, others: Sequence[Variant]) -> list[str]:
    """The inputs that differ, and behind a fold what follows from them."""
    entries = [entry for other in others for entry in input_differences(base, other)]
    given = [entry for entry in entries if entry.part == "input"]
    heading = page.heading(2, "What differs in the inputs")
    if given:
        seen = [heading, _input_table(given, others)]
    else:
        seen = [heading, page.paragraph("Nothing: every key has the same value.")]
    tables = tables_named([base, *others])
    if tables:
        words = f"Tables are compared by their names, not by their contents: {_listed(tables)}."
        seen.append(page.paragraph(words, "note"))
    follows = [entry for entry in entries if entry.part == "follows"]
    if follows:
        seen += page.fold("What follows from the inputs", [_input_table(follows, others)])
    return seen


def _input_table(entries: Sequence[Difference], others: Sequence[Variant]) -> str:
    """A row for each key, a column for each variant."""
    rows: dict[tuple[str, str], dict[str, Difference]] = {}
    for entry in entries:
        rows.setdefault((entry.name, entry.gear), {})[entry.variant] = entry
    lines = []
    for (name, gear), of_variant in rows.items():
        first = next(iter(of_variant.values()))
        cells = [
            _with_change(of_variant[other.name]) if other.name in of_variant else page.Cell("as the base")
            for other in others
        ]
        lines.append([page.code(name), gear or "all", _shown(first.base, first.unit), *cells])
    kinds = ("", "", "number", *("number" for _ in others))
    return page.table(("Key", "Gear", "Base", *(other.name for other in others)), lines, kinds=kinds)


def _with_change(entry: Difference) -> page.Cell:
    change = f"<br>{_signed(entry.percent, '%')}" if entry.percent is not None else ""
    if entry.change is not None and not change:
        change = f"<br>{_signed(entry.change, page.UNIT_WORDS.get(entry.unit, entry.unit))}"
    return page.Cell(f"{_shown(entry.value, entry.unit)}{change}")


# Of single motions.


def _motions(base: Variant, others: Sequence[Variant]) -> list[str]:
    entries = [entry for other in others for entry in answer_differences(base, other)]
    seen = [entry for entry in entries if entry.name in SEEN and entry.part == "answer"]
    seen += [entry for entry in entries if entry.part == "together"]
    # Of what differs in one variant the others are shown too, alike or not.
    changed = {(entry.gear, entry.name) for entry in entries if not entry.same}
    rest = [
        entry
        for entry in entries
        if entry.part == "answer" and entry.name not in SEEN and (entry.gear, entry.name) in changed
    ]
    sentences = [words for other in others for words in _sentences(other, seen, entries)]
    differs = any(not entry.same for entry in entries)
    head = "The answer differs" if differs else "The answer does not differ"
    forces = _forces(base, others)
    drawn = []
    if forces:
        words = {
            (entry.variant, entry.gear or "pair"): entry.words or _signed(entry.decibel, "dB", html=False)
            for entry in entries
            if entry.name == "film_force_rms" and entry.part == "answer"
        }
        drawn = [
            page.drawing(
                lambda: picture.draw_forces(forces, words),
                "What each gear pair loads its bearings with; at the bars of a variant its change.",
                f"{base.name} variants forces",
            )
        ]
    table = _answer_table(seen, others, {**SEEN, **TOGETHER})
    folds = page.fold(
        "All other quantities that differ", [_answer_table(rest, others, _meanings(rest))] if rest else []
    )
    return [
        page.verdict_box(head, None, sentences, doubt=False),
        *drawn,
        *_inputs(base, others),
        page.heading(2, "What differs in the answer"),
        table,
        page.paragraph(ERRORS, "note"),
        *folds,
    ]


def _sentences(other: Variant, seen: Sequence[Difference], entries: Sequence[Difference]) -> Iterator[str]:
    """What a variant does to the verdicts, and to the film force: together, or of each pair."""
    own = [entry for entry in seen if entry.variant == other.name]
    verdicts = [entry for entry in own if entry.name == "verdict"]
    changed: dict[tuple[object, object], list[str]] = {}
    for entry in (entry for entry in verdicts if not entry.same):
        changed.setdefault((entry.base, entry.value), []).append(entry.gear)
    for (before, after), gears in changed.items():
        whose = f"{_listed(gears)} {'has' if len(gears) == 1 else 'have'}" if any(gears) else "the pair has"
        yield f"{other.name}: {whose} {after or 'no verdict'} instead of {before or 'no verdict'}."
    if verdicts and not changed:
        yield f"{other.name}: {'every verdict' if len(verdicts) > 1 else 'the verdict'} is that of the base."
    forces = [entry for entry in own if entry.name == UNCORRELATED and entry.part == "together"]
    forces = forces or [entry for entry in own if entry.name == "film_force_rms"]
    for entry in forces:
        whose = (
            "The film force of all pairs, if independent," if entry.part == "together" else "The film force"
        )
        of_gear = f" of {entry.gear}" if entry.gear else ""
        if entry.change is None:
            continue
        ends = f"from {page.plain(entry.base, 'N', 4)} to {page.plain(entry.value, 'N', 4)} rms"
        if entry.same:
            force = page.plain(entry.base, "N", 4)
            yield f"{whose}{of_gear} does not differ beyond the errors ({force} rms)."
        else:
            change = ", ".join(
                filter(None, (_signed(entry.percent, "%", False), _signed(entry.decibel, "dB", False)))
            )
            yield f"{whose}{of_gear} goes {ends} ({change})."
    if all(entry.same for entry in entries if entry.variant == other.name):
        yield "No quantity differs beyond the errors."


def _forces(base: Variant, others: Sequence[Variant]) -> dict[str, dict[str, float]]:
    """Film force rms by variant and gear, where it is known."""
    gears = {name: name or "pair" for name in base.pairs}
    found: dict[str, dict[str, float]] = {
        base.name: {
            gears[gear]: float(solved.summary["film_force_rms"])
            for gear, solved in base.pairs.items()
            if "film_force_rms" in solved.summary
        }
    }
    for other in others:
        found[other.name] = {
            gears[pair.gear]: float(pair.other.summary["film_force_rms"])
            for pair in paired(base, other)
            if "film_force_rms" in pair.other.summary
        }
    return found if all(found.values()) else {}


def _answer_table(
    entries: Sequence[Difference], others: Sequence[Variant], words: Mapping[str, str | page.Cell]
) -> str:
    """Rows by gear and quantity; of each variant its value and its change."""
    rows: dict[tuple[str, str, str], dict[str, Difference]] = {}
    for entry in entries:
        rows.setdefault((entry.part, entry.gear, entry.name), {})[entry.variant] = entry
    order = list(words)
    keys = sorted(rows, key=lambda key: order.index(key[2]))
    groups = dict.fromkeys((part, gear) for part, gear, _ in rows)
    lines: list[list[str]] = []
    for part, gear in groups:
        if len(groups) > 1:
            lines.append(
                ["All pairs together" if part == "together" else f"Gear {gear}" if gear else "The pair"]
            )
        for key in (key for key in keys if key[:2] == (part, gear)):
            of_variant = rows[key]
            first = next(iter(of_variant.values()))
            line = [words[key[2]], _with_error(first.base, first.base_error, first.unit)]
            for other in others:
                own = of_variant.get(other.name)
                line += [_with_error(own.value, own.error, own.unit), _change(own)] if own else ["-", "-"]
            lines.append(line)
    heads = ["Quantity", "Base"]
    for other in others:
        heads += [other.name, "Change"]
    return page.table(heads, lines, kinds=("", *("number" for _ in heads[1:])), kind="dense")


def _meanings(entries: Iterable[Difference]) -> dict[str, page.Cell]:
    return {
        entry.name: page.named(entry.name, QUANTITIES[entry.name].meaning.replace("`", ""))
        for entry in entries
    }


def _with_error(value: Any, error: float | None, unit: str) -> page.Cell:
    if error is None or value is None or isinstance(value, str | bool):
        return _shown(value, unit)
    if float(value).is_integer() and error <= ROUNDING * abs(value):
        return _shown(value, unit)
    factor = next((factor for least, factor, _ in page.STEPS.get(unit, ()) if abs(value) >= least), 1.0)
    bound = page.value(factor * reported_error(error, float(value)), "", 2)  # in the unit of the value
    return page.Cell(f"{_shown(value, unit)}<br>&plusmn;&nbsp;{bound}")


def _change(entry: Difference) -> page.Cell:
    """'none', the change in percent and dB, or what it is in the unit where the base is 0."""
    if entry.words:
        return page.Cell(entry.words)
    if entry.change is None:
        return page.Cell("differs" if None not in (entry.base, entry.value) else "one side only")
    if entry.name.startswith("impacts_per") or _kind(entry.name) == "count":
        return page.Cell(_signed(entry.change, ""))
    changes = [_signed(entry.percent, "%"), _signed(entry.decibel, "dB")]
    if entry.name == THRESHOLD:
        changes.insert(0, _signed(entry.change, page.UNIT_WORDS.get(entry.unit, entry.unit)))
    sign = "+" if entry.change > 0.0 else ""
    return page.Cell("<br>".join(filter(None, changes)) or f"{sign}{page.value(entry.change, entry.unit, 3)}")


def _kind(name: str) -> str:
    return QUANTITIES[name].kind if name in QUANTITIES else ""


def _shown(value: object, unit: str) -> page.Cell:
    return page.Cell("-") if value is None else page.value(value, unit)


def _signed(number: float | None, unit: str, html: bool = True) -> str:
    """As in '-12.3 %': three digits, with a sign; nothing for no number."""
    if number is None:
        return ""
    words = f"{number:+.3g}" if unit != "dB" else f"{number:+.2f}"
    return f"{words.replace('-', chr(0x2212))}{('&nbsp;' if html else ' ') if unit else ''}{unit}"


# Of campaigns, sweeps and thresholds.


def _tables(base: Variant, others: Sequence[Variant]) -> list[str]:
    compared = [compared_rows(base, other) for other in others]
    sentences = [words for one in compared for words in _sentences_on_rows(base.task, one)]
    differs = any(bool(one.differs(name).any()) for one in compared for name in one.quantities)
    head = "The answer differs" if differs else "The answer does not differ"
    seen = [page.verdict_box(head, None, sentences, doubt=False)]
    inputs = _inputs(base, others)
    for one, other in zip(compared, others, strict=True):
        if base.task == "campaign":
            seen += _maps(base, other)
        name = one.other.name
        seen += [*inputs, page.heading(2, f"What differs in the answer: {name}"), *_tables_of(base.task, one)]
        inputs = []
    return seen


def _sentences_on_rows(task: str, one: Compared) -> Iterator[str]:
    name, count = one.other.name, one.rows[0].size
    what = {"campaign": "scenes", "sweep": "motions", "threshold": "traces and crossings"}[task]
    yield f"{name}: {count} {what} stand at the same values of {_listed(map(short_name, one.base.keys))}."
    alone = [
        f"{table.name} alone has {rest} more"
        for table in (one.base, one.other)
        if (rest := len(table.places) - count)
    ]
    if alone:
        yield f"{_listed(alone)}."
    for quantity in one.quantities:
        if quantity not in SAID:
            continue
        where = one.differs(quantity)
        yield f"{look.capital(short_name(quantity))} differs at {int(where.sum())} of {count}."


def _tables_of(task: str, one: Compared) -> list[str]:
    if task == "threshold":
        return [_thresholds_table(one), page.paragraph(f"{ERRORS} {ERRORS_OF_THRESHOLDS}", "note")]
    words = [name for name in one.quantities if one.is_word(name) and one.differs(name).any()]
    seen = [name for name in words if name in SEEN_WORDS]
    rest = [name for name in words if name not in SEEN_WORDS]
    without = [name for name in one.quantities if not one.is_word(name) and not one.has_errors(name)]
    note = ERRORS
    if without:
        note += f" No error was recorded of {_listed(map(short_name, without))}."
    return [
        *_pairs_table(one),
        *_words_table(one, seen),
        *page.fold("Numbers that differ", [_numbers_table(one), page.paragraph(note, "note")]),
        *page.fold("Other words that differ", _words_table(one, rest)),
    ]


def _pairs_table(one: Compared) -> list[str]:
    """Of each gear pair, or of all rows: with impacts in how many, and by how much the film force differs."""
    gears = one.base.keys.get(GEAR)
    named = np.array(["all"] * len(one.base.places)) if gears is None else gears
    here = named[one.rows[0]]
    has_verdict, has_force = ("verdict" in one.quantities, "film_force_rms" in one.quantities)
    if not (has_verdict or has_force):
        return []
    lines = []
    for gear in dict.fromkeys(here.tolist()):
        own = here == gear
        line = [gear, str(int(own.sum()))]
        if has_verdict:
            impacts = [np.array(["impacts" in word for word in side]) for side in one.values("verdict")]
            line += [str(int(side[own].sum())) for side in impacts]
        if has_force:
            levels = one.levels("film_force_rms")[own]
            known = levels[np.isfinite(levels)]
            ends = (np.median(known), known.min(), known.max()) if known.size else (None, None, None)
            line += [page.Cell(_signed(end, "dB") or "-") for end in ends]
        lines.append(line)
    heads = ["Gear", "Rows", *(["With impacts: base", one.other.name] if has_verdict else [])]
    heads += ["Film force: median", "lowest", "highest change"] if has_force else []
    return [page.table(heads, lines, kinds=("", *["number"] * (len(heads) - 1)), kind="dense")]


def _words_table(one: Compared, names: Sequence[str]) -> list[str]:
    """Which words became which others, and in how many rows."""
    rows = [
        [look.capital(short_name(name)), before, after, str(count)]
        for name in names
        for (before, after), count in one.changes(name).most_common()
    ]
    heads = ("", "Base", one.other.name, "Rows")
    return [page.table(heads, rows, kinds=("", "", "", "number"))] if rows else []


def _numbers_table(one: Compared) -> str:
    """Of each number that both recorded: how many rows differ, by how much in the middle and at most."""
    lines = []
    for name in (name for name in one.quantities if not one.is_word(name)):
        where, percent, levels = one.differs(name), one.percent(name), one.levels(name)
        line = [page.code(name), str(int(where.sum())), str(one.lacking(name))]
        if not where.any():
            lines.append([*line, "none", "none", "-"])
            continue
        numbers, unit = (levels, "dB") if np.isfinite(levels[where]).any() else (percent, "%")
        known = np.flatnonzero(where & np.isfinite(numbers))
        if not known.size:
            lines.append([*line, "-", "-", "-"])
            continue
        widest = known[np.argmax(np.abs(numbers[known]))]
        middle = _signed(float(np.median(numbers[known])), unit)
        lines.append(
            [*line, page.Cell(middle), page.Cell(_signed(float(numbers[widest]), unit)), _place(one, widest)]
        )
    heads = ("Quantity", "Rows that differ", "One side only", "Median of these", "Largest", "at")
    return page.table(heads, lines, kinds=("", *["number"] * 4, ""), kind="dense")


def _thresholds_table(one: Compared) -> str:
    lines = []
    unit = one.base.units[THRESHOLD]
    for place in range(min(one.rows[0].size, MOST_ROWS)):
        sides = []
        for table, rows in zip((one.base, one.other), one.rows, strict=True):
            sides += [table.columns[name][rows[place]] for name in (THRESHOLD, f"{THRESHOLD}_error", KIND)]
        base, base_error, kind, value, error, other = sides
        known = [None if np.isnan(number) else float(number) for number in (base, value, base_error, error)]
        entry = Difference(one.other.name, "", "answer", THRESHOLD, unit, *known)
        became = kind if kind == other else f"{kind}; variant: {other}"
        cells = [
            _with_error(*pair, unit) for pair in ((entry.base, entry.base_error), (entry.value, entry.error))
        ]
        change = _change(entry) if not (entry.base is None and entry.value is None) else page.Cell("-")
        lines.append([_place(one, place), became, *cells, change])
    heads = ("At", "From, to", "Base", one.other.name, "Change")
    return page.table(heads, lines, kinds=("", "", *["number"] * 3), kind="dense")


def _place(one: Compared, place: int) -> page.Cell:
    """The values of the keys of a row."""
    row = one.rows[0][place]
    words = [
        f"{short_name(key)} {values[row]}"
        if values.dtype == object
        else f"{short_name(key)} {page.value(float(values[row]), one.base.units.get(key, ''), 4)}"
        for key, values in one.base.keys.items()
    ]
    return page.Cell(", ".join(words))


def _maps(base: Variant, other: Variant) -> list[str]:
    one, two = base.results[0], other.results[0]
    assert isinstance(one, Campaign) and isinstance(two, Campaign)
    columns = [look.loudest(one, name) for name in DRAWN if name in one and name in two]
    return [
        page.drawing(
            partial(picture.draw_maps, one, two, column),
            f"{look.capital(short_name(column))} of the base, {base.name}, and of the variant, {other.name}, "
            "in one scale, and what differs. What is not verified is hatched in the map of each alone.",
            f"{base.name} {other.name} {column}",
        )
        for column in columns
        if column in one and column in two
    ]


def _listed(words: Iterable[str]) -> str:
    *rest, last = words
    return f"{', '.join(rest)} and {last}" if rest else last
