"""The MuJoCo library that the Python bindings have loaded, for what they do not wrap."""

import ctypes
import functools
import pathlib
import sys

import mujoco


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
