"""Keep MuJoCo's clock out of compiled loops."""

import ctypes
from collections.abc import Generator
from contextlib import contextmanager

from mjbeer.library import library


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
