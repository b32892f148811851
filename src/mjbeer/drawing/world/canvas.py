"""Pictures of a posed MuJoCo model as arrays, drawn without a window."""

from types import TracebackType
from typing import Self

import mujoco
import numpy as np

from mjbeer.drawing import opengl
from mjbeer.drawing.world.view import View
from mjbeer.exceptions import RenderingError

_NEAR, _FAR = 0.2, 20.0
"""Nearest and farthest that is drawn, in distances of what is looked at."""


class Canvas:
    """A context manager that draws a posed model into arrays, and frees the graphics memory at its end.

    It replaces mujoco.Renderer, which can only use the OpenGL that MUJOCO_GL named when MuJoCo was imported.

    Raises:
      RenderingError: if OpenGL cannot draw without a window; the message names what to install.
    """

    def __init__(self, model: mujoco.MjModel, width: int, height: int) -> None:
        self._model = model
        self._scene = mujoco.MjvScene(model, model.ngeom)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = False  # a third of the drawing time, and hidden by the wall
        self._option, self._anywhere = mujoco.MjvOption(), mujoco.MjvCamera()
        model.vis.global_.offwidth, model.vis.global_.offheight = width, height
        self._gl = opengl.context(width, height)
        try:
            self._gl.make_current()
            self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        except (mujoco.FatalError, RuntimeError) as error:
            self._gl.free()
            raise RenderingError(f"no off-screen picture of {width} x {height} pixels: {error}") from error

    def draw(self, data: mujoco.MjData, view: View) -> np.ndarray:
        """Return what a view shows as an array of shape (height, width, 3), uint8.

        The view may be smaller than the canvas.
        """
        scene, everything = self._scene, mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(self._model, data, self._option, None, self._anywhere, everything, scene)
        near = _NEAR * view.distance
        for eye in scene.camera:  # two of them, for stereo; MuJoCo draws their mean
            eye.pos, eye.up, eye.forward = view.eye, view.axes[1], -view.axes[2]
            eye.frustum_near, eye.frustum_far = near, _FAR * view.distance
            eye.frustum_center = near * (view.low[0] + view.high[0]) / 2
            eye.frustum_width = near * (view.high[0] - view.low[0]) / 2
            eye.frustum_bottom, eye.frustum_top = near * view.low[1], near * view.high[1]
        for light in scene.lights[: scene.nlight]:
            if light.headlight:
                light.pos, light.dir = view.eye, -view.axes[2]
        window = mujoco.MjrRect(0, 0, *view.pixels)
        pixels = np.empty((view.pixels[1], view.pixels[0], 3), np.uint8)
        self._gl.make_current()
        mujoco.mjr_render(window, scene, self._context)
        mujoco.mjr_readPixels(pixels, None, window, self._context)
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
