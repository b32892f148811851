# /// script
# requires-python = "==3.11.*"
# dependencies = ["pybullet==3.2.7", "numpy==2.4.6"]
# ///
"""A can in PyBullet: a cylinder or a sphere on a plane. Its wheels end with Python 3.11."""

import math

import pybullet
from common import Case, Motion, Setting, State, answer, repeated, sampled

WHOLE = {"erp": 1, "contactERP": 1, "frictionERP": 1}
SETTINGS = [
    Setting("cylinder", "default"),
    Setting("sphere", "default"),
    Setting("cylinder", "errors reduced at once", "erp, contactERP and frictionERP of 1", WHOLE),
    Setting("sphere", "long", "lengths times 30", {"scale": 30}),
]


def roll(case: Case, timestep: float, setting: Setting) -> Motion:
    """Roll the can with a timestep [s].

    A cylinder lies along its own z axis, so the body's z axis lies along the can, and its y axis
    points upwards at phi = 0. A body's frame is at its centre of mass.
    """
    if not pybullet.isConnected():
        pybullet.connect(pybullet.DIRECT)
    pybullet.resetSimulation()
    values = dict(setting.values)
    case = case.scaled(values.pop("scale", 1.0))
    pybullet.setGravity(case.gravity_x, 0, case.gravity_z)
    pybullet.setPhysicsEngineParameter(fixedTimeStep=timestep, **values)
    ground = pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    if setting.shape == "sphere":
        shape = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=case.radius)
    else:
        size = {"radius": case.radius, "height": case.length}
        shape = pybullet.createCollisionShape(pybullet.GEOM_CYLINDER, **size)
    can = pybullet.createMultiBody(
        baseMass=case.mass,
        baseCollisionShapeIndex=shape,
        baseInertialFramePosition=[0, -case.offset, 0],
    )
    pybullet.changeDynamics(
        can,
        -1,
        localInertiaDiagonal=[case.cross_inertia, case.cross_inertia, case.inertia],
        linearDamping=0,
        angularDamping=0,
        activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
        maxJointVelocity=1e6,
    )
    for body in (ground, can):
        pybullet.changeDynamics(
            body, -1, lateralFriction=math.sqrt(case.friction), restitution=0
        )  # it takes the product
    turned = pybullet.getQuaternionFromEuler([0, case.phi0, 0])
    lying = pybullet.getQuaternionFromEuler([math.pi / 2, 0, 0])
    nowhere = [0, 0, 0]
    _, orientation = pybullet.multiplyTransforms(nowhere, turned, nowhere, lying)
    x, z = case.centre
    along, away = case.centre_velocity
    pybullet.resetBasePositionAndOrientation(can, [x, 0, z], orientation)
    pybullet.resetBaseVelocity(can, [along, 0, away], [0, case.phi_dot0, 0])

    def read() -> State:
        (x, y, _), orientation = pybullet.getBasePositionAndOrientation(can)
        (along, _, _), (_, phi_dot, _) = pybullet.getBaseVelocity(can)
        matrix = pybullet.getMatrixFromQuaternion(orientation)
        sine, cosine = matrix[1], matrix[7]  # its y axis in the world
        u = x + case.offset * sine
        u_dot = along + case.offset * cosine * phi_dot
        return State(math.atan2(sine, cosine), u, phi_dot, u_dot, y)

    return sampled(case, timestep, repeated(pybullet.stepSimulation), read)


if __name__ == "__main__":
    answer("PyBullet", SETTINGS, roll, ("pybullet",))
