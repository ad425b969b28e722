"""Fixtures of the tests that call the program as a user does."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]

# A scene that is solved within a few milliseconds.
FAST_SCENE: dict[str, dict[str, str]] = {
    "contact": {"radius": "0.0127", "length": "0.010"},
    "lubricant": {"viscosity": "0.3", "pressure_viscosity": "2.0e-8"},
    "kinematics": {"entrainment_speed": "1.905"},
    "load": {"mass": "3.0", "steady_force": "199.2", "force_amplitude": "205.7", "frequency": "600.0"},
    "film": {"law": "'iso-viscous'"},
    "solver": {"steps_per_period": "32", "periods": "3", "method": "'newmark'"},
    "spectrum": {"periods": "2"},
    "output": {"directory": "'results'"},
}

SceneText = Callable[..., str]
Run = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(scope="session")
def repository() -> Path:
    """The root of the repository."""
    return REPOSITORY


@pytest.fixture(scope="session")
def rattle() -> Path:
    """The program under test: $RATTLE_PROGRAM, or build/rattle of this repository."""
    program = Path(os.environ.get("RATTLE_PROGRAM", REPOSITORY / "build" / "rattle")).resolve()
    if not os.access(program, os.X_OK):
        pytest.fail(f"There is no program {program}: run `make`, or set RATTLE_PROGRAM.", pytrace=False)
    return program


@pytest.fixture(scope="session")
def run(rattle: Path) -> Run:
    """``run(*arguments, cwd=..., stdin=...)`` calls the program and waits for its end."""

    def call(
        *arguments: object, cwd: Path, stdin: str | bytes = b"", timeout: float = 20.0
    ) -> subprocess.CompletedProcess[str]:
        ended = subprocess.run(
            [rattle, *map(str, arguments)],
            cwd=cwd,
            input=stdin.encode() if isinstance(stdin, str) else stdin,
            capture_output=True,
            timeout=timeout,
            check=False,
        )
        return subprocess.CompletedProcess(
            ended.args,
            ended.returncode,
            ended.stdout.decode("utf-8", "replace"),
            ended.stderr.decode("utf-8", "replace"),
        )

    return call


@pytest.fixture(scope="session")
def scene_text() -> SceneText:
    """``scene_text(load={'mass': '2.0'}, film={'law': None})`` is a valid, fast input with these changes.

    Values are namelist text; None leaves the key out, and a group that is None is left out as a whole.
    """

    def build(**changes: dict[str, str | None] | None) -> str:
        text = ""
        for group in {**FAST_SCENE, **changes}:
            if group in changes and changes[group] is None:
                continue
            assignments = {**FAST_SCENE.get(group, {}), **(changes.get(group) or {})}
            lines = [f"   {key} = {value}\n" for key, value in assignments.items() if value is not None]
            text += f"&{group}\n{''.join(lines)}/\n"
        return text

    return build
