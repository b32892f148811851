"""A scene with its model and integrator, set up once and run often."""

from dataclasses import replace

import numpy as np

from mjbeer.model import state
from mjbeer.model.build import compile_model
from mjbeer.model.setting import DOP853, Setting
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.stepping import Stepper
from mjbeer.simulation.tolerance import Solution, Solver, tuning
from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.scene import Scene


class Prepared:
    """A scene set up to be stepped in a setting; the benchmark times nothing but `solve`.

    Raises:
      UnsupportedError: if MuJoCo cannot have such a model.
      TemplateError: if the template of the scene is missing or not as it should be.
    """

    def __init__(self, scene: Scene, setting: Setting) -> None:
        self.scene, self.setting = scene, setting
        if setting.tolerance is not None:
            timestep = tuning(scene, setting.rolling, setting.timestep)
            self.model = compile_model(scene, replace(setting, integrator=DOP853, timestep=timestep))
            self._method: Solver | Integrator | Stepper = Solver(self.model, scene)
        else:
            self.model = compile_model(scene, setting)
            self._method = Integrator(self.model) if setting.integrator == DOP853 else Stepper(self.model)

    def start(self, phi0: float, phi_dot0: float) -> np.ndarray:
        """Return the state of a start at `phi0` [rad] with `phi_dot0` [rad/s], shape (nq + nv,)."""
        return state.start(self.model, self.scene, phi0=phi0, phi_dot0=phi_dot0)

    def solve(self, start: np.ndarray, times: np.ndarray) -> Solution:
        """Return the states at `times` [s] of the motion from `start`; MuJoCo's integrators use the nearest timesteps.

        Raises:
          DivergenceError: if the motion stops being finite.
          ToleranceError: if the tolerance is not reached.
        """
        if isinstance(self._method, Solver):
            assert self.setting.tolerance is not None
            return self._method.run(start, times, self.setting.tolerance)
        if isinstance(self._method, Integrator):
            return Solution(self._method.run(start, times, self.setting.timestep))
        steps = np.rint(times / self.setting.timestep).astype(np.int64)
        return Solution(self._method.run(start[None], steps)[0])

    def coordinates(self, states: np.ndarray, times: np.ndarray) -> Coordinates:
        """Return the coordinates for states of shape (samples, nq + nv) at `times` [s]."""
        return state.read(self.model, self.scene, states=states, times=times)
