"""The model that is drawn: one for every kind of trajectory of a scene, posed and never stepped.

It has the size of the templates' can whatever the scene's is: so all scenes look alike, and none is too
small or too large for the graphics, which compute in single precision.
"""

import dataclasses

import mujoco

from mjbeer.model import appearance
from mjbeer.model.build import compile_spec, specify
from mjbeer.model.setting import Setting
from mjbeer.model.state import places
from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene


def display_model(scene: Scene, reach: tuple[float, float] = (0.0, 0.0), aspect: float = 16 / 9) -> mujoco.MjModel:
    """The model that shows a scene: its joints are "slide", "lift", "roll" and, for a sliding load, "swing".

    `reach` is the lowest and the highest u [m] that will be shown, which the board and the camera "overview"
    span; `aspect` is the width of the picture over its height.

    Raises:
      TemplateError: if a template is missing, lacks a part, or has one that is not allowed.
      UnsupportedError: if MuJoCo refuses what a template shows.
    """
    drawn = _drawn(scene)
    spec = specify(drawn, Setting("contact"), visuals=True)
    appearance.extend(spec, drawn, reach[0] * scale(scene), reach[1] * scale(scene), aspect)
    return compile_spec(spec)


def scale(scene: Scene) -> float:
    """Drawn length of a metre of the scene."""
    return RADIUS / scene.can.radius


def pose(
    model: mujoco.MjModel, data: mujoco.MjData, scene: Scene, u: float, phi: float, roll: float, lift: float
) -> None:
    """Pose the display model: the axis at `u` [m] and `lift` [m], the load at `phi` and the can at `roll` [rad].

    A frozen load turns with the can. Cameras go with the can along the incline, but do not rise with it: a hop
    is to be seen.
    """
    values = {"slide": u * scale(scene), "lift": 0.0, "roll": roll, "swing": phi - roll}
    for name in places(model):
        data.joint(name).qpos[:] = values[name]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    data.joint("lift").qpos[:] = lift * scale(scene)
    mujoco.mj_kinematics(model, data)


def _drawn(scene: Scene) -> Scene:
    """The scene at the size it is drawn, with any masses that MuJoCo takes: a pose does not depend on them."""
    size = scale(scene)
    can = dataclasses.replace(scene.can, radius=RADIUS, length=scene.can.length * size, mass=1.0, inertia=RADIUS**2)
    load = dataclasses.replace(scene.load, mass=1.0, offset=min(scene.load.offset * size, RADIUS), inertia=RADIUS**2)
    return dataclasses.replace(scene, can=can, load=load, gravity=9.81)
