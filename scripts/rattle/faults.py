"""What the program says of bad input, as exceptions that carry each fault with its place."""

from __future__ import annotations

import re
from typing import NamedTuple

# The program writes: FILE:LINE: &group key: sentence. Line, group and key may be missing.
_FAULT = re.compile(
    r"(?P<file>.+?)(?::(?P<line>\d+))?:(?: &(?P<group>\w+)(?: (?P<key>[^\s:]+))?:)? (?P<message>.*)"
)


class Fault(NamedTuple):
    """One fault: where it is, and what is wrong; None where the program names no such place."""

    file: str
    line: int | None
    group: str | None
    key: str | None
    message: str

    def __str__(self) -> str:
        line = f":{self.line}" if self.line else ""
        key = f" {self.key}" if self.key else ""
        group = f" &{self.group}{key}:" if self.group else ""
        return f"{self.file}{line}:{group} {self.message}"


class RunError(Exception):
    """The program did not do what was asked; `faults` are its own words, one by one."""

    def __init__(self, faults: list[Fault], exit_code: int, words: str = "") -> None:
        super().__init__("\n".join(map(str, faults)) or words or f"rattle ended with exit code {exit_code}.")
        self.faults = tuple(faults)
        self.exit_code = exit_code


class InputError(RunError):
    """Bad input: nothing was run."""


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
