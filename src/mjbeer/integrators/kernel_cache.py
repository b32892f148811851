"""The folder for compiled kernels, with a hash of all files that their code may come from.

numba compiles a kernel anew when the kernel's own file has changed, and looks at no other. But what
a kernel calls is compiled into it, as are the constants that it uses, and these lie in other files
as well: after a change there numba would load the old code.
"""

import hashlib
import os
import pathlib
import shutil
import threading
import time
from collections.abc import Callable
from typing import Any

from numba import config, njit

_PACKAGE = pathlib.Path(__file__).parents[1]
SOURCES = tuple(
    path
    for folder in ("theory", "model", "integrators", "simulation")
    for path in sorted((_PACKAGE / folder).rglob("*.py"))
)
"""The files from which kernels may take functions and constants: those of the folders that have
kernels, and below."""
_PREFIX = "mjbeer-"
_UNUSED = 24 * 3600.0
"""Time after which the folder of other sources is removed [s]. A process that has begun earlier,
with those sources, may still compile: only if it writes at the very moment of the removal, its call
ends in an error."""
_lock = threading.Lock()


def compile_and_keep(function: Callable[..., Any], **options: Any) -> Any:
    """Return the kernel of a function: numba compiles it when it is called, or loads it.

    `options` are those of `njit`. The folder is numba's setting while the kernel is made, and the
    user's own functions are kept where the user wants them.
    """
    with _lock:
        before = config.CACHE_DIR
        config.CACHE_DIR = str(FOLDER)
        try:
            return njit(function, cache=True, **options)
        finally:
            config.CACHE_DIR = before


def _folder() -> pathlib.Path:
    """Return the folder for these sources, in numba's own folder: that can be written to.

    Each user has a folder of their own, as they may not be able to write into another's.
    """
    content = hashlib.sha256(str(os.getuid() if hasattr(os, "getuid") else "").encode())
    for path in SOURCES:
        content.update(path.read_bytes())
    return _numba_folder() / f"{_PREFIX}{content.hexdigest()[:16]}"


def _numba_folder() -> pathlib.Path:
    """Return the folder in which numba would keep the code of this file.

    It tells this of functions that it compiles only, and so this one is marked to be compiled.
    """
    return pathlib.Path(njit(_numba_folder, cache=True).stats.cache_path)


def _tidy() -> None:
    """Make the folder, mark it as used today, and remove those of other sources, long unused."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    os.utime(FOLDER)
    for other in FOLDER.parent.glob(f"{_PREFIX}*"):
        try:
            unused = time.time() - other.stat().st_mtime
        except FileNotFoundError:  # another process removes it, too
            continue
        if unused > _UNUSED:
            shutil.rmtree(other, ignore_errors=True)


FOLDER = _folder()
_tidy()
