"""The commands of a page, called as a user would from the folder of the repository."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path


def shell(page: str) -> str:
    """What a page has between ```sh and ```."""
    return "".join(re.findall(r"^```sh\n(.*?)^```", page, re.M | re.S))


def call(commands: str, folder: Path, rattle: Path, repository: Path) -> subprocess.CompletedProcess[str]:
    """Commands in a folder that is as the repository."""
    (folder / "build").mkdir()
    (folder / "build" / "rattle").symlink_to(rattle)
    for name in ("scripts", ".venv", "input"):
        (folder / name).symlink_to(repository / name)
    environment = os.environ | {"OMP_NUM_THREADS": "1"}
    return subprocess.run(
        ["bash", "-e", "-o", "pipefail", "-c", commands],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
