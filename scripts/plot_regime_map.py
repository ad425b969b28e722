#!/usr/bin/env python3
"""Draw Johnson's map of lubrication regimes and place scenes on it."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import rattle
from rattle import command, table

SUMMARY_ENDING = ".summary.nml"


def main() -> None:
    options = parse_options()
    from rattle.figures import film_regimes, style

    scenes = [read_scene(path) for path in options.scenes]
    with style.house_style():
        figure = film_regimes.draw(scenes)
        for path in style.save(figure, options.output, "regime_map"):
            command.note(str(path))
    if scenes:
        rows = film_regimes.table_rows(scenes)
        print(table.markdown(rows) if options.markdown else table.plain(rows))
    if len({scene.material for scene in scenes}) > 1:
        command.note(f"The scenes differ in alpha or E*; the hatched part is that of {scenes[0].name}.")


def read_scene(path: Path) -> Any:
    """A scene from its result and its summary, whichever is named; the result holds the resolved input."""
    from rattle.figures import film_regimes

    stem = path.name.removesuffix(SUMMARY_ENDING).removesuffix(".rattle")
    result_path = path.with_name(f"{stem}.rattle")
    summary_path = path.with_name(f"{stem}{SUMMARY_ENDING}")
    if path.name.endswith(SUMMARY_ENDING) and not result_path.exists():
        raise command.CommandError(
            f"{path} does not hold the contact of its scene, and {result_path}, which would, does not exist."
        )
    result = rattle.read(result_path)
    if result.task != "motion":
        raise command.CommandError(f"{result_path} is no motion: its contact has no static load.")
    summary = rattle.read_summary(summary_path) if summary_path.exists() else {}
    return film_regimes.new_scene(result.scene_name, result.input, summary)


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Draw the regime map of line contacts after Johnson as regime_map.png and .pdf, "
        "place scenes on it by their static load Q + m g (a line: the range of the applied force), and "
        "print where they lie. Without scenes the bare map is drawn."
    )
    parser.add_argument(
        "scenes",
        nargs="*",
        type=Path,
        metavar="SUMMARY|RESULT",
        help="NAME.summary.nml or NAME.rattle of a motion",
    )
    parser.add_argument("--output", type=Path, default=Path("."), metavar="DIR", help="where the figure goes")
    parser.add_argument("--markdown", action="store_true", help="print the table in Markdown")
    return parser.parse_args()


if __name__ == "__main__":
    command.run(main)
