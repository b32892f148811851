"""Keep MuJoCo's log off the terminal and the disk while a run reports its own failure."""

import threading
from collections.abc import Generator
from contextlib import contextmanager

import mujoco

_lock = threading.Lock()
_inside: list[tuple[bool, bool]] = []


@contextmanager
def quiet() -> Generator[None]:
    """Neither print MuJoCo's warnings nor write MUJOCO_LOG.TXT; errors are raised as ever.

    The setting is the process's, so runs in several threads share it until the last one ends.
    """
    with _lock:
        config = mujoco.MjLogConfig.get()
        _inside.append((config.logto_console, config.logto_file))
        _log(False, False)
    try:
        yield
    finally:
        with _lock:
            before = _inside.pop()
            if not _inside:  # the first to come in saw the setting as it was
                _log(*before)


def _log(console: bool, file: bool) -> None:
    config = mujoco.MjLogConfig.get()
    config.logto_console, config.logto_file = console, file
    mujoco.MjLogConfig.set(config)
