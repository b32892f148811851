"""A setting made ready to be run and timed: everything but the loop is done beforehand."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.model import state
from mjbeer.model.build import build
from mjbeer.model.setting import DOP853
from mjbeer.model.softness import softness
from mjbeer.model.usual import USUAL, build_usual
from mjbeer.simulation import tolerance
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.stepping import Stepper
from mjbeer.studies.benchmark.curves import TOLERANCE, Curve
from mjbeer.studies.benchmark.peers.peer import Peer
from mjbeer.studies.benchmark.points import Point
from mjbeer.studies.cases import Case
from mjbeer.theory.measure import distance
from mjbeer.theory.trajectory import Trajectory

_FINE = 1e-13
"""Local tolerance of the run that tells a model's error from its integrator's."""
_PATIENCE = 50_000
"""Most evaluations of that run."""
_SAMPLING = 1e-3
"""What a constraint is tuned to where the steps are DOP853's own [s]."""


@dataclass(frozen=True)
class Prepared:
    """A run, and what it runs: a model with its start, or None for a peer, whose run gives phi and u at once."""

    run: Callable[[], np.ndarray] | Callable[[], tuple[np.ndarray, np.ndarray]]
    setup: float
    model: mujoco.MjModel | None = None
    start: np.ndarray | None = None


def prepare(case: Case, curve: Curve, value: float, peers: dict[str, Peer]) -> Prepared:
    """Set up the run of a case with one setting.

    Raises:
      UnsupportedError: if there is no such model.
    """
    begin = time.perf_counter()
    if curve.way in peers:
        motion = peers[curve.way].prepare(case.scene, case.phi0, 0.0, case.times, value)
        return Prepared(motion, time.perf_counter() - begin)
    scene, times = case.scene, case.times
    timestep = tolerance.tuning(scene, curve.way, _SAMPLING) if curve.knob == TOLERANCE else value
    if curve.way in USUAL:
        model = build_usual(scene, curve.way, curve.method, timestep)
    else:
        model = build(scene, curve.way, integrator=curve.method, timestep=timestep)
    start = state.start(model, scene, case.phi0, 0.0)
    if curve.method != DOP853:
        stepper, steps = Stepper(model), np.rint(times / timestep).astype(int)
        run = lambda: stepper.run(start[None], steps)[0]  # noqa: E731
    elif curve.knob == TOLERANCE:
        solver = tolerance.Solver(model, scene)
        run = lambda: solver.run(start, times, value).states  # noqa: E731
    else:
        integrator = Integrator(model)
        run = lambda: integrator.run(start, times, timestep)  # noqa: E731
    return Prepared(run, time.perf_counter() - begin, model, start)


def measure(case: Case, prepared: Prepared, point: Point, truth: Trajectory) -> None:
    """Run once, and fill in everything but the run times.

    Raises:
      DivergenceError, ToleranceError: if the run fails.
    """
    point.setup = prepared.setup
    result = prepared.run()
    if prepared.model is None or prepared.start is None:
        point.judge(*result, truth)
        return
    moved = state.read(prepared.model, case.scene, np.asarray(result))
    run = Trajectory(case.scene, point.way, point.method, None, case.times, **vars(moved))
    point.judge(run.phi, run.u, truth)
    point.listen(run)
    _split(case, prepared, point, run, truth)
    soft = softness(prepared.model, prepared.start)
    if soft:
        point.timeconst, point.effective_timeconst = soft.timeconst, soft.effective_timeconst
        point.impedance, point.effective_impedance = soft.impedance, soft.effective_impedance


def _split(case: Case, prepared: Prepared, point: Point, run: Trajectory, truth: Trajectory) -> None:
    """The model's own error and the integrator's, by a run of the same model that has hardly any of the latter."""
    assert prepared.model is not None
    assert prepared.start is not None
    scale = tolerance.scales(prepared.model, case.scene)
    integrator = Integrator(prepared.model)
    try:
        fine = integrator.run(prepared.start, case.times, tolerance=_FINE, scale=scale, limit=_PATIENCE)
    except DivergenceError:
        return  # a model that is too stiff, or not smooth: no telling
    moved, radius = state.read(prepared.model, case.scene, fine), case.scene.can.radius
    point.model_error = distance(moved.phi, moved.u, truth.phi, truth.u, radius)
    point.integrator_error = distance(run.phi, run.u, moved.phi, moved.u, radius)
