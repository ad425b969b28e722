"""Thresholds as an array job: parts of the traces, joined into the file of one undivided run."""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from outcomes import contents, summary_of
from result_writer import result_bytes
from script_calls import call_script
from test_thresholds import LONG, MANY_LINES, SPEEDS, cut_short, threshold_text

import rattle as package
from rattle.checksums import checksum
from rattle.merge import _chunks
from rattle.result_header import SERIES

COARSE = {"tolerance": "1e-2"}
# No class is verified by errors of rounding alone, so that there are uncertain crossings.
STRICT = {"verification_tolerance": "1e-12"}


def part_of(part: int, parts: int) -> list[str]:
    return ["--set", f"campaign.part={part}", "--set", f"campaign.parts={parts}"]


def path_of(folder: Path, part: int, parts: int) -> Path:
    return folder / "results" / f"scene.part-{part}-of-{parts}.rattle"


@pytest.fixture
def solve(run, tmp_path: Path):
    """Find thresholds, or a part of them; return the file."""

    def call(*options: object, parts: tuple[int, int] | None = None) -> Path:
        chosen = part_of(*parts) if parts else []
        ended = run("--overwrite", *chosen, *options, "scene.nml", cwd=tmp_path, timeout=600.0)
        assert ended.returncode == 0, ended.stderr
        return path_of(tmp_path, *parts) if parts else tmp_path / "results" / "scene.rattle"

    return call


def merge(directory: Path, *parts: Path) -> subprocess.CompletedProcess[str]:
    return call_script("campaign.py", "merge", *parts, "--output", "joined.rattle", cwd=directory)


def refusal(directory: Path, *parts: Path) -> str:
    """What is said of parts that cannot be joined; nothing may have been written."""
    before = contents(directory)
    done = merge(directory, *parts)
    assert done.returncode == 2 and "Traceback" not in done.stderr
    assert contents(directory) == before
    return done.stderr


@pytest.mark.parametrize("parts", [2, 5])
def test_joined_parts_are_the_undivided_run(parts: int, solve, scene_text, tmp_path: Path) -> None:
    """Also where some parts have no trace; the traces of all parts are counted from the first of all."""
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text, threshold=COARSE, spectrum=STRICT))
    whole = solve()
    paths = [solve(parts=(part, parts)) for part in range(1, parts + 1)]
    held = [np.unique(package.read(path)["trace"]).tolist() for path in paths]
    assert held == ([[1.0], [2.0, 3.0]] if parts == 2 else [[], [1.0], [], [2.0], [3.0]])
    done = merge(tmp_path, *reversed(paths))
    assert (done.returncode, done.stdout) == (0, "joined.rattle\n"), done.stderr
    assert done.stderr == f"campaign.py: {parts} parts joined, 3 traces.\n"
    assert (tmp_path / "joined.rattle").read_bytes() == whole.read_bytes()
    reported = [summary_of(path.with_suffix(".summary.nml")) for path in (*paths, whole)]
    for name in ("traces", "crossings", "crossings_uncertain", "scenes"):
        assert sum(one[name] for one in reported[:-1]) == reported[-1][name] > 0, name


def test_parts_that_do_not_belong_together(solve, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text, threshold=COARSE))
    first, second, third = (solve(parts=(part, 3)) for part in (1, 2, 3))
    said = refusal(tmp_path, first, third)
    assert f"  traces 2 to 2 are missing between {first} and {third}.\n" in said
    assert "  of 3 parts these are not given: 2.\n" in said
    assert f"traces 3 to 3 are missing after {second}." in refusal(tmp_path, first, second)
    assert f"traces 2 to 2 of {second} are also in {second}." in refusal(
        tmp_path, first, second, second, third
    )
    assert "belong to different divisions: into 2 and 3 parts." in refusal(
        tmp_path, first, second, solve(parts=(2, 2))
    )
    solve("--set", "threshold.last=400.0", parts=(2, 3))
    assert "threshold.last is 400.0 in one, 455.0 in the other." in refusal(tmp_path, first, second, third)


def test_parts_of_two_states_of_a_table(solve, scene_text, tmp_path: Path) -> None:
    """Parts of traces from a CSV file that has changed in between are no whole."""
    lines = "kinematics.entrainment_speed\n0.8\n1.9\n9.5\n"
    (tmp_path / "traces.csv").write_text(lines)
    table = {"csv": "'traces.csv'"}
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text, campaign=table, threshold=COARSE))
    whole, first, second = solve(), solve(parts=(1, 2)), solve(parts=(2, 2))
    assert merge(tmp_path, first, second).returncode == 0
    assert (tmp_path / "joined.rattle").read_bytes() == whole.read_bytes()
    (tmp_path / "joined.rattle").unlink()
    (tmp_path / "traces.csv").write_text(lines.replace("0.8", "0.9"))
    solve(parts=(2, 2))
    said = refusal(tmp_path, first, second)
    assert "come from different traces: their CSV file has changed in between." in said


def test_a_part_is_carried_on(rattle, run, solve, scene_text, tmp_path: Path) -> None:
    """It has a state of its own, and ends as the part that was never cut."""
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text, campaign=MANY_LINES, threshold=LONG))
    expected = solve(parts=(2, 2)).read_bytes()
    path_of(tmp_path, 2, 2).unlink()
    state = path_of(tmp_path, 2, 2).with_suffix(".state")
    for share in (1.0, 2.0, 0.5, 4.0, 0.25):
        chosen = part_of(2, 2)
        code = cut_short(rattle, tmp_path, signal.SIGTERM, 0.1 * share, *chosen, name="scene.part-2-of-2")
        if code == 128 + signal.SIGTERM and state.exists():
            break
    else:
        raise AssertionError("the run could not be cut between two traces")
    ended = run("--resume", *part_of(1, 2), "scene.nml", cwd=tmp_path, timeout=600.0)
    assert "all is solved from the start" in ended.stdout
    ended = run("--resume", *part_of(2, 2), "scene.nml", cwd=tmp_path, timeout=600.0)
    assert ended.returncode == 0 and "traces of the earlier run" in ended.stdout, ended.stderr
    assert path_of(tmp_path, 2, 2).read_bytes() == expected
    assert not state.exists()


def test_wrong_parts_and_what_check_tells(run, refused, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text, campaign=SPEEDS))
    assert "campaign part: at most parts (3)" in refused(*part_of(4, 3), "scene.nml")[0]
    reported = run("--check", *part_of(2, 2), "scene.nml", cwd=tmp_path).stdout
    assert "! traces              2\n! scenes of the scan  34\n" in reported
    reported = run("--check", *part_of(1, 5), "scene.nml", cwd=tmp_path).stdout
    assert "! traces              0\n" in reported


def test_a_job_script_takes_thresholds_as_an_array(scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(threshold_text(scene_text))
    done = call_script("campaign.py", "slurm", "scene.nml", "--array", 3, "--program", "/x", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "join scene.part-1-of-3.rattle to scene.part-3-of-3.rattle" in done.stderr
    assert "--set campaign.parts=3 scene.nml" in (tmp_path / "scene.slurm").read_text()


def test_rows_of_several_chunks_are_joined(tmp_path: Path) -> None:
    """So many rows that the joined file has a checksum for each of two runs of them, and none is left."""
    columns = [("trace", "-"), *((f"column_{i}", "-") for i in range(11))]
    text = "&scene\n   task = 'threshold'\n/\n&campaign\n   part = {}\n   parts = {}\n/\n"
    size = 524_288 // 12
    rows = np.random.default_rng(1).random((2 * size, 12))
    rows[:, 0] = np.arange(2 * size) // 2 + 1
    for part, share in ((1, rows[:50_000]), (2, rows[50_000:])):
        content = result_bytes(columns, share, input_text=text.format(part, 2), chunk_rows=size)
        (tmp_path / f"{part}.rattle").write_bytes(content)
    done = merge(tmp_path, tmp_path / "1.rattle", tmp_path / "2.rattle")
    assert done.returncode == 0, done.stderr
    expected = result_bytes(columns, rows, input_text=text.format(1, 1), chunk_rows=size)
    assert (tmp_path / "joined.rattle").read_bytes() == expected


class Rows:
    """A part of thresholds as far as checksums ask for it: rows of two columns."""

    names = ("first", "second")

    def __init__(self, table: np.ndarray) -> None:
        self.table, self.row_count = table, len(table)
        self.header = SimpleNamespace(chunks=SimpleNamespace(kind=SERIES))

    def __getitem__(self, name: str) -> np.ndarray:
        return self.table[:, self.names.index(name)]


@pytest.mark.parametrize("rows", [1, 2, 3, 4])
def test_the_seal_has_the_checksum_of_a_chunk_that_is_not_full_alone(rows: int, monkeypatch) -> None:
    """As the program seals its series: whole chunks, here of two rows, have their checksums in the table."""
    monkeypatch.setattr("rattle.merge.series_chunk_rows", lambda *_: 2)
    table = np.arange(2.0 * rows).reshape(rows, 2)
    reported, seal = _chunks([Rows(table)])
    assert seal.rows == rows
    assert seal.rest_checksum == (checksum(table[-1:]) if rows % 2 else 0)
    whole = [checksum(table[start : start + 2]) for start in range(0, rows - 1, 2)]
    assert list(reported.checksums) == whole + [0] * (rows % 2)
