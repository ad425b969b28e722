"""The generated tables are what their generator makes, to the last digit, and a changed digit is noticed."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

SCRIPT = Path("scripts") / "generate" / "reynolds_film.py"
TABLES = Path("fsrc") / "film" / "coefficients"


def check(root: Path) -> int:
    command = [sys.executable, root / SCRIPT, "--check"]
    return subprocess.run(command, cwd=root, capture_output=True, timeout=240, check=False).returncode


def test_tables_are_reproduced_and_a_change_is_noticed(repository: Path, tmp_path: Path) -> None:
    for folder in (SCRIPT.parent, TABLES):
        shutil.copytree(repository / folder, tmp_path / folder)
    assert check(tmp_path) == 0
    table = tmp_path / TABLES / "iso_viscous_coefficients.f90"
    text = table.read_text()
    place = text.index("_dp", len(text) // 2) - 5
    table.write_text(text[:place] + ("1" if text[place] != "1" else "2") + text[place + 1 :])
    assert check(tmp_path) != 0
