"""The check of pages counts each kind of hard text, and leaves plain text alone; messages are read whole."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import check_pages
import list_messages

PLAIN = "# Heading of more words\n\nThe film `h` carries the load of the tooth. Let q_n be a load.\n"
EXPLAINED = "u*, v_n\nCSV"


@pytest.mark.parametrize(
    ("text", "counted"),
    (
        ("", {}),
        (f"The {' '.join(['long'] * 26)} end.", {"long_sentences": 1}),
        (
            f"The {' '.join(['long'] * 41)} end.",
            {"long_sentences": 1, "very_long_sentences": 1},
        ),
        ("The film is solved and the tooth is moved.", {"passive_chains": 1}),
        ("The film is solved. The tooth is moved.", {}),
        (f"The ${' '.join(['w*'] * 26)}$ end.", {}),
        ("\n\n".join(["", *["The film is short. " * 40]]), {"long_paragraphs": 1}),
        ("The log tells that nobody came.", {"idioms": 2}),
        (
            "NVH engineers see w*, q_2, u*, v_3 and CSV files. The force F_0 acts.",
            {"undefined_terms": 2},
        ),
    ),
)
def test_each_kind_is_counted(text: str, counted: dict[str, int]) -> None:
    plain, places = check_pages.long_parts(PLAIN, 6, EXPLAINED)
    assert places == [] and plain.sentences == 2
    found, places = check_pages.long_parts(f"{PLAIN}\n{text}\n", 6, EXPLAINED)
    kinds = {
        name: number for name, number in found._asdict().items() if name not in ("sentences", "paragraphs")
    }
    assert {name: number for name, number in kinds.items() if number} == counted, places


def test_a_message_is_joined_over_its_lines(tmp_path: Path) -> None:
    source = tmp_path / "a.f90"
    source.write_text(
        "! a comment 'of no message'\ncall add('the value '//text(a)// &\n   ' is not a number')\n"
    )
    assert [text for _, text in list_messages.of_fortran(source) if text] == ["the value ... is not a number"]


def test_equations_of_the_theory_are_in_the_sections_named(repository: Path) -> None:
    """Every number of the table of equations is a text of a section that its row links."""
    page = (repository / "fsrc" / "THEORY.md").read_text()
    sections = dict(re.findall(r"^## (\d+)\. (.*?)(?=^## |\Z)", page, re.MULTILINE | re.DOTALL))
    rows = re.findall(r"^\| (\([^|]*) \| [^|]* \| ([^|]*) \|", page.partition("## Symbols")[0], re.MULTILINE)
    named = [
        (number, re.findall(r"\[(\d+)\]", links))
        for numbers, links in rows
        for number in re.findall(r"\(\d+\)", numbers)
    ]
    assert len(named) >= 20
    assert not [
        number for number, links in named if not any(number in sections[section] for section in links)
    ]
