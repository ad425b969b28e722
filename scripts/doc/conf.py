"""Settings of the site of make doc: the pages of this repository where they are, and the Python API."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

from sphinx.application import Sphinx

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))

project = "rattle"
copyright = author = "The rattle developers"
release = (ROOT / "fsrc" / "VERSION").read_text().strip()

root_doc = "README"
exclude_patterns = [".*", "build", "results", "fsrc/ford.md"]
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx-mathjax-offline"]
myst_heading_anchors = 4
# Equations as GitHub has them: $z'$ in a line, ```math blocks.
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
# Most blocks of code are commands, namelists, equations or output, and name no language; z'' stays z''.
highlight_language = "none"
smartquotes = False

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_mock_imports = ["scipy"]
napoleon_google_docstring = False
napoleon_use_rtype = False

html_theme = "furo"
html_title = f"rattle {release}"
html_static_path = ["wide.css"]
html_css_files = ["wide.css"]
html_copy_source = False

# The pages beside the first one of a folder.
BESIDE = """
```{toctree}
:hidden:
:glob:
*
```
"""
CONTENTS = """
```{toctree}
:hidden:
:caption: Guide
:glob:
input/README
input/FIRST_MAP
input/*
```
```{toctree}
:hidden:
:caption: Python
scripts/README
scripts/doc/python
```
```{toctree}
:hidden:
:caption: Code
fsrc/THEORY
fsrc/README
scripts/doc/fortran
```
```{toctree}
:hidden:
:caption: Studies
:glob:
tests/README
tests/*/README
```
```{toctree}
:hidden:
:caption: Changes
CHANGELOG
```
"""


def add_contents(_: Sphinx, page: str, source: list[str]) -> None:
    """Give the first page the contents that the sidebar shows, studies their pages, Fortran its modules."""
    if page == root_doc:
        source[0] += CONTENTS
    elif page in ("tests/benchmarks/README", "tests/stress/README"):
        source[0] += BESIDE
    elif page == "scripts/doc/fortran":
        source[0] += "".join(modules())


def modules() -> Iterator[str]:
    """Each folder of fsrc with its modules: the first paragraph on each, and its place in FORD's pages."""
    folders = re.findall(r"^\| `(\w+)/` \|", (ROOT / "fsrc" / "README.md").read_text(), re.MULTILINE)
    for folder in folders:
        yield f"\n{folder}\n{'-' * len(folder)}\n\n"
        for path in sorted((ROOT / "fsrc" / folder).glob("**/*.f90")):
            name = path.stem
            if about := re.search(
                rf"((?:^!> .+\n)+)(?:^!>.*\n)*^module {name}$", path.read_text(), re.MULTILINE
            ):
                words = re.sub(r"([\\*`|_])", r"\\\1", " ".join(about[1].replace("!>", "").split()))
                yield f"- `{name} <../../code/module/{name}.html>`__: {words}\n"


def setup(site: Sphinx) -> None:
    site.connect("source-read", add_contents)
