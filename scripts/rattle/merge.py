"""Joins the parts of a campaign, or of thresholds, into the file that an undivided run writes, byte for byte.

A part of a campaign holds whole chunks, so the chunks of the whole are those of its parts one after another,
and their checksums stay as they are. A part of thresholds holds whole lines, each one row or more; the
checksums of the whole are made anew.
"""

from __future__ import annotations

import os
import re
import secrets
import shutil
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rattle.campaign_plan import Plan, read_plan
from rattle.campaign_result import SCENE, Campaign, read_campaign
from rattle.checksums import checksum
from rattle.command import CommandError
from rattle.counts import counted
from rattle.result import Result, read
from rattle.result_header import (
    CAMPAIGN,
    COLUMN_PART,
    SERIES,
    ChunkTable,
    Seal,
    header_bytes_of,
    series_chunk_rows,
)

PART_KEY = re.compile(r"^(\s*parts?\s*=\s*)\d+")
GROUP = re.compile(r"^\s*&(\w+)")
COPY_BYTES = 1 << 22

Part = Campaign | Result


def merge(paths: Sequence[Path], output: Path) -> str:
    """Join the parts into `output` and return how many scenes or traces it has, as in '300 scenes'.

    Raises CommandError, with a sentence for each fault, before anything is written.
    """
    parts = [_opened(path) for path in paths]
    for part in parts:
        if output.exists() and output.samefile(part.path):
            raise CommandError(f"{output} is one of the parts itself; give another --output.")
    # Where there are more parts than chunks, some hold no scene.
    holding = [part for part in parts if part.row_count > 0]
    faults = _unfinished(parts) or _differing(parts) or _disordered(holding) + _lacking(parts)
    if faults:
        raise CommandError("the parts cannot be joined:\n  " + "\n  ".join(faults))
    parts = sorted(holding, key=_first)
    _write(parts, output)
    return f"{_last(parts[-1])} {_counted(parts[-1])}s"


def whole_input(text: str) -> str:
    """The resolved input of the undivided run: that of a part, made part 1 of 1."""
    lines, group = [], ""
    for line in text.splitlines(keepends=True):
        begun = GROUP.match(line)
        if begun:
            group = begun[1].lower()
        lines.append(PART_KEY.sub(r"\g<1>1", line) if group == "campaign" else line)
    return "".join(lines)


def _opened(path: Path) -> Part:
    part = read(path)
    return part if part.task == "threshold" else read_campaign(path)


def _counted(part: Part) -> str:
    """What the numbers in the first column count: scenes of a campaign, traces of thresholds."""
    return part.names[0]


def _plan(part: Part) -> Plan:
    return read_plan(part.input_text)


def _unfinished(parts: Sequence[Part]) -> list[str]:
    faults = []
    for part in parts:
        if not part.closed:
            done, count = int(part.header.chunks.done.sum()), part.header.chunks.checksums.size
            faults.append(
                f"{part.path} is not finished: {done} of its {counted(count, 'chunk')} are done; "
                "rattle --resume goes on."
            )
    if not faults and not any(part.row_count for part in parts):
        faults.append(f"none of them holds a {_counted(parts[0])}.")
    return faults


def _differing(parts: Sequence[Part]) -> list[str]:
    faults = []
    first = parts[0]
    for part in parts[1:]:
        pair = f"{part.path} and {first.path}"
        if part.program_version != first.program_version:
            faults.append(
                f"{pair} were written by different versions of rattle: "
                f"{part.program_version} and {first.program_version}."
            )
        if part.header.names != first.header.names or part.header.units != first.header.units:
            faults.append(f"{pair} hold different columns.")
        elif whole_input(part.input_text) != whole_input(first.input_text):
            faults.append(f"{pair} come from different inputs: {_difference(part, first)}.")
        elif part.header.source_checksum != first.header.source_checksum:
            faults.append(
                f"{pair} come from different {_counted(part)}s: their CSV file has changed in between."
            )
        divisions = [_plan(one).parts for one in (part, first)]
        if divisions[0] != divisions[1]:
            faults.append(
                f"{pair} belong to different divisions: into {divisions[0]} and {divisions[1]} parts."
            )
        sizes = [one.header.chunks.chunk_rows for one in (part, first)]
        if sizes[0] != sizes[1] and _counted(part) == SCENE:
            faults.append(f"{pair} have chunks of different size: {sizes[0]} and {sizes[1]} rows.")
    return faults


def _difference(part: Part, other: Part) -> str:
    """The first key in which two inputs differ."""
    groups = [*part.input, *(group for group in other.input if group not in part.input)]
    for group in groups:
        mine, theirs = part.input.get(group, {}), other.input.get(group, {})
        for key in [*mine, *(key for key in theirs if key not in mine)]:
            if (group, key) in (("campaign", "part"), ("campaign", "parts")):
                continue
            if mine.get(key) != theirs.get(key):
                return (
                    f"{group}.{key} is {_shown(mine.get(key))} in one, {_shown(theirs.get(key))} in the other"
                )
    return "their texts are not the same"


def _shown(value: object) -> str:
    return "absent" if value is None else str(value)


def _disordered(parts: Sequence[Part]) -> list[str]:
    """Gaps, overlaps, scenes or traces out of order, parts of a campaign that do not begin with a chunk."""
    what = _counted(parts[0]) + "s"
    faults = [
        f"{part.path} is damaged: its {what} are not in order." for part in parts if not _in_order(part)
    ]
    if faults:
        return faults
    parts = sorted(parts, key=_first)
    end, before = 0, "the start"
    for part in parts:
        first, last = _first(part), _last(part)
        if first > end + 1:
            faults.append(f"{what} {end + 1} to {first - 1} are missing between {before} and {part.path}.")
        elif first <= end:
            faults.append(f"{what} {first} to {min(end, last)} of {part.path} are also in {before}.")
        if what == f"{SCENE}s" and (first - 1) % part.header.chunks.chunk_rows != 0:
            faults.append(f"{part.path} does not begin with a chunk, so its checksums cannot be kept.")
        if last > end:
            end, before = last, str(part.path)
    count = _plan(parts[-1]).scene_count
    if count is not None and end != count:
        faults.append(
            f"{what} {end + 1} to {count} are missing after {before}."
            if end < count
            else f"{before} holds {what} up to {end}, but there are {count}."
        )
    return faults


def _in_order(part: Part) -> bool:
    """A trace may have several rows; a scene that comes twice leaves a gap at the end."""
    return bool(np.isin(np.diff(part[_counted(part)]), (0, 1)).all())


def _lacking(parts: Sequence[Part]) -> list[str]:
    """Parts of the division that are not given."""
    held, count = {_plan(part).part for part in parts}, _plan(parts[0]).parts
    lacking = [str(number) for number in range(1, count + 1) if number not in held]
    return [f"of {count} parts these are not given: {', '.join(lacking)}."] if lacking else []


def _first(part: Part) -> int:
    return int(part[_counted(part)][0])


def _last(part: Part) -> int:
    return int(part[_counted(part)][-1])


def _write(parts: Sequence[Part], output: Path) -> None:
    """Write beside the output first, so that a full disk or a kill leaves no half file under its name.

    The name beside it is one that no file has: whatever stands there is not ours.
    """
    unfinished = output.with_name(f"{output.name}.{secrets.token_hex(8)}.unfinished")
    with unfinished.open("xb") as target:
        try:
            target.write(_head(parts))
            for part in parts:
                with part.path.open("rb") as source:
                    source.seek(part.header.header_bytes)
                    shutil.copyfileobj(source, target, COPY_BYTES)
            target.flush()
            os.fsync(target.fileno())
            os.replace(unfinished, output)
        except BaseException:
            unfinished.unlink(missing_ok=True)
            raise


def _head(parts: Sequence[Part]) -> bytes:
    """Header and chunk table of the whole."""
    header = parts[0].header
    text = _text_as_stored(parts[0])
    chunks, seal = _chunks(parts)
    columns = b"".join(
        COLUMN_PART.pack(name.encode().ljust(32), unit.encode().ljust(16))
        for name, unit in zip(header.names, header.units, strict=True)
    )
    return header_bytes_of(
        columns,
        text,
        column_count=len(header.names),
        program_version=header.program_version.encode().ljust(24),
        row_count=chunks.row_limit,
        source_checksum=header.source_checksum,
        chunks=chunks,
        seal=seal,
    )


def _chunks(parts: Sequence[Part]) -> tuple[ChunkTable, Seal]:
    """The checksums of the whole."""
    tables = [part.header.chunks for part in parts]
    count = sum(part.row_count for part in parts)
    if tables[0].kind == CAMPAIGN:
        sums = np.concatenate([table.checksums for table in tables])
        return ChunkTable(CAMPAIGN, tables[0].chunk_rows, count, sums), Seal()
    rows = np.concatenate([np.column_stack([part[name] for name in part.names]) for part in parts])
    size = series_chunk_rows(rows.shape[1], count)
    chunks = [rows[start : start + size] for start in range(0, count, size)]
    sums = np.array([checksum(chunk) if len(chunk) == size else 0 for chunk in chunks])
    rest = 0 if len(chunks[-1]) == size else checksum(chunks[-1])
    return ChunkTable(SERIES, size, count, sums), Seal(rows=count, rest_checksum=rest)


def _text_as_stored(part: Part) -> bytes:
    """The resolved input with the blanks that may end it, as that of the whole."""
    with part.path.open("rb") as stream:
        stream.seek(part.header.input_start)
        return whole_input(stream.read(part.header.input_bytes).decode("ascii")).encode("ascii")
