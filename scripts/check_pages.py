"""Counts what makes the Markdown pages hard to read; fails above a limit. Usage: check_pages.py [PAGE ...]

Counted are sentences of more than 25 and of more than 40 words, sentences with two passive verbs or more,
paragraphs of more than 6 lines of 100 characters (README.md: 4), words of the idiom list, and undefined
terms. Code, tables and headings are no sentences; idioms count in tables, too, but for those that a command
writes. Terms are abbreviations of capitals, Greek letters, and letters with an index or a star. They are
defined in input/GLOSSARY.md, in the symbols of fsrc/THEORY.md, or on their page: in code, in a table, or in
words. CHANGELOG.md is left out: a released section does not change. Named pages are printed place by place.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

WORDS, MOST_WORDS, LINES, LINE, README_LINES = 25, 40, 6, 100, 4
# Shares of all sentences and paragraphs in percent, and counts, over all pages.
LONG_SENTENCES, PASSIVE_CHAINS, LONG_PARAGRAPHS = 2.5, 0.5, 1.0
VERY_LONG_SENTENCES, IDIOMS, UNDEFINED_TERMS = 0, 0, 0

IDIOM = re.compile(
    r"\b(?:t[eo]ll(?:s|ing)?|told|nobody|somebody|lead(?:s|ing)? to|led to|so far|hangs? on|reckon\w*"
    r"|stands? (?:there|here)|makes? of|leaves? of|kn[eo]ws? nothing|held against|holds? against"
    r"|takes? for granted)\b",
    re.IGNORECASE,
)
PARTICIPLE = (
    r"(?:\w+ed|begun|born|bent|brought|built|chosen|cut|done|drawn|driven|found|given|held|hidden|hit|kept|known"
    r"|laid|left|lost|made|met|meant|paid|put|read|run|said|seen|sent|set|shown|split|taken|thrown|written)"
)
PASSIVE = re.compile(
    rf"\b(?:is|are|was|were|be|been|being) (?:(?:not|also|then|never|always|only|once|\w+ly) )?{PARTICIPLE}\b"
)
TERM = re.compile(
    r"(?<![\w.*/-])(?:[A-Z]{2,}(?![\w*.-])|(?<!\w)[A-Za-z]\*(?![\w*])|(?<!\w)[A-Za-z]_(?:[a-z]{1,3}|\d)(?!\w)"
    r"|(?:alpha|delta|eta|eta0|kappa|lambda|Lambda|omega|Phi|Psi|rho|sigma|tau|theta|zeta)(?![\w-]))"
)
# A term is defined before an equals sign or "be", in or before parentheses, or behind its noun.
DEFINED = (
    r"(?<!\w)(?:TERM (?:=|be\b|and \w+ be\b|\()|\((?:\w+, )?TERM\)"
    r"|(?:[Tt]he|[Aa]n?|its|one) (?:[a-z]+ ){1,2}TERM|(?:errors|slopes|multipliers) TERM)"
)
# Names of products, bodies of standards and signals of the system, and what stands for the user's own word.
NAMES = re.compile(r"AMD|EPYC|REXS|AVX|BSD|LLVM|ISO|DIN|IEC|IIIC|TR|SI|MB|README|SIG\w+|NAME|GEAR")
GENERATED = re.compile(r"^<!-- (?!end)[^\n]*-->\n.*?^<!-- end[^\n]*-->$", re.MULTILINE | re.DOTALL)
FRONT_MATTER = re.compile(r"\A---\n.*?^---$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"^```.*?^```$|(?:^|(?<=\n\n))(?: {4}[^\n]*\n+)+", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"`[^`]+`|\$[^$\n]+\$")
LINK = re.compile(r"!?\[([^]]*)\]\([^)]*\)")
# An item of a list, a quotation or a caption begins a paragraph of its own.
BREAK = re.compile(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )")
END = re.compile(r"(?<=[.!?])[\")*]*\s+(?=[\"(*]*[A-Z0-9`])")
SHORT = re.compile(r"\b(?:e\.g|i\.e|[Ff]igs?|[Ee]qs?|J|Mech|Eng|Sci|Env|Turkish|vol|no|ibid)\.")


WIDTHS = (10, 6, 9, 9, 12, 6, 8, 11)


class Count(NamedTuple):
    sentences: int = 0
    long_sentences: int = 0
    very_long_sentences: int = 0
    passive_chains: int = 0
    paragraphs: int = 0
    long_paragraphs: int = 0
    idioms: int = 0
    undefined_terms: int = 0


def prose(text: str) -> tuple[str, str]:
    """The text without code, generated tables and links; and the same without tables and headings."""
    text = CODE.sub("\n\n", GENERATED.sub("\n\n", FRONT_MATTER.sub("", text)))
    text = INLINE.sub("Code", LINK.sub(r"\1", re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)))
    return text, re.sub(r"^(?:\||#).*$", "\n", text, flags=re.MULTILINE)


def first_cells(page: str) -> str:
    """The first cells of the tables of a page that explain terms."""
    return "\n".join(re.findall(r"^\| *([^|]*?) *\|", Path(page).read_text(), re.MULTILINE))


def stem(term: str) -> str:
    """A term without its index, which may be any number or letter: a_2 is an a_n."""
    return re.sub(r"_.*", "_", term)


def any_index(term: str) -> str:
    return re.escape(stem(term)) + (r"\w+" if "_" in term else "")


def undefined_terms(text: str, words: str, explained: str) -> list[str]:
    """Terms of a page that neither the lists of terms nor the page itself explain."""
    own = "\n".join(
        [*(found[0] for found in CODE.finditer(text)), *re.findall(r"^\|.*$", text, re.MULTILINE)]
    )
    known = {stem(term) for term in TERM.findall(explained + own)}
    terms = {term for term in TERM.findall(words) if stem(term) not in known and not NAMES.fullmatch(term)}
    return sorted(term for term in terms if not re.search(DEFINED.replace("TERM", any_index(term)), words))


def long_parts(text: str, lines: int, explained: str) -> tuple[Count, list[str]]:
    """The counts of a page, and each place that is counted."""
    words, sentences = prose(text)
    idioms = [f"idiom '{found[0]}'" for found in IDIOM.finditer(words)]
    undefined = [f"undefined '{term}'" for term in undefined_terms(text, words, explained)]
    paragraphs = [" ".join(part.split()) for part in BREAK.split(sentences)]
    paragraphs = [part for part in paragraphs if part]
    parts = [part for each in paragraphs for part in END.split(SHORT.sub("code", each))]
    lengths = [len(re.findall(r"\S*\w\S*", part)) for part in parts]
    long = [part for part, length in zip(parts, lengths, strict=True) if length > WORDS]
    chains = [part for part in parts if len(PASSIVE.findall(part)) > 1]
    tall = [part for part in paragraphs if len(part) > lines * LINE]
    places = [
        *idioms,
        *undefined,
        *(f"sentence: {part}" for part in long),
        *(f"passive: {part}" for part in chains),
    ]
    places += [f"paragraph: {part[:70]}" for part in tall]
    longest = sum(length > MOST_WORDS for length in lengths)
    counts = (
        len(parts),
        len(long),
        longest,
        len(chains),
        len(paragraphs),
        len(tall),
        len(idioms),
        len(undefined),
    )
    return Count(*counts), places


def line(page: str, count: Count) -> str:
    return f"{page:40}" + "".join(f"{number:>{width}}" for number, width in zip(count, WIDTHS, strict=True))


def main() -> int:
    named = sys.argv[1:]
    listed = subprocess.run(["git", "ls-files", "*.md"], capture_output=True, text=True, check=True)
    pages = named or [page for page in listed.stdout.split() if page != "CHANGELOG.md"]
    total = Count()
    explained = first_cells("input/GLOSSARY.md") + "\n" + first_cells("fsrc/THEORY.md")
    print(f"{'page':40} sentences  long  over 40  passive  paragraphs  long  idioms  undefined")
    for page in pages:
        lines = README_LINES if page == "README.md" else LINES
        count, places = long_parts(Path(page).read_text(), lines, explained)
        print(line(page, count))
        total = Count(*(sum(both) for both in zip(total, count, strict=True)))
        for place in places if named else ():
            print("   ", place)
    print(line("all", total))
    return int(
        not named
        and (
            total.long_sentences > 0.01 * LONG_SENTENCES * total.sentences
            or total.very_long_sentences > VERY_LONG_SENTENCES
            or total.passive_chains > 0.01 * PASSIVE_CHAINS * total.sentences
            or total.long_paragraphs > 0.01 * LONG_PARAGRAPHS * total.paragraphs
            or total.idioms > IDIOMS
            or total.undefined_terms > UNDEFINED_TERMS
        )
    )


if __name__ == "__main__":
    sys.exit(main())
