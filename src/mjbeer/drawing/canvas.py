"""Pictures of a posed MuJoCo model as arrays, drawn without a window."""

from collections.abc import Callable
from types import TracebackType
from typing import Self

import mujoco
import numpy as np

from mjbeer.drawing import opengl
from mjbeer.exceptions import RenderingError

_ROOM = 64
"""Most geoms that can be added to those of the model."""


class Canvas:
    """A context manager that draws a posed model into arrays, and frees the graphics memory at its end.

    It replaces mujoco.Renderer, which can only use the OpenGL that MUJOCO_GL named when MuJoCo was imported.

    Raises:
      RenderingError: if OpenGL cannot draw without a window; the message names what to install.
    """

    def __init__(self, model: mujoco.MjModel, width: int, height: int) -> None:
        self._model = model
        self._scene = mujoco.MjvScene(model, model.ngeom + _ROOM)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = False  # a third of the drawing time, and hidden by the wall
        self._option = mujoco.MjvOption()
        self._view = mujoco.MjrRect(0, 0, width, height)
        model.vis.global_.offwidth, model.vis.global_.offheight = width, height
        self._gl = opengl.context(width, height)
        try:
            self._gl.make_current()
            self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        except (mujoco.FatalError, RuntimeError) as error:
            self._gl.free()
            raise RenderingError(f"no off-screen picture of {width} x {height} pixels: {error}") from error

    def draw(
        self, data: mujoco.MjData, camera: str, decorate: Callable[[mujoco.MjvScene], None] | None = None
    ) -> np.ndarray:
        """Return the picture from a camera, by its name, as an array of shape (height, width, 3), uint8.

        `decorate` is called with MuJoCo's scene before it is drawn, and may add geoms to it.
        """
        view = mujoco.MjvCamera()
        view.type, view.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, self._model.camera(camera).id
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(self._model, data, self._option, None, view, everything, self._scene)
        if decorate is not None:
            decorate(self._scene)
        pixels = np.empty((self._view.height, self._view.width, 3), np.uint8)
        self._gl.make_current()
        mujoco.mjr_render(self._view, self._scene, self._context)
        mujoco.mjr_readPixels(pixels, None, self._view, self._context)
        return pixels[::-1]  # OpenGL's first row is the lowest

    def close(self) -> None:
        """Free the graphics memory."""
        self._gl.make_current()
        self._context.free()
        self._gl.free()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
