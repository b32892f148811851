"""Run the benchmark: climb each ladder of settings for its errors, then time all settings in rounds."""

import gc
import math
import pathlib
import time
from collections.abc import Container, Sequence
from dataclasses import asdict
from functools import partial
from typing import Any

import mujoco
import numpy as np
from rich.console import Console

from mjbeer import require
from mjbeer.exceptions import DivergenceError, MjbeerError
from mjbeer.model.engine import quiet
from mjbeer.model.setting import DOP853, GAUSS_JACKSON, INTEGRATORS, ROLLINGS, supported
from mjbeer.model.state import read, start
from mjbeer.simulation.run import Prepared
from mjbeer.simulation.stepping import Solution, Stepper
from mjbeer.studies.benchmark import peers, sweeps
from mjbeer.studies.benchmark.peers import PEERS, Peer
from mjbeer.studies.benchmark.points import CHOSEN, COMMAND, TOLERANCE, USUAL, Benchmark, Curve, Point, usual_model
from mjbeer.studies.cases import INTERVAL, MEASURED, Case
from mjbeer.studies.rows import Row, Study, run
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


def conduct(names: Sequence[str], folder: pathlib.Path, quick: bool, console: Console) -> Benchmark:
    """Measure the cases of some names, write the study to study.jsonl in `folder`, and return it.

    A peer that cannot be imported takes no part; the settings of the study have its name and the reason. A study of
    the same settings and machine that is there already is gone on with.

    Raises:
      ParameterError: if a case does not exist, or study.jsonl is not a benchmark.
      OutputError: if the file cannot be written.
    """
    cases = [MEASURED[require.choice("scene", name, MEASURED)] for name in names]
    path, missing = folder / "study.jsonl", peers.absent()
    (folder / "summary.md").unlink(missing_ok=True)  # an earlier summary would not match the study
    climbed = [
        Row(Benchmark.ERRORS, curve.label, partial(_climb, case, curve, values), case.name)
        for case in cases
        for curve, values in ladders(case.scene, quick, missing).items()
    ]
    rungs: dict[Any, Rung] = {}
    timed = [
        Row(Benchmark.TIMES, f"round {repeat + 1}", partial(_time, case, path, rungs), case.name)
        for repeat in range(REPEATS)
        for case in cases
    ]
    many = Row(Benchmark.SWEEPS, "sweeps of many scenes", partial(sweeps.compare, quick))
    settings = {"cases": list(names), "quick": quick, "repeats": REPEATS, "absent": missing}
    return Benchmark.of_study(run([*climbed, *timed, many], console, path, COMMAND, settings))


def ladders(scene: Scene, quick: bool = False, missing: Container[str] = ()) -> dict[Curve, tuple[float, ...]]:
    """Return the curves of a scene, each with its timesteps [s] or tolerances [rad], coarsest first.

    MuJoCo's integrators halve their timestep from one rung to the next; DOP853 starts with a larger one, unless damping
    would make it explode, and halves it in two rungs, and GaussJackson, whose error falls by four decades in a halving,
    halves it in four. With `quick`, the ladders of MuJoCo's integrators end earlier, and all others have at most every
    second rung. Peers whose names are among the `missing` have no curve.
    """
    every = 2 if quick else 1
    steps = tuple(16e-3 / 2**k for k in range(6 if quick else 10))
    large = tuple((1e-3 if scene.dissipates else 128e-3) / 2 ** (k / 2) for k in range(0, 15, every))
    found: dict[Curve, tuple[float, ...]] = {}
    for way in (way for way in ROLLINGS if supported(scene, way)):
        found |= {Curve(way, integrator): steps for integrator in INTEGRATORS}
        found[Curve(way, DOP853)] = large
        found[Curve(way, CHOSEN, TOLERANCE)] = tuple(10.0**-k for k in range(3, 13, 3 if quick else 1))
    if not scene.dissipates:
        found[Curve("reduced", GAUSS_JACKSON)] = tuple(32e-3 / 2 ** (k / 4) for k in range(0, 29, every))
    found |= {Curve(name, "Euler"): (2e-3,) for name, rolling in USUAL.items() if supported(scene, rolling)}
    others = (peer for peer in PEERS.values() if peer.name not in missing)
    return found | {Curve(peer.name, "", TOLERANCE): peer.tolerances[::every] for peer in others}


class Rung:
    """A setting of a case, set up once and run often."""

    def __init__(self, case: Case, curve: Curve, value: float) -> None:
        self._case = case
        peer: Peer | None = PEERS.get(curve.way)
        if curve.way in USUAL:
            self._model, self._times = usual_model(curve.way, case.scene), case.times
            self._start = start(self._model, case.scene, case.phi0, 0.0)
            stepper, steps = Stepper(self._model), np.rint(case.times / value).astype(np.int64)
            self.run = lambda: Solution(stepper.run(self._start, steps))
        elif peer is None:
            self._prepared = Prepared(case.scene, curve.setting(value))
            self._model = self._prepared.model
            self._start = self._prepared.start(case.phi0, 0.0)
            self.run = partial(self._prepared.solve, self._start, case.times)
        else:
            self.run = peer.set_up(case.scene, case.phi0, 0.0, case.times, value)

    def measure(self, point: Point, truth: Trajectory) -> None:
        """Run once, and store errors against the exact motion in the point, and what else there is but run times.

        Raises:
          DivergenceError: if the run fails, or its end is not finite.
        """
        result, radius = self.run(), truth.scene.can.radius
        if isinstance(result, Solution):
            motion = read(self._model, truth.scene, result.states, truth.time)
            moved = Trajectory(**vars(motion), scene=truth.scene, phi0=truth.phi0, phi_dot0=0.0)
            point.slip_max, point.energy_drift = float(np.abs(moved.slip).max()) / radius, moved.energy_drift
            point.share = applied_share(self._model, self._start)
            result = motion.phi, motion.u
        if not np.isfinite([values[-1] for values in result]).all():  # a value that is not finite stays so
            raise DivergenceError(f"{point.curve.label}: the motion did not stay finite")
        phi_error, u_error = np.abs(result[0] - truth.phi), np.abs(result[1] - truth.u) / radius
        point.phi_max, point.phi_end = float(phi_error.max()), float(phi_error[-1])
        point.u_max, point.u_end = float(u_error.max()), float(u_error[-1])

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


def _climb(case: Case, curve: Curve, values: Sequence[float]) -> dict[str, Any]:
    """Measure the rungs of a ladder, down to its floor or to its second failure after a rung that ran."""
    truth, failures, ran = case.truth(), 0, False
    points: list[Point] = []
    for value in values:
        point = Point(case.name, curve.way, curve.method, curve.knob, value)
        points.append(point)
        try:
            begin = time.perf_counter()
            rung = Rung(case, curve, value)
            point.setup = time.perf_counter() - begin
            rung.measure(point, truth)
        except MjbeerError as error:
            point.failure, failures = str(error), failures + ran
        else:
            ran = True
        # Not for tolerances: the error may stay the same over some decades where the timesteps are finer than needed.
        if failures > 1 or (curve.knob != TOLERANCE and _floored(points)):
            break
    return asdict(curve) | {"points": [point.known() for point in points]}


def _floored(points: Sequence[Point]) -> bool:
    """Return whether the errors stopped falling: no later rung has less than half the error of some rung.

    Rungs whose samples are interpolated would hide that.
    """
    exact = [point for point in points if point.failure is None and np.frexp(point.value / INTERVAL)[0] == 0.5]
    errors = [point.error for point in exact if 0 < point.error < math.inf]
    rungs = enumerate(errors[:-2] if len(exact) >= _ENOUGH else [])
    return any(min(errors[place:]) >= _FLAT * error and error < _NO_FLOOR for place, error in rungs)


def _time(case: Case, path: pathlib.Path, rungs: dict[Any, Rung]) -> dict[str, list[float]]:
    """Return the run times [s] of all settings of a case that did not fail in the study in a file, by their curves.

    What is set up is kept in `rungs` for the next round.
    """
    points = [each for each in Benchmark.of_study(Study.load(path, COMMAND)).points if each.case == case.name]
    times: dict[str, list[float]] = {point.curve.label: [] for point in points}
    points = [point for point in points if point.failure is None]
    for point in points:
        if (case.name, point.curve, point.value) not in rungs:
            rung = rungs[case.name, point.curve, point.value] = Rung(case, point.curve, point.value)
            rung.run()  # warms its caches
    gc.collect()
    gc.disable()
    try:
        for point in points:
            times[point.curve.label].append(round(rungs[case.name, point.curve, point.value].seconds(), 9))
    finally:
        gc.enable()
    return times


def applied_share(model: mujoco.MjModel, state: np.ndarray) -> float | None:
    """Return the share of a hard constraint's force that the solver applies at a `state`, shape (nq + nv,).

    It is A/(A + R) with the regularizer R and the diagonal A = J M^-1 J^T of the rolling constraint's first row; None
    if no constraint is active.
    """
    data, mass = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    data.qpos[:], data.qvel[:] = state[: model.nq], state[model.nq :]
    with quiet():
        mujoco.mj_forward(model, data)
    if data.nefc == 0:
        return None
    mujoco.mj_fullM(model, data, mass)
    jacobian = np.array(data.efc_J).reshape(-1, model.nv)[0]
    diagonal = float(jacobian @ np.linalg.solve(mass, jacobian))
    return diagonal / (diagonal + float(data.efc_R[0]))
