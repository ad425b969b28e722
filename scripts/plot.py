#!/usr/bin/env python3
"""Draws results. Each command is the module of its name in rattle/figures."""

from __future__ import annotations

import argparse
import importlib
import sys
from pathlib import Path

import rattle
from rattle import command
from rattle.figures.options import common_options

COMMANDS = {
    "motion": "figures 6 to 10 of the paper from results of motions",
    "film": "figures 3 to 5 of the paper from the result of a film task",
    "sweep": "steady motions along a swept key, there and back",
    "campaign": "maps, slices and a one-page summary of a campaign",
    "orders": "engine orders over speed from a campaign, with measured ones over them",
    "waterfall": "amplitude over order and speed of a run-up, measured, or driven up and down",
    "threshold": "where along a key a motion changes, over one or two others, or over a map",
    "tolerance": "what a loose tolerance of the iteration does to a motion",
    "film-fit": "the film-thickness law (32), fitted to Reynolds films",
    "regime-map": "Johnson's map of lubrication regimes with scenes on it",
}


def main() -> int | None:
    options = parse_options()
    return options.run(options)


def parse_options() -> argparse.Namespace:
    first = "".join(sys.argv[1:2])
    parser = argparse.ArgumentParser(
        description="Draw results, each figure as PNG and PDF. Each command has its own --help."
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for name, words in COMMANDS.items():
        chosen = commands.add_parser(name, help=words, parents=[common_options()])
        if name == first:  # only its module is loaded
            module = importlib.import_module(f"rattle.figures.{name.replace('-', '_')}")
            chosen.description = module.DESCRIPTION
            module.add_options(chosen)
            chosen.set_defaults(run=module.run, parser=chosen)
    if first not in COMMANDS and (first.endswith(".rattle") or Path(first).is_file()):
        task = rattle.read(first).task
        right = f"; 'plot.py {task} {first}' draws it" if task in COMMANDS else ""
        raise command.CommandError(f"{first} is not a command{right}.")
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
