"""Every key that a campaign can vary, one by one: a row is the summary of the single scene with its value."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of

import rattle as package
from rattle.codes import CODES, FLAGS

RECORDED = (
    "impacts_per_period_drive",
    "film_minimum",
    "film_maximum",
    "acceleration_minimum",
    "acceleration_maximum",
    "velocity_minimum",
    "velocity_maximum",
    "load_maximum",
    "acceleration_rms",
    "crest_factor",
    "acceleration_kurtosis",
    "film_force_rms",
    "dissipated_energy",
    "dissipated_power",
    "model_limit",
    "steady_film",
    "natural_frequency",
    "damping_ratio",
    "harmonic_count",
    "harmonic_count_is_bound",
    "harmonic_distortion",
    "irregular_fraction",
    "reversals_per_period",
    "rattle_class",
    "film_regime",
    "law_contradicted",
    "alpha_p_maximum",
    "pressure_maximum",
    "deflection",
    "deflection_share",
    "stiffness_matters",
    "periods_solved",
    "sampling_sufficient",
)
# Two values of each key, neither of them that of the base, and a column that must differ between them.
KEYS = {
    "contact.radius": ("0.010", "0.015", "film_minimum"),
    "contact.radius_1": ("0.020", "0.030", "film_minimum"),
    "contact.radius_2": ("0.020", "0.030", "film_minimum"),
    "contact.damping_ratio": ("0.02", "0.2", "film_minimum"),
    "contact.length": ("0.009", "0.012", "film_minimum"),
    "contact.young_modulus": ("1.0e11", "3.0e11", "deflection"),
    "contact.poisson_ratio": ("0.1", "0.4", "deflection"),
    "contact.backlash": ("4.0e-6", "6.0e-6", "film_minimum"),
    "contact.stiffness": ("5.0e8", "2.0e9", "film_minimum"),
    "lubricant.viscosity": ("0.25", "0.35", "film_minimum"),
    "lubricant.pressure_viscosity": ("1.0e-8", "1.5e-8", "alpha_p_maximum"),
    "kinematics.entrainment_speed": ("1.5", "2.5", "film_minimum"),
    "kinematics.rolling_speed": ("3.0", "5.0", "film_minimum"),
    "kinematics.surface_speed_1": ("1.0", "3.0", "film_minimum"),
    "kinematics.surface_speed_2": ("1.0", "3.0", "film_minimum"),
    "load.mass": ("2.0", "4.0", "film_minimum"),
    "load.steady_force": ("150.0", "170.0", "film_minimum"),
    "load.force_amplitude": ("20.0", "50.0", "film_minimum"),
    "load.force_mean": ("-20.0", "30.0", "film_minimum"),
    "load.force_scale": ("0.25", "0.6", "film_minimum"),
    "load.frequency": ("500.0", "700.0", "film_minimum"),
    "load.gravity": ("0.0", "20.0", "film_minimum"),
    "film.initial_film": ("2.0e-6", "4.0e-6", "film_maximum"),
    "film.initial_velocity": ("-0.001", "0.002", "film_maximum"),
    "solver.accuracy": ("1.0e-2", "1.0e-4", "film_minimum"),
    "solver.periods": ("8", "12", "periods_solved"),
    "spectrum.periods": ("2", "4", "irregular_fraction"),
    "spectrum.harmonic_threshold": ("0.001", "0.1", "harmonic_count"),
    "spectrum.idle_harmonics": ("2", "30", "rattle_class"),
    "spectrum.quiet_limit": ("0.0001", "100.0", "rattle_class"),
    "spectrum.impact_limit": ("1.01", "1000.0", "impacts_per_period_drive"),
    "spectrum.irregular_limit": ("1.0e-13", "1.0", "rattle_class"),
}
# What the base of a key has beside that of all others. None: the key is left out.
FROM_START = {"film": {"initial_film": "3.0e-6"}, "solver": {"periods": "4"}}  # all periods are in the window
BASES = {
    "contact.damping_ratio": {"contact": {"stiffness": "1.0e9"}},
    "contact.radius_1": {"contact": {"radius": None, "radius_1": "0.025", "radius_2": "0.026"}},
    "contact.backlash": {"contact": {"backlash": "5.0e-6"}, "load": {"steady_force": "0.0"}},
    "contact.stiffness": {"contact": {"stiffness": "1.0e9"}},
    "kinematics.rolling_speed": {"kinematics": {"entrainment_speed": None, "rolling_speed": "3.8"}},
    "kinematics.surface_speed_1": {
        "kinematics": {"entrainment_speed": None, "surface_speed_1": "1.5", "surface_speed_2": "2.3"}
    },
    "load.force_mean": {"load": {"force_mean": "5.0"}},
    "film.initial_film": FROM_START,
    "film.initial_velocity": FROM_START,
    "spectrum.periods": FROM_START,
    "spectrum.irregular_limit": FROM_START,
    "spectrum.idle_harmonics": {"spectrum": {"quiet_limit": "0.001"}},
}
BASES["contact.radius_2"] = BASES["contact.radius_1"]
BASES["kinematics.surface_speed_2"] = BASES["kinematics.surface_speed_1"]
FILMS = {
    "published": {"law": "'iso-viscous'", "model": "'published'"},
    "exact": {"law": "'piezo-viscous'", "model": "'reynolds'"},
}
SOLVER = {"steps_per_period": None, "method": None, "periods": "10", "accuracy": "1e-8"}


def base(key: str, film: str, **solver: str) -> dict[str, dict[str, str | None]]:
    """The changes of the scene that is varied, so calm that 128 samples a period see every line."""
    changes = {
        "lubricant": {"pressure_viscosity": "1.2e-8"},
        "load": {"force_amplitude": "80.0"},
        "film": FILMS[film],
        "solver": SOLVER | solver,
        "spectrum": {"periods": "4"},
    }
    for group, more in BASES.get(key, {}).items():
        changes[group] = {**changes.get(group, {}), **more}
    return changes


def campaign_of(key: str, values: tuple[str, ...], film: str, scene_text) -> str:
    changes = base(key, film)
    changes["campaign"] = {
        "vary": f"'{key}'",
        "values(:, 1)": ", ".join(values),
        "samples_per_period": "128",
        "record": ", ".join(f"'{name}'" for name in dict.fromkeys((*RECORDED, "harmonics"))),
    }
    return scene_text(scene={"task": "'campaign'"}, **changes)


def shown(name: str, value: object) -> float:
    """A value of a summary as the number that stands in a row."""
    if name in CODES:
        return float({words: code for code, words in CODES[name].items()}[str(value).strip()])
    return float(value)


@pytest.mark.parametrize("film", FILMS)
@pytest.mark.parametrize("key", KEYS)
def test_a_row_is_the_single_scene_with_that_value(key, film, run, scene_text, tmp_path: Path) -> None:
    *values, differing = KEYS[key]
    (tmp_path / "many.nml").write_text(campaign_of(key, tuple(values), film, scene_text))
    ended = run("many.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    rows = package.read_campaign(tmp_path / "results" / "many.rattle")
    assert [float(value) for value in rows[key]] == [float(value) for value in values]
    assert rows[differing][0] != rows[differing][1]

    changes = base(key, film, samples_per_period="128")
    changes["spectrum"]["verify"] = ".false."
    (tmp_path / "one.nml").write_text(scene_text(**changes))
    for row, value in enumerate(values):
        ended = run("--overwrite", "--set", f"{key}={value}", "one.nml", cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        single = summary_of(tmp_path / "results" / "one.summary.nml")
        for name in RECORDED:
            if name not in single:
                assert np.isnan(rows[name][row]), name
            elif name in CODES or name in FLAGS or name.endswith(("_count", "_solved")):
                assert rows[name][row] == shown(name, single[name]), name
            else:
                close = pytest.approx(shown(name, single[name]), rel=1e-9, abs=1e-13)
                assert rows[name][row] == close, name
        harmonics = [rows[f"harmonic_{n}"][row] for n in range(1, 9)]
        assert single["harmonics"][:8] == pytest.approx(harmonics, rel=1e-9, abs=1e-9 * max(harmonics))


def test_no_other_key_can_be_varied(run, scene_text, tmp_path: Path) -> None:
    """The list above is whole: every other number of the key table is refused."""
    group, numbers = "", []
    for line in run("--keys", cwd=tmp_path).stdout.splitlines():
        begun = re.match(r"## &(\w+)", line)
        group = begun[1] if begun else group
        key = re.match(r"\| `(\w+)` \|[^|]*\|[^|]*\| (a number|an integer)", line)
        if key:
            numbers.append(f"{group}.{key[1]}")
    assert set(KEYS) <= set(numbers)
    for key in sorted(set(numbers) - set(KEYS)):
        if key.split(".")[0] in {"gear", "shaft", "oil"}:
            continue  # test_gear_inputs varies them
        (tmp_path / "many.nml").write_text(campaign_of(key, ("1", "2"), "published", scene_text))
        ended = run("--check", "many.nml", cwd=tmp_path)
        assert ended.returncode == 2 and "cannot be varied" in ended.stderr, key
