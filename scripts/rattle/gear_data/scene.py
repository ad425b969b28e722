"""Groups &gear, &shaft and &oil of gear data: joined, written with comments, checked by the program."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rattle import solver_process
from rattle.faults import InputWarning, read_faults
from rattle.gear_data import GROUPS, GearDataError, Given
from rattle.gear_data.drawing import along_normal, read_drawing
from rattle.gear_data.rexs import ENDINGS, PACKED, read_rexs
from rattle.keys import Key, key_table
from rattle.solve import BAD_INPUT, find_program, literal

REQUIRED = "required"
WARNING = "! warning: "


@dataclass(frozen=True)
class Scene:
    """Namelist text, and the sentences on keys that it still needs."""

    text: str
    missing: tuple[str, ...]
    odd: tuple[str, ...]


def read(paths: Sequence[Path], loose: Sequence[str] = ()) -> Scene:
    """The scene that some files describe together: pairs of one name are one pair.

    Raises GearDataError with each fault and its place; the program's own words where it refuses a value.
    """
    found: list[Given] = []
    for path in paths:
        if path.suffix.lower() in PACKED:
            raise GearDataError(f"{path}: of REXS files the XML form is read (.rexs); save it as such.")
        found += read_rexs(path, loose) if path.suffix.lower() in ENDINGS else read_drawing(path)
    given = along_normal(_with_pairs(found))
    values: dict[tuple[str, str, str], Given] = {}
    for one in given:
        other = values.setdefault((one.pair, one.group, one.key), one)
        if other.value != one.value:
            raise GearDataError(f"{one.place}: {one.words}, but {other.place} has {other.words}.")
    return _checked(values, [path.name for path in paths])


def _with_pairs(found: Sequence[Given]) -> list[Given]:
    """Values of a pair without a name are those of the only one that has a name."""
    names = list(dict.fromkeys(one.pair for one in found if one.group == "gear" and one.pair))
    unnamed = [one for one in found if one.group == "gear" and not one.pair]
    if unnamed and len(names) > 1:
        raise GearDataError(
            f"{unnamed[0].place}: {unnamed[0].words}: of which pair, {', '.join(names)}? Its name belongs "
            "above the column."
        )
    only = names[0] if names else ""
    return [
        Given(only, one.group, one.key, one.value, one.place, one.words) if one in unnamed else one
        for one in found
    ]


def _checked(values: dict[tuple[str, str, str], Given], sources: Sequence[str]) -> Scene:
    """The text of the groups, with a commented line for each required key that nothing gives."""
    pairs = list(dict.fromkeys(pair for pair, group, _ in values if group == "gear"))
    if not pairs:
        raise GearDataError(f"{', '.join(sources)}: nothing of a gear pair is in there.")
    missing: list[str] = []
    lines = [f"! Gear data of {', '.join(sources)}, in SI units; behind each value what the file has."]
    for group in GROUPS:
        for pair in pairs if group == "gear" else [""]:
            lines += ["", f"&{group}"]
            lines += [f"   name = {literal(pair)}"] if pair else []
            for known, rule in key_table().items():
                one = values.get((pair, *known))
                if known[0] != group:
                    continue
                if one is not None:
                    lines.append(f"   {one.key} = {literal(one.value)}   ! {one.words}")
                elif rule.default == REQUIRED and not _replaced(rule, group, values):
                    unit = f" [{rule.unit}]" if rule.unit not in ("", "-") else ""
                    meaning = rule.meaning.partition(". ")[0].rstrip(".") + "."
                    lines.append(f"   ! {known[1]} =    ! required{unit}: {meaning}")
                    missing.append(f"{f'{pair}: ' if pair else ''}&{group} {known[1]}{unit}: {meaning}")
            lines.append("/")
    text = "\n".join(lines) + "\n"
    refused, more, odd = _faults_of(text, values, pairs, missing)
    if refused:
        raise GearDataError("\n".join(refused))
    return Scene(text, tuple([*missing, *more]), tuple(odd))


def _replaced(rule: Key, group: str, values: dict[tuple[str, str, str], Given]) -> bool:
    """Whether a key stands there that this one is not used with."""
    return any(f"no `{group}.{key}`" in rule.used_with for _, _, key in values)


def _faults_of(
    text: str,
    values: dict[tuple[str, str, str], Given],
    pairs: Sequence[str],
    missing: Sequence[str],
) -> tuple[list[str], list[str], list[str]]:
    """What the program refuses of the values, at their places; what else it needs; what is odd."""
    ended = solver_process.solve([find_program(), "--check", "--", "-"], [], text)
    if ended.returncode not in (0, BAD_INPUT):
        raise GearDataError(f"the program cannot check it: {ended.stderr.strip()}")
    pair_of = _pairs_of_lines(text, pairs)
    refused, more, odd = [], [], []
    for line in ended.stdout.splitlines():
        if line.startswith(WARNING):
            fault = InputWarning(line.removeprefix(WARNING)).fault
            one = values.get((pair_of.get(fault.line or 0, ""), fault.group or "", fault.key or ""))
            odd.append(f"{one.place}: {one.words}: {fault.message}" if one else fault.message)
    for fault in read_faults(ended.stderr):
        pair = pair_of.get(fault.line or 0, "")
        one = values.get((pair, fault.group or "", fault.key or ""))
        named = [known for known in missing if f"&{fault.group} {fault.key}" in known]
        if one is not None and fault.line:
            refused.append(f"{one.place}: {one.words}: {fault.message}")
        elif fault.group in GROUPS and fault.key and not named:
            words = f"&{fault.group} {fault.key}: {fault.message}"
            more += [words] if words not in more else []
    return refused, more, odd


def _pairs_of_lines(text: str, pairs: Sequence[str]) -> dict[int, str]:
    """The pair whose group a line of the text belongs to."""
    found, at, inside = {}, -1, False
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("&"):
            inside = line == "&gear"
            at += inside
        if inside:
            found[number] = pairs[at]
    return found
