#!/usr/bin/env python3
"""Lets runs meet kills, full disks, little memory, failing calls, other runs, damaged and foreign files,
edited inputs, links, signals, missing locks, files that are taken away or may not be read.

A try fails if data are lost or silently wrong, if a summary stands beside the result of another run, if a run
ends with exit code 0 and without all its rows, if neither --resume nor --overwrite mends what it left, or if
a file that is not the program's has changed.
"""

from __future__ import annotations

import argparse
import contextlib
import errno
import io
import os
import random
import re
import resource
import runpy
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "scripts"))

import rattle  # noqa: E402
from rattle.command import CommandError  # noqa: E402
from rattle.merge import merge  # noqa: E402

BASE = """&contact radius = 0.0127 length = 0.010 /
&lubricant viscosity = 0.3 pressure_viscosity = 2.0e-8 /
&kinematics entrainment_speed = 1.905 /
&load mass = 3.0 steady_force = 199.2 force_amplitude = 205.7 frequency = 600.0 /
&film law = 'iso-viscous' /
&output directory = 'results' /
"""
MOTION = """&scene task = 'motion' /
&solver method = 'newmark' steps_per_period = 32 periods = {periods} /
&spectrum periods = 2 verify = .false. /
"""
STEADY = """&scene task = 'motion' /
&solver until = 'steady' periods = {periods} /
&spectrum periods = 2 verify = .false. /
"""
SWEEP = """&scene task = 'sweep' /
&solver periods = 60 /
&sweep key = 'frequency' first = 500.0 last = 600.0 count = 12 /
"""
FILM = """&scene task = 'film' /
&contact radius = 0.0127 length = 0.010 /
&lubricant viscosity = 0.3 pressure_viscosity = 2.0e-8 /
&points film_ratio_range = 35.0e-6, 140.0e-6, 40 speed_groups = 0.45e-6 compute = 'load', 'profile' /
&output directory = 'results' /
"""
CAMPAIGN = """&scene task = 'campaign' /
&solver periods = 60 accuracy = 1e-6 until = 'steady' /
&spectrum periods = 8 /
&campaign vary = 'load.force_amplitude', 'kinematics.entrainment_speed' first = 5.0, 0.5 last = 400.0, 20.0
   count = 24, 24 samples_per_period = 64 /
"""
TABLE = """&scene task = 'campaign' /
&solver periods = 60 accuracy = 1e-6 until = 'steady' /
&spectrum periods = 8 /
&campaign csv = 'table.csv' samples_per_period = 64 /
"""
THRESHOLD = """&scene task = 'threshold' /
&solver periods = 60 accuracy = 1e-6 /
&spectrum periods = 2 verify = .false. /
&threshold key = 'load.force_amplitude' criterion = 'harmonic_distortion' level = 0.3
   first = 20.0 last = 200.0 count = 5 tolerance = 0.01 /
&campaign vary = 'load.mass' first = 2.0 last = 3.0 count = 6 /
"""
GEARBOX = """&scene name = 'scene' /
&gear name = '1st', teeth_1 = 11, teeth_2 = 38, normal_module = 2.5e-3, helix_angle_deg = 28.96
   face_width = 0.016, loose_inertia = 1.715e-3, drag_torque = 0.1, backlash = 1e-4, tooth_stiffness = 0 /
&gear name = '4th', teeth_1 = 33, teeth_2 = 32, normal_module = 1.85e-3, helix_angle_deg = 30.8
   face_width = 0.016, loose_inertia = 2.8e-4, drag_torque = 0.05, backlash = 8e-5, tooth_stiffness = 0 /
&shaft speed_rpm = 800.0, orders = 2.0, 4.0, accelerations = 600.0, 100.0 /
&oil viscosity_40_cst = 58.0, viscosity_100_cst = 9.6, temperature_celsius = 0.0 /
&film law = 'iso-viscous', model = 'reynolds' /
&solver until = 'periods', periods = 40, accuracy = 1e-6, samples_per_period = 512 /
&spectrum periods = 2 verify = .false. /
&output directory = 'results' /
"""
# Values of an input that an engineer may edit.
EDITS = ("viscosity = 0.3", "length = 0.010", "radius = 0.0127", "mass = 3.0", "entrainment_speed = 1.905")
EDITS += ("speed_rpm = 800.0", "loose_inertia = 1.715e-3", "drag_torque = 0.05", "backlash = 8e-5")
# Address space of a try: with less the libraries are not loaded, with more every task here is solved [bytes].
LEAST_MEMORY, MOST_MEMORY = 22e6, 200e6
FOREIGN = {
    "notes.txt": b"my notes\n",
    "scene.part": b"RATTLE, my own\n",
    "scene.rattle.unfinished": b"mine\n",
}
# Errors of a lock that say neither that another run has it nor that there are none.
LOCK_ERRORS = (errno.EIO, errno.EINVAL, errno.EACCES, errno.EBADF, errno.EPERM)
NOBODY = 65534
# A script of somebody who calls the solver.
CALLER = """import sys
sys.path.insert(0, sys.argv[1])
import rattle
rattle.run('scene.nml', folder='results', resume=len(sys.argv) > 2)
"""


@dataclass
class Task:
    """What is run: an input, and maybe an earlier, shorter run whose files stand there."""

    name: str
    text: str
    earlier: str | None = None
    files: tuple[str, ...] = ("scene.rattle",)
    # Names of its scenes; several are the pairs of a gearbox, of which there is a table.
    stems: tuple[str, ...] = ("scene",)
    expected: dict[str, bytes] = field(default_factory=dict)
    start: dict[str, bytes] = field(default_factory=dict)
    seconds: float = 0.0
    trace: tuple[str, ...] = ()

    @property
    def is_campaign(self) -> bool:
        return self.name in ("campaign", "table")

    @property
    def summaries(self) -> tuple[str, ...]:
        return tuple(f"{stem}.summary.nml" for stem in dict.fromkeys((*self.stems, "scene")))

    @property
    def results(self) -> tuple[str, ...]:
        return tuple(f"{stem}.rattle" for stem in self.stems)

    @property
    def calls(self) -> int:
        return len(self.trace)

    @property
    def command(self) -> tuple[str, ...]:
        return ("--resume",) if self.earlier else ()


TASKS = (
    Task("motion", BASE + MOTION.format(periods=6000), files=("scene.rattle", "scene.state")),
    Task(
        "resumed motion",
        BASE + MOTION.format(periods=5000),
        BASE + MOTION.format(periods=3000),
        ("scene.rattle", "scene.state"),
    ),
    Task("steady motion", BASE + STEADY.format(periods=400), files=("scene.rattle", "scene.state")),
    Task("sweep", BASE + SWEEP),
    Task("film", FILM, files=("scene.rattle", "scene.profiles.rattle")),
    Task("campaign", BASE + CAMPAIGN),
    Task("table", BASE + TABLE),
    Task("threshold", BASE + THRESHOLD),
    Task(
        "gearbox",
        GEARBOX,
        files=("scene.1st.rattle", "scene.1st.state", "scene.4th.rattle", "scene.4th.state"),
        stems=("scene.1st", "scene.4th"),
    ),
)


class Study:
    """The program, a folder to backlash in, and the score."""

    def __init__(self, program: Path, folder: Path, shim: Path, options: argparse.Namespace) -> None:
        self.program, self.folder, self.shim = program, folder, shim
        self.tries, self.every_call = options.tries, options.every_call
        self.results = folder / "results"
        self.random = random.Random(options.seed)
        self.tried: Counter[tuple[str, str]] = Counter()
        self.failed: Counter[tuple[str, str]] = Counter()

    # --- runs ------------------------------------------------------------------------------------------

    def call(self, *options: str, wait: bool = True, limit: int | None = None, **environment: str):
        """One run of the program on the input of the folder."""
        process = subprocess.Popen(
            [self.program, "--quiet", "--threads", "2", *options, "scene.nml"],
            cwd=self.folder,
            env={**os.environ, **environment},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            preexec_fn=None
            if limit is None
            else lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
        )
        if wait:
            process.wait(120)
            process.stderr.close()
        return process

    def lay_out(self, task: Task) -> None:
        """The folder as it is before a try."""
        shutil.rmtree(self.results, ignore_errors=True)
        self.results.mkdir(parents=True)
        for name, content in {**task.start, **FOREIGN}.items():
            (self.results / name).write_bytes(content)
        (self.folder / "scene.nml").write_text(task.text)

    def prepare(self, task: Task) -> None:
        """Find out what the task writes undisturbed, how long it takes, and how many calls it makes."""
        lines = [f"{5.0 + i},{0.5 + 0.01 * i}" for i in range(600)]
        head = "load.force_amplitude,kinematics.entrainment_speed\n"
        (self.folder / "table.csv").write_text(head + "\n".join(lines) + "\n")
        if task.earlier:
            self.lay_out(task)
            (self.folder / "scene.nml").write_text(task.earlier)
            assert self.call().returncode == 0
            task.start = {
                path.name: path.read_bytes() for path in self.results.iterdir() if path.name not in FOREIGN
            }
        self.lay_out(task)
        begun = time.perf_counter()
        assert self.call(*task.command).returncode == 0, task.name
        task.seconds = time.perf_counter() - begun
        task.expected = {name: (self.results / name).read_bytes() for name in (*task.files, *task.summaries)}
        self.lay_out(task)
        trace = self.folder / "trace"
        trace.unlink(missing_ok=True)
        assert self.call(*task.command, **self.fault("none", 0), FAULT_TRACE=str(trace)).returncode == 0
        task.trace = tuple(trace.read_text().splitlines())

    def fault(self, kind: str, at: int) -> dict[str, str]:
        return {
            "LD_PRELOAD": str(self.shim),
            "FAULT_FOLDER": "results/",
            "FAULT_KIND": kind,
            "FAULT_AT": str(at),
        }

    # --- judging ---------------------------------------------------------------------------------------

    def score(self, what: str, task: Task, faults: list[str], note: str = "") -> None:
        self.tried[what, task.name] += 1
        if faults:
            self.failed[what, task.name] += 1
            words = f"{what}, {task.name}{', ' + note if note else ''}: {'; '.join(faults)}"
            print(words, file=sys.stderr, flush=True)

    def complete(self, task: Task) -> list[str]:
        """Whether everything is there, to the last bit; of the summary what does not depend on the moment."""
        faults = []
        for name, content in task.expected.items():
            path = self.results / name
            if not path.exists():
                faults.append(f"{name} is missing")
            elif timeless(path.read_bytes(), task) != timeless(content, task):
                faults.append(f"{name} is not what it should be")
        return faults

    def kept(self, task: Task) -> list[str]:
        """Whether the earlier files are as they were, or complete new ones; and those of others unchanged."""
        faults = self.kept_foreign()
        for name, content in task.start.items():
            path = self.results / name
            # A summary goes before its result is replaced, and comes last.
            if name not in task.expected or (name.endswith(".nml") and not path.exists()):
                continue
            now = path.read_bytes() if path.exists() else b""
            if now != content and timeless(now, task) != timeless(task.expected[name], task):
                faults.append(f"the earlier {name} is lost")
        return faults

    def readable(self, task: Task) -> list[str]:
        """Whether what can be read of a result is part of what should be there."""
        return [fault for name in task.results for fault in self.readable_rows(task, name)]

    def readable_rows(self, task: Task, name: str) -> list[str]:
        path = self.results / name
        if not path.exists() or path.stat().st_size == 0:
            return []
        try:
            found, done = rows_of(path, task.is_campaign)
        except rattle.ResultError:
            return ["the result cannot be read"]
        candidates = [task.expected[name], task.start.get(name, b"")]
        for content in filter(None, candidates):
            beside = self.folder / "expected.rattle"
            beside.write_bytes(content)
            expected, _ = rows_of(beside, task.is_campaign)
            if (
                len(found) <= len(expected)
                and found[done].tobytes() == expected[: len(found)][done].tobytes()
            ):
                return []
        return ["rows that can be read are wrong"]

    def belongs(self) -> list[str]:
        """Whether a summary beside a result is the one of that result, and a table that of its pairs."""
        faults = []
        for path in self.results.glob("scene*.summary.nml"):
            try:
                rattle.read_summary(path)
            except rattle.SummaryError as fault:
                faults.append(str(fault))
        return faults

    def read_closed(self, task: Task) -> list[str]:
        """Whether every result is that of a run that has come to its end."""
        faults = []
        for name in task.results:
            try:
                closed = rattle.read(self.results / name).closed
            except rattle.ResultError as fault:
                faults.append(str(fault))
            else:
                faults += [] if closed else [f"{name} is not closed"]
        return faults

    def mended(self, task: Task) -> list[str]:
        """Whether the run can be carried on or begun anew, to the undisturbed result."""
        if self.call("--resume").returncode == 0:
            return [f"--resume: {fault}" for fault in self.complete(task) + self.kept_foreign()]
        if self.call("--overwrite").returncode == 0:
            return [f"--overwrite: {fault}" for fault in self.complete(task) + self.kept_foreign()]
        return ["neither --resume nor --overwrite mends it"]

    def kept_foreign(self) -> list[str]:
        changed = [name for name, content in FOREIGN.items() if (self.results / name).read_bytes() != content]
        return [f"the foreign {name} has changed" for name in changed]

    def after(self, task: Task, code: int) -> list[str]:
        """All that must hold after a run that a fault has met."""
        if code == 0:
            return self.complete(task) + self.belongs() + self.kept_foreign() + self.litter()
        faults = self.kept(task) + self.readable(task) + self.belongs()
        return faults + self.mended(task) + self.belongs() + self.litter()

    def litter(self) -> list[str]:
        left = [path.name for path in self.results.iterdir() if path.suffix in (".new", ".old", ".lock")]
        return [f"{name} is left behind" for name in left]

    # --- faults ----------------------------------------------------------------------------------------

    def kills(self, task: Task) -> None:
        """SIGKILL at random moments."""
        for _ in range(self.tries):
            self.lay_out(task)
            process = self.call(*task.command, wait=False)
            time.sleep(self.random.uniform(0.0, 1.1 * task.seconds))
            process.kill()
            code = process.wait(60)
            process.stderr.close()
            self.score("kill at a random moment", task, self.after(task, code))

    def full_disks(self, task: Task) -> None:
        """No file may grow beyond a random size."""
        largest = max(len(content) for content in task.expected.values())
        for _ in range(self.tries):
            self.lay_out(task)
            limit = int(largest * self.random.random() ** 2)
            code = self.call(*task.command, limit=limit).returncode
            faults = [] if code in (0, 2, 3) else [f"exit code {code}"]
            self.score("full disk", task, faults + self.after(task, code), f"{limit} bytes")

    def short_memory(self, task: Task) -> None:
        """No more memory than a random limit, from what the program needs to start on."""
        for _ in range(self.tries):
            self.lay_out(task)
            limit = int(LEAST_MEMORY * (MOST_MEMORY / LEAST_MEMORY) ** self.random.random())
            ended = subprocess.run(
                [self.program, "--quiet", "--threads", "2", *task.command, "scene.nml"],
                cwd=self.folder,
                capture_output=True,
                text=True,
                check=False,
                preexec_fn=lambda most=limit: resource.setrlimit(resource.RLIMIT_AS, (most, most)),
            )
            code = ended.returncode
            faults = [] if code in (0, 2, 3) else [f"exit code {code}: {ended.stderr[:200]}"]
            if code == 3 and not any(
                word in ended.stderr for word in ("memory", "threads", "Thread creation")
            ):
                faults.append(f"it says {ended.stderr[:200]}")
            self.score("little memory", task, faults + self.after(task, code), f"{limit} bytes")

    def failing_calls(self, task: Task) -> None:
        """A fault at every output call, or at as many of them as there are tries."""
        for what, kind in (
            ("a call fails", "error"),
            ("nothing can be written from a call on", "full"),
            ("half of a write", "short"),
            ("kill at a call", "kill"),
        ):
            numbers = range(1, task.calls + 1)
            if not self.every_call:
                numbers = self.random.sample(numbers, min(self.tries, task.calls))
            for number in numbers:
                self.lay_out(task)
                code = self.call(*task.command, **self.fault(kind, number)).returncode
                allowed = (0, 2, 3) if kind != "kill" else (-signal.SIGKILL, 0)
                faults = [] if code in allowed else [f"exit code {code}"]
                self.score(what, task, faults + self.after(task, code), f"call {number} of {task.calls}")

    def two_at_a_time(self, task: Task) -> None:
        """Two runs of the same input, the second some moment after the first."""
        for _ in range(self.tries):
            self.lay_out(task)
            processes = [self.call(*task.command, wait=False)]
            time.sleep(self.random.uniform(0.0, 1.1 * task.seconds) * self.random.choice((0.0, 0.1, 1.0)))
            processes.append(self.call("--resume", wait=False))
            codes = []
            for process in processes:
                codes.append(process.wait(120))
                process.stderr.close()
            faults = [f"exit codes {codes}"] if 0 not in codes or set(codes) - {0, 2, 3} else []
            self.score("two runs at a time", task, faults + self.after(task, 0), str(codes))

    def flips(self, task: Task) -> None:
        """One flipped bit in a file: reported, or nothing that is read has changed."""
        written = Counter(kind_of(name) for other in TASKS for name in (*other.files, *other.summaries))
        for name in (*task.files, *task.summaries):
            # Kinds of files that few tasks write are tried as often as the others.
            kind = kind_of(name)
            for _ in range(-(-self.tries * len(TASKS) // written[kind])):
                self.lay_out(task)
                for other, content in task.expected.items():
                    (self.results / other).write_bytes(content)
                content = bytearray(task.expected[name])
                # Every second flip goes to the header, where a small part of a large file stands.
                end = len(content) if self.random.random() < 0.5 else min(len(content), 2048)
                place = self.random.randrange(end)
                content[place] ^= 1 << self.random.randrange(8)
                (self.results / name).write_bytes(content)
                faults = self.read_after_flip(task, name)
                if name.removesuffix("rattle") + "state" in task.files or name.endswith("state"):
                    faults += self.resume_after_flip(task)
                self.score(f"flipped bit, {kind}", task, faults, f"byte {place} of {name}")

    def read_after_flip(self, task: Task, name: str) -> list[str]:
        path = self.results / name
        # Alone in its folder: a summary is compared with the result beside it.
        beside = self.folder / "sound" / name
        shutil.rmtree(beside.parent, ignore_errors=True)
        beside.parent.mkdir()
        beside.write_bytes(task.expected[name])
        try:
            if name.endswith(".nml"):
                changed = rattle.read_summary(path) != rattle.read_summary(beside)
            else:
                changed = facts_of(path, task.is_campaign) != facts_of(beside, task.is_campaign)
        except (rattle.ResultError, rattle.SummaryError):
            return []
        return ["what is read has changed without a word"] if changed else []

    def resume_after_flip(self, task: Task) -> list[str]:
        code = self.call("--resume").returncode
        if code == 0:
            return self.complete(task)
        if code != 2:
            return [f"exit code {code} of --resume"]
        return self.mended(task)

    def foreign_files(self, task: Task) -> None:
        """A file of somebody else at a name that the run would write."""
        names = [*task.expected, *(f"{stem}.{kind}" for stem in task.stems for kind in ("log", "lock"))]
        names += ["scene.progress.nml"] if task.is_campaign else []
        for number in range(self.tries):
            self.lay_out(task)
            name = names[number % len(names)]
            mine = self.random.randbytes(self.random.randrange(1, 400))
            (self.results / name).write_bytes(mine)
            option = self.random.choice(([], ["--resume"], ["--overwrite"]))
            code = self.call(*option).returncode
            faults = [] if (self.results / name).read_bytes() == mine else [f"the foreign {name} has changed"]
            faults += [] if code == 2 else [f"exit code {code}"]
            self.score("foreign file in the way", task, faults + self.kept_foreign())

    def finished(self, task: Task) -> None:
        """The folder once the task is done."""
        self.lay_out(task)
        for name, content in task.expected.items():
            (self.results / name).write_bytes(content)

    def edit(self, task: Task) -> str:
        """Change one value of the input; the key."""
        given = self.random.choice([edit for edit in EDITS if edit in task.text])
        key, value = given.split(" = ")
        edited = f"{float(value) * self.random.uniform(0.8, 1.2):.6g}"
        (self.folder / "scene.nml").write_text(task.text.replace(given, f"{key} = {edited}"))
        return key

    def edited_inputs(self, task: Task) -> None:
        """--resume of an edited input over a finished result, whole or without some of its files."""
        for _ in range(self.tries):
            self.finished(task)
            lost = self.random.choice(
                ([], states(task), list(task.summaries), [*states(task), *task.summaries])
            )
            for name in lost:
                (self.results / name).unlink(missing_ok=True)
            before = {path.name: path.read_bytes() for path in self.results.iterdir()}
            key = self.edit(task)
            ended = self.reported("--resume")
            faults = [] if ended.returncode == 2 else [f"exit code {ended.returncode}"]
            faults += [] if f"{key} is " in ended.stderr else [f"it says {ended.stderr[:200]}"]
            after = {path.name: path.read_bytes() for path in self.results.iterdir()}
            faults += [] if before == after else ["the finished files have changed"]
            self.score("edited input, --resume", task, faults, key)

    def reported(self, *options: str, **environment: str) -> subprocess.CompletedProcess[str]:
        """One run with its words."""
        return subprocess.run(
            [self.program, "--quiet", "--threads", "2", *options, "scene.nml"],
            cwd=self.folder,
            env={**os.environ, **environment},
            capture_output=True,
            text=True,
            check=False,
            timeout=120,
        )

    def renames(self, task: Task) -> None:
        """A kill at or behind a rename of a run that replaces the finished files of another input."""
        near = [number for number, call in enumerate(task.trace, 1) if call.startswith("rename")]
        for _ in range(self.tries):
            self.finished(task)
            self.edit(task)
            # An overwriting run has a rename more: that of the summary that goes first.
            number = self.random.choice(near) + self.random.randrange(4)
            code = self.call("--overwrite", **self.fault("kill", number)).returncode
            faults = [] if code in (-signal.SIGKILL, 0) else [f"exit code {code}"]
            faults += self.belongs() + self.kept_foreign()
            for name in task.results:
                try:
                    rows_of(self.results / name, task.is_campaign)
                except rattle.ResultError as fault:
                    faults.append(str(fault))
            if self.call("--overwrite").returncode != 0:
                faults.append("--overwrite does not mend it")
            faults += self.belongs() + self.litter()
            self.score("kill between renames", task, faults, f"call {number}")

    def taken_away(self, task: Task) -> None:
        """Result or folder are removed at a random call: the run says so, or ends before."""
        lines = sorted({line for line in task.trace if ".lock" not in line})
        for _ in range(self.tries):
            self.lay_out(task)
            line, whole = self.random.choice(lines), self.random.random() < 0.5
            # Of a gearbox the pair goes that the call is about: another may have come to its end.
            at = [stem for stem in task.stems if f" {stem}." in line]
            whole = whole or not at
            process = self.call(*task.command, wait=False, **self.fault("none", 0), FAULT_WAIT=line)
            waiting = self.results / "waiting"
            while process.poll() is None and not waiting.exists():
                time.sleep(0.002)
            if whole:
                gone = self.folder / "gone"
                shutil.rmtree(gone, ignore_errors=True)
                self.results.rename(gone)
            else:
                for path in self.results.glob(f"{at[0]}.rattle*"):
                    if path.name not in FOREIGN:
                        path.unlink()
            waiting.unlink(missing_ok=True)
            words = process.stderr.read().decode()
            code = process.wait(120)
            process.stderr.close()
            there = all((self.results / name).exists() for name in task.expected)
            faults = [] if code in (2, 3) or (code == 0 and there) else [f"exit code {code}"]
            # After the last rename a run has nothing more to lose.
            if code == 0 and not there and line.endswith(".log"):
                faults = []
            faults += [] if code == 0 or "scene" in words else [f"it says {words[:200]}"]
            self.results.mkdir(exist_ok=True)
            for name, content in FOREIGN.items():
                (self.results / name).write_bytes(content)
            if self.call("--resume").returncode != 0 and self.call("--overwrite").returncode != 0:
                faults.append("neither --resume nor --overwrite mends it")
            self.score("taken away", task, faults + self.complete(task) + self.belongs(), f"{line}, {code}")

    def links(self, task: Task) -> None:
        """A link at a name that the run would write, to nothing, a file of any kind, a folder."""
        names = [*task.expected, *(f"{stem}.{kind}" for stem in task.stems for kind in ("log", "lock"))]
        for number in range(self.tries):
            self.lay_out(task)
            name = names[number % len(names)]
            elsewhere = self.folder / "elsewhere"
            if elsewhere.is_dir():
                shutil.rmtree(elsewhere)
            elsewhere.unlink(missing_ok=True)
            kind = self.random.choice(("nothing", "same", "foreign", "folder"))
            if kind == "folder":
                elsewhere.mkdir()
            elif kind != "nothing":
                elsewhere.write_bytes(task.expected.get(name, b"rattle log") if kind == "same" else b"mine\n")
            before = elsewhere.read_bytes() if elsewhere.is_file() else None
            (self.results / name).unlink(missing_ok=True)
            (self.results / name).symlink_to(elsewhere)
            ended = self.reported(*self.random.choice(([], ["--resume"], ["--overwrite"])))
            faults = [] if ended.returncode == 2 else [f"exit code {ended.returncode}"]
            faults += [] if "is a link" in ended.stderr else [f"it says {ended.stderr[:200]}"]
            after = elsewhere.read_bytes() if elsewhere.is_file() else None
            faults += (
                [] if after == before and elsewhere.exists() == (kind != "nothing") else ["it was followed"]
            )
            faults += [] if (self.results / name).is_symlink() else ["the link has changed"]
            self.score("link in the way", task, faults + self.kept_foreign(), f"{name} to {kind}")

    def no_locks(self, task: Task) -> None:
        """Two runs at a time where the file system has no locks; every second time of two inputs."""
        unlocked = {"LD_PRELOAD": str(self.shim), "FAULT_FLOCK": str(errno.ENOLCK)}
        for number in range(self.tries):
            self.lay_out(task)
            processes = [self.call(*task.command, wait=False, **unlocked)]
            time.sleep(self.random.uniform(0.0, 1.1 * task.seconds))
            if number % 2:
                self.edit(task)
            processes.append(self.call("--overwrite" if number % 2 else "--resume", wait=False, **unlocked))
            codes, words = [], ""
            for process in processes:
                words += process.communicate(timeout=120)[1].decode()
                codes.append(process.returncode)
            faults = [f"exit codes {codes}: {words}"] if 0 not in codes or set(codes) - {0, 2, 3} else []
            faults += self.belongs() + self.kept_foreign() + self.read_closed(task)
            if self.call("--overwrite").returncode != 0:
                faults.append("--overwrite does not mend it")
            self.score("two runs without locks", task, faults + self.belongs() + self.litter(), str(codes))

    def signals(self, task: Task) -> None:
        """SIGHUP, SIGXCPU or SIGTERM at a random call; --resume goes on to the undisturbed bytes."""
        for _ in range(self.tries):
            self.lay_out(task)
            number = self.random.choice((signal.SIGHUP, signal.SIGXCPU, signal.SIGTERM))
            at = self.random.randrange(1, task.calls + 1)
            code = self.call(
                *task.command, **self.fault("signal", at), FAULT_SIGNAL=str(int(number))
            ).returncode
            faults = [] if code in (0, 128 + number) else [f"exit code {code}"]
            faults += self.belongs() + self.kept_foreign() + self.litter()
            # A queue may end a job again and again.
            for _ in range(self.random.choice((0, 0, 4))):
                at = self.random.randrange(1, task.calls + 1)
                again = self.call("--resume", **self.fault("signal", at), FAULT_SIGNAL=str(int(number)))
                faults += (
                    [] if again.returncode in (0, 128 + number) else [f"then exit code {again.returncode}"]
                )
                faults += self.belongs()
            if self.call("--resume").returncode != 0:
                faults.append("--resume does not go on")
            faults += self.complete(task) + self.belongs()
            self.score("signal of a batch system", task, faults, f"{number.name} at call {at}")

    def scripts(self, task: Task) -> None:
        """Scripts that would write over a file of somebody else beside the result, its input among them."""
        stem = task.stems[0]
        calls = (("export.py", f"{stem}.csv"), ("report.py", "report.html"), ("export.py", f"{stem}.nc"))
        for _ in range(self.tries):
            self.finished(task)
            script, name = self.random.choice(calls[:1] if self.random.random() < 0.8 else calls)
            mine = self.random.randbytes(self.random.randrange(1, 400))
            (self.results / name).write_bytes(mine)
            before = {path.name for path in self.results.iterdir()}
            given = ["--output", str(self.results / name)] if script == "report.py" else []
            given += ["--to", "netcdf"] if name.endswith(".nc") else []
            code = script_here(script, str(self.results / task.results[0]), *given)
            faults = [] if code == 2 else [f"exit code {code}"]
            faults += [] if (self.results / name).read_bytes() == mine else [f"{name} has changed"]
            names = {path.name for path in self.results.iterdir()}
            faults += [] if names == before else [f"it left {sorted(names - before)}"]
            self.score("script over a file", task, faults + self.kept_foreign(), name)

    def failing_locks(self, task: Task) -> None:
        """A lock fails for a reason of its own: nothing runs, and the reason is named."""
        for _ in range(self.tries):
            self.random.choice((self.lay_out, self.finished))(task)
            before = {path.name: path.read_bytes() for path in self.results.iterdir()}
            cause = self.random.choice(LOCK_ERRORS)
            ended = self.reported("--overwrite", LD_PRELOAD=str(self.shim), FAULT_FLOCK=str(cause))
            faults = [] if ended.returncode == 3 else [f"exit code {ended.returncode}"]
            reported = f"cannot be locked: {os.strerror(cause)}" in ended.stderr
            faults += [] if reported else [f"it says {ended.stderr[:200]}"]
            after = {path.name: path.read_bytes() for path in self.results.iterdir()}
            faults += (
                [] if all(after.get(name) == content for name, content in before.items()) else ["it wrote"]
            )
            if self.call("--overwrite").returncode != 0:
                faults.append("--overwrite does not mend it")
            self.score("a lock fails", task, faults + self.complete(task) + self.litter(), os.strerror(cause))

    def unreadable(self, task: Task) -> None:
        """A file of an earlier run may not be read: this is reported. Root, who may all, is nobody here."""
        program = self.folder / "rattle"
        shutil.copy(self.program, program)
        as_nobody = {"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.geteuid() == 0 else {}
        for _ in range(self.tries):
            self.finished(task)
            self.results.chmod(0o777)
            name = self.random.choice([*task.expected])
            (self.results / name).chmod(0)
            ended = subprocess.run(
                [program, "--quiet", self.random.choice(("--resume", "--overwrite")), "scene.nml"],
                cwd=self.folder,
                capture_output=True,
                text=True,
                check=False,
                **as_nobody,
            )
            faults = [] if ended.returncode == 2 else [f"exit code {ended.returncode}"]
            faults += (
                []
                if f"{name} exists and may not be read" in ended.stderr
                else [f"it says {ended.stderr[:200]}"]
            )
            (self.results / name).chmod(0o644)
            self.score("may not be read", task, faults + self.complete(task) + self.belongs(), name)

    def callers(self, task: Task) -> None:
        """A script that calls the solver is interrupted: the solver ends with it, and --resume goes on."""
        environment = {**os.environ, "RATTLE_PROGRAM": str(self.program)}
        command = [sys.executable, "-c", CALLER, str(HERE.parents[1] / "scripts"), *task.command]
        for _ in range(self.tries):
            self.lay_out(task)
            number = self.random.choice((signal.SIGINT, signal.SIGTERM))
            process = subprocess.Popen(command, cwd=self.folder, env=environment, stderr=subprocess.DEVNULL)
            lock = self.results / f"{task.stems[0]}.lock"
            while process.poll() is None and not lock.exists():
                time.sleep(0.002)
            time.sleep(self.random.uniform(0.0, task.seconds))
            process.send_signal(number)
            process.wait(120)
            faults = self.belongs() + self.kept_foreign()
            ended = self.reported("--resume")
            faults += [] if ended.returncode == 0 else [f"--resume: {ended.stderr[:200]}"]
            self.score(
                "a script is interrupted", task, faults + self.complete(task) + self.litter(), number.name
            )

    def leavings(self, task: Task) -> None:
        """What a killed run has left is read by every script: each does its work or says why not."""
        for _ in range(self.tries):
            self.lay_out(task)
            at = self.random.randrange(1, task.calls + 1)
            self.call(*task.command, **self.fault("kill", at))
            place = self.folder / "made"
            shutil.rmtree(place, ignore_errors=True)
            faults = []
            for path in sorted(self.results.glob("scene*.rattle")):
                script = self.random.choice(("export.py", "report.py"))
                file = place / ("made.csv" if script == "export.py" else "made.html")
                place.mkdir(exist_ok=True)
                try:
                    code = script_here(script, str(path), "--overwrite", "--output", str(file))
                except Exception as fault:
                    faults.append(f"{script} of {path.name} breaks: {fault!r}")
                else:
                    faults += [] if code in (0, 1, 2) else [f"exit code {code} of {script}"]
            self.score("scripts on what is left", task, faults + self.mended(task), f"kill at call {at}")

    def merges(self, task: Task) -> None:
        """A part is missing, another input's, cut short or damaged when parts are joined."""
        if not (task.is_campaign or task.name == "threshold"):
            return
        self.lay_out(task)
        parts = 3
        for part in range(1, parts + 1):
            given = ("--set", f"campaign.part={part}", "--set", f"campaign.parts={parts}")
            assert self.call(*given).returncode == 0
        self.edit(task)
        # Some scenes of the edited input may fail.
        assert self.call("--output", "other", "--overwrite", *given).returncode in (0, 1)
        (self.folder / "scene.nml").write_text(task.text)
        names = [f"scene.part-{part}-of-{parts}.rattle" for part in range(1, parts + 1)]
        sound = {name: (self.results / name).read_bytes() for name in names}
        other = (self.folder / "other" / names[-1]).read_bytes()
        for _ in range(self.tries):
            for name, content in sound.items():
                (self.results / name).write_bytes(content)
            output = self.results / "scene.rattle"
            kind, chosen = self.random.choice(("missing", "another", "short", "damaged")), list(names)
            if kind == "missing":
                chosen.pop(self.random.randrange(parts))
            elif kind == "another":
                (self.results / names[-1]).write_bytes(other)
            else:
                name = self.random.choice(names)
                content = bytearray(sound[name])
                if kind == "short":
                    content = content[: self.random.randrange(1, len(content))]
                else:
                    content[self.random.randrange(128)] ^= 1 << self.random.randrange(8)
                (self.results / name).write_bytes(content)
            self.random.shuffle(chosen)
            faults = []
            try:
                merge([self.results / name for name in chosen], output)
            except (CommandError, rattle.ResultError):
                faults += ["a file is left"] if output.exists() else []
            else:
                # Bits that nothing hangs on may be damaged; all else is reported.
                same = output.read_bytes() == task.expected["scene.rattle"]
                faults += [] if kind == "damaged" and same else ["they were joined"]
                output.unlink()
            faults += self.litter()
            self.score("part missing at merge", task, faults, kind)

    def table(self) -> Iterator[str]:
        tasks = [task.name for task in TASKS]
        yield "| fault | " + " | ".join(tasks) + " | tried | failed |"
        yield "|---|" + "---:|" * (len(tasks) + 2)
        for what in dict.fromkeys(what for what, _ in self.tried):
            cells = [str(self.tried[what, task] or "") for task in tasks]
            tried = sum(self.tried[what, task] for task in tasks)
            failed = sum(self.failed[what, task] for task in tasks)
            yield f"| {what} | {' | '.join(cells)} | {tried} | {failed} |"
        yield f"| **all** | {' | ' * (len(tasks) - 1)} | {self.tried.total()} | **{self.failed.total()}** |"


def states(task: Task) -> list[str]:
    """Names of the states that a task keeps, or may keep."""
    return [f"{stem}.state" for stem in task.stems]


def kind_of(name: str) -> str:
    """What kind of file it is, of whatever scene: the name without that of the scene."""
    return re.sub(r"^scene\.(\d\w\w\.)?", "", name)


def script_here(script: str, *arguments: str) -> int:
    """Run a script of the package within this Python; its exit code."""
    own, handler = sys.argv, signal.getsignal(signal.SIGTERM)
    sys.argv = [script, *arguments]
    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            runpy.run_path(str(HERE.parents[1] / "scripts" / script), run_name="__main__")
    except SystemExit as left:
        return int(left.code or 0)
    finally:
        sys.argv = own
        signal.signal(signal.SIGTERM, handler)
    return 0


def timeless(content: bytes, task: Task) -> bytes:
    """A file without what differs from run to run: times, and counts of a single run of a campaign."""
    if not content.startswith(b"&summary"):
        return content
    words = rb"wall_seconds|checksum|_in_this_run" if task.is_campaign else rb"wall_seconds|checksum"
    return re.sub(rb"(?m)^.*(" + words + rb").*$", b"", content)


def rows_of(path: Path, is_campaign: bool) -> tuple[np.ndarray, np.ndarray]:
    """Rows that can be read, and which of them count."""
    if is_campaign:
        campaign = rattle.read_campaign(path)
        rows = np.array(campaign.rows)
        return rows, campaign.done[: len(rows)]
    result = rattle.read(path)
    rows = np.column_stack([np.array(result[name]) for name in result.names])
    return rows, np.ones(len(rows), dtype=bool)


def facts_of(path: Path, is_campaign: bool) -> tuple:
    """All that a reader gives."""
    rows, done = rows_of(path, is_campaign)
    if is_campaign:
        read = rattle.read_campaign(path)
        more = ()
    else:
        read = rattle.read(path)
        more = (read.coarse, *(read.extremes[name].tobytes() for name in read.names))
    words = (read.names, tuple(read.units.values()), read.input_text, read.program_version, read.closed)
    return (rows.tobytes(), done.tobytes(), *words, *more)


FAULTS: dict[str, Callable[[Study, Task], None]] = {
    "kills": Study.kills,
    "disks": Study.full_disks,
    "memory": Study.short_memory,
    "calls": Study.failing_calls,
    "pairs": Study.two_at_a_time,
    "flips": Study.flips,
    "foreign": Study.foreign_files,
    "edited": Study.edited_inputs,
    "renames": Study.renames,
    "taken": Study.taken_away,
    "links": Study.links,
    "unlocked": Study.no_locks,
    "signals": Study.signals,
    "scripts": Study.scripts,
    "merges": Study.merges,
    "locks": Study.failing_locks,
    "unreadable": Study.unreadable,
    "callers": Study.callers,
    "leavings": Study.leavings,
}


def main() -> None:
    options = parse_options()
    folder = options.folder.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shim = folder / "inject_faults.so"
    subprocess.run(
        ["gcc", "-O1", "-shared", "-fPIC", "-o", shim, HERE / "inject_faults.c", "-ldl"], check=True
    )
    study = Study(options.program.resolve(), folder, shim, options)
    try:
        for task in TASKS:
            if task.name not in options.tasks:
                continue
            study.prepare(task)
            for name in options.only:
                FAULTS[name](study, task)
                print(
                    f"{task.name}: {name}, {study.failed.total()} failed so far", file=sys.stderr, flush=True
                )
    except KeyboardInterrupt:
        print("cut short: what was tried so far", file=sys.stderr)
    print("\n".join(study.table()))
    sys.exit(study.failed.total() > 0)


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path, help="the program, build/rattle")
    parser.add_argument("folder", type=Path, help="folder to backlash in; it is emptied first")
    parser.add_argument("--tries", type=int, default=16, help="tries of each fault and task (16)")
    parser.add_argument("--every-call", action="store_true", help="a fault at every output call, not at some")
    parser.add_argument("--seed", type=int, default=1, help="of the random choices (1)")
    parser.add_argument("--only", nargs="+", choices=list(FAULTS), default=list(FAULTS), help="faults to try")
    names = [task.name for task in TASKS]
    parser.add_argument("--tasks", nargs="+", choices=names, default=names, help="tasks to try them on")
    return parser.parse_args()


if __name__ == "__main__":
    main()
