"""Error against run time: every integrator and every way of rolling, measured side by side."""

import gc
import pathlib
from collections.abc import Iterator, Sequence

from rich.console import Console

from mjbeer import require
from mjbeer.exceptions import MjbeerError
from mjbeer.output.terminal import progress_bar
from mjbeer.studies.benchmark import curves
from mjbeer.studies.benchmark.ablation import ablate
from mjbeer.studies.benchmark.curves import TIMESTEP, Curve, aligned
from mjbeer.studies.benchmark.measure import Rung
from mjbeer.studies.benchmark.peers.installed import absent, installed
from mjbeer.studies.benchmark.peers.peer import Peer
from mjbeer.studies.benchmark.points import Benchmark, Point
from mjbeer.studies.cases import CASES, Case
from mjbeer.studies.convergence import convergence

REPEATS = 5
"""Timed rounds. Each round times every setting once, so that a slow minute of the machine hits all settings alike."""
_ENOUGH = 5
"""Fewest rungs before a ladder may end at its floor."""


def conduct(names: Sequence[str], folder: pathlib.Path, quick: bool, console: Console) -> Benchmark:
    """Measure cases, and return the study kept in `folder` as study.json; what is there of one like it is used.

    A peer that cannot be imported takes no part; the study's settings have its name and the reason.

    First each ladder is climbed down once for its errors, to its floor; then every setting is timed, in rounds.
    The file is written after each ladder and each case of a round, so that an interrupted run goes on from there.

    Raises:
      ParameterError: on a case that does not exist, or a study.json that is something else.
      OutputError: if the file cannot be written.
    """
    cases = [CASES[require.choice("scene", name, CASES)] for name in names]
    path = folder / "study.json"
    asked = {"cases": list(names), "quick": quick, "repeats": REPEATS, "absent": absent()}
    found = Benchmark.begin(path, asked, console)
    (folder / "summary.md").unlink(missing_ok=True)  # it would be that of another study
    peers = {peer.name: peer for peer in installed()}
    rungs = [Rung(CASES[point.case], point, peers.get(point.way)) for point in found.points]
    ladders = [(case, curve, values) for case in cases for curve, values in _curves(case, peers, quick).items()]
    known = {(point.case, point.curve) for point in found.points}
    with progress_bar(console, len(ladders) + REPEATS * len(cases) + 1) as begin:
        for case, curve, values in ladders:
            begin(f"errors: {case.name}, {curve.label}")
            if (case.name, curve) not in known:
                climbed = list(_climb(case, curve, values, peers.get(curve.way)))
                rungs += climbed
                found.points += [rung.point for rung in climbed]
                found.save(path)
        for repeat in range(REPEATS):
            for case in cases:
                begin(f"run times: {case.name}, round {repeat + 1}")
                if _time([rung for rung in rungs if rung.case == case], repeat + 1):
                    found.save(path)
        begin("what each stage of a step costs")
        if not found.ablation:
            found.ablation = ablate()
            found.save(path)
    return found


def _curves(case: Case, peers: dict[str, Peer], quick: bool) -> dict[Curve, tuple[float, ...]]:
    found = curves.curves(case.scene, quick)
    for peer in peers.values():
        knobs = peer.knobs[:6] if peer.knob == TIMESTEP else peer.knobs[::2]
        found[Curve(peer.name, "", peer.knob)] = knobs if quick else peer.knobs
    return found


def _climb(case: Case, curve: Curve, values: Sequence[float], peer: Peer | None) -> Iterator[Rung]:
    """The rungs of a ladder, measured, down to its floor, or to its second failure."""
    truth, failures = case.truth(), 0
    steps: list[float] = []
    errors: list[float] = []
    for value in values:
        point = Point(case.name, curve.way, curve.method, curve.knob, value)
        rung = Rung(case, point, peer)
        try:
            rung.measure(truth)
        except MjbeerError as error:
            point.failure, failures = str(error), failures + 1
        else:
            if aligned(value) or curve.knob != TIMESTEP:
                steps.append(value)
                errors.append(point.error)
        yield rung
        # What a tolerance leaves may stay the same over some decades: it is met by steps that are finer anyway.
        floored = curve.knob == TIMESTEP and len(errors) >= _ENOUGH and convergence(steps, errors).kind == "floored"
        if floored or (failures > 1 and errors):
            return


def _time(rungs: Sequence[Rung], repeat: int) -> bool:
    """Time each rung once more that has been timed less often than that; whether there was any."""
    todo = [rung for rung in rungs if rung.point.failure is None and len(rung.point.times) < repeat]
    for rung in todo:
        if "run" not in vars(rung):  # it was measured before an interruption
            rung.run()
    gc.collect()
    gc.disable()
    try:
        for rung in todo:
            rung.point.times.append(rung.seconds())
    finally:
        gc.enable()
    return bool(todo)
