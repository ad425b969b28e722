"""Reads a page of report.py as numbers and words."""

from __future__ import annotations

import html
import re
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path

FACTORS = {"\N{MICRO SIGN}m": 1e-6, "nm": 1e-9, "mm/s": 1e-3, "ms": 1e-3, "MPa": 1e6, "GPa": 1e9, "mJ": 1e-3}


@dataclass
class Page:
    """What stands on the page outside its figures."""

    words: str = ""
    seen: str = ""  # those that stand before the folds of the appendix
    verdicts: list[str] = field(default_factory=list)
    badges: list[str] = field(default_factory=list)
    rows: list[list[str]] = field(default_factory=list)
    numbers: list[tuple[str, str]] = field(default_factory=list)  # all digits, and what is shown
    headings: list[str] = field(default_factory=list)
    anchors: list[str] = field(default_factory=list)
    tables: list[list[list[str]]] = field(default_factory=list)  # the heads and the rows of each
    paragraphs: list[str] = field(default_factory=list)  # and captions, in their order

    def shown(self, name: str) -> str:
        """The second cell of the row that begins with this name."""
        return next(row[1] for row in self.rows if len(row) > 1 and row[0] == name)


def read_page(path: Path) -> Page:
    text = path.read_text(encoding="utf-8")
    page = Page()
    _Reader(page).feed(re.sub(r"<(svg|style)\b.*?</\1>", "", text, flags=re.DOTALL))
    return page


def figures(path: Path) -> list[str]:
    return re.findall(r"<svg.*?</svg>", path.read_text(encoding="utf-8"), flags=re.DOTALL)


def input_of(path: Path) -> str:
    """The input that the page gives."""
    return html.unescape(re.search(r'<pre class="input">(.*?)</pre>', path.read_text(), re.DOTALL)[1])


def number(shown: str) -> float:
    """The number that a reader sees, in SI units."""
    digits, _, unit = (
        shown.replace("\N{MINUS SIGN}", "-").replace("\N{MULTIPLICATION SIGN}10", "e").partition("\xa0")
    )
    return float(digits) * FACTORS.get(unit, 1.0)


class _Reader(HTMLParser):
    def __init__(self, page: Page) -> None:
        super().__init__()
        self.page = page
        self.open: list[tuple[str, str]] = []
        self.number: tuple[str, str] | None = None

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        kind = given.get("class", "")
        if tag in ("br", "meta"):
            return
        self.open.append((tag, kind))
        if tag == "tr":
            self.page.rows.append([])
            self.page.tables[-1].append(self.page.rows[-1])
        elif tag == "table":
            self.page.tables.append([])
        elif tag in ("p", "figcaption"):
            self.page.paragraphs.append("")
        elif tag in ("td", "th"):
            self.page.rows[-1].append("")
        elif tag == "span" and kind.startswith("badge"):
            self.page.badges.append("")
        elif tag == "div" and kind.startswith("verdict"):
            self.page.verdicts.append("")
        elif tag in ("h1", "h2", "h3"):
            self.page.headings.append("")
            self.page.anchors.append(given.get("id", ""))
        if "data-value" in given:
            self.number = (given["data-value"], "")

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass
        if tag == "span" and self.number:
            self.page.numbers.append(self.number)
            self.number = None

    def handle_data(self, data):
        tags = [tag for tag, _ in self.open]
        self.page.words += data
        if ("section", "appendix") not in self.open:
            self.page.seen += data
        if "p" in tags or "figcaption" in tags:
            self.page.paragraphs[-1] += data
        if "td" in tags or "th" in tags:
            self.page.rows[-1][-1] += data
        if any(kind.startswith("badge") for _, kind in self.open):
            self.page.badges[-1] += data
        if any(kind.startswith("verdict") for _, kind in self.open):
            self.page.verdicts[-1] += data
        if any(tag in ("h1", "h2", "h3") for tag in tags):
            self.page.headings[-1] += data
        if self.number:
            self.number = (self.number[0], self.number[1] + data)
