"""Every command of input/MEASURED.md does what the page says."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from page_commands import call, shell

import rattle as package


def test_the_page_is_short(repository: Path) -> None:
    lines = (repository / "input" / "MEASURED.md").read_text().splitlines()
    assert len(lines) <= 80 and max(map(len, lines)) <= 132


def test_the_recording_of_the_page(rattle: Path, repository: Path, tmp_path: Path) -> None:
    """As far as the check of the input: what the page says of each step is printed."""
    page = (repository / "input" / "MEASURED.md").read_text()
    commands = shell(page).partition("build/rattle bench.nml")[0]
    assert commands.count("recording.py") == 2 and "--check" in commands
    ended = call(commands, tmp_path, rattle, repository)
    assert ended.returncode == 0, ended.stderr
    for words in (
        "1  Drehzahl ",
        "is 0 1/min at 0.7 s to 0.702 s (3 samples), its neighbours 824.3 and 825.22: replaced.",
        "12 whole cycles of 2 revolutions; 0.0539 revolutions are left out.",
        "signal engine_mean.csv, column 'speed_rpm': 720 samples; engine orders 0.5 to 8 are kept",
    ):
        assert words in ended.stdout, ended.stdout[:3000]
    refused = commands.splitlines()[1].replace("--mend ", "--overwrite ")
    ended = subprocess.run(["bash", "-c", refused], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ended.returncode == 2 and "is 0 1/min at 0.7 s" in ended.stderr


@pytest.mark.long
def test_the_way_from_a_recording_to_a_map(rattle: Path, repository: Path, tmp_path: Path) -> None:
    """All commands in their order; the map with fewer values."""
    commands = shell((repository / "input" / "MEASURED.md").read_text())
    assert "count = 4, 6" in commands
    ended = call(commands.replace("count = 4, 6", "count = 2, 2"), tmp_path, rattle, repository)
    assert ended.returncode == 0, ended.stderr
    assert len(package.read(tmp_path / "results" / "bench_map.rattle")["verdict"]) == 4 * 2 * 2
    for made in ("results/bench.summary.nml", "results/bench_map_pairs.png"):
        assert (tmp_path / made).stat().st_size > 0


def test_options_of_the_page_are_options(repository: Path) -> None:
    page = (repository / "input" / "MEASURED.md").read_text()
    code = "".join(
        path.read_text() for path in (repository / "scripts" / "rattle" / "recordings").glob("*.py")
    )
    tables = "".join(re.findall(r"^\|.*\n", page, re.M))
    for option in re.findall(r"(--[a-z][a-z-]+)", tables):
        assert f'"{option}"' in code, option
