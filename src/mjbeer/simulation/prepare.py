"""A scene with its model and integrator, set up once and run often."""

import math
from collections.abc import Generator
from contextlib import contextmanager

import numpy as np

from mjbeer.model import state
from mjbeer.model.build import Stepped
from mjbeer.model.numbers import Kind, Numbers
from mjbeer.model.setting import DOP853, GAUSS_JACKSON, Setting
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.gauss_jackson import GaussJackson
from mjbeer.simulation.stepping import Recorder, Solution, Stepper
from mjbeer.simulation.tolerance import Solver
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.scene import Scene

_GREATER = (math.sqrt(5) - 1) / 2
"""The greater of the two parts of a timestep in an uneven run: the golden section, of whose multiples none is near a
whole number, so that no rate of rotation has the same phase at the ends of both parts."""
_idle: dict[Kind, "Prepared"] = {}
"""Set-ups that nobody uses, one of each kind."""


class Prepared:
    """A scene set up to be stepped in a setting; the benchmark times nothing but `solve`.

    If `uneven`, each timestep is taken as two parts of unequal length, or as one and a bit with mjbeer's own
    integrators. The two runs of a motion, even and uneven, then have no timestep in common by which both could be wrong
    alike.

    Raises:
      UnsupportedError: if MuJoCo cannot have such a model.
    """

    def __init__(self, scene: Scene, setting: Setting, uneven: bool = False) -> None:
        self._made = Stepped(_numbers(scene, setting, uneven))
        self.model = self._made.model
        self._begin(scene, setting, uneven)

    def _begin(self, scene: Scene, setting: Setting, uneven: bool) -> None:
        """Set up an integrator for the model, which has the scene's numbers."""
        self.scene, self.setting, model, data = scene, setting, self.model, self._made.data
        self._step = setting.timestep * (_GREATER if uneven else 1)
        self._method: Solver | Integrator | GaussJackson | Stepper
        if setting.tolerance is not None:
            self._method = Solver(model, scene, data)
        elif setting.integrator == DOP853:
            self._method = Integrator(model, data)
        elif setting.integrator == GAUSS_JACKSON:
            self._method = GaussJackson(model, Integrator(model, data))
        else:
            model.opt.timestep = setting.timestep
            self._method = Stepper(model, (_GREATER, 1 - _GREATER) if uneven else (), data)

    @classmethod
    @contextmanager
    def borrowed(cls, scene: Scene, setting: Setting) -> Generator["Prepared"]:
        """Yield a set-up for the block, after which another call may write its scene into the same model.

        All that an idle set-up did before is gone: a motion has the same bits in it as in a new one.
        """
        numbers = _numbers(scene, setting, uneven=False)
        if (prepared := _idle.pop(numbers.kind, None)) is None:  # popped at once, so that no two threads get it
            prepared = cls(scene, setting)
        else:
            prepared._made.write(numbers)
            prepared._begin(scene, setting, uneven=False)
        try:
            yield prepared
        finally:
            _idle[numbers.kind] = prepared

    def start(self, phi0: float, phi_dot0: float) -> np.ndarray:
        """Return the state of a start at `phi0` [rad] with `phi_dot0` [rad/s], shape (nq + nv,)."""
        return state.start(self.model, self.scene, phi0=phi0, phi_dot0=phi_dot0)

    def solve(self, start: np.ndarray, times: np.ndarray, friction: float | None = None) -> Solution:
        """Return the states at `times` [s] of the motion from `start`; MuJoCo's integrators use the nearest timesteps.

        If a coefficient of `friction` is given, the solution has the record of all steps, too.

        Raises:
          DivergenceError: if the motion stops being finite.
          ToleranceError: if the tolerance is not reached.
        """
        method, setting = self._method, self.setting
        if isinstance(method, Solver):
            assert setting.tolerance is not None
            return method.run(start, times, setting.tolerance, math.inf if friction is None else friction)
        within = isinstance(method, Integrator)
        recorder = None if friction is None else Recorder(self.model, self.scene, friction, within)
        if isinstance(method, Stepper):
            states = method.run(start, np.rint(times / setting.timestep).astype(np.int64), recorder)
        else:
            states = method.run(start, times, self._step, watch=recorder)
        return Solution(states, record=recorder.record if recorder else None)

    def coordinates(self, states: np.ndarray, times: np.ndarray) -> Coordinates:
        """Return the coordinates for states of shape (samples, nq + nv) at `times` [s]."""
        return state.read(self.model, self.scene, states=states, times=times)


def _numbers(scene: Scene, setting: Setting, uneven: bool) -> Numbers:
    """Return what is to be written into the model of a scene.

    A rigid equality that is integrated to a tolerance only has to correct the slip that rounding causes. It is tuned to
    sqrt(a/g)/2, a twelfth of the period of a pendulum of length a, which is too slow to limit the steps.
    """
    timestep = setting.timestep * (_GREATER if uneven else 1)
    if setting.tolerance is not None and setting.rolling == "equality" and scene.gravity > 0:
        timestep = float(np.sqrt(scene.can.radius / scene.gravity)) / 2
    return Numbers.of(scene, setting, timestep=timestep)
