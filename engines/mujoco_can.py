# /// script
# requires-python = ">=3.11"
# dependencies = ["mujoco==4.0.0"]
# ///
"""A can in MuJoCo: a cylinder or a sphere on a plane."""

import math

import mujoco
from common import Case, Motion, Setting, State, answer, sampled

HARDEST = 0.9999
"""The largest impedance that MuJoCo allows."""
TIMECONST = 2.0
"""The least time constant of a contact in timesteps, unless the flag refsafe is off."""
CONTACT = (
    "solref of two timesteps, the least that the flag refsafe allows, which is on by default; "
    "solimp of 0.9999, the largest impedance; an elliptic cone; and impratio 100"
)
DEPTH = 1e-9
"""How deep the can starts, in radii: by rounding, one end does not touch at a depth of zero."""
STIFF = {"stiff": True, "cone": "elliptic", "impratio": 100}
SETTINGS = [
    Setting("cylinder", "default"),
    Setting("sphere", "default"),
    Setting("cylinder", "RK4", "the integrator RK4", {"integrator": "RK4"}),
    Setting("cylinder", "stiff contact", CONTACT, STIFF),
    Setting(
        "cylinder",
        "stiff contact, RK4",
        f"{CONTACT}; the integrator RK4",
        {**STIFF, "integrator": "RK4"},
    ),
]
XML = """
<mujoco>
  <option timestep="{timestep}" gravity="{case.gravity_x} 0 {case.gravity_z}"
    integrator="{integrator}" cone="{cone}" impratio="{impratio}"/>
  <default>
    <geom friction="{case.friction} 0.005 0.0001" {softness}/>
  </default>
  <worldbody>
    <geom type="plane" size="200 20 1"/>
    <body pos="0 0 {case.radius}">
      <freejoint/>
      <inertial pos="0 0 {centre}" mass="{case.mass}"
        diaginertia="{case.cross_inertia} {case.inertia} {case.cross_inertia}"/>
      <geom type="{shape}" size="{size}" euler="90 0 0"/>
    </body>
  </worldbody>
</mujoco>
"""


def roll(case: Case, timestep: float, setting: Setting) -> Motion:
    """Roll the can with a timestep [s]."""
    values = setting.values
    softness = ""
    if values.get("stiff"):
        softness = f'solref="{TIMECONST * timestep} 1" solimp="{HARDEST} {HARDEST} 0.001"'
    text = XML.format(
        case=case,
        timestep=timestep,
        integrator=values.get("integrator", "Euler"),
        cone=values.get("cone", "pyramidal"),
        impratio=values.get("impratio", 1),
        softness=softness,
        centre=-case.offset,
        shape=setting.shape,
        size=f"{case.radius}" if setting.shape == "sphere" else f"{case.radius} {case.length / 2}",
    )
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    half = case.phi0 / 2
    height = case.radius * (1 - DEPTH)
    data.qpos[:] = [case.u0, 0, height, math.cos(half), 0, math.sin(half), 0]
    data.qvel[:] = [case.u_dot0, 0, 0, 0, case.phi_dot0, 0]

    def read() -> State:
        x, y, _, cosine, _, sine, _ = data.qpos
        return State(2 * math.atan2(sine, cosine), x, data.qvel[4], data.qvel[0], y)

    def advance(steps: int) -> None:
        mujoco.mj_step(model, data, steps)

    return sampled(case, timestep, advance, read)


if __name__ == "__main__":
    answer("MuJoCo", SETTINGS, roll, ("mujoco",))
