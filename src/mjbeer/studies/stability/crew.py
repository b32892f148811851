"""Processes that measure tasks of a study, all cores at once, in a way that an interruption ends at once too."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any

from mjbeer.studies.study import Task


@contextmanager
def crew(tasks: Sequence[Task], processes: int | None = None) -> Generator[Callable[[Task], dict[str, Any]]]:
    """Yield a function that measures a task and returns its results.

    When it is first called with one of `tasks`, processes begin to measure all of these, in their order; by default
    there is one for each core. Any other task is measured in this process. A task's results do not depend on where it
    is measured. At the end of the block, or when it is interrupted, the processes are ended.

    Raises:
      OSError: if the system ends one of the processes.
    """
    count = min(processes or os.cpu_count() or 1, len(tasks))
    results: dict[str, Future[dict[str, Any]]] = {}
    pool: ProcessPoolExecutor | None = None
    names = {task.name for task in tasks}

    def measure(task: Task) -> dict[str, Any]:
        nonlocal pool
        if task.name not in names or count <= 1:
            return task.measure()
        if pool is None:
            # Not forked: a copy of a process with several threads may hang.
            pool = ProcessPoolExecutor(count, multiprocessing.get_context("spawn"), initializer=_follow)
            results.update({each.name: pool.submit(each.measure) for each in tasks})
        try:
            return results.pop(task.name).result()
        except BrokenProcessPool:
            raise OSError(f"a process was ended from outside while it measured {task.name}: is memory short?") from None

    try:
        yield measure
    except BaseException:
        for child in multiprocessing.active_children():
            child.terminate()
        raise
    finally:
        if pool is not None:
            pool.shutdown(cancel_futures=True)


def _follow() -> None:
    """Make this process leave interruptions to its parent, and end when the parent does, even if that is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    assert parent is not None

    def end() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=end, daemon=True).start()
