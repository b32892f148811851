# /// script
# requires-python = ">=3.11"
# dependencies = ["dartpy==6.20.0", "numpy==2.4.6"]
# ///
"""A can in DART: a cylinder or a sphere on a large box."""

import math

import numpy as np
from common import Case, Motion, Setting, State, answer, repeated, sampled
from dartpy.collision import BulletCollisionDetector, OdeCollisionDetector
from dartpy.dynamics import BoxShape, CylinderShape, FreeJoint, Inertia, Skeleton, SphereShape
from dartpy.math import Isometry3
from dartpy.simulation import World

DETECTORS = {"ODE": OdeCollisionDetector, "Bullet": BulletCollisionDetector}
SETTINGS = [
    Setting("cylinder", "default"),
    Setting("sphere", "default"),
    Setting(
        "cylinder", "ODE finds contacts", "ODE's collision detector, not FCL's", {"detector": "ODE"}
    ),
    Setting(
        "cylinder", "Bullet finds contacts", "Bullet's collision detector", {"detector": "Bullet"}
    ),
]


def roll(case: Case, timestep: float, setting: Setting) -> Motion:
    """Roll the can with a timestep [s].

    A cylinder lies along its own z axis, so the body's z axis lies along the can, and its y axis
    points upwards at phi = 0. The body's frame is on the can's axis.
    """
    world = World("incline")
    world.setTimeStep(timestep)
    world.setGravity([case.gravity_x, 0, case.gravity_z])
    if "detector" in setting.values:
        detector = DETECTORS[setting.values["detector"]]()
        world.getConstraintSolver().setCollisionDetector(detector)
    ground = Skeleton("ground")
    _, floor = ground.createWeldJointAndBodyNodePair()
    top = floor.createShapeNode(BoxShape([200, 20, 2]))
    top.setRelativeTranslation([0, 0, -1])
    can = Skeleton("can")
    joint, body = can.createFreeJointAndBodyNodePair()
    if setting.shape == "sphere":
        round_shape = SphereShape(case.radius)
    else:
        round_shape = CylinderShape(case.radius, case.length)
    for node in (top, body.createShapeNode(round_shape)):
        node.createCollisionAspect()
        node.createDynamicsAspect()
        node.getDynamicsAspect().setFrictionCoeff(case.friction)
    inertia = np.diag([case.cross_inertia, case.cross_inertia, case.inertia])
    body.setInertia(Inertia(case.mass, [0, -case.offset, 0], inertia))
    sine = math.sin(case.phi0)
    cosine = math.cos(case.phi0)
    pose = np.eye(4)
    pose[:3, :3] = [[cosine, sine, 0], [0, 0, -1], [-sine, cosine, 0]]
    pose[:3, 3] = case.u0, 0, case.radius
    joint.setPositions(FreeJoint.convertToPositions(Isometry3(pose)))
    joint.setVelocities(np.array([0, case.phi_dot0, 0, case.u_dot0, 0, 0]))
    world.addSkeleton(ground)
    world.addSkeleton(can)

    def read() -> State:
        matrix = body.getWorldTransform().matrix()
        phi = math.atan2(matrix[0, 1], matrix[2, 1])
        phi_dot = body.getAngularVelocity()[1]
        u_dot = body.getLinearVelocity()[0]
        return State(phi, matrix[0, 3], phi_dot, u_dot, matrix[1, 3])

    return sampled(case, timestep, repeated(world.step), read)


if __name__ == "__main__":
    answer("DART", SETTINGS, roll, ("dartpy",))
