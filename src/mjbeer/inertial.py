"""Mass and inertia of a body in the plane of the motion."""

import mujoco


def set_inertial(body: mujoco.MjsBody, mass: float, offset: float, inertia: float) -> None:
    """Give a body a `mass` [kg] at `offset` [m] below its axis and an axial `inertia` about it [kg m^2]."""
    body.explicitinertial = True
    body.mass, body.ipos, body.inertia = mass, [0, 0, -offset], [inertia] * 3


def weightless(body: mujoco.MjsBody) -> None:
    """Take mass and inertia from a body that is fixed to another, which then stands for both."""
    set_inertial(body, 0.0, 0.0, 0.0)
