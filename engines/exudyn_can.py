# /// script
# requires-python = ">=3.11"
# dependencies = ["exudyn==1.13.6", "numpy==2.4.6"]
# ///
"""A can in Exudyn: a disc that rolls by a constraint, or by a penalty."""

import math
import time

import exudyn
import numpy as np
from common import INTERVAL, Case, Motion, Setting, State, answer
from exudyn.utilities import (
    MarkerBodyRigid,
    NodeGenericData,
    ObjectConnectorRollingDiscPenalty,
    ObjectJointRollingDisc,
    RigidBodyInertia,
    SensorBody,
)

SETTINGS = [
    Setting("constraint", "default"),
    Setting(
        "constraint",
        "trapezoidal rule",
        "Newmark's trapezoidal rule with constraints of index 2, not the generalized alpha method",
        {"useNewmark": True, "useIndex2Constraints": True},
    ),
    Setting(
        "penalty",
        "stiff",
        "stiffness 1e6 N/m, damping 100 N s/m, and friction proportional below 1 mm/s; it has no "
        "defaults",
    ),
]


def roll(case: Case, timestep: float, setting: Setting) -> Motion:
    """Roll the can with a timestep [s]. The body's frame is on the can's axis."""
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    ground = system.CreateGround()
    about_axis = case.mass * case.offset**2
    inertia = np.diag(
        [case.cross_inertia + about_axis, case.inertia + about_axis, case.cross_inertia]
    )
    sine = math.sin(case.phi0)
    cosine = math.cos(case.phi0)
    can = system.CreateRigidBody(
        inertia=RigidBodyInertia(case.mass, inertia, com=[0, 0, -case.offset]),
        referencePosition=[case.u0, 0, case.radius],
        referenceRotationMatrix=np.array([[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]]),
        initialVelocity=[case.u_dot0, 0, 0],
        initialAngularVelocity=[0, case.phi_dot0, 0],
        gravity=[case.gravity_x, 0, case.gravity_z],
        nodeType=exudyn.NodeType.RotationEulerParameters,
    )
    options = {
        "markerNumbers": [
            system.AddMarker(MarkerBodyRigid(bodyNumber=body)) for body in (ground, can)
        ],
        "discRadius": case.radius,
        "discAxis": [0, 1, 0],
        "planeNormal": [0, 0, 1],
    }
    if setting.shape == "constraint":
        system.AddObject(ObjectJointRollingDisc(**options))
    else:
        data = NodeGenericData(initialCoordinates=[0, 0, 0], numberOfDataCoordinates=3)
        contact = ObjectConnectorRollingDiscPenalty(
            **options,
            nodeNumber=system.AddNode(data),
            contactStiffness=1e6,
            contactDamping=100,
            dryFriction=[case.friction, case.friction],
            dryFrictionProportionalZone=1e-3,
        )
        system.AddObject(contact)
    sensors = []
    for name in ("Position", "RotationMatrix", "Velocity", "AngularVelocity"):
        wanted = getattr(exudyn.OutputVariableType, name)
        sensor = SensorBody(bodyNumber=can, storeInternal=True, outputVariableType=wanted)
        sensors.append(system.AddSensor(sensor))
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(case.duration / timestep)
    settings.timeIntegration.endTime = case.duration
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = INTERVAL
    for name, value in setting.values.items():
        setattr(settings.timeIntegration.generalizedAlpha, name, value)
    motion = Motion()
    begin = time.process_time()
    system.SolveDynamic(settings)
    motion.seconds = time.process_time() - begin
    columns = [system.GetSensorStoredData(sensor)[:, 1:] for sensor in sensors]
    for place, matrix, velocity, rate in zip(*columns, strict=True):
        phi = math.atan2(matrix[2], matrix[0])
        motion.add(State(phi, place[0], rate[1], velocity[0], place[1]))
    return motion


if __name__ == "__main__":
    answer("Exudyn", SETTINGS, roll, ("exudyn",))
