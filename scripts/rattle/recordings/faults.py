"""What a recording is refused with."""

from __future__ import annotations

import importlib
from typing import Any

from rattle.command import CommandError

# Packages as pip calls them, by the module that is imported.
PACKAGES = {"nptdms": "npTDMS", "pint": "Pint"}


class RecordingError(CommandError):
    """A recording that cannot be used, explained in one plain sentence with file and line where known."""


class MissingLibrary(RecordingError):
    """A package of the optional extra that is not installed."""


def library(name: str) -> Any:
    """A module of the optional extra, imported when it is needed."""
    try:
        return importlib.import_module(name)
    except ImportError:
        package = PACKAGES.get(name.partition(".")[0], name.partition(".")[0])
        raise MissingLibrary(
            f"this needs the package {package}: pip install 'rattle[recordings]', "
            f"or pip install {package}, brings it."
        ) from None
