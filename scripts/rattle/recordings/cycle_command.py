"""`recording.py cycle`: the mean cycle of a steady recording."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from scipy import integrate

from rattle import command, outputs, table
from rattle.recordings import cycles, mending, options, signals, speed_search, units
from rattle.recordings.angle import ShaftAngle, shaft_angle
from rattle.recordings.channels import Channel, choose
from rattle.recordings.faults import RecordingError

# Orders that are printed, the strongest ones.
PRINTED = 12


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `recording.py cycle`."""
    options.add_recording(parser)
    parser.add_argument(
        "--signal",
        metavar="NAME",
        help="channel, by name or number; absent: the only one, or the shaft's speed",
    )
    options.add_shaft(parser)
    parser.add_argument(
        "--speed-near",
        type=command.positive_number,
        metavar="RPM",
        help="without any of these: measure the speed from the signal, within a tenth of this",
    )
    parser.add_argument(
        "--cycle-revolutions",
        type=command.positive,
        default=2,
        metavar="N",
        help="revolutions of a cycle, by default %(default)s as of a four-stroke engine",
    )
    parser.add_argument(
        "--samples",
        type=command.positive,
        default=cycles.SAMPLES,
        metavar="N",
        help="samples a revolution that are written, by default %(default)s",
    )
    parser.add_argument(
        "--radius", type=command.positive_number, metavar="M", help="of a torque or an acceleration [m]"
    )
    parser.add_argument("--output", type=Path, required=True, metavar="NAME.csv", help="the mean cycle")
    outputs.add_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Average, print what was done, write the CSV and print the lines of the input."""
    outputs.check([arguments.output], overwrite=arguments.overwrite, inputs=arguments.files)
    if "'" in arguments.output.name:
        raise RecordingError(f"{arguments.output}: a quote in its name does not go into an input.")
    notes: list[str] = []
    cycle, quantity = measure(arguments, notes)
    write = partial(signals.write_csv, cycle=cycle, quantity=quantity)
    outputs.write([(arguments.output, write)], overwrite=arguments.overwrite, inputs=arguments.files)
    for note in notes + cycle.notes:
        (command.note if note.startswith("warning: ") else print)(note)
    print()
    print(table.plain(_rows(cycle)))
    for warning in cycle.warnings:
        command.note(f"warning: {warning}")
    print(f"\n{arguments.output} holds it. For the input:\n")
    print(signals.namelist(cycle, quantity, arguments.output))
    return command.COMPLETE


def measure(arguments: argparse.Namespace, notes: list[str]) -> tuple[cycles.MeanCycle, signals.Taken]:
    """The mean cycle that the options ask for, and what rattle takes it as."""
    channels = options.read(arguments, notes)
    reference = _reference(arguments, channels)
    signal = _signal(arguments, channels, reference)
    quantity = signals.SPEED
    if signal is None:
        assert reference is not None, "without a signal the speed of a reference is meant"
        shaft = options.angle_of(arguments, reference)
        notes.append(f"the signal is the speed of the shaft, from the angle by '{reference.name}'.")
    else:
        signal, quantity = signals.taken(signal, arguments.radius, notes)
        if signal.has_time:
            signal = mending.mended(signal, mend=arguments.mend, notes=notes)
            signal = mending.bridged(signal, limit=arguments.bridge, notes=notes)
            shaft = _shaft(arguments, reference, signal, quantity)
        else:
            signal, shaft = _over_angle(arguments, reference, signal, quantity, notes)
    notes += [note for note in shaft.notes if note not in notes]
    return cycles.mean_cycle(
        signal,
        shaft,
        cycle_revolutions=arguments.cycle_revolutions,
        samples_per_revolution=arguments.samples,
        derivative=quantity.is_speed,
    ), quantity


def _reference(arguments: argparse.Namespace, channels: Sequence[Channel]) -> Channel | None:
    """The channel that shows the angle: the one that is named, else the only one that is an angle."""
    if name := options.reference_name(arguments):
        return choose(channels, name)
    found = [channel for channel in channels if units.fits(channel.unit, "rad")]
    return found[0] if len(found) == 1 else None


def _signal(
    arguments: argparse.Namespace, channels: Sequence[Channel], reference: Channel | None
) -> Channel | None:
    """The channel of the signal; None: the speed of the shaft itself is meant."""
    if arguments.signal is not None:
        chosen = choose(channels, arguments.signal)
        return None if chosen is reference and arguments.speed is None else chosen
    if options.reference_name(arguments):
        return None if arguments.speed is None else reference
    others = [channel for channel in channels if channel is not reference]
    if len(others) > 1:
        names = ", ".join(channel.label for channel in channels[:20])
        raise RecordingError(
            f"{channels[0].source} has {len(channels)} channels, choose by --signal: {names}."
        )
    return others[0] if others else None


def _shaft(
    arguments: argparse.Namespace, reference: Channel | None, signal: Channel, quantity: signals.Taken
) -> ShaftAngle:
    """The angle from the reference, or from the signal itself."""
    if reference is not None and not (
        arguments.speed and quantity.is_speed and reference.name == signal.name
    ):
        return options.angle_of(arguments, reference)
    if quantity.is_speed:
        return shaft_angle(signal, kind="speed", bridge=arguments.bridge)
    if arguments.speed_near is not None:
        return speed_search.steady_angle(signal, arguments.speed_near, arguments.cycle_revolutions)
    raise RecordingError(
        f"what turns '{signal.name}' into cycles? Name the channel of the shaft by --angle, --tacho (with "
        "--pulses) or --speed, or give --speed-near RPM and the speed is measured from the signal."
    )


def _over_angle(
    arguments: argparse.Namespace,
    reference: Channel | None,
    signal: Channel,
    quantity: signals.Taken,
    notes: list[str],
) -> tuple[Channel, ShaftAngle]:
    """A signal over the angle alone: times follow from its speed, or from the speed that the user gives."""
    if reference is None or not units.fits(reference.unit, "rad"):
        raise RecordingError(
            f"{signal.source} has no column of time and none of an angle; give its sampling rate by "
            "--rate, in Hz."
        )
    nominal = arguments.speed_near
    if quantity.is_speed and nominal is None:
        nominal = float(np.nanmedian(signal.values))
    if nominal is None or not nominal > 0.0:
        raise RecordingError(
            f"{signal.source} has no column of time: say at what speed it was recorded by --speed-near RPM."
        )
    by_sample = options.angle_of(arguments, reference)
    angle = by_sample.at(signal.time)
    radian = 60.0 / (2.0 * np.pi)
    signal = replace(signal, time=angle / nominal * radian, has_time=True)
    signal = mending.mended(signal, mend=arguments.mend, notes=notes)
    signal = mending.bridged(signal, limit=arguments.bridge, notes=notes)
    angle = signal.time * nominal / radian
    if quantity.is_speed:
        if not np.all(signal.values > 0.0):
            raise RecordingError(
                f"{signal.source}: '{signal.name}' falls to {signal.values.min():.4g} 1/min; a shaft that "
                "turns has a speed above zero; --mend replaces drop-outs."
            )
        slowness = radian / signal.values
        time = integrate.cumulative_trapezoid(slowness, angle, initial=0.0)
        signal = replace(signal, time=time)
    else:
        notes.append(f"it has no times: {nominal:g} 1/min is taken as its speed.")
    return signal, ShaftAngle(signal.time, angle, by_sample.notes, by_sample.error)


def _rows(cycle: cycles.MeanCycle) -> list[list[str]]:
    """The strongest orders, in their order."""
    shown = np.sort(np.argsort(-cycle.amplitudes, kind="stable")[:PRINTED])
    rows = [["order", f"amplitude [{units.shown(cycle.unit)}]", "+-", "phase [deg]", "+-"]]
    for place in shown:
        if cycle.amplitudes[place] < 1e-3 * cycle.amplitudes.max():
            continue
        pairs = (
            (cycle.amplitudes[place], cycle.amplitude_errors[place]),
            (np.degrees(cycle.phases[place]), np.degrees(cycle.phase_errors[place])),
        )
        cells = [cell for value, error in pairs for cell in (f"{value:.5g}", _error(error))]
        rows.append([f"{cycle.orders[place]:g}", *cells])
    return rows


def _error(error: float) -> str:
    return f"{error:.2g}" if np.isfinite(error) else "-"
