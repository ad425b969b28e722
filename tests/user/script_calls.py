"""Calls of the entry scripts, and the pictures they leave."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def call_script(
    script: str, *arguments: object, cwd: Path | None = None, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run a script with this Python and wait for its end."""
    return subprocess.run(
        [sys.executable, str(SCRIPTS / script), *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | environment,
    )


def figure_stems(directory: Path) -> list[str]:
    """Names of the figures; each must be there in both forms."""
    found = sorted(path.stem for path in directory.glob("*.png"))
    assert found == sorted(path.stem for path in directory.glob("*.pdf"))
    return found
