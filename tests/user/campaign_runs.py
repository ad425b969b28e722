"""Campaigns that the tests run: their input, their result, its bytes."""

from __future__ import annotations

from pathlib import Path

BASE = {
    "scene": {"task": "'campaign'"},
    "solver": {
        "steps_per_period": None,
        "method": None,
        "periods": "60",
        "accuracy": "1e-6",
        "until": "'steady'",
    },
    "spectrum": {"periods": "8"},
}


def grid(scene_text, first: int, second: int, **changes: dict) -> str:
    """A campaign over two keys."""
    campaign = {
        "vary": "'load.force_amplitude', 'kinematics.entrainment_speed'",
        "scale": "'linear', 'logarithmic'",
        "first": "5.0, 0.5",
        "last": "400.0, 20.0",
        "count": f"{first}, {second}",
        "samples_per_period": "64",
    }
    campaign.update(changes.pop("campaign", {}))
    return scene_text(**{**BASE, **changes}, campaign=campaign)


def solve(
    run, folder: Path, *options: object, name: str = "whole", code: int = 0, **identity: object
) -> Path:
    ended = run("--output", name, *options, "scene.nml", cwd=folder, timeout=600.0, **identity)
    assert ended.returncode == code, ended.stderr
    return folder / name / "scene.rattle"
