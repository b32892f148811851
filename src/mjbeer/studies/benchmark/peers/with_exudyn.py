"""EXUDYN: a multibody engine with a joint that rolls without slipping (https://github.com/jgerstmayr/EXUDYN).

The can is a plane rigid body that an ObjectJointRollingDisc keeps rolling on the ground; x points down the incline, y
away from it, and gravity is tilted. A sliding load is a second body on a revolute joint; a frozen load is part of the
can.

The integrator is EXUDYN's TrapezoidalIndex2: the implicit trapezoidal rule with constraints on velocities. Its error
falls as the square of the timestep over the whole ladder, and the joint does not limit it: over 2 s a can slips by
1e-12 of its radius and does not lift at all. Three alternatives were tried. Generalized-alpha has the same error at a
spectral radius of 1, and 1 % more at its default of 0.9; modified Newton iterations take as long or longer; and with
the reference point of the load at its centre of mass instead of on the axis, errors double.
"""

from collections.abc import Generator
from contextlib import contextmanager
from typing import Any

import numpy as np

from mjbeer.exceptions import DivergenceError, ParameterError, UnsupportedError
from mjbeer.studies.benchmark.peers.peer import Integrate, Motion, Peer
from mjbeer.theory.scene import Scene

# With these tolerances of Newton's iteration, its error is 1 % of the trapezoidal rule's at the finest timestep.
# EXUDYN's defaults, 1e-8 and 1e-10, reduce the order below 0.1 ms; 1e-12 and 1e-14 need an iteration more to remove
# the 1 %.
_RELATIVE, _ABSOLUTE = 1e-10, 1e-12
_COARSEST, _RUNGS = 0.016, 10
_ROUNDING = 1e-9  # of a time, in units of the step


def _set_up(scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, knob: float) -> Integrate:
    import exudyn

    system, sensors = _model(scene, phi0, phi_dot0)
    settings = _settings(times, knob)

    def integrate() -> Motion:
        try:
            with _silence():
                system.SolveDynamic(settings)
        except exudyn.SolverError as error:
            raise DivergenceError(f"EXUDYN: {error} at {system.sys['dynamicSolver'].it.currentTime:g} s") from error
        # Columns of a sensor: time, x, y and the angle, which is positive uphill.
        can, load = (system.GetSensorStoredData(sensor) for sensor in sensors)
        return -load[:, 3], can[:, 1]

    return integrate


def _model(scene: Scene, phi0: float, phi_dot0: float) -> tuple[Any, tuple[Any, Any]]:
    """Return the assembled system, and the sensors of the can's and the load's coordinates.

    Raises:
      UnsupportedError: if the load slides in a can without mass.
    """
    import exudyn
    from exudyn.itemInterface import (
        LoadMassProportional,
        MarkerBodyMass,
        MarkerBodyRigid,
        NodeRigidBody2D,
        ObjectGround,
        ObjectJointRevolute2D,
        ObjectJointRollingDisc,
        ObjectRigidBody2D,
        SensorNode,
    )

    can, load = scene.can, scene.load
    if scene.dissipates:
        raise UnsupportedError("the EXUDYN model of a can has neither damping nor drag; leave them out")
    if scene.attachment == "sliding" and can.mass == 0:
        raise UnsupportedError(
            "EXUDYN moves bodies with mass only: a massless can with a sliding load is none; give the can a mass"
        )
    system = exudyn.SystemContainer().AddSystem()
    u0, u_dot0 = scene.start(phi0, phi_dot0)
    radius, slope, normal = can.radius, np.sin(scene.incline), np.cos(scene.incline)

    def body(angle: float, rate: float, mass: float, inertia: float, offset: float) -> tuple[Any, Any]:
        """Add a body with its centre of mass `offset` below the axis; return its marker on the axis, and its sensor."""
        node = system.AddNode(
            NodeRigidBody2D(
                referenceCoordinates=[0, radius, 0],
                initialCoordinates=[u0, 0, -angle],
                initialVelocities=[u_dot0, 0, -rate],
            )
        )
        number = system.AddObject(
            ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=inertia, centerOfMass=[0, -offset])
        )
        system.AddLoad(
            LoadMassProportional(
                markerNumber=system.AddMarker(MarkerBodyMass(bodyNumber=number)),
                loadVector=[scene.gravity * slope, -scene.gravity * normal, 0],
            )
        )
        coordinates = exudyn.OutputVariableType.Coordinates
        sensor = SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=coordinates)
        return system.AddMarker(MarkerBodyRigid(bodyNumber=number)), system.AddSensor(sensor)

    axial = load.axis_inertia
    if scene.attachment == "frozen":
        rolling, sensor = body(phi0, phi_dot0, scene.mass, can.inertia + axial, scene.centre_of_mass)
        sensors = sensor, sensor
    else:
        rolling, first = body(u0 / radius, u_dot0 / radius, can.mass, can.inertia, 0.0)
        hanging, second = body(phi0, phi_dot0, load.mass, axial, load.offset)
        system.AddObject(ObjectJointRevolute2D(markerNumbers=[rolling, hanging]))
        sensors = first, second
    ground = system.AddMarker(MarkerBodyRigid(bodyNumber=system.AddObject(ObjectGround())))
    system.AddObject(
        ObjectJointRollingDisc(
            markerNumbers=[ground, rolling],
            constrainedAxes=[0, 1, 1],  # a plane body cannot move sideways anyway
            discRadius=radius,
            discAxis=[0, 0, 1],
            planeNormal=[0, 1, 0],
        )
    )
    system.Assemble()
    return system, sensors


def _settings(times: np.ndarray, timestep: float) -> Any:
    """Return settings of the solver with which it stores a sample at each of the times [s].

    Raises:
      ParameterError: unless the times are evenly spaced, by a whole number of timesteps.
    """
    import exudyn

    samples = len(times) - 1
    spacing = float(times[-1]) / samples
    steps = round(spacing / timestep)
    even = np.abs(times - spacing * np.arange(samples + 1)).max() <= _ROUNDING * timestep
    if not even or abs(spacing / timestep - steps) > _ROUNDING * steps:
        raise ParameterError(
            f"EXUDYN stores samples of fixed steps: times must be a whole number of timesteps apart; they are about "
            f"{spacing:g} s apart, and the timestep is {timestep:g} s"
        )
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = spacing
    integration = settings.timeIntegration
    integration.solverType = exudyn.DynamicSolverType.TrapezoidalIndex2
    integration.endTime = float(times[-1])
    integration.numberOfSteps = steps * samples
    integration.adaptiveStep = False
    integration.newton.useModifiedNewton = False
    integration.newton.relativeTolerance = _RELATIVE
    integration.newton.absoluteTolerance = _ABSOLUTE
    return settings


@contextmanager
def _silence() -> Generator[None]:
    """Keep EXUDYN from printing failures to the terminal: they are raised as exceptions."""
    from exudyn import config

    before, config.printToConsole = config.printToConsole, False
    try:
        yield
    finally:
        config.printToConsole = before


PEER = Peer(
    name="EXUDYN",
    knob="timestep",
    unit="s",
    knobs=tuple(_COARSEST / 2**rung for rung in range(_RUNGS)),
    set_up=_set_up,
)
