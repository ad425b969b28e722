"""Bad starts by the shell: closed descriptors, few files, small stacks, environments, long looks."""

from __future__ import annotations

import itertools
import os
import signal
import subprocess
from pathlib import Path

import pytest
from outcomes import contents, summary_of
from test_edited_inputs import TASKS
from waiting import until

from rattle import read

DESCRIPTORS = {0: "<&-", 1: ">&-", 2: "2>&-"}
SUBSETS = [subset for size in range(4) for subset in itertools.combinations(DESCRIPTORS, size)]


@pytest.fixture
def by_shell(rattle: Path, tmp_path: Path):
    """Call the program by a shell, after some words of it and with some redirections."""

    def call(
        before: str, *arguments: str, after: str = "", **environment: str
    ) -> subprocess.CompletedProcess:
        return subprocess.run(
            ["bash", "-c", f'{before or ":"} && exec "$0" "$@" {after}', rattle, *arguments],
            cwd=tmp_path,
            env={**os.environ, **environment},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )

    return call


def results_of(folder: Path) -> dict[str, bytes]:
    """The results of a run, which hold no times."""
    return {path.name: path.read_bytes() for path in folder.glob("*.rattle")}


# --- closed descriptors ----------------------------------------------------------------------------------


@pytest.mark.parametrize("task", TASKS)
def test_closed_descriptors_change_no_file(task: str, by_shell, scene_text, tmp_path: Path) -> None:
    """Whichever of the three are closed, the results are complete and the log has its words."""
    (tmp_path / "scene.nml").write_text(TASKS[task](scene_text))
    for subset in SUBSETS:
        folder = tmp_path / ("closed" + "".join(map(str, subset)))
        after = " ".join(DESCRIPTORS[number] for number in subset)
        ended = by_shell("", "--output", str(folder), "scene.nml", after=after)
        assert (ended.returncode, ended.stderr) == (0, ""), subset
        assert (ended.stdout == "") == (1 in subset)
        assert results_of(folder) == results_of(tmp_path / "closed")
        assert (folder / "scene.log").read_text().startswith("rattle ")
        assert summary_of(folder / "scene.summary.nml")["status"] == "complete"
        assert not (folder / "scene.lock").exists()


@pytest.mark.parametrize("option", ["--help", "--version", "--template", "--keys", "--check"])
def test_what_is_only_printed_is_lost_without_an_output(
    option: str, by_shell, scene_text, tmp_path: Path
) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    ended = by_shell("", option, *(["scene.nml"] if option == "--check" else []), after=">&-")
    assert ended.returncode == 3
    assert ended.stderr.startswith("the standard output could not be written")


def test_closed_input_is_no_file(by_shell) -> None:
    ended = by_shell("", "-", after="<&-")
    assert (ended.returncode, ended.stderr) == (2, "standard input: it cannot be read as a file\n")


@pytest.mark.parametrize("after", ["2>&-", "2>/dev/full"])
def test_the_exit_code_does_where_no_fault_is_known(after: str, by_shell, tmp_path: Path) -> None:
    assert by_shell("", "missing.nml", after=after).returncode == 2
    assert not contents(tmp_path)


# --- limits ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("task", TASKS)
def test_too_few_files_are_the_reason_reported(task: str, by_shell, scene_text, tmp_path: Path) -> None:
    """From the fewest with which the libraries load up to enough; --resume mends what was begun."""
    (tmp_path / "scene.nml").write_text(TASKS[task](scene_text))
    assert by_shell("", "--output", "enough", "scene.nml").returncode == 0
    outcomes = []
    for files in range(4, 12):
        ended = by_shell(f"ulimit -n {files}", "--resume", "--output", "few", "scene.nml")
        outcomes.append(ended.returncode)
        if ended.returncode != 0:
            assert (ended.returncode, "Too many open files" in ended.stderr) == (3, True), ended.stderr
    assert outcomes[0] == 3 and outcomes[-1] == 0
    assert results_of(tmp_path / "few") == results_of(tmp_path / "enough")


@pytest.mark.parametrize(("kilobytes", "exit_code"), [(128, 3), (1023, 3), (1024, 0), ("unlimited", 0)])
def test_the_stack_of_the_program(
    kilobytes: int | str, exit_code: int, by_shell, scene_text, tmp_path: Path
) -> None:
    (tmp_path / "scene.nml").write_text(TASKS["campaign"](scene_text))
    ended = by_shell(f"ulimit -S -s {kilobytes}", "--quiet", "--threads", "2", "scene.nml")
    assert ended.returncode == exit_code, ended.stderr
    if exit_code == 3:
        assert ended.stderr == (
            f"rattle: the stack is limited to {kilobytes} kB (ulimit -s), and rattle needs 1024 kB; "
            "type ulimit -s 8192, the usual limit\n"
        )
        assert not (tmp_path / "results").exists()


@pytest.mark.parametrize(
    ("variable", "size", "reported"),
    [
        ("OMP_STACKSIZE", "16k", 16),
        ("OMP_STACKSIZE", "100", 100),
        ("OMP_STACKSIZE", " 1023 K ", 1023),
        ("OMP_STACKSIZE", "65536B", 64),
        ("GOMP_STACKSIZE", "256", 256),
        ("OMP_STACKSIZE", "1M", None),
        ("OMP_STACKSIZE", "1024", None),
    ],
)
def test_the_stacks_of_threads(
    variable: str, size: str, reported: int | None, by_shell, scene_text, tmp_path: Path
) -> None:
    """Whatever spelling the library knows; one thread has none of its own."""
    (tmp_path / "scene.nml").write_text(TASKS["campaign"](scene_text))
    ended = by_shell("", "--quiet", "--threads", "2", "scene.nml", **{variable: size})
    if reported is None:
        assert (ended.returncode, ended.stderr) == (0, "")
        return
    assert ended.returncode == 3
    assert ended.stderr == (
        f"rattle: a thread has a stack of {reported} kB (OMP_STACKSIZE or GOMP_STACKSIZE), and rattle needs "
        "1024 kB; unset the variable, or set OMP_STACKSIZE=8M\n"
    )
    assert not (tmp_path / "results").exists()
    assert by_shell("", "--quiet", "--threads", "1", "scene.nml", **{variable: size}).returncode == 0


def test_threads_that_do_not_start(by_shell, scene_text, tmp_path: Path) -> None:
    """The library ends the program with 1 then, which would mean that a scene has failed."""
    (tmp_path / "scene.nml").write_text(TASKS["campaign"](scene_text))
    ended = by_shell("ulimit -v 4000000", "--threads", "2", "scene.nml", OMP_STACKSIZE="100G")
    assert ended.returncode == 3
    assert "Thread creation failed" in ended.stderr
    assert ended.stderr.splitlines()[-1].startswith(
        "the system refused what the program needs, see the line above"
    )


# --- environments ----------------------------------------------------------------------------------------

ENVIRONMENTS = [
    "GFORTRAN_OPTIONAL_PLUS=y",
    "GFORTRAN_STDOUT_UNIT=7",
    "GFORTRAN_STDERR_UNIT=9",
    "GFORTRAN_CONVERT_UNIT=swap",
    "GFORTRAN_LIST_SEPARATOR=;",
    "GFORTRAN_UNBUFFERED_ALL=y",
    "GFORTRAN_FORMATTED_BUFFER_SIZE=1",
    "GFORTRAN_UNFORMATTED_BUFFER_SIZE=1",
    "OMP_NUM_THREADS=3,2",
    "OMP_THREAD_LIMIT=1",
    "OMP_DYNAMIC=true",
    "OMP_NESTED=true",
    "OMP_MAX_ACTIVE_LEVELS=0",
    "OMP_PROC_BIND=spread",
    "OMP_PLACES={0}",
    "OMP_WAIT_POLICY=active",
]


@pytest.mark.parametrize("task", TASKS)
def test_environments_change_no_result(task: str, by_shell, scene_text, tmp_path: Path) -> None:
    """Of the libraries of gfortran and OpenMP: results, faults and files are the same."""
    (tmp_path / "scene.nml").write_text(TASKS[task](scene_text))
    (tmp_path / "bad.nml").write_text(scene_text(load={"mass": "-1.0"}))
    for setting in ["PLAIN=1", *ENVIRONMENTS]:
        name, _, value = setting.partition("=")
        ended = by_shell("", "--quiet", "--output", setting, "scene.nml", **{name: value})
        assert (ended.returncode, ended.stderr) == (0, ""), setting
        assert results_of(tmp_path / setting) == results_of(tmp_path / "PLAIN=1"), setting
        refused = by_shell("", "bad.nml", **{name: value})
        assert refused.returncode == 2 and "bad.nml:" in refused.stderr and "+" not in refused.stderr, setting
    assert {path.name for path in tmp_path.iterdir()} == {"scene.nml", "bad.nml", "PLAIN=1", *ENVIRONMENTS}


# --- before the first scene ------------------------------------------------------------------------------


def endless(scene_text) -> str:
    """A design whose scenes take minutes to be looked at."""
    campaign = {
        "vary": "'load.mass', 'load.frequency'",
        "sample": "'sobol'",
        "size": "1000000000",
        "confirm_size": ".true.",
        "first": "1.0, 500.0",
        "last": "5.0, 700.0",
        "record": "'film_minimum'",
    }
    solver = {"method": "'taylor'", "steps_per_period": None, "tolerance": None}
    return scene_text(scene={"task": "'campaign'"}, solver=solver, campaign=campaign)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT], ids=lambda number: number.name)
def test_a_long_look_at_scenes_has_a_log(
    number: signal.Signals, rattle: Path, scene_text, tmp_path: Path
) -> None:
    """And a file for watchers; a signal ends it, and leaves the log of the run before."""
    (tmp_path / "scene.nml").write_text(endless(scene_text))
    log = tmp_path / "results" / "scene.log"
    log.parent.mkdir()
    log.write_text("rattle 0.2.0, the log of an earlier run\n")
    command = [rattle, "--overwrite", "--threads", "1", "scene.nml"]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    watched = log.with_name("scene.progress.nml")
    try:
        until(lambda: watched.exists() and "none solved yet" in log.read_text(), process)
        assert "1000000000 scenes to be looked at before the first is solved" in log.read_text()
        seen = summary_of(watched)
        assert 0 < seen["scenes_looked_at"] < seen["scenes"] == 1000000000
    finally:
        process.send_signal(number)
    assert "none solved yet" in process.communicate()[0]
    assert process.returncode == 128 + number
    assert contents(log.parent) == {"scene.log": b"rattle 0.2.0, the log of an earlier run\n"}


def test_files_in_the_way_end_a_long_look(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(endless(scene_text))
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "scene.summary.nml").write_text("my notes\n")
    before = contents(tmp_path)
    ended = run("scene.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert "scene.summary.nml exists and was not written by rattle" in ended.stderr
    assert contents(tmp_path) == before


# --- signals while the program waits ---------------------------------------------------------------------

SIGNALS = [signal.SIGTERM, signal.SIGINT, signal.SIGHUP]


@pytest.mark.parametrize("number", SIGNALS, ids=lambda number: number.name)
@pytest.mark.parametrize("place", ["pipe", "standard input"])
def test_a_signal_ends_the_waiting_for_an_input(
    place: str, number: signal.Signals, rattle: Path, tmp_path: Path
) -> None:
    os.mkfifo(tmp_path / "scene.nml")
    end = os.open(tmp_path / "scene.nml", os.O_RDWR)
    argument = "scene.nml" if place == "pipe" else "-"
    process = subprocess.Popen([rattle, argument], cwd=tmp_path, stdin=end)
    # Asleep in the call that reads.
    until(lambda: Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()[0] == "S", process)
    process.send_signal(number)
    assert process.wait() == -number
    os.close(end)
    assert [path.name for path in tmp_path.iterdir()] == ["scene.nml"]


@pytest.mark.parametrize("number", SIGNALS, ids=lambda number: number.name)
def test_a_signal_ends_the_waiting_for_a_reader(
    number: signal.Signals, rattle: Path, scene_text, tmp_path: Path
) -> None:
    """Nobody reads the standard output, and the pipe is full; what was lost is said."""
    (tmp_path / "scene.nml").write_text(TASKS["campaign"](scene_text))
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    with pytest.raises(BlockingIOError):
        while True:
            os.write(writer, b" " * 4096)
    os.set_blocking(writer, True)
    command = [rattle, "--threads", "1", "scene.nml"]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=writer, stderr=subprocess.PIPE, text=True)
    # The log is there, its first line not yet: it goes to the terminal first.
    until((tmp_path / "results" / "scene.log").exists, process)
    process.send_signal(number)
    words = process.communicate()[1]
    os.close(reader)
    os.close(writer)
    assert process.returncode == 128 + number
    assert words.startswith("the standard output could not be written")
    assert not (tmp_path / "results" / "scene.lock").exists()


# --- failures --------------------------------------------------------------------------------------------

OVERFLOW = {"film": {"law": "'piezo-viscous'", "initial_velocity": "-1.0e3"}}


def test_quiet_failures_have_a_line(run, scene_text, tmp_path: Path) -> None:
    """Each failed scene, and none that succeeds."""
    (tmp_path / "bad.nml").write_text(scene_text(**OVERFLOW))
    (tmp_path / "good.nml").write_text(scene_text())
    ended = run("--quiet", "good.nml", "bad.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stdout) == (1, "")
    assert ended.stderr == (
        "bad.nml: The film load exceeds every number that can be represented; the film law does not hold "
        "here. results/bad.log has more\n"
    )


def test_quiet_campaigns_count_their_failures(run, scene_text, tmp_path: Path) -> None:
    campaign = {"vary": "'film.initial_velocity'", "first": "-1.0e3", "last": "0.0", "count": "2"}
    solver = {"method": "'taylor'", "steps_per_period": None, "tolerance": None}
    text = scene_text(
        scene={"task": "'campaign'"},
        solver=solver,
        **OVERFLOW,
        campaign={**campaign, "record": "'film_minimum'"},
    )
    (tmp_path / "scene.nml").write_text(text)
    ended = run("--quiet", "scene.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stdout) == (1, "")
    assert ended.stderr == "scene.nml: 1 scene failed; results/scene.log has more\n"


# --- work without end ------------------------------------------------------------------------------------


def test_the_steps_of_a_period_are_bounded(run, repository: Path, tmp_path: Path) -> None:
    """A mass of a grain of sand between two flanks under no load: half a million oscillations a period."""
    settings = ["--set", "load.mass=1.3e-9", "--set", "load.steady_force=1e-55"]
    ended = run("--quiet", *settings, repository / "input" / "drive_rattle.nml", cwd=tmp_path)
    assert ended.returncode == 1
    summary = summary_of(tmp_path / "results" / "drive_rattle.summary.nml")
    assert summary["status"] == "not_converged"
    assert summary["steps"] <= 1e5 + 1


@pytest.mark.long
def test_the_steps_of_a_motion_are_bounded(run, scene_text, tmp_path: Path) -> None:
    """A flank of a third of a micrometre: no period takes too many steps, all together do before the last."""
    text = scene_text(
        contact={"radius": "3e-7"},
        load={"force_amplitude": "240.0"},
        film={"model": "'published'"},
        solver={"method": "'taylor'", "steps_per_period": None, "periods": "120", "accuracy": "1e-6"},
        spectrum={"periods": "2", "verify": ".false."},
    )
    (tmp_path / "scene.nml").write_text(text)
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 1
    summary = summary_of(tmp_path / "results" / "scene.summary.nml")
    assert summary["status"] == "not_converged"
    assert 50 < summary["periods_solved"] < 120
    assert 7e5 < summary["steps"] < 7e5 + 1500 * 121


def test_a_campaign_names_its_longest_scene(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(TASKS["campaign"](scene_text))
    assert run("--quiet", "scene.nml", cwd=tmp_path).returncode == 0
    rows = read(tmp_path / "results" / "scene.rattle").row_count
    words = (tmp_path / "results" / "scene.log").read_text().partition("longest          scene ")[2].split()
    assert 1 <= int(words[0].rstrip(",")) <= rows and int(words[1]) > 0
