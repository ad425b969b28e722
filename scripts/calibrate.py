#!/usr/bin/env python3
"""Fit the drag on a loose gear, and another key if asked, to what was measured."""

from __future__ import annotations

import argparse
import csv
from functools import partial
from pathlib import Path

from rattle import calibration, command, encoder_calibration, outputs, table
from rattle.faults import RunError

KEY = "gear.drag_scale"


def main() -> int:
    options = parse_options()
    if options.output:
        outputs.check([options.output], overwrite=options.overwrite, inputs=[options.measured])
    if encoder_calibration.is_encoders(options.measured):
        return fit_encoders(options)
    measured = calibration.read_measurements(options.measured)
    if options.second and measured.name == calibration.RATTLES:
        raise command.CommandError(
            "Whether a pair rattles fits one key; a second key needs measured numbers."
        )
    keys = [options.key, *([options.second] if options.second else [])]
    model = calibration.Model(options.input, measured, keys, gear=options.gear, criterion=options.criterion)
    try:
        if measured.name == calibration.RATTLES:
            fit = calibration.fit_thresholds(model, options.range)
        else:
            ranges = [options.range, options.second_range][: len(keys)]
            fit = calibration.fit_numbers(model, ranges)
    except RunError as fault:
        return command.complain(str(fault))
    print(table.plain(cells(measured, fit)))
    for found in fit.fitted:
        print(sentence(found))
    for note in fit.notes:
        print(note)
    if options.output:
        files = [(options.output, partial(save, measured=measured, fit=fit))]
        outputs.write(files, overwrite=options.overwrite, inputs=[options.measured])
    return command.COMPLETE


def fit_encoders(options: argparse.Namespace) -> int:
    """Fit what two encoders show of a pair."""
    if options.second or options.output or options.key != KEY:
        raise command.CommandError(
            "Two encoders fit backlash and drag; leave --key, --second and --output out."
        )
    try:
        fit = encoder_calibration.fit_encoders(
            options.input, encoder_calibration.read_encoders(options.measured), options.gear
        )
    except RunError as fault:
        return command.complain(str(fault))
    print(table.plain(fit.rows))
    print(*map(sentence, fit.fitted), *fit.notes, sep="\n")
    return command.COMPLETE


def cells(measured: calibration.Measurements, fit: calibration.Fit) -> list[list[str]]:
    """Every measured point beside what the fitted input gives there."""
    words = measured.name == calibration.RATTLES
    rows = [["speed_rpm", "temperature_celsius", measured.name, "computed"]]
    for speed, temperature, value, found in zip(
        measured.speeds, measured.temperatures, measured.values, fit.computed, strict=True
    ):
        pair = [("yes" if number else "no") if words else f"{number:.4g}" for number in (value, found)]
        rows.append([f"{speed:g}", f"{temperature:g}", *pair])
    return rows


def sentence(found: calibration.Fitted) -> str:
    """A fitted key in words."""
    words = f"{found.key} = {found.value:.4g}"
    if found.interval is None:
        return words
    low, high = (f"{end:.4g}" for end in found.interval)
    if found.is_bound:
        return f"{words}; everything between {low} and {high} agrees with the points"
    return f"{words}, {calibration.CONFIDENCE:.0%} interval {low} to {high}"


def save(path: Path, measured: calibration.Measurements, fit: calibration.Fit) -> None:
    """The points in full precision."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["speed_rpm", "temperature_celsius", measured.name, "computed"])
        columns = (measured.speeds, measured.temperatures, measured.values, fit.computed)
        writer.writerows(zip(*(column.tolist() for column in columns), strict=True))


def span(text: str) -> tuple[float, float]:
    """The value of an option that is a range of positive numbers."""
    parts = [command.positive_number(part) for part in text.split(",")]
    if len(parts) != 2 or not parts[0] < parts[1]:
        raise argparse.ArgumentTypeError(f"'{text}' is not two positive numbers LOW,HIGH")
    return parts[0], parts[1]


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Fit gear.drag_scale to measured points. The CSV file has the columns speed_rpm, "
        "temperature_celsius and either rattles (1 or 0) or a quantity such as film_force_rms "
        "or drag_torque. The file that 'recording.py encoders' writes fits backlash and drag."
    )
    parser.add_argument("input", type=Path, help="input of a loose pair with computed or tabulated drag")
    parser.add_argument(
        "measured", type=Path, metavar="MEASURED", help="the measured points, or NAME.json of two encoders"
    )
    parser.add_argument("--gear", metavar="NAME", help="the pair, where the input has several")
    parser.add_argument("--key", default=KEY, help="the key that is fitted, by default %(default)s")
    parser.add_argument(
        "--range", type=span, default=(0.05, 20.0), metavar="LOW,HIGH", help="where it is looked for"
    )
    parser.add_argument("--second", metavar="GROUP.KEY", help="a second key to fit, with measured numbers")
    parser.add_argument(
        "--second-range", type=span, metavar="LOW,HIGH", help="where the second key is looked for"
    )
    parser.add_argument(
        "--criterion",
        choices=tuple(calibration.CRITERIA),
        default="impacts",
        help="what a pair that rattles does at least, by default %(default)s",
    )
    parser.add_argument("--output", type=Path, metavar="FILE.csv", help="save points and computed values")
    outputs.add_option(parser)
    options = command.parse(parser)
    if bool(options.second) != bool(options.second_range):
        parser.error("--second and --second-range go together")
    return options


if __name__ == "__main__":
    command.run(main)
