"""What would stop the rattle of each pair of an input, what an effort gains, and what all pairs do then."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from dataclasses import dataclass, field
from typing import Any

from rattle.command import CommandError
from rattle.countermeasures.levers import Lever, levers
from rattle.countermeasures.scenes import VERDICTS, Answer, Scene, Scenes, Together
from rattle.countermeasures.trace import Trace, trace
from rattle.countermeasures.variants import Variant
from rattle.counts import counted
from rattle.faults import InputError, InputWarning

# What is to end, and the verdicts that are left then.
TARGETS = {
    "double-sided impacts": frozenset(VERDICTS.values()) - {VERDICTS["double-sided impacts"]},
    "impacts": frozenset(code for word, code in VERDICTS.items() if "impacts" not in word),
    "separation": frozenset({VERDICTS["no separation"], VERDICTS["impacts without separation"]}),
}
# What is looked at first, to rank and to advise.
ORDER = ("impacts", "double-sided impacts", "separation")
# How far beyond the end a change is advised, a share of the range; more, where the motion is not yet calm.
MARGINS = (0.01, 0.03, 0.1)
LEAST_SHARE = 1e-9


@dataclass(frozen=True)
class End:
    """A change that ends something: to `value`, a `share` of the way to the end of the range.

    It ends it up to `until`; `confirmed`: the scene, solved again with `value`, does what was predicted.
    """

    value: float
    share: float
    until: float
    confirmed: bool
    answer: Answer


@dataclass(frozen=True)
class Measure:
    """One thing to change of a pair: what is needed of it, and what an effort gains; `note` says why not.

    `stretches`: from, to and verdict of each along the range.
    """

    lever: Lever
    stretches: tuple[tuple[float, float, int], ...]
    ends: Mapping[str, End]
    effort: tuple[float, Answer] | None
    note: str = ""

    @property
    def rank(self) -> tuple[float, ...]:
        """What needs the smallest share of its range to end impacts comes first."""
        ends = (self.ends.get(name) for name in ORDER)
        shares = [abs(end.share) if end and end.confirmed else math.inf for end in ends]
        return (*shares, self.effort[1].force if self.effort else math.inf)

    @property
    def best(self) -> tuple[str, End] | None:
        """What it ends, impacts before anything else."""
        return next(
            ((name, self.ends[name]) for name in ORDER if name in self.ends and self.ends[name].confirmed),
            None,
        )


@dataclass(frozen=True)
class PairStudy:
    """One pair as it is now, with what can be changed of it, the best first."""

    name: str
    now: Answer
    measures: tuple[Measure, ...]

    @property
    def targets(self) -> list[str]:
        """What it does now that may be ended."""
        return [name for name, left in TARGETS.items() if self.now.verdict not in left]


@dataclass(frozen=True)
class BoxMeasure:
    """What is changed of all pairs at once, and what they do then.

    `confirmed`: each pair that it was to calm is calm; None of a variant, of which nothing was predicted.
    `ends`: what it was to end in each of these pairs.
    """

    name: str
    settings: Mapping[str, Any]
    result: Together
    confirmed: bool | None = None
    cost: float = math.nan
    ends: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Study:
    """All pairs of an input, and all of them together, the best change first."""

    scenes: Scenes
    pairs: tuple[PairStudy, ...]
    together: tuple[BoxMeasure, ...]


def study(
    scenes: Scenes,
    ranges: Mapping[str, tuple[float, float]],
    keys: Sequence[str] = (),
    asked: Sequence[Variant] = (),
    report: Callable[[str], None] = lambda _: None,
) -> Study:
    """What each thing to change does to each pair, or only those of `keys`; `report` takes what goes on.

    `ranges` stand for the usual ones, by key; `asked` are variants that are solved as they stand.
    """
    found = {scene.name: levers(scene.groups, ranges) for scene in scenes.pairs}
    known = dict.fromkeys(lever.key for own in found.values() for lever in own)
    for key in (*ranges, *keys):
        if key not in known:
            raise CommandError(f"{key} is not one of the changes; choose from {', '.join(known)}.")
    pairs = []
    with warnings.catch_warnings():
        # What is odd about a change that is tried is nothing for the user.
        warnings.simplefilter("ignore", InputWarning)
        for scene in scenes.pairs:
            chosen = [lever for lever in found[scene.name] if not keys or lever.key in keys]
            report(f"{scene.name}: {counted(len(chosen), 'thing')} to change")
            measures = sorted((_measure(scene, lever) for lever in chosen), key=lambda measure: measure.rank)
            pairs.append(PairStudy(scene.name, scene.now, tuple(measures)))
        together = _together(scenes, pairs) if len(pairs) > 1 else []
        tried = [BoxMeasure(v.name, v.settings, scenes.solve(v.settings), None, v.cost) for v in asked]
    return Study(scenes, tuple(pairs), (*together, *sorted(tried, key=lambda one: _order(one, scenes))))


def _measure(scene: Scene, lever: Lever) -> Measure:
    try:
        tried = [(value, scene.solve(lever.settings(value))) for value in lever.efforts()]
        effort = min(
            (one for one in tried if math.isfinite(one[1].force)),
            key=lambda one: one[1].force,
            default=None,
        )
        wanted = {name: left for name, left in TARGETS.items() if scene.now.verdict not in left}
        if not wanted:
            return Measure(lever, (), {}, effort)
        found = trace(scene, lever)
        ends = {name: _end(scene, found, left) for name, left in wanted.items()}
    except InputError as fault:
        # Such as a centre of the range that a drag table does not reach.
        return Measure(lever, (), {}, None, f"refused: {fault.faults[0].message if fault.faults else fault}")
    return Measure(lever, tuple(found.stretches()), {name: end for name, end in ends.items() if end}, effort)


def _end(scene: Scene, found: Trace, left: Set[int]) -> End | None:
    """The nearest value at which every motion has a verdict of `left`, solved again with all starts."""
    lever, end = found.lever, None
    windows = [(float(lever.place_of(low)), float(lever.place_of(high))) for low, high in found.calm(left)]
    for near, far in ways(windows, float(lever.place_of(lever.now))):
        for inside in sorted({min(margin, 0.5 * abs(far - near)) for margin in MARGINS}):
            value = lever.value_at(near + math.copysign(inside, far - near))
            answer = scene.solve(lever.settings(value))
            confirmed = answer.verdict in left
            end = End(value, float(lever.share(value)), lever.value_at(far), confirmed, answer)
            if confirmed:
                return end
    return end


def ways(windows: Iterable[tuple[float, float]], now: float) -> list[tuple[float, float]]:
    """Near and far end of each window as seen from `now`, the nearest first; one about it goes both ways."""
    found = []
    for low, high in windows:
        if low < now:
            found.append((min(high, now), low))
        if high > now:
            found.append((max(low, now), high))
    return sorted(found, key=lambda way: abs(way[0] - now))


def _together(scenes: Scenes, pairs: Sequence[PairStudy]) -> list[BoxMeasure]:
    """Each thing changed of all pairs that it calms, solved all at once; the one that calms most first."""
    names = list(dict.fromkeys(measure.lever.name for pair in pairs for measure in pair.measures))
    found = []
    for name in names:
        chosen = [
            (number, pair, measure.lever, *measure.best)
            for number, pair in enumerate(pairs, 1)
            for measure in pair.measures
            if measure.lever.name == name and measure.best
        ]
        if not chosen:
            continue
        if chosen[0][2].is_of_pair:
            settings = {
                key.replace("gear.", f"gear({number})."): value
                for number, _, lever, _, end in chosen
                for key, value in lever.settings(end.value).items()
            }
        else:
            # One value for all: that which needs most, on the side that calms more pairs.
            side = 1.0 if sum(math.copysign(1.0, one[4].share) for one in chosen) >= 0.0 else -1.0
            chosen = [one for one in chosen if one[4].share * side >= 0.0]
            _, _, lever, _, end = max(chosen, key=lambda one: abs(one[4].share))
            settings = lever.settings(end.value)
        result = scenes.solve(settings)
        ends = {pair.name: target for _, pair, _, target, _ in chosen}
        confirmed = all(result.pairs[pair].verdict in TARGETS[end] for pair, end in ends.items())
        found.append(BoxMeasure(name, settings, result, confirmed, ends=ends))
    return sorted(found, key=lambda one: (rattling(one.result), _force(one.result)))


def _order(variant: BoxMeasure, scenes: Scenes) -> tuple[float, float]:
    """Variants by what they gain for their cost, then those without one by what they gain."""
    gain = -variant.result.change_db(scenes.together)[0]
    gain = gain if math.isfinite(gain) else -math.inf
    return (0.0, -gain / variant.cost) if variant.cost > 0.0 else (1.0, -gain)


def rattling(together: Together) -> int:
    """How many pairs have impacts."""
    return sum(answer.verdict not in TARGETS["impacts"] for answer in together.pairs.values())


def _force(together: Together) -> float:
    return together.uncorrelated if math.isfinite(together.uncorrelated) else math.inf
