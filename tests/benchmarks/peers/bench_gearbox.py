"""A campaign of a gearbox against the ensembles of other solvers: four loose pairs over speed, temperature,
drag and strength of the engine's orders, Reynolds iso-viscous films between two rigid flanks.

    bench_gearbox.py PROGRAM [--count 25,25,20,20] [--threads N] [--sample N]

This program solves the whole grid, each scene until its motion repeats, at most 60 periods; the others a
random sample of the same grid over 60 periods: heyoka with eight different scenes in a batch, CVODE one after
the other. Prints a Markdown table, and how far the largest films of the last ten periods are apart; with
`--sample 0` this program alone is timed.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import scenes

READY = Path(__file__).with_name("gearbox.nml")
AXES = {
    "shaft.speed_rpm": (600.0, 3000.0),
    "oil.temperature_celsius": (-20.0, 120.0),
    "gear.drag_torque": (0.03, 0.15),
    "load.force_scale": (0.5, 2.0),
}
PAIRS, PERIODS = 4, 60
# All columns of the input but `verified`
RECORDED = (
    "rattle_class,double_sided,film_minimum,acceleration_minimum,acceleration_maximum,acceleration_rms,"
    "film_force_rms,dissipated_power,harmonic_count,harmonic_distortion,film_regime,sampling_sufficient,model_limit"
)
HEYOKA_TOLERANCE, CVODE_TOLERANCE = 1e-7, 1e-8


def settings(values: dict[str, object]) -> list[str]:
    return [part for key, value in values.items() for part in ("--set", f"{key}={value}")]


def campaign(counts: list[int], record: str) -> list[str]:
    """Settings of the campaign over all axes."""
    ends = list(zip(*AXES.values(), strict=True))
    lists = {"vary": AXES, "first": ends[0], "last": ends[1], "count": counts, "record": [record]}
    return settings({f"campaign.{key}": ",".join(map(str, values)) for key, values in lists.items()})


def rigid(place: Path) -> Path:
    """The input with rigid teeth, which the other solvers have."""
    path = place / READY.name
    path.write_text(re.sub(r"tooth_stiffness = \S+", "tooth_stiffness = 0.0", READY.read_text()))
    return path


def solve(
    program: str, threads: int, counts: list[int], record: str, place: Path
) -> tuple[float, float, float]:
    """Processor and wall seconds of all scenes, and peak memory [MB]; the summary stays in `place`."""
    command = [program, "--quiet", "--overwrite", "--threads", str(threads), "--output", str(place)]
    begin = time.perf_counter()
    process = subprocess.Popen([*command, *campaign(counts, record), rigid(place)])
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - begin
    if os.waitstatus_to_exitcode(status) not in (0, 1):
        raise SystemExit(f"{program} ended with status {status}")
    return usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss / 1024.0


def reported(place: Path, what: str) -> str:
    """How many scenes the summary of the campaign says it of."""
    text = (place / f"{READY.stem}.summary.nml").read_text()
    return re.search(rf"scenes_{what}_in_this_run = (\d+)", text)[1]


def solved_alone(program: str, values: dict[str, float], place: Path) -> list[dict[str, list[float]]]:
    """What --check reports of each pair at these values, and its largest film as a single scene [m]."""
    text = rigid(place).read_text().partition("&campaign")[0].replace("task = 'campaign'", "name = 'one'")
    (place / "one.nml").write_text(text)
    call = [program, "--overwrite", "--output", str(place), *settings(values), str(place / "one.nml")]
    reported = subprocess.run([*call, "--check"], capture_output=True, text=True, check=True).stdout
    subprocess.run([*call, "--quiet"], check=False)
    pairs: list[dict[str, list[float]]] = []
    for name, numbers in re.findall(r"^! derived: (\S+) = ((?:(?:, )?[-+.\dE]+)+)", reported, re.M):
        if name == "lubricant.viscosity":
            pairs.append({})
        pairs[-1][name] = [float(number) for number in numbers.split(", ")]
    for pair, name in zip(pairs, re.findall(r"^ +name = '(\d\w+)'", text, re.M), strict=True):
        found = re.search(r"^ *film_maximum = (\S+)", (place / f"one.{name}.summary.nml").read_text(), re.M)
        pair["film_maximum"] = [float(found[1]) if found else np.nan]
    return pairs


def scaled(name: str, pair: dict[str, list[float]], strength: float) -> tuple[scenes.Scene, float]:
    """A pair in the scaled form of the peers, h0 the steady film of one flank; its largest film over h0."""

    def number(key: str) -> float:
        return pair[key][0]

    load, steady = number("load.steady_force"), scenes.steady_load_group(0.0)
    rolling = 2.0 * number("kinematics.entrainment_speed")
    radius, frequency = number("contact.radius"), number("load.frequency")
    film = 12 * rolling * number("lubricant.viscosity") * radius * number("contact.length") * steady / load
    ratios = [strength * amplitude / load for amplitude in pair["load.force_amplitudes"]]
    scene = scenes.Scene(
        name=name,
        model="reynolds",
        law="iso_viscous",
        force_amplitude=ratios[0] * load,
        pressure_viscosity=0.0,
        length=number("contact.length"),
        acceleration_scale=load / (number("load.mass") * film * frequency**2),
        squeeze_scale=4 * frequency * np.sqrt(radius * film / 2) / rolling,
        force_ratio=ratios[0],
        pressure_scale=0.0,
        steady_load=steady,
        more_ratios=tuple(ratios[1:]),
        phases=tuple(pair["load.force_phases"][1:]),
        backlash=number("contact.backlash") / film,
        periods=PERIODS,
    )
    return scene, number("film_maximum") / film


def random_sample(
    program: str, counts: list[int], size: int, place: Path
) -> list[tuple[scenes.Scene, float]]:
    """Random scenes of the grid, and the largest film that this program finds over h0."""
    random = np.random.default_rng(1)
    found = []
    for i in range(size):
        pair, *steps = (int(random.integers(count)) for count in (PAIRS, *counts))
        values = {
            key: first + (last - first) * step / (count - 1)
            for (key, (first, last)), step, count in zip(AXES.items(), steps, counts, strict=True)
        }
        chosen = solved_alone(program, values, place)[pair]
        found.append(scaled(f"gearbox-{i}", chosen, values["load.force_scale"]))
    return found


def heyoka_films(sample: list[scenes.Scene]) -> tuple[float, np.ndarray]:
    """Processor seconds a scene in batches of eight, and the largest film of the last ten periods over h0."""
    import heyoka_peer as peer

    integrator = peer._batch(sample[0].kind, HEYOKA_TOLERANCE)
    grid = np.append(float(PERIODS - scenes.SAMPLED_PERIODS), sample[0].sample_times)
    total, largest = 0.0, []
    for first in range(0, len(sample) - len(sample) % peer.LANES, peer.LANES):
        batch = sample[first : first + peer.LANES]
        begin = time.thread_time()
        integrator.set_time(0.0)
        integrator.state[:] = np.array([peer._start(scene) for scene in batch]).T
        integrator.pars[:] = np.array([peer._parameters(scene) for scene in batch]).T
        integrator.propagate_until(grid[0])
        films = integrator.propagate_grid(np.repeat(grid[:, None], peer.LANES, axis=1))[-1][1:, 0, :]
        total += time.thread_time() - begin
        largest += np.max(films, axis=0).tolist()
    return total / len(largest), np.array(largest)


def cvode_films(sample: list[scenes.Scene]) -> tuple[float, np.ndarray]:
    import cvode_peer

    solved = [cvode_peer.prepare(scene, CVODE_TOLERANCE)() for scene in sample]
    return float(np.mean([seconds for _, seconds in solved])), np.array([film.max() for film, _ in solved])


def main() -> None:
    parser = argparse.ArgumentParser(description="A gearbox against ensembles of other solvers.")
    parser.add_argument("program")
    parser.add_argument("--count", default="25,25,20,20", help="values of each key (25,25,20,20)")
    parser.add_argument("--threads", type=int, default=2, help="threads (2)")
    parser.add_argument("--sample", type=int, default=32, help="scenes the other solvers solve (32); 0: none")
    options = parser.parse_args()
    counts = [int(count) for count in options.count.split(",")]
    size = PAIRS * int(np.prod(counts))
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        processor, wall, memory = solve(options.program, options.threads, counts, RECORDED, place)
        print(
            f"{size} scenes on {options.threads} threads: {processor:.0f} s of processor time, {wall:.0f} s, "
            f"{memory:.0f} MB, {reported(place, 'failed')} failed, "
            f"{reported(place, 'beyond_model')} beyond the model\n"
        )
        if options.sample == 0:
            return
        sample = random_sample(options.program, counts, options.sample, place)
        fewer = [max(2, count // 3) for count in counts]
        few = PAIRS * int(np.prod(fewer))
        plain = solve(options.program, options.threads, fewer, RECORDED, place)[0] / few
        verified = solve(options.program, options.threads, fewer, f"{RECORDED},verified", place)[0] / few
    own = processor / size
    print("| what | a scene [ms], processor time | ratio | largest films apart, median and largest |")
    print("|---|---|---|---|")
    print(f"| rattle, until the motion repeats | {1e3 * own:.3f} | 1 | |")
    print(f"| every class verified, {few} scenes | {1e3 * verified:.3f} | {verified / plain:.2f} | |")
    ours = np.array([film for _, film in sample])
    for name, measure in (("heyoka, 8 lanes", heyoka_films), ("CVODE", cvode_films)):
        try:
            seconds, theirs = measure([scene for scene, _ in sample])
        except (ImportError, OSError, RuntimeError) as fault:
            print(f"| {name}, {PERIODS} periods | skipped: {fault} | | |")
            continue
        apart = np.abs(theirs / ours[: len(theirs)] - 1.0)
        print(
            f"| {name}, {PERIODS} periods | {1e3 * seconds:.2f} | {seconds / own:.1f} | "
            f"{np.median(apart):.1e}, {np.max(apart):.1e} |"
        )


if __name__ == "__main__":
    main()
