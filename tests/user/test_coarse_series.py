"""Impacts that no equidistant samples follow: series, figures, CSV and summary agree, or say why not."""

from __future__ import annotations

import csv
from pathlib import Path

import drawn
import numpy as np
import pytest
from campaign_runs import BASE
from outcomes import summary_of
from reported import counted
from script_calls import call_script

import rattle as package
from rattle.figures import histories, spectra, style
from rattle.verdict import classify

IMPACT = {
    "load": {"force_amplitude": "700", "frequency": "15"},
    "solver": {
        "method": "'taylor'",
        "steps_per_period": None,
        "accuracy": "1e-8",
        "samples_per_period": "512",
        "periods": "12",
    },
    "spectrum": {"periods": "2"},
}


@pytest.fixture
def impact(run, scene_text, tmp_path: Path):
    """A result and its summary."""

    def solve(**changes: dict[str, str]):
        (tmp_path / "impact.nml").write_text(scene_text(**(IMPACT | changes)))
        done = run("--verbose", "impact.nml", cwd=tmp_path)
        assert done.returncode == 0, done.stdout + done.stderr
        folder = tmp_path / "results"
        return package.read(folder / "impact.rattle"), summary_of(folder / "impact.summary.nml"), done.stdout

    return solve


@pytest.mark.parametrize("until", ["'periods'", "'steady'"])
def test_extremes_of_the_summary_stand_in_the_series(until: str, impact) -> None:
    """Both ways to end a run; the samples alone miss the impact by powers of ten."""
    columns = "'time', 'film_thickness', 'squeeze_velocity', 'acceleration', 'film_load', 'applied_force'"
    result, summary, _ = impact(
        solver=IMPACT["solver"] | {"until": until, "periods": "40"}, output={"columns": columns}
    )
    assert result.coarse and summary["series_coarse"]
    for column, key in [
        ("film_thickness", "film"),
        ("squeeze_velocity", "velocity"),
        ("acceleration", "acceleration"),
    ]:
        assert result.extremes[column].min() == pytest.approx(summary[f"{key}_minimum"], rel=1e-12)
        assert result.extremes[column].max() == pytest.approx(summary[f"{key}_maximum"], rel=1e-12)
    assert result["acceleration"].max() < 1e-3 * summary["acceleration_maximum"]
    load = 3.0 * (result.extremes["acceleration"] + 9.80665) + result.extremes["applied_force"]
    assert result.extremes["film_load"] == pytest.approx(load, rel=1e-12)
    # They are states of the window, in the order of time.
    times = result.extremes["time"]
    assert (times[1:] > times[:-1]).all()
    end = result["time"][-1]
    assert end - summary["window_periods"] / 15.0 <= times[0] and times[-1] <= end * (1.0 + 1e-12)


# So few harmonics that more samples find them all.
SMALL = {"force_amplitude": "150"}


def test_log_says_what_the_samples_miss(impact) -> None:
    """How many harmonics there are at least, and what the model cannot mean."""
    _, summary, reported = impact()
    assert "at least 40 harmonics" in reported and summary["harmonic_count_is_bound"]
    assert not summary["harmonic_distortion_is_bound"] and summary["sampling_sufficient"]
    assert summary["model_limit"] == "too_wide_and_narrow"
    assert "beyond a tenth of the radius" in reported and "below 1 nm" in reported


def test_number_of_samples_that_is_named_does(impact) -> None:
    """With as many samples as the summary names the series is fine, and the harmonics are the same."""
    _, coarse, reported = impact(load=SMALL, solver=IMPACT["solver"] | {"samples_per_period": "64"})
    assert coarse["series_coarse"] and not coarse["harmonics_by_integrals"]
    assert "series_coarse" not in reported  # as no extreme is missed
    samples = coarse["samples_per_period"]
    result, fine, _ = impact(
        load=SMALL, solver=IMPACT["solver"] | {"samples_per_period": str(samples)}, output={"overwrite": "t"}
    )
    assert not fine["series_coarse"] and not result.coarse
    assert fine["harmonics"] == pytest.approx(coarse["harmonics"], rel=1e-12)
    assert fine["acceleration_maximum"] == coarse["acceleration_maximum"]
    assert fine["model_limit"] == "within"


def test_newmark_says_how_many_steps_would_do(impact) -> None:
    """Its steps are its samples: too few of them are no verification."""
    newmark = {"method": "'newmark'", "steps_per_period": "64", "tolerance": "1e-14", "periods": "40"}
    result, summary, reported = impact(load={}, solver=newmark)
    assert result.coarse and summary["series_coarse"] and not summary["sampling_sufficient"]
    assert summary["verification"] == "uncertain"
    assert "solver.steps_per_period" in reported
    assert summary["harmonic_count_is_bound"] and summary["harmonic_distortion_is_bound"]
    assert len(result.extremes["time"]) == 0


def test_export_has_the_rows_of_the_extremes(impact, tmp_path: Path) -> None:
    """In the order of time."""
    result, summary, _ = impact()
    done = call_script("export.py", str(result.path), "--output", str(tmp_path / "impact.csv"))
    assert done.returncode == 0, done.stderr
    with (tmp_path / "impact.csv").open(encoding="utf-8") as stream:
        rows = list(csv.reader(line for line in stream if not line.startswith("#")))
    heads = [head.split("[")[0].strip() for head in rows[0]]
    times = [float(row[heads.index("time")]) for row in rows[1:]]
    assert times == sorted(times) and len(times) == len(result["time"]) + len(result.extremes["time"])
    assert max(float(row[heads.index("acceleration")]) for row in rows[1:]) == summary["acceleration_maximum"]


def test_samples_that_are_too_few_carry_no_class(impact) -> None:
    """Neither the script nor the figure judges them."""
    result, _, _ = impact()
    with pytest.raises(package.ResultError, match="coarser than its motion"):
        classify(result)
    done = call_script("classify.py", str(result.path))
    assert done.returncode != 0 and "coarser than its motion" in done.stderr
    figure = spectra.draw_acceleration([result], ["impact"], None)
    assert "class" not in drawn.all_words(figure)


def harmonics_drawn(figure) -> list[np.ndarray]:
    """Heights at whole multiples of the frequency, by panel; there are no others."""
    panels = []
    for axes in figure.axes:
        places, heights = np.hstack(drawn.bars(axes))
        assert places.tolist() == list(range(1, 41))
        panels.append(heights)
    return panels


def test_figure_10_draws_the_lines_of_the_summary(impact) -> None:
    """They are integrals over the steps here; those of the samples miss 93 in 100 of the second harmonic."""
    result, summary, _ = impact()
    with style.house_style():
        figure = spectra.draw_acceleration([result], ["impact"], None)
    for heights in harmonics_drawn(figure):
        assert heights.tolist() == summary["harmonics"]
    # From 20 dB below 1 % of the first to 3 times the largest.
    assert figure.axes[0].get_ylim() == pytest.approx((1e-3 * 290.75366, 3.0 * 290.75366), rel=1e-6)
    assert drawn.rules(figure.axes[0], "y") == [0.01 * summary["harmonics"][0]]
    assert "too few samples" not in drawn.all_words(figure)
    again = spectra.draw_acceleration([result], ["impact"], 2)
    assert harmonics_drawn(again)[0].tolist() == summary["harmonics"]


def test_harmonics_behind_those_of_the_summary_are_those_of_samples_that_give_these(impact) -> None:
    """Of twice the samples that are called too few; the first 40 stay those of the summary."""
    result, summary, _ = impact(load=SMALL, solver=IMPACT["solver"] | {"samples_per_period": "64"})
    ratio, amplitude = spectra.prolonged(summary, result)
    assert amplitude[1:].tolist() == summary["harmonics"]  # 64 samples resolve no more
    fine, reported, _ = impact(
        load=SMALL, solver=IMPACT["solver"] | {"samples_per_period": "1024"}, output={"overwrite": "t"}
    )
    ratio, amplitude = spectra.prolonged(reported, fine)
    _, by_samples = spectra.column_spectrum(fine, "acceleration", 1)
    known = len(reported["harmonics"]) + 1
    assert ratio.size == 1024 // 10 > known
    assert amplitude[1:known].tolist() == reported["harmonics"]
    assert amplitude[known:].tolist() == by_samples[known : ratio.size].tolist()


def test_figure_10_draws_harmonics_of_more_samples(impact) -> None:
    result, summary, _ = impact(load=SMALL, solver=IMPACT["solver"] | {"samples_per_period": "64"})
    with style.house_style():
        figure = spectra.draw_acceleration([result], ["impact"], None)
        both = spectra.draw_acceleration([result, result], ["one", "two"], None)
    assert harmonics_drawn(figure)[0].tolist() == summary["harmonics"]
    assert drawn.legend_words(both) == ["one, by its summary", "two, by its summary"]
    for axes in both.axes:
        for _, heights in drawn.bars(axes):
            assert heights.tolist() == summary["harmonics"]


@pytest.mark.parametrize("lacking", ["summary", "window", "better harmonics"])
def test_figure_10_says_where_no_better_lines_are_known(lacking: str, impact) -> None:
    """Without the summary, of another window, and of Newmark's method, whose steps are its samples."""
    newmark = {"method": "'newmark'", "steps_per_period": "64", "tolerance": "1e-14", "periods": "40"}
    changes = {"load": {}, "solver": newmark} if lacking == "better harmonics" else {}
    result, _, _ = impact(**changes)
    if lacking == "summary":
        result.summary_path.unlink()
    window = 1 if lacking == "window" else None
    with style.house_style():
        figure = spectra.draw_acceleration([result], ["impact"], window)
        both = spectra.draw_acceleration([result, result], ["one", "two"], window)
    words = "too few samples: these harmonics are those of the samples"
    assert words in drawn.all_words(figure).splitlines()
    assert "samples" not in figure.axes[0].get_title(loc="left")
    assert drawn.legend_words(both) == ["one, too few samples", "two, too few samples"]


def test_figure_8_shows_the_impact_of_every_period(impact) -> None:
    """The window holds the extremes of one period alone; the others repeat it."""
    result, summary, _ = impact(solver=IMPACT["solver"] | {"periods": "20"}, spectrum={"periods": "8"})
    with style.house_style():
        (axes,) = histories.draw_acceleration([result], ["impact"], 4).axes
    time, values = max(drawn.curves(axes), key=lambda curve: curve[0].size)
    high = values == summary["acceleration_maximum"]
    assert np.floor(time[high] * 0.015).tolist() == [0.0, 1.0, 2.0, 3.0]
    assert np.diff(time[high]) == pytest.approx(1e3 / 15.0, rel=1e-6)
    assert axes.get_ylim()[1] > summary["acceleration_maximum"]
    assert "samples" not in drawn.all_words(axes.figure)  # as nothing is missing


def test_check_names_films_that_the_model_cannot_mean(run, scene_text, tmp_path: Path) -> None:
    """A start beyond a tenth of the radius is known before anything runs."""
    (tmp_path / "wide.nml").write_text(scene_text(film={"initial_film": "2e-3"}))
    reported = run("--check", "wide.nml", cwd=tmp_path)
    assert reported.returncode == 0 and "beyond a tenth of the radius" in reported.stdout
    (tmp_path / "plain.nml").write_text(scene_text())
    assert "model_limit" not in run("--check", "plain.nml", cwd=tmp_path).stdout


def test_campaigns_and_sweeps_count_what_the_model_cannot_mean(run, scene_text, tmp_path: Path) -> None:
    """In the log, and row by row."""
    campaign = {
        "vary(1)": "'load.frequency'",
        "scale(1)": "'linear'",
        "first(1)": "15",
        "last(1)": "600",
        "count(1)": "2",
    }
    changes = BASE | {"load": {"force_amplitude": "700"}}
    text = scene_text(**changes, campaign=campaign)
    (tmp_path / "map.nml").write_text(text)
    reported = run("map.nml", cwd=tmp_path)
    assert reported.returncode == 0, reported.stdout + reported.stderr
    result = package.read(tmp_path / "results" / "map.rattle")
    beyond = int((result["model_limit"] > 0).sum())
    assert result["model_limit"][0] == 3 and beyond >= 1
    scenes = "1 scene" if beyond == 1 else f"{beyond} scenes"
    assert f"warning          {scenes} outside the range of the model" in reported.stdout
    assert (result["sampling_sufficient"] == 1).all() and "not resolved" not in reported.stdout
    # The true class and first harmonic of the impact, by an independent solver.
    assert result["rattle_class"][0] == 3 and result["harmonic_1"][0] == pytest.approx(290.75366, rel=1e-6)
    sweep = {"key": "'frequency'", "first": "15", "last": "20", "count": "2"}
    solver = {"steps_per_period": None, "method": None, "periods": "100"}
    text = scene_text(scene={"task": "'sweep'"}, load={"force_amplitude": "700"}, solver=solver, sweep=sweep)
    (tmp_path / "sweep.nml").write_text(text)
    reported = run("sweep.nml", cwd=tmp_path)
    assert reported.returncode == 0, reported.stdout + reported.stderr
    assert "motions outside the range of the model" in reported.stdout
    swept = package.read(tmp_path / "results" / "sweep.rattle")
    assert swept["acceleration_maximum"][0] == pytest.approx(9.082065e10, rel=1e-6)


def test_a_film_that_grows_too_wide_and_never_too_thin_counts(run, scene_text, tmp_path: Path) -> None:
    sweep = {"key": "'frequency'", "first": "80", "last": "200", "count": "4"}
    changes = {"load": {"force_amplitude": "700"}, "lubricant": {"viscosity": "3.0"}}
    solver = {"steps_per_period": None, "method": None, "periods": "100"}
    text = scene_text(scene={"task": "'sweep'"}, solver=solver, sweep=sweep, **changes)
    (tmp_path / "sweep.nml").write_text(text)
    reported = run("sweep.nml", cwd=tmp_path)
    assert reported.returncode == 0, reported.stderr
    swept = package.read(tmp_path / "results" / "sweep.rattle")
    wide = swept["film_maximum"] > 0.1 * 0.0127
    assert (swept["film_minimum"] > 1e-9).all() and 0 < wide.sum() < wide.size
    warned = f"warning          {counted(int(wide.sum()), 'motion')} outside the range of the model"
    assert warned in reported.stdout
    assert summary_of(tmp_path / "results" / "sweep.summary.nml")["motions_failed"] == 0
