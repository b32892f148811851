"""A standing can that is carried from one place to another by a gripper that holds it upright."""

from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError, warn_of_liquid
from mjbeer.model.build import build
from mjbeer.theory.standing import INDICATIVE, Standing

_MOST_STEPS = 1_000_000
"""Largest number of timesteps of a move and of what follows: a minute of computing."""
_FORCE_X = 3
"""Place of the level force in MuJoCo's force of a body on its parent: the moment comes first."""


@dataclass(frozen=True, eq=False)
class Carried:
    """What a gripper feels, and what the liquid does; arrays have the shape (steps,)."""

    time: np.ndarray
    """[s]"""
    place: np.ndarray
    """Place of the can [m]."""
    acceleration: np.ndarray
    """Acceleration of the can [m/s^2]."""
    force: np.ndarray
    """Level force of the gripper on the can [N]."""
    rise: np.ndarray
    """How high the surface rises at the wall ahead, by all modes that move, over the radius."""


def carry(
    can: Standing, distance: float = 0.4, duration: float = 1.0, after: float = 1.0, timestep: float = 5e-4
) -> Carried:
    """Return the motion of a can that is moved by a `distance` [m] in a `duration` [s], and then held for `after` [s].

    The move has the least jerk that starts and ends at rest. In the frame of the gripper the can stands still and
    gravity is tilted by the acceleration, so that the gripper is as rigid as can be.

    A `LiquidWarning` says where the surface rises by more than 0.3 radii: linear theory is no picture of it then.

    Raises:
      ParameterError: if a number is not greater than 0, the timestep is not allowed, or there are too many of them.
    """
    require.instance("can", can, Standing)
    for name, value, unit in (("distance", distance, "m"), ("duration", duration, "s"), ("after", after, "s")):
        require.positive(name, value, unit)
    if (steps := (duration + after) / require.within("timestep", timestep, *require.TIMESTEP, "s")) > _MOST_STEPS:
        raise ParameterError(f"a move has {_MOST_STEPS:g} timesteps at most, got {steps:.3g}")
    model = build(can, free=False, timestep=timestep)
    data, body = mujoco.MjData(model), model.body("can").id
    time = timestep * np.arange(round((duration + after) / timestep) + 1)
    place, acceleration = minimum_jerk(time, distance, duration)
    _, pushed = minimum_jerk(time + timestep / 2, distance, duration)  # a step has the gravity of its middle
    force, rise = np.empty_like(time), np.zeros_like(time)
    for step, now in enumerate(acceleration):
        model.opt.gravity[0] = -now
        mujoco.mj_forward(model, data)
        mujoco.mj_rnePostConstraint(model, data)
        force[step] = data.cfrc_int[body, _FORCE_X]
        rise[step] = sum(data.sensor(f"slosh{mode}_rise").data[0] for mode in range(1, can.modes + 1))
        model.opt.gravity[0] = -pushed[step]
        mujoco.mj_step(model, data)
    if (highest := float(np.abs(rise).max())) > INDICATIVE:
        warn_of_liquid(
            f"the surface rises by {highest:.2g} radii at the wall: beyond {INDICATIVE:g} linear theory is no picture "
            "of the liquid",
            stacklevel=2,
        )
    return Carried(time, place, acceleration, force, rise)


def minimum_jerk(time: np.ndarray, distance: float, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Return place [m] and acceleration [m/s^2] of a move with the least jerk, at times [s] of shape (times,)."""
    share = np.clip(time / duration, 0.0, 1.0)
    place = distance * share**3 * (10 - 15 * share + 6 * share**2)
    return place, distance / duration**2 * 60 * share * (1 - share) * (1 - 2 * share)
