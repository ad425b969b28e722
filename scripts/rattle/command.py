"""What every entry script does alike: plain messages and exit codes instead of tracebacks."""

from __future__ import annotations

import argparse
import codecs
import io
import math
import os
import signal
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

from rattle.campaign_result import Campaign
from rattle.faults import InputWarning
from rattle.result import Result, ResultError
from rattle.result_file import ResultFile
from rattle.summary import SummaryError, read_summary

COMPLETE = 0
BAD_INPUT = 2
INTERRUPTED = 130


class CommandError(Exception):
    """A request that cannot be met, explained in one plain sentence."""


def run(main: Callable[[], int | None]) -> None:
    """Run `main` and leave the process with its exit code."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=AS_FILE_NAME)
    # What a script must tidy up is tidied up also when a batch system or another program ends it.
    signal.signal(signal.SIGTERM, _leave)
    try:
        with warnings.catch_warnings():
            # What is odd about an input is for the user, whatever is set; warnings of libraries are not.
            warnings.simplefilter("ignore")
            warnings.simplefilter("default", InputWarning)
            warnings.showwarning = lambda words, *_, **__: note(str(words))
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
    except (UnicodeDecodeError, UnicodeEncodeError) as fault:
        words = fault.object if isinstance(fault.object, str) else repr(fault.object)
        code = complain(f"'{readable(words)[:200]}' cannot be read or written as text ({fault.reason}).")
    except ImportError as fault:
        code = complain(f"{words_of_import(fault)}; 'make python' builds and installs all.")
    except KeyboardInterrupt:
        code = INTERRUPTED
    sys.exit(code)


def words_of_import(fault: ImportError) -> str:
    """What cannot be loaded, as the beginning of a sentence."""
    if fault.name == "rattle" and "_kernels" in str(fault):
        return "The kernels of the package, which are compiled, are not built here"
    return f"A Python module cannot be loaded ({fault})"


def _leave(number: int, _: object) -> None:
    sys.exit(128 + number)


def _as_file_name(fault: UnicodeError) -> tuple[bytes, int]:
    """What an encoding does not have, as the bytes that it has in names of files."""
    if not isinstance(fault, UnicodeEncodeError):
        raise fault
    words = fault.object[fault.start : fault.end]
    try:
        return os.fsencode(words), fault.end
    except UnicodeError:
        return words.encode("ascii", "backslashreplace"), fault.end


def readable(words: str) -> str:
    """Words for pages and figures, where bytes of a file name that are no text have no place."""
    return words.encode("utf-8", "surrogateescape").decode("utf-8", "replace")


AS_FILE_NAME = "rattle_file_name"
codecs.register_error(AS_FILE_NAME, _as_file_name)


def complain(sentence: str) -> int:
    """Print one sentence for the user and return the exit code of bad input."""
    print(f"{Path(sys.argv[0]).name}: {sentence}", file=sys.stderr)
    return BAD_INPUT


def note(sentence: str) -> None:
    """Warn the user something that does not stop the work."""
    print(f"{Path(sys.argv[0]).name}: {sentence}", file=sys.stderr)


def note_open(result: Result | Campaign) -> None:
    """Warn the user that a result is not closed, or that the summary beside it is of another run."""
    if not result.closed:
        note(f"{result.path} is not closed; its {result.row_count} complete rows are used.")
    note_summary(result)


def note_summary(result: ResultFile) -> None:
    """Warn the user that the summary beside a result is of another run, if it is."""
    try:
        if result.summary_path.exists():
            read_summary(result.summary_path)
    except SummaryError as fault:
        note(str(fault))


def parse(parser: argparse.ArgumentParser) -> argparse.Namespace:
    """The options of a script; the whole help where there is no argument at all."""
    if len(sys.argv) == 1:
        parser.print_help(sys.stderr)
        sys.exit(BAD_INPUT)
    options, rest = parser.parse_known_args()
    if rest:
        getattr(options, "parser", parser).error(f"unrecognized arguments: {' '.join(rest)}")
    return options


def positive(text: str) -> int:
    """The value of an option that is a positive whole number."""
    if not (text.isascii() and text.isdecimal() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"'{text}' is not a positive whole number")
    return int(text)


def finite(text: str) -> float:
    """The value of an option that is a finite number."""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number")
    return number


def positive_number(text: str) -> float:
    """The value of an option that is a positive finite number."""
    number = finite(text)
    if number <= 0.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a positive number")
    return number


def names(text: str) -> list[str]:
    """The value of an option that is a list of names between commas."""
    return [name.strip() for name in text.split(",") if name.strip()]


def some_of(known: Sequence[int | str]) -> Callable[[str], tuple[int | str, ...]]:
    """A reader of an option that lists some of the known numbers and words between commas."""

    def read(text: str) -> tuple[int | str, ...]:
        parts = [part.strip() for part in text.split(",")]
        choice = {str(number): number for number in known}
        for part in parts:
            if part not in choice:
                raise argparse.ArgumentTypeError(f"'{part}' is not one of {', '.join(choice)}")
        return tuple(choice[part] for part in parts)

    return read


def held_key(text: str) -> tuple[str, float]:
    key, _, value = text.partition("=")
    try:
        return key.strip(), float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not group.key=value") from None


def one_each(pairs: Sequence[tuple[str, float]]) -> dict[str, float]:
    keys = [key for key, _ in pairs]
    for key in keys:
        if keys.count(key) > 1:
            raise CommandError(f"--slice gives {key} twice.")
    return dict(pairs)
