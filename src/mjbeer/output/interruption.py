"""What a command does when it is told to end: it unwinds at the first signal, and is gone at the second."""

import os
import signal
import threading
from collections.abc import Callable, Generator
from contextlib import contextmanager
from types import FrameType

SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""Ctrl-C, `kill`, and a terminal that is closed."""
_undone: list[Callable[[], object]] = []


class Interrupted(KeyboardInterrupt):
    """A signal asked this command to end; its number is what shells add 128 to."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.status = 128 + number


@contextmanager
def heeded() -> Generator[None]:
    """Raise `Interrupted` at the first signal; at the second, undo what is half done and end this process at once.

    So whoever presses Ctrl-C twice never waits for a cleanup, and it is done all the same. A signal that is ignored,
    as SIGHUP under nohup, stays so. Other threads than the main one hear of no signals.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard: list[int] = []

    def handle(number: int, _: FrameType | None) -> None:
        if heard:
            undo()
            os._exit(128 + heard[0])
        heard.append(number)
        raise Interrupted(number)

    before = {each: signal.getsignal(each) for each in SIGNALS}
    taken = [each for each, handler in before.items() if handler != signal.SIG_IGN]
    try:
        for each in taken:
            signal.signal(each, handle)
        yield
    finally:
        for each in taken:
            signal.signal(each, before[each])


@contextmanager
def undoing(what: Callable[[], object]) -> Generator[None]:
    """Call `what` when the block ends, however it does, a second signal included. It may be called twice."""
    _undone.append(what)
    try:
        yield
    finally:
        try:
            what()
        finally:
            _undone.remove(what)


def undo() -> None:
    """Undo now whatever is half done, the latest first."""
    for each in reversed(_undone):
        each()


@contextmanager
def withheld() -> Generator[None]:
    """Let a process that is started in the block hear none of the signals.

    A terminal's Ctrl-C goes to all processes of a command, and one that ended first would look like the fault.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
