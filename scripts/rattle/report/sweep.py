"""What a report says of a sweep: verdicts and classes along its key, on the ways up and down."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from rattle.campaign_section import short_name
from rattle.codes import STATUSES, SUCCESSES, spoken, word
from rattle.counts import counted
from rattle.figures import campaign_look as look
from rattle.figures import sweep as picture
from rattle.figures import waterfall
from rattle.report import motion, page
from rattle.result import Result
from rattle.run_up import LEFT, SPEED, differing, is_run_up, pace, peaks, ways

MOST_SPANS = 3  # of one verdict in the headline, before they are counted
WATERFALL = (
    "Levels of the acceleration relative to the shaft at the orders of the force: up, down, and "
    "down less up. Dashed: where stretches end in which both ways have motions of their own."
)


@dataclass(frozen=True)
class Stretch:
    """Neighbouring motions of one class on one way: first and last value of the key, and their rows."""

    way: str
    word: str
    first: float
    last: float
    rows: np.ndarray


def key_of(result: Result) -> tuple[str, str]:
    """Name and unit of the swept key."""
    return short_name(result.names[0]), result.units[result.names[0]]


def stretches(result: Result) -> list[Stretch]:
    """Both ways cut where the class, or whether there is one, changes."""
    values, failed = result[result.names[0]], ~np.isin(result["status"], SUCCESSES)
    words = np.array(
        [
            f"failed: {word('status', status)}" if bad else spoken(word("rattle_class", code))
            for bad, status, code in zip(failed, result["status"], result["rattle_class"], strict=True)
        ]
    )
    found = []
    for name, direction in ways(result).items():
        rows = np.flatnonzero(result["direction"] == direction)
        for part in np.split(rows, np.flatnonzero(words[rows][1:] != words[rows][:-1]) + 1):
            if part.size:
                found.append(Stretch(name, str(words[part[0]]), values[part[0]], values[part[-1]], part))
    return found


def verdict(result: Result, sentences: Sequence[str]) -> list[str]:
    """Verdicts along the key and the largest film force, or the classes that occur; what is said first."""
    failed = int((~np.isin(result["status"], SUCCESSES)).sum())
    words = "; ".join(headline(result)) or ", ".join(names(result)) or "no class"
    return [page.verdict_box(words, None, sentences, doubt=failed > 0)]


def headline(result: Result) -> Iterator[str]:
    """At which values of the key each verdict is, on either way, and where the film force is largest."""
    values, kept = result[result.names[0]], np.isin(result["status"], SUCCESSES)
    if "verdict" not in result or not kept.any():
        return
    verdicts = result["verdict"]
    for position, code in enumerate(sorted(np.unique(verdicts[kept]), reverse=True)):
        name = spoken(word("verdict", code))
        where = spans(result, kept & (verdicts == code))
        yield f"{name if position else look.capital(name)} at {where}"
    if "film_force_rms" in result:
        row = int(np.argmax(np.where(kept, result["film_force_rms"], -np.inf)))
        force = page.plain(float(result["film_force_rms"][row]), "N", page.FEW_DIGITS)
        yield f"largest film force {force} rms at {values[row]:.6g} {result.units[result.names[0]]}"


def spans(result: Result, rows: np.ndarray) -> str:
    """The values of the key of some rows, as in '700 to 900 and 1200 1/min'."""
    every, unit = np.unique(result[result.names[0]]), result.units[result.names[0]]
    places = np.flatnonzero(np.isin(every, result[result.names[0]][rows]))
    parts = np.split(places, np.flatnonzero(np.diff(places) > 1) + 1)
    if len(parts) > MOST_SPANS:
        return f"{places.size} values from {every[places[0]]:.6g} to {every[places[-1]]:.6g} {unit}"
    ends = [(every[part[0]], every[part[-1]]) for part in parts]
    words = [f"{first:.6g}" if first == last else f"{first:.6g} to {last:.6g}" for first, last in ends]
    return f"{' and '.join(filter(None, [', '.join(words[:-1]), words[-1]]))} {unit}"


def names(result: Result) -> list[str]:
    """The classes that occur."""
    found = (stretch.word for stretch in stretches(result))
    return list(dict.fromkeys(name for name in found if not name.startswith("failed")))


def meanings(result: Result) -> list[str]:
    return [motion.class_meanings(names(result))]


def numbers(result: Result) -> list[str]:
    """Where the motions are worst, and how many there are."""
    name, unit = key_of(result)
    values, kept = result[result.names[0]], np.isin(result["status"], SUCCESSES)
    rows = [["Motions", str(result.row_count)], ["of these failed", str(int((~kept).sum()))]]
    if kept.any():
        worst = int(np.argmax(np.where(kept, peaks(result), -np.inf)))
        thin = int(np.argmin(np.where(kept, result["film_minimum"], np.inf)))
        rows += [
            ["Largest acceleration", page.value(float(peaks(result)[worst]), "m/s2", page.FEW_DIGITS)],
            [f"at a {name} of", page.value(float(values[worst]), unit, page.FEW_DIGITS)],
            ["Thinnest film", page.value(float(result["film_minimum"][thin]), "m", page.FEW_DIGITS)],
            [f"at a {name} of", page.value(float(values[thin]), unit, page.FEW_DIGITS)],
        ]
    return page.numbers(rows)


def sentences_on(result: Result) -> Iterator[str]:
    name, unit = key_of(result)
    values = result[result.names[0]]
    endings = [STATUSES[int(status)] for status in result["status"]]
    steady, complete = endings.count("steady"), endings.count("complete")
    open_ended = f"{complete} not yet steady when their periods ended, " if complete else ""
    span = f"from {values.min():.6g} to {values.max():.6g} {unit}"
    yield (
        f"{result.row_count} motions along the {name}, {span}, each from the one before: {steady} steady, "
        f"{open_ended}{result.row_count - steady - complete} failed."
    )
    both = differing(result)
    if (result["direction"] < 0.0).any():
        if both.size:
            span = f"from {both.min():.6g} to {both.max():.6g}" if both.size > 1 else f"{both[0]:.6g}"
            yield (
                f"The way down differs from the way up at {counted(both.size, 'value')} of the {name}, "
                f"{span} {unit}: there are two motions, and which one comes depends on the one before."
            )
        elif known_both_ways(result):
            yield "The way down has the motions of the way up."
    if "orbit_period" in result:
        longest = int(np.nanmax(result["orbit_period"], initial=0.0))
        if longest > 1:
            yield f"Some motions repeat only after several periods of the force, at most {longest}."
    if is_run_up(result):
        yield from pace_of_run_up(result)
    yield "A sweep gives no verification of its classes; the single scene at a value of interest does."


def pace_of_run_up(result: Result) -> Iterator[str]:
    """How slow a driven run-up has to be for these motions to be its own, and where none is slow enough."""
    found = pace(result)
    row = found.slowest
    if row is None:
        yield "No rate of a run-up is known at which these are its motions: no multiplier below 1 is known."
        return
    way = next(name for name, direction in ways(result).items() if direction == result["direction"][row])
    yield (
        f"A run-up has these motions if it is driven at {found.rates[row]:.3g} 1/min/s or slower: a "
        f"disturbance then shrinks to {LEFT:.0%} from one value to the next. What takes longest is the way "
        f"{way} at {result[SPEED][row]:.6g} 1/min, where {result['floquet_modulus'][row]:.3g} of it is left "
        "after each period of the motion. Finer steps, the more towards a jump, take longer."
    )
    for words, direction in ways(result).items():
        spans = [f"{a:.6g} and {b:.6g}" for a, b, own in found.changes if own == direction]
        if spans:
            yield (
                f"On the way {words} the motion jumps or changes its period between {', '.join(spans)} "
                "1/min; no rate is slow enough there."
            )
    irregular = int((np.asarray(result["orbit_period"]) == 0.0).sum())
    if irregular:
        yield (
            f"At {irregular} of {result.row_count} values the motion is not known to repeat: no rate is "
            "known there."
        )


def known_both_ways(result: Result) -> bool:
    """Whether any value of the key has a motion on the way up and one on the way down."""
    kept = np.isin(result["status"], SUCCESSES)
    there, back = (result[result.names[0]][kept & (result["direction"] == way)] for way in (1.0, -1.0))
    return bool(np.isin(back, there).any())


def tables(result: Result) -> list[str]:
    """The stretches of one class, with the extremes of their motions."""
    _, unit = key_of(result)
    rows = []
    for part in stretches(result):
        span = page.Cell(f"{page.value(part.first, unit)} to {page.value(part.last, unit)}")
        extremes = ("-", "-")
        if np.isin(result["status"][part.rows[0]], SUCCESSES):
            peak = peaks(result)[part.rows].max()
            least = result["film_minimum"][part.rows].min()
            extremes = (page.value(least, "m"), page.value(peak, "m/s2"))
        rows.append([part.way, part.word, span, str(part.rows.size), *extremes])
    heads = ("Way", "Class", "Values", "Motions", "Thinnest film", "Largest acceleration")
    return [page.table(heads, rows, kinds=("", "", "", "number", "number", "number"))]


def figures(result: Result) -> list[str]:
    caption = (
        "Motions along the swept key: thinnest and thickest film, largest acceleration, period of "
        "the motion, "
        "and how much of a disturbance is left after one period (below 1: the motion is stable)."
    )
    if is_run_up(result):
        caption += (
            " Last, the fastest run-up that has these motions: faster, it lags behind them. Where there is "
            "none, the motion jumps, changes its period or is not known to repeat."
        )
    if differing(result).size:
        caption += " Shaded: both ways have motions of their own."
    drawn = [page.drawing(lambda: picture.draw(result), caption, f"{result.scene_name} sweep")]
    if is_run_up(result) and "harmonic_1" in result:
        drawn.append(
            page.drawing(lambda: waterfall.draw_ways(result), WATERFALL, f"{result.scene_name} waterfall")
        )
    return drawn
