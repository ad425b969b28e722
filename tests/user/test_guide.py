"""Commands of the pages: ready inputs are valid with their options, scripts have the options named there."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
PAGES = [
    "README.md",
    *(f"input/{name}.md" for name in ("CAMPAIGNS", "PAPER", "RUNNING", "VERIFICATION")),
    *sorted(str(path.relative_to(REPOSITORY)) for path in REPOSITORY.glob("tests/*/*.md")),
]
BLOCK = re.compile(r"(?:^|(?<=\n\n))((?: {4}[^\n]*\n?)+)", re.MULTILINE)
WORDS = re.compile(r"`((?:build/rattle|\S*python) [^`]+)`")


def commands(page: str) -> list[list[str]]:
    """The words of each command of a page, without comments."""
    text = (REPOSITORY / page).read_text()
    lines = [line for block in BLOCK.findall(text) for line in block.splitlines()] + WORDS.findall(text)
    parts = [part for line in lines for part in re.split(r"\s{2,}#|&&|>", line.strip())]
    return [
        shlex.split(part, comments=True) for part in parts if re.match(r"(build/rattle|\S*python) ", part)
    ]


RUNS = [words[1:] for page in PAGES for words in commands(page) if words[0] == "build/rattle"]
READY = [words for words in RUNS if words and (REPOSITORY / words[-1]).is_file()]
SCRIPTS = [words[1:] for page in PAGES for words in commands(page) if words[0].endswith("python")]


@pytest.mark.parametrize("words", READY, ids=" ".join)
def test_command_of_a_ready_input_is_valid(words: list[str], run) -> None:
    ended = run("--check", *(word for word in words if word != "--resume"), cwd=REPOSITORY)
    assert ended.returncode == 0, ended.stderr


@pytest.mark.parametrize("words", SCRIPTS, ids=" ".join)
def test_script_has_the_options_that_are_named(words: list[str]) -> None:
    assert (REPOSITORY / words[0]).is_file()
    asked = [word for word in words[1:] if word.startswith("--") and word != "--help"]
    command = words[1:2] if len(words) > 1 and re.fullmatch(r"[a-z-]+", words[1]) else []
    if not asked and not command:
        return
    ended = subprocess.run(
        [sys.executable, words[0], *command, "--help"],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    assert not [option for option in asked if option.partition("=")[0] not in ended.stdout]


def test_commands_were_found() -> None:
    assert len(READY) >= 8 and len(SCRIPTS) >= 15
