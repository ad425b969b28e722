#!/usr/bin/env python3
"""Draws results. Each command is the module of its name in rattle/figures."""

from __future__ import annotations

import argparse
import importlib
import sys
from pathlib import Path

import rattle
from rattle import command, outputs

COMMANDS = {
    "motion": "figures 6 to 10 of the paper from results of motions",
    "film": "figures 3 to 5 of the paper from the result of a film task",
    "sweep": "steady motions along a swept key, there and back",
    "campaign": "maps, slices and a one-page summary of a campaign",
    "orders": "engine orders over speed from a campaign, with measured ones over them",
    "threshold": "where along a key a motion changes, over one or two others, or over a map",
    "tolerance": "what a loose tolerance of the iteration does to a motion",
    "film-fit": "the film-thickness law (32), fitted to Reynolds films",
    "regime-map": "Johnson's map of lubrication regimes with scenes on it",
}
FORMATS = ("png", "pdf", "svg")
MILLIMETRES = 1.0 / 25.4


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
        raise command.CommandError(f"{first} is no command{right}.")
    return command.parse(parser)


def common_options() -> argparse.ArgumentParser:
    """What every command takes: where the figures go, and how they are written."""
    common = argparse.ArgumentParser(add_help=False)
    group = common.add_argument_group("figures")
    outputs.add_option(group)
    group.add_argument("--output", type=Path, default=Path(), metavar="DIR", help="where the figures go (.)")
    group.add_argument(
        "--format",
        type=formats,
        default=("png", "pdf"),
        metavar="NAMES",
        help=f"of {', '.join(FORMATS)} (png,pdf)",
    )
    group.add_argument(
        "--width", type=width, metavar="MM", help="width in mm, 80 for a column (most figures: 160)"
    )
    group.add_argument(
        "--font-size", type=font_size, metavar="PT", help="size of the type in points (9; 7 in a column)"
    )
    group.add_argument("--no-title", action="store_true", help="leave the titles out; captions say the same")
    group.add_argument("--xlim", type=limits, metavar="LO,HI", help="limits of the x axes; write --xlim=-1,1")
    group.add_argument("--ylim", type=limits, metavar="LO,HI", help="limits of the y axis of the first panel")
    group.add_argument("--dpi", type=command.positive, default=200, metavar="N", help="dots an inch (200)")
    return common


def formats(text: str) -> tuple[str, ...]:
    chosen = command.names(text)
    for name in chosen:
        if name not in FORMATS:
            raise argparse.ArgumentTypeError(f"'{name}' is not one of {', '.join(FORMATS)}")
    if not chosen:
        raise argparse.ArgumentTypeError("no format is named")
    return tuple(dict.fromkeys(chosen))


def width(text: str) -> float:
    """Inches of a width in millimetres."""
    value = command.positive_number(text)
    if not 40.0 <= value <= 1000.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a width from 40 to 1000 mm")
    return value * MILLIMETRES


def font_size(text: str) -> float:
    value = command.positive_number(text)
    if not 3.0 <= value <= 40.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a size of type from 3 to 40 points")
    return value


def limits(text: str) -> tuple[float, float]:
    ends = [command.finite(part) for part in text.split(",")]
    if len(ends) != 2 or ends[0] >= ends[1]:
        raise argparse.ArgumentTypeError(f"'{text}' is not two rising numbers such as 0,10")
    return ends[0], ends[1]


if __name__ == "__main__":
    command.run(main)
