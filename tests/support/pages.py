"""A small report: films of a second, plots that are nearly empty, and made-up numbers; and the elements of a page."""

import html.parser
import pathlib
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from PIL import Image

from mjbeer import exact, frozen, paper
from mjbeer.checks import Result
from mjbeer.drawing import video
from mjbeer.drawing.film import Take
from mjbeer.drawing.studio import Plotted
from mjbeer.output import files
from mjbeer.paper import stories as paper_stories
from mjbeer.paper.claim import CORRECTED
from mjbeer.paper.stories import Story
from mjbeer.report import films
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark
from mjbeer.studies.stability import stability_maps
from mjbeer.studies.validation.validate import Validation

PLOT = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 900 300"><title>A plot of {}</title>'
    '<defs><path id="dot" d="M0 40h9v9z"/></defs><use href="#dot"><title>a setting</title></use></svg>'
)
"""A wide plot with a title, and a point that tells something."""
SIZE = (64, 36, 10)
"""Width and height [pixels] and frames per second of the films, which last a second."""


def validation(misprints: slice = slice(None)) -> Validation:
    """A validation with two checks, the second of which failed, and a finding for each misprint, or for some."""
    errors = {"fine": 1e-6, "bad": 0.5}
    checks = [Result("stubs", name, "a <stub>", 1e-3, "rad", "phi_0^2", error) for name, error in errors.items()]
    audit = [
        Result(
            claim.equation, claim.quantity, "a witness", 1e-6, "", "rounding", 1.7e-9 * (place + 1),
            {"verdict": CORRECTED, "printed": 0.0127 * (place + 1), "expected_error": 0.0123 * (place + 1)},
        )
        for place, claim in enumerate(claim for claim in paper.claims() if claim.misprint)
    ]  # fmt: skip
    return Validation(checks, audit[misprints])


def stories() -> list[Story]:
    """Two stories, of which the first has a film."""
    film = Take(partial(exact, frozen(), np.array([0.0, 1.0]), 1.0), speed=1.0)
    return [
        Story("told", "A story", "", "A story of phi_0.", (1, 1, 4, 3), lambda panels: None, film),
        Story("still", "A plot", "", "A plot.", (1, 1, 4, 3), lambda panels: None),
    ]


def plots(folder: pathlib.Path) -> list[Plotted]:
    """Plots of the benchmark and of stability that are nearly empty, to be drawn into a folder."""
    names = [f"error-{case}" for case in Benchmark.load(SHIPPED).cases]
    return [
        Plotted(draw, folder / name) for name in (*names, *(f"stability-{family}" for family in stability_maps.FIGURES))
    ]


def draw(path: pathlib.Path) -> None:
    """Write a plot that is nearly empty."""
    files.write(path.with_name(f"{path.name}.svg"), PLOT.format(path.name))


def fill(folder: pathlib.Path, encoded: bool = False) -> None:
    """Write the files that a page shows into a folder: films are `encoded`, or else a few letters."""
    for each in (folder / "plots", folder / "paper"):
        each.mkdir()
    for plot in plots(folder / "plots"):
        plot.write()
    for name in ("letters", *(story.name for story in paper_stories.STORIES)):
        draw(folder / "paper" / name)
    for name in (*films.FILMS, *(f"paper/{story.name}" for story in paper_stories.STORIES if story.film)):
        if encoded:
            width, height, fps = SIZE
            shades = np.linspace(0, 255, fps).astype(np.uint8)
            video.encode((np.full((height, width, 3), one) for one in shades), folder / f"{name}.mp4", *SIZE)
        else:
            (folder / f"{name}.mp4").write_text(f"film {name}")
        Image.new("RGB", SIZE[:2], "navy").save(folder / f"{name}-still.png")


@dataclass
class Element:
    """An element of a page: its name, its attributes, and all the text in it."""

    name: str
    attributes: dict[str, str]
    text: str = ""


@dataclass
class Page(html.parser.HTMLParser):
    """The elements of a page, in the order in which they begin."""

    elements: list[Element] = field(default_factory=list)
    open: list[Element] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()

    @classmethod
    def of(cls, text: str) -> "Page":
        """Read a page."""
        page = cls()
        page.feed(text)
        page.close()
        assert not page.open, [element.name for element in page.open]
        return page

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        element = Element(tag, {name: value or "" for name, value in attrs})
        self.elements.append(element)
        if tag not in ("meta", "link", "img", "source", "input", "mspace", "br"):
            self.open.append(element)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append(Element(tag, {name: value or "" for name, value in attrs}))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop().name == tag, tag

    def handle_data(self, data: str) -> None:
        for element in self.open:
            element.text += data

    def all(self, *names: str) -> list[Element]:
        """The elements of some names."""
        return [element for element in self.elements if element.name in names]
