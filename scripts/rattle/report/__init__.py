"""One page on results of any task, for readers who never saw the program."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path

import rattle
from rattle.campaign_result import Campaign
from rattle.codes import QUANTITIES, words_of
from rattle.figures import film, film_points, ranks
from rattle.report import (
    asked,
    campaign,
    comparison,
    countermeasures,
    motion,
    page,
    sensitivity,
    sweep,
    threshold,
)
from rattle.report.limits import Limits
from rattle.result import MOTIONS_ENDING, Result, read
from rattle.result_file import ResultFile
from rattle.summary import Summary, comparison_table, input_warnings, read_summary

ABOUT = (
    "A loose gear pair, shaken by the engine, hammers through its oil film. This page says {what}, and how "
    "far that can be trusted. Computed with rattle."
)
OF_MOTIONS = "how the tooth pair moves under the force given here, how it rattles"
OF_THRESHOLDS = "where the tooth pair begins to move in another way"
EARLIER_TABLE = (
    "The table is that of an earlier version of rattle, which does not say how the film forces of all pairs "
    "add; solve the input again to know that."
)
COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
# What is seen, and what stands behind folds.
Parts = tuple[list[str], list[str]]
# How film forces of several pairs add: in the table of all pairs, in words, and in the picture.
SUMS = {
    "film_force_rms_uncorrelated": ("if their forces are independent", "together, independent"),
    "film_force_rms_in_phase": ("in phase", "together, in phase"),
}
FILM_CAPTIONS = {
    "figure_03": "Pressure in the film between the flanks, oil of constant viscosity.",
    "figure_04a": "Stiffness of the film over its thickness.",
    "figure_04b": "Damping of the film over its thickness.",
    "figure_05": "Pressure in the film between the flanks, oil that thickens under pressure.",
}


def report(paths: Sequence[Path], *, brief: bool = False, limits: Limits | None = None) -> str:
    """The page on all results, in the order given; a brief one prints without its appendix.

    `limits`: film forces [N rms] that gear pairs, by their names, are to keep.
    """
    limits = limits or {}
    # What the table of all motions of a scene tells, the part on the scene does.
    paths = [path for path in paths if not path.name.endswith(MOTIONS_ENDING)] or paths
    results = [opened(path) for path in paths]
    names = [path.name.removesuffix(".rattle") for path in paths]
    boxes = gearboxes(results)
    if len(boxes) == 1 and len(next(iter(boxes.values()))["gears"]) == len(names):
        name, box = next(iter(boxes.items()))
        title = f"Rattle of {name}"
        body = [page.heading(1, title), *page_of_box(results, names, box, limits)]
        return page.document(title, body, brief=brief)
    title = f"Rattle of {names[0]}" if len(names) == 1 else f"Rattle of {len(names)} results"
    what = OF_THRESHOLDS if {result.task for result in results} == {"threshold"} else OF_MOTIONS
    body = [page.heading(1, title)]
    if len(results) > 1:
        body += [*overview(results, names, boxes), *comparison.of_paths(paths)]
    for place, (result, name) in enumerate(zip(results, names, strict=True), 1):
        if len(results) > 1:
            body.append(page.heading(1, name, f"result-{place}"))
        body += part(result, name, limits)
    return page.document(title, [*body, page.paragraph(ABOUT.format(what=what), "note")], brief=brief)


def page_of_box(
    results: Sequence[ResultFile], names: Sequence[str], box: Summary, limits: Limits
) -> list[str]:
    """All gear pairs of an input: verdict, forces, the severest in pictures; each pair behind a fold."""
    summaries = {
        gear: dict(found) | (motion.summary_of(result) or {})
        for result in results
        for gear, found in box["gears"].items()
        if result.path.name == f"{box['name']}.{gear}.rattle"
    }
    for gear, found in box["gears"].items():
        summaries.setdefault(gear, dict(found))
    forces = forces_of(summaries)
    gears = [result.input["gear"] for result in results if "gear" in result.input]
    advice, folds = countermeasures.part(results[0].path.parent, str(box["name"]), summaries)
    named = [one for one in summaries.values() if "name" in one]
    folds = [*folds, *page.fold("Side by side", side_by_side(named))]
    for place, (result, name) in enumerate(zip(results, names, strict=True), 1):
        folds += page.fold(name, part(result, name, limits), f"result-{place}")
    return [
        page.paragraph(asked.operating_point(results[0], gears), "lead"),
        *box_verdict(summaries, box, limits),
        *rank_figure(summaries, box, limits),
        pairs_table(summaries, limits),
        *severest_pair(results, box, forces),
        *advice,
        *box_sections(results, summaries, box),
        page.paragraph(ABOUT.format(what=OF_MOTIONS), "note"),
        *page.appendix(folds),
    ]


def box_verdict(summaries: Mapping[str, Summary], box: Summary, limits: Limits) -> list[str]:
    """How many pairs rattle, how sure that is, and how hard they load the bearings."""
    known = {gear: one for gear, one in summaries.items() if "verdict" in one}
    hit = [gear for gear, one in known.items() if "impacts" in str(one["verdict"])]
    flags = [one.get("verdict_verified") for one in known.values()]
    all_flags = False if False in flags else None if None in flags or len(flags) < len(summaries) else True
    badge = motion.VERIFIED_VERDICT[all_flags]
    head = f"{len(hit)} of {len(summaries)} gear pairs have impacts"
    forces = forces_of(summaries)
    above = [gear for gear in forces if forces[gear] > limits.get(gear, float("inf"))]
    more = f"Above the limit: {', '.join(above)}." if above else "All keep their limits." if limits else ""
    return [page.verdict_box(head, badge, [sum_words(summaries, box), more], doubt=badge[0] == "doubt")]


def sum_words(summaries: Mapping[str, Summary], box: Summary) -> str:
    """How hard all pairs load the bearings together, or the severest where that is not known."""
    forces = forces_of(summaries)
    sums = [f"{float(box[key]):.3g} N {{}}{words}" for key, (words, _) in SUMS.items() if key in box]
    if len(sums) == len(SUMS):
        count = COUNTS[len(summaries)] if len(summaries) < len(COUNTS) else str(len(summaries))
        together = ", ".join(sums).format("rms ", "")
        return f"The {count} pairs together load the bearings with {together}."
    if not forces:
        return ""
    severest = max(forces, key=forces.get)
    return f"{severest} is the most severe: it loads its bearings with {forces[severest]:.3g} N rms."


def rank_figure(summaries: Mapping[str, Summary], box: Summary, limits: Limits) -> list[str]:
    forces = forces_of(summaries)
    if not forces:
        return []
    verdicts = {gear: str(one.get("verdict", "")).strip() for gear, one in summaries.items()}
    together = {words: float(box[key]) for key, (_, words) in SUMS.items() if key in box}
    kept = {gear: limit for gear, limit in limits.items() if gear in forces}
    caption = (
        "Fluctuation of the film force that each pair loads the bearings with, the hardest first; "
        "colours: what the tooth does." + (" Strokes: limits." if kept else "")
    )
    return [
        page.drawing(lambda: ranks.draw(forces, verdicts, together, kept), caption, f"{box['name']} ranks")
    ]


def pairs_table(summaries: Mapping[str, Summary], limits: Limits) -> str:
    """The pairs, the hardest first: verdict, force, impacts by flank, approach, inertia, and how sure."""
    forces = forces_of(summaries)
    heads = ["Pair", "Verdict", "Film force, rms", *(["Limit"] if limits else [])]
    heads += ["Impacts a period, drive / coast", "Approach velocity", "Inertia ratio", "How sure"]
    rows = []
    for gear in sorted(summaries, key=lambda gear: -forces.get(gear, -1.0)):
        one = summaries[gear]
        # Tables of earlier versions tell of double-sided impacts alone.
        earlier = {True: "double-sided impacts", False: "no double-sided impacts"}
        verdict = str(one.get("verdict", earlier.get(one.get("double_sided"), "-"))).strip()
        limit = [page.value(limits[gear], "N", page.FEW_DIGITS) if gear in limits else "-"] if limits else []
        impacts = [one.get(f"impacts_per_period_{flank}") for flank in ("drive", "coast")]
        counts = " / ".join("-" if count is None else f"{count:.3g}" for count in impacts)
        speeds = [
            one[name] for flank in ("drive", "coast") if (name := f"impact_velocity_maximum_{flank}") in one
        ]
        speed = page.value(float(max(speeds)), "m/s", 3) if speeds else "-"
        sure = motion.VERIFIED_VERDICT[one.get("verdict_verified")][1] if "verdict" in one else "-"
        motions = int(one.get("motions", 1))
        sure += f"; {motions} motions" if motions > 1 else ""
        force = number_of(one, "film_force_rms")
        rows.append([gear, verdict, force, *limit, counts, speed, number_of(one, "inertia_ratio"), sure])
    kinds = ["", "", "number", *(["number"] if limits else []), "number", "number", "number", ""]
    return page.table(heads, rows, kinds=kinds, kind="dense")


def severest_pair(results: Sequence[ResultFile], box: Summary, forces: Mapping[str, float]) -> list[str]:
    """Pictures of the gear pair that loads its bearings most."""
    gear = max(forces, key=forces.get) if forces else ""
    for result in results:
        if gear and result.path.name == f"{box['name']}.{gear}.rattle":
            drawn = motion.figures(result, motion.summary_of(result))
            return [page.heading(2, f"{gear}, the hardest, in pictures"), *drawn]
    return []


def box_sections(results: Sequence[ResultFile], summaries: Mapping[str, Summary], box: Summary) -> list[str]:
    """How sure, what would change it, and what to doubt; each sentence once, with the pairs it is about."""
    sure = by_pair({gear: motion.sure_sentences(one) for gear, one in summaries.items()})
    inputs = {result.path.name: result for result in results}
    doubts = by_pair(
        {
            gear: motion.doubts(one, motion.is_elastic(inputs[name]))
            for gear, one in summaries.items()
            if (name := f"{box['name']}.{gear}.rattle") in inputs
        }
    )
    added = f"Forces of the pairs, {box['film_force_text']}." if "film_force_text" in box else EARLIER_TABLE
    return [
        *page.section("How sure", sure),
        *page.section("What would change it", motion.change_sentences(summaries)),
        *page.section("What to doubt", [*doubts, added]),
        *odd_numbers_of(box, list(summaries.values())),
    ]


def by_pair(sentences: Mapping[str, Iterable[str]]) -> list[str]:
    """Each sentence once, behind the names of the pairs that it is about, where these are not all."""
    about: dict[str, list[str]] = {}
    for gear, lines in sentences.items():
        for line in lines:
            about.setdefault(line, []).append(gear)
    return [
        line if len(gears) == len(sentences) else f"{', '.join(gears)}: {line}"
        for line, gears in about.items()
    ]


def forces_of(summaries: Mapping[str, Summary]) -> dict[str, float]:
    """What each pair loads its bearings with [N rms], where it is known."""
    return {
        gear: float(summary["film_force_rms"])
        for gear, summary in summaries.items()
        if "film_force_rms" in summary
    }


def number_of(summary: Summary, name: str) -> str:
    return (
        page.value(float(summary[name]), QUANTITIES[name].unit, page.FEW_DIGITS) if name in summary else "-"
    )


def opened(path: Path) -> ResultFile:
    """A campaign as a campaign, everything else as a result."""
    result = read(path)
    return rattle.read_campaign(path) if result.task == "campaign" else result


def part(result: ResultFile, name: str, limits: Limits) -> list[str]:
    """All that is said of one result."""
    if isinstance(result, Campaign):
        parts = campaign_part(result)
    elif isinstance(result, Result) and result.row_count == 0:
        parts = ([page.paragraph("This result holds no row.", "note")], [])
    elif isinstance(result, Result) and result.path.name.endswith(MOTIONS_ENDING):
        parts = table_part(result)
    elif isinstance(result, Result):
        makers = {
            "motion": partial(motion_part, limits=limits),
            "sweep": sweep_part,
            "threshold": threshold_part,
            "film": film_part,
        }
        parts = makers.get(result.task, table_part)(result)
    unfinished = "This run was not finished when the page was written; what it had done so far is shown."
    parts, folds = parts
    return [
        page.paragraph(asked.operating_point(result), "lead"),
        *([] if result.closed else [page.paragraph(unfinished, "note")]),
        *parts,
        *motion.odd_numbers(result),
        *page.appendix(
            [
                *folds,
                *page.fold("What was asked", [page.paragraph(asked.in_short(result)), *asked.inputs(result)]),
                *page.fold("How it was computed", motion.computed(result, motion.summary_of(result))),
                *page.fold("How to compute it again", asked.repeat(result, name)),
            ]
        ),
    ]


# What is seen of a result of each task, and what stands behind folds.


def motion_part(result: Result, limits: Limits) -> Parts:
    summary = motion.summary_of(result)
    parts = [*motion.verdict(result, summary, limits), *motion.figures(result, summary)]
    if not summary:
        return parts, []
    advice, folds = countermeasures.part(result.path.parent, result.scene_name, {"": summary})
    folds = [*folds, *page.fold("Errors of the extremes", [motion.key_figures(summary)])]
    parts += [*motion.numbers(summary), *advice, *motion.sections(result, summary)]
    return parts, [*folds, *page.fold("All quantities", motion.quantities(result, summary))]


def sweep_part(result: Result) -> Parts:
    first, *others = sweep.sentences_on(result)
    parts = [*sweep.verdict(result, [first]), *sweep.figures(result), *sweep.numbers(result)]
    parts += page.section("What to doubt", others)
    folds = page.fold("What the classes mean", sweep.meanings(result))
    return parts, [*folds, *page.fold("All stretches of one class", sweep.tables(result))]


def threshold_part(result: Result) -> Parts:
    summary = motion.summary_of(result)
    parts = [*threshold.verdict(result), *threshold.figures(result), *threshold.numbers(result)]
    parts += page.section("How sure, and what to doubt", threshold.sentences_of(result, summary))
    folds = page.fold("What the classes mean", threshold.meanings(result))
    return parts, [*folds, *page.fold("All thresholds", threshold.tables(result))]


def campaign_part(result: Campaign) -> Parts:
    seen, others = campaign.figures(result)
    parts = [*campaign.verdict(result), *seen[:1], *campaign.numbers(result), *seen[1:]]
    parts += [
        *sensitivity.part(result),
        *page.section("How sure, and what to doubt", campaign.sentences_on(result)),
    ]
    folds = page.fold("What was varied", [campaign.keys_table(result)])
    folds += page.fold("What the classes mean", campaign.meanings(result))
    folds += page.fold("More pictures", others)
    return parts, [*folds, *page.fold("All quantities", campaign.tables(result))]


def film_part(result: Result) -> Parts:
    choice = film_points.Choice(None, None)
    drawn = [
        page.drawing(
            lambda maker=maker: maker(result.path, choice), FILM_CAPTIONS[stem], f"{result.path.stem} {stem}"
        )
        for _, stem, maker in film.FIGURES
    ]
    words = (
        f"The film at {result.row_count} points: load, stiffness and damping of the oil between the flanks."
    )
    seen, folds = table_part(result)
    return [page.paragraph(words), *drawn[:3], *seen], [*page.fold("More pictures", drawn[3:]), *folds]


def table_part(result: Result) -> Parts:
    """The range of every column, for tasks without a page of their own."""
    rows = [
        (name, QUANTITIES[name].meaning if name in QUANTITIES else "", result.units[name], result[name])
        for name in result.names
        if words_of(name) is None
    ]
    words = f"The range of each column of the result over its {result.row_count} rows."
    return [], page.fold("All columns", [page.paragraph(words, "note"), page.ranges(rows)])


def overview(results: Sequence[ResultFile], names: Sequence[str], boxes: Mapping[str, Summary]) -> list[str]:
    """Links to all parts, the pairs of gearboxes, and the summaries of motions side by side."""
    links = "".join(
        f'<a href="#result-{place}">{page.escape(name)}</a>' for place, name in enumerate(names, 1)
    )
    motions = [result for result in results if isinstance(result, Result) and result.task == "motion"]
    summaries = [summary for result in motions if (summary := motion.summary_of(result))]
    parts = [f"<nav>{links}</nav>"]
    for name, box in boxes.items():
        pairs = dict(box["gears"])
        parts += [page.heading(2, f"Gear pairs of {name}"), page.paragraph(sum_words(pairs, box))]
        parts.append(pairs_table(pairs, {}))
        parts += odd_numbers_of(box, summaries)
    return [*parts, *page.fold("Side by side", side_by_side(summaries))]


def side_by_side(summaries: Sequence[Summary]) -> list[str]:
    """The summaries of several motions in one table."""
    if len(summaries) < 2:
        return []
    head, *rows = comparison_table(summaries)
    for row in rows:
        row[0] = row[0].replace("[um]", "[\N{MICRO SIGN}m]").replace("/s2]", "/s\N{SUPERSCRIPT TWO}]")
    return [page.table(head, rows, kinds=["", *("number" for _ in summaries)])]


def gearboxes(results: Sequence[ResultFile]) -> dict[str, Summary]:
    """The tables of the program of all gear pairs of an input, by the name of the input."""
    paths = {
        result.path.with_name(result.path.name.removesuffix(f".{gear}.rattle") + ".summary.nml")
        for result in results
        if result.task == "motion" and (gear := str(result.input.get("gear", {}).get("name", "")).strip())
    }
    found = {
        path: summary
        for path in sorted(paths)
        if path.exists() and "gears" in (summary := read_summary(path))
    }
    names = [str(summary["name"]) for summary in found.values()]
    return {
        f"{path.resolve().parent.name}/{name}" if names.count(name) > 1 else name: summary
        for name, (path, summary) in zip(names, found.items(), strict=True)
    }


def odd_numbers_of(box: Summary, summaries: Sequence[Summary]) -> list[str]:
    """What is odd about the input of the gear pairs, each line once, with the pairs that it is about."""
    about: dict[str, list[str]] = {}
    for summary in summaries:
        gear = str(summary.get("gear", "")).strip()
        if gear in box["gears"] and str(summary["name"]).strip() == f"{box['name']}.{gear}":
            for line in input_warnings(summary):
                about.setdefault(line, []).append(gear)
    lines = [
        line if len(gears) == len(box["gears"]) else f"Gear {', '.join(gears)}: {line}"
        for line, gears in about.items()
    ]
    return motion.notes_on(lines)
