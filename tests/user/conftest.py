"""Fixtures of the tests that call the program as a user does."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings
from outcomes import assert_no_crash, contents
from waiting import PATIENCE

# No test is timed: an example that takes long on a busy machine is not a fault.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")

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
def shim(repository: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A library that lets an output call of the program meet a fault, or shows which calls there are."""
    library = tmp_path_factory.mktemp("shim") / "inject_faults.so"
    source = repository / "tests" / "faults" / "inject_faults.c"
    subprocess.run(["gcc", "-shared", "-fPIC", "-o", library, source, "-ldl"], check=True)
    return library


@pytest.fixture(scope="session")
def run(rattle: Path) -> Run:
    """``run(*arguments, cwd=..., stdin=...)`` calls the program and waits for its end.

    `program` is another path of it, `identity` names the user and groups that it runs as.
    """

    def call(
        *arguments: object,
        cwd: Path,
        stdin: str | bytes = b"",
        timeout: float = PATIENCE,
        program: Path | str = rattle,
        **identity: object,
    ) -> subprocess.CompletedProcess[str]:
        ended = subprocess.run(
            [program, *map(str, arguments)],
            cwd=cwd,
            input=stdin.encode() if isinstance(stdin, str) else stdin,
            capture_output=True,
            timeout=timeout,
            check=False,
            **identity,
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


@pytest.fixture
def refused(run: Run, tmp_path: Path) -> Callable[..., list[str]]:
    """Call the program with bad input; return its faults, one per line, everything else checked."""

    def call(*arguments: object, **options: object) -> list[str]:
        before = contents(tmp_path)
        ended = run(*arguments, cwd=tmp_path, **options)
        assert ended.returncode == 2, ended
        assert ended.stdout == ""
        assert_no_crash(ended.stderr)
        assert contents(tmp_path) == before
        assert ended.stderr.endswith("\n")
        return ended.stderr[:-1].split("\n")

    return call


@pytest.fixture
def solved(run: Run, scene_text: SceneText, tmp_path: Path) -> Callable[..., Path]:
    """Run a scene that must succeed; return the folder of its files."""

    def solve(name: str = "scene", **changes: dict[str, str | None] | None) -> Path:
        folder = tmp_path / name
        folder.mkdir()
        (folder / f"{name}.nml").write_text(scene_text(**changes))
        ended = run(f"{name}.nml", cwd=folder)
        assert (ended.returncode, ended.stderr) == (0, ""), ended
        return folder / "results"

    return solve
