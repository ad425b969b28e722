"""Counts in words."""

from __future__ import annotations


def counted(number: int, one: str, several: str = "") -> str:
    """As in '1 scene' and '2 scenes'; `several` stands behind other numbers, by default `one` with an s."""
    return f"{number} {one if number == 1 else several or one + 's'}"
