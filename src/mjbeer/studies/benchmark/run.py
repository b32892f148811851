"""Error against run time: every integrator and every way of rolling, measured side by side."""

import gc
import pathlib
import time
from collections.abc import Iterator, Sequence

from rich.console import Console

from mjbeer import require
from mjbeer.exceptions import MjbeerError
from mjbeer.output.terminal import progress_bar
from mjbeer.studies import study
from mjbeer.studies.benchmark import curves
from mjbeer.studies.benchmark.ablation import ablate
from mjbeer.studies.benchmark.curves import TIMESTEP, Curve, aligned
from mjbeer.studies.benchmark.measure import Prepared, measure, prepare
from mjbeer.studies.benchmark.peers.installed import installed
from mjbeer.studies.benchmark.peers.peer import Peer
from mjbeer.studies.benchmark.points import Point, Study, load, missing, same_conditions
from mjbeer.studies.cases import CASES, Case
from mjbeer.studies.convergence import verdict

REPEATS = 5
"""Run times of each setting; a round times every setting once, so that a slow minute is nobody's alone."""
_SHORT = 0.05
"""Runs under this [s] are repeated once, untimed, before they are timed: caches and branch predictors warm."""
_ENOUGH = 5
"""Fewest rungs before a ladder may end at its floor."""


def run(names: Sequence[str], folder: pathlib.Path, quick: bool, console: Console) -> Study:
    """Measure cases and keep the study in `folder`, as study.json; what is there from a run like this is used.

    First each ladder is climbed down once for its errors, to its floor; then every setting is timed, in rounds.
    The file is written after each ladder and each case of a round, so that an interrupted run goes on from there.

    Raises:
      ParameterError: on a case that does not exist.
      OutputError: if the file cannot be written.
    """
    cases = [CASES[require.choice("scene", name, CASES)] for name in names]
    path = folder / "study.json"
    found = _begin(path, {"cases": list(names), "quick": quick, "repeats": REPEATS}, console)
    (folder / "summary.md").unlink(missing_ok=True)  # it would be that of another study
    peers = {peer.name: peer for peer in installed()}
    ready: dict[int, Prepared] = {}
    ladders = [(case, curve, values) for case in cases for curve, values in _curves(case, peers, quick).items()]
    known = {(point.case, point.curve) for point in found.points}
    with progress_bar(console, len(ladders) + REPEATS * len(cases) + 1) as begin:
        for case, curve, values in ladders:
            begin(f"errors: {case.name}, {curve.label}")
            if (case.name, curve) not in known:
                found.points += _climb(case, curve, values, peers, ready)
                found.save(path)
        for repeat in range(REPEATS):
            for case in cases:
                begin(f"run times: {case.name}, round {repeat + 1}")
                if _time(case, found.points, repeat + 1, peers, ready):
                    found.save(path)
        begin("what each stage of a step costs")
        if not found.ablation:
            found.ablation = ablate()
            found.save(path)
    return found


def _begin(path: pathlib.Path, wanted: dict[str, object], console: Console) -> Study:
    here = study.machine()
    if path.exists():
        before = load(path)
        if same_conditions(before, wanted, here):
            console.print(f"going on from {path}", highlight=False, markup=False, soft_wrap=True)
            return before
    return Study(wanted, here)


def _curves(case: Case, peers: dict[str, Peer], quick: bool) -> dict[Curve, tuple[float, ...]]:
    found = curves.curves(case.scene, quick)
    for peer in peers.values():
        knobs = peer.knobs[:6] if peer.knob == TIMESTEP else peer.knobs[::2]
        found[Curve(peer.name, "", peer.knob)] = knobs if quick else peer.knobs
    return found


def _climb(
    case: Case, curve: Curve, values: Sequence[float], peers: dict[str, Peer], ready: dict[int, Prepared]
) -> Iterator[Point]:
    """The points of a ladder, down to its floor, or to its second failure."""
    truth, failures = case.truth(), 0
    steps: list[float] = []
    errors: list[float] = []
    for value in values:
        point = Point(case.name, curve.way, curve.method, curve.knob, value)
        try:
            ready[id(point)] = prepare(case, curve, value, peers)
            measure(case, ready[id(point)], point, truth)
        except MjbeerError as error:
            point.failure, failures = str(error), failures + 1
        else:
            if aligned(value) or curve.knob != TIMESTEP:
                steps.append(value)
                errors.append(point.error)
        yield point
        # What a tolerance leaves may stay the same over some decades: it is met by steps that are finer anyway.
        floored = curve.knob == TIMESTEP and len(errors) >= _ENOUGH and verdict(steps, errors).kind == "floored"
        if floored or (failures > 1 and errors):
            return


def _time(case: Case, points: list[Point], repeat: int, peers: dict[str, Peer], ready: dict[int, Prepared]) -> bool:
    """Time each setting of a case once more, if it has been timed less often than that; whether there was any."""
    todo = [each for each in missing(points, repeat) if each.case == case.name]
    for point in todo:
        if id(point) not in ready:  # from before an interruption
            ready[id(point)] = prepare(case, point.curve, point.value, peers)
            ready[id(point)].run()
    gc.collect()
    gc.disable()
    try:
        for point in todo:
            point.times.append(seconds(ready[id(point)]))
    finally:
        gc.enable()
    return bool(todo)


def seconds(prepared: Prepared) -> float:
    """Run time [s] of one warm run."""
    for _ in range(2):
        begin = time.perf_counter()
        prepared.run()
        taken = time.perf_counter() - begin
        if taken > _SHORT:
            break
    return taken
