#!/usr/bin/env python3
"""Which of several keys matter, and how much: designs of campaigns, and Sobol indices of their results."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import rattle
from rattle import command, outputs, sensitivity, table
from rattle.figures import style
from rattle.figures.options import by_default
from rattle.figures.sensitivity import draw, draw_directions


def main() -> int:
    return design() if sys.argv[1:2] == ["design"] else analyse()


def design() -> int:
    """Write the design of a campaign and an input that runs it."""
    parser = argparse.ArgumentParser(
        prog=f"{Path(sys.argv[0]).name} design",
        description="Write Saltelli's design over the ranges of a campaign's input, NAME.design.csv, and an "
        "input that runs it, NAME_design.nml, both beside the input, whose tables they share.",
    )
    parser.add_argument("input", type=Path, help="input with &campaign vary, first and last")
    parser.add_argument(
        "--blocks",
        type=power_of_two,
        metavar="N",
        help="blocks, each of as many scenes as keys and two more; a power of two "
        f"(as many as the scenes of campaign.size have room for, without it {sensitivity.BLOCKS})",
    )
    parser.add_argument(
        "--seed", type=command.positive, metavar="N", help="of the sample (campaign.seed, without it 1)"
    )
    outputs.add_option(parser)
    options = parser.parse_args(sys.argv[2:])
    made = sensitivity.new_design(options.input, options.blocks, options.seed, options.input.parent)
    command.note(made.words)
    for path in outputs.write(made.files, overwrite=options.overwrite, inputs=[options.input]):
        print(path)
    return command.COMPLETE


def analyse() -> int:
    """Report the indices of a result, and draw them."""
    parser = argparse.ArgumentParser(
        description="Print how much of the variance of what a campaign recorded each varied key explains: "
        "alone (first order) and with all others (total), with 95 % intervals; and how likely a pair is to "
        "rattle. 'sensitivity.py design INPUT' writes the campaign; of one with a sample only the "
        "probability is reported."
    )
    parser.add_argument("result", type=Path, help="result of a campaign over a design")
    parser.add_argument(
        "--quantities",
        type=command.names,
        default=[],
        metavar="NAMES",
        help="what is analysed, between commas",
    )
    parser.add_argument("--output", type=Path, metavar="FOLDER", help="draw bars there")
    outputs.add_option(parser)
    options = command.parse(parser)
    campaign = rattle.read_campaign(options.result)
    found = sensitivity.studies(campaign, options.quantities)
    for study in found:
        print("\n".join(words(study)))
    figures = []
    if any(study.found for study in found):
        figures.append((f"sensitivity_{campaign.name}", draw))
    if any(study.directions for study in found):
        figures.append((f"directions_{campaign.name}", draw_directions))
    if options.output and figures:
        with style.house_style():
            drawn = [(stem, maker(campaign, found)) for stem, maker in figures]
            for path in style.save(drawn, by_default(options.output, options.overwrite)):
                print(path)
    return command.COMPLETE


def words(study: sensitivity.Study) -> list[str]:
    """A study as lines."""
    sample = f"{study.blocks} blocks of a design" if study.blocks else "a sample"
    lines = [f"{study.pair}, {sample}" if study.pair else sample]
    if study.left_out:
        lines.append(f"{study.left_out} blocks are left out, since scenes of them failed")
    if study.probability:
        share, low, high = study.probability
        lines.append(f"probability of impacts {share:.3f}, 95% interval {low:.3f} to {high:.3f}")
    for found in study.found:
        rows = [[found.quantity, "first order", "+-", "total", "+-"]]
        for place, key in enumerate(study.keys):
            numbers = (found.first, found.first_error, found.total, found.total_error)
            rows.append([key, *(f"{column[place]:.3f}" for column in numbers)])
        lines += [table.plain(rows), ""]
    for way in study.directions:
        rows = [[way.quantity, "rank correlation"]]
        rows += [[key, f"{value:+.3f}"] for key, value in zip(study.keys, way.correlation, strict=True)]
        lines += [table.plain(rows), f"by chance up to {way.by_chance:.3f}", ""]
    if study.constant:
        lines.append(f"the same at all points: {', '.join(study.constant)}")
    return lines


def power_of_two(text: str) -> int:
    number = command.positive(text)
    if number < sensitivity.LEAST_BLOCKS or number & (number - 1):
        raise argparse.ArgumentTypeError(f"'{text}' is not a power of two from 2 on")
    return number


if __name__ == "__main__":
    command.run(main)
