"""Move two cans 0.4 m in a second with the same gripper: one with beer that sloshes, one as rigid as most models.

python examples/carry.py
"""

import mujoco
import numpy as np

import mjbeer

CANS = {"beer": mjbeer.standing("beer"), "rigid": mjbeer.standing("beer", modes=0)}
APART, HEIGHT = 0.2, 0.3  # of the cans, and of the grippers above the table [m]
DISTANCE, MOVE, AFTER = 0.4, 1.0, 1.5  # [m], [s], [s]
TIMESTEP = 1e-3  # [s]


def world() -> mujoco.MjModel:
    """Return two mocap grippers above a table, each welded to a can."""
    spec = mujoco.MjSpec()
    spec.option.timestep = TIMESTEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.worldbody.add_light(pos=[0, -1, 2], dir=[0, 0.5, -1])
    spec.worldbody.add_geom(name="table", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[1, 1, 0.1])
    for lane, (name, can) in enumerate(CANS.items()):
        place = [0, APART * lane, HEIGHT]
        hand = spec.worldbody.add_body(name=f"{name}-hand", pos=place, mocap=True)
        top = [0, 0, can.can.length]
        hand.add_geom(
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[0.04, 0.04, 0.005],
            pos=top,
            contype=0,
            conaffinity=0,
        )
        held = mjbeer.attach(spec, can, pos=place, prefix=f"{name}-")
        weld = spec.add_equality(
            name=f"{name}-grip", type=mujoco.mjtEq.mjEQ_WELD, name1=hand.name, name2=held.name
        )
        weld.objtype, weld.solref = mujoco.mjtObj.mjOBJ_BODY, [2 * TIMESTEP, 1]
        weld.data[:11] = [0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1]  # the two origins are at the same place
    return spec.compile()


def place(time: float) -> float:
    """Return the way of the grippers [m]: the move with the least jerk."""
    share = min(time / MOVE, 1.0)
    return DISTANCE * share**3 * (10 - 15 * share + 6 * share**2)


def forces() -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return the times [s], and the level force of each gripper on its can [N]."""
    model = world()
    data = mujoco.MjData(model)
    times, found = [], {name: [] for name in CANS}
    while data.time < MOVE + AFTER:
        for name in CANS:
            data.mocap_pos[model.body(f"{name}-hand").mocapid[0], 0] = place(data.time)
        mujoco.mj_step(model, data)
        times.append(data.time)
        for name, force in found.items():
            first = model.joint(f"{name}-free").dofadr[0]
            force.append(data.qfrc_constraint[first])
    return np.array(times), {name: np.array(force) for name, force in found.items()}


if __name__ == "__main__":
    times, felt = forces()
    for name, force in felt.items():
        ringing = np.abs(force[times > MOVE + 0.1]).max()
        print(
            f"{name}: at most {np.abs(force).max():.3f} N during the move, {ringing:.3f} N after the stop"
        )
