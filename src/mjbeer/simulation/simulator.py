"""A scene set up to be stepped; the models of one structure are compiled once, and each thread keeps its own."""

import math
import threading
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from mjbeer.model.build import compiled_model, write_numbers
from mjbeer.model.check import check_run, is_edited
from mjbeer.model.compiled_numbers import compiled_views
from mjbeer.model.joints import initial_state
from mjbeer.model.model_numbers import ModelNumbers, Structure
from mjbeer.model.setting import MJBEER_INTEGRATORS, Setting
from mjbeer.simulation.fixed_step import Recorder, Solution, states_after
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.scene import Scene

if TYPE_CHECKING:
    from mjbeer.integrators.dynamics import Dynamics

_GOLDEN_SECTION = (math.sqrt(5) - 1) / 2
"""The greater part of a timestep in an uneven run. None of its multiples is near a whole number, so that no rate of
rotation has the same phase at the ends of both parts."""
_kept = threading.local()
"""The simulators of a thread by the structure of their models: to make one takes longer than most runs."""


class Simulator:
    """A scene set up to be stepped in a setting, by one thread at a time; the benchmark times nothing but `solve`.

    If `uneven`, each timestep is taken as two parts of unequal length, or as one and a bit with mjbeer's own
    integrators, so that an even and an uneven run have no timestep by which both could be wrong alike.

    Raises:
      UnsupportedError: if MuJoCo cannot have such a model.
    """

    def __init__(self, scene: Scene, setting: Setting, uneven: bool = False) -> None:
        mechanics = _mechanics(scene, setting, uneven)
        self.model, self._uneven = compiled_model(mechanics), uneven
        self.data = mujoco.MjData(self.model)
        self._views = compiled_views(self.model, mechanics.parameters)
        self._written: ModelNumbers | None = None
        self._edited = is_edited(mechanics)
        self._dynamics: Dynamics | None = None  # of a model that one of mjbeer's own integrators has stepped
        self._write(mechanics)

    @classmethod
    def kept(cls, scene: Scene, setting: Setting) -> "Simulator":
        """Return this thread's simulator of such models, in which its last scene leaves no trace."""
        mechanics = _mechanics(scene, setting)
        simulators: dict[Structure, Simulator] = vars(_kept).setdefault("simulators", {})
        if (simulator := simulators.get(mechanics.structure)) is None:
            simulator = simulators[mechanics.structure] = cls(scene, setting)
        simulator._write(mechanics)
        return simulator

    def _write(self, mechanics: ModelNumbers) -> None:
        """Write the numbers of a scene into the model, if they are new, and reset the data."""
        self.scene, self.setting = mechanics.scene, mechanics.setting
        if mechanics == self._written:
            mujoco.mj_resetData(self.model, self.data)
        else:
            self._written = None  # until all of it is written
            write_numbers(self.model, self.data, mechanics, self._views)
            self._written = mechanics
        if self._dynamics is not None:
            self._dynamics.begin()

    def initial_state(self, phi0: float, phi_dot0: float) -> np.ndarray:
        """Return the state of a start at `phi0` [rad] with `phi_dot0` [rad/s], shape (nq + nv,)."""
        return initial_state(self.model, self.scene, phi0, phi_dot0)

    def check(self, motion: Coordinates) -> None:
        """Compare the MJCF with theory at the states of a run of this scene, unless it is mjbeer's own.

        Raises:
          TemplateError: if it does not move as theory says there.
        """
        if self._edited:
            check_run(_mechanics(self.scene, self.setting), motion)

    def solve(self, start: np.ndarray, times: np.ndarray, friction: float | None = None) -> Solution:
        """Return the states at `times` [s] of the motion from `start`; MuJoCo's integrators use the nearest timesteps.

        If a coefficient of `friction` is given, the solution has the record of all steps, too.

        Raises:
          DivergenceError: if the motion stops being finite.
          ToleranceError: if the tolerance is not reached.
        """
        scene, model, integrator = self.scene, self.model, self.setting.integrator
        timestep, tolerance = self.setting.timestep, self.setting.tolerance
        recorder: Recorder | None = None
        if tolerance is None and friction is not None:
            recorder = Recorder(model, scene, friction, within=integrator in MJBEER_INTEGRATORS)
        if tolerance is None and integrator not in MJBEER_INTEGRATORS:
            parts = (_GOLDEN_SECTION * timestep, (1 - _GOLDEN_SECTION) * timestep) if self._uneven else (timestep,)
            steps = np.rint(times / timestep).astype(np.int64)
            states = states_after(model, self.data, start, steps, parts, recorder)
            return Solution(states, recorder.record if recorder else None, None, integrator)
        # Imported only here: numba, which compiles them, takes longer to import than all else together.
        from mjbeer.integrators.dop853 import DOP853
        from mjbeer.integrators.dynamics import Dynamics
        from mjbeer.integrators.gauss_jackson import GaussJackson
        from mjbeer.simulation.tolerance import ToleranceLoop, even_at_most

        dynamics = self._dynamics = self._dynamics or Dynamics(model, self.data)
        if tolerance is not None:
            loop = ToleranceLoop(model, scene, dynamics)
            return loop.run(start, times, tolerance, math.inf if friction is None else friction)
        if self._uneven:
            timestep *= _GOLDEN_SECTION
        if integrator == "DOP853":
            states = DOP853(model, dynamics).run(start, times, timestep, observer=recorder)
        else:
            states = GaussJackson(model, dynamics).run(start, times, timestep, even_at_most(scene), recorder)
        return Solution(states, recorder.record if recorder else None, None, integrator)


def _mechanics(scene: Scene, setting: Setting, uneven: bool = False) -> ModelNumbers:
    """Return what is to be written into the model of a scene.

    A rigid equality that is integrated to a tolerance only has to correct the slip that rounding causes. It is tuned to
    sqrt(a/g)/2, a twelfth of the period of a pendulum of length a, which is too slow to limit the steps.
    """
    timestep = setting.timestep * (_GOLDEN_SECTION if uneven else 1)
    if setting.tolerance is not None and setting.rolling == "equality" and scene.gravity > 0:
        timestep = math.sqrt(scene.can.radius / scene.gravity) / 2
    return ModelNumbers(scene, setting, timestep=timestep)
