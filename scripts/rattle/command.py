"""What every entry script does alike: plain messages and exit codes instead of tracebacks."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable
from pathlib import Path

from rattle.result import ResultError
from rattle.summary import SummaryError

COMPLETE = 0
BAD_INPUT = 2
INTERRUPTED = 130


class CommandError(Exception):
    """A request that cannot be met, explained in one plain sentence."""


def run(main: Callable[[], int | None]) -> None:
    """Run `main` and leave the process with its exit code."""
    try:
        code = main() or COMPLETE
        sys.stdout.flush()
    except (CommandError, ResultError, SummaryError) as fault:
        code = complain(str(fault))
    except BrokenPipeError:  # the reader of our output, such as `head`, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = COMPLETE
    except OSError as fault:
        place = f"{fault.filename}: " if fault.filename else ""
        code = complain(f"{place}{fault.strerror or fault}.")
    except ImportError as fault:
        code = complain(f"A Python module cannot be loaded ({fault}); 'make python' builds and installs all.")
    except KeyboardInterrupt:
        code = INTERRUPTED
    sys.exit(code)


def complain(sentence: str) -> int:
    """Print one sentence for the user and return the exit code of bad input."""
    print(f"{Path(sys.argv[0]).name}: {sentence}", file=sys.stderr)
    return BAD_INPUT


def note(sentence: str) -> None:
    """Tell the user something that does not stop the work."""
    print(f"{Path(sys.argv[0]).name}: {sentence}", file=sys.stderr)


def positive(text: str) -> int:
    """The value of an option that is a positive whole number."""
    if not (text.isascii() and text.isdecimal() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"'{text}' is not a positive whole number")
    return int(text)
