# /// script
# requires-python = ">=3.11"
# dependencies = ["drake==1.51.1", "numpy==2.4.6"]
# ///
"""A can in Drake: a cylinder or a sphere on a half-space."""

import logging

import numpy as np
from common import Case, Motion, Setting, State, about_y, answer, sampled
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddContactMaterial,
    AddRigidHydroelasticProperties,
    Cylinder,
    HalfSpace,
    ProximityProperties,
    Sphere,
)
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.math import SpatialVelocity
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction
from pydrake.multibody.tree import RotationalInertia, SpatialInertia
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig
from pydrake.systems.framework import DiagramBuilder

logging.getLogger("drake").setLevel(logging.ERROR)
STIFF = {"stiffness": 1e7, "dissipation": 1.0}
LONGEST = 0.01
"""The longest step under error control [s], a fraction of a swing."""
SETTINGS = [
    Setting("cylinder", "default"),
    Setting("sphere", "default"),
    Setting(
        "cylinder",
        "stiff contact, CENIC",
        "point_stiffness 1e7 N/m and dissipation 1 s/m; the integrator CENIC on a continuous "
        "plant, with steps of the given length",
        {**STIFF, "cenic": True},
    ),
    Setting(
        "cylinder",
        "stiff contact, CENIC, error control",
        "the same, but CENIC chooses the steps: its accuracy is 1e-7 in place of a timestep of "
        "1 ms, and falls with the square of the timestep",
        {**STIFF, "cenic": True, "error_control": True},
    ),
    Setting(
        "cylinder, hydroelastic",
        "fine mesh",
        "a compliant cylinder, whose modulus is 1e7 Pa and whose edges are at most a tenth of the "
        "radius, on a rigid plane; dissipation 10 s/m",
        {"hydroelastic": True, "dissipation": 10.0},
    ),
]


def roll(case: Case, timestep: float, setting: Setting) -> Motion:
    """Roll the can with a timestep [s]. The body's frame is on the can's axis."""
    values = setting.values
    cenic = values.get("cenic", False)
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0 if cenic else timestep)
    plant.mutable_gravity_field().set_gravity_vector([case.gravity_x, 0, case.gravity_z])
    material = ProximityProperties()
    AddContactMaterial(
        friction=CoulombFriction(case.friction, case.friction),
        point_stiffness=values.get("stiffness"),
        dissipation=values.get("dissipation"),
        properties=material,
    )
    rigid = ProximityProperties(material)
    if values.get("hydroelastic"):
        AddCompliantHydroelasticProperties(case.radius / 10, 1e7, material)
        AddRigidHydroelasticProperties(rigid)
    plant.RegisterCollisionGeometry(
        plant.world_body(), RigidTransform(), HalfSpace(), "ground", rigid
    )
    inertia = RotationalInertia(case.cross_inertia, case.inertia, case.cross_inertia)
    centre = [0, 0, -case.offset]
    masses = SpatialInertia.MakeFromCentralInertia(case.mass, centre, inertia)
    can = plant.AddRigidBody("can", masses)
    is_sphere = setting.shape == "sphere"
    shape = Sphere(case.radius) if is_sphere else Cylinder(case.radius, case.length)
    lying = RigidTransform(RotationMatrix.MakeXRotation(np.pi / 2), [0, 0, 0])
    plant.RegisterCollisionGeometry(can, lying, shape, "can", material)
    plant.Finalize()
    simulator = Simulator(builder.Build())
    if cenic:
        config = SimulatorConfig(integration_scheme="cenic", max_step_size=timestep)
        config.use_error_control = values.get("error_control", False)
        if config.use_error_control:
            config.max_step_size = LONGEST
            config.accuracy = 1e-7 * (1e3 * timestep) ** 2
        ApplySimulatorConfig(config, simulator)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    turned = RotationMatrix.MakeYRotation(case.phi0)
    plant.SetFreeBodyPose(context, can, RigidTransform(turned, [case.u0, 0, case.radius]))
    velocity = SpatialVelocity([0, case.phi_dot0, 0], [case.u_dot0, 0, 0])
    plant.SetFreeBodySpatialVelocity(context, can, velocity)
    simulator.Initialize()

    def read() -> State:
        pose = plant.EvalBodyPoseInWorld(context, can)
        velocity = plant.EvalBodySpatialVelocityInWorld(context, can)
        x, y, _ = pose.translation()
        matrix = pose.rotation().matrix()
        phi = about_y((matrix[0, 0], matrix[2, 0]))
        return State(phi, x, velocity.rotational()[1], velocity.translational()[0], y)

    def advance(steps: int) -> None:
        simulator.AdvanceTo(simulator.get_context().get_time() + steps * timestep)

    return sampled(case, timestep, advance, read)


if __name__ == "__main__":
    answer("Drake", SETTINGS, roll, ("drake",))
