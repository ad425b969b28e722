"""Every command of input/FIRST_MAP.md does what the page says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from page_commands import call, shell

import rattle as package
from rattle.keys import key_table


@pytest.mark.long
def test_the_way_from_a_drawing_to_a_map(rattle: Path, repository: Path, tmp_path: Path) -> None:
    """All commands in their order, from a folder that is as the repository; the map with fewer values."""
    commands = shell((repository / "input" / "FIRST_MAP.md").read_text())
    assert commands.count("build/rattle") == 5 and "count = 9, 8" in commands
    ended = call(commands.replace("count = 9, 8", "count = 2, 2"), tmp_path, rattle, repository)
    assert ended.returncode == 0, ended.stderr
    for words in ("inertia ratio Lambda", "drag torque", "largest load"):
        assert ended.stdout.count(words) >= 4
    assert len(package.read(tmp_path / "results" / "box_map.rattle")["verdict"]) == 4 * 2 * 2
    for made in ("report.html", "results/box.summary.nml", "results/box_map_pairs.png"):
        assert (tmp_path / made).stat().st_size > 0


def test_keys_of_the_page_are_keys(repository: Path) -> None:
    page = (repository / "input" / "FIRST_MAP.md").read_text()
    known = {name for _, name in key_table()}
    named = re.findall(r"`(\w+_\w+)`", page.partition("## 2.")[0])
    assert {name for name in named if not name.startswith("_")} <= known
