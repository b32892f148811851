# /// script
# requires-python = ">=3.11"
# dependencies = [
#   "newton==1.8.0", "warp-lang==1.19.0", "mujoco==3.17.0", "mujoco-warp==3.17.0", "numpy==2.4.6",
# ]
# ///
"""A can in Newton on the CPU: a cylinder or a sphere on a plane, in single precision.

Its kernels compile when they are first used, for half a minute, and are kept.
"""

import math
import warnings

import newton
import numpy as np
import warp
from common import Case, Motion, Setting, State, answer, repeated, sampled

MUJOCO = {"use_mujoco_cpu": True}
"""MuJoCo's own library: the same in Warp takes several times as long on a CPU."""
RAW = 1
"""Solref is MuJoCo's, and not made from ke and kd: Newton's SOLREF_MODE_RAW."""
HARDEST = 0.9999
"""The largest impedance that MuJoCo allows."""
DEPTH = 1e-6
"""How deep the can starts on MuJoCo's contact, in radii: by rounding it would not touch yet at a
depth of zero. Single precision resolves 1e-7. XPBD is as far off without it."""
SETTINGS = [
    Setting("cylinder, XPBD", "default"),
    Setting("sphere, XPBD", "default"),
    Setting("cylinder, MuJoCo", "default", values={"options": MUJOCO, "depth": DEPTH}),
    Setting(
        "cylinder, MuJoCo",
        "stiff contact, RK4",
        "what MuJoCo's own row has: the integrator RK4; solref of two timesteps, solimp of 0.9999, "
        "an elliptic cone, and impratio 100",
        {
            "options": {**MUJOCO, "integrator": "rk4", "cone": "elliptic", "impratio": 100.0},
            "depth": DEPTH,
            "stiff": True,
        },
    ),
]


def roll(case: Case, timestep: float, setting: Setting) -> Motion:
    """Roll the can with a timestep [s]. A cylinder lies along its own z axis, and is turned."""
    values = setting.values
    warp.config.quiet = True
    warp.set_device("cpu")
    builder = newton.ModelBuilder()
    surface = builder.default_shape_cfg
    surface.mu = case.friction
    surface.mu_rolling = 0.0
    surface.mu_torsional = 0.0
    attributes = {}
    if values.get("stiff"):
        newton.solvers.SolverMuJoCo.register_custom_attributes(builder)
        attributes = {
            "mujoco:solref_mode": RAW,
            "mujoco:solref": [2 * timestep, 1.0],
            "mujoco:geom_solimp": [HARDEST, HARDEST, 0.001, 0.5, 2.0],
        }
    turned = warp.quat_from_axis_angle(warp.vec3(0, 1, 0), case.phi0)
    cross = case.cross_inertia
    can = builder.add_body(
        xform=warp.transform(
            warp.vec3(case.u0, 0, case.radius * (1 - values.get("depth", 0.0))), turned
        ),
        mass=case.mass,
        inertia=warp.mat33(cross, 0, 0, 0, case.inertia, 0, 0, 0, cross),
        com=warp.vec3(0, 0, -case.offset),
        lock_inertia=True,
    )
    weightless = surface.copy()
    weightless.density = 0.0
    if setting.shape.startswith("sphere"):
        builder.add_shape_sphere(can, radius=case.radius, cfg=weightless)
    else:
        lying = warp.quat_from_axis_angle(warp.vec3(1, 0, 0), math.pi / 2)
        pose = warp.transform(warp.vec3(0, 0, 0), lying)
        size = {"radius": case.radius, "half_height": case.length / 2}
        builder.add_shape_cylinder(
            can, xform=pose, cfg=weightless, custom_attributes=attributes, **size
        )
    builder.add_shape_plane(
        plane=(0.0, 0.0, 1.0, 0.0), width=0.0, length=0.0, custom_attributes=attributes
    )
    model = builder.finalize(device="cpu")
    model.set_gravity((case.gravity_x, 0.0, case.gravity_z))
    if setting.shape.endswith("XPBD"):
        solver = newton.solvers.SolverXPBD(model)
    else:
        solver = newton.solvers.SolverMuJoCo(model, **values["options"])
    now = model.state()
    after = model.state()
    control = model.control()
    contacts = model.contacts()
    x, z = case.centre_velocity
    now.body_qd.assign(np.array([[x, 0, z, 0, case.phi_dot0, 0]], dtype=np.float32))
    newton.eval_ik(model, now, now.joint_q, now.joint_qd)

    def step() -> None:
        nonlocal now, after
        now.clear_forces()
        model.collide(now, contacts)
        solver.step(now, after, control, contacts, timestep)
        now, after = after, now

    def read() -> State:
        x, y, _, _, sine, _, cosine = now.body_q.numpy()[0]
        along, _, _, _, phi_dot, _ = now.body_qd.numpy()[0]
        phi = 2 * math.atan2(sine, cosine)
        u_dot = along + case.offset * math.cos(phi) * phi_dot  # from that of the centre of mass
        return State(phi, x, phi_dot, u_dot, y)

    return sampled(case, timestep, repeated(step), read)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    answer("Newton", SETTINGS, roll, ("newton", "warp-lang", "mujoco"))
