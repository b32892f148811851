"""The MuJoCo library in this process: its C functions, its log and its clock."""

import ctypes
import functools
import pathlib
import sys
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


@contextmanager
def untimed() -> Generator[None]:
    """Step without MuJoCo reading the clock for its statistics, `mjData.timer`.

    The Python bindings install the clock whenever an MjData is made, so this comes after. Reading it some twenty
    times a step takes longer than a step of a model with one or two joints. The setting is the process's: of two
    runs in two threads, one may be timed after all, and is only slower.
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
    """Handle of the loaded library: opening the same file again gives the same library."""
    folder = pathlib.Path(mujoco.__file__).parent
    pattern = {"darwin": "libmujoco*.dylib", "win32": "mujoco.dll"}.get(sys.platform, "libmujoco.so*")
    return ctypes.CDLL(str(next(folder.glob(pattern))))


def address(name: str) -> int:
    """Address of a C function."""
    value = ctypes.cast(getattr(library(), name), ctypes.c_void_p).value
    assert value is not None
    return value
