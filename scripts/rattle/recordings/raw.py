"""What readers of files hand over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Raw:
    """A channel as its file has it: time [s] (None: it has none), and in text the line of each sample."""

    name: str
    unit: str
    values: np.ndarray
    time: np.ndarray | None
    lines: np.ndarray | None = None
