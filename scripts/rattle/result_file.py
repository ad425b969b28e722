"""What all result files share: header facts, the resolved input, and the checked map of the rows."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from rattle.checksums import LANES, checksum, checksums
from rattle.counts import counted
from rattle.namelist import NamelistError, parse
from rattle.result_header import SERIES, ColumnError, ResultError, ResultHeader

# Threads that verify chunks, and chunks below which another thread is not worth its start.
MOST_THREADS = 4
FEWEST_CHUNKS = 4
# Chunks of a few rows that are verified at a time.
SHORT_CHUNKS = 4096
DERIVED = re.compile(r"^! derived: (\w+)\.(\w+) = ([-+.\dE]+(?:, [-+.\dE]+)*) ?(.*)", re.MULTILINE)
# Tasks whose results plot.py draws, with a command of that name.
DRAWN = ("motion", "film", "sweep", "campaign", "threshold")


def _refuse(*_: object, **__: object) -> NoReturn:
    raise TypeError("A result cannot be changed; dict(result) is a mapping that can.")


if TYPE_CHECKING:

    class _Dict:
        """Nothing: for a checker of types the columns are a Mapping and no dict."""
else:
    _Dict = dict


class ColumnMapping(Mapping[str, np.ndarray], _Dict):
    """A read-only mapping that computes its values; a dict, but by type alone, since pandas asks for one.

    As a dict it is empty: all methods are those of Mapping.
    """

    __setitem__ = __delitem__ = __ior__ = clear = pop = popitem = setdefault = update = _refuse
    __eq__, __ne__, __hash__ = object.__eq__, object.__ne__, object.__hash__

    def __or__(self, other: Mapping[str, Any]) -> dict[str, Any]:
        return {**self, **other}

    def __ror__(self, other: Mapping[str, Any]) -> dict[str, Any]:
        return {**other, **self}

    def copy(self) -> dict[str, np.ndarray]:
        """The columns as a dict of its own."""
        return dict(self)

    def __reversed__(self) -> Iterator[str]:
        return reversed(list(self))

    def __reduce_ex__(self, _: object) -> tuple[object, ...]:
        return _made, (type(self),), self.__dict__


def _made(kind: type[ColumnMapping]) -> ColumnMapping:
    """An instance that gets its attributes afterwards, as copy and pickle make it."""
    return kind.__new__(kind)


class ResultFile(ColumnMapping):
    """A result file of any kind: its place, its columns by name, and what its header has.

    Attributes
    ----------
    header
        What the file has before the rows.
    path
        Where the file is.
    names, units
        Column names in order, and the unit of each by its name.
    closed
        False when the run was killed, or still runs.
    program_version, input_text
        As written by the program.
    """

    def __init__(self, path: Path, header: ResultHeader) -> None:
        self.path = path
        self.header = header
        self.names = header.names
        self.units: Mapping[str, str] = MappingProxyType(dict(zip(header.names, header.units, strict=True)))
        self.closed = header.closed
        self.program_version = header.program_version
        self.input_text = header.input_text

    def __getitem__(self, name: str) -> np.ndarray:
        raise NotImplementedError("each kind of file has its rows in another way")

    def __contains__(self, name: object) -> bool:
        return name in self.units

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def check_column(self, name: str) -> str:
        """The name of a column; refuse a name that is no column.

        Parameters
        ----------
        name
            The name.

        Returns
        -------
        name
            The same.

        Raises
        ------
        ResultError
            There is no such column.
        """
        if name not in self:
            raise ColumnError(f"{self.path} has no column '{name}'; it holds {', '.join(self.names)}.")
        return name

    @cached_property
    def input(self) -> dict[str, dict[str, Any]]:
        """The resolved input, by group and key."""
        try:
            groups = parse(self.input_text)
            # What follows from &gear, &shaft and &oil; a sweep or campaign may vary what it follows from.
            if groups.get("scene", {}).get("task") == "motion":
                for group, key, value, _ in DERIVED.findall(self.input_text):
                    numbers = [float(number) for number in value.split(",")]
                    several = len(numbers) > 1 or key.startswith("force_")
                    groups.setdefault(group, {})[key] = numbers if several else numbers[0]
            return groups
        except NamelistError as fault:
            raise ResultError(f"The resolved input in {self.path} cannot be read: {fault}") from None

    @property
    def derived_units(self) -> dict[tuple[str, str], str]:
        """The unit of each value, by group and key, that follows from &gear, &shaft and &oil."""
        return {(group, key): unit for group, key, _, unit in DERIVED.findall(self.input_text)}

    def value(self, group: str, key: str) -> Any:
        """One value of the resolved input.

        Parameters
        ----------
        group, key
            Names of its group and key.

        Returns
        -------
        value
            As the input has it.

        Raises
        ------
        ResultError
            There is no such key.
        """
        try:
            return self.input[group][key]
        except KeyError:
            raise ResultError(f"The resolved input in {self.path} has no {group}.{key}.") from None

    @property
    def has_gear(self) -> bool:
        """Whether the input describes gear pairs, whose acceleration is relative to the shaft."""
        return any(group.partition("(")[0] == "gear" for group in self.input)

    @property
    def summary_path(self) -> Path:
        """Where the program writes the summary of this run."""
        return self.path.with_suffix(".summary.nml")

    @property
    def task(self) -> str:
        """What the program was to do, as in 'motion', 'film' or 'sweep'."""
        return str(self.value("scene", "task")).strip()

    def require_task(self, task: str) -> None:
        """Refuse the result of another task, and name the command that draws it.

        Parameters
        ----------
        task
            The task that it has to be of.

        Raises
        ------
        ResultError
            It is of another task.
        """
        if self.task != task:
            drawn_by = f"; 'plot.py {self.task}' draws it" if self.task in DRAWN else ""
            raise ResultError(
                f"{self.path} is not a {task} but the result of task = '{self.task}'{drawn_by}."
            )


class CheckedRows:
    """The rows of a file, mapped; each chunk of them is compared with its checksum when first used.

    `mapped` holds all rows, those of series that are extremes at its end. Rows of a file in progress that no
    checksum covers yet, and chunks of a campaign that are not done, are given as they are.
    """

    def __init__(self, path: Path, header: ResultHeader, mapped: np.ndarray, row_count: int) -> None:
        self.mapped = mapped
        self._path = path
        self._header = header
        covered = header.seal.rows if header.chunks.kind == SERIES else header.chunks.row_limit
        self._covered = min(covered, row_count)
        self._sound = np.zeros(-(-self._covered // header.chunks.chunk_rows), dtype=bool)

    def verify(self, rows: slice = slice(None)) -> None:
        """Refuse a file whose rows are not what their checksums say."""
        chunk_rows = self._header.chunks.chunk_rows
        first, last, _ = slice(rows.start, rows.stop).indices(self._covered)
        chunks = range(first // chunk_rows, -(-last // chunk_rows) if last > first else 0)
        self._verify_short_chunks(chunks)
        unknown = [chunk for chunk in chunks if not self._sound[chunk]]
        # One core is slower than the memory.
        threads = min(MOST_THREADS, len(os.sched_getaffinity(0)), len(unknown) // FEWEST_CHUNKS)
        if threads > 1:
            with ThreadPoolExecutor(threads) as pool:
                for _ in pool.map(self._verify_chunk, unknown):
                    pass
        else:
            for chunk in unknown:
                self._verify_chunk(chunk)
        self._sound[unknown] = True

    def _verify_short_chunks(self, chunks: range) -> None:
        """Chunks of a few rows, many at a time; one that is not what its checksum says is left."""
        table, columns = self._header.chunks, self.mapped.shape[1]
        # A campaign in progress may end before the rows of all its chunks.
        held = min(self._covered, self.mapped.shape[0]) // table.chunk_rows
        whole = range(chunks.start, min(chunks.stop, held))
        if table.kind == SERIES or table.chunk_rows * columns > LANES:
            return
        for start in range(whole.start, whole.stop, SHORT_CHUNKS):
            some = slice(start, min(start + SHORT_CHUNKS, whole.stop))
            rows = self.mapped[some.start * table.chunk_rows : some.stop * table.chunk_rows]
            sums = checksums(rows.reshape(some.stop - some.start, -1))
            self._sound[some] |= sums == table.checksums[some]

    def _verify_chunk(self, chunk: int) -> None:
        table, seal = self._header.chunks, self._header.seal
        first = chunk * table.chunk_rows
        last = min(first + table.chunk_rows, self._covered)
        stored = table.checksums[chunk]
        if table.kind == SERIES and last - first < table.chunk_rows:
            stored = seal.rest_checksum
        elif table.kind != SERIES and stored == 0:
            return
        if checksum(self.mapped[first:last]) != stored:
            start = self._header.header_bytes
            places = (
                f"bytes {start + first * self._header.row_bytes} to {start + last * self._header.row_bytes}"
            )
            raise ResultError(
                f"{self._path} is damaged: rows {first + 1} to {last} ({places}) are not what their "
                "checksum says."
            )

    def extremes(self) -> np.ndarray:
        """The rows behind the others, verified."""
        seal = self._header.seal
        rows = self.mapped[self.mapped.shape[0] - seal.extremes :] if self._header.closed else self.mapped[:0]
        if rows.size and checksum(rows) != seal.extremes_checksum:
            raise ResultError(f"{self._path} is damaged: its extreme rows are not what their checksum says.")
        return rows


def check_length(path: Path, header: ResultHeader, data_bytes: int) -> None:
    """Refuse a closed file that holds fewer or more rows than its header says."""
    held = data_bytes // header.row_bytes
    if not header.closed:
        return
    expected = (header.row_count + header.seal.extremes) * header.row_bytes
    if data_bytes < expected:
        raise ResultError(f"{path} is cut short: it holds {held} of its {counted(header.row_count, 'row')}.")
    if data_bytes > expected:
        raise ResultError(
            f"{path} is {counted(data_bytes - expected, 'byte')} longer than its "
            f"{counted(header.row_count, 'row')}."
        )


def map_rows(path: Path, header: ResultHeader, row_count: int) -> np.ndarray:
    """The first rows of the file, read-only, an index for the column behind that of the row."""
    shape = (row_count, len(header.names))
    if row_count == 0:  # an empty range cannot be mapped
        rows = np.empty(shape, dtype="<f8")
        rows.flags.writeable = False
        return rows
    try:
        return np.memmap(path, dtype="<f8", mode="r", offset=header.header_bytes, shape=shape)
    except OSError as fault:
        raise ResultError(f"{path} cannot be mapped: {fault.strerror or fault}.") from None
