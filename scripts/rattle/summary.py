"""Summaries of scenes: read one, compare several."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rattle.checksums import checksum
from rattle.codes import QUANTITIES, spoken
from rattle.namelist import NamelistError, parse
from rattle.result_header import checksum_of_head
from rattle.rounding import stated_error

Summary = Mapping[str, Any]
# Words, with the unit, and what shows the number of a summary.
Row = tuple[str, Callable[[Summary], str]]
ABSENT = "-"
FILM_DIGITS = 5
CHECKSUM_MARK = b"! checksum "
ENDING = ".summary.nml"
# Keys that hold the checksum of a result, and how the name of that result ends.
RESULTS = {
    "result_checksum": ".rattle",
    "profiles_checksum": ".profiles.rattle",
    "motions_checksum": ".motions.rattle",
}
DIFFERENT = "one of the two is of another run, or damaged; rattle --overwrite writes both anew"


class SummaryError(Exception):
    """A summary that cannot be used, explained in one plain sentence."""


def read_summary(path: str | Path) -> dict[str, Any]:
    """Read a ``NAME.summary.nml``.

    That of a gearbox has the rows of its table as `gears`: the keys of each pair by its name.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    summary
        Its keys, SI units; what the run does not know is not in it.

    Raises
    ------
    SummaryError
        The file is absent, damaged or no summary, or does not belong to the results beside it: a run was
        killed between the two, or files were moved.

    Examples
    --------
    >>> solved = rattle.run("input/idle.nml", folder=folder)
    >>> rattle.read_summary(folder / "idle.summary.nml") == solved.summary
    True
    """
    path = Path(path)
    try:
        raw = path.read_bytes()
        body, mark, stored = raw.rpartition(CHECKSUM_MARK)
        if mark and stored != b"%d\n" % checksum(body):
            raise SummaryError(f"{path} is damaged: it is not what its checksum says.")
        groups = parse(raw.decode("utf-8"))
    except OSError as fault:
        raise SummaryError(f"{path} cannot be read: {fault.strerror or fault}.") from None
    except UnicodeDecodeError:
        raise SummaryError(f"{path} is not a summary: it is not plain text.") from None
    except NamelistError as fault:
        raise SummaryError(f"{path} is not a summary: {fault}") from None
    if "summary" not in groups:
        raise SummaryError(f"{path} is not a summary: it has no group &summary.")
    summary = groups["summary"]
    pairs = [keys for name, keys in groups.items() if name == "pair" or name.startswith("pair(")]
    if pairs:
        summary["gears"] = {str(keys.pop("gear")).strip(): keys for keys in pairs}
    summary.setdefault("name", path.name.removesuffix(".nml").removesuffix(".summary"))
    _check_results(path, summary)
    return summary


def _check_results(path: Path, summary: Summary) -> None:
    """Refuse a summary beside which the results of another run stand; one that stands alone is read."""
    stem = path.name.removesuffix(ENDING)
    for key, ending in RESULTS.items():
        result = path.with_name(stem + ending)
        if key in summary and result.exists() and checksum_of_head(result) != summary[key]:
            why = "its run left no result" if summary[key] == 0 else DIFFERENT
            raise SummaryError(f"{path} does not belong to {result} beside it: {why}.")
    for gear, pair in summary.get("gears", {}).items():
        other = path.with_name(f"{stem}.{gear}{ENDING}")
        if "summary_checksum" not in pair or not other.exists():
            continue
        if other.read_bytes().rpartition(CHECKSUM_MARK)[2] != b"%d\n" % pair["summary_checksum"]:
            raise SummaryError(f"{path} does not belong to {other} beside it: {DIFFERENT}.")


def input_warnings(summary: Summary) -> list[str]:
    """What the program found odd about the input."""
    found = summary.get("input_warnings", [])
    return [found] if isinstance(found, str) else list(found)


def comparison_table(summaries: Sequence[Summary]) -> list[list[str]]:
    """Rows of text, a column for each scene; the first row holds the scene names, and no row is empty."""
    rows = [["", *(str(summary["name"]).strip() for summary in summaries)]]
    for label, show in _ROWS:
        cells = [_cell(show, summary) for summary in summaries]
        if any(cell != ABSENT for cell in cells):
            rows.append([label, *cells])
    return rows


def _cell(show: Callable[[Summary], str], summary: Summary) -> str:
    try:
        return show(summary)
    except KeyError:
        return ABSENT
    except (TypeError, ValueError):
        raise SummaryError(f"The summary of {summary['name']} holds a value of a wrong type.") from None


def _text(label: str, key: str) -> Row:
    return label, lambda summary: spoken(str(summary[key]).strip())


def _number(label: str, quantity: str, form: str) -> Row:
    unit, scale = _shown_unit(quantity)
    return label + unit, lambda summary: format(float(summary[quantity]) * scale, form)


def _range(label: str, quantity: str, form: str) -> Row:
    (label, low), (_, high) = (_number(label, f"{quantity}_{end}", form) for end in ("minimum", "maximum"))
    return label, lambda summary: f"{low(summary)} to {high(summary)}"


def _bound(summary: Summary) -> str:
    """What stands before the number of harmonics where there may be more of them."""
    return "at least " if "harmonic_count_is_bound" in summary and summary["harmonic_count_is_bound"] else ""


def _flag(label: str, quantity: str, when_set: str, otherwise: str) -> Row:
    return label, lambda summary: when_set if summary[quantity] else otherwise


def _impacts(summary: Summary) -> str:
    """By flank, where there are two."""
    drive, coast = (summary.get(f"impacts_per_period_{flank}") for flank in ("drive", "coast"))
    if drive is None:
        return ABSENT
    return f"{drive:.3g}" if coast is None else f"{drive:.3g} drive, {coast:.3g} coast"


def _rigid_teeth_fit(summary: Summary) -> str:
    """Of elastic teeth, which leave a gap of their own, nothing is said."""
    if "gear_position_minimum" in summary:
        return ABSENT
    return "no" if summary["stiffness_matters"] else "yes"


def _shown_unit(quantity: str) -> tuple[str, float]:
    """The unit of the table of quantities, lengths in micrometres."""
    unit = QUANTITIES[quantity].unit
    return {"m": (" [um]", 1e6), "-": ("", 1.0)}.get(unit, (f" [{unit}]", 1.0))


_ROWS: tuple[Row, ...] = (
    _text("verdict", "verdict"),
    _flag("verification of the verdict", "verdict_verified", "numerically verified", "uncertain"),
    _text("class", "rattle_class"),
    (
        "verification of the class",
        lambda summary: str(summary["verification"]).strip().replace("verified", "numerically verified"),
    ),
    _number("film force rms", "film_force_rms", ".4g"),
    _number("largest load", "load_maximum", ".4g"),
    ("impacts a period", _impacts),
    _number("motions found", "motions", "g"),
    _text("status", "status"),
    _text("film law", "law"),
    _text("film model", "model"),
    _range("film thickness", "film", f"#.{FILM_DIGITS}g"),
    _range("coast film", "coast_film", f"#.{FILM_DIGITS}g"),
    _range("acceleration", "acceleration", ".3f"),
    _number("acceleration rms", "acceleration_rms", ".3f"),
    _number("dissipated power", "dissipated_power", ".4g"),
    ("harmonics", lambda summary: f"{_bound(summary)}{summary['harmonic_count']}"),
    _number("harmonic distortion", "harmonic_distortion", ".4f"),
    _number("irregular fraction", "irregular_fraction", ".1e"),
    _number("reversals a period", "reversals_per_period", "g"),
    (
        "error of the film",
        lambda summary: f"{stated_error(float(summary['film_error']), 1.0, FILM_DIGITS):.1e}",
    ),
    _text("motion", "orbit_stability"),
    _text("film regime", "film_regime"),
    _flag("film law fits", "law_contradicted", "no", "yes"),
    ("rigid teeth fit", _rigid_teeth_fit),
    _number("largest alpha p", "alpha_p_maximum", ".3g"),
    _number("natural frequency", "natural_frequency", ".1f"),
    _number("damping ratio", "damping_ratio", ".4f"),
    _number("steady film", "steady_film", ".4f"),
)
