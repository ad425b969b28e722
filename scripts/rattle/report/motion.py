"""What a report says of one motion; every number is one of its summary."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from rattle.codes import QUANTITIES, STATUSES, SUCCESSES, spoken
from rattle.figures import histories, period, spectra, style
from rattle.keys import unit_of
from rattle.report import page, tolerance
from rattle.report.limits import Limits
from rattle.report.limits import words as limit_words
from rattle.report.reference import Reference
from rattle.result import Result
from rattle.result_file import ResultFile
from rattle.summary import RESULTS, Summary, input_warnings, read_summary
from rattle.verdict import forced

SHOWN_PERIODS = 4  # of a motion without a summary
HARMONICS_SHOWN = 12
# Keys of a summary that are no quantities: what they are, and their unit.
COMPUTED = {
    "program_version": ("Version of rattle", ""),
    "law": ("Film law", ""),
    "model": ("Film model: published, the formulas of the paper; reynolds, those of rigid flanks", ""),
    "speed_used": ("Speed that the film was computed with", "m/s"),
    "speed_meaning": ("That speed is", ""),
    "acceleration_meaning": ("Accelerations are", ""),
    "status_time": ("Time at which the run ended", "s"),
    "film_at_status_time": ("Film at that time", "m"),
    "wall_seconds": ("Time that the computation took", "s"),
    "force_orders": ("Harmonics of the force", ""),
}
ERRORS = {
    "film_minimum": "film_minimum_error",
    "film_maximum": "film_maximum_error",
    "acceleration_minimum": "acceleration_minimum_error",
    "acceleration_maximum": "acceleration_maximum_error",
}
# What is said of each class, behind what the tooth does: how its acceleration sounds, whatever makes it.
# Words in braces are numbers of summary or input.
CLASSES = {
    "quiet": "quiet by its sound: what its acceleration adds to harmonics of the force is small, "
    "a harmonic distortion of {harmonic_distortion}, below the limit of {quiet_limit}.",
    "creep": "creep rattle by its sound: {lines} of the acceleration are above {threshold}, fewer than "
    "the {idle_harmonics} from which on it is idle rattle.",
    "idle": "idle rattle by its sound, which reaches far up in frequency: {lines} of the acceleration are "
    "above {threshold}; {idle_harmonics} or more make it idle rattle.",
    "irregular": "irregular rattle by its sound: no period of the motion is like the one before. A share of "
    "{irregular_fraction} of the "
    "power of the acceleration lies off the harmonics of the force; {irregular_limit} is the limit.",
    "irregular_so_far": "irregular so far by its sound: no period of the motion is like the one before, but "
    "it may settle. A share of {irregular_fraction} of the power of the acceleration lies off the harmonics "
    "of the force.",
    "subharmonic": "subharmonic rattle by its sound: the motion repeats, but {repeat}.",
}
# The same words without numbers, for several motions.
CLASS_MEANINGS = {
    "quiet": "The acceleration has little beside the orders of the force.",
    "creep": "Few harmonics of the acceleration stand out.",
    "idle": "Many harmonics of the acceleration stand out: a sound that reaches far up in frequency.",
    "irregular": "No period of the motion is like the one before, and neighbouring motions diverge.",
    "irregular so far": "The motion did not repeat as long as it was followed, and it may settle.",
    "subharmonic": "The motion repeats only after several periods of the force.",
}
REGIMES = {
    "iso-viscous": "The pressure in the film hardly thickens the oil (iso-viscous regime).",
    "piezo-viscous": "The pressure in the film thickens the oil, and the flanks keep their shape "
    "(piezo-viscous regime).",
    "elastohydrodynamic": "The pressure in the film is too high for flanks that keep their shape: either no "
    "piezo-viscous film exists between them, or they flatten by more than a tenth of the film "
    "(elastohydrodynamic regime).",
}
CONTRADICTED = (
    "The film law of this scene ({law}) is not the one of that regime. What is said here is true within "
    "the model; "
    "whether the model holds at this load is another question."
)
LIMITS = {
    "too_wide": "The film grows beyond a tenth of the radius, where the model of a line contact ends.",
    "too_narrow": "The film falls below 1 nm, where no oil film is left.",
    "too_wide_and_narrow": "The film grows beyond a tenth of the radius and falls below 1 nm, where the "
    "model ends.",
}
OUTSIDE_CLOSURE = (
    "Loads, oil or pressures leave the range that the closure of the elastohydrodynamic film was fitted to."
)
STABILITIES = {"unstable": "A periodic motion was found, but it is unstable: small disturbances grow."}
# By how much teeth deflect under the largest load, by whether they are elastic and whether that matters.
STIFFNESS = {
    (
        False,
        True,
    ): "The teeth of this scene are rigid, which is no fair assumption: steel ones would deflect by "
    "{share} of the film.",
    (
        False,
        False,
    ): "The teeth of this scene are rigid, which is a fair assumption: steel ones would deflect by "
    "{share} of the film.",
    (
        True,
        True,
    ): "The teeth deflect by {share} of the film, which this scene takes into account; "
    "rigid ones would be no fair assumption.",
    (
        True,
        False,
    ): "The teeth deflect by {share} of the film; rigid ones would be a fair assumption as well.",
}
# What the verdict on separation and impacts says.
VERDICTS = {
    "no separation": "The tooth stays on its drive flank",
    "separation": "The tooth leaves its drive flank, without an impact",
    "impacts without separation": "The tooth floats and falls back on its film, never leaving it",
    "single-sided impacts": "The tooth hits one flank",
    "double-sided impacts": "The tooth hits both flanks of its gap",
}
# The verification is of the numbers, not of the model: that stands with the word wherever it stands alone.
VERIFIED = "numerically verified"
VERIFIED_VERDICT = {True: ("good", VERIFIED), False: ("doubt", "uncertain"), None: ("open", "not examined")}
# The numbers that everybody should see, in their order, and what they are.
NUMBERS = {
    "film_force_rms": "Film force on the bearings, rms about its mean",
    "impacts_per_period_drive": "Impacts a period on the drive flank",
    "impacts_per_period_coast": "Impacts a period on the coast flank",
    "impact_velocity_maximum_drive": "Largest approach velocity, drive flank",
    "impact_velocity_maximum_coast": "Largest approach velocity, coast flank",
    "impact_load_maximum_drive": "Largest impact on the drive flank",
    "impact_load_maximum_coast": "Largest impact on the coast flank",
    "inertia_ratio": "Inertia over drag (above 1 the tooth leaves its flank without oil)",
    "drag_torque": "Drag torque on the loose gear",
    "acceleration_rms": "Acceleration, rms",
    "acceleration_maximum": "Acceleration, largest",
    "gear_acceleration_rms": "Angular acceleration of the loose gear, rms",
    "film_minimum": "Thinnest film",
    "acceleration_minimum": "Acceleration, least",
    "film_maximum": "Thickest film",
    "dissipated_power": "Power that films and teeth take",
    "alpha_p_maximum": "Largest pressure times the pressure-viscosity coefficient",
    "harmonic_count": "Harmonics of the acceleration that stand out",
    "natural_frequency": "Natural frequency of small motions",
}


def summary_of(result: ResultFile) -> Summary | None:
    return read_summary(result.summary_path) if result.summary_path.exists() else None


def odd_numbers(result: ResultFile) -> list[str]:
    """What the program found odd about the input, as numbers that were surely meant in another unit."""
    return notes_on(input_warnings(summary_of(result) or {}))


def notes_on(lines: Iterable[str]) -> list[str]:
    return [page.paragraph(f"{line[:1].upper()}{line[1:]}.", "note") for line in lines]


def verdict(
    result: Result, summary: Summary | None, limits: Limits, reference: Reference | None = None
) -> list[str]:
    """The verdict, its verification, the class with its own, and how hard it is."""
    if summary is None:
        words = f"No summary stands beside {result.path.name}: its class and errors are not known here."
        return [page.verdict_box("No verdict", None, [words], doubt=True)]
    sentences = list(verdict_sentences(summary, limits, reference))
    sentences += tolerance.short([tolerance.held(result, summary)])
    word = spoken(str(summary.get("rattle_class", "no class")).strip())
    badge = badge_of(summary)
    ended = str(summary["status"]).strip() in _ended_well()
    doubt = not ended or badge[0] == "doubt"
    if "verdict" not in summary:
        return [page.verdict_box(word, badge, sentences, doubt=doubt)]
    head = str(summary["verdict"]).strip()
    own = VERIFIED_VERDICT[summary.get("verdict_verified")]
    second = (f"Class: {word}", badge)
    return [page.verdict_box(head, own, sentences, doubt=doubt or own[0] == "doubt", second=second)]


def badge_of(summary: Summary) -> tuple[str, str]:
    """What the verification of the class says, in a word."""
    verification = str(summary.get("verification", "")).strip()
    if not verification:
        return "open", "not examined"
    return ("good", VERIFIED) if verification == "verified" else ("doubt", verification)


def verdict_sentences(summary: Summary, limits: Limits, reference: Reference | None = None) -> Iterator[str]:
    """What the tooth does, how often it hits, and how hard."""
    if str(summary["status"]).strip() not in _ended_well():
        yield f"The run did not reach its end ({summary['status']}). {summary.get('status_text', '')}".strip()
    verdict = VERDICTS.get(str(summary.get("verdict", "")).strip())
    if not verdict and summary.get("double_sided"):
        # Of a version that knew no impacts.
        verdict = "The coast film carries more than the drive film at times: the tooth crosses its gap"
    parts = [": ".join(filter(None, (verdict, impact_words(summary))))] if verdict else []
    if "film_force_rms" in summary:
        force = float(summary["film_force_rms"])
        gear = str(summary.get("gear", "")).strip()
        level = reference.words(gear, summary) if reference else ""
        size = f"film force on the bearings {force:.3g} N rms"
        parts.append(", ".join(filter(None, (size, level, limit_words(gear, force, limits)))))
    if parts:
        sentence = "; ".join(parts)
        yield f"{sentence[0].upper()}{sentence[1:]}."


def impact_words(summary: Summary) -> str:
    """As in '3 impacts a period on the drive flank, 2 on the coast flank'; nothing without impacts."""
    words: list[str] = []
    for flank in ("drive", "coast"):
        count = summary.get(f"impacts_per_period_{flank}", 0.0)
        if count > 0.0:
            noun = "" if words else " impact a period" if count == 1.0 else " impacts a period"
            words.append(f"{count:.3g}{noun} on the {flank} flank")
    return ", ".join(words)


def sections(result: Result, summary: Summary) -> list[str]:
    """What stands below the figures: sound, how sure, what would change it, what to doubt."""
    sound = list(sound_sentences(result, summary))
    sure = [*tolerance.sentences(result, summary), *sure_sentences(summary)]
    return [
        *page.section("How it sounds", sound),
        *page.section("How sure", sure),
        *page.section("What would change it", change_sentences({"": summary})),
        *page.section("What to doubt", list(doubts(summary, is_elastic(result)))),
        *page.section("Film and teeth", list(model_sentences(summary, is_elastic(result)))),
    ]


def sound_sentences(result: Result, summary: Summary) -> Iterator[str]:
    word = str(summary.get("rattle_class", "")).strip()
    if word in CLASSES:
        sound = CLASSES[word].format_map(_words(result, summary))
        yield sound[0].upper() + sound[1:]


def sure_sentences(summary: Summary) -> Iterator[str]:
    if "verification" in summary:
        yield str(summary.get("verification_text", "")).strip()
    elif str(summary.get("rattle_class", "")).strip():
        yield (
            "The scene was not solved a second time, so nothing is known of how far its class can be trusted."
        )
    periods, stability = summary.get("orbit_period"), str(summary.get("orbit_stability", "")).strip()
    if periods and stability and stability not in STABILITIES:
        every = "every period" if periods == 1 else f"every {periods} periods"
        yield f"A periodic motion was found: it repeats {every} of the force ({stability})."
    if summary.get("starts_solved", 1) > 1 and summary.get("motions", 1) <= 1:
        yield f"From other starts: {str(summary['motions_text']).strip()}."


def change_sentences(summaries: Mapping[str, Summary]) -> list[str]:
    """How far inertia and drag of gears are from keeping teeth on their flanks."""
    ratios = {
        gear: float(one["inertia_ratio"])
        for gear, one in summaries.items()
        if float(one.get("inertia_ratio", 0.0)) > 0.0
    }
    if not ratios:
        return []
    found = ", ".join(f"{gear} {ratio:.2f}".strip() for gear, ratio in ratios.items())
    return [
        f"Inertia over drag: {found}. Below 1 a tooth stays on its flank, or on the film there; "
        "more drag, less inertia of the loose gear or a calmer shaft lowers it."
    ]


def is_elastic(result: Result) -> bool:
    """Whether the teeth of a scene deflect."""
    return result.input.get("contact", {}).get("stiffness", 0.0) > 0.0


def doubts(summary: Summary, elastic: bool) -> Iterator[str]:
    """What speaks against the verdict, the most important first."""
    if summary.get("motions", 1) > 1:
        yield f"From other starts: {str(summary['motions_text']).strip()}."
    if summary.get("sampling_sufficient") is False:
        yield "There are too few samples a period for this motion: its harmonics are not those of the motion."
    if summary.get("orbit_period") and (
        words := STABILITIES.get(str(summary.get("orbit_stability")).strip())
    ):
        yield words
    if summary.get("law_contradicted"):
        yield from regime_sentences(summary)
    if summary.get("closure_range") == "outside":
        yield OUTSIDE_CLOSURE
    limit = LIMITS.get(str(summary.get("model_limit", "")).strip())
    if limit:
        yield limit
    if summary.get("stiffness_matters") and not elastic:
        yield from stiffness_sentences(summary, elastic)


def model_sentences(summary: Summary, elastic: bool) -> Iterator[str]:
    """What regime the film is in, and how far teeth deflect, where nothing of it is a doubt."""
    if not summary.get("law_contradicted"):
        yield from regime_sentences(summary)
    if elastic or not summary.get("stiffness_matters"):
        yield from stiffness_sentences(summary, elastic)


def stiffness_sentences(summary: Summary, elastic: bool) -> Iterator[str]:
    if "stiffness_matters" in summary and "deflection_share" in summary:
        share = float(summary["deflection_share"])
        words = f"{share:.3g} times the thickness" if share > 1.0 else f"{100.0 * share:.2g} %"
        yield STIFFNESS[elastic, bool(summary["stiffness_matters"])].format(share=words)


def class_meanings(words: Iterable[str]) -> str:
    """What the classes named mean."""
    rows = [[word, CLASS_MEANINGS[word]] for word in words if word in CLASS_MEANINGS]
    return page.table(("Class", "Meaning"), rows, kinds=("", "meaning"))


def regime_sentences(summary: Summary) -> Iterator[str]:
    sentence = REGIMES.get(str(summary.get("film_regime", "")).strip())
    if sentence:
        yield sentence
    if summary.get("law_contradicted"):
        yield CONTRADICTED.format(law=str(summary.get("law", "unknown")).strip())


def numbers(summary: Summary) -> list[str]:
    """The one table of numbers, those that are known."""
    rows = [
        [words, page.value(summary[name], QUANTITIES[name].unit, page.FEW_DIGITS)]
        for name, words in NUMBERS.items()
        if name in summary
    ]
    meaning = str(summary.get("acceleration_meaning", "")).strip()
    note = [page.paragraph(f"Accelerations are {meaning}.", "note")] if meaning else []
    return [*page.numbers(rows), *note] if rows else []


def figures(result: Result, summary: Summary | None) -> list[str]:
    """One period with its impacts, and the spectrum of the acceleration."""
    runs, labels = [result], style.run_labels([result])
    salt = result.scene_name
    over = (
        "over engine orders, multiples of the speed of the shaft"
        if result.shaft_speed
        else "at multiples of the frequency of the force"
    )
    relative = ", relative to the shaft" if result.has_gear else ""
    if summary:
        drawn = page.drawing(
            lambda: period.draw(result, summary, labels[0]),
            f"Film between the flanks and acceleration{relative}, over {period.words_of(result)}. Thin film: "
            "the flanks are close. Thick: the tooth is in flight. Triangles: impacts, pointing down on the "
            "drive flank, up on the coast flank.",
            f"{salt} period",
        )
    else:
        periods = min(SHOWN_PERIODS, result.whole_periods)
        drawn = page.drawing(
            lambda: histories.draw_film_and_force(runs, labels, periods),
            f"Film between the flanks under the applied force, over {period.words_of_last(periods)}.",
            f"{salt} film",
        )
    return [
        drawn,
        page.drawing(
            lambda: spectra.draw_acceleration(runs, labels, None),
            f"Harmonics of the acceleration{relative}, {over}. Those above the dashed line count for the "
            "class; dots are what the force itself brings.",
            f"{salt} spectrum",
        ),
    ]


def key_figures(summary: Summary) -> str:
    """The extremes of the motion with their errors."""
    rows = []
    for name, error in ERRORS.items():
        if name in summary:
            unit = QUANTITIES[name].unit
            known = page.error(summary[error], summary[name], unit) if error in summary else "not known"
            rows.append([_meaning(name).rstrip("."), page.value(summary[name], unit), known])
    extremes = page.table(("", "Value", "Error at most"), rows, kinds=("", "number", "number"))
    window = (
        f"The window is {period.words_of_last(summary['window_periods'])}."
        if "window_periods" in summary
        else ""
    )
    return extremes + (page.paragraph(window, "note") if window else "")


def quantities(result: Result, summary: Summary) -> list[str]:
    """Everything that the summary reports, with its meaning."""
    plain = [name for name in summary if name in QUANTITIES and not isinstance(summary[name], list)]
    return [explained(summary, plain), *harmonics(result, summary)]


def explained(summary: Summary, names: list[str]) -> str:
    """A table of quantities of the summary with their meanings."""
    rows = [[page.code(name), quantity(summary, name), _meaning(name)] for name in names]
    return page.table(
        ("Quantity", "Value", "Meaning"), rows, kinds=("", "number", "meaning"), kind="explained"
    )


def quantity(summary: Summary, name: str) -> page.Cell:
    """A quantity of the summary; an error as it belongs to its number, a relative one to 1."""
    unit = QUANTITIES[name].unit
    number, mark, _ = name.rpartition("_error")
    if mark:
        return page.error(summary[name], summary.get(number, 1.0), unit)
    return page.value(summary[name], unit)


def harmonics(result: Result, summary: Summary) -> list[str]:
    """The first lines of the acceleration, with the engine orders that they are where there is a shaft."""
    lines = np.atleast_1d(summary.get("harmonics", []))
    errors = np.atleast_1d(summary.get("harmonic_errors", []))
    if not lines.size:
        return []
    unit = QUANTITIES["harmonics"].unit
    rows = []
    for place, line in enumerate(lines[:HARMONICS_SHOWN].tolist()):
        error = page.error(errors[place], line, unit) if place < errors.size else "not known"
        number = place + 1
        order = [page.value(spectra.engine_order(result, number))] if result.shaft_speed else []
        rows.append([str(number), *order, page.value(line, unit), error])
    more = f"The summary lists {lines.size} of them." if lines.size > len(rows) else ""
    heads = ("Harmonic", *(["Engine order"] if result.shaft_speed else []), "Amplitude", "Error at most")
    return [
        page.heading(3, "Harmonics of the acceleration"),
        page.table(heads, rows, kinds=("", *("number" for _ in heads[1:]))),
        *([page.paragraph(more, "note")] if more else []),
    ]


def computed(result: ResultFile, summary: Summary | None) -> list[str]:
    """Version, method, accuracy and effort."""
    solver = result.input.get("solver", {})
    words = {
        "newmark": "Newmark's method as in the paper, with steps of equal length",
        "taylor": "series in time with controlled errors; the steps follow the motion",
    }
    rows = [["Version of rattle", page.value(result.program_version)]]
    if "method" in solver:
        method = str(solver["method"]).strip()
        rows.append(["Method", words.get(method, method)])
    for key, label, unit in (
        ("accuracy", "Relative accuracy of the film that was aimed at", ""),
        ("tolerance", "Tolerance of the iteration on the film", "m"),
        ("steps_per_period", "Steps in a period of the force", ""),
    ):
        if key in solver:
            rows.append([label, page.value(solver[key], unit)])
    for name, given in (summary or {}).items():
        if name in COMPUTED and name != "program_version":
            label, unit = COMPUTED[name]
            rows.append([label, page.value(given, unit)])
        elif name not in QUANTITIES and name not in (
            "name",
            "input_warnings",
            "motions_text",
            "program_version",
            "status_text",
            "verification",
            "verification_text",
            *RESULTS,
        ):
            rows.append([name.replace("_", " "), page.value(given, unit_of(name))])
    return [page.table(("", ""), rows, kinds=("", "number"))]


def _ended_well() -> set[str]:
    return {STATUSES[code] for code in SUCCESSES}


def _meaning(name: str) -> str:
    return QUANTITIES[name].meaning


def _words(result: Result, summary: Summary) -> dict[str, str]:
    """What the sentences on classes speak of."""
    count = summary.get("harmonic_count", 0)
    bound = "at least " if summary.get("harmonic_count_is_bound") else ""
    noun = "harmonic" if count == 1 else "harmonics"
    limits = result.input.get("spectrum", {})
    words: dict[str, str] = {
        name: f"{limits[name]:g}"
        for name in ("quiet_limit", "irregular_limit", "idle_harmonics")
        if name in limits
    }
    for name in ("harmonic_distortion", "irregular_fraction", "orbit_period"):
        words[name] = f"{summary[name]:.4g}" if name in summary else "unknown"
    words["repeat"] = f"only after {words['orbit_period']} periods of the force"
    if summary.get("orbit_period", 0) <= 1:
        words["repeat"] = (
            f"a share of {words['irregular_fraction']} of the power of the acceleration lies between the "
            "harmonics of the force"
        )
    largest = "the largest one of the force's own harmonics" if forced(result) else "the first"
    words["threshold"] = f"{100.0 * limits.get('harmonic_threshold', 0.0):g} % of {largest}"
    return words | {"lines": f"{bound}{count} {noun}"}
