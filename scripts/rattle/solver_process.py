"""The program as a process of its own, which never outlives the Python that waits for it unseen."""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import FrameType

END_WITH_PARENT = 1  # PR_SET_PDEATHSIG of Linux
# Signals that end a process which does not ask for them, and that a solver answers by saving its state.
ENDING = (signal.SIGTERM, signal.SIGHUP)


def solve(command: Sequence[str], settings: Sequence[str], text: str) -> subprocess.CompletedProcess[str]:
    """Run the program to its end, with settings 'group.key=value' and the text of its standard input.

    Settings go by a file that has no name, since a system takes arguments of so many bytes only. All words
    are bytes of file names, so that names of any encoding come back as they are.

    A signal that would end this process is handed to the program, which saves its state; this process ends
    when the program has.
    """
    with tempfile.TemporaryFile() as listed:
        listed.write("".join(f"{setting}\n" for setting in settings).encode("utf-8", "surrogateescape"))
        listed.flush()
        listed.seek(0)
        given = ["--set", f"@/dev/fd/{listed.fileno()}"] if settings else []
        with _handed_on() as hand_to:
            process = subprocess.Popen(
                [command[0], *given, *command[1:]],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                pass_fds=(listed.fileno(),),
                preexec_fn=_ending_with_parent(),
            )
            hand_to(process)
            said, complained = _talk(process, text.encode("utf-8", "surrogateescape"))
    return subprocess.CompletedProcess(
        process.args, process.returncode, os.fsdecode(said), os.fsdecode(complained)
    )


def _talk(process: subprocess.Popen[bytes], text: bytes) -> tuple[bytes, bytes]:
    """What the program says. An interruption goes on to it; a second one does not wait for its state."""
    try:
        return process.communicate(text)
    except BaseException:
        try:
            process.send_signal(signal.SIGINT)
            process.communicate()
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()
        raise


def _ending_with_parent() -> Callable[[], None] | None:
    """What makes the program end, with its state, when this process is killed; only Linux knows how."""
    if not sys.platform.startswith("linux"):
        return None
    control, parent = ctypes.CDLL(None).prctl, os.getpid()

    def ask() -> None:
        control(END_WITH_PARENT, int(signal.SIGTERM))
        if os.getppid() != parent:
            os._exit(128 + signal.SIGTERM)

    return ask


@contextmanager
def _handed_on() -> Iterator[Callable[[subprocess.Popen[bytes]], None]]:
    """Hand signals that would end this process to the program, and end once the program has.

    What is given takes the program. A signal that comes while it is being started is handed on then.
    """
    caught: list[int] = []
    running: list[subprocess.Popen[bytes]] = []

    def hand_on(number: int, _: FrameType | None) -> None:
        caught.append(number)
        for process in running:
            process.send_signal(number)

    def hand_to(process: subprocess.Popen[bytes]) -> None:
        running.append(process)
        for number in caught:
            process.send_signal(number)

    if threading.current_thread() is not threading.main_thread():
        yield hand_to  # the handlers are those of the main thread
        return
    ours = [number for number in ENDING if signal.getsignal(number) is signal.SIG_DFL]
    for number in ours:
        signal.signal(number, hand_on)
    try:
        yield hand_to
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)
        if caught:
            raise Ended(caught[0])


class Ended(SystemExit):
    """This process was asked to end; whoever catches it tidies up first. `number` is the signal."""

    def __init__(self, number: int) -> None:
        super().__init__(128 + number)
        self.number = number
