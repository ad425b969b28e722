"""The parts of a page: text, numbers, tables and figures as HTML that needs no other file."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from html import escape
from io import StringIO
from typing import TYPE_CHECKING, Any

import numpy as np

from rattle.command import CommandError, words_of_import
from rattle.figures import style
from rattle.figures.fit import shrink
from rattle.result import ResultError
from rattle.rounding import ERROR_DIGITS, stated_error

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Units in which numbers are read more easily: from which size on, factor and name, the largest first.
STEPS = {
    "m": ((1e-3, 1.0, "m"), (1e-8, 1e6, "\N{MICRO SIGN}m"), (1e-11, 1e9, "nm")),
    "m/s": ((0.1, 1.0, "m/s"), (1e-6, 1e3, "mm/s")),
    "s": ((0.1, 1.0, "s"), (1e-5, 1e3, "ms")),
    "Pa": ((1e9, 1e-9, "GPa"), (1e5, 1e-6, "MPa")),
    "J": ((1e-2, 1.0, "J"), (1e-6, 1e3, "mJ")),
}
UNIT_WORDS = {
    "m/s2": "m/s\N{SUPERSCRIPT TWO}",
    "rad/s2": "rad/s\N{SUPERSCRIPT TWO}",
    "degC": "\N{DEGREE SIGN}C",
    "-": "",
    "of key": "",
}
DIGITS = 6
FEW_DIGITS = 4
WIDTH = 4.6  # inches of figures: their type is legible on a telephone
MOST_NUMBERS = 15
POWER = re.compile(r"e([+-])0*(\d+)$")

# What a page is on, and of what.
ABOUT = (
    "A loose gear pair, shaken by the engine, hammers through its oil film. This page says {what}, and how "
    "far that can be trusted. Computed with rattle."
)
OF_MOTIONS = "how the tooth pair moves under the force given here, how it rattles"
OF_THRESHOLDS = "where the tooth pair begins to move in another way"

STYLE = """
:root { color-scheme: light;
  --ink: #1d2429; --soft: #57636b; --rule: #d5dbdf; --ground: #f5f7f8; --blue: #0072b2; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem 1.25rem 3rem; max-width: 58rem; color: var(--ink); background: #fff;
  font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .2rem; }
p + h1, div + h1, nav + h1, pre + h1 { margin-top: 3.5rem; }
h2 { font-size: 1.25rem; margin: 2.4rem 0 .6rem; padding-top: .5rem; border-top: 2px solid var(--ink); }
h3 { font-size: 1.02rem; margin: 1.6rem 0 .4rem; }
p { margin: .4rem 0; max-width: 46rem; }
.lead, figcaption, .note { color: var(--soft); }
.lead { margin-bottom: 1rem; }
code, pre { font-family: ui-monospace, "DejaVu Sans Mono", monospace; font-size: .86em; }
pre { background: var(--ground); border: 1px solid var(--rule); padding: .7rem .9rem; overflow-x: auto;
  white-space: pre-wrap; overflow-wrap: anywhere; }
nav a { margin-right: 1rem; }
a { color: var(--blue); }
.verdict { background: var(--ground); border-left: .35rem solid var(--blue);
  padding: .7rem 1rem; margin: .8rem 0; }
.verdict.doubt { border-color: #d55e00; }
.class { font-size: 1.5rem; font-weight: 650; margin: 0 0 .2rem; }
.second { font-weight: 600; margin: 0 0 .3rem; }
table.numbers { max-width: 40rem; }
.badge { display: inline-block; font-size: .85rem; font-weight: 600; padding: .1rem .55rem;
  margin-left: .5rem;
  border: 1px solid currentColor; border-radius: .8rem; vertical-align: .2rem; white-space: nowrap; }
.badge.good { color: #00664c; } .badge.doubt { color: #a34500; } .badge.open { color: var(--soft); }
.wide { overflow-x: auto; margin: .5rem 0; }
table { border-collapse: collapse; width: 100%; font-size: .9rem; }
th, td { text-align: left; vertical-align: top; padding: .22rem .7rem .22rem 0;
  border-bottom: 1px solid var(--rule); }
th { border-bottom: 1px solid var(--ink); }
td.number { text-align: right; font-variant-numeric: tabular-nums; padding-right: 1.1rem; }
td.number span { white-space: nowrap; }
th.number { text-align: right; padding-right: 1.1rem; }
td.meaning { color: var(--soft); }
table.dense { font-size: .84rem; }
table.dense :is(th, td, th.number, td.number) { padding-right: .55rem; }
table.explained td.meaning { width: 52%; }
table.explained td.number { max-width: 17rem; overflow-wrap: break-word; }
tr.group td { font-weight: 650; padding-top: .7rem; }
figure { margin: 1.2rem 0; }
figure svg { display: block; width: 100%; height: auto; max-width: 36rem; }
details { border-top: 1px solid var(--rule); }
details > summary { cursor: pointer; padding: .3rem 0; }
details > summary h2 { display: inline; border: 0; padding: 0; font-size: 1.05rem; }
details details { margin-left: 1rem; }
.appendix { margin-top: 2.4rem; }
figcaption { font-size: .9rem; max-width: 46rem; margin-top: .3rem; }
@media (max-width: 640px) {
  body { padding: 1rem .8rem 2rem; font-size: 15px; }
  h1 { font-size: 1.4rem; }
  table { font-size: .82rem; }
  table.explained td.meaning { display: block; width: auto; padding: 0 0 .35rem; border-bottom: 0; }
  table.explained tr { display: grid; grid-template-columns: 1fr auto; border-bottom: 1px solid var(--rule); }
  table.explained td { border-bottom: 0; overflow-wrap: anywhere; }
  table.explained td.meaning { grid-column: 1 / 3; }
  table.explained td.number { white-space: normal; max-width: 56vw; }
  table.explained th.meaning { display: none; }
}
@media print {
  @page { size: A4; margin: 16mm 15mm; }
  body { max-width: none; padding: 0; font-size: 10pt; orphans: 1; widows: 1; }
  h2, h3 { break-after: avoid; }
  figure, tr, .verdict { break-inside: avoid; }
  thead { display: table-header-group; }
  .wide { overflow: visible; }
  nav, .screen { display: none; }
  figure { display: inline-block; width: 86mm; margin: .3rem 3mm .3rem 0; vertical-align: top; }
  figcaption { font-size: 8pt; }
  figure.main { width: 125mm; }
  h1 { font-size: 16pt; }
  h2 { margin-top: 1rem; font-size: 12pt; }
  .class { font-size: 13pt; }
  .verdict { padding: .3rem .8rem; margin: .4rem 0; }
  table, table.dense { font-size: 8pt; line-height: 1.3; }
  .brief .appendix { display: none; }
  .appendix { break-before: page; columns: 2; column-gap: 7mm; font-size: 6.5pt; line-height: 1.3; }
  .appendix .appendix { break-before: auto; columns: auto; margin-top: .6rem; }
  .appendix :is(table, table.dense, figcaption, .note, .class, code) { font-size: 6.5pt; }
  .appendix :is(th, td) { padding: .08rem .3rem .08rem 0; overflow-wrap: anywhere; }
  .appendix td.number span { white-space: normal; }
  .appendix :is(h1, h2), .appendix details > summary h2 {
    font-size: 9pt; margin: .6rem 0 .2rem; padding: 0; }
  .appendix h3 { font-size: 7.5pt; margin: .5rem 0 .2rem; }
  .appendix details details { margin-left: 0; }
  .appendix .verdict { padding: .3rem .5rem; margin: .3rem 0; }
  .appendix figure { width: 100%; margin: .3rem 0; }
  .appendix .meaning { display: none; }
  table.numbers { break-inside: avoid; }
  .appendix pre { font-size: 5pt; line-height: 1.2; padding: .3rem; }
  details > :not(summary) { display: revert; }
  details::details-content { content-visibility: visible; display: block; }
  details > summary { list-style: none; }
  pre { font-size: 8pt; }
}
"""


def document(title: str, body: Sequence[str], *, brief: bool = False) -> str:
    """The whole page; a brief one prints without its appendix."""
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>{STYLE}</style>\n</head>\n"
        f"<body{_kind('brief' if brief else '')}>\n" + "\n".join(body) + "\n</body>\n</html>\n"
    )


def heading(level: int, words: str, anchor: str = "") -> str:
    mark = f' id="{escape(anchor)}"' if anchor else ""
    return f"<h{level}{mark}>{escape(words)}</h{level}>"


def paragraph(words: str, kind: str = "") -> str:
    """A paragraph of plain text."""
    return f"<p{_kind(kind)}>{escape(words)}</p>"


def verdict_box(
    word: str,
    badge: tuple[str, str] | None,
    sentences: Sequence[str],
    *,
    doubt: bool,
    second: tuple[str, tuple[str, str]] | None = None,
) -> str:
    """The verdict: one word, how far it can be trusted, and a paragraph of plain text.

    `second`: another word below the first, and how far that can be trusted.
    """

    def headed(words: str, kind: str, own: tuple[str, str] | None) -> str:
        mark = f'<span class="badge {own[0]}">{escape(own[1])}</span>' if own else ""
        return f'<p class="{kind}">{escape(words)}{mark}</p>'

    lines = [headed(word, "class", badge), *([headed(second[0], "second", second[1])] if second else [])]
    lines.append(paragraph(" ".join(filter(None, sentences))))
    return f'<div class="verdict{" doubt" if doubt else ""}">\n' + "\n".join(lines) + "\n</div>"


def numbers(rows: Sequence[Sequence[Any]], heads: Sequence[str] = ("In numbers", "")) -> list[str]:
    """The one table of numbers that everybody should see: words, then numbers, MOST_NUMBERS at most."""
    rows = rows[: MOST_NUMBERS // (len(heads) - 1)]
    kinds = ("", *("number" for _ in heads[1:]))
    return [table(heads, rows, kinds=kinds, kind="numbers")] if rows else []


def fold(words: str, parts: Sequence[str], anchor: str = "") -> list[str]:
    """Parts that open by a click, and in print stand in the appendix."""
    if not parts:
        return []
    return ["<details>", f"<summary>{heading(2, words, anchor)}</summary>", *parts, "</details>"]


def section(words: str, sentences: Iterable[str]) -> list[str]:
    """A heading with a paragraph for each sentence; nothing without any."""
    said = [paragraph(sentence) for sentence in sentences if sentence]
    return [heading(2, words), *said] if said else []


def appendix(parts: Sequence[str]) -> list[str]:
    """Folds that begin on a new sheet in print."""
    return ['<section class="appendix">', *parts, "</section>"] if parts else []


def table(
    heads: Sequence[str], rows: Sequence[Sequence[Any]], *, kinds: Sequence[str], kind: str = ""
) -> str:
    """A table; `kinds` says of each column whether it holds text, a 'number' or a 'meaning'.

    Cells are plain text, or `Cell` where they hold more. A row of one cell heads those that follow it.
    """
    lines = [
        "<tr>"
        + "".join(f"<th{_kind(k)}>{escape(h)}</th>" for h, k in zip(heads, kinds, strict=True))
        + "</tr>"
    ]
    body = []
    for row in rows:
        if len(row) == 1:
            body.append(f'<tr class="group"><td colspan="{len(heads)}">{_inner(row[0])}</td></tr>')
            continue
        cells = (f"<td{_kind(k)}>{_inner(cell)}</td>" for cell, k in zip(row, kinds, strict=True))
        body.append("<tr>" + "".join(cells) + "</tr>")
    return (
        f'<div class="wide"><table{_kind(kind)}>\n<thead>{lines[0]}</thead>\n<tbody>\n'
        + "\n".join(body)
        + "\n</tbody></table></div>"
    )


class Cell(str):
    """A cell that is HTML already."""


def code(words: str) -> Cell:
    return Cell(f"<code>{escape(words)}</code>")


def named(name: str, meaning: str) -> Cell:
    """A name with its meaning below, where no column is left for it."""
    return Cell(f'{code(name)}<br><span class="note">{escape(meaning)}</span>') if meaning else code(name)


def value(given: Any, unit: str = "", digits: int = DIGITS, beside: float | None = None) -> Cell:
    """A number or word with its unit as people read it; all digits are in the title of the cell.

    `beside`: the number whose unit it takes, if not its own.
    """
    if isinstance(given, bool):
        return Cell("yes" if given else "no")
    if isinstance(given, list | tuple | np.ndarray):
        return Cell(f"{', '.join(map(value, given))}{_behind(UNIT_WORDS.get(unit, unit))}")
    if isinstance(given, str):
        return Cell(escape(given.strip()))
    words, name = number_words(given, unit, digits, beside)
    exact = str(given) if isinstance(given, int) else repr(float(given))
    return Cell(f'<span data-value="{exact}" title="{exact} {escape(unit)}">{words}{_behind(name)}</span>')


def error(given: float, number: float, unit: str = "") -> Cell:
    """The error of a number that is reported with all digits, in its unit; a relative error belongs to 1."""
    return value(stated_error(float(given), float(number), DIGITS), unit, ERROR_DIGITS, beside=float(number))


def plain(given: float, unit: str, digits: int = DIGITS) -> str:
    """The same as text for a sentence."""
    words, name = number_words(given, unit, digits)
    return re.sub(r"&times;10<sup>(.*?)</sup>", r"e\1", words) + (f" {name}" if name else "")


def number_words(
    given: float, unit: str, digits: int = DIGITS, beside: float | None = None
) -> tuple[str, str]:
    """The digits of a number, as HTML, and the unit that they are in."""
    if isinstance(given, int):
        return str(given), UNIT_WORDS.get(unit, unit)
    number, name = float(given), UNIT_WORDS.get(unit, unit)
    if not math.isfinite(number):
        return "unknown", ""
    for least, factor, other in STEPS.get(unit, ()):
        if abs(number if beside is None else beside) >= least:
            number, name = factor * number, other
            break
    words = f"{number:.{digits}g}"
    power = POWER.search(words)
    if power:
        sign = "\N{MINUS SIGN}" if power[1] == "-" else ""
        words = f"{words[: power.start()]}&times;10<sup>{sign}{power[2]}</sup>"
    return words.replace("-", "\N{MINUS SIGN}"), name


def ranges(rows: Sequence[tuple[str, str, str, np.ndarray]]) -> str:
    """Smallest, middle and largest of the finite values of each: name, meaning, unit, values."""
    lines = []
    for name, meaning, unit, given in rows:
        known = given[np.isfinite(given)]
        three = (
            [value(float(f(known)), unit) for f in (np.min, np.median, np.max)] if known.size else ["-"] * 3
        )
        lines.append([named(name, meaning), *three])
    return table(
        ("Quantity", "Smallest", "Median", "Largest"), lines, kinds=("", "number", "number", "number")
    )


def drawing(draw: Callable[[], Figure], caption: str, salt: str, kind: str = "") -> str:
    """A figure with its caption, or the sentence that says why it cannot be drawn; 'main': large in print."""
    try:
        with style.house_style(salt):
            stream = StringIO()
            figure = draw()
            shrink(figure, WIDTH)
            figure.savefig(stream, format="svg", dpi=160, metadata={"Date": None})
    except (ResultError, CommandError) as fault:
        return paragraph(f"No figure here: {fault}", "note")
    except ImportError as fault:
        return paragraph(f"No figure here. {words_of_import(fault)}.", "note")
    picture = stream.getvalue()
    picture = picture[picture.index("<svg") :]
    picture = re.sub(r"<metadata>.*?</metadata>", "", picture, count=1, flags=re.DOTALL)
    picture = re.sub(r' (?:width|height)="[\d.]+pt"', "", picture, count=2)
    picture = picture.replace("<svg", f'<svg role="img" aria-label="{escape(caption)}"', 1)
    return f"<figure{_kind(kind)}>\n{picture}\n<figcaption>{escape(caption)}</figcaption>\n</figure>"


def _inner(cell: Any) -> str:
    return cell if isinstance(cell, Cell) else escape(str(cell))


def _behind(unit: str) -> str:
    return f"&nbsp;{escape(unit)}" if unit else ""


def _kind(kind: str) -> str:
    return f' class="{kind}"' if kind else ""
