"""Mutants by rule: slips of a person in a statement of Fortran or Python, made of its tokens."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

# The higher the level of an operator, the closer it binds.
LEVELS = {
    **dict.fromkeys((".or.", "or", ".eqv.", ".neqv."), 1),
    **dict.fromkeys((".and.", "and"), 2),
    **dict.fromkeys((".not.", "not"), 3),
    **dict.fromkeys(("==", "/=", "!=", "<", "<=", ">", ">="), 4),
    **dict.fromkeys(("//", "|", "&"), 5),
    **dict.fromkeys(("+", "-"), 6),
    **dict.fromkeys(("*", "/"), 7),
    "**": 8,
}
# Operators of which an operand may be forgotten, by their levels, and those that may stand before one alone.
FORGETFUL, UNARY = (1, 2, 5, 6, 7), ("+", "-", "~", ".not.", "not")
ENDS = {",", "=", "=>", ":", ";", "::", "+=", "-=", "*=", "|=", "if", "else", "for", "in", "return", "lambda"}
ASSIGNS = {"=", "+=", "-=", "*=", "|=", "=>"}
OPEN, CLOSE = ("(", "[", "{"), (")", "]", "}")
EXCHANGED = {
    "<": ("<=", ">"),
    "<=": ("<",),
    ">": (">=", "<"),
    ">=": (">",),
    "==": ("/=",),
    "/=": ("==",),
    "!=": ("==",),
    "+": ("-",),
    "-": ("+",),
    "*": ("/",),
    "/": ("*",),
    "|": ("&",),
    "&": ("|",),
    ".and.": (".or.",),
    ".or.": (".and.",),
    "and": ("or",),
    "or": ("and",),
    ".true.": (".false.",),
    ".false.": (".true.",),
    "True": ("False",),
    "False": ("True",),
}
# Names that are taken for each other, and parts of names, where the other name stands in the file, too.
WORDS = "min max,minval maxval,minloc maxloc,any all,floor ceiling,sin cos,exit cycle,break continue"
PARTS = (
    "first last,minimum maximum,lower upper,below above,low high,drive coast,quietest loudest,left right,x y,"
    "film velocity,rows columns,before after,earlier later,least largest,lowest highest"
)


def both_ways(pairs: str) -> dict[str, str]:
    """The other one of each."""
    split = [pair.split() for pair in pairs.split(",")]
    return {one: other for pair in split for one, other in (pair, pair[::-1])}


OTHER_WORD, OTHER_PART = both_ways(WORDS), both_ways(PARTS)
# Functions that may be forgotten; of several arguments one is all that is left.
FORGOTTEN = {"min", "max", "merge", "abs", "sqrt", "exp", "log", "floor", "ceiling"}
PATTERN = r"""(?P<comment>{comment}[^\n]*)|(?P<text>{text})
    |(?P<number>(?:\d+\.\d*|\.\d+|\d+)(?:[eEdD][+-]?\d+)?(?:_\w+)?)|(?P<name>[A-Za-z_]\w*)
    |(?P<word>\.[A-Za-z]+\.)|(?P<sign>\*\*|//|==|[/!<>+*|-]=|=>|::|->|:=|[-+*/<>=(){{}}\[\],:;%.&|~@])
    |(?P<end>\n)|(?P<blank>\s|\\\n)|(?P<rest>.)"""
FORTRAN_TEXT = r"""'[^'\n]*'|"[^"\n]*\""""
PYTHON_TEXT = (
    r"""[A-Za-z]{0,2}(?:\"{3}(?s:.*?)\"{3}|'{3}(?s:.*?)'{3}|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')"""
)
FORTRAN = re.compile(PATTERN.format(comment="!", text=FORTRAN_TEXT), re.VERBOSE)
PYTHON = re.compile(PATTERN.format(comment=r"\#", text=PYTHON_TEXT), re.VERBOSE)
# Statements that compute nothing, by their first word; a unit of a program, by any of them.
SILENT = re.compile(
    "use|implicit|public|private|end|module|contains|interface|import|procedure|abstract|program|include|format"
    "|type|class|generic|final|submodule|def|from|@|assert"
)
UNITS = {"function", "subroutine"}
# Brackets behind these hold no arguments, or such whose order makes no difference.
NO_CALL = re.compile(
    "write|read|open|close|inquire|allocate|deallocate|associate|select|case|min|max|if|while|elif|and|or|not|in"
    "|return|for|intent|dimension|isinstance"
)
JUMPS = {"call", "return", "exit", "cycle", "continue", "break", "raise"}
BRANCHES = {"if", "elif", "while", "for", "with", "do", "return", "yield"}


@dataclass(frozen=True)
class Token:
    kind: str
    text: str
    start: int

    @property
    def end(self) -> int:
        return self.start + len(self.text)


@dataclass(frozen=True)
class Change:
    """The text of a file from `start` to `end`, what it becomes, and by which rule."""

    start: int
    end: int
    text: str
    rule: str

    def apply(self, text: str) -> str:
        return text[: self.start] + self.text + text[self.end :]


def statements(text: str, python: bool) -> Iterator[list[Token]]:
    """The tokens of each statement, which may go on over several lines."""
    found: list[Token] = []
    depth, goes_on = 0, False
    for match in (PYTHON if python else FORTRAN).finditer(text):
        token = Token(match.lastgroup or "", match[0], match.start())
        depth += (match[0] in OPEN) - (match[0] in CLOSE)
        if token.kind == "end" and not depth and not goes_on:
            if found:
                yield found
            found = []
        elif token.text == "&" and not python:
            goes_on = bool(found)
        elif token.kind not in ("end", "blank", "comment"):
            found.append(token)
            goes_on = False
    if found:
        yield found


def changes(text: str, python: bool, lines: set[int]) -> list[Change]:
    """What the rules make of these lines, counted from 1."""
    names = set(re.findall(r"\w+", text))
    line_of = [0]
    for character in text:
        line_of.append(line_of[-1] + (character == "\n"))
    made: dict[tuple[int, int, str], Change] = {}
    for tokens in statements(text, python):
        if not lines.isdisjoint(range(line_of[tokens[0].start] + 1, line_of[tokens[-1].end] + 2)):
            for change in Statement(tokens, text, python, names).changes():
                if line_of[change.start] + 1 in lines:
                    made.setdefault((change.start, change.end, change.text), change)
    return list(made.values())


class Statement:
    """The tokens of a statement, and what the rules make of them. Places are those of tokens."""

    def __init__(self, tokens: list[Token], text: str, python: bool, names: set[str]) -> None:
        self.tokens, self.text, self.python, self.names = tokens, text, python, names
        # What texts hold is no word of the statement.
        self.words = ["''" if token.kind == "text" else token.text for token in tokens]

    @cached_property
    def partner(self) -> dict[int, int]:
        """The other bracket of each."""
        found: dict[int, int] = {}
        opened: list[int] = []
        for place, word in enumerate(self.words):
            if word in OPEN:
                opened.append(place)
            elif word in CLOSE and opened:
                found[place] = opened.pop()
                found[found[place]] = place
        return found

    @cached_property
    def within(self) -> list[str]:
        """The bracket that holds a token, empty if none does."""
        found, opened = [], [""]
        for word in self.words:
            if word in CLOSE and len(opened) > 1:
                opened.pop()
            found.append(opened[-1])
            if word in OPEN:
                opened.append(word)
        return found

    def changes(self) -> Iterator[Change]:
        words = self.words
        if SILENT.fullmatch(words[0]) or UNITS & set(words[:-1]):
            return
        first = 0
        if "::" in words:  # of a declaration only the values
            start = words.index("::")
            if "=" not in words[start:]:
                return
            first = words.index("=", start) + 1
        for place in range(first, len(words)):
            yield from self._of_token(place)
            yield from self._of_operator(place)
            yield from self._of_bound(place)
            if not first and words[place] in ("(", "["):
                yield from self._of_arguments(place)
        if not first:
            yield from self._of_condition()
            yield from self._forgotten()

    def _between(self, first: int, last: int) -> str:
        """The text from one token to another."""
        return self.text[self.tokens[first].start : self.tokens[last].end]

    def _becomes(self, first: int, last: int, text: str, rule: str) -> Change:
        return Change(self.tokens[first].start, self.tokens[last].end, text, rule)

    def _of_token(self, place: int) -> Iterator[Change]:
        token, word = self.tokens[place], self.words[place]
        if token.kind == "number":
            for number in other_numbers(word):
                yield self._becomes(place, place, number, "constant")
        elif token.kind == "name" and (other := other_name(word, self.names)):
            yield self._becomes(place, place, other, "the other of a pair")
        if word in EXCHANGED and (self._is_binary(place) or LEVELS.get(word, 0) < 5):
            for other in EXCHANGED[word]:
                other = "!=" if self.python and other == "/=" else other
                yield self._becomes(place, place, other, "operator")

    def _is_binary(self, place: int) -> bool:
        before = self.tokens[place - 1]
        is_value = before.kind in ("name", "number", "text") or before.text in CLOSE
        return place > 0 and is_value and self.words[place - 1] not in ENDS

    def _of_operator(self, place: int) -> Iterator[Change]:
        """A sign is forgotten, or an operand, or two operands are exchanged."""
        word = self.words[place]
        if word in UNARY and place + 1 < len(self.words) and not self._is_binary(place):
            start = self.tokens[place].start
            yield Change(start, self.tokens[place + 1].start, "", "sign or not is forgotten")
            return
        level = LEVELS.get(word, 0)
        if level not in FORGETFUL or not self._is_binary(place):
            return
        first, last = self._first_of_operand(place, level), self._last_of_operand(place, level)
        if last is not None:
            yield Change(self.tokens[place - 1].end, self.tokens[last].end, "", "operand is forgotten")
        if first is not None and word not in "-/":
            start = self.tokens[place + 1].start
            yield Change(self.tokens[first].start, start, "", "operand is forgotten")
        if first is not None and last is not None and word in "-/":
            exchanged = f"{self._between(place + 1, last)}{word}{self._between(first, place - 1)}"
            yield self._becomes(first, last, exchanged, "exchanged operands")

    def _last_of_operand(self, place: int, level: int) -> int | None:
        i = place + 1
        while i < len(self.words):
            if self.words[i] in OPEN:
                i = self.partner.get(i, len(self.words))
            elif self._ends(i) or (i > place + 1 and LEVELS.get(self.words[i], 9) <= level):
                break
            i += 1
        return i - 1 if place < i - 1 < len(self.words) else None

    def _first_of_operand(self, place: int, level: int) -> int | None:
        """Where the first operand of a chain of such operators begins; None for the others."""
        i = place - 1
        while i >= 0:
            if self.words[i] in CLOSE:
                i = self.partner.get(i, 0)
            elif self._ends(i) or LEVELS.get(self.words[i], 9) < level:
                break
            elif LEVELS.get(self.words[i], 9) == level:
                return None
            i -= 1
        return i + 1 if i + 1 < place else None

    def _ends(self, place: int) -> bool:
        return self.words[place] in (*ENDS, *OPEN, *CLOSE)

    def _of_bound(self, place: int) -> Iterator[Change]:
        """One fewer at an end of a loop, or of a part of an array."""
        word, outside = self.words[place], not self.within[place]
        is_loop = self.words[0] == "do" and word == "," and outside
        is_part = word == ":" and self.within[place] == ("[" if self.python else "(")
        last = self._last_of_operand(place, 0) if is_loop or is_part else None
        first = self._first_of_operand(place, 0) if is_part else None
        if last is not None:
            yield self._becomes(last, last, f"{self.tokens[last].text} - 1", "bound")
        if first is not None:
            yield self._becomes(place, place, " + 1:", "bound")

    def _of_arguments(self, place: int) -> Iterator[Change]:
        """Two neighbours are exchanged, or a function is forgotten."""
        before = self.tokens[place - 1] if place else Token("", "", 0)
        is_call = before.kind == "name" and before.text not in ENDS
        if place not in self.partner or not (is_call or self.words[place] == "["):
            return
        parts = list(self._arguments(place))
        if before.text in FORGOTTEN and is_call:
            for first, last in parts[: 1 + (len(parts) > 1)]:
                forgotten = f"({self._between(first, last)})"
                yield self._becomes(place - 1, self.partner[place], forgotten, "function is forgotten")
        for (a, b), (c, d) in zip(parts, parts[1:], strict=False):
            named = {"=", "for"} & {*self.words[a : b + 1], *self.words[c : d + 1]}
            if named or NO_CALL.fullmatch(before.text):
                continue
            one, other = self._between(a, b), self._between(c, d)
            between = self.text[self.tokens[b].end : self.tokens[c].start]
            if one != other:
                yield self._becomes(a, d, other + between + one, "exchanged arguments")

    def _arguments(self, place: int) -> Iterator[tuple[int, int]]:
        """First and last token of each argument behind a bracket."""
        start = i = place + 1
        while i <= self.partner[place]:
            if i == self.partner[place] or self.words[i] == ",":
                if i > start:
                    yield start, i - 1
                start = i + 1
            elif self.words[i] in OPEN:
                i = self.partner.get(i, i)
            i += 1

    def _of_condition(self) -> Iterator[Change]:
        """The condition of a branch is turned round."""
        for place, word in enumerate(self.words[:-1]):
            if word not in ("if", "while", "elif") or self.words[place + 1] in (".not.", "not"):
                continue
            first = place + 1
            if not self.python and first in self.partner and self.words[first + 1] != ".not.":
                first, last = first + 1, self.partner[first] - 1
                yield self._becomes(first, last, f".not. ({self._between(first, last)})", "condition")
            elif self.python:
                ends = [i for i in range(first, len(self.words)) if self.words[i] in ("else", ":")]
                last = (ends[0] if ends else len(self.words)) - 1
                if ends and first <= last and self.within[last] == self.within[place]:
                    yield self._becomes(first, last, f"not ({self._between(first, last)})", "condition")

    def _forgotten(self) -> Iterator[Change]:
        """An assignment, a call, a jump, or what is done on a condition is forgotten."""
        words = self.words
        assigns = any(word in ASSIGNS and not self.within[i] for i, word in enumerate(words))
        calls = self.python and self.tokens[0].kind == "name" and words[-1] == ")"
        on_condition = not self.python and words[0] == "if" and words[-1] != "then"
        if words[0] in JUMPS or on_condition or ((assigns or calls) and words[0] not in BRANCHES):
            text = "pass" if self.python else "continue"
            yield self._becomes(0, len(words) - 1, text, "statement is forgotten")


def other_numbers(number: str) -> Iterator[str]:
    """The neighbours of an integer; twice and a tenth of any other number; 1 for 0."""
    digits, underscore, kind = number.partition("_")
    if digits.isdigit():
        others = [str(other) for other in (int(digits) + 1, int(digits) - 1) if other >= 0]
    else:
        value = float(re.sub("[dD]", "e", digits))
        others = [repr(2.0 * value), repr(0.1 * value)] if value else ["1.0"]
    for other in others:
        yield f"{other}{underscore}{kind}"


def other_name(name: str, names: set[str]) -> str:
    """The other one of a pair, if it stands in the file; else empty."""
    if name in OTHER_WORD:
        return OTHER_WORD[name]
    parts = name.split("_")
    for place, part in enumerate(parts):
        other = "_".join([*parts[:place], OTHER_PART.get(part, part), *parts[place + 1 :]])
        if other != name and other in names:
            return other
    return ""
