"""Running the gear-rattle solver `rattle`; reading, judging and drawing its results."""

from pathlib import Path

from rattle.campaign_result import Campaign, read_campaign
from rattle.faults import Fault, InputError, RunError
from rattle.result import Result, ResultError, read
from rattle.solve import Gearbox, Range, SceneFailed, Solved, campaign, run, sweep, threshold
from rattle.summary import SummaryError, read_summary

# A link to fsrc/VERSION in a checkout, a copy of it where the package is installed.
version = (Path(__file__).parent / "VERSION").read_text().strip()

__all__ = [
    "Campaign",
    "Fault",
    "Gearbox",
    "InputError",
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
    "version",
]
