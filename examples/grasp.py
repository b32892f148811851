"""Grasp a can with beer between two fingers, lift it, carry it, and ask how high the beer rises.

python examples/grasp.py
"""

from typing import NamedTuple

import mujoco
import numpy as np

import mjbeer

CAN = mjbeer.standing("beer")
TIMESTEP = 1e-3  # [s]
GRIP = 8.0  # force of each finger [N]; the can with its beer weighs 2.1 N
FRICTION = [0.8, 0.004, 1e-4]  # of rubber on metal; the second resists a twist in the fingers [m]
TIP = 0.012  # radius of a fingertip, which is round [m]
OPEN = 0.03  # way of a finger from its start to the wall [m]
CLOSED = 0.5  # time at which the fingers have closed [s]
LIFT = 0.15  # how high the can is lifted [m]
LIFTED = 1.3  # time at which it is there [s]
CARRY = 0.30  # how far it is carried then [m]
CARRIED = 2.8  # time at which it is there [s]
END = 4.0  # [s]
STEEL = [0.32, 0.36, 0.42, 1]


class Grasp(NamedTuple):
    """What happens in the fingers; arrays have shape (steps,)."""

    time: np.ndarray
    """[s]."""
    slip: np.ndarray
    """How far the can is in the hand from where it was when the fingers had closed [m]."""
    tilt: np.ndarray
    """Angle between the can's axis and the vertical [rad]."""
    used: np.ndarray
    """Share of the fingers' friction that holds the can: it slips at 1."""
    rise: np.ndarray
    """How high the beer rises at the wall, in radii."""
    places: np.ndarray
    """Where the can's bottom is [m], shape (steps, 3)."""


def world() -> mujoco.MjModel:
    """Return a table with a can, and a hand of two fingers on a crane of two slides."""
    spec = mujoco.MjSpec()
    spec.option.timestep = TIMESTEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.impratio = 1000  # hard friction: with 10 the can creeps down by 1 mm/s
    spec.worldbody.add_light(pos=[CARRY / 2, -0.1, 1.5], dir=[0, 0.07, -1])
    spec.worldbody.add_geom(
        name="table",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[0.28, 0.12, 0.01],
        pos=[CARRY / 2, 0, -0.01],
        rgba=[0.84, 0.71, 0.54, 1],
    )
    crane = spec.worldbody.add_body(name="crane", pos=[0, 0, CAN.can.length / 2])
    hand = crane.add_body(name="hand")
    draw_bar(hand, [0, 0, 0.1], [0.01, 0.09, 0.006])
    for body, name, axis in ((crane, "along", [1, 0, 0]), (hand, "up", [0, 0, 1])):
        body.mass = 1.0
        body.inertia = [1e-3, 1e-3, 1e-3]
        body.explicitinertial = True
        body.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis, damping=200)
        motor = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.set_to_position(kp=2e4)
    for side, name in ((-1, "right"), (1, "left")):
        start = side * (CAN.can.radius + TIP + OPEN)
        finger = hand.add_body(name=name, pos=[0, start, 0])
        finger.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, -side, 0], damping=5)
        finger.add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[TIP, 0, 0],
            mass=0.05,
            condim=4,  # friction against a twist: with 3, the can swings between two points
            friction=FRICTION,
            rgba=STEEL,
        )
        draw_bar(finger, [0, 0, 0.047], [0.008, 0.004, 0.047])
        motor = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.set_to_motor()
    mjbeer.attach(spec, CAN, friction=FRICTION)
    return spec.compile()


def draw_bar(body: mujoco.MjsBody, place: list[float], half_size: list[float]) -> None:
    """Add a bar that touches nothing to a body."""
    bar = body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, pos=place, size=half_size, rgba=STEEL)
    bar.contype = 0
    bar.conaffinity = 0
    bar.mass = 0.0


def smooth(time: float, begin: float, end: float) -> float:
    """Return the share of a move with the least jerk, which is at rest before and after."""
    share = min(max((time - begin) / (end - begin), 0.0), 1.0)
    return share**3 * (10 - 15 * share + 6 * share**2)


def control(data: mujoco.MjData) -> None:
    """Tell the motors what to do now."""
    data.actuator("along").ctrl = CARRY * smooth(data.time, LIFTED, CARRIED)
    data.actuator("up").ctrl = LIFT * smooth(data.time, CLOSED, LIFTED)
    for finger in ("right", "left"):
        data.actuator(finger).ctrl = GRIP * smooth(data.time, 0.0, CLOSED)


def friction_used(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Return the largest share of its friction cone that a contact of a finger needs."""
    most = 0.0
    force = np.zeros(6)
    can = model.geom("can-can").id
    table = model.geom("table").id
    for index, contact in enumerate(data.contact):
        if can in contact.geom and table not in contact.geom:
            mujoco.mj_contactForce(model, data, index, force)
            sideways = np.linalg.norm(force[[1, 2, 3]] / contact.friction[[0, 1, 2]])
            most = max(most, sideways / max(force[0], 1e-9))
    return most


def grasp() -> Grasp:
    """Return what happens while the can is grasped, lifted and carried."""
    model = world()
    data = mujoco.MjData(model)
    rows = []
    places = []
    in_hand = []
    while data.time < END:
        control(data)
        mujoco.mj_step(model, data)
        rise = mjbeer.wall_rise(model, data)
        mujoco.mj_forward(model, data)  # after a step, places and forces are those before it
        can = data.body("can-can")
        tilt = np.arccos(min(can.xmat[8], 1.0))
        rows.append([data.time, tilt, friction_used(model, data), rise])
        places.append(can.xpos.copy())
        in_hand.append(can.xpos - data.body("hand").xpos)
    time, tilt, used, rise = np.transpose(rows)
    closed = np.searchsorted(time, CLOSED)
    slip = np.linalg.norm(np.array(in_hand) - in_hand[closed], axis=1)
    return Grasp(time, slip, tilt, used, rise, np.array(places))


if __name__ == "__main__":
    run = grasp()
    held = run.time > CLOSED
    ringing = run.rise[run.time > CARRIED + 0.1].max()
    x, _, z = run.places[-1]
    print(f"the can was carried {x:.4f} m and hangs {z:.4f} m above the table")
    print(f"it moved by at most {1e3 * run.slip[held].max():.3f} mm in the fingers,")
    print(f"tilted by at most {np.degrees(run.tilt[held].max()):.3f} degrees,")
    print(f"and needed at most {run.used[held].max():.3f} of the friction there is")
    print(f"the beer rose by at most {run.rise.max():.4f} R, and by {ringing:.4f} R after the stop")
