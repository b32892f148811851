"""MuJoCo's own bodies that roll through the can test.

The bodies are free in space and touch the incline by a contact, as anybody would model a wheel: no
file of mjbeer's is used.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer.studies import can_test
from mjbeer.studies.can_test import DURATION, Case, Errors
from mjbeer.theory.can import LENGTH

EVERY = 1e-3
"""Time between two samples [s]."""
DEPTH = 1e-9
"""How deep a body starts in the incline, in radii: by rounding, one end of a can does not touch at
a depth of zero."""


class Positions(NamedTuple):
    """Where a body is at some times, the start included."""

    time: np.ndarray
    """[s]"""
    phi: np.ndarray
    """[rad], without jumps of whole turns."""
    u: np.ndarray
    """Position of the axis along the incline [m]."""


_MJCF = """
<mujoco>
  <option timestep="{timestep!r}" gravity="{along!r} 0 {across!r}" {option}/>
  <default><geom friction="1 0.005 0.0001"/></default>
  {asset}
  <worldbody>
    <geom type="plane" size="200 20 1" {floor}/>
    <body pos="0 0 {radius!r}">
      <freejoint/>
      <inertial pos="0 0 {below!r}" mass="{mass!r}" diaginertia="{across_axis!r} {inertia!r} {across_axis!r}"/>
      <geom {shape} {contact}/>
    </body>
  </worldbody>
</mujoco>
"""  # noqa: E501 - a line of MJCF


def free_body(
    case: Case,
    timestep: float,
    option: str = 'integrator="RK4"',
    contact: str = "",
    edges: Sequence[float] = (),
    floor: str | None = None,
) -> mujoco.MjModel:
    """Return MuJoCo's model of a case: gravity is inclined, and the incline lies level.

    `option` and `contact` are attributes, of `<option>` and of both geoms; `floor` are those of the
    incline if they differ. The body is a cylinder, or if there are `edges` a mesh: a prism with an
    edge at each of these angles from the downward direction towards +x [rad].
    """
    scene = case.scene
    can = scene.can
    load = scene.load
    shape = f'type="cylinder" size="{can.radius!r} {can.length / 2!r}" euler="90 0 0"'
    asset = ""
    if len(edges):
        corners = []
        for y in (-LENGTH / 2, LENGTH / 2):
            for angle in edges:
                x = can.radius * math.sin(angle)
                z = -can.radius * math.cos(angle)
                corners.append(f"{x:.15g} {y!r} {z:.15g}")
        asset = f'<asset><mesh name="prism" vertex="{" ".join(corners)}"/></asset>'
        shape = 'type="mesh" mesh="prism"'
    text = _MJCF.format(
        timestep=timestep,
        along=scene.gravity * math.sin(scene.incline),
        across=-scene.gravity * math.cos(scene.incline),
        option=option,
        contact=contact,
        floor=contact if floor is None else floor,
        asset=asset,
        shape=shape,
        radius=can.radius,
        below=-load.offset,
        mass=scene.mass,
        inertia=load.inertia,
        across_axis=scene.mass * (3 * can.radius**2 + can.length**2) / 12,
    )
    return mujoco.MjModel.from_xml_string(text)


def start(case: Case, model: mujoco.MjModel) -> mujoco.MjData:
    """Return the state at the start: the can touches the incline and rolls without slip."""
    radius = case.scene.can.radius
    half = case.phi0 / 2
    data = mujoco.MjData(model)
    height = radius * (1 - DEPTH)
    data.qpos[:] = [radius * case.phi0, 0, height, math.cos(half), 0, math.sin(half), 0]
    data.qvel[:] = [radius * case.phi_dot0, 0, 0, 0, case.phi_dot0, 0]
    return data


def run(case: Case, model: mujoco.MjModel, duration: float = DURATION) -> Positions:
    """Return what MuJoCo makes of a case in a `duration` [s]."""
    data = start(case, model)
    samples = round(duration / EVERY)
    steps = round(EVERY / model.opt.timestep)
    half = np.empty(samples + 1)
    u = np.empty(samples + 1)
    for sample in range(samples + 1):
        if sample:
            mujoco.mj_step(model, data, steps)
        u[sample] = data.qpos[0]
        half[sample] = math.atan2(data.qpos[5], data.qpos[3])
    time = np.arange(samples + 1) * steps * model.opt.timestep
    return Positions(time, 2 * np.unwrap(half, period=math.pi), u)


def errors(case: Case, positions: Positions) -> Errors:
    """Return the errors of positions against exact theory."""
    return can_test.errors(case.truth(positions.time), positions.phi, positions.u)
