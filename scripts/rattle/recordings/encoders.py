"""Two encoders, of the driving and the loose gear: play, impacts and drag from their relative motion."""

from __future__ import annotations

import argparse
import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rattle import command, outputs, table
from rattle.derived import derived
from rattle.faults import RunError
from rattle.recordings import options
from rattle.recordings.angle import ShaftAngle, kind_of, shaft_angle
from rattle.recordings.channels import Channel, choose
from rattle.recordings.faults import RecordingError
from rattle.recordings.loose_flight import CONFIDENCE, Estimate, Flights, Motion, look
from rattle.recordings.order_windows import fit_window, mean_course

FORM = "rattle encoders 1"
RATIO = 1e-3  # by which the speeds of the gears may differ from what their base radii say
SAMPLES, FEW = 1500, 500  # a period: taken at least, and below which impacts are blurred
STEADY = 0.05  # of the speed, by which it may change
HIGHEST = 16.0  # order of the driver that is looked for
STANDING_OUT = 5.0  # standard errors
LEAST_SHARE = 0.01  # of the strongest order
PARTS = ("value", "low", "high", "scatter")


@dataclass(frozen=True)
class Geometry:
    """Base radii [m] of driver and loose gear, and their base helix angle [rad]."""

    driver: float
    loose: float
    helix: float = 0.0


@dataclass(frozen=True)
class Shaft:
    """Mean speed [1/min] and orders of the driver: A cos(order theta + phase) is its acceleration."""

    speed_rpm: float
    orders: tuple[float, ...]
    accelerations: tuple[float, ...]
    phases: tuple[float, ...]


def relative_motion(
    driver: ShaftAngle, loose: ShaftAngle, geometry: Geometry, period_order: float, notes: list[str]
) -> tuple[Motion, Shaft]:
    """The motion of the loose gear along the line of action, and that of the driver.

    The force repeats `period_order` times a revolution of the driver. Doubts are appended to `notes`.
    """
    begin, end = max(driver.time[0], loose.time[0]), min(driver.time[-1], loose.time[-1])
    steps = [float(np.median(np.diff(shaft.time))) for shaft in (driver, loose)]
    period = 60.0 / (period_order * driver.mean_speed_rpm)
    step = min(*steps, period / SAMPLES)
    if max(steps) > period / FEW:
        notes.append(
            f"The encoders have {period / max(steps):.0f} samples or lines a period of the force; fewer than "
            f"{FEW} blur impacts."
        )
    if end - begin < 64.0 * step:
        raise RecordingError(
            "the encoders have no time in common; they are of different recordings or clocks."
        )
    time = begin + step * np.arange(int((end - begin) / step))
    first, second = driver.at(time), loose.at(time)
    ratio = float((second[-1] - second[0]) / (first[-1] - first[0]))
    expected = geometry.driver / geometry.loose
    if abs(ratio / expected - 1.0) > RATIO:
        swapped = abs(ratio * expected - 1.0) <= RATIO
        raise RecordingError(
            f"the loose gear turns {ratio:.6g} times a turn of the driver, by base radii {expected:.6g}: "
            + ("the encoders are swapped." if swapped else "check the radii, the channels and their units.")
        )
    along = math.cos(geometry.helix)
    gear = along * geometry.loose * second
    motion = Motion(
        step,
        gear - along * geometry.driver * first,
        gear,
        first * period_order / (2.0 * math.pi),
        # What turns with the force itself cannot be distinguished from it.
        tuple(
            angle for angle, order in ((first, 1.0), (second, ratio)) if not _is_multiple(order, period_order)
        ),
    )
    return motion, _orders(time, first, period_order)


def _is_multiple(order: float, base: float) -> bool:
    return abs(order / base - max(1, round(order / base))) < 1e-3


def _orders(time: np.ndarray, angle: np.ndarray, period_order: float) -> Shaft:
    """The orders of the driver over all of the recording, as harmonics of the force."""
    course = mean_course(time, angle, max(1, math.ceil(1.0 / period_order - 1e-9)))
    phase = course.phase(time)
    speed = float((phase[-1] - phase[0]) / (time[-1] - time[0]))
    slow, fast = np.percentile(course.speed, (1.0, 99.0)) * 30.0 / math.pi
    if fast - slow > STEADY * slow:
        raise RecordingError(
            f"the speed of the driver goes from {slow:.4g} to {fast:.4g} 1/min; two encoders are evaluated "
            "at a steady speed: choose a part by --part."
        )
    top = min(HIGHEST, 0.4 * math.pi / (speed * float(time[1] - time[0])))
    orders = period_order * np.arange(1, int(top / period_order + 1e-9) + 1)
    middle = 0.5 * (phase[0] + phase[-1])
    fitted = fit_window(phase, angle - phase, list(orders), middle, middle - phase[0])
    if fitted is None:
        raise RecordingError(f"{len(time)} samples are too few for the orders of the driver.")
    found = -((orders * speed) ** 2) * fitted[0]
    clear = np.abs(fitted[0]) > STANDING_OUT * fitted[1]
    kept = clear & (np.abs(found) > LEAST_SHARE * np.max(np.abs(found[clear]), initial=0.0))
    if not np.any(kept):
        raise RecordingError(
            f"the driver turns evenly at multiples of order {period_order:g}; give the order of the force by "
            "--period-order."
        )
    return Shaft(
        speed * 30.0 / math.pi,
        tuple(map(float, orders[kept])),
        tuple(map(float, np.abs(found[kept]))),
        tuple(map(float, np.angle(found[kept]))),
    )


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `recording.py encoders`."""
    parser.description = (
        "From the angles of driver and loose gear at a steady speed: backlash, impacts a period by flank, "
        "approach velocities and restitution along the line of action, and drag over inertia of the loose "
        "gear. The file that is written is what calibrate.py takes."
    )
    options.add_recording(parser)
    parser.add_argument(
        "--driver", required=True, metavar="NAME", help="channel with the angle of the driver"
    )
    parser.add_argument(
        "--loose", required=True, metavar="NAME", help="channel with the angle of the loose gear"
    )
    parser.add_argument(
        "--lines", type=line_counts, metavar="N,N", help="lines a revolution, where the channels are pulses"
    )
    parser.add_argument("--input", type=Path, metavar="FILE.nml", help="input with the pair as &gear")
    parser.add_argument("--gear", metavar="NAME", help="the pair, where the input has several")
    parser.add_argument(
        "--base-radii", type=radii, metavar="R1,R2", help="of driver and loose gear [m], instead of --input"
    )
    parser.add_argument(
        "--base-helix-deg",
        type=command.finite,
        default=0.0,
        metavar="DEG",
        help="base helix angle, with --base-radii",
    )
    parser.add_argument(
        "--period-order",
        type=command.positive_number,
        metavar="O",
        help="periods of the force a revolution of the driver; absent: that of the input, else 1",
    )
    parser.add_argument(
        "--temperature", type=command.finite, metavar="DEGC", help="of the oil, for calibrate.py"
    )
    parser.add_argument(
        "--output", type=Path, required=True, metavar="NAME.json", help="what calibrate.py takes"
    )
    outputs.add_option(parser)


def line_counts(text: str) -> tuple[int, int]:
    """Lines of two encoders."""
    counts = [command.positive(part) for part in command.names(text)]
    if len(counts) != 2:
        raise argparse.ArgumentTypeError(f"'{text}' is not two whole numbers such as 3600,3600")
    return counts[0], counts[1]


def radii(text: str) -> tuple[float, float]:
    """Two radii."""
    found = [command.positive_number(part) for part in command.names(text)]
    if len(found) != 2:
        raise argparse.ArgumentTypeError(f"'{text}' is not two radii such as 0.0145,0.0501")
    return found[0], found[1]


def run(arguments: argparse.Namespace) -> int:
    """Do what `recording.py encoders` does; returns its exit code."""
    outputs.check([arguments.output], overwrite=arguments.overwrite, inputs=arguments.files)
    geometry, period_order = _pair(arguments)
    notes: list[str] = []
    recorded = options.read(arguments, notes)
    shafts: list[ShaftAngle] = []
    if choose(recorded, arguments.driver) is choose(recorded, arguments.loose):
        raise RecordingError(
            f"--driver and --loose are both '{arguments.driver}'; two encoders are two channels."
        )
    for place, name in enumerate((arguments.driver, arguments.loose)):
        lines = arguments.lines[place] if arguments.lines else None
        shafts.append(_encoder(choose(recorded, name), lines, arguments))
        notes += [note for note in shafts[-1].notes if note not in notes]
    driver, loose = shafts
    motion, shaft = relative_motion(driver, loose, geometry, period_order, notes)
    found = look(motion)
    numbers = as_dict(found, shaft, geometry, period_order, motion.step, arguments.temperature)
    text = json.dumps(numbers, indent=2) + "\n"
    outputs.write(
        [(arguments.output, outputs.text_writer(text))], overwrite=arguments.overwrite, inputs=arguments.files
    )
    print(table.plain(cells(numbers)))
    print(*notes, *words(found, shaft, period_order), arguments.output, sep="\n")
    return command.COMPLETE


def _encoder(channel: Channel, lines: int | None, arguments: argparse.Namespace) -> ShaftAngle:
    if lines is None and kind_of(channel) == "tacho":
        raise RecordingError(
            f"'{channel.name}' has no unit of an angle: give it by --unit '{channel.name}=deg', or the lines "
            "a revolution of pulses by --lines."
        )
    return shaft_angle(
        channel,
        kind="tacho" if lines else None,
        pulses_per_revolution=lines or 1,
        bridge=arguments.bridge,
        mend=arguments.mend,
    )


def _pair(arguments: argparse.Namespace) -> tuple[Geometry, float]:
    """Base radii and order of the force, from the options or as the program derives them."""
    if (arguments.input is None) == (arguments.base_radii is None):
        raise RecordingError("give either --input FILE.nml with the pair, or --base-radii R1,R2.")
    if arguments.base_radii is not None:
        helix = math.radians(arguments.base_helix_deg)
        driver, loose = arguments.base_radii
        return Geometry(driver, loose, helix), arguments.period_order or 1.0
    try:
        found = derived(arguments.input, gear=arguments.gear)
    except RunError as fault:
        raise RecordingError(f"{fault}") from None
    if "gear.base_radius_1" not in found:
        raise RecordingError(
            f"{arguments.input} has no &gear, whose base radii are needed; give --base-radii."
        )
    order = arguments.period_order or 60.0 * float(found["load.frequency"]) / float(found["shaft.speed_rpm"])
    driver, loose, helix = (
        float(found[f"gear.base_{name}"]) for name in ("radius_1", "radius_2", "helix_angle")
    )
    return Geometry(driver, loose, math.radians(helix)), order


def as_dict(
    found: Flights,
    shaft: Shaft,
    geometry: Geometry,
    period_order: float,
    step: float,
    temperature: float | None,
) -> dict[str, Any]:
    """What is written, in SI units: estimates with value, interval low to high, scatter and count."""
    lever = geometry.loose * math.cos(geometry.helix)
    flown = found.deceleration
    recorded = {
        "form": FORM,
        "confidence": CONFIDENCE,
        "temperature_celsius": temperature,
        "period_order": period_order,
        "periods": found.periods,
        "shaft": asdict(shaft),
        "play": asdict(found.play),
        "is_double_sided": found.is_double_sided,
        "drag_over_inertia": None if flown is None else asdict(_scaled(flown, 1.0 / lever)),
        "step": step,
        "drift": found.drift,
        "noise": found.noise,
    }
    for name, flank in (("drive", found.drive), ("coast", found.coast)):
        recorded |= {f"{key}_{name}": value for key, value in asdict(flank).items()}
    return recorded


def _scaled(estimate: Estimate, factor: float) -> Estimate:
    return Estimate(
        factor * estimate.value,
        factor * estimate.low,
        factor * estimate.high,
        factor * estimate.scatter,
        estimate.count,
    )


def cells(recorded: dict[str, Any]) -> list[list[str]]:
    """The estimates, as a table."""
    rows = [["", "value", f"{CONFIDENCE:.0%} interval", "scatter", "events"]]
    names = (
        ("backlash less films [um]" if recorded["is_double_sided"] else "range of the gap [um]", "play", 1e6),
        ("drag over inertia [1/s2]", "drag_over_inertia", 1.0),
        ("approach to the drive flank [mm/s]", "velocity_drive", 1e3),
        ("approach to the coast flank [mm/s]", "velocity_coast", 1e3),
        ("restitution at the drive flank", "restitution_drive", 1.0),
        ("restitution at the coast flank", "restitution_coast", 1.0),
    )
    for words, key, scale in names:
        own = recorded[key]
        if own is None:
            rows.append([words, "unknown", "", "", ""])
            continue
        value, low, high, scatter = (f"{scale * own[part]:.4g}" for part in PARTS)
        rows.append([words, value, f"{low} to {high}", scatter, f"{own['count']}"])
    for side in ("drive", "coast"):
        rows.append(
            [f"impacts a period, {side} flank", f"{recorded[f'impacts_per_period_{side}']:.4g}", "", "", ""]
        )
    return rows


def words(found: Flights, shaft: Shaft, period_order: float) -> list[str]:
    """What the user should know of the numbers."""
    orders = ", ".join(f"{order:g}" for order in shaft.orders)
    recorded = [
        f"{found.periods} periods of order {period_order:g} at {shaft.speed_rpm:.5g} 1/min; the driver has "
        f"order{'s' if len(shaft.orders) > 1 else ''} {orders}.",
        f"A drift of {found.drift * 1e6:.3g} um was taken off; the noise is {found.noise * 1e6:.3g} um.",
    ]
    recorded.append("Impacts behind a flight of less than a fifth of the play are not counted.")
    if found.is_double_sided:
        recorded.append("The backlash is larger by the oil films at contact, which no encoder sees.")
    else:
        recorded.append(
            "There are no impacts on both flanks: the backlash is larger than the range of the gap."
        )
    if found.deceleration is None:
        recorded.append("The gear does not fly through the middle of its play: drag over inertia is unknown.")
    else:
        recorded.append(
            "In flight the oil pulls a little, too: calibrate.py takes that off by solving the motion."
        )
    return recorded
