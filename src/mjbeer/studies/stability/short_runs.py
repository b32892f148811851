"""Short runs of stiff models at any timestep: how they end, measured and by linear theory.

A can with frozen beer on level ground is the stiffer, the harder its constraint, or the stronger gravity. Beer that
slides in a can of sheet metal, let go at 1 rad on the paper's incline, is the stiffer, the stronger it is damped; all
ways of rolling can have it, and so are compared with the same motion.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.integrators.dop853 import Dop853
from mjbeer.model.build import build, specify
from mjbeer.model.joints import joint_addresses
from mjbeer.model.mechanics import stiffest
from mjbeer.model.setting import DOP853, Integrator, Rolling, Setting
from mjbeer.simulation.fixed_step import states_after
from mjbeer.simulation.run import integrate
from mjbeer.studies.predictions import linear_stability, soft_constraint, soft_rolling
from mjbeer.studies.predictions.linear_stability import ACCURACY, GROWTH
from mjbeer.studies.predictions.soft_constraint import MAX_IMPEDANCE, SoftRow, spring
from mjbeer.studies.stability.judge import REFUSALS, Angles
from mjbeer.theory.can import Can
from mjbeer.theory.equations import kinetic_energy
from mjbeer.theory.exact import exact
from mjbeer.theory.record import ERROR
from mjbeer.theory.scenes import frozen, sliding

EXPLODED, INACCURATE, ACCURATE = range(3)
"""Outcomes of a run, as numbers for the cells of a map."""
BOUNDED = -1
"""What theory says of a damped run that does not explode: that it ends in one of the other ways."""
_IMPEDANCE = 0.9
"""dmin and dmax in the solimp of the constraints: both are MuJoCo's default dmin."""
_SWING = 1e-4
"""Angle from which the frozen can is let go [rad]."""
_SEED = 1e-7
"""Initial violation of the constraint, relative to `_SWING`. It must be tiny: a stiff constraint corrects it within one
time constant, and 1e-4 would already disturb the swing by 1 % at tau = 1 ms."""
_STEPS = 1000
"""Least number of steps of a swing: within it, a growth of 2 % a step makes any initial violation visible."""
_START, _DURATION, _SAMPLES = 1.0, 1.024, 16
"""phi at the start of a damped run [rad], where can and load are at rest; its duration [s], in which the load swings
twice; and its samples after the start."""
_PARTS = 8
"""Parts of a damped run in which theory takes the load's angle as constant."""
_POINTS = 2
"""Number of points at which the damped can in contact touches the ground."""
_GAIN = 10.0
"""A damped run explodes if its kinetic energy exceeds the largest that the motion can have by this factor."""


@dataclass(frozen=True)
class Plan:
    """Everything that defines the runs of a map except timestep and stiffness."""

    family: str
    """What makes the motion stiff: an equality whose solref has a time constant ("solref") or a stiffness ("direct"),
    "gravity" without a constraint, or the "damping" between can and load."""
    integrator: Integrator
    rolling: Rolling = "reduced"
    """The way of rolling of a damped can."""

    @property
    def name(self) -> str:
        """Name that is unique among the plans."""
        return ", ".join([self.family, *([self.rolling] if self.family == "damping" else []), self.integrator])

    def runs(self, value: float, timesteps: Sequence[float]) -> "Swings | DampedRuns":
        """Return what makes and predicts the runs at one stiffness or damping."""
        return DampedRuns(self, value, timesteps) if self.family == "damping" else Swings(self, value)


class Swings:
    """Swings with one plan and one stiffness: a time constant [s], a direct stiffness [1/s^2] or a gravity [m/s^2].

    Both motions, MuJoCo's and theory's, begin with the same small swing and are judged by the same rule: one that grows
    beyond `GROWTH` times its start has exploded, one whose error exceeds `ACCURACY` in the first half period is
    inaccurate.
    """

    def __init__(self, plan: Plan, value: float) -> None:
        self._plan, self._value = plan, value
        self._scene = frozen(0.0, gravity=value) if plan.family == "gravity" else frozen(0.0)
        self._frequency, radius = self._scene.frequency(), self._scene.can.radius
        if plan.family == "gravity":
            self._model = build(self._scene, "reduced", integrator=plan.integrator)
        else:
            spec = specify(self._scene, "equality", integrator=plan.integrator)
            for constraint in spec.equalities:
                critical = -value, -2 * math.sqrt(value)
                constraint.solref = critical if plan.family == "direct" else (value, 1.0)
                constraint.solimp[:2] = _IMPEDANCE
            self._model = spec.compile()
        self._start = np.zeros(self._model.nq + self._model.nv)
        for name, at in joint_addresses(self._model).items():
            self._start[at] = _SWING * (radius * (1 + _SEED) if name == "slide" else 1.0)

    def measure(self, timestep: float) -> int:
        """Simulate with a timestep [s] and return the outcome."""
        self._model.opt.timestep = timestep
        samples = np.arange(self._steps(timestep) + 1)
        try:
            if self._plan.integrator == DOP853:
                states = Dop853(self._model).run(self._start, samples * timestep, timestep)
            else:
                states = states_after(self._model, mujoco.MjData(self._model), self._start, samples)
        except DivergenceError:
            return EXPLODED
        return self._judge(states, timestep)

    def predict(self, timestep: float) -> int:
        """Return the outcome by linear theory, which multiplies the start by the matrix of one step again and again."""
        unit = np.repeat([1.0, timestep], self._model.nq)
        states = linear_stability.motion(self._step(timestep), self._start * unit, self._steps(timestep))
        with np.errstate(over="ignore"):
            return self._judge(states / unit, timestep)

    def _step(self, timestep: float) -> np.ndarray:
        """Return the matrix of one step by linear theory."""
        integrator, value = self._plan.integrator, self._value
        if self._plan.family == "gravity":
            return linear_stability.amplification(integrator, (self._frequency * timestep) ** 2)
        if self._plan.family == "direct":
            row: SoftRow = soft_constraint.direct(value, 2 * math.sqrt(value), _IMPEDANCE)
        else:
            row = spring(value, 1.0, _IMPEDANCE)
        return soft_rolling.by_equality(self._scene).step(integrator, row, timestep)

    def _steps(self, timestep: float) -> int:
        """Return the number of steps of a run: half a period, or `_STEPS` if that is more."""
        return max(_STEPS, math.ceil(math.pi / (self._frequency * timestep)))

    def _judge(self, states: np.ndarray, timestep: float) -> int:
        count, joints = self._model.nq, joint_addresses(self._model)
        with np.errstate(invalid="ignore"):
            if not (np.abs(states[:, :count]) < GROWTH * self._start[:count]).all():
                return EXPLODED
        at = joints.get("phi", joints.get("roll"))
        early = states[: max(1, math.floor(math.pi / (self._frequency * timestep))) + 1]
        angles = self._frequency * timestep * np.arange(len(early))
        phi, rate = early[:, at] / _SWING, early[:, count + at] / (_SWING * self._frequency)
        errors = np.hypot(phi - np.cos(angles), rate + np.sin(angles))
        return ACCURATE if errors.max() < ACCURACY else INACCURATE


class DampedRuns:
    """Runs with one plan and one damping [N m s], at any of some timesteps [s]."""

    def __init__(self, plan: Plan, damping: float, timesteps: Sequence[float]) -> None:
        self._plan, self._scene = plan, sliding(can=Can.sheet_metal(), damping=damping)
        every = np.unique(np.concatenate([_samples(timestep) for timestep in timesteps]))
        self._exact = exact(self._scene, every, _START)
        self._kinetic = float(kinetic_energy(self._scene, self._exact).max())
        self._systems = list(self._linearized())

    def measure(self, timestep: float) -> int:
        """Simulate with a timestep [s] and return the outcome; at one that was not named, whether the run explodes."""
        setting = Setting(self._plan.rolling, self._plan.integrator, timestep)
        try:
            run = integrate(self._scene, _START, 0.0, setting, _samples(timestep))
        except REFUSALS:
            return EXPLODED
        most = self._kinetic + 2 * self._scene.oscillator.depth
        if not float(kinetic_energy(self._scene, run).max()) <= _GAIN * most:
            return EXPLODED
        at, radius = np.searchsorted(self._exact.time, run.time), self._scene.can.radius
        at = np.minimum(at, len(self._exact.time) - 1)
        start = _START, self._scene.start(_START, 0.0)[0] / radius
        right = Angles(self._exact.phi[at], self._exact.u[at] / radius, start)
        return ACCURATE if right.off(run.phi, run.u / radius) <= ERROR else INACCURATE

    def predict(self, timestep: float) -> int:
        """Return EXPLODED if theory lets a small disturbance grow by `GROWTH` in a run with a timestep [s], or BOUNDED.

        In each part of the run the matrix of a step is that of small motions about the load's angle then, and a
        disturbance grows with its spectral radius. It may begin and end with any part.
        """
        integrator = self._plan.integrator
        row = spring(stiffest(integrator, timestep, self._plan.rolling == "contact"), 1.0, MAX_IMPEDANCE)
        steps, growth, largest = _DURATION / _PARTS / timestep, 0.0, 0.0
        for system in self._systems:
            radius = linear_stability.spectral_radius(system.step(integrator, row, timestep))
            growth = max(0.0, growth + steps * math.log(radius))
            largest = max(largest, growth)
        return EXPLODED if largest > math.log(GROWTH) else BOUNDED

    def _linearized(self) -> list[soft_rolling.System]:
        """Return the linear equations of small motions about the load's angle in the middle of each part of a run."""
        rolling, scene = self._plan.rolling, self._scene
        middles = (np.arange(_PARTS) + 0.5) * _DURATION / _PARTS
        angles = exact(scene, middles, _START).phi.tolist()
        if rolling == "reduced":
            return [soft_rolling.by_coordinates(scene, angle) for angle in angles]
        if rolling == "equality":
            return [soft_rolling.by_equality(scene, excess=0.0, angle=angle) for angle in angles]
        impratio = float(build(scene, rolling).opt.impratio)
        return [soft_rolling.by_contact(scene, 0.0, _POINTS, impratio, angle) for angle in angles]


def _samples(timestep: float) -> np.ndarray:
    """Return the times of the samples of a damped run [s], which are multiples of its timestep."""
    return timestep * np.unique(np.rint(np.linspace(0, _DURATION, _SAMPLES + 1) / timestep))
