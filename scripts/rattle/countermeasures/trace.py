"""The verdict of a scene along one thing that is changed, and where on it the motion is calm enough."""

from __future__ import annotations

from collections.abc import Iterator, Set
from dataclasses import dataclass

import numpy as np

from rattle.countermeasures.levers import LEAST, Lever
from rattle.countermeasures.scenes import UNKNOWN, Scene
from rattle.solve import threshold

COUNT, FEW = 17, 9
"""Values of a scan: along a key, which the program follows, and of scenes that are solved one by one."""
TOLERANCE = 2.0e-3
HALVINGS = 5
STARTS = 3
SEARCH = {"spectrum.verify": False}
# Films in nodes of pressure are not followed along a key.
IN_NODES = ("resolved", "automatic")


@dataclass(frozen=True)
class Change:
    """A change of the verdict between two values.

    `last_below` and `last_above`: to where motions of the side below and above last.
    """

    lower: float
    upper: float
    below: int
    above: int
    last_below: float
    last_above: float


@dataclass(frozen=True)
class Trace:
    """The verdict along a lever: `first_verdict` at its lower end, then its changes, in rising order.

    `others`: where motions live that other starts alone lead to, on another side than those from rest.
    """

    lever: Lever
    first_verdict: int
    changes: tuple[Change, ...]
    others: tuple[float, float] | None = None

    def stretches(self) -> list[tuple[float, float, int]]:
        """From, to and verdict of each stretch, end to end."""
        middles = [0.5 * (change.lower + change.upper) for change in self.changes]
        ends = [self.lever.first, *middles, self.lever.last]
        verdicts = [self.first_verdict, *(change.above for change in self.changes)]
        return list(zip(ends[:-1], ends[1:], verdicts, strict=True))

    def calm(self, left: Set[int]) -> Iterator[tuple[float, float]]:
        """The windows in which every motion that was found has a verdict of `left`."""
        rough = [self.others] if self.others else []
        first, last = self.lever.first, self.lever.last
        ends = [first, *(end for change in self.changes for end in (change.lower, change.upper)), last]
        verdicts = [self.first_verdict, *(change.above for change in self.changes)]
        for place, verdict in enumerate(verdicts):
            if verdict not in left:
                low, high = ends[2 * place], ends[2 * place + 1]
                if place > 0:
                    low = min(self.changes[place - 1].upper, self.changes[place - 1].last_above)
                if place < len(self.changes):
                    high = max(self.changes[place].lower, self.changes[place].last_below)
                rough.append((low, high))
        # A bracket belongs to the rougher side of it.
        rough += [(c.lower, c.upper) for c in self.changes if not {c.below, c.above} <= left]
        at = first
        for low, high in sorted(rough):
            if low > at:
                yield at, low
            at = max(at, high)
        if at < last:
            yield at, last


def trace(scene: Scene, lever: Lever) -> Trace:
    """The verdict along a lever, followed by the program or, where it has no such key, scene by scene."""
    in_nodes = str(scene.groups.get("film", {}).get("model", "")).strip() in IN_NODES
    return _solved(scene, lever) if in_nodes or not lever.is_one_key else _followed(scene, lever)


def _followed(scene: Scene, lever: Lever) -> Trace:
    """By the task threshold: changes of the motion from rest, and to where the motions of both sides last."""
    first = max(lever.first, LEAST.get(lever.key, lever.first))
    rows = threshold(
        scene.path,
        lever.key,
        first,
        lever.last,
        criterion="verdict",
        scale="logarithmic" if lever.logarithmic else "linear",
        count=COUNT,
        tolerance=TOLERANCE,
        set={**SEARCH, lever.key: lever.last},
    ).result
    assert rows is not None, "a threshold always leaves its table"
    has_ends = "last_below" in rows
    changes: list[Change] = []
    others, first_verdict = None, UNKNOWN
    for place in range(rows.row_count):
        row = {name: float(rows[name][place]) for name in rows.names}
        codes = [row[f"verdict_{side}"] for side in ("below", "above")]
        below, above = (int(code) if np.isfinite(code) else UNKNOWN for code in codes)
        last_below, last_above = (row[f"last_{s}"] if has_ends else np.nan for s in ("below", "above"))
        if not changes:
            first_verdict = below
        if row["crossing"] > 0:
            lower, upper = row["lower"], row["upper"]
            last_below = last_below if np.isfinite(last_below) else lower
            last_above = last_above if np.isfinite(last_above) else upper
            changes.append(Change(lower, upper, below, above, last_below, last_above))
        elif last_above <= last_below:
            others = (last_above, last_below)
    return Trace(lever, first_verdict, tuple(changes), others)


def _solved(scene: Scene, lever: Lever) -> Trace:
    """By scenes that are solved one by one, each from a few starts, the worst motion of which counts."""
    known: dict[float, int] = {}
    settings = SEARCH | ({} if "starts" in scene.groups.get("solver", {}) else _starts(scene))

    def verdict(place: float) -> int:
        if place not in known:
            known[place] = scene.solve(settings | lever.settings(lever.value_at(place))).verdict
        return known[place]

    def between(low: float, high: float, halvings: int) -> Iterator[Change]:
        below, above = verdict(low), verdict(high)
        if below == above:
            return
        if halvings == 0:
            lower, upper = lever.value_at(low), lever.value_at(high)
            yield Change(lower, upper, below, above, lower, upper)
            return
        middle = 0.5 * (low + high)
        yield from between(low, middle, halvings - 1)
        yield from between(middle, high, halvings - 1)

    places = np.linspace(0.0, 1.0, FEW).tolist()
    changes = [
        change
        for low, high in zip(places[:-1], places[1:], strict=True)
        for change in between(low, high, HALVINGS)
    ]
    return Trace(lever, verdict(0.0), tuple(changes))


def _starts(scene: Scene) -> dict[str, int]:
    """Few starts, where the film and the method have any."""
    film, solver = scene.groups.get("film", {}), scene.groups.get("solver", {})
    is_followed = str(solver.get("method", "taylor")).strip() == "taylor"
    return {"solver.starts": STARTS} if is_followed and str(film.get("model")).strip() not in IN_NODES else {}
