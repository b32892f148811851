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

    All that the process draws shares its compiled shaders.

    Raises:
      RenderingError: if OpenGL does not start; the message says why not and what to install.
    """
    # Mesa's software rasterizer (llvmpipe, seen in 22.3) frees a fence while another of its threads
    # still unlocks it, and now and then the process crashes. Without threads of its own it cannot.
    os.environ.setdefault("LP_NUM_THREADS", "0")
    name = "osmesa" if os.environ.get("MUJOCO_GL", "").strip().lower() == "osmesa" else "egl"
    try:
        # Not mujoco.GLContext: that is what MUJOCO_GL said when MuJoCo was imported, a window
        # system's by default.
        library = importlib.import_module(f"mujoco.{name}" if sys.platform == "linux" else "mujoco")
        # Pictures are drawn into a buffer of MuJoCo's, of any size.
        opened = library.GLContext(16, 16)
    except Exception as error:  # of what kind depends on what is missing
        raise RenderingError(
            f"no off-screen OpenGL ({name}): {error}\n"
            "EGL runs on a graphics card or without one. On Debian and Ubuntu this installs it:\n"
            f"    {INSTALL}"
        ) from error
    atexit.register(opened.free)  # later it could not be freed any more
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
