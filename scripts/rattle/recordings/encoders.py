"""Two encoders, of the driving and the loose gear: their relative angle along the line of action."""

from __future__ import annotations

import argparse

from rattle.recordings.faults import RecordingError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `recording.py encoders`."""
    parser.add_argument("files", nargs="+", metavar="FILE", help="recordings of both encoders")


def run(arguments: argparse.Namespace) -> int:
    """Do what `recording.py encoders` does; returns its exit code."""
    raise RecordingError("recordings of two encoders are not read yet.")
