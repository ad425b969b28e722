"""The page scripts/README.md prints what it says."""

from __future__ import annotations

import io
import re
from contextlib import redirect_stdout

import pytest


def test_every_line_of_the_page_is_true(repository, rattle, monkeypatch):
    monkeypatch.chdir(repository)
    monkeypatch.setenv("RATTLE_PROGRAM", str(rattle))
    page = (repository / "scripts" / "README.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    assert len(blocks) >= 7
    names: dict[str, object] = {}
    for block in blocks:
        for part in re.findall(r"(.*?)((?:^#: [^\n]*\n)+|\Z)", block, re.DOTALL | re.MULTILINE):
            lines, reported = part
            printed = io.StringIO()
            with redirect_stdout(printed):
                exec(compile(lines, "scripts/README.md", "exec"), names)
            expected = "".join(line.removeprefix("#: ") for line in reported.splitlines(keepends=True))
            assert printed.getvalue() == expected, lines


@pytest.mark.parametrize("name", ("plot", "report", "compare", "classify", "export", "campaign"))
def test_every_script_is_named(repository, name):
    assert f"`{name}.py`" in (repository / "scripts" / "README.md").read_text()
