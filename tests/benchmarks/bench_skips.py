"""What is skipped where a scene does not need it, and what that saves. Prints a Markdown table.

    bench_skips.py PROGRAM

Each row runs a scene with the thing and without it, in turn; the times are medians of the whole process.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time

ROUNDS = 9
NEWMARK = [
    "--set",
    "solver.periods=4000",
    "--set",
    "output.series=.false.",
    "--set",
    "spectrum.verify=.false.",
]
TAYLOR = [
    *("--set", "output.series=.false.", "--set", "spectrum.verify=.false."),
    *("--set", "film.law=iso-viscous", "--set", "solver.periods=4000"),
]
MAP = ["--threads", "1", "--set", "campaign.count=101, 101", "input/map.nml"]
# The columns of the map, all but `verified`
PLAIN = [
    "--set",
    "campaign.record=film_minimum,film_maximum,acceleration_minimum,acceleration_maximum,natural_frequency,"
    "damping_ratio,harmonic_count,harmonic_distortion,irregular_fraction,reversals_per_period,rattle_class,"
    "sampling_sufficient,film_regime,alpha_p_maximum,model_limit,harmonics",
]
LEAN = ["--set", "campaign.record=film_minimum,film_maximum"]
BARE = "tests/benchmarks/bare.nml"

# what, when it is skipped, with it, without it
ROWS = (
    (
        "rupture (18)",
        "`rupture = 'half-pi'`",
        [*NEWMARK, "--set", "film.rupture=solved", "input/idle.nml"],
        [*NEWMARK, "input/idle.nml"],
    ),
    ("exponential", "iso-viscous law", [*NEWMARK, "input/creep.nml"], [*NEWMARK, "input/idle.nml"]),
    (
        "series",
        "`series = .false.`",
        [*NEWMARK, "--set", "output.series=.true.", "input/idle.nml"],
        [*NEWMARK, "input/idle.nml"],
    ),
    (
        "verification",
        "`verify = .false.`",
        [*TAYLOR, "--set", "spectrum.verify=.true.", BARE],
        [*TAYLOR, BARE],
    ),
    (
        "periods after the motion repeats",
        "`until = 'steady'`",
        [*TAYLOR, BARE],
        [*TAYLOR, "--set", "solver.until=steady", BARE],
    ),
    ("verification of every scene", "`verified` not in `record`", MAP, [*PLAIN, *MAP]),
    (
        "spectrum and pressure scan",
        "columns of a campaign that need none",
        [*PLAIN, *MAP],
        [*LEAN, *MAP],
    ),
    (
        "pressure scan",
        "columns of a campaign that need none",
        [*LEAN[:1], "campaign.record=film_minimum,alpha_p_maximum", *MAP],
        [*LEAN, *MAP],
    ),
)


def main() -> None:
    program = sys.argv[1]
    print("| skipped | when | with it [ms] | without [ms] | saves |")
    print("|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as place:
        base = [program, "--quiet", "--overwrite", "--output", place]
        for what, when, full, short in ROWS:
            times: dict[bool, list[float]] = {True: [], False: []}
            for _ in range(ROUNDS):
                for needed, options in ((True, full), (False, short)):
                    start = time.perf_counter()
                    subprocess.run([*base, *options], check=True, stdout=subprocess.DEVNULL)
                    times[needed].append(1e3 * (time.perf_counter() - start))
            with_it, without = (statistics.median(times[needed]) for needed in (True, False))
            print(
                f"| {what} | {when} | {with_it:.1f} | {without:.1f} | {100 * (1 - without / with_it):.0f} % |"
            )


if __name__ == "__main__":
    main()
