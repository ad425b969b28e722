"""What was written is not lost: failed and killed runs, two runs at a time, damaged and foreign files."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
from pathlib import Path

import pytest
from campaign_runs import BASE, grid
from outcomes import contents, digest, summary_of
from result_writer import resealed

import rattle as package

KINDS = ("log", "rattle", "state", "summary.nml")
# What a run that was killed has left beside the place of a file.
LEFT = "0123456789abcdef.new"


def limited(rattle: Path, folder: Path, blocks: int, *arguments: str) -> subprocess.CompletedProcess[str]:
    """A run whose files may not grow beyond some kilobytes, which stands in for a full disk."""
    command = f'ulimit -f {blocks}; exec "$0" "$@"'
    return subprocess.run(
        ["bash", "-c", command, rattle, *arguments], cwd=folder, capture_output=True, text=True, check=False
    )


def film_task(scene_text) -> str:
    absent = {"load": None, "film": None, "solver": None, "spectrum": None, "kinematics": None}
    points = {"film_ratios": "70e-6, 80e-6", "speed_groups": "0.45e-6", "compute": "'load', 'profile'"}
    return scene_text(scene={"task": "'film'"}, points=points, **absent)


def sweep(scene_text, count: int = 3) -> str:
    return scene_text(
        scene={"task": "'sweep'"},
        solver={"method": None, "steps_per_period": None, "periods": "60"},
        sweep={"key": "'frequency'", "first": "500.0", "last": "600.0", "count": str(count)},
    )


# --- failed runs -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("command", ["--resume", "--overwrite"])
def test_failed_run_leaves_the_earlier_files(
    command: str, rattle: Path, run, scene_text, tmp_path: Path
) -> None:
    """The disk runs full while the longer series is written; all but the log stays as it was."""
    (tmp_path / "scene.nml").write_text(scene_text(solver={"periods": "100"}))
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    before = contents(tmp_path / "results")
    longer = ("--quiet", command, "--set", "solver.periods=200", "scene.nml")
    ended = limited(rattle, tmp_path, 150, *longer)
    assert ended.returncode == 3
    assert ended.stderr == "results/scene.rattle cannot be written: File too large\n"
    after = contents(tmp_path / "results")
    log = next(path for path in after if str(path).endswith("scene.log"))
    assert {path: after[path] for path in after if path != log} == {
        path: before[path] for path in before if path != log
    }
    assert run(*longer, cwd=tmp_path).returncode == 0
    assert run("--output", "whole", "--set", "solver.periods=200", "scene.nml", cwd=tmp_path).returncode == 0
    for kind in ("rattle", "state"):
        assert digest(tmp_path / "results" / f"scene.{kind}") == digest(tmp_path / "whole" / f"scene.{kind}")


def test_failed_first_run_says_so(rattle: Path, run, scene_text, tmp_path: Path) -> None:
    """What came to the disk stays, unclosed; a summary says that it is not all."""
    (tmp_path / "scene.nml").write_text(scene_text(solver={"periods": "200"}))
    assert limited(rattle, tmp_path, 150, "--quiet", "scene.nml").returncode == 3
    results = tmp_path / "results"
    assert sorted(path.name for path in results.iterdir()) == [
        "scene.log",
        "scene.rattle",
        "scene.summary.nml",
    ]
    assert summary_of(results / "scene.summary.nml")["status"] == "not_written"
    assert not package.read(results / "scene.rattle").closed
    assert run("--resume", "scene.nml", cwd=tmp_path).returncode == 0
    assert package.read(results / "scene.rattle").closed


@pytest.mark.parametrize("limit", [0, 1, 6, 7, 100])
def test_full_disk_from_the_start_stops_nobody(
    limit: int, rattle: Path, run, scene_text, tmp_path: Path
) -> None:
    """Whatever a few bytes make of the log and the first file, the next run is not kept from its work."""
    (tmp_path / "scene.nml").write_text(scene_text())
    ended = subprocess.run(
        [rattle, "--quiet", "scene.nml"],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
    )
    assert ended.returncode == 3
    assert run("--resume", "scene.nml", cwd=tmp_path).returncode == 0
    assert package.read(tmp_path / "results" / "scene.rattle").closed


@pytest.mark.parametrize("task", ["film", "sweep"])
def test_failed_task_leaves_the_earlier_files(
    task: str, rattle: Path, run, scene_text, tmp_path: Path
) -> None:
    text = film_task(scene_text) if task == "film" else sweep(scene_text)
    (tmp_path / "scene.nml").write_text(text)
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    before = {name: digest(tmp_path / "results" / name) for name in os.listdir(tmp_path / "results")}
    assert limited(rattle, tmp_path, 1, "--quiet", "--overwrite", "scene.nml").returncode == 3
    after = {name: digest(tmp_path / "results" / name) for name in os.listdir(tmp_path / "results")}
    before.pop("scene.log"), after.pop("scene.log")
    assert after == before


# --- what a crash leaves ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "command", [[], ["--resume"], ["--overwrite"]], ids=lambda words: "".join(words) or "plain"
)
@pytest.mark.parametrize("kind", [*KINDS, *(f"{kind}.{LEFT}" for kind in KINDS[1:]), "lock"])
def test_empty_file_is_ours(kind: str, command: list[str], run, scene_text, tmp_path: Path) -> None:
    """A crash between the making of a file and its first bytes stops no one."""
    (tmp_path / "scene.nml").write_text(scene_text())
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / f"scene.{kind}").touch()
    ended = run(*command, "scene.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert sorted(path.name for path in (tmp_path / "results").iterdir()) == [
        f"scene.{kind}" for kind in KINDS
    ]


@pytest.mark.parametrize(
    "kind", ["log", "rattle", "summary.nml", "progress.nml", f"rattle.{LEFT}", f"summary.nml.{LEFT}"]
)
def test_empty_file_of_a_campaign_is_ours(kind: str, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(grid(scene_text, 5, 5))
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / f"scene.{kind}").touch()
    ended = run("--resume", "scene.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert package.read_campaign(tmp_path / "results" / "scene.rattle").closed


@pytest.mark.parametrize("kind", ["rattle", "summary.nml"])
def test_zeros_beside_the_place_of_a_file_are_ours(kind: str, run, scene_text, tmp_path: Path) -> None:
    """A crash of the machine leaves zeros where bytes were on their way to the disk."""
    (tmp_path / "scene.nml").write_text(grid(scene_text, 5, 5))
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / f"scene.{kind}.{LEFT}").write_bytes(bytes(4096))
    ended = run("--resume", "scene.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert not (tmp_path / "results" / f"scene.{kind}.{LEFT}").exists()


@pytest.mark.parametrize("kind", ["rattle", "state", "summary.nml"])
def test_half_of_a_new_file_is_replaced(kind: str, run, scene_text, tmp_path: Path) -> None:
    """A crash amid the writing leaves half a file beside its place, and a file in its place untouched."""
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    path = tmp_path / "results" / f"scene.{kind}"
    half = path.with_name(f"{path.name}.{LEFT}")
    half.write_bytes(path.read_bytes()[:50])
    assert run("--resume", "--set", "solver.periods=9", "scene.nml", cwd=tmp_path).returncode == 0
    assert not half.exists()


# --- two runs at a time ----------------------------------------------------------------------------------


@pytest.mark.parametrize("task", ["motion", "film", "sweep"])
def test_one_of_two_runs_refuses(task: str, rattle: Path, scene_text, tmp_path: Path) -> None:
    """However they meet: one does the work, the others say why not and change nothing."""
    long = scene_text(solver={"periods": "3000"}, spectrum={"verify": ".false."})
    text = {"motion": long, "film": film_task(scene_text), "sweep": sweep(scene_text, 20)}[task]
    (tmp_path / "scene.nml").write_text(text)
    alone = subprocess.run([rattle, "--quiet", "--output", "alone", "scene.nml"], cwd=tmp_path, check=False)
    assert alone.returncode == 0
    for _ in range(10):
        runs = [
            subprocess.Popen(
                [rattle, "--quiet", "scene.nml"], cwd=tmp_path, stderr=subprocess.PIPE, text=True
            )
            for _ in range(3)
        ]
        reported = [process.communicate(timeout=600.0)[1] for process in runs]
        codes = [process.returncode for process in runs]
        assert codes.count(0) == 1, (codes, reported)
        for code, words in zip(codes, reported, strict=True):
            assert code in (0, 2, 3)
            if code == 3:
                assert words == (
                    "results/scene is being written by another run; wait for its end, or choose another name "
                    "or output directory\n"
                )
            if code == 2:
                assert "exists; --overwrite replaces it" in words
        assert digest(tmp_path / "results" / "scene.rattle") == digest(tmp_path / "alone" / "scene.rattle")
        assert not (tmp_path / "results" / "scene.lock").exists()
        shutil.rmtree(tmp_path / "results")


# --- damage ----------------------------------------------------------------------------------------------


def flipped(path: Path, place: int) -> None:
    content = bytearray(path.read_bytes())
    content[place] ^= 16
    path.write_bytes(content)


def test_damaged_state_is_not_carried_on(run, scene_text, tmp_path: Path) -> None:
    """Wherever the damage is, it is refused with a sentence, or it stands where nothing is read."""
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    assert run("--output", "whole", "--set", "solver.periods=9", "scene.nml", cwd=tmp_path).returncode == 0
    whole = digest(tmp_path / "whole" / "scene.rattle")
    state = tmp_path / "results" / "scene.state"
    sound, series = state.read_bytes(), (tmp_path / "results" / "scene.rattle").read_bytes()
    harmless = 0
    for place in range(5, len(sound), 37):
        flipped(state, place)
        ended = run("--resume", "--set", "solver.periods=9", "scene.nml", cwd=tmp_path)
        if ended.returncode == 0:
            harmless += 1
            assert digest(tmp_path / "results" / "scene.rattle") == whole
            (tmp_path / "results" / "scene.rattle").write_bytes(series)
        else:
            assert ended.returncode == 2 and "results/scene.state" in ended.stderr
        state.write_bytes(sound)
    assert harmless < 8


def test_damaged_series_is_not_carried_on(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    series = tmp_path / "results" / "scene.rattle"
    flipped(series, -1000)
    before = contents(tmp_path)
    ended = run("--resume", "--set", "solver.periods=9", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert "results/scene.rattle is damaged: rows 1 to 97 are not what their checksum says" in ended.stderr
    assert contents(tmp_path) == before


def test_damaged_summary_is_reported(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    path = tmp_path / "results" / "scene.summary.nml"
    sound = path.read_bytes()
    assert package.read_summary(path)["status"] == "complete"
    for place in range(0, sound.index(b"! checksum"), 29):
        flipped(path, place)
        with pytest.raises(package.SummaryError):
            package.read_summary(path)
        path.write_bytes(sound)


def test_half_of_a_seal_covers_nothing(run, scene_text, tmp_path: Path) -> None:
    """The disk was full while the checksums of a series in progress went there: its rows can be read."""
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    path = tmp_path / "results" / "scene.rattle"
    rows = package.read(path)["acceleration"].tolist()
    content = path.read_bytes()
    head = content[:24] + (-1).to_bytes(8, "little", signed=True) + content[32:100]
    path.write_bytes(head + bytes(20) + content[120:])
    assert package.read(path)["acceleration"].tolist()[: len(rows)] == rows
    ended = run("--resume", "--set", "solver.periods=9", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2 and "scene.rattle holds 0 rows, fewer than the 33" in ended.stderr


@pytest.mark.parametrize("kind", ["state", "rattle"])
def test_files_of_another_version_are_not_carried_on(kind: str, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    path = tmp_path / "results" / f"scene.{kind}"
    content = path.read_bytes()
    path.write_bytes(resealed(content[:40] + b"9.8.7".ljust(24) + content[64:]))
    before = contents(tmp_path)
    ended = run("--resume", "--set", "solver.periods=9", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert f"results/scene.{kind} was written by version 9.8.7 of rattle, this is " in ended.stderr
    assert "--overwrite instead of --resume" in ended.stderr
    assert contents(tmp_path) == before


# --- campaigns -------------------------------------------------------------------------------------------


def table_campaign(scene_text, folder: Path) -> None:
    (folder / "scene.nml").write_text(scene_text(**BASE, campaign={"csv": "'table.csv'"}))
    (folder / "table.csv").write_text("load.mass,load.frequency\n3.0,600\n3.0,700\n2.0,600\n")


@pytest.mark.parametrize("change", [("2.0", "2.5"), ("\n2.0,600", ""), ("load.mass", "load.steady_force")])
def test_changed_table_is_refused(change: tuple[str, str], run, scene_text, tmp_path: Path) -> None:
    table_campaign(scene_text, tmp_path)
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    before = digest(tmp_path / "results" / "scene.rattle")
    table = tmp_path / "table.csv"
    table.write_text(table.read_text().replace(*change))
    ended = run("--resume", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert "results/scene.rattle was begun with other " in ended.stderr
    assert "--overwrite begins anew" in ended.stderr
    assert digest(tmp_path / "results" / "scene.rattle") == before
    assert run("--overwrite", "scene.nml", cwd=tmp_path).returncode == 0


def test_table_written_in_other_words_is_the_same(run, scene_text, tmp_path: Path) -> None:
    """What counts are the numbers."""
    table_campaign(scene_text, tmp_path)
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    (tmp_path / "table.csv").write_text('"load.mass","load.frequency"\r\n3,6e2\r\n3.0,700\r\n2.0,600')
    assert run("--resume", "scene.nml", cwd=tmp_path).returncode == 0


@pytest.mark.parametrize(
    "options", [[], ["--resume"], ["--overwrite"]], ids=lambda words: "".join(words) or "plain"
)
@pytest.mark.parametrize("kind", ["rattle", "log", "summary.nml", "progress.nml", "lock"])
def test_campaign_leaves_foreign_files(
    kind: str, options: list[str], refused, scene_text, tmp_path: Path
) -> None:
    """Even its own input or table, if it has such a name; the fixture compares the contents."""
    (tmp_path / "scene.nml").write_text(grid(scene_text, 3, 3))
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / f"scene.{kind}").write_text("my notes\n")
    faults = refused(*options, "scene.nml")
    expected = f"results/scene.{kind} exists and was not written by rattle; it is never replaced"
    assert faults == [f"scene.nml: &output: {expected}"]


@pytest.mark.parametrize("kind", ["rattle", "log", "summary.nml", "progress.nml"])
def test_campaign_replaces_its_files_only_if_asked(
    kind: str, refused, run, scene_text, tmp_path: Path
) -> None:
    (tmp_path / "scene.nml").write_text(grid(scene_text, 3, 3))
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    for other in ("rattle", "log", "summary.nml", "progress.nml"):
        if other != kind:
            (tmp_path / "results" / f"scene.{other}").unlink()
    expected = f"results/scene.{kind} exists; --resume continues it, --overwrite replaces it"
    assert refused("scene.nml") == [f"scene.nml: &output overwrite: {expected}"]
    # A summary alone shows nothing of its input, which might be another.
    option = "--overwrite" if kind == "summary.nml" else "--resume"
    assert run(option, "scene.nml", cwd=tmp_path).returncode == 0
