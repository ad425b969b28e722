"""Campaigns as CSV, Parquet and NetCDF; other results as NetCDF."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rattle.campaign_result import Campaign
from rattle.codes import CODES, WORD_ENDING, word
from rattle.result import Result
from rattle.result_file import ResultFile

if TYPE_CHECKING:
    import pyarrow
    import xarray

ROWS_AT_ONCE = 10000


def write_csv(campaign: Campaign, path: Path) -> None:
    """A head of name[unit], then the scenes that are done; every number reads back as the same float64."""
    coded = [name for name in CODES if name in campaign]
    head = [f"{name}[{campaign.units[name]}]" for name in campaign.names]
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow([*head, *(name + WORD_ENDING for name in coded)])
        places = [campaign.names.index(name) for name in coded]
        for start in range(0, campaign.rows.shape[0], ROWS_AT_ONCE):
            part = slice(start, start + ROWS_AT_ONCE)
            rows = np.asarray(campaign.rows[part])
            for row in rows[campaign.done[part][: rows.shape[0]]].tolist():
                words = [word(name, row[place]) for name, place in zip(coded, places, strict=True)]
                writer.writerow([int(row[0]), *row[1:], *words])


def write_parquet(campaign: Campaign, path: Path) -> None:
    """The scenes that are done; units are in the metadata of the columns."""
    import pyarrow.parquet

    pyarrow.parquet.write_table(arrow_table(campaign), path)


def arrow_table(campaign: Campaign) -> pyarrow.Table:
    """The frame with the units in the metadata of its fields and the resolved input in that of the table."""
    import pyarrow

    plain = campaign.to_dataframe()
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


def write_netcdf(campaign: Campaign, path: Path) -> None:
    """A NetCDF-4 file over the varied keys of a grid, or over the scene; not a number where not done."""
    _write_dataset(campaign.to_xarray(), path)


def write_series(result: Result, path: Path, names: Sequence[str], stride: int) -> None:
    """A NetCDF-4 file over time, or over the rows; the extreme rows stand where their times are."""
    data = result.to_xarray()
    along = next(iter(data.sizes))
    kept = [name for name in names if name in data.data_vars]
    _write_dataset(data[kept].isel({along: slice(None, None, stride)}), path)


def _write_dataset(data: xarray.Dataset, path: Path) -> None:
    encoding = {name: {"zlib": True, "complevel": 1, "_FillValue": np.nan} for name in data.data_vars}
    data.to_netcdf(path, engine="netcdf4", format="NETCDF4", encoding=encoding)


def _texts(result: ResultFile, title: str, units: Mapping[str, str]) -> dict[str, str]:
    source = f"rattle {result.program_version}"
    texts = {f"{name}_unit": unit for name, unit in units.items()}
    return texts | {"title": title, "source": source, "resolved_input": result.input_text}


CAMPAIGN_WRITERS: dict[str, tuple[str, Callable[[Campaign, Path], None]]] = {
    "csv": (".csv", write_csv),
    "parquet": (".parquet", write_parquet),
    "netcdf": (".nc", write_netcdf),
}
SERIES_WRITERS: dict[str, Callable[[Result, Path, Sequence[str], int], None]] = {
    "netcdf": write_series,
}
