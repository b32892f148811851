# /// script
# requires-python = ">=3.11"
# dependencies = ["pymunk==7.3.1"]
# ///
"""A can in Pymunk, which is Chipmunk in Python: a circle on a segment, in two dimensions."""

import math

import pymunk
from common import Case, Motion, Setting, State, answer, repeated, sampled

SETTINGS = [
    Setting("circle", "default"),
    Setting(
        "circle",
        "no slop",
        "no collision_slop, which is 0.1 lengths and so three radii by default; 20 iterations",
        {"collision_slop": 0.0, "iterations": 20},
    ),
]


def roll(case: Case, timestep: float, setting: Setting) -> Motion:
    """Roll the can with a timestep [s]. Angles grow to the left, and so have the other sign."""
    space = pymunk.Space()
    space.gravity = case.gravity_x, case.gravity_z
    for name, value in setting.values.items():
        setattr(space, name, value)
    ground = pymunk.Segment(space.static_body, (-100, -1), (100, -1), 1)  # it is 1 m thick
    body = pymunk.Body(case.mass, case.inertia)
    body.position = case.centre
    body.velocity = case.centre_velocity
    body.angle = -case.phi0
    body.angular_velocity = -case.phi_dot0
    axis = 0, case.offset
    circle = pymunk.Circle(body, case.radius, axis)
    ground.friction = circle.friction = math.sqrt(case.friction)  # it takes the product
    space.add(ground, body, circle)

    def read() -> State:
        u_dot, _ = body.velocity_at_local_point(axis)
        return State(-body.angle, body.local_to_world(axis).x, -body.angular_velocity, u_dot)

    return sampled(case, timestep, repeated(lambda: space.step(timestep)), read)


if __name__ == "__main__":
    answer("Pymunk", SETTINGS, roll, ("pymunk",))
