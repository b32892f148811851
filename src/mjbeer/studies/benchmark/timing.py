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
from mjbeer.integrators.dop853 import DOP853
from mjbeer.integrators.gauss_jackson import GaussJackson
from mjbeer.model.build import specify
from mjbeer.model.joints import initial_state, to_coordinates
from mjbeer.model.setting import MUJOCO_INTEGRATORS, ROLLINGS, Setting, supported
from mjbeer.output.terminal import progress_bar
from mjbeer.simulation.fixed_step import states_after
from mjbeer.simulation.simulator import Simulator
from mjbeer.simulation.tolerance import even_at_most
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
    """Return a model as people usually write it, with MuJoCo's defaults wherever there are any."""
    spec, stock = specify(scene, points.USUAL[name], integrator="Euler", timestep=2e-3), mujoco.MjSpec().option
    spec.option.enableflags, spec.option.impratio, spec.option.cone = stock.enableflags, stock.impratio, stock.cone
    spec.option.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    for constraint in (*spec.equalities, *spec.pairs):
        constraint.solref, constraint.solimp = (0.02, 1), (0.9, 0.95, 0.001, 0.5, 2)
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
    scene, times, value = case.scene, points.TIMES, point.value
    if point.model in OTHER_TOOLS:
        return OTHER_TOOLS[point.model].set_up(scene, case.phi0, 0.0, times, value), lambda found: found
    own: DOP853 | GaussJackson | None = None
    if point.model in points.USUAL:
        model = usual_model(point.model, scene)
        begin = initial_state(model, scene, case.phi0, 0.0)
        steps = np.rint(times / value).astype(np.int64)
        solve = partial(states_after, model, mujoco.MjData(model), begin, steps)
    else:
        given: dict[str, Any] = {"tolerance": value}
        if point.parameter == points.TIMESTEP:
            given = {"integrator": point.method, "timestep": value}
        simulator = Simulator(scene, replace(Setting(), rolling=point.model, **given))
        model, begin = simulator.model, simulator.initial_state(case.phi0, 0.0)
        if point.method == "DOP853":
            own = DOP853(model)
            solve = partial(own.run, begin, times, value)
        elif point.method == "GaussJackson":
            own = GaussJackson(model)
            solve = partial(own.run, begin, times, value, even_at_most(scene))
        else:
            solve = lambda: simulator.solve(begin, times).states  # noqa: E731

    def motion(states: np.ndarray) -> Samples:
        found, count = to_coordinates(model, scene, states, times), own.evaluations if own else None
        if point.method in MUJOCO_INTEGRATORS:
            count = round(float(times[-1]) / value) * (4 if point.method == "RK4" else 1)
        return found.phi, found.u, count

    return solve, motion


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
