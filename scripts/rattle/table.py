"""Tables of text for terminals and reports."""

from __future__ import annotations

from collections.abc import Sequence


def plain(rows: Sequence[Sequence[str]]) -> str:
    """Aligned columns, the first to the left, the others to the right; the first row is the head."""
    widths = _widths(rows)
    lines = [_aligned(row, widths, "  ").rstrip() for row in rows]
    lines.insert(1, "  ".join("-" * width for width in widths))
    return "\n".join(lines)


def markdown(rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table, also aligned as plain text."""
    escaped = [[cell.replace("|", "\\|") for cell in row] for row in rows]
    widths = [max(width, 3) for width in _widths(escaped)]
    lines = [f"| {_aligned(row, widths, ' | ')} |" for row in escaped]
    rules = ["-" * widths[0], *("-" * (width - 1) + ":" for width in widths[1:])]
    lines.insert(1, f"| {' | '.join(rules)} |")
    return "\n".join(lines)


def _widths(rows: Sequence[Sequence[str]]) -> list[int]:
    return [max(map(len, column)) for column in zip(*rows, strict=True)]


def _aligned(row: Sequence[str], widths: Sequence[int], separator: str) -> str:
    first, *others = row
    cells = [first.ljust(widths[0])]
    cells += [cell.rjust(width) for cell, width in zip(others, widths[1:], strict=True)]
    return separator.join(cells)
