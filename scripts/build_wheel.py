"""What pip calls to build the wheel of this checkout: make compiles program and kernels, this packs them.

Only whole installations are known, `pip install .`; the program in the wheel is one for this kind of machine.
"""

from __future__ import annotations

import base64
import hashlib
import os
import re
import stat
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
# Packages of requirements.txt that every script needs, and by extra those for tables and other formats,
# for recordings of a test bench, and for sounds.
NEEDED = ("numpy", "matplotlib", "f90nml")
EXTRAS = {
    "tables": ("pandas", "xarray", "pyarrow", "netCDF4", "openpyxl", "scipy", "SALib"),
    "recordings": ("pandas", "scipy", "Pint", "asammdf", "npTDMS", "pyuff", "h5py"),
    "sound": ("scipy", "mosqito"),
}


def build_wheel(
    wheel_directory: str,
    config_settings: Mapping[str, Any] | None = None,
    metadata_directory: str | None = None,
) -> str:
    """Write the wheel and return its name."""
    project = read_project()
    stem = f"{project['name']}-{project['version']}"
    name = f"{stem}-{tag()}.whl"
    with tempfile.TemporaryDirectory() as folder:
        stage = Path(folder)
        make(stage)
        with zipfile.ZipFile(Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
            record = [added(wheel, place, content, mode) for place, content, mode in contents(stage, stem)]
            record += [
                added(wheel, f"{stem}.dist-info/METADATA", metadata(project).encode()),
                added(wheel, f"{stem}.dist-info/WHEEL", wheel_text().encode()),
            ]
            listing = "".join(record) + f"{stem}.dist-info/RECORD,,\n"
            added(wheel, f"{stem}.dist-info/RECORD", listing.encode())
    return name


def prepare_metadata_for_build_wheel(
    metadata_directory: str, config_settings: Mapping[str, Any] | None = None
) -> str:
    """Write what pip asks before it builds, and return its folder."""
    project = read_project()
    name = f"{project['name']}-{project['version']}.dist-info"
    folder = Path(metadata_directory) / name
    folder.mkdir()
    (folder / "METADATA").write_text(metadata(project))
    return name


def build_sdist(sdist_directory: str, config_settings: Mapping[str, Any] | None = None) -> str:
    raise NotImplementedError("rattle is installed from its checkout: pip install FOLDER")


def read_project() -> dict[str, Any]:
    """What pyproject.toml says of the project, and its version."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    return {**project, "version": (ROOT / "fsrc" / "VERSION").read_text().strip()}


def make(stage: Path) -> None:
    """Compile, and install into the stage, for the Python that runs this."""
    places = ("SCRIPTS_PLACE=scripts", "PACKAGES_PLACE=package", f"PREFIX={stage}", "DESTDIR=")
    command = ["make", f"-j{os.cpu_count()}", "install", f"PYTHON={sys.executable}", *places]
    settings = {name: value for name, value in os.environ.items() if not name.startswith("MAKE")}
    ended = subprocess.run(command, cwd=ROOT, env=settings, check=False, capture_output=True, text=True)
    if ended.returncode != 0:
        raise SystemExit(f"make install failed:\n{ended.stdout}{ended.stderr}")


def contents(stage: Path, stem: str) -> Iterator[tuple[str, bytes, int]]:
    """Place in the wheel, bytes and mode of everything that make left."""
    data = f"{stem}.data"
    yield f"{data}/scripts/rattle", (stage / "scripts" / "rattle").read_bytes(), 0o755
    for link in sorted((stage / "scripts").glob("rattle-*")):
        _, _, text = link.read_text().partition("\n")
        yield f"{data}/scripts/{link.name}", f"#!python\n{text}".encode(), 0o755
    for top, place in (("package/rattle", "rattle"), ("share", f"{data}/data/share")):
        for path in sorted((stage / top).rglob("*")):
            if path.is_file():
                yield f"{place}/{path.relative_to(stage / top)}", path.read_bytes(), 0o644


def added(wheel: zipfile.ZipFile, place: str, content: bytes, mode: int = 0o644) -> str:
    """Put a file into the wheel; returns its line of the record."""
    entry = zipfile.ZipInfo(place)
    entry.external_attr = (stat.S_IFREG | mode) << 16  # pip makes only plain files executable
    entry.compress_type = zipfile.ZIP_DEFLATED
    wheel.writestr(entry, content)
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{place},sha256={digest},{len(content)}\n"


def metadata(project: Mapping[str, Any]) -> str:
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {project['name']}",
        f"Version: {project['version']}",
        f"Summary: {project['description']}",
        f"Requires-Python: {project['requires-python']}",
        f"License: {project['license']['text']}",
    ]
    asked = requirements()
    lines += [f"Requires-Dist: {asked[name]}" for name in NEEDED]
    for extra, names in EXTRAS.items():
        lines += [f"Provides-Extra: {extra}"]
        lines += [f"Requires-Dist: {asked[name]}; extra == '{extra}'" for name in names]
    return "\n".join(lines) + "\n"


def requirements() -> dict[str, str]:
    """The lines of requirements.txt by package."""
    lines = (ROOT / "scripts" / "requirements.txt").read_text().splitlines()
    return {re.split(r"[<>=~]", line)[0]: line for line in lines if line and not line.startswith("#")}


def wheel_text() -> str:
    return f"Wheel-Version: 1.0\nGenerator: rattle\nRoot-Is-Purelib: false\nTag: {tag()}\n"


def tag() -> str:
    """This Python on this kind of machine."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[^A-Za-z0-9]', '_', sysconfig.get_platform())}"
