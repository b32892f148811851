"""The film of a can that stands, whose liquid is let go with a tilted surface."""

import contextlib
import math
import os
from collections.abc import Generator
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.drawing import opengl, video
from mjbeer.drawing.film import Film, RenderPlan
from mjbeer.drawing.overlay import HEIGHT, STRIP, draw_title
from mjbeer.drawing.sheet import Sheet
from mjbeer.drawing.strip import Chart, ChartStrip, Line
from mjbeer.exceptions import RenderingError
from mjbeer.model.attach import surface_slope
from mjbeer.model.build import build
from mjbeer.model.setting import MujocoIntegrator
from mjbeer.output import terminal
from mjbeer.output.plots import COLOURS
from mjbeer.theory.scene import DURATION
from mjbeer.theory.standing import QUANTITATIVE, Standing

_FIELD_OF_VIEW = 32.0
"""Angle of the picture's height, seen from the eye [degrees]."""
_ROOM = 1.5
"""Height of the picture, divided by the can's length or its width, whichever is larger."""
_LOOK_AT = 0.45
"""Height of the middle of the picture above the bottom, divided by the can's length."""
_DOWN = 14.0
"""How far the eye looks down [degrees]."""


class Slosh(NamedTuple):
    """The motion of a standing can's liquid; arrays have one row for each sample."""

    time: np.ndarray
    """[s], shape (samples,)."""
    qpos: np.ndarray
    """Coordinates of the model, shape (samples, nq)."""
    rise: np.ndarray
    """How high the surface rises at the wall towards +x, divided by R, shape (samples,)."""


def slosh(can: Standing, model: mujoco.MjModel, duration: float) -> Slosh:
    """Return how the liquid of a can that is held moves for a `duration` [s] in its model.

    It is let go at rest in its first mode, with a surface that rises by 0.1 R at the wall.
    """
    data = mujoco.MjData(model)
    if can.moving_modes > 0:
        tilt = math.asin(QUANTITATIVE / can.elevations()[0])
        data.joint("slosh1").qpos = [math.cos(tilt / 2), 0, -math.sin(tilt / 2), 0]
    count = max(1, math.ceil(duration / model.opt.timestep))
    qpos = np.empty((count + 1, model.nq))
    rise = np.zeros(count + 1)
    for sample in range(count + 1):
        if sample > 0:
            mujoco.mj_step(model, data)
        qpos[sample] = data.qpos
        rise[sample] = surface_slope(model, data, "")[0]
    return Slosh(model.opt.timestep * np.arange(count + 1), qpos, rise)


@dataclass(frozen=True)
class StandingFilm(Film):
    """The film of a can that is held, whose liquid is let go with a rise of 0.1 R at the wall."""

    can: Standing
    duration: float = DURATION
    """[s]."""
    integrator: MujocoIntegrator = "RK4"
    timestep: float = 1e-3
    """[s]."""

    def plan(self) -> RenderPlan:
        duration = require.positive("duration", self.duration, "s")
        # The can is held: on a soft floor it would rock a little, which damps the slosh.
        model = build(
            self.can,
            visuals=True,
            integrator=self.integrator,
            timestep=self.timestep,
            free=False,
        )
        motion = slosh(self.can, model, duration)
        draw = partial(self._pictures, model, motion)
        return RenderPlan(0.0, duration, self.speed, draw)

    def _pictures(
        self, model: mujoco.MjModel, motion: Slosh, times: np.ndarray, width: int, height: int
    ) -> Generator[np.ndarray]:
        can = self.can
        sheet = Sheet(width, height)
        top = round(HEIGHT * sheet.unit)
        below = round(STRIP * sheet.unit)
        strip = ChartStrip([_rise_chart(can, motion)], width, below)
        title = f"A can of {can.name} that stands"
        frequency = can.frequencies(1)[0] / math.tau
        words = f"{100 * can.fill:.3g} % full; linear theory says {frequency:.2f} Hz"
        data = mujoco.MjData(model)
        with contextlib.closing(_Camera(can, model, (width, height - top - below))) as camera:
            for time in times:
                sample = min(np.searchsorted(motion.time, time), len(motion.time) - 1)
                data.qpos[:] = motion.qpos[sample]
                sheet.put(camera.picture(data), top)
                draw_title(sheet, title, words, time, self.speed)
                strip.draw(sheet, time, height - below)
                yield sheet.picture()


def _rise_chart(can: Standing, motion: Slosh) -> Chart:
    """Return the chart of the rise at the right wall, beside linear theory if the liquid moves."""
    lines = [Line("MuJoCo", motion.time, motion.rise, COLOURS[0])]
    if can.moving_modes > 0:
        lines.append(Line("theory", motion.time, free_decay(can, motion.time)))
    return Chart("rise at the right wall [R]", lines, least=2 * QUANTITATIVE)


def free_decay(can: Standing, time: np.ndarray) -> np.ndarray:
    """Return the rise at the wall of a can that is held, by linear theory, in radii.

    It is that of a damped oscillator, the first mode, which is let go at rest at 0.1 R.
    """
    omega = can.frequencies(1)[0]
    ratio = can.damping_ratios(1)[0]
    damped = omega * math.sqrt(1 - ratio**2)
    phase = damped * time
    decay = np.exp(-ratio * omega * time)
    return QUANTITATIVE * decay * (np.cos(phase) + ratio * omega / damped * np.sin(phase))


class _Camera:
    """Draws a model by OpenGL, seen from the side and a little from above.

    It holds graphics memory until it is closed.
    """

    def __init__(self, can: Standing, model: mujoco.MjModel, pixels: tuple[int, int]) -> None:
        """Prepare pictures of so many `pixels`."""
        self._model = model
        self._pixels = pixels
        self._scene = mujoco.MjvScene(model, model.ngeom)
        self._view = mujoco.MjvCamera()
        size = max(can.can.length, 2 * can.can.radius)
        half_angle = math.radians(_FIELD_OF_VIEW / 2)
        self._view.lookat[:] = [0, 0, _LOOK_AT * can.can.length]
        self._view.distance = _ROOM * size / (2 * math.tan(half_angle))
        self._view.azimuth = 90  # along y, with x to the right
        self._view.elevation = -_DOWN
        model.vis.global_.fovy = _FIELD_OF_VIEW
        model.vis.global_.offwidth, model.vis.global_.offheight = pixels
        self._gl = opengl.context()
        self._gl.make_current()
        try:
            font = mujoco.mjtFontScale.mjFONTSCALE_100.value
            self._context = mujoco.MjrContext(model, font)
        except (mujoco.FatalError, RuntimeError) as error:
            size_in_words = f"{pixels[0]} x {pixels[1]} pixels"
            raise RenderingError(f"no off-screen picture of {size_in_words}: {error}") from error

    def picture(self, data: mujoco.MjData) -> np.ndarray:
        """Return a picture of shape (height, width, 4), uint8."""
        width, height = self._pixels
        mujoco.mj_kinematics(self._model, data)
        mujoco.mj_camlight(self._model, data)
        option = mujoco.MjvOption()
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(self._model, data, option, None, self._view, everything, self._scene)
        self._gl.make_current()
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        whole = mujoco.MjrRect(0, 0, width, height)
        mujoco.mjr_render(whole, self._scene, self._context)
        upside_down = np.empty((height, width, 3), np.uint8)
        mujoco.mjr_readPixels(upside_down, None, whole, self._context)
        opaque = np.full((height, width, 1), 255, np.uint8)
        return np.concatenate([upside_down[::-1], opaque], axis=2)

    def close(self) -> None:
        """Free the graphics memory."""
        self._gl.make_current()
        self._context.free()


def render_standing(
    film: StandingFilm, path: str | os.PathLike[str], width: int, height: int, fps: float = 30
) -> None:
    """Write the film of a standing can as a video, MP4 with H.264, whole or not at all.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: if OpenGL or ffmpeg does not work; the message says what to do.
      OutputError: if the file cannot be written.
    """
    target = video.check_target(path, width, height)
    plan = film.plan()
    with terminal.progress_bar(terminal.STDERR, len(plan.times(fps))) as show_progress:
        video.write(plan, target, width, height, fps, show_progress)
