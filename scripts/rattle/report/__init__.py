"""One page on results of any task, for readers who never saw the program."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import rattle
from rattle.campaign_result import Campaign
from rattle.codes import QUANTITIES, words_of
from rattle.counts import counted
from rattle.figures import film, film_points
from rattle.report import (
    asked,
    campaign,
    comparison,
    countermeasures,
    gearbox,
    motion,
    page,
    sensitivity,
    sweep,
    threshold,
)
from rattle.report.limits import Limits
from rattle.report.reference import Reference
from rattle.result import MOTIONS_ENDING, Result, read
from rattle.result_file import ResultFile
from rattle.summary import Summary

# What is seen, and what stands behind folds.
Parts = tuple[list[str], list[str]]
FILM_CAPTIONS = {
    "figure_03": "Pressure in the film between the flanks, oil of constant viscosity.",
    "figure_04a": "Stiffness of the film over its thickness.",
    "figure_04b": "Damping of the film over its thickness.",
    "figure_05": "Pressure in the film between the flanks, oil that thickens under pressure.",
}


def report(
    paths: Sequence[Path],
    *,
    brief: bool = False,
    limits: Limits | None = None,
    reference: Reference | None = None,
) -> str:
    """The page on all results, in the order given; a brief one prints without its appendix.

    `limits`: film forces [N rms] that gear pairs, by their names, are to keep. `reference`: what they are
    measured by, in dB.
    """
    limits = limits or {}
    # What the table of all motions of a scene shows, the part on the scene does.
    paths = [path for path in paths if not path.name.endswith(MOTIONS_ENDING)] or paths
    results = [opened(path) for path in paths]
    names = [path.name.removesuffix(".rattle") for path in paths]
    boxes = gearbox.gearboxes(results)
    if len(boxes) == 1 and len(next(iter(boxes.values()))["gears"]) == len(names):
        name, box = next(iter(boxes.items()))
        title = f"Rattle of {name}"
        parts = {
            name: part(result, name, limits, reference) for result, name in zip(results, names, strict=True)
        }
        pairs = [result for result in results if isinstance(result, Result)]
        body = [page.heading(1, title), *gearbox.page_of_box(pairs, box, limits, parts, reference)]
        return page.document(title, body, brief=brief)
    title = f"Rattle of {names[0]}" if len(names) == 1 else f"Rattle of {len(names)} results"
    what = page.OF_THRESHOLDS if {result.task for result in results} == {"threshold"} else page.OF_MOTIONS
    body = [page.heading(1, title)]
    if len(results) > 1:
        body += [*overview(results, names, boxes, reference), *comparison.of_paths(paths)]
    for place, (result, name) in enumerate(zip(results, names, strict=True), 1):
        if len(results) > 1:
            body.append(page.heading(1, name, f"result-{place}"))
        body += part(result, name, limits, reference)
    return page.document(title, [*body, page.paragraph(page.ABOUT.format(what=what), "note")], brief=brief)


def opened(path: Path) -> ResultFile:
    """A campaign as a campaign, everything else as a result."""
    result = read(path)
    return rattle.read_campaign(path) if result.task == "campaign" else result


def part(result: ResultFile, name: str, limits: Limits, reference: Reference | None = None) -> list[str]:
    """All that is said of one result."""
    if isinstance(result, Campaign):
        seen, folds = campaign_part(result)
    elif isinstance(result, Result) and result.row_count == 0:
        seen, folds = [page.paragraph("This result holds no row.", "note")], []
    elif isinstance(result, Result) and result.path.name.endswith(MOTIONS_ENDING):
        seen, folds = table_part(result)
    elif isinstance(result, Result):
        makers: dict[str, Callable[[Result], Parts]] = {
            "motion": partial(motion_part, limits=limits, reference=reference),
            "sweep": sweep_part,
            "threshold": threshold_part,
            "film": film_part,
        }
        seen, folds = makers.get(result.task, table_part)(result)
    unfinished = "This run was not finished when the page was written; what it had done by then is shown."
    return [
        page.paragraph(asked.operating_point(result), "lead"),
        *([] if result.closed else [page.paragraph(unfinished, "note")]),
        *seen,
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


def motion_part(result: Result, limits: Limits, reference: Reference | None = None) -> Parts:
    summary = motion.summary_of(result)
    parts = [*motion.verdict(result, summary, limits, reference), *motion.figures(result, summary)]
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
        page.drawing(partial(maker, result.path, choice), FILM_CAPTIONS[stem], f"{result.path.stem} {stem}")
        for _, stem, maker in film.FIGURES
    ]
    points = counted(result.row_count, "point")
    words = f"The film at {points}: load, stiffness and damping of the oil between the flanks."
    seen, folds = table_part(result)
    return [page.paragraph(words), *drawn[:3], *seen], [*page.fold("More pictures", drawn[3:]), *folds]


def table_part(result: Result) -> Parts:
    """The range of every column, for tasks without a page of their own."""
    rows = [
        (name, QUANTITIES[name].meaning if name in QUANTITIES else "", result.units[name], result[name])
        for name in result.names
        if words_of(name) is None
    ]
    words = f"The range of each column of the result over its {counted(result.row_count, 'row')}."
    return [], page.fold("All columns", [page.paragraph(words, "note"), page.ranges(rows)])


def overview(
    results: Sequence[ResultFile],
    names: Sequence[str],
    boxes: Mapping[str, Summary],
    reference: Reference | None = None,
) -> list[str]:
    """Links to all parts, the pairs of gearboxes, and the summaries of motions side by side."""
    links = "".join(
        f'<a href="#result-{place}">{page.escape(name)}</a>' for place, name in enumerate(names, 1)
    )
    motions = [result for result in results if isinstance(result, Result) and result.task == "motion"]
    summaries = [summary for result in motions if (summary := motion.summary_of(result))]
    parts = [f"<nav>{links}</nav>"]
    for name, box in boxes.items():
        pairs = dict(box["gears"])
        parts += [page.heading(2, f"Gear pairs of {name}"), page.paragraph(gearbox.sum_words(pairs, box))]
        parts.append(gearbox.pairs_table(pairs, {}, reference))
        parts += gearbox.odd_numbers_of(box, summaries)
    return [*parts, *page.fold("Side by side", gearbox.side_by_side(summaries))]
