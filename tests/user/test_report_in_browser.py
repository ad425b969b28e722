"""Pages of report.py as a browser shows and prints them; skipped where there is no browser."""

from __future__ import annotations

import html
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from script_calls import call_script

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
WIDTHS = (1200, 400)
# The page in a frame of a given width, and how wide its content is then.
FRAME = """<!DOCTYPE html><meta charset="utf-8"><body style="margin:0">
<iframe id="page" style="border:0;width:{width}px;height:{height}px" srcdoc="{page}"></iframe>
<p id="reported"></p><script>
onload = () => {{
  const inner = document.getElementById("page").contentDocument;
  const out = [...inner.querySelectorAll("svg, p, h1, h2, pre, .verdict, figcaption")]
    .filter(e => e.getBoundingClientRect().right > {width} + 1)
    .map(e => e.tagName);
  const root = inner.documentElement;
  const type = parseFloat(getComputedStyle(inner.body).fontSize);
  document.getElementById("reported").textContent =
    `reported: ${{root.scrollWidth}} ${{root.scrollHeight}} ${{type}} [${{out}}]`;
}};
</script>"""

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(BROWSER is None, reason="there is no browser that runs without a window"),
]


def browse(place: Path, *options: str) -> str:
    """Open a page without a window; returns what the browser prints."""
    arguments = ["--headless", "--disable-gpu", f"--user-data-dir={place.parent / 'profile'}"]
    if os.geteuid() == 0:
        arguments.append("--no-sandbox")
    ended = subprocess.run(
        [BROWSER, *arguments, *options, place.as_uri()],
        capture_output=True,
        text=True,
        timeout=600.0,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


@pytest.fixture(scope="module")
def page(tmp_path_factory, repository, run) -> Path:
    """A page on all kinds of results."""
    folder = tmp_path_factory.mktemp("report")
    inputs = [repository / "input" / f"{name}.nml" for name in ("idle", "sweep", "map")]
    small = ("--set", "campaign.count=9,9", "--set", "sweep.count=11")
    for path in inputs:
        chosen = [word for word in small if path.stem == "map" and "camp" in word or path.stem in word]
        options = [part for word in chosen for part in ("--set", word)]
        ended = run(path, *options, "--output", folder, cwd=folder, timeout=600.0)
        assert ended.returncode == 0, ended.stderr
    output = folder / "page.html"
    results = [folder / f"{path.stem}.rattle" for path in inputs]
    done = call_script("report.py", *results, "--output", output, "--pdf", folder / "page.pdf")
    assert done.returncode == 0, done.stderr
    return output


@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_is_wider_than_the_window(page, width):
    frame = page.with_name(f"frame_{width}.html")
    frame.write_text(FRAME.format(width=width, height=3000, page=html.escape(page.read_text())))
    reported = re.search(r"reported: (\d+) (\d+) ([\d.]+) \[(.*?)\]", browse(frame, "--dump-dom"))
    assert reported, "the page did not load"
    assert int(reported[1]) <= width and reported[4] == ""
    assert int(reported[2]) > 3000  # long, as a page of three results is
    assert float(reported[3]) >= 15.0


@pytest.mark.parametrize("width", WIDTHS)
def test_verdict_and_figures_are_seen(page, width):
    frame, picture = page.with_name(f"seen_{width}.html"), page.with_name(f"seen_{width}.png")
    frame.write_text(FRAME.format(width=width, height=4000, page=html.escape(page.read_text())))
    browse(frame, f"--window-size={max(width, 500)},4000", "--hide-scrollbars", f"--screenshot={picture}")
    seen = imread(picture)[:, :width, :3]
    assert seen.shape[:2] == (4000, width)
    dark = seen.min(axis=2) < 0.6
    assert 0.01 < dark.mean() < 0.3
    blue = (seen[:, :, 2] - seen[:, :, 0] > 0.4).sum(axis=1)  # the curves and the rule beside the verdict
    assert (blue > 0).mean() > 0.1
    assert np.flatnonzero(dark.any(axis=1))[0] < 100  # it begins at the top


def sheets(pdf: Path) -> int:
    return len(re.findall(rb"/Type\s*/Page\b", pdf.read_bytes()))


def test_it_prints(page):
    pdf = page.with_name("page.pdf")
    content = pdf.read_bytes()
    assert content.startswith(b"%PDF")
    assert 6 <= sheets(pdf) <= 30  # three results: at least one sheet each before and in the appendix
    assert re.search(rb"/MediaBox\s*\[\s*0 0 59[45][.\d]* 84[12]", content)  # A4


@pytest.mark.parametrize(
    ("name", "most", "changes"),
    (
        ("idle", 4, ()),
        ("loose_gear", 4, ()),
        ("elastohydrodynamic", 4, ()),
        ("gearbox", 5, ()),
        ("gearbox_map", 5, ("campaign.count=5,4",)),
    ),
)
def test_few_sheets_come_before_the_appendix(name, most, changes, repository, run, tmp_path):
    """What leads to a decision: at most four sheets of a motion, five of a map or a gearbox."""
    options = [part for change in changes for part in ("--set", change)]
    ended = run(
        repository / "input" / f"{name}.nml", *options, "--output", tmp_path, cwd=tmp_path, timeout=600.0
    )
    assert ended.returncode == 0, ended.stderr
    results = [path for path in sorted(tmp_path.glob(f"{name}*.rattle")) if "motions" not in path.name]
    reported = []
    for options in ((), ("--brief",)):
        pdf = tmp_path / f"page{len(reported)}.pdf"
        done = call_script("report.py", *results, *options, "--overwrite", "--output", tmp_path, "--pdf", pdf)
        assert done.returncode == 0, done.stderr
        reported.append(sheets(pdf))
    assert 1 <= reported[1] <= most
    assert reported[1] < reported[0]
