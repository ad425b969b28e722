"""Every line of a log is what the summary, or the row, reports: each number with its scale and rounding."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import campaign_runs
import numpy as np
import pytest
from outcomes import series_in
from reported import ANY, SPOKEN, assert_reported, counted, short, stated_error
from test_thresholds import threshold_text

import rattle

# What resists a loose gear, and what the shaft does against that.
DRAG = {f"drag_{part}": " N m" for part in ("torque", "bearing", "synchroniser", "churning")}
DRAG["inertia_ratio"] = ""
SUCCESSES = ("complete", "steady")
LAWS = {
    ("reynolds", "iso-viscous"): "Reynolds iso-viscous film of rigid flanks",
    ("reynolds", "piezo-viscous"): "Reynolds piezo-viscous film of rigid flanks",
    ("published", "iso-viscous"): "published iso-viscous film (35), rupture angle pi/2",
    ("published", "piezo-viscous"): "published piezo-viscous film (37)",
}
ENDS = {
    "too_wide": "the film grows beyond a tenth of the radius, where the parabolic gap of a line contact ends",
    "too_narrow": "the film falls below 1 nm, where no oil film is left",
}
STEEL = 14e9  # stiffness of a steel tooth for each length of contact [N/m2]


def log_of(path: Path) -> list[str]:
    """The log without warnings of odd inputs, which report of no result."""
    lines = path.with_suffix(".log").read_text().splitlines()
    return [line for line in lines if "is not what machines have" not in line]


def files(path: Path) -> list[str]:
    motions = path.with_suffix(".motions.rattle")
    return [
        f"  {path}",
        *([f"  {motions}"] if motions.exists() else []),
        f"  {path.with_suffix('.summary.nml')}",
    ]


def item(label: str, text: str) -> str:
    """A line with a label."""
    return f"  {label:17}{text}"


def files_of_table(path: Path) -> str:
    return item("files", f"{path.with_suffix('.summary.nml')}, .rattle, .log")


def um(length: float, digits: int) -> str:
    return f"{short(1e6 * length, digits)} um"


def operating_point(given: Mapping[str, Any]) -> str:
    """Speed, oil and force, from the resolved input with what is derived."""
    load, oil = given["load"], given["lubricant"]
    speed = f"entrainment speed {short(given['kinematics']['entrainment_speed'], 4)} m/s"
    if "gear" in given:
        speed = f"shaft {short(given['shaft']['speed_rpm'], 4)} 1/min"
    heat = f"{short(given['oil']['temperature_celsius'], 4)} degC, " if "oil" in given else ""
    orders = load.get("force_orders")
    force = f"of {counted(np.size(orders), 'order')} of" if orders else ""
    force = force or f"{short(load['force_scale'] * load['force_amplitude'], 4)} N at"
    return (
        f"{speed}; oil {heat}{short(oil['viscosity'], 4)} Pa s, {oil['viscosity_law']}; "
        f"force {force} {short(load['frequency'], 4)} Hz"
    )


def start_of_motion(summary: Mapping[str, Any]) -> str:
    """What is known before it is solved."""
    if "steady_film" not in summary:
        return "  no rigid piezo-viscous film carries the static load"
    words = f"  steady film {um(summary['steady_film'], 5)}"
    if "natural_frequency" in summary:
        words += f", natural frequency {short(summary['natural_frequency'], 5)} Hz"
        words += f", damping ratio {short(summary['damping_ratio'], 4)}"
    for name, unit in DRAG.items():
        if name in summary:
            words += f", {name.replace('_', ' ')} {short(summary[name], 4)}{unit}"
    return words


FITTING = {
    "iso-viscous": "iso-viscous with model = reynolds",
    "piezo-viscous": "piezo-viscous with model = reynolds",
    "elastohydrodynamic": "elastohydrodynamic",
}
RELATIVE = "relative to the shaft, along the line of action"


def teeth_words(summary: Mapping[str, Any]) -> str:
    ratios = (f"{name} ratio {short(summary[f'{name}_ratio'], 4)}" for name in ("contact", "overlap"))
    return f"  profile shift sum {short(summary['profile_shift_sum'], 3)}, {', '.join(ratios)}"


def lines_of_motion(path: Path) -> list[str | None]:
    """The log of a motion, from its summary and its resolved input."""
    summary, given = rattle.read_summary(path.with_suffix(".summary.nml")), rattle.read(path).input
    failed = summary["status"] not in SUCCESSES
    return [
        f"rattle {summary['program_version']}, scene {summary['name']}: "
        f"{LAWS[summary['model'], summary['law']]}",
        f"  {operating_point(given)}",
        teeth_words(summary) if "gear" in given else None,
        start_of_motion(summary),
        "  no natural frequency: small motions about the steady film are overdamped"
        if "steady_film" in summary and "natural_frequency" not in summary
        else None,
        verdict_words(summary) if "rattle_class" in summary else None,
        f"  {summary['steps']} steps in {ANY} s, {short(summary.get('iterations_per_step', 0.0), 3)} "
        f"iterations a step, {summary['steps_cut']} steps cut where the film law had no value",
        f"  {summary['status']} at t = {short(summary['status_time'], 6)} s, film "
        f"{um(summary['film_at_status_time'], 5)}: {summary['status_text']}"
        if failed
        else None,
        *(lines_of_window(path, summary, given) if "rattle_class" in summary else []),
        ending_of_motion(summary),
        *files(path),
    ]


def lines_of_window(path: Path, summary: Mapping[str, Any], given: Mapping[str, Any]) -> list[str | None]:
    verification = f" ({spoken_verification(summary)})" if "verification" in summary else ""
    limits = [ENDS[name] for name in ENDS if name in summary["model_limit"]]
    relative = f" {RELATIVE}" if "gear" in given else ""
    contradicted = (
        "  warning: the film law of the scene does not fit this regime (law_contradicted); "
        f"{FITTING[summary['film_regime']]} fits"
    )
    return [
        f"  film {um(summary['film_minimum'], 5).removesuffix(' um')} to {um(summary['film_maximum'], 5)}, "
        f"acceleration {short(summary['acceleration_minimum'], 5)} to "
        f"{short(summary['acceleration_maximum'], 5)} m/s2{relative}",
        spectrum_words(summary, verification),
        "  The motion does not repeat within its window of "
        f"{counted(given['spectrum']['periods'], 'period')}: other windows have other numbers; raise "
        "spectrum.periods for steadier ones."
        if summary["rattle_class"].startswith("irregular")
        and summary["sampling_sufficient"]
        and "followed_periods" not in summary
        else None,
        "  Extremes, rms, impacts and harmonics are those of "
        f"{counted(summary['followed_periods'], 'period')} that the motion was followed, with standard "
        f"errors by batches of {counted(summary['batch_periods'], 'period')}; extremes of an irregular "
        "motion grow with time."
        if "followed_periods" in summary
        else None,
        f"  warning: {coarse_words(summary, given)}" if is_misleading(path, summary) else None,
        f"  warning: {', and '.join(limits)} (model_limit)" if limits else None,
        *(lines_of_verification(summary) if verification else []),
        f"  {summary['motions_text']}",
        f"  {summary['starts_solved'] - 1} further starts were followed for {ANY} periods"
        if summary["starts_solved"] > 1
        else None,
        f"  {regime_words(summary)}",
        contradicted if summary["law_contradicted"] else None,
        stiffness_words(summary, given),
    ]


def scatter(summary: Mapping[str, Any], name: str) -> str:
    """Two standard errors of a number of an irregular motion."""
    if "followed_periods" not in summary:
        return ""
    return f" +- {short(stated_error(summary[f'{name}_error'], summary[name], 4), 2)}"


def verdict_words(summary: Mapping[str, Any]) -> str:
    sure = {True: " (numerically verified)", False: " (uncertain)", None: ""}[summary.get("verdict_verified")]
    sure += f"; {class_words(summary)}"
    sure += f" ({spoken_verification(summary)})" if "verification" in summary else ""
    sure += f", {SOUNDS[summary['rattle_class']]}"
    rms = summary["acceleration_rms"]
    level = f" ({short(20.0 * np.log10(rms / 1e-6), 4)} dB re 1e-6 m/s2)" if rms > 0.0 else ""
    force = short(summary["film_force_rms"], 4) + scatter(summary, "film_force_rms")
    shaking = short(rms, 4) + scatter(summary, "acceleration_rms")
    words = f"{summary['verdict']}{sure}: film force rms {force} N, acceleration rms {shaking} m/s2{level}"
    assert next(iter(summary)) == "verdict_text" and summary["verdict_text"] == words
    return f"  {words}"


SOUNDS = {
    "quiet": "a sound of little beside the orders of the force",
    "creep": "a sound of few harmonics",
    "idle": "a sound of many harmonics",
    "irregular": "a sound that does not repeat",
    "subharmonic": "a sound that repeats after several periods",
    "irregular_so_far": "a sound that has not repeated yet",
}


def spoken_verification(summary: Mapping[str, Any]) -> str:
    return "numerically verified" if summary["verification"] == "verified" else summary["verification"]


def class_words(summary: Mapping[str, Any]) -> str:
    return SPOKEN.get(summary["rattle_class"], summary["rattle_class"])


def spectrum_words(summary: Mapping[str, Any], verification: str) -> str:
    if "harmonic_distortion" not in summary:
        return f"  no motion above rounding: {class_words(summary)}"
    bound = "at least " if summary["harmonic_count_is_bound"] else ""
    share = "at least " if summary["harmonic_distortion_is_bound"] else ""
    start = ", from rest" if summary["motions"] > 1 else ""
    return (
        f"  {bound}{summary['harmonic_count']} harmonics, harmonic distortion {share}"
        f"{short(summary['harmonic_distortion'], 3)}, {short(summary['reversals_per_period'], 3)} reversals "
        f"a period: {class_words(summary)}{verification}{start}"
    )


def is_misleading(path: Path, summary: Mapping[str, Any]) -> bool:
    """Whether the harmonics are those of too few samples, or these miss extremes by more than a hundredth."""
    if not summary["series_coarse"] or not summary["sampling_sufficient"]:
        return bool(summary["series_coarse"])
    result = rattle.read(path)
    window = result.window(summary["window_periods"])
    for name, quantity, seen in (
        ("film_thickness", "film", np.log),
        ("acceleration", "acceleration", np.asarray),
    ):
        samples = seen(result.samples(name, window))
        low, high = (seen(summary[f"{quantity}_{end}"]) for end in ("minimum", "maximum"))
        if max(samples.min() - low, high - samples.max()) > 0.01 * (high - low):
            return True
    return False


def coarse_words(summary: Mapping[str, Any], given: Mapping[str, Any]) -> str:
    newmark = given["solver"]["method"] == "newmark"
    key = "solver.steps_per_period" if newmark else "solver.samples_per_period"
    if not summary["sampling_sufficient"]:
        what = f"the harmonics are those of the samples: raise {key}"
    elif summary["harmonics_by_integrals"]:
        return (
            "the samples of the series are too few for its motion: take peaks from its rows of the "
            "extremes, and harmonics from here, where they are integrals over the steps (series_coarse), or "
            f"raise {key}, which shows all but the shortest impacts"
        )
    else:
        what = f"{key} = {summary['samples_per_period']} would do, as many as gave the harmonics here"
    return (
        f"the samples of the series are too few for its motion; {what} "
        "(series_coarse; the rows of the extremes stand in the series)"
    )


def lines_of_verification(summary: Mapping[str, Any]) -> list[str | None]:
    errors = [
        short(stated_error(summary[f"{name}_error"], summary.get(name, 1.0), 5), 2)
        for name in ("film", "acceleration_minimum", "acceleration_maximum")
        if f"{name}_error" in summary
    ]
    multiplier = np.atleast_1d(summary.get("floquet_multipliers", [0.0]))
    return [
        f"  {summary['verification_text']}",
        f"  error of the film at most {errors[0]} of it, of the extremes of the acceleration {errors[1]} and "
        f"{errors[2]} m/s2"
        if len(errors) == 3
        else None,
        f"  the motion repeats after {counted(summary['orbit_period'], 'period')}: "
        f"{summary['orbit_stability']}, largest Floquet multiplier "
        f"{short(float(np.hypot(*multiplier[:2])), 3)}"
        if "orbit_period" in summary and "orbit_stability" in summary
        else None,
    ]


def regime_words(summary: Mapping[str, Any]) -> str:
    reached = summary["alpha_p_maximum"]
    words = f"{summary['film_regime']}: the Reynolds film reaches alpha p = {short(reached, 3)}; "
    if reached >= 1.0:
        return words + "from 1 on there is no piezo-viscous film of rigid flanks"
    if summary["film_regime"] == "elastohydrodynamic":
        return words + f"the flanks deflect by {ANY} % of the film, limit 10 %"
    return words + (
        "below 0.1 pressure hardly thickens the oil"
        if reached < 0.1
        else "from 0.1 on pressure thickens the oil"
    )


def stiffness_words(summary: Mapping[str, Any], given: Mapping[str, Any]) -> str | None:
    """A warning where teeth are rigid and steel ones would deflect by more than a tenth of the film."""
    if "stiffness" in given["contact"] or not summary["stiffness_matters"]:
        return None
    share = summary["deflection_share"]
    words = f"{short(share, 2)} times" if share > 1.0 else f"{short(100.0 * share, 2)} % of"
    steel = "gear.tooth_stiffness = 1.4E10 N/m2"
    if "gear" not in given:
        steel = f"contact.stiffness = {short(STEEL * given['contact']['length'], 2)} N/m"
    return (
        f"  warning: under its largest load a steel tooth deflects by {words} the film, while these teeth "
        "are rigid (stiffness_matters). Elastic teeth may move otherwise, and fall into another class: "
        f"steel ones have {steel}"
    )


def ending_of_motion(summary: Mapping[str, Any]) -> str | None:
    """Vibration severity and impacts, as far as they are known."""
    parts = [
        f"gear acceleration {end} {short(summary[f'gear_acceleration_{end}'], 4)} rad/s2"
        for end in ("rms", "maximum")
        if f"gear_acceleration_{end}" in summary
    ]
    parts += (
        [f"dissipated power {short(summary['dissipated_power'], 4)} W"]
        if "dissipated_power" in summary
        else []
    )
    if "double_sided" in summary:
        parts.append(f"double sided {'yes' if summary['double_sided'] else 'no'}")
    return f"  {', '.join(parts)}" if parts else None


@pytest.fixture(scope="module")
def solve(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("logs")

    def call(name: str, text: str, *options: object, code: int = 0) -> Path:
        (folder / f"{name}.nml").write_text(text)
        ended = run(
            f"{name}.nml", "--verbose", "--output", folder / name, *options, cwd=folder, timeout=600.0
        )
        assert ended.returncode == code, ended.stderr
        path = folder / name / f"{name}.rattle"
        assert ended.stdout == path.with_suffix(".log").read_text()
        return path

    return call


def named(text: str, name: str) -> str:
    return f"&scene\n name = '{name}'\n/\n" + text


TAYLOR = {"steps_per_period": None, "method": None, "periods": "60", "accuracy": "1e-6", "until": "'steady'"}
EXACT = {"law": "'iso-viscous'", "model": "'reynolds'"}
GAP = {"backlash": "1e-5", "stiffness": "1e9"}
# What each scene makes a log report beside the rest: another regime, limit, way of sampling, or end.
MOTIONS = {
    "plain": {},
    "calm": {"solver": TAYLOR},
    "weak": {"load": {"force_amplitude": "1.0"}, "solver": TAYLOR, "film": EXACT},
    "thin": {"lubricant": {"viscosity": "0.005"}, "solver": TAYLOR, "film": EXACT},
    "wide": {"load": {"steady_force": "0.001", "force_amplitude": "0.0001"}, "solver": TAYLOR, "film": EXACT},
    "loose": {"contact": GAP, "solver": TAYLOR, "film": EXACT, "load": {"force_amplitude": "400.0"}},
    "hard": {"solver": {**TAYLOR, "samples_per_period": "64"}, "load": {"force_amplitude": "800.0"}},
    "few": {"load": {"force_amplitude": "800.0"}, "spectrum": {"verify": ".false."}},
    "bare": {"solver": TAYLOR, "spectrum": {"verify": ".false."}},
}
FAILED = {
    "lost": {"load": {"force_amplitude": "1e9"}, "solver": {"iteration_limit": "2"}},
    "no_film": {"film": {"law": "'piezo-viscous'", "model": "'reynolds'"}, "solver": TAYLOR},
}


@pytest.mark.parametrize("name", (*MOTIONS, *FAILED))
def test_the_log_of_a_motion_is_its_summary(solve, scene_text, name):
    changes = (MOTIONS | FAILED)[name]
    path = solve(name, named(scene_text(**changes), name), code=1 if name in FAILED else 0)
    assert_reported(log_of(path), lines_of_motion(path))


@pytest.mark.parametrize("name", ("engine_cycle", "loose_pair", "loose_gear", "idle", "creep_period_two"))
def test_the_log_of_a_ready_scene_is_its_summary(run, repository, tmp_path, name):
    assert run(repository / "input" / f"{name}.nml", "--output", tmp_path, cwd=tmp_path).returncode == 0
    (path,) = series_in(tmp_path)
    found = log_of(path)
    if name == "engine_cycle":
        assert "; engine orders 0.5 to 12 are kept, " in found.pop(1)
    assert_reported(found, lines_of_motion(path))


HEADS = ("gear", "verdict", "class", "least film", "peak", "rms", "film force", "power")
UNITS = ("[um]", "[m/s2]", "[m/s2]", "rms [N]", "[W]")


def reported_by_the_table(gear: str, summary: Mapping[str, Any]) -> list[str]:
    """The cells of a pair, as many as there are heads."""
    word = class_words(summary) if "rattle_class" in summary else "-"
    known = "acceleration_minimum" in summary
    peak = max(-summary["acceleration_minimum"], summary["acceleration_maximum"]) if known else None
    least = 1e6 * summary["film_minimum"] if "film_minimum" in summary else None
    sizes = [summary.get(name) for name in ("acceleration_rms", "film_force_rms", "dissipated_power")]
    numbers = ["-" if number is None else short(number, 4) for number in (least, peak, *sizes)]
    verdict = summary.get("verdict", summary["status"])
    return [gear, verdict, word + (", verified" if summary.get("verified") else ""), *numbers]


@pytest.mark.parametrize(
    ("change", "code"),
    (
        (("name = '2nd'", "name = '2nd'"), 0),
        # The 4th, which alone has a larger gap, leaves the film of the Reynolds piezo-viscous law.
        (("&solver", "&film law = 'piezo-viscous', model = 'reynolds' /\n&solver"), 1),
        (("periods = ", "verify = .false., periods = "), 0),
    ),
    ids=("ready", "failing", "not verified"),
)
def test_the_log_of_a_gearbox_is_its_table(run, repository, tmp_path, change, code):
    text = (repository / "input" / "gearbox.nml").read_text()
    before, spectrum, behind = text.partition("&spectrum") if change[0] == "periods = " else ("", "", text)
    (tmp_path / "box.nml").write_text(before + spectrum + behind.replace(*change, 1))
    ended = run("box.nml", "--set", "scene.name=box", "--output", tmp_path, cwd=tmp_path)
    assert ended.returncode == code, ended.stderr
    table = rattle.read_summary(tmp_path / "box.summary.nml")
    lines = (tmp_path / "box.log").read_text().splitlines()
    ranked = sorted(table["gears"].items(), key=lambda pair: -pair[1].get("film_force_rms", -1.0))
    others = [
        f"  {gear}: {summary['motions_text']}" for gear, summary in ranked if summary.get("motions", 1) > 1
    ]
    behind_sums = slice(len(lines) - 2 - len(others), len(lines) - 2)
    assert lines[behind_sums] == others
    del lines[behind_sums]
    head, point, heads, units, *rows, uncorrelated, in_phase, words, relative, file = lines
    assert head == f"rattle {table['program_version']}, gearbox box: {len(table['gears'])} pairs"
    of_a_pair = (tmp_path / "box.4th.log").read_text().splitlines()
    assert point == item("operating point", of_a_pair[1].strip())
    cells = [[cell for cell in re.split("  +", row.strip()) if cell] for row in rows]
    assert cells == [reported_by_the_table(gear, summary) for gear, summary in ranked]
    assert tuple(re.split("  +", heads.strip())) == HEADS and tuple(re.split("  +", units.strip())) == UNITS
    # Every unit, and the words of "together", stand under their head.
    starts = [heads.index(name, heads.index("film force") if name == "power" else 0) for name in HEADS]
    starts[HEADS.index("rms")] = heads.index(" rms ") + 1
    for row in rows:
        assert [bool(re.match(r"\S", row[start:])) and row[start - 1] == " " for start in starts] == [
            True
        ] * 8
    forces = [summary.get("film_force_rms", np.nan) for summary in table["gears"].values()]
    powers = [summary.get("dissipated_power", np.nan) for summary in table["gears"].values()]
    failed = sum(summary["status"] not in SUCCESSES for summary in table["gears"].values())
    assert table["pairs"] == len(forces) and table["pairs_failed"] == failed and (failed > 0) == (code == 1)
    assert file == item("files", f"{tmp_path}/box.summary.nml, .log")
    assert words == f"  {table['film_force_text']}"
    assert relative == f"  peak and rms of the acceleration {RELATIVE}"
    sums = ("film_force_rms_uncorrelated", "film_force_rms_in_phase", "dissipated_power")
    if failed:
        assert not set(sums) & set(table)
        assert uncorrelated.split() == ["together,", "uncorrelated", "-", "-"]
        assert in_phase.split() == ["together,", "in", "phase", "-"]
        return
    assert table[sums[0]] == pytest.approx(np.sqrt(np.sum(np.square(forces))), rel=1e-12)
    assert table["dissipated_power"] == pytest.approx(np.sum(powers), rel=1e-12)
    assert re.split("  +", uncorrelated.strip()) == [
        "together, uncorrelated",
        short(table[sums[0]], 4),
        short(table["dissipated_power"], 4),
    ]
    assert re.split("  +", in_phase.strip()) == ["together, in phase", short(table[sums[1]], 4)]
    assert (
        uncorrelated.index(short(table[sums[0]], 4)) == in_phase.index(short(table[sums[1]], 4)) == starts[-2]
    )


def test_the_log_of_a_film_task_is_its_summary(solve, repository):
    text = (repository / "input" / "film.nml").read_text()
    path = solve("film", text, "--set", "scene.name=film")
    summary, rows = rattle.read_summary(path.with_suffix(".summary.nml")), rattle.read(path).row_count
    assert summary["points"] == rows
    assert_reported(
        log_of(path),
        [
            f"rattle {rattle.version}, scene film: film task",
            item("points", f"{rows} in {ANY} s: {summary['status_text']}"),
            item("files", f"{path.with_suffix('.summary.nml')}, .rattle, .profiles.rattle, .log"),
        ],
    )


@pytest.mark.parametrize(
    ("key", "first", "last", "failed"),
    (
        ("force_amplitude", "100.0", "900.0", 0),
        ("force_amplitude", "100.0", "1e9", 1),
        # No film of rigid flanks carries such loads.
        ("steady_force", "3e4", "4e4", 7),
    ),
)
def test_the_log_of_a_sweep_is_its_rows(solve, scene_text, key, first, last, failed):
    """Of a force that grows without end motions leave what the model can mean, or fail: by the exit code."""
    sweep = {
        "key": f"'{key}'",
        "first": first,
        "last": last,
        "count": "4",
        "spacing": "'logarithmic'",
    }
    exact = key == "steady_force"
    film = {"law": "'piezo-viscous'", "model": "'reynolds'"} if exact else {}
    text = scene_text(scene={"task": "'sweep'"}, film=film, solver={**TAYLOR, "until": None}, sweep=sweep)
    name = f"sweep_{first[0]}_{last[0]}"
    path = solve(name, text, "--set", f"scene.name={name}", code=int(failed > 0))
    result, summary = rattle.read(path), rattle.read_summary(path.with_suffix(".summary.nml"))
    assert failed == int((~np.isin(result["status"], (0, 1))).sum())
    assert (
        summary["status_text"]
        == {
            0: "All that was asked for was solved.",
            1: "1 of 7 motions failed (column status). The others were solved.",
            7: "7 of 7 motions failed (column status).",
        }[failed]
    )
    beyond = int((result["model_limit"] > 0).sum()) if "model_limit" in result else None
    assert (summary["motions"], summary["motions_failed"]) == (result.row_count, failed)
    warning = item(
        "warning",
        f"{ANY if beyond is None else beyond} motions outside the range of the model: films above a tenth of "
        "the radius or below 1 nm (model_limit)",
    )
    found = log_of(path)
    assert_reported(
        found,
        [
            f"rattle {rattle.version}, scene {name}: sweep of {result.row_count} motions, "
            + (
                "Reynolds piezo-viscous film of rigid flanks"
                if exact
                else "published iso-viscous film (35), rupture angle pi/2"
            ),
            item("motions", f"{result.row_count} in {ANY} s: {summary['status_text']}"),
            files_of_table(path),
            warning if "outside the range" in found[-1] else None,
        ],
    )


RECORD = "'rattle_class', 'acceleration_maximum', 'verified', 'model_limit', 'sampling_sufficient'"


@pytest.mark.parametrize(
    ("name", "last", "changes"),
    (
        ("doubtful", "400.0, 20.0", {}),
        ("far", "1e7, 20.0", {}),
        ("failing", "400.0, 20.0", {"film": {"law": "'piezo-viscous'", "model": "'reynolds'"}}),
        ("irregular", "2000.0, 20.0", {}),
    ),
)
def test_the_log_of_a_campaign_is_its_rows(solve, scene_text, name, last, changes):
    campaign = {"record": RECORD, "last": last, "samples_per_period": "32"}
    text = campaign_runs.grid(scene_text, 6, 5, campaign=campaign, **changes)
    text = text.replace("&scene\n", f"&scene\n name = '{name}'\n")
    path = solve(name, text, "--threads", 2, code=int(name == "failing"))
    rows, summary = rattle.read_campaign(path), rattle.read_summary(path.with_suffix(".summary.nml"))
    failed, count = int(rows.failed.sum()), rows.row_count
    verified = rows["verified"]
    doubts, tested = int((verified == 0.0).sum()), int(np.isfinite(verified).sum())
    beyond = int((rows["model_limit"] > 0.0).sum())
    coarse = int((rows["sampling_sufficient"] == 0.0).sum())
    irregular, open_ended = (int((rows["rattle_class"] == code).sum()) for code in (4.0, 6.0))
    assert {"irregular": irregular, "far": beyond, "failing": failed, "doubtful": doubts}[name] > 0
    assert summary["scenes"] == summary["scenes_done"] == count
    assert summary["scenes_failed_in_this_run"] == failed
    assert summary["scenes_beyond_model_in_this_run"] == beyond
    assert summary["scenes_undersampled_in_this_run"] == coarse
    assert summary["scenes_not_verified_in_this_run"] == doubts
    assert summary["scenes_irregular_in_this_run"] == irregular
    assert summary["scenes_irregular_so_far_in_this_run"] == open_ended
    law = LAWS[("reynolds", "piezo-viscous") if changes else ("published", "iso-viscous")]
    found = log_of(path)
    assert_reported(
        [line for line in found if " s left, " not in line],
        [
            f"rattle {rattle.version}, campaign {name}: {count} scenes, {law}; 1 rank of 2 threads",
            item("scenes", f"{count} of {count}, {ANY} a second, {failed} failed, {doubts} not verified"),
            item(
                "not verified",
                f"{doubts} of {tested} scenes: a tighter solution has another class, or comes close to a "
                "limit (verified)",
            )
            if doubts
            else None,
            item(
                "irregular",
                f"{counted(irregular, 'scene')}: numbers of 100 periods or more, with standard errors "
                "(acceleration_rms_error)",
            )
            if irregular
            else None,
            item(
                "irregular so far",
                f"{counted(open_ended, 'scene')}: no repetition, no Lyapunov exponent that is surely "
                "positive",
            )
            if open_ended
            else None,
            item("longest", f"scene {ANY}, {ANY} steps"),
            files_of_table(path),
            item(
                "warning",
                f"{counted(beyond, 'scene')} outside the range of the model: films above a tenth of the "
                "radius or below 1 nm (model_limit)",
            )
            if beyond
            else None,
            item(
                "warning",
                f"harmonics of {counted(coarse, 'scene')} are not resolved (sampling_sufficient); raise "
                "campaign.samples_per_period",
            )
            if coarse
            else None,
        ],
    )


def test_the_log_of_thresholds_is_their_rows(solve, scene_text):
    text = threshold_text(scene_text, threshold={"tolerance": "1e-3"})
    path = solve("edge", text, "--threads", 2)
    rows, summary = rattle.read(path), rattle.read_summary(path.with_suffix(".summary.nml"))
    crossed = rows["crossing"] > 0
    lines, without = int(np.unique(rows["trace"]).size), int((~crossed).sum())
    both = (rows["verified_below"] == 1.0) & (rows["verified_above"] == 1.0)
    doubts = int((crossed & ~both).sum())
    assert (summary["traces"], summary["crossings"], summary["traces_without_crossing"]) == (
        lines,
        crossed.sum(),
        without,
    )
    assert summary["crossings_uncertain"] == doubts
    given = rows.input["threshold"]
    grid = summary["scenes_of_a_grid"]
    wide = summary["crossings_wide"]
    starts, unsure = 3, summary["crossings_end_unsure"]  # three by default
    followed = summary["crossings_followed"]
    assert followed == np.isfinite(rows["last_below"][crossed]).sum()
    others = int(np.isfinite(rows["last_below"][~crossed]).sum())
    assert summary["traces_with_another_side"] == others
    places = given["count"]
    while places < grid / lines:
        places = 2 * places - 1
    assert_reported(
        [line for line in log_of(path) if " s left, " not in line],
        [
            f"rattle {rattle.version}, threshold {rows.scene_name}: {counted(lines, 'trace')} "
            f"of {given['key']}, "
            f"{LAWS['published', 'iso-viscous']}; 1 rank of 2 threads",
            f"  {given['count']} values a trace, then halves down to {places} places; two changes "
            "between neighbours of the scan that cancel each other stay unseen: more &threshold count sees "
            "them",
            "  the ends of a crossing go apart again until both are verified",
            f"  then the motions of both sides, from {counted(starts, 'start')}, are followed along "
            f"{given['key']} to where they end; in a trace without a crossing these starts are tried at both "
            "ends and in the middle",
            item(
                "scenes",
                f"{summary['scenes']} of {summary['scenes']}, {ANY} a second, "
                f"{summary['scenes_failed']} failed",
            ),
            item(
                "crossings",
                f"{summary['crossings']}; {without} of {counted(lines, 'trace')} without any; at {doubts} a "
                "side is not verified",
            ),
            item(
                "width",
                f"{counted(wide, 'crossing')} have ends that are verified only farther apart than requested "
                "(width)",
            )
            if wide
            else None,
            item(
                "either side",
                f"possible at {summary['crossings_either']} of {counted(followed, 'crossing')}, beyond the "
                "change from rest (last_below, last_above)",
            ),
            item(
                "motion ends",
                f"unsure at {counted(unsure, 'crossing')}: no repetition, known to a bracket, or unknown "
                "(motion_end_below, _above)",
            )
            if unsure
            else None,
            item(
                "other side",
                f"in {others} of {counted(without, 'trace')} without a crossing, from other starts "
                "(last_above to last_below)",
            )
            if others
            else None,
            item("starts", f"{starts} do not prove that there are no other motions"),
            f"  {summary['scenes']} scenes; a grid as fine has {int(grid)}, "
            f"{short(grid / summary['scenes'], 3)} times as many",
            files_of_table(path),
        ],
    )
