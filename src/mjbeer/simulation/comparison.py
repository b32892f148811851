"""How far two runs of a motion are apart, and what their distance and their drift say of the error."""

import math

import mujoco
import numpy as np

from mjbeer.model.state import read
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import angle_distance

_SAFETY = 1.5
"""Error estimate over the distance of two runs."""
SAFETY_BY_CHANCE = 3.0
"""The same where two runs may agree by chance: from the third run on, and for tolerances outside `_ASYMPTOTIC`, where
rounding or large steps hide the method's order."""
_ASYMPTOTIC = (1e-11, 1e-5)
"""Range of tolerances in which the method's order shows: the finer run has an eighth of the other one's error."""
NUDGE = 4e-14
"""Distance of the first run's start from the given start, relative to `scales`. The distance of the first two runs then
includes the effect of a small change of the start, which is large beside a separatrix."""
ROUNDING_OVER_NUDGE = 3 / 40
"""Estimated effect of rounding over the effect of `NUDGE`: the rounding of a run is like a nudge of some 1e-15, with a
safety factor of 3."""
_DRIFT = 0.5
"""Error of phi over that which the drift of the swing's energy implies at most: the rate of a rotation goes with the
square root of its energy, and the frequency of a swing depends on its energy less than that."""
_FAR = 4.0
"""Beside a barrier the frequency depends on the energy more, and _DRIFT grows: from where the energy is as near to that
of the barrier as a quarter of the largest kinetic energy (measured for swings of 2.85 rad: 2 instead of 0.5)."""
_NEAREST = 10.0
"""How many times _DRIFT is at most. Nearer to the barrier the drift would be that of rounding, and the distance of the
runs shows how much the motion amplifies."""
_COMPARED = 64
"""Largest number of samples at which two runs are compared; they are spread over the motion as unevenly as the golden
section, so that no period is a multiple of the gaps. A run that is only compared has no others, as a sample in every
step takes a quarter more evaluations."""
_GOLDEN = (math.sqrt(5) - 1) / 2


class Comparison:
    """A model of a scene, whose runs are compared."""

    def __init__(self, model: mujoco.MjModel, scene: Scene) -> None:
        self.scale = scales(model, scene)
        """Size of each component of the state, as `scales` returns it."""
        self._contact = bool(model.npair)
        # phi and u/a are sums of components of the state.
        unit = read(model, scene, np.eye(model.nq + model.nv), times=np.zeros(model.nq + model.nv))
        self._angles = np.column_stack([unit.phi, unit.u / scene.can.radius])

    def aside(self, start: np.ndarray, distance: float = NUDGE) -> np.ndarray:
        """Return a start at a `distance` from `start`, relative to `scale`."""
        return start + distance * self.scale

    def distance(self, coarse: np.ndarray, fine: np.ndarray, start: np.ndarray) -> float:
        """Return the largest distance of two runs in phi or u/a [rad], relative to the angle beyond 1 rad."""
        angles, truth, first = coarse @ self._angles, fine @ self._angles, start @ self._angles
        return max(angle_distance(angles[:, column], truth[:, column], float(first[column])) for column in (0, 1))

    def drift(self, record: Record) -> float:
        """Return the error of phi and u/a [rad] that the drift of energy and momentum implies.

        A contact has no such drift to judge by: it takes energy, and gives it back.
        """
        if self._contact:
            return 0.0
        gap = _FAR * record.to_barrier
        share = min(max(1.0, record.swing / gap), _NEAREST) if gap > 0 else _NEAREST
        return max(_DRIFT * share * record.swing_error, record.axis_error)


def safety(tolerance: float) -> float:
    """Return the error estimate of a tolerance [rad] over the distance of the first two runs."""
    return _SAFETY if _ASYMPTOTIC[0] < tolerance < _ASYMPTOTIC[1] else SAFETY_BY_CHANCE


def few(samples: int) -> np.ndarray:
    """Return the indices of the samples at which two runs are compared: all, or `_COMPARED` of them with the last."""
    if samples <= _COMPARED:
        return np.arange(samples)
    spread = samples * (np.arange(1, _COMPARED) * _GOLDEN % 1)
    return np.unique(np.append(spread.astype(int), samples - 1))


def scales(model: mujoco.MjModel, scene: Scene) -> np.ndarray:
    """Return the size of each component of the state below which its error counts absolutely, shape (nq + nv,).

    It is a radius for lengths and 1 rad for angles, and these times sqrt(g/a) for their rates.
    """
    radius = scene.can.radius
    positions = np.where(model.jnt_type == mujoco.mjtJoint.mjJNT_SLIDE, radius, 1.0)
    rate = np.sqrt(scene.gravity / radius) if scene.gravity > 0 else 1.0
    return np.concatenate([positions, positions * rate])
