"""Run the benchmark: measure the error of every setting, then time all settings in rounds."""

import gc
import pathlib
from collections.abc import Iterator, Sequence

from rich.console import Console

from mjbeer import require
from mjbeer.exceptions import MjbeerError
from mjbeer.output.terminal import progress_bar
from mjbeer.studies.benchmark import curves
from mjbeer.studies.benchmark.ablation import ablate
from mjbeer.studies.benchmark.curves import TIMESTEP, TOLERANCE, Curve, aligned
from mjbeer.studies.benchmark.measure import Rung
from mjbeer.studies.benchmark.peers import with_scipy
from mjbeer.studies.benchmark.peers.installed import absent, installed
from mjbeer.studies.benchmark.peers.peer import Peer
from mjbeer.studies.benchmark.points import Benchmark, Point
from mjbeer.studies.cases import MEASURED, Case
from mjbeer.studies.convergence import convergence

REPEATS = 5
"""Timed rounds. Each round times every setting once, so that a slow minute of the machine hits all settings alike."""
_ENOUGH = 5
"""Fewest rungs of a ladder that ends at its floor."""


def conduct(names: Sequence[str], folder: pathlib.Path, quick: bool, console: Console) -> Benchmark:
    """Measure the cases of some names, write the study to study.json in `folder`, and return it.

    A peer that cannot be imported takes no part; the settings of the study have its name and the reason.

    First each ladder is run once for its errors, from its coarsest rung down to its floor. Then every setting is timed,
    in rounds. The file is written after each ladder and after each case of a round. If it is there already, from the
    same settings and machine, the study is continued.

    Raises:
      ParameterError: if a case does not exist, or study.json is not a benchmark.
      OutputError: if the file cannot be written.
    """
    cases = [MEASURED[require.choice("scene", name, MEASURED)] for name in names]
    path = folder / "study.json"
    settings = {"cases": list(names), "quick": quick, "repeats": REPEATS, "absent": absent()}
    study = Benchmark.begin(path, settings, console)
    (folder / "summary.md").unlink(missing_ok=True)  # an earlier summary would not match the study
    peers = {peer.name: peer for peer in (*installed(), *with_scipy.STIFF)}
    rungs = [Rung(MEASURED[point.case], point, peers.get(point.way)) for point in study.points]
    ladders = [(case, curve, values) for case in cases for curve, values in _curves(case, peers, quick).items()]
    measured = {(point.case, point.curve) for point in study.points}
    with progress_bar(console, len(ladders) + REPEATS * len(cases) + 1) as begin:
        for case, curve, values in ladders:
            begin(f"errors: {case.name}, {curve.label}")
            if (case.name, curve) not in measured:
                ladder = list(_climb(case, curve, values, peers.get(curve.way)))
                rungs += ladder
                study.points += [rung.point for rung in ladder]
                study.save(path)
        for repeat in range(REPEATS):
            for case in cases:
                begin(f"run times: {case.name}, round {repeat + 1}")
                if _time([rung for rung in rungs if rung.case == case], repeat + 1):
                    study.save(path)
        begin("what each stage of a step costs")
        if not study.ablation:
            study.ablation = ablate()
            study.save(path)
    return study


def _curves(case: Case, peers: dict[str, Peer], quick: bool) -> dict[Curve, tuple[float, ...]]:
    """Return the curves of a case with their ladders, of mjbeer's models and of other tools."""
    ladders = curves.curves(case.scene, quick)
    for peer in peers.values():
        if peer in with_scipy.STIFF and not case.scene.dissipates:
            continue
        ladders[Curve(peer.name, "", TOLERANCE)] = peer.tolerances[:: 2 if quick else 1]
    return ladders


def _climb(case: Case, curve: Curve, values: Sequence[float], peer: Peer | None) -> Iterator[Rung]:
    """Measure and yield the rungs of a ladder, down to its floor or to its second failure after a rung that ran."""
    truth, failures, ran = case.truth(), 0, False
    steps: list[float] = []
    errors: list[float] = []
    for value in values:
        point = Point(case=case.name, way=curve.way, method=curve.method, knob=curve.knob, value=value)
        rung = Rung(case, point, peer)
        try:
            rung.measure(truth)
        except MjbeerError as error:
            point.failure, failures = str(error), failures + ran
        else:
            ran = True
            if aligned(value) or curve.knob != TIMESTEP:
                steps.append(value)
                errors.append(point.error)
        yield rung
        # Not for tolerances: the error may stay the same over some decades where the timesteps are finer than needed.
        floored = curve.knob == TIMESTEP and len(errors) >= _ENOUGH and convergence(steps, errors).kind == "floored"
        if floored or failures > 1:
            return


def _time(rungs: Sequence[Rung], repeat: int) -> bool:
    """Time each rung that has fewer than `repeat` run times once more, and return whether there was any."""
    todo = [rung for rung in rungs if rung.point.failure is None and len(rung.point.times) < repeat]
    for rung in todo:
        if "run" not in vars(rung):  # the study was continued: set the rung up and warm its caches
            rung.run()
    gc.collect()
    gc.disable()
    try:
        for rung in todo:
            rung.point.times.append(rung.seconds())
    finally:
        gc.enable()
    return bool(todo)
