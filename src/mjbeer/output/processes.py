"""Other processes to work in, one for each core, that end at once when this one is interrupted or killed."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Generator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager


@contextmanager
def pool(most: int) -> Generator[ProcessPoolExecutor]:
    """Yield an executor with a process for each core, but not more than `most`; they start when work is submitted.

    At the end of the block, or when it is interrupted, the processes are ended.
    """
    # Not forked: a copy of a process with several threads may hang, and a copy of OpenGL is of no use.
    # Threads for linear algebra would take the cores from other processes; NumPy asks when it is loaded.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    context, count = multiprocessing.get_context("spawn"), max(1, min(os.cpu_count() or 1, most))
    executor = ProcessPoolExecutor(count, context, follow_parent)
    try:
        yield executor
    except BaseException:
        for child in multiprocessing.active_children():
            child.terminate()
        raise
    finally:
        executor.shutdown(cancel_futures=True)


def follow_parent() -> None:
    """Make this process leave interruptions to its parent, and end when the parent does, even if that is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    assert parent is not None

    def end() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=end, daemon=True).start()
