"""The integrator GaussJackson: a multistep method around MuJoCo's forward dynamics, for smooth motions."""

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError, UnsupportedError
from mjbeer.model.engine import quiet, untimed
from mjbeer.simulation import gauss_jackson_kernel
from mjbeer.simulation.compiling import told
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.gauss_jackson_weights import COUNT
from mjbeer.simulation.recorder import Recorder

_STARTING = 2
"""Timestep of DOP853, which starts a run, over the timestep. Measured down to 1e-12 rad, the error after 2 s is that of
a start at single timesteps, and at most a quarter more; with three it is up to ten times as large. Two saves forty
evaluations of a run's hundreds."""


class GaussJackson:
    """The Gauss-Jackson method with second sums around the forward dynamics of one model, set up once and run often.

    A step is two evaluations, where DOP853 has twelve and steps that are three times as large. The method has almost no
    room on the side of damped motions: a damping or a constraint that decays within a few timesteps would make it
    unstable. Without `data` of the model, in its initial state, it makes its own.

    Raises:
      UnsupportedError: if the model has constraints or damping.
      ValueError: if the model has joints other than slides and hinges.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData | None = None) -> None:
        if not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_CONSTRAINT:
            raise UnsupportedError("GaussJackson integrates smooth motions only, and this model has constraints")
        damping = model.dof_damping, model.dof_dampingpoly, model.tendon_damping, model.tendon_dampingpoly
        if any(coefficients.any() for coefficients in damping):
            raise UnsupportedError("GaussJackson integrates undamped motions only, and this model has damping")
        self._starter, self._size = Integrator(model, data), model.nv
        self.evaluations = 0
        """Number of evaluations of the forward dynamics in the last run."""

    def run(
        self, start: np.ndarray, times: np.ndarray, timestep: float, recorder: Recorder | None = None
    ) -> np.ndarray:
        """Return the states at increasing `times` [s], shape (samples, nq + nv), of the motion from `start` at time 0.

        The first twelve steps of `timestep` [s] are DOP853's, and two more are taken than the times need: a run is no
        shorter than these fourteen. Between steps the states are those of the polynomial through the accelerations
        around. A `recorder` is shown all steps.

        Raises:
          DivergenceError: if the motion stops being finite.
        """
        size, pointers, views = self._size, self._starter._pointers, self._starter._views
        first = timestep * np.arange(COUNT)
        try:
            states, slopes = self._starter.run(start, first, _STARTING * timestep), np.empty((COUNT, 2 * size))
        except DivergenceError as error:
            raise DivergenceError(f"GaussJackson could not start: {error}") from error
        sums, history = np.empty((4, size)), np.empty((size, COUNT + gauss_jackson_kernel.BLOCK))
        samples, begun = np.empty((len(times), 2 * size)), int(np.searchsorted(times, 0.0, side="right"))
        samples[:begun] = start
        place, status = (timestep, COUNT - 1, begun), gauss_jackson_kernel.BLOCK_END
        rows = gauss_jackson_kernel.BLOCK if recorder else 0
        kept = np.empty(rows), np.empty((rows, 2 * size)), np.empty((rows, 2 * size))
        with told(gauss_jackson_kernel.advance), quiet(), untimed():
            gauss_jackson_kernel.begin(pointers, views, states, slopes, timestep, sums, history)
            self.evaluations = self._starter.evaluations + COUNT
            if not np.isfinite(sums).all():  # the position over the square of the timestep overflows, or a force does
                raise DivergenceError(f"GaussJackson could not start: its sums are not finite at t = {first[-1]:.6g} s")
            if recorder:
                reached = 1 + int(np.searchsorted(first, times[-1]))  # what comes after it is not the run's
                recorder.add_smooth(first[:reached], states[:reached], slopes[:reached])
            while status == gauss_jackson_kernel.BLOCK_END:
                status, place, taken, rows = gauss_jackson_kernel.advance(
                    pointers, views, sums, history, times, samples, place, kept
                )
                if recorder and rows:
                    recorder.add_smooth(*(part[:rows] for part in kept))
                self.evaluations += 2 * taken
        if status == gauss_jackson_kernel.NOT_FINITE:
            raise DivergenceError(
                f"the GaussJackson run diverged at t = {place[1] * timestep:.6g} s: its state is no longer finite"
            )
        return samples
