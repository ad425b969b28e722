"""The package of the kernels: every public name is listed."""

from __future__ import annotations

import importlib
import pkgutil

from kernel_module import kernels


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
