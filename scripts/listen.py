#!/usr/bin/env python3
"""Make the film forces of gear pairs, a gearbox or variants of it heard, and report their levels."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rattle import command, outputs, table
from rattle.campaign_plan import GEAR
from rattle.comparison.variant import grouped
from rattle.counts import counted

if TYPE_CHECKING:
    from rattle.result import Result
    from rattle.sound.track import Heard
    from rattle.sound.transfer import Transfer

SHORTEST, LONGEST = 0.2, 600.0  # seconds
CLIPPED = 1.0
MOST_SPEEDS = 9  # that are listed
QUASI_STEADY = (
    "Quasi-steady: at each speed its own steady motion from rest is heard, cross-faded into the next. A "
    "driven run-up lags behind and jumps later (input/CAMPAIGNS.md)."
)
DRIVEN = (
    "Quasi-steady: at each speed the motion of the sweep is heard, cross-faded into the next: motions that "
    "are carried along, there and back"
)
WITHOUT_LIBRARY = (
    "Loudness and sharpness are left out: MoSQITo is not installed; pip install 'rattle[sound]' brings it."
)
NOT_CALIBRATED = (
    "The generic housing is none that was measured: only differences between the variants of one file mean "
    "something, and none that lies in a few orders. Loudness and sharpness, which depend on the level, are "
    "left out. --transfer takes a measured one."
)


def main() -> None:
    options = parse_options()
    outputs.check([options.output], overwrite=options.overwrite, inputs=options.results)
    if options.output.suffix.lower() != ".wav":
        raise command.CommandError(f"{options.output}: a sound is written as FILE.wav.")
    from rattle.sound import track, transfer  # scipy only where a sound is made

    function = transfer.read_transfer(options.transfer) if options.transfer else transfer.generic()
    if options.rate is not None:
        return run_up(options, function)
    variants = grouped(options.results)
    for result in (result for variant in variants for result in variant.results):
        command.note_open(result)
    found = track.heard(variants, function, options.seconds)
    scale = options.full_scale or track.full_scale(found, function)
    files = [(options.output, lambda path: track.write_wav(path, found, scale))]
    inputs = [*options.results, *([options.transfer] if options.transfer else [])]
    outputs.write(files, overwrite=options.overwrite, inputs=inputs)
    print(table.plain(rows(found)))
    print(f"through {function.words}; a sample of 1 is {scale:.4g} Pa")
    for words in remarks(found, function, scale):
        command.note(words)
    print(options.output)


def run_up(options: argparse.Namespace, function: Transfer) -> None:
    """A run-up, whose results are a campaign over speed, or sweeps over it, one of each pair."""
    import rattle
    from rattle.sound import run_up, track

    results = [rattle.read(path) for path in options.results]
    sweeps = {str(one.input.get(GEAR, {}).get("name", "")).strip(): one for one in results}
    if len(results) != 1 and (len(sweeps) < len(results) or any(one.task != "sweep" for one in results)):
        raise command.CommandError(
            "--rate takes one run-up: a campaign over shaft.speed_rpm, or a sweep over it of each pair."
        )
    if results[0].task == "sweep":
        if options.rate < 0.0:
            raise command.CommandError("A sweep is heard the ways it went; --rate is above 0.")
        for result in sweeps.values():
            command.note_open(result)
        ways, left_out = run_up.driven_motions(sweeps)
        found, said = (
            run_up.heard_driven(ways, options.rate, function),
            driven_words([*sweeps.values()], options.rate),
        )
    else:
        motions, left_out = run_up.solved_motions(rattle.read_campaign(options.results[0]))
        found, said = run_up.heard(motions, options.rate, function), QUASI_STEADY
    scale = options.full_scale or track.full_scale([found], function)
    inputs = [*options.results, *([options.transfer] if options.transfer else [])]
    files = [(options.output, lambda path: track.write_wav(path, [found], scale))]
    outputs.write(files, overwrite=options.overwrite, inputs=inputs)
    print(table.plain(list(run_up.rows(found, MOST_SPEEDS))))
    print(f"through {function.words}; a sample of 1 is {scale:.4g} Pa")
    irregular = sum(not force.repeats for one in found.motions for force in one.forces.values())
    for words, is_said in (
        (said, True),
        (NOT_CALIBRATED, not function.calibrated),
        (f"{irregular} motions do not repeat: their last periods are heard again and again.", irregular),
        (f"Left out, as no motion was found: {', '.join(f'{n:g}' for n in left_out)} 1/min.", left_out),
    ):
        if is_said:
            command.note(words)
    print(options.output)


def driven_words(sweeps: Sequence[Result], rate: float) -> str:
    """How slow the run-up of sweeps has to be: as slow as the slowest of them asks for; whether it is."""
    from rattle.run_up import is_run_up, pace

    paces = [pace(result) for result in sweeps if is_run_up(result)]
    slowest = [rates.rates[rates.slowest] for rates in paces if rates.slowest is not None]
    if len(slowest) < len(sweeps):
        return f"{DRIVEN}."
    faster = f" That of {rate:g} 1/min/s is faster: it would lag behind." if rate > min(slowest) else ""
    return f"{DRIVEN}, which a run-up has at {min(slowest):.3g} 1/min/s or slower.{faster}"


def rows(found: list) -> list[list[str]]:
    """A line for each variant."""
    lines = [
        [
            "",
            "from [s]",
            "force rms [N]",
            "passed on",
            "level [dB(A)]",
            "to the first",
            "N5 [sone]",
            "S [acum]",
        ]
    ]
    for one in found:
        force = " + ".join(f"{each.rms:.4g}" for each in one.forces.values())
        known = [f"{value:.2f}" if value is not None else "-" for value in (one.loudness, one.sharpness)]
        levels = [f"{one.level:.1f}", f"{one.level - found[0].level:+.1f}"]
        lines.append([one.name, f"{one.start:g}", force, f"{100.0 * one.share:.3g} %", *levels, *known])
    return lines


def remarks(found: Sequence[Heard], function: Transfer, scale: float) -> list[str]:
    """What has to be known of the sound."""
    words = []
    if not function.calibrated:
        words.append(NOT_CALIBRATED)
    elif found[0].loudness is None:
        words.append(WITHOUT_LIBRARY)
    for one in found:
        for gear, force in one.forces.items():
            pair = f"{one.name}: {gear or 'the pair'}"
            if not force.repeats:
                last = f"its last {counted(force.periods, 'period is', 'periods are')} heard again and again"
                words.append(f"{pair} has a motion that does not repeat; {last}.")
            if force.motions > 1:
                words.append(f"{pair} has {force.motions} motions; heard is the one from rest.")
    largest = max(float(abs(one.pressure).max()) for one in found) / scale
    if largest > CLIPPED:
        words.append(f"The largest sample is {largest:.3g}, and players cut it off at 1; raise --full-scale.")
    return words


def duration(text: str) -> float:
    seconds = command.positive_number(text)
    if not SHORTEST <= seconds <= LONGEST:
        raise argparse.ArgumentTypeError(f"'{text}' is not from {SHORTEST:g} to {LONGEST:g} seconds")
    return seconds


def rate(text: str) -> float:
    found = command.finite(text)
    if found == 0.0:
        raise argparse.ArgumentTypeError("a run-up needs a rate other than 0")
    return found


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Write what the film forces of gear pairs sound like, through a transfer function from "
        "the force on the bearings to sound pressure, and report A-weighted level, loudness and sharpness. "
        "The pairs of one input sound together; variants follow each other with the same gain. "
        "input/LISTENING.md says what may be concluded."
    )
    parser.add_argument(
        "results",
        nargs="+",
        type=Path,
        metavar="RESULT",
        help="NAME.rattle of a motion; of a gearbox NAME.summary.nml, or the results of its pairs",
    )
    parser.add_argument("--output", type=Path, required=True, metavar="FILE.wav", help="the sound, 48 kHz")
    parser.add_argument(
        "--transfer",
        type=Path,
        metavar="FILE.csv",
        help="columns frequency [Hz], amplitude [Pa/N], phase [deg] (a generic housing, not calibrated)",
    )
    parser.add_argument("--seconds", type=duration, default=3.0, metavar="S", help="of each variant (3)")
    parser.add_argument(
        "--rate",
        type=rate,
        metavar="1/MIN/S",
        help="of a run-up, down where it is below 0; RESULT is then a campaign over shaft.speed_rpm, or the "
        "sweeps over it of all pairs; a sweep is heard the ways it went",
    )
    parser.add_argument(
        "--full-scale",
        type=command.positive_number,
        metavar="PA",
        help="pressure of a sample of 1 (1 Pa of a measured transfer function, else twice the largest)",
    )
    outputs.add_option(parser)
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
