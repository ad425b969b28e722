"""Random loose gears with their films in nodes, as exact as asked: how far they are off 128 nodes.

    python tests/stress/nodal_accuracy.py build/rattle [--scenes 50] [--first 1] [--accuracies 1e-2 1e-3]

Gears are those of closure_errors.py, two periods from rest. Nodes and bound are those of `solver.accuracy`.
The reference has 128 nodes and an accuracy of 1e-5. Errors are those of the largest acceleration and of the
smallest film of both flanks, relative to themselves; goals are the accuracy and three times that.
"""

from __future__ import annotations

import argparse
import resource
import statistics
from pathlib import Path

from closure_errors import film_of, peak_of, scene_of, solved

REFERENCE = 1e-5


def solution_of(number: int, accuracy: float, program: Path) -> tuple[dict, float]:
    """Summary of a scene, and the processor time that it took [s]."""
    settings = {"film.model": "resolved", "solver.accuracy": accuracy}
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    reported = solved(scene_of(number)[0], settings, program)
    return reported, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def row_of(accuracy: float, numbers: range, references: dict[int, dict], program: Path) -> str:
    """A line of the table: errors, scenes that miss the goals, and times."""
    peaks, films, seconds, misses = [], [], [], []
    for number in numbers:
        reported, spent = solution_of(number, accuracy, program)
        seconds.append(spent)
        if not reported["status"] == references[number]["status"] == "complete":
            misses.append(f"{number} ({reported['status']})")
            continue
        peaks.append(abs(peak_of(reported) / peak_of(references[number]) - 1.0))
        films.append(abs(film_of(reported) / film_of(references[number]) - 1.0))
        if peaks[-1] > accuracy or films[-1] > 3.0 * accuracy:
            misses.append(f"{number} (peak {peaks[-1]:.1e}, film {films[-1]:.1e})")
    pairs = [(choice, errors) for errors in (peaks, films) for choice in (statistics.median, max)]
    cells = [f"{accuracy:g}", *(f"{choice(errors):.1e}" for choice, errors in pairs)]
    return " | ".join(
        ["", *cells, ", ".join(misses) or "none", f"{statistics.median(seconds):.2f}", ""]
    ).strip()


def main() -> None:
    """Solve the scenes and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--scenes", type=int, default=50)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--accuracies", type=float, nargs="+", default=[1e-2, 3e-3, 1e-3, 1e-4])
    options = parser.parse_args()
    numbers = range(options.first, options.first + options.scenes)
    references = {number: solution_of(number, REFERENCE, options.program)[0] for number in numbers}
    print("| accuracy | peak, median | largest | film, median | largest | beyond a goal | seconds, median |")
    print("|---|---:|---:|---:|---:|---|---:|")
    for accuracy in options.accuracies:
        print(row_of(accuracy, numbers, references, options.program))


if __name__ == "__main__":
    main()
