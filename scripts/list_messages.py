"""Prints every message of the program and the scripts, one a line. Usage: list_messages.py [--idioms]

A message is a text of two words or more in the code. Texts of fsrc are joined over continuation lines, with
... for what is put in; docstrings of Python are left out. --idioms prints the messages with a word of the
list of check_pages.py, and fails if there is one; the class irregular_so_far keeps its name."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from check_pages import IDIOM

LITERAL = re.compile(r"'((?:[^']|'')*)'|\"((?:[^\"]|\"\")*)\"")
COMMENT = re.compile(r"^((?:[^'\"!]|'[^']*'|\"[^\"]*\")*)!.*$")
MESSAGE = re.compile(r"[A-Za-z]{2}.* [A-Za-z]|\w \w{2,}")


def of_fortran(path: Path) -> Iterator[tuple[int, str]]:
    """Line and text of the messages of a source file."""
    statement, first = "", 0
    for number, line in enumerate(path.read_text().splitlines(), 1):
        code = COMMENT.sub(r"\1", line).strip()
        first = first if statement else number
        statement += (
            code.removeprefix("&").removesuffix("&").strip() if statement else code.removesuffix("&").strip()
        )
        if code.endswith("&"):
            continue
        # What stands between two literals of one text is an expression joined to them by //.
        joined = re.sub(r"(['\"])\s*//\s*(['\"])", "", statement)
        text, last = "", 0
        for found in LITERAL.finditer(joined):
            between = joined[last : found.start()]
            if text and "//" not in between:
                yield first, text
                text = ""
            elif text:
                text += "..."
            text += (found[1] or found[2] or "").replace("''", "'").replace('""', '"')
            last = found.end()
        yield first, text
        statement = ""


def of_python(path: Path) -> Iterator[tuple[int, str]]:
    """Line and text of the messages of a script."""
    tree = ast.parse(path.read_text())
    docs = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    parts = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            yield (
                node.lineno,
                "".join(
                    str(getattr(part, "value", "")) if isinstance(part, ast.Constant) else "..."
                    for part in node.values
                ),
            )
        elif (
            isinstance(node, ast.Constant) and isinstance(node.value, str) and not {id(node)} & (docs | parts)
        ):
            yield node.lineno, node.value


def main() -> int:
    found = []
    for path in sorted([*Path("fsrc").rglob("*.f90"), *Path("scripts").rglob("*.py")]):
        messages = of_fortran(path) if path.suffix == ".f90" else of_python(path)
        found += [(path, line, " ".join(text.split())) for line, text in messages if MESSAGE.search(text)]
    only_idioms = "--idioms" in sys.argv
    if only_idioms:
        # The list itself is no message.
        found = [
            each
            for each in found
            if IDIOM.search(each[2].replace("irregular so far", "")) and r"\b" not in each[2]
        ]
    for path, line, text in found:
        print(f"{path}:{line}: {text}")
    print(f"{len(found)} messages", file=sys.stderr)
    return int(only_idioms and len(found) > 0)


if __name__ == "__main__":
    sys.exit(main())
