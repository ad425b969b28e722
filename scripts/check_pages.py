"""Counts what makes the Markdown pages hard to read; fails above a limit. Usage: check_pages.py [PAGE ...]

Counted are sentences of more than 25 words, paragraphs of more than 6 lines of 100 characters (README.md: 4),
and words of the idiom list. Code, tables and headings are no sentences; idioms count in tables, too, but for
those that a command writes. CHANGELOG.md is left out: a released section does not change. Named pages are
printed place by place."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

WORDS, LINES, LINE, README_LINES = 25, 6, 100, 4
# Shares of all sentences and paragraphs in percent, and idioms, over all pages.
LONG_SENTENCES, LONG_PARAGRAPHS, IDIOMS = 10.0, 3.0, 0

IDIOM = re.compile(
    r"\b(?:t[eo]ll(?:s|ing)?|told|nobody|somebody|lead(?:s|ing)? to|led to|so far|hangs? on|reckon\w*"
    r"|stands? (?:there|here)|makes? of|leaves? of|kn[eo]ws? nothing|held against|holds? against"
    r"|takes? for granted)\b",
    re.IGNORECASE,
)
GENERATED = re.compile(r"^<!-- (?!end)[^\n]*-->\n.*?^<!-- end[^\n]*-->$", re.MULTILINE | re.DOTALL)
FRONT_MATTER = re.compile(r"\A---\n.*?^---$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"^```.*?^```$|(?:^|(?<=\n\n))(?: {4}[^\n]*\n+)+", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"`[^`]+`")
LINK = re.compile(r"!?\[([^]]*)\]\([^)]*\)")
# An item of a list, a quotation or a caption begins a paragraph of its own.
BREAK = re.compile(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )")
END = re.compile(r"(?<=[.!?])[\")*]*\s+(?=[\"(*]*[A-Z0-9`])")
SHORT = re.compile(r"\b(?:e\.g|i\.e|[Ff]igs?|[Ee]qs?|J|Mech|Eng|Sci|Env|Turkish|vol|no|ibid)\.")


class Count(NamedTuple):
    sentences: int = 0
    long_sentences: int = 0
    paragraphs: int = 0
    long_paragraphs: int = 0
    idioms: int = 0


def prose(text: str) -> tuple[str, str]:
    """The text without code, generated tables and links; and the same without tables and headings."""
    text = CODE.sub("\n\n", GENERATED.sub("\n\n", FRONT_MATTER.sub("", text)))
    text = INLINE.sub("Code", LINK.sub(r"\1", re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)))
    return text, re.sub(r"^(?:\||#).*$", "\n", text, flags=re.MULTILINE)


def long_parts(text: str, lines: int) -> tuple[Count, list[str]]:
    """The counts of a page, and each place that is counted."""
    words, sentences = prose(text)
    idioms = [f"idiom '{found[0]}'" for found in IDIOM.finditer(words)]
    paragraphs = [" ".join(part.split()) for part in BREAK.split(sentences)]
    paragraphs = [part for part in paragraphs if part]
    parts = [part for each in paragraphs for part in END.split(SHORT.sub("code", each))]
    long = [part for part in parts if len(re.findall(r"\S*\w\S*", part)) > WORDS]
    tall = [part for part in paragraphs if len(part) > lines * LINE]
    places = [*idioms, *(f"sentence: {part}" for part in long), *(f"paragraph: {part[:70]}" for part in tall)]
    return Count(len(parts), len(long), len(paragraphs), len(tall), len(idioms)), places


def main() -> int:
    named = sys.argv[1:]
    listed = subprocess.run(["git", "ls-files", "*.md"], capture_output=True, text=True, check=True)
    pages = named or [page for page in listed.stdout.split() if page != "CHANGELOG.md"]
    total = Count()
    print(f"{'page':32} sentences  long  paragraphs  long  idioms")
    for page in pages:
        count, places = long_parts(Path(page).read_text(), README_LINES if page == "README.md" else LINES)
        print(f"{page:32} {count[0]:9} {count[1]:5} {count[2]:11} {count[3]:5} {count[4]:7}")
        total = Count(*(sum(both) for both in zip(total, count, strict=True)))
        for place in places if named else ():
            print("   ", place)
    print(f"{'all':32} {total[0]:9} {total[1]:5} {total[2]:11} {total[3]:5} {total[4]:7}")
    return int(
        not named
        and (
            total.long_sentences > 0.01 * LONG_SENTENCES * total.sentences
            or total.long_paragraphs > 0.01 * LONG_PARAGRAPHS * total.paragraphs
            or total.idioms > IDIOMS
        )
    )


if __name__ == "__main__":
    sys.exit(main())
