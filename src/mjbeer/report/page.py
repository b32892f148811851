"""The page of the report: everything in one file that opens from the disk, and that fetches nothing."""

import base64
import math
import pathlib
import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape

from mjbeer import paper
from mjbeer.checks import Result
from mjbeer.drawing.film import Take
from mjbeer.drawing.studio import Plotted
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

_SMALL = 1e-3  # a smaller share is a power of ten and not a percentage
_WIDE = 9.6  # width [inches] from which a plot takes the width of the page, so that its letters can be read
_FAILED = re.compile(r"\*\*(.+?)\*\*")

Film = tuple[bytes, bytes]
"""A film as MP4, and a picture from the midst of it as WebP."""


@dataclass(frozen=True)
class Shown:
    """A film, a plot, or both, as the page shows them."""

    name: str
    title: str
    caption: str
    command: str
    plot: Picture | None = None
    film: Film | None = None

    @property
    def wide(self) -> bool:
        """Whether the plot has several panels side by side, and needs the width of the page."""
        return self.plot is not None and self.plot.width > _WIDE


def plots(folder: pathlib.Path) -> list[Plotted]:
    """Return the plots of the page that are not those of the stories, by the names of files in a folder."""
    benchmark = Benchmark.load(SHIPPED)
    scenes = {case: replace(benchmark, points=benchmark.of(case)) for case in benchmark.cases}
    drawn = {f"error-{case}": partial(work_precision.draw, scene) for case, scene in scenes.items()}
    return [
        Plotted(draw, folder / name, in_memory=True)
        for name, draw in (drawn | stability_maps.figures(stability_maps.load())).items()
    ]


def html(
    validation: Validation,
    films: Mapping[str, Film],
    plots: Mapping[str, Picture],
    told: Mapping[str, Film],
    quick: bool,
    not_drawn: str,
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
    environment.filters |= {"mathml": mathml, "power": power, "share": share, "marked": _marked, "data": _data}
    environment.filters["inline"] = _inline
    made = "mjbeer paper" + " --films" * (not quick)
    benchmark, maps = Benchmark.load(SHIPPED), stability_maps.load()
    scenes = {name: _scene(name, films.get(name)) for name in FILMS}
    runs, same, _ = stability_maps.summary(maps["maps"])
    return environment.get_template("page.html").render(
        sketch=pathlib.Path(stories.__file__).with_name("letters.svg").read_text(encoding="utf-8"),
        races=[scenes.pop(name) for name in RACES],
        films=list(scenes.values()),
        not_drawn=not_drawn,
        errors=[plots[f"error-{case}"] for case in benchmark.cases],
        benchmark=benchmark,
        costs=benchmark_tables.tables(benchmark),
        slower=_range(benchmark, "MuJoCo RK4"),
        heyoka=_range(benchmark, "heyoka"),
        maps=maps,
        figures=[
            Shown(f"stability-{name}", figure.title, figure.caption, maps["command"], plots[f"stability-{name}"])
            for name, figure in stability_maps.FAMILIES.items()
        ],
        runs=runs,
        same=same,
        misprints=(misprints := _misprints(validation)),
        kinds=Counter(row.misprint.kind for _, row in misprints if row.misprint),
        quoted=[row for row in paper.claims() if row.quote and not row.misprint],
        findings=len(validation.audit),
        stories=[
            Shown(each.name, each.title, each.caption, made, plots[each.name], told.get(each.name))
            for each in stories.STORIES
        ],
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


def _scene(name: str, drawn: Film | None) -> Shown:
    """Return a film of the scenes, or what there is of it if it was not drawn."""
    film = FILMS[name]
    command = f"{COMMANDS[name]} --output {name}.mp4" if name in COMMANDS else "mjbeer report"
    head = film.look if isinstance(film, Take) else film
    return Shown(name, head.title if head else name, film.caption, command, film=drawn)


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
    """Return the findings of what is wrong in the paper, each with its row."""
    rows = {(row.equation, row.quantity): row for row in paper.claims() if row.misprint}
    named = [((result.group, result.name), result) for result in validation.audit]
    return [(finding, rows[name]) for name, finding in named if name in rows]


def _marked(cell: str) -> Markup:
    """Return a text of a table as HTML, with Greek letters; what stands between two pairs of asterisks is strong."""
    return Markup(_FAILED.sub(r"<strong>\1</strong>", str(escape(letters(cell)))))
