"""The model that is drawn for a scene: it is posed at the coordinates of a trajectory, and never stepped.

Its can has the radius of the templates' can, whatever the scene's radius is. All scenes then look alike, and none is
too small or too large for the graphics, which compute in single precision.
"""

import dataclasses

import mujoco

from mjbeer.model import appearance
from mjbeer.model.build import compile_spec, compose
from mjbeer.model.setting import Setting
from mjbeer.model.state import places
from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene


def display_model(scene: Scene, reach: tuple[float, float] = (0.0, 0.0), aspect: float = 16 / 9) -> mujoco.MjModel:
    """Return the model that shows a scene. Its joints are "slide", "lift", "roll" and, for a sliding load, "swing".

    `reach` is the lowest and the highest u [m] that will be shown: the board and the camera "overview" cover this
    range. `aspect` is the width of the picture over its height.

    Raises:
      TemplateError: if a template is missing, lacks a part, or has a part that is not allowed.
      UnsupportedError: if MuJoCo cannot compile the geoms of a template.
    """
    resized = _resize(scene)
    spec = compose(resized, Setting("contact"), visuals=True)
    appearance.extend(spec, resized, reach[0] * scale(scene), reach[1] * scale(scene), aspect)
    return compile_spec(spec)


def scale(scene: Scene) -> float:
    """Return the length [m] at which one metre of the scene is drawn."""
    return RADIUS / scene.can.radius


def pose(
    model: mujoco.MjModel, data: mujoco.MjData, scene: Scene, u: float, phi: float, roll: float, lift: float
) -> None:
    """Pose the display model: the axis at `u` [m] and `lift` [m], the load at `phi` and the can at `roll` [rad].

    A frozen load turns with the can. Cameras follow the can along the incline but do not rise with it, so that a hop
    can be seen.
    """
    values = {"slide": u * scale(scene), "lift": 0.0, "roll": roll, "swing": phi - roll}
    for name in places(model):
        data.joint(name).qpos[:] = values[name]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    data.joint("lift").qpos[:] = lift * scale(scene)
    mujoco.mj_kinematics(model, data)


def _resize(scene: Scene) -> Scene:
    """Return the scene at the size at which it is drawn, with masses of 1 kg: a pose does not depend on masses."""
    size = scale(scene)
    can = dataclasses.replace(scene.can, radius=RADIUS, length=scene.can.length * size, mass=1.0, inertia=RADIUS**2)
    load = dataclasses.replace(scene.load, mass=1.0, offset=min(scene.load.offset * size, RADIUS), inertia=RADIUS**2)
    return dataclasses.replace(scene, can=can, load=load, gravity=9.81)
