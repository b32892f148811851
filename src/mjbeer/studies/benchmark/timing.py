"""Run the benchmark.

Each setting is run once for its error, then all settings in rounds for their times.
"""

import gc
import math
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import mujoco
import numpy as np
from rich.console import Console

from mjbeer.exceptions import DivergenceError, MjbeerError
from mjbeer.integrators.mujoco_steps import MuJoCoSteps
from mjbeer.model.build import specify
from mjbeer.model.joints import initial_state, to_coordinates
from mjbeer.model.setting import MJBEER_INTEGRATORS, MUJOCO_INTEGRATORS, Setting
from mjbeer.output.terminal import progress_bar
from mjbeer.simulation.methods import fixed_method, model_numbers
from mjbeer.simulation.solve import solve
from mjbeer.simulation.stepped_model import SteppedModel
from mjbeer.studies.benchmark import ladders, other_tools
from mjbeer.studies.benchmark.other_tools import OTHER_TOOLS, Samples, Solver
from mjbeer.studies.benchmark.points import CASES, STOCK, TIMESTEP, Benchmark, Case, Point
from mjbeer.studies.study import machine
from mjbeer.theory.record import Record
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

REPEATS = 5
"""Number of timed rounds. Each times every setting once, so that a slow minute of the machine
affects all settings alike."""
_WARM = 0.05
"""A run shorter than this [s] is run once before, so that caches and predictors are warm."""
_BRIEF = 0.01
"""A run that is shorter than this [s] is repeated for so long, as one of a tenth of a millisecond
is at the mercy of the system. Its time in a round is the median."""


def run(names: Sequence[str], quick: bool, console: Console | None) -> Benchmark:
    """Measure the cases of some names: first all errors, then all times, in rounds.

    A setting that fails is a point with the reason. A tool that cannot be imported takes no part;
    the settings of the study have its name and the reason.
    """
    missing = other_tools.absent()
    settings = {"cases": list(names), "quick": quick, "repeats": REPEATS, "absent": missing}
    study = Benchmark(settings, machine(), [])
    curves = {name: ladders.ladders(CASES[name], quick, missing) for name in names}
    count = sum(len(of_case) for of_case in curves.values())
    timed: dict[str, list[tuple[Point, Solver]]] = {name: [] for name in names}
    with progress_bar(console, count + REPEATS * len(names)) as begin:
        for name, of_case in curves.items():
            case = CASES[name]
            truth = case.truth()
            for curve, values in of_case.items():
                begin(f"{name}: {curve.label}")
                for value in values:
                    point = Point(name, curve.model, curve.method, curve.parameter, value)
                    study.points.append(point)
                    try:
                        timed[name].append((point, measure(case, point, truth)))
                    except MjbeerError as error:
                        point.failure = str(error)
        for number in range(1, REPEATS + 1):
            for name in names:
                begin(f"{name}: round {number}")
                _time_all(timed[name])
    return study


def _time_all(timed: Sequence[tuple[Point, Solver]]) -> None:
    """Add a run time to each point, without garbage collection meanwhile."""
    gc.collect()
    gc.disable()
    try:
        for point, solver in timed:
            point.times.append(_seconds(solver.run))
    finally:
        gc.enable()


def _seconds(run: Callable[[], Any]) -> float:
    """Return the run time in a round [s]."""
    duration = _seconds_once(run)
    if duration > _WARM:
        return duration
    durations = []
    while sum(durations) < _BRIEF:
        durations.append(_seconds_once(run))
    return statistics.median(durations)


def _seconds_once(run: Callable[[], Any]) -> float:
    """Return the processor's time of one run [s], without the time that other programs take."""
    begin = time.process_time()
    run()
    return time.process_time() - begin


def measure(case: Case, point: Point, truth: Trajectory) -> Solver:
    """Set up a point and run it once; return its solver, to be timed.

    The point gets its set-up time, its evaluations, its errors against the `truth`, and its drift.

    Raises:
      MjbeerError: if it cannot be set up, or fails, or its end is not finite.
    """
    began = time.process_time()
    solver = _set_up(case, point)
    point.setup = time.process_time() - began
    motion, point.evaluations = solver.read(solver.run())
    # A value that is not finite stays so.
    if not (math.isfinite(motion.phi[-1]) and math.isfinite(motion.u[-1])):
        raise DivergenceError(f"{point.curve.label}: the motion did not stay finite")
    point.phi_max = float(np.abs(motion.phi - truth.phi).max())
    point.u_max = float(np.abs(motion.u - truth.u).max()) / case.scene.can.radius
    point.energy_drift = Record.of(motion, case.scene).energy_drift
    return solver


def _set_up(case: Case, point: Point) -> Solver:
    """Set up a point: another tool, a model as people usually write it, or a setting of mjbeer."""
    if point.model in OTHER_TOOLS:
        return OTHER_TOOLS[point.model].set_up(case, point.value)
    if point.model in STOCK:
        return _set_up_usual(case, point)
    return _set_up_setting(case, point)


def _set_up_usual(case: Case, point: Point) -> Solver:
    """Set up a model as people usually write it."""
    model = usual_model(point.model, case.scene)
    start = initial_state(model, case.scene, case.phi0, case.phi_dot0)
    method = MuJoCoSteps(model, mujoco.MjData(model), [point.value], point.method)

    def read(states: np.ndarray) -> Samples:
        motion = to_coordinates(model, case.scene, states, case.times)
        return Samples(motion, _evaluations_of_steps(case, point))

    return Solver(partial(method.run, start, case.times), read)


def usual_model(name: str, scene: Scene) -> mujoco.MjModel:
    """Return a model as people usually write it, with MuJoCo's defaults wherever there are any.

    The equality is written as u = a roll, in metres.
    """
    spec = specify(scene, STOCK[name], integrator="Euler", timestep=2e-3)
    stock = mujoco.MjSpec().option
    spec.option.enableflags = stock.enableflags
    spec.option.impratio = stock.impratio
    spec.option.cone = stock.cone
    spec.option.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    for equality in spec.equalities:
        equality.name1 = "slide"
        equality.name2 = "roll"
        equality.data[:5] = [0.0, scene.can.radius, 0.0, 0.0, 0.0]
    for constraint in (*spec.equalities, *spec.pairs):
        constraint.solref = (0.02, 1)
        constraint.solimp = (0.9, 0.95, 0.001, 0.5, 2)
    return spec.compile()


def _set_up_setting(case: Case, point: Point) -> Solver:
    """Set up a setting of mjbeer: the integrator alone, or all runs of a tolerance."""
    if point.parameter == TIMESTEP:
        setting = replace(
            Setting(), rolling=point.model, integrator=point.method, timestep=point.value
        )
    else:
        setting = replace(Setting(), rolling=point.model, tolerance=point.value)
    stepped = SteppedModel(model_numbers(case.scene, setting))
    start = stepped.initial_state(case.phi0, case.phi_dot0)

    def run_to_tolerance() -> np.ndarray:
        return solve(stepped, setting, start, case.times).states

    def read(states: np.ndarray) -> Samples:
        motion = to_coordinates(stepped.model, case.scene, states, case.times)
        if point.method in MUJOCO_INTEGRATORS:
            return Samples(motion, _evaluations_of_steps(case, point))
        if point.method in MJBEER_INTEGRATORS:
            return Samples(motion, stepped.dynamics.evaluations)
        return Samples(motion, None)

    if setting.tolerance is not None:
        return Solver(run_to_tolerance, read)
    return Solver(partial(fixed_method(stepped, setting).run, start, case.times), read)


def _evaluations_of_steps(case: Case, point: Point) -> int:
    """Return how often MuJoCo's integrator evaluates the accelerations with a fixed timestep."""
    steps = round(float(case.times[-1]) / point.value)
    return 4 * steps if point.method == "RK4" else steps
