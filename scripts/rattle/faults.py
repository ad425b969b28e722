"""What the program says of bad or odd input: exceptions and warnings that carry each fault with its place."""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

_PACKAGE = str(Path(__file__).parent)

# The program writes: FILE:LINE: &group key: sentence. Line, group and key may be missing.
_FAULT = re.compile(
    r"(?P<file>.+?)(?::(?P<line>\d+))?:(?: &(?P<group>\w+)(?: (?P<key>[^\s:]+))?:)? (?P<message>.*)"
)
# As it begins what is odd about a key: &group key = value.
_ODD_KEY = re.compile(r"&(?P<group>\w+) (?P<key>\w+) = ")


class Fault(NamedTuple):
    """One fault: where it is, and what is wrong; None where the program names no such place."""

    file: str  #: as it was given
    line: int | None  #: from 1 on
    group: str | None  #: without its &
    key: str | None  #: without its group
    message: str  #: one plain sentence

    def __str__(self) -> str:
        line = f":{self.line}" if self.line else ""
        key = f" {self.key}" if self.key else ""
        group = f" &{self.group}{key}:" if self.group else ""
        return f"{self.file}{line}:{group} {self.message}"


class RunError(Exception):
    """The program did not do what was asked.

    Attributes
    ----------
    faults
        What it reported, a `Fault` each.
    exit_code
        The exit code of the program.
    """

    def __init__(self, faults: list[Fault], exit_code: int, words: str = "") -> None:
        super().__init__("\n".join(map(str, faults)) or words or f"rattle ended with exit code {exit_code}.")
        self.faults = tuple(faults)
        self.exit_code = exit_code


class InputError(RunError):
    """Bad input: nothing was run. Its `faults` have file, line, group and key of each fault."""


class InputWarning(UserWarning):
    """What is odd about an input that was solved all the same.

    Attributes
    ----------
    fault
        The sentence and its place.
    """

    def __init__(self, line: str) -> None:
        super().__init__(line)
        (fault,) = read_faults(line)
        named = _ODD_KEY.match(fault.message)
        self.fault = fault._replace(group=named["group"], key=named["key"]) if named else fault


def warn(lines: Iterable[str]) -> None:
    """Raise the `input_warnings` of summaries, each once, at the line outside this package that called."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        level, frame = level + 1, frame.f_back
    for line in dict.fromkeys(lines):
        warnings.warn(InputWarning(line.removeprefix("warning: ")), stacklevel=level)


def read_faults(text: str) -> list[Fault]:
    """The faults in what the program wrote to its standard error."""
    found = []
    for line in filter(None, text.splitlines()):
        match = _FAULT.fullmatch(line)
        if match is None:
            found.append(Fault("rattle", None, None, None, line))
            continue
        number = int(match["line"]) if match["line"] else None
        found.append(Fault(match["file"], number, match["group"], match["key"], match["message"]))
    return found
