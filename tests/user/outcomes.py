"""What the tests look at once a call of the program has ended."""

from __future__ import annotations

import hashlib
from pathlib import Path

import f90nml

TRACES_OF_A_CRASH = (
    "acktrace",
    "Program received",
    "Fortran runtime error",
    "forrtl",
    "At line",
    "malloc",
    "free()",
)


def contents(folder: Path) -> dict[str, bytes]:
    """Everything below a folder; folders themselves count as well."""
    return {
        str(path.relative_to(folder)): b"" if path.is_dir() else path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_dir() or path.is_file()
    }


def digest(path: Path) -> str:
    """One short text for all bytes of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def summary_of(path: Path) -> dict:
    """The &summary group as Python values."""
    return f90nml.read(path)["summary"]


def assert_no_crash(text: str) -> None:
    """What a program printed holds no word of a crash."""
    assert not [trace for trace in TRACES_OF_A_CRASH if trace in text], text


def assert_faults(found: list[str], file: object, expected: list[str]) -> None:
    """Each fault begins with 'file:', then with 'line: &group key: message' as expected, in this order."""
    wanted = [f"{file}:{'' if fault[0].isdigit() else ' '}{fault}" for fault in expected]
    assert len(found) == len(wanted), "\n".join(found)
    for fault, start in zip(found, wanted, strict=True):
        assert fault.startswith(start)


def series_in(folder: Path) -> list[Path]:
    """The results in a folder, by name, without the tables of all motions of a scene beside them."""
    return sorted(path for path in folder.glob("*.rattle") if not path.name.endswith(".motions.rattle"))
