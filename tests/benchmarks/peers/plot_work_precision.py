"""Work-precision figure and Markdown table from the CSV of run_peers.py.

    python plot_work_precision.py work_precision.csv --figure work_precision.png --table work_precision.md

The time at an error is interpolated in log-log between two neighbouring tolerance settings of a contender
on a scene, and averaged over the scenes of a group; it is never extrapolated. A group has no time at an
error that a contender misses on one of its scenes. Where the loosest setting is already more accurate than
asked for, its time is an upper bound, marked by <=.
"""

import argparse
import csv
import math
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt

GROUPS = {
    "published": ("published iso_viscous", "published piezo_viscous"),
    "Reynolds iso-viscous": ("reynolds iso_viscous",),
    "Reynolds piezo-viscous": ("reynolds piezo_viscous",),
}
TABLE_ERRORS = (1e-4, 1e-6, 1e-8)
CURVE_ERRORS = tuple(10.0 ** (-k / 4) for k in range(8, 50))
MARKS = "os^DvPX*<>phd"  # of the peers, in their order
DEFAULT_BASE = "heyoka 8 lanes"
MOST_COLUMNS = 3


@dataclass(frozen=True)
class Cost:
    """CPU seconds at an error; `bound` if they are only an upper bound."""

    seconds: float
    bound: bool


Points = dict[str, dict[str, dict[str, list[tuple[float, float, float]]]]]


def read(path: Path) -> tuple[dict[str, str], Points]:
    """Header, and for contender, film, scene the points (tolerance, error, seconds), loosest first."""
    head: dict[str, str] = {}
    points: Points = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    with path.open() as stream:
        lines = stream.read().splitlines()
    for line in lines:
        if line.startswith("#"):
            key, _, value = line[1:].partition(":")
            head[key.strip()] = value.strip()
    for row in csv.DictReader(line for line in lines if not line.startswith("#")):
        point = (float(row["tolerance"]), float(row["error"]), float(row["cpu_seconds_median"]))
        points[row["contender"]][row["film"]][row["scene"]].append(point)
    for films in points.values():
        for scenes_of_film in films.values():
            for series in scenes_of_film.values():
                series.sort(reverse=True)
    return head, points


def cost_at(series: list[tuple[float, float, float]], error: float) -> Cost | None:
    """Cost on one scene, from the last pair of settings whose errors enclose the one asked for.

    A setting that is more accurate and cheaper still counts instead.
    """
    accurate = [seconds for _, reached, seconds in series if reached <= error]
    if not accurate:
        return None
    cheapest = min(accurate)
    for (_, coarse, before), (_, fine, after) in reversed(list(zip(series, series[1:], strict=False))):
        if coarse > error >= fine > 0:
            share = math.log(coarse / error) / math.log(coarse / fine)
            return Cost(min(cheapest, before * (after / before) ** share), bound=False)
    return Cost(cheapest, bound=True)


def group_cost(films: dict, names: tuple[str, ...], count: int, error: float) -> Cost | None:
    """Mean over the scenes of a group, None unless all `count` scenes have a cost."""
    costs = [cost_at(series, error) for name in names for series in films.get(name, {}).values()]
    if len(costs) < count or None in costs:
        return None
    return Cost(sum(each.seconds for each in costs) / count, any(each.bound for each in costs))


def groups_of(points: Points) -> dict[str, tuple[str, ...]]:
    """Title and films of the groups in the file; changed scenes name theirs."""
    films = dict.fromkeys(film for films in points.values() for film in films)
    plain = [film for names in GROUPS.values() for film in names]
    groups = GROUPS | {film: (film,) for film in films if film not in plain}
    return {title: names for title, names in groups.items() if scene_count(points, names)}


def scene_count(points: Points, names: tuple[str, ...]) -> int:
    """Number of scenes of a group in the file."""
    return len({scene for films in points.values() for name in names for scene in films.get(name, {})})


def cell(cost: Cost | None, base: Cost | None) -> str:
    """Milliseconds and the ratio to the base contender."""
    if cost is None:
        return "-"
    text = f"{'<= ' if cost.bound else ''}{1e3 * cost.seconds:.3g} ms"
    if base is None or (cost.bound and base.bound):
        return text
    sign = "<= " if cost.bound else ">= " if base.bound else ""
    return f"{text} ({sign}{cost.seconds / base.seconds:.3g}x)"


def table(head: dict[str, str], points: Points, base_name: str) -> str:
    """Markdown: one table a group, times and ratios at TABLE_ERRORS."""
    lines = [
        f"CPU time of a scene at an error of the film; in brackets relative to {base_name}.",
        f"{head.get('date', '')}, {head.get('cpu', '')}, {head.get('compiler of the own ones', '')}.",
        f"`{head.get('command', '')}`",
    ]
    for title, names in groups_of(points).items():
        count = scene_count(points, names)
        base = {error: group_cost(points.get(base_name, {}), names, count, error) for error in TABLE_ERRORS}
        lines += [
            "",
            f"| {title}, {count} scene{'s' if count > 1 else ''} | "
            + " | ".join(f"error {error:.0e}" for error in TABLE_ERRORS)
            + " |",
        ]
        lines.append("|---" * (1 + len(TABLE_ERRORS)) + "|")
        for contender, films in points.items():
            cells = [cell(group_cost(films, names, count, error), base[error]) for error in TABLE_ERRORS]
            lines.append(f"| {contender} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def figure(head: dict[str, str], points: Points, path: Path) -> None:
    """One panel a group at page width: time against error, own contenders black, the others with marks."""
    own = [name.strip() for name in head.get("own", "").split(";") if name.strip()]
    groups = groups_of(points)
    plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.7})
    rows = math.ceil(len(groups) / MOST_COLUMNS)
    height = 0.9 + 2.8 * rows  # inches
    picture, axes = plt.subplots(
        rows, min(len(groups), MOST_COLUMNS), figsize=(6.3, height), sharex=True, squeeze=False
    )
    for axis in axes.flat[len(groups) :]:
        axis.remove()
    colours, peers = plt.get_cmap("tab20"), [name for name in points if name not in own]
    for axis, (title, names) in zip(axes.flat, groups.items(), strict=False):
        count = scene_count(points, names)
        for contender, films in points.items():
            costs = [(error, group_cost(films, names, count, error)) for error in CURVE_ERRORS]
            drawn = [(error, 1e3 * cost.seconds) for error, cost in costs if cost and not cost.bound]
            if not drawn:
                continue
            if contender in own:
                dash = ("-", "--", "-.", ":")[own.index(contender) % 4]
                style = {"color": "black", "linewidth": 1.6, "linestyle": dash, "marker": ""}
            else:
                place = peers.index(contender) % len(MARKS)
                style = {"color": colours(place), "linewidth": 0.9, "marker": MARKS[place]}
            axis.loglog(*zip(*drawn, strict=True), label=contender, markevery=4, markersize=3.5, **style)
        title = title.replace(", ", ",\n")
        axis.set_title(f"{title},\n{f'mean of {count} scenes' if count > 1 else 'one scene'}", fontsize=8)
        axis.grid(True, which="major", linewidth=0.4)
    axes[0][0].invert_xaxis()
    for axis in axes[-1]:
        axis.set_xlabel("Largest relative error\nof the film")
    for axis in axes[:, 0]:
        axis.set_ylabel("Processor time of a scene [ms]")
    handles = {}
    for axis in picture.axes:
        handles.update({label: line for line, label in zip(*axis.get_legend_handles_labels(), strict=True)})
    picture.legend(handles.values(), handles.keys(), loc="lower center", ncols=4, frameon=False)
    picture.suptitle(f"{head.get('cpu', '')}, {head.get('date', '')}", fontsize=8)
    picture.tight_layout(rect=(0, 0.52 / height, 1, 1), w_pad=0.6)
    picture.savefig(path, dpi=200)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("csv", type=Path)
    parser.add_argument("--figure", type=Path, default=Path("work_precision.png"))
    parser.add_argument("--table", type=Path, default=Path("work_precision.md"))
    parser.add_argument("--base", help="contender the ratios refer to (default: the first own one)")
    options = parser.parse_args()
    head, points = read(options.csv)
    own = [name.strip() for name in head.get("own", "").split(";") if name.strip()]
    text = table(head, points, options.base or (own[0] if own else DEFAULT_BASE))
    options.table.write_text(text)
    figure(head, points, options.figure)
    print(text, end="")


if __name__ == "__main__":
    main()
