"""Every numeric key of every kind of input at numbers that no machine has: refused or solved, never a crash.

By hand, best with the debug build, which stops at the first overflow:

    python tests/stress/extreme_numbers.py build/debug/rattle [--draws 300] [--seed 1]

The keys come from `--template`, the numbers that can be computed with from the refusals. Each is
set to +-1e+-300, 1e+-150 and 1e+-30, and to the ends of its range; more inputs are drawn with
several keys at the ends of their ranges at once. Every input is checked, and run if it is valid. An
input that is still being solved after some seconds is stopped, which counts as well ended; what
counts as a failure is an end by a signal, or any code but 0, 1 and 2.
"""

from __future__ import annotations

import argparse
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

Groups = dict[str, dict[str, str]]

EXTREMES = [sign * 10.0**power for sign in (1, -1) for power in (300, 150, 30, -30, -150, -300)]

TEETH: Groups = {
    "contact": {"radius": "0.0127", "length": "0.010"},
    "lubricant": {"viscosity": "0.3", "pressure_viscosity": "2.0e-8"},
    "kinematics": {"entrainment_speed": "1.905"},
}
MOTION: Groups = {
    **TEETH,
    "load": {"mass": "3.0", "steady_force": "199.2", "force_amplitude": "205.7", "frequency": "600.0"},
    "film": {"law": "'iso-viscous'"},
    "solver": {"periods": "3", "samples_per_period": "32"},
    "spectrum": {"periods": "2"},
}
POINTS: Groups = {**TEETH, "scene": {"task": "'film'"}, "points": {"film_ratios": "70.0e-6"}}
EXACT: Groups = {"film": {"model": "'reynolds'"}}
LIGHT: Groups = {"load": {"steady_force": "1.0", "force_amplitude": "0.5"}}
VARIED: Groups = {
    "scene": {"task": "'campaign'"},
    "campaign": {
        "vary": "'load.force_amplitude', 'lubricant.viscosity'",
        "first": "10.0, 0.1",
        "last": "20.0, 0.2",
        "count": "2, 2",
        "allow_invalid": ".true.",
    },
}


def merged(*parts: Groups) -> Groups:
    """One input of several, later ones first in force."""
    groups: Groups = {}
    for part in parts:
        for group, keys in part.items():
            groups[group] = {**groups.get(group, {}), **keys}
    return groups


BASES: dict[str, Groups] = {
    "published": MOTION,
    "solved rupture": merged(MOTION, {"film": {"rupture": "'solved'"}}),
    "published piezo": merged(MOTION, {"film": {"law": "'piezo-viscous'"}}),
    "exact": merged(MOTION, EXACT),
    "exact piezo": merged(MOTION, EXACT, LIGHT, {"film": {"law": "'piezo-viscous'"}}),
    "until steady": merged(
        MOTION, {"solver": {"until": "'steady'", "periods": "40"}, "spectrum": {"periods": "8"}}
    ),
    "newmark": merged(
        MOTION, {"solver": {"method": "'newmark'", "steps_per_period": "32", "samples_per_period": ""}}
    ),
    "sweep": merged(
        MOTION,
        {
            "scene": {"task": "'sweep'"},
            "sweep": {"key": "'frequency'", "first": "500.0", "last": "600.0", "count": "2"},
        },
    ),
    "campaign": merged(MOTION, VARIED),
    "threshold": merged(
        MOTION,
        {
            "scene": {"task": "'threshold'"},
            "threshold": {
                "key": "'load.mass'",
                "first": "1.0",
                "last": "3.0",
                "count": "2",
                "tolerance": "0.2",
            },
        },
    ),
    "exact campaign": merged(MOTION, EXACT, LIGHT, VARIED, {"film": {"law": "'piezo-viscous'"}}),
    "film": POINTS,
    "film of groups": merged(
        POINTS,
        {
            "points": {
                "speed_groups": "1e-9",
                "compute": "'rupture', 'load', 'stiffness', 'damping', 'limits'",
            }
        },
    ),
    "numerical film": merged(POINTS, {"film": {"model": "'numerical'"}, "points": {"cells": "64"}}),
    "profiles": merged(POINTS, {"points": {"compute": "'pressure', 'profile'", "profile_nodes": "5"}}),
}

# What must be left out for a key, and what it needs beside it.
LEFT_OUT = {
    "radius_1": "radius",
    "radius_2": "radius",
    "rolling_speed": "entrainment_speed",
    "surface_speed_1": "entrainment_speed",
    "surface_speed_2": "entrainment_speed",
    "film_ratio_range": "film_ratios",
    "squeeze_ratio_range": "squeeze_ratios",
    "speed_group_range": "speed_groups",
    "values": "first",
}
NEEDED = {
    "radius_1": {"radius_2": "0.02"},
    "radius_2": {"radius_1": "0.02"},
    "surface_speed_1": {"surface_speed_2": "1.0"},
    "surface_speed_2": {"surface_speed_1": "1.0"},
    "values": {"vary": "'load.mass'", "last": "", "count": ""},
}


ALLOWED = re.compile(r"Allowed: (a number|numbers|an integer)(.*?)\.(?: Default with .*)?$")


class Key(NamedTuple):
    """A numeric key, and the first and last number that it takes."""

    group: str
    name: str
    ends: tuple[float, ...]


def numeric_keys(program: Path) -> list[Key]:
    """The keys that take numbers, from the template of all keys."""
    template = subprocess.run([program, "--template"], capture_output=True, text=True, check=True).stdout
    keys = []
    group, rule = "", ""
    for line in template.splitlines():
        if line.startswith("&"):
            group = line[1:].strip()
        elif found := re.search(ALLOWED, line):
            rule = found[2] + " "
        elif rule:
            name = re.match(r"\W*(\w+) =", line)[1]
            ends = tuple(float(end) for end in re.findall(r"-?\d[\d.E+-]*(?=\s)", rule))
            keys.append(Key(group, name, ends))
            rule = ""
    with tempfile.TemporaryDirectory() as folder:
        return [key._replace(ends=refused_beyond(program, Path(folder), key) or key.ends) for key in keys]


def refused_beyond(program: Path, folder: Path, key: Key) -> tuple[float, ...]:
    """First and last number that can be computed with, as the refusal of another one says."""
    if key.group in ("sweep", "campaign"):
        return ()
    groups = next(with_key(POINTS if key.group == "points" else MOTION, key, 1e300))
    _, reported = outcome(program, folder, groups, seconds=10.0)
    found = re.search(r"possible: (\S+) to (\S+)", reported)
    return (float(found[1]), float(found[2])) if found else ()


def namelist(groups: Groups) -> str:
    """The input as text; empty values are left out."""
    text = ""
    for group, keys in groups.items():
        body = "".join(f"   {name} = {value}\n" for name, value in keys.items() if value)
        text += f"&{group}\n{body}/\n"
    return text


def with_key(base: Groups, key: Key, number: float) -> Iterator[Groups]:
    """The input with a key at a number, in every place where the key takes it."""
    word = f"{number:.17g}"
    values = [word]
    if key.name.endswith("_range"):
        values = [f"{word}, 1.0, 3", f"1e-6, {word}, 3"]
    elif key.group == "campaign" and key.name in ("first", "last"):
        values = [f"{word}, 0.15", f"15.0, {word}"]
    for value in values:
        name = "values(:, 1)" if key.name == "values" else key.name
        groups = merged(base, {key.group: NEEDED.get(key.name, {})}, {key.group: {name: value}})
        if key.name in LEFT_OUT:
            groups[key.group].pop(LEFT_OUT[key.name], None)
        if key.group == "points" and key.name.startswith("speed_group"):
            groups.pop("kinematics", None)
        yield groups


def single_inputs(keys: list[Key], bases: dict[str, Groups]) -> Iterator[tuple[str, Groups]]:
    """One key after the other at every extreme; keys of other tasks are refused, which is an answer, too."""
    for title, base in bases.items():
        for key in keys:
            if key.group in ("sweep", "points", "campaign") and key.group not in base:
                continue
            for number in [*EXTREMES, *key.ends]:
                for groups in with_key(base, key, number):
                    yield f"{title}: {key.group}.{key.name} = {number:g}", groups


def drawn_inputs(keys: list[Key], draws: int, seed: int) -> Iterator[tuple[str, Groups]]:
    """Several keys at once, each at an end of its range or somewhere in it."""
    drawer = random.Random(seed)
    physical = [
        key
        for key in keys
        if len(key.ends) == 2 and key.group in ("contact", "lubricant", "kinematics", "load", "film")
    ]
    physical = [key for key in physical if key.name not in LEFT_OUT]
    for _ in range(draws):
        title, groups = drawer.choice(list(BASES.items()))
        chosen = drawer.sample(physical, drawer.randint(2, len(physical)))
        for key in chosen:
            if key.group not in groups or (
                key.group == "film" and title in ("film", "film of groups", "numerical film", "profiles")
            ):
                continue
            low, high = key.ends
            within = drawer.uniform(low, high) if low <= 0.0 else low * (high / low) ** drawer.random()
            groups = next(with_key(groups, key, drawer.choice([low, high, within])))
        yield f"{title}: " + ", ".join(f"{key.name}" for key in chosen), groups


def outcome(program: Path, folder: Path, groups: Groups, *, seconds: float) -> tuple[str, str]:
    """How --check and, of a valid input, a run ended, in words; and what was reported on standard error."""
    (folder / "extreme.nml").write_text(namelist(groups))
    code = 2
    for options in (["--check"], ["--overwrite", "--quiet"]):
        command = [program, *options, "extreme.nml"]
        try:
            ended = subprocess.run(
                command,
                cwd=folder,
                capture_output=True,
                text=True,
                errors="replace",
                timeout=seconds,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return ("hung in --check" if "--check" in options else "stopped"), ""
        code = ended.returncode
        if code not in (0, 1, 2) or "runtime error" in ended.stderr:
            return f"CRASHED with code {code} in {options[0]}", ended.stderr
        if code == 2:
            return ("refused" if "--check" in options else "refused only when run"), ended.stderr
    return ("solved" if code == 0 else "failed honestly"), ended.stderr


def main() -> int:
    parser = argparse.ArgumentParser(description="Numbers that no machine has.")
    parser.add_argument("program", type=Path)
    parser.add_argument("--draws", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--only", default="", help="titles that begin so")
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    keys = numeric_keys(program)
    tally: Counter[str] = Counter()
    bad = []
    with tempfile.TemporaryDirectory() as name:
        for title, groups in (
            *single_inputs(keys, BASES),
            *drawn_inputs(keys, arguments.draws, arguments.seed),
        ):
            if not title.startswith(arguments.only):
                continue
            words, reported = outcome(program, Path(name), groups, seconds=arguments.seconds)
            tally[words.split(" in ")[0]] += 1
            if words.startswith(("CRASHED", "hung", "refused only")):
                bad.append(title)
                print(f"{title}: {words}\n{reported}\n{namelist(groups)}", flush=True)
    for words, count in sorted(tally.items()):
        print(f"{count:6d} {words}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
