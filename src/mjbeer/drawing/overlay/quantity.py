"""What a strip chart below a film can show: a quantity of the motion over time, with its letter and unit."""

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mjbeer.theory.equations import Coordinates
from mjbeer.theory.scene import Scene

_EARTH = 9.81
"""Gravity on earth [m/s^2]."""
_INTERVALS = 200
"""Number of intervals of a motion over which forces are averaged."""


@dataclass(frozen=True)
class Quantity:
    """A number that a motion has at each time."""

    title: str
    """What it is, in words, with its letter and its unit."""
    of: Callable[[Scene, Coordinates], np.ndarray]
    """Its values for a motion, of shape (samples,)."""
    low: float = -math.inf
    """Least value that a chart has room for."""
    high: float = math.inf
    """Largest value that a chart has room for; the blow of a landing goes beyond."""
    least: float = 0.0
    """Least range of values that a chart shows."""


def wrapped(angle: np.ndarray | float) -> np.ndarray:
    """Return an angle [rad] in degrees between -180 and 180."""
    return (np.degrees(angle) + 180) % 360 - 180


def even(scene: Scene, motion: Coordinates, time: np.ndarray) -> np.ndarray:
    """Return where a can would be at some times [s] that accelerates evenly [m].

    It starts with the same momentum as the can of the motion, and with its load at rest in it where that has an
    equilibrium: the motion goes to and fro about it. With damping or drag no can accelerates evenly. It is then one
    that has neither, and what it gains on the motion is what they cost.
    """
    if scene.dissipates:
        scene = dataclasses.replace(scene, damping=0.0, drag=0.0)
    u, u_dot = motion.u[0], motion.u_dot[0]
    if scene.attachment == "sliding":
        swing = scene.load.moment / scene.effective_mass
        u = u - swing * (math.sin(motion.phi[0]) - math.sin(scene.equilibrium()))
        u_dot = u_dot - swing * math.cos(motion.phi[0]) * motion.phi_dot[0]
    since = time - motion.time[0]
    return u + u_dot * since + scene.acceleration() * since**2 / 2


def forces(scene: Scene, motion: Coordinates) -> tuple[np.ndarray, np.ndarray]:
    """Return the normal and the friction force [N] that act in a motion, also while the can slips or is in the air.

    They follow from the change of the momentum of can and load. Each is the mean force over a two hundredth of the
    motion: a stiff contact trembles, which a single step would show and an eye would not. The friction is positive up
    the incline.
    """
    load, heavy = scene.load.moment, scene.mass * scene.gravity
    across = scene.mass * motion.lift_dot + load * np.sin(motion.phi) * motion.phi_dot
    along = scene.mass * motion.u_dot - load * np.cos(motion.phi) * motion.phi_dot
    half = np.ptp(motion.time) / _INTERVALS / 2
    first = np.maximum(motion.time - half, motion.time[0])
    last = np.minimum(motion.time + half, motion.time[-1])

    def change(momentum: np.ndarray) -> np.ndarray:
        values = np.interp(last, motion.time, momentum) - np.interp(first, motion.time, momentum)
        return values / (last - first)

    normal = heavy * math.cos(scene.incline) + change(across)
    return normal, heavy * math.sin(scene.incline) - change(along)


def weight(scene: Scene) -> float:
    """Return the weight of can and load [N], in which forces are drawn; without gravity, that on earth."""
    return scene.mass * (scene.gravity or _EARTH)


def _normal(scene: Scene, motion: Coordinates) -> np.ndarray:
    return forces(scene, motion)[0] / weight(scene)


QUANTITIES = {
    "phi": Quantity("angle of the load, φ [°]", lambda _, motion: wrapped(motion.phi), least=10.0),
    "u": Quantity("way down the incline, u [m]", lambda _, motion: motion.u),
    "u_dot": Quantity("speed down the incline [m/s]", lambda _, motion: motion.u_dot),
    "ahead": Quantity(
        "ahead of even acceleration [mm]", lambda scene, motion: 1e3 * (motion.u - even(scene, motion, motion.time))
    ),
    "normal": Quantity("normal force, N [weights]", _normal, low=-1.0, high=4.0),
    "lift": Quantity("height above the incline [mm]", lambda _, motion: 1e3 * motion.lift),
    "slip": Quantity(
        "slid instead of rolled [mm]",
        lambda scene, motion: 1e3 * (motion.u - motion.u[0] - scene.can.radius * (motion.roll - motion.roll[0])),
    ),
}
"""All of them, by name."""
