"""The integrator GaussJackson: a multistep method around MuJoCo's forward dynamics, for smooth motions."""

import math

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError, UnsupportedError
from mjbeer.model.engine import quiet, untimed
from mjbeer.model.setting import GAUSS_JACKSON
from mjbeer.simulation import gauss_jackson_kernel
from mjbeer.simulation.dop853 import Integrator, drive
from mjbeer.simulation.gauss_jackson_kernel import COUNT
from mjbeer.simulation.stepping import Watcher

_STARTING = 2
"""Timestep of DOP853, which starts a run, over the timestep. Measured down to 1e-12 rad, the error after 2 s is that of
a start at single timesteps, and at most a quarter more; with three it is up to ten times as large. Two saves forty
evaluations of a run's hundreds."""
_SHARE = 0.046
"""Timestep for an error of 1e-6 rad over the shortest regular step of DOP853 at a local tolerance of 1. It is smaller
than needed in three of four random motions."""
_POWER = 0.07
"""By which power of the tolerance the timestep falls (measured from 1e-6 to 1e-12; at order 12 it is 1/13 to 1/12)."""
_LOOSEST = 1e-6
"""Largest tolerance [rad] for which a timestep is chosen: with larger steps the method's order does not show."""
_GROWTH = 1.5
"""Largest factor from one regular step of DOP853 to the next; a run begins with steps that grow more."""
_FEWEST = 4
"""Smallest number of regular steps that say how long steps may be."""
_START = 7 * COUNT + 2 * COUNT
"""Evaluations before the first step of its own: six and a half a step for DOP853 with samples, and one a state."""


class GaussJackson:
    """The Gauss-Jackson method with second sums around the forward dynamics of one model, set up once and run often.

    A step is two evaluations, where DOP853 has twelve and steps that are three times as large. The method has almost no
    room on the side of damped motions: a damping or a constraint that decays within a few timesteps would make it
    unstable. A run is started by the DOP853 integrator of the model; without a `starter` it makes its own.

    Raises:
      UnsupportedError: if the model has constraints or damping.
      ValueError: if the model has joints other than slides and hinges.
    """

    def __init__(self, model: mujoco.MjModel, starter: Integrator | None = None) -> None:
        if not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_CONSTRAINT:
            raise UnsupportedError("GaussJackson integrates smooth motions only, and this model has constraints")
        damping = model.dof_damping, model.dof_dampingpoly, model.tendon_damping, model.tendon_dampingpoly
        if any(coefficients.any() for coefficients in damping):
            raise UnsupportedError("GaussJackson integrates undamped motions only, and this model has damping")
        self._starter, self._size = Integrator(model) if starter is None else starter, model.nv
        self.evaluations = 0
        """Number of evaluations of the forward dynamics in the last run."""

    def run(self, start: np.ndarray, times: np.ndarray, timestep: float, watch: Watcher | None = None) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv), of the motion from `start` at time 0.

        The first twelve steps of `timestep` [s] are DOP853's, and two more are taken than the times need. Between steps
        the states are those of the polynomial through the accelerations around.

        Raises:
          DivergenceError: if the motion stops being finite.
        """
        size, dynamics = self._size, self._starter.dynamics
        first = timestep * np.arange(COUNT)
        begun = int(np.searchsorted(times, first[-1], side="right"))
        along = np.concatenate([first, times[:begun]])
        order, states = np.argsort(along, kind="stable"), np.empty((len(along), 2 * size))
        try:
            states[order] = self._starter.run(start, along[order], _STARTING * timestep)
        except DivergenceError as error:
            raise DivergenceError(f"GaussJackson could not start: {error}") from error
        samples = np.empty((len(times), 2 * size))
        states, samples[:begun] = states[:COUNT], states[COUNT:]
        sums, history = np.empty((4, size)), np.empty((size, COUNT + gauss_jackson_kernel.BLOCK))
        with quiet(), untimed():
            gauss_jackson_kernel.begin(*dynamics, states, timestep, sums, history)
        if not np.isfinite(sums).all():  # the position over the square of the timestep overflows, or a force does
            raise DivergenceError(f"GaussJackson could not start: its sums are not finite at t = {first[-1]:.6g} s")
        if watch:
            reached = 1 + int(np.searchsorted(first, times[-1]))  # what comes after it is not the run's
            watch(first[:reached], states[:reached])
        rows, place = gauss_jackson_kernel.BLOCK if watch else 0, (first[-1], COUNT - 1, timestep, begun)
        kept = np.empty(rows), np.empty((rows, 2 * size))
        fixed = *dynamics, sums, history, times, samples, kept
        taken = drive(GAUSS_JACKSON, gauss_jackson_kernel.advance, fixed, place, math.inf, watch)
        self.evaluations = self._starter.evaluations + COUNT + taken
        return samples


def plan(ends: np.ndarray, tolerance: float, local: float) -> tuple[float, float]:
    """Return a timestep [s] that should reach a tolerance [rad], and the number of evaluations that it takes.

    `ends` has the times [s] at the start and at the ends of the steps that DOP853 chose with a `local` tolerance. If
    these are too few to tell, the number of evaluations is infinite.
    """
    steps = np.diff(ends)
    settled = np.flatnonzero(steps[1:] <= _GROWTH * steps[:-1])
    regular = steps[settled[0] : -1] if len(settled) else steps[:0]  # the last step is cut at the end of the run
    if len(regular) < _FEWEST:
        return math.nan, math.inf
    share = _SHARE * min(1.0, tolerance / _LOOSEST) ** _POWER
    timestep = share * float(regular.min()) / local ** (1 / 8)
    return timestep, _START + 2 * float(ends[-1]) / timestep
