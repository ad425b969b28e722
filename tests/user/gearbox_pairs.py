"""Single pairs of the ready gearbox map."""

from __future__ import annotations


def one_pair(text: str, place: int) -> str:
    """The input of gearbox_map with one of its pairs alone and without its campaign."""
    head, *pairs = text.split("&gear\n")
    rest = pairs[-1]
    pairs[-1] = rest[: rest.index("&shaft\n")]
    return f"{head}&gear\n{pairs[place]}{rest[rest.index('&shaft') : rest.index('&campaign')]}"
