"""Reading, judging and drawing the results of the gear-rattle solver `rattle`."""

from rattle.campaign import Campaign, read_campaign
from rattle.result import Result, ResultError, read
from rattle.summary import SummaryError, read_summary

version = "0.1.0"

__all__ = [
    "Campaign",
    "Result",
    "ResultError",
    "SummaryError",
    "read",
    "read_campaign",
    "read_summary",
    "version",
]
