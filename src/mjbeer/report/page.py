"""The report: one page that opens from the disk and fetches nothing.

More maps and a race to play lie beside it.
"""

import base64
import html
import pathlib
import re
import tempfile
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from jinja2 import Environment, PackageLoader, StrictUndefined
from latex2mathml.converter import convert
from markupsafe import Markup, escape
from rich.console import Console

from mjbeer import paper
from mjbeer.drawing import opengl
from mjbeer.drawing.video import PlotJob
from mjbeer.output import files, jobs
from mjbeer.output.jobs import Job
from mjbeer.output.plots import Picture
from mjbeer.paper import stories
from mjbeer.report import films
from mjbeer.studies.benchmark import benchmark_tables, work_precision
from mjbeer.studies.benchmark.points import SHIPPED, Benchmark
from mjbeer.studies.engines import engine_plot, engine_tables, findings
from mjbeer.studies.engines.results import Results
from mjbeer.studies.stability import stability_maps
from mjbeer.studies.study import machine
from mjbeer.studies.validation.validate import Validation, validate

_HERE = pathlib.Path(__file__).parent
_LIVE = (_HERE / "web" / "live.html", _HERE.parents[2] / "docs" / "live.html")
"""Where the race to play is, in a wheel and in a checkout."""
_ENGINES = "engines"
"""The picture of the can test."""
_MAP = "stability-solref"
"""The map on the page; the others lie beside it."""
_MATHML = {
    'display="block"': 'display="inline" displaystyle="true"',
    'mathcolor="differs"': 'class="differs"',
    # So that the style can set them apart from the letters around.
    "<mi>sin</mi>": '<mi class="function">sin</mi>',
    "<mi>cos</mi>": '<mi class="function">cos</mi>',
    # A name of MathML 2, which browsers no longer know.
    '<mspace width="negativethinmathspace" />': "",
}
"""What is replaced in the MathML of latex2mathml."""
_GREEK = r"(?<![A-Za-z])(alpha|beta|delta|epsilon|theta|mu|pi|phi|omega|Omega)(?![A-Za-z])"
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


class ShownFilm(NamedTuple):
    """A film on the page."""

    video: bytes
    """As MP4."""
    still: bytes
    """A picture of it, as WebP."""


def write(folder: pathlib.Path, quick: bool, console: Console) -> tuple[Validation, str]:
    """Write index.html, live.html and the maps that lie beside it into a folder.

    Quickly, the films are smaller and the stories have plots and no films. Where there is no
    OpenGL, there are no films. What comes back is the validation, and the line that says which
    films are missing, or "".

    Raises:
      OutputError: if the folder cannot be written to.
      RenderingError: if a film cannot be drawn for another reason.
    """
    with tempfile.TemporaryDirectory() as work:
        filmed = films.film_jobs(pathlib.Path(work), quick)
        not_drawn = ""
        if opengl.problem():
            not_drawn = opengl.missing_films_message([job.path.stem for job in filmed])
            filmed = []
        # The checks take longest, and compile what the films run; plots are quick.
        checks = Job("the checks", partial(validate, None))
        drawn = [Job(job.path.name, job.write) for job in (*filmed, *plot_jobs(folder))]
        validation, *made = jobs.run_jobs([checks, *drawn], console)
        stills = made[: len(filmed)]
        plots = made[len(filmed) :]
        shown = {
            job.path.stem: ShownFilm(job.path.read_bytes(), still)
            for job, still in zip(filmed, stills, strict=True)
        }
        pictures = {plot.name: plot for plot in plots if plot}
        live = next(path for path in _LIVE if path.is_file())
        files.write(folder / "live.html", live.read_text(encoding="utf-8"))
        files.write(folder / "index.html", page(validation, shown, pictures, quick, not_drawn))
    return validation, not_drawn


def plot_jobs(folder: pathlib.Path) -> list[PlotJob]:
    """Return the plots of the page; the maps that lie beside it are drawn into a folder."""
    benchmark = Benchmark.load(SHIPPED)
    jobs = []
    for case in benchmark.cases:
        of_case = replace(benchmark, points=benchmark.of(case))
        draw = partial(work_precision.draw, of_case)
        jobs.append(PlotJob(draw, folder / f"error-{case}", in_memory=True))
    draw_engines = partial(engine_plot.draw, Results.load())
    jobs.append(PlotJob(draw_engines, folder / _ENGINES, in_memory=True))
    for story in stories.STORIES:
        jobs.append(PlotJob(story.plot, folder / story.name, in_memory=True))
    for name, draw in stability_maps.figures(stability_maps.load()).items():
        jobs.append(PlotJob(draw, folder / name, in_memory=name == _MAP))
    return jobs


def page(
    validation: Validation,
    drawn: Mapping[str, ShownFilm],
    plots: Mapping[str, Picture],
    quick: bool,
    not_drawn: str,
) -> str:
    """Return the page as HTML, with plots and `drawn` films by their names.

    `not_drawn` says why films are missing, or is "".
    """
    loader = PackageLoader("mjbeer.report", "web")
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined)
    environment.filters |= {"mathml": mathml, "share": share, "marked": _marked, "data": _data}
    benchmark = Benchmark.load(SHIPPED)
    rolled = Results.load()
    maps = stability_maps.load()
    runs, border = stability_maps.summary(maps.maps)
    claims = paper.claims()
    misprinted = {(claim.equation, claim.quantity): claim for claim in claims if claim.misprint}
    misprints = [
        (result, misprinted[result.group, result.name])
        for result in validation.audit
        if (result.group, result.name) in misprinted
    ]
    return environment.get_template("page.html").render(
        films=films,
        drawn=drawn,
        not_drawn=not_drawn,
        errors=[plots[f"error-{case}"] for case in benchmark.cases],
        benchmark=benchmark,
        costs=benchmark_tables.tables(benchmark),
        ratio_range=partial(benchmark_tables.ratio_range, benchmark),
        engines=plots[_ENGINES],
        engine_tables=[engine_tables.errors(rolled), engine_tables.conservation(rolled)],
        engines_answer=findings.answer(rolled),
        maps=maps,
        map=plots[_MAP],
        families=stability_maps.FAMILIES,
        runs=runs,
        border=border,
        misprints=misprints,
        kinds=Counter(claim.misprint.kind for _, claim in misprints if claim.misprint),
        quoted=[claim for claim in claims if claim.quote and not claim.misprint],
        stories=stories,
        plots=plots,
        validation=validation,
        machine=machine(),
        quick=quick,
    )


def share(value: float) -> Markup:
    """Return a share of the largest term as HTML: a percentage, or a power of ten.

    A percentage has two digits, or three from 100 on.
    """
    if abs(value) >= 1:
        return escape(f"{100 * value:.3g} %")
    if abs(value) >= 1e-3 or value == 0:
        return escape(f"{100 * value:.2g} %")
    digits, power = f"{value:.1e}".split("e")
    exponent = f"{int(power)}".replace("-", "\N{MINUS SIGN}")
    return Markup("{}&thinsp;·&thinsp;10<sup>{}</sup>").format(digits, exponent)


def mathml(latex: str) -> Markup:
    r"""Return the MathML of a formula, one `math` element for each line; `\\` separates the lines.

    `\textcolor{differs}{...}` becomes an element of the class "differs".
    """
    text = "".join(convert(line, display="block") for line in re.split(r"\\\\\s", latex))
    for old, new in _MATHML.items():
        text = text.replace(old, new)
    return Markup(text)


def letters(text: str) -> str:
    """Return a text of the audit with phi as φ, phi_dot as φ̇, a^2 as a² and phi_0 as φ₀."""
    text = re.sub(_GREEK, lambda name: html.unescape(f"&{name[1]};"), text)
    text = re.sub(r"(?<![A-Za-z])(\w)_ddot", "\\1\N{COMBINING DIAERESIS}", text)
    text = re.sub(r"(?<![A-Za-z])(\w)_dot", "\\1\N{COMBINING DOT ABOVE}", text)
    text = re.sub(r"\^(\d)(?!\d)", lambda power: power[1].translate(_RAISED), text)
    return text.replace("_0", "₀")


def _data(content: bytes | str, kind: str) -> str:
    """Return a file of a kind as a data: URI."""
    content = content if isinstance(content, bytes) else content.encode()
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def _marked(cell: str) -> Markup:
    """Return a text of a table as HTML, with Greek letters; what is in **asterisks** is strong."""
    text = str(escape(letters(cell)))
    return Markup(re.sub(r"\*\*(.+?)\*\*", r"<strong>\1</strong>", text))
