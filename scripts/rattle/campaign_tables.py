"""Campaigns as pandas DataFrame, pyarrow Table and xarray Dataset. These packages are loaded only here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rattle.campaign_plan import GRID
from rattle.codes import CODES, words_of

if TYPE_CHECKING:
    import pandas
    import pyarrow
    import xarray

    from rattle.campaign import Campaign

WORD_ENDING = "_word"


def frame(campaign: Campaign) -> pandas.DataFrame:
    """A row for each scene that is done; codes also as words, a category each."""
    import pandas

    rows = np.asarray(campaign.rows)
    done = campaign.done[: rows.shape[0]]
    table = pandas.DataFrame(rows if done.all() else rows[done], columns=list(campaign.names))
    table["scene"] = table["scene"].astype("int64")
    for name, words in CODES.items():
        if name in campaign:
            dtype = pandas.CategoricalDtype(list(words.values()), ordered=False)
            table[name + WORD_ENDING] = table[name].map(words).astype(dtype)
    table.attrs = {
        "campaign": campaign.name,
        "units": dict(campaign.units),
        "resolved_input": campaign.input_text,
        "program_version": campaign.program_version,
    }
    return table


def arrow_table(campaign: Campaign) -> pyarrow.Table:
    """The frame with the units in the metadata of its fields and the resolved input in that of the table."""
    import pyarrow

    plain = frame(campaign)
    plain.attrs = {}
    table = pyarrow.Table.from_pandas(plain, preserve_index=False)
    fields = [
        field.with_metadata({"unit": campaign.units[field.name]}) if field.name in campaign.units else field
        for field in table.schema
    ]
    metadata = dict(table.schema.metadata or {})
    metadata.update(
        {
            b"campaign": campaign.name.encode(),
            b"program_version": campaign.program_version.encode(),
            b"resolved_input": campaign.input_text.encode(),
        }
    )
    return table.cast(pyarrow.schema(fields, metadata=metadata))


def dataset(campaign: Campaign) -> xarray.Dataset:
    """Variables over the varied keys of a grid, or over the scene; codes carry flag_values, flag_meanings."""
    import xarray

    on_grid = campaign.kind == GRID
    dimensions: tuple[str, ...] = campaign.varied if on_grid else ("scene",)
    coordinates: dict[str, Any] = {}
    if on_grid:
        for axis in campaign.axes:
            coordinates[axis.key] = ((axis.key,), axis.values, _attributes(campaign, axis.key))
    else:
        scenes = campaign["scene"][campaign.done].astype("int64")
        coordinates["scene"] = (dimensions, scenes, _attributes(campaign, "scene"))
        for key in campaign.varied:
            coordinates[key] = (dimensions, campaign[key][campaign.done], _attributes(campaign, key))
    variables = {}
    for name in campaign.names:
        if name in coordinates:
            continue
        values = campaign.grid(name) if on_grid else campaign[name][campaign.done]
        variables[name] = (dimensions, values, _attributes(campaign, name))
    attributes = {
        "title": campaign.name,
        "source": f"rattle {campaign.program_version}",
        "scenes_done": int(campaign.done.sum()),
        "scenes": campaign.row_count,
        "resolved_input": campaign.input_text,
    }
    return xarray.Dataset(variables, coordinates, attributes)


def _attributes(campaign: Campaign, name: str) -> dict[str, Any]:
    attributes: dict[str, Any] = {
        "units": _udunits(campaign.units[name]),
        "long_name": name.replace("_", " "),
    }
    words = words_of(name)
    if words:
        attributes["flag_values"] = np.array(list(words), dtype=float)
        attributes["flag_meanings"] = " ".join(words.values())
    return attributes


def _udunits(unit: str) -> str:
    """The unit as readers of NetCDF know it."""
    known = {"": "1", "-": "1", "m/s2": "m s-2", "m/s": "m s-1", "1/Pa": "Pa-1"}
    return known.get(unit, unit)
