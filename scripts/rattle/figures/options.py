"""Options of every script that draws: where the figures go, and how they are written."""

from __future__ import annotations

import argparse
from pathlib import Path

from rattle import command, outputs

FORMATS = ("png", "pdf", "svg")
MILLIMETRES = 1.0 / 25.4


def common_options() -> argparse.ArgumentParser:
    """What every command takes: where the figures go, and how they are written."""
    common = argparse.ArgumentParser(add_help=False)
    group = common.add_argument_group("figures")
    outputs.add_option(group)
    group.add_argument("--output", type=Path, default=Path(), metavar="DIR", help="where the figures go (.)")
    group.add_argument(
        "--format",
        type=formats,
        # A second one takes longer than all else that drawing does.
        default=("png",),
        metavar="NAMES",
        help=f"of {', '.join(FORMATS)} (png)",
    )
    group.add_argument(
        "--width",
        type=width,
        metavar="MM",
        help="width in mm, 80 for a column, whose titles leave out the film (160)",
    )
    group.add_argument(
        "--font-size", type=font_size, metavar="PT", help="size of the type in points (9; 7 in a column)"
    )
    group.add_argument("--no-title", action="store_true", help="leave the titles out; captions say the same")
    group.add_argument("--xlim", type=limits, metavar="LO,HI", help="limits of the x axes; write --xlim=-1,1")
    group.add_argument("--ylim", type=limits, metavar="LO,HI", help="limits of the y axis of the first panel")
    group.add_argument("--dpi", type=command.positive, default=200, metavar="N", help="dots an inch (200)")
    return common


def by_default(output: Path, overwrite: bool) -> argparse.Namespace:
    """All of them as they are without an option, for scripts that have none but where files go."""
    options = common_options().parse_args([])
    options.output, options.overwrite = output, overwrite
    return options


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
