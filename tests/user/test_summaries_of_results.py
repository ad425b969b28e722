"""A summary knows its result: readers refuse one that stands beside the result of another run."""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path

import f90nml
import pytest
from outcomes import contents
from script_calls import call_script
from test_edited_inputs import GEARBOX, TASKS

import rattle as package

KINDS = ("summary.nml", "rattle", "state", "profiles.rattle")


@pytest.fixture
def two_runs(run, scene_text, tmp_path: Path):
    """Two runs of a task that differ in a key, in folders of their own: the folders."""

    def call(task: str, **changes: dict) -> tuple[Path, Path]:
        for folder, given in (("one", {}), ("two", changes or {"lubricant": {"viscosity": "0.25"}})):
            (tmp_path / "scene.nml").write_text(TASKS[task](scene_text, **given))
            assert run("--quiet", "--output", folder, "scene.nml", cwd=tmp_path).returncode == 0
        return tmp_path / "one", tmp_path / "two"

    return call


def exchange(one: Path, two: Path, name: str) -> None:
    """Put a file of the second run among those of the first."""
    (one / name).write_bytes((two / name).read_bytes())


@pytest.mark.parametrize("task", TASKS)
def test_a_summary_beside_another_result_is_refused(task: str, two_runs) -> None:
    one, two = two_runs(task)
    path = one / "scene.summary.nml"
    assert package.read_summary(path)["status"] == "complete"
    exchange(one, two, "scene.rattle")
    with pytest.raises(package.SummaryError, match=r"does not belong to .*scene\.rattle beside it"):
        package.read_summary(path)
    # Where nothing stands beside it there is nothing to compare it with.
    (one / "scene.rattle").unlink()
    assert package.read_summary(path)["status"] == "complete"
    exchange(one, two, "scene.rattle")
    exchange(one, two, "scene.summary.nml")
    if task == "film":
        with pytest.raises(
            package.SummaryError, match=r"does not belong to .*scene\.profiles\.rattle beside"
        ):
            package.read_summary(path)
        exchange(one, two, "scene.profiles.rattle")
    assert package.read_summary(path)["status"] == "complete"


def test_one_row_makes_another_result(two_runs) -> None:
    """The head of the file knows every byte of the rows."""
    one, _ = two_runs("motion")
    path = one / "scene.rattle"
    content = path.read_bytes()
    for place in (24, 85, 100, 110):
        path.write_bytes(content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :])
        with pytest.raises(package.SummaryError):
            package.read_summary(one / "scene.summary.nml")


def test_a_summary_of_a_run_without_a_series_says_so(two_runs, tmp_path: Path) -> None:
    one, two = two_runs("motion", output={"series": ".false."})
    assert package.read_summary(two / "scene.summary.nml")["result_checksum"] == 0
    exchange(two, one, "scene.rattle")
    with pytest.raises(package.SummaryError, match="its run left no result"):
        package.read_summary(two / "scene.summary.nml")


@pytest.mark.parametrize(
    "script",
    [
        ["compare.py", "RESULT"],
        ["compare.py", "SUMMARY"],
        ["report.py", "RESULT", "--output", "page.html"],
        ["classify.py", "RESULT"],
        ["plot.py", "motion", "RESULT", "--figures", "8"],
        ["plot.py", "regime-map", "RESULT"],
        ["export.py", "RESULT", "--output", "series.csv"],
    ],
    ids=lambda words: "-".join(words[:2]),
)
def test_every_script_says_so(script: list[str], two_runs, tmp_path: Path) -> None:
    one, two = two_runs("motion")
    exchange(one, two, "scene.summary.nml")
    named = {"RESULT": one / "scene.rattle", "SUMMARY": one / "scene.summary.nml"}
    ended = call_script(script[0], *(named.get(word, word) for word in script[1:]), cwd=tmp_path)
    assert "scene.summary.nml does not belong to " in ended.stderr
    needs_it = script[0] in ("compare.py", "report.py") or script[1] == "regime-map"
    assert ended.returncode == 2 or not needs_it


def test_scripts_of_campaigns_say_so(two_runs, tmp_path: Path) -> None:
    one, two = two_runs("campaign")
    exchange(one, two, "scene.summary.nml")
    for script in (
        ["campaign.py", "export", one / "scene.rattle", "--to", "csv", "--output", "rows.csv"],
        ["plot.py", "campaign", one / "scene.rattle"],
    ):
        ended = call_script(*script, cwd=tmp_path)
        assert "scene.summary.nml does not belong to " in ended.stderr


def test_profiles_beside_another_table_are_refused(two_runs, tmp_path: Path) -> None:
    """Also where a kill has left no summary."""
    one, two = two_runs("film")
    exchange(one, two, "scene.profiles.rattle")
    (one / "scene.summary.nml").unlink()
    ended = call_script("plot.py", "film", one / "scene.rattle", cwd=tmp_path)
    assert ended.returncode == 2
    assert "scene.profiles.rattle does not belong to" in ended.stderr


def test_a_table_of_other_pairs_is_refused(run, tmp_path: Path) -> None:
    (tmp_path / "box.nml").write_text(GEARBOX)
    for folder, setting in (("one", "shaft.speed_rpm=800"), ("two", "shaft.speed_rpm=820")):
        ended = run("--quiet", "--output", folder, "--set", setting, "box.nml", cwd=tmp_path)
        assert ended.returncode == 0
    one, two = tmp_path / "one", tmp_path / "two"
    assert set(package.read_summary(one / "box.summary.nml")["gears"]) == {"1st", "4th"}
    for kind in ("rattle", "summary.nml"):
        exchange(one, two, f"box.4th.{kind}")
    with pytest.raises(
        package.SummaryError, match=r"box\.summary\.nml does not belong to .*box\.4th\.summary"
    ):
        package.read_summary(one / "box.summary.nml")
    ended = call_script(
        "report.py", one / "box.1st.rattle", one / "box.4th.rattle", "--output", "page.html", cwd=tmp_path
    )
    assert ended.returncode == 2 and "box.summary.nml does not belong to" in ended.stderr


def test_a_table_of_some_pairs_does_not_look_whole(rattle: Path, run, tmp_path: Path, shim: Path) -> None:
    """A signal comes when the first pair is complete and the second has not begun."""
    (tmp_path / "box.nml").write_text(GEARBOX)
    command = [rattle, "--quiet", "--threads", "1", "box.nml"]
    environment = {"LD_PRELOAD": shim, "FAULT_FOLDER": "results/", "FAULT_KIND": "none"}
    trace = tmp_path / "trace"
    subprocess.run(command, cwd=tmp_path, env={**environment, "FAULT_TRACE": trace}, check=True)
    assert f90nml.read(tmp_path / "results" / "box.summary.nml")["summary"]["status"] == "complete"
    at = trace.read_text().splitlines().index("close box.1st.log") + 1
    environment |= {"FAULT_KIND": "signal", "FAULT_SIGNAL": "15", "FAULT_AT": str(at)}
    ended = subprocess.run([*command, "--overwrite"], cwd=tmp_path, env=environment, check=False)
    assert ended.returncode == 128 + signal.SIGTERM
    table = f90nml.read(tmp_path / "results" / "box.summary.nml")["summary"]
    assert (table["status"], table["pairs"]) == ("interrupted", 2)
    assert run("--resume", "box.nml", cwd=tmp_path).returncode == 0
    table = f90nml.read(tmp_path / "results" / "box.summary.nml")["summary"]
    assert (table["status"], table["pairs"]) == ("complete", 2)


# --- kills between the renames ---------------------------------------------------------------------------


@pytest.mark.parametrize("option", ["--overwrite", "--resume"])
@pytest.mark.parametrize("task", TASKS)
def test_a_kill_at_any_call_leaves_no_foreign_summary(
    task: str,
    option: str,
    shim: Path,
    rattle: Path,
    run,
    scene_text,
    tmp_path: Path,
) -> None:
    """Whatever call of an overwriting run is its last: a summary beside a result is that of this result."""
    changes = {"lubricant": {"viscosity": "0.25"}} if option == "--overwrite" else {}
    (tmp_path / "scene.nml").write_text(TASKS[task](scene_text))
    assert run("--quiet", "--threads", "1", "scene.nml", cwd=tmp_path).returncode == 0
    results = tmp_path / "results"
    before = {path.name: path.read_bytes() for path in results.iterdir()}
    (tmp_path / "scene.nml").write_text(TASKS[task](scene_text, **changes))
    trace = tmp_path / "trace"

    def meet(kind: str, at: int) -> int:
        environment = {
            "LD_PRELOAD": shim,
            "FAULT_FOLDER": "results/",
            "FAULT_KIND": kind,
            "FAULT_AT": str(at),
        }
        environment["FAULT_TRACE"] = trace if kind == "none" else "/dev/null"
        command = [rattle, "--quiet", "--threads", "1", option, "scene.nml"]
        return subprocess.run(command, cwd=tmp_path, env=environment, check=False).returncode

    assert meet("none", 0) == 0
    calls = trace.read_text().splitlines()
    renames = [number for number, call in enumerate(calls, 1) if call.startswith("rename")]
    assert len(renames) >= 2
    for number in sorted(
        {near for place in renames for near in (place, place + 1)} & set(range(len(calls) + 1))
    ):
        for path in results.iterdir():
            path.unlink()
        for name, content in before.items():
            (results / name).write_bytes(content)
        assert meet("kill", number) == -signal.SIGKILL, calls[number - 1]
        if (results / "scene.summary.nml").exists():
            package.read_summary(results / "scene.summary.nml")
        assert run("--quiet", "--overwrite", "scene.nml", cwd=tmp_path).returncode == 0
        assert package.read_summary(results / "scene.summary.nml")["status"] == "complete"


def test_an_overwriting_gearbox_takes_the_table_away_first(
    rattle: Path, run, tmp_path: Path, shim: Path
) -> None:
    """A kill once the first pair is in its place leaves no table of the earlier pairs."""
    (tmp_path / "box.nml").write_text(GEARBOX)
    assert run("--quiet", "box.nml", cwd=tmp_path).returncode == 0
    command = [rattle, "--quiet", "--threads", "1", "--overwrite", "--set", "shaft.speed_rpm=820", "box.nml"]
    environment = {"LD_PRELOAD": shim, "FAULT_FOLDER": "results/", "FAULT_KIND": "none"}
    trace = tmp_path / "trace"
    subprocess.run(command, cwd=tmp_path, env={**environment, "FAULT_TRACE": trace}, check=True)
    placed = trace.read_text().splitlines().index("rename box.1st.summary.nml") + 1
    assert run("--quiet", "--overwrite", "box.nml", cwd=tmp_path).returncode == 0
    environment |= {"FAULT_KIND": "kill", "FAULT_AT": str(placed + 1)}
    assert subprocess.run(command, cwd=tmp_path, env=environment, check=False).returncode == -signal.SIGKILL
    assert not (tmp_path / "results" / "box.summary.nml").exists()
    assert package.read_summary(tmp_path / "results" / "box.1st.summary.nml")["status"] in (
        "complete",
        "steady",
    )
    assert run("--resume", "--set", "shaft.speed_rpm=820", "box.nml", cwd=tmp_path).returncode == 2
    ended = run("--quiet", "--overwrite", "--set", "shaft.speed_rpm=820", "box.nml", cwd=tmp_path)
    assert ended.returncode == 0
    assert len(package.read_summary(tmp_path / "results" / "box.summary.nml")["gears"]) == 2


def test_a_run_that_fails_brings_the_summary_back(
    rattle: Path, run, scene_text, tmp_path: Path, shim: Path
) -> None:
    """The first file cannot be put in its place: all stay, and belong together."""
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 0
    command = [rattle, "--quiet", "--threads", "1", "--overwrite", "--set", "load.mass=2.0", "scene.nml"]
    environment = {"LD_PRELOAD": shim, "FAULT_FOLDER": "results/", "FAULT_KIND": "none"}
    trace = tmp_path / "trace"
    (tmp_path / "kept").mkdir()
    before = contents(tmp_path / "results")
    subprocess.run(command, cwd=tmp_path, env={**environment, "FAULT_TRACE": trace}, check=True)
    at = trace.read_text().splitlines().index("rename scene.rattle") + 1
    for name, content in before.items():
        (tmp_path / "results" / name).write_bytes(content)
    environment |= {"FAULT_KIND": "error", "FAULT_AT": str(at)}
    assert subprocess.run(command, cwd=tmp_path, env=environment, check=False).returncode == 3
    after = contents(tmp_path / "results")
    before.pop("scene.log"), after.pop("scene.log")
    assert after == before
