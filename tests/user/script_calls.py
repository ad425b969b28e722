"""Calls of the entry scripts, and the pictures they leave."""

from __future__ import annotations

import contextlib
import io
import multiprocessing
import os
import runpy
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


# A Python that has imported what takes long, and forks for each call of a script.
READY = multiprocessing.get_context("forkserver")
READY.set_forkserver_preload(
    ["matplotlib.figure", "matplotlib.backends.backend_agg", "numpy", "script_calls"]
)


def call_script(
    script: str, *arguments: object, cwd: Path | None = None, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run a script in a process of its own and wait for its end."""
    command = [str(SCRIPTS / script), *map(str, arguments)]
    with tempfile.TemporaryDirectory() as folder:
        places = [Path(folder) / name for name in ("said", "complained")]
        child = READY.Process(target=_be, args=(command, cwd or Path.cwd(), os.environ | environment, places))
        child.start()
        child.join()
        said, complained = (place.read_text() for place in places)
    return subprocess.CompletedProcess(command, child.exitcode, said, complained)


def _be(command: list[str], cwd: Path, environment: dict[str, str], places: list[Path]) -> None:
    """Become a script: what it says goes to files."""
    for number, place in enumerate(places, 1):
        os.dup2(os.open(place, os.O_WRONLY | os.O_CREAT), number)
    os.environ.clear()
    os.environ.update(environment)
    time.tzset()
    os.chdir(cwd)
    sys.argv = command
    sys.path[0:0] = [str(SCRIPTS), *filter(None, environment.get("PYTHONPATH", "").split(":"))]
    runpy.run_path(command[0], run_name="__main__")


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
    """Names of the figures."""
    return sorted(path.stem for path in directory.glob("*.png"))
