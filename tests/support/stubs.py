"""Stand-ins for what takes long: made-up rows to validate, and videos that are not drawn."""

import pathlib
from functools import cache, partial

import pytest

from mjbeer import exact, paper, sliding
from mjbeer.checks.check import Check
from mjbeer.drawing import opengl, video
from mjbeer.drawing.film import MotionFilm
from mjbeer.exceptions import RenderingError
from mjbeer.output import files, jobs, plots
from mjbeer.paper import stories
from mjbeer.paper.stories import PlotSize, Story
from mjbeer.report import page
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark
from mjbeer.studies.validation import validate as validation


def validate(monkeypatch: pytest.MonkeyPatch, **errors: float) -> None:
    """Make the validation table one of rows with a quantity and an error each, and the bound 1e-3;
    audit nothing."""
    made = [
        Check("stubs", name, lambda e=error: e, "a stub", 1e-3, "rad", "none")
        for name, error in errors.items()
    ]
    monkeypatch.setattr(validation, "checks", lambda: made)
    monkeypatch.setattr(paper, "claims", list)


@cache
def _empty_chart() -> plots.Picture:
    """A plot of nothing, which is drawn once a process."""
    picture = plots.Picture("empty")
    with plots.chart(picture, title="A plot & a title", subtitle="of a stub"):
        pass
    return picture


def plot(path: pathlib.Path | plots.Picture) -> None:
    """Write a plot of nothing, or make a picture one."""
    empty = _empty_chart()
    if isinstance(path, plots.Picture):
        path.title = empty.title
        path.subtitle = empty.subtitle
        path.svg = empty.svg
    else:
        files.write(path.with_name(f"{path.name}.svg"), empty.svg)


def draw(monkeypatch: pytest.MonkeyPatch, fail_at: str = "") -> list[video.FilmJob]:
    """Make videos text files, and the one of a name fail; the films that were ordered so far.

    There is OpenGL then, or so it seems, and the paper has a single story. Nothing is done in other
    processes.
    """
    calls: list[video.FilmJob] = []

    def filmed(order: video.FilmJob) -> bytes:
        if order.path.name == fail_at:
            raise RenderingError(f"cannot draw {fail_at}")
        files.write(order.path, f"film {order.path.stem}")
        calls.append(order)
        return b"still"

    def few(folder: pathlib.Path) -> list[video.PlotJob]:
        names = [f"error-{case}" for case in Benchmark.load(SHIPPED).cases]
        names += ["error-contact", "engines", "stability-solref", "told"]
        jobs = [video.PlotJob(plot, folder / name, in_memory=True) for name in names]
        return [*jobs, video.PlotJob(plot, folder / "stability-more")]

    film = MotionFilm(partial(exact, sliding(), [0.0, 0.1], 0.1), speed=0.5)
    monkeypatch.setattr(video.FilmJob, "write", filmed)
    monkeypatch.setattr(jobs, "run_jobs", lambda given, _: [job.work() for job in given])
    monkeypatch.setattr(opengl, "problem", lambda: None)
    story = Story(
        "told",
        "A story & a title",
        "",
        "A stub's story.",
        PlotSize(1, 1, 4, 3),
        lambda panels: None,
        film,
    )
    monkeypatch.setattr(stories, "STORIES", (story,))
    monkeypatch.setattr(page, "plot_jobs", few)
    monkeypatch.setattr(
        video, "render", lambda trajectory, path, *_, **__: files.write(path, "film")
    )
    return calls
