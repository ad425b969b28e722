"""Waits for what a process has done, not for time: a loaded machine makes a test slow, and nothing else."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

# Where nothing comes of it all [s].
PATIENCE = 3600.0
TICKS = os.sysconf("SC_CLK_TCK")


def until(reached: Callable[[], bool], process: subprocess.Popen) -> None:
    """Until something is so; a process that ends before is a failure."""
    deadline = time.monotonic() + PATIENCE
    while not reached():
        assert process.poll() is None or reached(), f"it ended with {process.returncode} before"
        assert time.monotonic() < deadline, "nothing comes of it"
        time.sleep(0.005)


def let_work(process: subprocess.Popen, seconds: float) -> None:
    """Until a process has used so much processor time on all its threads, or has ended."""
    until(lambda: process.poll() is not None or processor_seconds(process) >= seconds, process)


def processor_seconds(process: subprocess.Popen) -> float:
    """Processor time that a process has used so far [s]."""
    try:
        fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    except FileNotFoundError:
        return PATIENCE
    return (int(fields[11]) + int(fields[12])) / TICKS
