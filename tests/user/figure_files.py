"""Calls the scripts that draw, and looks at the pictures they leave."""

from __future__ import annotations

from pathlib import Path

from matplotlib.image import imread


def stems(directory: Path) -> list[str]:
    """Names of the figures; none may be blank."""
    found = sorted(path.stem for path in directory.glob("*.png"))
    for path in directory.glob("*.png"):
        picture = imread(path)
        assert picture.shape[0] > 400 and picture.shape[1] > 1000
        assert 0.005 < (picture[:, :, :3].min(axis=2) < 0.7).mean() < 0.5, path
    return found
