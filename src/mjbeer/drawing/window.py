"""Whether MuJoCo's viewer can open a window here, found out in another process.

Where it cannot, MuJoCo's viewer would wait for its window for ever, and a bad driver may crash.
"""

import os
import subprocess
import sys

from mjbeer.exceptions import RenderingError

_PROBE = """
import sys, glfw, mujoco
glfw.ERROR_REPORTING = False
window = None
if glfw.init():
    glfw.window_hint(glfw.VISIBLE, False)
    window = glfw.create_window(16, 16, "", None, None)
if not window:
    sys.exit((glfw.get_error()[1] or b"").decode())
glfw.make_context_current(window)
mujoco.MjrContext(mujoco.MjModel.from_xml_string("<mujoco/>"), 100).free()
"""
_PATIENCE = 60
"""How long a window may take to open [s]; it is a second or two."""
_OTHER_WAYS = (
    "`mjbeer render` draws a video without a window, and `mjbeer export` writes a file for MuJoCo's viewer elsewhere"
)


def require_window() -> None:
    """Check that a window can be opened.

    Raises:
      RenderingError: if it cannot; the message has the reason, and the two ways on.
    """
    if reason := _why_not():
        raise RenderingError(f"no window can be opened: {reason}; {_OTHER_WAYS}")


def _why_not() -> str | None:
    """Return why no window can be opened, in one line, or None if one can."""
    command, environment = [sys.executable, "-c", _PROBE], os.environ | {"MUJOCO_GL": "disable"}
    try:
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=_PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        return f"none did within {_PATIENCE} s"
    if done.returncode == 0:
        return None
    if done.returncode < 0:
        return f"OpenGL crashed with signal {-done.returncode}"
    return (done.stderr.strip().splitlines() or ["no message says why"])[-1]
