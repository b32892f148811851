"""Stand-ins for what takes long: made-up rows to validate, videos that are not drawn, studies that are short."""

import os
import pathlib
from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import pytest

from mjbeer import exact, paper, sliding
from mjbeer.checks import Check
from mjbeer.drawing import opengl, video
from mjbeer.drawing.film import MotionFilm
from mjbeer.exceptions import RenderingError
from mjbeer.output import files, plots
from mjbeer.paper import stories
from mjbeer.paper.claim import Bound, Claim, Witness
from mjbeer.paper.stories import Story
from mjbeer.report import page
from mjbeer.studies.benchmark import other_tools, timing
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark, Curve
from mjbeer.studies.stability import stability_maps, stability_study
from mjbeer.studies.validation import validate as validation

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


def benchmark(monkeypatch: pytest.MonkeyPatch, ladders: Mapping[Curve, tuple[float, ...]] = LADDERS) -> None:
    """Make the benchmark one of short ladders, timed twice, with all tools there."""
    monkeypatch.setattr(timing, "ladders", lambda *_: dict(ladders))
    monkeypatch.setattr(other_tools, "absent", dict)
    monkeypatch.setattr(timing, "REPEATS", 2)


def stability(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the stability study one of the first check of each group, with a small map and few runs, in this process."""
    first: dict[str, Check] = {}
    for check in stability_study.plan(True):
        first.setdefault(check.group, check)
    small = {"maps": partial(stability_maps.measure, stability_maps.PLANS[0], 4)}
    small["search"] = partial(stability_study.batch, 0, 4)
    first |= {group: replace(first[group], measure=measure) for group, measure in small.items()}
    monkeypatch.setattr(stability_study, "plan", lambda quick: list(first.values()))
    monkeypatch.setattr(os, "cpu_count", lambda: 1)


def validate(monkeypatch: pytest.MonkeyPatch, **errors: float) -> None:
    """Make the validation table one of rows with a quantity and an error each, and the bound 1e-3; audit nothing."""
    made = [Check("stubs", name, lambda e=error: e, "a stub", 1e-3, "rad", "none") for name, error in errors.items()]
    monkeypatch.setattr(validation, "checks", lambda: made)
    monkeypatch.setattr(paper, "claims", list)


def audited(monkeypatch: pytest.MonkeyPatch, **errors: float) -> None:
    """Make the audit one of confirmed equations with an error each, and the bound 1e-3."""
    rows = [
        Claim(name, "a stub", Witness("none", lambda error=error: error), Bound(1e-3, ""), "1 + seen - 1")
        for name, error in errors.items()
    ]
    monkeypatch.setattr(paper, "claims", lambda: rows)


def draw(monkeypatch: pytest.MonkeyPatch, fail_at: str = "") -> list[video.FilmJob]:
    """Make videos text files, and the one of a name fail; the films that were ordered so far.

    There is OpenGL then, or so it seems, and the paper has a single story. Nothing is done in other processes.
    """
    calls: list[video.FilmJob] = []

    def filmed(order: video.FilmJob) -> bytes:
        if order.path.name == fail_at:
            raise RenderingError(f"cannot draw {fail_at}")
        files.write(order.path, f"film {order.path.stem}")
        calls.append(order)
        return b"still"

    def plot(path: pathlib.Path | plots.Picture) -> None:
        with plots.chart(path, title="A plot & a title", subtitle="of a stub"):
            pass

    def few(folder: pathlib.Path) -> list[video.PlotJob]:
        names = [f"error-{case}" for case in Benchmark.load(SHIPPED).cases]
        beside, names = video.PlotJob(plot, folder / "stability-more"), [*names, "stability-solref", "told"]
        return [*(video.PlotJob(plot, folder / name, in_memory=True) for name in names), beside]

    film = MotionFilm(partial(exact, sliding(), [0.0, 0.1], 0.1), speed=0.5)
    monkeypatch.setattr(video.FilmJob, "write", filmed)
    monkeypatch.setattr(video, "produce", lambda orders, _: [order.write() for order in orders])
    monkeypatch.setattr(opengl, "problem", lambda: None)
    story = Story("told", "A story & a title", "", "A stub's story.", (1, 1, 4, 3), lambda panels: None, film)
    monkeypatch.setattr(stories, "STORIES", (story,))
    monkeypatch.setattr(page, "plot_jobs", few)
    monkeypatch.setattr(video, "render", lambda trajectory, path, *_, **__: files.write(path, "film"))
    return calls
