"""Whatever stands in an input, the program ends soon, with code 0, 1 or 2, and never with a crash.

A mutation can turn `periods = 3` into `periods = 333333333`, which is valid and would run for days. What
the reader accepts is therefore looked at with --check first, and run only if its resolved steps are few.
"""

from __future__ import annotations

import math
import re
import shutil
import tempfile
from pathlib import Path

import f90nml
import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, event, example, given, settings
from hypothesis import strategies as st
from outcomes import assert_no_crash, summary_of

from rattle import read

pytestmark = pytest.mark.long

MOST_STEPS = 20_000
MOST_ROWS_A_PERIOD = 5_000
STATUSES = {
    "complete",
    "steady",
    "not_converged",
    "film_lost",
    "no_rigid_film",
    "overflow",
    "interrupted",
    "time_limit",
    "not_written",
}

# Derandomized: a test that fails fails for everybody. Shrinking is kept, so that a failure is small.
FUZZ = settings(
    max_examples=150,
    derandomize=True,
    database=None,
    phases=(Phase.explicit, Phase.generate, Phase.shrink),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)

BASE = """! A fast scene that uses most keys.
&scene
   name = 'fuzz' task = "motion"
/
&contact
   radius_1 = 0.02, radius_2 = 0.0347
   length = 0.010 ! [m]
/
&lubricant viscosity = 0.3, pressure_viscosity = 2.0d-8 /
&kinematics surface_speed_1 = 1.905, surface_speed_2 = 1.905 /
&load
   mass = 3.0
   steady_force = 199.2
   force_amplitude = 205.7
   frequency = 600.0
/
&film law = 'iso-viscous', rupture = 'solved', initial_velocity = -1e-4 /
&solver
   tolerance = 1.0e-14
   iteration_limit = 50
   method = 'newmark' steps_per_period = 16
   periods = 3
/
&spectrum periods = 2 /
&output columns = 'time', 'acceleration', series = T, stride = 2 /
"""
TOKENS = re.findall(r"\w+|'[^']*'|\s+|[^\w\s]", BASE)
SNIPPETS = [
    *"&/=,!()'\"*%:;$\t\n\r.+-",
    "\r\n",
    "''",
    "!'",
    "&load",
    "&end",
    " / ",
    "nan",
    "inf",
    "1e999",
    "-1",
    "0",
    "1e308",
    "1e-308",
    "5e-324",
    "2147483647",
    "2147483648",
    "99999999999999999999",
    ".true.",
    "3*1.0",
    "(1)",
    "(0)",
    "(-1)",
    "(99999999999)",
    "(1:2)",
    "\x00",
    "\x7f",
    "\ufeff",
    "\u00e4",
    "'piezo-viscous'",
    "'successive'",
    "initial_film = 1e-9",
    "a" * 600,
]


@pytest.fixture
def survives(run):
    """Check, and if it is short run, an input; every way it can end is checked."""

    def call(content: bytes, *arguments: str) -> None:
        folder = Path(tempfile.mkdtemp(prefix="rattle-fuzz-"))
        try:
            checked = run("--check", "-", *arguments, cwd=folder, stdin=content, timeout=600.0)
            assert_plain(checked)
            assert checked.returncode in (0, 2), checked
            assert list(folder.iterdir()) == []
            event(f"--check ends with {checked.returncode}")
            if checked.returncode == 2 or not is_short(checked.stdout):
                return
            ended = run("-", *arguments, "--output", "here", cwd=folder, stdin=content, timeout=600.0)
            assert_plain(ended)
            assert ended.returncode in (0, 1), ended
            event(f"run ends with {ended.returncode}")
            assert_summary(folder / "here", ended.returncode)
        finally:
            shutil.rmtree(folder)

    return call


def assert_plain(ended) -> None:
    """No trace of a crash; faults, and nothing but faults, on the error channel, as the code says."""
    assert_no_crash(ended.stderr + ended.stdout)
    assert (ended.stderr != "") == (ended.returncode == 2), ended
    assert (ended.stdout == "") == (ended.returncode == 2), ended


def is_short(echo: str) -> bool:
    """Whether a resolved input is solved within moments."""
    solver = f90nml.reads(echo)["solver"]
    steps = solver["steps_per_period"]
    # A step may take as many iterations as the limit allows.
    iterations = (
        min(solver["iteration_limit"], 100) if solver["iteration"] == "newton" else solver["iteration_limit"]
    )
    return steps * solver["periods"] * iterations <= 50 * MOST_STEPS and steps <= MOST_ROWS_A_PERIOD


def assert_summary(folder: Path, code: int) -> None:
    (path,) = folder.glob("*.summary.nml")
    summary = summary_of(path)
    assert summary["status"] in STATUSES
    assert (summary["status"] in ("complete", "steady")) == (code == 0)
    for key, value in summary.items():
        for number in value if isinstance(value, list) else [value]:
            assert not isinstance(number, float) or math.isfinite(number), key
    if code == 0:
        assert summary["film_minimum"] > 0
        for series in folder.glob("*.rattle"):
            assert all(np.isfinite(column).all() for column in read(series).columns.values())


@FUZZ
@given(content=st.binary(max_size=2000))
@example(content=b"\xff" * 300_000)
@example(content=b"&" * 5000)
@example(content=b"'" * 5000)
@example(content=b"/" * 5000)
@example(content=b"&a" * 5000)
@example(content=b"(" * 5000)
def test_random_bytes(content: bytes, survives) -> None:
    survives(content)


@FUZZ
@given(content=st.text(alphabet=st.sampled_from(list("&/=,!'\"()\n\t .-+*019eEdDtTmas_loc")), max_size=400))
@example(content="&a(")
@example(content="&a b(")
@example(content="&a b=")
@example(content="&a b='")
@example(content="&a b=/")
@example(content="&a b=1/")
@example(content="&a b=1/2")
@example(content="&output columns(")
@example(content="&output columns=,,")
def test_random_namelist_signs(content: str, survives) -> None:
    survives(content.encode())


@FUZZ
@given(words=st.lists(st.sampled_from(TOKENS + SNIPPETS), max_size=120))
def test_shuffled_words(words: list[str], survives) -> None:
    survives("".join(words).encode())


def mutated(draw, parts: list[str]) -> str:
    """A few parts deleted, doubled, moved, replaced, or joined by others."""
    parts = list(parts)
    for _ in range(draw(st.integers(1, 4))):
        if not parts:
            break
        at = draw(st.integers(0, len(parts) - 1))
        kind = draw(st.sampled_from(["delete", "double", "insert", "replace", "swap"]))
        if kind == "delete":
            del parts[at]
        elif kind == "double":
            parts.insert(at, parts[at])
        elif kind == "insert":
            parts.insert(at, draw(st.sampled_from(SNIPPETS)))
        elif kind == "replace":
            parts[at] = draw(st.sampled_from(SNIPPETS + TOKENS))
        else:
            other = draw(st.integers(0, len(parts) - 1))
            parts[at], parts[other] = parts[other], parts[at]
    return "".join(parts)


@FUZZ
@given(data=st.data())
def test_mutated_letters(data, survives) -> None:
    survives(mutated(data.draw, list(BASE)).encode())


@FUZZ
@given(data=st.data())
def test_mutated_words(data, survives) -> None:
    survives(mutated(data.draw, TOKENS).encode())


@FUZZ
@given(data=st.data())
def test_mutated_lines(data, survives) -> None:
    survives(mutated(data.draw, BASE.splitlines(keepends=True)).encode())


POSITIVE = st.floats(min_value=0, exclude_min=True, allow_infinity=False) | st.floats(1e-9, 1e9)
ANY = st.floats(allow_nan=False, allow_infinity=False) | st.floats(-1e6, 1e6)


@settings(FUZZ, max_examples=300)
@given(
    contact=st.fixed_dictionaries({"radius": POSITIVE, "length": POSITIVE, "young_modulus": POSITIVE}),
    lubricant=st.fixed_dictionaries({"viscosity": POSITIVE, "pressure_viscosity": POSITIVE}),
    kinematics=st.fixed_dictionaries({"entrainment_speed": POSITIVE}),
    load=st.fixed_dictionaries(
        {"mass": POSITIVE, "steady_force": ANY, "force_amplitude": POSITIVE, "frequency": POSITIVE}
    ),
    film=st.fixed_dictionaries({"initial_velocity": ANY}, optional={"initial_film": POSITIVE}),
    words=st.tuples(
        st.sampled_from(["'iso-viscous'", "'piezo-viscous'"]), st.sampled_from(["'newton'", "'successive'"])
    ),
    tolerance=POSITIVE,
)
def test_numbers_of_any_size(
    contact, lubricant, kinematics, load, film, words, tolerance, scene_text, survives
) -> None:
    """Every number that the key table allows ends in a status and a finite summary, however far out."""
    groups = {
        "contact": contact,
        "lubricant": lubricant,
        "kinematics": kinematics,
        "load": load,
        "film": film,
    }
    changes = {group: {key: repr(value) for key, value in keys.items()} for group, keys in groups.items()}
    changes["film"]["law"] = words[0]
    changes["solver"] = {"steps_per_period": "16", "iteration": words[1], "tolerance": repr(tolerance)}
    survives(scene_text(**changes).encode())


@FUZZ
@given(
    setting=st.text(
        alphabet=st.characters(codec="utf-8", exclude_characters="\0", exclude_categories=["Cs"]), max_size=80
    )
    | st.builds(
        "{}.{}={}".format,
        st.sampled_from(["load", "film", "output", "scene", "x", ""]),
        st.sampled_from(["mass", "law", "columns", "name", "x", ""]),
        st.sampled_from(SNIPPETS).filter(lambda text: "\0" not in text),
    )
)
@example(setting="load.mass=1\n/ &film law=")
@example(setting="load.mass=1/ &film")
@example(setting="load.mass=1 &")
@example(setting="load.mass='")
def test_random_settings(setting: str, survives) -> None:
    survives(BASE.encode(), "--set", setting)
