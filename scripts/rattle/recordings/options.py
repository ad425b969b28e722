"""Options that every task on recordings takes: files, units, the part, and the angle of the shaft."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from rattle import command
from rattle.counts import counted
from rattle.recordings.angle import BRIDGE, ShaftAngle, shaft_angle
from rattle.recordings.channels import RATE, Channel, read_channels, with_units
from rattle.recordings.faults import RecordingError


def add_recording(parser: argparse.ArgumentParser) -> None:
    """What is read, and how it is mended."""
    parser.add_argument(
        "files",
        nargs="+",
        type=Path,
        metavar="FILE",
        help="recordings of the same clock: CSV, MDF, TDMS, ...",
    )
    parser.add_argument(
        "--unit", action="append", default=[], type=_unit, metavar="NAME=UNIT", help="unit of a channel"
    )
    parser.add_argument("--rate", type=command.positive_number, metavar="HZ", help=RATE)
    parser.add_argument("--part", type=_part, metavar="FROM,TO", help="use this part alone [s]")
    parser.add_argument(
        "--bridge",
        type=command.positive_number,
        default=BRIDGE,
        metavar="S",
        help="longest gap that is bridged [s], by default %(default)s",
    )
    parser.add_argument("--mend", action="store_true", help="replace spikes and drop-outs")


def add_shaft(parser: argparse.ArgumentParser) -> None:
    """What shows the angle of the shaft."""
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--angle", metavar="NAME", help="channel with the angle of the shaft")
    which.add_argument("--tacho", metavar="NAME", help="channel with pulses of a wheel on the shaft")
    which.add_argument("--speed", metavar="NAME", help="channel with the speed of the shaft; integrated")
    parser.add_argument(
        "--pulses",
        type=command.positive,
        default=1,
        metavar="N",
        help="teeth of that wheel, missing ones too",
    )
    parser.add_argument(
        "--missing",
        type=_count,
        default=0,
        metavar="N",
        help="missing teeth, 2 of a wheel 60-2; by default none",
    )


def read(options: argparse.Namespace, notes: list[str]) -> list[Channel]:
    """The channels of all files, with the units and within the part that the options give."""
    channels: list[Channel] = []
    for path in options.files:
        channels += read_channels(path, rate=options.rate, notes=notes)
    names = [name for name, _ in options.unit]
    for name in names:
        if names.count(name) > 1:
            raise RecordingError(f"--unit gives '{name}' twice.")
    channels = with_units(channels, dict(options.unit))
    if options.part is None:
        return channels
    return [_within(channel, *options.part) for channel in channels]


def reference_name(options: argparse.Namespace) -> str | None:
    """The channel that the options name for the angle of the shaft."""
    return options.angle or options.tacho or options.speed


def angle_of(options: argparse.Namespace, reference: Channel) -> ShaftAngle:
    """The angle of the shaft from its channel, as the options say what that is; an angle if they do not."""
    return shaft_angle(
        reference,
        kind="tacho" if options.tacho else "speed" if options.speed else "angle",
        pulses_per_revolution=options.pulses,
        missing_teeth=options.missing,
        bridge=options.bridge,
        mend=options.mend,
    )


def _within(channel: Channel, begin: float, end: float) -> Channel:
    if not channel.has_time:
        raise RecordingError(f"{channel.source} has no column of time, so --part cannot choose from it.")
    inside = (channel.time >= begin) & (channel.time <= end)
    if np.sum(inside) < 4:
        raise RecordingError(
            f"{channel.source}: --part leaves {counted(int(np.sum(inside)), 'sample')} of '{channel.name}', "
            f"which was recorded from {channel.time[0]:.6g} to {channel.time[-1]:.6g} s."
        )
    return replace(channel, time=channel.time[inside], values=channel.values[inside])


def _count(text: str) -> int:
    if not (text.isascii() and text.isdecimal()):
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number")
    return int(text)


def _unit(text: str) -> tuple[str, str]:
    name, equals, unit = text.rpartition("=")
    if not equals or not name.strip() or not unit.strip():
        raise argparse.ArgumentTypeError(f"'{text}' is not NAME=UNIT")
    return name.strip(), unit.strip()


def _part(text: str) -> tuple[float, float]:
    ends = [command.finite(part) for part in text.split(",")]
    if len(ends) != 2 or not ends[0] < ends[1]:
        raise argparse.ArgumentTypeError(f"'{text}' is not two ascending times FROM,TO")
    return ends[0], ends[1]
