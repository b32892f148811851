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
"""The files from which kernels may take functions and constants.

These rooms have kernels, or are imported by rooms that do. A change in any other room leaves the
compiled code as it is. A test finds all files that kernels are made from, and looks for them here.
"""
_PREFIX = "mjbeer-"
_UNUSED = 24 * 3600.0
"""Time without use after which the folder of other sources is removed [s].

A process that began earlier, with those sources, may still compile. Its call ends in an error only
if it writes at the very moment of the removal.
"""
_lock = threading.Lock()


def compile_and_keep(function: Callable[..., Any], **options: Any) -> Any:
    """Return the kernel of a function: numba compiles it when it is called, or loads it.

    `options` are those of `njit`. The folder is numba's setting only while the kernel is made, so
    that the user's own functions are kept where the user wants them.
    """
    with _lock:
        before = config.CACHE_DIR
        config.CACHE_DIR = str(FOLDER)
        try:
            return njit(function, cache=True, **options)
        finally:
            config.CACHE_DIR = before


def _folder() -> pathlib.Path:
    """Return the folder for these sources, within the folder of numba, which can be written to.

    Each user has a folder of their own, as one user may not write into the folder of another.
    """
    content = hashlib.sha256(str(os.getuid() if hasattr(os, "getuid") else "").encode())
    for path in SOURCES:
        content.update(path.read_bytes())
    return _numba_folder() / f"{_PREFIX}{content.hexdigest()[:16]}"


def _numba_folder() -> pathlib.Path:
    """Return the folder in which numba would keep compiled code of this file.

    It is in NUMBA_CACHE_DIR if the user has set that, otherwise beside this file, or in the user's
    cache if nothing can be written there. numba says where only for a function that is marked for
    compiling and keeping. So this function marks itself; it is never compiled.
    """
    return pathlib.Path(njit(_numba_folder, cache=True).stats.cache_path)


def _tidy() -> None:
    """Make the folder, mark it as used now, and remove the unused folders of other sources.

    Every process that imports this file does so, as those that load code use the folder as well.
    """
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
