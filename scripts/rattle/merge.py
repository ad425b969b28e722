"""Joins the parts of a campaign into the file that an undivided run writes, byte for byte.

A part holds whole chunks, so the chunks of the whole are those of its parts one after another, and their
checksums stay as they are.
"""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rattle.campaign_result import SCENE, Campaign, read_campaign
from rattle.command import CommandError
from rattle.result_header import CAMPAIGN, COLUMN_PART, ChunkTable, header_bytes_of

PART_KEY = re.compile(r"^(\s*parts?\s*=\s*)\d+")
GROUP = re.compile(r"^\s*&(\w+)")
COPY_BYTES = 1 << 22


def merge(paths: Sequence[Path], output: Path) -> int:
    """Join the parts into `output` and return the count of its scenes.

    Raises CommandError, with a sentence for each fault, before anything is written.
    """
    parts = [read_campaign(path) for path in paths]
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
    return sum(part.row_count for part in parts)


def whole_input(text: str) -> str:
    """The resolved input of the undivided run: that of a part, made part 1 of 1."""
    lines, group = [], ""
    for line in text.splitlines(keepends=True):
        begun = GROUP.match(line)
        if begun:
            group = begun[1].lower()
        lines.append(PART_KEY.sub(r"\g<1>1", line) if group == "campaign" else line)
    return "".join(lines)


def _unfinished(parts: Sequence[Campaign]) -> list[str]:
    faults = []
    for part in parts:
        if not part.closed:
            done, count = int(part.chunks.done.sum()), part.chunks.checksums.size
            faults.append(
                f"{part.path} is not finished: {done} of its {count} chunks are done; "
                "rattle --resume goes on."
            )
    if not faults and not any(part.row_count for part in parts):
        faults.append("none of them holds a scene.")
    return faults


def _differing(parts: Sequence[Campaign]) -> list[str]:
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
            faults.append(f"{pair} come from different scenes: their CSV file has changed in between.")
        if part.parts != first.parts:
            faults.append(f"{pair} belong to different divisions: into {part.parts} and {first.parts} parts.")
        if part.chunks.chunk_rows != first.chunks.chunk_rows:
            faults.append(
                f"{pair} have chunks of different size: {part.chunks.chunk_rows} and "
                f"{first.chunks.chunk_rows} rows."
            )
    return faults


def _difference(part: Campaign, other: Campaign) -> str:
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


def _disordered(parts: Sequence[Campaign]) -> list[str]:
    """Gaps, overlaps, scenes out of order, parts that do not end with a chunk."""
    faults = [
        f"{part.path} is damaged: its scenes are not in order."
        for part in parts
        if not np.array_equal(part[SCENE], np.arange(_first(part), _first(part) + part.row_count))
    ]
    if faults:
        return faults
    parts = sorted(parts, key=_first)
    end, before = 0, "the start"
    for part in parts:
        first = _first(part)
        if first > end + 1:
            faults.append(f"scenes {end + 1} to {first - 1} are missing between {before} and {part.path}.")
        elif first <= end:
            last = min(end, first + part.row_count - 1)
            faults.append(f"scenes {first} to {last} of {part.path} are also in {before}.")
        if (first - 1) % part.chunks.chunk_rows != 0:
            faults.append(f"{part.path} does not begin with a chunk, so its checksums cannot be kept.")
        if first + part.row_count - 1 > end:
            end, before = first + part.row_count - 1, str(part.path)
    last = parts[-1]
    if last.scene_count is not None and end != last.scene_count:
        faults.append(
            f"scenes {end + 1} to {last.scene_count} are missing after {before}."
            if end < last.scene_count
            else f"{before} holds scenes up to {end}, but the campaign has {last.scene_count}."
        )
    return faults


def _lacking(parts: Sequence[Campaign]) -> list[str]:
    """Parts of the division that are not given."""
    held = {part.part for part in parts}
    lacking = [str(number) for number in range(1, parts[0].parts + 1) if number not in held]
    return [f"of {parts[0].parts} parts these are not given: {', '.join(lacking)}."] if lacking else []


def _first(part: Campaign) -> int:
    return int(part[SCENE][0])


def _write(parts: Sequence[Campaign], output: Path) -> None:
    """Write beside the output first, so that a full disk or a kill leaves no half file under its name."""
    unfinished = output.with_name(output.name + ".unfinished")
    try:
        with unfinished.open("wb") as target:
            target.write(_head(parts))
            for part in parts:
                with part.path.open("rb") as source:
                    source.seek(part.header.header_bytes)
                    shutil.copyfileobj(source, target, COPY_BYTES)
            target.flush()
            os.fsync(target.fileno())
        os.replace(unfinished, output)
    finally:
        unfinished.unlink(missing_ok=True)


def _head(parts: Sequence[Campaign]) -> bytes:
    """Header and chunk table of the whole."""
    header = parts[0].header
    text = _text_as_stored(parts[0])
    chunks = ChunkTable(
        CAMPAIGN,
        parts[0].chunks.chunk_rows,
        sum(part.row_count for part in parts),
        np.concatenate([part.chunks.checksums for part in parts]),
    )
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
    )


def _text_as_stored(part: Campaign) -> bytes:
    """The resolved input with the blanks that may end it, as that of the whole."""
    with part.path.open("rb") as stream:
        stream.seek(part.header.input_start)
        return whole_input(stream.read(part.header.input_bytes).decode("ascii")).encode("ascii")
