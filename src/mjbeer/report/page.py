"""The page of the report: everything in one file that opens from the disk, and that fetches nothing."""

import base64
import io
import math
import pathlib
import re
from collections import Counter
from dataclasses import dataclass, replace
from functools import partial

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape
from PIL import Image

from mjbeer import paper
from mjbeer.checks import Result
from mjbeer.drawing.film import Take
from mjbeer.drawing.studio import Plotted
from mjbeer.paper import stories
from mjbeer.paper.claim import Claim
from mjbeer.report.films import COMMANDS, FILMS, RACES
from mjbeer.report.formulas import letters, mathml
from mjbeer.studies.benchmark import benchmark_tables, work_precision
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark
from mjbeer.studies.stability import stability_maps
from mjbeer.studies.study import machine
from mjbeer.studies.validation.validate import Validation

LIMIT = 8.5e6
"""Largest size of films and plots in the page [bytes], which with its text is below 9 MB; films of the paper that would
exceed it stay beside it as files."""
_SMALL = 1e-3
"""A smaller share is a power of ten and not a percentage."""
_WIDE = 690.0
"""Width [points] from which a plot takes the width of the page, so that its letters can be read."""
_TITLE, _SUBTITLE = 23.0, 17.3
"""Heights of a plot's title, which the page has as a heading, and of the line below it [points]: see `output.plots`."""
_KINDS = {".mp4": "video/mp4", ".svg": "image/svg+xml", ".webp": "image/webp"}
_FAILED = re.compile(r"\*\*(.+?)\*\*")


@dataclass(frozen=True)
class Plot:
    """A plot (SVG) as the page shows it: without its title, which is the heading above it."""

    name: str
    title: str
    svg: str
    width: float
    """Width [points]."""

    @classmethod
    def of(cls, path: pathlib.Path, captioned: bool = False) -> "Plot":
        """Read a plot and its title, which is its name if it has none.

        The line below the title is cut off as well where the page has it as a caption.
        """
        svg = path.read_text(encoding="utf-8")
        svg = re.sub(r"(?s)<metadata>.*</metadata>", "", svg[svg.index("<svg") :])
        title = re.search(r"<title>([^<]*)</title>", svg.partition("<g")[0])
        corner, top, width, height = map(float, re.findall(r"[-\d.]+", svg.partition('viewBox="')[2])[:4])
        if title:
            head = _TITLE + _SUBTITLE * captioned
            top, height = top + head, height - head
        size = f'viewBox="{corner:g} {top:g} {width:g} {height:g}"'
        svg = re.sub(r'viewBox="[^"]*"', size, re.sub(r' (?:width|height)="[\d.]+pt"', "", svg, count=2), count=1)
        return cls(path.stem, str(Markup(title[1]).unescape()) if title else path.stem, svg, width)

    @property
    def picture(self) -> str:
        """The plot as a data: URI."""
        return _uri(self.svg.encode(), ".svg")

    @property
    def inline(self) -> Markup:
        """The plot as an element of the page, whose points then tell what they are; its names are its own."""
        svg = re.sub(r'(id="|="#|url\(#)', rf"\1{self.name}-", self.svg)
        return Markup(svg.replace("<svg ", f'<svg role="img" aria-label="{escape(self.title)}" ', 1))


@dataclass(frozen=True)
class Shown:
    """A film, a plot, or both, as the page shows them."""

    name: str
    title: str
    caption: str
    command: str
    plot: Plot | None = None
    video: str = ""
    """The film as a data: URI; empty if there is none."""
    poster: str = ""
    """A picture from the midst of the film as a data: URI; empty if the film is not in the page."""
    beside: str = ""
    """Where the film is, relative to the page, if it is too large for it."""

    @property
    def wide(self) -> bool:
        """Whether the plot has several panels side by side, and needs the width of the page."""
        return self.plot is not None and self.plot.width > _WIDE


def plots(folder: pathlib.Path) -> list[Plotted]:
    """Return the plots of error against run time, scene by scene, and the stability maps, to be drawn into a folder."""
    benchmark = Benchmark.load(SHIPPED)
    scenes = {case: replace(benchmark, points=benchmark.of(case)) for case in benchmark.cases}
    drawn = {f"error-{case}": partial(work_precision.draw, scene) for case, scene in scenes.items()}
    return [
        Plotted(draw, folder / name) for name, draw in (drawn | stability_maps.figures(stability_maps.load())).items()
    ]


def html(folder: pathlib.Path, validation: Validation, quick: bool, not_drawn: str) -> str:
    """Return the page on the films, plots and stories in a folder; `not_drawn` says why films are missing, or is ""."""
    environment = Environment(
        loader=PackageLoader("mjbeer.report", "web"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"mathml": mathml, "power": power, "share": share, "marked": _marked}
    benchmark, maps = Benchmark.load(SHIPPED), stability_maps.load()
    films = {name: _film(folder, name) for name in FILMS}
    errors = [Plot.of(folder / "plots" / f"error-{case}.svg") for case in benchmark.cases]
    figures = [
        Shown(plot.name, plot.title, figure.caption, maps["command"], plot)
        for name, figure in stability_maps.FIGURES.items()
        for plot in [Plot.of(folder / "plots" / f"stability-{name}.svg", captioned=True)]
    ]
    summary = stability_maps.summary(maps).values()
    room = LIMIT - sum(len(film.video) + len(film.poster) for film in films.values())
    room -= sum(len(plot.svg) for plot in errors) + sum(len(each.plot.picture) for each in figures if each.plot)
    return environment.get_template("page.html").render(
        sketch=Plot.of(folder / "paper" / "letters.svg"),
        races=[films.pop(name) for name in RACES],
        films=list(films.values()),
        not_drawn=not_drawn,
        errors=errors,
        benchmark=benchmark,
        costs=benchmark_tables.tables(benchmark),
        slower=_range(benchmark, "MuJoCo RK4"),
        heyoka=_range(benchmark, "heyoka"),
        maps=maps,
        figures=figures,
        runs=round(sum(of["runs"] for of in summary)),
        same=sum(of["as predicted"] for of in summary) / sum(of["runs"] for of in summary),
        misprints=(misprints := _misprints(validation)),
        kinds=Counter(row.misprint.kind for _, row in misprints if row.misprint),
        quoted=[row for row in paper.claims() if row.quote and not row.misprint],
        findings=len(validation.audit),
        stories=_stories(folder, quick, room),
        validation=validation,
        tables=validation.tables(document=True),
        machine=machine(),
        quick=quick,
    )


def power(value: float) -> Markup:
    """Return a number in two digits as HTML: 0.0021 as it is, and smaller ones as a power of ten."""
    if value == 0 or 1e-3 <= abs(value) < 1e4:
        return escape(f"{value:.2g}")
    digits, exponent = f"{value:.1e}".split("e")
    raised = Markup("10<sup>{}</sup>").format(str(int(exponent)).replace("-", "\N{MINUS SIGN}"))
    if math.isclose(value, float(f"1e{exponent}"), rel_tol=1e-9):
        return raised
    return Markup("{}&thinsp;·&thinsp;{}").format(digits, raised)


def share(value: float) -> Markup:
    """Return a share of the largest term as HTML: a percentage in two digits, three from 100 on, or a power of ten."""
    if abs(value) < _SMALL:
        return power(value)
    return escape(f"{100 * value:.3g} %" if abs(value) >= 1 else f"{100 * value:.2g} %")


def _film(folder: pathlib.Path, name: str) -> Shown:
    """Return a film of the scenes with its poster, or without both if it was not drawn."""
    film, video = FILMS[name], folder / f"{name}.mp4"
    command = f"{COMMANDS[name]} --output {name}.mp4" if name in COMMANDS else "mjbeer report"
    head = film.look if isinstance(film, Take) else film
    shown = Shown(name, head.title if head else name, film.caption, command)
    return replace(shown, video=_data(video), poster=_poster(video)) if video.exists() else shown


def _stories(folder: pathlib.Path, quick: bool, room: float) -> list[Shown]:
    """Return the paper's stories: each film goes into the page as long as there is `room` [bytes] for it.

    A `quick` report has no films of stories; an earlier one may have left some.
    """
    plots = [Plot.of(folder / "paper" / f"{story.name}.svg") for story in stories.STORIES]
    room -= sum(len(plot.picture) for plot in plots)
    shown = []
    for story, plot in zip(stories.STORIES, plots, strict=True):
        video = folder / "paper" / f"{story.name}.mp4"
        each = Shown(story.name, plot.title, story.caption, "mjbeer paper" + " --films" * (not quick), plot)
        if story.film is not None and not quick and video.exists():
            with_film = replace(each, video=_data(video), poster=_poster(video))
            size = len(with_film.video) + len(with_film.poster)
            each = with_film if size < room else replace(each, beside=f"paper/{story.name}.mp4")
            room -= size if size < room else 0
        shown.append(each)
    return shown


def _data(path: pathlib.Path) -> str:
    return _uri(path.read_bytes(), path.suffix)


def _poster(video: pathlib.Path) -> str:
    """Return the still picture beside a film as a data: URI, a third as large as the file."""
    file = io.BytesIO()
    with Image.open(video.with_name(f"{video.stem}-still.png")) as still:
        still.save(file, "WEBP", quality=80)
    return _uri(file.getvalue(), ".webp")


def _uri(content: bytes, kind: str) -> str:
    return f"data:{_KINDS[kind]};base64,{base64.b64encode(content).decode()}"


def _range(benchmark: Benchmark, name: str) -> str:
    """Return the least and the largest run time of another tool over that of mjbeer's best setting, at equal error."""
    return " to ".join(map(benchmark_tables.two_digits, benchmark_tables.span(benchmark, name)))


def _misprints(validation: Validation) -> list[tuple[Result, Claim]]:
    """Return the findings of what is wrong in the paper, each with its row."""
    rows = {(row.equation, row.quantity): row for row in paper.claims() if row.misprint}
    named = [((result.group, result.name), result) for result in validation.audit]
    return [(finding, rows[name]) for name, finding in named if name in rows]


def _marked(cell: str) -> Markup:
    """Return a text of a table as HTML, with Greek letters; what stands between two pairs of asterisks is strong."""
    return Markup(_FAILED.sub(r"<strong>\1</strong>", str(escape(letters(cell)))))
