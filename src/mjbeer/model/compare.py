"""Compares the accelerations of a model with those of theory, and its joints and constraints."""

import copy
import math
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer.model.joints import joint_addresses, rolling_coordinates, to_coordinates, to_states
from mjbeer.model.mujoco_library import quiet
from mjbeer.model.setting import Rolling, Setting
from mjbeer.theory.equations import Coordinates, accelerations
from mjbeer.theory.scene import Scene

_ALLOWED = 1e-13
"""Largest difference of phi_ddot from theory that a model may have, divided by `_rounding`. In
random scenes of all sizes, at 448 starts and in 408 runs, rounding was 5e-15 of it at most."""


def model_fault(
    model: mujoco.MjModel, scene: Scene, setting: Setting, motion: Coordinates | None = None
) -> str | None:
    """Return how a model differs from its scene, None if it does not.

    The model must have the scene's joints, no constraint but that of rolling, and theory's
    accelerations. They are compared in the states of a `motion`, or, if it is None, in a few states
    of `_probes`. All states are taken as ones of rolling without slipping.
    """
    joints = tuple(joint_addresses(model))
    expected_joints = _joints(scene, setting.rolling)
    if joints != expected_joints:
        return f"gives the joints {', '.join(joints)}, not {', '.join(expected_joints)}"
    probes = _probes(scene) if motion is None else _rolling_states(scene, motion)
    equations = _evaluate(model, setting.rolling, probes)
    if equations.constraint_fault is not None:
        return equations.constraint_fault
    found = _phi_ddot(model, scene, equations)
    _, expected = accelerations(scene, probes.phi, probes.phi_dot, probes.u_dot)
    size = np.abs(expected).max() + _typical_rate(scene) ** 2
    difference = np.abs(found - expected)
    if not np.all(difference <= _ALLOWED * _rounding(scene, setting.rolling, probes, size)):
        by = f"{difference.max():.3g} rad/s^2 (of {size:.3g})"
        return f"gives phi an acceleration that differs from theory by up to {by}"
    if equations.warned:
        return "makes MuJoCo warn of a state of rolling"
    return None


def _joints(scene: Scene, rolling: Rolling) -> tuple[str, ...]:
    """Return the joints that the model of a scene has, in this order."""
    sliding = scene.attachment == "sliding"
    if rolling == "reduced":
        return ("slide", "phi") if sliding else ("phi",)
    joints = ["slide"]
    if rolling == "contact":
        joints.append("lift")
    joints.append("roll")
    if sliding:
        joints.append("swing")
    return tuple(joints)


def _typical_rate(scene: Scene) -> float:
    """Return the rate at which a can of this size swings [rad/s]."""
    return math.sqrt(max(scene.gravity, 1.0) / scene.can.radius)


def _probes(scene: Scene) -> Coordinates:
    """Return a few states of rolling, no two of which are mirror images or a quarter turn apart."""
    phi = np.array([-2.6, -0.7, 0.3, 1.1, 2.2])
    phi_dot = _typical_rate(scene) * np.array([2.0, -1.0, 0.5, 3.0, -2.0])
    roll = phi[::-1]
    roll_dot = phi_dot[::-1]
    if scene.attachment == "frozen":
        roll = phi
        roll_dot = phi_dot
    radius = scene.can.radius
    return rolling_coordinates(radius, radius * roll, radius * roll_dot, phi, phi_dot)


def _rolling_states(scene: Scene, motion: Coordinates) -> Coordinates:
    """Return the states of a motion as ones of rolling without slipping."""
    radius = scene.can.radius
    u = motion.u
    u_dot = motion.u_dot
    if scene.attachment == "frozen":
        u = radius * motion.phi
        u_dot = radius * motion.phi_dot
    return rolling_coordinates(radius, u, u_dot, motion.phi, motion.phi_dot)


class _Equations(NamedTuple):
    """The equations of motion of a model, inertias x accelerations = torques, at some states."""

    inertias: np.ndarray
    """Mass matrices, shape (states, nv, nv)."""
    torques: np.ndarray
    """Forces of joints without those of constraints, shape (states, nv)."""
    warned: bool
    """Whether MuJoCo warned of a state."""
    constraint_fault: str | None
    """Which constraint acts besides that of rolling, at the first state where one does."""


def _evaluate(model: mujoco.MjModel, rolling: Rolling, probes: Coordinates) -> _Equations:
    """Return a model's equations of motion at states of rolling."""
    model = copy.copy(model)
    # The accelerations of "discrete" are means over a step.
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    data = mujoco.MjData(model)
    states = to_states(model, probes)
    inertias = np.empty((len(states), model.nv, model.nv))
    torques = np.empty((len(states), model.nv))
    constraint_fault = None
    with quiet():
        for state, inertia, torque in zip(states, inertias, torques, strict=True):
            data.qpos[:] = state[: model.nq]
            data.qvel[:] = state[model.nq :]
            mujoco.mj_forward(model, data)
            if constraint_fault is None:
                constraint_fault = _constraint_fault(model, data, rolling)
            mujoco.mj_fullM(model, data, inertia)
            torque[:] = data.qfrc_smooth
    warned = bool(np.any(data.warning.number))
    return _Equations(inertias, torques, warned, constraint_fault)


def _constraint_fault(model: mujoco.MjModel, data: mujoco.MjData, rolling: Rolling) -> str | None:
    """Return which constraint is active besides that of rolling, None if there is none."""
    others = data.nf + data.nl
    expected_equalities = int(rolling == "equality")
    if data.ne != expected_equalities or (data.ncon > 0) != (rolling == "contact") or others > 0:
        return f"gives {data.nefc} rows of constraints, not only those of rolling"
    if rolling == "contact":
        pair = model.pair("rolling")
        rolling_geoms = {int(pair.geom1[0]), int(pair.geom2[0])}
        if not rolling_geoms.issuperset(data.contact.geom.ravel().tolist()):
            return "lets geoms touch other than the can and the incline"
    return None


def _phi_ddot(model: mujoco.MjModel, scene: Scene, equations: _Equations) -> np.ndarray:
    """Return phi_ddot [rad/s^2] of a can that rolls without any slip, shape (states,).

    MuJoCo's own accelerations are those of a constraint that may be soft. Here the equations of all
    joints are projected on the motions of rolling.
    """
    radius = scene.can.radius
    # A sliding load has two motions of rolling: the can alone turns, or the load alone. With a
    # frozen load both turn together. The rates of the joints in these motions are `rates`.
    if scene.attachment == "sliding":
        can_rate = np.array([1.0, 0.0])
        load_rate = np.array([0.0, 1.0])
    else:
        can_rate = load_rate = np.ones(1)
    origin = 0 * can_rate
    motions = rolling_coordinates(radius, origin, radius * can_rate, origin, load_rate)
    rates = to_states(model, motions)[:, model.nq :]
    inertias = rates @ equations.inertias @ rates.T
    torques = equations.torques @ rates.T
    accelerations_of_joints = np.linalg.solve(inertias, torques[..., None])[..., 0] @ rates
    return _phi_rate(model, scene, accelerations_of_joints)


def _phi_rate(model: mujoco.MjModel, scene: Scene, joint_rates: np.ndarray) -> np.ndarray:
    """Return the rate of phi that follows from the rates of all joints, shape (states,).

    phi is a sum of angles of joints. So phi_ddot follows from the joints' accelerations just as
    phi_dot does from their velocities. `to_coordinates` knows that sum, but takes whole states:
    here it gets made-up ones, with these rates at position 0 and time 0.
    """
    count = len(joint_rates)
    made_up_states = np.concatenate([np.zeros((count, model.nq)), joint_rates], axis=1)
    return to_coordinates(model, scene, made_up_states, np.zeros(count)).phi_dot


def _rounding(scene: Scene, rolling: Rolling, probes: Coordinates, size: float) -> np.ndarray:
    """Return the terms that are rounded in MuJoCo's phi_ddot [rad/s^2], added up, shape (states,).

    The rounding of phi_ddot is in proportion to this sum. `size` is the size of phi_ddot itself.
    """
    inertia = scene.oscillator.inertia(probes.phi)
    # MuJoCo computes torques from places in the world. More of their digits are lost, the farther
    # the can is from the origin, and the larger m a^2 is beside the inertia that they turn.
    far = 1 + np.abs(probes.roll)
    heavy = 1 + scene.mass * scene.can.radius**2 / inertia
    rounding = size * far * heavy
    if scene.oscillator.chord > 0 and rolling == "reduced":
        # The direction of the chord tendon, which has no length at phi = pi.
        rounding /= np.abs(np.cos(probes.phi / 2))
    # Damping takes the difference of two rates.
    rates = np.abs(probes.roll_dot) + np.abs(probes.phi_dot)
    slope = scene.damping_law.derivative(probes.roll_dot - probes.phi_dot)
    return rounding + slope * rates / inertia
