"""A tooth that no force shakes is quiet, whatever solves it: what moves it is the error of the solution."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

import rattle as package

METHODS = ["newmark", "taylor"]
FILMS = [(law, model) for law in ("iso-viscous", "piezo-viscous") for model in ("published", "reynolds")]

# From light to heavy damping, from stiff to slack, every film that a steady force can press.
CAMPAIGN = """&scene task = 'campaign' name = 'rest' /
&contact radius = 0.0127 length = 0.010 /
&lubricant viscosity = 0.3 pressure_viscosity = 1.0e-9 /
&kinematics entrainment_speed = 1.905 /
&load mass = 3.0 steady_force = 199.2 force_amplitude = 0.0 frequency = 600.0 /
&film law = 'iso-viscous' /
&solver periods = 40 /
&campaign
   sample = 'sobol' size = 256 allow_invalid = .true.
   vary(1) = 'kinematics.entrainment_speed' scale(1) = 'logarithmic' first(1) = 0.001 last(1) = 100.0
   vary(2) = 'load.mass' scale(2) = 'logarithmic' first(2) = 0.001 last(2) = 20.0
   vary(3) = 'load.frequency' scale(3) = 'logarithmic' first(3) = 5.0 last(3) = 5000.0
   vary(4) = 'load.steady_force' scale(4) = 'logarithmic' first(4) = 0.1 last(4) = 5000.0
   vary(5) = 'contact.length' scale(5) = 'logarithmic' first(5) = 0.0001 last(5) = 0.05
   record = 'rattle_class'
/
&output directory = 'results' /
"""


@pytest.mark.parametrize(("law", "model"), FILMS)
@pytest.mark.parametrize("method", METHODS)
def test_scene_at_rest_is_quiet(method: str, law: str, model: str, run, scene_text, tmp_path: Path) -> None:
    accuracies = [{}] if method == "newmark" else [{"accuracy": word} for word in ("1e-4", "1e-8", "1e-11")]
    for number, accuracy in enumerate(accuracies):
        folder = tmp_path / str(number)
        assert amplitude_scene(run, scene_text, folder, "0.0", method, law, model, **accuracy) == {
            "rattle_class": "quiet",
            "verification": "verified",
        }


@pytest.mark.parametrize("method", METHODS)
def test_faint_motion_has_its_line(method: str, run, scene_text, tmp_path: Path) -> None:
    """A force of less than a ten-thousandth of the static load moves the tooth by more than the errors."""
    for law in ("iso-viscous", "piezo-viscous"):
        found = amplitude_scene(run, scene_text, tmp_path / law, "0.01", method, law, "published")
        assert found == {"rattle_class": "quiet", "harmonic_count": 1, "verification": "verified"}


def amplitude_scene(
    run, scene_text, folder: Path, amplitude: str, method: str, law: str, model: str, **solver: str
) -> dict:
    """Class, lines and verification of the scene of the paper under a force of some amplitude [N]."""
    folder.mkdir()
    text = scene_text(
        lubricant={"pressure_viscosity": "1.0e-9" if model == "reynolds" else "2.0e-8"},
        load={"force_amplitude": amplitude},
        film={"law": f"'{law}'", "model": f"'{model}'"},
        solver={
            "method": f"'{method}'",
            "steps_per_period": "512" if method == "newmark" else None,
            "periods": "60",
            **solver,
        },
        spectrum={"periods": "16"},
    )
    (folder / "scene.nml").write_text(text)
    assert run("scene.nml", cwd=folder).returncode == 0
    summary = summary_of(folder / "results" / "scene.summary.nml")
    # Without motion nothing is said of lines.
    return {key: summary[key] for key in ("rattle_class", "harmonic_count", "verification") if key in summary}


@pytest.mark.long
@pytest.mark.parametrize("accuracy", ["1e-3", "1e-6", "1e-8", "1e-11"])
@pytest.mark.parametrize(("law", "model"), FILMS)
def test_campaign_at_rest_is_quiet(law: str, model: str, accuracy: str, run, tmp_path: Path) -> None:
    (tmp_path / "rest.nml").write_text(CAMPAIGN)
    settings = [f"film.law={law}", f"film.model={model}", f"solver.accuracy={accuracy}"]
    run(*(word for setting in settings for word in ("--set", setting)), "rest.nml", cwd=tmp_path)
    campaign = package.read_campaign(tmp_path / "results" / "rest.rattle")
    solved = np.array(campaign["status"]) == 0
    assert np.count_nonzero(solved) > 128
    assert set(np.array(campaign["rattle_class"])[solved]) == {1}
