"""The command line as users run it: in a process of its own, with limits, signals and broken streams."""

import os
import pathlib
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TextIO

_MAIN = "import sys, warnings; from mjbeer.cli.app import main; sys.exit(main())"
SHORT = f"import pytest; from tests.support import stubs; stubs.benchmark(pytest.MonkeyPatch()); {_MAIN}"
"""With a benchmark of short ladders."""
_CHECKOUT = pathlib.Path(__file__).parents[2]
_PATIENCE = 60


def start(
    words: Sequence[str],
    code: str = _MAIN,
    env: Mapping[str, str] = os.environ,
    stdout: int | TextIO | None = subprocess.PIPE,
    stderr: int | TextIO = subprocess.PIPE,
    preexec_fn: Callable[[], None] | None = None,
) -> subprocess.Popen[str]:
    """Start Python's `code`, by default `mjbeer`, with some words, in a session of its own, as a terminal does.

    No signal is ignored in it, even if whoever runs the tests ignores some; `preexec_fn` comes after that.
    """

    def prepare() -> None:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        if preexec_fn is not None:
            preexec_fn()

    code = f"import sys; sys.path.append({str(_CHECKOUT)!r}); {code}"
    return subprocess.Popen(
        [sys.executable, "-P", "-c", code, *words],
        start_new_session=True,
        text=True,
        env=env,
        stdout=stdout,
        stderr=stderr,
        preexec_fn=prepare,  # noqa: PLW1509 - it makes system calls only
    )


def run(words: Sequence[str], *settings: Any, **streams: Any) -> tuple[int, str, str]:
    """Exit status, standard output and standard error of what `start` starts with the same arguments."""
    with start(words, *settings, **streams) as process:
        out, err = process.communicate(timeout=_PATIENCE)
    return process.returncode, out or "", err or ""


def interrupt(
    process: subprocess.Popen[str], when: Callable[[], object], *numbers: int, everybody: bool = True
) -> tuple[int, str]:
    """Send signals as soon as `when` is true, to all of its processes or to it alone; exit status and last words."""
    end, send = time.monotonic() + _PATIENCE, os.killpg if everybody else os.kill
    while not when():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end
        time.sleep(0.02)
    for number in numbers:
        send(process.pid, number)
        time.sleep(0.3)
    try:
        _, err = process.communicate(timeout=_PATIENCE / 2)
    except subprocess.TimeoutExpired:
        # Python forgets an interrupt that arrives while it clears a lock of its imports; one would press again.
        send(process.pid, numbers[-1])
        _, err = process.communicate(timeout=_PATIENCE)
    return process.returncode, err


def little_disk() -> None:
    """Let no file become longer than 4 KiB, as if the disk were full; ffmpeg is even killed for it."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # Python does the same
