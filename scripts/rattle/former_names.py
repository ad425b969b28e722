"""Former names: results and summaries that have them are read, and they may be asked for, with a warning.

They are read for one version. The program knows those of keys and quantities itself.
"""

from __future__ import annotations

import warnings
from collections.abc import Container, Mapping
from types import MappingProxyType
from typing import Any

# Columns and keys of summaries.
FORMER_NAMES: Mapping[str, str] = MappingProxyType(
    {
        "line_count": "harmonic_count",
        "line_count_is_bound": "harmonic_count_is_bound",
        "lines_by_integrals": "harmonics_by_integrals",
        "loudness_error": "severity_error",
        "certified": "verified",
        "certified_below": "verified_below",
        "certified_above": "verified_above",
        "certificate": "verification",
        "certificate_text": "verification_text",
        "line": "trace",
        "lines": "traces",
        "lines_without_crossing": "traces_without_crossing",
    }
)
FORMER_KEYS: Mapping[str, Mapping[str, str]] = MappingProxyType(
    {
        "spectrum": {
            "certify": "verify",
            "certificate_tolerance": "verification_tolerance",
            "line_threshold": "harmonic_threshold",
            "idle_lines": "idle_harmonics",
        }
    }
)


class Names(dict[str, Any]):
    """Values by their names, which may be asked for by their former names, with a warning."""

    def __missing__(self, name: str) -> Any:
        present = asked_for(name, self)
        if present == name:
            raise KeyError(name)
        return self[present]


def asked_for(name: str, known: Container[str]) -> str:
    """The present name of what is asked for by a former name, with a warning; any other name as it is."""
    present = FORMER_NAMES.get(name, name)
    if name in known or present not in known:
        return name
    if present != name:
        warnings.warn(f"{name} is called {present} now", FutureWarning, stacklevel=3)
    return present


def present_names(names: tuple[str, ...]) -> tuple[str, ...]:
    """The present names of columns of a result, varied keys among them."""
    return tuple(FORMER_NAMES.get(name, _present_key(name)) for name in names)


def _present_key(name: str) -> str:
    group, dot, key = name.partition(".")
    return f"{group}{dot}{FORMER_KEYS.get(group, {}).get(key, key)}"


def present_summary(keys: Mapping[str, Any]) -> Names:
    """The keys of a summary by their present names, the word of a verified class too."""
    summary = Names({FORMER_NAMES.get(name, name): value for name, value in keys.items()})
    if str(summary.get("verification", "")).strip() == "certified":
        summary["verification"] = "verified"
    return summary


def present_input(groups: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """A resolved input by the present names of its keys."""
    return {
        group: {FORMER_KEYS.get(group, {}).get(key, key): value for key, value in keys.items()}
        for group, keys in groups.items()
    }
