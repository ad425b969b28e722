#!/usr/bin/env python3
"""Write one self-contained page on results: verdict, figures, numbers, input."""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from rattle import command, outputs

# Browsers that print a page without a window.
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "microsoft-edge")
LONGEST_PRINT = 120  # seconds


def main() -> int | None:
    options = parse_options()
    page = file_in(options.output, (".html", ".htm"))
    printed = file_in(options.pdf, (".pdf",)) if options.pdf else None
    places = [page, printed] if printed else [page]
    outputs.check(places, overwrite=options.overwrite, inputs=options.results)
    import rattle
    from rattle.report import report  # needs the kernels, and what is missing of them has a sentence here
    from rattle.report.limits import check, read_limits
    from rattle.report.reference import read_reference

    limits = read_limits(options.limits) if options.limits else {}
    unmatched = check(options.limits, limits, map(rattle.read, options.results)) if options.limits else []
    reference = read_reference(options.reference) if options.reference else None
    made = report(options.results, brief=options.brief, limits=limits, reference=reference)
    text = command.readable(made)
    outputs.write([(page, outputs.text_writer(text))], overwrite=options.overwrite, inputs=options.results)
    print(page)
    if unmatched:
        command.note(f"{options.limits} has limits of pairs that are not here: {', '.join(unmatched)}.")
    return print_page(page, printed, options) if printed else None


def file_in(given: str, endings: Sequence[str]) -> Path:
    """The file that an option names; of a folder, which needs not be there yet, the file report in it."""
    path = Path(given)
    is_file = path.suffix.lower() in endings and not given.endswith(os.sep) and not path.is_dir()
    return path if is_file or path.is_file() else path / f"report{endings[0]}"


def print_page(source: Path, target: Path, options: argparse.Namespace) -> int:
    """The page as PDF, where a browser is found."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        return command.complain(
            f"{target} was not written: no browser that prints without a window is on the search path "
            f"({', '.join(BROWSERS)}). {source} prints from any browser."
        )
    with tempfile.TemporaryDirectory() as profile:
        made, opened = Path(profile) / "page.pdf", Path(profile) / "page.html"
        opened.write_text(
            source.read_text(encoding="utf-8").replace("<details>", "<details open>"), encoding="utf-8"
        )
        arguments = ["--headless", "--disable-gpu", f"--user-data-dir={profile}", "--no-pdf-header-footer"]
        if os.geteuid() == 0:  # the browser refuses root inside its sandbox
            arguments.append("--no-sandbox")
        try:
            ended = subprocess.run(
                [browser, *arguments, f"--print-to-pdf={made}", opened.as_uri()],
                capture_output=True,
                text=True,
                timeout=LONGEST_PRINT,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return command.complain(f"{target} was not written: {browser} took more than {LONGEST_PRINT} s.")
        if ended.returncode != 0 or not made.exists():
            last = ended.stderr.strip().splitlines()[-1:] or ["it gave no reason"]
            return command.complain(f"{target} was not written: {browser} failed ({last[0]}).")
        files = [(target, partial(shutil.copyfile, made))]
        outputs.write(files, overwrite=options.overwrite, inputs=options.results)
    print(target)
    return command.COMPLETE


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Write one page (HTML, no other file needed) on results of scenes, sweeps, campaigns "
        "and films: "
        "verdict, figures, numbers, how they were computed, and the input that computes them again."
    )
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT", help="result file, NAME.rattle")
    parser.add_argument(
        "--output",
        default="report.html",
        metavar="PLACE",
        help="the page, FILE.html, or the folder for report.html (.)",
    )
    parser.add_argument(
        "--pdf",
        metavar="PLACE",
        help="also print the page, by a browser found here, as FILE.pdf or into a folder",
    )
    parser.add_argument(
        "--limits",
        type=Path,
        metavar="FILE.csv",
        help="film forces that pairs are to keep: columns gear and film_force_rms [N]",
    )
    parser.add_argument(
        "--reference",
        metavar="[NAME=]RESULT",
        help="also give film forces in dB re those of this result or summary, pair by pair",
    )
    parser.add_argument(
        "--brief",
        action="store_true",
        help="leave the appendix out of what is printed; the rest is at most four sheets of a ready motion, "
        "five of a map or gearbox",
    )
    outputs.add_option(parser)
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
