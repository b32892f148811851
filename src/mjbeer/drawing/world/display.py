"""The model that is drawn: one can, or several side by side. It is posed, and never stepped.

Its cans have the radius of the templates' can, whatever the scene's radius is. All scenes then look alike, and none is
too small or too large for the graphics, which compute in single precision.
"""

import dataclasses
import math
from collections.abc import Sequence
from typing import TypeAlias

import mujoco
import numpy as np

from mjbeer.model import looks
from mjbeer.model.build import compile_spec, compose
from mjbeer.model.setting import Setting
from mjbeer.model.state import places
from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene

_PAINT = [0.15, 0.17, 0.2, 1.0]
"""Colour of lines on the board."""
Colour: TypeAlias = tuple[float, float, float]
_PALER = 0.35
"""How much nearer to white the surface of a painted load is."""
_HIDDEN = 1e3
"""How far off a hidden can is [m]: behind whatever looks at the board."""


@dataclasses.dataclass(frozen=True, eq=False)
class Display:
    """A board with cans of one size on it. Their joints are named as in the templates, with a prefix for each lane."""

    model: mujoco.MjModel
    data: mujoco.MjData
    scenes: Sequence[Scene]
    lanes: Sequence[float]
    """Where each can is across the board [m], away from the reader."""

    @classmethod
    def of(
        cls, scenes: Sequence[Scene], low: float, high: float, apart: float = 0.0, lines: Sequence[float] = ()
    ) -> "Display":
        """Return the display of cans on one incline, whose board is long enough for u from `low` to `high` [m].

        The cans are `apart` [m] from each other, the first of them nearest to the reader. `lines` are distances down
        the incline at which a line is drawn across the board [m]. All these lengths are as drawn.

        Raises:
          TemplateError: if a template is missing, lacks a part, or has a part that is not allowed.
          UnsupportedError: if MuJoCo cannot compile the geoms of a template.
        """
        lanes = [lane * apart for lane in range(len(scenes))]
        specs = [compose(_resize(scene), Setting("contact"), visuals=True) for scene in scenes]
        for spec in specs:
            for pair in spec.pairs:
                spec.delete(pair)
        board, *others = specs
        looks.lengthen(board, _resize(scenes[0]), low, high)
        for number, (lane, spec) in enumerate(zip(lanes[1:], others, strict=True), start=1):
            frame = board.body("incline").add_frame(pos=[0, lane, 0])
            frame.attach_body(spec.body("can"), _prefix(number), "")
        planks = board.geom("board")
        planks.pos = [planks.pos[0], planks.pos[1] + lanes[-1] / 2, planks.pos[2]]
        planks.size = [planks.size[0], planks.size[1] + lanes[-1] / 2, planks.size[2]]
        wall = board.geom("wall")
        wall.pos = [*wall.pos[:1], wall.pos[1] + lanes[-1], *wall.pos[2:]]
        for number, along in enumerate(lines):
            _add_line(board, f"line{number}", along)
        model = compile_spec(board)
        return cls(model, mujoco.MjData(model), scenes, lanes)

    def paint(self, labels: Sequence[Colour], loads: Sequence[Colour | None]) -> None:
        """Give each can's label a colour, and its load too unless that is None; what is on the load is then paler."""
        for number, (label, load) in enumerate(zip(labels, loads, strict=True)):
            self.model.mat(_prefix(number) + "label").rgba[:3] = label
            if load is not None:
                for name, share in (("load", 0.0), ("foam", _PALER)):
                    self._paint(_prefix(number) + name, np.array(load) * (1 - share) + share)

    def _paint(self, name: str, colour: np.ndarray) -> None:
        """Give the material of a geom a colour, if the model has the geom."""
        geom = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_GEOM, name)
        if geom >= 0:
            self.model.mat_rgba[self.model.geom_matid[geom], :3] = colour

    def pose(self, positions: np.ndarray) -> None:
        """Put each can at u [m], phi [rad], roll [rad] and lift [m], one row for each; a frozen load turns with it."""
        joints = places(self.model)
        for number, (scene, (u, phi, roll, lift)) in enumerate(zip(self.scenes, positions, strict=True)):
            size = scale(scene)
            values = {"slide": u * size, "lift": lift * size, "roll": roll, "swing": phi - roll}
            for name, value in values.items():
                if (joint := _prefix(number) + name) in joints:
                    self.data.joint(joint).qpos[:] = value
        self._place()

    def hide(self) -> None:
        """Put all cans where nobody sees them."""
        for number in range(len(self.scenes)):
            self.data.joint(_prefix(number) + "lift").qpos[:] = _HIDDEN
        self._place()

    def _place(self) -> None:
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def length(self, number: int = 0) -> float:
        """Return the length of a can as drawn [m]."""
        return self.scenes[number].can.length * scale(self.scenes[number])

    def front(self, number: int = 0) -> float:
        """Return the coordinate y of a can's near end [m]."""
        return self.lanes[number] - self.length(number) / 2


def scale(scene: Scene) -> float:
    """Return the length [m] at which one metre of the scene is drawn."""
    return RADIUS / scene.can.radius


def on_incline(scene: Scene, along: np.ndarray | float, height: np.ndarray | float) -> np.ndarray:
    """Return x and z of points `along` the incline and at a `height` over it, in one unit, shape (..., 2)."""
    sine, cosine = math.sin(scene.incline), math.cos(scene.incline)
    x, z = along * cosine + height * sine, height * cosine - along * sine
    return np.stack(np.broadcast_arrays(x, z), axis=-1)


def _add_line(spec: mujoco.MjSpec, name: str, along: float) -> None:
    """Add a dark line across the board, as thin as a coat of paint, to its specification."""
    board = spec.geom("board")
    top, half = board.pos[2] + board.size[2], [0.003, board.size[1], 0.0002]
    body, kind = spec.body("incline"), mujoco.mjtGeom.mjGEOM_BOX
    body.add_geom(spec.default, name=name, type=kind, size=half, pos=[along, board.pos[1], top], rgba=_PAINT, group=2)


def _prefix(number: int) -> str:
    return f"{number}-" if number else ""


def _resize(scene: Scene) -> Scene:
    """Return the scene at the size at which it is drawn, with masses of 1 kg: a pose does not depend on masses."""
    size = scale(scene)
    can = dataclasses.replace(scene.can, radius=RADIUS, length=scene.can.length * size, mass=1.0, inertia=RADIUS**2)
    load = dataclasses.replace(scene.load, mass=1.0, offset=min(scene.load.offset * size, RADIUS), inertia=RADIUS**2)
    return dataclasses.replace(scene, can=can, load=load, gravity=9.81, damping=0.0, drag=0.0)
