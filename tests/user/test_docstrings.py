"""Every public name of rattle is documented, with the parameters of its signature; the examples run."""

from __future__ import annotations

import doctest
import inspect
import re
from collections.abc import Iterator
from typing import Any

import pytest

import rattle as package
import rattle.kernels as kernels
import rattle.recordings as recordings

MODULES = (package, kernels, recordings)
# A section of a docstring, and the names in it: lines that are not indented.
SECTION = re.compile(r"^(\w+)\n-+\n(.*?)(?=^\w+\n-+\n|\Z)", re.MULTILINE | re.DOTALL)
FIELD = re.compile(r"^ {4}(\w+): (.*)$", re.MULTILINE)


def public() -> Iterator[tuple[str, Any]]:
    """Every function and class that is exported, and the methods and properties that are ours."""
    for module in MODULES:
        for name in module.__all__:
            member = getattr(module, name)
            if not callable(member):
                continue
            yield f"{module.__name__}.{name}", member
            for owner in inspect.getmro(member) if inspect.isclass(member) else ():
                for method, own in vars(owner).items() if owner.__module__.startswith("rattle") else ():
                    if not method.startswith("_") and is_method(own):
                        yield f"{module.__name__}.{name}.{method}", getattr(own, "func", own)


def is_method(member: Any) -> bool:
    """Whether a member of a class is code of its own, but for what only refuses."""
    if inspect.isfunction(member):
        return not member.__name__.startswith("_")
    return isinstance(member, property) or hasattr(member, "func")


PUBLIC = dict(public())


def sections(member: Any) -> dict[str, list[str]]:
    """The names in each section of a docstring; several may share a line."""
    found = SECTION.findall(inspect.getdoc(member) or "")
    return {
        title: [name for line in re.findall(r"^\S.*$", text, re.MULTILINE) for name in line.split(", ")]
        for title, text in found
    }


@pytest.mark.parametrize("name", PUBLIC)
def test_a_public_name_documents_its_parameters(name):
    member = PUBLIC[name]
    text = member.__doc__
    assert text and not text.startswith(f"{name.rpartition('.')[2]}("), (
        "tuples write a docstring of their own"
    )
    if inspect.isclass(member):
        # Fields say what they are beside them, where editors and the reference read it.
        if dataclass_or_tuple(member):
            lines = FIELD.findall(inspect.getsource(member))
            assert [field for field, rest in lines if "  #: " not in rest] == []
        return
    if not inspect.isfunction(member):
        return
    parameters = list(inspect.signature(member).parameters.values())
    given = [f"**{p.name}" if p.kind is p.VAR_KEYWORD else p.name for p in parameters if p.name != "self"]
    documented = sections(member)
    assert sorted(documented.get("Parameters", [])) == sorted(given)
    returns = inspect.signature(member).return_annotation
    if given and returns != "None":
        assert documented.get("Returns")


def dataclass_or_tuple(member: type) -> bool:
    return hasattr(member, "__dataclass_fields__") or hasattr(member, "_fields")


def test_the_examples_of_docstrings_run(repository, rattle, tmp_path, monkeypatch):
    monkeypatch.chdir(repository)
    monkeypatch.setenv("RATTLE_PROGRAM", str(rattle))
    finder, runner = doctest.DocTestFinder(recurse=False), doctest.DocTestRunner()
    examples = 0
    for name, member in PUBLIC.items():
        for test in finder.find(member, name, globs={"rattle": package, "folder": tmp_path}):
            examples += runner.run(test).attempted
    assert examples > 0 and runner.summarize(verbose=False).failed == 0
