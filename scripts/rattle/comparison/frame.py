"""Comparisons as tables for other programs: a pandas DataFrame, or rows of a CSV file."""

from __future__ import annotations

import csv
import itertools
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rattle.comparison.answers import answer_differences
from rattle.comparison.inputs import input_differences
from rattle.comparison.rows import Compared, compared_rows
from rattle.comparison.variant import Given, Variant, variants_of
from rattle.optional import needed

if TYPE_CHECKING:
    import pandas

HEAD = ("variant", "gear", "part", "name", "unit", "base", "value", "base_error", "error")
CHANGES = ("change", "percent", "decibel", "same")


def variants(given: Mapping[str, Given]) -> pandas.DataFrame:
    """What differs between a base and variants of it, as a pandas DataFrame.

    Parameters
    ----------
    given
        By name, the first the base: what `run`, `campaign`, `sweep` or `threshold` returned, a result, or
        the path of a result or summary (of a gearbox NAME.summary.nml, or a list of the paths of its
        pairs).

    Returns
    -------
    frame
        Of motions a row for each key of the input that differs and for each quantity of the answer, by
        `variant`, `gear` (empty: all alike) and `part` ('input', 'follows', 'answer', 'together'): values
        and their stated errors, `change`, `percent`, `decibel`, and `same`, whether the two differ by no
        more than the errors. Of campaigns, sweeps and thresholds a row for each variant and set of values
        of the keys that both have, with each quantity of base (NAME_base) and variant (NAME), and whether
        they are the same (NAME_same).

    Raises
    ------
    CommandError
        The results cannot be compared; one plain sentence.
    """
    pandas = needed("pandas")
    base, *others = variants_of(given)
    if base.task == "motion":
        frame = pandas.DataFrame([row for other in others for row in motion_rows(base, other)])
        return frame.reindex(columns=[*HEAD, *CHANGES])
    return pandas.concat(
        [pandas.DataFrame(columns_of(compared_rows(base, other))) for other in others], ignore_index=True
    )


def write_csv(path: Path, sides: Sequence[Variant]) -> None:
    """The same rows as a CSV file; numbers read back as the same float64."""
    base, *others = sides
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        if base.task == "motion":
            writer.writerow((*HEAD, *CHANGES))
            for other in others:
                writer.writerows(map(_cell, row.values()) for row in motion_rows(base, other))
            return
        parts = [columns_of(compared_rows(base, other)) for other in others]
        head = list(dict.fromkeys(name for columns in parts for name in columns))
        writer.writerow(head)
        for columns in parts:
            nothing = itertools.repeat("", columns["variant"].size)
            rows = zip(*(columns.get(name, nothing) for name in head), strict=True)
            writer.writerows(map(_cell, row) for row in rows)


def motion_rows(base: Variant, other: Variant) -> Iterator[dict[str, Any]]:
    """What differs in the inputs, and all of the answer, a dict for each."""
    for entry in (*input_differences(base, other), *answer_differences(base, other)):
        yield {name: getattr(entry, name) for name in HEAD} | {name: getattr(entry, name) for name in CHANGES}


def columns_of(compared: Compared) -> dict[str, np.ndarray]:
    """Keys and quantities of both, a row for each set of values of the keys."""
    first = compared.rows[0]
    columns: dict[str, np.ndarray] = {"variant": np.full(first.size, compared.other.name, dtype=object)}
    columns |= {key: values[first] for key, values in compared.base.keys.items()}
    for name in compared.quantities:
        columns[f"{name}_base"], columns[name] = compared.values(name)
        columns[f"{name}_same"] = ~compared.differs(name)
    return columns


def _cell(value: Any) -> Any:
    if isinstance(value, list):
        return " ".join(map(str, value))
    if isinstance(value, float | np.floating):
        return repr(float(value)) if np.isfinite(value) else ""
    return value
