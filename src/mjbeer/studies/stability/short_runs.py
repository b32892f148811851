"""Short runs of a can with frozen beer on level ground, at any timestep and stiffness, measured and by linear theory.

Both motions begin with the same small swing and are judged by the same rule: a motion that grows beyond `GROWTH` times
its start is unstable, one whose error exceeds `ACCURACY` in the first half period is inaccurate.
"""

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model.build import build
from mjbeer.model.setting import DOP853, Integrator, Softness
from mjbeer.model.state import places
from mjbeer.predictions import linear_stability, soft_constraint, soft_rolling
from mjbeer.predictions.linear_stability import ACCURACY, GROWTH
from mjbeer.predictions.soft_constraint import SoftRow
from mjbeer.predictions.soft_rolling import diagonal_excess
from mjbeer.simulation import dop853
from mjbeer.simulation.stepping import Stepper
from mjbeer.studies.stability.small_swings import settle
from mjbeer.theory.named import frozen
from mjbeer.theory.scene import Scene

FREE = ("gravity", "spring")
"""Families without a constraint."""
UNSTABLE, INACCURATE, ACCURATE = 0, 1, 2
"""Outcomes of a run, as numbers for the cells of a map."""
IMPEDANCE = 0.9
"""dmin and dmax in the solimp of the constraints: both are MuJoCo's default dmin."""
_SWING = 1e-4
"""Angle from which the can is let go [rad]."""
_SEED = 1e-7
"""Initial violation of the constraint, relative to `_SWING` (or to half the contact's depth). It must be tiny: a stiff
constraint corrects it within one time constant, and 1e-4 would already disturb the swing by 1 % at tau = 1 ms."""
_STEPS = 1000
"""Least number of steps of a run: within it, a growth of 2 % a step makes any initial violation visible."""
_LEVEL = frozen(incline=0.0)


@dataclass(frozen=True)
class Plan:
    """Everything that defines a run except timestep and stiffness."""

    family: str
    """What makes the motion stiff: a constraint ("equality" or "contact") whose solref has a time constant, an equality
    with a direct solref ("direct"), or, without a constraint, "gravity" or a joint's "spring" of the same frequency."""
    integrator: Integrator
    refsafe: bool = False
    dampratio: float = 1.0
    written: str = "exact"
    """Whether an equality has its "exact" diagonal, or MuJoCo's default one with the "slide" or the "hinge" first."""

    @property
    def name(self) -> str:
        """Name that is unique among the plans."""
        parts = [self.family, self.integrator]
        parts += ["refsafe"] if self.refsafe else []
        parts += [f"damping ratio {self.dampratio:g}"] if self.dampratio != 1 else []
        parts += [f"{self.written} first"] if self.written != "exact" else []
        return ", ".join(parts)


class ShortRuns:
    """Runs of one plan and one stiffness: a time constant [s], a direct stiffness [1/s^2] or a gravity [m/s^2]."""

    def __init__(self, plan: Plan, value: float) -> None:
        self._plan, self._value = plan, value
        self._scene = frozen(incline=0.0, gravity=value) if plan.family in FREE else _LEVEL
        self._model = _model(plan, self._scene, value)
        excess = diagonal_excess(self._scene)
        # With the hinge first the row is divided by the radius, but MuJoCo's estimate of its diagonal is not.
        self._excess = {"exact": 1.0, "slide": excess, "hinge": excess * self._scene.can.radius**2}[plan.written]
        self._points = _contact_points(self._model)
        self._frequency = self._scene.frequency()

    def measure(self, timestep: float) -> int:
        """Simulate with a timestep [s] and return the outcome: UNSTABLE, INACCURATE or ACCURATE."""
        rest, start = self._rest_and_start(timestep)
        samples = np.arange(self._steps(timestep) + 1)
        try:
            if self._plan.integrator == DOP853:
                states = dop853.Integrator(self._model).run(rest + start, samples * timestep, timestep)
            else:
                states = Stepper(self._model).run(rest + start, samples)
        except DivergenceError:
            return UNSTABLE
        return self._judge(states - rest, rest, start, timestep)

    def predict(self, timestep: float) -> int:
        """Return the outcome by linear theory, which multiplies the start by the matrix of one step again and again."""
        rest, start = self._rest_and_start(timestep)
        unit = np.repeat([1.0, timestep], len(start) // 2)
        states = linear_stability.motion(self._step(rest, timestep), start * unit, self._steps(timestep))
        with np.errstate(over="ignore"):
            return self._judge(states / unit, rest, start, timestep)

    def _step(self, rest: np.ndarray, timestep: float) -> np.ndarray:
        """Return the matrix of one step by linear theory."""
        plan, joints = self._plan, places(self._model)
        if plan.family in FREE:
            spring = SoftRow(self._frequency**2, 0.0, 1.0)
            if plan.family == "spring" and plan.integrator == "discrete":  # takes springs implicitly, like constraints
                spring = spring.at_end_of_step(timestep)
            return linear_stability.amplification(
                plan.integrator, spring.stiffness * timestep**2, spring.damping * timestep
            )
        if plan.family == "contact":
            system = soft_rolling.by_contact(
                self._scene, -rest[joints["lift"]], self._points, float(self._model.opt.impratio)
            )
        else:
            system = soft_rolling.by_equality(self._scene, self._excess)
        return system.step(plan.integrator, _row(plan, self._value, timestep), timestep)

    def _steps(self, timestep: float) -> int:
        """Return the number of steps of a run: half a period, or `_STEPS` if that is more."""
        return max(_STEPS, math.ceil(self._half(timestep)))

    def _half(self, timestep: float) -> float:
        """Return how many timesteps half a period has."""
        return math.pi / (self._frequency * timestep)

    def _rest_and_start(self, timestep: float) -> tuple[np.ndarray, np.ndarray]:
        """Set the timestep; return the state at rest, carried by a contact if any, and how far from it a run starts."""
        model = self._model
        model.opt.timestep = timestep
        rest = settle(model, np.zeros(model.nq + model.nv))
        start = np.zeros_like(rest)
        for name, at in places(model).items():
            turn = self._scene.can.radius * (1 + _SEED) if name == "slide" else 1.0
            start[at] = _SEED / 2 * rest[at] if name == "lift" else _SWING * turn
        return rest, start

    def _judge(self, states: np.ndarray, rest: np.ndarray, start: np.ndarray, timestep: float) -> int:
        """Return the outcome of states relative to the rest; a can in contact must stay within half of its depth."""
        model, joints = self._model, places(self._model)
        bounds = GROWTH * start[: model.nq]
        if "lift" in joints:
            bounds[joints["lift"]] = abs(rest[joints["lift"]]) / 2
        with np.errstate(invalid="ignore"):
            if not (np.abs(states[:, : model.nq]) < bounds).all():
                return UNSTABLE
        at = joints.get("phi", joints.get("roll"))
        early = states[: max(1, math.floor(self._half(timestep))) + 1]
        angles = self._frequency * timestep * np.arange(len(early))
        phi, rate = early[:, at] / _SWING, early[:, model.nq + at] / (_SWING * self._frequency)
        errors = np.hypot(phi - np.cos(angles), rate + np.sin(angles))
        return ACCURATE if errors.max() < ACCURACY else INACCURATE


def _model(plan: Plan, scene: Scene, value: float) -> mujoco.MjModel:
    """Return the model of a plan at one stiffness, as `ShortRuns` takes it."""
    if plan.family in FREE:
        model = build(scene, "reduced", integrator=plan.integrator)
        if plan.family == "spring":
            _replace_gravity_by_spring(model, scene)
        return model
    damping = 2 * plan.dampratio * math.sqrt(value)
    softness = Softness(
        solref=(-value, -damping) if plan.family == "direct" else (value, plan.dampratio),
        impedance=(IMPEDANCE, IMPEDANCE),
        refsafe=plan.refsafe,
        exact_diagonal=plan.written == "exact",
        first="hinge" if plan.written == "hinge" else "slide",
    )
    rolling = "contact" if plan.family == "contact" else "equality"
    return build(scene, rolling, integrator=plan.integrator, softness=softness)


def _replace_gravity_by_spring(model: mujoco.MjModel, scene: Scene) -> None:
    """Replace gravity by a spring on the joint phi with which a small swing has the same frequency."""
    data, mass = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, mass)
    at = int(model.joint("phi").dofadr[0])
    model.joint("phi").stiffness[0] = scene.frequency() ** 2 * mass[at, at]
    model.opt.gravity[:] = 0.0
    model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_SPRING)


def _contact_points(model: mujoco.MjModel) -> int:
    """Return the number of points at which a can at rest touches the ground."""
    data = mujoco.MjData(model)
    data.qpos[:] = settle(model, np.zeros(model.nq + model.nv))[: model.nq]
    mujoco.mj_forward(model, data)
    return int(data.ncon)


def _row(plan: Plan, value: float, timestep: float) -> SoftRow:
    """Return the constraint's row as MuJoCo uses it, which refsafe may have softened."""
    if plan.family == "direct":
        return soft_constraint.direct(value, 2 * plan.dampratio * math.sqrt(value), IMPEDANCE)
    timeconst = value
    if plan.refsafe and plan.integrator != "discrete":
        timeconst = soft_constraint.refsafe_timeconst(value, timestep)
    elif plan.refsafe and plan.family == "contact":
        timeconst = soft_constraint.discrete_refsafe_timeconst(value, plan.dampratio, IMPEDANCE, timestep)
    return soft_constraint.spring(timeconst, plan.dampratio, IMPEDANCE)
