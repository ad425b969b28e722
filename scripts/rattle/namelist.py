"""Namelist text as Python values."""

from __future__ import annotations

import re
import warnings
from collections import Counter
from typing import Any

import f90nml

_OPENING = re.compile(r"(?:^|(?<=/))[ \t]*[&$](?!end\b)[a-z]\w*", re.IGNORECASE | re.MULTILINE)
_INSIDE = re.compile(
    r"""'[^'\n]*'|"[^"\n]*"|(?P<comment>!.*|^[ \t]*\#.*)|(?P<end>/(?!\w)|[&$]end\b)|(?P<next>[&$]\w)"""
    r"|(?P<digits>\b\d+\.?\d*|\.\d+)q(?P<exponent>[+-]?\d+)\b|\((?P<first>\d*):(?P<last>\d*):(?P<stride>\d+)\)",
    re.IGNORECASE | re.MULTILINE,
)
_LAST = "1000000"  # as many elements as the program takes


class NamelistError(Exception):
    """Namelist text that cannot be parsed."""


def parse(text: str) -> dict[str, dict[str, Any]]:
    """Parse namelist text into group, key, value; groups of one name are NAME, NAME(2), NAME(3) and so on."""
    groups: dict[str, dict[str, Any]] = {}
    seen: Counter[str] = Counter()
    for name, group in parse_groups(text).items():
        seen[name] += 1
        groups[name if seen[name] == 1 else f"{name}({seen[name]})"] = dict(group)
    return groups


def parse_groups(text: str) -> f90nml.Namelist:
    """Parse namelist text into groups that also know where their arrays start, and can be written."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # of values that the parser leaves out
            groups = f90nml.Parser().reads(_plain(text))
        for group in groups.values():
            dict(group)  # what is no mapping of keys fails here
        return groups
    except Exception as fault:  # the parser shows damaged text by exceptions of many types
        detail = str(fault).splitlines()[0].rstrip(".") if str(fault) else type(fault).__name__
        raise NamelistError(f"it is not a namelist ({detail}).") from fault


def _plain(text: str) -> str:
    """The groups alone, as the parser knows them: no q exponents, no open ends before a stride."""
    text = re.sub("[\f\x1a\ufeff]", " ", text)
    parts = []
    at = 0
    while opening := _OPENING.search(text, at):
        at = opening.end()
        parts.append(opening.group().strip())
        for token in _INSIDE.finditer(text, at):
            parts.append(text[at : token.start()])
            at = token.end()
            if token["end"] or token["next"]:
                at -= len(token["next"] or "")
                parts.append("\n/\n")
                break
            if token["exponent"]:
                parts.append(f"{token['digits']}e{token['exponent']}")
            elif token["stride"]:
                parts.append(f"({token['first'] or 1}:{token['last'] or _LAST}:{token['stride']})")
            elif not token["comment"]:
                parts.append(token.group())
        else:
            parts.append(text[at:])
            break
    return "".join(parts)
