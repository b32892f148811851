"""Run the benchmark: climb each ladder of settings for its errors, then time all settings in rounds."""

import gc
import math
import time
from collections.abc import Callable, Container, Sequence
from functools import partial

import mujoco
import numpy as np
from rich.console import Console

from mjbeer import require
from mjbeer.exceptions import DivergenceError, MjbeerError
from mjbeer.integrators.dop853 import Dop853
from mjbeer.integrators.gauss_jackson import GaussJackson
from mjbeer.model.build import specify
from mjbeer.model.joints import initial_state, to_coordinates
from mjbeer.model.setting import DOP853, GAUSS_JACKSON, INTEGRATORS, ROLLINGS, supported
from mjbeer.output.terminal import progress_bar
from mjbeer.simulation.fixed_step import states_after
from mjbeer.simulation.run import Simulator
from mjbeer.simulation.tolerance import even_at_most
from mjbeer.studies.benchmark import other_tools
from mjbeer.studies.benchmark.other_tools import OTHER_TOOLS, Motion
from mjbeer.studies.benchmark.points import (
    CASES,
    CHOSEN,
    INTERVAL,
    TOLERANCE,
    USUAL,
    Benchmark,
    Case,
    Curve,
    Point,
)
from mjbeer.studies.study import machine
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

REPEATS = 5
"""Timed rounds. Each round times every setting once, so that a slow minute of the machine hits all settings alike."""
_ENOUGH = 5
"""Fewest rungs of a ladder that ends at its floor."""
_FLAT = 0.5
"""A rung is at the floor if no later rung has less than this share of its error."""
_NO_FLOOR = 1e-2
"""Errors above this [rad] are not taken for a floor: on a motion that far off, rungs may agree by chance."""
_SHORT = 0.05
"""A run shorter than this [s] is timed twice and the first time dropped, so that caches and predictors are warm."""


def conduct(names: Sequence[str], quick: bool, console: Console | None) -> Benchmark:
    """Measure the cases of some names: first all errors, then all times, in rounds.

    A tool that cannot be imported takes no part; the settings of the study have its name and the reason.

    Raises:
      ParameterError: if a case does not exist.
    """
    cases = [CASES[require.choice("scene", name, CASES)] for name in names]
    missing, rungs = other_tools.absent(), list[Rung]()
    climbs = [(case, *each) for case in cases for each in ladders(case.scene, quick, missing).items()]
    study = Benchmark({"cases": list(names), "quick": quick, "repeats": REPEATS, "absent": missing}, machine(), [])
    with progress_bar(console, len(climbs) + REPEATS * len(cases)) as begin:
        for case, curve, values in climbs:
            begin(f"{case.name}: {curve.label}")
            climbed = climb(case, curve, values)
            study.points += [point for point, _ in climbed]
            rungs += [rung for _, rung in climbed if rung is not None]
        for repeat in range(REPEATS):
            for case in cases:
                begin(f"{case.name}: round {repeat + 1}")
                _time([rung for rung in rungs if rung.point.case == case.name])
    return study


def usual_model(name: str, scene: Scene) -> mujoco.MjModel:
    """Return a model as people usually write it, with MuJoCo's defaults wherever there are any."""
    spec, stock = specify(scene, USUAL[name], integrator="Euler", timestep=2e-3), mujoco.MjSpec().option
    spec.option.enableflags, spec.option.impratio, spec.option.cone = stock.enableflags, stock.impratio, stock.cone
    spec.option.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    for constraint in (*spec.equalities, *spec.pairs):
        constraint.solref, constraint.solimp = (0.02, 1), (0.9, 0.95, 0.001, 0.5, 2)
    if name == "equality, hinge first":
        for equality in spec.equalities:
            equality.name1, equality.name2, equality.data[1] = equality.name2, equality.name1, 1 / scene.can.radius
    return spec.compile()


def ladders(scene: Scene, quick: bool = False, missing: Container[str] = ()) -> dict[Curve, tuple[float, ...]]:
    """Return the curves of a scene, each with its timesteps [s] or tolerances [rad], coarsest first.

    MuJoCo's integrators halve their timestep from one rung to the next; DOP853 starts with a larger one and halves it
    in two rungs, and GaussJackson, whose error falls by four decades in a halving, halves it in four. With `quick`, the
    ladders of MuJoCo's integrators end earlier, and all others have at most every second rung. Tools whose names are
    among the `missing` have no curve.
    """
    every = 2 if quick else 1
    steps = tuple(16e-3 / 2**k for k in range(6 if quick else 10))
    large = tuple(128e-3 / 2 ** (k / 2) for k in range(0, 15, every))
    found: dict[Curve, tuple[float, ...]] = {}
    for way in (way for way in ROLLINGS if supported(scene, way)):
        found |= {Curve(way, integrator): steps for integrator in INTEGRATORS}
        found[Curve(way, DOP853)] = large
        found[Curve(way, CHOSEN, TOLERANCE)] = tuple(10.0**-k for k in range(3, 13, 3 if quick else 1))
    found[Curve("reduced", GAUSS_JACKSON)] = tuple(32e-3 / 2 ** (k / 4) for k in range(0, 29, every))
    found |= {Curve(name, "Euler"): (2e-3,) for name, rolling in USUAL.items() if supported(scene, rolling)}
    others = (tool for tool in OTHER_TOOLS.values() if tool.name not in missing)
    return found | {Curve(tool.name, "", TOLERANCE): tool.tolerances[::every] for tool in others}


class Rung:
    """A point of a case, set up once and run often."""

    def __init__(self, case: Case, point: Point) -> None:
        self.point, value = point, point.value
        if point.model in OTHER_TOOLS:
            self.run = OTHER_TOOLS[point.model].set_up(case.scene, case.phi0, 0.0, case.times, value)
            return
        if point.model in USUAL:
            model = usual_model(point.model, case.scene)
            data, steps = mujoco.MjData(model), np.rint(case.times / value).astype(np.int64)
            begin = initial_state(model, case.scene, case.phi0, 0.0)
            solve = lambda: states_after(model, data, begin, steps)  # noqa: E731
        else:
            simulator = Simulator(case.scene, point.curve.setting(value))
            model, begin = simulator.model, simulator.initial_state(case.phi0, 0.0)
            solve = lambda: simulator.solve(begin, case.times).states  # noqa: E731
        self.solve = solve

        def run() -> Motion:
            motion = to_coordinates(model, case.scene, solve(), case.times)
            return motion.phi, motion.u, None

        self.run: Callable[[], Motion] = run
        self._count = partial(_evaluations, point, case, model, begin)

    def measure(self, truth: Trajectory) -> None:
        """Run once, and store errors against the exact motion in the point, and the number of evaluations.

        Raises:
          DivergenceError: if the run fails, or its end is not finite.
        """
        (phi, u, evaluations), point = self.run(), self.point
        if not (math.isfinite(phi[-1]) and math.isfinite(u[-1])):  # a value that is not finite stays so
            raise DivergenceError(f"{point.curve.label}: the motion did not stay finite")
        point.phi_max = float(np.abs(phi - truth.phi).max())
        point.u_max = float(np.abs(u - truth.u).max()) / truth.scene.can.radius
        point.evaluations = evaluations if point.model in OTHER_TOOLS else self._count()

    def seconds(self) -> float:
        """Return the run time [s] of one run with warm caches."""
        duration, run = 0.0, getattr(self, "solve", self.run)
        for _ in range(2):
            begin = time.perf_counter()
            run()
            duration = time.perf_counter() - begin
            if duration > _SHORT:
                break
        return duration


def _evaluations(point: Point, case: Case, model: mujoco.MjModel, begin: np.ndarray) -> int | None:
    """Return how often a run evaluates accelerations; None where a tolerance chooses the steps."""
    if point.parameter == TOLERANCE:
        return None
    if point.method in INTEGRATORS:
        return round(float(case.times[-1]) / point.value) * (4 if point.method == "RK4" else 1)
    method: Dop853 | GaussJackson
    if point.method == DOP853:
        method = Dop853(model)
        method.run(begin, case.times, point.value)
    else:
        method = GaussJackson(model)
        method.run(begin, case.times, point.value, even_at_most(case.scene))
    return method.evaluations


def climb(case: Case, curve: Curve, values: Sequence[float]) -> list[tuple[Point, Rung | None]]:
    """Measure the rungs of a ladder, down to its floor or to its second failure after a rung that ran.

    Return the points, each with what runs it again, or None if it failed.
    """
    truth, failures = case.truth(), 0
    climbed: list[tuple[Point, Rung | None]] = []
    for value in values:
        point, rung = Point(case.name, curve.model, curve.method, curve.parameter, value), None
        try:
            begin = time.perf_counter()
            rung = Rung(case, point)
            point.setup = time.perf_counter() - begin
            rung.measure(truth)
        except MjbeerError as error:
            point.failure, rung = str(error), None
            failures += any(other for _, other in climbed)
        climbed.append((point, rung))
        # Not for tolerances: the error may stay the same over some decades where the timesteps are finer than needed.
        if failures > 1 or (curve.parameter != TOLERANCE and _floored([each for each, _ in climbed])):
            break
    return climbed


def _time(rungs: Sequence[Rung]) -> None:
    """Time each rung once, one after the other."""
    gc.collect()
    gc.disable()
    try:
        for rung in rungs:
            rung.point.times.append(round(rung.seconds(), 9))
    finally:
        gc.enable()


def _floored(points: Sequence[Point]) -> bool:
    """Return whether the errors stopped falling: no later rung has less than half the error of some rung.

    Rungs whose samples are interpolated would hide that.
    """
    exact = [point for point in points if point.failure is None and np.frexp(point.value / INTERVAL)[0] == 0.5]
    errors = [point.error for point in exact if 0 < point.error < math.inf]
    rungs = enumerate(errors[:-2] if len(exact) >= _ENOUGH else [])
    return any(min(errors[place:]) >= _FLAT * error and error < _NO_FLOOR for place, error in rungs)
