"""Titles, labels, legends and annotations of figures say what rows and summaries say, and nothing else."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import campaign_writer
import numpy as np
import pytest
from figure_words import assert_says, film_of, relative, words_of
from outcomes import series_in
from reported import SPOKEN
from test_drawn_thresholds import ROWS, level_result, written

import rattle
from rattle import codes
from rattle.campaign_section import new_section
from rattle.figures import (
    campaign_map,
    campaign_slice,
    campaign_summary,
    histories,
    spectra,
    style,
    sweep,
    threshold,
)
from rattle.run_up import differing
from rattle.thresholds import thresholds

PERIODS = 4


# --- motions -------------------------------------------------------------------------------------------

READY = ("idle", "engine_cycle", "loose_gear", "creep_false_harmonic", "creep_period_two")


@pytest.fixture(scope="module")
def solved(run, repository, tmp_path_factory):
    """Ready motions and sweeps, by their names."""
    folder = tmp_path_factory.mktemp("drawn")
    inputs = [repository / "input" / f"{name}.nml" for name in (*READY, "stiff_or_not")]
    assert run(*inputs, "--output", folder, cwd=folder).returncode == 0
    return {path.stem: path for path in series_in(folder)}


class Motion:
    """A motion with all that is reported of it."""

    def __init__(self, path: Path) -> None:
        self.result = rattle.read(path)
        self.reported = rattle.read_summary(path.with_suffix(".summary.nml"))
        self.given = self.result.input
        self.frequency = self.reported.get("frequency", self.given["load"].get("frequency"))
        speed = self.given.get("shaft", {}).get("speed_rpm")
        self.order = None if speed is None else self.frequency / (speed / 60.0)
        self.forced = "force_amplitudes" in self.given["load"]

    def title(self, subject: str) -> str:
        return f"{subject}: {self.reported['name']}, {film_of(self.given)}"

    def time(self) -> str:
        rows = self.result["time"]
        count = round((rows[-1] - rows[0]) * self.frequency)
        start = rows[0] + (count - PERIODS) / self.frequency
        return f"Time within the last {PERIODS} excitation periods [ms], from $t = {1e3 * start:.2f}$ ms"

    def coarse(self, name: str, unit: str, scale: float) -> str:
        if not self.reported["series_coarse"]:
            return ""
        least, largest = (scale * self.reported[f"{name}_{end}"] for end in ("minimum", "maximum"))
        if not self.reported["sampling_sufficient"]:
            return "Series of too few samples; what lies between them is not known"
        samples = self.result[{"film": "film_thickness"}.get(name, name)][
            -PERIODS * self.result.samples_per_period :
        ]
        samples = scale * samples.reshape(PERIODS, -1)
        missed = [least - samples.min(axis=1), largest - samples.max(axis=1)]
        whole = largest - least
        if name == "film":  # its axis is logarithmic
            missed = [np.log(samples.min(axis=1) / least), np.log(largest / samples.max(axis=1))]
            whole = np.log(largest / least)
        if np.abs(missed).max() <= 0.01 * whole:
            return ""
        return f"Series of too few samples; between them {least:.4g} to {largest:.4g} {unit}, not all drawn"

    def axis_of_frequency(self) -> str:
        if self.order is not None:
            return "Engine order [-]"
        return (
            f"Harmonic, multiple of {self.frequency:.3g} Hz"
            if self.forced
            else r"Frequency ratio $f/f_\mathrm{exc}$"
        )


@pytest.mark.parametrize("name", READY)
def test_words_of_histories(solved, name):
    motion = Motion(solved[name])
    runs, labels = [motion.result], style.run_labels([motion.result])
    film = motion.coarse("film", r"$\mathrm{\mu}$m", 1e6)
    assert_says(
        histories.draw_film_and_force(runs, labels, PERIODS),
        [
            motion.title("Film and applied force"),
            film,
            r"Film thickness $h$ [$\mathrm{\mu}$m]",
            "Applied force $F$ [N]",
            motion.time(),
        ],
    )
    label = r"Acceleration $\ddot{z}$ [m/s$^2$]"
    label = relative(label) if "gear" in motion.given else label
    made = histories.draw_acceleration(runs, labels, PERIODS)
    near = len(made.axes) == 2  # the largest impact, drawn beside
    assert near == (name == "loose_gear")
    assert_says(
        made,
        [
            motion.title("Acceleration"),
            motion.coarse("acceleration", "m/s$^2$", 1.0),
            motion.time(),
            label,
            *([label, "The largest impact, on the same axis of time [ms]"] if near else []),
        ],
    )


@pytest.mark.parametrize("name", READY)
def test_words_of_spectra(solved, name):
    motion = Motion(solved[name])
    reported = motion.reported
    runs, labels = [motion.result], style.run_labels([motion.result])
    load = motion.given["load"]
    mean = load["steady_force"] + load.get("force_mean", 0.0)
    lines = {1: load.get("force_amplitude", 0.0)}
    if motion.forced:
        given = (reported.get(key, load.get(key)) for key in ("force_orders", "force_amplitudes"))
        lines = dict(zip(*map(np.atleast_1d, given), strict=True))
    largest = max(lines, key=lambda order: abs(lines[order]))
    made = spectra.draw_force(runs, labels, None)
    # The numbers are those of the samples of the force, to rounding.
    found = [
        re.sub(r"\b\d+(\.\d+)?(?= N)", lambda match: f"{float(match[0]):.3g}", text)
        for text in words_of(made)
    ]
    assert found == sorted(
        [
            motion.title("Spectrum of the applied force"),
            motion.axis_of_frequency(),
            "Amplitude of $F$ [N]",
            f"mean\n{mean:.3g} N",
            f"{abs(lines[largest]):.3g} N\nat {largest * motion.frequency:.4g} Hz",
        ]
    )
    by_samples = not reported["sampling_sufficient"]
    share = 100.0 * motion.given["spectrum"]["harmonic_threshold"]
    reference = "the first harmonic" if not motion.forced else f"harmonic {largest_line(motion, lines)}"
    subject = "Spectrum of the acceleration"
    level = r"Level [dB re 10$^{-6}$ m/s$^2$]"
    driven = "at harmonics of the force"
    if motion.order is not None and len(lines) <= 8:
        driven = f"orders of the force: {', '.join(f'{line * motion.order:g}' for line in sorted(lines))}"
        reference = f"the line of engine order {largest_line(motion, lines) * motion.order:.4g}"
    elif motion.order is not None and motion.forced:
        reference = f"the line of engine order {largest_line(motion, lines) * motion.order:.4g}"
    between = reported.get("orbit_period", 1) > 1 or by_samples
    assert_says(
        spectra.draw_acceleration(runs, labels, None),
        [
            motion.title(relative(subject) if "gear" in motion.given else subject),
            motion.axis_of_frequency(),
            level,
            "too few samples: these harmonics are those of the samples" if by_samples else None,
            f"harmonics of {motion.frequency:.4g} Hz",
            driven if motion.forced else None,
            "between the harmonics" if between else None,
            f"{share:.3g} % of {reference}",
        ],
    )


def largest_line(motion: Motion, lines: Mapping[int, float]) -> int:
    """The harmonic of the force at which the acceleration is largest."""
    found = {int(order): motion.reported["harmonics"][int(order) - 1] for order in lines}
    return max(found, key=found.get)


# --- sweeps --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("of_gear", (False, True))
def test_words_of_a_sweep(solved, run, repository, tmp_path, of_gear):
    path = solved["stiff_or_not"]
    if of_gear:
        text = (repository / "input" / "loose_pair.nml").read_text()
        text = re.sub(r"^ *until = .*\n", "", text, flags=re.MULTILINE)
        text = f"&scene\n task = 'sweep', name = 'box'\n/\n{text}"
        text += "&sweep\n key = 'speed_rpm'\n first = 800.0\n last = 900.0\n count = 2\n/\n"
        (tmp_path / "box.nml").write_text(text)
        ended = run("box.nml", "--set", "solver.periods=20", "--output", tmp_path, cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        path = next(tmp_path.glob("*.rattle"))
    result = rattle.read(path)
    peak = r"Peak $|\ddot{z}|$ [m/s$^2$]"
    key = "Shaft speed [1/min]" if of_gear else "Stiffness of the teeth $k$ [N/m]"
    both = (result["direction"] < 0.0).any()
    limit = result.input["spectrum"]["idle_harmonics"]
    assert_says(
        # Only a sweep over speed has a rate.
        sweep.draw(
            result,
            panels=tuple(name for name in sweep.PANELS if of_gear or name != sweep.RATE),
            marks=[(850.0, "here")],
        ),
        [
            f"Steady motions: {result.scene_name}, {film_of(result.input)}",
            "Film [$\\mathrm{\\mu}$m]",
            peak.replace("Peak", "Relative peak") if of_gear else peak,
            "Harmonics",
            f"idle from {limit} harmonics on",
            "Period [$1/f$]",
            "Floquet multiplier",
            "Rate [1/min/s]" if of_gear else None,
            key,
            "here",
            "up",
            "down" if both else None,
            "hysteresis" if differing(result).size else None,
        ],
    )


# --- campaigns -----------------------------------------------------------------------------------------


def share(count: int, whole: int) -> str:
    percent = 100.0 * count / whole
    return "< 0.1 %" if 0.0 < percent < 0.1 else f"{percent:.1f} %"


def campaign(tmp_path: Path, *, of_gear: bool = False, undone: Sequence[int] = ()) -> rattle.Campaign:
    made = campaign_writer.grid(campaign_writer.FORCES, campaign_writer.SPEEDS, failures=True)
    if of_gear:
        made.base += "&gear\n   teeth_1 = 11\n   teeth_2 = 38\n/\n"
    return rattle.read_campaign(made.write(tmp_path / "map.rattle", undone=undone, closed=not undone))


def legend_of_map(rows: rattle.Campaign, column: str) -> list[str]:
    """Classes, failures and doubts with their shares of all scenes."""
    whole, done = rows.row_count, rows.done
    found, classes = [], rows["rattle_class"]
    if column == "rattle_class":
        for code, name in codes.CLASSES.items():
            words = SPOKEN.get(name, name)
            found.append(f"{words} ({share(int((classes == code).sum()), whole)})")
    for code, words in ((3.0, "film lost"), (4.0, "no rigid film")):
        count = int((done & (rows["status"] == code)).sum())
        if count:
            found.append(f"{words} ({share(count, whole)})")
    if not done.all():
        found.append(f"not done ({share(int((~done).sum()), whole)})")
    so_far = int((done & (classes == 6.0)).sum())
    lacking = int((done & (rows["verified"] == 0.0) & (classes != 6.0)).sum())
    found.append(f"not verified ({share(lacking, whole)})")
    if column != "rattle_class":
        found.append(f"irregular so far ({share(so_far, whole)})")
    return found


def scenes_of(rows: rattle.Campaign) -> str:
    done = int(rows.done.sum())
    return f"{done} scenes" if done == rows.row_count else f"{done} of {rows.row_count} scenes"


@pytest.mark.parametrize("undone", ((), (1,)), ids=("finished", "not finished"))
@pytest.mark.parametrize("of_gear", (False, True), ids=("scene", "gear"))
@pytest.mark.parametrize("column", ("rattle_class", "acceleration_maximum", "film_minimum"))
def test_words_of_a_map(tmp_path, column, of_gear, undone):
    rows = campaign(tmp_path, of_gear=of_gear, undone=undone)
    section = new_section(rows, rows.varied, {})
    bar = {
        "acceleration_maximum": f"{'Relative acceleration' if of_gear else 'Acceleration'} maximum [m/s$^2$]",
        "film_minimum": "Film minimum [\N{MICRO SIGN}m]",
    }
    title = column.replace("_", " ").capitalize()
    made = campaign_map.draw(section, column, campaign_map.Options(()))
    assert_says(
        made,
        [
            f"{title}: map",
            "Force amplitude [N]",
            "Entrainment speed [m/s]",
            bar.get(column),
            *legend_of_map(rows, column),
        ],
    )
    # Each entry once: what is irregular so far is a class that is hatched.
    words = [text.rpartition(" (")[0] for text in words_of(made) if text.endswith(" %)")]
    assert len(set(words)) == len(words) and "irregular so far" in words
    so_far = next(patch for patch in made.legends[0].get_patches() if "so far" in patch.get_label())
    assert so_far.get_hatch() and (so_far.get_facecolor()[3] > 0.0) == (column == "rattle_class")


def test_words_of_a_slice(tmp_path):
    rows = campaign(tmp_path, of_gear=True)
    speed = rows.axis(campaign_writer.SPEED).values[3]
    section = new_section(rows, (campaign_writer.FORCE,), {campaign_writer.SPEED: float(speed)})
    here = rows[campaign_writer.SPEED] == speed
    classes = {codes.CLASSES[int(code)] for code in rows["rattle_class"][here] if np.isfinite(code)}
    doubt = (here & (rows["verified"] == 0.0) & (rows["rattle_class"] != 6.0)).any()
    failed = {3.0: "film lost", 4.0: "no rigid film"}
    assert_says(
        campaign_slice.draw(section, ["acceleration_maximum", "film_minimum"]),
        [
            f"Along force amplitude: map, entrainment speed = {speed:.4g} m/s",
            "Relative acceleration maximum\n[m/s$^2$]",
            "Film minimum\n[\N{MICRO SIGN}m]",
            "Force amplitude [N]",
            *(SPOKEN.get(name, name) for name in classes),
            "not verified" if doubt else None,
            *(words for code, words in failed.items() if (here & (rows["status"] == code)).any()),
        ],
    )


def test_words_of_the_page_on_a_campaign(tmp_path):
    rows = campaign(tmp_path, of_gear=True)
    worst = np.argsort(-np.nan_to_num(rows["acceleration_maximum"]))[:3]
    made = campaign_summary.draw(
        rows, campaign_summary.Worst([int(row) for row in worst], "acceleration_maximum", False)
    )
    texts = words_of(made)
    judged, lacking = (
        int((rows.done & keep).sum()) for keep in (np.isfinite(rows["verified"]), rows["verified"] == 0.0)
    )
    failed = int(rows.failed.sum())
    heads = [
        f"Campaign map, {rows.row_count} scenes",
        f"Verification fails in {share(lacking, judged)} of {judged} scenes",
        f"How scenes ended: {share(failed, rows.row_count)} failed",
        "Share of classes",
        "Rattle class",
        "Worst scenes, largest acceleration maximum; inputs with series: map_scenes/",
    ]
    assert [head for head in heads if head not in texts] == []
    keys = next(text for text in texts if text.startswith("force amplitude"))
    assert keys.splitlines() == [
        "force amplitude: 20 to 400 N (linear, 20 values)",
        "entrainment speed: 0.5 to 5 m/s (logarithmic, 15 values)",
        "Published iso-viscous film;  rattle 0.1.0",
        "Acceleration relative to the shaft, on the line of action",
    ]
    classes = rows["rattle_class"][rows.done]
    counts = [int((classes == code).sum()) for code in codes.CLASSES] + [int(np.isnan(classes).sum())]
    assert [f"{count}  ({share(count, classes.size)})" for count in counts if count][0] in texts
    for count in counts:
        assert f"{count}  ({share(count, classes.size)})" in texts
    names = [label.get_text() for axes in made.axes for label in axes.get_yticklabels()]
    assert {"irregular so far", "no class"} <= set(names) and not any("_" in name for name in names)
    table = next(text for text in texts if text.startswith("input")).splitlines()
    for line, row in zip(table[2:], worst, strict=True):
        cells = re.split(r"\s{2,}", line.strip())
        numbers = [
            rows[name][row] for name in (campaign_writer.FORCE, campaign_writer.SPEED, "acceleration_maximum")
        ]
        assert cells[1:4] == [f"{number:.4g}" for number in numbers]
        name = codes.CLASSES[int(rows["rattle_class"][row])]
        assert cells[4] == SPOKEN.get(name, name)
        assert cells[6] == ("yes" if rows["verified"][row] else "no")


# --- thresholds ----------------------------------------------------------------------------------------


def test_words_of_thresholds(tmp_path):
    result = written(tmp_path / "edge.rattle")
    names = {1.0: "quiet", 2.0: "creep", 3.0: "idle"}
    kinds: dict[str, int] = {}
    unsure = 0
    for _, _, crossing, _, _, below, above, status_below, status_above, *sides in ROWS:
        if not crossing:
            continue
        ends = [
            names[code] if status == 1.0 else "film lost"
            for code, status in ((below, status_below), (above, status_above))
        ]
        kinds[" to ".join(ends)] = kinds.get(" to ".join(ends), 0) + 1
        unsure += sides != [1.0, 1.0]
    without = sum(row[2] == 0.0 for row in ROWS)
    assert_says(
        threshold.draw(thresholds(result)),
        [
            "Change of class: edge",
            "Entrainment speed [m/s]",
            "Force amplitude [N], searched from 5 to 100 N",
            "not quiet here",
            "end: its neighbour has no such change near",
            *(f"{kind} ({count})" for kind, count in kinds.items()),
            "from lower to upper",
            f"not verified ({unsure})",
            f"no change ({without})",
        ],
    )


def test_words_of_a_level(tmp_path):
    """What lies below the level is called so, wherever it stands."""
    result = level_result(tmp_path / "level.rattle")
    order = [
        [
            "below" if result[f"film_force_rms_{side}"][row] < 100.0 else "at least"
            for side in ("below", "above")
        ]
        for row in range(result.row_count)
    ]
    found = thresholds(result)
    assert found.kinds.tolist() == [f"{one} 100 N to {other} 100 N" for one, other in order]
    quantity = str(result.value("threshold", "criterion")).strip()
    level, unit = float(result.value("threshold", "level")), result.units[f"{quantity}_below"]
    kinds: dict[str, int] = {}
    for row in range(result.row_count):
        if result["crossing"][row] > 0:
            words = [
                f"{'below' if result[f'{quantity}_{side}'][row] < level else 'at least'} {level:g} {unit}"
                for side in ("below", "above")
            ]
            kinds[" to ".join(words)] = kinds.get(" to ".join(words), 0) + 1
    assert kinds and all("below" in kind and "at least" in kind for kind in kinds)
    texts = words_of(threshold.draw(thresholds(result)))
    assert {f"{kind} ({count})" for kind, count in kinds.items()} <= set(texts)
    (label,) = (text for text in texts if "searched from" in text)
    first, last = (float(result.value("threshold", end)) for end in ("first", "last"))
    title = f"{quantity.replace('_', ' ').capitalize()} passes {level:g} {unit}: {result.scene_name}"
    assert title in texts and f"at least {level:g} {unit} here" in texts
    assert label.endswith(f", searched from {first:.4g} to {last:.4g} {result.units['lower']}")


@pytest.mark.parametrize("code", codes.CLASSES)
def test_a_class_against_all_others_is_called_by_its_name(tmp_path, code):
    name = codes.CLASSES[code]
    rows = [[*row[:5], float(code), 1.0 if code > 1 else 2.0, *row[7:]] for row in ROWS if row[2] == 1.0]
    result = written(tmp_path / "edge.rattle", rows=rows, criterion=name)
    texts = words_of(threshold.draw(thresholds(result)))
    words = SPOKEN.get(name, name)
    assert f"Change into or out of {words}: edge" in texts and f"{words} here" in texts
    assert f"{words} to another class ({len(rows)})" in texts
