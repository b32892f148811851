"""Hands out the scenes of a sweep in chunks of about a second to threads, processes or a cluster."""

import os
import pickle
from collections.abc import Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait

import numpy as np

from mjbeer.exceptions import ParameterError
from mjbeer.studies.sweep.plan import Plan
from mjbeer.studies.sweep.work import Measured, Work, measure

_CHUNK = 1.0
"""Time that a chunk takes [s]: long enough that handing it out costs nothing, short enough to be lost."""
_SHORTEST = 0.05
"""Time that a chunk takes towards the end [s], where the scenes left are shared out evenly."""
_FIRST = 8
"""Scenes in a chunk before it is known how long a scene takes."""
_GROWTH = 16
"""Largest ratio of a chunk to the one before: a few scenes may be quicker than the others."""
_WAITING = 256
"""Largest number of chunks that are handed out at once, for clusters of some hundred processes."""
_SHARES = 4
"""Chunks for each worker into which the scenes left are shared out, where that is less than a second's."""


def carry_out(work: Work, plan: Plan, scenes: np.ndarray, executor: Executor) -> Generator[tuple[np.ndarray, Measured]]:
    """Yield the numbers of some scenes and what was measured on them, chunk by chunk, as the chunks come back.

    What is measured on a scene does not depend on where and in which chunk that is done. If the generator is closed,
    chunks that have not begun are cancelled.

    Raises:
      ParameterError: if the work cannot be sent to the executor's processes.
      OSError: if the system ends one of the processes.
    """
    _check_sendable(work, executor)
    workers = getattr(executor, "_max_workers", None) or os.cpu_count() or 1
    pace, timed, size, place = np.inf, 0, _FIRST, 0
    out: dict[Future[Measured], np.ndarray] = {}
    try:
        while place < len(scenes) or out:
            while place < len(scenes) and len(out) < (workers if pace == np.inf else _WAITING):
                if pace < np.inf:
                    share = (len(scenes) - place) / (_SHARES * workers)
                    size = int(min(max(share, _SHORTEST / pace), _CHUNK / pace, _GROWTH * size)) or 1
                chunk = scenes[place : place + size]
                out[executor.submit(measure, work, plan.rows(chunk))] = chunk
                place += len(chunk)
            for done in _finished(out):
                chunk = out.pop(done)
                measured = done.result()
                if (count := len(chunk) - 1) > 0:
                    timed += count
                    pace = measured.pace if timed == count else pace + (measured.pace - pace) * count / timed
                yield chunk, measured
    except BrokenExecutor as error:
        raise OSError("a process of the sweep was ended from outside: is memory short?") from error
    finally:
        for waiting in out:
            waiting.cancel()


def _finished(futures: dict[Future[Measured], np.ndarray]) -> Iterator[Future[Measured]]:
    return iter(wait(futures, return_when=FIRST_COMPLETED).done)


def _check_sendable(work: Work, executor: Executor) -> None:
    """Check that the work can be sent to other processes, if it has to be; other executors have ways of their own.

    Raises:
      ParameterError: if it cannot be sent.
    """
    if not isinstance(executor, ProcessPoolExecutor):
        return
    try:
        pickle.dumps(work)
    except Exception as error:  # an object may raise anything here
        raise ParameterError(
            "what makes the scenes, and functions of their runs, must be defined at the top of a module to be sent to "
            f"processes: {' '.join(str(error).splitlines())}"
        ) from error
