"""Peer CVODE: BDF with a dense analytic Jacobian in C, compiled here from cvode_peer.c against SUNDIALS."""

import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

import command
import numpy as np
import scenes

FLAGS = ("-O3", "-march=native")
LIBRARIES = ("-lsundials_cvode", "-lsundials_nvecserial", "-lm")
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
LEAST_SECONDS = 0.01

_folder = tempfile.TemporaryDirectory(prefix="cvode_peer_")
_program = Path(_folder.name) / "cvode_peer"


def _compile() -> str:
    """Compile the program; its version. A failure is an ImportError: the peer is missing."""
    source = Path(__file__).with_suffix(".c")
    try:
        call = ["gcc", *FLAGS, "-o", str(_program), str(source), *LIBRARIES]
        subprocess.run(call, check=True, capture_output=True, text=True)
        answer = subprocess.run([_program, "--version"], check=True, capture_output=True, text=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise ImportError(f"cvode_peer.c cannot be compiled (libsundials-dev, gcc): {error}") from error
    return answer.stdout.strip()


VERSION = _compile()


def prepare(scene: scenes.Scene, tolerance: float) -> Callable[[], tuple[np.ndarray, float]]:
    """The function returned solves once and gives the film and the CPU seconds that the program measured."""
    return command.prepare([str(_program)], scene, tolerance, str(LEAST_SECONDS))


IS_COMMAND = True
CONTENDERS = {"CVODE BDF": (prepare, TOLERANCES)}
