"""A campaign against the ensembles of other solvers: the map of input/map.nml with 1000 values of each key.

    bench_campaign.py PROGRAM [--side N] [--sample N]

This program solves the whole map, each scene until its motion repeats, at most 200 periods; the others a
random sample of its scenes over 200 periods, as their users would run them: heyoka with eight different
scenes in a batch, CVODE one after the other with its analytic Jacobian. One core, processor time, at settings
that give the film an error of about 1e-6. Prints a Markdown table.
"""

from __future__ import annotations

import argparse
import math
import os
import subprocess
import tempfile
import time

import numpy as np
import scenes

FORCES = (5.0, 455.0)
SPEEDS = (0.5, 20.0)
LENGTH = 0.010
STEADY_FORCE = 199.2
# The default columns of a campaign; those of the map are these and `verified`
RECORDED = (
    "film_minimum,film_maximum,acceleration_minimum,acceleration_maximum,natural_frequency,damping_ratio,"
    "harmonic_count,harmonic_distortion,irregular_fraction,reversals_per_period,rattle_class,sampling_sufficient,"
    "film_regime,alpha_p_maximum,model_limit,harmonics"
)
PLAIN = ["--set", f"campaign.record={RECORDED}"]
VERIFIED = ["--set", f"campaign.record={RECORDED},verified"]
HEYOKA_TOLERANCE, CVODE_TOLERANCE = 1e-7, 1e-8


def map_scene(force: float, speed: float) -> scenes.Scene:
    """A scene of the map in the scaled form of the peers, h0 its steady film."""
    load = STEADY_FORCE + scenes.MASS * scenes.GRAVITY
    film = 2.8 * LENGTH * speed * scenes.VISCOSITY * scenes.RADIUS / load
    rate = math.sqrt(scenes.RADIUS * film) * scenes.FREQUENCY / speed
    return scenes.Scene(
        name=f"map-{force:g}-{speed:g}",
        model="published",
        law="iso_viscous",
        force_amplitude=force,
        pressure_viscosity=scenes.ALPHA,
        length=LENGTH,
        acceleration_scale=load / (scenes.MASS * film * scenes.FREQUENCY**2),
        squeeze_scale=3 * math.pi / (2.8 * math.sqrt(2)) * rate,
        force_ratio=force / load,
        pressure_scale=0.0,
        steady_load=1.0,
    )


def random_scenes(count: int) -> list[scenes.Scene]:
    random = np.random.default_rng(1)
    forces = random.uniform(*FORCES, count)
    speeds = np.exp(random.uniform(*np.log(SPEEDS), count))
    return [map_scene(force, speed) for force, speed in zip(forces, speeds, strict=True)]


def heyoka_seconds(sample: list[scenes.Scene]) -> float:
    """Seconds a scene in batches of eight."""
    import heyoka_peer

    integrator = heyoka_peer._batch(sample[0].kind, HEYOKA_TOLERANCE)
    parameters = len(integrator.pars)
    total = 0.0
    for first in range(0, len(sample), 8):
        batch = sample[first : first + 8]
        begin = time.thread_time()
        integrator.set_time(0.0)
        integrator.state[:] = np.array([heyoka_peer._start(scene) for scene in batch]).T
        integrator.pars[:] = np.array([scene.parameters[:parameters] for scene in batch]).T
        integrator.propagate_until(float(scenes.PERIODS))
        total += time.thread_time() - begin
    return total / len(sample)


def cvode_seconds(sample: list[scenes.Scene]) -> float:
    import cvode_peer

    return float(np.mean([cvode_peer.prepare(scene, CVODE_TOLERANCE)()[1] for scene in sample]))


def own_seconds(
    program: str, side: int, threads: int, *options: str, periods: int = int(scenes.PERIODS)
) -> tuple[float, float, float]:
    """Processor and wall seconds a scene of the map, and peak memory [MB]."""
    with tempfile.TemporaryDirectory() as place:
        command = [program, "--quiet", "--threads", str(threads), "--output", place]
        command += ["--set", f"campaign.count={side}, {side}", "--set", f"solver.periods={periods}"]
        if not any("campaign.record" in option for option in options):
            command += PLAIN
        command += [*options, "input/map.nml"]
        begin = time.perf_counter()
        process = subprocess.Popen(command)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - begin
    if status:
        raise SystemExit(f"{program} ended with status {status}")
    return (usage.ru_utime + usage.ru_stime) / side**2, wall / side**2, usage.ru_maxrss / 1024.0


def main() -> None:
    parser = argparse.ArgumentParser(description="A campaign against ensembles of other solvers.")
    parser.add_argument("program")
    parser.add_argument("--side", type=int, default=1000, help="values of each key (1000)")
    parser.add_argument("--sample", type=int, default=96, help="scenes the other solvers solve (96)")
    options = parser.parse_args()
    small = options.side // 4
    one, one_wall, memory = own_seconds(options.program, options.side, 1)
    _, two_wall, _ = own_seconds(options.program, options.side, 2)
    sorted_cost, _, small_memory = own_seconds(options.program, small, 1)
    lean, _, _ = own_seconds(options.program, small, 1, "--set", "campaign.record=film_minimum,film_maximum")
    verified, _, _ = own_seconds(options.program, small, 1, *VERIFIED)
    scrambled_options = ["--set", "campaign.sample=sobol", "--set", f"campaign.size={small**2}"]
    scrambled, _, _ = own_seconds(options.program, small, 1, *scrambled_options)
    bare = [
        "--set",
        "solver.until=periods",
        "--set",
        "spectrum.periods=1",
        "--set",
        "campaign.samples_per_period=32",
    ]
    bare += ["--set", "campaign.record=film_minimum,film_maximum,steady_film,natural_frequency,damping_ratio"]
    one_period, _, _ = own_seconds(options.program, options.side, 1, *bare, periods=1)
    two_periods, _, _ = own_seconds(options.program, options.side, 1, *bare, periods=2)
    driver = 2 * one_period - two_periods
    sample = random_scenes(options.sample)
    print("| what | a scene [us], one core | ratio |")
    print("|---|---|---|")
    print(f"| rattle, {options.side} x {options.side} scenes, all default columns | {1e6 * one:.1f} | 1 |")
    print(f"| the same on two cores, wall time one core over two | | {one_wall / two_wall:.2f} |")
    print(
        f"| film range alone, no spectrum, no pressure scan | {1e6 * lean:.1f} | {lean / sorted_cost:.2f} |"
    )
    print(f"| every class verified | {1e6 * verified:.1f} | {verified / sorted_cost:.2f} |")
    print(
        f"| scenes in random order, over the grid | {1e6 * scrambled:.1f} | {scrambled / sorted_cost:.2f} |"
    )
    print(f"| driver and output: one period less the second | {1e6 * driver:.1f} | {driver / one:.2f} |")
    for name, measure, part in (
        ("heyoka, 8 lanes, 200 periods", heyoka_seconds, sample),
        ("CVODE, 200 periods", cvode_seconds, sample[:24]),
    ):
        try:
            seconds = measure(part)
        except (ImportError, OSError, RuntimeError) as fault:
            print(f"| {name} | skipped: {fault} | |")
            continue
        print(f"| {name} | {1e6 * seconds:.0f} | {seconds / one:.1f} |")
    print(f"\npeak memory {small_memory:.0f} MB for {small**2} scenes, {memory:.0f} MB for {options.side**2}")


if __name__ == "__main__":
    main()
