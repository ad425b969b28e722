"""Results of campaigns: a row for each scene, and which of them are done."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rattle.campaign_plan import GEAR, GRID, LINEAR, Plan, PlannedAxis, read_plan
from rattle.codes import CODES, SUCCESSES, WORD_ENDING, attributes
from rattle.optional import needed
from rattle.result_file import CheckedRows, ResultFile, check_length, map_rows
from rattle.result_header import CAMPAIGN, ResultError, ResultHeader, read_header

if TYPE_CHECKING:
    import pandas
    import xarray

SCENE = "scene"


@dataclass(frozen=True)
class Axis:
    """One varied key."""

    key: str  #: as group.key
    unit: str  #: of the key
    scale: str  #: 'linear' or 'logarithmic'
    values: np.ndarray  #: in rising order for a grid, else the least and the greatest


class Campaign(ResultFile):
    """One campaign result: a mapping of column names to read-only arrays.

    ``campaign['rattle_class']`` has an entry for every scene, NaN where the scene is not done; it is mapped
    from the file as long as all are.

    Attributes
    ----------
    row_count
        Scenes that the file is to hold.
    chunks
        The chunk table: rows in a chunk, and the checksum of each.
    done
        For every scene, whether it is done.
    kind
        'grid', 'sample' or 'csv'.
    varied
        The varied keys, as group.key; 'gear' first where several pairs were solved.
    gears
        Names of these pairs, by the numbers 1, 2, ... in the column 'gear'.
    part, parts
        Which part of how many this is; 1 and 1 for a whole campaign.
    scene_count
        Scenes of the whole campaign, None where only its end shows.
    path
        Where the file is.
    names, units
        Column names in order, and the unit of each by its name.
    closed
        False when the run was killed, or still runs.
    program_version, input_text
        As written by the program.
    """

    def __init__(
        self,
        path: Path,
        header: ResultHeader,
        rows: np.ndarray,
        plan: Plan,
    ) -> None:
        super().__init__(path, header)
        self.row_count = header.chunks.row_limit
        self.chunks = header.chunks
        self.done = np.repeat(self.chunks.done, self.chunks.chunk_rows)[: self.row_count]
        self.kind = plan.kind
        self.part, self.parts = plan.part, plan.parts
        self.scene_count = plan.scene_count
        if self.scene_count is None and self.closed and self.parts == 1:
            self.scene_count = self.row_count
        self.varied = tuple(name for name in header.names if is_varied(name))
        self.gears = plan.gears
        self._pair: int | None = None
        self._plan = plan
        self._rows = CheckedRows(path, header, rows, self.row_count)

    def __getitem__(self, name: str) -> np.ndarray:
        name = self.check_column(name)
        held = self.rows[:, self.names.index(name)]
        if self.done.all():
            return held
        values = np.full(self.row_count, np.nan)
        done = self.done[: held.size]
        values[: held.size][done] = held[done]
        values.flags.writeable = False
        return values

    def __repr__(self) -> str:
        state = "closed" if self.closed else "not closed"
        return f"<Campaign {self.path}: {self.done.sum()} of {self.row_count} scenes done; {state}>"

    @property
    def rows(self) -> np.ndarray:
        """All rows that the file holds, as they stand there; those not done hold nothing meaningful."""
        self._rows.verify()
        if self._pair is None:
            return self._rows.mapped
        first = self._pair * self.row_count
        return self._rows.mapped[first : first + self.row_count]

    @property
    def name(self) -> str:
        """Name of the campaign, that of its base scene; with that of the gear if it is of one pair alone."""
        name = str(self.input.get("scene", {}).get("name", self.path.stem)).strip()
        return name if self._pair is None else f"{name}.{self.gears[self._pair]}"

    def pair(self, gear: str) -> Campaign:
        """The campaign of one gear pair alone, as if no other had been in the input.

        Parameters
        ----------
        gear
            Name of the pair.

        Returns
        -------
        campaign
            Its scenes.

        Raises
        ------
        ResultError
            There is no such pair, or this is a part of a campaign.
        """
        if gear not in self.gears:
            known = f"it has {', '.join(self.gears)}" if self.gears else "it has one pair only"
            raise ResultError(f"{self.path} has no gear '{gear}'; {known}.")
        if self.parts > 1:
            raise ResultError(f"{self.path} is a part of a campaign; merge the parts to look at one gear.")
        alone = copy.copy(self)
        for name in ("failed", "axes", "places"):
            alone.__dict__.pop(name, None)
        alone._pair = self.gears.index(gear)
        own = self.input["gear" if alone._pair == 0 else f"gear({alone._pair + 1})"]
        others = {group: keys for group, keys in self.input.items() if not group.startswith("gear")}
        alone.__dict__["input"] = others | {"gear": own}
        alone.row_count = self.row_count // len(self.gears)
        first = alone._pair * alone.row_count
        alone.done = self.done[first : first + alone.row_count]
        alone.varied = tuple(key for key in self.varied if key != GEAR)
        alone.scene_count = alone.row_count
        return alone

    @property
    def pairs(self) -> tuple[Campaign, ...]:
        """The campaign of each gear pair alone; where there is one pair only, this campaign."""
        return tuple(map(self.pair, self.gears)) if self.gears and self._pair is None else (self,)

    @cached_property
    def failed(self) -> np.ndarray:
        """For every scene, whether it is done but failed, which is what its status says."""
        if "status" not in self:
            return np.zeros(self.row_count, dtype=bool)
        return self.done & ~np.isin(self["status"], SUCCESSES)

    @cached_property
    def axes(self) -> tuple[Axis, ...]:
        """The varied keys in the order of their columns."""
        planned = {axis.key: axis for axis in self._plan.axes}
        return tuple(self._axis(key, planned.get(key)) for key in self.varied)

    def axis(self, key: str) -> Axis:
        """The axis of one varied key.

        Parameters
        ----------
        key
            The key, as group.key.

        Returns
        -------
        axis
            Its values with their unit.

        Raises
        ------
        ResultError
            The campaign does not vary it.
        """
        for axis in self.axes:
            if axis.key == key:
                return axis
        raise ResultError(f"{self.path} does not vary '{key}'; it varies {', '.join(self.varied)}.")

    @property
    def shape(self) -> tuple[int, ...]:
        """Scenes along each axis of a grid."""
        return tuple(axis.values.size for axis in self.axes)

    @cached_property
    def places(self) -> tuple[np.ndarray, ...]:
        """For every scene that is done, its index along each axis of the grid."""
        if self.kind != GRID:
            raise ResultError(f"{self.path} is not a grid but a {self.kind} campaign.")
        return tuple(_nearest(axis.values, self[axis.key][self.done]) for axis in self.axes)

    def grid(self, name: str) -> np.ndarray:
        """A column on the grid.

        Parameters
        ----------
        name
            Name of the column.

        Returns
        -------
        values
            An axis for each varied key, NaN where the scene is not done.

        Raises
        ------
        ResultError
            There is no such column, or the campaign is no grid.
        """
        values = np.full(self.shape, np.nan)
        values[self.places] = self[name][self.done]
        return values

    def to_dataframe(self) -> pandas.DataFrame:
        """The scenes that are done as a pandas DataFrame; codes also as words, in columns NAME_word."""
        pandas = needed("pandas")
        rows = np.asarray(self.rows)
        done = self.done[: rows.shape[0]]
        table = pandas.DataFrame(rows if done.all() else rows[done], columns=list(self.names))
        table["scene"] = table["scene"].astype("int64")
        for name, words in CODES.items():
            if name in self:
                dtype = pandas.CategoricalDtype(list(words.values()), ordered=False)
                table[name + WORD_ENDING] = table[name].map(words).astype(dtype)
        if GEAR in self:
            names = dict(enumerate(self.gears, 1))
            table[GEAR] = table[GEAR].map(names).astype(pandas.CategoricalDtype(list(self.gears)))
        table.attrs = {
            "campaign": self.name,
            "units": dict(self.units),
            "resolved_input": self.input_text,
            "program_version": self.program_version,
        }
        return table

    def to_xarray(self) -> xarray.Dataset:
        """An xarray Dataset over the axes of the grid, or over the scenes if the campaign is no grid.

        Codes carry flag_values and flag_meanings.
        """
        xarray = needed("xarray")
        on_grid = self.kind == GRID
        dimensions: tuple[str, ...] = self.varied if on_grid else ("scene",)
        coordinates: dict[str, Any] = {}
        if on_grid:
            for axis in self.axes:
                coordinates[axis.key] = ((axis.key,), axis.values, attributes(axis.key, self.units[axis.key]))
        else:
            scenes = self["scene"][self.done].astype("int64")
            coordinates["scene"] = (dimensions, scenes, attributes("scene", self.units["scene"]))
            for key in self.varied:
                coordinates[key] = (dimensions, self[key][self.done], attributes(key, self.units[key]))
        if GEAR in coordinates:
            along, numbers, _ = coordinates[GEAR]
            coordinates[GEAR] = (along, [self.gears[int(number) - 1] for number in numbers])
        variables = {}
        for name in self.names:
            if name in coordinates:
                continue
            values = self.grid(name) if on_grid else self[name][self.done]
            variables[name] = (dimensions, values, attributes(name, self.units[name]))
        of_campaign = {
            "title": self.name,
            "source": f"rattle {self.program_version}",
            "scenes_done": int(self.done.sum()),
            "scenes": self.row_count,
            "resolved_input": self.input_text,
        }
        return xarray.Dataset(variables, coordinates, of_campaign)

    frame, dataset = to_dataframe, to_xarray

    def _axis(self, key: str, planned: PlannedAxis | None) -> Axis:
        values = np.unique(self[key][self.done])
        scale = planned.scale if planned else LINEAR
        if self.kind != GRID:
            return Axis(key, self.units[key], scale, values[[0, -1]] if values.size else values)
        expected = np.unique(planned.values) if planned and planned.values is not None else None
        if expected is not None:
            values = _completed(values, expected, f"{self.path} contradicts its input: {key} has values")
        elif not self.done.all():
            raise ResultError(f"{self.path} does not have all values of {key}, and not all scenes are done.")
        return Axis(key, self.units[key], scale, values)


def read_campaign(path: str | Path) -> Campaign:
    """Open a campaign result.

    Parameters
    ----------
    path
        The file, NAME.rattle.

    Returns
    -------
    campaign
        Its scenes.

    Raises
    ------
    ResultError
        The file is absent, foreign, no campaign, cut short or damaged; one plain sentence.
    """
    path = Path(path)
    try:
        with path.open("rb") as stream:
            header = read_header(stream, path)
            data_bytes = stream.seek(0, 2) - header.header_bytes
    except OSError as fault:
        raise ResultError(f"{path} cannot be read: {fault.strerror or fault}.") from None
    if header.chunks.kind != CAMPAIGN:
        ResultFile(path, header).require_task("campaign")
        raise ResultError(f"{path} is not a campaign: it has no chunk table.")
    try:
        plan = read_plan(header.input_text)
    except ValueError as fault:
        raise ResultError(f"{path} is not a campaign: {fault}") from None
    if header.names[0] != SCENE or not any(is_varied(name) for name in header.names):
        raise ResultError(f"{path} is not a campaign: its columns are not a scene and the varied keys.")
    _check_rows(path, header, data_bytes)
    held = min(data_bytes // header.row_bytes, header.chunks.row_limit)
    return Campaign(path, header, map_rows(path, header, held), plan)


def is_varied(name: str) -> bool:
    """Whether a column of a campaign is a varied key."""
    return "." in name or name == GEAR


def _check_rows(path: Path, header: ResultHeader, data_bytes: int) -> None:
    """Refuse a file whose length, count of rows and chunks contradict each other."""
    chunks = header.chunks
    check_length(path, header, data_bytes)
    if header.closed and not chunks.done.all():
        missing = int(np.argmin(chunks.done)) + 1
        raise ResultError(f"{path} is damaged: it is closed, but its chunk {missing} is not done.")
    if data_bytes > chunks.row_limit * header.row_bytes:
        raise ResultError(
            f"{path} is {data_bytes - chunks.row_limit * header.row_bytes} bytes longer than its "
            f"{chunks.row_limit} rows."
        )
    done = np.flatnonzero(chunks.done)
    held = data_bytes // header.row_bytes
    if done.size and held < min((int(done[-1]) + 1) * chunks.chunk_rows, chunks.row_limit):
        raise ResultError(
            f"{path} is cut short: its chunk {int(done[-1]) + 1} counts as done, but {held} rows are all "
            "it holds."
        )


def _nearest(values: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Index of the nearest entry of the rising `values`."""
    middles = 0.5 * (values[1:] + values[:-1])
    return np.searchsorted(middles, wanted)


def _completed(values: np.ndarray, expected: np.ndarray, complaint: str) -> np.ndarray:
    """The expected values, replaced by those of the rows, which may differ in their last digits."""
    completed = expected.copy()
    if values.size:
        place = _nearest(expected, values)
        gap = np.diff(expected).min(initial=np.abs(expected).max())
        strange = np.abs(values - expected[place]) > 1e-6 * gap
        if strange.any():
            raise ResultError(f"{complaint} such as {values[strange][0]:.6g} that are not on its axis.")
        completed[place] = values
    return completed
