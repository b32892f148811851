"""The MuJoCo library as loaded in this process: its C functions, its log and its clock."""

import ctypes
import functools
import pathlib
import sys
import threading
from collections.abc import Generator
from contextlib import contextmanager

import mujoco

LARGEST = 1e10
"""Largest state that MuJoCo does not call diverged (mjMAXVAL)."""
_lock = threading.Lock()
_saved: list[tuple[bool, bool]] = []
"""The log's settings when the first `quiet` was entered, once for each that is still open."""


@contextmanager
def quiet() -> Generator[None]:
    """Stop MuJoCo from printing warnings and from writing MUJOCO_LOG.TXT; errors are raised as usual.

    The setting belongs to the process: runs in several threads share it until the last one ends.
    """
    with _lock:
        # Reading and writing the settings takes longer than a hundred steps.
        _saved.append(_saved[0] if _saved else _set_log(console=False, file=False))
    try:
        yield
    finally:
        with _lock:
            before = _saved.pop()
            if not _saved:
                _set_log(*before)


def _set_log(console: bool, file: bool) -> tuple[bool, bool]:
    """Set where the log goes, and return where it went."""
    config = mujoco.MjLogConfig.get()
    before = config.logto_console, config.logto_file
    config.logto_console, config.logto_file = console, file
    mujoco.MjLogConfig.set(config)
    return before


@contextmanager
def untimed() -> Generator[None]:
    """Stop MuJoCo from reading the clock for its statistics, `mjData.timer`.

    That takes longer than a step of a model with one or two joints. The Python bindings install the clock whenever an
    MjData is made, so enter this afterwards. The setting belongs to the process: of runs in two threads one may be
    timed after all, and is only slower.
    """
    clock = ctypes.c_void_p.in_dll(library(), "mjcb_time")
    before, clock.value = clock.value, None
    try:
        yield
    finally:
        if before is not None:
            clock.value = before


@functools.cache
def library() -> ctypes.CDLL:
    """Return the handle of the loaded library; opening the same file again gives the same library."""
    folder = pathlib.Path(mujoco.__file__).parent
    pattern = {"darwin": "libmujoco*.dylib", "win32": "mujoco.dll"}.get(sys.platform, "libmujoco.so*")
    return ctypes.CDLL(str(next(folder.glob(pattern))))


@functools.cache
def address(name: str) -> int:
    """Return the address of a C function."""
    return ctypes.cast(getattr(library(), name), ctypes.c_void_p).value or 0
