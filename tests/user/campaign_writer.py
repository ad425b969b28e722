"""Writes made-up campaigns for the tests, independent of the reader and of the Fortran program."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path

import numpy as np
from result_writer import checksum, header

FORCE, SPEED, VISCOSITY = "load.force_amplitude", "kinematics.entrainment_speed", "lubricant.viscosity"
UNITS = {FORCE: "N", SPEED: "m/s", VISCOSITY: "Pa s"}
RECORDED = (
    ("film_minimum", "m"),
    ("film_maximum", "m"),
    ("acceleration_minimum", "m/s2"),
    ("acceleration_maximum", "m/s2"),
    ("natural_frequency", "Hz"),
    ("damping_ratio", "-"),
    ("harmonic_count", "-"),
    ("harmonic_distortion", "-"),
    ("irregular_fraction", "-"),
    ("reversals_per_period", "-"),
    ("rattle_class", "-"),
    ("film_regime", "-"),
    ("law_contradicted", "-"),
    ("alpha_p_maximum", "-"),
    ("status", "-"),
    ("period_count", "-"),
    *((f"harmonic_{n}", "m/s2") for n in range(1, 9)),
    ("verified", "-"),
)

BASE = """&scene
   name = '{name}'
   task = 'campaign'
/
&contact
   radius = 0.0127
   length = 0.01
/
&lubricant
   viscosity = 0.3
   pressure_viscosity = 2.0E-8
/
&kinematics
   entrainment_speed = 1.905
/
&load
   mass = 3.0
   steady_force = 199.2
   force_amplitude = 205.7
   frequency = 600.0
/
&film
   law = 'iso-viscous'
   model = 'published'
/
&solver
   method = 'newmark'
   steps_per_period = 64
   periods = 20
/
&output
   series = .false.
   columns = 'time', 'film_thickness', 'acceleration'
/
"""


@dataclass(frozen=True)
class Key:
    """A varied key of a grid."""

    key: str
    first: float
    last: float
    count: int
    scale: str = "linear"
    listed: tuple[float, ...] = ()

    @property
    def values(self) -> np.ndarray:
        if self.listed:
            return np.array(self.listed)
        space = np.geomspace if self.scale == "logarithmic" else np.linspace
        return space(self.first, self.last, self.count)


FORCES = Key(FORCE, 20.0, 400.0, 20)
SPEEDS = Key(SPEED, 0.5, 5.0, 15, "logarithmic")
VISCOSITIES = Key(VISCOSITY, 0.0, 0.0, 0, listed=(0.1, 0.3, 0.9))
# Forces and speeds of the scenes of a CSV file.
LISTED = ((100.0, 1.0), (300.0, 1.5), (250.0, 4.0))


@dataclass
class Made:
    """A campaign to write: `rows` hold all scenes, in order."""

    name: str
    columns: list[tuple[str, str]]
    rows: np.ndarray
    group: str
    chunk_rows: int = 64
    version: str = "0.1.0"
    source: int = 0
    base: str = field(default=BASE)

    def input_text(self, part: int = 1, parts: int = 1) -> str:
        share = f"   part = {part}\n   parts = {parts}\n"
        return self.base.format(name=self.name) + f"&campaign\n{self.group}{share}/\n"

    def column(self, name: str) -> np.ndarray:
        """A column, to look at or to change."""
        return self.rows[:, [column for column, _ in self.columns].index(name)]

    def content(
        self, *, part: int = 1, parts: int = 1, undone: Iterable[int] = (), closed: bool = True
    ) -> bytes:
        """A whole file, or one part of it; `undone` chunks, from 0, hold rubbish."""
        size = self.chunk_rows
        chunks = math.ceil(len(self.rows) / size)
        first, last = chunks * (part - 1) // parts, chunks * part // parts
        rows = self.rows[first * size : last * size].copy()
        checksums = [checksum(rows[i * size : (i + 1) * size].tobytes()) for i in range(last - first)]
        for chunk in undone:
            checksums[chunk] = 0
            rows[chunk * size : (chunk + 1) * size] = -7e77
        head = header(
            self.columns,
            self.input_text(part, parts).encode("ascii"),
            table=(b"CHUNKTAB", size, len(checksums), len(rows)),
            checksums=checksums,
            row_count=len(rows) if closed else -1,
            program_version=self.version,
            source=self.source,
        )
        return head + rows.astype("<f8").tobytes()

    def write(self, path: Path, **options) -> Path:
        path.write_bytes(self.content(**options))
        return path

    def write_parts(self, directory: Path, parts: int, **options) -> list[Path]:
        return [
            self.write(
                directory / f"{self.name}.part-{part}-of-{parts}.rattle", part=part, parts=parts, **options
            )
            for part in range(1, parts + 1)
        ]


def grid(
    *keys: Key, name: str = "map", slow_first: bool = False, failures: bool = False, chunk_rows: int = 64
) -> Made:
    """A grid; the first key varies fastest unless `slow_first`."""
    if slow_first:
        points = np.array(list(product(*(key.values for key in keys))))
    else:
        points = np.array(list(product(*(key.values for key in reversed(keys)))))[:, ::-1]
    lines = "   sample = 'grid'\n"
    for i, key in enumerate(keys, 1):
        lines += f"   vary({i}) = '{key.key}'\n"
        if key.listed:
            lines += f"   values(1:{len(key.listed)}, {i}) = {', '.join(map(repr, key.listed))}\n"
        else:
            lines += f"   scale({i}) = '{key.scale}'\n   first({i}) = {key.first!r}\n"
            lines += f"   last({i}) = {key.last!r}\n   count({i}) = {key.count}\n"
    return _made(name, [key.key for key in keys], points, lines, failures, chunk_rows)


def sample(size: int = 300, name: str = "cloud", failures: bool = False) -> Made:
    """Scenes that are no grid."""
    random = np.random.default_rng(7)
    points = np.column_stack([random.uniform(20.0, 400.0, size), 0.5 * 10.0 ** random.uniform(0, 1, size)])
    lines = f"   vary = '{FORCE}', '{SPEED}'\n   scale = 'linear', 'logarithmic'\n"
    lines += "   first = 20.0, 0.5\n   last = 400.0, 5.0\n"
    lines += f"   sample = 'sobol'\n   size = {size}\n   seed = 1\n"
    return _made(name, [FORCE, SPEED], points, lines, failures, 64)


def csv_table(name: str = "list", points: Sequence[Sequence[float]] = LISTED) -> Made:
    points = np.array(points)
    return _made(name, [FORCE, SPEED], points, "   csv = 'scenes.csv'\n", False, 2)


def _made(
    name: str, keys: Sequence[str], points: np.ndarray, lines: str, failures: bool, chunk_rows: int
) -> Made:
    columns = [("scene", "-"), *((key, UNITS[key]) for key in keys), *RECORDED]
    given = dict(zip(keys, points.T, strict=True))
    force = given.get(FORCE, np.full(len(points), 205.7))
    speed = given.get(SPEED, np.full(len(points), 1.905))
    viscosity = given.get(VISCOSITY, np.full(len(points), 0.3))
    data = _quantities(force, speed, viscosity)
    if failures:
        _let_fail(data, force, speed)
    scenes = np.arange(1.0, len(points) + 1)
    rows = np.column_stack([scenes, points, *(data[column] for column, _ in RECORDED)])
    return Made(name, columns, rows, lines, chunk_rows)


def _quantities(force: np.ndarray, speed: np.ndarray, viscosity: np.ndarray) -> dict[str, np.ndarray]:
    """Smooth numbers of plausible size, not physics."""
    severity = force / 205.7 * (1.905 / speed) ** 0.4 * (0.3 / viscosity) ** 0.2
    film = 0.9e-6 * (speed / 1.905) * (viscosity / 0.3)
    distortion = 1.3 * severity**1.5
    borders = [distortion < 0.35, severity < 0.8, severity < 1.6, severity < 1.8, severity < 2.0]
    codes = np.select(borders, [1.0, 2.0, 3.0, 6.0, 5.0], 4.0)
    data = {
        "film_minimum": film / (1.0 + 1.5 * severity),
        "film_maximum": film * (1.0 + 3.0 * severity),
        "acceleration_minimum": -60.0 * severity,
        "acceleration_maximum": 200.0 * severity**2,
        "natural_frequency": 1473.6 * (1.905 / speed) ** 0.9,
        "damping_ratio": 0.61 * (speed / 1.905) ** 0.25 * (viscosity / 0.3) ** 0.5,
        "harmonic_count": np.floor(30.0 * np.minimum(severity, 1.3)),
        "harmonic_distortion": distortion,
        "irregular_fraction": np.where(codes >= 4.0, 0.05 * severity, 0.0),
        "reversals_per_period": np.where(codes >= 3.0, 4.0, 2.0),
        "rattle_class": codes,
        "film_regime": np.select([severity < 0.3, severity < 0.9], [1.0, 2.0], 3.0),
        "law_contradicted": (severity > 0.3).astype(float),
        "alpha_p_maximum": 1.5 * severity,
        "status": np.ones_like(severity),
        "period_count": np.floor(12.0 + 20.0 * severity),
        "verified": ((codes < 4.0) & (np.abs(severity - 0.8) > 0.03)).astype(float),
    }
    for n in range(1, 9):
        data[f"harmonic_{n}"] = 20.0 * severity / n ** (2.0 / (0.5 + severity))
    return data


def _let_fail(data: dict[str, np.ndarray], force: np.ndarray, speed: np.ndarray) -> None:
    """Two corners of the map fail, each in its own way; a failed scene knows little."""
    lost = (force > 330.0) & (speed < 0.8)
    rigid = (force > 370.0) & (speed > 3.0)
    for failed, status in ((lost, 3.0), (rigid, 4.0)):
        for name in data:
            if name not in ("natural_frequency", "damping_ratio"):
                data[name][failed] = np.nan
        data["status"][failed] = status


def with_verdicts(made: Made, *, verified: bool = True) -> Made:
    """The same with verdicts and film forces: each verdict in a quarter of the scenes, side by side."""
    count = len(made.rows)
    force = made.rows[:, 1]
    columns = {"verdict": np.floor(4.0 * np.arange(count) / count), "film_force_rms": 0.01 * force**1.5}
    if verified:
        columns["verdict_verified"] = (np.arange(count) % 7 > 0).astype(float)
    made.columns = [*made.columns, *((name, "N" if "force" in name else "-") for name in columns)]
    made.rows = np.column_stack([made.rows, *columns.values()])
    return made
