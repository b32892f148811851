"""One setting measured: its errors against exact theory, of the model and of the integrator, and its run time."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

from mjbeer.exceptions import DivergenceError
from mjbeer.model.softness import softness
from mjbeer.simulation.dop853 import Integrator
from mjbeer.simulation.prepare import Prepared
from mjbeer.simulation.tolerance import Solution, scales
from mjbeer.studies.benchmark.peers.peer import Motion, Peer
from mjbeer.studies.benchmark.points import Point
from mjbeer.studies.cases import Case
from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.measure import distance
from mjbeer.theory.trajectory import Trajectory

_FINE = 1e-13
"""Local tolerance of the run that tells a model's error from its integrator's."""
_PATIENCE = 50_000
"""Most evaluations of that run."""
_SHORT = 0.05
"""Runs under this [s] are repeated once, untimed, before they are timed: caches and branch predictors warm."""


@dataclass(eq=False)
class Rung:
    """A point of the study, and what runs it: set up once, run often."""

    case: Case
    point: Point
    peer: Peer | None
    """The other tool whose point it is; None for mjbeer's own models."""

    @cached_property
    def prepared(self) -> Prepared:
        """The scene in the setting of the point, for mjbeer's own models."""
        return Prepared(self.case.scene, self.point.curve.setting(self.point.value))

    @cached_property
    def run(self) -> Callable[[], Solution] | Callable[[], Motion]:
        """A function that integrates the motion from its start at every call: all that is timed."""
        case = self.case
        if self.peer is not None:
            return self.peer.prepare(case.scene, case.phi0, 0.0, case.times, self.point.value)
        return partial(self.prepared.solve, self.prepared.start(case.phi0, 0.0), case.times)

    def measure(self, truth: Trajectory) -> None:
        """Run once, and fill in everything of the point but its run times.

        Raises:
          UnsupportedError: if there is no such model.
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
        self.point.describe(Trajectory(**vars(motion), scene=self.case.scene))
        self._split_error(motion, truth)
        soft = softness(self.prepared.model, self.prepared.start(self.case.phi0, 0.0))
        if soft:
            self.point.timeconst, self.point.effective_timeconst = soft.timeconst, soft.effective_timeconst
            self.point.impedance, self.point.effective_impedance = soft.impedance, soft.effective_impedance

    def seconds(self) -> float:
        """Run time [s] of one warm run."""
        taken = 0.0
        for _ in range(2):
            begin = time.perf_counter()
            self.run()
            taken = time.perf_counter() - begin
            if taken > _SHORT:
                break
        return taken

    def _split_error(self, motion: Coordinates, truth: Trajectory) -> None:
        """Find the model's own error and the integrator's, by a run of the same model with hardly any of the latter.

        A model that is too stiff for that run, or not smooth, is left without.
        """
        prepared, case = self.prepared, self.case
        start, scale = prepared.start(case.phi0, 0.0), scales(prepared.model, case.scene)
        try:
            states = Integrator(prepared.model).run(start, case.times, tolerance=_FINE, scale=scale, limit=_PATIENCE)
        except DivergenceError:
            return
        fine, radius = prepared.coordinates(states, case.times), case.scene.can.radius
        self.point.model_error = distance(fine, truth, radius, relative=False)
        self.point.integrator_error = distance(motion, fine, radius, relative=False)
