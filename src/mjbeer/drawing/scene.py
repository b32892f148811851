"""The drawn scene: one can, or several side by side, on their board.

It is posed, never stepped, and drawn by OpenGL. Its cans have the radius of the templates' can,
whatever the scene's is: none is too small or too large for the single precision of the graphics.
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

_UNSEEN = 5
"""The group of geoms that are not drawn. Each can is in one of the groups before it."""
_STRIPE = math.pi / 2 * RADIUS
"""Length of a stripe of the board [m]. A pale one begins at x = 0, as in the templates."""
_PALE = np.array([0.94, 0.84, 0.69])
_DARK = np.array([0.84, 0.71, 0.54])
"""Colours of the stripes, as in mjcf/assets.xml."""
_SQUARE = 0.1
"""Distance of the lines on the wall [m]; x = 0 is half-way between two of them."""
_WALL = np.array([0.985, 0.99, 1.0])
_GRID = np.array([0.84, 0.87, 0.92])
"""Colours of the wall and of its lines, as in mjcf/scene.xml."""
_PAINT = np.array([0.15, 0.17, 0.2])
"""Colour of lines across the board, such as the start of a race."""
_STROKE = 0.003
"""Half the width of these lines [m]."""
_NEAR = np.array([0.0, -1.0, 0.0])
"""Unit vector towards the reader."""


def coordinates(trajectory: Trajectory, times: np.ndarray) -> np.ndarray:
    """Return u [m], phi [rad], roll [rad] and lift [m] at some times [s], shape (times, 4).

    Between samples each is the cubic with their values and rates, whose error falls as the
    interval's fourth power.
    """
    motion = trajectory
    samples = np.stack([motion.u, motion.phi, motion.roll, motion.lift], axis=1)
    if len(samples) == 1:
        return np.repeat(samples, len(times), axis=0)
    rates = np.stack([motion.u_dot, motion.phi_dot, motion.roll_dot, motion.lift_dot], axis=1)
    return CubicHermiteSpline(motion.time, samples, rates)(times)


class Display:
    """A board with cans of one size on it, and a wall behind.

    Joints are named as in the templates, with a prefix for each lane. All lengths are as drawn.
    """

    def __init__(
        self, scenes: Sequence[Scene], apart: float = 0.0, lines: Sequence[float] = ()
    ) -> None:
        """Make the display of cans on one incline, `apart` [m] from each other, the nearest first.

        At each distance [m] down the incline in `lines` a line crosses the board.
        """
        self.scenes = scenes
        self.lanes = [lane * apart for lane in range(len(scenes))]
        self._lines = lines
        first, *others = (_drawn_spec(scene, group) for group, scene in enumerate(scenes))
        parent = first.body("incline") or first.worldbody
        for number, spec in enumerate(others, start=1):
            spec.option.tolerance = first.option.tolerance  # nothing is stepped here
            frame = parent.add_frame(pos=[0, self.lanes[number], 0])
            frame.attach_body(spec.body("can"), _prefix(number), "")
        board = first.geom("board")
        board.pos += [0, self.lanes[-1] / 2, 0]
        board.size += [0, self.lanes[-1] / 2, 0]
        first.geom("wall").pos += [0, self.lanes[-1], 0]
        self.model = compile_spec(first)
        self.data = mujoco.MjData(self.model)

    def paint(
        self, labels: Sequence[Sequence[float]], loads: Sequence[Sequence[float] | None]
    ) -> None:
        """Give each can's label a colour, and its load too unless that is None.

        What is on a load that has a colour is paler.
        """
        for number, (label, load) in enumerate(zip(labels, loads, strict=True)):
            self.model.mat(_prefix(number) + "label").rgba[:3] = label
            if load is not None:
                self._paint_geom(_prefix(number) + "load", np.array(load))
                self._paint_geom(_prefix(number) + "foam", np.array(load) * (1 - 0.35) + 0.35)

    def _paint_geom(self, name: str, colour: np.ndarray) -> None:
        """Give the material of a geom a colour, if there is this geom."""
        geom = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_GEOM, name)
        if geom >= 0:
            self.model.mat_rgba[self.model.geom_matid[geom], :3] = colour

    def pose(self, positions: np.ndarray) -> None:
        """Put each can at the u [m], phi [rad], roll [rad] and lift [m] of its row.

        A frozen load turns with its can.
        """
        joints = joint_addresses(self.model)
        for number, (scene, position) in enumerate(zip(self.scenes, positions, strict=True)):
            u, phi, roll, lift = position
            coordinate = {
                "slide": u * scale(scene),
                "lift": lift * scale(scene),
                "roll": roll,
                "swing": phi - roll,
            }
            for name, value in coordinate.items():
                joint = _prefix(number) + name
                if joint in joints:
                    self.data.joint(joint).qpos[:] = value
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def ends(self, number: int = 0) -> tuple[float, float]:
        """Return the coordinates y of a can's near and far end [m]."""
        scene = self.scenes[number]
        half = scene.can.length * scale(scene) / 2
        return self.lanes[number] - half, self.lanes[number] + half

    def outline(self, number: int, position: np.ndarray) -> np.ndarray:
        """Return points around both ends of a can at a position [m], shape (2, points, 3)."""
        scene = self.scenes[number]
        u, lift = position[[0, 3]] * scale(scene)
        edge = circle(1.12 * RADIUS)  # with room for what sticks out
        ring = on_incline(scene, u, RADIUS + lift) + edge
        return np.stack([np.insert(ring, 1, y, axis=1) for y in self.ends(number)])

    def draw_empty(self, sheet: Sheet, view: View) -> None:
        """Draw wall and board, flat, ten times as fast as OpenGL.

        The rows above and below the view are not kept.
        """
        self._draw_wall(sheet, view)
        self._draw_board(sheet, view)

    def _draw_wall(self, sheet: Sheet, view: View) -> None:
        y = float(self.model.geom("wall").pos[1])
        corners = view.corners(y)
        left, low = corners.min(axis=0)
        right, high = corners.max(axis=0)
        upright = [[(x, low), (x, high)] for x in _grid(left, right)]
        level = [[(left, z), (right, z)] for z in _grid(low, high)]
        lines = np.reshape(upright + level, (-1, 2, 2))
        sheet.area(view.pixel(np.insert(corners, 1, y, axis=-1)), self.lit(_WALL, _NEAR, view))
        places = view.pixel(np.insert(lines, 1, y, axis=-1))
        width = _SQUARE / 64 * view.scale(np.array([left, y, low]))
        sheet.line(_separated(places), width, self.lit(_GRID, _NEAR, view))

    def _draw_board(self, sheet: Sheet, view: View) -> None:
        """Draw the upper side of the board and its front: every eye sees these two."""
        board = self.model.geom("board")
        front = board.pos[1] - board.size[1]
        back = board.pos[1] + board.size[1]
        under = board.pos[2] - board.size[2]
        over = board.pos[2] + board.size[2]
        scene = self.scenes[0]
        seen = np.concatenate([view.corners(front), view.corners(back)])
        along = seen @ on_incline(scene, 1.0, 0.0)
        stripes = _STRIPE * np.arange(along.min() // _STRIPE - 1, along.max() // _STRIPE + 2)
        dark = stripes[np.round(stripes / _STRIPE) % 2 == 1]

        def bands(begin: np.ndarray, length: float, y: float, z: float) -> np.ndarray:
            """Return the places of bands that begin somewhere down the incline.

            They run from the upper front edge of the board to the edge at `y` and `z`.
            """
            end = begin + length
            corners = [
                in_space(scene, begin, over, front),
                in_space(scene, end, over, front),
                in_space(scene, end, z, y),
                in_space(scene, begin, z, y),
            ]
            return _separated(view.pixel(np.stack(corners, axis=1)))

        up = in_space(scene, 0.0, 1.0, 0.0)
        whole = float(np.ptp(stripes))
        lines = np.array(self._lines) - _STROKE
        sheet.area(bands(stripes[:1], whole, back, over), self.lit(_PALE, up, view))
        sheet.area(bands(dark, _STRIPE, back, over), self.lit(_DARK, up, view))
        if len(lines):
            sheet.area(bands(lines, 2 * _STROKE, back, over), self.lit(_PAINT, up, view))
        sheet.area(bands(stripes[:1], whole, front, under), self.lit(_PALE, _NEAR, view))
        sheet.area(bands(dark, _STRIPE, front, under), self.lit(_DARK, _NEAR, view))

    def shade(self, sheet: Sheet, view: View, outline: np.ndarray) -> None:
        """Draw the shadow on the board of a can with an outline, as `Display.outline` gives it."""
        scene = self.scenes[0]
        along = in_space(scene, 1.0, 0.0, 0.0)
        up = in_space(scene, 0.0, 1.0, 0.0)
        light = self.model.light_dir[0]
        board = self.model.geom("board")
        height = outline @ up - board.pos[2] - board.size[2]
        near, far = outline - np.multiply.outer(height / (light @ up), light)
        corners = np.array(
            [
                near[(near @ along).argmin()],
                near[(near @ along).argmax()],
                far[(far @ along).argmax()],
                far[(far @ along).argmin()],
            ]
        )
        middle = corners.mean(axis=0)
        for share in (0.8, 0.95):  # its edge is soft
            shadow = middle + share * (corners - middle)
            sheet.area(view.pixel(shadow), (0.25, 0.15, 0.05), alpha=0.16)

    def lit(self, colour: np.ndarray, normal: np.ndarray, view: View) -> Colour:
        """Return the colour of a face with a `normal`, lit by the sun and from the eye."""
        model = self.model
        head = model.vis.headlight
        sun = model.light_diffuse[0] * max(0.0, -normal @ model.light_dir[0])
        light = head.ambient + head.diffuse * max(0.0, float(normal @ view.axes[2])) + sun
        red, green, blue = np.minimum(colour * light, 1.0).tolist()
        return red, green, blue


def _drawn_spec(scene: Scene, group: int) -> mujoco.MjSpec:
    """Return what is drawn of a scene, with the geoms of its can in a group."""
    resized = _resize(scene)
    spec = rolling_spec(resized, Setting("contact"), visuals=True)
    if scene.load.fill is not None:
        looks.shape_beer(spec, resized, edges=64)  # a circle, to the eye
    for pair in spec.pairs:
        spec.delete(pair)
    for geom in spec.geoms:
        of_can = geom.group == looks.VISUAL_GROUP and geom.name not in ("board", "wall")
        geom.group = group % _UNSEEN if of_can else _UNSEEN
    return spec


def _resize(scene: Scene) -> Scene:
    """Return the scene at the size at which it is drawn, with masses of 1 kg.

    A pose does not depend on masses.
    """
    can = dataclasses.replace(
        scene.can,
        radius=RADIUS,
        length=scene.can.length * scale(scene),
        mass=1.0,
        inertia=RADIUS**2,
    )
    offset = min(scene.load.offset * scale(scene), RADIUS)
    load = dataclasses.replace(scene.load, mass=1.0, offset=offset, inertia=RADIUS**2)
    return dataclasses.replace(scene, can=can, load=load, gravity=9.81, damping=0.0, drag=0.0)


def _prefix(number: int) -> str:
    """Return with what the names begin that belong to a lane."""
    return f"{number}-" if number else ""


def _grid(low: float, high: float) -> np.ndarray:
    """Return the places of the lines on the wall between two places [m]."""
    first, last = np.floor(np.array([low, high]) / _SQUARE + 0.5)
    return _SQUARE * (np.arange(first, last) + 0.5)


def _separated(shapes: np.ndarray) -> np.ndarray:
    """Return lines or polygons of shape (n, k, 2) as one path, with gaps (NaN)."""
    gap = np.full_like(shapes[:, :1], np.nan)
    return np.concatenate([shapes, gap], axis=1).reshape(-1, 2)


class Painter:
    """Draws the cans of a display by OpenGL, and lays them on wall and board.

    It holds graphics memory until closed.

    It replaces mujoco.Renderer, which can only use the OpenGL that MUJOCO_GL named when MuJoCo was
    imported.
    """

    def __init__(self, display: Display, pixels: tuple[int, int], still: bool = True) -> None:
        """Prepare to draw pictures of at most some `pixels`, all with one view if `still`."""
        self._display = display
        self._still = still
        self._empty: np.ndarray | None = None
        model = display.model
        model.vis.global_.offwidth = 2 * pixels[0]
        model.vis.global_.offheight = 2 * pixels[1]
        # Pictures are drawn with twice as many pixels each way, which takes less time than samples
        # and shows more.
        model.vis.quality.offsamples = 0
        model.vis.quality.shadowsize = 0  # no light casts one
        self._option = mujoco.MjvOption()
        self._camera = mujoco.MjvCamera()
        self._scene = mujoco.MjvScene(model, model.ngeom)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = False
        self._gl = opengl.context()
        try:
            self._gl.make_current()
            font = mujoco.mjtFontScale.mjFONTSCALE_100.value
            self._context = mujoco.MjrContext(model, font)
        except (mujoco.FatalError, RuntimeError) as error:
            size = f"{pixels[0]} x {pixels[1]}"
            raise RenderingError(f"no off-screen picture of {size} pixels: {error}") from error

    def paint(self, sheet: Sheet, view: View, positions: np.ndarray) -> None:
        """Draw a view onto a sheet; a row of `positions` is a can's u, phi, roll and lift."""
        if self._empty is not None:
            sheet.put(self._empty, view.top)
        else:
            self._display.draw_empty(sheet, view)
            if self._still:
                self._empty = sheet.part(view.top, view.top + view.pixels[1])
        self._display.pose(positions)
        outlines = [
            self._display.outline(number, position) for number, position in enumerate(positions)
        ]
        for outline in outlines:
            self._display.shade(sheet, view, outline)
        for number in reversed(range(len(outlines))):  # the nearest at last
            edges = view.edges(outlines[number], margin=3)
            if edges.right > edges.left and edges.lower > edges.upper:
                can = self._draw(view.crop(edges), number)
                sheet.composite(can, edges.left, view.top + edges.upper)

    def _draw(self, view: View, number: int) -> np.ndarray:
        """Return a can in a view, shape (height, width, 4), uint8.

        The last channel is how much the can covers."""
        from OpenGL import GL

        self._option.geomgroup[:] = 0
        self._option.geomgroup[number % _UNSEEN] = 1
        mujoco.mjv_updateScene(
            self._display.model,
            self._display.data,
            self._option,
            None,
            self._camera,
            mujoco.mjtCatBit.mjCAT_ALL.value,
            self._scene,
        )
        self._place_eye(view)
        width = 2 * view.pixels[0]
        height = 2 * view.pixels[1]
        self._gl.make_current()
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        mujoco.mjr_render(mujoco.MjrRect(0, 0, width, height), self._scene, self._context)
        # mjr_readPixels leaves out the fourth channel, which is 255, and 0 where nothing is drawn.
        # The first row is the lowest.
        fine = np.empty((height, width, 4), np.uint8)
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, self._context.offFBO)
        GL.glReadPixels(0, 0, width, height, GL.GL_RGBA, GL.GL_UNSIGNED_BYTE, fine)
        # As red, green, blue and padding, for Pillow divides colours by what it takes for their
        # opacity.
        whole = Image.frombuffer("RGBX", (width, height), fine, "raw", "RGBX", 0, -1)
        return np.asarray(whole.reduce(2))

    def _place_eye(self, view: View) -> None:
        """Let the scene be seen in a view, by light from its eye."""
        # Nothing is drawn nearer to the eye than this, or beyond `frustum_far`.
        near = 0.2 * view.distance
        for eye in self._scene.camera:  # two of them, for stereo; MuJoCo draws their mean
            eye.pos = view.eye
            eye.up = view.axes[1]
            eye.forward = -view.axes[2]
            eye.frustum_near = near
            eye.frustum_far = 20 * view.distance
            eye.frustum_center = near * (view.low[0] + view.high[0]) / 2
            eye.frustum_width = near * (view.high[0] - view.low[0]) / 2
            eye.frustum_bottom = near * view.low[1]
            eye.frustum_top = near * view.high[1]
        for light in self._scene.lights[: self._scene.nlight]:
            if light.headlight:
                light.pos = view.eye
                light.dir = -view.axes[2]

    def close(self) -> None:
        """Free the graphics memory."""
        self._gl.make_current()
        self._context.free()
