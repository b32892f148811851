"""Run the benchmark: each setting once for its error, then all settings in rounds for their times."""

import gc
import math
import time
from collections.abc import Callable, Container, Sequence
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
from mjbeer.model.setting import MJBEER_INTEGRATORS, MUJOCO_INTEGRATORS, ROLLINGS, Setting, supported
from mjbeer.output.terminal import progress_bar
from mjbeer.simulation.methods import fixed_method, model_numbers
from mjbeer.simulation.solve import solve
from mjbeer.simulation.stepped_model import SteppedModel
from mjbeer.studies.benchmark import other_tools, points
from mjbeer.studies.benchmark.other_tools import OTHER_TOOLS, Samples
from mjbeer.studies.benchmark.points import CASES, Benchmark, Case, Curve, Point
from mjbeer.studies.study import machine
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

REPEATS = 5
"""Timed rounds. Each round times every setting once, so that a slow minute of the machine hits all settings alike."""
_SHORT = 0.05
"""A run shorter than this [s] is timed twice and the first time dropped, so that caches and predictors are warm."""


def conduct(names: Sequence[str], quick: bool, console: Console | None) -> Benchmark:
    """Measure the cases of some names: first all errors, then all times, in rounds.

    A setting that fails is a point with the reason. A tool that cannot be imported takes no part; the settings of the
    study have its name and the reason.
    """
    cases, missing = [CASES[name] for name in names], other_tools.absent()
    curves = [(case, *curve) for case in cases for curve in ladders(case.scene, quick, missing).items()]
    study = Benchmark({"cases": list(names), "quick": quick, "repeats": REPEATS, "absent": missing}, machine(), [])
    ready: dict[str, list[tuple[Point, Callable[[], Any]]]] = {case.name: [] for case in cases}
    with progress_bar(console, len(curves) + REPEATS * len(cases)) as begin:
        for case, curve, values in curves:
            begin(f"{case.name}: {curve.label}")
            truth = case.truth()
            for value in values:
                point = Point(case.name, curve.model, curve.method, curve.parameter, value)
                study.points.append(point)
                try:
                    ready[case.name].append((point, measure(case, point, truth)))
                except MjbeerError as error:
                    point.failure = str(error)
        for repeat in range(REPEATS):
            for case in cases:
                begin(f"{case.name}: round {repeat + 1}")
                gc.collect()
                gc.disable()
                try:
                    for point, solve in ready[case.name]:
                        point.times.append(_seconds(solve))
                finally:
                    gc.enable()
    return study


def usual_model(name: str, scene: Scene) -> mujoco.MjModel:
    """Return a model as people usually write it, with MuJoCo's defaults wherever there are any.

    The equality is written as u = a roll, in metres.
    """
    spec = specify(scene, points.USUAL[name], integrator="Euler", timestep=2e-3)
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


def ladders(scene: Scene, quick: bool = False, missing: Container[str] = ()) -> dict[Curve, tuple[float, ...]]:
    """Return the curves of a scene, each with its timesteps [s] or tolerances [rad], coarsest first.

    MuJoCo's integrators halve their timestep from one rung to the next; DOP853 starts with a larger one and halves it
    in two rungs, and GaussJackson, whose error falls by four decades in a halving, halves it in four. With `quick`, the
    ladders of MuJoCo's integrators end earlier, and all others have at most every second rung. Tools whose names are
    among the `missing` have no curve.
    """
    every = 2 if quick else 1
    steps = tuple(16e-3 / 2**k for k in range(6 if quick else 10))
    tolerances = tuple(10.0**-k for k in range(3, 13, 3 if quick else 1))
    large = tuple(128e-3 / 2 ** (k / 2) for k in range(0, 15, every))
    found: dict[Curve, tuple[float, ...]] = {}
    for rolling in (rolling for rolling in ROLLINGS if supported(scene, rolling)):
        found |= {Curve(rolling, integrator): steps for integrator in MUJOCO_INTEGRATORS}
        found[Curve(rolling, "DOP853")] = large
        if rolling != "contact":  # which is too soft for a tolerance
            found[Curve(rolling, points.CHOSEN, points.TOLERANCE)] = tolerances
    found[Curve("reduced", "GaussJackson")] = tuple(32e-3 / 2 ** (k / 4) for k in range(0, 29, every))
    found |= {Curve(name, "Euler"): (2e-3,) for name, rolling in points.USUAL.items() if supported(scene, rolling)}
    others = {name: tool for name, tool in OTHER_TOOLS.items() if name not in missing}
    return found | {Curve(name, "", points.TOLERANCE): tool.tolerances[::every] for name, tool in others.items()}


def measure(case: Case, point: Point, truth: Trajectory) -> Callable[[], Any]:
    """Set a point up and run it once; store its set-up time, evaluations, and errors against the exact motion in it.

    Returned is what runs it again, to be timed.

    Raises:
      MjbeerError: if it cannot be set up, or fails, or its end is not finite.
    """
    began = time.perf_counter()
    solve, motion = _set_up(case, point)
    point.setup = time.perf_counter() - began
    phi, u, point.evaluations = motion(solve())
    if not (math.isfinite(phi[-1]) and math.isfinite(u[-1])):  # a value that is not finite stays so
        raise DivergenceError(f"{point.curve.label}: the motion did not stay finite")
    point.phi_max = float(np.abs(phi - truth.phi).max())
    point.u_max = float(np.abs(u - truth.u).max()) / truth.scene.can.radius
    return solve


def _set_up(case: Case, point: Point) -> tuple[Callable[[], Any], Callable[[Any], Samples]]:
    """Return what runs a point, and what makes samples from what it returns.

    The point is another tool, a model as people usually write it, or a setting of mjbeer.
    """
    if point.model in OTHER_TOOLS:
        tool = OTHER_TOOLS[point.model]
        return tool.set_up(case.scene, case.phi0, 0.0, points.TIMES, point.value), lambda found: found
    if point.model in points.USUAL:
        return _set_up_usual(case, point)
    return _set_up_setting(case, point)


def _set_up_usual(case: Case, point: Point) -> tuple[Callable[[], Any], Callable[[Any], Samples]]:
    """Return the same for a model as people usually write it."""
    model = usual_model(point.model, case.scene)
    start = initial_state(model, case.scene, case.phi0, 0.0)
    method = MuJoCoSteps(model, mujoco.MjData(model), [point.value], point.method)

    def samples(states: np.ndarray) -> Samples:
        motion = to_coordinates(model, case.scene, states, points.TIMES)
        return motion.phi, motion.u, _evaluations_of_steps(point)

    return partial(method.run, start, points.TIMES), samples


def _set_up_setting(case: Case, point: Point) -> tuple[Callable[[], Any], Callable[[Any], Samples]]:
    """Return the same for a setting of mjbeer: the integrator alone, or all runs of a tolerance."""
    given: dict[str, Any] = {"tolerance": point.value}
    if point.parameter == points.TIMESTEP:
        given = {"integrator": point.method, "timestep": point.value}
    setting = replace(Setting(), rolling=point.model, **given)
    stepped = SteppedModel(model_numbers(case.scene, setting))
    start = stepped.initial_state(case.phi0, 0.0)
    if setting.tolerance is None:
        run = partial(fixed_method(stepped, setting).run, start, points.TIMES)
    else:
        run = lambda: solve(stepped, setting, start, points.TIMES).states  # noqa: E731

    def samples(states: np.ndarray) -> Samples:
        motion = to_coordinates(stepped.model, case.scene, states, points.TIMES)
        count = _evaluations_of_steps(point) if point.method in MUJOCO_INTEGRATORS else None
        if point.method in MJBEER_INTEGRATORS:
            count = stepped.dynamics.evaluations
        return motion.phi, motion.u, count

    return run, samples


def _evaluations_of_steps(point: Point) -> int:
    """Return how often one of MuJoCo's integrators evaluates the accelerations with a fixed timestep."""
    steps = round(float(points.TIMES[-1]) / point.value)
    return 4 * steps if point.method == "RK4" else steps


def _seconds(solve: Callable[[], Any]) -> float:
    """Return the run time [s] with warm caches."""
    duration = 0.0
    for _ in range(2):
        begin = time.perf_counter()
        solve()
        duration = time.perf_counter() - begin
        if duration > _SHORT:
            break
    return duration
