"""What a report says of thresholds: what changes where, how far that stands, and what it took."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import numpy as np

from rattle.campaign_plan import GEAR
from rattle.campaign_section import short_name
from rattle.command import CommandError
from rattle.counts import counted
from rattle.figures import threshold as picture
from rattle.figures.campaign_look import capital
from rattle.figures.threshold_curves import LINES_SENTENCE
from rattle.report import motion, page
from rattle.result import Result
from rattle.rounding import stated_error
from rattle.summary import Summary
from rattle.thresholds import Thresholds, thresholds, words_of_criterion

MOST_ROWS = 100
MOST_KINDS = 12
KINDS = ("From, to", "Thresholds", "Least", "Largest", "Not verified")
BEGINNING = "no impacts to impacts"
MOST_SEEN = page.MOST_NUMBERS // (len(KINDS) - 1)


def verdict(result: Result) -> list[str]:
    """Where the most common change is, how many others there are, and how well they are known."""
    found = thresholds(result)
    crossed = found.column("crossing") > 0
    if not crossed.any():
        return [page.verdict_box("No threshold", None, [first_sentence(found)], doubt=False)]
    kind, count = Counter(found.kinds[crossed]).most_common(1)[0]
    values = found.values[crossed & (found.kinds == kind)]
    ends = [page.plain(float(end), found.range.unit, page.FEW_DIGITS) for end in (values.min(), values.max())]
    where = f"at {ends[0]}" if count == 1 else f"between {ends[0]} and {ends[1]}"
    head = f"Impacts begin {where}" if kind == BEGINNING else f"From {kind} {where}"
    lacking, total = int(found.uncertain.sum()), int(crossed.sum())
    sentences = [f"{counted(total, 'threshold')}, {count} of this kind."]
    if "verified_below" in result:
        sentences.append(f"{lacking} not numerically verified." if lacking else "All numerically verified.")
    return [page.verdict_box(head, None, sentences, doubt=lacking > 0)]


def sentences_of(result: Result, summary: Summary | None) -> list[str]:
    return list(sentences_on(thresholds(result), summary))


def first_sentence(found: Thresholds) -> str:
    """What was looked for, and where."""
    first, last = (page.plain(float(end), found.range.unit) for end in found.range.values)
    lines = int(np.unique(found.column("trace")).size)
    keys = " and ".join(map(short_name, found.varied))
    of_lines = "" if lines == 1 else f", on {lines} traces, one for each value of {keys}"
    return (
        f"Looked for: {words_of_criterion(found)}, along the {short_name(found.key)} from {first} to "
        f"{last}{of_lines}."
    )


def meanings(result: Result) -> list[str]:
    """What the classes are that change; nothing where no class does."""
    found = thresholds(result)
    if found.quantity != "rattle_class":
        return []
    return [motion.class_meanings(dict.fromkeys(name for kind in found.kinds for name in kind.split(" to ")))]


def numbers(result: Result) -> list[str]:
    """Of each pair where its changes are; the most common kinds, how many, least and largest."""
    found = thresholds(result)
    return [*pairs_of(found), *page.numbers(kinds_of(found), KINDS)]


def pairs_of(found: Thresholds) -> list[str]:
    """Of each gear pair where its most common change is least and largest; nothing without pairs."""
    if GEAR not in found.varied:
        return []
    crossed, gears = found.column("crossing") > 0, found.column(GEAR)
    others = [key for key in found.varied if key != GEAR]
    rows = []
    for gear in np.unique(gears):
        own = np.flatnonzero(crossed & (gears == gear))
        if not own.size:
            rows.append([found.words_of_value(GEAR, gear), "none", "-", "-"])
            continue
        kind = Counter(found.kinds[own]).most_common(1)[0][0]
        same = own[found.kinds[own] == kind]
        ends = same[[np.argmin(found.values[same]), np.argmax(found.values[same])]]
        cells = []
        for row in ends:
            at = " and ".join(found.words_of_value(key, float(found.column(key)[row])) for key in others)
            value = page.plain(float(found.values[row]), found.range.unit, page.FEW_DIGITS)
            cells.append(f"{value} at {at}" if at else value)
        rows.append([found.words_of_value(GEAR, gear), kind, *cells])
    kinds = ("", "", "number", "number")
    return [page.table(("Gear", "Change", "Least", "Largest"), rows, kinds=kinds, kind="dense")]


def sentences_on(found: Thresholds, summary: Summary | None) -> Iterator[str]:
    unit = found.range.unit
    crossed = found.column("crossing") > 0
    lines = int(np.unique(found.column("trace")).size)
    yield first_sentence(found)
    for kind, count in Counter(found.kinds[crossed]).most_common(3):
        values = found.values[crossed & (found.kinds == kind)]
        least, largest = (page.plain(float(end), unit) for end in (values.min(), values.max()))
        where = f"at {least}" if count == 1 else f"{count} times, between {least} and {largest}"
        yield f"From {kind}: {where}."
    if lines > 1 or not crossed.any():
        none = int((~crossed).sum())
        if none:
            many = (
                f"{none} of {lines} traces {'has' if none == 1 else 'have'} no"
                if lines > 1
                else "The trace has no"
            )
            yield f"{many} threshold in this range."
        else:
            yield "Every trace has a threshold in this range."
    if found.has_ends and crossed.any():
        either = int(found.either.sum())
        which = f"At {either} of {counted(int(crossed.sum()), 'threshold')} either side is possible beyond it"
        yield (
            f"{which}: motions of a side, followed from there, last on while those of the other exist. These "
            "thresholds are those of the motion from rest; on the way up a gear changes at last_below, on "
            "the way down at last_above."
            if either
            else "Followed along the key from their starts, the motions of both sides end at the thresholds."
        )
    if found.another_side.any():
        others = int(found.another_side.sum())
        having = counted(others, "trace without a threshold has", "traces without a threshold have")
        yield f"{having} motions on another side, from other starts: from last_above to last_below."
    if "verified_below" in found.result and crossed.any():
        sure = int(crossed.sum() - found.uncertain.sum())
        yield (
            f"At {sure} of {counted(int(crossed.sum()), 'threshold')} both ends are numerically verified: "
            "solved again, tighter, they are on the same side. "
            "Where that is not possible close to the change, its ends lie "
            "farther apart, and the distance between them is how well the threshold is known."
        )
    count = found.result.value("threshold", "count")
    halved = ""
    if crossed.any():
        widths = np.where(crossed, found.column("width"), 0.0)
        widest = int(np.argmax(widths))
        width = stated_error(float(widths[widest]), float(found.column("upper")[widest]), page.DIGITS)
        halved = (
            "; between neighbours that differ the gap was halved again and again; the widest that is left is "
            f"{page.plain(width, unit)}"
        )
    yield (
        f"{'Each trace' if lines > 1 else 'The trace'} was solved in {count} places{halved}. Two changes "
        "between neighbours that cancel each other are not seen."
    )
    if summary and "scenes" in summary:
        times = float(summary["scenes_of_a_grid"]) / float(summary["scenes"])
        yield f"It took {summary['scenes']} scenes; a grid as fine has {times:.3g} times as many."


def kinds_of(found: Thresholds) -> list[list[str]]:
    """Each kind of change, the most common first: how many, the least and the largest, and their doubts."""
    unit, crossed = found.range.unit, found.column("crossing") > 0
    rows = []
    for kind, count in Counter(found.kinds[crossed]).most_common(MOST_KINDS):
        places = np.flatnonzero(crossed & (found.kinds == kind))
        ends = places[[np.argmin(found.values[places]), np.argmax(found.values[places])]]
        numbers = [page.value(float(found.values[place]), unit) for place in ends]
        rows.append([kind, str(count), *numbers, str(int(found.uncertain[places].sum()))])
    return rows


def tables(result: Result) -> list[str]:
    """Each kind of change; then every threshold."""
    found = thresholds(result)
    unit, crossed = found.range.unit, found.column("crossing") > 0
    rows = kinds_of(found)
    parts = [page.table(KINDS, rows, kinds=("", *["number"] * 4))] if len(rows) > MOST_SEEN else []
    if result.row_count > MOST_ROWS:
        words = f"All {result.row_count} rows stand in the result file; the first {MOST_ROWS} are these."
        parts.append(page.paragraph(words, "note"))
    lines = []
    for row in range(min(result.row_count, MOST_ROWS)):
        axes = [found.words_of_value(key, float(found.column(key)[row])) for key in found.varied]
        lower, upper, width = (float(found.column(name)[row]) for name in ("lower", "upper", "width"))
        ends = [page.value(lower, unit), page.value(upper, unit), page.error(width, upper, unit)]
        kind = found.kinds[row] if crossed[row] else f"{found.kinds[row]} throughout"
        sure = "no" if found.uncertain[row] else "yes" if crossed[row] and "verified_below" in result else "-"
        lines.append([*axes, *(ends if crossed[row] else ["-"] * len(ends)), kind, sure])
    heads = (
        *(capital(short_name(key)) for key in found.varied),
        "Between",
        "And",
        "Width",
        "From, to",
        "Verified",
    )
    kinds = (*("number" for _ in found.varied), "number", "number", "number", "", "")
    return [*parts, page.table(heads, lines, kinds=kinds)]


def figures(result: Result) -> list[str]:
    caption = (
        "Thresholds over the varied keys. Bars: lower to upper; open marks: not numerically verified. "
        f"Shaded: the side that rattles, darker where several do. {LINES_SENTENCE}"
    )
    try:
        found, held = picture.cut(thresholds(result), {}, 2)
    except CommandError:
        return [page.paragraph("Thresholds of one trace, or of a sample of traces, have no curve.", "note")]
    return [page.drawing(lambda: picture.draw(found, held), caption, f"{result.scene_name} threshold")]
