"""Calls of the entry scripts, and the pictures they leave."""

from __future__ import annotations

import contextlib
import io
import os
import runpy
import signal
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


def called_here(script: str, *arguments: object, cwd: Path) -> tuple[int, str, str]:
    """The same within this Python, as another takes seconds to start: exit code, words, complaints."""
    said, complained = io.StringIO(), io.StringIO()
    before, handler, own = Path.cwd(), signal.getsignal(signal.SIGTERM), sys.argv
    sys.argv = [script, *map(str, arguments)]
    os.chdir(cwd)
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
            runpy.run_path(str(SCRIPTS / script), run_name="__main__")
    except SystemExit as left:
        return left.code or 0, said.getvalue(), complained.getvalue()
    finally:
        os.chdir(before)
        signal.signal(signal.SIGTERM, handler)
        sys.argv = own
    raise AssertionError(f"{script} came to an end without an exit code")


def figure_stems(directory: Path) -> list[str]:
    """Names of the figures; each must be there in both forms."""
    found = sorted(path.stem for path in directory.glob("*.png"))
    assert found == sorted(path.stem for path in directory.glob("*.pdf"))
    return found
