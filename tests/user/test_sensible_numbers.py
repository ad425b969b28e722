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
