#!/usr/bin/env python3
"""Write one self-contained page on results: verdict, figures, numbers, input."""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from rattle import command
from rattle.report import report

# Browsers that print a page without a window.
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "microsoft-edge")
LONGEST_PRINT = 120  # seconds


def main() -> int | None:
    options = parse_options()
    for path in (options.output, options.pdf):
        if path and any(
            path.exists() and path.samefile(given) for given in options.results if given.exists()
        ):
            raise command.CommandError(f"{path} is a result itself; give another name.")
    text = report(options.results)
    options.output.parent.mkdir(parents=True, exist_ok=True)
    options.output.write_text(text, encoding="utf-8")
    print(options.output)
    return print_page(options.output, options.pdf) if options.pdf else None


def print_page(source: Path, target: Path) -> int:
    """The page as PDF, where a browser is found."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        return command.complain(
            f"{target} was not written: no browser that prints without a window is on the search path "
            f"({', '.join(BROWSERS)}). {source} prints from any browser."
        )
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as profile:
        arguments = ["--headless", "--disable-gpu", f"--user-data-dir={profile}", "--no-pdf-header-footer"]
        if os.geteuid() == 0:  # the browser refuses root inside its sandbox
            arguments.append("--no-sandbox")
        try:
            ended = subprocess.run(
                [browser, *arguments, f"--print-to-pdf={target.resolve()}", source.resolve().as_uri()],
                capture_output=True,
                text=True,
                timeout=LONGEST_PRINT,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return command.complain(f"{target} was not written: {browser} took more than {LONGEST_PRINT} s.")
    if ended.returncode != 0 or not target.exists():
        last = ended.stderr.strip().splitlines()[-1:] or ["it gave no reason"]
        return command.complain(f"{target} was not written: {browser} failed ({last[0]}).")
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
        "--output", type=Path, default=Path("report.html"), metavar="FILE.html", help="the page (report.html)"
    )
    parser.add_argument(
        "--pdf", type=Path, metavar="FILE.pdf", help="also print the page, by a browser found here"
    )
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
