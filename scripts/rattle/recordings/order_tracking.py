"""Run-ups: from a recording to the table that `&shaft table` takes, and the waterfall beside it."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rattle import command, outputs, table
from rattle.recordings import mending, options, units
from rattle.recordings.angle import ShaftAngle
from rattle.recordings.channels import Channel, choose
from rattle.recordings.faults import RecordingError
from rattle.recordings.order_windows import Course, longest_run, mean_course, stand_out, track, waterfall

CYCLES = 2  # a window reaches so many cycles either way at least
ROWS = 30  # of a table, or some less
RESOLVED = 0.8  # of the Nyquist frequency at the highest speed
SEEN = 3e-3  # of the strongest order of a speed: orders below it are not looked at
STEADY = 0.05  # of the speed: less change is no run-up
UNCERTAIN = 0.02  # of an amplitude: larger errors are warned of
LEAST_SAMPLES = 64
# How often a signal is differentiated to an acceleration, by its unit.
DERIVATIVES = {"rad": 2, "rad/s": 1, "rad/s2": 0, "m/s2": 0}
PER_MINUTE = 30.0 / math.pi


@dataclass(frozen=True)
class Waterfall:
    """Amplitudes over speed [1/min] (rows) and order (columns), in the unit of a run-up."""

    speeds: np.ndarray
    orders: np.ndarray
    amplitudes: np.ndarray


@dataclass(frozen=True)
class RunUp:
    """Complex amplitudes A exp(i phase) over speed [1/min] (rows) and order (columns).

    The order O is A cos(O theta + phase) of the mean angle theta of the shaft. `errors` are standard errors
    of the amplitudes, `powers` shares of the power of all orders that stand out.
    """

    speeds: np.ndarray
    orders: tuple[float, ...]
    amplitudes: np.ndarray
    errors: np.ndarray
    powers: np.ndarray
    waterfall: Waterfall
    notes: list[str]


def track_run_up(
    time: np.ndarray,
    values: np.ndarray,
    derivatives: int,
    shaft: tuple[np.ndarray, np.ndarray],
    *,
    orders: Sequence[float] | None = None,
    dropped: float = 1e-4,
    highest: float = 16.0,
    step: float | None = None,
    cycle_revolutions: int = 2,
    tones: Sequence[float] = (),
) -> RunUp:
    """Orders of a signal over the speed of a shaft.

    Parameters
    ----------
    time : times of the samples [s], ascending
    values : the signal; not a number in gaps
    derivatives : how often it is differentiated: 2 of an angle, 1 of a speed, 0 of an acceleration
    shaft : times [s] and angles [rad] of the shaft
    orders : which orders are kept; None: by power, all but the weakest that together have the share `dropped`
    highest : largest order that is looked for
    step : distance of the rows [1/min]; None: a round one that makes about thirty rows
    cycle_revolutions : revolutions after which the engine repeats: orders are looked for at its multiples
    tones : constant frequencies [Hz] that cross the orders, such as hum: fitted too, and dropped
    """
    notes: list[str] = []
    course = longest_run(mean_course(*shaft, cycle_revolutions), cycle_revolutions, notes)
    usable = np.isfinite(values) & (time >= course.time[0]) & (time <= course.time[-1])
    time, values = time[usable], values[usable]
    if len(time) < LEAST_SAMPLES:
        raise RecordingError(f"the signal has {len(time)} samples within the run-up, too few.")
    phase = course.phase(time)
    # What rotates is no oscillation; its slow rest is fitted in each window.
    values = values - np.polynomial.Polynomial.fit(phase, values, 1)(phase)
    # Samples of a wheel are equally far apart in angle, others in time.
    top = RESOLVED * math.pi / float(np.percentile(np.diff(phase), 99.0))
    if top < 1.0 / cycle_revolutions:
        raise RecordingError(
            f"at the highest speed samples are {math.degrees(RESOLVED * math.pi / top):.3g} deg apart, "
            "which shows no order; sample faster."
        )
    if orders and max(orders) > top:
        raise RecordingError(
            f"order {max(orders):g} is beyond what the samples show at the highest speed; {top:.3g} is not."
        )
    if highest > top:
        notes.append(
            f"Orders are looked for up to {top:.3g}; the samples show no higher ones at the highest speed."
        )
        highest = top
    reach = 2.0 * math.pi * cycle_revolutions * CYCLES
    speeds, lines, seen = waterfall(phase, values, course, max(highest, *(orders or (0.0,))), reach)
    picture = Waterfall(speeds * PER_MINUTE, lines, seen * np.outer(speeds, lines) ** derivatives)
    rows = _rows(course, step, phase, reach)
    asked = sorted({float(order) for order in orders or ()})
    wanted = sorted({*_seen(picture, cycle_revolutions, highest), *asked})
    centres, hum = course.at_speed(rows), [2.0 * math.pi * tone * time for tone in tones]
    clear = stand_out(phase, values, wanted, centres, reach, hum)
    wanted = [order for order, is_clear in zip(wanted, clear, strict=True) if is_clear or order in asked]
    if not wanted:
        raise RecordingError("no order stands out of the signal; name those to keep by --orders.")
    least = max(reach, 4.0 * math.pi / min(np.diff(wanted), default=1.0))
    tracked, errors = track(phase, values, wanted, centres, least, hum)
    if not np.all(np.isfinite(tracked)):
        bad = rows[~np.all(np.isfinite(tracked), axis=1)][0] * PER_MINUTE
        raise RecordingError(
            f"at {bad:.4g} 1/min there are too few samples for {len(wanted)} orders; "
            "ask for fewer by --orders, or record longer."
        )
    turned = (1j * np.outer(rows, wanted)) ** derivatives
    tracked, errors = tracked * turned, errors * np.abs(turned)
    powers = np.mean(np.maximum(np.abs(tracked) ** 2 - 2.0 * errors**2, 0.0), axis=0)
    weakest = np.argsort(powers, kind="stable")
    is_kept = np.isin(wanted, asked)
    if not asked:
        is_kept[weakest] = np.cumsum(powers[weakest]) > dropped * np.sum(powers)
    kept = np.flatnonzero(is_kept)
    rest = 1.0 - float(np.sum(powers[kept]) / np.sum(powers))
    left = [order for order, stays in zip(wanted, is_kept, strict=True) if not stays]
    notes.append(
        f"Orders kept{'' if asked else ' by power'}: {_words([wanted[place] for place in kept])}"
        + (f"; dropped: {_words(left)}, with {rest:.2g} of the power." if left else ".")
    )
    return RunUp(
        rows * PER_MINUTE,
        tuple(wanted[place] for place in kept),
        tracked[:, kept],
        errors[:, kept],
        powers[kept] / np.sum(powers),
        picture,
        notes,
    )


def _rows(course: Course, step: float | None, phase: np.ndarray, reach: float) -> np.ndarray:
    """Speeds [rad/s] of the rows: multiples of the step about which half a window at least was recorded."""
    low, high = sorted(float(speed) * PER_MINUTE for speed in (course.speed[0], course.speed[-1]))
    if high - low < STEADY * high:
        raise RecordingError(
            f"the speed goes from {low:.4g} to {high:.4g} 1/min, which is not a run-up; "
            "'recording.py cycle' takes steady recordings."
        )
    if step is None:
        raw = (high - low) / ROWS
        power = 10.0 ** math.floor(math.log10(raw))
        step = power * min(factor for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= raw)
    speeds = np.arange(math.ceil(low / step - 1e-6), math.floor(high / step + 1e-6) + 1) * step / PER_MINUTE
    centres = course.at_speed(speeds)
    speeds = speeds[(centres > phase[0] + 0.5 * reach) & (centres < phase[-1] - 0.5 * reach)]
    if len(speeds) < 2:
        raise RecordingError(
            f"the speed goes from {low:.4g} to {high:.4g} 1/min; a table needs two rows, here {step:g} apart."
        )
    return speeds


def _seen(picture: Waterfall, cycle_revolutions: int, highest: float) -> list[float]:
    """Multiples of the order of a cycle that reach a share of the strongest order of some speed."""
    candidates = np.arange(1, int(highest * cycle_revolutions) + 1)
    places = np.searchsorted(picture.orders, candidates / cycle_revolutions - 1e-9)
    own = picture.amplitudes[:, places]
    share = own / np.max(own, axis=1, keepdims=True)
    return list(candidates[np.max(share, axis=0) > SEEN] / cycle_revolutions)


def _words(orders: Sequence[float]) -> str:
    return ", ".join(f"{order:g}" for order in orders)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `recording.py run-up`."""
    parser.description = (
        "Track the orders of a run-up (or run-down) over the speed of the shaft. Writes the table that "
        "&shaft table takes, of a signal in m/s2 the order cuts for plot.py orders --measured, and beside it "
        "NAME.waterfall.csv for plot.py waterfall."
    )
    options.add_recording(parser)
    parser.add_argument(
        "--signal",
        metavar="NAME",
        help="channel whose orders are tracked; absent: the motion of the shaft itself",
    )
    options.add_shaft(parser)
    parser.add_argument(
        "--orders",
        type=order_list,
        metavar="O,...",
        help="orders that are kept; by default those with the power",
    )
    parser.add_argument(
        "--drop",
        type=command.positive_number,
        default=1e-4,
        metavar="SHARE",
        help="share of the power that the weakest orders may have together to be left out (%(default)s)",
    )
    parser.add_argument(
        "--highest",
        type=command.positive_number,
        default=16.0,
        metavar="O",
        help="largest order looked for (16)",
    )
    parser.add_argument(
        "--step",
        type=command.positive_number,
        metavar="RPM",
        help="distance of the rows; by default about 30 rows",
    )
    parser.add_argument(
        "--cycle-revolutions",
        type=command.positive,
        default=2,
        metavar="N",
        help="revolutions after which the engine repeats: orders are multiples of 1/N (2)",
    )
    parser.add_argument(
        "--tone",
        type=command.positive_number,
        action="append",
        default=[],
        metavar="HZ",
        help="constant frequency that crosses the orders, such as hum; repeatable",
    )
    parser.add_argument("--output", type=Path, required=True, metavar="NAME.csv", help="the table")
    outputs.add_option(parser)


def order_list(text: str) -> list[float]:
    """Orders between commas."""
    return [command.positive_number(part) for part in command.names(text)]


def run(arguments: argparse.Namespace) -> int:
    """Do what `recording.py run-up` does; returns its exit code."""
    beside = arguments.output.with_suffix(".waterfall.csv")
    outputs.check([arguments.output, beside], overwrite=arguments.overwrite, inputs=arguments.files)
    notes: list[str] = []
    recorded = options.read(arguments, notes)
    reference = options.reference_name(arguments)
    if reference is None:
        raise RecordingError("a run-up needs the channel with the angle: --angle, --tacho or --speed.")
    shaft_channel = choose(recorded, reference)
    shaft = options.angle_of(arguments, shaft_channel)
    notes += shaft.notes
    if arguments.signal:
        signal = choose(recorded, arguments.signal)
    else:
        signal = own_motion(shaft_channel, shaft, is_speed=arguments.speed is not None)
    signal = mending.mended(signal, mend=arguments.mend, notes=notes)
    unit = signal_unit(signal)
    found = track_run_up(
        signal.time,
        signal.within(unit),
        DERIVATIVES[unit],
        (shaft.time, shaft.angle),
        orders=arguments.orders,
        dropped=arguments.drop,
        highest=arguments.highest,
        step=arguments.step,
        cycle_revolutions=arguments.cycle_revolutions,
        tones=arguments.tone,
    )
    if not shaft.marked:
        notes.append("The phases count from where the recording begins, not from a mark of a wheel.")
    origin = f"{signal.name} of {arguments.files[0].name} over the angle of {shaft_channel.name}"
    files = [
        (arguments.output, outputs.text_writer(table_text(found, unit, origin))),
        (beside, outputs.text_writer(waterfall_text(found, unit, origin))),
    ]
    written = outputs.write(files, overwrite=arguments.overwrite, inputs=arguments.files)
    print(table.plain(cells(found, unit)))
    print(*dict.fromkeys([*notes, *found.notes]), *doubts(found), sep="\n")
    print(*written, sep="\n")
    if drawn_unit(unit) == "rad/s2":
        print(f"For the input: &shaft table = '{arguments.output.name}' /")
    return command.COMPLETE


def own_motion(channel: Channel, shaft: ShaftAngle, *, is_speed: bool) -> Channel:
    """What the shaft itself does: its speed where that was recorded, else its angle."""
    if is_speed:
        return channel
    return Channel(channel.name, "rad", shaft.time, shaft.angle, channel.source)


def signal_unit(channel: Channel) -> str:
    """The unit among those whose orders can be tracked."""
    if not channel.unit:
        units.factor(channel.unit, "rad/s2", channel.name)  # which says how a unit is given
    for unit in DERIVATIVES:
        if units.fits(channel.unit, unit):
            return unit
    raise RecordingError(
        f"'{channel.name}' is in {channel.unit}; a run-up takes an angle, a speed or an acceleration of the "
        "shaft, or an acceleration in m/s2."
    )


def drawn_unit(unit: str) -> str:
    """The unit of the amplitudes of a signal that was recorded in `unit`."""
    return "m/s2" if unit == "m/s2" else "rad/s2"


def table_text(found: RunUp, unit: str, origin: str) -> str:
    """The table as a CSV file; of a signal in m/s2 order cuts."""
    lines = [f"# orders of {origin}", *(f"# {note}" for note in found.notes)]
    is_table = drawn_unit(unit) == "rad/s2"
    names = ("acceleration_{0:g},phase_{0:g}" if is_table else "order_{0:g}").format
    lines.append(",".join(["speed_rpm", *map(names, found.orders)]))
    for speed, row in zip(found.speeds, found.amplitudes, strict=True):
        cells = [
            f"{abs(value):.6g},{np.angle(value):.5f}" if is_table else f"{abs(value):.6g}" for value in row
        ]
        lines.append(",".join([f"{speed:.10g}", *cells]))
    return "\n".join([*lines, ""])


def waterfall_text(found: RunUp, unit: str, origin: str) -> str:
    """The waterfall as a CSV file: a column for each order."""
    picture = found.waterfall
    lines = [
        f"# waterfall of {origin}",
        f"# unit: {drawn_unit(unit)}",
        f"# kept: {','.join(f'{order:g}' for order in found.orders)}",
        ",".join(["speed_rpm", *(f"order_{order:.6g}" for order in picture.orders)]),
    ]
    for speed, row in zip(picture.speeds, picture.amplitudes, strict=True):
        lines.append(",".join([f"{speed:.6g}", *(f"{value:.4g}" for value in row)]))
    return "\n".join([*lines, ""])


def cells(found: RunUp, unit: str) -> list[list[str]]:
    """Of each order its share of the power, its amplitudes and how well they are known."""
    rows = [["order", "share of power", f"amplitudes [{drawn_unit(unit)}]", "standard error"]]
    for place, order in enumerate(found.orders):
        size = np.abs(found.amplitudes[:, place])
        worst = np.max(found.errors[:, place] / size)
        rows.append(
            [
                f"{order:g}",
                f"{found.powers[place]:.2%}",
                f"{size.min():.4g} to {size.max():.4g}",
                f"up to {worst:.1%}",
            ]
        )
    return rows


def doubts(found: RunUp) -> list[str]:
    """Where the table is not as good as its rows seem."""
    notes = []
    for place, order in enumerate(found.orders):
        own = found.amplitudes[:, place]
        shares = found.errors[:, place] / np.abs(own)
        if np.any(shares > UNCERTAIN):
            notes.append(
                f"Order {order:g} is known to {np.max(shares):.1%} only at "
                f"{found.speeds[np.argmax(shares)]:.6g} 1/min; a slower run-up or larger --step helps."
            )
        # Lines of amplitude and phase between rows twice as far apart are off four times as much.
        size, turn = np.abs(own), np.angle(own[2:] / own[:-2])
        off = (
            np.abs(own[1:-1] - 0.5 * (size[:-2] + size[2:]) * np.exp(1j * (np.angle(own[:-2]) + 0.5 * turn)))
            / 4.0
        )
        if off.size and np.max(off) > UNCERTAIN * np.max(size):
            notes.append(
                f"Order {order:g} bends between the rows at {found.speeds[1 + np.argmax(off)]:.6g} 1/min: "
                f"the line between is off by {np.max(off) / np.max(size):.1%} of the largest amplitude: "
                "take a smaller --step."
            )
    return notes
