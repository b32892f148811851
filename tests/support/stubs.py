"""Stand-ins for what takes long: made-up rows to validate, videos that are not drawn, studies that are short."""

import inspect
import os
import pathlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from PIL import Image
from rich.console import Console

from mjbeer import exact, paper, sliding
from mjbeer.checks import Check
from mjbeer.drawing import opengl, studio, video, viewer
from mjbeer.drawing.film import Take
from mjbeer.exceptions import RenderingError
from mjbeer.output import files
from mjbeer.paper import stories
from mjbeer.paper.claim import Bound, Claim, Witness
from mjbeer.paper.stories import Story
from mjbeer.report import page
from mjbeer.studies.benchmark import other_tools, timing
from mjbeer.studies.benchmark.points import Curve
from mjbeer.studies.stability import search, stability_maps, stability_study
from mjbeer.studies.validation import validate as validation
from tests.support import pages

STEPS = tuple(16e-3 / 2**k for k in range(6))
LARGE = tuple(64e-3 / 2**k for k in range(7))
LADDERS = {
    Curve("reduced", "Euler"): STEPS,
    Curve("reduced", "RK4"): STEPS,
    Curve("reduced", "DOP853"): LARGE,
    Curve("reduced", "mjbeer", "tolerance"): (1e-6, 1e-9),
    Curve("equality", "RK4"): STEPS,
    Curve("contact", "DOP853"): LARGE[:5],
    Curve("equality, slide first", "Euler"): (2e-3,),
    Curve("equality, hinge first", "Euler"): (2e-3,),
    Curve("contact, defaults", "Euler"): (2e-3,),
    Curve("SciPy DOP853", "", "tolerance"): (1e-3, 1e-6),
    Curve("mjbeer.simulate", "", "tolerance"): (1e-6,),
}
FEW = {Curve("reduced", "RK4"): STEPS[:2], Curve("equality", "RK4"): STEPS[:2]}
"""For what does not depend on the ladders."""


def benchmark(monkeypatch: pytest.MonkeyPatch, ladders: Mapping[Curve, tuple[float, ...]] = LADDERS) -> None:
    """Make the benchmark one of short ladders, timed twice, with all tools there."""
    monkeypatch.setattr(timing, "ladders", lambda *_: dict(ladders))
    monkeypatch.setattr(other_tools, "absent", dict)
    monkeypatch.setattr(timing, "REPEATS", 2)


def stability(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the stability study one of the first check of each group, with a small map and few runs, in this process."""
    first: dict[str, Check] = {}
    for check in stability_study.plan("quick"):
        first.setdefault(check.group, check)
    small = {"maps": partial(stability_maps.measure, stability_maps.PLANS[0], (4, 4))}
    small["search"] = partial(search.batch, 0, 4)
    first |= {group: replace(first[group], measure=measure) for group, measure in small.items()}
    monkeypatch.setattr(stability_study, "plan", lambda extent: list(first.values()))
    monkeypatch.setattr(os, "cpu_count", lambda: 1)


def validate(monkeypatch: pytest.MonkeyPatch, **errors: float) -> None:
    """Make the validation table one of rows with a quantity and an error each, and the bound 1e-3; audit nothing."""
    made = [Check("stubs", name, lambda e=error: e, "a stub", 1e-3, "rad", "none") for name, error in errors.items()]
    monkeypatch.setattr(validation, "checks", lambda: made)
    monkeypatch.setattr(paper, "claims", list)


def audited(monkeypatch: pytest.MonkeyPatch, **errors: float) -> None:
    """Make the audit one of confirmed equations with an error each, and the bound 1e-3."""
    rows = [
        Claim(name, "a stub", Witness("none", lambda error=error: error), Bound(1e-3, ""), lambda e: (1.0 + e, -1.0))
        for name, error in errors.items()
    ]
    monkeypatch.setattr(paper, "claims", lambda: rows)


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

    def produce(orders: Sequence[studio.Order], _: Console) -> list[Any]:
        return [make(order) for order in orders]

    def make(order: studio.Order) -> Any:
        if not isinstance(order, studio.Filmed):
            return order.write()
        if order.path.name == fail_at:
            raise RenderingError(f"cannot draw {fail_at}")
        files.write(order.path, "film")
        Image.new("RGB", pages.SIZE[:2]).save(order.path.with_name(f"{order.path.stem}-still.png"))
        calls.append({"function": "produce", "film": order.film, "path": order.path, "width": order.width})
        return None

    film = Take(partial(exact, sliding(), [0.0, 0.1], 0.1), speed=0.5)
    monkeypatch.setattr(studio, "produce", produce)
    monkeypatch.setattr(opengl, "problem", lambda: None)
    monkeypatch.setattr(video, "problem", lambda: None)
    story = Story("told", "A story", "", "A stub's story.", (1, 1, 4, 3), lambda panels: None, film)
    monkeypatch.setattr(stories, "STORIES", (story,))
    monkeypatch.setattr(page, "plots", pages.plots)
    monkeypatch.setattr(viewer, "require_window", lambda: None)
    monkeypatch.setattr(viewer, "_play", lambda player: None)
    monkeypatch.setattr(video, "render", stub("render", video.render))
    return calls
