"""Where the files go: taken away during the run, links in the way, no locks, signals of batch systems."""

from __future__ import annotations

import errno
import os
import resource
import shutil
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from outcomes import contents, summary_of
from test_edited_inputs import GEARBOX, TASKS
from waiting import PATIENCE, until

import rattle as package

BOX = GEARBOX + "&scene name = 'scene' /\n"
SLOWER_BOX = BOX.replace("speed_rpm = 800.0", "speed_rpm = 700.0")


@pytest.fixture
def begun(rattle: Path, tmp_path: Path):
    """Begin a run that some call holds up for a second, and do something meanwhile: its end and its words."""

    def call(
        text: str, shim: Path, at: str, meanwhile: Callable[[], None], *options: str
    ) -> subprocess.CompletedProcess[str]:
        (tmp_path / "scene.nml").write_text(text)
        command = [rattle, "--quiet", "--threads", "1", *options, "scene.nml"]
        environment = {**os.environ, "LD_PRELOAD": str(shim), "FAULT_FOLDER": "results/", "FAULT_WAIT": at}
        process = subprocess.Popen(
            command, cwd=tmp_path, env=environment, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        waiting = tmp_path / "results" / "waiting"
        until(waiting.exists, process)
        meanwhile()
        waiting.unlink(missing_ok=True)
        out, words = process.communicate(timeout=PATIENCE)
        return subprocess.CompletedProcess(command, process.returncode, out, words)

    return call


# The call before which the files are taken away: the first file that is written to its end.
HELD = {
    "motion": "fsync scene.state.new",
    "sweep": "fsync scene.summary.nml.new",
    "film": "fsync scene.summary.nml.new",
    "threshold": "fsync scene.summary.nml.new",
    "campaign": "pwrite scene.rattle",
}


@pytest.mark.parametrize("what", ["result", "folder", "folder, made again"])
@pytest.mark.parametrize("task", TASKS)
def test_files_that_are_taken_away_are_missed(
    task: str, what: str, begun, run, shim: Path, scene_text, tmp_path: Path
) -> None:
    """The end is no success, and a sentence says why; the next run mends all."""
    results = tmp_path / "results"

    def meanwhile() -> None:
        if what == "result":
            for path in [*results.glob("*.rattle"), *results.glob("*.rattle.*.new")]:
                path.unlink()
        else:
            results.rename(tmp_path / "gone")
        if what.endswith("again"):
            results.mkdir()

    text = TASKS[task](scene_text)
    ended = begun(text, shim, HELD[task], meanwhile)
    assert ended.returncode == 3, ended
    assert "results/scene" in ended.stderr and "cannot be written" in ended.stderr, ended.stderr
    summary = results / "scene.summary.nml"
    assert not summary.exists() or summary_of(summary)["status"] == "not_written"
    assert run("--resume", "scene.nml", cwd=tmp_path).returncode == 0
    assert package.read(results / "scene.rattle").closed
    assert package.read_summary(summary)["status"] in ("complete", "steady")


def test_pairs_that_are_taken_away_are_missed(begun, run, shim: Path, tmp_path: Path) -> None:
    """The first pair is complete when the folder goes; the second says so."""
    ended = begun(
        BOX, shim, "fsync scene.4th.state.new", lambda: (tmp_path / "results").rename(tmp_path / "gone")
    )
    assert ended.returncode == 3
    assert "results/scene.4th" in ended.stderr and "cannot be written" in ended.stderr


def test_a_log_that_is_taken_away_is_missed(begun, shim: Path, scene_text, tmp_path: Path) -> None:
    ended = begun(scene_text(), shim, "fsync scene.state.new", (tmp_path / "results" / "scene.log").unlink)
    assert ended.returncode == 3
    assert "results/scene.log could not be written" in ended.stderr and "the file removed" in ended.stderr


# --- links -----------------------------------------------------------------------------------------------

NAMES = {
    "motion": ("rattle", "state", "summary.nml", "log", "lock"),
    "sweep": ("rattle", "summary.nml", "log", "lock"),
    "film": ("rattle", "profiles.rattle", "summary.nml", "log", "lock"),
    "threshold": ("rattle", "state", "summary.nml", "progress.nml", "log", "lock"),
    "campaign": ("rattle", "summary.nml", "progress.nml", "log", "lock"),
}


@pytest.mark.parametrize("target", ["nothing", "a file of the same kind", "a foreign file", "a folder"])
@pytest.mark.parametrize("task", TASKS)
def test_links_are_neither_followed_nor_replaced(
    task: str, target: str, run, scene_text, tmp_path: Path
) -> None:
    """Whatever option is given; what they lead to is neither made nor changed."""
    (tmp_path / "scene.nml").write_text(TASKS[task](scene_text))
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 0
    results, elsewhere = tmp_path / "results", tmp_path / "elsewhere"
    elsewhere.mkdir()
    for kind in NAMES[task]:
        name = f"scene.{kind}"
        shutil.rmtree(results)
        results.mkdir()
        place = elsewhere / name
        if target == "a file of the same kind":
            assert (
                run("--quiet", "--output", "elsewhere", "scene.nml", "--overwrite", cwd=tmp_path).returncode
                == 0
            )
        elif target == "a foreign file":
            place.write_text("my notes\n")
        elif target == "a folder":
            place.unlink(missing_ok=True)
            place.mkdir(exist_ok=True)
        else:
            place.unlink(missing_ok=True)
        (results / name).symlink_to(place)
        before = contents(tmp_path)
        for options in ([], ["--resume"], ["--overwrite"]):
            ended = run(*options, "scene.nml", cwd=tmp_path)
            assert ended.returncode == 2, (name, options)
            assert f"results/{name} is a link, which rattle did not make" in ended.stderr
            assert contents(tmp_path) == before


def test_files_beside_their_places_have_new_names(
    shim: Path, rattle: Path, run, scene_text, tmp_path: Path
) -> None:
    """No two runs call them alike, and links at the names of earlier versions are left alone."""
    (tmp_path / "scene.nml").write_text(scene_text())
    results = tmp_path / "results"
    results.mkdir()
    for kind in ("rattle", "state", "summary.nml"):
        (results / f"scene.{kind}.new").symlink_to(tmp_path / f"made.{kind}")
    seen = set()
    for number in range(3):
        folder, trace = tmp_path / f"killed{number}", tmp_path / f"trace{number}"
        environment = {"LD_PRELOAD": shim, "FAULT_FOLDER": folder.name, "FAULT_TRACE": trace}
        command = [rattle, "--quiet", "--output", folder, "--overwrite", "scene.nml"]
        subprocess.run(command, cwd=tmp_path, check=True)
        # The calls of a run that replaces files are not those of the first one.
        subprocess.run(command, cwd=tmp_path, env=environment, check=True)
        at = trace.read_text().splitlines().index("fsync scene.state.new") + 1
        environment |= {"FAULT_KIND": "kill", "FAULT_AT": str(at)}
        subprocess.run(command, cwd=tmp_path, env=environment, check=False)
        names = {path.name for path in folder.glob("*.new")}
        assert names and not names & seen
        seen |= names
    assert run("--overwrite", "scene.nml", cwd=tmp_path).returncode == 0
    assert not list(tmp_path.glob("made.*"))
    assert len(list(results.glob("*.new"))) == 3


def test_a_hard_link_to_a_log_keeps_its_other_name(run, scene_text, tmp_path: Path) -> None:
    """A log is made anew, not written into."""
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    os.link(tmp_path / "results" / "scene.log", tmp_path / "kept.log")
    before = (tmp_path / "kept.log").read_bytes()
    assert run("--overwrite", "--set", "load.mass=2.0", "scene.nml", cwd=tmp_path).returncode == 0
    assert (tmp_path / "kept.log").read_bytes() == before
    assert (tmp_path / "results" / "scene.log").read_bytes() != before


def test_leftovers_of_killed_runs_go_and_foreign_ones_stay(run, scene_text, tmp_path: Path) -> None:
    """Those of other scenes in the folder stay too, be their runs at work."""
    (tmp_path / "scene.nml").write_text(scene_text())
    results = tmp_path / "results"
    results.mkdir()
    word = "0123456789abcdef"
    gone = {
        f"scene.rattle.{word}.new": b"RATT",
        f"scene.state.{word}.new": b"",
        f"scene.summary.nml.{word}.old": b"&summary\n",
    }
    kept = {
        f"scene.rattle.{word[::-1]}.new": b"my notes\n",
        f"scene.rattle.{word}.bak": b"",
        f"scene.2.rattle.{word}.new": b"RATTLE\r\n",
        "scene.rattle.new": b"",
        f"scene.rattle.{word[:-1]}.new": b"",
    }
    for name, content in {**gone, **kept}.items():
        (results / name).write_bytes(content)
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    assert not any((results / name).exists() for name in gone)
    assert all((results / name).read_bytes() == content for name, content in kept.items())


# --- locks -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("task", TASKS)
def test_every_task_warns_where_there_are_no_locks(
    task: str, shim: Path, rattle: Path, scene_text, tmp_path: Path
) -> None:
    (tmp_path / "scene.nml").write_text(TASKS[task](scene_text))
    environment = {**os.environ, "LD_PRELOAD": str(shim), "FAULT_FLOCK": str(errno.ENOLCK)}
    ended = subprocess.run(
        [rattle, "scene.nml"], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, ended.stderr
    words = "this file system has no locks (No locks available); see that no other run writes here\n"
    assert words in ended.stdout
    assert f"  warning: {words}" in (tmp_path / "results" / "scene.log").read_text()
    assert not (tmp_path / "results" / "scene.lock").exists()


@pytest.mark.parametrize("cause", [errno.EIO, errno.EINVAL, errno.EACCES])
def test_other_errors_of_a_lock_are_named(
    cause: int, shim: Path, rattle: Path, scene_text, tmp_path: Path
) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    environment = {**os.environ, "LD_PRELOAD": str(shim), "FAULT_FLOCK": str(cause)}
    ended = subprocess.run(
        [rattle, "scene.nml"], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 3
    assert ended.stderr == f"results/scene.lock cannot be locked: {os.strerror(cause)}\n"


@pytest.mark.parametrize("task", TASKS)
def test_of_two_runs_without_locks_the_later_one_wins(
    task: str, begun, shim: Path, rattle: Path, run, scene_text, tmp_path: Path
) -> None:
    """The first one says so and keeps nothing; series and summary are those of one run."""
    command = [
        rattle,
        "--quiet",
        "--threads",
        "1",
        "--overwrite",
        "--set",
        "lubricant.viscosity=0.25",
        "scene.nml",
    ]
    unlocked = {**os.environ, "LD_PRELOAD": str(shim), "FAULT_FLOCK": str(errno.ENOLCK)}
    second: list[subprocess.Popen] = []

    def meanwhile() -> None:
        second.append(subprocess.Popen(command, cwd=tmp_path, env=unlocked, stderr=subprocess.DEVNULL))
        assert second[0].wait(60) == 0

    os.environ["FAULT_FLOCK"] = str(errno.ENOLCK)
    try:
        ended = begun(TASKS[task](scene_text), shim, HELD[task], meanwhile)
    finally:
        del os.environ["FAULT_FLOCK"]
    assert ended.returncode == 3, ended
    assert "results/scene" in ended.stderr
    results = tmp_path / "results"
    assert package.read_summary(results / "scene.summary.nml")["status"] == "complete"
    assert "viscosity = 0.25" in package.read(results / "scene.rattle").input_text


@pytest.fixture
def stopped(rattle: Path, shim: Path, tmp_path: Path):
    """Begin a run without locks that stops before the first of some calls, until SIGCONT comes."""
    begun_here: list[subprocess.Popen] = []

    def call(text: str, at: str) -> subprocess.Popen:
        (tmp_path / "scene.nml").write_text(text)
        command = [rattle, "--quiet", "--threads", "1", "scene.nml"]
        trace = tmp_path / "trace"
        known = {**os.environ, "LD_PRELOAD": str(shim), "FAULT_FOLDER": "results/"}
        known |= {"FAULT_FLOCK": str(errno.ENOLCK), "FAULT_TRACE": str(trace), "FAULT_KIND": "none"}
        subprocess.run(command, cwd=tmp_path, env=known, check=True)
        shutil.rmtree(tmp_path / "results")
        known |= {"FAULT_KIND": "signal", "FAULT_SIGNAL": str(int(signal.SIGSTOP))}
        known["FAULT_AT"] = str(trace.read_text().splitlines().index(at) + 1)
        process = subprocess.Popen(command, cwd=tmp_path, env=known, stderr=subprocess.PIPE, text=True)
        begun_here.append(process)
        assert os.WIFSTOPPED(os.waitpid(process.pid, os.WUNTRACED)[1])
        return process

    yield call
    for process in begun_here:
        process.kill()
        process.communicate()


def test_the_run_that_loses_leaves_the_log_of_the_later_one(
    stopped, begun, shim: Path, scene_text, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It ends at the moment at which the later one has made its log and written nothing there."""
    first = stopped(scene_text(), "fsync scene.state.new")
    monkeypatch.setenv("FAULT_FLOCK", str(errno.ENOLCK))

    def meanwhile() -> None:
        first.send_signal(signal.SIGCONT)
        assert "which began later" in first.communicate(timeout=60)[1]
        assert first.returncode == 3

    ended = begun(scene_text(), shim, "write scene.log", meanwhile, "--overwrite")
    assert ended.returncode == 0, ended.stderr
    assert (tmp_path / "results" / "scene.log").read_text().startswith("rattle ")


def test_the_log_of_another_run_is_no_loss_of_a_result(
    begun, shim: Path, scene_text, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without locks one that loses may make its log a moment after that of the winner."""
    monkeypatch.setenv("FAULT_FLOCK", str(errno.ENOLCK))
    log = tmp_path / "results" / "scene.log"

    def meanwhile() -> None:
        log.unlink()
        log.write_text("rattle, the log of another run\n")

    ended = begun(scene_text(), shim, "fsync scene.state.new", meanwhile)
    assert ended.returncode == 0
    assert ended.stderr == "warning: results/scene.log was replaced by that of another run\n"
    assert log.read_text() == "rattle, the log of another run\n"


def test_a_later_run_that_gives_up_leaves_the_first_one_at_work(
    stopped, begun, shim: Path, scene_text, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The later one finds a file in its way once the lock is its own, and hands the lock back."""
    first = stopped(scene_text(), "open scene.log")
    monkeypatch.setenv("FAULT_FLOCK", str(errno.ENOLCK))
    results = tmp_path / "results"
    ended = begun(
        scene_text(),
        shim,
        "pwrite scene.lock",
        lambda: (results / "scene.summary.nml").write_text("&summary\n/\n"),
    )
    assert ended.returncode == 2
    assert "scene.summary.nml exists; --overwrite replaces it" in ended.stderr
    first.send_signal(signal.SIGCONT)
    words = first.communicate(timeout=60)[1]
    assert first.returncode == 0, words
    assert package.read_summary(results / "scene.summary.nml")["status"] == "complete"
    assert package.read(results / "scene.rattle").closed
    assert not (results / "scene.lock").exists()


def test_a_campaign_that_loses_at_once_replaces_nothing(
    begun, shim: Path, rattle: Path, scene_text, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A later one comes to its end while the first one makes its file."""
    command = [rattle, "--quiet", "--overwrite", "--set", "lubricant.viscosity=0.25", "scene.nml"]
    unlocked = {**os.environ, "LD_PRELOAD": str(shim), "FAULT_FLOCK": str(errno.ENOLCK)}
    monkeypatch.setenv("FAULT_FLOCK", str(errno.ENOLCK))
    ended = begun(
        TASKS["campaign"](scene_text),
        shim,
        "fsync scene.rattle.new",
        lambda: subprocess.run(command, cwd=tmp_path, env=unlocked, check=True),
    )
    assert ended.returncode == 3
    assert "which began later" in ended.stderr
    results = tmp_path / "results"
    assert package.read_summary(results / "scene.summary.nml")["status"] == "complete"
    assert "viscosity = 0.25" in package.read(results / "scene.rattle").input_text
    assert package.read(results / "scene.rattle").closed


@pytest.mark.parametrize("kind", ["resumed", "edited and overwriting", "of other pairs"])
def test_of_two_runs_of_a_gearbox_the_later_one_is_refused(
    kind: str, begun, shim: Path, run, tmp_path: Path
) -> None:
    """The first pair of the first run is in its place: the later run changes nothing, however it goes."""
    results = tmp_path / "results"
    text, option = {
        "resumed": (BOX, "--resume"),
        "edited and overwriting": (SLOWER_BOX, "--overwrite"),
        "of other pairs": (BOX.replace("'1st'", "'2nd'").replace("'4th'", "'5th'"), "--overwrite"),
    }[kind]
    (tmp_path / "later.nml").write_text(text)

    def meanwhile() -> None:
        before = contents(results)
        assert "scene.1st.summary.nml" in before and "scene.summary.nml" not in before
        ended = run("--quiet", option, "later.nml", cwd=tmp_path)
        assert ended.returncode == 3
        assert ended.stderr.startswith("results/scene is being written by another run; wait for its end, or ")
        assert contents(results) == before

    ended = begun(BOX, shim, "fsync scene.4th.state.new", meanwhile)
    assert ended.returncode == 0, ended.stderr
    assert list(package.read_summary(results / "scene.summary.nml")["gears"]) == ["1st", "4th"]
    assert not list(results.glob("*.lock"))


def test_of_two_runs_of_a_gearbox_without_locks_the_later_one_writes_the_table(
    stopped, begun, shim: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first run has both pairs when the later one has replaced the first of them."""
    first = stopped(BOX, "close scene.4th.lock (deleted)")
    monkeypatch.setenv("FAULT_FLOCK", str(errno.ENOLCK))
    table = tmp_path / "results" / "scene.summary.nml"

    def meanwhile() -> None:
        first.send_signal(signal.SIGCONT)
        assert "results/scene is being written by another run" in first.communicate(timeout=60)[1]
        assert first.returncode == 3
        assert not table.exists()

    ended = begun(SLOWER_BOX, shim, "fsync scene.4th.state.new", meanwhile, "--overwrite")
    assert ended.returncode == 0, ended.stderr
    assert list(package.read_summary(table)["gears"]) == ["1st", "4th"]
    assert not list(table.parent.glob("*.lock"))


# --- signals ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGXCPU, signal.SIGTERM], ids=lambda one: one.name)
@pytest.mark.parametrize("task", ["motion", "threshold", "campaign"])
def test_signals_of_batch_systems_keep_the_state(
    task: str, number: int, shim: Path, rattle: Path, run, scene_text, tmp_path: Path
) -> None:
    """They come once the log has begun; --resume goes on to the bytes of an undisturbed run."""
    (tmp_path / "scene.nml").write_text(TASKS[task](scene_text))
    environment = {**os.environ, "LD_PRELOAD": str(shim), "FAULT_FOLDER": "results/", "FAULT_KIND": "signal"}
    environment |= {"FAULT_SIGNAL": str(int(number)), "FAULT_AT": "6"}
    ended = subprocess.run(
        [rattle, "--quiet", "--threads", "1", "scene.nml"],
        cwd=tmp_path,
        env=environment,
        check=False,
        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),
    )
    assert ended.returncode == 128 + number
    results = tmp_path / "results"
    assert package.read_summary(results / "scene.summary.nml")["status"] == "interrupted"
    assert run("--resume", "scene.nml", cwd=tmp_path).returncode == 0
    assert run("--output", "whole", "scene.nml", cwd=tmp_path).returncode == 0
    assert (results / "scene.rattle").read_bytes() == (tmp_path / "whole" / "scene.rattle").read_bytes()


def test_a_finished_threshold_stays_when_it_is_solved_again_and_interrupted(
    shim: Path, rattle: Path, run, scene_text, tmp_path: Path
) -> None:
    """What was cut short has no result: the summary beside the earlier one stays that of its run."""
    (tmp_path / "scene.nml").write_text(TASKS["threshold"](scene_text))
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    results = tmp_path / "results"
    kept = {name: (results / name).read_bytes() for name in ("scene.rattle", "scene.summary.nml")}
    environment = {**os.environ, "LD_PRELOAD": str(shim), "FAULT_FOLDER": "results/", "FAULT_KIND": "signal"}
    environment |= {"FAULT_SIGNAL": str(int(signal.SIGTERM))}
    command = [rattle, "--quiet", "--threads", "1", "--resume", "scene.nml"]
    logs = []
    for at in range(4, 100, 2):
        # The signal comes before ever later calls, until the run has made all of them.
        ended = subprocess.run(command, cwd=tmp_path, env={**environment, "FAULT_AT": str(at)}, check=False)
        if ended.returncode == 0:
            break
        assert ended.returncode == 128 + signal.SIGTERM
        assert kept == {name: (results / name).read_bytes() for name in kept}
        logs.append((results / "scene.log").read_text())
    assert any("scene.rattle and its summary are those of an earlier run" in text for text in logs)
    assert (results / "scene.rattle").read_bytes() == kept["scene.rattle"]
    assert package.read_summary(results / "scene.summary.nml")["status"] == "complete"


def test_a_run_of_nohup_outlives_its_terminal(shim: Path, rattle: Path, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    environment = {**os.environ, "LD_PRELOAD": str(shim), "FAULT_FOLDER": "results/", "FAULT_KIND": "signal"}
    environment |= {"FAULT_SIGNAL": str(int(signal.SIGHUP)), "FAULT_AT": "6"}
    ended = subprocess.run(
        [rattle, "--quiet", "scene.nml"],
        cwd=tmp_path,
        env=environment,
        check=False,
        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN),
    )
    assert ended.returncode == 0
    assert package.read_summary(tmp_path / "results" / "scene.summary.nml")["status"] == "complete"


def test_a_limit_of_processor_time_keeps_the_state(rattle: Path, run, scene_text, tmp_path: Path) -> None:
    """The soft limit is a warning, the hard one a kill some seconds later."""
    (tmp_path / "scene.nml").write_text(
        scene_text(
            solver={"periods": "3000000"}, output={"series": ".false."}, spectrum={"verify": ".false."}
        )
    )
    ended = subprocess.run(
        [rattle, "--quiet", "--threads", "1", "scene.nml"],
        cwd=tmp_path,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (1, 20)),
    )
    assert ended.returncode == 128 + signal.SIGXCPU
    assert summary_of(tmp_path / "results" / "scene.summary.nml")["status"] == "interrupted"
    assert (tmp_path / "results" / "scene.state").stat().st_size > 0


# --- what may not be read --------------------------------------------------------------------------------


@pytest.mark.parametrize("which", ["input", "result"])
def test_what_may_not_be_read_is_reported_as_such(
    which: str, rattle: Path, run, scene_text, tmp_path: Path
) -> None:
    """Root may read all, so for root the program runs as nobody, from a copy that no one can reach."""
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 0
    unread = tmp_path / ("scene.nml" if which == "input" else "results/scene.summary.nml")
    unread.chmod(0)
    (tmp_path / "results").chmod(0o777)
    tmp_path.chmod(0o755)
    as_nobody: dict[str, object] = {}
    if os.geteuid() == 0:
        shutil.copy(rattle, tmp_path / "rattle")
        as_nobody = {"program": "./rattle", "user": 65534, "group": 65534, "extra_groups": []}
    ended = run("--overwrite", "scene.nml", cwd=tmp_path, **as_nobody)
    assert ended.returncode == 2
    if which == "input":
        assert ended.stderr == "scene.nml: it may not be read\n"
    else:
        assert "results/scene.summary.nml exists and may not be read" in ended.stderr
    assert "no such file" not in ended.stderr
