"""Scripts do the same whatever environment and files of a user say of Matplotlib, Python and language."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from campaign_writer import FORCES, SPEEDS, grid
from conftest import REPOSITORY
from test_order_cuts import CAMPAIGN, GEAR
from test_sensitivity import INPUT, SPREAD

SCRIPTS = REPOSITORY / "scripts"
# What a notebook sets, and what nothing can mean.
BACKENDS = ("module://matplotlib_inline.backend_inline", "no such backend")
BAD_STYLE = b"font.family: \xff\xfe\naxes.edgecolor: nocolour\nbackend: nonsense\nno colon\n"
OTHER_STYLE = b"axes.edgecolor: red\nfont.size: 14\ntext.usetex: true\nsavefig.bbox: tight\nsvg.hashsalt: x\n"


def hostile(name: str, folder: Path, work: Path) -> dict[str, str]:
    """Settings that must change nothing; their files are put into the folder, and to where the work is."""
    environment = {key: value for key, value in os.environ.items() if key not in ("HOME", "PYTHONPATH")}
    if name == "plain":
        return {**environment, "HOME": str(folder)}
    styles = folder / "config" / "stylelib"
    styles.mkdir(parents=True)
    if name == "broken":
        for place in (work / "matplotlibrc", styles.parent / "matplotlibrc", styles / "own.mplstyle"):
            place.write_bytes(BAD_STYLE)
        return {
            **environment,
            "MPLBACKEND": BACKENDS[0],
            "MPLCONFIGDIR": str(styles.parent),
            "LC_ALL": "xx_YY.no-such",
            "LANG": "tlh",
            "PYTHONWARNINGS": "error",
        }
    if name == "own style":
        for place in (work / "matplotlibrc", folder / "own.rc", styles.parent / "matplotlibrc"):
            place.write_bytes(OTHER_STYLE)
        given = {"MATPLOTLIBRC": str(folder / "own.rc"), "MPLCONFIGDIR": str(styles.parent)}
        return {
            **environment,
            **given,
            "MPLBACKEND": BACKENDS[1],
            "HOME": str(folder),
            "LC_ALL": "de_DE.UTF-8",
        }
    (styles.parent / "matplotlibrc").mkdir()
    given = {"MATPLOTLIBRC": str(styles.parent), "MPLCONFIGDIR": "/proc/none/of/this", "MPLBACKEND": "TkAgg"}
    return {
        **given,
        "PATH": os.environ["PATH"],
        "LC_ALL": "C",
        "PYTHONUTF8": "0",
        "PYTHONCOERCECLOCALE": "0",
        "PYTHONOPTIMIZE": "2",
        "PYTHONWARNINGS": "error::DeprecationWarning,always::ResourceWarning",
        "DISPLAY": ":none",
    }


ENVIRONMENTS = ("broken", "own style", "bare")
SMALL = ("--format", "png,svg", "--dpi", "30")
# Every script that works on files: what follows its name. `o` takes what it writes.
COMMANDS = {
    "plot a motion": ("plot.py", "motion", "idle.rattle", "--output", "o", "--figures", "8", *SMALL),
    "plot a film": ("plot.py", "film", "film.rattle", "--output", "o", *SMALL),
    "plot a campaign": ("plot.py", "campaign", "map.rattle", "--output", "o", *SMALL),
    "plot regimes": ("plot.py", "regime-map", "idle.rattle", "--output", "o", *SMALL),
    "report": ("report.py", "idle.rattle", "film.rattle", "map.rattle", "--output", "o"),
    "compare": ("compare.py", "idle.rattle"),
    "compare with measured cuts": (
        "compare.py",
        "run_up.rattle",
        "--measured",
        "bench.csv",
        "--output",
        "o",
        *SMALL,
    ),
    "classify": ("classify.py", "idle.rattle", "--output", "o.csv"),
    "export": ("export.py", "idle.rattle", "--output", "o.csv"),
    "export as NetCDF": ("export.py", "idle.rattle", "--output", "o.nc"),
    "campaign status": ("campaign.py", "status", "map.rattle"),
    "campaign as Parquet": (
        "campaign.py",
        "export",
        "map.rattle",
        "--to",
        "parquet",
        "--output",
        "o.parquet",
    ),
    "scenes again": ("campaign.py", "rerun", "map.rattle", "--worst", "2", "--output", "o"),
    "a page on variants": ("compare.py", "idle.rattle", "idle.rattle", "--output", "o"),
    "a sound": ("listen.py", "idle.rattle", "--output", "o.wav", "--seconds", "0.2"),
    "a job script": ("campaign.py", "slurm", "pair.nml", "--program", "rattle", "--script", "o"),
    "a design": ("sensitivity.py", "design", "pair.nml", "--blocks", "2"),
    "indices": ("sensitivity.py", "pair_design.rattle", "--quantities", "film_force_rms", "--output", "o"),
    "countermeasures": ("countermeasures.py", "single.nml", "--keys", "gear.face_width", "--output", "o"),
    "a fit": ("calibrate.py", "single.nml", "measured.csv", "--range", "0.5,2", "--output", "o.csv"),
}
QUICK = ("plot a motion", "compare", "a job script")


@pytest.fixture(scope="module")
def results(run, tmp_path_factory) -> Path:
    """A motion, a film, campaigns over speed and over a design, and measured cuts and points."""
    folder = tmp_path_factory.mktemp("results")
    for name in ("idle", "film"):
        ended = run("--output", folder, REPOSITORY / "input" / f"{name}.nml", cwd=folder)
        assert ended.returncode == 0, ended.stderr
    grid(FORCES, SPEEDS, failures=True).write(folder / "map.rattle")
    (folder / "single.nml").write_text(INPUT)
    (folder / "pair.nml").write_text(f"{INPUT}{SPREAD}/\n")
    (folder / "run_up.nml").write_text(f"{GEAR}{CAMPAIGN}&scene task = 'campaign' /\n")
    (folder / "bench.csv").write_text("speed_rpm,order_2\n800,1\n1000,2\n")
    (folder / "measured.csv").write_text("speed_rpm,temperature_celsius,film_force_rms\n800,50,5\n900,60,6\n")
    arguments = [*COMMANDS["a design"][1:], "--overwrite"]
    called("sensitivity.py", arguments, folder, dict(os.environ))
    for name in ("run_up", "pair_design"):
        ended = run("--output", folder, f"{name}.nml", cwd=folder)
        assert ended.returncode == 0, ended.stderr
    for made in folder.glob("pair*design.[nc]*"):
        made.unlink()
    return folder


def called(script: str, arguments: list[object], cwd: Path, environment: dict[str, str]) -> tuple[str, str]:
    """What a script says and complains of in an interpreter of its own."""
    ended = subprocess.run(
        [sys.executable, SCRIPTS / script, *map(str, arguments)],
        cwd=cwd,
        env=environment,
        capture_output=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr.decode(errors="replace")
    return ended.stdout.decode(), ended.stderr.decode()


def left_by(name: str, environment: str, results: Path, place: Path) -> tuple[str, str, dict[str, bytes]]:
    """What a command says and complains of, and what it writes."""
    folder = place / "work"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(results, folder)
    settings = hostile(environment, place / environment, folder)
    before = set(folder.rglob("*"))
    said, complained = called(*COMMANDS[name][:1], list(COMMANDS[name][1:]), folder, settings)
    made = {str(path.relative_to(folder)): path for path in folder.rglob("*") if path not in before}
    return said, complained, {key: path.read_bytes() for key, path in made.items() if path.is_file()}


def some(name: str) -> object:
    return pytest.param(name, marks=() if name in QUICK else pytest.mark.long)


@pytest.mark.parametrize("name", list(map(some, COMMANDS)))
def test_a_script_does_the_same_in_every_environment(name: str, results: Path, tmp_path: Path) -> None:
    expected = left_by(name, "plain", results, tmp_path)
    assert expected[0] or expected[2]
    for environment in ENVIRONMENTS if name in QUICK else ENVIRONMENTS[:1]:
        found = left_by(name, environment, results, tmp_path)
        assert found[:2] == expected[:2], environment
        assert found[2].keys() == expected[2].keys()
        for file, content in found[2].items():
            assert content == expected[2][file], (environment, file)


def test_the_matplotlib_of_a_notebook_keeps_its_settings(results: Path, tmp_path: Path) -> None:
    """Who has loaded Matplotlib finds it as it was; so are the variables of who has not."""
    words = """
import os, sys
sys.path.insert(0, {scripts!r})
{load}
from rattle.figures import style
import matplotlib
with style.house_style():
    assert matplotlib.rcParams["axes.edgecolor"] == "black", matplotlib.rcParams["axes.edgecolor"]
given = [os.environ[name] for name in ("MPLBACKEND", "MATPLOTLIBRC")]
print(matplotlib.rcParams["axes.edgecolor"], *given, os.getcwd())
"""
    settings = hostile("own style", tmp_path, tmp_path) | {"MPLBACKEND": "svg"}
    for load, colour in (("import matplotlib", "red"), ("", "black")):
        ended = subprocess.run(
            [sys.executable, "-c", words.format(scripts=str(SCRIPTS), load=load)],
            cwd=tmp_path,
            env=settings,
            capture_output=True,
            text=True,
            check=False,
        )
        assert (ended.returncode, ended.stderr) == (0, "")
        assert ended.stdout.split() == [colour, "svg", settings["MATPLOTLIBRC"], str(tmp_path)]
