"""What the closure of the elastohydrodynamic film costs beside the Reynolds film of rigid flanks on the same
springs.

    bench_closure.py PROGRAM [--rounds 3] [--side 12] [--many 100]

Loose gears over force and viscosity, side by side squared of them, until steady, with every class
verified and without; one thread, processor time of the whole process, medians of interleaved rounds. Then
many squared loose gears by the closure until steady, once.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import subprocess
import tempfile
from pathlib import Path

INPUT = """&scene name = 'gears', task = 'campaign' /
&contact radius = 9.1e-3, length = 0.019, backlash = 110.0e-6, stiffness = 2.4e8 /
&lubricant viscosity = 0.02, pressure_viscosity = 1.6e-8 /
&kinematics rolling_speed = 2.8 /
&load mass = 0.62, steady_force = 2.0, gravity = 0.0, frequency = 30.0, force_amplitude = 6.0 /
&solver until = 'steady', periods = 60, starts = 1, samples_per_period = 256, accuracy = 1e-6 /
&spectrum periods = 2 /
&campaign vary = 'load.force_amplitude', 'lubricant.viscosity', neighbours = .false.
   first = 2.0, 0.005, last = 30.0, 0.15 /
"""
COLUMNS = ("film_minimum", "acceleration_maximum", "acceleration_minimum", "rattle_class")
LAWS = {
    "rigid flanks, constant viscosity": ("film.law=iso-viscous", "film.model=reynolds"),
    "closure, constant viscosity": ("film.law=elastohydrodynamic", "lubricant.viscosity_law=constant"),
    "closure, Roelands": ("film.law=elastohydrodynamic", "lubricant.viscosity_law=roelands"),
}


def seconds(program: str, place: Path, side: int, law: tuple[str, ...], verified: bool) -> float:
    """Processor time of a campaign [s]."""
    record = ",".join(f"'{name}'" for name in (*COLUMNS, *(("verified",) if verified else ())))
    settings = (*law, f"campaign.count={side},{side}", f"campaign.record={record}")
    command = [program, "--quiet", "--overwrite", "--threads", "1", "--output", str(place)]
    for setting in settings:
        command += ["--set", setting]
    (place / "gears.nml").write_text(INPUT)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([*command, str(place / "gears.nml")], check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--side", type=int, default=12)
    parser.add_argument("--many", type=int, default=100)
    options = parser.parse_args()
    kinds = [(name, verified) for verified in (True, False) for name in LAWS]
    times: dict[tuple[str, bool], list[float]] = {kind: [] for kind in kinds}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(options.rounds):
            for name, verified in kinds:
                times[name, verified].append(
                    seconds(options.program, Path(folder), options.side, LAWS[name], verified)
                )
        many = seconds(options.program, Path(folder), options.many, LAWS["closure, Roelands"], verified=False)
    print("| loose gears until steady | a scene | over rigid flanks |")
    print("|---|---:|---:|")
    for verified in (True, False):
        base = statistics.median(times[next(iter(LAWS)), verified])
        for name in LAWS:
            median = statistics.median(times[name, verified])
            reported = ", verified" if verified else ""
            print(f"| {name}{reported} | {1e3 * median / options.side**2:.2f} ms | {median / base:.2f} |")
    print(f"\n{options.many**2} gears by the closure, Roelands: {many:.1f} s of processor time")


if __name__ == "__main__":
    main()
