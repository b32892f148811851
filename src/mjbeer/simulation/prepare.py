"""A scene with its model and integrator, set up once and run often."""

import math
import threading
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
whole number. So no rate of rotation has the same phase at the ends of both parts, step by step."""

_MOST_IDLE = 8
"""Largest number of idle set-ups that are kept for later calls: each has memory for contacts that it hardly touches."""
_idle: list[tuple[Kind, "Prepared"]] = []
"""Set-ups that nobody uses, with the kind of each, the oldest first."""
_taking = threading.Lock()


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
        self.scene, self.setting = scene, setting
        self._step = _step(setting, uneven)
        """Timestep to which constraints are tuned, and that of mjbeer's own integrators."""
        if setting.tolerance is not None:
            self._method: Solver | Integrator | GaussJackson | Stepper = Solver(self.model, scene, self._made.data)
        elif setting.integrator == DOP853:
            self._method = Integrator(self.model, self._made.data)
        elif setting.integrator == GAUSS_JACKSON:
            self._method = GaussJackson(self.model, Integrator(self.model, self._made.data))
        else:
            self.model.opt.timestep = setting.timestep
            self._method = Stepper(self.model, (_GREATER, 1 - _GREATER) if uneven else (), self._made.data)

    @classmethod
    @contextmanager
    def borrowed(cls, scene: Scene, setting: Setting) -> Generator["Prepared"]:
        """Yield a set-up for the block, after which another call may write its scene into the same model.

        All that an idle set-up did before is gone: a motion has the same bits in it as in a new one.
        """
        numbers = _numbers(scene, setting, uneven=False)
        with _taking:
            places = [place for place, (kind, _) in enumerate(_idle) if kind == numbers.kind]
            prepared = _idle.pop(places[0])[1] if places else None
        if prepared is None:
            prepared = cls(scene, setting)
        else:
            prepared._made.write(numbers)
            prepared._begin(scene, setting, uneven=False)
        try:
            yield prepared
        finally:
            with _taking:
                _idle.append((numbers.kind, prepared))
                del _idle[:-_MOST_IDLE]

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
        if isinstance(self._method, Solver):
            assert self.setting.tolerance is not None
            return self._method.run(start, times, self.setting.tolerance, math.inf if friction is None else friction)
        within = isinstance(self._method, Integrator)
        recorder = None if friction is None else Recorder(self.model, self.scene, friction, within)
        if isinstance(self._method, Integrator | GaussJackson):
            states = self._method.run(start, times, self._step, watch=recorder)
        else:
            steps = np.rint(times / self.setting.timestep).astype(np.int64)
            states = self._method.run(start, steps, recorder)
        return Solution(states, record=recorder.record if recorder else None)

    def coordinates(self, states: np.ndarray, times: np.ndarray) -> Coordinates:
        """Return the coordinates for states of shape (samples, nq + nv) at `times` [s]."""
        return state.read(self.model, self.scene, states=states, times=times)


def _step(setting: Setting, uneven: bool) -> float:
    return setting.timestep * (_GREATER if uneven else 1)


def _numbers(scene: Scene, setting: Setting, uneven: bool) -> Numbers:
    """Return what is to be written into the model of a scene.

    A rigid equality that is integrated to a tolerance only has to correct the slip that rounding causes. It is tuned to
    sqrt(a/g)/2, a twelfth of the period of a pendulum of length a, which is too slow to limit the steps.
    """
    timestep = _step(setting, uneven)
    if setting.tolerance is not None and setting.rolling == "equality" and scene.gravity > 0:
        timestep = float(np.sqrt(scene.can.radius / scene.gravity)) / 2
    return Numbers.of(scene, setting, timestep=timestep)
