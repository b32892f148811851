"""The report: one page that opens from the disk and loads nothing from elsewhere.

Beside the page lie each film as a file, more maps, and a race to play.
"""

import base64
import html
import pathlib
import re
from collections import Counter
from collections.abc import Callable, Mapping
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
from mjbeer.output.terminal import Table
from mjbeer.paper import stories
from mjbeer.paper.claim import Claim, ClaimResult
from mjbeer.report import films
from mjbeer.studies.benchmark import benchmark_tables, work_precision
from mjbeer.studies.benchmark.points import CASES, SHIPPED, Benchmark
from mjbeer.studies.engines import engine_plot, engine_tables, findings
from mjbeer.studies.engines.results import Results
from mjbeer.studies.stability import map_plots, stability_maps
from mjbeer.studies.study import machine
from mjbeer.studies.validation.validate import Validation, validate

_HERE = pathlib.Path(__file__).parent
_LIVE_OF_WHEEL = _HERE / "web" / "live.html"
_LIVE_OF_CHECKOUT = _HERE.parents[2] / "docs" / "live.html"
"""The race to play, as it is installed from a wheel and in a checkout."""
_ERROR_OF_CONTACT = "error-contact"
"""The picture of a can that rolls by friction."""
_ENGINES = "engines"
"""The picture of the can test."""
_MAP = "stability-solref"
"""The map on the page; the others lie beside it."""
_MATHML = {
    'display="block"': 'display="inline" displaystyle="true"',
    'mathcolor="differs"': 'class="differs"',
    # The class lets the style set functions apart from the letters around them.
    "<mi>sin</mi>": '<mi class="function">sin</mi>',
    "<mi>cos</mi>": '<mi class="function">cos</mi>',
    # MathML 2 had this width, and browsers no longer know it.
    '<mspace width="negativethinmathspace" />': "",
}
"""The replacements in the MathML of latex2mathml."""
_GREEK = r"(?<![A-Za-z])(alpha|beta|delta|epsilon|theta|mu|pi|phi|omega|Omega)(?![A-Za-z])"
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


class ShownFilm(NamedTuple):
    """A film on the page."""

    video: bytes
    """As MP4."""
    still: bytes
    """A picture of it, as WebP."""


class _Audit(NamedTuple):
    """The section about the paper's claims."""

    misprints: list[tuple[ClaimResult, Claim]]
    """Each misprint of the paper, as measured."""
    kinds: Counter[str]
    """How many misprints there are of each kind."""
    quoted: list[Claim]
    """The other claims that rest on the paper's own words."""


class _Errors(NamedTuple):
    """The section about error against run time."""

    benchmark: Benchmark
    plots: list[Picture]
    motions: Mapping[str, str]
    """What each motion is, in words, by its name."""
    tables: list[Table]
    ratio_range: Callable[[str, float], str]
    """Tells how many times as long a setting takes as the best, at an error [rad]."""


class _Engines(NamedTuple):
    """The section about other physics engines."""

    answer: str
    """What the test found, in a sentence or two."""
    picture: Picture
    tables: list[Table]


class _Stability(NamedTuple):
    """The section about where runs explode."""

    maps: stability_maps.StoredMaps
    families: Mapping[str, stability_maps.Family]
    map: Picture
    """The map on the page."""
    runs: int
    """How many short runs all maps have."""
    border: float
    """Largest relative distance of a measured border from the one of linear theory."""


def write(folder: pathlib.Path, quick: bool, console: Console) -> tuple[Validation, str]:
    """Write index.html, live.html, the films and the maps that lie beside them into a folder.

    A `quick` report has smaller films, and stories with plots alone. Where OpenGL does not work,
    there are no films. Return the validation, and the line that says which films are missing, or
    "".

    Raises:
      OutputError: if the folder cannot be written to.
      RenderingError: if a film cannot be drawn for another reason.
    """
    film_jobs = films.film_jobs(folder, quick)
    not_drawn = ""
    if opengl.problem():
        not_drawn = opengl.missing_films_message([job.path.stem for job in film_jobs])
        film_jobs = []
    # The checks come first: they take longest, and compile what the films run.
    checks = Job("the checks", partial(validate, None))
    drawings = [Job(job.path.name, job.write) for job in (*film_jobs, *plot_jobs(folder))]
    validation, *drawn = jobs.run_jobs([checks, *drawings], console)
    stills = drawn[: len(film_jobs)]
    plots = drawn[len(film_jobs) :]
    shown_films = {
        job.path.stem: ShownFilm(job.path.read_bytes(), still)
        for job, still in zip(film_jobs, stills, strict=True)
    }
    # A plot that went into a file of its own is None here.
    pictures = {plot.name: plot for plot in plots if plot}
    live = _LIVE_OF_WHEEL if _LIVE_OF_WHEEL.is_file() else _LIVE_OF_CHECKOUT
    files.write(folder / "live.html", live.read_text(encoding="utf-8"))
    text = page(validation, shown_films, pictures, quick, not_drawn)
    files.write(folder / "index.html", text)
    return validation, not_drawn


def plot_jobs(folder: pathlib.Path) -> list[PlotJob]:
    """Return the jobs for the plots of the page, and for the maps beside it, in a folder."""
    benchmark = Benchmark.load(SHIPPED)
    plots = []
    for case in benchmark.cases:
        of_case = replace(benchmark, points=benchmark.of(case))
        draw = partial(work_precision.draw, of_case)
        plots.append(PlotJob(draw, folder / f"error-{case}", in_memory=True))
    draw_contact = partial(work_precision.draw_contact, benchmark)
    plots.append(PlotJob(draw_contact, folder / _ERROR_OF_CONTACT, in_memory=True))
    draw_engines = partial(engine_plot.draw, Results.load())
    plots.append(PlotJob(draw_engines, folder / _ENGINES, in_memory=True))
    for story in stories.STORIES:
        plots.append(PlotJob(story.plot, folder / story.name, in_memory=True))
    for name, draw in map_plots.figures(stability_maps.load()).items():
        plots.append(PlotJob(draw, folder / name, in_memory=name == _MAP))
    return plots


def page(
    validation: Validation,
    shown_films: Mapping[str, ShownFilm],
    plots: Mapping[str, Picture],
    quick: bool,
    not_drawn: str,
) -> str:
    """Return the page as HTML, with films and plots by their names.

    `not_drawn` says why films are missing, or is "".
    """
    loader = PackageLoader("mjbeer.report", "web")
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined)
    environment.filters |= {"mathml": mathml, "share": share, "marked": _marked, "data": _data}
    return environment.get_template("page.html").render(
        validation=validation,
        audit=_audit(validation),
        films=films,
        shown_films=shown_films,
        not_drawn=not_drawn,
        errors=_errors(plots),
        engines=_engines(plots),
        stability=_stability(plots),
        stories=stories,
        plots=plots,
        machine=machine(),
        quick=quick,
    )


def _audit(validation: Validation) -> _Audit:
    claims = paper.claims()
    misprinted = {(claim.equation, claim.quantity): claim for claim in claims if claim.misprint}
    misprints = [
        (result, misprinted[result.group, result.name])
        for result in validation.audit
        if (result.group, result.name) in misprinted
    ]
    kinds = Counter(claim.misprint.kind for _, claim in misprints if claim.misprint)
    quoted = [claim for claim in claims if claim.quote and not claim.misprint]
    return _Audit(misprints, kinds, quoted)


def _errors(plots: Mapping[str, Picture]) -> _Errors:
    benchmark = Benchmark.load(SHIPPED)
    return _Errors(
        benchmark,
        plots=[*(plots[f"error-{case}"] for case in benchmark.cases), plots[_ERROR_OF_CONTACT]],
        motions={case: CASES[case].story for case in (*benchmark.cases, *benchmark.long_cases)},
        tables=benchmark_tables.tables(benchmark),
        ratio_range=partial(benchmark_tables.ratio_range, benchmark),
    )


def _engines(plots: Mapping[str, Picture]) -> _Engines:
    results = Results.load()
    return _Engines(
        findings.answer(results),
        picture=plots[_ENGINES],
        tables=[engine_tables.errors(results), engine_tables.conservation(results)],
    )


def _stability(plots: Mapping[str, Picture]) -> _Stability:
    maps = stability_maps.load()
    runs, border = stability_maps.summary(maps.maps)
    return _Stability(maps, stability_maps.FAMILIES, plots[_MAP], runs, border)


def share(value: float) -> Markup:
    """Return a share of the largest term as HTML: a percentage, or a power of ten.

    A percentage has two digits, or all of its whole number from 100 on.
    """
    if abs(value) >= 0.1:
        return escape(f"{100 * value:.0f} %")
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
