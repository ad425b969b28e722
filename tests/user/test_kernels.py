"""The package of the kernels: every public name is listed and documented."""

from __future__ import annotations

import importlib
import inspect
import pkgutil

import pytest
from kernel_module import kernels


@pytest.mark.parametrize("name", sorted(kernels.__all__))
def test_every_kernel_is_documented(name):
    thing = getattr(kernels, name)
    if not callable(thing):
        return
    text = inspect.getdoc(thing) or ""
    assert text and not text.startswith(f"{name}("), "numpy and tuples write a docstring of their own"
    if inspect.isfunction(thing) and name not in ("classify", "lines", "amplitude_spectrum"):
        assert "eq" in text or "(32)" in text or "map" in text or "film" in text
        assert "[" in text or "arrays" in text or "pure numbers" in text


def test_all_names_everything_public():
    parts = [name for _, name, _ in pkgutil.iter_modules(kernels.__path__) if not name.startswith("_")]
    assert parts
    modules = [kernels, *(importlib.import_module(f"{kernels.__name__}.{part}") for part in parts)]
    public = {
        name
        for module in modules
        for name, thing in vars(module).items()
        if not name.startswith("_") and getattr(thing, "__module__", "") == module.__name__
    }
    assert public <= set(kernels.__all__)
