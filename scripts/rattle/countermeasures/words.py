"""A study in words: ranked tables and the sentences above them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rattle.codes import CODES
from rattle.countermeasures.levers import Lever
from rattle.countermeasures.scenes import UNKNOWN, Scenes
from rattle.countermeasures.study import ORDER, TARGETS, BoxMeasure, Measure, PairStudy, rattling
from rattle.countermeasures.table import gain_of_cost
from rattle.solve import literal
from rattle.table import markdown


def verdict_word(code: int) -> str:
    return CODES["verdict"].get(code, "no end reached")


def value_words(value: float, unit: str) -> str:
    """A value as engineers read it."""
    if unit == "kg m2":
        value, unit = value * 1e6, "kg mm2"
    elif unit == "m" and value != 0.0:
        value, unit = (value * 1e6, "um") if abs(value) < 1e-3 else (value * 1e3, "mm")
    number = f"{value:.3g}" if abs(value) < 999.5 else f"{value:.0f}"
    return f"{number}{'' if unit in ('', '-') else f' {unit}'}"


def change_words(lever: Lever, value: float) -> str:
    """A value with its distance from the present one."""
    words = value_words(value, lever.unit)
    if lever.unit == "degC":
        return f"{words} ({value - lever.now:+.3g} K)"
    return f"{words} ({100.0 * (value / lever.now - 1.0):+.0f} %)" if lever.now > 0.0 else words


def end_words(measure: Measure, name: str) -> str:
    """What it takes to end something; where nothing within the range does it, that."""
    if measure.note:
        return "-"
    if name not in measure.ends:
        return "not within"
    end, lever = measure.ends[name], measure.lever
    words = change_words(lever, end.value)
    words += f", to {value_words(end.until, lever.unit)}" if comes_back(measure, name) else ""
    if not end.confirmed:
        words += f"; not confirmed: {verdict_word(end.answer.verdict)}"
        words += f" of {end.answer.motions} motions" if end.answer.motions > 1 else ""
    return words


def comes_back(measure: Measure, name: str) -> bool:
    """Whether what is ended begins again before the end of the range."""
    until, lever = measure.ends[name].until, measure.lever
    return not (math.isclose(until, lever.first) or math.isclose(until, lever.last))


def cells(pair: PairStudy) -> list[list[str]]:
    """The ranked table of a pair, its head first; what it does not do now has no column."""
    kept = [name for name in TARGETS if name in pair.targets]
    rows = [["Change", "Now", "Range", *(f"No {name} from" for name in kept), "Effort", "Gain [dB]"]]
    for measure in pair.measures:
        lever = measure.lever
        ends = [value_words(end, lever.unit) for end in (lever.first, lever.last)]
        effort, gain = "-", "-"
        if measure.effort:
            value, answer = measure.effort
            effort = change_words(lever, value)
            gain = gain_words(-answer.change_db(pair.now), answer.error_db(pair.now))
        row = [lever.name, value_words(lever.now, lever.unit), " to ".join(ends)]
        rows.append([*row, *(end_words(measure, name) for name in kept), effort, gain])
    return rows


def gain_words(gain: float, error: float) -> str:
    """A gain with its error where that can be seen; one within its error is none."""
    if not math.isfinite(gain):
        return "-"
    if error >= 0.05:
        return f"{gain:.1f} +- {error:.1f}" if abs(gain) > error else f"none, +- {error:.1f}"
    return f"{gain:.1f}".replace("-0.0", "0.0")


def sentences(pair: PairStudy) -> list[str]:
    """What would stop a pair, in words."""
    now = pair.now
    motions = "one motion" if now.motions == 1 else f"{now.motions} motions"
    if now.verdict == UNKNOWN or not pair.targets:
        found = [
            f"{first_up(verdict_word(now.verdict))}, {now.force:.3g} N rms of film force: nothing is to end."
        ]
        return [*found, *_best_effort(pair)]
    found = [f"{first_up(verdict_word(now.verdict))}, {now.force:.3g} N rms of film force, {motions}."]
    for name in (name for name in ORDER if name in pair.targets):
        best = min(
            (m for m in pair.measures if name in m.ends and m.ends[name].confirmed),
            key=lambda measure: abs(measure.ends[name].share),
            default=None,
        )
        if best is None:
            found.append(f"Nothing within its range ends {name}.")
            continue
        end = best.ends[name]
        rest = f", {end.answer.motions} motions" if end.answer.motions > 1 else ""
        found.append(
            f"{first_up(name)} {'ends' if name == 'separation' else 'end'} with {best.lever.name} "
            f"at {change_words(best.lever, end.value)}: solved again, {verdict_word(end.answer.verdict)}, "
            f"{end.answer.change_db(now):+.1f} dB{rest}."
        )
        if comes_back(best, name):
            back = "it comes" if name == "separation" else "they come"
            found.append(f"Beyond {value_words(end.until, best.lever.unit)} {back} back.")
    return [*found, *_best_effort(pair)]


def first_up(words: str) -> str:
    return words[:1].upper() + words[1:]


def _best_effort(pair: PairStudy) -> list[str]:
    tried = [(measure, *measure.effort) for measure in pair.measures if measure.effort]
    if not tried:
        return []
    best, value, answer = min(tried, key=lambda one: one[2].force)
    gain = gain_words(-answer.change_db(pair.now), answer.error_db(pair.now))
    return [
        f"Of an effort of a tenth each, {best.lever.name} to {change_words(best.lever, value)} "
        f"gains {gain} dB."
    ]


def together_cells(scenes: Scenes, measures: Sequence[BoxMeasure]) -> list[list[str]]:
    """What is changed of all pairs at once, or of the only one, and what they do then."""
    before = scenes.together
    has_cost = any(math.isfinite(measure.cost) for measure in measures)
    is_box = len(scenes.pairs) > 1
    head = ["Pairs with impacts", "Uncorrelated [dB]", "In phase [dB]", "Confirmed"]
    head = head if is_box else ["Verdict", "Film force [dB]"]
    rows = [["Change", "Set", *head, *(["Cost", "Gain per cost [dB]"] if has_cost else [])]]
    for measure in measures:
        changes = [f"{change:+.1f}" for change in measure.result.change_db(before)]
        if is_box:
            confirmed = {None: "-", True: "yes", False: "no"}[measure.confirmed]
            numbers = [str(rattling(measure.result)), *changes, confirmed]
        else:
            numbers = [verdict_word(next(iter(measure.result.pairs.values())).verdict), changes[0]]
        row = [measure.name, _short_settings(measure), *numbers]
        if has_cost:
            gain = gain_of_cost(measure, before)
            row += [f"{number:.3g}" if math.isfinite(number) else "-" for number in (measure.cost, gain)]
        rows.append(row)
    return rows


def _short_settings(measure: BoxMeasure) -> str:
    return ", ".join(
        f"{key}={value:.4g}"
        if isinstance(value, float)
        else f"{key}={literal([float(f'{v:.4g}') for v in value])}"
        for key, value in measure.settings.items()
    )


def page(scenes: Scenes, pairs: Sequence[PairStudy], together: Sequence[BoxMeasure]) -> str:
    """Everything in words, as Markdown."""
    parts = [f"# What would stop the rattle of {scenes.name}"]
    for pair in pairs:
        parts += [f"## {pair.name}", " ".join(sentences(pair)), markdown(cells(pair))]
        parts += [f"{m.lever.name}: {m.note}." for m in pair.measures if m.note]
    if together:
        parts += ["## All pairs, changed at once and solved again" if len(pairs) > 1 else "## Variants"]
        if len(pairs) > 1:
            rattles = rattling(scenes.together)
            parts.append(f"Now {rattles} of {len(pairs)} pairs {'has' if rattles == 1 else 'have'} impacts.")
        parts.append(markdown(together_cells(scenes, together)))
    return "\n\n".join(parts) + "\n"
