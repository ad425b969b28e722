#!/usr/bin/env python3
"""Write &gear, &shaft and &oil of what a drawing, a spreadsheet or a REXS model says of gear pairs."""

from __future__ import annotations

import argparse
from pathlib import Path

from rattle import command, outputs

INCOMPLETE = 1


def main() -> int:
    options = parse_options()
    from rattle.gear_data.scene import read  # needs the kernels, which convert units

    if options.output is not None:
        outputs.check([options.output], overwrite=options.overwrite, inputs=options.files)
    scene = read(options.files, options.loose)
    if options.output is None:
        print(scene.text, end="")
    else:
        files = [(options.output, outputs.text_writer(scene.text))]
        outputs.write(files, overwrite=options.overwrite, inputs=options.files)
        print(options.output)
    for sentence in scene.odd:
        command.note(sentence)
    for sentence in scene.missing:
        command.note(f"still missing: {sentence}")
    return INCOMPLETE if scene.missing else command.COMPLETE


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Write an input of what drawings and data sheets say: CSV files and spreadsheets (.xlsx) "
        "with a quantity a row, its unit, and a column of values for each pair, and the cylindrical stages "
        "of REXS models (XML). Several files complete one another. Units are converted, values are checked "
        "by the program, names that are not known are refused. Exit code 1: written, but keys are missing.",
        epilog="names, units and what is read of REXS: input/GEARS.md",
    )
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE", help=".csv, .xlsx or .rexs")
    parser.add_argument(
        "--loose",
        type=command.names,
        default=[],
        metavar="GEAR,GEAR",
        help="loose gears of a REXS model that are gear_1 of their stage; without it each gear_2 is loose",
    )
    parser.add_argument("--output", type=Path, metavar="FILE.nml", help="the input (printed)")
    outputs.add_option(parser)
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
