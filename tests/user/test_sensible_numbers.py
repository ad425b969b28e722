"""Numbers that no engineer can mean: millimetres for metres, mPa s for Pa s."""

from __future__ import annotations

from pathlib import Path

import pytest
from campaign_runs import grid

ODD = [
    ("contact", "radius", "7.786", "7.786 m", "1.0E-4 to 1.0 m"),
    ("contact", "length", "18.25", "18.25 m", "1.0E-4 to 1.0 m"),
    ("lubricant", "viscosity", "23.7", "23.7 Pa s", "1.0E-4 to 20.0 Pa s"),
    ("load", "gravity", "9806.65", "9806.65 m/s2", "0.0 to 100.0 m/s2"),
]


@pytest.mark.parametrize(("group", "key", "value", "shown", "sensible"), ODD, ids=lambda item: str(item)[:20])
def test_odd_number_is_taken_with_a_warning(
    group: str, key: str, value: str, shown: str, sensible: str, run, scene_text, tmp_path: Path
) -> None:
    """The warning names place, key and range, in --check and in the log; the scene stays valid."""
    text = scene_text(**{group: {key: value}})
    (tmp_path / "scene.nml").write_text(text)
    line = next(n for n, line in enumerate(text.splitlines(), 1) if line.startswith(f"   {key} ="))
    warning = f"warning: scene.nml:{line}: &{group} {key} = {shown} is not what machines have ({sensible})"
    checked = run("--check", "scene.nml", cwd=tmp_path)
    assert checked.returncode == 0
    assert f"! {warning}" in checked.stdout and checked.stdout.count("is not what machines have") == 1
    run("--quiet", "scene.nml", cwd=tmp_path)
    assert f"  {warning}" in (tmp_path / "results" / "scene.log").read_text()


@pytest.mark.long
def test_sensible_numbers_have_no_warning(run, scene_text, repository: Path, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(scene_text())
    ready = sorted((repository / "input").glob("*.nml"))
    for path in [tmp_path / "scene.nml", *ready]:
        assert "is not what machines have" not in run("--check", path, cwd=tmp_path).stdout


def test_odd_number_of_a_campaign(run, scene_text, tmp_path: Path) -> None:
    (tmp_path / "scene.nml").write_text(grid(scene_text, 2, 2, contact={"radius": "7.786"}))
    checked = run("--check", "scene.nml", cwd=tmp_path)
    assert "! warning: scene.nml:2: &contact radius = 7.786 m" in checked.stdout
    assert run("--quiet", "--set", "contact.length=18", "scene.nml", cwd=tmp_path).returncode in (0, 1)
    log = (tmp_path / "results" / "scene.log").read_text()
    assert "&contact radius = 7.786 m" in log and "--set contact.length=18: &contact length = 18.0 m" in log


def warnings_of(run, folder: Path) -> list[str]:
    """Lines of --check that warn of numbers, which the log repeats; the scene stays valid."""
    checked = run("--check", "scene.nml", cwd=folder)
    assert checked.returncode == 0, checked.stderr
    lines = [
        line.removeprefix("! ") for line in checked.stdout.splitlines() if "not what machines have" in line
    ]
    assert run("--quiet", "scene.nml", cwd=folder).returncode in (0, 1)
    log = (folder / "results" / "scene.log").read_text()
    assert [line.strip() for line in log.splitlines() if "not what machines have" in line] == lines
    return lines


@pytest.mark.parametrize(
    ("key", "first", "last", "expected"),
    [
        (
            "frequency",
            "0.05",
            "100.0",
            ["&sweep first = 0.05 Hz is not what machines have for load.frequency (0.1"],
        ),
        (
            "frequency",
            "100.0",
            "2.0e5",
            ["&sweep last = 200000.0 Hz is not what machines have for load.frequency"],
        ),
        ("force_amplitude", "2.0e6", "3.0e6", ["&sweep first = 2.0E6 N", "&sweep last = 3.0E6 N"]),
        (
            "entrainment_speed",
            "1.0",
            "400.0",
            ["&sweep last = 400.0 m/s is not what machines have for kinematics.entr"],
        ),
        ("steady_force", "100.0", "200.0", []),
    ],
)
def test_odd_ends_of_a_sweep(
    key: str, first: str, last: str, expected: list, run, scene_text, tmp_path: Path
) -> None:
    text = scene_text(
        scene={"task": "'sweep'"},
        solver={"method": None, "steps_per_period": None},
        sweep={"key": f"'{key}'", "first": first, "last": last, "count": "2", "turn": ".false."},
    )
    (tmp_path / "scene.nml").write_text(text)
    places = {end: text[: text.index(f"   {end} =")].count("\n") + 1 for end in ("first", "last")}
    found = warnings_of(run, tmp_path)
    assert len(found) == len(expected)
    for line, start in zip(found, expected, strict=True):
        assert line.startswith(f"warning: scene.nml:{places[start.split()[1]]}: {start}")


def test_odd_ranges_of_a_campaign(run, scene_text, tmp_path: Path) -> None:
    """Ends of ranges and lists of values, each by its own key, with how many numbers of a list are odd."""
    text = grid(
        scene_text,
        2,
        2,
        campaign={
            "vary": "'contact.radius', 'lubricant.viscosity', 'load.mass', 'spectrum.quiet_limit'",
            "scale": "'linear', 'linear', 'linear', 'linear'",
            "first": "1.0e-5, 0.01, 1.0, 0.1",
            "last": "7.786, 23.7, 2.0, 0.2",
            "count": "2, 2, 2, 2",
        },
    )
    (tmp_path / "scene.nml").write_text(text)
    at = {name: text[: text.index(f"   {name} =")].count("\n") + 1 for name in ("first", "last")}
    assert [line.split(" is not")[0] for line in warnings_of(run, tmp_path)] == [
        f"warning: scene.nml:{at['first']}: &campaign first(1) = 1.0E-5 m",
        f"warning: scene.nml:{at['last']}: &campaign last(1) = 7.786 m",
        f"warning: scene.nml:{at['last']}: &campaign last(2) = 23.7 Pa s",
    ]


def test_odd_values_of_a_campaign(run, scene_text, tmp_path: Path) -> None:
    text = grid(
        scene_text,
        2,
        2,
        campaign={
            "vary": "'load.mass', 'lubricant.viscosity'",
            "scale": None,
            "first": None,
            "last": None,
            "count": None,
            "values(:, 1)": "3.0, 4000.0, 5.0, 6000.0",
            "values(:, 2)": "0.1, 0.2",
        },
    )
    (tmp_path / "scene.nml").write_text(text)
    (found,) = warnings_of(run, tmp_path)
    assert (
        ": &campaign values(:, 1): 4000.0 kg is not what machines have for load.mass (1.0E-4 to 1000.0 kg)"
        in found
    )
    assert "the first of 2 such numbers among 4;" in found


def test_odd_columns_of_a_table(run, scene_text, tmp_path: Path) -> None:
    """Each column with an odd number is named, with the line of the first of them and how many there are."""
    rows = [
        f"{mass},0.2,{speed}" for mass, speed in [(3, 1), (3, 2), (3000, 3), (3, 4), (4000, 5), (5000, 6)]
    ]
    table = (
        "load.mass,lubricant.viscosity,kinematics.entrainment_speed\n" + "\n".join(rows) + "\n7,0.2,1000\n"
    )
    (tmp_path / "odd.csv").write_text(table)
    keys = ("vary", "scale", "first", "last", "count")
    text = grid(scene_text, 2, 2, campaign={**dict.fromkeys(keys), "csv": "'odd.csv'"})
    (tmp_path / "scene.nml").write_text(text)
    mass, speed = warnings_of(run, tmp_path)
    assert mass.startswith(
        "warning: odd.csv:4: column 1: 3000.0 kg is not what machines have for load.mass ("
    )
    assert "the first of 3 such numbers among 7;" in mass
    assert speed.startswith(
        "warning: odd.csv:8: column 3: 1000.0 m/s is not what machines have for kinematics.entr"
    )
    assert "the only such number among 7;" in speed
