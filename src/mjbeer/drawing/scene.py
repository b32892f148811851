"""The drawn scene: one can, or several side by side, on their board; it is posed, never stepped, and drawn by OpenGL.

Its cans have the radius of the templates' can, whatever the scene's is: none is too small or too large for the single
precision of the graphics.
"""

import dataclasses
import math
from collections.abc import Sequence

import mujoco
import numpy as np
from PIL import Image
from scipy.interpolate import CubicHermiteSpline

from mjbeer.drawing import opengl
from mjbeer.drawing.camera import View, circle, in_space, on_incline, scale
from mjbeer.drawing.sheet import Colour, Sheet
from mjbeer.exceptions import RenderingError
from mjbeer.model import looks
from mjbeer.model.build import rolling_spec
from mjbeer.model.joints import joint_addresses
from mjbeer.model.mjcf_file import compile_spec
from mjbeer.model.setting import Setting
from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

_VISUAL, _UNSEEN = 2, 5  # groups of geoms: what templates show, and what is not drawn; each can is in one of its own
_STRIPE = math.pi / 2 * RADIUS  # length of a stripe of the board [m]; a pale one begins at x = 0, as in templates
_SQUARE, _LINE = 0.1, 0.1 / 64  # distance of the lines on the wall [m], two of them around x = 0, and their width
_PAINT, _STROKE = np.array([0.15, 0.17, 0.2]), 0.003  # colour of lines across the board, and half their width [m]
_PALE, _DARK = np.array([0.94, 0.84, 0.69]), np.array([0.84, 0.71, 0.54])  # stripes of the board, as in mjcf/assets.xml
_WALL, _GRID = np.array([0.985, 0.99, 1.0]), np.array([0.84, 0.87, 0.92])  # the wall and its lines, as in scene.xml
_NEAR = np.array([0.0, -1.0, 0.0])  # unit vector towards the reader


def coordinates(trajectory: Trajectory, times: np.ndarray) -> np.ndarray:
    """Return u [m], phi [rad], roll [rad] and lift [m] at some times [s], shape (times, 4).

    Between samples each is the cubic with their values and rates, whose error falls as the interval's fourth power.
    """
    samples = np.stack([trajectory.u, trajectory.phi, trajectory.roll, trajectory.lift], axis=1)
    if len(samples) == 1:
        return np.repeat(samples, len(times), axis=0)
    rates = np.stack([trajectory.u_dot, trajectory.phi_dot, trajectory.roll_dot, trajectory.lift_dot], axis=1)
    return CubicHermiteSpline(trajectory.time, samples, rates)(times)


class Display:
    """A board with cans of one size on it, and a wall behind. Joints are named as in the templates, with a prefix for
    each lane. All lengths are as drawn."""

    def __init__(self, scenes: Sequence[Scene], apart: float = 0.0, lines: Sequence[float] = ()) -> None:
        """Make the display of cans on one incline, `apart` [m] from each other, the nearest first; at the distances
        `lines` [m] down the incline a line crosses the board."""
        self.scenes, self.lanes, self._lines = scenes, [lane * apart for lane in range(len(scenes))], lines
        specs = [rolling_spec(_resize(scene), Setting("contact"), visuals=True) for scene in scenes]
        for number, (scene, spec) in enumerate(zip(scenes, specs, strict=True)):
            if scene.load.fill is not None:
                looks.shape_beer(spec, _resize(scene), edges=64)  # a circle, to the eye
            for pair in spec.pairs:
                spec.delete(pair)
            for geom in spec.geoms:
                of_can = geom.group == _VISUAL and geom.name not in ("board", "wall")
                geom.group = number % _UNSEEN if of_can else _UNSEEN
        first, *others = specs
        for number, (lane, spec) in enumerate(zip(self.lanes[1:], others, strict=True), start=1):
            spec.option.tolerance = first.option.tolerance  # nothing is stepped here
            parent = first.body("incline") or first.worldbody
            parent.add_frame(pos=[0, lane, 0]).attach_body(spec.body("can"), _prefix(number), "")
        board, wall = first.geom("board"), first.geom("wall")
        board.pos += [0, self.lanes[-1] / 2, 0]
        board.size += [0, self.lanes[-1] / 2, 0]
        wall.pos += [0, self.lanes[-1], 0]
        self.model = compile_spec(first)
        self.data = mujoco.MjData(self.model)

    def paint(self, labels: Sequence[Sequence[float]], loads: Sequence[Sequence[float] | None]) -> None:
        """Give each can's label a colour, and its load too unless that is None; what is on the load is then paler."""
        for number, (label, load) in enumerate(zip(labels, loads, strict=True)):
            self.model.mat(_prefix(number) + "label").rgba[:3] = label
            for name, share in (("load", 0.0), ("foam", 0.35)):
                geom = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_GEOM, _prefix(number) + name)
                if load is not None and geom >= 0:
                    self.model.mat_rgba[self.model.geom_matid[geom], :3] = np.array(load) * (1 - share) + share

    def pose(self, positions: np.ndarray) -> None:
        """Put each can at u [m], phi [rad], roll [rad] and lift [m], one row for each; a frozen load turns with it."""
        joints = joint_addresses(self.model)
        for number, (scene, (u, phi, roll, lift)) in enumerate(zip(self.scenes, positions, strict=True)):
            values = {"slide": u * scale(scene), "lift": lift * scale(scene), "roll": roll, "swing": phi - roll}
            for name, value in values.items():
                if (joint := _prefix(number) + name) in joints:
                    self.data.joint(joint).qpos[:] = value
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def ends(self, number: int = 0) -> tuple[float, float]:
        """Return the coordinates y of a can's near and far end [m]."""
        half = self.scenes[number].can.length * scale(self.scenes[number]) / 2
        return self.lanes[number] - half, self.lanes[number] + half

    def outline(self, number: int, position: np.ndarray) -> np.ndarray:
        """Return points around both ends of a can [m], shape (2, points, 3), for its u, phi, roll and lift."""
        u, lift = position[[0, 3]] * scale(self.scenes[number])
        edge = circle(1.12 * RADIUS)  # with room for what sticks out
        ring = on_incline(self.scenes[number], u, RADIUS + lift) + edge
        return np.stack([np.insert(ring, 1, y, axis=1) for y in self.ends(number)])

    def draw_empty(self, sheet: Sheet, view: View) -> None:
        """Draw wall and board, flat, ten times as fast as OpenGL. The rows above and below the view are not kept."""
        y = float(self.model.geom("wall").pos[1])
        corners = view.corners(y)
        low, high = corners.min(axis=0), corners.max(axis=0)
        x, z = (_SQUARE * (np.arange(*np.floor(ends / _SQUARE + 0.5)) + 0.5) for ends in np.transpose([low, high]))
        lines = [[(at, low[1]), (at, high[1])] for at in x] + [[(low[0], at), (high[0], at)] for at in z]
        places = view.pixel(np.insert(np.reshape(lines, (-1, 2, 2)), 1, y, axis=-1))
        sheet.area(view.pixel(np.insert(corners, 1, y, axis=-1)), self.lit(_WALL, _NEAR, view))
        width = _LINE * view.scale(np.insert(low, 1, y))
        sheet.line(_separated(places), width, self.lit(_GRID, _NEAR, view))
        self._draw_board(sheet, view)

    def _draw_board(self, sheet: Sheet, view: View) -> None:
        board, scene = self.model.geom("board"), self.scenes[0]
        (front, back), (under, over) = ((board.pos[i] - board.size[i], board.pos[i] + board.size[i]) for i in (1, 2))
        seen = np.concatenate([view.corners(front), view.corners(back)]) @ on_incline(scene, 1.0, 0.0)
        stripes = _STRIPE * np.arange(seen.min() // _STRIPE - 1, seen.max() // _STRIPE + 2)
        dark = stripes[np.round(stripes / _STRIPE) % 2 == 1]
        up = in_space(scene, 0.0, 1.0, 0.0)
        for normal, edge in ((up, (back, over)), (_NEAR, (front, under))):  # every eye is over the board

            def bands(begin: np.ndarray, length: float, edges=((front, over),) * 2 + (edge,) * 2) -> np.ndarray:
                """Return the places of the parts of this face that begin somewhere down the incline."""
                ends = zip((begin, begin + length, begin + length, begin), edges, strict=True)
                points = [in_space(scene, along, z, y) for along, (y, z) in ends]
                return _separated(view.pixel(np.stack(points, axis=1)))

            sheet.area(bands(stripes[:1], float(np.ptp(stripes))), self.lit(_PALE, normal, view))
            sheet.area(bands(dark, _STRIPE), self.lit(_DARK, normal, view))
            if len(self._lines) and normal is up:
                sheet.area(bands(np.array(self._lines) - _STROKE, 2 * _STROKE), self.lit(_PAINT, normal, view))

    def shade(self, sheet: Sheet, view: View, outline: np.ndarray) -> None:
        """Draw the shadow on the board of a can whose ends have an outline, as `Display.outline` gives it."""
        along, up = in_space(self.scenes[0], np.array([1.0, 0.0]), np.array([0.0, 1.0]), 0.0)
        light, board = self.model.light_dir[0], self.model.geom("board")
        fallen = outline - np.multiply.outer((outline @ up - board.pos[2] - board.size[2]) / (light @ up), light)
        near, far = ([ring[(ring @ along).argmin()], ring[(ring @ along).argmax()]] for ring in fallen)
        corners = np.array([*near, *far[::-1]])
        middle = corners.mean(axis=0)
        for share in (0.8, 0.95):  # its edge is soft
            sheet.area(view.pixel(middle + share * (corners - middle)), (0.25, 0.15, 0.05), alpha=0.16)

    def lit(self, colour: np.ndarray, normal: np.ndarray, view: View) -> Colour:
        """Return the colour of a face that is turned to a `normal`, lit by the sun and from the eye."""
        model = self.model
        head, sun = model.vis.headlight, model.light_diffuse[0] * max(0.0, -normal @ model.light_dir[0])
        light = head.ambient + head.diffuse * max(0.0, float(normal @ view.axes[2])) + sun
        red, green, blue = np.minimum(colour * light, 1.0).tolist()
        return red, green, blue


def _prefix(number: int) -> str:
    """Return with what the names begin that belong to a lane."""
    return f"{number}-" if number else ""


def _resize(scene: Scene) -> Scene:
    """Return the scene at the size at which it is drawn, with masses of 1 kg: a pose does not depend on masses."""
    size = scale(scene)
    can = dataclasses.replace(scene.can, radius=RADIUS, length=scene.can.length * size, mass=1.0, inertia=RADIUS**2)
    load = dataclasses.replace(scene.load, mass=1.0, offset=min(scene.load.offset * size, RADIUS), inertia=RADIUS**2)
    return dataclasses.replace(scene, can=can, load=load, gravity=9.81, damping=0.0, drag=0.0)


def _separated(shapes: np.ndarray) -> np.ndarray:
    """Return places of several lines or polygons of shape (n, k, 2) as one path, with gaps (NaN)."""
    return np.concatenate([shapes, np.full_like(shapes[:, :1], np.nan)], axis=1).reshape(-1, 2)


class Painter:
    """Draws the cans of a display by OpenGL, and lays them on wall and board. It holds graphics memory until closed.

    It replaces mujoco.Renderer, which can only use the OpenGL that MUJOCO_GL named when MuJoCo was imported.
    """

    def __init__(self, display: Display, pixels: tuple[int, int], still: bool = True) -> None:
        """Prepare to draw pictures of up to so many `pixels`; `still` says that all views are the same."""
        self._display, self._still, model = display, still, display.model
        self._empty: np.ndarray | None = None
        self._scene = mujoco.MjvScene(model, model.ngeom)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = False
        self._option, self._anywhere = mujoco.MjvOption(), mujoco.MjvCamera()
        model.vis.global_.offwidth, model.vis.global_.offheight = 2 * pixels[0], 2 * pixels[1]
        model.vis.quality.offsamples = 0  # twice as many pixels, each way, take less time and show more
        model.vis.quality.shadowsize = 0  # no light casts one
        self._gl = opengl.context()
        try:
            self._gl.make_current()
            self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        except (mujoco.FatalError, RuntimeError) as error:
            raise RenderingError(f"no off-screen picture of {pixels[0]} x {pixels[1]} pixels: {error}") from error

    def paint(self, sheet: Sheet, view: View, positions: np.ndarray) -> None:
        """Draw a view onto a sheet, with u, phi, roll and lift of each can in the rows of `positions`."""
        if self._empty is None:
            self._display.draw_empty(sheet, view)
            self._empty = sheet.part(view.top, view.top + view.pixels[1]) if self._still else None
        else:
            sheet.put(self._empty, view.top)
        self._display.pose(positions)
        outlines = [self._display.outline(*of) for of in enumerate(positions)]
        for outline in outlines:
            self._display.shade(sheet, view, outline)
        for number, outline in reversed(list(enumerate(outlines))):  # the nearest at last
            left, upper, right, lower = view.box(outline, margin=3)
            if right > left and lower > upper:
                sheet.composite(self._draw(view.crop(left, upper, right, lower), number), left, view.top + upper)

    def _draw(self, view: View, number: int) -> np.ndarray:
        """Return a can in a view, shape (height, width, 4), uint8: its colour where it is, and how much it covers."""
        from OpenGL import GL

        self._option.geomgroup[:] = 0
        self._option.geomgroup[number % _UNSEEN] = 1
        scene, everything = self._scene, mujoco.mjtCatBit.mjCAT_ALL.value
        model, data = self._display.model, self._display.data
        mujoco.mjv_updateScene(model, data, self._option, None, self._anywhere, everything, scene)
        near, far = 0.2 * view.distance, 20 * view.distance  # nothing is drawn before and behind
        for eye in scene.camera:  # two of them, for stereo; MuJoCo draws their mean
            eye.pos, eye.up, eye.forward = view.eye, view.axes[1], -view.axes[2]
            eye.frustum_near, eye.frustum_far = near, far
            eye.frustum_center = near * (view.low[0] + view.high[0]) / 2
            eye.frustum_width = near * (view.high[0] - view.low[0]) / 2
            eye.frustum_bottom, eye.frustum_top = near * view.low[1], near * view.high[1]
        for light in scene.lights[: scene.nlight]:
            if light.headlight:
                light.pos, light.dir = view.eye, -view.axes[2]
        width, height = 2 * view.pixels[0], 2 * view.pixels[1]
        self._gl.make_current()
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        mujoco.mjr_render(mujoco.MjrRect(0, 0, width, height), scene, self._context)
        # Not mjr_readPixels: the fourth channel is 255, and 0 where nothing is drawn. The first row is the lowest.
        fine = np.empty((height, width, 4), np.uint8)
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, self._context.offFBO)
        GL.glReadPixels(0, 0, width, height, GL.GL_RGBA, GL.GL_UNSIGNED_BYTE, fine)
        # As red, green, blue and padding, for Pillow divides colours by what it takes for their opacity.
        return np.asarray(Image.frombuffer("RGBX", (width, height), fine, "raw", "RGBX", 0, -1).reduce(2))

    def close(self) -> None:
        """Free the graphics memory."""
        self._gl.make_current()
        self._context.free()
