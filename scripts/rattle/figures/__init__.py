"""Publication figures of motions; one module draws one kind of figure."""

from __future__ import annotations

import logging
import os
import sys
from pathlib import Path


def _load_matplotlib() -> None:
    """Load Matplotlib with none of the settings of the user, which could change figures or fail here.

    A Matplotlib that is there already is left as it is; figures are drawn in the house style all the same.
    """
    if "matplotlib" in sys.modules:
        return
    own = {"MPLBACKEND": "agg", "MATPLOTLIBRC": os.devnull}
    given = {name: os.environ.get(name) for name in own}
    # Its words on folders that it cannot write to are not for those who only draw.
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    os.environ.update(own)
    try:
        # A matplotlibrc in the working directory comes before any other.
        if os.path.lexists("matplotlibrc"):
            here = os.open(os.curdir, getattr(os, "O_PATH", os.O_RDONLY))
            os.chdir(Path(__file__).parent)
            try:
                import matplotlib
            finally:
                os.fchdir(here)
                os.close(here)
        import matplotlib  # noqa: F401
    finally:
        for name, value in given.items():
            os.environ.pop(name)
            if value is not None:
                os.environ[name] = value


_load_matplotlib()
