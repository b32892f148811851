"""The drawn scene: one can, or several side by side, on their board.

It is posed, never stepped, and drawn by OpenGL. Its cans have the radius of the templates' can,
whatever the scene's is: none is too small or too large for the single precision of the graphics.
"""

import dataclasses
from collections.abc import Sequence

import mujoco
import numpy as np
from PIL import Image
from scipy.interpolate import CubicHermiteSpline

from mjbeer.drawing import opengl
from mjbeer.drawing.camera import View, circle, on_incline, scale
from mjbeer.drawing.scenery import Scenery
from mjbeer.drawing.sheet import Sheet
from mjbeer.exceptions import ParameterError, RenderingError
from mjbeer.model import looks
from mjbeer.model.build import rolling_spec
from mjbeer.model.joints import joint_addresses
from mjbeer.model.mjcf_file import compile_spec
from mjbeer.model.setting import Setting
from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

_UNSEEN = mujoco.mjNGROUP - 1
"""The group of geoms that are not drawn. Each can has one of the groups before it to itself."""
_PALER = 0.35
"""How far the colour of foam is on the way from its load's to white."""


def coordinates(motion: Trajectory, times: np.ndarray) -> np.ndarray:
    """Return u [m], phi [rad], roll [rad] and lift [m] at some times [s], shape (times, 4).

    Between two samples each is the cubic that has their values and rates; its error falls with the
    fourth power of the interval.
    """
    samples = np.stack([motion.u, motion.phi, motion.roll, motion.lift], axis=1)
    if len(samples) == 1:
        return np.repeat(samples, len(times), axis=0)
    rates = np.stack([motion.u_dot, motion.phi_dot, motion.roll_dot, motion.lift_dot], axis=1)
    return CubicHermiteSpline(motion.time, samples, rates)(times)


class Display:
    """A model of a board with cans on it, and a wall behind.

    All cans are drawn with one radius. Joints are named as in the templates, with a prefix for
    each lane. Lengths are as drawn.
    """

    def __init__(
        self, scenes: Sequence[Scene], apart: float = 0.0, lines: Sequence[float] = ()
    ) -> None:
        """Make the display of cans on one incline, `apart` [m] from each other, the nearest first.

        At each distance [m] down the incline in `lines` a line crosses the board.

        Raises:
          ParameterError: if there are more than five cans: each must be drawn by itself.
        """
        if len(scenes) > _UNSEEN:
            raise ParameterError(f"at most {_UNSEEN} cans can be drawn together, got {len(scenes)}")
        self.scenes = scenes
        self.lanes = [lane * apart for lane in range(len(scenes))]
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
        self.scenery = Scenery(self.model, scenes[0], lines)

    def paint(
        self, labels: Sequence[Sequence[float]], loads: Sequence[Sequence[float] | None]
    ) -> None:
        """Give the label of each can a colour, and each load, unless its colour is None.

        The foam on a load gets a paler shade of its colour.
        """
        for number, (label, load) in enumerate(zip(labels, loads, strict=True)):
            self.model.mat(_prefix(number) + "label").rgba[:3] = label
            if load is not None:
                colour = np.array(load)
                self._paint_geom(_prefix(number) + "load", colour)
                self._paint_geom(_prefix(number) + "foam", colour + _PALER * (1 - colour))

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
        geom.group = group if of_can else _UNSEEN
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
    load = dataclasses.replace(
        scene.load, mass=1.0, offset=offset, inertia=RADIUS**2, sloshes_in=None
    )
    return dataclasses.replace(scene, can=can, load=load, gravity=9.81, damping=0.0, drag=0.0)


def _prefix(number: int) -> str:
    """Return what the names in a lane begin with."""
    return f"{number}-" if number else ""


class Painter:
    """Draws the cans of a display by OpenGL, and lays them on wall and board.

    It holds graphics memory until it is closed. It stands in for `mujoco.Renderer`, which can only
    use the OpenGL that MUJOCO_GL named when MuJoCo was imported.
    """

    def __init__(self, display: Display, pixels: tuple[int, int], still: bool = True) -> None:
        """Prepare to draw pictures of at most so many `pixels`, all with one view if `still`."""
        self._display = display
        self._still = still
        self._empty: np.ndarray | None = None
        model = display.model
        model.vis.global_.offwidth = 2 * pixels[0]
        model.vis.global_.offheight = 2 * pixels[1]
        # Pictures are drawn with twice as many pixels each way and then reduced, which takes less
        # time than multisampling and shows more.
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
            self._display.scenery.draw(sheet, view)
            if self._still:
                self._empty = sheet.part(view.top, view.top + view.pixels[1])
        self._display.pose(positions)
        outlines = [
            self._display.outline(number, position) for number, position in enumerate(positions)
        ]
        for outline in outlines:
            self._display.scenery.shade(sheet, view, outline)
        for number in reversed(range(len(outlines))):  # the nearest comes last
            self._lay(sheet, view, number, outlines[number])

    def paint_end(self, sheet: Sheet, view: View, number: int, position: np.ndarray) -> None:
        """Draw the near end of a can on a small sheet; a `paint` has put it at its position."""
        near, _ = self._display.ends(number)
        self._display.scenery.draw_slice(sheet, view, near)
        self._lay(sheet, view, number, self._display.outline(number, position))

    def _lay(self, sheet: Sheet, view: View, number: int, outline: np.ndarray) -> None:
        """Lay a can with an outline on a sheet."""
        edges = view.edges(outline, margin=3)
        if edges.right > edges.left and edges.lower > edges.upper:
            can = self._draw(view.crop(edges), number)
            sheet.composite(can, edges.left, view.top + edges.upper)

    def _draw(self, view: View, number: int) -> np.ndarray:
        """Return the picture of a can in a view, shape (height, width, 4), uint8.

        The last channel is how much the can covers.
        """
        from OpenGL import GL

        self._option.geomgroup[:] = 0
        self._option.geomgroup[number] = 1
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
        # Pillow is told that the fourth channel is padding: it would divide the colours by an
        # opacity.
        whole = Image.frombuffer("RGBX", (width, height), fine, "raw", "RGBX", 0, -1)
        return np.asarray(whole.reduce(2))

    def _place_eye(self, view: View) -> None:
        """Put the two eyes and the headlight of MuJoCo's scene where the eye of the view is."""
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
