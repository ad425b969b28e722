"""The short report of the terminal: the verdict first, few lines, nothing that log or summary do not hold."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from test_thresholds import threshold_text

import rattle

MOST_LINES, WIDEST = 15, 110
LABEL = slice(2, 19)
ALIGNED = r"  \S.{15} \S"
# Newmark's method of 32 steps a period, whose false harmonics this input is about.
COARSE_ON_PURPOSE = "creep_false_harmonic"
READY = (
    "creep",
    COARSE_ON_PURPOSE,
    "creep_period_two",
    "drive_rattle",
    "elastohydrodynamic",
    "engine_cycle",
    "gearbox",
    "idle",
    "loose_gear",
    "loose_pair",
    "rattling_gear",
    "two_motions",
)
LABELS = ("verdict", "operating point", "film force", "acceleration", "impacts", "film", "at rest", "files")
LABELS_IN_A_TABLE = ("verdict", "impacts", "motions", "files")
NUMBER = re.compile(r"(?<![\w.])-?\d+\.?\d*(?:E-?\d+)?(?![\w.]*\.nml)")


@pytest.fixture(scope="module", params=READY)
def shown(request, run, repository: Path, tmp_path_factory) -> tuple[str, Path, list[list[str]]]:
    """A ready input, the folder of its results, and the lines of each scene."""
    folder = tmp_path_factory.mktemp("short")
    ended = run(repository / "input" / f"{request.param}.nml", "--output", "out", cwd=folder)
    assert ended.returncode == 0, ended.stderr
    scenes = re.split(r"^(?=rattle )", ended.stdout, flags=re.M)[1:]
    return request.param, folder / "out", [scene.splitlines() for scene in scenes]


def labels_of(lines: list[str]) -> list[str]:
    return [line[LABEL].rstrip() for line in lines[1:]]


def test_a_scene_has_few_aligned_lines_the_verdict_first(shown) -> None:
    _, _, scenes = shown
    for lines in scenes:
        assert len(lines) <= MOST_LINES and max(map(len, lines)) <= WIDEST, "\n".join(lines)
        if ", gearbox " in lines[0]:
            continue
        assert all(re.match(ALIGNED, line) for line in lines[1:])
        labels = labels_of(lines)
        wanted = LABELS_IN_A_TABLE if len(scenes) > 1 else LABELS
        assert labels[0] == "verdict" and [label for label in labels if label in wanted] == list(wanted)
        assert "warning" not in labels[: labels.index("files")]


def test_each_number_stands_in_log_or_summary(shown) -> None:
    _, folder, scenes = shown
    for lines in scenes:
        name = re.match(r"rattle \S+ (?:scene|gearbox) ([^:]+)", lines[0])[1]
        log = (folder / f"{name}.log").read_text()
        summary = rattle.read_summary(folder / f"{name}.summary.nml")
        known = {number for number in summary.values() if isinstance(number, int | float)}
        for line in lines:
            if line.startswith(("  files", "  warning", "  input")):
                continue
            for number in NUMBER.findall(line):
                found = number in NUMBER.findall(log) or any(
                    float(number) == pytest.approx(value, rel=5e-3) for value in known
                )
                assert found, (number, line)


def test_verbose_shows_the_log_which_has_more(shown, run, repository: Path, tmp_path: Path) -> None:
    name, _, scenes = shown
    source = repository / "input" / f"{name}.nml"
    ended = run(source, "--verbose", "--output", "out", cwd=tmp_path)
    first = re.match(r"rattle \S+ scene ([^:]+)", scenes[0][0])[1]
    log = (tmp_path / "out" / f"{first}.log").read_text()
    assert ended.stdout.startswith(log)
    summary = rattle.read_summary(tmp_path / "out" / f"{first}.summary.nml")
    # What the short report leaves out.
    for words in (
        summary["verdict_text"],
        summary["verification_text"],
        summary["motions_text"],
        "steps in ",
    ):
        assert words in log
    assert "steps in " not in "\n".join(scenes[0])


def test_the_log_file_does_not_depend_on_what_is_shown(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    logs = []
    for options in ((), ("--verbose",), ("--quiet",)):
        assert run("scene.nml", "--overwrite", *options, cwd=tmp_path).returncode == 0
        logs.append(re.sub(r"in \S+ s,", "", (tmp_path / "results" / "scene.log").read_text()))
    assert logs[0] == logs[1] == logs[2] and "warning: " in logs[0]


def test_files_named_in_one_line_are_there(shown) -> None:
    _, folder, scenes = shown
    for lines in scenes:
        (line,) = (line for line in lines if line.startswith("  files"))
        path, *ends = line[LABEL.stop :].split(", ")
        stem = path.removesuffix(".summary.nml")
        named = {f"{Path(stem).name}{end}" for end in (".summary.nml", *ends)}
        there = {file.name for file in folder.iterdir() if not file.name.endswith((".state", ".lock"))}
        others = {file for file in there if rattle_name(file) != Path(stem).name}
        assert path.startswith("out/") and named == there - others


def rattle_name(file: str) -> str:
    return re.sub(r"(\.motions|\.profiles)?\.(rattle|log)$|\.summary\.nml$", "", file)


def test_no_ready_input_has_too_few_samples(shown) -> None:
    name, _, scenes = shown
    assert any("series_coarse" in line for lines in scenes for line in lines) == (name == COARSE_ON_PURPOSE)


def test_a_series_that_misses_impacts_is_warned_of(run, repository: Path, tmp_path: Path) -> None:
    box = repository / "input" / "gearbox.nml"
    ended = run(box, "--set", "solver.samples_per_period=64", "--output", "out", cwd=tmp_path)
    assert ended.stdout.count("series_coarse: ") == 4
    assert ended.stdout.count("raise solver.samples_per_period\n") == 4


def test_many_warnings_take_few_lines(run, repository: Path, tmp_path: Path) -> None:
    """What is left over is counted, and the log has it."""
    text = (repository / "input" / "engine_cycle.nml").read_text()
    (tmp_path / "cycle.nml").write_text(text)
    (tmp_path / "engine_cycle.csv").write_bytes((repository / "input" / "engine_cycle.csv").read_bytes())
    ended = run("cycle.nml", "--set", "solver.samples_per_period=512", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    lines = ended.stdout.splitlines()
    assert len(lines) == MOST_LINES and lines[-1] == "  warning          3 more in results/cycle.log"
    log = (tmp_path / "results" / "cycle.log").read_text()
    assert "(law_contradicted)" in log and "series_coarse" in log and "signal " in log


def test_a_failed_scene_says_how_it_ended(run, scene_text, tmp_path: Path) -> None:
    film = {"law": "'piezo-viscous'", "model": "'reynolds'"}
    (tmp_path / "scene.nml").write_text(scene_text(load={"steady_force": "3e4"}, film=film))
    ended = run("scene.nml", cwd=tmp_path)
    assert ended.returncode == 1
    summary = rattle.read_summary(tmp_path / "results" / "scene.summary.nml")
    lines = ended.stdout.splitlines()
    assert lines[2] == f"  ended            {summary['status']} at t = 0 s"
    assert lines[3].strip() == summary["status_text"]


@pytest.mark.parametrize(
    ("name", "change", "labels"),
    (
        ("film", "points.profile_nodes=9", ["points", "files"]),
        ("sweep", "sweep.count=5", ["motions", "files"]),
        ("map", "campaign.count=4,4", ["scenes", "longest", "files"]),
        ("gearbox_orders", "campaign.count=2", ["scenes", "motions", "longest", "files"]),
        (
            "threshold",
            "threshold.count=5",
            ["scenes", "crossings", "width", "either side", "starts", "files"],
        ),
    ),
)
def test_tables_have_the_labels_of_scenes(
    run, repository: Path, tmp_path: Path, name, change, labels
) -> None:
    ended = run(
        repository / "input" / f"{name}.nml", "--set", change, "--output", tmp_path / "out", cwd=tmp_path
    )
    assert ended.returncode == 0, ended.stderr
    lines = [line for line in ended.stdout.splitlines() if " s left, " not in line]
    assert all(re.match(ALIGNED, line) for line in lines[1:]) and labels_of(lines) == labels, ended.stdout
    assert max(len(line.replace(str(tmp_path), "")) for line in lines[1:]) <= WIDEST


def test_thresholds_explain_themselves_in_the_log(rattle: Path, scene_text, tmp_path: Path) -> None:
    (tmp_path / "edge.nml").write_text(
        threshold_text(scene_text, threshold={"tolerance": "0.1", "count": "5"})
    )
    printed = {}
    for options in ((), ("--verbose",)):
        command = [rattle, "edge.nml", "--overwrite", *options]
        ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
        printed[options] = ended.stdout
        assert "places; two changes between neighbours" in (tmp_path / "results" / "edge.log").read_text()
    assert "places; two changes" in printed["--verbose",] and "places; two changes" not in printed[()]
