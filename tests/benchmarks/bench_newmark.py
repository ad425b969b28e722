"""Speed of the program as a user meets it: a Newmark step, start-up, the series, memory. Prints a table.

    bench_newmark.py PROGRAM BENCH_MOTION FLAGS_FILE

Every figure is a median; PROGRAM is called as a whole process for all but the first two rows.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROUNDS = 21
INPUTS = ("input/idle.nml", "input/creep.nml")


def wall_milliseconds(command: list[str], rounds: int = ROUNDS) -> float:
    """Median wall time of a command [ms], after one call that warms the caches."""
    times = []
    for _ in range(rounds + 1):
        start = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        times.append(1e3 * (time.perf_counter() - start))
    return statistics.median(times[1:])


def peak_megabytes(command: list[str]) -> float:
    """Peak resident memory of a command [MB]."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        raise subprocess.CalledProcessError(status, command)
    return usage.ru_maxrss / 1024.0


def processor() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown processor"


def main() -> None:
    program, bench, flags = sys.argv[1:4]
    compiler, options = Path(flags).read_text().splitlines()[:2]
    print(f"processor {processor()}; {compiler}")
    print(f"flags {options}")
    rows: list[tuple[str, str, str]] = []
    for line in subprocess.run(
        [bench, *INPUTS], check=True, capture_output=True, text=True
    ).stdout.splitlines():
        name, nanoseconds, iterations = line.split(",")
        rows.append((f"{name}: a Newmark step, 512 a period", f"{float(nanoseconds):.1f} ns", "60 ns"))
        rows.append((f"{name}: Newton's iterations a step", f"{float(iterations):.3f}", "2"))
    with tempfile.TemporaryDirectory() as place:
        base = [program, "--quiet", "--overwrite", "--output", place, "--set", "spectrum.verify=.false."]
        long_run = ["--set", "solver.periods=4000", INPUTS[0]]
        check = wall_milliseconds([program, "--check", INPUTS[0]])
        rows.append(("start-up and input (rattle --check)", f"{check:.1f} ms", "10 ms"))
        bare = wall_milliseconds([*base, "--set", "output.series=.false.", *long_run], 7)
        full = wall_milliseconds([*base, *long_run], 7)
        rows.append(("idle, 4000 periods, no series", f"{bare:.1f} ms", ""))
        rows.append(("  writing its series (4 columns) on top", f"{full - bare:.1f} ms", f"{bare:.1f} ms"))
        silent = [*base, "--set", "output.series=.false.", INPUTS[0]]
        few = peak_megabytes([*silent, "--set", "solver.periods=100"])
        many = peak_megabytes([*silent, "--set", "solver.periods=20000"])
        rows.append(("peak memory, 100 periods, no series", f"{few:.1f} MB", ""))
        rows.append(("peak memory, 20000 periods, no series", f"{many:.1f} MB", f"{few:.1f} MB"))
    width = max(len(row[0]) for row in rows)
    print(f"{'what':<{width}}  {'measured':>12}  {'at most':>10}")
    for what, measured, limit in rows:
        print(f"{what:<{width}}  {measured:>12}  {limit:>10}")


if __name__ == "__main__":
    main()
