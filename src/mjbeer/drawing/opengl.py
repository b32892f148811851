"""Off-screen OpenGL: EGL, or what the environment variable MUJOCO_GL names."""

import atexit
import functools
import importlib
import os
import sys
from collections.abc import Sequence
from typing import Any

from mjbeer.exceptions import RenderingError

INSTALL = "apt-get update && apt-get install -y libegl1 libopengl0 libgl1-mesa-dri"
"""What installs OpenGL on Debian and Ubuntu."""


@functools.cache
def context() -> Any:
    """Return the off-screen OpenGL context of this process, not yet current.

    All pictures of the process share it, and so the shaders that it has compiled.

    Raises:
      RenderingError: if OpenGL does not start; the message says why not and what to install.
    """
    # In Mesa's software renderer (llvmpipe, seen in 22.3) one thread may free a fence that another
    # is still unlocking, and then the process crashes. Without threads of its own it cannot.
    os.environ.setdefault("LP_NUM_THREADS", "0")
    name = "osmesa" if os.environ.get("MUJOCO_GL", "").strip().lower() == "osmesa" else "egl"
    try:
        # On Linux, `mujoco.GLContext` is the class that MUJOCO_GL named when MuJoCo was imported.
        # Without that variable it needs a display.
        library = importlib.import_module(f"mujoco.{name}" if sys.platform == "linux" else "mujoco")
        # The size does not matter: pictures are drawn into a buffer of MuJoCo's.
        opened = library.GLContext(16, 16)
    except Exception as error:  # its type depends on what is missing
        raise RenderingError(
            f"no off-screen OpenGL ({name}): {error}\n"
            "EGL runs on a graphics card or without one. On Debian and Ubuntu this installs it:\n"
            f"    {INSTALL}"
        ) from error
    atexit.register(opened.free)  # after that the interpreter has taken OpenGL apart
    return opened


def problem() -> str | None:
    """Return why no picture can be drawn here, or None if one can."""
    try:
        context()
    except RenderingError as error:
        return str(error)
    return None


def missing_films_message(films: Sequence[str]) -> str:
    """Return the line that says which films are missing without OpenGL, and what installs it."""
    names = ", ".join(films)
    remedy = f"on Debian and Ubuntu this installs it: {INSTALL}"
    return f"not drawn because there is no OpenGL: {names}; {remedy}"
