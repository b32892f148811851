"""Processes that measure tasks of a study, all cores at once."""

import os
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any

from mjbeer.output import processes
from mjbeer.studies.study import Task


@contextmanager
def crew(tasks: Sequence[Task], most: int | None = None) -> Generator[Callable[[Task], dict[str, Any]]]:
    """Yield a function that measures a task and returns its results.

    When it is first called with one of `tasks`, processes begin to measure all of these, in their order; there is one
    for each core, but not more than `most`. Any other task is measured in this process. A task's results do not depend
    on where it is measured. At the end of the block, or when it is interrupted, the processes are ended.

    Raises:
      OSError: if the system ends one of the processes.
    """
    count = min(most or os.cpu_count() or 1, len(tasks))
    results: dict[str, Future[dict[str, Any]]] = {}
    names = {task.name for task in tasks}
    with processes.pool(count) as executor:

        def measure(task: Task) -> dict[str, Any]:
            if task.name not in names or count <= 1:
                return task.measure()
            if not results:
                results.update({each.name: executor.submit(each.measure) for each in tasks})
            try:
                return results[task.name].result()
            except BrokenProcessPool:
                raise OSError(
                    f"a process was ended from outside while it measured {task.name}: is memory short?"
                ) from None

        yield measure
