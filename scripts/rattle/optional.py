"""Libraries that only some tasks need, and the sentence where one is not installed."""

from __future__ import annotations

import importlib
from types import ModuleType

# Which extra of the package brings a library.
EXTRAS = {"pandas": "tables", "xarray": "tables", "openpyxl": "tables", "scipy": "sound"}


def needed(library: str, module: str = "") -> ModuleType:
    """A library, or a module of it. Raises ModuleNotFoundError with a plain sentence if it is not there."""
    try:
        return importlib.import_module(module or library)
    except ModuleNotFoundError as fault:
        if (fault.name or "").partition(".")[0] != library:
            raise
        raise ModuleNotFoundError(
            f"{library} is not installed, which this needs; "
            f"pip install 'rattle[{EXTRAS[library]}]' brings it",
            name=library,
        ) from None
