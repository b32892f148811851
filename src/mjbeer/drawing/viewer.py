"""A scene in MuJoCo's own viewer: at its start and paused, to be run, paused and started anew by keys."""

import threading
import time

import mujoco

from mjbeer import require
from mjbeer.drawing import opengl
from mjbeer.exceptions import RenderingError, UnsupportedError
from mjbeer.model.build import START, compile_spec, refuse_others
from mjbeer.model.export import CAMERA, present, present_standing
from mjbeer.model.setting import FRICTION, INTEGRATORS, OWN, Integrator, Rolling, Setting, supported
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing

_SPACE = 32
"""The code of the space bar in GLFW."""
_FRAME = 1 / 60
"""Time between two pictures [s]."""
_PATIENCE = 10
"""How long a window may take to close [s]."""
# Where no window can be opened, MuJoCo's viewer would wait for it for ever.
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
_OTHER_WAYS = (
    "`mjbeer render` draws a video without a window, and `mjbeer export` writes a file for MuJoCo's viewer elsewhere"
)
_HELP = "space\nbackspace\nF4", "run or pause\nstart anew\nplot the sensors"
"""The text in the window, in two columns."""


class Player:
    """The motion of a model in real time: paused at its start, until the space bar is pressed."""

    def __init__(self, model: mujoco.MjModel, speed: float = 1.0) -> None:
        self.model, self.data, self._speed = model, mujoco.MjData(model), speed
        self.restart()

    def restart(self) -> None:
        """Go back to the start, and pause."""
        self.paused = True
        mujoco.mj_resetDataKeyframe(self.model, self.data, self.model.key(START).id)
        mujoco.mj_forward(self.model, self.data)
        self._due = self._reached = 0.0

    def press(self, key: int) -> None:
        """Run or pause, if the `key` is the space bar."""
        if key == _SPACE:
            self.paused = not self.paused

    def advance(self, elapsed: float) -> None:
        """Step the motion through `elapsed` [s] of real time.

        If the viewer has reset the time, as it does when backspace is pressed, the motion restarts. What a slow machine
        cannot step within a frame is left out, so that the window stays alive.
        """
        if self.data.time < self._reached:
            self.restart()
        if self.paused:
            mujoco.mj_forward(self.model, self.data)  # a joint may have been moved by hand
            return
        self._due += self._speed * elapsed
        end = time.monotonic() + _FRAME
        while self._due >= self.model.opt.timestep and time.monotonic() < end:
            mujoco.mj_step(self.model, self.data)
            self._due -= self.model.opt.timestep
        self._due = min(self._due, self._speed * _FRAME)
        self._reached = self.data.time


def view(
    scene: Scene | Standing,
    phi0: float = 0.0,
    phi_dot0: float = 0.0,
    rolling: Rolling | None = None,
    integrator: Integrator = "RK4",
    timestep: float = 1e-3,
    friction: float = FRICTION,
    speed: float = 1.0,
) -> None:
    """Open MuJoCo's viewer on a scene at its start, paused, and return when its window is closed.

    The parameters are those of `export`. If `rolling` is None, it is "equality", or "reduced" where MuJoCo can have no
    equality. A `standing` can stands on a floor, and has neither start nor rolling nor friction. A `speed` of 0.1 shows
    the motion ten times slower than in reality.

    Raises:
      ParameterError: if a parameter is not allowed.
      UnsupportedError: if MuJoCo cannot have such a model.
      RenderingError: if no window can be opened.
    """
    if integrator in OWN:
        raise UnsupportedError(
            f"{integrator} is mjbeer's integrator, not MuJoCo's; view with one of {', '.join(INTEGRATORS)}"
        )
    require.positive("speed", speed)
    if isinstance(scene, Standing):
        refuse_others(rolling=rolling or "reduced", phi0=phi0, phi_dot0=phi_dot0, friction=friction)
        model = present_standing(scene, True, Setting(integrator=integrator, timestep=timestep)).compile()
    else:
        rolling = rolling or ("equality" if supported(scene, "equality") else "reduced")
        setting = Setting(rolling, integrator, timestep, friction=friction)
        model = compile_spec(present(scene, setting, *require.start(phi0, phi_dot0)), setting.rigid)
    opengl.rasterize_in_one_thread()
    require_window()
    _play(Player(model, speed))


def require_window() -> None:
    """Check that a window can be opened.

    Raises:
      RenderingError: if it cannot; the message has the reason, and the two ways on.
    """
    if reason := opengl.why_not(_PROBE):
        raise RenderingError(f"no window can be opened: {reason}; {_OTHER_WAYS}")


def _play(player: Player) -> None:
    """Show a player in a window until the window is closed."""
    import mujoco.viewer

    others = threading.enumerate()
    try:
        window = mujoco.viewer.launch_passive(player.model, player.data, key_callback=player.press)
    except RuntimeError as error:  # on macOS, where a window needs MuJoCo's own launcher
        raise RenderingError(f"MuJoCo's viewer does not open: {error}") from error
    try:
        with window.lock():
            window.cam.type, window.cam.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, player.model.camera(CAMERA).id
        window.set_texts((None, None, *_HELP))
        before = time.monotonic()
        while window.is_running():
            now = time.monotonic()
            player.advance(now - before)
            before = now
            window.sync()
            time.sleep(_FRAME)
    finally:
        window.close()
        for thread in threading.enumerate():  # the window's thread would crash if the process ended before it
            if thread not in others:
                thread.join(_PATIENCE)
