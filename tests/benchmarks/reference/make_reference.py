"""Make film.csv, the reference motions of the bench, in two independent ways, and say how well they agree.

Command: python tests/benchmarks/reference/make_reference.py [--check]
(numpy, gcc with libquadmath; about ten minutes)

film.csv holds the first way (extrapolation.c, quadruple precision), the second is collocation.c (long
double). With --check the file is compared, not written.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "peers"))

import scenes  # noqa: E402

FILMS = ("published iso_viscous", "published piezo_viscous", "reynolds iso_viscous", "reynolds piezo_viscous")
COLLOCATION_STEPS = 6
LIMIT = 1e-13


def run(program: Path, scene: scenes.Scene, *more: int) -> list[str]:
    """Film values that one of the two programs prints for a scene."""
    numbers = [f"{value:.17g}" for value in scene.parameters]
    counts = [str(n) for n in (scenes.PERIODS, scenes.SAMPLED_PERIODS, scenes.POINTS_A_PERIOD, *more)]
    call = [str(program), str(FILMS.index(scene.film)), *numbers, *counts]
    return subprocess.run(call, check=True, capture_output=True, text=True).stdout.split()


def main() -> None:
    """Run both ways, compare, write."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--check", action="store_true", help="compare film.csv instead of writing it")
    check = parser.parse_args().check
    names, columns, worst = [], [], 0.0
    with tempfile.TemporaryDirectory() as folder:
        programs = {}
        for name in ("extrapolation", "collocation"):
            programs[name] = Path(folder) / name
            source = HERE / f"{name}.c"
            flags = ["-O2", "-std=gnu11", "-Wall", "-Wextra", "-Werror"]
            subprocess.run(["gcc", *flags, "-o", programs[name], source, "-lquadmath", "-lm"], check=True)
        for scene in scenes.all_scenes():
            start = time.perf_counter()
            text = run(programs["extrapolation"], scene)
            middle = time.perf_counter()
            other = run(programs["collocation"], scene, COLLOCATION_STEPS)
            first, second = np.array(text, dtype=np.longdouble), np.array(other, dtype=np.longdouble)
            difference = float(np.max(np.abs(first / second - 1)))
            worst = max(worst, difference)
            print(
                f"{scene.name:22s} two ways agree to {difference:.1e} "
                f"({middle - start:.0f} s, {time.perf_counter() - middle:.0f} s)",
                flush=True,
            )
            names.append(scene.name)
            columns.append(first.astype(float))
    table = np.array(columns).T
    if check:
        stored = scenes.reference_film()
        worst = max([worst, *(scenes.film_error(stored[n], c) for n, c in zip(names, columns, strict=True))])
    else:
        with (HERE / "film.csv").open("w") as stream:
            stream.write("# h/h0 at tau = 190 + k/64, k = 1 ... 640, of the scenes in ../peers/scenes.py\n")
            stream.write("# made by: python tests/benchmarks/reference/make_reference.py\n")
            stream.write(f"# two independent ways agree to {worst:.1e} (relative)\n")
            stream.write(",".join(names) + "\n")
            for row in table:
                stream.write(",".join(f"{value:.17g}" for value in row) + "\n")
    print(f"largest difference {worst:.1e}")
    if worst > LIMIT:
        sys.exit(f"the ways differ by more than {LIMIT:.0e}")


if __name__ == "__main__":
    main()
