"""The page on all gear pairs of an input: verdict, forces, the severest in pictures."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from rattle.codes import QUANTITIES
from rattle.figures import ranks
from rattle.report import asked, countermeasures, motion, page, tolerance
from rattle.report.limits import Limits, excess
from rattle.report.reference import Reference
from rattle.result import Result
from rattle.result_file import ResultFile
from rattle.summary import Summary, comparison_table, input_warnings, read_summary

EARLIER_TABLE = (
    "The table is that of an earlier version of rattle, which does not say how the film forces of all pairs "
    "add; solve the input again to know that."
)
COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
# How film forces of several pairs add: in the table of all pairs, in words, and in the picture.
SUMS = {
    "film_force_rms_uncorrelated": ("if their forces are independent", "together, independent"),
    "film_force_rms_in_phase": ("in phase", "together, in phase"),
}


def page_of_box(
    results: Sequence[Result],
    box: Summary,
    limits: Limits,
    parts: Mapping[str, list[str]],
    reference: Reference | None = None,
) -> list[str]:
    """All gear pairs of an input: verdict, forces, the severest in pictures; `parts` stand behind folds."""
    summaries = {
        gear: {**found, **(motion.summary_of(result) or {})}
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
    for place, (name, part) in enumerate(parts.items(), 1):
        folds += page.fold(name, part, f"result-{place}")
    return [
        page.paragraph(asked.operating_point(results[0], gears), "lead"),
        *box_verdict(summaries, box, limits, reference, held_by(results, box, summaries)),
        *rank_figure(summaries, box, limits, reference),
        pairs_table(summaries, limits, reference),
        *severest_pair(results, box, forces),
        *advice,
        *box_sections(results, summaries, box),
        page.paragraph(page.ABOUT.format(what=page.OF_MOTIONS), "note"),
        *page.appendix(folds),
    ]


def held_by(
    results: Sequence[ResultFile], box: Summary, summaries: Mapping[str, Summary]
) -> list[tolerance.Held | str]:
    """How the verdict of each pair with a result holds within tolerances."""
    inputs = {result.path.name: result for result in results}
    return [
        tolerance.held(inputs[name], one)
        for gear, one in summaries.items()
        if (name := f"{box['name']}.{gear}.rattle") in inputs
    ]


def box_verdict(
    summaries: Mapping[str, Summary],
    box: Summary,
    limits: Limits,
    reference: Reference | None = None,
    held: Sequence[tolerance.Held | str] = (),
) -> list[str]:
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
    level = reference.together(box, summaries) if reference else ""
    words = [sum_words(summaries, box), level, more, *tolerance.short(held)]
    return [page.verdict_box(head, badge, words, doubt=badge[0] == "doubt")]


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
    severest = max(forces, key=lambda gear: forces[gear])
    return f"{severest} is the most severe: it loads its bearings with {forces[severest]:.3g} N rms."


def rank_figure(
    summaries: Mapping[str, Summary], box: Summary, limits: Limits, reference: Reference | None = None
) -> list[str]:
    forces = forces_of(summaries)
    if not forces:
        return []
    verdicts = {gear: str(one.get("verdict", "")).strip() for gear, one in summaries.items()}
    together = {words: float(box[key]) for key, (_, words) in SUMS.items() if key in box}
    kept = {gear: limit for gear, limit in limits.items() if gear in forces}
    levels = {gear: reference.level(gear, summaries[gear]) for gear in forces} if reference else {}
    caption = (
        "Fluctuation of the film force that each pair loads the bearings with, the hardest first; "
        "colours: what the tooth does."
        + (" Strokes: limits." if kept else "")
        + (f" Levels re {reference.name}." if reference else "")
    )
    name = f"{box['name']} ranks"
    return [page.drawing(lambda: ranks.draw(forces, verdicts, together, kept, levels), caption, name)]


def pairs_table(summaries: Mapping[str, Summary], limits: Limits, reference: Reference | None = None) -> str:
    """The pairs, the hardest first: verdict, force, impacts by flank, approach, inertia, and how sure."""
    forces = forces_of(summaries)
    heads = ["Pair", "Verdict", "Film force, rms", *(["Limit", "Over limit"] if limits else [])]
    heads += [f"re {reference.name}"] if reference else []
    heads += ["Impacts a period, drive / coast", "Approach velocity", "Inertia ratio", "How sure"]
    rows = []
    for gear in sorted(summaries, key=lambda gear: -forces.get(gear, -1.0)):
        one = summaries[gear]
        # Tables of earlier versions report of double-sided impacts alone.
        earlier: dict[bool | None, str] = {True: "double-sided impacts", False: "no double-sided impacts"}
        verdict = str(one.get("verdict", earlier.get(one.get("double_sided"), "-"))).strip()
        limit = []
        if limits:
            limit.append(page.value(limits[gear], "N", page.FEW_DIGITS) if gear in limits else "-")
            limit.append(excess(gear, forces.get(gear), limits))
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
        limit += [reference.level(gear, one)] if reference else []
        rows.append([gear, verdict, force, *limit, counts, speed, number_of(one, "inertia_ratio"), sure])
    kinds = ["", "", "number", *["number"] * (2 * bool(limits) + bool(reference))]
    kinds += ["number", "number", "number", ""]
    return page.table(heads, rows, kinds=kinds, kind="dense")


def severest_pair(results: Sequence[Result], box: Summary, forces: Mapping[str, float]) -> list[str]:
    """Pictures of the gear pair that loads its bearings most."""
    gear = max(forces, key=lambda gear: forces[gear]) if forces else ""
    for result in results:
        if gear and result.path.name == f"{box['name']}.{gear}.rattle":
            drawn = motion.figures(result, motion.summary_of(result))
            return [page.heading(2, f"{gear}, the hardest, in pictures"), *drawn]
    return []


def box_sections(results: Sequence[Result], summaries: Mapping[str, Summary], box: Summary) -> list[str]:
    """How sure, what would change it, and what to doubt; each sentence once, with the pairs it is about."""
    inputs = {result.path.name: result for result in results}
    sure = by_pair(
        {
            gear: [
                *(tolerance.sentences(inputs[name], one) if name in inputs else []),
                *motion.sure_sentences(one),
            ]
            for gear, one in summaries.items()
            for name in [f"{box['name']}.{gear}.rattle"]
        }
    )
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
