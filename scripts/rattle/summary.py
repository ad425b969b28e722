"""Summaries of scenes: read one, compare several."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rattle.checksums import checksum
from rattle.namelist import NamelistError, parse

Summary = Mapping[str, Any]
ABSENT = "-"
CHECKSUM_MARK = b"! checksum "


class SummaryError(Exception):
    """A summary that cannot be used, explained in one plain sentence."""


def read_summary(path: str | Path) -> dict[str, Any]:
    """The keys of a ``NAME.summary.nml``; what the run does not know is not in it."""
    path = Path(path)
    try:
        raw = path.read_bytes()
        body, mark, stored = raw.rpartition(CHECKSUM_MARK)
        if mark and stored != b"%d\n" % checksum(body):
            raise SummaryError(f"{path} is damaged: it is not what its checksum says.")
        groups = parse(raw.decode("ascii"))
    except OSError as fault:
        raise SummaryError(f"{path} cannot be read: {fault.strerror or fault}.") from None
    except UnicodeDecodeError:
        raise SummaryError(f"{path} is not a summary: it is not plain text.") from None
    except NamelistError as fault:
        raise SummaryError(f"{path} is not a summary: {fault}") from None
    if "summary" not in groups:
        raise SummaryError(f"{path} is not a summary: it has no group &summary.")
    summary = groups["summary"]
    summary.setdefault("name", path.name.removesuffix(".nml").removesuffix(".summary"))
    return summary


def comparison_table(summaries: Sequence[Summary]) -> list[list[str]]:
    """Rows of text, a column for each scene; the first row holds the scene names."""
    rows = [["", *(str(summary["name"]).strip() for summary in summaries)]]
    for label, show in _ROWS:
        rows.append([label, *(_cell(show, summary) for summary in summaries)])
    return rows


def _cell(show: Callable[[Summary], str], summary: Summary) -> str:
    try:
        return show(summary)
    except KeyError:
        return ABSENT
    except (TypeError, ValueError):
        raise SummaryError(f"The summary of {summary['name']} holds a value of a wrong type.") from None


def _text(key: str) -> Callable[[Summary], str]:
    return lambda summary: str(summary[key]).strip()


def _number(key: str, form: str, scale: float = 1.0) -> Callable[[Summary], str]:
    return lambda summary: format(float(summary[key]) * scale, form)


def _range(quantity: str, form: str, scale: float = 1.0) -> Callable[[Summary], str]:
    low, high = _number(f"{quantity}_minimum", form, scale), _number(f"{quantity}_maximum", form, scale)
    return lambda summary: f"{low(summary)} to {high(summary)}"


def _law_fits(summary: Summary) -> str:
    return "no" if summary["law_contradicted"] else "yes"


_ROWS: tuple[tuple[str, Callable[[Summary], str]], ...] = (
    ("status", _text("status")),
    ("film law", _text("law")),
    ("film model", _text("model")),
    ("film thickness [um]", _range("film", ".4f", 1e6)),
    ("acceleration [m/s2]", _range("acceleration", ".3f")),
    ("lines", _text("line_count")),
    ("harmonic distortion", _number("harmonic_distortion", ".4f")),
    ("irregular fraction", _number("irregular_fraction", ".1e")),
    ("reversals a period", _number("reversals_per_period", "g")),
    ("rattle class", _text("rattle_class")),
    ("class stands", _text("certificate")),
    ("error of the film", _number("film_error", ".1e")),
    ("motion", _text("orbit_stability")),
    ("film regime", _text("film_regime")),
    ("law fits", _law_fits),
    ("largest alpha p", _number("alpha_p_maximum", ".3g")),
    ("natural frequency [Hz]", _number("natural_frequency", ".1f")),
    ("damping ratio", _number("damping_ratio", ".4f")),
    ("steady film [um]", _number("steady_film", ".4f", 1e6)),
)
