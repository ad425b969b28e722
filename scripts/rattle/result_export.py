"""Results of any task but campaigns as NetCDF and MAT-files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rattle.mat_file import write_mat
from rattle.result import Result


def write_netcdf(result: Result, path: Path, names: Sequence[str], stride: int) -> None:
    """A NetCDF-4 file over time, or over the rows; the extreme rows stand where their times are."""
    data = result.dataset()
    along = next(iter(data.sizes))
    kept = data[[name for name in names if name in data.data_vars]].isel({along: slice(None, None, stride)})
    encoding = {name: {"zlib": True, "complevel": 1, "_FillValue": np.nan} for name in kept.data_vars}
    kept.to_netcdf(path, engine="netcdf4", format="NETCDF4", encoding=encoding)


def write_matlab(result: Result, path: Path, names: Sequence[str], stride: int) -> None:
    """A MAT-file with a column vector for each column, and its unit as NAME_unit."""
    table = result.table()
    texts = {f"{name}_unit": result.units[name] for name in names}
    texts |= {
        "title": result.scene_name,
        "source": f"rattle {result.program_version}",
        "resolved_input": result.input_text,
    }
    write_mat(path, {name: table[name][::stride] for name in names}, texts)
