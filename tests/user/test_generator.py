"""The generated tables are what their generator makes, to the last digit, and a changed digit is noticed."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.long

SCRIPT = Path("scripts") / "generate" / "reynolds_film.py"
TABLES = Path("fsrc") / "film" / "coefficients"
DIFFERS = "differs from what its generator makes"
SAME = "is reproduced byte for byte"


def test_tables_are_reproduced_and_a_change_is_noticed(repository: Path, tmp_path: Path) -> None:
    for folder in (SCRIPT.parent, TABLES):
        shutil.copytree(repository / folder, tmp_path / folder)
    table = tmp_path / TABLES / "iso_viscous_coefficients.f90"
    text = table.read_text()
    place = text.index("_dp", len(text) // 2) - 5
    table.write_text(text[:place] + ("1" if text[place] != "1" else "2") + text[place + 1 :])
    command = [sys.executable, tmp_path / SCRIPT, "--check"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=240, check=False)
    tables = {path.name for path in (repository / TABLES).iterdir()}
    assert len(tables) > 1
    assert done.returncode == 1
    assert done.stderr.split() == [*str(TABLES / table.name).split(), *DIFFERS.split()]
    reproduced = {Path(line.split()[0]).name for line in done.stdout.splitlines() if line.endswith(SAME)}
    assert reproduced == tables - {table.name}
