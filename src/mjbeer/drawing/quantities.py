"""Quantities of a motion that a film shows: as charts over time, as arrows, and in its notes."""

import dataclasses
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from mjbeer.theory.scene import GRAVITY
from mjbeer.theory.trajectory import Trajectory

INTERVALS = 50
"""A force is a mean over the duration of the motion, divided by this number."""


class Quantity(NamedTuple):
    """A quantity of a motion that a chart can show."""

    title: str
    """What it is, with its letter and unit."""
    values: Callable[[Trajectory], np.ndarray]
    """Returns its values at the samples of a motion, shape (samples,)."""
    low: float = -math.inf
    high: float = math.inf
    least: float = 0.0
    """`low`, `high` and `least` are the limits of its chart, as in `Chart`."""


def wrapped(angle: np.ndarray | float) -> np.ndarray:
    """Return an angle [rad] in degrees between -180 and 180."""
    return (np.degrees(angle) + 180) % 360 - 180


def mean_motion(motion: Trajectory, time: np.ndarray) -> np.ndarray:
    """Return where a can that accelerates evenly is [m] at some times [s].

    The can of the motion swings to and fro about this one. If the load slides, this can starts with
    the same momentum, but with its load at rest at the equilibrium; if the load is frozen, it
    starts at the same place with the same speed. It has neither damping nor drag: what these cost
    is how far the can of the motion falls behind it.
    """
    scene = motion.scene
    u = motion.u[0]
    u_dot = motion.u_dot[0]
    if scene.dissipates:
        scene = dataclasses.replace(scene, damping=0.0, drag=0.0)
    if scene.attachment == "sliding":
        swing = scene.load.moment / scene.effective_mass
        u = u - swing * (math.sin(motion.phi[0]) - math.sin(scene.equilibrium()))
        u_dot = u_dot - swing * math.cos(motion.phi[0]) * motion.phi_dot[0]
    since = time - motion.time[0]
    return u + u_dot * since + scene.acceleration() * since**2 / 2


class MeanForces(NamedTuple):
    """Forces of the incline on the can, in weights of can and load, shape (samples,)."""

    normal: np.ndarray
    friction: np.ndarray
    """It is positive up the incline."""


def mean_forces(motion: Trajectory) -> MeanForces:
    """Return the mean forces around each sample, also of a can that slips or flies.

    They follow from the change of momentum in a fiftieth of the motion. The forces at an instant
    would not be readable: a can that hardly presses on the ground rises and lands many times a
    second, and each landing is a blow. Without gravity the unit is the weight on earth.
    """
    scene = motion.scene
    moment = scene.load.moment
    away = scene.mass * motion.lift_dot + moment * np.sin(motion.phi) * motion.phi_dot
    downhill = scene.mass * motion.u_dot - moment * np.cos(motion.phi) * motion.phi_dot
    weight = scene.mass * scene.gravity
    normal = weight * math.cos(scene.incline) + _mean_rate(motion.time, away)
    friction = weight * math.sin(scene.incline) + _mean_rate(motion.time, -downhill)
    unit = scene.mass * (scene.gravity or GRAVITY)
    return MeanForces(normal / unit, friction / unit)


def _mean_rate(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the mean rate of change of values around each time."""
    half = np.ptp(time) / INTERVALS / 2
    before = np.maximum(time - half, time[0])
    after = np.minimum(time + half, time[-1])
    return (np.interp(after, time, values) - np.interp(before, time, values)) / (after - before)


QUANTITIES = {
    "phi": Quantity("angle of the load, φ [°]", lambda motion: wrapped(motion.phi), least=10.0),
    "turns": Quantity(
        "turns of the load", lambda motion: (motion.phi - motion.phi[0]) / math.tau, least=0.1
    ),
    "u": Quantity("distance [m]", lambda motion: motion.distance),
    "u_dot": Quantity("speed [m/s]", lambda motion: motion.u_dot),
    "ahead": Quantity(
        "ahead of even acceleration [mm]",
        lambda motion: 1e3 * (motion.u - mean_motion(motion, motion.time)),
    ),
    "normal": Quantity(
        "normal force, N [weights]",
        lambda motion: mean_forces(motion).normal,
        low=-1.0,
        high=10.0,  # the blow of a landing goes beyond
    ),
    "lift": Quantity("height of flight [mm]", lambda motion: 1e3 * motion.lift),
}
"""What a chart can show, by name."""
