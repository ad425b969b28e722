"""Campaigns as CSV, Parquet and NetCDF files."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np

from rattle.campaign import Campaign
from rattle.campaign_tables import WORD_ENDING, arrow_table, dataset
from rattle.codes import CODES, word

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


def write_netcdf(campaign: Campaign, path: Path) -> None:
    """A NetCDF-4 file over the varied keys of a grid, or over the scene; not a number where not done."""
    data = dataset(campaign)
    encoding = {name: {"zlib": True, "complevel": 1, "_FillValue": np.nan} for name in data.data_vars}
    data.to_netcdf(path, engine="netcdf4", format="NETCDF4", encoding=encoding)


WRITERS: dict[str, tuple[str, Callable[[Campaign, Path], None]]] = {
    "csv": (".csv", write_csv),
    "parquet": (".parquet", write_parquet),
    "netcdf": (".nc", write_netcdf),
}
