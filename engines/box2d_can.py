# /// script
# requires-python = ">=3.11"
# dependencies = ["pyb2d3==0.11.1", "numpy==2.4.6"]
# ///
"""A can in Box2D 3: a circle on a segment, in two dimensions and single precision."""

import math

import pyb2d3
from common import Case, Motion, Setting, State, answer, repeated, sampled

STIFF = "lengths times 30, as Box2D is made for metres; contact_hertz 1e4 instead of 30"
SETTINGS = [
    Setting("circle", "default"),
    Setting("circle", "long, stiff contact", STIFF, {"scale": 30, "hertz": 1e4}),
    Setting(
        "circle",
        "long, stiff contact, one substep",
        f"{STIFF}; one substep instead of four",
        {"scale": 30, "hertz": 1e4, "substeps": 1},
    ),
]
SUBSTEPS = 4
"""The number that Box2D's manual recommends."""
FARTHEST = 10
"""The ends of the incline [m]."""


def roll(case: Case, timestep: float, setting: Setting) -> Motion:
    """Roll the can with a timestep [s]. Angles grow to the left, and so have the other sign."""
    case = case.scaled(setting.values.get("scale", 1.0))
    substeps = setting.values.get("substeps", SUBSTEPS)
    options = {}
    if "hertz" in setting.values:
        options["contact_hertz"] = setting.values["hertz"]
    gravity = case.gravity_x, case.gravity_z
    world = pyb2d3.World(gravity=gravity, **options)
    material = pyb2d3.surface_material(friction=case.friction, restitution=0.0)
    ground = world.create_static_body(position=(0, 0))
    far = FARTHEST * case.scale
    ground.create_shape(pyb2d3.shape_def(material=material), pyb2d3.segment((-far, 0), (far, 0)))
    turned = pyb2d3.Rot()  # `make_rot` and `angle` are approximations, 4e-4 rad off
    turned.c = math.cos(case.phi0)
    turned.s = -math.sin(case.phi0)
    can = world.create_dynamic_body(
        position=(case.u0, case.radius),
        rotation=turned,
        linear_damping=0,
        angular_damping=0,
        enable_sleep=False,
    )
    can.create_shape(
        pyb2d3.shape_def(material=material, density=1),
        pyb2d3.circle(center=(0, 0), radius=case.radius),
    )
    masses = pyb2d3.MassData()
    masses.mass = case.mass
    masses.center = (0, -case.offset)
    masses.rotational_inertia = case.inertia
    can.mass_data = masses
    can.linear_velocity = case.centre_velocity
    can.angular_velocity = -case.phi_dot0

    def read() -> State:
        x, _ = can.position
        phi = math.atan2(-can.rotation.s, can.rotation.c)
        phi_dot = -can.angular_velocity
        along, _ = can.linear_velocity  # of the centre of mass
        return State(phi, x, phi_dot, along + case.offset * math.cos(phi) * phi_dot)

    return sampled(case, timestep, repeated(lambda: world.step(timestep, substeps)), read)


if __name__ == "__main__":
    answer("Box2D", SETTINGS, roll, ("pyb2d3",))
