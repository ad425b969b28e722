"""make install and pip install: what they leave works from any folder."""

from __future__ import annotations

import hashlib
import html
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from rattle.keys import key_table

# They share a folder of the build: the tests of a file run one after another.
pytestmark = pytest.mark.long

SCRIPTS = (
    "calibrate",
    "campaign",
    "classify",
    "compare",
    "countermeasures",
    "export",
    "gear_data",
    "listen",
    "plot",
    "recording",
    "report",
    "sensitivity",
)


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
    folder = tmp_path_factory.mktemp("installed")
    # Python by a name of the search path, in a folder with a blank.
    own = folder / "a Python" / "bin"
    own.mkdir(parents=True)
    (own / "python-of-test").symlink_to(Path(sys.executable).resolve())
    (own.parent / "lib").symlink_to(Path(sys.prefix) / "lib")
    shutil.copy(Path(sys.prefix) / "pyvenv.cfg", own.parent)
    # A destination with blanks and a quote; something stands where its words before the blanks point to.
    precious = folder / "it's" / "bin" / "rattle" / "precious"
    precious.parent.mkdir(parents=True)
    precious.touch()
    before = places(folder)
    settings = (f"DESTDIR={folder}", "PREFIX=/it's put here", f"BUILD={build_of(rattle, repository)}")
    call(
        "make",
        "install",
        *settings,
        "PYTHON=python-of-test",
        cwd=repository,
        PATH=f"{own}:{os.environ['PATH']}",
    )
    prefix = folder / "it's put here"
    assert places(folder) - places(prefix) - {prefix} == before
    return prefix


def places(folder: Path) -> set[Path]:
    """Everything below a folder."""
    return set(folder.rglob("*"))


def build_of(program: Path, repository: Path) -> str:
    return os.path.relpath(program.parent, repository)


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
        "print(rattle.__file__, rattle.solve.find_program(), summary['rattle_class'], sep='\\n')\n"
        "from rattle import kernels; print(kernels.rupture_angle(0.0))"
    )
    packages = installed / "lib" / "rattle"
    reported = call(sys.executable, "-c", words, cwd=tmp_path, PYTHONPATH=str(packages)).splitlines()
    assert reported[:3] == [
        str(packages / "rattle" / "__init__.py"),
        str(installed / "bin" / "rattle"),
        "idle",
    ]
    assert (packages / "rattle" / "py.typed").is_file()
    assert float(reported[3]) == pytest.approx(0.4435543342)
    call(installed / "bin" / "rattle-report", "out/idle.rattle", cwd=tmp_path)
    page = (tmp_path / "report.html").read_text()
    meaning = key_table()["load", "mass"].meaning.partition(" Follows from")[0]
    assert html.escape(meaning.replace("`", "")) in page


def test_the_man_page_has_every_option_and_key(installed, rattle, repository, tmp_path):
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
    assert (installed / "share/doc/rattle/keys.md").read_text() == (repository / "input/KEYS.md").read_text()
    assert "share/doc/rattle/keys.md" in plain
    if shutil.which("groff"):
        assert (
            call("groff", "-man", "-Tutf8", "-ww", "-z", installed / "share/man/man1/rattle.1", cwd=tmp_path)
            == ""
        )


def test_bash_completes_options_keys_and_inputs(installed, tmp_path):
    for name in ("creep.nml", "creep.rattle"):
        (tmp_path / name).touch()

    def completed(*words: str) -> list[str]:
        completion = shlex.quote(str(installed / "share/bash-completion/completions/rattle"))
        line = f"source {completion}; compopt() {{ :; }}\n"
        line += f"COMP_WORDS=(rattle {' '.join(words)}); COMP_CWORD={len(words)}; _rattle\n"
        return call("bash", "-c", line + 'printf "%s\\n" "${COMPREPLY[@]}"', cwd=tmp_path).split()

    assert completed("--set", "load.force_a") == ["load.force_amplitude=", "load.force_amplitudes="]
    assert completed("--template", "spec") == ["spectrum"]
    assert completed("--ov") == ["--overwrite"]
    assert completed("cr") == ["creep.nml"]


@pytest.fixture
def moved(installed, tmp_path) -> Path:
    """A copy of the installation in a folder that was there before, with another program's files."""
    prefix = tmp_path / "of all"
    shutil.copytree(installed, prefix, symlinks=True)
    listed = prefix / "lib/rattle/installed.list"
    listed.write_text(re.sub(r"^folder  (\.|share|share/man)\n", "", listed.read_text(), flags=re.MULTILINE))
    return prefix


def uninstall(repository: Path, *settings: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["make", "--no-print-directory", "uninstall", *settings],
        cwd=repository,
        capture_output=True,
        text=True,
        check=False,
    )


def test_uninstall_removes_what_was_installed_and_nothing_else(moved, repository):
    call(moved / "bin/rattle-classify", "--help", cwd=moved, PYTHONDONTWRITEBYTECODE="")
    assert list((moved / "lib/rattle/rattle").glob("__pycache__/*.pyc"))
    others = ("bin/rattle-own", "lib/rattle/rattle/own.py", "share/man/man1/other.1")
    for name in others:
        (moved / name).write_text("somebody else's")
    changed = moved / "lib/rattle/plot.py"
    changed.write_text("# changed since\n")
    (moved / "bin/rattle-export").unlink()
    ended = uninstall(repository, f"DESTDIR={moved.parent}", "PREFIX=/of all")
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout == f"kept, as it has changed since: {changed}\n"
    left = {str(place.relative_to(moved)) for place in places(moved) if not place.is_dir()}
    assert left == {*others, "lib/rattle/plot.py"}
    folders = {str(place.relative_to(moved)) for place in places(moved) if place.is_dir()}
    assert folders == {
        "bin",
        "lib",
        "lib/rattle",
        "lib/rattle/rattle",
        "share",
        "share/man",
        "share/man/man1",
    }
    again = uninstall(repository, f"PREFIX={moved}")
    assert again.returncode != 0 and "it is not known what was installed" in again.stderr


def test_nothing_is_left_of_an_installation_alone(moved, repository):
    assert uninstall(repository, f"PREFIX={moved}").returncode == 0
    assert {str(place.relative_to(moved)) for place in places(moved)} == {"share", "share/man"}


@pytest.mark.parametrize("place", ("../precious", "/precious", "bin/../../precious"))
def test_a_list_that_leaves_the_folder_is_not_believed(place, tmp_path, repository):
    listed = tmp_path / "prefix/lib/rattle/installed.list"
    listed.parent.mkdir(parents=True)
    (tmp_path / "precious").touch()
    listed.write_text(f"{hashlib.sha256(b'').hexdigest()}  {place}\n")
    ended = uninstall(repository, f"PREFIX={tmp_path / 'prefix'}")
    assert ended.returncode != 0 and "names places outside" in ended.stderr
    assert (tmp_path / "precious").exists() and listed.exists()


def test_install_refuses_what_it_cannot_do_before_it_writes(repository, tmp_path):
    script = repository / "scripts/install.sh"
    for python, prefix, words in (
        ("no-such-python", tmp_path / "x", "there is no Python called no-such-python"),
        (sys.executable, "", "PREFIX is empty"),
        (sys.executable, f"{tmp_path}/a\nb", "more than one line"),
    ):
        arguments = (python, "build", "", "", "gfortran", prefix, "bin", "lib/rattle")
        ended = subprocess.run(
            [script, *arguments], cwd=repository, capture_output=True, text=True, check=False
        )
        assert ended.returncode == 2 and words in ended.stderr
    assert not places(tmp_path)


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
        "import rattle; print(rattle.__file__, rattle.__version__)\n"
        "from rattle import kernels; print(kernels.rupture_angle(0.0))"
    )
    reported = call(sys.executable, "-c", words, cwd=tmp_path, PYTHONPATH=str(site)).split()
    assert reported[0] == str(site / "rattle" / "__init__.py") and float(reported[2]) == pytest.approx(
        0.4435543342
    )
    assert reported[1] in call(site / "bin" / "rattle", "--version", cwd=tmp_path)
    assert {path.name for path in (site / "bin").iterdir()} >= {
        "rattle",
        *(f"rattle-{name}" for name in SCRIPTS),
    }
    described = next(site.glob("rattle-*.dist-info/METADATA")).read_text()
    assert f"Version: {reported[1]}\n" in described
    assert re.search(r"^Requires-Dist: numpy>=", described, re.MULTILINE)
    recorded = next(site.glob("rattle-*.dist-info/RECORD")).read_text()
    for file in ("keys.md,sha256=", "_kernels", "py.typed,sha256="):
        assert f"rattle/{file}" in recorded
