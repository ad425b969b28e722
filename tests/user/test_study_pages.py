"""Tables of study pages are written by their commands; a page of another form is refused."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import page_tables

import check_studies

STUDY = """# Title

**Question.** One?

**Method.** Two.

**Result.** Three:

{table}
**Limits.** Four.

**Command.** Five.
"""
TABLE = "| a | b |\n|---|---|\n| 1 | 2 |\n"
WRITTEN = f"<!-- table: written by {{command}} -->\n{TABLE}<!-- end -->\n"


def printing(place: Path, *tables: str) -> str:
    """A command that prints tables with words between them."""
    path = place / f"printed{len([*place.iterdir()])}.md"
    path.write_text("words\n".join(tables))
    return f"cat {path}"


def written(path: Path, *commands: str, word: str = "") -> int:
    """Exit code of the script for a page with a table by each command."""
    page = "\n".join(WRITTEN.format(command=command) for command in commands)
    path.write_text(f"Before\n\n{TABLE}\n{page}\nBehind\n")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["page_tables.py", str(path), word])
        return page_tables.main()


def test_a_table_is_what_its_command_prints(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The table of its head, with date and processor; the others, and those of other commands, stay."""
    page = tmp_path / "PAGE.md"
    first = printing(tmp_path, "| c |\n", TABLE.replace("1", "3"))
    second = printing(tmp_path, TABLE.replace("1", "5"))
    assert written(page, first, second, word=first) == 0, capsys.readouterr().err
    text = page.read_text()
    assert "| 3 | 2 |" in text and "| 5 | 2 |" not in text and text.count("| 1 | 2 |") == 2
    assert check_studies.MEASURED.search(text.partition("| 3 | 2 |\n")[2])
    assert "| c |" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("tables", "fault"),
    (
        ((), "prints no table"),
        (("| c |\n",), "| c |"),
        ((TABLE, TABLE), "two tables with the same head"),
        (None, "exit code 1"),
    ),
)
def test_a_command_without_the_table_leaves_the_page(
    tables: tuple[str, ...] | None, fault: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "PAGE.md"
    command = "false" if tables is None else printing(tmp_path, *tables)
    assert written(page, command) == 1 and fault in capsys.readouterr().err
    assert page.read_text().count(TABLE) == 2


@pytest.mark.parametrize(
    ("text", "fault"),
    (
        (STUDY.format(table=""), None),
        (STUDY.format(table=WRITTEN), None),
        (STUDY.format(table=f"{TABLE}\n*2026-11-22, AMD EPYC; `make`.*\n"), None),
        (STUDY.format(table=TABLE), "neither a command"),
        (STUDY.format(table=f"{TABLE}\n*Of a run.*\n"), "neither a command"),
        (STUDY.format(table=f"{TABLE}\nWords.\n\n*2026-11-22, AMD EPYC.*\n"), "neither a command"),
        (STUDY.format(table="**Method.**"), "not Question, Method"),
        (STUDY.format(table="\n" * 100), "longer than"),
        ("# Title\n", "no study"),
    ),
)
def test_a_page_of_another_form_is_refused(text: str, fault: str | None) -> None:
    found = check_studies.faults(text)
    assert fault in found[0] if fault else not found, found
    assert not check_studies.faults("# Index\n", index=True)
