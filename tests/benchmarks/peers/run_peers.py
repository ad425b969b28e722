"""Run time against error of every contender on the bench scenes, written as CSV.

    python run_peers.py --output work_precision.csv [--quick] [--changed] [--own "NAME=COMMAND" ...]

Each contender solves each scene with a series of tolerances. A first solution compiles, measures the error
against the reference and the time; then come N rounds, each timing every setting once in turn, so that a
slow spell of the machine meets all contenders alike. The CSV has the median over the rounds of the CPU
seconds of one solution. A series ends where a solution takes longer than --limit seconds, or a call, which
may fill many lanes, longer than ten times that, or where its error is below --finest. --own adds a
contender that is a command (protocol: command.py), run side by side with the peers; it may be given several
times; --flags names the file in which make keeps their compiler and flags. A contender that is not installed,
or that fails on a setting, is reported and left out.

--changed adds the published scenes changed by several orders, two flanks and elastic teeth, and leaves out
the Reynolds films. Their references are made at the start: heyoka at its tightest tolerance, CVODE beside it
says how sure that is. Peers without these equations are left out.
"""

import argparse
import csv
import datetime
import importlib
import math
import os
import platform
import shlex
import statistics
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import command
import scenes

PEERS = ("cvode_peer", "scipy_peer", "numbalsoda_peer", "cyrk_peer", "diffsol_peer", "heyoka_peer")
CHANGED_PEERS = ("cvode_peer", "heyoka_peer")
OWN_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
QUICK_TOLERANCES = (1e-4, 1e-6, 1e-8)
LEAST_SECONDS = 0.01
# A call may take so many times the limit of a solution.
CALL_LIMIT = 10
COLUMNS = ("contender", "version", "scene", "film", "tolerance", "error", "cpu_seconds_median", "rounds")

Solve = Callable[[], tuple]


@dataclass
class Contender:
    """Name, version, `prepare(scene, tolerance)`, the series of tolerances, and whether it is a command."""

    name: str
    version: str
    prepare: Callable[[scenes.Scene, float], Solve]
    tolerances: tuple[float, ...]
    is_command: bool


@dataclass
class Setting:
    """One contender at one tolerance on one scene, with its times."""

    contender: Contender
    scene: scenes.Scene
    tolerance: float
    solve: Solve
    error: float
    seconds: list[float] = field(default_factory=list)


def report(text: str) -> None:
    """A line to standard error."""
    print(text, file=sys.stderr, flush=True)


def mean_seconds(setting: Setting) -> float:
    """Mean CPU seconds of as many solutions as make up LEAST_SECONDS; a command does that by itself."""
    total, count = 0.0, 0
    while count == 0 or (total < LEAST_SECONDS and not setting.contender.is_command):
        total += setting.solve()[1]
        count += 1
    return total / count


def found_peers(peers: tuple[str, ...], only: list[str] | None) -> list[Contender]:
    """The contenders that are installed."""
    found = []
    for name in peers:
        try:
            module = importlib.import_module(name)
        except (ImportError, OSError) as error:
            report(f"skipped, not installed: {name} ({error})")
            continue
        for title, (prepare, tolerances) in module.CONTENDERS.items():
            if not only or any(word.lower() in title.lower() for word in only):
                found.append(Contender(title, module.VERSION, prepare, tolerances, module.IS_COMMAND))
    return found


def own_contender(text: str) -> Contender:
    """Contender of an option --own NAME=COMMAND."""
    name, equals, words = text.partition("=")
    if not equals:
        name, words = "rattle", text
    call = shlex.split(words)
    answer = subprocess.run([*call, "--version"], capture_output=True, text=True)
    lines = answer.stdout.strip().splitlines() if answer.returncode == 0 else []
    return Contender(
        name,
        lines[0] if lines else "unknown",
        partial(command.prepare, call),
        OWN_TOLERANCES,
        is_command=True,
    )


def changed_references(chosen: list[scenes.Scene]) -> dict:
    """Films of changed scenes by heyoka at its tightest, and by CVODE, another method, for comparison."""
    import cvode_peer
    import heyoka_peer

    films = {}
    for scene in chosen:
        # Where a film ruptures explicit steps are too short, and only CVODE gets on.
        explicit = scenes.LETS_GO not in scene.group
        tight = heyoka_peer.prepare_scalar(scene, 1e-16) if explicit else cvode_peer.prepare(scene, 1e-12)
        films[scene.name], _ = tight()
        other, _ = cvode_peer.prepare(scene, 1e-11)()
        report(f"reference of {scene.name}: two ways {scenes.film_error(other, films[scene.name]):.0e} apart")
    return films


def first_solutions(
    contender: Contender,
    chosen: list[scenes.Scene],
    reference: dict,
    quick: bool,
    limit: float,
    finest: float,
) -> list[Setting]:
    """Compile and solve once at every tolerance; errors of the settings to be timed."""
    settings = []
    for scene in chosen:
        for tolerance in QUICK_TOLERANCES if quick else contender.tolerances:
            try:
                solve = contender.prepare(scene, tolerance)
                begin = sum(os.times()[:4])
                film, seconds = solve()
                call = sum(os.times()[:4]) - begin
                if scene.periods < scenes.PERIODS:
                    solve = contender.prepare(
                        replace(scene, periods=scenes.PERIODS, name=f"{scene.name} timed"), tolerance
                    )
            except Exception as failure:  # whatever a peer raises costs this setting only
                report(f"left out: {contender.name}, {scene.name}, tolerance {tolerance:g}: {failure}")
                continue
            error = scenes.film_error(film, reference[scene.name])
            if math.isfinite(error):
                settings.append(Setting(contender, scene, tolerance, solve, error))
            else:
                report(f"left out: {contender.name}, {scene.name}, tolerance {tolerance:g}: no finite motion")
            if max(seconds, call / CALL_LIMIT) > limit:
                report(
                    f"series ends: {contender.name}, {scene.name}, tolerance {tolerance:g}: "
                    f"{seconds:.2g} s a solution, {call:.2g} s a call"
                )
                break
            if error < finest:
                break
    return settings


def cpu_model() -> str:
    """Name of the processor."""
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def first_line(*call: str) -> str:
    """First line that a command prints, or 'none'."""
    try:
        return subprocess.run(call, capture_output=True, text=True, check=True).stdout.splitlines()[0]
    except (OSError, subprocess.CalledProcessError, IndexError):
        return "none"


def header(
    contenders: list[Contender], own: list[Contender], rounds: int, flags: Path | None
) -> dict[str, str]:
    """What a reader needs to judge the numbers."""
    versions = {each.name: each.version for each in contenders}
    built = flags.read_text().splitlines()[:2] if flags else []
    return {
        "date": datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "command": "python " + " ".join(shlex.quote(word) for word in sys.argv),
        "cpu": cpu_model(),
        "system": platform.platform(),
        "python": platform.python_version(),
        "compiler of the own ones": ", ".join(built),
        "compiler of cvode_peer.c": f"{first_line('gcc', '--version')} -O3 -march=native",
        "clock": f"CPU time of one thread, median of {rounds} interleaved rounds, compilation excluded",
        "versions": "; ".join(f"{name} {version}" for name, version in versions.items()),
        "own": "; ".join(each.name for each in own),
    }


def write(path: Path, head: dict[str, str], settings: list[Setting]) -> None:
    """The CSV file."""
    with path.open("w", newline="") as stream:
        for key, value in head.items():
            stream.write(f"# {key}: {value}\n")
        rows = csv.writer(stream, lineterminator="\n")
        rows.writerow(COLUMNS)
        for each in settings:
            median = statistics.median(each.seconds)
            rows.writerow(
                [
                    each.contender.name,
                    each.contender.version,
                    each.scene.name,
                    each.scene.group or each.scene.film,
                ]
                + [f"{each.tolerance:.3g}", f"{each.error:.4e}", f"{median:.6e}", len(each.seconds)]
            )


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--output", type=Path, default=Path("work_precision.csv"))
    parser.add_argument("--own", action="append", default=[], metavar="NAME=COMMAND")
    parser.add_argument("--only", action="append", metavar="WORD", help="only peers whose name has this word")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument(
        "--limit", type=float, default=2.0, help="seconds of a solution after which a series ends"
    )
    parser.add_argument(
        "--finest", type=float, default=0.0, help="error below which a series ends (none: all its settings)"
    )
    parser.add_argument("--flags", type=Path, help="flags file of the build of the own ones")
    parser.add_argument("--changed", action="store_true", help="published scenes, as they are and changed")
    parser.add_argument("--quick", action="store_true", help="F0 = Q only, three tolerances, three rounds")
    options = parser.parse_args()
    own = [own_contender(text) for text in options.own]
    contenders = own + found_peers(CHANGED_PEERS if options.changed else PEERS, options.only)
    if not contenders:
        report("no contender found")
        return 1
    chosen, rounds, reference = scenes.all_scenes(), options.rounds, scenes.reference_film()
    if options.changed:
        changed = scenes.changed_scenes()
        try:
            reference |= changed_references(changed)
        except ImportError as error:
            report(f"the references of changed scenes need heyoka and CVODE: {error}")
            return 1
        chosen = [scene for scene in chosen if scene.model == "published"] + changed
    if options.quick:
        chosen = [each for each in chosen if each.force_amplitude == scenes.STATIC_FORCE]
        rounds = 3
    settings = []
    for contender in contenders:
        settings += first_solutions(
            contender, chosen, reference, options.quick, options.limit, options.finest
        )
        count = sum(each.contender is contender for each in settings)
        report(f"{contender.name} {contender.version}: {count} settings")
    for number in range(rounds):
        for each in settings:
            each.seconds.append(mean_seconds(each))
        report(f"round {number + 1} of {rounds} done")
    write(options.output, header(contenders, own, rounds, options.flags), settings)
    report(f"written: {options.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
