"""make install and pip install: what they leave works from any folder."""

from __future__ import annotations

import html
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from rattle.keys import key_table

# One installation at a time: they share a folder of the build.
pytestmark = [pytest.mark.long, pytest.mark.xdist_group("installation")]

SCRIPTS = ("campaign", "classify", "compare", "export", "plot", "report")


def call(*command: object, cwd: Path, **environment: str) -> str:
    """Run a command that must succeed, with no path into this repository; returns what it prints."""
    settings = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith("MAKE") and name not in ("PYTHONPATH", "RATTLE_PROGRAM")
    }
    ended = subprocess.run(
        list(map(str, command)),
        cwd=cwd,
        env=settings | environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=500,
    )
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return ended.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory, repository, rattle) -> Path:
    """A folder that make installed into."""
    prefix = tmp_path_factory.mktemp("installed")
    build = os.path.relpath(rattle.parent, repository)
    call("make", "install", f"PREFIX={prefix}", f"BUILD={build}", f"PYTHON={sys.executable}", cwd=repository)
    return prefix


def test_the_program_is_there(installed, rattle, tmp_path):
    version = call(rattle, "--version", cwd=tmp_path)
    assert call(installed / "bin" / "rattle", "--version", cwd=tmp_path) == version


@pytest.mark.parametrize("name", SCRIPTS)
def test_every_script_runs_from_any_folder(installed, tmp_path, name):
    assert "usage:" in call(installed / "bin" / f"rattle-{name}", "--help", cwd=tmp_path)


def test_the_package_solves_reports_and_has_its_kernels(installed, repository, tmp_path):
    words = (
        f"import rattle; result, summary = rattle.run({str(repository / 'input' / 'idle.nml')!r}, "
        "folder='out')\n"
        "print(rattle.__file__, rattle.solve.find_program(), summary['rattle_class'])\n"
        "from rattle import kernels; print(kernels.rupture_angle(0.0))"
    )
    packages = installed / "lib" / "rattle"
    told = call(sys.executable, "-c", words, cwd=tmp_path, PYTHONPATH=str(packages)).split()
    assert told[:3] == [str(packages / "rattle" / "__init__.py"), str(installed / "bin" / "rattle"), "idle"]
    assert float(told[3]) == pytest.approx(0.4435543342)
    call(installed / "bin" / "rattle-report", "out/idle.rattle", cwd=tmp_path)
    page = (tmp_path / "report.html").read_text()
    meaning = key_table()["load", "mass"].meaning.partition(" Follows from")[0]
    assert html.escape(meaning.replace("`", "")) in page


def test_the_man_page_has_every_option_and_key(installed, rattle, tmp_path):
    page = (installed / "share" / "man" / "man1" / "rattle.1").read_text()
    plain = page.replace(r"\-", "-").replace(r"\&", "")
    options = re.findall(r"^  (--\w+)", call(rattle, "--help", cwd=tmp_path), re.MULTILINE)
    assert len(options) >= 12
    assert all(rf"\fB{option}\fR" in plain for option in options)
    assert len(key_table()) > 60
    for (group, name), key in key_table().items():
        part = plain.partition(f"\n.SS &{group}\n")[2].partition("\n.SS ")[0]
        assert rf"\fB{name}\fR" in part, (group, name)
        assert key.meaning.replace("`", "").replace("\\", r"\e") in part
    if shutil.which("groff"):
        assert (
            call("groff", "-man", "-Tutf8", "-ww", "-z", installed / "share/man/man1/rattle.1", cwd=tmp_path)
            == ""
        )


def test_bash_completes_options_keys_and_inputs(installed, tmp_path):
    for name in ("creep.nml", "creep.rattle"):
        (tmp_path / name).touch()

    def completed(*words: str) -> list[str]:
        line = f"source {installed}/share/bash-completion/completions/rattle; compopt() {{ :; }}\n"
        line += f"COMP_WORDS=(rattle {' '.join(words)}); COMP_CWORD={len(words)}; _rattle\n"
        return call("bash", "-c", line + 'printf "%s\\n" "${COMPREPLY[@]}"', cwd=tmp_path).split()

    assert completed("--set", "load.force_a") == ["load.force_amplitude=", "load.force_amplitudes="]
    assert completed("--template", "spec") == ["spectrum"]
    assert completed("--ov") == ["--overwrite"]
    assert completed("cr") == ["creep.nml"]


def test_pip_installs_the_checkout_with_program_and_kernels(repository, tmp_path):
    site = tmp_path / "site"
    options = (
        "--quiet",
        "--disable-pip-version-check",
        "--no-deps",
        "--no-build-isolation",
        "--target",
        site,
    )
    call(sys.executable, "-m", "pip", "install", *options, repository, cwd=tmp_path)
    words = (
        "import rattle; print(rattle.__file__, rattle.version)\n"
        "from rattle import kernels; print(kernels.rupture_angle(0.0))"
    )
    told = call(sys.executable, "-c", words, cwd=tmp_path, PYTHONPATH=str(site)).split()
    assert told[0] == str(site / "rattle" / "__init__.py") and float(told[2]) == pytest.approx(0.4435543342)
    assert told[1] in call(site / "bin" / "rattle", "--version", cwd=tmp_path)
    assert {path.name for path in (site / "bin").iterdir()} >= {
        "rattle",
        *(f"rattle-{name}" for name in SCRIPTS),
    }
    described = next(site.glob("rattle-*.dist-info/METADATA")).read_text()
    assert f"Version: {told[1]}\n" in described
    assert re.search(r"^Requires-Dist: numpy>=", described, re.MULTILINE)
    recorded = next(site.glob("rattle-*.dist-info/RECORD")).read_text()
    assert "rattle/keys.md,sha256=" in recorded and "rattle/_kernels" in recorded
