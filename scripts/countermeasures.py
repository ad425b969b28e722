#!/usr/bin/env python3
"""What would stop the rattle of gear pairs: how far each thing has to change, and what an effort gains."""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path

from rattle import command, outputs
from rattle.countermeasures import table, variants, words
from rattle.countermeasures.scenes import Scenes, opened
from rattle.countermeasures.study import PairStudy, study
from rattle.faults import RunError
from rattle.outputs import Writer


def main() -> int:
    options = parse_options()
    ranges = dict(options.range)
    if len(ranges) < len(options.range):
        raise command.CommandError("--range gives a key twice.")
    with tempfile.TemporaryDirectory(prefix="rattle-") as folder:
        try:
            scenes = opened(options.input, Path(folder))
            asked = variants.read(options.variants, scenes) if options.variants else []
            places = paths(options, scenes, with_table=bool(asked) or len(scenes.pairs) > 1)
            given = [options.input, *([options.variants] if options.variants else [])]
            outputs.check(places, overwrite=options.overwrite, inputs=given)
            found = study(scenes, ranges, options.keys, asked, command.note)
        except RunError as fault:
            return command.complain(str(fault))
    page = words.page(scenes, found.pairs, found.together)
    print(page)
    texts = [table.to_csv(found.pairs), page, table.together_csv(scenes, found.together)]
    files = [(path, outputs.text_writer(text)) for path, text in zip(places, texts, strict=False)]
    for path in draw(found.pairs, scenes.name, files, options):
        print(path)
    return command.COMPLETE


def paths(options: argparse.Namespace, scenes: Scenes, *, with_table: bool) -> list[Path]:
    """The tables that are written; that of all pairs together only where there is anything in it."""
    endings = [table.ENDING, table.PAGE_ENDING, *([table.TOGETHER_ENDING] if with_table else [])]
    return [options.output / f"{scenes.name}{ending}" for ending in endings]


def draw(
    pairs: Sequence[PairStudy], name: str, files: Sequence[tuple[Path, Writer]], options: argparse.Namespace
) -> list[Path]:
    """Write a figure for each pair, and the tables with them."""
    from rattle.figures import countermeasures, style  # matplotlib only where something was found
    from rattle.figures.options import by_default

    with style.house_style():
        stem = f"countermeasures_{name}"
        stems = [f"{stem}.{pair.name}" if len(pairs) > 1 else stem for pair in pairs]
        figures = [(stem, countermeasures.draw(pair)) for stem, pair in zip(stems, pairs, strict=True)]
        return style.save(figures, by_default(options.output, options.overwrite), files)


def new_range(text: str) -> tuple[str, tuple[float, float]]:
    """The value of an option that is GROUP.KEY=FIRST:LAST."""
    key, equals, ends = text.partition("=")
    parts = ends.split(":")
    if not equals or len(parts) != 2:
        raise argparse.ArgumentTypeError(f"'{text}' is not GROUP.KEY=FIRST:LAST")
    first, last = map(command.finite, parts)
    if not first < last:
        raise argparse.ArgumentTypeError(f"'{text}' does not go from a smaller to a larger value")
    return key.strip(), (first, last)


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Report for each gear pair of an input, at its operating point, how far drag, inertia, "
        "backlash, face width, oil, damping, immersion, synchroniser gap and the acceleration of each order "
        "have to change to end double-sided impacts, impacts and separation, and what an effort of a tenth "
        "gains in dB of film force rms. Each change is solved again. Tables NAME.countermeasures.csv and "
        ".md, and a figure a pair; report.py shows them if they are beside the results."
    )
    parser.add_argument(
        "input", type=Path, help="input of a pair or gearbox; of a map, at its operating point"
    )
    parser.add_argument(
        "--range",
        type=new_range,
        action="append",
        default=[],
        metavar="KEY=FIRST:LAST",
        help="range of a key instead of the usual one; may be repeated",
    )
    parser.add_argument(
        "--keys", type=command.names, default=[], metavar="KEY,KEY", help="change these only, all by default"
    )
    parser.add_argument(
        "--variants",
        type=Path,
        metavar="FILE.csv",
        help="also solve these: columns variant, cost and keys as gear.backlash; *0.9 multiplies the value",
    )
    parser.add_argument(
        "--output", type=Path, default=Path("results"), metavar="FOLDER", help="where files go (results)"
    )
    outputs.add_option(parser)
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
