"""What the program says of the trends that test stands report, for the pairs of a gearbox at idle, and of
what the paper calls idle and creep.

    python tests/trends/run_trends.py

Writes trends.png beside this file, and prints the tables of README.md.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import spearmanr

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

import rattle
from rattle.codes import CLASSES, CODES, spoken
from rattle.figures import style
from rattle.figures.campaign_look import plain_log_ticks
from rattle.thresholds import WITH_IMPACTS

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
INPUT = ROOT / "input" / "gearbox_tolerances.nml"
ACCELERATION = 600.0  # of the main order in the input [rad/s2]
COUNT = 29
QUANTITIES = (
    "film_force_rms",
    "impacts_per_period_drive",
    "impacts_per_period_coast",
    "impact_impulse_mean_drive",
    "impact_impulse_mean_coast",
    "verdict",
)
# Name, key, values of the key, what the axis shows of them, its label.
AXES = (
    ("acceleration", "load.force_scale", (100.0, 1500.0), 1.0 / ACCELERATION, "Main order [rad/s$^2$]"),
    ("oil temperature", "oil.temperature_celsius", (20.0, 110.0), 1.0, "Oil [\N{DEGREE SIGN}C]"),
    ("backlash", "gear.backlash", (20.0, 300.0), 1e-6, r"Backlash [$\mathrm{\mu}$m]"),
    ("drag", "gear.drag_scale", (0.25, 4.0), 1.0, "Drag over computed [-]"),
)
MAP = ROOT / "input" / "map.nml"
LAWS = ("iso-viscous", "piezo-viscous")


def solve(key: str, values: np.ndarray) -> rattle.Campaign:
    """The pairs with the film that is the default of gears, not the quicker one of so many tolerances."""
    text = re.sub(r"&film\n.*?\n/\n", "", INPUT.read_text().partition("&campaign")[0], flags=re.DOTALL)
    more = {"solver.periods": 200, "campaign.samples_per_period": 256}
    return rattle.campaign(text, {key: values}, record=QUANTITIES, set=more).result


def impulse_flow(pair: rattle.Campaign, frequency: float) -> np.ndarray:
    """Impulse of all impacts in a second [N s/s]."""
    flanks = [
        np.nan_to_num(np.array(pair[f"impacts_per_period_{flank}"]))
        * np.nan_to_num(np.array(pair[f"impact_impulse_mean_{flank}"]))
        for flank in ("drive", "coast")
    ]
    return frequency * sum(flanks)


def trend(values: np.ndarray, numbers: np.ndarray) -> str:
    """Rank correlation, and by how much the level changes from the first to the last value."""
    usable = np.isfinite(numbers) & (numbers > 0.0)
    if np.sum(usable) < 3:
        return "-"
    rank = spearmanr(values[usable], numbers[usable]).statistic
    ends = numbers[usable][[0, -1]]
    return f"{rank:+.2f}, {20.0 * np.log10(ends[1] / ends[0]):+.0f} dB"


def classes_and_verdicts() -> list[str]:
    """How many scenes of the paper's map have each class and verdict, under both published laws."""
    verdicts = CODES["verdict"]
    rows = [f"| law | class | scenes | {' | '.join(verdicts.values())} |"]
    rows.append("|---" * (3 + len(verdicts)) + "|")
    for law in LAWS:
        changes = {
            "film.law": law,
            "campaign.count": (101, 101),
            "campaign.record": ("rattle_class", "verdict"),
        }
        found = rattle.run(MAP, set=changes).result
        reported = np.array(found["rattle_class"]), np.array(found["verdict"])
        for code, word in CLASSES.items():
            counts = [np.sum((reported[0] == code) & (reported[1] == verdict)) for verdict in verdicts]
            if sum(counts) > 0:
                shares = " | ".join(f"{count / sum(counts):.1%}" for count in counts)
                rows.append(f"| {law} | {spoken(word)} | {sum(counts)} | {shares} |")
    return rows


def main() -> int:
    rows = ["| varied | pair | film force rms | impulse a second | impacts at |", "|---|---|---|---|---|"]
    with style.house_style():
        figure = Figure(figsize=(style.WIDTH, 6.8))
        panels = figure.subplots(len(AXES), 2)
        for (name, key, ends, unit, label), (left, right) in zip(AXES, panels, strict=True):
            space = np.geomspace if name == "drag" else np.linspace
            shown = space(*ends, COUNT)
            campaign = solve(key, unit * shown)
            frequency = float(campaign.input["shaft"]["speed_rpm"]) / 60.0 * 2.0
            for place, pair in enumerate(campaign.pairs):
                gear = campaign.gears[place]
                force, impulse = np.array(pair["film_force_rms"]), impulse_flow(pair, frequency)
                line = style.run_line(place)
                left.plot(shown, 20.0 * np.log10(force), label=gear, **line)
                with np.errstate(divide="ignore"):
                    right.plot(shown, 20.0 * np.log10(impulse), **line)
                hit = np.isin(pair["verdict"], WITH_IMPACTS)
                words = f"{np.mean(hit):.0%} of the values"
                rows.append(
                    f"| {name} | {gear} | {trend(shown, force)} | {trend(shown, impulse)} | {words} |"
                )
            for axes in (left, right):
                axes.set_xlabel(label)
                if name == "drag":
                    axes.set_xscale("log")
                    plain_log_ticks(axes.xaxis, *ends)
        panels[0, 0].set_title("Film force rms [dB re 1 N]")
        panels[0, 1].set_title("Impulse a second [dB re 1 N]")
        figure.suptitle(
            f"Pairs of {INPUT.stem}, one key varied at a time: {style.film_words(campaign)}",
            x=0.02,
            ha="left",
            fontsize=9.5,
        )
        style.legend_below(figure, panels[0, 0], 4)
        figure.savefig(HERE / "trends.png", dpi=110, metadata={"Software": None})
    print("\n".join([*rows, "", *classes_and_verdicts()]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
