"""Short runs of stiff models at any timestep: how they end, measured and by linear theory.

A can with frozen beer on level ground is the stiffer, the harder its constraint, or the stronger gravity. Beer that
slides in a can of sheet metal, let go at 1 rad on the paper's incline, is the stiffer, the stronger it is damped; all
ways of rolling can have it, and so are compared with the same motion.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model.build import build, specify
from mjbeer.model.engine import quiet
from mjbeer.model.numbers import stiffest
from mjbeer.model.setting import DOP853, Integrator, Rolling, Setting
from mjbeer.model.state import places
from mjbeer.predictions import linear_stability, soft_constraint, soft_rolling
from mjbeer.predictions.linear_stability import ACCURACY, GROWTH
from mjbeer.predictions.soft_constraint import MAX_IMPEDANCE, SoftRow, spring
from mjbeer.predictions.soft_rolling import System, diagonal_excess
from mjbeer.simulation import dop853
from mjbeer.simulation.run import Run, integrate
from mjbeer.simulation.stepping import Stepper
from mjbeer.studies.stability.judge import REFUSALS, Angles, explodes
from mjbeer.theory.can import Can
from mjbeer.theory.equations import kinetic_energy
from mjbeer.theory.exact import exact
from mjbeer.theory.named import frozen, sliding
from mjbeer.theory.record import ERROR
from mjbeer.theory.scene import Scene

FREE = ("gravity", "spring")
"""Families without a constraint."""
UNSTABLE, INACCURATE, ACCURATE = range(3)
"""Outcomes of a swing, as numbers for the cells of a map."""
EXPLODED, WRONG, WARNED, TRUSTED, SILENT = range(5)
"""Those of a damped run. It exploded, or was refused; its error is above `record.ERROR`, and it says so; it is
accurate, and warns nevertheless; it is accurate and trusted. The last must not occur: its error is above
`record.ERROR`, and it is trusted."""
BOUNDED = -1
"""What theory says of a damped run that does not explode: that it ends in one of the other ways."""
_IMPEDANCE = 0.9
"""dmin and dmax in the solimp of the constraints: both are MuJoCo's default dmin."""
_SWING = 1e-4
"""Angle from which the frozen can is let go [rad]."""
_SEED = 1e-7
"""Initial violation of the constraint, relative to `_SWING` (or to half the contact's depth). It must be tiny: a stiff
constraint corrects it within one time constant, and 1e-4 would already disturb the swing by 1 % at tau = 1 ms."""
_STEPS = 1000
"""Least number of steps of a swing: within it, a growth of 2 % a step makes any initial violation visible."""
_START = 1.0
"""phi at the start of a damped run [rad], where can and load are at rest."""
_DURATION = 1.024
"""Duration of a damped run [s], in which the load swings twice."""
_SAMPLES = 16
"""Samples of a damped run after its start. Its warnings rest on all of its steps."""
_PARTS = 8
"""Parts of a damped run in which theory takes the load's angle as constant."""
_POINTS = 2
"""Number of points at which the damped can in contact touches the ground."""


@dataclass(frozen=True)
class Plan:
    """Everything that defines a swing of the frozen can except timestep and stiffness."""

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
        parts = [self.family, self.integrator, "refsafe" if self.refsafe else ""]
        parts += [f"damping ratio {self.dampratio:g}" if self.dampratio != 1 else ""]
        parts += [f"{self.written} first" if self.written != "exact" else ""]
        return ", ".join(filter(None, parts))


class ShortRuns:
    """Swings with one plan and one stiffness: a time constant [s], a direct stiffness [1/s^2] or a gravity [m/s^2].

    Both motions, MuJoCo's and theory's, begin with the same small swing and are judged by the same rule: one that grows
    beyond `GROWTH` times its start is unstable, one whose error exceeds `ACCURACY` in the first half period inaccurate.
    """

    def __init__(self, plan: Plan, value: float) -> None:
        self._plan, self._value = plan, value
        self._scene = frozen(incline=0.0, gravity=value) if plan.family in FREE else frozen(incline=0.0)
        self._model = _model(plan, self._scene, value)
        excess = diagonal_excess(self._scene)
        # With the hinge first the row is divided by the radius, but MuJoCo's estimate of its diagonal is not.
        self._excess = {"exact": 1.0, "slide": excess, "hinge": excess * self._scene.can.radius**2}[plan.written]
        data = mujoco.MjData(self._model)
        data.qpos[:] = settle(self._model, np.zeros(self._model.nq + self._model.nv))[: self._model.nq]
        mujoco.mj_forward(self._model, data)
        self._points = int(data.ncon)  # at which a can at rest touches the ground
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

    def explodes(self, timestep: float) -> bool:
        """Simulate with a timestep [s], and return whether the run is unstable."""
        return self.measure(timestep) == UNSTABLE

    def _step(self, rest: np.ndarray, timestep: float) -> np.ndarray:
        """Return the matrix of one step by linear theory."""
        plan, scene = self._plan, self._scene
        if plan.family in FREE:
            row = SoftRow(self._frequency**2, 0.0, 1.0)
            if plan.family == "spring" and plan.integrator == "discrete":  # takes springs implicitly, like constraints
                row = row.at_end_of_step(timestep)
            return linear_stability.amplification(plan.integrator, row.stiffness * timestep**2, row.damping * timestep)
        if plan.family == "contact":
            depth, impratio = -rest[places(self._model)["lift"]], float(self._model.opt.impratio)
            system = soft_rolling.by_contact(scene, depth, self._points, impratio)
        else:
            system = soft_rolling.by_equality(scene, self._excess)
        return system.step(plan.integrator, self._row(timestep), timestep)

    def _row(self, timestep: float) -> SoftRow:
        """Return the constraint's row as MuJoCo uses it, which refsafe may have softened."""
        plan, timeconst = self._plan, self._value
        if plan.family == "direct":
            return soft_constraint.direct(timeconst, 2 * plan.dampratio * math.sqrt(timeconst), _IMPEDANCE)
        if plan.refsafe and plan.integrator != "discrete":
            timeconst = soft_constraint.refsafe_timeconst(timeconst, timestep)
        elif plan.refsafe and plan.family == "contact":
            timeconst = soft_constraint.discrete_refsafe_timeconst(timeconst, plan.dampratio, _IMPEDANCE, timestep)
        return soft_constraint.spring(timeconst, plan.dampratio, _IMPEDANCE)

    def _steps(self, timestep: float) -> int:
        """Return the number of steps of a run: half a period, or `_STEPS` if that is more."""
        return max(_STEPS, math.ceil(math.pi / (self._frequency * timestep)))

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
        count, joints = self._model.nq, places(self._model)
        bounds = GROWTH * start[:count]
        if "lift" in joints:
            bounds[joints["lift"]] = abs(rest[joints["lift"]]) / 2
        with np.errstate(invalid="ignore"):
            if not (np.abs(states[:, :count]) < bounds).all():
                return UNSTABLE
        at = joints.get("phi", joints.get("roll"))
        early = states[: max(1, math.floor(math.pi / (self._frequency * timestep))) + 1]
        angles = self._frequency * timestep * np.arange(len(early))
        phi, rate = early[:, at] / _SWING, early[:, count + at] / (_SWING * self._frequency)
        errors = np.hypot(phi - np.cos(angles), rate + np.sin(angles))
        return ACCURATE if errors.max() < ACCURACY else INACCURATE


def _model(plan: Plan, scene: Scene, value: float) -> mujoco.MjModel:
    """Return the model of a plan at one stiffness, as `ShortRuns` takes it."""
    if plan.family in FREE:
        model = build(scene, "reduced", integrator=plan.integrator)
        if plan.family == "spring":  # on the joint phi, in place of gravity and of the same frequency
            data, mass = mujoco.MjData(model), np.zeros((model.nv, model.nv))
            mujoco.mj_forward(model, data)
            mujoco.mj_fullM(model, data, mass)
            at = int(model.joint("phi").dofadr[0])
            model.joint("phi").stiffness[0] = scene.frequency() ** 2 * mass[at, at]
            model.opt.gravity[:] = 0.0
            model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_SPRING)
        return model
    damping = 2 * plan.dampratio * math.sqrt(value)
    spec = specify(scene, "contact" if plan.family == "contact" else "equality", integrator=plan.integrator)
    for constraint in (*spec.equalities, *spec.pairs):
        constraint.solref = (-value, -damping) if plan.family == "direct" else (value, plan.dampratio)
        constraint.solimp[:2] = _IMPEDANCE
    if plan.refsafe:
        spec.option.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    if plan.written != "exact":
        spec.option.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_DIAGEXACT)
    if plan.written == "hinge":
        for equality in spec.equalities:
            equality.name1, equality.name2, equality.data[1] = equality.name2, equality.name1, 1 / scene.can.radius
    return spec.compile()


@dataclass
class DampedRuns:
    """Runs with one way of rolling, one integrator and one damping [N m s], at any of some timesteps [s]."""

    rolling: Rolling
    integrator: Integrator
    damping: float
    timesteps: Sequence[float]
    error: float = field(default=math.inf, init=False)
    """Largest error of phi and u/a at the samples of the run measured last [rad], relative beyond 1 rad."""

    def __post_init__(self) -> None:
        self._scene = sliding(can=Can.sheet_metal(), damping=self.damping)
        every = np.unique(np.concatenate([_samples(timestep) for timestep in self.timesteps]))
        self._exact = exact(self._scene, every, _START)
        self._kinetic = float(kinetic_energy(self._scene, self._exact).max())
        self._systems = list(_systems(self.rolling, self._scene))

    def measure(self, timestep: float) -> int:
        """Simulate with one of the timesteps [s], and return the outcome."""
        run, self.error = self._simulate(timestep), math.inf
        if run is None:
            return EXPLODED
        at, radius = np.searchsorted(self._exact.time, run.time), self._scene.can.radius
        start = _START, self._scene.start(_START, 0.0)[0] / radius
        truth = Angles(self._exact.phi[at], self._exact.u[at] / radius, start)
        self.error = truth.off(run.phi, run.u / radius)
        if run.trusted:
            return TRUSTED if self.error <= ERROR else SILENT
        if explodes(run, self._kinetic):
            return EXPLODED
        return WARNED if self.error <= ERROR else WRONG

    def explodes(self, timestep: float) -> bool:
        """Simulate with any timestep [s], and return whether the run explodes."""
        run = self._simulate(timestep)
        return run is None or explodes(run, self._kinetic)

    def predict(self, timestep: float) -> int:
        """Return EXPLODED if theory lets a small disturbance grow by `GROWTH` in a run with a timestep [s], or BOUNDED.

        In each part of the run the matrix of a step is that of small motions about the load's angle then, and a
        disturbance grows with its spectral radius. It may begin and end with any part.
        """
        row = spring(stiffest(self.integrator, timestep, self.rolling == "contact"), 1.0, MAX_IMPEDANCE)
        steps, growth, largest = _DURATION / _PARTS / timestep, 0.0, 0.0
        for system in self._systems:
            radius = linear_stability.spectral_radius(system.step(self.integrator, row, timestep))
            growth = max(0.0, growth + steps * math.log(radius))
            largest = max(largest, growth)
        return EXPLODED if largest > math.log(GROWTH) else BOUNDED

    def _simulate(self, timestep: float) -> Run | None:
        """Return the run with a timestep [s]; None if it diverges or is refused."""
        setting = Setting(self.rolling, self.integrator, timestep)
        try:
            return integrate(self._scene, _START, 0.0, setting, _samples(timestep))
        except (DivergenceError, *REFUSALS):
            return None


def _samples(timestep: float) -> np.ndarray:
    """Return the times of the samples of a damped run [s], which are multiples of its timestep."""
    return timestep * np.unique(np.rint(np.linspace(0, _DURATION, _SAMPLES + 1) / timestep))


def _systems(rolling: Rolling, scene: Scene) -> Iterator[System]:
    """Yield the linear equations of small motions about the load's angle in the middle of each part of a run."""
    middles = (np.arange(_PARTS) + 0.5) * _DURATION / _PARTS
    impratio = float(build(scene, rolling).opt.impratio)
    for angle in exact(scene, middles, _START).phi.tolist():
        if rolling == "reduced":
            yield soft_rolling.by_coordinates(scene, angle)
        elif rolling == "equality":
            yield soft_rolling.by_equality(scene, excess=0.0, angle=angle)
        else:
            yield soft_rolling.by_contact(scene, 0.0, _POINTS, impratio, angle)


def settle(model: mujoco.MjModel, at: np.ndarray) -> np.ndarray:
    """Return a state, shape (nq + nv,), with the lift at which the can has no acceleration away from the incline.

    A model without a lift gets its state back. The contact force is linear in the depth, so that two trials give the
    wanted depth. From any other depth the can would fall or rise to it, unlike in the exact motion.
    """
    if "lift" not in (joints := places(model)):
        return at
    index = joints["lift"]
    data, balanced = mujoco.MjData(model), at.copy()

    def acceleration(lift: float) -> float:
        data.qpos[:], data.qvel[:] = at[: model.nq], at[model.nq :]
        data.qpos[index], data.qacc_warmstart[:] = lift, 0.0
        with quiet():
            mujoco.mj_forward(model, data)
        return float(data.qacc[index])

    trials = -1e-7, -2e-7
    first, second = (acceleration(lift) for lift in trials)
    balanced[index] = trials[0] - first * (trials[1] - trials[0]) / (second - first)
    return balanced
