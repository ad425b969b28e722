#!/usr/bin/env python3
"""Draw a sweep: steady motions along a key, there and back."""

from __future__ import annotations

import argparse
from pathlib import Path

import rattle
from rattle import command
from rattle.figures import style, sweep


def main() -> None:
    parser = argparse.ArgumentParser(description="Draw a sweep as sweep_NAME.png and sweep_NAME.pdf.")
    parser.add_argument("result", type=Path, help="result file of a sweep task")
    parser.add_argument("--output", type=Path, default=Path("."), metavar="DIR", help="where the figure goes")
    options = parser.parse_args()
    result = rattle.read(options.result)
    with style.house_style():
        for path in style.save(sweep.draw(result), options.output, f"sweep_{result.scene_name}"):
            print(path)


if __name__ == "__main__":
    command.run(main)
