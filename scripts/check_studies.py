"""Holds the study pages, tests/*/*.md, to one form.

Every study has Question, Method, Result, Limits and Command, in this order. A table of its result is written
by a command (tests/page_tables.py), or a note below it in italics says when and on which machine it was
measured. README.md of a folder may be an index without a study.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from page_tables import ROWS
from page_tables import TABLE as WRITTEN

PARTS = ["Question", "Method", "Result", "Limits", "Command"]
PART = re.compile(rf"\*\*({'|'.join(PARTS)})\.\*\*")
HEADING = re.compile(r"^#+ .*$", re.MULTILINE)
# Such as *2026-11-22, AMD EPYC (Zen 4), both cores at work.*
MEASURED = re.compile(r"\s*^\*\d{4}-\d\d-\d\d\b[^*]*, (?:AMD|Intel|ARM|any machine)[^*]*\*$", re.MULTILINE)
MOST_LINES = 100


def faults(text: str, *, index: bool = False) -> list[str]:
    """What a page lacks."""
    found = []
    places = [*(heading.start() for heading in HEADING.finditer(text)), len(text)]
    studies = [text[begin:end] for begin, end in zip(places, places[1:], strict=False)]
    studies = [study for study in studies if PART.search(study)]
    if not studies and not index:
        found.append("has no study")
    for study in studies:
        title = study.partition("\n")[0].strip("# ")
        parts = PART.findall(study)
        if parts != PARTS:
            found.append(f"'{title}': has {', '.join(parts)}, not {', '.join(PARTS)}")
        if study.count("\n") > MOST_LINES:
            found.append(f"'{title}': longer than {MOST_LINES} lines")
        result = WRITTEN.sub("", study.partition("**Result.**")[2].partition("**Limits.**")[0])
        found += [
            f"'{title}': neither a command above nor date and machine below the table {table[0][:60].strip()}"
            for table in ROWS.finditer(result)
            if not MEASURED.match(result, table.end())
        ]
    return found


def main() -> int:
    listed = subprocess.run(["git", "ls-files", "tests/*/*.md"], capture_output=True, text=True, check=True)
    found = [
        f"{page}: {fault}"
        for page in listed.stdout.split()
        for fault in faults(Path(page).read_text(), index=page.endswith("README.md"))
    ]
    print("\n".join(found))
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
