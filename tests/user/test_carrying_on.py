"""What a user does with a run that ended: --resume, after its end, after a signal, after its time limit."""

from __future__ import annotations

import signal
import subprocess
from pathlib import Path

import numpy as np
import pytest
from outcomes import contents, digest, summary_of
from result_writer import write_result
from waiting import let_work, until

import rattle as package

METHODS = ["newmark", "taylor"]

# Film laws and models, and short names of them.
FILMS = {
    "published-iso": {"law": "'iso-viscous'", "model": "'published'"},
    "published-piezo": {"law": "'piezo-viscous'", "model": "'published'"},
    "reynolds-iso": {"law": "'iso-viscous'", "model": "'reynolds'"},
    "reynolds-piezo": {"law": "'piezo-viscous'", "model": "'reynolds'"},
}


def summary(results: Path) -> dict:
    """The summary without the time it took."""
    read = summary_of(results / "scene.summary.nml").todict()
    del read["wall_seconds"]
    return read


def films(results: Path) -> np.ndarray:
    return np.array(package.read(results / "scene.rattle")["film_thickness"])


def same(folder: Path, *names: str, one: str = "chained", other: str = "long") -> None:
    """Two results are the same: summaries but for the time they took, files to the last bit."""
    assert summary(folder / one) == summary(folder / other)
    for name in names or ("scene.rattle", "scene.state"):
        assert digest(folder / one / name) == digest(folder / other / name), name


def canonical(scene_text, law: str = "iso-viscous", model: str = "published", **solver: str | None) -> str:
    """The scene of the paper; with the Reynolds film a viscosity that it bears."""
    given = {"steps_per_period": None, "method": None, "periods": "60", **solver}
    lubricant = {"pressure_viscosity": "1.0e-9"} if model == "reynolds" else {}
    return scene_text(
        film={"law": f"'{law}'", "model": f"'{model}'"},
        lubricant=lubricant,
        solver=given,
        spectrum={"periods": "16"},
    )


def solver_of(method: str, steps: str = "64", **keys: str) -> dict[str, str | None]:
    return {"method": f"'{method}'", "steps_per_period": steps if method == "newmark" else None, **keys}


def settling(scene_text, film: str, method: str, **keys: str | None) -> str:
    """A steady run that needs some twenty periods, thirty with the published piezo-viscous film."""
    slower = film == "published-piezo"
    return scene_text(
        contact={"length": "0.0002" if slower else "0.01"},
        kinematics={"entrainment_speed": "0.01" if slower else "0.03"},
        load={"steady_force": "20.0", "force_amplitude": "60.0" if slower else "30.0"},
        film=FILMS[film],
        solver={**solver_of(method, "256"), "periods": "120", "until": "'steady'", **keys},
        spectrum={"periods": "4", "verify": ".false."},
    )


def creeping(scene_text, method: str, periods: str, **keys: str) -> str:
    """A film that rises for thousands of periods: nothing repeats, and it is too stiff for series."""
    return scene_text(
        contact={"length": "0.0002"},
        kinematics={"entrainment_speed": "0.001"},
        load={"steady_force": "20.0", "force_amplitude": "60.0"},
        film={"law": "'piezo-viscous'"},
        solver={**solver_of(method, "512"), "periods": periods, "until": "'steady'", **keys},
        spectrum={"periods": "1", "verify": ".false."},
        output={"series": ".false."},
    )


def carry_on(run, folder: Path, *options: str, output: str = "chained", code: int = 0) -> str:
    """One more call with --resume; what it reported."""
    ended = run("--resume", "--output", output, *options, "scene.nml", cwd=folder)
    assert ended.returncode == code, ended.stderr
    return ended.stdout


def terminated(rattle: Path, folder: Path, *options: str, after: float) -> dict:
    """Summary of a run that a signal ends after so much processor time [s]."""
    process = subprocess.Popen([rattle, *options, "--quiet", "--output", "cut", "scene.nml"], cwd=folder)
    until((folder / "cut" / "scene.log").exists, process)
    let_work(process, after)
    process.send_signal(signal.SIGTERM)
    assert process.wait(600) == 128 + signal.SIGTERM
    return summary(folder / "cut")


# --- a known number of periods ---------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["published", "reynolds"])
@pytest.mark.parametrize("method", METHODS)
def test_one_long_run_equals_three_chained(method: str, model: str, run, scene_text, tmp_path: Path) -> None:
    for law in ("iso-viscous", "piezo-viscous"):
        folder = tmp_path / law
        folder.mkdir()
        (folder / "scene.nml").write_text(canonical(scene_text, law, model, **solver_of(method)))
        for periods in (17, 20, 60):
            reported = carry_on(run, folder, "--set", f"solver.periods={periods}")
        assert "carried on       from period 4" in reported
        assert run("--output", "long", "scene.nml", cwd=folder).returncode == 0
        same(folder)


@pytest.mark.parametrize("film", FILMS)
def test_samples_that_fill_no_whole_registers_keep_their_bits(
    film: str, run, scene_text, tmp_path: Path
) -> None:
    """A sample has the same bits wherever in a block of periods it stands."""
    text = canonical(
        scene_text,
        *(word.strip("'") for word in FILMS[film].values()),
        method="'taylor'",
        samples_per_period="67",
    )
    (tmp_path / "scene.nml").write_text(text)
    for periods in (17, 20, 30, 41, 60):
        carry_on(run, tmp_path, "--set", f"solver.periods={periods}")
    assert run("--output", "long", "scene.nml", cwd=tmp_path).returncode == 0
    same(tmp_path)


@pytest.mark.parametrize(
    ("method", "setting", "carried"),
    [
        ("newmark", "load.mass=3", "steps"),
        ("newmark", "film.initial_velocity=-0.08", "cuts"),
        ("taylor", "load.mass=3", "lienard_variable"),
        ("taylor", "load.mass=1e-3", "implicit"),
    ],
    ids=lambda word: word,
)
def test_nothing_that_is_carried_over_is_lost(
    method: str, setting: str, carried: str, run, scene_text, tmp_path: Path
) -> None:
    """What is carried over is not zero in the state, so that losing it would show."""
    (tmp_path / "scene.nml").write_text(canonical(scene_text, **solver_of(method)))
    for periods in (17, 20, 60):
        reported = carry_on(run, tmp_path, "--set", setting, "--set", f"solver.periods={periods}")
    assert "carried on       from period 4" in reported
    assert run("--output", "long", "--set", setting, "scene.nml", cwd=tmp_path).returncode == 0
    assert package.read(tmp_path / "long" / "scene.state")[carried][0] != 0.0
    same(tmp_path)


@pytest.mark.parametrize("method", METHODS)
def test_interrupted_run_is_carried_on(method: str, rattle: Path, run, scene_text, tmp_path: Path) -> None:
    """A terminated run resumed ends like one that was left alone."""
    # What returns to the last bit is not computed again; these take a second all the same.
    periods = {"newmark": 20000, "taylor": 5000000}[method]
    text = canonical(scene_text, **solver_of(method, "512", periods=str(periods)))
    (tmp_path / "scene.nml").write_text(text)
    quiet = ["--set", "output.series=.false.", "--set", "spectrum.verify=.false.", "--quiet"]
    cut = terminated(rattle, tmp_path, *quiet, after=0.05)
    assert cut["status"] == "interrupted" and 0 < cut["periods_solved"] < periods
    assert run(*quiet, "--resume", "--output", "cut", "scene.nml", cwd=tmp_path).returncode == 0
    assert run(*quiet, "--output", "whole", "scene.nml", cwd=tmp_path).returncode == 0
    same(tmp_path, "scene.state", one="cut", other="whole")


@pytest.mark.parametrize("method", METHODS)
def test_interrupted_series_is_completed(method: str, rattle: Path, run, scene_text, tmp_path: Path) -> None:
    # Each takes a fast machine some tenths of a second: the signal must come before its end.
    periods = {"newmark": 50000, "taylor": 10000}[method]
    text = canonical(scene_text, **solver_of(method, periods=str(periods)))
    (tmp_path / "scene.nml").write_text(text.replace("&spectrum", "&spectrum\n   verify = .false."))
    cut = terminated(rattle, tmp_path, after=0.05)
    assert cut["status"] == "interrupted" and 0 < cut["periods_solved"] < periods
    carry_on(run, tmp_path, output="cut")
    assert run("--output", "whole", "scene.nml", cwd=tmp_path).returncode == 0
    same(tmp_path, one="cut", other="whole")


@pytest.mark.parametrize("method", METHODS)
def test_series_that_was_not_closed_is_carried_on(method: str, run, scene_text, tmp_path: Path) -> None:
    """A killed run leaves a series with its rows uncounted, maybe more than the state knows of."""
    (tmp_path / "scene.nml").write_text(canonical(scene_text, **solver_of(method)))
    carry_on(run, tmp_path)
    series = tmp_path / "chained" / "scene.rattle"
    content = bytearray(series.read_bytes())
    content[24:32] = (-1).to_bytes(8, "little", signed=True)
    series.write_bytes(content + bytes(1000))
    assert "carried on       from period 44" in carry_on(run, tmp_path, "--set", "solver.periods=70")
    assert run("--output", "long", "--set", "solver.periods=70", "scene.nml", cwd=tmp_path).returncode == 0
    same(tmp_path)


def test_time_limit_ends_cleanly(run, scene_text, tmp_path: Path) -> None:
    text = canonical(
        scene_text, method="'newmark'", steps_per_period="4096", periods="1000000", time_limit="0.05"
    )
    (tmp_path / "scene.nml").write_text(text)
    ended = run("--set", "output.series=.false.", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 1
    assert summary(tmp_path / "results")["status"] == "time_limit"
    assert (tmp_path / "results" / "scene.state").exists()


def test_change_of_method_within_a_run_is_counted_once(run, scene_text, tmp_path: Path) -> None:
    """Wherever the chain is cut, steps tried before the engine went over to collocation count once."""
    text = creeping(scene_text, "taylor", "60", until="'periods'")
    (tmp_path / "scene.nml").write_text(text)
    for periods in (2, 3, 4, 5, 6, 60):
        carry_on(run, tmp_path, "--set", f"solver.periods={periods}")
    assert run("--output", "long", "scene.nml", cwd=tmp_path).returncode == 0
    assert package.read(tmp_path / "long" / "scene.state")["implicit"][0] == 1
    same(tmp_path, "scene.state")


def test_film_that_nothing_holds_up_is_carried_on(run, scene_text, tmp_path: Path) -> None:
    """Where no film carries the static load, the sinking film stops both runs at the same moment."""
    text = scene_text(
        load={"steady_force": "2000.0", "force_amplitude": "10.0", "frequency": "60000.0"},
        film={"law": "'piezo-viscous'", "model": "'reynolds'", "initial_film": "50.0e-6"},
        solver={"steps_per_period": None, "method": "'taylor'", "periods": "60"},
    )
    (tmp_path / "scene.nml").write_text(text)
    for periods in (12, 17, 20):
        carry_on(run, tmp_path, "--set", f"solver.periods={periods}")
    assert "no_rigid_film" in carry_on(run, tmp_path, code=1)
    assert run("--output", "long", "scene.nml", cwd=tmp_path).returncode == 1
    same(tmp_path, "scene.rattle")


# --- until the motion repeats ----------------------------------------------------------------------------


@pytest.mark.parametrize("film", FILMS)
@pytest.mark.parametrize("method", METHODS)
def test_steady_run_in_pieces_equals_one(method: str, film: str, run, scene_text, tmp_path: Path) -> None:
    """A search that periods or time cut short goes on, and finds the same orbit at the same period."""
    # The finer the samples, the fewer the periods between two looks at the clock.
    samples = {} if method == "newmark" else {"samples_per_period": "8192" if method == "taylor" else "64"}
    (tmp_path / "scene.nml").write_text(settling(scene_text, film, method, **samples))
    for periods in (8, 12, 15):
        carry_on(run, tmp_path, "--set", f"solver.periods={periods}")
    reported = carry_on(run, tmp_path, "--set", "solver.time_limit=1e-9", code=1)
    assert "carried on       from period" in reported
    assert summary(tmp_path / "chained")["status"] == "time_limit"
    assert "carried on       from period" in carry_on(run, tmp_path)
    assert run("--output", "long", "scene.nml", cwd=tmp_path).returncode == 0
    long = summary(tmp_path / "long")
    assert long["status"] == "steady" and 15 < long["periods_solved"] < 60
    same(tmp_path)


@pytest.mark.parametrize("method", METHODS)
def test_steady_run_is_finished_for_good(method: str, run, scene_text, tmp_path: Path) -> None:
    """More periods change nothing: the motion repeats, its summary stays."""
    (tmp_path / "scene.nml").write_text(settling(scene_text, "published-iso", method))
    carry_on(run, tmp_path)
    first = summary(tmp_path / "chained")
    before = films(tmp_path / "chained")
    reported = carry_on(run, tmp_path, "--set", "solver.periods=5000")
    assert "earlier run      found steady" in reported
    assert first["status"] == "steady"
    after = summary(tmp_path / "chained")
    # The series says how many periods were asked for.
    del first["result_checksum"], after["result_checksum"]
    assert after == first
    assert np.array_equal(films(tmp_path / "chained"), before)
    assert run("--output", "long", "--set", "solver.periods=5000", "scene.nml", cwd=tmp_path).returncode == 0
    same(tmp_path)
    ended = run("--resume", "--output", "chained", "--set", "solver.periods=10", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2 and "before" in ended.stderr


def test_orbit_must_fit_into_the_longer_run(run, scene_text, tmp_path: Path) -> None:
    """The state stands at the start of the orbit: a run takes it up if it holds the whole of it."""
    (tmp_path / "scene.nml").write_text(settling(scene_text, "published-iso", "newmark"))
    carry_on(run, tmp_path)
    state = package.read(tmp_path / "chained" / "scene.state")
    start, orbit = int(state["periods"][0]), int(state["orbit"][0])
    assert start > 0 and orbit >= 1
    end = start + orbit
    shorter = ("--resume", "--output", "chained", "--set", f"solver.periods={end - 1}", "scene.nml")
    ended = run(*shorter, cwd=tmp_path)
    assert ended.returncode == 2
    assert f"is at period {start}; the window of this run would begin before" in ended.stderr
    reported = carry_on(run, tmp_path, "--set", f"solver.periods={end}")
    assert "earlier run      found steady" in reported


@pytest.mark.parametrize("method", METHODS)
def test_interrupted_search_goes_on(method: str, rattle: Path, run, scene_text, tmp_path: Path) -> None:
    """A signal is heard while the search goes on, and the search carried on ends like one left alone."""
    periods = {"newmark": 20000, "taylor": 3000}[method]
    (tmp_path / "scene.nml").write_text(creeping(scene_text, method, str(periods)))
    cut = terminated(rattle, tmp_path, after=0.05)
    assert cut["status"] == "interrupted" and 0 < cut["periods_solved"] < periods
    reported = carry_on(run, tmp_path, output="cut")
    assert f"carried on       from period {cut['periods_solved']}" in reported
    assert run("--output", "whole", "scene.nml", cwd=tmp_path).returncode == 0
    same(tmp_path, "scene.state", one="cut", other="whole")


@pytest.mark.parametrize("method", METHODS)
def test_steady_run_goes_on_beyond_its_orbit(method: str, run, scene_text, tmp_path: Path) -> None:
    """With until = 'periods' the state of a steady run is a state like others; the decreasing is reported."""
    (tmp_path / "scene.nml").write_text(settling(scene_text, "reynolds-iso", method))
    carry_on(run, tmp_path)
    on = ["--set", "solver.until=periods"]
    reported = carry_on(run, tmp_path, *on)
    assert "carried on       from period" in reported
    assert run("--output", "long", *on, "scene.nml", cwd=tmp_path).returncode == 0
    same(tmp_path)
    before = digest(tmp_path / "chained" / "scene.state")
    ended = run("--resume", "--output", "chained", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert "does not watch whether the motion repeats; --overwrite instead" in ended.stderr
    assert digest(tmp_path / "chained" / "scene.state") == before


# --- states that are refused -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "setting",
    [
        "load.mass=4",
        "solver.accuracy=1e-7",
        "film.initial_film=1e-6",
        "output.stride=2",
        "film.law=piezo-viscous",
    ],
)
def test_resume_refuses_another_scene(setting: str, run, scene_text, tmp_path: Path) -> None:
    """The key that changed is named, and nothing of the earlier run is touched."""
    results = solved(run, tmp_path, canonical(scene_text))
    assert_resume_is_refused(run, results, "--set", setting, word=setting.partition("=")[0])


def test_resume_refuses_a_scene_that_lost_a_key(run, scene_text, tmp_path: Path) -> None:
    results = solved(run, tmp_path, canonical(scene_text), "--set", "film.initial_film=1e-6")
    assert_resume_is_refused(run, results, word="film.initial_film")


def test_resume_refuses_a_window_that_began_before_the_state(run, scene_text, tmp_path: Path) -> None:
    """The state stands at period 44, where the window of 60 periods began; that of 59 began at 43."""
    results = solved(run, tmp_path, canonical(scene_text))
    assert_resume_is_refused(run, results, "--set", "solver.periods=59", word="is at period 44")


def solved(run, folder: Path, text: str, *options: str) -> Path:
    """Results of a scene."""
    (folder / "scene.nml").write_text(text)
    assert run(*options, "scene.nml", cwd=folder).returncode == 0
    return folder / "results"


def assert_resume_is_refused(run, results: Path, *options: str, word: str) -> None:
    """The reason holds the word, and the files of the earlier run stay as they are."""
    before = contents(results)
    ended = run("--resume", *options, "scene.nml", cwd=results.parent)
    assert ended.returncode == 2
    assert word in ended.stderr
    assert contents(results) == before


@pytest.mark.parametrize("method", METHODS)
def test_resume_refuses_the_state_of_an_earlier_version(method: str, run, scene_text, tmp_path: Path) -> None:
    """A state that lacks what a run is carried on       from is reported from one that holds it."""
    (tmp_path / "scene.nml").write_text(canonical(scene_text, **solver_of(method)))
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    path = tmp_path / "results" / "scene.state"
    state = package.read(path)
    names = list(state.columns)[:7]
    assert names[0] == "periods" and names[-1] == "cuts"
    columns = [(name, state.units[name]) for name in names]
    reported = {"input_text": state.input_text, "program_version": state.program_version}
    write_result(path, columns, [[state[name][0] for name in names]], **reported)
    before = {file.name: digest(file) for file in path.parent.iterdir()}
    ended = run("--resume", "--set", "solver.periods=90", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert "was kept by another version of rattle; --overwrite instead of --resume" in ended.stderr
    assert {file.name: digest(file) for file in path.parent.iterdir()} == before


def test_resume_needs_the_series_of_the_scene(run, scene_text, tmp_path: Path) -> None:
    """A lost series, or one of another scene in its place, is reported before anything is written."""
    (tmp_path / "scene.nml").write_text(canonical(scene_text))
    assert run("scene.nml", cwd=tmp_path).returncode == 0
    assert run("--output", "other", "--set", "load.mass=4", "scene.nml", cwd=tmp_path).returncode == 0
    series = tmp_path / "results" / "scene.rattle"
    series.unlink()
    ended = run("--resume", "--set", "solver.periods=90", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2 and "scene.rattle cannot be read" in ended.stderr
    assert not series.exists()
    series.write_bytes((tmp_path / "other" / "scene.rattle").read_bytes())
    ended = run("--resume", "--set", "solver.periods=90", "scene.nml", cwd=tmp_path)
    assert ended.returncode == 2 and "load.mass" in ended.stderr
