"""What a report says of a campaign: how often each class is, how scenes ended, where it is worst."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np

from rattle import rerun
from rattle.campaign_plan import GEAR, GRID
from rattle.campaign_result import Campaign
from rattle.campaign_section import Section, new_section
from rattle.codes import QUANTITIES, spoken, word, words_of
from rattle.counts import counted
from rattle.figures import campaign_look as look
from rattle.figures import campaign_map, campaign_slice
from rattle.report import motion, onset, page

# Columns that are drawn where they are recorded, and what their picture shows.
DRAWN = {
    "verdict": "What the tooth does in its gap over the varied keys.",
    "rattle_class": "Class of the motion over the varied keys.",
    "film_force_rms": "Fluctuation of the force on the bearings of the shaft: how severe the rattle is.",
    "acceleration_maximum": "Largest acceleration: how hard the tooth is thrown back by the film.",
    "film_minimum": "Thinnest film: how close the flanks come.",
    "verified": "Whether the class is verified: a second solution with a tighter tolerance agrees.",
}
MOST_SEEN = 3
EXTRAPOLATED = (
    "In {scenes} the film is extrapolated: loads, oil or pressures are beyond what its closure is fitted to."
)
INSTEAD = " film.model = 'automatic' solves these in nodes, as 'resolved' does a single scene."
SURE = "All {} are numerically verified."
# The numbers that everybody should see beside the shares: columns, which end is worst, and words.
ENDS = (
    ("film_force_rms", np.max, "Largest film force on the bearings, rms"),
    ("acceleration_maximum", np.max, "Largest acceleration"),
    ("film_minimum", np.min, "Thinnest film"),
    ("alpha_p_maximum", np.max, "Largest pressure times the pressure-viscosity coefficient"),
)
WORST_BY = "acceleration_maximum"
WORST_COUNT = 10
EXTRA = ("rattle_class", "film_regime", "verified")


def verdict(campaign: Campaign) -> list[str]:
    """Where impacts begin and where they are worst; where no verdict is recorded the classes that occur."""
    classes = [name for name, _ in numbers_of_words(campaign, "rattle_class").most_common()]
    words = onset.headline(campaign) or look.capital(", ".join(classes)) or "No class"
    complete = campaign.done.all() and not campaign.failed.any()
    every = (
        f"All {campaign.row_count} scenes are solved." if campaign.row_count > 1 else "The scene is solved."
    )
    solved = every if complete else done_words(campaign)
    sure = sure_in_short(campaign)
    doubt = not complete or (sure != "" and not sure.startswith("All"))
    return [page.verdict_box(words, None, [solved, sure], doubt=doubt)]


def done_words(campaign: Campaign) -> str:
    """How many scenes are solved, and how many failed."""
    done, failed = int(campaign.done.sum()), int(campaign.failed.sum())
    are = "is" if done == 1 else "are"
    return f"{done} of {campaign.row_count} scenes {are} solved; {failed} of them failed."


def sure_in_short(campaign: Campaign) -> str:
    """How many verdicts, or classes where no verdict is recorded, do not hold when solved again."""
    flags, what = verdict_flags(campaign), "verdicts"
    if "verdict" not in campaign and "verified" in campaign:
        flags, what = campaign["verified"][campaign.done], "classes"
    lacking, known = int((flags == 0.0).sum()), int(np.isfinite(flags).sum())
    if not known:
        return ""
    return f"{lacking} of {known} {what} are not numerically verified." if lacking else SURE.format(what)


def meanings(campaign: Campaign) -> list[str]:
    counts = numbers_of_words(campaign, "rattle_class")
    return [motion.class_meanings(name for name, _ in counts.most_common())] if counts else []


def numbers(campaign: Campaign) -> list[str]:
    """How often each verdict or class is, and the worst of what is recorded; of several pairs a row each."""
    if len(campaign.gears) > 1 and len(campaign.pairs) > 1:
        return numbers_of_pairs(campaign)
    done = int(campaign.done.sum())
    rows = [["Scenes", str(done)], ["of these failed", str(int(campaign.failed.sum()))]]
    for column in ("verdict", "rattle_class"):
        for name, count in numbers_of_words(campaign, column).most_common():
            rows.append([look.capital(name), look.share(count, done)])
        if len(rows) > 2:
            break
    return page.numbers([*rows, *ends_of(campaign)])


def ends_of(campaign: Campaign) -> list[list[str]]:
    """The worst of each column that is recorded."""
    rows = [[words, end_of(campaign, name, end)] for name, end, words in ENDS if name in campaign]
    return [row for row in rows if row[1] != "-"]


def end_of(campaign: Campaign, name: str, end: Callable[[np.ndarray], float]) -> str:
    """The largest or the smallest of a column, failed scenes left out."""
    values = campaign[name][~campaign.failed]
    finite = values[np.isfinite(values)]
    return page.value(float(end(finite)), campaign.units[name], page.FEW_DIGITS) if finite.size else "-"


def numbers_of_pairs(campaign: Campaign) -> list[str]:
    """Of each gear pair where impacts begin, where they are hardest, and how sure that is."""
    pairs = dict(zip(campaign.gears, campaign.pairs, strict=True))
    if onset.impacts(campaign.pairs[0]) is None:
        ends = [end for end in ENDS if end[0] in campaign][:3]
        rows = [[gear, *(end_of(alone, name, end) for name, end, _ in ends)] for gear, alone in pairs.items()]
        return page.numbers(rows, ["Gear", *(words for _, _, words in ends)]) if ends else []
    rows = []
    for gear, alone in pairs.items():
        found = onset.worst(alone)
        force = [page.value(found[0], "N", page.FEW_DIGITS), found[1]] if found else ["-", "-"]
        flags = verdict_flags(alone)
        sure = f"{int((flags == 1.0).sum())} of {flags.size}" if flags.size else "-"
        rows.append([gear, onset.beginning(alone), *force, sure])
    heads = ("Gear", "Impacts begin", "Largest film force, rms", "at", "Verdicts numerically verified")
    return [page.table(heads, rows, kinds=("", "", "number", "", "number"), kind="dense")]


def verdict_flags(campaign: Campaign) -> np.ndarray:
    """Whether the verdict of each scene that is done is verified, where that is known."""
    if "verdict_verified" not in campaign:
        return np.zeros(0)
    flags = campaign["verdict_verified"][campaign.done]
    return flags[np.isfinite(flags)]


def sentences_on(campaign: Campaign) -> Iterator[str]:
    done = int(campaign.done.sum())
    yield done_words(campaign)
    if "verdict" in campaign:
        shares = [
            f"{name} in {count} ({look.share(count, done)})"
            for name, count in numbers_of_words(campaign, "verdict").most_common()
        ]
        yield f"Verdict: {', '.join(shares)}." if shares else "No scene has a verdict."
    if "motions" in campaign:
        several = int((campaign.done & (campaign["motions"] > 1.0)).sum())
        yield (
            f"{counted(several, 'scene has', 'scenes have')} several motions: numbers are those of "
            "the motion from rest, maps of verdict and class show the loudest and hatch such scenes "
            "crosswise."
        )
    if "verdict_verified" in campaign:
        flags = verdict_flags(campaign)
        others = int((flags == 0.0).sum())
        are = "is another" if others == 1 else "are others"
        yield f"Solved again, tighter, {others} of {flags.size} verdicts {are}."
    classes = numbers_of_words(campaign, "rattle_class")
    if classes:
        shares = [f"{name} in {count} ({look.share(count, done)})" for name, count in classes.most_common()]
        yield f"Class of the motion: {', '.join(shares)}."
    elif "rattle_class" in campaign:
        yield "No scene has a class."
    else:
        yield "The class was not recorded."
    if "verified" in campaign:
        verified, lacking = verifications(campaign)
        yield (
            f"The class is verified in {counted(verified, 'scene')}: solved again, tighter, it is the "
            "same, or both halves of an irregular motion agree. "
            f"{lacking} of {verified + lacking} scenes {'is' if lacking == 1 else 'are'} not verified."
        )
    else:
        yield "Whether the classes are the same when the scenes are solved again, tighter, was not recorded."
    if "closure_range" in campaign and np.isfinite(campaign["closure_range"]).any():
        count = int((campaign["closure_range"][campaign.done] == look.OUTSIDE).sum())
        yield EXTRAPOLATED.format(scenes=counted(count, "scene")) + (
            "" if "film_model" in campaign or not count else INSTEAD
        )
    elif "law_contradicted" in campaign:
        count = int((campaign["law_contradicted"][campaign.done] == 1.0).sum())
        scenes = counted(count, "scene")
        yield f"In {scenes} the film law is not the one of the regime that the motion reaches."
    elif "film_regime" in campaign:
        regimes = numbers_of_words(campaign, "film_regime").most_common()
        yield f"Regime of the film: {', '.join(f'{name} in {count}' for name, count in regimes)}."
    elif str(campaign.input.get("film", {}).get("law")).strip() == "elastohydrodynamic":
        yield "Whether the film is extrapolated beyond its closure was not recorded (closure_range)."
    for name, sentence in (
        (
            "model_limit",
            "In {scenes} the film leaves the range of the model: below 1 nm, or above a tenth of the radius.",
        ),
        (
            "stiffness_matters",
            "In {scenes} the teeth deflect, or if they are rigid those of steel would, by more than a "
            "tenth of the film: rigid teeth are no fair assumption there.",
        ),
        ("double_sided", "In {scenes} the tooth hits both flanks of its gap."),
    ):
        if name in campaign:
            count = int((campaign[name][campaign.done] >= 1.0).sum())
            yield sentence.format(scenes=counted(count, "scene"))


def verifications(campaign: Campaign) -> tuple[int, int]:
    """How many classes are verified, and how many are not."""
    flags = campaign["verified"][campaign.done]
    return int((flags == 1.0).sum()), int((flags == 0.0).sum())


def numbers_of_words(campaign: Campaign, column: str) -> Counter[str]:
    """How often each word of a column of codes is, over the scenes that are done and have one."""
    if column not in campaign:
        return Counter()
    codes = campaign[column][campaign.done]
    return Counter(spoken(word(column, code)) for code in codes[np.isfinite(codes)].tolist())


def figures(campaign: Campaign) -> tuple[list[str], list[str]]:
    """The pictures that everybody should see, of several pairs those of all together; and the others."""
    if len(campaign.pairs) == 1:
        drawn = figures_of_pair(campaign)
        return drawn[:MOST_SEEN], drawn[MOST_SEEN:]
    others = []
    for gear, alone in zip(campaign.gears, campaign.pairs, strict=True):
        if alone.done.any():
            others += [page.heading(3, f"Gear {gear}"), *figures_of_pair(alone)]
    if campaign.kind != GRID or len(campaign.pairs[0].varied) < 2:
        first = 1 + len(figures_of_pair(campaign.pairs[0])[:MOST_SEEN])
        return others[:first], others[first:]
    free = campaign.pairs[0].varied[:2]
    sections = {
        gear: new_section(alone, free, {})
        for gear, alone in zip(campaign.gears, campaign.pairs, strict=True)
        if alone.done.any()
    }
    names = [name for name in DRAWN if name in campaign][:MOST_SEEN]
    columns = {name: drawn_column(campaign, name) for name in names}
    return [
        page.drawing(
            partial(campaign_map.draw_pairs, sections, [columns[name]], campaign_map.Options()),
            caption(list(sections.values()), name),
            f"{campaign.name} pairs {columns[name]}",
            "main" if name == names[0] else "",
        )
        for name in names
    ], others


def caption(sections: Sequence[Section], column: str) -> str:
    """What a map shows, and of hatching and lines what is there."""
    parts = [DRAWN[column]]
    if column in ("verdict", "rattle_class"):
        name = drawn_column(sections[0].campaign, column)
        doubts = [doubt.words for one in sections for doubt in look.doubts(one.campaign, name)]
        gaps = [gap.words for one in sections for gap in look.gaps(one.campaign, name)]
        gaps += ["not done"] if not all(one.campaign.done.all() for one in sections) else []
        for words, hatched in (("Hatched", doubts), ("Hatched in grey", gaps)):
            if hatched:
                parts.append(f"{words}: {'; '.join(dict.fromkeys(hatched))}.")
    if column == "verdict":
        if any("film_force_rms" in one.campaign for one in sections):
            parts.append("Lines: film force on the bearings [N rms].")
        failing = [look.where_law_fails(one.campaign) for one in sections]
        if any(found is not None and found[0].any() for found in failing):
            fails = dict.fromkeys(found[1] for found in failing if found is not None)
            parts.append(f"Beyond the green line, on the side of its ticks, the {' or '.join(fails)}.")
    return " ".join(parts)


def drawn_column(campaign: Campaign, column: str) -> str:
    """What a map of a column shows: verdict and class of the loudest motion, where they are recorded."""
    return look.loudest(campaign, column) if column in ("verdict", "rattle_class") else column


def figures_of_pair(campaign: Campaign) -> list[str]:
    """Maps over the first two varied keys, or slices along the only one."""
    if campaign.kind == GRID and len(campaign.varied) == 1:
        columns = [name for name in DRAWN if name in campaign and name != "verified"]
        words = f"Along {look.short_name(campaign.varied[0])}. Crosses: scenes that failed."
        section = new_section(campaign, campaign.varied, {})
        draw = partial(campaign_slice.draw, section, columns)
        return [page.drawing(draw, words, f"{campaign.name} slice")]
    if len(campaign.varied) == 1:
        return [page.paragraph("A sample of one key only has no map.", "note")]
    x, y = campaign.varied[:2]
    drawn = []
    for column in DRAWN:
        if column not in campaign:
            continue
        options = campaign_map.Options(None if column in ("verdict", "rattle_class") else ())
        name = drawn_column(campaign, column)
        if campaign.kind == GRID:
            section = new_section(campaign, (x, y), {})
            words = caption([section], column)
            held = f" Held: {section.words}." if section.held else ""
            draw = partial(campaign_map.draw, section, name, options)
        else:
            words, held = DRAWN[column], ""
            draw = partial(campaign_map.draw_points, campaign, x, y, name, options)
        drawn.append(page.drawing(draw, words + held, f"{campaign.name} {name}"))
    return drawn


def keys_table(campaign: Campaign) -> str:
    """What was varied, and between which values."""
    rows = []
    for axis in campaign.axes:
        ends = (
            [page.value(float(end), axis.unit) for end in axis.values[[0, -1]]]
            if axis.values.size
            else ["-", "-"]
        )
        count = str(axis.values.size) if campaign.kind == GRID else "-"
        if axis.key == GEAR:
            ends = [campaign.gears[0], campaign.gears[-1]]
        rows.append([page.code(axis.key), *ends, axis.scale, count])
    kinds = ("", "number", "number", "", "number")
    return page.table(("Varied key", "First", "Last", "Scale", "Values"), rows, kinds=kinds)


def tables(campaign: Campaign) -> list[str]:
    """The worst scenes, and the range of every quantity."""
    parts = []
    if WORST_BY in campaign and np.isfinite(campaign[WORST_BY][campaign.done & ~campaign.failed]).any():
        parts += [page.heading(3, "Scenes with the largest acceleration"), worst(campaign)]
    kept = campaign.done & ~campaign.failed
    rows = [
        (name, QUANTITIES[name].meaning, campaign.units[name], campaign[name][kept])
        for name in campaign.names
        if name in QUANTITIES and words_of(name) is None
    ]
    return [*parts, page.heading(3, "Range of each quantity"), page.ranges(rows)]


def worst(campaign: Campaign) -> str:
    extra = [name for name in EXTRA if name in campaign]
    heads = [
        "Scene",
        *map(look.short_name, campaign.varied),
        look.short_name(WORST_BY),
        *map(look.short_name, extra),
    ]
    rows = []
    for row in rerun.extreme_rows(campaign, WORST_BY, WORST_COUNT):
        numbers = [
            campaign.gears[int(campaign[key][row]) - 1]
            if key == GEAR
            else page.value(float(campaign[key][row]), campaign.units[key])
            for key in (*campaign.varied, WORST_BY)
        ]
        rows.append(
            [
                str(int(campaign["scene"][row])),
                *numbers,
                *(spoken(word(name, campaign[name][row])) for name in extra),
            ]
        )
    kinds = ("number", *("number" for _ in campaign.varied), "number", *("" for _ in extra))
    return page.table(heads, rows, kinds=kinds)
