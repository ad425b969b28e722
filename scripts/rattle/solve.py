"""Runs the program from Python: a file, a text or a dict in, its result and its summary out."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
import weakref
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from rattle import faults, solver_process
from rattle.campaign_result import Campaign, read_campaign
from rattle.faults import InputError, RunError, read_faults
from rattle.keys import key_table
from rattle.optional import needed
from rattle.result import Result, read
from rattle.summary import input_warnings, read_summary

if TYPE_CHECKING:
    import pandas
    import xarray

COMPLETE, SCENE_FAILED, BAD_INPUT = 0, 1, 2
_HERE = Path(__file__).resolve().parent
# The program of this repository, of this installation, of this Python.
PROGRAMS = (
    _HERE.parents[1] / "build" / "rattle",
    _HERE.parents[2] / "bin" / "rattle",
    Path(sys.executable).parent / "rattle",
)

NO_LISTS = (bytes, bytearray, memoryview, Mapping, set, frozenset)

Group = Mapping[str, Any]
Input = str | Path | Mapping[str, Group | Sequence[Group]]


class Solved(NamedTuple):
    """What a run left."""

    result: Result | Campaign | None  #: `Campaign` of a campaign; None where no series was asked for
    summary: dict[str, Any]  #: what the summary holds, SI units

    def to_dataframe(self) -> pandas.DataFrame:
        """The summary as a pandas DataFrame of one row; that of the result is `result.to_dataframe()`."""
        return Gearbox({str(self.summary.get("gear", "")).strip(): self}).to_dataframe()

    def to_xarray(self) -> xarray.Dataset:
        """The summary as an xarray Dataset over its one gear pair."""
        return Gearbox({str(self.summary.get("gear", "")).strip(): self}).to_xarray()


class Gearbox(dict[str, Solved]):
    """What each gear pair of an input left, by its name."""

    summary: dict[str, Any] | None = None  #: table of all pairs, None for sweeps

    def to_dataframe(self) -> pandas.DataFrame:
        """The summaries as a pandas DataFrame, a row for each pair."""
        pandas = needed("pandas")
        frame = pandas.DataFrame.from_dict(
            {gear: solved.summary for gear, solved in self.items()}, orient="index"
        )
        return frame.drop(columns="gear", errors="ignore").rename_axis("gear")

    def to_xarray(self) -> xarray.Dataset:
        """The summaries as an xarray Dataset over the pairs."""
        needed("xarray")
        return self.to_dataframe().to_xarray()


class SceneFailed(RunError):
    """The scene did not reach its end.

    Attributes
    ----------
    solved
        What there is of it.
    """

    def __init__(self, solved: Solved) -> None:
        status, words = solved.summary.get("status", "failed"), solved.summary.get("status_text", "")
        super().__init__([], SCENE_FAILED, f"{solved.summary['name']}: {status}. {words}".strip())
        self.solved = solved


@dataclass(frozen=True)
class Range:
    """A varied key of a campaign, from one value to another."""

    first: float  #: in the unit of the key
    last: float  #: in the unit of the key
    count: int | None = None  #: values on a grid; None: a sample has its own number
    scale: str = "linear"  #: or 'logarithmic'

    @property
    def values(self) -> np.ndarray:
        """The points of its grid."""
        if self.count is None:
            raise ValueError("A range beside keys with values needs a count.")
        space = np.geomspace if self.scale == "logarithmic" else np.linspace
        return space(self.first, self.last, self.count)


def run(
    input: Input,
    *,
    set: Mapping[str, Any] | None = None,
    folder: str | Path | None = None,
    overwrite: bool = False,
    resume: bool = False,
    threads: int | None = None,
    program: str | Path | None = None,
) -> Solved | Gearbox:
    """Solve one input and return its result and its summary.

    An interruption from the keyboard is handed to the program, which saves the state that `resume` needs.

    Parameters
    ----------
    input
        A file, namelist text, or a dict of groups of keys, of several &gear as a list.
    set
        Keys with the values that they get instead of those of the input, as 'group.key' or by group; 'gear'
        means all pairs of the input, 'gear(2)' its second.
    folder
        Where the files go; None: a temporary one that lives as long as the result.
    overwrite
        Whether files of an earlier run in `folder` may be replaced.
    resume
        Whether an earlier run in `folder` is carried on.
    threads
        Threads of a campaign, by default all cores.
    program
        The program, by default the one of this installation.

    Returns
    -------
    solved
        Result and summary; of several gear pairs a `Gearbox`, which has them by gear.

    Raises
    ------
    InputError
        Bad input, nothing was run; `faults` names file, line, group and key of each.
    SceneFailed
        A motion that did not reach its end. Sweeps, campaigns and thresholds have a column `status`
        instead, a `Gearbox` has it in its summaries.
    RunError
        Everything else, such as a full disk.

    Warns
    -----
    InputWarning
        What is odd about the input, such as a number that was surely meant in another unit.

    Examples
    --------
    >>> result, summary = rattle.run("input/idle.nml", set={"load.mass": 3.0})
    >>> print(summary["rattle_class"])
    idle
    """
    command = [str(program or find_program())]
    text = text_of(input)
    settings = [f"{key}={literal(value)}" for key, value in _keys_set(set or {})]
    command += ["--overwrite"] if overwrite else []
    command += ["--resume"] if resume else []
    if threads is not None:
        command += ["--threads", str(threads)]
    # From here on what fails must not leave the temporary folder behind.
    place = Path(folder) if folder is not None else Path(tempfile.mkdtemp(prefix="rattle-"))
    # All of the log names each file in a line of its own.
    command += ["--verbose", "--output", os.fspath(place), "--"]
    try:
        ended = solver_process.solve(
            command + ["-" if text is not None else _file(input)], settings, text or ""
        )
        solved = _outcome(ended)
        every = [solved] if isinstance(solved, Solved) else solved.values()
        faults.warn(line for one in every for line in input_warnings(one.summary))
    except BaseException:
        if folder is None:
            shutil.rmtree(place, ignore_errors=True)
        raise
    if folder is None:
        # A gearbox keeps its files until nobody holds it any more.
        held = solved if isinstance(solved, Gearbox) else solved.result
        if held is None:
            shutil.rmtree(place, ignore_errors=True)
        else:
            weakref.finalize(held, shutil.rmtree, place, ignore_errors=True)
    if isinstance(solved, Gearbox):
        return solved
    if ended.returncode == SCENE_FAILED and solved.summary["status"] not in ("complete", "steady"):
        raise SceneFailed(solved)
    return solved


def sweep(
    input: Input,
    key: str | None = None,
    first: float | Range | None = None,
    last: float | None = None,
    *,
    set: Mapping[str, Any] | None = None,
    count: int | None = None,
    spacing: str | None = None,
    turn: bool | None = None,
    **options: Any,
) -> Solved | Gearbox:
    """Follow steady motions along a key; an argument that is None is as the input has it.

    Parameters
    ----------
    input
        A file, namelist text, or a dict of groups of keys, of several &gear as a list.
    key
        The key, as 'load.frequency' or 'frequency'.
    first, last
        Range of the key, in its unit; or a `Range` as `first`, which has ends, count and scale.
    set
        Keys with the values that they get instead of those of the input, as 'group.key' or by group; 'gear'
        means all pairs of the input, 'gear(2)' its second.
    count
        Number of values.
    spacing
        'linear' or 'logarithmic'.
    turn
        Whether the sweep also goes back.
    **options
        Other arguments of `run`: folder, overwrite, resume, threads and program.

    Returns
    -------
    solved
        Result, a row for each value, and summary; of several gear pairs a `Gearbox`.

    Raises
    ------
    InputError
        Bad input, nothing was run; `faults` names file, line, group and key of each.
    RunError
        Everything else, such as a full disk.

    Examples
    --------
    >>> down = rattle.sweep("input/sweep.nml", "frequency", 250.0, 300.0, count=11)
    >>> len(down.result["frequency"])
    21
    """
    first, last, count, spacing = _ends(first, last, count, spacing)
    if key is not None and tuple(key.rpartition(".")[::2]) in key_table():
        key = key.rpartition(".")[2]  # keys that a sweep takes have names of their own
    given = {"key": key, "first": first, "last": last, "count": count, "spacing": spacing, "turn": turn}
    asked = {f"sweep.{name}": value for name, value in given.items() if value is not None}
    return run(input, set={"scene.task": "sweep", **asked, **(set or {})}, **options)


def campaign(
    input: Input,
    vary: Mapping[str, Range | Iterable[float]] | None = None,
    *,
    set: Mapping[str, Any] | None = None,
    record: Sequence[str] | None = None,
    sample: str | None = None,
    size: int | None = None,
    seed: int | None = None,
    **options: Any,
) -> Solved:
    """Solve many motions that differ in some keys; an argument that is None is as the input has it.

    Parameters
    ----------
    input
        A file, namelist text, or a dict of groups of keys, of several &gear as a list.
    vary
        Maps 'group.key' to a `Range` or to values, instead of what the input varies; None: as it has it.
    set
        Keys with the values that they get instead of those of the input, as 'group.key' or by group; 'gear'
        means all pairs of the input, 'gear(2)' its second.
    record
        Names of the quantities that the result has.
    sample
        'grid' for all combinations, 'sobol' for a sample of the ranges.
    size
        Scenes of a sample.
    seed
        Seed of a sample: the same seed gives the same scenes everywhere.
    **options
        Other arguments of `run`: folder, overwrite, resume, threads and program.

    Returns
    -------
    solved
        `Campaign`, a row for each scene, and summary.

    Raises
    ------
    InputError
        Bad input, nothing was run; `faults` names file, line, group and key of each.
    RunError
        Everything else, such as a full disk.

    Examples
    --------
    >>> vary = {
    ...     "load.mass": rattle.Range(2.0, 4.0, 3),
    ...     "kinematics.entrainment_speed": [1.0, 2.0],
    ... }
    >>> solved = rattle.campaign("input/map.nml", vary, record=["rattle_class"])
    >>> solved.result.shape
    (3, 2)
    """
    given = {"record": record, "sample": sample, "size": size, "seed": seed}
    asked = {f"campaign.{name}": value for name, value in given.items() if value is not None}
    settings = {"scene.task": "campaign", **asked, **_varied(vary), **(set or {})}
    # All pairs of an input are rows of one campaign.
    return cast(Solved, run(input, set=settings, **options))


def threshold(
    input: Input,
    key: str | None = None,
    first: float | Range | None = None,
    last: float | None = None,
    *,
    set: Mapping[str, Any] | None = None,
    vary: Mapping[str, Range | Iterable[float]] | None = None,
    criterion: str | None = None,
    level: float | None = None,
    scale: str | None = None,
    count: int | None = None,
    tolerance: float | None = None,
    **options: Any,
) -> Solved:
    """Find where along a key a motion changes, for each scene of `vary`; None: as the input has it.

    Parameters
    ----------
    input
        A file, namelist text, or a dict of groups of keys, of several &gear as a list.
    key
        The key along which is searched, as 'load.force_amplitude'.
    first, last
        Range of the key, in its unit; or a `Range` as `first`, which has ends, count and scale.
    set
        Keys with the values that they get instead of those of the input, as 'group.key' or by group; 'gear'
        means all pairs of the input, 'gear(2)' its second.
    vary
        Maps 'group.key' to a `Range` or to values; None: as the input has it.
    criterion
        What changes: 'class', 'impacts', one class, or the name of a quantity.
    level
        Value of the quantity that is the criterion, in its unit.
    scale
        'linear' or 'logarithmic'.
    count
        Points that are scanned.
    tolerance
        Largest width of a bracket, a share of the range [-].
    **options
        Other arguments of `run`: folder, overwrite, resume, threads and program.

    Returns
    -------
    solved
        Result, a row for each change between `lower` and `upper`, and summary.

    Raises
    ------
    InputError
        Bad input, nothing was run; `faults` names file, line, group and key of each.
    RunError
        Everything else, such as a full disk.
    """
    first, last, count, scale = _ends(first, last, count, scale)
    given = {"key": key, "first": first, "last": last, "criterion": criterion, "level": level, "scale": scale}
    given |= {"count": count, "tolerance": tolerance}
    asked = {f"threshold.{name}": value for name, value in given.items() if value is not None}
    settings = {"scene.task": "threshold", **asked, **_varied(vary), **(set or {})}
    return cast(Solved, run(input, set=settings, **options))


def find_program() -> str:
    """The program: $RATTLE_PROGRAM, that of this repository or installation, else that of the search path."""
    named = os.environ.get("RATTLE_PROGRAM")
    found = named or next(
        (str(path) for path in PROGRAMS if os.access(path, os.X_OK) and path.is_file()), None
    )
    found = found or shutil.which("rattle")
    if found is None:
        raise RunError([], BAD_INPUT, "There is no program rattle: run make, or name it as $RATTLE_PROGRAM.")
    return found


def _ends(
    first: float | Range | None, last: float | None, count: int | None, scale: str | None
) -> tuple[float | None, float | None, int | None, str | None]:
    """First and last value, count and scale, of a `Range` where one is given."""
    if not isinstance(first, Range):
        return first, last, count, scale
    if any(value is not None for value in (last, count, scale)):
        raise TypeError("A Range has its last value, count and scale: leave these arguments out.")
    return first.first, first.last, first.count, first.scale


def _keys_set(given: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Each key that is set, as 'group.key', with its value."""
    for name, value in given.items():
        if "." in name:
            yield name, value
        elif isinstance(value, Mapping):
            yield from ((f"{name}.{key}", own) for key, own in value.items())
        else:
            raise TypeError(
                f"set[{name!r}] has to be a dict of keys: several pairs are 'gear(1)', 'gear(2)', ..."
            )


def _varied(vary: Mapping[str, Range | Iterable[float]] | None) -> dict[str, Any]:
    """Keys of &campaign that vary these."""
    asked: dict[str, Any] = {}
    varied = dict(vary or {})
    if varied:  # instead of those of the input, whose ranges the program then leaves
        asked["campaign.vary"] = list(varied)
        asked["campaign.scale"] = [v.scale if isinstance(v, Range) else "linear" for v in varied.values()]
    if not all(isinstance(values, Range) for values in varied.values()):  # a table of values has no gaps
        varied = {key: v.values if isinstance(v, Range) else v for key, v in varied.items()}
    for place, values in enumerate(varied.values(), 1):
        if isinstance(values, Range):
            parts = {"first": values.first, "last": values.last, "count": values.count}
            asked |= {f"campaign.{name}({place})": part for name, part in parts.items() if part is not None}
        else:
            asked[f"campaign.values(:,{place})"] = list(values)
    return asked


def text_of(given: Input) -> str | None:
    """The namelist text of an input that is no file; None where it is one."""
    if isinstance(given, Mapping):
        text = ""
        for name, groups in given.items():
            for keys in [groups] if isinstance(groups, Mapping) else groups:
                lines = [f"   {key} = {literal(value)}\n" for key, value in keys.items()]
                # The groups of a resolved input are called gear, gear(2), ...
                text += f"&{name.partition('(')[0]}\n{''.join(lines)}/\n"
        return text
    if isinstance(given, str) and ("\n" in given or given.lstrip().startswith("&")):
        return given
    return None


def _file(given: Any) -> str:
    """The path of an input file; a file whose name is a dash is none of the standard input."""
    path = os.fsdecode(os.fspath(given))
    return "./-" if path == "-" else path


def literal(value: Any) -> str:
    """A Python value as a namelist has it."""
    if isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0):
        value = value.item()
    if isinstance(value, bool):
        return ".true." if value else ".false."
    if isinstance(value, str):
        if "\n" in value or "\r" in value:
            raise ValueError(f"{value!r} has more than one line; a text in an input has one")
        quoted = value.replace("'", "''")
        return f"'{quoted}'"
    if isinstance(value, int | float):
        return repr(value)
    # Bytes would come as their numbers, a mapping as its keys, a set in no order.
    if isinstance(value, Iterable) and not isinstance(value, NO_LISTS):
        return ", ".join(map(literal, value))
    raise TypeError(f"{value!r} is not a value that an input can have")


def _outcome(ended: subprocess.CompletedProcess[str]) -> Solved | Gearbox:
    """Result and summary of a run that left them, by the names of files that end its log."""
    if ended.returncode not in (COMPLETE, SCENE_FAILED):
        kind = InputError if ended.returncode == BAD_INPUT else RunError
        raise kind(read_faults(ended.stderr), ended.returncode)
    written = [path for line in ended.stdout.split("\n") for path in _paths(line)]
    summaries = [path for path in written if path.name.endswith(".summary.nml")]
    if not summaries:
        raise RunError(read_faults(ended.stderr), ended.returncode, "The program left no summary.")
    if len(summaries) == 1:
        return _solved(summaries[0], written)
    gearbox = Gearbox()
    for path in summaries:
        solved = _solved(path, written)
        if "gears" in solved.summary:
            gearbox.summary = solved.summary
        else:
            gearbox[str(solved.summary["gear"]).strip()] = solved
    return gearbox


def _paths(line: str) -> list[Path]:
    """Files that a line of a log names: the whole first path, of those beside it their endings alone."""
    first, *endings = re.sub(r"^  (files +)?", "", line).split(", .")
    stem = first.removesuffix(".summary.nml")
    return [Path(first), *(Path(f"{stem}.{ending}") for ending in endings)]


def _solved(summary: Path, written: Sequence[Path]) -> Solved:
    """A summary with the result that stands beside it."""
    name = summary.name.removesuffix(".summary.nml")
    path = summary.with_name(f"{name}.rattle")
    result = None
    if path in written:
        opened = read(path)
        result = read_campaign(path) if opened.task == "campaign" else opened
    return Solved(result, read_summary(summary))
