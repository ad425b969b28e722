"""Running the gear-rattle solver `rattle`; reading, judging and drawing its results."""

from pathlib import Path

from rattle.campaign_result import Campaign, read_campaign
from rattle.comparison.frame import variants
from rattle.faults import Fault, InputError, InputWarning, RunError
from rattle.result import Result, ResultError, read
from rattle.solve import Gearbox, Range, SceneFailed, Solved, campaign, run, sweep, threshold
from rattle.summary import SummaryError, read_summary

# A link to fsrc/VERSION in a checkout, a copy of it where the package is installed.
_VERSION = Path(__file__).parent / "VERSION"


def __getattr__(name: str) -> str:
    """Read the version when it is asked for: scripts work without it where their folder alone was copied."""
    if name not in ("version", "__version__"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        return _VERSION.read_text().strip()
    except OSError:
        raise AttributeError(
            f"The version is not known: {_VERSION} is missing, in a clone of rattle a link to fsrc/VERSION."
        ) from None


__all__ = [
    "__version__",
    "Campaign",
    "Fault",
    "Gearbox",
    "InputError",
    "InputWarning",
    "Range",
    "Result",
    "ResultError",
    "RunError",
    "SceneFailed",
    "Solved",
    "SummaryError",
    "campaign",
    "read",
    "read_campaign",
    "read_summary",
    "run",
    "sweep",
    "threshold",
    "variants",
    "version",
]
