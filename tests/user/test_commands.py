"""What the options do, what is written, and how runs end."""

from __future__ import annotations

import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import f90nml
import numpy as np
import pytest

from rattle import read

GROUPS = (
    "scene",
    "contact",
    "lubricant",
    "kinematics",
    "load",
    "film",
    "solver",
    "spectrum",
    "points",
    "sweep",
    "campaign",
    "output",
)
CRASH = ("acktrace", "Program received", "Fortran runtime error")


def summary_of(path: Path) -> dict:
    """The &summary group as Python values."""
    return f90nml.read(path)["summary"]


@pytest.fixture
def solved(run, scene_text, tmp_path: Path) -> Callable[..., Path]:
    """Run a scene that must succeed; return the folder of its files."""

    def solve(name: str = "scene", **changes: dict[str, str | None] | None) -> Path:
        folder = tmp_path / name
        folder.mkdir()
        (folder / f"{name}.nml").write_text(scene_text(**changes))
        ended = run(f"{name}.nml", cwd=folder)
        assert (ended.returncode, ended.stderr) == (0, ""), ended
        return folder / "results"

    return solve


# --- looking, not running ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"film": {"law": "'piezo-viscous'"}},
        {"film": {"law": "'iso-viscous'", "rupture": "'solved'", "rupture_solver": "'successive'"}},
        {"contact": {"radius": None, "radius_1": "0.02", "radius_2": "0.0345678901234567"}},
        {"kinematics": {"entrainment_speed": None, "surface_speed_1": "3", "surface_speed_2": "-0.1"}},
        {"film": {"initial_film": "1.2345678901234567e-6", "initial_velocity": "-1d-3"}},
        {
            "output": {"columns": "'time', 'film_load'", "series": "f", "stride": "8"},
            "scene": {"name": "'x'"},
        },
    ],
    ids=["plain", "piezo-viscous", "solved rupture", "two radii", "two speeds", "start", "output"],
)
def test_echo_of_check_is_itself_an_input(changes: dict, run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text(**changes))
    first = run("--check", "scene.nml", cwd=tmp_path)
    assert (first.returncode, first.stderr) == (0, "")
    again = run("--check", "-", cwd=tmp_path, stdin=first.stdout)
    assert (again.returncode, again.stderr) == (0, "")
    assert again.stdout == first.stdout.replace("! scene.nml:", "! standard input:")
    assert [path.name for path in tmp_path.iterdir()] == ["scene.nml"]


def test_check_tells_derived_values(run, scene_text, tmp_path: Path) -> None:
    """At rest the load of (35) is inversely proportional to the film, so its stiffness is (Q + m g)/h0."""
    echo = run("--check", "-", cwd=tmp_path, stdin=scene_text()).stdout
    film = float(re.search(r"steady film +(\S+) m", echo)[1])
    frequency = float(re.search(r"natural frequency +(\S+) Hz", echo)[1])
    load = 199.2 + 3.0 * 9.80665
    assert frequency == pytest.approx(np.sqrt(load / film / 3.0) / (2 * np.pi), rel=1e-5)
    for words in ("damping ratio", "squeeze group A", "pressure group B", "largest alpha p"):
        assert words in echo


def test_check_of_several_files(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "a.nml").write_text(scene_text())
    (tmp_path / "b.nml").write_text(scene_text(load={"mass": "2"}))
    echo = run("--check", "a.nml", "b.nml", cwd=tmp_path).stdout
    assert "! a.nml: valid" in echo
    assert "   mass = 3.0\n" in echo.split("! b.nml: valid")[0]
    assert "   mass = 2.0\n" in echo.split("! b.nml: valid")[1]


def test_check_does_not_mind_existing_results(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    assert run("--check", "scene.nml", cwd=tmp_path).returncode == 0


def test_template_is_a_valid_input(run, tmp_path: Path) -> None:
    template = run("--template", cwd=tmp_path)
    assert (template.returncode, template.stderr) == (0, "")
    assert [line[1:] for line in template.stdout.split("\n") if line.startswith("&")] == list(GROUPS)
    checked = run("--check", "-", cwd=tmp_path, stdin=template.stdout)
    assert (checked.returncode, checked.stderr) == (0, "")


def test_template_with_every_key_uncommented_names_only_known_keys(run, tmp_path: Path) -> None:
    """The only faults left are those of keys that exclude each other or have no default."""
    template = run("--template", cwd=tmp_path).stdout
    everything = re.sub(r"^   ! (\w+ =)", r"   \1", template, flags=re.MULTILINE)
    faults = run("--check", "-", cwd=tmp_path, stdin=everything).stderr
    assert "unknown" not in faults
    assert faults.count("\n") > 0


@pytest.mark.parametrize("group", [*GROUPS, "LOAD"])
def test_template_of_one_group(group: str, run, tmp_path: Path) -> None:
    whole = run("--template", cwd=tmp_path).stdout
    part = run("--template", group, cwd=tmp_path)
    assert part.returncode == 0
    assert re.findall(r"^&(\w+)$", part.stdout, flags=re.MULTILINE) == [group.lower()]
    assert part.stdout in whole


def test_version(run, repository: Path, tmp_path: Path) -> None:
    ended = run("--version", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout == f"rattle {(repository / 'fsrc' / 'VERSION').read_text().strip()}\n"


def test_help_names_every_option(run, tmp_path: Path) -> None:
    ended = run("--help", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    for option in ("check", "template", "keys", "set", "output", "overwrite", "quiet", "version", "help"):
        assert f"--{option}" in ended.stdout
    assert run("-h", cwd=tmp_path).stdout == ended.stdout


def test_page_of_keys(run, repository: Path, tmp_path: Path) -> None:
    ended = run("--keys", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    template = run("--template", cwd=tmp_path).stdout
    keys = re.findall(r"^   (?:! )?(\w+) =", template, flags=re.MULTILINE)
    assert len(keys) > 30
    assert re.findall(r"^\| `(\w+)` \|", ended.stdout, flags=re.MULTILINE) == keys
    page = repository / "input" / "README.md"
    if page.exists():
        assert page.read_text() == ended.stdout


@pytest.mark.parametrize("scene", ["idle", "creep"])
def test_ready_scenes_are_valid(scene: str, run, repository: Path, tmp_path: Path) -> None:
    ended = run("--check", repository / "input" / f"{scene}.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")


# --- options -----------------------------------------------------------------------------------------


def test_set_comes_before_the_file(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    settings = ["load.mass=2.5", "LOAD.Gravity=0", "film.law=piezo-viscous", "output.columns=time,film_load"]
    options = [part for setting in settings for part in ("--set", setting)]
    echo = f90nml.reads(run("--check", *options, "scene.nml", cwd=tmp_path).stdout)
    assert echo["load"]["mass"] == 2.5
    assert echo["load"]["gravity"] == 0.0
    assert echo["film"]["law"] == "piezo-viscous"
    assert echo["output"]["columns"] == ["time", "film_load"]


def test_last_set_wins(run, scene_text, tmp_path: Path) -> None:
    options = ["--set", "load.mass=2.5", "--set", "load.mass=4"]
    echo = f90nml.reads(run("--check", "-", *options, cwd=tmp_path, stdin=scene_text()).stdout)
    assert echo["load"]["mass"] == 4.0


def test_set_mends_a_missing_key(run, scene_text, tmp_path: Path) -> None:
    ended = run("--check", "-", "--set", "load.mass=2", cwd=tmp_path, stdin=scene_text(load={"mass": None}))
    assert ended.returncode == 0


def test_set_takes_quotes_as_well(run, scene_text, tmp_path: Path) -> None:
    options = ["--set", "scene.name='a'", "--set", "output.columns='time', \"acceleration\""]
    echo = f90nml.reads(run("--check", "-", *options, cwd=tmp_path, stdin=scene_text()).stdout)
    assert echo["scene"]["name"] == "a"
    assert echo["output"]["columns"] == ["time", "acceleration"]


def test_output_makes_the_folder(run, scene_text, tmp_path: Path) -> None:
    ended = run("-", "--output", "new/it's/here", cwd=tmp_path, stdin=scene_text(scene={"name": "'a'"}))
    assert ended.returncode == 0
    assert sorted(path.name for path in (tmp_path / "new" / "it's" / "here").iterdir()) == [
        "a.log",
        "a.rattle",
        "a.state",
        "a.summary.nml",
    ]
    assert not (tmp_path / "results").exists()


def test_output_takes_an_absolute_path(run, scene_text, tmp_path: Path) -> None:
    assert run("-", "--output", tmp_path / "there", cwd=tmp_path, stdin=scene_text()).returncode == 0
    assert (tmp_path / "there" / "standard-input.rattle").is_file()


def test_overwrite_replaces_earlier_results(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    ended = run("--overwrite", "scene.nml", "--set", "solver.periods=2", cwd=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    result = read(tmp_path / "results" / "scene.rattle")
    assert result.closed
    assert result.row_count == 2 * 32 + 1
    assert summary_of(tmp_path / "results" / "scene.summary.nml")["steps"] == 64


def test_overwrite_replaces_an_unclosed_result(run, scene_text, tmp_path: Path) -> None:
    """What a killed run left behind is a result of an earlier run, too."""
    (tmp_path / "scene.nml").write_text(scene_text())
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    path = tmp_path / "results" / "scene.rattle"
    whole = path.read_bytes()
    path.write_bytes(whole[:24] + (-1).to_bytes(8, "little", signed=True) + whole[32:-100])
    assert not read(path).closed
    assert run("--overwrite", "scene.nml", cwd=tmp_path).returncode == 0
    assert path.read_bytes() == whole


def test_quiet_prints_nothing(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    ended = run("--quiet", "scene.nml", cwd=tmp_path)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")
    assert "steady film" in (tmp_path / "results" / "scene.log").read_text()


def test_quiet_still_tells_faults(run, tmp_path: Path) -> None:
    ended = run("--quiet", "absent.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert ended.stderr.startswith("absent.nml: ")


def test_log_holds_what_the_terminal_showed(run, scene_text, tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / f"{name}.nml").write_text(scene_text())
    ended = run("a.nml", "b.nml", cwd=tmp_path)
    logs = [(tmp_path / "results" / f"{name}.log").read_text() for name in ("a", "b")]
    assert ended.stdout == "".join(logs)
    for name, log in zip(("a", "b"), logs, strict=True):
        assert log.startswith("rattle ")
        assert f"scene {name}" in log
        assert f"results/{name}.summary.nml" in log


# --- what is written ---------------------------------------------------------------------------------


def test_series_has_every_step_and_the_start(solved) -> None:
    result = read(solved() / "scene.rattle")
    assert result.closed
    assert list(result.columns) == ["time", "applied_force", "film_thickness", "acceleration"]
    assert result.row_count == 3 * 32 + 1
    steps = np.arange(97)
    np.testing.assert_allclose(result["time"], steps / (600.0 * 32), rtol=1e-15)
    # Eq. (34): F = Q + F0 cos(2 pi f t).
    expected = 199.2 + 205.7 * np.cos(2 * np.pi * steps / 32)
    np.testing.assert_allclose(result["applied_force"], expected, rtol=1e-13)


def test_columns_in_the_order_of_the_input(solved) -> None:
    names = ["film_load", "acceleration", "squeeze_velocity", "time", "film_thickness", "applied_force"]
    columns = ", ".join(f"'{name}'" for name in names)
    result = read(solved("some", output={"columns": columns}) / "some.rattle")
    assert list(result.columns) == names
    units = ["N", "m/s2", "m/s", "s", "m", "N"]
    assert [result.units[name] for name in names] == units
    # Eq. (1): m z'' = W - F - m g.
    np.testing.assert_allclose(
        result["film_load"], 3.0 * (result["acceleration"] + 9.80665) + result["applied_force"], rtol=1e-13
    )
    everything = read(solved("default") / "default.rattle")
    for name in everything.columns:
        np.testing.assert_array_equal(result[name], everything[name])


@pytest.mark.parametrize("stride", [2, 5, 7, 32, 33, 40, 96, 97, 1000])
def test_stride_takes_every_nth_row(stride: int, solved) -> None:
    whole = read(solved("whole") / "whole.rattle")
    thin = read(solved("thin", output={"stride": str(stride)}) / "thin.rattle")
    assert thin.closed
    for name in whole.columns:
        np.testing.assert_array_equal(thin[name], whole[name][::stride])


def test_scene_without_a_series(solved) -> None:
    folder = solved(output={"series": ".false."})
    assert sorted(path.name for path in folder.iterdir()) == ["scene.log", "scene.state", "scene.summary.nml"]
    assert summary_of(folder / "scene.summary.nml")["rattle_class"] in ("idle", "creep", "quiet", "irregular")


def test_series_does_not_change_the_summary(solved) -> None:
    def steady_part(path: Path) -> str:
        return re.sub(r"wall_seconds.*|name = .*", "", path.read_text())

    first = steady_part(solved("a") / "a.summary.nml")
    assert first == steady_part(solved("b", output={"series": "f"}) / "b.summary.nml")


@pytest.mark.parametrize("law", ["iso-viscous", "piezo-viscous"])
def test_same_input_gives_the_same_bytes(law: str, run, scene_text, tmp_path: Path) -> None:
    """In other folders, under another name of the input file, with other places, on repeated runs."""
    text = scene_text(film={"law": f"'{law}'"}, scene={"name": "'same'"}, solver={"steps_per_period": "256"})
    results = []
    for folder in ("a", "b/c/d"):
        here = tmp_path / folder
        here.mkdir(parents=True)
        (here / f"{folder[-1]}.nml").write_text(text)
        for output in ("first", "second"):
            arguments = [f"{folder[-1]}.nml", "--output", output, "--quiet", "--overwrite"]
            assert run(*arguments, cwd=here).returncode == 0
            results.append((here / output / "same.rattle").read_bytes())
    assert len(results[0]) > 3 * 256 * 32
    assert all(result == results[0] for result in results[1:])


def test_result_is_an_input_of_itself(run, solved, tmp_path: Path) -> None:
    """The resolved input in the header, fed back, gives the same file."""
    folder = solved(film={"law": "'piezo-viscous'"}, output={"stride": "3"})
    text = read(folder / "scene.rattle").input_text
    assert run("-", "--output", "again", cwd=tmp_path, stdin=text).returncode == 0
    assert (tmp_path / "again" / "scene.rattle").read_bytes() == (folder / "scene.rattle").read_bytes()


def test_summary_of_a_complete_run(solved) -> None:
    summary = summary_of(solved() / "scene.summary.nml")
    assert summary["status"] == "complete"
    assert summary["status_time"] == pytest.approx(3 / 600.0)
    assert summary["name"] == "scene"
    assert summary["steps"] == 96
    assert summary["evaluations"] >= 96
    assert summary["iterations_per_step"] == pytest.approx(summary["evaluations"] / 96)
    assert summary["wall_seconds"] > 0
    assert summary["window_periods"] == 2
    assert summary["film_minimum"] < summary["steady_film"] < summary["film_maximum"]
    assert isinstance(summary["law_contradicted"], bool)


def test_extremes_are_those_of_the_window(solved) -> None:
    folder = solved(solver={"periods": "9"})
    summary = summary_of(folder / "scene.summary.nml")
    result = read(folder / "scene.rattle")
    window = slice(7 * 32 + 1, None)
    assert summary["film_minimum"] == result["film_thickness"][window].min()
    assert summary["film_maximum"] == result["film_thickness"][window].max()
    assert summary["acceleration_minimum"] == result["acceleration"][window].min()
    assert summary["acceleration_maximum"] == result["acceleration"][window].max()


# --- how runs end ------------------------------------------------------------------------------------

# At this speed of approach exp(A) of the piezo-viscous load (37) is beyond every number.
OVERFLOW = {"film": {"law": "'piezo-viscous'", "initial_velocity": "-1.0e3"}}


@pytest.mark.parametrize("order", [("bad", "good"), ("good", "bad")], ids=" ".join)
def test_failed_scene_does_not_stop_the_others(
    order: tuple[str, str], run, scene_text, tmp_path: Path
) -> None:
    (tmp_path / "good.nml").write_text(scene_text())
    (tmp_path / "bad.nml").write_text(scene_text(**OVERFLOW))
    ended = run(*(f"{name}.nml" for name in order), cwd=tmp_path)
    assert ended.returncode == 1
    assert not [word for word in CRASH if word in ended.stderr + ended.stdout]
    good = summary_of(tmp_path / "results" / "good.summary.nml")
    assert good["status"] == "complete"
    bad = summary_of(tmp_path / "results" / "bad.summary.nml")
    assert bad["status"] == "overflow"
    assert bad["status_time"] == 0.0
    assert bad["status_text"].endswith(".")
    assert bad["steady_film"] > 0
    assert "rattle_class" not in bad
    assert "film_minimum" not in bad
    assert read(tmp_path / "results" / "bad.rattle").closed
    assert "overflow" in (tmp_path / "results" / "bad.log").read_text()


def test_not_converged(run, scene_text, tmp_path: Path) -> None:
    """A tolerance that no pass can meet ends the scene; rows up to the failing step are kept."""
    text = scene_text(solver={"iteration_limit": "1", "tolerance": "1e-300"})
    assert run("-", cwd=tmp_path, stdin=text).returncode == 1
    summary = summary_of(tmp_path / "results" / "standard-input.summary.nml")
    assert summary["status"] == "not_converged"
    result = read(tmp_path / "results" / "standard-input.rattle")
    assert result.closed
    assert result.row_count == summary["steps"] + 1
    assert summary["film_at_status_time"] > 0


def long_scene(scene_text: Callable[..., str], **output: str) -> str:
    """Would take many minutes and hundreds of gigabytes."""
    return scene_text(solver={"steps_per_period": "512", "periods": "100000000"}, output=output)


def start(rattle: Path, cwd: Path, *arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [rattle, *arguments], cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def wait_for_rows(path: Path, size: int = 100_000) -> None:
    """Until the program has written rows."""
    deadline = time.monotonic() + 10.0
    while not path.exists() or path.stat().st_size < size:
        assert time.monotonic() < deadline, f"{path} does not grow"
        time.sleep(0.005)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGUSR1], ids=lambda n: n.name)
def test_interruption_keeps_what_was_computed(
    number: signal.Signals, rattle: Path, scene_text, tmp_path: Path
) -> None:
    (tmp_path / "long.nml").write_text(long_scene(scene_text))
    (tmp_path / "next.nml").write_text(scene_text())
    path = tmp_path / "results" / "long.rattle"
    process = start(rattle, tmp_path, "long.nml", "next.nml")
    try:
        wait_for_rows(path)
        process.send_signal(number)
        stdout, stderr = process.communicate(timeout=10)
    finally:
        process.kill()
    assert process.returncode == 128 + number
    assert stderr == ""
    assert "interrupted" in stdout

    summary = summary_of(tmp_path / "results" / "long.summary.nml")
    assert summary["status"] == "interrupted"
    result = read(path)
    assert result.closed
    assert result.row_count == summary["steps"] + 1
    assert result.row_count % 512 == 1
    np.testing.assert_array_equal(result["time"][:3], np.arange(3) / (600.0 * 512))
    assert result["time"][-1] == pytest.approx(summary["status_time"], rel=1e-14)
    assert np.isfinite(result["acceleration"]).all()
    assert "rattle_class" not in summary
    assert "interrupted" in (tmp_path / "results" / "long.log").read_text()
    assert not (tmp_path / "results" / "next.summary.nml").exists()
    shutil.rmtree(tmp_path / "results")


def test_kill_leaves_a_readable_result(rattle: Path, scene_text, tmp_path: Path) -> None:
    (tmp_path / "long.nml").write_text(long_scene(scene_text))
    path = tmp_path / "results" / "long.rattle"
    process = start(rattle, tmp_path, "long.nml")
    try:
        wait_for_rows(path)
    finally:
        process.kill()
        process.communicate(timeout=10)
    result = read(path)
    assert not result.closed
    assert result.row_count > 1000
    steps = np.arange(1000, dtype=float)
    np.testing.assert_array_equal(result["time"][:1000], steps / (600.0 * 512))
    assert np.isfinite(result["acceleration"]).all()
    assert not (tmp_path / "results" / "long.summary.nml").exists()
    shutil.rmtree(tmp_path / "results")


def test_full_disk(rattle: Path, scene_text, tmp_path: Path) -> None:
    """A file that may not grow stands for the full disk: code 3, a plain sentence, a summary all the same."""
    (tmp_path / "long.nml").write_text(long_scene(scene_text))

    def limit_files() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, 1_000_000))

    ended = subprocess.run(
        [rattle, "long.nml"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=20,
        check=False,
        preexec_fn=limit_files,
    )
    assert ended.returncode == 3
    assert re.fullmatch(r"results/long\.rattle cannot be written: .+\n", ended.stderr)
    summary = summary_of(tmp_path / "results" / "long.summary.nml")
    assert summary["status"] == "not_written"
    result = read(tmp_path / "results" / "long.rattle")
    assert not result.closed
    assert result.row_count > 20_000
    assert "rattle_class" not in summary


PEAK_MEMORY = """
import os, subprocess, sys
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, usage = os.wait4(process.pid, 0)
print(os.waitstatus_to_exitcode(status), usage.ru_maxrss)
"""


def test_memory_does_not_grow_with_the_periods(rattle: Path, scene_text, tmp_path: Path) -> None:
    """Without a series nothing is kept but the window."""
    peaks = []
    for periods in (100, 4000):
        name = f"p{periods}"
        solver = {"steps_per_period": "512", "periods": str(periods)}
        (tmp_path / f"{name}.nml").write_text(scene_text(solver=solver, output={"series": "f"}))
        measured = subprocess.run(
            [sys.executable, "-c", PEAK_MEMORY, rattle, f"{name}.nml"],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=60,
            check=True,
        )
        code, kilobytes = map(int, measured.stdout.split())
        assert code == 0
        peaks.append(kilobytes)
    # One value of 4000 periods alone would be 16 MB.
    assert peaks[1] - peaks[0] < 3000


def test_closed_terminal_does_not_lose_the_run(rattle: Path, scene_text, tmp_path: Path) -> None:
    """`rattle ... | head -1`: nobody reads any more, but the files are complete."""
    (tmp_path / "scene.nml").write_text(scene_text())
    reader, writer = os.pipe()
    os.close(reader)
    process = subprocess.Popen([rattle, "scene.nml"], cwd=tmp_path, stdout=writer, stderr=subprocess.PIPE)
    os.close(writer)
    process.communicate(timeout=10)
    assert summary_of(tmp_path / "results" / "scene.summary.nml")["status"] == "complete"
    assert read(tmp_path / "results" / "scene.rattle").closed
