"""Texts as systems of test benches export them: separators, decimal marks, heads, units, clocks."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rattle import recordings

TIME = np.arange(40) * 0.01
SPEED = np.round(800.0 + np.sin(50.0 * TIME), 4)


def rows(separator: str, decimal: str = ".", form: str = ".4f", end: str = "") -> str:
    """Lines of both columns."""
    pairs = zip(TIME, SPEED, strict=True)
    lines = [separator.join(format(x, form).replace(".", decimal) for x in pair) + end for pair in pairs]
    return "\n".join(lines) + "\n"


def each(line: Callable[[float, float], str]) -> str:
    return "".join(line(time, speed) + "\n" for time, speed in zip(TIME, SPEED, strict=True))


def german(speed: float) -> str:
    """A speed in mrad/s with points between thousands and a decimal comma."""
    return f"{speed * np.pi / 30.0 * 1e3:,.3f}".replace(",", " ").replace(".", ",").replace(" ", ".")


TEXTS = {
    "INCA": "ETASAsciiItemFile record 0 0\nsampleCount 40\ntime\tn\ns\trpm\nf8\tf8\n" + rows("\t"),
    "types below units": "time,n\ns,1/min\ndouble,double\n" + rows(","),
    "LabVIEW": "LabVIEW\t\nWriter_Version\t2\n***End_of_Header***\t\n\nX_Value\tn [rpm]\tComment\n"
    + rows("\t", ",", end="\t"),
    "separator at the end": "time_s;n_rpm;\n" + rows(";", ",", end=";"),
    "aligned by blanks": "  time_s   n_rpm\n" + rows("     "),
    "quotes": '"time [s]","n [rpm]"\n' + each(lambda t, n: f'"{t:.4f}","{n:.4f}"'),
    "heads in a comment": "# measured in cell 3\n# time_s, n_rpm\n" + rows(","),
    "comments between": "time_s,n_rpm\n" + rows(",").replace("\n0.2000", "\n# marker 1\n\n0.2000"),
    "clock": "Uhrzeit;n [U/min]\n" + each(lambda t, n: f"12:00:{t:06.3f};{n:.4f}".replace(".", ",")),
    "dates": "timestamp,n_rpm\n" + each(lambda t, n: f"2026-11-28 12:00:{t:06.3f},{n:.4f}"),
    "German dates": "Datum;n\n;1/min\n"
    + each(lambda t, n: "28.11.2026 12:00:" + f"{t:06.3f};{n:.4f}".replace(".", ",")),
    "exponents": "time_s,n_rpm\n" + rows(",", form=".8E"),
    "semicolons with points": "time_s;n_rpm\n" + rows(";"),
    "both decimal marks": "time_s;n_rpm\n" + each(lambda t, n: f"{t:.3f};" + f"{n:.4f}".replace(".", ",")),
    "thousands": "time_ms;n [mrad/s]\n" + each(lambda t, n: f"{1e3 * t:.1f};".replace(".", ",") + german(n)),
    "words": "time_s,state,n_rpm\n" + rows(",").replace(",", ",idle,"),
    "short lines": "time_s,n_rpm,c\n" + each(lambda t, n: f"{t:.4f},{n:.4f}" + (",1" if n > 800.0 else "")),
    "units behind a stroke": "Zeit/s;n/(1/min)\n" + rows(";", ","),
    "units in parentheses": "Time (ms);Speed (rpm)\n" + each(lambda t, n: f"{1e3 * t:.1f};{n:.4f}"),
    "old line ends": ("time_s,n_rpm\n" + rows(",")).replace("\n", "\r"),
    "end of file of DOS": "time_s,n_rpm\n" + rows(",") + "\x1a",
    "bars": "time_s|n_rpm\n" + rows("|"),
    "spreadsheet": "sep=;\ntime_s;n_rpm\n" + rows(";", ","),
    "lines of two cells above": "Date;28.11.2026\nEngine;M270\ntime_s;n_rpm\n" + rows(";", ","),
    "unit of two words": "time_s,n_rad_s\n" + each(lambda t, n: f"{t:.4f},{n * np.pi / 30.0:.6f}"),
    "no unit of the time": "Zeit;n\n;1/min\n" + rows(";", ","),
    "no name of the time": "x,n_rpm\n" + rows(","),
}


@pytest.mark.parametrize("name", TEXTS)
def test_a_text_of_a_bench(tmp_path: Path, name: str) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(TEXTS[name].encode())
    channels = recordings.read_channels(path)
    (channel,) = (channel for channel in channels if channel.unit in ("rpm", "rad/s", "mrad/s"))
    assert channel.has_time and len(channel.values) == 40
    np.testing.assert_allclose(channel.time - channel.time[0], TIME, atol=1e-9)
    np.testing.assert_allclose(channel.within("rpm"), SPEED, atol=2e-4)


def test_one_column_and_a_rate(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_text("n [1/min]\n" + "".join(f"{n:.4f}\n" for n in SPEED).replace(".", ","))
    (channel,) = recordings.read_channels(path, rate=100.0)
    np.testing.assert_allclose(channel.time, TIME, atol=1e-9)
    np.testing.assert_allclose(channel.values, SPEED, atol=1e-9)
    (channel,) = recordings.read_channels(path)
    assert not channel.has_time


def test_a_counter_of_samples_is_no_time(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_text("sample,n_rpm\n" + "".join(f"{i},{n:.4f}\n" for i, n in enumerate(SPEED)))
    assert not recordings.read_channels(path)[1].has_time


def test_two_bytes_a_letter(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(("time_s,n_rpm\n" + rows(",")).encode("utf-16"))
    (channel,) = recordings.read_channels(path)
    np.testing.assert_allclose(channel.values, SPEED, atol=1e-9)
