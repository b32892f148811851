"""Off-screen OpenGL: which backend works here, found out before anything of it is loaded."""

import atexit
import functools
import importlib
import os
import subprocess
import sys
import threading
from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np

from mjbeer.exceptions import RenderingError

BACKENDS = ("egl", "osmesa")
"""In the order they are tried; the environment variable MUJOCO_GL may name one."""
INSTALL = "apt-get update && apt-get install -y libegl1 libopengl0 libgl1-mesa-dri"
"""The line that brings EGL to Debian and Ubuntu."""
REMEDY = f"""\
With EGL, which runs on a graphics card or without one (Debian and Ubuntu):
    {INSTALL}
or with OSMesa, where a release still has it:
    apt-get update && apt-get install -y libosmesa6"""
# Tried in another process, for a backend that fails leaves PyOpenGL bound to it.
_PROBE = """
import mujoco
from mujoco.{0} import GLContext
context = GLContext(16, 16)
context.make_current()
mujoco.MjrContext(mujoco.MjModel.from_xml_string("<mujoco/>"), 100).free()
context.free()
"""
_NONE = "disable"
"""The value of MUJOCO_GL with which MuJoCo loads no OpenGL when it is imported."""
_THREAD = threading.local()
_PATIENCE = 60
"""How long OpenGL may take to start [s]; it is a second or two."""


def context() -> Any:
    """The off-screen OpenGL context of this thread, not yet current: all that it draws shares its compiled shaders.

    Raises:
      RenderingError: if no backend works; the message says why not and what to install.
    """
    if not hasattr(_THREAD, "context"):
        _THREAD.context = _library().GLContext(16, 16)  # pictures are drawn into a buffer of MuJoCo's, of any size
        atexit.register(_THREAD.context.free)  # later it could not be freed any more
    return _THREAD.context


def _library() -> ModuleType:
    if sys.platform != "linux":
        return importlib.import_module("mujoco")
    rasterize_in_one_thread()
    # Not mujoco.GLContext: that is what MUJOCO_GL said when MuJoCo was imported, a window system's by default.
    return importlib.import_module(f"mujoco.{backend()}")


def read(drawn: Any, width: int, height: int) -> np.ndarray:
    """Return what a MuJoCo context has drawn, with a channel more than MuJoCo returns, shape (height, width, 4), uint8.

    The first row is the lowest. The last channel is 255, and 0 where nothing is drawn. There must be no multisampling.
    """
    from OpenGL import GL

    pixels = np.empty((height, width, 4), np.uint8)
    GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, drawn.offFBO)
    GL.glReadPixels(0, 0, width, height, GL.GL_RGBA, GL.GL_UNSIGNED_BYTE, pixels)
    return pixels


def rasterize_in_one_thread() -> None:
    """Make Mesa draw in the thread that calls it, unless the user has set how many threads it takes.

    Mesa's software rasterizer (llvmpipe, seen in 22.3) frees a fence while another of its threads still unlocks it, and
    so writes into memory that is free or somebody else's: now and then the process that draws crashes. Without threads
    of its own it cannot. It has to be said before the first context.
    """
    os.environ.setdefault("LP_NUM_THREADS", "0")


@functools.cache
def backend() -> str:
    """The backend that works here on Linux: "egl", else "osmesa".

    Raises:
      RenderingError: if neither does.
    """
    asked = os.environ.get("MUJOCO_GL", "").strip().lower()
    tried, reasons = (asked,) if asked in BACKENDS else BACKENDS, []
    for name in tried:
        if (reason := _why_not(name)) is None:
            return name
        reasons.append(f"\n  {name}: {reason}")
    only = f" (MUJOCO_GL={asked} rules out others)" if len(tried) == 1 else ""
    raise RenderingError(f"no off-screen OpenGL{only}:{''.join(reasons)}\n{REMEDY}")


def problem() -> str | None:
    """Return why no picture can be drawn here, or None if one can."""
    try:
        if sys.platform == "linux":
            backend()
        else:
            context()
    except RenderingError as error:
        return str(error)
    return None


def missing(films: Sequence[str]) -> str:
    """Return the line that names the films that are missing because there is no OpenGL, and what installs it."""
    return f"not drawn because there is no OpenGL: {', '.join(films)}; on Debian and Ubuntu this installs it: {INSTALL}"


def keep_out() -> None:
    """Import MuJoCo without the OpenGL that MUJOCO_GL names, which it would load at once, and fail where it cannot.

    What draws nothing needs none; what does asks for a `context`.
    """
    asked = os.environ.get("MUJOCO_GL")
    if sys.platform != "linux" or asked is None:
        return
    os.environ["MUJOCO_GL"] = _NONE
    try:
        import mujoco  # noqa: F401
    finally:
        os.environ["MUJOCO_GL"] = asked


def _why_not(name: str) -> str | None:
    return why_not(_PROBE.format(name))


def why_not(program: str) -> str | None:
    """Return why a program in Python that tries OpenGL fails, in one line, or None if it does not.

    It runs in another process: a bad driver may crash, or wait for ever.
    """
    command, environment = [sys.executable, "-c", program], os.environ | {"MUJOCO_GL": _NONE}
    try:
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=_PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        return f"did not start within {_PATIENCE} s"
    if done.returncode < 0:
        return f"crashed with signal {-done.returncode}"
    return (done.stderr.strip().splitlines() or ["failed without a message"])[-1] if done.returncode else None
