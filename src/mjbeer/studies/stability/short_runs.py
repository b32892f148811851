"""Short runs of stiff models at any timestep: how they end, measured and by linear theory.

A can with frozen beer on level ground is the stiffer, the harder its constraint, or the stronger gravity. Beer that
slides in a can of sheet metal is the stiffer, the stronger it is damped. Both motions, MuJoCo's and theory's, begin
with the same small swing and are judged by the same rule.
"""

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.integrators.dop853 import Dop853
from mjbeer.model.build import build, specify
from mjbeer.model.joints import joint_addresses
from mjbeer.model.setting import DOP853, Integrator
from mjbeer.simulation.fixed_step import states_after
from mjbeer.studies import predictions
from mjbeer.studies.predictions import ACCURACY, GROWTH, spring
from mjbeer.theory.can import Can
from mjbeer.theory.scenes import frozen, sliding

EXPLODED, INACCURATE, ACCURATE = range(3)
"""Outcomes of a run, as numbers for the cells of a map."""
_IMPEDANCE = 0.9
"""dmin and dmax in the solimp of the constraints: both are MuJoCo's default dmin."""
_SWING = 1e-4
"""Angle from which the can is let go [rad]."""
_SEED = 1e-7
"""Initial violation of the constraint, relative to `_SWING`. It must be tiny: a stiff constraint corrects it within one
time constant, and 1e-4 would already disturb the swing by 1 % at tau = 1 ms."""
_STEPS = 1000
"""Least number of steps of a swing: within it, a growth of 2 % a step makes any initial violation visible."""


@dataclass(frozen=True)
class Plan:
    """Everything that defines the runs of a map except timestep and stiffness."""

    family: str
    """The cause of stiffness: an equality whose solref has a time constant ("solref") or a stiffness ("direct"),
    "gravity" without a constraint, or the "damping" between can and load."""
    integrator: Integrator

    @property
    def name(self) -> str:
        """Name that is unique among the plans."""
        return f"{self.family}, {self.integrator}"


class Swings:
    """Swings with one plan and one value: a time constant [s], a direct stiffness [1/s^2], a gravity [m/s^2], or a
    damping [N m s].

    A swing that grows beyond `GROWTH` times its start has exploded, and one whose error exceeds `ACCURACY` in the first
    half period is inaccurate.
    """

    def __init__(self, plan: Plan, value: float) -> None:
        self._integrator, self._row = plan.integrator, None
        if plan.family in ("solref", "direct"):
            scene, critical = frozen(0.0), 2 * math.sqrt(value)
            spec = specify(scene, "equality", integrator=plan.integrator)
            direct = plan.family == "direct"
            for constraint in spec.equalities:
                constraint.solref = (-value, -critical) if direct else (value, 1.0)
                constraint.solimp[:2] = _IMPEDANCE
            row = predictions.direct(value, critical, _IMPEDANCE) if direct else spring(value, 1.0, _IMPEDANCE)
            self._model, self._row = spec.compile(), row
        else:
            damped = plan.family == "damping"
            scene = sliding(0.0, can=Can.sheet_metal(), damping=value) if damped else frozen(0.0, gravity=value)
            self._model = build(scene, "reduced", integrator=plan.integrator)
        self._frequency, self._right = scene.frequency(), predictions.small_motion(scene)
        self._theory = predictions.small_motion(scene, constrained=self._row is not None)
        self._start = np.zeros(self._model.nq + self._model.nv)
        for name, at in joint_addresses(self._model).items():
            self._start[at] = _SWING * (scene.can.radius * (1 + _SEED) if name == "slide" else 1.0)

    def measure(self, timestep: float) -> int:
        """Simulate with a timestep [s] and return the outcome."""
        self._model.opt.timestep = timestep
        samples = np.arange(self._steps(timestep) + 1)
        try:
            if self._integrator == DOP853:
                states = Dop853(self._model).run(self._start, samples * timestep, timestep)
            else:
                states = states_after(self._model, mujoco.MjData(self._model), self._start, samples)
        except DivergenceError:
            return EXPLODED
        return self._judge(states, timestep)

    def predict(self, timestep: float) -> int:
        """Return the outcome by linear theory, which multiplies the start by the matrix of one step again and again."""
        matrix = self._theory.step(self._integrator, timestep, self._row)
        unit = np.repeat([1.0, timestep], self._model.nq)
        states = predictions.motion(matrix, self._start * unit, self._steps(timestep))
        with np.errstate(over="ignore"):
            return self._judge(states / unit, timestep)

    def _steps(self, timestep: float) -> int:
        """Return the number of steps of a run: half a period, or `_STEPS` if that is more."""
        return max(_STEPS, math.ceil(math.pi / (self._frequency * timestep)))

    def _judge(self, states: np.ndarray, timestep: float) -> int:
        count = self._model.nq
        with np.errstate(invalid="ignore"):
            if not (np.abs(states[:, :count]) < GROWTH * self._start[:count]).all():
                return EXPLODED
        pace, last = self._frequency * timestep, len(self._right.mass) - 1  # phi is the last coordinate everywhere
        early = states[: max(1, math.floor(math.pi / pace)) + 1] / _SWING
        right = predictions.motion(self._right.exact(timestep), np.eye(2 * last + 2)[last], len(early) - 1)
        phi = early[:, count - 1] - right[:, last]
        rate = early[:, -1] / self._frequency - right[:, -1] / pace
        return ACCURATE if np.hypot(phi, rate).max() < ACCURACY else INACCURATE
