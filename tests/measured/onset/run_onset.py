"""From which inertia ratio on the tooth of a loose gear leaves its flank, over drag and temperature.

    python tests/measured/onset/run_onset.py

Writes table.csv and onset.png beside this file, and prints the table of ../README.md.
"""

from __future__ import annotations

import sys
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "scripts"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tables import read_csv, write_csv

import rattle
from rattle.figures import style
from rattle.figures.campaign_look import plain_log_ticks

HERE = Path(__file__).resolve().parent
INPUT = HERE / "pair.nml"
DRAG_SCALES = (0.5, 1.0, 2.0, 4.0)
TEMPERATURES = (20.0, 60.0, 100.0)  # [degC]
RATIOS = (0.6, 1.5)  # inertia ratios between which separation is looked for
SEARCH = {"criterion": "separation", "scale": "logarithmic", "count": 2, "tolerance": 5e-3}
HEAD = ("drag_scale", "oil_celsius", "drag_torque_N_m", "ratio_at_onset", "crossings")


def onset(
    drag_scale: float, temperature: float, between: tuple[float, float] = RATIOS
) -> tuple[float, float, int]:
    """Drag torque [N m], inertia ratio where separation begins, and at how many it begins or ends."""
    changes = {"gear.drag_scale": drag_scale, "oil.temperature_celsius": temperature}
    short = {"solver.until": "periods", "solver.periods": 4, "spectrum.verify": False}
    once = rattle.run(INPUT, set=changes | short).summary
    # The ratio is in proportion to the scale of the force.
    first, last = (ratio / once["inertia_ratio"] for ratio in between)
    rows = rattle.threshold(INPUT, "load.force_scale", first, last, set=changes, **SEARCH).result.frame()
    found = rows[rows["crossing"] > 0]
    middle = np.sqrt(found["lower"] * found["upper"]).min() * once["inertia_ratio"]
    return float(once["drag_torque"]), float(middle), len(found)


def draw(rows: list[dict[str, str]]) -> None:
    with style.house_style():
        figure = Figure(figsize=(style.WIDTH, 3.4))
        axes = figure.subplots()
        for place, temperature in enumerate(TEMPERATURES):
            here = [row for row in rows if float(row["oil_celsius"]) == temperature]
            axes.plot(
                [float(row["drag_torque_N_m"]) for row in here],
                [float(row["ratio_at_onset"]) for row in here],
                label=f"{temperature:g} \N{DEGREE SIGN}C",
                marker="o",
                **style.run_line(place),
            )
        axes.axhline(1.0, color=style.FORCE_COLOUR, lw=0.8)
        axes.text(0.011, 1.005, "rule: rigid tooth without oil", va="bottom", fontsize=8)
        axes.set(xscale="log", xlim=(0.01, 1.0), xlabel="Drag torque [N m]", ylabel="Inertia ratio [-]")
        plain_log_ticks(axes.xaxis, 0.01, 1.0)
        axes.set_title("Inertia ratio from which on the tooth leaves its flank, computed")
        style.legend_below(figure, axes, 3)
        figure.savefig(HERE / "onset.png", dpi=110, metadata={"Software": None})


def main() -> int:
    # Ratios below 1, of which the program warns, are meant.
    warnings.simplefilter("ignore", rattle.InputWarning)
    cells = [(scale, temperature) for temperature in TEMPERATURES for scale in DRAG_SCALES]
    with ThreadPoolExecutor() as pool:
        table = [
            (*cell, *found)
            for cell, found in zip(cells, pool.map(onset, *zip(*cells, strict=True)), strict=True)
        ]
    write_csv(HERE / "table.csv", HEAD, table)
    rows = read_csv(HERE / "table.csv")
    head = " | ".join(f"drag x {scale:g}" for scale in DRAG_SCALES)
    lines = [f"| oil | {head} |", "|---" * (1 + len(DRAG_SCALES)) + "|"]
    for temperature in TEMPERATURES:
        cells = [
            f"{float(row['ratio_at_onset']):.2f} ({float(row['drag_torque_N_m']):.3f} N m)"
            for row in rows
            if float(row["oil_celsius"]) == temperature
        ]
        lines.append(f"| {temperature:g} degC | {' | '.join(cells)} |")
    print("\n".join(lines))
    draw(rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
