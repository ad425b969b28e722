"""Every link of a page names a file, and one with # a heading of it. Addresses of the web are not checked."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```$|`[^`\n]*`", re.MULTILINE | re.DOTALL)
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)


def anchors(page: Path) -> set[str]:
    """The anchors of the headings of a page, as GitHub forms them."""
    heads = (re.sub(r"[^\w\s-]", "", head.lower()) for head in HEADING.findall(page.read_text()))
    return {head.replace(" ", "-") for head in heads}


def faults(page: Path) -> list[str]:
    """The links of a page that lead nowhere."""
    found = []
    for link in LINK.findall(CODE.sub("", page.read_text())):
        place, _, anchor = link.partition("#")
        target = page.parent / place if place else page
        if "://" in link:
            continue
        if not target.exists():
            found.append(f"{page}: {link}: there is no such file")
        elif anchor and anchor not in anchors(target):
            found.append(f"{page}: {link}: there is no such heading")
    return found


listed = subprocess.run(["git", "ls-files", "*.md"], capture_output=True, text=True, check=True)
broken = [fault for page in listed.stdout.split() for fault in faults(Path(page))]
print("\n".join(broken))
sys.exit(bool(broken))
