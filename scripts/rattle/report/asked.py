"""What was asked of the program: the resolved input, key by key, and as text that repeats the run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any
from urllib.parse import quote

from rattle.campaign_result import Axis, Campaign
from rattle.keys import key_table
from rattle.report import page
from rattle.result import Result
from rattle.result_file import ResultFile
from rattle.thresholds import thresholds

# What matters most of a scene, in the order in which it is reported.
IN_SHORT = (
    ("load", "mass", "mass of the tooth pair"),
    ("load", "steady_force", "steady force"),
    ("load", "force_mean", "mean of the force beside it"),
    ("load", "force_amplitude", "amplitude of the oscillating force"),
    ("load", "force_amplitudes", "amplitudes of the oscillating force"),
    ("load", "frequency", "its frequency"),
    ("lubricant", "viscosity", "viscosity of the oil"),
    ("kinematics", "entrainment_speed", "speed at which the flanks draw oil in"),
    ("contact", "radius", "radius of the contact"),
    ("contact", "length", "its length"),
    ("contact", "backlash", "backlash between the flanks"),
    ("contact", "stiffness", "stiffness of the teeth"),
)
# Of a scene that is described by its gears, and what then follows.
DRIVEN = (
    ("shaft", "speed_rpm", "speed of the shaft"),
    ("oil", "temperature_celsius", "temperature of the oil"),
)
FOLLOWING = ("load", "lubricant", "kinematics", "contact")
MOST_PAIRS = 6  # that the first line names
# What the first line says of a scene without gears, with the words around the value.
OF_SYMBOLS = (
    ("load", "steady_force", "steady force {}"),
    ("load", "force_amplitude", "amplitude {}"),
    ("load", "force_amplitudes", "amplitudes {}"),
    ("load", "frequency", "at {}"),
    ("lubricant", "viscosity", "oil of {}"),
    ("kinematics", "entrainment_speed", "drawn in at {}"),
)


def in_short(result: ResultFile) -> str:
    """The few values that a scene is known by; those that a task varies are not among them."""
    known = key_table()
    varied = {name.rpartition(".")[2] for name in result.names if "." in name}
    if result.task == "sweep":
        varied.add(result.names[0])
    if result.task == "threshold":
        varied.add(str(result.value("threshold", "key")).strip().rpartition(".")[2])
    parts = pairs(result)
    results: list[str] = []
    for group, name, words in (*DRIVEN, *IN_SHORT):
        given = result.input.get(group, {}).get(name)
        if given is None or name in varied:
            continue
        unit = known[group, name].unit if (group, name) in known else ""
        numbers = given if isinstance(given, list) else [given]
        follows = parts and "gear" in result.input and group in FOLLOWING
        sentence = f"{words} {', '.join(page.plain(number, unit) for number in numbers)}"
        (results if follows else parts).append(sentence)
    film = result.input.get("film", {})
    law = " ".join(str(film[name]).strip() for name in ("model", "law") if name in film)
    if law:
        parts.append(f"film by the {law.replace('reynolds', 'Reynolds')} law")
    asked = f"Asked: {'; '.join(parts)}. " if parts else ""
    made = f"This makes: {'; '.join(results)}. " if results else ""
    return f"{asked}{made}All inputs stand below."


def operating_point(result: ResultFile, gears: Sequence[Mapping[str, Any]] | None = None) -> str:
    """The first line of a page: speed, oil and teeth; without gears the force and the oil.

    `gears`: all pairs of a gearbox, of which the result is one.
    """
    spans = varied_ranges(result)

    def value(group: str, name: str) -> str:
        if f"{group}.{name}" in spans:
            first, last, unit = spans[f"{group}.{name}"]
            return f"{page.plain(first, '', 4)} to {page.plain(last, unit, 4)}"
        given = result.input.get(group, {}).get(name)
        if given is None:
            return ""
        key = key_table().get((group, name))
        unit = key.unit if key else result.derived_units.get((group, name), "")
        *others, last = given if isinstance(given, list) else [given]
        return ", ".join([*(page.plain(one, "", 4) for one in others), page.plain(last, unit, 4)])

    if "gear" not in result.input:
        parts = [words.format(said) for group, name, words in OF_SYMBOLS if (said := value(group, name))]
        sentence = ", ".join(parts).replace(", at ", " at ")
        return f"{sentence[:1].upper()}{sentence[1:]}."
    speed, oil = value("shaft", "speed_rpm"), value("oil", "temperature_celsius")
    grade = [value("oil", f"viscosity_{at}_cst") for at in (40, 100)]
    parts = [f"at {speed}"] if speed else []
    parts += [f"oil {oil}"] if oil else []
    if all(grade):
        parts[-1] += f" ({grade[0].removesuffix(' mm2/s')} and {grade[1]} at 40 and 100 \N{DEGREE SIGN}C)"
    gears = gears or [keys for group, keys in result.input.items() if group.partition("(")[0] == "gear"]
    teeth = [f"{str(keys.get('name', '')).strip()} {keys['teeth_1']}/{keys['teeth_2']}" for keys in gears]
    named = f"{', '.join(map(str.strip, teeth))} teeth"
    parts.append(named if len(gears) <= MOST_PAIRS else f"{len(gears)} gear pairs")
    sentence = ", ".join(parts).replace("mm2/s", "mm\N{SUPERSCRIPT TWO}/s")
    return f"{sentence[:1].upper()}{sentence[1:]}."


def varied_ranges(result: ResultFile) -> dict[str, tuple[float, float, str]]:
    """First and last value of what a task varies, with the unit, by group.key."""
    if isinstance(result, Campaign):
        axes = [axis for axis in result.axes if axis.values.size]
    elif isinstance(result, Result) and result.task == "threshold":
        found = thresholds(result)
        axes = [found.range, *found.axes]
    elif result.task == "sweep":
        key, values = str(result.value("sweep", "key")).strip(), result[result.names[0]]
        group = next((group for group, name in key_table() if name == key), "")
        axes = [Axis(f"{group}.{key}", result.units[result.names[0]], "", values)]
    else:
        axes = []
    return {
        axis.key: (float(axis.values.min()), float(axis.values.max()), axis.unit)
        for axis in axes
        if axis.values.size
    }


def pairs(result: ResultFile) -> list[str]:
    """Each gear pair by its teeth and module."""
    gears = [keys for group, keys in result.input.items() if group.partition("(")[0] == "gear"]
    words = "{name} ({teeth_1} teeth drive {teeth_2}, module {module:g} mm)"
    names = [
        words.format(**{"name": "gear"} | keys, module=1e3 * keys["normal_module"]).strip() for keys in gears
    ]
    return [f"gear pair{'s' * (len(names) > 1)} {', '.join(names)}"] if names else []


def inputs(result: ResultFile) -> list[str]:
    """A table of the resolved input with units and meanings."""
    known = key_table()
    rows: list[list[str]] = []
    for group, keys in result.input.items():
        rows.append([page.code(f"&{group}")])
        for name, given in keys.items():
            key = known.get((group.partition("(")[0], name))
            unit = key.unit if key else result.derived_units.get((group, name), "")
            meaning = key.meaning if key else "Follows from gears, shaft and oil."
            rows.append([page.code(name), page.value(given, unit), meaning.replace("`", "")])
    return [
        page.paragraph("Every value that the run used, also those that were left at their defaults.", "note"),
        page.table(("Key", "Value", "Meaning"), rows, kinds=("", "number", "meaning"), kind="explained"),
    ]


def repeat(result: ResultFile, name: str) -> list[str]:
    """The input as text, and how to run it again."""
    file = f"{name}.nml"
    text = result.input_text.rstrip() + "\n"
    link = (
        f'<p class="screen"><a download="{escape(file)}" '
        f'href="data:text/plain;charset=utf-8,{quote(text)}">Save as {escape(file)}</a></p>'
    )
    how = f"This text, saved as {file}, repeats the run with: rattle {file}"
    parts = [page.paragraph(how), link, f'<pre class="input">{escape(text)}</pre>']
    if "csv" in result.input.get("campaign", {}):
        csv = str(result.input["campaign"]["csv"]).strip()
        parts.insert(
            1, page.paragraph(f"It needs the table of scenes {csv}, which is not part of this page.")
        )
    return parts
