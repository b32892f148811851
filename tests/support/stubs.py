"""Stand-ins for what takes long: made-up rows to validate, videos that are not drawn, studies that are short."""

import inspect
import pathlib
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import pytest
from rich.console import Console

from mjbeer import exact, paper, sliding
from mjbeer.drawing import encoder, opengl, studio, video, viewer
from mjbeer.drawing.film import Take
from mjbeer.exceptions import RenderingError
from mjbeer.output import files
from mjbeer.paper import stories
from mjbeer.paper.row import Bound, Row, Witness
from mjbeer.paper.stories import Story
from mjbeer.studies.benchmark import curves
from mjbeer.studies.benchmark import run as benchmark_run
from mjbeer.studies.benchmark.curves import Curve
from mjbeer.studies.benchmark.peers import with_scipy
from mjbeer.studies.check import Check
from mjbeer.studies.stability import run as stability_run
from mjbeer.studies.stability.run import tasks
from mjbeer.studies.study import Task
from mjbeer.studies.sweep import speed
from mjbeer.studies.validation import motions

STEPS = tuple(16e-3 / 2**k for k in range(6))
LARGE = tuple(64e-3 / 2**k for k in range(7))
LADDERS = {
    Curve("reduced", "Euler", "timestep"): STEPS,
    Curve("reduced", "RK4", "timestep"): STEPS,
    Curve("reduced", "DOP853", "timestep"): LARGE,
    Curve("reduced", "DOP853", "tolerance"): (1e-6, 1e-9),
    Curve("equality", "RK4", "timestep"): STEPS,
    Curve("contact", "DOP853", "timestep"): LARGE[:5],
    Curve("equality, slide first", "Euler", "timestep"): (2e-3,),
    Curve("equality, hinge first", "Euler", "timestep"): (2e-3,),
    Curve("contact, defaults", "Euler", "timestep"): (2e-3,),
}
FEW = {Curve("reduced", "RK4", "timestep"): STEPS[:2], Curve("equality", "RK4", "timestep"): STEPS[:2]}
"""For what does not depend on the ladders."""


def benchmark(monkeypatch: pytest.MonkeyPatch, ladders: Mapping[Curve, tuple[float, ...]] = LADDERS) -> None:
    """Make the benchmark one of short ladders and two peers, timed twice, with made-up times of stages and sweeps."""
    monkeypatch.setattr(curves, "curves", lambda scene, quick: dict(ladders))
    monkeypatch.setattr(benchmark_run, "installed", lambda: [with_scipy.DOP853, with_scipy.ODEINT])
    monkeypatch.setattr(benchmark_run, "absent", dict)
    stages = [{"case": "frozen", "integrator": "RK4", "step": 1e-6, "clock": 2.0}]
    monkeypatch.setattr(benchmark_run, "ablate", lambda: stages)
    monkeypatch.setattr(benchmark_run, "REPEATS", 2)
    swept = [speed.Timed("a sweep of stubs", lambda: (0.0, 0.0), 1e-3, 1e-7)]
    monkeypatch.setattr(speed, "compare", lambda count, rounds: swept)


def stability(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the stability study one of the first task of each group, but for the maps, which take longer."""
    first: dict[str, Task] = {}
    for each in tasks("quick"):
        first.setdefault(each.group, each)
    del first["maps"]
    monkeypatch.setattr(stability_run, "tasks", lambda extent: list(first.values()))


def validate(monkeypatch: pytest.MonkeyPatch, **errors: float) -> None:
    """Make the validation table one of rows with a quantity and an error each, and the bound 1e-3; audit nothing."""
    checks = [Check(name, "a stub", 1e-3, "rad", "none", lambda error=error: error) for name, error in errors.items()]
    monkeypatch.setattr(motions, "checks", lambda: checks)
    monkeypatch.setattr(paper, "rows", list)


def audited(monkeypatch: pytest.MonkeyPatch, **errors: float) -> None:
    """Make the audit one of confirmed equations with an error each, and the bound 1e-3."""
    rows = [
        Row(name, "a stub", Witness("none", lambda error=error: error), Bound(1e-3, ""), lambda e: (1.0 + e, -1.0))
        for name, error in errors.items()
    ]
    monkeypatch.setattr(paper, "rows", lambda: rows)


def draw(monkeypatch: pytest.MonkeyPatch, fail_at: str = "") -> list[dict[str, Any]]:
    """Make videos and pictures text files, and the one of a name fail; the arguments of all calls so far.

    A viewer is closed as soon as it would open.

    There are OpenGL and ffmpeg then, or so it seems, and the paper has a single story, whose plot is a text file too.
    """
    calls: list[dict[str, Any]] = []

    def stub(name: str, real: Callable[..., None]) -> Callable[..., None]:
        signature = inspect.signature(real)

        def instead(*args: object, **kwargs: object) -> None:
            call = signature.bind(*args, **kwargs).arguments
            call["path"] = pathlib.Path(call["path"])
            if call["path"].name == fail_at:
                raise RenderingError(f"cannot draw {fail_at}")
            files.write(call["path"], name)
            calls.append({"function": name, **call})

        return instead

    def tell(path: pathlib.Path) -> None:
        files.write(path.with_name(f"{path.name}.svg"), "plot")

    def produce(orders: Sequence[studio.Order], _: Console) -> None:
        for order in orders:
            if order.path.name == fail_at:
                raise RenderingError(f"cannot draw {fail_at}")
            files.write(order.path, "film")
            files.write(order.path.with_name(f"{order.path.stem}-still.png"), "still")
            calls.append({"function": "produce", "film": order.film, "path": order.path, "width": order.width})

    film = Take(partial(exact, sliding(), [0.0, 0.1], 0.1), speed=0.5)
    monkeypatch.setattr(studio, "produce", produce)
    monkeypatch.setattr(opengl, "problem", lambda: None)
    monkeypatch.setattr(encoder, "problem", lambda: None)
    monkeypatch.setattr(stories, "stories", lambda: [Story("told", "A stub's story.", tell, film)])
    monkeypatch.setattr(viewer, "require_window", lambda: None)
    monkeypatch.setattr(viewer, "_play", lambda player: None)
    for name in ("render", "save_frame"):
        monkeypatch.setattr(video, name, stub(name, getattr(video, name)))
    return calls
