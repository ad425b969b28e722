"""Random gearboxes: does what countermeasures.py advises end what it says, when the gearbox is solved again?

    .venv/bin/python tests/stress/countermeasures_again.py build/rattle [--boxes 20] [--first 1]

Each gearbox has two to four pairs of input/gearbox.nml with other inertia, backlash, width and drag, at a
random speed, excitation and oil temperature. Three things to change are drawn and studied. What is advised is
then applied to the whole gearbox, which is solved again from 99 starts at a tenth of the accuracy. A line for
each gearbox, and a table of the sums at the end; the exit code is 1 where something said to be calm is not:

    pairs       of the gearbox, and how many of them have impacts
    ends        values that are advised to one pair, and how many of them countermeasures.py confirms
    advised     pairs that something changed in all pairs at once is to calm, how many of them
                countermeasures.py says are calm then, and how many of these still are when solved again
"""

from __future__ import annotations

import argparse
import os
import random
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

import rattle
from rattle.command import CommandError
from rattle.countermeasures.levers import levers
from rattle.countermeasures.scenes import Together, answer, opened
from rattle.countermeasures.study import TARGETS, study
from rattle.namelist import parse_groups
from rattle.solve import text_of

INPUT = Path(__file__).resolve().parents[2] / "input" / "gearbox.nml"
LEVERS = 3  # things to change of each gearbox
STRICTER = {"solver.starts": 99, "solver.accuracy": 1e-9, "output.series": False}
HEADS = ("pairs", "with impacts", "ends", "confirmed", "advised", "calm", "calm again")
SUMS = (
    ("values advised to one pair, confirmed by all starts", "ends", "confirmed"),
    ("pairs that a change of all pairs at once is to calm, calm then", "advised", "calm"),
    ("these, still calm from 99 starts at a tenth of the accuracy", "calm", "calm again"),
)


def draw(number: int) -> tuple[dict[str, Any], random.Random]:
    """A gearbox of two to four pairs, and the dice that go on."""
    dice = random.Random(number)
    ready = parse_groups(INPUT.read_text())
    gears = [gear.todict() for gear in dice.sample(list(ready["gear"]), dice.choice((2, 2, 3, 4)))]
    for gear in gears:
        gear["loose_inertia"] *= dice.uniform(0.6, 1.6)
        gear["backlash"] = dice.uniform(4e-5, 1.6e-4)
        gear["face_width"] *= dice.uniform(0.8, 1.25)
        gear["synchroniser_gap"] *= dice.uniform(0.7, 1.5)
        gear["immersion_depth"] = dice.uniform(0.0, 0.02)
        gear["tooth_damping_ratio"] = dice.choice((0.0, 0.02, 0.05))
    orders = [dice.uniform(150.0, 1000.0), dice.uniform(30.0, 200.0), dice.uniform(5.0, 80.0)]
    shaft = {
        "speed_rpm": dice.uniform(600.0, 2500.0),
        "orders": [2.0, 4.0, 6.0],
        "accelerations": orders,
        "phases": [dice.uniform(-3.0, 3.0) for _ in orders],
    }
    oil = ready["oil"].todict() | {"temperature_celsius": dice.uniform(20.0, 100.0)}
    return {"gear": gears, "shaft": shaft, "oil": oil, "solver": {"until": "steady", "periods": 200}}, dice


def again(path: Path, settings: dict[str, Any]) -> Together:
    """The whole gearbox from more starts and more exactly."""
    solved = rattle.run(path, set=STRICTER | dict(settings))
    return Together({name: answer(one.summary) for name, one in solved.items()})


def judged(number: int, folder: Path, say: Callable[[str], None]) -> Counter:
    """What is counted of one gearbox; `say` takes what is not calm though it was said to be."""
    groups, dice = draw(number)
    path = folder / f"box{number}.nml"
    path.write_text(text_of(groups))
    scenes = opened(path, folder)
    keys = [lever.key for lever in levers(scenes.pairs[0].groups, {})]
    found = study(scenes, {}, dice.sample(keys, LEVERS))
    count = Counter(pairs=len(found.pairs))
    for pair in found.pairs:
        count["with impacts"] += "impacts" in pair.targets
        ends = [end for measure in pair.measures for end in measure.ends.values()]
        count["ends"] += len(ends)
        count["confirmed"] += sum(end.confirmed for end in ends)
    for measure in found.together:
        after = again(path, measure.settings)
        for name, end in measure.ends.items():
            calm = [one.pairs[name].verdict in TARGETS[end] for one in (measure.result, after)]
            count["advised"] += 1
            count["calm"] += calm[0]
            count["calm again"] += all(calm)
            if not all(calm):
                say(f"box {number}, {name}: {end} by {measure.name}, {measure.settings}: {calm}")
    return count


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--boxes", type=int, default=20)
    parser.add_argument("--first", type=int, default=1, help="number of the first gearbox")
    options = parser.parse_args()
    os.environ["RATTLE_PROGRAM"] = str(options.program.resolve())
    warnings.simplefilter("ignore")
    total: Counter = Counter()
    print("box", *HEADS, sep="\t", flush=True)
    for number in range(options.first, options.first + options.boxes):
        with tempfile.TemporaryDirectory() as folder:
            try:
                count = judged(number, Path(folder), lambda words: print(words, flush=True))
            except CommandError as fault:
                print(f"box {number}: {fault}", flush=True)
                total["refused"] += 1
                continue
        total += count
        print(number, *(count[name] for name in HEADS), sep="\t", flush=True)
    print("all", *(total[name] for name in HEADS), f"{total['refused']} refused\n", sep="\t")
    print("| what | of | confirmed |\n|---|---:|---:|")
    for what, of, confirmed in SUMS:
        print(f"| {what} | {total[of]} | {total[confirmed]} |")
    return int(total["calm again"] < total["calm"])


if __name__ == "__main__":
    sys.exit(main())
