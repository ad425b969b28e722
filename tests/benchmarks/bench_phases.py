"""Where a campaign spends its time: by phase of its rows, by kind of row, by procedure.

    bench_phases.py PROGRAM [--count N]

`input/gearbox_map.nml` at N x N points on one thread, its stacks sampled by perf. PROGRAM is a build that
keeps frame pointers: make profile. Periods of irregular motions are followed beside a neighbour. Steps are
those of the motion from rest of three rows of each class, solved alone. Prints Markdown tables.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import f90nml
import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "scripts"))

import rattle  # noqa: E402
from rattle import outputs, rerun  # noqa: E402
from rattle.codes import spoken, word  # noqa: E402

READY = REPOSITORY / "input/gearbox_map.nml"
RATE = 997  # samples a second of processor time
PERIODS = ("periods_solved", "start_periods", "followed_periods")
EACH = 3  # rows of a kind that are solved alone
SMALLEST = 0.02  # share of a procedure that is listed
# A stack belongs to the first phase of which it has all procedures.
PHASES = {
    "motions of neighbours": ("handed_motions",),
    "other starts, Newton's method": ("other_motions", "periodic_orbit"),
    "other starts, followed": ("other_motions",),
    "irregular motions, beside a neighbour": ("follow_beside_neighbours",),
    "finer windows": ("classify_finer",),
    "tighter solution, Newton's method": ("verify_group", "periodic_orbit"),
    "tighter solution": ("verify_group",),
    "motion from rest, Newton's method": ("periodic_orbit",),
    "motion from rest": ("solve_group",),
}
OTHER = "reading, judging, writing"


def stacks(samples: Path) -> Iterator[list[str]]:
    """The procedures of each sample, innermost first."""
    command = ["perf", "script", "-i", samples, "-F", "ip,sym"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    for block in text.split("\n\n"):
        lines = [line.split(maxsplit=1) for line in block.strip().splitlines()]
        procedures = [line[1] for line in lines if len(line) == 2]
        if procedures:
            yield procedures


def phase_of(stack: list[str]) -> str:
    names = "\n".join(stack)
    return next((phase for phase, parts in PHASES.items() if all(part in names for part in parts)), OTHER)


def procedure_of(symbol: str) -> str:
    """As 'module: procedure', without what the compiler adds to a name."""
    module, _, procedure = symbol.partition("_MOD_")
    name = f"{module.removeprefix('__')}: {procedure}" if procedure else symbol
    return name.partition(".")[0]


def table(heads: tuple[str, ...], rows: list[tuple[object, ...]]) -> None:
    print(f"\n| {' | '.join(heads)} |\n|---|{'---:|' * (len(heads) - 1)}")
    for row in rows:
        print(f"| {' | '.join(map(str, row))} |")


def kinds(campaign: rattle.Campaign, program: str, folder: Path) -> list[tuple[object, ...]]:
    """A line for each class: rows, periods a row, and steps a period of some rows solved alone."""
    words = np.array([spoken(word("rattle_class", code)) for code in campaign["rattle_class"]])
    lines = []
    for kind in dict.fromkeys(words.tolist()):
        rows = np.flatnonzero(words == kind)
        means = [np.mean(np.nan_to_num(campaign[name][rows])) for name in PERIODS]
        chosen = rows[np.linspace(0, rows.size - 1, min(EACH, rows.size)).astype(int)]
        outputs.write(rerun.inputs(campaign, chosen, folder, "results"), overwrite=True)
        found = [
            rattle.run(
                folder / f"{rerun.scene_label(campaign, row)}.nml",
                set={"solver.starts": 1, "spectrum.verify": False, "output.series": False},
                threads=1,
                program=program,
                overwrite=True,
            ).summary
            for row in chosen
        ]
        lines.append(
            (
                kind,
                rows.size,
                *(f"{mean:.0f}" for mean in means),
                f"{sum(one['steps'] for one in found) / sum(one['periods_solved'] for one in found):.0f}",
            )
        )
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=5)
    options = parser.parse_args()
    if shutil.which("perf") is None:
        sys.exit("bench_phases.py: perf is not installed; Debian has it in linux-perf.")
    warnings.simplefilter("ignore", rattle.InputWarning)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        columns = [*f90nml.read(READY)["campaign"]["record"], *PERIODS]
        settings = [f"campaign.count={options.count},{options.count}"]
        settings.append("campaign.record=" + ",".join(f"'{name}'" for name in columns))
        asked = [options.program, "--quiet", "--threads", "1", "--output", folder, READY]
        asked[1:1] = [word for setting in settings for word in ("--set", setting)]
        record = ["perf", "record", "-q", "-F", str(RATE), "-g", "-o", folder / "samples", "--", *asked]
        subprocess.run(record, check=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
        campaign = rattle.read_campaign(folder / f"{READY.stem}.rattle")
        found = list(stacks(folder / "samples"))
        phases = Counter(map(phase_of, found))
        lines = [
            (phase, f"{100.0 * phases[phase] / len(found):.1f} %", f"{phases[phase] / RATE:.2f}")
            for phase in (*PHASES, OTHER)
            if phases[phase]
        ]
        table(("phase", "share", "processor time [s]"), lines)
        heads = ("class", "rows", "periods from rest", "of other starts", "followed")
        table((*heads, "steps a period"), kinds(campaign, options.program, folder))
        procedures = Counter(procedure_of(stack[0]) for stack in found)
        listed = [pair for pair in procedures.most_common() if pair[1] >= SMALLEST * len(found)]
        table(("procedure", "share"), [(name, f"{100.0 * n / len(found):.1f} %") for name, n in listed])


if __name__ == "__main__":
    main()
