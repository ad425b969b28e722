"""Checks that a release is stated alike everywhere, and prints the text of its tag.

The version stands in fsrc/VERSION; CITATION.cff, the newest section of CHANGELOG.md and the tag, where there
is one, must agree with it. Every section of the changelog has a date and at most 40 lines, the newest first.
"""

from __future__ import annotations

import datetime
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

SECTION_LINES = 40
HEADING = re.compile(r"^## (\d+\.\d+\.\d+) \((\d{4}-\d{2}-\d{2})\)$")


def sections(changelog: str) -> Iterator[tuple[str, list[str]]]:
    """Heading of each section and its lines."""
    for part in re.split(r"^(?=## )", changelog, flags=re.MULTILINE)[1:]:
        heading, *lines = part.rstrip().splitlines()
        yield heading, lines


def faults(version: str, changelog: str, citation: str, tag: str) -> Iterator[str]:
    """One sentence per place that has another release.

    `tag` is the message of the tag of this version, empty where there is none.
    """
    releases = []
    for heading, lines in sections(changelog):
        if not (found := HEADING.match(heading)):
            yield f"CHANGELOG.md: '{heading}' is not '## VERSION (YEAR-MONTH-DAY)'"
            continue
        releases.append((tuple(map(int, found[1].split("."))), datetime.date.fromisoformat(found[2])))
        if len(lines) > SECTION_LINES:
            yield f"CHANGELOG.md: {found[1]} has {len(lines)} lines, more than {SECTION_LINES}"
    if releases != sorted(releases, reverse=True) or len({release for release, _ in releases}) < len(
        releases
    ):
        yield "CHANGELOG.md: the newest version does not stand first"
    newest, date = releases[0] if releases else ((), None)
    if ".".join(map(str, newest)) != version:
        yield f"CHANGELOG.md: its newest version is not {version} of fsrc/VERSION"
    for key, value in (("version", version), ("date-released", str(date))):
        stated = re.search(rf"^{key}: (\S+)$", citation, re.MULTILINE)
        if stated is None or stated[1] != value:
            yield f"CITATION.cff: {key} is {stated[1] if stated else 'missing'}, not {value}"
    if tag and tag.strip() != tag_text(version, changelog):
        yield f"the message of tag v{version} is not its section of CHANGELOG.md"


def tag_text(version: str, changelog: str) -> str:
    """The message of the tag of a version: its section of the changelog."""
    for heading, lines in sections(changelog):
        if heading.startswith(f"## {version} "):
            return "\n".join([f"rattle {version}", "", *lines]).replace("\n\n\n", "\n\n").strip()
    return ""


def main() -> int:
    os.chdir(Path(__file__).resolve().parents[1])
    version = Path("fsrc/VERSION").read_text().strip()
    changelog = Path("CHANGELOG.md").read_text()
    asked = ["git", "for-each-ref", "--format=%(contents)", f"refs/tags/v{version}"]
    tag = subprocess.run(asked, capture_output=True, text=True, check=False).stdout
    found = list(faults(version, changelog, Path("CITATION.cff").read_text(), tag))
    print("\n".join(found) if found else tag_text(version, changelog))
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
