"""Every command of input/LISTENING.md does what the page says."""

from __future__ import annotations

from pathlib import Path

import pytest
from page_commands import call, shell
from scipy.io import wavfile

from rattle.sound import transfer


@pytest.mark.long
def test_every_command_of_the_page_makes_its_sound(rattle: Path, repository: Path, tmp_path: Path) -> None:
    commands = shell((repository / "input" / "LISTENING.md").read_text())
    assert commands.count("listen.py") == 4
    ended = call(commands, tmp_path, rattle, repository)
    assert ended.returncode == 0, ended.stderr
    for name, seconds in (("box.wav", 6.5), ("first.wav", 3.0), ("run_up.wav", 6.0), ("driven.wav", 24.0)):
        rate, samples = wavfile.read(tmp_path / name)
        assert rate == 48000 and samples.size in (48000 * seconds, 48000 * seconds + 1)


def test_the_page_has_the_modes_of_the_generic_housing(repository: Path) -> None:
    page = (repository / "input" / "LISTENING.md").read_text()
    *most, last = (f"{mode:g}" for mode, _, _ in transfer.MODES)
    assert f"{', '.join(most)} and {last} Hz" in page
    assert {damping for _, damping, _ in transfer.MODES} <= {0.02, 0.025, 0.03}
    assert transfer.GENERIC_GAIN == 1e-4
