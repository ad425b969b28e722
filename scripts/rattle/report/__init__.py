"""One page on results of any task, for readers who never saw the program."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import rattle
from rattle.campaign_result import Campaign
from rattle.codes import QUANTITIES, spoken, words_of
from rattle.figures import campaign_look as look
from rattle.figures import film, film_points
from rattle.report import asked, campaign, motion, page, sensitivity, sweep, threshold
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
# What is seen, and what stands behind folds.
Parts = tuple[list[str], list[str]]
# What of each gear pair everybody should see.
SEEN = ("film_force_rms", "acceleration_maximum", "film_minimum")
# Columns of the table of a gearbox.
TOGETHER = (
    "film_minimum",
    "acceleration_minimum",
    "acceleration_maximum",
    "acceleration_rms",
    "film_force_rms",
    "dissipated_power",
)
FILM_CAPTIONS = {
    "figure_03": "Pressure in the film between the flanks, oil of constant viscosity.",
    "figure_04a": "Stiffness of the film over its thickness.",
    "figure_04b": "Damping of the film over its thickness.",
    "figure_05": "Pressure in the film between the flanks, oil that thickens under pressure.",
}


def report(paths: Sequence[Path], *, brief: bool = False) -> str:
    """The page on all results, in the order given; a brief one prints without its appendix."""
    # What the table of all motions of a scene tells, the part on the scene does.
    paths = [path for path in paths if not path.name.endswith(MOTIONS_ENDING)] or paths
    results = [opened(path) for path in paths]
    names = [path.name.removesuffix(".rattle") for path in paths]
    boxes = gearboxes(results)
    if len(boxes) == 1 and len(next(iter(boxes.values()))["gears"]) == len(names):
        name, box = next(iter(boxes.items()))
        title = f"Rattle of the gear pairs of {name}"
        return page.document(title, [page.heading(1, title), *page_of_box(results, names, box)], brief=brief)
    title = f"Rattle of {names[0]}" if len(names) == 1 else f"Rattle of {len(names)} results"
    what = OF_THRESHOLDS if {result.task for result in results} == {"threshold"} else OF_MOTIONS
    body = [page.heading(1, title), page.paragraph(ABOUT.format(what=what), "lead")]
    if len(results) > 1:
        body += overview(results, names, boxes)
    for place, (result, name) in enumerate(zip(results, names, strict=True), 1):
        if len(results) > 1:
            body.append(page.heading(1, name, f"result-{place}"))
        body += part(result, name)
    return page.document(title, body, brief=brief)


def page_of_box(results: Sequence[ResultFile], names: Sequence[str], box: Summary) -> list[str]:
    """All gear pairs of an input: verdict, the severest in pictures, numbers; each pair behind a fold."""
    summaries = [summary for result in results if (summary := motion.summary_of(result))]
    words, table = together(box)
    others = [
        f"{gear}: {str(summary['motions_text']).strip()}."
        for gear, summary in box["gears"].items()
        if summary.get("motions", 1) > 1
    ]
    hit = [gear for gear, summary in box["gears"].items() if "impacts" in str(summary.get("verdict", ""))]
    verdicts = [
        f"{gear}: {str(summary['verdict']).strip()}"
        for gear, summary in box["gears"].items()
        if "verdict" in summary
    ]
    head = f"{len(hit)} of {len(box['gears'])} gear pairs have impacts"
    folds = page.fold("Gear pairs, each and together", [table])
    folds += page.fold("Side by side", side_by_side(summaries))
    for place, (result, name) in enumerate(zip(results, names, strict=True), 1):
        folds += page.fold(name, part(result, name), f"result-{place}")
    return [
        page.paragraph(ABOUT.format(what=OF_MOTIONS), "lead"),
        page.verdict_box(
            head, None, [f"{'; '.join(verdicts)}." if verdicts else "", *others, words], doubt=False
        ),
        *odd_numbers_of(box, summaries),
        *severest_pair(results, box),
        *page.appendix(folds),
    ]


def severest_pair(results: Sequence[ResultFile], box: Summary) -> list[str]:
    """Pictures of the gear pair that loads its bearings most, and the numbers of all pairs."""
    forces = forces_of(box)
    gear = max(forces, key=forces.get) if forces else ""
    drawn = []
    for result in results:
        if gear and result.path.name == f"{box['name']}.{gear}.rattle":
            drawn = [page.paragraph(f"{gear}, the most severe, in pictures:"), *motion.figures(result)]
    rows = [
        [gear, *(number_of(summary, name) for name in SEEN)]
        for gear, summary in sorted(box["gears"].items(), key=lambda pair: -forces.get(pair[0], -1.0))
    ]
    return [*drawn, *page.numbers(rows, ("Gear", *(look.capital(look.short_name(name)) for name in SEEN)))]


def forces_of(box: Summary) -> dict[str, float]:
    """What each pair loads its bearings with [N rms], where it is known."""
    return {
        gear: float(summary["film_force_rms"])
        for gear, summary in box["gears"].items()
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


def part(result: ResultFile, name: str) -> list[str]:
    """All that is said of one result."""
    if isinstance(result, Campaign):
        parts = campaign_part(result)
    elif isinstance(result, Result) and result.row_count == 0:
        parts = ([page.paragraph("This result holds no row, so there is nothing to tell of it.", "note")], [])
    elif isinstance(result, Result) and result.path.name.endswith(MOTIONS_ENDING):
        parts = table_part(result)
    elif isinstance(result, Result):
        makers = {"motion": motion_part, "sweep": sweep_part, "threshold": threshold_part, "film": film_part}
        parts = makers.get(result.task, table_part)(result)
    unfinished = "This run was not finished when the page was written; what it had done so far is shown."
    parts, folds = parts
    return [
        *([] if result.closed else [page.paragraph(unfinished, "note")]),
        *motion.odd_numbers(result),
        *parts,
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


def motion_part(result: Result) -> Parts:
    summary = motion.summary_of(result)
    parts = [*motion.verdict(result, summary), *motion.figures(result)]
    if not summary:
        return parts, []
    folds = page.fold("Errors of the extremes", [motion.key_figures(summary)])
    return [*parts, *motion.numbers(summary)], [
        *folds,
        *page.fold("All quantities", motion.quantities(result, summary)),
    ]


def sweep_part(result: Result) -> Parts:
    parts = [*sweep.verdict(result), *sweep.figures(result), *sweep.numbers(result)]
    folds = page.fold("What the classes mean", sweep.meanings(result))
    return parts, [*folds, *page.fold("All stretches of one class", sweep.tables(result))]


def threshold_part(result: Result) -> Parts:
    summary = motion.summary_of(result)
    parts = [*threshold.verdict(result, summary), *threshold.figures(result), *threshold.numbers(result)]
    folds = page.fold("What the classes mean", threshold.meanings(result))
    return parts, [*folds, *page.fold("All thresholds", threshold.tables(result))]


def campaign_part(result: Campaign) -> Parts:
    seen, others = campaign.figures(result)
    parts = [*campaign.verdict(result), *sensitivity.part(result), *seen, *campaign.numbers(result)]
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
        words, table = together(box)
        parts += [page.heading(2, f"Gear pairs of {name}"), page.paragraph(words), table]
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
    summaries = [read_summary(path) for path in sorted(paths) if path.exists()]
    return {str(summary["name"]): summary for summary in summaries if "gears" in summary}


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


def together(box: Summary) -> tuple[str, str]:
    """What the gear pairs of an input do, each and together: a sentence and a table."""
    heads = ("Gear", "Class", "Verdict", *(look.capital(look.short_name(name)) for name in TOGETHER))
    rows = []
    sums = {
        f"together, {word}": f"film_force_rms_{word.replace(' ', '_')}"
        for word in ("uncorrelated", "in phase")
    }
    together = [(words, {"film_force_rms": box[name]} if name in box else {}) for words, name in sums.items()]
    together[0][1].update({name: box[name] for name in ("dissipated_power",) if name in box})
    for gear, summary in (*box["gears"].items(), *together):
        # Tables of earlier versions tell of double-sided impacts alone.
        earlier = {True: "double-sided impacts", False: "no double-sided impacts"}
        verdict = str(summary.get("verdict", earlier.get(summary.get("double_sided"), "-")))
        numbers = [number_of(summary, name) for name in TOGETHER]
        rows.append([gear, spoken(str(summary.get("rattle_class", "-"))), verdict, *numbers])
    known = forces_of(box)
    words = EARLIER_TABLE
    if "film_force_text" in box:
        words = f"Of the film forces, which the bearings of the shaft feel, {box['film_force_text']}."
    if known:
        severest = max(known, key=known.get)
        words = (
            f"{severest} is the most severe: it loads its bearings with {known[severest]:.3g} N rms. {words}"
        )
    kinds = ("", "", "", *("number" for _ in TOGETHER))
    return words, page.table(heads, rows, kinds=kinds, kind="dense")
