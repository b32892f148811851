# /// script
# requires-python = ">=3.11"
# dependencies = ["rapier3d==0.36.1", "numpy==2.4.6"]
# ///
"""A can in Rapier: a cylinder, or a ball, on a half-space, in single precision."""

import math

import rapier3d
from common import Case, Motion, Setting, State, answer, repeated, sampled

STIFF = "contacts of 10 kHz instead of 60 Hz, and one solver iteration instead of four"
SETTINGS = [
    Setting("cylinder", "default"),
    Setting("ball", "default"),
    Setting("cylinder", "stiff contact", STIFF, {"frequency": 1e4, "iterations": 1}),
    Setting("ball", "stiff contact", STIFF, {"frequency": 1e4, "iterations": 1}),
]
DAMPING_RATIO = 10.0
"""Rapier's own for contacts."""


def roll(case: Case, timestep: float, setting: Setting) -> Motion:
    """Roll the can with a timestep [s]. A cylinder lies along its own y axis, as the can does."""
    world = rapier3d.PhysicsWorld(gravity=(case.gravity_x, 0, case.gravity_z))
    parameters = world.integration_parameters
    parameters.dt = timestep
    if setting.values:
        softness = rapier3d.SpringCoefficients(setting.values["frequency"], DAMPING_RATIO)
        parameters.static_contact_softness = softness
        parameters.num_solver_iterations = setting.values["iterations"]
    del parameters  # or the world stays borrowed
    ground = rapier3d.Collider.halfspace((0, 0, 1)).friction(case.friction).restitution(0)
    world.colliders.insert(ground.build())
    inertia = case.cross_inertia, case.inertia, case.cross_inertia
    masses = rapier3d.MassProperties((0, 0, -case.offset), case.mass, inertia)
    x, z = case.centre_velocity
    body = (
        rapier3d.RigidBody.dynamic()
        .translation((case.u0, 0, case.radius))
        .rotation((0, case.phi0, 0))
        .linvel((x, 0, z))
        .angvel((0, case.phi_dot0, 0))
        .can_sleep(False)
        .additional_mass_properties(masses)
    )
    handle = world.rigid_bodies.insert(body.build())
    if setting.shape == "ball":
        shape = rapier3d.Collider.ball(case.radius)
    else:
        shape = rapier3d.Collider.cylinder(case.length / 2, case.radius)
    shape = shape.density(0).friction(case.friction).restitution(0)
    world.colliders.insert_with_parent(shape.build(), handle, world.rigid_bodies)

    def read() -> State:
        can = world.rigid_bodies[handle]
        phi = 2 * math.atan2(can.rotation.j, can.rotation.w)
        u_dot = can.linvel.x + case.offset * math.cos(phi) * can.angvel.y  # from the centre's
        return State(phi, can.translation.x, can.angvel.y, u_dot, can.translation.y)

    return sampled(case, timestep, repeated(world.step), read)


if __name__ == "__main__":
    answer("Rapier", SETTINGS, roll, ("rapier3d",))
