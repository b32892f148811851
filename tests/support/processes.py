"""The command line as users run it: in a process of its own, with signals and broken streams.

Nothing here waits for a time: a process says on standard output that it has come to a place, and
stays there. At the end is what processes of a study are given to do: each of them loads this module
anew, and fast.
"""

import contextlib
import os
import pathlib
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Generator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TextIO

if TYPE_CHECKING:
    from mjbeer import Trajectory

PATIENCE = 600.0
"""Time after which a process is taken to hang [s]: a guard, which no machine is slow enough to
meet."""
_MAIN = "import sys; from mjbeer.cli.app import main; sys.exit(main())"
_CHECKOUT = pathlib.Path(__file__).parents[2]


@contextlib.contextmanager
def start(
    words: Sequence[str],
    code: str = _MAIN,
    env: Mapping[str, str] = os.environ,
    stdout: int | TextIO | None = subprocess.PIPE,
    preexec_fn: Callable[[], None] | None = None,
) -> Generator[subprocess.Popen[str]]:
    """Start Python's `code`, by default `mjbeer`, with some words, in a session of its own, as a
    terminal does.

    No signal is ignored in it, even if whoever runs the tests ignores some; `preexec_fn` comes
    after that. At the end of the block, however it ends, all processes of the session are gone.
    """

    def prepare() -> None:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        if preexec_fn is not None:
            preexec_fn()

    command = [
        sys.executable,
        "-P",
        "-c",
        f"import sys; sys.path.append({str(_CHECKOUT)!r}); {code}",
        *words,
    ]
    with subprocess.Popen(
        command,
        start_new_session=True,
        text=True,
        env=env,
        stdout=stdout,
        stderr=subprocess.PIPE,
        preexec_fn=prepare,  # noqa: PLW1509 - it makes system calls only
    ) as process:
        try:
            yield process
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)


def run(words: Sequence[str], *settings: Any, **streams: Any) -> tuple[int, str, str]:
    """Exit status, standard output and standard error of what `start` starts with the same
    arguments."""
    with start(words, *settings, **streams) as process:
        out, err = process.communicate(timeout=PATIENCE)
    return process.returncode, out or "", err


def hear(process: subprocess.Popen[str], word: str) -> None:
    """Wait until a process says a word, on a line of its own."""
    assert process.stdout is not None
    assert f"{word}\n" in process.stdout, process.communicate()[1]


def interrupt(
    process: subprocess.Popen[str], *numbers: int, everybody: bool = True
) -> tuple[int, str]:
    """Send signals to all of its processes or to it alone; exit status and last words."""
    send = os.killpg if everybody else os.kill
    for number in numbers:
        send(process.pid, number)
    _, err = process.communicate(timeout=PATIENCE)
    return process.returncode, err


def where() -> dict[str, Any]:
    """Return in which process this is."""
    return {"process": os.getpid()}


def highest(trajectory: "Trajectory") -> float:
    """Return the largest phi of a motion [rad], as a quantity of a sweep."""
    return float(trajectory.phi.max())


def work_and_sleep() -> dict[str, Any]:
    """Say so, and work for longer than any test."""
    print("at work", flush=True)
    time.sleep(3600)
    return {}


def hang_in_a_program() -> None:
    """Start a program that hangs and ignores signals, and wait for it.

    The program says when it is there.
    """
    subprocess.run(["sh", "-c", "trap '' INT TERM; echo at work; exec sleep 3600"], check=True)


def sleep(*_: object) -> None:
    """Work for longer than any test, and say nothing."""
    time.sleep(3600)


def two_that_sleep(_: object) -> None:
    """Run two jobs in processes that work for longer than any test, and say so."""
    from mjbeer.output.jobs import Job, run_jobs

    run_jobs([Job("one", work_and_sleep), Job("other", work_and_sleep)], None)


class EndlessPlot(NamedTuple):
    """A plot that takes longer than any test to draw."""

    path: pathlib.Path

    def write(self) -> None:
        """Begin the plot, and say so."""
        from mjbeer.output import files

        with files.atomic_write(self.path.with_name(f"{self.path.name}.svg")):
            print("drawing", flush=True)
            time.sleep(3600)


def fall() -> dict[str, Any]:
    """End the process as from outside."""
    os.kill(os.getpid(), signal.SIGKILL)
    return {}
