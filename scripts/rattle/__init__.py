"""Reading, judging and drawing the results of the gear-rattle solver `rattle`."""

from rattle.result import Result, ResultError, read
from rattle.summary import SummaryError, read_summary

version = "0.1.0"

__all__ = ["Result", "ResultError", "SummaryError", "read", "read_summary", "version"]
