"""Writes the tables of a study page anew, each by the command that stands above it.

    python tests/page_tables.py PAGE [WORD]

    <!-- table: written by COMMAND -->
    | head | of the table |
    ...
    <!-- end -->

Each command, or each that contains WORD, runs once, in the shell, from the folder of the repository. Of the
tables that it prints the one with the same head replaces the table of the page, with date and processor
below. Nothing is written if the command fails or prints no such table.
"""

from __future__ import annotations

import argparse
import datetime
import platform
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TABLE = re.compile(
    r"^<!-- table: written by (?P<command>.+) -->\n(?P<content>(?:(?!<!--).*\n)+)<!-- end -->$", re.MULTILINE
)
ROWS = re.compile(r"(?:^\|.*\n)+", re.MULTILINE)


class NoTable(Exception):
    """A command that fails, or prints no table of the head of the page."""


def printed_by(command: str) -> dict[str, str]:
    """The tables that a command prints, by their heads; its lines are shown as they come."""
    lines = []
    with subprocess.Popen(command, shell=True, cwd=ROOT, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for line in process.stdout:
            print(line, end="", flush=True)
            lines.append(line)
    if process.returncode:
        raise NoTable(f"{command}: exit code {process.returncode}")
    tables = ROWS.findall("".join(lines))
    found = {head_of(table): table for table in tables}
    if len(found) < len(tables):
        raise NoTable(f"{command}: prints two tables with the same head")
    return found


def head_of(table: str) -> str:
    return table.partition("\n")[0].strip()


def processor() -> str:
    """Name of the processor, where the system has it."""
    names = re.findall(r"^model name\s*: (.+)$", _text(Path("/proc/cpuinfo")), re.MULTILINE)
    return names[0] if names else platform.processor() or platform.machine()


def _text(path: Path) -> str:
    return path.read_text() if path.exists() else ""


def commands_of(text: str, word: str = "") -> list[str]:
    """The commands of a page that contain a word, each once."""
    found = [*dict.fromkeys(table["command"] for table in TABLE.finditer(text) if word in table["command"])]
    if not found:
        raise NoTable(f"no table is written by a command with '{word}'")
    return found


def with_tables(text: str, printed: dict[str, dict[str, str]]) -> str:
    """The text of a page with the tables that its commands have printed."""
    note = f"\n*{datetime.date.today()}, {processor()}.*\n"

    def anew(table: re.Match[str]) -> str:
        command, content = table["command"], table["content"]
        if command not in printed:
            return table[0]
        head = head_of(content)
        if head not in printed[command]:
            heads = "\n".join(printed[command]) or "none"
            raise NoTable(f"{command}: prints no table with the head of the page\n{head}\nbut\n{heads}")
        return table[0].replace(content, printed[command][head] + note)

    return TABLE.sub(anew, text)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("page", type=Path)
    parser.add_argument("word", nargs="?", default="", help="only tables whose command contains it")
    options = parser.parse_args()
    try:
        printed = {
            command: printed_by(command) for command in commands_of(options.page.read_text(), options.word)
        }
        # Commands may take an hour: what was edited meanwhile stays.
        options.page.write_text(with_tables(options.page.read_text(), printed))
    except NoTable as fault:
        print(f"{options.page}: {fault}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
