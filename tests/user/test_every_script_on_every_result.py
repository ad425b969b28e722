"""Every script on every kind of result: its work, or a plain sentence; never a traceback."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
from pathlib import Path

import campaign_runs
import campaign_writer
import pytest
from outcomes import series_in
from result_writer import result_bytes
from script_calls import SCRIPTS, called_here
from test_thresholds import threshold_text
from waiting import until

import rattle as package

SMALL = ("--format", "png", "--dpi", "20")
FAILING = {"load": {"force_amplitude": "1e9"}, "solver": {"iteration_limit": "2"}}
STEADY = {"solver": {"method": None, "steps_per_period": None, "until": "'steady'", "periods": "60"}}
# Scripts with what stands before and behind the result.
CALLS = {
    "export": ("export.py", (), ("--output", "o/of.csv")),
    "export as NetCDF": ("export.py", (), ("--output", "o/of.nc")),
    "export a column": ("export.py", (), ("--columns", "acceleration", "--stride", "3", "--output", "-")),
    "classify": ("classify.py", (), ("--output", "o/classes.csv")),
    "compare": ("compare.py", (), ()),
    "compare in Markdown": ("compare.py", ("--markdown",), ()),
    "listen": ("listen.py", (), ("--output", "o/of.wav", "--seconds", "0.2")),
    "compare one as a page": ("compare.py", (), ("--output", "o")),
    "report": ("report.py", (), ("--output", "o")),
    **{
        f"plot {name}": ("plot.py", (name,), ("--output", "o", *SMALL))
        for name in ("motion", "film", "sweep", "campaign", "threshold", "regime-map")
    },
    "plot without a command": ("plot.py", (), ()),
    "plot a motion over others": ("plot.py", ("motion", "--overlay"), ("--output", "o", *SMALL)),
    "plot a summary": ("plot.py", ("campaign", "--summary"), ("--output", "o", *SMALL)),
    "plot all pairs": ("plot.py", ("campaign", "--together"), ("--output", "o", *SMALL)),
    "campaign status": ("campaign.py", ("status",), ()),
    "campaign export": ("campaign.py", ("export", "--to", "csv"), ("--output", "o/map.csv")),
    "campaign as Parquet": ("campaign.py", ("export", "--to", "parquet"), ("--output", "o/map.parquet")),
    "campaign rerun": ("campaign.py", ("rerun", "--worst", "2"), ("--output", "o")),
    "campaign rerun of failures": ("campaign.py", ("rerun", "--failed", "2"), ("--output", "o")),
    "campaign merge": ("campaign.py", ("merge",), ("--output", "o/joined.rattle")),
    "campaign slurm": ("campaign.py", ("slurm", "--program", "x"), ("--script", "o/job")),
}
# What each kind of result must give: the scripts that do their work on it. Others refuse, with a sentence.
ALWAYS = {"export", "export as NetCDF", "report"}
COMPARED = {"compare", "compare in Markdown"}
SERIES = ALWAYS | {"export a column"}
MOTION = SERIES | COMPARED | {"plot regime-map", "plot motion", "plot a motion over others", "listen"}
CAMPAIGN = ALWAYS | {
    "plot campaign",
    "plot all pairs",
    "plot a summary",
    "campaign status",
    "campaign export",
}
CAMPAIGN |= {"campaign as Parquet", "campaign rerun"}
WORKING = {
    "motion": MOTION | {"classify"},
    "failed": SERIES | COMPARED | {"plot regime-map"},
    "steady_failed": SERIES | COMPARED | {"plot regime-map"},
    "never_begun": SERIES | COMPARED | {"plot regime-map"},
    "interrupted": MOTION | {"classify"},
    "unclosed": (MOTION - COMPARED) | {"classify"},
    "film": ALWAYS | COMPARED | {"plot film"},
    "sweep": ALWAYS | COMPARED | {"plot sweep"},
    "map": CAMPAIGN | COMPARED | {"campaign merge"},
    "unfinished_map": CAMPAIGN,
    "empty_map": ALWAYS | COMPARED | {"campaign status", "campaign export", "campaign as Parquet"},
    "unbegun_list": ALWAYS | {"campaign status", "campaign export", "campaign as Parquet"},
    "crossings": ALWAYS | COMPARED | {"plot threshold", "campaign merge"},
    "empty_crossings": ALWAYS | COMPARED,
    "unfinished_crossings": ALWAYS | {"plot threshold"},
    "no_motion": SERIES | {"plot regime-map"},
    "no_sweep": ALWAYS,
    "no_film": ALWAYS,
    "box.one": MOTION,
    "box.summary.nml": COMPARED | {"listen"},
    "alone.summary.nml": COMPARED,
    "motion.state": SERIES,
    "motion.log": set(),
    "foreign": set(),
    "empty": set(),
    "absent": set(),
    "folder": set(),
}


@pytest.fixture(scope="module")
def results(tmp_path_factory, rattle, run, repository, scene_text) -> Path:
    """A folder with a result of each kind."""
    folder = tmp_path_factory.mktemp("kinds")

    def solve(name: str, text: str, *options: str, codes: tuple[int, ...] = (0,)) -> None:
        (folder / f"{name}.nml").write_text(text)
        ended = run("--output", ".", *options, f"{name}.nml", cwd=folder, timeout=600.0)
        assert ended.returncode in codes, ended.stderr

    solve("motion", scene_text(load={"force_amplitude": "20.0"}, solver={"periods": "20"}))
    solve("failed", scene_text(**FAILING), codes=(1,))
    late = {**STEADY, "load": {"force_amplitude": "2000.0"}}
    late["film"] = {"law": "'piezo-viscous'", "model": "'reynolds'"}
    solve("steady_failed", scene_text(**late), codes=(1,))
    heavy = {**late, "load": {"steady_force": "2e5"}, "solver": STEADY["solver"]}
    solve("never_begun", scene_text(**heavy), codes=(1,))
    film = (repository / "input" / "film.nml").read_text()
    solve("film", film, "--set", "scene.name=film")
    sweep = (repository / "input" / "sweep.nml").read_text()
    solve("sweep", sweep, "--set", "scene.name=sweep", "--set", "sweep.count=3")
    solve("map", campaign_runs.grid(scene_text, 4, 3))
    solve("crossings", threshold_text(scene_text, threshold={"tolerance": "1e-2"}))
    parts = ("--set", "campaign.part=1", "--set", "campaign.parts=9")
    solve("empty_map", campaign_runs.grid(scene_text, 2, 2), *parts)
    solve("empty_crossings", threshold_text(scene_text, threshold={"tolerance": "1e-2"}), *parts)
    for name in ("empty_map", "empty_crossings"):
        for ending in (".rattle", ".summary.nml"):
            (folder / f"{name}.part-1-of-9{ending}").rename(folder / f"{name}{ending}")
    one = campaign_writer.grid(campaign_writer.FORCES, campaign_writer.SPEEDS, name="unfinished_map")
    one.write(folder / "unfinished_map.rattle", undone=[2], closed=False)
    listed = campaign_writer.csv_table(name="unbegun_list")
    chunks = range(-(-len(listed.rows) // listed.chunk_rows))
    listed.write(folder / "unbegun_list.rattle", undone=chunks, closed=False)
    gears = (repository / "input" / "gearbox.nml").read_text()
    solve("box", gears, "--set", "scene.name=box", "--set", "solver.periods=20", codes=(0, 1))
    first = next(path for path in series_in(folder) if path.name.startswith("box."))
    shutil.copy(first, folder / "box.one.rattle")
    shutil.copy(first.with_suffix(".summary.nml"), folder / "box.one.summary.nml")
    shutil.copy(folder / "motion.summary.nml", folder / "alone.summary.nml")
    whole = package.read(folder / "motion.rattle")
    for name, source in (
        ("unclosed", whole),
        ("unfinished_crossings", package.read(folder / "crossings.rattle")),
    ):
        columns = [(column, source.units[column]) for column in source.names]
        rows = [list(row) for row in zip(*(source[column] for column in source.names), strict=True)][:-1]
        content = result_bytes(columns, rows, input_text=source.input_text, closed=False)
        (folder / f"{name}.rattle").write_bytes(content)
    for name in ("motion", "sweep", "film"):
        source = package.read(folder / f"{name}.rattle")
        columns = [(column, source.units[column]) for column in source.names]
        content = result_bytes(columns, [], input_text=source.input_text, closed=False)
        (folder / f"no_{name}.rattle").write_bytes(content)
    interrupt(rattle, folder, scene_text)
    (folder / "foreign.rattle").write_bytes(b"PK\x03\x04" + bytes(range(256)) * 4)
    (folder / "empty.rattle").write_bytes(b"")
    (folder / "folder.rattle").mkdir()
    return folder


def interrupt(rattle: Path, folder: Path, scene_text) -> None:
    """A motion that a signal ended after some periods."""
    text = scene_text(load={"force_amplitude": "20.0"}, solver={"periods": "100000000"})
    (folder / "interrupted.nml").write_text(text)
    process = subprocess.Popen([rattle, "--quiet", "--output", ".", "interrupted.nml"], cwd=folder)
    path = folder / "interrupted.rattle"
    until(lambda: path.exists() and path.stat().st_size > 20_000, process)
    process.send_signal(signal.SIGTERM)
    assert process.wait(600) == 128 + signal.SIGTERM


@pytest.mark.long
@pytest.mark.parametrize("kind", WORKING)
def test_scripts_do_their_work_or_say_why_not(kind, results, tmp_path):
    place = results / (kind if kind.endswith((".nml", ".state", ".log")) else f"{kind}.rattle")
    worked = set()
    for name, (script, before, behind) in CALLS.items():
        folder = tmp_path / name.replace(" ", "_")
        (folder / "o").mkdir(parents=True)
        code, said, complaint = called_here(script, *before, place, *behind, cwd=folder)
        reported = f"{name} of {kind}: {code}, {said[-200:]}, {complaint}"
        assert code in (0, 2), reported
        assert "Traceback" not in complaint and "Warning" not in complaint, reported
        if code == 0:
            worked.add(name)
            assert said or any((folder / "o").iterdir()), reported
        else:
            lines = complaint.rstrip().splitlines()
            assert lines[-1].endswith((".", "'-h'")) or "error:" in complaint, reported
            assert not any((folder / "o").iterdir()), reported
    assert sorted(worked) == sorted(WORKING[kind])


MOTION_KINDS = {"motion", "motion.state", "failed", "steady_failed", "never_begun", "interrupted", "box.one"}
BESIDE_ITSELF = MOTION_KINDS | {"sweep", "map", "unfinished_map", "crossings", "unfinished_crossings"}
BESIDE_ITSELF |= {"box.summary.nml", "alone.summary.nml"}


@pytest.mark.long
@pytest.mark.parametrize("kind", WORKING)
def test_any_two_results_are_compared_or_it_is_said_why_not(kind, results, tmp_path):
    place = results / (kind if kind.endswith((".nml", ".state", ".log")) else f"{kind}.rattle")
    for name, other in (("itself", place), ("a motion", results / "motion.rattle")):
        output = tmp_path / name.replace(" ", "_")
        arguments = (place, other, "--output", output)
        code, said, complaint = called_here("compare.py", *arguments, cwd=tmp_path)
        reported = f"{kind} beside {name}: {code}, {said}, {complaint}"
        assert "Traceback" not in complaint and "Warning" not in complaint, reported
        compared = kind in (BESIDE_ITSELF if name == "itself" else MOTION_KINDS | {"alone.summary.nml"})
        assert (code == 0) == compared, reported
        if code == 0:
            page = (output / "comparison.html").read_text()
            assert ("The answer does not differ" in page) or name != "itself", reported
            assert (output / "comparison.csv").read_text().count("\n") > 1, reported
        else:
            assert complaint.count("\n") == 1 and complaint.endswith(".\n") and not output.exists(), reported


@pytest.mark.long
def test_without_kernels_scripts_work_or_name_what_is_missing(results, tmp_path):
    """In a copy of the scripts that nobody built the kernels for, made as `cp -r` does: a link stays one."""
    copy = tmp_path / "scripts"
    shutil.copytree(
        SCRIPTS, copy, symlinks=True, ignore=shutil.ignore_patterns("*.so", "__pycache__", "generate")
    )
    asked = "import rattle; print(rattle.__file__); rattle.version"
    ended = subprocess.run(
        [sys.executable, "-c", asked], cwd=copy, capture_output=True, text=True, check=False
    )
    assert str(copy) in ended.stdout and ended.returncode == 1
    assert ended.stderr.endswith(
        f"The version is not known: {copy / 'rattle' / 'VERSION'} is missing, in a clone of rattle a link to "
        "fsrc/VERSION.\n"
    )
    for name, kind, code in (
        ("export", "motion", 0),
        ("compare", "motion", 0),
        ("report", "motion", 2),
        ("report", "failed", 2),
        ("report", "crossings", 2),
        ("report", "empty_crossings", 2),
        ("classify", "motion", 2),
        ("plot motion", "motion", 2),
        ("plot regime-map", "motion", 2),
        ("plot film", "film", 2),
        ("plot threshold", "crossings", 0),
        ("plot campaign", "map", 0),
        ("export", "empty_crossings", 0),
        ("export", "failed", 0),
    ):
        script, before, behind = CALLS[name]
        (tmp_path / "o").mkdir()
        command = [sys.executable, copy / script, *before, results / f"{kind}.rattle", *behind]
        ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert ended.returncode == code, (name, kind, ended.stderr)
        missing = "The kernels of the package, which are compiled, are not built here; 'make python' builds"
        assert (missing in ended.stderr) == (code == 2), (name, kind, ended.stderr)
        assert "Traceback" not in ended.stderr
        assert (name == "compare" or any((tmp_path / "o").iterdir())) == (code == 0), (name, kind)
        shutil.rmtree(tmp_path / "o")
