"""Keys, columns and summaries by their names of the version before: read for one version, with a warning."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from conftest import Run, SceneText
from outcomes import summary_of
from result_writer import result_bytes

import rattle
from rattle.former_names import FORMER_KEYS, FORMER_NAMES

OLD_SPECTRUM = {
    "certify": ".true.",
    "certificate_tolerance": "0.02",
    "line_threshold": "0.02",
    "idle_lines": "15",
}


def told(text: str) -> set[tuple[str, str]]:
    """Which names a log calls former ones, and how they are called now."""
    return set(re.findall(r"warning: (?:--set )?\S+: (\S+) is called (\S+) now", text))


def test_former_keys_mean_the_present_ones(run: Run, scene_text: SceneText, tmp_path: Path) -> None:
    names = FORMER_KEYS["spectrum"]
    assert OLD_SPECTRUM.keys() == names.keys()
    scene = {"solver": {"method": None, "steps_per_period": None, "periods": "60"}}
    (tmp_path / "old.nml").write_text(scene_text(**scene, spectrum={"periods": "2"} | OLD_SPECTRUM))
    present = {names[key]: value for key, value in OLD_SPECTRUM.items()}
    (tmp_path / "new.nml").write_text(scene_text(**scene, spectrum={"periods": "2"} | present))
    old, new = (run(name, cwd=tmp_path) for name in ("old.nml", "new.nml"))
    assert (old.returncode, new.returncode) == (0, 0)
    assert told(old.stdout) == set(names.items())
    assert told(new.stdout) == set()
    results = [tmp_path / "results" / name for name in ("old.rattle", "new.rattle")]
    assert np.array_equal(*(rattle.read(path)["acceleration"] for path in results))
    summaries = [rattle.read_summary(path.with_suffix(".summary.nml")) for path in results]
    for key in ("verification", "harmonic_count", "rattle_class"):
        assert summaries[0][key] == summaries[1][key]
    assert not FORMER_NAMES.keys() & summary_of(tmp_path / "results" / "old.summary.nml").keys()
    header = rattle.read(results[0]).input_text
    assert not [key for key in names if re.search(rf"\b{key}\b", header)]


def test_a_former_key_beside_its_present_one_is_set_twice(
    run: Run, scene_text: SceneText, tmp_path: Path
) -> None:
    (tmp_path / "both.nml").write_text(scene_text(spectrum={"idle_lines": "15", "idle_harmonics": "15"}))
    ended = run("both.nml", cwd=tmp_path)
    assert ended.returncode == 2
    assert "this key is set in line" in ended.stderr


def test_settings_and_words_take_former_names(run: Run, scene_text: SceneText, tmp_path: Path) -> None:
    campaign = {
        "scene": {"task": "'campaign'"},
        "solver": {"method": None, "steps_per_period": None, "periods": "40"},
        "campaign": {
            "vary": "'spectrum.idle_lines'",
            "first": "5",
            "last": "30",
            "count": "2",
            "record": "'rattle_class', 'line_count', 'certified'",
        },
    }
    (tmp_path / "old.nml").write_text(scene_text(**campaign))
    ended = run("old.nml", "--set", "spectrum.line_threshold=0.02", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert {"line_threshold", "spectrum.idle_lines"} <= {old for old, _ in told(ended.stdout)}
    result = rattle.read_campaign(tmp_path / "results" / "old.rattle")
    assert {"spectrum.idle_harmonics", "harmonic_count", "verified"} <= set(result.names)
    with pytest.warns(FutureWarning, match="certified is called verified now"):
        assert np.array_equal(result["certified"], result["verified"])


def test_results_of_the_version_before_have_their_present_names(tmp_path: Path) -> None:
    path = tmp_path / "old.rattle"
    text = "&spectrum\n   idle_lines = 20\n/\n"
    path.write_bytes(result_bytes([("value", "m"), ("line_count", "-")], [[1.0, 7.0]], input_text=text))
    result = rattle.read(path)
    assert result.names == ("value", "harmonic_count")
    assert result.value("spectrum", "idle_harmonics") == 20
    with pytest.warns(FutureWarning, match="line_count is called harmonic_count now"):
        assert result["line_count"] == [7.0]


def test_summaries_of_the_version_before_have_their_present_names(tmp_path: Path) -> None:
    path = tmp_path / "old.summary.nml"
    path.write_text("&summary\n  line_count = 30\n  certificate = 'certified'\n  certificate_text = ''\n/\n")
    summary = rattle.read_summary(path)
    assert (summary["harmonic_count"], summary["verification"]) == (30, "verified")
    with pytest.warns(FutureWarning, match="certificate is called verification now"):
        assert summary["certificate"] == "verified"
    with pytest.raises(KeyError):
        summary["lines_of_another_kind"]
