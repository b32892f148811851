"""Short runs of a can frozen to its load on the level, at any timestep and stiffness, and what linear theory says.

Both are judged by one rule, from the same small start: a motion that leaves `GROWTH` times its start is unstable, one
that is off by `ACCURACY` in the first half period is inaccurate.
"""

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model.build import build
from mjbeer.model.setting import DOP853, Softness
from mjbeer.model.state import places, settle
from mjbeer.predictions import linear_stability, soft_constraint, soft_rolling
from mjbeer.predictions.linear_stability import ACCURACY, GROWTH
from mjbeer.predictions.soft_constraint import SoftRow, diagonal_excess
from mjbeer.simulation import dop853, stepping
from mjbeer.theory.scene import Scene, frozen

FREE = ("gravity", "spring")
"""Families without a constraint."""
UNSTABLE, INACCURATE, ACCURATE = 0, 1, 2
"""What a run is."""
IMPEDANCE = 0.9
"""solimp's dmin and dmax of the rows: MuJoCo's default dmin."""
_SWING = 1e-4
"""Angle from which the can is let go [rad]."""
_SEED = 1e-7
"""Initial violation of the constraint, relative to `_SWING` (or to half the contact's depth). It must be tiny: a stiff
constraint corrects it within one time constant, and 1e-4 would already disturb the swing by 1 % at tau = 1 ms."""
_STEPS = 1000
"""Least number of steps of a run: in that time an instability of 2 % a step outgrows any seed."""
_LEVEL = frozen(incline=0.0)


@dataclass(frozen=True)
class Plan:
    """What is run, but for timestep and stiffness."""

    family: str
    """"equality" or "contact" with a solref of time constants, "direct" (an equality with a direct solref), or
    "gravity" (no constraint), or "spring" (the same, with a joint's spring of its frequency instead of gravity)."""
    integrator: str
    refsafe: bool = False
    dampratio: float = 1.0
    written: str = "exact"
    """An equality with its "exact" diagonal, or with MuJoCo's default one and the "slide" or the "hinge" first."""

    @property
    def name(self) -> str:
        """Unique among the plans."""
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
        # With the hinge first the row is divided by the radius, but not what MuJoCo takes for its diagonal.
        self._excess = {"exact": 1.0, "slide": excess, "hinge": excess * self._scene.can.radius**2}[plan.written]
        self._points = _touching(self._model)
        self._frequency = self._scene.frequency()

    def measure(self, timestep: float) -> int:
        """Return what MuJoCo's run with a timestep [s] is: UNSTABLE, INACCURATE or ACCURATE."""
        rest, start = self._ready(timestep)
        samples = np.arange(self._steps(timestep) + 1)
        try:
            if self._plan.integrator == DOP853:
                states = dop853.integrate(self._model, rest + start, samples * timestep, timestep)
            else:
                states = stepping.step(self._model, (rest + start)[None], samples)[0]
        except DivergenceError:
            return UNSTABLE
        return self._judge(states - rest, rest, start, timestep)

    def predict(self, timestep: float) -> int:
        """Return the same by linear theory: the start is multiplied by the matrix of a step again and again."""
        rest, start = self._ready(timestep)
        unit = np.repeat([1.0, timestep], len(start) // 2)
        states = linear_stability.motion(self._step(rest, timestep), start * unit, self._steps(timestep))
        with np.errstate(over="ignore"):
            return self._judge(states / unit, rest, start, timestep)

    def _step(self, rest: np.ndarray, timestep: float) -> np.ndarray:
        plan, joints = self._plan, places(self._model)
        if plan.family in FREE:
            spring = SoftRow(self._frequency**2, 0.0, 1.0)
            if plan.family == "spring" and plan.integrator == "discrete":  # implicit in it, as in a row
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
        return max(_STEPS, math.ceil(self._half(timestep)))

    def _half(self, timestep: float) -> float:
        """Timesteps in half a period."""
        return math.pi / (self._frequency * timestep)

    def _ready(self, timestep: float) -> tuple[np.ndarray, np.ndarray]:
        """The state at rest, at the depth at which a contact carries the can, and how far from it a run starts."""
        model = self._model
        model.opt.timestep = timestep
        rest = settle(model, np.zeros(model.nq + model.nv))
        start = np.zeros_like(rest)
        for name, at in places(model).items():
            turn = self._scene.can.radius * (1 + _SEED) if name == "slide" else 1.0
            start[at] = _SEED / 2 * rest[at] if name == "lift" else _SWING * turn
        return rest, start

    def _judge(self, states: np.ndarray, rest: np.ndarray, start: np.ndarray, timestep: float) -> int:
        """The verdict on states relative to the rest. A contact must not lose half of its depth."""
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
        off = np.hypot(phi - np.cos(angles), rate + np.sin(angles))
        return ACCURATE if off.max() < ACCURACY else INACCURATE


def _model(plan: Plan, scene: Scene, value: float) -> mujoco.MjModel:
    if plan.family in FREE:
        model = build(scene, "reduced", integrator=plan.integrator)
        if plan.family == "spring":
            _hang(model, scene)
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


def _hang(model: mujoco.MjModel, scene: Scene) -> None:
    """Replace gravity by a spring on the joint phi that gives a small swing the same frequency."""
    data, mass = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, mass)
    at = int(model.joint("phi").dofadr[0])
    model.joint("phi").stiffness[0] = scene.frequency() ** 2 * mass[at, at]
    model.opt.gravity[:] = 0.0
    model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_SPRING)


def _touching(model: mujoco.MjModel) -> int:
    """In how many points a can at rest touches the incline."""
    data = mujoco.MjData(model)
    data.qpos[:] = settle(model, np.zeros(model.nq + model.nv))[: model.nq]
    mujoco.mj_forward(model, data)
    return int(data.ncon)


def _row(plan: Plan, value: float, timestep: float) -> SoftRow:
    """The row as MuJoCo has it, after refsafe."""
    if plan.family == "direct":
        return soft_constraint.direct(value, 2 * plan.dampratio * math.sqrt(value), IMPEDANCE)
    timeconst = value
    if plan.refsafe and plan.integrator != "discrete":
        timeconst = soft_constraint.refsafe_timeconst(value, timestep)
    elif plan.refsafe and plan.family == "contact":
        timeconst = soft_constraint.discrete_refsafe_timeconst(value, plan.dampratio, IMPEDANCE, timestep)
    return soft_constraint.spring(timeconst, plan.dampratio, IMPEDANCE)
