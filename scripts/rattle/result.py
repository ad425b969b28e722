"""Result files as named, memory-mapped columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from rattle.codes import CODES, WORD_ENDING, attributes, quantity_of, word
from rattle.optional import needed
from rattle.result_file import CheckedRows, ResultFile, check_length, map_rows
from rattle.result_header import ResultError, ResultHeader, read_header
from rattle.summary import read_summary

if TYPE_CHECKING:
    import pandas
    import xarray

TIME = "time"
# How the table of all motions of a scene ends.
MOTIONS_ENDING = ".motions.rattle"
# How the table of pressures and films over the contact ends.
PROFILES_ENDING = ".profiles.rattle"


class Result(ResultFile):
    """One result file of a single scene: a mapping of column names to read-only arrays.

    ``result['film_thickness']`` is mapped from the file, not a copy. What is read is compared with the
    checksums of the file; a column as a whole, `samples` the rows asked for.

    Attributes
    ----------
    row_count
        Rows that the file holds, without the extreme ones.
    coarse
        Whether the program says that the series is coarser than the motion.
    path
        Where the file is.
    names, units
        Column names in order, and the unit of each by its name.
    closed
        False when the run was killed, or still runs.
    program_version, input_text
        As written by the program.
    """

    def __init__(self, path: Path, header: ResultHeader, rows: np.ndarray, row_count: int) -> None:
        super().__init__(path, header)
        self.row_count = row_count
        self.coarse = bool(header.seal.coarse)
        self._rows = CheckedRows(path, header, rows, row_count)

    def __getitem__(self, name: str) -> np.ndarray:
        return self._part(name)

    @property
    def columns(self) -> Result:
        """The mapping of column name to array, which is the result itself."""
        return self

    def _part(self, name: str, rows: slice = slice(None)) -> np.ndarray:
        """Some rows of a column; no others are verified."""
        place = self.names.index(self.check_column(name))
        self._rows.verify(rows)
        return self._rows.mapped[: self.row_count, place][rows]

    @cached_property
    def extremes(self) -> Mapping[str, np.ndarray]:
        """The extreme rows by column, which are extremes of the motion that fall between the other rows."""
        rows = self._rows.extremes()
        return MappingProxyType({name: rows[:, place] for place, name in enumerate(self.names)})

    def merged(self, names: Sequence[str], rows: slice = slice(None)) -> list[np.ndarray]:
        """Some columns with the extreme rows put in by time, for a curve; copies, all finite.

        Parameters
        ----------
        names
            Names of the columns.
        rows
            Which rows, by default all.

        Returns
        -------
        columns
            An array for each name.

        Raises
        ------
        ResultError
            A value is not finite.
        """
        parts = [self.samples(name, rows) for name in names]
        if TIME not in self or not self.extremes[TIME].size:
            return parts
        time, between = self.samples(TIME, rows), np.asarray(self.extremes[TIME])
        inside = (
            (between >= time[0]) & (between <= time[-1]) if time.size else np.zeros(between.size, dtype=bool)
        )
        places = np.searchsorted(time, between[inside], side="right")
        return [
            np.insert(part, places, self.extremes[name][inside])
            for name, part in zip(names, parts, strict=True)
        ]

    def table(self) -> dict[str, np.ndarray]:
        """All columns, with the extreme rows put in by time where there are times."""
        if TIME in self and self.extremes[TIME].size:
            return dict(zip(self.names, self.merged(self.names), strict=True))
        return {name: np.array(self[name]) for name in self.names}

    def to_dataframe(self) -> pandas.DataFrame:
        """The table as a pandas DataFrame; codes also as words, in columns NAME_word."""
        pandas = needed("pandas")
        frame = pandas.DataFrame(self.table())
        for name in (name for name in self.names if quantity_of(name) in CODES):
            frame[name + WORD_ENDING] = [word(name, code) for code in frame[name]]
        frame.attrs = {"units": dict(self.units), **self._reported}
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """The table as an xarray Dataset over time, or over the rows where there are no times."""
        xarray = needed("xarray")
        columns = self.table()
        along = TIME if TIME in self else "row"
        variables = {
            name: (along, values, attributes(name, self.units[name])) for name, values in columns.items()
        }
        coordinates = {TIME: variables.pop(TIME)} if TIME in self else {}
        return xarray.Dataset(variables, coordinates, self._reported)

    frame, dataset = to_dataframe, to_xarray

    @property
    def _reported(self) -> dict[str, str]:
        return {
            "title": self.scene_name,
            "source": f"rattle {self.program_version}",
            "resolved_input": self.input_text,
        }

    def __repr__(self) -> str:
        state = "closed" if self.closed else "not closed"
        return f"<Result {self.path}: {self.row_count} rows of {', '.join(self)}; {state}>"

    def require_rows(self, task: str) -> None:
        """Refuse the result of another task, or one that holds nothing to draw.

        Parameters
        ----------
        task
            The task that it has to be of.

        Raises
        ------
        ResultError
            It is none of that, or has no row.
        """
        self.require_task(task)
        if self.row_count == 0:
            raise ResultError(f"{self.path} holds no row: there is nothing to draw.")

    def number(self, group: str, key: str) -> float:
        """One number of the resolved input.

        Parameters
        ----------
        group, key
            Names of its group and key.

        Returns
        -------
        number
            In the unit of the key.

        Raises
        ------
        ResultError
            There is no such number.
        """
        number = self.value(group, key)
        if isinstance(number, bool) or not isinstance(number, int | float):
            raise ResultError(f"The resolved input in {self.path} has no number as {group}.{key}.")
        return number

    def positive_integer(self, group: str, key: str) -> int:
        """One count of the resolved input.

        Parameters
        ----------
        group, key
            Names of its group and key.

        Returns
        -------
        count
            At least 1.

        Raises
        ------
        ResultError
            There is no such count.
        """
        number = self.number(group, key)
        if number != int(number) or number < 1:
            raise ResultError(f"The resolved input in {self.path} has no positive integer as {group}.{key}.")
        return int(number)

    def samples(self, name: str, rows: slice = slice(None)) -> np.ndarray:
        """A contiguous copy of some rows of a column, all of them finite.

        Parameters
        ----------
        name
            Name of the column.
        rows
            Which rows, by default all.

        Returns
        -------
        values
            In the unit of the column.

        Raises
        ------
        ResultError
            There is no such column, a value is not finite, or the file is damaged.
        """
        values = np.ascontiguousarray(self._part(name, rows), dtype=np.float64)
        if not np.isfinite(values).all():
            raise ResultError(f"The column '{name}' of {self.path} holds values that are not finite.")
        return values

    @property
    def motions(self) -> Result | None:
        """The motions that the starts of the scene led to, one per row; None where one start was followed."""
        return self._table_beside(MOTIONS_ENDING)

    @property
    def profiles(self) -> Result | None:
        """Pressures and films over the contact, a row for each node; None where none were written."""
        return self._table_beside(PROFILES_ENDING)

    def _table_beside(self, ending: str) -> Result | None:
        path = self.path.with_name(self.path.name.removesuffix(".rattle") + ending)
        return read(path) if path.exists() else None

    @property
    def scene_name(self) -> str:
        """Name of the scene."""
        return str(self.value("scene", "name")).strip()

    @property
    def law(self) -> str:
        """The film law, 'iso-viscous' or 'piezo-viscous'."""
        return str(self.value("film", "law")).strip()

    @property
    def frequency(self) -> float:
        """The excitation frequency [Hz]."""
        return float(self.number("load", "frequency"))

    @property
    def shaft_speed(self) -> float | None:
        """The mean speed [1/min] of the shaft that the input describes, if it describes one."""
        if "speed_rpm" not in self.input.get("shaft", {}):
            return None
        return float(self.number("shaft", "speed_rpm"))

    @property
    def samples_per_period(self) -> int:
        """Rows in one period of the excitation."""
        newmark = str(self.input.get("solver", {}).get("method", "newmark")).strip() == "newmark"
        steps = self.positive_integer("solver", "steps_per_period" if newmark else "samples_per_period")
        stride = self.positive_integer("output", "stride")
        if steps % stride != 0:
            raise ResultError(
                f"{self.path} has no whole number of samples a period: "
                f"a stride of {stride} does not divide {steps} steps."
            )
        return steps // stride

    @property
    def whole_periods(self) -> int:
        """Whole periods that the rows span; the first row is the start at t = 0."""
        return max(self.row_count - 1, 0) // self.samples_per_period

    @property
    def is_irregular(self) -> bool:
        """Whether the summary beside it says that neighbouring motions diverge."""
        return (
            self.summary_path.exists() and read_summary(self.summary_path).get("rattle_class") == "irregular"
        )

    @property
    def orbit_period(self) -> int | None:
        """Periods after which the motion is known to repeat, by the summary beside it."""
        if not self.summary_path.exists():
            return None
        summary = read_summary(self.summary_path)
        if "orbit_period" not in summary or summary.get("orbit_stability") == "unstable":
            return None
        return int(summary["orbit_period"])

    @property
    def window_periods(self) -> int:
        """Periods that the program judged, those of the &spectrum group, or one period of a steady motion."""
        if str(self.input.get("solver", {}).get("until", "periods")).strip() == "steady":
            if not self.summary_path.exists():
                raise ResultError(
                    f"{self.path} ran until steady; its window stands in {self.summary_path}, "
                    "which is not there."
                )
            summary = read_summary(self.summary_path)
            if "window_periods" not in summary:
                raise ResultError(
                    f"{self.path} has no window: its run ended before one was whole "
                    f"({summary.get('status', 'unknown')})."
                )
            return int(summary["window_periods"])
        return self.positive_integer("spectrum", "periods")

    def window(self, periods: int | None = None, *, with_start: bool = False) -> slice:
        """The rows of the last whole periods of the excitation.

        The window is half open: its first sample follows its start by one sample, so it holds exactly
        ``periods * samples_per_period`` rows, as a spectrum needs them.

        Parameters
        ----------
        periods
            How many, by default those that the program judged.
        with_start
            Whether the row at its start is added, as a picture of the whole window needs it.

        Returns
        -------
        rows
            The slice of rows.

        Raises
        ------
        ResultError
            The file holds fewer periods.
        """
        if periods is None:
            periods = self.window_periods
        if periods < 1:
            raise ResultError("A window needs at least one period.")
        if periods > self.whole_periods:
            raise ResultError(
                f"{self.path} holds {self.whole_periods} whole periods, fewer than the {periods} asked for."
            )
        start = self.row_count - periods * self.samples_per_period
        return slice(start - 1 if with_start else start, self.row_count)


def read(path: str | Path) -> Result:
    """Open a result file.

    Parameters
    ----------
    path
        The file, NAME.rattle.

    Returns
    -------
    result
        Its columns, mapped from the file.

    Raises
    ------
    ResultError
        The file is absent, foreign, cut short, of another version or byte order; one plain sentence.
    """
    path = Path(path)
    try:
        with path.open("rb") as stream:
            header = read_header(stream, path)
            data_bytes = stream.seek(0, 2) - header.header_bytes
    except OSError as fault:
        raise ResultError(f"{path} cannot be read: {fault.strerror or fault}.") from None
    check_length(path, header, data_bytes)
    held = data_bytes // header.row_bytes
    row_count = header.row_count if header.closed else held
    if not header.closed and header.seal.extremes:
        row_count = header.seal.rows  # the run ended while it wrote the extreme rows
    return Result(path, header, map_rows(path, header, held), row_count)
