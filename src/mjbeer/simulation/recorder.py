"""The record of a run, which is made while a model is stepped."""

import math
from typing import NamedTuple

import mujoco
import numpy as np

from mjbeer.model.joints import to_coordinates
from mjbeer.theory.equations import Coordinates, accelerations, select_samples
from mjbeer.theory.record import Record, RecordMaker
from mjbeer.theory.scene import Scene


class Recorder:
    """Makes the record of a run of a scene's model: an `Observer`.

    It looks at the ends of all steps. Steps of mjbeer's own integrators are so long that forces
    have to be looked for within them, too.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        scene: Scene,
        friction: float = math.inf,
        look_within_steps: bool = False,
    ) -> None:
        self._model = model
        self._scene = scene
        self._looks_within_steps = look_within_steps
        self._maker = RecordMaker(scene, friction)
        self._last: _Ends | None = None

    @property
    def record(self) -> Record:
        """Return the record of the steps so far."""
        return self._maker.record

    def __call__(self, times: np.ndarray, states: np.ndarray) -> None:
        """Add the next steps."""
        motion = to_coordinates(self._model, self._scene, states, times)
        if not self._looks_within_steps:
            self._maker.add(motion)
            return
        self._maker.add_states(motion)
        ends = _Ends.of(self._scene, motion)
        if self._last is None:
            start = select_samples(motion, [0])
            self._maker.add_forces(start.time, start.phi, start.phi_dot, start.u_dot)
        else:
            ends = self._last.followed_by(ends)
        if len(ends.time) > 1:
            self._add_forces_within(ends)
        self._last = ends.last()

    def _add_forces_within(self, ends: "_Ends") -> None:
        """Add the forces at points within steps, and at all of their ends except the first."""
        step = np.diff(ends.time)[:, np.newaxis]
        time = ends.time[:-1, np.newaxis] + step * _SHARES
        turned, phi_dot = _interpolate(step, ends.phi, ends.phi_dot, ends.phi_ddot)
        _, u_dot = _interpolate(step, ends.u, ends.u_dot, ends.u_ddot)
        phi = ends.phi[:-1, np.newaxis] + turned
        self._maker.add_forces(time.ravel(), phi.ravel(), phi_dot.ravel(), u_dot.ravel())


class _Ends(NamedTuple):
    """The state and the accelerations at the ends of steps, each of shape (ends,)."""

    time: np.ndarray
    phi: np.ndarray
    phi_dot: np.ndarray
    phi_ddot: np.ndarray
    u: np.ndarray
    u_dot: np.ndarray
    u_ddot: np.ndarray

    @classmethod
    def of(cls, scene: Scene, motion: Coordinates) -> "_Ends":
        u_ddot, phi_ddot = accelerations(scene, motion.phi, motion.phi_dot, motion.u_dot)
        return cls(
            time=motion.time,
            phi=motion.phi,
            phi_dot=motion.phi_dot,
            phi_ddot=phi_ddot,
            u=motion.u,
            u_dot=motion.u_dot,
            u_ddot=u_ddot,
        )

    def followed_by(self, more: "_Ends") -> "_Ends":
        """Return these ends and `more` of them."""
        return _Ends(*np.concatenate([self, more], axis=1))

    def last(self) -> "_Ends":
        """Return the last end alone."""
        return _Ends(*(values[-1:] for values in self))


_POINTS = 32
"""Points in a step at which forces are looked for. A step may be half a swing long. If N varies in
it by its own size, then its extreme between two points is (pi/64)^2/2, a thousandth, beyond
them."""
_SHARES = np.arange(1, _POINTS + 1) / _POINTS
_POWERS = np.arange(1, 6)
_CONDITIONS = np.array(
    [
        [1, 1, 1, 1, 1],  # the change over the step
        [1, 0, 0, 0, 0],  # the slope at its beginning
        [0, 2, 0, 0, 0],  # the second derivative there
        [1, 2, 3, 4, 5],  # the slope at its end
        [0, 2, 6, 12, 20],  # the second derivative there
    ]
)
"""What the polynomial c1 x + ... + c5 x^5, with x from 0 to 1 over a step, has to fulfil."""
_COEFFICIENTS = np.linalg.inv(_CONDITIONS)
"""The inverse: the coefficients are its product with the five numbers that fulfil the
conditions."""
_CHANGES = _SHARES[:, np.newaxis] ** _POWERS @ _COEFFICIENTS
"""Change since the beginning, a row for each point within the step: its product with these numbers
is what the polynomial is there."""
_SLOPES = _POWERS * _SHARES[:, np.newaxis] ** (_POWERS - 1) @ _COEFFICIENTS
"""The same for the slope."""


def _interpolate(
    step: np.ndarray, value: np.ndarray, slope: np.ndarray, bend: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return how a coordinate has changed since the beginning of each step, and its slope.

    Both are at the points within a step, shape (steps, points). Given are the lengths of the steps
    [s], shape (steps, 1), and at their ends the coordinate and its first and second derivatives,
    shape (steps + 1,).
    """
    length = step[:, 0]
    conditions = np.stack(
        [
            np.diff(value),
            length * slope[:-1],
            length**2 * bend[:-1],
            length * slope[1:],
            length**2 * bend[1:],
        ],
        axis=-1,
    )
    return conditions @ _CHANGES.T, conditions @ _SLOPES.T / step
