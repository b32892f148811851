"""The page of the report: everything in one file that opens from the disk, and that fetches nothing."""

import base64
import pathlib
import re
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape

from mjbeer import paper
from mjbeer.checks import Result
from mjbeer.drawing.film import MotionFilm
from mjbeer.drawing.video import PlotJob
from mjbeer.output.plots import Picture
from mjbeer.paper import stories
from mjbeer.paper.claim import Claim
from mjbeer.report.films import COMMANDS, FILMS, RACES
from mjbeer.report.formulas import letters, mathml
from mjbeer.studies.benchmark import benchmark_tables, work_precision
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark
from mjbeer.studies.stability import stability_maps
from mjbeer.studies.study import machine
from mjbeer.studies.validation.validate import Validation

_MAP = "stability-solref"  # the maps on the page; the others lie beside it
_SMALL = 1e-3  # a smaller share is a power of ten and not a percentage
_FAILED = re.compile(r"\*\*(.+?)\*\*")

Film = tuple[bytes, bytes]  # a film as MP4, and a picture from the midst of it as WebP


@dataclass(frozen=True)
class Exhibit:
    """A film, a plot, or both, as the page shows them."""

    name: str
    title: str
    caption: str
    command: str
    plot: Picture | None = None
    film: Film | None = None


def plot_jobs(folder: pathlib.Path) -> list[PlotJob]:
    """Return the plots of the page, by the names of files in a folder, into which maps are drawn that lie beside it."""
    benchmark = Benchmark.load(SHIPPED)
    scenes = {case: replace(benchmark, points=benchmark.of(case)) for case in benchmark.cases}
    drawn: dict[str, Callable[[Any], None]] = {
        f"error-{case}": partial(work_precision.draw, scene) for case, scene in scenes.items()
    }
    drawn |= {story.name: story.plot for story in stories.STORIES}
    maps = stability_maps.figures(stability_maps.load())
    return [PlotJob(draw, folder / name, name not in maps or name == _MAP) for name, draw in (drawn | maps).items()]


def html(
    validation: Validation, films: Mapping[str, Film], plots: Mapping[str, Picture], quick: bool, not_drawn: str
) -> str:
    """Return the page, with films of scenes and stories and plots by their names.

    `not_drawn` says why films are missing, or is "".
    """
    environment = Environment(
        loader=PackageLoader("mjbeer.report", "web"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"mathml": mathml, "share": share, "marked": _marked, "data": _data, "inline": _inline}
    made = "mjbeer paper" + " --films" * (not quick)
    benchmark, maps = Benchmark.load(SHIPPED), stability_maps.load()
    scenes = {name: _scene(name, films.get(name)) for name in FILMS}
    runs, _, border = stability_maps.summary(maps["maps"])
    wrong, others = _misprints(validation), [name for name in stability_maps.FAMILIES if name not in _MAP]
    return environment.get_template("page.html").render(
        sketch=stories.letters(),
        races=[scenes.pop(name) for name in RACES],
        films=list(scenes.values()),
        not_drawn=not_drawn,
        errors=[plots[f"error-{case}"] for case in benchmark.cases],
        benchmark=benchmark,
        costs=benchmark_tables.tables(benchmark),
        slower=_range(benchmark, "MuJoCo RK4"),
        heyoka=_range(benchmark, "heyoka"),
        maps=maps,
        map=plots[_MAP],
        other_maps={f"stability-{name}.svg": stability_maps.FAMILIES[name].title for name in others},
        runs=runs,
        border=border,
        misprints=wrong,
        kinds=Counter(claim.misprint.kind for _, claim in wrong if claim.misprint),
        quoted=[claim for claim in paper.claims() if claim.quote and not claim.misprint],
        claims=len(validation.audit),
        stories=[
            Exhibit(each.name, each.title, each.caption, made, plots[each.name], films.get(each.name))
            for each in stories.STORIES
        ],
        validation=validation,
        tables=validation.tables(document=True),
        machine=machine(),
        quick=quick,
    )


def share(value: float) -> Markup:
    """Return a share of the largest term as HTML: a percentage in two digits, three from 100 on, or a power of ten."""
    if abs(value) >= _SMALL or value == 0:
        return escape(f"{100 * value:.3g} %" if abs(value) >= 1 else f"{100 * value:.2g} %")
    digits, power = f"{value:.1e}".split("e")
    return Markup("{}&thinsp;·&thinsp;10<sup>{}</sup>").format(digits, f"{int(power)}".replace("-", "\N{MINUS SIGN}"))


def _scene(name: str, drawn: Film | None) -> Exhibit:
    """Return a film of the scenes, or what there is of it if it was not drawn."""
    film = FILMS[name]
    command = f"{COMMANDS[name]} --output {name}.mp4" if name in COMMANDS else "mjbeer report"
    head = film.look if isinstance(film, MotionFilm) else film
    return Exhibit(name, head.title if head else name, film.caption, command, film=drawn)


def _data(content: bytes | str, kind: str) -> str:
    """Return a file of a kind as a data: URI."""
    content = content if isinstance(content, bytes) else content.encode()
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def _inline(plot: Picture) -> Markup:
    """Return a plot as an element of the page, whose points then tell what they are; its names are its own."""
    svg = re.sub(r'(id="|="#|url\(#)', rf"\1{plot.name}-", plot.svg)
    return Markup(svg.replace("<svg ", f'<svg role="img" aria-label="{escape(plot.title)}" ', 1))


def _range(benchmark: Benchmark, name: str) -> str:
    """Return the least and the largest run time of another tool over that of mjbeer's best setting, at equal error."""
    return " to ".join(map(benchmark_tables.two_digits, benchmark_tables.span(benchmark, name)))


def _misprints(validation: Validation) -> list[tuple[Result, Claim]]:
    """Return the results of what is wrong in the paper, each with its claim."""
    claims = {(claim.equation, claim.quantity): claim for claim in paper.claims() if claim.misprint}
    named = [((result.group, result.name), result) for result in validation.audit]
    return [(result, claims[name]) for name, result in named if name in claims]


def _marked(cell: str) -> Markup:
    """Return a text of a table as HTML, with Greek letters; what stands between two pairs of asterisks is strong."""
    return Markup(_FAILED.sub(r"<strong>\1</strong>", str(escape(letters(cell)))))
