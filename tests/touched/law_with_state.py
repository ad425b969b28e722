"""A toy law with a state of its own: the chain of ten relaxing films of the unit tests."""

from __future__ import annotations

import re
import subprocess
from math import isclose
from pathlib import Path

import scene
from run_touched import REPOSITORY, ToyError, Tree

INPUT = scene.scene_text(law="relaxing-chain").replace(
    "   periods = 40\n", "   method = 'taylor'\n   periods = 40\n"
)
LAW = REPOSITORY / "tests/unit/relaxing_film.f90"
# Its stiffness K [N/m] and reach L [m]
STIFFNESS, REACH = 2.0e6, 2.0e-4


def change(tree: Tree) -> None:
    tree.add("fsrc/contact/relaxing_film.f90", LAW.read_text())
    types = "fsrc/scene/scene_types.f90"
    # Toys share one copy: that of a law may have added its word before.
    words = re.search(r"words_of_laws = '(.*)'", (tree.root / types).read_text())[1]
    code = f"law_relaxing = {len(words.split()) + 1}"
    tree.change(types, "law_piezo_viscous = 2", f"{code}, law_piezo_viscous = 2")
    tree.change(types, f"'{words}'", f"'{words} relaxing-chain'")
    main = "fsrc/main.f90"
    tree.put(main, "   use key_page,", "   use film_states, only: add_film_state\n")
    tree.put(
        main,
        "   use run_tasks,",
        "   use relaxing_film, only: relaxing_film_t\n   use scene_types, only: law_relaxing\n",
    )
    tree.put(main, "   type(command_t) :: command\n", "   type(relaxing_film_t), target, save :: chain\n")
    tree.put(main, "   call watch_end()\n", "   call add_film_state(law_relaxing, chain)\n")


def look(folder: Path, scratch: Path) -> None:
    """The film at rest carries the static load, elastic teeth take the law, Newmark's method does not."""
    reported = scene.read_summary(folder / "law_with_state.summary.nml")
    steady = REACH - (scene.STEADY_FORCE + scene.MASS * scene.GRAVITY) / STIFFNESS
    if not isclose(reported["steady_film"], steady, rel_tol=1e-9):
        raise ToyError(f"its steady film is {reported['steady_film']}, not {steady}")
    stiff = ["--set", "contact.stiffness=1e12", "--set", "scene.name=stiff_chain", "law_with_state.nml"]
    subprocess.run([scratch / "build/rattle", "--quiet", "--output", ".", *stiff], cwd=folder, check=True)
    elastic = scene.read_summary(folder / "stiff_chain.summary.nml")
    if not isclose(elastic["film_minimum"], reported["film_minimum"], rel_tol=1e-3):
        raise ToyError(
            f"its film is {reported['film_minimum']}, between stiff teeth {elastic['film_minimum']}"
        )
    refused = ["--set", "solver.method=newmark", "--set", "scene.name=refused", "law_with_state.nml"]
    ended = subprocess.run(
        [scratch / "build/rattle", *refused], cwd=folder, capture_output=True, text=True, check=False
    )
    if ended.returncode != 2 or "&solver method: the paper's method cannot follow" not in ended.stderr:
        raise ToyError(f"Newmark's method takes it: {ended.returncode}, {ended.stderr}")
