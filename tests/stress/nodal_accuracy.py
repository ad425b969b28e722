"""Random loose gears with their films in nodes, as exact as asked: how far they are off 128 nodes.

    python tests/stress/nodal_accuracy.py build/rattle [--scenes 50] [--first 1] [--accuracies 1e-2 1e-3]
    python tests/stress/nodal_accuracy.py build/rattle --sensitive

Gears are those of closure_errors.py, two periods from rest. Nodes and bound are those of `solver.accuracy`.
The reference has 128 nodes and an accuracy of 1e-5. Errors are those of the largest acceleration and of the
smallest film of both flanks, relative to themselves; goals are the accuracy and three times that.

With --sensitive the table is of the gears whose peak no method computes as exactly: how far it moves under
the closure where the force is larger or smaller by a millionth.
"""

from __future__ import annotations

import argparse
import resource
import statistics
from pathlib import Path

from closure_errors import film_of, peak_of, scene_of, solved

REFERENCE = 1e-5
CHANGE = 1e-6
SENSITIVE = 1e-4


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


def change_by_force(number: int, program: Path) -> float:
    """How far the peak under the closure moves, relative to it, with a force that is a millionth off."""
    peaks = []
    for factor in (1.0, 1.0 - CHANGE, 1.0 + CHANGE):
        scene = scene_of(number)[0]
        scene["load"]["force_amplitudes"] = [factor * force for force in scene["load"]["force_amplitudes"]]
        peaks.append(peak_of(solved(scene, {}, program)))
    return max(abs(peak / peaks[0] - 1.0) for peak in peaks[1:])


def print_sensitive(numbers: range, program: Path) -> None:
    """Table of the gears whose peak moves by more than SENSITIVE, and of the largest change of the others."""
    changes = {number: change_by_force(number, program) for number in numbers}
    sensitive = [number for number in numbers if changes[number] > SENSITIVE]
    print("| gear | change of the peak |")
    print("|---|---:|")
    for number in sensitive:
        print(f"| {number} | {changes[number]:.1e} |")
    others = [changes[number] for number in numbers if number not in sensitive]
    print(f"| largest of the other {len(others)} | {max(others):.1e} |")


def main() -> None:
    """Solve the scenes and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--scenes", type=int, default=50)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--accuracies", type=float, nargs="+", default=[1e-2, 3e-3, 1e-3, 1e-4])
    parser.add_argument("--sensitive", action="store_true")
    options = parser.parse_args()
    numbers = range(options.first, options.first + options.scenes)
    if options.sensitive:
        print_sensitive(numbers, options.program)
        return
    references = {number: solution_of(number, REFERENCE, options.program)[0] for number in numbers}
    print("| accuracy | peak, median | largest | film, median | largest | beyond a goal | seconds, median |")
    print("|---|---:|---:|---:|---:|---|---:|")
    for accuracy in options.accuracies:
        print(row_of(accuracy, numbers, references, options.program))


if __name__ == "__main__":
    main()
