"""The MuJoCo library as loaded in this process: its C functions, its log and its clock."""

import ctypes
import functools
import pathlib
import sys
import threading
from collections.abc import Generator
from contextlib import contextmanager
from typing import NamedTuple

import mujoco

MAX_STATE = 1e10
"""MuJoCo calls a motion diverged if a position or a rate is larger (mjMAXVAL)."""


class _Output(NamedTuple):
    """Where MuJoCo's log goes, and the address of the clock that it reads."""

    console: bool
    file: bool
    clock: int | None


_SILENT = _Output(console=False, file=False, clock=None)


class _Quiet:
    """The blocks of `quiet` that are open in all threads."""

    lock = threading.Lock()
    blocks = 0
    """How many there are."""
    before = _SILENT
    """What is restored when the last one ends."""


@contextmanager
def quiet() -> Generator[None]:
    """Stop MuJoCo from printing warnings, from writing its log, and from reading the clock.

    The log is MUJOCO_LOG.TXT, and the clock is for `mjData.timer`. Errors are raised as usual. To
    read the clock takes longer than a step of a model with one or two joints. To change these
    settings takes as long as ten such steps, so enter this once a run. They belong to the process:
    the first block that is entered, in any thread, changes them, and the last one restores them.
    """
    with _Quiet.lock:
        if _Quiet.blocks == 0:
            _Quiet.before = _exchange(_SILENT)
        _Quiet.blocks += 1
    try:
        yield
    finally:
        with _Quiet.lock:
            _Quiet.blocks -= 1
            if _Quiet.blocks == 0:
                _exchange(_Quiet.before)


def _exchange(output: _Output) -> _Output:
    """Set where the log goes and the address of the clock, and return what they were."""
    config = mujoco.MjLogConfig.get()
    clock = _clock()
    before = _Output(config.logto_console, config.logto_file, clock.value)
    config.logto_console = output.console
    config.logto_file = output.file
    clock.value = output.clock
    mujoco.MjLogConfig.set(config)
    return before


@functools.cache
def _clock() -> ctypes.c_void_p:
    """Return the variable of the library that has the address of the clock."""
    return ctypes.c_void_p.in_dll(library(), "mjcb_time")


@functools.cache
def library() -> ctypes.CDLL:
    """Return the handle of the loaded library: to open its file again gives the same one."""
    folder = pathlib.Path(mujoco.__file__).parent
    names = {"darwin": "libmujoco*.dylib", "win32": "mujoco.dll"}
    pattern = names.get(sys.platform, "libmujoco.so*")
    return ctypes.CDLL(str(next(folder.glob(pattern))))


@functools.cache
def address(name: str) -> int:
    """Return the address of a C function."""
    return ctypes.cast(getattr(library(), name), ctypes.c_void_p).value or 0
