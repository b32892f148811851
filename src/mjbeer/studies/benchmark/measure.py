"""Measure one setting: its error against exact theory, the shares of model and integrator in it, and its run time."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model.engine import quiet
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.run import Prepared
from mjbeer.simulation.stepping import Solution
from mjbeer.simulation.tolerance import scales
from mjbeer.studies.benchmark.peers.peer import Motion, Peer
from mjbeer.studies.benchmark.points import Point
from mjbeer.studies.cases import Case
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.trajectory import Trajectory, distance

_FINE = 1e-13
"""Local tolerance of the run that separates a model's error from its integrator's."""
_MOST_EVALUATIONS = 50_000
"""Most evaluations of the accelerations in that run."""
_SHORT = 0.05
"""A run shorter than this [s] is timed twice and the first time dropped, so that caches and predictors are warm."""


@dataclass(eq=False)
class Rung:
    """A point of the benchmark with the function that runs it, which is set up once and run often."""

    case: Case
    point: Point
    peer: Peer | None
    """The other tool that the point is of; None for mjbeer's own models."""

    @cached_property
    def prepared(self) -> Prepared:
        """The scene in the setting of the point; only for mjbeer's own models."""
        return Prepared(self.case.scene, self.point.curve.setting(self.point.value))

    @cached_property
    def run(self) -> Callable[[], Solution] | Callable[[], Motion]:
        """A function that integrates the motion from its start at every call; only these calls are timed."""
        case = self.case
        if self.peer is not None:
            return self.peer.prepare(
                case.scene, phi0=case.phi0, phi_dot0=0.0, times=case.times, tolerance=self.point.value
            )
        return partial(self.prepared.solve, self.prepared.start(case.phi0, 0.0), case.times)

    def measure(self, truth: Trajectory) -> None:
        """Run once, and store everything in the point but its run times.

        Raises:
          UnsupportedError: if MuJoCo or the other tool has no model of the scene.
          DivergenceError, ToleranceError: if the run fails.
        """
        begin = time.perf_counter()
        run = self.run
        self.point.setup = time.perf_counter() - begin
        result = run()
        if not isinstance(result, Solution):
            self.point.judge(*result, truth)
            return
        motion = self.prepared.coordinates(result.states, self.case.times)
        self.point.judge(motion.phi, motion.u, truth)
        self.point.describe(Trajectory(**vars(motion), scene=self.case.scene, phi0=self.case.phi0, phi_dot0=0.0))
        self._split_error(motion, truth)
        soft = effective_softness(self.prepared.model, self.prepared.start(self.case.phi0, 0.0))
        if soft:
            self.point.timeconst, self.point.effective_timeconst = soft.timeconst, soft.effective_timeconst
            self.point.impedance, self.point.effective_impedance = soft.impedance, soft.effective_impedance

    def seconds(self) -> float:
        """Return the run time [s] of one run with warm caches."""
        duration = 0.0
        for _ in range(2):
            begin = time.perf_counter()
            self.run()
            duration = time.perf_counter() - begin
            if duration > _SHORT:
                break
        return duration

    def _split_error(self, motion: Coordinates, truth: Trajectory) -> None:
        """Store the errors of the model and of the integrator in the point.

        The same model is run once more with hardly any error of the integrator. A model that is too stiff or not
        smooth enough for that run gets neither of the two.
        """
        prepared, case = self.prepared, self.case
        start, scale = prepared.start(case.phi0, 0.0), scales(prepared.model, case.scene)
        try:
            states = Integrator(prepared.model).run(
                start, case.times, tolerance=_FINE, scale=scale, limit=_MOST_EVALUATIONS
            )
        except DivergenceError:
            return
        fine, radius = prepared.coordinates(states, case.times), case.scene.can.radius
        self.point.model_error = distance(fine, truth, radius)
        self.point.integrator_error = distance(motion, fine, radius)


@dataclass(frozen=True)
class EffectiveSoftness:
    """The softness of a constraint, as asked for and as the solver used it."""

    timeconst: float
    """Time constant that solref asks for [s]."""
    effective_timeconst: float
    """Time constant that the solver used [s]: `refsafe` raises one below two timesteps."""
    impedance: float
    """d of solimp: the share of its reference acceleration that a row with the exact diagonal would reach."""
    effective_impedance: float
    """The share that the row reached, with the regularizer that the solver used and the exact diagonal."""


def effective_softness(model: mujoco.MjModel, state: np.ndarray) -> EffectiveSoftness | None:
    """Return the softness of the rolling constraint at a `state`, shape (nq + nv,); None if no constraint is active.

    The time constant comes from the stiffness K = 1/(d tau)^2 (damping ratio 1) of MuJoCo's reference acceleration, and
    the impedance from the regularizer R and the diagonal A = J M^-1 J^T of the constraint's first row.
    """
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = state[: model.nq], state[model.nq :]
    with quiet():
        mujoco.mj_forward(model, data)
    if data.nefc == 0:
        return None
    solref, solimp = (model.eq_solref, model.eq_solimp) if model.neq else (model.pair_solref, model.pair_solimp)
    jacobian, mass = np.array(data.efc_J).reshape(-1, model.nv)[0], np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    diagonal = float(jacobian @ np.linalg.solve(mass, jacobian))
    return EffectiveSoftness(
        timeconst=float(solref[0, 0]),
        effective_timeconst=1 / (float(solimp[0, 1]) * float(data.efc_KBIP[0, 0]) ** 0.5),
        impedance=float(data.efc_KBIP[0, 2]),
        effective_impedance=diagonal / (diagonal + float(data.efc_R[0])),
    )
