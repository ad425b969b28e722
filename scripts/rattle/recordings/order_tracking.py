"""Run-ups: orders over speed from a recording of a run-up."""

from __future__ import annotations

import argparse

from rattle.recordings.faults import RecordingError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `recording.py run-up`."""
    parser.add_argument("files", nargs="+", metavar="FILE", help="recordings of one run-up")


def run(arguments: argparse.Namespace) -> int:
    """Do what `recording.py run-up` does; returns its exit code."""
    raise RecordingError("run-ups are not read yet.")
