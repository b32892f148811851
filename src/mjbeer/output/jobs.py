"""Jobs for other processes, one on every core: their results, failures and interruption."""

import itertools
import multiprocessing
import os
import signal
import threading
import warnings
from collections.abc import Callable, Generator, Iterable, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    wait,
)
from contextlib import closing, contextmanager
from dataclasses import dataclass
from multiprocessing.process import BaseProcess
from typing import Any, NamedTuple

from rich.console import Console

from mjbeer.output.terminal import progress_bar


@dataclass(frozen=True, eq=False)
class Job:
    """A piece of work."""

    name: str
    """What an error and the progress bar call it."""
    work: Callable[[], Any]
    """The function that does it. For another process, it and its result must be picklable."""


class Finished(NamedTuple):
    """A job that is finished, and what it returned."""

    job: Job
    result: Any


def run_jobs(jobs: Sequence[Job], console: Console | None) -> list[Any]:
    """Run jobs, and return their results in the order of the jobs.

    Raises:
      OSError: if the system ends one of the processes.
      Exception: what a job raises, with a note that names the job.
    """
    results: dict[Job, Any] = {}
    with closing(finished_jobs(jobs, console)) as finished:
        results.update(finished)
    return [results[job] for job in jobs]


def finished_jobs(jobs: Sequence[Job], console: Console | None) -> Generator[Finished]:
    """Run jobs in a process for each core, or in this one for a single job; yield each at its end.

    The jobs begin in their order, without warnings, and `console` shows a progress bar. If the
    generator is closed, or ended by an error or an interruption, all processes end at once, and so
    do the processes that they have started.

    Raises:
      OSError: if the system ends one of the processes.
      Exception: what a job raises, with a note that names the job.
    """
    processes = min(os.cpu_count() or 1, len(jobs))
    with progress_bar(console, len(jobs)) as advance:
        if processes <= 1:
            for job in jobs:
                advance(job.name)
                with _naming(job), warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    result = job.work()
                yield Finished(job, result)
            return
        with (
            pool(processes) as executor,
            closing(as_finished(jobs, executor, processes)) as finished,
        ):
            for job, result in finished:
                advance(job.name)
                yield Finished(job, result)


def as_finished(jobs: Iterable[Job], executor: Executor, at_once: int) -> Generator[Finished]:
    """Submit jobs to an executor, up to so many `at_once`, and yield each when it is finished.

    A job is taken from `jobs` when its turn comes, so that it may depend on the jobs finished
    before. When the generator is closed, jobs that have not begun are cancelled.

    Raises:
      OSError: if the system ends one of the executor's processes; it names the jobs that were under
        way.
      Exception: what a job raises, with a note that names the job.
    """
    waiting = iter(jobs)
    under_way: dict[Future[Any], Job] = {}
    try:
        while True:
            for job in itertools.islice(waiting, at_once - len(under_way)):
                under_way[executor.submit(job.work)] = job
            if not under_way:
                return
            for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                job = under_way[future]
                with _naming(job):
                    result = future.result()
                del under_way[future]
                yield Finished(job, result)
    except BrokenExecutor as error:
        jobs_lost = [job.name for future, job in under_way.items() if not _has_result(future)]
        names = ", ".join(jobs_lost) or "nothing yet"
        raise OSError(
            f"a process was ended from outside while at work on {names}: is memory short?"
        ) from error
    finally:
        for future in under_way:
            future.cancel()


def _has_result(future: Future[Any]) -> bool:
    return future.done() and not future.cancelled() and future.exception() is None


@contextmanager
def _naming(job: Job) -> Generator[None]:
    """Add a note with the name of the job to an error that the block raises."""
    try:
        yield
    except BrokenExecutor:  # a process has ended, whichever job it had
        raise
    except Exception as error:
        error.add_note(f"while at work on {job.name}")
        raise


@contextmanager
def pool(most: int) -> Generator[ProcessPoolExecutor]:
    """Yield an executor with a process for each core, but not more than `most`.

    At the end of the block all processes have ended. After an error or an interruption they are
    killed, together with the processes that they have started.
    """
    # Processes are not forked: a copy of a process with several threads may hang, and a copy of its
    # OpenGL context cannot draw.
    context = multiprocessing.get_context("spawn")
    # Threads for linear algebra would take the cores from other processes. NumPy reads this when it
    # is loaded.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    processes = max(1, min(os.cpu_count() or 1, most))
    others = multiprocessing.active_children()
    executor = ProcessPoolExecutor(processes, context, _begin_worker)
    try:
        # All processes start here, as the executor overlooks the end of a process that starts with
        # the last job.
        for _ in range(processes):
            executor.submit(_nothing)
        yield executor
    except BaseException:
        for process in multiprocessing.active_children():
            if process not in others:
                _kill(process)
        raise
    finally:
        executor.shutdown(cancel_futures=True)


def _nothing() -> None:
    """Do no work."""


def _begin_worker() -> None:
    """Make this process a worker, which is silent and does not outlive its parent.

    It leads a process group of its own, to which all processes belong that it starts, such as
    ffmpeg. An interruption from the terminal does not reach the group, and killing the group leaves
    no process behind.
    """
    os.setpgid(0, 0)
    warnings.simplefilter("ignore")
    parent = multiprocessing.parent_process()
    assert parent is not None, "a worker has a parent"

    def follow_parent() -> None:
        parent.join()  # returns even if the parent was killed
        os.killpg(0, signal.SIGKILL)

    threading.Thread(target=follow_parent, daemon=True).start()


def _kill(worker: BaseProcess) -> None:
    """Kill a worker and all processes that it has started."""
    assert worker.pid is not None, "it has been started"
    try:
        os.killpg(worker.pid, signal.SIGKILL)
    except ProcessLookupError:  # it does not lead its group yet
        worker.kill()
